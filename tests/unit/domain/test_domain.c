/* The domain of a mesh on one rank: every face once inside a tile or as two tile-boundary faces that mirror
 * each other. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>
#include <mpi.h>

#include "domain/domain.h"
#include "base/mem.h"
#include "base/tet.h"

static const int64_t cells[3] = {4, 5, 3};
static const double origin[3] = {-1e-3, 0, 2e-3}, size[3] = {4e-3, 6e-3, 2e-3};

/* From single elements to one tile for all 360; with whole blocks and without, with and without a ragged last
 * tile. */
static const int tile_sizes[] = {1, 5, 8, 24, 64, 100, 256, 360, 1000};
enum { TILE_SIZES = sizeof tile_sizes / sizeof tile_sizes[0] };

enum { MANY = 300, LAST = MANY - 1 };
static const rg_material matter[] = {[0] = {.lambda = 1.2e11, .mu = 0.8e11},
                                     [1] = {.lambda = 0.3e11, .mu = 0.1e11},
                                     [LAST] = {.lambda = 2e11, .mu = 3e11}};

/* One material; three, the last of all among them, in turn among the elements, the second one rarely. */
static const rg_interface_material materials[] = {{1, matter, 4, RG_PENALTY_ELASTIC},
                                                  {1, matter, 4, RG_PENALTY_ISOTROPIC},
                                                  {MANY, matter, 4, RG_PENALTY_ELASTIC}};
enum { MATERIALS = sizeof materials / sizeof *materials };

static int material_of(const rg_interface_material *m, rg_gid e) {
    return m->materials == 1 ? 0 : e % 19 == 3 ? 1 : e % 2 == 0 ? LAST : 0;
}

/* A domain with the mesh and the part that it was built from. */
typedef struct {
    rg_mesh *mesh;
    rg_part *part;
    rg_domain *domain;
    const rg_interface_material *material;
} setup;

static setup setup_make(int tile, const rg_interface_material *material) {
    setup s = {.mesh = rg_mesh_box(cells, origin, size, 0.13, 3), .material = material};
    s.part = rg_part_distribute(s.mesh, tile, MPI_COMM_SELF);
    for (rg_lid i = 0; i < s.part->elements; i++) {
        rg_element *e = &s.part->element[i];
        e->material = (uint16_t)material_of(material, e->id);
        for (int f = 0; f < RG_FACES; f++) {
            e->beside[f] = (uint16_t)material_of(material, e->neighbour[f]);
        }
    }
    s.domain = rg_domain_build(s.part, NULL, 0, material);
    return s;
}

static void for_each_setup(void (*check)(const setup *s)) {
    for (int t = 0; t < TILE_SIZES; t++) {
        for (int m = 0; m < MATERIALS; m++) {
            setup s = setup_make(tile_sizes[t], &materials[m]);
            check(&s);
            rg_domain_free(s.domain);
            rg_part_free(s.part);
            rg_mesh_free(s.mesh);
        }
    }
}

static const double *corner(const rg_mesh *m, rg_gid e, int i) {
    return m->x + 3 * m->corner[4 * e + i];
}

/* Area vector of face f of element e (m^2) out of the element. */
static void outward(const rg_mesh *m, rg_gid e, int f, double area[3]) {
    const double *x[3] = {corner(m, e, rg_face_node[f][0]), corner(m, e, rg_face_node[f][1]),
                          corner(m, e, rg_face_node[f][2])};
    double away = 0;
    for (int c = 0; c < 3; c++) {
        int a = (c + 1) % 3, b = (c + 2) % 3;
        area[c] =
            0.5 * ((x[1][a] - x[0][a]) * (x[2][b] - x[0][b]) - (x[1][b] - x[0][b]) * (x[2][a] - x[0][a]));
        away += area[c] * (x[0][c] - corner(m, e, f)[c]);
    }
    for (int c = 0; c < 3; c++) {
        area[c] *= away > 0 ? 1 : -1;
    }
}

/* Slot of a global element; every tile but the last one has the same number of them. */
static size_t slot_of(const rg_domain *d, rg_gid e) {
    rg_gid tile = e / d->tile_elements;
    return d->tile[tile].begin * RG_LANES + rg_slot_in(d, &d->tile[tile], e);
}

