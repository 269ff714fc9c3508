#include "mesh_check.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../kernels/layout.h"
#include "error.h"
#include "mem.h"
#include "tet.h"

/* Relative bounds. */
static const double least_volume = 1e-12, same_place = 1e-9;

static const double *corner(const rg_mesh *mesh, rg_gid e, int i) {
    return mesh->x + 3 * mesh->corner[4 * e + i];
}

static double distance(const double a[3], const double b[3]) {
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                (a[2] - b[2]) * (a[2] - b[2]));
}

/* ---- elements ---- */

static void check_corners(const rg_mesh *mesh, const char *name, rg_gid e) {
    const rg_gid *c = mesh->corner + 4 * e;
    for (int i = 0; i < 4; i++) {
        bool known = c[i] >= 0 && c[i] < mesh->vertices;
        if (!known || (i > 0 && c[i] <= c[i - 1])) {
            rg_fatal(RG_USAGE,
                     "%s: element %" PRId64
                     ": its corners must be four different vertices in ascending order; "
                     "they are %" PRId64 ", %" PRId64 ", %" PRId64 ", %" PRId64,
                     name, rg_mesh_original(mesh, e), c[0], c[1], c[2], c[3]);
        }
    }
}

double rg_tet_longest_edge(const double *x) {
    double edge = 0;
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < i; j++) {
            edge = fmax(edge, distance(x + 3 * i, x + 3 * j));
        }
    }
    return edge;
}

bool rg_tet_has_volume(const double *x) {
    double edge = rg_tet_longest_edge(x);
    return fabs(rg_tet_volume(x, x + 3, x + 6, x + 9)) >
           least_volume * edge * edge * edge; /* no: not finite */
}

static void check_volume(const rg_mesh *mesh, const char *name, rg_gid e) {
    double x[12];
    for (int i = 0; i < 4; i++) {
        memcpy(x + 3 * i, corner(mesh, e, i), 3 * sizeof *x);
    }
    if (!rg_tet_has_volume(x)) {
        rg_fatal(RG_USAGE,
                 "%s: element %" PRId64 " at (%g, %g, %g) m has no volume: %g m3 with edges of up to %g m",
                 name, rg_mesh_original(mesh, e), x[0], x[1], x[2],
                 fabs(rg_tet_volume(x, x + 3, x + 6, x + 9)), rg_tet_longest_edge(x));
    }
}

static void check_neighbour(const rg_mesh *mesh, const char *name, rg_gid e, int f) {
    rg_gid other = mesh->neighbour[4 * e + f];
    if (other < 0) {
        return;
    }
    int g = mesh->face[4 * e + f];
    bool agree = other < mesh->elements && other != e && g >= 0 && g < 4 &&
                 mesh->neighbour[4 * other + g] == e && mesh->face[4 * other + g] == f;
    for (int i = 0; i < 3 && agree; i++) {
        agree = mesh->corner[4 * e + rg_face_node[f][i]] == mesh->corner[4 * other + rg_face_node[g][i]];
    }
    if (!agree) {
        rg_fatal(RG_USAGE,
                 "%s: neighbour: element %" PRId64 " takes element %" PRId64
                 " for its neighbour across face %d, but they do not share it",
                 name, rg_mesh_original(mesh, e),
                 other < mesh->elements ? rg_mesh_original(mesh, other) : other, f);
    }
}

static void check_use(const rg_mesh *mesh, const char *name) {
    int8_t *used = RG_NEW(int8_t, (size_t)mesh->vertices);
    for (rg_gid i = 0; i < 4 * mesh->elements; i++) {
        used[mesh->corner[i]] = 1;
    }
    for (rg_gid v = 0; v < mesh->vertices; v++) {
        if (!used[v]) {
            rg_fatal(RG_USAGE, "%s: no element uses vertex %" PRId64, name, v);
        }
    }
    rg_free(used);
}

/* ---- vertices at the same place ---- */

struct projected {
    double along; /* a line that no regular mesh is aligned with, so that few vertices share a place on it */
    rg_gid vertex;
};

static int by_place(const void *a, const void *b) {
    const struct projected *p = a, *q = b;
    return (p->along > q->along) - (p->along < q->along);
}

