#include "base/exact_sum.h"

#include <math.h>
#include <string.h>

enum { CARRY_EVERY = 1 << 29 };

/* Moves what exceeds 32 bits of a limb into the next, leaving limbs in [0, 2^32) but the last, which keeps
 * the sign. */
static void carry(rg_exact_sum *sum) {
    for (int k = 0; k + 1 < RG_EXACT_LIMBS; k++) {
        int64_t up = sum->limb[k] >> 32;
        sum->limb[k] -= up * (INT64_C(1) << 32);
        sum->limb[k + 1] += up;
    }
    sum->pending = 0;
}

void rg_exact_add(rg_exact_sum *sum, double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    unsigned exponent = (unsigned)(bits >> 52) & 0x7ff;
    uint64_t mantissa = bits & ((UINT64_C(1) << 52) - 1);
    if (exponent == 0x7ff) {
        sum->not_finite++;
        return;
    }
    if (exponent > 0) {
        mantissa |= UINT64_C(1) << 52;
        exponent--;
    }
    unsigned k = exponent / 32, shift = exponent % 32;
    uint64_t low = mantissa << shift, high = shift == 0 ? 0 : mantissa >> (64 - shift);
    int64_t sign = (bits >> 63) != 0 ? -1 : 1;
    sum->limb[k] += sign * (int64_t)(low & 0xffffffffu);
    sum->limb[k + 1] += sign * (int64_t)(low >> 32);
    sum->limb[k + 2] += sign * (int64_t)high;
    if (++sum->pending >= CARRY_EVERY) {
        carry(sum);
    }
}

void rg_exact_merge(rg_exact_sum *sum, const rg_exact_sum *other) {
    for (int k = 0; k < RG_EXACT_LIMBS; k++) {
        sum->limb[k] += other->limb[k]; /* each below 2^61 */
    }
    sum->not_finite += other->not_finite;
    carry(sum);
}

double rg_exact_value(rg_exact_sum *sum) {
    if (sum->not_finite != 0) {
        return NAN;
    }
    carry(sum);
    rg_exact_sum magnitude = *sum;
    double sign = 1;
    if (magnitude.limb[RG_EXACT_LIMBS - 1] < 0) {
        sign = -1;
        for (int k = 0; k < RG_EXACT_LIMBS; k++) {
            magnitude.limb[k] = -magnitude.limb[k];
        }
        carry(&magnitude);
    }
    /* What lies below the three highest limbs, 65 to 96 bits, is less than half an ulp and goes. The bits are
     * the same wherever the same sum is formed, which is what counts here. */
    double value = 0;
    for (int k = RG_EXACT_LIMBS - 1; k >= 0; k--) {
        value += ldexp((double)magnitude.limb[k], 32 * k - 1074);
    }
    return sign * value;
}

void rg_exact_start_allreduce(rg_exact_sum *sums, int count, MPI_Comm comm, MPI_Request *request) {
    for (int i = 0; i < count; i++) {
        carry(&sums[i]);
    }
    MPI_Iallreduce(MPI_IN_PLACE, sums, count * (int)(sizeof *sums / sizeof(int64_t)), MPI_INT64_T, MPI_SUM,
                   comm, request);
}

void rg_exact_allreduce(rg_exact_sum *sums, int count, MPI_Comm comm) {
    for (int i = 0; i < count; i++) {
        carry(&sums[i]);
    }
    MPI_Allreduce(MPI_IN_PLACE, sums, count * (int)(sizeof *sums / sizeof(int64_t)), MPI_INT64_T, MPI_SUM,
                  comm);
}
