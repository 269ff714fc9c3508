/* The case file: what it means, and that its echo reads back bit by bit. */
#include "case/read.h"
#include "case/echo.h"
#include "support/case_input.h"

#include "case/key.h"
#include "partition/material.h"

#include <math.h>

#ifndef RG_SOURCE_ROOT
#define RG_SOURCE_ROOT "." /* run from the root of the tree */
#endif

#define CASES RG_SOURCE_ROOT "/bench/examples/"

/* ---- what a case means ---- */

static void test_values(void **state) {
    (void)state;
    write_bytes(base, strlen(base));
    rg_case *c = read_good(path, 0, NULL);
    const double origin[3] = {0};
    assert_string_equal(c->path, path);
    assert_string_equal(c->name, "bar");
    assert_true(c->mesh.cells[0] == 2 && c->mesh.cells[1] == 2 && c->mesh.cells[2] == 4);
    assert_true(c->mesh.size[0] == 1e-3 && c->mesh.size[1] == 1e-3 && c->mesh.size[2] == 2e-3);
    assert_memory_equal(c->mesh.origin, origin, sizeof origin);
    assert_true(c->material.young == 260e9 && c->material.poisson == 0.21 && c->material.density == 3690);
    assert_true(c->interface.law == RG_LAW_LINEAR && c->interface.strength == 400e6);
    assert_true(c->interface.energy == 34 && c->time.end == 1e-6);
    assert_int_equal(c->boundaries, 1);
    assert_string_equal(c->boundary[0].set, "z+");
    assert_int_equal(c->boundary[0].component, 2);
    assert_int_equal(c->boundary[0].prescribed, RG_PRESCRIBED_VELOCITY);
    assert_string_equal(rg_expr_text(c->boundary[0].value), "6.086");
    assert_int_equal(c->output.probes, 1);
    assert_string_equal(c->output.probe[0].name, "p");
    assert_true(c->output.probe[0].at[2] == 1e-3);
    rg_case_free(c);
}

static void test_defaults(void **state) {
    (void)state;
    write_bytes(base, strlen(base));
    rg_case *c = read_good(path, 0, NULL);
    assert_true(c->mesh.jitter == 0 && c->mesh.seed == 1 && c->mesh.tile == 0 && c->mesh.file == NULL);
    assert_true(c->interface.form == RG_FORM_VARIATIONAL && c->interface.penalty == RG_PENALTY_ELASTIC);
    assert_true(c->defaults == 1 && c->interface.beta_s == 2 && c->interface.beta == 1);
    assert_true(c->interface.activation == RG_ACTIVATION_CONSERVING);
    assert_true(c->interface.contact == RG_CONTACT_POTENTIAL && c->mass == RG_MASS_CONSISTENT);
    assert_true(c->time.safety == 0.875 && c->time.steps == 0);
    assert_string_equal(c->output.dir, "results/bar");
    assert_true(c->output.interval_steps == 0 && c->output.interval_time == 1e-6 / 50);
    assert_true(c->output.fields == RG_FIELDS_COMMON && c->output.energy_limit == 0.05);
    for (int k = 0; k < 3; k++) {
        assert_null(c->initial.displacement[k]);
        assert_null(c->initial.velocity[k]);
    }
    rg_case_free(c);
}

