/* The elastic solid of any symmetry: a million states of every set of kernels against the reference; and the
 * reference against the isotropic solid, rotations of space and of the solid, and its acoustic tensor. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reference/material.h"
#include "support/acoustic.h"
#include "support/dice.h"
#include "support/kernel_input.h"
#include "support/sanitized.h"

#define LAMBDA 77.8e9
#define MU     107.4e9

static const double isotropic[6][6] = {{LAMBDA + 2 * MU, LAMBDA, LAMBDA, 0, 0, 0},
                                       {LAMBDA, LAMBDA + 2 * MU, LAMBDA, 0, 0, 0},
                                       {LAMBDA, LAMBDA, LAMBDA + 2 * MU, 0, 0, 0},
                                       {0, 0, 0, MU, 0, 0},
                                       {0, 0, 0, 0, MU, 0},
                                       {0, 0, 0, 0, 0, MU}};

/* As far from the isotropic solid as `size` shear moduli; no constant is like another. */
static rg_material make_solid(dice *d, double size) {
    rg_material m = {.model = RG_MATERIAL_ANISOTROPIC, .lambda = LAMBDA, .mu = MU, .density = 3690};
    for (int i = 0, at = 0; i < 6; i++)
        for (int j = i; j < 6; j++, at++)
            m.of.anisotropic.stiffness[at] = isotropic[i][j] + size * MU * dice_sign(d);
    m.of.anisotropic.softest = m.of.anisotropic.stiffest = LAMBDA + 2 * MU;
    return m;
}

static void assert_near(double got, double expected, double tolerance) {
    if (!(fabs(got - expected) <= tolerance))
        fail_msg("%.17g instead of %.17g", got, expected);
}

static void random_gradient(dice *d, double size, double F[3][3]) {
    for (int k = 0; k < 9; k++)
        F[k / 3][k % 3] = (k % 4 == 0) + size * dice_sign(d);
}

/* ---- Kernels ---- */

enum {
    STATES = RG_SANITIZED ? 100000 : 1000000,
    BLOCKS = 64,
    ELEMENTS = BLOCKS * RG_LANES,
    ROUNDS = STATES / (4 * ELEMENTS) + 1
};

typedef struct {
    double *force, *traction, *stiffening, *energy, *cauchy;
} result;

static result result_make(void) {
    return (result){input_alloc(BLOCKS * RG_NODE_BLOCK * sizeof(double)),
                    input_alloc(BLOCKS * RG_TRACTION_BLOCK * sizeof(double)),
                    input_alloc(ELEMENTS * sizeof(double)), input_alloc(ELEMENTS * sizeof(double)),
                    input_alloc(ELEMENTS * 24 * sizeof(double))};
}

static void result_free(result *r) {
    free(r->force);
    free(r->traction);
    free(r->stiffening);
    free(r->energy);
    free(r->cauchy);
}

static void compute(const rg_kernels *set, rg_bulk_args args, result *r) {
    args.force = r->force;
    args.traction = r->traction;
    args.stiffening = r->stiffening;
    set->bulk(&args, 0, BLOCKS);
    set->bulk_state(&(rg_bulk_state_args){.bulk = &args, .energy = r->energy, .cauchy = r->cauchy}, 0,
                    BLOCKS);
}

/* Largest difference over the largest value. */
static double apart(const double *one, const double *other, size_t count) {
    double most = 0, largest = 0;
    for (size_t k = 0; k < count; k++) {
        double difference = fabs(one[k] - other[k]);
        most = isnan(difference) ? INFINITY : fmax(most, difference);
        largest = fmax(largest, fabs(other[k]));
    }
    return most / largest;
}

/* The reference takes strains of some `size` from F, where they have lost the digits of I. */
static void compare(const char *name, const result *r, const result *ref, double size) {
    double worst = fmax(apart(r->force, ref->force, BLOCKS * RG_NODE_BLOCK),
                        apart(r->traction, ref->traction, BLOCKS * RG_TRACTION_BLOCK));
    worst = fmax(worst, apart(r->stiffening, ref->stiffening, ELEMENTS));
    worst = fmax(worst, apart(r->energy, ref->energy, ELEMENTS));
    worst = fmax(worst, apart(r->cauchy, ref->cauchy, ELEMENTS * 24));
    if (!(worst * size <= 3.5e-16))
        fail_msg("%s: apart by %g of the largest, at strains of %g", name, worst, size);
}

/* Elements of random shape in random states, each of the four points in one of its own; in every other round
 * each element has axes of its own. */
