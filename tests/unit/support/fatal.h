/* The end of a run goes to a test on ranks: where one is expected, rg_fatal keeps its words and jumps to
 * `escape`; any other ends the program. Include once in a program, in place of error.c; FATAL_ONLY: the one
 * status that may be expected. */
#ifndef RG_TEST_FATAL_H
#define RG_TEST_FATAL_H

#include <mpi.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>

#include "base/error.h"

static jmp_buf escape;
static bool expect_fatal;
static int fatal_status;
static char said[1000];

void rg_fatal(int status, const char *format, ...) {
    va_list args;
    va_start(args, format);
    vsnprintf(said, sizeof said, format, args);
    va_end(args);
    bool may_be = expect_fatal;
#ifdef FATAL_ONLY
    may_be = may_be && status == FATAL_ONLY;
#endif
    if (!may_be) {
        printf("Bail out! %s\n", said);
        fflush(stdout);
        MPI_Abort(MPI_COMM_WORLD, 1);
    }
    fatal_status = status;
    longjmp(escape, 1);
}

#endif
