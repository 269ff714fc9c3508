/* Every cohesive law of the registry, also under a conserving activation where it can be: its scalar form
 * against closed-form theory, then the kernels of every instruction set against the scalar form on random
 * states. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/hash.h"
#include "cohesive/facts.h"
#include "reference/cohesive.h"
#include "support/figures.h"
#include "support/kernel_input.h"
#include "support/precision.h"

#define SIGMA 4e8
#define DELTA 1.7e-7

enum { PATHS = 10000, PATH_STEPS = 20, STATES = 2000 };

/* A law under test. */
typedef struct {
    rg_law law;
    double shape[RG_LAW_SHAPE];
    double beta;
    double onset; /* of a conserving activation (m); 0: none */
    rg_law_facts facts;
} subject;

/* Parameters of its own: the defaults, or all a fifth off them, within their range. */
static void own_parameters(rg_law law, bool off, double shape[RG_LAW_SHAPE]) {
    memset(shape, 0, RG_LAW_SHAPE * sizeof *shape);
#define RG_LAW_PARAMETER(NAME, index, word, unit, low, high, fallback, meaning)                              \
    if (law == RG_LAW_##NAME)                                                                                \
        shape[index] = off ? 0.8 * fallback + 0.2 * fmin(1, high) : fallback;
#include "laws.h"
#undef RG_LAW_PARAMETER
}

/* `onset` in critical openings, of laws that can be conserving. */
static subject make_subject(rg_law law, bool off, double beta, double onset) {
    subject s = {.law = law, .beta = beta};
    own_parameters(law, off, s.shape);
    s.facts = rg_law_facts_of(law, s.shape, beta);
    if (s.facts.forms & RG_NORMAL_MEASURE)
        s.beta = 0;
    s.onset = (s.facts.forms & RG_ENVELOPE) != 0 ? onset * DELTA : 0;
    return s;
}

/* Every law with three sets of parameters, and two onsets where it has one. */
static void for_each_law(void (*test)(const subject *s)) {
    for (int law = 0; law < (int)RG_LAWS; law++) {
        const subject all[] = {make_subject((rg_law)law, false, 1, 0), make_subject((rg_law)law, true, 2, 0),
                               make_subject((rg_law)law, true, 0.5, 0),
                               make_subject((rg_law)law, true, 2, 0.1),
                               make_subject((rg_law)law, true, 0.5, 0.7)};
        for (size_t k = 0; k < sizeof all / sizeof *all; k++)
            if (k < 3 || all[k].onset > 0)
                test(&all[k]);
    }
}

static rg_law_query query_of(const subject *s, double normal, double sliding) {
    return (rg_law_query){SIGMA, DELTA,  s->shape, s->beta,
                          1e-9,  normal, sliding,  hypot(s->beta * sliding, fmax(0, normal)),
                          0,     0};
}

/* The answer at an opening; the state moves on. */
static rg_law_answer ask(const subject *s, double normal, double sliding, double state[1 + RG_LAW_MEMORY]) {
    rg_law_query q = query_of(s, normal, sliding);
    q.before = state[0];
    if (s->onset > 0)
        return rg_reference_conserving(s->law, &q, s->onset, state);
    state[0] = fmax(state[0], q.effective);
    return rg_reference_law(s->law, &q, state);
}

/* The answer at an opening after one as large as `largest`; no memory besides. */
static rg_law_answer ask_at(const subject *s, double normal, double sliding, double largest) {
    double state[1 + RG_LAW_MEMORY] = {largest - s->onset};
    return ask(s, normal, sliding, state);
}

static double random_in(uint64_t *key, double low, double high) {
    *key = rg_hash(*key, 1);
    return low + (high - low) * rg_hash_uniform(*key);
}

/* Tolerances are a few times what rounding leaves, with either compiler and on all instruction sets. */
static void expect_near(const subject *s, const char *what, double got, double expected, double tolerance) {
    if (!(fabs(got - expected) <= tolerance))
        fail_msg("%s, beta %g, onset %g: %s is %.12g instead of %.12g", s->facts.word, s->beta, s->onset,
                 what, got, expected);
}

/* ---- Work of separation ---- */

/* Traction along the way of pure opening, or of pure sliding. */
static double traction(const subject *s, bool slide, double x) {
    rg_law_answer a = ask_at(s, slide ? 0 : x, slide ? x : 0, 0);
    return slide ? a.sliding : a.normal;
}

/* Gauss's rule of five points in each of `panels`. */
static double work(const subject *s, bool slide, double from, double to, int panels) {
    static const double at[5] = {-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831,
                                 0.9061798459386640};
    static const double weight[5] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                     0.4786286704993665, 0.2369268850561891};
    double sum = 0, half = (to - from) / panels / 2;
    for (int k = 0; k < 5 * panels; k++)
        sum += weight[k % 5] * half * traction(s, slide, from + half * (2 * (k / 5) + 1 + at[k % 5]));
    return sum;
}

