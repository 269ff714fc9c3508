/* Linear softening whose energies of opening and of sliding differ (M. L. Benzeggagh & M. Kenane 1996; as a
 * rigid law of the effective opening P. P. Camanho, C. G. Davila & M. F. de Moura 2003): with delta of (3.16)
 *     T = sigma_c (1 - delta/delta_B)                       loading, unloading to the origin, as `linear`
 *     delta_B = 2 G_B/sigma_c,  G_B = G_c (1 + (rho - 1) B^eta)
 * where rho is `ratio`, the energy of sliding over that of opening, eta `exponent`, and B the share of
 * sliding in the work at the switch, |tau|^2/beta^2 over <t_n>^2 + |tau|^2/beta^2: the criterion is the
 * quadratic one of both stresses, with the shear strength beta sigma_c. Work of separation G_B: G_c in
 * opening, rho G_c in sliding. A point keeps its B, so that its energy does not depend on what way it takes
 * later.
 *
 * Unloading: towards the origin. Closure: contact alone bears the normal part; sliding goes on as before.
 *
 * Memory: (rho - 1) B^eta (RG_MIXED), set at the switch. */
#if defined(RG_LAW_FUNCTIONS) && !defined(RG_COHESIVE_BENZEGGAGH_KENANE_H)
#define RG_COHESIVE_BENZEGGAGH_KENANE_H

/* T/delta (Pa/m) of a critical opening. */
RG_INLINE rg_vec rg_benzeggagh_kenane_secant(const rg_law_point *p, rg_vec largest, rg_vec opening) {
    rg_vec s = p->strength * (1.0 / rg_max(largest, rg_splat(RG_OPENING_FLOOR)) - 1.0 / opening);
    return rg_max(s, rg_splat(0.0));
}

RG_INLINE void rg_benzeggagh_kenane_respond(const rg_law_point *p, rg_law_state *state, rg_law_response *r) {
    rg_vec opening = p->opening * (1.0 + state->memory[0]);
    rg_law_by_secant(p, rg_benzeggagh_kenane_secant(p, state->largest, opening), r);
}

/* Dissipated: G_B min(1, delta_max/delta_B). */
RG_INLINE void rg_benzeggagh_kenane_energy(const rg_law_point *p, const rg_law_state *state,
                                           rg_law_energy *e) {
    rg_vec opening = p->opening * (1.0 + state->memory[0]);
    e->stored = rg_law_stored(p, rg_benzeggagh_kenane_secant(p, state->largest, opening));
    e->dissipated = p->area * (0.5 * p->strength * rg_min(state->largest, opening));
}
#endif

#if defined(RG_LAW_REFERENCES) && !defined(RG_COHESIVE_BENZEGGAGH_KENANE_REFERENCE)
#define RG_COHESIVE_BENZEGGAGH_KENANE_REFERENCE
static void rg_benzeggagh_kenane_reference(const rg_law_query *p, double state[], rg_law_answer *a) {
    double end = p->opening * (1 + state[1]), worn = fmin(1, state[0] / end);
    rg_reference_secant(p, p->strength * (1 - worn) / fmax(state[0], 1e-30), a);
    a->dissipated = p->strength * end / 2 * worn;
}
#endif

#ifdef RG_LAW
RG_LAW(BENZEGGAGH_KENANE, benzeggagh_kenane, "benzeggagh-kenane",
       "linear, with energies of opening and sliding that differ (Benzeggagh & Kenane 1996)",
       RG_FORMS_DG | RG_ENVELOPE | RG_MIXED, 0.5, 1, 0, 0, 1)
#endif
#ifdef RG_LAW_PARAMETER
RG_LAW_PARAMETER(
    BENZEGGAGH_KENANE, RG_MIXED_RATIO, "interface.benzeggagh-kenane.ratio", NULL, 1e-3, 1e6, 4,
    "fracture energy of sliding over that of opening, which is interface.energy; the strength of "
    "sliding is interface.beta times interface.strength")
RG_LAW_PARAMETER(
    BENZEGGAGH_KENANE, RG_MIXED_EXPONENT, "interface.benzeggagh-kenane.exponent", NULL, 0.1, 100, 2,
    "energy between them: energy (1 + (ratio - 1) B^exponent), B the share of sliding at the switch")
#endif
