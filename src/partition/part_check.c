#include "partition/part_check.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "base/mem.h"
#include "layout.h"
#include "mesh/check.h"

/* An element with faces on the surface. */
typedef struct {
    rg_gid id;
    int32_t open; /* bit f: face f is on the surface */
    int32_t part;
    double x[4][3];
} outer;

/* A face on the surface; two 64-bit words for MPI. */
typedef struct {
    uint64_t key;
    rg_gid element;
} face;

static uint64_t position_key(const double x[3]) {
    uint64_t h = 0;
    for (int i = 0; i < 3; i++) {
        h = rg_hash_double(h, x[i]);
    }
    return h;
}

/* Follows from the positions of the corners alone, in any order, and from the part. */
static uint64_t face_key(const double x[4][3], int f, int32_t part) {
    uint64_t sum = part > 0 ? rg_hash(0, (uint64_t)part) : 0;
    for (int k = 0; k < 3; k++) {
        sum += position_key(x[rg_face_node[f][k]]);
    }
    return sum;
}

/* ---- the surface, on rank 0 ---- */

static outer *list_outer(const rg_part *part, int *count) {
    outer *list = RG_NEW(outer, (size_t)part->elements);
    *count = 0;
    for (rg_lid i = 0; i < part->elements; i++) {
        const rg_element *e = &part->element[i];
        outer o = {.id = e->id, .part = e->part};
        for (int f = 0; f < 4; f++) {
            o.open |= e->neighbour[f] < 0 ? 1 << f : 0;
        }
        if (o.open != 0) {
            memcpy(o.x, e->x, sizeof o.x);
            list[(*count)++] = o;
        }
    }
    return list;
}

static int by_id(const void *a, const void *b) {
    const outer *p = a, *q = b;
    return (p->id > q->id) - (p->id < q->id);
}

/* All of them on rank 0, in order; NULL and 0 on the others. */
static outer *gather_outer(const rg_part *part, MPI_Comm comm, int *total) {
    int rank, ranks, own;
    MPI_Comm_rank(comm, &rank);
    MPI_Comm_size(comm, &ranks);
    outer *mine = list_outer(part, &own), *all = NULL;
    int *count = RG_NEW(int, (size_t)ranks), *at = RG_NEW(int, (size_t)ranks + 1);
    MPI_Gather(&own, 1, MPI_INT, count, 1, MPI_INT, 0, comm);
    for (int r = 0; r < ranks; r++) {
        at[r + 1] = at[r] + count[r];
    }
    *total = rank == 0 ? at[ranks] : 0;
    all = rank == 0 ? RG_NEW(outer, (size_t)*total + 1) : NULL;
    MPI_Datatype type;
    MPI_Type_contiguous(sizeof(outer), MPI_BYTE, &type);
    MPI_Type_commit(&type);
    MPI_Gatherv(mine, own, type, all, count, at, type, 0, comm);
    MPI_Type_free(&type);
    if (rank == 0) {
        qsort(all, (size_t)*total, sizeof *all, by_id);
    }
    rg_free(mine);
    rg_free(count);
    rg_free(at);
    return all;
}

static int by_key(const void *a, const void *b) {
    const face *p = a, *q = b;
    if (p->key != q->key) {
        return p->key < q->key ? -1 : 1;
    }
    return (p->element > q->element) - (p->element < q->element);
}

static face *list_faces(const outer *list, int count, int64_t *faces) {
    face *all = RG_NEW(face, 4 * (size_t)count + 1);
    *faces = 0;
    for (int i = 0; i < count; i++) {
        for (int f = 0; f < 4; f++) {
            if (list[i].open >> f & 1) {
                all[(*faces)++] = (face){face_key(list[i].x, f, list[i].part), list[i].id};
            }
        }
    }
    qsort(all, (size_t)*faces, sizeof *all, by_key);
    return all;
}

typedef struct {
    rg_gid element[2];
} pair;

static int by_elements(const void *a, const void *b) {
    const pair *p = a, *q = b;
    int k = p->element[0] == q->element[0];
    return (p->element[k] > q->element[k]) - (p->element[k] < q->element[k]);
}

/* Two elements may share several faces in place: they are told once. */
static void check_pairs(const face *all, int64_t faces, const rg_mesh_file *file,
                        rg_input_errors *input_errors) {
    pair *found = RG_NEW(pair, (size_t)faces + 1);
    size_t pairs = 0;
    for (int64_t i = 1; i < faces; i++) {
        if (all[i].key == all[i - 1].key) {
            found[pairs++] = (pair){{all[i - 1].element, all[i].element}};
        }
    }
    qsort(found, pairs, sizeof *found, by_elements);
    for (size_t i = 0; i < pairs; i++) {
        const rg_gid *e = found[i].element;
        bool told = i > 0 && by_elements(&found[i - 1], &found[i]) == 0;
        char *words = told ? NULL : rg_input_errors_place(input_errors, e[0], e[1]);
        if (words != NULL) {
            snprintf(words, RG_INPUT_ERROR_WORDS,
                     "elements %" PRId64 " and %" PRId64
                     " have a face at the same place, but are not neighbours: %s",
                     rg_mesh_file_original(file, e[0]), rg_mesh_file_original(file, e[1]),
                     rg_mesh_open_words(rg_mesh_file_header(file)->parts > 0));
        }
    }
    rg_free(found);
}

/* ---- geometry of the surface ---- */

typedef struct {
    double x[3];
    int64_t part, slot;
} place;

