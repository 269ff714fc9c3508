/* Bulk kernel of the linear elastic solid of small strains: W = lambda/2 (tr e)^2 + mu e:e of e = sym H, H =
 * F - I, P = dW/dF = lambda tr e I + 2 mu e (Hooke's law; L. D. Landau & E. M. Lifshitz, Theory of
 * Elasticity, 4).
 *
 * Not objective: a rotation Q of the body makes strains sym Q - I, of the second order in its angle, and
 * stresses with them. */
#include "element/material_point.h"

#define RG_MATERIAL linear_elastic
#define RG_HISTORY  0

RG_INLINE void linear_stress(const rg_material *m, rg_vec H[3][3], rg_vec P[3][3]) {
    rg_vec mu = rg_splat(m->mu), pressure = rg_splat(m->lambda) * (H[0][0] + H[1][1] + H[2][2]);
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3;
        P[i][i] = rg_splat(2.0 * m->mu) * H[i][i] + pressure;
        P[i][j] = P[j][i] = mu * (H[i][j] + H[j][i]);
    }
}

/* e:e = sum of H_ii^2 and half the squares of H_ij + H_ji. */
RG_INLINE rg_vec linear_energy(const rg_material *m, rg_vec H[3][3]) {
    rg_vec trace = H[0][0] + H[1][1] + H[2][2], square = {0}, shear = {0};
    for (int i = 0; i < 3; i++) {
        rg_vec slide = H[i][(i + 1) % 3] + H[(i + 1) % 3][i];
        square += H[i][i] * H[i][i];
        shear += slide * slide;
    }
    return rg_splat(0.5 * m->lambda) * (trace * trace) + rg_splat(m->mu) * (square + 0.5 * shear);
}

RG_INLINE void material_step(const rg_bulk_args *args, rg_vec H[3][3], rg_vec history[], rg_vec P[3][3],
                             rg_point *out) {
    (void)history;
    rg_vec F[3][3];
    rg_plus_identity(H, F);
    linear_stress(&args->material, H, P);
    out->stiffening = rg_where_valid(rg_determinant(F), rg_splat(1.0));
}

RG_INLINE void material_state(const rg_material *m, rg_vec H[3][3], rg_vec history[], bool stress,
                              rg_point_state *out) {
    (void)history;
    out->energy = linear_energy(m, H);
    if (stress) {
        rg_vec F[3][3];
        rg_plus_identity(H, F);
        out->J = rg_determinant(F);
        linear_stress(m, H, out->P);
    }
}

#include "element/bulk.h"
