/* Stiffness of an elastic solid of any symmetry: the 21 constants C of rg_anisotropic, in Voigt's order 11 22
 * 33 23 13 12. */
#ifndef RG_STIFFNESS_H
#define RG_STIFFNESS_H

#include <stdbool.h>

#include "materials.h"

/* Place of the constant (i, j) of the Voigt matrix among the 21. */
int rg_stiffness_place(int i, int j);

/* Of a solid with three planes of symmetry: Young's moduli E1 E2 E3; Poisson's ratios 23 13 12, nu_ij the
 * contraction along j by tension along i, nu_ij/E_i = nu_ji/E_j; shear moduli 23 13 12. False where its
 * compliance is not positive definite, whose smallest eigenvalue (1/Pa) *least is. */
bool rg_stiffness_orthotropic(const double young[3], const double poisson[3], const double shear[3],
                              double c[RG_STIFFNESS], double *least);

/* Smallest eigenvalue of C as a map of symmetric tensors (Pa); > 0: every strain takes energy. */
double rg_stiffness_least(const double c[RG_STIFFNESS]);

/* From the axes of the solid, axis[i] its i-th as a unit vector, into those of the mesh. */
void rg_stiffness_turn(double c[RG_STIFFNESS], const double axis[3][3]);

/* Axes that Euler angles after Bunge (degrees) turn x, y, z into: by the first about z, by the second about
 * the new x, by the third about the new z. */
void rg_stiffness_axes(const double angles[3], double axis[3][3]);

/* Bulk and shear modulus that are the means over all orientations (W. Voigt, Lehrbuch der Kristallphysik,
 * 1910) (Pa). */
void rg_stiffness_mean(const double c[RG_STIFFNESS], double *bulk, double *shear);

/* Acoustic tensor n.C.n along a unit vector n as xx yy zz yz xz xy (Pa): rho c^2 of its plane waves are its
 * eigenvalues (E. B. Christoffel 1877). */
void rg_stiffness_acoustic(const double c[RG_STIFFNESS], const double n[3], double tensor[6]);

/* Over all directions: the most and the least of the largest eigenvalue, and the least of all (Pa), to 1e-6.
 */
typedef struct {
    double stiffest, softest, slowest;
} rg_stiffness_range;
rg_stiffness_range rg_stiffness_over_directions(const double c[RG_STIFFNESS]);

#endif
