/* The whole mesh on one rank: box, connection, partition, Hilbert curve. */
#include <math.h>
#include <setjmp.h>
#include <stdbool.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/error.h"
#include "base/hash.h"
#include "base/hilbert.h"
#include "base/mem.h"
#include "base/tet.h"
#include "layout.h"
#include "mesh/mesh.h"
#include "mesh/tile_graph.h"
#include "support/child.h"

static const struct box {
    int64_t cells[3];
    double origin[3], size[3], jitter;
} boxes[] = {
    {{1, 1, 1}, {0, 0, 0}, {1, 1, 1}, 0},
    {{1, 1, 3}, {-1, 2, 0.1}, {0.3, 0.2, 0.7}, 0},
    {{4, 3, 5}, {-0.2e-3, -0.2e-3, -2e-3}, {0.4e-3, 0.4e-3, 4e-3}, 0.12},
    {{7, 6, 5}, {0.1, 0.2, 0.3}, {0.7, 1.3, 0.9}, 0.1},
};
enum { BOXES = sizeof boxes / sizeof boxes[0] };

static rg_mesh *make(const struct box *b) {
    return rg_mesh_box(b->cells, b->origin, b->size, b->jitter, 7);
}

static const double *vertex(const rg_mesh *m, rg_gid e, int i) {
    return m->x + 3 * m->corner[4 * e + i];
}

static double volume(const rg_mesh *m, rg_gid e) {
    return fabs(rg_tet_volume(vertex(m, e, 0), vertex(m, e, 1), vertex(m, e, 2), vertex(m, e, 3)));
}

/* Outward area vector of face f (m^2). */
static void face_area(const rg_mesh *m, rg_gid e, int f, double area[3]) {
    const double *a = vertex(m, e, rg_face_node[f][0]), *b = vertex(m, e, rg_face_node[f][1]);
    const double *c = vertex(m, e, rg_face_node[f][2]), *apex = vertex(m, e, f);
    double inward = 0.0;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        area[i] = 0.5 * ((b[j] - a[j]) * (c[k] - a[k]) - (b[k] - a[k]) * (c[j] - a[j]));
        inward += area[i] * (apex[i] - a[i]);
    }
    for (int i = 0; i < 3 && inward > 0.0; i++) {
        area[i] = -area[i];
    }
}

static void test_counts(void **state) {
    (void)state;
    for (int b = 0; b < BOXES; b++) {
        rg_mesh *m = make(&boxes[b]);
        const int64_t *n = boxes[b].cells;
        assert_int_equal(m->elements, 6 * n[0] * n[1] * n[2]);
        assert_int_equal(m->vertices, (n[0] + 1) * (n[1] + 1) * (n[2] + 1));
        rg_gid surface = 0, inside = 0;
        for (rg_gid slot = 0; slot < 4 * m->elements; slot++) {
            surface += m->neighbour[slot] < 0;
            inside += m->neighbour[slot] > slot / 4; /* each interior face from its lower element only */
        }
        assert_int_equal(surface, 4 * (n[0] * n[1] + n[1] * n[2] + n[2] * n[0]));
        assert_int_equal(inside, (4 * m->elements - surface) / 2);
        rg_mesh_free(m);
    }
}

/* Six elements in each cell, each a walk from its lowest to its highest vertex; vertices in grid order. */
static void test_numbering(void **state) {
    (void)state;
    const int64_t n[3] = {3, 2, 4};
    const double origin[3] = {10, 20, 30}, size[3] = {3, 4, 2};
    rg_mesh *m = rg_mesh_box(n, origin, size, 0, 0);
    const rg_gid row = n[0] + 1, layer = row * (n[1] + 1), diagonal = 1 + row + layer;
    int count[24] = {0};
    for (rg_gid e = 0; e < m->elements; e++) {
        const rg_gid *c = m->corner + 4 * e;
        rg_gid at[3] = {c[0] % row, c[0] / row % (n[1] + 1), c[0] / layer};
        assert_true(at[0] < n[0] && at[1] < n[1] && at[2] < n[2]);
        assert_true(c[0] < c[1] && c[1] < c[2] && c[2] < c[3] && c[3] == c[0] + diagonal);
        count[at[0] + n[0] * (at[1] + n[1] * at[2])]++;
        for (int i = 0; i < 3; i++) {
            assert_true(fabs(vertex(m, e, 0)[i] - (origin[i] + (double)at[i] * size[i] / (double)n[i])) <
                        1e-13);
        }
    }
    for (int cell = 0; cell < 24; cell++) {
        assert_int_equal(count[cell], 6);
    }
    rg_mesh_free(m);
}

