/* Reference elastic solid of any symmetry: its stress in tensors, with all 81 components of the stiffness. */
#include <math.h>
#include "reference/material.h"
#include "reference/reference.h"

/* S = C:E, the constants as components of the tensor. */
static void stress(const rg_material *m, double E[3][3], double S[3][3]) {
    static const int voigt[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};
    double c[6][6];
    for (int i = 0, at = 0; i < 6; i++)
        for (int j = i; j < 6; j++, at++)
            c[i][j] = c[j][i] = m->of.anisotropic.stiffness[at];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            S[i][j] = 0;
            for (int k = 0; k < 9; k++)
                S[i][j] += c[voigt[i][j]][voigt[k / 3][k % 3]] * E[k / 3][k % 3];
        }
}

/* Largest absolute row sum beside the diagonal, with it. */
static double largest_row(double t[3][3]) {
    double largest = -INFINITY;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        largest = fmax(largest, t[i][i] + fabs(t[i][j]) + fabs(t[i][k]));
    }
    return largest;
}

void rg_reference_point_anisotropic(const rg_material *m, bool advance, double F[3][3], double history[],
                                    double P[3][3], rg_reference_point *out) {
    (void)advance, (void)history;
    double E[3][3], S[3][3], inverse[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            E[i][j] = (F[0][i] * F[0][j] + F[1][i] * F[1][j] + F[2][i] * F[2][j] - (i == j)) / 2;
    stress(m, E, S);
    out->energy =
        (rg_reference_dot(E[0], S[0]) + rg_reference_dot(E[1], S[1]) + rg_reference_dot(E[2], S[2])) / 2;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            P[i][j] = F[i][0] * S[0][j] + F[i][1] * S[1][j] + F[i][2] * S[2][j];
    out->stiffening = rg_reference_invert(F, inverse) > 0
                          ? 1 + 2 * largest_row(E) + fmax(0, largest_row(S)) / m->of.anisotropic.softest
                          : NAN;
}
