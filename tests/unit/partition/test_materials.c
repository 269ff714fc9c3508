/* Materials of a case as the kernels take them: constants, waves, fields. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "base/mem.h"
#include "base/principal.h"
#include "base/stiffness.h"
#include "partition/material.h"

static void assert_near(double found, double expected) {
    if (!(fabs(found - expected) <= 4e-15 * fabs(expected))) {
        fail_msg("%.17g instead of %.17g", found, expected);
    }
}

/* Bulk modulus E/(3 (1 - 2 nu)), shear modulus E/(2 (1 + nu)); K = lambda + 2/3 mu. */
static void test_elastic(void **state) {
    (void)state;
    for (rg_material_model model = 0; model < RG_MATERIAL_MODELS; model++) {
        if ((rg_material_inside(model) & RG_TAKES_YOUNG) == 0) {
            continue;
        }
        rg_material_input in = {.model = model, .young = 210e9, .poisson = 0.3, .density = 7800};
        for (int p = 0; p < RG_PARAMETERS; p++) {
            in.parameter[p] = 1e6 * (p + 2);
        }
        rg_material m = rg_material_make(&in);
        assert_true(m.model == model && m.density == 7800);
        assert_near(m.mu, 210e9 / 2.6);
        assert_near(m.lambda + 2 * m.mu / 3, 210e9 / 1.2);
        assert_near(rg_material_dilatational(&m), sqrt((210e9 / 1.2 + 4 * 210e9 / 2.6 / 3) / 7800));
        assert_near(rg_material_shear(&m), sqrt(210e9 / 2.6 / 7800));
        assert_memory_equal(m.of.parameter, in.parameter, sizeof in.parameter);
    }
}

/* Speeds from the moduli at rest: mu = 2 (c10 + c01), K + 4/3 mu. */
static void test_rubber(void **state) {
    rg_material_input in = {.model = RG_MATERIAL_MOONEY_RIVLIN, .density = 1100};
    (void)state;
    in.parameter[RG_PARAMETER_BULK] = 2e9;
    in.parameter[RG_PARAMETER_C10] = 0.3e6;
    in.parameter[RG_PARAMETER_C01] = 0.1e6;
    rg_material m = rg_material_make(&in);
    assert_near(rg_material_shear(&m), sqrt(0.8e6 / 1100));
    assert_near(rg_material_dilatational(&m), sqrt((2e9 + 4 * 0.8e6 / 3) / 1100));
    assert_memory_equal(m.of.parameter, in.parameter, sizeof in.parameter);
}

/* mu = sum mu alpha/2. */
static void test_ogden(void **state) {
    rg_material_input in = {.model = RG_MATERIAL_OGDEN, .density = 1100};
    (void)state;
    in.parameter[RG_PARAMETER_BULK] = 2e9;
    in.parameter[RG_PARAMETER_MU_1] = 0.6e6;
    in.parameter[RG_PARAMETER_ALPHA_1] = 1.3;
    in.parameter[RG_PARAMETER_MU_3] = -0.01e6;
    in.parameter[RG_PARAMETER_ALPHA_3] = -2;
    rg_material m = rg_material_make(&in);
    assert_near(rg_material_shear(&m), sqrt(0.4e6 / 1100));
    assert_near(rg_material_dilatational(&m), sqrt((2e9 + 4 * 0.4e6 / 3) / 1100));
}

static void test_ceramic(void **state) {
    (void)state;
    for (int derived = 0; derived < 2; derived++) {
        rg_material_input in = {.model = RG_MATERIAL_DESHPANDE_EVANS,
                                .poisson = 0.2,
                                .density = 3700,
                                .interaction = derived ? RG_INTERACTION_DERIVED : RG_INTERACTION_THESIS};
        in.deshpande_evans = (rg_deshpande_evans){
            .shear = 146e9, .flaw_radius = 19e-6, .flaw_density = 1e12, .toughness = 3e6};
        in.parameter[RG_PARAMETER_YIELD_STRESS] = 4e9;
        rg_material m = rg_material_make(&in);
        const rg_deshpande_evans *p = &m.of.deshpande_evans.parameters;
        assert_true(p->shear == 146e9 && p->poisson == 0.2 && p->density == 3700 && p->yield_stress == 4e9);
        assert_true(p->flaw_radius == 19e-6 && p->flaw_density == 1e12 && p->toughness == 3e6);
        assert_int_equal(p->single_pi, derived);
        assert_near(m.mu, 146e9);
        /* Young's modulus 2 (1 + nu) G, from it K */
        assert_near(m.lambda + 2 * m.mu / 3, 2 * 1.2 * 146e9 / (3 * 0.6));
        double limit = 1, speed = 2;
        assert_false(rg_material_plastic_wave(&m, &limit, &speed));
        assert_true(limit == 1 && speed == 2);
    }
}

