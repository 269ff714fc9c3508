/* Hanging nodes: each surface face looks at the surface vertices near it. */
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "base/vector.h"
#include "layout.h"
#include "mesh/apart.h"
#include "mesh/check.h"
#include "mesh/near.h"

static const double near_face = 1e-6; /* of its longest edge */

struct triangle {
    const double *x[3];
    rg_gid vertex[3];
    double low[3], high[3]; /* its box, wider by the tolerance */
    double reach;           /* the tolerance (m) */
};

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

/* Faces of the surface, then its vertices, and their boxes, which are of two kinds to the search. */
struct search {
    const rg_mesh *mesh;
    int32_t *part; /* of each vertex; NULL: all are of one */
    int64_t count;
    rg_gid *number; /* 4 * element + face, or vertex */
    rg_near_box *box;
    rg_gid *of; /* [vertices]: the first face on which one hangs, -1 without */
};

enum { FACE, VERTEX };

static void list_faces(struct search *s) {
    for (rg_gid slot = 0; slot < 4 * s->mesh->elements; slot++) {
        if (s->mesh->neighbour[slot] < 0) {
            struct triangle t = get_triangle(s->mesh, slot);
            rg_near_box *box = &s->box[s->count];
            box->part = FACE;
            memcpy(box->low, t.low, sizeof t.low);
            memcpy(box->high, t.high, sizeof t.high);
            s->number[s->count++] = slot;
        }
    }
}

static void list_vertices(struct search *s) {
    int8_t *seen = RG_NEW(int8_t, (size_t)s->mesh->vertices);
    int64_t faces = s->count;
    for (int64_t i = 0; i < 3 * faces; i++) {
        rg_gid slot = s->number[i / 3], v = s->mesh->corner[slot / 4 * 4 + rg_face_node[slot % 4][i % 3]];
        if (!seen[v]) {
            rg_near_box *box = &s->box[s->count];
            box->part = VERTEX;
            memcpy(box->low, s->mesh->x + 3 * v, sizeof box->low);
            memcpy(box->high, box->low, sizeof box->high);
            s->number[s->count++] = v;
            seen[v] = 1;
        }
    }
    rg_free(seen);
}

static void look(void *context, int64_t face, int64_t vertex) {
    struct search *s = context;
    rg_gid slot = s->number[face], v = s->number[vertex];
    struct triangle t = get_triangle(s->mesh, slot);
    bool first = s->of[v] < 0 || slot < s->of[v];
    bool together = s->part == NULL || s->part[v] == s->part[t.vertex[0]];
    if (first && together && !is_corner(&t, v) && touches(&t, s->mesh->x + 3 * v)) {
        s->of[v] = slot;
    }
}

rg_gid *rg_mesh_hanging(const rg_mesh *mesh) {
    size_t faces = 0, vertices = (size_t)mesh->vertices;
    for (rg_gid slot = 0; slot < 4 * mesh->elements; slot++) {
        faces += mesh->neighbour[slot] < 0;
    }
    size_t most = faces + (3 * faces < vertices ? 3 * faces : vertices);
    struct search s = {.mesh = mesh,
                       .part = rg_mesh_vertex_parts(mesh),
                       .number = RG_NEW(rg_gid, most),
                       .box = RG_NEW(rg_near_box, most),
                       .of = RG_NEW(rg_gid, vertices)};
    for (size_t v = 0; v < vertices; v++) {
        s.of[v] = -1;
    }
    list_faces(&s);
    list_vertices(&s);
    rg_near_pairs(s.box, s.count, look, &s);
    rg_free(s.part);
    rg_free(s.number);
    rg_free(s.box);
    return s.of;
}
