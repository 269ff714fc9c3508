/* Exponential functions of vectors of doubles, on top of the logarithm in vec.h. */
#ifndef RG_VEC_MATH_H
#define RG_VEC_MATH_H

#include "vec.h"

/* Natural logarithm to 1 ulp or so; NaN where x is not positive. */
RG_INLINE rg_vec rg_log(rg_vec x) {
    rg_vec excess;
    return rg_log_beside_1(x - 1.0, x, &excess);
}

RG_INLINE rg_vec rg_min(rg_vec a, rg_vec b) {
    return -rg_max(-a, -b);
}

/* exp x = 2^k (1 + p) with x = k log 2 + r, |r| <= log(2)/2 and p = exp(r) - 1 by its Taylor series: the
 * first term left out is 4e-18. x is taken into [-708, 709], where 2^k is a normal number. */
RG_INLINE void rg_exp_parts(rg_vec x, rg_vec *power, rg_vec *p) {
    static const double factorial[] = {1,    1,     2,      6,       24,       120,       720,
                                       5040, 40320, 362880, 3628800, 39916800, 479001600, 6227020800};
    const double shift = 0x1.8p52; /* adding it leaves the integer part in the low bits */
    rg_vec inside = rg_min(rg_max(x, rg_splat(-708.0)), rg_splat(709.0));
    rg_vec shifted = inside * 0x1.71547652b82fep0 + shift, k = shifted - shift;
    rg_vec r = (inside - k * 0x1.62e42fefa3800p-1) - k * 0x1.ef35793c76730p-45;
    rg_vec series = rg_splat(1.0 / factorial[13]);
    for (int n = 12; n >= 2; n--) {
        series = series * r + 1.0 / factorial[n];
    }
    *p = series * (r * r) + r;
    *power = (rg_vec)(((rg_mask)shifted << 52) + (rg_mask)rg_splat(1.0));
}

/* exp x to 1 ulp or so; x beyond [-708, 709] counts as that end, also where x is not a number. */
RG_INLINE rg_vec rg_exp(rg_vec x) {
    rg_vec power, p;
    rg_exp_parts(x, &power, &p);
    return power + power * p;
}

/* exp x - 1 to a few ulp, also where x is small; range as in rg_exp. */
RG_INLINE rg_vec rg_expm1(rg_vec x) {
    rg_vec power, p;
    rg_exp_parts(x, &power, &p);
    return (power - 1.0) + power * p;
}

/* log(1 + x) to a few ulp, also where x is small: the rounding of 1 + x is taken out (W. Kahan). */
RG_INLINE rg_vec rg_log1p(rg_vec x) {
    rg_vec sum = 1.0 + x, kept = sum - 1.0;
    return rg_select(kept == 0.0, x, rg_log(sum) * (x / kept));
}

/* x^y, x > 0. The relative error is that of the exponent, up to 1.5 |y log x| ulp. */
RG_INLINE rg_vec rg_pow(rg_vec x, double y) {
    return rg_exp(y * rg_log(x));
}

#endif
