/* The domain: what one rank sweeps. Elements and interfaces in blocks of RG_LANES (kernels/layout.h), their
 * links and geometry, and the schedule in which the passes run over them. Knows the mesh, no physics and no
 * messages.
 *
 * Elements: own ones that touch another rank, then the other own ones, then ghosts (elements of other ranks
 * across a partition face); each group is padded to whole blocks. Tiles are runs of consecutive own blocks
 * small enough for the cache; the order is a Hilbert curve, so a tile is compact. Interfaces: those inside a
 * tile, tile by tile; those between tiles; those shared with another rank; one block of zeros, to which
 * surface faces link. */
#ifndef RG_DOMAIN_H
#define RG_DOMAIN_H

#include <stdbool.h>
#include <stddef.h>

#include "case.h"
#include "mesh.h"

typedef struct {
    size_t begin, end;   /* element blocks */
    size_t ibegin, iend; /* blocks of the interfaces inside the tile */
} rg_tile;

/* A face shared with another rank, from this rank's point of view. */
typedef struct {
    int32_t rank; /* the other rank */
    rg_gid minus; /* key, the same on both ranks: number and local face of the minus element */
    int8_t minus_face;
    int32_t own, ghost; /* links: 4 * element + face */
} rg_shared_face;

typedef struct {
    size_t elements, interfaces;    /* own elements; interfaces of which the minus side is owned */
    size_t blocks, boundary_blocks; /* own blocks; those with elements that touch another rank come first */
    size_t ghost_blocks;
    rg_gid *id;         /* [own and ghost slots]: global element number; -1 in padding */
    double *corner;     /* [own slots][4][3]: m */
    int8_t *set;        /* [own slots][4]: surface set, -1 for none */
    double *geom;       /* kernels/layout.h, own blocks */
    int32_t *neighbour; /* own blocks */
    int32_t *interface; /* own blocks */
    size_t tiles, boundary_tiles;
    rg_tile *tile;

    size_t iblocks;       /* all but the zero block */
    size_t between_begin; /* first block of interfaces between tiles */
    size_t shared_begin;  /* first block of interfaces shared with another rank */
    int32_t *side[2];     /* links of the minus and plus side */
    double *igeom;
    uint8_t *counted; /* [interface]: 1 where this rank speaks for it (owns the minus side) */

    size_t shared;
    rg_shared_face *shared_face; /* sorted by rank, then key */
} rg_domain;

/* Material and penalty that enter the interface geometry. */
typedef struct {
    double lambda, mu, beta_s;
    rg_penalty penalty;
} rg_interface_material;

/* Builds the domain of rank `rank` from its part; `tile_elements` is the size of a tile. The caller owns the
 * result. */
rg_domain *rg_domain_build(const rg_part *part, int rank, const rg_interface_material *m,
                           size_t tile_elements);

void rg_domain_free(rg_domain *d);

#endif
