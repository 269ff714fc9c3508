#include "base/error.h"

#include <mpi.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

void rg_fatal(int status, const char *format, ...) {
    va_list args;
    va_start(args, format);
    fflush(stdout);
    fputs("rhegma: ", stderr);
    vfprintf(stderr, format, args);
    fputc('\n', stderr);
    fflush(stderr);
    va_end(args);
    int up = 0, down = 0;
    MPI_Initialized(&up);
    MPI_Finalized(&down);
    if (up && !down) {
        int ranks = 1;
        MPI_Comm_size(MPI_COMM_WORLD, &ranks);
        if (ranks > 1) {
            nanosleep(&(struct timespec){.tv_nsec = 100000000},
                      NULL); /* lest the abort overtake the message */
            MPI_Abort(MPI_COMM_WORLD, status);
        }
    }
    _Exit(status);
}

void rg_warn(const char *format, ...) {
    va_list args;
    va_start(args, format);
    fputs("rhegma: warning: ", stderr);
    vfprintf(stderr, format, args);
    fputc('\n', stderr);
    va_end(args);
}
