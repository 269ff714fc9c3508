/* Keys of an anisotropic solid: read, written and read again, from a table, and what is refused. */
#include "case/echo.h"
#include "case/read.h"
#include "support/case_input.h"

#define ISOTROPIC "  model: neo-hookean\n  young: 260e9\n  poisson: 0.21\n  density: 3690\n"
#define COPPER                                                                                               \
    "[168.4e9, 121.4e9, 121.4e9, 0, 0, 0, 168.4e9, 121.4e9, 0, 0, 0, 168.4e9, 0, 0, 0, 75.4e9, 0, 0, "       \
    "75.4e9, 0, 75.4e9]"

static void write_solid(const char *keys) {
    char block[1024];
    snprintf(block, sizeof block, "  model: anisotropic\n  density: 8960\n%s", keys);
    write_changed(ISOTROPIC, block);
}

/* Reads the case that `c` is written as. */
static rg_case *read_again(const rg_case *c) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    rg_case_echo(c, file);
    assert_int_equal(fclose(file), 0);
    return read_good(path, 0, NULL);
}

static void test_constants(void **state) {
    (void)state;
    write_solid("  stiffness: " COPPER "\n  orientation: {axis_1: [1, 1, 0], axis_2: [0, 0, 2]}\n");
    rg_case *c = read_good(path, 0, NULL);
    for (int twice = 0; twice < 2; twice++) {
        const rg_anisotropic_input *a = &c->material.anisotropic;
        assert_true(c->material.model == RG_MATERIAL_ANISOTROPIC && c->material.density == 8960);
        for (int k = 0; k < RG_STIFFNESS; k++) {
            bool shear = k == 15 || k == 18 || k == 20, along = k == 0 || k == 6 || k == 11;
            bool across = k == 1 || k == 2 || k == 7;
            assert_true(a->stiffness[k] == (along ? 168.4e9 : across ? 121.4e9 : shear ? 75.4e9 : 0));
        }
        assert_true(a->axis[0][0] == 1 && a->axis[0][1] == 1 && a->axis[1][2] == 2 && a->young[0] == 0);
        rg_case *again = read_again(c);
        rg_case_free(c);
        c = again;
    }
    rg_case_free(c);
}

static void test_three_planes(void **state) {
    (void)state;
    write_solid("  young: [10e9, 20e9, 40e9]\n  poisson: [0.25, -0.1, 0.4]\n  shear: [3e9, 5e9, 7e9]\n"
                "  orientation: {angles: [10, 20, -30]}\n");
    rg_case *c = read_good(path, 0, NULL);
    for (int twice = 0; twice < 2; twice++) {
        const rg_anisotropic_input *a = &c->material.anisotropic;
        assert_true(a->young[0] == 10e9 && a->young[1] == 20e9 && a->young[2] == 40e9);
        assert_true(a->poisson[0] == 0.25 && a->poisson[1] == -0.1 && a->poisson[2] == 0.4);
        assert_true(a->shear[0] == 3e9 && a->shear[1] == 5e9 && a->shear[2] == 7e9);
        assert_true(a->angles[0] == 10 && a->angles[1] == 20 && a->angles[2] == -30);
        assert_true(c->material.young == 0 && c->material.poisson == 0 && a->stiffness[0] == 0);
        rg_case *again = read_again(c);
        rg_case_free(c);
        c = again;
    }
    rg_case_free(c);
}

static void test_axes_of_elements(void **state) {
    (void)state;
    write_solid("  stiffness: " COPPER "\n  orientation: {angle_1: 90*x, angle_3: 30}\n");
    rg_case *c = read_good(path, 0, NULL);
    for (int twice = 0; twice < 2; twice++) {
        const rg_anisotropic_input *a = &c->material.anisotropic;
        assert_true(a->angle[1] == NULL && a->field == NULL && rg_material_axes_vary(&c->material));
        assert_string_equal(rg_expr_text(a->angle[0]), "90*x");
        assert_string_equal(rg_expr_text(a->angle[2]), "30");
        rg_case *again = read_again(c);
        rg_case_free(c);
        c = again;
    }
    rg_case_free(c);
}

static char csv[80];

static void write_csv(const char *text) {
    snprintf(csv, sizeof csv, "%s/grains.csv", directory);
    FILE *file = fopen(csv, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, strlen(text), file), strlen(text));
    assert_int_equal(fclose(file), 0);
}

static const char grains[] =
    "mesh: {file: grains.csv}\n" /* as long as it can be read */
    "material: {model: anisotropic, density: 8960, stiffness: " COPPER "}\n"
    "materials:\n"
    "  - {file: grains.csv, name: g, model: anisotropic, density: 8960, stiffness: " COPPER "}\n"
    "interface: {law: none}\n"
    "time: {end: 1e-6}\n";

