/* The fields of solver/field_list.h: their memory, what of a solver a checkpoint must hold, their end. */
#ifndef RG_FIELDS_H
#define RG_FIELDS_H

#include "solver/solver.h"
#include "solver/state.h"

/* Memory for all of them, zero; the pages are touched later. Of a solver whose domain and law are known. */
void rg_fields_allocate(rg_solver *s);

/* First touch: the pages of tile t go to the thread that calls this, which is to be the one that will sweep
 * the tile. */
void rg_fields_touch(rg_solver *s, const rg_tile *t);

void rg_fields_free(rg_solver *s);

/* Registers those that are saved, and all else that the solver holds and a restart needs. */
void rg_state_of_solver(rg_state *st, rg_solver *s);

#endif
