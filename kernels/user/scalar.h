/* A material of one point at a time, in doubles, for those who have it so:
 *
 *     #define RG_HISTORY      1
 *     #define RG_SCALAR_POINT my_point
 *     #include "user/scalar.h"
 *     static void my_point(double F[3][3], double history[], const double parameter[], double dt,
 *                          rg_scalar_point *out) { ... }
 *     ... RG_USER_MATERIAL(...)
 *
 * With dt > 0 it takes the step of that length (s) which ends at F: history is that before and, when it
 * returns, that after. With dt = 0 it tells the stress and the energy of F for the history as it is. What it
 * does not set of `out` is 0. It is some times slower than vectors: each lane is computed on its own. */
#ifndef RG_USER_SCALAR_H
#define RG_USER_SCALAR_H

#include "user/material.h"

typedef struct {
    double P[3][3];               /* first Piola-Kirchhoff stress (Pa) */
    double energy;                /* stored, per reference volume (J/m^3) */
    double stiffening;            /* bound on the acoustic tensor over lambda + 2 mu at rest */
    double released[RG_RELEASED]; /* in the step, by flow and by damage (J/m^3) */
    double internal[RG_INTERNAL]; /* RG_INTERNAL_DAMAGE ... (kernels.h), for output */
} rg_scalar_point;

static void RG_SCALAR_POINT(double F[3][3], double history[], const double parameter[], double dt,
                            rg_scalar_point *out);

#if RG_HISTORY > 0
#define RG_SCALAR_HISTORY RG_HISTORY
#else
#define RG_SCALAR_HISTORY 1
#endif

RG_INLINE void rg_scalar_lane(const rg_material *m, double dt, int lane, rg_vec H[3][3], rg_vec history[],
                              double own[], rg_scalar_point *out) {
    double F[3][3];
    *out = (rg_scalar_point){.energy = 0};
    for (int k = 0; k < 9; k++) {
        F[k / 3][k % 3] = (double)H[k / 3][k % 3][lane] + (k % 4 == 0);
    }
    for (int k = 0; k < RG_HISTORY; k++) {
        own[k] = history[k][lane];
    }
    RG_SCALAR_POINT(F, own, m->of.user.parameter, dt, out);
}

RG_INLINE void material_step(const rg_bulk_args *args, rg_vec H[3][3], rg_vec history[], rg_vec P[3][3],
                             rg_point *out) {
    rg_vec F[3][3];
    rg_plus_identity(H, F);
    for (int l = 0; l < RG_VLEN; l++) {
        rg_scalar_point s;
        double own[RG_SCALAR_HISTORY];
        rg_scalar_lane(&args->material, args->material.dt, l, H, history, own, &s);
        for (int k = 0; k < 9; k++) {
            P[k / 3][k % 3][l] = (rg_real)s.P[k / 3][k % 3];
        }
        for (int k = 0; k < RG_HISTORY; k++) {
            history[k][l] = (rg_real)own[k];
        }
        for (int k = 0; k < RG_RELEASED; k++) {
            out->released[k][l] = (rg_real)s.released[k];
        }
        out->stiffening[l] = (rg_real)s.stiffening;
    }
    out->stiffening = rg_where_valid(rg_determinant(F), out->stiffening);
}

RG_INLINE void material_state(const rg_material *m, rg_vec H[3][3], rg_vec history[], bool stress,
                              rg_point_state *out) {
    rg_vec F[3][3];
    rg_plus_identity(H, F);
    out->J = rg_determinant(F);
    for (int l = 0; l < RG_VLEN; l++) {
        rg_scalar_point s;
        double own[RG_SCALAR_HISTORY];
        rg_scalar_lane(m, 0, l, H, history, own, &s);
        out->energy[l] = (rg_real)s.energy;
        for (int k = 0; k < RG_INTERNAL; k++) {
            out->internal[k][l] = (rg_real)s.internal[k];
        }
        for (int k = 0; stress && k < 9; k++) {
            out->P[k / 3][k % 3][l] = (rg_real)s.P[k / 3][k % 3];
        }
    }
}

#endif
