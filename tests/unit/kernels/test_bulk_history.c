/* Bulk kernels of materials with a history: every set against the scalar reference on random states, what
 * must hold exactly of an element, and that only an advance moves the history. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/deshpande_evans_input.h"
#include "support/kernel_input.h"

static rg_material_model model; /* under test */

/* Values of its history: of a point, of an element. */
static size_t values(void) {
    return (size_t)rg_material_history(model);
}

static size_t history_rows(void) {
    return rg_history_rows(rg_material_history(model));
}

#define TOLERANCE 1e-9 /* of the largest value of its kind; strains of a step are known to 1e-13 */
#define DT        2e-9

/* All that the kernels write, in blocks of `rows` values a lane (0: of the history). */
enum { FORCE, TRACTION, STIFFENING, PAST, ENERGY, CAUCHY, INTERNAL, FIELDS };
static const struct {
    const char *name;
    size_t rows, kinds; /* every `kinds`-th row is of the same kind */
} field[FIELDS] = {{"force", 30, 1}, {"traction", 36, 1}, {"stiffening", 1, 1},         {"history", 0, 0},
                   {"energy", 1, 1}, {"cauchy", 24, 1},   {"internal", 12, RG_INTERNAL}};

static size_t rows_of(int f) {
    return f == PAST ? history_rows() : field[f].rows;
}

static size_t kinds_of(int f) {
    return f == PAST ? history_rows() : field[f].kinds;
}

typedef struct {
    double *value[FIELDS];
} output;

static double *zeros(int f) {
    return input_alloc(INPUT_EBLOCKS * rows_of(f) * RG_LANES * sizeof(double));
}

static size_t at(int f, size_t slot, size_t row) {
    return f == TRACTION ? slot * rows_of(f) + row
                         : (slot / RG_LANES * rows_of(f) + row) * RG_LANES + slot % RG_LANES;
}

/* ---- States ---- */

/* Metals: linear hardening, one that saturates soon, none. */
static const double metals[3][RG_PARAMETERS] = {
    {[RG_PARAMETER_YIELD_STRESS] = 1e9, [RG_PARAMETER_HARDENING] = 2e9},
    {[RG_PARAMETER_YIELD_STRESS] = 1e9,
     [RG_PARAMETER_HARDENING] = 1e9,
     [RG_PARAMETER_SATURATION_STRESS] = 2e9,
     [RG_PARAMETER_SATURATION_RATE] = 400},
    {[RG_PARAMETER_YIELD_STRESS] = 2e9}};
static int metal; /* under test */

/* A mesh of the material under test whose strains are `size` times a per cent. */
static input *make_input(double size, uint64_t order) {
    input *in = input_make(INPUT_SMALL, input_laws[0], 7, order);
    for (size_t k = 0; k < INPUT_EBLOCKS * RG_NODE_BLOCK; k++)
        in->u[k] *= size;
    input_break(in, 0.1);
    input_set_model(in, model);
    if (model == RG_MATERIAL_DESHPANDE_EVANS)
        in->material.of.deshpande_evans.parameters = rg_deshpande_evans_alumina();
    else
        memcpy(in->material.of.parameter, metals[metal], sizeof metals[metal]);
    rg_material_prepare(&in->material, DT);
    return in;
}

/* Each element's own past, wherever it sits: cracks from none to saturated, a tenth of them hardened; of the
 * metal, half. */
static void make_history(const input *in, double *history) {
    const bool ceramic = model == RG_MATERIAL_DESHPANDE_EVANS;
    const size_t skipped = ceramic ? 0 : 1; /* the metal has all but the growth of cracks */
    double most = ceramic ? in->material.of.deshpande_evans.constants.growth_max : 0;
    for (size_t e = 0; e < INPUT_ELEMENTS; e++) {
        dice d = {100 + e, 0};
        for (size_t g = 0; g < RG_GAUSS; g++) {
            double growth = dice_unit(&d) < 0.5 ? 0.2 * dice_unit(&d) : most * dice_unit(&d);
            double ep = dice_unit(&d) < (ceramic ? 0.9 : 0.5) ? 0 : 0.01 * dice_unit(&d);
            point_state s = state_make(&d, growth, ep, ep, 0, 1e-3);
            for (size_t k = 0; k < values(); k++)
                history[at(PAST, in->element[e], g * values() + k)] = s.history[skipped + k];
        }
    }
}

