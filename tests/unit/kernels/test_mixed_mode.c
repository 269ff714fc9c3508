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

/* ---- Strength that grows with pressure ---- */

#define PHI   0.6 /* friction, tan(phi) */
#define BETA  1.5
#define SHEAR (BETA * SIGMA)

/* Heat of friction, of all points. */
static double heat_of(const point *p) {
    double sum = 0;
    for (int q = 0; q < RG_POINTS; q++)
        sum += p->bench.crack[rg_friction_index(0, q, RG_FRICTION_HEAT, p->bench.args.crack_stride)];
    return sum / AREA;
}

/* A face under pressure p holds up to c + p tan(phi) of shear and no more; it goes on with just that, slides
 * by (1 - D) c + p tan(phi), and takes its fracture energy and p tan(phi) times what it slides. */
static void slide(const rg_kernels *set, rg_contact contact, double pressure, figure *held, figure *slid,
                  figure *gone) {
    static const double none[2] = {0, 0};
    rg_cohesive law = {.strength = SIGMA,
                       .opening = DELTA,
                       .separation = DELTA,
                       .beta = BETA,
                       .criterion = RG_CRITERION_MOHR_COULOMB,
                       .activation = RG_ACTIVATION_CONSERVING,
                       .onset = 0.3 * BETA * BETA,
                       .beta_s = 4,
                       .contact = contact,
                       .sliding = RG_SLIDING_COULOMB,
                       .friction = PHI};
    point p;
    point_make(&p, set, law);
    double strength = SHEAR + PHI * pressure, all[2], before;
    load(&p, (double[2]){-pressure, 0.9999 * strength}, none);
    assert_int_equal(p.bench.broken[0], 0);
    const double pull[2] = {-pressure, 1.0001 * strength};
    load(&p, pull, none);
    assert_int_equal(p.bench.broken[0], FACE_BENCH_ALL);
    traction(&p, all);
    raise_figure(held, all[0], -pressure, strength);
    raise_figure(held, all[1], strength, strength);
    double stored = energy(&p, RG_E_COHESIVE) + energy(&p, RG_E_CONTACT) + energy(&p, RG_E_UNRESOLVED);
    raise_figure(held, stored, 0, SHEAR * SHEAR / FACE_BENCH_ISO); /* what is lent and what stores it */
    before = all[1];
    double work = 0, step = DELTA / BETA / STEPS, first = stored + energy(&p, RG_E_DISSIPATED);
    for (int k = 1; k <= STEPS + 100; k++) {
        load(&p, pull, (double[2]){0, step});
        traction(&p, all);
        double damage = fmin(1, (double)k / STEPS);
        raise_figure(slid, all[1], SHEAR * (1 - damage) + PHI * pressure, strength);
        raise_figure(slid, all[0], -pressure, strength);
        work += 0.5 * (before + all[1]) * step;
        before = all[1];
    }
    double found = energy(&p, RG_E_COHESIVE) + energy(&p, RG_E_CONTACT) + energy(&p, RG_E_UNRESOLVED) +
                   energy(&p, RG_E_DISSIPATED) - first;
    raise_figure(gone, energy(&p, RG_E_DISSIPATED), GC, GC);
    double rubbed = PHI * pressure * step * (STEPS + 100);
    raise_figure(gone, work - found, rubbed, work);
    raise_figure(gone, heat_of(&p), rubbed, work);
}

static void test_mohr_coulomb(void **state) {
    const rg_kernels *sets[INPUT_SETS];
    int n = input_sets(sets, INPUT_SETS);
    figure held = {"Mohr-Coulomb: traction and energy through the switch",
                   .bound = sizeof(rg_real) == 8 ? 2e-12 : 1e-4, .why = ROUNDING},
           slid = {"Mohr-Coulomb: traction of a face that slides",
                   .bound = sizeof(rg_real) == 8 ? 2e-12 : 1e-4, .why = ROUNDING},
           gone = {"Mohr-Coulomb: energy that sliding takes", .bound = sizeof(rg_real) == 8 ? 2e-12 : 1e-4,
                   .why = ROUNDING};
    (void)state;
    for (int k = 0; k < n; k++)
        for (int p = 0; p <= 6; p++)
            slide(sets[k], RG_CONTACT_PENALTY, p * SIGMA, &held, &slid, &gone);
    assert_true(state_figure(held));
    assert_true(state_figure(slid));
    assert_true(state_figure(gone));
}

/* ---- Shear that fades ---- */

/* A point that breaks by opening goes on with all of its traction; opened by x critical openings and slid by
 * s it has 1 - x of it and of k s; work is what it stores and takes. */
static void open_and_slide(const rg_kernels *set, figure *held, figure *balance) {
    static const double none[2] = {0, 0}, pull[2] = {1.0001 * SIGMA, 0.7 * SIGMA};
    rg_cohesive law = {.strength = SIGMA,
                       .opening = DELTA,
                       .separation = DELTA,
                       .activation = RG_ACTIVATION_CONSERVING,
                       .onset = 0.3,
                       .beta_s = 4,
                       .contact = RG_CONTACT_POTENTIAL,
                       .shear = RG_SHEAR_FADING};
    point p;
    point_make(&p, set, law);
    double before[2], now[2], work = 0, opened = 0, slid = 0;
    load(&p, pull, none);
    assert_int_equal(p.bench.broken[0], FACE_BENCH_ALL);
    traction(&p, before);
    raise_figure(held, before[0], SIGMA, SIGMA);
    raise_figure(held, before[1], pull[1], SIGMA);
    double first = energy(&p, RG_E_COHESIVE) + energy(&p, RG_E_DISSIPATED);
    for (int k = 1; k <= STEPS; k++) { /* there and some of the way back along the face */
        double step[2] = {1.02 * DELTA / STEPS, 2e-10 * cos(0.005 * k)};
        load(&p, pull, step);
        traction(&p, now);
        opened += step[0];
        slid += step[1];
        double left = fmax(0, 1 - opened / DELTA);
        raise_figure(held, now[0], SIGMA * left, SIGMA);
        raise_figure(held, now[1], left * (pull[1] + FACE_BENCH_ISO * slid), SIGMA);
        for (int c = 0; c < 2; c++) {
            work += 0.5 * (before[c] + now[c]) * step[c];
            before[c] = now[c];
        }
    }
    raise_figure(balance, energy(&p, RG_E_COHESIVE) + energy(&p, RG_E_DISSIPATED) - first, work, GC);
    assert_true(fabs(energy(&p, RG_E_COHESIVE)) < 1e-12 * GC && energy(&p, RG_E_UNRESOLVED) <= 0);
    assert_true(fabs(energy(&p, RG_E_DISSIPATED) - GC) > 0.1 * GC); /* shear has its share */
}

static void test_fading(void **state) {
    const rg_kernels *sets[INPUT_SETS];
    int n = input_sets(sets, INPUT_SETS);
    figure held = {"shear that fades: traction", .bound = sizeof(rg_real) == 8 ? 5e-12 : 1e-4,
                   .why = ROUNDING},
           balance = {"shear that fades: work against what is stored and taken",
                      .bound = sizeof(rg_real) == 8 ? 2.5e-6 : 1.9e-6};
    (void)state;
    for (int k = 0; k < n; k++)
        open_and_slide(sets[k], &held, &balance);
    assert_true(state_figure(held));
    assert_true(state_figure(balance));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_benzeggagh_kenane),
        cmocka_unit_test(test_mohr_coulomb),
        cmocka_unit_test(test_fading),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
