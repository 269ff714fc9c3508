/* The folder of checkpoints, their times, and what a restart keeps of outputs. */
#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/mem.h"
#include "restart/checkpoint.h"
#include "restart/checkpoint_folder.h"
#include "restart/restart.h"

/* ---- stand-ins: outputs that are brought to the disk ---- */

int64_t __wrap_rg_probes_sync(rg_probes *p);
int64_t __wrap_rg_csv_sync(rg_csv *t);
rg_fragment_mark __wrap_rg_fragment_table_sync(rg_fragment_table *t);
rg_writer_mark __wrap_rg_snapshots_sync(rg_snapshots *w);

int64_t __wrap_rg_probes_sync(rg_probes *p) {
    return p == NULL ? 301 : -1;
}

int64_t __wrap_rg_csv_sync(rg_csv *t) {
    return t == NULL ? 302 : -1;
}

rg_fragment_mark __wrap_rg_fragment_table_sync(rg_fragment_table *t) {
    return (rg_fragment_mark){t == NULL ? 303 : -1, 3.5, {3, 4}};
}

rg_writer_mark __wrap_rg_snapshots_sync(rg_snapshots *w) {
    return (rg_writer_mark){w->first, 12, 13};
}

/* ---- the folder ---- */

static char place[] = "/tmp/test_restart.XXXXXX", folder[64];

static int set_up(void **state) {
    (void)state;
    snprintf(folder, sizeof folder, "%s/checkpoints", mkdtemp(place) == NULL ? "" : place);
    return mkdir(folder, 0777);
}

static int tear_down(void **state) {
    (void)state;
    rmdir(folder);
    return rmdir(place);
}

static const char *in_folder(const char *name) {
    static char path[200];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static void expect_steps(int count, const int64_t *wanted) {
    int64_t *steps;
    assert_int_equal(rg_folder_list(folder, &steps), count);
    assert_true((steps == NULL) == (count == 0));
    for (int i = 0; i < count; i++) {
        assert_int_equal(steps[i], wanted[i]);
    }
    rg_free(steps);
    assert_int_equal(rg_checkpoints_exist(place), count > 0);
}

/* Those of checkpoints, half-written ones, others. */
static const char *const name[] = {"step-000000000007.h5",
                                   "step-000000000300.h5",
                                   "step-1234567890123.h5",
                                   "step-000000000000.h5",
                                   "step-000000000008.h5.part",
                                   "step-.part",
                                   "step-7.h5",
                                   "step--00000000001.h5",
                                   "step-000000000009.h5.damaged",
                                   "step-000000000010",
                                   "other-000000000001.h5.part",
                                   "step-00000000001x.h5",
                                   ".part",
                                   "step-.parts",
                                   "step-000000000007.h5x"};
enum { OURS = 4, HALF = 6, NAMES = sizeof name / sizeof *name };

static void names(void **state) {
    (void)state;
    const int64_t steps[] = {1234567890123, 300, 7, 0};
    expect_steps(0, NULL);
    for (int i = 0; i < NAMES; i++) {
        close(open(in_folder(name[i]), O_WRONLY | O_CREAT, 0666));
    }
    expect_steps(4, steps);
    char *path = rg_folder_path(folder, 300);
    assert_string_equal(path, in_folder(name[1]));
    rg_free(path);
    rg_checkpoints_remove(place, false); /* the half-written ones alone */
    for (int i = 0; i < NAMES; i++) {
        assert_int_equal(access(in_folder(name[i]), F_OK) == 0, i < OURS || i >= HALF);
    }
    for (int k = 0; k < 2; k++) {
        rg_folder_prune(folder, 3);
        expect_steps(3, steps);
    }
    rg_checkpoints_remove(place, true);
    expect_steps(0, NULL);
    for (int i = HALF; i < NAMES; i++) {
        assert_int_equal(remove(in_folder(name[i])), 0);
    }
}

static void no_folder(void **state) {
    (void)state;
    int64_t *steps;
    assert_int_equal(rg_folder_list("/dev/null/x", &steps), 0);
    assert_null(steps);
    rg_folder_clean("/dev/null/x");
    assert_false(rg_checkpoints_exist("/dev/null"));
}

/* ---- times, outputs ---- */

static void median(void **state) {
    (void)state;
    double seconds[] = {5, 1, 4, 2};
    const double wanted[] = {0, 5, 3, 4, 3};
    for (int n = 0; n <= 4; n++) {
        rg_checkpoints k = {.written = n, .seconds = seconds};
        assert_true(rg_checkpoints_median(&k) == wanted[n]);
    }
    assert_true(seconds[0] == 5 && seconds[3] == 2);
}

static void what_is_kept_of_outputs(void **state) {
    (void)state;
    rg_case input = {0};
    rg_solver s = {.input = &input, .pass_seconds = 3, .ranks = 5, .threads = 7, .limiting_state = "closed"};
    rg_restart keep = {.fields = {1, 2, 3}, .frame = 4, .good_time = 8};
    rg_snapshots none = {.fields = 0, .first = 11}, some = {.fields = 1, .first = 11};
    rg_restart_sync(&keep, &s, NULL, NULL, NULL, &none);
    assert_int_equal(keep.history_bytes, 301);
    assert_int_equal(keep.energy_bytes, 302);
    assert_int_equal(keep.fragments.bytes, 303);
    assert_true(keep.fragments.overlap_time == 3.5 && keep.fragments.overlap[1] == 4);
    assert_true(keep.fields.frames == 1 && keep.fields.volume == 2 && keep.fields.crack == 3);
    assert_true(keep.core_seconds == 105);
    assert_string_equal(keep.limiting_state, "closed");
    assert_true(keep.frame == 4 && keep.good_time == 8);
    rg_restart_sync(&keep, &s, NULL, NULL, NULL, &some);
    assert_true(keep.fields.frames == 11 && keep.fields.volume == 12 && keep.fields.crack == 13);
}

static void what_is_kept_of_the_spectrum(void **state) {
    (void)state;
    rg_case input = {0};
    rg_restart keep = {.limiting_state = "closed", .core_seconds = 105};
    rg_snapshots none = {0};
    rg_solver s = {.input = &input, .ranks = 3, .threads = 5};
    rg_restart_spectrum(&keep, &s);
    assert_true(s.pass_seconds == 7);
    assert_string_equal(s.limiting_state, "closed");
    rg_restart_sync(&keep, &s, NULL, NULL, NULL, &none); /* the word is its own now */
    assert_string_equal(keep.limiting_state, "closed");
    assert_true(keep.core_seconds == 105);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names),
        cmocka_unit_test(no_folder),
        cmocka_unit_test(median),
        cmocka_unit_test(what_is_kept_of_outputs),
        cmocka_unit_test(what_is_kept_of_the_spectrum),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
