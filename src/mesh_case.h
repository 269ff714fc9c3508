#ifndef RG_MESH_CASE_H
#define RG_MESH_CASE_H

#include "case.h"
#include "mesh.h"

/* The mesh of a case: the built-in box or the one in mesh.file, sorted and connected. Ends the run with a
 * message if the boundary names a surface set that the file does not have. Not collective; the caller frees
 * it. */
rg_mesh *rg_mesh_of_case(const rg_case *c);

/* Each rank's part of it, likewise. Of a mesh file no rank reads more than that; the box is made on rank 0.
 * Collective; the caller frees it. */
rg_part *rg_part_of_case(const rg_case *c, MPI_Comm comm);

#endif
