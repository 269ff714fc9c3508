/* How a rigid body turns: the free motion of tops against their exact one, what it keeps, small turns to
 * rounding, and the inertia of shapes. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "base/vector.h"
#include "case/case.h"
#include "solver/attitude.h"

static void assert_near(double found, double expected, double bound, const char *what) {
    if (!(fabs(found - expected) <= bound)) {
        fail_msg("%s: %.17g, not %.17g: off by %.2g", what, found, expected, found - expected);
    }
}

static void go_on(const rg_inertia *b, const double momentum[3], double dt, int steps, double q[4]) {
    for (int i = 0; i < steps; i++) {
        double step[4];
        rg_inertia_free(b, q, momentum, dt, step);
        rg_rotation_join(step, q, q);
    }
}

static double energy(const rg_inertia *b, const double q[4], const double momentum[3]) {
    double spin[3];
    rg_inertia_spin(b, q, momentum, spin);
    return 0.5 * rg_vector_dot(spin, momentum);
}

/* A body with two equal moments: its axis goes round L at |L|/I1, and it turns about it at (1/I3 - 1/I1) L.n
 * besides, in steps of any length. */
static void test_symmetric_top(void **state) {
    (void)state;
    const double n[3] = {2.0 / 7, 3.0 / 7, 6.0 / 7}, momentum[3] = {0.3, -1.1, 0.7};
    for (int flat = 0; flat < 2; flat++) {
        double across = 2, along = flat ? 3.5 : 0.5, tensor[6];
        for (int k = 0; k < 6; k++) {
            int i = k < 3 ? k : k == 3 ? 1 : 0, j = k < 3 ? k : k == 5 ? 1 : 2;
            tensor[k] = across * (i == j) + (along - across) * n[i] * n[j];
        }
        rg_inertia b = rg_inertia_make(tensor);
        double q[4] = {1, 0, 0, 0}, about[3], turn[3], first[4], second[4], expected[4];
        const double time = 4.2;
        go_on(&b, momentum, time / 7, 7, q);
        for (int c = 0; c < 3; c++) {
            about[c] = time * momentum[c] / across;
            turn[c] = time * (1 / along - 1 / across) * rg_vector_dot(momentum, n) * n[c];
        }
        rg_rotation_by(about, first);
        rg_rotation_by(turn, second);
        rg_rotation_join(first, second, expected);
        double same = 0;
        for (int c = 0; c < 4; c++) {
            same += q[c] * expected[c]; /* the same turn may have either sign */
        }
        assert_near(fabs(same), 1, 2e-15, flat ? "flat top" : "long top");
        for (int c = 0; c < 4; c++) {
            assert_near(q[c] * (same > 0 ? 1 : -1), expected[c], 2e-15, "its attitude");
        }
    }
}

/* With three moments, about the one in between, from which it tumbles: the energy swings by (angle of a
 * step)^2 and does not drift; the attitude comes back when run backwards. */
static void test_tumbling(void **state) {
    (void)state;
    const double tensor[6] = {1, 2, 2.5, 0.1, -0.2, 0.15}, momentum[3] = {0.05, 2, -0.02};
    rg_inertia b = rg_inertia_make(tensor);
    double worst[2] = {0, 0};
    for (int fine = 0; fine < 2; fine++) {
        double q[4] = {1, 0, 0, 0}, start = energy(&b, q, momentum), dt = fine ? 0.01 : 0.02;
        for (int i = 0; i < 20000; i++) {
            go_on(&b, momentum, dt, 1, q);
            worst[fine] = fmax(worst[fine], fabs(energy(&b, q, momentum) / start - 1));
        }
    }
    assert_true(worst[1] < 4e-6 && worst[1] > 1e-7);
    assert_near(worst[0] / worst[1], 4, 0.2, "order of the energy");
    double q[4] = {1, 0, 0, 0};
    const double back[3] = {-momentum[0], -momentum[1], -momentum[2]};
    go_on(&b, momentum, 0.3, 40, q);
    assert_true(fabs(q[0]) < 0.9);
    go_on(&b, back, 0.3, 40, q);
    assert_near(fabs(q[0]), 1, 1e-14, "there and back");
    for (int c = 1; c < 4; c++) {
        assert_near(q[c], 0, 3e-14, "there and back");
    }
}

