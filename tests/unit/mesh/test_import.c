/* Import, whatever the format: numbers that are far apart, middles of edges, names of faces. */
#include <math.h>
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
#include "base/tet.h"
#include "base/vector.h"
#include "layout.h"
#include "mesh/check.h"
#include "mesh/import/import.h"
#include "mesh/import/merge.h"
#include "support/dice.h"
#include "support/mesh_text.h"

static void add_nodes(rg_import *m) {
    static const double x[5][3] = {{1, 2, 3}, {5, 2, 3.5}, {1.5, 7, 3}, {1, 2.5, 9}, {6, 8, 10}};
    for (size_t n = 0; n < 5; n++) {
        rg_import_node(m, 10 * (n + 1), x[n]);
    }
}

/* Two tetrahedra on either side of nodes 20 30 40. */
static rg_import make_pair(void) {
    rg_import m = {.path = "pair", .how.scale = 1};
    add_nodes(&m);
    rg_import_element(&m, 1, 4, (const size_t[]){10, 20, 30, 40});
    rg_import_element(&m, 2, 4, (const size_t[]){20, 30, 40, 50});
    rg_sets_add(&m.surface, "top");
    rg_sets_add(&m.surface, "side");
    return m;
}

static void end(rg_import *m) {
    rg_mesh *mesh = rg_import_finish(m);
    print_mesh(mesh, stderr);
}

#define X5      "x 0: 1 2 3\nx 1: 5 2 3.5\nx 2: 1.5 7 3\nx 3: 1 2.5 9\nx 4: 6 8 10\n"
#define WARNING "rhegma: warning: pair: "

/* Nodes that come after elements, and one that comes again and moves. */
static void add_in_turns(void) {
    rg_import m = make_pair();
    rg_import_node(&m, 5, (const double[]){8, 1, 2});
    rg_import_element(&m, 3, 4, (const size_t[]){10, 20, 30, 5});
    rg_import_node(&m, 50, (const double[]){6.5, 8.5, 10.5});
    rg_import_element(&m, 4, 4, (const size_t[]){10, 20, 5, 40});
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
    rg_import m = {.path = "pair", .how.scale = 1};
    rg_import_element(&m, 8, 4, (const size_t[]){10, 20, 30, 40});
}

static void no_elements(void) {
    rg_import m = {.path = "pair", .how.scale = 1};
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
    rg_import m = {.path = "pair", .how.scale = 0.25};
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
    rg_import_element(&m, 1, 10, node);
    rg_import_put(&m, 0, rg_sets_add(&m.volume, "steel"));
    rg_mesh *mesh = rg_import_finish(&m);
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
        rg_import_add_face(&m, faces[i]);
    }
    end(&m);
}

#define LEFT                                                                                                 \
    WARNING "2 nodes belong to no tetrahedron and are left out; the first is node 5 at (9, 9, 9.5) m\n"
#define BETWEEN                                                                                              \
    "faces of surface sets lie between elements: interface.sets may name them, boundary leaves them out\n"
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
                 LEFT WARNING "1 " BETWEEN X5
                              "e 1: 0 1 2 3, side at 0, top at 2\ne 2: 1 2 3 4, side at 3\ninner 1 2 3\n");
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
    expect_faces(2, two, RG_OK, LEFT X5 "e 1: 0 1 2 3, top and side at 2\ne 2: 1 2 3 4\n");
    const rg_import_face inside[] = {{{40, 30, 20}, 7, 1}, {{20, 30, 40}, 9, 0}};
    expect_faces(2, inside, RG_OK,
                 LEFT WARNING
                 "1 " BETWEEN X5
                 "e 1: 0 1 2 3, top and side at 0\ne 2: 1 2 3 4, top and side at 3\ninner 1 2 3\n");
}

/* ---- nodes that coincide ---- */

/* Points on a grid of twelve places along each axis, the outer ones far away, some off by a little more or
 * less than is within reach: against all pairs. */
