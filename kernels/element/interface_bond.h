/* Shear of points that break by opening alone (beta = 0), on top of law and contact: `interface.shear:
 * fading`.
 *
 * The law of such a point knows its opening w_n alone, so the shear traction of the switch would drop from
 * one step to the next. Instead a spring goes on with it, of the stiffness k that the penalty has across, and
 * fades as the law does: drag  t = (1 - D) k e,  e = w_t - a,  k e_0 = tau at the switch with slip and anchor
 * in the frame of friction and the damage D of the point, so that what it holds at the switch is what was
 * there, and at D = 1 nothing. It is a potential that damage takes: stored      (1 - D) k (|e|^2 - |e_0|^2)/2
 *     dissipated  k (|e|^2 - |e_0|^2)/2 dD
 * counted from the switch, since stretching it then took no work; a step from (D, e) to (D', e') dissipates
 * k (D' - D) (e . e' - |e_0|^2)/2, the work of the trapezoid less what is stored. */
#ifndef RG_INTERFACE_BOND_H
#define RG_INTERFACE_BOND_H

#include "element/interface_friction.h"

/* That friction does not hold (N). */
RG_INLINE void shear_to_hold(const interface *s, int q, const vec3 n, vec3 shear) {
    rg_vec along = rg_dot(s->mean[q], n);
    vec3 held = {{0}};
    if (is_frictional(s)) {
        held_by_friction(s, q, n, held);
    }
    for (int c = 0; c < 3; c++) {
        shear[c] = s->mean[q][c] - along * n[c] - held[c];
    }
}

/* Springs of points that break now. */
RG_INLINE void tie(const interface *s, int q, const vec3 n, const surface_frame *f, const rg_vec slip[2],
                   rg_vec damage, rg_mask now, rg_vec bond[RG_BOND]) {
    vec3 shear;
    shear_to_hold(s, q, n, shear);
    rg_vec stretch[2], square = {0};
    for (int k = 0; k < 2; k++) {
        stretch[k] = rg_dot(shear, f->along[k]) / s->pen_iso;
        square += stretch[k] * stretch[k];
        bond[RG_BOND_STRETCH + k] = rg_select(now, stretch[k], bond[RG_BOND_STRETCH + k]);
        bond[RG_BOND_ANCHOR + k] = rg_select(now, slip[k] - stretch[k], bond[RG_BOND_ANCHOR + k]);
    }
    bond[RG_BOND_START] = rg_select(now, square, bond[RG_BOND_START]);
    bond[RG_BOND_DAMAGE] = rg_select(now, damage, bond[RG_BOND_DAMAGE]);
    bond[RG_BOND_HEAT] = rg_select(now, rg_splat(0.0), bond[RG_BOND_HEAT]);
}

/* Adds the drag of the springs. */
RG_INLINE void add_bond(interface *s, int q, vec3 g[2], const vec3 n, rg_mask broken, rg_mask now,
                        vec3 turn[RG_FNODES]) {
    rg_mask acting = broken & fading(s);
    if (!rg_any(acting)) {
        return;
    }
    point_opening o;
    surface_frame f;
    crack_opening(s, q, n, &o);
    tangents(s, n, &f);
    rg_vec bond[RG_BOND], drag[2], product = {0}, damage = point_damage(s, q);
    rg_friction_point p = {.slip = {rg_dot(o.tangential, f.along[0]), rg_dot(o.tangential, f.along[1])},
                           .stiffness = s->pen_iso,
                           .weight = rg_splat(rg_tri[q / 3].weight)};
    for (int k = 0; k < RG_BOND; k++) {
        bond[k] = rg_load(bond_state(s, q, k));
    }
    tie(s, q, n, &f, p.slip, damage, now, bond);
    for (int k = 0; k < 2; k++) {
        rg_vec stretch = p.slip[k] - bond[RG_BOND_ANCHOR + k];
        product += bond[RG_BOND_STRETCH + k] * stretch;
        bond[RG_BOND_STRETCH + k] = stretch;
        drag[k] = (1.0 - damage) * s->pen_iso * stretch;
    }
    bond[RG_BOND_HEAT] +=
        0.5 * s->pen_iso * (damage - bond[RG_BOND_DAMAGE]) * (product - bond[RG_BOND_START]);
    bond[RG_BOND_DAMAGE] = damage;
    for (int k = 0; k < RG_BOND_GIVEN; k++) {
        store_where(bond_state(s, q, k), acting, bond[k]);
    }
    for (int c = 0; c < 3; c++) {
        rg_vec t = drag[0] * f.along[0][c] + drag[1] * f.along[1][c];
        s->total[q][c] += rg_select(acting, t, rg_splat(0.0));
    }
    if (s->args->law.contact == RG_CONTACT_POTENTIAL) {
        turn_with_frame(q, g, &f, &p, drag, &o, acting, turn);
    }
}

/* What the springs of broken points store, have taken, and what came free with the shear (J, of the face). */
RG_INLINE void bond_energy(const interface *s, int q, rg_mask broken, rg_vec sum[RG_E_INTERFACE]) {
    rg_mask acting = broken & fading(s);
    rg_vec zero = {0}, weight = rg_splat(rg_tri[q / 3].weight), square = {0};
    for (int k = 0; k < 2; k++) {
        rg_vec stretch = rg_load(bond_state(s, q, RG_BOND_STRETCH + k));
        square += stretch * stretch;
    }
    rg_vec left = 1.0 - rg_load(bond_state(s, q, RG_BOND_DAMAGE));
    rg_vec stored = 0.5 * left * s->pen_iso * (square - rg_load(bond_state(s, q, RG_BOND_START)));
    sum[RG_E_COHESIVE] += weight * rg_select(acting, stored, zero);
    sum[RG_E_DISSIPATED] += weight * rg_select(acting, rg_load(bond_state(s, q, RG_BOND_HEAT)), zero);
    sum[RG_E_UNRESOLVED] += weight * rg_select(acting, rg_load(bond_state(s, q, RG_BOND_GIVEN)), zero);
}

#endif
