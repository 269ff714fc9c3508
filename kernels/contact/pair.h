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
 * and phi on those at d_m, so of a moving boundary only the edges of A and B have a part in the gradient. */
#ifndef RG_CONTACT_PAIR_H
#define RG_CONTACT_PAIR_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "kernels.h"
#include "vec.h"

/* Rules exact for polynomials of degree 6 in a triangle, and 7 on an edge. */
enum { INSIDE_POINTS = 12, EDGE_POINTS = 4 };
static const double inside_rule[INSIDE_POINTS][3] = {
    {0.063089014491502228, 0.063089014491502228, 0.050844906370206817},
    {0.063089014491502228, 0.873821971016995544, 0.050844906370206817},
    {0.873821971016995544, 0.063089014491502228, 0.050844906370206817},
    {0.249286745170910421, 0.249286745170910421, 0.116786275726379366},
    {0.249286745170910421, 0.501426509658179158, 0.116786275726379366},
    {0.501426509658179158, 0.249286745170910421, 0.116786275726379366},
    {0.310352451033784405, 0.053145049844816947, 0.082851075618373575},
    {0.053145049844816947, 0.310352451033784405, 0.082851075618373575},
    {0.310352451033784405, 0.636502499121398648, 0.082851075618373575},
    {0.636502499121398648, 0.310352451033784405, 0.082851075618373575},
    {0.053145049844816947, 0.636502499121398648, 0.082851075618373575},
    {0.636502499121398648, 0.053145049844816947, 0.082851075618373575}};
static const double edge_rule[EDGE_POINTS][2] = {{0.069431844202973712, 0.173927422568726929},
                                                 {0.330009478207571868, 0.326072577431273071},
                                                 {0.669990521792428132, 0.326072577431273071},
                                                 {0.930568155797026288, 0.173927422568726929}};

/* c + x p_x + y p_y over the mid-plane. */
typedef struct {
    double c, x, y;
} linear;

/* Sides of P: edges k -> k + 1 of A (0 to 2), of B (3 to 5), of the depth. */
enum { SIDE_OF_B = 3, SIDE_OF_DEPTH = 6, MOST_CORNERS = 8, MOST = MOST_CORNERS + 1 };

typedef struct {
    int count;
    double p[MOST][2];
    int side[MOST]; /* of the edge from corner i to the next */
} polygon;

/* A face in the frame of the mid-plane: e1, e2, n, from the first corner of A. */
typedef struct {
    double x[3][3];        /* corners */
    double normal[3];      /* unit, out of the element */
    linear height;         /* of its plane over the mid-plane */
    linear l[3];           /* barycentric coordinates */
    double gradient[3][3]; /* of the integral of phi by its corners, for a mid-plane that does not turn */
} seen_face;

typedef struct {
    double across[2][3]; /* (x1 - x0) x (x2 - x0) of A, B */
    double length[2];
    double normal[2][3];
    double facing;      /* -nA.nB */
    double frame[3][3]; /* e1, e2, n */
    double twice;       /* |nA - nB| */
    seen_face face[2];
    linear depth;
} meeting;

RG_INLINE double dot3(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

RG_INLINE void cross3(const double a[3], const double b[3], double out[3]) {
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = a[j] * b[k] - a[k] * b[j];
    }
}

RG_INLINE void minus3(const double a[3], const double b[3], double out[3]) {
    for (int c = 0; c < 3; c++) {
        out[c] = a[c] - b[c];
    }
}

RG_INLINE double at(const linear *f, const double p[2]) {
    return f->c + f->x * p[0] + f->y * p[1];
}

/* From this facing on the weight is 1: faces at 70 degrees to each other. */
#define FULL_FACING 0.35

RG_INLINE double weight_of(double facing, double *slope) {
    double t = facing / FULL_FACING;
    *slope = t < 1 ? 6 * t * (1 - t) / FULL_FACING : 0;
    return t < 1 ? t * t * (3 - 2 * t) : 1;
}

/* phi and phi'. */
RG_INLINE double potential_of(double d, double reach, double *slope) {
    double r = d / reach, fall = 1 - r * r;
    *slope = 2 * d * fall * (1 - 3 * r * r);
    return d * d * fall * fall;
}

/* ---- The mid-plane ---- */

RG_INLINE void set_normal(meeting *m, int k, const double *x) {
    double one[3], two[3];
    minus3(x + 3, x, one);
    minus3(x + 6, x, two);
    cross3(one, two, m->across[k]);
    m->length[k] = sqrt(dot3(m->across[k], m->across[k]));
    for (int c = 0; c < 3; c++) {
        m->normal[k][c] = m->across[k][c] / m->length[k];
    }
}

