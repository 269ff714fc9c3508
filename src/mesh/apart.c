#include "mesh/apart.h"

#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/input_errors.h"
#include "base/mem.h"
#include "base/union_find.h"
#include "base/vector.h"
#include "layout.h"
#include "mesh/check.h"
#include "mesh/near.h"

/* Of the shorter of two longest edges. Contact begins behind a skin of about this thickness. */
static const double slack = 1e-3;

/* What is no gap, likewise. */
static const double rounding = 1e-9;

/* Faces whose normals are farther from opposite do not touch: cosine. */
static const double facing = 0.97;

/* ---- which ---- */

int32_t rg_mesh_keep_apart(rg_mesh *mesh) {
    int32_t parts = 0;
    size_t vertices = (size_t)mesh->vertices, *up = RG_NEW(size_t, vertices);
    int32_t *number = RG_NEW(int32_t, vertices);
    for (size_t v = 0; v < vertices; v++) {
        up[v] = v;
        number[v] = -1;
    }
    for (rg_gid e = 0; e < mesh->elements; e++) {
        for (int i = 1; i < 4; i++) {
            rg_union_join(up, (size_t)mesh->corner[4 * e], (size_t)mesh->corner[4 * e + i]);
        }
    }
    rg_free(mesh->part);
    mesh->part = RG_NEW(int32_t, (size_t)mesh->elements);
    for (rg_gid e = 0; e < mesh->elements; e++) {
        size_t root = rg_union_root(up, (size_t)mesh->corner[4 * e]);
        number[root] = number[root] < 0 ? parts++ : number[root];
        mesh->part[e] = number[root];
    }
    rg_free(up);
    rg_free(number);
    if (parts < 2) {
        rg_free(mesh->part);
        mesh->part = NULL;
    }
    return parts;
}

int32_t rg_mesh_apart(const rg_mesh *mesh) {
    int32_t parts = 0;
    for (rg_gid e = 0; e < mesh->elements && mesh->part != NULL; e++) {
        parts = mesh->part[e] >= parts ? mesh->part[e] + 1 : parts;
    }
    return parts;
}

int32_t *rg_mesh_vertex_parts(const rg_mesh *mesh) {
    if (mesh->part == NULL) {
        return NULL;
    }
    int32_t *part = RG_NEW(int32_t, (size_t)mesh->vertices);
    for (rg_gid i = 0; i < 4 * mesh->elements; i++) {
        part[mesh->corner[i]] = mesh->part[i / 4];
    }
    return part;
}

/* ---- where ---- */

/* A face of the surface, or an element. */
typedef struct {
    rg_gid slot;    /* 4 * element + face; of an element the first */
    double x[4][3]; /* corners; of a face the last is that of its element */
    double edge;    /* the longest */
    double normal[3];
} piece;

static void fill_box(rg_near_box *box, const piece *p, int corners, int32_t part) {
    box->part = part;
    for (int c = 0; c < 3; c++) {
        box->low[c] = INFINITY;
        box->high[c] = -INFINITY;
        for (int k = 0; k < corners; k++) {
            box->low[c] = fmin(box->low[c], p->x[k][c] - slack * p->edge);
            box->high[c] = fmax(box->high[c], p->x[k][c] + slack * p->edge);
        }
    }
}

static piece get_element(const rg_mesh *mesh, rg_gid e) {
    piece p = {.slot = 4 * e};
    for (int i = 0; i < 4; i++) {
        memcpy(p.x[i], mesh->x + 3 * mesh->corner[4 * e + i], sizeof p.x[i]);
    }
    p.edge = rg_tet_longest_edge((const double *)p.x);
    return p;
}

static piece get_face(const rg_mesh *mesh, rg_gid slot) {
    piece p = {.slot = slot};
    double inward[3];
    for (int k = 0; k < 4; k++) {
        rg_gid corner = mesh->corner[slot / 4 * 4 + (k < 3 ? rg_face_node[slot % 4][k] : slot % 4)];
        memcpy(p.x[k], mesh->x + 3 * corner, sizeof p.x[k]);
    }
    for (int k = 0; k < 3; k++) {
        p.edge = fmax(p.edge, sqrt(rg_vector_distance2(p.x[k], p.x[(k + 1) % 3])));
    }
    rg_vector_normal((const double *)p.x, p.normal);
    rg_vector_subtract(p.x[3], p.x[0], inward);
    double outward = rg_vector_dot(inward, p.normal) > 0 ? -1 : 1;
    for (int c = 0; c < 3; c++) {
        p.normal[c] *= outward;
    }
    return p;
}

