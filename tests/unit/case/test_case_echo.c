/* The echo of a case, letter by letter, and what a restart may not change of it. */
#include "case/read.h"
#include "case/echo.h"
#include "support/case_input.h"

#include "base/mem.h"
#include "case/compare.h"
#include "case/key.h"

static const char small[] = "mesh: {cells: [2, 3, 4], size: [0.25, 2, 0.5]}\n"
                            "material: {model: neo-hookean, young: 2048, poisson: 0.125, density: 3690}\n"
                            "interface: {law: linear, strength: 400, energy: 34}\n"
                            "time: {end: 0.5}\n";

/* All that is not given. */
static const char defaults[] =
    "defaults: 1\n"
    "mesh:\n"
    "  cells: [2, 3, 4]\n"
    "  size: [0.25, 2, 0.5] # m\n"
    "  origin: [0, 0, 0] # m\n"
    "  jitter: 0\n"
    "  seed: 1\n"
    "  tile: 256\n"
    "  rebalance: 0\n"
    "material:\n"
    "  model: neo-hookean\n"
    "  young: 2048 # Pa\n"
    "  poisson: 0.125\n"
    "  density: 3690 # kg/m3\n"
    "materials: []\n"
    "interface:\n"
    "  form: variational\n"
    "  beta_s: 2\n"
    "  penalty: elastic\n"
    "  law: linear\n"
    "  strength: 400 # Pa\n"
    "  energy: 34 # J/m2\n"
    "  beta: 1\n"
    "  activation: conserving\n"
    "  onset: 0.5\n"
    "  contact: potential\n"
    "  friction: 0\n"
    "  sets: []\n"
    "viscosity:\n"
    "  linear: 0\n"
    "  quadratic: 0\n"
    "mass: consistent\n"
    "initial:\n"
    "  sets: []\n"
    "start: initial\n"
    "boundary: []\n"
    "loads: []\n"
    "bodies: []\n"
    "time:\n"
    "  end: 0.5 # s\n"
    "  safety: 0.875\n"
    "  collapse: 0.01\n"
    "output:\n"
    "  dir: \"results/m\"\n"
    "  interval: 0.01 # s\n"
    "  probes: []\n"
    "  sensors: []\n"
    "  crack_tips: []\n"
    "  crack_fronts: []\n"
    "  fields: [displacement, velocity, stress, mean_stress, principal_stress, crack, fragment]\n"
    "  fragments: each\n"
    "  precision: double\n"
    "  compression: 0\n"
    "  energy_limit: 0.050000000000000003\n"
    "checkpoint:\n"
    "  steps: 0\n"
    "  time: 0 # s\n"
    "  wall_time: 0 # s\n"
    "  keep: 2\n";

