#include "base/stiffness.h"

#include <math.h>
#include <string.h>

#include "base/dense.h"
#include "base/principal.h"
#include "base/vector.h"

static const int voigt[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}}; /* of a pair of axes */
static const int first[6] = {0, 1, 2, 1, 0, 0}, second[6] = {0, 1, 2, 2, 2, 1};

int rg_stiffness_place(int i, int j) {
    int a = i < j ? i : j, b = i < j ? j : i;
    return 6 * a - a * (a - 1) / 2 + b - a;
}

/* ---- Eigenvalues ---- */

static double least_eigenvalue(double m[6][6]) {
    enum { SWEEPS = 20 }; /* it converges quadratically: eight are plenty */
    for (int n = 0; n < SWEEPS * 36; n++) {
        int p = n % 36 / 6, q = n % 6;
        if (p < q && m[p][q] != 0) {
            double turn[2];
            rg_dense_rotate(6, m[0], p, q, turn);
        }
    }
    double least = m[0][0];
    for (int k = 1; k < 6; k++) {
        least = fmin(least, m[k][k]);
    }
    return least;
}

/* In Kelvin's notation, shears times sqrt 2, the matrix has the eigenvalues of the tensor. */
double rg_stiffness_least(const double c[RG_STIFFNESS]) {
    double m[6][6];
    for (int n = 0; n < 36; n++) {
        int i = n / 6, j = n % 6;
        m[i][j] = c[rg_stiffness_place(i, j)] * (i < 3 ? 1 : sqrt(2)) * (j < 3 ? 1 : sqrt(2));
    }
    return least_eigenvalue(m);
}

bool rg_stiffness_orthotropic(const double young[3], const double poisson[3], const double shear[3],
                              double c[RG_STIFFNESS], double *least) {
    double s[9], m[6][6] = {{0}};
    for (int k = 0; k < 3; k++) {
        int i = k == 0 ? 1 : 0, j = k == 2 ? 1 : 2; /* 23, 13, 12 */
        s[4 * k] = 1 / young[k];
        s[3 * i + j] = s[3 * j + i] = -poisson[k] / young[i];
        m[3 + k][3 + k] = 0.5 / shear[k]; /* of the tensor's components, in Kelvin's notation */
    }
    for (int n = 0; n < 9; n++) {
        m[n / 3][n % 3] = s[n];
    }
    *least = least_eigenvalue(m);
    if (!(*least > 0)) {
        return false;
    }
    rg_dense_invert(3, s);
    memset(c, 0, RG_STIFFNESS * sizeof *c);
    for (int i = 0; i < 3; i++) {
        for (int j = i; j < 3; j++) {
            c[rg_stiffness_place(i, j)] = s[3 * i + j];
        }
        c[rg_stiffness_place(3 + i, 3 + i)] = shear[i];
    }
    return true;
}

/* ---- Directions ---- */

/* Turns one index of all 81 components after the other. */
void rg_stiffness_turn(double c[RG_STIFFNESS], const double axis[3][3]) {
    double from[81], to[81];
    for (int n = 0; n < 81; n++) {
        from[n] = c[rg_stiffness_place(voigt[n / 27][n / 9 % 3], voigt[n / 3 % 3][n % 3])];
    }
    for (int stride = 1; stride < 81; stride *= 3) {
        for (int n = 0; n < 81; n++) {
            int i = n / stride % 3, base = n - i * stride;
            to[n] = axis[0][i] * from[base] + axis[1][i] * from[base + stride] +
                    axis[2][i] * from[base + 2 * stride];
        }
        memcpy(from, to, sizeof from);
    }
    for (int i = 0; i < 6; i++) {
        for (int j = i; j < 6; j++) {
            c[rg_stiffness_place(i, j)] = from[27 * first[i] + 9 * second[i] + 3 * first[j] + second[j]];
        }
    }
}

