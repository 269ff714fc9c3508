/* Materials through the solver against their pointwise reference: a cube of six tetrahedra whose sides are
 * moved so that the deformation stays homogeneous, F = Q (I + t L), feels at each of its points what one
 * point of the model feels; Q is a rotation of space, which must change nothing but the axes. */
#include <mpi.h>
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "case/read.h"
#include "reference/deshpande_evans.h"
#include "reference/material.h"
#include "reference/reference.h"
#include "solver/setup.h"
#include "solver/step.h"
#include "solver/spectrum.h"
#include "solver/tile.h"
#include "support/figures.h"

typedef struct {
    const char *name;
    double rate[3]; /* diagonal of L (1/s) */
    double strain;  /* up to which |t L_zz| goes */
} path;

/* Uniaxial strain, also to where the solid flows, and the uniaxial stress of the elastic solid; compression
 * ends in the middle of failure: there the rate of growth multiplies what rounding left. */
static const path paths[] = {
    {"uniaxial strain, compression", {0, 0, -1e5}, 0.04},
    {"uniaxial strain, flow", {0, 0, -1e6}, 0.15},
    {"uniaxial strain, tension", {0, 0, 1e5}, 0.02},
    {"compression", {0.2e5, 0.2e5, -1e5}, 0.015},
    {"tension", {-0.2e5, -0.2e5, 1e5}, 0.02},
};
enum { PATHS = sizeof paths / sizeof *paths };

static const double still[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
/* By 1 rad about (1, 2, 2)/3. */
static double turned[3][3];

static void make_rotation(double Q[3][3]) {
    const double n[3] = {1.0 / 3, 2.0 / 3, 2.0 / 3}, c = cos(1), s = sin(1);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int k = 3 - i - j;
            double sign = i == j ? 0 : (j - i + 3) % 3 == 1 ? -1 : 1;
            Q[i][j] = (i == j) * c + (1 - c) * n[i] * n[j] + (i == j ? 0 : sign * s * n[k]);
        }
}

/* ---- The case ---- */

/* Component c of Q diag(d) X, as an expression. */
static void expression(const double Q[3][3], const double d[3], int c, char *text, size_t size) {
    snprintf(text, size, "\"(%.17g)*x+(%.17g)*y+(%.17g)*z\"", Q[c][0] * d[0], Q[c][1] * d[1], Q[c][2] * d[2]);
}

static void write_case(FILE *f, const path *p, const double Q[3][3]) {
    static const char *const set[] = {"x-", "x+", "y-", "y+", "z-", "z+"};
    char text[200];
    fputs(
        "mesh: {cells: [1, 1, 1], size: [1e-4, 1e-4, 1e-4]}\n"
        "material: {model: deshpande-evans, shear: 146e9, poisson: 0.2, density: 3700, flaw_radius: 19e-6,\n"
        "  flaw_density: 1e12, toughness: 3e6, yield_stress: 4e9}\n"
        "interface: {law: none}\ntime: {end: 1}\noutput: {fields: []}\ninitial:\n",
        f);
    for (int what = 0; what < 2; what++) {
        fprintf(f, "  %s: {", what == 0 ? "displacement" : "velocity");
        for (int c = 0; c < 3; c++) {
            double R[3][3];
            for (int k = 0; k < 9; k++)
                R[k / 3][k % 3] = Q[k / 3][k % 3] - (what == 0 && k % 4 == 0);
            expression((const double(*)[3])R, what == 0 ? (double[]){1, 1, 1} : p->rate, c, text,
                       sizeof text);
            fprintf(f, "%s%c: %s", c > 0 ? ", " : "", "xyz"[c], text);
        }
        fputs("}\n", f);
    }
    fputs("boundary:\n", f);
    for (int k = 0; k < 18; k++) {
        expression(Q, p->rate, k % 3, text, sizeof text);
        fprintf(f, "  - {set: %s, component: %c, velocity: %s}\n", set[k / 3], "xyz"[k % 3], text);
    }
}

static rg_case *make_case(const path *p, const double Q[3][3]) {
    char file[] = "/tmp/test_material.XXXXXX";
    int fd = mkstemp(file);
    FILE *f = fdopen(fd, "w");
    assert_non_null(f);
    write_case(f, p, Q);
    fclose(f);
    rg_case *c = rg_case_read(file, 0, NULL, stderr);
    remove(file);
    assert_non_null(c);
    return c;
}

/* ---- Comparison ---- */

/* A point of the reference. */
typedef struct {
    double F[3][3], history[RG_DE_HISTORY], P[3][3];
    rg_reference_de_result result;
    double plastic, damage; /* released since the start (J/m^3) */
} twin;

static void follow(twin *t, const path *p, const double Q[3][3], double time, double dt) {
    const rg_deshpande_evans alumina = rg_deshpande_evans_alumina();
    for (int k = 0; k < 9; k++)
        t->F[k / 3][k % 3] = Q[k / 3][k % 3] * (1 + time * p->rate[k % 3]);
    t->result = rg_reference_de_step(&alumina, dt, t->F, t->history, t->P);
    t->plastic += t->result.plastic;
    t->damage += t->result.damage;
}

