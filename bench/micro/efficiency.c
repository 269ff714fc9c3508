/* What the cores of a machine gain over one of them, measured so that a noisy machine disturbs both sides of
 * each ratio alike: short samples of everything, in turn, round after round. Ranks that have nothing to do
 * sleep. */
#define _GNU_SOURCE 1 /* sched_setaffinity */
#include <sched.h>

#include <errno.h>
#include <math.h>
#include <mpi.h>
#include <omp.h>
#include <string.h>
#include <time.h>

#include "base/denormals.h"
#include "base/error.h"
#include "base/mem.h"
#include "case/read.h"
#include "micro/bench.h"
#include "micro/spall.h"
#include "solver/setup.h"
#include "solver/step.h"

enum { FORMS = 2, LAYOUTS = 3, QUANTITIES = 4 + LAYOUTS * FORMS, STEPS = 3, TRIADS = 6, PEAKS = 4 };

static const char *const forms[FORMS] = {"variational", "incomplete"};

/* Samples in seconds per call. */
typedef struct {
    const char *name;
    int form;     /* -1: a roof */
    int threads;  /* of rank 0; of each rank in a common job */
    bool common;  /* all ranks work */
    int calls;    /* of one sample */
    double scale; /* work of a call over the work of the one-core call */
    void (*call)(void *, int);
    void *job;
    bench_samples samples;
} quantity;

typedef struct {
    bench *b;
    int cores, rounds;
    int cpu[CPU_SETSIZE]; /* the first processors allowed, one a core */
    rg_case *input[FORMS];
    rg_solver *alone[FORMS], *common[FORMS]; /* rank 0's with a thread per core; one thread per rank */
    bench_roof_job *roof;
    size_t tets;
    quantity q[QUANTITIES];
} efficiency;

/* ---- Processors ---- */

static void pin(int cpu) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET((size_t)cpu, &set);
    sched_setaffinity(0, sizeof set, &set);
}

/* Thread k on core k, or the one thread of a rank on the rank's core. */
static void place_threads(const efficiency *e, int threads) {
    omp_set_num_threads(threads);
#pragma omp parallel
    pin(e->cpu[threads > 1 ? omp_get_thread_num() : e->b->rank]);
}

static void find_processors(efficiency *e) {
    cpu_set_t mask;
    CPU_ZERO(&mask);
    sched_getaffinity(0, sizeof mask, &mask);
    int found = 0;
    for (size_t c = 0; c < CPU_SETSIZE && found < e->cores; c++) {
        if (CPU_ISSET(c, &mask)) {
            e->cpu[found++] = (int)c;
        }
    }
    if (found < e->cores) {
        rg_fatal(RG_USAGE,
                 "%d processors are needed, one for each rank, and %d allowed (mpirun --bind-to none)",
                 e->cores, found);
    }
}

/* A barrier in which nobody spins: whoever works meanwhile has the machine to himself. */
static void sleep_until_all_are_here(void) {
    MPI_Request request;
    int done = 0;
    MPI_Ibarrier(MPI_COMM_WORLD, &request);
    while (MPI_Test(&request, &done, MPI_STATUS_IGNORE), !done) {
        nanosleep(&(struct timespec){.tv_nsec = 500 * 1000}, NULL);
    }
}

/* ---- Set-up ---- */

static void make_solvers(efficiency *e, const int cells[3]) {
    bool first = e->b->rank == 0;
    for (int f = 0; f < FORMS; f++) {
        e->input[f] = bench_spall_case(cells, e->b->options.tile, forms[f]);
        if (first) {
            place_threads(e, e->cores);
            e->alone[f] = rg_solver_make(e->input[f], MPI_COMM_SELF);
            rg_solver_start(e->alone[f]);
        }
        sleep_until_all_are_here();
        place_threads(e, 1);
        e->common[f] = rg_solver_make(e->input[f], MPI_COMM_WORLD);
        rg_solver_start(e->common[f]);
    }
    e->tets = (size_t)e->common[0]->part->total;
}

static void list_quantities(efficiency *e) {
    int n = e->cores;
    double all = n;
    quantity *q = e->q;
    *q++ = (quantity){"triad, one core", -1, 1, false, TRIADS, 1, bench_triad, e->roof, {0}};
    *q++ = (quantity){"triad, all cores", -1, n, false, TRIADS, 1, bench_triad, e->roof, {0}};
    *q++ = (quantity){"peak, one core", -1, 1, false, PEAKS, 1, bench_peak, e->roof, {0}};
    *q++ = (quantity){"peak, all cores", -1, n, false, PEAKS, all, bench_peak, e->roof, {0}};
    for (int f = 0; f < FORMS; f++) {
        void *alone = e->alone[f], *common = e->common[f];
        *q++ = (quantity){"step, one core", f, 1, false, STEPS, 1, bench_spall_steps, alone, {0}};
        *q++ = (quantity){"step, threads", f, n, false, STEPS, 1, bench_spall_steps, alone, {0}};
        *q++ = (quantity){"step, ranks", f, 1, true, STEPS, 1, bench_spall_steps, common, {0}};
    }
}