static int by_bits(const void *a, const void *b) {
    const place *p = a, *q = b;
    int order = memcmp(p->x, q->x, sizeof p->x);
    return order != 0 ? order : (p->part > q->part) - (p->part < q->part);
}

/* The elements at the surface as a mesh of their own, of which only the surface means anything. */
static rg_mesh *surface_mesh(const outer *list, int count, bool apart) {
    size_t slots = 4 * (size_t)count;
    rg_mesh *m = RG_NEW(rg_mesh, 1);
    *m = (rg_mesh){.elements = count,
                   .x = RG_NEW(double, 3 * slots),
                   .corner = RG_NEW(rg_gid, slots),
                   .neighbour = RG_NEW(rg_gid, slots),
                   .part = apart ? RG_NEW(int32_t, (size_t)count) : NULL,
                   .original = RG_NEW(rg_gid, (size_t)count)};
    place *at = RG_NEW(place, slots);
    for (size_t s = 0; s < slots; s++) {
        memcpy(at[s].x, list[s / 4].x[s % 4], sizeof at[s].x);
        at[s].part = list[s / 4].part;
        at[s].slot = (int64_t)s;
        apart ? m->part[s / 4] = list[s / 4].part : 0;
        m->neighbour[s] = list[s / 4].open >> s % 4 & 1 ? -1 : 0;
        m->original[s / 4] = list[s / 4].id;
    }
    qsort(at, slots, sizeof *at, by_bits);
    for (size_t s = 0; s < slots; s++) {
        if (s == 0 || by_bits(&at[s - 1], &at[s]) != 0) {
            memcpy(m->x + 3 * m->vertices++, at[s].x, sizeof at[s].x);
        }
        m->corner[at[s].slot] = m->vertices - 1;
    }
    rg_free(at);
    return m;
}

static void check_surface(const outer *list, int count, const rg_mesh_file *file,
                          rg_input_errors *input_errors) {
    rg_mesh *surface = surface_mesh(list, count, rg_mesh_file_header(file)->parts > 0);
    rg_input_errors found = {.name = input_errors->name};
    rg_mesh_check_surface(surface, &found);
    for (rg_gid e = 0; e < surface->elements && found.count > 0; e++) { /* now that they are needed */
        surface->original[e] = rg_mesh_file_original(file, list[e].id);
    }
    if (found.count > 0) {
        rg_mesh_check_surface(surface, input_errors);
    }
    rg_mesh_free(surface);
}

/* ---- three elements ---- */

/* Where in all[faces] `key` is; -1: nowhere. */
static int64_t find(const face *all, int64_t faces, uint64_t key) {
    int64_t low = 0, high = faces;
    while (low < high) {
        int64_t middle = (low + high) / 2;
        if (all[middle].key < key) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low < faces && all[low].key == key ? low : -1;
}

/* Where the surface has the face in `slot` of the part, which is between two elements; the lower one looks.
 */
static int64_t third(const rg_part *part, const face *all, int64_t faces, int64_t slot) {
    const rg_element *e = &part->element[slot / 4];
    int f = (int)(slot % 4);
    return e->neighbour[f] > e->id ? find(all, faces, face_key(e->x, f, e->part)) : -1;
}

/* Looks for the surface's faces among the own ones between elements. */
static void check_inside(const rg_part *part, const face *all, int64_t faces, const rg_mesh_file *file,
                         rg_input_errors *input_errors) {
    int64_t wrong = 0, slots = 4 * (int64_t)part->elements;
#pragma omp parallel for schedule(static) reduction(+ : wrong)
    for (int64_t slot = 0; slot < slots; slot++) {
        wrong += third(part, all, faces, slot) >= 0;
    }
    for (int64_t slot = 0; slot < slots && wrong > 0; slot++) {
        const rg_element *e = &part->element[slot / 4];
        int64_t at = third(part, all, faces, slot);
        char *words = at >= 0 ? rg_input_errors_place(input_errors, e->id, slot % 4 - 4) : NULL;
        if (words != NULL) {
            snprintf(words, RG_INPUT_ERROR_WORDS,
                     "elements %" PRId64 ", %" PRId64 " and %" PRId64 " share a face",
                     rg_mesh_file_original(file, e->id), rg_mesh_file_original(file, e->neighbour[slot % 4]),
                     rg_mesh_file_original(file, all[at].element));
        }
    }
}

void rg_part_check(const rg_part *part, const char *name, const rg_mesh_file *file, MPI_Comm comm) {
    rg_input_errors input_errors = {.name = name};
    int count, rank;
    int64_t faces = 0;
    MPI_Comm_rank(comm, &rank);
    outer *list = gather_outer(part, comm, &count);
    face *all = list_faces(list, count, &faces);
    check_pairs(all, faces, file, &input_errors); /* rank 0's; the others have none yet */
    MPI_Bcast(&faces, 1, MPI_INT64_T, 0, comm);
    if (rank != 0) {
        rg_free(all);
        all = RG_NEW(face, (size_t)faces + 1);
    }
    MPI_Bcast(all, (int)(2 * faces), MPI_UINT64_T, 0, comm);
    check_inside(part, all, faces, file, &input_errors);
    rg_free(all);
    rg_input_errors_agree(&input_errors, comm);
    if (rank == 0) {
        check_surface(list, count, file, &input_errors);
    }
    rg_free(list);
    rg_input_errors_agree(&input_errors, comm);
}
