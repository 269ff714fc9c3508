/* The tables of a case: what functions they make, from points and from files, and what is refused of them. */
#include <math.h>

#include "case/curve.h"
#include "case/echo.h"
#include "case/key.h"
#include "support/case_input.h"

static char csv[80]; /* beside the case file */

static void write_csv(const char *text) {
    snprintf(csv, sizeof csv, "%s/pulse.csv", directory);
    FILE *file = fopen(csv, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, strlen(text), file), strlen(text));
    assert_int_equal(fclose(file), 0);
}

static rg_curve points(size_t count, double (*point)[2]) {
    return (rg_curve){.points = count, .point = point};
}

/* ---- functions ---- */

static void test_straight(void **state) {
    (void)state;
    double p[][2] = {{-1, 4}, {0, 0}, {2, 8}, {2.5, -1}};
    rg_curve c = points(4, p);
    static const double known[][2] = {{-INFINITY, 4}, {-1.5, 4}, {-1, 4},       {-0.75, 3},
                                      {0, 0},         {0.5, 2},  {2, 8},        {2.25, 3.5},
                                      {2.5, -1},      {3, -1},   {INFINITY, -1}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        assert_true(rg_curve_value(&c, known[i][0]) == known[i][1]);
    }
    assert_true(isnan(rg_curve_value(&c, NAN)));
}

/* Two points alone: the cubic with slope 0 at both ends. */
static void test_smooth_step(void **state) {
    (void)state;
    double p[][2] = {{1, 2}, {5, 10}};
    rg_curve c = points(2, p);
    rg_curve_smooth(&c);
    for (int i = 0; i <= 8; i++) {
        double s = i / 8.0, known = 2 + 8 * s * s * (3 - 2 * s);
        assert_true(fabs(rg_curve_value(&c, 1 + 4 * s) - known) <= 1e-14);
    }
    rg_free(c.slope);
}

/* Through its points, monotone between them, with a slope that does not jump; by the formula at one of them.
 */
static void test_smooth(void **state) {
    (void)state;
    double p[][2] = {{0, 0}, {1, 2}, {3, 10}, {4, 10}, {6, 5}, {7, 6}};
    rg_curve c = points(6, p);
    rg_curve_smooth(&c);
    assert_true(fabs(c.slope[1] - 9 / (5 / 2.0 + 4 / 4.0)) <= 1e-14);
    assert_true(c.slope[0] == 0 && c.slope[2] == 0 && c.slope[3] == 0 && c.slope[4] == 0 && c.slope[5] == 0);
    for (size_t k = 0; k + 1 < c.points; k++) {
        const double *a = p[k], *b = p[k + 1];
        assert_true(rg_curve_value(&c, a[0]) == a[1]);
        double last = a[1], h = 1e-6;
        for (int i = 1; i <= 50; i++) {
            double v = rg_curve_value(&c, a[0] + (b[0] - a[0]) * i / 50.0);
            assert_true((v - last) * (b[1] - a[1]) >= 0);
            last = v;
        }
        double left = (a[1] - rg_curve_value(&c, a[0] - h)) / h,
               right = (rg_curve_value(&c, a[0] + h) - a[1]) / h;
        assert_true(fabs(left - c.slope[k]) < 1e-4 && fabs(right - c.slope[k]) < 1e-4);
    }
    rg_free(c.slope);
}

/* ---- in a case ---- */

static double value_of(const rg_case *c, double z, double t) {
    const double x[3] = {0, 0, z};
    return rg_expr_value(c->boundary[0].value, x, t);
}

static const char *const from = "velocity: 6.086}\n";

/* Points, a file and a smooth one, called by one another's side; what the run writes reads back to the same.
 */
