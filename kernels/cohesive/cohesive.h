/* What a cohesive law is to the kernels: three functions of a point, in vectors. One file per law, listed in
 * laws.h; element/interface.c compiles the kernel once around each (element/interface_law.h calls them).
 *
 *   void rg_NAME_respond(const rg_law_point *p, rg_law_state *state, rg_law_response *r)
 *       traction of a point whose largest opening is up to date; advances the memory, if the law has one
 *   void rg_NAME_energy(const rg_law_point *p, const rg_law_state *state, rg_law_energy *e)
 *       recoverable and dissipated energy of that state
 *
 * The normal part of a closed point (normal < 0) belongs to contact, not to the law. A law that answers with
 * rg_law_by_secant and rg_law_stored unloads to the origin. */
#ifndef RG_COHESIVE_H
#define RG_COHESIVE_H

#include "kernels.h"
#include "vec.h"
#include "vec_math.h"

#define RG_OPENING_FLOOR 1e-20 /* m: keeps the secant finite where nothing has opened, also in floats */
#define RG_NO_AREA       1e-37 /* m2: keeps the normal of padding finite, likewise */

typedef struct {
    const rg_cohesive *law;
    double step;                       /* time since the state before (s) */
    rg_vec area;                       /* of the face (m^2); what a law returns carries it as a factor */
    rg_vec strength, opening, inverse; /* sigma_c (Pa), delta_c (m), 1/delta_c (1/m) at this point */
    rg_vec beta2;                      /* weight of shear, squared; of form intrinsic law->beta all over */
    rg_vec normal;                     /* normal opening D_n (m), < 0: closed */
    rg_vec sliding_square;             /* |D_t|^2 (m^2) */
    rg_vec effective;                  /* sqrt(beta^2 |D_t|^2 + max(0, D_n)^2) (m) */
    rg_vec before;                     /* largest effective opening before this state (m) */
    rg_vec onset; /* of a law with RG_FOLLOWS: opening at which it starts, 0 but of a conserving activation
                     (m); its largest openings are counted from it */
} rg_law_point;

typedef struct {
    rg_vec largest; /* effective opening so far, this state included (m) */
    rg_vec memory[RG_LAW_MEMORY];
} rg_law_state;

/* Traction (N): normal along n, and shear * (weight * D_t). */
typedef struct {
    rg_vec normal, shear, weight;
} rg_law_response;

typedef struct {
    rg_vec stored, dissipated; /* J */
} rg_law_energy;

/* T = s delta in the direction of (beta^2 D_t, max(0, D_n)) (3.19). */
RG_INLINE void rg_law_by_secant(const rg_law_point *p, rg_vec secant, rg_law_response *r) {
    r->shear = p->area * secant;
    r->weight = p->beta2;
    r->normal = r->shear * rg_max(p->normal, rg_splat(0.0));
}

/* s delta^2 / 2 */
RG_INLINE rg_vec rg_law_stored(const rg_law_point *p, rg_vec secant) {
    return 0.5 * p->area * secant * p->effective * p->effective;
}

/* What the critical opening of a law RG_MIXED grows by, at a share of shear. */
RG_INLINE rg_vec rg_law_excess(const rg_cohesive *law, rg_vec share) {
    return rg_splat(law->shape[RG_MIXED_RATIO] - 1) *
           rg_pow(rg_max(share, rg_splat(1e-30)), law->shape[RG_MIXED_EXPONENT]);
}

/* How fast a point goes through its law (3.15): |dx|/dt over the part of x, the opening over the critical
 * one, that it is in: `ascent` below the strength, 1 - ascent beyond it; 0 once separated. */
RG_INLINE void rg_law_opening_rate(const rg_law_point *p, double ascent, rg_law_state *state) {
    double per_second = p->step > 0 ? 1 / p->step : 0;
    rg_vec x = p->effective * p->inverse, moved = rg_abs(p->effective - state->memory[RG_LIMITER_LAST]);
    rg_vec beyond = rg_select(x < 1.0, rg_splat(per_second / (1 - ascent)), rg_splat(0.0));
    rg_vec part = rg_select(x < rg_splat(ascent), rg_splat(per_second / ascent), beyond);
    state->memory[RG_LIMITER_RATE] = moved * p->inverse * part;
    state->memory[RG_LIMITER_LAST] = p->effective;
}

#define RG_LAW_FUNCTIONS
#include "laws.h"
#undef RG_LAW_FUNCTIONS

#endif
