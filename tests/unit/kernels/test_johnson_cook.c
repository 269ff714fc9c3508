/* The Johnson-Cook metal against closed forms, at points of the reference. (test_bulk_history.c holds kernels
 * and reference together.) */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>

#include "support/reference_point.h"

#define YOUNG   200e9
#define POISSON 0.29
#define DT      1e-8

/* 4340 steel of G. R. Johnson & W. H. Cook, 7th Int. Symp. Ballistics (1983). */
static const double steel[RG_PARAMETERS] = {
    [RG_PARAMETER_YIELD_STRESS] = 792e6,       [RG_PARAMETER_HARDENING_MODULUS] = 510e6,
    [RG_PARAMETER_HARDENING_POWER] = 0.26,     [RG_PARAMETER_RATE_SENSITIVITY] = 0.014,
    [RG_PARAMETER_REFERENCE_RATE] = 1,         [RG_PARAMETER_SOFTENING_POWER] = 1.03,
    [RG_PARAMETER_MELTING_TEMPERATURE] = 1793, [RG_PARAMETER_ROOM_TEMPERATURE] = 294,
    [RG_PARAMETER_HEAT_CAPACITY] = 477,        [RG_PARAMETER_HEAT_FRACTION] = 0.9};

static rg_material metal(const double parameter[RG_PARAMETERS]) {
    rg_material m = {.model = RG_MATERIAL_JOHNSON_COOK,
                     .density = 7830,
                     .lambda = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON)),
                     .mu = YOUNG / (2 * (1 + POISSON))};
    memcpy(m.of.parameter, parameter, sizeof m.of.parameter);
    rg_material_prepare(&m, DT);
    return m;
}

/* The steel without what is named, and without heat. */
static rg_material cold(double rate) {
    double p[RG_PARAMETERS];
    memcpy(p, steel, sizeof p);
    p[RG_PARAMETER_RATE_SENSITIVITY] = rate;
    p[RG_PARAMETER_HEAT_CAPACITY] = p[RG_PARAMETER_HEAT_FRACTION] = 0;
    return metal(p);
}

static figure stress_of_steel = {"johnson-cook, at rates 1e-2 to 1e7/s: von Mises stress, of A",
                                 .bound = 1.2e-12, .why = ROUNDING};

/* A bar stretched without change of volume at a constant rate: stress by the law at the strain and the rate
 * that the step had, at and beyond the reference rate and below it. */
static void test_rates(void **state) {
    const double A = 792e6, B = 510e6, n = 0.26, C = 0.014;
    (void)state;
    for (int power = -2; power <= 7; power++) {
        rg_material m = cold(C);
        double rate = pow(10, power);
        rg_material_prepare(&m, 0.002 / rate);
        reference_point p = point_make(&m, rg_reference_point_johnson_cook);
        for (int k = 1; k <= 50; k++) {
            double before = p.history[RG_JC_STRAIN], e = 0.002 * k;
            point_stretch(&p, -e / 2, e);
            double ep = p.history[RG_JC_STRAIN], dep = ep - before, G3 = 3 * m.mu;
            double speed = fmax(0, log(dep / 0.002 * rate));
            if (dep > 0)
                raise_figure(&stress_of_steel, point_mises(&p), (A + B * pow(ep, n)) * (1 + C * speed), A);
            raise_figure(&stress_of_steel, point_mises(&p), G3 * (e - ep), A);
        }
        assert_true(p.history[RG_JC_STRAIN] > 0.08);
    }
    assert_true(state_figure(stress_of_steel));
}

/* Without rates the number of steps does not matter where the direction of strain stays, nor does the step's
 * duration. */
static void test_steps(void **state) {
    rg_material m = cold(0);
    reference_point one = point_make(&m, rg_reference_point_johnson_cook), many = one;
    figure apart = {"johnson-cook, 0.1 of strain in 1 and 500 steps: plastic strain", .bound = 3e-14,
                    .why = ROUNDING};
    (void)state;
    point_stretch(&one, -0.05, 0.1);
    for (int k = 1; k <= 500; k++)
        point_stretch(&many, -1e-4 * k, 2e-4 * k);
    raise_figure(&apart, many.history[RG_JC_STRAIN], one.history[RG_JC_STRAIN], 1);
    assert_true(state_figure(apart));
}

/* Stress of a perfectly plastic metal (no B) that softens in proportion to its heat (m = 1): with s dep heat,
 * s = s0 exp(-k s0 ep), k = chi/(density c (Tm - T0)), s0 = A (1 + C log rate). Largest error, of A. */