static void test_volume(void **state) {
    (void)state;
    for (int b = 0; b < BOXES; b++) {
        rg_mesh *m = make(&boxes[b]);
        long double sum = 0.0;
        for (rg_gid e = 0; e < m->elements; e++) {
            assert_true(volume(m, e) > 0.0);
            sum += (long double)volume(m, e);
        }
        double box = boxes[b].size[0] * boxes[b].size[1] * boxes[b].size[2];
        assert_true(fabs((double)sum - box) <= 1e-14 * box);
        rg_mesh_free(m);
    }
}

/* Both sides of a face name each other and the same three vertices. */
static void check_neighbours(const rg_mesh *m) {
    for (rg_gid slot = 0; slot < 4 * m->elements; slot++) {
        rg_gid e = slot / 4, other = m->neighbour[slot];
        int f = (int)(slot % 4), g = m->face[slot];
        if (other < 0) {
            assert_int_equal(other, -1);
            assert_int_equal(g, -1);
            continue;
        }
        assert_true(other < m->elements && other != e && g >= 0 && g < 4);
        assert_int_equal(m->neighbour[4 * other + g], e);
        assert_int_equal(m->face[4 * other + g], f);
        for (int i = 0; i < 3; i++) {
            assert_int_equal(m->corner[4 * e + rg_face_node[f][i]],
                             m->corner[4 * other + rg_face_node[g][i]]);
        }
    }
}

static void test_neighbours(void **state) {
    (void)state;
    for (int b = 0; b < BOXES; b++) {
        rg_mesh *m = make(&boxes[b]);
        check_neighbours(m);
        rg_mesh_free(m);
    }
}

static void test_closed_elements(void **state) {
    (void)state;
    rg_mesh *m = make(&boxes[BOXES - 1]);
    for (rg_gid e = 0; e < m->elements; e++) {
        double sum[3] = {0, 0, 0}, total = 0.0;
        for (int f = 0; f < 4; f++) {
            double area[3];
            face_area(m, e, f, area);
            for (int i = 0; i < 3; i++) {
                sum[i] += area[i];
                total += fabs(area[i]);
            }
        }
        assert_true(fabs(sum[0]) + fabs(sum[1]) + fabs(sum[2]) < 1e-14 * total);
    }
    rg_mesh_free(m);
}

/* Each set is one whole side: its faces lie exactly on the plane, look outward and cover it. */
static void check_sets(const rg_mesh *m, const struct box *b) {
    double covered[6] = {0};
    for (rg_gid slot = 0; slot < 4 * m->elements; slot++) {
        int s = m->set[slot], f = (int)(slot % 4);
        assert_int_equal(s >= 0, m->neighbour[slot] < 0);
        if (s < 0) {
            continue;
        }
        int axis = s / 2;
        double plane = s % 2 ? b->origin[axis] + b->size[axis] : b->origin[axis], area[3];
        for (int i = 0; i < 3; i++) {
            assert_true(vertex(m, slot / 4, rg_face_node[f][i])[axis] == plane);
        }
        face_area(m, slot / 4, f, area);
        covered[s] += s % 2 ? area[axis] : -area[axis];
    }
    for (int s = 0; s < 6; s++) {
        double side = b->size[(s / 2 + 1) % 3] * b->size[(s / 2 + 2) % 3];
        assert_true(fabs(covered[s] - side) < 1e-13 * side);
    }
}

