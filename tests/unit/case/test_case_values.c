/* Values of the wrong kind, keys at the wrong place and what is no YAML. */
#include "support/case_input.h"

static const mistake numbers_and_texts[] = {
    {"young: 260e9", "young: +.inf", ":6:10: material.young: +.inf: not finite; allowed: number > 0 (Pa)\n"},
    {"young: 260e9", "young: -.inf", ":6:10: material.young: -.inf: not finite; allowed: number > 0 (Pa)\n"},
    {"young: 260e9", "young: +Infinity",
     ":6:10: material.young: +Infinity: not finite; allowed: number > 0 (Pa)\n"},
    {"young: 260e9", "young: nan", ":6:10: material.young: nan: not finite; allowed: number > 0 (Pa)\n"},
    {"young: 260e9", "young: -.NaN", ":6:10: material.young: -.NaN: not finite; allowed: number > 0 (Pa)\n"},
    {"young: 260e9", "young: '.inf'",
     ":6:10: material.young: \".inf\": not a number; allowed: number > 0 (Pa)\n"},
    {"young: 260e9", "young: \"x\"",
     ":6:10: material.young: \"x\": not a number; allowed: number > 0 (Pa)\n"},
    {"young: 260e9", "young: ~", ":6:10: material.young: no value; allowed: number > 0 (Pa)\n"},
    {"young: 260e9", "young: null", ":6:10: material.young: no value; allowed: number > 0 (Pa)\n"},
    {"young: 260e9", "young: [1]", ":6:10: material.young: [1]: not a number; allowed: number > 0 (Pa)\n"},
    {"young: 260e9", "young: 1e400", ":6:10: material.young: 1e400: not finite; allowed: number > 0 (Pa)\n"},
    {"young: 260e9", "young: -1e400",
     ":6:10: material.young: -1e400: not finite; allowed: number > 0 (Pa)\n"},
    {"[2, 2, 4]", "[1, 1, 1, 1]",
     ":2:10: mesh.cells: [1, 1, 1, 1]: wrong number of entries; allowed: [x, y, z], each integer >= 1 and <= "
     "100000\n"},
    {"[2, 2, 4]", "[]",
     ":2:10: mesh.cells: []: wrong number of entries; allowed: [x, y, z], each integer >= 1 and <= 100000\n"},
    {"[2, 2, 4]", "{}",
     ":2:10: mesh.cells: {}: not a list; allowed: [x, y, z], each integer >= 1 and <= 100000\n"},
    {"[2, 2, 4]", "[1e3, \"3\", ~]",
     ":2:11: mesh.cells[0]: 1e3: not an integer; allowed: integer >= 1 and <= 100000\n"
     ":2:16: mesh.cells[1]: \"3\": a text (in quotes), not a number; allowed: integer >= 1 and <= 100000\n"
     ":2:21: mesh.cells[2]: no value; allowed: integer >= 1 and <= 100000\n"},
    {"[2, 2, 4]", "[9223372036854775808, -1, .inf]",
     ":2:11: mesh.cells[0]: 9223372036854775808: out of range; allowed: integer >= 1 and <= 100000\n"
     ":2:32: mesh.cells[1]: -1: out of range; allowed: integer >= 1 and <= 100000\n"
     ":2:36: mesh.cells[2]: .inf: not finite; allowed: integer >= 1 and <= 100000\n"},
    {"[2, 2, 4]", "~", ":2:10: mesh.cells: no value; allowed: [x, y, z], each integer >= 1 and <= 100000\n"},
    {"output:\n", "output:\n  fields: [stres, damage]\n",
     ":18:12: output.fields[0]: stres: not one of the allowed words; allowed: list from displacement, "
     "velocity, "
     "stress, mean_stress, principal_stress, crack, damage, regime, plastic_strain, triaxiality, rank, "
     "fragment, "
     "material, plastic_volume, bulking_pressure, temperature, contact; did you mean 'stress'?\n"},
    {"output:\n",
     "output:\n"
     "  dir: true\n",
     ":18:8: output.dir: true: not a text (put it in quotes to make it one); allowed: text\n"},
    {"output:\n",
     "output:\n"
     "  dir: false\n",
     ":18:8: output.dir: false: not a text (put it in quotes to make it one); allowed: text\n"},
    {"output:\n",
     "output:\n"
     "  dir: ~\n",
     ":18:8: output.dir: no value; allowed: text\n"},
    {"output:\n",
     "output:\n"
     "  dir: \"\"\n",
     ":18:8: output.dir: \"\": not a text; allowed: text\n"},
    {"output:\n",
     "output:\n"
     "  dir: [a]\n",
     ":18:8: output.dir: [a]: not a text; allowed: text\n"},
    {"output:\n",
     "output:\n"
     "  dir: {a: b}\n",
     ":18:8: output.dir: {a: b}: not a text; allowed: text\n"},
    {"output:\n",
     "output:\n"
     "  dir: 1.5\n",
     ":18:8: output.dir: 1.5: not a text (put it in quotes to make it one); allowed: text\n"},
    {"output:\n",
     "output:\n"
     "  dir: 12e3\n",
     ":18:8: output.dir: 12e3: not a text (put it in quotes to make it one); allowed: text\n"},
    {"output:\n",
     "output:\n"
     "  interval: '3'\n",
     ":18:13: output.interval: \"3\": a text (in quotes), not a number; allowed: integer >= 1 (steps), or "
     "number > 0 and < 1 (simulated seconds)\n"},
    {"output:\n",
     "output:\n"
     "  interval: ~\n",
     ":18:13: output.interval: no value; allowed: integer >= 1 (steps), or number > 0 and < 1 (simulated "
     "seconds)\n"},
    {"output:\n",
     "output:\n"
     "  interval: [3]\n",
     ":18:13: output.interval: [3]: not a number; allowed: integer >= 1 (steps), or number > 0 and < 1 "
     "(simulated seconds)\n"},
    {"output:\n",
     "output:\n"
     "  interval: -1\n",
     ":18:13: output.interval: -1: out of range; allowed: integer >= 1 (steps), or number > 0 and < 1 "
     "(simulated seconds)\n"},
    {"output:\n",
     "output:\n"
     "  interval: -1.0\n",
     ":18:13: output.interval: -1.0: out of range; allowed: integer >= 1 (steps), or number > 0 and < 1 "
     "(simulated seconds)\n"},
    {"output:\n",
     "output:\n"
     "  interval: .inf\n",
     ":18:13: output.interval: .inf: not finite; allowed: integer >= 1 (steps), or number > 0 and < 1 "
     "(simulated seconds)\n"},
    {"output:\n",
     "output:\n"
     "  interval: 1e-400\n",
     ":18:13: output.interval: 1e-400: out of range; allowed: integer >= 1 (steps), or number > 0 and < 1 "
     "(simulated seconds)\n"},
    {"output:\n",
     "output:\n"
     "  times: 3\n",
     ":18:10: output.times: 3: not a list; allowed: ascending list, each number >= 0 (s)\n"},
    {"output:\n",
     "output:\n"
     "  times: [x]\n",
     ":18:11: output.times[0]: x: not a number; allowed: number >= 0 (s)\n"},
    {"output:\n",
     "output:\n"
     "  times: [-1, 1e-7]\n",
     ":18:11: output.times[0]: -1: out of range; allowed: number >= 0 (s)\n"},
    {"output:\n",
     "output:\n"
     "  times: [1e-7, 1e-6, 1.0000001e-6]\n",
     ":18:23: output.times: 1.0000001e-6: after time.end, 1e-06 s\n"},
    {"output:\n",
     "output:\n"
     "  times: [2e-7, 1e-7]\n",
     ":18:10: output.times: [2e-7, 1e-7]: not ascending; allowed: ascending list, each number >= 0 (s)\n"},
    {"output:\n",
     "output:\n"
     "  times: [1e-7, [2]]\n",
     ":18:17: output.times[1]: [2]: not a number; allowed: number >= 0 (s)\n"},
    {"output:\n",
     "output:\n"
     "  times: [3e-7, 3e-7, 9]\n",
     ":18:10: output.times: [3e-7, 3e-7, 9]: not ascending; allowed: ascending list, each number >= 0 (s)\n"},
    {"output:\n",
     "output:\n"
     "  times: [\"1e-7\"]\n",
     ":18:11: output.times[0]: \"1e-7\": a text (in quotes), not a number; allowed: number >= 0 (s)\n"},
    {"  end: 1e-6\n"
     "output:\n",
     "  end: 0\n"
     "output:\n"
     "  times: [3]\n",
     ":16:8: time.end: 0: out of range; allowed: number > 0 (s)\n"},
    {"velocity: 6.086", "velocity: ~",
     ":14:39: boundary[0].velocity: no value; allowed: number or expression in x, y, z, t (m/s)\n"},
    {"velocity: 6.086", "velocity: {a: 1}",
     ":14:39: boundary[0].velocity: {a: 1}: not a number or expression; allowed: number or expression in x, "
     "y, z, t (m/s)\n"},
    {"velocity: 6.086", "velocity: +.inf",
     ":14:39: boundary[0].velocity: +.inf: not finite; allowed: number or expression in x, y, z, t (m/s)\n"},
    {"velocity: 6.086", "velocity: '.inf'",
     ":14:39: boundary[0].velocity: \".inf\": Unexpected token \".inf \" found at position 0.; allowed: "
     "number or expression in x, y, z, t (m/s)\n"},
    {"velocity: 6.086", "velocity: nx",
     ":14:39: boundary[0].velocity: nx: depends on a normal, which only faces have; allowed: number or "
     "expression in x, y, z, t (m/s)\n"},
    {"velocity: 6.086", "velocity: \"\" ",
     ":14:39: boundary[0].velocity: \"\": Expression is empty.; allowed: number or expression in x, y, z, t "
     "(m/s)\n"},
    {"velocity: 6.086", "velocity: '1 2'",
     ":14:39: boundary[0].velocity: \"1 2\": Unexpected value \"2\" found at position 2; allowed: number or "
     "expression in x, y, z, t (m/s)\n"},
    {"output:\n",
     "output:\n"
     "  region: t\n"
     "  fields: [[crack], damage, crack, velocity, crack]\n",
     ":18:11: output.region: t: depends on t, but this is the state at the start; allowed: number or "
     "expression in x, y, z\n"
     ":19:12: output.fields[0]: [crack]: not one of the allowed words; allowed: list from displacement, "
     "velocity, stress, mean_stress, principal_stress, crack, damage, regime, plastic_strain, triaxiality, "
     "rank, fragment, material, plastic_volume, bulking_pressure, temperature, contact\n"
     ":19:46: output.fields[4]: crack: given twice; allowed: list from displacement, velocity, stress, "
     "mean_stress, principal_stress, crack, damage, regime, plastic_strain, triaxiality, rank, fragment, "
     "material, plastic_volume, bulking_pressure, temperature, contact\n"},
    {"output:\n",
     "output:\n"
     "  fields: [Crack, displacement]\n"
     "  fragments: never\n",
     ":18:12: output.fields[0]: Crack: not one of the allowed words; allowed: list from displacement, "
     "velocity, stress, mean_stress, principal_stress, crack, damage, regime, plastic_strain, triaxiality, "
     "rank, fragment, material, plastic_volume, bulking_pressure, temperature, contact; did you mean "
     "'crack'?\n"
     ":19:14: output.fragments: never: not one of the allowed words; allowed: each, last, none\n"},
};

