/* Whether a mesh can be computed on: every rule at its bound, and hanging nodes against a search of all
 * pairs. */
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
#include "layout.h"
#include "mesh/check.h"
#include "support/dice.h"
#include "support/mesh_text.h"

/* ---- elements ---- */

static void test_longest_edge(void **state) {
    (void)state;
    dice d = {.seed = 1};
    bool seen[6] = {false};
    for (int n = 0; n < 200; n++) {
        double x[12], most = 0;
        int which = 0;
        for (int i = 0; i < 12; i++) {
            x[i] = 3 * dice_sign(&d);
        }
        for (int a = 0, k = 0; a < 4; a++) {
            for (int b = a + 1; b < 4; b++, k++) {
                double length = hypot(hypot(x[3 * a] - x[3 * b], x[3 * a + 1] - x[3 * b + 1]),
                                      x[3 * a + 2] - x[3 * b + 2]);
                which = length > most ? k : which;
                most = fmax(most, length);
            }
        }
        seen[which] = true;
        assert_true(fabs(rg_tet_longest_edge(x) - most) <= 1e-15 * most);
    }
    for (int k = 0; k < 6; k++) {
        assert_true(seen[k]);
    }
}

static void test_volume_bound(void **state) {
    (void)state;
    const rg_gid corner[4] = {3, 5, 8, 9};
    double x[12] = {1, 2, 3, 5, 2, 3, 1, 5, 3}; /* edges 4, 3 and 5; the height makes 1e-12 of 125 */
    char what[RG_INPUT_ERROR_WORDS];
    const double height = 125e-12 / 2;
    for (int side = -1; side <= 1; side += 2) {
        memcpy(x + 9, (double[]){2, 3, 0}, 3 * sizeof *x);
        x[2] = x[5] = x[8] = 0;
        x[11] = side * 1.001 * height;
        assert_true(rg_tet_sound(x, corner, 70, what));
        x[11] = side * 0.999 * height;
        assert_false(rg_tet_sound(x, corner, 70, what));
        assert_string_equal(
            what, "element 70 at (1, 2, 0) m has no volume: 1.24875e-10 m3 with edges of up to 5 m");
    }
    x[11] = NAN;
    assert_false(rg_tet_sound(x, corner, 70, what));
}

static void test_corner_order(void **state) {
    (void)state;
    const double x[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const rg_gid wrong[][4] = {{3, 3, 8, 9}, {3, 8, 8, 9}, {3, 5, 9, 9},
                               {5, 3, 8, 9}, {3, 8, 5, 9}, {3, 5, 9, 8}};
    char what[RG_INPUT_ERROR_WORDS], words[RG_INPUT_ERROR_WORDS];
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_false(rg_tet_sound(x, wrong[i], 70, what));
        snprintf(words, sizeof words,
                 "element 70: its corners must be four different vertices in ascending order; they are %d, "
                 "%d, %d, %d",
                 (int)wrong[i][0], (int)wrong[i][1], (int)wrong[i][2], (int)wrong[i][3]);
        assert_string_equal(what, words);
    }
    assert_true(rg_tet_sound(x, (const rg_gid[]){3, 5, 8, 9}, 70, what));
}

/* ---- meshes ---- */

/* A chain of three tetrahedra, elements 71, 72 and 73 of the input, with room for a fourth and more vertices.
 */
static rg_mesh *chain(void) {
    static const double x[6][3] = {{1, 2, 3}, {5, 2, 3.5}, {1.5, 7, 3}, {1, 2.5, 9}, {6, 8, 10}, {-3, 4, 15}};
    static const rg_gid corner[12] = {0, 1, 2, 3, 1, 2, 3, 4, 2, 3, 4, 5};
    rg_mesh *m = RG_NEW(rg_mesh, 1);
    *m = (rg_mesh){.vertices = 6,
                   .elements = 3,
                   .x = RG_NEW(double, 3 * 12),
                   .corner = RG_NEW(rg_gid, 4 * 4),
                   .neighbour = RG_NEW(rg_gid, 4 * 4),
                   .face = RG_NEW(int8_t, 4 * 4),
                   .set = RG_NEW(int32_t, 4 * 4),
                   .original = RG_NEW(rg_gid, 4)};
    memcpy(m->x, x, sizeof x);
    memcpy(m->corner, corner, sizeof corner);
    for (rg_gid e = 0; e < 4; e++) {
        m->original[e] = 71 + e;
    }
    rg_mesh_connect(m);
    return m;
}

