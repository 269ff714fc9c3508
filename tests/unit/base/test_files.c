/* Output files and directories, tables, memory, and how a run ends with a message. */
#define _DEFAULT_SOURCE /* mkdtemp */
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/error.h"
#include "base/input_errors.h"
#include "base/files.h"
#include "base/mem.h"
#include "case/case.h"
#include "case/read.h"
#include "case/echo.h"
#include "diagnostics/ledger.h"
#include "support/child.h"
#include "support/sanitized.h"

static char dir[] = "/tmp/test_files.XXXXXX"; /* the working directory of the tests; empty between them */
static char said[16384];

static int set_up(void **state) {
    (void)state;
    return mkdtemp(dir) == NULL || chdir(dir) != 0;
}

static int tear_down(void **state) {
    (void)state;
    return chdir("/") != 0 || rmdir(dir) != 0; /* fails if a test left something */
}

static void put(const char *path, const char *text) {
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fputs(text, f);
    fclose(f);
}

static void expect_file(const char *path, const char *text) {
    static char found[16384];
    FILE *f = fopen(path, "r");
    assert_non_null(f);
    found[fread(found, 1, sizeof found - 1, f)] = '\0';
    fclose(f);
    assert_string_equal(found, text);
}

static bool there(const char *path) {
    return access(path, F_OK) == 0;
}

static void expect_end(void (*job)(void), int status, const char *words) {
    assert_int_equal(run_child(job, said, sizeof said), status);
    assert_string_equal(said, words);
}

/* ---- ends and warnings ---- */

static void end_with_words(void) {
    assert_non_null(freopen("out", "w", stdout));
    printf("said before");
    rg_warn("%s of %d", "a warning", 3);
    rg_fatal(7, "%d and %s", 5, "text");
}

static void test_fatal(void **state) {
    (void)state;
    expect_end(end_with_words, 7, "rhegma: warning: a warning of 3\nrhegma: 5 and text\n");
    expect_file("out", "said before");
    remove("out");
}

static void end_with_faults(void) {
    rg_input_errors none = {.name = "none"}, f = {.name = "a.inp"};
    rg_input_errors_end(&none); /* goes on */
    rg_input_errors_add(&f, 2, 0, "the second");
    rg_input_errors_add(&f, 1, 0, "the first, %d", 1);
    rg_input_errors_end(&f);
}

static void end_with_many_faults(void) {
    rg_input_errors f = {.name = "b"};
    for (int i = 0; i < 12; i++) {
        rg_input_errors_add(&f, i, 0, "%0600d", i); /* cut */
    }
    rg_input_errors_agree(&f, MPI_COMM_SELF);
}

static void test_faults(void **state) {
    (void)state;
    expect_end(end_with_faults, RG_USAGE, "rhegma: a.inp: the first, 1\nrhegma: a.inp: the second\n");
    char expected[8192] = "";
    for (size_t i = 0, used = 0; i < 10; i++) {
        used += (size_t)snprintf(expected + used, sizeof expected - used, "rhegma: b: %0399d\n", 0);
    }
    snprintf(expected + strlen(expected), 64, "rhegma: b: and 2 more\n");
    expect_end(end_with_many_faults, RG_USAGE, expected);
}

/* ---- memory ---- */

static bool zeroed(const char *block, size_t size) {
    for (size_t i = 0; i < size; i++) {
        if (block[i] != 0) {
            return false;
        }
    }
    return true;
}

static bool mapped(const void *at) {
    return msync((void *)((uintptr_t)at & ~(uintptr_t)4095), 4096, MS_ASYNC) == 0;
}

