#include "mesh/improve/move.h"

#include <math.h>
#include <string.h>

#include "base/vector.h"
#include "layout.h"

enum { MOST_TETS = 128, MOST_EDGES = 64, STEPS = 20, HALVINGS = 7, HULL_STEPS = 30 };

static const double widest = 0.1,
                    narrowest = 2e-2, /* heights up to so much above the smallest one count as near it */
    in_plane = 1e-6, /* sine of the angle below which faces are in one plane, edges in one line */
    worth = 1e-3;    /* relative gain that is worth a step */

/* ---- where a vertex may go ---- */

/* Projector on the directions in which a vertex may move. */
typedef struct {
    double p[3][3];
} freedom;

static void project(const freedom *f, const double a[3], double out[3]) {
    double result[3];
    for (int i = 0; i < 3; i++) {
        result[i] = rg_vector_dot(f->p[i], a);
    }
    memcpy(out, result, sizeof result);
}

static void add(double a[3], double factor, const double b[3]) {
    for (int i = 0; i < 3; i++) {
        a[i] += factor * b[i];
    }
}

/* Takes the direction n (of length 1) away. */
static void forbid(freedom *f, const double n[3]) {
    double m[3];
    project(f, n, m);
    double square = rg_vector_dot(m, m);
    if (square < in_plane * in_plane) {
        return;
    }
    for (int i = 0; i < 3; i++) {
        add(f->p[i], -m[i] / square, m);
    }
    /* what is left of nothing is rounding */
    if (f->p[0][0] + f->p[1][1] + f->p[2][2] < 0.5) {
        memset(f, 0, sizeof *f);
    }
}

/* Leaves at most the direction of the edge e (of length 1). */
static void confine(freedom *f, const double e[3]) {
    double m[3];
    project(f, e, m);
    memset(f, 0, sizeof *f);
    if (rg_vector_dot(m, m) > 1 - in_plane * in_plane) {
        for (int i = 0; i < 3; i++) {
            add(f->p[i], e[i], e);
        }
    }
}

/* An edge of labelled faces at the vertex, by its other end. */
typedef struct {
    rg_gid end;
    int32_t label;
    bool differ;
    int faces; /* twice their number: a kept face is met from both sides */
} face_edge;

typedef struct {
    int count;
    face_edge edge[MOST_EDGES];
} face_edges;

static bool note_edge(face_edges *list, rg_gid end, int32_t label) {
    int i = 0;
    while (i < list->count && list->edge[i].end != end) {
        i++;
    }
    if (i == MOST_EDGES) {
        return false;
    }
    if (i == list->count) {
        list->edge[list->count++] = (face_edge){end, label, false, 0};
    }
    list->edge[i].differ = list->edge[i].differ || list->edge[i].label != label;
    list->edge[i].faces += label < RG_SURFACE ? 1 : 2;
    return true;
}

static void normalise(double v[3]) {
    double length = sqrt(rg_vector_dot(v, v));
    for (int i = 0; i < 3; i++) {
        v[i] /= length;
    }
}

static void face_normal(const rg_tets *t, const rg_gid v[3], double n[3]) {
    double u[3], w[3];
    rg_vector_subtract(rg_tets_at(t, v[1]), rg_tets_at(t, v[0]), u);
    rg_vector_subtract(rg_tets_at(t, v[2]), rg_tets_at(t, v[0]), w);
    rg_vector_cross(u, w, n);
    normalise(n);
}

/* Named edges hold the vertex on their line, and at its end. */
static void confine_to_lines(const rg_tets *t, rg_gid vertex, freedom *f) {
    const rg_star *star = t->star + vertex;
    rg_gid first = -1;
    bool goes_on = false;
    for (int i = 0; i < (t->on_line != NULL && t->on_line[vertex] ? 4 * star->count : 0); i++) {
        rg_gid end = t->tet[star->tet[i / 4]].corner[i % 4];
        if (end != vertex && rg_tets_is_line(t, vertex, end)) {
            double e[3];
            rg_vector_subtract(rg_tets_at(t, end), rg_tets_at(t, vertex), e);
            normalise(e);
            confine(f, e);
            goes_on = goes_on || (first >= 0 && end != first);
            first = end;
        }
    }
    if (first >= 0 && !goes_on) {
        memset(f, 0, sizeof *f);
    }
}

/* Faces with labels hold the vertex in their planes; edges where labels change, or where not two such faces
 * meet, hold it on their line. */
static freedom freedom_of(const rg_tets *t, rg_gid vertex) {
    freedom f = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    face_edges list = {.count = 0};
    const rg_star *star = t->star + vertex;
    for (int i = 0; i < star->count; i++) {
        const rg_tet *tet = t->tet + star->tet[i];
        for (int k = 0; k < 4; k++) {
            rg_gid v[3] = {tet->corner[rg_face_node[k][0]], tet->corner[rg_face_node[k][1]],
                           tet->corner[rg_face_node[k][2]]};
            if (tet->label[k] == 0 || tet->corner[k] == vertex) {
                continue;
            }
            double n[3];
            face_normal(t, v, n);
            forbid(&f, n);
            for (int j = 0; j < 3; j++) {
                if (v[j] != vertex && !note_edge(&list, v[j], tet->label[k])) {
                    return (freedom){{{0}}};
                }
            }
        }
    }
    confine_to_lines(t, vertex, &f);
    for (int i = 0; i < list.count; i++) {
        if (list.edge[i].differ || list.edge[i].faces != 4) {
            double e[3];
            rg_vector_subtract(rg_tets_at(t, list.edge[i].end), rg_tets_at(t, vertex), e);
            normalise(e);
            confine(&f, e);
        }
    }
    return f;
}

/* ---- heights and their gradients ---- */

