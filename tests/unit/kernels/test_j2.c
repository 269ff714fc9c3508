/* J2 plasticity against theory, on every set of kernels: each element of a mesh is a point with a deformation
 * gradient of its own, which a path moves step by step. (test_bulk_history.c holds kernels and reference
 * together.) */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reference/hencky.h"
#include "reference/material.h"
#include "reference/reference.h"
#include "support/dice.h"
#include "support/figures.h"
#include "support/kernel_input.h"

#define YOUNG   70e9
#define POISSON 0.3
#define YIELD   200e6

static const rg_material perfect = {.model = RG_MATERIAL_J2,
                                    .density = 2700,
                                    .lambda = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON)),
                                    .mu = YOUNG / (2 * (1 + POISSON)),
                                    .of.parameter = {[RG_PARAMETER_YIELD_STRESS] = YIELD}};

/* Linear hardening, and a part that saturates, as asked for. */
static rg_material metal(double hardening, double top, double rate) {
    rg_material m = perfect;
    m.of.parameter[RG_PARAMETER_HARDENING] = hardening;
    m.of.parameter[RG_PARAMETER_SATURATION_STRESS] = top;
    m.of.parameter[RG_PARAMETER_SATURATION_RATE] = rate;
    return m;
}

static double yield_stress(const rg_material *m, double ep) {
    const double *p = m->of.parameter, top = p[RG_PARAMETER_SATURATION_STRESS];
    double gain = top > 0 ? top - YIELD : 0;
    return YIELD + p[RG_PARAMETER_HARDENING] * ep + gain * (1 - exp(-p[RG_PARAMETER_SATURATION_RATE] * ep));
}

/* ---- Points ---- */

enum { POINTS = INPUT_ELEMENTS };

typedef struct {
    const rg_kernels *set;
    input *in;
    double (*F)[3][3]; /* of each point: the caller moves it */
    double *history, *force, *traction, *stiffening, *energy, *cauchy, *internal;
} points;

static points points_make(const rg_kernels *set, const rg_material *m) {
    points p = {.set = set, .in = input_make(INPUT_SMALL, input_laws[0], 7, 0)};
    p.in->material = *m;
    p.F = input_alloc(POINTS * sizeof *p.F);
    for (int e = 0; e < POINTS; e++)
        for (int i = 0; i < 3; i++)
            p.F[e][i][i] = 1;
    p.history = input_alloc(INPUT_ESLOTS * rg_history_rows(RG_J2_HISTORY) * sizeof(double));
    p.force = input_alloc(INPUT_EBLOCKS * RG_NODE_BLOCK * sizeof(double));
    p.traction = input_alloc(INPUT_EBLOCKS * RG_TRACTION_BLOCK * sizeof(double));
    p.stiffening = input_alloc(INPUT_ESLOTS * sizeof(double));
    p.energy = input_alloc(INPUT_ESLOTS * sizeof(double));
    p.cauchy = input_alloc(INPUT_ESLOTS * RG_GAUSS * 6 * sizeof(double));
    p.internal = input_alloc(INPUT_ESLOTS * RG_GAUSS * RG_INTERNAL * sizeof(double));
    return p;
}

static void points_free(points *p) {
    free(p->F);
    free(p->history);
    free(p->force);
    free(p->traction);
    free(p->stiffening);
    free(p->energy);
    free(p->cauchy);
    free(p->internal);
    input_free(p->in);
}

/* A step that ends at F; its state. */
static void points_step(points *p) {
    for (size_t e = 0; e < POINTS; e++)
        for (int a = 0; a < RG_NODES; a++)
            for (int c = 0; c < 3; c++)
                p->in->u[rg_node_index(p->in->element[e], a, c)] =
                    rg_reference_dot(p->F[e][c], p->in->x[e][a]) - p->in->x[e][a][c];
    rg_bulk_args bulk = input_bulk_args(p->in, p->force, p->traction, p->stiffening);
    bulk.gradient = RG_GRADIENT_OWN;
    bulk.history = p->history;
    bulk.advance = true;
    p->set->bulk(&bulk, 0, INPUT_EBLOCKS);
    p->set->bulk_state(&(rg_bulk_state_args){&bulk, p->energy, p->cauchy, p->internal}, 0, INPUT_EBLOCKS);
}

static double *history_of(const points *p, int e, size_t row) {
    return &p->history[rg_history_index(p->in->element[e], rg_history_block(RG_J2_HISTORY), row)];
}