static void test_merge(void **state) {
    (void)state;
    enum { ROWS = 300 };
    const double reach = 0.25;
    int64_t joined = 0;
    for (uint64_t seed = 1; seed < 40; seed++) {
        double x[3 * ROWS], farthest = 0;
        size_t twin[ROWS], low[ROWS];
        dice d = {.seed = seed};
        for (size_t k = 0; k < 3 * ROWS; k++) {
            double aside[] = {0, 0, 0.125, 0.25, 0.26, 0.5};
            x[k] =
                floor(3 * dice_unit(&d)) + aside[(size_t)(6 * dice_unit(&d))] + (k % 3 == seed % 3 ? 1e3 : 0);
        }
        for (size_t n = 0; n < ROWS; n++) { /* every tenth stands for another one already */
            twin[n] = n % 10 == 9 ? n - 9 : n;
            low[n] = n;
        }
        for (bool again = true; again;) {
            again = false;
            for (size_t a = 0; a < ROWS; a++) {
                for (size_t b = 0; b < a; b++) {
                    double apart = sqrt(pow(x[3 * a] - x[3 * b], 2) + pow(x[3 * a + 1] - x[3 * b + 1], 2) +
                                        pow(x[3 * a + 2] - x[3 * b + 2], 2));
                    if (a % 10 != 9 && b % 10 != 9 && apart <= reach) {
                        again = again || low[a] != low[b];
                        low[a] = low[b] = low[a] < low[b] ? low[a] : low[b];
                        farthest = fmax(farthest, apart);
                    }
                }
            }
        }
        rg_merged found = rg_merge(ROWS, x, reach, twin);
        int64_t count = 0;
        size_t first = ROWS;
        for (size_t n = 0; n < ROWS; n++) {
            assert_int_equal(twin[n], n % 10 == 9 ? low[n - 9] : low[n]);
            first = n % 10 != 9 && low[n] != n && n < first ? n : first;
            count += n % 10 != 9 && low[n] != n;
        }
        assert_true(found.count == count && found.first == first && found.farthest == farthest);
        joined += count;
    }
    assert_true(joined > 1000);
}

/* ---- plates ---- */

/* Two triangles side by side, the second one left-handed and in two sets, with edges and nodes in sets; the
 * square they fill is off the axes. A node is off the plane, or merged with another. */
static rg_import_how plate_how;
static double off_plane, away;
static const char *edge_name;
static bool with_solid, without_faces;

static void add_plate(void) {
    rg_import m = {.path = "plate", .how = plate_how};
    static const double x[5][3] = {{1, 1, 3}, {3, 1, 3}, {3, 2, 3}, {1, 2, 3}, {3, 1, 3}};
    static const size_t number[5] = {10, 20, 30, 40, 15};
    for (size_t n = 0; n < 5; n++) {
        rg_import_node(&m, number[n],
                       (const double[]){x[n][0] - away, x[n][1] + away, x[n][2] + (n == 2 ? off_plane : 0)});
    }
    rg_sets_add(&m.surface, "a");
    rg_sets_add(&m.surface, "b");
    rg_sets_add(&m.edge_set, edge_name);
    rg_sets_add(&m.edge_set, "cut");
    rg_sets_add(&m.node_set, "side");
    size_t second = plate_how.merge > 0 ? 15 : 20;
    if (!without_faces) {
        rg_import_add_face(&m, (rg_import_face){{10, 20, 40}, 7, 1});
        rg_import_add_face(&m, (rg_import_face){{40, 30, second}, 6, 0});
        rg_import_add_face(&m, (rg_import_face){{40, 30, second}, 6, 1});
    }
    rg_import_add_edge(&m, (rg_import_edge){{40, 10}, 1, 0});
    rg_import_add_edge(&m, (rg_import_edge){{40, second}, 2, 1});
    rg_import_add_point(&m, 30, 0);
    rg_import_add_point(&m, second, 0);
    if (with_solid) {
        rg_import_element(&m, 9, 4, (const size_t[]){10, 20, 30, 40});
    }
    rg_mesh *mesh = rg_import_finish(&m);
    rg_mesh_sort(mesh);
    rg_mesh_connect(mesh);
    rg_mesh_check(mesh, "plate");
    double volume[4] = {0}, area[6] = {0}, inside = 0;
    for (rg_gid slot = 0; slot < 4 * mesh->elements; slot++) {
        const double *c[4], *p = mesh->x;
        for (int k = 0; k < 4; k++) {
            c[k] = p + 3 * mesh->corner[slot / 4 * 4 + k];
        }
        volume[mesh->region[slot / 4]] += fabs(rg_tet_volume(c[0], c[1], c[2], c[3])) / 4;
        double u[3], v[3], n[3];
        const int *f = rg_face_node[slot % 4];
        rg_vector_subtract(c[f[1]], c[f[0]], u);
        rg_vector_subtract(c[f[2]], c[f[0]], v);
        rg_vector_cross(u, v, n);
        double here = sqrt(rg_vector_dot(n, n)) / 2;
        area[mesh->set[slot] >= 0 ? mesh->set[slot] : 5] += here;
        inside += mesh->neighbour[slot] >= 0 && mesh->set[slot] >= 0 ? here : 0;
    }
    fprintf(stderr, "%d elements, %d vertices; volumes %g %g %g; areas", (int)mesh->elements,
            (int)mesh->vertices, volume[0], volume[1], volume[2]);
    for (int32_t s = 0; s < mesh->surface.count; s++) {
        fprintf(stderr, " %s %g", mesh->surface.name[s], area[s]);
    }
    fprintf(stderr, ", inside %g\n", inside);
}

