#include "base/dense.h"

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
