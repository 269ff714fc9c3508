/* Hexahedra, wedges and pyramids as tetrahedra: all numberings of a mesh of all shapes fill it, and fit
 * together. */
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

#include "base/tet.h"
#include "mesh/import/solid.h"
#include "support/inp_text.h"

/* Abaqus's own corners: the unit cube; half of it; a pyramid on it. */
static const double cube[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                  {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
static const double wedge[6][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
static const double pyramid[5][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}};
static const double tet[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

static const struct {
    int corners, faces;
    const double (*x)[3];
    double volume, area[6]; /* of S1, S2, ... */
} shapes[] = {{8, 6, cube, 1, {1, 1, 1, 1, 1, 1}},
              {6, 5, wedge, 0.5, {0.5, 0.5, 1, 1.4142135623730951, 1, 0}},
              {5,
               5,
               pyramid,
               1.0 / 3,
               {1, 0.55901699437494745, 0.55901699437494745, 0.55901699437494745, 0.55901699437494745, 0}},
              {4, 4, tet, 1.0 / 6, {0.5, 0.5, 0.8660254037844386, 0.5, 0, 0}}};

static void normal_of(const double *a, const double *b, const double *c, double n[3]) {
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        n[i] = 0.5 * ((b[j] - a[j]) * (c[k] - a[k]) - (b[k] - a[k]) * (c[j] - a[j]));
    }
}

static size_t sorted(const size_t v[3]) {
    size_t low = 99, high = 0;
    for (int i = 0; i < 3; i++) {
        low = v[i] < low ? v[i] : low;
        high = v[i] > high ? v[i] : high;
    }
    return low + 100 * (v[0] + v[1] + v[2] - low - high) + 10000 * high;
}

/* Some of the 40,320 numberings: place[corner] is its number. */
static void number(int corners, unsigned seed, size_t node[8], int corner_of[9]) {
    for (int i = 0; i < corners; i++) {
        node[i] = (size_t)i + 1;
    }
    for (int i = corners - 1; i > 0; i--) {
        int k = (int)(seed % (unsigned)(i + 1));
        size_t swap = node[i];
        seed = seed * 1664525U / 7 + 12345U;
        node[i] = node[k];
        node[k] = swap;
    }
    for (int i = 0; i < corners; i++) {
        corner_of[node[i]] = i;
    }
}

static void test_split(void **state) {
    (void)state;
    for (size_t s = 0; s < sizeof shapes / sizeof *shapes; s++) {
        for (unsigned seed = 0; seed < 500; seed++) {
            size_t node[8], tets[RG_SOLID_TETS][4], triangle[2][3], outer[12];
            int corner_of[9], outers = 0, sides = 0;
            number(shapes[s].corners, seed * 2654435761U, node, corner_of);
            int count = rg_solid_split(shapes[s].corners, node, tets);
            double volume = 0;
            for (int t = 0; t < count; t++) {
                const double *x[4];
                for (int i = 0; i < 4; i++) {
                    x[i] = shapes[s].x[corner_of[tets[t][i]]];
                }
                double v = rg_tet_volume(x[0], x[1], x[2], x[3]);
                assert_true(v > 0.01); /* the right way round */
                volume += v;
            }
            assert_true(fabs(volume - shapes[s].volume) < 1e-15);
            for (int f = 0; f < RG_SOLID_FACES; f++) {
                int triangles = rg_solid_face(shapes[s].corners, f, node, triangle);
                double sum[3] = {0, 0, 0};
                for (int t = 0; t < triangles; t++) {
                    double n[3];
                    normal_of(shapes[s].x[corner_of[triangle[t][0]]], shapes[s].x[corner_of[triangle[t][1]]],
                              shapes[s].x[corner_of[triangle[t][2]]], n);
                    for (int i = 0; i < 3; i++) {
                        sum[i] += n[i];
                    }
                    outer[outers++] = sorted(triangle[t]);
                }
                assert_int_equal(triangles > 0, f < shapes[s].faces);
                assert_true(fabs(sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]) -
                                 shapes[s].area[f]) < 1e-15);
                /* cut from the corner of the lowest number */
                assert_true(triangles < 2 ||
                            (triangle[0][0] == triangle[1][0] && triangle[0][0] < triangle[0][1] &&
                             triangle[0][0] < triangle[0][2] && triangle[0][0] < triangle[1][2]));
            }
            /* the sides of the tetrahedra are these, and others twice */
            for (int a = 0; a < 4 * count; a++) {
                size_t side[3];
                int same = 0, outside = 0;
                for (int i = 0, k = 0; i < 4; i++) {
                    if (i != a % 4) {
                        side[k++] = tets[a / 4][i];
                    }
                }
                for (int i = 0; i < outers; i++) {
                    outside += outer[i] == sorted(side);
                }
                for (int b = 0; b < 4 * count; b++) {
                    size_t other[3];
                    for (int i = 0, k = 0; i < 4; i++) {
                        if (i != b % 4) {
                            other[k++] = tets[b / 4][i];
                        }
                    }
                    same += sorted(other) == sorted(side);
                }
                assert_int_equal(same + outside, 2);
                sides += outside;
            }
            assert_int_equal(sides, outers);
        }
    }
}

