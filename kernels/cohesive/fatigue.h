/* Linear softening with hysteresis between unloading and reloading (O. Nguyen, E. A. Repetto, M. Ortiz &
 * R. A. Radovitzky 2001; thesis 3.2.2): with delta of (3.16), below the envelope sigma_c (1 - delta/delta_c)
 *     unloading   T = s delta, s = K-, the secant at which it began;  dK+/d delta = (K+ - K-)/delta_f
 *     reloading   dT/d delta = K+;                                    dK+/d delta = -K+/delta_f
 * so each cycle wears the point, the more the shorter the decay opening delta_f (`decay` times delta_c). On
 * the envelope K+ = T/delta. Work of separation without cycles G_c = sigma_c delta_c / 2. Both equations are
 * integrated exactly over a step.
 *
 * With an onset eps (RG_FOLLOWS) the envelope is sigma_c (1 - (delta - eps)/delta_c), wear is of openings
 * beyond eps alone, and stored is s (delta^2 - eps^2)/2: what a point gives on the way back below eps, and
 * must get again, is not worn. Reduces to the above for eps = 0.
 *
 * Unloading: towards the origin. Closure: contact alone bears the normal part; sliding goes on as before.
 *
 * Memory: effective opening of the last step (m), secant T/delta and reloading slope K+ (Pa/m), dissipated
 * energy (J/m^2), 0 before the first step. A step from (d0, s0) to (d1, s1) dissipates (s0 - s1)(d0 d1 -
 * eps^2)/2: what the trapezoidal rule takes up less what is stored; not negative, because K+ never exceeds s
 * and s does not fall by wear where d0 d1 is below eps^2. */
#if defined(RG_LAW_FUNCTIONS) && !defined(RG_COHESIVE_FATIGUE_H)
#define RG_COHESIVE_FATIGUE_H

#define RG_NO_LOSS 1e-30 /* J/m2: nothing, but not 0 */

/* Secant of the envelope, T/delta (Pa/m). */
RG_INLINE rg_vec rg_fatigue_envelope(const rg_law_point *p, rg_vec delta) {
    rg_vec left = 1.0 - (delta - p->onset) * p->inverse;
    return rg_max(p->strength * left / rg_max(delta, rg_splat(RG_OPENING_FLOOR)), rg_splat(0.0));
}

/* Dissipated at the first opening, `largest` beyond the onset: the work up to there less what is stored. */
RG_INLINE rg_vec rg_fatigue_first_loss(const rg_law_point *p, rg_vec largest, rg_vec secant) {
    rg_vec reached = rg_min(largest, p->opening);
    rg_vec work = p->strength * reached * (1.0 - 0.5 * reached * p->inverse);
    return rg_max(work - 0.5 * secant * largest * (largest + 2.0 * p->onset), rg_splat(RG_NO_LOSS));
}

RG_INLINE void rg_fatigue_respond(const rg_law_point *p, rg_law_state *state, rg_law_response *r) {
    rg_vec last = state->memory[0], before = state->memory[1], reload = state->memory[2];
    rg_mask first = state->memory[3] == 0.0, grows = p->effective > last;
    rg_vec from = rg_max(last, p->onset), to = rg_max(p->effective, p->onset);
    rg_vec decay = p->opening * rg_splat(p->law->shape[0]), left = rg_exp(-rg_abs(to - from) / decay);
    rg_vec delta = rg_max(p->effective, rg_splat(RG_OPENING_FLOOR));
    rg_vec across = last * p->effective - p->onset * p->onset;
    rg_vec again = (before * from + reload * decay * (1.0 - left)) / delta;
    again = rg_select(across >= 0.0, again, before);
    rg_vec up = rg_min(rg_min(again, rg_fatigue_envelope(p, delta)), before);
    rg_vec start = rg_fatigue_envelope(p, state->largest + p->onset);
    rg_vec s = rg_select(first, start, rg_select(grows, up, before));
    reload = rg_select(grows, rg_min(reload * left, s), s + (reload - s) * left);
    rg_vec gone = rg_max(0.5 * across * (before - s), rg_splat(0.0));
    state->memory[0] = p->effective;
    state->memory[1] = s;
    state->memory[2] = rg_select(first, s, reload);
    state->memory[3] += rg_select(first, rg_fatigue_first_loss(p, state->largest, s), gone);
    rg_law_by_secant(p, s, r);
}

RG_INLINE void rg_fatigue_energy(const rg_law_point *p, const rg_law_state *state, rg_law_energy *e) {
    rg_vec squares = p->effective * p->effective - p->onset * p->onset;
    e->stored = 0.5 * p->area * state->memory[1] * squares;
    e->dissipated = p->area * state->memory[3];
}
#endif

#if defined(RG_LAW_REFERENCES) && !defined(RG_COHESIVE_FATIGUE_REFERENCE)
#define RG_COHESIVE_FATIGUE_REFERENCE
static void rg_fatigue_reference(const rg_law_query *p, double state[], rg_law_answer *a) {
    double delta = p->effective, far = p->shape[0] * p->opening, eps = p->onset, start = state[0] + eps;
    double *last = &state[1], *s = &state[2], *reload = &state[3], *lost = &state[4];
    double from = fmax(*last, eps), to = fmax(delta, eps), worth = *last * delta - eps * eps;
    if (*lost == 0) {
        double worn = fmin(1, state[0] / p->opening);
        *s = *reload = p->strength * (1 - worn) / fmax(start, 1e-20);
        *lost = p->strength * p->opening * worn * (1 - worn / 2) - *s * (start * start - eps * eps) / 2;
        *lost = fmax(1e-30, *lost);
    } else if (delta > *last) {
        double t = worth >= 0 ? *s * from + *reload * far * (1 - exp((from - to) / far)) : *s * delta;
        double top = p->strength * fmax(0, 1 - (delta - eps) / p->opening);
        double now = fmin(fmin(t, top) / delta, *s);
        *lost += fmax(0, worth * (*s - now)) / 2;
        *reload = fmin(*reload * exp((from - to) / far), now);
        *s = now;
    } else
        *reload = *s + (*reload - *s) * exp((to - from) / far);
    *last = delta;
    rg_reference_secant(p, *s, a);
    a->stored -= *s * eps * eps / 2;
    a->dissipated = *lost;
}
#endif

#ifdef RG_LAW
RG_LAW(FATIGUE, fatigue, "fatigue", "linear, with a reloading slope that wears (Nguyen et al. 2001)",
       RG_FORMS_DG | RG_ENVELOPE | RG_FOLLOWS, 0.5, 1, 0, 0, 4)
#endif
#ifdef RG_LAW_PARAMETER
RG_LAW_PARAMETER(FATIGUE, 0, "interface.fatigue.decay", NULL, 1e-3, 1e6, 1,
                 "opening over which reloading wears the slope, over the critical one")
#endif
