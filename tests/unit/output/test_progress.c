/* What a person sees while a run goes on, to the letter, with a clock and a terminal of the test's own. */
#include <math.h>
#include <mpi.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "output/progress.h"

static void assert_near(double found, double wanted, double apart) {
    if (!(fabs(found - wanted) <= apart)) {
        fail_msg("%.17g, not %.17g", found, wanted);
    }
}

/* ---- stand-ins ---- */

static double wall;
static bool terminal[3];

double MPI_Wtime(void) {
    return wall;
}

int isatty(int file) {
    return file <= 2 && terminal[file];
}

/* ---- what is said ---- */

static int kept;

static void listen(void) {
    fflush(stdout);
    kept = dup(STDOUT_FILENO);
    FILE *file = tmpfile();
    assert_non_null(file);
    dup2(fileno(file), STDOUT_FILENO);
    fclose(file);
}

static const char *heard(void) {
    static char text[2000];
    fflush(stdout);
    ssize_t size = pread(STDOUT_FILENO, text, sizeof text - 1, 0);
    dup2(kept, STDOUT_FILENO);
    close(kept);
    text[size < 0 ? 0 : size] = '\0';
    return text;
}

/* ---- cases ---- */

static rg_case input;
static rg_solver solver;
static const rg_energy energy = {.error = -2.5e-4, .share = 3.76e-2, .failed_area = 3.125e-7};
#define HEAD  "    step    time (s)    dt (s)  energy error  of dissip.  failed (m2)   left\n"
#define STATE "      30  4.0000e-06  2.00e-07      -2.5e-04    +3.8e-02    3.125e-07   60 s"

static int set_up(void **state) {
    (void)state;
    terminal[STDOUT_FILENO] = terminal[STDERR_FILENO] = false;
    input = (rg_case){.time = {.end = 1e-5}};
    solver = (rg_solver){.input = &input, .step = 10, .dt = 1e-7};
    wall = 100;
    return 0;
}

/* 20 steps of 2 s each later, 30 before the end. */
static rg_progress begun(bool speaks) {
    rg_progress p;
    rg_progress_begin(&p, speaks, &solver);
    solver.step = 30;
    solver.time = 4e-6;
    solver.dt = 2e-7;
    wall = 140;
    return p;
}

static void time_left(void **state) {
    (void)state;
    rg_progress p = begun(true);
    assert_near(rg_progress_left(&p, &solver), 60, 1e-9);
    solver.time = 1.1e-5; /* beyond the end */
    assert_near(rg_progress_left(&p, &solver), 0, 0);
    solver.time = 4e-6;
    solver.dt = 0;
    assert_near(rg_progress_left(&p, &solver), 0, 0);
    solver.dt = 2e-7;
    solver.step = 10;
    assert_near(rg_progress_left(&p, &solver), 0, 0); /* nothing is done yet */
    solver.step = 11;
    assert_near(rg_progress_left(&p, &solver), 40 * 30, 1e-9);
}

static void time_left_to_the_last_step(void **state) {
    (void)state;
    input.time.steps = 35;
    rg_progress p = begun(true);
    assert_near(rg_progress_left(&p, &solver), 10, 1e-9);
    input.time.steps = 1000;
    solver.step = 10;
    wall = 100;
    solver.dt = 1e-7;
    p = begun(true);
    assert_near(rg_progress_left(&p, &solver), 60, 1e-9);
    p.last = 1;
    solver.step = 1;
    p.first = 0;
    assert_near(rg_progress_left(&p, &solver), 0, 0);
}

static void lines_to_a_file(void **state) {
    (void)state;
    rg_progress p = begun(true);
    listen();
    rg_progress_show(&p, &solver, &energy);
    rg_progress_show(&p, &solver, &energy);
    rg_progress_say(&p, "word %d of %s", 3, "many");
    rg_progress_end(&p);
    assert_string_equal(heard(), HEAD STATE "\n" STATE "\nword 3 of many\n");
}

static void too_little_dissipated_to_judge_by(void **state) {
    (void)state;
    rg_progress p = begun(true);
    rg_energy first = energy;
    first.share = NAN;
    listen();
    rg_progress_show(&p, &solver, &first);
    assert_string_equal(heard(), HEAD "      30  4.0000e-06  2.00e-07      -2.5e-04           -"
                                      "    3.125e-07   60 s\n");
}

static void live_line_on_a_terminal(void **state) {
    (void)state;
    terminal[STDOUT_FILENO] = terminal[STDERR_FILENO] = true;
    rg_progress p = begun(true);
    listen();
    rg_progress_show(&p, &solver, &energy);
    rg_progress_say(&p, "word");
    rg_progress_end(&p);
    assert_string_equal(heard(), HEAD "\r\033[K" STATE "\r\033[Kword\n\n");
}

static void units_of_the_time_left(void **state) {
    (void)state;
    static const struct {
        double left;
        const char *words;
    } times[] = {{999, " 999 s\n"}, {1020, " 17 min\n"}, {59940, " 999 min\n"}, {61200, "  17 h\n"}};
    for (size_t i = 0; i < sizeof times / sizeof *times; i++) {
        rg_progress p = begun(true);
        wall = 100 + times[i].left * 2 / 3; /* 20 of 50 steps are done */
        listen();
        rg_progress_show(&p, &solver, &energy);
        const char *line = heard();
        assert_string_equal(line + strlen(line) - strlen(times[i].words), times[i].words);
        assert_true(strlen(strchr(line, '\n') + 1) <= 81);
        set_up(NULL);
    }
}

static void half_a_terminal_is_none(void **state) {
    (void)state;
    for (int which = STDOUT_FILENO; which <= STDERR_FILENO; which++) {
        terminal[STDOUT_FILENO] = which == STDOUT_FILENO;
        terminal[STDERR_FILENO] = which == STDERR_FILENO;
        rg_progress p;
        rg_progress_begin(&p, true, &solver);
        assert_false(p.terminal);
    }
}

static void nothing_where_it_does_not_speak(void **state) {
    (void)state;
    terminal[STDOUT_FILENO] = terminal[STDERR_FILENO] = true;
    rg_progress p = begun(false);
    listen();
    rg_progress_show(&p, &solver, &energy);
    rg_progress_say(&p, "word");
    rg_progress_end(&p);
    assert_string_equal(heard(), "");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(time_left, set_up),
        cmocka_unit_test_setup(time_left_to_the_last_step, set_up),
        cmocka_unit_test_setup(lines_to_a_file, set_up),
        cmocka_unit_test_setup(too_little_dissipated_to_judge_by, set_up),
        cmocka_unit_test_setup(live_line_on_a_terminal, set_up),
        cmocka_unit_test_setup(units_of_the_time_left, set_up),
        cmocka_unit_test_setup(half_a_terminal_is_none, set_up),
        cmocka_unit_test_setup(nothing_where_it_does_not_speak, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
