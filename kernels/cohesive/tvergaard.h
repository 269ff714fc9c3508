/* Cubic law of the effective opening (V. Tvergaard 1990; thesis 3.2-3.5): with x = delta/delta_c, where
 * delta_c is the critical normal opening and delta_c/beta that of sliding,
 *     T = (27/4) sigma_c x (1 - x)^2     up to x = 1,
 * T_n = T D_n/delta, T_t = beta^2 T D_t/delta. Tvergaard's coupling alpha is set to beta: then the loading
 * curve has a potential, and no path can gain energy. Work of separation G_c = (9/16) sigma_c delta_c;
 * strength reached at x = 1/3; stiffness at most the first slope, (27/4) sigma_c/delta_c.
 *
 * Unloading: towards the origin. Closure: contact alone bears the normal part; sliding goes on as before. */
#if defined(RG_LAW_FUNCTIONS) && !defined(RG_COHESIVE_TVERGAARD_H)
#define RG_COHESIVE_TVERGAARD_H

RG_INLINE rg_vec rg_tvergaard_left(const rg_law_point *p, const rg_law_state *state) {
    return rg_max(1.0 - state->largest * p->inverse, rg_splat(0.0));
}

RG_INLINE rg_vec rg_tvergaard_secant(const rg_law_point *p, rg_vec left) {
    return rg_splat(6.75) * p->strength * p->inverse * (left * left);
}

RG_INLINE void rg_tvergaard_respond(const rg_law_point *p, rg_law_state *state, rg_law_response *r) {
    rg_law_by_secant(p, rg_tvergaard_secant(p, rg_tvergaard_left(p, state)), r);
}

/* Dissipated: the work (27/4) (x^2/2 - 2 x^3/3 + x^4/4) less T x/2, that is (27/4) (x^3/3 - x^4/4). */
RG_INLINE void rg_tvergaard_energy(const rg_law_point *p, const rg_law_state *state, rg_law_energy *e) {
    rg_vec left = rg_tvergaard_left(p, state), x = 1.0 - left;
    e->stored = rg_law_stored(p, rg_tvergaard_secant(p, left));
    e->dissipated =
        p->area * (rg_splat(6.75) * p->strength * p->opening) * (x * x * x * (rg_splat(1. / 3) - 0.25 * x));
}
#endif

#if defined(RG_LAW_REFERENCES) && !defined(RG_COHESIVE_TVERGAARD_REFERENCE)
#define RG_COHESIVE_TVERGAARD_REFERENCE
static void rg_tvergaard_reference(const rg_law_query *p, double state[], rg_law_answer *a) {
    double x = fmin(1, state[0] / p->opening), f = 27. / 4 * p->strength * (1 - 2 * x + x * x);
    rg_reference_secant(p, f / p->opening, a);
    double work = 27. / 4 * p->strength * p->opening * (x * x / 2 - 2 * x * x * x / 3 + x * x * x * x / 4);
    a->dissipated = work - f * x * x * p->opening / 2;
}
#endif

#ifdef RG_LAW
RG_LAW(TVERGAARD, tvergaard, "tvergaard", "cubic in the effective opening (Tvergaard 1990)",
       RG_FORMS_INTRINSIC, 0.5625, 1, 6.75, 6.75 * beta * beta, 0)
#endif
