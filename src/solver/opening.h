/* Faces that hold until a time of the case and then open (interface.sets: `open`, `at`).
 *
 * What the penalty of such a face and the lift of its jump have stored goes with them, from one step to the
 * next. So much the total energy is less afterwards: the potential energy of the whole body before less that
 * after, and dt/2 v . (f before - f after), since the kick at a step has the force of the state after from
 * half a step before on. The ledger counts it as `unresolved`. A material's history is that of the state
 * before: with plastic flow in the very step this is not exact. */
#ifndef RG_OPENING_H
#define RG_OPENING_H

#include <stddef.h>

#include "solver/solver.h"

/* Opens those whose time has come, between two steps. Collective. */
void rg_openings_take(rg_solver *s);

/* The faces of a set of interface.sets that are open, or open at a time, in words: "of 2.5e-09 m2, 2 faces,
 * at 1e-06 s". */
void rg_opening_describe(const rg_solver *s, int set, char *words, size_t size);

#endif
