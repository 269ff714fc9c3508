/* Bulk kernel of the Drucker-Prager solid. */
#ifndef RG_SINGLE

#include "material/drucker_prager.h"

#define RG_MATERIAL drucker_prager
#define RG_HISTORY  RG_DP_HISTORY

static __attribute__((noinline)) void material_step(const rg_bulk_args *args, rg_vec H[3][3],
                                                    rg_vec history[], rg_vec P[3][3], rg_point *out) {
    rg_vec F[3][3];
    rg_plus_identity(H, F);
    rg_dp_step(&args->material, args->advance, F, history, P, out);
}

RG_INLINE void material_state(const rg_material *m, rg_vec H[3][3], rg_vec history[], bool stress,
                              rg_point_state *out) {
    const rg_dp_constants c = rg_dp_constants_of(m);
    rg_vec F[3][3];
    rg_hencky d;
    rg_plus_identity(H, F);
    rg_hencky_at(F, history + RG_DP_FLOW, &d);
    rg_vec volume = d.ekk - history[RG_DP_VOLUME];
    out->energy = 0.5 * (c.bulk * (volume * volume) + c.shear3 * (d.eb * d.eb));
    out->J = d.J;
    rg_no_internal(out);
    out->internal[RG_INTERNAL_PLASTIC] = history[RG_DP_STRAIN];
    out->internal[RG_INTERNAL_VOLUME] = history[RG_DP_VOLUME];
    if (stress) {
        rg_hencky_piola(c.bulk * volume, c.shear3 * d.eb, &d, out->P);
    }
}

#include "element/bulk.h"

#else
typedef int rg_needs_double_precision; /* materials.h */
#endif
