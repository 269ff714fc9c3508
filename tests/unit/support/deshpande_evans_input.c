#include "support/deshpande_evans_input.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reference/deshpande_evans.h"

point_state state_make(dice *d, double growth, double ep, double plastic, double ekk, double eb) {
    static const int row[6] = {0, 1, 2, 1, 0, 0}, column[6] = {0, 1, 2, 2, 2, 1};
    double e[3][3], V[3][3], flow[3][3], Fp[3][3], Q[3][3], VQ[3][3], metric[3][3];
    point_state s = {.history = {growth, ep}};
    dice_deviator(d, eb, e);
    for (int i = 0; i < 3; i++)
        e[i][i] += ekk / 3;
    symmetric_exp(e, V);
    dice_rotation(d, Q);
    dice_deviator(d, plastic, flow);
    symmetric_exp(flow, Fp);
    product(V, Q, VQ);
    product(VQ, Fp, s.F);
    for (int i = 0; i < 9; i++)
        flow[i / 3][i % 3] *= -2;
    symmetric_exp(flow, metric);
    for (int k = 0; k < 6; k++)
        s.history[RG_DE_FLOW + k] = metric[row[k]][column[k]] - (row[k] == column[k]);
    return s;
}

/* Ratio ekk/eb at the transition from I to II, or from II to III. */
static double transition(const rg_deshpande_evans *p, double growth, bool second) {
    rg_reference_de_cracks c = rg_reference_de_coefficients(p, rg_de_damage(p, growth));
    double G = p->shear, k = 3 * (1 - 2 * p->poisson) / (2 * G * (1 + p->poisson));
    double kappa2 = rg_de_prepare(p, 1).crack_compliance;
    return second ? c.A * c.B / (c.C * c.C - c.A * c.A) * (k + kappa2 * c.C * c.C) /
                        (1 / (3 * G) + kappa2 * c.E * c.E)
                  : -c.B / c.A * 3 * G * k;
}

point_state state_random(dice *d, const rg_deshpande_evans *p) {
    double most = rg_de_prepare(p, 1).growth_max, kind = dice_unit(d);
    double growth = kind < 0.2 ? 0 : kind < 0.22 ? most : most * pow(dice_unit(d), 3);
    double ep = dice_unit(d) < 0.3 ? 0 : dice_power(d, -7, -0.5), plastic = ep > 0 ? 0.2 * dice_unit(d) : 0;
    double eb = dice_power(d, -6, -0.7), ekk = fmin(fmax(eb * 10 * dice_sign(d) * dice_unit(d), -0.4), 0.4);
    kind = dice_unit(d);
    if (kind < 0.2)
        ekk = eb * transition(p, growth, kind < 0.1) * (1 + dice_sign(d) * dice_power(d, -12, -6));
    return state_make(d, growth, ep, plastic, ekk, eb);
}

/* ---- Arrays ---- */

double *point_alloc(size_t count) {
    size_t bytes = (count * sizeof(double) + 63) / 64 * 64;
    double *p = aligned_alloc(64, bytes);
    if (p == NULL)
        abort();
    return memset(p, 0, bytes);
}

void arrays_make(point_arrays *a, size_t n, const rg_deshpande_evans *p, double dt) {
    a->n = n;
    a->F = point_alloc(9 * n);
    a->history = point_alloc(RG_DE_HISTORY * n);
    a->P = point_alloc(9 * n);
    a->result = point_alloc(POINT_RESULT * n);
    a->constants = rg_de_prepare(p, dt);
    a->args = (points){&a->constants, a->F, a->history, a->P, a->result};
    const point_state virgin = {.F = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (size_t i = 0; i < n; i++)
        arrays_put(a, i, &virgin);
}

void arrays_put(point_arrays *a, size_t i, const point_state *s) {
    for (size_t k = 0; k < 9; k++)
        a->F[point_index(i, k, 9)] = s->F[k / 3][k % 3];
    for (size_t k = 0; k < RG_DE_HISTORY; k++)
        a->history[point_index(i, k, RG_DE_HISTORY)] = s->history[k];
}

void arrays_get_P(const point_arrays *a, size_t i, double P[3][3]) {
    for (size_t k = 0; k < 9; k++)
        P[k / 3][k % 3] = a->P[point_index(i, k, 9)];
}

double arrays_history(const point_arrays *a, size_t i, size_t k) {
    return a->history[point_index(i, k, RG_DE_HISTORY)];
}

double arrays_result(const point_arrays *a, size_t i, size_t k) {
    return a->result[point_index(i, k, POINT_RESULT)];
}

void arrays_free(point_arrays *a) {
    free(a->F);
    free(a->history);
    free(a->P);
    free(a->result);
}
