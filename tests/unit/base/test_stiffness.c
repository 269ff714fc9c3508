/* Stiffness of any symmetry against crystals whose constants and waves have closed forms. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/principal.h"
#include "base/stiffness.h"
#include "base/vector.h"
#include "support/dice.h"

static void assert_near(double found, double expected, double tolerance) {
    if (!(fabs(found - expected) <= tolerance)) {
        fail_msg("%.17g instead of %.17g", found, expected);
    }
}

/* Copper (GPa): C11, C12, C44. */
static const double copper[3] = {168.4, 121.4, 75.4};

static void cubic(const double of[3], double c[RG_STIFFNESS]) {
    memset(c, 0, RG_STIFFNESS * sizeof *c);
    for (int i = 0; i < 3; i++) {
        for (int j = i; j < 3; j++) {
            c[rg_stiffness_place(i, j)] = of[i != j];
        }
        c[rg_stiffness_place(3 + i, 3 + i)] = of[2];
    }
}

/* Of no symmetry. */
static void triclinic(dice *d, double c[RG_STIFFNESS]) {
    cubic(copper, c);
    for (int k = 0; k < RG_STIFFNESS; k++) {
        c[k] += 20 * dice_sign(d);
    }
}

static void test_places(void **state) {
    (void)state;
    for (int i = 0, at = 0; i < 6; i++) {
        for (int j = i; j < 6; j++, at++) {
            assert_int_equal(rg_stiffness_place(i, j), at);
            assert_int_equal(rg_stiffness_place(j, i), at);
        }
    }
}

/* An isotropic solid by its engineering constants; of an orthotropic one the strains by tension along each
 * axis, and its shears. */
static void test_orthotropic(void **state) {
    (void)state;
    double c[RG_STIFFNESS], least, nu[3] = {0.3, 0.3, 0.3}, E[3] = {210, 210, 210}, G = 210 / 2.6;
    assert_true(rg_stiffness_orthotropic(E, nu, (double[3]){G, G, G}, c, &least));
    double lambda = 210 * 0.3 / (1.3 * 0.4);
    double expected[RG_STIFFNESS];
    cubic((double[3]){lambda + 2 * G, lambda, G}, expected);
    for (int k = 0; k < RG_STIFFNESS; k++) {
        assert_near(c[k], expected[k], 2e-13);
    }
    assert_near(least, 0.4 / 210, 1e-18); /* of the compliance: 1/(3 K) */
    assert_true(rg_stiffness_orthotropic(E, nu, (double[3]){1e3, 2e3, 1e3}, c, &least));
    assert_near(least, 0.5 / 2e3, 1e-18); /* ... or 1/(2 G) */
    const double young[3] = {10, 20, 40}, poisson[3] = {0.25, 0.1, 0.4}, shear[3] = {3, 5, 7};
    assert_true(rg_stiffness_orthotropic(young, poisson, shear, c, &least));
    const double strain[3][3] = {
        {1, -0.4, -0.1}, {-0.4 * 20 / 10, 1, -0.25}, {-0.1 * 40 / 10, -0.25 * 40 / 20, 1}};
    for (int axis = 0; axis < 3; axis++) {
        for (int i = 0; i < 3; i++) {
            double stress = 0;
            for (int j = 0; j < 3; j++) {
                stress += c[rg_stiffness_place(i, j)] * strain[axis][j] / young[axis];
            }
            assert_near(stress, i == axis, 5e-16);
        }
        assert_true(c[rg_stiffness_place(3 + axis, 3 + axis)] == shear[axis]);
    }
    /* Three equal ratios of 0.6: under pressure it would grow, by -0.2/E each way. */
    assert_false(rg_stiffness_orthotropic(E, (double[3]){0.6, 0.6, 0.6}, shear, c, &least));
    assert_near(least, -0.2 / 210, 1e-18);
}

/* Of a cubic crystal the eigenvalues are C11 + 2 C12, C11 - C12 (twice) and 2 C44 (three times), whatever its
 * orientation. */
static void test_least(void **state) {
    static const struct {
        double constant[3], least;
    } crystal[] = {
        {{168.4, 121.4, 75.4}, 47}, {{107, 28, 28.3}, 56.6}, {{10, -4, 20}, 2}, {{100, 105, 50}, -5}};
    dice d = {3, 0};
    (void)state;
    for (size_t k = 0; k < sizeof crystal / sizeof *crystal; k++) {
        double c[RG_STIFFNESS], R[3][3];
        cubic(crystal[k].constant, c);
        assert_near(rg_stiffness_least(c), crystal[k].least, 2e-13);
        dice_rotation(&d, R);
        rg_stiffness_turn(c, (const double(*)[3])R);
        assert_near(rg_stiffness_least(c), crystal[k].least, 4e-13);
    }
}

static double energy(const double c[RG_STIFFNESS], double e[3][3]) {
    const double voigt[6] = {e[0][0], e[1][1], e[2][2], 2 * e[1][2], 2 * e[0][2], 2 * e[0][1]};
    double sum = 0;
    for (int n = 0; n < 36; n++) {
        sum += c[rg_stiffness_place(n / 6, n % 6)] * voigt[n / 6] * voigt[n % 6];
    }
    return sum / 2;
}

/* The energy of a strain that turns with the solid stays, of any strain; and axes may be exchanged by hand.
 */
