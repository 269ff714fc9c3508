/* Ogden's solid (R. W. Ogden, Proc. R. Soc. Lond. A 326 (1972) 565), compressible, its volume apart:
 *
 *     W = sum mu_p/alpha_p (l1^alpha_p + l2^alpha_p + l3^alpha_p - 3) + K/4 (J^2 - 1 - 2 log J),
 *
 * l_i = J^-1/3 lambda_i of the principal stretches lambda_i: mu = sum mu_p alpha_p/2 at rest, each product >
 * 0. With mu_1 = 2 c10, alpha_1 = 2, mu_2 = -2 c01, alpha_2 = -2 it is that of Mooney and Rivlin.
 *
 * Stretches are the eigenvalues of the Green strain E, found by Jacobi's rotations, which know no case of
 * equal ones and keep the digits of small strains. As l1 l2 l3 = 1, the third logarithm and the third power
 * follow from the others. With e_i = log l_i the principal values of the Kirchhoff stress are
 *
 *     tau_i = sum mu_p (l_i^alpha_p - mean of the three) + K/2 (J^2 - 1). */
#ifndef RG_OGDEN_H
#define RG_OGDEN_H

#include "material/hencky.h"
#include "material/neo_hookean.h"

/* To rounding: of the largest entry three leave at most 3e-5 beside the diagonal, four 3e-20 (of ten million
 * tensors, alike eigenvalues among them). */
enum { RG_OGDEN_SWEEPS = 4 };

typedef struct {
    double mu[RG_OGDEN_TERMS], alpha[RG_OGDEN_TERMS], bulk;
} rg_ogden;

RG_INLINE rg_ogden rg_ogden_of(const rg_material *m) {
    const double *p = m->of.parameter;
    return (rg_ogden){{p[RG_PARAMETER_MU_1], p[RG_PARAMETER_MU_2], p[RG_PARAMETER_MU_3]},
                      {p[RG_PARAMETER_ALPHA_1], p[RG_PARAMETER_ALPHA_2], p[RG_PARAMETER_ALPHA_3]},
                      p[RG_PARAMETER_BULK]};
}

typedef struct {
    rg_volume_change v;
    rg_vec axis[3][3];      /* of E */
    rg_vec square[3], e[3]; /* 1 + 2 times its principal values, log l_i */
} rg_ogden_strain;

/* Rotation of the axes p and q that takes a[p][q] to zero; r the third one. first: axes are still those of a.
 */
RG_INLINE void rg_ogden_rotate(rg_vec a[3][3], rg_vec axis[3][3], int p, int q, int r, bool first) {
    rg_vec apart = a[q][q] - a[p][p], twice = 2.0 * a[p][q];
    rg_vec root = rg_sqrt(apart * apart + twice * twice),
           size = rg_max(rg_abs(apart) + root, rg_splat(1e-300));
    rg_vec t = rg_select(apart < 0.0, -twice, twice) / size, c = 1.0 / rg_sqrt(1.0 + t * t), s = t * c;
    rg_vec shift = t * a[p][q], pr = a[p][r], qr = a[q][r];
    a[p][p] -= shift;
    a[q][q] += shift;
    a[p][q] = a[q][p] = rg_splat(0.0);
    a[p][r] = a[r][p] = c * pr - s * qr;
    a[q][r] = a[r][q] = s * pr + c * qr;
    for (int k = 0; k < 3; k++) {
        if (first) {
            axis[p][k] = k == p ? c : k == q ? -s : rg_splat(0.0);
            axis[q][k] = k == p ? s : k == q ? c : rg_splat(0.0);
            axis[r][k] = rg_splat(k == r ? 1.0 : 0.0);
            continue;
        }
        rg_vec x = axis[p][k], y = axis[q][k];
        axis[p][k] = c * x - s * y;
        axis[q][k] = s * x + c * y;
    }
}

RG_INLINE void rg_ogden_strain_at(rg_vec H[3][3], rg_ogden_strain *s) {
    rg_vec E[3][3];
    rg_neo_hookean_volume(H, &s->v);
    for (int i = 0; i < 3; i++) {
        for (int j = i; j < 3; j++) {
            rg_vec square = H[0][i] * H[0][j] + H[1][i] * H[1][j] + H[2][i] * H[2][j];
            E[i][j] = E[j][i] = 0.5 * ((H[i][j] + H[j][i]) + square);
        }
    }
    for (int k = 0; k < RG_OGDEN_SWEEPS; k++) {
        rg_ogden_rotate(E, s->axis, 0, 1, 2, k == 0);
        rg_ogden_rotate(E, s->axis, 0, 2, 1, false);
        rg_ogden_rotate(E, s->axis, 1, 2, 0, false);
    }
    for (int i = 0; i < 3; i++) {
        s->square[i] = 1.0 + 2.0 * E[i][i];
    }
    for (int i = 0; i < 2; i++) {
        s->e[i] = 0.5 * rg_log1p(2.0 * E[i][i]) - (1.0 / 3) * s->v.log_J;
    }
    s->e[2] = -(s->e[0] + s->e[1]);
}

