/* Operations of the Deshpande-Evans ceramic at a point, term by term as material/deshpande_evans.h has them.
 */
#ifndef RG_COST_CERAMIC_H
#define RG_COST_CERAMIC_H

#include "cost/hencky.h"
#include "cost/variant.h"

enum {
    /* y, size, X^2; root; apart; both; c1; c2; A; B; C - A, C; C^2; C^2 - A^2 */
    DE_CRACKS = 3 + 2 + (1 + HENCKY_FMA) + 2 + 2 + (2 + HENCKY_FMA) + 2 * (2 + HENCKY_FMA) + (2 + 1) + 1 + 2,
    /* elastic; losses; slid; open; shared divisor; III: stiffness, mean, mises; limit; II: pull, its rate */
    DE_RESPONSE = 1 + 2 + (2 + HENCKY_FMA) + (HENCKY_FMA + 2 + HENCKY_FMA) + 3 + (3 + 2 + 1) + 2 + 3 + 2,
    DE_STRESS = HENCKY_FMA + 1 + 1 + HENCKY_FMA + (1 + HENCKY_FMA), /* g; III; limit; mean, mises of II */
    DE_DRIVE = 2 + (2 + 1 + HENCKY_FMA + 1),                        /* part of eb^2; III, II */
    DE_TANGENT = HENCKY_FMA,
    DE_STORED = 1 + HENCKY_FMA + 1,

    DE_AT_REST =
        HENCKY_STRAIN + DE_CRACKS + DE_RESPONSE + DE_STRESS + DE_STORED + HENCKY_PIOLA + HENCKY_STIFFENING,

    DE_LOG_RATE = 1 + HENCKY_LOG + 2,
    /* rate; Euler's step; interval, width, ratio, unit */
    DE_START_GROWTH = DE_LOG_RATE + (HENCKY_EXP + 1) + 4 + (1 + (2 + HENCKY_LOG1P + 1) + HENCKY_EXP + 2),
    DE_PANEL = 1 + DE_CRACKS + DE_RESPONSE + (HENCKY_FMA + 1) + DE_DRIVE + DE_LOG_RATE + 2 +
               (HENCKY_EXPM1 + HENCKY_FMA) + 1 + (1 + HENCKY_FMA) + 3,
    /* the panel in which time ends, by small functions; the new stress */
    DE_END_GROWTH = (1 + HENCKY_LOG1P_SMALL + 1) + (1 + 1 + HENCKY_EXPM1_SMALL + HENCKY_FMA) + DE_CRACKS +
                    DE_RESPONSE + DE_STRESS + DE_STORED + 1,

    DE_POWER_LESS_1 = 7 * HENCKY_FMA + 2 + 1, /* small, by Estrin's scheme */
    DE_HARDEN = 1 + HENCKY_POW + 1,
    DE_TRIAL = 2 + HENCKY_LOG + 3,
    DE_LAMBERT = (HENCKY_FMA + 1) + 2 * HENCKY_FMA + 1,
    /* flow before the step; hardness in its middle, softening, w; z, dep, part */
    DE_START_FLOW = HENCKY_EXP + (2 + HENCKY_FMA) + (2 + HENCKY_FMA) + (4 + DE_LAMBERT) + 3 +
                    (HENCKY_EXPM1_SMALL + HENCKY_FMA) + 1,
    DE_TO = 2 + 3 + 1 + DE_STRESS + DE_DRIVE - 2 + DE_TANGENT, /* z, dep; log R; eb; stress */
    DE_RATE = (1 + HENCKY_EXPM1_SMALL + HENCKY_FMA) + (DE_POWER_LESS_1 + HENCKY_FMA), /* R, hardening */
    /* s0; ep + dep, share; rate, harder, relief; bend; g, dg, d2g; z; dep, part */
    DE_HALLEY = 1 + 3 + 4 + (1 + 3 * HENCKY_FMA) + (1 + 3 * HENCKY_FMA) + (6 + HENCKY_FMA) + (2 + 1) +
                (HENCKY_EXPM1_SMALL + 1 + 1),
    DE_END_FLOW = 1 + HENCKY_FLOW + 2 + DE_STORED + 1, /* Cp^-1; ep, eb; energy */
};

/* A step, or at rest. */
static inline double rg_ceramic_flops(const rg_cost_variant *v) {
    double growth = DE_START_GROWTH + v->panels * DE_PANEL + DE_END_GROWTH;
    double flow = DE_START_FLOW + (DE_TO + DE_RATE) + v->newton * (DE_HALLEY + DE_TO + DE_RATE) - DE_RATE +
                  DE_END_FLOW; /* the last iteration has no rate */
    double trial = DE_HARDEN + DE_TRIAL;
    return DE_AT_REST + (v->advance ? DE_DRIVE : 0) + v->growing * growth + v->flowing * (trial + flow);
}

/* Energy alone, or with the stress; the internal variables are not asked for. */
static inline double rg_ceramic_state_flops(const rg_cost_variant *v) {
    return HENCKY_STRAIN + DE_CRACKS + DE_RESPONSE + DE_STRESS + DE_STORED + (v->cauchy ? HENCKY_PIOLA : 0);
}

#endif
