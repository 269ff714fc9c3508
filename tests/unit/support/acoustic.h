/* The acoustic tensor of an elastic solid, by its reference. */
#ifndef RG_SUPPORT_ACOUSTIC_H
#define RG_SUPPORT_ACOUSTIC_H

#include <math.h>

#include "reference/hencky.h"
#include "reference/material.h"

/* Largest eigenvalue of dP_iJ/dF_kL N_J N_L at F, by central differences. */
static inline double acoustic(const rg_material *m, rg_reference_point_law *law, double F[3][3],
                              const double N[3]) {
    const double step = 1e-5;
    double A[3][3], value[3], v[3][3];
    for (int k = 0; k < 3; k++) {
        double P[2][3][3];
        for (int side = 0; side < 2; side++) {
            double moved[3][3];
            rg_reference_point out = {0};
            for (int i = 0; i < 9; i++)
                moved[i / 3][i % 3] = F[i / 3][i % 3] + (i / 3 == k) * (side ? step : -step) * N[i % 3];
            law(m, false, moved, NULL, P[side], &out);
        }
        for (int i = 0; i < 3; i++) {
            A[i][k] = 0;
            for (int j = 0; j < 3; j++)
                A[i][k] += (P[1][i][j] - P[0][i][j]) / (2 * step) * N[j];
        }
    }
    for (int i = 0; i < 3; i++) /* symmetric but for rounding */
        for (int k = 0; k < i; k++)
            A[i][k] = A[k][i] = (A[i][k] + A[k][i]) / 2;
    rg_reference_eigen(A, value, v);
    return fmax(value[0], fmax(value[1], value[2]));
}

#endif
