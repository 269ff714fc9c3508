/* Reference neo-Hookean solid. */
#include <math.h>
#include "reference/material.h"
#include "reference/reference.h"

double rg_reference_invert(double f[3][3], double inv[3][3]) {
    double cofactor[3][3];
    for (int r = 0; r < 3; r++)
        rg_reference_cross(f[(r + 1) % 3], f[(r + 2) % 3], cofactor[r]);
    double det = rg_reference_dot(f[0], cofactor[0]);
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            inv[c][r] = cofactor[r][c] / det;
    return det;
}

/* Bound of the acoustic tensor relative to its value at F = I; NaN unless det F > 0. */
static double stiffening(const rg_material *m, double det, double inv[3][3]) {
    double largest = 0;
    if (!(det > 0))
        return NAN;
    for (int r = 0; r < 3; r++) {
        double sum = 0;
        for (int c = 0; c < 3; c++)
            sum += fabs(rg_reference_dot(inv[r], inv[c]));
        largest = fmax(largest, sum);
    }
    double slope = m->lambda + m->mu - m->lambda * log(det);
    return (m->mu + fmax(0, slope) * largest) / (m->lambda + 2 * m->mu);
}

void rg_reference_point_neo_hookean(const rg_material *m, bool advance, double F[3][3], double history[],
                                    double P[3][3], rg_reference_point *out) {
    (void)advance, (void)history;
    double inv[3][3], trace = 0, det = rg_reference_invert(F, inv), log_j = log(det);
    for (int r = 0; r < 3; r++) {
        trace += rg_reference_dot(F[r], F[r]);
        for (int c = 0; c < 3; c++)
            P[r][c] = m->mu * F[r][c] + (m->lambda * log_j - m->mu) * inv[c][r];
    }
    out->stiffening = stiffening(m, det, inv);
    out->energy = (m->lambda / 2 * log_j - m->mu) * log_j + m->mu / 2 * (trace - 3);
}