/* What goes with the form, the law and the set of defaults that a case means; what is given stays. */
static void test_defaults_that_follow(void **state) {
    (void)state;
    enum { RATE = 2 };
    static const struct {
        const char *change[4];
        double beta_s, onset, safety;
        rg_activation activation;
        rg_contact contact;
    } known[] = {
        {{"defaults=1"}, 2, 0.5, 0.875, RG_ACTIVATION_CONSERVING, RG_CONTACT_POTENTIAL},
        {{"defaults=0"}, 4, 0.3, 0.5, RG_ACTIVATION_CONTINUOUS, RG_CONTACT_PENALTY},
        {{"defaults=1", "interface.law=rate"}, 2, 0.5, 0.875, RG_ACTIVATION_CONSERVING, RG_CONTACT_POTENTIAL},
        {{"defaults=1", "interface={law: free, strength: 1}"},
         2,
         0.5,
         0.875,
         RG_ACTIVATION_CONSERVING,
         RG_CONTACT_POTENTIAL},
        {{"defaults=1", "interface.form=incomplete"},
         4,
         0.5,
         0.5,
         RG_ACTIVATION_CONTINUOUS,
         RG_CONTACT_PENALTY},
        {{"defaults=1", "interface.form=continuous", "interface.faces=1"},
         4,
         0.5,
         0.5,
         RG_ACTIVATION_CONTINUOUS,
         RG_CONTACT_PENALTY},
        {{"defaults=1", "interface.form=intrinsic", "interface.law=exponential"},
         4,
         0.5,
         0.5,
         RG_ACTIVATION_CONTINUOUS,
         RG_CONTACT_PENALTY},
        {{"defaults=1", "interface.contact=flux"}, 2, 0.5, 0.5, RG_ACTIVATION_CONTINUOUS, RG_CONTACT_FLUX},
        {{"defaults=1", "interface.contact=penalty", "interface.friction=0.5"},
         2,
         0.5,
         0.875,
         RG_ACTIVATION_CONSERVING,
         RG_CONTACT_PENALTY},
        {{"defaults=1", "interface.beta_s=3", "interface.activation=total", "time.safety=0.25"},
         3,
         0.5,
         0.25,
         RG_ACTIVATION_TOTAL,
         RG_CONTACT_POTENTIAL},
        {{"interface={law: none}"}, 2, 0.5, 0.875, RG_ACTIVATION_CONTINUOUS, RG_CONTACT_POTENTIAL},
        {{"defaults=0", "interface.activation=conserving", "interface.contact=potential"},
         4,
         0.3,
         0.5,
         RG_ACTIVATION_CONSERVING,
         RG_CONTACT_POTENTIAL},
    };
    write_bytes(base, strlen(base));
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        int changes = 0;
        if (i == RATE && sizeof(rg_real) < sizeof(double)) {
            continue; /* that law needs double precision */
        }
        while (changes < 4 && known[i].change[changes] != NULL) {
            changes++;
        }
        rg_case *c = read_good(path, changes, known[i].change);
        assert_true(c->interface.beta_s == known[i].beta_s && c->interface.onset == known[i].onset);
        assert_true(c->interface.activation == known[i].activation && c->time.safety == known[i].safety);
        assert_true(c->interface.contact == known[i].contact);
        rg_case_free(c);
    }
}

static void test_overrides(void **state) {
    (void)state;
    static const char *const set[] = {"mesh.cells=[3,3,30]",
                                      "mesh.jitter=0.25",
                                      "mass=lumped",
                                      "interface.form=incomplete",
                                      "output.interval=7",
                                      "output.fields=[]",
                                      "time.steps=12",
                                      "boundary=[{set: x-, component: y, displacement: t}]",
                                      "initial.velocity.z=-z/2e-3",
                                      "output.dir='a=b.c'",
                                      "initial.displacement={x: 1e-6}",
                                      "output.probes=[]"};
    write_bytes(base, strlen(base));
    rg_case *c = read_good(path, sizeof set / sizeof set[0], set);
    assert_true(c->mesh.cells[0] == 3 && c->mesh.cells[2] == 30 && c->mesh.jitter == 0.25);
    assert_true(c->mass == RG_MASS_LUMPED && c->interface.form == RG_FORM_INCOMPLETE);
    assert_true(c->output.interval_steps == 7 && c->output.interval_time == 0);
    assert_true(c->output.fields == 0 && c->time.steps == 12);
    assert_int_equal(c->boundaries, 1);
    assert_string_equal(c->boundary[0].set, "x-");
    assert_true(c->boundary[0].component == 1 && c->boundary[0].prescribed == RG_PRESCRIBED_DISPLACEMENT);
    assert_string_equal(rg_expr_text(c->initial.velocity[2]), "-z/2e-3");
    assert_string_equal(rg_expr_text(c->initial.displacement[0]), "1e-6");
    assert_string_equal(c->output.dir, "a=b.c");
    assert_int_equal(c->output.probes, 0);
    rg_case_free(c);
}

static void test_interval_kinds(void **state) {
    (void)state;
    static const char *const steps[] = {"output.interval=1"}, *const seconds[] = {"output.interval=2.5e-8"};
    write_bytes(base, strlen(base));
    rg_case *c = read_good(path, 1, steps);
    assert_true(c->output.interval_steps == 1 && c->output.interval_time == 0);
    rg_case_free(c);
    c = read_good(path, 1, seconds);
    assert_true(c->output.interval_steps == 0 && c->output.interval_time == 2.5e-8);
    rg_case_free(c);
}