static void test_sets(void **state) {
    (void)state;
    static const char *const names[6] = {"x-", "x+", "y-", "y+", "z-", "z+"};
    for (int b = 0; b < BOXES; b++) {
        rg_mesh *m = make(&boxes[b]);
        assert_int_equal(m->surface.count, 6);
        for (int s = 0; s < 6; s++) {
            assert_string_equal(m->surface.name[s], names[s]);
        }
        check_sets(m, &boxes[b]);
        rg_mesh_free(m);
    }
}

static void test_jitter(void **state) {
    (void)state;
    const int64_t n[3] = {6, 5, 4};
    const double origin[3] = {0, 0, 0}, size[3] = {1.2, 1.5, 0.4}, reach = 0.1 * 0.1; /* of the z edge */
    rg_mesh *plain = rg_mesh_box(n, origin, size, 0, 3), *moved = rg_mesh_box(n, origin, size, 0.1, 3);
    rg_mesh *again = rg_mesh_box(n, origin, size, 0.1, 3), *other = rg_mesh_box(n, origin, size, 0.1, 4);
    size_t bytes = 3 * (size_t)plain->vertices * sizeof(double);
    assert_memory_equal(moved->x, again->x, bytes);
    double largest = 0.0, mean = 0.0;
    rg_gid count = 0;
    for (rg_gid v = 0; v < plain->vertices; v++) {
        bool surface = false;
        for (int i = 0; i < 3; i++) {
            double x = plain->x[3 * v + i];
            surface = surface || x == 0.0 || x == size[i];
        }
        for (int i = 0; i < 3; i++) {
            double by = moved->x[3 * v + i] - plain->x[3 * v + i];
            assert_int_equal(by != 0.0, !surface);
            assert_int_equal(moved->x[3 * v + i] != other->x[3 * v + i], !surface);
            largest = fmax(largest, fabs(by));
            mean += by;
            count += !surface;
        }
    }
    assert_true(largest <= reach * (1 + 1e-12) && largest > 0.95 * reach);
    assert_true(fabs(mean / (double)count) < 0.2 * reach);
    rg_mesh_free(plain);
    rg_mesh_free(moved);
    rg_mesh_free(again);
    rg_mesh_free(other);
}

/* Renumbers vertices and elements at random, with corners sorted again. */
static void shuffle(rg_gid *list, rg_gid count, uint64_t seed) {
    for (rg_gid i = 0; i < count; i++) {
        list[i] = i;
    }
    for (rg_gid i = count - 1; i > 0; i--) {
        rg_gid j = (rg_gid)(rg_hash(seed, (uint64_t)i) % (uint64_t)(i + 1)), t = list[i];
        list[i] = list[j];
        list[j] = t;
    }
}

static int ascending(const void *a, const void *b) {
    rg_gid p = *(const rg_gid *)a, q = *(const rg_gid *)b;
    return (p > q) - (p < q);
}

static void test_connect_unstructured(void **state) {
    (void)state;
    const int64_t n[3] = {5, 4, 6};
    const double origin[3] = {0, 0, 0}, size[3] = {1, 1, 1};
    rg_mesh *m = rg_mesh_box(n, origin, size, 0, 0);
    size_t faces = 4 * (size_t)m->elements;
    rg_gid *number = RG_NEW(rg_gid, (size_t)m->vertices), *moved = RG_NEW(rg_gid, (size_t)m->elements);
    rg_gid *corner = RG_NEW(rg_gid, faces), *neighbour = RG_NEW(rg_gid, faces);
    memcpy(neighbour, m->neighbour, faces * sizeof *neighbour);
    shuffle(number, m->vertices, 1);
    shuffle(moved, m->elements, 2);
    for (size_t slot = 0; slot < faces; slot++) {
        corner[4 * moved[slot / 4] + (rg_gid)slot % 4] = number[m->corner[slot]];
    }
    for (size_t e = 0; e < faces; e += 4) {
        qsort(corner + e, 4, sizeof *corner, ascending);
    }
    memcpy(m->corner, corner, faces * sizeof *corner);
    rg_mesh_connect(m);
    check_neighbours(m);
    for (rg_gid e = 0; e < m->elements; e++) { /* the same neighbours as before, under their new numbers */
        rg_gid sum = 0, before = 0;
        for (int f = 0; f < 4; f++) {
            rg_gid old = neighbour[4 * e + f];
            sum += m->neighbour[4 * moved[e] + f];
            before += old < 0 ? -1 : moved[old];
        }
        assert_int_equal(sum, before);
    }
    rg_free(number);
    rg_free(moved);
    rg_free(corner);
    rg_free(neighbour);
    rg_mesh_free(m);
}

