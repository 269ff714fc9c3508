/* The Holmquist-Johnson-Cook concrete against closed forms, at points of the reference. (test_bulk_history.c
 * holds kernels and reference together.) */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>

#include "support/reference_point.h"

#define K    16e9
#define G    14.86e9
#define FC   48e6
#define T    4e6
#define P_C  16e6
#define P_L  0.8e9
#define MU_L 0.1
#define K1   85e9
#define K2   -171e9
#define K3   208e9
#define DT   1e-6

/* Of the source. */
static rg_material concrete(void) {
    rg_material m = {.model = RG_MATERIAL_HOLMQUIST_JOHNSON_COOK,
                     .density = 2440,
                     .lambda = K - 2 * G / 3,
                     .mu = G,
                     .of.parameter = {[RG_PARAMETER_REFERENCE_RATE] = 1,
                                      [RG_PARAMETER_COMPRESSIVE_STRENGTH] = FC,
                                      [RG_PARAMETER_COHESIVE_STRENGTH] = 0.79,
                                      [RG_PARAMETER_CRUSHED_STRENGTH] = 1.6,
                                      [RG_PARAMETER_CRUSHED_POWER] = 0.61,
                                      [RG_PARAMETER_LARGEST_STRENGTH] = 7,
                                      [RG_PARAMETER_TENSILE_LIMIT] = T,
                                      [RG_PARAMETER_FAILURE_STRAIN] = 0.04,
                                      [RG_PARAMETER_FAILURE_POWER] = 1,
                                      [RG_PARAMETER_LEAST_FAILURE_STRAIN] = 0.01,
                                      [RG_PARAMETER_CRUSH_PRESSURE] = P_C,
                                      [RG_PARAMETER_LOCK_PRESSURE] = P_L,
                                      [RG_PARAMETER_LOCK_STRAIN] = MU_L,
                                      [RG_PARAMETER_BULK_1] = K1,
                                      [RG_PARAMETER_BULK_2] = K2,
                                      [RG_PARAMETER_BULK_3] = K3}};
    rg_material_prepare(&m, DT);
    return m;
}

static double volume(const reference_point *p) {
    double inverse[3][3], F[3][3];
    memcpy(F, p->F, sizeof F);
    return rg_reference_invert(F, inverse);
}

static double pressure(const reference_point *p) {
    return -point_mean(p) / volume(p);
}

static void press(reference_point *p, double mu) {
    double stretch = -log1p(mu) / 3;
    point_stretch(p, stretch, stretch);
}

/* ---- Pressure ---- */

static double dense(double x) {
    return K1 * x + (x > 0 ? K2 * x * x + K3 * x * x * x : 0);
}

/* mu where all pores have closed, by Newton's method. */
static double lock(void) {
    double x = P_L / K1;
    for (int n = 0; n < 20; n++)
        x -= (dense(x) - P_L) / (K1 + 2 * K2 * x + 3 * K3 * x * x);
    return MU_L + (1 + MU_L) * x;
}

/* From all sides: elastic to P_C, then along the straight line to P_L, back along K_u between K and K1, on
 * along it and further; beyond P_L there and back along the curve of the dense solid; under tension down to
 * -T, less the damage of the pores. Also the plastic volume, and the damage: mup over ef along the line. */
static void test_pressure(void **state) {
    const rg_material m = concrete();
    figure curve = {"holmquist-johnson-cook, from all sides: pressure, of P_lock", .bound = 6e-14,
                    .why = ROUNDING};
    figure pores = {"holmquist-johnson-cook, from all sides: plastic volume", .bound = 4e-15,
                    .why = ROUNDING};
    reference_point p = point_make(&m, rg_reference_point_holmquist_johnson_cook);
    const double mu_c = P_C / K, mu_m = lock(), K_t = (P_L - P_C) / (mu_m - mu_c);
    (void)state;
    for (int n = 1; n <= 10; n++) {
        press(&p, mu_c * n / 10);
        raise_figure(&curve, pressure(&p), P_C * n / 10, P_L);
        assert_true(n == 10 || (p.spent == 0 && p.history[RG_HJC_CLOSED] == 0));
    }
    for (int n = 1; n <= 9; n++) {
        double top = mu_c + (mu_m - mu_c) * n / 10, F = n / 10., K_u = (1 - F) * K + F * K1;
        double at = P_C + K_t * (top - mu_c), none = top - at / K_u;
        press(&p, top);
        raise_figure(&curve, pressure(&p), at, P_L);
        raise_figure(&pores, p.out.internal[RG_INTERNAL_VOLUME], -log1p(none), 1);
        for (int back = 1; back <= 4; back++) {
            double mu = top - (top - none) * back / 4;
            press(&p, mu);
            raise_figure(&curve, pressure(&p), K_u * (mu - none), P_L);
        }
        press(&p, none - 1e-3);
        raise_figure(&curve, pressure(&p), -T * (1 - p.history[RG_HJC_DAMAGE]), P_L);
        press(&p, top); /* and there again, without work */
        raise_figure(&curve, pressure(&p), at, P_L);
    }
    for (int n = 1; n <= 20; n++) {
        double mu = n <= 10 ? mu_m + 0.1 * n / 10 : mu_m + 0.1 - (mu_m + 0.1 - MU_L) * (n - 10) / 10;
        press(&p, mu);
        raise_figure(&curve, pressure(&p), dense((mu - MU_L) / (1 + MU_L)), P_L);
        raise_figure(&pores, p.out.internal[RG_INTERNAL_VOLUME], -log1p(MU_L), 1);
    }
    assert_true(state_figure(curve));
    assert_true(state_figure(pores));
}

