/* Where two triangles of a plane lie over each other and a linear depth d is between 0 and d_m, and what
 * phi = d^2 (1 - d^2/d_m^2)^2 comes to there.
 *
 * The boundary of what both share consists of parts of their six edges, each found for itself: from where it
 * comes in over the lines of the other triangle to where it goes out. Two edges that cross have one crossing,
 * so that the parts meet to the last bit. An edge of B along one of A has no part: A has it. Integrals are
 * sums over triangles from a point o to these parts, exact for polynomials: with r = d/d_m,
 *
 *     int r^m dA = 2 area m!/(m + 2)! h_m(r_0, r_1, r_2),
 *     int r^m l_i dA = 2 area m!/(m + 3)! h_m(r_0, r_1, r_2, r_i),
 *
 * h_m the sum of all products of m of its arguments. With o where d = 0 if P ends there, the side along it
 * has no triangle; that along d = d_m is made of triangles to a point of that line. */
#ifndef RG_CONTACT_OVERLAP_H
#define RG_CONTACT_OVERLAP_H

#include <math.h>

#include "contact/wide.h"

/* c + x p_x + y p_y over the plane. */
typedef struct {
    wide c, x, y;
} linear;

/* Corners run counter-clockwise; edge i goes from corner i to the next. */
typedef struct {
    wide x[3][2];
    linear l[3]; /* barycentric coordinates */
} triangle;

/* Part of an edge. */
typedef struct {
    wide t[2], p[2][2]; /* where it begins and ends: on the edge, and the points */
    wide_mask is;       /* there is one */
} part_of_edge;

enum { A, B, EDGES = 6 }; /* of A, then of B */

typedef struct {
    triangle face[2];
    linear depth;
    wide reach; /* d_m */
    part_of_edge part[EDGES];
    wide least, most; /* depth over what both share */
    wide_mask is;     /* they share something */
} overlap;

typedef struct {
    wide value, slope[3]; /* int phi, and int phi' (1, p_x, p_y) */
    wide edge[2][3][2];   /* what corners move by the edges: int phi l N */
    wide area;
} integral;

RG_INLINE wide at(const linear *f, const wide p[2]) {
    return f->c + f->x * p[0] + f->y * p[1];
}

RG_INLINE void set_triangle(triangle *t) {
    wide area = (t->x[1][0] - t->x[0][0]) * (t->x[2][1] - t->x[0][1]) -
                (t->x[2][0] - t->x[0][0]) * (t->x[1][1] - t->x[0][1]);
    for (int i = 0; i < 3; i++) { /* 1 at corner i, 0 on the edge opposite */
        const wide *a = t->x[(i + 1) % 3], *b = t->x[(i + 2) % 3];
        t->l[i].x = -(b[1] - a[1]) / area;
        t->l[i].y = (b[0] - a[0]) / area;
        t->l[i].c = -t->l[i].x * a[0] - t->l[i].y * a[1];
    }
}

/* ---- The boundary ---- */

/* An edge on whose ends a line has these values, over them at t, at point x. */
RG_INLINE void cut(part_of_edge *e, wide begin, wide end, wide t, const wide x[2]) {
    wide_mask in = (wide_mask)(begin < 0), out = (wide_mask)(end < 0), later = in & (wide_mask)(t > e->t[0]),
              sooner = out & (wide_mask)(t < e->t[1]);
    e->is &= ~(in & out);
    e->t[0] = wide_select(later, t, e->t[0]);
    e->t[1] = wide_select(sooner, t, e->t[1]);
    for (int c = 0; c < 2; c++) {
        e->p[0][c] = wide_select(later, x[c], e->p[0][c]);
        e->p[1][c] = wide_select(sooner, x[c], e->p[1][c]);
    }
}

/* Edges that lie along each other to so much of the size of a face, well above rounding: what is on which
 * side of the other would be a matter of chance. */
#define ALONG 1e-12

RG_INLINE void cross_edges(overlap *o, int i, int j) {
    const wide *from = o->face[A].x[i], *to = o->face[A].x[(i + 1) % 3];
    const linear *over_b = &o->face[B].l[(j + 2) % 3], *over_a = &o->face[A].l[(i + 2) % 3];
    wide begin = at(over_b, from), end = at(over_b, to), begin_b = at(over_a, o->face[B].x[j]),
         end_b = at(over_a, o->face[B].x[(j + 1) % 3]), x[2];
    wide_mask along = (wide_mask)(wide_abs(begin) < ALONG) & (wide_mask)(wide_abs(end) < ALONG);
    begin = wide_select(along, wide_splat(0), begin);
    end = wide_select(along, wide_splat(0), end);
    begin_b = wide_select(along, wide_splat(-1), begin_b);
    end_b = wide_select(along, wide_splat(-1), end_b);
    wide t = begin / (begin - end);
    for (int c = 0; c < 2; c++) {
        x[c] = from[c] + t * (to[c] - from[c]);
    }
    cut(&o->part[i], begin, end, t, x);
    cut(&o->part[3 + j], begin_b, end_b, begin_b / (begin_b - end_b), x);
}

