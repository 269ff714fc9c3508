/* Step 1 at the points of a face: the fracture criterion (5.3, 5.17), and with what opening a point that
 * breaks starts, the activation (section 6 of kernels/README.md). */
#ifndef RG_INTERFACE_CRITERION_H
#define RG_INTERFACE_CRITERION_H

#include "cohesive/conserving.h"
#include "cohesive/friction.h"
#include "element/interface_crack.h"

/* The Piola traction below which a point is not tested: half the strength, as an area-weighted square. */
RG_INLINE rg_vec test_bound(const interface *s) {
    double beta = s->args->law.beta, strength = s->args->law.strength;
    double reach = s->args->beta == NULL && beta > 0 && beta < 1 ? 1 / (beta * beta) : 1;
    rg_vec bound = rg_splat(0.25 * strength * strength / reach) * s->area_square;
    if (s->args->beta != NULL) {
        rg_vec one = rg_splat(1.0), each = of_face(s, s->args->beta, 0);
        bound *= rg_select(each > 0.0, rg_min(each * each, one), one);
    }
    if (s->args->scale != NULL) {
        bound *= scale(s, 0) * scale(s, 0);
    }
    return bound;
}

RG_INLINE bool any_to_test(const interface *s) {
    rg_vec bound = test_bound(s), largest = {0};
    for (int q = 0; q < RG_POINTS; q++) {
        largest = rg_max(rg_dot(s->mean[q], s->mean[q]), largest);
    }
    return rg_any(largest > bound);
}

/* Whether pressure adds its friction to the strength of shear (Mohr and Coulomb). */
RG_INLINE bool is_frictional(const interface *s) {
    return s->args->law.criterion == RG_CRITERION_MOHR_COULOMB;
}

/* The part h of the traction (N) that friction holds: along tau, mu p of it, or all that there is; p is the
 * pressure. */
RG_INLINE void held_by_friction(const interface *s, int q, const vec3 n, vec3 held) {
    rg_vec along = rg_dot(s->mean[q], n), zero = rg_splat(0.0);
    for (int c = 0; c < 3; c++) {
        held[c] = s->mean[q][c] - along * n[c];
    }
    rg_vec most = of_face(s, s->args->friction, s->args->law.friction) * rg_max(-along, zero);
    rg_vec share = most / rg_max(rg_sqrt(rg_dot(held, held)), rg_splat(RG_FORCE_FLOOR));
    share = rg_min(share, rg_splat(1.0));
    for (int c = 0; c < 3; c++) {
        held[c] *= share;
    }
}

/* Takes from tau (Pa) what friction holds of it; out of line, for runs without it. */
static __attribute__((noinline)) void take_friction(const interface *s, int q, const vec3 n, rg_vec area,
                                                    vec3 tau) {
    vec3 held;
    held_by_friction(s, q, n, held);
    for (int c = 0; c < 3; c++) {
        tau[c] -= held[c] / rg_max(area, rg_splat(RG_NO_AREA));
    }
}

/* Cauchy traction t of a point: its shear tau, less what friction holds of it, its tension <t_n>, and what of
 * both meets the strength. */
typedef struct {
    vec3 tau;
    rg_vec tension, shear; /* shear: weight of tau, 1/beta^2 (beta = 0: 0) */
    rg_vec effective;      /* sqrt(<t_n>^2 + |tau|^2/beta^2) */
} cauchy;

RG_INLINE rg_vec shear_weight(const interface *s) {
    double beta = s->args->law.beta;
    if (s->args->beta == NULL) {
        return rg_splat(beta > 0 ? 1 / (beta * beta) : 0);
    }
    return rg_select(s->beta2 > 0.0, 1.0 / s->beta2, rg_splat(0.0));
}

RG_INLINE void cauchy_traction(const interface *s, int q, const vec3 n, rg_vec area, cauchy *t) {
    vec3 all;
    for (int c = 0; c < 3; c++) {
        all[c] = s->mean[q][c] / rg_max(area, rg_splat(RG_NO_AREA));
    }
    t->shear = shear_weight(s);
    rg_vec tn = rg_dot(all, n);
    t->tension = rg_max(tn, rg_splat(0.0));
    for (int c = 0; c < 3; c++) {
        t->tau[c] = all[c] - tn * n[c];
    }
    if (is_frictional(s)) {
        take_friction(s, q, n, area, t->tau);
    }
    t->effective = rg_sqrt(t->tension * t->tension + t->shear * rg_dot(t->tau, t->tau));
}

/* Criterion (5.3), (5.17): which of the intact points break now. Padding has no area. */
RG_INLINE rg_mask breaking(const interface *s, int q, const cauchy *t, rg_mask intact) {
    rg_mask tested = (s->area_square > 0.0) & (rg_dot(s->mean[q], s->mean[q]) > test_bound(s));
    return intact & tested & (t->effective > s->strength);
}

/* Opening eps from which a point that breaks starts (m); 0 where the law takes the total jump. */
RG_INLINE rg_vec onset(const interface *s, rg_activation activation) {
    const rg_cohesive *law = &s->args->law;
    double share = activation == RG_ACTIVATION_TOTAL        ? 0.0
                   : activation == RG_ACTIVATION_CONSERVING ? law->onset
                                                            : RG_ONSET;
    rg_vec eps = rg_splat(share * law->strength) * s->strong_area / normal_penalty(s);
    if (activation == RG_ACTIVATION_CONSERVING && s->args->beta != NULL) { /* the law's is for its own beta */
        eps *= rg_max(s->beta2, rg_splat(1.0)) * rg_splat(1 / (law->beta > 1 ? law->beta * law->beta : 1));
    }
    return eps;
}