static void test_expressions(void **state) {
    (void)state;
    static const struct {
        const char *text;
        bool position, time;
        double value; /* at x = (2, 3, 5), t = 7 */
    } expected[] = {
        {"-6.25", false, false, -6.25},     {"2*pi/pi", false, false, 2}, {"x+10*y+100*z", true, false, 532},
        {"'t>6 ? t : -1'", false, true, 7}, {"'x*t^2'", true, true, 98},  {"-1*cos(pi*z)", true, false, 1},
        {"x==2", true, false, 1},           {"'3'", false, false, 3},
    };
    const double at[3] = {2, 3, 5}, elsewhere[3] = {-1, 0, 4};
    for (size_t i = 0; i < sizeof expected / sizeof expected[0]; i++) {
        char line[64];
        snprintf(line, sizeof line, "velocity: %s}", expected[i].text);
        write_changed("velocity: 6.086}", line);
        rg_case *c = read_good(path, 0, NULL);
        const rg_expr *e = c->boundary[0].value;
        rg_expr_value(e, elsewhere, 0);
        assert_true(rg_expr_value(e, at, 7) == expected[i].value);
        assert_int_equal(rg_expr_uses_position(e), expected[i].position);
        assert_int_equal(rg_expr_uses_time(e), expected[i].time);
        rg_case_free(c);
    }
}

/* ---- echo ---- */

static char *echo(const rg_case *c) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    rg_case_echo(c, out);
    assert_int_equal(fclose(out), 0);
    return text;
}

static void same_expr(const rg_expr *a, const rg_expr *b) {
    assert_int_equal(a == NULL, b == NULL);
    if (a != NULL) {
        assert_string_equal(rg_expr_text(a), rg_expr_text(b));
    }
}

static void same_bodies(const rg_case *a, const rg_case *b) {
    assert_int_equal(a->bodies, b->bodies);
    for (int i = 0; i < a->bodies; i++) {
        const rg_body_input *p = &a->body[i], *q = &b->body[i];
        const double of_p[] = {p->radius, p->density, p->mass, p->penalty, p->length};
        const double of_q[] = {q->radius, q->density, q->mass, q->penalty, q->length};
        assert_string_equal(p->name, q->name);
        assert_true(p->shape == q->shape && p->motion == q->motion);
        assert_memory_equal(of_p, of_q, sizeof of_p);
        assert_memory_equal(p->at, q->at, sizeof p->at);
        assert_memory_equal(p->normal, q->normal, sizeof p->normal);
        assert_memory_equal(p->axis, q->axis, sizeof p->axis);
        assert_int_equal(p->sets, q->sets);
        for (int k = 0; k < p->sets; k++) {
            assert_string_equal(p->set[k], q->set[k]);
        }
        assert_memory_equal(p->inertia, q->inertia, sizeof p->inertia);
        assert_int_equal(p->ties, q->ties);
        for (int k = 0; k < p->ties; k++) {
            assert_string_equal(p->tied[k], q->tied[k]);
        }
        for (int k = 0; k < 3; k++) {
            same_expr(p->spin[k], q->spin[k]);
            same_expr(p->velocity[k], q->velocity[k]);
        }
    }
}

static void same_lists(const rg_case *a, const rg_case *b) {
    assert_int_equal(a->boundaries, b->boundaries);
    for (int i = 0; i < a->boundaries; i++) {
        assert_string_equal(a->boundary[i].set, b->boundary[i].set);
        assert_int_equal(a->boundary[i].component, b->boundary[i].component);
        assert_int_equal(a->boundary[i].prescribed, b->boundary[i].prescribed);
        same_expr(a->boundary[i].value, b->boundary[i].value);
    }
    same_bodies(a, b);
    assert_int_equal(a->output.times, b->output.times);
    if (a->output.times > 0) {
        assert_memory_equal(a->output.time, b->output.time, (size_t)a->output.times * sizeof(double));
    }
    assert_int_equal(a->output.probes, b->output.probes);
    for (int i = 0; i < a->output.probes; i++) {
        assert_string_equal(a->output.probe[i].name, b->output.probe[i].name);
        assert_memory_equal(a->output.probe[i].at, b->output.probe[i].at, sizeof a->output.probe[i].at);
    }
}

