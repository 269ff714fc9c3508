/* Import, whatever the format: numbers that are far apart, middles of edges, names of faces. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/error.h"
#include "base/mem.h"
#include "mesh/import/import.h"
#include "support/mesh_text.h"

static char *const names[] = {(char[]){"top"}, (char[]){"side"}};

static void add_nodes(rg_import *m) {
    static const double x[5][3] = {{1, 2, 3}, {5, 2, 3.5}, {1.5, 7, 3}, {1, 2.5, 9}, {6, 8, 10}};
    for (size_t n = 0; n < 5; n++) {
        rg_import_node(m, 10 * (n + 1), x[n]);
    }
}

/* Two tetrahedra on either side of nodes 20 30 40. */
static rg_import make_pair(void) {
    rg_import m = {.path = "pair", .scale = 1};
    add_nodes(&m);
    rg_import_element(&m, 1, 4, (const size_t[]){10, 20, 30, 40}, -1);
    rg_import_element(&m, 2, 4, (const size_t[]){20, 30, 40, 50}, -1);
    return m;
}

static void end(rg_import *m) {
    rg_mesh *mesh = rg_import_finish(m, names);
    mesh->sets = 2;
    mesh->set_name[0] = names[0];
    mesh->set_name[1] = names[1];
    print_mesh(mesh, stderr);
}

#define X5      "x 0: 1 2 3\nx 1: 5 2 3.5\nx 2: 1.5 7 3\nx 3: 1 2.5 9\nx 4: 6 8 10\n"
#define WARNING "rhegma: warning: pair: "

/* Nodes that come after elements, and one that comes again and moves. */
static void add_in_turns(void) {
    rg_import m = make_pair();
    rg_import_node(&m, 5, (const double[]){8, 1, 2});
    rg_import_element(&m, 3, 4, (const size_t[]){10, 20, 30, 5}, -1);
    rg_import_node(&m, 50, (const double[]){6.5, 8.5, 10.5});
    rg_import_element(&m, 4, 4, (const size_t[]){10, 20, 5, 40}, -1);
    end(&m);
}

static void test_turns(void **state) {
    (void)state;
    expect_said(add_in_turns, RG_OK,
                WARNING
                "2 of 4 elements have their corners in the order of a negative volume, the first of them 3: "
                "they are taken as if they had not\n"
                "x 0: 8 1 2\nx 1: 1 2 3\nx 2: 5 2 3.5\nx 3: 1.5 7 3\nx 4: 1 2.5 9\nx 5: 6.5 8.5 10.5\n"
                "e 1: 1 2 3 4\ne 2: 2 3 4 5\ne 3: 0 1 2 3\ne 4: 0 1 2 4\n");
}

static void no_nodes(void) {
    rg_import m = {.path = "pair", .scale = 1};
    rg_import_element(&m, 8, 4, (const size_t[]){10, 20, 30, 40}, -1);
}

static void no_elements(void) {
    rg_import m = {.path = "pair", .scale = 1};
    add_nodes(&m);
    end(&m);
}

static void test_nothing(void **state) {
    (void)state;
    expect_said(no_nodes, RG_USAGE, "rhegma: pair: element 8 has node 10, which is not there\n");
    expect_said(no_elements, RG_USAGE, "rhegma: pair: no tetrahedra\n");
}

/* Of a second-order element, whose middles are off straight by so many parts of their edges. */
static double off[6];

static void add_quadratic(void) {
    static const int ends[6][2] = {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {2, 3}, {1, 3}};
    rg_import m = {.path = "pair", .scale = 0.25};
    size_t node[10] = {10, 20, 30, 40};
    add_nodes(&m);
    for (int k = 0; k < 6; k++) {
        double x[3], edge = 0;
        for (int i = 0; i < 3; i++) {
            double a = m.x[3 * ends[k][0] + i] * 4, b = m.x[3 * ends[k][1] + i] * 4;
            x[i] = (a + b) / 2;
            edge += (b - a) * (b - a);
        }
        x[k % 3] += off[k] * __builtin_sqrt(edge);
        node[4 + k] = 100 + (size_t)k;
        rg_import_node(&m, node[4 + k], x);
    }
    rg_import_element(&m, 1, 10, node, 0);
    rg_mesh *mesh = rg_import_finish(&m, names);
    assert_int_equal(mesh->region[0], 0);
    print_mesh(&(rg_mesh){.vertices = 1, .x = mesh->x}, stderr);
}

