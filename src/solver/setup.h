/* Setting a solver up and taking it down. */
#ifndef RG_SETUP_H
#define RG_SETUP_H

#include "solver/solver.h"

/* Builds everything for a case: mesh, partition, domain, fields at rest. Collective. */
rg_solver *rg_solver_make(const rg_case *input, MPI_Comm comm);

/* The same on a mesh that is there, without a patch. Takes over `part`; keeps a reference to `input`.
 * Collective. */
rg_solver *rg_solver_make_from_part(const rg_case *input, rg_part *part, MPI_Comm comm);

void rg_solver_free(rg_solver *s);

#endif
