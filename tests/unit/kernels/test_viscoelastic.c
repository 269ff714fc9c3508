/* The viscoelastic solid against closed forms, at points of the reference. (test_bulk_history.c holds kernels
 * and reference together.) */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>

#include "reference/hencky.h"
#include "support/reference_point.h"

#define G0 2.26e9
#define K0 5.88e9

static const double shear[3] = {0.2, 0.15, 0.1}, bulk[3] = {0.1, 0, 0.05}, tau[3] = {1e-6, 1e-5, 3e-4};

/* Maxwell elements 0 to n - 1, for steps of dt. */
static rg_material polymer(int n, double dt) {
    rg_material m = {.model = RG_MATERIAL_VISCOELASTIC, .density = 1190, .lambda = K0 - 2 * G0 / 3, .mu = G0};
    for (int i = 0; i < n; i++) {
        m.of.parameter[RG_PARAMETER_SHEAR_FRACTION_1 + i] = shear[i];
        m.of.parameter[RG_PARAMETER_BULK_FRACTION_1 + i] = bulk[i];
        m.of.parameter[RG_PARAMETER_RELAXATION_TIME_1 + i] = tau[i];
    }
    rg_material_prepare(&m, dt);
    return m;
}

/* Second Piola-Kirchhoff stress, F^-1 P. */
static double second(const reference_point *p, int i, int j) {
    double inverse[3][3], F[3][3], sum = 0;
    memcpy(F, p->F, sizeof F);
    rg_reference_invert(F, inverse);
    for (int k = 0; k < 3; k++)
        sum += inverse[i][k] * p->P[k][j];
    return sum;
}

/* The same of the solid in the long run. */
static double at_rest(const reference_point *p, int i, int j) {
    rg_material rest = polymer(3, 1);
    reference_point q = *p;
    double K = K0 * (1 - bulk[0] - bulk[1] - bulk[2]);
    rest.mu = G0 * (1 - shear[0] - shear[1] - shear[2]);
    rest.lambda = K - 2 * rest.mu / 3;
    rg_reference_point_neo_hookean(&rest, false, q.F, NULL, q.P, &q.out);
    return second(&q, i, j);
}

/* A strain E, large and turned, that grows at a constant rate for a time and then stays: each element has
 * A = E tau/t (1 - exp(-t/tau)) at its end, and then falls with exp(-time/tau). In any number of steps. */
static void test_ramp_and_relaxation(void **state) {
    figure ramp = {"viscoelastic, strain of 20 % at a constant rate in 1 to 100 steps: stress, of G",
                   .bound = 5e-15, .why = ROUNDING};
    figure relaxed = {"viscoelastic, then held for 1 to 100 times as long: stress, of G", .bound = 2.5e-15,
                      .why = ROUNDING};
    const double time = 5e-6, E[3][3] = {{0.2, 0.05, -0.1}, {0.05, -0.1, 0.03}, {-0.1, 0.03, 0.1}};
    dice d = {7, 0};
    (void)state;
    for (int steps = 1; steps <= 100; steps *= 10) {
        const rg_material m = polymer(3, time / steps);
        reference_point p = point_make(&m, rg_reference_point_viscoelastic);
        for (int n = 1; n <= 2 * steps; n++) {
            double part = fmin((double)n / steps, 1), root[3][3], Q[3][3], C[3][3], past = time * n / steps;
            for (int k = 0; k < 9; k++)
                C[k / 3][k % 3] = (k % 4 == 0) + 2 * part * E[k / 3][k % 3];
            rg_reference_function(C, sqrt, root); /* F = Q U */
            dice_rotation(&d, Q);
            product(Q, root, p.F);
            point_step(&p);
            for (int k = 0; k < 9; k++) {
                int i = k / 3, j = k % 3;
                double expected = at_rest(&p, i, j), trace = (i == j) * (E[0][0] + E[1][1] + E[2][2]);
                for (int e = 0; e < 3; e++) {
                    double left = tau[e] / time * -expm1(-fmin(past, time) / tau[e]) *
                                  exp(-fmax(past - time, 0) / tau[e]);
                    expected += left * (2 * G0 * shear[e] * (E[i][j] - trace / 3) + K0 * bulk[e] * trace);
                }
                raise_figure(n <= steps ? &ramp : &relaxed, second(&p, i, j), expected, G0);
            }
        }
    }
    assert_true(state_figure(ramp));
    assert_true(state_figure(relaxed));
}

/* Creep in shear under a constant stress, of one element: the strain goes from s/G to s/G_inf as
 * 1/G_inf - (1/G_inf - 1/G) exp(-t/tau'), tau' = tau G/G_inf. Imposed on a point it holds the stress. */
