/* Reference Deshpande-Evans ceramic. */
#include "reference/deshpande_evans.h"

#include <math.h>
#include <string.h>

#include "layout.h"
#include "reference/hencky.h"
#include "reference/material.h"
#include "reference/reference.h"

static const double pi = 3.14159265358979323846;

rg_reference_de_cracks rg_reference_de_coefficients(const rg_deshpande_evans *p, double damage) {
    double d0 = rg_de_initial_damage(p), X = cbrt(damage / d0) - 1,
           root = sqrt(1 + p->friction * p->friction);
    double A1 = pi * sqrt(p->beta / 3) * (root - p->friction);
    double A3 = A1 * (root + p->friction) / (root - p->friction);
    double c1 = 1 / (pi * pi * pow(p->alpha, 1.5) * pow(X + p->beta / p->alpha, 1.5));
    double c2 = 1 + 2 * X * X * pow(d0, 2.0 / 3) / (1 - pow(damage, 2.0 / 3));
    double c3 = 2 * p->alpha * p->alpha * pi * (p->single_pi ? 1 : pi) * X * X;
    rg_reference_de_cracks k;
    k.A = c1 * (c2 * A3 - c2 * A1 + c3);
    k.B = c1 / sqrt(3) * (c2 * A3 + c2 * A1 + c3);
    k.C = k.A + p->gamma * sqrt(p->alpha * cbrt(damage / d0));
    k.E = sqrt(k.B * k.B * k.C * k.C / (k.C * k.C - k.A * k.A));
    return k;
}

int rg_reference_de_regime(const rg_deshpande_evans *p, double damage, double mean, double mises) {
    rg_reference_de_cracks k = rg_reference_de_coefficients(p, damage);
    if (mean <= -k.B / k.A * mises)
        return 1;
    return mean < k.A * k.B / (k.C * k.C - k.A * k.A) * mises ? 2 : 3;
}

static double kappa(const rg_deshpande_evans *p) {
    return pi * rg_de_initial_damage(p) / (4 * pow(p->alpha, 3) * p->shear * (1 + p->poisson));
}

double rg_reference_de_intensity(const rg_deshpande_evans *p, double damage, double mean, double mises) {
    rg_reference_de_cracks k = rg_reference_de_coefficients(p, damage);
    double unit = sqrt(pi * p->flaw_radius);
    switch (rg_reference_de_regime(p, damage, mean, mises)) {
    case 1:
        return 0;
    case 2:
        return unit * (k.A * mean + k.B * mises);
    default:
        return unit * sqrt(k.C * k.C * mean * mean + k.E * k.E * mises * mises);
    }
}

double rg_reference_de_energy(const rg_deshpande_evans *p, double damage, double mean, double mises) {
    double nu = p->poisson, intensity = rg_reference_de_intensity(p, damage, mean, mises);
    double w0 = (2.0 / 3 * mises * mises + 3 * (1 - 2 * nu) / (1 + nu) * mean * mean) / (4 * p->shear);
    return w0 + kappa(p) * intensity * intensity / (pi * p->flaw_radius);
}

/* dX/dt of an intensity. */
static double growth_rate(const rg_deshpande_evans *p, double intensity) {
    double speed = p->growth_speed * pow(intensity / p->toughness, p->growth_exponent);
    return fmin(speed, sqrt(p->shear / p->density)) / (p->alpha * p->flaw_radius);
}

double rg_reference_de_damage_rate(const rg_deshpande_evans *p, double damage, double mean, double mises) {
    double d0 = rg_de_initial_damage(p), intensity = rg_reference_de_intensity(p, damage, mean, mises);
    return 3 * pow(damage, 2.0 / 3) * cbrt(d0) * growth_rate(p, intensity);
}

int rg_reference_de_invariants(const rg_deshpande_evans *p, double damage, double ekk, double eb,
                               double *mean, double *mises) {
    rg_reference_de_cracks c = rg_reference_de_coefficients(p, damage);
    double G = p->shear, k = 3 * (1 - 2 * p->poisson) / (2 * G * (1 + p->poisson)), kap = kappa(p);
    double soft = k + 2 * kap * c.C * c.C, soft_shear = 1 / (3 * G) + 2 * kap * c.E * c.E;
    if (ekk <= -c.B / c.A * 3 * G * k * eb) {
        *mean = ekk / k;
        *mises = 3 * G * eb;
        return 1;
    }
    if (ekk >= c.A * c.B / (c.C * c.C - c.A * c.A) * eb * soft / soft_shear) {
        *mean = ekk / soft;
        *mises = eb / soft_shear;
        return 3;
    }
    double a11 = k + 2 * kap * c.A * c.A, a12 = 2 * kap * c.A * c.B, a22 = 1 / (3 * G) + 2 * kap * c.B * c.B;
    double d = a11 * a22 - a12 * a12;
    *mean = (a22 * ekk - a12 * eb) / d;
    *mises = (a11 * eb - a12 * ekk) / d;
    return 2;
}

double rg_reference_de_flow_stress(const rg_deshpande_evans *p, double ep, double rate) {
    double s0 = p->yield_stress / 2 * (1 + pow(ep / p->yield_strain, p->hardening_exponent));
    double n = p->rate_exponent, relative = rate / p->plastic_rate;
    if (rate <= p->transition_rate)
        return s0 * pow(relative, 1 / n);
    return s0 * relative * pow(p->transition_rate / p->plastic_rate, (1 - n) / n);
}

static double overstress(const rg_deshpande_evans *p, double damage, double ekk, double eb, double ep,
                         double dt, double flow) {
    double mean, mises;
    rg_reference_de_invariants(p, damage, ekk, eb - flow, &mean, &mises);
    return mises - rg_reference_de_flow_stress(p, ep + flow, flow / dt);
}

