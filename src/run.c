#include "run.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "affinity.h"
#include "error.h"
#include "estimate.h"
#include "files.h"
#include "ledger.h"
#include "mem.h"
#include "probe.h"
#include "progress.h"
#include "snapshot.h"
#include "spectrum.h"
#include "summary.h"

/* Stiffening up to this costs no time step: the spectrum's margin and any sensible safety cover it. */
#define STIFFENING_FREE 1.05

enum { EXCHANGES = 6 };

typedef struct {
    const rg_case *input;
    rg_solver *solver;
    rg_ledger ledger;
    rg_probes *probes;
    rg_snapshots *snapshots;
    rg_progress progress;
    rg_summary summary;
    rg_csv *energy;
    double dt_reference, next_output;
    int frame;        /* next of output.times */
    double good_time; /* of the last output that was in order (s) */
    char failure[400];
} run;

/* Time step for the current stiffening, in steps of 9 % so that it seldom changes (a leapfrog conserves
 * energy at a constant step). */
static double step_size(const run *r, double stiffening) {
    double dt = r->dt_reference;
    if (stiffening > STIFFENING_FREE) {
        dt /= sqrt(exp2(ceil(4 * log2(stiffening)) / 4));
    }
    if (r->frame < r->input->output.times) { /* equal steps that end at the next frame */
        double there = r->input->output.time[r->frame] - r->solver->time;
        dt = there > 0 ? there / ceil(there / dt * (1 - 1e-9)) : dt;
    }
    double left = r->input->time.end - r->solver->time;
    return left > 0 && left < dt * (1 + 1e-9) ? left : dt;
}

/* The element whose state is not finite, or the lowest-numbered of several. */
static void locate_failure(run *r, int64_t step, double time) {
    const rg_solver *s = r->solver;
    rg_gid id = INT64_MAX, first;
    double x[3] = {0, 0, 0};
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        if (!isfinite(s->stiffening[slot]) && s->domain->id[slot] >= 0 && s->domain->id[slot] < id) {
            id = s->domain->id[slot];
            for (int c = 0; c < 3; c++) {
                const double *p = s->domain->corner + 12 * slot + c;
                x[c] = 0.25 * (p[0] + p[3] + p[6] + p[9]);
            }
        }
    }
    MPI_Allreduce(&id, &first, 1, MPI_INT64_T, MPI_MIN, s->comm);
    for (int c = 0; c < 3; c++) {
        x[c] = id == first ? x[c] : 0;
    }
    MPI_Allreduce(MPI_IN_PLACE, x, 3, MPI_DOUBLE, MPI_SUM, s->comm);
    snprintf(r->failure, sizeof r->failure,
             "the state is not finite (or an element is inside out) at step %" PRId64
             ", time %.6g s, dt %.4g s: element %" PRId64
             " at (%.4g, %.4g, %.4g) m; last good output at %.6g s",
             step, time, s->dt, first, x[0], x[1], x[2], r->good_time);
}

static bool output_due(run *r) {
    if (r->input->output.interval_steps > 0) {
        return r->solver->step % r->input->output.interval_steps == 0;
    }
    double interval = r->input->output.interval_time;
    if (r->solver->time < r->next_output - 1e-6 * interval) {
        return false;
    }
    r->next_output = (floor(r->solver->time / interval + 1e-6) + 1) * interval;
    return true;
}

/* Whether fields of the present state are to be written. */
static bool frame_due(run *r) {
    const rg_case *c = r->input;
    if (r->frame == c->output.times || r->solver->time < c->output.time[r->frame] * (1 - 1e-12)) {
        return false;
    }
    r->frame++;
    return true;
}

static bool done(const run *r) {
    const rg_case *c = r->input;
    return r->solver->time >= c->time.end * (1 - 1e-12) ||
           (c->time.steps > 0 && r->solver->step >= c->time.steps);
}

/* Ledger, fields and progress of the current state. */
static void output(run *r, bool fields) {
    const rg_energy *e = rg_ledger_take(&r->ledger, r->solver);
    rg_csv_energy(r->energy, e);
    if (r->failure[0] == '\0' && !(r->ledger.worst <= r->input->output.energy_limit)) {
        snprintf(r->failure, sizeof r->failure,
                 "the energy error %.3g passed the limit %.3g (output.energy_limit) at step %" PRId64
                 ", time %.6g s; the time step is set by element %" PRId64
                 "; last good output at %.6g s; a smaller time.safety may help",
                 e->error, r->input->output.energy_limit, e->step, e->time, r->solver->limiting,
                 r->good_time);
    }
    if (r->failure[0] == '\0') {
        r->good_time = e->time;
    }
    rg_probes_flush(r->probes);
    if (fields) {
        rg_snapshots_write(r->snapshots, r->solver);
    }
    rg_progress_show(&r->progress, r->solver, e);
}

