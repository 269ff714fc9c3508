/* Making and freeing the expressions of a case file. */
#ifndef RG_CASE_EXPR_H
#define RG_CASE_EXPR_H

#include "case.h"

/* True if text is a decimal number as YAML 1.2 writes it; *integer: without point and exponent. */
bool rg_is_number(const char *text, bool *integer);

/* Expression from its text: a number, or an expression for muParser in x, y, z, t and the constant pi. NULL
 * if it is none; then *message tells why. Free the message with rg_free. */
rg_expr *rg_expr_new(const char *text, char **message);

/* True if the text is just a number. */
bool rg_expr_is_number(const rg_expr *e);

#endif
