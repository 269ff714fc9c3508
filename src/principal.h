/* Principal values of a symmetric tensor. */
#ifndef RG_PRINCIPAL_H
#define RG_PRINCIPAL_H

/* Eigenvalues of (xx yy zz yz xz xy), largest first: closed form by the angle of the third invariant. */
void rg_principal(const double s[6], double value[3]);

#endif
