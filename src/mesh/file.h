/* Mesh files: a mesh as the solver wants it, so that a run builds nothing and each rank reads its own part.
 *
 * HDF5, one dataset per array, all at the top. Elements are numbered along a Hilbert curve through their
 * centroids; a tile is the run of `tile_elements` (256; fewer in a small mesh) consecutive numbers.
 * Integers are signed and as wide as their values need, numbers are 64-bit floats, lengths are in m.
 *
 *   attributes      format = "rhegma mesh", version = 1 to 4, program
 *                   vertices, elements, interfaces (interior faces), tile_elements, tiles, surface_sets,
 *                   volume_sets (how many there are); box [2][3]: lower and upper corner
 *   surface_sets    [surface_sets] names, at most 255 bytes each, in 64 bytes where those are enough; not
 * there if there are none volume_sets     [volume_sets] likewise
 *
 * and only from version 2 on, which is for sets that overlap (3: and that have faces between elements),
 *
 *   attributes      surface_combinations, volume_combinations: rows of the next two, which are not there if 0
 *   surface_combinations  [rows][2] number of a combination, from 0 on, and one of the sets that it is of,
 * both volume_combinations   ascending (mesh/sets.h)
 *
 * and only from version 4 on, which is for parts that are kept apart although they touch (mesh/apart.h), and
 * for cracks (mesh/import/crack.h),
 *
 *   attributes      parts: how many there are, 0 if none are kept apart; crack: 1 + the surface set whose
 *                   faces between elements are open from the start, 0: none
 *   part            [elements] which one an element is of; not there if none are kept apart
 *
 *   corner          [elements][4] vertices, ascending; face f of an element is the one opposite corner f
 *   neighbour       [elements][4] element across face f; -1 on the surface
 *   face            [elements][4] which face of the neighbour that is; -1 on the surface
 *   set             [elements][4] surface set of face f, or surface_sets + its combination; -1 for none. A
 *                   face between two elements has the same on both sides, before version 3 none
 *   region          [elements] volume set, or volume_sets + the combination; -1 for none
 *   original        [elements] number of the element in the input
 *
 *   vertex_start    [tiles + 1] row at which the vertices of each tile begin in the next two
 *   vertex          [rows] numbers of the vertices that a tile needs, ascending for each tile
 *   x               [rows][3] their positions; those of a vertex that several tiles need are repeated
 *
 *   tile_start      [tiles + 1] row at which the neighbours of each tile begin in the next two
 *   tile_neighbour  [rows] numbers of the tiles it shares faces with, ascending for each tile
 *   tile_faces      [rows] how many faces
 *   partition_N     [tiles] rank 0 .. N - 1 that owns the tile; optional, any number of them
 *
 *   checksum/NAME   of dataset NAME: one for each tile's rows where the rows belong to tiles (corner to x),
 *                   one for the whole in the others; rg_rows_checksum (mesh/rows.h) says how
 *
 * So everything a run of tiles needs is one contiguous stretch of each dataset: positions stand with the
 * tiles although that repeats those on a tile's surface (about twice in all, a fifth of the file),
 * because the vertices of a tile are scattered over any list without repetition. The checksums are ours and
 * not HDF5's fletcher32: that one needs chunks, whose index and whole-chunk reads cost more than they give in
 * a file that is written once and read in long stretches, and a reader of some tiles can verify what it
 * reads. The file's own structure is in HDF5's newer format, in which every piece of it carries a checksum
 * that HDF5 verifies.
 *
 * Vertices keep the numbers of the input, since these orient all faces.
 *
 * Errors end the run with status RG_USAGE and a message that names file and dataset; of the rows of tiles all
 * that is wrong is told at once (base/input_errors.h). */
#ifndef RG_MESH_FILE_H
#define RG_MESH_FILE_H

#include <stdbool.h>

#include "base/input_errors.h"
#include "mesh/mesh.h"
#include "mesh/tile_graph.h"

/* A file is of the lowest version that has what it holds, so that older programs read it if they can. */
enum { RG_MESH_VERSION = 4 };

typedef struct {
    rg_gid vertices, elements, interfaces;
    int64_t tile_elements, tiles;
    double box[2][3]; /* m */
    rg_sets surface, volume;
    int32_t parts; /* that are kept apart; 0: none are */
    int32_t crack; /* 1 + surface set; 0: none */
} rg_mesh_header;

typedef struct {
    int parts;
    const int32_t *owner; /* [tiles] */
} rg_tile_partition;

/* A run of tiles and the vertices they need: those of one tile after those of the other, so that what several
 * need is repeated. */
typedef struct {
    rg_gid first, elements; /* number of the first element, and how many there are */
    rg_gid vertices;
    rg_gid *vertex;    /* [vertices] their numbers, ascending within a tile */
    double *x;         /* [vertices][3] m */
    rg_gid *corner;    /* [elements][4] numbers of vertices */
    rg_lid *at;        /* [elements][4] where they stand in `vertex`, among those of the element's tile */
    rg_gid *neighbour; /* [elements][4], and so on as in rg_mesh */
    int8_t *face;
    int32_t *set, *region;
    int32_t *part; /* NULL: no parts are kept apart */
    rg_gid *original;
} rg_mesh_slab;

typedef struct rg_mesh_file rg_mesh_file;

/* Opens a mesh file and reads its header. Not collective, no MPI: every rank may open the file for itself. */
rg_mesh_file *rg_mesh_file_open(const char *path);

/* The same on all ranks of `comm`, collective: those that cannot open it say so once. What is wrong with the
 * header every rank would tell, so one of them has read it before. */
rg_mesh_file *rg_mesh_file_open_on_all(const char *path, MPI_Comm comm);

const rg_mesh_header *rg_mesh_file_header(const rg_mesh_file *f);

/* Tiles begin .. end - 1, checked against their checksums, for indices out of range, and each element by
 * itself (rg_tet_sound). Caller frees. NULL: something is wrong, and `input_errors` has it, told tile by
 * tile. */
rg_mesh_slab *rg_mesh_file_slab(rg_mesh_file *f, int64_t begin, int64_t end, rg_input_errors *input_errors);
void rg_mesh_slab_free(rg_mesh_slab *slab);

/* The number that element `element` had in the input, for messages; its number in the file if that cannot be
 * read. */
rg_gid rg_mesh_file_original(const rg_mesh_file *f, rg_gid element);

rg_tile_graph *rg_mesh_file_graph(rg_mesh_file *f);

/* Fills owner[tiles]; false if the file has no partition for so many ranks. */
bool rg_mesh_file_partition(rg_mesh_file *f, int parts, int32_t *owner);

/* For how many ranks the file has partitions, ascending; returns how many such numbers there are. Caller
 * frees *parts with rg_free. */
int rg_mesh_file_partitions(rg_mesh_file *f, int **parts);

void rg_mesh_file_close(rg_mesh_file *f);

/* Opens, reads and checks (rg_mesh_check) the whole mesh. Caller frees with rg_mesh_free. */
rg_mesh *rg_mesh_file_read(const char *path);

/* Writes a mesh that is sorted and connected, with `partitions` partitions of its tiles: to a new name, then
 * renamed, so that `path` is never half a file. */
void rg_mesh_file_write(const char *path, const rg_mesh *mesh, int partitions,
                        const rg_tile_partition *partition);

/* Adds partitions to the file at `path`, in place of those for as many ranks: to a copy, which then takes the
 * name. Reads and checks nothing else of the file. */
void rg_mesh_file_add_partitions(const char *path, int partitions, const rg_tile_partition *partition);

#endif