/* The boundary of what both share, and the range of depths there. */
RG_INLINE void find_overlap(overlap *o) {
    for (int e = 0; e < EDGES; e++) {
        const triangle *f = &o->face[e / 3];
        part_of_edge *part = &o->part[e];
        part->is = (wide_mask)(f->x[0][0] == f->x[0][0]);
        for (int k = 0; k < 2; k++) {
            part->t[k] = wide_splat(k);
            for (int c = 0; c < 2; c++) {
                part->p[k][c] = f->x[(e + k) % 3][c];
            }
        }
    }
    for (int e = 0; e < 9; e++) {
        cross_edges(o, e / 3, e % 3);
    }
    o->least = wide_splat(INFINITY);
    o->most = wide_splat(-INFINITY);
    o->is = (wide_mask){0};
    for (int e = 0; e < EDGES; e++) {
        part_of_edge *part = &o->part[e];
        part->is &= (wide_mask)(part->t[0] < part->t[1]);
        o->is |= part->is;
        for (int k = 0; k < 2; k++) {
            wide d = at(&o->depth, part->p[k]);
            o->least = wide_select(part->is & (wide_mask)(d < o->least), d, o->least);
            o->most = wide_select(part->is & (wide_mask)(d > o->most), d, o->most);
        }
    }
}

/* ---- Integrals ---- */

/* A side of P: its ends, with d/d_m there, and whether these lie where it goes over d_m. All 0 where there is
 * none. */
typedef struct {
    wide p[2][2], r[2];
    wide_mask is, over[2];
} pressed_side;

/* Of a part that which lies where 0 < d < d_m. */
RG_INLINE pressed_side press(const overlap *o, const part_of_edge *part) {
    pressed_side s;
    wide d[2] = {at(&o->depth, part->p[0]), at(&o->depth, part->p[1])};
    wide at_0 = d[0] / (d[0] - d[1]), at_m = (d[0] - o->reach) / (d[0] - d[1]), t[2];
    wide_mask under[2];
    for (int k = 0; k < 2; k++) {
        under[k] = (wide_mask)(d[k] < 0);
        s.over[k] = (wide_mask)(d[k] > o->reach);
        t[k] = wide_select(under[k], at_0, wide_select(s.over[k], at_m, wide_splat(k)));
        s.r[k] = wide_select(under[k], wide_splat(0), wide_select(s.over[k], wide_splat(1), d[k] / o->reach));
    }
    s.is = part->is & ~(under[0] & under[1]) & ~(s.over[0] & s.over[1]);
    for (int c = 0; c < 2; c++) {
        wide way = part->p[1][c] - part->p[0][c];
        s.p[0][c] = wide_where(s.is, part->p[0][c] + t[0] * way);
        s.p[1][c] = wide_select(under[1] | s.over[1], part->p[0][c] + t[1] * way, part->p[1][c]);
        s.p[1][c] = wide_where(s.is, s.p[1][c]);
        s.r[c] = wide_where(s.is, s.r[c]);
    }
    return s;
}

enum { DEGREE = 6 };

/* h_m(..., r) from h_m(...), m up to `degree`. */
RG_INLINE void add_argument(int degree, const wide h[], wide r, wide out[]) {
    out[0] = h[0];
    for (int m = 1; m <= degree; m++) {
        out[m] = h[m] + r * out[m - 1];
    }
}