#define LONE                                                                                                 \
    "rhegma: warning: plate: 1 nodes belong to no tetrahedron and are left out; the first is node 15 at "    \
    "(6, 2, 6) m\n"

static void test_extrude(void **state) {
    (void)state;
    for (int layers = 1; layers < 4; layers++) {
        for (int merge = 0; merge < 2; merge++) {
            char said[1000];
            edge_name = "left";
            plate_how = (rg_import_how){.scale = 2, .merge = merge, .thickness = 0.75, .layers = layers};
            snprintf(said, sizeof said,
                     LONE
                     "rhegma: warning: plate: %d " BETWEEN
                     "%d elements, %d vertices; volumes 0 3 3; areas left 1.5 cut %g bottom 8 top 8 side "
                     "1.5, inside %g\n",
                     2 * layers, 6 * layers, 4 * (layers + 1), 2 * sqrt(20) * 0.75, 2 * sqrt(20) * 0.75);
            expect_said(add_plate, RG_OK, said);
        }
    }
    plate_how.merge = 0;
    edge_name = "top"; /* is that of an edge: the upper face has no name */
    expect_said(
        add_plate, RG_OK,
        "rhegma: warning: plate: there is a set 'top' of edges: the faces that --extrude would call so "
        "are in no set\n" LONE "rhegma: warning: plate: 6 " BETWEEN
        "18 elements, 16 vertices; volumes 0 3 3; areas top 1.5 cut 6.7082 bottom 8 side 1.5, inside "
        "6.7082\n");
    away = 32; /* of no consequence for what is turned */
    expect_said(
        add_plate, RG_OK,
        "rhegma: warning: plate: there is a set 'top' of edges: the faces that --extrude would call so "
        "are in no set\n"
        "rhegma: warning: plate: 1 nodes belong to no tetrahedron and are left out; the first is node 15 at "
        "(-58, 66, 6) m\n"
        "rhegma: warning: plate: 6 " BETWEEN
        "18 elements, 16 vertices; volumes 0 3 3; areas top 1.5 cut 6.7082 bottom 8 side 1.5, inside "
        "6.7082\n");
    away = 0;
    off_plane = 0.001;
    expect_said(
        add_plate, RG_USAGE,
        "rhegma: plate: --extrude takes a mesh that is flat in z, but its triangles are at z from 6 to "
        "6.002 m\n");
    off_plane = 0;
    without_faces = true;
    expect_said(
        add_plate, RG_USAGE,
        "rhegma: plate: --extrude takes a flat mesh of triangles and quadrangles, but there are none\n");
    with_solid = true;
    expect_said(add_plate, RG_USAGE,
                "rhegma: plate: --extrude takes a flat mesh of triangles and quadrangles, but there are "
                "solids\n");
}

/* Sets of nodes: faces of the surface all of whose corners are in one; if there are none, those between
 * elements. */
static void add_points(void) {
    static const struct {
        const char *name;
        size_t node[5];
    } sets[] = {{"all", {10, 20, 30, 40, 50}}, {"none", {10, 20, 50}},   {"foot", {30, 10, 20, 30, 99}},
                {"side", {50, 40, 30}},        {"inside", {20, 30, 40}}, {"back", {40, 50, 30, 60}}};
    rg_import m = make_pair();
    rg_import_node(&m, 60, (const double[]){0, 0, 0.5});
    rg_import_add_face(&m, (rg_import_face){{40, 10, 20}, 7, 1});
    for (int i = 5; i >= 0; i--) {
        for (int k = 0; k < 5 && sets[i].node[k] > 0; k++) {
            rg_import_add_point(&m, sets[i].node[k], i);
        }
    }
    for (int i = 0; i < 6; i++) {
        rg_sets_add(&m.node_set, sets[i].name);
    }
    end(&m);
}