/* Index of an element's centroid on the curve, where space counts in mean elements. */
static uint64_t curve_key(const rg_mesh *m, const double low[3], const double extent[3], double edge,
                          rg_gid e) {
    static const double origin[3] = {0, 0, 0};
    double x[3] = {0, 0, 0};
    for (int i = 0; i < 3; i++) {
        x[i] = 0.25 * ((vertex(m, e, 0)[i] + vertex(m, e, 1)[i]) + (vertex(m, e, 2)[i] + vertex(m, e, 3)[i]));
        x[i] = (x[i] - low[i]) / extent[i];
    }
    return rg_hilbert_point(x, origin, edge);
}

/* Elements ascend along the curve. */
static void test_order(void **state) {
    (void)state;
    for (int b = 0; b < BOXES; b++) {
        rg_mesh *m = make(&boxes[b]);
        double box[2][3], extent[3], edge = 0;
        rg_mesh_box_around(m, box);
        rg_mesh_mean_extent(m, (const double(*)[3])box, extent);
        for (int i = 0; i < 3; i++) {
            assert_true(box[0][i] == boxes[b].origin[i] && box[1][i] == box[0][i] + boxes[b].size[i]);
            edge = fmax(edge, boxes[b].size[i] / extent[i]);
        }
        for (rg_gid e = 1; e < m->elements; e++) {
            assert_true(curve_key(m, box[0], extent, edge, e - 1) < curve_key(m, box[0], extent, edge, e));
        }
        rg_mesh_free(m);
    }
}

/* All elements of a cube of six are as wide as the cube; the sum has 30 bits. */
static void test_mean_extent(void **state) {
    (void)state;
    const int64_t n[3] = {3, 4, 5};
    const double origin[3] = {1, 2, 3}, size[3] = {0.3, 4, 50};
    rg_mesh *m = rg_mesh_box(n, origin, size, 0, 0);
    double box[2][3], extent[3];
    rg_mesh_box_around(m, box);
    rg_mesh_mean_extent(m, (const double(*)[3])box, extent);
    for (int i = 0; i < 3; i++) {
        double cube = size[i] / (double)n[i];
        assert_true(fabs(extent[i] - cube) < 1e-8 * cube);
    }
    rg_mesh_free(m);
}

/* Neighbours are near each other in the mesh's order. */
static void test_hilbert_locality(void **state) {
    (void)state;
    const int64_t n[3] = {12, 10, 14};
    const double low[3] = {0, 0, 0}, size[3] = {1.2, 1.0, 1.4};
    rg_mesh *m = rg_mesh_box(n, low, size, 0, 0);
    double sum = 0.0;
    rg_gid count = 0;
    for (rg_gid slot = 0; slot < 4 * m->elements; slot++) {
        if (m->neighbour[slot] >= 0) {
            sum += fabs((double)(m->neighbour[slot] - slot / 4));
            count++;
        }
    }
    double mean = sum / (double)count, random = (double)m->elements / 3;
    assert_true(mean < 0.1 * random);
    rg_mesh_free(m);
}

/* An element as vertices and sets, whatever its number. */
struct record {
    rg_gid corner[4];
    int32_t set[4];
};

static int by_corners(const void *a, const void *b) {
    const struct record *p = a, *q = b;
    return memcmp(p->corner, q->corner, sizeof p->corner);
}

static struct record *records(const rg_mesh *m) {
    struct record *list = RG_NEW(struct record, (size_t)m->elements);
    for (rg_gid e = 0; e < m->elements; e++) {
        memcpy(list[e].corner, m->corner + 4 * e, sizeof list[e].corner);
        memcpy(list[e].set, m->set + 4 * e, sizeof list[e].set);
    }
    qsort(list, (size_t)m->elements, sizeof *list, by_corners);
    return list;
}

