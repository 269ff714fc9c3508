/* Mooney-Rivlin solid (R. S. Rivlin 1948), compressible, its volume apart:
 * W = c10 (J^-2/3 I1 - 3) + c01 (J^-4/3 I2 - 3) + K/4 (J^2 - 1 - 2 log J), I1 and I2 of C = F^T F. The last
 * part, of J. C. Simo & R. L. Taylor (1991), has no end in compression. At rest mu = 2 (c10 + c01), and K is
 * the bulk modulus. */
#ifndef RG_MOONEY_RIVLIN_H
#define RG_MOONEY_RIVLIN_H

#include "material/hencky.h"
#include "material/neo_hookean.h"

typedef struct {
    double c10, c01, bulk;
} rg_mooney_rivlin;

RG_INLINE rg_mooney_rivlin rg_mooney_rivlin_of(const rg_material *m) {
    const double *p = m->of.parameter;
    return (rg_mooney_rivlin){p[RG_PARAMETER_C10], p[RG_PARAMETER_C01], p[RG_PARAMETER_BULK]};
}

typedef struct {
    rg_volume_change v;
    rg_vec E[6], trace, square[6]; /* Green strain, of H so that no digits are lost; tr E; E E */
    rg_vec a, less_1;              /* J^-2/3, and less 1 */
} rg_mooney_strain;

RG_INLINE void rg_mooney_strain_at(rg_vec H[3][3], rg_mooney_strain *s) {
    rg_neo_hookean_volume(H, &s->v);
    for (int k = 0; k < 6; k++) {
        int i = rg_sym_row[k], j = rg_sym_column[k];
        rg_vec square = H[0][i] * H[0][j] + H[1][i] * H[1][j] + H[2][i] * H[2][j];
        s->E[k] = 0.5 * ((H[i][j] + H[j][i]) + square);
    }
    s->trace = s->E[0] + s->E[1] + s->E[2];
    rg_coaxial_product(s->E, s->E, s->square);
    s->a = rg_exp_and_less_1((-2.0 / 3) * s->v.log_J, &s->less_1);
}

/* P = F^-T C S, where C S is, with t = tr E, the deviator of
 * (4 c10 J^-2/3 + 4 c01 J^-4/3 (1 + 2 t)) E - 8 c01 J^-4/3 E^2, and K/2 (J^2 - 1) I. */
RG_INLINE void rg_mooney_stress(const rg_material *m, rg_mooney_strain *s, rg_vec P[3][3]) {
    rg_mooney_rivlin c = rg_mooney_rivlin_of(m);
    rg_vec second = rg_splat(4 * c.c01) * (s->a * s->a);
    rg_vec x = rg_splat(4 * c.c10) * s->a + second * (1.0 + 2.0 * s->trace), y = 2.0 * second, M[6];
    for (int k = 0; k < 6; k++) {
        M[k] = x * s->E[k] - y * s->square[k];
    }
    rg_vec j = s->v.j, mean = (1.0 / 3) * (M[0] + M[1] + M[2]);
    rg_vec rest = rg_splat(0.5 * c.bulk) * j * (2.0 + j) - mean, inverse = 1.0 / s->v.J;
    for (int k = 0; k < 6; k++) {
        M[k] = (k < 3 ? M[k] + rest : M[k]) * inverse;
    }
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            rg_vec column[3] = {M[rg_sym[0][k]], M[rg_sym[1][k]], M[rg_sym[2][k]]};
            P[i][k] = column[i] + rg_dot(s->v.D[i], column);
        }
    }
}

/* I1 = 3 + 2 t and I2 = 3 + 4 t + 2 (t^2 - E:E), so that, with L = log J, e = -2/3 L and d = exp e - 1 - e,
 *     J^-2/3 I1 - 3 = 2 (t - L) + 3 d + 2 t (J^-2/3 - 1),
 *     J^-4/3 I2 - 3 = 4 (t - L) + 6 d + 3 (J^-2/3 - 1)^2 + 4 t (J^-4/3 - 1) + 2 (t^2 - E:E) J^-4/3,
 * each term of second order, as is t - L = H:H/2 - (j - tr H) + (j - L). */
