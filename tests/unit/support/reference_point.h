/* One point of a material with a history, by its reference: paths of its deformation, and what must hold of
 * any such material. */
#ifndef RG_REFERENCE_POINT_H
#define RG_REFERENCE_POINT_H

#include <math.h>
#include <string.h>

#include "reference/material.h"
#include "reference/reference.h"
#include "support/dice.h"
#include "support/figures.h"

typedef struct {
    const rg_material *m;
    rg_reference_point_law *law;
    double F[3][3], P[3][3], history[24];
    rg_reference_point out;
    double spent; /* set free so far (J/m^3) */
} reference_point;

static inline reference_point point_make(const rg_material *m, rg_reference_point_law *law) {
    return (reference_point){.m = m, .law = law, .F = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
}

/* A step that ends at F. */
static inline void point_step(reference_point *p) {
    p->law(p->m, true, p->F, p->history, p->P, &p->out);
    p->spent += p->out.released[RG_RELEASED_PLASTIC] + p->out.released[RG_RELEASED_DAMAGE];
}

static inline void point_stretch(reference_point *p, double across, double along) {
    p->F[0][0] = p->F[1][1] = exp(across);
    p->F[2][2] = exp(along);
    point_step(p);
}

/* tau = P F^T. */
static inline void point_kirchhoff(const reference_point *p, double tau[3][3]) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            tau[i][j] = rg_reference_dot(p->P[i], p->F[j]);
}

/* Of tau: the mean, and von Mises'. */
static inline double point_mean(const reference_point *p) {
    double tau[3][3];
    point_kirchhoff(p, tau);
    return (tau[0][0] + tau[1][1] + tau[2][2]) / 3;
}

static inline double point_mises(const reference_point *p) {
    double tau[3][3], mean = point_mean(p), square = 0;
    point_kirchhoff(p, tau);
    for (int k = 0; k < 9; k++)
        square += pow(tau[k / 3][k % 3] - (k % 4 == 0) * mean, 2);
    return sqrt(1.5 * square);
}

/* F <- exp(size random) F, with `volume` of the size in its determinant. */
static inline void point_wander(reference_point *p, dice *d, double size, double volume) {
    double rate[3][3], move[3][3], next[3][3], grow = 1 + volume * size * dice_sign(d);
    dice_deviator(d, size * dice_unit(d), rate);
    symmetric_exp(rate, move);
    product(move, p->F, next);
    for (int k = 0; k < 9; k++)
        p->F[k / 3][k % 3] = grow * next[k / 3][k % 3];
}

/* A random path seen by an observer who turns at each step: the same history, the stress turned. Both over
 * `modulus`, of histories over the largest value of their kind. */
static inline void point_turned(reference_point still, dice *d, int steps, double size, double modulus,
                                figure *stress, figure *history) {
    reference_point turned = still;
    double largest[24] = {0}, apart[24] = {0};
    int values = rg_material_history(still.m->model);
    for (int n = 0; n < steps; n++) {
        double Q[3][3], expected[3][3];
        point_wander(&still, d, size, 0.2);
        dice_rotation(d, Q);
        product(Q, still.F, turned.F);
        point_step(&still);
        point_step(&turned);
        product(Q, still.P, expected);
        for (int k = 0; k < 9; k++)
            raise_figure(stress, turned.P[k / 3][k % 3], expected[k / 3][k % 3], modulus);
        for (int k = 0; k < values; k++) {
            largest[k] = fmax(largest[k], fabs(still.history[k]));
            apart[k] = fmax(apart[k], fabs(turned.history[k] - still.history[k]));
        }
    }
    for (int k = 0; k < values; k++)
        raise_figure(history, apart[k], 0, largest[k] > 0 ? largest[k] : 1);
}

/* P at F, with the history as it is, against differences of the energy. */
static inline void point_gradient(const reference_point *p, double modulus, figure *gradient) {
    const double step = 1e-5;
    for (int k = 0; k < 9; k++) {
        double moved[2];
        reference_point at = *p, other = *p;
        at.law(at.m, false, at.F, at.history, at.P, &at.out);
        for (int side = 0; side < 2; side++) {
            other.F[k / 3][k % 3] = p->F[k / 3][k % 3] + (side ? step : -step);
            other.law(other.m, false, other.F, other.history, other.P, &other.out);
            moved[side] = other.out.energy;
        }
        raise_figure(gradient, at.P[k / 3][k % 3], (moved[1] - moved[0]) / (2 * step), modulus);
    }
}

/* Work done on a point along a curved path of displacement gradients up to 5 % times `size`, less what it
 * stores and has set free, over the latter; `press`: its volume falls at the same time by so much. */
static inline double point_missing_energy(reference_point p, int steps, double size, double press) {
    double work = 0;
    for (int n = 1; n <= steps; n++) {
        double t = (double)n / steps, before[3][3], from[3][3], move[9] = {0};
        memcpy(before, p.P, sizeof before);
        memcpy(from, p.F, sizeof from);
        move[0] = 0.02 * sin(2 * t);
        move[1] = 0.05 * t * t;
        move[5] = 0.03 * (1 - cos(3 * t));
        move[8] = -0.03 * t;
        for (int k = 0; k < 9; k++)
            p.F[k / 3][k % 3] = ((k % 4 == 0) + size * move[k]) * cbrt(1 - press * t);
        point_step(&p);
        for (int k = 0; k < 9; k++)
            work += (p.P[k / 3][k % 3] + before[k / 3][k % 3]) / 2 * (p.F[k / 3][k % 3] - from[k / 3][k % 3]);
    }
    return fabs(work - p.out.energy - p.spent) / p.spent;
}

#endif