/* What closing pores sets free is the area between loading and unloading, in any number of steps: to m and
 * back to no pressure, the work of the pressure by Simpson's rule along closed forms. The damage of it is
 * mup over ef, here of the least strain alone. */
static void test_crushing(void **state) {
    rg_material m = concrete();
    figure work = {"holmquist-johnson-cook, pores that close: energy set free, relative", .bound = 2.5e-12,
                   .why = ROUNDING};
    figure damage = {"holmquist-johnson-cook, pores that close: damage against mup over ef", .bound = 6e-16,
                     .why = ROUNDING};
    (void)state;
    m.of.parameter[RG_PARAMETER_FAILURE_STRAIN] = 0;
    m.of.parameter[RG_PARAMETER_LEAST_FAILURE_STRAIN] = 0.2;
    const double mu_c = P_C / K, mu_m = lock(), K_t = (P_L - P_C) / (mu_m - mu_c);
    for (int whole = 0; whole <= 1; whole++) {
        double m_most = whole ? mu_m : mu_c + 0.6 * (mu_m - mu_c), F = 0.6, K_u = (1 - F) * K + F * K1;
        double none = whole ? MU_L : m_most - (P_C + K_t * (m_most - mu_c)) / K_u, area = 0;
        const int cuts = 1000;
        for (int n = 0; n < cuts; n++)
            for (int k = 0; k < 3; k++) {
                double weight = (k == 1 ? 4 : 1) / 6. / cuts, s = (n + k / 2.) / cuts;
                double up = mu_c * s, on = mu_c + (m_most - mu_c) * s, back = none + (m_most - none) * s;
                double p_back = whole ? dense((back - MU_L) / (1 + MU_L)) : K_u * (back - none);
                area += weight * (K * up * mu_c / pow(1 + up, 2) +
                                  (P_C + K_t * (on - mu_c)) * (m_most - mu_c) / pow(1 + on, 2) -
                                  p_back * (m_most - none) / pow(1 + back, 2));
            }
        for (int steps = 1; steps <= 100; steps *= 10) {
            reference_point p = point_make(&m, rg_reference_point_holmquist_johnson_cook);
            for (int n = 1; n <= steps; n++)
                press(&p, (m_most + (whole ? 0.05 : 0)) * n / steps);
            raise_figure(&work, p.spent, area, area);
            /* the straight branch ends at a plastic mu that is somewhat beyond that of the dense solid */
            if (!whole)
                raise_figure(&damage, p.history[RG_HJC_DAMAGE], none / 0.2, 1);
        }
    }
    assert_true(state_figure(work));
    assert_true(state_figure(damage));
}

/* ---- Strength ---- */

/* Of the pressure, before the rate. */
static double strength(double p, double D) {
    double sum = p > 0 ? 0.79 * (1 - D) + 1.6 * pow(p / FC, 0.61) : 0.79 * (1 - D + p / T);
    return FC * fmax(fmin(sum, 7), 0);
}

/* Sheared at a constant volume: von Mises' stress is the strength at that pressure, whole, damaged, crushed
 * and at its limit; the damage is the plastic strain over ef, and rates raise the strength. */