static const char *const all[] = {
    "mesh.origin=[-1, 0.5, 8]",
    "mesh.jitter=0.25",
    "mesh.seed=77",
    "mesh.tile=512",
    "mesh.weight='1 + x'",
    "mesh.rebalance=1.5",
    "material.name=first",
    "materials=[{name: second, where: z > 1, model: st-venant-kirchhoff, young: 64, poisson: 0.25, density: "
    "7},"
    "{where: '1', name: third, model: linear-elastic, young: 32, poisson: 0, density: 9}]",
    "interface.penalty=isotropic",
    "interface.beta_s=5",
    "interface.beta=0.75",
    "interface.activation=conserving",
    "interface.onset=0.625",
    "interface.contact=potential",
    "interface.sets=[{where: nz > x, strength: 100, beta: 0, friction: 0, weibull: {modulus: 3, area: 2}}, "
    "{between: [second, third], energy: 3*z, beta: nx, law: interface}, {where: 1, law: none}]",
    "interface.weibull={modulus: 12, area: 0.5, seed: 9, keep: opening}",
    "viscosity={linear: 0.0625, quadratic: 1.25}",
    "mass=lumped",
    "initial.displacement.y=x",
    "initial.velocity={x: 1.5e3, z: -y}",
    "boundary=[{set: x-, component: y, displacement: 0}, {component: z, set: y+, velocity: 't < 1 ? x : 2'}]",
    "loads=[{name: push, set: x-, traction: {z: 't*x'}, until: 8}, {where: 'y > 1', acceleration: {y: "
    "-9.75}, from: 0.5}]",
    "bodies=[{name: ball, shape: sphere, motion: free, at: [1, 2, 3], radius: 0.5, density: 7, faces: [z+, "
    "x-],"
    "velocity: {y: 1/3}}, {name: wall, shape: plane, motion: prescribed, at: [0, 0, -1], normal: [0, 3, 4],"
    "penalty: 2, velocity: {x: t, y: 0, z: t*t}}, {name: rod, shape: cylinder, motion: free, mass: 0.75,"
    "at: [0, 0, -1], axis: [1, 1, 0], radius: 2, inertia: [1, 1.25, 1.5, 0, 0.125, 0], spin: {z: 4}, tied: "
    "[y-]}]",
    "time={end: 0.25, safety: 0.875, steps: 30, collapse: 0}",
    "output.dir=\"a \\\"b\\\" \\\\ \\t\\x7f: # \\u00e9\"",
    "output.interval=3",
    "output.times=[0, 0.125, 0.25]",
    "output.probes=[{name: p-1, at: [-1, 1, 8]}, {name: p_2, at: [-0.875, 2.5, 8.5]}]",
    "output.fields=[material, rank, velocity, triaxiality]",
    "output.fragments=last",
    "output.region=x > 0",
    "output.precision=single",
    "output.compression=9",
    "output.energy_limit=0.5",
    "checkpoint={steps: 11, time: 0.125, wall_time: 600, keep: 5}",
    NULL};

static char *echo_text;
static size_t echo_size;

/* In echo_text, which the caller frees. */
static char *echo_of(const rg_case *c) {
    FILE *out = open_memstream(&echo_text, &echo_size);
    assert_non_null(out);
    rg_case_echo(c, out);
    assert_int_equal(fclose(out), 0);
    return echo_text;
}

/* Whether a line of an echo is that of a key which came after this test was written: it is a key of every
 * case, and no text here has its name. */
static bool is_newer(const char *line, size_t length, const char *section, size_t section_length) {
    char dotted[100], name[60];
    size_t indent = strspn(line, " "), end = strcspn(line + indent, ":\n");
    snprintf(name, sizeof name, "%.*s:", (int)end, line + indent);
    snprintf(dotted, sizeof dotted, "%.*s%s%.*s", indent > 0 ? (int)section_length : 0, section,
             indent > 0 ? "." : "", (int)end, line + indent);
    bool newer =
        end < length && strstr(defaults, name) == NULL && rg_key_find(&rg_case_table, dotted) != NULL;
    for (int i = 0; newer && all[i] != NULL; i++) {
        newer = strstr(all[i], dotted) == NULL && strstr(all[i], name) == NULL;
    }
    return newer;
}

/* Expects the letters of `expected`, but for lines of newer keys, so that a new key is no change here. */
static void assert_echo(const char *found, const char *expected) {
    const char *section = "";
    size_t section_length = 0, length;
    for (const char *line = found; *line != '\0'; line += length) {
        length = strcspn(line, "\n") + 1;
        if (*line != ' ') {
            section = line;
            section_length = strcspn(line, ":");
        }
        if (strncmp(line, expected, length) == 0) {
            expected += length;
        } else if (!is_newer(line, length, section, section_length)) {
            fail_msg("found:\n%s\ninstead of:\n%s", line, expected);
        }
    }
    assert_string_equal("", expected);
}

