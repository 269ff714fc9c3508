/* What Gmsh cannot do ends the run with its message, whichever call it is. */
#include <gmshc.h>
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

#include "base/error.h"
#include "mesh/import/gmsh_read.h"
#include "support/child.h"

static char path[] = "/tmp/test_gmsh_errors.XXXXXX.geo"; /* a tetrahedron with a named side */
static const char geometry[] =
    "Point(1) = {0, 0, 0, 1}; Point(2) = {1, 0, 0, 1}; Point(3) = {0, 1, 0, 1}; Point(4) = {0, 0, 1, 1};\n"
    "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 1}; Line(4) = {1, 4}; Line(5) = {2, 4};\n"
    "Line(6) = {3, 4}; Curve Loop(1) = {1, 2, 3}; Curve Loop(2) = {1, 5, -4}; Curve Loop(3) = {2, 6, -5};\n"
    "Curve Loop(4) = {3, 4, -6}; Plane Surface(1) = {1}; Plane Surface(2) = {2}; Plane Surface(3) = {3};\n"
    "Plane Surface(4) = {4}; Surface Loop(1) = {1, 2, 3, 4}; Volume(1) = {1};\n"
    "Physical Surface(\"base\") = {1}; Physical Volume(\"all\") = {1};\n";

/* ---- calls that fail ---- */

static const char *failing; /* the call that fails */
static int turn, met;       /* when it is called for the time `turn`; how often it was called */

static void refuse(const char *call, int *error) {
    met += strcmp(call, failing) == 0;
    *error = strcmp(call, failing) == 0 && met == turn ? 1 : *error;
}

/* clang-format off */
#define WRAP(CALL, PARAMETERS, ARGUMENTS) \
    void __real_##CALL PARAMETERS; \
    void __wrap_##CALL PARAMETERS; \
    void __wrap_##CALL PARAMETERS { \
        __real_##CALL ARGUMENTS; \
        refuse(#CALL, error); \
    }
WRAP(gmshOpen, (const char *file, int *error), (file, error))
WRAP(gmshModelMeshGenerate, (int dim, int *error), (dim, error))
WRAP(gmshModelMeshGetNodes, (size_t **tag, size_t *tags, double **x, size_t *xs, double **p, size_t *ps, int dim, int of,
                             int border, int parametric, int *error),
     (tag, tags, x, xs, p, ps, dim, of, border, parametric, error))
WRAP(gmshModelMeshGetElements, (int **type, size_t *types, size_t ***tag, size_t **tags, size_t *n1, size_t ***node,
                                size_t **nodes, size_t *n2, int dim, int of, int *error),
     (type, types, tag, tags, n1, node, nodes, n2, dim, of, error))
WRAP(gmshModelGetEntities, (int **pair, size_t *pairs, int dim, int *error), (pair, pairs, dim, error))
WRAP(gmshModelGetPhysicalGroups, (int **pair, size_t *pairs, int dim, int *error), (pair, pairs, dim, error))
WRAP(gmshModelGetEntitiesForPhysicalGroup, (int dim, int group, int **tag, size_t *tags, int *error),
     (dim, group, tag, tags, error))
WRAP(gmshModelGetPhysicalName, (int dim, int group, char **name, int *error), (dim, group, name, error))
/* clang-format on */

void __wrap_gmshOptionSetString(const char *name, const char *value, int *error);

void __wrap_gmshOptionSetString(const char *name, const char *value, int *error) {
    fprintf(stderr, "%s = %s\n", name, value);
    *error = 0;
}

static const char *log_lines[4]; /* what Gmsh has said; NULL: ends */

void __wrap_gmshLoggerGet(char ***line, size_t *lines, int *error);

void __wrap_gmshLoggerGet(char ***line, size_t *lines, int *error) {
    *line = (char **)(uintptr_t)log_lines;
    for (*lines = 0; log_lines[*lines] != NULL; ++*lines) {
    }
    *error = 0;
}

/* ---- tests ---- */

static void read_it(void) {
    rg_mesh_free(rg_gmsh_read(path, &(rg_import_how){.scale = 1}, &(rg_gmsh_size){.at = NULL}));
}