static void test_strength(void **state) {
    rg_material m = concrete();
    figure stress = {"holmquist-johnson-cook, sheared at -2 MPa to 4 GPa: von Mises stress, of f_c",
                     .bound = 2e-12, .why = ROUNDING};
    figure damage = {"holmquist-johnson-cook, sheared: damage against plastic strain over ef", .bound = 5e-13,
                     .why = ROUNDING};
    figure faster = {"holmquist-johnson-cook, at rates 1e-2 to 1e4/s: von Mises stress, of f_c",
                     .bound = 5e-13, .why = ROUNDING};
    static const double mu[] = {-2e6 / K, 1e-4, 5e-4, 0.003, 0.03, 0.09, 0.14};
    int crushed = 0, bounded = 0;
    (void)state;
    for (size_t i = 0; i < sizeof mu / sizeof *mu; i++) {
        reference_point p = point_make(&m, rg_reference_point_holmquist_johnson_cook);
        press(&p, mu[i]);
        double at = pressure(&p), closing = p.history[RG_HJC_DAMAGE], J = volume(&p);
        double ef = fmax(0.04 * (at + T) / FC, 0.01);
        for (int n = 1; n <= 60; n++) {
            double e = -1e-3 * n, stretch = -log1p(mu[i]) / 3, D = p.history[RG_HJC_DAMAGE];
            at = pressure(&p);
            point_stretch(&p, stretch - e / 2, stretch + e);
            D = p.history[RG_HJC_DAMAGE];
            if (p.history[RG_HJC_LAST] > 0)
                raise_figure(&stress, point_mises(&p), J * strength(at, D), FC);
            if (at >= 0) /* else the pressure follows the falling limit */
                raise_figure(&damage, D, fmin(1, closing + p.history[RG_HJC_STRAIN] / ef), 1);
            crushed += D == 1;
            bounded += strength(at, D) == 7 * FC;
        }
    }
    assert_true(crushed > 100 && bounded > 20);
    m.of.parameter[RG_PARAMETER_RATE_SENSITIVITY] = 0.007;
    m.of.parameter[RG_PARAMETER_FAILURE_STRAIN] = 1e30;
    for (int power = -2; power <= 4; power += 2) {
        double rate = pow(10, power), step = 1e-3;
        rg_material_prepare(&m, step / rate);
        reference_point p = point_make(&m, rg_reference_point_holmquist_johnson_cook);
        for (int n = 1; n <= 30; n++) {
            bool flowed = p.history[RG_HJC_LAST] > 0;
            point_stretch(&p, 0.5 * step * n - log1p(5e-4) / 3, -step * n - log1p(5e-4) / 3);
            if (flowed)
                raise_figure(&faster, point_mises(&p) * (1 + 5e-4),
                             strength(K * 5e-4, 0) * (1 + 0.007 * fmax(0, log(rate))), FC);
        }
    }
    assert_true(state_figure(stress));
    assert_true(state_figure(damage));
    assert_true(state_figure(faster));
}

/* Uniaxial strain: the axial stress is p + 2/3 s, of small steps against the published algorithm in rates,
 * without the change of volume in stress and strain that finite strain makes. */
static void test_uniaxial(void **state) {
    const rg_material m = concrete();
    figure axial = {
        "holmquist-johnson-cook, uniaxial strain to 15 % and back: axial stress against the algorithm in "
        "rates, of P_lock",
        .bound = 4.5e-4};
    reference_point p = point_make(&m, rg_reference_point_holmquist_johnson_cook);
    const int steps = 20000;
    double s = 0, D = 0, closed = 0, none = 0, mu_c = P_C / K, mu_m = lock();
    const double K_t = (P_L - P_C) / (mu_m - mu_c);
    (void)state;
    for (int n = 1; n <= 2 * steps; n++) {
        double e = -0.15 * (n <= steps ? n : 2 * steps - n) / steps, de = (n <= steps ? -0.15 : 0.15) / steps;
        double mu = exp(-e) - 1, J = exp(e), at, before = none;
        point_stretch(&p, 0, e);
        closed = fmin(fmax(closed, mu - mu_c), mu_m - mu_c);
        if (closed >= mu_m - mu_c) {
            none = MU_L;
            at = dense((mu - MU_L) / (1 + MU_L));
        } else {
            double F = fmax(closed, 0) / (mu_m - mu_c), K_u = (1 - F) * K + F * K1;
            none = closed > 0 ? mu_c + closed - (P_C + K_t * closed) / K_u : 0;
            at = K_u * (mu - none);
        }
        at = fmax(at, -T * (1 - D));
        double ef = fmax(0.04 * fmax(at + T, 0) / FC, 0.01);
        D = fmin(1, D + fmax(none - before, 0) / ef);
        double trial = s - 2 * G * de, most = J * strength(at, D); /* s: Kirchhoff's, signed */
        double stress = fmin(fabs(trial), most);
        D = fmin(1, D + (fabs(trial) - stress) / (3 * G) / ef);
        s = copysign(stress, trial);
        double tau[3][3];
        point_kirchhoff(&p, tau);
        raise_figure(&axial, -tau[2][2] / J, at + 2.0 / 3 * s / J, P_L);
    }
    assert_true(D == 1 && p.history[RG_HJC_DAMAGE] == 1);
    assert_true(state_figure(axial));
}

/* ---- What must hold of any ---- */

