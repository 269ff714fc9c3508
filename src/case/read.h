/* Reading a case file. */
#ifndef RG_CASE_READ_H
#define RG_CASE_READ_H

#include <stdio.h>

#include "case/case.h"

/* Reads the case file at `path`, applies `overrides` (each "a.b=value", value in YAML syntax) and checks it
 * all. Returns NULL after printing every problem to `errors`, one a line (file:line:column: key: value: what
 * is wrong, the allowed range, the nearest known key); for overrides the place is "--set a.b=value". The
 * caller owns the result and frees it with rg_case_free. Reads nothing but the file, writes nothing but
 * `errors`. */
rg_case *rg_case_read(const char *path, int overrides, const char *const override[], FILE *errors);

/* The bytes of a case file; NULL, with errno, if it cannot be read or is too large to be one. The caller
 * frees them (rg_free). */
char *rg_case_file(const char *path, size_t *size);

/* rg_case_read of a case that is in memory: YAML text[0..size), of the file at `path` in messages. NULL
 * stands for a file that could not be read, for the reason in errno. */
rg_case *rg_case_read_text(const char *path, const char *text, size_t size, int overrides,
                           const char *const override[], FILE *errors);

void rg_case_free(rg_case *c);

#endif