static void check_work(const subject *s) {
    double expected = s->facts.work * SIGMA * DELTA, unit = SIGMA * DELTA;
    double start = s->onset, last = DELTA + start;
    double opening = work(s, false, start, last, 10000) + work(s, false, last, 60 * DELTA, 20000);
    expect_near(s, "work of opening", opening, expected, 1e-12 * unit);
    if (s->beta > 0) { /* q is the ratio of the two where the law has it */
        double q = s->law == RG_LAW_XU_NEEDLEMAN ? s->shape[0] : 1, end = last / s->beta;
        double sliding = work(s, true, start / s->beta, end, 10000) + work(s, true, end, 60 * end, 20000);
        expect_near(s, "work of sliding", sliding, q * expected, 1e-12 * unit);
    }
}

static void test_work(void **state) {
    (void)state;
    for_each_law(check_work);
}

/* ---- Potential: at a fixed history the traction is the derivative of what is stored ---- */

/* Central differences of stored energy and tractions. */
typedef struct {
    double normal, sliding; /* of the energy */
    double cross[2];        /* dT_n/dD_t, dT_t/dD_n */
} derivatives;

static derivatives differentiate(const subject *s, double normal, double sliding, double largest) {
    double h = 1e-5 * DELTA;
    rg_law_answer up = ask_at(s, normal + h, sliding, largest),
                  down = ask_at(s, normal - h, sliding, largest);
    rg_law_answer right = ask_at(s, normal, sliding + h, largest),
                  left = ask_at(s, normal, sliding - h, largest);
    return (derivatives){(up.stored - down.stored) / (2 * h),
                         (right.stored - left.stored) / (2 * h),
                         {(right.normal - left.normal) / (2 * h), (up.sliding - down.sliding) / (2 * h)}};
}

static void check_potential(const subject *s) {
    uint64_t key = 5;
    for (int k = 0; k < STATES; k++) {
        double normal = random_in(&key, 0.01, 1.2) * DELTA, sliding = random_in(&key, 0.01, 1.2) * DELTA;
        rg_law_query q = query_of(s, normal, sliding);
        double largest = q.effective * random_in(&key, 1.01, 3);
        rg_law_answer a = ask_at(s, normal, sliding, largest);
        derivatives d = differentiate(s, normal, sliding, largest);
        double stiff = fmax(1, s->facts.slope[0] + s->facts.slope[1]) * SIGMA;
        expect_near(s, "derivative along the normal", d.normal, a.normal, 2e-9 * stiff);
        expect_near(s, "derivative along sliding", d.sliding, a.sliding, 3e-10 * stiff);
        expect_near(s, "mixed derivative", d.cross[0], d.cross[1], 3e-9 * stiff / DELTA);
    }
}

static void test_potential(void **state) {
    (void)state;
    for_each_law(check_potential);
}

/* ---- Dissipation ---- */

/* What is dissipated never comes back. */
static void walk(const subject *s, uint64_t key) {
    double state[1 + RG_LAW_MEMORY] = {1e-12 * DELTA};
    double unit = SIGMA * DELTA * fmax(1, s->facts.work), reach = random_in(&key, 0.2, 2) * DELTA;
    double least = -SIGMA * s->onset / 2; /* stored: from the switch on */
    rg_law_answer last = ask(s, 0, 0, state);
    for (int step = 0; step < PATH_STEPS; step++) {
        double normal = random_in(&key, -0.2, 1) * reach, sliding = random_in(&key, 0, 1) * reach;
        rg_law_answer now = ask(s, normal, sliding, state);
        if (!(now.dissipated >= last.dissipated - 1e-12 * unit) || !(now.stored >= least - 1e-12 * unit))
            fail_msg("%s, onset %g: dissipated %g after %g, stored %g", s->facts.word, s->onset,
                     now.dissipated, last.dissipated, now.stored);
        last = now;
    }
}