/* What a case changes in the chain: `corner`, `neighbour`, `face` or `set` at a place. */
typedef struct {
    char what;
    int at;
    int64_t value;
    const char *said;
} change;

static const change *planted;

static void check_changed(void) {
    rg_mesh *m = chain();
    for (const change *c = planted; c->what != '\0'; c++) {
        c->what == 'c'   ? (void)(m->corner[c->at] = c->value)
        : c->what == 'n' ? (void)(m->neighbour[c->at] = c->value)
        : c->what == 'f' ? (void)(m->face[c->at] = (int8_t)c->value)
        : c->what == 's' ? (void)(m->set[c->at] = (int32_t)c->value)
                         : (void)(m->vertices = c->value);
    }
    rg_mesh_check(m, "chain");
}

static void test_changes(void **state) {
    (void)state;
    const change cases[][8] = {
        {{'c', 3, 6, "element 71: there is no vertex 6\n"}},
        {{'c', 4, -1, "element 72: there is no vertex -1\n"}},
        {{'c', 7, 3,
          "element 72: its corners must be four different vertices in ascending order; they are 1, 2, 3, "
          "3\n"}},
        {{'v', 0, 7, "no element uses vertex 6\n"}},
        /* slots 0 and 7 are one face, 4 and 11 another */
        {{'s', 4, 1, "set: elements 72 and 73 have the face between them in different sets\n"}},
        {{'s', 4, 2, ""},
         {'s', 11, 2, ""},
         {'s', 7, 2, "set: elements 71 and 72 have the face between them in different sets\n"}},
        {{'n', 0, 3,
          "neighbour: element 71 takes element 3 for its neighbour across face 0, but they do not share it\n"
          "neighbour: element 72 takes element 71 for its neighbour across face 3, but they do not share "
          "it\n"}},
        {{'n', 0, 0,
          "neighbour: element 71 takes element 71 for its neighbour across face 0, but they do not share it\n"
          "neighbour: element 72 takes element 71 for its neighbour across face 3, but they do not share "
          "it\n"}},
        {{'f', 0, -1,
          "neighbour: element 71 takes element 72 for its neighbour across face 0, but they do not share it\n"
          "neighbour: element 72 takes element 71 for its neighbour across face 3, but they do not share "
          "it\n"}},
        {{'f', 0, 4,
          "neighbour: element 71 takes element 72 for its neighbour across face 0, but they do not share it\n"
          "neighbour: element 72 takes element 71 for its neighbour across face 3, but they do not share "
          "it\n"}},
        {{'n', 7, 2,
          "neighbour: element 71 takes element 72 for its neighbour across face 0, but they do not share it\n"
          "neighbour: element 72 takes element 73 for its neighbour across face 3, but they do not share "
          "it\n"}},
        {{'n', 7, -1,
          "neighbour: element 71 takes element 72 for its neighbour across face 0, but they do not share "
          "it\n"}},
        {{'n', 1, 2, ""},
         {'f', 1, 2, ""},
         {'n', 10, 0, ""},
         {'f', 10, 1, /* agree, but share no face */
          "neighbour: element 71 takes element 73 for its neighbour across face 1, but they do not share it\n"
          "neighbour: element 73 takes element 71 for its neighbour across face 2, but they do not share "
          "it\n"}},
        {{'c', 12, 3, ""}, /* agree, but one of them is behind the last element */
         {'c', 13, 4, ""},
         {'c', 14, 5, ""},
         {'n', 15, 2, ""},
         {'f', 15, 0, ""},
         {'f', 8, 3, ""},
         {'n', 8, 3,
          "neighbour: element 73 takes element 3 for its neighbour across face 0, but they do not share "
          "it\n"}},
    };
    planted = (const change[]){{.what = '\0'}};
    expect_said(check_changed, RG_OK, "");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        change list[9] = {{.what = '\0'}};
        char said[1000] = "";
        int n = 0;
        for (; n < 8 && cases[i][n].what != '\0'; n++) {
            list[n] = cases[i][n];
        }
        planted = list;
        for (const char *line = cases[i][n - 1].said; *line != '\0'; line = strchr(line, '\n') + 1) {
            snprintf(said + strlen(said), sizeof said - strlen(said), "rhegma: chain: %.*s\n",
                     (int)strcspn(line, "\n"), line);
        }
        expect_said(check_changed, RG_USAGE, said);
    }
}

