/* The part of the state that only some elements have, as tables of a checkpoint: the arrays of the broken
 * faces, each list and each pool. */
#ifndef RG_STATE_TABLE_H
#define RG_STATE_TABLE_H

#include "base/h5_parallel.h"
#include "domain/slab.h"
#include "solver/solver.h"
#include "solver/state.h"

typedef struct {
    const char *name; /* of its group */
    int arrays;
    const rg_state_array *array[RG_MAX_STATE];
} rg_state_table;

/* The tables of the state; returns how many (at most RG_MAX_STATE). */
int rg_state_tables(const rg_state *st, rg_state_table table[RG_MAX_STATE]);

/* Collective: writes a table into a group of its own. */
void rg_state_table_write(rg_h5_file *f, const rg_state_table *t, const rg_solver *s, const rg_slab *slab);

/* Collective: fills the table from its group. Faces that are not in it keep what they have. False, on any
 * rank: it does not hold what it should. */
bool rg_state_table_read(rg_h5_file *f, const rg_state_table *t, const rg_solver *s, const rg_slab *slab);

/* HDF5's type of an array's values in memory. */
hid_t rg_state_h5_type(const rg_state_array *a);

#endif
