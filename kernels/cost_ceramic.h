/* Operations of the Deshpande-Evans ceramic at a point, term by term as deshpande_evans.h has them. */
#ifndef RG_COST_CERAMIC_H
#define RG_COST_CERAMIC_H

#include "cost_hencky.h"
#include "cost_model.h"

enum {
    /* y, size, X^2; root; apart; both; c1; c2; A; B; C - A; C; 1/(C^2 - A^2); C^2; E^2; transition */
    DE_CRACKS =
        3 + 2 + (1 + HENCKY_FMA) + 2 + 2 + (2 + HENCKY_FMA) + 2 * (2 + HENCKY_FMA) + 2 + 1 + 3 + 1 + 3 + 2,
    /* elastic parts; compliances; shared divisor; open mean, mises; sliding g; both regimes' stresses */
    DE_STRESS = 3 + 2 * HENCKY_FMA + (1 + 2 * HENCKY_FMA) + 1 + 2 + 1 + 2 + 3 + 1 + (1 + HENCKY_FMA) + 1 + 1 +
                (1 + HENCKY_FMA) + HENCKY_FMA,
    DE_STRESS_AGAIN = 3 + HENCKY_FMA + 1 + HENCKY_FMA, /* von Mises stress at another eb: the rest stays */
    DE_DRIVE = 3 + HENCKY_FMA + 1,
    DE_TANGENT = 1 + HENCKY_FMA + 1,
    DE_STORED = 1 + HENCKY_FMA + 1,

    DE_AT_REST =
        HENCKY_STRAIN + DE_CRACKS + DE_STRESS + DE_DRIVE + DE_STORED + HENCKY_PIOLA + HENCKY_STIFFENING,

    DE_LOG_RATE = 1 + HENCKY_LOG + 2,
    /* rate, explicit step; interval, width, ratio, unit; the panel in which time ends; the new stress */
    DE_GROWTH = DE_LOG_RATE + (HENCKY_EXP + 1) + 4 + (1 + 1 + 2 + HENCKY_LOG1P + 1 + HENCKY_EXP + 2) +
                (1 + HENCKY_LOG1P + 1 + 1 + HENCKY_EXPM1 + 1 + HENCKY_FMA) + DE_CRACKS + DE_STRESS +
                DE_STORED + 1,
    DE_PANEL = 2 + DE_CRACKS + DE_STRESS + DE_DRIVE + DE_LOG_RATE + 2 + 1 + (HENCKY_EXPM1 + 1 + HENCKY_FMA),
    DE_NEXT_PANEL = HENCKY_EXP + 1, /* unit, from the second one on */

    DE_HARDENED = 1 + HENCKY_POW + 1,
    DE_RATE = 3 + 1 + DE_HARDENED + HENCKY_EXP, /* log R; ep + dep; hardening; R */
    DE_NEWTON = 1 + 1 + DE_STRESS_AGAIN + HENCKY_FMA + (3 + HENCKY_FMA + 1 + HENCKY_FMA) + 5,
    DE_MOVE_LAST = 1 + HENCKY_EXPM1_SMALL + 2, /* dep by a small step */
    /* and log R, hardening, R likewise */
    DE_MOVE = DE_MOVE_LAST + 3 + (2 + HENCKY_LOG1P_SMALL) + (1 + HENCKY_EXPM1_SMALL + HENCKY_FMA) +
              (1 + HENCKY_EXPM1_SMALL + HENCKY_FMA),
    /* upper end and start of the iteration; Cp^-1; ep, eb, the new stress */
    DE_FLOW = (DE_HARDENED + 2 + HENCKY_LOG) + 3 + HENCKY_EXP + DE_TANGENT + 3 + (2 + HENCKY_LOG) + DE_RATE +
              (1 + HENCKY_FLOW) + (2 + DE_STRESS_AGAIN + (1 + HENCKY_FMA) + DE_DRIVE + DE_STORED + 1),
};

/* A step, or at rest. */
static inline double rg_ceramic_flops(const rg_cost_variant *v) {
    double growth = DE_GROWTH + v->panels * DE_PANEL + (v->panels > 1 ? v->panels - 1 : 0) * DE_NEXT_PANEL;
    double moves = v->newton > 1 ? (v->newton - 1) * DE_MOVE + DE_MOVE_LAST : v->newton * DE_MOVE_LAST;
    /* the first step is not small */
    double flow = DE_FLOW + v->newton * DE_NEWTON + moves + (v->newton > 0 ? HENCKY_EXP + DE_RATE : 0);
    return DE_AT_REST + v->growing * growth + v->flowing * flow;
}

/* Energy alone, or with the stress; the internal variables are not asked for. */
static inline double rg_ceramic_state_flops(const rg_cost_variant *v) {
    return HENCKY_STRAIN + DE_CRACKS + DE_STRESS + DE_STORED + (v->cauchy ? HENCKY_PIOLA : 0);
}

#endif
