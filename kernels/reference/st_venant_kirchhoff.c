/* Reference St. Venant-Kirchhoff solid. */
#include <math.h>
#include "reference/material.h"

/* The bound of material/bulk_st_venant_kirchhoff.c, from C and S. */
static double stiffening(const rg_material *m, double E[3][3], double trace) {
    double norm = 0, modulus = m->lambda + 2 * m->mu;
    for (int i = 0; i < 3; i++) {
        double sum = 0;
        for (int j = 0; j < 3; j++)
            sum += fabs((i == j) + 2 * E[i][j]);
        norm = fmax(norm, sum);
    }
    return (norm * modulus + fmax(0, m->lambda * trace + m->mu * (norm - 1))) / modulus;
}

void rg_reference_point_st_venant_kirchhoff(const rg_material *m, bool advance, double F[3][3],
                                            double history[], double P[3][3], rg_reference_point *out) {
    (void)advance, (void)history;
    double E[3][3], S[3][3], inverse[3][3], trace = 0, square = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            E[i][j] = (F[0][i] * F[0][j] + F[1][i] * F[1][j] + F[2][i] * F[2][j] - (i == j)) / 2;
    for (int i = 0; i < 3; i++)
        trace += E[i][i];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            square += E[i][j] * E[i][j];
            S[i][j] = (i == j) * m->lambda * trace + 2 * m->mu * E[i][j];
        }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            P[i][j] = F[i][0] * S[0][j] + F[i][1] * S[1][j] + F[i][2] * S[2][j];
    out->energy = m->lambda / 2 * trace * trace + m->mu * square;
    out->stiffening = rg_reference_invert(F, inverse) > 0 ? stiffening(m, E, trace) : NAN;
}
