/* The search for faces that may touch, against all pairs: whatever touches or lies over each other, now or
 * after every corner has moved as far as it may, was found; each pair once, by all ranks that have a part in
 * it. Prints TAP from rank 0. */
#include "contact/search.h"

#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "base/vector.h"
#include "support/dice.h"
#include "support/tap_memory.h"

enum { FACES = 240 };

static int ranks;
static rg_search by = {.penalty = 4, .skin = 2e-3, .reach = 0.5, .fat = 0.1, .turn = 0.3};

/* Triangles of edges near 1 in a box of 5, a few of them large, the same on all ranks; every sixth one flies
 * far away. */
static void throw_faces(rg_exposed_face *f) {
    dice d = {5, 0};
    for (int i = 0; i < FACES; i++) {
        double R[3][3], at[3], size = i % 50 == 0 ? 4 : 0.7;
        dice_rotation(&d, R);
        for (int c = 0; c < 3; c++) {
            at[c] = 2.5 * dice_sign(&d) + (i % 6 == 0 ? 1e3 * (c + 1) : 0);
        }
        f[i] = (rg_exposed_face){.id = 4 * i, .rank = i % 7 % ranks, .modulus = 1, .height = 0.6};
        for (int k = 0; k < 9; k++) {
            double p[3] = {size * cos(2.1 * (k / 3)), size * sin(2.1 * (k / 3)), 0.1 * dice_sign(&d)};
            f[i].corner[k] = at[k % 3] + R[k % 3][0] * p[0] + R[k % 3][1] * p[1] + R[k % 3][2] * p[2];
            f[i].rest[k] = f[i].corner[k] + 100 * i; /* nothing is shared undeformed */
        }
    }
}

/* Each corner by at most the length that the search allows. */
static void move(rg_exposed_face *f, int pass) {
    dice d = {(uint64_t)pass, 0};
    for (int i = 0; i < 3 * FACES && pass > 0; i++) {
        double R[3][3];
        dice_rotation(&d, R);
        for (int c = 0; c < 3; c++) {
            f[i / 3].corner[3 * (i % 3) + c] += (1 - 1e-12) * by.fat * R[c][0];
        }
    }
}

static bool is_found(const rg_candidate *p, size_t pairs, rg_gid a, rg_gid b) {
    int times = 0;
    for (size_t i = 0; i < pairs; i++) {
        times += p[i].face[0].id == a && p[i].face[1].id == b;
    }
    return times == 1;
}

/* Pairs over each other of which this rank has a part; those that were not found, or more than once. */
static void compare(const rg_candidate *p, size_t pairs, int pass, int *over, int *missed) {
    static rg_exposed_face f[FACES];
    throw_faces(f);
    move(f, pass);
    for (int i = 0; i < FACES; i++) {
        for (int k = i + 1; k < FACES; k++) {
            rg_contact_pair pair;
            double corner[18], box[12], force[18], sunk[2] = {0, 0}, energy, depth;
            if ((f[i].rank != rank && f[k].rank != rank) || !rg_search_may_touch(&by, &f[i], &f[k], &pair)) {
                continue;
            }
            pair.face[0] = 0;
            pair.face[1] = 1;
            memcpy(corner, f[i].corner, sizeof f[i].corner);
            memcpy(corner + 9, f[k].corner, sizeof f[k].corner);
            rg_contact_box(corner, box);
            rg_contact_box(corner + 9, box + 6);
            rg_contact_args args = {.corner = corner,
                                    .box = box,
                                    .sunk = sunk,
                                    .pair = &pair,
                                    .force = force,
                                    .energy = &energy,
                                    .depth = &depth};
            rg_kernels_select()->contact(&args, 0, 1);
            if (depth > 0) {
                *over += 1;
                *missed += !is_found(p, pairs, f[i].id, f[k].id);
            }
        }
    }
}

/* Least and most of the distances along n of corners of f from corners of g. */
static void distances(const double *n, const rg_exposed_face *f, const rg_exposed_face *g, double out[2]) {
    out[0] = INFINITY;
    out[1] = -INFINITY;
    for (int i = 0; i < 9; i++) {
        double r[3];
        rg_vector_subtract(f->corner + 3 * (i / 3), g->corner + 3 * (i % 3), r);
        out[0] = fmin(out[0], rg_vector_dot(n, r));
        out[1] = fmax(out[1], rg_vector_dot(n, r));
    }
}

