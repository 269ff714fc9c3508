/* Deshpande-Evans ceramic at a point: deshpande_evans_model.h has the equations.
 *
 * Frame. The model is one of small strains; here its strain is the Hencky strain of F Fp^-1 and its stress
 * the Kirchhoff stress (hencky.h).
 *
 * One step at fixed F: plastic flow with the cracks as they are (backward Euler), then growth of the cracks
 * with the strain as it is. Both are relaxations at constant F, so what they release is exactly the fall of
 * the stored energy.
 *
 * Growth solves dt = int dX/(dX/dt) for its upper end instead of the differential equation: the rate falls by
 * many decades over a step, but it is not negative, so the time is a monotone function of X: no iteration, no
 * stability limit, no overshoot. The interval that the shear wave speed can reach is cut in RG_DE_PANELS
 * geometric panels in X + beta/alpha, on which (X + beta/alpha)/rate is a power.
 *
 * Operations per point: kernels/cost_ceramic.h. Against the neo-Hookean bulk kernel of 1990 they make one of
 * 3350 where nothing happens, 5240 where cracks grow, 7640 where the solid flows.
 *
 * A lane's result depends on that lane alone: parts that only some lanes need are entered if any lane needs
 * them, and other lanes keep their bits. */
#ifndef RG_DESHPANDE_EVANS_H
#define RG_DESHPANDE_EVANS_H

#include "deshpande_evans_model.h"
#include "hencky.h"

enum { RG_DE_NEWTON = 8 }; /* steps of the flow's iteration, at most; two where it is under way */
#define RG_DE_NEAR 1e-6    /* size of its last step in log dep: the next one would be the square */

/* ---- Cracks ---- */

typedef struct {
    rg_vec A, B, C2, E2; /* C2, E2: squares */
    rg_vec open;         /* A B/(C^2 - A^2) */
} rg_de_cracks;

RG_INLINE rg_de_cracks rg_de_cracks_at(const rg_de_constants *c, rg_vec X) {
    rg_vec y = X + c->offset, size = X + 1.0, X2 = X * X;
    rg_vec root = y * rg_sqrt(y), apart = 1.0 - c->d0_23 * (size * size), both = 1.0 / (root * apart);
    rg_vec c1 = c->c1 * (both * apart), c2 = 1.0 + c->c2 * X2 * (both * root);
    rg_de_cracks k;
    k.A = c1 * (c2 * c->difference + c->c3 * X2);
    k.B = c1 * (c2 * c->sum + (c->c3 * 0.57735026918962576451) * X2);
    rg_vec more = c->gamma_root * rg_sqrt(size), C = k.A + more;
    rg_vec inverse = 1.0 / (more * (C + k.A));
    k.C2 = C * C;
    k.E2 = k.B * k.B * k.C2 * inverse;
    k.open = k.A * k.B * inverse;
    return k;
}

typedef struct {
    rg_vec mean, mises; /* sm, se (Pa) */
    rg_vec drive;       /* K_I/sqrt(pi a) (Pa); 0 in regime I */
    rg_vec tangent;     /* dse/deb (Pa) */
} rg_de_stress;

/* Stress from ekk = tr e and eb = sqrt(2/3 e':e'). In I and II with g = A sm + B se, or 0 if that is
 * negative: sm = K (ekk - 2 kappa A g), se = 3G (eb - 2 kappa B g). */
