/* Contact of two faces: the energy from its definition, and its gradient by complex steps, exact to rounding.
 * The polygon is found in another way than the kernel's: its corners are those points where two of the eight
 * lines cross that no other line cuts off, in the order of their angles. */
#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reference/reference.h"

typedef double complex number;
enum { LINES = 8, OF_FACES = 6, CROSSINGS = LINES * (LINES - 1) / 2 };
#define STEP 1e-30

static number dot(const number a[3], const number b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const number a[3], const number b[3], number out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static void unit(number v[3]) {
    number length = csqrt(dot(v, v));
    for (int c = 0; c < 3; c++) {
        v[c] /= length;
    }
}

/* c + x p_x + y p_y >= 0. */
typedef struct {
    number c, x, y;
} line;

static number value(const line *f, const number p[2]) {
    return f->c + f->x * p[0] + f->y * p[1];
}

/* The linear function that has these values at three points. */
static line through(number p[3][2], const number z[3]) {
    number a = p[1][0] - p[0][0], b = p[1][1] - p[0][1], c = p[2][0] - p[0][0], d = p[2][1] - p[0][1];
    number det = a * d - b * c, x = ((z[1] - z[0]) * d - (z[2] - z[0]) * b) / det,
           y = ((z[2] - z[0]) * a - (z[1] - z[0]) * c) / det;
    return (line){z[0] - x * p[0][0] - y * p[0][1], x, y};
}

typedef struct {
    number p[2];
    double angle;
} corner;

static int by_angle(const void *a, const void *b) {
    const corner *p = a, *q = b;
    return (p->angle > q->angle) - (p->angle < q->angle);
}

/* Corners of what is on the good side of all lines. */
static int corners_of(const line *f, int lines, corner *out) {
    int count = 0;
    for (int i = 0; i < lines; i++) {
        for (int j = i + 1; j < lines; j++) {
            number det = f[i].x * f[j].y - f[i].y * f[j].x;
            if (!(cabs(det) > 0)) {
                continue;
            }
            corner k = {
                .p = {(f[i].y * f[j].c - f[j].y * f[i].c) / det, (f[j].x * f[i].c - f[i].x * f[j].c) / det}};
            bool good = true;
            for (int m = 0; m < lines; m++) {
                good = good && (m == i || m == j || creal(value(&f[m], k.p)) >= 0);
            }
            if (good) {
                out[count++] = k;
            }
        }
    }
    number middle[2] = {0, 0};
    for (int i = 0; i < count; i++) {
        middle[0] += out[i].p[0] / count;
        middle[1] += out[i].p[1] / count;
    }
    for (int i = 0; i < count; i++) {
        out[i].angle = atan2(creal(out[i].p[1] - middle[1]), creal(out[i].p[0] - middle[0]));
    }
    qsort(out, (size_t)count, sizeof *out, by_angle);
    return count;
}

/* Legendre's points and weights for degree 7 on (0, 1). */
static const double point[4][2] = {{0.069431844202973712, 0.173927422568726929},
                                   {0.330009478207571868, 0.326072577431273071},
                                   {0.669990521792428132, 0.326072577431273071},
                                   {0.930568155797026288, 0.173927422568726929}};

/* int d^2 (1 - d^2/reach^2)^2 over a triangle, as a square folded to it. */
static number triangle(const line *depth, double reach, const number *o, const number *a, const number *b) {
    number area = (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]), sum = 0;
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++) {
            double s = point[i][0], t = point[j][0];
            number p[2];
            for (int c = 0; c < 2; c++) {
                p[c] = o[c] + s * ((1 - t) * (a[c] - o[c]) + t * (b[c] - o[c]));
            }
            number d = value(depth, p), r = d / reach;
            sum += point[i][1] * point[j][1] * s * area * d * d * (1 - r * r) * (1 - r * r);
        }
    }
    return sum;
}

/* From 0 at 0 to 1 at 1. */
static number rising(number t) {
    return creal(t) <= 0 ? 0 : creal(t) < 1 ? t * t * (3 - 2 * t) : 1;
}

/* Of a pair with corners in common that have come w apart. */
static number share_of(const rg_contact_pair *pair, const number w[3], const number n[3]) {
    if (pair->parting > 0) {
        return rising(dot(w, w) / pair->parting - 1);
    }
    number wn = dot(w, n), root = pair->fading > 0 ? 1 - (dot(w, w) + 15 * wn * wn) / pair->fading : 0;
    return creal(root) > 0 ? 1 - root * root : 1;
}