static int32_t interface_link(const rg_domain *d, rg_gid e, int f) {
    return d->interface[rg_link_index(slot_of(d, e), f)];
}

/* Interface of the domain that an element's face links to. */
static size_t interface_of(const rg_domain *d, rg_gid e, int f) {
    const rg_tile *t = rg_tile_of(d, slot_of(d, e));
    return t->ibegin * RG_LANES + (size_t)interface_link(d, e, f) / 4;
}

static bool is_tile_face(const rg_domain *d, const rg_tile *t, size_t i) {
    assert_true(i >= t->ibegin * RG_LANES && i < t->iend * RG_LANES && i < d->iblocks * RG_LANES);
    return i >= t->sbegin * RG_LANES;
}

/* Row of a tile-boundary face of a tile. */
static size_t row_of(const rg_tile *t, size_t i) {
    return t->row + (i - t->sbegin * RG_LANES);
}

static bool in_one_tile(const rg_domain *d, rg_gid e, rg_gid other) {
    return e / d->tile_elements == other / d->tile_elements;
}

static bool same_geometry(const rg_domain *d, size_t i, size_t j) {
    for (int k = 0; k < RG_IGEOM; k++) {
        if (memcmp(&d->igeom[rg_igeom_index(i, k)], &d->igeom[rg_igeom_index(j, k)], sizeof(double)) != 0) {
            return false;
        }
    }
    return true;
}

/* ---- Elements ---- */

static void check_slots(const setup *s) {
    const rg_domain *d = s->domain;
    size_t real = 0;
    assert_int_equal(d->elements, s->mesh->elements);
    assert_int_equal(d->tiles, (s->mesh->elements + d->tile_elements - 1) / d->tile_elements);
    assert_int_equal(d->boundary_tiles, 0);
    assert_int_equal(d->shared, 0);
    for (rg_gid e = 0; e < s->mesh->elements; e++) {
        size_t slot = slot_of(d, e);
        assert_int_equal(d->id[slot], e);
        assert_int_equal(d->material[slot / RG_LANES], material_of(s->material, e));
        assert_int_equal(d->tile[e / d->tile_elements].first, e / d->tile_elements * d->tile_elements);
        assert_ptr_equal(rg_tile_of(d, slot), &d->tile[e / d->tile_elements]);
        assert_memory_equal(d->set + 4 * slot, s->mesh->set + 4 * e, 4);
        for (int i = 0; i < 4; i++) {
            assert_memory_equal(d->corner + 12 * slot + 3 * i, corner(s->mesh, e, i), 3 * sizeof(double));
        }
    }
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        real += d->id[slot] >= 0;
    }
    assert_int_equal(real, d->elements);
}

/* Whether an element has a neighbour in another tile. */
static bool is_on_rim(const setup *s, rg_gid e) {
    rg_gid tile = e / s->domain->tile_elements;
    for (int f = 0; f < RG_FACES; f++) {
        rg_gid other = s->mesh->neighbour[4 * e + f];
        if (other >= 0 && other / s->domain->tile_elements != tile) {
            return true;
        }
    }
    return false;
}

/* Materials ascend in a tile; of each those on the rim come last; of these and the others the numbers ascend.
 */
static void check_runs(const setup *s) {
    const rg_domain *d = s->domain;
    size_t rims = 0;
    for (size_t t = 0; t < d->tiles; t++) {
        size_t end = 0, blocks = d->tile[t].end - d->tile[t].begin;
        for (size_t begin = 0; begin < blocks; begin = end) {
            end = rg_run_end(d, &d->tile[t], begin);
            const uint16_t *of = d->material + d->tile[t].begin;
            const rg_gid *id = d->id + d->tile[t].begin * RG_LANES;
            assert_true(end > begin && end <= blocks && (begin == 0 || of[begin - 1] < of[begin]));
            rg_gid before = -1;
            for (size_t at = begin * RG_LANES; at < end * RG_LANES; at++) {
                assert_int_equal(of[at / RG_LANES], of[begin]);
                assert_true(at > begin * RG_LANES || id[at] >= 0);
                rg_gid order = id[at] < 0 ? INT64_MAX : id[at] + is_on_rim(s, id[at]) * s->mesh->elements;
                assert_true(id[at] < 0 || order > before);
                before = order;
            }
        }
        assert_int_equal(end, blocks);
    }
    for (size_t b = 0; b < d->blocks; b++) {
        bool rim = false;
        for (size_t at = b * RG_LANES; at < (b + 1) * RG_LANES; at++) {
            rim |= d->id[at] >= 0 && is_on_rim(s, d->id[at]);
        }
        assert_int_equal(d->rim[b], rim);
        rims += rim;
    }
    assert_true(d->tiles == 1 || (rims > 0 && rims <= d->blocks));
}

