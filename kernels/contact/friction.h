/* Coulomb friction of a pair of faces that press: a spring that holds a point of A to a point of B, and a
 * return to the cone |f| <= mu N. With N = dE/dd of the pair's potential, its point of attack c, and the
 * frame of the mid-plane:
 *
 *     e = (1 - n n') (xA(a) - xB(b))        a, b: the spring's ends, by barycentric coordinates
 *     U = k |e|^2/2,  k = shear W area(P)   with all of its gradient as forces, so that both momenta stay
 *     stick  k |e| <= mu_s N                (mu_k if it slid before)
 *     slide  e = (mu_k N/k) e/|e|           else: the ends are set anew, a where c is on A, b so that e is so
 *
 * A pair begins with its ends upon each other at c. As P grows what joins it comes unstretched, as it shrinks
 * what leaves it takes its stretch along: e falls with k0/k in the one case, the force with k/k0 in the
 * other. A pair that parts loses its spring. Heat is what is missing then: the work of the force, by the
 * trapezoid of a step, less what the spring has gained,
 *
 *     (k0 e0 + k e)/2 . (s - e0) - (U - U0),  s: e before the return.
 *
 * The stretch is remembered in a frame that turns with A: along its first edge, seen along n, and across. */
#ifndef RG_CONTACT_FRICTION_H
#define RG_CONTACT_FRICTION_H

#include "contact/pair.h"

/* What there is of a pair's friction. */
typedef struct {
    wide anchor[2][3]; /* barycentric coordinates on A, B */
    wide stretch[2];   /* in the frame of A's first edge */
    wide stiffness, slides;
} grip;

RG_INLINE void load_grip(const rg_contact_args *args, size_t i, int lane, grip *g) {
    const double *from = args->grip + RG_GRIP * i;
    for (int k = 0; k < 2; k++) {
        const double *l = from + RG_GRIP_ANCHOR + 2 * k;
        g->anchor[k][0][lane] = l[0];
        g->anchor[k][1][lane] = l[1];
        g->anchor[k][2][lane] = 1 - l[0] - l[1];
        g->stretch[k][lane] = from[RG_GRIP_STRETCH + k];
    }
    g->stiffness[lane] = from[RG_GRIP_STIFFNESS];
    g->slides[lane] = from[RG_GRIP_SLIDES];
}

RG_INLINE void store_grip(const rg_contact_args *args, size_t i, int lane, const grip *g) {
    double *to = args->grip + RG_GRIP * i;
    for (int k = 0; k < 2; k++) {
        to[RG_GRIP_ANCHOR + 2 * k] = g->anchor[k][0][lane];
        to[RG_GRIP_ANCHOR + 2 * k + 1] = g->anchor[k][1][lane];
        to[RG_GRIP_STRETCH + k] = g->stretch[k][lane];
    }
    to[RG_GRIP_STIFFNESS] = g->stiffness[lane];
    to[RG_GRIP_SLIDES] = g->slides[lane];
}

/* From one end of the spring to the other, in the frame of the mid-plane. */
RG_INLINE void reach_across(const meeting *m, const grip *g, wide r[3]) {
    for (int c = 0; c < 3; c++) {
        r[c] = wide_splat(0);
        for (int i = 0; i < 3; i++) {
            r[c] += g->anchor[0][i] * m->x[0][i][c] - g->anchor[1][i] * m->x[1][i][c];
        }
    }
}

/* Unit vector along A's first edge, of the frame of the mid-plane. */
RG_INLINE void along_edge(const meeting *m, wide t[2]) {
    t[0] = m->x[0][1][0] - m->x[0][0][0];
    t[1] = m->x[0][1][1] - m->x[0][0][1];
    wide length = wide_sqrt(t[0] * t[0] + t[1] * t[1]);
    t[0] /= length;
    t[1] /= length;
}

/* Where the pressure attacks, in the mid-plane. Deep parts pull, so that it may be beside the faces: then, by
 * so much of their size, it is nowhere. */
#define BESIDE 0.1
RG_INLINE wide_mask attack_at(const meeting *m, const integral *sum, wide c[2]) {
    wide_mask over = (wide_mask)(sum->slope[0] > 0);
    c[0] = sum->slope[1] / sum->slope[0];
    c[1] = sum->slope[2] / sum->slope[0];
    for (int i = 0; i < 6; i++) {
        over &= (wide_mask)(at(&m->over.face[i / 3].l[i % 3], c) > -BESIDE);
    }
    return over;
}

/* Ends of the spring with one at point c on A, and the other so that the stretch is e. */
RG_INLINE void set_anchors(const meeting *m, const wide c[2], const wide e[2], wide_mask where, grip *g) {
    wide at_b[2] = {c[0] - e[0], c[1] - e[1]};
    for (int i = 0; i < 3; i++) {
        g->anchor[0][i] = wide_select(where, at(&m->over.face[0].l[i], c), g->anchor[0][i]);
        g->anchor[1][i] = wide_select(where, at(&m->over.face[1].l[i], at_b), g->anchor[1][i]);
    }
}