/* Expects the echo of case `text` with `count` overrides, and that it reads back to itself. */
static void expect_echo(const char *text, int count, const char *const set[], const char *expected) {
    size_t before = rg_alloc_total();
    for (int again = 0; again < 2; again++) {
        rg_case *c = again ? rg_case_read_text("a/m.yaml", expected, strlen(expected), 0, NULL, stderr)
                           : rg_case_read_text("a/m.yaml", text, strlen(text), count, set, stderr);
        assert_non_null(c);
        char *found = echo_of(c);
        assert_echo(found, expected);
        free(found);
        rg_case_free(c);
        assert_int_equal(rg_alloc_total(), before);
    }
}

static void test_defaults(void **state) {
    (void)state;
    expect_echo(small, 0, NULL, defaults);
}

static void test_everything(void **state) {
    (void)state;
    expect_echo(small, sizeof all / sizeof *all - 1, all,
                "defaults: 1\n"
                "mesh:\n"
                "  cells: [2, 3, 4]\n"
                "  size: [0.25, 2, 0.5] # m\n"
                "  origin: [-1, 0.5, 8] # m\n"
                "  jitter: 0.25\n"
                "  seed: 77\n"
                "  tile: 512\n"
                "  weight: \"1 + x\"\n"
                "  rebalance: 1.5\n"
                "material:\n"
                "  name: \"first\"\n"
                "  model: neo-hookean\n"
                "  young: 2048 # Pa\n"
                "  poisson: 0.125\n"
                "  density: 3690 # kg/m3\n"
                "materials:\n"
                "  - name: \"second\"\n"
                "    where: \"z > 1\"\n"
                "    model: st-venant-kirchhoff\n"
                "    young: 64 # Pa\n"
                "    poisson: 0.25\n"
                "    density: 7 # kg/m3\n"
                "  - name: \"third\"\n"
                "    where: 1\n"
                "    model: linear-elastic\n"
                "    young: 32 # Pa\n"
                "    poisson: 0\n"
                "    density: 9 # kg/m3\n"
                "interface:\n"
                "  form: variational\n"
                "  beta_s: 5\n"
                "  penalty: isotropic\n"
                "  law: linear\n"
                "  strength: 400 # Pa\n"
                "  energy: 34 # J/m2\n"
                "  beta: 0.75\n"
                "  activation: conserving\n"
                "  onset: 0.625\n"
                "  contact: potential\n"
                "  friction: 0\n"
                "  sets:\n"
                "    - where: \"nz > x\"\n"
                "      strength: 100 # Pa\n"
                "      beta: 0\n"
                "      friction: 0\n"
                "      weibull:\n"
                "        modulus: 3\n"
                "        area: 2 # m2\n"
                "    - between: [\"second\", \"third\"]\n"
                "      energy: \"3*z\" # J/m2\n"
                "      beta: \"nx\"\n"
                "    - where: 1\n"
                "      law: none\n"
                "  weibull:\n"
                "    modulus: 12\n"
                "    area: 0.5 # m2\n"
                "    seed: 9\n"
                "    keep: opening\n"
                "viscosity:\n"
                "  linear: 0.0625\n"
                "  quadratic: 1.25\n"
                "mass: lumped\n"
                "initial:\n"
                "  displacement:\n"
                "    y: \"x\" # m\n"
                "  velocity:\n"
                "    x: 1.5e3 # m/s\n"
                "    z: \"-y\" # m/s\n"
                "  sets: []\n"
                "start: initial\n"
                "boundary:\n"
                "  - set: \"x-\"\n"
                "    component: y\n"
                "    displacement: 0 # m\n"
                "  - set: \"y+\"\n"
                "    component: z\n"
                "    velocity: \"t < 1 ? x : 2\" # m/s\n"
                "loads:\n"
                "  - name: \"push\"\n"
                "    set: \"x-\"\n"
                "    traction:\n"
                "      z: \"t*x\" # Pa\n"
                "    from: 0 # s\n"
                "    until: 8 # s\n"
                "  - where: \"y > 1\"\n"
                "    acceleration:\n"
                "      y: -9.75 # m/s2\n"
                "    from: 0.5 # s\n"
                "bodies:\n"
                "  - name: \"ball\"\n"
                "    shape: sphere\n"
                "    motion: free\n"
                "    at: [1, 2, 3] # m\n"
                "    radius: 0.5 # m\n"
                "    density: 7 # kg/m3\n"
                "    velocity:\n"
                "      y: \"1/3\" # m/s\n"
                "    faces: [\"z+\", \"x-\"]\n"
                "    penalty: 4\n"
                "  - name: \"wall\"\n"
                "    shape: plane\n"
                "    motion: prescribed\n"
                "    at: [0, 0, -1] # m\n"
                "    normal: [0, 3, 4]\n"
                "    velocity:\n"
                "      x: \"t\" # m/s\n"
                "      y: 0 # m/s\n"
                "      z: \"t*t\" # m/s\n"
                "    penalty: 2\n"
                "  - name: \"rod\"\n"
                "    shape: cylinder\n"
                "    motion: free\n"
                "    at: [0, 0, -1] # m\n"
                "    radius: 2 # m\n"
                "    axis: [1, 1, 0]\n"
                "    mass: 0.75 # kg\n"
                "    inertia: [1, 1.25, 1.5, 0, 0.125, 0] # kg m2\n"
                "    spin:\n"
                "      z: 4 # rad/s\n"
                "    tied: [\"y-\"]\n"
                "    penalty: 4\n"
                "time:\n"
                "  end: 0.25 # s\n"
                "  safety: 0.875\n"
                "  steps: 30\n"
                "  collapse: 0\n"
                "output:\n"
                "  dir: \"a \\\"b\\\" \\\\ \\x09\\x7f: # \xc3\xa9\"\n"
                "  interval: 3 # steps\n"
                "  times: [0, 0.125, 0.25] # s\n"
                "  probes:\n"
                "    - name: \"p-1\"\n"
                "      at: [-1, 1, 8] # m\n"
                "    - name: \"p_2\"\n"
                "      at: [-0.875, 2.5, 8.5] # m\n"
                "  sensors: []\n"
                "  crack_tips: []\n"
                "  crack_fronts: []\n"
                "  fields: [velocity, triaxiality, rank, material]\n"
                "  fragments: last\n"
                "  region: \"x > 0\"\n"
                "  precision: single\n"
                "  compression: 9\n"
                "  energy_limit: 0.5\n"
                "checkpoint:\n"
                "  steps: 11\n"
                "  time: 0.125 # s\n"
                "  wall_time: 600 # s\n"
                "  keep: 5\n");
}