static void test_runs(void **state) {
    (void)state;
    for_each_setup(check_runs);
}

/* Each tile holds its run of elements; every element has its place. */
static void test_slots(void **state) {
    (void)state;
    for_each_setup(check_slots);
}

static void check_element_geometry(const setup *s) {
    const rg_domain *d = s->domain;
    for (rg_gid e = 0; e < s->mesh->elements; e++) {
        size_t slot = slot_of(d, e);
        double volume = fabs(rg_tet_volume(corner(s->mesh, e, 0), corner(s->mesh, e, 1),
                                           corner(s->mesh, e, 2), corner(s->mesh, e, 3)));
        assert_true(fabs(d->geom[rg_geom_index(slot, RG_GEOM_VOLUME)] - volume) < 1e-14 * volume);
        for (int k = 0; k < 3; k++) { /* l_k falls from 1 at corner k to 0 at the others */
            for (int j = 0; j < 4; j++) {
                double drop = 0;
                for (int c = 0; c < 3; c++) {
                    drop += d->geom[rg_geom_index(slot, RG_GEOM_GRAD + 3 * k + c)] *
                            (corner(s->mesh, e, k)[c] - corner(s->mesh, e, j)[c]);
                }
                assert_true(fabs(drop - (j == k ? 0 : 1)) < 1e-12);
            }
        }
    }
}

/* Volume and gradients of the barycentric coordinates. */
static void test_element_geometry(void **state) {
    (void)state;
    for_each_setup(check_element_geometry);
}

/* ---- Faces ---- */

/* A face inside a tile, from one of its elements. */
static void check_inside(const setup *s, rg_gid e, int f, rg_gid other, int g) {
    const rg_domain *d = s->domain;
    const rg_tile *t = rg_tile_of(d, slot_of(d, e));
    int32_t link = interface_link(d, e, f);
    size_t i = interface_of(d, e, f), first = t->begin * RG_LANES;
    assert_false(is_tile_face(d, t, i) || link & RG_TILE_FACE);
    assert_int_equal(interface_of(d, other, g), i);
    assert_int_equal(interface_link(d, other, g) % 4, 1 - link % 4);
    assert_int_equal(d->side[link % 4][i], rg_side_link(slot_of(d, e) - first, f));
    assert_int_equal(d->neighbour[rg_link_index(slot_of(d, e), f)],
                     rg_neighbour_link(slot_of(d, other) - first, g));
    assert_int_equal(d->counted[i], 1);
}

/* A tile-boundary face, from one of its sides. */
static void check_tile_face(const setup *s, rg_gid e, int f, rg_gid other, int g) {
    const rg_domain *d = s->domain;
    const rg_tile *t = rg_tile_of(d, slot_of(d, e)), *u = rg_tile_of(d, slot_of(d, other));
    int32_t link = interface_link(d, e, f);
    size_t i = interface_of(d, e, f), j = interface_of(d, other, g);
    assert_true(is_tile_face(d, t, i) && is_tile_face(d, u, j) && link & RG_TILE_FACE && i != j);
    assert_int_equal(link & 1, d->side[1][i] & 1);
    assert_int_equal(d->side[1][i] & 1, 1 - (d->side[1][j] & 1));
    assert_int_equal(d->side[1][i] / 2, row_of(u, j));
    assert_int_equal(d->side[1][j] / 2, row_of(t, i));
    assert_int_equal(d->side[0][i], rg_side_link(slot_of(d, e) - t->begin * RG_LANES, f));
    assert_int_equal(d->neighbour[rg_link_index(slot_of(d, e), f)],
                     rg_neighbour_link(i - t->sbegin * RG_LANES, RG_GHOST));
    assert_true(same_geometry(d, i, j));
    assert_int_equal(d->counted[i], e < other);
}

