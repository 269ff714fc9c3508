/* Exact sums of doubles: the same bits in any order, on any number of ranks and threads.
 *
 * A double is an integer times 2^-1074; the accumulator holds the sum as such an integer, in 64-bit limbs
 * that each carry 32 bits and have the rest as room for carries (a small superaccumulator, after Kulisch;
 * Neal, arXiv 1505.05571). */
#ifndef RG_EXACT_SUM_H
#define RG_EXACT_SUM_H

#include <mpi.h>
#include <stddef.h>
#include <stdint.h>

enum { RG_EXACT_LIMBS = 68 };

typedef struct {
    int64_t limb[RG_EXACT_LIMBS]; /* limb k counts units of 2^(32 k - 1074) */
    int64_t pending;              /* additions since the carries were last moved up */
    int64_t not_finite;           /* number of addends that were infinite or not a number */
} rg_exact_sum;

/* Adds x. Start from {0}. */
void rg_exact_add(rg_exact_sum *sum, double x);

/* Adds another sum. */
void rg_exact_merge(rg_exact_sum *sum, const rg_exact_sum *other);

/* The sum, right to an ulp; NaN if an addend was not finite. */
double rg_exact_value(rg_exact_sum *sum);

/* Collective: replaces sums[count] by their totals over the ranks. */
void rg_exact_allreduce(rg_exact_sum *sums, int count, MPI_Comm comm);

/* The same, under way when it returns: `sums` is the library's until `request` is done. */
void rg_exact_start_allreduce(rg_exact_sum *sums, int count, MPI_Comm comm, MPI_Request *request);

#endif
