/* Shear and tension together, at a face alone: what a point gives and takes follows in closed form. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include "support/face_bench.h"
#include "support/figures.h"
#include "support/kernel_input.h"

#define AREA  FACE_BENCH_AREA
#define SIGMA 4e8
#define DELTA 1.6e-7 /* critical opening of mode I (m) */
#define GC    (SIGMA * DELTA / 2)
#define RIGHT 1.5707963267948966

enum { STEPS = 400 };

/* Vectors are (normal, tangential), the latter along some direction in the face. */
typedef struct {
    face_bench bench;
    const rg_kernels *set;
    double at; /* direction of the tangential part */
} point;

static void to_space(double at, const double v[2], double out[3]) {
    out[0] = v[1] * cos(at);
    out[1] = v[1] * sin(at);
    out[2] = v[0];
}

static void load(point *p, const double pull[2], const double moved[2]) {
    double t[3], u[3];
    to_space(p->at, pull, t);
    to_space(p->at, moved, u);
    face_bench_load(&p->bench, t, u);
    face_bench_run(&p->bench, p->set);
}

/* Traction per area: a uniform one loads the three mid-edges with a third each. */
static void traction(const point *p, double t[2]) {
    double f[3];
    for (int c = 0; c < 3; c++)
        f[c] = 3 * (double)p->bench.force[rg_iforce_index(0, 3, c)] / AREA;
    t[0] = f[2];
    t[1] = f[0] * cos(p->at) + f[1] * sin(p->at);
}

static double energy(const point *p, int k) {
    return p->bench.energy[k * RG_LANES] / AREA;
}

static void point_make(point *p, const rg_kernels *set, rg_cohesive law) {
    p->set = set;
    p->at = 0.7;
    face_bench_make(&p->bench, law, 1, INSIDE);
}

/* Along the ray (cos a, beta sin a) of tractions, and on along the openings that the law has there. */
static void tear(const rg_kernels *set, rg_activation activation, double angle, figure *work, figure *lost) {
    static const double none[2] = {0, 0};
    const double beta = 1.5, ratio = 3.7, exponent = 1.6;
    rg_cohesive law = {.law = RG_LAW_BENZEGGAGH_KENANE,
                       .strength = SIGMA,
                       .opening = DELTA,
                       .separation = DELTA,
                       .beta = beta,
                       .activation = activation,
                       .onset = 0.3 * beta * beta,
                       .beta_s = 4,
                       .shape = {ratio, exponent}};
    point p;
    point_make(&p, set, law);
    const double along[2] = {cos(angle), sin(angle) / beta}; /* of openings; effective length 1 */
    const double weak[2] = {0.9999 * SIGMA * cos(angle), 0.9999 * SIGMA * beta * sin(angle)};
    const double strong[2] = {1.0001 * SIGMA * cos(angle), 1.0001 * SIGMA * beta * sin(angle)};
    const double energy_of_all = GC * (1 + (ratio - 1) * pow(sin(angle), 2 * exponent));
    load(&p, weak, none);
    assert_int_equal(p.bench.broken[0], 0);
    load(&p, strong, none);
    assert_int_equal(p.bench.broken[0], FACE_BENCH_ALL);
    double before[2], now[2], done = 0, step = 2 * energy_of_all / SIGMA / STEPS;
    traction(&p, before);
    for (int k = 1; k <= STEPS; k++) {
        load(&p, strong, (double[2]){step * along[0], step * along[1]});
        traction(&p, now);
        for (int c = 0; c < 2; c++) {
            done += 0.5 * (before[c] + now[c]) * step * along[c];
            before[c] = now[c];
        }
    }
    if (activation == RG_ACTIVATION_CONSERVING)
        raise_figure(work, done, energy_of_all, energy_of_all);
    load(&p, strong, (double[2]){DELTA * along[0], DELTA * along[1]});
    raise_figure(lost, energy(&p, RG_E_DISSIPATED), energy_of_all, energy_of_all);
    traction(&p, now);
    assert_true(fabs(now[0]) + fabs(now[1]) <= 1e-9 * SIGMA && energy(&p, RG_E_COHESIVE) <= 1e-12 * GC);
}

/* Pure opening takes G_c, pure sliding `ratio` times that, all between what Benzeggagh & Kenane say; the
 * strength of sliding is beta times that of opening. */
static void test_benzeggagh_kenane(void **state) {
    const rg_kernels *sets[INPUT_SETS];
    int n = input_sets(sets, INPUT_SETS);
    figure work = {"Benzeggagh-Kenane: work of separation", .bound = sizeof(rg_real) == 8 ? 2e-13 : 1e-4,
                   .why = ROUNDING},
           lost = {"Benzeggagh-Kenane: dissipated", .bound = sizeof(rg_real) == 8 ? 4e-15 : 1e-6,
                   .why = ROUNDING};
    (void)state;
    for (int k = 0; k < n; k++)
        for (int a = 0; a <= 6; a++) {
            tear(sets[k], RG_ACTIVATION_CONTINUOUS, a * RIGHT / 6, &work, &lost);
            tear(sets[k], RG_ACTIVATION_CONSERVING, a * RIGHT / 6, &work, &lost);
        }
    assert_true(state_figure(work));
    assert_true(state_figure(lost));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_benzeggagh_kenane),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
