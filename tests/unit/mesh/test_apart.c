/* Parts that are kept apart: which they are, where they touch, whether they overlap, and their file. */
#include <math.h>
#include <omp.h>
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
#include "base/mem.h"
#include "mesh/apart.h"
#include "mesh/check.h"
#include "mesh/file.h"
#include "support/dice.h"
#include "support/mesh_text.h"

/* A box of cells, moved. */
typedef struct {
    int64_t cells[3];
    double origin[3], size[3];
} box;

/* The boxes as one mesh, turned about a line so that nothing is aligned, in some order of the elements. */
static rg_mesh *make(const box *b, int boxes) {
    static const double turn[3][3] = {{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}};
    rg_mesh *m = RG_NEW(rg_mesh, 1);
    size_t vertices = 0, elements = 0;
    m->x = RG_NEW(double, 3000);
    m->corner = RG_NEW(rg_gid, 8000);
    for (int k = 0; k < boxes; k++) {
        rg_mesh *one = rg_mesh_box(b[k].cells, b[k].origin, b[k].size, 0, 1);
        for (size_t i = 0; i < 3 * (size_t)one->vertices; i++) {
            const double *x = one->x + i / 3 * 3, *row = turn[i % 3];
            m->x[3 * vertices + i] = row[0] * x[0] + row[1] * x[1] + row[2] * x[2];
        }
        for (size_t i = 0; i < 4 * (size_t)one->elements; i++) {
            m->corner[4 * elements + i] = one->corner[i] + (rg_gid)vertices;
        }
        vertices += (size_t)one->vertices;
        elements += (size_t)one->elements;
        rg_mesh_free(one);
    }
    m->vertices = (rg_gid)vertices;
    m->elements = (rg_gid)elements;
    m->neighbour = RG_NEW(rg_gid, 4 * elements);
    m->face = RG_NEW(int8_t, 4 * elements);
    m->set = RG_NEW(int32_t, 4 * elements);
    memset(m->set, -1, 4 * elements * sizeof *m->set);
    rg_mesh_sort(m);
    rg_mesh_connect(m);
    return m;
}

/* Two blocks side by side, one of which covers a part of the other. */
static const box side_by_side[] = {{{2, 3, 1}, {0, 0, 0}, {2, 3, 1}}, {{3, 2, 2}, {0.5, 1, 1}, {3, 1.5, 2}}};

/* ---- which ---- */

static void test_numbers(void **state) {
    (void)state;
    rg_mesh *m = make(side_by_side, 2);
    assert_int_equal(rg_mesh_apart(m), 0);
    assert_null(rg_mesh_vertex_parts(m));
    assert_int_equal(rg_mesh_keep_apart(m), 2);
    assert_int_equal(rg_mesh_apart(m), 2);
    assert_int_equal(m->part[0], 0);
    int32_t *of = rg_mesh_vertex_parts(m);
    for (rg_gid i = 0; i < 4 * m->elements; i++) { /* vertices of the first box have the lower numbers */
        bool second = m->corner[i] >= 3 * 4 * 2, swapped = m->corner[0] >= 3 * 4 * 2;
        assert_int_equal(m->part[i / 4], second != swapped);
        assert_int_equal(of[m->corner[i]], m->part[i / 4]);
    }
    rg_free(of);
    rg_mesh_free(m);
}

/* Two blocks that have one vertex in common are one part, though they share no face. */
static void test_a_shared_vertex(void **state) {
    (void)state;
    rg_mesh *m = make(side_by_side, 2);
    int32_t *part = RG_NEW(int32_t, (size_t)m->elements);
    for (rg_gid i = 0; i < 4 * m->elements; i++) {
        m->corner[i] = m->corner[i] == 3 * 4 * 2 ? 3 * 4 * 2 - 1 : m->corner[i];
    }
    assert_int_equal(rg_mesh_keep_apart(m), 1);
    assert_null(m->part);
    assert_int_equal(rg_mesh_parts(m, part), 2);
    rg_free(part);
    rg_mesh_free(m);
}

/* ---- touching ---- */

/* Blocks with a gap between them. */
static rg_touch *touches_across(double gap, double turned, size_t *count) {
    box b[2];
    memcpy(b, side_by_side, sizeof b);
    b[1].origin[2] += gap;
    rg_mesh *m = make(b, 2);
    for (rg_gid v = 3 * 4 * 2; v < m->vertices; v++) { /* not a turn, but the same to first order */
        m->x[3 * v] += turned * m->x[3 * v + 2];
    }
    rg_mesh_keep_apart(m);
    rg_touch *touch = rg_mesh_touches(m, count);
    rg_mesh_free(m);
    return touch;
}

