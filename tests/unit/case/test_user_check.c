/* The checks of a user's material: one that is right passes them, with and without a history, and each fault
 * is told with its number. The material stands in for a library: St. Venant and Kirchhoff's solid with a
 * damage that the largest energy brings, (1 - D) W0, D = W0/(W0 + c). */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "case/user.h"

#define LAMBDA 70e9
#define MU     50e9

typedef enum {
    RIGHT,
    ENERGY,     /* of another solid */
    STEP,       /* stress of the step other than that of the state */
    TURNED,     /* stress that does not turn with the solid */
    MOMENT,     /* ... that has a moment */
    AT_REST,    /* ... at rest */
    STIFF,      /* moduli less than those at rest */
    BOUND,      /* bound on the stiffening that is none */
    INSIDE_OUT, /* not noticed */
    NO_NUMBER,  /* likewise */
    LANES,      /* that know of each other */
    MEMORY,     /* of the call before */
    BOOKS,      /* not all of what is set free is booked */
    GAIN,       /* of energy in a cycle: it stiffens, and all is booked */
    PATH,       /* a history in space, which does not turn with the solid */
} fault;

static fault planted;
static double critical; /* c (J/m^3); infinite: no damage; < 0: strain makes it stiffer */
static int calls;

static double damage_of(double W0) {
    return W0 / (W0 + critical);
}

/* Integral of W0 dD. */
static double released_by(double W0) {
    return critical * (log1p(W0 / critical) - W0 / (W0 + critical));
}

static double determinant(const double F[9]) {
    return F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) +
           F[2] * (F[3] * F[7] - F[4] * F[6]);
}

/* Stress and energy of the undamaged solid at F. */
static double elastic(const double F[9], double P[3][3]) {
    double E[3][3], trace = 0, square = 0;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            double C = F[i] * F[j] + F[3 + i] * F[3 + j] + F[6 + i] * F[6 + j];
            E[i][j] = planted == TURNED ? (F[3 * i + j] + F[3 * j + i]) / 2 - (i == j) : (C - (i == j)) / 2;
            square += E[i][j] * E[i][j];
        }
        trace += E[i][i];
    }
    for (int i = 0; i < 3; i++) {
        for (int J = 0; J < 3; J++) {
            P[i][J] = 0;
            for (int K = 0; K < 3; K++) {
                double S = LAMBDA * trace * (J == K) + 2 * MU * E[J][K];
                P[i][J] += (planted == TURNED ? i == K : F[3 * i + K]) * S;
            }
        }
    }
    for (int i = 0; i < 3 && planted == MOMENT; i++) { /* F times a skew tensor of 700 Pa */
        P[i][1] += 700 * F[3 * i];
        P[i][0] -= 700 * F[3 * i + 1];
    }
    P[2][2] += planted == AT_REST ? 1e4 : 0;
    return LAMBDA / 2 * trace * trace + MU * square;
}

static void one_point(rg_user_point *p, bool advance) {
    double F[9], P[3][3], norm = 0, worst = 0;
    for (int k = 0; k < 9; k++) {
        F[k] = p->H[k / 3][k % 3] + (k % 4 == 0);
        norm += p->H[k / 3][k % 3] * p->H[k / 3][k % 3];
    }
    for (int i = 0; i < 3; i++) {
        double row = 0;
        for (int j = 0; j < 3; j++) {
            row += fabs(F[3 * i] * F[3 * j] + F[3 * i + 1] * F[3 * j + 1] + F[3 * i + 2] * F[3 * j + 2]);
        }
        worst = fmax(worst, row);
    }
    double W0 = elastic(F, P), before = p->history[0], J = determinant(F);
    if (planted == PATH) { /* counts only what stretches along x of space */
        if (advance && F[0] * F[0] + F[1] * F[1] + F[2] * F[2] > 1 + before / MU) {
            p->history[0] = MU * (F[0] * F[0] + F[1] * F[1] + F[2] * F[2] - 1);
        }
    } else if (advance && isfinite(critical)) {
        p->history[0] = fmax(before, W0);
    }
    double left = isfinite(critical) ? 1 - damage_of(p->history[0]) : 1;
    for (int k = 0; k < 9; k++) {
        p->state_P[k / 3][k % 3] = left * P[k / 3][k % 3];
        p->P[k / 3][k % 3] = left * P[k / 3][k % 3] * (planted == STEP ? 1 + 1e-3 : 1);
    }
    p->energy = left * W0 * (planted == ENERGY ? 1 + 1e-3 : 1);
    p->J = J;
    double bound = worst + sqrt(norm) * (3 * LAMBDA + 2 * MU) / (LAMBDA + 2 * MU);
    p->stiffening = planted == BOUND ? 0.9 : bound;
    p->stiffening = J > 0 || planted == INSIDE_OUT ? p->stiffening : NAN;
    p->stiffening = !isnan(J) || planted != NO_NUMBER ? p->stiffening : 1;
    p->released[RG_RELEASED_DAMAGE] =
        isfinite(critical) ? released_by(p->history[0]) - released_by(before) : 0;
    p->released[RG_RELEASED_DAMAGE] *= planted == BOOKS ? 0.5 : 1;
}