static void test_case(void **state) {
    (void)state;
    write_csv("\xef\xbb\xbftime, pressure\r\n# from a gauge\r\n0, 0\r\n\r\n  1e-6;5\n4e-6\t-1");
    write_changed(from, "velocity: '10*ramp(t) + pulse(t)*(z > 1 ? 2 : 3) + soft(z)'}\n"
                        "tables:\n  ramp: [[0, 0], [1e-6, 1]]\n  pulse: pulse.csv\n"
                        "  soft: {smooth: true, points: [[0, 0], [2, 4]]}\n");
    rg_case *c = read_good(path, 0, NULL);
    assert_int_equal(c->tables.count, 3);
    assert_true(fabs(value_of(c, 0, 5e-7) - (5 + 7.5)) < 1e-14);
    assert_true(fabs(value_of(c, 1.5, 3e-6) - (10 + 2 + 4 * 0.5625 * 1.5)) < 1e-14);
    assert_true(fabs(value_of(c, 0, 1) - (10 - 3)) < 1e-14);
    rg_expr *copy = rg_expr_copy(c->boundary[0].value);
    assert_true(rg_expr_value(copy, (double[3]){0, 0, 0}, 5e-7) == value_of(c, 0, 5e-7));
    rg_expr_free(copy);
    FILE *file = fopen(path, "w");
    rg_case_echo(c, file);
    fclose(file);
    remove(csv); /* it is not needed any more */
    rg_case *again = read_good(path, 0, NULL);
    for (int i = 0; i < 40; i++) {
        assert_true(value_of(again, 0.1 * i, 1.7e-7 * i) == value_of(c, 0.1 * i, 1.7e-7 * i));
    }
    rg_case_free(again);
    rg_case_free(c);
}

static void test_mistakes(void **state) {
    (void)state;
    static const mistake list[] = {
        {"time:\n", "tables: [1]\ntime:\n",
         ":15:9: tables: [1]: not a mapping of names to tables; allowed: $TABLES\n"},
        {"time:\n",
         "tables:\n  sin: [[0, 0], [1, 1]]\n  a-b: [[0, 0], [1, 1]]\n  nx: [[0, 0], [1, 1]]\ntime:\n",
         ":16:3: tables.sin: expressions know this word as their own; allowed: a letter, then letters, "
         "digits and _\n"
         ":17:3: tables.a-b: not a name for a function; allowed: a letter, then letters, digits and _\n"
         ":18:3: tables.nx: expressions know this word as their own; allowed: a letter, then letters, digits "
         "and _\n"},
        {"time:\n", "tables:\n  f: [[0, 0]]\n  g: [[0, 0], [0, 1]]\n  h: [[0, x], [1, 1], 3]\ntime:\n",
         ":16:6: tables.f: [[0, 0]]: fewer than two points; allowed: $TABLES\n"
         ":17:15: tables.g[1]: [0, 1]: its argument is not above the one before; allowed: $TABLES\n"
         ":18:11: tables.h[0][1]: x: not a number; allowed: $TABLES\n"
         ":18:23: tables.h[2]: 3: not a pair [argument, value]; allowed: $TABLES\n"},
        {"time:\n",
         "tables:\n  f: {smooth: maybe, points: [[0, 0], [1, 1]]}\n  g: {smooth: true}\n"
         "  h: {point: 1, points: [[0, 0], [1, 1]]}\ntime:\n",
         ":16:15: tables.f.smooth: maybe: neither true nor false; allowed: $TABLES\n"
         ":17:6: tables.g: {smooth: true}: has no points; allowed: $TABLES\n"
         ":18:7: tables.h.point: unknown key; allowed: points, file, smooth; did you mean 'points'?\n"},
        {"time:\n", "tables:\n  f: none.csv\ntime:\n",
         ":16:6: tables.f: none.csv: cannot be read: No such file or directory; allowed: $TABLES\n"},
        {"velocity: 6.086", "velocity: 'f(t)'",
         ":14:39: boundary[0].velocity: \"f(t)\": Unexpected token \"f\" found at position 0.; allowed: "
         "number or "
         "expression in x, y, z, t (m/s)\n"},
    };
    for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
        char words[512], lines[4096] = "";
        rg_key_allowed(rg_key_find(&rg_case_table, "tables"), words, sizeof words);
        for (const char *at = list[i].messages; *at != '\0';) {
            const char *mark = strstr(at, "$TABLES");
            int length = mark == NULL ? (int)strlen(at) : (int)(mark - at);
            rg_text_add(lines, sizeof lines, "%.*s%s", length, at, mark == NULL ? "" : words);
            at += length + (mark == NULL ? 0 : 7);
        }
        write_changed(list[i].from, list[i].to);
        expect_messages(0, NULL, lines);
    }
}

