/* What reading a case file is made of: words and how near they are, numbers, the tree of nodes, problems. */
#include "case/read.h"
#include "support/case_input.h"

#include <errno.h>
#include <libfyaml.h>
#include <math.h>

#include "base/error.h"
#include "base/mem.h"
#include "case/compare.h"
#include "case/expr.h"
#include "case/key.h"
#include "case/tree.h"
#include "support/child.h"
#include "support/dice.h"

/* ---- how near words are ---- */

static char lower(char c) {
    return (char)(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
}

/* Edits by their definition. */
static size_t edits(const char *a, size_t m, const char *b, size_t n) {
    if (m == 0 || n == 0) {
        return m + n;
    }
    size_t replaced = edits(a, m - 1, b, n - 1) + (lower(a[m - 1]) != lower(b[n - 1]));
    size_t dropped = edits(a, m - 1, b, n) + 1, added = edits(a, m, b, n - 1) + 1;
    size_t least = dropped < added ? dropped : added;
    return replaced < least ? replaced : least;
}

static size_t random_word(dice *d, char word[8]) {
    static const char letters[] = "abAxy.";
    size_t length = (size_t)(7 * dice_unit(d));
    for (size_t i = 0; i < length; i++) {
        word[i] = letters[(size_t)(6 * dice_unit(d))];
    }
    word[length] = '\0';
    return length;
}

static void test_edit_distance(void **state) {
    (void)state;
    dice d = {3, 0};
    assert_int_equal(rg_edit_distance("kitten", 6, "SITTING!", 7), 3);
    for (int i = 0; i < 400; i++) {
        char a[8], b[8];
        size_t m = random_word(&d, a), n = random_word(&d, b);
        assert_int_equal(rg_edit_distance(a, m, b, n), edits(a, m, b, n));
    }
}

/* The first of the nearest ones, at most a third of the word and one away, and with a letter in common. */
static const char *nearest_of(const char *word, const char *const list[]) {
    const char *best = NULL;
    size_t least = strlen(word) / 3 + 2;
    for (int i = 0; list[i] != NULL; i++) {
        size_t m = strlen(word), n = strlen(list[i]), distance = edits(word, m, list[i], n);
        if (distance < least && distance < (m > n ? m : n)) {
            least = distance;
            best = list[i];
        }
    }
    return best;
}

static void test_nearest_word(void **state) {
    (void)state;
    dice d = {5, 0};
    int found = 0;
    for (int i = 0; i < 200; i++) {
        char word[8], text[4][8];
        const char *list[5] = {NULL};
        random_word(&d, word);
        for (int k = 0; k < 4; k++) {
            random_word(&d, text[k]);
            list[k] = text[k];
        }
        assert_ptr_equal(rg_nearest(word, list), nearest_of(word, list));
        found += rg_nearest(word, list) != NULL;
    }
    assert_true(found > 50 && found < 190);
    char longest[RG_LONGEST_WORD + 2];
    memset(longest, 'q', RG_LONGEST_WORD + 1);
    longest[RG_LONGEST_WORD + 1] = '\0';
    const char *list[] = {longest + 2, NULL};
    assert_ptr_equal(rg_nearest(longest + 1, list), list[0]);
    assert_null(rg_nearest(longest, list));
}

static void test_choices(void **state) {
    (void)state;
    static const struct {
        const char *word;
        const char *list[4];
        size_t size;
        const char *said;
    } cases[] = {
        {"left", {NULL}, 40, "none"},
        {"left", {"bottom", "top", NULL}, 40, "bottom, top"},
        {"botom", {"bottom", "top", NULL}, 40, "bottom, top; did you mean 'bottom'?"},
        {"botom", {"bottom", "top", NULL}, 36, "bottom, top; did you mean 'bottom'?"},
        {"botom", {"bottom", "top", "side", NULL}, 36, "bottom, top; did you mean 'bottom'?"},
        {"botom", {"bottom", "top", "side", NULL}, 39, "bottom, top, s; did you mean 'bottom'?"},
        {"left", {"bottom", "top", "side", NULL}, 9, "bottom, "},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[64];
        memset(text, '#', sizeof text);
        assert_ptr_equal(rg_choices(cases[i].word, cases[i].list, text, cases[i].size), text);
        assert_string_equal(text, cases[i].said);
        for (size_t k = cases[i].size; k < sizeof text; k++) {
            assert_int_equal(text[k], '#');
        }
    }
}

static void test_nearest_key(void **state) {
    (void)state;
    static const struct {
        const rg_key_table *table;
        const char *name, *nearest;
    } known[] = {
        {&rg_case_table, "mesh.fil", "mesh.file"}, /* the first one */
        {&rg_case_table, "mesh.cels", "mesh.cells"},
        {&rg_case_table, "mesh.CELLS", "mesh.cells"},
        {&rg_case_table, "cells", "mesh.cells"},
        {&rg_case_table, "material.cells", "mesh.cells"},
        {&rg_case_table, "mehs", "mesh"},             /* a section */
        {&rg_case_table, "initial.velocity.u", NULL}, /* x, y, z are as near */
        {&rg_case_table, "initial.velocty", "initial.velocity"},
        {&rg_case_table, "veloc", "initial.velocity"},
        {&rg_case_table, "material.poisson_ratio", "material.poisson"},
        {&rg_case_table, "pois", "material.poisson"},
        {&rg_case_table, "material.pois", "material.poisson"},
        {&rg_case_table, "en", NULL}, /* begins like time.end, but that is too short to tell */
        {&rg_case_table, "end", "time.end"},
        {&rg_case_table, "endd", "time.end"},
        {&rg_case_table, "end_time", "time.end"}, /* three letters are enough to begin alike */
        {&rg_case_table, "time.ent", "time.end"},
        {&rg_case_table, "output.intervall", "output.interval"},
        {&rg_case_table, "checkpoint.intervall", NULL}, /* in another section only what is called just so */
        {&rg_case_table, "checkpoint.dir", "output.dir"},
        {&rg_case_table, "interface.linear", "viscosity.linear"},
        {&rg_case_table, "interface.weibul", "interface.weibull"},
        {&rg_case_table, "interface.set", "interface.sets"},
        {&rg_case_table, "mesh.sed", "mesh.seed"}, /* rather than one of another section */
        {&rg_case_table, "boundry", "boundary"},
        {&rg_case_table, "fracture", NULL},
        {&rg_case_table, "qqqqqqqqqqqqqq", NULL},
        {&rg_case_table, "", NULL},
        {&rg_boundary_table, "units", NULL},
        {&rg_boundary_table, "velocty", "velocity"},
        {&rg_material_table, "densty", "density"},
        {&rg_body_table, "velocity", "velocity"},
        {&rg_body_table, "velocity.w", NULL},
        {&rg_body_table, "a", "at"},
        {&rg_case_table, "initial.tension", NULL},
        {&rg_case_table, "initial.speed", "initial.rotation.speed"},
        {&rg_case_table, "initial.sped", NULL}, /* deeper down than the name is */
        {&rg_case_table, "interface.ascent", "interface.bilinear.ascent"},
        {&rg_case_table, "material.strength", "interface.strength"},
        {&rg_case_table, "output.mass", "mass"},
        {&rg_case_table, "ascent", NULL},
        {&rg_case_table, "initial.velocity.zz", "initial.velocity.z"},
        {&rg_probe_table, "q", NULL},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        char text[64] = "";
        const char *found = rg_key_nearest(known[i].table, known[i].name, text, sizeof text);
        if ((found == NULL) != (known[i].nearest == NULL) ||
            (found != NULL && strcmp(found, known[i].nearest) != 0)) {
            fail_msg("%s: %s, not %s", known[i].name, found != NULL ? found : "none",
                     known[i].nearest != NULL ? known[i].nearest : "none");
        }
    }
    /* Words that are far too long are not compared. */
    char text[64], longest[RG_LONGEST_WORD + 2];
    memset(longest, 'q', sizeof longest);
    memcpy(longest, "poisson", strlen("poisson"));
    longest[RG_LONGEST_WORD + 1] = '\0';
    assert_null(rg_key_nearest(&rg_case_table, longest, text, sizeof text));
    longest[RG_LONGEST_WORD] = '\0';
    assert_string_equal(rg_key_nearest(&rg_case_table, longest, text, sizeof text), "material.poisson");
}

static void test_sections(void **state) {
    (void)state;
    assert_true(rg_key_is_section(&rg_case_table, "mesh") && rg_key_is_section(&rg_case_table, "time"));
    assert_true(rg_key_is_section(&rg_case_table, "checkpoint")); /* the last one */
    assert_true(rg_key_is_section(&rg_case_table, "initial.velocity"));
    assert_false(rg_key_is_section(&rg_case_table, "mes") || rg_key_is_section(&rg_case_table, "mass"));
    assert_false(rg_key_is_section(&rg_case_table, "mesh.cells"));
    assert_false(rg_key_is_section(&rg_case_table, "eesh"));
    static const rg_key alone[] = {{.name = "a.b"}, {.name = "c"}, {.name = "d.e"}}; /* in sections of one */
    static const rg_key_table table = {alone, 3, 0};
    assert_true(rg_key_is_section(&table, "a") && rg_key_is_section(&table, "d"));
    assert_false(rg_key_is_section(&table, "c"));
    assert_true(rg_key_find(&rg_case_table, "defaults") == &rg_case_table.key[0]);
    assert_string_equal(rg_key_find(&rg_case_table, "checkpoint.keep")->name, "checkpoint.keep");
    assert_null(rg_key_find(&rg_case_table, "checkpoint"));
}

/* What is not given is the first word of a choice. */
static void test_default_words(void **state) {
    (void)state;
    const rg_key_table *const tables[] = {&rg_case_table,     &rg_material_table,   &rg_boundary_table,
                                          &rg_load_table,     &rg_body_table,       &rg_probe_table,
                                          &rg_face_set_table, &rg_initial_set_table};
    for (size_t t = 0; t < sizeof tables / sizeof *tables; t++) {
        for (const rg_key *key = tables[t]->key; key < tables[t]->key + tables[t]->keys; key++) {
            assert_true(key->type != RG_KEY_CHOICE || key->fallback == 0);
        }
    }
}

/* ---- numbers and expressions ---- */

static void test_numbers(void **state) {
    (void)state;
    static const char *const integers[] = {"0", "-12", "+7", "99999999999999999999"};
    static const char *const reals[] = {"1.",  ".5",   "-.5",    "1.5",    "1e3",
                                        "1E3", "1e+3", "2.e-30", "+.5e-7", "1.25E+10"};
    static const char *const others[] = {"",     "-",     "+",     ".",     "e3",  "1e",  "1e+",
                                         "1e-",  "1.5e",  "1x",    "0x10",  "1 ",  " 1",  "--1",
                                         "1..2", "1.2.3", "1e3.5", "1e3e3", "nan", "inf", "1e 3",
                                         "+-1",  "1,000", ".e3",   "12e3x", "1-2"};
    bool integer = false;
    for (size_t i = 0; i < sizeof integers / sizeof *integers; i++) {
        assert_true(rg_is_number(integers[i], &integer) && integer);
    }
    for (size_t i = 0; i < sizeof reals / sizeof *reals; i++) {
        assert_true(rg_is_number(reals[i], &integer) && !integer);
    }
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        if (rg_is_number(others[i], &integer)) {
            fail_msg("'%s' is taken for a number", others[i]);
        }
    }
}

