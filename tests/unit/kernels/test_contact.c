/* Contact of two faces: every set against the definition and its complex steps, and what must hold of a
 * potential: both momenta, exchange of the faces, any triangulation of a flat surface. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "kernels.h"
#include "support/dice.h"
#include "support/kernel_input.h"
#include "support/near.h"

enum { PAIRS = 1500, TRIES = 150000 };

typedef struct {
    double corner[2 * PAIRS][9], box[2 * PAIRS][6], sunk[2 * PAIRS], force[PAIRS][18], energy[PAIRS],
        depth[PAIRS], grip[PAIRS][RG_GRIP], heat[PAIRS], rate[2 * PAIRS][9], drag[PAIRS][18], stiffer[PAIRS];
    rg_contact_pair pair[PAIRS];
    size_t count;
    bool rough; /* with friction */
    double damping;
} bunch;

static rg_contact_args args_of(bunch *b) {
    return (rg_contact_args){.corner = b->corner[0],
                             .box = b->box[0],
                             .sunk = b->sunk,
                             .pair = b->pair,
                             .force = b->force[0],
                             .energy = b->energy,
                             .depth = b->depth,
                             .grip = b->rough ? b->grip[0] : NULL,
                             .heat = b->heat,
                             .rate = b->damping > 0 ? b->rate[0] : NULL,
                             .damping = b->damping,
                             .dt = 0.5,
                             .drag = b->drag[0],
                             .stiffer = b->stiffer};
}

/* The first `pairs` pairs. */
static void meet(const rg_kernels *set, bunch *b, size_t pairs) {
    for (size_t i = 0; i < 2 * pairs; i++) {
        rg_contact_box(b->corner[i], b->box[i]);
    }
    rg_contact_args args = args_of(b);
    set->contact(&args, 0, pairs);
}

/* Two faces of edges near 1 that lie near each other, flat or steep, turned at random. */
static void throw_faces(dice *d, double *x) {
    static const double triangle[3][2] = {{0.6, 0}, {-0.3, 0.5}, {-0.3, -0.5}};
    double R[3][3], steep = dice_unit(d) < 0.5 ? 0.06 : 0.36;
    dice_rotation(d, R);
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < 3; i++) {
            const double *from = triangle[k == 1 ? 2 - i : i];
            double p[3] = {from[0] + 0.4 * dice_sign(d), from[1] + 0.4 * dice_sign(d), steep * dice_sign(d)};
            for (int c = 0; c < 3; c++) {
                x[9 * k + 3 * i + c] = R[c][0] * p[0] + R[c][1] * p[1] + R[c][2] * p[2];
            }
        }
    }
}

/* How a pair's faces are related: some are both sides of a former face, some have a corner or two in common
 * that has come apart by about as much as it takes. */
static void relate(dice *d, int k, rg_contact_pair *pair) {
    static const double mean[3][3] = {{1.0 / 3, 1.0 / 3, 1.0 / 3}, {1, 0, 0}, {0.5, 0.5, 0}};
    for (int side = 0; side < 2 && k % 4 < 3; side++) {
        memcpy(pair->common[side], mean[k % 4], sizeof mean[0]);
    }
    pair->fading = k % 4 == 0 ? 0.4 + dice_unit(d) : 0;
    pair->parting = k % 4 == 1 || k % 4 == 2 ? 0.4 + dice_unit(d) : 0;
}

/* Pairs that touch, and one in eight of those that do not. */
static void throw_pairs(bunch *b, uint64_t seed) {
    dice d = {seed, 0};
    b->count = 0;
    for (int k = 0; k < TRIES && b->count < PAIRS; k++) {
        size_t at = b->count;
        throw_faces(&d, b->corner[2 * at]);
        b->pair[at] = (rg_contact_pair){.face = {(int32_t)(2 * at), (int32_t)(2 * at + 1)},
                                        .stiffness = dice_power(&d, -1, 1),
                                        .limit = 0.3 + 0.3 * dice_unit(&d),
                                        .skin = 0.02 * dice_unit(&d)};
        relate(&d, k, &b->pair[at]);
        b->sunk[2 * at] = k % 3 == 0 ? 0.1 * dice_unit(&d) : 0;
        b->sunk[2 * at + 1] = k % 3 == 0 ? 0.1 * dice_unit(&d) : 0;
        rg_contact_args args = args_of(b);
        rg_kernels_reference.contact(&args, at, at + 1);
        b->count += b->energy[at] > 0 || k % 8 == 0;
    }
    assert_int_equal(b->count, PAIRS);
}

