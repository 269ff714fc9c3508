/* The stress of the start from the fields of an earlier run (initial.stress.run). */
#ifndef RG_STRESS_OF_RUN_H
#define RG_STRESS_OF_RUN_H

#include <stdint.h>

#include "solver/solver.h"

/* Fills `prestress` of the elements with set[slot] < 0: [slots], as rg_initial_of numbers them. An element
 * has the same stress at all its points: what the run wrote is the mean of each. Ends the run with a message
 * where it wrote none, where its mesh is another one, or where no element takes it. Each rank reads a
 * contiguous share of the elements, which then goes to the ranks that own them. Collective. */
void rg_stress_of_run(rg_solver *s, const int16_t *set);

#endif