/* ---- faces that touch ---- */

enum { MOST_CORNERS = 8 }; /* of what two triangles share */

/* Cuts off what of the polygon is beyond the line through `a` along `n` x (b - a), on the other side than
 * `inside`; returns the number of corners that are left. */
static int cut(double polygon[MOST_CORNERS][3], int corners, const double a[3], const double b[3],
               const double inside[3], const double n[3]) {
    double along[3], across[3], r[3], out[MOST_CORNERS][3];
    int kept = 0;
    rg_vector_subtract(b, a, along);
    rg_vector_cross(n, along, across);
    rg_vector_subtract(inside, a, r);
    double side = rg_vector_dot(across, r) > 0 ? 1 : -1;
    for (int k = 0; k < corners; k++) {
        const double *p = polygon[k], *q = polygon[(k + 1) % corners];
        rg_vector_subtract(p, a, r);
        double from = side * rg_vector_dot(across, r);
        rg_vector_subtract(q, a, r);
        double to = side * rg_vector_dot(across, r);
        if (from >= 0 && kept < MOST_CORNERS) {
            memcpy(out[kept++], p, sizeof out[0]);
        }
        if ((from < 0) != (to < 0) && kept < MOST_CORNERS) {
            for (int c = 0; c < 3; c++) {
                out[kept][c] = p[c] + (q[c] - p[c]) * from / (from - to);
            }
            kept++;
        }
    }
    memcpy(polygon, out, (size_t)kept * sizeof out[0]);
    return kept;
}

/* What two faces share, seen along `n`: its area, middle, and how far b is from a there. */
typedef struct {
    double area, middle[3], gap;
} shared;

static shared overlay(const piece *a, const piece *b, const double n[3]) {
    shared s = {.area = 0};
    double polygon[MOST_CORNERS][3], r[3];
    int corners = 3;
    memcpy(polygon, a->x, 3 * sizeof polygon[0]);
    for (int k = 0; k < 3; k++) {
        corners = cut(polygon, corners, b->x[k], b->x[(k + 1) % 3], b->x[(k + 2) % 3], n);
    }
    for (int k = 2; k < corners; k++) {
        double u[3], v[3], w[3];
        rg_vector_subtract(polygon[k - 1], polygon[0], u);
        rg_vector_subtract(polygon[k], polygon[0], v);
        rg_vector_cross(u, v, w);
        double area = 0.5 * fabs(rg_vector_dot(w, n));
        for (int c = 0; c < 3; c++) {
            s.middle[c] += area * (polygon[0][c] + polygon[k - 1][c] + polygon[k][c]) / 3;
        }
        s.area += area;
    }
    for (int c = 0; c < 3; c++) {
        s.middle[c] /= s.area;
    }
    rg_vector_subtract(b->x[0], s.middle, r);
    s.gap = rg_vector_dot(r, b->normal) / rg_vector_dot(n, b->normal);
    return s;
}

typedef struct {
    piece *face;
    const int32_t *part; /* of an element */
    rg_touch *touch;     /* one for each two faces, whose numbers are in `faces` */
    size_t touches, room;
} touching;

static void look_at_faces(void *context, int64_t i, int64_t j) {
    touching *t = context;
    const piece *a = &t->face[i], *b = &t->face[j];
    double n[3], edge = fmin(a->edge, b->edge);
    if (rg_vector_dot(a->normal, b->normal) > -facing) {
        return;
    }
    rg_vector_subtract(a->normal, b->normal, n);
    double length = sqrt(rg_vector_dot(n, n));
    for (int c = 0; c < 3; c++) {
        n[c] /= length;
    }
    shared s = overlay(a, b, n);
    if (s.area > slack * slack * edge * edge && fabs(s.gap) <= slack * edge) {
        t->touch = rg_grow(t->touch, &t->room, t->touches, sizeof *t->touch);
        s.gap = fabs(s.gap) > rounding * edge ? s.gap : 0;
        rg_touch *new = &t->touch[t->touches++];
        *new = (rg_touch){.part = {t->part[a->slot / 4], t->part[b->slot / 4]},
                          .faces = {i, j},
                          .area = s.area,
                          .gap = {s.gap, s.gap}};
        memcpy(new->place, s.middle, sizeof new->place);
    }
}

