/* Improvement of flat elements: what must grow grows, what must stay stays. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "../kernels/layout.h"
#include "../src/improve.h"
#include "../src/improve_flip.h"
#include "../src/improve_move.h"
#include "../src/mem.h"
#include "../src/mesh_check.h"
#include "../src/tet.h"

static const int64_t cells[3] = {6, 5, 8};
static const double origin[3] = {0.1, -0.2, 0.3}, size[3] = {0.6, 0.5, 0.8};

static void assert_close(double a, double b, double tolerance) {
    assert_true(fabs(a - b) <= tolerance);
}

static rg_mesh *jittered(void) {
    return rg_mesh_box(cells, origin, size, 0.22, 3);
}

static rg_improvement improve(rg_mesh *m) {
    rg_improvement done = rg_mesh_improve(m);
    rg_mesh_sort(m);
    rg_mesh_connect(m);
    rg_mesh_check(m, "improved");
    return done;
}

static const double *face_vertex(const rg_mesh *m, rg_gid slot, int i) {
    return m->x + 3 * m->corner[slot / 4 * 4 + rg_face_node[slot % 4][i]];
}

static double face_area(const rg_mesh *m, rg_gid slot) {
    const double *a = face_vertex(m, slot, 0), *b = face_vertex(m, slot, 1), *c = face_vertex(m, slot, 2);
    double square = 0;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        double n = (b[j] - a[j]) * (c[k] - a[k]) - (b[k] - a[k]) * (c[j] - a[j]);
        square += n * n / 4;
    }
    return sqrt(square);
}

static double total_volume(const rg_mesh *m, int region) {
    double sum = 0;
    for (rg_gid e = 0; e < m->elements; e++) {
        const rg_gid *c = m->corner + 4 * e;
        double v = rg_tet_volume(m->x + 3 * c[0], m->x + 3 * c[1], m->x + 3 * c[2], m->x + 3 * c[3]);
        sum += m->region == NULL || m->region[e] == region ? fabs(v) : 0;
    }
    return sum;
}

/* Smallest height, computed apart: 3 V over the largest face. */
static double smallest_height(const rg_mesh *m) {
    double least = INFINITY;
    for (rg_gid e = 0; e < m->elements; e++) {
        const rg_gid *c = m->corner + 4 * e;
        double v = rg_tet_volume(m->x + 3 * c[0], m->x + 3 * c[1], m->x + 3 * c[2], m->x + 3 * c[3]);
        for (int f = 0; f < 4; f++) {
            least = fmin(least, 3 * fabs(v) / face_area(m, 4 * e + f));
        }
    }
    return least;
}

static void test_flat_elements_grow(void **state) {
    (void)state;
    rg_mesh *m = jittered();
    double before = smallest_height(m);
    rg_improvement done = improve(m);
    assert_close(done.before, before, 1e-12 * before);
    assert_close(done.after, smallest_height(m), 1e-12 * before);
    assert_true(done.after > 1.8 * before);
    assert_true(done.moves > 0 && done.edges > 0);
    rg_mesh_free(m);
}

/* The sides of the box stay where they are, to the bit, with all their area and their sets. */
static void test_box_keeps_its_shape(void **state) {
    (void)state;
    rg_mesh *m = jittered();
    improve(m);
    assert_close(total_volume(m, 0), 0.6 * 0.5 * 0.8, 1e-12);
    double area[6] = {0};
    for (rg_gid slot = 0; slot < 4 * m->elements; slot++) {
        int side = m->set[slot];
        assert_int_equal(side >= 0, m->neighbour[slot] < 0);
        for (int i = 0; side >= 0 && i < 3; i++) {
            double there = origin[side / 2] + (side % 2 == 1 ? size[side / 2] : 0);
            assert_true(face_vertex(m, slot, i)[side / 2] - there == 0);
        }
        area[side >= 0 ? side : 0] += side >= 0 ? face_area(m, slot) : 0;
    }
    for (int side = 0; side < 6; side++) {
        assert_close(area[side], 0.6 * 0.5 * 0.8 / size[side / 2], 1e-12);
    }
    rg_mesh_free(m);
}

