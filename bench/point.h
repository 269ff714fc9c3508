/* What point.c gives to Python. */
#ifndef RG_BENCH_POINT_H
#define RG_BENCH_POINT_H

#include "kernels.h"

/* A row of what is found: Cauchy stress along the three axes (Pa), stretches along them, what is stored and
 * what was set free so far, by flow and by damage (J/m^3), and what is inside (RG_INTERNAL_ of kernels.h). */
enum {
    POINT_ENERGY = 6,
    POINT_SPENT = 7,
    POINT_INSIDE = POINT_SPENT + RG_RELEASED,
    POINT_VALUES = POINT_INSIDE + RG_INTERNAL
};

/* How it may move along the first two axes: as told; alike, and so that the pressure is there that is told;
 * each by itself, likewise. */
typedef enum { POINT_HELD, POINT_ALIKE, POINT_EACH } point_free;

/* A step: the stretches at its end, of which the first two count where they are held; the pressure across,
 * where they are free (Pa); how long it takes (s). */
typedef struct {
    double stretch[3], pressure, duration;
} point_step;

extern const char *const point_key[]; /* of the parameters of materials.h in a case, NULL at the end */
extern const int point_parameters, point_stiffness, point_values;

/* Number of a model by its word in a case; -1: there is none. */
int point_model(const char *word);

/* P (Pa) of a virgin point at F. `elastic`: lambda, mu (Pa), density (kg/m^3). `constants`: all parameters of
 * materials.h; of an anisotropic solid its stiffness (Pa); of the ceramic none, which is the table's alumina.
 */
void point_stress(int model, const double elastic[3], const double constants[], const double F[9],
                  double P[9]);

/* A path from the virgin solid, along `axes` (orthonormal rows). Returns for how many steps a stretch was
 * found. */
int point_walk(int model, const double elastic[3], const double constants[], const double axes[9], int free,
               int steps, const point_step way[], double found[][POINT_VALUES]);

#endif
