#include "output/progress.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <unistd.h>

void rg_progress_begin(rg_progress *p, bool speaks, const rg_solver *s) {
    bool terminal = isatty(STDOUT_FILENO) == 1 && isatty(STDERR_FILENO) == 1; /* mpirun fakes one of them */
    *p = (rg_progress){
        speaks, terminal, false, s->input->time.end, MPI_Wtime(), s->step, s->input->time.steps};
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

/* In five columns. */
static void show_left(double seconds) {
    if (seconds < 1000) {
        printf("%3.0f s", seconds);
    } else if (seconds < 60000) {
        printf("%2.0f min", seconds / 60);
    } else {
        printf("%3.0f h", seconds / 3600);
    }
}

/* At most 80 columns; all else of the ledger is in energy.csv. */
void rg_progress_show(rg_progress *p, const rg_solver *s, const rg_energy *e) {
    if (!p->speaks) {
        return;
    }
    if (!p->headed) {
        printf("    step    time (s)    dt (s)  energy error  of dissip.  failed (m2)   left\n");
        p->headed = true;
    }
    printf("%s%8" PRId64 "  %10.4e  %8.2e  %+12.1e  ", p->terminal ? "\r\033[K" : "", s->step, s->time, s->dt,
           e->error);
    if (isfinite(e->share)) {
        printf("%+10.1e", e->share);
    } else {
        printf("%10s", "-"); /* too little to judge by */
    }
    printf("  %11.3e  ", e->failed_area);
    show_left(rg_progress_left(p, s));
    printf("%s", p->terminal ? "" : "\n");
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