static void check_dissipation(const subject *s) {
    for (uint64_t path = 0; path < PATHS; path++)
        walk(s, rg_hash(77, path));
}

static void test_dissipation(void **state) {
    (void)state;
    for (int law = 0; law < (int)RG_LAWS; law++) {
        for (int k = 0; k < 2; k++) {
            subject s = make_subject((rg_law)law, true, 1, 0.3 * k);
            if (k == 0 || s.onset > 0)
                check_dissipation(&s);
        }
    }
}

/* A fine path: work taken up equals energy stored and dissipated to the order of the rule. */
static void check_balance(const subject *s) {
    enum { FINE = 200000 };
    double state[1 + RG_LAW_MEMORY] = {1e-9 * DELTA}, taken = 0, n = 0, t = 0;
    rg_law_answer last = ask(s, 0, 0, state);
    double begin = last.stored + last.dissipated;
    for (int k = 1; k <= FINE; k++) { /* out, half back, out again, further aside */
        double a = 4.0 * k / FINE, way = a < 1 ? a : a < 2 ? 1.5 - a / 2 : a < 3 ? a / 2 - 0.5 : a - 2;
        double to_n = 0.6 * way * DELTA, to_t = 0.3 * way * way * DELTA;
        rg_law_answer now = ask(s, to_n, to_t, state);
        taken += (last.normal + now.normal) / 2 * (to_n - n) + (last.sliding + now.sliding) / 2 * (to_t - t);
        last = now;
        n = to_n;
        t = to_t;
    }
    double unit = SIGMA * DELTA * fmax(0.5, s->facts.work);
    expect_near(s, "energy of a fine path", last.stored + last.dissipated - begin, taken, 3e-4 * unit);
}

static void test_balance(void **state) {
    (void)state;
    for_each_law(check_balance);
}

/* ---- Laws with a memory ---- */

/* Opened at a constant rate, the work of separation is (1 + (v/v_0)^n) times that of slow opening. */
static void check_rate(double onset) {
    subject s = make_subject(RG_LAW_RATE, true, 1, onset);
    enum { STEPS = 2000 };
    double memory[1 + RG_LAW_MEMORY] = {1e-9 * DELTA}, reach = 4 * DELTA, speed = reach / STEPS / 1e-9;
    rg_law_answer a = ask(&s, 0, 0, memory);
    for (int k = 1; k <= STEPS; k++)
        a = ask(&s, reach * k / STEPS, 0, memory);
    double expected = SIGMA * DELTA / 2 * (1 + pow(speed / s.shape[0], s.shape[1]));
    assert_true(expected > 1.03 * SIGMA * DELTA / 2);
    expect_near(&s, "work at a rate", a.dissipated, expected, 3e-3 * expected);
}

static void test_rate(void **state) {
    (void)state;
    check_rate(0);
    check_rate(0.3);
}

/* Cycles to the same opening beyond the onset wear the point: each peak is lower, by what the equations say
 * for the first. */
static void check_fatigue(double onset) {
    subject s = make_subject(RG_LAW_FATIGUE, false, 1, onset);
    double memory[1 + RG_LAW_MEMORY] = {1e-9 * DELTA}, top = 0.4 * DELTA + s.onset, far = s.shape[0] * DELTA;
    double worn = top - s.onset, peak[4];
    ask(&s, s.onset, 0, memory);
    for (int cycle = 0; cycle < 4; cycle++) {
        for (int k = 1; k <= 1000; k++)
            peak[cycle] = ask(&s, top * k / 1000, 0, memory).normal;
        for (int k = 999; k >= 0; k--)
            ask(&s, top * k / 1000, 0, memory);
    }
    double again = 0.6 * SIGMA / top * (s.onset + far * (1 - exp(-worn / far)));
    expect_near(&s, "first peak", peak[0], 0.6 * SIGMA, 2e-15 * SIGMA);
    expect_near(&s, "second peak", peak[1], again, (onset > 0 ? 4e-7 : 1e-13) * SIGMA);
    assert_true(peak[2] < 0.99 * peak[1] && peak[3] < 0.99 * peak[2] && peak[3] > 0);
}

