/* The cohesive law that a case makes, against closed forms. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "case/expr.h"
#include "solver/law.h"

static void assert_near(double found, double expected) {
    if (!(fabs(found - expected) <= 4e-15 * fabs(expected))) {
        fail_msg("%.17g instead of %.17g", found, expected);
    }
}

static rg_expr *expression(const char *text) {
    char *message = NULL;
    rg_expr *e = rg_expr_new(text, &message);
    assert_non_null(e);
    return e;
}

static rg_case make_case(rg_law law, rg_form form) {
    rg_case c = {.interface = {.law = law,
                               .form = form,
                               .strength = 400e6,
                               .energy = 34,
                               .beta = 2,
                               .beta_s = 1.5,
                               .onset = 0.05,
                               .contact = RG_CONTACT_PENALTY}};
    for (int k = 0; k < RG_LAWS; k++) {
        c.interface.shape[k][0] = 0.25;
    }
    return c;
}

/* Linear softening: half of strength times opening is the energy. */
static void test_linear(void **state) {
    (void)state;
    rg_case c = make_case(RG_LAW_LINEAR, RG_FORM_VARIATIONAL);
    rg_cohesive law = rg_law_make(&c);
    assert_true(law.law == RG_LAW_LINEAR && law.form == RG_FORM_VARIATIONAL && law.strength == 400e6 &&
                law.beta == 2 && law.beta_s == 1.5 && law.contact == RG_CONTACT_PENALTY && law.slope == 0);
    assert_near(law.opening, 2 * 34 / 400e6);
    assert_near(law.separation, law.opening);
    assert_near(law.onset, 0.05 * 4); /* sliding counts beta^2 times */
    c.interface.beta = 0.5;
    assert_near(rg_law_make(&c).onset, 0.05);
    assert_true(rg_law_steps(&law) == 0);
}

/* Polynomial: 9/16 of strength times opening, its measure the normal opening alone; at the start it rises by
 * 27/4 of the strength over the opening in the normal, and a part of that beside. */
static void test_intrinsic(void **state) {
    (void)state;
    rg_case c = make_case(RG_LAW_POLYNOMIAL, RG_FORM_INTRINSIC);
    rg_cohesive law = rg_law_make(&c);
    assert_near(law.opening, 34 / (0.5625 * 400e6));
    assert_near(law.separation, law.opening);
    assert_true(law.beta == 0);
    double slope[2];
    rg_law_stiffness(&law, slope);
    assert_near(slope[0], 6.75 * 1.25 * 400e6 / law.opening);
    assert_near(slope[1], 6.75 * 0.25 * 400e6 / law.opening);
    assert_near(law.slope, slope[0]);
    c.interface.form = RG_FORM_VARIATIONAL;
    assert_true(rg_law_make(&c).slope == 0);
    c = make_case(RG_LAW_BILINEAR, RG_FORM_INTRINSIC);
    c.interface.shape[RG_LAW_BILINEAR][RG_LIMITER_STEPS] = 12;
    law = rg_law_make(&c);
    assert_true(law.beta == 2 && rg_law_steps(&law) == 12);
}

/* Traction of pure opening over the strength, at an opening over the critical one. */
static double curve(rg_law law, double x) {
    double z = 16 * exp(1) / 9;
    switch (law) {
    case RG_LAW_BILINEAR:
        return x < 0.25 ? x / 0.25 : (1 - x) / 0.75;
    case RG_LAW_TVERGAARD:
    case RG_LAW_POLYNOMIAL:
        return 6.75 * x * (1 - x) * (1 - x);
    case RG_LAW_NEEDLEMAN:
        return 0.5625 * z * z * x * exp(-z * x);
    default:
        return exp(1) * x * exp(-x);
    }
}

/* Of laws with a slope: up to the top the traction grows to the strength, and falls from there. */
static void test_top(void **state) {
    (void)state;
    static const rg_law laws[] = {RG_LAW_BILINEAR,  RG_LAW_TVERGAARD,   RG_LAW_POLYNOMIAL,
                                  RG_LAW_NEEDLEMAN, RG_LAW_EXPONENTIAL, RG_LAW_XU_NEEDLEMAN};
    for (size_t k = 0; k < sizeof laws / sizeof *laws; k++) {
        rg_case c = make_case(laws[k], RG_FORM_INTRINSIC);
        rg_cohesive law = rg_law_make(&c);
        double top = rg_law_top(&law) * law.separation / law.opening;
        assert_near(curve(laws[k], top), 1);
        assert_true(curve(laws[k], 0.99 * top) < 1 && curve(laws[k], 1.01 * top) < 1);
    }
    rg_case c = make_case(RG_LAW_FREE, RG_FORM_INTRINSIC);
    rg_cohesive free = rg_law_make(&c);
    assert_true(!(rg_law_top(&free) < INFINITY));
}

