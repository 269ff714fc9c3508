/* The 12-node interface kernel. A face's traction at each of its six points is that of the DG terms (section
 * 2 of kernels/README.md; element/interface_face.h); where a point breaks or has broken it is, one after the
 * other,
 *     1. criterion   does it break, and from which opening       (5.3), (5.17)   interface_criterion.h
 *     2. law         traction of the opening and its history     section 7       interface_law.h
 *     3. contact     of closed points                            section 6       interface_contact.h
 *     4. friction    likewise                                    section 6       interface_friction.h
 *        and shear that fades, of points that break by opening alone             interface_bond.h
 * The same code does the faces inside a tile and its tile-boundary faces.
 *
 * A face without damage costs only the DG terms and a bound on its traction; the normal of the deformed
 * mid-surface and the steps above are computed, out of line, where a lane needs them; that part is compiled
 * once around each law and activation. Lanes that do not need them keep their bits: a face's result never
 * depends on the faces that share its block. */
#include "cohesive/facts.h"
#include "element/interface_bond.h"
#include "element/interface_contact.h"
#include "element/interface_criterion.h"
#include "element/interface_face.h"
#include "element/interface_friction.h"
#include "element/interface_law.h"
#include "element/interface_rise.h"
#include "library.h"

/* ---- Points of damaged faces ---- */

/* Step 1: the broken points, with those that break now. */
RG_INLINE rg_mask break_point(interface *s, int q, const vec3 n, rg_vec area, rg_mask broken,
                              rg_activation activation, int mixed) {
    cauchy t;
    cauchy_traction(s, q, n, area, &t);
    if (rises(s)) {
        raise_strength(s, q, &t, broken);
    }
    rg_mask now = breaking(s, q, &t, ~broken);
    if (rg_any(now)) {
        activate(s, q, n, &t, now, activation, mixed);
    }
    return broken | now;
}

/* Steps 2 and 3: the DG traction of broken points gives way to law and contact. Returns the points that keep
 * it, since they are closed under contact `flux`. */
RG_INLINE rg_mask broken_traction(interface *s, int q, vec3 g[2], const vec3 n, rg_mask broken,
                                  law_functions law, rg_activation activation, vec3 turn[RG_FNODES]) {
    point_opening o;
    crack_opening(s, q, n, &o);
    rg_mask closed = returning(s, &o, broken), acting = broken & ~closed;
    rg_law_response t;
    cohesive_traction(s, q, &o, acting, law, activation, &t);
    add_contact(s, q, g, &o, acting, &t, turn);
    for (int c = 0; c < 3; c++) {
        rg_vec all = t.shear * (t.weight * o.tangential[c]) + t.normal * n[c];
        s->total[q][c] = rg_select(acting, all, s->total[q][c]);
    }
    return closed;
}

RG_INLINE void damaged(interface *s, law_functions law, rg_activation activation) {
    const rg_interface_args *args = s->args;
    size_t first = s->block * RG_LANES + (size_t)s->lane;
    vec3 g[RG_POINTS][2], n[RG_POINTS], turn[RG_FNODES] = {{{0}}};
    rg_vec area[RG_POINTS];
    load_law(s);
    find_middle(s);
    mid_tangents(s, g);
    mid_surface(g, n, area);
    uint8_t broken[RG_VLEN], unlinked[RG_VLEN] = {0}, any = 0;
    memcpy(broken, args->broken + first, sizeof broken);
    for (int q = 0; q < RG_POINTS; q++) {
        rg_mask cracked = break_point(s, q, n[q], area[q], bit_mask(broken, q), activation, law.mixed);
        set_bits(broken, q, cracked);
        rg_mask closed = {0};
        if (rg_any(cracked)) {
            closed = broken_traction(s, q, g[q], n[q], cracked, law, activation, turn);
        }
        set_bits(unlinked, q, cracked & ~closed);
    }
    memcpy(args->broken + first, broken, sizeof broken);
    memcpy(args->unlinked + first, unlinked, sizeof unlinked);
    for (int l = 0; l < RG_VLEN; l++) {
        any |= broken[l];
    }
    if (any) {
        args->active[s->block] = 1;
    }
    if (args->law.contact == RG_CONTACT_POTENTIAL) {
        store_turn(s, turn);
    }
}

/* Step 4, once the others are done at all points; `before`: bits of those that were broken already. */
static __attribute__((noinline)) void rub(interface *s, const uint8_t before[RG_VLEN]) {
    const uint8_t *bits = s->args->broken + s->block * RG_LANES + s->lane;
    vec3 g[RG_POINTS][2], n[RG_POINTS], turn[RG_FNODES] = {{{0}}};
    rg_vec area[RG_POINTS];
    mid_tangents(s, g);
    mid_surface(g, n, area);
    if (s->args->law.contact == RG_CONTACT_POTENTIAL) {
        load_turn(s, turn);
    }
    for (int q = 0; q < RG_POINTS; q++) {
        rg_mask broken = bit_mask(bits, q);
        if (rg_any(broken)) {
            rg_mask now = broken & ~bit_mask(before, q);
            if (rises(s)) {
                load_risen_law(s, q);
            }
            add_friction(s, q, g[q], n[q], broken, now, turn);
            add_bond(s, q, g[q], n[q], broken, now, turn);
        }
    }
    if (s->args->law.contact == RG_CONTACT_POTENTIAL) {
        store_turn(s, turn);
    }
}

