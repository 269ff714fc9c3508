#include <math.h>
#include <mpi.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "micro/bench.h"

/* Short calls are repeated within a sample until it lasts this long (s). */
#define SAMPLE_SECONDS 2e-3
#define QUICK_SECONDS  5e-4
/* A row takes no longer than about this (s). */
#define ROW_SECONDS 10.0
#define QUICK_ROW   0.05
enum { LEAST_SAMPLES = 3 };

/* Seconds that the slowest rank takes. */
static double elapsed(void (*call)(void *, int), void *context, int calls) {
    MPI_Barrier(MPI_COMM_WORLD);
    double t = MPI_Wtime();
    call(context, calls);
    t = MPI_Wtime() - t;
    MPI_Allreduce(MPI_IN_PLACE, &t, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    return t;
}

void bench_measure(const bench *b, int repeats, void (*call)(void *, int), void *context,
                   bench_samples *out) {
    double target = b->options.quick ? QUICK_SECONDS : SAMPLE_SECONDS;
    double budget = b->options.quick ? QUICK_ROW : ROW_SECONDS, sum = 0;
    double once = elapsed(call, context, 1);
    int calls = once < target ? (int)ceil(target / fmax(once, 1e-7)) : 1;
    elapsed(call, context, calls); /* warms up for what follows */
    out->count = 0;
    while (out->count < repeats && (out->count < LEAST_SAMPLES || sum < budget)) {
        double t = elapsed(call, context, calls);
        sum += t;
        out->seconds[out->count++] = t / calls;
    }
}

void bench_measure_once(void (*call)(void *, int), void *context, bench_samples *out) {
    out->count = 1;
    out->seconds[0] = elapsed(call, context, 1);
}

static int ascending(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double bench_quantile(const bench_samples *s, double p) {
    double sorted[BENCH_SAMPLES], at = p * (s->count - 1);
    memcpy(sorted, s->seconds, (size_t)s->count * sizeof *sorted);
    qsort(sorted, (size_t)s->count, sizeof *sorted, ascending);
    int below = (int)at, above = below + 1 < s->count ? below + 1 : below;
    return sorted[below] + (at - below) * (sorted[above] - sorted[below]);
}

double bench_median(const bench_samples *s) {
    return bench_quantile(s, 0.5);
}

double bench_minimum(const bench_samples *s) {
    double least = s->seconds[0];
    for (int i = 1; i < s->count; i++) {
        least = fmin(least, s->seconds[i]);
    }
    return least;
}

void bench_share(size_t count, size_t *begin, size_t *end) {
    size_t team = (size_t)omp_get_num_threads(), me = (size_t)omp_get_thread_num();
    *begin = count * me / team;
    *end = count * (me + 1) / team;
}