static void test_table_of_angles(void **state) {
    (void)state;
    write_bytes(grains, strlen(grains));
    write_csv("set,angle_1,angle_2,angle_3\na,10,20,30\nb,-1.5,0,360\n");
    rg_case *c = read_good(path, 0, NULL);
    assert_int_equal(c->others, 2);
    for (int k = 0; k < 2; k++) {
        const rg_anisotropic_input *a = &c->other[k].is.anisotropic;
        const double expected[2][3] = {{10, 20, 30}, {-1.5, 0, 360}};
        assert_memory_equal(a->angles, expected[k], sizeof a->angles);
        assert_true(a->stiffness[20] == 75.4e9);
    }
    rg_case_free(c);
#define FILE_KEY ":4:12: materials[0].file: grains.csv: "
    write_csv("set,angle_1,angle_2\na,10,20\n");
    expect_messages(0, NULL, FILE_KEY "of the columns angle_1, angle_2, angle_3 there are but 2\n");
    write_csv("set,angle_1,angle_2,angle_3\na,10,20,\n");
    expect_messages(0, NULL, ":4:12: materials[0].orientation.angles[2]: no value; allowed: number\n");
    static const char *const both[] = {
        "materials=[{file: grains.csv, name: g, model: anisotropic, orientation: {}}]"};
    expect_messages(
        1, both,
        "--set materials=[{file: grains.csv, name: g, model: anisotropic, orientation: {}}]: "
        "materials[0].file: grains.csv: orientation is given beside the file's columns of angles\n");
    unlink(csv);
}

static void test_refused(void **state) {
    (void)state;
    static const struct {
        const char *keys, *messages;
    } wrong[] = {
        {"", ":5:3: material: missing stiffness; allowed: stiffness, or young, poisson, shear\n"},
        {"  young: 260e9\n  shear: [1, 2, 3]\n",
         ":7:10: material.young: 260e9: not a list; allowed: [E1, E2, E3], each number > 0 (Pa)\n"},
        {"  stiffness: [1, 2, 3]\n",
         ":7:14: material.stiffness: [1, 2, 3]: wrong number of entries; allowed: [C11, C12, ..., C66], each "
         "number (Pa)\n"},
        {"  stiffness: " COPPER "\n  young: [1, 1, 1]\n",
         ":7:3: material.stiffness: given beside young, poisson or shear; allowed: stiffness, or young, "
         "poisson, shear\n"},
        {"  young: [1, 1, 1]\n",
         ":5:3: material: missing shear; allowed: stiffness, or young, poisson, shear\n"},
        {"  shear: [1, 1, 1]\n",
         ":5:3: material: missing young; allowed: stiffness, or young, poisson, shear\n"},
        {"  stiffness: [1, 2, 2, 0, 0, 0, 1, 2, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 1]\n",
         ":7:3: material.stiffness: not positive definite: its smallest eigenvalue is -1 Pa\n"},
        {"  young: [2, 2, 2]\n  poisson: [0.6, 0.6, 0.6]\n  shear: [1, 1, 1]\n",
         ":8:3: material.poisson: with these, the compliance is not positive definite: its smallest "
         "eigenvalue is -0.1 1/Pa\n"},
        {"  stiffness: " COPPER "\n  orientation: {axis_1: [1, 0, 0]}\n",
         ":8:17: material.orientation.axis_1: not used without axis_2\n"},
        {"  stiffness: " COPPER "\n  orientation: {axis_2: [1, 0, 0]}\n",
         ":8:17: material.orientation.axis_2: not used without axis_1\n"},
        {"  stiffness: " COPPER "\n  orientation: {axis_1: [1, 0, 0], axis_2: [-2, 0, 0]}\n",
         ":8:36: material.orientation.axis_2: along axis_1, or one of them is 0\n"},
        {"  stiffness: " COPPER
         "\n  orientation: {axis_1: [1, 0, 0], axis_2: [0, 1, 0], angles: [1, 2, 3]}\n",
         ":8:55: material.orientation.angles: given beside axes\n"},
        {"  stiffness: " COPPER "\n  orientation: {axis_1: [1, 0, 0], angle_2: x}\n",
         ":8:36: material.orientation.angle_2: given beside axes\n"},
        {"  stiffness: " COPPER "\n  orientation: {angles: [1, 2, 3], angle_3: x}\n",
         ":8:17: material.orientation.angles: given beside angle_3\n"},
        {"  stiffness: " COPPER "\n  orientation: {angle_1: x, field: axes}\n",
         ":8:29: material.orientation.field: given beside angle_1\n"},
        {"  stiffness: " COPPER "\n  orientation: {field: axes}\n",
         ":8:17: material.orientation.field: not used with the box: it is a dataset of a mesh file\n"},
        {"  stiffness: " COPPER "\n  orientation: {angle_1: 3*t}\n",
         ":8:26: material.orientation.angle_1: 3*t: depends on t, but this is the state at the start; "
         "allowed: number "
         "or expression in x, y, z (degrees)\n"},
        {"  stiffness: " COPPER "\n  orientation: {angle_1: x}\ninitial: {stress: {xx: 1}}\n",
         ":1:1: initial.stress: not with material, whose axes differ from element to element: what the "
         "stress has stored would not be known\n"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        write_solid(wrong[i].keys);
        expect_messages(0, NULL, wrong[i].messages);
    }
    write_changed("  density: 3690\n", "  density: 3690\n  stiffness: " COPPER "\n");
    expect_messages(0, NULL,
                    ":9:3: material.stiffness: [168.4e9, 121.4e9, 121.4e9, 0, 0, 0, 168.4e9, 121.4e9, 0, 0,"
                    "...: not used, because material.model is neo-hookean; it belongs to anisotropic\n");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_constants),        cmocka_unit_test(test_three_planes),
        cmocka_unit_test(test_axes_of_elements), cmocka_unit_test(test_table_of_angles),
        cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
