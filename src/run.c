#include "case/echo.h"
#include "run.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/affinity.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/mem.h"
#include "diagnostics/autopsy.h"
#include "output/fragment_table.h"
#include "output/progress.h"
#include "partition/mesh_case.h"
#include "restart/restart.h"
#include "restart/schedule.h"
#include "solver/balance.h"
#include "solver/opening.h"
#include "solver/step_limiter.h"
#include "solver/relax.h"
#include "solver/setup.h"
#include "solver/step.h"
#include "solver/spectrum.h"

enum { EXCHANGES = 6 };

/* From this stiffening on an element may turn inside out in a step. */
#define CAREFUL 2

/* The ledger is taken at least every so many steps, and before that each time the steps since the start are
 * four times as many: it takes as long as some four steps. It is judged from the first of them on: a body
 * that is set in motion at once has little energy in its first steps, and of that the error of the time
 * integration, of order (omega dt)^2, is a good part. */
#define FIRST_LOOK 16
#define LOOK       2048

typedef struct {
    const rg_case *input;
    const rg_run_options *options;
    rg_solver *solver;
    rg_ledger ledger;
    rg_probes *probes;
    rg_slab *slab; /* of the snapshots and the checkpoints; NULL before the first of them */
    rg_snapshots *snapshots;
    rg_fragment_table *fragments;
    rg_progress progress;
    rg_summary summary;
    rg_csv *energy;
    rg_state state;
    rg_restart keep;
    rg_checkpoints checkpoints;
    rg_schedule schedule;
    rg_balance balance;
    double dt_reference;
    double next_output; /* when one is due (s) */
    bool restart;       /* goes on from a checkpoint */
    bool cut;           /* the last step was another than it would have been without time.end */
    bool stopped;       /* asked to, with a checkpoint */
    bool uneven;        /* stopped with a checkpoint to repartition the mesh */
    double setup;       /* wall time of the last set-up (s) */
    char failure[RG_FAILURE_WORDS];
} run;

/* Time step for the current stiffening and opening rate, in steps of 9 % so that it seldom changes (a
 * leapfrog conserves energy at a constant step). */
static double stable_step(const run *r, double stiffening) {
    double dt = r->dt_reference;
    dt = stiffening > RG_STIFFENING_FREE ? dt / sqrt(exp2(ceil(4 * log2(stiffening)) / 4)) : dt;
    return rg_limited_step(r->solver, dt);
}

/* The step that would be next if the run had no end. */
static double free_step(const run *r, double stiffening) {
    double dt = stable_step(r, stiffening);
    if (r->keep.frame < r->input->output.times) { /* equal steps that end at the next frame */
        double there = r->input->output.time[r->keep.frame] - r->solver->time;
        dt = there > 0 ? there / ceil(there / dt * (1 - 1e-9)) : dt;
    }
    return dt;
}

static double step_size(const run *r, double stiffening) {
    double dt = free_step(r, stiffening), left = r->input->time.end - r->solver->time;
    return left > 0 && left < dt * (1 + 1e-9) ? left : dt;
}

/* The first multiple of output.interval after `time`. */
static double output_after(const run *r, double time) {
    double interval = r->input->output.interval_time;
    return (floor(time / interval + 1e-6) + 1) * interval;
}

static bool output_due(run *r) {
    if (r->input->output.interval_steps > 0) {
        return r->solver->step % r->input->output.interval_steps == 0;
    }
    double interval = r->input->output.interval_time;
    if (r->solver->time < r->next_output - 1e-6 * interval) {
        return false;
    }
    r->next_output = output_after(r, r->solver->time);
    return true;
}

/* Whether the energy of the present state is to be looked at though no output has done so for long: soon at
 * first, because what grows without bound does so soon. */
static bool look_due(const run *r) {
    int64_t last = r->ledger.last.step, since = r->solver->step - last, wait = 3 * last;
    return since >= (wait < FIRST_LOOK ? FIRST_LOOK : wait > LOOK ? LOOK : wait);
}

/* Whether fields of the present state are to be written. */
static bool frame_due(run *r) {
    const rg_case *c = r->input;
    if (r->keep.frame == c->output.times || r->solver->time < c->output.time[r->keep.frame] * (1 - 1e-12)) {
        return false;
    }
    r->keep.frame++;
    return true;
}

static bool done(const run *r) {
    const rg_case *c = r->input;
    return r->solver->time >= c->time.end * (1 - 1e-12) ||
           (c->time.steps > 0 && r->solver->step >= c->time.steps);
}

