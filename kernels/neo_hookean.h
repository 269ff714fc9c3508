/* neo-Hookean solid: W = (lambda/2 log J - mu) log J + mu/2 (tr F^T F - 3). */
#ifndef RG_NEO_HOOKEAN_H
#define RG_NEO_HOOKEAN_H

#include "kernels.h"
#include "vec.h"

/* Cofactor matrix J F^-T. */
RG_INLINE void rg_cofactor(rg_vec F[3][3], rg_vec cof[3][3]) {
    for (int i = 0; i < 3; i++) {
        rg_cross(F[(i + 1) % 3], F[(i + 2) % 3], cof[i]);
    }
}

/* First Piola-Kirchhoff stress P = mu F + (lambda log J - mu) F^-T (Pa). Also gives cof(F), J and log J. */
RG_INLINE void rg_neo_hookean_stress(const rg_material *m, rg_vec F[3][3], rg_vec P[3][3], rg_vec cof[3][3],
                                     rg_vec *J, rg_vec *log_J) {
    rg_cofactor(F, cof);
    *J = rg_dot(F[0], cof[0]);
    *log_J = rg_log(*J);
    rg_vec p = (m->lambda * *log_J - m->mu) / *J;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            P[i][j] = m->mu * F[i][j] + p * cof[i][j];
        }
    }
}

/* Energy density W (J/m^3). With F = I + H, tr F^T F - 3 is summed as 2 tr H + H:H. What remains is the
 * rounding of F itself, about eps mu: it shows where strains are below some 1e-6. */
RG_INLINE rg_vec rg_neo_hookean_energy(const rg_material *m, rg_vec F[3][3], rg_vec log_J) {
    rg_vec trace = {0}, square = {0};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            rg_vec h = F[i][j] - (i == j ? 1.0 : 0.0);
            square += h * h;
        }
        trace += F[i][i] - 1.0;
    }
    return 0.5 * m->lambda * log_J * log_J + m->mu * (trace - log_J) + 0.5 * m->mu * square;
}

/* Bound on how much the acoustic tensor, mu |N|^2 I + (lambda + mu - lambda log J) a (x) a with a = F^-T N,
 * exceeds its largest value lambda + 2 mu at F = I: |a|^2 is at most the largest absolute row sum of F^-1
 * F^-T. Not a number where F is not or J <= 0. */
RG_INLINE rg_vec rg_neo_hookean_stiffening(const rg_material *m, rg_vec cof[3][3], rg_vec J, rg_vec log_J) {
    rg_vec row[3] = {{0}, {0}, {0}};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            row[i] += rg_abs(cof[0][i] * cof[0][j] + cof[1][i] * cof[1][j] + cof[2][i] * cof[2][j]);
        }
    }
    rg_vec norm = rg_max(row[0], rg_max(row[1], row[2])) / (J * J);
    rg_vec modulus = rg_max(m->lambda + m->mu - m->lambda * log_J, rg_splat(0.0));
    return (m->mu + modulus * norm) / (m->lambda + 2.0 * m->mu) + 0.0 * (log_J + norm);
}

#endif