/* Below the onset of a conserving activation nothing is worn: what a point gave there it gets again. */
static void check_fatigue_below_the_onset(void) {
    subject s = make_subject(RG_LAW_FATIGUE, false, 1, 0.3);
    double memory[1 + RG_LAW_MEMORY] = {1e-12 * DELTA};
    rg_law_answer first = ask(&s, s.onset, 0, memory), last = first;
    for (int cycle = 0; cycle < 4; cycle++) {
        expect_near(&s, "stored at rest", ask(&s, 0, 0, memory).stored, -SIGMA * s.onset / 2,
                    1e-12 * SIGMA * DELTA);
        last = ask(&s, s.onset, 0, memory);
    }
    expect_near(&s, "traction after cycles", last.normal, first.normal, 1e-15 * SIGMA);
    expect_near(&s, "dissipated by them", last.dissipated, first.dissipated, 1e-15 * SIGMA * DELTA);
}

static void test_fatigue(void **state) {
    (void)state;
    check_fatigue(0);
    check_fatigue(0.3);
    check_fatigue_below_the_onset();
}

/* ---- Stiffness ---- */

static void check_stiffness(const subject *s) {
    const double bound[2] = {s->facts.slope[0] * SIGMA / DELTA, s->facts.slope[1] * SIGMA / DELTA};
    const bool by_opening = (s->facts.forms & RG_NORMAL_MEASURE) != 0;
    uint64_t key = 9;
    double h = 1e-6 * DELTA;
    if (!(s->facts.forms & RG_FORMS_INTRINSIC))
        return;
    for (int k = 0; k < STATES; k++) {
        double aside = by_opening ? 0.29 : 1.5; /* for which the bound is given */
        double normal = random_in(&key, 1e-4, 1.5) * DELTA, sliding = random_in(&key, 1e-4, aside) * DELTA;
        double largest = random_in(&key, 0, 2) * DELTA;
        rg_law_answer a = ask_at(s, normal, sliding, largest), up = ask_at(s, normal + h, sliding, largest);
        if (!(a.normal / normal <= bound[0] * (1 + 1e-9) && a.sliding / sliding <= bound[1] * (1 + 1e-9) &&
              (up.normal - a.normal) / h <= bound[0] * (1 + 1e-4) + 1e-4 * SIGMA / DELTA))
            fail_msg("%s: stiffer than %g and %g at %g, %g after %g", s->facts.word, bound[0], bound[1],
                     normal, sliding, largest);
    }
    double first = ask_at(s, 1e-6 * DELTA, 0, 0).normal / (1e-6 * DELTA);
    bool above = by_opening || (s->law == RG_LAW_XU_NEEDLEMAN && s->shape[0] < 1); /* room for coupling */
    if (!above)
        expect_near(s, "first slope", first, bound[0], 6e-6 * bound[0]);
}

static void test_stiffness(void **state) {
    (void)state;
    for_each_law(check_stiffness);
}

/* A conserving law answers as the law does at the damage; is at most strength over onset stiff, which it is
 * before the first damage; and where it opens, work done since the switch is what it has stored and
 * dissipated. */
static void check_conserving(const subject *s) {
    uint64_t key = 13;
    double bound = SIGMA / s->onset;
    for (int k = 0; k < STATES && s->onset > 0; k++) {
        double damage = random_in(&key, 1e-6, 1.2) * DELTA, part = random_in(&key, 0, 1);
        double largest = s->onset + damage, sliding = random_in(&key, 0, 1) * largest / s->beta;
        subject plain = *s;
        plain.onset = 0;
        rg_law_answer law = ask_at(&plain, damage, 0, damage), top = ask_at(s, largest, 0, largest);
        rg_law_answer back = ask_at(s, part * largest, sliding, largest);
        expect_near(s, "envelope", top.normal, law.normal, 2e-15 * SIGMA);
        expect_near(s, "work to the envelope", top.stored + top.dissipated, law.stored + law.dissipated,
                    2e-15 * SIGMA * DELTA);
        assert_true(back.normal <= bound * part * largest * (1 + 1e-12));
        assert_true(back.sliding <= s->beta * s->beta * bound * sliding * (1 + 1e-12));
    }
    if (s->onset > 0) {
        rg_law_answer first = ask_at(s, 0.5 * s->onset, 0, s->onset), start = ask_at(s, s->onset, 0, 0);
        expect_near(s, "first slope", first.normal, bound * 0.5 * s->onset, 1.5e-12 * SIGMA);
        expect_near(s, "traction at the switch", start.normal, SIGMA, 3e-12 * SIGMA);
        expect_near(s, "stored at the switch", start.stored, 0, 1.2e-13 * SIGMA * DELTA);
        expect_near(s, "dissipated at the switch", start.dissipated, 0, 1.2e-13 * SIGMA * DELTA);
    }
}

