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

#include "base/mem.h"
#include "base/tet.h"
#include "layout.h"
#include "mesh/check.h"
#include "mesh/improve/flip.h"
#include "mesh/improve/improve.h"
#include "mesh/improve/move.h"
#include "support/dice.h"
#include "support/sanitized.h"

/* Few with sanitizers, which slow everything down. */
enum { ACROSS = RG_SANITIZED ? 3 : 6, DEEP = RG_SANITIZED ? 3 : 5 };
static const int64_t cells[3] = {ACROSS, DEEP, 8};
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
    /* as far as with the constants that were found best: what changes one gets elsewhere */
    assert_true(RG_SANITIZED || fabs(done.after / before - 3.5346) <= 1e-3);
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
        if (v / ((ACROSS + 1) * (DEEP + 1)) == 4) {
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
    m->region = RG_NEW(int32_t, (size_t)m->elements);
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

/* Faces that the input names stay, and those in sets with these; else the plane does not survive. */
static void test_inner_faces_stay(void **state) {
    (void)state;
    for (int named = 0; named < 3; named++) {
        rg_mesh *m = layered();
        double half = 0; /* of the plane: in set 6 */
        for (rg_gid slot = 0; named == 2 && slot < 4 * m->elements; slot++) {
            double x = face_vertex(m, slot, 0)[0] + face_vertex(m, slot, 1)[0] + face_vertex(m, slot, 2)[0];
            m->set[slot] = !in_middle(m, slot) ? m->set[slot] : x < 1.2 ? 6 : 7;
            half += m->set[slot] == 6 ? face_area(m, slot) / 2 : 0;
        }
        m->inner = RG_NEW(rg_gid, (size_t)(12 * m->elements));
        for (rg_gid slot = 0; named == 1 && slot < 4 * m->elements; slot++) {
            for (int i = 0; i < 3 && in_middle(m, slot); i++) {
                m->inner[3 * m->inners + (size_t)i] = m->corner[slot / 4 * 4 + rg_face_node[slot % 4][i]];
            }
            m->inners += in_middle(m, slot);
        }
        dice d = {.seed = 17};
        for (size_t i = m->inners; i > 1; i--) { /* in no order */
            rg_gid *a = m->inner + 3 * (i - 1), *b = m->inner + 3 * (size_t)(dice_unit(&d) * (double)i);
            rg_gid swap[3] = {a[0], a[1], a[2]};
            memcpy(a, b, sizeof swap);
            memcpy(b, swap, sizeof swap);
        }
        improve(m);
        for (rg_gid slot = 0; slot < 4 * m->elements; slot++) {
            assert_int_equal(m->set[slot] >= 6, named == 2 && in_middle(m, slot));
            half -= m->set[slot] == 6 ? face_area(m, slot) / 2 : 0;
        }
        assert_close(half, 0, 1e-12);
        assert_true(named > 0 ? fabs(middle_area(m) - 0.3) <= 1e-12 : middle_area(m) < 0.2);
        rg_mesh_free(m);
    }
}

/* Twice the same, and nothing in it has a length of its own. */
static void test_same_at_any_size(void **state) {
    (void)state;
    rg_mesh *a = jittered(), *b = jittered();
    for (rg_gid i = 0; i < 3 * b->vertices; i++) {
        b->x[i] *= 0x1p-10;
    }
    improve(a);
    improve(b);
    assert_int_equal(a->elements, b->elements);
    assert_memory_equal(a->corner, b->corner, 4 * (size_t)a->elements * sizeof *a->corner);
    for (rg_gid i = 0; i < 3 * b->vertices; i++) {
        assert_true(b->x[i] == 0x1p-10 * a->x[i]);
    }
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
    m->set = RG_NEW(int32_t, slots);
    memcpy(m->x, x, 3 * (size_t)vertices * sizeof *x);
    memcpy(m->corner, corner, slots * sizeof *corner);
    memset(m->set, -1, slots * sizeof *m->set);
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
        for (rg_gid e = 0; flat && e < 3; e++) {
            assert_int_equal(m->original[e], 0); /* the one that was in the way */
        }
        rg_mesh_connect(m);
        rg_mesh_check(m, "replaced");
        assert_close(total_volume(m, 0), volume, 1e-14);
        assert_true(smallest_height(m) > before);
        rg_mesh_free(m);
    }
}

