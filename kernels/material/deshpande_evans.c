/* Constants of the Deshpande-Evans ceramic. */
#include "material/deshpande_evans_model.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

rg_deshpande_evans rg_deshpande_evans_alumina(void) {
    return (rg_deshpande_evans){
        .shear = 146e9,
        .poisson = 0.2,
        .density = 3700,
        .flaw_radius = 19e-6,
        .flaw_density = 1e12,
        .alpha = sqrt(0.5),
        .beta = 0.1,
        .gamma = 2,
        .friction = 0.75,
        .toughness = 3e6,
        .growth_speed = 100e-6,
        .growth_exponent = 10,
        .damage_max = 0.999,
        .yield_stress = 4e9,
        .yield_strain = 0.002,
        .hardening_exponent = 0.1,
        .plastic_rate = 0.002,
        .transition_rate = 1e6,
        .rate_exponent = 10,
    };
}

double rg_de_initial_damage(const rg_deshpande_evans *p) {
    return 4.0 / 3 * pi * pow(p->alpha * p->flaw_radius, 3) * p->flaw_density;
}

double rg_de_damage(const rg_deshpande_evans *p, double growth) {
    return rg_de_initial_damage(p) * pow(1 + growth, 3);
}

/* Stress at which the step's plastic strain is RG_DE_NO_FLOW before any hardening. */
static double quiet_stress(const rg_de_constants *c) {
    double rate = log(RG_DE_NO_FLOW) - c->log_edot0_dt; /* log(edot/edot0) */
    return c->half_yield * exp(rate <= c->log_transition ? c->inv_n * rate : rate - c->jump);
}

rg_de_constants rg_de_prepare(const rg_deshpande_evans *p, double dt) {
    double d0 = rg_de_initial_damage(p), root = sqrt(1 + p->friction * p->friction);
    double a1 = pi * sqrt(p->beta / 3) * (root - p->friction);
    double a3 = a1 * (root + p->friction) / (root - p->friction), length = p->alpha * p->flaw_radius;
    rg_de_constants c = {
        .bulk = 2 * p->shear * (1 + p->poisson) / (3 * (1 - 2 * p->poisson)),
        .von_mises = 3 * p->shear,
        .p_modulus = 2 * p->shear * (1 - p->poisson) / (1 - 2 * p->poisson),
        .crack_compliance = pi * d0 / (2 * pow(p->alpha, 3) * p->shear * (1 + p->poisson)),
        .offset = p->beta / p->alpha,
        .c1 = 1 / (pi * pi * pow(p->alpha, 1.5)),
        .c2 = 2 * pow(d0, 2.0 / 3),
        .c3 = 2 * p->alpha * p->alpha * pi * (p->single_pi ? 1 : pi),
        .d0 = d0,
        .d0_23 = pow(d0, 2.0 / 3),
        .sum = (a3 + a1) / sqrt(3),
        .difference = a3 - a1,
        .gamma_root = p->gamma * sqrt(p->alpha),
        .growth_max = cbrt(p->damage_max / d0) - 1,
        .intensity = sqrt(pi * p->flaw_radius) / p->toughness,
        .exponent = p->growth_exponent,
        .log_rate = log(p->growth_speed / length),
        .log_cap = log(sqrt(p->shear / p->density) / length),
        .dt = dt,
        .reach = dt * sqrt(p->shear / p->density) / length,
        .half_yield = p->yield_stress / 2,
        .yield_strain = p->yield_strain,
        .hardening = p->hardening_exponent,
        .inv_n = 1 / p->rate_exponent,
        .n = p->rate_exponent,
        .log_edot0_dt = log(p->plastic_rate * dt),
        .log_transition = log(p->transition_rate / p->plastic_rate),
    };
    c.jump = (1 - c.inv_n) * c.log_transition;
    double silent = exp((log(RG_DE_NO_GROWTH * c.offset / dt) - c.log_rate) / c.exponent) / c.intensity;
    c.silent = silent * silent;
    for (int k = 0; k < RG_DE_BINOMIAL; k++) {
        c.binomial[k] = k == 0 ? c.hardening : c.binomial[k - 1] * (c.hardening - k) / (k + 1);
    }
    c.quiet = quiet_stress(&c);
    return c;
}
