/* Drucker and Prager's solid (Q. Appl. Math. 10 (1952) 157) with a tension cut-off and a cap that hardens (F.
 * L. DiMaggio & I. S. Sandler, J. Eng. Mech. Div. ASCE 97 (1971) 935), at finite strain. With p the pressure
 * and q von Mises' part of Cauchy's stress:
 *
 *     cone     q <= k + a p, where p <= pa                                      (1)
 *     cut-off  p >= -T, T at most that of the cone's apex, k/a                  (2)
 *     cap      (p - pa)^2 + R^2 q^2 <= R^2 Q^2, where p > pa                    (3)
 *              Q = k + a pa, pb = pa + R Q: it begins where the cone ends
 *     pb = pb0 - P1 log(1 - ec/W), ec what the cap's flow has taken from the volume.  (4)
 *
 * Flow is along the normal on (2) and (3); on (1) the volume grows by b times the equivalent plastic strain.
 *
 * Frame. The deviator is that of J2 in the Hencky strain of F Fp^-1 (material/hencky.h), where Fp has a part
 * that keeps the volume and a volume exp(vp): stored energy K/2 (log J - vp)^2 + 3G/2 eb^2, so the mean of
 * tau is K (log J - vp). Strengths are those of Cauchy's stress, tau/J. So the solid is hyperelastic between
 * its updates, and rotations of space change nothing, whatever the step.
 *
 * One step at fixed F has q fall by 3G/J dep and p rise by K/J dvp. On cone and cut-off that is closed: dep
 * of the cone alone takes p to p1; the end has p1 within [-T, pa] and the smaller one of q and k + a p there,
 * which is right on the cone, on the cut-off, where both meet (the apex is such a point), and where cone and
 * cap meet, whose flow there has no volume. On the cap, the rise s of pb gives ec by (4), so p, so by the
 * normal q, and (3) is one equation, which falls with s: Newton's method in a bracket.
 *
 * What a step releases is the work of flow, by the trapezoidal rule from the stress before it, where that
 * flowed, to the one after: with the stored energy a pair, to second order in the step. All of it counts as
 * plastic.
 *
 * A lane's result depends on that lane alone: parts that only some lanes need are entered if any lane needs
 * them, and other lanes keep their bits. */
#ifndef RG_DRUCKER_PRAGER_H
#define RG_DRUCKER_PRAGER_H

#include "element/material_point.h"
#include "material/hencky.h"

enum { RG_DP_NEWTON = 100 }; /* steps at most; five or so */
/* Size of the last step in that of the bracket; q falls to 0 in a small part of it. */
#define RG_DP_NEAR 1e-13

/* What a point needs of the parameters. */
typedef struct {
    double bulk, shear3, p_modulus; /* K, 3G, lambda + 2 mu (Pa) */
    rg_dp_cone cone;
    double tension;                  /* T (Pa) */
    double cap, ratio;               /* pb0 (Pa; infinite: none), R */
    double per_cap;                  /* how pa grows with pb */
    double compaction, inv_pressure; /* W, 1/P1 */
} rg_dp_constants;

RG_INLINE rg_dp_constants rg_dp_constants_of(const rg_material *m) {
    const double *given = m->of.drucker_prager.given, cut = given[RG_PARAMETER_TENSION_CUTOFF];
    const rg_dp_cone *cone = &m->of.drucker_prager.cone;
    double apex = cone->slope > 0 ? cone->strength / cone->slope : __builtin_inf();
    double cap = given[RG_PARAMETER_CAP_PRESSURE], ratio = given[RG_PARAMETER_CAP_RATIO];
    return (rg_dp_constants){
        .bulk = m->lambda + 2.0 / 3 * m->mu,
        .shear3 = 3 * m->mu,
        .p_modulus = m->lambda + 2 * m->mu,
        .cone = *cone,
        .tension = cut > 0 && cut < apex ? cut : apex,
        .cap = cap > 0 ? cap : __builtin_inf(),
        .ratio = ratio,
        .per_cap = 1 / (1 + ratio * cone->slope),
        .compaction = given[RG_PARAMETER_COMPACTION],
        .inv_pressure = cap > 0 ? 1 / given[RG_PARAMETER_COMPACTION_PRESSURE] : 0,
    };
}