/* The second block covers 1.5 x 1.5 of the first, of which each cell has two faces: the cells 0..1 and 1..2
 * by 1..2 and 2..3; and the 3 x 2 of the second but those beyond 2, which begin with the third. */
static void test_touching(void **state) {
    (void)state;
    size_t count;
    rg_touch *t = touches_across(0, 0, &count);
    assert_int_equal(count, 1);
    assert_true(fabs(t->area - 1.5 * 1.5) < 1e-12);
    assert_int_equal(t->part[0], 0);
    assert_int_equal(t->part[1], 1);
    assert_int_equal(t->faces[0] < t->faces[1] ? t->faces[0] : t->faces[1], 7);
    assert_int_equal(t->faces[0] + t->faces[1], 15);
    double middle[3] = {1.25, 1.75, 1}, square = 0;
    for (int c = 0; c < 3; c++) {
        square += t->place[c] * t->place[c] - middle[c] * middle[c];
    }
    assert_true(fabs(square) < 1e-12 && !(fabs(t->gap[0]) > 0) && !(fabs(t->gap[1]) > 0));
    rg_free(t);
    /* Within 1e-3 of the shorter of two longest edges: that of the second one's faces, sqrt(1 + 0.75^2). */
    t = touches_across(0.99e-3 * 1.25, 0, &count);
    assert_int_equal(count, 1);
    assert_true(fabs(t->gap[0] / (0.99e-3 * 1.25) - 1) < 1e-9 && fabs(t->gap[1] / t->gap[0] - 1) < 1e-9);
    rg_free(t);
    t = touches_across(1.01e-3 * 1.25, 0, &count);
    assert_int_equal(count, 0);
    rg_free(t);
}

/* Two blocks on one, whose faces both of them touch. */
static void test_faces_that_touch_twice(void **state) {
    (void)state;
    static const box on_one[] = {{{1, 1, 1}, {0, 0, 0}, {2, 2, 1}},
                                 {{1, 1, 1}, {0, 0.1, 1}, {1, 1.9, 1}},
                                 {{1, 1, 1}, {1, 0, 1}, {1, 1.8, 1}}};
    size_t count;
    int beside = 0;
    rg_mesh *m = make(on_one, 3);
    rg_mesh_keep_apart(m);
    rg_touch *t = rg_mesh_touches(m, &count);
    assert_int_equal(count, 3);
    for (size_t i = 0; i < count; i++) {
        bool aside = fabs(t[i].area - 1.7) < 1e-12; /* the two above, beside each other */
        assert_true(aside || fabs(t[i].area - 1.9) < 1e-12 || fabs(t[i].area - 1.8) < 1e-12);
        assert_int_equal(t[i].faces[0], 2);
        assert_int_equal(t[i].faces[1], 2);
        beside += aside;
    }
    assert_int_equal(beside, 1);
    rg_free(t);
    rg_mesh_free(m);
}

/* ---- overlaps ---- */

static double sunk;

static void check_sunk(void) {
    box b[2];
    memcpy(b, side_by_side, sizeof b);
    b[1].origin[2] -= sunk;
    rg_mesh *m = make(b, 2);
    rg_mesh_keep_apart(m);
    rg_mesh_check_overlaps(m, "blocks");
    rg_mesh_free(m);
}

/* Of all elements of both blocks: the smallest longest edge is that of the second's, (1, 0.75, 1). */
static void test_overlaps(void **state) {
    (void)state;
    char said[1000], words[80];
    double bound = 1e-3 * sqrt(2 + 0.75 * 0.75);
    sunk = 0.99 * bound;
    expect_said(check_sunk, 0, "");
    for (int k = 0; k < 3; k++) {
        sunk = k == 0 ? 1.01 * bound : 0.1 * k;
        assert_int_equal(run_child(check_sunk, said, sizeof said), RG_USAGE);
        snprintf(words, sizeof words, " by %.3g m, at (", sunk);
        assert_int_equal(strncmp(said, "rhegma: blocks: parts 1 and 2 lie in each other: elements ", 58), 0);
        assert_non_null(strstr(said, words));
        assert_ptr_equal(strchr(said, '\n'), said + strlen(said) - 1); /* one line for the pair of parts */
    }
}

