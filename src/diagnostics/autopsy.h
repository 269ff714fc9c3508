/* What a run that went wrong died of: the element that was worst off, and what set the time step. */
#ifndef RG_AUTOPSY_H
#define RG_AUTOPSY_H

#include "solver/solver.h"

enum { RG_FAILURE_WORDS = 1000 };

/* Continues words[RG_FAILURE_WORDS], the reason, with step, time (s), the element and what limited the step,
 * and writes all that to autopsy.json in the output directory. The element is the first one whose state is
 * not finite; if all are, that which is stiffened most. `step` and `time` are those of the state that went
 * wrong; `good_time` (s) is the time of the last output that was in order. Collective. */
void rg_autopsy_add(char *words, const rg_solver *s, int64_t step, double time, double good_time);

#endif
