/* Deshpande-Evans ceramic at a point: material/deshpande_evans_model.h has the equations.
 *
 * Frame. The model is one of small strains; here its strain is the Hencky strain of F Fp^-1 and its stress
 * the Kirchhoff stress (material/hencky.h).
 *
 * One step at fixed F: plastic flow with the cracks as they are (backward Euler), then growth of the cracks
 * with the strain as it is. Both are relaxations at constant F, so what they release is exactly the fall of
 * the stored energy.
 *
 * Flow solves se(eb - dep) = s0(ep + dep) R(dep/dt) for z = log dep by Halley's method. Its start: with log
 * se and log s0 linear in dep, dep = (flow at the stress and hardness before the step) exp(-W(w)).
 *
 * Growth solves dt = int dX/(dX/dt) for its upper end instead of the differential equation: the rate falls by
 * many decades over a step, but it is not negative, so the time is a monotone function of X: no iteration, no
 * stability limit, no overshoot. The interval that the shear wave speed can reach is cut in RG_DE_PANELS
 * geometric panels in X + beta/alpha, on which (X + beta/alpha)/rate is a power.
 *
 * Sweeps. At a point each logarithm, exponential and quotient waits for the one before, and a processor sees
 * some 200 operations ahead: it would idle. So a step is made of short functions, and each goes over all
 * points of the element before the next one begins; while one point waits, others go on.
 *
 * Operations per point: kernels/cost/ceramic.h. Against the neo-Hookean bulk kernel of 1990 they make one of
 * 3350 where nothing happens, 5040 where cracks grow, 5540 where the solid flows, 7220 where it does both.
 *
 * A lane's result depends on that lane alone: parts that only some lanes need are entered if any lane needs
 * them, and other lanes keep their bits. */
#ifndef RG_DESHPANDE_EVANS_H
#define RG_DESHPANDE_EVANS_H

#include "layout.h"
#include "material/deshpande_evans_model.h"
#include "material/hencky.h"

enum { RG_DE_ITERATIONS = 8 }; /* of the flow's equation, at most; one or two where it is under way */
#define RG_DE_NEAR  2e-4       /* step in log dep that is the last one: its cube over 12 is left */
#define RG_DE_LEAST 1e-300     /* ep/epsY that stands for none */

/* ---- Cracks ---- */

typedef struct {
    rg_vec A, B, C2;
    rg_vec gap; /* C^2 - A^2; E^2 = B^2 C^2/gap */
} rg_de_cracks;

RG_INLINE rg_de_cracks rg_de_cracks_at(const rg_de_constants *c, rg_vec X) {
    rg_vec y = X + c->offset, size = X + 1.0, X2 = X * X;
    rg_vec root = y * rg_sqrt(y), apart = 1.0 - c->d0_23 * (size * size), both = 1.0 / (root * apart);
    rg_vec c1 = c->c1 * (both * apart), c2 = 1.0 + c->c2 * X2 * (both * root);
    rg_de_cracks k;
    k.A = c1 * (c2 * c->difference + c->c3 * X2);
    k.B = c1 * (c2 * c->sum + (c->c3 * 0.57735026918962576451) * X2);
    rg_vec more = c->gamma_root * rg_sqrt(size), C = k.A + more;
    k.C2 = C * C;
    k.gap = more * (C + k.A);
    return k;
}

/* Stress by eb = sqrt(2/3 e':e') where ekk = tr e and the cracks stay: linear in each regime. In I and II,
 * with g = A sm + B se, or 0 if that is negative: sm = K (ekk - 2 kappa A g), se = 3G (eb - 2 kappa B g). */
typedef struct {
    rg_vec elastic;                           /* K ekk */
    rg_vec pull, pull_rate;                   /* g = pull + pull_rate eb */
    rg_vec mean_loss, mises_loss;             /* -dsm/dg, -dse/dg */
    rg_vec open_mean, open_stiff, open_limit; /* III: sm, dse/deb; it begins at sm/eb */
    rg_vec mean_part, mises_part;             /* III: (K_I/sqrt(pi a))^2 over sm^2 and over eb^2 */
} rg_de_response;

