/* What `rhegma keys` prints of the registry. (That the JSON Schema takes cases and refuses mistakes is tested
 * with a validator, tests/system/test_keys.py.) */
#include <ctype.h>

#include "case/reference.h"
#include "case/tree.h"
#include "support/case_input.h"

/* Returns how many keys were written to *text, which is to be freed. */
static int print(int (*write)(FILE *, const char *), const char *prefix, char **text) {
    size_t size = 0;
    FILE *out = open_memstream(text, &size);
    assert_non_null(out);
    int keys = write(out, prefix);
    assert_int_equal(fclose(out), 0);
    return keys;
}

static const rg_key_table *const tables[] = {&rg_case_table,     &rg_material_table,   &rg_boundary_table,
                                             &rg_load_table,     &rg_body_table,       &rg_probe_table,
                                             &rg_face_set_table, &rg_initial_set_table};
enum { TABLES = sizeof tables / sizeof *tables };

/* Without what Markdown's tables and JSON's texts would have to escape. */
static bool is_plain(const char *text) {
    return text == NULL || strpbrk(text, "\n\t|\"\\") == NULL;
}

static bool is_sentence(const char *text) {
    size_t length = text == NULL ? 0 : strlen(text);
    return length > 1 && !isspace((unsigned char)text[0]) && strchr(". ,;", text[length - 1]) == NULL &&
           is_plain(text);
}

/* Every key says what it means, each of its words too where one does, and what holds without it. */
static void test_meanings(void **state) {
    (void)state;
    char text[256];
    for (int t = 0; t < TABLES; t++) {
        for (int i = 0; i < tables[t]->keys; i++) {
            const rg_key *key = &tables[t]->key[i];
            if (!is_sentence(key->meaning) || rg_key_default(key, text, sizeof text)[0] == '\0') {
                fail_msg("%s: %s; %s", key->name, key->meaning, text);
            }
            assert_true(is_plain(text) && is_plain(key->unit));
            for (int k = 0; key->choice_meaning != NULL && key->choice[k] != NULL; k++) {
                assert_true(is_sentence(key->choice_meaning[k]));
            }
            assert_true(key->need != RG_NEED_OPTIONAL || key->absent != NULL || key->models != 0);
        }
    }
}

/* Every key of the parser has a row of its own, in the order of the registry. */
static void test_every_key_has_a_row(void **state) {
    (void)state;
    char *text = NULL;
    int keys = print(rg_reference_text, "", &text), rows = 0;
    const char *from = text;
    for (int i = 0; i < rg_case_table.keys; i++) {
        const rg_key *key = &rg_case_table.key[i];
        const rg_key_table own = {.key = key, .keys = 1}, *table = key->entry != NULL ? key->entry : &own;
        for (int k = key->entry != NULL ? -1 : 0; k < table->keys; k++) {
            char row[512], allowed[256];
            const rg_key *inner = k < 0 ? key : &table->key[k];
            if (inner->of_material && table != &own) {
                continue; /* once, with those of `material` */
            }
            snprintf(row, sizeof row, "%s%s%s\n    %s; ", key->name, k >= 0 && table != &own ? "[]." : "",
                     k >= 0 && table != &own ? inner->name : "",
                     rg_key_allowed(inner, allowed, sizeof allowed));
            const char *found = strstr(from, row);
            if (found == NULL || (found != text && found[-1] != '\n')) {
                fail_msg("no row after the one before: %s", row);
            }
            from = strchr(found + strlen(row), '\n') + 1;
            assert_true(strncmp(from, "    ", 4) == 0 &&
                        strncmp(from + 4, inner->meaning, strlen(inner->meaning)) == 0);
            rows++;
        }
    }
    assert_int_equal(keys, rows + 1); /* and expressions */
    assert_non_null(strstr(from, "\nexpressions\n    x, y, z "));
    free(text);
}

