/* Results of a test program on any number of ranks, as TAP from rank 0. Include once in a program. */
#ifndef RG_TAP_H
#define RG_TAP_H

#include <mpi.h>
#include <stdbool.h>
#include <stdio.h>

#include "support/figures.h"

static int rank, number, failures;

/* One line of TAP: fine if it is on every rank. */
static void report(bool good, const char *subject, const char *name) {
    int mine = good, all;
    MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_LAND, MPI_COMM_WORLD);
    number++;
    failures += !all;
    if (rank == 0) {
        printf("%s %d - %s: %s\n", all ? "ok" : "not ok", number, subject, name);
    }
}

/* A figure of figures.h, of the rank that found the largest deviation, as a line of TAP. */
static inline void report_figure(const char *subject, figure f) {
    double mine = figure_deviation(&f), most, found;
    mine = isnan(mine) ? INFINITY : mine;
    MPI_Allreduce(&mine, &most, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    double one = mine == most ? f.found : -INFINITY; /* of several such ranks one */
    MPI_Allreduce(&one, &found, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    f.found = found;
    int ranks;
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    if (rank == 0) {
        figure_write(&f, ranks);
        figure_print(&f, stdout);
    }
    report(most <= f.bound, subject, f.quantity);
}

/* Prints the plan, which TAP allows at the end: without it, a program that ends early is seen. The exit
 * status. */
static inline int finish(void) {
    if (rank == 0) {
        printf("1..%d\n", number);
    }
    MPI_Finalize();
    return failures > 0;
}

#endif
