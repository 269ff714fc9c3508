/* An elastic solid that loses stiffness as it is strained: with E the Green strain and
 *     W0 = lambda/2 (tr E)^2 + mu E:E,   W = (1 - D) W0,   S = (1 - D) (lambda tr E 1 + 2 mu E),
 * the damage D follows from Y, the largest W0 that the point has seen:
 *     D = most (1 - exp(-(Y - threshold)/scale))  beyond the threshold.
 * A step sets free the integral of Y dD, so what is stored and what is set free add up to the work. */
#define RG_HISTORY      1 /* Y (J/m^3) */
#define RG_SCALAR_POINT softening
#include "user/scalar.h"

enum { YOUNG, POISSON, THRESHOLD, SCALE, MOST };
static const rg_user_parameter parameters[] = {
    {"young", "Pa", "Young's modulus", .low = 0, .high = INFINITY, .open = true},
    {"poisson", NULL, "Poisson's ratio", .low = 0, .high = 0.5, .open = true},
    {"threshold", "J/m3", "energy at which damage begins", .low = 0, .high = INFINITY, .open = true},
    {"scale", "J/m3", "energy over which it grows", .low = 0, .high = INFINITY, .open = true},
    {"most", NULL, "damage at the end", .low = 0, .high = 1, .open = true, .optional = true, .fallback = 0.3},
};

static void moduli(const double p[], double *lambda, double *mu) {
    *lambda = p[YOUNG] * p[POISSON] / ((1 + p[POISSON]) * (1 - 2 * p[POISSON]));
    *mu = p[YOUNG] / (2 * (1 + p[POISSON]));
}

static double damage(const double p[], double Y) {
    return Y > p[THRESHOLD] ? p[MOST] * (1 - exp(-(Y - p[THRESHOLD]) / p[SCALE])) : 0;
}

/* Integral of Y dD up to Y. */
static double dissipated(const double p[], double Y) {
    double start = p[THRESHOLD], scale = p[SCALE];
    return Y > start ? p[MOST] * (start + scale - (Y + scale) * exp(-(Y - start) / scale)) : 0;
}

static void softening(double F[3][3], double history[], const double p[], double dt, rg_scalar_point *out) {
    double lambda, mu, E[3][3], trace = 0, square = 0, stretch = 0;
    moduli(p, &lambda, &mu);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            double C = F[0][i] * F[0][j] + F[1][i] * F[1][j] + F[2][i] * F[2][j];
            E[i][j] = 0.5 * (C - (i == j));
            square += E[i][j] * E[i][j];
        }
        trace += E[i][i];
    }
    for (int i = 0; i < 3; i++) { /* largest sum of a row of F F^T: no less than its largest eigenvalue */
        double row = 0;
        for (int j = 0; j < 3; j++) {
            row += fabs(F[i][0] * F[j][0] + F[i][1] * F[j][1] + F[i][2] * F[j][2]);
        }
        stretch = fmax(stretch, row);
    }
    double whole = 0.5 * lambda * trace * trace + mu * square, before = history[0];
    if (dt > 0 && whole > history[0]) {
        history[0] = whole;
    }
    double D = damage(p, history[0]), left = 1 - D;
    for (int i = 0; i < 3; i++) {
        for (int J = 0; J < 3; J++) {
            for (int K = 0; K < 3; K++) {
                double S = lambda * trace * (J == K) + 2 * mu * E[J][K];
                out->P[i][J] += left * F[i][K] * S;
            }
        }
    }
    out->energy = left * whole;
    /* F C F^T of the stiffness, and N.S.N of the stress. */
    out->stiffening = stretch + sqrt(square) * (3 * lambda + 2 * mu) / (lambda + 2 * mu);
    out->released[RG_RELEASED_DAMAGE] = dissipated(p, history[0]) - dissipated(p, before);
    out->internal[RG_INTERNAL_DAMAGE] = D;
}

RG_USER_MATERIAL(.name = "softening", .meaning = "elastic, with a damage that strain brings",
                 RG_USER_LIST(parameters), .inside = RG_HAS_DAMAGE, .moduli = moduli)
