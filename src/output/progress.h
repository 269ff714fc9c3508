/* What a person sees while a run goes on, a line for each output: step, time, dt, energy error, area that has
 * failed (carries nothing any more) and that is broken (its cohesive law acts), wall time left. On a terminal
 * one line that is written anew. */
#ifndef RG_PROGRESS_H
#define RG_PROGRESS_H

#include "diagnostics/ledger.h"

typedef struct {
    bool speaks, terminal, headed;
    double end, started; /* simulated time at which the run ends; wall clock at its start (s) */
    int64_t first, last; /* step at its start, and the last one that the case allows; 0: no limit */
} rg_progress;

void rg_progress_begin(rg_progress *p, bool speaks, const rg_solver *s);
/* Wall time to the end of the run (s): at the present time step and the mean cost of a step so far. */
double rg_progress_left(const rg_progress *p, const rg_solver *s);

void rg_progress_show(rg_progress *p, const rg_solver *s, const rg_energy *e);
/* A line for the person, printf style. */
void rg_progress_say(const rg_progress *p, const char *format, ...) __attribute__((format(printf, 2, 3)));

void rg_progress_end(rg_progress *p);

#endif
