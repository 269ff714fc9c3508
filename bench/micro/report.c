/* The table on standard output, and what decides that a variant failed. */
#include <math.h>
#include <string.h>

#include "micro/bench.h"

/* Of the largest value of the field: instruction sets fuse and order operations in their own way. */
#define TOLERANCE (sizeof(rg_real) == sizeof(double) ? 1e-10 : 1e-5)

double bench_value(const void *values, size_t size, size_t i) {
    return size == sizeof(double) ? ((const double *)values)[i] : (double)((const float *)values)[i];
}

void bench_compare(bench *b, const bench_row *row, const bench_field *f) {
    double scale = 0;
    for (size_t i = 0; i < f->count; i++) {
        scale = fmax(scale, fabs(f->expected[i]));
    }
    for (size_t i = 0; i < f->count; i++) {
        double got = bench_value(f->got, f->size, i);
        if (!(fabs(got - f->expected[i]) <= TOLERANCE * scale)) {
            fprintf(
                stderr,
                "rhegma-bench: %s, %s (%s, %d threads, rank %d): %s[%zu] is %.17g, the reference has %.17g\n",
                row->kernel, row->set, bench_size_name[row->size], row->threads, b->rank, f->name, i, got,
                f->expected[i]);
            b->failed = true;
            return;
        }
    }
}

void bench_print_roofs(const bench *b, const bench_roofs *r, FILE *out) {
    if (b->rank != 0) {
        return;
    }
    fprintf(out, "\n%d ranks x %d threads, %s precision\n", b->ranks, r->threads, RG_PRECISION);
    for (int s = 0; s < BENCH_SIZES; s++) {
        double mb = 3e-6 * sizeof(rg_real) * (double)r->words[s];
        fprintf(out, "triad %-10s %8.1f GB/s (3 words), %.1f with write-allocate; %.3g MB a rank\n",
                bench_size_name[s], bench_triad_rate(b, r, (bench_size)s, 3),
                bench_triad_rate(b, r, (bench_size)s, 4), mb);
    }
    for (int k = 0; k < r->sets; k++) {
        fprintf(out, "peak  %-10s %8.1f Gflop/s\n", r->set[k], bench_peak_rate(b, r, k));
    }
}

void bench_print_header(FILE *out) {
    fprintf(out, "\n%-29s %-9s %-6s %7s %3s %8s %8s %7s %7s %6s %6s\n", "kernel", "set", "level", "tets",
            "thr", "us/tet", "least", "GF/s", "GB/s", "F/B", "% roof");
}

void bench_print_row(const bench *b, const bench_row *row, FILE *out) {
    if (b->rank != 0) {
        return;
    }
    double t = bench_median(&row->samples), roof = bench_roofline(b, row), scale = 1e6 / row->tets;
    fprintf(out, "%-29s %-9s %-6s %7.0f %3d %8.4f %8.4f ", row->kernel, row->set, bench_size_name[row->size],
            row->tets, row->threads, scale * t, scale * bench_minimum(&row->samples));
    if (row->cost.flops > 0) {
        fprintf(out, "%7.2f %7.2f %6.3f %6.1f\n", 1e-9 * row->cost.flops / t, 1e-9 * row->cost.actual / t,
                row->cost.flops / row->cost.actual, 100e-9 * row->cost.flops / t / roof);
    } else {
        fprintf(out, "%7s %7s %6s %6s\n", "-", "-", "-", "-");
    }
    fflush(out);
}
