/* Operations of the Deshpande-Evans ceramic at a point, term by term as deshpande_evans.h has them. */
#ifndef RG_COST_CERAMIC_H
#define RG_COST_CERAMIC_H

#include "cost_model.h"

enum {
    DE_FMA = 2,
    DE_DOT = 5,
    DE_COAXIAL = 6 * DE_DOT,          /* product of coaxial symmetric tensors */
    DE_SYM_DOT = 2 * DE_DOT + DE_FMA, /* full contraction */
    DE_CONGRUENCE = 15 * DE_DOT,      /* G S, then six entries of (G S) G^T */
    /* polynomials by Estrin's scheme: FMAs of all levels and squares of x between them */
    DE_LOG_SERIES = 9 * DE_FMA + 3,
    DE_EXP_SERIES = 11 * DE_FMA + 3,
    DE_LOG = 4 + DE_LOG_SERIES + 2 + 1 + 3 * DE_FMA,                     /* s, z; tail, k, sum */
    DE_EXP_PARTS = DE_FMA + 1 + 2 * DE_FMA + DE_EXP_SERIES + 1 + DE_FMA, /* k, r; r^2, p */
    DE_EXP = DE_EXP_PARTS + DE_FMA,
    DE_EXPM1 = DE_EXP_PARTS + 1 + DE_FMA,
    DE_LOG1P = DE_LOG + 4,
    DE_POW = DE_LOG + 1 + DE_EXP,

    DE_INVARIANTS = 3 + (DE_SYM_DOT + 1), /* q, r of a symmetric tensor with trace 0 */
    /* x; x^2, q, r; six determinants and their sums; one division; three products; e' */
    DE_HENCKY = 3 + (3 * DE_FMA + 3) + DE_COAXIAL + DE_INVARIANTS + 3 * (4 * DE_FMA + 1 + 2 + 1 + DE_FMA) +
                3 + 3 * (1 + 2 * DE_FMA) + 2 + (1 + 3 * (1 + 1 + DE_FMA) + 3 * (1 + DE_FMA)),
    /* F, Cp^-1, cofactors, J and its inverse, b, log b, log J, eb */
    DE_STRAIN = 3 + 3 + 27 + DE_DOT + 1 + DE_CONGRUENCE + DE_HENCKY + DE_LOG + DE_SYM_DOT + 2,
    /* y, size, X^2; root; apart; both; c1; c2; A; B; C - A; C; 1/(C^2 - A^2); C^2; E^2; transition */
    DE_CRACKS = 3 + 2 + (1 + DE_FMA) + 2 + 2 + (2 + DE_FMA) + 2 * (2 + DE_FMA) + 2 + 1 + 3 + 1 + 3 + 2,
    /* elastic parts; compliances; shared divisor; open mean, mises; sliding g; both regimes' stresses */
    DE_STRESS = 3 + 2 * DE_FMA + (1 + 2 * DE_FMA) + 1 + 2 + 1 + 2 + 3 + 1 + (1 + DE_FMA) + 1 + 1 +
                (1 + DE_FMA) + DE_FMA,
    DE_STRESS_AGAIN = 3 + DE_FMA + 1 + DE_FMA, /* von Mises stress at another eb: the rest stays */
    DE_DRIVE = 3 + DE_FMA + 1,
    DE_TANGENT = 1 + DE_FMA + 1,
    DE_STORED = 1 + DE_FMA + 1,
    DE_PIOLA = 2 + 6 * (DE_FMA + 1) + 9 * DE_DOT,
    /* cof^T cof, row sums, norm; pressure, deviator and spread; bound and guards */
    DE_STIFFENING = 6 * DE_DOT + 9 + 2 + (DE_FMA + 1 + DE_FMA) + (DE_FMA + 1) + (1 + DE_FMA),

    DE_AT_REST = DE_STRAIN + DE_CRACKS + DE_STRESS + DE_DRIVE + DE_STORED + DE_PIOLA + DE_STIFFENING,

    DE_LOG_RATE = 1 + DE_LOG + 2,
    /* rate, explicit step; interval, width, ratio, unit; the panel in which time ends; the new stress */
    DE_GROWTH = DE_LOG_RATE + (DE_EXP + 1) + 4 + (1 + 1 + 2 + DE_LOG1P + 1 + DE_EXP + 2) +
                (1 + DE_LOG1P + 1 + 1 + DE_EXPM1 + 1 + DE_FMA) + DE_CRACKS + DE_STRESS + DE_STORED + 1,
    DE_PANEL = 2 + DE_CRACKS + DE_STRESS + DE_DRIVE + DE_LOG_RATE + 2 + 1 + (DE_EXPM1 + 1 + DE_FMA),
    DE_NEXT_PANEL = DE_EXP + 1, /* unit, from the second one on */

    DE_HARDENED = 1 + DE_POW + 1,
    DE_NEWTON =
        DE_EXP + 1 + DE_HARDENED + 4 + DE_EXP + 1 + DE_STRESS_AGAIN + DE_FMA + (3 + DE_FMA + 1 + DE_FMA) + 5,
    DE_EXPONENTIAL = DE_COAXIAL + DE_INVARIANTS + 12 * (2 * (1 + DE_FMA) + 1) + (DE_FMA + 1 + 6 * 4),
    /* upper end and start of the iteration, dep; Cp^-1; ep, eb, the new stress */
    DE_FLOW = (DE_HARDENED + 2 + DE_LOG) + 3 + DE_LOG + (3 + DE_EXP) + DE_TANGENT + 1 + (DE_FMA + 2) +
              DE_EXP + (1 + 7 + DE_EXPONENTIAL + DE_COAXIAL + 9 + DE_CONGRUENCE + 6) +
              (2 + DE_STRESS_AGAIN + (1 + DE_FMA) + DE_DRIVE + DE_STORED + 1),
};

/* A step, or at rest. */
static inline double rg_ceramic_flops(const rg_cost_variant *v) {
    double growth = DE_GROWTH + v->panels * DE_PANEL + (v->panels > 1 ? v->panels - 1 : 0) * DE_NEXT_PANEL;
    return DE_AT_REST + v->growing * growth + v->flowing * (DE_FLOW + v->newton * DE_NEWTON);
}

/* Energy alone, or with the stress; the internal variables are not asked for. */
static inline double rg_ceramic_state_flops(const rg_cost_variant *v) {
    return DE_STRAIN + DE_CRACKS + DE_STRESS + DE_STORED + (v->cauchy ? DE_PIOLA : 0);
}

#endif
