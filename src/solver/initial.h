/* The state at the start: displacements and velocities from `initial` and its sets. */
#ifndef RG_INITIAL_H
#define RG_INITIAL_H

#include "solver/solver.h"

/* What holds for an element: the values of the last of `initial.sets` that has it, or of `initial`; *number:
 * of the set, or -1. `volume`: the mesh's volume sets. Not for threads. */
const rg_initial *rg_initial_of(const rg_case *c, const rg_domain *d, const rg_sets *volume, size_t slot,
                                int *number);

/* Fills displacement and velocity; where elements share nodes, with the mean of what they have, by mass. Ends
 * the run with a message where a set is empty or a value is not finite. Collective. */
void rg_initial_fill(rg_solver *s);

#endif
