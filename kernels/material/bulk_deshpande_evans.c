/* Bulk kernel of the Deshpande-Evans ceramic. */
#ifndef RG_SINGLE

#include "element/material_point.h"
#include "material/deshpande_evans.h"

#define RG_MATERIAL deshpande_evans
#define RG_HISTORY  RG_DE_HISTORY

#define RG_TOGETHER RG_GAUSS

static __attribute__((noinline)) void material_steps(const rg_bulk_args *args, rg_vec H[][3][3],
                                                     rg_vec history[][RG_DE_HISTORY], rg_vec P[][3][3],
                                                     rg_point out[]) {
    const rg_de_constants *c = &args->material.of.deshpande_evans.constants;
    rg_vec F[RG_TOGETHER][3][3];
    rg_de_result r[RG_TOGETHER];
    for (int g = 0; g < RG_TOGETHER; g++) {
        rg_plus_identity(H[g], F[g]);
    }
    rg_de_points(c, args->advance, RG_TOGETHER, F, history, P, r);
    for (int g = 0; g < RG_TOGETHER; g++) {
        out[g].stiffening = r[g].stiffening;
        out[g].released[RG_RELEASED_PLASTIC] = r[g].plastic;
        out[g].released[RG_RELEASED_DAMAGE] = r[g].damage;
    }
}

RG_INLINE void material_state(const rg_material *m, rg_vec H[3][3], rg_vec history[], bool stress,
                              rg_point_state *out) {
    const rg_de_constants *c = &m->of.deshpande_evans.constants;
    rg_vec F[3][3], size = history[RG_DE_GROWTH] + 1.0;
    rg_hencky d;
    rg_plus_identity(H, F);
    rg_hencky_at(F, history + RG_DE_FLOW, &d);
    rg_de_cracks k = rg_de_cracks_at(c, history[RG_DE_GROWTH]);
    rg_de_response r = rg_de_response_at(c, &k, d.ekk);
    rg_de_stress s = rg_de_stress_at(c, &r, d.eb);
    out->energy = rg_de_stored(&s, d.ekk, d.eb);
    out->J = d.J;
    rg_no_internal(out);
    out->internal[RG_INTERNAL_DAMAGE] = c->d0 * (size * size * size);
    out->internal[RG_INTERNAL_REGIME] = rg_de_regime(&r, &s, d.eb);
    out->internal[RG_INTERNAL_PLASTIC] = history[RG_DE_STRAIN];
    if (stress) {
        rg_hencky_piola(s.mean, s.mises, &d, out->P);
    }
}

#include "element/bulk.h"

#else
typedef int rg_needs_double_precision; /* materials.h */
#endif