static void test_turn(void **state) {
    dice d = {4, 0};
    (void)state;
    for (int n = 0; n < 100; n++) {
        double c[RG_STIFFNESS], turned[RG_STIFFNESS], R[3][3], Rt[3][3], e[3][3], half[3][3], there[3][3];
        triclinic(&d, c);
        memcpy(turned, c, sizeof c);
        dice_rotation(&d, R);
        rg_stiffness_turn(turned, (const double(*)[3])R);
        dice_deviator(&d, 1, e);
        for (int k = 0; k < 9; k++) {
            Rt[k / 3][k % 3] = R[k % 3][k / 3];
        }
        product(Rt, e, half); /* its axes are the rows of R: in the mesh, R^T e R */
        product(half, R, there);
        assert_near(energy(turned, there), energy(c, e), 4e-13);
    }
    double c[RG_STIFFNESS];
    triclinic(&d, c);
    double before = c[rg_stiffness_place(0, 1)], shear = c[rg_stiffness_place(0, 3)];
    rg_stiffness_turn(c, (const double[3][3]){{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}); /* 1 is y, 2 is z, 3 is x */
    assert_near(c[rg_stiffness_place(1, 2)], before, 0);
    assert_near(c[rg_stiffness_place(1, 4)], shear, 0);
}

static void test_mean(void **state) {
    dice d = {5, 0};
    double c[RG_STIFFNESS], R[3][3], bulk[2], shear[2];
    (void)state;
    cubic(copper, c);
    rg_stiffness_mean(c, &bulk[0], &shear[0]);
    assert_near(bulk[0], (168.4 + 2 * 121.4) / 3, 3e-14);
    assert_near(shear[0], (168.4 - 121.4 + 3 * 75.4) / 5, 3e-14);
    triclinic(&d, c);
    rg_stiffness_mean(c, &bulk[0], &shear[0]);
    dice_rotation(&d, R);
    rg_stiffness_turn(c, (const double(*)[3])R);
    rg_stiffness_mean(c, &bulk[1], &shear[1]);
    assert_near(bulk[1], bulk[0], 2e-13);
    assert_near(shear[1], shear[0], 2e-13);
}

/* rho c^2 of the waves of a cubic crystal along [100], [110], [111]. */
static void test_waves(void **state) {
    const double a = copper[0], b = copper[1], g = copper[2];
    const double expected[3][3] = {{a, g, g},
                                   {(a + b + 2 * g) / 2, g, (a - b) / 2},
                                   {(a + 2 * b + 4 * g) / 3, (a - b + g) / 3, (a - b + g) / 3}};
    (void)state;
    for (int k = 0; k < 3; k++) {
        double c[RG_STIFFNESS], tensor[6], value[3], axis[3][3], n[3];
        for (int i = 0; i < 3; i++) {
            n[i] = i <= k ? 1 / sqrt(k + 1) : 0;
        }
        cubic(copper, c);
        rg_stiffness_acoustic(c, n, tensor);
        rg_principal_axes(tensor, value, axis);
        for (int i = 0; i < 3; i++) {
            assert_near(value[2 - i], expected[k][i], 1.5e-13);
        }
    }
}

/* n.C.n by the components of C: of a solid of no symmetry, along any direction; x.A.x is twice the energy of
 * the strain of x n. */
static void test_acoustic(void **state) {
    dice d = {6, 0};
    (void)state;
    for (int k = 0; k < 100; k++) {
        double c[RG_STIFFNESS], R[3][3], A[6], e[3][3];
        triclinic(&d, c);
        dice_rotation(&d, R);
        rg_stiffness_acoustic(c, R[0], A);
        double x[3] = {dice_sign(&d), dice_sign(&d), dice_sign(&d)};
        for (int n = 0; n < 9; n++) {
            e[n / 3][n % 3] = (x[n / 3] * R[0][n % 3] + x[n % 3] * R[0][n / 3]) / 2;
        }
        double form = A[0] * x[0] * x[0] + A[1] * x[1] * x[1] + A[2] * x[2] * x[2] +
                      2 * (A[3] * x[1] * x[2] + A[4] * x[0] * x[2] + A[5] * x[0] * x[1]);
        assert_near(form, 2 * energy(c, e), 4e-13);
    }
}

/* Copper is stiffest along [111] and softest along [100], silver chloride's like has it the other way round;
 * the slowest wave slides along [1-10] in (110), or across [100]. */
static void test_directions(void **state) {
    static const double other[3] = {60, 36, 6};
    double c[RG_STIFFNESS], R[3][3];
    dice d = {7, 0};
    (void)state;
    cubic(copper, c);
    dice_rotation(&d, R);
    rg_stiffness_turn(c, (const double(*)[3])R);
    rg_stiffness_range range = rg_stiffness_over_directions(c);
    assert_near(range.stiffest, (copper[0] + 2 * copper[1] + 4 * copper[2]) / 3, 1e-6 * copper[0]);
    assert_near(range.softest, copper[0], 1e-6 * copper[0]);
    assert_near(range.slowest, (copper[0] - copper[1]) / 2, 1e-6 * copper[0]);
    cubic(other, c);
    range = rg_stiffness_over_directions(c);
    assert_near(range.stiffest, other[0], 1e-6 * other[0]);
    assert_near(range.softest, (other[0] + 2 * other[1] + 4 * other[2]) / 3, 1e-6 * other[0]);
    assert_near(range.slowest, other[2], 1e-6 * other[0]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_places),   cmocka_unit_test(test_orthotropic), cmocka_unit_test(test_least),
        cmocka_unit_test(test_turn),     cmocka_unit_test(test_mean),        cmocka_unit_test(test_waves),
        cmocka_unit_test(test_acoustic), cmocka_unit_test(test_directions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
