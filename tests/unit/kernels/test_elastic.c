/* Points of the linear elastic, the St. Venant-Kirchhoff, the Mooney-Rivlin and the Ogden solid against
 * theory: stress by hand, what a rotation does, the bound on the acoustic tensor. (test_reference.c
 * differentiates their energies, test_kernels.c holds the kernels against these points.) */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "reference/material.h"
#include "support/acoustic.h"
#include "support/dice.h"

#define LAMBDA 77.8e9
#define MU     107.4e9
#define LARGE  (LAMBDA + 2 * MU)

typedef struct {
    rg_reference_point_law *law;
    const char *name;
} solid;

static const solid solids[] = {{rg_reference_point_neo_hookean, "neo-Hookean"},
                               {rg_reference_point_linear_elastic, "linear"},
                               {rg_reference_point_st_venant_kirchhoff, "St. Venant-Kirchhoff"},
                               {rg_reference_point_mooney_rivlin, "Mooney-Rivlin"},
                               {rg_reference_point_ogden, "Ogden"}};
enum { NEO_HOOKEAN, LINEAR, KIRCHHOFF, MOONEY, OGDEN, SOLIDS };
#define C10 (0.35 * MU)
#define C01 (0.15 * MU)

static const rg_material elastic = {.lambda = LAMBDA,
                                    .mu = MU,
                                    .density = 3690,
                                    .of.parameter = {[RG_PARAMETER_BULK] = LAMBDA + 2 * MU / 3,
                                                     [RG_PARAMETER_C10] = C10,
                                                     [RG_PARAMETER_C01] = C01,
                                                     [RG_PARAMETER_MU_1] = 0.5 * MU,
                                                     [RG_PARAMETER_ALPHA_1] = 1.3,
                                                     [RG_PARAMETER_MU_2] = 0.1 * MU,
                                                     [RG_PARAMETER_ALPHA_2] = 5,
                                                     [RG_PARAMETER_MU_3] = -0.425 * MU,
                                                     [RG_PARAMETER_ALPHA_3] = -2}};

static rg_reference_point point(int which, double F[3][3], double P[3][3]) {
    rg_reference_point out = {0};
    solids[which].law(&elastic, false, F, NULL, P, &out);
    return out;
}

/* Tolerances are a few times what rounding leaves, with either compiler and on all instruction sets. */
static void assert_near(const solid *s, double got, double expected, double tolerance) {
    if (!(fabs(got - expected) <= tolerance))
        fail_msg("%s: %.17g instead of %.17g", s->name, got, expected);
}

/* F = diag(a, 1, 1): P of both by hand, with its energy; a shear by g as well. */
static void test_by_hand(void **state) {
    const double stretch[3] = {0.6, 1.1, 3}, g = 0.3;
    double P[3][3];
    (void)state;
    for (int k = 0; k < 3; k++) {
        double a = stretch[k], F[3][3] = {{a, 0, 0}, {0, 1, 0}, {0, 0, 1}}, e = (a * a - 1) / 2;
        rg_reference_point r = point(LINEAR, F, P);
        assert_near(&solids[LINEAR], P[0][0], LARGE * (a - 1), 4e-15 * MU);
        assert_near(&solids[LINEAR], P[1][1], LAMBDA * (a - 1), 4e-15 * MU);
        assert_near(&solids[LINEAR], r.energy, LARGE * (a - 1) * (a - 1) / 2, 4e-15 * MU);
        r = point(KIRCHHOFF, F, P);
        assert_near(&solids[KIRCHHOFF], P[0][0], a * LARGE * e, 4e-15 * MU);
        assert_near(&solids[KIRCHHOFF], P[1][1], LAMBDA * e, 4e-15 * MU);
        assert_near(&solids[KIRCHHOFF], r.energy, LARGE * e * e / 2, 4e-15 * MU);
    }
    double F[3][3] = {{1, g, 0}, {0, 1, 0}, {0, 0, 1}};
    point(LINEAR, F, P);
    assert_near(&solids[LINEAR], P[0][1], MU * g, 4e-15 * MU);
    assert_near(&solids[LINEAR], P[1][1], 0, 4e-15 * MU);
    point(KIRCHHOFF, F, P); /* E_12 = g/2, E_22 = g^2/2 */
    assert_near(&solids[KIRCHHOFF], P[1][1], LARGE * g * g / 2, 4e-15 * MU);
    assert_near(&solids[KIRCHHOFF], P[0][1], MU * g + g * LARGE * g * g / 2, 4e-15 * MU);
}

/* Mooney and Rivlin's solid in simple shear by g, where J = 1: Cauchy stresses 2 (c10 + c01) g, and along
 * less across 2 c10 g^2 and -2 c01 g^2 (Rivlin 1948); and swollen by J alone, under K/2 (J^2 - 1)/J. */