/* The area of corners in the order of their angles. */
static number area_of(const corner *k, int count) {
    number sum = 0;
    for (int i = 1; i + 1 < count; i++) {
        const number *o = k[0].p, *a = k[i].p, *b = k[i + 1].p;
        sum += ((a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0])) / 2;
    }
    return sum;
}

/* What friction needs to know besides: the frame of the mid-plane, the faces' barycentric coordinates in it,
 * W share area. */
typedef struct {
    number e[2][3], n[3];
    line l[2][3];
    number area;
} plane;

/* `lifted` is added to the depth; `seen` may be NULL. */
static number energy_of(const rg_contact_pair *pair, double sunk, number x[2][3][3], const line *lifted,
                        double *deepest, plane *seen) {
    double skin = pair->skin + sunk, reach = pair->limit - skin, least = INFINITY;
    number normal[2][3], n[3], e[2][3], axis[3] = {0.3, 0.5, -0.8}, p[2][3][2], z[2][3], w[3] = {0, 0, 0};
    for (int k = 0; k < 2; k++) {
        number one[3], two[3];
        for (int c = 0; c < 3; c++) {
            one[c] = x[k][1][c] - x[k][0][c];
            two[c] = x[k][2][c] - x[k][0][c];
        }
        cross(one, two, normal[k]);
        unit(normal[k]);
    }
    *deepest = 0;
    number facing = -dot(normal[0], normal[1]);
    if (!(creal(facing) > 0)) {
        return 0;
    }
    for (int c = 0; c < 3; c++) {
        n[c] = normal[0][c] - normal[1][c];
    }
    unit(n);
    cross(n, axis, e[0]);
    unit(e[0]);
    cross(n, e[0], e[1]);
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < 3; i++) {
            p[k][i][0] = dot(x[k][i], e[0]);
            p[k][i][1] = dot(x[k][i], e[1]);
            z[k][i] = dot(x[k][i], n);
            for (int c = 0; c < 3; c++) {
                w[c] += (k == 1 ? 1 : -1) * pair->common[k][i] * x[k][i][c];
            }
        }
    }
    line a = through(p[0], z[0]), b = through(p[1], z[1]), f[LINES],
         depth = {a.c - b.c - skin + lifted->c, a.x - b.x + lifted->x, a.y - b.y + lifted->y};
    for (int i = 0; i < 6; i++) {
        number one[3] = {0, 0, 0};
        one[i % 3] = 1;
        f[i] = through(p[i / 3], one);
    }
    f[6] = depth;
    f[7] = (line){reach - depth.c, -depth.x, -depth.y};
    corner k[CROSSINGS];
    int count = corners_of(f, OF_FACES, k);
    for (int i = 0; i < count; i++) {
        double d = creal(value(&depth, k[i].p)) + skin;
        least = fmin(least, d);
        *deepest = fmax(*deepest, d);
    }
    number share = share_of(pair, w, n);
    *deepest = least < pair->limit && creal(share) > 0 ? *deepest : 0;
    if (!(reach > 0)) {
        return 0;
    }
    count = corners_of(f, LINES, k);
    number sum = 0, t = facing / 0.35;
    for (int i = 1; i + 1 < count; i++) {
        sum += triangle(&depth, reach, k[0].p, k[i].p, k[i + 1].p);
    }
    if (seen != NULL) {
        *seen = (plane){.area = rising(t) * share * area_of(k, count)};
        memcpy(seen->e, e, sizeof e);
        memcpy(seen->n, n, sizeof n);
        memcpy(seen->l, f, sizeof seen->l);
    }
    return 0.5 * pair->stiffness * rising(t) * share * sum;
}

/* ---- Friction ---- */

/* k/2 |P r|^2, r from the spring's end on B to that on A; P takes away what is along the mid-plane's normal.
 */