static void check_surface(const setup *s, rg_gid e, int f) {
    const rg_domain *d = s->domain;
    size_t slot = slot_of(d, e), first = rg_tile_of(d, slot)->begin * RG_LANES;
    assert_int_equal(interface_link(d, e, f), RG_NO_INTERFACE);
    assert_int_equal(d->neighbour[rg_link_index(slot, f)], rg_neighbour_link(slot - first, f));
}

static void check_faces(const setup *s) {
    const rg_domain *d = s->domain;
    int *seen = RG_NEW(int, d->iblocks *RG_LANES + 1);
    for (rg_gid at = 0; at < 4 * s->mesh->elements; at++) {
        rg_gid other = s->mesh->neighbour[at];
        if (other < 0) {
            check_surface(s, at / 4, (int)(at % 4));
            continue;
        }
        bool inside = in_one_tile(d, at / 4, other);
        (inside ? check_inside : check_tile_face)(s, at / 4, (int)(at % 4), other, s->mesh->face[at]);
        seen[interface_of(d, at / 4, (int)(at % 4))] += inside ? 1 : 2;
    }
    size_t counted = 0, used = 0, faces = 0;
    for (size_t i = 0; i < d->iblocks * RG_LANES;
         i++) { /* inside: from both elements; tile-boundary face: from its own */
        assert_true(seen[i] == 0 || seen[i] == 2);
        counted += d->counted[i];
        used += seen[i] > 0;
    }
    for (rg_gid at = 0; at < 4 * s->mesh->elements; at++) {
        rg_gid other = s->mesh->neighbour[at];
        faces += other > at / 4 ? (in_one_tile(d, at / 4, other) ? 1 : 2) : 0;
    }
    assert_int_equal(used, faces);
    assert_int_equal(counted, s->part->interfaces);
    assert_int_equal(d->interfaces, counted);
    rg_free(seen);
}

/* Every interior face appears once inside a tile or as exactly two tile-boundary faces with the same
 * geometry, opposite sides and each other's rows; `counted` marks each face once. */
static void test_faces(void **state) {
    (void)state;
    for_each_setup(check_faces);
}

/* Area and penalties of interface i at face f of element e. */
static void check_interface(const setup *s, rg_gid e, int f, rg_gid other, size_t i) {
    const rg_domain *d = s->domain;
    const rg_interface_material *m = s->material;
    int own = material_of(m, e), beside = material_of(m, other);
    double lambda = 0.5 * (matter[own].lambda + matter[beside].lambda);
    double mu = 0.5 * (matter[own].mu + matter[beside].mu);
    double out[3], normal[3], volume[2], sign = interface_link(d, e, f) & 1 ? -1 : 1;
    outward(s->mesh, e, f, out);
    double area = rg_interface_area(d, i, normal);
    const double *x[3] = {corner(s->mesh, e, rg_face_node[f][0]), corner(s->mesh, e, rg_face_node[f][1]),
                          corner(s->mesh, e, rg_face_node[f][2])};
    for (int c = 0; c < 3; c++) {
        assert_true(d->igeom[rg_igeom_index(i, RG_IGEOM_EDGE + c)] == x[1][c] - x[0][c]);
        assert_true(d->igeom[rg_igeom_index(i, RG_IGEOM_EDGE + 3 + c)] == x[2][c] - x[0][c]);
        assert_true(fabs(sign * normal[c] - out[c]) < 1e-14 * area);
    }
    assert_true(fabs(area - sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2])) < 1e-14 * area);
    for (int k = 0; k < 2; k++) {
        rg_gid a = k ? other : e;
        volume[k] = fabs(rg_tet_volume(corner(s->mesh, a, 0), corner(s->mesh, a, 1), corner(s->mesh, a, 2),
                                       corner(s->mesh, a, 3)));
    }
    double h = 3 * fmin(volume[0], volume[1]) / area, scale = m->beta_s / h;
    bool elastic = m->penalty == RG_PENALTY_ELASTIC;
    double iso = area * scale * (elastic ? mu : lambda + 2 * mu);
    double norm = elastic ? scale * (lambda + mu) / area : 0;
    assert_true(fabs(d->igeom[rg_igeom_index(i, RG_IGEOM_PEN_ISO)] - iso) < 1e-13 * iso);
    assert_true(fabs(d->igeom[rg_igeom_index(i, RG_IGEOM_PEN_NORM)] - norm) <= 1e-13 * norm);
    assert_int_equal(d->beside != NULL, m->materials > 1);
    assert_true(d->beside == NULL || (d->beside[i][0] == (own < beside ? own : beside) &&
                                      d->beside[i][1] == (own < beside ? beside : own)));
}

