/* Reference of Ogden's solid, from the eigenvalues of F F^T. */
#include <math.h>
#include "reference/hencky.h"
#include "reference/material.h"
#include "reference/reference.h"

void rg_reference_point_ogden(const rg_material *m, bool advance, double F[3][3], double history[],
                              double P[3][3], rg_reference_point *out) {
    (void)advance, (void)history;
    const double *given = m->of.parameter, K = given[RG_PARAMETER_BULK];
    double b[3][3], square[3], axis[3][3], inverse[3][3], tau[3], l[3], energy = 0, most = 0, sum = 0;
    double J = rg_reference_invert(F, inverse), mean = K / 2 * (J * J - 1);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            b[i][j] = rg_reference_dot(F[i], F[j]);
    rg_reference_eigen(b, square, axis);
    for (int i = 0; i < 3; i++) {
        l[i] = sqrt(square[i]) / cbrt(J);
        tau[i] = mean;
    }
    for (int p = 0; p < RG_OGDEN_TERMS; p++) {
        double mu = given[RG_PARAMETER_MU_1 + p], alpha = given[RG_PARAMETER_ALPHA_1 + p], power[3],
               largest = 0;
        for (int i = 0; i < 3; i++) {
            power[i] = pow(l[i], alpha);
            largest = fmax(largest, power[i]);
        }
        for (int i = 0; i < 3; i++)
            tau[i] += mu * (power[i] - (power[0] + power[1] + power[2]) / 3);
        energy += mu != 0 ? mu / alpha * (power[0] + power[1] + power[2] - 3) : 0;
        most += mu * alpha * largest;
    }
    double spin[3][3] = {{0}};
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                spin[i][j] += tau[k] * axis[i][k] * axis[j][k];
        sum += (tau[k] - mean) * (tau[k] - mean);
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            P[i][j] = rg_reference_dot(spin[i], inverse[j]);
    double x = log(fmax(l[0], fmax(l[1], l[2])) / fmin(l[0], fmin(l[1], l[2])));
    double bound =
        K * J * J + 2.0 / 3 * most * (1 + fmin(x * x / 3, x)) + fmax(-mean, 0) + 1.25 * sqrt(1.5 * sum);
    out->energy = energy + K / 4 * (J * J - 1 - 2 * log(J));
    out->stiffening =
        J > 0 ? bound / fmin(square[0], fmin(square[1], square[2])) / (m->lambda + 2 * m->mu) : NAN;
}
