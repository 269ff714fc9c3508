/* Step 4 at the broken points of a face: friction of closed ones (section 6 of kernels/README.md), on top of
 * law and contact. Apart from these: runs without it need not pay for it. */
#ifndef RG_INTERFACE_FRICTION_H
#define RG_INTERFACE_FRICTION_H

#include "cohesive/friction.h"
#include "element/interface_crack.h"

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

/* mu D p of a point (N); 0 where it is open, or broke in this very state. */
RG_INLINE rg_vec friction_limit(const interface *s, int q, const point_opening *o, rg_mask broken_before) {
    const rg_cohesive *law = &s->args->law;
    rg_vec damage = rg_splat(1.0);
    if (law->separation > 0) {
        damage = rg_min(rg_load(crack_state(s, q, RG_CRACK_OPENING)) / separation(s), damage);
    }
    rg_vec pressure = s->contact * rg_max(-o->normal, rg_splat(0.0));
    return rg_select(broken_before, of_face(s, s->args->friction, law->friction) * damage * pressure,
                     rg_splat(0.0));
}

/* The elastic predictor and the return to |t_t| <= mu D p (cohesive/friction.h). */
RG_INLINE void add_coulomb(interface *s, int q, const vec3 n, const point_opening *o, rg_mask broken,
                           rg_mask now) {
    vec3 along[2];
    rg_vec state[RG_FRICTION], drag[2];
    tangents(s, n, along);
    rg_friction_point p = {.slip = {rg_dot(o->tangential, along[0]), rg_dot(o->tangential, along[1])},
                           .stiffness = s->pen_iso,
                           .limit = friction_limit(s, q, o, broken & ~now),
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

/* Its spring alone, without limit or memory. */
RG_INLINE void add_spring(interface *s, int q, const point_opening *o, rg_mask broken) {
    for (int c = 0; c < 3; c++) {
        s->total[q][c] += rg_select(broken, s->pen_iso * o->tangential[c], rg_splat(0.0));
    }
}

/* Adds friction to the traction of broken points; `now`: those that broke in this state. */
RG_INLINE void add_friction(interface *s, int q, const vec3 n, rg_mask broken, rg_mask now) {
    point_opening o;
    crack_opening(s, q, n, &o);
    switch (s->args->law.sliding) {
    case RG_SLIDING_FREE:
        break;
    case RG_SLIDING_COULOMB:
        add_coulomb(s, q, n, &o, broken, now);
        break;
    case RG_SLIDING_STUCK:
        add_spring(s, q, &o, broken);
        break;
    }
}

/* What springs store at broken points. */
RG_INLINE rg_vec friction_energy(const interface *s, int q, rg_mask broken) {
    rg_vec stretch[2] = {rg_load(friction_state(s, q, RG_FRICTION_STRETCH)),
                         rg_load(friction_state(s, q, RG_FRICTION_STRETCH + 1))};
    rg_vec stored = rg_splat(rg_tri[q / 3].weight) * rg_friction_stored(s->pen_iso, stretch);
    return rg_select(broken, stored, rg_splat(0.0));
}

#endif
