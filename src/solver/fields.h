/* What a solver holds that a checkpoint must. */
#ifndef RG_FIELDS_H
#define RG_FIELDS_H

#include "solver/solver.h"
#include "solver/state.h"

/* Registers all of it. */
void rg_state_of_solver(rg_state *st, rg_solver *s);

#endif