static void test_memory(void **state) {
    (void)state;
    static const size_t sizes[] = {0,       1, 24, 63, 64, 65, 100000, (4 << 20) - 1, 4 << 20, (4 << 20) + 1,
                                   20000000};
    enum { COUNT = sizeof sizes / sizeof *sizes };
    char *block[COUNT];
    size_t before = rg_alloc_total(), total = before;
    for (int i = 0; i < COUNT; i++) {
        block[i] = i % 2 == 0 ? rg_alloc(sizes[i], 1) : rg_alloc(1, sizes[i]);
        total += sizes[i];
        assert_true((uintptr_t)block[i] % 64 == 0 && zeroed(block[i], sizes[i]));
        memset(block[i], 0xa5, sizes[i]);
        assert_int_equal(rg_alloc_total(), total);
    }
    for (int i = 0; i < COUNT; i++) {
        for (size_t k = 0; k < sizes[i]; k++) {
            assert_true((unsigned char)block[i][k] == 0xa5); /* nobody else has it */
        }
        rg_free(block[i]);
        total -= sizes[i];
        assert_int_equal(rg_alloc_total(), total);
        if (sizes[i] > 5 << 20) { /* given back to the system, from end to end */
            assert_false(mapped(block[i]) || mapped(block[i] + sizes[i] - 1));
        }
    }
    double *sparse = rg_alloc_sparse(1000000, sizeof *sparse);
    assert_int_equal(rg_alloc_total(), before + 8000000);
    assert_true((uintptr_t)sparse % 64 == 0 && sparse[0] == 0 && sparse[999999] == 0);
    rg_free(sparse);
    rg_free(rg_alloc(5, 0));
    rg_free(NULL);
    int *grown = rg_realloc(NULL, 3, sizeof *grown);
    memcpy(grown, (const int[3]){7, 8, 9}, 3 * sizeof *grown);
    for (int n = 4; n < 3000; n *= 3) {
        grown = rg_realloc(grown, (size_t)n, sizeof *grown);
        grown[n - 1] = n;
        assert_true(grown[0] == 7 && grown[1] == 8 && grown[2] == 9 && grown[n - 1] == n);
    }
    assert_int_equal(rg_alloc_total(), before);
    rg_free(grown);
    assert_int_equal(rg_alloc_total(), before);
}

static void too_many(void) {
    rg_alloc(SIZE_MAX / 2, 3);
}

static void all_of_it(void) {
    rg_alloc_sparse(1, SIZE_MAX - 127); /* with what stands around it, this wraps around */
}

static void limit_memory(void) {
    setrlimit(RLIMIT_AS, &(struct rlimit){1 << 30, 1 << 30});
}

static void more_than_allowed(void) {
    limit_memory();
    rg_alloc(3, (size_t)1 << 30);
}

static void more_sparse_than_allowed(void) {
    limit_memory();
    rg_alloc_sparse(3, (size_t)1 << 30);
}

static void grow_beyond(void) {
    limit_memory();
    rg_realloc(rg_realloc(NULL, 5, 1), 3, (size_t)1 << 30);
}

static void test_out_of_memory(void **state) {
    (void)state;
    expect_end(too_many, RG_FAILURE, "rhegma: out of memory: 9223372036854775807 items of 3 bytes\n");
    expect_end(all_of_it, RG_FAILURE, "rhegma: out of memory: 1 items of 18446744073709551488 bytes\n");
    if (!RG_SANITIZED) { /* which lives beyond such a limit */
        expect_end(more_than_allowed, RG_FAILURE, "rhegma: out of memory: 3 items of 1073741824 bytes\n");
        expect_end(more_sparse_than_allowed, RG_FAILURE,
                   "rhegma: out of memory: 3 items of 1073741824 bytes\n");
        expect_end(grow_beyond, RG_FAILURE, "rhegma: out of memory: 3 items of 1073741824 bytes\n");
    }
}

/* ---- directories ---- */

static void make_below_a_file(void) {
    rg_make_directory("a/file/c", MPI_COMM_WORLD);
}

static void make_below_nothing(void) {
    rg_make_directory("/proc/a/b", MPI_COMM_WORLD);
}

