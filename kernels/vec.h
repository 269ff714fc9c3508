/* Vectors of reals as wide as the instruction set this file is compiled for, with the operators of C, so
 * that a kernel reads like its equations. A block of RG_LANES lanes is RG_LANES / RG_VLEN vectors.
 *
 * GCC's and Clang's vector types do the arithmetic; intrinsics stand only where the language has no word
 * (maximum, square root). Both refuse to mix a vector of floats with a double that a float does not hold:
 * parameters and constants enter through rg_splat. Arrays of vectors are passed without const: C17 does not
 * convert pointers to arrays. */
#ifndef RG_VEC_H
#define RG_VEC_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "layout.h"

#if defined(__AVX512F__) && defined(__AVX512VL__)
#define RG_VBYTES 64
#elif defined(__AVX2__) && defined(__FMA__)
#define RG_VBYTES 32
#else
#define RG_VBYTES 16
#endif

#if RG_VBYTES > 16
#include <immintrin.h>
#endif

#ifdef RG_SINGLE
typedef int32_t rg_lane_int;
#define RG_VLEN         (RG_VBYTES / 4)
#define RG_INTRINSIC(f) f##ps
#define RG_M512         __m512
#define RG_M256         __m256
#else
typedef int64_t rg_lane_int; /* as large as a real */
#define RG_VLEN         (RG_VBYTES / 8)
#define RG_INTRINSIC(f) f##pd
#define RG_M512         __m512d
#define RG_M256         __m256d
#endif

typedef rg_real rg_vec __attribute__((vector_size(RG_VBYTES)));
typedef rg_lane_int rg_mask __attribute__((vector_size(RG_VBYTES))); /* a lane is all ones or all zeros */

#define RG_INLINE static inline __attribute__((always_inline))

RG_INLINE rg_vec rg_splat(double x) {
    return (rg_real)x - (rg_vec){0};
}

RG_INLINE rg_vec rg_load(const rg_real *p) {
    return *(const rg_vec *)(const void *)p;
}

RG_INLINE void rg_store(rg_real *p, rg_vec x) {
    *(rg_vec *)(void *)p = x;
}

/* Stores what is summed or written out: as doubles. */
RG_INLINE void rg_store_wide(double *p, rg_vec x) {
    typedef double wide __attribute__((vector_size(RG_VLEN * sizeof(double))));
    wide d = __builtin_convertvector(x, wide);
    memcpy(p, &d, sizeof d);
}

/* One address per lane. A gather is one plain load per lane, free of the microcode penalty that the gather
 * instruction carries on many Intel processors. */
typedef struct {
    const rg_real *lane[RG_VLEN];
} rg_lanes;

/* Value k behind each lane's address. */
RG_INLINE rg_vec rg_gather(const rg_lanes *p, int k) {
#define RG_AT(l) p->lane[l][k]
#if RG_VLEN == 16
    return (rg_vec){RG_AT(0), RG_AT(1), RG_AT(2),  RG_AT(3),  RG_AT(4),  RG_AT(5),  RG_AT(6),  RG_AT(7),
                    RG_AT(8), RG_AT(9), RG_AT(10), RG_AT(11), RG_AT(12), RG_AT(13), RG_AT(14), RG_AT(15)};
#elif RG_VLEN == 8
    return (rg_vec){RG_AT(0), RG_AT(1), RG_AT(2), RG_AT(3), RG_AT(4), RG_AT(5), RG_AT(6), RG_AT(7)};
#elif RG_VLEN == 4
    return (rg_vec){RG_AT(0), RG_AT(1), RG_AT(2), RG_AT(3)};
#else
    return (rg_vec){RG_AT(0), RG_AT(1)};
#endif
#undef RG_AT
}

/* ---- Rows: values of one lane side by side in memory ---- */

/* Rows are moved in pieces of RG_PIECE values, one vector each; where a vector has room for two pieces (16
 * floats) it holds that of a lane in its lower half and that of the lane eight further in its upper half. */
