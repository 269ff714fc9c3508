/* Reference Mooney-Rivlin solid, from F and its invariants. */
#include <math.h>
#include "reference/material.h"
#include "reference/reference.h"

/* Largest absolute row sum of a symmetric matrix. */
static double largest_row(double t[3][3]) {
    double largest = 0;
    for (int i = 0; i < 3; i++)
        largest = fmax(largest, fabs(t[i][0]) + fabs(t[i][1]) + fabs(t[i][2]));
    return largest;
}

/* The bound of material/mooney_rivlin.h. */
static double stiffening(const rg_material *m, double C[3][3], double inverse[3][3], double J, double I1) {
    const double *p = m->of.parameter;
    double metric[3][3], trace = 0;
    for (int i = 0; i < 3; i++) {
        trace += rg_reference_dot(inverse[i], inverse[i]);
        for (int j = 0; j < 3; j++)
            metric[i][j] = rg_reference_dot(inverse[i], inverse[j]);
    }
    double n = largest_row(metric), c = largest_row(C), product = fmax(1, c * n);
    double first = 2 + fmax(0, 10.0 / 9 * I1 * n - 8.0 / 3) + 2.0 / 3 * (product - 1) / sqrt(product);
    double second = 2 * n * n + n * fmax(0, 4.0 / 3 * n - 2.0 / 9 * trace) + n / 3 * (n - 1 / c);
    return (p[RG_PARAMETER_C10] * pow(J, -2.0 / 3) * first + p[RG_PARAMETER_C01] * pow(J, 2.0 / 3) * second +
            p[RG_PARAMETER_BULK] / 2 * (1 + J * J) * n) /
           (m->lambda + 2 * m->mu);
}

void rg_reference_point_mooney_rivlin(const rg_material *m, bool advance, double F[3][3], double history[],
                                      double P[3][3], rg_reference_point *out) {
    (void)advance, (void)history;
    const double c10 = m->of.parameter[RG_PARAMETER_C10], c01 = m->of.parameter[RG_PARAMETER_C01];
    const double bulk = m->of.parameter[RG_PARAMETER_BULK];
    double C[3][3], inverse[3][3], I1 = 0, square = 0, J = rg_reference_invert(F, inverse);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            C[i][j] = F[0][i] * F[0][j] + F[1][i] * F[1][j] + F[2][i] * F[2][j];
            square += C[i][j] * C[i][j];
        }
    I1 = C[0][0] + C[1][1] + C[2][2];
    double I2 = (I1 * I1 - square) / 2, a = pow(J, -2.0 / 3), b = pow(J, -4.0 / 3);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double FC = F[i][0] * C[0][j] + F[i][1] * C[1][j] + F[i][2] * C[2][j];
            P[i][j] = 2 * c10 * a * (F[i][j] - I1 / 3 * inverse[j][i]) +
                      2 * c01 * b * (I1 * F[i][j] - FC - 2.0 / 3 * I2 * inverse[j][i]) +
                      bulk / 2 * (J * J - 1) * inverse[j][i];
        }
    out->energy = c10 * (a * I1 - 3) + c01 * (b * I2 - 3) + bulk / 4 * (J * J - 1 - 2 * log(J));
    out->stiffening = J > 0 ? stiffening(m, C, inverse, J, I1) : NAN;
}