/* Three elements on each of two faces: that of the earlier element is told first. */
static void connect_thrice(void) {
    static const rg_gid corner[24] = {0, 1, 2, 6, 3, 4, 5, 7,  3, 4, 5, 8,
                                      3, 4, 5, 9, 0, 1, 2, 10, 0, 1, 2, 11};
    rg_mesh *m = chain();
    m->vertices = 12;
    m->elements = 6;
    m->corner = RG_NEW(rg_gid, 24);
    m->neighbour = RG_NEW(rg_gid, 24);
    m->face = RG_NEW(int8_t, 24);
    m->original = NULL;
    memcpy(m->corner, corner, sizeof corner);
    rg_mesh_connect(m);
}

static void test_third_element_on_a_face(void **state) {
    (void)state;
    expect_said(connect_thrice, RG_USAGE,
                "rhegma: mesh: elements 0, 4 and 5 share the face with vertices 0, 1 and 2\n"
                "rhegma: mesh: elements 1, 2 and 3 share the face with vertices 3, 4 and 5\n");
}

/* Where the chain's number is that of the input itself. */
static void check_unnumbered(void) {
    rg_mesh *m = chain();
    m->original = NULL;
    m->neighbour[4] = -1;
    m->face[4] = -1;
    rg_mesh_check(m, "chain");
}

static void test_numbers_without_an_input(void **state) {
    (void)state;
    expect_said(check_unnumbered, RG_USAGE,
                "rhegma: chain: neighbour: element 2 takes element 1 for its neighbour across face 3, but "
                "they do not "
                "share it\n");
}

/* ---- vertices at the same place ---- */

static double apart[3];
static int copies;

/* A fourth element with copies of the chain's last face, moved by so much, and a vertex of its own. */
static void check_copies(void) {
    rg_mesh *m = chain();
    memcpy(m->x + 18, m->x + 9, 9 * sizeof *m->x); /* 6 7 8 are copies of 3 4 5 */
    memcpy(m->x + 27, (const double[]){0, 11, 14}, 3 * sizeof *m->x);
    for (int k = 0; k < 3; k++) {
        m->x[18 + k] += apart[k];
        m->x[21 + k] += copies > 1 ? 0 : 10;
        m->x[24 + k] += copies > 2 ? 0 : k == 0 ? -20 : 9;
    }
    memcpy(m->corner + 12, (const rg_gid[]){6, 7, 8, 9}, 4 * sizeof *m->corner);
    m->vertices = 10;
    m->elements = 4;
    memset(m->set, -1, 16 * sizeof *m->set);
    rg_mesh_connect(m);
    rg_mesh_check(m, "chain");
}