/* ---- the ring around an edge ---- */

/* Vertices 2 .. 2 + sides - 1 around the edge 0 1, at random heights and distances; closed, or a fan whose
 * first and last vertex lie in one plane with the edge. The corners of every other tetrahedron begin
 * elsewhere. */
static rg_mesh *make_ring(int sides, bool closed, uint64_t seed) {
    double x[3 * 14] = {0.1, -0.2, 0, 0.05, 0.1, 1};
    rg_gid corner[4 * 12];
    dice d = {.seed = seed};
    int tets = closed ? sides : sides - 1;
    for (int k = 0; k < sides; k++) {
        double angle = closed
                           ? 6.283185307179586 * (k + 0.3 * dice_unit(&d)) / sides
                           : 3.141592653589793 * (k + (k > 0 && k < tets ? 0.3 * dice_sign(&d) : 0)) / tets;
        double far = closed ? 0.35 + 0.15 * dice_unit(&d) : 0.15 + 0.35 * dice_unit(&d);
        x[6 + 3 * k] = far * cos(angle);
        x[7 + 3 * k] = closed || (k > 0 && k < tets) ? far * sin(angle) : 0;
        x[8 + 3 * k] = closed ? 0.35 + 0.3 * dice_unit(&d) : 0.1 + 0.8 * dice_unit(&d);
    }
    memset(x, 0,
           closed ? 0 : 5 * sizeof *x); /* the edge of a fan is the axis that angles are measured around */
    for (int k = 0; k < tets; k++) {
        rg_gid c[4] = {0, 1, 2 + k, 2 + (k + 1) % sides};
        for (int i = 0; i < 4; i++) { /* ascending, as in a mesh */
            int place = 0;
            for (int j = 0; j < 4; j++) {
                place += c[j] < c[i];
            }
            corner[4 * k + place] = c[i];
        }
    }
    return small(2 + sides, x, tets, corner);
}

/* The largest smallest height of all ways to join vertices i .. k of the ring by triangles. */
static double best_of_all(const rg_tets *t, int i, int k) {
    double best = k - i < 2 ? INFINITY : -INFINITY;
    for (int j = i + 1; j < k; j++) {
        rg_gid up[4] = {2 + i, 2 + j, 2 + k, 1}, down[4] = {2 + i, 2 + k, 2 + j, 0};
        double here = fmin(rg_tets_height(t, up), rg_tets_height(t, down));
        best = fmax(best, fmin(here, fmin(best_of_all(t, i, j), best_of_all(t, j, k))));
    }
    return best;
}

static void test_rings(void **state) {
    (void)state;
    int gone = 0, stays = 0;
    for (int sides = 3; sides <= 12; sides++) {
        for (uint64_t seed = 1; seed <= (sides < 10 ? 12 : 3); seed++) {
            rg_mesh *m = make_ring(sides, true, 100 * (uint64_t)sides + seed);
            double before = smallest_height(m), volume = total_volume(m, 0);
            rg_tets t = rg_tets_make(m);
            double best = best_of_all(&t, 0, sides - 1);
            bool pays = best > 1.001 * before && sides <= 11; /* longer rings are left alone */
            assert_int_equal(rg_tets_remove_edge(&t, seed % 2 == 0, seed % 2 == 1), pays);
            rg_tets_finish(&t);
            assert_int_equal(m->elements, pays ? 2 * (sides - 2) : sides);
            rg_mesh_connect(m);
            rg_mesh_check(m, "ring");
            assert_close(total_volume(m, 0), volume, 1e-13);
            assert_close(smallest_height(m), pays ? best : before, 1e-13);
            gone += pays;
            stays += !pays;
            rg_mesh_free(m);
        }
    }
    assert_true(gone > 10 && stays > 10);
}

/* Fans of several tetrahedra, too: the best way to join their vertices, and two surface faces in place of
 * two. */
