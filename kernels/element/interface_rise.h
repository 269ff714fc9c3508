/* Strengths that rise with the rate of stress, before step 1 at a point of a face that holds:
 *     sigma_d = sigma_c min(`most`, max(1, (rate/rate_0)^n)),
 * the power law in the rate of stress of CEB-FIP Model Code 1990 (2.1.4.4), which is that of glass and of
 * slow cracks too. `rate` is the mean one (Pa/s) of the criterion's effective traction since the point was
 * last loaded by half of sigma_c: the rate of a step would be that of the ringing. A traction that stays
 * where it is therefore breaks a point in the end that it would not break at once.
 *
 * A point that breaks keeps its factor f: strength f sigma_c, critical opening delta_c/f, so that the work of
 * separation stays G_c, and all that follows the switch is of these two. */
#ifndef RG_INTERFACE_RISE_H
#define RG_INTERFACE_RISE_H

#include "element/interface_criterion.h"

#define RG_NO_TIME 1e-30 /* s: keeps a rate finite */

RG_INLINE bool rises(const interface *s) {
    return s->args->law.rise.rate > 0;
}

RG_INLINE rg_real *rise_state(const interface *s, int q, int k) {
    const rg_interface_args *args = s->args;
    return args->crack + rg_rise_index(&args->law, s->block * RG_LANES, q, k, args->crack_stride) + s->lane;
}

/* The law at point q, by the factor of its strength. */
RG_INLINE void load_risen(interface *s, rg_vec factor) {
    load_law(s);
    s->strength *= factor;
    s->strong_area *= factor;
    s->opening /= factor;
    s->inverse = 1.0 / s->opening; /* exactly: a point that starts at the end of its law carries nothing */
}

/* That of a broken point; of one open from the start 1. */
static __attribute__((noinline)) void load_risen_law(interface *s, int q) {
    load_risen(s, rg_max(rg_load(rise_state(s, q, RG_RISE_FACTOR)), rg_splat(1.0)));
}

/* f at a mean rate of stress. */
RG_INLINE rg_vec rise(const interface *s, rg_vec rate) {
    const rg_rise *r = &s->args->law.rise;
    rg_vec n = of_face(s, s->args->rise, r->exponent),
           over = rg_max(rate * rg_splat(1 / r->rate), rg_splat(1.0));
    return rg_min(rg_exp(n * rg_log(over)), rg_splat(r->most));
}

/* The law at point q: of one that holds and is tested by its rate so far, which this state adds to. */
static __attribute__((noinline)) void raise_strength(interface *s, int q, const cauchy *t, rg_mask broken) {
    load_law(s);
    rg_vec factor = rg_max(rg_load(rise_state(s, q, RG_RISE_FACTOR)), rg_splat(1.0));
    rg_mask tested = ~broken & (s->area_square > 0.0) & (rg_dot(s->mean[q], s->mean[q]) > test_bound(s));
    if (rg_any(tested)) {
        double step = s->args->step, time = s->args->time;
        rg_vec now = rg_splat(time), last = rg_load(rise_state(s, q, RG_RISE_LAST));
        rg_vec from = rg_load(rise_state(s, q, RG_RISE_STRESS)),
               span = rg_load(rise_state(s, q, RG_RISE_SPAN));
        rg_mask anew =
            (rg_load(rise_state(s, q, RG_RISE_FACTOR)) == 0.0) | (now - last > rg_splat(1.5 * step));
        rg_vec half = step > 0 ? rg_min(t->effective, 0.5 * s->strength) : t->effective;
        from = rg_select(anew, half, from);
        span = rg_select(anew, rg_splat(step), rg_select(now > last, span + rg_splat(step), span));
        rg_vec gain = rg_max(t->effective - from, rg_splat(0.0));
        rg_vec rate = rg_select(span > 0.0, gain / rg_max(span, rg_splat(RG_NO_TIME)), rg_splat(0.0));
        rg_vec risen = rise(s, rate);
        store_where(rise_state(s, q, RG_RISE_STRESS), tested, from);
        store_where(rise_state(s, q, RG_RISE_SPAN), tested, span);
        store_where(rise_state(s, q, RG_RISE_LAST), tested, now);
        store_where(rise_state(s, q, RG_RISE_FACTOR), tested, risen);
        factor = rg_select(tested, risen, factor);
    }
    load_risen(s, factor);
}

#endif
