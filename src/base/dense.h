/* Small dense matrices, row by row. */
#ifndef RG_DENSE_H
#define RG_DENSE_H

/* Inverts a symmetric positive definite matrix [n][n] in place. */
void rg_dense_invert(int n, double *m);

/* Turns a symmetric matrix [n][n] in the plane (p, q), p < q, so that m[p][q], which is not 0, becomes 0: a
 * step of Jacobi's method. turn[0], turn[1]: cosine and sine, by which vectors turn along. */
void rg_dense_rotate(int n, double *m, int p, int q, double turn[2]);

/* x <- cosine x - sine y, y <- sine x + cosine y, of so many values that lie `stride` apart. */
void rg_dense_turn(int count, int stride, double *x, double *y, const double turn[2]);

#endif
