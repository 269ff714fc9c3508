/* When checkpoints are due, and what the clock is told, with a clock of the test's own. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "base/error.h"
#include "base/interrupt.h"
#include "restart/schedule.h"

static void assert_near(double found, double wanted, double apart) {
    if (!(fabs(found - wanted) <= apart)) {
        fail_msg("%.17g, not %.17g", found, wanted);
    }
}

/* ---- stand-ins ---- */

static double now, limit, asked, stop_at, next_at;
static int clocks, answers, warnings;
static char warned[400];

double rg_interrupt_now(void) {
    return now;
}

double rg_interrupt_limit(double walltime) {
    asked = walltime;
    return limit;
}

void rg_interrupt_clock(double stop, double next) {
    stop_at = stop;
    next_at = next;
    clocks++;
}

void rg_interrupt_answered(void) {
    answers++;
}

void rg_warn(const char *format, ...) {
    va_list args;
    va_start(args, format);
    vsnprintf(warned, sizeof warned, format, args);
    va_end(args);
    warnings++;
}

/* ---- a solver, as far as schedules look at it ---- */

static rg_case input;
static rg_part part;
static rg_solver solver;

static int set_up(void **state) {
    (void)state;
    input = (rg_case){.checkpoint = {.keep = 2}};
    part = (rg_part){.total = 3000000}; /* 500 bytes each at 50 MB/s: 30 s */
    solver = (rg_solver){.input = &input, .part = &part};
    now = 7;
    limit = INFINITY;
    asked = stop_at = next_at = NAN;
    clocks = answers = warnings = 0;
    warned[0] = '\0';
    return 0;
}

static bool due(const rg_schedule *t, int64_t step, double time) {
    solver.step = step;
    solver.time = time;
    return rg_schedule_due(t, &solver, false);
}

/* ---- due ---- */

static void never_where_nothing_asks(void **state) {
    (void)state;
    rg_schedule t;
    rg_schedule_start(&t, &solver, 0);
    assert_true(isinf(t.next_time) && t.last == -1);
    assert_false(due(&t, 0, 0));
    assert_false(due(&t, 100, 1));
    assert_false(rg_schedule_due(&t, &solver, true)); /* not at the end either */
}

static void every_so_many_steps(void **state) {
    (void)state;
    rg_schedule t;
    input.checkpoint.steps = 5;
    rg_schedule_start(&t, &solver, 0);
    for (int64_t step = 0; step < 17; step++) {
        assert_int_equal(due(&t, step, 1e-9 * (double)step), step == 5 || step == 10 || step == 15);
    }
    assert_true(due(&t, 10, 1e-8));
    rg_schedule_done(&t, &solver, 1);
    assert_int_equal(t.last, 10);
    assert_int_equal(answers, 1);
    assert_false(due(&t, 10, 1e-8)); /* it was */
    solver.step = 12;
    assert_true(rg_schedule_due(&t, &solver, true)); /* at the end, whatever the step */
    solver.step = 10;
    assert_false(rg_schedule_due(&t, &solver, true)); /* but not twice */
}

static void at_multiples_of_simulated_time(void **state) {
    (void)state;
    rg_schedule t;
    input.checkpoint.time = 2e-7;
    rg_schedule_start(&t, &solver, 0);
    assert_near(t.next_time, 2e-7, 1e-21);
    assert_false(due(&t, 1, 1.99e-7));
    assert_true(due(&t, 2, 2e-7 * (1 - 0.9e-6)));
    assert_false(due(&t, 2, 2e-7 * (1 - 1.1e-6)));
    assert_true(due(&t, 3, 2.5e-7));
    rg_schedule_done(&t, &solver, 1);
    assert_near(t.next_time, 4e-7, 1e-21);
    assert_false(due(&t, 4, 3.9e-7));
    assert_true(due(&t, 5, 7.3e-7)); /* a step over several */
    rg_schedule_done(&t, &solver, 1);
    assert_near(t.next_time, 8e-7, 1e-21);
    assert_true(due(&t, 6, 8e-7 * (1 - 0.2e-6))); /* a hair before it counts as there */
    rg_schedule_done(&t, &solver, 1);
    assert_near(t.next_time, 10e-7, 1e-21);
    solver.step = 7;
    solver.time = 8.5e-7;
    assert_true(rg_schedule_due(&t, &solver, true));
}

static void starts_behind_a_restart(void **state) {
    (void)state;
    rg_schedule t;
    input.checkpoint.time = 2e-7;
    input.checkpoint.steps = 5;
    solver.step = 10;
    solver.time = 5e-7;
    rg_schedule_start(&t, &solver, 0);
    assert_int_equal(t.last, 10);
    assert_near(t.next_time, 6e-7, 1e-21);
    assert_false(due(&t, 10, 5e-7));
    solver.step = 0;
    solver.time = 0;
    rg_schedule_start(&t, &solver, 0);
    assert_int_equal(t.last, -1);
    solver.step = 1;
    rg_schedule_start(&t, &solver, 0);
    assert_int_equal(t.last, 1);
}

