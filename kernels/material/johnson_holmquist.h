/* The Johnson-Holmquist model of a ceramic (JH-2: G. R. Johnson & T. J. Holmquist, AIP Conf. Proc. 309 (1994)
 * 981; D. S. Cronin and others, 4th European LS-DYNA Users Conf. (2003), D-I-47), at finite strain. With
 * mu = 1/J - 1, p the pressure of Cauchy's stress, p* = p/P_HEL, T* = T/P_HEL and s_HEL = 3/2 (HEL - P_HEL):
 *
 *     p = K1 mu + (K2 mu^2 + K3 mu^3 where mu > 0) + dp, not below -T (1 - D)      (1)
 *     strength s = s_HEL ((1 - D) si* + D sf*) (1 + C max(0, log(rate/rate0)))     (2)
 *     si* = A (p* + T*)^N,  sf* = B p*^M, at most S and si*; 0 of negative numbers (3)
 *     dD = dep/ef,  ef = D1 (p* + T*)^D2, D at most 1                              (4)
 *     bulking: (K1 mu + dp)^2/2K1 grows by beta dU, dU what (2) loses of s^2/6G    (5)
 *
 * Frame. The deviator is that of J2 in Hencky strain of F Fp^-1 (material/hencky.h): stored energy 3G/2 eb^2,
 * which is the s^2/6G of (5), tau' = 2G e'. So the solid is hyperelastic between its updates, rotations of
 * space change nothing, whatever the step, and no stress is stored or turned. The strength (2) is Cauchy's,
 * so eb goes up to J s/3G. The pressure is a function of J, as published, and so has an energy per reference
 * volume as well (tau = -J p I):
 *
 *     Wv = int p0(mu)/(1 + mu)^2 dmu + dp (1 - J) + dp^2/2K1,                      (6)
 *
 * and beyond the tensile limit, where the pressure stays as J grows, T (1 - D) times what J grows by.
 *
 * One step, at fixed F and with the pressure of its beginning, solves (2) and (4) together: with x = dep both
 * are linear, 3G (eb - x) = a - (D + x/ef) (a - f), a and f J s of the intact and of the crushed solid. Where
 * the loss of strength outruns the elastic unloading (3G ef <= a - f) D is 1 at once. The rate is that of the
 * whole deviator, as published: from the elastic strain that the last step left, where that flowed, to the
 * one before flow. Then (5), per reference volume: dU is by how much flow at a strength that fell released
 * more of the stored energy. What a step releases is the work of flow from the stress before it to that after
 * it (`plastic`) and the fall of (6) at this J (`damage`: negative where bulking stores, at most beta dU of
 * what flow set free, as 1 - J <= mu). A pair with what is stored, whatever the step; the ledger closes to
 * second order where strength varies smoothly, to first where it is lost at once.
 *
 * Where strength is lost at once this is not the published bookkeeping, which goes on in steps after the loss
 * has begun: each takes dU from (2) at a pressure that the dp of the last one has raised, though the stress
 * has not followed. In the published test with D1 = 0.005 that stores 9.8 MJ/m3 while flow sets free 8.6,
 * whatever the step: 5 % of HEL more pressure, of energy that is not there.
 *
 * A lane's result depends on that lane alone: parts that only some lanes need are entered if any lane needs
 * them, and other lanes keep their bits. */
#ifndef RG_JOHNSON_HOLMQUIST_H
#define RG_JOHNSON_HOLMQUIST_H

#include "element/material_point.h"
#include "material/hencky.h"

#define RG_JH_LEAST 1e-300 /* of what is raised to a power: stands for 0 */

/* What a point needs of the parameters. */
typedef struct {
    double bulk, bulk2, bulk3, shear3, p_modulus; /* K1, K2, K3, 3G, lambda + 2 mu (Pa) */
    double tension, inv_pressure;                 /* T (Pa), 1/P_HEL */
    double intact, crushed, limit;                /* s_HEL A, s_HEL B, s_HEL S (infinite: none) (Pa) */
    double intact_power, crushed_power;           /* N, M */
    double fracture, fracture_power;              /* D1, D2 */
    double bulking;                               /* beta */
    double rate, inv_unit;                        /* C, 1/(rate0 dt) */
} rg_jh_constants;