RG_INLINE void set_frame(meeting *m) {
    double *n = m->frame[2], axis[3] = {0, 0, 0};
    minus3(m->normal[0], m->normal[1], n);
    m->twice = sqrt(dot3(n, n));
    int least = 0;
    for (int c = 0; c < 3; c++) {
        n[c] /= m->twice;
        least = fabs(n[c]) < fabs(n[least]) ? c : least;
    }
    axis[least] = 1;
    cross3(n, axis, m->frame[0]);
    double length = sqrt(dot3(m->frame[0], m->frame[0]));
    for (int c = 0; c < 3; c++) {
        m->frame[0][c] /= length;
    }
    cross3(n, m->frame[0], m->frame[1]);
}

RG_INLINE void set_face(const meeting *m, int k, const double *x, const double *origin, seen_face *f) {
    for (int i = 0; i < 3; i++) {
        double r[3];
        minus3(x + 3 * i, origin, r);
        for (int c = 0; c < 3; c++) {
            f->x[i][c] = dot3(r, m->frame[c]);
        }
        f->normal[i] = dot3(m->normal[k], m->frame[i]);
    }
    f->height.x = -f->normal[0] / f->normal[2];
    f->height.y = -f->normal[1] / f->normal[2];
    f->height.c = f->x[0][2] - f->height.x * f->x[0][0] - f->height.y * f->x[0][1];
    double area = (f->x[1][0] - f->x[0][0]) * (f->x[2][1] - f->x[0][1]) -
                  (f->x[2][0] - f->x[0][0]) * (f->x[1][1] - f->x[0][1]);
    for (int i = 0; i < 3; i++) { /* 1 at corner i, 0 on the edge opposite */
        const double *a = f->x[(i + 1) % 3], *b = f->x[(i + 2) % 3];
        f->l[i].x = -(b[1] - a[1]) / area;
        f->l[i].y = (b[0] - a[0]) / area;
        f->l[i].c = -f->l[i].x * a[0] - f->l[i].y * a[1];
    }
}

/* ---- The polygon ---- */

/* Keeps what is on the side f >= 0 of a line, which becomes side `side`. */
RG_INLINE void clip(polygon *p, const linear *f, int side) {
    double value[MOST];
    bool all = true;
    for (int i = 0; i < p->count; i++) {
        value[i] = at(f, p->p[i]);
        all = all && value[i] >= 0;
    }
    if (all) {
        return;
    }
    polygon out = {.count = 0};
    for (int i = 0; i < p->count; i++) {
        int next = i + 1 < p->count ? i + 1 : 0;
        bool in = value[i] >= 0, stays = value[next] >= 0;
        if (in) {
            out.p[out.count][0] = p->p[i][0];
            out.p[out.count][1] = p->p[i][1];
            out.side[out.count++] = p->side[i];
        }
        if (in != stays && out.count < MOST) {
            double t = value[i] / (value[i] - value[next]);
            for (int c = 0; c < 2; c++) {
                out.p[out.count][c] = p->p[i][c] + t * (p->p[next][c] - p->p[i][c]);
            }
            out.side[out.count++] = in ? side : p->side[i];
        }
    }
    *p = out;
}

/* Where A and B are over each other; false where they are not. */
RG_INLINE bool cut_out(const meeting *m, polygon *p) {
    p->count = 3;
    for (int i = 0; i < 3; i++) {
        p->p[i][0] = m->face[0].x[i][0];
        p->p[i][1] = m->face[0].x[i][1];
        p->side[i] = i;
    }
    for (int i = 0; i < 3 && p->count > 2; i++) {
        clip(p, &m->face[1].l[(i + 2) % 3], SIDE_OF_B + i);
    }
    return p->count > 2;
}

/* The smallest and the largest depth there. */
RG_INLINE void depths_of(const meeting *m, const polygon *p, double range[2]) {
    range[0] = INFINITY;
    range[1] = -INFINITY;
    for (int i = 0; i < p->count; i++) {
        double d = at(&m->depth, p->p[i]);
        range[0] = d < range[0] ? d : range[0];
        range[1] = d > range[1] ? d : range[1];
    }
}

/* Of that the part which presses; false where there is none. */
RG_INLINE bool cut_pressed(const meeting *m, double reach, polygon *p) {
    if (!(reach > 0)) {
        return false;
    }
    clip(p, &m->depth, SIDE_OF_DEPTH);
    if (p->count > 2) {
        clip(p, &(linear){reach - m->depth.c, -m->depth.x, -m->depth.y}, SIDE_OF_DEPTH);
    }
    return p->count > 2;
}

/* ---- Integrals ---- */

/* int phi, and int phi' (1, p_x, p_y). */
typedef struct {
    double value, slope[3];
} integral;