static int by_parts(const void *a, const void *b) {
    const rg_touch *p = a, *q = b;
    int k = p->part[0] == q->part[0], f = p->faces[0] == q->faces[0];
    if (p->part[k] != q->part[k]) {
        return p->part[k] < q->part[k] ? -1 : 1;
    }
    return (p->faces[f] > q->faces[f]) - (p->faces[f] < q->faces[f]);
}

/* One touch of all those of the same two parts; seen[face] is the last one that counted a face. */
static rg_touch sum_up(const rg_touch *from, size_t count, size_t *seen, size_t number) {
    rg_touch all = {.part = {from->part[0], from->part[1]}, .gap = {INFINITY, -INFINITY}};
    for (size_t i = 0; i < count; i++) {
        const rg_touch *t = from + i;
        for (int k = 0; k < 2; k++) {
            all.faces[k] += seen[t->faces[k]] != number;
            seen[t->faces[k]] = number;
        }
        for (int c = 0; c < 3; c++) {
            all.place[c] += t->area * t->place[c];
        }
        all.area += t->area;
        all.gap[0] = fmin(all.gap[0], t->gap[0]);
        all.gap[1] = fmax(all.gap[1], t->gap[1]);
    }
    for (int c = 0; c < 3; c++) {
        all.place[c] /= all.area;
    }
    return all;
}

rg_touch *rg_mesh_touches(const rg_mesh *mesh, size_t *count) {
    touching t = {.part = mesh->part};
    int64_t faces = 0;
    size_t pairs = 0, slots = 4 * (size_t)mesh->elements;
    *count = 0;
    if (mesh->part == NULL) {
        return NULL;
    }
    for (size_t s = 0; s < slots; s++) {
        faces += mesh->neighbour[s] < 0;
    }
    t.face = RG_NEW(piece, (size_t)faces + 1);
    rg_near_box *box = RG_NEW(rg_near_box, (size_t)faces + 1);
    faces = 0;
    for (size_t s = 0; s < slots; s++) {
        if (mesh->neighbour[s] < 0) {
            t.face[faces] = get_face(mesh, (rg_gid)s);
            fill_box(&box[faces], &t.face[faces], 3, mesh->part[s / 4]);
            faces++;
        }
    }
    rg_near_pairs(box, faces, look_at_faces, &t);
    if (t.touches > 0) {
        qsort(t.touch, t.touches, sizeof *t.touch, by_parts);
    }
    size_t *seen = RG_NEW(size_t, (size_t)faces + 1);
    for (size_t i = 0, n; i < t.touches; i += n) {
        for (n = 1;
             i + n < t.touches && memcmp(t.touch[i + n].part, t.touch[i].part, sizeof t.touch->part) == 0;
             n++) {
        }
        rg_touch all = sum_up(t.touch + i, n, seen, pairs + 1);
        t.touch[pairs++] = all;
    }
    rg_free(seen);
    rg_free(box);
    rg_free(t.face);
    *count = pairs;
    return t.touch;
}

/* ---- elements that overlap ---- */

/* How far two elements lie in each other along `axis`, of any length; INFINITY where that has none. */
static double depth_along(const piece *a, const piece *b, const double axis[3], double shortest) {
    double length = sqrt(rg_vector_dot(axis, axis)), low[2] = {INFINITY, INFINITY},
           high[2] = {-INFINITY, -INFINITY};
    if (!(length > shortest)) {
        return INFINITY;
    }
    for (int k = 0; k < 8; k++) {
        double at = rg_vector_dot(axis, k < 4 ? a->x[k] : b->x[k - 4]) / length;
        low[k / 4] = fmin(low[k / 4], at);
        high[k / 4] = fmax(high[k / 4], at);
    }
    return fmin(high[0] - low[1], high[1] - low[0]);
}