RG_INLINE rg_de_response rg_de_response_at(const rg_de_constants *c, const rg_de_cracks *k, rg_vec ekk) {
    const double soft = c->crack_compliance;
    rg_de_response r = {.elastic = c->bulk * ekk, .mean_part = k->C2};
    r.mean_loss = (soft * c->bulk) * k->A;
    r.mises_loss = (soft * c->von_mises) * k->B;
    rg_vec slid = 1.0 + (r.mean_loss * k->A + r.mises_loss * k->B);
    rg_vec bulk_open = 1.0 + (soft * c->bulk) * k->C2, E2_gap = k->B * k->B * k->C2;
    rg_vec shear_open = k->gap + (soft * c->von_mises) * E2_gap; /* times gap */
    rg_vec open_both = bulk_open * shear_open, inverse = 1.0 / (slid * open_both);
    rg_vec stiff = c->von_mises * (bulk_open * (slid * inverse)); /* over gap */
    r.open_mean = r.elastic * (shear_open * (slid * inverse));
    r.open_stiff = stiff * k->gap;
    r.open_limit = k->A * k->B * stiff;
    r.mises_part = E2_gap * (stiff * r.open_stiff);
    r.pull = k->A * r.elastic * (open_both * inverse);
    r.pull_rate = c->von_mises * (k->B * (open_both * inverse));
    return r;
}

typedef struct {
    rg_vec mean, mises; /* sm, se (Pa) */
    rg_vec drive2;      /* (K_I/sqrt(pi a))^2 (Pa^2); 0 in regime I */
    rg_vec tangent;     /* dse/deb (Pa) */
} rg_de_stress;

RG_INLINE rg_de_stress rg_de_stress_at(const rg_de_constants *c, const rg_de_response *r, rg_vec eb) {
    rg_vec g = r->pull + r->pull_rate * eb, mises = r->open_stiff * eb;
    rg_mask open = r->open_mean >= r->open_limit * eb, closed = g <= 0.0;
    rg_de_stress s;
    g = rg_select(closed, rg_splat(0.0), g);
    s.mean = rg_select(open, r->open_mean, r->elastic - r->mean_loss * g);
    s.mises = rg_select(open, mises, c->von_mises * eb - r->mises_loss * g);
    s.drive2 =
        rg_select(open, r->mean_part * (r->open_mean * r->open_mean) + r->mises_part * (eb * eb), g * g);
    rg_vec sliding = c->von_mises - r->mises_loss * r->pull_rate;
    s.tangent = rg_select(open, r->open_stiff, rg_select(closed, rg_splat(c->von_mises), sliding));
    return s;
}

/* Energy per volume (J/m^3): W is homogeneous of degree 2 in the stress. */
RG_INLINE rg_vec rg_de_stored(const rg_de_stress *s, rg_vec ekk, rg_vec eb) {
    return 0.5 * (s->mean * ekk + s->mises * eb);
}

/* 1, 2 or 3; 0 where there is no stress. */
RG_INLINE rg_vec rg_de_regime(const rg_de_response *r, const rg_de_stress *s, rg_vec eb) {
    rg_vec regime = rg_select(s->drive2 > 0.0, rg_splat(2.0), rg_splat(1.0));
    regime = rg_select(r->open_mean >= r->open_limit * eb, rg_splat(3.0), regime);
    return rg_select((s->mean == 0.0) & (s->mises == 0.0), rg_splat(0.0), regime);
}

/* ---- A point on its way through a step ---- */

typedef struct {
    rg_vec ep;               /* before the step */
    rg_vec z, dep;           /* log of dep, the plastic strain of the step */
    rg_vec hard;             /* hardening part of s0(ep + dep) (Pa) */
    rg_vec R, power, slope;  /* se/s0 at this rate, its logarithm, and d log R/dz */
    rg_vec low, high;        /* bracket of z */
    rg_vec step, more, part; /* on the way to the next z: step in z, in dep, and that over ep + dep */
    rg_de_stress s;          /* at eb - dep */
    rg_mask flows, moving;
} rg_de_flow;

typedef struct {
    rg_vec y, width, ratio; /* X + beta/alpha; width of a panel in log y, and exp of that */
    rg_vec drive2;          /* at the panel's end */
    rg_vec log_rate, next;  /* log(dX/dt) at its beginning and end */
    rg_vec time, unit;      /* left; that of a panel at the rate of its beginning; over dt */
    rg_vec at, bend,
        left;          /* where time ends: y, and rise and time over unit of the panel that begins there */
    rg_vec end, grown; /* X that the shear wave speed can reach; X at the end of the step */
    rg_mask grows;
    rg_mask large, running; /* lanes that take the quadrature, and whose time has not run out */
} rg_de_growth;

