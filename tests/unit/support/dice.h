/* Random numbers, rotations and tensors for tests of materials. */
#ifndef RG_TEST_DICE_H
#define RG_TEST_DICE_H

#include <stdint.h>

/* Reproducible random numbers; the state is the count of calls. */
typedef struct {
    uint64_t seed, count;
} dice;

double dice_unit(dice *d);                                /* in [0, 1) */
double dice_sign(dice *d);                                /* in [-1, 1) */
double dice_power(dice *d, double from, double to);       /* 10^uniform(from, to) */
void dice_rotation(dice *d, double R[3][3]);              /* uniform */
void dice_deviator(dice *d, double size, double s[3][3]); /* symmetric, trace 0, sqrt(2/3 s:s) = size */

void product(double a[3][3], double b[3][3], double out[3][3]);
void symmetric_exp(double s[3][3], double out[3][3]);

#endif
