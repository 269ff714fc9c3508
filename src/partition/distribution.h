/* Distribution: which rank gets which tiles of a mesh, and the order in which it sweeps them. */
#ifndef RG_DISTRIBUTION_H
#define RG_DISTRIBUTION_H

#include "mesh/tile_graph.h"

/* Held by rank 0, whatever the mesh comes from: a distribution follows from the graph of tiles. */
typedef struct {
    int ranks;
    rg_gid elements; /* of the mesh; `tile` of them to a tile */
    int tile;
    int64_t tiles;
    int32_t *owner; /* [tiles]: rank */
    int64_t *list; /* [tiles]: those of rank 0 first, then those of rank 1, ... in the order of their sweep */
    int64_t *start; /* [ranks + 1]: where each rank's tiles begin */
    rg_lid *shared; /* [ranks]: how many of them share a face with another rank; they come first */
    rg_partition_quality quality;
} rg_distribution;

/* The distribution that gives tile t to owner[t], which it takes over. Ends the run with a message if a rank
 * gets more elements than it can number. Free with rg_distribution_free. */
rg_distribution *rg_distribution_make(const rg_tile_graph *g, int32_t *owner, int ranks);
void rg_distribution_free(rg_distribution *d);

/* Collective; `d` on rank 0. Tells each rank the counts, tiles and quality of its part, and makes room for
 * its elements. */
void rg_distribution_share(const rg_distribution *d, rg_part *own, MPI_Comm comm);

#endif