static rg_expr *expression(const char *text) {
    char before = 'x', *message = &before;
    rg_expr *e = rg_expr_new(text, &message);
    if (e == NULL) {
        fail_msg("%s: %s", text, message);
    }
    assert_null(message);
    assert_string_equal(rg_expr_text(e), text);
    return e;
}

static void test_variables(void **state) {
    (void)state;
    static const struct {
        const char *text;
        bool position, time, normal, number;
        double value; /* at x = (2, 3, 5), t = 7 (0 of a face), n = (11, 13, 17) */
    } known[] = {
        {"x", true, false, false, false, 2},
        {"y", true, false, false, false, 3},
        {"z", true, false, false, false, 5},
        {"t", false, true, false, false, 7},
        {"nx", false, false, true, false, 11},
        {"ny", false, false, true, false, 13},
        {"nz", false, false, true, false, 17},
        {"z + 100*nx", true, false, true, false, 1105},
        {"1 + 1", false, false, false, false, 2},
        {"-2.5", false, false, false, true, -2.5},
        {"4*pi", false, false, false, false, 12.566370614359172},
        {"x == 2", true, false, false, false, 1},
        {"x <= 1", true, false, false, false, 0},
        {"y >= 3", true, false, false, false, 1},
        {"y != 3", true, false, false, false, 0},
        {"1/(x - 2)", true, false, false, false, INFINITY},
    };
    const double x[3] = {2, 3, 5}, n[3] = {11, 13, 17}, elsewhere[3] = {-1, -4, -9};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        rg_expr *e = expression(known[i].text), *copy = rg_expr_copy(e);
        assert_int_equal(rg_expr_uses_position(e), known[i].position);
        assert_int_equal(rg_expr_uses_time(e), known[i].time);
        assert_int_equal(rg_expr_uses_normal(e), known[i].normal);
        assert_int_equal(rg_expr_is_number(e), known[i].number);
        double value = known[i].time     ? rg_expr_value(e, x, 7)
                       : known[i].normal ? rg_expr_face_value(e, x, n)
                                         : rg_expr_value(e, x, 0);
        assert_true(value == known[i].value);
        rg_expr_value(e, elsewhere, -3); /* leaves the copy alone */
        assert_string_equal(rg_expr_text(copy), known[i].text);
        value = known[i].time     ? rg_expr_value(copy, x, 7)
                : known[i].normal ? rg_expr_face_value(copy, x, n)
                                  : rg_expr_value(copy, x, 0);
        assert_true(value == known[i].value);
        rg_expr_free(copy);
        rg_expr_free(e);
    }
    assert_null(rg_expr_copy(NULL));
    rg_expr *e = expression("t"); /* of a face that has no normal: nothing is written anywhere */
    assert_true(rg_expr_face_value(e, x, n) == 0);
    rg_expr_free(e);
}