static bunch expected, found;

static double size_of(const bunch *b, size_t i) {
    double most = 0;
    for (int k = 0; k < 18; k++) {
        most = fmax(most, fabs(b->force[i][k]));
    }
    return most;
}

/* Forces of faces nearly at right angles, or of polygons that are nearly nothing, are small differences. */
static void test_reference(void **state) {
    (void)state;
    const rg_kernels *sets[INPUT_SETS];
    int n = input_sets(sets, INPUT_SETS), touching = 0;
    throw_pairs(&expected, 7);
    meet(&rg_kernels_reference, &expected, PAIRS);
    for (int s = 0; s < n; s++) {
        found = expected;
        memset(found.energy, 0, sizeof found.energy);
        meet(sets[s], &found, PAIRS);
        for (size_t i = 0; i < PAIRS; i++) {
            double energy = expected.energy[i], kappa = expected.pair[i].stiffness;
            if (!(fabs(found.energy[i] - energy) <= 4e-17 * kappa)) {
                fail_msg("%s: energy %.17g instead of %.17g", sets[s]->name, found.energy[i], energy);
            }
            if (!(fabs(found.depth[i] - expected.depth[i]) <= 2e-15)) {
                fail_msg("%s: depth %.17g instead of %.17g", sets[s]->name, found.depth[i],
                         expected.depth[i]);
            }
            touching += energy > 0;
            for (int k = 0; energy > 0 && found.energy[i] > 0 && k < 18; k++) {
                double one = found.force[i][k], two = expected.force[i][k];
                if (!(fabs(one - two) <= 2.5e-15 * kappa)) {
                    fail_msg("%s: force %d of pair %zu is %.17g instead of %.17g", sets[s]->name, k, i, one,
                             two);
                }
            }
        }
    }
    assert_true(touching > n * PAIRS / 2);
}

/* Against central differences of the kernel's own energy; where a corner of one face comes to lie on an edge
 * of the other the force has a corner too, which so small a step seldom meets. */
static void test_gradient(void **state) {
    (void)state;
    const rg_kernels *set = rg_kernels_select();
    static const double h = 1e-5;
    int off = 0, all = 0;
    throw_pairs(&found, 8);
    meet(set, &found, PAIRS);
    expected = found;
    for (int k = 0; k < 18; k++) {
        double up[PAIRS];
        for (int sign = 1; sign >= -1; sign -= 2) {
            for (size_t i = 0; i < PAIRS; i++) {
                double *x = &found.corner[2 * i + (size_t)k / 9][k % 9];
                *x = expected.corner[2 * i + (size_t)k / 9][k % 9] + sign * h;
            }
            meet(set, &found, PAIRS);
            memcpy(sign > 0 ? up : found.energy, found.energy, sizeof up);
        }
        for (size_t i = 0; i < PAIRS; i++) {
            if (expected.energy[i] > 0) {
                double slope = (up[i] - found.energy[i]) / (2 * h), size = expected.pair[i].stiffness;
                off += !(fabs(slope + expected.force[i][k]) <= 1e-10 * size);
                all++;
            }
        }
        found = expected;
    }
    assert_true(all > 9 * PAIRS && off < all / 1000);
}

static void check_momenta(void) {
    for (size_t i = 0; i < PAIRS; i++) {
        double sum[3] = {0, 0, 0}, moment[3] = {0, 0, 0}, size = size_of(&found, i);
        for (int k = 0; found.energy[i] > 0 && k < 6; k++) {
            const double *x = &found.corner[2 * i + (size_t)k / 3][k % 3 * 3], *f = &found.force[i][3 * k];
            for (int c = 0; c < 3; c++) {
                int a = (c + 1) % 3, b = (c + 2) % 3;
                sum[c] += f[c];
                moment[c] += (x[a] + 1) * f[b] - (x[b] + 1) * f[a];
            }
        }
        for (int c = 0; found.energy[i] > 0 && c < 3; c++) {
            assert_true(fabs(sum[c]) <= 4e-15 * fmax(size, 1e-2 * found.pair[i].stiffness));
            assert_true(fabs(moment[c]) <= 4e-15 * fmax(size, 1e-2 * found.pair[i].stiffness));
        }
    }
}

