/* Stress before any deformation: every set against the scalar reference in random states, and the reference
 * against what its potential says of it. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reference/material.h"
#include "reference/reference.h"
#include "stressed.h"
#include "support/dice.h"
#include "support/kernel_input.h"
#include "support/precision.h"

enum {
    NODAL = INPUT_EBLOCKS * RG_NODE_BLOCK,
    TRACTION = INPUT_EBLOCKS * RG_TRACTION_BLOCK,
    STRESS = INPUT_EBLOCKS * RG_PRESTRESS_BLOCK,
    CAUCHY = INPUT_EBLOCKS * RG_GAUSS * 6 * RG_LANES
};

static const double most = 3e9; /* of the stress (Pa), whose components are of both signs */

/* All that the kernels write starts from numbers of its own, since they add to it. */
typedef struct {
    input *in;
    rg_real *stress, *force, *traction, *stiffening;
    double *energy, *cauchy;
    rg_bulk_args bulk;
} problem;

static problem *make(input_kind kind, rg_gradient gradient, rg_material_model model) {
    dice d = {.seed = 11};
    problem *p = input_alloc(sizeof *p);
    p->in = input_make(kind, input_laws[0], 3, 0);
    input_break(p->in, 0.3); /* points out of the lift */
    input_set_model(p->in, model);
    p->stress = input_alloc(STRESS * sizeof *p->stress);
    p->force = input_alloc(NODAL * sizeof *p->force);
    p->traction = input_alloc(TRACTION * sizeof *p->traction);
    p->stiffening = input_alloc(INPUT_ESLOTS * sizeof *p->stiffening);
    p->energy = input_alloc(INPUT_ESLOTS * sizeof *p->energy);
    p->cauchy = input_alloc(CAUCHY * sizeof *p->cauchy);
    for (size_t i = 0; i < STRESS; i++)
        p->stress[i] = (rg_real)(most * (2 * dice_unit(&d) - 1));
    for (size_t i = 0; i < NODAL; i++)
        p->force[i] = (rg_real)(2 * dice_unit(&d) - 1);
    for (size_t i = 0; i < TRACTION; i++)
        p->traction[i] = (rg_real)(2 * dice_unit(&d) - 1);
    for (size_t i = 0; i < INPUT_ESLOTS; i++) {
        p->stiffening[i] = (rg_real)(1 + dice_unit(&d));
        p->energy[i] = 1e-6 * dice_unit(&d);
    }
    for (size_t i = 0; i < CAUCHY; i++)
        p->cauchy[i] = 1e9 * dice_unit(&d);
    p->bulk = input_bulk_args(p->in, p->force, p->traction, p->stiffening);
    p->bulk.gradient = gradient;
    return p;
}

static void release(problem *p) {
    input_free(p->in);
    void *blocks[] = {p->stress, p->force, p->traction, p->stiffening, p->energy, p->cauchy, p};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
        free(blocks[i]);
}

static void run(const rg_kernels *set, problem *p) {
    rg_bulk_state_args state = {.bulk = &p->bulk, .energy = p->energy, .cauchy = p->cauchy};
    set->prestress(&(rg_prestress_args){&p->bulk, p->stress}, 0, INPUT_EBLOCKS);
    set->prestress_state(&(rg_prestress_state_args){&state, p->stress}, 0, INPUT_EBLOCKS);
}

/* ---- against the reference ---- */

static double largest(const rg_real *x, size_t n) {
    double m = 0;
    for (size_t i = 0; i < n; i++)
        m = fmax(m, fabs((double)x[i]));
    return m;
}

/* Padding has no element. */
static void compare(const char *set, const char *what, const rg_real *got, const rg_real *expected,
                    size_t n) {
    double scale = largest(expected, n);
    for (size_t i = 0; i < n; i++)
        if (!(fabs((double)got[i] - (double)expected[i]) <= TOLERANCE * scale))
            fail_msg("%s: %s %zu is %.9g instead of %.9g, of at most %.9g", set, what, i, (double)got[i],
                     (double)expected[i], scale);
}

static void compare_wide(const char *set, const char *what, const double *got, const double *expected,
                         size_t n) {
    double scale = 0;
    for (size_t i = 0; i < n; i++)
        scale = fmax(scale, fabs(expected[i]));
    for (size_t i = 0; i < n; i++)
        if (!(fabs(got[i] - expected[i]) <= TOLERANCE * scale))
            fail_msg("%s: %s %zu is %.17g instead of %.17g, of at most %.9g", set, what, i, got[i],
                     expected[i], scale);
}

