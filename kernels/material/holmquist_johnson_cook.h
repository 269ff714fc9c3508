/* The Holmquist-Johnson-Cook concrete (T. J. Holmquist, G. R. Johnson & W. H. Cook, 14th Int. Symp.
 * Ballistics (1993) 591), at finite strain. With mu = 1/J - 1, p the pressure of Cauchy's stress, fc the
 * compressive strength, p* = p/fc and T* = T/fc:
 *
 *     strength s = fc (A (1 - D) + B p*^N) (1 + C max(0, log(rate/rate0))), at most fc S,  (1)
 *         fc A ((1 - D) + p/T) in place of the sum under tension: 0 at p = -T (1 - D)
 *     dD = (dep + dmup)/ef, ef = D1 (p* + T*)^D2, not below ef0; D at most 1               (2)
 *     p not below -T (1 - D), and by the largest m that mu has come to:                    (3)
 *         K mu                      elastic, up to m = mu_c = P_c/K
 *         P_c + K_t (m - mu_c)      as pores close, m = mu, up to P_l;
 *         less K_u (m - mu)         back from there, K_u = (1 - F) K + F K1, F = (m - mu_c)/(mu_m - mu_c)
 *         K1 x + (K2 x^2 + K3 x^3 where x > 0)   of the dense solid, from m = mu_m on,
 *             x = (mu - mu_l)/(1 + mu_l), where mu_m is mu at P_l: there and back alike.
 *
 * mup, the plastic part of mu, is where (3) has no pressure: m - p/K_u, and mu_l of the dense solid.
 *
 * Frame. As material/johnson_holmquist.h: the deviator from the Hencky strain of F Fp^-1, stored energy 3G/2
 * eb^2; the pressure a function of J and m. With y = (1 + mup) J and x = 1/y - 1 all of (3) that can be
 * undone is b x + (c x^2 + d x^3 where x > 0), b = K_u (1 + mup) as long as there are pores, and the energy
 * per reference volume
 *
 *     Wv = (b (y - 1 - log y) + c (x + 2 log y - y + 1) + d (x^2/2 - 2x - 3 log y + y - 1))/(1 + mup),   (4)
 *
 * and beyond the tensile limit T (1 - D) times what y grows by. So the solid is hyperelastic between its
 * updates and rotations of space change nothing.
 *
 * One step closes pores first: m goes up to mu. What that sets free is the work of the loading curve between
 * both m less what (4) at them has grown by: exact, whatever the step. At m = mu_m the solid changes to the
 * curve of the dense one, which stores somewhat more, as the published curves have it. Then (1) and (2) are
 * solved together at the pressure of the step, linear in dep: 3G (eb - dep) = a - (D + dep/ef) b, unless S
 * bounds it. The rate is that of the whole deviator, from the elastic strain that the last step left, where
 * that flowed. `plastic` is the work of flow, from the stress before it to that after it, and that of the
 * pores; `damage` what a falling tensile limit takes from (4).
 *
 * A lane's result depends on that lane alone: parts that only some lanes need are entered if any lane needs
 * them, and other lanes keep their bits. */
#ifndef RG_HOLMQUIST_JOHNSON_COOK_H
#define RG_HOLMQUIST_JOHNSON_COOK_H

#include "element/material_point.h"
#include "material/hencky.h"

#define RG_HJC_LEAST 1e-300 /* of what is raised to a power or divides: stands for 0 */

/* What a point needs of the parameters. */
typedef struct {
    double bulk, shear3, p_modulus;         /* K, 3G, lambda + 2 mu (Pa) */
    double crush, range, inv_range;         /* mu_c, mu_m - mu_c */
    double pressure, rise;                  /* P_c, K_t (Pa) */
    double dense, bulk1, bulk2, bulk3;      /* 1 + mu_l; K1, K2, K3 (Pa) */
    double tension, inv_unit;               /* T (Pa), 1/fc */
    double cohesion, crushed, limit;        /* fc A, fc B, fc S (infinite: none) (Pa) */
    double crushed_power;                   /* N */
    double fracture, fracture_power, least; /* D1, D2, ef0 */
    double rate, inv_rate;                  /* C, 1/(rate0 dt) */
} rg_hjc_constants;

