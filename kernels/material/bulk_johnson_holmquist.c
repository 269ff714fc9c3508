/* Bulk kernel of the Johnson-Holmquist ceramic. */
#ifndef RG_SINGLE

#include "material/johnson_holmquist.h"

#define RG_MATERIAL johnson_holmquist
#define RG_HISTORY  RG_JH_HISTORY

static __attribute__((noinline)) void material_step(const rg_bulk_args *args, rg_vec H[3][3],
                                                    rg_vec history[], rg_vec P[3][3], rg_point *out) {
    rg_vec F[3][3];
    rg_plus_identity(H, F);
    rg_jh_step(&args->material, args->advance, F, history, P, out);
}

RG_INLINE void material_state(const rg_material *m, rg_vec H[3][3], rg_vec history[], bool stress,
                              rg_point_state *out) {
    const rg_jh_constants c = rg_jh_constants_of(m);
    rg_vec F[3][3];
    rg_jh_point p;
    rg_plus_identity(H, F);
    rg_jh_begin(&c, F, history, &p);
    out->energy = 0.5 * p.mises * p.d.eb + rg_jh_stored(&c, p.d.J, p.bulked, p.hold);
    out->J = p.d.J;
    rg_no_internal(out);
    out->internal[RG_INTERNAL_DAMAGE] = history[RG_JH_DAMAGE];
    out->internal[RG_INTERNAL_BULKING] = history[RG_JH_BULKING];
    out->internal[RG_INTERNAL_PLASTIC] = history[RG_JH_STRAIN];
    if (stress) {
        rg_hencky_piola(-p.p * p.d.J, p.mises, &p.d, out->P);
    }
}

#include "element/bulk.h"

#else
typedef int rg_needs_double_precision; /* materials.h */
#endif