/* ---- One function around each law and activation ---- */

/* Of the two activations that are alike but for the onset. */
RG_INLINE rg_activation shifted(const interface *s) {
    return s->args->law.activation == RG_ACTIVATION_TOTAL ? RG_ACTIVATION_TOTAL : RG_ACTIVATION_CONTINUOUS;
}

#ifndef RG_USER_LAW
#define RG_INTERFACE_LAWS "laws.h" /* a library has but its own: user/law.c */
#endif

/* A law that a conserving activation cannot serve has nothing there: no case has it. */
#define RG_LAW(NAME, name, word, meaning, forms, work, separation, normal_slope, shear_slope, memory)        \
    static const law_functions law_##name = {rg_##name##_respond,                                            \
                                             rg_##name##_energy,                                             \
                                             memory,                                                         \
                                             ((forms)&RG_MIXED) != 0 ? (memory) : 0,                         \
                                             ((forms)&RG_FOLLOWS) != 0,                                      \
                                             ((forms)&RG_WORKLESS) != 0};                                    \
    static __attribute__((noinline)) void damaged_##name(interface *s) {                                     \
        damaged(s, law_##name, shifted(s));                                                                  \
    }                                                                                                        \
    static __attribute__((noinline)) void damaged_conserving_##name(interface *s) {                          \
        if (((forms)&RG_CONSERVES) != 0) {                                                                   \
            damaged(s, law_##name, RG_ACTIVATION_CONSERVING);                                                \
        }                                                                                                    \
    }
#include RG_INTERFACE_LAWS
#undef RG_LAW

