/* The mesh that a case asks for. */
#include "partition/mesh_case.h"

#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "case/problem.h"
#include "mesh/file.h"
#include "partition/material_map.h"
#include "partition/tile_weight.h"

static const char *list_names(const rg_mesh_header *h, char *text, size_t size) {
    size_t used = 0;
    text[0] = '\0';
    for (int s = 0; s < h->sets && used < size; s++) {
        used += (size_t)snprintf(text + used, size - used, "%s%s", s > 0 ? ", " : "", h->set_name[s]);
    }
    return h->sets > 0 ? text : "none";
}

/* The surface sets that the boundary names must be in the mesh file: the case file could not know. */
static void check_sets(const rg_case *c) {
    rg_mesh_file *f = rg_mesh_file_open(c->mesh.file);
    const rg_mesh_header *h = rg_mesh_file_header(f);
    const char *names[RG_MAX_SETS + 1] = {NULL};
    char all[1024];
    memcpy(names, h->set_name, (size_t)h->sets * sizeof *names);
    for (int b = 0; b < c->boundaries; b++) {
        const char *set = c->boundary[b].set;
        bool known = false;
        for (int s = 0; s < h->sets; s++) {
            known = known || strcmp(set, names[s]) == 0;
        }
        if (!known) {
            const char *near = rg_nearest(set, names);
            rg_fatal(RG_USAGE, "%s: boundary[%d].set: %s: %s has no such surface set; allowed: %s%s%s%s",
                     c->path, b, set, c->mesh.file, list_names(h, all, sizeof all),
                     near != NULL ? "; did you mean '" : "", near != NULL ? near : "",
                     near != NULL ? "'?" : "");
        }
    }
    rg_mesh_file_close(f);
}

rg_mesh *rg_mesh_of_case(const rg_case *c) {
    if (c->mesh.file != NULL) {
        check_sets(c);
        return rg_mesh_file_read(c->mesh.file);
    }
    return rg_mesh_box(c->mesh.cells, c->mesh.origin, c->mesh.size, c->mesh.jitter, c->mesh.seed);
}

static rg_part *part_of_file(const rg_case *c, double *cost, bool known, int rank, MPI_Comm comm) {
    if (rank == 0) {
        check_sets(c);
    }
    MPI_Barrier(comm); /* what is wrong with the file as such, rank 0 has told */
    if (!known && c->mesh.weight != NULL) {
        cost = rg_tile_weights_of_file(c, comm);
    }
    return rg_part_read(c->mesh.file, cost, comm);
}

static rg_part *part_of_box(const rg_case *c, double *cost, bool known, int rank, MPI_Comm comm) {
    rg_mesh *mesh = NULL;
    int tile = 0;
    if (rank == 0) {
        mesh = rg_mesh_of_case(c);
        tile = rg_tile_elements(mesh->elements);
        if (!known && c->mesh.weight != NULL) {
            cost = rg_tile_weights_of_mesh(c, mesh, tile);
        }
    }
    rg_part *part = rg_part_distribute_weighted(mesh, tile, cost, comm);
    rg_mesh_free(mesh);
    return part;
}

rg_part *rg_part_of_case(const rg_case *c, double *cost, MPI_Comm comm) {
    int rank, known = cost != NULL;
    MPI_Comm_rank(comm, &rank);
    MPI_Bcast(&known, 1, MPI_INT, 0, comm);
    rg_part *part = c->mesh.file != NULL ? part_of_file(c, cost, known, rank, comm)
                                         : part_of_box(c, cost, known, rank, comm);
    rg_materials_assign(c, part, comm);
    return part;
}