static void test_conserving(void **state) {
    (void)state;
    for_each_law(check_conserving);
}

/* ---- Kernels ---- */

/* What the interface kernels write, with the crack state of the law. */
typedef struct {
    rg_real *force, *turn, *crack;
    double *energy;
    uint8_t broken[INPUT_ISLOTS], unlinked[INPUT_ISLOTS], active[INPUT_IBLOCKS];
} output;

static size_t stride_of(const input *in) {
    size_t friction = in->law.sliding == RG_SLIDING_COULOMB ? RG_FRICTION_BLOCK : 0;
    size_t loan = in->law.criterion == RG_CRITERION_MOHR_COULOMB ? RG_LOAN_BLOCK : 0;
    size_t bond = in->law.shear == RG_SHEAR_FADING ? RG_BOND_BLOCK : 0;
    size_t rise = in->law.rise.rate > 0 ? RG_RISE_BLOCK : 0;
    return RG_CRACK_BLOCK + friction + loan + bond + rise +
           (size_t)rg_law_facts_of(in->law.law, in->law.shape, in->law.beta).memory * RG_POINTS * RG_LANES;
}

static output output_make(const input *in) {
    size_t stride = stride_of(in);
    output out = {.force = input_alloc(INPUT_IBLOCKS * RG_IFORCE_BLOCK * sizeof(rg_real)),
                  .turn = input_alloc(INPUT_IBLOCKS * RG_IFORCE_BLOCK * sizeof(rg_real)),
                  .crack = input_alloc(INPUT_IBLOCKS * stride * sizeof(rg_real)),
                  .energy = input_alloc(INPUT_ISLOTS * RG_E_INTERFACE * sizeof(double))};
    for (size_t b = 0; b < INPUT_IBLOCKS; b++)
        memcpy(out.crack + b * stride, in->crack + b * RG_CRACK_BLOCK, RG_CRACK_BLOCK * sizeof(rg_real));
    memcpy(out.broken, in->broken, sizeof out.broken);
    memcpy(out.unlinked, in->unlinked, sizeof out.unlinked);
    memcpy(out.active, in->active, sizeof out.active);
    return out;
}

static void output_free(output *out) {
    free(out->force);
    free(out->turn);
    free(out->crack);
    free(out->energy);
}

/* Properties of each face. */
typedef struct {
    const rg_real *scale, *beta, *friction, *rise;
} faces;

/* Three steps, each with larger displacements, so that memories matter; then the energies. */
static output run(const rg_kernels *set, const input *in, const faces *own) {
    output out = output_make(in);
    rg_interface_args args =
        input_interface_args(in, out.broken, out.unlinked, out.active, out.crack, out.force);
    args.crack_stride = stride_of(in);
    args.turn = out.turn;
    args.scale = own == NULL ? NULL : own->scale;
    args.beta = own == NULL ? NULL : own->beta;
    args.friction = own == NULL ? NULL : own->friction;
    args.rise = own == NULL ? NULL : own->rise;
    args.step = 1e-9;
    rg_real *u = input_alloc(INPUT_EBLOCKS * RG_NODE_BLOCK * sizeof *u);
    args.u = u;
    for (int step = 0; step < 3; step++) {
        static const double grown[3] = {1, 1.03, 0.98};
        for (size_t k = 0; k < INPUT_EBLOCKS * RG_NODE_BLOCK; k++)
            u[k] = (rg_real)(grown[step] * in->u[k]);
        args.time += args.step;
        set->interface(&args, 0, INPUT_IBLOCKS);
    }
    set->interface_state(&(rg_interface_state_args){&args, out.energy}, 0, INPUT_IBLOCKS);
    free(u);
    return out;
}

/* Of all that is compared here, in shares of the largest value of its kind. */
static figure twin = {"cohesive laws in the kernels against plain C",
                      .bound = sizeof(rg_real) == 8 ? 4e-13 : 8e-5, .why = ROUNDING};

/* Relative to the largest value, times `wide`. */
static void compare_within(const char *set, const char *law, const char *what, const double *got,
                           const double *expected, size_t count, double wide) {
    double most = 0;
    for (size_t k = 0; k < count; k++)
        most = fmax(most, wide * fabs(expected[k]));
    for (size_t k = 0; k < count; k++)
        if (!(fabs(got[k] - expected[k]) <= TOLERANCE * most))
            fail_msg("%s, %s: %s[%zu] is %.17g instead of %.17g", set, law, what, k, got[k], expected[k]);
        else if (most > 0)
            raise_figure(&twin, got[k], expected[k], most);
}