static void test_same_place(void **state) {
    (void)state;
    const char *at =
        "rhegma: chain: elements %d and 74 have different vertices at the same place (%s) m: the mesh is "
        "open there; rhegma mesh joins nodes that coincide by --merge D, keeps parts apart by --apart, or "
        "takes faces that lie on each other for a crack by --crack NAME\n";
    char one[500], all[1500];
    snprintf(one, sizeof one, at, 71, "1, 2.5, 9");
    copies = 1;
    expect_said(check_copies, RG_USAGE, one);
    /* Within 1e-9 of the diagonal of the box, here from (-23, 2, 3) to (16, 18, 24). */
    double reach = 1e-9 * sqrt(39 * 39 + 16 * 16 + 21 * 21);
    for (int i = 0; i < 3; i++) {
        apart[i] = 0.99 * reach;
        snprintf(one, sizeof one, at, 71,
                 i == 0   ? "1.00000005, 2.5, 9"
                 : i == 1 ? "1, 2.50000005, 9"
                          : "1, 2.5, 9.00000005");
        expect_said(check_copies, RG_USAGE, one);
        apart[i] = 1.01 * reach; /* then it is near a face of the other, but not at its corner */
        assert_int_equal(run_child(check_copies, all, sizeof all), RG_USAGE);
        assert_null(strstr(all, "same place"));
        assert_non_null(strstr(all, "hanging node"));
        apart[i] = 0;
    }
    copies = 3;
    int used = snprintf(all, sizeof all, at, 71, "1, 2.5, 9");
    used += snprintf(all + used, sizeof all - (size_t)used, at, 72, "6, 8, 10");
    snprintf(all + used, sizeof all - (size_t)used, at, 73, "-3, 4, 15");
    expect_said(check_copies, RG_USAGE, all);
}

/* Three vertices at one place: each of the two higher ones is told with the lowest. */
static void check_three(void) {
    static const double far[2][3] = {{20, 1, 2}, {1, 20, 2}};
    rg_mesh *m = RG_NEW(rg_mesh, 1);
    *m = (rg_mesh){.vertices = 12,
                   .elements = 3,
                   .x = RG_NEW(double, 36),
                   .corner = RG_NEW(rg_gid, 12),
                   .neighbour = RG_NEW(rg_gid, 12),
                   .face = RG_NEW(int8_t, 12),
                   .set = RG_NEW(int32_t, 12)};
    static const double x[4][3] = {{0, 0, 0}, {1, 0.5, 0.25}, {0.5, 2, 0}, {0.25, 0, 3}};
    for (int k = 0; k < 12; k++) {
        m->corner[k] = k;
        for (int i = 0; i < 3; i++) { /* the second and third look away from the first */
            double at = x[k % 4][i] * (k / 4 == 0 ? 1 : -1);
            m->x[3 * k + i] = k / 4 == 2 && k % 4 > 0 ? at + far[k % 2][i] : at;
        }
    }
    rg_mesh_connect(m);
    rg_mesh_check(m, "three");
}

static void test_three_at_one_place(void **state) {
    (void)state;
    const char *at =
        "rhegma: three: elements 0 and %d have different vertices at the same place (%s) m: the mesh is open "
        "there; rhegma mesh joins nodes that coincide by --merge D, keeps parts apart by --apart, or takes "
        "faces that lie on each other for a crack by --crack NAME\n";
    char said[900];
    int used = snprintf(said, sizeof said, at, 1, "-0, -0, -0");
    snprintf(said + used, sizeof said - (size_t)used, at, 2, "-0, -0, -0");
    expect_said(check_three, RG_USAGE, said);
}

/* ---- hanging nodes ---- */

/* Two tetrahedra without a common vertex: the first has triangle (0, 0, 0), (4, 0, 0), (1, 2, 0), in the
 * order of its numbers or another, and the second one corner at p; all of it moved by `away` along each axis.
 */
