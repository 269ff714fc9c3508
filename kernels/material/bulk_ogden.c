/* Bulk kernel of Ogden's solid. */
#ifndef RG_SINGLE

#include "material/ogden.h"

#define RG_MATERIAL ogden
#define RG_HISTORY  0

static __attribute__((noinline)) void material_step(const rg_bulk_args *args, rg_vec H[3][3],
                                                    rg_vec history[], rg_vec P[3][3], rg_point *out) {
    const rg_ogden c = rg_ogden_of(&args->material);
    rg_ogden_strain s;
    rg_vec tau[3], energy, most;
    (void)history;
    rg_ogden_strain_at(H, &s);
    rg_ogden_terms(&c, &s, tau, &energy, &most);
    rg_vec mean = rg_ogden_mean(&c, &s);
    rg_ogden_piola(H, &s, tau, mean, P);
    out->stiffening = rg_ogden_stiffening(&args->material, &c, &s, tau, mean, most);
}

static __attribute__((noinline)) void material_state(const rg_material *m, rg_vec H[3][3], rg_vec history[],
                                                     bool stress, rg_point_state *out) {
    const rg_ogden c = rg_ogden_of(m);
    rg_ogden_strain s;
    rg_vec tau[3], energy, most;
    (void)history;
    rg_ogden_strain_at(H, &s);
    rg_ogden_terms(&c, &s, tau, &energy, &most);
    out->energy = rg_ogden_energy(&c, &s, energy);
    out->J = s.v.J;
    if (stress) {
        rg_ogden_piola(H, &s, tau, rg_ogden_mean(&c, &s), out->P);
    }
}

#include "element/bulk.h"

#else
typedef int rg_needs_double_precision; /* materials.h */
#endif
