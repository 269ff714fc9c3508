/* The roofs of the roofline, measured in the same run as the kernels: triad bandwidth and multiply-add rate.
 */
#include <math.h>
#include <omp.h>
#include <string.h>

#include "base/mem.h"
#include "micro/bench.h"
#include "micro/limits.h"

typedef struct {
    const char *name;
    double (*peak)(long rounds, double factor);
    void (*triad)(rg_real *a, const rg_real *b, const rg_real *c, double s, size_t words);
} loops;

static const loops all_loops[] = {
#ifdef RG_X86
    {"x86-64-v4", bench_peak_v4, bench_triad_v4},
    {"x86-64-v3", bench_peak_v3, bench_triad_v3},
    {"x86-64-v2", bench_peak_v2, bench_triad_v2},
#else
    {"generic", bench_peak_generic, bench_triad_generic},
#endif
};

static const loops *find_loops(const char *name) {
    size_t k = 0, last = sizeof all_loops / sizeof *all_loops - 1;
    while (k < last && strcmp(all_loops[k].name, name) != 0) {
        k++;
    }
    return &all_loops[k];
}

struct bench_roof_job {
    const loops *use;
    rg_real *a, *b, *c;
    size_t words;
    long rounds;
    double flops; /* of all threads, in one call */
};

void bench_triad(void *context, int calls) {
    const bench_roof_job *j = context;
#pragma omp parallel
    {
        size_t begin, end;
        bench_share(j->words / RG_LANES, &begin, &end);
        begin *= RG_LANES;
        for (int i = 0; i < calls; i++) {
            j->use->triad(j->a + begin, j->b + begin, j->c + begin, 0.5, end * RG_LANES - begin);
#pragma omp barrier
        }
    }
}

static void first_touch(const bench_roof_job *j) {
#pragma omp parallel
    {
        size_t begin, end;
        bench_share(j->words / RG_LANES, &begin, &end);
        for (size_t i = begin * RG_LANES; i < end * RG_LANES; i++) {
            j->a[i] = 0;
            j->b[i] = 1;
            j->c[i] = 2;
        }
    }
}

bench_roof_job *bench_roof_job_make(const char *set, size_t words, long rounds) {
    bench_roof_job *j = RG_NEW(bench_roof_job, 1);
    *j = (bench_roof_job){.use = find_loops(set),
                          .a = RG_NEW(rg_real, words),
                          .b = RG_NEW(rg_real, words),
                          .c = RG_NEW(rg_real, words),
                          .words = words,
                          .rounds = rounds};
    first_touch(j);
    return j;
}

void bench_roof_job_free(bench_roof_job *j) {
    rg_free(j->a);
    rg_free(j->b);
    rg_free(j->c);
    rg_free(j);
}

void bench_peak(void *context, int calls) {
    bench_roof_job *j = context;
    double flops = 0;
#pragma omp parallel reduction(+ : flops)
    for (int i = 0; i < calls; i++) {
        flops += j->use->peak(j->rounds, 0.999);
    }
    j->flops = flops / calls;
}

size_t bench_triad_words(bench_size size, int threads, bool quick) {
    size_t small = (size_t)threads << 17, least = (size_t)(quick ? 16 : 96) << 20;
    size_t large = (4 * bench_cache_size() / 3 + 63) / 64 * 64;
    return (size == BENCH_CACHE ? small : large > least ? large : least) / sizeof(rg_real);
}

void bench_measure_roofs(const bench *b, bench_roofs *r) {
    const rg_kernels *sets[BENCH_SETS];
    *r = (bench_roofs){.threads = omp_get_max_threads(), .sets = rg_kernels_available(sets, BENCH_SETS)};
    for (int s = 0; s < BENCH_SIZES; s++) {
        r->words[s] = bench_triad_words((bench_size)s, r->threads, b->options.quick);
        bench_roof_job *j = bench_roof_job_make(sets[0]->name, r->words[s], 0);
        bench_measure(b, b->options.repeats, bench_triad, j, &r->triad[s]);
        bench_roof_job_free(j);
    }
    for (int k = 0; k < r->sets; k++) {
        bench_roof_job *j = bench_roof_job_make(sets[k]->name, 0, b->options.quick ? 20000 : 200000);
        r->set[k] = sets[k]->name;
        bench_measure(b, b->options.repeats, bench_peak, j, &r->peak[k]);
        r->flops[k] = j->flops;
        bench_roof_job_free(j);
    }
}

double bench_triad_rate(const bench *b, const bench_roofs *r, bench_size size, int words) {
    double bytes = (double)words * sizeof(rg_real) * (double)r->words[size] * b->ranks;
    return 1e-9 * bytes / bench_median(&r->triad[size]);
}

double bench_peak_rate(const bench *b, const bench_roofs *r, int set) {
    double best = 0;
    for (int k = 0; k < r->sets; k++) {
        double rate = 1e-9 * r->flops[k] * b->ranks / bench_median(&r->peak[k]);
        best = set == k || (set < 0 && rate > best) ? rate : best;
    }
    return best;
}

double bench_roofline(const bench *b, const bench_row *row) {
    for (int k = 0; k < b->roofs; k++) {
        if (b->roof[k].threads == row->threads && row->cost.flops > 0) {
            double stream = bench_triad_rate(b, &b->roof[k], row->size, 4);
            return fmin(bench_peak_rate(b, &b->roof[k], -1), row->cost.flops / row->cost.actual * stream);
        }
    }
    return 0;
}