/* The forces of a pair have no sum and no moment, about any point. */
static void test_momenta(void **state) {
    (void)state;
    throw_pairs(&found, 9);
    meet(rg_kernels_select(), &found, PAIRS);
    check_momenta();
}

static void test_exchange(void **state) {
    (void)state;
    const rg_kernels *set = rg_kernels_select();
    throw_pairs(&expected, 10);
    found = expected;
    for (size_t i = 0; i < PAIRS; i++) {
        found.pair[i].face[0] = expected.pair[i].face[1];
        found.pair[i].face[1] = expected.pair[i].face[0];
    }
    meet(set, &expected, PAIRS);
    meet(set, &found, PAIRS);
    for (size_t i = 0; i < PAIRS; i++) {
        double kappa = expected.pair[i].stiffness;
        assert_true(fabs(expected.energy[i] - found.energy[i]) <= 2e-17 * kappa);
        for (int k = 0; expected.energy[i] > 0 && found.energy[i] > 0 && k < 18; k++) {
            assert_true(fabs(expected.force[i][k] - found.force[i][(k + 9) % 18]) <= 2e-16 * kappa);
        }
    }
}

/* A square against a face, cut along one diagonal, along the other and into four: the same energy, and the
 * same forces on the face and on the corners of the square, which stay in its plane. */
static void test_cut(void **state) {
    (void)state;
    static const double square[5][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {0.2, -0.1}};
    static const int cut[3][4][3] = {
        {{0, 2, 1}, {0, 3, 2}}, {{1, 0, 3}, {1, 3, 2}}, {{0, 4, 1}, {1, 4, 2}, {2, 4, 3}, {3, 4, 0}}};
    static const int faces[3] = {2, 2, 4};
    const rg_kernels *set = rg_kernels_select();
    double energy[3] = {0}, force[3][9] = {{0}},
           face[3][3] = {{0.1, 0.7, -0.03}, {-0.8, -0.6, -0.06}, {0.9, -0.5, 0.01}};
    for (int k = 0; k < 3; k++) {
        bunch *b = &found;
        memset(b, 0, sizeof *b);
        for (int f = 0; f < faces[k]; f++) {
            for (int i = 0; i < 3; i++) {
                const double *p = square[cut[k][f][i]];
                double at[3] = {p[0], p[1], 0.02 * p[0] + 0.01 * p[1]};
                memcpy(&b->corner[2 * f + 1][3 * i], at, sizeof at);
                /* the square faces down, the face below it up */
                memcpy(&b->corner[2 * f][3 * i], face[i], sizeof at);
                b->corner[2 * f][3 * i + 2] += 0.05;
            }
            b->pair[f] =
                (rg_contact_pair){.face = {2 * f, 2 * f + 1}, .stiffness = 1, .skin = 1e-3, .limit = 0.501};
        }
        meet(set, b, (size_t)faces[k]);
        for (int f = 0; f < faces[k]; f++) {
            energy[k] += b->energy[f];
            for (int c = 0; b->energy[f] > 0 && c < 9; c++) {
                force[k][c] += b->force[f][c];
            }
        }
    }
    assert_true(energy[0] > 1e-4);
    for (int k = 1; k < 3; k++) {
        assert_true(fabs(energy[k] - energy[0]) < 1e-15 * energy[0]);
        for (int c = 0; c < 9; c++) {
            assert_true(fabs(force[k][c] - force[0][c]) < 1e-17);
        }
    }
}

/* Corners on a grid: edges that lie along each other, corners on edges and on corners, turned so that
 * rounding decides or nothing does; parallel faces beside some that are in part too deep. What they come to
 * is that of the same faces shaken a little; the reference, which is lost where three lines meet, need not
 * know. */