typedef struct {
    int count;
    double height[4 * MOST_TETS], gradient[4 * MOST_TETS][3];
} heights;

/* Corners p[3] and twice the area of a face, as a vector. */
static double face_of(const rg_tets *t, const rg_tet *tet, int f, const double *p[3], double n[3]) {
    double u[3], w[3];
    for (int i = 0; i < 3; i++) {
        p[i] = rg_tets_at(t, tet->corner[rg_face_node[f][i]]);
    }
    rg_vector_subtract(p[1], p[0], u);
    rg_vector_subtract(p[2], p[0], w);
    rg_vector_cross(u, w, n);
    return sqrt(rg_vector_dot(n, n));
}

/* Heights of a tetrahedron whose corner `at` moves: 3 V over the areas. The gradient of 6 V is the vector of
 * the opposite face. */
static void take_heights(const rg_tets *t, const rg_tet *tet, int at, heights *h) {
    const double *x = rg_tets_at(t, tet->corner[at]), *p[3];
    double slope[3], away[3], area = face_of(t, tet, at, p, slope);
    rg_vector_subtract(x, p[0], away);
    double volume = rg_vector_dot(away, slope), sign = volume < 0 ? -1 : 1;
    for (int i = 0; i < 3; i++) {
        slope[i] *= sign;
        h->gradient[h->count][i] = slope[i] / area;
    }
    h->height[h->count++] = fabs(volume) / area;
    for (int k = 1; k < 4; k++) {
        double n[3], side[3], turn[3]; /* turn/area: gradient of the area */
        int mine = 0;
        area = face_of(t, tet, (at + k) % 4, p, n);
        while (p[mine] != x) {
            mine++;
        }
        rg_vector_subtract(p[(mine + 1) % 3], p[(mine + 2) % 3], side);
        rg_vector_cross(side, n, turn);
        for (int i = 0; i < 3; i++) {
            h->gradient[h->count][i] = (slope[i] - fabs(volume) / area * turn[i] / area) / area;
        }
        h->height[h->count++] = fabs(volume) / area;
    }
}

static void all_heights(const rg_tets *t, rg_gid vertex, heights *h) {
    const rg_star *star = t->star + vertex;
    h->count = 0;
    for (int i = 0; i < star->count; i++) {
        const rg_tet *tet = t->tet + star->tet[i];
        take_heights(t, tet, rg_tets_find(tet, vertex), h);
    }
}

/* Smallest height around the vertex; negative if a tetrahedron has turned inside out. */
static double least_height(const rg_tets *t, rg_gid vertex) {
    const rg_star *star = t->star + vertex;
    double least = INFINITY;
    for (int i = 0; i < star->count; i++) {
        least = fmin(least, rg_tets_height(t, t->tet[star->tet[i]].corner));
    }
    return least;
}

/* ---- ascent ---- */

/* Shortest vector of the convex hull of g[count], by Gilbert's iteration: from the vector so far towards the
 * point of the hull that lies farthest back along it. */
static void shortest(int count, double (*const g)[3], double d[3]) {
    memcpy(d, g[0], 3 * sizeof *d);
    for (int step = 0; step < HULL_STEPS; step++) {
        int back = 0;
        for (int i = 1; i < count; i++) {
            back = rg_vector_dot(g[i], d) < rg_vector_dot(g[back], d) ? i : back;
        }
        double way[3];
        rg_vector_subtract(g[back], d, way);
        double square = rg_vector_dot(way, way), along = -rg_vector_dot(way, d);
        if (!(along > 1e-6 * rg_vector_dot(d, d)) || !(square > 0)) {
            return;
        }
        double part = fmin(1, along / square);
        for (int i = 0; i < 3; i++) {
            d[i] += part * way[i];
        }
    }
}

/* Direction in which the heights near the smallest one grow, along f; false if there is none. */
static bool ascent(heights *h, const freedom *f, double least, double near, double direction[3]) {
    int active = 0;
    for (int i = 0; i < h->count; i++) {
        if (h->height[i] <= (1 + near) * least) {
            project(f, h->gradient[i], h->gradient[active]);
            active++;
        }
    }
    shortest(active, h->gradient, direction);
    return rg_vector_dot(direction, direction) > 1e-4;
}

/* Goes along the direction as far as it pays, from half the smallest height on. Returns the height reached.
 */
static double search(rg_tets *t, rg_gid vertex, const double direction[3], double least) {
    double *x = t->mesh->x + 3 * vertex, from[3];
    double length = sqrt(rg_vector_dot(direction, direction)), step = 0.5 * least / length;
    memcpy(from, x, sizeof from);
    for (int i = 0; i < HALVINGS; i++, step *= 0.5) {
        for (int k = 0; k < 3; k++) {
            x[k] = from[k] + step * direction[k];
        }
        double height = least_height(t, vertex);
        if (height > least * (1 + worth)) {
            return height;
        }
    }
    memcpy(x, from, sizeof from);
    return least;
}

bool rg_tets_move(rg_tets *t, rg_gid vertex) {
    if (t->star[vertex].count > MOST_TETS) {
        return false;
    }
    freedom f = freedom_of(t, vertex);
    if (f.p[0][0] + f.p[1][1] + f.p[2][2] < 0.5) {
        return false;
    }
    heights h;
    double least = rg_tets_star_height(t, vertex), before = least, near = widest, direction[3];
    for (int step = 0; step < STEPS && near > narrowest; step++) {
        all_heights(t, vertex, &h);
        double height = ascent(&h, &f, least, near, direction) ? search(t, vertex, direction, least) : least;
        near = height > least ? near : 0.3 * near;
        least = height;
    }
    rg_tets_update(t, vertex);
    return least > before;
}