static efficiency *make(bench *b) {
    efficiency *e = RG_NEW(efficiency, 1);
    static const int full[3] = {15, 15, 166}, quick[3] = {6, 6, 60};
    *e = (efficiency){.b = b, .cores = b->ranks, .rounds = b->options.rounds};
    find_processors(e);
    make_solvers(e, b->options.quick ? quick : full);
    if (b->rank == 0) {
        const rg_kernels *sets[BENCH_SETS];
        rg_kernels_available(sets, BENCH_SETS);
        place_threads(e, e->cores);
        e->roof = bench_roof_job_make(sets[0]->name,
                                      bench_triad_words(BENCH_MEMORY, e->cores, b->options.quick), 2000000);
    }
    list_quantities(e);
    return e;
}

static void discard(efficiency *e) {
    for (int f = 0; f < FORMS; f++) {
        rg_solver_free(e->alone[f]);
        rg_solver_free(e->common[f]);
        rg_case_free(e->input[f]);
    }
    if (e->roof != NULL) {
        bench_roof_job_free(e->roof);
    }
    rg_free(e);
}

/* ---- Rounds ---- */

/* A call to warm up, then those that count. */
static double sample(const efficiency *e, const quantity *q) {
    double t = 0;
    sleep_until_all_are_here();
    if (q->common || e->b->rank == 0) {
        place_threads(e, q->threads);
        rg_flush_denormals();
        q->call(q->job, 1);
        if (q->common) {
            MPI_Barrier(MPI_COMM_WORLD);
        }
        t = MPI_Wtime();
        q->call(q->job, q->calls);
        t = MPI_Wtime() - t;
    }
    sleep_until_all_are_here();
    MPI_Allreduce(MPI_IN_PLACE, &t, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    return t / q->calls / q->scale;
}

/* The state of all steps is the same in each round. */
static void reset_states(efficiency *e) {
    const rg_kernels *sets[BENCH_SETS];
    rg_kernels_available(sets, BENCH_SETS);
    for (int f = 0; f < FORMS; f++) {
        if (e->b->rank == 0) {
            place_threads(e, e->cores);
            bench_spall_reset(e->alone[f], sets[0], 0);
        }
        sleep_until_all_are_here();
        place_threads(e, 1);
        bench_spall_reset(e->common[f], sets[0], 0);
    }
}

/* There and back, so that a drift of the machine favours none. */
static void round_trip(efficiency *e, int round) {
    for (int k = 0; k < QUANTITIES; k++) {
        quantity *q = &e->q[round % 2 == 0 ? k : QUANTITIES - 1 - k];
        q->samples.seconds[q->samples.count++] = sample(e, q);
    }
}

/* ---- Result ----
 * Medians of each round's ratios; and, as what a machine does that nobody disturbs, ratios of the fastest
 * samples. */

/* Of each round: how often the work of one core is done in the time of all. */
static bench_samples ratios(const quantity *one, const quantity *all) {
    bench_samples r = {.count = one->samples.count};
    for (int i = 0; i < r.count; i++) {
        r.seconds[i] = one->samples.seconds[i] / all->samples.seconds[i];
    }
    return r;
}

static bench_samples limits(const efficiency *e) {
    bench_samples triad = ratios(&e->q[0], &e->q[1]), peak = ratios(&e->q[2], &e->q[3]);
    for (int i = 0; i < triad.count; i++) {
        triad.seconds[i] = fmin(triad.seconds[i], peak.seconds[i]);
    }
    return triad;
}

static bench_samples shares(const bench_samples *gain, const bench_samples *limit) {
    bench_samples r = *gain;
    for (int i = 0; i < r.count; i++) {
        r.seconds[i] /= limit->seconds[i];
    }
    return r;
}

/* Of the fastest samples. */
static double gain_of_least(const quantity *one, const quantity *all) {
    return bench_minimum(&one->samples) / bench_minimum(&all->samples);
}

static double limit_of_least(const efficiency *e) {
    return fmin(gain_of_least(&e->q[0], &e->q[1]), gain_of_least(&e->q[2], &e->q[3]));
}

static void put_samples(FILE *out, const char *key, const bench_samples *s) {
    fprintf(out, "\"%s\": %.4f, \"%s_quartiles\": [%.4f, %.4f]", key, bench_median(s), key,
            bench_quantile(s, 0.25), bench_quantile(s, 0.75));
}

static void print_line(const char *name, const bench_samples *s, double least) {
    printf("%-34s %6.3f   %5.3f to %5.3f   %6.3f\n", name, bench_median(s), bench_quantile(s, 0.25),
           bench_quantile(s, 0.75), least);
}

static void print(const efficiency *e) {
    char name[BENCH_LABEL];
    bench_samples limit = limits(e), triad = ratios(&e->q[0], &e->q[1]), peak = ratios(&e->q[2], &e->q[3]);
    printf("%d cores over one, %zu tets, %d rounds\n", e->cores, e->tets, e->rounds);
    printf("%-34s %6s   %14s   %6s\n", "", "median", "quartiles", "fastest");
    print_line("gain, triad", &triad, gain_of_least(&e->q[0], &e->q[1]));
    print_line("gain, peak", &peak, gain_of_least(&e->q[2], &e->q[3]));
    print_line("limit: the smaller of each round", &limit, limit_of_least(e));
    for (int f = 0; f < FORMS; f++) {
        const quantity *q = &e->q[4 + LAYOUTS * f];
        double scale = 1e6 / (double)e->tets;
        printf("%s on one core: median %.4f, least %.4f us/tet\n", forms[f],
               scale * bench_median(&q->samples), scale * bench_minimum(&q->samples));
        for (int k = 1; k < LAYOUTS; k++) {
            bench_samples gain = ratios(q, &q[k]), share = shares(&gain, &limit);
            snprintf(name, sizeof name, "  gain, %s", q[k].name);
            double least = gain_of_least(q, &q[k]);
            print_line(name, &gain, least);
            print_line("    of the limit", &share, least / limit_of_least(e));
        }
    }
}

static void put_quantities(const efficiency *e, FILE *out) {
    for (int k = 0; k < QUANTITIES; k++) {
        const quantity *q = &e->q[k];
        fprintf(out, "%s\n    {\"name\": \"%s\", \"form\": \"%s\", \"samples_s\": [", k > 0 ? "," : "",
                q->name, q->form < 0 ? "" : forms[q->form]);
        for (int i = 0; i < q->samples.count; i++) {
            fprintf(out, "%s%.6g", i > 0 ? ", " : "", q->samples.seconds[i]);
        }
        fprintf(out, "]}");
    }
}

static void put_result(const efficiency *e, FILE *out) {
    bench_samples limit = limits(e);
    fprintf(out, "  \"cores\": %d, \"tets\": %zu, ", e->cores, e->tets);
    put_samples(out, "limit", &limit);
    fprintf(out, ",\n  \"steps\": [");
    for (int f = 0; f < FORMS; f++) {
        for (int k = 1; k < LAYOUTS; k++) {
            const quantity *q = &e->q[4 + LAYOUTS * f];
            bench_samples gain = ratios(q, &q[k]), share = shares(&gain, &limit);
            fprintf(out, "%s\n    {\"form\": \"%s\", \"layout\": \"%s\", ", f + k > 1 ? "," : "", forms[f],
                    k == 1 ? "threads" : "ranks");
            put_samples(out, "gain", &gain);
            fprintf(out, ", ");
            put_samples(out, "of_limit", &share);
            fprintf(out, ", \"of_limit_fastest\": %.4f}", gain_of_least(q, &q[k]) / limit_of_least(e));
        }
    }
    fprintf(out, "],\n  \"quantities\": [");
    put_quantities(e, out);
    fprintf(out, "]\n}\n");
}

static void write_record(const efficiency *e, char (*affinity)[BENCH_TEXT]) {
    const char *path = e->b->options.json;
    FILE *out = fopen(path, "w");
    if (out == NULL) {
        rg_fatal(RG_FAILURE, "%s: cannot be written: %s", path, strerror(errno));
    }
    fprintf(out, "{\n  \"program\": \"rhegma-bench --efficiency\", \"quick\": %s,\n",
            e->b->options.quick ? "true" : "false");
    bench_put_build(out);
    bench_put_machine(e->b, affinity, out);
    put_result(e, out);
    if (ferror(out) || fclose(out) != 0) {
        rg_fatal(RG_FAILURE, "%s: writing failed", path);
    }
}

/* The processors as they are in the runs with a rank a core. */
static void report(const efficiency *e) {
    place_threads(e, 1);
    e->b->options.threads = 1;
    char(*affinity)[BENCH_TEXT] = bench_affinity(e->b);
    if (e->b->rank != 0) {
        return;
    }
    for (int r = 0; r < e->cores; r++) {
        printf("core %d: processor %s (thread %d of rank 0, or rank %d)\n", r, affinity[r], r, r);
    }
    print(e);
    if (e->b->options.json != NULL) {
        write_record(e, affinity);
    }
    rg_free(affinity);
}

void bench_efficiency(bench *b) {
    efficiency *e = make(b);
    for (int round = 0; round < e->rounds; round++) {
        reset_states(e);
        round_trip(e, round);
    }
    report(e);
    discard(e);
}