static void (*const damaged_by_law[][RG_ACTIVATIONS])(interface *s) = {
#define RG_LAW(NAME, name, ...)                                                                              \
    [RG_LAW_##NAME] = {[RG_ACTIVATION_CONTINUOUS] = damaged_##name,                                          \
                       [RG_ACTIVATION_TOTAL] = damaged_##name,                                               \
                       [RG_ACTIVATION_CONSERVING] = damaged_conserving_##name},
#include RG_INTERFACE_LAWS
#undef RG_LAW
};

RG_INLINE void damaged_face(interface *s) {
    const rg_cohesive *law = &s->args->law;
    uint8_t before[RG_VLEN];
    memcpy(before, s->args->broken + s->block * RG_LANES + s->lane, sizeof before);
    damaged_by_law[law->law][law->activation](s);
    if (law->sliding != RG_SLIDING_FREE || law->shear != RG_SHEAR_RELEASED) {
        rub(s, before);
    }
}

/* ---- The kernel ---- */

RG_INLINE void interface_vector(const rg_interface_args *args, size_t block, int lane, bool tile_face) {
    interface s;
    load_interface(&s, args, block, lane, tile_face);
    jump_at_points(&s);
    mean_traction(&s);
    dg_traction(&s);
    if (args->active[block] || any_to_test(&s)) {
        damaged_face(&s);
    }
    store_nodal_force(&s);
}

/* Crack state of the next block that has some: it lies too far on for a processor to foresee. */
RG_INLINE void prefetch_cracks(const rg_interface_args *args, size_t block, size_t end) {
    if (block < end && args->active[block]) {
        const rg_real *state = args->crack + block * args->crack_stride;
        for (size_t k = 0; k < RG_CRACK_BLOCK; k += 64 / sizeof *state) {
            __builtin_prefetch(state + k, 1);
        }
    }
}

void RG_ISA_NAME(rg_interface)(const rg_interface_args *args, size_t begin, size_t end) {
#ifndef RG_USER_LAW
    if (args->law.law == RG_LAW_USER) {
        args->law.user->interface(args, begin, end);
        return;
    }
#endif
    for (size_t b = begin; b < end; b++) {
        prefetch_cracks(args, b + 1, end);
        for (int lane = 0; lane < RG_LANES; lane += RG_VLEN) {
            if (b < args->first_tile_face) {
                interface_vector(args, b, lane, false);
            } else {
                interface_vector(args, b, lane, true);
            }
        }
    }
}

/* ---- Energies ---- */

RG_INLINE void broken_energy(const interface *s, int q, const vec3 n, rg_mask broken, rg_mask unlinked,
                             rg_vec sum[RG_E_INTERFACE], law_functions law, rg_activation activation) {
    point_opening o;
    rg_law_energy e;
    crack_opening(s, q, n, &o);
    cohesive_energy(s, q, &o, law, activation, &e);
    rg_vec zero = {0}, weight = rg_splat(rg_tri[q / 3].weight);
    sum[RG_E_COHESIVE] += weight * rg_select(broken & unlinked, e.stored, zero);
    sum[RG_E_CONTACT] += weight * contact_energy(s, &o, broken);
    sum[RG_E_DISSIPATED] += weight * rg_select(broken, e.dissipated, zero);
    if (activation == RG_ACTIVATION_CONSERVING) {
        sum[RG_E_UNRESOLVED] += weight * rg_select(broken, unresolved_energy(s, q, law), zero);
    }
}

RG_INLINE void crack_energy(interface *s, rg_vec sum[RG_E_INTERFACE], law_functions law,
                            rg_activation activation) {
    const rg_interface_args *args = s->args;
    const uint8_t *broken = args->broken + s->block * RG_LANES + s->lane;
    const uint8_t *unlinked = args->unlinked + s->block * RG_LANES + s->lane;
    vec3 g[RG_POINTS][2], n[RG_POINTS];
    rg_vec area[RG_POINTS];
    load_law(s);
    mid_tangents(s, g);
    mid_surface(g, n, area);
    for (int q = 0; q < RG_POINTS; q++) {
        if (rises(s)) {
            load_risen_law(s, q);
        }
        broken_energy(s, q, n[q], bit_mask(broken, q), bit_mask(unlinked, q), sum, law, activation);
    }
}

#define RG_LAW(NAME, name, word, meaning, forms, ...)                                                        \
    static __attribute__((noinline)) void energy_##name(interface *s, rg_vec sum[RG_E_INTERFACE]) {          \
        crack_energy(s, sum, law_##name, shifted(s));                                                        \
    }                                                                                                        \
    static                                                                                                   \
        __attribute__((noinline)) void energy_conserving_##name(interface *s, rg_vec sum[RG_E_INTERFACE]) {  \
        if (((forms)&RG_CONSERVES) != 0) {                                                                   \
            crack_energy(s, sum, law_##name, RG_ACTIVATION_CONSERVING);                                      \
        }                                                                                                    \
    }
#include RG_INTERFACE_LAWS
#undef RG_LAW

static void (*const energy_by_law[][RG_ACTIVATIONS])(interface *s, rg_vec sum[RG_E_INTERFACE]) = {
#define RG_LAW(NAME, name, ...)                                                                              \
    [RG_LAW_##NAME] = {[RG_ACTIVATION_CONTINUOUS] = energy_##name,                                           \
                       [RG_ACTIVATION_TOTAL] = energy_##name,                                                \
                       [RG_ACTIVATION_CONSERVING] = energy_conserving_##name},
#include RG_INTERFACE_LAWS
#undef RG_LAW
};

/* What springs store counts as contact. */
static __attribute__((noinline)) void rubbing_energy(const interface *s, rg_vec sum[RG_E_INTERFACE]) {
    const uint8_t *bits = s->args->broken + s->block * RG_LANES + s->lane;
    for (int q = 0; q < RG_POINTS; q++) {
        sum[RG_E_CONTACT] += friction_energy(s, q, bit_mask(bits, q));
    }
}

static __attribute__((noinline)) void bonding_energy(interface *s, rg_vec sum[RG_E_INTERFACE]) {
    const uint8_t *bits = s->args->broken + s->block * RG_LANES + s->lane;
    load_law(s);
    for (int q = 0; q < RG_POINTS; q++) {
        bond_energy(s, q, bit_mask(bits, q), sum);
    }
}

RG_INLINE void state_vector(const rg_interface_state_args *args, size_t block, size_t row, int lane) {
    interface s;
    load_interface(&s, args->interface, block, lane, block >= args->interface->first_tile_face);
    jump_at_points(&s);
    rg_vec sum[RG_E_INTERFACE] = {{0}};
    const uint8_t *unlinked = s.args->unlinked + block * RG_LANES + lane;
    for (int q = 0; q < RG_POINTS; q++) {
        rg_vec along = rg_dot(s.normal, s.jump[q]);
        rg_vec penalty = s.pen_iso * rg_dot(s.jump[q], s.jump[q]) + s.pen_norm * along * along;
        sum[RG_E_PENALTY] +=
            rg_select(bit_mask(unlinked, q), rg_splat(0.0), rg_splat(0.5 * rg_tri[q / 3].weight) * penalty);
    }
    if (s.args->active[block]) {
        energy_by_law[s.args->law.law][s.args->law.activation](&s, sum);
        if (s.args->law.sliding == RG_SLIDING_COULOMB) {
            rubbing_energy(&s, sum);
        }
        if (s.args->law.shear == RG_SHEAR_FADING) {
            bonding_energy(&s, sum);
        }
    }
    for (size_t k = 0; k < RG_E_INTERFACE; k++) {
        rg_store_wide(args->energy + (row * RG_E_INTERFACE + k) * RG_LANES + lane, sum[k]);
    }
}

void RG_ISA_NAME(rg_interface_state)(const rg_interface_state_args *args, size_t begin, size_t end) {
#ifndef RG_USER_LAW
    if (args->interface->law.law == RG_LAW_USER) {
        args->interface->law.user->interface_state(args, begin, end);
        return;
    }
#endif
    for (size_t b = begin; b < end; b++) {
        for (int lane = 0; lane < RG_LANES; lane += RG_VLEN) {
            state_vector(args, b, b - begin, lane);
        }
    }
}
