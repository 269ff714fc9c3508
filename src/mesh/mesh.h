/* Meshes: the whole one on the rank that makes and partitions it, and the part that each rank gets. */
#ifndef RG_MESH_H
#define RG_MESH_H

#include <mpi.h>
#include <stddef.h>
#include <stdint.h>

#include "mesh/sets.h"

typedef int64_t rg_gid; /* global element or vertex number */
typedef int32_t rg_lid; /* number local to a rank */

/* The whole mesh. Held by rank 0 only, during set-up. Elements are numbered along a Hilbert curve through
 * their centroids; a tile is a run of consecutive elements, tile t those from t * tile on. Tiles are what
 * ranks own and what threads sweep; they follow from the mesh alone, and so does every sum that runs over
 * one. */
typedef struct {
    rg_gid vertices, elements;
    int tile;          /* elements of a tile; 0: not chosen, so that rg_mesh_tile tells */
    double *x;         /* [vertices][3] m */
    rg_gid *corner;    /* [elements][4], ascending within an element (see kernels/layout.h) */
    rg_gid *neighbour; /* [elements][4]: element across local face f (opposite corner f); -1 on the surface */
    int8_t *face;      /* [elements][4]: the neighbour's local face number; -1 on the surface */
    int32_t *set;    /* [elements][4]: group of a face among `surface`, the same on both sides; -1 for none */
    rg_sets surface; /* named sets of faces, on the surface and inside */
    rg_gid *original; /* [elements]: numbers that the elements had in the input; NULL: as here */
    int32_t *region;  /* [elements]: group among `volume`; -1 for none; NULL: none at all */
    rg_sets volume;   /* named sets of elements */
    int32_t
        crack; /* 1 + set of faces inside that are a crack from the start (mesh/import/crack.h); 0: none */
    int32_t *part; /* [elements]: parts that are kept apart although they touch (mesh/apart.h); NULL: none */
    rg_gid *inner; /* [inners][3]: vertices, ascending, of faces inside that the input has: an import only */
    size_t inners;
    rg_gid *line; /* [lines][2]: vertices, ascending, of edges that the input names: an import only */
    size_t lines;
} rg_mesh;

/* Box of nx ny nz cubes of 6 tetrahedra (Kuhn: all around one main diagonal, so that neighbours match), from
 * `origin` to origin + size, surface sets "x-", "x+", "y-", "y+", "z-", "z+". Interior vertices are moved by
 * up to `jitter` times the smallest cell edge in each component, by a counter-based hash of seed and vertex
 * number. Ends the run with a message if an element is turned inside out (names it). */
rg_mesh *rg_mesh_box(const int64_t cells[3], const double origin[3], const double size[3], double jitter,
                     int64_t seed);

/* The number by which a message calls element e: that of the input. */
static inline rg_gid rg_mesh_original(const rg_mesh *mesh, rg_gid e) {
    return mesh->original != NULL ? mesh->original[e] : e;
}

/* Renumbers the elements along a Hilbert curve through their centroids, those at the same point in the order
 * of their numbers, so that runs of consecutive numbers are compact. Lengths count in mean extents of the
 * elements along each axis; the curve starts at the lower corner of the mesh. Fills `original`; leaves
 * `neighbour` and `face` to rg_mesh_connect. */
void rg_mesh_sort(rg_mesh *mesh);

/* Mean extent of the elements along each axis (m); `box` is that around the mesh. */
void rg_mesh_mean_extent(const rg_mesh *mesh, const double box[2][3], double extent[3]);

/* Elements of a tile in a mesh of so many: `most` (RG_TILE, or what is asked for, a multiple of 16 up to
 * RG_MOST_TILE), fewer in a small mesh, so that there are tiles enough. */
int rg_tile_elements(rg_gid elements, int most);

/* Elements of a tile of this mesh. */
int rg_mesh_tile(const rg_mesh *mesh);

/* Fills `neighbour` and `face` from `corner`. Ends the run, naming them, if three elements share a face. */
void rg_mesh_connect(rg_mesh *mesh);

/* Lower and upper corner of all vertices (m). */
void rg_mesh_box_around(const rg_mesh *mesh, double box[2][3]);

void rg_mesh_free(rg_mesh *mesh);