static void test_rubber_by_hand(void **state) {
    const solid *s = &solids[MOONEY];
    double P[3][3], sigma[3][3];
    (void)state;
    for (int n = 1; n < 10; n++) {
        const double g = 0.2 * n;
        double F[3][3] = {{1, g, 0}, {0, 1, 0}, {0, 0, 1}};
        rg_reference_point r = point(MOONEY, F, P);
        for (int k = 0; k < 9; k++)
            sigma[k / 3][k % 3] =
                P[k / 3][0] * F[k % 3][0] + P[k / 3][1] * F[k % 3][1] + P[k / 3][2] * F[k % 3][2];
        assert_near(s, sigma[0][1], MU * g, 1e-14 * MU);
        assert_near(s, sigma[1][0], MU * g, 1e-14 * MU);
        assert_near(s, sigma[0][0] - sigma[2][2], 2 * C10 * g * g, 1e-14 * MU);
        assert_near(s, sigma[1][1] - sigma[2][2], -2 * C01 * g * g, 1e-14 * MU);
        assert_near(s, r.energy, MU / 2 * g * g, 1e-14 * MU);
        const double K = LAMBDA + 2 * MU / 3, size = 0.4 + 0.2 * n, J = size * size * size;
        double swollen[3][3] = {{size, 0, 0}, {0, size, 0}, {0, 0, size}};
        r = point(MOONEY, swollen, P);
        for (int k = 0; k < 9; k++)
            assert_near(s, P[k / 3][k % 3], (k % 4 == 0) * K / 2 * (J * J - 1) / size, 1e-14 * K * J * J);
        assert_near(s, r.energy, K / 4 * (J * J - 1 - 2 * log(J)), 1e-14 * K * J * J);
    }
}

static rg_reference_point rubber(rg_reference_point_law *law, const double parameter[RG_PARAMETERS],
                                 double F[3][3], double P[3][3]) {
    rg_material m = {.lambda = LAMBDA, .mu = MU};
    rg_reference_point out = {0};
    memcpy(m.of.parameter, parameter, sizeof m.of.parameter);
    law(&m, false, F, NULL, P, &out);
    return out;
}

/* Ogden's solid where it keeps its volume, stretched by l along one axis: tau_1 - tau_2 = sum mu (l^alpha -
 * l^(-alpha/2)), two stretches alike. */
static void test_ogden_by_hand(void **state) {
    const double mu[3] = {0.5 * MU, 0.1 * MU, -0.425 * MU}, alpha[3] = {1.3, 5, -2};
    const solid *s = &solids[OGDEN];
    (void)state;
    for (int n = 0; n < 10; n++) {
        const double l = 0.5 + 0.25 * n, across = 1 / sqrt(l);
        double F[3][3] = {{across, 0, 0}, {0, l, 0}, {0, 0, across}}, P[3][3], expected = 0, energy = 0;
        rg_reference_point r = point(OGDEN, F, P);
        for (int p = 0; p < 3; p++) {
            expected += mu[p] * (pow(l, alpha[p]) - pow(l, -alpha[p] / 2));
            energy += mu[p] / alpha[p] * (pow(l, alpha[p]) + 2 * pow(l, -alpha[p] / 2) - 3);
        }
        assert_near(s, P[1][1] * l - P[0][0] * across, expected, 1e-13 * MU * (1 + fabs(expected) / MU));
        assert_near(s, P[2][2], P[0][0], 1e-13 * MU * (1 + fabs(P[0][0]) / MU));
        assert_near(s, r.energy, energy, 1e-13 * MU * (1 + energy / MU));
    }
}

static void random_gradient(dice *d, double size, double F[3][3]) {
    for (int k = 0; k < 9; k++)
        F[k / 3][k % 3] = (k % 4 == 0) + size * dice_sign(d);
}

/* Two terms of the powers 2 and -2 are Mooney and Rivlin's solid, and the first one alone is that without
 * c01. */