static void test_edges_along_each_other(void **state) {
    (void)state;
    static const double shake = 1e-6;
    const rg_kernels *sets[INPUT_SETS];
    int n = input_sets(sets, INPUT_SETS), touching = 0;
    dice d = {11, 0};
    for (size_t i = 0; i < PAIRS; i++) {
        double R[3][3], p[6][3], one[2][2];
        dice_rotation(&d, R);
        for (int c = 0; c < 9 && i % 2 == 0; c++) { /* some exactly */
            R[c / 3][c % 3] = c % 4 == 0;
        }
        for (int k = 0; k < 2; k++) { /* up, down */
            do {
                for (int j = 3 * k; j < 3 * k + 3; j++) {
                    p[j][0] = floor(3 * dice_unit(&d));
                    p[j][1] = floor(3 * dice_unit(&d));
                    p[j][2] = i % 3 == 0 ? 0 : 0.05 * p[j][0] - 0.02 * p[j][1];
                    p[j][2] += k == 1 ? 0 : i % 6 == 1 ? 0.3 * p[j][0] : 0.2; /* in part too deep */
                }
                for (int c = 0; c < 4; c++) {
                    one[c / 2][c % 2] = p[3 * k + 1 + c / 2][c % 2] - p[3 * k][c % 2];
                }
            } while ((k == 0 ? 1 : -1) * (one[0][0] * one[1][1] - one[0][1] * one[1][0]) <= 0);
        }
        for (int k = 0; k < 18; k++) {
            double *x = &found.corner[2 * i + (size_t)k / 9][k % 9];
            *x = R[k % 3][0] * p[k / 3][0] + R[k % 3][1] * p[k / 3][1] + R[k % 3][2] * p[k / 3][2];
            expected.corner[2 * i + (size_t)k / 9][k % 9] = *x + shake * dice_sign(&d);
        }
        found.pair[i] =
            (rg_contact_pair){.face = {(int32_t)(2 * i), (int32_t)(2 * i + 1)}, .stiffness = 1, .limit = 0.5};
        expected.pair[i] = found.pair[i];
        for (int k = 0; k < 2; k++) {
            found.sunk[2 * i + (size_t)k] = expected.sunk[2 * i + (size_t)k] = 0;
        }
    }
    meet(&rg_kernels_reference, &expected, PAIRS);
    for (int s = 0; s < n; s++) {
        if (sets[s] == &rg_kernels_reference) {
            continue;
        }
        meet(sets[s], &found, PAIRS);
        for (size_t i = 0; i < PAIRS; i++) {
            if (!(fabs(found.energy[i] - expected.energy[i]) <= 0.4 * shake)) {
                fail_msg("%s: energy %g instead of %g", sets[s]->name, found.energy[i], expected.energy[i]);
            }
            for (int k = 0; found.energy[i] > 0 && k < 18;
                 k++) { /* which side of an edge they are for is open */
                assert_true(fabs(found.force[i][k]) < 1);
            }
            touching += expected.energy[i] > 1e-4;
        }
    }
    assert_true(touching > PAIRS / 2);
}

/* Two equal faces d apart: E = kappa/2 area phi(d - skin), and none beyond the reach; W for one that turns.
 */
static void test_value(void **state) {
    (void)state;
    const rg_kernels *set = rg_kernels_select();
    static const double depth[] = {-0.1, 0.001, 0.1, 0.3, 0.6};
    for (size_t k = 0; k < sizeof depth / sizeof *depth; k++) {
        bunch *b = &found;
        double d = depth[k] - 0.002, r = d / 0.5, phi = d > 0 && r < 1 ? d * d * pow(1 - r * r, 2) : 0;
        memset(b, 0, sizeof *b);
        double x[18] = {0, 0, depth[k], 1, 0, depth[k], 0, 1, depth[k], 0, 0, 0, 0, 1, 0, 1, 0, 0};
        memcpy(b->corner, x, sizeof x);
        b->pair[0] = (rg_contact_pair){.face = {0, 1}, .stiffness = 3, .skin = 0.0005, .limit = 0.502};
        b->sunk[0] = 0.0015;
        meet(set, b, 1);
        assert_true(fabs(b->energy[0] - 0.5 * 3 * 0.5 * phi) <= 1e-15 * phi);
        double push = phi > 0 ? b->force[0][11] + b->force[0][14] + b->force[0][17] : 0;
        double slope = phi > 0 ? 2 * d * (1 - r * r) * (1 - 3 * r * r) : 0;
        assert_true(fabs(push - 0.5 * 3 * 0.5 * slope) <= 1e-15);
    }
}

