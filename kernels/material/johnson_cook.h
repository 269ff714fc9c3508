/* The Johnson-Cook metal, at finite strain: W = K/2 (log J)^2 + 3G/2 eb^2 of the Hencky strain of F Fp^-1
 * (material/hencky.h), as material/j2.h has it, with the flow stress (G. R. Johnson & W. H. Cook, 7th Int.
 * Symp. Ballistics, 1983)
 *
 *     s = (A + B ep^n) (1 + C max(0, log(rate/rate0))) (1 - T*^m),   T* = (T - T0)/(Tm - T0) in [0, 1],
 *
 * ep the equivalent plastic strain, `rate` its rate over the step, T0 the temperature to begin with. Flow
 * heats the point, which conducts none of it away: density c dT = chi times its work (Taylor & Quinney).
 *
 * One step is a radial return at the temperature before it: x = dep solves 3G (eb - x) = s(ep + x, x/dt) for
 * z = log(x/(rate0 dt)). In z the difference of both sides grows and is convex, so Newton's method comes down
 * to the root from an upper bound: the flow of a solid that neither hardens nor knows rates. What flow sets
 * free is its work by the trapezoidal rule over hardening, at the rate and temperature of the step: with it
 * the ledger closes to second order in the strain of a step, and to first order in the change of rate and
 * temperature in it. All of it counts as dissipated.
 *
 * The points of an element go together, so that while one waits for a logarithm others go on. A lane's result
 * depends on that lane alone: parts that only some lanes need are entered if any lane needs them, and other
 * lanes keep their bits. */
#ifndef RG_JOHNSON_COOK_H
#define RG_JOHNSON_COOK_H

#include "element/material_point.h"
#include "material/hencky.h"

enum { RG_JC_NEWTON = 100 }; /* steps at most; three or four in metals that flow already */
#define RG_JC_NEAR  1e-7     /* size of the last one in z: the next would be half its square or less */
#define RG_JC_LEAST 1e-300   /* plastic strain, or T*, that stands for none */

/* What a point needs of the parameters. */
typedef struct {
    double bulk, von_mises, p_modulus; /* K, 3G, lambda + 2 mu (Pa) */
    double yield, hardening, power;    /* A, B (Pa), n */
    double rate, unit;                 /* C; rate0 dt, the strain of a step at that rate */
    double softening, inv_range;       /* m, 0: none; 1/(Tm - T0) (1/K) */
    double heating, room;              /* chi/(density c) (K m^3/J); T0 (K) */
} rg_jc_constants;

RG_INLINE rg_jc_constants rg_jc_constants_of(const rg_material *m) {
    const double *given = m->of.parameter, capacity = given[RG_PARAMETER_HEAT_CAPACITY];
    double range = given[RG_PARAMETER_MELTING_TEMPERATURE] - given[RG_PARAMETER_ROOM_TEMPERATURE];
    return (rg_jc_constants){
        .bulk = m->lambda + 2.0 / 3 * m->mu,
        .von_mises = 3 * m->mu,
        .p_modulus = m->lambda + 2 * m->mu,
        .yield = given[RG_PARAMETER_YIELD_STRESS],
        .hardening = given[RG_PARAMETER_HARDENING_MODULUS],
        .power = given[RG_PARAMETER_HARDENING_POWER],
        .rate = given[RG_PARAMETER_RATE_SENSITIVITY],
        .unit = given[RG_PARAMETER_REFERENCE_RATE] * m->dt,
        .softening = given[RG_PARAMETER_SOFTENING_POWER],
        .inv_range = range > 0 ? 1 / range : 0,
        .heating = capacity > 0 ? given[RG_PARAMETER_HEAT_FRACTION] / (m->density * capacity) : 0,
        .room = given[RG_PARAMETER_ROOM_TEMPERATURE],
    };
}

/* 1 - T*^m at a rise of the temperature. */
RG_INLINE rg_vec rg_jc_soft(const rg_jc_constants *c, rg_vec rise) {
    rg_vec relative = rg_max(rg_min(rise * c->inv_range, rg_splat(1.0)), rg_splat(RG_JC_LEAST));
    return c->softening > 0 ? 1.0 - rg_pow(relative, c->softening) : rg_splat(1.0);
}

/* B ep^n. */
RG_INLINE rg_vec rg_jc_hard(const rg_jc_constants *c, rg_vec ep) {
    return c->hardening > 0 ? c->hardening * rg_pow(rg_max(ep, rg_splat(RG_JC_LEAST)), c->power)
                            : (rg_vec){0};
}

/* A point on its way through a step. */
typedef struct {
    rg_hencky d;
    rg_vec ep, soft, before;  /* before the step; A + B ep^n */
    rg_vec mises;             /* now */
    rg_vec z, x, hard, speed; /* x = dep, B (ep + x)^n, 1 + C max(0, z) */
    rg_mask flows, moving;
    bool flowing, going; /* some lane */
} rg_jc_point;

