/* The case file: any bytes, up to a NUL; what follows it are overrides, one a line. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "case/case.h"
#include "case/read.h"
#include "case/echo.h"
#include "host.h"

enum { MOST = 8 };

/* What rg_case_echo says of the case, or the problems of a text that is none. The caller frees the result. */
static char *read_and_echo(const char *text, size_t size, int count, const char *const *set, bool *good) {
    char *said = NULL, *echo = NULL;
    size_t said_size = 0, echo_size = 0;
    FILE *errors = open_memstream(&said, &said_size), *out = open_memstream(&echo, &echo_size);
    rg_case *c = rg_case_read_text("case.yaml", text, size, count, set, errors);
    fclose(errors);
    *good = c != NULL;
    rg_fuzz_require(*good == (said_size == 0), "problems are told if and only if there are some");
    if (*good) {
        static const double x[3] = {1e-3, -2e-3, 0.5};
        for (int k = 0; k < 3; k++) {
            for (int n = 0; n < 2; n++) {
                const rg_expr *e = n == 0 ? c->initial.displacement[k] : c->initial.velocity[k];
                rg_fuzz_require(e == NULL || rg_expr_text(e) != NULL, "an expression has its text");
                double value = e != NULL ? rg_expr_value(e, x, 0) : 0;
                double again = e != NULL ? rg_expr_value(e, x, 0) : 0;
                rg_fuzz_require(!(value < again) && !(value > again), "an expression has one value");
            }
        }
        rg_case_echo(c, out);
    }
    rg_case_free(c);
    fclose(out);
    free(said);
    return echo;
}

static void body(const uint8_t *data, size_t size) {
    char *copy = malloc(size + 1), *rest = copy;
    const char *set[MOST];
    int count = 0;
    bool good, again;
    memcpy(copy, data, size);
    copy[size] = '\0';
    size_t length = strlen(copy);
    for (rest = copy + length + 1; rest < copy + size && count < MOST; count++) {
        set[count] = rest;
        rest += strcspn(rest, "\n");
        *rest++ = '\0';
    }
    char *echo = read_and_echo(copy, length, count, set, &good);
    if (good) {
        char *second = read_and_echo(echo, strlen(echo), 0, NULL, &again);
        rg_fuzz_require(again && strcmp(echo, second) == 0, "the echo of a case is the same case");
        free(second);
    }
    free(echo);
    free(copy);
}

RG_FUZZ_TARGET(body)