static rg_gid element_of(const rg_mesh *mesh, rg_gid vertex) {
    rg_gid i = 0;
    while (mesh->corner[i] != vertex) {
        i++;
    }
    return rg_mesh_original(mesh, i / 4);
}

static _Noreturn void refuse_pair(const rg_mesh *mesh, const char *name, rg_gid v, rg_gid w) {
    const double *x = mesh->x + 3 * v;
    rg_fatal(
        RG_USAGE,
        "%s: elements %" PRId64 " and %" PRId64
        " have different vertices at the same place (%.9g, %.9g, %.9g) m: the mesh is open there; merge its "
        "duplicate nodes",
        name, element_of(mesh, v), element_of(mesh, w), x[0], x[1], x[2]);
}

static void check_places(const rg_mesh *mesh, const char *name) {
    static const double line[3] = {0.5257311, 0.6360098, 0.5648217}; /* of length 1 */
    struct projected *p = RG_NEW(struct projected, (size_t)mesh->vertices);
    double box[2][3];
    rg_mesh_box_around(mesh, box);
    double reach = same_place * distance(box[0], box[1]);
    for (rg_gid v = 0; v < mesh->vertices; v++) {
        const double *x = mesh->x + 3 * v;
        p[v] = (struct projected){line[0] * x[0] + line[1] * x[1] + line[2] * x[2], v};
    }
    qsort(p, (size_t)mesh->vertices, sizeof *p, by_place);
    for (rg_gid i = 0; i < mesh->vertices; i++) {
        for (rg_gid j = i + 1; j < mesh->vertices && p[j].along - p[i].along <= reach; j++) {
            if (distance(mesh->x + 3 * p[i].vertex, mesh->x + 3 * p[j].vertex) <= reach) {
                refuse_pair(mesh, name, p[i].vertex, p[j].vertex);
            }
        }
    }
    rg_free(p);
}

static void check_hanging(const rg_mesh *mesh, const char *name) {
    rg_gid vertex, slot;
    if (rg_mesh_hanging(mesh, &vertex, &slot)) {
        const double *x = mesh->x + 3 * vertex;
        rg_fatal(RG_USAGE,
                 "%s: a vertex of element %" PRId64
                 " at (%.9g, %.9g, %.9g) m lies on a face of element %" PRId64
                 " without being its corner (a hanging node): the mesh is open there",
                 name, element_of(mesh, vertex), x[0], x[1], x[2], rg_mesh_original(mesh, slot / 4));
    }
}

void rg_mesh_check_elements(const rg_mesh *mesh, const char *name) {
    for (rg_gid e = 0; e < mesh->elements; e++) {
        check_corners(mesh, name, e);
        check_volume(mesh, name, e);
    }
}

void rg_mesh_check_surface(const rg_mesh *mesh, const char *name) {
    check_places(mesh, name);
    check_hanging(mesh, name);
}

void rg_mesh_check(const rg_mesh *mesh, const char *name) {
    rg_mesh_check_elements(mesh, name);
    for (rg_gid e = 0; e < mesh->elements; e++) {
        for (int f = 0; f < 4; f++) {
            check_neighbour(mesh, name, e, f);
        }
    }
    check_use(mesh, name);
    rg_mesh_check_surface(mesh, name);
}

/* ---- parts ---- */

static void flood(const rg_mesh *mesh, rg_gid first, int32_t number, int32_t *part, rg_gid *stack) {
    rg_gid depth = 0;
    stack[depth++] = first;
    part[first] = number;
    while (depth > 0) {
        rg_gid e = stack[--depth];
        for (int f = 0; f < 4; f++) {
            rg_gid other = mesh->neighbour[4 * e + f];
            if (other >= 0 && part[other] < 0) {
                part[other] = number;
                stack[depth++] = other;
            }
        }
    }
}

int32_t rg_mesh_parts(const rg_mesh *mesh, int32_t *part) {
    int32_t count = 0;
    rg_gid *stack = RG_NEW(rg_gid, (size_t)mesh->elements);
    for (rg_gid e = 0; e < mesh->elements; e++) {
        part[e] = -1;
    }
    for (rg_gid e = 0; e < mesh->elements; e++) {
        if (part[e] < 0) {
            flood(mesh, e, count++, part, stack);
        }
    }
    rg_free(stack);
    return count;
}