static void test_middles(void **state) {
    (void)state;
    static const struct {
        double off[6];
        const char *said;
    } cases[] = {
        {{0, 0, 0, 0, 0, 0}, ""},
        {{0.9e-6, 0, 0, 0, 0, 0}, ""},
        {{1.1e-6, 0, 0, 0, 0.9e-6, 0},
         "1 of 6 mid-nodes are off straight by more than 1e-06 of their edge, by 1.1e-06 at most\n"},
        {{0, 0.25, 0.5, 0.125, 0, 0},
         "3 of 6 mid-nodes are off straight by more than 1e-06 of their edge, by 0.5 at most\n"},
        {{0, 0, 0, 0, 0.0625, 0.25},
         "2 of 6 mid-nodes are off straight by more than 1e-06 of their edge, by 0.25 at most\n"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char said[400];
        memcpy(off, cases[i].off, sizeof off);
        snprintf(said, sizeof said, "%s%sx 0: 0.25 0.5 0.75\n",
                 cases[i].said[0] != '\0' ? WARNING "second-order elements are taken by their corners: " : "",
                 cases[i].said);
        expect_said(add_quadratic, RG_OK, said);
    }
}

/* Faces, in any order of their nodes: of the surface, between elements, of nothing; named and not. */
static const rg_import_face *faces;
static size_t face_count;

static void add_faces(void) {
    rg_import m = make_pair();
    rg_import_node(&m, 60, (const double[]){0, 0, 0.5});
    rg_import_node(&m, 60, (const double[]){0, 0, 0.25});
    rg_import_node(&m, 5, (const double[]){9, 9, 9.5});
    for (size_t i = 0; i < face_count; i++) {
        rg_import_add_face(&m, faces[i].name, faces[i].node, faces[i].set);
    }
    end(&m);
}

#define LEFT                                                                                                 \
    WARNING "2 nodes belong to no tetrahedron and are left out; the first is node 5 at (9, 9, 9.5) m\n"
#define BETWEEN "faces of surface sets lie between elements, not on the surface: in no set\n"
#define NOWHERE "triangles of surface sets are no faces of tetrahedra: left out\n"

static void expect_faces(size_t count, const rg_import_face *list, int status, const char *said) {
    faces = list;
    face_count = count;
    expect_said(add_faces, status, said);
}

static void test_faces(void **state) {
    (void)state;
    const rg_import_face surface[] = {{{40, 10, 20}, 7, 1}, {{50, 40, 20}, 8, 0}, {{20, 10, 40}, 9, 1}};
    expect_faces(3, surface, RG_OK, LEFT X5 "e 1: 0 1 2 3, side at 2\ne 2: 1 2 3 4, top at 1\n");
    const rg_import_face unnamed[] = {{{40, 10, 20}, 7, RG_IMPORT_UNNAMED},
                                      {{40, 30, 20}, 8, RG_IMPORT_UNNAMED}};
    expect_faces(2, unnamed, RG_OK, LEFT X5 "e 1: 0 1 2 3\ne 2: 1 2 3 4\ninner 1 2 3\n");
    const rg_import_face both[] = {{{40, 10, 20}, 7, RG_IMPORT_UNNAMED},
                                   {{40, 10, 20}, 8, 0},
                                   {{40, 30, 20}, 9, RG_IMPORT_UNNAMED},
                                   {{40, 20, 30}, 10, 1}};
    expect_faces(4, both, RG_OK,
                 LEFT WARNING "1 " BETWEEN X5 "e 1: 0 1 2 3, top at 2\ne 2: 1 2 3 4\ninner 1 2 3\n");
    /* with node 60, 99 and 5, of which the second is not there and the others are no corners; and behind all
     * faces */
    const rg_import_face nowhere[] = {{{10, 20, 50}, 7, 0},
                                      {{10, 20, 60}, 8, 0},
                                      {{99, 20, 10}, 9, 1},
                                      {{10, 5, 50}, 10, RG_IMPORT_UNNAMED},
                                      {{10, 30, 50}, 11, RG_IMPORT_UNNAMED},
                                      {{20, 10, 30}, 12, 1},
                                      {{40, 50, 50}, 13, 1}};
    expect_faces(7, nowhere, RG_OK, LEFT WARNING "4 " NOWHERE X5 "e 1: 0 1 2 3, side at 3\ne 2: 1 2 3 4\n");
    const rg_import_face two[] = {{{40, 10, 20}, 9, 1}, {{20, 10, 40}, 7, 0}};
    expect_faces(
        2, two, RG_USAGE,
        LEFT
        "rhegma: pair: 7 and 9 are the same face, in surface sets 'top' and 'side'; it can be in one only\n");
    const rg_import_face inside[] = {{{40, 30, 20}, 7, 1}, {{20, 30, 40}, 9, 0}};
    expect_faces(
        2, inside, RG_USAGE,
        LEFT
        "rhegma: pair: 7 and 9 are the same face, in surface sets 'side' and 'top'; it can be in one only\n");
}

/* A mesh takes as much memory as its arrays have items, and gives all of it back. */
static void test_memory(void **state) {
    (void)state;
    size_t before = rg_alloc_total();
    rg_import m = make_pair();
    rg_import_add_face(&m, 7, (const size_t[]){40, 10, 20}, 1);
    rg_import_add_face(&m, 8, (const size_t[]){40, 10, 30}, 1);
    rg_mesh *mesh = rg_import_finish(&m, names);
    enum { VERTICES = 5, ELEMENTS = 2, FACES = 2 };
    assert_int_equal(rg_alloc_total() - before,
                     sizeof *mesh + 3 * VERTICES * sizeof *mesh->x +
                         ELEMENTS * (4 * (sizeof *mesh->corner + sizeof *mesh->neighbour +
                                          sizeof *mesh->face + sizeof *mesh->set) +
                                     sizeof *mesh->region + sizeof *mesh->original) +
                         (3 * FACES + 1) * sizeof *mesh->inner);
    rg_mesh_free(mesh);
    assert_int_equal(rg_alloc_total(), before);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_turns), cmocka_unit_test(test_nothing), cmocka_unit_test(test_middles),
        cmocka_unit_test(test_faces), cmocka_unit_test(test_memory),
    };
    return cmocka_run_group_tests_name("import", tests, NULL, NULL);
}