RG_INLINE rg_vec rg_mooney_energy(const rg_material *m, rg_vec H[3][3], rg_mooney_strain *s) {
    rg_mooney_rivlin c = rg_mooney_rivlin_of(m);
    rg_vec t = s->trace, less = s->less_1, squared = s->a * s->a, j = s->v.j;
    rg_vec product = rg_sym_dot(s->E, s->E),
           size = rg_dot(H[0], H[0]) + rg_dot(H[1], H[1]) + rg_dot(H[2], H[2]);
    rg_vec apart = 2.0 * (0.5 * size - s->v.second + s->v.log_excess), curve = less + (2.0 / 3) * s->v.log_J;
    rg_vec first = apart + 3.0 * curve + 2.0 * t * less;
    rg_vec second = 2.0 * apart + 6.0 * curve + less * (3.0 * less + 4.0 * t * (1.0 + s->a)) +
                    2.0 * (t * t - product) * squared;
    return rg_splat(c.c10) * first + rg_splat(c.c01) * second +
           rg_splat(0.25 * c.bulk) * (j * j + 2.0 * s->v.log_excess);
}

/* Bound on the acoustic tensor over lambda + 2 mu = K + 8/3 (c10 + c01), its largest value at rest. Along N,
 * with a = F^-T N and b = F N (a.b = 1) and m any unit vector, it is m.A.m = c10 J^-2/3 (2 - 8/3 m.a m.b +
 * 10/9 I1 (m.a)^2)
 *   + c01 J^2/3 (2 |F^-1 m|^2 a.a + 4/3 m.a m.Q a - 2/9 tr Q (m.a)^2), Q = F^-T F^-1,
 *   + K/2 (1 + J^2) (m.a)^2.
 * b and Q a are split along a and across: no eigenvalue of C exceeds c, none of Q exceeds n, both largest row
 * sums, so across b is at most (c n - 1)/(2 sqrt(c n)) over |a| (Kantorovich), and Q a (n - 1/c)/2 times it.
 */
RG_INLINE rg_vec rg_mooney_stiffening(const rg_material *m, rg_mooney_strain *s) {
    rg_mooney_rivlin c = rg_mooney_rivlin_of(m);
    rg_vec F[3][3], row[3] = {{0}, {0}, {0}}, zero = {0}, J = s->v.J, *E = s->E;
    rg_plus_identity(s->v.D, F); /* cofactors */
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            row[i] += rg_abs(F[0][i] * F[0][j] + F[1][i] * F[1][j] + F[2][i] * F[2][j]);
        }
    }
    rg_vec trace = F[0][0] * F[0][0] + F[0][1] * F[0][1] + F[0][2] * F[0][2];
    for (int i = 1; i < 3; i++) {
        trace += rg_dot(F[i], F[i]);
    }
    rg_vec over = 1.0 / (J * J), n = rg_max(row[0], rg_max(row[1], row[2])) * over;
    rg_vec yz = rg_abs(E[3]), xz = rg_abs(E[4]), xy = rg_abs(E[5]);
    rg_vec most = rg_max(E[0] + (xy + xz), rg_max(E[1] + (xy + yz), E[2] + (xz + yz)));
    rg_vec largest = 1.0 + 2.0 * most, product = rg_max(largest * n, rg_splat(1.0));
    rg_vec first = rg_max((10.0 / 9) * (3.0 + 2.0 * s->trace) * n - 8.0 / 3, zero) + 2.0 +
                   (2.0 / 3) * (product - 1.0) / rg_sqrt(product);
    rg_vec second = n * (2.0 * n + rg_max((4.0 / 3) * n - (2.0 / 9) * trace * over, zero) +
                         (1.0 / 3) * (n - 1.0 / largest));
    rg_vec sum = rg_splat(c.c10) * s->a * first + rg_splat(c.c01) / s->a * second +
                 rg_splat(0.5 * c.bulk) * (1.0 + J * J) * n;
    return sum * rg_splat(1 / (m->lambda + 2.0 * m->mu)) + 0.0 * (s->v.log_J + n);
}

#endif
