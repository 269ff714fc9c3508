/* States of the Deshpande-Evans ceramic for tests */
#ifndef RG_DESHPANDE_EVANS_INPUT_H
#define RG_DESHPANDE_EVANS_INPUT_H

#include "support/deshpande_evans_points.h"
#include "support/dice.h"

/* A deformation gradient with its history. */
typedef struct {
    double F[3][3], history[RG_DE_HISTORY];
} point_state;

/* F and Cp^-1 with random rotations and random flow of size `plastic`, whose elastic strain has the
 * invariants ekk and eb. */
point_state state_make(dice *d, double growth, double ep, double plastic, double ekk, double eb);

/* A state from all over: undamaged to saturated, virgin to hardened, elastic strains 1e-6 to 0.2, a fifth of
 * them within 1e-6 of one of the two transitions. */
point_state state_random(dice *d, const rg_deshpande_evans *p);

/* Zeroed, 64-byte aligned doubles. */
double *point_alloc(size_t count);

/* Arrays for n points, n a multiple of RG_LANES, and the arguments that point to them. */
typedef struct {
    size_t n;
    double *F, *history, *P, *result;
    rg_de_constants constants;
    points args;
} point_arrays;

void arrays_make(point_arrays *a, size_t n, const rg_deshpande_evans *p, double dt);
void arrays_put(point_arrays *a, size_t i, const point_state *s);
void arrays_get_P(const point_arrays *a, size_t i, double P[3][3]);
double arrays_history(const point_arrays *a, size_t i, size_t k);
double arrays_result(const point_arrays *a, size_t i, size_t k);
void arrays_free(point_arrays *a);

#endif
