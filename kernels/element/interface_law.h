/* Step 2 at the broken points of a face: the traction-separation law (section 7 of kernels/README.md), a file
 * each in cohesive/, and what a conserving activation makes of it. */
#ifndef RG_INTERFACE_LAW_H
#define RG_INTERFACE_LAW_H

#include "element/interface_criterion.h"

/* A law as this kernel is compiled around it: its functions (cohesive/cohesive.h) and the number of values
 * that a point remembers. */
typedef struct {
    void (*respond)(const rg_law_point *p, rg_law_state *state, rg_law_response *r);
    void (*energy)(const rg_law_point *p, const rg_law_state *state, rg_law_energy *e);
    int memory, mixed;      /* mixed: as mixed_memory */
    bool follows, workless; /* RG_FOLLOWS, RG_WORKLESS */
} law_functions;

RG_INLINE rg_law_point law_point(const interface *s, const point_opening *o, rg_vec before) {
    return (rg_law_point){.law = &s->args->law,
                          .step = s->args->step,
                          .area = s->area,
                          .strength = s->strength,
                          .opening = s->opening,
                          .inverse = s->inverse,
                          .beta2 = s->beta2,
                          .normal = o->normal,
                          .sliding_square = rg_dot(o->tangential, o->tangential),
                          .effective = o->effective,
                          .before = before};
}

/* A conserving activation asks a law at its damage, or tells it the onset (cohesive/conserving.h). */
RG_INLINE void ask_at(rg_law_point *p, rg_vec damage, rg_vec onset, law_functions law,
                      rg_activation activation) {
    if (activation == RG_ACTIVATION_CONSERVING && law.follows) {
        p->onset = onset;
    } else if (activation == RG_ACTIVATION_CONSERVING) {
        p->effective = damage;
    }
}

RG_INLINE void load_memory(const interface *s, int memory, int q, rg_law_state *state) {
    for (int k = 0; k < memory; k++) {
        state->memory[k] = rg_load(memory_state(s, memory, q, k));
    }
}

RG_INLINE void store_memory(const interface *s, int memory, int q, rg_mask acting,
                            const rg_law_state *state) {
    for (int k = 0; k < memory; k++) {
        store_where(memory_state(s, memory, q, k), acting, state->memory[k]);
    }
}

/* delta_max of (3.19): the largest opening so far, of a conserving activation less its onset. Keeps it. */
RG_INLINE rg_vec grow(const interface *s, int q, rg_mask acting, rg_vec reached, rg_vec before) {
    rg_mask grows = acting & (reached > before);
    rg_vec largest = rg_select(grows, reached, before);
    if (rg_any(grows)) {
        rg_store(crack_state(s, q, RG_CRACK_OPENING), largest);
    }
    return largest;
}

/* Keeps the time at which points of the intrinsic form separate. */
RG_INLINE void note_separation(const interface *s, int q, rg_mask acting, rg_vec before, rg_vec largest) {
    rg_vec bound = separation(s, q, 0);
    rg_mask parted = acting & (largest >= bound) & (before < bound);
    if (rg_any(parted)) {
        store_where(crack_state(s, q, RG_CRACK_TIME), parted, rg_splat(s->args->time));
    }
}

/* Traction of the law at the opening o of the points that act by it, with their damage and memory. */
RG_INLINE void cohesive_traction(const interface *s, int q, const point_opening *o, rg_mask acting,
                                 law_functions law, rg_activation activation, rg_law_response *r) {
    bool conserving = activation == RG_ACTIVATION_CONSERVING;
    rg_vec before = rg_load(crack_state(s, q, RG_CRACK_OPENING)), eps = point_onset(s, q, activation);
    rg_vec reached = conserving ? rg_conserving_damage(o->effective, eps) : o->effective;
    rg_law_state state = {.largest = grow(s, q, acting, reached, before)};
    if (s->args->law.form == RG_FORM_INTRINSIC) {
        note_separation(s, q, acting, before, state.largest);
    }
    rg_law_point p = law_point(s, o, before);
    ask_at(&p, state.largest, eps, law, activation);
    load_memory(s, law.memory, q, &state);
    law.respond(&p, &state, r);
    if (conserving && !law.follows) {
        rg_conserving_respond(state.largest, eps, r);
    }
    store_memory(s, law.memory, q, acting, &state);
}

/* What of the law's work a point can give back, and what it has dissipated. */
RG_INLINE void cohesive_energy(const interface *s, int q, const point_opening *o, law_functions law,
                               rg_activation activation, rg_law_energy *e) {
    bool conserving = activation == RG_ACTIVATION_CONSERVING;
    rg_law_state state = {.largest = rg_load(crack_state(s, q, RG_CRACK_OPENING))};
    rg_law_point p = law_point(s, o, state.largest);
    rg_vec eps = point_onset(s, q, activation);
    load_memory(s, law.memory, q, &state);
    ask_at(&p, state.largest, eps, law, activation);
    law.energy(&p, &state, e);
    if (conserving && !law.follows) {
        rg_conserving_energy(state.largest, eps, o->effective, e);
    }
}

/* What came free where a point broke by a conserving activation beyond what its law can take, less what was
 * lent to it (J, of the whole face). */
RG_INLINE rg_vec unresolved_energy(const interface *s, int q, law_functions law) {
    rg_vec given = rg_load(crack_state(s, q, RG_CRACK_GIVEN));
    rg_vec rest = law.workless ? given : rg_conserving_unresolved(given, critical_opening(s, q, law.mixed));
    rg_vec beyond = s->area * s->strength * rest;
    return is_frictional(s) ? beyond - rg_load(loan_state(s, q)) : beyond;
}

#endif