RG_INLINE integral integrate(const meeting *m, double reach, const polygon *p) {
    integral sum = {0};
    const double *o = p->p[0];
    for (int i = 1; i + 1 < p->count; i++) {
        const double *a = p->p[i], *b = p->p[i + 1];
        double one[2] = {a[0] - o[0], a[1] - o[1]}, two[2] = {b[0] - o[0], b[1] - o[1]};
        double area = 0.5 * (one[0] * two[1] - one[1] * two[0]);
        for (int q = 0; q < INSIDE_POINTS; q++) {
            double at_q[2], slope;
            for (int c = 0; c < 2; c++) {
                at_q[c] = o[c] + inside_rule[q][0] * one[c] + inside_rule[q][1] * two[c];
            }
            double value = potential_of(at(&m->depth, at_q), reach, &slope), w = area * inside_rule[q][2];
            sum.value += w * value;
            sum.slope[0] += w * slope;
            sum.slope[1] += w * slope * at_q[0];
            sum.slope[2] += w * slope * at_q[1];
        }
    }
    return sum;
}

/* What the edges of a face have a part in, as they move: on its corners, int phi l N over the edge. */
RG_INLINE void add_edges(meeting *m, double reach, const polygon *p) {
    for (int i = 0; i < p->count; i++) {
        if (p->side[i] >= SIDE_OF_DEPTH) {
            continue;
        }
        seen_face *f = &m->face[p->side[i] / SIDE_OF_B];
        int k = p->side[i] % SIDE_OF_B, corner[2] = {k, (k + 1) % 3};
        const double *a = p->p[i], *b = p->p[i + 1 < p->count ? i + 1 : 0];
        double out[2] = {b[1] - a[1], a[0] - b[0]};
        for (int q = 0; q < EDGE_POINTS; q++) {
            double at_q[2], slope;
            for (int c = 0; c < 2; c++) {
                at_q[c] = a[c] + edge_rule[q][0] * (b[c] - a[c]);
            }
            double value = edge_rule[q][1] * potential_of(at(&m->depth, at_q), reach, &slope);
            for (int e = 0; e < 2; e++) {
                double share = value * at(&f->l[corner[e]], at_q);
                f->gradient[corner[e]][0] += share * out[0];
                f->gradient[corner[e]][1] += share * out[1];
            }
        }
    }
}

/* Depth follows the heights of the corners, of A with sign 1, of B with -1; and where the corners move along
 * the mid-plane they take the height with them. */
RG_INLINE void set_gradient(seen_face *f, const integral *sum, double sign) {
    for (int i = 0; i < 3; i++) {
        const linear *l = &f->l[i];
        double moment = sign * (l->c * sum->slope[0] + l->x * sum->slope[1] + l->y * sum->slope[2]);
        f->gradient[i][0] = -moment * f->height.x;
        f->gradient[i][1] = -moment * f->height.y;
        f->gradient[i][2] = moment;
    }
}

/* ---- Forces ---- */

/* The gradient by n for corners that do not move: n x T, T the moment of the gradient of the corners, in the
 * frame. */
RG_INLINE void add_moment(const seen_face *f, double by_normal[2]) {
    for (int i = 0; i < 3; i++) {
        const double *x = f->x[i], *g = f->gradient[i];
        by_normal[0] -= x[2] * g[0] - x[0] * g[2];
        by_normal[1] += x[1] * g[2] - x[2] * g[1];
    }
}

/* The share of a pair whose faces had corners in common, w the distance of the means of these; its gradient
 * over that of the pair's energy goes to w and to n. */
typedef struct {
    double share, by_apart[3], by_normal[2];
} handover;

/* Of a former face what the interface's own contact has not: 1 - r^2, r = 1 - (|w|^2 + 15 w_n^2)/area, down
 * to 0 (element/interface_contact.h). */
RG_INLINE void take_over(double area, const double w[3], handover *h) {
    double r = 1 - (dot3(w, w) + 15 * w[2] * w[2]) / area;
    if (r > 0) {
        double by = 2 * r / area;
        h->share = 1 - r * r;
        for (int c = 0; c < 3; c++) {
            h->by_apart[c] = by * (2 * w[c] + (c == 2 ? 30 * w[2] : 0));
        }
        h->by_normal[0] = by * 30 * w[2] * w[0];
        h->by_normal[1] = by * 30 * w[2] * w[1];
    }
}

/* Of faces with their solid between them: rises from 0 where |w|^2 is one area to 1 where it is two. */
RG_INLINE void part(double area, const double w[3], handover *h) {
    double t = dot3(w, w) / area - 1;
    if (t < 1) {
        double rise = t > 0 ? t : 0;
        h->share = rise * rise * (3 - 2 * rise);
        for (int c = 0; c < 3; c++) {
            h->by_apart[c] = 6 * rise * (1 - rise) * 2 * w[c] / area;
        }
    }
}

