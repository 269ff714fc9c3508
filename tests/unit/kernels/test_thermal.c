/* Solids that heat expands: every set of kernels against the scalar reference, free and held solids by hand,
 * and the work of the expansion. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/dice.h"
#include "support/figures.h"
#include "support/kernel_input.h"

#define STEP 2e-9

/* All that the kernels write of a mesh. */
enum { FORCE, TRACTION, STIFFENING, THERMAL, HISTORY, ENERGY, CAUCHY, FIELDS };
typedef struct {
    rg_real *value[FIELDS];
    double *wide[FIELDS];
} output;

static size_t rows_of(int f, const input *in) {
    const size_t rows[FIELDS] = {3 * RG_NODES,
                                 RG_TRACTION_ROW,
                                 1,
                                 RG_THERMAL,
                                 rg_history_rows(rg_material_history(in->material.model)),
                                 1,
                                 RG_GAUSS * 6};
    return rows[f];
}

static size_t index_of(int f, const input *in, size_t slot, size_t row) {
    size_t rows = rows_of(f, in);
    return f == TRACTION ? slot * rows + row : (slot / RG_LANES * rows + row) * RG_LANES + slot % RG_LANES;
}

static output make_output(const input *in) {
    output o = {0};
    for (int f = 0; f < FIELDS; f++) {
        size_t count = INPUT_ESLOTS * rows_of(f, in) + 1;
        if (f < ENERGY)
            o.value[f] = input_alloc(count * sizeof(rg_real));
        else
            o.wide[f] = input_alloc(count * sizeof(double));
    }
    return o;
}

static void free_output(output *o) {
    for (int f = 0; f < FIELDS; f++) {
        free(o->value[f]);
        free(o->wide[f]);
    }
}

static double at(const output *o, int f, const input *in, size_t slot, size_t row) {
    size_t i = index_of(f, in, slot, row);
    return f < ENERGY ? (double)o->value[f][i] : o->wide[f][i];
}

static void run(const rg_kernels *set, const input *in, output *o, bool advance) {
    rg_bulk_args bulk = input_bulk_args(in, o->value[FORCE], o->value[TRACTION], o->value[STIFFENING]);
    rg_bulk_state_args state = {.bulk = &bulk, .energy = o->wide[ENERGY], .cauchy = o->wide[CAUCHY]};
    bulk.thermal = o->value[THERMAL];
    bulk.history = rows_of(HISTORY, in) > 0 ? o->value[HISTORY] : NULL;
    bulk.advance = advance;
    set->bulk(&bulk, 0, INPUT_EBLOCKS);
    set->bulk_state(&state, 0, INPUT_EBLOCKS);
}

static void set_material(input *in, rg_material_model model) {
    input_set_model(in, model);
    if (model == RG_MATERIAL_J2) {
        memset(in->material.of.parameter, 0, sizeof in->material.of.parameter);
        in->material.of.parameter[RG_PARAMETER_YIELD_STRESS] = 1e9;
        in->material.of.parameter[RG_PARAMETER_HARDENING] = 2e9;
    }
    rg_material_prepare(&in->material, STEP);
}

static const rg_material_model models[] = {RG_MATERIAL_NEO_HOOKEAN,
#ifndef RG_SINGLE
                                           RG_MATERIAL_J2,
#endif
                                           RG_MATERIAL_ST_VENANT_KIRCHHOFF};
enum { MODELS = sizeof models / sizeof *models };

#ifdef RG_SINGLE
#define TOLERANCE 3e-5
#else
#define TOLERANCE 1e-9
#endif

