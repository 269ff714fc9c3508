#include "base/principal.h"

#include <math.h>

#include "base/dense.h"

void rg_principal(const double s[6], double value[3]) {
    const double third = 2.0943951023931954923; /* 2 pi/3 */
    double mean = (s[0] + s[1] + s[2]) / 3, x = s[0] - mean, y = s[1] - mean, z = s[2] - mean;
    double shear = s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
    double radius = sqrt((x * x + y * y + z * z + 2 * shear) / 6);
    double det =
        x * (y * z - s[3] * s[3]) - s[5] * (s[5] * z - s[3] * s[4]) + s[4] * (s[5] * s[3] - y * s[4]);
    double cosine = radius > 0 ? det / (2 * radius * radius * radius) : 1;
    double angle = acos(fmax(-1, fmin(1, cosine))) / 3;
    value[0] = mean + 2 * radius * cos(angle);
    value[2] = mean + 2 * radius * cos(angle + third);
    value[1] = 3 * mean - value[0] - value[2];
}

static void positive(double axis[3]) {
    double largest = 0;
    for (int c = 0; c < 3; c++) {
        largest = fabs(axis[c]) > fabs(largest) ? axis[c] : largest;
    }
    for (int c = 0; c < 3 && largest < 0; c++) {
        axis[c] = -axis[c];
    }
}

void rg_principal_axes(const double s[6], double value[3], double axis[3][3]) {
    enum { SWEEPS = 12 }; /* it converges quadratically: five are plenty */
    double a[3][3] = {{s[0], s[5], s[4]}, {s[5], s[1], s[3]}, {s[4], s[3], s[2]}};
    double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int k = 0; k < 3 * SWEEPS; k++) {
        int p = k % 3 == 2 ? 1 : 0, q = k % 3 == 0 ? 1 : 2;
        if (a[p][q] != 0) {
            double turn[2];
            rg_dense_rotate(3, a[0], p, q, turn);
            rg_dense_turn(3, 1, v[p], v[q], turn);
        }
    }
    int order[3] = {0, 1, 2};
    for (int i = 0; i < 3; i++) {
        int k = i == 1 ? 1 : 0; /* exchanges (0 1), (1 2), (0 1) sort three */
        if (a[order[k]][order[k]] > a[order[k + 1]][order[k + 1]]) {
            int swap = order[k];
            order[k] = order[k + 1];
            order[k + 1] = swap;
        }
    }
    for (int k = 0; k < 3; k++) {
        value[k] = a[order[k]][order[k]];
        for (int c = 0; c < 3; c++) {
            axis[k][c] = v[order[k]][c];
        }
        positive(axis[k]);
    }
}
