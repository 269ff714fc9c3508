/* Operations of the Johnson-Cook metal at a point, term by term as material/johnson_cook.h has them. */
#ifndef RG_COST_JOHNSON_COOK_H
#define RG_COST_JOHNSON_COOK_H

#include "cost/hencky.h"
#include "cost/variant.h"

enum {
    JC_STRESS = 2, /* mean and von Mises part */
    JC_AT_REST = HENCKY_STRAIN + JC_STRESS + HENCKY_PIOLA + HENCKY_STIFFENING,
    JC_HARD = HENCKY_POW + 1,
    JC_RATE = HENCKY_FMA, /* 1 + C max(0, z) */
    /* T*, 1 - T*^m; A + B ep^n; over; x; z; rate; B (ep + x)^n */
    JC_START =
        (1 + HENCKY_POW + 1) + (JC_HARD + 1) + HENCKY_FMA + 1 + (1 + HENCKY_LOG) + JC_RATE + (1 + JC_HARD),
    /* curve, flow; over; slope; step, z; x; rate; B (ep + x)^n */
    JC_NEWTON =
        2 + 2 * HENCKY_FMA + (5 + HENCKY_FMA - 1) + (2 + 1) + 2 + (HENCKY_EXP + 1) + JC_RATE + (1 + JC_HARD),
    /* work; part; Cp^-1; ep, heat; von Mises stress */
    JC_RETURN = 6 + 1 + HENCKY_FLOW + HENCKY_LONG_SERIES + 1 + HENCKY_FMA + 2,
    JC_ENERGY = 1 + 1 + 1 + HENCKY_FMA + 1,
};

/* A step, or at rest. */
static inline double rg_johnson_cook_flops(const rg_cost_variant *v) {
    return JC_AT_REST + v->flowing * (JC_START + v->newton * JC_NEWTON + JC_RETURN);
}

/* Energy alone, or with the stress. */
static inline double rg_johnson_cook_state_flops(const rg_cost_variant *v) {
    return HENCKY_STRAIN + JC_ENERGY + (v->cauchy ? HENCKY_PIOLA + JC_STRESS : 0);
}

#endif
