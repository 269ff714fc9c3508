/* Small dense matrices. */
#ifndef RG_DENSE_H
#define RG_DENSE_H

/* Inverts a symmetric positive definite matrix [n][n] in place. */
void rg_dense_invert(int n, double *m);

#endif
