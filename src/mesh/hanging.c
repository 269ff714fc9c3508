/* Hanging nodes: surface vertices are sorted into cubic cells, and each surface face looks at those near it.
 */
#include <math.h>
#include <stdlib.h>

#include "base/mem.h"
#include "base/vector.h"
#include "layout.h"
#include "mesh/apart.h"
#include "mesh/check.h"

static const double near_face = 1e-6; /* of its longest edge */

struct kept {
    int64_t cell;
    rg_gid vertex;
};

/* Cells are numbered along x first, so those of a row follow each other. */
struct grid {
    double low[3], edge;
    int64_t cells[3];
    struct kept *kept; /* surface vertices by cell */
    rg_gid count;
    int32_t *part; /* of each vertex; NULL: all are of one */
};

struct triangle {
    const double *x[3];
    rg_gid vertex[3];
    double low[3], high[3]; /* its box, wider by the tolerance */
    double reach;           /* the tolerance (m) */
};

static int by_cell(const void *a, const void *b) {
    const struct kept *p = a, *q = b;
    return (p->cell > q->cell) - (p->cell < q->cell);
}

static struct triangle get_triangle(const rg_mesh *mesh, rg_gid slot) {
    struct triangle t;
    double edge = 0;
    for (int k = 0; k < 3; k++) {
        t.vertex[k] = mesh->corner[slot / 4 * 4 + rg_face_node[slot % 4][k]];
        t.x[k] = mesh->x + 3 * t.vertex[k];
    }
    for (int i = 0; i < 3; i++) {
        t.low[i] = fmin(t.x[0][i], fmin(t.x[1][i], t.x[2][i]));
        t.high[i] = fmax(t.x[0][i], fmax(t.x[1][i], t.x[2][i]));
        edge = fmax(edge, t.high[i] - t.low[i]);
    }
    t.reach = near_face * edge;
    for (int i = 0; i < 3; i++) {
        t.low[i] -= t.reach;
        t.high[i] += t.reach;
    }
    return t;
}

static int64_t cell_along(const struct grid *g, int axis, double x) {
    double at = floor((x - g->low[axis]) / g->edge);
    at = at > 0 ? at : 0;
    return at < (double)g->cells[axis] ? (int64_t)at : g->cells[axis] - 1;
}

static int64_t cell_of(const struct grid *g, const double x[3]) {
    return (cell_along(g, 2, x[2]) * g->cells[1] + cell_along(g, 1, x[1])) * g->cells[0] +
           cell_along(g, 0, x[0]);
}

/* Cells as wide as the mean surface face, but not more than 2^20 along an axis. */
static void lay_cells(struct grid *g, const rg_mesh *mesh) {
    double box[2][3], sum = 0, longest = 0;
    rg_gid faces = 0;
    rg_mesh_box_around(mesh, box);
    for (rg_gid slot = 0; slot < 4 * mesh->elements; slot++) {
        if (mesh->neighbour[slot] < 0) {
            sum += get_triangle(mesh, slot).reach / near_face;
            faces++;
        }
    }
    for (int i = 0; i < 3; i++) {
        g->low[i] = box[0][i];
        longest = fmax(longest, box[1][i] - box[0][i]);
    }
    g->edge = fmax(sum / (double)faces, longest * 0x1p-20);
    for (int i = 0; i < 3; i++) {
        g->cells[i] = (int64_t)((box[1][i] - box[0][i]) / g->edge) + 1;
    }
}

static struct grid make_grid(const rg_mesh *mesh) {
    struct grid g = {.kept = RG_NEW(struct kept, (size_t)mesh->vertices), .part = rg_mesh_vertex_parts(mesh)};
    int8_t *seen = RG_NEW(int8_t, (size_t)mesh->vertices);
    lay_cells(&g, mesh);
    for (rg_gid slot = 0; slot < 4 * mesh->elements; slot++) {
        for (int k = 0; mesh->neighbour[slot] < 0 && k < 3; k++) {
            rg_gid v = mesh->corner[slot / 4 * 4 + rg_face_node[slot % 4][k]];
            if (!seen[v]) {
                seen[v] = 1;
                g.kept[g.count++] = (struct kept){cell_of(&g, mesh->x + 3 * v), v};
            }
        }
    }
    rg_free(seen);
    qsort(g.kept, (size_t)g.count, sizeof *g.kept, by_cell);
    return g;
}

