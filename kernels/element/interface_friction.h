/* Step 4 at the broken points of a face: friction of closed ones (section 6 of kernels/README.md), on top of
 * law and contact. Apart from these: runs without it need not pay for it. */
#ifndef RG_INTERFACE_FRICTION_H
#define RG_INTERFACE_FRICTION_H

#include "cohesive/friction.h"
#include "element/interface_contact.h"
#include "element/interface_criterion.h"

/* Tangents of the deformed mid-surface at a point of normal n: along the chord from corner 0 to 1, and across
 * it. */
typedef struct {
    vec3 along[2];
    rg_vec length; /* of the chord's part in the surface (m) */
    rg_vec rise;   /* its part along n (m) */
} surface_frame;

RG_INLINE void tangents(const interface *s, const vec3 n, surface_frame *f) {
    vec3 *along = f->along;
    for (int c = 0; c < 3; c++) {
        along[0][c] = s->edge[0][c] + (s->middle[1][c] - s->middle[0][c]);
    }
    f->rise = rg_dot(along[0], n);
    for (int c = 0; c < 3; c++) {
        along[0][c] -= f->rise * n[c];
    }
    f->length = rg_max(rg_sqrt(rg_dot(along[0], along[0])), rg_splat(RG_NO_AREA));
    for (int c = 0; c < 3; c++) {
        along[0][c] /= f->length;
    }
    rg_cross(n, along[0], along[1]);
}

/* Slip s_k = w . a_k also follows the frame: for drag d = d_0 a_0 + d_1 a_1 of the springs
 *     sum d_k w . da_k = -w_n d . dn + (d_0 s_1 - d_1 s_0) (a_1 . dc - (c . n) a_1 . dn)/|c_t|,
 * c the chord and c_t its part in the surface. Adds the nodal forces that follow, of which either side bears
 * one half: with them springs are potentials, and what acts on both sides is without a moment. */
RG_INLINE void turn_with_frame(int q, vec3 g[2], const surface_frame *f, const rg_friction_point *p,
                               const rg_vec drag[2], const point_opening *o, rg_mask broken,
                               vec3 turn[RG_FNODES]) {
    rg_vec spin = (drag[0] * p->slip[1] - drag[1] * p->slip[0]) / f->length;
    vec3 v;
    for (int c = 0; c < 3; c++) {
        v[c] = -o->normal * (drag[0] * f->along[0][c] + drag[1] * f->along[1][c]) -
               spin * f->rise * f->along[1][c];
        rg_vec end = rg_select(broken, rg_splat(-0.5) * p->weight * spin * f->along[1][c], rg_splat(0.0));
        turn[1][c] += end;
        turn[0][c] -= end;
    }
    add_turn_along(q, g, v, rg_splat(1.0), broken, turn);
}

/* mu D p of a point (N); 0 where it is open, or broke in this very state. With Mohr and Coulomb's criterion
 * mu p, from the first state on: it is what that adds to the strength. */
RG_INLINE rg_vec friction_limit(const interface *s, int q, const point_opening *o, rg_mask broken_before) {
    const rg_cohesive *law = &s->args->law;
    if (is_frictional(s)) {
        return of_face(s, s->args->friction, law->friction) * contact_pressure(s, o);
    }
    rg_vec damage = point_damage(s, q);
    rg_vec pressure = contact_pressure(s, o);
    return rg_select(broken_before, of_face(s, s->args->friction, law->friction) * damage * pressure,
                     rg_splat(0.0));
}

/* Springs of points that break now hold what friction held of the traction, so that it goes on. */
RG_INLINE void load_springs(const interface *s, int q, const vec3 n, const surface_frame *f,
                            const rg_friction_point *p, rg_mask now, rg_vec state[RG_FRICTION]) {
    vec3 held;
    held_by_friction(s, q, n, held);
    for (int k = 0; k < 2; k++) {
        rg_vec stretch = rg_dot(held, f->along[k]) / p->stiffness;
        state[RG_FRICTION_STRETCH + k] = rg_select(now, stretch, state[RG_FRICTION_STRETCH + k]);
        state[RG_FRICTION_ANCHOR + k] = rg_select(now, p->slip[k] - stretch, state[RG_FRICTION_ANCHOR + k]);
    }
}

/* The elastic predictor and the return to the limit (cohesive/friction.h). */
RG_INLINE void add_coulomb(interface *s, int q, vec3 g[2], const vec3 n, const point_opening *o,
                           rg_mask broken, rg_mask now, vec3 turn[RG_FNODES]) {
    surface_frame f;
    rg_vec state[RG_FRICTION], drag[2];
    tangents(s, n, &f);
    rg_friction_point p = {.slip = {rg_dot(o->tangential, f.along[0]), rg_dot(o->tangential, f.along[1])},
                           .stiffness = s->pen_iso,
                           .limit = friction_limit(s, q, o, broken & ~now),
                           .weight = rg_splat(rg_tri[q / 3].weight)};
    for (int k = 0; k < RG_FRICTION; k++) {
        state[k] = rg_load(friction_state(s, q, k));
    }
    if (is_frictional(s) && rg_any(now)) {
        load_springs(s, q, n, &f, &p, now, state);
    }
    rg_friction_return(&p, state, drag);
    for (int k = 0; k < RG_FRICTION; k++) {
        store_where(friction_state(s, q, k), broken, state[k]);
    }
    for (int c = 0; c < 3; c++) {
        rg_vec t = drag[0] * f.along[0][c] + drag[1] * f.along[1][c];
        s->total[q][c] += rg_select(broken, t, rg_splat(0.0));
    }
    if (s->args->law.contact == RG_CONTACT_POTENTIAL) {
        turn_with_frame(q, g, &f, &p, drag, o, broken, turn);
    }
}

/* Its spring alone, without limit or memory. */
RG_INLINE void add_spring(interface *s, int q, const point_opening *o, rg_mask broken) {
    for (int c = 0; c < 3; c++) {
        s->total[q][c] += rg_select(broken, s->pen_iso * o->tangential[c], rg_splat(0.0));
    }
}

/* Adds friction to the traction of broken points; `now`: those that broke in this state. */
RG_INLINE void add_friction(interface *s, int q, vec3 g[2], const vec3 n, rg_mask broken, rg_mask now,
                            vec3 turn[RG_FNODES]) {
    point_opening o;
    crack_opening(s, q, n, &o);
    switch (s->args->law.sliding) {
    case RG_SLIDING_FREE:
        break;
    case RG_SLIDING_COULOMB:
        add_coulomb(s, q, g, n, &o, broken, now, turn);
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