/* Elastic limit in uniaxial strain: s_zz - s_xx = sY, where s_xx = lambda/(lambda + 2 mu) s_zz. Beyond it, in
 * small steps of strain e: the stress deviates less, ds = K de + 2/3 dsY, and the yield stress follows the
 * plastic strain, dsY = H dep, which the shear strain splits: dsY = 2 G (de - 3/2 dep). */
static void test_plastic_wave(void **state) {
    (void)state;
    static const double given[][4] = {
        {2e8, 0, 2e8, 0}, {2e8, 3e9, 0, 0}, {2e8, 3e9, 5e8, 12}, {2e8, 3e9, 1e8, 12}, {2e8, 0, 5e8, 40}};
    for (size_t k = 0; k < sizeof given / sizeof *given; k++) {
        rg_material_input in = {.model = RG_MATERIAL_J2, .young = 70e9, .poisson = 0.33, .density = 2700};
        in.parameter[RG_PARAMETER_YIELD_STRESS] = given[k][0];
        in.parameter[RG_PARAMETER_HARDENING] = given[k][1];
        in.parameter[RG_PARAMETER_SATURATION_STRESS] = given[k][2];
        in.parameter[RG_PARAMETER_SATURATION_RATE] = given[k][3];
        rg_material m = rg_material_make(&in);
        double G = 70e9 / 2.66, K = 70e9 / (3 * 0.34), lambda = K - 2 * G / 3, limit, speed;
        double H = given[k][1] + (given[k][2] > given[k][0] ? given[k][2] - given[k][0] : 0) * given[k][3];
        assert_true(rg_material_plastic_wave(&m, &limit, &speed));
        assert_near(limit, given[k][0] / (1 - lambda / (lambda + 2 * G)));
        double strain = 1, plastic = 2 * G * strain / (H + 3 * G), yield = H * plastic;
        assert_near(speed, sqrt((K * strain + 2 * yield / 3) / strain / 2700));
    }
}

/* ---- an anisotropic solid ---- */

static const rg_anisotropic_input copper = {.stiffness = {168.4e9, 121.4e9, 121.4e9, 0, 0,       0, 168.4e9,
                                                          121.4e9, 0,       0,       0, 168.4e9, 0, 0,
                                                          0,       75.4e9,  0,       0, 75.4e9,  0, 75.4e9}};

static rg_material crystal(const rg_anisotropic_input *in) {
    return rg_material_make(
        &(rg_material_input){.model = RG_MATERIAL_ANISOTROPIC, .density = 8960, .anisotropic = *in});
}

static void assert_close(double found, double expected, double tolerance) {
    if (!(fabs(found - expected) <= tolerance)) {
        fail_msg("%.17g instead of %.17g", found, expected);
    }
}

static void assert_same_stiffness(const rg_material *a, const rg_material *b) {
    for (int k = 0; k < RG_STIFFNESS; k++) {
        assert_close(a->of.anisotropic.stiffness[k], b->of.anisotropic.stiffness[k], 2e-3);
    }
}

/* By Young's moduli that are all alike it is the isotropic solid, face by face. */
static void test_isotropic(void **state) {
    const rg_anisotropic_input in = {.young = {210e9, 210e9, 210e9},
                                     .poisson = {0.3, 0.3, 0.3},
                                     .shear = {210e9 / 2.6, 210e9 / 2.6, 210e9 / 2.6},
                                     .angles = {20, 50, -70}};
    const rg_material m = crystal(&in),
                      other = rg_material_make(&(rg_material_input){
                          .model = RG_MATERIAL_NEO_HOOKEAN, .young = 210e9, .poisson = 0.3, .density = 8960});
    const double n[3] = {0.48, -0.6, 0.64};
    double lambda, mu, z[6], expected[6];
    (void)state;
    assert_close(m.lambda, other.lambda, 1e-14 * other.lambda);
    assert_close(m.mu, other.mu, 1e-14 * other.mu);
    assert_close(rg_material_modulus(&m), rg_material_modulus(&other), 1e-14 * other.mu);
    assert_close(m.of.anisotropic.softest, rg_material_modulus(&other), 1e-14 * other.mu);
    rg_material_face(&m, n, &lambda, &mu);
    assert_close(lambda, other.lambda, 2e-14 * other.mu);
    assert_close(mu, other.mu, 2e-14 * other.mu);
    rg_material_impedance(&m, n, z);
    rg_material_impedance(&other, n, expected);
    for (int k = 0; k < 6; k++) {
        assert_close(z[k], expected[k], 1e-11);
    }
    assert_close(rg_material_slowest(&m), rg_material_shear(&other), 1e-3);
    rg_material_face(&other, n, &lambda, &mu);
    assert_true(lambda == other.lambda && mu == other.mu);
}

