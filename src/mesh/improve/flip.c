#include "mesh/improve/flip.h"

#include <math.h>
#include <string.h>

#include "base/tet.h"
#include "layout.h"

enum { MOST_RING = 11 };

static const double worth = 1e-3, /* relative gain that is worth a change */
    flat = 1e-9; /* volume, relative to the product of edges, of a flat pair of surface faces */

/* ---- the ring around an edge ---- */

typedef struct {
    rg_gid a, b;
    int tets;
    rg_gid tet[MOST_RING]; /* tet[i] has vertex[i] and vertex[i + 1] */
    int vertices;          /* one more than tetrahedra where the edge is on the surface */
    rg_gid vertex[MOST_RING + 1];
    double height; /* smallest (m) */
} ring;

/* The two corners of a tetrahedron besides a and b, so that (a, b, p, q) is right-handed. */
static void other_corners(const rg_tet *tet, rg_gid a, rg_gid b, rg_gid *p, rg_gid *q) {
    static const int8_t rest[4][4][2] = {{{0, 0}, {2, 3}, {3, 1}, {1, 2}},
                                         {{3, 2}, {0, 0}, {0, 3}, {2, 0}},
                                         {{1, 3}, {3, 0}, {0, 0}, {0, 1}},
                                         {{2, 1}, {0, 2}, {1, 0}, {0, 0}}};
    const int8_t *place = rest[rg_tets_find(tet, a)][rg_tets_find(tet, b)];
    *p = tet->corner[place[0]];
    *q = tet->corner[place[1]];
}

/* Orders the links p -> q of the tetrahedra into a chain that begins at `first`. */
static bool chain(ring *r, const rg_gid (*link)[2], const rg_gid *tet, rg_gid first) {
    rg_gid at = first;
    for (int n = 0; n < r->tets; n++) {
        int i = 0;
        while (i < r->tets && link[i][0] != at) {
            i++;
        }
        if (i == r->tets) {
            return false;
        }
        r->vertex[n] = at;
        r->tet[n] = tet[i];
        at = link[i][1];
    }
    r->vertex[r->tets] = at;
    r->vertices = at == first ? r->tets : r->tets + 1;
    return true;
}

/* False if the tetrahedra around the edge are too many, or not one ring or fan. */
static bool make_ring(const rg_tets *t, rg_gid a, rg_gid b, ring *r) {
    rg_gid tet[MOST_RING], link[MOST_RING][2], first = -1;
    *r = (ring){.a = a, .b = b, .height = INFINITY};
    r->tets = rg_tets_around(t, a, b, MOST_RING, tet);
    if (r->tets > MOST_RING) {
        return false;
    }
    for (int i = 0; i < r->tets; i++) {
        other_corners(t->tet + tet[i], a, b, &link[i][0], &link[i][1]);
        r->height = fmin(r->height, t->tet[tet[i]].height);
    }
    for (int i = 0; i < r->tets; i++) {
        bool reached = false;
        for (int k = 0; k < r->tets; k++) {
            reached = reached || link[k][1] == link[i][0];
        }
        first = reached ? first : link[i][0];
    }
    return chain(r, (const rg_gid(*)[2])link, tet, first >= 0 ? first : link[0][0]);
}

/* Label of the face (a, b, vertex i) as its tetrahedron has it. */
static int32_t spoke_label(const rg_tets *t, const ring *r, int i) {
    bool last = i > 0 && i == r->tets; /* of a fan */
    const rg_tet *tet = t->tet + r->tet[last ? i - 1 : i];
    rg_gid opposite = r->vertex[last ? i - 1 : (i + 1) % r->vertices];
    return tet->label[rg_tets_find(tet, opposite)];
}

static bool in_one_plane(const rg_tets *t, const ring *r) {
    const double *x[4] = {rg_tets_at(t, r->a), rg_tets_at(t, r->b), rg_tets_at(t, r->vertex[0]),
                          rg_tets_at(t, r->vertex[r->tets])};
    double size = 0;
    for (int i = 0; i < 3; i++) {
        size = fmax(size, fmax(fabs(x[1][i] - x[0][i]), fabs(x[3][i] - x[2][i])));
    }
    return fabs(rg_tet_volume(x[0], x[1], x[2], x[3])) <= flat * size * size * size;
}

/* Whether the edge and the faces that meet in it may go: it has no name, and none has a label, but for the
 * ends of a fan, which must be in one set and plane. */
static bool may_go(const rg_tets *t, const ring *r) {
    if (rg_tets_is_line(t, r->a, r->b)) {
        return false;
    }
    bool fan = r->vertices > r->tets;
    for (int i = fan ? 1 : 0; i < r->tets; i++) {
        if (spoke_label(t, r, i) != 0) {
            return false;
        }
    }
    return !fan || (spoke_label(t, r, 0) == spoke_label(t, r, r->tets) && r->tets > 1 && in_one_plane(t, r));
}

/* ---- the best triangles ---- */