#define RG_PIECE (RG_VLEN < 8 ? RG_VLEN : 8)

typedef rg_real rg_piece __attribute__((vector_size(RG_PIECE * sizeof(rg_real))));

/* Square transpose, of both halves where there are two: r[i][l] <-> r[l][i], by pairs, quads and halves. */
#if RG_VLEN == 16
#define RG_SHUFFLE(a, b, i0, i1, i2, i3, i4, i5, i6, i7)                                                     \
    __builtin_shufflevector(a, b, (i0) + ((i0)&8), (i1) + ((i1)&8), (i2) + ((i2)&8), (i3) + ((i3)&8),        \
                            (i4) + ((i4)&8), (i5) + ((i5)&8), (i6) + ((i6)&8), (i7) + ((i7)&8),              \
                            (i0) + ((i0)&8) + 8, (i1) + ((i1)&8) + 8, (i2) + ((i2)&8) + 8,                   \
                            (i3) + ((i3)&8) + 8, (i4) + ((i4)&8) + 8, (i5) + ((i5)&8) + 8,                   \
                            (i6) + ((i6)&8) + 8, (i7) + ((i7)&8) + 8)
#else
#define RG_SHUFFLE __builtin_shufflevector
#endif

RG_INLINE void rg_transpose(rg_vec r[RG_PIECE]) {
    rg_vec t[RG_PIECE];
#if RG_VLEN >= 8
    rg_vec s[RG_PIECE];
    for (int i = 0; i < 8; i += 2) {
        t[i] = RG_SHUFFLE(r[i], r[i + 1], 0, 8, 2, 10, 4, 12, 6, 14);
        t[i + 1] = RG_SHUFFLE(r[i], r[i + 1], 1, 9, 3, 11, 5, 13, 7, 15);
    }
    for (int h = 0; h < 8; h += 4) {
        for (int i = h; i < h + 2; i++) {
            s[i] = RG_SHUFFLE(t[i], t[i + 2], 0, 1, 8, 9, 4, 5, 12, 13);
            s[i + 2] = RG_SHUFFLE(t[i], t[i + 2], 2, 3, 10, 11, 6, 7, 14, 15);
        }
    }
    for (int i = 0; i < 4; i++) {
        r[i] = RG_SHUFFLE(s[i], s[i + 4], 0, 1, 2, 3, 8, 9, 10, 11);
        r[i + 4] = RG_SHUFFLE(s[i], s[i + 4], 4, 5, 6, 7, 12, 13, 14, 15);
    }
#elif RG_VLEN == 4
    for (int i = 0; i < 4; i += 2) {
        t[i] = __builtin_shufflevector(r[i], r[i + 1], 0, 4, 2, 6);
        t[i + 1] = __builtin_shufflevector(r[i], r[i + 1], 1, 5, 3, 7);
    }
    for (int i = 0; i < 2; i++) {
        r[i] = __builtin_shufflevector(t[i], t[i + 2], 0, 1, 4, 5);
        r[i + 2] = __builtin_shufflevector(t[i], t[i + 2], 2, 3, 6, 7);
    }
#else
    t[0] = (rg_vec){r[0][0], r[1][0]};
    t[1] = (rg_vec){r[0][1], r[1][1]};
    r[0] = t[0];
    r[1] = t[1];
#endif
}

/* The piece at lane[l] and, in the upper half, the one at lane[l + 8]. */
RG_INLINE rg_vec rg_load_piece(const rg_lanes *row, int l, int at) {
    rg_piece low;
    memcpy(&low, row->lane[l] + at, sizeof low);
#if RG_VLEN == 16
    rg_piece high;
    memcpy(&high, row->lane[l + 8] + at, sizeof high);
    return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
#else
    return low;
#endif
}