/* Bit by bit. */
static void same_case(const rg_case *a, const rg_case *b) {
    assert_memory_equal(a->mesh.cells, b->mesh.cells, sizeof a->mesh.cells);
    assert_memory_equal(a->mesh.size, b->mesh.size, sizeof a->mesh.size);
    assert_memory_equal(a->mesh.origin, b->mesh.origin, sizeof a->mesh.origin);
    assert_memory_equal(&a->mesh.jitter, &b->mesh.jitter, sizeof a->mesh.jitter);
    assert_true(a->mesh.seed == b->mesh.seed && a->mass == b->mass);
    assert_memory_equal(&a->material, &b->material,
                        offsetof(rg_material_input, name)); /* the text has names */
    assert_true(a->interface.form == b->interface.form && a->interface.penalty == b->interface.penalty);
    assert_true(a->interface.law == b->interface.law && a->interface.contact == b->interface.contact);
    assert_true(a->interface.activation == b->interface.activation);
    const double of_a[] = {a->interface.beta_s, a->interface.strength,   a->interface.energy,
                           a->interface.beta,   a->interface.onset,      a->time.end,
                           a->time.safety,      a->output.interval_time, a->output.energy_limit};
    const double of_b[] = {b->interface.beta_s, b->interface.strength,   b->interface.energy,
                           b->interface.beta,   b->interface.onset,      b->time.end,
                           b->time.safety,      b->output.interval_time, b->output.energy_limit};
    assert_memory_equal(of_a, of_b, sizeof of_a);
    assert_true(a->time.steps == b->time.steps && a->output.interval_steps == b->output.interval_steps);
    assert_true(a->output.fields == b->output.fields && a->output.fragments == b->output.fragments);
    assert_string_equal(a->output.dir, b->output.dir);
    for (int k = 0; k < 3; k++) {
        same_expr(a->initial.displacement[k], b->initial.displacement[k]);
        same_expr(a->initial.velocity[k], b->initial.velocity[k]);
    }
    same_lists(a, b);
}

static void check_round_trip(const char *file, int overrides, const char *const override[]) {
    rg_case *c = read_good(file, overrides, override);
    char *text = echo(c);
    write_bytes(text, strlen(text));
    rg_case *again = read_good(path, 0, NULL);
    char *second = echo(again);
    same_case(c, again);
    assert_string_equal(text, second);
    free(second);
    free(text);
    rg_case_free(again);
    rg_case_free(c);
}

static void test_round_trip_of_cases(void **state) {
    (void)state;
    check_round_trip(CASES "spall/spall.yaml", 0, NULL);
    check_round_trip(CASES "spall/spall-jittered.yaml", 0, NULL);
    check_round_trip(CASES "free-bar/free-bar.yaml", 0, NULL);
    check_round_trip(CASES "torn-bar/torn-bar.yaml", 0, NULL);
    check_round_trip(CASES "bimaterial/bimaterial.yaml", 0, NULL);
    static const char *const onset[] = {"interface.onset=0.7"};
    check_round_trip(CASES "endurance/endurance.yaml", 1, onset);
}

static void test_round_trip_of_everything(void **state) {
    (void)state;
    static const char *const set[] = {
        "mesh.origin=[0.1, -3e-17, -0.0]",
        "mesh.seed=9223372036854775807",
        "material.young=123456789012.34567",
        "interface.penalty=isotropic",
        "interface.activation=total",
        "interface.contact=flux",
        "mass=lumped",
        "initial.displacement={x: 1e-6*x, z: -0}",
        "initial.velocity={y: 'sin(x) + 1'}",
        "boundary=[{set: x-, component: y, displacement: 'x >= 0 ? t : 1'}]",
        "bodies=[{name: b1, shape: sphere, motion: free, at: [0, -0.0, 0.1], radius: 0.3, density: 1e3,"
        "velocity: {x: 0, z: -1/3}, faces: [z+, x-], penalty: 0.1}, {name: b2, shape: plane, motion: "
        "prescribed,"
        "at: [0, 0, -1], normal: [0, 0, 2], velocity: {z: sin(t)}}, {name: b3, shape: cylinder, motion: free,"
        "at: [0, 0, -1], axis: [1, 1, 0], radius: 2, mass: 0.7}]",
        "time.end=1e-7",
        "time.steps=3",
        "output.times=[0, 0.3e-7, 1e-7]",
        "output.dir=\"a \\\"b\\\" \\\\ \\t: # \\u00e9\"",
        "output.interval=3",
        "output.probes=[{name: a-B_1, at: [0.1, 0, 0]}, {name: b, at: [0.1, 0, 1e-3]}]",
        "output.fields=[crack, velocity]"};
    write_bytes(base, strlen(base));
    check_round_trip(path, sizeof set / sizeof set[0], set);
}

/* A default interval of two seconds must not come back as two steps. */
static void test_round_trip_of_long_run(void **state) {
    (void)state;
    static const char *const set[] = {"time.end=100"};
    write_bytes(base, strlen(base));
    rg_case *c = read_good(path, 1, set);
    assert_true(c->output.interval_time == 2 && c->output.interval_steps == 0);
    rg_case_free(c);
    check_round_trip(path, 1, set);
}

