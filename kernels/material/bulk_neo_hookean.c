/* Bulk kernel of the neo-Hookean solid. */
#include "material/neo_hookean.h"

#define RG_MATERIAL neo_hookean
#define RG_HISTORY  0

RG_INLINE void material_step(const rg_bulk_args *args, rg_vec H[3][3], rg_vec history[], rg_vec P[3][3],
                             rg_point *out) {
    (void)history;
    rg_volume_change v;
    rg_neo_hookean_volume(H, &v);
    rg_neo_hookean_stress(&args->material, H, &v, P);
    out->stiffening = rg_neo_hookean_stiffening(&args->material, &v);
}

RG_INLINE void material_state(const rg_material *m, rg_vec H[3][3], rg_vec history[], bool stress,
                              rg_point_state *out) {
    (void)history;
    rg_volume_change v;
    rg_neo_hookean_volume(H, &v);
    out->energy = rg_neo_hookean_energy(m, H, &v);
    out->J = v.J;
    if (stress) {
        rg_neo_hookean_stress(m, H, &v, out->P);
    }
}

#include "element/bulk.h"
