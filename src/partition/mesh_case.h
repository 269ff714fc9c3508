#ifndef RG_MESH_CASE_H
#define RG_MESH_CASE_H

#include "case/case.h"
#include "mesh/mesh.h"

/* The crack that a mesh file brings (mesh/import/crack.h) as one more entry of interface.sets, open from the
 * start, unless one names it already. Ends the run with a message where the case has no faces that could be
 * open. Collective. */
void rg_case_take_crack(rg_case *c, MPI_Comm comm);

/* The mesh of a case: the built-in box or the one in mesh.file, sorted and connected. Ends the run with a
 * message if the boundary names a surface set that the file does not have. Not collective; the caller frees
 * it. */
rg_mesh *rg_mesh_of_case(const rg_case *c);

/* Each rank's part of it, likewise. Of a mesh file no rank reads more than that; the box is made on rank 0.
 * cost[tiles] on rank 0, from rg_alloc, taken over: what each tile costs, in place of mesh.weight; or NULL.
 * Collective; the caller frees the part. */
rg_part *rg_part_of_case(const rg_case *c, double *cost, MPI_Comm comm);

#endif