static void test_ogden_is_mooney_rivlin(void **state) {
    dice d = {8, 0};
    (void)state;
    for (int n = 0; n < 1000; n++) {
        const double c10 = 0.35 * MU, c01 = n % 2 == 0 ? 0.15 * MU : 0, K = LAMBDA + 2 * MU / 3;
        const double mooney[RG_PARAMETERS] = {
            [RG_PARAMETER_BULK] = K, [RG_PARAMETER_C10] = c10, [RG_PARAMETER_C01] = c01};
        const double ogden[RG_PARAMETERS] = {[RG_PARAMETER_BULK] = K,
                                             [RG_PARAMETER_MU_1] = 2 * c10,
                                             [RG_PARAMETER_ALPHA_1] = 2,
                                             [RG_PARAMETER_MU_2] = -2 * c01,
                                             [RG_PARAMETER_ALPHA_2] = c01 > 0 ? -2 : 0};
        double F[3][3], P[3][3], other[3][3];
        random_gradient(&d, 0.3, F);
        rg_reference_point one = rubber(rg_reference_point_mooney_rivlin, mooney, F, P);
        rg_reference_point two = rubber(rg_reference_point_ogden, ogden, F, other);
        for (int k = 0; k < 9; k++)
            assert_near(&solids[OGDEN], other[k / 3][k % 3], P[k / 3][k % 3], 3e-14 * MU);
        assert_near(&solids[OGDEN], two.energy, one.energy, 2e-14 * MU);
    }
}

/* P(QF) = Q P(F) where the solid is objective. The linear one is not: a turn by 0.01 rad makes strains of
 * half its square, and the stress that goes with them. */
static void test_rotation(void **state) {
    dice d = {5, 0};
    (void)state;
    for (int n = 0; n < 1000; n++) {
        double F[3][3], Q[3][3], QF[3][3], P[3][3], turned[3][3], expected[3][3];
        random_gradient(&d, 0.3, F);
        dice_rotation(&d, Q);
        product(Q, F, QF);
        for (int which = 0; which < SOLIDS; which++) {
            if (which == LINEAR)
                continue;
            rg_reference_point one = point(which, F, P), other = point(which, QF, turned);
            product(Q, P, expected);
            for (int k = 0; k < 9; k++)
                assert_near(&solids[which], turned[k / 3][k % 3], expected[k / 3][k % 3], 1.5e-14 * MU);
            assert_near(&solids[which], other.energy, one.energy, 8e-15 * MU);
        }
    }
    const double c = cos(0.01), s = sin(0.01);
    double Q[3][3] = {{c, -s, 0}, {s, c, 0}, {0, 0, 1}}, P[3][3];
    point(LINEAR, Q, P);
    assert_near(&solids[LINEAR], P[0][0], 2 * (LAMBDA + MU) * (c - 1), 4e-15 * MU);
    assert_near(&solids[LINEAR], P[2][2], 2 * LAMBDA * (c - 1), 4e-15 * MU);
    assert_true(P[0][0] < -1e-4 * MU);
}

/* At small strains all are the same to the first order: the difference falls as the square. */
static void test_small_strains(void **state) {
    const double size[2] = {1e-3, 1e-5};
    double most[2] = {0, 0};
    (void)state;
    for (int k = 0; k < 2; k++) {
        dice d = {6, 0};
        for (int n = 0; n < 100; n++) {
            double F[3][3], P[3][3], other[3][3];
            random_gradient(&d, size[k], F);
            point(NEO_HOOKEAN, F, P);
            for (int which = LINEAR; which < SOLIDS; which++) {
                point(which, F, other);
                for (int i = 0; i < 9; i++)
                    most[k] = fmax(most[k], fabs(other[i / 3][i % 3] - P[i / 3][i % 3]) / MU);
            }
        }
    }
    assert_true(most[0] > 1e-7 && fabs(most[0] / most[1] / 1e4 - 1) < 0.05);
}

/* The stiffening is a bound, it is 1 at rest, and never beyond three times what is met. */
static void test_stiffening(void **state) {
    dice d = {7, 0};
    (void)state;
    for (int which = 0; which < SOLIDS; which++) {
        double F[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, P[3][3], loosest = 0;
        assert_near(&solids[which], point(which, F, P).stiffening, 1, 1e-14);
        for (int n = 0; n < 300; n++) {
            double most = 0;
            random_gradient(&d, n % 3 == 0 ? 0.02 : 0.3, F);
            double bound = point(which, F, P).stiffening;
            for (int k = 0; k < 40; k++) {
                double R[3][3];
                dice_rotation(&d, R);
                most = fmax(most, acoustic(&elastic, solids[which].law, F, R[0]) / LARGE);
            }
            if (!(most <= bound * (1 + 1e-8)))
                fail_msg("%s: stiffening %g, bound %g", solids[which].name, most, bound);
            loosest = fmax(loosest, bound / most);
        }
        assert_true(loosest < (which == LINEAR ? 1 + 1e-2 : 3));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_by_hand),       cmocka_unit_test(test_rubber_by_hand),
        cmocka_unit_test(test_ogden_by_hand), cmocka_unit_test(test_ogden_is_mooney_rivlin),
        cmocka_unit_test(test_rotation),      cmocka_unit_test(test_small_strains),
        cmocka_unit_test(test_stiffening),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