static bool in_middle(const rg_mesh *m, rg_gid slot) {
    bool all = true;
    for (int i = 0; i < 3; i++) {
        all = all && fabs(face_vertex(m, slot, i)[2] - 0.7) < 1e-12;
    }
    return all;
}

/* A box whose vertices between the 4th and the 5th layer of cubes lie in the plane z = 0.7. */
static rg_mesh *layered(void) {
    rg_mesh *m = jittered();
    for (rg_gid v = 0; v < m->vertices; v++) {
        if (v / (7 * 6) == 4) {
            m->x[3 * v + 2] = 0.7;
        }
    }
    return m;
}

static double middle_area(const rg_mesh *m) {
    double area = 0;
    for (rg_gid slot = 0; slot < 4 * m->elements; slot++) {
        area += in_middle(m, slot) ? face_area(m, slot) / 2 : 0;
    }
    return area;
}

static void test_volume_sets_stay(void **state) {
    (void)state;
    rg_mesh *m = layered();
    m->region = RG_NEW(int8_t, (size_t)m->elements);
    for (rg_gid e = 0; e < m->elements; e++) {
        double z = 0;
        for (int i = 0; i < 4; i++) {
            z += m->x[3 * m->corner[4 * e + i] + 2] / 4;
        }
        m->region[e] = z > 0.7;
    }
    assert_true(improve(m).edges > 0);
    assert_close(middle_area(m), 0.3, 1e-12);
    assert_close(total_volume(m, 0), 0.12, 1e-12);
    assert_close(total_volume(m, 1), 0.12, 1e-12);
    for (rg_gid slot = 0; slot < 4 * m->elements; slot++) {
        rg_gid other = m->neighbour[slot];
        assert_int_equal(other >= 0 && m->region[other] != m->region[slot / 4], in_middle(m, slot));
    }
    rg_mesh_free(m);
}

/* Faces that the input names stay; where it does not, the plane does not survive. */
static void test_inner_faces_stay(void **state) {
    (void)state;
    for (int named = 0; named < 2; named++) {
        rg_mesh *m = layered();
        m->inner = RG_NEW(rg_gid, (size_t)(12 * m->elements));
        for (rg_gid slot = 0; named == 1 && slot < 4 * m->elements; slot++) {
            for (int i = 0; i < 3 && in_middle(m, slot); i++) {
                m->inner[3 * m->inners + (size_t)i] = m->corner[slot / 4 * 4 + rg_face_node[slot % 4][i]];
            }
            m->inners += in_middle(m, slot);
        }
        improve(m);
        if (named == 1) {
            assert_close(middle_area(m), 0.3, 1e-12);
        } else {
            assert_true(middle_area(m) < 0.2);
        }
        rg_mesh_free(m);
    }
}

static void test_same_every_time(void **state) {
    (void)state;
    rg_mesh *a = jittered(), *b = jittered();
    improve(a);
    improve(b);
    assert_int_equal(a->elements, b->elements);
    assert_memory_equal(a->x, b->x, 3 * (size_t)a->vertices * sizeof *a->x);
    assert_memory_equal(a->corner, b->corner, 4 * (size_t)a->elements * sizeof *a->corner);
    rg_mesh_free(a);
    rg_mesh_free(b);
}

/* ---- single changes ---- */

static rg_mesh *small(rg_gid vertices, const double *x, rg_gid elements, const rg_gid *corner) {
    rg_mesh *m = RG_NEW(rg_mesh, 1);
    size_t slots = 4 * (size_t)elements;
    m->vertices = vertices;
    m->elements = elements;
    m->x = RG_NEW(double, 3 * (size_t)vertices);
    m->corner = RG_NEW(rg_gid, slots);
    m->neighbour = RG_NEW(rg_gid, slots);
    m->face = RG_NEW(int8_t, slots);
    m->set = RG_NEW(int8_t, slots);
    memcpy(m->x, x, 3 * (size_t)vertices * sizeof *x);
    memcpy(m->corner, corner, slots * sizeof *corner);
    memset(m->set, -1, slots);
    rg_mesh_connect(m);
    return m;
}

