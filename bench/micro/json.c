/* The record of a run: what it ran on, the roofs, and every sample of every row. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/error.h"
#include "base/mem.h"
#include "micro/bench.h"
#include "revision.h"

#ifndef RG_COMPILER_FLAGS
#define RG_COMPILER_FLAGS "unknown"
#endif

/* A string, quoted. */
static void put_text(FILE *out, const char *key, const char *text) {
    fprintf(out, "\"%s\": \"", key);
    for (; *text != '\0'; text++) {
        if (*text == '"' || *text == '\\') {
            fputc('\\', out);
        }
        fputc((unsigned char)*text < ' ' ? ' ' : *text, out);
    }
    fputc('"', out);
}

static void put_samples(FILE *out, const char *key, const bench_samples *s, double scale) {
    fprintf(out, "\"%s\": [", key);
    for (int i = 0; i < s->count; i++) {
        fprintf(out, "%s%.6g", i > 0 ? ", " : "", scale * s->seconds[i]);
    }
    fputc(']', out);
}

static void put_date(FILE *out) {
    char text[32];
    time_t now = time(NULL);
    struct tm utc;
    strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", gmtime_r(&now, &utc));
    put_text(out, "date", text);
}

void bench_put_machine(const bench *b, char (*affinity)[BENCH_TEXT], FILE *out) {
    char cpu[BENCH_TEXT], host[BENCH_TEXT] = "";
    bench_cpu_model(cpu);
    gethostname(host, sizeof host - 1);
    fprintf(out, "  \"machine\": {");
    put_text(out, "cpu", cpu);
    fprintf(out, ", \"processors\": %d, \"last_cache_bytes\": %zu, ", bench_processors(), bench_cache_size());
    put_text(out, "host", host);
    fprintf(out, "},\n  \"ranks\": %d, \"threads\": %d,\n  \"affinity\": [", b->ranks, b->options.threads);
    for (int i = 0; i < b->ranks * b->options.threads; i++) {
        fprintf(out, "%s\n    {\"rank\": %d, \"thread\": %d, ", i > 0 ? "," : "", i / b->options.threads,
                i % b->options.threads);
        put_text(out, "processors", affinity[i]);
        fputc('}', out);
    }
    fprintf(out, "],\n");
}

void bench_put_build(FILE *out) {
    fprintf(out, "  ");
    put_text(out, "revision", RG_REVISION);
    fprintf(out, ", ");
    put_date(out);
    fprintf(out, ",\n  ");
    put_text(out, "compiler", __VERSION__);
    fprintf(out, ", ");
    put_text(out, "flags", RG_COMPILER_FLAGS);
    fprintf(out, ",\n  ");
    put_text(out, "precision", RG_PRECISION);
    fprintf(out, ",\n");
}

/* One line per triad and per peak; rates over all ranks. */
static void put_roofs(const bench *b, FILE *out) {
    const char *separator = "";
    fprintf(out, "  \"triad\": [");
    for (int k = 0; k < b->roofs; k++) {
        for (int s = 0; s < BENCH_SIZES; s++) {
            const bench_roofs *r = &b->roof[k];
            fprintf(out,
                    "%s\n    {\"threads\": %d, \"level\": \"%s\", \"gbytes_3_words\": %.5g, "
                    "\"gbytes_with_write_allocate\": %.5g, \"bytes_per_rank\": %zu, ",
                    separator, r->threads, bench_size_name[s], bench_triad_rate(b, r, (bench_size)s, 3),
                    bench_triad_rate(b, r, (bench_size)s, 4), 3 * sizeof(rg_real) * r->words[s]);
            put_samples(out, "samples_s", &r->triad[s], 1);
            fputc('}', out);
            separator = ",";
        }
    }
    separator = "";
    fprintf(out, "],\n  \"peak\": [");
    for (int k = 0; k < b->roofs; k++) {
        for (int s = 0; s < b->roof[k].sets; s++) {
            const bench_roofs *r = &b->roof[k];
            fprintf(out, "%s\n    {\"threads\": %d, \"set\": \"%s\", \"gflops\": %.5g, ", separator,
                    r->threads, r->set[s], bench_peak_rate(b, r, s));
            put_samples(out, "samples_s", &r->peak[s], 1);
            fputc('}', out);
            separator = ",";
        }
    }
    fprintf(out, "],\n");
}

static void put_row(const bench *b, const bench_row *r, FILE *out) {
    double t = bench_median(&r->samples), scale = 1e6 / r->tets, roof = bench_roofline(b, r);
    fprintf(out,
            "    {\"kernel\": \"%s\", \"set\": \"%s\", \"level\": \"%s\", \"tets\": %.0f, \"ranks\": %d, "
            "\"threads\": %d,\n",
            r->kernel, r->set, bench_size_name[r->size], r->tets, b->ranks, r->threads);
    fprintf(
        out, "     \"us_per_tet\": %.6g, \"us_per_tet_least\": %.6g, \"gflops\": %.5g, \"gbytes\": %.5g,\n",
        scale * t, scale * bench_minimum(&r->samples), 1e-9 * r->cost.flops / t, 1e-9 * r->cost.actual / t);
    fprintf(
        out,
        "     \"flops_per_tet\": %.6g, \"minimal_bytes_per_tet\": %.6g, \"actual_bytes_per_tet\": %.6g,\n",
        r->cost.flops / r->tets, r->cost.minimal / r->tets, r->cost.actual / r->tets);
    fprintf(out, "     \"roofline_gflops\": %.5g, \"percent_of_roofline\": %.4g,\n     ", roof,
            roof > 0 ? 100e-9 * r->cost.flops / t / roof : 0);
    put_samples(out, "samples_us_per_tet", &r->samples, scale);
    fputc('}', out);
}

static void put_all(const bench *b, char (*affinity)[BENCH_TEXT], FILE *out) {
    fprintf(out, "{\n  \"program\": \"rhegma-bench\", \"quick\": %s, \"tile\": %d, \"validated\": %s,\n",
            b->options.quick ? "true" : "false", b->options.tile, b->failed ? "false" : "true");
    bench_put_build(out);
    bench_put_machine(b, affinity, out);
    put_roofs(b, out);
    fprintf(out, "  \"rows\": [\n");
    for (int k = 0; k < b->rows; k++) {
        put_row(b, &b->row[k], out);
        fprintf(out, "%s\n", k + 1 < b->rows ? "," : "");
    }
    fprintf(out, "  ]\n}\n");
}

void bench_write_json(const bench *b) {
    char(*affinity)[BENCH_TEXT] = bench_affinity(b);
    if (b->rank == 0) {
        FILE *out = fopen(b->options.json, "w");
        if (out == NULL) {
            rg_fatal(RG_FAILURE, "%s: cannot be written: %s", b->options.json, strerror(errno));
        }
        put_all(b, affinity, out);
        if (ferror(out) || fclose(out) != 0) {
            rg_fatal(RG_FAILURE, "%s: writing failed", b->options.json);
        }
        rg_free(affinity);
    }
}