static const mistake keys[] = {
    {"mesh:\n",
     "mesh: {cells: [1, 1, 1], cells: [2, 2, 2], size: [1, 1, 1]}\n"
     "mesh:\n",
     ":1:26: mesh.cells: given twice, first at line 1 column 8\n"
     ":2:1: mesh: given twice, first at line 1 column 1\n"},
    {"time:\n"
     "  end: 1e-6\n",
     "time: [1]\n", ":15:7: time: [1]: not a mapping of keys\n"},
    {"time:\n"
     "  end: 1e-6\n",
     "time: \"end\"\n", ":15:7: time: \"end\": not a mapping of keys\n"},
    {"time:\n"
     "  end: 1e-6\n",
     "time: ~\n",
     ":15:7: time: no value\n"
     ":15:7: time.end: missing; allowed: number > 0 (s)\n"},
    {"time:\n"
     "  end: 1e-6\n",
     "time: {}\n", ":15:7: time.end: missing; allowed: number > 0 (s)\n"},
    {"mesh:\n",
     "initial:\n"
     "  velocity: 3\n"
     "  displacement: [1, 2]\n"
     "  speed: 1\n"
     "mesh:\n",
     ":2:13: initial.velocity: 3: not a mapping of keys\n"
     ":3:17: initial.displacement: [1, 2]: not a mapping of keys\n"
     ":4:3: initial.speed: unknown key; did you mean 'initial.rotation.speed'?\n"},
    {"mesh:\n",
     ": 3\n"
     "? {a: 1}\n"
     ": 4\n"
     "mesh:\n",
     ":1:1: unknown key; allowed: defaults, tables, mesh, material, materials, interface, contact, "
     "viscosity, temperature, mass, "
     "initial, start, relax, "
     "boundary, loads, bodies, time, output, checkpoint\n"
     ":2:3: a key must be a single word\n"},
    {"mesh:\n",
     "time: &x 3\n"
     "mesh:\n",
     ":1:10: anchors, aliases and tags are not supported\n"
     ":16:1: time: given twice, first at line 1 column 1\n"},
    {"  - {set: z+, component: z, velocity: 6.086}\n",
     "  - {set: z+, set: z-, component: z, velocity: 6.086, a.b: 3}\n"
     "  -\n"
     "  - {}\n"
     "  - []\n",
     ":14:3: boundary[1]: no value; allowed: " BOUNDARY_LIST "\n"
     ":14:15: boundary[0].set: given twice, first at line 14 column 6\n"
     ":14:55: boundary[0].a.b: unknown key: the parts of a dotted key stand on lines of their own\n"
     ":16:5: boundary[2]: missing set or where; allowed: exactly one of set, where\n"
     ":16:5: boundary[2]: missing " MOTIONS(
         " or ") " or absorbing or dashpot; " ONE_MOTION
                 ":17:5: boundary[3]: []: not a mapping of keys; allowed: " BOUNDARY_LIST "\n"},
    {"boundary:\n"
     "  - {set: z+, component: z, velocity: 6.086}\n",
     "boundary:\n", ":13:1: boundary: no value; allowed: " BOUNDARY_LIST "\n"},
};