static void test_wide_fans(void **state) {
    (void)state;
    int gone[9] = {0}, stays = 0;
    for (int sides = 3; sides <= 8; sides++) {
        for (uint64_t seed = 1; seed <= 60; seed++) {
            rg_mesh *m = make_ring(sides, false, 1000 * (uint64_t)sides + seed);
            double before = smallest_height(m), volume = total_volume(m, 0);
            for (rg_gid s = 0; s < 4 * m->elements; s++) { /* the faces of the edge are of set 7 */
                const rg_gid *c = m->corner + s / 4 * 4;
                m->set[s] = m->neighbour[s] < 0 && s % 4 >= 2 && c[1] == 1 ? 7 : -1;
            }
            rg_tets t = rg_tets_make(m);
            double best = best_of_all(&t, 0, sides - 1);
            bool pays = best > 1.001 * before;
            assert_int_equal(rg_tets_remove_edge(&t, seed % 2 == 0, seed % 2 == 1), pays);
            rg_tets_finish(&t);
            assert_int_equal(m->elements, pays ? 2 * (sides - 2) : sides - 1);
            rg_mesh_connect(m);
            rg_mesh_check(m, "fan");
            assert_close(total_volume(m, 0), volume, 1e-13);
            assert_close(smallest_height(m), pays ? best : before, 1e-13);
            int marked = 0;
            for (rg_gid s = 0; s < 4 * m->elements; s++) {
                const rg_gid *c = m->corner + s / 4 * 4;
                bool flat = true;
                for (int i = 0; i < 4; i++) {
                    flat = flat && (i == s % 4 || m->x[3 * c[i] + 1] == 0);
                }
                assert_int_equal(m->set[s], flat ? 7 : -1);
                marked += flat;
            }
            assert_int_equal(marked, 2);
            gone[sides] += pays;
            stays += !pays;
            rg_mesh_free(m);
        }
    }
    assert_true(gone[3] > 10 && gone[4] > 3 && gone[5] > 1 && gone[6] > 1 && stays > 10);
}

/* A ring with one face that must stay, whichever it is, stays. */
static void test_kept_spokes(void **state) {
    (void)state;
    for (int closed = 0; closed < 2; closed++) {
        int tried = 0;
        for (uint64_t seed = 1; seed <= 30; seed++) {
            for (int kept = closed ? 0 : 1; kept < (closed ? 4 : 3); kept++) {
                for (int keep = 0; keep < 2; keep++) {
                    rg_mesh *m = make_ring(4, closed, 4000 + seed);
                    if (keep) {
                        m->inner = RG_NEW(rg_gid, 3);
                        memcpy(m->inner, (const rg_gid[]){0, 1, 2 + kept}, 3 * sizeof *m->inner);
                        m->inners = 1;
                    }
                    double before = smallest_height(m);
                    rg_tets t = rg_tets_make(m);
                    bool pays = best_of_all(&t, 0, 3) > 1.001 * before;
                    tried += pays && keep;
                    assert_int_equal(rg_tets_remove_edge(&t, 0, 1), pays && !keep);
                    rg_tets_finish(&t);
                    rg_mesh_free(m);
                }
            }
        }
        assert_true(tried > 10);
    }
}

/* A fan around an edge of the surface goes where its ends lie in one plane and set, and has another surface
 * face on either side then. */