/* Sorting keeps each element with its sets, and brings a shuffled mesh back to the same order. */
static void test_sort(void **state) {
    (void)state;
    rg_mesh *m = make(&boxes[BOXES - 1]);
    size_t faces = 4 * (size_t)m->elements, bytes = (size_t)m->elements * sizeof(struct record);
    rg_gid *moved = RG_NEW(rg_gid, (size_t)m->elements), *corner = RG_NEW(rg_gid, faces);
    int32_t *set = RG_NEW(int32_t, faces);
    struct record *before = records(m);
    memcpy(corner, m->corner, faces * sizeof *corner);
    memcpy(set, m->set, faces * sizeof *set);
    shuffle(moved, m->elements, 2);
    for (size_t slot = 0; slot < faces; slot++) {
        m->corner[4 * moved[slot / 4] + (rg_gid)slot % 4] = corner[slot];
        m->set[4 * moved[slot / 4] + (rg_gid)slot % 4] = set[slot];
    }
    assert_memory_not_equal(m->corner, corner, faces * sizeof *corner);
    rg_mesh_sort(m);
    struct record *after = records(m);
    assert_memory_equal(after, before, bytes);
    assert_memory_equal(m->corner, corner, faces * sizeof *corner);
    assert_memory_equal(m->set, set, faces);
    rg_free(before);
    rg_free(after);
    rg_free(moved);
    rg_free(corner);
    rg_free(set);
    rg_mesh_free(m);
}

/* At least 64 tiles where the elements suffice, of whole blocks if that is possible, at most as asked for. */
static void test_tile_elements(void **state) {
    (void)state;
    static const struct {
        rg_gid elements;
        int tile;
    } known[] = {{1, 1},           {6, 1},
                 {63, 1},          {127, 1},
                 {128, 2},         {511, 7},
                 {512, 8},         {1023, 15},
                 {1024, 16},       {64 * 255, 240},
                 {16383, 240},     {16384, RG_TILE},
                 {16385, RG_TILE}, {INT64_C(1) << 40, RG_TILE}};
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
        assert_int_equal(rg_tile_elements(known[k].elements, RG_TILE), known[k].tile);
    }
    assert_int_equal(rg_tile_elements(64 * RG_MOST_TILE - 1, RG_MOST_TILE), RG_MOST_TILE - 16);
    assert_int_equal(rg_tile_elements(64 * RG_MOST_TILE, RG_MOST_TILE), RG_MOST_TILE);
    assert_int_equal(rg_mesh_tile(&(rg_mesh){.elements = INT64_C(1) << 40}), RG_TILE);
    assert_int_equal(rg_mesh_tile(&(rg_mesh){.elements = INT64_C(1) << 40, .tile = 512}), 512);
    for (rg_gid elements = 1; elements < 40000; elements++) {
        int tile = rg_tile_elements(elements, RG_TILE);
        rg_gid tiles = (elements + tile - 1) / tile;
        assert_true(tile >= 1 && tile <= RG_TILE && (tile < 16 || tile % 16 == 0));
        assert_true(tiles >= 64 || tiles == elements);
    }
}

/* The 512 cells nearest the origin are the curve's first 512, each a face neighbour of the one before. */
static void test_hilbert_curve(void **state) {
    (void)state;
    uint32_t at[512][3];
    bool seen[512] = {false};
    for (uint32_t c = 0; c < 512; c++) {
        uint32_t cell[3] = {c % 8, c / 8 % 8, c / 64};
        uint64_t key = rg_hilbert_cell(cell);
        assert_true(key < 512 && !seen[key]);
        seen[key] = true;
        memcpy(at[key], cell, sizeof cell);
    }
    for (int i = 1; i < 512; i++) {
        int steps = 0;
        for (int k = 0; k < 3; k++) {
            steps += abs((int)at[i][k] - (int)at[i - 1][k]);
        }
        assert_int_equal(steps, 1);
    }
}

