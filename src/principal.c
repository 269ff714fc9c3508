#include "principal.h"

#include <math.h>

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
