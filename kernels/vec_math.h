/* Exponential functions of vectors, on top of the logarithm in vec.h. */
#ifndef RG_VEC_MATH_H
#define RG_VEC_MATH_H

#include "vec.h"

/* c[0] + c[1] x + ... + c[n - 1] x^(n - 1), n <= 16, by Estrin's scheme: the materials that need it wait for
 * results, not for arithmetic, and its chain is log2(n) operations long instead of Horner's n. */
RG_INLINE rg_vec rg_polynomial(const double c[], int n, rg_vec x) {
    rg_vec part[8], power = x;
    for (int i = 0; i < n / 2; i++) {
        part[i] = rg_splat(c[2 * i + 1]) * x + rg_splat(c[2 * i]);
    }
    if (n % 2 == 1) {
        part[n / 2] = rg_splat(c[n - 1]);
    }
    for (int left = (n + 1) / 2; left > 1; left = (left + 1) / 2) {
        power *= power;
        for (int i = 0; i < left / 2; i++) {
            part[i] = part[2 * i + 1] * power + part[2 * i];
        }
        if (left % 2 == 1) {
            part[left / 2] = part[left - 1];
        }
    }
    return part[0];
}

/* Natural logarithm to 1 ulp or so; NaN where x is not positive. As in rg_log_beside_1. */
RG_INLINE rg_vec rg_log(rg_vec x) {
    static const double c[] = {2.0 / 3,  2.0 / 5,  2.0 / 7,  2.0 / 9,  2.0 / 11,
                               2.0 / 13, 2.0 / 15, 2.0 / 17, 2.0 / 19, 2.0 / 21};
    rg_mask bits = (rg_mask)rg_abs(x);
    rg_mask e = (bits - ((rg_mask){0} + RG_SQRT_HALF)) >> RG_MANTISSA;
    rg_vec m = (rg_vec)(bits - (e << RG_MANTISSA));
    rg_vec k = (rg_vec)(e + ((rg_mask){0} + RG_UNIT_BITS)) - rg_splat(RG_UNIT);
    rg_vec t = m - 1.0, s = t / (t + 2.0), z = s * s;
    rg_vec tail = s * (z * rg_polynomial(c, 10, z));
    rg_vec log = k * rg_splat(RG_LOG2_HIGH) + (2.0 * s + (tail + k * rg_splat(RG_LOG2_LOW)));
    return rg_select(x > 0.0, log, rg_splat(__builtin_nan("")));
}

#ifdef RG_SINGLE
enum { RG_EXP_TERMS = 7 };
#define RG_EXP_LOW  -87.0
#define RG_EXP_HIGH 88.0
#else
enum { RG_EXP_TERMS = 12 };
#define RG_EXP_LOW  -708.0
#define RG_EXP_HIGH 709.0
#endif

/* exp x = 2^k (1 + p) with x = k log 2 + r, |r| <= log(2)/2 and p = exp(r) - 1 by its Taylor series: the
 * first term left out is 4e-18 (single: 2e-10). x is taken into [RG_EXP_LOW, RG_EXP_HIGH], where 2^k is a
 * normal number. */
RG_INLINE void rg_exp_parts(rg_vec x, rg_vec *power, rg_vec *p) {
    static const double c[] = {1.0 / 2,       1.0 / 6,        1.0 / 24,        1.0 / 120,
                               1.0 / 720,     1.0 / 5040,     1.0 / 40320,     1.0 / 362880,
                               1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800};
    const rg_vec shift = rg_splat(RG_UNIT); /* adding it leaves the integer part in the low bits */
    rg_vec inside = rg_min(rg_max(x, rg_splat(RG_EXP_LOW)), rg_splat(RG_EXP_HIGH));
    rg_vec shifted = inside * rg_splat(0x1.71547652b82fep0) + shift, k = shifted - shift;
    rg_vec r = (inside - k * rg_splat(RG_LOG2_HIGH)) - k * rg_splat(RG_LOG2_LOW);
    *p = rg_polynomial(c, RG_EXP_TERMS, r) * (r * r) + r;
    *power = (rg_vec)(((rg_mask)shifted << RG_MANTISSA) + (rg_mask)rg_splat(1.0));
}

/* exp x to 1 ulp or so; x beyond [RG_EXP_LOW, RG_EXP_HIGH] counts as that end, also where x is not a number.
 */
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

/* exp x, and exp x - 1 to a few ulp; range as in rg_exp. */
RG_INLINE rg_vec rg_exp_and_less_1(rg_vec x, rg_vec *less_1) {
    rg_vec power, p;
    rg_exp_parts(x, &power, &p);
    *less_1 = (power - 1.0) + power * p;
    return power + power * p;
}

#define RG_SMALL 0.01 /* where one polynomial does for these two */

/* exp x - 1, |x| <= RG_SMALL: the first term left out is 2e-16 of the sum. */
RG_INLINE rg_vec rg_expm1_small(rg_vec x) {
    static const double c[] = {1.0 / 2, 1.0 / 6, 1.0 / 24, 1.0 / 120, 1.0 / 720};
    return rg_polynomial(c, 5, x) * (x * x) + x;
}

/* log(1 + x), |x| <= RG_SMALL + RG_SMALL^2, likewise: as rg_log without its exponent. */
RG_INLINE rg_vec rg_log1p_small(rg_vec x) {
    static const double c[] = {2.0 / 3, 2.0 / 5, 2.0 / 7};
    rg_vec s = x / (x + 2.0), z = s * s;
    return s * (z * rg_polynomial(c, 3, z)) + 2.0 * s;
}

/* log(1 + x) to a few ulp, also where x is small: the rounding of 1 + x is taken out (W. Kahan). */
RG_INLINE rg_vec rg_log1p(rg_vec x) {
    rg_vec sum = 1.0 + x, kept = sum - 1.0;
    return rg_select(kept == 0.0, x, rg_log(sum) * (x / kept));
}

/* x^y, x > 0. The relative error is that of the exponent, up to 1.5 |y log x| ulp. */
RG_INLINE rg_vec rg_pow(rg_vec x, double y) {
    return rg_exp(rg_splat(y) * rg_log(x));
}

#endif
