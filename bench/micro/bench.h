/* The microbenchmark harness: what its parts share. One row of the result is one kernel (or the whole step)
 * of one instruction set, on one size and number of threads; every repeat is kept. */
#ifndef RG_BENCH_H
#define RG_BENCH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "cost/model.h"
#include "kernels.h"

enum { BENCH_SAMPLES = 100, BENCH_SETS = 4, BENCH_LABEL = 48, BENCH_TEXT = 256 };

typedef struct {
    bool quick;
    const char *json;   /* file to write, or NULL */
    const char *kernel; /* only rows with this in their name, or NULL */
    int threads;        /* up to this many */
    int rounds;         /* of the measurement of efficiency; 0 for the table of kernels */
    int repeats;
    int tile; /* elements of one, in the whole step */
} bench_options;

/* Seconds per call, the slowest rank's, of each repeat. */
typedef struct {
    int count;
    double seconds[BENCH_SAMPLES];
} bench_samples;

/* Where the data of a row come from, and hence which triad bounds it. */
typedef enum { BENCH_CACHE, BENCH_MEMORY, BENCH_SIZES } bench_size;

extern const char *const bench_size_name[BENCH_SIZES];

/* Counts are sums over the ranks. */
typedef struct {
    char kernel[BENCH_LABEL];
    const char *set; /* instruction set */
    bench_size size;
    int threads;
    double tets;  /* a call's work, in tetrahedra; two interfaces count as one */
    rg_cost cost; /* of one call */
    bench_samples samples;
} bench_row;

/* What the machine can do: measured on all ranks at once, each with `threads` threads. */
typedef struct {
    int threads;
    bench_samples triad[BENCH_SIZES]; /* seconds of one triad over words[size] words per array and rank */
    size_t words[BENCH_SIZES];
    int sets;
    const char *set[BENCH_SETS];
    bench_samples peak[BENCH_SETS]; /* seconds of flops[set] operations per rank */
    double flops[BENCH_SETS];
} bench_roofs;

typedef struct {
    bench_options options;
    int rank, ranks;
    int rows, roofs, capacity;
    bench_row *row;
    bench_roofs roof[32]; /* per number of threads */
    bool failed;          /* a variant differs from the reference */
} bench;

/* ---- Time (bench_time.c) ---- */

/* Times call(context, calls), which does its work `calls` times over: after a warm-up, `repeats` samples or
 * as many as fit into some seconds (at least three). Collective. */
void bench_measure(const bench *b, int repeats, void (*call)(void *context, int calls), void *context,
                   bench_samples *out);

/* Times one call, done once. Collective. */
void bench_measure_once(void (*call)(void *context, int calls), void *context, bench_samples *out);

/* Value below which the share `p` of the samples lies, between neighbours linearly. */
double bench_quantile(const bench_samples *s, double p);
double bench_median(const bench_samples *s);
double bench_minimum(const bench_samples *s);

/* Share of `count` blocks that belongs to the calling thread of a team: [begin, end). */
void bench_share(size_t count, size_t *begin, size_t *end);

/* ---- Roofs (bench_roof.c) ---- */

/* Measures triad and peak for the number of threads that OpenMP is set to. Collective. */
void bench_measure_roofs(const bench *b, bench_roofs *r);

/* Arrays of `words` words for the triad and `rounds` of multiply-adds for the peak, in loops of the
 * instruction set named; memory lies with the threads that OpenMP is set to. Free with bench_roof_job_free.
 */
typedef struct bench_roof_job bench_roof_job;
bench_roof_job *bench_roof_job_make(const char *set, size_t words, long rounds);
void bench_roof_job_free(bench_roof_job *j);

/* `calls` times all words, shared among the threads; all rounds, on each thread. */
void bench_triad(void *job, int calls);
void bench_peak(void *job, int calls);

/* Words of a triad array: in the cache, as much memory as the kernels' small problem takes; else four times
 * the last cache over three arrays, and not less than a good number of pages. */
size_t bench_triad_words(bench_size size, int threads, bool quick);

/* GB/s over all ranks, from the median: 3 words an element, as triads are quoted, or 4 with the line fetched
 * before it is written, as the cost model counts. */
double bench_triad_rate(const bench *b, const bench_roofs *r, bench_size size, int words);

/* Gflop/s over all ranks, from the median; the highest of all sets if `set` is -1. */
double bench_peak_rate(const bench *b, const bench_roofs *r, int set);

/* min(peak, intensity * triad) of a row, in Gflop/s; 0 for a row without operations. */
double bench_roofline(const bench *b, const bench_row *row);

/* ---- What is measured ---- */

/* All kernels on one size with one number of threads, validated and timed. Collective. */
void bench_kernels(bench *b, bench_size size, int threads);

/* The whole step of the solver on two meshes, unbroken and with a tenth of the faces broken. Collective. */
void bench_steps(bench *b, int threads);

/* Whether the options ask for a row of this name. */
bool bench_wants(const bench *b, const char *kernel);

/* A new row; the pointer holds until the next one. */
bench_row *bench_add_row(bench *b, const char *kernel, const char *set, bench_size size, int threads);

/* What `ranks` cores gain over one: triad, peak and the step, on one core, on all as threads of rank 0, and
 * on all as ranks, in turn, options.rounds times; prints the ratios, writes options.json. Collective. */
void bench_efficiency(bench *b);

/* What the cost model says of each kernel and of the step, as a table in Markdown. */
void bench_print_costs(void);

/* Names of the kernels, NULL behind the last. */
const char *bench_kernel_name(int k);
const char *bench_step_name(int k);

/* Compares `got` with `expected`, relative to the largest expected value of all; complains and notes the
 * failure where they differ. Local to the rank. */
typedef struct {
    const char *name;
    const void *got; /* reals or doubles */
    const double *expected;
    size_t count, size; /* values; bytes of one in `got` */
} bench_field;

/* Value i of an array of reals or doubles. */
double bench_value(const void *values, size_t size, size_t i);

void bench_compare(bench *b, const bench_row *row, const bench_field *f);

/* ---- Report (bench_report.c, bench_json.c) ---- */

/* Rank 0. */
void bench_print_roofs(const bench *b, const bench_roofs *r, FILE *out);
void bench_print_header(FILE *out);
void bench_print_row(const bench *b, const bench_row *row, FILE *out);

/* Members of the record: the machine with each thread's processors, [ranks][threads], and the build. */
void bench_put_machine(const bench *b, char (*affinity)[BENCH_TEXT], FILE *out);
void bench_put_build(FILE *out);

/* Collective; writes options.json on rank 0. */
void bench_write_json(const bench *b);

/* ---- Machine (bench_machine.c) ---- */

/* Processor model from /proc/cpuinfo, "unknown" if it is not there. */
void bench_cpu_model(char text[BENCH_TEXT]);

/* Size of the last-level cache in bytes, or 0. */
size_t bench_cache_size(void);

/* Processors that each thread of each rank may use, as lists such as "0-3,8": [rank][thread]. Collective; the
 * result is rank 0's (others NULL), freed with rg_free. */
char (*bench_affinity(const bench *b))[BENCH_TEXT];

/* Processors of the machine. */
int bench_processors(void);

#endif