/* The first kept vertex in `cell` or beyond. */
static rg_gid first_in(const struct grid *g, int64_t cell) {
    rg_gid low = 0, high = g->count;
    while (low < high) {
        rg_gid middle = (low + high) / 2;
        *(g->kept[middle].cell < cell ? &low : &high) = g->kept[middle].cell < cell ? middle + 1 : middle;
    }
    return low;
}

/* Whether point p is within reach of the triangle: of its plane, and of its inside or edges. */
static bool touches(const struct triangle *t, const double p[3]) {
    double u[3], v[3], w[3], n[3];
    for (int i = 0; i < 3; i++) {
        u[i] = t->x[1][i] - t->x[0][i];
        v[i] = t->x[2][i] - t->x[0][i];
        w[i] = p[i] - t->x[0][i];
    }
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        n[i] = u[j] * v[k] - u[k] * v[j];
    }
    double uu = rg_vector_dot(u, u), uv = rg_vector_dot(u, v), vv = rg_vector_dot(v, v),
           wu = rg_vector_dot(w, u), wv = rg_vector_dot(w, v), nn = rg_vector_dot(n, n);
    double b = (vv * wu - uv * wv) / nn, c = (uu * wv - uv * wu) / nn; /* barycentric coordinates */
    double slack = t->reach * sqrt(fmax(uu, vv) / nn);                 /* the reach over the least height */
    return fabs(rg_vector_dot(w, n)) <= t->reach * sqrt(nn) && b >= -slack && c >= -slack &&
           b + c <= 1 + slack;
}

static bool is_corner(const struct triangle *t, rg_gid vertex) {
    return vertex == t->vertex[0] || vertex == t->vertex[1] || vertex == t->vertex[2];
}

/* Looks for vertices that hang on face `slot`; of[vertex] is the first face on which one hangs, -1 without.
 */
static void search(const struct grid *g, const rg_mesh *mesh, rg_gid slot, rg_gid *of) {
    struct triangle t = get_triangle(mesh, slot);
    int64_t low[3], high[3];
    for (int i = 0; i < 3; i++) {
        low[i] = cell_along(g, i, t.low[i]);
        high[i] = cell_along(g, i, t.high[i]);
    }
    for (int64_t z = low[2]; z <= high[2]; z++) {
        for (int64_t y = low[1]; y <= high[1]; y++) {
            int64_t row = (z * g->cells[1] + y) * g->cells[0];
            for (rg_gid i = first_in(g, row + low[0]); i < g->count && g->kept[i].cell <= row + high[0];
                 i++) {
                rg_gid v = g->kept[i].vertex;
                bool together = g->part == NULL || g->part[v] == g->part[t.vertex[0]];
                if (of[v] < 0 && together && !is_corner(&t, v) && touches(&t, mesh->x + 3 * v)) {
                    of[v] = slot;
                }
            }
        }
    }
}

rg_gid *rg_mesh_hanging(const rg_mesh *mesh) {
    struct grid g = make_grid(mesh);
    rg_gid *of = RG_NEW(rg_gid, (size_t)mesh->vertices);
    for (rg_gid v = 0; v < mesh->vertices; v++) {
        of[v] = -1;
    }
    for (rg_gid slot = 0; slot < 4 * mesh->elements; slot++) {
        if (mesh->neighbour[slot] < 0) {
            search(&g, mesh, slot, of);
        }
    }
    rg_free(g.kept);
    rg_free(g.part);
    return of;
}
