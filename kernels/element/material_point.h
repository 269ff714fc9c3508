/* The pointwise signature that all materials share. A source bulk_NAME.c defines, before it includes
 * element/bulk.h,
 *
 *     #define RG_MATERIAL NAME
 *     #define RG_HISTORY  values of history per point
 *
 *     RG_INLINE void material_step(const rg_bulk_args *args, rg_vec H[3][3], rg_vec history[],
 *                                  rg_vec P[3][3], rg_point *out);
 *         P (Pa) and `out` at the deformation gradient F = I + H. If args->advance, history goes on by the
 *         step for which args->material was prepared, and `out->released` tells what that set free.
 *
 *         Or, with #define RG_TOGETHER RG_GAUSS,
 *
 *     RG_INLINE void material_steps(const rg_bulk_args *args, rg_vec H[][3][3], rg_vec history[][RG_HISTORY],
 *                                   rg_vec P[][3][3], rg_point out[]);
 *         The same for RG_TOGETHER points at once.
 *
 *     RG_INLINE void material_state(const rg_material *m, rg_vec H[3][3], rg_vec history[], bool stress,
 *                                   rg_point_state *out);
 *         The state at F as it is; P only if `stress`.
 *
 *     With #define RG_TURNED the kernel turns H into the element's own axes (rg_bulk_args.turn), and P back.
 *
 * All lanes are on their own: what is computed in one must not depend on the others. */
#ifndef RG_MATERIAL_POINT_H
#define RG_MATERIAL_POINT_H

#include "kernels.h"
#include "vec.h"

typedef struct {
    rg_vec stiffening; /* bound on the acoustic tensor over its value at F = I; not a number where F is not or
                          J <= 0 */
    rg_vec released[RG_RELEASED]; /* in the step, per reference volume (J/m^3); only with history */
} rg_point;

typedef struct {
    rg_vec energy; /* stored, per reference volume (J/m^3) */
    rg_vec J, P[3][3];
    rg_vec internal[RG_INTERNAL]; /* only with history */
} rg_point_state;

/* What a material with a history begins with: none of the internal variables. */
RG_INLINE void rg_no_internal(rg_point_state *out) {
    for (int k = 0; k < RG_INTERNAL; k++) {
        out->internal[k] = (rg_vec){0};
    }
}

/* F = I + H. */
RG_INLINE void rg_plus_identity(rg_vec H[3][3], rg_vec F[3][3]) {
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            F[i][j] = i == j ? H[i][j] + 1.0 : H[i][j];
        }
    }
}

/* J = det F. */
RG_INLINE rg_vec rg_determinant(rg_vec F[3][3]) {
    rg_vec row[3];
    rg_cross(F[1], F[2], row);
    return rg_dot(F[0], row);
}

/* `bound` where J is a number > 0, else not a number: a stiffening for which J must be asked. */
RG_INLINE rg_vec rg_where_valid(rg_vec J, rg_vec bound) {
    return rg_select(J > 0.0, bound, rg_splat(__builtin_nan(""))) + 0.0 * J;
}

#endif