/* The fields, where asked for, the table of fragments, and whether they overlap. */
static void write_fields(run *r, bool fields) {
    rg_solver *s = r->solver;
    bool table = rg_fragment_table_due(r->fragments, s, done(r) || r->failure[0] != '\0');
    bool show = fields && rg_snapshots_show_fragments(r->snapshots);
    bool look = rg_fragment_table_looks(r->fragments);
    rg_fragment_parts *parts = table || show || look ? rg_fragments_find(s) : NULL;
    if (fields) {
        rg_snapshots_write(r->snapshots, s, parts);
    }
    if (table) {
        rg_fragment_table_take(r->fragments, s, parts);
    }
    if (look) {
        rg_fragment_table_look(r->fragments, s, parts);
    }
    rg_fragment_parts_free(parts);
}

/* The ledger of the current state; notes where it is off by more than the case allows. */
static void take_stock(run *r) {
    const rg_energy *e = rg_ledger_take(&r->ledger, r->solver);
    const rg_case *c = r->input;
    if (r->failure[0] == '\0' && e->step >= FIRST_LOOK &&
        rg_ledger_off(&r->ledger, c, r->failure, sizeof r->failure)) {
        rg_autopsy_add(r->failure, r->solver, e->step, e->time, r->keep.good_time);
    }
    if (r->failure[0] == '\0') {
        r->keep.good_time = e->time;
    }
}

/* Row of the ledger, fields and progress of the current state. */
static void output(run *r, bool fields) {
    rg_energy_row(r->energy, &r->ledger, r->solver);
    rg_probes_flush(r->probes);
    write_fields(r, fields);
    rg_progress_show(&r->progress, r->solver, &r->ledger.last);
}

/* A state that no step can leave: not finite, or such that the step collapses. */
static void examine(run *r, int64_t step, double time) {
    const rg_solver *s = r->solver;
    char why[400];
    double next = stable_step(r, s->stiffening_anywhere);
    bool lapse = rg_bodies_told(s->bodies, why, sizeof why); /* of which the solid may know nothing */
    if (lapse || !isfinite(s->stiffening_anywhere)) {
        bool told = lapse || rg_constraints_told(s->constraints, why, sizeof why, s->comm) ||
                    rg_loads_told(s->loads, why, sizeof why);
        snprintf(r->failure, sizeof r->failure, "the state is not finite%s%s%s",
                 told ? " (" : " (or an element is inside out)", told ? why : "", told ? ")" : "");
    } else if (next < r->input->time.collapse * r->dt_reference) {
        snprintf(r->failure, sizeof r->failure,
                 "the time step collapsed: %.3g s, below %.3g (time.collapse) of the %.3g s at rest", next,
                 r->input->time.collapse, r->dt_reference);
    } else {
        return;
    }
    rg_autopsy_add(r->failure, s, step, time, r->keep.good_time);
}

/* Whether the work of the ranks is so uneven that another partition pays. */
static bool uneven(run *r) {
    rg_solver *s = r->solver;
    double checkpoint = rg_schedule_seconds(s, r->checkpoints.slowest);
    return !done(r) &&
           rg_balance_pays(&r->balance, s, checkpoint + r->setup, rg_progress_left(&r->progress, s));
}

/* Whether the next step is the last one, and cut to end in time. */
static bool cut_next(const run *r) {
    double stiffening = r->solver->stiffening_anywhere;
    return !done(r) && fabs(step_size(r, stiffening) - free_step(r, stiffening)) > 0;
}

/* Writes a checkpoint if it is time for one, or for another partition; returns whether to stop after it. A
 * longer run would not come through a state to which a cut step has led: the checkpoint of the end is that of
 * the state before, from which it goes on to the same bits. */
static bool save(run *r) {
    const rg_solver *s = r->solver;
    if (r->cut) {
        return false;
    }
    bool end = done(r) || (s->stop_request < RG_REQUEST_STOP && cut_next(r));
    bool due = rg_schedule_due(&r->schedule, s, end);
    r->uneven = s->stop_request < RG_REQUEST_STOP && uneven(r);
    if (!due && !r->uneven) {
        return false;
    }
    rg_restart_sync(&r->keep, s, r->energy, r->probes, r->fragments, r->snapshots);
    rg_checkpoint_write(&r->checkpoints, (int)r->input->checkpoint.keep);
    rg_schedule_done(&r->schedule, s, r->checkpoints.slowest);
    r->stopped = s->stop_request >= RG_REQUEST_STOP;
    return r->stopped || r->uneven;
}

