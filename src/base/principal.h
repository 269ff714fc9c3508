/* Principal values of a symmetric tensor. */
#ifndef RG_PRINCIPAL_H
#define RG_PRINCIPAL_H

/* Eigenvalues of (xx yy zz yz xz xy), largest first: closed form by the angle of the third invariant. */
void rg_principal(const double s[6], double value[3]);

/* Eigenvalues, smallest first, and their unit vectors axis[value][component], the largest component of each
 * positive: Jacobi rotations, right to rounding also where eigenvalues lie close together. */
void rg_principal_axes(const double s[6], double value[3], double axis[3][3]);

#endif