/* A point on its way through a step; pressures and strengths of Cauchy's stress. */
typedef struct {
    rg_hencky d;
    rg_vec p, q, bulk, shear3; /* stress before flow; K/J, 3G/J */
    rg_vec to_p, to_q;         /* after it */
    rg_vec ends, top;          /* pa, Q before the step */
    rg_vec rises;              /* of pb in the step */
    rg_mask flows, caps;
} rg_dp_point;

RG_INLINE bool rg_dp_has_cap(const rg_dp_constants *c) {
    return c->cap < __builtin_inf();
}

/* (3) over R, as the stress is after pb has risen by s, and how it grows with s. */
typedef struct {
    rg_vec x, q, over, slope; /* p - pa and q at the end */
} rg_dp_cap;

/* `beyond` = p - pa of the trial; `left` = W - ec before the step. */
RG_INLINE rg_dp_cap rg_dp_cap_at(const rg_dp_constants *c, const rg_dp_point *t, rg_vec beyond, rg_vec left,
                                 rg_vec s) {
    const double square = c->ratio * c->ratio, moves = c->per_cap;
    rg_vec lost, kept = rg_exp_and_less_1(-c->inv_pressure * s, &lost);
    rg_vec taken = -left * lost, by = left * kept * c->inv_pressure; /* ec in the step; over s */
    rg_dp_cap o;
    o.x = rg_max(beyond - t->bulk * taken - moves * s, rg_splat(0.0));
    rg_vec y = o.x + square * t->shear3 * taken, over_y = 1.0 / rg_max(y, rg_splat(1e-150));
    rg_vec dx = -t->bulk * by - moves, dy = dx + square * t->shear3 * by;
    o.q = t->q * o.x * over_y;
    rg_vec dq = t->q * (dx * y - o.x * dy) * (over_y * over_y);
    rg_vec length = rg_sqrt(o.x * o.x + square * (o.q * o.q));
    o.over = length - c->ratio * (t->top + c->cone.slope * moves * s);
    o.slope = (o.x * dx + square * (o.q * dq)) / rg_max(length, rg_splat(1e-150)) -
              c->ratio * c->cone.slope * moves;
    return o;
}

/* Flow on the cap, of lanes in `caps`. */
RG_INLINE void rg_dp_flow_on_cap(const rg_dp_constants *c, rg_vec rise, rg_dp_point *t) {
    rg_vec left = c->compaction * rg_exp(-c->inv_pressure * rise), beyond = t->p - t->ends;
    rg_vec low = rg_splat(0.0), high = beyond * (1 / c->per_cap), s = low, size = high;
    rg_mask moving = t->caps;
    for (int i = 0; i < RG_DP_NEWTON && rg_any(moving); i++) {
        rg_dp_cap at = rg_dp_cap_at(c, t, beyond, left, s);
        rg_mask below = at.over > 0.0;
        low = rg_select(moving & below, s, low);
        high = rg_select(moving & ~below, s, high);
        rg_vec next = s - at.over / at.slope;
        next = rg_select((next > low) & (next < high), next, 0.5 * (low + high));
        rg_vec step = next - s;
        s = rg_select(moving, next, s);
        moving &= rg_abs(step) > RG_DP_NEAR * size;
    }
    rg_dp_cap at = rg_dp_cap_at(c, t, beyond, left, s);
    rg_vec ends = t->ends + c->per_cap * s;
    t->rises = rg_select(t->caps, s, t->rises);
    t->to_p = rg_select(t->caps, ends + at.x, t->to_p);
    t->to_q = rg_select(t->caps, at.q, t->to_q);
}

/* Whether and where the solid flows at the trial stress; the end on cone and cut-off. */
RG_INLINE bool rg_dp_trial(const rg_dp_constants *c, rg_vec rise, rg_dp_point *t) {
    const double k = c->cone.strength, a = c->cone.slope, b = c->cone.dilation;
    rg_vec zero = rg_splat(0.0), over = rg_max(t->q - a * t->p - k, zero);
    t->caps = (rg_mask){0};
    t->ends = rg_splat(__builtin_inf());
    if (rg_dp_has_cap(c)) {
        t->ends = c->per_cap * (rise + (c->cap - c->ratio * k));
        t->top = k + a * t->ends;
        rg_vec beyond = t->p - t->ends, radius = c->ratio * t->top, high = c->ratio * t->q;
        t->caps = (beyond > 0.0) & (beyond * beyond + high * high > radius * radius);
        over = rg_select(beyond > 0.0, zero, over);
    }
    rg_vec p = t->p + (b * t->bulk) * (over / (t->shear3 + (a * b) * t->bulk));
    p = rg_max(rg_select(t->p > t->ends, t->p, rg_min(p, t->ends)), rg_splat(-c->tension));
    rg_mask cone = (over > 0.0) | (t->p < p);
    t->to_p = p;
    t->to_q = rg_select(cone, rg_min(t->q, k + a * p), t->q);
    t->flows = cone | t->caps;
    return rg_any(t->flows);
}

