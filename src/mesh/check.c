#include "mesh/check.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/tet.h"
#include "layout.h"
#include "mesh/apart.h"

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

double rg_tet_longest_edge(const double *x) {
    double edge = 0;
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < i; j++) {
            edge = fmax(edge, distance(x + 3 * i, x + 3 * j));
        }
    }
    return edge;
}

double rg_mesh_longest_edge(const rg_mesh *mesh, rg_gid e) {
    double x[12];
    for (int i = 0; i < 4; i++) {
        memcpy(x + 3 * i, corner(mesh, e, i), 3 * sizeof *x);
    }
    return rg_tet_longest_edge(x);
}

static bool has_volume(const double *x) {
    double edge = rg_tet_longest_edge(x);
    return fabs(rg_tet_volume(x, x + 3, x + 6, x + 9)) >
           least_volume * edge * edge * edge; /* no: not finite */
}

bool rg_tet_sound(const double *x, const rg_gid corner[4], rg_gid name, char *what) {
    if (!(corner[0] < corner[1] && corner[1] < corner[2] && corner[2] < corner[3])) {
        snprintf(what, RG_INPUT_ERROR_WORDS,
                 "element %" PRId64
                 ": its corners must be four different vertices in ascending order; they are "
                 "%" PRId64 ", %" PRId64 ", %" PRId64 ", %" PRId64,
                 name, corner[0], corner[1], corner[2], corner[3]);
    } else if (!has_volume(x)) {
        snprintf(what, RG_INPUT_ERROR_WORDS,
                 "element %" PRId64 " at (%g, %g, %g) m has no volume: %g m3 with edges of up to %g m", name,
                 x[0], x[1], x[2], fabs(rg_tet_volume(x, x + 3, x + 6, x + 9)), rg_tet_longest_edge(x));
    } else {
        return true;
    }
    return false;
}

static void check_element(const rg_mesh *mesh, rg_input_errors *input_errors, rg_gid e) {
    const rg_gid *c = mesh->corner + 4 * e;
    double x[12] = {0};
    char what[RG_INPUT_ERROR_WORDS];
    for (int i = 0; i < 4; i++) {
        if (c[i] < 0 || c[i] >= mesh->vertices) {
            rg_input_errors_add(input_errors, e, 0, "element %" PRId64 ": there is no vertex %" PRId64,
                                rg_mesh_original(mesh, e), c[i]);
            return;
        }
        memcpy(x + 3 * i, corner(mesh, e, i), 3 * sizeof *x);
    }
    if (!rg_tet_sound(x, c, rg_mesh_original(mesh, e), what)) {
        rg_input_errors_add(input_errors, e, 0, "%s", what);
    }
}

static void check_neighbour(const rg_mesh *mesh, rg_input_errors *input_errors, rg_gid e, int f) {
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
        rg_input_errors_add(input_errors, e, 1 + f,
                            "neighbour: element %" PRId64 " takes element %" PRId64
                            " for its neighbour across face %d, but they do not share it",
                            rg_mesh_original(mesh, e),
                            other < mesh->elements ? rg_mesh_original(mesh, other) : other, f);
    } else if (e < other && mesh->set[4 * e + f] != mesh->set[4 * other + g]) {
        rg_input_errors_add(input_errors, e, 1 + f,
                            "set: elements %" PRId64 " and %" PRId64
                            " have the face between them in different sets",
                            rg_mesh_original(mesh, e), rg_mesh_original(mesh, other));
    } else if (e < other && mesh->part != NULL && mesh->part[e] != mesh->part[other]) {
        rg_input_errors_add(input_errors, e, 1 + f,
                            "part: elements %" PRId64 " and %" PRId64
                            " are neighbours, but in parts that are kept apart",
                            rg_mesh_original(mesh, e), rg_mesh_original(mesh, other));
    }
}

