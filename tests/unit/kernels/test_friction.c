/* Coulomb friction in the interface kernels: never a gain of energy, and nothing that a rotation of the body
 * would change. That the kernels compute it as the scalar reference does is in test_laws.c. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/hash.h"
#include "support/figures.h"
#include "support/kernel_input.h"

/* What rounding of displacements as large as the body does to springs and forces; in floats also with the
 * reference, which computes in doubles. */
#define TURNED (sizeof(rg_real) == sizeof(double) ? 4e-12 : 1.3e-3)

enum {
    SEEDS = 10,
    PATH_STEPS = 20, /* 10 times 1044 points on 10,000 paths */
    TURNS = 12,
    STRIDE = RG_CRACK_BLOCK + RG_FRICTION_BLOCK,
    NODES = INPUT_EBLOCKS * RG_NODE_BLOCK,
};

static const rg_cohesive law = {.strength = 4e8,
                                .opening = 1.7e-7,
                                .separation = 1.7e-7,
                                .beta = 1,
                                .activation = RG_ACTIVATION_TOTAL,
                                .sliding = RG_SLIDING_COULOMB,
                                .friction = 0.4};

/* A mesh of which every point is broken, its displacement on its way, and what the kernel keeps. */
typedef struct {
    input *in;
    rg_real *u, *crack, *force;
    rg_interface_args args;
} body;

/* Openings count from zero, as with the thesis's activation. */
static body body_make(uint64_t seed) {
    body b = {.in = input_make(INPUT_SMALL, law, seed, 3),
              .u = input_alloc(NODES * sizeof *b.u),
              .crack = input_alloc(INPUT_IBLOCKS * STRIDE * sizeof *b.crack),
              .force = input_alloc(INPUT_IBLOCKS * RG_IFORCE_BLOCK * sizeof *b.force)};
    input_break(b.in, 1);
    b.args = input_interface_args(b.in, b.in->broken, b.in->unlinked, b.in->active, b.crack, b.force);
    b.args.crack_stride = STRIDE;
    b.args.u = b.u;
    memcpy(b.u, b.in->u, NODES * sizeof *b.u);
    return b;
}

static void body_free(body *b) {
    input_free(b->in);
    free(b->u);
    free(b->crack);
    free(b->force);
}

static double friction(const body *b, size_t i, int q, int k) {
    return b->crack[rg_friction_index(b->in->slot[i], q, k, STRIDE)];
}

static double stretch(const body *b, size_t i, int q) {
    return hypot(friction(b, i, q, RG_FRICTION_STRETCH), friction(b, i, q, RG_FRICTION_STRETCH + 1));
}

/* Each node goes its own way, by about a tenth of the critical opening a step. */
static void wander(body *b, uint64_t seed, int step) {
    for (size_t k = 0; k < NODES; k++) {
        uint64_t h = rg_hash(rg_hash(seed, (uint64_t)step), k);
        b->u[k] += (rg_real)(0.2 * law.opening * (rg_hash_uniform(h) - 0.5));
    }
}

/* How often points stuck, slid and were open; what friction has dissipated never falls. */
typedef struct {
    size_t stuck, slid, open;
} tally;

static void look(const body *b, double heat[INPUT_INTERFACES][RG_POINTS], tally *t) {
    for (size_t i = 0; i < INPUT_INTERFACES; i++)
        for (int q = 0; q < RG_POINTS; q++) {
            double now = friction(b, i, q, RG_FRICTION_HEAT);
            assert_true(now >= heat[i][q]);
            t->open += stretch(b, i, q) <= 0;
            t->slid += stretch(b, i, q) > 0 && now > heat[i][q];
            t->stuck += stretch(b, i, q) > 0 && now <= heat[i][q];
            heat[i][q] = now;
        }
}