/* Of the echo, from the line that begins with `from` up to that which begins with `to`. */
static void expect_part(const char *set, const char *from, const char *to, const char *expected) {
    rg_case *c = rg_case_read_text("m.yaml", small, strlen(small), 1, &set, stderr);
    assert_non_null(c);
    char *text = echo_of(c), *begin = strstr(text, from);
    assert_non_null(begin);
    char *end = strstr(begin, to);
    assert_non_null(end);
    *end = '\0';
    assert_string_equal(begin, expected);
    free(text);
    rg_case_free(c);
}

/* Keys that a form or a law has no use for are not there. */
static void test_forms_and_laws(void **state) {
    (void)state;
    static const char *const known[][2] = {
        {"interface={law: none}", "  form: variational\n  beta_s: 2\n  penalty: elastic\n  law: none\n"},
        {"interface={law: none, form: continuous}", "  form: continuous\n  law: none\n"},
        {"interface={law: linear, form: continuous, faces: z, strength: 1, energy: 2}",
         "  form: continuous\n  faces: \"z\"\n  beta_s: 4\n  penalty: elastic\n  law: linear\n  strength: 1 "
         "# "
         "Pa\n  energy: 2 # J/m2\n  beta: 1\n  activation: continuous\n  contact: penalty\n  friction: 0\n"
         "  sets: []\n"},
        {"interface={law: free, strength: 1}",
         "  form: variational\n  beta_s: 2\n  penalty: elastic\n  law: free\n  strength: 1 # Pa\n  beta: 1\n "
         " "
         "activation: conserving\n  onset: 0.5\n  contact: potential\n  friction: 0\n  sets: []\n"},
        {"interface={law: polynomial, form: intrinsic, strength: 1, energy: 2}",
         "  form: intrinsic\n  beta_s: 4\n  law: polynomial\n  strength: 1 # Pa\n  energy: 2 # J/m2\n  "
         "contact: "
         "penalty\n  friction: 0\n  polynomial:\n    alpha: 1\n  sets: []\n"},
        {"interface={law: needleman, form: intrinsic, strength: 1, energy: 2}",
         "  form: intrinsic\n  beta_s: 4\n  law: needleman\n  strength: 1 # Pa\n  energy: 2 # J/m2\n  "
         "contact: "
         "penalty\n  friction: 0\n  needleman:\n    alpha: 1\n  sets: []\n"},
        {"interface={law: bilinear, form: intrinsic, strength: 1, energy: 2}",
         "  form: intrinsic\n  beta_s: 4\n  law: bilinear\n  strength: 1 # Pa\n  energy: 2 # J/m2\n  beta: "
         "1\n  "
         "contact: penalty\n  friction: 0\n  bilinear:\n    ascent: 0.01\n    steps: 0\n  sets: []\n"},
        {"interface={law: xu-needleman, form: intrinsic, strength: 1, energy: 2}",
         "  form: intrinsic\n  beta_s: 4\n  law: xu-needleman\n  strength: 1 # Pa\n  energy: 2 # J/m2\n  "
         "beta: "
         "1\n  contact: penalty\n  friction: 0\n  xu-needleman:\n    q: 1\n    r: 0\n  sets: []\n"},
        {"interface={law: fatigue, form: incomplete, strength: 1, energy: 2}",
         "  form: incomplete\n  beta_s: 4\n  penalty: elastic\n  law: fatigue\n  strength: 1 # Pa\n  energy: "
         "2 # "
         "J/m2\n  beta: 1\n  activation: continuous\n  contact: penalty\n  friction: 0\n  fatigue:\n    "
         "decay: "
         "1\n  sets: []\n"},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        expect_part(known[i][0], "  form:", "viscosity", known[i][1]);
    }
    expect_part("interface={law: none, form: continuous}", "mass", "initial", "mass: lumped\n");
}