/* Forces of the current state and, where it is to be output, that; then the step to the next one. The time
 * step follows the stiffening of the state before, which all ranks know by now: one step is no time for it to
 * change by more than any sensible safety. A state that may be the last good one is not left before it is
 * known that the next can be reached. Returns whether to go on. */
static bool advance(run *r, double *other) {
    rg_solver *s = r->solver;
    rg_openings_take(s);
    bool last = done(r), due = output_due(r) || last;
    bool frame = frame_due(r) || (due && r->input->output.times == 0), out = due || frame,
         fresh = out || look_due(r);
    double dt = step_size(r, s->stiffening_anywhere), time = s->time;
    bool cut = cut_next(r);
    int64_t step = s->step;
    bool careful = !(s->stiffening_anywhere < CAREFUL);
    if (fresh || careful) {
        rg_solver_kick(s, dt);
    } else {
        rg_solver_step(s, dt);
    }
    rg_probes_next(r->probes, time);
    examine(r, step, time);
    bool failed = r->failure[0] != '\0';
    if (failed && !fresh && !careful) {
        rg_solver_kick(s, dt); /* the fields are those of the state that followed */
    }
    if (fresh || failed) {
        double begin = MPI_Wtime();
        take_stock(r);
        failed = r->failure[0] != '\0';
        if (out || failed) {
            output(r, frame || failed);
        }
        *other += MPI_Wtime() - begin;
    }
    if (r->failure[0] != '\0' || last) {
        return false;
    }
    if (fresh || careful) {
        rg_solver_drift(s);
    }
    r->cut = cut;
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
    bool on = true;
    while (on) {
        double begin = MPI_Wtime();
        bool stop = save(r);
        other += MPI_Wtime() - begin;
        on = !stop && advance(r, &other);
    }
    r->summary.loop_seconds += MPI_Wtime() - started - other;
    r->summary.output_seconds += other;
    r->summary.checkpoints += r->checkpoints.written;
    r->summary.checkpoint_seconds += r->checkpoints.total;
    if (r->checkpoints.written > 0) {
        r->summary.checkpoint_median = rg_checkpoints_median(&r->checkpoints);
    }
}

/* ---- outputs ---- */

/* Results of two runs never mix; but those of days are not lost because of a word forgotten, and those of a
 * run that had ended not in silence. */
static void refuse_overwriting(const run *r) {
    const char *dir = r->input->output.dir;
    if (r->solver->rank == 0 && !r->options->overwrite) {
        if (rg_completed(dir)) {
            rg_warn(
                "%s: this run takes the place of one that had ended; pictures there are still of that one",
                dir);
        } else if (rg_checkpoints_exist(dir)) {
            rg_fatal(
                RG_USAGE,
                "%s holds checkpoints of a run that did not end: --restart %s goes on from them, --overwrite "
                "starts anew without them",
                dir, dir);
        }
    }
    MPI_Barrier(r->solver->comm);
}

static void open_outputs(run *r) {
    const rg_case *c = r->input;
    if (r->solver->rank == 0) {
        rg_refuse_busy(c->output.dir, "energy.csv");
        rg_refuse_own_case(c->output.dir);
    }
    refuse_overwriting(r);
    rg_make_directory(c->output.dir, r->solver->comm);
    if (r->solver->rank == 0) {
        rg_checkpoints_remove(c->output.dir,
                              true); /* first: none may outlive the files that it goes on with */
    }
    rg_remove_results(c->output.dir, r->solver->rank);
    r->energy = rg_csv_open(c->output.dir, "energy.csv", r->solver->rank);
    rg_csv_hold(r->energy);
    rg_energy_header(r->energy, r->solver);
    rg_case_write(c, r->solver->rank);
    rg_probes_open(r->probes, r->solver);
    r->snapshots = rg_snapshots_open(r->solver, &r->slab);
    r->fragments = rg_fragment_table_open(r->solver);
}

