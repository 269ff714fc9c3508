/* Contact of two faces as one potential (section 10 of kernels/README.md), after Sahu & Petrinic, arXiv
 * 2506.04841, with all of its gradient. Each face is the triangle of its corners, normals nA and nB point
 * out:
 *
 *     n = (nA - nB)/|nA - nB|                   the mid-plane
 *     d(p) = n.(xA - xB)(p) - skin              depth at a point p of it beyond the skin, linear
 *     P = proj A and proj B, where 0 < d < d_m  convex, at most 8 corners; d_m = limit - skin
 *     E = (kappa/2) W(-nA.nB) int_P phi(d) dA,  phi = d^2 (1 - d^2/d_m^2)^2
 *
 * W rises from 0 where the faces are at right angles to 1. phi and phi' vanish on the sides of P at d = 0,
 * and phi on those at d_m, so of a moving boundary only the edges of A and B have a part in the gradient.
 *
 * A lane is a pair. B is seen from behind, so that the corners of both run counter-clockwise on the mid-plane
 * and both normals, nA and -nB, point up. */
#ifndef RG_CONTACT_PAIR_H
#define RG_CONTACT_PAIR_H

#include "contact/overlap.h"
#include "kernels.h"

/* Corner i of A and of B, as they run on the mid-plane. */
static const int corner_of[2][3] = {{0, 1, 2}, {0, 2, 1}};

/* From this facing on the weight is 1: faces at 70 degrees to each other. */
#define FULL_FACING 0.35

/* A vector of pairs. */
typedef struct {
    wide corner[2][3][3];
    wide stiffness, skin, reach; /* skin: with what they have sunk; reach: d_m */
    wide fading, parting, common[2][3];
    wide shear, friction[2], impedance;
    wide across[2][3]; /* (x1 - x0) x (x2 - x0) */
    wide length[2];
    wide normal[2][3]; /* nA, -nB */
    wide facing;       /* -nA.nB */
    wide frame[3][3];  /* e1, e2, n */
    wide twice;        /* |nA - nB| */
    wide x[2][3][3];   /* corners in the frame, from the first one of A */
    linear height[2];  /* of their planes over the mid-plane */
    overlap over;
    wide gradient[2][3][3]; /* of the integral of phi by the corners, for a mid-plane that does not turn */
} meeting;

RG_INLINE void load_pair(meeting *m, const rg_contact_args *args, size_t i, int lane) {
    const rg_contact_pair *p = &args->pair[i];
    double sunk = 0;
    for (int k = 0; k < 2; k++) {
        const double *x = args->corner + 9 * (size_t)p->face[k];
        for (int j = 0; j < 9; j++) {
            m->corner[k][j / 3][j % 3][lane] = x[3 * corner_of[k][j / 3] + j % 3];
        }
        for (int j = 0; j < 3; j++) {
            m->common[k][j][lane] = p->common[k][corner_of[k][j]];
        }
        sunk = args->sunk[p->face[k]] > sunk ? args->sunk[p->face[k]] : sunk;
        m->friction[k][lane] = p->friction[k];
    }
    m->shear[lane] = p->shear;
    m->impedance[lane] = p->impedance;
    m->stiffness[lane] = p->stiffness;
    m->skin[lane] = p->skin + sunk;
    m->reach[lane] = p->limit - (p->skin + sunk);
    m->fading[lane] = p->fading;
    m->parting[lane] = p->parting;
}

/* ---- The mid-plane ---- */

RG_INLINE void set_normal(meeting *m, int k) {
    wide one[3], two[3];
    wide_minus(m->corner[k][1], m->corner[k][0], one);
    wide_minus(m->corner[k][2], m->corner[k][0], two);
    wide_cross(one, two, m->across[k]);
    m->length[k] = wide_sqrt(wide_dot(m->across[k], m->across[k]));
    for (int c = 0; c < 3; c++) {
        m->normal[k][c] = m->across[k][c] / m->length[k];
    }
}

