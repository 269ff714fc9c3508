/* Frames, rotations and polar coordinates against points that are known. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/import/frame.h"

/* Within rounding: sines and roots of numbers about 1 to 100. */
static void expect_point(const double x[3], double a, double b, double c) {
    const double expected[3] = {a, b, c};
    for (int i = 0; i < 3; i++) {
        if (!(fabs(x[i] - expected[i]) < 3e-14)) {
            fail_msg("(%.17g, %.17g, %.17g) instead of (%g, %g, %g)", x[0], x[1], x[2], a, b, c);
        }
    }
}

static void test_through(void **state) {
    (void)state;
    const double a[3] = {10, 20, 30}, along[3] = {13, 24, 99}, up[3] = {10, 20, 37}, side[3] = {10, 25, 11};
    rg_frame f = rg_frame_global;
    double x[3] = {1, 2, 3};
    rg_frame_out(&f, x);
    assert_true(x[0] == 1 && x[1] == 2 && x[2] == 3);
    assert_true(rg_frame_through(a, along, NULL, &f)); /* the third axis stays, whatever b's height */
    rg_frame_out(&f, x);
    expect_point(x, 10 + 0.6 - 1.6, 20 + 0.8 + 1.2, 33);
    assert_true(rg_frame_through(a, up, side, &f)); /* z, y, -x */
    memcpy(x, (const double[]){1, 2, 3}, sizeof x);
    rg_frame_out(&f, x);
    expect_point(x, 7, 22, 31);
    assert_false(rg_frame_through(a, up, NULL, &f));
    assert_false(rg_frame_through(a, a, side, &f));
    assert_false(rg_frame_through(a, up, a, &f));
    assert_false(rg_frame_through(a, up, (const double[]){10, 20, 44}, &f));
    assert_false(rg_frame_through(a, (const double[]){1e200, 20, 30}, side,
                                  &f)); /* its length is beyond all numbers */
}

static void test_moved(void **state) {
    (void)state;
    static const struct {
        double by[3], a[3], b[3], angle, out[3]; /* of (1, 2, 3) */
    } cases[] = {
        {{5, 6, 7}, {0, 0, 0}, {0, 0, 1}, 0, {6, 8, 10}},
        {{0, 0, 0}, {0, 0, 0}, {0, 0, 3}, 90, {-2, 1, 3}},
        {{0, 0, 0}, {0, 0, 0}, {0, 0, -3}, 90, {2, -1, 3}},
        {{0, 0, 0}, {0, 0, 0}, {2, 0, 0}, 90, {1, -3, 2}},
        {{0, 0, 0}, {0, 0, 0}, {0, 2, 0}, 90, {3, 2, -1}},
        {{0, 0, 0}, {0, 0, 0}, {0, 0, 1}, -180, {-1, -2, 3}},
        {{0, 0, 0}, {0, 0, 0}, {0, 0, 1}, 720, {1, 2, 3}},
        {{0, 0, 0}, {5, 1, 1}, {5, 1, 9}, 270, {6, 5, 3}},
        {{1, 0, 0}, {5, 1, 1}, {5, 1, 9}, 90, {4, -2, 3}}, /* moved first */
        {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, 120, {3, 1, 2}},
        {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, -120, {2, 3, 1}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        rg_frame f;
        double x[3] = {1, 2, 3};
        assert_true(rg_frame_moved(cases[i].by, cases[i].a, cases[i].b, cases[i].angle, &f));
        rg_frame_out(&f, x);
        expect_point(x, cases[i].out[0], cases[i].out[1], cases[i].out[2]);
    }
    rg_frame f;
    assert_false(rg_frame_moved(cases[0].by, cases[8].a, cases[8].a, 90, &f));
}

static void test_polar(void **state) {
    (void)state;
    static const struct {
        double in[3], cylindrical[3], spherical[3];
    } cases[] = {
        {{2, 0, 0}, {2, 0, 0}, {2, 0, 0}},
        {{2, 90, 0}, {0, 2, 0}, {0, 2, 0}},
        {{2, 180, 0}, {-2, 0, 0}, {-2, 0, 0}},
        {{2, 270, 0}, {0, -2, 0}, {0, -2, 0}},
        {{2, -90, 90}, {0, -2, 90}, {0, 0, 2}},
        {{2, 45, -90}, {1.4142135623730951, 1.4142135623730951, -90}, {0, 0, -2}},
        {{2, 30, 60}, {1.7320508075688772, 1, 60}, {0.86602540378443860, 0.5, 1.7320508075688772}},
        {{2, 120, -30}, {-1, 1.7320508075688772, -30}, {-0.86602540378443860, 1.5, -1}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double x[3], y[3];
        memcpy(x, cases[i].in, sizeof x);
        memcpy(y, cases[i].in, sizeof y);
        rg_from_cylindrical(x);
        rg_from_spherical(y);
        expect_point(x, cases[i].cylindrical[0], cases[i].cylindrical[1], cases[i].cylindrical[2]);
        expect_point(y, cases[i].spherical[0], cases[i].spherical[1], cases[i].spherical[2]);
    }
    double quarter[3] = {3, 450, 7}; /* exact, so that nodes on planes stay there */
    rg_from_cylindrical(quarter);
    assert_true(quarter[0] == 0 && quarter[1] == 3 && quarter[2] == 7);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_through),
        cmocka_unit_test(test_moved),
        cmocka_unit_test(test_polar),
    };
    return cmocka_run_group_tests_name("frame", tests, NULL, NULL);
}
