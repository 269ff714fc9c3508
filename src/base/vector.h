/* Vectors of three components. */
#ifndef RG_VECTOR_H
#define RG_VECTOR_H

#include <math.h>

static inline double rg_vector_dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void rg_vector_cross(const double a[3], const double b[3], double out[3]) {
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = a[j] * b[k] - a[k] * b[j];
    }
}

/* out = a - b */
static inline void rg_vector_subtract(const double a[3], const double b[3], double out[3]) {
    for (int i = 0; i < 3; i++) {
        out[i] = a[i] - b[i];
    }
}

/* Square of the distance of two points. */
static inline double rg_vector_distance2(const double a[3], const double b[3]) {
    double d[3];
    rg_vector_subtract(a, b, d);
    return rg_vector_dot(d, d);
}

/* Unit normal of a triangle of corner[9], round which its corners run by the right hand; returns twice its
 * area. */
static inline double rg_vector_normal(const double corner[9], double n[3]) {
    double one[3], two[3];
    rg_vector_subtract(corner + 3, corner, one);
    rg_vector_subtract(corner + 6, corner, two);
    rg_vector_cross(one, two, n);
    double length = sqrt(rg_vector_dot(n, n));
    for (int i = 0; i < 3; i++) {
        n[i] /= length;
    }
    return length;
}

#endif