/* Adds a triangle o, p, q, corners with values of d/d_m. */
RG_INLINE void add_triangle(const overlap *over, wide_mask is, wide p[3][2], const wide r[3], integral *sum) {
    wide twice = (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
    wide h[DEGREE + 1], two[DEGREE + 1], one[DEGREE + 1] = {wide_splat(1)};
    for (int m = 1; m <= DEGREE; m++) {
        one[m] = one[m - 1] * r[1];
    }
    add_argument(DEGREE, one, r[2], two);
    add_argument(DEGREE, two, r[0], h);
    twice = wide_where(is, twice);
    sum->area += 0.5 * twice;
    sum->value += twice * over->reach * over->reach * (h[2] / 12 - h[4] / 15 + h[6] / 56);
    for (int i = 0; i < 3; i++) {
        wide k[DEGREE];
        add_argument(DEGREE - 1, h, r[i], k);
        wide slope = 2 * twice * over->reach * (k[1] / 24 - k[3] / 30 + k[5] / 112);
        sum->slope[0] += slope;
        sum->slope[1] += slope * p[i][0];
        sum->slope[2] += slope * p[i][1];
    }
}

/* Adds what an edge has a part in, as it moves: on its corners, int phi l N over the side. */
RG_INLINE void add_edge(const overlap *o, int e, const pressed_side *s, integral *sum) {
    wide out[2] = {s->p[1][1] - s->p[0][1], s->p[0][0] - s->p[1][0]}, value[2];
    wide one[DEGREE + 1] = {wide_splat(1)}, two[DEGREE + 1];
    for (int m = 1; m <= DEGREE; m++) {
        one[m] = one[m - 1] * s->r[0];
    }
    add_argument(DEGREE, one, s->r[1], two);
    for (int k = 0; k < 2; k++) { /* int phi (1 - t), int phi t */
        wide h[DEGREE + 1];
        add_argument(DEGREE, two, s->r[k], h);
        value[k] = o->reach * o->reach * (h[2] / 12 - h[4] / 15 + h[6] / 56);
    }
    for (int k = 0; k < 2; k++) {
        int corner = (e + k) % 3;
        const linear *l = &o->face[e / 3].l[corner];
        wide share = value[0] * at(l, s->p[0]) + value[1] * at(l, s->p[1]);
        sum->edge[e / 3][corner][0] += share * out[0];
        sum->edge[e / 3][corner][1] += share * out[1];
    }
}

/* The foot of p on the line where the depth is d. */
RG_INLINE void foot_of(const overlap *o, const wide p[2], wide d, wide out[2]) {
    const linear *f = &o->depth;
    wide way = (d - at(f, p)) / (f->x * f->x + f->y * f->y);
    out[0] = p[0] + way * f->x;
    out[1] = p[1] + way * f->y;
}

/* Where the triangles meet: amid the sides, or beneath that where d = 0; its d/d_m. */
RG_INLINE wide middle_of(const overlap *o, const pressed_side s[EDGES], wide middle[2]) {
    wide count = wide_splat(0), foot[2];
    middle[0] = middle[1] = wide_splat(0);
    for (int e = 0; e < EDGES; e++) {
        count += wide_where(s[e].is, wide_splat(2));
        for (int c = 0; c < 2; c++) {
            middle[c] += s[e].p[0][c] + s[e].p[1][c];
        }
    }
    for (int c = 0; c < 2; c++) {
        middle[c] /= count;
    }
    wide_mask ends = (wide_mask)(o->least < 0);
    wide r = wide_select(ends, wide_splat(0), at(&o->depth, middle) / o->reach);
    foot_of(o, middle, wide_splat(0), foot);
    for (int c = 0; c < 2; c++) {
        middle[c] = wide_select(ends, foot[c], middle[c]);
    }
    return r;
}

RG_INLINE integral integrate(const overlap *o) {
    integral sum = {.value = wide_splat(0)};
    pressed_side side[EDGES];
    wide p[3][2], r[3];
    for (int e = 0; e < EDGES; e++) {
        side[e] = press(o, &o->part[e]);
        add_edge(o, e, &side[e], &sum);
    }
    r[0] = middle_of(o, side, p[0]);
    for (int e = 0; e < EDGES; e++) {
        for (int k = 0; k < 2; k++) {
            r[1 + k] = side[e].r[k];
            for (int c = 0; c < 2; c++) {
                p[1 + k][c] = side[e].p[k][c];
            }
        }
        add_triangle(o, side[e].is, p, r, &sum);
    }
    wide_mask deep = o->is & (wide_mask)(o->most > o->reach);
    if (!wide_any(deep)) {
        return sum;
    }
    wide beyond[2];
    foot_of(o, p[0], o->reach, beyond);
    beyond[0] = wide_where(deep, beyond[0]); /* elsewhere it may not be a number */
    beyond[1] = wide_where(deep, beyond[1]);
    for (int e = 0; e < EDGES; e++) {
        for (int k = 0; k < 2; k++) { /* comes back below d_m there, goes over it here */
            r[1] = r[2] = wide_splat(1);
            for (int c = 0; c < 2; c++) {
                p[2 - k][c] = side[e].p[k][c];
                p[1 + k][c] = beyond[c];
            }
            add_triangle(o, side[e].is & side[e].over[k], p, r, &sum);
        }
    }
    return sum;
}

#endif
