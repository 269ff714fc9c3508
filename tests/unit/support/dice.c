#include "support/dice.h"

#include <math.h>

#include "base/hash.h"
#include "reference/hencky.h"

double dice_unit(dice *d) {
    return rg_hash_uniform(rg_hash(d->seed, d->count++));
}

double dice_sign(dice *d) {
    return 2 * dice_unit(d) - 1;
}

double dice_power(dice *d, double from, double to) {
    return pow(10, from + (to - from) * dice_unit(d));
}

/* From a random unit quaternion. */
void dice_rotation(dice *d, double R[3][3]) {
    double q[4], norm;
    do {
        norm = 0;
        for (int k = 0; k < 4; k++) {
            q[k] = dice_sign(d);
            norm += q[k] * q[k];
        }
    } while (norm > 1 || norm < 0.01);
    double s = 2 / norm, w = q[0];
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        double x = q[i + 1], y = q[j + 1], z = q[k + 1];
        R[i][i] = 1 - s * (y * y + z * z);
        R[i][j] = s * (x * y - w * z);
        R[i][k] = s * (x * z + w * y);
    }
}

void product(double a[3][3], double b[3][3], double out[3][3]) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
}

void symmetric_exp(double s[3][3], double out[3][3]) {
    rg_reference_function(s, exp, out);
}

void dice_deviator(dice *d, double size, double s[3][3]) {
    double trace = 0, square = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j <= i; j++)
            s[i][j] = s[j][i] = dice_sign(d);
    trace = s[0][0] + s[1][1] + s[2][2];
    for (int i = 0; i < 3; i++) {
        s[i][i] -= trace / 3;
        for (int j = 0; j < 3; j++)
            square += s[i][j] * s[i][j];
    }
    for (int i = 0; i < 9; i++)
        s[i / 3][i % 3] *= size / sqrt(2.0 / 3 * square);
}