/* The same axes as directions and as angles; those of a quarter turn about z by hand. */
static void test_axes(void **state) {
    const double degree = acos(-1) / 180, p = 30 * degree, t = 40 * degree, q = -100 * degree;
    rg_anisotropic_input one = copper, other = copper;
    (void)state;
    for (int i = 0, at = 0; i < 6; i++) { /* of no symmetry */
        for (int j = i; j < 6; j++, at++) {
            one.stiffness[at] += 1e9 * (at + 1);
        }
    }
    memcpy(other.stiffness, one.stiffness, sizeof one.stiffness);
    /* Axes of x y z turned by phi1 about z, then by Phi about the new x, then by phi2 about the new z. */
    const double x[3] = {cos(p), sin(p), 0}, y[3] = {-sin(p) * cos(t), cos(p) * cos(t), sin(t)};
    for (int k = 0; k < 3; k++) {
        one.axis[0][k] = 3 * (cos(q) * x[k] + sin(q) * y[k]);
        one.axis[1][k] = 0.1 * (cos(q) * y[k] - sin(q) * x[k]) + 7 * one.axis[0][k]; /* not across */
    }
    other.angles[0] = 30;
    other.angles[1] = 40;
    other.angles[2] = -100;
    rg_material a = crystal(&one), b = crystal(&other);
    assert_same_stiffness(&a, &b);
    memset(one.axis, 0, sizeof one.axis);
    one.axis[0][1] = 1; /* its 1 is y, its 2 is -x */
    one.axis[1][0] = -1;
    a = crystal(&one);
    assert_close(a.of.anisotropic.stiffness[6], one.stiffness[0], 1e-4);   /* 22 from 11 */
    assert_close(a.of.anisotropic.stiffness[7], one.stiffness[2], 1e-4);   /* 23 from 13 */
    assert_close(a.of.anisotropic.stiffness[5], -one.stiffness[10], 1e-4); /* 11,12 from 22,12 */
}

/* What stands for a face is no less than the acoustic tensor, and touches it along [100]; impedances squared
 * are that tensor over the density. */
static void test_faces(void **state) {
    rg_anisotropic_input in = copper;
    (void)state;
    for (int k = 0; k < 200; k++) {
        static const int first[6] = {0, 1, 2, 1, 0, 0}, second[6] = {0, 1, 2, 2, 2, 1};
        in.angles[0] = 37.0 * k;
        in.angles[1] = 101.0 * k;
        const rg_material m = crystal(&in);
        const double u = -0.995 + 0.01 * k, r = sqrt(1 - u * u), n[3] = {r * cos(k), r * sin(k), u};
        double A[6], value[3], lambda, mu, z[6];
        rg_stiffness_acoustic(m.of.anisotropic.stiffness, n, A);
        rg_material_impedance(&m, n, z);
        for (int c = 0; c < 6; c++) {
            static const int at[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};
            double square = 0;
            for (int j = 0; j < 3; j++) {
                square += z[at[first[c]][j]] * z[at[j][second[c]]];
            }
            assert_close(square * 8960, A[c], 5e-15 * 2e11);
        }
        rg_material_face(&m, n, &lambda, &mu);
        for (int c = 0; c < 6; c++) { /* what stands for it, less the tensor */
            A[c] = (lambda + mu) * n[first[c]] * n[second[c]] + (c < 3 ? mu : 0) - A[c];
        }
        rg_principal(A, value);
        assert_true(value[2] > -1e-4 && value[0] < 0.35 * rg_material_modulus(&m));
    }
    const rg_material m = crystal(&copper);
    double lambda, mu;
    rg_material_face(&m, (const double[3]){0, 1, 0}, &lambda, &mu);
    assert_close(lambda + 2 * mu, 168.4e9, 1e-3);
    assert_close(mu, 75.4e9, 1e-3);
}

