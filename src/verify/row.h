/* Rows of the table of rhegma verify: what theory says, what was measured, whether they agree. */
#ifndef RG_VERIFY_ROW_H
#define RG_VERIFY_ROW_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

enum { RG_VERIFY_ROWS = 8 }; /* most rows of one check */

typedef struct {
    const char *check;
    char theory[24], measured[24];
    double deviation, limit;
} rg_verify_row;

typedef struct {
    int rows;
    rg_verify_row row[RG_VERIFY_ROWS];
} rg_verify_rows;

/* Adds a value to compare with theory. The deviation is relative; where theory is 0, it is the value itself,
 * which the caller has made dimensionless. */
void rg_verify_value(rg_verify_rows *rows, const char *check, double theory, double measured, double limit);

/* Adds two hashes that must be equal: the deviation is 0 or infinite. */
void rg_verify_hash(rg_verify_rows *rows, const char *check, uint64_t expected, uint64_t found);

/* Whether the deviation is within the limit; one that is not a number never is. */
bool rg_verify_holds(const rg_verify_row *row);

/* Prints the head of the table; a row. */
void rg_verify_print_head(FILE *out);
void rg_verify_print(const rg_verify_row *row, FILE *out);

#endif