static void test_wrong_expressions(void **state) {
    (void)state;
    static const struct {
        const char *text, *message;
    } known[] = {
        {"x=1", "an assignment is not an expression"},
        {"=1", "an assignment is not an expression"},
        {"x = 1", "an assignment is not an expression"},
        {"x == 1 ? y=3 : 1", "an assignment is not an expression"},
        {"x, y", "2 values where one is needed"},
        {"1, x, y", "3 values where one is needed"},
        {"1/0", "not finite"},
        {"0/0", "not finite"},
        {"1e999", "not finite"},
        {"x +", "Unexpected end of expression at position 4"},
        {"v", "Unexpected token \"v\" found at position 0."},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        char *message = NULL;
        assert_null(rg_expr_new(known[i].text, &message));
        assert_string_equal(message, known[i].message);
        rg_free(message);
    }
    /* one operand beyond what muParser takes: told, not "0 values" */
    char *text = RG_NEW(char, 20011), *message = NULL;
    memset(text, ' ', 20010);
    memcpy(text, "sin(x", 5);
    text[20009] = ')';
    assert_null(rg_expr_new(text, &message));
    assert_string_equal(message,
                        "an operand is longer than 19999 characters: a set of the mesh, or a table, can "
                        "say more");
    rg_free(message);
    rg_free(text);
}