/* Closed opening at which contact goes on with the pressure of the DG traction, at most 0 (m). */
RG_INLINE rg_vec pressed_at_switch(const interface *s, int q, const vec3 n) {
    return rg_min(rg_dot(s->mean[q], n), rg_splat(0.0)) / s->contact;
}

/* What comes free at a point that breaks, but for contact: F = sigma_c area g of cohesive/conserving.h (J).
 */
RG_INLINE rg_vec released(const interface *s, rg_vec mean_jump, rg_vec penalty) {
    double beta_s = s->args->law.beta_s, kept = beta_s > RG_LIFT ? 0.5 * (1 - RG_LIFT / beta_s) : 0;
    return mean_jump + rg_splat(kept) * penalty;
}

/* g of cohesive/conserving.h: what comes free at a point that breaks, over its area and strength (m). */
RG_INLINE rg_vec given_free(const interface *s, int q, rg_vec pressed) {
    rg_vec along = rg_dot(s->normal, s->jump[q]);
    rg_vec penalty = s->pen_iso * rg_dot(s->jump[q], s->jump[q]) + s->pen_norm * along * along;
    rg_vec free = released(s, rg_dot(s->mean[q], s->jump[q]), penalty) - 0.5 * s->contact * pressed * pressed;
    return free / (s->area * s->strength);
}

/* That part of it which comes of shear (J). */
RG_INLINE rg_vec given_by_shear(const interface *s, int q, const vec3 n) {
    rg_vec along = rg_dot(s->jump[q], n), square = rg_dot(s->jump[q], s->jump[q]) - along * along;
    return released(s, rg_dot(s->mean[q], s->jump[q]) - rg_dot(s->mean[q], n) * along, s->pen_iso * square);
}

/* eps of a broken point, of a conserving activation its own. */
RG_INLINE rg_vec point_onset(const interface *s, int q, rg_activation activation) {
    rg_vec common = onset(s, activation);
    if (activation != RG_ACTIVATION_CONSERVING) {
        return common;
    }
    return rg_conserving_onset(rg_load(crack_state(s, q, RG_CRACK_GIVEN)), common);
}

/* Activation of the points that break now: their first state.
 *   total       the opening is [u]
 *   continuous  [u] - ([u]_s - eps d), d = (tau/beta^2 + <t_n> n)/sigma_s along the traction: so that the
 *               cohesive traction continues the one at the switch in direction and size (Papoulia et al.)
 *   conserving  [u] - ([u]_s - delta_0 d - w_p n), of which d_0 is damage already and w_p what contact is
 *               pressed by, so that pressure goes on, too (cohesive/conserving.h)
 * With Mohr and Coulomb's criterion d_0 is not made smaller by what contact and the springs of friction begin
 * with, or the traction would fall where the pressure is high: that is lent, and booked. */
RG_INLINE void activate(const interface *s, int q, const vec3 n, const cauchy *t, rg_mask now,
                        rg_activation activation, int mixed) {
    if (mixed > 0) {
        rg_vec sheared = t->shear * rg_dot(t->tau, t->tau);
        store_where(memory_state(s, mixed, q, 0), now,
                    rg_law_excess(&s->args->law, sheared / (t->effective * t->effective)));
    }
    rg_vec start = onset(s, activation), first = start, pressed = rg_splat(0.0);
    if (activation == RG_ACTIVATION_CONSERVING) {
        pressed = pressed_at_switch(s, q, n);
        rg_vec given = given_free(s, q, is_frictional(s) ? rg_splat(0.0) : pressed);
        if (is_frictional(s)) {
            vec3 held;
            held_by_friction(s, q, n, held);
            store_where(loan_state(s, q), now,
                        0.5 * (s->contact * pressed * pressed + rg_dot(held, held) / s->pen_iso));
        }
        if (rg_any(now & fading(s))) { /* is the spring's, and none of the law's */
            rg_vec sheared = rg_max(given_by_shear(s, q, n), rg_splat(0.0));
            store_where(bond_state(s, q, RG_BOND_GIVEN), now & fading(s), sheared);
            given = rg_select(fading(s), given - sheared / (s->area * s->strength), given);
        }
        store_where(crack_state(s, q, RG_CRACK_GIVEN), now, given);
        start = rg_conserving_onset(given, start);
        first = rg_conserving_first(given, critical_opening(s, q, mixed));
        start = rg_conserving_start(given, first, start);
    }
    bool total = s->args->law.activation == RG_ACTIVATION_TOTAL;
    for (int c = 0; c < 3; c++) {
        rg_vec d = (t->shear * t->tau[c] + t->tension * n[c]) / t->effective;
        rg_vec origin = total ? rg_splat(0.0) : s->jump[q][c] - start * d - pressed * n[c];
        store_where(crack_state(s, q, RG_CRACK_ORIGIN + c), now, origin);
    }
    store_where(crack_state(s, q, RG_CRACK_OPENING), now, first);
    store_where(crack_state(s, q, RG_CRACK_TIME), now, rg_splat(s->args->time));
}

#endif