static figure history = {"ceramic in the solver against one point: history", .bound = 8e-11, .why = ROUNDING},
              stress = {"ceramic in the solver against one point: stress, of the shear modulus",
                        .bound = 3e-12, .why = ROUNDING},
              stored = {"ceramic in the solver against one point: energy stored, of 1 GJ/m3",
                        .bound = 3.3e-12, .why = ROUNDING},
              released = {"ceramic in the solver against one point: energy set free, of 1 GJ/m3",
                          .bound = 1.4e-12, .why = ROUNDING},
              history_turned = {"ceramic in the solver, turned by 1 rad: history", .bound = 2.5e-12,
                                .why = ROUNDING};

/* The points of an element with the reference point; its energy (J) and, of a block, the stresses. */
static void compare_element(const path *p, const rg_solver *s, size_t slot, const twin *t, double energy,
                            const double *cauchy) {
    static const int row[6] = {0, 1, 2, 1, 0, 0}, column[6] = {0, 1, 2, 2, 2, 1};
    double J = 1, volume = 1e-12 / 6;
    const size_t rows = RG_GAUSS * RG_DE_HISTORY;
    for (int k = 0; k < 3; k++)
        J *= 1 + s->time * p->rate[k];
    for (size_t k = 0; k < rows; k++)
        raise_figure(&history, s->history[rg_history_index(slot, s->model->history_stride, k)],
                     t->history[k % RG_DE_HISTORY], k % RG_DE_HISTORY == RG_DE_GROWTH ? 3 : 1);
    for (size_t k = 0; k < 6 * RG_GAUSS; k++) {
        double sigma = rg_reference_dot(t->P[row[k % 6]], t->F[column[k % 6]]) / J;
        raise_figure(&stress, cauchy[k * RG_LANES + slot % RG_LANES], sigma, 146e9);
    }
    raise_figure(&stored, energy, volume * t->result.energy, 1e9 * volume);
    raise_figure(&released,
                 s->history[rg_history_index(slot, s->model->history_stride, rows + RG_RELEASED_PLASTIC)],
                 volume * t->plastic, 1e9 * volume);
    raise_figure(&released,
                 s->history[rg_history_index(slot, s->model->history_stride, rows + RG_RELEASED_DAMAGE)],
                 volume * t->damage, 1e9 * volume);
}

static void compare(const path *p, rg_solver *s, const twin *t) {
    _Alignas(64) double cauchy[RG_GAUSS * 6 * RG_LANES], energy[RG_LANES];
    int elements = 0;
    for (const rg_tile *tile = s->domain->tile; tile < s->domain->tile + s->domain->tiles; tile++) {
        rg_bulk_args bulk = rg_tile_bulk(s, tile, &s->work[0], 0);
        rg_bulk_state_args args = {.bulk = &bulk, .energy = energy, .cauchy = cauchy};
        rg_tile_receive(s, tile, &s->work[0]);
        for (size_t block = tile->begin; block < tile->end; block++) {
            s->kernels->bulk_state(&args, block - tile->begin, block - tile->begin + 1);
            for (size_t l = 0; l < RG_LANES; l++)
                if (s->domain->id[block * RG_LANES + l] >= 0) {
                    compare_element(p, s, block * RG_LANES + l, t, energy[l], cauchy);
                    elements++;
                }
        }
    }
    assert_int_equal(elements, 6);
}

static void check_path(const path *p, const double Q[3][3], twin *t) {
    rg_case *c = make_case(p, Q);
    rg_solver *s = rg_solver_make(c, MPI_COMM_WORLD);
    rg_spectrum(s);
    rg_solver_start(s);
    double dt = 0.3 * 2 / sqrt(s->omega2);
    *t = (twin){.plastic = 0};
    while (fabs(s->time * p->rate[2]) < p->strain) {
        rg_solver_kick(s, dt);
        follow(t, p, Q, s->time, s->dt);
        compare(p, s, t);
        rg_solver_drift(s);
    }
    print_message("# %s: %lld steps, X = %.3g, ep = %.3g, sigma_zz = %.4g GPa\n", p->name, (long long)s->step,
                  t->history[RG_DE_GROWTH], t->history[RG_DE_STRAIN], 1e-9 * t->P[2][2]);
    rg_solver_free(s);
    rg_case_free(c);
}

static void test_paths(void **state) {
    (void)state;
    for (int k = 0; k < PATHS; k++) {
        twin a, b;
        check_path(&paths[k], still, &a);
        check_path(&paths[k], (const double(*)[3])turned, &b);
        for (size_t i = 0; i < RG_DE_HISTORY; i++)
            raise_figure(&history_turned, b.history[i], a.history[i], i == RG_DE_GROWTH ? 3 : 1);
    }
    assert_true(state_figure(history));
    assert_true(state_figure(stress));
    assert_true(state_figure(stored));
    assert_true(state_figure(released));
    assert_true(state_figure(history_turned));
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    make_rotation(turned);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_paths),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    MPI_Finalize();
    return failed;
}