/* An entry whose first key stands in a section. */
static void test_sections_of_entries(void **state) {
    (void)state;
    expect_part("loads=[{acceleration: {y: 1, z: 2}}, {acceleration: {x: t}, until: 3}]", "loads", "bodies",
                "loads:\n  - acceleration:\n      y: 1 # m/s2\n      z: 2 # m/s2\n    from: 0 # s\n"
                "  - acceleration:\n      x: \"t\" # m/s2\n    from: 0 # s\n    until: 3 # s\n");
}

static void test_interval_of_a_long_run(void **state) {
    (void)state;
    expect_part("time.end=49", "  interval", "  probes", "  interval: 0.97999999999999998 # s\n");
    expect_part("time.end=50", "  dir", "  fields",
                "  dir: \"results/m\"\n  probes: []\n"
                "  sensors: []\n"
                "  crack_tips: []\n"
                "  crack_fronts: []\n"); /* 1 s would be a step */
}

#ifndef RG_SINGLE

static void test_ceramic_and_metal(void **state) {
    (void)state;
    expect_part("material={model: deshpande-evans, shear: 64, poisson: 0.25, density: 3, flaw_radius: 1, "
                "flaw_density: 0.125, toughness: 32, yield_stress: 4}",
                "  model", "materials",
                "  model: deshpande-evans\n  shear: 64 # Pa\n  poisson: 0.25\n  density: 3 # kg/m3\n"
                "  flaw_radius: 1 # m\n  flaw_density: 0.125 # 1/m3\n  alpha: 0.70710678118654757\n"
                "  beta: 0.10000000000000001\n  gamma: 2\n  friction: 0.75\n  toughness: 32 # Pa sqrt(m)\n"
                "  growth_speed: 0.0001 # m/s\n  growth_exponent: 10\n  interaction: thesis\n"
                "  damage_max: 0.999\n  yield_stress: 4 # Pa\n  yield_strain: 0.002\n"
                "  hardening_exponent: 0.10000000000000001\n  plastic_rate: 0.002 # 1/s\n"
                "  transition_rate: 1000000 # 1/s\n  rate_exponent: 10\n");
    expect_part(
        "material={model: j2, young: 64, poisson: 0.25, density: 3, yield_stress: 4, hardening: 2, "
        "saturation_stress: 5, saturation_rate: 7}",
        "  model", "materials",
        "  model: j2\n  young: 64 # Pa\n  poisson: 0.25\n  density: 3 # kg/m3\n  yield_stress: 4 # Pa\n"
        "  hardening: 2 # Pa\n  saturation_stress: 5 # Pa\n  saturation_rate: 7\n");
    expect_part("material={model: j2, young: 64, poisson: 0.25, density: 3, yield_stress: 4}", "  fields",
                "  frag",
                "  fields: [displacement, velocity, stress, mean_stress, principal_stress, crack, "
                "plastic_strain, triaxiality, fragment]\n");
}