static void test_directories(void **state) {
    (void)state;
    char whole[64];
    snprintf(whole, sizeof whole, "%s/d/e/", dir);
    rg_make_directory("a/b/c", MPI_COMM_WORLD);
    rg_make_directory("a/b", MPI_COMM_WORLD);
    rg_make_directory(whole, MPI_COMM_WORLD);
    assert_true(there("a/b/c/.") && there("d/e/."));
    put("a/file", "");
    expect_end(make_below_a_file, RG_FAILURE,
               "rhegma: output directory a/file/c: cannot be created: Not a directory\n");
    expect_end(make_below_nothing, RG_FAILURE,
               "rhegma: output directory /proc/a/b: cannot be created: No such file or directory\n");
    remove("a/file");
    remove("a/b/c");
    remove("a/b");
    remove("a");
    remove("d/e");
    remove("d");
}

/* ---- opening, closing, bringing to the disk ---- */

static void test_input(void **state) {
    (void)state;
    put("f", "abc");
    FILE *f = rg_open_input("f");
    assert_true(f != NULL && fgetc(f) == 'a');
    fclose(f);
    errno = 0;
    assert_true(rg_open_input(".") == NULL && errno == EISDIR);
    assert_true(rg_open_input("none") == NULL && errno == ENOENT);
    remove("f");
}

static void test_sync(void **state) {
    (void)state;
    put("f", "abc");
    assert_true(rg_sync("f") && rg_sync_folder("."));
    errno = 0;
    assert_true(!rg_sync("none") && errno == ENOENT);
    assert_true(!rg_sync_folder("none") && errno == ENOENT);
    assert_true(!rg_sync("/dev/null") && errno == EINVAL); /* cannot be synchronized at all */
    assert_true(rg_sync_folder("/dev/null"));
    remove("f");
}

/* Directory "././././...f" such that dir/name has `length` characters, where name is autopsy.json. */
static const char *long_path(size_t length) {
    static char path[5000];
    size_t n = length - strlen("/autopsy.json");
    for (size_t i = 0; i < n; i++) {
        path[i] = i % 2 == 0 ? '.' : '/';
    }
    path[n] = '\0';
    return path;
}

static void open_too_long(void) {
    fclose(rg_open_in(long_path(4096), "autopsy.json"));
}

static void open_nowhere(void) {
    rg_open_in("no", "f.csv");
}

static void close_full(void) {
    FILE *f = fopen("/dev/full", "w");
    fputs("text", f);
    rg_close_in(f, "d", "f.csv");
}

static void close_after_failure(void) {
    FILE *f = fopen("/dev/full", "w");
    setvbuf(f, NULL, _IONBF, 0);
    fputs("text", f);
    rg_close_in(f, "d", "f.csv");
}

static void sync_full(void) {
    FILE *f = fopen("/dev/full", "w");
    fputs("text", f);
    rg_sync_file(f, "name");
}

static void sync_null(void) {
    rg_sync_file(fopen("/dev/null", "w"), "name");
}

static void test_open_and_close(void **state) {
    (void)state;
    FILE *f = rg_open_in(".", "f");
    fputs("abcde", f);
    assert_int_equal(rg_sync_file(f, "f"), 5);
    expect_file("f", "abcde");
    rg_close_in(f, ".", "f");
    f = rg_open_in(".", "f"); /* anew */
    rg_close_in(f, ".", "f");
    expect_file("f", "");
    remove("f");
    f = rg_open_in(long_path(4095), "autopsy.json");
    rg_close_in(f, ".", "f");
    assert_true(there("autopsy.json"));
    remove("autopsy.json");
    assert_int_equal(run_child(open_too_long, said, sizeof said), RG_USAGE);
    assert_non_null(strstr(said, "/autopsy.json: the path is too long\n"));
    expect_end(open_nowhere, RG_FAILURE, "rhegma: no/f.csv: cannot be written: No such file or directory\n");
    expect_end(close_full, RG_FAILURE, "rhegma: d/f.csv: cannot be written: No space left on device\n");
    expect_end(close_after_failure, RG_FAILURE,
               "rhegma: d/f.csv: cannot be written: No space left on device\n");
    expect_end(sync_full, RG_FAILURE, "rhegma: name: cannot be written: No space left on device\n");
    expect_end(sync_null, RG_FAILURE, "rhegma: name: cannot be written: Invalid argument\n");
}