static double strain_of(const points *p, int e) {
    return *history_of(p, e, RG_J2_STRAIN);
}

/* Dissipated so far, per volume. */
static double released(const points *p, int e) {
    return *history_of(p, e, RG_GAUSS * RG_J2_HISTORY + RG_RELEASED_PLASTIC) /
           p->in->geom[rg_geom_index(p->in->element[e], RG_GEOM_VOLUME)];
}

/* Kirchhoff stress at the element's first point. */
static void kirchhoff(const points *p, int e, double tau[3][3]) {
    static const int row[6] = {0, 1, 2, 1, 0, 0}, column[6] = {0, 1, 2, 2, 2, 1};
    double inverse[3][3], J = rg_reference_invert(p->F[e], inverse);
    size_t slot = p->in->element[e];
    for (size_t k = 0; k < 6; k++)
        tau[row[k]][column[k]] = tau[column[k]][row[k]] =
            J * p->cauchy[(slot / RG_LANES * RG_GAUSS * 6 + k) * RG_LANES + slot % RG_LANES];
}

static double mises_of(double tau[3][3]) {
    double mean = (tau[0][0] + tau[1][1] + tau[2][2]) / 3, square = 0;
    for (int k = 0; k < 9; k++)
        square += pow(tau[k / 3][k % 3] - (k % 4 == 0) * mean, 2);
    return sqrt(1.5 * square);
}

static void for_each_set(void (*check)(const rg_kernels *set)) {
    const rg_kernels *sets[INPUT_SETS];
    int n = input_sets(sets, INPUT_SETS);
    for (int k = 0; k < n; k++)
        check(sets[k]);
}

/* ---- Closed forms ---- */

static void stretch(points *p, double across, double along) {
    for (int e = 0; e < POINTS; e++) {
        p->F[e][0][0] = p->F[e][1][1] = exp(across);
        p->F[e][2][2] = exp(along);
    }
}

static figure strain_of_strain = {"j2, uniaxial strain in 1 to 16 steps: plastic strain", .bound = 1.3e-15,
                                  .why = ROUNDING},
              stress_of_strain = {"j2, uniaxial strain in 1 to 16 steps: stress, of G", .bound = 3e-15,
                                  .why = ROUNDING},
              heat_of_strain = {"j2, uniaxial strain in 1 to 16 steps: dissipation, relative", .bound = 6e-14,
                                .why = ROUNDING};

/* Uniaxial strain e with linear hardening: ep = (2G |e| - s0)/(3G + H) beyond |e| = s0/2G, so the stress
 * rises by K + 4/3 G H/(3G + H); then back to where the stress has turned round. Any number of steps gives
 * the same. */
static void check_uniaxial_strain(const rg_kernels *set) {
    const double H = 5e9, G = perfect.mu, K = perfect.lambda + 2 * G / 3, top = -0.03;
    const rg_material m = metal(H, 0, 0);
    for (int steps = 1; steps <= 16; steps *= 4) {
        points p = points_make(set, &m);
        double tau[3][3], ep = 0, first = YIELD / (2 * G);
        for (int n = 1; n <= steps; n++) {
            double e = top * n / steps, slope = K + 4.0 / 3 * G * H / (3 * G + H);
            stretch(&p, 0, e);
            points_step(&p);
            kirchhoff(&p, 5, tau);
            ep = fmax(0, (2 * G * fabs(e) - YIELD) / (3 * G + H));
            raise_figure(&strain_of_strain, strain_of(&p, 5), ep, 1);
            double expected = -(K + 4 * G / 3) * fmin(first, fabs(e)) - slope * fmax(0, fabs(e) - first);
            raise_figure(&stress_of_strain, tau[2][2], expected, G);
        }
        double spent = ep * (YIELD + H * ep / 2);
        raise_figure(&heat_of_strain, released(&p, 5), spent, spent);
        double hard = YIELD + H * ep,
               back = top + 2 * hard / (2 * G); /* to the other side of the yield surface */
        stretch(&p, 0, back - 1e-6);
        points_step(&p);
        raise_figure(&strain_of_strain, strain_of(&p, 5), ep, 1);
        stretch(&p, 0, back + 0.01);
        points_step(&p);
        kirchhoff(&p, 5, tau);
        double more = ep + 2 * G * 0.01 / (3 * G + H);
        raise_figure(&strain_of_strain, strain_of(&p, 5), more, 1);
        raise_figure(&stress_of_strain, tau[2][2], K * (back + 0.01) + 2.0 / 3 * (YIELD + H * more), G);
        points_free(&p);
    }
}