typedef struct {
    rg_vec *history;
    rg_hencky d;
    rg_vec eb, energy, plastic, damage;
    rg_de_response r;
    rg_de_stress s;
    rg_de_flow flow;
    rg_de_growth growth;
    bool flowing, moving, growing, running; /* some lane */
} rg_de_point;

/* One sweep over the points p[n], of those that are `needed`. */
#define RG_DE_EACH(needed)                                                                                   \
    for (int g = 0; g < n; g++)                                                                              \
        if (p[g].needed)

/* ---- Functions of an argument that is small most of the time ---- */

RG_INLINE rg_vec rg_de_expm1(rg_vec x) {
    rg_mask large = rg_abs(x) > RG_SMALL;
    rg_vec y = rg_expm1_small(x);
    return rg_any(large) ? rg_select(large, rg_expm1(x), y) : y;
}

RG_INLINE rg_vec rg_de_log1p(rg_vec x) {
    rg_mask large = rg_abs(x) > RG_SMALL;
    rg_vec y = rg_log1p_small(x);
    return rg_any(large) ? rg_select(large, rg_log1p(x), y) : y;
}

/* (1 + x)^M - 1 */
RG_INLINE rg_vec rg_de_power_less_1(const rg_de_constants *c, rg_vec x) {
    rg_mask large = rg_abs(x) > RG_SMALL;
    rg_vec y = rg_polynomial(c->binomial, RG_DE_BINOMIAL, x) * x;
    return rg_any(large) ? rg_select(large, rg_expm1(c->hardening * rg_log1p(x)), y) : y;
}

/* ---- Plastic flow ---- */

/* log R of a rate, and d log R/dz. */
RG_INLINE rg_vec rg_de_power(const rg_de_constants *c, rg_vec z, rg_vec *slope) {
    rg_vec rate = z - c->log_edot0_dt, slow = c->inv_n * rate, fast = rate - c->jump;
    *slope = rg_select(fast > slow, rg_splat(1.0), rg_splat(c->inv_n));
    return rg_max(slow, fast);
}

/* The inverse: z, and dz/d log R. */
RG_INLINE rg_vec rg_de_log_flow(const rg_de_constants *c, rg_vec power, rg_vec *slope) {
    rg_vec slow = c->n * power, fast = power + c->jump;
    *slope = rg_select(fast < slow, rg_splat(1.0), rg_splat(c->n));
    return c->log_edot0_dt + rg_min(slow, fast);
}

/* Lambert's function: the W with W exp(W) = w, w >= 0. Pade approximant at 0, too small by 1 % at w = 1, half
 * of it at 100. */
RG_INLINE rg_vec rg_de_lambert(rg_vec w) {
    return w * (1.0 + (4.0 / 3) * w) / (1.0 + w * (7.0 / 3 + (5.0 / 6) * w));
}

/* Hardness before the step. */
RG_INLINE void rg_de_harden(const rg_de_constants *c, rg_de_point *p) {
    rg_de_flow *f = &p->flow;
    f->ep = rg_max(p->history[RG_DE_STRAIN], rg_splat(RG_DE_LEAST * c->yield_strain));
    f->hard = c->half_yield * rg_pow(f->ep * (1.0 / c->yield_strain), c->hardening);
}

/* Flow at the stress before the step. */
RG_INLINE void rg_de_trial(const rg_de_constants *c, rg_de_point *p) {
    rg_de_flow *f = &p->flow;
    f->R = p->s.mises / (c->half_yield + f->hard);
    f->power = rg_log(f->R);
    f->high = rg_de_log_flow(c, f->power, &f->slope);
    f->flows = f->moving = f->high > -27.631021115928548; /* log RG_DE_NO_FLOW */
    p->flowing = p->moving = rg_any(f->flows);
}

/* From there to where the iteration starts: log se falls by w/n over that flow, log s0 grows by it, and z
 * falls by W(w). The hardening is taken in the middle. */
RG_INLINE void rg_de_start_flow(const rg_de_constants *c, rg_de_point *p) {
    rg_de_flow *f = &p->flow;
    rg_vec most = rg_exp(f->high), trial = f->high;
    rg_mask beyond = most > p->eb;
    if (rg_any(beyond)) {
        most = rg_select(beyond, p->eb, most);
        f->high = rg_select(beyond, rg_log(p->eb), f->high);
    }
    rg_vec hardness = (c->half_yield + f->hard) * (f->ep + 0.5 * most);
    rg_vec softer = p->s.tangent * hardness + (c->hardening * p->s.mises) * f->hard;
    rg_vec fall = rg_de_lambert(f->slope * most * softer / (p->s.mises * hardness));
    f->low = f->high - 100.0;
    f->z = trial;
    f->step = (f->high - fall) - trial;
    f->dep = rg_splat(0.0);
    f->more = most + most * rg_de_expm1(-fall);
    f->part = f->more / f->ep;
}