/* Grains of one crystal, and then one of another. */
static void test_grains(void **state) {
    rg_other_material other[2] = {
        {.is = {.model = RG_MATERIAL_ANISOTROPIC, .density = 8960, .anisotropic = copper}},
        {.is = {.model = RG_MATERIAL_ANISOTROPIC, .density = 8960, .anisotropic = copper}}};
    other[0].is.anisotropic.angles[1] = 45;
    other[1].is.anisotropic.stiffness[0] = 200e9;
    rg_case c = {.material = {.model = RG_MATERIAL_ANISOTROPIC, .density = 8960, .anisotropic = copper},
                 .others = 2,
                 .other = other};
    (void)state;
    rg_material *all = rg_materials_of_case(&c);
    for (int i = 0; i < 3; i++) {
        rg_material alone = rg_material_make(rg_case_material(&c, i));
        assert_memory_equal(&all[i].of.anisotropic, &alone.of.anisotropic, sizeof alone.of.anisotropic);
    }
    assert_close(all[1].of.anisotropic.stiffest, (168.4e9 + 2 * 121.4e9 + 4 * 75.4e9) / 3, 1e5);
    rg_free(all);
}

/* ---- fields ---- */

static void test_of_case(void **state) {
    (void)state;
    rg_other_material other[2] = {
        {.is = {.model = RG_MATERIAL_J2, .young = 5, .poisson = 0.1, .density = 6}},
        {.is = {.model = RG_MATERIAL_NEO_HOOKEAN, .young = 7, .poisson = 0.2, .density = 8}}};
    rg_case c = {.material = {.model = RG_MATERIAL_LINEAR_ELASTIC, .young = 3, .poisson = 0.3, .density = 4},
                 .others = 2,
                 .other = other};
    rg_material *all = rg_materials_of_case(&c);
    assert_true(all[0].density == 4 && all[1].density == 6 && all[2].density == 8);
    assert_near(all[0].mu, 3 / 2.6);
    assert_near(all[1].mu, 5 / 2.2);
    assert_near(all[2].mu, 7 / 2.4);
    rg_free(all);
}

static void test_fields(void **state) {
    (void)state;
    const unsigned plastic = RG_FIELD_PLASTIC | RG_FIELD_TRIAXIALITY,
                   ceramic = plastic | RG_FIELD_DAMAGE | RG_FIELD_REGIME;
    static const rg_material_model models[] = {RG_MATERIAL_NEO_HOOKEAN,       RG_MATERIAL_J2,
                                               RG_MATERIAL_DESHPANDE_EVANS,   RG_MATERIAL_JOHNSON_COOK,
                                               RG_MATERIAL_JOHNSON_HOLMQUIST, RG_MATERIAL_DRUCKER_PRAGER};
    const unsigned own[] = {0,
                            plastic,
                            ceramic,
                            plastic | RG_FIELD_TEMPERATURE,
                            plastic | RG_FIELD_DAMAGE | RG_FIELD_BULKING,
                            plastic | RG_FIELD_VOLUME};
    const int count = sizeof models / sizeof *models;
    for (int a = 0; a < count; a++) {
        rg_case c = {.material = {.model = models[a]}};
        assert_int_equal(rg_case_default_fields(&c), RG_FIELDS_COMMON | own[a]);
        assert_int_equal(rg_case_possible_fields(&c), RG_FIELDS_COMMON | RG_FIELD_RANK |
                                                          RG_FIELD_TRIAXIALITY | RG_FIELD_MATERIAL | own[a]);
        for (int b = 0; b < count; b++) {
            rg_other_material other[2] = {{.is = {.model = RG_MATERIAL_LINEAR_ELASTIC}},
                                          {.is = {.model = models[b]}}};
            c.others = 2;
            c.other = other;
            assert_int_equal(rg_case_default_fields(&c),
                             RG_FIELDS_COMMON | RG_FIELD_MATERIAL | own[a] | own[b]);
            assert_int_equal(rg_case_possible_fields(&c), RG_FIELDS_COMMON | RG_FIELD_RANK |
                                                              RG_FIELD_TRIAXIALITY | RG_FIELD_MATERIAL |
                                                              own[a] | own[b]);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_elastic), cmocka_unit_test(test_isotropic), cmocka_unit_test(test_axes),
        cmocka_unit_test(test_faces),   cmocka_unit_test(test_grains),    cmocka_unit_test(test_rubber),
        cmocka_unit_test(test_ogden),   cmocka_unit_test(test_ceramic),   cmocka_unit_test(test_plastic_wave),
        cmocka_unit_test(test_of_case), cmocka_unit_test(test_fields),
    };
    int failed = cmocka_run_group_tests_name("materials", tests, NULL, NULL);
    return failed + (rg_alloc_blocks() > 0); /* all is given back */
}