/* What is wrong in a file is told with its line. */
static void test_wrong_files(void **state) {
    (void)state;
    static const char *const known[][2] = {
        {"0, 0\n1, one\n", "line 2: 'one' is not a finite number"},
        {"t, p\nt, p\n", "line 2: 't' is not a finite number"},
        {"0, 0\n1\n", "line 2: 1 numbers where two are needed"},
        {"0, 0\n1, 2, 3\n", "line 2: more than two numbers"},
        {"0,5; 0,1\n", "line 1: more than two numbers"},
        {"0,, 1\n", "line 1: '' is not a finite number"},
        {"0 0\n\n0 1\n", "line 3: 0 is not above the argument before, 0"},
        {"0 0\n1e999 1\n", "line 2: '1e999' is not a finite number"},
        {"# nothing\n0 0\n", "fewer than two points"},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        rg_curve c = {0};
        char *what = rg_curve_parse(&c, known[i][0], strlen(known[i][0]));
        assert_non_null(what);
        assert_string_equal(what, known[i][1]);
        rg_free(what);
        rg_free(c.point);
    }
}

/* ---- materials in the rows of a file ---- */

static const char grains[] =
    "mesh: {file: bar.yaml}\nmaterial: {model: neo-hookean, young: 1, poisson: 0, density: 1}\n"
    "materials:\n  - {name: first, where: x, model: linear-elastic, young: 2, poisson: 0.1, density: 3}\n"
    "  - {name: g, file: pulse.csv, model: neo-hookean, density: 7}\n"
    "  - {name: last, set: end, model: neo-hookean, young: 5, poisson: 0.3, density: 6}\n"
    "interface: {law: none}\ntime: {end: 1}\n";

static void test_materials(void **state) {
    (void)state;
    write_bytes(grains, strlen(grains));
    for (int own = 0; own < 2; own++) {
        write_csv(own ? "young,name,set,poisson\n\n1e9,steel,grain.1,0.25\n  # none\n2.5e9,iron,12,0.125"
                      : " set , young,poisson\r\ngrain.1 ,\t1e9,0.25\r\n12,2.5e9,0.125\r\n");
        rg_case *c = read_good(path, 0, NULL);
        assert_int_equal(c->others, 4);
        const struct {
            const char *name, *set;
            double young, poisson, density;
        } row[] = {{"first", NULL, 2, 0.1, 3},
                   {own ? "steel" : "g-1", "grain.1", 1e9, 0.25, 7},
                   {own ? "iron" : "g-2", "12", 2.5e9, 0.125, 7},
                   {"last", "end", 5, 0.3, 6}};
        for (int k = 0; k < 4; k++) {
            const rg_other_material *o = &c->other[k];
            assert_string_equal(o->is.name, row[k].name);
            assert_true(row[k].set == NULL ? o->set == NULL && o->where != NULL
                                           : strcmp(o->set, row[k].set) == 0);
            assert_true(o->is.young == row[k].young && o->is.poisson == row[k].poisson &&
                        o->is.density == row[k].density && o->file == NULL);
        }
        rg_case_free(c);
    }
}

