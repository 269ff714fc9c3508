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
/* Texts of any length: `count` operands, each by `write` from its number. */
typedef void writer(int k, FILE *out);

static rg_expr *of_many(int count, writer *write, const char *join, const char *around) {
    char *text = NULL, *message = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    fprintf(out, "%s", around);
    for (int k = 0; k < count; k++) {
        fprintf(out, "%s", k > 0 ? join : "");
        write(k, out);
    }
    fprintf(out, "%s", *around == '(' ? ")\n" : "");
    fclose(out);
    assert_true(size > 40000); /* of which no operand may have half */
    rg_expr *e = rg_expr_with(text, &tables, &message);
    if (e == NULL) {
        print_message("%s\n", message);
    }
    assert_non_null(e);
    assert_string_equal(rg_expr_text(e), text);
    assert_false(rg_expr_is_number(e));
    free(text);
    return e;
}

static void box(int k, FILE *out) {
    fprintf(out, "(abs(x - %d) < 0.25 && (y > 0 || z > %d))", 3 * k, k);
}

static void slab(int k, FILE *out) {
    fprintf(out, "abs(x - %d) > 0.25", 3 * k);
}

/* Signs of exponents and operands are no joints. */
static void term(int k, FILE *out) {
    fprintf(out, "%d.e+0*nx - 2.5E+1*(y + t) * +%d", k, k);
}

static void longer(int k, FILE *out) {
    fprintf(out, "(0 > 1");
    for (int i = 0; i < 2000; i++) {
        fprintf(out, " || abs(x - %d) < 0.25", 3 * (2000 * k + i));
    }
    fprintf(out, ")");
}

static double value_at(const rg_expr *e, double x, double y, double z) {
    return rg_expr_value(e, (const double[3]){x, y, z}, 2);
}

static void test_any_length(void **state) {
    (void)state;
    enum { MANY = 2000 };
    rg_expr *e = of_many(MANY, box, " || ", "");
    for (int k = -1; k <= MANY; k++) {
        bool in = k >= 0 && k < MANY;
        assert_true(value_at(e, 3 * k + 0.2, 1, 0) == in && value_at(e, 3 * k, -1, k + 0.5) == in);
        assert_true(value_at(e, 3 * k + 0.3, 1, 0) == 0 && value_at(e, 3 * k, -1, k - 0.5) == 0);
    }
    assert_true(rg_expr_uses_position(e) && !rg_expr_uses_time(e) && !rg_expr_uses_normal(e));
    rg_expr *again = rg_expr_copy(e);
    assert_true(value_at(again, 3 * (MANY - 1), 1, 0) == 1);
    rg_expr_free(again);
    rg_expr_free(e);
    e = of_many(MANY, slab, "&&", "(");
    for (int k = -1; k <= MANY; k++) {
        assert_true(value_at(e, 3 * k + 0.2, 1, 0) == (k < 0 || k == MANY) &&
                    value_at(e, 3 * k + 0.3, 1, 0) == 1);
    }
    rg_expr_free(e);
    e = of_many(MANY, term, " + ", " ");
    double sum = MANY * (MANY - 1) / 2.0, normal[3] = {0.5, 0, 0};
    assert_true(rg_expr_face_value(e, (const double[3]){0, 3, 0}, normal) == sum * (0.5 - 25 * 3));
    assert_true(rg_expr_value(e, (const double[3]){0, 3, 0}, 2) == sum * (0.5 - 25 * 5));
    assert_true(rg_expr_uses_position(e) && rg_expr_uses_time(e) && rg_expr_uses_normal(e));
    rg_expr_free(e);
    e = of_many(2, longer, "||", ""); /* operands that are taken apart in turn */
    assert_true(value_at(e, 3 * 3999, 0, 0) == 1 && value_at(e, 3 * 4000, 0, 0) == 0 &&
                value_at(e, 6, 0, 0) == 1);
    rg_expr_free(e);
}

/* What is wrong with a piece is told as of the whole; what cannot be taken apart is. */
static void test_long_mistakes(void **state) {
    (void)state;
    static const struct {
        const char *first, *middle, *last, *message;
    } wrong[] = {{"x > 1 || ", "1 || 1", "|| v > 2", "Unexpected token \"v\" found at position"},
                 {"x > 1 ? 1 : ", "1 +", "2", "an operand is longer than 19999 characters"},
                 {"max(x, ", "1 + ", "2)", "an operand is longer than 19999 characters"},
                 {"x < y + ", "1 + ", "2", "an operand is longer than 19999 characters"},
                 {"1e+", "1 ^", "2", "an operand is longer than 19999 characters"},
                 {"x || ", "1 || 1", "|| (y", "Missing parenthesis"},
                 {"1/0 + ", "1 + 1", "+ 2", "not finite"}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char *text = RG_NEW(char, 25001), *message = NULL;
        memset(text, ' ', 25000);
        memcpy(text, wrong[i].first, strlen(wrong[i].first));
        memcpy(text + 12000, wrong[i].middle, strlen(wrong[i].middle));
        memcpy(text + 25000 - strlen(wrong[i].last), wrong[i].last, strlen(wrong[i].last));
        assert_null(rg_expr_new(text, &message));
        if (strncmp(message, wrong[i].message, strlen(wrong[i].message)) != 0) {
            print_message("%s: %s\n", wrong[i].first, message);
        }
        assert_true(strncmp(message, wrong[i].message, strlen(wrong[i].message)) == 0);
        rg_free(message);
        rg_free(text);
    }
}

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
        cmocka_unit_test(test_values),     cmocka_unit_test(test_all_that_is_listed),
        cmocka_unit_test(test_any_length), cmocka_unit_test(test_long_mistakes),
        cmocka_unit_test(test_normal),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    return failed + (rg_alloc_blocks() > 0); /* all is given back */
}