static void check_areas(const setup *s) {
    const rg_domain *d = s->domain;
    for (rg_gid e = 0; e < s->mesh->elements; e++) {
        double sum[3] = {0, 0, 0}, total = 0;
        for (int f = 0; f < RG_FACES; f++) {
            double area[3], length;
            rg_gid other = s->mesh->neighbour[4 * e + f];
            outward(s->mesh, e, f, area);
            if (other >= 0) { /* the domain's: it points from minus to plus */
                size_t i = interface_of(d, e, f);
                check_interface(s, e, f, other, i);
                rg_interface_area(d, i, area);
            }
            length = sqrt(area[0] * area[0] + area[1] * area[1] + area[2] * area[2]);
            total += length;
            for (int c = 0; c < 3; c++) {
                sum[c] += other >= 0 && interface_link(d, e, f) & 1 ? -area[c] : area[c];
            }
        }
        assert_true(fabs(sum[0]) + fabs(sum[1]) + fabs(sum[2]) < 1e-14 * total);
    }
}

/* Area vectors point from minus to plus, those out of an element sum to nothing; penalties as defined. */
static void test_areas(void **state) {
    (void)state;
    for_each_setup(check_areas);
}

/* ---- Tiles ---- */

/* The other tile and element of tile-boundary face i. */
typedef struct {
    size_t tile, place; /* place: index among the other tile's tile-boundary faces */
} across;

static across other_side(const rg_domain *d, size_t i) {
    size_t row = (size_t)d->side[1][i] / 2, t = 0;
    while (t + 1 < d->tiles && d->tile[t + 1].row <= row) {
        t++;
    }
    return (across){t, row - d->tile[t].row};
}

/* Tile-boundary faces of tile t that are used: as many as its elements' faces on other tiles. */
static size_t used_tile_faces(const setup *s, size_t t) {
    const rg_domain *d = s->domain;
    size_t n = 0;
    for (rg_gid at = 4 * d->tile[t].first; at < 4 * s->mesh->elements; at++) {
        if (at / 4 >= d->tile[t].first + d->tile_elements) {
            break;
        }
        n += s->mesh->neighbour[at] >= 0 && !in_one_tile(d, at / 4, s->mesh->neighbour[at]);
    }
    return n;
}

static void check_streams(const setup *s) {
    const rg_domain *d = s->domain;
    for (size_t t = 0; t < d->tiles; t++) {
        size_t first = d->tile[t].sbegin * RG_LANES, n = used_tile_faces(s, t);
        assert_true(first + n <= d->tile[t].iend * RG_LANES);
        for (size_t k = 1; k < n; k++) {
            across before = other_side(d, first + k - 1), here = other_side(d, first + k);
            assert_true(before.tile <= here.tile);
            if (before.tile == here.tile) {
                assert_int_equal(here.place, before.place + 1);
            }
        }
    }
}

/* Tile-boundary faces with one other tile lie side by side, the tiles by ascending number, and in the same
 * order on both sides: their rows are read as a stream. */
static void test_streams(void **state) {
    (void)state;
    for_each_setup(check_streams);
}