/* Of a random state, in one step that expands elements as they like. */
static void test_reference(void **state) {
    const rg_kernels *sets[INPUT_SETS];
    int n = input_sets(sets, INPUT_SETS), worked = 0;
    (void)state;
    for (int m = 0; m < MODELS; m++) {
        input *in = input_make(INPUT_SMALL, input_laws[0], 7, 0);
        input_break(in, 0.1);
        set_material(in, models[m]);
        for (int s = 0; s < n; s++) {
            output o[2];
            for (int k = 0; k < 2; k++) {
                dice d = {30, 0};
                o[k] = make_output(in);
                for (size_t i = 0; i < INPUT_ESLOTS * RG_THERMAL; i++)
                    o[k].value[THERMAL][i] =
                        (rg_real)(i / RG_LANES % RG_THERMAL < RG_THERMAL_FORCE ? 5e-3 * dice_sign(&d)
                                                                               : 1e8 * dice_sign(&d));
                run(k == 0 ? sets[s] : &rg_kernels_reference, in, &o[k], true);
            }
            for (int f = 0; f < FIELDS; f++)
                for (size_t row = 0; row < rows_of(f, in); row++) {
                    double scale = 0;
                    size_t first = f == THERMAL || f == HISTORY ? row : 0;
                    size_t end = f == THERMAL || f == HISTORY ? row + 1 : rows_of(f, in);
                    for (size_t slot = 0; slot < INPUT_ESLOTS; slot++)
                        for (size_t r = first; r < end; r++)
                            scale = fmax(scale, fabs(at(&o[1], f, in, slot, r)));
                    for (size_t e = 0; e < INPUT_ELEMENTS; e++) {
                        size_t slot = in->element[e];
                        double a = at(&o[0], f, in, slot, row), b = at(&o[1], f, in, slot, row);
                        if (!(fabs(a - b) <= TOLERANCE * scale))
                            fail_msg("%s: model %d, field %d, row %zu is %.17g instead of %.17g",
                                     sets[s]->name, (int)models[m], f, row, a, b);
                        worked += f == THERMAL && row == RG_THERMAL_WORK && fabs(a) > 1e-3 * scale;
                    }
                }
            free_output(&o[0]);
            free_output(&o[1]);
        }
        input_free(in);
    }
    assert_true(worked > 300);
}

/* All elements at one gradient, grown by `size` in all directions, at expansion e. */
static void place(input *in, output *o, double size, double e) {
    for (size_t k = 0; k < INPUT_ELEMENTS; k++)
        for (int i = 0; i < 3 * RG_NODES; i++)
            in->u[rg_node_index(in->element[k], i / 3, i % 3)] = (rg_real)(size * in->x[k][i / 3][i % 3]);
    for (size_t slot = 0; slot < INPUT_ESLOTS; slot++)
        for (size_t g = 0; g < RG_GAUSS; g++)
            o->value[THERMAL][index_of(THERMAL, in, slot, RG_THERMAL_EXPANSION + g)] = (rg_real)e;
}

/* A body that grows as it is heated has neither stress nor energy; one that is held has that of F/(1 + e): of
 * the neo-Hookean solid lambda log Je + mu (s^-2 - 1) over the volume, s = 1 + e, Je = s^-3; -3K e to first
 * order. And the work that was booked on the way is what is stored, to second order in the step. */
static void test_free_and_held(void **state) {
    const rg_kernels *sets[INPUT_SETS];
    int n = input_sets(sets, INPUT_SETS);
    const double e = 0.01;
    figure free_stress = {"heated, free: stress, of 3K e", .bound = 1e-12, .why = ROUNDING};
    figure held = {"heated, held: stress, of 3K e", .bound = 1e-12, .why = ROUNDING};
    figure work = {"heated, held, in 20 steps: work of the expansion against what is stored, relative",
                   .bound = 4.8e-5};
    (void)state;
#ifdef RG_SINGLE
    free_stress.bound = held.bound = 1e-4;
    work.bound = 1e-3;
#endif
    for (int s = 0; s < n; s++) {
        input *in = input_make(INPUT_SMALL, input_laws[0], 7, 0);
        output o = make_output(in);
        const double lambda = in->material.lambda, mu = in->material.mu, scale = (3 * lambda + 2 * mu) * e;
        const double grown = 1 + e, stress = (-3 * lambda * log(grown) + mu * (1 / (grown * grown) - 1));
        for (int k = 1; k <= 20; k++) {
            place(in, &o, 0, e * k / 20);
            run(sets[s], in, &o, true);
        }
        for (size_t k = 0; k < INPUT_ELEMENTS; k++) {
            double stored = at(&o, ENERGY, in, in->element[k], 0);
            raise_figure(&work, at(&o, THERMAL, in, in->element[k], RG_THERMAL_WORK), stored, stored);
            for (size_t g = 0; g < 6 * RG_GAUSS; g++)
                raise_figure(&held, at(&o, CAUCHY, in, in->element[k], g), g % 6 < 3 ? stress : 0, scale);
        }
        place(in, &o, e, e);
        run(sets[s], in, &o, false);
        for (size_t k = 0; k < INPUT_ELEMENTS; k++)
            for (size_t g = 0; g < 6 * RG_GAUSS; g++)
                raise_figure(&free_stress, at(&o, CAUCHY, in, in->element[k], g), 0, scale);
        free_output(&o);
        input_free(in);
    }
    assert_true(state_figure(free_stress));
    assert_true(state_figure(held));
    assert_true(state_figure(work));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_reference),
                                       cmocka_unit_test(test_free_and_held)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
