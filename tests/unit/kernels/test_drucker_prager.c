/* Drucker and Prager's solid against closed forms, at points of the reference. (test_bulk_history.c holds
 * kernels and reference together.) */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>

#include "support/reference_point.h"

#define YOUNG   20e9
#define POISSON 0.2
#define K       (YOUNG / (3 * (1 - 2 * POISSON)))
#define G       (YOUNG / (2 * (1 + POISSON)))
#define C       15e6
#define PHI     0.6108652381980153  /* 35 degrees */
#define PSI     0.17453292519943295 /* 10 degrees */
#define CAP     300e6
#define RATIO   0.6
#define PORES   0.1
#define UNIT    200e6

static const double SLOPE = 6 * 0.573576436351046 / (3 - 0.573576436351046);
static const double DILATION = 6 * 0.17364817766693033 / (3 - 0.17364817766693033);

static double strength(void) {
    return 6 * C * cos(PHI) / (3 - sin(PHI));
}

static rg_material rock(double cutoff, bool cap) {
    rg_material m = {.model = RG_MATERIAL_DRUCKER_PRAGER,
                     .density = 2300,
                     .lambda = K - 2 * G / 3,
                     .mu = G,
                     .of.parameter = {[RG_PARAMETER_COHESION] = C,
                                      [RG_PARAMETER_FRICTION_ANGLE] = 35,
                                      [RG_PARAMETER_DILATION_ANGLE] = 10,
                                      [RG_PARAMETER_TENSION_CUTOFF] = cutoff,
                                      [RG_PARAMETER_CAP_PRESSURE] = cap ? CAP : 0,
                                      [RG_PARAMETER_CAP_RATIO] = RATIO,
                                      [RG_PARAMETER_COMPACTION] = PORES,
                                      [RG_PARAMETER_COMPACTION_PRESSURE] = UNIT}};
    rg_material_prepare(&m, 1e-8);
    return m;
}

static double volume_of(const reference_point *p) {
    double inverse[3][3], F[3][3];
    memcpy(F, p->F, sizeof F);
    return rg_reference_invert(F, inverse);
}

/* Of Cauchy's stress. */
static double pressure(const reference_point *p) {
    return -point_mean(p) / volume_of(p);
}

static double mises(const reference_point *p) {
    return point_mises(p) / volume_of(p);
}

/* ---- Compression ---- */

/* Under a pressure all round the axial stress goes up to that of Mohr and Coulomb, s1 = (2 c cos phi + (1 +
 * sin phi) pc)/(1 - sin phi); from there on the solid flows by dep at that stress, and its volume grows by
 * b dep. In logarithmic strains: elastic ones of tau = J sigma, plastic ones -dep + b dep/3 along, dep/2 +
 * b dep/3 across. */
static void test_confined(void **state) {
    const rg_material m = rock(0, false);
    figure axial = {"drucker-prager, triaxial compression: axial stress, of the strength", .bound = 2.5e-12,
                    .why = ROUNDING};
    figure across = {"drucker-prager, triaxial compression: stress across, of the strength", .bound = 2.5e-12,
                     .why = ROUNDING};
    figure strains = {"drucker-prager, triaxial compression: plastic strain and volume", .bound = 3e-14,
                      .why = ROUNDING};
    figure heat = {"drucker-prager, triaxial compression: dissipation, relative", .bound = 1.6e-3};
    (void)state;
    for (int confined = 0; confined < 3; confined++) {
        const double pc = 20e6 * confined, s1 = (2 * C * cos(PHI) + (1 + sin(PHI)) * pc) / (1 - sin(PHI));
        const double q = s1 - pc, p = (s1 + 2 * pc) / 3;
        for (int steps = 1; steps <= 10; steps += 9) {
            reference_point at = point_make(&m, rg_reference_point_drucker_prager);
            double ep = 0, spent = 0, tau[3][3];
            for (int n = 0; n <= steps; n++) {
                double before = ep, log_J = 0;
                ep = 0.03 * n / steps;
                for (int i = 0; i < 100; i++) /* the volume that goes with the stress of that volume */
                    log_J = -(1 - 2 * POISSON) * exp(log_J) * 3 * p / YOUNG + DILATION * ep;
                double J = exp(log_J), e1 = -J * (s1 - 2 * POISSON * pc) / YOUNG;
                double e2 = -J * (pc - POISSON * (s1 + pc)) / YOUNG, swell = DILATION * ep / 3;
                point_stretch(&at, e2 + ep / 2 + swell, e1 - ep + swell);
                point_kirchhoff(&at, tau);
                raise_figure(&axial, -tau[2][2] / J, s1, s1);
                raise_figure(&across, -tau[0][0] / J, pc, s1);
                raise_figure(&strains, at.history[RG_DP_STRAIN], ep, 1);
                raise_figure(&strains, at.history[RG_DP_VOLUME], DILATION * ep, 1);
                spent += (ep - before) * J * (q - DILATION * p);
            }
            if (steps > 1)
                raise_figure(&heat, at.spent, spent, spent);
        }
    }
    assert_true(state_figure(axial));
    assert_true(state_figure(across));
    assert_true(state_figure(strains));
    assert_true(state_figure(heat));
}

