/* neo-Hookean solid: W = (lambda/2 log J - mu) log J + mu/2 (tr F^T F - 3). */
#ifndef RG_NEO_HOOKEAN_H
#define RG_NEO_HOOKEAN_H

#include "element/material_point.h"

/* Strains are small against 1, and what is computed from F loses the digits that the 1 takes: all but the
 * last few in floats. So everything is written in H = F - I, in cof F - I = D and in J - 1 = j. */
typedef struct {
    rg_vec D[3][3];
    rg_vec j, J, log_J;
    rg_vec second;     /* j - tr H: second invariant and determinant of H */
    rg_vec log_excess; /* j - log J */
} rg_volume_change;

/* Off the diagonal a cofactor of F has no 1 to lose: each of its products has a small factor. */
RG_INLINE void rg_neo_hookean_volume(rg_vec H[3][3], rg_volume_change *v) {
    rg_vec F[3][3], minor[3];
    rg_plus_identity(H, F);
    for (int i = 0; i < 3; i++) {
        int a = (i + 1) % 3, b = (i + 2) % 3;
        rg_cross(F[a], F[b], v->D[i]);
        minor[i] = H[a][a] * H[b][b] - H[a][b] * H[b][a];
        v->D[i][i] = H[a][a] + H[b][b] + minor[i];
    }
    v->second = minor[0] + rg_dot(H[0], v->D[0]);
    v->j = H[0][0] + H[1][1] + H[2][2] + v->second;
    v->J = 1.0 + v->j;
    v->log_J = rg_log_beside_1(v->j, v->J, &v->log_excess);
}

/* First Piola-Kirchhoff stress P = mu F + (lambda log J - mu) F^-T = mu H + (r - mu) D + r I with
 * r = (lambda log J + mu j)/J (Pa). */
RG_INLINE void rg_neo_hookean_stress(const rg_material *m, rg_vec H[3][3], rg_volume_change *v,
                                     rg_vec P[3][3]) {
    rg_vec lambda = rg_splat(m->lambda), mu = rg_splat(m->mu);
    rg_vec r = (lambda * v->log_J + mu * v->j) / v->J, p = r - mu;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            P[i][j] = mu * H[i][j] + p * v->D[i][j];
        }
        P[i][i] += r;
    }
}

/* Energy density W (J/m^3): tr F^T F - 3 = 2 tr H + H:H, and tr H - log J = (j - log J) - (j - tr H), so that
 * every term is of second order. */
RG_INLINE rg_vec rg_neo_hookean_energy(const rg_material *m, rg_vec H[3][3], rg_volume_change *v) {
    rg_vec square = {0};
    for (int i = 0; i < 3; i++) {
        square += rg_dot(H[i], H[i]);
    }
    rg_vec lambda = rg_splat(m->lambda), mu = rg_splat(m->mu);
    return 0.5 * lambda * v->log_J * v->log_J + mu * (v->log_excess - v->second) + 0.5 * mu * square;
}

/* Bound on how much the acoustic tensor, mu |N|^2 I + (lambda + mu - lambda log J) a (x) a with a = F^-T N,
 * exceeds its largest value lambda + 2 mu at F = I: |a|^2 is at most the largest absolute row sum of F^-1
 * F^-T. Not a number where F is not or J <= 0. */
RG_INLINE rg_vec rg_neo_hookean_stiffening(const rg_material *m, rg_volume_change *v) {
    rg_vec cof[3][3], row[3] = {{0}, {0}, {0}};
    rg_plus_identity(v->D, cof);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            row[i] += rg_abs(cof[0][i] * cof[0][j] + cof[1][i] * cof[1][j] + cof[2][i] * cof[2][j]);
        }
    }
    rg_vec norm = rg_max(row[0], rg_max(row[1], row[2])) / (v->J * v->J);
    rg_vec modulus = rg_max(rg_splat(m->lambda + m->mu) - rg_splat(m->lambda) * v->log_J, rg_splat(0.0));
    return (rg_splat(m->mu) + modulus * norm) / rg_splat(m->lambda + 2.0 * m->mu) + 0.0 * (v->log_J + norm);
}

#endif
