#include "micro/limits.h"

#include "isa.h"
#include "vec.h"

double RG_ISA_NAME(bench_peak)(long rounds, double factor) {
    rg_vec chain[BENCH_CHAINS];
    const rg_vec a = rg_splat(factor), b = rg_splat(1 - factor); /* fixed point 1 */
    for (int k = 0; k < BENCH_CHAINS; k++) {
        chain[k] = rg_splat(1 + 0.01 * k);
    }
    for (long r = 0; r < rounds; r++) {
#pragma GCC unroll 12
        for (int k = 0; k < BENCH_CHAINS; k++) {
            chain[k] = chain[k] * a + b;
        }
    }
    double sum = 0; /* of no use but to keep the loop: it is far from 0 */
    for (int k = 0; k < BENCH_CHAINS; k++) {
        sum += chain[k][0];
    }
    return sum == 0 ? 0 : 2.0 * RG_VLEN * BENCH_CHAINS * (double)rounds;
}

/* a = b + s c; `words` is a multiple of RG_LANES. */
void RG_ISA_NAME(bench_triad)(rg_real *a, const rg_real *b, const rg_real *c, double s, size_t words) {
    for (size_t i = 0; i < words; i += RG_VLEN) {
        rg_store(a + i, rg_load(b + i) + rg_splat(s) * rg_load(c + i));
    }
}
