/* Reference linear elastic solid. */
#include <math.h>
#include "reference/material.h"

void rg_reference_point_linear_elastic(const rg_material *m, bool advance, double F[3][3], double history[],
                                       double P[3][3], rg_reference_point *out) {
    (void)advance, (void)history;
    double inverse[3][3], e[3][3], trace = F[0][0] + F[1][1] + F[2][2] - 3, square = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            e[i][j] = (F[i][j] + F[j][i]) / 2 - (i == j);
            square += e[i][j] * e[i][j];
            P[i][j] = (i == j) * m->lambda * trace + 2 * m->mu * e[i][j];
        }
    out->energy = m->lambda / 2 * trace * trace + m->mu * square;
    out->stiffening = rg_reference_invert(F, inverse) > 0 ? 1 : NAN;
}