static bool overlap(const double d[2], double low, double high) {
    return d[0] <= high && d[1] >= low;
}

/* Which pairs the search is to tell, by all corners of both: normals that may face each other, some points
 * that may lie over each other along the mid-plane's, by no more than contact reaches, and on the right side
 * of both planes. */
static bool may_meet(const rg_exposed_face *f, const rg_exposed_face *g) {
    double p[3], q[3], n[3], d[2], least = fmin(f->height, g->height), deep = (by.skin + by.reach) * least;
    double slack = 2 * by.fat + 4 * by.turn * deep, far = by.fat + 0.5 * (by.skin + by.reach) * f->height;
    bool good = true;
    rg_vector_normal(f->corner, p);
    rg_vector_normal(g->corner, q);
    rg_vector_subtract(p, q, n);
    double length = sqrt(rg_vector_dot(n, n));
    far += by.fat + 0.5 * (by.skin + by.reach) * g->height;
    for (int c = 0; c < 3; c++) {
        n[c] /= length;
        double axis[3] = {c == 0, c == 1, c == 2};
        distances(axis, f, g, d);
        good = good && overlap(d, -far, far) &&
               overlap(d, fmin(n[c] * deep, 0) - slack, fmax(n[c] * deep, 0) + slack);
    }
    distances(n, f, g, d);
    good = good && overlap(d, -slack, deep + slack) && rg_vector_dot(p, q) <= 2 * by.turn;
    distances(p, f, g, d);
    good = good && overlap(d, -slack, deep + slack);
    distances(q, f, g, d);
    return good && overlap(d, -deep - slack, slack);
}

/* Pairs of this rank that were told without need, or not told. */
static int wrongly_told(const rg_candidate *p, size_t pairs, const rg_exposed_face *f) {
    int wrong = 0;
    for (int i = 0; i < FACES; i++) {
        for (int k = i + 1; k < FACES; k++) {
            rg_contact_pair pair;
            if (f[i].rank == rank || f[k].rank == rank) {
                bool wanted = may_meet(&f[i], &f[k]) && rg_search_may_touch(&by, &f[i], &f[k], &pair);
                wrong += is_found(p, pairs, f[i].id, f[k].id) != wanted;
            }
        }
    }
    return wrong;
}

