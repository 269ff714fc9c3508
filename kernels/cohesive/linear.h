/* Linear irreversible softening (thesis 3.16-3.22; G. T. Camacho & M. Ortiz 1996): with the effective opening
 * delta = sqrt(beta^2 |D_t|^2 + max(0, D_n)^2) and the largest one so far, delta_max,
 *     T = sigma_c (1 - delta/delta_c)                      loading
 *     T = sigma_c (1 - delta_max/delta_c) delta/delta_max  unloading,
 * so both are T = s delta with the secant s = sigma_c (1/delta_max - 1/delta_c), delta_max updated first.
 * Work of separation G_c = sigma_c delta_c / 2.
 *
 * Unloading: towards the origin. Closure: contact alone bears the normal part; sliding goes on as before.
 *
 * The law starts at the strength. Which opening it is given decides whether the traction is continuous in
 * time: the total jump (activation `total`, the thesis) or the jump since the switch, offset along the
 * traction that broke the point (`continuous`). The latter is the time-continuous form of this law in the
 * sense of K. D. Papoulia, C.-H. Sam & S. A. Vavasis (2003): the traction just before the switch is what the
 * law starts from, in size and direction. It is not a law of its own, and every law that starts rigid has it.
 */
#if defined(RG_LAW_FUNCTIONS) && !defined(RG_COHESIVE_LINEAR_H)
#define RG_COHESIVE_LINEAR_H

/* Secant s = T/delta (Pa/m); 0 once failed. */
RG_INLINE rg_vec rg_linear_secant(const rg_law_point *p, rg_vec delta_max) {
    rg_vec floor = rg_splat(RG_OPENING_FLOOR);
    rg_vec s = p->strength * (1.0 / rg_max(delta_max, floor) - p->inverse);
    return rg_max(s, rg_splat(0.0));
}

RG_INLINE void rg_linear_respond(const rg_law_point *p, rg_law_state *state, rg_law_response *r) {
    rg_law_by_secant(p, rg_linear_secant(p, state->largest), r);
}

/* Dissipated: G_c min(1, delta_max/delta_c). */
RG_INLINE void rg_linear_energy(const rg_law_point *p, const rg_law_state *state, rg_law_energy *e) {
    rg_vec excess = rg_max(state->largest - p->opening, rg_splat(0.0));
    e->stored = rg_law_stored(p, rg_linear_secant(p, state->largest));
    e->dissipated = p->area * (0.5 * p->strength * (state->largest - excess));
}
#endif

#if defined(RG_LAW_REFERENCES) && !defined(RG_COHESIVE_LINEAR_REFERENCE)
#define RG_COHESIVE_LINEAR_REFERENCE
static void rg_linear_reference(const rg_law_query *p, double state[], rg_law_answer *a) {
    double worn = fmin(1, state[0] / p->opening);
    rg_reference_secant(p, p->strength * (1 - worn) / fmax(state[0], 1e-30), a);
    a->dissipated = p->strength * p->opening / 2 * worn;
}
#endif

#ifdef RG_LAW
RG_LAW(LINEAR, linear, "linear", "traction falls linearly with opening (Camacho & Ortiz 1996)",
       RG_FORMS_DG | RG_ENVELOPE, 0.5, 1, 0, 0, 0)
#endif
