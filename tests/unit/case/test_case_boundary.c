/* Rules for entries of a boundary, each of them broken. */
#include "case/read.h"
#include "support/case_input.h"

static const mistake boundary[] = {
    {"  - {set: z+, component: z, velocity: 6.086}\n",
     "  - {set: z+, component: z, velocity: 6.086}\n"
     "  - {set: z+, component: y, velocity: 1}\n"
     "  - {set: z-, component: z, displacement: 1}\n"
     "  - {set: z-, component: z, velocity: 1}\n"
     "  - {set: z+, component: y, displacement: x}\n"
     "  - {set: z+, component: q, velocity: 1}\n"
     "  - {set: z+, component: q, velocity: 1}\n"
     "  - {component: z, velocity: 1}\n"
     "  - {set: z+, component: z, velocity: y, displacement: 2}\n"
     "  - {set: {a: 1}, component: [z], velocity: nx}\n"
     "  - {set: x-, absorbing: true}\n"
     "  - {set: x-, absorbing: true, component: x}\n"
     "  - {set: x+, absorbing: false}\n"
     "  - {set: x+, absorbing: 1}\n"
     "  - {set: x+, absorbing: true, name: a}\n"
     "  - {set: x+, absorbing: true, component: x, velocity: 1}\n"
     "  - {set: x+, velocity: 1}\n"
     "  - {set: x+, component: y, velocity: 1, name: p}\n"
     "  - {set: y+, absorbing: true, from: 1}\n"
     "  - {set: y+, component: y, velocity: 1, from: 2, until: 1}\n"
     "  - {set: y+, where: x > 0, normal: 0}\n"
     "  - {set: y+, normal: 0, component: y}\n"
     "  - {set: y+, component: y, direction: [1, 0, 0], velocity: 1}\n"
     "  - {set: y+, direction: [0, 0, 0], velocity: 1}\n"
     "  - {set: y+, angle: x, axis: [0, 0, 1]}\n"
     "  - {set: y+, angle: t}\n"
     "  - {set: y+, angle: t, axis: [0, 0, 0]}\n"
     "  - {set: y+, normal: t, axis: [0, 0, 1], translation: {x: 1}}\n"
     "  - {set: y+, component: x, velocity: 1, until: 1}\n"
     "  - {set: y+, component: x, displacement: 1, from: 1}\n"
     "  - {set: y+, component: x, displacement: 1, from: 2, until: 3}\n",
     ":17:5: boundary[3]: set z- component z is prescribed twice, first at line 16 column 5\n"
     ":18:5: boundary[4]: set z+ component y is prescribed twice, first at line 15 column 5\n"
     ":19:26: boundary[5].component: q: not one of the allowed words; allowed: x, y, z\n"
     ":20:26: boundary[6].component: q: not one of the allowed words; allowed: x, y, z\n"
     ":21:5: boundary[7]: missing set or where; allowed: exactly one of set, where\n"
     ":22:42: boundary[8]: velocity and displacement both given; " ONE_MOTION
     ":23:11: boundary[9].set: {a: 1}: not one of the allowed words; allowed: x-, x+, y-, y+, z-, z+\n"
     ":23:30: boundary[9].component: [z]: not one of the allowed words; allowed: x, y, z\n"
     ":23:45: boundary[9].velocity: nx: depends on a normal, which only faces have; allowed: number or "
     "expression in x, y, z, t (m/s)\n"
     ":25:32: boundary[11].component: not used: it belongs to a velocity or displacement\n"
     ":26:26: boundary[12].absorbing: prescribes nothing; allowed: true\n"
     ":27:26: boundary[13].absorbing: 1: neither true nor false; allowed: true or false\n"
     ":28:32: boundary[14].name: not used: what leaves is `radiated` in energy.csv\n"
     ":29:15: boundary[15]: velocity and absorbing both given; " ONE_MOTION
     ":30:5: boundary[16].component: missing; allowed: x, y, z\n"
     ":32:32: boundary[18].from: not used: a side absorbs all the time\n"
     ":33:58: boundary[19].until: not after `from`\n"
     ":34:15: boundary[20]: set and where both given; allowed: exactly one of set, where\n"
     ":35:26: boundary[21].component: not used: it belongs to a velocity or displacement\n"
     ":36:29: boundary[22]: component and direction both given; allowed: one of component, direction\n"
     ":37:26: boundary[23].direction: [0, 0, 0]: has no direction\n"
     ":38:22: boundary[24].angle: x: depends on x, y or z, but this is the same everywhere; allowed: number "
     "or "
     "expression in t (rad)\n"
     ":39:5: boundary[25].axis: missing: an angle turns about it; allowed: 3 numbers\n"
     ":40:31: boundary[26].axis: [0, 0, 0]: has no direction\n"
     ":41:26: boundary[27].axis: not used: it belongs to an angle\n"
     ":41:43: boundary[27].translation: not used: it belongs to an angle\n"
     ":44:5: boundary[30]: set y+ component x is prescribed twice, first at line 43 column 5\n"
     ":49:14: output.probes[0].name: p: the name of an earlier one in history.csv; allowed: letters, digits, "
     "_ "
     "and -; unique in history.csv\n"},
    /* all that is wrong with an entry; it is compared with no other then */
    {"  - {set: z+, component: z, velocity: 6.086}\n",
     "  - {set: y+, component: x, displacement: 1, from: 1}\n"
     "  - {set: y+, component: x, velocity: 1, from: 5, until: 4}\n"
     "  - {set: x+, absorbing: true, name: b, until: 1, component: x, axis: [1, 0, 0]}\n",
     ":15:58: boundary[1].until: not after `from`\n"
     ":16:32: boundary[2].name: not used: what leaves is `radiated` in energy.csv\n"
     ":16:41: boundary[2].until: not used: a side absorbs all the time\n"
     ":16:51: boundary[2].component: not used: it belongs to a velocity or displacement\n"
     ":16:65: boundary[2].axis: not used: it belongs to an angle\n"},
};

static void test_boundary(void **state) {
    (void)state;
    expect_mistakes(boundary, sizeof boundary / sizeof *boundary);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_boundary),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
