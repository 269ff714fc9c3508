/* Bulk kernel of the Holmquist-Johnson-Cook concrete. */
#ifndef RG_SINGLE

#include "material/holmquist_johnson_cook.h"

#define RG_MATERIAL holmquist_johnson_cook
#define RG_HISTORY  RG_HJC_HISTORY

static __attribute__((noinline)) void material_step(const rg_bulk_args *args, rg_vec H[3][3],
                                                    rg_vec history[], rg_vec P[3][3], rg_point *out) {
    rg_vec F[3][3];
    rg_plus_identity(H, F);
    rg_hjc_step(&args->material, args->advance, F, history, P, out);
}

RG_INLINE void material_state(const rg_material *m, rg_vec H[3][3], rg_vec history[], bool stress,
                              rg_point_state *out) {
    const rg_hjc_constants c = rg_hjc_constants_of(m);
    rg_vec F[3][3];
    rg_hjc_point p;
    rg_plus_identity(H, F);
    rg_hjc_begin(&c, F, history, &p);
    out->energy = 0.5 * p.mises * p.d.eb + rg_hjc_stored(&p.curve, p.d.J, p.hold);
    out->J = p.d.J;
    rg_no_internal(out);
    out->internal[RG_INTERNAL_DAMAGE] = history[RG_HJC_DAMAGE];
    out->internal[RG_INTERNAL_PLASTIC] = history[RG_HJC_STRAIN];
    out->internal[RG_INTERNAL_VOLUME] = -rg_log(p.curve.packed);
    if (stress) {
        rg_hencky_piola(-p.p * p.d.J, p.mises, &p.d, out->P);
    }
}

#include "element/bulk.h"

#else
typedef int rg_needs_double_precision; /* materials.h */
#endif