/* Uniaxial strain e on the cone of a solid of little friction: with J = exp(e), 3G (2/3 |e| - ep) = J k + a K
 * (|e| + b ep), whatever the number of steps. */
static void test_uniaxial_strain(void **state) {
    rg_material m = rock(0, false);
    const double angle = 20 * 0.017453292519943295, a = 6 * sin(angle) / (3 - sin(angle));
    const double k = 6 * C * cos(angle) / (3 - sin(angle));
    figure flow = {"drucker-prager, uniaxial strain in 1 and 30 steps: plastic strain", .bound = 1e-15,
                   .why = ROUNDING};
    (void)state;
    m.of.parameter[RG_PARAMETER_FRICTION_ANGLE] = 20;
    rg_material_prepare(&m, 1e-8);
    for (int steps = 1; steps <= 30; steps += 29) {
        reference_point p = point_make(&m, rg_reference_point_drucker_prager);
        for (int n = 1; n <= steps; n++) {
            double e = 0.04 * n / steps, over = 2 * G * e - exp(-e) * k - a * K * e;
            point_stretch(&p, 0, -e);
            raise_figure(&flow, p.history[RG_DP_STRAIN], fmax(0, over / (3 * G + a * DILATION * K)), 1);
        }
        assert_true(p.history[RG_DP_STRAIN] > 5e-3);
    }
    assert_true(state_figure(flow));
}

/* ---- Tension ---- */

/* Pulled from all sides: the mean stress goes up to the cut-off, or to the apex c/tan phi; further on all is
 * flow of the volume. And the apex and the corner of cut-off and cone, where shear comes to it. */
static void test_tension(void **state) {
    figure most = {"drucker-prager, tension: mean stress over that of cut-off or apex", .bound = 1e-13,
                   .why = ROUNDING};
    figure shear = {"drucker-prager, tension and shear: von Mises stress at the corner, of c", .bound = 1e-12,
                    .why = ROUNDING};
    figure volume = {"drucker-prager, tension: plastic volume", .bound = 1e-15, .why = ROUNDING};
    (void)state;
    for (int cut = 0; cut < 3; cut++) {
        const double apex = C / tan(PHI), T = cut == 1 ? 4e6 : apex;
        const rg_material m = rock(cut == 0 ? 0 : cut == 1 ? T : 2 * apex, false);
        reference_point p = point_make(&m, rg_reference_point_drucker_prager);
        for (int n = 1; n <= 10; n++) {
            double e = 1e-3 * n, J = exp(3 * e);
            point_stretch(&p, e, e);
            raise_figure(&most, -pressure(&p), fmin(T, K * 3 * e / J), T);
            raise_figure(&volume, p.history[RG_DP_VOLUME], fmax(0, 3 * e - J * T / K), 1);
            assert_true(p.history[RG_DP_STRAIN] < 1e-15);
        }
        for (int i = 0; i < 3; i++)
            p.F[i][i] = exp(0.02);
        p.F[0][1] = 0.02;
        point_step(&p);
        raise_figure(&most, -pressure(&p), T, T);
        raise_figure(&shear, mises(&p), strength() - SLOPE * T, C);
        assert_true(p.history[RG_DP_STRAIN] > 1e-3);
    }
    assert_true(state_figure(most));
    assert_true(state_figure(shear));
    assert_true(state_figure(volume));
}