/* ---- texts ---- */

static void test_texts(void **state) {
    (void)state;
    size_t before = rg_alloc_total();
    char *copy = rg_text_copy("abcdef", 3), *empty = rg_text_copy(NULL, 0), *five = rg_text_format("%05d", 7);
    assert_int_equal(rg_alloc_total() - before, 3 + 1 + 1 + 5 + 1); /* with room for their ends */
    rg_free(five);
    char *made = rg_text_format("%s-%d-%.3f", "a long text to be sure", 12, 0.5), text[8] = "ab";
    assert_string_equal(copy, "abc");
    assert_string_equal(empty, "");
    assert_string_equal(made, "a long text to be sure-12-0.500");
    rg_text_add(text, sizeof text, "%s%d", "c", 4);
    assert_string_equal(text, "abc4");
    rg_text_add(text, sizeof text, "%s", "56789");
    assert_string_equal(text, "abc4567");
    rg_text_add(text, sizeof text, "8");
    assert_string_equal(text, "abc4567");
    rg_free(copy);
    rg_free(empty);
    rg_free(made);
}

/* ---- problems ---- */

static void test_order_of_problems(void **state) {
    (void)state;
    rg_problems all = {.file = "a.yaml"};
    const rg_place set = {1, 1, "b=1"}, none = {0, 0, NULL}, early = {2, 30, NULL}, late = {10, 3, NULL},
                   same_line = {10, 20, NULL};
    rg_problem_add(&all, set, &(rg_subject){0}, "first of --set");
    rg_problem_add(&all, same_line, &(rg_subject){.key = "k", .value = "v"}, "%d", 4);
    rg_problem_add(&all, late, &(rg_subject){.key = "", .allowed = "a\tb"}, "third");
    rg_problem_add(&all, early, &(rg_subject){.nearest = "n"}, "second");
    rg_problem_add(&all, late, &(rg_subject){.value = "v\n\x01"}, "fourth");
    rg_problem_add(&all, none, &(rg_subject){0}, "of the file");
    rg_problem_add(&all, (rg_place){1, 1, "a=1"}, &(rg_subject){0}, "second of --set");
    assert_int_equal(all.count, 7);
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    rg_problems_flush(&all, out);
    fclose(out);
    assert_string_equal(text, "a.yaml: of the file\n"
                              "a.yaml:2:30: second; did you mean 'n'?\n"
                              "a.yaml:10:3: third; allowed: a b\n"
                              "a.yaml:10:3: v  : fourth\n"
                              "a.yaml:10:20: k: v: 4\n"
                              "--set b=1: first of --set\n"
                              "--set a=1: second of --set\n");
    assert_true(all.count == 0 && all.problem == NULL);
    free(text);
    rg_problems_flush(&all, stderr); /* nothing */
}