static void test_hilbert_point(void **state) {
    (void)state;
    const double low[3] = {-1, 2, 5}, inside[3] = {-0.75, 2.5, 6.999}, beyond[3] = {-7, 9, 5.5};
    const double cells = (double)(1 << RG_HILBERT_BITS);
    const uint32_t last = (1 << RG_HILBERT_BITS) - 1;
    const uint32_t cell[3] = {1 << 18, 1 << 19, (uint32_t)((6.999 - 5.0) / 2.0 * cells)};
    const uint32_t edge[3] = {0, last, 1 << 19};
    assert_true(rg_hilbert_point(inside, low, 2.0) == rg_hilbert_cell(cell));
    assert_true(rg_hilbert_point(beyond, low, 2.0) == rg_hilbert_cell(edge));
    const uint32_t corners[2][3] = {{0, 0, 0}, {last, 0, 0}}; /* the curve's ends */
    assert_true(rg_hilbert_cell(corners[0]) == 0);
    assert_true(rg_hilbert_cell(corners[1]) == (UINT64_C(1) << 63) - 1);
}

/* part[tiles]: which of `parts` has a tile. */
static void partition(const rg_mesh *m, int tile, int parts, int32_t *part) {
    rg_tile_graph *g = rg_tile_graph_make(m, tile);
    rg_tile_graph_partition(g, parts, part);
    rg_tile_graph_free(g);
}

/* Sizes of the smallest and the largest part, in elements. */
static void part_sizes(const rg_mesh *m, int tile, int parts, const int32_t *part, rg_gid *least,
                       rg_gid *most) {
    rg_gid *size = RG_NEW(rg_gid, (size_t)parts);
    for (rg_gid e = 0; e < m->elements; e++) {
        assert_true(part[e / tile] >= 0 && part[e / tile] < parts);
        size[part[e / tile]]++;
    }
    *least = m->elements;
    *most = 0;
    for (int p = 0; p < parts; p++) {
        *least = size[p] < *least ? size[p] : *least;
        *most = size[p] > *most ? size[p] : *most;
    }
    rg_free(size);
}

/* Partition of tiles: the same in every run, few faces cut, and balanced within 10 % or what whole tiles
 * allow: the largest part, for which all wait, within a tile of even, the smallest within two. */
static void check_partition(const rg_mesh *m, int tile, int parts) {
    size_t tiles = (size_t)((m->elements + tile - 1) / tile);
    int32_t *part = RG_NEW(int32_t, tiles), *again = RG_NEW(int32_t, tiles);
    rg_gid least, most, cut = 0;
    partition(m, tile, parts, part);
    partition(m, tile, parts, again);
    assert_memory_equal(part, again, tiles * sizeof *part);
    part_sizes(m, tile, parts, part, &least, &most);
    double even = (double)m->elements / parts;
    assert_true((double)most < even + fmax(0.1 * even, tile));
    assert_true((double)least > even - fmax(0.1 * even, tile > 1 ? 2 * tile : 0));
    for (rg_gid slot = 0; slot < 4 * m->elements; slot++) {
        cut += m->neighbour[slot] >= 0 && part[slot / 4 / tile] != part[m->neighbour[slot] / tile];
    }
    assert_true(cut < m->elements / 2); /* a random partition cuts most of the 4 sides per element */
    rg_free(part);
    rg_free(again);
}

static void test_partition_balance(void **state) {
    (void)state;
    const int64_t n[3] = {8, 9, 10};
    const double origin[3] = {0, 0, 0}, size[3] = {1, 1, 1};
    rg_mesh *m = rg_mesh_box(n, origin, size, 0, 0);
    const int tiles[] = {8, 40};
    for (size_t k = 0; k < sizeof tiles / sizeof tiles[0]; k++) {
        for (int parts = 1; parts <= 8; parts += parts < 4 ? 1 : 4) {
            check_partition(m, tiles[k], parts);
        }
    }
    rg_mesh_free(m);
}