static void test_fans(void **state) {
    (void)state;
    /* 0 and 1 and the ends 2 and 4 in the plane y = 0; 3 beside it */
    static const double x[15] = {0, 0, 0, 0, 0, 1, 0.3, 0, 0.45, 0.05, 0.6, 0.5, -0.35, 0, 0.55};
    static const rg_gid corner[8] = {0, 1, 2, 3, 0, 1, 3, 4};
    for (int n = 0; n < 18; n++) { /* as it is, small, and far from the origin */
        int what = n / 3;
        double length = n % 3 == 1 ? 1e-3 : 1, far = n % 3 == 2 ? 4 : 0;
        rg_mesh *m = small(5, x, 2, corner);
        /* faces 0 1 2 of the first and 0 1 4 of the second */
        m->set[3] = 7;
        m->set[4 + 2] = what == 1 ? 8 : 7;
        /* out of the plane: volume 0.3/6 of this, of which 1e-9 of the edge cubed is flat */
        m->x[13] = what == 2 ? -2.2e-8 : what == 3 ? -1.8e-8 : 0;
        for (int i = 0; i < 15; i++) {
            m->x[i] = length * m->x[i] + far;
        }
        m->set[0] = 3;                      /* 1 2 3: stays */
        m->set[4 + 1] = what == 4 ? 2 : -1; /* 0 3 4: stays */
        double volume = total_volume(m, 0);
        m->region = what == 5 ? RG_NEW(int32_t, 2) : NULL;
        if (what == 5) {
            m->region[0] = 1; /* the face between them must stay */
        }
        rg_tets t = rg_tets_make(m);
        bool goes = what == 0 || what == 3 || what == 4;
        assert_int_equal(rg_tets_remove_edge(&t, 1, 0), goes);
        rg_tets_finish(&t);
        assert_int_equal(m->elements, 2);
        rg_mesh_connect(m);
        rg_mesh_check(m, "fan");
        assert_close(total_volume(m, 0) + (what == 5 ? total_volume(m, 1) : 0), volume,
                     (what == 3 ? 1e-9
                      : far > 0 ? 1e-14
                                : 1e-15) *
                         length * length * length);
        int count[10] = {0};
        for (int s = 0; s < 8; s++) {
            count[m->set[s] + 1] += m->neighbour[s] < 0;
            assert_true(m->neighbour[s] < 0 || m->set[s] == -1);
            if (goes && m->set[s] == 7) { /* the new ones: 2 4 with 0 or 1 */
                const rg_gid *c = m->corner + s / 4 * 4;
                assert_int_equal(c[0] + c[1] + c[2] + c[3] - c[s % 4], 6 + (c[0] == 0 ? 0 : 1));
            }
            if (m->set[s] == 3) {
                const rg_gid *c = m->corner + s / 4 * 4;
                assert_int_equal(c[0] + c[1] + c[2] + c[3] - c[s % 4], 1 + 2 + 3);
            }
            if (m->set[s] == 2) {
                const rg_gid *c = m->corner + s / 4 * 4;
                assert_int_equal(c[0] + c[1] + c[2] + c[3] - c[s % 4], 0 + 3 + 4);
            }
        }
        assert_int_equal(count[8], what == 1 ? 1 : 2);
        assert_int_equal(count[9], what == 1);
        assert_int_equal(count[4], 1);
        assert_int_equal(count[3], what == 4);
        rg_mesh_free(m);
    }
}

/* ---- faces ---- */

/* Two elements on either side of a triangle, with the face at each place in the first one: three around the
 * line between the apexes, where that is better, and none where the face must stay or the line runs outside.
 */
static void test_faces(void **state) {
    (void)state;
    static const double place[5][3] = {
        {0.1, 0.05, -0.4}, {3, 0, 0}, {-1.5, 2.4, 0}, {-1.4, -2.7, 0}, {0, 0.1, 0.5}};
    for (int n = 0; n < 5 * 24; n++) {
        int number[5] = {0}, left[5] = {0, 1, 2, 3, 4};
        for (int k = 0, code = n; k < 5; k++) { /* the vertices in any order */
            int pick = code % (5 - k);
            code /= 5 - k;
            number[k] = left[pick];
            for (int j = pick; j < 4 - k; j++) {
                left[j] = left[j + 1];
            }
        }
        for (int kind = 0; kind < 3;
             kind++) { /* kind 1: the face is between volume sets; 2: the line runs outside */
            double x[15];
            rg_gid corner[8];
            for (int k = 0; k < 5; k++) {
                memcpy(x + 3 * number[k], place[k], sizeof place[k]);
                x[3 * number[k]] += kind == 2 && (k == 0 || k == 4) ? 9 : 0;
            }
            for (int e = 0; e < 2; e++) {
                const int c[4] = {number[e == 0 ? 0 : 4], number[1], number[2], number[3]};
                for (int i = 0; i < 4; i++) {
                    corner[4 * e + (c[0] < c[i]) + (c[1] < c[i]) + (c[2] < c[i]) + (c[3] < c[i])] = c[i];
                }
            }
            rg_mesh *m = small(5, x, 2, corner);
            m->region = RG_NEW(int32_t, 2);
            m->region[0] = kind == 1;
            for (int s = 0; s < 8;
                 s++) { /* each surface face is of the set of the vertex of the triangle that it lacks */
                const rg_gid *c = corner + s / 4 * 4;
                for (int k = 1; k < 4; k++) {
                    m->set[s] = c[s % 4] == number[k] ? k : m->set[s];
                }
            }
            double before = smallest_height(m), volume = total_volume(m, 0) + total_volume(m, 1);
            rg_tets t = rg_tets_make(m);
            int f = rg_tets_find(t.tet, number[0]), g = rg_tets_find(t.tet, number[1]);
            assert_false(rg_tets_remove_face(&t, 0, g)); /* on the surface */
            assert_int_equal(rg_tets_remove_face(&t, 0, f), kind == 0);
            rg_tets_finish(&t);
            assert_int_equal(m->elements, kind == 0 ? 3 : 2);
            rg_mesh_connect(m);
            rg_mesh_check(m, "face");
            assert_close(total_volume(m, 0) + total_volume(m, 1), volume, 1e-13);
            assert_true(kind == 0 ? smallest_height(m) > 1.1 * before
                                  : fabs(smallest_height(m) - before) < 1e-15);
            for (rg_gid s = 0; s < 4 * m->elements; s++) {
                const rg_gid *c = m->corner + s / 4 * 4;
                int lacks = -1;
                for (int k = 1; k < 4; k++) {
                    bool there = false;
                    for (int i = 0; i < 4; i++) {
                        there = there || (i != s % 4 && c[i] == number[k]);
                    }
                    lacks = there ? lacks : k;
                }
                assert_int_equal(m->set[s], m->neighbour[s] < 0 ? lacks : -1);
            }
            rg_mesh_free(m);
        }
    }
}