RG_INLINE rg_hjc_constants rg_hjc_constants_of(const rg_material *m) {
    const double *given = m->of.parameter, unit = given[RG_PARAMETER_COMPRESSIVE_STRENGTH];
    const double limit = given[RG_PARAMETER_LARGEST_STRENGTH];
    const rg_hjc_pores *pores = &m->of.holmquist_johnson_cook.pores;
    return (rg_hjc_constants){
        .bulk = m->lambda + 2.0 / 3 * m->mu,
        .shear3 = 3 * m->mu,
        .p_modulus = m->lambda + 2 * m->mu,
        .crush = pores->crush,
        .range = pores->range,
        .inv_range = 1 / pores->range,
        .pressure = given[RG_PARAMETER_CRUSH_PRESSURE],
        .rise = pores->rise,
        .dense = 1 + given[RG_PARAMETER_LOCK_STRAIN],
        .bulk1 = given[RG_PARAMETER_BULK_1],
        .bulk2 = given[RG_PARAMETER_BULK_2],
        .bulk3 = given[RG_PARAMETER_BULK_3],
        .tension = given[RG_PARAMETER_TENSILE_LIMIT],
        .inv_unit = 1 / unit,
        .cohesion = unit * given[RG_PARAMETER_COHESIVE_STRENGTH],
        .crushed = unit * given[RG_PARAMETER_CRUSHED_STRENGTH],
        .limit = limit > 0 ? unit * limit : __builtin_inf(),
        .crushed_power = given[RG_PARAMETER_CRUSHED_POWER],
        .fracture = given[RG_PARAMETER_FAILURE_STRAIN],
        .fracture_power = given[RG_PARAMETER_FAILURE_POWER],
        .least = given[RG_PARAMETER_LEAST_FAILURE_STRAIN],
        .rate = given[RG_PARAMETER_RATE_SENSITIVITY],
        .inv_rate = 1 / (given[RG_PARAMETER_REFERENCE_RATE] * m->dt),
    };
}

/* x^power of x >= 0. */
RG_INLINE rg_vec rg_hjc_power(rg_vec x, double power) {
    return rg_pow(rg_max(x, rg_splat(RG_HJC_LEAST)), power);
}

/* ---- Pressure ---- */

/* What can be undone of (3): 1 + mup and its inverse; b, c, d (Pa). */
typedef struct {
    rg_vec packed, spare, bulk, square, cube;
} rg_hjc_curve;

/* At m = mu_c + closed. */
RG_INLINE rg_hjc_curve rg_hjc_curve_at(const rg_hjc_constants *c, rg_vec closed) {
    rg_vec zero = rg_splat(0.0), one = rg_splat(1.0);
    if (!rg_any(closed > 0.0)) {
        return (rg_hjc_curve){one, one, rg_splat(c->bulk), zero, zero};
    }
    rg_mask dense = closed >= c->range;
    rg_vec slope = c->bulk + (closed * c->inv_range) * (c->bulk1 - c->bulk);
    rg_vec packed = 1.0 + ((closed + c->crush) - (c->rise * closed + c->pressure) / slope);
    packed = rg_select(dense, rg_splat(c->dense), rg_select(closed > 0.0, packed, one));
    return (rg_hjc_curve){
        .packed = packed,
        .spare = 1.0 / packed,
        .bulk = rg_select(dense, rg_splat(c->bulk1), slope * packed),
        .square = rg_select(dense, rg_splat(c->bulk2), zero),
        .cube = rg_select(dense, rg_splat(c->bulk3), zero),
    };
}

/* Without the tensile limit, and how it grows with mu. */
RG_INLINE rg_vec rg_hjc_pressure(const rg_hjc_curve *k, rg_vec inv_J, rg_vec *modulus) {
    rg_vec x = (inv_J - k->packed) * k->spare, pressed = rg_max(x, rg_splat(0.0));
    *modulus = (k->bulk + pressed * (2.0 * k->square + (3.0 * k->cube) * pressed)) * k->spare;
    return k->bulk * x + (pressed * pressed) * (k->square + k->cube * pressed);
}

/* (4) at J, where `hold` = T (1 - D). */
RG_INLINE rg_vec rg_hjc_stored(const rg_hjc_curve *k, rg_vec J, rg_vec hold) {
    rg_vec y = J * k->packed, most = k->bulk / (k->bulk - hold); /* y where the pressure stays */
    rg_vec at = rg_min(y, most), less = at - 1.0, x = 1.0 / at - 1.0, less_log;
    rg_vec log_y = rg_log_beside_1(less, at, &less_log);
    rg_vec two = x + 2.0 * log_y - less, three = x * (0.5 * x - 2.0) - 3.0 * log_y + less;
    rg_vec more = rg_select(x > 0.0, k->square * two + k->cube * three, rg_splat(0.0));
    return k->spare * (k->bulk * less_log + more + hold * (y - at));
}

/* ---- A step ---- */