static void test_uniaxial_strain(void **state) {
    (void)state;
    for_each_set(check_uniaxial_strain);
    assert_true(state_figure(strain_of_strain));
    assert_true(state_figure(stress_of_strain));
    assert_true(state_figure(heat_of_strain));
}

static figure strain_of_stress = {"j2, uniaxial stress in 1 and 20 steps: plastic strain", .bound = 4e-15,
                                  .why = ROUNDING},
              tension_of_stress = {
                  "j2, uniaxial stress in 1 and 20 steps: tension and stress across, of the yield stress",
                  .bound = 3e-12, .why = ROUNDING};

/* Uniaxial stress: the tension is the yield curve, Voce's with a linear part, at an axial strain of sY/E + ep
 * and one of -nu sY/E - ep/2 across. */
static void check_uniaxial_stress(const rg_kernels *set) {
    const double rate[4] = {5, 50, 500, 2e4};
    for (int k = 0; k < 4; k++) {
        const rg_material m = metal(k % 2 == 0 ? 1e9 : 0, 1.8 * YIELD, rate[k]);
        for (int steps = 1; steps <= 20; steps += 19) {
            points p = points_make(set, &m);
            for (int n = 1; n <= steps; n++) {
                double ep = 0.05 * n / steps, sy = yield_stress(&m, ep), tau[3][3];
                stretch(&p, -POISSON * sy / YOUNG - ep / 2, sy / YOUNG + ep);
                points_step(&p);
                kirchhoff(&p, 17, tau);
                raise_figure(&strain_of_stress, strain_of(&p, 17), ep, 1);
                raise_figure(&tension_of_stress, tau[2][2], sy, YIELD);
                raise_figure(&tension_of_stress, tau[0][0], 0, YIELD);
            }
            points_free(&p);
        }
    }
}

static void test_uniaxial_stress(void **state) {
    (void)state;
    for_each_set(check_uniaxial_stress);
    assert_true(state_figure(strain_of_stress));
    assert_true(state_figure(tension_of_stress));
}

/* ---- Random paths ---- */

/* F <- exp(size random) F: a random step, by another random deformation for each point. */
static void wander(points *p, dice *d, double size) {
    for (int e = 0; e < POINTS; e++) {
        double rate[3][3], move[3][3], next[3][3];
        dice_deviator(d, size * dice_unit(d), rate);
        symmetric_exp(rate, move);
        product(move, p->F[e], next);
        double volume = 1 + 0.2 * size * dice_sign(d);
        for (int k = 0; k < 9; k++)
            p->F[e][k / 3][k % 3] = volume * next[k / 3][k % 3];
    }
}

static double determinant_of_flow(const points *p, int e) {
    static const int place[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};
    double metric[3][3], inverse[3][3];
    for (int k = 0; k < 9; k++)
        metric[k / 3][k % 3] = *history_of(p, e, (size_t)(RG_J2_FLOW + place[k / 3][k % 3])) + (k % 4 == 0);
    return rg_reference_invert(metric, inverse);
}

static figure yield_of_paths =
                  {"j2, random paths: von Mises stress against the yield curve, of the yield stress",
                   .bound = 1.1e-12, .why = ROUNDING},
              volume_of_paths = {"j2, random paths: det Fp^-2 less 1", .bound = 7e-14, .why = ROUNDING};

/* The stress is on the yield curve where a step flowed and never beyond it; plastic strain and dissipation
 * never fall; det Fp stays 1; the stress moves with F no faster than the elastic solid's. */
static void check_paths(const rg_kernels *set) {
    const rg_material metals[3] = {metal(0, 0, 0), metal(2e9, 0, 0), metal(5e8, 1.5 * YIELD, 30)};
    for (int k = 0; k < 3; k++) {
        points p = points_make(set, &metals[k]);
        dice d = {20 + (uint64_t)k, 0};
        int flowed = 0, rested = 0;
        for (int n = 0; n < 60; n++) {
            double before[POINTS], spent[POINTS];
            for (int e = 0; e < POINTS; e++) {
                before[e] = strain_of(&p, e);
                spent[e] = released(&p, e);
            }
            wander(&p, &d, n % 2 == 0 ? 1e-2 : 1e-3);
            points_step(&p);
            for (int e = 0; e < POINTS; e++) {
                double tau[3][3], ep = strain_of(&p, e), yield = yield_stress(&metals[k], ep);
                kirchhoff(&p, e, tau);
                double mises = mises_of(tau);
                assert_true(ep >= before[e] && released(&p, e) >= spent[e]);
                raise_figure(&yield_of_paths, ep > before[e] ? mises : fmax(mises, yield), yield, YIELD);
                flowed += ep > before[e];
                rested += ep == before[e];
                raise_figure(&volume_of_paths, determinant_of_flow(&p, e), 1, 1);
            }
        }
        assert_true(flowed > 1000 && rested > 1000);
        points_free(&p);
    }
}