/* ---- Cap ---- */

static double cap_of(const reference_point *p) {
    return CAP + p->history[RG_DP_RISE];
}

/* Pressed from all sides: p = K (|log J| - ec)/J up to the crush curve pb = pb0 - P1 log(1 - ec/W), in any
 * number of steps; back it is elastic. */
static void test_crush_curve(void **state) {
    const rg_material m = rock(0, true);
    figure curve = {"drucker-prager, crush curve in 1 and 20 steps: pressure, of that of the cap",
                    .bound = 6e-13, .why = ROUNDING};
    (void)state;
    for (int steps = 1; steps <= 20; steps += 19) {
        reference_point p = point_make(&m, rg_reference_point_drucker_prager);
        double ec = 0, log_J = 0;
        for (int n = 1; n <= steps; n++) {
            ec = 0.08 * n / steps;
            double pb = CAP - UNIT * log(1 - ec / PORES);
            for (int i = 0; i < 200; i++)
                log_J = -ec - exp(log_J) * pb / K;
            point_stretch(&p, log_J / 3, log_J / 3);
            raise_figure(&curve, pressure(&p), pb, CAP);
            raise_figure(&curve, cap_of(&p), pb, CAP);
        }
        log_J += 0.01;
        point_stretch(&p, log_J / 3, log_J / 3);
        raise_figure(&curve, pressure(&p), -K * (log_J + ec) * exp(-log_J), CAP);
        assert_true(p.history[RG_DP_STRAIN] < 1e-15);
    }
    assert_true(state_figure(curve));
}

/* Trials of any kind, beyond each surface and each corner: the stress ends on the surface that it passed or
 * inside all, and flow has the direction of the rule there. */
static void test_random_returns(void **state) {
    const rg_material m = rock(5e6, true);
    figure beyond = {"drucker-prager, random paths: beyond the surfaces, of the cohesion", .bound = 3e-11,
                     .why = ROUNDING};
    figure rule = {"drucker-prager, random paths: off the flow rule, of the flow", .bound = 1e-8,
                   .why = ROUNDING};
    const double k = strength(), T = 5e6;
    int on_cone = 0, on_cap = 0, on_cut = 0, on_corner = 0, where_cap_begins = 0;
    dice d = {60, 0};
    (void)state;
    for (int n = 0; n < 4000; n++) {
        reference_point p = point_make(&m, rg_reference_point_drucker_prager);
        const double sizes[3] = {2e-3, 6e-3, 2e-2};
        for (int s = 0; s < 3; s++) {
            reference_point before = p;
            point_wander(&p, &d, sizes[(n + s) % 3], n % 2 == 0 ? 0.3 : 3);
            point_step(&p);
            const double *now = p.history, *then = before.history;
            double dep = now[RG_DP_STRAIN] - then[RG_DP_STRAIN], dvp = now[RG_DP_VOLUME] - then[RG_DP_VOLUME];
            double at = pressure(&p), q = mises(&p), pb = cap_of(&p);
            double pa = (pb - RATIO * k) / (1 + RATIO * SLOPE), Q = k + SLOPE * pa;
            double size = fabs(dep) + fabs(dvp), near = 1e-6 * C;
            if (at > pa + near)
                raise_figure(&beyond, fmax(0, hypot(at - pa, RATIO * q) - RATIO * Q), 0, C);
            else
                raise_figure(&beyond, fmax(0, fmax(q - k - SLOPE * at, -T - at)), 0, C);
            assert_true(dep >= 0 && p.history[RG_DP_RISE] >= before.history[RG_DP_RISE]);
            if (size < 1e-9)
                continue;
            if (at > pa + near) { /* dvp/dep = -(p - pa)/(R^2 q) */
                raise_figure(&rule, -dvp * RATIO * RATIO * q, dep * (at - pa), size * C);
                on_cap++;
            } else if (fabs(at - pa) <= near) {
                assert_true(dvp <= DILATION * dep + 1e-9 * size);
                where_cap_begins++;
            } else if (at > -T + near) {
                raise_figure(&rule, dvp, DILATION * dep, size);
                on_cone++;
            } else if (q < k - SLOPE * T - near) {
                raise_figure(&rule, dep, 0, size);
                on_cut++;
            } else {
                assert_true(dvp >= DILATION * dep - 1e-9 * size);
                on_corner++;
            }
        }
    }
    print_message("# %d on the cone, %d cap, %d cut-off, %d corner, %d where the cap begins\n", on_cone,
                  on_cap, on_cut, on_corner, where_cap_begins);
    assert_true(on_cone > 500 && on_cap > 500 && on_cut > 100 && on_corner > 500 && where_cap_begins > 20);
    assert_true(state_figure(beyond));
    assert_true(state_figure(rule));
}