static void test_all_pairs(const char *name) {
    static rg_exposed_face all[FACES], own[FACES];
    size_t count = 0, pairs;
    int over = 0, missed = 0, total;
    throw_faces(all);
    for (int i = 0; i < FACES; i++) {
        own[count] = all[i];
        own[count].row = (int32_t)count;
        count += all[i].rank == rank;
    }
    rg_candidate *p = rg_search_pairs(&by, own, count, &pairs, MPI_COMM_WORLD);
    bool mine = true, ascending = true, rows = true;
    for (size_t i = 0; i < pairs; i++) {
        mine = mine && (p[i].face[0].rank == rank || p[i].face[1].rank == rank);
        ascending = ascending && p[i].face[0].id < p[i].face[1].id &&
                    (i == 0 || p[i - 1].face[0].id < p[i].face[0].id ||
                     (p[i - 1].face[0].id == p[i].face[0].id && p[i - 1].face[1].id < p[i].face[1].id));
        for (int k = 0; k < 2; k++) {
            const rg_exposed_face *f = &p[i].face[k];
            rows = rows && (f->rank != rank || own[f->row].id == f->id);
        }
    }
    for (int pass = 0; pass < 12; pass++) {
        compare(p, pairs, pass, &over, &missed);
    }
    MPI_Allreduce(&over, &total, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
    report(mine && rows, name, "tells each rank its own pairs");
    report(ascending, name, "gives pairs by their numbers, each once");
    report(total > 1000 && missed == 0, name, "finds all that come over each other");
    report(wrongly_told(p, pairs, all) == 0, name, "finds what a plain loop finds");
    rg_free(p);
}

static rg_exposed_face at(rg_gid id, const double x[9]) {
    rg_exposed_face f = {.id = id, .modulus = 2, .height = 0.5};
    memcpy(f.rest, x, sizeof f.rest);
    memcpy(f.corner, x, sizeof f.corner);
    return f;
}

/* An edge of the solid presses nothing, a notch does; of a former interface both sides fade. */
static void test_neighbours(void) {
    static const double top[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, side[9] = {0, 0, 0, 0, 0, -1, 1, 0, 0},
                        notch[9] = {0, 0, 0, 1, 0, 0, 0, 0, 1}, below[9] = {0, 0, 0, 0, 1, 0, 1, 0, 0};
    rg_exposed_face a = at(4, top), b = at(8, side), c = at(12, notch), d = at(16, below), e = at(5, below);
    rg_contact_pair pair;
    report(!rg_search_may_touch(&by, &a, &b, &pair), "search", "leaves out convex edges");
    rg_exposed_face far = b;
    for (int i = 0; i < 3; i++) { /* half a face's root area, less what both may move, to go: and past it */
        far.corner[3 * i + 2] -= sqrt(0.5) - 2 * by.fat - 1e-6;
    }
    bool holds = !rg_search_may_touch(&by, &a, &far, &pair);
    for (int i = 0; i < 3; i++) {
        far.corner[3 * i + 2] -= 2e-6;
    }
    bool parted = rg_search_may_touch(&by, &a, &far, &pair) && pair.parting == 0.5 && pair.fading == 0;
    static const double ends[2][3] = {{0.5, 0.5, 0}, {0.5, 0, 0.5}};
    report(holds && parted && memcmp(pair.common, ends, sizeof ends) == 0, "search",
           "takes them in once they have come apart");
    report(!rg_search_may_touch(&by, &a, &e, &pair), "search", "leaves out faces of one element");
    report(rg_search_may_touch(&by, &a, &c, &pair), "search", "keeps notches");
    bool keeps = rg_search_may_touch(&by, &a, &d, &pair) && pair.fading == 0;
    a.former = d.former = 1;
    report(keeps && rg_search_may_touch(&by, &a, &d, &pair) && pair.fading == 0.5, "search",
           "knows both sides of a former interface");
    report(pair.stiffness == 4 * 2 / 0.5 && pair.skin == 2e-3 * 0.5 && pair.limit == 0.502 * 0.5, "search",
           "scales by the height of elements");
}

/* Pairs that rank 0 finds of two faces that face each other, a little apart, moved by `away` along x, the
 * second one stretched `stretched` times. */
static size_t pairs_of_two(double away, double stretched) {
    static const double low[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, high[9] = {0, 0, 0.1, 0, 1, 0.1, 1, 0, 0.1};
    rg_exposed_face f[2] = {at(4, low), at(8, high)};
    for (int k = 0; k < 9; k++) {
        f[0].rest[k] += 100; /* nothing is shared undeformed */
        f[1].corner[k] *= k % 3 < 2 ? stretched : 1;
        for (int i = 0; i < 2; i++) {
            f[i].corner[k] += k % 3 == 0 ? away : 0;
            f[i].row = i;
        }
    }
    size_t pairs;
    rg_free(rg_search_pairs(&by, f, rank == 0 ? 2 : 0, &pairs, MPI_COMM_WORLD));
    return rank == 0 ? pairs : 0;
}

/* The grid of cells ends 2^20 of them from the origin. */
static void test_lost_faces(void) {
    size_t near = pairs_of_two(0, 1) + pairs_of_two(1e5, 1); /* each by all ranks together */
    size_t lost = pairs_of_two(1e8, 1) + pairs_of_two(-1e8, 1) + pairs_of_two(NAN, 1);
    size_t wide = pairs_of_two(0, 9.9), torn = pairs_of_two(0, 10.1);
    report(near == (rank == 0 ? 2 : 0), "search", "finds two faces");
    report(lost == 0, "search", "leaves out what is nowhere near");
    report(wide == (rank == 0) && torn == 0, "search", "leaves out torn faces");
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    test_all_pairs("search");
    test_neighbours();
    rg_search usual = by;
    by = (rg_search){.penalty = 4, .skin = 0.5, .reach = 0.02, .fat = 0.02, .turn = 0.05};
    test_all_pairs("thick skins");
    by = usual;
    test_lost_faces();
    return finish_with_nothing_left();
}
