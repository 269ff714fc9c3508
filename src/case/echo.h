/* Writing a case as a case file. */
#ifndef RG_CASE_ECHO_H
#define RG_CASE_ECHO_H

#include <stdio.h>

#include "case/case.h"

/* Writes the full set of values used, defaults included, as a YAML case file that reads back to the same
 * case. */
void rg_case_echo(const rg_case *c, FILE *out);

/* The same as case.yaml in the output directory, which keeps an older one until the new one is whole; rank 0.
 * Ends the run with a message on failure. */
void rg_case_write(const rg_case *c, int rank);

#endif