static void check_use(const rg_mesh *mesh, rg_input_errors *input_errors) {
    int8_t *used = RG_NEW(int8_t, (size_t)mesh->vertices);
    for (rg_gid i = 0; i < 4 * mesh->elements; i++) {
        used[mesh->corner[i]] = 1;
    }
    for (rg_gid v = 0; v < mesh->vertices; v++) {
        if (!used[v]) {
            rg_input_errors_add(input_errors, mesh->elements + v, 0, "no element uses vertex %" PRId64, v);
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

const char *rg_mesh_open_words(bool apart) {
    return apart
               ? "the mesh is open there, inside one of its parts; rhegma mesh joins nodes that coincide by "
                 "--merge D, or takes faces that lie on each other for a crack by --crack NAME"
               : "the mesh is open there; rhegma mesh joins nodes that coincide by --merge D, keeps parts "
                 "apart by --apart, or takes faces that lie on each other for a crack by --crack NAME";
}

/* twin[v]: the lowest vertex at the place of v, below v; -1 if there is none. */
static void check_twins(const rg_mesh *mesh, const rg_gid *twin, rg_input_errors *input_errors) {
    for (rg_gid v = 1; v < mesh->vertices; v++) { /* none is below the first */
        char *words = twin[v] >= 0 ? rg_input_errors_place(input_errors, v, 0) : NULL;
        if (words != NULL) {
            const double *x = mesh->x + 3 * v;
            snprintf(words, RG_INPUT_ERROR_WORDS,
                     "elements %" PRId64 " and %" PRId64
                     " have different vertices at the same place (%.9g, %.9g, %.9g) m: %s",
                     element_of(mesh, twin[v]), element_of(mesh, v), x[0], x[1], x[2],
                     rg_mesh_open_words(mesh->part != NULL));
        }
    }
}

static void check_places(const rg_mesh *mesh, rg_input_errors *input_errors) {
    static const double line[3] = {0.5257311, 0.6360098, 0.5648217}; /* of length 1 */
    struct projected *p = RG_NEW(struct projected, (size_t)mesh->vertices);
    rg_gid *twin = RG_NEW(rg_gid, (size_t)mesh->vertices);
    double box[2][3];
    rg_mesh_box_around(mesh, box);
    double reach = same_place * distance(box[0], box[1]);
    int32_t *part = rg_mesh_vertex_parts(mesh);
    for (rg_gid v = 0; v < mesh->vertices; v++) {
        const double *x = mesh->x + 3 * v;
        p[v] = (struct projected){line[0] * x[0] + line[1] * x[1] + line[2] * x[2], v};
        twin[v] = -1;
    }
    qsort(p, (size_t)mesh->vertices, sizeof *p, by_place);
    for (rg_gid i = 0; i < mesh->vertices; i++) {
        for (rg_gid j = i + 1; j < mesh->vertices && p[j].along - p[i].along <= reach; j++) {
            rg_gid v = p[i].vertex, w = p[j].vertex, low = v < w ? v : w, high = v < w ? w : v;
            if (distance(mesh->x + 3 * v, mesh->x + 3 * w) <= reach && (twin[high] < 0 || low < twin[high]) &&
                (part == NULL || part[v] == part[w])) {
                twin[high] = low;
            }
        }
    }
    check_twins(mesh, twin, input_errors);
    rg_free(part);
    rg_free(twin);
    rg_free(p);
}

static void check_hanging(const rg_mesh *mesh, rg_input_errors *input_errors) {
    rg_gid *face = rg_mesh_hanging(mesh);
    for (rg_gid v = 0; v < mesh->vertices; v++) {
        char *words = face[v] >= 0 ? rg_input_errors_place(input_errors, v, 0) : NULL;
        if (words != NULL) {
            const double *x = mesh->x + 3 * v;
            snprintf(words, RG_INPUT_ERROR_WORDS,
                     "a vertex of element %" PRId64
                     " at (%.9g, %.9g, %.9g) m lies on a face of element %" PRId64
                     " without being its corner (a hanging node): %s",
                     element_of(mesh, v), x[0], x[1], x[2], rg_mesh_original(mesh, face[v] / 4),
                     rg_mesh_open_words(mesh->part != NULL));
        }
    }
    rg_free(face);
}

void rg_mesh_check_elements(const rg_mesh *mesh, const char *name) {
    rg_input_errors input_errors = {.name = name};
    for (rg_gid e = 0; e < mesh->elements; e++) {
        check_element(mesh, &input_errors, e);
    }
    rg_input_errors_end(&input_errors);
}

void rg_mesh_check_surface(const rg_mesh *mesh, rg_input_errors *input_errors) {
    int64_t before = input_errors->count;
    check_places(mesh, input_errors);
    if (input_errors->count == before) { /* each copy of a corner would hang */
        check_hanging(mesh, input_errors);
    }
}

void rg_mesh_check(const rg_mesh *mesh, const char *name) {
    rg_input_errors input_errors = {.name = name};
    rg_mesh_check_elements(mesh, name);
    for (rg_gid e = 0; e < mesh->elements; e++) {
        for (int f = 0; f < 4; f++) {
            check_neighbour(mesh, &input_errors, e, f);
        }
    }
    check_use(mesh, &input_errors);
    rg_input_errors_end(&input_errors);
    rg_mesh_check_surface(mesh, &input_errors);
    rg_input_errors_end(&input_errors);
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
