#include "mesh/import/crack.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/tet.h"
#include "base/union_find.h"
#include "base/vector.h"
#include "layout.h"
#include "mesh/import/merge.h"

static const double same_place = 1e-9; /* of the mesh's size, as in mesh/check.c */

/* A face of the surface. */
typedef struct {
    rg_gid place[4]; /* ascending: of each vertex the lowest one at its place; then the part */
    rg_gid slot;
} side;

static int by_place(const void *a, const void *b) {
    const side *p = a, *q = b;
    for (int k = 0; k < 4; k++) {
        if (p->place[k] != q->place[k]) {
            return p->place[k] < q->place[k] ? -1 : 1;
        }
    }
    return (p->slot > q->slot) - (p->slot < q->slot);
}

static bool same_face(const side *a, const side *b) {
    return memcmp(a->place, b->place, sizeof a->place) == 0;
}

/* [vertices]: the lowest vertex at the place of each. */
static size_t *find_places(const rg_mesh *mesh) {
    double box[2][3];
    size_t count = (size_t)mesh->vertices, *place = RG_NEW(size_t, count);
    rg_mesh_box_around(mesh, box);
    for (size_t v = 0; v < count; v++) {
        place[v] = v;
    }
    rg_merge(count, mesh->x, same_place * sqrt(rg_vector_distance2(box[0], box[1])), place);
    return place;
}

static rg_gid vertex_of(const rg_mesh *mesh, rg_gid slot, int k) {
    return mesh->corner[slot / 4 * 4 + rg_face_node[slot % 4][k]];
}

static int ascending(const void *a, const void *b) {
    const rg_gid *p = a, *q = b;
    return (*p > *q) - (*p < *q);
}

/* The faces of the surface that do not lie alone, by their places: those before and behind are not of one. */
static side *list_sides(const rg_mesh *mesh, const size_t *place, size_t *count) {
    size_t slots = 4 * (size_t)mesh->elements, kept = 0;
    side *list = RG_NEW(side, slots + 1);
    *count = 0;
    for (size_t s = 0; s < slots; s++) {
        if (mesh->neighbour[s] >= 0) {
            continue;
        }
        side *new = &list[(*count)++];
        *new = (side){.place = {0, 0, 0, mesh->part != NULL ? mesh->part[s / 4] : 0}, .slot = (rg_gid)s};
        for (int k = 0; k < 3; k++) {
            new->place[k] = (rg_gid)place[vertex_of(mesh, (rg_gid)s, k)];
        }
        qsort(new->place, 3, sizeof *new->place, ascending);
    }
    qsort(list, *count, sizeof *list, by_place);
    for (size_t i = 0, n; i < *count; i += n) {
        for (n = 1; i + n < *count && same_face(&list[i], &list[i + n]); n++) {
        }
        if (n == 2) { /* three are an error that connecting would tell worse than the check of places does */
            list[kept++] = list[i];
            list[kept++] = list[i + 1];
        }
    }
    *count = kept;
    return list;
}

/* Whether the elements of two faces at the same place are on both sides of it. */
static bool face_each_other(const rg_mesh *mesh, rg_gid one, rg_gid other) {
    double volume[2];
    for (int k = 0; k < 2; k++) {
        rg_gid slot = k == 0 ? one : other;
        volume[k] = rg_tet_volume(
            mesh->x + 3 * vertex_of(mesh, one, 0), mesh->x + 3 * vertex_of(mesh, one, 1),
            mesh->x + 3 * vertex_of(mesh, one, 2), mesh->x + 3 * mesh->corner[slot / 4 * 4 + slot % 4]);
    }
    return (volume[0] > 0) != (volume[1] > 0);
}

/* ---- joining ---- */

/* The vertices of two faces that are at the same places become the lower ones. */
static void join_vertices(const rg_mesh *mesh, const size_t *place, rg_gid one, rg_gid other, size_t *up) {
    for (int k = 0; k < 9; k++) {
        rg_gid v = vertex_of(mesh, one, k / 3), w = vertex_of(mesh, other, k % 3);
        if (place[v] == place[w]) {
            rg_union_join(up, (size_t)v, (size_t)w);
        }
    }
}

/* Puts the corners of an element in ascending order again, and with each the set of the face opposite to it.
 */
static void order_corners(rg_mesh *mesh, rg_gid e) {
    rg_gid *corner = mesh->corner + 4 * e;
    int32_t *set = mesh->set + 4 * e;
    for (int i = 1; i < 4; i++) {
        for (int k = i; k > 0 && corner[k] < corner[k - 1]; k--) {
            rg_gid vertex = corner[k];
            int32_t group = set[k];
            corner[k] = corner[k - 1];
            set[k] = set[k - 1];
            corner[k - 1] = vertex;
            set[k - 1] = group;
        }
    }
}

/* Tuples of vertices by their new numbers, ascending again. */
static void renumber_tuples(rg_gid *vertex, size_t tuples, size_t width, const rg_gid *number) {
    for (size_t i = 0; i < width * tuples; i++) {
        vertex[i] = number[vertex[i]];
    }
    for (size_t i = 0; i < tuples; i++) {
        qsort(vertex + width * i, width, sizeof *vertex, ascending);
    }
}