void rg_stiffness_axes(const double angles[3], double axis[3][3]) {
    const double degree = 0.017453292519943295769;
    double c1 = cos(angles[0] * degree), c = cos(angles[1] * degree), c2 = cos(angles[2] * degree);
    double s1 = sin(angles[0] * degree), s = sin(angles[1] * degree), s2 = sin(angles[2] * degree);
    const double rows[3][3] = {{c1 * c2 - s1 * s2 * c, s1 * c2 + c1 * s2 * c, s2 * s},
                               {-c1 * s2 - s1 * c2 * c, -s1 * s2 + c1 * c2 * c, c2 * s},
                               {s1 * s, -c1 * s, c}};
    memcpy(axis, rows, sizeof rows);
}

void rg_stiffness_mean(const double c[RG_STIFFNESS], double *bulk, double *shear) {
    double along = 0, across = 0, shears = 0;
    for (int i = 0; i < 3; i++) {
        along += c[rg_stiffness_place(i, i)];
        across += c[rg_stiffness_place(i, (i + 1) % 3)];
        shears += c[rg_stiffness_place(3 + i, 3 + i)];
    }
    *bulk = (along + 2 * across) / 9;
    *shear = (along - across + 3 * shears) / 15;
}

void rg_stiffness_acoustic(const double c[RG_STIFFNESS], const double n[3], double tensor[6]) {
    for (int k = 0; k < 6; k++) {
        tensor[k] = 0;
        for (int m = 0; m < 9; m++) {
            int a = voigt[first[k]][m / 3], b = voigt[second[k]][m % 3];
            tensor[k] += c[rg_stiffness_place(a, b)] * n[m / 3] * n[m % 3];
        }
    }
}

enum { LARGEST, SMALLEST }; /* eigenvalue of the acoustic tensor */

static double eigenvalue(const double c[RG_STIFFNESS], const double n[3], int which) {
    double tensor[6], value[3];
    rg_stiffness_acoustic(c, n, tensor);
    rg_principal(tensor, value);
    return value[which == LARGEST ? 0 : 2];
}

/* Goes from n along directions that raise sign times the eigenvalue, by steps that shrink. */
static double climb(const double c[RG_STIFFNESS], double n[3], int which, double sign, double step) {
    double best = sign * eigenvalue(c, n, which);
    while (step > 2e-4) { /* 1 - cos(step)/2: below 1e-7 of what is sought */
        bool higher = false;
        for (int k = 0; k < 6; k++) {
            double other[3] = {n[0], n[1], n[2]};
            other[k / 2] += k % 2 == 0 ? step : -step;
            double length = sqrt(rg_vector_dot(other, other));
            for (int i = 0; i < 3; i++) {
                other[i] /= length;
            }
            double here = sign * eigenvalue(c, other, which);
            if (here > best) {
                best = here;
                memcpy(n, other, sizeof other);
                higher = true;
            }
        }
        step = higher ? step : step / 2;
    }
    return sign * best;
}

/* From the best of points that cover the half sphere evenly. */
static double extreme(const double c[RG_STIFFNESS], int which, double sign) {
    enum { POINTS = 300 };                    /* some 8 degrees apart */
    const double golden = 2.3999632297286533; /* angle between one and the next */
    double from[3] = {1, 0, 0}, best = sign * eigenvalue(c, from, which);
    for (int i = 0; i < POINTS; i++) {
        double z = (i + 0.5) / POINTS, r = sqrt(1 - z * z);
        double n[3] = {r * cos(i * golden), r * sin(i * golden), z};
        double here = sign * eigenvalue(c, n, which);
        if (here > best) {
            best = here;
            memcpy(from, n, sizeof n);
        }
    }
    return climb(c, from, which, sign, 0.1);
}

rg_stiffness_range rg_stiffness_over_directions(const double c[RG_STIFFNESS]) {
    return (rg_stiffness_range){.stiffest = extreme(c, LARGEST, 1),
                                .softest = extreme(c, LARGEST, -1),
                                .slowest = extreme(c, SMALLEST, -1)};
}