/* The element across a face is the one that shares all of it, though others, which come first, share an edge.
 */
static void test_crowded_face(void **state) {
    (void)state;
    /* 0 and 4 on either side of the triangle 1 2 3; 5 to 10 beyond the sides of these two */
    static const double x[33] = {0.1, 0.05, -0.4, 3,  0, 0,  -1.5, 2.4, 0, -1.4, -2.7, 0, 0, 0.1, 0.5, 2, 3,
                                 -2,  -4,   0,    -2, 2, -3, -2,   2,   3, 2,    -4,   0, 2, 2,   -3,  2};
    rg_gid corner[32];
    for (int k = 0; k < 3; k++) { /* an edge of the triangle with either apex, and what is beyond */
        rg_gid a = 1 + k, b = 1 + (k + 1) % 3, low = a < b ? a : b, high = a < b ? b : a;
        memcpy(corner + 4 * k, (const rg_gid[]){0, low, high, 5 + k}, 4 * sizeof *corner);
        memcpy(corner + 12 + 4 * k, (const rg_gid[]){low, high, 4, 8 + k}, 4 * sizeof *corner);
    }
    memcpy(corner + 24, (const rg_gid[]){0, 1, 2, 3, 1, 2, 3, 4}, 8 * sizeof *corner);
    for (int first = 0; first < 2; first++) { /* the two before the others, and behind them */
        rg_gid here[32];
        for (int i = 0; i < 32; i++) {
            here[i] = corner[first ? (i + 24) % 32 : i];
        }
        rg_mesh *m = small(11, x, 8, here);
        double volume = total_volume(m, 0);
        rg_tets t = rg_tets_make(m);
        rg_gid lower = first ? 0 : 6;
        assert_true(rg_tets_remove_face(&t, lower, rg_tets_find(t.tet + lower, 0)));
        rg_tets_finish(&t);
        assert_int_equal(m->elements, 9);
        rg_mesh_connect(m);
        rg_mesh_check(m, "crowded");
        assert_close(total_volume(m, 0), volume, 1e-12);
        rg_mesh_free(m);
    }
}

/* A change must pay by a thousandth: heights of the old and the new pair around it. */
static void test_least_gain(void **state) {
    (void)state;
    for (int pays = 0; pays < 2; pays++) {
        /* three around the edge 0 1 of length 2 h in the middle of a triangle: heights follow from h */
        double h = 1, x[15] = {0, 0, -h, 0, 0, h}, three, two;
        static const rg_gid corner[12] = {0, 1, 2, 3, 0, 1, 3, 4, 0, 1, 2, 4};
        double low = 0.05, high = 5; /* size of the triangle: at its root both are as good, times 1 -+ 4e-4 */
        for (int n = 0; n < 200; n++) {
            double far = (low + high) / 2;
            for (int k = 0; k < 3; k++) {
                x[6 + 3 * k] = far * cos(2.0943951023931953 * k);
                x[7 + 3 * k] = far * sin(2.0943951023931953 * k);
            }
            rg_mesh *m = small(5, x, 3, corner);
            rg_tets t = rg_tets_make(m);
            three = t.tet[0].height;
            two = rg_tets_height(&t, (const rg_gid[]){2, 3, 4, 1});
            double wanted = pays ? 1.0011 : 1.0009;
            *(two > wanted * three ? &low : &high) = far;
            if (n == 199) {
                assert_close(two / three, wanted, 1e-9);
                assert_int_equal(rg_tets_remove_edge(&t, 0, 1), pays);
            }
            rg_tets_finish(&t);
            rg_mesh_free(m);
        }
    }
}

