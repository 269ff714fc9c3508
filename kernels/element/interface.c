/* The 12-node interface kernel: DG traction, fracture, cohesive law and contact at the six points of a face.
 *
 * The same code does the faces inside a tile and its tile-boundary faces (element/interface_face.h).
 *
 * A face without damage costs only the DG terms and a bound on its traction; the normal of the deformed
 * mid-surface, the criterion and the cohesive law are computed, out of line, where a lane needs them; that
 * part is compiled once around each law (cohesive/cohesive.h). Lanes that do not need them keep their bits: a
 * face's result never depends on the faces that share its block. */
#include "cohesive/cohesive.h"
#include "cohesive/conserving.h"
#include "cohesive/facts.h"
#include "cohesive/friction.h"
#include "element/interface_face.h"

RG_INLINE rg_vec scale(const interface *s, int k) {
    return rg_load(s->args->scale + (s->block * 2 + (size_t)k) * RG_LANES + s->lane);
}

/* The Piola traction below which a point is not tested: half the strength, as an area-weighted square. */
RG_INLINE rg_vec test_bound(const interface *s) {
    double beta = s->args->law.beta, strength = s->args->law.strength;
    double reach = beta > 0 && beta < 1 ? 1 / (beta * beta) : 1;
    rg_vec bound = rg_splat(0.25 * strength * strength / reach) * s->area_square;
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

/* ---- Damaged faces ---- */

RG_INLINE rg_mask bit_mask(const uint8_t bits[RG_VLEN], int q) {
    rg_mask m;
    for (int l = 0; l < RG_VLEN; l++) {
        m[l] = -(rg_word)((bits[l] >> q) & 1);
    }
    return m;
}

RG_INLINE void set_bits(uint8_t bits[RG_VLEN], int q, rg_mask m) {
    for (int l = 0; l < RG_VLEN; l++) {
        bits[l] = (uint8_t)((bits[l] & ~(1 << q)) | ((m[l] & 1) << q));
    }
}

RG_INLINE rg_real *crack_state(const interface *s, int q, int k) {
    return s->args->crack + s->block * s->args->crack_stride + (q * RG_CRACK + k) * RG_LANES + s->lane;
}

RG_INLINE rg_real *memory_state(const interface *s, int memory, int q, int k) {
    return s->args->crack + s->block * s->args->crack_stride + RG_CRACK_BLOCK + (q * memory + k) * RG_LANES +
           s->lane;
}

/* Parameters of the law on these faces. */
RG_INLINE void load_law(interface *s) {
    const rg_cohesive *law = &s->args->law;
    s->area = rg_sqrt(s->area_square);
    s->strength = rg_splat(law->strength);
    s->strong_area = s->area;
    s->opening = rg_splat(law->opening);
    s->inverse = rg_splat(1.0 / law->opening);
    s->contact = normal_penalty(s);
    if (law->slope > 0 && s->args->scale == NULL) {
        s->contact = rg_max(s->contact, s->area * rg_splat(law->slope));
    }
    if (s->args->scale != NULL) {
        s->strength *= scale(s, 0);
        s->strong_area *= scale(s, 0);
        s->opening *= scale(s, 1);
        s->inverse = 1.0 / s->opening;
        s->contact = rg_max(s->contact, s->area * rg_splat(law->slope) * scale(s, 0) / scale(s, 1));
    }
}

/* Writes x where m is set; where nothing is set nothing is touched (untouched pages cost no memory). */
RG_INLINE void store_where(rg_real *p, rg_mask m, rg_vec x) {
    rg_store(p, rg_select(m, x, rg_load(p)));
}

/* Opening eps from which a point that switches starts (m); 0 where the law takes the total jump. */
RG_INLINE rg_vec onset(const interface *s, bool conserving) {
    const rg_cohesive *law = &s->args->law;
    double share = law->total ? 0.0 : conserving ? law->onset : RG_ONSET;
    return rg_splat(share * law->strength) * s->strong_area / normal_penalty(s);
}

/* Fracture criterion at unbroken points (5.3; beta = 0: 5.17), on the Cauchy traction: which lanes switch
 * now. The crack state starts so that the cohesive traction continues the one at the switch in direction and
 * size (Papoulia's time continuity): the opening is measured from `origin` = [u] - eps d, d along the
 * traction; of a conserving activation [u] - delta_0 d (cohesive/conserving.h). */
RG_INLINE rg_mask switch_points(const interface *s, int q, const vec3 n, rg_vec area, rg_mask intact,
                                bool conserving) {
    const rg_cohesive *law = &s->args->law;
    vec3 t, tau, d;
    for (int c = 0; c < 3; c++) {
        t[c] = s->mean[q][c] / rg_max(area, rg_splat(RG_NO_AREA));
    }
    rg_vec shear = rg_splat(law->beta > 0 ? 1 / (law->beta * law->beta) : 0);
    rg_vec tn = rg_dot(t, n), tension = rg_max(tn, rg_splat(0.0));
    for (int c = 0; c < 3; c++) {
        tau[c] = t[c] - tn * n[c];
    }
    rg_vec effective = rg_sqrt(tension * tension + shear * rg_dot(tau, tau));
    rg_mask tested =
        (s->area_square > 0.0) & (rg_dot(s->mean[q], s->mean[q]) > test_bound(s)); /* padding has no area */
    rg_mask now = intact & tested & (effective > s->strength);
    if (!rg_any(now)) {
        return now;
    }
    rg_vec start = onset(s, conserving), first = start;
    if (conserving) {
        rg_vec slid = rg_splat(law->beta > 0 ? 1.0 : 0.0) * rg_dot(tau, s->jump[q]);
        rg_vec along = rg_dot(s->normal, s->jump[q]);
        rg_vec penalty = s->pen_iso * rg_dot(s->jump[q], s->jump[q]) + s->pen_norm * along * along;
        double kept = law->beta_s > RG_LIFT ? 0.5 * (1 - RG_LIFT / law->beta_s) : 0;
        rg_vec given = (slid + tension * rg_dot(n, s->jump[q])) / effective +
                       rg_splat(kept) * penalty / (s->area * s->strength);
        first = rg_conserving_first(given, s->opening);
        start = rg_conserving_start(given, first, start);
    }
    for (int c = 0; c < 3; c++) {
        d[c] = (shear * tau[c] + tension * n[c]) / effective;
        rg_vec origin = law->total ? rg_splat(0.0) : s->jump[q][c] - start * d[c];
        store_where(crack_state(s, q, RG_CRACK_ORIGIN + c), now, origin);
    }
    store_where(crack_state(s, q, RG_CRACK_OPENING), now, first);
    store_where(crack_state(s, q, RG_CRACK_TIME), now, rg_splat(s->args->time));
    return now;
}

/* Opening of a broken point: w = [u] - origin, split along n. */
typedef struct {
    vec3 tangential;
    rg_vec normal, effective;
} opening;

RG_INLINE void crack_opening(const interface *s, int q, const vec3 n, opening *o) {
    vec3 w;
    for (int c = 0; c < 3; c++) {
        w[c] = s->jump[q][c] - rg_load(crack_state(s, q, RG_CRACK_ORIGIN + c));
    }
    o->normal = rg_dot(w, n);
    for (int c = 0; c < 3; c++) {
        o->tangential[c] = w[c] - o->normal * n[c];
    }
    rg_vec beta2 = rg_splat(s->args->law.beta * s->args->law.beta);
    rg_vec open = rg_max(o->normal, rg_splat(0.0));
    o->effective = rg_sqrt(beta2 * rg_dot(o->tangential, o->tangential) + open * open);
}

typedef void law_respond(const rg_law_point *p, rg_law_state *state, rg_law_response *r);
typedef void law_energy(const rg_law_point *p, const rg_law_state *state, rg_law_energy *e);

RG_INLINE rg_law_point law_point(const interface *s, const opening *o, rg_vec before) {
    return (rg_law_point){.law = &s->args->law,
                          .step = s->args->step,
                          .area = s->area,
                          .strength = s->strength,
                          .opening = s->opening,
                          .inverse = s->inverse,
                          .normal = o->normal,
                          .sliding_square = rg_dot(o->tangential, o->tangential),
                          .effective = o->effective,
                          .before = before};
}

RG_INLINE void load_memory(const interface *s, int memory, int q, rg_law_state *state) {
    for (int k = 0; k < memory; k++) {
        state->memory[k] = rg_load(memory_state(s, memory, q, k));
    }
}

/* Keeps the time at which points of the intrinsic form separate. */
RG_INLINE void note_separation(const interface *s, int q, rg_mask acting, rg_vec before, rg_vec largest) {
    const rg_cohesive *law = &s->args->law;
    rg_vec bound = s->opening * rg_splat(law->separation / law->opening);
    rg_mask parted = acting & (largest >= bound) & (before < bound);
    if (rg_any(parted)) {
        store_where(crack_state(s, q, RG_CRACK_TIME), parted, rg_splat(s->args->time));
    }
}

/* How much of a face still faces the other one: (1 - (|w_t|^2 + (4 w_n)^2)/area)^2, down to 0; here its root.
 * It falls as they slide off each other; and a side that comes back from elsewhere must not count as deep
 * inside. Where faces are pressed w_n is some thousandths of their size. */
#define DEPTHS 16.0
RG_INLINE rg_vec overlap_root(const interface *s, const opening *o) {
    rg_vec apart = rg_dot(o->tangential, o->tangential) + DEPTHS * (o->normal * o->normal);
    return rg_max(1.0 - apart / rg_max(s->area, rg_splat(RG_NO_AREA)), rg_splat(0.0));
}

/* Traction along n, and over w_t (N/m). */
typedef struct {
    rg_vec along, sliding;
} traction;

/* Contact as a potential, over `touching` = min(0, w_n): E = c/2 w_n^2 root^2. */
RG_INLINE void add_potential_contact(const interface *s, const opening *o, rg_vec touching, traction *t) {
    rg_vec root = overlap_root(s, o), pressed = s->contact * touching * root;
    rg_vec away = 2.0 * pressed * touching / rg_max(s->area, rg_splat(RG_NO_AREA));
    t->along += pressed * root - DEPTHS * away * touching;
    t->sliding -= away;
}

/* A potential of w_n = w . n and w_t = w - w_n n also depends on n, by (along - sliding w_n) w_t . dn, and
 *     w_t . dn = (dg1 . (g2 x w_t) + dg2 . (w_t x g1))/|g1 x g2|.
 * Adds the nodal forces that follow, of which either side bears one half. */
RG_INLINE void add_turn(int q, vec3 g[2], const opening *o, const traction *t, rg_mask acting,
                        vec3 turn[RG_FNODES]) {
    rg_real xi[RG_FNODES], eta[RG_FNODES];
    face_derivatives(q, xi, eta);
    vec3 w, across, one, two;
    for (int c = 0; c < 3; c++) {
        w[c] = o->tangential[c];
    }
    rg_cross(g[0], g[1], across);
    rg_cross(g[1], w, one);
    rg_cross(w, g[0], two);
    rg_vec twice = rg_sqrt(rg_dot(across, across));
    rg_vec factor = rg_splat(-0.5 * rg_tri[q / 3].weight) * (t->along - t->sliding * o->normal) /
                    rg_max(twice, rg_splat(RG_NO_AREA));
    factor = rg_select(acting, factor, rg_splat(0.0));
    for (int a = 0; a < RG_FNODES; a++) {
        for (int c = 0; c < 3; c++) {
            turn[a][c] += factor * (xi[a] * one[c] + eta[a] * two[c]);
        }
    }
}

RG_INLINE void store_turn(const interface *s, vec3 turn[RG_FNODES]) {
    rg_real *to = s->args->turn + s->block * RG_IFORCE_BLOCK + s->lane;
    for (int a = 0; a < RG_FNODES; a++) {
        for (int c = 0; c < 3; c++) {
            rg_store(to + (a * 3 + c) * RG_LANES, turn[a][c]);
        }
    }
}

/* Replaces the DG traction at broken points by the cohesive law and contact. Returns the points that keep
 * their DG terms because they are closed under flux contact. */
RG_INLINE rg_mask broken_traction(interface *s, int q, vec3 g[2], const vec3 n, rg_mask broken,
                                  law_respond *respond, int memory, bool conserving, vec3 turn[RG_FNODES]) {
    const rg_cohesive *law = &s->args->law;
    opening o;
    crack_opening(s, q, n, &o);
    rg_mask closed = (law->flux ? broken : (rg_mask){0}) & (o.normal < 0.0);
    rg_mask acting = broken & ~closed;
    rg_vec before = rg_load(crack_state(s, q, RG_CRACK_OPENING)), eps = onset(s, conserving);
    rg_vec reached = conserving ? rg_conserving_damage(o.effective, eps) : o.effective;
    rg_mask grows = acting & (reached > before);
    rg_law_state state = {.largest = rg_select(grows, reached, before)};
    if (conserving) {
        o.effective = state.largest;
    }
    if (rg_any(grows)) {
        rg_store(crack_state(s, q, RG_CRACK_OPENING), state.largest);
    }
    if (law->intrinsic) {
        note_separation(s, q, acting, before, state.largest);
    }
    rg_law_point p = law_point(s, &o, before);
    rg_law_response r;
    load_memory(s, memory, q, &state);
    respond(&p, &state, &r);
    if (conserving) {
        rg_conserving_respond(state.largest, eps, &r);
    }
    for (int k = 0; k < memory; k++) {
        store_where(memory_state(s, memory, q, k), acting, state.memory[k]);
    }
    rg_vec touching = rg_select(o.normal < rg_splat(law->contact_below), o.normal, rg_splat(0.0));
    if (law->potential) {
        traction t = {r.normal, r.shear * r.weight};
        add_potential_contact(s, &o, touching, &t);
        add_turn(q, g, &o, &t, acting, turn);
        for (int c = 0; c < 3; c++) {
            rg_vec all = t.sliding * o.tangential[c] + t.along * n[c];
            s->total[q][c] = rg_select(acting, all, s->total[q][c]);
        }
        return closed;
    }
    rg_vec along = r.normal + rg_splat(law->flux ? 0.0 : 1.0) * s->contact * touching;
    for (int c = 0; c < 3; c++) {
        rg_vec t = r.shear * (r.weight * o.tangential[c]) + along * n[c];
        s->total[q][c] = rg_select(acting, t, s->total[q][c]);
    }
    return closed;
}

RG_INLINE void damaged(interface *s, law_respond *respond, int memory, bool conserving) {
    const rg_interface_args *args = s->args;
    size_t first = s->block * RG_LANES + (size_t)s->lane;
    vec3 g[RG_POINTS][2], n[RG_POINTS], turn[RG_FNODES] = {{{0}}};
    rg_vec area[RG_POINTS];
    load_law(s);
    mid_tangents(s, g);
    mid_surface(g, n, area);
    uint8_t broken[RG_VLEN], unlinked[RG_VLEN] = {0}, any = 0;
    memcpy(broken, args->broken + first, sizeof broken);
    for (int q = 0; q < RG_POINTS; q++) {
        rg_mask cracked = bit_mask(broken, q);
        cracked |= switch_points(s, q, n[q], area[q], ~cracked, conserving);
        set_bits(broken, q, cracked);
        rg_mask closed = {0};
        if (rg_any(cracked)) {
            closed = broken_traction(s, q, g[q], n[q], cracked, respond, memory, conserving, turn);
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
    if (args->law.potential) {
        store_turn(s, turn);
    }
}

/* The same around each law; conserving around those that can be (empty for the others). */
#define RG_LAW(NAME, name, word, meaning, forms, work, separation, normal_slope, shear_slope, memory)        \
    static __attribute__((noinline)) void damaged_##name(interface *s) {                                     \
        damaged(s, rg_##name##_respond, memory, false);                                                      \
    }                                                                                                        \
    static __attribute__((noinline)) void damaged_conserving_##name(interface *s) {                          \
        if (((forms)&RG_ENVELOPE) != 0) {                                                                    \
            damaged(s, rg_##name##_respond, memory, true);                                                   \
        }                                                                                                    \
    }
#include "laws.h"
#undef RG_LAW

static void (*const damaged_by_law[][2])(interface *s) = {
#define RG_LAW(NAME, name, ...) {damaged_##name, damaged_conserving_##name},
#include "laws.h"
#undef RG_LAW
};

/* ---- Friction (cohesive/friction.h): apart from the rest, which runs without it need not pay for ---- */

RG_INLINE rg_real *friction_state(const interface *s, int q, int k) {
    return s->args->crack + rg_friction_index(s->block * RG_LANES, q, k, s->args->crack_stride) + s->lane;
}

/* Tangents of the deformed mid-surface at a point of normal n: along the chord from corner 0 to 1, and across
 * it. */
RG_INLINE void tangents(const interface *s, const vec3 n, vec3 along[2]) {
    vec3 one[RG_FNODES], two[RG_FNODES];
    traces(s, one, two);
    for (int c = 0; c < 3; c++) {
        along[0][c] = s->edge[0][c] + 0.5 * ((one[1][c] + two[1][c]) - (one[0][c] + two[0][c]));
    }
    rg_vec across = rg_dot(along[0], n);
    for (int c = 0; c < 3; c++) {
        along[0][c] -= across * n[c];
    }
    rg_vec length = rg_max(rg_sqrt(rg_dot(along[0], along[0])), rg_splat(RG_NO_AREA));
    for (int c = 0; c < 3; c++) {
        along[0][c] /= length;
    }
    rg_cross(n, along[0], along[1]);
}

/* mu D p of a point (N); 0 where it is open, or switched in this very state. */
RG_INLINE rg_vec friction_limit(const interface *s, int q, const opening *o, rg_mask settled) {
    const rg_cohesive *law = &s->args->law;
    rg_vec damage = rg_splat(1.0);
    if (law->separation > 0) {
        rg_vec parted = s->opening * rg_splat(law->separation / law->opening);
        damage = rg_min(rg_load(crack_state(s, q, RG_CRACK_OPENING)) / parted, damage);
    }
    rg_vec pressure = s->contact * rg_max(-o->normal, rg_splat(0.0));
    return rg_select(settled, rg_splat(law->friction) * damage * pressure, rg_splat(0.0));
}

/* Adds friction to the traction of broken points; `now`: those that switched in this state. */
RG_INLINE void rub_point(interface *s, int q, const vec3 n, rg_mask broken, rg_mask now) {
    opening o;
    crack_opening(s, q, n, &o);
    if (s->args->law.stick) {
        for (int c = 0; c < 3; c++) {
            s->total[q][c] += rg_select(broken, s->pen_iso * o.tangential[c], rg_splat(0.0));
        }
        return;
    }
    vec3 along[2];
    rg_vec state[RG_FRICTION], drag[2];
    tangents(s, n, along);
    rg_friction_point p = {.slip = {rg_dot(o.tangential, along[0]), rg_dot(o.tangential, along[1])},
                           .stiffness = s->pen_iso,
                           .limit = friction_limit(s, q, &o, broken & ~now),
                           .weight = rg_splat(rg_tri[q / 3].weight)};
    for (int k = 0; k < RG_FRICTION; k++) {
        state[k] = rg_load(friction_state(s, q, k));
    }
    rg_friction_return(&p, state, drag);
    for (int k = 0; k < RG_FRICTION; k++) {
        store_where(friction_state(s, q, k), broken, state[k]);
    }
    for (int c = 0; c < 3; c++) {
        rg_vec t = drag[0] * along[0][c] + drag[1] * along[1][c];
        s->total[q][c] += rg_select(broken, t, rg_splat(0.0));
    }
}

/* The law, then friction on top. */
static __attribute__((noinline)) void damaged_with_friction(interface *s) {
    const uint8_t *bits = s->args->broken + s->block * RG_LANES + s->lane;
    uint8_t before[RG_VLEN];
    vec3 g[RG_POINTS][2], n[RG_POINTS];
    rg_vec area[RG_POINTS];
    memcpy(before, bits, sizeof before);
    damaged_by_law[s->args->law.law][s->args->law.onset > 0](s);
    mid_tangents(s, g);
    mid_surface(g, n, area);
    for (int q = 0; q < RG_POINTS; q++) {
        rg_mask broken = bit_mask(bits, q);
        if (rg_any(broken)) {
            rub_point(s, q, n[q], broken, broken & ~bit_mask(before, q));
        }
    }
}

/* What springs store counts as contact. */
static __attribute__((noinline)) void friction_energy(const interface *s, rg_vec sum[RG_E_INTERFACE]) {
    const uint8_t *bits = s->args->broken + s->block * RG_LANES + s->lane;
    for (int q = 0; q < RG_POINTS; q++) {
        rg_vec stretch[2] = {rg_load(friction_state(s, q, RG_FRICTION_STRETCH)),
                             rg_load(friction_state(s, q, RG_FRICTION_STRETCH + 1))};
        rg_vec stored = rg_splat(rg_tri[q / 3].weight) * rg_friction_stored(s->pen_iso, stretch);
        sum[RG_E_CONTACT] += rg_select(bit_mask(bits, q), stored, rg_splat(0.0));
    }
}

RG_INLINE void interface_vector(const rg_interface_args *args, size_t block, int lane, bool tile_face) {
    interface s;
    load_interface(&s, args, block, lane, tile_face);
    jump_at_points(&s);
    mean_traction(&s);
    dg_traction(&s);
    if (args->active[block] || any_to_test(&s)) {
        if (args->law.friction > 0) {
            damaged_with_friction(&s);
        } else {
            damaged_by_law[args->law.law][args->law.onset > 0](&s);
        }
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
                             rg_vec sum[RG_E_INTERFACE], law_energy *energy, int memory, bool conserving) {
    const rg_cohesive *law = &s->args->law;
    opening o;
    crack_opening(s, q, n, &o);
    rg_vec zero = {0}, weight = rg_splat(rg_tri[q / 3].weight);
    rg_law_state state = {.largest = rg_load(crack_state(s, q, RG_CRACK_OPENING))};
    rg_law_point p = law_point(s, &o, state.largest);
    rg_law_energy e;
    load_memory(s, memory, q, &state);
    if (conserving) {
        p.effective = state.largest;
    }
    energy(&p, &state, &e);
    if (conserving) {
        rg_conserving_energy(state.largest, onset(s, true), o.effective, &e);
    }
    rg_vec contact = 0.5 * s->contact * o.normal * o.normal;
    if (law->potential) {
        rg_vec root = overlap_root(s, &o);
        contact *= root * root;
    }
    rg_mask touching = law->flux ? (rg_mask){0} : broken & (o.normal < rg_splat(law->contact_below));
    sum[RG_E_COHESIVE] += weight * rg_select(broken & unlinked, e.stored, zero);
    sum[RG_E_CONTACT] += weight * rg_select(touching, contact, zero);
    sum[RG_E_DISSIPATED] += weight * rg_select(broken, e.dissipated, zero);
}

RG_INLINE void crack_energy(interface *s, rg_vec sum[RG_E_INTERFACE], law_energy *energy, int memory,
                            bool conserving) {
    const rg_interface_args *args = s->args;
    const uint8_t *broken = args->broken + s->block * RG_LANES + s->lane;
    const uint8_t *unlinked = args->unlinked + s->block * RG_LANES + s->lane;
    vec3 g[RG_POINTS][2], n[RG_POINTS];
    rg_vec area[RG_POINTS];
    load_law(s);
    mid_tangents(s, g);
    mid_surface(g, n, area);
    for (int q = 0; q < RG_POINTS; q++) {
        broken_energy(s, q, n[q], bit_mask(broken, q), bit_mask(unlinked, q), sum, energy, memory,
                      conserving);
    }
}

#define RG_LAW(NAME, name, word, meaning, forms, work, separation, normal_slope, shear_slope, memory)        \
    static __attribute__((noinline)) void energy_##name(interface *s, rg_vec sum[RG_E_INTERFACE]) {          \
        crack_energy(s, sum, rg_##name##_energy, memory, false);                                             \
    }                                                                                                        \
    static                                                                                                   \
        __attribute__((noinline)) void energy_conserving_##name(interface *s, rg_vec sum[RG_E_INTERFACE]) {  \
        if (((forms)&RG_ENVELOPE) != 0) {                                                                    \
            crack_energy(s, sum, rg_##name##_energy, memory, true);                                          \
        }                                                                                                    \
    }
#include "laws.h"
#undef RG_LAW

static void (*const energy_by_law[][2])(interface *s, rg_vec sum[RG_E_INTERFACE]) = {
#define RG_LAW(NAME, name, ...) {energy_##name, energy_conserving_##name},
#include "laws.h"
#undef RG_LAW
};

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
        energy_by_law[s.args->law.law][s.args->law.onset > 0](&s, sum);
        if (s.args->law.friction > 0) {
            friction_energy(&s, sum);
        }
    }
    for (size_t k = 0; k < RG_E_INTERFACE; k++) {
        rg_store_wide(args->energy + (row * RG_E_INTERFACE + k) * RG_LANES + lane, sum[k]);
    }
}

void RG_ISA_NAME(rg_interface_state)(const rg_interface_state_args *args, size_t begin, size_t end) {
    for (size_t b = begin; b < end; b++) {
        for (int lane = 0; lane < RG_LANES; lane += RG_VLEN) {
            state_vector(args, b, b - begin, lane);
        }
    }
}
