/* Bulk kernel of the Deshpande-Evans ceramic. */
#ifndef RG_SINGLE

#include "deshpande_evans.h"
#include "material_point.h"

#define RG_MATERIAL deshpande_evans
#define RG_HISTORY  RG_DE_HISTORY

static __attribute__((noinline)) void material_step(const rg_bulk_args *args, rg_vec H[3][3],
                                                    rg_vec history[], rg_vec P[3][3], rg_point *out) {
    const rg_de_constants *c = &args->material.of.deshpande_evans.constants;
    rg_vec F[3][3];
    rg_plus_identity(H, F);
    rg_de_result r = args->advance ? rg_de_step(c, F, history, P) : rg_de_at_rest(c, F, history, P);
    out->stiffening = r.stiffening;
    out->released[RG_RELEASED_PLASTIC] = r.plastic;
    out->released[RG_RELEASED_DAMAGE] = r.damage;
}

RG_INLINE void material_state(const rg_material *m, rg_vec H[3][3], rg_vec history[], bool stress,
                              rg_point_state *out) {
    const rg_de_constants *c = &m->of.deshpande_evans.constants;
    rg_vec F[3][3], size = history[RG_DE_GROWTH] + 1.0;
    rg_hencky d;
    rg_plus_identity(H, F);
    rg_hencky_at(F, history + RG_DE_FLOW, &d);
    rg_de_cracks k = rg_de_cracks_at(c, history[RG_DE_GROWTH]);
    rg_de_stress s = rg_de_stress_at(c, &k, d.ekk, d.eb);
    out->energy = rg_de_stored(&s, d.ekk, d.eb);
    out->J = d.J;
    out->internal[RG_INTERNAL_DAMAGE] = c->d0 * (size * size * size);
    out->internal[RG_INTERNAL_REGIME] = rg_de_regime(&k, &s);
    out->internal[RG_INTERNAL_PLASTIC] = history[RG_DE_STRAIN];
    if (stress) {
        rg_hencky_piola(s.mean, s.mises, &d, out->P);
    }
}

#include "bulk.h"

#else
typedef int rg_needs_double_precision; /* materials.h */
#endif