/* One element with all that its rank must know of it. */
typedef struct {
    rg_gid id;
    double x[4][3];         /* corners (m) */
    double volume;          /* m^3, > 0 */
    rg_gid neighbour[4];    /* -1 on the surface */
    double other_volume[4]; /* the neighbour's volume (m^3); own volume on the surface */
    int32_t owner[4];       /* rank of the neighbour; -1 on the surface */
    int8_t face[4];         /* the neighbour's local face; -1 on the surface */
    int32_t set[4];         /* group of surface sets, -1 for none */
    int32_t region;         /* group of volume sets, -1 for none */
    int32_t part;           /* of those that are kept apart; 0 where none are */
    uint16_t material;      /* which of the case's, once rg_materials_assign has run; until then 0 */
    uint16_t beside[4];     /* the neighbour's; its own on the surface */
    uint8_t across; /* bits of faces beyond which it is of other volume sets or another material, likewise */
} rg_element;

/* Euler angles of the axes of an element's solid and its neighbours' (degrees); on the surface its own. */
typedef struct {
    rg_gid id;
    double own[3], beside[4][3];
} rg_turn;

/* How good a partition is. */
typedef struct {
    double imbalance;       /* most elements on a rank over their mean */
    double cost_imbalance;  /* the same of the costs that the partition was told; without any, of elements */
    rg_gid cut_faces;       /* interior faces between ranks */
    int neighbours_max;     /* ranks that one shares faces with: most */
    double neighbours_mean; /* ... and mean */
} rg_partition_quality;

/* The part of the mesh that a rank owns, tile by tile in the order in which it is swept: first the tiles that
 * share a face with another rank, then the others, each by ascending number. */
typedef struct {
    rg_gid total;      /* elements of the whole mesh */
    rg_gid interfaces; /* interior faces of the whole mesh */
    double box[2][3];  /* lower and upper corner of the whole mesh (m) */
    int tile;          /* elements of a tile; the last one of the mesh may have fewer */
    int32_t parts;     /* of the whole mesh that are kept apart; 0: none are */
    rg_lid tiles;      /* own tiles */
    rg_lid boundary;   /* of these, how many share a face with another rank; they come first */
    rg_gid *tile_id;   /* [tiles]: global number of the tile */
    rg_lid elements;   /* own elements */
    rg_element *element;
    rg_turn *turn; /* [elements]; NULL: no solid has axes that differ from element to element */
    rg_gid
        *original; /* [elements]: numbers in the mesh that this one was cut from; NULL if it is the whole */
    rg_sets surface, volume;      /* sets of the whole mesh */
    rg_partition_quality quality; /* of the partition of the whole mesh */
} rg_part;

/* Mean of its corners (m). */
void rg_element_centroid(const rg_element *e, double x[3]);

/* Elements of global tile `id`. */
static inline rg_lid rg_tile_size(const rg_part *part, rg_gid id) {
    rg_gid left = part->total - id * part->tile;
    return (rg_lid)(left < part->tile ? left : part->tile);
}

/* Collective. Rank 0 gives the mesh (others NULL), partitions it in tiles of `tile` elements for the ranks of
 * `comm` and sends each its part. The caller owns the result. */
rg_part *rg_part_distribute(const rg_mesh *mesh, int tile, MPI_Comm comm);

/* The same, with the cost of each tile for the partition: weight[tiles] on rank 0, from rg_alloc, taken over;
 * or NULL. */
rg_part *rg_part_distribute_weighted(const rg_mesh *mesh, int tile, double *weight, MPI_Comm comm);

/* Collective. The same from the mesh file at `path`: rank 0 reads the graph of tiles and a partition for the
 * ranks of `comm` (METIS makes one if the file has none for so many, or there are weights), each rank then
 * reads its own tiles; no rank ever holds more than its part. The result has the same bits as that of
 * rg_part_distribute of the whole mesh with the same partition. Ends the run (RG_USAGE) if the file is
 * damaged, an element has no volume, elements on both sides of a face do not agree about it, graph, counts or
 * box are not those of the elements, or the surface is not closed (partition/part_check.h): with messages
 * that do not depend on the number of ranks (base/input_errors.h). The caller owns the result. */
rg_part *rg_part_read(const char *path, double *weight, MPI_Comm comm);

void rg_part_free(rg_part *part);

#endif
