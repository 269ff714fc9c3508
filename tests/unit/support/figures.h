/* Figures that a test states: a quantity in words, the value found, theory, and how far apart they may be.
 *
 *     assert_true(state_figure((figure){"speed of a wave", .theory = 8906, .found = c, .bound = 20, .unit =
 * "m/s"})); assert_true(state_figure((figure){"misfit of the yield curve", .found = error, .bound = 3e-12,
 * .why = ROUNDING}));
 *
 * Without a theory it is 0: what is found is an error. With `relative`, `bound` is a share of the theory.
 *
 * Where the environment variable RHEGMA_FIGURES names a file, each figure adds a line of JSON to it, from
 * which tests/report makes its table. The report, not the test, wants a bound within three times the
 * deviation found, or a reason `why` it is wider. (On several ranks: report_figure in tap.h.) */
#ifndef RG_TEST_FIGURES_H
#define RG_TEST_FIGURES_H

#include <fcntl.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#ifdef RG_SINGLE
#define FIGURE_SINGLE "true"
#else
#define FIGURE_SINGLE "false"
#endif
#define ROUNDING "rounding differs between instruction sets"

typedef struct {
    const char *quantity; /* this and the other words: without quotes and backslashes */
    double theory, found, bound;
    bool relative;
    const char *unit, *why;
} figure;

static inline double figure_deviation(const figure *f) {
    double apart = fabs(f->found - f->theory);
    return f->relative ? apart / fabs(f->theory) : apart;
}

/* For a figure of many values, which is the worst of them: raises the error found so far to that of one more.
 */
static inline void raise_figure(figure *f, double got, double expected, double scale) {
    double error = fabs(got - expected) / scale;
    if (!isnan(f->found) && !(error <= f->found)) {
        f->found = error;
    }
}

/* A JSON number; what is none becomes null. */
static inline const char *figure_number(char text[32], double value) {
    snprintf(text, 32, isfinite(value) ? "%.17g" : "null", value);
    return text;
}

/* In one write, since others append to the same file. */
static inline void figure_write(const figure *f, int ranks) {
    const char *path = getenv("RHEGMA_FIGURES");
    if (path == NULL) {
        return;
    }
    const char *slash = strrchr(__BASE_FILE__, '/'), *name = slash != NULL ? slash + 1 : __BASE_FILE__;
    char line[1024], theory[32], found[32], bound[32];
    int length = snprintf(
        line, sizeof line,
        "{\"quantity\": \"%s\", \"theory\": %s, \"found\": %s, \"bound\": %s, \"relative\": %s, "
        "\"unit\": \"%s\", \"why\": \"%s\", \"test\": \"%.*s\", \"ranks\": %d, \"single\": %s}\n",
        f->quantity, figure_number(theory, f->theory), figure_number(found, f->found),
        figure_number(bound, f->bound), f->relative ? "true" : "false", f->unit != NULL ? f->unit : "",
        f->why != NULL ? f->why : "", (int)strcspn(name, "."), name, ranks, FIGURE_SINGLE);
    int file = open(path, O_WRONLY | O_APPEND | O_CREAT, 0666);
    if (file < 0 || length >= (int)sizeof line || write(file, line, (size_t)length) != length) {
        fprintf(stderr, "%s: cannot write the figure '%s'\n", path, f->quantity);
        abort();
    }
    close(file);
}

/* For the reader, as a comment of TAP. */
static inline void figure_print(const figure *f, FILE *stream) {
    fprintf(stream, "# %s: found %.6g%s%s, theory %.6g, bound %.2g%s\n", f->quantity, f->found,
            f->unit != NULL ? " " : "", f->unit != NULL ? f->unit : "", f->theory, f->bound,
            f->relative ? " of it" : "");
}

/* Whether the deviation is within the bound. */
static inline bool state_figure(figure f) {
    figure_write(&f, 1);
    figure_print(&f, stderr);
    return figure_deviation(&f) <= f.bound;
}

#endif