static output run(const rg_kernels *set, const input *in, rg_gradient gradient, bool advance) {
    output out;
    for (int f = 0; f < FIELDS; f++)
        out.value[f] = zeros(f);
    make_history(in, out.value[PAST]);
    rg_bulk_args bulk = input_bulk_args(in, out.value[FORCE], out.value[TRACTION], out.value[STIFFENING]);
    bulk.gradient = gradient;
    bulk.history = out.value[PAST];
    bulk.advance = advance;
    rg_bulk_state_args state = {&bulk, out.value[ENERGY], out.value[CAUCHY], out.value[INTERNAL]};
    set->bulk(&bulk, 0, INPUT_EBLOCKS);
    set->bulk_state(&state, 0, INPUT_EBLOCKS);
    return out;
}

static void free_output(output *out) {
    for (int f = 0; f < FIELDS; f++)
        free(out->value[f]);
}

/* ---- Against the reference ---- */

/* The largest value of a kind; of what was set free, which is a difference of energies, the largest energy.
 */
static double scale_of(int f, size_t kind, const output *expected) {
    double scale = 0;
    int of = f == PAST && kind >= history_rows() - RG_RELEASED ? ENERGY : f;
    for (size_t s = 0; s < INPUT_ESLOTS; s++)
        for (size_t r = of == f ? kind : 0; r < rows_of(of); r += kinds_of(of))
            scale = fmax(scale, fabs(expected->value[of][at(of, s, r)]));
    return scale;
}

static void compare_kind(const char *set, int f, size_t kind, const output *out, const output *expected) {
    double scale = scale_of(f, kind, expected);
    for (size_t s = 0; s < INPUT_ESLOTS; s++)
        for (size_t r = kind; r < rows_of(f); r += kinds_of(f)) {
            double a = out->value[f][at(f, s, r)], b = expected->value[f][at(f, s, r)];
            if (!(fabs(a - b) <= TOLERANCE * scale))
                fail_msg("%s: %s, slot %zu, row %zu is %.17g instead of %.17g", set, field[f].name, s, r, a,
                         b);
        }
}

/* Points in each regime; points that the step made grow; points that it made flow. */
typedef struct {
    int regime[4], grown, flown;
} census;

static void count(const input *in, const output *out, census *c) {
    double *before = zeros(PAST);
    make_history(in, before);
    for (size_t e = 0; e < INPUT_ELEMENTS; e++)
        for (size_t g = 0; g < RG_GAUSS; g++) {
            size_t first = at(PAST, in->element[e], g * values());
            size_t strain = model == RG_MATERIAL_DESHPANDE_EVANS ? first + RG_LANES : first;
            const double *after = out->value[PAST];
            c->regime[(int)out->value[INTERNAL][at(INTERNAL, in->element[e], g * RG_INTERNAL + 1)]]++;
            c->grown += strain != first && after[first] > before[first];
            c->flown += after[strain] > before[strain];
        }
    free(before);
}

static const double sizes[] = {0.03, 0.3, 1, 3, -0.1, -1, -3};
enum { SIZES = sizeof sizes / sizeof *sizes };

static void check_set(const rg_kernels *set, rg_gradient gradient, bool advance, census *c) {
    for (int k = 0; k < SIZES; k++) {
        input *in = make_input(sizes[k], 0);
        output expected = run(&rg_kernels_reference, in, gradient, advance),
               out = run(set, in, gradient, advance);
        for (int f = 0; f < FIELDS; f++)
            for (size_t kind = 0; kind < kinds_of(f); kind++)
                compare_kind(set->name, f, kind, &out, &expected);
        count(in, &out, c);
        free_output(&expected);
        free_output(&out);
        input_free(in);
    }
}

static void test_ceramic(void **state) {
    const rg_kernels *sets[INPUT_SETS];
    int n = rg_kernels_available(sets, INPUT_SETS);
    (void)state;
    model = RG_MATERIAL_DESHPANDE_EVANS;
    for (int s = 0; s < n; s++) {
        census c = {{0}, 0, 0}, rest = {{0}, 0, 0};
        check_set(sets[s], RG_GRADIENT_LIFTED, true, &c);
        check_set(sets[s], RG_GRADIENT_OWN, true, &c);
        check_set(sets[s], RG_GRADIENT_LIFTED, false, &rest);
        print_message("# %s: %d, %d, %d points in regime I, II, III; %d grow, %d flow\n", sets[s]->name,
                      c.regime[1], c.regime[2], c.regime[3], c.grown, c.flown);
        assert_true(c.regime[0] == 0 && c.regime[1] > 100 && c.regime[2] > 100 && c.regime[3] > 100);
        assert_true(c.grown > 500 && c.flown > 100);
        assert_true(rest.grown == 0 && rest.flown == 0);
    }
}

