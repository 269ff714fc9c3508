#include "restart/schedule.h"

#include <math.h>

#include "base/error.h"
#include "base/interrupt.h"

/* Of a checkpoint that was never written: bytes of an element, and how fast a disk is at least. */
#define BYTES_PER_ELEMENT 500.0
#define BYTES_PER_SECOND  50e6

/* Before the limit of wall time: three times the slowest checkpoint, 2 s, and 1 % of the limit. */
static double last_moment(const rg_schedule *t, double seconds) {
    return t->limit - 3 * seconds - 2 - 0.01 * (isfinite(t->limit) ? t->limit : 0);
}

static void set_clock(const rg_schedule *t, const rg_solver *s, double seconds) {
    double every = s->input->checkpoint.wall_time;
    if (s->rank == 0) {
        rg_interrupt_clock(last_moment(t, seconds), every > 0 ? rg_interrupt_now() + every : INFINITY);
    }
}

double rg_schedule_seconds(const rg_solver *s, double seconds) {
    return seconds > 0 ? seconds : (double)s->part->total * BYTES_PER_ELEMENT / BYTES_PER_SECOND;
}

static double after(double interval, double time) {
    return interval > 0 ? (floor(time / interval + 1e-6) + 1) * interval : INFINITY;
}

void rg_schedule_start(rg_schedule *t, const rg_solver *s, double walltime) {
    *t = (rg_schedule){.next_time = after(s->input->checkpoint.time, s->time),
                       .last = s->step > 0 ? s->step : -1};
    t->limit = s->rank == 0 ? rg_interrupt_limit(walltime) : INFINITY;
    set_clock(t, s, rg_schedule_seconds(s, 0));
}

void rg_schedule_warn(const rg_schedule *t, const rg_solver *s) {
    double seconds = rg_schedule_seconds(s, 0), now = rg_interrupt_now();
    if (s->rank == 0 && last_moment(t, seconds) <= now) {
        rg_warn(
            "the wall-time limit of %.0f s leaves no time for steps: set-up took %.0f s, and a checkpoint of "
            "about %.0f s needs three times that and 2 s",
            t->limit, now, seconds);
    }
}

bool rg_schedule_due(const rg_schedule *t, const rg_solver *s, bool end) {
    int64_t steps = s->input->checkpoint.steps;
    bool regular = steps > 0 || s->input->checkpoint.time > 0 || s->input->checkpoint.wall_time > 0;
    if (s->stop_request >= RG_REQUEST_STOP) {
        return !end; /* all but over: to the end */
    }
    if (s->step == t->last) {
        return false;
    }
    return s->stop_request == RG_REQUEST_CHECKPOINT || (steps > 0 && s->step > 0 && s->step % steps == 0) ||
           s->time >= t->next_time - 1e-6 * s->input->checkpoint.time || (end && regular);
}

void rg_schedule_done(rg_schedule *t, const rg_solver *s, double seconds) {
    t->next_time = after(s->input->checkpoint.time, s->time);
    t->last = s->step;
    rg_interrupt_answered();
    set_clock(t, s, seconds);
}
