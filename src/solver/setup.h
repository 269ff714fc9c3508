/* Setting a solver up and taking it down. */
#ifndef RG_SETUP_H
#define RG_SETUP_H

#include "solver/solver.h"

/* Builds everything for a case: mesh, partition, domain, fields at rest. In form continuous these take no
 * memory until rg_spectrum, which has need of another set before, is done. Collective. */
rg_solver *rg_solver_make(const rg_case *input, MPI_Comm comm);

/* The same on a mesh that is there, without a patch. Takes over `part`; keeps a reference to `input`.
 * Collective. */
rg_solver *rg_solver_make_from_part(const rg_case *input, rg_part *part, MPI_Comm comm);

/* A solver of another model on the domain of `s`, at rest, with fields of its own and without prescribed
 * motions or bodies: for rg_solver_impulse. Keeps references to both. Collective. */
rg_solver *rg_solver_beside(const rg_solver *s, const rg_model *model);

/* First touch of fields at rest: the pages go to the thread that will sweep the tile. */
void rg_solver_touch(rg_solver *s);

void rg_solver_free(rg_solver *s);

#endif