RG_INLINE rg_de_stress rg_de_stress_at(const rg_de_constants *c, const rg_de_cracks *k, rg_vec ekk,
                                       rg_vec eb) {
    const double soft = c->crack_compliance;
    rg_vec elastic = c->bulk * ekk, shear = c->von_mises * eb, shear_soft = (soft * c->von_mises) * k->B;
    rg_vec bulk_open = 1.0 + (soft * c->bulk) * k->C2, shear_open = 1.0 + (soft * c->von_mises) * k->E2;
    rg_vec slid = 1.0 + (soft * c->bulk) * (k->A * k->A) + shear_soft * k->B,
           open_both = bulk_open * shear_open;
    rg_vec inverse = 1.0 / (slid * open_both), slid_inverse = slid * inverse;
    rg_vec mean = elastic * (shear_open * slid_inverse), stiff = c->von_mises * (bulk_open * slid_inverse);
    rg_vec mises = stiff * eb, share = open_both * inverse, pull = k->A * elastic + k->B * shear;
    rg_mask open = mean >= k->open * mises, closed = pull <= 0.0;
    rg_vec g = rg_select(closed, rg_splat(0.0), pull * share);
    rg_vec sliding = c->von_mises * (1.0 - shear_soft * k->B * share);
    rg_de_stress s;
    s.mean = rg_select(open, mean, elastic - (soft * c->bulk) * (k->A * g));
    s.mises = rg_select(open, mises, shear - shear_soft * g);
    s.drive = rg_select(open, rg_sqrt(k->C2 * (mean * mean) + k->E2 * (mises * mises)), g);
    s.tangent = rg_select(open, stiff, rg_select(closed, rg_splat(c->von_mises), sliding));
    return s;
}

/* Energy per volume (J/m^3): W is homogeneous of degree 2 in the stress. */
RG_INLINE rg_vec rg_de_stored(const rg_de_stress *s, rg_vec ekk, rg_vec eb) {
    return 0.5 * (s->mean * ekk + s->mises * eb);
}

/* log(dX/dt); e^-300 stands for no growth. */
RG_INLINE rg_vec rg_de_log_rate(const rg_de_constants *c, rg_vec drive) {
    rg_vec u = rg_log(rg_max(c->intensity * drive, rg_splat(1e-300)));
    return rg_min(c->log_rate + rg_max(c->exponent * u, rg_splat(-300.0)), rg_splat(c->log_cap));
}

/* X after dt of growth at constant strain, for the lanes in `wanted`; log_rate is log(dX/dt) at X, euler = dt
 * dX/dt. With phi = y/(dX/dt) a panel takes phi (exp(rise) - 1)/rise times its width in log y. */
RG_INLINE rg_vec rg_de_quadrature(const rg_de_constants *c, rg_vec X, rg_vec ekk, rg_vec eb, rg_vec log_rate,
                                  rg_vec euler, rg_mask wanted) {
    rg_vec y = X + c->offset, end = rg_min(X + c->reach, rg_splat(c->growth_max));
    rg_vec width = rg_log1p((end - X) / y) * (1.0 / RG_DE_PANELS), ratio = rg_exp(width);
    rg_vec time = rg_splat(1.0), unit = width * y / euler; /* in units of dt */
    rg_vec at = y, bend = {0}, left = {0}, rise = {0};
    rg_mask running = wanted; /* lanes whose time has not run out */
    for (int i = 0; i < RG_DE_PANELS && rg_any(running); i++) {
        if (i > 0) {
            unit *= rg_exp(rise);
        }
        rg_vec begin = y;
        y *= ratio;
        rg_de_cracks k = rg_de_cracks_at(c, y - c->offset);
        rg_de_stress s = rg_de_stress_at(c, &k, ekk, eb);
        rg_vec next = rg_de_log_rate(c, s.drive);
        rise = width - (next - log_rate);
        rise = rg_select(rise == 0.0, rg_splat(1e-30), rise);
        at = rg_select(running, begin, at);
        bend = rg_select(running, rise, bend);
        left = rg_select(running, time / unit, left);
        time -= unit * (rg_expm1(rise) / rise);
        running &= time >= 0.0;
        log_rate = next;
    }
    rg_vec part = rg_log1p(bend * left) / bend; /* of the panel */
    rg_vec grown = (at - c->offset) + at * rg_expm1(part * width);
    return rg_select(running, end, rg_min(rg_max(grown, X), end));
}

