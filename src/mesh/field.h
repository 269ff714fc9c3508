/* Fields of a mesh file: datasets beside those of file.h, which whoever has them puts there, a row for each
 * element in the order of the file (`original` has its number in the input). They have no checksums. */
#ifndef RG_MESH_FIELD_H
#define RG_MESH_FIELD_H

#include "mesh/mesh.h"

/* Elements first .. first + count - 1. */
typedef struct {
    rg_gid first, count;
} rg_mesh_run;

/* Reads the rows of so many runs, one after another, of dataset `name` [elements][3], numbers of any type.
 * False: there is none of that shape, or it cannot be read, and why[200] tells. */
bool rg_mesh_field_read(const char *path, const char *name, rg_gid elements, size_t runs,
                        const rg_mesh_run *run, double (*out)[3], char why[200]);

#endif