/* ---- the tree ---- */

static void test_line_of_a_node(void **state) {
    (void)state;
    static const char yaml[] = "{a: [1, 'x y', {b: \"c\", d: }], e: {}, f: [], g: -3.5}";
    static const char whole[] = "{a: [1, \"x y\", {b: \"c\", d: }], e: {}, f: [], g: -3.5}";
    rg_problems none = {.file = "f"};
    rg_node root = {.kind = RG_NODE_BAD};
    rg_yaml_parse(&none, yaml, strlen(yaml), NULL, &root);
    assert_int_equal(none.count, 0);
    for (size_t size = 5; size < sizeof whole + 5; size++) {
        char line[80], expected[80];
        memset(line, '#', sizeof line);
        snprintf(expected, size, "%s", whole);
        if (size < sizeof whole + 1) {
            strcpy(expected + size - 4, "...");
        }
        assert_ptr_equal(rg_node_line(&root, line, size), line);
        assert_string_equal(line, expected);
        assert_int_equal(line[size], '#');
    }
    rg_node_clear(&root);
    assert_true(root.kind == RG_NODE_BAD && root.children == 0 && root.child == NULL);
}

/* "1:2 key 3:4 [text]" of each node, in their order. */
static void describe(const rg_node *node, FILE *out) {
    static const char kind[] = "slmb";
    fprintf(out, "%c %d:%d", kind[node->kind], node->at.line, node->at.column);
    if (node->key != NULL) {
        fprintf(out, " %s %d:%d", node->key, node->key_at.line, node->key_at.column);
    }
    if (node->kind == RG_NODE_SCALAR) {
        fprintf(out, " %s%s", node->text, node->plain ? "" : " (text)");
    }
    fprintf(out, "%s%s\n", node->at.set != NULL ? " of " : "", node->at.set != NULL ? node->at.set : "");
    for (int i = 0; i < node->children; i++) {
        describe(&node->child[i], out);
    }
}

static void expect_tree(const rg_node *root, const char *expected) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    describe(root, out);
    fclose(out);
    assert_string_equal(text, expected);
    free(text);
}

static void test_tree(void **state) {
    (void)state;
    static const char yaml[] = "# first\n"
                               "a:   12\n"
                               "'b': \"1\\n2\"\n"
                               "c:\n"
                               "  - x y\n"
                               "  - 'z'\n"
                               "  - {k: [1, 2], l: ~}\n"
                               "d:\n"
                               "  e: text\n"
                               "    more\n"
                               "  f:\n";
    rg_problems none = {.file = "f"};
    rg_node root = {.kind = RG_NODE_BAD};
    rg_yaml_parse(&none, yaml, strlen(yaml), NULL, &root);
    assert_int_equal(none.count, 0);
    expect_tree(&root, "m 2:1\n"
                       "s 2:6 a 2:1 12\n"
                       "s 3:6 b 3:1 1\n2 (text)\n"
                       "l 5:3 c 4:1\n"
                       "s 5:5 x y\n"
                       "s 6:5 z (text)\n"
                       "m 7:5\n"
                       "l 7:9 k 7:6\n"
                       "s 7:10 1\n"
                       "s 7:13 2\n"
                       "s 7:20 l 7:17 ~\n"
                       "m 9:3 d 8:1\n"
                       "s 9:6 e 9:3 text more\n"
                       "s 11:3 f 11:3 \n");
    const rg_node *d = rg_node_find(&root, "dx", 1);
    assert_ptr_equal(d, &root.child[3]);
    assert_null(rg_node_find(&root, "dx", 2));
    assert_null(rg_node_find(&root.child[2], "x", 1)); /* a list has no keys */
    assert_true(rg_node_is_null(&d->child[1]) && rg_node_is_null(&root.child[2].child[2].child[1]));
    assert_false(rg_node_is_null(&d->child[0]) || rg_node_is_null(&root.child[0]) || rg_node_is_null(d));
    rg_node_clear(&root);
    rg_yaml_parse(&none, "[null, '', '~', Null]", 21, "k", &root);
    assert_true(rg_node_is_null(&root.child[0]) && !rg_node_is_null(&root.child[1]));
    assert_true(!rg_node_is_null(&root.child[2]) && !rg_node_is_null(&root.child[3]));
    expect_tree(&root,
                "l 1:1 of k\ns 1:2 null of k\ns 1:8  (text) of k\ns 1:12 ~ (text) of k\ns 1:17 Null of k\n");
    rg_node_clear(&root);
}

