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

/* The largest component of a stress of the start (Pa); 0: there is none. Collective. */
double rg_initial_stress_largest(const rg_solver *s);

/* Of the stress of the start, what it makes of elements by themselves: about the norm, in that of M^-1, of
 * its forces on a body of loose elements. Collective. */
double rg_initial_stress_scale(const rg_solver *s);

#endif
