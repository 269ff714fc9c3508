/* Operations of the Holmquist-Johnson-Cook concrete at a point, term by term as
 * material/holmquist_johnson_cook.h has them. */
#ifndef RG_COST_HOLMQUIST_JOHNSON_COOK_H
#define RG_COST_HOLMQUIST_JOHNSON_COOK_H

#include "cost/hencky.h"
#include "cost/johnson_holmquist.h"
#include "cost/variant.h"

enum {
    HJC_PRESS = 2 + (3 + 2 * HENCKY_FMA) + (2 + 2 * HENCKY_FMA), /* x; modulus; pressure */
    HJC_BEGIN = 2 + HJC_PRESS + 1,                               /* T (1 - D); von Mises stress */
    HJC_END = 1 + 2,                                             /* mean; stiffer */
    HJC_AT_REST = HENCKY_STRAIN + HJC_BEGIN + HJC_END + HENCKY_PIOLA + HENCKY_STIFFENING,
    /* mu; a, b and the least that the strength can be; T (1 - D) */
    HJC_QUICK = 1 + (3 + 2 * HENCKY_FMA + 1) + 2,
    HJC_STRENGTH = (1 + HENCKY_POW + 1 + 2 * HENCKY_FMA) +
                   (1 + HENCKY_FMA + 1 + HENCKY_LOG + HENCKY_FMA + 2 + HENCKY_FMA), /* rate */
    HJC_FAILURE = 2 + HENCKY_POW + 1,
    /* over, steep; D, strength after, dep; bounded; stress before; part, Cp^-1; ep, eb; work */
    HJC_FLOW = HJC_FAILURE + (1 + HENCKY_FMA) + (2 + HENCKY_FMA + 2) + 2 + 1 + (1 + HENCKY_FLOW) + 2 + 3 +
               HENCKY_LONG_SERIES,
    /* y, its limit; x; log; two, three; sum */
    HJC_STORED =
        3 + 3 + JH_LOG + (1 + HENCKY_FMA) + (2 * HENCKY_FMA + 2) + (1 + HENCKY_FMA) + (2 * HENCKY_FMA + 2),
    HJC_CURVE = (1 + HENCKY_FMA) + (HENCKY_FMA + 4) + 2,
    /* 1 + m before and after; its curve; work, stored; D */
    HJC_CLOSE = 4 + HJC_CURVE + (HENCKY_LOG + 5 + HENCKY_FMA) + (2 * HJC_STORED + 2) + 1 + HJC_PRESS +
                HJC_FAILURE + 2,
    HJC_ENERGY = 3 + HJC_STORED,
};

/* A step, or at rest; pores close in a share `growing` of the points. */
static inline double rg_holmquist_johnson_cook_flops(const rg_cost_variant *v) {
    return HJC_AT_REST + (v->advance ? HJC_QUICK : 0) + v->flowing * (HJC_STRENGTH + HJC_FLOW) +
           v->growing * HJC_CLOSE;
}

/* Energy alone, or with the stress. Nobody asks for log J and the modulus, nor for the pressure without the
 * stress. */
static inline double rg_holmquist_johnson_cook_state_flops(const rg_cost_variant *v) {
    return HENCKY_STRAIN - HENCKY_LOG + HJC_BEGIN - (3 + 2 * HENCKY_FMA) + HJC_ENERGY +
           (v->cauchy ? HENCKY_PIOLA + 1 : -(4 + 2 * HENCKY_FMA));
}

#endif