static number spring_energy(double k, double anchor[2][3], number x[2][3][3]) {
    number normal[2][3], n[3], r[3] = {0, 0, 0};
    for (int f = 0; f < 2; f++) {
        number one[3], two[3];
        for (int c = 0; c < 3; c++) {
            one[c] = x[f][1][c] - x[f][0][c];
            two[c] = x[f][2][c] - x[f][0][c];
            for (int i = 0; i < 3; i++) {
                r[c] += (f == 0 ? 1 : -1) * anchor[f][i] * x[f][i][c];
            }
        }
        cross(one, two, normal[f]);
        unit(normal[f]);
    }
    for (int c = 0; c < 3; c++) {
        n[c] = normal[0][c] - normal[1][c];
    }
    unit(n);
    return 0.5 * k * (dot(r, r) - dot(r, n) * dot(r, n));
}

/* Coordinates in the mid-plane: along A's first edge, and across. */
static void set_axes(const plane *at, number x[2][3][3], double axis[2][3]) {
    number edge[3], across[3];
    for (int c = 0; c < 3; c++) {
        edge[c] = x[0][1][c] - x[0][0][c];
    }
    number up = dot(edge, at->n);
    for (int c = 0; c < 3; c++) {
        edge[c] -= up * at->n[c];
    }
    unit(edge);
    cross(at->n, edge, across);
    for (int c = 0; c < 3; c++) {
        axis[0][c] = creal(edge[c]);
        axis[1][c] = creal(across[c]);
    }
}

/* The derivatives of the energy by a depth of 1, p_x, p_y: the normal force and its moments. */
static void force_of(const rg_contact_pair *pair, double sunk, number x[2][3][3], double by[3]) {
    double deepest;
    for (int c = 0; c < 3; c++) {
        line lifted = {c == 0 ? STEP * I : 0, c == 1 ? STEP * I : 0, c == 2 ? STEP * I : 0};
        by[c] = cimag(energy_of(pair, sunk, x, &lifted, &deepest, NULL)) / STEP;
    }
}

static void set_ends(const plane *at, const double by[3], double axis[2][3], const double e[2],
                     double *grip) {
    number a[2] = {by[1] / by[0], by[2] / by[0]}, b[2] = {a[0], a[1]};
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < 2; k++) {
            b[k] -= (e[0] * axis[0][c] + e[1] * axis[1][c]) * at->e[k][c];
        }
    }
    static const int order[2] = {0,
                                 2}; /* as the kernel sees B: from behind, coordinates of corners 0 and 2 */
    for (int i = 0; i < 2; i++) {
        grip[RG_GRIP_ANCHOR + i] = creal(value(&at->l[0][i], a));
        grip[RG_GRIP_ANCHOR + 2 + i] = creal(value(&at->l[1][order[i]], b));
    }
}

static void anchors_of(const double *grip, double anchor[2][3]) {
    const double *l = grip + RG_GRIP_ANCHOR;
    anchor[0][0] = l[0];
    anchor[0][1] = l[1];
    anchor[0][2] = 1 - l[0] - l[1];
    anchor[1][0] = l[2];
    anchor[1][2] = l[3];
    anchor[1][1] = 1 - l[2] - l[3];
}

static double stored(const double *grip) {
    const double *e = grip + RG_GRIP_STRETCH;
    return 0.5 * grip[RG_GRIP_STIFFNESS] * (e[0] * e[0] + e[1] * e[1]);
}

/* Whether the point of attack is over both faces, or nearly. */
static bool attacks_over(const plane *at, const double by[3]) {
    number c[2] = {by[1] / by[0], by[2] / by[0]};
    bool over = true;
    for (int i = 0; i < 6; i++) {
        over = over && creal(value(&at->l[i / 3][i % 3], c)) > -0.1;
    }
    return over;
}