/* Single rows to the letter: ranges, units, defaults, conditions, words. */
static void test_rows(void **state) {
    (void)state;
    static const struct {
        const char *prefix, *text;
        int keys;
    } rows[] = {
        {"interface.onset",
         "interface.onset\n    number > 0 and <= 1; default: 0.5 (defaults 0: 0.3); with activation "
         "conserving\n"
         "    opening from which the law starts, in jumps at which the penalty alone would carry the "
         "strength; a smaller one is "
         "stiffer\n",
         1},
        {"mesh.origin",
         "mesh.origin\n    [x, y, z], each number (m); default: [0, 0, 0]; without mesh.file\n"
         "    corner of the box with the smallest x, y, z\n",
         1},
        {"mass",
         "mass\n    consistent, lumped, scaled; default: consistent\n    mass matrix\n"
         "      consistent: exact for the shape functions; its inverse is one constant matrix\n"
         "      lumped: HRZ, on the diagonal: the only one of form continuous and its default\n"
         "      scaled: consistent on all that is linear in an element, its quadratic modes twice as heavy: "
         "a "
         "longer step, and fronts that come late by a fraction of an element\n",
         1},
        {"interface.bilinear.a",
         "interface.bilinear.ascent\n    number >= 1e-06 and <= 0.999; default: 0.01; with law bilinear\n"
         "    opening at the strength, over the critical one\n",
         1},
        {"material.hardening",
         "material.hardening\n    number >= 0 (Pa); default: 0; of j2\n    slope of the yield stress over "
         "plastic strain\n"
         "\nmaterial.hardening_modulus\n    number >= 0 (Pa); default: 0; of johnson-cook\n    B: what "
         "hardening adds to the yield stress at a plastic strain of 1\n"
         "\nmaterial.hardening_power\n    number > 0; required; of johnson-cook\n    n: hardening goes with "
         "the plastic strain to this power\n"
         "\nmaterial.hardening_exponent\n    number >= 0 and <= 1; default: 0.1; of deshpande-evans\n"
         "    the yield stress goes with the plastic strain to this power\n",
         4},
        {"boundary[].v",
         "boundary[].velocity\n    number or expression in x, y, z, t (m/s); this or another motion\n    "
         "prescribed velocity\n",
         1},
        {"time.end", "time.end\n    number > 0 (s); required\n    end of the run; may change on a restart\n",
         1},
        {"nothing", "", 0},
        {"mesh.file.", "", 0},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char *text = NULL;
        int keys = print(rg_reference_text, rows[i].prefix, &text);
        assert_string_equal(text, rows[i].text);
        assert_int_equal(keys, rows[i].keys);
        free(text);
    }
}

static void test_markdown(void **state) {
    (void)state;
    char *text = NULL;
    assert_int_equal(print(rg_reference_markdown, "viscosity", &text), 2);
    assert_string_equal(
        text,
        "## `viscosity`\n\n| key | value | default | meaning |\n| --- | --- | --- | --- |\n"
        "| `viscosity.linear` | number >= 0 | 0 | b1 of the bulk viscosity rho h (b1 c (-div v) + b2^2 h "
        "(div v)^2), against ringing behind shocks, as 0.06 |\n"
        "| `viscosity.quadratic` | number >= 0 | 0 | b2, in compression alone, as 1.2 |\n");
    free(text);
    assert_int_equal(print(rg_reference_markdown, "output.fr", &text), 1);
    assert_non_null(strstr(
        text, " | each | rows of fragments.csv<br>`each`: for each output<br>`last`: for the end of the run"
              "<br>`none`: no file |\n"));
    free(text);
    assert_int_equal(print(rg_reference_markdown, "exp", &text), 1);
    assert_non_null(strstr(text, "\n| `&& \\|\\|` | and, or |\n"));
    free(text);
}

/* One heading for each block, also of lists and single keys, with an empty line before all but the first. */
static void test_headings(void **state) {
    (void)state;
    static const char *const blocks[] = {
        "defaults", "tables", "mesh",  "material", "materials", "interface", "contact", "viscosity", "mass",
        "initial",  "start",  "relax", "boundary", "bodies",    "time",      "output",  "checkpoint"};
    char *text = NULL, heading[64];
    int keys = print(rg_reference_markdown, "", &text), headings = 0;
    const char *from = text;
    assert_true(keys > 100);
    for (const char *at = strstr(text, "## "); at != NULL; at = strstr(at + 1, "## ")) {
        headings++;
    }
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
        snprintf(heading, sizeof heading, "%s## `%s`\n\n| key", i > 0 ? "\n\n" : "", blocks[i]);
        from = strstr(from, heading);
        assert_non_null(from);
        assert_true(i > 0 || from == text);
    }
    assert_non_null(strstr(from, "\n\n## Expressions\n\n| write"));
    assert_int_equal(headings, 20);
    free(text);
}

/* Nothing is left of what it took. */
static void test_schema(void **state) {
    (void)state;
    static const char begins[] =
        "{\n  \"$schema\": \"http://json-schema.org/draft-07/schema#\",\n  \"title\": ";
    char *text = NULL;
    size_t size = 0, before = rg_alloc_total();
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    rg_schema_write(out);
    assert_int_equal(fclose(out), 0);
    assert_int_equal(rg_alloc_total(), before);
    assert_true(strncmp(text, begins, strlen(begins)) == 0 && strcmp(text + size - 3, "\n}\n") == 0);
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_meanings), cmocka_unit_test(test_every_key_has_a_row),
        cmocka_unit_test(test_rows),     cmocka_unit_test(test_markdown),
        cmocka_unit_test(test_headings), cmocka_unit_test(test_schema),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