static void check_layout(const setup *s) {
    const rg_domain *d = s->domain;
    size_t block = 0, iblock = 0, row = 0, largest = 0, tile_faces = 0, blocks = 0;
    for (size_t t = 0; t < d->tiles; t++) {
        const rg_tile *tile = &d->tile[t];
        assert_true(tile->begin == block && tile->ibegin == iblock && tile->row == row);
        assert_true(tile->end > tile->begin && tile->ibegin <= tile->sbegin);
        assert_int_equal(tile->iend - tile->sbegin, (used_tile_faces(s, t) + RG_LANES - 1) / RG_LANES);
        block = tile->end;
        iblock = tile->iend;
        row += (tile->iend - tile->sbegin) * RG_LANES;
        blocks = tile->end - tile->begin > blocks ? tile->end - tile->begin : blocks;
        largest = tile->iend - tile->ibegin > largest ? tile->iend - tile->ibegin : largest;
        tile_faces = tile->iend - tile->sbegin > tile_faces ? tile->iend - tile->sbegin : tile_faces;
    }
    assert_true(d->blocks == block && d->iblocks == iblock && d->own_rows == row);
    assert_true(d->tile_blocks == blocks && d->tile_iblocks == largest && d->tile_sblocks == tile_faces);
}

/* Blocks and rows of the tiles follow each other without gaps. */
static void test_layout(void **state) {
    (void)state;
    for_each_setup(check_layout);
}

static void check_element_padding(const rg_domain *d, size_t slot) {
    size_t first = rg_tile_of(d, slot)->begin * RG_LANES;
    assert_true(d->geom[rg_geom_index(slot, RG_GEOM_VOLUME)] > 0);
    for (int f = 0; f < RG_FACES; f++) {
        assert_int_equal(d->interface[rg_link_index(slot, f)], RG_NO_INTERFACE);
        assert_int_equal(d->neighbour[rg_link_index(slot, f)], rg_neighbour_link(slot - first, f));
        assert_int_equal(d->set[4 * slot + (size_t)f], -1);
    }
}

/* Interface i of a tile, or its padding: links stay inside the tile, padding has no area and its own row. */
static void check_interface_slot(const rg_domain *d, const rg_tile *t, size_t i, bool padding) {
    size_t slots = (t->end - t->begin) * RG_LANES;
    bool tile_face = is_tile_face(d, t, i);
    assert_true(d->side[0][i] >= 0 && (size_t)d->side[0][i] / 4 < slots);
    assert_true(tile_face || (d->side[1][i] >= 0 && (size_t)d->side[1][i] / 4 < slots));
    for (int k = 0; padding && k < RG_IGEOM; k++) {
        assert_true(d->igeom[rg_igeom_index(i, k)] == 0);
    }
    if (padding && tile_face) {
        assert_int_equal(d->side[1][i] / 2, row_of(t, i));
    }
    assert_true(!padding || !d->counted[i]);
}

static void check_padding(const setup *s) {
    const rg_domain *d = s->domain;
    uint8_t *used = RG_NEW(uint8_t, d->iblocks * RG_LANES + 1);
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        if (d->id[slot] < 0) {
            check_element_padding(d, slot);
        }
    }
    for (rg_gid at = 0; at < 4 * s->mesh->elements; at++) {
        if (s->mesh->neighbour[at] >= 0) {
            used[interface_of(d, at / 4, (int)(at % 4))] = 1;
        }
    }
    for (size_t t = 0; t < d->tiles; t++) {
        for (size_t i = d->tile[t].ibegin * RG_LANES; i < d->tile[t].iend * RG_LANES; i++) {
            check_interface_slot(d, &d->tile[t], i, !used[i]);
        }
    }
    rg_free(used);
}

/* Padding is harmless: elements of their own, interfaces without area that nobody counts or links to. */
static void test_padding(void **state) {
    (void)state;
    for_each_setup(check_padding);
}

int main(int argc, char **argv) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_slots),
        cmocka_unit_test(test_runs),
        cmocka_unit_test(test_element_geometry),
        cmocka_unit_test(test_faces),
        cmocka_unit_test(test_areas),
        cmocka_unit_test(test_streams),
        cmocka_unit_test(test_layout),
        cmocka_unit_test(test_padding),
    };
    MPI_Init(&argc, &argv);
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    MPI_Finalize();
    return failed;
}
