/* Strengths that rise with the rate of stress, at a face alone: what it holds at a constant rate, what it
 * takes then, and that a traction which stays breaks it in the end. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include "support/face_bench.h"
#include "support/figures.h"
#include "support/kernel_input.h"
#include "support/precision.h"

#define AREA  FACE_BENCH_AREA
#define SIGMA 4e8
#define DELTA 1.6e-7
#define GC    (SIGMA * DELTA / 2)
#define RATE  1e14 /* r_0 (Pa/s) */
#define N     0.2
#define MOST  2.5

static rg_cohesive rising(double most) {
    return (rg_cohesive){.law = RG_LAW_LINEAR,
                         .strength = SIGMA,
                         .opening = DELTA,
                         .separation = DELTA,
                         .beta = 1,
                         .activation = RG_ACTIVATION_CONSERVING,
                         .onset = 0.5,
                         .beta_s = 4,
                         .rise = {RATE, N, most}};
}

/* The next state, a step later. */
static void pull(face_bench *b, const rg_kernels *set, double step, double traction, double opening) {
    b->args.step = step;
    b->args.time += step;
    face_bench_load(b, (double[3]){0, 0, traction}, (double[3]){0, 0, opening});
    face_bench_run(b, set);
}

/* Traction at which a face breaks that is loaded at a constant rate, from steps of a thousandth of SIGMA. */
static double strength_at(face_bench *b, const rg_kernels *set, double most, double rate, double rest) {
    double traction = 0, step = 1e-3 * SIGMA / rate;
    face_bench_make(b, rising(most), 1, INSIDE);
    for (int k = 0; k < 100 && rest > 0; k++) /* before: at a pull below half of the strength */
        pull(b, set, step, rest * SIGMA, 0);
    for (traction = rest * SIGMA; b->broken[0] == 0 && traction < 5 * SIGMA; traction += 1e-3 * SIGMA)
        pull(b, set, step, traction, 0);
    return traction - 1e-3 * SIGMA;
}

static void test_strength(void **state) {
    const rg_kernels *sets[INPUT_SETS];
    int n = input_sets(sets, INPUT_SETS);
    figure found = {"strength that rises with the rate of stress", .bound = 2.5e-3,
                    .why = "a step of the load, and one by which the start of the mean is not known"};
    (void)state;
    for (int k = 0; k < n; k++)
        for (int power = -2; power <= 3; power++) {
            face_bench b;
            double rate = RATE * pow(10, power), factor = fmin(MOST, fmax(1, pow(rate / RATE, N)));
            raise_figure(&found, strength_at(&b, sets[k], MOST, rate, 0.4), factor * SIGMA, factor * SIGMA);
            assert_int_equal(b.broken[0], FACE_BENCH_ALL);
            for (int step = 0; step < 400; step++) /* opened wholly it has taken G_c, at any rate */
                pull(&b, sets[k], 1e-9, factor * SIGMA, 0.005 * DELTA);
            raise_figure(&found, b.energy[RG_E_DISSIPATED * RG_LANES], AREA * GC, AREA * GC);
        }
    assert_true(state_figure(found));
}

/* A pull that is held breaks a face when its mean rate has fallen so far: f(t) SIGMA = pull at t. One below
 * half of the strength in between starts the mean anew. */
static void test_held(void **state) {
    const rg_kernels *sets[INPUT_SETS];
    int n = input_sets(sets, INPUT_SETS);
    figure late = {"strength that rises: time to break under a constant pull", .bound = 1e-2,
                   .why = "half a step of a hundred"};
    (void)state;
    for (int k = 0; k < n; k++)
        for (int broken_off = 0; broken_off < 2; broken_off++) {
            face_bench b;
            double high = 1.4 * SIGMA, time = 0, wanted = 0.9 * SIGMA / (RATE * pow(1.4, 1 / N)),
                   step = wanted / 100.5;
            face_bench_make(&b, rising(10), 1, INSIDE);
            for (int before = 0; before < 60; before++)
                pull(&b, sets[k], step, before < 50 && broken_off ? high : 0.1 * SIGMA, 0);
            assert_int_equal(b.broken[0], 0);
            for (time = 0; b.broken[0] == 0 && time < 3 * wanted; time += step)
                pull(&b, sets[k], step, high, 0);
            raise_figure(&late, time, wanted, wanted);
        }
    assert_true(state_figure(late));
}

/* What is not asked for is not touched: factor 1, and no memory of it. */
static void test_slow_is_as_ever(void **state) {
    const rg_kernels *sets[INPUT_SETS];
    int n = input_sets(sets, INPUT_SETS);
    (void)state;
    for (int k = 0; k < n; k++) {
        face_bench b, plain;
        rg_cohesive law = rising(MOST);
        face_bench_make(&b, law, 1, INSIDE);
        law.rise = (rg_rise){0};
        face_bench_make(&plain, law, 1, INSIDE);
        for (int step = 0; step < 40; step++) {
            pull(&b, sets[k], 1, 0.03 * SIGMA * step, step < 35 ? 0 : 1e-9);
            pull(&plain, sets[k], 1, 0.03 * SIGMA * step, step < 35 ? 0 : 1e-9);
            assert_memory_equal(b.force, plain.force, sizeof b.force);
            assert_memory_equal(b.energy, plain.energy, sizeof b.energy);
        }
        assert_int_equal(b.broken[0], FACE_BENCH_ALL);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_strength),
        cmocka_unit_test(test_held),
        cmocka_unit_test(test_slow_is_as_ever),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
