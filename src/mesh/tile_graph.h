/* The graph of tiles: what a partition cuts. A small thing: one node for some hundred elements. */
#ifndef RG_TILE_GRAPH_H
#define RG_TILE_GRAPH_H

#include "mesh/mesh.h"

/* Which tiles share faces. */
typedef struct {
    rg_gid elements; /* of the mesh; tile t has those from t * tile on */
    int tile;
    int64_t tiles;
    int64_t *start;     /* [tiles + 1] */
    int64_t *neighbour; /* [start[tiles]] */
    int32_t *faces;     /* [start[tiles]] */
    double *weight;     /* [tiles] cost of a tile; NULL: its elements */
} rg_tile_graph;

/* The graph of the tiles of a connected mesh, `tile` elements each. Free with rg_tile_graph_free. */
rg_tile_graph *rg_tile_graph_make(const rg_mesh *mesh, int tile);
void rg_tile_graph_free(rg_tile_graph *g);

/* METIS partition (the best of several, by what the slowest part has to do), an edge weighing as many faces
 * as two tiles share, a tile its cost; fixed seed: part[tiles] in 0..parts-1, no part empty, numbered in the
 * order of their tiles. Ends the run with a message if there are more parts than tiles. */
void rg_tile_graph_partition(const rg_tile_graph *g, int parts, int32_t *part);

/* Of a partition in `parts` parts. */
rg_partition_quality rg_tile_graph_quality(const rg_tile_graph *g, int parts, const int32_t *part);

#endif