static double error_of_heat(int steps, double *rise) {
    double p[RG_PARAMETERS], error = 0, rate = 1e4, end = 1;
    memcpy(p, steel, sizeof p);
    p[RG_PARAMETER_HARDENING_MODULUS] = 0;
    p[RG_PARAMETER_SOFTENING_POWER] = 1;
    rg_material m = metal(p);
    rg_material_prepare(&m, end / steps / rate);
    reference_point point = point_make(&m, rg_reference_point_johnson_cook);
    double k = 0.9 / (m.density * 477 * (1793 - 294)), s0 = 792e6 * (1 + 0.014 * log(rate));
    for (int n = 1; n <= steps; n++) {
        double e = end * n / steps;
        point_stretch(&point, -e / 2, e);
        if (n > 4 * steps / 100) /* after the first of it the rate of flow is that of the strain */
            error = fmax(error, fabs(point_mises(&point) - s0 * exp(-k * s0 * point.history[RG_JC_STRAIN])));
    }
    *rise = point.history[RG_JC_RISE];
    return error / 792e6;
}

static void test_heat(void **state) {
    double rise, coarse = error_of_heat(200, &rise), fine = error_of_heat(3200, &rise);
    figure error = {"johnson-cook, adiabatic softening in 200 steps: stress, of A", .found = coarse,
                    .bound = 2e-3};
    figure order = {"johnson-cook, adiabatic softening: error in 3,200 steps over that in 200",
                    .found = fine / coarse, .bound = 0.2};
    (void)state;
    assert_true(rise > 150 && rise < 250);
    assert_true(state_figure(error));
    assert_true(state_figure(order));
}

/* No strength is left from the melting temperature on. */
static void test_melting(void **state) {
    const rg_material m = metal(steel);
    reference_point p = point_make(&m, rg_reference_point_johnson_cook);
    (void)state;
    p.history[RG_JC_RISE] = 1793 - 294 + 100;
    point_stretch(&p, -0.05, 0.1);
    assert_true(point_mises(&p) < 1e-3 && p.history[RG_JC_STRAIN] > 0.0999999 && p.spent >= 0);
}

static void test_objectivity(void **state) {
    const rg_material m = metal(steel);
    figure stress = {"johnson-cook, turned at each step: stress, of E", .bound = 2e-14, .why = ROUNDING};
    figure history = {"johnson-cook, turned at each step: history, relative", .bound = 6e-12,
                      .why = ROUNDING};
    dice d = {30, 0};
    (void)state;
    for (int n = 0; n < 20; n++)
        point_turned(point_make(&m, rg_reference_point_johnson_cook), &d, 40, 5e-3, YOUNG, &stress, &history);
    assert_true(state_figure(stress));
    assert_true(state_figure(history));
}

static void test_gradient(void **state) {
    const rg_material m = metal(steel);
    figure gradient = {"johnson-cook, P against differences of the energy, of E", .bound = 2e-10};
    dice d = {50, 0};
    (void)state;
    for (int n = 0; n < 50; n++) {
        reference_point p = point_make(&m, rg_reference_point_johnson_cook);
        for (int k = 0; k < 10; k++) {
            point_wander(&p, &d, 2e-2, 0.2);
            point_step(&p);
        }
        assert_true(p.history[RG_JC_STRAIN] > 0.03);
        point_wander(&p, &d, 1e-2, 0.5);
        point_gradient(&p, YOUNG, &gradient);
    }
    assert_true(state_figure(gradient));
}

/* What is set free is what the ledger needs. */
static void test_work(void **state) {
    const rg_material m = metal(steel);
    reference_point p = point_make(&m, rg_reference_point_johnson_cook);
    double coarse = point_missing_energy(p, 100, 1, 0), fine = point_missing_energy(p, 1600, 1, 0);
    figure missing = {"johnson-cook, energy missing on a path of 100 steps, of what is dissipated",
                      .found = coarse, .bound = 4e-4};
    figure order = {"johnson-cook, energy missing in 1,600 steps over that in 100", .found = fine / coarse,
                    .bound = 0.03};
    (void)state;
    assert_true(state_figure(missing));
    assert_true(state_figure(order));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rates),   cmocka_unit_test(test_steps),       cmocka_unit_test(test_heat),
        cmocka_unit_test(test_melting), cmocka_unit_test(test_objectivity), cmocka_unit_test(test_gradient),
        cmocka_unit_test(test_work),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