static const mistake yaml[] = {
    {"young: 260e9", "young: !!float 1", ":6:18: anchors, aliases and tags are not supported\n"},
    {"young: 260e9", "young: &a 1", ":6:13: anchors, aliases and tags are not supported\n"},
    {"mesh:\n", "mesh: !x\n", ":2:3: anchors, aliases and tags are not supported\n"},
    {"[2, 2, 4]", "[2, *b, &c 4]",
     ":2:14: anchors, aliases and tags are not supported\n"
     ":2:21: anchors, aliases and tags are not supported\n"},
    {"  law: linear\n", "  law: [linear\n", ":12:9: not valid YAML: missing comma in flow sequence\n"},
    {"young: 260e9", "young: \303\251\007", ":6:11: byte 0x07 is not text (UTF-8)\n"},
    {NULL,
     "a: 1\n"
     "...\n"
     "---\n"
     "3\n"
     "---\n"
     "[4]\n",
     ":4:1: a second YAML document; a case is one document\n"},
    {NULL, "--- 3\n", ":1:5: 3: a case is a mapping of keys\n"},
    {NULL, "just a text\n", ":1:1: just a text: a case is a mapping of keys\n"},
    {NULL, "~\n", ":1:1: ~: a case is a mapping of keys\n"},
    {NULL, "a: \"unclosed\n", ":1:5: not valid YAML: double-quoted scalar without closing quote\n"},
};