RG_INLINE handover hand_over(const meeting *m, const rg_contact_pair *pair) {
    handover h = {.share = 1};
    double w[3];
    for (int c = 0; c < 3; c++) {
        w[c] = 0;
        for (int i = 0; i < 3; i++) {
            w[c] += pair->common[1][i] * m->face[1].x[i][c] - pair->common[0][i] * m->face[0].x[i][c];
        }
    }
    if (pair->fading > 0) {
        take_over(pair->fading, w, &h);
    } else if (pair->parting > 0) {
        part(pair->parting, w, &h);
    }
    return h;
}

/* Adds -dE/d(corners) of what depends on the direction of face k alone: `by` = dE/d(normal). */
RG_INLINE void turn_face(const meeting *m, int k, const double *x, const double by[3], double *force) {
    double g[3], one[3], two[3], on1[3], on2[3], along = dot3(by, m->normal[k]);
    for (int c = 0; c < 3; c++) {
        g[c] = (by[c] - along * m->normal[k][c]) / m->length[k];
    }
    minus3(x + 3, x, one);
    minus3(x + 6, x, two);
    cross3(two, g, on1);
    cross3(g, one, on2);
    for (int c = 0; c < 3; c++) {
        force[c] += on1[c] + on2[c];
        force[3 + c] -= on1[c];
        force[6 + c] -= on2[c];
    }
}

/* Energy of a pair, and the forces on its corners where there is some; `x` of A and of B. */
RG_INLINE double pair_forces(const rg_contact_pair *pair, double sunk, const double *a, const double *b,
                             double *force, double *depth) {
    meeting m;
    polygon p;
    double skin = pair->skin + sunk, reach = pair->limit - skin, range[2];
    *depth = 0;
    set_normal(&m, 0, a);
    set_normal(&m, 1, b);
    m.facing = -dot3(m.normal[0], m.normal[1]);
    if (!(m.facing > 0)) {
        return 0;
    }
    set_frame(&m);
    set_face(&m, 0, a, a, &m.face[0]);
    set_face(&m, 1, b, a, &m.face[1]);
    m.depth = (linear){m.face[0].height.c - m.face[1].height.c - skin,
                       m.face[0].height.x - m.face[1].height.x, m.face[0].height.y - m.face[1].height.y};
    if (!cut_out(&m, &p)) {
        return 0;
    }
    handover h = hand_over(&m, pair);
    if (!(h.share > 0)) {
        return 0;
    }
    depths_of(&m, &p, range);
    *depth = range[0] < reach && range[1] + skin > 0 ? range[1] + skin : 0;
    if (!cut_pressed(&m, reach, &p)) {
        return 0;
    }
    integral sum = integrate(&m, reach, &p);
    double slope, weight = weight_of(m.facing, &slope);
    double scale = 0.5 * pair->stiffness * weight * h.share, energy = scale * sum.value;
    if (!(energy > 0)) {
        return 0;
    }
    double by_normal[2] = {0, 0}, turning[3];
    for (int k = 0; k < 2; k++) {
        set_gradient(&m.face[k], &sum, k == 0 ? 1 : -1);
    }
    add_edges(&m, reach, &p);
    for (int k = 0; k < 2; k++) {
        add_moment(&m.face[k], by_normal);
    }
    double passed = 0.5 * pair->stiffness * weight * sum.value; /* on to the share */
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < 3; i++) {
            double g[3], sign = k == 0 ? -1 : 1;
            for (int c = 0; c < 3; c++) {
                g[c] = scale * m.face[k].gradient[i][c] + sign * pair->common[k][i] * passed * h.by_apart[c];
            }
            for (int c = 0; c < 3; c++) {
                force[9 * k + 3 * i + c] =
                    -(g[0] * m.frame[0][c] + g[1] * m.frame[1][c] + g[2] * m.frame[2][c]);
            }
        }
    }
    for (int c = 0; c < 3; c++) {
        double e1 = scale * by_normal[0] + passed * h.by_normal[0],
               e2 = scale * by_normal[1] + passed * h.by_normal[1];
        turning[c] = (e1 * m.frame[0][c] + e2 * m.frame[1][c]) / m.twice;
    }
    double facing = 0.5 * pair->stiffness * slope * h.share * sum.value;
    for (int k = 0; k < 2; k++) {
        double by[3];
        for (int c = 0; c < 3; c++) {
            by[c] = (k == 0 ? turning[c] : -turning[c]) - facing * m.normal[1 - k][c];
        }
        turn_face(&m, k, k == 0 ? a : b, by, force + 9 * k);
    }
    return energy;
}

#endif
