/* The neo-Hookean solid of the program once more, as a material of a library: the same bits. */
#include "user/material.h"

#include "material/neo_hookean.h"

#define RG_HISTORY 0

enum { YOUNG, POISSON, WRONG };
static const rg_user_parameter parameters[] = {
    {.name = "young", .unit = "Pa", .low = 0, .high = INFINITY, .open = true, .meaning = "Young's modulus"},
    {.name = "poisson",
     .low = 0,
     .high = 0.5,
     .open = true,
     .optional = true,
     .fallback = 0.21,
     .meaning = "Poisson's ratio"},
    {.name = "wrong", .optional = true, .fallback = 1, .meaning = "factor of the energy"},
};

static void moduli(const double p[], double *lambda, double *mu) {
    *lambda = p[YOUNG] * p[POISSON] / ((1 + p[POISSON]) * (1 - 2 * p[POISSON]));
    *mu = p[YOUNG] / (2 * (1 + p[POISSON]));
}

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
    out->energy = rg_neo_hookean_energy(m, H, &v) * rg_splat(m->of.user.parameter[WRONG]);
    out->J = v.J;
    if (stress) {
        rg_neo_hookean_stress(m, H, &v, out->P);
    }
}

RG_USER_MATERIAL(.name = "neo-hookean", .meaning = "elastic at any strain", RG_USER_LIST(parameters),
                 .moduli = moduli)
