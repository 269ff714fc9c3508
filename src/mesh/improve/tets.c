#include "mesh/improve/tets.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/tet.h"
#include "base/vector.h"
#include "layout.h"

enum { MOST_LABELS = 64 };

/* ---- geometry ---- */

static double twice_area(const double a[3], const double b[3], const double c[3]) {
    double u[3], v[3], n[3];
    rg_vector_subtract(b, a, u);
    rg_vector_subtract(c, a, v);
    rg_vector_cross(u, v, n);
    return sqrt(rg_vector_dot(n, n));
}

double rg_tets_height(const rg_tets *t, const rg_gid corner[4]) {
    const double *x[4];
    double most = 0;
    for (int i = 0; i < 4; i++) {
        x[i] = rg_tets_at(t, corner[i]);
    }
    for (int f = 0; f < 4; f++) {
        most = fmax(most, twice_area(x[rg_face_node[f][0]], x[rg_face_node[f][1]], x[rg_face_node[f][2]]));
    }
    return 6 * rg_tet_volume(x[0], x[1], x[2], x[3]) / most;
}

double rg_tets_star_height(const rg_tets *t, rg_gid vertex) {
    const rg_star *star = t->star + vertex;
    double least = INFINITY;
    for (int i = 0; i < star->count; i++) {
        least = fmin(least, t->tet[star->tet[i]].height);
    }
    return least;
}

void rg_tets_update(rg_tets *t, rg_gid vertex) {
    const rg_star *star = t->star + vertex;
    for (int i = 0; i < star->count; i++) {
        rg_tet *tet = t->tet + star->tet[i];
        tet->height = rg_tets_height(t, tet->corner);
    }
}

/* ---- finding ---- */

int rg_tets_find(const rg_tet *tet, rg_gid vertex) {
    for (int i = 0; i < 4; i++) {
        if (tet->corner[i] == vertex) {
            return i;
        }
    }
    return -1;
}

int rg_tets_around(const rg_tets *t, rg_gid a, rg_gid b, int most, rg_gid *tet) {
    const rg_star *star = t->star + a;
    int count = 0;
    for (int i = 0; i < star->count; i++) {
        if (rg_tets_find(t->tet + star->tet[i], b) >= 0) {
            if (count < most) {
                tet[count] = star->tet[i];
            }
            count++;
        }
    }
    return count;
}

rg_labelled_face rg_labelled_face_of(rg_gid a, rg_gid b, rg_gid c, int32_t label) {
    rg_gid low = a < b ? a : b, high = a < b ? b : a;
    rg_labelled_face face = {{low, high, c}, label};
    if (c < low) {
        face = (rg_labelled_face){{c, low, high}, label};
    } else if (c < high) {
        face = (rg_labelled_face){{low, c, high}, label};
    }
    return face;
}

static rg_labelled_face face_of(const rg_tet *tet, int f) {
    const int *node = rg_face_node[f];
    return rg_labelled_face_of(tet->corner[node[0]], tet->corner[node[1]], tet->corner[node[2]],
                               tet->label[f]);
}

/* ---- coming and going ---- */

static void enter(rg_star *star, rg_gid tet) {
    star->tet = rg_grow(star->tet, &star->room, (size_t)star->count, sizeof *star->tet);
    star->tet[star->count++] = tet;
}

static void leave(rg_star *star, rg_gid tet) {
    int i = 0;
    while (star->tet[i] != tet) {
        i++;
    }
    memmove(star->tet + i, star->tet + i + 1, (size_t)(star->count - i - 1) * sizeof *star->tet);
    star->count--;
}

static rg_gid add(rg_tets *t, const rg_tet *tet) {
    t->tet = rg_grow(t->tet, &t->room, (size_t)t->count, sizeof *t->tet);
    t->tet[t->count] = *tet;
    for (int i = 0; i < 4; i++) {
        enter(t->star + tet->corner[i], t->count);
    }
    return t->count++;
}

static void drop(rg_tets *t, rg_gid tet) {
    for (int i = 0; i < 4; i++) {
        leave(t->star + t->tet[tet].corner[i], tet);
    }
    t->tet[tet].corner[0] = -1;
}

static int32_t label_among(const rg_labelled_face *list, int count, rg_labelled_face face) {
    for (int i = 0; i < count; i++) {
        if (memcmp(list[i].vertex, face.vertex, sizeof face.vertex) == 0) {
            return list[i].label;
        }
    }
    return 0;
}

void rg_tets_replace(rg_tets *t, int olds, const rg_gid *old, int news, const rg_gid (*corner)[4], int mores,
                     const rg_labelled_face *more) {
    rg_labelled_face list[MOST_LABELS];
    int labels = 0;
    rg_tet first = t->tet[old[0]];
    for (int i = 0; i < mores; i++) {
        list[labels++] = more[i];
    }
    for (int i = 0; i < olds; i++) {
        for (int f = 0; f < 4; f++) {
            if (t->tet[old[i]].label[f] != 0) {
                list[labels++] = face_of(t->tet + old[i], f);
            }
        }
        drop(t, old[i]);
    }
    for (int i = 0; i < news; i++) {
        rg_tet tet = {.original = first.original, .region = first.region};
        memcpy(tet.corner, corner[i], sizeof tet.corner);
        for (int f = 0; f < 4; f++) {
            tet.label[f] = label_among(list, labels, face_of(&tet, f));
        }
        tet.height = rg_tets_height(t, tet.corner);
        add(t, &tet);
    }
}

/* ---- from and to the mesh ---- */

static int by_vertices(const void *a, const void *b) {
    const rg_gid *p = a, *q = b;
    for (int i = 0; i < 3; i++) {
        if (p[i] != q[i]) {
            return p[i] < q[i] ? -1 : 1;
        }
    }
    return 0;
}