/* ---- What must hold of any ---- */

static void test_objectivity(void **state) {
    const rg_material m = rock(5e6, true);
    figure stress = {"drucker-prager, turned at each step: stress, of E", .bound = 2e-14, .why = ROUNDING};
    figure history = {"drucker-prager, turned at each step: history, relative", .bound = 1e-11,
                      .why = ROUNDING};
    dice d = {30, 0};
    (void)state;
    for (int n = 0; n < 20; n++)
        point_turned(point_make(&m, rg_reference_point_drucker_prager), &d, 40, 5e-3, YOUNG, &stress,
                     &history);
    assert_true(state_figure(stress));
    assert_true(state_figure(history));
}

static void test_gradient(void **state) {
    const rg_material m = rock(5e6, true);
    figure gradient = {"drucker-prager, P against differences of the energy, of E", .bound = 2.4e-10};
    dice d = {50, 0};
    (void)state;
    for (int n = 0; n < 50; n++) {
        reference_point p = point_make(&m, rg_reference_point_drucker_prager);
        for (int k = 0; k < 10; k++) {
            point_wander(&p, &d, 2e-2, 1);
            point_step(&p);
        }
        assert_true(p.history[RG_DP_STRAIN] > 0.01);
        point_wander(&p, &d, 1e-2, 0.5);
        point_gradient(&p, YOUNG, &gradient);
    }
    assert_true(state_figure(gradient));
}

/* What is set free is what the ledger needs, to second order in the step: sheared on the cone, and pressed on
 * to the cap as well. */
static void test_work(void **state) {
    figure missing = {"drucker-prager, energy missing on a path of 100 steps, of what is dissipated",
                      .bound = 1.3e-4};
    figure order = {"drucker-prager, energy missing in 1,600 steps over that in 100", .bound = 0.03};
    (void)state;
    for (int pressed = 0; pressed < 2; pressed++) {
        const rg_material m = rock(0, pressed == 1);
        reference_point p = point_make(&m, rg_reference_point_drucker_prager);
        double press = pressed ? 0.15 : 0.01, coarse = point_missing_energy(p, 100, 1, press);
        raise_figure(&missing, coarse, 0, 1);
        raise_figure(&order, point_missing_energy(p, 1600, 1, press), 0, coarse);
    }
    assert_true(state_figure(missing));
    assert_true(state_figure(order));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_confined),       cmocka_unit_test(test_uniaxial_strain),
        cmocka_unit_test(test_tension),        cmocka_unit_test(test_crush_curve),
        cmocka_unit_test(test_random_returns), cmocka_unit_test(test_objectivity),
        cmocka_unit_test(test_gradient),       cmocka_unit_test(test_work),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