/* Halley's step in z, or where that leaves the bracket, to its middle. The right side less the left one, g,
 * grows and, but for cracks that open, is convex. */
RG_INLINE void rg_de_halley(const rg_de_constants *c, rg_de_point *p) {
    rg_de_flow *f = &p->flow;
    rg_vec s0 = c->half_yield + f->hard, inverse = 1.0 / (f->ep + f->dep), share = f->dep * inverse;
    rg_vec rate = s0 * f->slope, harder = c->hardening * f->hard * share, relief = f->s.tangent * f->dep;
    rg_vec bend = f->slope * (rate + 2.0 * harder) + harder * (1.0 - (1.0 - c->hardening) * share);
    rg_vec g = s0 * f->R - f->s.mises, dg = f->R * (rate + harder) + relief, d2g = f->R * bend + relief;
    f->high = rg_select(g > 0.0, f->z, f->high);
    f->low = rg_select(g > 0.0, f->low, f->z);
    rg_vec next = f->z - 2.0 * g * dg / (2.0 * dg * dg - g * d2g);
    next = rg_select((next >= f->low) & (next <= f->high), next, 0.5 * (f->low + f->high));
    f->step = rg_select(f->moving, next - f->z, rg_splat(0.0));
    f->more = f->dep * rg_de_expm1(f->step);
    f->part = f->more * inverse;
}

/* Takes the step. A small one is the last, if it has not crossed a corner of the curves. */
RG_INLINE void rg_de_move(const rg_de_constants *c, bool first, rg_de_point *p) {
    rg_de_flow *f = &p->flow;
    rg_vec power = f->power, slope = f->slope, tangent = f->s.tangent;
    f->z += f->step;
    f->dep += f->more;
    f->power = rg_de_power(c, f->z, &f->slope);
    f->s = rg_de_stress_at(c, &p->r, rg_max(p->eb - f->dep, rg_splat(0.0)));
    if (!first) {
        f->moving &= (rg_abs(f->step) > RG_DE_NEAR) | (f->slope != slope) | (f->s.tangent != tangent);
        p->moving = rg_any(f->moving);
        if (!p->moving) {
            return;
        }
    }
    f->R += f->R * rg_de_expm1(f->power - power);
    f->hard += f->hard * rg_de_power_less_1(c, f->part);
}

/* History, eb and stress after the flow; what it releases. */
RG_INLINE void rg_de_end_flow(rg_de_point *p) {
    rg_de_flow *f = &p->flow;
    rg_vec dep = rg_min(f->dep, p->eb), *strain = &p->history[RG_DE_STRAIN];
    rg_mask flows = f->flows & (dep > 0.0);
    rg_hencky_flow(&p->d, dep / p->eb, p->history + RG_DE_FLOW, flows);
    *strain = rg_select(flows, *strain + dep, *strain);
    p->eb = rg_select(flows, p->eb - dep, p->eb);
    rg_vec less = rg_de_stored(&f->s, p->d.ekk, p->eb);
    p->plastic = rg_select(flows, p->energy - less, p->plastic);
    p->energy = rg_select(flows, less, p->energy);
    p->s.mean = rg_select(flows, f->s.mean, p->s.mean);
    p->s.mises = rg_select(flows, f->s.mises, p->s.mises);
    p->s.drive2 = rg_select(flows, f->s.drive2, p->s.drive2);
}

/* Flow of one step with the cracks as they are. None where there is less than RG_DE_NO_FLOW. */
RG_INLINE void rg_de_relax(const rg_de_constants *c, int n, rg_de_point p[]) {
    bool moving = false;
    RG_DE_EACH(flowing) {
        rg_de_harden(c, &p[g]);
    }
    RG_DE_EACH(flowing) {
        rg_de_trial(c, &p[g]);
    }
    RG_DE_EACH(flowing) {
        rg_de_start_flow(c, &p[g]);
    }
    RG_DE_EACH(flowing) {
        rg_de_move(c, true, &p[g]);
        moving = true;
    }
    for (int i = 0; i < RG_DE_ITERATIONS && moving; i++) {
        moving = false;
        RG_DE_EACH(moving) {
            rg_de_halley(c, &p[g]);
        }
        RG_DE_EACH(moving) {
            rg_de_move(c, false, &p[g]);
            moving |= p[g].moving;
        }
    }
    RG_DE_EACH(flowing) {
        rg_de_end_flow(&p[g]);
    }
}