/* Advances a grip; returns the force of the spring in the frame of the mid-plane, on B, and what became heat.
 * `normal`: N; `stiffness`: k, 0 of pairs that do not press. */
RG_INLINE wide hold(const meeting *m, const wide attack[2], wide normal, wide stiffness, grip *g,
                    wide force[2]) {
    const wide zero = wide_splat(0), one = wide_splat(1);
    wide_mask holds = (wide_mask)(stiffness > 0), fresh = (wide_mask)(g->stiffness == 0);
    wide k0 = g->stiffness, k = wide_select(holds, stiffness, one), t[2], r[3], s[2], e[2], trial[2];
    wide kept = wide_select((wide_mask)(k0 < k), k0 / k, one);
    along_edge(m, t);
    reach_across(m, g, r);
    s[0] = wide_select(fresh, zero, r[0] * t[0] + r[1] * t[1]);
    s[1] = wide_select(fresh, zero, r[1] * t[0] - r[0] * t[1]);
    wide before = zero, after = zero, gone = zero, size = zero;
    for (int c = 0; c < 2; c++) {
        g->stretch[c] = wide_select(fresh, zero, g->stretch[c]);
        trial[c] = s[c] - (1 - kept) * g->stretch[c];
        before += 0.5 * k0 * g->stretch[c] * g->stretch[c];
        size += trial[c] * trial[c];
    }
    size = k * wide_sqrt(size);
    wide coefficient = wide_select((wide_mask)(g->slides > 0), m->friction[1], m->friction[0]);
    wide_mask slides = holds & (wide_mask)(size > coefficient * normal);
    wide scale = wide_select(slides, m->friction[1] * normal / size, one);
    for (int c = 0; c < 2; c++) {
        e[c] = wide_where(holds, scale * trial[c]);
        after += 0.5 * k * e[c] * e[c];
        gone += 0.5 * (k0 * g->stretch[c] + k * e[c]) * (s[c] - g->stretch[c]);
        g->stretch[c] = e[c];
    }
    g->slides = wide_where(slides, one);
    g->stiffness = wide_where(holds, stiffness);
    wide in_plane[2] = {e[0] * t[0] - e[1] * t[1], e[0] * t[1] + e[1] * t[0]};
    set_anchors(m, attack, in_plane, holds & (slides | fresh | (wide_mask)(kept < 1)), g);
    force[0] = k * in_plane[0];
    force[1] = k * in_plane[1];
    return wide_select(holds, gone - (after - before), before);
}

/* Adds the spring's forces to those of the corners; returns its energy. */
RG_INLINE wide pull(const meeting *m, const grip *g, const wide f[2], wide force[2][3][3]) {
    wide r[3], along[3];
    reach_across(m, g, r);
    for (int c = 0; c < 3; c++) {
        along[c] = f[0] * m->frame[0][c] + f[1] * m->frame[1][c];
    }
    for (int k = 0; k < 2; k++) {
        wide by[3];
        for (int i = 0; i < 3; i++) {
            for (int c = 0; c < 3; c++) {
                wide part = g->anchor[k][i] * along[c];
                force[k][i][c] += k == 0 ? -part : part;
            }
        }
        for (int c = 0; c < 3; c++) { /* e turns with n, by which its rise r.n counts */
            by[c] = -r[2] * along[c] / m->twice;
        }
        turn_face(m, k, by, force[k]);
    }
    return 0.5 * g->stiffness * (g->stretch[0] * g->stretch[0] + g->stretch[1] * g->stretch[1]);
}

/* Adds friction to the forces of a vector of pairs, those that press. */
RG_INLINE wide add_friction(const rg_contact_args *args, const size_t pair[], int count, const meeting *m,
                            const integral *sum, const handover *h, wide_mask presses, wide force[2][3][3]) {
    grip g;
    wide slope, f[2], c[2], weight = weight_of(m->facing, &slope) * h->share;
    wide normal = 0.5 * m->stiffness * weight * sum->slope[0], stiffness = m->shear * weight * sum->area;
    stiffness = wide_where(attack_at(m, sum, c) & presses & (wide_mask)(stiffness > 0), stiffness);
    for (int l = 0; l < WIDE; l++) {
        load_grip(args, pair[l < count ? l : count - 1], l, &g);
    }
    wide heat = hold(m, c, normal, stiffness, &g, f);
    for (int l = 0; l < count; l++) {
        store_grip(args, pair[l], l, &g);
        args->heat[pair[l]] = heat[l];
    }
    return pull(m, &g, f, force);
}

#endif
