/* The checks of a user's cohesive law: one that is right passes, and each fault is told with its number. The
 * law stands in for a library: full strength up to half of the critical opening, then a straight fall. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "case/user.h"

typedef enum {
    RIGHT,
    START,    /* below the strength */
    WORK,     /* other than declared */
    BOOKS,    /* dissipates too little */
    FALLS,    /* what it has dissipated falls */
    HARDENS,  /* the secant grows */
    NEGATIVE, /* traction */
    TAIL,     /* beyond its end */
    LANES,    /* know of each other */
    NO_NUMBER,
    NOTHING, /* is declared */
} fault;

static fault planted;

static double traction(double x) {
    return x < 0.5 ? 1 : x < 1 ? 2 * (1 - x) : 0;
}

static double work(double x) {
    double fallen = x < 0.5 ? 0 : x < 1 ? x - 0.5 : 0.5;
    return (x < 1 ? x : 1) - fallen * fallen;
}

static void points(const rg_cohesive *law, rg_user_law_point point[RG_LANES]) {
    (void)law;
    for (int l = 0; l < RG_LANES; l++) {
        rg_user_law_point *p = &point[l];
        double x = p->largest / p->opening, T = traction(x), dissipated = work(x) - x * T / 2;
        T *= planted == START ? 0.9 : 1;
        T += planted == TAIL && x > 1 ? 0.01 : 0;
        T -= planted == NEGATIVE && x > 0.9 ? 0.3 : 0;
        T *= planted == HARDENS && x > 0.2 && x < 0.3 ? 1.5 : 1;
        dissipated *= planted == BOOKS ? 0.9 : 1;
        dissipated -= planted == FALLS && x > 0.6 && x < 0.7 ? 0.01 : 0;
        p->secant = p->strength * T / p->largest;
        p->dissipated = planted == NO_NUMBER && x > 0.6 ? NAN : p->strength * p->opening * dissipated;
    }
    point[0].secant *= planted == LANES && point[1].largest > point[1].opening / 2 ? 1 + 1e-12 : 1;
}

static bool passes(fault f, double *share, double *closed, char *why, size_t size) {
    rg_user_law u = {.points = points};
    rg_cohesive law = {.law = RG_LAW_USER, .user = &u};
    law.shape[RG_USER_WORK] = f == NOTHING ? 0 : f == WORK ? 0.7 : 0.75;
    law.shape[RG_USER_END] = 1;
    planted = f;
    why[0] = '\0';
    return rg_user_law_check(&law, 1e8, 1e-6, share, closed, why, size);
}

static void test_a_right_one_passes(void **state) {
    (void)state;
    double share, closed;
    char why[512];
    bool good = passes(RIGHT, &share, &closed, why, sizeof why);
    assert_string_equal(why, "");
    assert_true(good && fabs(share - 1) < 1e-9 && closed < 1e-9);
}

static const char *const words[] = {
    [START] = "starts at 0.9 of the strength",
    [WORK] = "a monotonic opening takes 1.07143 of the work that it declares",
    [BOOKS] = "what it dissipates and stores differs from the work of opening by 0.1 of the energy",
    [FALLS] = "it may not fall",
    [HARDENS] = "it may neither grow nor be negative",
    [NEGATIVE] = "it may neither grow nor be negative",
    [TAIL] = "beyond its end it has a traction of 0.01 of the strength",
    [LANES] = "in another lane",
    [NO_NUMBER] = "it may not fall",
    [NOTHING] = "declares a work of 0 and an end of 1",
};

static void test_faults_are_told(void **state) {
    (void)state;
    for (fault f = START; f <= NOTHING; f++) {
        double share, closed;
        char why[512];
        bool good = passes(f, &share, &closed, why, sizeof why);
        if (good || strstr(why, words[f]) == NULL) {
            fail_msg("fault %d: %s", (int)f, good ? "not seen" : why);
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
