/* Operations of the Johnson-Holmquist ceramic at a point, term by term as material/johnson_holmquist.h has
 * them. */
#ifndef RG_COST_JOHNSON_HOLMQUIST_H
#define RG_COST_JOHNSON_HOLMQUIST_H

#include "cost/hencky.h"
#include "cost/variant.h"

enum {
    /* T (1 - D); mu; modulus, pressure; von Mises stress */
    JH_BEGIN = 2 + 1 + 2 * HENCKY_FMA + (2 + 2 * HENCKY_FMA + 1) + 1,
    JH_END = 1 + 2, /* mean; stiffer */
    JH_AT_REST = HENCKY_STRAIN + JH_BEGIN + JH_END + HENCKY_PIOLA + HENCKY_STIFFENING,
    JH_QUICK = 2 + 1 + 3, /* p* + T*; the least that the strength can be */
    /* intact, crushed, that of the step; rate */
    JH_STRENGTH = (HENCKY_POW + 2) + (1 + HENCKY_POW + 1 + 1) + (1 + HENCKY_FMA) +
                  (HENCKY_FMA + 1 + 1 + HENCKY_LOG + HENCKY_FMA + 3),
    JH_LOG = 4 + 9 * HENCKY_FMA + 1 + 8, /* beside 1: s, z; series; k; sum */
    /* J at the limit; mu; log; two, three; sum */
    JH_STORED = (2 + HENCKY_FMA) + 3 + JH_LOG + (1 + HENCKY_FMA) + (2 * HENCKY_FMA + 2) + (1 + HENCKY_FMA) +
                (5 * HENCKY_FMA + 1),
    /* ef; falls; D; strength after, dep; stress before; dU; bulking; T (1 - D); stored before and after;
     * work; part, Cp^-1; ep, eb, p */
    JH_FLOW = (HENCKY_POW + 1) + (2 + HENCKY_FMA) + 2 + (HENCKY_FMA + 2) + 1 + 4 +
              (1 + HENCKY_FMA + 1 + HENCKY_FMA + 3) + 2 + (2 * JH_STORED + 1) + 3 + 1 + HENCKY_FLOW + 1 + 1 +
              2,
    JH_ENERGY = 2 + JH_STORED,
};

/* A step, or at rest. */
static inline double rg_johnson_holmquist_flops(const rg_cost_variant *v) {
    return JH_AT_REST + (v->advance ? JH_QUICK : 0) + v->flowing * (JH_STRENGTH + JH_FLOW);
}

/* Energy alone, or with the stress. Nobody asks for log J and the modulus, nor for the pressure without the
 * stress. */
static inline double rg_johnson_holmquist_state_flops(const rg_cost_variant *v) {
    return HENCKY_STRAIN - HENCKY_LOG + JH_BEGIN - 2 * HENCKY_FMA + JH_ENERGY +
           (v->cauchy ? HENCKY_PIOLA + 1 : -(2 + 2 * HENCKY_FMA + 1));
}

#endif