/* A point on its way through it. */
typedef struct {
    rg_hencky d;
    rg_hjc_curve curve;
    rg_vec hold;    /* T (1 - D) */
    rg_vec free, p; /* pressure without and with the tensile limit */
    rg_vec modulus, mises;
    rg_vec damage;    /* D, by the pores that the step closed */
    rg_vec a, b, now; /* J s of no damage, by how much a damage of 1 lowers it; of `damage`, before flow */
    rg_vec most;      /* J fc S */
    rg_mask flows;
    bool flowing;
} rg_hjc_point;

RG_INLINE void rg_hjc_press(rg_hjc_point *p) {
    p->free = rg_hjc_pressure(&p->curve, p->d.inv_J, &p->modulus);
    p->p = rg_max(p->free, -p->hold);
}

RG_INLINE void rg_hjc_begin(const rg_hjc_constants *c, rg_vec F[3][3], rg_vec history[RG_HJC_HISTORY],
                            rg_hjc_point *p) {
    rg_hencky_at(F, history + RG_HJC_FLOW, &p->d);
    p->curve = rg_hjc_curve_at(c, history[RG_HJC_CLOSED]);
    p->damage = history[RG_HJC_DAMAGE];
    p->hold = c->tension * (1.0 - p->damage);
    rg_hjc_press(p);
    p->mises = c->shear3 * p->d.eb;
    p->flowing = false;
}

/* ef of (2). */
RG_INLINE rg_vec rg_hjc_failure_strain(const rg_hjc_constants *c, rg_vec p) {
    rg_vec relative = rg_max((p + c->tension) * c->inv_unit, rg_splat(0.0));
    return rg_max(c->fracture * rg_hjc_power(relative, c->fracture_power),
                  rg_splat(c->least > RG_HJC_LEAST ? c->least : RG_HJC_LEAST));
}

/* Pores close, if they do: the curve and its pressure after it, the damage of that, and what it sets free. */
RG_INLINE rg_vec rg_hjc_close(const rg_hjc_constants *c, rg_vec history[RG_HJC_HISTORY], rg_hjc_point *p) {
    rg_vec *closed = &history[RG_HJC_CLOSED], zero = rg_splat(0.0);
    rg_vec to = rg_min(p->d.inv_J - (1 + c->crush), rg_splat(c->range));
    rg_mask closes = to > *closed;
    if (!rg_any(closes)) {
        return zero;
    }
    to = rg_select(closes, to, *closed);
    const rg_hjc_curve before = p->curve;
    rg_vec from = (1 + c->crush) + *closed, end = (1 + c->crush) + to; /* 1 + m */
    rg_vec inv_from = 1.0 / from, inv_end = 1.0 / end;
    p->curve = rg_hjc_curve_at(c, to);
    rg_vec work = c->rise * rg_log(end * inv_from) +
                  (c->pressure - c->rise * (1 + c->crush)) * ((to - *closed) * (inv_from * inv_end));
    work -= rg_hjc_stored(&p->curve, inv_end, zero) - rg_hjc_stored(&before, inv_from, zero);
    rg_vec lost = rg_max(p->curve.packed - before.packed, zero); /* dmup */
    rg_hjc_press(p);
    rg_vec grown = rg_min(p->damage + lost / rg_hjc_failure_strain(c, p->p), rg_splat(1.0));
    p->damage = rg_select(closes, grown, p->damage);
    *closed = to;
    return rg_select(closes, work, zero);
}

/* Strength at the pressure of the step, and whether the solid flows; the rate matters where it does. */
RG_INLINE void rg_hjc_strength(const rg_hjc_constants *c, rg_vec history[RG_HJC_HISTORY], rg_hjc_point *p) {
    rg_vec J = p->d.J, pulled = (c->cohesion / c->tension) * rg_min(p->p, rg_splat(0.0));
    p->b = J * c->cohesion;
    p->a = p->b + J * pulled;
    p->most = J * c->limit;
    rg_vec least = rg_min(p->a - p->damage * p->b, p->most);
    if (!rg_any(p->mises > 0.999 * least)) { /* pressure adds to it */
        return;
    }
    rg_vec more = c->crushed * rg_hjc_power(p->p * c->inv_unit, c->crushed_power);
    p->a += J * rg_select(p->p > 0.0, more, rg_splat(0.0));
    p->now = rg_max(rg_min(p->a - p->damage * p->b, p->most), rg_splat(0.0));
    p->flows = p->mises > p->now;
    p->flowing = rg_any(p->flows);
    if (p->flowing && c->rate > 0) {
        rg_vec last = history[RG_HJC_LAST];
        rg_vec gained = rg_select(last > 0.0, p->d.eb - last, p->d.eb - p->now * (1 / c->shear3));
        rg_vec speed = 1.0 + c->rate * rg_log(rg_max(gained * c->inv_rate, rg_splat(1.0)));
        p->a *= speed;
        p->b *= speed;
        p->now = rg_max(rg_min(p->a - p->damage * p->b, p->most), rg_splat(0.0));
        p->flows &= p->mises > p->now;
        p->flowing = rg_any(p->flows);
    }
}