/* ---- Growth of cracks ---- */

/* log(dX/dt); e^-300 stands for no growth, of which there is no logarithm. */
RG_INLINE rg_vec rg_de_log_rate(const rg_de_constants *c, rg_vec drive2) {
    rg_vec u = (0.5 * c->exponent) * rg_log((c->intensity * c->intensity) * drive2);
    return rg_min(c->log_rate + rg_max(u, rg_splat(-300.0)), rg_splat(c->log_cap));
}

RG_INLINE void rg_de_begin_growth(const rg_de_constants *c, rg_de_point *p) {
    rg_de_growth *w = &p->growth;
    w->grows = (p->s.drive2 > c->silent) & (p->history[RG_DE_GROWTH] < c->growth_max);
    p->growing = rg_any(w->grows);
    if (p->growing) {
        w->log_rate = rg_de_log_rate(c, p->s.drive2);
    }
}

/* Euler's step, which will do where it is little, and the panels for the rest. */
RG_INLINE void rg_de_start_growth(const rg_de_constants *c, rg_de_point *p) {
    rg_de_growth *w = &p->growth;
    rg_vec X = p->history[RG_DE_GROWTH], y = X + c->offset, euler = c->dt * rg_exp(w->log_rate);
    w->grows &= euler > RG_DE_NO_GROWTH * y;
    w->large = w->running = w->grows & (euler > RG_DE_LITTLE * y);
    w->grown = rg_min(X + euler, rg_splat(c->growth_max));
    p->running = rg_any(w->running);
    if (p->running) {
        w->end = rg_min(X + c->reach, rg_splat(c->growth_max));
        w->width = rg_log1p((w->end - X) / y) * (1.0 / RG_DE_PANELS);
        w->ratio = rg_exp(w->width);
        w->y = w->at = y;
        w->time = rg_splat(1.0);
        w->unit = w->width * y / euler;
        w->bend = w->left = (rg_vec){0};
    }
}

RG_INLINE void rg_de_panel_drive(const rg_de_constants *c, rg_de_point *p) {
    rg_de_growth *w = &p->growth;
    rg_de_cracks k = rg_de_cracks_at(c, w->y * w->ratio - c->offset);
    rg_de_response r = rg_de_response_at(c, &k, p->d.ekk);
    w->drive2 = rg_de_stress_at(c, &r, p->eb).drive2;
}

RG_INLINE void rg_de_panel_rate(const rg_de_constants *c, rg_de_point *p) {
    p->growth.next = rg_de_log_rate(c, p->growth.drive2);
}

/* With phi = y/(dX/dt) a panel takes phi (exp(rise) - 1)/rise times its width in log y. */
RG_INLINE void rg_de_panel_time(rg_de_point *p) {
    rg_de_growth *w = &p->growth;
    rg_vec rise = w->width - (w->next - w->log_rate), less_1;
    rise = rg_select(rise == 0.0, rg_splat(1e-30), rise);
    rg_vec growth = rg_exp_and_less_1(rise, &less_1);
    w->at = rg_select(w->running, w->y, w->at);
    w->bend = rg_select(w->running, rise, w->bend);
    w->left = rg_select(w->running, w->time / w->unit, w->left);
    w->time -= w->unit * (less_1 / rise);
    w->running &= w->time >= 0.0;
    p->running = rg_any(w->running);
    w->y *= w->ratio;
    w->unit *= growth;
    w->log_rate = w->next;
}

/* X at the end of the step. */
RG_INLINE void rg_de_end_growth(const rg_de_constants *c, rg_de_point *p) {
    rg_de_growth *w = &p->growth;
    rg_vec X = p->history[RG_DE_GROWTH];
    if (rg_any(w->large)) {
        rg_vec part = rg_de_log1p(w->bend * w->left) / w->bend; /* of the panel */
        rg_vec to = (w->at - c->offset) + w->at * rg_de_expm1(part * w->width);
        to = rg_select(w->running, w->end, rg_min(rg_max(to, X), w->end));
        w->grown = rg_select(w->large, to, w->grown);
    }
    w->grows &= w->grown > X;
    p->growing = rg_any(w->grows);
}