static void compare(const char *set, const char *law, const char *what, const double *got,
                    const double *expected, size_t count) {
    compare_within(set, law, what, got, expected, count, 1);
}

static double *wide(const rg_real *x, size_t count) {
    double *d = input_alloc(count * sizeof *d);
    for (size_t k = 0; k < count; k++)
        d[k] = x[k];
    return d;
}

static void compare_reals(const char *set, const char *law, const char *what, const rg_real *got,
                          const rg_real *expected, size_t count) {
    double *a = wide(got, count), *b = wide(expected, count);
    compare(set, law, what, a, b, count);
    free(a);
    free(b);
}

/* Largest openings of broken points; those of others mean nothing. */
static void compare_cracks(const char *set, const char *law, const output *out, const output *ref,
                           size_t stride) {
    for (size_t i = 0; i < INPUT_ISLOTS; i++)
        for (int q = 0; q < RG_POINTS; q++) {
            const size_t at = i / RG_LANES * stride + rg_crack_index(i % RG_LANES, q, RG_CRACK_OPENING);
            double got = out->crack[at], expected = ref->crack[at];
            if ((ref->broken[i] >> q & 1) && !(fabs(got - expected) <= TOLERANCE * 10 * DELTA))
                fail_msg("%s, %s: opening[%zu][%d] is %g instead of %g", set, law, i, q, got, expected);
            if (ref->broken[i] >> q & 1)
                raise_figure(&twin, got, expected, 10 * DELTA);
        }
}

/* Slips are what displacements of an edge's length leave, of which floats have few digits. */
#define OF_SLIP (sizeof(rg_real) == 8 ? 1 : 3)

/* Some of what points keep: `count` values each, the first of a block at `first`. */
typedef struct {
    const char *what;
    size_t stride, first, count;
    double wide; /* as in compare_within */
} kept;

/* Value k of all points, 0 where they hold. */
static double *values_of(const kept *part, const output *out, const output *ref, size_t k) {
    double *all = input_alloc(INPUT_ISLOTS * RG_POINTS * sizeof *all);
    for (size_t i = 0; i < INPUT_ISLOTS; i++)
        for (size_t q = 0; q < RG_POINTS; q++)
            if (ref->broken[i] >> q & 1)
                all[i * RG_POINTS + q] = out->crack[i / RG_LANES * part->stride + part->first +
                                                    (q * part->count + k) * RG_LANES + i % RG_LANES];
    return all;
}

static void compare_kept(const char *set, const char *law, const kept *part, const output *out,
                         const output *ref) {
    for (size_t k = 0; k < part->count; k++) {
        double *got = values_of(part, out, ref, k), *expected = values_of(part, ref, ref, k), sum = 0;
        compare_within(set, law, part->what, got, expected, INPUT_ISLOTS * RG_POINTS, part->wide);
        for (size_t i = 0; i < INPUT_ISLOTS * RG_POINTS; i++)
            sum += fabs(expected[i]);
        assert_true(sum > 0);
        free(got);
        free(expected);
    }
}

/* Faces of infinite strength hold. */
static void mend(input *in, const rg_real *scale) {
    for (size_t i = 0; i < INPUT_ISLOTS; i++)
        if (isinf(scale[i / RG_LANES * 2 * RG_LANES + i % RG_LANES]))
            in->broken[i] = in->unlinked[i] = 0;
    input_flags(in);
}