static void test_points(void **state) {
    (void)state;
    expect_said(
        add_points, RG_OK,
        WARNING
        "1 nodes belong to no tetrahedron and are left out; the first is node 60 at (0, 0, 0.5) m\n" WARNING
        "1 sets of nodes hold no whole face and are left out: 'none'\n" WARNING
        "1 sets of nodes are left out, for there are surfaces of their names: 'side'\n" X5
        "e 1: 0 1 2 3, inside at 0, all at 1, side and all at 2, all and foot at 3\n"
        "e 2: 1 2 3 4, all and back at 0, all at 1, all at 2, inside at 3\n");
}

/* The message names the first five. */
static void add_many_points(void) {
    rg_import m = make_pair();
    for (int i = 0; i < 7; i++) {
        rg_sets_add(&m.node_set, (const char[]){(char)('a' + i), '\0'});
    }
    end(&m);
}

static void test_many_points(void **state) {
    (void)state;
    expect_said(add_many_points, RG_OK,
                WARNING "7 sets of nodes hold no whole face and are left out: 'a', 'b', 'c', 'd', "
                        "'e', ...\n" X5 "e 1: 0 1 2 3\ne 2: 1 2 3 4\n");
}

/* Outer faces of elements, beside faces that are named: sets of both, in any order. */
static void add_skins(void) {
    rg_import m = make_pair();
    rg_sets_add(&m.surface, "skin");
    rg_sets_add(&m.surface, "more");
    rg_import_add_face(&m, (rg_import_face){{40, 10, 20}, 7, 3});
    rg_import_add_face(&m, (rg_import_face){{40, 10, 20}, 8, 0});
    rg_import_add_face(&m, (rg_import_face){{40, 50, 20}, 9, 2});
    rg_import_put_skin(&m, 0, 2);
    rg_import_put_skin(&m, 0, 1);
    rg_import_put_skin(&m, 1, 2);
    end(&m);
}

static void test_skins(void **state) {
    (void)state;
    expect_said(add_skins, RG_OK,
                X5
                "e 1: 0 1 2 3, side and skin at 1, top and side and skin and more at 2, side and skin at 3\n"
                "e 2: 1 2 3 4, skin at 0, skin at 1, skin at 2\n");
}

/* Elements in several sets of volumes. */
static void add_volumes(void) {
    rg_import m = make_pair();
    rg_sets_add(&m.volume, "steel");
    rg_sets_add(&m.volume, "half");
    rg_sets_add(&m.volume, "whole");
    for (int32_t e = 0; e < 2; e++) {
        rg_import_put(&m, e, e);
        rg_import_put(&m, e, 2);
        rg_import_put(&m, e, 2);
    }
    end(&m);
}

static void test_volumes(void **state) {
    (void)state;
    expect_said(add_volumes, RG_OK, X5 "e 1: 0 1 2 3 in steel and whole\ne 2: 1 2 3 4 in half and whole\n");
}

/* A mesh takes as much memory as its arrays have items, and gives all of it back. */
static void test_memory(void **state) {
    (void)state;
    size_t before = rg_alloc_total();
    rg_import m = make_pair();
    rg_import_add_face(&m, (rg_import_face){{40, 10, 20}, 7, 1});
    rg_import_add_face(&m, (rg_import_face){{40, 10, 30}, 8, 1});
    rg_mesh *mesh = rg_import_finish(&m);
    enum { VERTICES = 5, ELEMENTS = 2, FACES = 2 };
    assert_int_equal(rg_alloc_total() - before,
                     sizeof *mesh + sizeof "top" + sizeof "side" + 3 * VERTICES * sizeof *mesh->x +
                         ELEMENTS * (4 * (sizeof *mesh->corner + sizeof *mesh->neighbour +
                                          sizeof *mesh->face + sizeof *mesh->set) +
                                     sizeof *mesh->region + sizeof *mesh->original) +
                         (3 * FACES + 1) * sizeof *mesh->inner);
    rg_mesh_free(mesh);
    assert_int_equal(rg_alloc_total(), before);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_turns),   cmocka_unit_test(test_nothing),     cmocka_unit_test(test_middles),
        cmocka_unit_test(test_faces),   cmocka_unit_test(test_points),      cmocka_unit_test(test_merge),
        cmocka_unit_test(test_extrude), cmocka_unit_test(test_many_points), cmocka_unit_test(test_skins),
        cmocka_unit_test(test_volumes), cmocka_unit_test(test_memory),
    };
    int failed = cmocka_run_group_tests_name("import", tests, NULL, NULL);
    return failed + (rg_alloc_blocks() > 0); /* all is given back */
}
