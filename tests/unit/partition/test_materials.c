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
    static const rg_material_model models[] = {RG_MATERIAL_NEO_HOOKEAN, RG_MATERIAL_J2,
                                               RG_MATERIAL_DESHPANDE_EVANS};
    const unsigned own[] = {0, plastic, ceramic};
    for (int a = 0; a < 3; a++) {
        rg_case c = {.material = {.model = models[a]}};
        assert_int_equal(rg_case_default_fields(&c), RG_FIELDS_COMMON | own[a]);
        assert_int_equal(rg_case_possible_fields(&c), RG_FIELDS_COMMON | RG_FIELD_RANK |
                                                          RG_FIELD_TRIAXIALITY | RG_FIELD_MATERIAL | own[a]);
        for (int b = 0; b < 3; b++) {
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
        cmocka_unit_test(test_elastic), cmocka_unit_test(test_ceramic), cmocka_unit_test(test_plastic_wave),
        cmocka_unit_test(test_of_case), cmocka_unit_test(test_fields),
    };
    int failed = cmocka_run_group_tests_name("materials", tests, NULL, NULL);
    return failed + (rg_alloc_blocks() > 0); /* all is given back */
}