static rg_gid hangs_on_at(const double p[3], int order, double away) {
    static const double triangle[3][3] = {{0, 0, 0}, {4, 0, 0}, {1, 2, 0}};
    double x[8][3] = {{0}};
    rg_gid corner[8] = {0, 1, 2, 3, 4, 5, 6, 7}, neighbour[8];
    int8_t face[8];
    for (int k = 0; k < 3; k++) {
        memcpy(x[k], triangle[(order / 2 + (order % 2 ? 2 - k : k)) % 3], sizeof x[k]);
    }
    memcpy(x[3], (const double[]){1.5, 0.5, 7}, sizeof x[3]);
    memcpy(x[4], p, sizeof x[4]);
    for (int k = 5; k < 8; k++) {
        memcpy(x[k], (const double[]){p[0] + (k == 5), p[1] + 0.5 * (k == 6), -6 + (k == 7)}, sizeof x[k]);
    }
    for (int k = 0; k < 24; k++) {
        x[k / 3][k % 3] += away;
    }
    rg_mesh m = {
        .vertices = 8, .elements = 2, .x = x[0], .corner = corner, .neighbour = neighbour, .face = face};
    rg_mesh_connect(&m);
    neighbour[0] = neighbour[1] = neighbour[2] =
        1; /* of the first one, the triangle alone is on the surface */
    rg_gid *of = rg_mesh_hanging(&m), found = of[4];
    for (int v = 0; v < 8; v++) {
        assert_true(v == 4 || of[v] < 0);
    }
    rg_free(of);
    return found;
}

/* The same wherever the mesh lies. */
static rg_gid hangs_on(const double p[3], int order) {
    rg_gid found = hangs_on_at(p, order, 0);
    assert_int_equal(hangs_on_at(p, order, -64), found);
    assert_int_equal(hangs_on_at(p, order, 64), found);
    return found;
}

/* Distances from the triangle's plane and beyond its edges up to which a vertex counts as on it: 1e-6 of the
 * widest extent from the plane; from an edge more, by as much as it is shorter than the longer edge at corner
 * 0. */
static void test_reach(void **state) {
    (void)state;
    const double reach = 4e-6;
    for (int order = 0; order < 6; order++) {
        double t[3][3], u[3], v[3];
        static const double triangle[3][3] = {{0, 0, 0}, {4, 0, 0}, {1, 2, 0}};
        for (int k = 0; k < 3; k++) {
            memcpy(t[k], triangle[(order / 2 + (order % 2 ? 2 - k : k)) % 3], sizeof t[k]);
        }
        for (int i = 0; i < 3; i++) {
            u[i] = t[1][i] - t[0][i];
            v[i] = t[2][i] - t[0][i];
        }
        double longer = fmax(hypot(u[0], u[1]), hypot(v[0], v[1]));
        for (int side = -1; side <= 1; side += 2) {
            assert_int_equal(hangs_on((const double[]){1.5, 0.5, side * 0.99 * reach}, order), 3);
            assert_int_equal(hangs_on((const double[]){1.5, 0.5, side * 1.01 * reach}, order), -1);
        }
        for (int k = 0; k < 3; k++) { /* beyond the middle of the edge opposite corner k */
            const double *a = t[(k + 1) % 3], *b = t[(k + 2) % 3];
            double length = hypot(b[0] - a[0], b[1] - a[1]),
                   out[2] = {(b[1] - a[1]) / length, -(b[0] - a[0]) / length};
            double mid[2] = {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2};
            double sign = out[0] * (t[k][0] - mid[0]) + out[1] * (t[k][1] - mid[1]) > 0 ? -1 : 1;
            for (int i = 0; i < 2; i++) {
                double far = sign * (i == 0 ? 0.99 : 1.01) * reach * longer / length;
                const double p[3] = {mid[0] + far * out[0], mid[1] + far * out[1], 0};
                assert_int_equal(hangs_on(p, order), i == 0 ? 3 : -1);
            }
        }
    }
}

static double from_segment(const double p[3], const double a[3], const double b[3]) {
    double along = 0, square = 0, far = 0;
    for (int i = 0; i < 3; i++) {
        along += (p[i] - a[i]) * (b[i] - a[i]);
        square += (b[i] - a[i]) * (b[i] - a[i]);
    }
    double s = fmax(0, fmin(1, along / square));
    for (int i = 0; i < 3; i++) {
        far += pow(p[i] - a[i] - s * (b[i] - a[i]), 2);
    }
    return sqrt(far);
}