static void override(rg_node *root, const char *set, const char *message) {
    rg_problems all = {.file = "f"};
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    rg_tree_override(&all, root, set);
    rg_problems_flush(&all, out);
    fclose(out);
    assert_string_equal(text, message);
    free(text);
}

static void test_overrides_of_a_tree(void **state) {
    (void)state;
    static const char yaml[] = "a: {b: 1, c: 2}\nd:\ne: 5\nf: ''\n";
    rg_problems none = {.file = "f"};
    rg_node root = {.kind = RG_NODE_BAD};
    rg_yaml_parse(&none, yaml, strlen(yaml), NULL, &root);
    override(&root, "a.c=[7, 8]", "");
    override(&root, "a.n.m=x=y", "");
    override(&root, "d.g='9'", "");
    override(&root, "new=~", "");
    override(&root, "e.h=1",
             "--set e.h=1: e.h: cannot be set: what it belongs to is not a mapping of keys\n");
    override(&root, "f.h=1",
             "--set f.h=1: f.h: cannot be set: what it belongs to is not a mapping of keys\n");
    override(&root, "a.c=6", "--set a.c=6: a.c: set twice\n");
    static const char *const bad[] = {"abc", "=1", ".a=1", "a.=1", "a..b=1", "..=1"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char message[80];
        snprintf(message, sizeof message, "--set %s: expected --set section.key=value\n", bad[i]);
        override(&root, bad[i], message);
    }
    override(&root, "a.b=", "--set a.b=: no value behind the '='\n");
    override(&root, "a.b=\x7f", "--set a.b= : byte 0x7f is not text (UTF-8)\n");
    expect_tree(&root, "m 1:1\n"
                       "m 1:4 a 1:1\n"
                       "s 1:8 b 1:5 1\n"
                       "l 1:1 c 1:11 of a.c=[7, 8]\n"
                       "s 1:2 7 of a.c=[7, 8]\n"
                       "s 1:5 8 of a.c=[7, 8]\n"
                       "m 1:1 n 1:1 of a.n.m=x=y\n"
                       "s 1:1 m 1:1 x=y of a.n.m=x=y\n"
                       "m 1:1 d 2:1 of d.g='9'\n"
                       "s 1:1 g 1:1 9 (text) of d.g='9'\n"
                       "s 3:4 e 3:1 5\n"
                       "s 4:4 f 4:1  (text)\n"
                       "s 1:1 new 1:1 ~ of new=~\n");
    rg_node_clear(&root);
    size_t before = rg_alloc_total();
    override(&root, "a=1", ""); /* of a file that could not be read: nobody complains about that again */
    assert_true(root.kind == RG_NODE_BAD && root.children == 0);
    assert_int_equal(rg_alloc_total(), before);
}