static void test_metals(void **state) {
    const rg_kernels *sets[INPUT_SETS];
    int n = rg_kernels_available(sets, INPUT_SETS);
    (void)state;
    model = RG_MATERIAL_J2;
    for (metal = 0; metal < 3; metal++)
        for (int s = 0; s < n; s++) {
            census c = {{0}, 0, 0}, rest = {{0}, 0, 0};
            check_set(sets[s], RG_GRADIENT_LIFTED, true, &c);
            check_set(sets[s], RG_GRADIENT_OWN, true, &c);
            check_set(sets[s], RG_GRADIENT_LIFTED, false, &rest);
            print_message("# %s: metal %d, %d of %d points flow\n", sets[s]->name, metal, c.flown,
                          c.regime[0]);
            assert_true(c.flown > 1000 && c.regime[0] - c.flown > 1000 && rest.flown == 0);
        }
    metal = 0;
}

/* ---- What holds exactly ---- */

static void for_each_material(void (*test)(void)) {
    static const rg_material_model models[] = {RG_MATERIAL_DESHPANDE_EVANS, RG_MATERIAL_J2};
    for (size_t k = 0; k < sizeof models / sizeof *models; k++) {
        model = models[k];
        metal = 1;
        test();
    }
}

/* An element's results do not depend on where it sits and with whom. */
static void check_any_place(void) {
    const rg_kernels *sets[INPUT_SETS];
    int n = input_sets(sets, INPUT_SETS);
    for (int s = 0; s < n; s++) {
        input *in = make_input(1, 0), *other = make_input(1, 5);
        output a = run(sets[s], in, true, true), b = run(sets[s], other, true, true);
        for (int f = 0; f < FIELDS; f++)
            for (size_t e = 0; e < INPUT_ELEMENTS; e++)
                for (size_t r = 0; r < rows_of(f); r++) {
                    const double *x = &a.value[f][at(f, in->element[e], r)],
                                 *y = &b.value[f][at(f, other->element[e], r)];
                    if (memcmp(x, y, sizeof *x) != 0)
                        fail_msg("%s: %s of element %zu depends on its place", sets[s]->name, field[f].name,
                                 e);
                }
        free_output(&a);
        free_output(&b);
        input_free(in);
        input_free(other);
    }
}

static void test_any_place(void **state) {
    (void)state;
    for_each_material(check_any_place);
}

/* The forces of a step are those of its end: at rest in the new state they are the same to rounding, and the
 * energy that the step set free is what it took from the stored one; of the metal, less than that: the work
 * of the yield curve. */
static void check_end_of_step(void) {
    const rg_kernels *sets[INPUT_SETS];
    int n = input_sets(sets, INPUT_SETS);
    const size_t past = INPUT_EBLOCKS * history_rows() * RG_LANES;
    for (int s = 0; s < n; s++) {
        input *in = make_input(1, 0);
        output before = run(sets[s], in, true, false), after = run(sets[s], in, true, true);
        output again = run(sets[s], in, true, false);
        memcpy(again.value[PAST], after.value[PAST], past * sizeof(double));
        rg_bulk_args bulk =
            input_bulk_args(in, again.value[FORCE], again.value[TRACTION], again.value[STIFFENING]);
        bulk.history = again.value[PAST];
        sets[s]->bulk(&bulk, 0, INPUT_EBLOCKS);
        compare_kind(sets[s]->name, FORCE, 0, &after, &again);
        compare_kind(sets[s]->name, TRACTION, 0, &after, &again);
        assert_memory_equal(again.value[PAST], after.value[PAST], past * sizeof(double));
        for (size_t e = 0; e < INPUT_ELEMENTS; e++) {
            size_t slot = in->element[e];
            double released = 0, scale = before.value[ENERGY][at(ENERGY, slot, 0)];
            for (size_t k = 0; k < RG_RELEASED; k++)
                released += after.value[PAST][at(PAST, slot, history_rows() - RG_RELEASED + k)];
            double kept = scale - after.value[ENERGY][at(ENERGY, slot, 0)] - released;
            if (model == RG_MATERIAL_J2)
                assert_true(kept > -1e-11 * scale && released >= 0);
            else
                assert_true(fabs(kept) < 1e-11 * scale);
        }
        free_output(&before);
        free_output(&after);
        free_output(&again);
        input_free(in);
    }
}

static void test_end_of_step(void **state) {
    (void)state;
    for_each_material(check_end_of_step);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ceramic),
        cmocka_unit_test(test_metals),
        cmocka_unit_test(test_any_place),
        cmocka_unit_test(test_end_of_step),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