/* Flow of one step; what it releases, and the stress after it. */
RG_INLINE void rg_dp_flow(const rg_dp_constants *c, rg_vec history[RG_DP_HISTORY], rg_dp_point *t,
                          rg_vec *mean, rg_vec *mises, rg_point *out) {
    rg_vec zero = rg_splat(0.0), rise = history[RG_DP_RISE];
    t->rises = zero;
    if (rg_any(t->caps)) {
        rg_dp_flow_on_cap(c, rise, t);
    }
    rg_mask flows = t->flows;
    rg_vec dep = (t->q - t->to_q) / t->shear3, dvp = (t->to_p - t->p) / t->bulk;
    rg_vec mean_after = -t->to_p * t->d.J, mises_after = t->to_q * t->d.J;
    rg_mask flowed = (history[RG_DP_MEAN] != 0.0) | (history[RG_DP_MISES] != 0.0);
    rg_vec mean_before = rg_select(flowed, history[RG_DP_MEAN], mean_after);
    rg_vec mises_before = rg_select(flowed, history[RG_DP_MISES], mises_after);
    rg_vec work = 0.5 * (dep * (mises_before + mises_after) + dvp * (mean_before + mean_after));
    out->released[RG_RELEASED_PLASTIC] = rg_select(flows, work, zero);
    rg_vec size = rg_select(t->d.eb > 0.0, t->d.eb, rg_splat(1.0));
    rg_hencky_flow(&t->d, dep / size, history + RG_DP_FLOW, flows);
    history[RG_DP_STRAIN] += rg_select(flows, dep, zero);
    history[RG_DP_VOLUME] += rg_select(flows, dvp, zero);
    history[RG_DP_RISE] = rg_select(t->caps, rise + t->rises, rise);
    *mean = rg_select(flows, mean_after, *mean);
    *mises = rg_select(flows, mises_after, *mises);
}

/* P (Pa) and `out` at F; history goes on if `advance`. */
RG_INLINE void rg_dp_step(const rg_material *m, bool advance, rg_vec F[3][3], rg_vec history[RG_DP_HISTORY],
                          rg_vec P[3][3], rg_point *out) {
    const rg_dp_constants c = rg_dp_constants_of(m);
    rg_dp_point t;
    rg_hencky_at(F, history + RG_DP_FLOW, &t.d);
    rg_vec zero = rg_splat(0.0), mean = c.bulk * (t.d.ekk - history[RG_DP_VOLUME]), mises = c.shear3 * t.d.eb;
    rg_vec excess = rg_splat(1.0);
    out->released[RG_RELEASED_PLASTIC] = out->released[RG_RELEASED_DAMAGE] = zero;
    if (advance) {
        t.p = -mean * t.d.inv_J;
        t.q = mises * t.d.inv_J;
        t.bulk = c.bulk * t.d.inv_J;
        t.shear3 = c.shear3 * t.d.inv_J;
        bool flowing = rg_dp_trial(&c, history[RG_DP_RISE], &t);
        if (flowing) {
            rg_dp_flow(&c, history, &t, &mean, &mises, out);
            excess = rg_select(t.flows, rg_splat(1.0 + c.cone.excess), excess);
        }
        history[RG_DP_MEAN] = flowing ? rg_select(t.flows, mean, zero) : zero;
        history[RG_DP_MISES] = flowing ? rg_select(t.flows, mises, zero) : zero;
    }
    rg_hencky_piola(mean, mises, &t.d, P);
    out->stiffening = excess * rg_hencky_stiffening(c.p_modulus, c.shear3, mean, mises, &t.d);
}

#endif