/* Bytes that are UTF-8 are taken, others told, with the column in characters. */
static void test_bytes(void **state) {
    (void)state;
    static const char *const good[] = {"\t",           "\xc2\x80",         "\xdf\xbf",         "\xe1\x80\x80",
                                       "\xef\xbf\xbd", "\xf1\x80\x80\x80", "\xf4\x8f\xbf\xbf", "~"};
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        char yaml[32];
        rg_problems none = {.file = "f"};
        rg_node root = {.kind = RG_NODE_BAD};
        snprintf(yaml, sizeof yaml, "a: \"%s\"\r\nb: c\n", good[i]);
        rg_yaml_parse(&none, yaml, strlen(yaml), NULL, &root);
        assert_int_equal(none.count, 0);
        assert_string_equal(root.child[0].text, good[i]);
        rg_node_clear(&root);
    }
    static const char *const bad[] = {"\x01",
                                      "\x1f",
                                      "\x7f",
                                      "\x80",
                                      "\xbf",
                                      "\xc0\x80",
                                      "\xc1\xbf",
                                      "\xc2",
                                      "\xc2\x41",
                                      "\xc2\xc0",
                                      "\xe1\x80",
                                      "\xe1\x80\x41",
                                      "\xe1\x41\x80",
                                      "\xf1\x80\x80",
                                      "\xf1\x80\x80\x41",
                                      "\xf1\x41\x80\x80",
                                      "\xf5\x80\x80\x80",
                                      "\xff",
                                      "\xf1\x80\xc0\x80"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char message[80];
        snprintf(message, sizeof message, "--set a.b=\xc3\xa9x%s: byte 0x%02x is not text (UTF-8)\n", bad[i],
                 (unsigned)(unsigned char)bad[i][0]);
        for (char *p = message; p[1] != '\0'; p++) {
            *p = (char)(*p == 1 || *p == 0x1f || *p == 0x7f ? ' ' : *p);
        }
        rg_node root = {.kind = RG_NODE_BAD};
        char set[32];
        snprintf(set, sizeof set, "a.b=\xc3\xa9x%s", bad[i]);
        override(&root, set, message);
        assert_int_equal(root.kind, RG_NODE_BAD);
    }
    rg_problems all = {.file = "f"};
    rg_node root = {.kind = RG_NODE_BAD};
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    rg_yaml_parse(&all, "a: 1\n\xc3\xa9\xe1\x80\x80x\x02", 12, NULL, &root);
    rg_yaml_parse(&all, "a\xe1\x80\x80", 3, NULL, &root); /* ends within a character */
    rg_problems_flush(&all, out);
    fclose(out);
    assert_string_equal(text, "f:1:2: byte 0xe1 is not text (UTF-8)\nf:2:4: byte 0x02 is not text (UTF-8)\n");
    free(text);
}

/* ---- the file ---- */

static void test_bytes_of_a_file(void **state) {
    (void)state;
    static const size_t sizes[] = {0, 1, 65535, 65536, 65537, 200001};
    static char bytes[200001];
    for (size_t i = 0; i < sizeof bytes; i++) {
        bytes[i] = (char)(i * i % 251);
    }
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        size_t size = 7;
        write_bytes(bytes, sizes[i]);
        char *text = rg_case_file(path, &size);
        assert_int_equal(size, sizes[i]);
        assert_memory_equal(text, bytes, size);
        rg_free(text);
    }
    enum { MOST = 64 << 20 }; /* bytes that are read at most: a hole in the file costs next to nothing */
    for (int more = 0; more < 2; more++) {
        size_t size = 0;
        assert_int_equal(truncate(path, MOST + more), 0);
        errno = 0;
        char *text = rg_case_file(path, &size);
        assert_true(more == 0 ? text != NULL && size == MOST : text == NULL && errno == EFBIG);
        rg_free(text);
    }
    size_t size = 0;
    errno = 0;
    assert_true(rg_case_file("/tmp", &size) == NULL && errno == EISDIR);
    assert_true(rg_case_file("/nonexistent/a", &size) == NULL && errno == ENOENT);
}

static void test_names_of_cases(void **state) {
    (void)state;
    static const char *const known[][2] = {{"bench/examples/spall/spall.yaml", "spall"},
                                           {"a.b/c", "c"},
                                           {"x.tar.gz", "x.tar"},
                                           {"/e/.yaml", ".yaml"},
                                           {"plain", "plain"},
                                           {"d.e/f.g/h.i", "h"}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        rg_case *c = rg_case_read_text(known[i][0], base, strlen(base), 0, NULL, stderr);
        char dir[64];
        snprintf(dir, sizeof dir, "results/%s", known[i][1]);
        assert_string_equal(c->name, known[i][1]);
        assert_string_equal(c->path, known[i][0]);
        assert_string_equal(c->output.dir, dir);
        rg_case_free(c);
    }
    rg_case_free(NULL);
}

/* ---- what libraries refuse ---- */

/* Calls to them come here (-Wl,--wrap). */
static const char *refused = ""; /* the name of the function that does not do its job */

FILE *__real_open_memstream(char **text, size_t *size);
FILE *__wrap_open_memstream(char **text, size_t *size);
FILE *__wrap_open_memstream(char **text, size_t *size) {
    return strcmp(refused, "open_memstream") == 0 ? NULL : __real_open_memstream(text, size);
}

