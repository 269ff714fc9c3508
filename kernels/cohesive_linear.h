/* Linear irreversible softening (thesis 3.16-3.22; Camacho & Ortiz 1996): with the effective opening
 * delta = sqrt(beta^2 |D_t|^2 + max(0, D_n)^2) and the largest one so far, delta_max,
 *     T = sigma_c (1 - delta/delta_c)                      loading
 *     T = sigma_c (1 - delta_max/delta_c) delta/delta_max  unloading,
 * so both are T = s delta with the secant s = sigma_c (1/delta_max - 1/delta_c), delta_max updated first. */
#ifndef RG_COHESIVE_LINEAR_H
#define RG_COHESIVE_LINEAR_H

#include "kernels.h"
#include "vec.h"

#define RG_OPENING_FLOOR 1e-20 /* m: keeps the secant finite where nothing has opened, also in floats */
#define RG_NO_AREA       1e-37 /* m2: keeps the normal of padding finite, likewise */

/* Secant s = T/delta (Pa/m); 0 once failed. */
RG_INLINE rg_vec rg_cohesive_secant(const rg_cohesive *law, rg_vec delta_max) {
    rg_vec floor = rg_splat(RG_OPENING_FLOOR);
    rg_vec s = rg_splat(law->strength) * (1.0 / rg_max(delta_max, floor) - rg_splat(1.0 / law->opening));
    return rg_max(s, rg_splat(0.0));
}

/* Energy dissipated per area, G_c min(1, delta_max/delta_c) (J/m^2). */
RG_INLINE rg_vec rg_cohesive_dissipated(const rg_cohesive *law, rg_vec delta_max) {
    rg_vec excess = rg_max(delta_max - rg_splat(law->opening), rg_splat(0.0));
    return rg_splat(0.5 * law->strength) * (delta_max - excess);
}

#endif