/* History and stress with it; what it releases. */
RG_INLINE void rg_de_loosen(const rg_de_constants *c, rg_de_point *p) {
    rg_de_growth *w = &p->growth;
    rg_vec *X = &p->history[RG_DE_GROWTH];
    rg_de_cracks k = rg_de_cracks_at(c, w->grown);
    rg_de_response r = rg_de_response_at(c, &k, p->d.ekk);
    rg_de_stress after = rg_de_stress_at(c, &r, p->eb);
    rg_vec less = rg_de_stored(&after, p->d.ekk, p->eb);
    p->damage = rg_select(w->grows, p->energy - less, p->damage);
    p->energy = rg_select(w->grows, less, p->energy);
    p->s.mean = rg_select(w->grows, after.mean, p->s.mean);
    p->s.mises = rg_select(w->grows, after.mises, p->s.mises);
    *X = rg_select(w->grows, w->grown, *X);
}

/* Growth of one step with the strain as it is. */
RG_INLINE void rg_de_weaken(const rg_de_constants *c, int n, rg_de_point p[]) {
    bool running = false;
    for (int g = 0; g < n; g++) {
        rg_de_begin_growth(c, &p[g]);
    }
    RG_DE_EACH(growing) {
        rg_de_start_growth(c, &p[g]);
        running |= p[g].running;
    }
    for (int i = 0; i < RG_DE_PANELS && running; i++) {
        running = false;
        RG_DE_EACH(running) {
            rg_de_panel_drive(c, &p[g]);
        }
        RG_DE_EACH(running) {
            rg_de_panel_rate(c, &p[g]);
        }
        RG_DE_EACH(running) {
            rg_de_panel_time(&p[g]);
            running |= p[g].running;
        }
    }
    RG_DE_EACH(growing) {
        rg_de_end_growth(c, &p[g]);
    }
    RG_DE_EACH(growing) {
        rg_de_loosen(c, &p[g]);
    }
}

/* ---- The points of an element ---- */

/* What a point gives besides its stress. */
typedef struct {
    rg_vec stiffening; /* bound on the acoustic tensor over lambda + 2 mu of the intact solid */
    rg_vec energy;     /* stored, at the end of the step, per reference volume (J/m^3) */
    rg_vec plastic;    /* released by flow in the step, >= 0 (J/m^3) */
    rg_vec damage;     /* released by growth of cracks in the step (J/m^3); can be negative, see the model */
} rg_de_result;

RG_INLINE void rg_de_begin(const rg_de_constants *c, rg_vec F[3][3], rg_vec history[RG_DE_HISTORY],
                           rg_de_point *p) {
    p->history = history;
    rg_hencky_at(F, history + RG_DE_FLOW, &p->d);
    rg_de_cracks k = rg_de_cracks_at(c, history[RG_DE_GROWTH]);
    p->eb = p->d.eb;
    p->r = rg_de_response_at(c, &k, p->d.ekk);
    p->s = rg_de_stress_at(c, &p->r, p->eb);
    p->energy = rg_de_stored(&p->s, p->d.ekk, p->eb);
    p->plastic = p->damage = (rg_vec){0};
    p->flowing = rg_any(p->s.mises > c->quiet);
    p->moving = p->growing = p->running = false;
}

RG_INLINE void rg_de_end(const rg_de_constants *c, rg_de_point *p, rg_vec P[3][3], rg_de_result *out) {
    rg_hencky_piola(p->s.mean, p->s.mises, &p->d, P);
    out->stiffening = rg_hencky_stiffening(c->p_modulus, c->von_mises, p->s.mean, p->s.mises, &p->d);
    out->energy = p->energy;
    out->plastic = p->plastic;
    out->damage = p->damage;
}

/* The points F[n], n <= RG_GAUSS, at given histories: first Piola-Kirchhoff stress P (Pa). If `advance`,
 * after one step of the constants' dt that ends at F, which updates the histories; else nothing is released.
 */
RG_INLINE void rg_de_points(const rg_de_constants *c, bool advance, int n, rg_vec F[][3][3],
                            rg_vec history[][RG_DE_HISTORY], rg_vec P[][3][3], rg_de_result out[]) {
    rg_de_point p[RG_GAUSS];
    for (int g = 0; g < n; g++) {
        rg_de_begin(c, F[g], history[g], &p[g]);
    }
    if (advance) {
        rg_de_relax(c, n, p);
        rg_de_weaken(c, n, p);
    }
    for (int g = 0; g < n; g++) {
        rg_de_end(c, &p[g], P[g], &out[g]);
    }
}

#endif
