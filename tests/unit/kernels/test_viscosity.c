/* Bulk viscosity: every set against the scalar reference, and what must hold of a pressure that resists the
 * change of volume alone. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/kernel_input.h"
#include "support/precision.h"

enum { NODAL = INPUT_EBLOCKS * RG_NODE_BLOCK };

typedef struct {
    input *in;
    rg_real *force, *stiffening;
    double *heat;
    rg_bulk_args bulk;
    rg_viscosity_args args;
} problem;

/* Forces and stiffening start from numbers of their own: the kernel adds to one and multiplies the other. */
static problem *make(input_kind kind) {
    problem *p = input_alloc(sizeof *p);
    p->in = input_make(kind, input_laws[0], 3, 0);
    p->force = input_alloc(NODAL * sizeof *p->force);
    p->stiffening = input_alloc(INPUT_ESLOTS * sizeof *p->stiffening);
    p->heat = input_alloc(INPUT_ESLOTS * sizeof *p->heat);
    for (size_t e = 0; e < INPUT_ESLOTS; e++)
        p->stiffening[e] = 1;
    p->bulk = input_bulk_args(p->in, p->force, NULL, p->stiffening);
    p->args = (rg_viscosity_args){.bulk = &p->bulk,
                                  .velocity = p->in->velocity,
                                  .linear = 0.06 * 1e4,
                                  .quadratic = 1.44,
                                  .damping = 0.3,
                                  .damping_rate = 1e-4,
                                  .allowed = 0.7,
                                  .dt = 1e-9,
                                  .heat = p->heat};
    return p;
}

static void release(problem *p) {
    input_free(p->in);
    free(p->force);
    free(p->stiffening);
    free(p->heat);
    free(p);
}

/* Gives every element the velocity L x of its deformed position, or of its reference one. */
static void set_velocity(problem *p, double L[3][3], int deformed) {
    const input *in = p->in;
    for (size_t e = 0; e < INPUT_ELEMENTS; e++)
        for (int n = 0; n < RG_NODES; n++)
            for (int i = 0; i < 3; i++) {
                double v = 0;
                for (int j = 0; j < 3; j++)
                    v += L[i][j] *
                         (in->x[e][n][j] + deformed * (double)in->u[rg_node_index(in->element[e], n, j)]);
                in->velocity[rg_node_index(in->element[e], n, i)] = (rg_real)v;
            }
}

static double largest(const rg_real *x, size_t n) {
    double m = 0;
    for (size_t i = 0; i < n; i++)
        m = fmax(m, fabs((double)x[i]));
    return m;
}

static void near(const char *set, const char *what, double got, double expected, double scale) {
    if (!(fabs(got - expected) <= TOLERANCE * scale))
        fail_msg("%s: %s is %.17g instead of %.17g", set, what, got, expected);
}

static void for_each_set(void (*check)(const rg_kernels *set, input_kind kind)) {
    const rg_kernels *sets[INPUT_SETS];
    int n = input_sets(sets, INPUT_SETS);
    for (int k = 0; k < n; k++)
        for (int kind = 0; kind < 2; kind++)
            check(sets[k], (input_kind)kind);
}

static void check_reference(const rg_kernels *set, input_kind kind) {
    problem *a = make(kind), *b = make(kind);
    double scale = 0;
    set->viscosity(&a->args, 0, INPUT_EBLOCKS);
    rg_kernels_reference.viscosity(&b->args, 0, INPUT_EBLOCKS);
    double size = largest(b->force, NODAL);
    for (size_t i = 0; i < NODAL; i++)
        near(set->name, "force", a->force[i], b->force[i], size);
    for (size_t e = 0; e < INPUT_ESLOTS; e++)
        scale = fmax(scale, b->heat[e]);
    for (size_t e = 0; e < INPUT_ESLOTS; e++) {
        near(set->name, "heat", a->heat[e], b->heat[e], scale);
        near(set->name, "stiffening", a->stiffening[e], b->stiffening[e], 1);
    }
    assert_true(size > 0 && scale > 0);
    release(a);
    release(b);
}