/* ---- Friction ---- */

/* Pairs that have not met yet, rough ones and slippery ones. */
static void throw_rough_pairs(bunch *b, uint64_t seed) {
    dice d = {seed, 0};
    b->rough = false;
    throw_pairs(b, seed);
    b->rough = true;
    memset(b->grip, 0, sizeof b->grip);
    for (size_t i = 0; i < PAIRS; i++) {
        rg_contact_pair *p = &b->pair[i];
        p->friction[1] = 0.4 * dice_unit(&d);
        p->friction[0] = p->friction[1] * (1 + dice_unit(&d));
        p->shear = (0.2 + 0.3 * dice_unit(&d)) * p->stiffness;
    }
}

/* Moves corners a little. */
static void stir(bunch *b, dice *d) {
    for (size_t i = 0; i < PAIRS; i++) {
        for (int k = 0; k < 18; k++) {
            b->corner[2 * i + (size_t)k / 9][k % 9] += 0.01 * dice_sign(d);
        }
    }
}

typedef struct {
    int sticks, slides, parts, grows;
} tally;

static void count_grips(const bunch *before, const bunch *after, tally *t) {
    for (size_t i = 0; i < PAIRS; i++) {
        double k0 = before->grip[i][RG_GRIP_STIFFNESS], k = after->grip[i][RG_GRIP_STIFFNESS];
        bool slides = after->grip[i][RG_GRIP_SLIDES] > 0;
        t->sticks += k0 > 0 && k > 0 && !slides;
        t->slides += k > 0 && slides;
        t->parts += k0 > 0 && k == 0;
        t->grows += k0 > 0 && k > k0;
    }
}

static void compare_grips(const char *name, double by) {
    for (size_t i = 0; i < PAIRS; i++) {
        const double *one = found.grip[i], *two = expected.grip[i], kappa = expected.pair[i].stiffness;
        bool same = (one[RG_GRIP_STIFFNESS] > 0) == (two[RG_GRIP_STIFFNESS] > 0);
        for (int k = 0; same && k < RG_GRIP;
             k++) { /* ends of springs that are nearly nothing may be anywhere */
            double weight = k == RG_GRIP_STIFFNESS ? 1 : two[RG_GRIP_STIFFNESS];
            same = fabs(one[k] - two[k]) * weight <= by * kappa;
        }
        for (int k = 0; same && k < 18 && expected.energy[i] > 0; k++) {
            same = fabs(found.force[i][k] - expected.force[i][k]) <= by * kappa;
        }
        same = same && fabs(found.heat[i] - expected.heat[i]) <= by * kappa &&
               fabs(found.energy[i] - expected.energy[i]) <= by * kappa;
        if (!same) {
            fail_msg("%s: pair %zu, k %g, heat %g instead of k %g, heat %g", name, i, one[RG_GRIP_STIFFNESS],
                     found.heat[i], two[RG_GRIP_STIFFNESS], expected.heat[i]);
        }
    }
}

/* From the same grips on, as faces move: they begin, stick, slide, grow and part. */
static void test_friction_reference(void **state) {
    (void)state;
    const rg_kernels *sets[INPUT_SETS];
    static bunch before;
    int n = input_sets(sets, INPUT_SETS);
    dice d = {12, 0};
    tally t = {0};
    throw_rough_pairs(&before, 12);
    for (int step = 0; step < 4; step++) {
        expected = before;
        meet(&rg_kernels_reference, &expected, PAIRS);
        for (int s = 0; s < n; s++) {
            found = before;
            meet(sets[s], &found, PAIRS);
            compare_grips(sets[s]->name, 1e-14);
        }
        count_grips(&before, &expected, &t);
        before = expected;
        stir(&before, &d);
    }
    assert_true(t.sticks > PAIRS / 8 && t.slides > PAIRS / 8 && t.parts > PAIRS / 40 && t.grows > PAIRS / 8);
}

