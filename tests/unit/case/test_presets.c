/* Solids by name: what a preset fills, what stays, what is refused, and that each is a solid. */
#include <math.h>

#include "case/preset.h"
#include "support/case_input.h"

static const char of_name[] = "mesh: {cells: [1, 1, 2], size: [1, 1, 2]}\n"
                              "material: {preset: pmma}\n"
                              "interface: {law: none}\n"
                              "time: {end: 1e-6}\n";

static void test_fills(void **state) {
    (void)state;
    write_bytes(of_name, strlen(of_name));
    static const char *const set[] = {
        "material.density=1200",
        "materials=[{name: s, where: 'z > 1', preset: maraging-steel, model: linear-elastic, poisson: 0}]"};
    rg_case *c = read_good(path, 2, set);
    const rg_material_input *m = &c->material, *s = &c->other[0].is;
    assert_true(m->model == RG_MATERIAL_NEO_HOOKEAN && m->young == 3.24e9 && m->poisson == 0.35);
    assert_true(m->density == 1200); /* what is given stays */
    assert_true(s->model == RG_MATERIAL_LINEAR_ELASTIC && s->young == 190e9 && s->poisson == 0 &&
                s->density == 8000);
    assert_string_equal(m->preset, "pmma");
    rg_case_free(c);
}

/* Keys that the model has no use for are left out; what it needs besides is missing, at the preset's place.
 */
static void test_other_models(void **state) {
    (void)state;
    write_bytes(of_name, strlen(of_name));
#ifndef RG_SINGLE
    static const char *const flows[] = {"material.model=j2", "material.yield_stress=60e6"};
    rg_case *c = read_good(path, 2, flows);
    assert_true(c->material.young == 3.24e9 && c->material.parameter[RG_PARAMETER_YIELD_STRESS] == 60e6);
    rg_case_free(c);
    expect_messages(1, flows, ":2:11: material.yield_stress: missing; allowed: number > 0 (Pa)\n");
    static const char *const cracks[] = {
        "material={preset: pmma, model: deshpande-evans, shear: 1e9, flaw_radius: 19e-6, flaw_density: 1e12, "
        "toughness: 3e6, yield_stress: 4e9}"};
    c = read_good(path, 1, cracks);
    assert_true(c->material.young == 0 && c->material.poisson == 0.35 && c->material.density == 1190);
    rg_case_free(c);
#endif
}

static void test_refused(void **state) {
    (void)state;
#define NAMES                                                                                                \
    "allowed: alumina-seagraves, alumina-ad995, silicon-carbide, boron-carbide, soda-lime-glass, pmma, "     \
    "granite, concrete, maraging-steel, concrete-hjc, alumina-jh2, boron-carbide-jh2, silicon-carbide-jh2, " \
    "float-glass-jh2, steel-4340, copper-ofhc, berea-sandstone, pmma-viscoelastic"
    write_bytes(of_name, strlen(of_name));
    static const char *const near[] = {"material.preset=pma"};
    expect_messages(1, near,
                    "--set material.preset=pma: material.preset: pma: no such preset (rhegma materials lists "
                    "them); " NAMES "; did you mean 'pmma'?\n");
    static const char *const list[] = {
        "materials=[{name: b, where: 1, preset: [1], model: neo-hookean, young: 1, poisson: 0, density: 1}]"};
    expect_messages(
        1, list,
        "--set materials=[{name: b, where: 1, preset: [1], model: neo-hookean, young: 1, poisson: "
        "0, density: 1}]: materials[0].preset: [1]: no such preset (rhegma materials lists "
        "them); " NAMES "\n");
}

/* Each is a case that reads, of a solid: waves between 1 and 15 km/s, a crack that opens between nanometres
 * and millimetres, and lines that a person can read. */
static void test_each(void **state) {
    (void)state;
    write_bytes(of_name, strlen(of_name));
    for (int i = 0; i < RG_PRESETS; i++) {
        const rg_preset *p = &rg_preset_list[i];
        char change[80];
        snprintf(change, sizeof change, "material.preset=%s", p->name);
        const char *const set[] = {change};
#ifdef RG_SINGLE /* the others are refused */
        if (strstr(p->block, "neo-hookean") == NULL) {
            continue;
        }
#endif
        rg_case *c = read_good(path, 1, set);
        const rg_material_input *m = &c->material;
        double nu = m->poisson, speed = sqrt(m->young * (1 - nu) / ((1 + nu) * (1 - 2 * nu)) / m->density);
        assert_true(speed > 1e3 && speed < 15e3);
        assert_true(2 * p->energy / p->strength > 1e-8 && 2 * p->energy / p->strength < 1e-3);
        assert_true(strlen(p->source) > 20 && strlen(p->validity) > 10 && rg_preset_find(p->name) == p);
        rg_case_free(c);
    }
    assert_null(rg_preset_find("pmm"));
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    rg_preset_print(rg_preset_find("concrete"), out);
    fclose(out);
    assert_string_equal(
        text, "concrete: plain concrete, 53 MPa in compression\n\n"
              "material: {preset: concrete}   # the same as {model: neo-hookean, young: 36e9, poisson: 0.18, "
              "density: 2400}\n"
              "interface: {law: linear, strength: 3.8e+06, energy: 65}   # Pa, J/m2\n\n"
              "source    J. Ozbolt, J. Bosnjak & E. Sola, Eng. Fract. Mech. 110 (2013) 88: dynamic compact "
              "tension\n"
              "validity  elastic in compression: crushing is not in it\n");
    free(text);
}

/* Strength (Pa) and energy (J/m2) of cracks, read from the sources a second time: a slip of the keyboard in a
 * table is seen by nothing else. */
static void test_cracks(void **state) {
    (void)state;
    static const struct {
        const char *name;
        double strength, energy;
    } known[] = {{"alumina-seagraves", 4e8, 34},
                 {"alumina-ad995", 2.62e8, 52},
                 {"silicon-carbide", 2.5e8, 22.6},
                 {"boron-carbide", 3.5e8, 13.2},
                 {"soda-lime-glass", 6e7, 7.4},
                 {"pmma", 1.296e8, 352.3},
                 {"granite", 1.28e7, 24},
                 {"concrete", 3.8e6, 65},
                 {"maraging-steel", 8.44e8, 22130},
                 {"concrete-hjc", 4e6, 65},
                 {"alumina-jh2", 2.62e8, 52},
                 {"boron-carbide-jh2", 3.5e8, 13.2},
                 {"silicon-carbide-jh2", 2.5e8, 22.6},
                 {"float-glass-jh2", 6e7, 7.4},
                 {"steel-4340", 2.4e9, 2e4},
                 {"copper-ofhc", 1.2e9, 2e4},
                 {"berea-sandstone", 5e6, 6.4},
                 {"pmma-viscoelastic", 1.296e8, 352.3}};
    assert_int_equal(sizeof known / sizeof *known, RG_PRESETS);
    for (int i = 0; i < RG_PRESETS; i++) {
        const rg_preset *p = rg_preset_find(known[i].name);
        assert_non_null(p);
        assert_true(p->strength == known[i].strength && p->energy == known[i].energy);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fills), cmocka_unit_test(test_other_models), cmocka_unit_test(test_refused),
        cmocka_unit_test(test_each),  cmocka_unit_test(test_cracks),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