/* Newton's step in z. */
RG_INLINE void rg_jc_newton(const rg_jc_constants *c, rg_jc_point *p) {
    rg_vec curve = c->yield + p->hard, flow = p->soft * p->speed;
    rg_vec over = (c->von_mises * p->x - p->mises) + flow * curve;
    rg_vec slope = p->x * (c->von_mises + flow * (c->power * p->hard) / (p->ep + p->x));
    slope += rg_select(p->z > 0.0, c->rate * p->soft * curve, rg_splat(0.0));
    rg_vec step = over / slope;
    p->z = rg_select(p->moving, p->z - step, p->z);
    p->x = c->unit * rg_exp(p->z);
    p->speed = 1.0 + c->rate * rg_max(p->z, rg_splat(0.0));
    p->hard = rg_jc_hard(c, p->ep + p->x);
    p->moving &= rg_abs(step) > RG_JC_NEAR;
    p->going = rg_any(p->moving);
}

/* Whether it flows, and where the iteration starts. A point that was never hot keeps its yield stress. */
RG_INLINE void rg_jc_start(const rg_jc_constants *c, rg_vec history[RG_JC_HISTORY], rg_jc_point *p) {
    if (!rg_any((p->mises > c->yield) | (history[RG_JC_RISE] > 0.0))) {
        return;
    }
    p->ep = history[RG_JC_STRAIN];
    p->soft = rg_jc_soft(c, history[RG_JC_RISE]);
    p->before = c->yield + rg_jc_hard(c, p->ep);
    rg_vec over = p->mises - p->soft * p->before;
    p->flows = p->moving = over > 0.0;
    p->flowing = p->going = rg_any(p->flows);
    if (p->flowing) {
        p->x = rg_select(p->flows, over * (1 / c->von_mises), rg_splat(1.0));
        p->z = rg_log(p->x * (1 / c->unit));
        p->speed = 1.0 + c->rate * rg_max(p->z, rg_splat(0.0));
        p->hard = rg_jc_hard(c, p->ep + p->x);
    }
}

/* History and stress after it; the work that it dissipates (J/m^3). */
RG_INLINE rg_vec rg_jc_return(const rg_jc_constants *c, rg_vec history[RG_JC_HISTORY], rg_jc_point *p) {
    rg_vec dep = rg_select(p->flows, p->x, rg_splat(0.0)), none = rg_splat(0.0);
    rg_vec work = 0.5 * dep * (p->soft * p->speed) * (p->before + (c->yield + p->hard));
    work = rg_select(p->flows, work, none);
    rg_hencky_flow(&p->d, dep / rg_select(p->flows, p->d.eb, rg_splat(1.0)), history + RG_JC_FLOW, p->flows);
    history[RG_JC_STRAIN] += dep;
    history[RG_JC_RISE] += c->heating * work;
    p->mises = rg_select(p->flows, c->von_mises * (p->d.eb - dep), p->mises);
    return work;
}

/* P (Pa) and `out` at F[n], n <= RG_GAUSS; histories go on if `advance`. */
RG_INLINE void rg_jc_points(const rg_material *m, bool advance, int n, rg_vec F[][3][3],
                            rg_vec history[][RG_JC_HISTORY], rg_vec P[][3][3], rg_point out[]) {
    const rg_jc_constants c = rg_jc_constants_of(m);
    rg_jc_point p[RG_GAUSS];
    bool going = false;
    for (int g = 0; g < n; g++) {
        rg_hencky_at(F[g], history[g] + RG_JC_FLOW, &p[g].d);
        p[g].mises = c.von_mises * p[g].d.eb;
        p[g].flowing = p[g].going = false;
        out[g].released[RG_RELEASED_PLASTIC] = out[g].released[RG_RELEASED_DAMAGE] = (rg_vec){0};
    }
    for (int g = 0; advance && g < n; g++) {
        rg_jc_start(&c, history[g], &p[g]);
        going |= p[g].going;
    }
    for (int i = 0; i < RG_JC_NEWTON && going; i++) {
        going = false;
        for (int g = 0; g < n; g++) {
            if (p[g].going) {
                rg_jc_newton(&c, &p[g]);
                going |= p[g].going;
            }
        }
    }
    for (int g = 0; g < n; g++) {
        if (p[g].flowing) {
            out[g].released[RG_RELEASED_PLASTIC] = rg_jc_return(&c, history[g], &p[g]);
        }
        rg_vec mean = c.bulk * p[g].d.ekk;
        rg_hencky_piola(mean, p[g].mises, &p[g].d, P[g]);
        out[g].stiffening = rg_hencky_stiffening(c.p_modulus, c.von_mises, mean, p[g].mises, &p[g].d);
    }
}

#endif
