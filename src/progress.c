#include "progress.h"

#include <inttypes.h>
#include <stdio.h>
#include <unistd.h>

void rg_progress_begin(rg_progress *p, bool speaks, double end, int64_t steps) {
    *p = (rg_progress){speaks, isatty(STDOUT_FILENO) == 1, end, MPI_Wtime(), steps};
}

/* The ledger, one line an interval. */
static void show_ledger(const rg_energy *e) {
    printf("energy (J): kinetic %.4e  bulk %.4e  penalty %.2e  cohesive %.2e  contact %.2e  dissipated %.4e  "
           "work %.4e\n",
           e->kinetic, e->bulk, e->penalty, e->cohesive, e->contact, e->dissipated, e->external);
}

void rg_progress_show(rg_progress *p, const rg_solver *s, const rg_energy *e) {
    if (!p->speaks) {
        return;
    }
    double share = (double)s->step / (double)p->steps;
    double by_time = s->time / p->end;
    share = by_time > share ? by_time : share;
    double used = MPI_Wtime() - p->started, left = share > 0 ? used * (1 / share - 1) : 0;
    printf("%s", p->terminal ? "\r\033[K" : "");
    show_ledger(e);
    printf("step %7" PRId64 "  time %.4e s  dt %.3e s  energy error %+.1e  broken %.4e m2  left %.0f s%s",
           s->step, s->time, s->dt, e->error, e->broken_area, left > 0 ? left : 0, p->terminal ? "" : "\n");
    fflush(stdout);
}

void rg_progress_end(rg_progress *p) {
    if (p->speaks && p->terminal) {
        putchar('\n');
    }
}
