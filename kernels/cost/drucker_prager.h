/* Operations of the Drucker-Prager solid at a point, without a cap, term by term as material/drucker_prager.h
 * has them. */
#ifndef RG_COST_DRUCKER_PRAGER_H
#define RG_COST_DRUCKER_PRAGER_H

#include "cost/hencky.h"
#include "cost/variant.h"

enum {
    DP_STRESS = 3, /* elastic volume; mean and von Mises part */
    DP_AT_REST = HENCKY_STRAIN + DP_STRESS + HENCKY_PIOLA + HENCKY_STIFFENING + 1,
    /* p, q, K/J, 3G/J; over; p and q after it */
    DP_TRIAL = 4 + (HENCKY_FMA + 1) + (1 + HENCKY_FMA + 1 + HENCKY_FMA) + HENCKY_FMA,
    /* dep, dvp; stress after; work; part, Cp^-1; ep, vp */
    DP_FLOW = 4 + 2 + (2 + 1 + HENCKY_FMA + 1) + 1 + HENCKY_FLOW + 2,
    DP_ENERGY = 1 + 1 + 1 + 1 + HENCKY_FMA + 1,
};

/* A step, or at rest. */
static inline double rg_drucker_prager_flops(const rg_cost_variant *v) {
    return DP_AT_REST + (v->advance ? DP_TRIAL : 0) + v->flowing * DP_FLOW;
}

/* Energy alone, or with the stress. */
static inline double rg_drucker_prager_state_flops(const rg_cost_variant *v) {
    return HENCKY_STRAIN + DP_ENERGY + (v->cauchy ? HENCKY_PIOLA + DP_STRESS - 1 : 0);
}

#endif
