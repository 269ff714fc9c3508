/* Bulk kernel of the elastic solid of any symmetry: W = 1/2 E:C:E of the Green strain E = 1/2 (F^T F - I),
 * S = dW/dE = C:E, P = F S, with the 21 constants C in the axes of the mesh, or in those of each element (J.
 * F. Nye, Physical Properties of Crystals, 1985, chapter 8): what bulk_st_venant_kirchhoff.c is with two.
 *
 * Objective, but for moderate strains, as that one. */
#include "element/material_point.h"

#define RG_MATERIAL anisotropic
#define RG_HISTORY  0
#define RG_TURNED

/* Strain and stress in Voigt's order, shear strains twice those of the tensor. */
typedef struct {
    rg_vec e[6], s[6];
} voigt;

/* In H = F - I: 2 E = H + H^T + H^T H keeps all digits of a small strain. */
RG_INLINE void strain_at(rg_vec H[3][3], voigt *v) {
    static const int row[6] = {0, 1, 2, 1, 0, 0}, column[6] = {0, 1, 2, 2, 2, 1};
    for (int k = 0; k < 6; k++) {
        int i = row[k], j = column[k];
        rg_vec square = H[0][i] * H[0][j] + H[1][i] * H[1][j] + H[2][i] * H[2][j];
        v->e[k] = (H[i][j] + H[j][i]) + square;
    }
    for (int k = 0; k < 3; k++) {
        v->e[k] *= 0.5;
    }
}

RG_INLINE void stress_at(const rg_material *m, voigt *v) {
    static const int place[6][6] = {{0, 1, 2, 3, 4, 5},     {1, 6, 7, 8, 9, 10},    {2, 7, 11, 12, 13, 14},
                                    {3, 8, 12, 15, 16, 17}, {4, 9, 13, 16, 18, 19}, {5, 10, 14, 17, 19, 20}};
    const double *c = m->of.anisotropic.stiffness;
    for (int i = 0; i < 6; i++) {
        v->s[i] = rg_splat(c[place[i][0]]) * v->e[0];
        for (int j = 1; j < 6; j++) {
            v->s[i] += rg_splat(c[place[i][j]]) * v->e[j];
        }
    }
}

/* P = S + H S. */
RG_INLINE void piola(rg_vec H[3][3], voigt *v, rg_vec P[3][3]) {
    static const int place[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};
    for (int j = 0; j < 3; j++) {
        rg_vec s[3] = {v->s[place[0][j]], v->s[place[1][j]], v->s[place[2][j]]};
        for (int i = 0; i < 3; i++) {
            P[i][j] = s[i] + rg_dot(H[i], s);
        }
    }
}

/* Largest over the rows of a symmetric tensor of the diagonal and the magnitudes beside it, those times
 * `off`: no eigenvalue exceeds it. */
RG_INLINE rg_vec largest_row(rg_vec t[6], double off) {
    rg_vec yz = rg_abs(t[3]), xz = rg_abs(t[4]), xy = rg_abs(t[5]), by = rg_splat(off);
    return rg_max(t[0] + by * (xy + xz), rg_max(t[1] + by * (xy + yz), t[2] + by * (xz + yz)));
}

/* Bound on the acoustic tensor (N.S N) I + F (N.C.N) F^T over its value N.C.N at rest: the eigenvalues of
 * F F^T are those of I + 2 E, and tension counts most where the solid is softest. */
RG_INLINE rg_vec stiffening_at(const rg_material *m, voigt *v) {
    rg_vec twice = 2.0 * largest_row(v->e, 0.5), tension = rg_max(largest_row(v->s, 1.0), rg_splat(0.0));
    return 1.0 + twice + tension * rg_splat(1 / m->of.anisotropic.softest);
}

RG_INLINE void material_step(const rg_bulk_args *args, rg_vec H[3][3], rg_vec history[], rg_vec P[3][3],
                             rg_point *out) {
    (void)history;
    rg_vec F[3][3];
    voigt v;
    rg_plus_identity(H, F);
    strain_at(H, &v);
    stress_at(&args->material, &v);
    piola(H, &v, P);
    out->stiffening = rg_where_valid(rg_determinant(F), stiffening_at(&args->material, &v));
}

RG_INLINE void material_state(const rg_material *m, rg_vec H[3][3], rg_vec history[], bool stress,
                              rg_point_state *out) {
    (void)history;
    voigt v;
    strain_at(H, &v);
    stress_at(m, &v);
    rg_vec twice = v.e[0] * v.s[0];
    for (int k = 1; k < 6; k++) {
        twice += v.e[k] * v.s[k];
    }
    out->energy = 0.5 * twice;
    if (stress) {
        rg_vec F[3][3];
        rg_plus_identity(H, F);
        out->J = rg_determinant(F);
        piola(H, &v, out->P);
    }
}

#include "element/bulk.h"