/* Vertices become those that stand for them, and close the ranks; returns the new number of each. */
static rg_gid *renumber(rg_mesh *mesh, size_t *up) {
    rg_gid kept = 0, *number = RG_NEW(rg_gid, (size_t)mesh->vertices);
    for (rg_gid v = 0; v < mesh->vertices; v++) { /* the root is the lowest */
        rg_gid root = (rg_gid)rg_union_root(up, (size_t)v);
        if (root == v) {
            memmove(mesh->x + 3 * kept, mesh->x + 3 * v, 3 * sizeof *mesh->x);
        }
        number[v] = root == v ? kept++ : number[root];
    }
    for (rg_gid i = 0; i < 4 * mesh->elements; i++) {
        mesh->corner[i] = number[mesh->corner[i]];
    }
    renumber_tuples(mesh->inner, mesh->inners, 3, number);
    renumber_tuples(mesh->line, mesh->lines, 2, number);
    for (rg_gid e = 0; e < mesh->elements; e++) {
        order_corners(mesh, e);
    }
    mesh->vertices = kept;
    return number;
}

/* ---- the set ---- */

/* The set of that name, one more if there is none: the numbers of combinations move up then. */
static int32_t set_of(rg_mesh *mesh, const char *name) {
    int32_t set = rg_sets_find(&mesh->surface, name);
    if (set < 0) {
        set = rg_sets_add(&mesh->surface, name);
        for (rg_gid slot = 0; slot < 4 * mesh->elements; slot++) {
            mesh->set[slot] += mesh->set[slot] >= set;
        }
    }
    return set;
}

/* Both sides of a face are in the sets of either, and in the crack's. */
static void put(rg_mesh *mesh, rg_sets_joining *joining, rg_gid slot, int32_t set) {
    rg_gid beyond = 4 * mesh->neighbour[slot] + mesh->face[slot];
    int32_t group = mesh->set[slot], count;
    const int32_t *member = rg_sets_of(&mesh->surface, &mesh->set[beyond], &count);
    int32_t *copy = RG_NEW(int32_t, (size_t)count + 1);
    memcpy(copy, member, (size_t)count * sizeof *copy);
    for (int32_t k = 0; k < count; k++) {
        group = rg_sets_join(joining, group, copy[k]);
    }
    rg_free(copy);
    group = rg_sets_join(joining, group, set);
    mesh->set[slot] = mesh->set[beyond] = group;
}

static double area_of(const rg_mesh *mesh, rg_gid slot, double middle[3]) {
    double u[3], v[3], n[3];
    const double *x = mesh->x + 3 * vertex_of(mesh, slot, 0), *y = mesh->x + 3 * vertex_of(mesh, slot, 1),
                 *z = mesh->x + 3 * vertex_of(mesh, slot, 2);
    rg_vector_subtract(y, x, u);
    rg_vector_subtract(z, x, v);
    rg_vector_cross(u, v, n);
    for (int c = 0; c < 3; c++) {
        middle[c] = (x[c] + y[c] + z[c]) / 3;
    }
    return 0.5 * sqrt(rg_vector_dot(n, n));
}

/* The face of element e that is opposite to a vertex. */
static rg_gid slot_opposite(const rg_mesh *mesh, rg_gid e, rg_gid vertex) {
    rg_gid slot = 4 * e;
    while (mesh->corner[slot] != vertex) {
        slot++;
    }
    return slot;
}

/* An element and the corner that is opposite to its face on the crack. */
typedef struct {
    rg_gid element, vertex;
} joined;

static void put_all(rg_mesh *mesh, const joined *list, const rg_gid *number, int32_t set,
                    rg_mesh_crack *crack) {
    rg_sets_joining joining = {.sets = &mesh->surface};
    for (int64_t i = 0; i < crack->faces; i++) {
        double middle[3];
        rg_gid slot = slot_opposite(mesh, list[i].element, number[list[i].vertex]);
        put(mesh, &joining, slot, set);
        double area = area_of(mesh, slot, middle);
        crack->area += area;
        for (int c = 0; c < 3; c++) {
            crack->place[c] += area * middle[c];
        }
    }
    for (int c = 0; c < 3; c++) {
        crack->place[c] /= crack->area;
    }
    rg_sets_joined(&joining);
}

rg_mesh_crack rg_mesh_take_crack(rg_mesh *mesh, const char *name) {
    rg_mesh_crack crack = {.faces = 0};
    size_t count, *place = find_places(mesh);
    side *side_of = list_sides(mesh, place, &count);
    size_t *up = RG_NEW(size_t, (size_t)mesh->vertices);
    joined *list = RG_NEW(joined, count + 1);
    for (rg_gid v = 0; v < mesh->vertices; v++) {
        up[v] = (size_t)v;
    }
    for (size_t i = 0; i < count; i += 2) {
        rg_gid one = side_of[i].slot, other = side_of[i + 1].slot;
        if (face_each_other(mesh, one, other)) {
            join_vertices(mesh, place, one, other, up);
            list[crack.faces++] = (joined){one / 4, mesh->corner[one]};
        }
    }
    if (crack.faces > 0) {
        int32_t set = set_of(mesh, name);
        rg_gid *number = renumber(mesh, up);
        rg_mesh_connect(mesh);
        put_all(mesh, list, number, set, &crack);
        mesh->crack = set + 1;
        rg_free(number);
    }
    rg_free(place);
    rg_free(side_of);
    rg_free(up);
    rg_free(list);
    return crack;
}