/* Strength and energy that are expressions are 1 in the law, but numbers written as such are themselves. */
static void test_expressions(void **state) {
    (void)state;
    rg_case c = make_case(RG_LAW_LINEAR, RG_FORM_VARIATIONAL);
    rg_expr *number = expression("7"), *field = expression("1 + x");
    c.interface.strength_at = field;
    assert_near(rg_law_make(&c).strength, 1);
    assert_near(rg_law_make(&c).opening, 2 * 34);
    c.interface.energy_at = field;
    assert_near(rg_law_make(&c).opening, 2);
    c.interface.strength_at = number;
    assert_near(rg_law_make(&c).strength, 400e6);
    assert_true(rg_law_number(7, number) == 7 && rg_law_number(7, field) == 1 && rg_law_number(7, NULL) == 7);
    rg_expr_free(number);
    rg_expr_free(field);
}

static void test_none(void **state) {
    (void)state;
    rg_case c = make_case(RG_LAW_NONE, RG_FORM_INCOMPLETE);
    rg_cohesive law = rg_law_make(&c);
    assert_true(law.strength > 0 && isinf(law.strength) && law.opening == 1 && law.separation == 1 &&
                law.beta == 2 && law.form == RG_FORM_INCOMPLETE && law.friction == 0);
}

/* Faces rub where the interface or one of its sets does. */
static void test_friction(void **state) {
    (void)state;
    rg_case c = make_case(RG_LAW_LINEAR, RG_FORM_VARIATIONAL);
    rg_face_set set[2] = {{.friction = 0}, {.friction = 0}};
    rg_expr *zero = expression("0"), *field = expression("x > 0 ? 0.2 : 0");
    c.interface.set = set;
    c.interface.sets = 2;
    assert_int_equal(rg_law_make(&c).sliding, RG_SLIDING_FREE);
    set[1].friction_at = zero;
    assert_int_equal(rg_law_make(&c).sliding, RG_SLIDING_FREE);
    set[1].friction_at = field;
    assert_int_equal(rg_law_make(&c).sliding, RG_SLIDING_COULOMB);
    set[1].friction_at = NULL;
    set[0].friction = 0.1;
    assert_int_equal(rg_law_make(&c).sliding, RG_SLIDING_COULOMB);
    assert_true(rg_law_make(&c).friction == 0);
    c.interface.sets = 0;
    assert_int_equal(rg_law_make(&c).sliding, RG_SLIDING_FREE);
    c.interface.friction = 0.3;
    assert_int_equal(rg_law_make(&c).sliding, RG_SLIDING_COULOMB);
    assert_true(rg_law_make(&c).friction == 0.3);
    rg_expr_free(zero);
    rg_expr_free(field);
}

/* Values of a block of faces: those of all laws, what a law remembers at each point, then what sliding needs.
 */
static void test_stride(void **state) {
    (void)state;
    rg_cohesive law = {.law = RG_LAW_LINEAR};
    assert_int_equal(rg_crack_stride(&law), RG_CRACK_BLOCK);
    law.sliding = RG_SLIDING_COULOMB;
    assert_int_equal(rg_crack_stride(&law), RG_CRACK_BLOCK + RG_FRICTION_BLOCK);
    law.criterion = RG_CRITERION_MOHR_COULOMB;
    assert_int_equal(rg_crack_stride(&law), RG_CRACK_BLOCK + RG_LOAN_BLOCK + RG_FRICTION_BLOCK);
    law.sliding = RG_SLIDING_FREE;
    assert_int_equal(rg_crack_stride(&law), RG_CRACK_BLOCK + RG_LOAN_BLOCK);
    law = (rg_cohesive){.law = RG_LAW_FATIGUE};
    assert_int_equal(rg_crack_stride(&law), RG_CRACK_BLOCK + 4 * RG_POINTS * RG_LANES);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_linear), cmocka_unit_test(test_intrinsic), cmocka_unit_test(test_expressions),
        cmocka_unit_test(test_none),   cmocka_unit_test(test_friction),  cmocka_unit_test(test_stride),
        cmocka_unit_test(test_top),
    };
    return cmocka_run_group_tests_name("law", tests, NULL, NULL);
}