/* The grip of a pair that presses goes on; returns the heat. */
static double advance_grip(const rg_contact_pair *pair, double sunk, number x[2][3][3], const plane *at,
                           double *grip) {
    double by[3], axis[2][3], anchor[2][3], s[2] = {0, 0}, *e = grip + RG_GRIP_STRETCH, old[2] = {e[0], e[1]},
                                            before = stored(grip), size = 0, work = 0;
    double k0 = grip[RG_GRIP_STIFFNESS], k = pair->shear * creal(at->area);
    force_of(pair, sunk, x, by);
    if (!(by[0] > 0 && k > 0 && attacks_over(at, by))) {
        grip[RG_GRIP_STIFFNESS] = 0;
        return before;
    }
    set_axes(at, x, axis);
    anchors_of(grip, anchor);
    for (int c = 0; k0 > 0 && c < 18; c++) { /* A, B; corner; component */
        double r = (c < 9 ? 1 : -1) * anchor[c / 9][c / 3 % 3] * creal(x[c / 9][c / 3 % 3][c % 3]);
        s[0] += r * axis[0][c % 3];
        s[1] += r * axis[1][c % 3];
    }
    double kept = k0 < k ? k0 / k : 1;
    for (int c = 0; c < 2; c++) {
        e[c] = s[c] - (1 - kept) * (k0 > 0 ? old[c] : 0);
    }
    size = k * hypot(e[0], e[1]);
    bool slid = k0 > 0 && grip[RG_GRIP_SLIDES] > 0, slides = size > pair->friction[slid] * by[0];
    for (int c = 0; c < 2; c++) {
        e[c] *= slides ? pair->friction[1] * by[0] / size : 1;
        work += k0 > 0 ? 0.5 * (k0 * old[c] + k * e[c]) * (s[c] - old[c]) : 0;
    }
    grip[RG_GRIP_STIFFNESS] = k;
    grip[RG_GRIP_SLIDES] = slides;
    if (slides || kept < 1) {
        set_ends(at, by, axis, e, grip);
    }
    return work - (stored(grip) - before);
}

/* ---- Damping ---- */

/* With the forces of the potential in `force`: adds that of damping (contact/damping.h). */
static void damp(const rg_contact_args *args, size_t i, double sunk, number x[2][3][3], const plane *at,
                 double *force) {
    const rg_contact_pair *pair = &args->pair[i];
    double by[3], rate = 0, area = creal(at->area);
    force_of(pair, sunk, x, by);
    args->stiffer[i] = 0;
    memset(args->drag + 18 * i, 0, 18 * sizeof(double));
    if (!(by[0] > 0)) {
        return;
    }
    for (size_t n = 0; n < 18; n++) {
        rate -= force[n] * args->rate[9 * (size_t)pair->face[n / 9] + n % 9] / by[0];
    }
    double coefficient = fmin(args->damping * by[0], pair->impedance * area);
    double q = fmax(-1, fmin(1, coefficient * rate / by[0]));
    args->stiffer[i] = pair->stiffness * (1 + fmax(q, 0)) + 2 * coefficient / (area * args->dt);
    for (size_t n = 0; n < 18; n++) {
        args->drag[18 * i + n] = q * force[n];
        force[n] += q * force[n];
    }
}

void rg_reference_contact(const rg_contact_args *args, size_t begin, size_t end) {
    static const line flat = {0, 0, 0};
    for (size_t i = begin; i < end; i++) {
        const rg_contact_pair *pair = &args->pair[i];
        number x[2][3][3];
        for (int k = 0; k < 18; k++) {
            x[k / 9][k / 3 % 3][k % 3] = args->corner[9 * pair->face[k / 9] + k % 9];
        }
        double sunk = fmax(args->sunk[pair->face[0]], args->sunk[pair->face[1]]), deepest, k = 0,
               anchor[2][3] = {{0}};
        plane at;
        args->energy[i] = creal(energy_of(pair, sunk, x, &flat, &args->depth[i], &at));
        bool presses = args->energy[i] > 0;
        if (args->grip != NULL) {
            double *grip = args->grip + RG_GRIP * i;
            args->heat[i] = presses ? advance_grip(pair, sunk, x, &at, grip) : stored(grip);
            grip[RG_GRIP_STIFFNESS] = presses ? grip[RG_GRIP_STIFFNESS] : 0;
            args->energy[i] += stored(grip);
            k = grip[RG_GRIP_STIFFNESS];
            anchors_of(grip, anchor);
        }
        double spring[18] = {0}; /* apart: only what the potential does is damped */
        for (int n = 0; n < 18 && presses; n++) {
            number *moved = &x[n / 9][n / 3 % 3][n % 3], kept = *moved;
            *moved += STEP * I;
            number energy = energy_of(pair, sunk, x, &flat, &deepest, NULL);
            spring[n] = k > 0 ? -cimag(spring_energy(k, anchor, x)) / STEP : 0;
            args->force[18 * i + (size_t)n] = -cimag(energy) / STEP;
            *moved = kept;
        }
        if (presses && args->rate != NULL) {
            damp(args, i, sunk, x, &at, args->force + 18 * i);
        }
        for (size_t n = 0; n < 18 && presses; n++) {
            args->force[18 * i + n] += spring[n];
        }
    }
}