/* X at the end of the step; X itself where there is no growth. */
RG_INLINE rg_vec rg_de_grow(const rg_de_constants *c, rg_vec X, rg_vec ekk, rg_vec eb,
                            const rg_de_stress *s) {
    rg_mask growing = (s->drive > c->silent) & (X < c->growth_max);
    if (!rg_any(growing)) {
        return X;
    }
    rg_vec log_rate = rg_de_log_rate(c, s->drive), euler = c->dt * rg_exp(log_rate), y = X + c->offset;
    growing &= euler > RG_DE_NO_GROWTH * y;
    rg_mask large = growing & (euler > RG_DE_LITTLE * y);
    rg_vec grown = rg_select(growing, rg_min(X + euler, rg_splat(c->growth_max)), X);
    if (rg_any(large)) {
        grown = rg_select(large, rg_de_quadrature(c, X, ekk, eb, log_rate, euler, large), grown);
    }
    return grown;
}

/* ---- Plastic flow ---- */

/* (sY/2) ((ep/epsY)^M, and with 1 added */
RG_INLINE rg_vec rg_de_hardened(const rg_de_constants *c, rg_vec ep) {
    return c->half_yield * rg_pow(rg_max(ep * (1.0 / c->yield_strain), rg_splat(1e-300)), c->hardening);
}

/* Flow of one step at z = log dep. */
typedef struct {
    rg_vec z, dep;
    rg_vec hard;     /* hardening part of s0(ep + dep) (Pa) */
    rg_vec power, R; /* se/s0 at this rate, and its logarithm */
    rg_mask fast;    /* beyond the transition */
} rg_de_rate;

RG_INLINE rg_vec rg_de_power(const rg_de_constants *c, rg_vec z, rg_mask *beyond) {
    rg_vec rate = z - c->log_edot0_dt, slow = c->inv_n * rate, fast = rate - c->jump;
    *beyond = fast > slow;
    return rg_max(slow, fast);
}

RG_INLINE rg_de_rate rg_de_rate_at(const rg_de_constants *c, rg_vec ep, rg_vec z, rg_vec dep) {
    rg_de_rate f = {.z = z, .dep = dep};
    f.power = rg_de_power(c, z, &f.fast);
    f.hard = rg_de_hardened(c, ep + f.dep);
    f.R = rg_exp(f.power);
    return f;
}

/* Moves on to another z: by what changes where that is little, which saves two thirds of the operations. The
 * last time dep alone is wanted. */
RG_INLINE void rg_de_move(const rg_de_constants *c, rg_vec ep, rg_vec z, bool again, rg_de_rate *f) {
    rg_vec step = z - f->z, more = f->dep * rg_expm1_small(step);
    rg_mask large = rg_abs(step) > RG_SMALL, fast = f->fast;
    rg_de_rate near = {
        .z = z, .dep = f->dep + more, .power = f->power, .hard = f->hard, .R = f->R, .fast = fast};
    if (again) {
        near.power = rg_de_power(c, z, &near.fast);
        rg_vec harder = rg_log1p_small(more / (ep + f->dep));
        near.hard += f->hard * rg_expm1_small(c->hardening * harder);
        near.R += f->R * rg_expm1_small(near.power - f->power);
    }
    if (rg_any(large)) {
        rg_de_rate there = rg_de_rate_at(c, ep, z, rg_exp(z));
        near.dep = rg_select(large, there.dep, near.dep);
        near.hard = rg_select(large, there.hard, near.hard);
        near.R = rg_select(large, there.R, near.R);
    }
    *f = near;
}

/* Plastic strain of one step, dep: se(eb - dep) = s0(ep + dep) R(dep/dt). In z = log dep the right side less
 * the left one grows and, but for cracks that open, is convex: Newton's method comes down to the root from
 * above without overshoot. The upper end is the flow at the stress and the hardness before the step; the
 * start is where the stress relaxes to first order; a bracket guards the rest. 0 where less than
 * RG_DE_NO_FLOW. */
