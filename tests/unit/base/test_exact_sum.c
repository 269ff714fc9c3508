/* Exact sums over ranks: nothing of what cancels is left, whoever has which part. Prints TAP from rank 0. */
#include <math.h>
#include <mpi.h>
#include <stdint.h>
#include <stdio.h>

#include "base/exact_sum.h"
#include "base/hash.h"
#include "support/tap_memory.h"

enum { COUNT = 20000, SUMS = 2 }; /* samples and their negatives */
#define TINY 0x1p-900

/* Over 2000 binary orders of magnitude. */
static double sample(int i) {
    uint64_t h = rg_hash(11, (uint64_t)i);
    return ldexp(rg_hash_uniform(h) - 0.5, (int)(h % 2000) - 1000);
}

/* Each sample on one rank and its negative on another; besides, 0 to COUNT - 1 times TINY, which is what is
 * left of the first sum. The second one has half of all. */
static void add(rg_exact_sum sum[SUMS], int ranks) {
    for (int i = 0; i < COUNT; i++) {
        if (i % ranks == rank) {
            rg_exact_add(&sum[0], sample(i));
            rg_exact_add(&sum[1], 0.5 * sample(i));
        }
        if ((i / 7 + 1) % ranks == rank) {
            rg_exact_add(&sum[0], -sample(i));
            rg_exact_add(&sum[1], -0.5 * sample(i));
        }
        if (i % 5 % ranks == rank) {
            rg_exact_add(&sum[0], i * TINY);
            rg_exact_add(&sum[1], 0.5 * i * TINY);
        }
    }
}

static void check(bool waits) {
    const char *name = waits ? "not waited for" : "at once";
    int ranks;
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    rg_exact_sum sum[SUMS] = {{{0}, 0, 0}};
    add(sum, ranks);
    if (waits) {
        MPI_Request request;
        rg_exact_start_allreduce(sum, SUMS, MPI_COMM_WORLD, &request);
        MPI_Wait(&request, MPI_STATUS_IGNORE);
    } else {
        rg_exact_allreduce(sum, SUMS, MPI_COMM_WORLD);
    }
    const double theory = 0.5 * COUNT * (COUNT - 1.0) * TINY;
    report_figure(
        name, (figure){"exact sum of 40,000 values of 1e-300 to 1e300 that cancel: what is left, relative",
                       .found = rg_exact_value(&sum[0]) / theory - 1, .bound = 0});
    report(rg_exact_value(&sum[1]) == 0.5 * theory, name, "each sum by itself");
}

static void check_lost_value(void) {
    int ranks;
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    rg_exact_sum sum = {{0}, 0, 0}, part = {{0}, 0, 0};
    rg_exact_add(&part, rank == ranks - 1 ? (double)INFINITY : 1);
    rg_exact_merge(&sum, &part);
    rg_exact_allreduce(&sum, 1, MPI_COMM_WORLD);
    report(isnan(rg_exact_value(&sum)), "not finite", "what one rank adds all know");
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    check(false);
    check(true);
    check_lost_value();
    return finish_with_nothing_left();
}
