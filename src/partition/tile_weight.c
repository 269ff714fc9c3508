#include "partition/tile_weight.h"

#include <float.h>

#include "base/error.h"
#include "base/mem.h"
#include "base/first_bad.h"
#include "mesh/file.h"

enum { SLAB = 256 }; /* tiles of a file at once */

typedef struct {
    const rg_case *c;
    int64_t tile;
    double *weight;   /* [tiles] */
    rg_first_bad bad; /* where it is not positive and finite */
} scale;

/* Adds mesh.weight at the centroid of an element with these corners to that of its tile. */
static void weigh(scale *s, rg_gid element, const double *const corner[4]) {
    double x[3];
    for (int i = 0; i < 3; i++) {
        x[i] = 0.25 * ((corner[0][i] + corner[1][i]) + (corner[2][i] + corner[3][i]));
    }
    double value = rg_expr_value(s->c->mesh.weight, x, 0);
    s->weight[element / s->tile] += value;
    if (!(value >= DBL_MIN && value <= DBL_MAX)) {
        rg_first_bad_note(&s->bad, 0, x, value);
    }
}

static _Noreturn void refuse(const scale *s) {
    rg_fatal(RG_USAGE, "%s: mesh.weight: %s is %g at (%g, %g, %g); allowed: numbers > 0", s->c->path,
             rg_expr_text(s->c->mesh.weight), s->bad.value, s->bad.x[0], s->bad.x[1], s->bad.x[2]);
}

double *rg_tile_weights_of_mesh(const rg_case *c, const rg_mesh *mesh, int tile) {
    scale s = {.c = c,
               .tile = tile,
               .weight = RG_NEW(double, (size_t)((mesh->elements + tile - 1) / tile)),
               .bad = {.which = RG_NOWHERE}};
    for (rg_gid e = 0; e < mesh->elements; e++) {
        const double *corner[4];
        for (int i = 0; i < 4; i++) {
            corner[i] = mesh->x + 3 * mesh->corner[4 * e + i];
        }
        weigh(&s, e, corner);
    }
    if (s.bad.which != RG_NOWHERE) {
        refuse(&s);
    }
    return s.weight;
}

static void weigh_slab(scale *s, const rg_mesh_slab *slab) {
    for (rg_gid e = 0; e < slab->elements; e++) {
        const double *corner[4];
        for (int i = 0; i < 4; i++) {
            corner[i] = slab->x + 3 * slab->at[4 * e + i];
        }
        weigh(s, slab->first + e, corner);
    }
}

double *rg_tile_weights_gather(double *weight, int64_t tiles, MPI_Comm comm) {
    int rank;
    MPI_Comm_rank(comm, &rank);
    /* One rank has each value, the others have zero: the sum only brings them together. */
    MPI_Reduce(rank == 0 ? MPI_IN_PLACE : weight, weight, (int)tiles, MPI_DOUBLE, MPI_SUM, 0, comm);
    if (rank > 0) {
        rg_free(weight);
        return NULL;
    }
    return weight;
}

double *rg_tile_weights_of_file(const rg_case *c, MPI_Comm comm) {
    int rank, ranks;
    MPI_Comm_rank(comm, &rank);
    MPI_Comm_size(comm, &ranks);
    rg_input_errors input_errors = {.name = c->mesh.file};
    rg_mesh_file *f = rg_mesh_file_open_on_all(c->mesh.file, comm);
    const rg_mesh_header *h = rg_mesh_file_header(f);
    scale s = {.c = c,
               .tile = h->tile_elements,
               .weight = RG_NEW(double, (size_t)h->tiles),
               .bad = {.which = RG_NOWHERE}};
    int64_t end = h->tiles * (rank + 1) / ranks;
    for (int64_t t = h->tiles * rank / ranks; t < end; t += SLAB) {
        rg_mesh_slab *slab = rg_mesh_file_slab(f, t, t + SLAB < end ? t + SLAB : end, &input_errors);
        if (slab != NULL) {
            weigh_slab(&s, slab);
            rg_mesh_slab_free(slab);
        }
    }
    rg_input_errors_agree(&input_errors, comm);
    if (rg_first_bad_lowest(&s.bad, comm)) {
        rg_speak(comm);
        refuse(&s);
    }
    double *weight = rg_tile_weights_gather(s.weight, h->tiles, comm);
    rg_mesh_file_close(f);
    return weight;
}
