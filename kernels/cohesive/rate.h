/* Linear softening whose work of separation grows with the rate of opening, v = d delta/dt (F. Zhou, J.-F.
 * Molinari & T. Shioya 2005, as thesis 3.2.2 reports it; the power law is this program's choice):
 *     T = sigma_c (1 - delta/delta_c(v)),   delta_c(v) = delta_c (1 + (v/v_0)^n)   loading
 * with delta of (3.16), v_0 (m/s) `speed` and n `exponent`. The secant s = T/delta never grows, so slow
 * opening after fast cannot create energy. Work of separation sigma_c delta_c (1 + (v/v_0)^n)/2 at constant
 * v; G_c is that for v -> 0.
 *
 * Unloading: towards the origin. Closure: contact alone bears the normal part; sliding goes on as before.
 *
 * Memory: effective opening of the last step (m); compliance 1/s (m/Pa), 0 before the first step; dissipated
 * energy (J/m^2). A step from (d0, s0) to (d1, s1) dissipates (s0 - s1) d0 d1/2: what the trapezoidal rule
 * takes up less what is stored. */
#if defined(RG_LAW_FUNCTIONS) && !defined(RG_COHESIVE_RATE_H)
#define RG_COHESIVE_RATE_H

#define RG_STIFFNESS_FLOOR 1e-30 /* Pa/m: nothing */

RG_INLINE void rg_rate_respond(const rg_law_point *p, rg_law_state *state, rg_law_response *r) {
    rg_vec last = state->memory[0], zero = rg_splat(0.0), floor = rg_splat(RG_STIFFNESS_FLOOR);
    rg_mask first = state->memory[1] == 0.0;
    rg_vec before = 1.0 / rg_max(state->memory[1], floor);
    double per_speed = p->step > 0 ? 1 / (p->step * p->law->shape[0]) : 0;
    rg_vec speed = rg_select(first, zero, (p->effective - last) * rg_splat(per_speed));
    rg_vec stretch = 1.0 + rg_pow(rg_max(speed, rg_splat(1e-30)), p->law->shape[1]);
    rg_vec largest = rg_max(state->largest, rg_splat(RG_OPENING_FLOOR));
    rg_vec s = rg_max(p->strength * (1.0 / largest - p->inverse / stretch), zero);
    s = rg_select(first, s, rg_select(p->effective > p->before, rg_min(s, before), before));
    rg_vec gone = rg_select(first, p->strength * state->largest, last * p->effective * (before - s));
    state->memory[0] = p->effective;
    state->memory[1] = 1.0 / rg_max(s, floor);
    state->memory[2] += 0.5 * rg_max(gone, zero);
    rg_law_by_secant(p, s, r);
}

RG_INLINE void rg_rate_energy(const rg_law_point *p, const rg_law_state *state, rg_law_energy *e) {
    rg_vec s = 1.0 / rg_max(state->memory[1], rg_splat(RG_STIFFNESS_FLOOR));
    e->stored = rg_select(state->memory[1] > 0.0, rg_law_stored(p, s), rg_splat(0.0));
    e->dissipated = p->area * state->memory[2];
}
#endif

#if defined(RG_LAW_REFERENCES) && !defined(RG_COHESIVE_RATE_REFERENCE)
#define RG_COHESIVE_RATE_REFERENCE
static void rg_rate_reference(const rg_law_query *p, double state[], rg_law_answer *a) {
    double delta = p->effective, *last = &state[1], *compliance = &state[2];
    double slow = p->strength * fmax(0, 1 / fmax(state[0], 1e-30) - 1 / p->opening), s = slow;
    if (*compliance > 0) {
        double before = 1 / *compliance, speed = p->step > 0 ? fmax(0, delta - *last) / p->step : 0;
        double critical = p->opening * (1 + pow(speed / p->shape[0], p->shape[1]));
        double fast = p->strength * fmax(0, 1 / fmax(state[0], 1e-30) - 1 / critical);
        s = delta > p->before ? fmin(before, fast) : before;
        state[3] += fmax(0, *last * delta * (before - s)) / 2;
    } else
        state[3] += p->strength * state[0] / 2;
    *last = delta;
    *compliance = 1 / fmax(s, 1e-30);
    rg_reference_secant(p, s, a);
    a->dissipated = state[3];
}
#endif

#ifdef RG_LAW
RG_LAW(RATE, rate, "rate",
       "linear, with a critical opening that grows with the opening rate; double precision",
       RG_FORMS_DG | RG_ENVELOPE, 0.5, 1, 0, 0, 3)
#endif
#ifdef RG_LAW_PARAMETER
RG_LAW_PARAMETER(RATE, 0, "interface.rate.speed", "m/s", 1e-9, 1e9, 10,
                 "opening rate at which the critical opening is twice that of slow opening")
RG_LAW_PARAMETER(RATE, 1, "interface.rate.exponent", NULL, 0.01, 10, 1,
                 "the critical opening is multiplied by 1 + (opening rate/speed)^exponent")
#endif