/* Smallest height that triangles over vertices i .. k can leave, and the third vertex of the one at (i, k).
 */
typedef struct {
    double height[MOST_RING + 1][MOST_RING + 1];
    int third[MOST_RING + 1][MOST_RING + 1];
} triangles;

static double pair_height(const rg_tets *t, const ring *r, int i, int j, int k) {
    rg_gid up[4] = {r->vertex[i], r->vertex[j], r->vertex[k], r->b};
    rg_gid down[4] = {r->vertex[j], r->vertex[i], r->vertex[k], r->a};
    return fmin(rg_tets_height(t, up), rg_tets_height(t, down));
}

static void choose(const rg_tets *t, const ring *r, triangles *best) {
    for (int width = 1; width < r->vertices; width++) {
        for (int i = 0; i + width < r->vertices; i++) {
            int k = i + width;
            best->height[i][k] = width == 1 ? INFINITY : -INFINITY;
            best->third[i][k] = -1;
            for (int j = i + 1; j < k; j++) {
                double height = fmin(best->height[i][j], best->height[j][k]);
                height = fmin(height, pair_height(t, r, i, j, k));
                if (height > best->height[i][k]) {
                    best->height[i][k] = height;
                    best->third[i][k] = j;
                }
            }
        }
    }
}

static int list_pairs(const ring *r, const triangles *best, int i, int k, int count, rg_gid (*corner)[4]) {
    if (k - i < 2) {
        return count;
    }
    int j = best->third[i][k];
    rg_gid up[4] = {r->vertex[i], r->vertex[j], r->vertex[k], r->b};
    rg_gid down[4] = {r->vertex[j], r->vertex[i], r->vertex[k], r->a};
    memcpy(corner[count], up, sizeof up);
    memcpy(corner[count + 1], down, sizeof down);
    count = list_pairs(r, best, i, j, count + 2, corner);
    return list_pairs(r, best, j, k, count, corner);
}

bool rg_tets_remove_edge(rg_tets *t, rg_gid a, rg_gid b) {
    ring r;
    triangles best;
    if (!make_ring(t, a, b, &r) || r.vertices < 3 || !may_go(t, &r)) {
        return false;
    }
    int last = r.vertices - 1;
    choose(t, &r, &best);
    if (!(best.height[0][last] > r.height * (1 + worth))) {
        return false;
    }
    rg_gid corner[2 * MOST_RING][4];
    int count = list_pairs(&r, &best, 0, last, 0, corner);
    int32_t label = spoke_label(t, &r, 0);
    rg_labelled_face ends[2] = {rg_labelled_face_of(a, r.vertex[0], r.vertex[last], label),
                                rg_labelled_face_of(b, r.vertex[0], r.vertex[last], label)};
    rg_tets_replace(t, r.tets, r.tet, count, (const rg_gid(*)[4])corner, r.vertices > r.tets ? 2 : 0, ends);
    return true;
}

/* ---- faces ---- */

/* The tetrahedron across face f, -1 if there is none. */
static rg_gid across(const rg_tets *t, rg_gid tet, int f) {
    const rg_gid *corner = t->tet[tet].corner;
    const int *node = rg_face_node[f];
    const rg_star *star = t->star + corner[node[0]];
    for (int i = 0; i < star->count; i++) {
        const rg_tet *other = t->tet + star->tet[i];
        if (star->tet[i] != tet && rg_tets_find(other, corner[node[1]]) >= 0 &&
            rg_tets_find(other, corner[node[2]]) >= 0) {
            return star->tet[i];
        }
    }
    return -1;
}

bool rg_tets_remove_face(rg_tets *t, rg_gid tet, int f) {
    /* so that (q, p, r, apex) is right-handed */
    static const int8_t turn[4][3] = {{3, 1, 2}, {2, 0, 3}, {3, 0, 1}, {1, 0, 2}};
    rg_gid other = t->tet[tet].label[f] == 0 ? across(t, tet, f) : -1;
    if (other < 0) {
        return false;
    }
    const rg_tet *lower = t->tet + tet, *upper = t->tet + other;
    rg_gid face[3] = {lower->corner[turn[f][0]], lower->corner[turn[f][1]], lower->corner[turn[f][2]]};
    rg_gid a = lower->corner[f], b = -1, corner[3][4];
    for (int i = 0; i < 4; i++) {
        b = rg_tets_find(lower, upper->corner[i]) < 0 ? upper->corner[i] : b;
    }
    double height = INFINITY;
    for (int i = 0; i < 3; i++) {
        rg_gid c[4] = {a, b, face[i], face[(i + 1) % 3]};
        memcpy(corner[i], c, sizeof c);
        height = fmin(height, rg_tets_height(t, c));
    }
    if (!(height > fmin(lower->height, upper->height) * (1 + worth))) {
        return false;
    }
    rg_gid old[2] = {tet, other};
    rg_tets_replace(t, 2, old, 3, (const rg_gid(*)[4])corner, 0, NULL);
    return true;
}