static double creep(int steps) {
    const double s = 1e3, end = 5 * tau[0], slow = tau[0] / (1 - shear[0]), soft = G0 * (1 - shear[0]);
    const rg_material m = polymer(1, end / steps), sudden = polymer(1, 1e-9 * tau[0]);
    reference_point p = point_make(&sudden, rg_reference_point_viscoelastic);
    double worst = 0;
    p.F[0][1] = s / G0;
    point_step(&p);
    p.m = &m;
    for (int n = 1; n <= steps; n++) {
        p.F[0][1] = s * (1 / soft - (1 / soft - 1 / G0) * exp(-end * n / steps / slow));
        point_step(&p);
        worst = fmax(worst, fabs(p.P[0][1] / s - 1));
    }
    return worst;
}

static void test_creep(void **state) {
    figure error = {"viscoelastic, creep in 100 steps: stress, relative", .found = creep(100), .bound = 8e-6};
    figure order = {"viscoelastic, creep: error in 1,600 steps over that in 100",
                    .found = creep(1600) / error.found, .bound = 0.01};
    (void)state;
    assert_true(state_figure(error));
    assert_true(state_figure(order));
}

/* A step of strain that takes no time meets the moduli of the material; held for long it leaves those of the
 * solid in the long run, and all that the elements stored is dissipated. */
static void test_limits(void **state) {
    const rg_material sudden = polymer(3, 1e-12), late = polymer(3, 1);
    reference_point p = point_make(&sudden, rg_reference_point_viscoelastic);
    figure first = {"viscoelastic, sudden strain of 1e-5: shear stress, relative", .bound = 5e-7};
    figure last = {"viscoelastic, long after: shear stress, relative", .bound = 1e-15, .why = ROUNDING};
    figure spent = {"viscoelastic, long after: dissipated of what the elements stored, relative",
                    .bound = 1.3e-7};
    double strain = 1e-5;
    (void)state;
    p.F[0][1] = strain;
    point_step(&p);
    raise_figure(&first, p.P[0][1], G0 * strain, G0 * strain);
    double stored = p.out.energy, held = G0 * strain * strain / 2;
    raise_figure(&first, stored, held, held);
    p.m = &late;
    for (int n = 0; n < 3; n++)
        point_step(&p);
    raise_figure(&last, p.P[0][1], G0 * 0.55 * strain, G0 * strain);
    raise_figure(&spent, p.out.energy, 0.55 * held, held);
    assert_true(state_figure(first));
    assert_true(state_figure(last));
    assert_true(state_figure(spent));
}

static void test_objectivity(void **state) {
    const rg_material m = polymer(3, 1e-6);
    figure stress = {"viscoelastic, turned at each step: stress, of G", .bound = 1e-14, .why = ROUNDING};
    figure history = {"viscoelastic, turned at each step: history, relative", .bound = 1.2e-12,
                      .why = ROUNDING};
    dice d = {30, 0};
    (void)state;
    for (int n = 0; n < 20; n++)
        point_turned(point_make(&m, rg_reference_point_viscoelastic), &d, 40, 5e-3, G0, &stress, &history);
    assert_true(state_figure(stress));
    assert_true(state_figure(history));
}

static void test_gradient(void **state) {
    const rg_material m = polymer(3, 1e-6);
    figure gradient = {"viscoelastic, P against differences of the energy, of G", .bound = 2.5e-10};
    dice d = {50, 0};
    (void)state;
    for (int n = 0; n < 50; n++) {
        reference_point p = point_make(&m, rg_reference_point_viscoelastic);
        for (int k = 0; k < 10; k++) {
            double before = p.spent;
            point_wander(&p, &d, 2e-2, 0.2);
            point_step(&p);
            assert_true(p.spent > before - 1e-3 * p.out.energy); /* a short step may borrow */
        }
        assert_true(p.spent > 0);
        point_wander(&p, &d, 1e-2, 0.5);
        point_gradient(&p, G0, &gradient);
    }
    assert_true(state_figure(gradient));
}

/* What is dissipated is what the ledger needs, to second order in the step. */
static void test_work(void **state) {
    rg_material m = polymer(3, 1e-7), fine_m = polymer(3, 1e-7 / 16);
    reference_point p = point_make(&m, rg_reference_point_viscoelastic), q = p;
    q.m = &fine_m;
    double coarse = point_missing_energy(p, 100, 1, 0), fine = point_missing_energy(q, 1600, 1, 0);
    figure missing = {"viscoelastic, energy missing on a path of 100 steps, of what is dissipated",
                      .found = coarse, .bound = 2e-6};
    figure order = {"viscoelastic, energy missing in 1,600 steps over that in 100", .found = fine / coarse,
                    .bound = 0.01};
    (void)state;
    assert_true(state_figure(missing));
    assert_true(state_figure(order));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ramp_and_relaxation),
        cmocka_unit_test(test_creep),
        cmocka_unit_test(test_limits),
        cmocka_unit_test(test_objectivity),
        cmocka_unit_test(test_gradient),
        cmocka_unit_test(test_work),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