RG_INLINE void rg_store_piece(rg_real *row, int stride, int l, int at, rg_vec r) {
#if RG_VLEN == 16
    rg_piece low = __builtin_shufflevector(r, r, 0, 1, 2, 3, 4, 5, 6, 7);
    rg_piece high = __builtin_shufflevector(r, r, 8, 9, 10, 11, 12, 13, 14, 15);
    memcpy(row + (l + 8) * stride + at, &high, sizeof high);
#else
    rg_piece low = r;
#endif
    memcpy(row + l * stride + at, &low, sizeof low);
}

/* out[k] = value k of each lane's row, k < count, count >= RG_PIECE. Whole pieces of a row are loaded and
 * transposed: a row is two or three cache lines, where one value per line would be as many lines as values.
 */
RG_INLINE void rg_load_rows(const rg_lanes *row, int count, rg_vec out[]) {
    for (int k = 0; k < count; k += RG_PIECE) {
        int at = k + RG_PIECE <= count ? k : count - RG_PIECE; /* the last ones overlap */
        rg_vec r[RG_PIECE];
        for (int l = 0; l < RG_PIECE; l++) {
            r[l] = rg_load_piece(row, l, at);
        }
        rg_transpose(r);
        for (int i = 0; i < RG_PIECE; i++) {
            out[at + i] = r[i];
        }
    }
}

/* The converse: rows of `count` values, `stride` apart, one per lane. */
RG_INLINE void rg_store_rows(rg_real *row, int stride, int count, const rg_vec in[]) {
    for (int k = 0; k < count; k += RG_PIECE) {
        int at = k + RG_PIECE <= count ? k : count - RG_PIECE;
        rg_vec r[RG_PIECE];
        for (int i = 0; i < RG_PIECE; i++) {
            r[i] = in[at + i];
        }
        rg_transpose(r);
        for (int l = 0; l < RG_PIECE; l++) {
            rg_store_piece(row, stride, l, at, r[l]);
        }
    }
}

RG_INLINE rg_vec rg_select(rg_mask m, rg_vec yes, rg_vec no) {
    return (rg_vec)((m & (rg_mask)yes) | (~m & (rg_mask)no));
}

/* The larger and the smaller one; the second where either is not a number. */
#if RG_VBYTES == 64
RG_INLINE rg_vec rg_max(rg_vec a, rg_vec b) {
    return (rg_vec)RG_INTRINSIC(_mm512_max_)((RG_M512)a, (RG_M512)b);
}

RG_INLINE rg_vec rg_min(rg_vec a, rg_vec b) {
    return (rg_vec)RG_INTRINSIC(_mm512_min_)((RG_M512)a, (RG_M512)b);
}
#elif RG_VBYTES == 32
RG_INLINE rg_vec rg_max(rg_vec a, rg_vec b) {
    return (rg_vec)RG_INTRINSIC(_mm256_max_)((RG_M256)a, (RG_M256)b);
}

RG_INLINE rg_vec rg_min(rg_vec a, rg_vec b) {
    return (rg_vec)RG_INTRINSIC(_mm256_min_)((RG_M256)a, (RG_M256)b);
}
#else
RG_INLINE rg_vec rg_max(rg_vec a, rg_vec b) {
    return rg_select(a > b, a, b);
}

RG_INLINE rg_vec rg_min(rg_vec a, rg_vec b) {
    return rg_select(a < b, a, b);
}
#endif

RG_INLINE rg_vec rg_abs(rg_vec a) {
    const rg_lane_int no_sign = sizeof(rg_real) == 8 ? (rg_lane_int)INT64_MAX : INT32_MAX;
    return (rg_vec)((rg_mask)a & no_sign);
}