static void points(const rg_material *m, bool advance, rg_user_point p[RG_LANES]) {
    (void)m;
    calls++;
    for (int l = 0; l < RG_LANES; l++) {
        one_point(&p[l], advance);
    }
    p[0].P[1][1] *= planted == LANES ? 1 + 1e-15 * (double)(p[1].H[0][0] > 0) : 1;
    p[0].P[1][1] += planted == MEMORY ? calls : 0;
}

static void moduli(const double parameter[], double *lambda, double *mu) {
    (void)parameter;
    *lambda = LAMBDA;
    *mu = MU;
}

static const rg_user_facts facts = {.name = "solid", .moduli = moduli};

static bool passes(fault f, double c, rg_user_report *r, char *why, size_t size) {
    planted = f;
    critical = c;
    rg_user_material u = {.facts = &facts, .history = isfinite(c) ? 1 : 0, .points = points};
    rg_material m = {.model = RG_MATERIAL_USER,
                     .lambda = LAMBDA,
                     .mu = MU * (f == STIFF ? 0.99 : 1),
                     .density = 1,
                     .of.user.library = &u};
    why[0] = '\0';
    return rg_user_check(&m, r, why, size);
}

static void test_a_right_one_passes(void **state) {
    (void)state;
    rg_user_report r;
    char why[512];
    for (int k = 0; k < 2; k++) {
        bool good = passes(RIGHT, k == 0 ? (double)INFINITY : 5e5, &r, why, sizeof why);
        assert_string_equal(why, "");
        assert_true(good && r.energetic && r.path == (k == 1));
        assert_true(r.energy < 1e-7 && r.turned < 1e-9 && r.symmetric < 1e-13 && r.tangent < 1e-9);
        assert_true(fabs(r.modulus[1] - 1) < 1e-6 && fabs(r.modulus[0] - 1) < 1e-6 && r.stiffening < 1);
        assert_true(k == 0 || (r.balance < 3e-3 && r.path_turned < 1e-12 && r.released > 0.3));
    }
}

static const struct {
    fault fault;
    double critical;
    const char *words;
} faults[] = {
    {ENERGY, INFINITY, "the stress is not the derivative of the energy: they differ by 0.001"},
    {STEP, INFINITY, "material_step and material_state give stresses that differ by 0.001"},
    {TURNED, INFINITY, "not objective: a turned solid has stresses or energies that are off by "},
    {MOMENT, INFINITY, "Kirchhoff's stress is not symmetric: it differs from its transpose by "},
    {AT_REST, INFINITY, "a stress of 1e+04 Pa at rest"},
    {STIFF, INFINITY, "at rest its acoustic tensor is 1.006 to 1.01 times"},
    {BOUND, INFINITY, "the bound `stiffening` is too low"},
    {INSIDE_OUT, INFINITY, "where F is inside out"},
    {NO_NUMBER, INFINITY, "and 1 where F is not a number"},
    {LANES, INFINITY, "lanes must not know of each other"},
    {MEMORY, INFINITY, "nor calls of earlier ones"},
    {BOOKS, 5e5, "the energy of a cycle of strain does not add up"},
    {GAIN, -1e9, "of the work put in: it makes energy"},
    {PATH, 5e5, "of a cycle"},
};

static void test_faults_are_told(void **state) {
    (void)state;
    for (size_t k = 0; k < sizeof faults / sizeof *faults; k++) {
        rg_user_report r;
        char why[512];
        bool good = passes(faults[k].fault, faults[k].critical, &r, why, sizeof why);
        if (good || strstr(why, faults[k].words) == NULL) {
            fail_msg("fault %d: %s", (int)faults[k].fault, good ? "not seen" : why);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_right_one_passes),
        cmocka_unit_test(test_faults_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