/* Flow and its damage; its work. */
RG_INLINE rg_vec rg_hjc_flow(const rg_hjc_constants *c, rg_vec history[RG_HJC_HISTORY], rg_hjc_point *p) {
    rg_vec *last = &history[RG_HJC_LAST], zero = rg_splat(0.0), one = rg_splat(1.0);
    rg_vec strain = rg_hjc_failure_strain(c, p->p), over = p->mises - (p->a - p->damage * p->b);
    rg_vec steep = c->shear3 * strain - p->b;
    rg_vec grown = rg_select(steep > 0.0, rg_min(p->damage + over / steep, one), one);
    rg_vec after = p->a - grown * p->b;
    rg_mask bounded = (after > p->most) | (after < 0.0); /* then the strength does not fall with D */
    after = rg_max(rg_min(after, p->most), zero);
    rg_vec dep = (p->mises - after) * (1 / c->shear3);
    grown = rg_select(bounded, rg_min(p->damage + dep / strain, one), grown);
    rg_vec start = rg_select(*last > 0.0, c->shear3 * *last, p->now);
    rg_hencky_flow(&p->d, dep / rg_select(p->flows, p->d.eb, one), history + RG_HJC_FLOW, p->flows);
    history[RG_HJC_STRAIN] += rg_select(p->flows, dep, zero);
    p->damage = rg_select(p->flows, grown, p->damage);
    *last = after * (1 / c->shear3);
    p->mises = rg_select(p->flows, after, p->mises);
    return rg_select(p->flows, 0.5 * dep * (start + after), zero);
}

/* The tensile limit of the damage after the step; what its fall takes from the stored energy. */
RG_INLINE rg_vec rg_hjc_release(const rg_hjc_constants *c, rg_vec history[RG_HJC_HISTORY], rg_hjc_point *p) {
    rg_vec hold = c->tension * (1.0 - p->damage), lost = rg_splat(0.0);
    rg_mask falls = (p->damage > history[RG_HJC_DAMAGE]) & (p->free < -hold);
    if (rg_any(falls)) {
        lost = rg_hjc_stored(&p->curve, p->d.J, p->hold) - rg_hjc_stored(&p->curve, p->d.J, hold);
        lost = rg_select(falls, lost, rg_splat(0.0));
    }
    history[RG_HJC_DAMAGE] = p->damage;
    p->hold = hold;
    p->p = rg_max(p->free, -hold);
    return lost;
}

/* P (Pa) and `out` at F; history goes on if `advance`. */
RG_INLINE void rg_hjc_step(const rg_material *m, bool advance, rg_vec F[3][3], rg_vec history[RG_HJC_HISTORY],
                           rg_vec P[3][3], rg_point *out) {
    const rg_hjc_constants c = rg_hjc_constants_of(m);
    rg_hjc_point p;
    rg_hjc_begin(&c, F, history, &p);
    out->released[RG_RELEASED_PLASTIC] = out->released[RG_RELEASED_DAMAGE] = (rg_vec){0};
    if (advance) {
        out->released[RG_RELEASED_PLASTIC] = rg_hjc_close(&c, history, &p);
        rg_hjc_strength(&c, history, &p);
        if (p.flowing) {
            out->released[RG_RELEASED_PLASTIC] += rg_hjc_flow(&c, history, &p);
        }
        history[RG_HJC_LAST] =
            p.flowing ? rg_select(p.flows, history[RG_HJC_LAST], rg_splat(0.0)) : (rg_vec){0};
        out->released[RG_RELEASED_DAMAGE] = rg_hjc_release(&c, history, &p);
    }
    rg_vec mean = -p.p * p.d.J, stiffer = rg_max(p.modulus - c.bulk, rg_splat(0.0));
    rg_hencky_piola(mean, p.mises, &p.d, P);
    /* what closed pores add to the bulk modulus counts like a pressure */
    out->stiffening = rg_hencky_stiffening(c.p_modulus, c.shear3, mean - stiffer, p.mises, &p.d);
}

#endif
