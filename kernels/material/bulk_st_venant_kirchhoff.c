/* Bulk kernel of the St. Venant-Kirchhoff solid: W = lambda/2 (tr E)^2 + mu E:E of the Green strain
 * E = 1/2 (F^T F - I), S = dW/dE = lambda tr E I + 2 mu E, P = F S (J. Bonet & R. D. Wood, Nonlinear
 * Continuum Mechanics for Finite Element Analysis, 2008, 6.3).
 *
 * Objective, but for moderate strains: pressed to 1/sqrt(3) of its length it gets weaker, and nothing keeps
 * it from turning inside out. */
#include "element/material_point.h"

#define RG_MATERIAL st_venant_kirchhoff
#define RG_HISTORY  0

typedef struct {
    rg_vec E[3][3], trace; /* Green strain; tr E */
} green_strain;

/* In H = F - I: 2 E = H + H^T + H^T H keeps all digits of a small strain. */
RG_INLINE void strain_at(rg_vec H[3][3], green_strain *s) {
    for (int i = 0; i < 3; i++) {
        for (int j = i; j < 3; j++) {
            rg_vec square = H[0][i] * H[0][j] + H[1][i] * H[1][j] + H[2][i] * H[2][j];
            s->E[i][j] = s->E[j][i] = 0.5 * ((H[i][j] + H[j][i]) + square);
        }
    }
    s->trace = s->E[0][0] + s->E[1][1] + s->E[2][2];
}

/* P = S + H S. */
RG_INLINE void piola(const rg_material *m, rg_vec H[3][3], green_strain *s, rg_vec P[3][3]) {
    rg_vec S[3][3], pressure = rg_splat(m->lambda) * s->trace;
    for (int i = 0; i < 3; i++) {
        for (int j = i; j < 3; j++) {
            S[i][j] = S[j][i] = rg_splat(2.0 * m->mu) * s->E[i][j];
        }
        S[i][i] += pressure;
    }
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            P[i][j] = S[i][j] + rg_dot(H[i], S[j]);
        }
    }
}

RG_INLINE rg_vec energy_at(const rg_material *m, green_strain *s) {
    rg_vec square = {0};
    for (int i = 0; i < 3; i++) {
        square += rg_dot(s->E[i], s->E[i]);
    }
    return rg_splat(0.5 * m->lambda) * (s->trace * s->trace) + rg_splat(m->mu) * square;
}

/* Bound on the acoustic tensor (N.S N) I + mu F F^T + (lambda + mu) (F N) (x) (F N) over lambda + 2 mu: the
 * eigenvalues of F F^T are those of C = I + 2 E, at most its largest absolute row sum c, and those of S at
 * most lambda tr E + mu (c - 1). */
RG_INLINE rg_vec stiffening_at(const rg_material *m, green_strain *s) {
    rg_vec row[3];
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        row[i] = s->E[i][i] + (rg_abs(s->E[i][j]) + rg_abs(s->E[i][k]));
    }
    rg_vec twice = 2.0 * rg_max(row[0], rg_max(row[1], row[2])); /* c - 1 */
    rg_vec tension = rg_splat(m->lambda) * s->trace + rg_splat(m->mu) * twice;
    return 1.0 + twice + rg_max(tension, rg_splat(0.0)) * rg_splat(1 / (m->lambda + 2.0 * m->mu));
}

RG_INLINE void material_step(const rg_bulk_args *args, rg_vec H[3][3], rg_vec history[], rg_vec P[3][3],
                             rg_point *out) {
    (void)history;
    rg_vec F[3][3];
    green_strain s;
    rg_plus_identity(H, F);
    strain_at(H, &s);
    piola(&args->material, H, &s, P);
    out->stiffening = rg_where_valid(rg_determinant(F), stiffening_at(&args->material, &s));
}

RG_INLINE void material_state(const rg_material *m, rg_vec H[3][3], rg_vec history[], bool stress,
                              rg_point_state *out) {
    (void)history;
    green_strain s;
    strain_at(H, &s);
    out->energy = energy_at(m, &s);
    if (stress) {
        rg_vec F[3][3];
        rg_plus_identity(H, F);
        out->J = rg_determinant(F);
        piola(m, H, &s, out->P);
    }
}

#include "element/bulk.h"
