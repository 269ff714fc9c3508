#ifndef RG_MESH_CASE_H
#define RG_MESH_CASE_H

#include "case.h"
#include "mesh.h"

/* The mesh of a case: the built-in box or the one in mesh.file, sorted and connected. Ends the run with a
 * message if the boundary names a surface set that the file does not have, or a probe is not in its mesh. Not
 * collective; the caller frees it. */
rg_mesh *rg_mesh_of_case(const rg_case *c);

#endif
