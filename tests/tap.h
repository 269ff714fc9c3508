/* Results of a test program on any number of ranks, as TAP from rank 0. Include once in a program. */
#ifndef RG_TAP_H
#define RG_TAP_H

#include <mpi.h>
#include <stdbool.h>
#include <stdio.h>

static int rank, number, failures;

/* One line of TAP: fine if it is on every rank. */
static void report(bool good, const char *mesh, const char *name) {
    int mine = good, all;
    MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_LAND, MPI_COMM_WORLD);
    number++;
    failures += !all;
    if (rank == 0) {
        printf("%s %d - %s: %s\n", all ? "ok" : "not ok", number, mesh, name);
    }
}

#endif
