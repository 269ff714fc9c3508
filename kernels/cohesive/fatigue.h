/* Linear softening with hysteresis between unloading and reloading (O. Nguyen, E. A. Repetto, M. Ortiz &
 * R. A. Radovitzky 2001; thesis 3.2.2): with delta of (3.16), below the envelope sigma_c (1 - delta/delta_c)
 *     unloading   T = s delta, s = K-, the secant at which it began;  dK+/d delta = (K+ - K-)/delta_f
 *     reloading   dT/d delta = K+;                                    dK+/d delta = -K+/delta_f
 * so each cycle wears the point, the more the shorter the decay opening delta_f (`decay` times delta_c). On
 * the envelope K+ = T/delta. Work of separation without cycles G_c = sigma_c delta_c / 2. Both equations are
 * integrated exactly over a step.
 *
 * Unloading: towards the origin. Closure: contact alone bears the normal part; sliding goes on as before.
 *
 * Memory: effective opening of the last step (m), secant T/delta and reloading slope K+ (Pa/m), dissipated
 * energy (J/m^2), 0 before the first step. A step from (d0, s0) to (d1, s1) dissipates (s0 - s1) d0 d1/2:
 * what the trapezoidal rule takes up less what is stored; not negative, because K+ never exceeds s. */
#if defined(RG_LAW_FUNCTIONS) && !defined(RG_COHESIVE_FATIGUE_H)
#define RG_COHESIVE_FATIGUE_H

RG_INLINE rg_vec rg_fatigue_envelope(const rg_law_point *p, rg_vec delta) {
    rg_vec floor = rg_splat(RG_OPENING_FLOOR);
    return rg_max(p->strength * (1.0 / rg_max(delta, floor) - p->inverse), rg_splat(0.0));
}

RG_INLINE void rg_fatigue_respond(const rg_law_point *p, rg_law_state *state, rg_law_response *r) {
    rg_vec last = state->memory[0], before = state->memory[1], reload = state->memory[2];
    rg_mask first = state->memory[3] == 0.0, grows = p->effective > last;
    rg_vec decay = p->opening * rg_splat(p->law->shape[0]),
           left = rg_exp(-rg_abs(p->effective - last) / decay);
    rg_vec floor = rg_splat(RG_OPENING_FLOOR), delta = rg_max(p->effective, floor);
    rg_vec again = (before * last + reload * decay * (1.0 - left)) / delta;
    rg_vec up = rg_min(rg_min(again, rg_fatigue_envelope(p, delta)), before);
    rg_vec start = rg_fatigue_envelope(p, state->largest);
    rg_vec s = rg_select(first, start, rg_select(grows, up, before));
    reload = rg_select(grows, rg_min(reload * left, s), s + (reload - s) * left);
    rg_vec gone = rg_select(first, p->strength * state->largest, last * p->effective * (before - s));
    state->memory[0] = p->effective;
    state->memory[1] = s;
    state->memory[2] = rg_select(first, s, reload);
    state->memory[3] += 0.5 * rg_max(gone, rg_splat(0.0));
    rg_law_by_secant(p, s, r);
}

RG_INLINE void rg_fatigue_energy(const rg_law_point *p, const rg_law_state *state, rg_law_energy *e) {
    e->stored = rg_law_stored(p, state->memory[1]);
    e->dissipated = p->area * state->memory[3];
}
#endif

#if defined(RG_LAW_REFERENCES) && !defined(RG_COHESIVE_FATIGUE_REFERENCE)
#define RG_COHESIVE_FATIGUE_REFERENCE
static void rg_fatigue_reference(const rg_law_query *p, double state[], rg_law_answer *a) {
    double delta = p->effective, far = p->shape[0] * p->opening;
    double *last = &state[1], *s = &state[2], *reload = &state[3], *lost = &state[4];
    if (*lost == 0) {
        *s = *reload = p->strength * fmax(0, 1 / fmax(state[0], 1e-20) - 1 / p->opening);
        *lost = p->strength * state[0] / 2;
    } else if (delta > *last) {
        double t = *s * *last + *reload * far * (1 - exp((*last - delta) / far));
        double top = p->strength * fmax(0, 1 - delta / p->opening);
        double now = fmin(fmin(t, top) / delta, *s);
        *lost += fmax(0, *last * delta * (*s - now)) / 2;
        *reload = fmin(*reload * exp((*last - delta) / far), now);
        *s = now;
    } else
        *reload = *s + (*reload - *s) * exp((delta - *last) / far);
    *last = delta;
    rg_reference_secant(p, *s, a);
    a->dissipated = *lost;
}
#endif

#ifdef RG_LAW
RG_LAW(FATIGUE, fatigue, "fatigue", "linear, with a reloading slope that wears (Nguyen et al. 2001)",
       RG_FORMS_DG, 0.5, 1, 0, 0, 4)
#endif
#ifdef RG_LAW_PARAMETER
RG_LAW_PARAMETER(FATIGUE, 0, "interface.fatigue.decay", NULL, 1e-3, 1e6, 1,
                 "opening over which reloading wears the slope, over the critical one")
#endif