#endif

/* ---- what a restart may not change ---- */

static char *fixed_of(int count, const char *const set[]) {
    rg_case *c = rg_case_read_text("m.yaml", small, strlen(small), count, set, stderr);
    assert_non_null(c);
    char *text = rg_case_fixed(c);
    rg_case_free(c);
    return text;
}

static void test_fixed_values(void **state) {
    (void)state;
    static const char *const set[] = {
        "boundary=[{set: x-, component: y, displacement: 0},{set: y+, component: z, "
        "velocity: 't'}]",
        "bodies=[{name: b, shape: plane, motion: prescribed, at: [0, 0, -1], normal: "
        "[0, 3, 4], faces: [z+, x-]}]",
        "mesh.weight=x",
        "mesh.rebalance=2",
        "time.steps=9",
        "checkpoint.steps=3",
        "output={dir: d, fields: [], interval: 4, region: y}"};
    char *text = fixed_of(sizeof set / sizeof *set, set);
    assert_string_equal(text, "mesh.cells: [2, 3, 4]\n"
                              "mesh.size: [0.25, 2, 0.5]\n"
                              "mesh.origin: [0, 0, 0]\n"
                              "mesh.jitter: 0\n"
                              "mesh.seed: 1\n"
                              "mesh.tile: 256\n"
                              "material.model: neo-hookean\n"
                              "material.young: 2048\n"
                              "material.poisson: 0.125\n"
                              "material.density: 3690\n"
                              "interface.form: variational\n"
                              "interface.beta_s: 2\n"
                              "interface.penalty: elastic\n"
                              "interface.law: linear\n"
                              "interface.strength: 400\n"
                              "interface.energy: 34\n"
                              "interface.beta: 1\n"
                              "interface.activation: conserving\n"
                              "interface.onset: 0.5\n"
                              "interface.contact: potential\n"
                              "interface.friction: 0\n"
                              "viscosity.linear: 0\n"
                              "viscosity.quadratic: 0\n"
                              "mass: consistent\n"
                              "start: initial\n"
                              "boundary[0].set: \"x-\"\n"
                              "boundary[0].component: y\n"
                              "boundary[0].displacement: 0\n"
                              "boundary[1].set: \"y+\"\n"
                              "boundary[1].component: z\n"
                              "boundary[1].velocity: \"t\"\n"
                              "bodies[0].name: \"b\"\n"
                              "bodies[0].shape: plane\n"
                              "bodies[0].motion: prescribed\n"
                              "bodies[0].at: [0, 0, -1]\n"
                              "bodies[0].normal: [0, 3, 4]\n"
                              "bodies[0].faces: [\"z+\", \"x-\"]\n"
                              "bodies[0].penalty: 4\n"
                              "output.fragments: each\n"
                              "output.region: \"y\"\n"
                              "output.precision: double\n");
    free(text);
}