/* Units and defaults stand in the echo for people to read. */
static void test_echo_text(void **state) {
    (void)state;
    write_bytes(base, strlen(base));
    rg_case *c = read_good(path, 0, NULL);
    char *text = echo(c);
    assert_non_null(strstr(text, "\n  young: 260000000000 # Pa\n"));
    assert_non_null(strstr(text, "\n  safety: 0.875\n"));
    assert_non_null(strstr(text, "\n  - set: \"z+\"\n    component: z\n    velocity: 6.086 # m/s\n"));
    assert_non_null(strstr(text, "\ninitial:\n  sets: []\nstart: initial\nboundary:")); /* no values */
    free(text);
    rg_case_free(c);
}

#ifndef RG_SINGLE

/* The smallest ceramic is that of the table. */
static void test_ceramic(void **state) {
    (void)state;
    write_changed(elastic, ceramic);
    rg_case *c = read_good(path, 0, NULL);
    rg_deshpande_evans table = rg_deshpande_evans_alumina();
    rg_material m = rg_material_make(&c->material);
    table.poisson = 0.21;
    table.density = 3690;
    assert_memory_equal(&m.of.deshpande_evans.parameters, &table, offsetof(rg_deshpande_evans, single_pi));
    assert_true(!m.of.deshpande_evans.parameters.single_pi &&
                c->output.fields == (1023U | RG_FIELD_FRAGMENT) && m.mu == 146e9);
    rg_case_free(c);
    static const char *const derived[] = {"material.interaction=derived"};
    check_round_trip(path, 1, derived);
}

/* A metal has what is given, and 0 of what is not; its waves by hand. */
static void test_metal(void **state) {
    (void)state;
    write_changed(elastic, metal);
    static const char *const voce[] = {"material.hardening=1e9", "material.saturation_stress=3e8",
                                       "material.saturation_rate=40"};
    for (int given = 0; given <= 3; given += 3) {
        rg_case *c = read_good(path, given, voce);
        rg_material m = rg_material_make(&c->material);
        double limit, speed, G = 70e9 / 2 / 1.21, K = 70e9 / 3 / (1 - 2 * 0.21),
                             H = given == 0 ? 0 : 1e9 + 40e8;
        const double expected[RG_PARAMETERS] = {[RG_PARAMETER_YIELD_STRESS] = 2e8,
                                                [RG_PARAMETER_HARDENING] = given == 0 ? 0 : 1e9,
                                                [RG_PARAMETER_SATURATION_STRESS] = given == 0 ? 0 : 3e8,
                                                [RG_PARAMETER_SATURATION_RATE] = given == 0 ? 0 : 40};
        assert_memory_equal(m.of.parameter, expected, sizeof expected);
        assert_true((c->output.fields & (RG_FIELD_PLASTIC | RG_FIELD_TRIAXIALITY)) ==
                    (RG_FIELD_PLASTIC | RG_FIELD_TRIAXIALITY));
        assert_true((c->output.fields & (RG_FIELD_DAMAGE | RG_FIELD_REGIME)) == 0);
        assert_true(rg_material_plastic_wave(&m, &limit, &speed));
        assert_true(fabs(limit - 2e8 * (K + 4 * G / 3) / (2 * G)) < 1e-12 * limit);
        assert_true(fabs(speed - sqrt((K + 4 * G / 3 * H / (3 * G + H)) / 3690)) < 1e-12 * speed);
        rg_case_free(c);
        check_round_trip(path, given, voce);
    }
    write_changed(NULL, base);
    rg_case *c = read_good(path, 0, NULL);
    rg_material m = rg_material_make(&c->material);
    double none = 0;
    assert_false(rg_material_plastic_wave(&m, &none, &none));
    rg_case_free(c);
}

#endif

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_values),
        cmocka_unit_test(test_defaults),
        cmocka_unit_test(test_defaults_that_follow),
        cmocka_unit_test(test_overrides),
        cmocka_unit_test(test_interval_kinds),
        cmocka_unit_test(test_expressions),
        cmocka_unit_test(test_round_trip_of_cases),
        cmocka_unit_test(test_round_trip_of_everything),
        cmocka_unit_test(test_round_trip_of_long_run),
        cmocka_unit_test(test_echo_text),
#ifndef RG_SINGLE
        cmocka_unit_test(test_metal),
        cmocka_unit_test(test_ceramic),
#endif
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
