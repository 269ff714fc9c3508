/* The range of every number of a case file: both ends from both sides, and the words for it. */
#include "case/read.h"
#include "support/case_input.h"

#define BODY(more) "bodies=[{name: b, shape: sphere, motion: free, at: [0, 0, 1], " more "}]"

static const struct {
    const char *set;                              /* "key=..." with %s where the value goes */
    const char *lowest, *below, *highest, *above; /* good, bad, good, bad; NULL: there is none */
    const char *key, *allowed;                    /* in the message */
    const char *other;                            /* an override that the key needs */
    const char *solid;                            /* NULL: the base case's */
} ranges[] = {
    {"mesh.cells=[1, %s, 1]", "1", "0", "100000", "100001", "mesh.cells[1]", "integer >= 1 and <= 100000",
     NULL, NULL},
    {"mesh.size=[1, 1, %s]", "1e-300", "0", "1e300", NULL, "mesh.size[2]", "number > 0 (m)",
     "output.probes=[]", NULL},
    {"mesh.origin=[%s, 0, 0]", "-1e300", NULL, "1e300", NULL, "mesh.origin[0]", "number (m)",
     "output.probes=[]", NULL},
    {"mesh.jitter=%s", "0", "-1e-9", "0.3", "0.300001", "mesh.jitter", "number >= 0 and <= 0.3", NULL, NULL},
    {"mesh.seed=%s", "0", "-1", "9223372036854775807", NULL, "mesh.seed", "integer >= 0", NULL, NULL},
    {"mesh.rebalance=%s", "0", "-1e-9", "1e300", NULL, "mesh.rebalance", "number >= 0", NULL, NULL},
    {"material.young=%s", "1e-9", "0", "1e300", NULL, "material.young", "number > 0 (Pa)", NULL, NULL},
    {"material.poisson=%s", "0", "-1e-9", "0.499999", "0.5", "material.poisson", "number >= 0 and < 0.5",
     NULL, NULL},
    {"material.density=%s", "1e-9", "0", "1e300", NULL, "material.density", "number > 0 (kg/m3)", NULL, NULL},
    {"materials=[{name: a, where: 1, model: neo-hookean, young: 1, poisson: 0.25, density: %s}]", "1e-9", "0",
     "1e300", NULL, "materials[0].density", "number > 0 (kg/m3)", NULL, NULL},
    {"materials=[{name: a, where: 1, model: neo-hookean, young: 1, poisson: %s, density: 1}]", "0", "-1e-9",
     "0.499999", "0.5", "materials[0].poisson", "number >= 0 and < 0.5", NULL, NULL},
    {"interface.beta_s=%s", "1e-9", "0", "1e9", NULL, "interface.beta_s", "number > 0", NULL, NULL},
    {"interface.strength=%s", "1e-9", "0", "1e300", NULL, "interface.strength",
     "number > 0, or expression in x, y, z, nx, ny, nz (Pa)", NULL, NULL},
    {"interface.energy=%s", "1e-9", "0", "1e300", NULL, "interface.energy",
     "number > 0, or expression in x, y, z, nx, ny, nz (J/m2)", NULL, NULL},
    {"interface.beta=%s", "0", "-1e-9", "1e9", NULL, "interface.beta", "number >= 0", NULL, NULL},
    {"interface.onset=%s", "1e-9", "0", "1", "1.000001", "interface.onset", "number > 0 and <= 1",
     "interface.activation=conserving", NULL},
    {"interface.friction=%s", "0", "-1e-9", "1e9", NULL, "interface.friction", "number >= 0", NULL, NULL},
    {"interface.sets=[{where: 1, strength: %s}]", "1e-9", "0", "1e300", NULL, "interface.sets[0].strength",
     "number > 0, or expression in x, y, z, nx, ny, nz (Pa)", NULL, NULL},
    {"interface.sets=[{where: 1, energy: %s}]", "1e-9", "0", "1e300", NULL, "interface.sets[0].energy",
     "number > 0, or expression in x, y, z, nx, ny, nz (J/m2)", NULL, NULL},
    {"interface.sets=[{where: 1, beta: %s}]", "0", "-1e-9", "1e300", NULL, "interface.sets[0].beta",
     "number >= 0, or expression in x, y, z, nx, ny, nz", NULL, NULL},
    {"interface.sets=[{where: 1, friction: %s}]", "0", "-1e-9", "1e300", NULL, "interface.sets[0].friction",
     "number >= 0, or expression in x, y, z, nx, ny, nz", NULL, NULL},
    {"interface.sets=[{where: 1, weibull: {area: 1, modulus: %s}}]", "1e-9", "0", "1e9", NULL,
     "interface.sets[0].weibull.modulus", "number > 0", NULL, NULL},
    {"interface.sets=[{where: 1, weibull: {modulus: 1, area: %s}}]", "1e-9", "0", "1e9", NULL,
     "interface.sets[0].weibull.area", "number > 0 (m2)", NULL, NULL},
    {"interface.sets=[{where: 1, weibull: {modulus: 1, area: 1, seed: %s}}]", "1", "0", "9223372036854775807",
     NULL, "interface.sets[0].weibull.seed", "integer >= 1", NULL, NULL},
    {"interface.weibull={area: 1, modulus: %s}", "1e-9", "0", "1e9", NULL, "interface.weibull.modulus",
     "number > 0", NULL, NULL},
    {"interface.weibull={modulus: 1, area: %s}", "1e-9", "0", "1e9", NULL, "interface.weibull.area",
     "number > 0 (m2)", NULL, NULL},
    {"interface.weibull={modulus: 1, area: 1, seed: %s}", "0", "-1", "9223372036854775807", NULL,
     "interface.weibull.seed", "integer >= 0", NULL, NULL},
    {"contact={model: general, penalty: %s}", "1e-9", "0", "1e9", NULL, "contact.penalty", "number > 0", NULL,
     NULL},
    {"contact={model: general, damping: %s}", "0", "-1e-9", "1e9", NULL, "contact.damping",
     "number >= 0 (s/m)", NULL, NULL},
    {"viscosity.linear=%s", "0", "-1e-9", "1e9", NULL, "viscosity.linear", "number >= 0", NULL, NULL},
    {"viscosity.quadratic=%s", "0", "-1e-9", "1e9", NULL, "viscosity.quadratic", "number >= 0", NULL, NULL},
    {"time.end=%s", "1e-9", "0", "1e300", NULL, "time.end", "number > 0 (s)", NULL, NULL},
    {"time.safety=%s", "1e-9", "0", "1", "1.000001", "time.safety", "number > 0 and <= 1", NULL, NULL},
    {"time.steps=%s", "1", "0", "9223372036854775807", "9223372036854775808", "time.steps", "integer >= 1",
     NULL, NULL},
    {"time.collapse=%s", "0", "-1e-9", "0.999999", "1", "time.collapse", "number >= 0 and < 1", NULL, NULL},
    {"output.interval=%s", "1", "0", "9223372036854775807", NULL, "output.interval",
     "integer >= 1 (steps), or number > 0 and < 1 (simulated seconds)", NULL, NULL},
    {"output.interval=%s", "1e-9", "0.0", "0.999999", "1.0", "output.interval",
     "integer >= 1 (steps), or number > 0 and < 1 (simulated seconds)", NULL, NULL},
    {"output.times=[%s]", "0", "-1e-9", "1e-6", NULL, "output.times[0]", "number >= 0 (s)", NULL, NULL},
    {"output.compression=%s", "0", "-1", "9", "10", "output.compression", "integer >= 0 and <= 9", NULL,
     NULL},
    {"output.energy_limit=%s", "1e-9", "0", "1e9", NULL, "output.energy_limit", "number > 0", NULL, NULL},
    {"checkpoint.steps=%s", "0", "-1", "9223372036854775807", NULL, "checkpoint.steps", "integer >= 0", NULL,
     NULL},
    {"checkpoint.time=%s", "0", "-1e-9", "1e9", NULL, "checkpoint.time", "number >= 0 (s)", NULL, NULL},
    {"checkpoint.wall_time=%s", "0", "-1e-9", "1e9", NULL, "checkpoint.wall_time", "number >= 0 (s)", NULL,
     NULL},
    {"checkpoint.keep=%s", "1", "0", "1000", "1001", "checkpoint.keep", "integer >= 1 and <= 1000", NULL,
     NULL},
    {BODY("radius: %s, mass: 1"), "1e-9", "0", "1e9", NULL, "bodies[0].radius", "number > 0 (m)", NULL, NULL},
    {BODY("radius: 1, mass: %s"), "1e-9", "0", "1e9", NULL, "bodies[0].mass", "number > 0 (kg)", NULL, NULL},
    {BODY("radius: 1, density: %s"), "1e-9", "0", "1e9", NULL, "bodies[0].density", "number > 0 (kg/m3)",
     NULL, NULL},
    {BODY("radius: 1, mass: 1, penalty: %s"), "1e-9", "0", "1e9", NULL, "bodies[0].penalty", "number > 0",
     NULL, NULL},
#ifndef RG_SINGLE
    {"material.shear=%s", "1e-9", "0", "1e300", NULL, "material.shear", "number > 0 (Pa)", NULL, ceramic},
    {"material.flaw_radius=%s", "1e-9", "0", "1e-5", NULL, "material.flaw_radius", "number > 0 (m)", NULL,
     ceramic},
    {"material.flaw_density=%s", "1e-9", "0", "1e12", NULL, "material.flaw_density", "number > 0 (1/m3)",
     NULL, ceramic},
    {"material.alpha=%s", "1e-9", "0", "1", "1.000001", "material.alpha", "number > 0 and <= 1", NULL,
     ceramic},
    {"material.beta=%s", "1e-9", "0", "1e9", NULL, "material.beta", "number > 0", NULL, ceramic},
    {"material.gamma=%s", "1e-9", "0", "1e9", NULL, "material.gamma", "number > 0", NULL, ceramic},
    {"material.friction=%s", "0", "-1e-9", "1e9", NULL, "material.friction", "number >= 0", NULL, ceramic},
    {"material.toughness=%s", "1e-9", "0", "1e9", NULL, "material.toughness", "number > 0 (Pa sqrt(m))", NULL,
     ceramic},
    {"material.growth_speed=%s", "1e-9", "0", "1e9", NULL, "material.growth_speed", "number > 0 (m/s)", NULL,
     ceramic},
    {"material.growth_exponent=%s", "1e-9", "0", "1e9", NULL, "material.growth_exponent", "number > 0", NULL,
     ceramic},
    {"material.damage_max=%s", "0.1", "0", "0.999999", "1", "material.damage_max", "number > 0 and < 1", NULL,
     ceramic},
    {"material.yield_stress=%s", "1e-9", "0", "1e300", NULL, "material.yield_stress", "number > 0 (Pa)", NULL,
     ceramic},
    {"material.yield_strain=%s", "1e-9", "0", "1e9", NULL, "material.yield_strain", "number > 0", NULL,
     ceramic},
    {"material.hardening_exponent=%s", "0", "-1e-9", "1", "1.000001", "material.hardening_exponent",
     "number >= 0 and <= 1", NULL, ceramic},
    {"material.plastic_rate=%s", "1e-9", "0", "1e9", NULL, "material.plastic_rate", "number > 0 (1/s)", NULL,
     ceramic},
    {"material.transition_rate=%s", "1e-9", "0", "1e9", NULL, "material.transition_rate", "number > 0 (1/s)",
     NULL, ceramic},
    {"material.rate_exponent=%s", "1", "0.999999", "1e9", NULL, "material.rate_exponent", "number >= 1", NULL,
     ceramic},
    {"material.yield_stress=%s", "1e-9", "0", "1e300", NULL, "material.yield_stress", "number > 0 (Pa)", NULL,
     metal},
    {"material.hardening=%s", "0", "-1e-9", "1e300", NULL, "material.hardening", "number >= 0 (Pa)", NULL,
     metal},
    {"material.saturation_rate=%s", "1e-9", "-1e-9", "1e300", NULL, "material.saturation_rate", "number >= 0",
     "material.saturation_stress=5e8", metal},
    {"material.saturation_stress=%s", "4e8", "-1e-9", "1e300", NULL, "material.saturation_stress",
     "number >= 0 (Pa)", "material.saturation_rate=5", metal},
#endif
};

