/* Vectors of doubles, whatever the precision of this build: contact subtracts positions. */
#ifndef RG_CONTACT_WIDE_H
#define RG_CONTACT_WIDE_H

#include "vec.h"

typedef double wide __attribute__((vector_size(RG_VBYTES)));
typedef int64_t wide_mask __attribute__((vector_size(RG_VBYTES))); /* a lane is all ones or all zeros */

enum { WIDE = RG_VBYTES / (int)sizeof(double) };

RG_INLINE wide wide_splat(double x) {
    return x - (wide){0};
}

RG_INLINE wide wide_select(wide_mask m, wide yes, wide no) {
    return (wide)((m & (wide_mask)yes) | (~m & (wide_mask)no));
}

/* x where m holds, else 0. */
RG_INLINE wide wide_where(wide_mask m, wide x) {
    return (wide)(m & (wide_mask)x);
}

RG_INLINE wide wide_abs(wide x) {
    return (wide)((wide_mask)x & INT64_MAX);
}

RG_INLINE wide wide_sqrt(wide x) {
    for (int l = 0; l < WIDE; l++) {
        x[l] = __builtin_sqrt(x[l]);
    }
    return x;
}

RG_INLINE bool wide_any(wide_mask m) {
    int64_t any = 0;
    for (int l = 0; l < WIDE; l++) {
        any |= m[l];
    }
    return any != 0;
}

RG_INLINE wide wide_dot(const wide a[3], const wide b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

RG_INLINE void wide_cross(const wide a[3], const wide b[3], wide out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

RG_INLINE void wide_minus(const wide a[3], const wide b[3], wide out[3]) {
    for (int c = 0; c < 3; c++) {
        out[c] = a[c] - b[c];
    }
}

#endif
