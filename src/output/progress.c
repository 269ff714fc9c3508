#include "output/progress.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <unistd.h>

void rg_progress_begin(rg_progress *p, bool speaks, const rg_solver *s) {
    bool terminal = isatty(STDOUT_FILENO) == 1 && isatty(STDERR_FILENO) == 1; /* mpirun fakes one of them */
    *p = (rg_progress){speaks, terminal, s->input->time.end, MPI_Wtime(), s->step, s->input->time.steps};
}

/* The ledger, one line an interval. */
static void show_ledger(const rg_energy *e) {
    printf("energy (J): kinetic %.4e  bulk %.4e  penalty %.2e  cohesive %.2e  contact %.2e  dissipated %.4e  "
           "work %.4e\n",
           e->kinetic, e->bulk, e->penalty, e->cohesive, e->contact, e->dissipated, e->external);
}

/* The step shrinks while bodies break: a share of time, or of the steps estimated at the start, would promise
 * too much. */
double rg_progress_left(const rg_progress *p, const rg_solver *s) {
    int64_t done = s->step - p->first;
    double steps = s->dt > 0 ? fmax((p->end - s->time) / s->dt, 0) : 0;
    if (p->last > 0) {
        steps = fmin(steps, (double)(p->last - s->step));
    }
    return done > 0 ? (MPI_Wtime() - p->started) / (double)done * steps : 0;
}

void rg_progress_show(rg_progress *p, const rg_solver *s, const rg_energy *e) {
    if (!p->speaks) {
        return;
    }
    double left = rg_progress_left(p, s);
    printf("%s", p->terminal ? "\r\033[K" : "");
    show_ledger(e);
    printf("step %7" PRId64 "  time %.4e s  dt %.3e s  energy error %+.1e  broken %.4e m2  left %.0f s%s",
           s->step, s->time, s->dt, e->error, e->broken_area, left, p->terminal ? "" : "\n");
    fflush(stdout);
}

void rg_progress_say(const rg_progress *p, const char *format, ...) {
    if (p->speaks) {
        va_list words;
        va_start(words, format);
        printf("%s", p->terminal ? "\r\033[K" : "");
        vprintf(format, words);
        putchar('\n');
        va_end(words);
    }
}

void rg_progress_end(rg_progress *p) {
    if (p->speaks && p->terminal) {
        putchar('\n');
    }
}
