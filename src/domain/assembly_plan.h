/* The plan of an assembly: which copies are one node, tile by tile, and which rows it is summed from. */
#ifndef RG_ASSEMBLY_PLAN_H
#define RG_ASSEMBLY_PLAN_H

#include <mpi.h>

#include "domain/halo.h"
#include "domain/conforming.h"

/* Nodes of a tile: those that it alone holds, then, from `border` on, those of which others have copies too,
 * with one row each from `row` on. */
typedef struct {
    size_t first, border, end;
    size_t row;
    bool waits; /* some of them have copies on other ranks */
} rg_tile_nodes;

typedef struct {
    size_t first, end;
} rg_sources;

typedef struct {
    rg_tile_nodes *tile; /* [tiles] */
    size_t nodes, copies;
    size_t *first_copy;  /* [nodes + 1]: copies of a node in its tile, by ascending element */
    int32_t *copy;       /* [copies]: rg_node_index of component 0 within the tile's fields */
    rg_sources *sources; /* [own rows]: of `source`, what the row's node is summed from */
    size_t *source;      /* rows, by ascending number of their tiles */
    rg_halo_plan halo;
} rg_assembly_plan;

/* Collective; free with rg_assembly_plan_free. */
rg_assembly_plan *rg_assembly_plan_make(const rg_domain *d, const rg_conforming_faces *j, MPI_Comm comm);

void rg_assembly_plan_free(rg_assembly_plan *p);

#endif