static void test_paths(void **state) {
    (void)state;
    for_each_set(check_paths);
    assert_true(state_figure(yield_of_paths));
    assert_true(state_figure(volume_of_paths));
}

static figure stress_turned = {"j2, turned at each step: stress, of E", .bound = 4e-14, .why = ROUNDING},
              history_turned = {"j2, turned at each step: plastic strain and flow", .bound = 4e-14,
                                .why = ROUNDING};

/* A path seen by an observer who turns at each step: the same history, the stress turned. */
static void check_objectivity(const rg_kernels *set) {
    const rg_material m = metal(5e8, 1.5 * YIELD, 30);
    points still = points_make(set, &m), turned = points_make(set, &m);
    dice d = {30, 0};
    double most = 0;
    for (int n = 0; n < 40; n++) {
        double Q[POINTS][3][3];
        wander(&still, &d, 5e-3);
        for (int e = 0; e < POINTS; e++) {
            dice_rotation(&d, Q[e]);
            product(Q[e], still.F[e], turned.F[e]);
        }
        points_step(&still);
        points_step(&turned);
        for (int e = 0; e < POINTS; e++) {
            double tau[3][3], other[3][3], half[3][3];
            kirchhoff(&still, e, tau);
            kirchhoff(&turned, e, other);
            product(Q[e], tau, half);
            for (int i = 0; i < 3; i++)
                for (int j = 0; j < 3; j++)
                    raise_figure(&stress_turned, other[i][j], rg_reference_dot(half[i], Q[e][j]), YOUNG);
            for (size_t k = 0; k < RG_J2_HISTORY; k++)
                raise_figure(&history_turned, *history_of(&turned, e, k), *history_of(&still, e, k), 1);
            most = fmax(most, strain_of(&still, e));
        }
    }
    assert_true(most > 0.05);
    points_free(&still);
    points_free(&turned);
}

static void test_objectivity(void **state) {
    (void)state;
    for_each_set(check_objectivity);
    assert_true(state_figure(stress_turned));
    assert_true(state_figure(history_turned));
}

static figure stress_beside = {
    "j2, beside states on the yield curve: change of stress, of that of the elastic solid", .bound = 5};

/* From a state on the yield curve, a small step gives a stress near to it, whether it flows or unloads: no
 * farther than in the elastic solid, with some room for what large strains add. */
static void check_continuity(const rg_kernels *set) {
    const double gap = 1e-8;
    const rg_material m = metal(0, 1.5 * YIELD, 100);
    points one = points_make(set, &m), other = points_make(set, &m);
    dice d = {40, 0};
    int flowed = 0, unloaded = 0;
    for (int n = 0; n < 40; n++) {
        double before[POINTS];
        for (int e = 0; e < POINTS; e++)
            before[e] = strain_of(&one, e);
        wander(&one, &d, 3e-3);
        points_step(&one);
        memcpy(other.history, one.history, INPUT_ESLOTS * rg_history_rows(RG_J2_HISTORY) * sizeof(double));
        for (int e = 0; e < POINTS; e++)
            for (int k = 0; k < 9; k++)
                other.F[e][k / 3][k % 3] = one.F[e][k / 3][k % 3] + gap * dice_sign(&d);
        points_step(&other);
        for (int e = 0; e < POINTS; e++) {
            double a[3][3], b[3][3];
            kirchhoff(&one, e, a);
            kirchhoff(&other, e, b);
            for (int k = 0; k < 9; k++)
                raise_figure(&stress_beside, b[k / 3][k % 3], a[k / 3][k % 3], gap * (m.lambda + 2 * m.mu));
            bool on = strain_of(&one, e) > before[e];
            flowed += on && strain_of(&other, e) > strain_of(&one, e) + 1e-10;
            unloaded += on && !(strain_of(&other, e) > strain_of(&one, e));
        }
    }
    assert_true(flowed > 200 && unloaded > 200);
    points_free(&one);
    points_free(&other);
}

