/* Bilinear law (H. D. Espinosa & P. D. Zavattieri 2003; P. H. Geubelle & J. S. Baylor 1998;
 * thesis 3.11-3.13): with x = delta/delta_c, delta the effective opening (3.16), and the ascent a, the x at
 * the strength, T = sigma_c x/a                 up to a T = sigma_c (1 - x)/(1 - a)     from there to 1 so
 * the slope sigma_c/(a delta_c) can be chosen apart from strength and energy; the stiffness is at most that.
 * Rule of thumb (Espinosa & Zavattieri): slope >= 10 E/h. Work of separation G_c = sigma_c delta_c / 2.
 *
 * `steps` is N of the adaptive time step (3.14): the number of steps in which x goes from 0 to a; 0: not
 * asked for. Memory: that of rg_law_opening_rate.
 *
 * Unloading: towards the origin, so reversible up to a. Closure: contact alone bears the normal part; sliding
 * goes on as before. */
#if defined(RG_LAW_FUNCTIONS) && !defined(RG_COHESIVE_BILINEAR_H)
#define RG_COHESIVE_BILINEAR_H

/* s delta_c / sigma_c = min(1/a, (1/x - 1)/(1 - a)), not below 0. */
RG_INLINE rg_vec rg_bilinear_secant(const rg_law_point *p, rg_vec x) {
    double a = p->law->shape[0];
    rg_vec beyond = (1.0 / rg_max(x, rg_splat(0.5 * a)) - 1.0) * rg_splat(1 / (1 - a));
    rg_vec s = rg_max(-rg_max(-beyond, rg_splat(-1 / a)), rg_splat(0.0));
    return p->strength * p->inverse * s;
}

RG_INLINE void rg_bilinear_respond(const rg_law_point *p, rg_law_state *state, rg_law_response *r) {
    rg_law_by_secant(p, rg_bilinear_secant(p, state->largest * p->inverse), r);
    if (p->law->shape[RG_LIMITER_STEPS] > 0) {
        rg_law_opening_rate(p, p->law->shape[0], state);
    }
}

/* Dissipated: G_c (x - a)/(1 - a) between a and 1, x = delta_max/delta_c. */
RG_INLINE void rg_bilinear_energy(const rg_law_point *p, const rg_law_state *state, rg_law_energy *e) {
    double a = p->law->shape[0];
    rg_vec x = state->largest * p->inverse,
           worn = rg_max((x - rg_splat(a)) * rg_splat(1 / (1 - a)), rg_splat(0.0));
    e->stored = rg_law_stored(p, rg_bilinear_secant(p, x));
    e->dissipated = p->area * (0.5 * p->strength * p->opening) * -rg_max(-worn, rg_splat(-1.0));
}
#endif

#if defined(RG_LAW_REFERENCES) && !defined(RG_COHESIVE_BILINEAR_REFERENCE)
#define RG_COHESIVE_BILINEAR_REFERENCE
static void rg_bilinear_reference(const rg_law_query *p, double state[], rg_law_answer *a) {
    double rise = p->shape[0], x = state[0] / p->opening, t = 0;
    if (x < rise)
        t = p->strength * x / rise;
    else if (x < 1)
        t = p->strength * (1 - x) / (1 - rise);
    rg_reference_secant(p, x > 0 ? t / state[0] : p->strength / (rise * p->opening), a);
    a->dissipated = p->strength * p->opening / 2 * fmin(1, fmax(0, (x - rise) / (1 - rise)));
    if (p->shape[RG_LIMITER_STEPS] > 0)
        rg_reference_opening_rate(p, rise, state);
}
#endif

#ifdef RG_LAW
RG_LAW(BILINEAR, bilinear, "bilinear", "up to the strength, then down to 0 (Espinosa & Zavattieri 2003)",
       RG_FORMS_INTRINSIC | RG_LIMITS_STEP, 0.5, 1, 1 / shape[0], beta *beta / shape[0], RG_LIMITER_MEMORY)
#endif
#ifdef RG_LAW_PARAMETER
RG_LAW_PARAMETER(BILINEAR, 0, "interface.bilinear.ascent", NULL, 1e-6, 0.999, 0.01,
                 "opening at the strength, over the critical one")
RG_LAW_PARAMETER(BILINEAR, RG_LIMITER_STEPS, "interface.bilinear.steps", NULL, 0, 1e6, 0,
                 "steps that the way from 0 to the strength, and from there to 0, takes at least, by a "
                 "shorter time step; 0: not asked for")
#endif