/* Takes up the files of the run that wrote the checkpoint, where they stood then. */
static void reopen_outputs(run *r) {
    const rg_case *c = r->input;
    int rank = r->solver->rank;
    r->energy = rg_csv_reopen(c->output.dir, "energy.csv", rank, r->keep.energy_bytes);
    rg_csv_hold(r->energy);
    rg_probes_reopen(r->probes, r->solver, r->keep.history_bytes);
    r->fragments = rg_fragment_table_reopen(r->solver, &r->keep.fragments);
    if (r->keep.fields.frames > 0) {
        r->snapshots = rg_snapshots_reopen(r->solver, &r->slab, &r->keep.fields);
    } else {
        rg_remove_frames(c->output.dir, rank);
        r->snapshots = rg_snapshots_open(r->solver, &r->slab);
    }
    if (rank == 0) {
        rg_checkpoints_remove(c->output.dir, false);
        rg_remove_endings(c->output.dir);
    }
    rg_case_write(c, rank);
}

static void close_outputs(run *r) {
    rg_probes_close(r->probes);
    rg_snapshots_close(r->snapshots);
    rg_fragment_table_close(r->fragments);
    rg_csv_close(r->energy);
    rg_checkpoints_close(&r->checkpoints);
    rg_slab_free(r->slab);
}

/* ---- beginning and end ---- */

/* The state, at rest or from a checkpoint, up to where the estimate can be made. `cost` as in
 * rg_part_of_case. */
static void make_state(run *r, double *cost, MPI_Comm comm) {
    const rg_case *c = r->input;
    r->solver = r->restart ? rg_solver_make_from_part(c, rg_part_of_case(c, cost, comm), comm)
                           : rg_solver_make(c, comm);
    if (c->mesh.rebalance > 0 && r->solver->ranks > 1) {
        r->solver->tile_seconds = RG_NEW(double, r->solver->domain->tiles);
    }
    r->probes = rg_probes_find(r->solver);
    rg_restart_register(&r->state, &r->keep, r->solver, &r->ledger, &r->summary);
    rg_probes_register(r->probes, &r->state);
    rg_checkpoints_open(&r->checkpoints, c->output.dir, r->solver, &r->state, &r->slab);
    if (!r->restart) {
        rg_spectrum(r->solver);
        return;
    }
    if (r->solver->rank == 0) {
        rg_refuse_busy(c->output.dir, "energy.csv");
    }
    MPI_Barrier(comm);
    rg_checkpoint_load(&r->checkpoints);
    rg_restart_spectrum(&r->keep, r->solver);
}

/* All that a time loop needs: at rest or from a checkpoint, on a partition by `cost` (rg_part_of_case). */
static void prepare(run *r, double *cost, MPI_Comm comm) {
    rg_start start = r->input->start;
    FILE *out = r->options->quiet ? NULL : stdout;
    make_state(r, cost, comm);
    measure_exchange(r->solver);
    if (!r->restart) {
        rg_solver_start(r->solver);
        r->summary.equilibrium = start == RG_START_STATIC  ? rg_equilibrium_find(r->solver, out)
                                 : start == RG_START_RELAX ? rg_relax(r->solver, out)
                                                           : (rg_equilibrium){0};
        if (start == RG_START_INITIAL && r->solver->prestress != NULL) {
            r->summary.stress_out_of_balance = rg_equilibrium_of_stress(r->solver, out);
        }
    }
    rg_free(r->summary.estimate.of_material);
    r->summary.estimate = rg_estimate_run(r->solver);
    r->dt_reference = r->summary.estimate.dt;
    double before = r->solver->time - r->solver->dt; /* that state had all its outputs */
    r->next_output = r->solver->step > 0 ? output_after(r, before) : 0;
    r->summary.partitions++;
}

static void open_or_reopen(run *r) {
    if (r->restart) {
        reopen_outputs(r);
        rg_solver_resume(r->solver);
    } else {
        open_outputs(r);
    }
    rg_schedule_start(&r->schedule, r->solver, r->options->walltime);
}

