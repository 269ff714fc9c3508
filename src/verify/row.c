#include "verify/row.h"

#include <inttypes.h>
#include <math.h>

static rg_verify_row *next(rg_verify_rows *rows, const char *check) {
    rg_verify_row *row = &rows->row[rows->rows++];
    *row = (rg_verify_row){.check = check};
    return row;
}

void rg_verify_value(rg_verify_rows *rows, const char *check, double theory, double measured, double limit) {
    rg_verify_row *row = next(rows, check);
    bool zero = fabs(theory) <= 0;
    snprintf(row->theory, sizeof row->theory, "%.6g", theory);
    snprintf(row->measured, sizeof row->measured, zero ? "%.2g" : "%.6g", measured);
    row->deviation = fabs(zero ? measured : measured / theory - 1);
    row->limit = limit;
}

void rg_verify_hash(rg_verify_rows *rows, const char *check, uint64_t expected, uint64_t found) {
    rg_verify_row *row = next(rows, check);
    snprintf(row->theory, sizeof row->theory, "%016" PRIx64, expected);
    snprintf(row->measured, sizeof row->measured, "%016" PRIx64, found);
    row->deviation = expected == found ? 0 : INFINITY;
    row->limit = 0;
}

bool rg_verify_holds(const rg_verify_row *row) {
    return row->deviation <= row->limit;
}

void rg_verify_print_head(FILE *out) {
    fprintf(out, "%-44s %16s %16s %10s %8s  %s\n", "check", "theory", "measured", "deviation", "limit", "ok");
}

void rg_verify_print(const rg_verify_row *row, FILE *out) {
    fprintf(out, "%-44s %16s %16s %10.1e %8.0e  %s\n", row->check, row->theory, row->measured, row->deviation,
            row->limit, rg_verify_holds(row) ? "yes" : "NO");
    fflush(out);
}
