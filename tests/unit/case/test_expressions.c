/* What `rhegma keys` says that expressions know: each of it does what C does. */
#include <math.h>

#include "case/expr.h"
#include "support/case_input.h"

static const double at[3] = {0.3, 0.7, 2.5}, now = 1.25;

static const struct {
    const char *name; /* as listed; NULL: the one before */
    const char *text;
    double value;
} known[] = {
    {"x, y, z", "x + 10*y + 100*z", 257.3},
    {"t", "t", 1.25},
    {"pi", "pi", 3.14159265358979323846},
    {"_e", "_e", 2.71828182845904523536},
    {"+ - * / ^", "x + y - z*t/4", 0.3 + 0.7 - 2.5 * 1.25 / 4},
    {NULL, "2^3^2", 512},
    {NULL, "-2^2", -4},
    {"< <= > >= == !=", "(1 < 2) + 2*(2 <= 2) + 4*(2 > 1) + 8*(1 >= 1) + 16*(1 == 1) + 32*(1 != 2)", 63},
    {NULL, "(2 < 1) + (2 <= 1) + (1 > 2) + (1 >= 2) + (1 == 2) + (1 != 1)", 0},
    {"&& ||", "(1 && 0) + 2*(0 || 1)", 2},
    {"a ? b : c", "x ? 3 : 4", 3},
    {NULL, "x < 0 ? 3 : 4", 4},
    {"sin(a)", "sin(x)", 0.29552020666133957510},
    {"cos(a)", "cos(x)", 0.95533648912560601964},
    {"tan(a)", "tan(x)", 0.30933624960962323303},
    {"asin(a)", "asin(sin(x))", 0.3},
    {"acos(a)", "acos(cos(x))", 0.3},
    {"atan(a)", "atan(tan(x))", 0.3},
    {"atan2(a, b)", "atan2(1, -1)", 2.35619449019234492885},
    {"sinh(a)", "sinh(x)", 0.30452029344714261896},
    {"cosh(a)", "cosh(x)", 1.04533851412886046925},
    {"tanh(a)", "tanh(x)", 0.29131261245159090581},
    {"asinh(a)", "asinh(sinh(x))", 0.3},
    {"acosh(a)", "acosh(cosh(x))", 0.3},
    {"atanh(a)", "atanh(tanh(x))", 0.3},
    {"exp(a)", "exp(x)", 1.34985880757600310398},
    {"log(a)", "log(exp(x))", 0.3},
    {"ln(a)", "ln(exp(x))", 0.3},
    {"log2(a)", "log2(8)", 3},
    {"log10(a)", "log10(1000)", 3},
    {"sqrt(a)", "sqrt(z)", 1.58113883008418966600},
    {"abs(a)", "abs(-x)", 0.3},
    {"sign(a)", "sign(-z) + 10*sign(z) + 100*sign(0*z)", 9},
    {"rint(a)", "rint(2.6) + rint(-1.4)", 2},
    {"min(a, ...)", "min(z, x, y)", 0.3},
    {"max(a, ...)", "max(x, z, y)", 2.5},
    {"sum(a, ...)", "sum(x, y, z)", 3.5},
    {"avg(a, ...)", "avg(x, y, z)", 3.5 / 3},
    {"name(a)", "name(t) + 10*name(z)", 22.75},
};

static double straight[2][2] = {{1, 3}, {2, 2}}; /* the table `name` */
static rg_curve curve = {.name = (char[]){"name"}, .points = 2, .point = straight};
static const rg_curves tables = {1, &curve};

static void test_values(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        char *message = NULL;
        rg_expr *e = rg_expr_with(known[i].text, &tables, &message);
        if (e == NULL) {
            fail_msg("%s: %s", known[i].text, message);
        }
        double value = rg_expr_value(e, at, now);
        if (!(fabs(value - known[i].value) <= 4e-16 * fmax(1, fabs(value)))) {
            fail_msg("%s: %.17g, not %.17g", known[i].text, value, known[i].value);
        }
        rg_expr_free(e);
    }
}

/* The words of the list one by one: names that stand alone, or each call of a line. */
static bool is_tried(const char *name, size_t length) {
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        if (known[i].name != NULL && strlen(known[i].name) == length &&
            strncmp(known[i].name, name, length) == 0) {
            return true;
        }
    }
    return false;
}

static void expect_tried(const char *line) {
    const char *end = strchr(line, ')');
    if (strchr(line, '(') == NULL) {
        assert_true(strcmp(line, "nx, ny, nz") == 0 || is_tried(line, strlen(line)));
        return;
    }
    for (; end != NULL; end = strchr(line, ')')) {
        if (!is_tried(line, (size_t)(end - line) + 1)) {
            fail_msg("no test tries %s", line);
        }
        line = end[1] == ' ' ? end + 2 : end + 1;
    }
}

static void test_all_that_is_listed(void **state) {
    (void)state;
    int lines = 0, calls = 0;
    for (const rg_expr_word *word = rg_expr_words; word->write != NULL; word++) {
        assert_true(word->meaning[0] != '\0');
        expect_tried(word->write);
        lines++;
    }
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) { /* and nothing else is tried */
        bool listed = known[i].name == NULL;
        for (const rg_expr_word *word = rg_expr_words; word->write != NULL; word++) {
            listed = listed || strstr(word->write, known[i].name) != NULL;
        }
        assert_true(listed);
        calls += known[i].name != NULL && strchr(known[i].name, '(') != NULL ? 1 : 0;
    }
    assert_true(lines > 0 && calls == 27);
}

/* The normal of a face, nx, ny, nz. */
static void test_normal(void **state) {
    (void)state;
    char *message = NULL;
    rg_expr *e = rg_expr_new("nx + 10*ny + 100*nz + 1000*z", &message);
    assert_non_null(e);
    assert_true(rg_expr_face_value(e, at, (double[3]){1, 2, 3}) == 2821);
    rg_expr_free(e);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_values),
        cmocka_unit_test(test_all_that_is_listed),
        cmocka_unit_test(test_normal),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    return failed + (rg_alloc_blocks() > 0); /* all is given back */
}