static void test_a_million_states(void **state) {
    const rg_kernels *sets[INPUT_SETS];
    int n = input_sets(sets, INPUT_SETS);
    double *u = input_alloc(BLOCKS * RG_NODE_BLOCK * sizeof(double));
    double *geom = input_alloc(BLOCKS * RG_GEOM_BLOCK * sizeof(double));
    double *turn = input_alloc(BLOCKS * RG_TURN_BLOCK * sizeof(double));
    result ref = result_make(), out = result_make();
    dice d = {1, 0};
    (void)state;
    for (int round = 0; round < ROUNDS; round++) {
        double size = dice_power(&d, -4, -1.3);
        for (size_t e = 0; e < ELEMENTS; e++) {
            double Q[3][3];
            dice_rotation(&d, Q);
            for (int k = 0; k < RG_TURN; k++)
                turn[rg_turn_index(e, k)] = Q[k / 3][k % 3];
            for (int k = 0; k < 9; k++)
                geom[rg_geom_index(e, RG_GEOM_GRAD + k)] = (k % 4 == 0) + 0.3 * dice_sign(&d);
            geom[rg_geom_index(e, RG_GEOM_VOLUME)] = 0.1 + dice_unit(&d);
            for (int k = 0; k < RG_NODES * 3; k++)
                u[rg_node_index(e, k / 3, k % 3)] = size * dice_sign(&d);
        }
        rg_bulk_args args = {
            .material = make_solid(&d, 0.3), .gradient = RG_GRADIENT_OWN, .u = u, .geom = geom};
        args.turn = round % 2 == 0 ? NULL : turn;
        compute(&rg_kernels_reference, args, &ref);
        for (int k = 0; k < n; k++) {
            compute(sets[k], args, &out);
            compare(sets[k]->name, &out, &ref, size);
        }
    }
    result_free(&ref);
    result_free(&out);
    free(u);
    free(geom);
    free(turn);
}

/* ---- The reference ---- */

static rg_reference_point point(const rg_material *m, double F[3][3], double P[3][3]) {
    rg_reference_point out = {0};
    rg_reference_point_anisotropic(m, false, F, NULL, P, &out);
    return out;
}

/* With the constants of an isotropic solid it is St. Venant-Kirchhoff's, stiffening included. */
static void test_isotropic(void **state) {
    dice d = {2, 0};
    const rg_material m = make_solid(&d, 0);
    (void)state;
    for (int n = 0; n < 1000; n++) {
        double F[3][3], P[3][3], expected[3][3];
        rg_reference_point other = {0};
        random_gradient(&d, n % 2 == 0 ? 0.3 : 1e-3, F);
        rg_reference_point one = point(&m, F, P);
        rg_reference_point_st_venant_kirchhoff(&m, false, F, NULL, expected, &other);
        for (int k = 0; k < 9; k++)
            assert_near(P[k / 3][k % 3], expected[k / 3][k % 3], 8e-15 * MU);
        assert_near(one.energy, other.energy, 4e-15 * MU);
        assert_near(one.stiffening, other.stiffening, 4e-15);
    }
}

/* P(QF) = Q P(F). */
static void test_objective(void **state) {
    dice d = {3, 0};
    (void)state;
    for (int n = 0; n < 1000; n++) {
        const rg_material m = make_solid(&d, 0.3);
        double F[3][3], Q[3][3], QF[3][3], P[3][3], turned[3][3], expected[3][3];
        random_gradient(&d, 0.3, F);
        dice_rotation(&d, Q);
        product(Q, F, QF);
        rg_reference_point one = point(&m, F, P), other = point(&m, QF, turned);
        product(Q, P, expected);
        for (int k = 0; k < 9; k++)
            assert_near(turned[k / 3][k % 3], expected[k / 3][k % 3], 2e-14 * MU);
        assert_near(other.energy, one.energy, 1e-14 * MU);
    }
}

/* Tension along each axis and each shear, by hand: a row of the stiffness at a time. */
static void test_by_hand(void **state) {
    static const int row[6] = {0, 1, 2, 1, 0, 0}, column[6] = {0, 1, 2, 2, 2, 1};
    dice d = {4, 0};
    const rg_material m = make_solid(&d, 0.3);
    const double small = 1e-7;
    (void)state;
    for (int a = 0; a < 6; a++) {
        double F[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, P[3][3];
        F[row[a]][column[a]] += small;
        point(&m, F, P);
        for (int b = 0; b < 6; b++) {
            int low = a < b ? a : b, high = a < b ? b : a;
            double c = m.of.anisotropic.stiffness[6 * low - low * (low - 1) / 2 + high - low];
            assert_near(P[row[b]][column[b]] / small, c, 1e-6 * MU);
        }
    }
}

/* The stiffening bounds the acoustic tensor over that at rest along the same direction, and never exceeds
 * what is met by more than three times. */
static void test_stiffening(void **state) {
    dice d = {5, 0};
    double loosest = 0;
    (void)state;
    for (int n = 0; n < 200; n++) {
        enum { DIRECTIONS = 40 };
        rg_material m = make_solid(&d, 0.3);
        double F[3][3], P[3][3], rest[DIRECTIONS], N[DIRECTIONS][3], most = 0;
        m.of.anisotropic.softest = INFINITY;
        for (int k = 0; k < DIRECTIONS; k++) {
            double R[3][3], I[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
            dice_rotation(&d, R);
            memcpy(N[k], R[0], sizeof R[0]);
            rest[k] = acoustic(&m, rg_reference_point_anisotropic, I, N[k]);
            m.of.anisotropic.softest = fmin(m.of.anisotropic.softest, rest[k]);
        }
        random_gradient(&d, n % 3 == 0 ? 0.02 : 0.3, F);
        double bound = point(&m, F, P).stiffening;
        for (int k = 0; k < DIRECTIONS; k++)
            most = fmax(most, acoustic(&m, rg_reference_point_anisotropic, F, N[k]) / rest[k]);
        if (!(most <= bound * (1 + 1e-8)))
            fail_msg("stiffening %g, bound %g", most, bound);
        loosest = fmax(loosest, bound / most);
    }
    assert_true(loosest < 3);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_million_states), cmocka_unit_test(test_isotropic),
        cmocka_unit_test(test_objective),        cmocka_unit_test(test_by_hand),
        cmocka_unit_test(test_stiffening),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