static box random_box[2];

static void check_random(void) {
    rg_mesh *m = make(random_box, 2);
    rg_mesh_keep_apart(m);
    rg_mesh_check_overlaps(m, "boxes");
    rg_mesh_free(m);
}

/* Boxes at random, against the shape that two of them share. */
static void test_random_boxes(void **state) {
    (void)state;
    dice d = {.seed = 7};
    int found = 0, touching = 0;
    box *b = random_box;
    for (int trial = 0; trial < 60; trial++) {
        char said[1000];
        double shared = 1;
        for (int k = 0; k < 2; k++) {
            for (int c = 0; c < 3; c++) {
                b[k].cells[c] = 1 + (int64_t)(2.99 * dice_unit(&d));
                b[k].size[c] = 0.5 + dice_unit(&d);
                b[k].origin[c] = k == 0 ? 0 : 1.6 * dice_unit(&d) - 0.8;
            }
        }
        bool on_top = trial % 2 == 0; /* then they touch or are beside each other */
        b[1].origin[2] = on_top ? b[0].size[2] : b[1].origin[2];
        for (int c = 0; c < 3; c++) {
            double low = fmax(b[0].origin[c], b[1].origin[c]),
                   high = fmin(b[0].origin[c] + b[0].size[c], b[1].origin[c] + b[1].size[c]);
            shared = on_top && c == 2 ? shared : low < high && shared > 0 ? shared * (high - low) : 0;
        }
        size_t count;
        rg_mesh *m = make(b, 2);
        rg_mesh_keep_apart(m);
        rg_touch *t = rg_mesh_touches(m, &count);
        if (on_top) {
            assert_int_equal(count, shared > 0);
            assert_true(count == 0 || fabs(t->area - shared) < 1e-12);
            touching += count > 0;
        }
        bool overlap = !on_top && shared > 0;
        found += overlap;
        assert_int_equal(run_child(check_random, said, sizeof said), overlap ? RG_USAGE : 0);
        rg_free(t);
        rg_mesh_free(m);
    }
    assert_true(found > 5 && touching > 5);
}

/* ---- many ---- */

/* Eight blocks around a point, whose common sides have the same cells; each side of a block is beside two or
 * none of the others. The upper ones hang `gap` above the lower ones. */
enum { AROUND = 8 };
static const int64_t around_cells[3][2] = {{2, 1}, {1, 3}, {2, 2}};
static const double around_size[3][2] = {{1.1, 0.7}, {0.8, 1.3}, {1.2, 0.9}};

static void set_around(double gap, box b[AROUND]) {
    for (int k = 0; k < AROUND; k++) {
        for (int c = 0; c < 3; c++) {
            int side = k >> c & 1;
            b[k].cells[c] = around_cells[c][side];
            b[k].size[c] = around_size[c][side];
            b[k].origin[c] = side == 0 ? -around_size[c][0] : c == 2 ? gap : 0;
        }
    }
}

/* Block of each part, by where its first element is. */
static void blocks_of(const rg_mesh *m, int block[AROUND]) {
    rg_gid begin[AROUND + 1] = {0};
    for (int k = 0; k < AROUND; k++) {
        rg_gid vertices = 1;
        for (int c = 0; c < 3; c++) {
            vertices *= around_cells[c][k >> c & 1] + 1;
        }
        begin[k + 1] = begin[k] + vertices;
    }
    for (rg_gid e = 0; e < m->elements; e++) {
        for (int k = 0; k < AROUND; k++) {
            if (m->corner[4 * e] >= begin[k] && m->corner[4 * e] < begin[k + 1]) {
                block[m->part[e]] = k;
            }
        }
    }
}

/* The one axis along which two blocks are beside each other, and share a side; -1: there is none. */
static int axis_between(int a, int b) {
    return (a ^ b) == 1 ? 0 : (a ^ b) == 2 ? 1 : (a ^ b) == 4 ? 2 : -1;
}