static void test_reference(void **state) {
    (void)state;
    for_each_set(check_reference);
}

/* The heat of an element is what its forces take from its motion, and never negative. */
static void check_power(const rg_kernels *set, input_kind kind) {
    problem *p = make(kind);
    set->viscosity(&p->args, 0, INPUT_EBLOCKS);
    for (size_t e = 0; e < INPUT_ESLOTS; e++) {
        double power = 0, size = 0;
        for (int k = 0; k < 3 * RG_NODES; k++) {
            size_t at = rg_node_index(e, k / 3, k % 3);
            power -= (double)p->force[at] * p->in->velocity[at];
            size += fabs((double)p->force[at] * p->in->velocity[at]);
        }
        assert_true(p->heat[e] >= 0);
        near(set->name, "power", p->heat[e], 1e-9 * power, 1e-9 * size);
    }
    release(p);
}

static void test_power(void **state) {
    (void)state;
    for_each_set(check_power);
}

/* A rotation in space changes no volume. */
static void check_rotation(const rg_kernels *set, input_kind kind) {
    problem *p = make(kind);
    double spin[3][3] = {{0, 3e4, -1e4}, {-3e4, 0, 2e4}, {1e4, -2e4, 0}};
    double swelling[3][3] = {{3e4, 0, 0}, {0, 3e4, 0}, {0, 0, 3e4}};
    set_velocity(p, swelling, 1);
    set->viscosity(&p->args, 0, INPUT_EBLOCKS);
    double size = largest(p->force, NODAL);
    memset(p->force, 0, NODAL * sizeof *p->force);
    set_velocity(p, spin, 1);
    set->viscosity(&p->args, 0, INPUT_EBLOCKS);
    assert_true(size > 0 && largest(p->force, NODAL) < TOLERANCE * size);
    release(p);
}

static void test_rotation(void **state) {
    (void)state;
    for_each_set(check_rotation);
}

/* In a body that is not deformed yet, closing at the rate r: q = rho h r (b1 c + b2^2 h r), and opening:
 * without the second part. */
static void check_pressure(const rg_kernels *set, input_kind kind) {
    (void)kind;
    for (int sign = -1; sign <= 1; sign += 2) {
        problem *p = make(INPUT_SMALL);
        double r = sign * 3e5, squeeze = fmax(r, 0),
               L[3][3] = {{-r / 2, 0, 0}, {0, -r / 4, 0}, {0, 0, -r / 4}};
        memset(p->in->u, 0, NODAL * sizeof *p->in->u);
        set_velocity(p, L, 0);
        set->viscosity(&p->args, 0, INPUT_EBLOCKS);
        for (size_t e = 0; e < INPUT_ELEMENTS; e++) {
            size_t slot = p->in->element[e];
            double most = 0, volume = p->in->geom[rg_geom_index(slot, RG_GEOM_VOLUME)], last[3] = {0, 0, 0};
            for (int k = 0; k < 4; k++) {
                double square = 0;
                for (int c = 0; c < 3; c++) {
                    double g = k < 3 ? p->in->geom[rg_geom_index(slot, RG_GEOM_GRAD + 3 * k + c)] : last[c];
                    last[c] -= g;
                    square += g * g;
                }
                most = fmax(most, square);
            }
            double h = 1 / sqrt(most), q = 3690 * h * (600 * r + 1.44 * h * squeeze * squeeze);
            double xi = 0.3 + 1e-4 * h * squeeze, factor = (sqrt(1 + xi * xi) + xi) * 0.7;
            near(set->name, "heat", p->heat[slot], 1e-9 * volume * q * r, 1e-9 * volume * q * r);
            near(set->name, "stiffening", p->stiffening[slot], factor * factor, 1);
        }
        release(p);
    }
}

static void test_pressure(void **state) {
    (void)state;
    for_each_set(check_pressure);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_reference),
        cmocka_unit_test(test_power),
        cmocka_unit_test(test_rotation),
        cmocka_unit_test(test_pressure),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
