/* The adaptive time step (3.14) in the solver: opening rates against (3.15) from the displacement itself, and
 * the step that follows from them. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <mpi.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "case/case.h"
#include "case/read.h"
#include "reference/reference.h"
#include "solver/step_limiter.h"
#include "solver/setup.h"
#include "solver/step.h"
#include "solver/spectrum.h"
#include "solver/tile.h"

#define ASCENT 0.1
#define PULL   "boundary=[{set: z+, component: z, velocity: 2e8*t}, {set: z-, component: z, velocity: -2e8*t}]"
#define STEPS  200.0

enum { MOST_STEPS = 3000 };

static rg_case *read_case(void) {
    static const char *const override[] = {
        "mesh.cells=[2, 2, 6]",        "mesh.jitter=0.1",        "mesh.size=[2e-4, 2e-4, 6e-4]",
        "mesh.origin=[0, 0, 0]",       "output.probes=[]",       PULL,
        "interface.form=intrinsic",    "interface.law=bilinear", "interface.bilinear.ascent=0.1",
        "interface.bilinear.steps=200"};
    rg_case *c = rg_case_read(RG_SOURCE_ROOT "/bench/examples/spall/spall.yaml",
                              sizeof override / sizeof *override, override, stderr);
    assert_non_null(c);
    return c;
}

/* Effective opening of point q over the critical one. The normal is that of the body at rest: strains are
 * below a per cent, and it matters at closed points alone. */
static double opening(const rg_solver *s, const rg_tile *t, size_t i, int q, const double normal[3]) {
    double l[3], shape[RG_FNODES], jump[3] = {0, 0, 0};
    rg_reference_face_point(q, l);
    rg_reference_face_shape(l, shape);
    for (int c = 0; c < 3; c++) {
        for (int a = 0; a < RG_FNODES; a++) {
            jump[c] += shape[a] * (rg_tile_trace(s, t, i, 1, a, c) - rg_tile_trace(s, t, i, 0, a, c));
        }
    }
    double area = sqrt(rg_reference_dot(normal, normal)), along = rg_reference_dot(jump, normal) / area;
    double across = fmax(0, rg_reference_dot(jump, jump) - along * along);
    return sqrt(across + fmax(0, along) * fmax(0, along)) / s->model->law.opening;
}

/* max xi/dt of all points by (3.15); `x` holds their openings of the state before and gets those of this one.
 * `widest`: the largest of them. */
static double opening_rate_of(const rg_solver *s, double *x, double dt, double *widest) {
    double most = 0;
    for (size_t k = 0; k < s->domain->tiles; k++) {
        const rg_tile *t = &s->domain->tile[k];
        for (size_t i = t->ibegin * RG_LANES; i < t->iend * RG_LANES; i++) {
            double normal[3], area = rg_interface_area(s->domain, i, normal);
            for (int q = 0; q < RG_POINTS && area > 0; q++) {
                double *before = &x[i * RG_POINTS + (size_t)q], now = opening(s, t, i, q, normal);
                double part = now < ASCENT ? ASCENT : 1 - ASCENT;
                most = now < 1 && dt > 0 ? fmax(most, fabs(now - *before) / part / dt) : most;
                *widest = fmax(*widest, now);
                *before = now;
            }
        }
    }
    return most;
}

/* The step is the smaller one of (3.14), within the rounding of solver/step_limiter.h. */
static void check_step(double got, double dt, double opening_rate) {
    double cohesive = 1 / (opening_rate * STEPS);
    assert_true(got <= fmin(dt, cohesive) * (1 + 1e-12));
    assert_true(got >= fmin(dt, cohesive * exp2(-0.25)) * (1 - 1e-12));
}

static void test_step_follows_the_opening(void **state) {
    rg_case *c = read_case();
    rg_solver *s = rg_solver_make(c, MPI_COMM_SELF);
    double *x = calloc(s->domain->iblocks * RG_LANES * RG_POINTS, sizeof *x), widest = 0, least = 1,
           fastest = 0;
    (void)state;
    assert_non_null(x);
    rg_spectrum(s);
    double still = 0.5 * 2 / sqrt(s->omega2);
    rg_solver_start(s);
    int steps = 0;
    for (; widest < 1.5 * ASCENT && steps < MOST_STEPS; steps++) {
        double dt = rg_limited_step(s, still), climb = widest;
        check_step(dt, still, s->opening_rate);
        double expected = opening_rate_of(s, x, s->dt, &widest);
        if (climb > 0.1 * ASCENT && widest < ASCENT) { /* at first the predictor lags too far behind */
            fastest = fmax(fastest, (widest - climb) / ASCENT * STEPS);
        }
        rg_solver_step(s, dt);
        assert_true(fabs(s->opening_rate - expected) <= 1e-3 * expected);
        least = fmin(least, dt / still);
    }
    assert_true(steps < MOST_STEPS);
    assert_true(least < 0.5); /* it did matter */
    assert_true(fastest < 1.25 && fastest > 0.5);
    free(x);
    rg_solver_free(s);
    rg_case_free(c);
}

/* Without `steps`, and for other laws, the step stays as it is and nothing is kept for it. */
static void test_no_limit_without_steps(void **state) {
    (void)state;
    rg_case *c = read_case();
    c->interface.shape[RG_LAW_BILINEAR][RG_LIMITER_STEPS] = 0;
    rg_solver *s = rg_solver_make(c, MPI_COMM_SELF);
    rg_solver_start(s);
    rg_solver_step(s, 1e-12);
    rg_solver_step(s, 1e-12);
    assert_null(s->tile_opening_rate);
    assert_true(rg_limited_step(s, 3e-9) >= 3e-9);
    rg_solver_free(s);
    rg_case_free(c);
}

int main(int argc, char **argv) {
    omp_set_num_threads(1);
    MPI_Init(&argc, &argv);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_step_follows_the_opening),
        cmocka_unit_test(test_no_limit_without_steps),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    MPI_Finalize();
    return failed;
}