RG_INLINE void set_frame(meeting *m) {
    wide *n = m->frame[2], axis[3], least = {0};
    for (int c = 0; c < 3; c++) {
        n[c] = m->normal[0][c] + m->normal[1][c];
    }
    m->twice = wide_sqrt(wide_dot(n, n));
    for (int c = 0; c < 3; c++) { /* the axis that n is farthest from */
        n[c] /= m->twice;
        wide size = wide_abs(n[c]);
        wide_mask less = c == 0 ? (wide_mask)(size == size) : (wide_mask)(size < least);
        for (int b = 0; b < c; b++) {
            axis[b] = wide_select(less, wide_splat(0), axis[b]);
        }
        axis[c] = wide_select(less, wide_splat(1), wide_splat(0));
        least = wide_select(less, size, least);
    }
    wide_cross(n, axis, m->frame[0]);
    wide length = wide_sqrt(wide_dot(m->frame[0], m->frame[0]));
    for (int c = 0; c < 3; c++) {
        m->frame[0][c] /= length;
    }
    wide_cross(n, m->frame[0], m->frame[1]);
}

RG_INLINE void set_face(meeting *m, int k) {
    wide normal[3];
    triangle *t = &m->over.face[k];
    for (int i = 0; i < 3; i++) {
        wide r[3];
        wide_minus(m->corner[k][i], m->corner[0][0], r);
        for (int c = 0; c < 3; c++) {
            m->x[k][i][c] = wide_dot(r, m->frame[c]);
        }
        normal[i] = wide_dot(m->normal[k], m->frame[i]);
    }
    linear *z = &m->height[k];
    z->x = -normal[0] / normal[2];
    z->y = -normal[1] / normal[2];
    z->c = m->x[k][0][2] - z->x * m->x[k][0][0] - z->y * m->x[k][0][1];
    for (int i = 0; i < 3; i++) {
        t->x[i][0] = m->x[k][i][0];
        t->x[i][1] = m->x[k][i][1];
    }
    set_triangle(t);
}

RG_INLINE void set_depth(meeting *m) {
    const linear *a = &m->height[0], *b = &m->height[1];
    m->over.depth = (linear){a->c - b->c - m->skin, a->x - b->x, a->y - b->y};
    m->over.reach = m->reach;
}

/* ---- Shares ---- */

RG_INLINE wide weight_of(wide facing, wide *slope) {
    wide t = facing / FULL_FACING;
    wide_mask rises = (wide_mask)(t < 1);
    *slope = wide_select(rises, 6 * t * (1 - t) / FULL_FACING, wide_splat(0));
    return wide_select(rises, t * t * (3 - 2 * t), wide_splat(1));
}

/* The share of a pair whose faces had corners in common, w the distance of the means of these; its gradient
 * over that of the pair's energy goes to w and to n. */
typedef struct {
    wide share, by_apart[3], by_normal[2];
} handover;

/* Of a former face what the interface's own contact has not: 1 - r^2, r = 1 - (|w|^2 + 15 w_n^2)/area, down
 * to 0 (element/interface_contact.h). */
RG_INLINE void take_over(wide area, const wide w[3], handover *h) {
    wide r = 1 - (wide_dot(w, w) + 15 * w[2] * w[2]) / area, by = 2 * r / area;
    wide_mask fades = (wide_mask)(area > 0) & (wide_mask)(r > 0);
    h->share = wide_select(fades, 1 - r * r, h->share);
    for (int c = 0; c < 3; c++) {
        h->by_apart[c] =
            wide_select(fades, by * (2 * w[c] + (c == 2 ? 30 * w[2] : wide_splat(0))), h->by_apart[c]);
    }
    for (int c = 0; c < 2; c++) {
        h->by_normal[c] = wide_select(fades, by * 30 * w[2] * w[c], h->by_normal[c]);
    }
}

/* Of faces with their solid between them: rises from 0 where |w|^2 is one area to 1 where it is two. */
RG_INLINE void part(wide area, const wide w[3], handover *h) {
    wide t = wide_dot(w, w) / area - 1, rise = wide_select((wide_mask)(t > 0), t, wide_splat(0));
    wide_mask parts = (wide_mask)(area > 0) & (wide_mask)(t < 1);
    h->share = wide_select(parts, rise * rise * (3 - 2 * rise), h->share);
    for (int c = 0; c < 3; c++) {
        h->by_apart[c] = wide_select(parts, 6 * rise * (1 - rise) * 2 * w[c] / area, h->by_apart[c]);
    }
}