static void test_friction_momenta(void **state) {
    (void)state;
    dice d = {14, 0};
    throw_rough_pairs(&found, 14);
    for (int step = 0; step < 3; step++) {
        meet(rg_kernels_select(), &found, PAIRS);
        check_momenta();
        stir(&found, &d);
    }
}

/* A face that slides over a larger one, d deep: k = shear area, it slips at mu_s N, then mu_k N holds it back
 * and takes all of its work. Far from the origin, askew. */
static void test_friction_value(void **state) {
    (void)state;
    const rg_kernels *set = rg_kernels_select();
    static const double shear = 0.8, kinetic = 0.2, rest = 0.3, way[2] = {0.6, 0.8};
    dice d = {13, 0};
    static const double normal = 3 * 0.5 * 0.01 * (1 - 4e-4) * (1 - 12e-4);
    double R[3][3], work = 0, last = 0, heat = 0;
    bool slides = false;
    bunch *b = &found;
    dice_rotation(&d, R);
    memset(b, 0, sizeof *b);
    b->rough = true;
    b->pair[0] = (rg_contact_pair){
        .face = {0, 1}, .stiffness = 3, .limit = 0.5, .shear = shear, .friction = {rest, kinetic}};
    for (int step = 0; step < 60; step++) {
        double p[6][3] = {{0, 0, 0.01}, {1, 0, 0.01}, {0, 1, 0.01}, {-3, -3, 0}, {-3, 9, 0}, {9, -3, 0}};
        double moved = 1e-3 * step;
        for (int i = 0; i < 6; i++) {
            for (int c = 0; c < 2 && i < 3; c++) {
                p[i][c] += moved * way[c];
            }
            for (int c = 0; c < 3; c++) {
                b->corner[i / 3][3 * (i % 3) + c] =
                    10 + R[c][0] * p[i][0] + R[c][1] * p[i][1] + R[c][2] * p[i][2];
            }
        }
        meet(set, b, 1);
        double drag[3] = {0, 0, 0};
        for (int k = 0; k < 9; k++) {
            for (int c = 0; c < 3; c++) {
                drag[c] -= R[k % 3][c] * b->force[0][k];
            }
        }
        double pull = drag[0] * way[0] + drag[1] * way[1], spring = shear * 0.5 * moved;
        slides = slides || spring > rest * normal;
        assert_true(near(pull, slides ? kinetic * normal : spring, 1e-14));
        assert_true(near(-drag[2], -normal, 1e-14));
        assert_true(near(drag[0] * way[1] - drag[1] * way[0], 0, 1e-14));
        work += step > 0 ? 0.5 * (last + pull) * 1e-3 : 0;
        heat += b->heat[0];
        last = pull;
    }
    double stored = 0.5 * pow(kinetic * normal, 2) / (0.5 * shear);
    assert_true(slides && near(heat, work - stored, 1e-14) && heat > 5 * stored);
}

/* ---- Damping ---- */

/* Pairs whose corners move, some so fast that the force is none or twice as large, some pressed so hard that
 * the impedance bounds what is taken. */
static void throw_damped_pairs(bunch *b, uint64_t seed) {
    dice d = {seed, 0};
    throw_rough_pairs(b, seed);
    b->damping = 0.7;
    for (size_t i = 0; i < PAIRS; i++) {
        b->pair[i].impedance = 0.3 * dice_unit(&d);
        for (int k = 0; k < 18; k++) {
            b->rate[2 * i + (size_t)k / 9][k % 9] = 2 * dice_sign(&d);
        }
    }
}