/* Lists may lie 32 deep. */
static void test_nesting(void **state) {
    (void)state;
    for (int depth = 31; depth <= 33; depth++) {
        char text[80] = "", message[512] = ":1:33: nested too deeply\n";
        memset(text, '[', (size_t)depth);
        memset(text + depth, ']', (size_t)depth);
        write_bytes(text, 2 * (size_t)depth);
        if (depth < 33) {
            snprintf(message, sizeof message, ":1:1: %.*s: a case is a mapping of keys\n", 2 * depth, text);
        }
        if (depth > 31) { /* of a long value the beginning is shown */
            snprintf(message, sizeof message,
                     depth == 32 ? ":1:1: %.60s...: a case is a mapping of keys\n" : "%s",
                     depth == 32 ? text : ":1:33: nested too deeply\n");
        }
        expect_messages(0, NULL, message);
    }
}
static void test_numbers_and_texts(void **state) {
    (void)state;
    expect_mistakes(numbers_and_texts, sizeof numbers_and_texts / sizeof *numbers_and_texts);
}

static void test_keys(void **state) {
    (void)state;
    expect_mistakes(keys, sizeof keys / sizeof *keys);
}

static void test_yaml(void **state) {
    (void)state;
    expect_mistakes(yaml, sizeof yaml / sizeof *yaml);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_numbers_and_texts),
        cmocka_unit_test(test_keys),
        cmocka_unit_test(test_yaml),
        cmocka_unit_test(test_nesting),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