RG_INLINE handover hand_over(const meeting *m) {
    handover h = {.share = wide_splat(1)};
    wide w[3];
    for (int c = 0; c < 3; c++) {
        w[c] = wide_splat(0);
        for (int i = 0; i < 3; i++) {
            w[c] += m->common[1][i] * m->x[1][i][c] - m->common[0][i] * m->x[0][i][c];
        }
    }
    take_over(m->fading, w, &h);
    part(m->parting, w, &h);
    return h;
}

/* ---- Forces ---- */

/* Depth follows the heights of the corners, of A with sign 1, of B with -1; and where the corners move along
 * the mid-plane they take the height with them. */
RG_INLINE void set_gradient(meeting *m, const integral *sum, int k) {
    for (int i = 0; i < 3; i++) {
        const linear *l = &m->over.face[k].l[i];
        wide moment = l->c * sum->slope[0] + l->x * sum->slope[1] + l->y * sum->slope[2];
        moment = k == 0 ? moment : -moment;
        m->gradient[k][i][0] = sum->edge[k][i][0] - moment * m->height[k].x;
        m->gradient[k][i][1] = sum->edge[k][i][1] - moment * m->height[k].y;
        m->gradient[k][i][2] = moment;
    }
}

/* The gradient by n for corners that do not move: n x T, T the moment of the gradient of the corners, in the
 * frame. */
RG_INLINE void add_moment(const meeting *m, int k, wide by_normal[2]) {
    for (int i = 0; i < 3; i++) {
        const wide *x = m->x[k][i], *g = m->gradient[k][i];
        by_normal[0] -= x[2] * g[0] - x[0] * g[2];
        by_normal[1] += x[1] * g[2] - x[2] * g[1];
    }
}

/* Adds -dE/d(corners) of what depends on the direction of face k alone: `by` = dE/d(normal). */
RG_INLINE void turn_face(const meeting *m, int k, const wide by[3], wide force[3][3]) {
    wide g[3], one[3], two[3], on1[3], on2[3], along = wide_dot(by, m->normal[k]);
    for (int c = 0; c < 3; c++) {
        g[c] = (by[c] - along * m->normal[k][c]) / m->length[k];
    }
    wide_minus(m->corner[k][1], m->corner[k][0], one);
    wide_minus(m->corner[k][2], m->corner[k][0], two);
    wide_cross(two, g, on1);
    wide_cross(g, one, on2);
    for (int c = 0; c < 3; c++) {
        force[0][c] += on1[c] + on2[c];
        force[1][c] -= on1[c];
        force[2][c] -= on2[c];
    }
}

/* Forces on the corners, from the integrals over P; returns the energy. */
RG_INLINE wide pair_forces(meeting *m, const integral *sum, const handover *h, wide force[2][3][3]) {
    wide slope, weight = weight_of(m->facing, &slope), by_normal[2] = {wide_splat(0), wide_splat(0)};
    wide passed = 0.5 * m->stiffness * weight * sum->value; /* on to the share */
    wide scale = 0.5 * m->stiffness * weight * h->share;
    for (int k = 0; k < 2; k++) {
        set_gradient(m, sum, k);
        add_moment(m, k, by_normal);
        for (int i = 0; i < 3; i++) {
            wide g[3], apart = k == 0 ? -m->common[k][i] * passed : m->common[k][i] * passed;
            for (int c = 0; c < 3; c++) {
                g[c] = scale * m->gradient[k][i][c] + apart * h->by_apart[c];
            }
            for (int c = 0; c < 3; c++) {
                force[k][i][c] = -(g[0] * m->frame[0][c] + g[1] * m->frame[1][c] + g[2] * m->frame[2][c]);
            }
        }
    }
    wide e1 = scale * by_normal[0] + passed * h->by_normal[0],
         e2 = scale * by_normal[1] + passed * h->by_normal[1],
         facing = 0.5 * m->stiffness * slope * h->share * sum->value;
    for (int k = 0; k < 2; k++) {
        wide by[3];
        for (int c = 0; c < 3; c++) {
            by[c] = (e1 * m->frame[0][c] + e2 * m->frame[1][c]) / m->twice + facing * m->normal[1 - k][c];
        }
        turn_face(m, k, by, force[k]);
    }
    return scale * sum->value;
}

#endif