/* Corners that are the same: a wedge in the guise of a hexahedron, and one without volume. */
static void test_collapsed(void **state) {
    (void)state;
    size_t tets[RG_SOLID_TETS][4], triangle[2][3];
    assert_int_equal(rg_solid_split(8, (const size_t[]){1, 2, 3, 3, 4, 5, 6, 6}, tets), 3);
    assert_int_equal(rg_solid_face(8, 0, (const size_t[]){1, 2, 3, 3, 4, 5, 6, 6}, triangle), 1);
    assert_int_equal(rg_solid_face(8, 4, (const size_t[]){1, 2, 3, 3, 4, 5, 6, 6}, triangle), 0);
    assert_int_equal(rg_solid_split(8, (const size_t[]){1, 1, 1, 1, 1, 1, 1, 1}, tets), 0);
}

#define BLOCK                                                                                                \
    "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 1, 1, 0\n4, 0, 1, 0\n5, 0, 0, 1\n6, 1, 0, 1\n7, 1, 1, 1\n8, 0, 1, "   \
    "1\n"

/* From the file: elements in sets, surfaces, and other shapes beside them. */
static void test_input(void **state) {
    (void)state;
    const char *words =
        BLOCK "9, 0.5, 0.5, 2\n10, 2, 0, 0\n11, 2, 0, 1\n12, 0.5, 0.5, -1\n*ELEMENT, TYPE=C3D8R, ELSET=h\n1, "
              "1, 2, 3, 4, 5,\n6, 7, 8\n"
              "*ELEMENT, TYPE=C3D5, ELSET=p\n2, 5, 6, 7, 8, 9\n*ELEMENT, TYPE=C3D6\n3, 2, 10, 3, 6, 11, 7\n"
              "*SURFACE, NAME=s\n1, S6\np, S2\n3, S5\n*SURFACE, NAME=free\nh,\n";
    expect_refused(BLOCK "*ELEMENT, TYPE=C3D8\n1, 1, 2, 3, 4, 5, 6, 7, 8\n",
                   ":10: *ELEMENT, TYPE=C3D8: only tetrahedra are possible (C3D4, C3D10 and their kin), but "
                   "there are other "
                   "solids: 1 C3D8; --split cuts hexahedra, wedges and pyramids");
    split = true;
    expect(words, WARNING
           ": 1 nodes belong to no tetrahedron and are left out; the first is node 12 at (0.5, 0.5, -1) "
           "m\n" WARNING ": 2 faces of surface sets lie between elements: interface.sets may name them, "
           "boundary leaves them out\n"
           "x 0: 0 0 0\nx 1: 1 0 0\nx 2: 1 1 0\nx 3: 0 1 0\nx 4: 0 0 1\nx 5: 1 0 1\nx 6: 1 1 1\nx 7: 0 1 1\n"
           "x 8: 0.5 0.5 2\nx 9: 2 0 0\nx 10: 2 0 1\n"
           "e 1: 0 4 6 7 in h, s and free at 2\ne 1: 0 4 5 6 in h, free at 3\ne 1: 0 1 5 6 in h, s at 0, "
           "free at 3\n"
           "e 1: 0 1 2 6 in h, s at 0, free at 3\ne 1: 0 2 6 7 in h, free at 0\n"
           "e 1: 0 2 3 7 in h, free at 0, s and free at 1, free at 3\n"
           "e 2: 4 5 6 8 in p, s at 2\ne 2: 4 6 7 8 in p\n"
           "e 3: 1 5 6 10, s at 3\ne 3: 1 2 9 10\ne 3: 1 2 6 10, s at 3\ninner 1 2 6\ninner 1 5 6\n");
    split = false;
}

/* Types that can be split, with so many nodes; those of a variable number, and others, are refused as before.
 */
static void test_types(void **state) {
    (void)state;
    static const struct {
        const char *name;
        int nodes, tets; /* 0: refused */
    } types[] = {{"C3D8", 8, 6},    {"c3d8i", 8, 6},   {"C3D20R", 20, 6}, {"DC3D8", 8, 6},
                 {"AC3D20", 20, 6}, {"C3D6", 6, 3},    {"C3D15", 15, 3},  {"C3D5", 5, 2},
                 {"C3D13", 13, 2},  {"C3D15V", 18, 0}, {"C3D27", 27, 0},  {"SC8R", 8, 0},
                 {"COH3D8", 8, 0},  {"DCC3D8", 8, 0},  {"C3D80", 8, 0},   {"F3D8", 8, 0}};
    split = true;
    for (size_t i = 0; i < sizeof types / sizeof *types; i++) {
        char words[2000] = BLOCK, said[4000];
        const int wedge_at[6] = {1, 2, 4, 5, 6, 8};
        for (int n = 9; n < 30; n++) {
            sprintf(words + strlen(words), "%d, 9, 9, %d\n", n, n);
        }
        sprintf(words + strlen(words), "*ELEMENT, TYPE=%s, ELSET=e\n1", types[i].name);
        for (int n = 0; n < types[i].nodes; n++) {
            int at = types[i].tets == 3 && n < 6 ? wedge_at[n] : n + 1;
            sprintf(words + strlen(words), n == 12 ? ",\n%d" : ", %d", at);
        }
        strcat(words, "\n");
        write_input(words);
        int status = run_child(read_and_print, said, sizeof said), found = 0;
        assert_int_equal(status, types[i].tets > 0 ? RG_OK : RG_USAGE);
        for (const char *at = strstr(said, "e 1: "); at != NULL; at = strstr(at + 1, "e 1: ")) {
            found++;
        }
        assert_int_equal(found, types[i].tets);
    }
    split = false;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_split),
        cmocka_unit_test(test_collapsed),
        cmocka_unit_test(test_input),
        cmocka_unit_test(test_types),
    };
    return cmocka_run_group_tests_name("inp_split", tests, set_up, tear_down);
}