/* Polycrystals have thousands. */
static void test_many_materials(void **state) {
    (void)state;
    enum { OTHERS = 1000 };
    static char text[100 * OTHERS], whole[100 * OTHERS + 8192];
    size_t used = (size_t)snprintf(text, sizeof text, "materials:\n");
    for (int i = 0; i < OTHERS; i++) {
        used += (size_t)snprintf(
            text + used, sizeof text - used,
            "  - {name: m%d, where: 1, model: neo-hookean, young: 1, poisson: 0, density: 1}\n", i);
    }
    snprintf(text + used, sizeof text - used, "interface:\n  sets: [{between: [m0, m%d]}]\n", OTHERS - 1);
    const char *rest = strstr(base, "interface:\n");
    snprintf(whole, sizeof whole, "%.*s%s%s", (int)(rest - base), base, text, rest + strlen("interface:\n"));
    write_bytes(whole, strlen(whole));
    rg_case *c = read_good(path, 0, NULL);
    assert_int_equal(c->others, OTHERS);
    assert_int_equal(rg_case_find_material(c, "m999"), OTHERS);
    assert_int_equal(rg_case_find_material(c, "material"), 0);
    assert_int_equal(rg_case_find_material(c, "m1000"), -1);
    assert_string_equal(rg_case_material_name(c, 2), "m1");
    assert_ptr_equal(rg_case_material(c, 2), &c->other[1].is);
    rg_case_free(c);
}

static void test_wrong_materials(void **state) {
    (void)state;
#define FILE_KEY ":5:21: materials[1].file: pulse.csv: "
    static const struct {
        const char *csv, *messages;
    } wrong[] = {
        {"set,young,poisson\n1,2\n", FILE_KEY "line 2 of the file has 2 fields, its first one 3\n"},
        {"young,poisson\n1,2\n", FILE_KEY "its first line names the columns, and there is no column 'set'\n"},
        {"set,young,poisson,young\n", FILE_KEY "column young is there twice\n"},
        {"set,density\n", FILE_KEY "column density of the file is given beside it too\n"},
        {"set,young,poisson\n", FILE_KEY "the file has no rows\n"},
        {"", FILE_KEY "the file has no rows\n"},
        {"set,young,poisson\na,1,0\nb,-1,0\nc,1,x\n",
         ":5:21: materials[2].young: -1: out of range; allowed: number > 0 (Pa)\n"
         ":5:21: materials[3].poisson: x: not a number; allowed: number >= 0 and < 0.5\n"},
        {"set,young,poisson\na,1,\n",
         ":5:5: materials[1].poisson: missing; allowed: number >= 0 and < 0.5\n"},
        {"set,young,poissn,poisson\na,1,0,0\n",
         ":5:15: materials[1].poissn: unknown key; did you mean 'poisson'?\n"},
        {"set,name,young,poisson\na,first,1,0\n", ":5:21: materials[1].name: first: the name of an earlier "
                                                  "material; allowed: letters, digits, _ and -; "
                                                  "unique among materials\n"},
    };
    write_bytes(grains, strlen(grains));
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        write_csv(wrong[i].csv);
        expect_messages(0, NULL, wrong[i].messages);
    }
    unlink(csv);
    expect_messages(0, NULL, FILE_KEY "cannot be read: No such file or directory\n");
    static const char *const list[] = {"materials=[{name: g, file: [1], model: neo-hookean}]"};
    expect_messages(1, list,
                    "--set materials=[{name: g, file: [1], model: neo-hookean}]: materials[0].file: [1]: not "
                    "the path of a CSV file\n");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_straight),       cmocka_unit_test(test_smooth_step),
        cmocka_unit_test(test_smooth),         cmocka_unit_test(test_case),
        cmocka_unit_test(test_mistakes),       cmocka_unit_test(test_wrong_files),
        cmocka_unit_test(test_materials),      cmocka_unit_test(test_wrong_materials),
        cmocka_unit_test(test_many_materials),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