int __real_fclose(FILE *file);
int __wrap_fclose(FILE *file);
int __wrap_fclose(FILE *file) {
    int status = __real_fclose(file);
    return strcmp(refused, "fclose") == 0 ? EOF : status;
}

struct fy_diag *__real_fy_diag_create(const struct fy_diag_cfg *config);
struct fy_diag *__wrap_fy_diag_create(const struct fy_diag_cfg *config);
struct fy_diag *__wrap_fy_diag_create(const struct fy_diag_cfg *config) {
    return strcmp(refused, "fy_diag_create") == 0 ? NULL : __real_fy_diag_create(config);
}

struct fy_parser *__real_fy_parser_create(const struct fy_parse_cfg *config);
struct fy_parser *__wrap_fy_parser_create(const struct fy_parse_cfg *config);
struct fy_parser *__wrap_fy_parser_create(const struct fy_parse_cfg *config) {
    return strcmp(refused, "fy_parser_create") == 0 ? NULL : __real_fy_parser_create(config);
}

int __real_fy_parser_set_string(struct fy_parser *parser, const char *text, size_t size);
int __wrap_fy_parser_set_string(struct fy_parser *parser, const char *text, size_t size);
int __wrap_fy_parser_set_string(struct fy_parser *parser, const char *text, size_t size) {
    return strcmp(refused, "fy_parser_set_string") == 0 ? -1
                                                        : __real_fy_parser_set_string(parser, text, size);
}

struct fy_diag_error *__real_fy_diag_errors_iterate(struct fy_diag *diag, void **iterator);
struct fy_diag_error *__wrap_fy_diag_errors_iterate(struct fy_diag *diag, void **iterator);
struct fy_diag_error *__wrap_fy_diag_errors_iterate(struct fy_diag *diag, void **iterator) {
    return strcmp(refused, "fy_diag_errors_iterate") == 0 ? NULL
                                                          : __real_fy_diag_errors_iterate(diag, iterator);
}

static void parse_none(void) {
    rg_problems none = {.file = "f"};
    rg_node root = {.kind = RG_NODE_BAD};
    rg_yaml_parse(&none, "a: 1", 4, NULL, &root);
}

static void add_problem(void) {
    rg_problems one = {.file = "f"};
    rg_problem_add(&one, (rg_place){0}, &(rg_subject){0}, "wrong");
}

static void list_fixed(void) {
    static rg_case none;
    rg_case_fixed(&none);
}

static void test_refusals_of_libraries(void **state) {
    (void)state;
    static const struct {
        void (*job)(void);
        const char *refused;
    } jobs[] = {
        {parse_none, "fy_diag_create"},
        {parse_none, "fy_parser_create"},
        {parse_none, "fy_parser_set_string"},
        {add_problem, "open_memstream"},
        {add_problem, "fclose"},
        {list_fixed, "open_memstream"},
    };
    char said[1000];
    for (size_t i = 0; i < sizeof jobs / sizeof *jobs; i++) {
        refused = jobs[i].refused;
        int status = run_child(jobs[i].job, said, sizeof said);
        refused = "";
        assert_string_equal(said, "rhegma: out of memory\n");
        assert_int_equal(status, RG_FAILURE);
    }
    /* An error of which the parser says nothing is told all the same. */
    rg_problems all = {.file = "f"};
    rg_node root = {.kind = RG_NODE_BAD};
    refused = "fy_diag_errors_iterate";
    rg_yaml_parse(&all, "a: [1", 5, NULL, &root);
    refused = "";
    assert_int_equal(all.count, 1);
    assert_string_equal(all.problem[0].text, "f:1:1: not valid YAML");
    rg_problems_flush(&all, stderr);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_edit_distance),
        cmocka_unit_test(test_nearest_word),
        cmocka_unit_test(test_choices),
        cmocka_unit_test(test_nearest_key),
        cmocka_unit_test(test_sections),
        cmocka_unit_test(test_numbers),
        cmocka_unit_test(test_variables),
        cmocka_unit_test(test_wrong_expressions),
        cmocka_unit_test(test_texts),
        cmocka_unit_test(test_order_of_problems),
        cmocka_unit_test(test_line_of_a_node),
        cmocka_unit_test(test_tree),
        cmocka_unit_test(test_overrides_of_a_tree),
        cmocka_unit_test(test_bytes),
        cmocka_unit_test(test_bytes_of_a_file),
        cmocka_unit_test(test_names_of_cases),
        cmocka_unit_test(test_default_words),
        cmocka_unit_test(test_refusals_of_libraries),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