double rg_reference_de_flow(const rg_deshpande_evans *p, double damage, double ekk, double eb, double ep,
                            double dt) {
    double mean, mises, low = log(RG_DE_NO_FLOW), high = log(eb);
    rg_reference_de_invariants(p, damage, ekk, eb, &mean, &mises);
    if (mises <= rg_reference_de_flow_stress(p, ep, RG_DE_NO_FLOW / dt))
        return 0;
    low -= 100;
    for (int i = 0; i < 70; i++) { /* 100 + log eb shrinks to rounding */
        double middle = (low + high) / 2;
        *(overstress(p, damage, ekk, eb, ep, dt, exp(middle)) > 0 ? &low : &high) = middle;
    }
    return exp(low);
}

/* Time per relative growth, phi = (X + beta/alpha)/(dX/dt); no growth is e^-300 of that at K_IC. */
static double phi(const rg_deshpande_evans *p, double growth, double ekk, double eb) {
    double mean, mises, damage = rg_de_damage(p, growth);
    rg_reference_de_invariants(p, damage, ekk, eb, &mean, &mises);
    double rate = growth_rate(p, rg_reference_de_intensity(p, damage, mean, mises));
    double least = p->growth_speed / (p->alpha * p->flaw_radius) * exp(-300);
    return (growth + p->beta / p->alpha) / fmax(rate, least);
}

double rg_reference_de_growth(const rg_deshpande_evans *p, double growth, double ekk, double eb, double dt) {
    double offset = p->beta / p->alpha, y = growth + offset, first = phi(p, growth, ekk, eb);
    double most = cbrt(p->damage_max / rg_de_initial_damage(p)) - 1;
    double euler = growth + dt * y / first;
    if (growth >= most || dt / first <= RG_DE_NO_GROWTH)
        return growth;
    if (dt / first <= RG_DE_LITTLE)
        return fmin(euler, most);
    double end = fmin(growth + dt * sqrt(p->shear / p->density) / (p->alpha * p->flaw_radius), most);
    double width = log((end + offset) / y) / RG_DE_PANELS;
    for (int i = 1; i <= RG_DE_PANELS; i++) {
        double last = phi(p, y * exp(i * width) - offset, ekk, eb), bend = log(last / first);
        double needed = width * (bend == 0 ? first : (last - first) / bend);
        if (dt < needed) {
            double linear = dt / (width * first), part = bend == 0 ? linear : log1p(bend * linear) / bend;
            return fmin(y * exp((i - 1 + part) * width) - offset, most);
        }
        dt -= needed;
        first = last;
    }
    return end;
}

/* ---- The point ---- */

rg_reference_de_result rg_reference_de_step(const rg_deshpande_evans *p, double dt, double F[3][3],
                                            double history[RG_DE_HISTORY], double P[3][3]) {
    rg_reference_de_result out;
    double inverse[3][3], b[3][3], e[3][3], mean, mises, damage = rg_de_damage(p, history[RG_DE_GROWTH]);
    double ekk = log(rg_reference_invert(F, inverse)),
           eb = rg_reference_hencky(F, history + RG_DE_FLOW, b, e);
    double lambda = 2 * p->shear * p->poisson / (1 - 2 * p->poisson);
    out.ekk = ekk;
    out.eb = eb;
    out.regime_before = rg_reference_de_invariants(p, damage, ekk, eb, &mean, &mises);
    double before = rg_reference_de_energy(p, damage, mean, mises);
    double flow = dt > 0 && eb > 0 ? rg_reference_de_flow(p, damage, ekk, eb, history[RG_DE_STRAIN], dt) : 0;
    if (flow > 0)
        rg_reference_hencky_flow(inverse, b, e, flow / eb, history + RG_DE_FLOW);
    history[RG_DE_STRAIN] += flow;
    rg_reference_de_invariants(p, damage, ekk, eb - flow, &mean, &mises);
    double between = rg_reference_de_energy(p, damage, mean, mises);
    if (dt > 0)
        history[RG_DE_GROWTH] = rg_reference_de_growth(p, history[RG_DE_GROWTH], ekk, eb - flow, dt);
    damage = rg_de_damage(p, history[RG_DE_GROWTH]);
    out.regime = rg_reference_de_invariants(p, damage, ekk, eb - flow, &mean, &mises);
    out.energy = rg_reference_de_energy(p, damage, mean, mises);
    out.plastic = before - between;
    out.damage = between - out.energy;
    rg_reference_hencky_piola(mean, mises, eb, e, inverse, P);
    out.stiffening = rg_reference_hencky_stiffening(lambda, p->shear, mean, mises, eb, inverse);
    return out;
}

void rg_reference_point_deshpande_evans(const rg_material *m, bool advance, double F[3][3], double history[],
                                        double P[3][3], rg_reference_point *out) {
    const rg_de_material *de = &m->of.deshpande_evans;
    double dt = advance ? de->constants.dt : 0;
    rg_reference_de_result r = rg_reference_de_step(&de->parameters, dt, F, history, P);
    out->stiffening = r.stiffening;
    out->energy = r.energy;
    out->released[RG_RELEASED_PLASTIC] = r.plastic;
    out->released[RG_RELEASED_DAMAGE] = r.damage;
    out->internal[RG_INTERNAL_DAMAGE] = rg_de_damage(&de->parameters, history[RG_DE_GROWTH]);
    out->internal[RG_INTERNAL_REGIME] = r.energy > 0 ? r.regime : 0;
    out->internal[RG_INTERNAL_PLASTIC] = history[RG_DE_STRAIN];
}