/* Whether p is on the triangle: its areas with p make up the triangle's. */
static bool on_triangle(const double p[3], const double *const t[3]) {
    double area[4];
    for (int k = 0; k < 4; k++) {
        const double *a = k == 0 ? p : t[0], *b = k == 1 ? p : t[1], *c = k == 2 ? p : t[2];
        double square = 0;
        for (int i = 0; i < 3; i++) {
            int j = (i + 1) % 3, l = (i + 2) % 3;
            square += pow((b[j] - a[j]) * (c[l] - a[l]) - (b[l] - a[l]) * (c[j] - a[j]), 2);
        }
        area[k] = sqrt(square);
    }
    return area[0] + area[1] + area[2] < area[3] * (1 + 1e-9) ||
           fmin(from_segment(p, t[0], t[1]), fmin(from_segment(p, t[1], t[2]), from_segment(p, t[2], t[0]))) <
               1e-9;
}

/* Boxes of different cells, side by side, as one mesh: at their common planes the vertices of each hang on
 * the other. */
static rg_mesh *join(int count, rg_mesh *const part[]) {
    rg_mesh *m = RG_NEW(rg_mesh, 1);
    for (int k = 0; k < count; k++) {
        m->vertices += part[k]->vertices;
        m->elements += part[k]->elements;
    }
    m->x = RG_NEW(double, 3 * (size_t)m->vertices);
    m->corner = RG_NEW(rg_gid, 4 * (size_t)m->elements);
    m->neighbour = RG_NEW(rg_gid, 4 * (size_t)m->elements);
    m->face = RG_NEW(int8_t, 4 * (size_t)m->elements);
    m->set = RG_NEW(int32_t, 4 * (size_t)m->elements);
    rg_gid v = 0, e = 0;
    for (int k = 0; k < count; k++) {
        memcpy(m->x + 3 * v, part[k]->x, 3 * (size_t)part[k]->vertices * sizeof *m->x);
        for (rg_gid i = 0; i < 4 * part[k]->elements; i++) {
            m->corner[4 * e + i] = part[k]->corner[i] + v;
        }
        v += part[k]->vertices;
        e += part[k]->elements;
    }
    rg_mesh_connect(m);
    return m;
}

static void test_hanging(void **state) {
    (void)state;
    static const int64_t cells[3][3] = {{3, 2, 4}, {2, 5, 3}, {4, 3, 2}};
    static const double origin[3][3] = {{-1, 2, 3}, {-0.1, 2.2, 3.1}, {-0.8, 2.9, 3.3}},
                        size[3][3] = {{0.9, 0.9, 2}, {3, 0.7, 1.6}, {0.3, 2, 1.1}};
    rg_mesh *part[3];
    for (int k = 0; k < 3; k++) {
        part[k] = rg_mesh_box(cells[k], origin[k], size[k], 0.2, 5 + k);
    }
    rg_mesh *m = join(3, part);
    rg_gid *of = rg_mesh_hanging(m), found = 0;
    bool *surface = RG_NEW(bool, (size_t)m->vertices);
    for (rg_gid slot = 0; slot < 4 * m->elements; slot++) {
        for (int k = 0; k < 3 && m->neighbour[slot] < 0; k++) {
            surface[m->corner[slot / 4 * 4 + rg_face_node[slot % 4][k]]] = true;
        }
    }
    for (rg_gid v = 0; v < m->vertices; v++) {
        rg_gid first = -1;
        for (rg_gid slot = 0; slot < 4 * m->elements && first < 0 && surface[v]; slot++) {
            const double *t[3];
            bool corner = false;
            for (int k = 0; k < 3; k++) {
                rg_gid w = m->corner[slot / 4 * 4 + rg_face_node[slot % 4][k]];
                t[k] = m->x + 3 * w;
                corner = corner || w == v;
            }
            first = m->neighbour[slot] < 0 && !corner && on_triangle(m->x + 3 * v, t) ? slot : -1;
        }
        assert_int_equal(of[v], first);
        found += first >= 0;
    }
    assert_true(found > 20);
    rg_free(of);
    rg_free(surface);
    for (int k = 0; k < 3; k++) {
        rg_mesh_free(part[k]);
    }
    rg_mesh_free(m);
}