static void expect(int status, const char *words) {
    char said[1000], wanted[1000] = "";
    int found = run_child(read_it, said, sizeof said);
    if (words != NULL) {
        snprintf(wanted, sizeof wanted, "rhegma: %s: Gmsh: %s\n", path, words);
    }
    if (found != status || strcmp(said, wanted) != 0) {
        fail_msg("%s, call %d: status %d, said: %s", failing, turn, found, said);
    }
}

static void test_calls(void **state) {
    (void)state;
    static const struct {
        const char *call;
        int calls; /* that must succeed */
    } cases[] = {{"none", 0},
                 {"gmshOpen", 1},
                 {"gmshModelMeshGenerate", 1},
                 {"gmshModelMeshGetNodes", 1},
                 {"gmshModelMeshGetElements", 1},
                 {"gmshModelGetEntities", 3}, /* volumes twice, surfaces */
                 {"gmshModelGetPhysicalGroups", 2},
                 {"gmshModelGetEntitiesForPhysicalGroup", 2},
                 {"gmshModelGetPhysicalName", 2}};
    log_lines[0] = NULL;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        failing = cases[i].call;
        met = 0;
        for (turn = cases[i].calls == 0 ? 0 : 1; turn <= cases[i].calls; turn++) {
            expect(turn == 0 ? RG_OK : RG_USAGE, turn == 0 ? NULL : "no reason given");
        }
    }
}

/* The first error that Gmsh tells is the reason. */
static void test_reasons(void **state) {
    (void)state;
    static const char *const cases[][4] = {{"first", "Error: first", "Error: second"},
                                           {"second", "Info: first", "Error: second"},
                                           {"third", "Warning: Error: first", "Info: second", "Error: third"},
                                           {"no reason given", "Info: first"}};
    failing = "gmshOpen";
    turn = 1;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        for (int k = 0; k < 3; k++) {
            log_lines[k] = cases[i][k + 1];
        }
        expect(RG_USAGE, cases[i][0]);
    }
}

static char other[sizeof path + 8]; /* the same file with another ending */

static void read_other(void) {
    assert_non_null(freopen("/dev/null", "w", stdout)); /* where OpenCASCADE complains */
    rg_mesh_free(rg_gmsh_read(other, &(rg_import_how){.scale = 1}, &(rg_gmsh_size){.at = NULL}));
}

/* Files that say their unit are asked for metres, whatever the case of their endings; others have none. */
static void test_units(void **state) {
    (void)state;
    static const struct {
        const char *ending;
        bool unit;
    } cases[] = {{".step", true}, {".stp", true},  {".iges", true},  {".igs", true},       {".STEP", true},
                 {".Igs", true},  {".geo", false}, {".brep", false}, {".step.geo", false}, {"step", false}};
    failing = "gmshOpen";
    turn = 1;
    log_lines[0] = NULL;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char said[1000], wanted[1000];
        snprintf(other, sizeof other, "%.*s%s", (int)(strrchr(path, '.') - path), path, cases[i].ending);
        assert_true(strcmp(other, path) == 0 || link(path, other) == 0);
        met = 0;
        int status = run_child(read_other, said, sizeof said);
        assert_true(strcmp(other, path) == 0 || unlink(other) == 0);
        snprintf(wanted, sizeof wanted, "%srhegma: %s: Gmsh: no reason given\n",
                 cases[i].unit ? "Geometry.OCCTargetUnit = M\n" : "", other);
        assert_int_equal(status, RG_USAGE);
        assert_string_equal(said, wanted);
    }
}

static int set_up(void **state) {
    (void)state;
    int file = mkstemps(path, 4);
    return file >= 0 && write(file, geometry, sizeof geometry - 1) == sizeof geometry - 1 ? close(file) : 1;
}

static int tear_down(void **state) {
    (void)state;
    return remove(path);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_calls), cmocka_unit_test(test_reasons),
                                       cmocka_unit_test(test_units)};
    return cmocka_run_group_tests_name("gmsh_errors", tests, set_up, tear_down);
}
