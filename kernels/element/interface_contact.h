/* Step 3 at the broken points of a face: contact of closed ones (section 6 of kernels/README.md), on top of
 * the law. c = (beta_s/h_s)(lambda + 2 mu) area, in form intrinsic at least the law's slope. */
#ifndef RG_INTERFACE_CONTACT_H
#define RG_INTERFACE_CONTACT_H

#include <math.h>

#include "element/interface_crack.h"

/* Points that contact acts on: closed ones; of its linear part, all. */
RG_INLINE rg_mask is_touching(const interface *s, const point_opening *o) {
    return o->normal < rg_splat(s->args->law.contact == RG_CONTACT_LINEAR ? INFINITY : 0.0);
}

/* min(0, w_n); of the linear part, w_n. */
RG_INLINE rg_vec touching(const interface *s, const point_opening *o) {
    return rg_select(is_touching(s, o), o->normal, rg_splat(0.0));
}

/* Points whose DG terms return since they are closed: contact `flux`. */
RG_INLINE rg_mask returning(const interface *s, const point_opening *o, rg_mask broken) {
    return (s->args->law.contact == RG_CONTACT_FLUX ? broken : (rg_mask){0}) & (o->normal < 0.0);
}

/* How much of a face still faces the other one: (1 - (|w_t|^2 + (4 w_n)^2)/area)^2, down to 0; here its root.
 * It falls as they slide off each other; and a side that comes back from elsewhere must not count as deep
 * inside. Where faces are pressed w_n is some thousandths of their size. */
#define DEPTHS 16.0
RG_INLINE rg_vec facing_root(const interface *s, const point_opening *o) {
    rg_vec apart = rg_dot(o->tangential, o->tangential) + DEPTHS * (o->normal * o->normal);
    return rg_max(1.0 - apart / rg_max(s->area, rg_splat(RG_NO_AREA)), rg_splat(0.0));
}

/* Pressure of contact on a broken point (N). */
RG_INLINE rg_vec contact_pressure(const interface *s, const point_opening *o) {
    rg_vec depth = rg_max(-o->normal, rg_splat(0.0)), pressure = s->contact * depth;
    if (s->args->law.contact == RG_CONTACT_POTENTIAL) { /* -dE/dw_n */
        rg_vec root = facing_root(s, o);
        rg_vec fading = rg_splat(2.0 * DEPTHS) * depth * depth / rg_max(s->area, rg_splat(RG_NO_AREA));
        pressure *= root * rg_max(root - fading, rg_splat(0.0));
    }
    return pressure;
}

/* Contact as a potential: E = c/2 w_n^2 root^2. */
RG_INLINE void add_potential(const interface *s, const point_opening *o, rg_vec pressed, rg_law_response *r) {
    rg_vec root = facing_root(s, o), force = s->contact * pressed * root;
    rg_vec away = 2.0 * force * pressed / rg_max(s->area, rg_splat(RG_NO_AREA));
    r->normal += force * root - DEPTHS * away * pressed;
    r->shear = r->shear * r->weight - away;
    r->weight = rg_splat(1.0);
}

/* Nodal forces of `times` v . dn, v tangential, of which either side bears one half:
 *     v . dn = (dg1 . (g2 x v) + dg2 . (v x g1))/|g1 x g2|. */
RG_INLINE void add_turn_along(int q, vec3 g[2], const vec3 v, rg_vec times, rg_mask acting,
                              vec3 turn[RG_FNODES]) {
    rg_real xi[RG_FNODES], eta[RG_FNODES];
    face_derivatives(q, xi, eta);
    vec3 across, one, two;
    rg_cross(g[0], g[1], across);
    rg_cross(g[1], v, one);
    rg_cross(v, g[0], two);
    rg_vec twice = rg_sqrt(rg_dot(across, across));
    rg_vec factor = rg_splat(-0.5 * rg_tri[q / 3].weight) * times / rg_max(twice, rg_splat(RG_NO_AREA));
    factor = rg_select(acting, factor, rg_splat(0.0));
    for (int a = 0; a < RG_FNODES; a++) {
        for (int c = 0; c < 3; c++) {
            turn[a][c] += factor * (xi[a] * one[c] + eta[a] * two[c]);
        }
    }
}

/* A potential of w_n = w . n and w_t = w - w_n n also depends on n, by (t_n - T w_n) w_t . dn, where the
 * traction is t_n n + T w_t. */
RG_INLINE void add_turn(int q, vec3 g[2], const point_opening *o, const rg_law_response *r, rg_mask acting,
                        vec3 turn[RG_FNODES]) {
    vec3 w;
    for (int c = 0; c < 3; c++) {
        w[c] = o->tangential[c];
    }
    add_turn_along(q, g, w, r->normal - r->shear * o->normal, acting, turn);
}

/* Adds contact to the traction of the points that act by their law. */
RG_INLINE void add_contact(const interface *s, int q, vec3 g[2], const point_opening *o, rg_mask acting,
                           rg_law_response *r, vec3 turn[RG_FNODES]) {
    switch (s->args->law.contact) {
    case RG_CONTACT_PENALTY:
    case RG_CONTACT_LINEAR:
        r->normal += s->contact * touching(s, o);
        break;
    case RG_CONTACT_FLUX: /* has no part in those that act */
        break;
    case RG_CONTACT_POTENTIAL:
        add_potential(s, o, touching(s, o), r);
        add_turn(q, g, o, r, acting, turn);
        break;
    }
}

/* What contact stores at broken points. */
RG_INLINE rg_vec contact_energy(const interface *s, const point_opening *o, rg_mask broken) {
    rg_vec energy = 0.5 * s->contact * o->normal * o->normal;
    if (s->args->law.contact == RG_CONTACT_POTENTIAL) {
        rg_vec root = facing_root(s, o);
        energy *= root * root;
    }
    rg_mask touches = s->args->law.contact == RG_CONTACT_FLUX ? (rg_mask){0} : broken & is_touching(s, o);
    return rg_select(touches, energy, rg_splat(0.0));
}

RG_INLINE void load_turn(const interface *s, vec3 turn[RG_FNODES]) {
    const rg_real *from = s->args->turn + s->block * RG_IFORCE_BLOCK + s->lane;
    for (int a = 0; a < RG_FNODES; a++) {
        for (int c = 0; c < 3; c++) {
            turn[a][c] = rg_load(from + (a * 3 + c) * RG_LANES);
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

#endif