RG_INLINE rg_jh_constants rg_jh_constants_of(const rg_material *m) {
    const double *given = m->of.parameter, pressure = given[RG_PARAMETER_HUGONIOT_PRESSURE];
    double unit = 1.5 * (given[RG_PARAMETER_HUGONIOT_LIMIT] - pressure);
    double limit = given[RG_PARAMETER_CRUSHED_LIMIT];
    return (rg_jh_constants){
        .bulk = m->lambda + 2.0 / 3 * m->mu,
        .bulk2 = given[RG_PARAMETER_BULK_2],
        .bulk3 = given[RG_PARAMETER_BULK_3],
        .shear3 = 3 * m->mu,
        .p_modulus = m->lambda + 2 * m->mu,
        .tension = given[RG_PARAMETER_TENSILE_LIMIT],
        .inv_pressure = 1 / pressure,
        .intact = unit * given[RG_PARAMETER_INTACT_STRENGTH],
        .crushed = unit * given[RG_PARAMETER_CRUSHED_STRENGTH],
        .limit = limit > 0 ? unit * limit : __builtin_inf(),
        .intact_power = given[RG_PARAMETER_INTACT_POWER],
        .crushed_power = given[RG_PARAMETER_CRUSHED_POWER],
        .fracture = given[RG_PARAMETER_FAILURE_STRAIN],
        .fracture_power = given[RG_PARAMETER_FAILURE_POWER],
        .bulking = given[RG_PARAMETER_BULKING],
        .rate = given[RG_PARAMETER_RATE_SENSITIVITY],
        .inv_unit = 1 / (given[RG_PARAMETER_REFERENCE_RATE] * m->dt),
    };
}

/* ---- Pressure ---- */

/* Of an intact solid without bulking, and how it grows with mu. */
RG_INLINE rg_vec rg_jh_pressure(const rg_jh_constants *c, rg_vec mu, rg_vec *modulus) {
    rg_vec pressed = rg_max(mu, rg_splat(0.0));
    *modulus = c->bulk + pressed * (2 * c->bulk2 + (3 * c->bulk3) * pressed);
    return c->bulk * mu + (pressed * pressed) * (c->bulk2 + c->bulk3 * pressed);
}

/* (6) at J, where `bulked` and `hold` = T (1 - D) are as they are. */
RG_INLINE rg_vec rg_jh_stored(const rg_jh_constants *c, rg_vec J, rg_vec bulked, rg_vec hold) {
    rg_vec most = 1.0 / (1.0 - (hold + bulked) * (1 / c->bulk)); /* J where the pressure stays */
    rg_vec at = rg_min(J, most), y = at - 1.0, mu = 1.0 / at - 1.0, less_log;
    rg_vec log_J = rg_log_beside_1(y, at, &less_log), pressed = rg_max(mu, rg_splat(0.0));
    rg_vec two = mu + 2.0 * log_J - y;
    rg_vec three = mu * (0.5 * mu - 2.0) - 3.0 * log_J + y;
    rg_vec more = rg_select(pressed > 0.0, c->bulk2 * two + c->bulk3 * three, rg_splat(0.0));
    return c->bulk * less_log + more - bulked * y + bulked * bulked * (0.5 / c->bulk) + hold * (J - at);
}

/* ---- Strength and flow ---- */

/* x^power of x >= 0. */
RG_INLINE rg_vec rg_jh_power(rg_vec x, double power) {
    return rg_pow(rg_max(x, rg_splat(RG_JH_LEAST)), power);
}

/* A point on its way through a step. */
typedef struct {
    rg_hencky d;
    rg_vec bulked, hold; /* dp; T (1 - D) */
    rg_vec free, p;      /* pressure without and with the tensile limit */
    rg_vec modulus, mises;
    rg_vec relative, a, f, now; /* p* + T*; J s intact, crushed and at the damage before the step */
    rg_mask flows;
    bool flowing;
} rg_jh_point;

RG_INLINE void rg_jh_begin(const rg_jh_constants *c, rg_vec F[3][3], rg_vec history[RG_JH_HISTORY],
                           rg_jh_point *p) {
    rg_hencky_at(F, history + RG_JH_FLOW, &p->d);
    p->bulked = history[RG_JH_BULKING];
    p->hold = c->tension * (1.0 - history[RG_JH_DAMAGE]);
    p->free = rg_jh_pressure(c, p->d.inv_J - 1.0, &p->modulus) + p->bulked;
    p->p = rg_max(p->free, -p->hold);
    p->mises = c->shear3 * p->d.eb;
    p->flowing = false;
}