RG_INLINE rg_vec rg_de_flow(const rg_de_constants *c, const rg_de_cracks *k, rg_vec ekk, rg_vec eb, rg_vec ep,
                            const rg_de_stress *trial) {
    rg_vec ratio = rg_log(trial->mises / (c->half_yield + rg_de_hardened(c, ep)));
    rg_vec high = c->log_edot0_dt + rg_min(c->n * ratio, ratio + c->jump);
    rg_mask flows = high > -27.631021115928548; /* log RG_DE_NO_FLOW */
    if (!rg_any(flows)) {
        return (rg_vec){0};
    }
    rg_vec most = rg_exp(high);
    rg_mask beyond = most > eb;
    if (rg_any(beyond)) {
        most = rg_select(beyond, eb, most);
        high = rg_select(beyond, rg_log(eb), high);
    }
    rg_vec relaxes = c->n * trial->tangent * most / trial->mises; /* of log(rate), to first order */
    rg_vec low = high - 100.0, start = most / (1.0 + relaxes);
    rg_de_rate f = rg_de_rate_at(c, ep, rg_log(start), start);
    rg_mask moving = flows;
    for (int i = 0; i < RG_DE_NEWTON && rg_any(moving); i++) {
        rg_vec s0 = c->half_yield + f.hard;
        rg_vec slope = rg_select(f.fast, rg_splat(1.0), rg_splat(c->inv_n));
        rg_de_stress s = rg_de_stress_at(c, k, ekk, rg_max(eb - f.dep, rg_splat(0.0)));
        rg_vec g = s0 * f.R - s.mises;
        rg_vec dg = f.R * (s0 * slope + c->hardening * f.hard * (f.dep / (ep + f.dep))) + s.tangent * f.dep;
        high = rg_select(g > 0.0, f.z, high);
        low = rg_select(g > 0.0, low, f.z);
        rg_vec next = f.z - g / dg;
        next = rg_select((next >= low) & (next <= high), next, 0.5 * (low + high));
        next = rg_select(moving, next, f.z);
        moving &= rg_abs(next - f.z) > RG_DE_NEAR;
        rg_de_move(c, ep, next, rg_any(moving), &f);
    }
    return rg_select(flows, rg_min(f.dep, eb), rg_splat(0.0));
}

/* ---- The point ---- */

/* What a point gives besides its stress. */
typedef struct {
    rg_vec stiffening; /* bound on the acoustic tensor over lambda + 2 mu of the intact solid */
    rg_vec energy;     /* stored, at the end of the step, per reference volume (J/m^3) */
    rg_vec plastic;    /* released by flow in the step, >= 0 (J/m^3) */
    rg_vec damage;     /* released by growth of cracks in the step (J/m^3); can be negative, see the model */
} rg_de_result;

/* The point at a given history, which stays: first Piola-Kirchhoff stress P (Pa), nothing released. */
RG_INLINE rg_de_result rg_de_at_rest(const rg_de_constants *c, rg_vec F[3][3], rg_vec history[RG_DE_HISTORY],
                                     rg_vec P[3][3]) {
    rg_hencky d;
    rg_hencky_at(F, history + RG_DE_FLOW, &d);
    rg_de_cracks k = rg_de_cracks_at(c, history[RG_DE_GROWTH]);
    rg_de_stress s = rg_de_stress_at(c, &k, d.ekk, d.eb);
    rg_hencky_piola(s.mean, s.mises, &d, P);
    return (rg_de_result){.stiffening = rg_hencky_stiffening(c->p_modulus, c->von_mises, s.mean, s.mises, &d),
                          .energy = rg_de_stored(&s, d.ekk, d.eb)};
}

