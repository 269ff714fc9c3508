/* Scalar twin of element/material_point.h: one function per material. */
#ifndef RG_REFERENCE_MATERIAL_H
#define RG_REFERENCE_MATERIAL_H

#include "kernels.h"

typedef struct {
    double stiffening, energy, released[RG_RELEASED], internal[RG_INTERNAL];
} rg_reference_point;

/* P (Pa) and `out` at F. If `advance`, history goes on by the step for which `m` was prepared. */
typedef void rg_reference_point_law(const rg_material *m, bool advance, double F[3][3], double history[],
                                    double P[3][3], rg_reference_point *out);

#define RG_REFERENCE_POINT(name, NAME, word, meaning, history, inside)                                       \
    rg_reference_point_law rg_reference_point_##name;
RG_MATERIALS(RG_REFERENCE_POINT)

/* Inverse of a 3x3 matrix; returns the determinant. */
double rg_reference_invert(double f[3][3], double inv[3][3]);

#endif