/* No part is empty, down to one tile each. */
static void test_partition_tiny(void **state) {
    (void)state;
    for (int b = 0; b < 2; b++) {
        rg_mesh *m = make(&boxes[b]);
        int32_t part[18];
        for (int tile = 1; tile <= 7; tile++) {
            for (int parts = 1; parts <= (m->elements + tile - 1) / tile; parts++) {
                rg_gid least, most;
                partition(m, tile, parts, part);
                part_sizes(m, tile, parts, part, &least, &most);
                assert_true(least >= 1);
            }
        }
        rg_mesh_free(m);
    }
}

static void expect_refusal(void (*job)(void), const char *const *words) {
    char said[512];
    assert_int_equal(run_child(job, said, sizeof said), RG_USAGE);
    for (; *words != NULL; words++) {
        assert_non_null(strstr(said, *words));
    }
}

static void wild_jitter(void) {
    const struct box b = {{4, 3, 5}, {0, 0, 0}, {4, 3, 5}, 0.9};
    rg_mesh_free(make(&b));
}

static void many_cells(void) {
    const struct box b = {{1000000, 1000000, 1000000}, {0, 0, 0}, {1, 1, 1}, 0};
    rg_mesh_free(make(&b));
}

static const rg_mesh *one_cell; /* made before the fork: a child has no threads to sort it */

static void many_parts(void) {
    int32_t part[3];
    partition(one_cell, 2, 4, part);
}

static void shared_thrice(void) {
    double x[18] = {0};
    rg_gid corner[12] = {0, 1, 2, 3, 0, 1, 2, 4, 0, 1, 2, 5}, neighbour[12];
    int8_t face[12];
    rg_mesh m = {
        .vertices = 6, .elements = 3, .x = x, .corner = corner, .neighbour = neighbour, .face = face};
    rg_mesh_connect(&m);
}

/* The element that the message names is in the cell that it names, and has less than a thousandth of the
 * volume. */
static void check_refused_element(void) {
    char said[512];
    long long e, cell[3];
    double jitter, share;
    assert_int_equal(run_child(wild_jitter, said, sizeof said), RG_USAGE);
    assert_int_equal(
        sscanf(
            said,
            "rhegma: mesh.jitter: %lf turns element %lld in cell (%lld, %lld, %lld) inside out or nearly so: "
            "its volume is %lf of the regular one; choose a smaller jitter or another seed",
            &jitter, &e, &cell[0], &cell[1], &cell[2], &share),
        6);
    assert_true(jitter == 0.9 && share < 1e-3);
    assert_int_equal(e / 6, cell[0] + 4 * (cell[1] + 3 * cell[2]));
}

static void test_refusals(void **state) {
    (void)state;
    rg_mesh *m = make(&boxes[0]);
    one_cell = m;
    expect_refusal(wild_jitter, (const char *const[]){"mesh.jitter: 0.9", "element ", "cell (", NULL});
    check_refused_element();
    expect_refusal(many_cells, (const char *const[]){"mesh.cells", "1000000 x 1000000 x 1000000", NULL});
    expect_refusal(many_parts, (const char *const[]){"4 ranks", "6 elements", "3 tiles", NULL});
    expect_refusal(shared_thrice, (const char *const[]){"elements 0, 1 and 2", "vertices 0, 1 and 2", NULL});
    rg_mesh_free(m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_counts),           cmocka_unit_test(test_numbering),
        cmocka_unit_test(test_volume),           cmocka_unit_test(test_neighbours),
        cmocka_unit_test(test_closed_elements),  cmocka_unit_test(test_sets),
        cmocka_unit_test(test_jitter),           cmocka_unit_test(test_connect_unstructured),
        cmocka_unit_test(test_hilbert_curve),    cmocka_unit_test(test_hilbert_point),
        cmocka_unit_test(test_hilbert_locality), cmocka_unit_test(test_order),
        cmocka_unit_test(test_mean_extent),      cmocka_unit_test(test_sort),
        cmocka_unit_test(test_tile_elements),    cmocka_unit_test(test_partition_balance),
        cmocka_unit_test(test_partition_tiny),   cmocka_unit_test(test_refusals),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    return failed + (rg_alloc_blocks() > 0); /* all is given back */
}