/* ---- moving ---- */

/* Where the vertex in the middle of an octahedron may go. */
enum { ANYWHERE, SURFACE, EDGE, BETWEEN_SETS, BETWEEN_REGIONS, RIM, PLACES };

/* Vertices 0 to 5 at (1 0 0) (0 1 0) (0 0 1) and opposite, 6 in the middle; some of them are moved a little
 * where the faces that hold the middle one stay in their planes, and it itself along `free` directions. */
static rg_mesh *make_star(int kind, uint64_t seed, const bool free[3]) {
    double x[21] = {0};
    dice d = {.seed = seed};
    rg_gid corner[32];
    int tets = 0;
    for (int v = 0; v < 6; v++) {
        for (int i = 0; i < 3; i++) {
            bool plane = kind == ANYWHERE || i == v % 3 || (free[i] && kind != ANYWHERE);
            x[3 * v + i] = (i == v % 3 ? (v < 3 ? 1 : -1) : 0) + (plane ? 0.3 * dice_sign(&d) : 0);
        }
    }
    for (int i = 0; i < 3; i++) {
        x[18 + i] = free[i] ? 0.3 * dice_sign(&d) : 0;
    }
    for (int o = 0; o < 8; o++) {
        bool upper = (o & 4) == 0, right = (o & 2) == 0;
        bool half = kind == SURFACE || kind == EDGE || kind == BETWEEN_SETS;
        if ((!half || upper) && (kind != EDGE || right)) {
            rg_gid c[3] = {o & 1 ? 3 : 0, o & 2 ? 4 : 1, o & 4 ? 5 : 2};
            int place = 0;
            for (rg_gid v = 0; v < 6; v++) {
                if (v == c[0] || v == c[1] || v == c[2]) {
                    corner[4 * tets + place++] = v;
                }
            }
            corner[4 * tets++ + 3] = 6;
        }
    }
    rg_mesh *m = small(7, x, tets, corner);
    m->inner = RG_NEW(rg_gid, 3 * 2);
    m->region = kind == BETWEEN_REGIONS ? RG_NEW(int32_t, (size_t)tets) : NULL;
    for (int e = 0; e < tets; e++) {
        const rg_gid *c = corner + 4 * e;
        bool below = c[2] == 5, left = c[0] == 3 || c[1] == 3 || c[2] == 3;
        if (kind == BETWEEN_REGIONS) {
            m->region[e] = below;
        }
        for (int f = 0; f < 3; f++) { /* the faces of the middle vertex in the plane of x and y */
            bool flat = c[f] == 2 || c[f] == 5;
            m->set[4 * e + f] = kind == BETWEEN_SETS && flat && left ? 1 : m->set[4 * e + f];
        }
    }
    for (rg_gid v = 1; kind == RIM && v <= 4; v += 3) { /* a sheet that ends at the axis of y */
        memcpy(m->inner + 3 * m->inners++, (const rg_gid[]){0, v, 6}, 3 * sizeof *m->inner);
    }
    return m;
}

static double star_height(const rg_tets *t) {
    double least = INFINITY;
    for (rg_gid e = 0; e < t->count; e++) {
        least = fmin(least, rg_tets_height(t, t->tet[e].corner));
    }
    return least;
}

/* The axes of the star after a turn that no axis survives, or none. */
static void turned_axes(bool turned, double axis[3][3]) {
    static const double general[3][3] = {
        {2.0 / 7, 3.0 / 7, 6.0 / 7}, {3.0 / 7, -6.0 / 7, 2.0 / 7}, {6.0 / 7, 2.0 / 7, -3.0 / 7}};
    for (int n = 0; n < 9; n++) {
        axis[n / 3][n % 3] = turned ? general[n / 3][n % 3] : n % 4 == 0;
    }
}

