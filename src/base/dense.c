#include "base/dense.h"

#include <math.h>

/* Gauss and Jordan; such a matrix needs no pivoting. */
void rg_dense_invert(int n, double *m) {
    for (int k = 0; k < n; k++) {
        double pivot = 1 / m[k * n + k];
        m[k * n + k] = 1;
        for (int j = 0; j < n; j++) {
            m[k * n + j] *= pivot;
        }
        for (int i = 0; i < n; i++) {
            double factor = m[i * n + k];
            for (int j = 0; i != k && j < n; j++) {
                m[i * n + j] = (j == k ? 0 : m[i * n + j]) - factor * m[k * n + j];
            }
        }
    }
}

void rg_dense_turn(int count, int stride, double *x, double *y, const double turn[2]) {
    for (int k = 0; k < count * stride; k += stride) {
        double a = x[k], b = y[k];
        x[k] = turn[0] * a - turn[1] * b;
        y[k] = turn[1] * a + turn[0] * b;
    }
}

/* Golub & Van Loan, Matrix Computations, 8.5. */
void rg_dense_rotate(int n, double *m, int p, int q, double turn[2]) {
    double theta = 0.5 * (m[n * q + q] - m[n * p + p]) / m[n * p + q];
    double t = (theta < 0 ? -1 : 1) / (fabs(theta) + sqrt(1 + theta * theta));
    turn[0] = 1 / sqrt(1 + t * t);
    turn[1] = t * turn[0];
    rg_dense_turn(n, n, m + p, m + q, turn);
    rg_dense_turn(n, 1, m + n * p, m + n * q, turn);
    m[n * p + q] = m[n * q + p] = 0;
}
