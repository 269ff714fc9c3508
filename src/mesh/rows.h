/* Rows of numbers in a mesh file: their types, and the checksums that say whether they are what was written.
 */
#ifndef RG_MESH_ROWS_H
#define RG_MESH_ROWS_H

#include <hdf5.h>
#include <stdbool.h>
#include <stdint.h>

/* Bytes for the name of a set, the zero at its end included: the most, and those of a file of short names. */
enum { RG_SET_NAME = 256, RG_SHORT_NAME = 64 };

typedef enum {
    RG_ROWS_INT8,
    RG_ROWS_INT32,
    RG_ROWS_INT64,
    RG_ROWS_DOUBLE,
    RG_ROWS_NAME,
    RG_ROWS_LONG_NAME
} rg_row_type;

/* A dataset of a mesh file. */
typedef struct {
    const char *name; /* its checksums are in dataset checksum/name */
    rg_row_type type;
    int columns;
} rg_rows;

/* The same rows, of short names or of those of RG_SET_NAME bytes. */
rg_rows rg_rows_of_names(const rg_rows *r, bool are_long);

/* Whether the rows are names. */
bool rg_rows_are_names(const rg_rows *r);

/* Bytes of a row in memory. */
size_t rg_rows_bytes(const rg_rows *r);

/* HDF5's type of a value in memory. A name has a type of its own, which the caller closes; H5Tclose leaves
 * the others alone (they cannot be closed) and fails. */
hid_t rg_rows_type(const rg_rows *r);

/* Checksum of `count` rows: the values in order, each as a 64-bit word (integers and the bytes of names with
 * their sign extended, doubles bit by bit), chained by rg_hash (base/hash.h) from 0. So it depends neither on
 * the width in which integers are stored nor on the machine. One wrong bit changes it; wrong data that pass
 * it by accident have a chance of 2^-64. */
uint64_t rg_rows_checksum(const rg_rows *r, const void *data, int64_t count);

/* All datasets; their meaning is in mesh/file.h. */
extern const rg_rows rg_rows_surface_sets, rg_rows_volume_sets, rg_rows_surface_combinations,
    rg_rows_volume_combinations;
extern const rg_rows rg_rows_corner, rg_rows_neighbour, rg_rows_face, rg_rows_set, rg_rows_region,
    rg_rows_original, rg_rows_part;
extern const rg_rows rg_rows_vertex_start, rg_rows_vertex, rg_rows_x;
extern const rg_rows rg_rows_tile_start, rg_rows_tile_neighbour, rg_rows_tile_faces;

#endif