/* Euler's equations for the three moments by their own: d(body momentum)/dt = p x I^-1 p, in small steps. */
static void test_euler(void **state) {
    (void)state;
    const double tensor[6] = {1, 2, 2.5, 0, 0, 0}, momentum[3] = {0.4, 1.5, -0.8};
    rg_inertia b = rg_inertia_make(tensor);
    double q[4] = {1, 0, 0, 0}, p[3] = {momentum[0], momentum[1], momentum[2]}, spin[3], back[4], along[3];
    enum { STEPS = 100000 };
    const double time = 3, dt = time / STEPS;
    for (int i = 0; i < STEPS; i++) { /* midpoint rule */
        double half[3], rate[3], w[3];
        for (int pass = 0; pass < 2; pass++) {
            const double *at = pass == 0 ? p : half;
            for (int c = 0; c < 3; c++) {
                w[c] = at[c] / tensor[c];
            }
            rg_vector_cross(at, w, rate);
            for (int c = 0; c < 3; c++) {
                half[c] = p[c] + 0.5 * dt * rate[c];
            }
        }
        for (int c = 0; c < 3; c++) {
            p[c] += dt * rate[c];
        }
    }
    go_on(&b, momentum, time / 3000, 3000, q);
    rg_inertia_spin(&b, q, momentum, spin);
    memcpy(back, (const double[4]){q[0], -q[1], -q[2], -q[3]}, sizeof back);
    rg_rotation_turn(back, spin, along);
    for (int c = 0; c < 3; c++) {
        assert_near(along[c], p[c] / tensor[c], 2e-7, "angular velocity in the body");
    }
}

/* A turn of 1e-9 moves by itself, not by what cancellation leaves. */
static void test_small_turns(void **state) {
    (void)state;
    const double vector[3] = {0, 0, 1e-9}, x[3] = {3, 0, 5};
    double q[4], moved[3];
    rg_rotation_by(vector, q);
    rg_rotation_move(q, x, moved);
    assert_near(moved[0], -1.5e-18, 1e-33, "inward");
    assert_near(moved[1], 3e-9, 1e-24, "across");
    assert_near(moved[2], 0, 0, "along");
}

/* Of shapes: of a heap of points inside them, to what 8e6 of them leave. */
static void test_shapes(void **state) {
    (void)state;
    rg_body_input ball = {.shape = RG_SHAPE_SPHERE, .radius = 0.5, .density = 3},
                  rod = {.shape = RG_SHAPE_CYLINDER,
                         .radius = 0.3,
                         .length = 1.5,
                         .density = 3,
                         .axis = {2, 0, 1}};
    const rg_body_input *bodies[] = {&ball, &rod};
    const double half = 0.8, cell = 2 * half / 200;
    for (int i = 0; i < 2; i++) {
        double sum[7] = {0}, inertia[6];
        for (int n = 0; n < 8000000; n++) {
            double x[3] = {cell * (n % 200 + 0.5) - half, cell * (n / 200 % 200 + 0.5) - half,
                           cell * (n / 40000 + 0.5) - half};
            double along = (2 * x[0] + x[2]) / sqrt(5), square = rg_vector_dot(x, x);
            bool in = i == 0 ? square < 0.25 : fabs(along) < 0.75 && square - along * along < 0.09;
            for (int k = 0; in && k < 6; k++) {
                int a = k < 3 ? k : k == 3 ? 1 : 0, b = k < 3 ? k : k == 5 ? 1 : 2;
                sum[k] += (a == b ? square : 0) - x[a] * x[b];
            }
            sum[6] += in;
        }
        double mass = rg_body_mass(bodies[i]), share = 3 * cell * cell * cell;
        rg_body_inertia(bodies[i], inertia);
        assert_near(mass / (share * sum[6]), 1, 2e-3, "mass");
        for (int k = 0; k < 6; k++) {
            assert_near(inertia[k], share * sum[k], 6e-3 * inertia[1], "inertia");
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_symmetric_top), cmocka_unit_test(test_tumbling), cmocka_unit_test(test_euler),
        cmocka_unit_test(test_small_turns),   cmocka_unit_test(test_shapes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
