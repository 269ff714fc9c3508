/* Bulk kernel of the viscoelastic solid. */
#ifndef RG_SINGLE

#include "material/viscoelastic.h"

#define RG_MATERIAL viscoelastic
#define RG_HISTORY  RG_VE_HISTORY

#define RG_TOGETHER RG_GAUSS

static __attribute__((noinline)) void material_steps(const rg_bulk_args *args, rg_vec H[][3][3],
                                                     rg_vec history[][RG_VE_HISTORY], rg_vec P[][3][3],
                                                     rg_point out[]) {
    const rg_ve_constants c = rg_ve_constants_of(&args->material);
    for (int g = 0; g < RG_TOGETHER; g++) {
        rg_ve_step(&c, args->advance, H[g], history[g], P[g], &out[g]);
    }
}

RG_INLINE void material_state(const rg_material *m, rg_vec H[3][3], rg_vec history[], bool stress,
                              rg_point_state *out) {
    const rg_ve_constants c = rg_ve_constants_of(m);
    rg_volume_change v;
    rg_vec E[6], A[6], S[6], all[6];
    rg_neo_hookean_volume(H, &v);
    rg_ve_strain(H, E);
    out->energy = rg_neo_hookean_energy(&c.rest, H, &v);
    out->J = v.J;
    rg_no_internal(out);
    for (int k = 0; k < 6; k++) {
        all[k] = (rg_vec){0};
    }
    for (int i = 0; i < RG_VE_ELEMENTS; i++) {
        for (int k = 0; k < 6; k++) {
            A[k] = history[RG_VE_ELASTIC + 6 * i + k] + (E[k] - history[RG_VE_STRAIN + k]);
        }
        rg_ve_stress(&c, i, A, S);
        out->energy += 0.5 * rg_ve_dot(S, A);
        for (int k = 0; k < 6; k++) {
            all[k] += S[k];
        }
    }
    if (stress) {
        rg_neo_hookean_stress(&c.rest, H, &v, out->P);
        rg_ve_add_piola(H, all, out->P);
    }
}

#include "element/bulk.h"

#else
typedef int rg_needs_double_precision; /* materials.h */
#endif
