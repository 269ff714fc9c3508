/* What tiles cost, by the key mesh.weight of a case: for the partition. */
#ifndef RG_TILE_WEIGHT_H
#define RG_TILE_WEIGHT_H

#include "case/case.h"
#include "mesh/mesh.h"

/* [tiles]: the sum over a tile's elements of mesh.weight at their centroids. End the run (RG_USAGE) with a
 * message if that is not positive and finite somewhere. Caller frees with rg_free. Of a mesh; or of the
 * case's mesh file, of which each rank reads a share: collective, NULL on all ranks but 0. */
double *rg_tile_weights_of_mesh(const rg_case *c, const rg_mesh *mesh, int tile);
double *rg_tile_weights_of_file(const rg_case *c, MPI_Comm comm);

/* Brings together what the ranks know of the tiles, each of its own and 0 of others: all of weight[tiles] on
 * rank 0; frees it on others, which get NULL. Collective. */
double *rg_tile_weights_gather(double *weight, int64_t tiles, MPI_Comm comm);

#endif
