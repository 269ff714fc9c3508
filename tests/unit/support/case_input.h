/* Case files that the tests write, and what reading them says. */
#ifndef CASE_INPUT_H
#define CASE_INPUT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/mem.h"
#include "case/case.h"
#include "case/read.h"
#include "case/tree.h"

/* What is allowed of the motions of a boundary. */
#define MOTIONS(join) RG_PRESCRIBED(RG_PRESCRIBED_KEY, join)
#define ONE_MOTION    "allowed: exactly one of " MOTIONS(", ") ", absorbing, dashpot\n"
#define BOUNDARY_LIST                                                                                        \
    "list of {name, set, where, component, direction, " MOTIONS(                                             \
        " or ") " or absorbing, dashpot, axis, at, translation, "                                            \
                "from, until}"
#include "cohesive/facts.h"

/* The smallest case; the tests of mistakes change one place of it and know its lines and columns. */
static const char base[] = "mesh:\n"
                           "  cells: [2, 2, 4]\n"
                           "  size: [1e-3, 1e-3, 2e-3]\n"
                           "material:\n"
                           "  model: neo-hookean\n"
                           "  young: 260e9\n"
                           "  poisson: 0.21\n"
                           "  density: 3690\n"
                           "interface:\n"
                           "  law: linear\n"
                           "  strength: 400e6\n"
                           "  energy: 34\n"
                           "boundary:\n"
                           "  - {set: z+, component: z, velocity: 6.086}\n"
                           "time:\n"
                           "  end: 1e-6\n"
                           "output:\n"
                           "  probes:\n"
                           "    - {name: p, at: [0, 0, 1e-3]}\n";

static char directory[] = "/tmp/test_case.XXXXXX";
static char path[64]; /* of the case file that the tests write */

static inline int set_up(void **state) {
    (void)state;
    snprintf(path, sizeof path, "%s/bar.yaml", mkdtemp(directory) == NULL ? "" : directory);
    return 0;
}

static inline int tear_down(void **state) {
    (void)state;
    remove(path);
    return rmdir(directory);
}

static inline void write_bytes(const char *text, size_t size) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

/* Writes the base case with `from` (all of it if NULL) replaced by `to`. */
static inline void write_changed(const char *from, const char *to) {
    char text[4096];
    const char *found = from == NULL ? base : strstr(base, from);
    assert_non_null(found);
    const char *rest = from == NULL ? "" : found + strlen(from);
    snprintf(text, sizeof text, "%.*s%s%s", (int)(found - base), base, to, rest);
    write_bytes(text, strlen(text));
}

/* Reads `file`; *messages is what it printed. Free both. */
static inline rg_case *read_case(const char *file, int overrides, const char *const override[],
                                 char **messages) {
    size_t size = 0;
    FILE *errors = open_memstream(messages, &size);
    assert_non_null(errors);
    rg_case *c = rg_case_read(file, overrides, override, errors);
    assert_int_equal(fclose(errors), 0);
    return c;
}

static inline rg_case *read_good(const char *file, int overrides, const char *const override[]) {
    char *messages = NULL;
    rg_case *c = read_case(file, overrides, override, &messages);
    assert_string_equal(messages, "");
    assert_non_null(c);
    free(messages);
    return c;
}

/* "linear, free": the laws with all these bits of their forms. */
static inline void name_laws(char *text, size_t size, int forms) {
    const char *join = "";
    for (int law = 0; law < (int)RG_LAWS; law++) {
        rg_law_facts facts = rg_law_facts_of((rg_law)law, (double[RG_LAW_SHAPE]){0}, 1);
        if ((facts.forms & forms) == forms) {
            rg_text_add(text, size, "%s%s", join, facts.word);
            join = ", ";
        }
    }
}

/* The models of materials with all these bits of what is inside. */
static inline void name_models(char *text, size_t size, int inside) {
    const char *join = "";
    for (rg_material_model m = 0; m < RG_MATERIAL_MODELS; m++) {
        if (((int)rg_material_inside(m) & inside) == inside) {
            rg_text_add(text, size, "%s%s", join, rg_material_word(m));
            join = ", ";
        }
    }
    rg_text_add(text, size, inside == 0 ? ", user" : "");
}

/* Those that take Young's modulus, an anisotropic one three of them. */
static inline void name_young_models(char *text, size_t size, int bits) {
    const char *join = "";
    for (rg_material_model m = 0; m < RG_MATERIAL_MODELS; m++) {
        if (m == RG_MATERIAL_ANISOTROPIC || ((int)rg_material_inside(m) & bits) != 0) {
            rg_text_add(text, size, "%s%s", join, rg_material_word(m));
            join = ", ";
        }
    }
}

/* What stands for names of the registries in the messages below. */
static const struct {
    const char *mark;
    void (*name)(char *text, size_t size, int bits);
    int bits;
} named[] = {{"$MODELS", name_models, 0},
             {"$ELASTIC_MODELS", name_young_models, RG_TAKES_YOUNG},
             {"$LAWS", name_laws, 0},
             {"$RIGID_LAWS", name_laws, RG_FORMS_DG},
             {"$SLOPED_LAWS", name_laws, RG_FORMS_INTRINSIC}};

static inline void fill_names(char *text, size_t size) {
    for (size_t k = 0; k < sizeof named / sizeof *named; k++) {
        for (char *found = strstr(text, named[k].mark); found != NULL; found = strstr(text, named[k].mark)) {
            char *rest = rg_text_format("%s", found + strlen(named[k].mark));
            *found = '\0';
            named[k].name(text, size, named[k].bits);
            rg_text_add(text, size, "%s", rest);
            rg_free(rest);
        }
    }
}

/* Expects exactly `lines`, in each of which a leading ':' stands for the file's path and ':', and $MODELS and
 * so on for names. */
static inline void expect_messages(int overrides, const char *const override[], const char *lines) {
    char expected[8192] = "", *messages = NULL;
    for (const char *line = lines; *line != '\0';) {
        int length = (int)(strchr(line, '\n') - line) + 1;
        rg_text_add(expected, sizeof expected, "%s%.*s", *line == ':' ? path : "", length, line);
        line += length;
    }
    fill_names(expected, sizeof expected);
    size_t before = rg_alloc_total();
    rg_case *c = read_case(path, overrides, override, &messages);
    assert_string_equal(messages, expected);
    assert_null(c);
    assert_int_equal(rg_alloc_total(), before);
    free(messages);
}

/* A change of the base case, as in write_changed, and what is said of it. */
typedef struct {
    const char *from, *to, *messages;
} mistake;

static inline void expect_mistakes(const mistake *list, size_t count) {
    for (size_t i = 0; i < count; i++) {
        write_changed(list[i].from, list[i].to);
        expect_messages(0, NULL, list[i].messages);
    }
}

/* Of the ceramic's table, with the constants that the base case has; in place of `elastic`. */
static const char elastic[] = "material:\n  model: neo-hookean\n  young: 260e9\n";
static const char ceramic[] = "material:\n  model: deshpande-evans\n  shear: 146e9\n  flaw_radius: 19e-6\n"
                              "  flaw_density: 1e12\n  toughness: 3e6\n  yield_stress: 4e9\n";
static const char metal[] = "material:\n  model: j2\n  young: 70e9\n  yield_stress: 2e8\n";

#endif