/* Writes the overrides of case i, `text` the one with the value, to `set`; returns their number. */
static int options(size_t i, const char *set[2], char text[512], const char *value) {
    int count = 0;
    if (ranges[i].other != NULL) {
        set[count++] = ranges[i].other;
    }
    snprintf(text, 512, ranges[i].set, value);
    set[count++] = text;
    return count;
}

static void expect_good(size_t i, const char *value) {
    char text[512], *said = NULL;
    const char *set[2];
    int count = options(i, set, text, value);
    rg_case *c = read_case(path, count, set, &said);
    if (c == NULL) {
        fail_msg("%s: %s", text, said);
    }
    rg_case_free(c);
    free(said);
}

static void expect_bad(size_t i, const char *value) {
    char text[512], line[1024], *said = NULL;
    const char *set[2];
    int count = options(i, set, text, value);
    rg_case *c = read_case(path, count, set, &said);
    snprintf(line, sizeof line, "--set %s: %s: %s: out of range; allowed: %s\n", text, ranges[i].key, value,
             ranges[i].allowed);
    assert_string_equal(said, line);
    assert_null(c);
    free(said);
}

static void test_ranges(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++) {
        write_changed(elastic, ranges[i].solid != NULL ? ranges[i].solid : elastic);
        expect_good(i, ranges[i].lowest);
        expect_good(i, ranges[i].highest);
        if (ranges[i].below != NULL) {
            expect_bad(i, ranges[i].below);
        }
        if (ranges[i].above != NULL) {
            expect_bad(i, ranges[i].above);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_ranges)};
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