static void stop_requests(void **state) {
    (void)state;
    rg_schedule t;
    rg_schedule_start(&t, &solver, 0);
    solver.stop_request = RG_REQUEST_CHECKPOINT;
    assert_true(due(&t, 3, 1e-9));
    rg_schedule_done(&t, &solver, 1);
    assert_false(due(&t, 3, 1e-9)); /* was just written */
    for (int stop_request = RG_REQUEST_STOP; stop_request <= RG_REQUEST_TIME_UP; stop_request++) {
        solver.stop_request = stop_request;
        assert_true(due(&t, 3, 1e-9)); /* also where it was: the run is to stop */
        assert_false(rg_schedule_due(&t, &solver, true));
    }
    input.checkpoint.steps = 5; /* all but over: to the end, without */
    assert_false(rg_schedule_due(&t, &solver, true));
}

static void at_the_end_for_each_reason(void **state) {
    (void)state;
    rg_schedule t;
    for (int reason = 0; reason < 4; reason++) {
        input.checkpoint.steps = reason == 1 ? 1000 : 0;
        input.checkpoint.time = reason == 2 ? 1 : 0;
        input.checkpoint.wall_time = reason == 3 ? 1000 : 0;
        solver.step = 0;
        solver.time = 0;
        rg_schedule_start(&t, &solver, 0);
        assert_false(due(&t, 7, 1e-3));
        assert_int_equal(rg_schedule_due(&t, &solver, true), reason > 0);
    }
}

/* ---- the clock ---- */

static void seconds_of_a_checkpoint(void **state) {
    (void)state;
    assert_near(rg_schedule_seconds(&solver, 0), 30, 1e-12);
    assert_near(rg_schedule_seconds(&solver, 0.25), 0.25, 0);
}

static void clock_leaves_room_for_a_checkpoint(void **state) {
    (void)state;
    rg_schedule t;
    limit = 1000;
    input.checkpoint.wall_time = 60;
    rg_schedule_start(&t, &solver, 1234);
    assert_near(asked, 1234, 0);
    assert_near(t.limit, 1000, 0);
    assert_int_equal(clocks, 1);
    assert_near(stop_at, 1000 - 3 * 30 - 2 - 10, 1e-9);
    assert_near(next_at, 7 + 60, 1e-12);
    now = 50;
    rg_schedule_done(&t, &solver, 4);
    assert_int_equal(clocks, 2);
    assert_near(stop_at, 1000 - 3 * 4 - 2 - 10, 1e-9);
    assert_near(next_at, 110, 1e-12);
}

static void clock_without_limits(void **state) {
    (void)state;
    rg_schedule t;
    rg_schedule_start(&t, &solver, 0);
    assert_int_equal(clocks, 1);
    assert_true(isinf(stop_at) && stop_at > 0 && isinf(next_at) && next_at > 0);
}

static void clock_is_of_rank_0(void **state) {
    (void)state;
    rg_schedule t;
    limit = 1000;
    solver.rank = 1;
    rg_schedule_start(&t, &solver, 1000);
    rg_schedule_done(&t, &solver, 1);
    assert_int_equal(clocks, 0);
    assert_true(isinf(t.limit) && isnan(asked));
    now = 2000;
    t.limit = 10;
    rg_schedule_warn(&t, &solver);
    assert_int_equal(warnings, 0);
}

static void limit_that_leaves_no_steps(void **state) {
    (void)state;
    rg_schedule t;
    limit = 150; /* less 3 x 30, 2 and 1.5: 56.5 */
    rg_schedule_start(&t, &solver, 0);
    now = 56.4;
    rg_schedule_warn(&t, &solver);
    assert_int_equal(warnings, 0);
    now = 56.6;
    rg_schedule_warn(&t, &solver);
    assert_int_equal(warnings, 1);
    assert_string_equal(warned,
                        "the wall-time limit of 150 s leaves no time for steps: set-up took 57 s, and a "
                        "checkpoint of about 30 s needs three times that and 2 s");
    t.limit = INFINITY;
    now = 1e9;
    rg_schedule_warn(&t, &solver);
    assert_int_equal(warnings, 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(never_where_nothing_asks, set_up),
        cmocka_unit_test_setup(every_so_many_steps, set_up),
        cmocka_unit_test_setup(at_multiples_of_simulated_time, set_up),
        cmocka_unit_test_setup(starts_behind_a_restart, set_up),
        cmocka_unit_test_setup(stop_requests, set_up),
        cmocka_unit_test_setup(at_the_end_for_each_reason, set_up),
        cmocka_unit_test_setup(seconds_of_a_checkpoint, set_up),
        cmocka_unit_test_setup(clock_leaves_room_for_a_checkpoint, set_up),
        cmocka_unit_test_setup(clock_without_limits, set_up),
        cmocka_unit_test_setup(clock_is_of_rank_0, set_up),
        cmocka_unit_test_setup(limit_that_leaves_no_steps, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