static void expect_changes(const char *before, const char *here, const char *expected) {
    static const char head[] =
        "the case is not that of the checkpoint; a restart may change time, checkpoint, "
        "mesh.weight, mesh.rebalance and most of output, but not";
    char *changes = rg_case_changes(before, here);
    if (expected == NULL) {
        assert_null(changes);
        return;
    }
    assert_non_null(changes);
    assert_memory_equal(changes, head, sizeof head - 1);
    assert_string_equal(changes + sizeof head - 1, expected);
    rg_free(changes);
}

static void test_changes(void **state) {
    (void)state;
    static const char *const set[] = {
        "interface.strength=401", "initial.velocity.x=1",
        "interface.beta=1",       "boundary=[{set: x-, component: y, displacement: 0}]",
        "output.region=x",        "time.steps=4",
        "output.dir=elsewhere"};
    char *before = fixed_of(0, NULL), *here = fixed_of(sizeof set / sizeof *set, set);
    expect_changes(before, before, NULL);
    expect_changes(here, here, NULL);
    expect_changes(before, here,
                   "\n  interface.strength: 401; in the checkpoint: 400"
                   "\n  initial.velocity.x: 1; in the checkpoint: not given"
                   "\n  boundary[0].set: \"x-\"; in the checkpoint: not given"
                   "\n  boundary[0].component: y; in the checkpoint: not given"
                   "\n  boundary[0].displacement: 0; in the checkpoint: not given"
                   "\n  output.region: \"x\"; in the checkpoint: not given");
    expect_changes(here, before,
                   "\n  interface.strength: 400; in the checkpoint: 401"
                   "\n  initial.velocity.x: not given; in the checkpoint: 1"
                   "\n  boundary[0].set: not given; in the checkpoint: \"x-\""
                   "\n  boundary[0].component: not given; in the checkpoint: y"
                   "\n  boundary[0].displacement: not given; in the checkpoint: 0"
                   "\n  output.region: not given; in the checkpoint: \"x\"");
    free(before);
    free(here);
}

/* Keys that begin alike, order, and lines as only a damaged checkpoint has them. */
static void test_changes_of_lines(void **state) {
    (void)state;
    expect_changes("a: 1\nab: 2\n", "ab: 2\na: 1\n", NULL);
    expect_changes("a: 1\nab: 2\n", "ab: 1\na: 2\n",
                   "\n  ab: 1; in the checkpoint: 2\n  a: 2; in the checkpoint: 1");
    expect_changes("a: 1\n", "a: 12\n", "\n  a: 12; in the checkpoint: 1");
    expect_changes("a: 12\n", "a: 1\n", "\n  a: 1; in the checkpoint: 12");
    expect_changes("a: 1\n", "a: 1\nb: x: y\n", "\n  b: x: y; in the checkpoint: not given");
    expect_changes("noise\na: 1\n", "a: 1\n", "\n  noise: not given; in the checkpoint: ");
    expect_changes("a:1\n", "a: 1\n", "\n  a: 1; in the checkpoint: 1");
    expect_changes("", "a: 1\n", "\n  a: 1; in the checkpoint: not given");
    expect_changes("a: 1", "", "\n  a: not given; in the checkpoint: 1");
    expect_changes("\n\na: 1\n", "a: 1\n",
                   "\n  : not given; in the checkpoint: \n  : not given; in the checkpoint: ");
    expect_changes("", "", NULL);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_defaults),
        cmocka_unit_test(test_everything),
        cmocka_unit_test(test_forms_and_laws),
        cmocka_unit_test(test_interval_of_a_long_run),
        cmocka_unit_test(test_sections_of_entries),
#ifndef RG_SINGLE
        cmocka_unit_test(test_ceramic_and_metal),
#endif
        cmocka_unit_test(test_fixed_values),
        cmocka_unit_test(test_changes),
        cmocka_unit_test(test_changes_of_lines),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
