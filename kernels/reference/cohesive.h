/* The cohesive laws as scalars, straight after their equations; each law's function is in its own file
 * (laws.h). */
#ifndef RG_REFERENCE_COHESIVE_H
#define RG_REFERENCE_COHESIVE_H

#include <math.h>

#include "kernels.h"

typedef struct {
    double strength, opening; /* sigma_c (Pa), delta_c (m) */
    const double *shape;      /* the law's own parameters */
    double beta, step;        /* weight of shear; time since the state before (s) */
    double normal, sliding;   /* D_n, |D_t| (m) */
    double effective;         /* sqrt(beta^2 |D_t|^2 + max(0, D_n)^2) (m) */
    double before;            /* largest effective opening before this state (m) */
    double onset;             /* of laws with RG_FOLLOWS (m): by rg_reference_conserving */
} rg_law_query;

typedef struct {
    double normal, sliding;    /* traction along n and along D_t (Pa) */
    double stored, dissipated; /* J/m^2 */
} rg_law_answer;

static inline void rg_reference_secant(const rg_law_query *p, double secant, rg_law_answer *a) {
    a->normal = secant * fmax(0, p->normal);
    a->sliding = secant * p->beta * p->beta * p->sliding;
    a->stored = secant * p->effective * p->effective / 2;
}

/* Opening rate of a point (3.15), into the memory behind state[0]. */
static inline void rg_reference_opening_rate(const rg_law_query *p, double ascent, double state[]) {
    double x = p->effective / p->opening, last = state[1 + RG_LIMITER_LAST] / p->opening, opening_rate = 0;
    if (p->step > 0 && x < 1)
        opening_rate = fabs(x - last) / p->step / (x < ascent ? ascent : 1 - ascent);
    state[1 + RG_LIMITER_RATE] = opening_rate;
    state[1 + RG_LIMITER_LAST] = p->effective;
}

/* Answer of a law. state: largest effective opening (this state included), then the law's memory, which is
 * advanced; asking again for the same state (before = state[0]) changes nothing. */
rg_law_answer rg_reference_law(rg_law law, const rg_law_query *p, double state[1 + RG_LAW_MEMORY]);

/* The same under a conserving activation (cohesive/conserving.h) from the opening `onset` (m). Openings of
 * the query are counted with it, except for `before`, which like state[0] is the damage, largest opening less
 * onset; it is brought up to date here. */
rg_law_answer rg_reference_conserving(rg_law law, const rg_law_query *p, double onset,
                                      double state[1 + RG_LAW_MEMORY]);

/* (ratio - 1) B^exponent, B the share of shear (RG_MIXED). */
static inline double rg_reference_excess(const double *shape, double share) {
    return (shape[RG_MIXED_RATIO] - 1) * pow(share, shape[RG_MIXED_EXPONENT]);
}

#define RG_REFERENCE_NOTHING 1e-20 /* m: least damage of a point that has switched */

#endif
