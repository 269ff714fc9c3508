/* When checkpoints are due. */
#ifndef RG_SCHEDULE_H
#define RG_SCHEDULE_H

#include "solver/solver.h"

typedef struct {
    double next_time; /* simulated time of the next one that is due by time (s) */
    double limit;     /* wall time, since the program started (s); infinite: none */
    int64_t last;     /* step of the last checkpoint; -1: none yet */
} rg_schedule;

/* From the solver's state on; rank 0 sets the clock (base/interrupt.h). `walltime` 0: none but Slurm's. */
void rg_schedule_start(rg_schedule *t, const rg_solver *s, double walltime);

/* Warns, before the first step, of a limit that leaves time for one at most: a job that queues itself again
 * while the exit status says so would do that for ever. */
void rg_schedule_warn(const rg_schedule *t, const rg_solver *s);

/* Whether the present state is to be saved: the same on all ranks. `end`: it is the last one. */
bool rg_schedule_due(const rg_schedule *t, const rg_solver *s, bool end);

/* What a checkpoint takes (s): the slowest so far, `seconds`; or a guess where there was none yet. */
double rg_schedule_seconds(const rg_solver *s, double seconds);

/* It was, in at most `seconds`. */
void rg_schedule_done(rg_schedule *t, const rg_solver *s, double seconds);

#endif