/* Strength at the pressure of the step, and whether the solid flows; the rate matters where it does. */
RG_INLINE void rg_jh_strength(const rg_jh_constants *c, rg_vec history[RG_JH_HISTORY], rg_jh_point *p) {
    rg_vec zero = rg_splat(0.0), D = history[RG_JH_DAMAGE], J = p->d.J;
    p->relative = (p->p + c->tension) * c->inv_pressure;
    if (c->intact_power <= 1) { /* x^N is then at least the smaller one of x and 1 */
        rg_vec least = (0.999 * c->intact) * (1.0 - D) * J * rg_min(p->relative, rg_splat(1.0));
        if (!rg_any(p->mises > least)) {
            return;
        }
    }
    p->a = J * rg_select(p->relative > 0.0, c->intact * rg_jh_power(p->relative, c->intact_power), zero);
    rg_vec f = c->crushed * rg_jh_power(p->p * c->inv_pressure, c->crushed_power);
    p->f = rg_select(p->p > 0.0, rg_min(J * rg_min(f, rg_splat(c->limit)), p->a), zero);
    p->now = p->a - D * (p->a - p->f);
    p->flows = p->mises > p->now;
    p->flowing = rg_any(p->flows);
    if (p->flowing && c->rate > 0) {
        rg_vec last = history[RG_JH_LAST];
        rg_vec gained = rg_select(last > 0.0, p->d.eb - last, p->d.eb - p->now * (1 / c->shear3));
        rg_vec speed = 1.0 + c->rate * rg_log(rg_max(gained * c->inv_unit, rg_splat(1.0)));
        p->a *= speed;
        p->f *= speed;
        p->now *= speed;
        p->flows &= p->mises > p->now;
        p->flowing = rg_any(p->flows);
    }
}

/* Flow, damage and bulking of one step; what they release. */
RG_INLINE void rg_jh_flow(const rg_jh_constants *c, rg_vec history[RG_JH_HISTORY], rg_jh_point *p,
                          rg_point *out) {
    rg_vec *D = &history[RG_JH_DAMAGE], *last = &history[RG_JH_LAST], zero = rg_splat(0.0);
    rg_vec strain =
        rg_select(p->relative > 0.0, c->fracture * rg_jh_power(p->relative, c->fracture_power), zero);
    rg_vec fall = p->a - p->f, over = p->mises - p->now, steep = c->shear3 * strain - fall;
    rg_vec grown = rg_select(steep > 0.0, rg_min(*D + over / steep, rg_splat(1.0)), rg_splat(1.0));
    rg_vec after = p->a - grown * fall, dep = (p->mises - after) * (1 / c->shear3);
    rg_vec start = rg_select(*last > 0.0, c->shear3 * *last, p->now);
    rg_vec lost = (p->now - after) * (p->now + after) * (0.5 / c->shear3); /* dU of (5) */
    rg_vec pressure = c->bulk * (p->d.inv_J - 1.0) + p->bulked;
    rg_vec square = pressure * pressure + (2 * c->bulking * c->bulk) * rg_max(lost, zero);
    rg_vec bulked = p->bulked + (rg_sqrt(square) - pressure);
    bulked = rg_select((lost > 0.0) & (pressure > 0.0), bulked, p->bulked);
    rg_vec hold = c->tension * (1.0 - grown);
    rg_vec kept = rg_jh_stored(c, p->d.J, bulked, hold) - rg_jh_stored(c, p->d.J, p->bulked, p->hold);
    out->released[RG_RELEASED_PLASTIC] = rg_select(p->flows, 0.5 * dep * (start + after), zero);
    out->released[RG_RELEASED_DAMAGE] = rg_select(p->flows, -kept, zero);
    rg_hencky_flow(&p->d, dep / rg_select(p->flows, p->d.eb, rg_splat(1.0)), history + RG_JH_FLOW, p->flows);
    history[RG_JH_STRAIN] += rg_select(p->flows, dep, zero);
    history[RG_JH_BULKING] = rg_select(p->flows, bulked, p->bulked);
    *D = rg_select(p->flows, grown, *D);
    *last = after * (1 / c->shear3);
    p->mises = rg_select(p->flows, after, p->mises);
    p->p = rg_select(p->flows, rg_max(p->free + (bulked - p->bulked), -hold), p->p);
}

/* P (Pa) and `out` at F; history goes on if `advance`. */
RG_INLINE void rg_jh_step(const rg_material *m, bool advance, rg_vec F[3][3], rg_vec history[RG_JH_HISTORY],
                          rg_vec P[3][3], rg_point *out) {
    const rg_jh_constants c = rg_jh_constants_of(m);
    rg_jh_point p;
    rg_jh_begin(&c, F, history, &p);
    out->released[RG_RELEASED_PLASTIC] = out->released[RG_RELEASED_DAMAGE] = (rg_vec){0};
    if (advance) {
        rg_jh_strength(&c, history, &p);
        if (p.flowing) {
            rg_jh_flow(&c, history, &p, out);
        }
        history[RG_JH_LAST] =
            p.flowing ? rg_select(p.flows, history[RG_JH_LAST], rg_splat(0.0)) : (rg_vec){0};
    }
    rg_vec mean = -p.p * p.d.J, stiffer = rg_max(p.modulus - c.bulk, rg_splat(0.0));
    rg_hencky_piola(mean, p.mises, &p.d, P);
    /* what compression adds to the bulk modulus counts like a pressure */
    out->stiffening = rg_hencky_stiffening(c.p_modulus, c.shear3, mean - stiffer, p.mises, &p.d);
}

#endif