static void reopen_none(void) {
    rg_reopen_in(".", "none", 0);
}

static void reopen_short(void) {
    rg_reopen_in(".", "f", 7);
}

static void reopen_directory(void) {
    rg_reopen_in("..", ".", 0);
}

static void test_reopen(void **state) {
    (void)state;
    for (int length = 0; length <= 6; length += 3) {
        char expected[16];
        put("f", "abcdef");
        FILE *f = rg_reopen_in(".", "f", length);
        fputs("+", f);
        fclose(f);
        snprintf(expected, sizeof expected, "%.*s+", length, "abcdef");
        expect_file("f", expected);
    }
    put("f", "abcdef");
    expect_end(reopen_none, RG_USAGE, "rhegma: ./none: cannot go on with it: No such file or directory\n");
    expect_end(reopen_short, RG_USAGE,
               "rhegma: ./f: cannot go on with it: it has 6 bytes and had 7 at the checkpoint\n");
    expect_end(reopen_directory, RG_FAILURE, "rhegma: ../.: cannot be written: Is a directory\n");
    expect_file("f", "abcdef");
    remove("f");
}

/* ---- what an earlier run left ---- */

static const char *const results[] = {"summary.json", "history.csv", "fragments.csv",
                                      "autopsy.json", "fields.xdmf", "fields.h5"};
enum { RESULTS = sizeof results / sizeof *results };

static void remove_what_cannot(void) {
    rg_remove_endings(".");
}

static void test_removing(void **state) {
    (void)state;
    for (int i = 0; i < RESULTS; i++) {
        put(results[i], "");
    }
    put("case.yaml", "");
    put("energy.csv", "");
    mkdir("fields", 0777);
    put("fields/0000.h5", "");
    put("fields/0001.h5.part", "");
    put("fields/mine.txt", "");
    rg_remove_results(".", 1); /* only the first rank does */
    rg_remove_frames(".", 1);
    for (int i = 0; i < RESULTS; i++) {
        assert_true(there(results[i]));
    }
    assert_true(there("fields/0000.h5"));
    rg_remove_endings(".");
    for (int i = 0; i < RESULTS; i++) {
        assert_int_equal(there(results[i]), strstr(results[i], ".json") == NULL);
        put(results[i], "");
    }
    rg_remove_results(".", 0);
    for (int i = 0; i < RESULTS; i++) {
        assert_false(there(results[i]));
    }
    assert_true(there("case.yaml") && there("energy.csv") && there("fields/mine.txt"));
    assert_false(there("fields/0000.h5") || there("fields/0001.h5.part"));
    remove("fields/mine.txt");
    put("fields/0002.h5", "");
    rg_remove_frames(".", 0);
    assert_false(there("fields"));
    rg_remove_frames(".", 0); /* nothing left is fine */
    rg_remove_results(".", 0);
    mkdir("summary.json", 0777);
    put("summary.json/f", "");
    expect_end(remove_what_cannot, RG_FAILURE,
               "rhegma: ./summary.json: an earlier result cannot be removed: Directory not empty\n");
    remove("summary.json/f");
    remove("summary.json");
    remove("case.yaml");
    remove("energy.csv");
}

static void refuse(void) {
    rg_refuse_own_case(".");
}

static void test_own_case(void **state) {
    (void)state;
    expect_end(refuse, 0, "");
    put("case.yaml", "");
    expect_end(refuse, RG_USAGE,
               "rhegma: ./case.yaml: no run wrote it, for there is no energy.csv beside it, but this one "
               "would write "
               "over it: take another directory (-o), or name the file otherwise\n");
    put("energy.csv", "");
    expect_end(refuse, 0, "");
    remove("case.yaml");
    expect_end(refuse, 0, "");
    remove("energy.csv");
}