/* What the terms make of the stretches: principal values of the deviator of tau, their energy, and the sum of
 * mu_p alpha_p times the largest l_i^alpha_p. */
RG_INLINE void rg_ogden_terms(const rg_ogden *c, rg_ogden_strain *s, rg_vec tau[3], rg_vec *energy,
                              rg_vec *most) {
    *energy = *most = rg_splat(0.0);
    tau[0] = tau[1] = tau[2] = rg_splat(0.0);
    for (int p = 0; p < RG_OGDEN_TERMS; p++) {
        if (c->mu[p] == 0) {
            continue;
        }
        rg_vec power[3], more[3], mu = rg_splat(c->mu[p]);
        for (int i = 0; i < 2; i++) {
            power[i] = rg_exp_and_less_1(rg_splat(c->alpha[p]) * s->e[i], &more[i]);
        }
        rg_vec both = more[0] + more[1] + more[0] * more[1];
        power[2] = 1.0 / (1.0 + both);
        more[2] = -both * power[2];
        rg_vec sum = more[0] + more[1] + more[2];
        for (int i = 0; i < 3; i++) {
            tau[i] += mu * (more[i] - (1.0 / 3) * sum);
        }
        *energy += rg_splat(c->mu[p] / c->alpha[p]) * sum;
        *most += rg_splat(c->mu[p] * c->alpha[p]) * rg_max(power[0], rg_max(power[1], power[2]));
    }
}

/* P = F S, S = sum tau_i/lambda_i^2 N_i N_i. */
RG_INLINE void rg_ogden_piola(rg_vec H[3][3], rg_ogden_strain *s, rg_vec tau[3], rg_vec pressure,
                              rg_vec P[3][3]) {
    rg_vec S[3][3] = {{{0}}};
    for (int k = 0; k < 3; k++) {
        rg_vec part = (tau[k] + pressure) / s->square[k];
        for (int i = 0; i < 3; i++) {
            for (int j = i; j < 3; j++) {
                S[i][j] += part * (s->axis[k][i] * s->axis[k][j]);
                S[j][i] = S[i][j];
            }
        }
    }
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            P[i][j] = S[i][j] + rg_dot(H[i], S[j]);
        }
    }
}

/* K/2 (J^2 - 1). */
RG_INLINE rg_vec rg_ogden_mean(const rg_ogden *c, rg_ogden_strain *s) {
    return rg_splat(0.5 * c->bulk) * s->v.j * (2.0 + s->v.j);
}

RG_INLINE rg_vec rg_ogden_energy(const rg_ogden *c, rg_ogden_strain *s, rg_vec terms) {
    return terms + rg_splat(0.25 * c->bulk) * (s->v.j * s->v.j + 2.0 * s->v.log_excess);
}

/* Bound on the acoustic tensor over lambda + 2 mu = K + 4/3 mu, its largest value at rest. Along N, with n =
 * F^-T N, m any unit vector and d the symmetric part of m n it is
 *
 *     sum T_ij d_ii d_jj + sum (i, j apart) g_ij x coth x d_ij^2 - 2 tau:d^2 + n.tau n,
 *
 * T = d tau/d e, g_ij = (tau_i - tau_j)/x, x = e_i - e_j, tau's mean t. Of the terms T' and g are at most M =
 * sum mu_p alpha_p max l^alpha_p, d':d' is at most 2/3 n.n, x coth x 1 + min(x^2/3, |x|); the volume adds K
 * J^2, and what is left is at most -t and 5/4 of von Mises' stress (material/hencky.h). n.n is at most 1 over
 * the least lambda^2. */
RG_INLINE rg_vec rg_ogden_stiffening(const rg_material *m, const rg_ogden *c, rg_ogden_strain *s,
                                     rg_vec tau[3], rg_vec mean, rg_vec most) {
    rg_vec least = rg_min(s->square[0], rg_min(s->square[1], s->square[2]));
    rg_vec x = rg_max(s->e[0], rg_max(s->e[1], s->e[2])) - rg_min(s->e[0], rg_min(s->e[1], s->e[2]));
    rg_vec mises = rg_sqrt(1.5 * (tau[0] * tau[0] + tau[1] * tau[1] + tau[2] * tau[2]));
    rg_vec spread = 1.0 + rg_min((1.0 / 3) * x * x, x), J = s->v.J;
    rg_vec sum =
        rg_splat(c->bulk) * (J * J) + (2.0 / 3) * most * spread + rg_max(-mean, rg_splat(0.0)) + 1.25 * mises;
    return rg_where_valid(J, sum / least * rg_splat(1 / (m->lambda + 2.0 * m->mu))) + 0.0 * least;
}

#endif