/* The eight tetrahedra of a regular octahedron around a vertex inside: all heights are equal and largest,
 * 1/sqrt(3), where it is at the centre. */
static void test_vertex_goes_to_the_best_place(void **state) {
    (void)state;
    static const double x[21] = {1, 0, 0, 0, 1, 0, 0, 0, 1, -1, 0, 0, 0, -1, 0, 0, 0, -1, 0.3, 0.2, -0.25};
    rg_gid corner[32];
    for (int o = 0; o < 8; o++) {
        rg_gid c[3] = {o & 1 ? 3 : 0, o & 2 ? 4 : 1, o & 4 ? 5 : 2};
        int place = 0;
        for (rg_gid v = 0; v < 6; v++) {
            if (v == c[0] || v == c[1] || v == c[2]) {
                corner[4 * o + place++] = v;
            }
        }
        corner[4 * o + 3] = 6;
    }
    rg_mesh *m = small(7, x, 8, corner);
    rg_tets t = rg_tets_make(m);
    assert_true(rg_tets_move(&t, 6));
    assert_true(rg_tets_star_height(&t, 6) > 0.97 / sqrt(3));
    assert_false(rg_tets_move(&t, 0)); /* a corner of the surface */
    rg_tets_finish(&t);
    rg_mesh_free(m);
}

/* Three tetrahedra around a long edge become two across it, two flat ones become three around their short
 * line. */
static void test_edge_and_face_are_replaced(void **state) {
    (void)state;
    static const rg_gid three[12] = {0, 1, 2, 3, 0, 1, 3, 4, 0, 1, 2, 4}, two[8] = {0, 2, 3, 4, 1, 2, 3, 4};
    static const double aside[3][2] = {{1, 0}, {-0.5, 0.8}, {-0.5, -0.9}};
    for (int flat = 0; flat < 2; flat++) {
        double x[15] = {0, 0, 0, 0, 0, 1};
        for (int i = 0; i < 3; i++) {
            x[6 + 3 * i] = (flat ? 3 : 0.3) * aside[i][0];
            x[7 + 3 * i] = (flat ? 3 : 0.3) * aside[i][1];
            x[8 + 3 * i] = 0.5;
        }
        rg_mesh *m = flat ? small(5, x, 2, two) : small(5, x, 3, three);
        double before = smallest_height(m), volume = total_volume(m, 0);
        rg_tets t = rg_tets_make(m);
        assert_false(rg_tets_remove_edge(&t, 2, 3)); /* on the surface, which is bent there */
        if (flat) {
            assert_true(rg_tets_remove_face(&t, 0, rg_tets_find(t.tet, 0)));
        } else {
            assert_true(rg_tets_remove_edge(&t, 0, 1));
        }
        rg_tets_finish(&t);
        assert_int_equal(m->elements, flat ? 3 : 2);
        rg_mesh_connect(m);
        rg_mesh_check(m, "replaced");
        assert_close(total_volume(m, 0), volume, 1e-14);
        assert_true(smallest_height(m) > before);
        rg_mesh_free(m);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_flat_elements_grow),
        cmocka_unit_test(test_box_keeps_its_shape),
        cmocka_unit_test(test_volume_sets_stay),
        cmocka_unit_test(test_inner_faces_stay),
        cmocka_unit_test(test_same_every_time),
        cmocka_unit_test(test_vertex_goes_to_the_best_place),
        cmocka_unit_test(test_edge_and_face_are_replaced),
    };
    return cmocka_run_group_tests_name("improve", tests, NULL, NULL);
}
