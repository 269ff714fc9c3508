/* Operations of the J2 solid at a point, term by term as material/j2.h has them. */
#ifndef RG_COST_J2_H
#define RG_COST_J2_H

#include "cost/hencky.h"
#include "cost/variant.h"

enum {
    J2_STRESS = 2, /* mean and von Mises part */
    J2_AT_REST = HENCKY_STRAIN + J2_STRESS + HENCKY_PIOLA + HENCKY_STIFFENING,
    J2_YIELD = 1 + HENCKY_FMA,
    J2_LEFT = 1 + HENCKY_EXP + 1, /* only where hardening saturates */
    /* curve; dep; ep, curve, part, von Mises stress, work; for a strain far beyond yield in one step */
    J2_FLOW = J2_YIELD + (1 + HENCKY_FMA + 1) + 1 + J2_YIELD + 1 + HENCKY_FLOW + HENCKY_LONG_SERIES + 2 + 3,
    /* left before and after; the other lower bound */
    J2_SATURATION = 2 * J2_LEFT + 2,
    J2_NEWTON = J2_LEFT + (HENCKY_FMA + 1 + 1 + HENCKY_FMA + 1) + 1 + 1,
    J2_ENERGY = 1 + 1 + 1 + HENCKY_FMA + 1,
};

/* A step, or at rest. */
static inline double rg_j2_flops(const rg_cost_variant *v) {
    double saturation = v->newton > 0 ? J2_SATURATION + v->newton * J2_NEWTON : 0;
    return J2_AT_REST + v->flowing * (J2_FLOW + saturation);
}

/* Energy alone, or with the stress. */
static inline double rg_j2_state_flops(const rg_cost_variant *v) {
    return HENCKY_STRAIN + J2_ENERGY + (v->cauchy ? HENCKY_PIOLA + J2_STRESS : 0);
}

#endif