static void test_objectivity(void **state) {
    const rg_material m = concrete();
    figure stress = {"holmquist-johnson-cook, turned at each step: stress, of G", .bound = 1e-14,
                     .why = ROUNDING};
    figure history = {"holmquist-johnson-cook, turned at each step: history, relative", .bound = 1.8e-11,
                      .why = ROUNDING};
    dice d = {30, 0};
    (void)state;
    for (int n = 0; n < 40; n++)
        point_turned(point_make(&m, rg_reference_point_holmquist_johnson_cook), &d, 40, 3e-3, G, &stress,
                     &history);
    assert_true(state_figure(stress));
    assert_true(state_figure(history));
}

/* P = dW/dF while nothing happens: virgin, damaged, with pores closed and dense, pressed and pulled beyond
 * what it bears. */
static void test_gradient(void **state) {
    const rg_material m = concrete();
    figure gradient = {"holmquist-johnson-cook, P against differences of the energy, of G", .bound = 1.5e-9};
    dice d = {50, 0};
    int held = 0, solid = 0;
    (void)state;
    for (int n = 0; n < 200; n++) {
        reference_point p = point_make(&m, rg_reference_point_holmquist_johnson_cook);
        press(&p, n % 4 == 0 ? 0.13 : n % 4 == 1 ? 0.05 : 1e-4);
        for (int k = 0; k < 10; k++) {
            point_wander(&p, &d, 5e-3, 0.5);
            point_step(&p);
        }
        point_wander(&p, &d, 5e-3, n % 4 == 2 ? 4 : 0.5);
        p.law(p.m, false, p.F, p.history, p.P, &p.out);
        held += fabs(pressure(&p) + T * (1 - p.history[RG_HJC_DAMAGE])) < 1;
        solid += p.out.internal[RG_INTERNAL_VOLUME] == -log1p(MU_L);
        point_gradient(&p, G, &gradient);
    }
    assert_true(held > 20 && solid > 20);
    assert_true(state_figure(gradient));
}

/* On random paths damage and pores go one way, the stress is at most the strength, and as long as there are
 * pores nothing is gained. */
static void test_paths(void **state) {
    const rg_material m = concrete();
    figure beyond = {"holmquist-johnson-cook, random paths: von Mises stress beyond the strength, of f_c",
                     .bound = 7e-15, .why = ROUNDING};
    dice d = {60, 0};
    int flowed = 0, crushed = 0, pulled = 0;
    (void)state;
    for (int n = 0; n < 200; n++) {
        reference_point p = point_make(&m, rg_reference_point_holmquist_johnson_cook);
        press(&p, 0.05 * n / 200);
        for (int k = 0; k < 60; k++) {
            reference_point before = p;
            point_wander(&p, &d, 2e-3, 0.5);
            point_step(&p);
            double D = p.history[RG_HJC_DAMAGE], at = pressure(&p);
            if (at >= 0)
                raise_figure(&beyond, fmax(point_mises(&p) - volume(&p) * strength(at, D), 0), 0, FC);
            assert_true(D >= before.history[RG_HJC_DAMAGE] && D <= 1);
            assert_true(p.history[RG_HJC_CLOSED] >= before.history[RG_HJC_CLOSED]);
            assert_true(p.spent >= before.spent - 1e-6 * FC);
            flowed += p.history[RG_HJC_STRAIN] > before.history[RG_HJC_STRAIN];
            pulled += at < 0;
        }
        crushed += p.history[RG_HJC_DAMAGE] == 1;
    }
    assert_true(flowed > 1000 && crushed > 20 && pulled > 30);
    assert_true(state_figure(beyond));
}

/* What is set free is what the ledger needs, better and better in smaller steps. */
static void test_work(void **state) {
    const rg_material m = concrete();
    figure missing = {"holmquist-johnson-cook, energy missing on a path of 400 steps, of what is dissipated",
                      .bound = 7e-6};
    figure order = {"holmquist-johnson-cook, energy missing in 6,400 steps over that in 400", .bound = 0.01};
    (void)state;
    reference_point p = point_make(&m, rg_reference_point_holmquist_johnson_cook);
    double coarse = point_missing_energy(p, 400, 0.5, 0.06), fine = point_missing_energy(p, 6400, 0.5, 0.06);
    raise_figure(&missing, coarse, 0, 1);
    raise_figure(&order, fine, 0, coarse);
    assert_true(state_figure(missing));
    assert_true(state_figure(order));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pressure), cmocka_unit_test(test_crushing),    cmocka_unit_test(test_strength),
        cmocka_unit_test(test_uniaxial), cmocka_unit_test(test_objectivity), cmocka_unit_test(test_gradient),
        cmocka_unit_test(test_paths),    cmocka_unit_test(test_work),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
