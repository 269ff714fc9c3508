/* What a person sees while a run goes on: the ledger every interval, and the live line with step, time, dt,
 * energy error, broken area, time left. */
#ifndef RG_PROGRESS_H
#define RG_PROGRESS_H

#include "ledger.h"

typedef struct {
    bool speaks, terminal;
    double end, started;
    int64_t steps;
} rg_progress;

void rg_progress_begin(rg_progress *p, bool speaks, double end, int64_t steps);
void rg_progress_show(rg_progress *p, const rg_solver *s, const rg_energy *e);
void rg_progress_end(rg_progress *p);

#endif
