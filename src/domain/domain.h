/* The domain: what one rank sweeps. Elements and interfaces in tiles and blocks (kernels/layout.h), their
 * links and geometry. Knows the mesh, no physics and no messages.
 *
 * Tiles are the mesh's; those that touch another rank come first. Each has its elements, the interfaces
 * inside it and its tile-boundary faces, padded to whole blocks. Its elements lie by material, each of them
 * padded, so every block is of one material; of each those come last that have a neighbour in another tile,
 * so the boundary sweep finds them in few blocks; then by number. A tile-boundary face has a row by which the
 * other side finds its trace and its tractions; the rows of other ranks' tile-boundary faces come behind the
 * own ones, in the order in which they arrive. */
#ifndef RG_DOMAIN_H
#define RG_DOMAIN_H

#include <stdbool.h>
#include <stddef.h>

#include "case/case.h"
#include "layout.h"
#include "mesh/mesh.h"

typedef struct {
    rg_gid first;                /* global number of its first element */
    size_t begin, end;           /* element blocks */
    size_t ibegin, sbegin, iend; /* interface blocks: inside, then tile-boundary faces */
    size_t row;                  /* row of the first tile-boundary face */
} rg_tile;

/* A face shared with another rank, from this rank's point of view. */
typedef struct {
    int32_t rank;     /* the other rank */
    rg_gid tile[2];   /* global numbers, the lower one first */
    rg_gid key;       /* the same on both ranks: 4 * lower element number + its local face */
    size_t tile_face; /* its row here */
} rg_shared_face;

typedef struct {
    size_t elements, interfaces; /* own elements; interfaces that this rank counts */
    size_t blocks, iblocks;
    rg_gid *id;           /* [slots]: global element number; -1 in padding */
    double *corner;       /* [slots][4][3]: m */
    int32_t *set;         /* [slots][4]: group of surface sets, -1 for none */
    int32_t *region;      /* [slots]: group of volume sets, -1 for none */
    uint8_t *across;      /* [slots]: bits of faces beyond which volume sets or the material differ */
    uint16_t *material;   /* [blocks]: number of its material */
    uint8_t *rim;         /* [blocks]: 1 where an element has a neighbour in another tile */
    uint16_t *place;      /* [tiles][tile_elements]: slot in its tile, by number in it */
    rg_real *geom;        /* kernels/layout.h */
    rg_real *turn;        /* [blocks][RG_TURN][lane]: axes of the solid; NULL: none differ in a material */
    int32_t *neighbour;   /* links */
    int32_t *interface;   /* links */
    rg_gid tile_elements; /* of every tile but the mesh's last one */
    size_t tiles, boundary_tiles;
    rg_tile *tile;
    size_t tile_blocks, tile_iblocks,
        tile_sblocks; /* largest of a tile: all, interfaces, tile-boundary faces */

    int32_t *side[2]; /* links of the interfaces */
    rg_real *igeom;
    uint16_t (*beside)[2]; /* [interface]: materials of both sides, the lower first; NULL: there is but one */
    uint8_t *counted; /* [interface]: 1 where this copy speaks for the face (owns the lower-numbered side) */
    size_t own_rows;  /* of the tile-boundary faces, padding included; `shared` more come behind */
    size_t shared;
    rg_shared_face *shared_face; /* sorted by rank, tiles and key: the order in which rows are exchanged */
} rg_domain;

/* Materials and penalty that enter the interface geometry. */
typedef struct {
    int materials;
    const rg_material *material; /* [materials] */
    double beta_s;
    rg_penalty penalty;
} rg_interface_material;

/* Builds the domain of rank `rank` from its part. Bit f of joined[i] is set where the elements on both sides
 * of face f of element i share their nodes (domain/conforming.h), so that it carries no interface; NULL:
 * nowhere. The caller owns the result. */
rg_domain *rg_domain_build(const rg_part *part, const uint8_t *joined, int rank,
                           const rg_interface_material *m);

/* Tile that holds an element slot. */
const rg_tile *rg_tile_of(const rg_domain *d, size_t slot);

/* Slot, in its tile t, of element `id`. */
static inline size_t rg_slot_in(const rg_domain *d, const rg_tile *t, rg_gid id) {
    return d->place[(size_t)(t - d->tile) * (size_t)d->tile_elements + (size_t)(id - t->first)];
}

/* Where the blocks of tile t that are of one material with its block `begin` end; both count from the tile's
 * first block. */
static inline size_t rg_run_end(const rg_domain *d, const rg_tile *t, size_t begin) {
    const uint16_t *of = d->material + t->begin;
    size_t end = begin + 1;
    while (end < t->end - t->begin && of[end] == of[begin]) {
        end++;
    }
    return end;
}

/* Mass of an element (kg); `m`: the materials, by number. */
static inline double rg_element_mass(const rg_domain *d, const rg_material *m, size_t slot) {
    return m[d->material[slot / RG_LANES]].density * (double)d->geom[rg_geom_index(slot, RG_GEOM_VOLUME)];
}

/* The area vector of an interface (m^2), and its length. */
double rg_interface_area(const rg_domain *d, size_t i, double normal[3]);

void rg_domain_free(rg_domain *d);

#endif