static void test_against_reference(void **state) {
    (void)state;
    const rg_kernels *sets[INPUT_SETS];
    int n = input_sets(sets, INPUT_SETS);
    static const rg_material_model models[] = {RG_MATERIAL_NEO_HOOKEAN, RG_MATERIAL_ANISOTROPIC,
                                               RG_MATERIAL_J2};
    for (int k = 0; k < 12 * n; k++) {
        const rg_kernels *set = sets[k / 12];
        rg_material_model model = models[k / 4 % 3];
        input_kind kind = k % 2 == 0 ? INPUT_SMALL : INPUT_LARGE;
        rg_gradient gradient = k / 2 % 2 == 0 ? RG_GRADIENT_OWN : RG_GRADIENT_LIFTED;
        problem *p = make(kind, gradient, model), *twin = make(kind, gradient, model);
        run(set, p);
        run(&rg_kernels_reference, twin);
        compare(set->name, "force", p->force, twin->force, NODAL);
        compare(set->name, "traction", p->traction, twin->traction, TRACTION);
        compare(set->name, "stiffening", p->stiffening, twin->stiffening, INPUT_ESLOTS);
        compare_wide(set->name, "energy", p->energy, twin->energy, INPUT_ESLOTS);
        compare_wide(set->name, "stress", p->cauchy, twin->cauchy, CAUCHY);
        release(p);
        release(twin);
    }
}

/* ---- the reference against its potential ---- */

static double energy_of(problem *p, size_t slot) {
    rg_bulk_state_args state = {.bulk = &p->bulk, .energy = p->energy};
    memset(p->energy, 0, INPUT_ESLOTS * sizeof *p->energy);
    rg_reference_prestress_state(&(rg_prestress_state_args){&state, p->stress}, 0, INPUT_EBLOCKS);
    return p->energy[slot];
}

/* Forces are its gradient (the energy is quadratic in u, so that central differences of any width are exact);
 * at rest it is what the stress stores by Hooke's law, here of one component, and the stress is that given.
 */
static void test_potential(void **state) {
    (void)state;
    problem *p = make(INPUT_LARGE, RG_GRADIENT_OWN, RG_MATERIAL_NEO_HOOKEAN);
    memset(p->force, 0, NODAL * sizeof *p->force);
    rg_reference_prestress(&(rg_prestress_args){&p->bulk, p->stress}, 0, INPUT_EBLOCKS);
    double scale = largest(p->force, NODAL), width = 0.1 * INPUT_SIZE;
    for (size_t e = 0; e < INPUT_ELEMENTS; e += 17)
        for (int i = 0; i < 3 * RG_NODES; i++) {
            size_t slot = p->in->element[e], at = rg_node_index(slot, i / 3, i % 3);
            rg_real before = p->in->u[at];
            p->in->u[at] = (rg_real)(before + width);
            double high = energy_of(p, slot), step = p->in->u[at];
            p->in->u[at] = (rg_real)(before - width);
            double low = energy_of(p, slot);
            step -= p->in->u[at];
            p->in->u[at] = before;
            if (!(fabs((low - high) / step - (double)p->force[at]) <= TOLERANCE * scale))
                fail_msg("force %.9g instead of %.9g of at most %.9g", (double)p->force[at],
                         (low - high) / step, scale);
        }
    memset(p->in->u, 0, NODAL * sizeof *p->in->u);
    memset(p->stress, 0, STRESS * sizeof *p->stress);
    memset(p->cauchy, 0, CAUCHY * sizeof *p->cauchy);
    for (size_t i = 0; i < STRESS; i++) /* shear yz alone */
        p->stress[i] = (rg_real)(i / RG_LANES % 6 == 3 ? most : 0);
    for (size_t e = 0; e < INPUT_ELEMENTS; e++) {
        size_t slot = p->in->element[e];
        double volume = (double)p->in->geom[rg_geom_index(slot, RG_GEOM_VOLUME)];
        double stored = volume * most * most / (2 * p->in->material.mu);
        assert_true(fabs(energy_of(p, slot) / stored - 1) <= TOLERANCE);
    }
    rg_bulk_state_args at_rest = {.bulk = &p->bulk, .cauchy = p->cauchy};
    rg_reference_prestress_state(&(rg_prestress_state_args){&at_rest, p->stress}, 0, INPUT_EBLOCKS);
    for (size_t e = 0; e < INPUT_ELEMENTS; e++)
        for (size_t k = 0; k < RG_GAUSS * 6; k++) {
            size_t slot = p->in->element[e];
            double got = p->cauchy[(slot / RG_LANES * RG_GAUSS * 6 + k) * RG_LANES + slot % RG_LANES];
            assert_true(fabs(got - (k % 6 == 3 ? most : 0)) <= TOLERANCE * most);
        }
    release(p);
}