static void test_continuity(void **state) {
    (void)state;
    for_each_set(check_continuity);
    assert_true(state_figure(stress_beside));
}

/* ---- Energy, at points of the reference ---- */

static double energy_at(const rg_material *m, double F[3][3], double history[RG_J2_HISTORY], double P[3][3]) {
    rg_reference_point out;
    rg_reference_point_j2(m, false, F, history, P, &out);
    return out.energy;
}

/* Within the elastic range, also of a solid that has flowed, P = dW/dF. */
static void test_gradient(void **state) {
    const rg_material m = metal(1e9, 0, 0);
    const double step = 1e-5;
    figure gradient = {"j2, P against differences of the energy, of E", .bound = 2.6e-10};
    dice d = {50, 0};
    (void)state;
    for (int n = 0; n < 200; n++) {
        double flow[3][3], F[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, P[3][3], other[3][3];
        double history[RG_J2_HISTORY] = {0};
        rg_reference_point out;
        dice_deviator(&d, 0.1, flow);
        symmetric_exp(flow, F);
        rg_reference_point_j2(&m, true, F, history, P, &out);
        assert_true(history[RG_J2_STRAIN] > 0.05);
        for (int k = 0; k < 9; k++)
            F[k / 3][k % 3] += 1e-2 * dice_sign(&d);
        energy_at(&m, F, history, P);
        for (int k = 0; k < 9; k++) {
            double moved[2], start = F[k / 3][k % 3];
            for (int side = 0; side < 2; side++) {
                F[k / 3][k % 3] = start + (side ? step : -step);
                moved[side] = energy_at(&m, F, history, other);
            }
            F[k / 3][k % 3] = start;
            raise_figure(&gradient, P[k / 3][k % 3], (moved[1] - moved[0]) / (2 * step), YOUNG);
        }
    }
    assert_true(state_figure(gradient));
}

/* Work done on a point along a curved path less what it stores and what it has set free, over the latter. */
static double missing_energy(const rg_material *m, int steps) {
    double F[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, P[3][3] = {{0}}, history[RG_J2_HISTORY] = {0};
    double work = 0, spent = 0, stored = 0;
    for (int n = 1; n <= steps; n++) {
        double t = (double)n / steps, before[3][3], from[3][3], move[9] = {0};
        rg_reference_point out;
        memcpy(before, P, sizeof before);
        memcpy(from, F, sizeof from);
        move[0] = 0.02 * sin(2 * t);
        move[1] = 0.05 * t * t;
        move[5] = 0.03 * (1 - cos(3 * t));
        move[8] = -0.03 * t;
        for (int k = 0; k < 9; k++)
            F[k / 3][k % 3] = (k % 4 == 0) + move[k];
        rg_reference_point_j2(m, true, F, history, P, &out);
        for (int k = 0; k < 9; k++)
            work += (P[k / 3][k % 3] + before[k / 3][k % 3]) / 2 * (F[k / 3][k % 3] - from[k / 3][k % 3]);
        spent += out.released[RG_RELEASED_PLASTIC];
        stored = out.energy;
    }
    return fabs(work - stored - spent) / spent;
}

/* What is set free is what the ledger needs, to second order in the step (but for the step that meets the
 * yield point). */
static void test_work(void **state) {
    const rg_material metals[3] = {metal(0, 0, 0), metal(2e9, 0, 0), metal(5e8, 1.5 * YIELD, 30)};
    figure missing = {"j2, energy missing on a path of 100 steps, of what is dissipated", .bound = 4e-4};
    figure order = {"j2, energy missing in 1,600 steps over that in 100", .bound = 0.01};
    (void)state;
    for (int k = 0; k < 3; k++) {
        double coarse = missing_energy(&metals[k], 100), fine = missing_energy(&metals[k], 1600);
        raise_figure(&missing, coarse, 0, 1);
        raise_figure(&order, fine, 0, coarse);
    }
    assert_true(state_figure(missing));
    assert_true(state_figure(order));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_uniaxial_strain),
        cmocka_unit_test(test_uniaxial_stress),
        cmocka_unit_test(test_paths),
        cmocka_unit_test(test_objectivity),
        cmocka_unit_test(test_continuity),
        cmocka_unit_test(test_gradient),
        cmocka_unit_test(test_work),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