static void test_many_touch(void **state) {
    (void)state;
    static const double turn[3][3] = {{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}}; /* as in make */
    const double gap = 3e-4;
    box b[AROUND];
    size_t count, i = 0;
    int block[AROUND];
    set_around(gap, b);
    rg_mesh *m = make(b, AROUND);
    assert_int_equal(rg_mesh_keep_apart(m), AROUND);
    blocks_of(m, block);
    rg_touch *t = rg_mesh_touches(m, &count);
    assert_int_equal(count, 12);
    for (int k = 0; k < AROUND * AROUND; k++) {
        int p = k / AROUND, q = k % AROUND, axis = axis_between(block[p], block[q]);
        if (p >= q || axis < 0) {
            continue;
        }
        double area = 1, middle[3] = {0}, wanted = axis == 2 ? gap : 0;
        int64_t faces = 2;
        for (int c = 0; c < 3; c++) {
            int side = block[p] >> c & 1;
            if (c != axis) {
                area *= around_size[c][side];
                faces *= around_cells[c][side];
                middle[c] = b[block[p]].origin[c] + 0.5 * around_size[c][side];
            } else if (c == 2 && side == 1) {
                middle[c] = gap; /* on the face of the lower number */
            }
        }
        assert_int_equal(t[i].part[0], p);
        assert_int_equal(t[i].part[1], q);
        assert_int_equal(t[i].faces[0], faces);
        assert_int_equal(t[i].faces[1], faces);
        assert_true(fabs(t[i].area - area) < 1e-12);
        assert_true(fabs(t[i].gap[0] - wanted) < 1e-12 && fabs(t[i].gap[1] - wanted) < 1e-12);
        for (int c = 0; c < 3; c++) {
            double at = turn[c][0] * middle[0] + turn[c][1] * middle[1] + turn[c][2] * middle[2];
            assert_true(fabs(t[i].place[c] - at) < 1e-12);
        }
        i++;
    }
    rg_free(t);
    rg_mesh_free(m);
}

/* The blocks, larger than there is room for, with every vertex moved a little. */
static rg_mesh *make_crowd(void) {
    box b[AROUND];
    dice d = {.seed = 11};
    set_around(0, b);
    for (int k = 0; k < AROUND; k++) {
        for (int c = 0; c < 3; c++) {
            double more = 0.05 + 0.1 * dice_unit(&d);
            b[k].origin[c] -= (k >> c & 1) == 1 ? more : 0;
        }
    }
    rg_mesh *m = make(b, AROUND);
    for (rg_gid i = 0; i < 3 * m->vertices; i++) {
        m->x[i] += 0.02 * dice_sign(&d);
    }
    rg_mesh_keep_apart(m);
    return m;
}

static void check_crowd(void) {
    rg_mesh *m = make_crowd();
    rg_mesh_check_overlaps(m, "crowd");
    rg_mesh_free(m);
}

static void minus(const double *a, const double *b, double out[3]) {
    for (int c = 0; c < 3; c++) {
        out[c] = a[c] - b[c];
    }
}

/* The shortest way by which element i leaves j: along all normals of planes through an edge of one that are
 * parallel to an edge of any of the two. */
static double way_out(const rg_mesh *m, rg_gid i, rg_gid j) {
    static const int end[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
    double edge[12][3], way = INFINITY;
    for (int k = 0; k < 12; k++) {
        const rg_gid *corner = m->corner + 4 * (k < 6 ? i : j);
        minus(m->x + 3 * corner[end[k % 6][1]], m->x + 3 * corner[end[k % 6][0]], edge[k]);
    }
    for (int k = 0; k < 144; k++) {
        const double *a = edge[k / 12], *b = edge[k % 12];
        double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
        double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), most[2] = {-INFINITY, -INFINITY},
               least[2] = {INFINITY, INFINITY};
        for (int v = 0; v < 8 && k / 12 < k % 12; v++) {
            const double *x = m->x + 3 * m->corner[4 * (v < 4 ? i : j) + v % 4];
            double at = (n[0] * x[0] + n[1] * x[1] + n[2] * x[2]) / length;
            most[v / 4] = fmax(most[v / 4], at);
            least[v / 4] = fmin(least[v / 4], at);
        }
        if (k / 12 < k % 12 && length > 1e-6) {
            way = fmin(way, fmin(most[0] - least[1], most[1] - least[0]));
        }
    }
    return way;
}

/* Each two of eight parts lie in each other: the deepest of all pairs of elements is told, those of the
 * lowest numbers where several are as deep, in the order of the parts, ten of them. */