static void turn_mesh(rg_mesh *m, const double axis[3][3]) {
    for (rg_gid v = 0; v < m->vertices; v++) {
        double from[3];
        memcpy(from, m->x + 3 * v, sizeof from);
        for (int i = 0; i < 3; i++) {
            m->x[3 * v + i] = from[0] * axis[0][i] + from[1] * axis[1][i] + from[2] * axis[2][i];
        }
    }
}

/* The best height by trying in all free directions, with steps that get smaller. */
static double search_best(const rg_tets *t, const bool free[3], const double axis[3][3]) {
    double *x = t->mesh->x + 18, from[3], best = star_height(t);
    dice d = {.seed = 99};
    memcpy(from, x, sizeof from);
    for (double step = 0.2; step > 1e-4; step *= 0.8) {
        for (int n = 0; n < 120; n++) {
            double back[3], height;
            memcpy(back, x, sizeof back);
            for (int i = 0; i < 3; i++) {
                double far = free[i] ? step * dice_sign(&d) : 0;
                for (int k = 0; k < 3; k++) {
                    x[k] += far * axis[i][k];
                }
            }
            height = star_height(t);
            height > best ? (void)(best = height) : (void)memcpy(x, back, sizeof back);
        }
    }
    memcpy(x, from, sizeof from);
    return best;
}

static void test_moves(void **state) {
    (void)state;
    static const bool free[PLACES][3] = {{true, true, true},   {true, true, false}, {true, false, false},
                                         {false, true, false}, {true, true, false}, {false, true, false}};
    for (int kind = 0; kind < PLACES; kind++) {
        double worst = 1;
        for (uint64_t seed = 1; seed <= (RG_SANITIZED ? 4 : 16); seed++) {
            double axis[3][3];
            rg_mesh *m = make_star(kind, 50 * (uint64_t)kind + seed, free[kind]);
            turned_axes(seed % 2 == 0, axis);
            turn_mesh(m, (const double(*)[3])axis);
            rg_tets t = rg_tets_make(m);
            double before = star_height(&t), best = search_best(&t, free[kind], (const double(*)[3])axis),
                   x[21];
            memcpy(x, m->x, sizeof x);
            assert_close(rg_tets_star_height(&t, 6), before, 0);
            bool moved = rg_tets_move(&t, 6);
            double after = star_height(&t);
            assert_int_equal(moved, after > before);
            assert_close(rg_tets_star_height(&t, 6), after, 0); /* heights are kept up */
            assert_memory_equal(m->x, x, 18 * sizeof *x);
            for (int i = 0; i < 3; i++) {
                double along = 0;
                for (int k = 0; k < 3; k++) {
                    along += (m->x[18 + k] - x[18 + k]) * axis[i][k];
                }
                assert_true(free[kind][i] ? along == 0 || moved : fabs(along) < 1e-15);
            }
            worst = fmin(worst, after / best);
            rg_tets_finish(&t);
            rg_mesh_free(m);
        }
        /* Heights within 2 % of the smallest count as near it, so that much may be left to gain. */
        print_message("# %.4g of the best\n", worst);
        assert_true(worst > 0.97);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_flat_elements_grow),
        cmocka_unit_test(test_box_keeps_its_shape),
        cmocka_unit_test(test_volume_sets_stay),
        cmocka_unit_test(test_inner_faces_stay),
        cmocka_unit_test(test_same_at_any_size),
        cmocka_unit_test(test_vertex_goes_to_the_best_place),
        cmocka_unit_test(test_edge_and_face_are_replaced),
        cmocka_unit_test(test_rings),
        cmocka_unit_test(test_wide_fans),
        cmocka_unit_test(test_kept_spokes),
        cmocka_unit_test(test_fans),
        cmocka_unit_test(test_faces),
        cmocka_unit_test(test_crowded_face),
        cmocka_unit_test(test_least_gain),
        cmocka_unit_test(test_moves),
    };
    int failed = cmocka_run_group_tests_name("improve", tests, NULL, NULL);
    return failed + (rg_alloc_blocks() > 0); /* all is given back */
}