static void check_kernel(const rg_kernels *set, input_kind kind, const rg_cohesive *law, const faces *own) {
    input *in = input_make(kind, *law, 7, 3);
    input_break(in, law->form == RG_FORM_INTRINSIC ? 1 : 0.4);
    if (own != NULL)
        mend(in, own->scale);
    output out = run(set, in, own), ref = run(&rg_kernels_reference, in, own);
    const char *word = rg_law_facts_of(law->law, law->shape, law->beta).word;
    assert_memory_equal(out.broken, ref.broken, sizeof out.broken);
    assert_memory_equal(out.unlinked, ref.unlinked, sizeof out.unlinked);
    compare_reals(set->name, word, "force", out.force, ref.force, INPUT_IBLOCKS * RG_IFORCE_BLOCK);
    compare_reals(set->name, word, "turn", out.turn, ref.turn, INPUT_IBLOCKS * RG_IFORCE_BLOCK);
    compare(set->name, word, "energy", out.energy, ref.energy, INPUT_ISLOTS * RG_E_INTERFACE);
    size_t stride = stride_of(in), memory = (size_t)rg_law_facts_of(law->law, law->shape, law->beta).memory;
    compare_cracks(set->name, word, &out, &ref, stride);
    compare_kept(set->name, word, &(kept){"memory", stride, RG_CRACK_BLOCK, memory, 1}, &out, &ref);
    size_t loan = law->criterion == RG_CRITERION_MOHR_COULOMB ? RG_LOAN_BLOCK : 0,
           behind = law->sliding == RG_SLIDING_COULOMB ? loan + RG_FRICTION_BLOCK : loan;
    if (law->rise.rate > 0)
        compare_kept(set->name, word, &(kept){"rise", stride, stride - behind - RG_RISE_BLOCK, RG_RISE, 1},
                     &out, &ref);
    if (law->shear == RG_SHEAR_FADING)
        compare_kept(
            set->name, word,
            &(kept){"bond", stride, RG_CRACK_BLOCK + memory * RG_POINTS * RG_LANES, RG_BOND, OF_SLIP}, &out,
            &ref);
    if (law->criterion == RG_CRITERION_MOHR_COULOMB)
        compare_kept(set->name, word,
                     &(kept){"loan", stride, stride - RG_FRICTION_BLOCK - RG_LOAN_BLOCK, 1, 1}, &out, &ref);
    if (law->sliding == RG_SLIDING_COULOMB)
        compare_kept(set->name, word,
                     &(kept){"friction", stride, stride - RG_FRICTION_BLOCK, RG_FRICTION, OF_SLIP}, &out,
                     &ref);
    output_free(&out);
    output_free(&ref);
    input_free(in);
}

static rg_cohesive cohesive_of(const subject *s, bool intrinsic) {
    rg_cohesive law = {.strength = SIGMA,
                       .opening = DELTA,
                       .beta = s->beta,
                       .law = s->law,
                       .form = intrinsic ? RG_FORM_INTRINSIC : RG_FORM_VARIATIONAL,
                       .separation = s->facts.separation * DELTA,
                       .slope = intrinsic ? s->facts.slope[0] * SIGMA / DELTA : 0};
    memcpy(law.shape, s->shape, sizeof law.shape);
    return law;
}

/* Case files with law `rate` are refused in single precision. */
static bool exists(rg_law law) {
    return sizeof(rg_real) == sizeof(double) || law != RG_LAW_RATE;
}