static int32_t label_of(const rg_mesh *mesh, rg_gid slot) {
    rg_gid e = slot / 4, other = mesh->neighbour[slot], name[3];
    if (other < 0) {
        return RG_SURFACE + mesh->set[slot] + 1;
    }
    if (mesh->set[slot] >= 0) {
        return -mesh->set[slot] - 1;
    }
    for (int i = 0; i < 3; i++) {
        name[i] = mesh->corner[4 * e + rg_face_node[slot % 4][i]];
    }
    bool between = mesh->region != NULL && mesh->region[e] != mesh->region[other];
    bool named = mesh->inner != NULL && bsearch(name, mesh->inner, (size_t)mesh->inners,
                                                3 * sizeof *mesh->inner, by_vertices) != NULL;
    return between || named ? RG_KEPT : 0;
}

static void turn(rg_tet *tet) {
    rg_gid corner = tet->corner[0];
    int32_t label = tet->label[0];
    tet->corner[0] = tet->corner[1];
    tet->label[0] = tet->label[1];
    tet->corner[1] = corner;
    tet->label[1] = label;
}

static int by_ends(const void *a, const void *b) {
    const rg_gid *p = a, *q = b;
    return p[0] != q[0] ? (p[0] > q[0]) - (p[0] < q[0]) : (p[1] > q[1]) - (p[1] < q[1]);
}

bool rg_tets_is_line(const rg_tets *t, rg_gid a, rg_gid b) {
    if (t->on_line == NULL || !t->on_line[a] || !t->on_line[b]) {
        return false;
    }
    rg_gid ends[2] = {a < b ? a : b, a < b ? b : a};
    return bsearch(ends, t->mesh->line, t->mesh->lines, sizeof ends, by_ends) != NULL;
}

static void find_lines(rg_tets *t) {
    rg_mesh *mesh = t->mesh;
    if (mesh->lines == 0) {
        return;
    }
    qsort(mesh->line, mesh->lines, 2 * sizeof *mesh->line, by_ends);
    t->on_line = RG_NEW(bool, (size_t)mesh->vertices);
    for (size_t i = 0; i < 2 * mesh->lines; i++) {
        t->on_line[mesh->line[i]] = true;
    }
}

rg_tets rg_tets_make(rg_mesh *mesh) {
    rg_tets t = {.mesh = mesh, .star = RG_NEW(rg_star, (size_t)mesh->vertices)};
    if (mesh->inner != NULL) {
        qsort(mesh->inner, (size_t)mesh->inners, 3 * sizeof *mesh->inner, by_vertices);
    }
    find_lines(&t);
    for (rg_gid e = 0; e < mesh->elements; e++) {
        rg_tet tet = {.original = rg_mesh_original(mesh, e),
                      .region = mesh->region != NULL ? mesh->region[e] : -1};
        for (int i = 0; i < 4; i++) {
            tet.corner[i] = mesh->corner[4 * e + i];
            tet.label[i] = label_of(mesh, 4 * e + i);
        }
        if (rg_tets_height(&t, tet.corner) < 0) {
            turn(&tet);
        }
        tet.height = rg_tets_height(&t, tet.corner);
        add(&t, &tet);
    }
    return t;
}

/* The sets of a face with this label. */
static int32_t group_of(int32_t label) {
    return label < 0 ? -label - 1 : label >= RG_SURFACE ? label - RG_SURFACE - 1 : -1;
}

/* Corners ascending, with their faces. */
static void put(rg_mesh *mesh, rg_gid e, const rg_tet *tet) {
    for (int i = 0; i < 4; i++) {
        int place = 0;
        for (int k = 0; k < 4; k++) {
            place += tet->corner[k] < tet->corner[i];
        }
        mesh->corner[4 * e + place] = tet->corner[i];
        mesh->set[4 * e + place] = group_of(tet->label[i]);
    }
    mesh->original[e] = tet->original;
    if (mesh->region != NULL) {
        mesh->region[e] = tet->region;
    }
}

static void resize(rg_mesh *mesh, size_t count) {
    rg_free(mesh->corner);
    rg_free(mesh->neighbour);
    rg_free(mesh->face);
    rg_free(mesh->set);
    rg_free(mesh->original);
    rg_free(mesh->inner); /* by old numbers */
    mesh->inner = NULL;
    mesh->inners = 0;
    rg_free(mesh->line);
    mesh->line = NULL;
    mesh->lines = 0;
    mesh->elements = (rg_gid)count;
    mesh->corner = RG_NEW(rg_gid, 4 * count);
    mesh->neighbour = RG_NEW(rg_gid, 4 * count);
    mesh->face = RG_NEW(int8_t, 4 * count);
    mesh->set = RG_NEW(int32_t, 4 * count);
    mesh->original = RG_NEW(rg_gid, count);
    if (mesh->region != NULL) {
        rg_free(mesh->region);
        mesh->region = RG_NEW(int32_t, count);
    }
}

void rg_tets_finish(rg_tets *t) {
    size_t left = 0;
    for (rg_gid i = 0; i < t->count; i++) {
        left += t->tet[i].corner[0] >= 0;
    }
    resize(t->mesh, left);
    rg_gid e = 0;
    for (rg_gid i = 0; i < t->count; i++) {
        if (t->tet[i].corner[0] >= 0) {
            put(t->mesh, e++, t->tet + i);
        }
    }
    for (rg_gid v = 0; v < t->mesh->vertices; v++) {
        rg_free(t->star[v].tet);
    }
    rg_free(t->star);
    rg_free(t->on_line);
    rg_free(t->tet);
}
