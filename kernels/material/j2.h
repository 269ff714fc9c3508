/* J2 plasticity with isotropic hardening, at finite strain: W = K/2 (log J)^2 + 3G/2 eb^2 of the Hencky
 * strain of F Fp^-1 (material/hencky.h), eb = sqrt(2/3 e':e'), so the Kirchhoff stress has the mean K log J
 * and the von Mises part 3G eb. It flows along its deviator and stays on or below the yield curve sY(ep) = s0
 * + H ep
 * + (s_inf - s0) (1 - exp(-delta ep)), linear hardening and one that saturates (E. Voce 1948; J. C. Simo & T.
 * J. R. Hughes, Computational Inelasticity, 1998, 3.3 and 9.3), ep the equivalent plastic strain.
 *
 * One step is a radial return in logarithmic strain: eb - dep with 3G (eb - dep) = sY(ep + dep). It has no
 * error where the direction of the strain stays, whatever the step. What flow sets free is the work of the
 * yield curve, by the trapezoidal rule from sY(ep) to sY(ep + dep): exact for linear hardening, and with it
 * the ledger closes to second order. All of it counts as dissipated.
 *
 * A lane's result depends on that lane alone: parts that only some lanes need are entered if any lane needs
 * them, and other lanes keep their bits. */
#ifndef RG_J2_H
#define RG_J2_H

#include "element/material_point.h"
#include "material/hencky.h"

enum { RG_J2_NEWTON = 50 }; /* steps at most; four or five in metals */
#define RG_J2_NEAR 1e-8     /* size of the last one in delta dep: the next would be half its square */

/* What a point needs of the parameters. */
typedef struct {
    double bulk, von_mises, p_modulus; /* K, 3G, lambda + 2 mu (Pa) */
    double yield, hardening;           /* s0, H (Pa) */
    double gain, rate;                 /* s_inf - s0 (Pa), delta; gain 0: no saturating part */
} rg_j2_constants;

RG_INLINE rg_j2_constants rg_j2_constants_of(const rg_material *m) {
    const double *given = m->of.parameter, top = given[RG_PARAMETER_SATURATION_STRESS];
    return (rg_j2_constants){.bulk = m->lambda + 2.0 / 3 * m->mu,
                             .von_mises = 3 * m->mu,
                             .p_modulus = m->lambda + 2 * m->mu,
                             .yield = given[RG_PARAMETER_YIELD_STRESS],
                             .hardening = given[RG_PARAMETER_HARDENING],
                             .gain = top > 0 ? top - given[RG_PARAMETER_YIELD_STRESS] : 0,
                             .rate = given[RG_PARAMETER_SATURATION_RATE]};
}

/* What is left of the gain: (s_inf - s0) exp(-delta ep). */
RG_INLINE rg_vec rg_j2_left(const rg_j2_constants *c, rg_vec ep) {
    return c->gain > 0 ? c->gain * rg_exp(-c->rate * ep) : (rg_vec){0};
}

/* sY(ep), from what is left of the gain there. */
RG_INLINE rg_vec rg_j2_yield(const rg_j2_constants *c, rg_vec ep, rg_vec left) {
    return (c->yield + c->gain) + c->hardening * ep - left;
}

/* dep > 0 of lanes in `flows`, where `over` = 3G eb - sY(ep) > 0: the root of
 *     f(x) = (3G + H) x + left (1 - exp(-delta x)) - over,
 * which grows and is concave, so Newton's method comes up to the root from below. It starts from the larger
 * one of two lower bounds, the tangent at 0 and the asymptote. */
RG_INLINE rg_vec rg_j2_flow(const rg_j2_constants *c, rg_vec left, rg_vec over, rg_mask flows) {
    double slope = c->von_mises + c->hardening;
    rg_vec x = over / (slope + c->rate * left);
    if (c->gain > 0) {
        x = rg_max(x, (over - left) * (1 / slope));
        rg_mask moving = flows;
        for (int i = 0; i < RG_J2_NEWTON && rg_any(moving); i++) {
            rg_vec rest = left * rg_exp(-c->rate * x);
            rg_vec step = (over - slope * x - (left - rest)) / (slope + c->rate * rest);
            x = rg_select(moving, x + step, x);
            moving &= rg_abs(c->rate * step) > RG_J2_NEAR;
        }
    }
    return rg_select(flows, x, rg_splat(0.0));
}

/* The return: history, eb and von Mises stress after it, and the work that it dissipates (J/m^3). */
RG_INLINE rg_vec rg_j2_return(const rg_j2_constants *c, rg_hencky *d, rg_vec history[RG_J2_HISTORY],
                              rg_vec *mises, rg_vec left, rg_vec yield, rg_mask flows) {
    rg_vec ep = history[RG_J2_STRAIN], dep = rg_j2_flow(c, left, *mises - yield, flows), after = ep + dep;
    rg_vec hard = rg_j2_yield(c, after, rg_j2_left(c, after));
    rg_hencky_flow(d, dep / rg_select(flows, d->eb, rg_splat(1.0)), history + RG_J2_FLOW, flows);
    history[RG_J2_STRAIN] = rg_select(flows, after, ep);
    *mises = rg_select(flows, c->von_mises * (d->eb - dep), *mises);
    return 0.5 * dep * (yield + hard);
}

/* P (Pa) and `out` at F; history goes on if `advance`. */
RG_INLINE void rg_j2_step(const rg_material *m, bool advance, rg_vec F[3][3], rg_vec history[RG_J2_HISTORY],
                          rg_vec P[3][3], rg_point *out) {
    rg_j2_constants c = rg_j2_constants_of(m);
    rg_hencky d;
    rg_hencky_at(F, history + RG_J2_FLOW, &d);
    rg_vec mean = c.bulk * d.ekk, mises = c.von_mises * d.eb;
    out->released[RG_RELEASED_PLASTIC] = out->released[RG_RELEASED_DAMAGE] = (rg_vec){0};
    if (advance && rg_any(mises > c.yield)) { /* it only hardens */
        rg_vec left = rg_j2_left(&c, history[RG_J2_STRAIN]);
        rg_vec yield = rg_j2_yield(&c, history[RG_J2_STRAIN], left);
        rg_mask flows = mises > yield;
        if (rg_any(flows)) {
            out->released[RG_RELEASED_PLASTIC] = rg_j2_return(&c, &d, history, &mises, left, yield, flows);
        }
    }
    rg_hencky_piola(mean, mises, &d, P);
    out->stiffening = rg_hencky_stiffening(c.p_modulus, c.von_mises, mean, mises, &d);
}

#endif