/* Forces of the current state and, where it is to be output, that; then the step to the next one. The time
 * step follows the stiffening of the state before, which all ranks know by now: one step is no time for it to
 * change by more than any sensible safety. Returns whether to go on. */
static bool advance(run *r, double *other) {
    rg_solver *s = r->solver;
    bool last = done(r), due = output_due(r) || last;
    bool frame = frame_due(r) || (due && r->input->output.times == 0), fresh = due || frame;
    double dt = step_size(r, s->stiffening_anywhere), time = s->time;
    int64_t step = s->step;
    if (fresh) {
        rg_solver_kick(s, dt);
    } else {
        rg_solver_step(s, dt);
    }
    rg_probes_next(r->probes, time);
    if (!isfinite(s->stiffening_anywhere)) {
        locate_failure(r, step, time);
    }
    if (fresh) {
        double begin = MPI_Wtime();
        output(r, frame);
        *other += MPI_Wtime() - begin;
    }
    if (r->failure[0] != '\0' || last) {
        return false;
    }
    if (fresh) {
        rg_solver_drift(s);
    }
    if (s->step == 1) {
        r->summary.dt_first = s->dt;
    }
    return true;
}

/* The least of a few, which nobody disturbed; the first opens connections. */
static void measure_exchange(rg_solver *s) {
    double least = INFINITY;
    for (int k = 0; k < EXCHANGES; k++) {
        MPI_Barrier(s->comm);
        double t = MPI_Wtime();
        rg_solver_exchange(s);
        least = fmin(least, MPI_Wtime() - t);
    }
    MPI_Allreduce(&least, &s->exchange_seconds, 1, MPI_DOUBLE, MPI_MAX, s->comm);
}

static void time_loop(run *r) {
    double started = MPI_Wtime(), other = 0;
    while (advance(r, &other)) {
    }
    r->summary.loop_seconds = MPI_Wtime() - started - other;
    r->summary.output_seconds = other;
}

static void open_outputs(run *r) {
    const rg_case *c = r->input;
    rg_make_directory(c->output.dir, r->solver->comm);
    rg_remove_results(c->output.dir, r->solver->rank);
    rg_echo_case(c, r->solver->rank);
    r->energy = rg_csv_open(c->output.dir, "energy.csv", r->solver->rank);
    rg_csv_energy_header(r->energy);
    rg_probes_open(r->probes, r->solver);
    r->snapshots = rg_snapshots_open(r->solver);
}

static void close_outputs(run *r) {
    rg_probes_close(r->probes);
    rg_snapshots_close(r->snapshots);
    rg_csv_close(r->energy);
}

int rg_run(const rg_case *c, MPI_Comm comm, bool quiet) {
    run *r = RG_NEW(run, 1);
    r->input = c;
    double begin = MPI_Wtime();
    r->solver = rg_solver_make(c, comm);
    r->probes = rg_probes_find(r->solver);
    rg_spectrum(r->solver);
    rg_estimate estimate = rg_estimate_run(r->solver);
    r->dt_reference = estimate.dt;
    r->next_output = c->output.interval_time;
    bool speaks = r->solver->rank == 0 && !quiet;
    if (speaks) {
        rg_estimate_print(r->solver, &estimate, stdout);
    }
    if (!quiet) {
        rg_affinity_print(comm, stdout);
    }
    measure_exchange(r->solver);
    open_outputs(r);
    rg_solver_start(r->solver);
    r->solver->phases = (rg_phases){.last = 0};
    rg_progress_begin(&r->progress, speaks, c->time.end, estimate.steps);
    r->summary.setup_seconds = MPI_Wtime() - begin;
    time_loop(r);
    rg_progress_end(&r->progress);
    r->summary.failure = r->failure;
    rg_summary_write(&r->summary, r->solver, &r->ledger, &estimate);
    close_outputs(r);
    if (r->failure[0] != '\0' && r->solver->rank == 0) {
        fprintf(stderr, "rhegma: stopped: %s\n", r->failure);
    }
    if (speaks) {
        rg_summary_print(&r->summary, r->solver, &r->ledger, stdout);
    }
    int status = r->failure[0] == '\0' ? RG_OK : RG_FAILURE;
    rg_solver_free(r->solver);
    rg_free(r);
    return status;
}

int rg_check(const rg_case *c, MPI_Comm comm) {
    rg_solver *s = rg_solver_make(c, comm);
    rg_probes_close(rg_probes_find(s));
    rg_spectrum(s);
    rg_estimate estimate = rg_estimate_run(s);
    if (s->rank == 0) {
        rg_estimate_print(s, &estimate, stdout);
    }
    rg_affinity_print(comm, stdout);
    rg_solver_free(s);
    return RG_OK;
}