static void test_damping_reference(void **state) {
    (void)state;
    const rg_kernels *sets[INPUT_SETS];
    static bunch before;
    int n = input_sets(sets, INPUT_SETS), whole = 0, none = 0, between = 0;
    throw_damped_pairs(&before, 15);
    expected = before;
    meet(&rg_kernels_reference, &expected, PAIRS);
    for (int s = 0; s < n; s++) {
        found = before;
        meet(sets[s], &found, PAIRS);
        compare_grips(sets[s]->name, 1e-14);
        for (size_t i = 0; i < PAIRS; i++) {
            double kappa = expected.pair[i].stiffness;
            for (int k = 0; k < 18 && expected.energy[i] > 0; k++) {
                assert_true(near(found.drag[i][k], expected.drag[i][k], 1e-13 * kappa));
            }
            assert_true(!(expected.energy[i] > 0) ||
                        near(found.stiffer[i], expected.stiffer[i], 1e-12 * kappa));
        }
    }
    for (size_t i = 0; i < PAIRS; i++) { /* it takes energy, and never pulls */
        double power = 0, size = 0;
        for (int k = 0; k < 18 && expected.energy[i] > 0; k++) {
            power += expected.drag[i][k] * expected.rate[2 * i + (size_t)k / 9][k % 9];
            size += fabs(expected.drag[i][k]);
        }
        assert_true(power <= 1e-15);
        none += size == 0;
        whole += expected.stiffer[i] > 1.99 * expected.pair[i].stiffness;
        between += size > 0;
    }
    assert_true(between > 1000 && whole > 100 && none > 100);
}

static void test_damping_momenta(void **state) {
    (void)state;
    throw_damped_pairs(&found, 16);
    meet(rg_kernels_select(), &found, PAIRS);
    check_momenta();
}

/* A face that sinks into a larger one: N (1 + c d') until the impedance says less, and for B and the step. */
static void test_damping_value(void **state) {
    (void)state;
    static const double x[18] = {0, 0, 0.01, 1, 0, 0.01, 0, 1, 0.01, -3, -3, 0, -3, 9, 0, 9, -3, 0};
    static const double normal = 3 * 0.5 * 0.01 * (1 - 4e-4) * (1 - 12e-4);
    static const double rate[] = {-9, -0.5, 0, 0.5, 1.2, 9}, q[] = {-1, -0.35, 0, 0.35, 0.84, 1};
    bunch *b = &found;
    memset(b, 0, sizeof *b);
    memcpy(b->corner, x, sizeof x);
    b->damping = 0.7;
    b->pair[0] = (rg_contact_pair){.face = {0, 1}, .stiffness = 3, .limit = 0.5, .impedance = 1};
    for (int k = 0; k < 12; k++) {
        double most = k < 6 ? 1 : 0.25 * 0.7 * normal / 0.5; /* a quarter of c N over the area */
        double factor = k < 6 ? q[k] : fmax(-1, fmin(1, 0.25 * 0.7 * rate[k - 6]));
        b->pair[0].impedance = most;
        for (int i = 0; i < 3; i++) {
            b->rate[0][3 * i + 2] = 3 + rate[k % 6];
            b->rate[1][3 * i + 2] = 3;
        }
        meet(rg_kernels_select(), b, 1);
        double push = b->force[0][11] + b->force[0][14] + b->force[0][17];
        double drag = b->drag[0][11] + b->drag[0][14] + b->drag[0][17];
        assert_true(near(push, (1 + factor) * normal, 1e-14));
        assert_true(near(drag, factor * normal, 1e-14));
        double taken = fmin(0.7 * normal / 0.5, most);
        assert_true(near(b->stiffer[0], 3 * (1 + fmax(factor, 0)) + 2 * taken / 0.5, 1e-13));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_reference),
        cmocka_unit_test(test_gradient),
        cmocka_unit_test(test_momenta),
        cmocka_unit_test(test_exchange),
        cmocka_unit_test(test_cut),
        cmocka_unit_test(test_edges_along_each_other),
        cmocka_unit_test(test_value),
        cmocka_unit_test(test_friction_reference),
        cmocka_unit_test(test_friction_momenta),
        cmocka_unit_test(test_friction_value),
        cmocka_unit_test(test_damping_reference),
        cmocka_unit_test(test_damping_momenta),
        cmocka_unit_test(test_damping_value),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
