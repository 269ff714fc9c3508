/* Deals: which rank gets which tiles of a mesh, and the order in which it sweeps them. */
#ifndef RG_DEAL_H
#define RG_DEAL_H

#include "mesh/tile_graph.h"

/* Held by rank 0, whatever the mesh comes from: a deal follows from the graph of tiles. */
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
} rg_deal;

/* The deal that gives tile t to owner[t], which it takes over. Ends the run with a message if a rank gets
 * more elements than it can number. Free with rg_deal_free. */
rg_deal *rg_deal_make(const rg_tile_graph *g, int32_t *owner, int ranks);
void rg_deal_free(rg_deal *d);

/* Collective; `d` on rank 0. Tells each rank the counts, tiles and quality of its part, and makes room for
 * its elements. */
void rg_deal_share(const rg_deal *d, rg_part *own, MPI_Comm comm);

#endif