/* 1, 2 or 3; 0 where there is no stress. */
RG_INLINE rg_vec rg_de_regime(const rg_de_cracks *k, const rg_de_stress *s) {
    rg_vec regime = rg_select(s->drive > 0.0, rg_splat(2.0), rg_splat(1.0));
    regime = rg_select(s->mean >= k->open * s->mises, rg_splat(3.0), regime);
    return rg_select((s->mean == 0.0) & (s->mises == 0.0), rg_splat(0.0), regime);
}

/* Flow of one step with the cracks as they are: history, eb and stress after it; returns the energy released
 * and lowers the one stored by it. */
RG_INLINE rg_vec rg_de_relax(const rg_de_constants *c, const rg_de_cracks *k, rg_hencky *d,
                             rg_vec history[RG_DE_HISTORY], rg_vec *eb, rg_de_stress *s, rg_vec *energy) {
    rg_vec dep = rg_de_flow(c, k, d->ekk, *eb, history[RG_DE_STRAIN], s), released = {0};
    rg_mask flows = (s->mises > c->quiet) & (dep > 0.0);
    if (rg_any(flows)) {
        rg_hencky_flow(d, dep / *eb, history + RG_DE_FLOW, flows);
        history[RG_DE_STRAIN] = rg_select(flows, history[RG_DE_STRAIN] + dep, history[RG_DE_STRAIN]);
        *eb = rg_select(flows, *eb - dep, *eb);
        rg_de_stress after = rg_de_stress_at(c, k, d->ekk, *eb);
        rg_vec less = rg_de_stored(&after, d->ekk, *eb);
        released = rg_select(flows, *energy - less, released);
        *energy = rg_select(flows, less, *energy);
        s->mean = rg_select(flows, after.mean, s->mean);
        s->mises = rg_select(flows, after.mises, s->mises);
        s->drive = rg_select(flows, after.drive, s->drive);
    }
    return released;
}

/* Growth of one step with the strain as it is, likewise. */
RG_INLINE rg_vec rg_de_weaken(const rg_de_constants *c, rg_vec ekk, rg_vec eb, rg_vec *X, rg_de_stress *s,
                              rg_vec *energy) {
    rg_vec grown = rg_de_grow(c, *X, ekk, eb, s), released = {0};
    rg_mask grows = grown > *X;
    if (rg_any(grows)) {
        rg_de_cracks k = rg_de_cracks_at(c, grown);
        rg_de_stress after = rg_de_stress_at(c, &k, ekk, eb);
        rg_vec less = rg_de_stored(&after, ekk, eb);
        released = rg_select(grows, *energy - less, released);
        *energy = rg_select(grows, less, *energy);
        s->mean = rg_select(grows, after.mean, s->mean);
        s->mises = rg_select(grows, after.mises, s->mises);
        *X = rg_select(grows, grown, *X);
    }
    return released;
}

/* One step of the constants' dt that ends at F: updates the history and gives P (Pa) there. */
RG_INLINE rg_de_result rg_de_step(const rg_de_constants *c, rg_vec F[3][3], rg_vec history[RG_DE_HISTORY],
                                  rg_vec P[3][3]) {
    rg_hencky d;
    rg_hencky_at(F, history + RG_DE_FLOW, &d);
    rg_vec eb = d.eb;
    rg_de_cracks k = rg_de_cracks_at(c, history[RG_DE_GROWTH]);
    rg_de_stress s = rg_de_stress_at(c, &k, d.ekk, eb);
    rg_de_result out = {.energy = rg_de_stored(&s, d.ekk, eb)};
    if (rg_any(s.mises > c->quiet)) {
        out.plastic = rg_de_relax(c, &k, &d, history, &eb, &s, &out.energy);
    }
    out.damage = rg_de_weaken(c, d.ekk, eb, &history[RG_DE_GROWTH], &s, &out.energy);
    rg_hencky_piola(s.mean, s.mises, &d, P);
    out.stiffening = rg_hencky_stiffening(c->p_modulus, c->von_mises, s.mean, s.mises, &d);
    return out;
}

#endif
