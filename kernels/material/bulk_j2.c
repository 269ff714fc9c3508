/* Bulk kernel of the J2 elastic-plastic solid. */
#ifndef RG_SINGLE

#include "material/j2.h"

#define RG_MATERIAL j2
#define RG_HISTORY  RG_J2_HISTORY

static __attribute__((noinline)) void material_step(const rg_bulk_args *args, rg_vec H[3][3],
                                                    rg_vec history[], rg_vec P[3][3], rg_point *out) {
    rg_vec F[3][3];
    rg_plus_identity(H, F);
    rg_j2_step(&args->material, args->advance, F, history, P, out);
}

RG_INLINE void material_state(const rg_material *m, rg_vec H[3][3], rg_vec history[], bool stress,
                              rg_point_state *out) {
    rg_j2_constants c = rg_j2_constants_of(m);
    rg_vec F[3][3];
    rg_hencky d;
    rg_plus_identity(H, F);
    rg_hencky_at(F, history + RG_J2_FLOW, &d);
    out->energy = 0.5 * (c.bulk * (d.ekk * d.ekk) + c.von_mises * (d.eb * d.eb));
    out->J = d.J;
    rg_no_internal(out);
    out->internal[RG_INTERNAL_PLASTIC] = history[RG_J2_STRAIN];
    if (stress) {
        rg_hencky_piola(c.bulk * d.ekk, c.von_mises * d.eb, &d, out->P);
    }
}

#include "element/bulk.h"

#else
typedef int rg_needs_double_precision; /* materials.h */
#endif
