/* Values of a case file that may be a number or an expression in x, y, z (reference position, m) and t (s).
 */
#ifndef RG_CASE_EXPR_H
#define RG_CASE_EXPR_H

#include <stdbool.h>

#include "case/curve.h"

typedef struct rg_expr rg_expr;

/* What expressions know, as one writes it and in words; the last one is {NULL, NULL}. */
typedef struct {
    const char *write, *meaning;
} rg_expr_word;
extern const rg_expr_word rg_expr_words[];

/* True if text is a decimal number as YAML 1.2 writes it; *integer: without point and exponent. */
bool rg_is_number(const char *text, bool *integer);

/* Expression from its text: a number, or an expression for muParser in x, y, z, t and the constant pi. NULL
 * if it is none; then *message tells why. Free the message with rg_free. */
rg_expr *rg_expr_new(const char *text, char **message);

/* The same of an expression that may call these functions too; keeps a reference to them. */
rg_expr *rg_expr_with(const char *text, const rg_curves *tables, char **message);

/* Another one of the same text, for another thread; NULL for NULL. Free with rg_expr_free. */
rg_expr *rg_expr_copy(const rg_expr *e);
void rg_expr_free(rg_expr *e);

/* True if the text is just a number. */
bool rg_expr_is_number(const rg_expr *e);

/* Expression as its source text, whether it depends on position or on time, and its value. Not thread-safe.
 */
const char *rg_expr_text(const rg_expr *e);
bool rg_expr_uses_position(const rg_expr *e);
bool rg_expr_uses_time(const rg_expr *e);
double rg_expr_value(const rg_expr *e, const double x[3], double t);

/* The same of an expression of faces, which may also use the unit normal nx, ny, nz, of either sign. */
bool rg_expr_uses_normal(const rg_expr *e);
double rg_expr_face_value(const rg_expr *e, const double x[3], const double normal[3]);

#endif
