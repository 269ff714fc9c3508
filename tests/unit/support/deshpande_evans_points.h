/* Arrays of points through the vector functions of kernels/material/deshpande_evans.h and vec_math.h, on
 * every instruction set. Values lie as [block][value][lane], blocks of RG_LANES points. */
#ifndef RG_DESHPANDE_EVANS_POINTS_H
#define RG_DESHPANDE_EVANS_POINTS_H

#include <stddef.h>

#include "layout.h"
#include "material/deshpande_evans_model.h"

enum { POINT_STIFFENING, POINT_ENERGY, POINT_PLASTIC, POINT_DAMAGE, POINT_RESULT };

typedef struct {
    const rg_de_constants *constants;
    const double *F; /* [9] */
    double *history; /* [RG_DE_HISTORY], in/out */
    double *P;       /* out: [9] */
    double *result;  /* out: [POINT_RESULT] */
} points;

typedef enum { MATH_EXP, MATH_EXPM1, MATH_LOG1P, MATH_POW, MATH_FUNCTIONS } math_function;

typedef struct {
    const char *name; /* of the set, as in rg_kernels */
    void (*step)(const points *p, size_t blocks);
    void (*at_rest)(const points *p, size_t blocks);           /* P and POINT_ENERGY alone */
    void (*hencky)(const double *b, double *e, size_t blocks); /* deviator of 1/2 log b, [6] */
    void (*math)(math_function f, double exponent, const double *x, double *y, size_t blocks);
} point_set;

/* All sets this machine can run; returns their number. */
int point_sets(point_set sets[3]);

static inline size_t point_index(size_t point, size_t value, size_t values) {
    return (point / RG_LANES * values + value) * RG_LANES + point % RG_LANES;
}

#endif
