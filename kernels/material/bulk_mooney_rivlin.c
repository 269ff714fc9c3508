/* Bulk kernel of the Mooney-Rivlin solid. */
#ifndef RG_SINGLE

#include "material/mooney_rivlin.h"

#define RG_MATERIAL mooney_rivlin
#define RG_HISTORY  0

RG_INLINE void material_step(const rg_bulk_args *args, rg_vec H[3][3], rg_vec history[], rg_vec P[3][3],
                             rg_point *out) {
    (void)history;
    rg_mooney_strain s;
    rg_mooney_strain_at(H, &s);
    rg_mooney_stress(&args->material, &s, P);
    out->stiffening = rg_mooney_stiffening(&args->material, &s);
}

RG_INLINE void material_state(const rg_material *m, rg_vec H[3][3], rg_vec history[], bool stress,
                              rg_point_state *out) {
    (void)history;
    rg_mooney_strain s;
    rg_mooney_strain_at(H, &s);
    out->energy = rg_mooney_energy(m, H, &s);
    out->J = s.v.J;
    if (stress) {
        rg_mooney_stress(m, &s, out->P);
    }
}

#include "element/bulk.h"

#else
typedef int rg_needs_double_precision; /* materials.h */
#endif
