/* Bulk kernel of the Johnson-Cook metal. */
#ifndef RG_SINGLE

#include "material/johnson_cook.h"

#define RG_MATERIAL johnson_cook
#define RG_HISTORY  RG_JC_HISTORY

#define RG_TOGETHER RG_GAUSS

static __attribute__((noinline)) void material_steps(const rg_bulk_args *args, rg_vec H[][3][3],
                                                     rg_vec history[][RG_JC_HISTORY], rg_vec P[][3][3],
                                                     rg_point out[]) {
    rg_vec F[RG_TOGETHER][3][3];
    for (int g = 0; g < RG_TOGETHER; g++) {
        rg_plus_identity(H[g], F[g]);
    }
    rg_jc_points(&args->material, args->advance, RG_TOGETHER, F, history, P, out);
}

RG_INLINE void material_state(const rg_material *m, rg_vec H[3][3], rg_vec history[], bool stress,
                              rg_point_state *out) {
    rg_jc_constants c = rg_jc_constants_of(m);
    rg_vec F[3][3];
    rg_hencky d;
    rg_plus_identity(H, F);
    rg_hencky_at(F, history + RG_JC_FLOW, &d);
    out->energy = 0.5 * (c.bulk * (d.ekk * d.ekk) + c.von_mises * (d.eb * d.eb));
    out->J = d.J;
    rg_no_internal(out);
    out->internal[RG_INTERNAL_PLASTIC] = history[RG_JC_STRAIN];
    out->internal[RG_INTERNAL_TEMPERATURE] = c.room + history[RG_JC_RISE];
    if (stress) {
        rg_hencky_piola(c.bulk * d.ekk, c.von_mises * d.eb, &d, out->P);
    }
}

#include "element/bulk.h"

#else
typedef int rg_needs_double_precision; /* materials.h */
#endif