static void test_many_overlap(void **state) {
    (void)state;
    static char said[1 << 14], words[1 << 14];
    rg_mesh *m = make_crowd();
    size_t length = 0;
    int told = 0;
    assert_int_equal(rg_mesh_apart(m), AROUND);
    for (int k = 0; k < AROUND * AROUND; k++) {
        rg_gid deepest[2] = {-1, -1};
        double depth = 1e-3;
        for (rg_gid i = 0; i < m->elements; i++) {
            for (rg_gid j = 0; j < m->elements && m->part[i] == k / AROUND; j++) {
                double way = m->part[j] == k % AROUND && k / AROUND < k % AROUND ? way_out(m, i, j) : 0;
                if (way > depth * (1 + 1e-9)) {
                    depth = way;
                    deepest[0] = i;
                    deepest[1] = j;
                }
            }
        }
        if (deepest[0] >= 0 && told++ < 10) {
            const double *x = m->x + 3 * m->corner[4 * deepest[0]];
            length += (size_t)snprintf(words + length, sizeof words - length,
                                       "rhegma: crowd: parts %d and %d lie in each other: elements %" PRId64
                                       " and %" PRId64 " by %.3g m, at (%.9g, %.9g, %.9g) m\n",
                                       k / AROUND + 1, k % AROUND + 1, rg_mesh_original(m, deepest[0]),
                                       rg_mesh_original(m, deepest[1]), depth, x[0], x[1], x[2]);
        }
    }
    snprintf(words + length, sizeof words - length, "rhegma: crowd: and %d more\n", told - 10);
    rg_mesh_free(m);
    assert_true(told > 20);
    assert_int_equal(run_child(check_crowd, said, sizeof said), RG_USAGE);
    assert_string_equal(said, words);
}

/* ---- checks and file ---- */

static bool spoilt;

static void check_blocks(void) {
    rg_mesh *m = make(side_by_side, 2);
    rg_mesh_keep_apart(m);
    m->part[m->elements - 1] ^= spoilt;
    rg_mesh_check(m, "blocks");
    rg_mesh_free(m);
}

static void test_neighbours_are_of_one_part(void **state) {
    (void)state;
    char said[4000];
    expect_said(check_blocks, 0, "");
    spoilt = true;
    assert_int_equal(run_child(check_blocks, said, sizeof said), RG_USAGE);
    assert_non_null(strstr(said, "rhegma: blocks: part: elements "));
    assert_non_null(strstr(said, " are neighbours, but in parts that are kept apart\n"));
}

static char path[] = "/tmp/test_apart.XXXXXX";

static void read_file(void) {
    rg_mesh_free(rg_mesh_file_read(path));
}

static void test_file(void **state) {
    (void)state;
    char said[1000], words[200];
    close(mkstemp(path));
    rg_mesh *m = make(side_by_side, 2);
    rg_mesh_keep_apart(m);
    rg_mesh_file_write(path, m, 0, NULL);
    rg_mesh *back = rg_mesh_file_read(path);
    assert_memory_equal(back->part, m->part, (size_t)m->elements * sizeof *m->part);
    rg_mesh_free(back);
    m->part[5] = -1;
    rg_mesh_file_write(path, m, 0, NULL);
    assert_int_equal(run_child(read_file, said, sizeof said), RG_USAGE);
    snprintf(words, sizeof words, "rhegma: %s: part: value -1 of element %d is not between 0 and 1\n", path,
             (int)m->original[5]);
    assert_string_equal(said, words);
    rg_free(m->part);
    m->part = NULL;
    rg_mesh_file_write(path, m, 0, NULL); /* an older program reads it, but for what touches */
    assert_int_equal(run_child(read_file, said, sizeof said), RG_USAGE);
    assert_non_null(strstr(said, rg_mesh_open_words(false)));
    rg_mesh_free(m);
    unlink(path);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_numbers),
        cmocka_unit_test(test_a_shared_vertex),
        cmocka_unit_test(test_touching),
        cmocka_unit_test(test_overlaps),
        cmocka_unit_test(test_many_touch),
        cmocka_unit_test(test_faces_that_touch_twice),
        cmocka_unit_test(test_many_overlap),
        cmocka_unit_test(test_random_boxes),
        cmocka_unit_test(test_neighbours_are_of_one_part),
        cmocka_unit_test(test_file),
    };
    omp_set_num_threads(1); /* a child has none of its parent's threads */
    int failed = cmocka_run_group_tests_name("apart", tests, NULL, NULL);
    return failed + (rg_alloc_blocks() > 0); /* all is given back */
}