RG_INLINE rg_vec rg_sqrt(rg_vec a) {
#if RG_VBYTES == 64
    return (rg_vec)RG_INTRINSIC(_mm512_sqrt_)((RG_M512)a);
#elif RG_VBYTES == 32
    return (rg_vec)RG_INTRINSIC(_mm256_sqrt_)((RG_M256)a);
#else
    for (int l = 0; l < RG_VLEN; l++) { /* rounds once, also through double */
        a[l] = (rg_real)__builtin_sqrt(a[l]);
    }
    return a;
#endif
}

RG_INLINE bool rg_any(rg_mask m) {
#if RG_VBYTES == 64
    return _mm512_test_epi64_mask((__m512i)m, (__m512i)m) != 0;
#elif RG_VBYTES == 32
    return !_mm256_testz_si256((__m256i)m, (__m256i)m);
#else
    rg_lane_int any = 0;
    for (int l = 0; l < RG_VLEN; l++) {
        any |= m[l];
    }
    return any != 0;
#endif
}

RG_INLINE rg_vec rg_dot(const rg_vec a[3], const rg_vec b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

RG_INLINE void rg_cross(const rg_vec a[3], const rg_vec b[3], rg_vec out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* Bits of numbers and what splits 2^e m: in a real, `unit` counts ones in its low bits. */
#ifdef RG_SINGLE
enum { RG_MANTISSA = 23, RG_LOG_LAST = 9 };
#define RG_SQRT_HALF 0x3f3504f3
#define RG_UNIT_BITS 0x4b400000
#define RG_UNIT      0x1.8p23
#define RG_LOG2_HIGH 0x1.63p-1
#define RG_LOG2_LOW  -2.1219444005469058e-4
#else
enum { RG_MANTISSA = 52, RG_LOG_LAST = 21 };
#define RG_SQRT_HALF INT64_C(0x3fe6a09e667f3bcd)
#define RG_UNIT_BITS INT64_C(0x4338000000000000)
#define RG_UNIT      0x1.8p52
#define RG_LOG2_HIGH 0x1.62e42fefa3800p-1
#define RG_LOG2_LOW  0x1.ef35793c76730p-45
#endif

/* log x for x = 1 + y, y > -1, and y - log x, both to an ulp or so of themselves however small y is; NaN
 * where x is not positive. With x = 2^e m, m in [sqrt(1/2), sqrt 2): log x = e log 2 + 2 artanh s,
 * s = (m - 1)/(m + 1); and t - 2 s = s t for s = t/(2 + t). */
RG_INLINE rg_vec rg_log_beside_1(rg_vec y, rg_vec x, rg_vec *y_less_log) {
    rg_mask bits = (rg_mask)rg_abs(x); /* with the sign the next line could overflow */
    rg_mask e = (bits - ((rg_mask){0} + RG_SQRT_HALF)) >> RG_MANTISSA;
    rg_vec m = (rg_vec)(bits - (e << RG_MANTISSA));
    rg_vec k = (rg_vec)(e + ((rg_mask){0} + RG_UNIT_BITS)) - rg_splat(RG_UNIT);
    rg_vec t = rg_select(e == 0, y, m - 1.0);
    rg_vec s = t / (t + 2.0), z = s * s;
    rg_vec p = rg_splat(2.0 / RG_LOG_LAST);
    for (int n = RG_LOG_LAST - 2; n >= 3; n -= 2) {
        p = p * z + rg_splat(2.0 / n);
    }
    rg_vec tail = s * (z * p), nan = rg_splat(__builtin_nan(""));
    rg_vec log = k * rg_splat(RG_LOG2_HIGH) + (2.0 * s + (tail + k * rg_splat(RG_LOG2_LOW)));
    *y_less_log = rg_select(e == 0, s * t - tail, y - log);
    return rg_select(x > 0.0, log, nan);
}

/* First value of element or interface `number` in a field of `block` values per block. Unsigned, so that
 * divisions are shifts. */
RG_INLINE const rg_real *rg_first_value(const rg_real *field, uint32_t number, size_t block) {
    return field + (number / RG_LANES) * block + number % RG_LANES;
}

#endif