static void test_never_negative(void **state) {
    const rg_kernels *sets[INPUT_SETS];
    int n = input_sets(sets, INPUT_SETS);
    tally t = {0, 0, 0};
    (void)state;
    for (uint64_t seed = 1; seed <= SEEDS; seed++) {
        body b = body_make(seed);
        double heat[INPUT_INTERFACES][RG_POINTS] = {{0}};
        for (int step = 0; step < PATH_STEPS; step++) {
            wander(&b, seed, step);
            sets[seed % (uint64_t)n]->interface(&b.args, 0, INPUT_IBLOCKS);
            look(&b, heat, &t);
        }
        body_free(&b);
    }
    size_t all = t.stuck + t.slid + t.open;
    assert_true(t.stuck > all / 50 && t.slid > all / 50 && t.open > all / 50);
}

/* u <- R (X + u) - X, R a turn by `angle` about (1, 2, 3). */
static void turn(body *b, double angle, double r[3][3]) {
    const double length = sqrt(14), a[3] = {1 / length, 2 / length, 3 / length};
    const double c = cos(angle), s = sin(angle);
    const double cross[3][3] = {{0, -a[2], a[1]}, {a[2], 0, -a[0]}, {-a[1], a[0], 0}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            r[i][j] = (i == j ? c : 0) + (1 - c) * a[i] * a[j] + s * cross[i][j];
    for (size_t e = 0; e < INPUT_ELEMENTS; e++)
        for (int n = 0; n < RG_NODES; n++) {
            const double *x = b->in->x[e][n];
            double now[3];
            for (int i = 0; i < 3; i++)
                now[i] = x[i] + b->in->u[rg_node_index(b->in->element[e], n, i)];
            for (int i = 0; i < 3; i++)
                b->u[rg_node_index(b->in->element[e], n, i)] =
                    (rg_real)(r[i][0] * now[0] + r[i][1] * now[1] + r[i][2] * now[2] - x[i]);
        }
}

/* Largest value of the force, and its largest difference from r times `before`. */
static double force_error(const body *b, const rg_real *before, double r[3][3], double *most) {
    double worst = 0;
    *most = 0;
    for (size_t i = 0; i < INPUT_INTERFACES; i++)
        for (int a = 0; a < RG_FNODES; a++)
            for (int c = 0; c < 3; c++) {
                double turned = 0;
                for (int d = 0; d < 3; d++)
                    turned += r[c][d] * before[rg_iforce_index(b->in->slot[i], a, d)];
                *most = fmax(*most, fabs(turned));
                worst = fmax(worst, fabs(b->force[rg_iforce_index(b->in->slot[i], a, c)] - turned));
            }
    return worst;
}

/* Points that stick and points that have slid keep their springs, and dissipate nothing, while the body
 * turns; its forces turn along. */
static void test_objectivity(void **state) {
    const rg_kernels *sets[INPUT_SETS];
    int n = input_sets(sets, INPUT_SETS);
    double springs = 0, heat = 0, forces = 0; /* largest changes, relative to the largest of their kind */
    (void)state;
    for (int set = 0; set < n; set++) {
        body b = body_make(5);
        sets[set]->interface(&b.args, 0, INPUT_IBLOCKS);
        rg_real *crack = input_alloc(INPUT_IBLOCKS * STRIDE * sizeof *crack),
                *force = input_alloc(INPUT_IBLOCKS * RG_IFORCE_BLOCK * sizeof *force);
        memcpy(crack, b.crack, INPUT_IBLOCKS * STRIDE * sizeof *crack);
        memcpy(force, b.force, INPUT_IBLOCKS * RG_IFORCE_BLOCK * sizeof *force);
        double r[3][3], most[RG_FRICTION] = {0}, worst[RG_FRICTION] = {0}, force_most;
        for (int k = 1; k <= TURNS; k++) {
            turn(&b, 0.25 * k, r);
            sets[set]->interface(&b.args, 0, INPUT_IBLOCKS);
        }
        for (size_t i = 0; i < INPUT_INTERFACES; i++)
            for (int q = 0; q < RG_POINTS; q++)
                for (int k = 0; k < RG_FRICTION; k++) {
                    double before = crack[rg_friction_index(b.in->slot[i], q, k, STRIDE)];
                    most[k] = fmax(most[k], fabs(before));
                    worst[k] = fmax(worst[k], fabs(friction(&b, i, q, k) - before));
                }
        for (int k = 0; k < RG_FRICTION; k++) {
            double *kind = k == RG_FRICTION_HEAT ? &heat : &springs;
            assert_true(most[k] > 0);
            *kind = fmax(*kind, worst[k] / most[k]);
        }
        double error = force_error(&b, force, r, &force_most);
        forces = fmax(forces, error / force_most);
        free(crack);
        free(force);
        body_free(&b);
    }
    assert_true(state_figure((figure){"friction turned by 3 rad: change of springs", .found = springs,
                                      .bound = TURNED, .why = ROUNDING}));
    assert_true(state_figure((figure){"friction turned by 3 rad: heat of the turn", .found = heat,
                                      .bound = TURNED, .why = ROUNDING}));
    assert_true(state_figure((figure){"friction turned by 3 rad: change of forces that turn along",
                                      .found = forces, .bound = TURNED, .why = ROUNDING}));
}

/* ---- With contact as a potential ---- */

/* Points far below the surface and far along it, by some 4 and 40 % of the root of their area: there what
 * turns with the mid-surface weighs as much as what acts along the opening. Failed, so contact and friction
 * act alone; springs are relaxed somewhere aside, so that they do not pull along the slip. */
static void press(body *b, double coefficient) {
    static const double w[2] = {-15, 150};
    b->in->law.contact = RG_CONTACT_POTENTIAL;
    b->args.law.contact = RG_CONTACT_POTENTIAL;
    b->args.law.friction = coefficient;
    memset(b->crack, 0, INPUT_IBLOCKS * STRIDE * sizeof *b->crack);
    for (size_t i = 0; i < INPUT_INTERFACES; i++)
        for (int q = 0; q < RG_POINTS; q++)
            input_break_point(b->in, i, q, w, 10);
    for (size_t k = 0; k < INPUT_IBLOCKS; k++)
        memcpy(b->crack + k * STRIDE, b->in->crack + k * RG_CRACK_BLOCK, RG_CRACK_BLOCK * sizeof *b->crack);
    for (size_t i = 0; i < INPUT_INTERFACES; i++)
        for (int k = 0; k < 2 * RG_POINTS; k++) {
            size_t at = rg_friction_index(b->in->slot[i], k / 2, RG_FRICTION_ANCHOR + k % 2, STRIDE);
            b->crack[at] = (rg_real)(100 * law.opening * (rg_hash_uniform(rg_hash(12, at)) - 0.5));
        }
}

/* Sum over the nodes of all elements of what faces do to them, times `way` (moments: about the origin, one
 * component). */
static double over_nodes(const body *b, double (*way)(const body *b, size_t slot, int node, int c)) {
    double sum = 0;
    for (size_t i = 0; i < INPUT_INTERFACES; i++)
        for (int k = 0; k < 2 * RG_FNODES * 3; k++) {
            int side = k / (RG_FNODES * 3), a = k / 3 % RG_FNODES, c = k % 3;
            size_t s = b->in->slot[i], at = rg_iforce_index(s, a, c);
            int32_t link = b->in->side[side][s];
            double force = (side == 0 ? 1 : -1) * (double)b->force[at] + (double)b->args.turn[at];
            sum += force * way(b, (size_t)link / RG_FACES, rg_face_node[link % RG_FACES][a], c);
        }
    return sum;
}

static double random_way(const body *b, size_t slot, int node, int c) {
    (void)b;
    return 2 * rg_hash_uniform(rg_hash(11, rg_node_index(slot, node, c))) - 1;
}

/* What a face stores. */
static double stored(body *b, const rg_kernels *set) {
    double *energy = input_alloc(INPUT_ISLOTS * RG_E_INTERFACE * sizeof *energy), sum = 0;
    set->interface(&b->args, 0, INPUT_IBLOCKS);
    set->interface_state(&(rg_interface_state_args){&b->args, energy}, 0, INPUT_IBLOCKS);
    for (size_t i = 0; i < INPUT_INTERFACES; i++)
        for (int k = 0; k < RG_E_INTERFACE; k++) {
            size_t s = b->in->slot[i];
            sum += k == RG_E_DISSIPATED
                       ? 0
                       : energy[(s / RG_LANES * RG_E_INTERFACE + (size_t)k) * RG_LANES + s % RG_LANES];
        }
    free(energy);
    return sum;
}

static void move(body *b, double by) {
    for (size_t e = 0; e < INPUT_ELEMENTS; e++)
        for (int k = 0; k < 3 * RG_NODES; k++) {
            size_t slot = b->in->element[e], at = rg_node_index(slot, k / 3, k % 3);
            b->u[at] = (rg_real)(b->in->u[at] + by * random_way(b, slot, k / 3, k % 3));
        }
}

/* Springs that nothing makes slide are a potential: forces are what a central difference of the energy says,
 * to the square of its step. */
static void test_gradient(void **state) {
    const rg_kernels *sets[INPUT_SETS];
    int n = input_sets(sets, INPUT_SETS);
    double worst = 0;
    const double step = sizeof(rg_real) == 8 ? 1e-10 : 1e-8; /* m */
    (void)state;
    for (int set = 0; set < n; set++) {
        body b = body_make(5);
        rg_real *turned = input_alloc(INPUT_IBLOCKS * RG_IFORCE_BLOCK * sizeof *turned);
        b.args.turn = turned;
        double energy[2];
        for (int k = 0; k < 2; k++) {
            press(&b, 1e6);
            move(&b, k == 0 ? step : -step);
            energy[k] = stored(&b, sets[set]);
        }
        press(&b, 1e6);
        move(&b, 0);
        double all = stored(&b, sets[set]), work = over_nodes(&b, random_way);
        assert_true(all > 0);
        worst = fmax(worst, fabs((energy[1] - energy[0]) / (2 * step) / work - 1));
        free(turned);
        body_free(&b);
    }
    assert_true(
        state_figure((figure){"friction with contact as a potential: force against gradient", .found = worst,
                              .bound = sizeof(rg_real) == 8 ? 8e-9 : 2e-2, .why = "difference of energies"}));
}

/* Lever arms of a moment about x, y, z. */
static int axis;
static double lever(const body *b, size_t slot, int node, int c) {
    size_t e = 0;
    while (b->in->element[e] != slot)
        e++;
    if (c == axis)
        return 0;
    int other = 3 - c - axis; /* M = X x F: M_axis gets +-X_other F_c */
    double x = b->in->x[e][node][other] + b->u[rg_node_index(slot, node, other)];
    return (axis + 1) % 3 == other ? x : -x;
}

/* Sides that stick or slide, at a distance, exert no moment. Openings count from 0 here: an origin does not
 * turn with the body, which in a run is of no matter, for it is as small as the jump of an intact face. */
static void test_moment(void **state) {
    const rg_kernels *sets[INPUT_SETS];
    int n = input_sets(sets, INPUT_SETS);
    double worst = 0;
    (void)state;
    for (int set = 0; set < n; set++) {
        body b = body_make(5);
        rg_real *turned = input_alloc(INPUT_IBLOCKS * RG_IFORCE_BLOCK * sizeof *turned);
        b.args.turn = turned;
        press(&b, 0.4);
        move(&b, 0);
        for (size_t i = 0; i < INPUT_INTERFACES; i++)
            for (int k = 0; k < RG_POINTS * 3; k++) {
                size_t slot = b.in->slot[i],
                       at = rg_crack_index(slot % RG_LANES, k / 3, RG_CRACK_ORIGIN + k % 3);
                b.crack[slot / RG_LANES * STRIDE + at] = 0;
            }
        stored(&b, sets[set]);
        double scale = 0;
        for (size_t k = 0; k < INPUT_IBLOCKS * RG_IFORCE_BLOCK; k++)
            scale = fmax(scale, fabs((double)b.force[k]));
        for (axis = 0; axis < 3; axis++)
            worst = fmax(worst, fabs(over_nodes(&b, lever)) / (scale * 4 * INPUT_SIZE * INPUT_INTERFACES));
        free(turned);
        body_free(&b);
    }
    assert_true(
        state_figure((figure){"friction with contact as a potential: moment of both sides", .found = worst,
                              .bound = sizeof(rg_real) == 8 ? 1.3e-17 : 1e-8, .why = ROUNDING}));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_never_negative),
        cmocka_unit_test(test_objectivity),
        cmocka_unit_test(test_gradient),
        cmocka_unit_test(test_moment),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
