/* Whether the parts that the ranks read make up a mesh that is closed where it looks closed. */
#ifndef RG_PART_CHECK_H
#define RG_PART_CHECK_H

#include "mesh/file.h"
#include "mesh/mesh.h"

/* Ends the run (RG_USAGE) with messages (base/input_errors.h) that begin with `name` and name the elements by
 * their numbers in the input, which `file` has, if on the surface of the mesh, or of a part of it that is
 * kept apart,
 *   - two faces are at the same place, without their elements being neighbours,
 *   - a face is at the place of one between two elements: three share it,
 * or, where that is well,
 *   - two vertices are at the same place (within 1e-9 of the mesh's size), or one is on a face without being
 *     its corner (within 1e-6 of the longest edge): the mesh is open there.
 * Rank 0 gathers the elements at the surface, and no others. Collective. */
void rg_part_check(const rg_part *part, const char *name, const rg_mesh_file *file, MPI_Comm comm);

#endif