/* How far two elements lie in each other: the shortest way apart, which is along a normal of a face of one or
 * of an edge of each; not above 0 where they do not. */
static double depth_of(const piece *a, const piece *b) {
    static const int edge[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
    double along[2][6][3], axis[3], depth = INFINITY;
    double shortest = 1e-6 * a->edge * b->edge; /* of edges as good as parallel */
    for (int k = 0; k < 6; k++) {
        rg_vector_subtract(a->x[edge[k][1]], a->x[edge[k][0]], along[0][k]);
        rg_vector_subtract(b->x[edge[k][1]], b->x[edge[k][0]], along[1][k]);
    }
    static const int face[4][2] = {{0, 1}, {0, 2}, {1, 2}, {3, 4}}; /* two of the edges of each */
    for (int k = 0; k < 8 && depth > 0; k++) {
        const double(*e)[3] = (const double(*)[3])along[k / 4];
        rg_vector_cross(e[face[k % 4][0]], e[face[k % 4][1]], axis);
        depth = fmin(depth, depth_along(a, b, axis, 0));
    }
    for (int k = 0; k < 36 && depth > 0; k++) {
        rg_vector_cross(along[0][k / 6], along[1][k % 6], axis);
        depth = fmin(depth, depth_along(a, b, axis, shortest));
    }
    return depth;
}

typedef struct {
    int32_t part[2];
    rg_gid element[2];
    double depth;
} overlap;

typedef struct {
    const rg_mesh *mesh;
    overlap *found;
    size_t count, room;
} overlapping;

static void look_at_elements(void *context, int64_t i, int64_t j) {
    overlapping *o = context;
    piece a = get_element(o->mesh, i), b = get_element(o->mesh, j);
    double depth = depth_of(&a, &b);
    if (depth > slack * fmin(a.edge, b.edge)) {
        o->found = rg_grow(o->found, &o->room, o->count, sizeof *o->found);
        o->found[o->count++] = (overlap){{o->mesh->part[i], o->mesh->part[j]}, {i, j}, depth};
    }
}

/* Of two parts the deepest first. */
static int by_depth(const void *a, const void *b) {
    const overlap *p = a, *q = b;
    int k = p->part[0] == q->part[0], e = p->element[0] == q->element[0];
    if (p->part[k] != q->part[k]) {
        return p->part[k] < q->part[k] ? -1 : 1;
    }
    if (p->depth < q->depth || p->depth > q->depth) {
        return p->depth > q->depth ? -1 : 1;
    }
    return (p->element[e] > q->element[e]) - (p->element[e] < q->element[e]);
}

void rg_mesh_check_overlaps(const rg_mesh *mesh, const char *name) {
    overlapping o = {.mesh = mesh};
    rg_input_errors input_errors = {.name = name};
    if (mesh->part == NULL) {
        return;
    }
    rg_near_box *box = RG_NEW(rg_near_box, (size_t)mesh->elements);
    for (rg_gid e = 0; e < mesh->elements; e++) {
        piece p = get_element(mesh, e);
        fill_box(&box[e], &p, 4, mesh->part[e]);
    }
    rg_near_pairs(box, mesh->elements, look_at_elements, &o);
    rg_free(box);
    if (o.count > 0) {
        qsort(o.found, o.count, sizeof *o.found, by_depth);
    }
    for (size_t i = 0; i < o.count; i++) {
        const overlap *f = &o.found[i];
        const double *x = mesh->x + 3 * mesh->corner[4 * f->element[0]];
        if (i == 0 || memcmp(f->part, f[-1].part, sizeof f->part) != 0) {
            rg_input_errors_add(&input_errors, f->part[0], f->part[1],
                                "parts %d and %d lie in each other: elements %" PRId64 " and %" PRId64
                                " by %.3g m, at (%.9g, %.9g, %.9g) m",
                                f->part[0] + 1, f->part[1] + 1, rg_mesh_original(mesh, f->element[0]),
                                rg_mesh_original(mesh, f->element[1]), f->depth, x[0], x[1], x[2]);
        }
    }
    rg_free(o.found);
    rg_input_errors_end(&input_errors);
}