/* The same of a mean stress, whose energy is not quadratic. */
static void test_potential_of_pressure(void **state) {
    (void)state;
    problem *p = make(INPUT_LARGE, RG_GRADIENT_OWN, RG_MATERIAL_JOHNSON_COOK);
    memset(p->force, 0, NODAL * sizeof *p->force);
    rg_reference_prestress(&(rg_prestress_args){&p->bulk, p->stress}, 0, INPUT_EBLOCKS);
    double scale = largest(p->force, NODAL), width = sizeof(rg_real) < sizeof(double) ? 1e-2 : 1e-4;
    for (size_t e = 0; e < INPUT_ELEMENTS; e += 17)
        for (int i = 0; i < 3 * RG_NODES; i++) {
            size_t slot = p->in->element[e], at = rg_node_index(slot, i / 3, i % 3);
            rg_real before = p->in->u[at];
            p->in->u[at] = (rg_real)(before + width * INPUT_SIZE);
            double high = energy_of(p, slot), step = p->in->u[at];
            p->in->u[at] = (rg_real)(before - width * INPUT_SIZE);
            double low = energy_of(p, slot);
            step -= p->in->u[at];
            p->in->u[at] = before;
            assert_true(fabs((low - high) / step - (double)p->force[at]) <= 30 * width * width * scale);
        }
    memset(p->in->u, 0, NODAL * sizeof *p->in->u);
    size_t slot = p->in->element[0];
    double bulk = p->in->material.lambda + 2.0 / 3 * p->in->material.mu, stored = 0;
    for (int g = 0; g < RG_GAUSS; g++) {
        double mean =
            p->stress[slot / RG_LANES * RG_PRESTRESS_BLOCK + (size_t)(6 * g) * RG_LANES + slot % RG_LANES];
        stored += 0.25 * (double)p->in->geom[rg_geom_index(slot, RG_GEOM_VOLUME)] * mean * mean / (2 * bulk);
    }
    assert_true(fabs(energy_of(p, slot) / stored - 1) <= TOLERANCE);
    release(p);
}

/* Inverse of the stiffness of a solid without symmetries, and of the isotropic ones in their closed form. */
static void test_compliance(void **state) {
    (void)state;
    problem *p = make(INPUT_SMALL, RG_GRADIENT_OWN, RG_MATERIAL_ANISOTROPIC);
    const rg_material *m = &p->in->material;
    double inverse[6][6];
    rg_material_compliance(m, inverse);
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) {
            double sum = 0;
            for (int k = 0; k < 6; k++) {
                int low = i < k ? i : k, high = i < k ? k : i;
                sum +=
                    m->of.anisotropic.stiffness[6 * low - low * (low - 1) / 2 + high - low] * inverse[k][j];
            }
            assert_true(fabs(sum - (i == j)) < 1e-14);
        }
    release(p);
}

/* Each solid that flows has the stress that it was given, at its own strain and beside it. */
static void test_stress_inside(void **state) {
    (void)state;
    static const struct {
        rg_material_model model;
        rg_reference_point_law *law;
    } solids[] = {{RG_MATERIAL_J2, rg_reference_point_j2},
                  {RG_MATERIAL_JOHNSON_COOK, rg_reference_point_johnson_cook},
                  {RG_MATERIAL_DRUCKER_PRAGER, rg_reference_point_drucker_prager},
                  {RG_MATERIAL_JOHNSON_HOLMQUIST, rg_reference_point_johnson_holmquist}};
    static const double part[6] = {-0.03, 0.01, -0.02, 0.004, -0.005, 0.006};
    static const int row[6] = {0, 1, 2, 1, 0, 0}, column[6] = {0, 1, 2, 2, 2, 1};
    for (size_t i = 0; i < sizeof solids / sizeof *solids; i++) {
        problem *p = make(INPUT_SMALL, RG_GRADIENT_OWN, solids[i].model);
        rg_material m = p->in->material;
        rg_material_prepare(&m, 1e-9);
        double F[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, P[3][3], stress[6], history[32] = {0};
        rg_reference_point out;
        for (int k = 0; k < 6; k++)
            stress[k] = part[k] * m.mu;
        rg_material_take_stress(&m, stress, history);
        solids[i].law(&m, false, F, history, P, &out);
        for (int k = 0; k < 6; k++)
            assert_true(fabs(P[row[k]][column[k]] + stress[k] - part[k] * m.mu) < 1e-14 * m.mu);
        release(p);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_against_reference),     cmocka_unit_test(test_potential),
        cmocka_unit_test(test_potential_of_pressure), cmocka_unit_test(test_compliance),
        cmocka_unit_test(test_stress_inside),
    };
    return cmocka_run_group_tests_name("prestress", tests, NULL, NULL);
}
