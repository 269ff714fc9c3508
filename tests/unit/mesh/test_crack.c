/* Cracks of no width: a box that was split along faces inside, and taken together again. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/mem.h"
#include "layout.h"
#include "mesh/import/crack.h"
#include "mesh/file.h"

static rg_mesh *make(void) {
    static const int64_t cells[3] = {4, 3, 4};
    static const double origin[3] = {-2, 0, -2}, size[3] = {4, 3, 4};
    return rg_mesh_box(cells, origin, size, 0, 1);
}

/* Sorts the corners of an element, and with each the set of the face opposite to it. */
static void sort_corners(rg_mesh *m, rg_gid e) {
    for (int n = 0; n < 16; n++) {
        rg_gid *c = m->corner + 4 * e + n % 3, high = c[1];
        int32_t *s = m->set + 4 * e + n % 3, set = s[1];
        if (c[0] > c[1]) {
            c[1] = c[0];
            c[0] = high;
            s[1] = s[0];
            s[0] = set;
        }
    }
}

/* Faces of the plane z = 0 with x < 0 get vertices of their own above; those below are in set x-, those above
 * in sets x+ and y+. The vertices at x = 0 hold both halves together. */
static rg_gid split(rg_mesh *m, rg_gid *opened) {
    rg_gid old = m->vertices, faces = 0;
    int32_t high = rg_sets_combine(&m->surface, 2, (const int32_t[]){1, 3});
    double *x_all = RG_NEW(double, 6 * (size_t)old);
    memcpy(x_all, m->x, 3 * (size_t)old * sizeof *x_all);
    rg_free(m->x);
    m->x = x_all;
    for (rg_gid slot = 0; slot < 4 * m->elements; slot++) {
        bool on = m->neighbour[slot] >= 0, left = true;
        for (int k = 0; k < 3; k++) {
            const double *x = m->x + 3 * m->corner[slot / 4 * 4 + rg_face_node[slot % 4][k]];
            on = on && !(fabs(x[2]) > 0);
            left = left && x[0] <= 0;
        }
        opened[slot] = on && left ? m->neighbour[slot] : -1;
        bool above = m->x[3 * m->corner[slot] + 2] > 0; /* the corner opposite */
        m->set[slot] = on && left ? (above ? high : 0) : m->set[slot];
        faces += on && left && above;
    }
    memcpy(m->x + 3 * old, m->x, 3 * (size_t)old * sizeof *m->x);
    for (rg_gid e = 0; e < m->elements; e++) {
        double z = 0;
        for (int i = 0; i < 4; i++) {
            z += m->x[3 * m->corner[4 * e + i] + 2];
        }
        for (int i = 0; i < 4 && z > 0; i++) {
            const double *x = m->x + 3 * m->corner[4 * e + i];
            m->corner[4 * e + i] += !(fabs(x[2]) > 0) && x[0] < 0 ? old : 0;
        }
    }
    rg_gid *number = RG_NEW(rg_gid, 2 * (size_t)old), kept = 0;
    for (rg_gid i = 0; i < 4 * m->elements; i++) {
        number[m->corner[i]] = 1;
    }
    for (rg_gid v = 0; v < 2 * old; v++) {
        memmove(m->x + 3 * kept, m->x + 3 * v, 3 * sizeof *m->x);
        kept += number[v];
        number[v] = kept - 1;
    }
    for (rg_gid i = 0; i < 4 * m->elements; i++) {
        m->corner[i] = number[m->corner[i]];
    }
    rg_free(number);
    m->vertices = kept;
    for (rg_gid e = 0; e < m->elements; e++) {
        sort_corners(m, e);
    }
    rg_mesh_connect(m);
    return faces;
}

static int ascending(const void *a, const void *b) {
    const rg_gid *p = a, *q = b;
    return (*p > *q) - (*p < *q);
}

static bool same_neighbours(const rg_mesh *a, const rg_mesh *b, rg_gid e) {
    rg_gid list[2][4];
    memcpy(list[0], a->neighbour + 4 * e, sizeof list[0]);
    memcpy(list[1], b->neighbour + 4 * e, sizeof list[1]);
    for (int k = 0; k < 2; k++) {
        qsort(list[k], 4, sizeof **list, ascending);
    }
    return memcmp(list[0], list[1], sizeof list[0]) == 0;
}

/* The mesh is the box again, and the crack is where it was split, in the sets of both sides and its own; a
 * file holds it. `named`: the crack has the name of a set that is there. */
static void test_crack(void **state) {
    (void)state;
    for (int named = 0; named < 2; named++) {
        char path[] = "/tmp/test_crack.XXXXXX";
        rg_mesh *box = make(), *m = make();
        rg_gid *opened = RG_NEW(rg_gid, 4 * (size_t)m->elements), faces = split(m, opened), sides = 0;
        assert_int_equal(faces, 2 * 3 * 2);
        assert_int_equal(m->vertices, box->vertices + 2 * 4);
        rg_mesh_crack crack = rg_mesh_take_crack(m, named ? "z+" : "flaw");
        assert_int_equal(crack.faces, faces);
        assert_true(fabs(crack.area - 6) < 1e-12 && fabs(crack.place[0] + 1) < 1e-12);
        assert_true(fabs(crack.place[1] - 1.5) < 1e-12 && !(fabs(crack.place[2]) > 0));
        assert_int_equal(m->vertices, box->vertices);
        assert_int_equal(m->crack, named ? 6 : 7);
        assert_memory_equal(m->x, box->x, 3 * (size_t)box->vertices * sizeof *m->x);
        for (rg_gid e = 0; e < m->elements; e++) {
            assert_true(same_neighbours(m, box, e));
            assert_memory_equal(m->corner + 4 * e, box->corner + 4 * e, 4 * sizeof *m->corner);
        }
        for (rg_gid slot = 0; slot < 4 * m->elements; slot++) {
            int32_t count, group = m->set[slot];
            const int32_t *of = rg_sets_of(&m->surface, &group, &count);
            if (opened[slot] >= 0) {
                const int32_t all[4] = {0, 1, 3, m->crack - 1};
                assert_int_equal(count, 4);
                assert_memory_equal(of, all, sizeof all);
                sides++;
            } else {
                assert_int_equal(group, box->set[slot]);
            }
        }
        assert_int_equal(sides, 2 * faces);
        close(mkstemp(path));
        rg_mesh_file_write(path, m, 0, NULL);
        rg_mesh *back = rg_mesh_file_read(path);
        assert_int_equal(back->crack, m->crack);
        unlink(path);
        rg_mesh_free(back);
        rg_mesh_free(box);
        rg_mesh_free(m);
        rg_free(opened);
    }
}

/* Two elements on the same side of a face are none, nor is a mesh without any. */
static void test_no_crack(void **state) {
    (void)state;
    rg_mesh *m = make();
    assert_int_equal(rg_mesh_take_crack(m, "flaw").faces, 0);
    assert_int_equal(m->crack, 0);
    rg_gid *opened = RG_NEW(rg_gid, 4 * (size_t)m->elements);
    split(m, opened);
    for (rg_gid v = 0; v < m->vertices; v++) { /* folded over the crack */
        m->x[3 * v + 2] = fabs(m->x[3 * v + 2]);
    }
    assert_int_equal(rg_mesh_take_crack(m, "flaw").faces, 0);
    rg_free(opened);
    rg_mesh_free(m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_crack),
        cmocka_unit_test(test_no_crack),
    };
    int failed = cmocka_run_group_tests_name("crack", tests, NULL, NULL);
    return failed + (rg_alloc_blocks() > 0); /* all is given back */
}