static rg_case *some_case(void) {
    static const char text[] = "mesh: {cells: [2, 2, 2], size: [1, 1, 1]}\n"
                               "material: {model: neo-hookean, young: 1, poisson: 0.25, density: 1}\n"
                               "interface: {law: none}\n"
                               "time: {end: 1}\n"
                               "output: {dir: out}\n";
    return rg_case_read_text("a.yaml", text, strlen(text), 0, NULL, stderr);
}

static void echo_onto_a_directory(void) {
    rg_case_write(some_case(), 0);
}

static void test_echo(void **state) {
    (void)state;
    rg_case *c = some_case();
    char *text = NULL;
    size_t size = 0;
    FILE *f = open_memstream(&text, &size);
    rg_case_echo(c, f);
    fclose(f);
    mkdir("out", 0777);
    rg_case_write(c, 1);
    assert_false(there("out/case.yaml"));
    put("out/case.yaml", "old");
    rg_case_write(c, 0);
    expect_file("out/case.yaml", text);
    assert_false(there("out/case.yaml.part"));
    remove("out/case.yaml");
    mkdir("out/case.yaml", 0777);
    expect_end(echo_onto_a_directory, RG_FAILURE,
               "rhegma: out/case.yaml: cannot be written: Is a directory\n");
    expect_file("out/case.yaml.part", text);
    remove("out/case.yaml.part");
    remove("out/case.yaml");
    remove("out");
    free(text);
    rg_case_free(c);
}

/* ---- tables ---- */

static void test_table(void **state) {
    (void)state;
    rg_csv *t = rg_csv_open(".", "t.csv", 0), *silent = rg_csv_open(".", "other.csv", 1);
    rg_csv_header(t, "a,b,c,d");
    rg_csv_row(t, (const int64_t[]){1, -2}, 2, (const double[]){0.1, -1e300}, 2);
    expect_file("t.csv", "a,b,c,d\n1,-2,0.10000000000000001,-1.0000000000000001e+300\n"); /* at once */
    rg_csv_row(t, (const int64_t[]){INT64_MAX}, 1, NULL, 0);
    assert_int_equal(rg_csv_sync(t), 8 + 50 + 20);
    rg_csv_row(t, (const int64_t[]){3}, 1, NULL, 0);
    rg_csv_header(silent, "a");
    rg_csv_row(silent, (const int64_t[]){1}, 1, NULL, 0);
    rg_csv_hold(silent);
    assert_int_equal(rg_csv_sync(silent), 0);
    rg_csv_close(t);
    rg_csv_close(silent);
    assert_false(there("other.csv"));
    t = rg_csv_reopen(".", "t.csv", 0, 8);
    silent = rg_csv_reopen(".", "other.csv", 2, 99);
    rg_csv_row(t, (const int64_t[]){4}, 1, (const double[]){5}, 1);
    rg_csv_close(t);
    rg_csv_close(silent);
    expect_file("t.csv", "a,b,c,d\n4,5\n");
    remove("t.csv");
}