static void check_hanging(void) {
    rg_mesh *m = chain(); /* with a fourth element that has a corner on the face 3 4 5 */
    for (int i = 0; i < 3; i++) {
        double on = (m->x[9 + i] + m->x[12 + i] + 2 * m->x[15 + i]) / 4;
        for (int k = 0; k < 4; k++) {
            m->x[18 + 3 * k + i] = on + (k > 0) * (i == 1 ? 3 : i == 2 ? 5 : 0) + (k == i + 1);
        }
    }
    memcpy(m->corner + 12, (const rg_gid[]){6, 7, 8, 9}, 4 * sizeof *m->corner);
    m->vertices = 10;
    m->elements = 4;
    rg_mesh_connect(m);
    rg_mesh_check(m, "chain");
}

static void test_hanging_is_told(void **state) {
    (void)state;
    expect_said(
        check_hanging, RG_USAGE,
        "rhegma: chain: a vertex of element 74 at (0.25, 4.625, 12.25) m lies on a face of element "
        "73 without "
        "being its corner (a hanging node): the mesh is open there; rhegma mesh joins nodes that coincide "
        "by --merge D, keeps parts apart by --apart, or takes faces that lie on each other for a crack by "
        "--crack NAME\n");
}

/* ---- parts ---- */

/* Against the least element that can be reached, found by passing it on until nothing changes. */
static void test_parts(void **state) {
    (void)state;
    static const int64_t cells[3] = {4, 3, 5};
    static const double origin[3] = {0, 0, 0}, size[3] = {4, 3, 5};
    rg_mesh *m = rg_mesh_box(cells, origin, size, 0, 1);
    dice d = {.seed = 2};
    for (rg_gid slot = 0; slot < 4 * m->elements; slot++) { /* cut at random */
        rg_gid other = m->neighbour[slot];
        if (other >= 0 && dice_unit(&d) < 0.35) {
            m->neighbour[4 * other + m->face[slot]] = -1;
            m->neighbour[slot] = -1;
        }
    }
    size_t count = (size_t)m->elements;
    rg_gid *least = RG_NEW(rg_gid, count);
    int32_t *part = RG_NEW(int32_t, count), *number = RG_NEW(int32_t, count), parts = 0;
    for (rg_gid e = 0; e < m->elements; e++) {
        least[e] = e;
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (rg_gid slot = 0; slot < 4 * m->elements; slot++) {
            if (m->neighbour[slot] >= 0 && least[m->neighbour[slot]] < least[slot / 4]) {
                least[slot / 4] = least[m->neighbour[slot]];
                changed = true;
            }
        }
    }
    int32_t found = rg_mesh_parts(m, part);
    for (rg_gid e = 0; e < m->elements; e++) {
        number[e] = least[e] == e ? parts++ : number[least[e]];
        assert_int_equal(part[e], number[e]);
    }
    assert_int_equal(found, parts);
    assert_true(parts > 10);
    rg_free(least);
    rg_free(part);
    rg_free(number);
    rg_mesh_free(m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_longest_edge),
        cmocka_unit_test(test_volume_bound),
        cmocka_unit_test(test_corner_order),
        cmocka_unit_test(test_changes),
        cmocka_unit_test(test_third_element_on_a_face),
        cmocka_unit_test(test_numbers_without_an_input),
        cmocka_unit_test(test_same_place),
        cmocka_unit_test(test_three_at_one_place),
        cmocka_unit_test(test_reach),
        cmocka_unit_test(test_hanging),
        cmocka_unit_test(test_hanging_is_told),
        cmocka_unit_test(test_parts),
    };
    int failed = cmocka_run_group_tests_name("mesh_check", tests, NULL, NULL);
    return failed + (rg_alloc_blocks() > 0); /* all is given back */
}