static void begin(run *r, MPI_Comm comm) {
    double started = MPI_Wtime();
    prepare(r, NULL, comm);
    bool speaks = r->solver->rank == 0 && !r->options->quiet;
    if (r->solver->rank == 0) {
        rg_estimate_warn(r->input, &r->summary.estimate);
    }
    if (speaks) {
        rg_estimate_print(r->solver, &r->summary.estimate, stdout);
        rg_probes_print(r->probes, stdout);
    }
    if (!r->options->quiet) {
        rg_affinity_print(comm, stdout);
    }
    open_or_reopen(r);
    rg_schedule_warn(&r->schedule, r->solver);
    r->solver->phases = (rg_phases){.last = 0};
    if (r->restart && done(r) && r->solver->rank == 0) {
        rg_warn("nothing is left to compute: the checkpoint is of step %" PRId64 ", time %.6g s; time.end or "
                "time.steps must be beyond",
                r->solver->step, r->solver->time);
    } else if (speaks && r->restart) {
        printf("goes on from step %" PRId64 ", time %.6g s\n", r->solver->step, r->solver->time);
    }
    r->summary.first_step = r->solver->step;
    rg_progress_begin(&r->progress, speaks, r->solver);
    rg_balance_start(&r->balance, r->solver, false);
    r->summary.setup_seconds = r->setup = MPI_Wtime() - started;
}

/* The run goes on from the checkpoint just written, in the same files, on a partition by what the tiles cost.
 */
static void repartition(run *r, MPI_Comm comm) {
    double started = MPI_Wtime(), *cost = rg_balance_costs(r->solver), before = r->balance.now;
    rg_phases phases = r->solver->phases;
    close_outputs(r);
    rg_solver_free(r->solver);
    *r = (run){.input = r->input,
               .options = r->options,
               .restart = true,
               .summary = r->summary,
               .progress = r->progress};
    prepare(r, cost, comm);
    open_or_reopen(r);
    r->solver->phases = phases;
    rg_balance_start(&r->balance, r->solver, true);
    r->setup = MPI_Wtime() - started;
    r->summary.setup_seconds += r->setup;
    rg_progress_say(&r->progress,
                    "step %" PRId64 ": the ranks' work was uneven (most %.2f of the mean), the mesh is "
                    "repartitioned (by cost, most %.2f of the mean) in %.2f s",
                    r->solver->step, before, r->solver->part->quality.cost_imbalance, r->setup);
}

/* Says how it ended; returns the exit status. */
static int conclude(run *r) {
    const rg_solver *s = r->solver;
    bool failed = r->failure[0] != '\0', speaks = s->rank == 0 && !r->options->quiet;
    if (r->stopped) {
        const char *why = s->stop_request == RG_REQUEST_STOP ? "by a signal" : "before the wall-time limit";
        char status[64];
        snprintf(status, sizeof status, "stopped %s", why);
        r->summary.failure = status;
        rg_summary_write(&r->summary, r->solver, &r->ledger, r->fragments);
        if (s->rank == 0) {
            fprintf(stderr,
                    "rhegma: stopped with a checkpoint at step %" PRId64 ", time %.6g s, %s; goes on with: "
                    "rhegma run --restart %s\n",
                    s->step, s->time, why, r->input->output.dir);
        }
        return RG_INTERRUPTED;
    }
    r->summary.failure = r->failure;
    rg_summary_write(&r->summary, r->solver, &r->ledger, r->fragments);
    if (failed && s->rank == 0) {
        fprintf(stderr, "rhegma: stopped: %s\n", r->failure);
    }
    if (speaks) {
        rg_summary_print(&r->summary, s, &r->ledger, stdout);
    }
    return failed ? RG_FAILURE : RG_OK;
}

int rg_run(const rg_case *c, MPI_Comm comm, const rg_run_options *options) {
    run *r = RG_NEW(run, 1);
    r->input = c;
    r->options = options;
    r->restart = options->restart;
    begin(r, comm);
    time_loop(r);
    while (r->uneven) {
        repartition(r, comm);
        time_loop(r);
    }
    rg_progress_end(&r->progress);
    int status = conclude(r);
    close_outputs(r);
    rg_free(r->summary.estimate.of_material);
    rg_solver_free(r->solver);
    rg_free(r);
    return status;
}

int rg_run_check(const rg_case *c, MPI_Comm comm) {
    rg_solver *s = rg_solver_make(c, comm);
    rg_probes *probes = rg_probes_find(s);
    rg_spectrum(s);
    rg_solver_start(s);
    if (s->prestress != NULL) {
        rg_equilibrium_of_stress(s, stdout);
    }
    rg_solver_measure(s);
    rg_estimate estimate = rg_estimate_run(s);
    if (s->rank == 0) {
        rg_estimate_warn(c, &estimate);
        rg_estimate_print(s, &estimate, stdout);
        rg_probes_print(probes, stdout);
    }
    rg_affinity_print(comm, stdout);
    rg_probes_close(probes);
    rg_free(estimate.of_material);
    rg_solver_free(s);
    return RG_OK;
}