static void test_energy_table(void **state) {
    (void)state;
    rg_other_material steel = {.is = {.name = (char[]){"steel"}}};
    rg_case input = {.material = {.name = (char[]){"glass"}}, .other = &steel, .others = 1};
    rg_model model = {.materials = 1};
    const rg_solver solver = {.input = &input, .model = &model};
    const rg_ledger l = {.last = {.step = 41,
                                  .time = 1,
                                  .kinetic = 2,
                                  .bodies = 3,
                                  .bulk = 4,
                                  .penalty = 5,
                                  .cohesive = 6,
                                  .contact = 7,
                                  .foundation = 7.5,
                                  .dissipated = 8,
                                  .plastic = 9,
                                  .damage = 10,
                                  .viscous = 11,
                                  .friction = 12,
                                  .unresolved = 13,
                                  .radiated = 13.5,
                                  .half_kick = 14,
                                  .external = 15,
                                  .total = 16,
                                  .error = 17,
                                  .share = NAN,
                                  .broken_area = 18,
                                  .failed_area = 19,
                                  .momentum = {20, 21, 22},
                                  .angular_momentum = {23, 24, 25}},
                         .material = {{26, 27, 28}, {29, 30, 31}}};
    static const char header[] =
        "step,time,kinetic,bodies,bulk,penalty,cohesive,contact,foundation,dissipated,plastic,damage,viscous,"
        "friction,"
        "unresolved,radiated,half_kick,external_work,total,error_rel,error_dissipated,broken_area,failed_"
        "area,"
        "momentum_x,momentum_y,"
        "momentum_z,angular_x,angular_y,angular_z";
    static const char row[] =
        "41,1,2,3,4,5,6,7,7.5,8,9,10,11,12,13,13.5,14,15,16,17,nan,18,19,20,21,22,23,24,25";
    char wanted[1000];
    for (int two = 0; two < 2; two++) {
        rg_csv *t = rg_csv_open(".", "e.csv", 0);
        model.materials = 1 + two;
        rg_energy_header(t, &solver);
        rg_energy_row(t, &l, &solver);
        rg_csv_close(t);
        snprintf(wanted, sizeof wanted, "%s%s\n%s%s\n", header,
                 two ? ",kinetic_glass,bulk_glass,dissipated_glass,kinetic_steel,bulk_steel,dissipated_steel"
                     : "",
                 row, two ? ",26,27,28,29,30,31" : "");
        expect_file("e.csv", wanted);
        remove("e.csv");
    }
}

static void write_full(void) {
    rg_csv_header(rg_csv_open("/dev", "full", 0), "a,b");
}

static void sync_table(void) {
    rg_csv_sync(rg_csv_open("/dev", "null", 0));
}

static void ask_whether_busy(void) {
    rg_refuse_busy(".", "t.csv");
    rg_refuse_busy(".", "none.csv");
    rg_csv_hold(rg_csv_open(".", "t.csv", 0));
    fputs("mine", stderr);
}

static void hold_what_is_held(void) {
    rg_csv_hold(rg_csv_reopen(".", "t.csv", 0, 0));
}

static void test_busy_table(void **state) {
    (void)state;
    static const char busy[] =
        "rhegma: ./t.csv: another run is writing to it; wait for its end, or take another directory\n";
    expect_end(write_full, RG_FAILURE, "rhegma: /dev/full: cannot be written: No space left on device\n");
    expect_end(sync_table, RG_FAILURE, "rhegma: /dev/null: cannot be written: Invalid argument\n");
    rg_csv *t = rg_csv_open(".", "t.csv", 0);
    expect_end(ask_whether_busy, 0, "mine");
    rg_csv_hold(t);
    expect_end(ask_whether_busy, RG_USAGE, busy);
    expect_end(hold_what_is_held, RG_USAGE, busy);
    rg_csv_close(t);
    expect_end(ask_whether_busy, 0, "mine");
    rg_refuse_busy(".", "t.csv"); /* asking does not hold it */
    expect_end(ask_whether_busy, 0, "mine");
    remove("t.csv");
}

int main(int argc, char **argv) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fatal),       cmocka_unit_test(test_faults),
        cmocka_unit_test(test_memory),      cmocka_unit_test(test_out_of_memory),
        cmocka_unit_test(test_directories), cmocka_unit_test(test_input),
        cmocka_unit_test(test_sync),        cmocka_unit_test(test_open_and_close),
        cmocka_unit_test(test_reopen),      cmocka_unit_test(test_removing),
        cmocka_unit_test(test_own_case),    cmocka_unit_test(test_echo),
        cmocka_unit_test(test_table),       cmocka_unit_test(test_energy_table),
        cmocka_unit_test(test_busy_table),
    };
    MPI_Init(&argc, &argv);
    int failed = cmocka_run_group_tests(tests, set_up, tear_down);
    MPI_Finalize();
    return failed;
}