static void test_kernels(void **state) {
    const rg_kernels *sets[INPUT_SETS];
    int n = rg_kernels_available(sets, INPUT_SETS);
    rg_real *scale = input_alloc(2 * INPUT_ISLOTS * sizeof *scale),
            *some = input_alloc(2 * INPUT_ISLOTS * sizeof *some);
    rg_real *beta = input_alloc(INPUT_ISLOTS * sizeof *beta),
            *friction = input_alloc(INPUT_ISLOTS * sizeof *beta),
            *rise = input_alloc(INPUT_ISLOTS * sizeof *beta);
    (void)state;
    for (size_t k = 0; k < 2 * INPUT_ISLOTS; k++)
        scale[k] = (rg_real)(0.7 + 0.6 * rg_hash_uniform(rg_hash(3, k)));
    for (size_t k = 0; k < INPUT_ISLOTS; k++) {
        beta[k] = (rg_real)fmax(0, 2 * rg_hash_uniform(rg_hash(4, k)) - 0.3);
        friction[k] = (rg_real)rg_hash_uniform(rg_hash(5, k));
        rise[k] = (rg_real)(0.3 * rg_hash_uniform(rg_hash(6, k)));
    }
    memcpy(some, scale, 2 * INPUT_ISLOTS * sizeof *some);
    for (size_t k = 0; k < INPUT_ISLOTS; k += 11)
        some[k / RG_LANES * 2 * RG_LANES + k % RG_LANES] = (rg_real)INFINITY;
    const faces own = {scale, NULL, NULL, NULL}, all = {some, beta, friction, rise};
    for (int k = 0; k < n; k++)
        for (int l = 0; l < (int)RG_LAWS; l++)
            for (int kind = 0; kind < 2 && exists((rg_law)l); kind++) {
                subject s = make_subject((rg_law)l, true, kind == 0 ? 1 : 1.5, 0.3);
                rg_cohesive law = cohesive_of(&s, (s.facts.forms & RG_FORMS_DG) == 0);
                check_kernel(sets[k], (input_kind)kind, &law, NULL);
                check_kernel(sets[k], (input_kind)kind, &law, &own);
                law.sliding = RG_SLIDING_COULOMB;
                law.friction = 0.4;
                check_kernel(sets[k], (input_kind)kind, &law,
                             kind == 1                         ? NULL
                             : law.form == RG_FORM_VARIATIONAL ? &all
                                                               : &own);
                law.contact = RG_CONTACT_POTENTIAL;
                check_kernel(sets[k], (input_kind)kind, &law, NULL);
                law.contact = RG_CONTACT_PENALTY;
                law.sliding = RG_SLIDING_STUCK;
                check_kernel(sets[k], (input_kind)kind, &law, NULL);
                law.sliding = RG_SLIDING_FREE;
                law.activation = RG_ACTIVATION_CONSERVING;
                law.onset = 0.3; /* in units of the penalty, as the kernels take it */
                law.beta_s = 4;
                if ((s.facts.forms & RG_CONSERVES) != 0) {
                    check_kernel(sets[k], (input_kind)kind, &law, NULL);
                    check_kernel(sets[k], (input_kind)kind, &law, &all);
                }
                if (s.onset > 0) {
                    law.shear = RG_SHEAR_FADING; /* of those with beta 0 */
                    law.contact = kind == 0 ? RG_CONTACT_POTENTIAL : RG_CONTACT_PENALTY;
                    check_kernel(sets[k], (input_kind)kind, &law, &all);
                    law.sliding = RG_SLIDING_COULOMB;
                    law.criterion = RG_CRITERION_MOHR_COULOMB;
                    check_kernel(sets[k], (input_kind)kind, &law, &all);
                    law.shear = RG_SHEAR_RELEASED;
                    check_kernel(sets[k], (input_kind)kind, &law, NULL);
                    check_kernel(sets[k], (input_kind)kind, &law, &all);
                    law.rise = (rg_rise){1e16, 0.1, 1.4};
                    check_kernel(sets[k], (input_kind)kind, &law, NULL);
                    law.shear = RG_SHEAR_FADING;
                    check_kernel(sets[k], (input_kind)kind, &law, &all);
                }
            }
    free(scale);
    free(some);
    free(beta);
    free(friction);
    free(rise);
}

/* Of a face with a scale the answer is that of a law with these parameters; faces beside it do not matter. */
static void test_scale(void **state) {
    rg_real *scale = input_alloc(2 * INPUT_ISLOTS * sizeof *scale);
    (void)state;
    for (size_t k = 0; k < 2 * INPUT_ISLOTS; k++)
        scale[k] = k / RG_LANES % 2 == 0 ? 2 : (rg_real)0.5;
    subject s = make_subject(RG_LAW_LINEAR, false, 1, 0);
    rg_cohesive law = cohesive_of(&s, false), scaled = law;
    scaled.strength *= 2;
    scaled.opening *= 0.5;
    scaled.separation *= 0.5;
    input *in = input_make(INPUT_SMALL, law, 7, 3);
    input_break(in, 0.4);
    output one = run(&rg_kernels_reference, in, &(faces){.scale = scale});
    in->law = scaled;
    output two = run(&rg_kernels_reference, in, NULL);
    compare_reals("reference", "linear", "force", one.force, two.force, INPUT_IBLOCKS * RG_IFORCE_BLOCK);
    compare("reference", "linear", "energy", one.energy, two.energy, INPUT_ISLOTS * RG_E_INTERFACE);
    output_free(&one);
    output_free(&two);
    input_free(in);
    free(scale);
}

static void test_worst(void **state) {
    (void)state;
    assert_true(twin.found > 0 && state_figure(twin));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_work),        cmocka_unit_test(test_potential),
        cmocka_unit_test(test_dissipation), cmocka_unit_test(test_balance),
        cmocka_unit_test(test_stiffness),   cmocka_unit_test(test_kernels),
        cmocka_unit_test(test_scale),       cmocka_unit_test(test_rate),
        cmocka_unit_test(test_fatigue),     cmocka_unit_test(test_conserving),
        cmocka_unit_test(test_worst),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
