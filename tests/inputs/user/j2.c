/* J2 plasticity of the program once more, as a material of a library: the same bits. */
#include "user/material.h"

#include "material/j2.h"

#define RG_HISTORY RG_J2_HISTORY

enum { YOUNG, POISSON, YIELD, HARDENING };
static const rg_user_parameter parameters[] = {
    {"young", "Pa", .low = 0, .high = INFINITY, .open = true},
    {"poisson", .low = 0, .high = 0.5, .open = true},
    {"yield", "Pa", .low = 0, .high = INFINITY, .open = true},
    {"hardening", "Pa", .low = 0, .high = INFINITY, .optional = true},
};

static void moduli(const double p[], double *lambda, double *mu) {
    *lambda = p[YOUNG] * p[POISSON] / ((1 + p[POISSON]) * (1 - 2 * p[POISSON]));
    *mu = p[YOUNG] / (2 * (1 + p[POISSON]));
}

static rg_material built_in(const rg_material *m) {
    rg_material own = {.lambda = m->lambda, .mu = m->mu, .dt = m->dt};
    own.of.parameter[RG_PARAMETER_YIELD_STRESS] = m->of.user.parameter[YIELD];
    own.of.parameter[RG_PARAMETER_HARDENING] = m->of.user.parameter[HARDENING];
    return own;
}

static __attribute__((noinline)) void material_step(const rg_bulk_args *args, rg_vec H[3][3],
                                                    rg_vec history[], rg_vec P[3][3], rg_point *out) {
    rg_vec F[3][3];
    rg_material own = built_in(&args->material);
    rg_plus_identity(H, F);
    rg_j2_step(&own, args->advance, F, history, P, out);
}

RG_INLINE void material_state(const rg_material *m, rg_vec H[3][3], rg_vec history[], bool stress,
                              rg_point_state *out) {
    rg_material own = built_in(m);
    rg_j2_constants c = rg_j2_constants_of(&own);
    rg_vec F[3][3];
    rg_hencky d;
    rg_plus_identity(H, F);
    rg_hencky_at(F, history + RG_J2_FLOW, &d);
    out->energy = 0.5 * (c.bulk * (d.ekk * d.ekk) + c.von_mises * (d.eb * d.eb));
    out->J = d.J;
    out->internal[RG_INTERNAL_PLASTIC] = history[RG_J2_STRAIN];
    if (stress) {
        rg_hencky_piola(c.bulk * d.ekk, c.von_mises * d.eb, &d, out->P);
    }
}

RG_USER_MATERIAL(.name = "j2", RG_USER_LIST(parameters), .inside = RG_HAS_PLASTIC, .moduli = moduli)
