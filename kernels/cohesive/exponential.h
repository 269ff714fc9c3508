/* Universal binding energy of Rose, Smith & Ferrante, made irreversible (M. Ortiz & A. Pandolfi 1999; thesis
 * 5.4, 5.5): with the effective opening delta of (3.16) and delta_0, the opening at the strength,
 *     T = e sigma_c (delta/delta_0) exp(-delta/delta_0)    loading
 * and the secant of the largest opening, s = e (sigma_c/delta_0) exp(-delta_max/delta_0), on the way back.
 * Work of separation G_c = e sigma_c delta_0; it carries less than 1 % of the strength beyond 7.64 delta_0.
 * Stiffness: at most the first slope, e sigma_c/delta_0.
 *
 * Unloading: towards the origin. Closure: contact alone bears the normal part; sliding goes on as before. */
#if defined(RG_LAW_FUNCTIONS) && !defined(RG_COHESIVE_EXPONENTIAL_H)
#define RG_COHESIVE_EXPONENTIAL_H

#define RG_E 2.71828182845904523536

RG_INLINE rg_vec rg_exponential_secant(const rg_law_point *p, rg_vec x) {
    return rg_splat(RG_E) * p->strength * p->inverse * rg_exp(-x);
}

RG_INLINE void rg_exponential_respond(const rg_law_point *p, rg_law_state *state, rg_law_response *r) {
    rg_law_by_secant(p, rg_exponential_secant(p, state->largest * p->inverse), r);
}

/* Dissipated: e sigma_c delta_0 (1 - (1 + x + x^2/2) exp(-x)), x = delta_max/delta_0. */
RG_INLINE void rg_exponential_energy(const rg_law_point *p, const rg_law_state *state, rg_law_energy *e) {
    rg_vec x = state->largest * p->inverse, decay = rg_exp(-x);
    e->stored = rg_law_stored(p, rg_exponential_secant(p, x));
    e->dissipated =
        p->area * (rg_splat(RG_E) * p->strength * p->opening) * (1.0 - (1.0 + x * (1.0 + 0.5 * x)) * decay);
}
#endif

#if defined(RG_LAW_REFERENCES) && !defined(RG_COHESIVE_EXPONENTIAL_REFERENCE)
#define RG_COHESIVE_EXPONENTIAL_REFERENCE
static void rg_exponential_reference(const rg_law_query *p, double state[], rg_law_answer *a) {
    double e = exp(1), x = state[0] / p->opening, top = e * p->strength * x * exp(-x);
    rg_reference_secant(p, e * p->strength * exp(-x) / p->opening, a);
    a->dissipated = e * p->strength * p->opening * (1 - (1 + x) * exp(-x)) - top * state[0] / 2;
}
#endif

#ifdef RG_LAW
RG_LAW(EXPONENTIAL, exponential, "exponential",
       "universal binding energy, irreversible (Rose, Smith & Ferrante; Ortiz & Pandolfi 1999)",
       RG_FORMS_INTRINSIC, 2.71828182845904523536, 7.64, 2.71828182845904523536,
       2.71828182845904523536 * beta * beta, 0)
#endif
