/* The time loop as its files show it: which steps, which outputs, how it stops and goes on. A bar of a few
 * elements; every run in a process of its own. */
#define _DEFAULT_SOURCE /* mkdtemp */
#include <dirent.h>
#include <fcntl.h>
#include <math.h>
#include <omp.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/error.h"
#include "base/files.h"
#include "base/interrupt.h"
#include "case/read.h"
#include "diagnostics/ledger.h"
#include "output/fragment_table.h"
#include "output/progress.h"
#include "run.h"
#include "support/child.h"

static const char text[] = "mesh: {cells: [1, 1, 2], size: [1e-3, 1e-3, 2e-3]}\n"
                           "material: {model: neo-hookean, young: 260e9, poisson: 0.21, density: 3690}\n"
                           "interface: {law: linear, strength: 4e9, energy: 3400}\n"
                           "initial: {velocity: {z: 20*z/2e-3}}\n"
                           "time: {end: 1}\n"
                           "output: {dir: out, interval: 1, fields: [velocity]}\n";

static char directory[] = "/tmp/test_run.XXXXXX"; /* in which the tests run */
static char said[16384], printed[65536];

static int set_up(void **state) {
    (void)state;
    return mkdtemp(directory) == NULL || chdir(directory) != 0;
}

static int clear(void **state) {
    (void)state;
    return system("rm -rf out held looks taken shown") != 0;
}

static int tear_down(void **state) {
    (void)state;
    return system("rm -rf stdout") != 0 || chdir("/") != 0 || rmdir(directory) != 0;
}

/* ---- calls that leave a mark: "held" once the results are, "looks" a byte for each look at fragments ----
 */

static void mark(const char *name, char byte) {
    FILE *f = fopen(name, "a");
    fputc(byte, f);
    fclose(f);
}

void __real_rg_csv_hold(const rg_csv *t);
void __wrap_rg_csv_hold(const rg_csv *t);
void __wrap_rg_csv_hold(const rg_csv *t) {
    __real_rg_csv_hold(t);
    mark("held", '+');
}

static bool blind; /* nobody looks */
bool __wrap_rg_fragment_table_looks(const rg_fragment_table *t);
bool __wrap_rg_fragment_table_looks(const rg_fragment_table *t) {
    (void)t;
    return !blind;
}

void __wrap_rg_fragment_table_look(rg_fragment_table *t, const rg_solver *s, const rg_fragment_parts *p);
void __wrap_rg_fragment_table_look(rg_fragment_table *t, const rg_solver *s, const rg_fragment_parts *p) {
    (void)t;
    (void)s;
    mark("looks", p != NULL ? '+' : '-');
}

static bool followed; /* the looks at the energy are noted, and the lines of progress */
const rg_energy *__real_rg_ledger_take(rg_ledger *l, rg_solver *s);
const rg_energy *__wrap_rg_ledger_take(rg_ledger *l, rg_solver *s);
const rg_energy *__wrap_rg_ledger_take(rg_ledger *l, rg_solver *s) {
    if (followed) {
        FILE *f = fopen("taken", "a");
        fprintf(f, "%d ", (int)s->step);
        fclose(f);
    }
    return __real_rg_ledger_take(l, s);
}

void __real_rg_progress_show(rg_progress *p, const rg_solver *s, const rg_energy *e);
void __wrap_rg_progress_show(rg_progress *p, const rg_solver *s, const rg_energy *e);
void __wrap_rg_progress_show(rg_progress *p, const rg_solver *s, const rg_energy *e) {
    if (followed) {
        mark("shown", e->step == s->step ? '+' : '-');
    }
    __real_rg_progress_show(p, s, e);
}

/* ---- a run ---- */

static struct {
    const char *set[16];
    rg_run_options options;
    int signal_to_send; /* before it begins; 0: none */
    bool check;         /* rg_run_check in place of rg_run */
} job;

static void go(void) {
    int file = open("stdout", O_WRONLY | O_CREAT | O_TRUNC, 0666), count = 0;
    dup2(file, STDOUT_FILENO);
    omp_set_num_threads(1); /* here: a child has none of its parent's settings with Clang's library */
    while (job.set[count] != NULL) {
        count++;
    }
    rg_case *c = rg_case_read_text("bar.yaml", text, strlen(text), count, job.set, stderr);
    rg_interrupt_listen();
    if (job.signal_to_send != 0) {
        raise(job.signal_to_send);
    }
    int status = c == NULL   ? 99
                 : job.check ? rg_run_check(c, MPI_COMM_WORLD)
                             : rg_run(c, MPI_COMM_WORLD, &job.options);
    fflush(stdout);
    fflush(stderr);
    _exit(status);
}

static double elapsed; /* in the last run (s) */

static void expect_status(int status) {
    double begin = MPI_Wtime();
    int found = run_child(go, said, sizeof said);
    elapsed = MPI_Wtime() - begin;
    if (found != status) {
        fail_msg("status %d, not %d: %s", found, status, said);
    }
    FILE *f = fopen("stdout", "r");
    printed[fread(printed, 1, sizeof printed - 1, f)] = '\0';
    fclose(f);
}

#define RUN(status_, ...)                                                                                    \
    do {                                                                                                     \
        memset(&job, 0, sizeof job);                                                                         \
        memcpy(job.set, (const char *[16]){__VA_ARGS__}, sizeof job.set);                                    \
        job.options.quiet = true;                                                                            \
        expect_status(status_);                                                                              \
    } while (0)

/* ---- what it left ---- */

enum { MOST = 256 };

typedef struct {
    int rows;
    int64_t step[MOST];
    double time[MOST], total[MOST];
} table;

static table read_energy(void) {
    table t = {.rows = 0};
    char line[2048];
    FILE *f = fopen("out/energy.csv", "r");
    assert_non_null(f);
    assert_non_null(fgets(line, sizeof line, f));
    int columns = 0; /* before the total */
    char *total = strstr(line, ",total,");
    for (char *at = line; total != NULL && at <= total; at++) {
        columns += *at == ',';
    }
    assert_true(columns > 2 && columns < 32);
    while (fgets(line, sizeof line, f) != NULL && t.rows < MOST) {
        double column[32];
        char *at = line;
        for (int k = 0; k <= columns; k++) {
            column[k] = strtod(at, &at);
            at++;
        }
        t.step[t.rows] = (int64_t)column[0];
        t.time[t.rows] = column[1];
        t.total[t.rows] = column[columns];
        t.rows++;
    }
    fclose(f);
    return t;
}

static char *read_all(const char *path) {
    static char bytes[2][65536];
    static int next;
    char *text_of = bytes[next++ % 2];
    FILE *f = fopen(path, "r");
    assert_non_null(f);
    text_of[fread(text_of, 1, sizeof bytes[0] - 1, f)] = '\0';
    fclose(f);
    return text_of;
}

static double summary(const char *key) {
    char word[64];
    snprintf(word, sizeof word, "\"%s\": ", key);
    const char *at = strstr(read_all("out/summary.json"), word);
    assert_non_null(at);
    return strtod(at + strlen(word), NULL);
}

static int count_in(const char *dir, const char *end) {
    int count = 0;
    DIR *folder = opendir(dir);
    for (struct dirent *e = folder == NULL ? NULL : readdir(folder); e != NULL; e = readdir(folder)) {
        size_t n = strlen(e->d_name), m = strlen(end);
        count += n > m && strcmp(e->d_name + n - m, end) == 0;
    }
    if (folder != NULL) {
        closedir(folder);
    }
    return count;
}

/* Times of the field output, from its description. */
static int frames(double time[MOST]) {
    int count = 0;
    for (const char *at = read_all("out/fields.xdmf"); (at = strstr(at, "<Time Value=\"")) != NULL; count++) {
        at += strlen("<Time Value=\"");
        time[count] = strtod(at, NULL);
    }
    return count;
}

static bool close_to(double a, double b) {
    return fabs(a - b) <= 1e-14 * fabs(b); /* sums of time steps */
}

/* "key=value" of a time in units of dt. */
static const char *option(int slot, const char *format, double value) {
    static char kept[4][256];
    snprintf(kept[slot], sizeof kept[slot], format, value);
    return kept[slot];
}

static double dt; /* of the bar: what the summary of the first run says */

/* ---- outputs ---- */

static void test_steps_as_interval(void **state) {
    (void)state;
    RUN(RG_OK, "output.interval=4", "time.steps=10");
    assert_string_equal(said, "");
    assert_string_equal(printed, "");
    dt = summary("dt_first");
    static const int64_t step[] = {0, 4, 8, 10};
    double time[MOST];
    table t = read_energy();
    assert_int_equal(t.rows, 4);
    assert_int_equal(frames(time), 4);
    for (int i = 0; i < 4; i++) {
        assert_int_equal(t.step[i], step[i]);
        assert_true(close_to(t.time[i], (double)step[i] * dt) && close_to(time[i], t.time[i]));
    }
    assert_true(summary("steps") == 10 && summary("dt_last") == dt && close_to(summary("time_end"), 10 * dt));
    assert_non_null(strstr(read_all("out/case.yaml"), "steps: 10\n"));
    assert_true(summary("restarted_from_step") == 0 && summary("partitions") == 1 &&
                summary("checkpoints") == 0);
    assert_true(summary("wall_s") > 0 && summary("output_s") > 0 && summary("output_s") < summary("wall_s"));
    assert_true(summary("setup_s") > 0 && summary("setup_s") < 60 && summary("wall_s") < 60);
    assert_int_equal(count_in("out/checkpoints", ".h5"), 0);
    assert_string_equal(read_all("held"), "+");
    assert_string_equal(read_all("looks"), "++++");
    assert_true(summary("setup_s") + summary("wall_s") < elapsed); /* each moment counts once */
    /* of the critical step, as time.safety says by default */
    assert_true(fabs(dt / summary("dt_critical") - 0.875) < 1e-12);
}

/* The first state at or after each multiple of the interval, the start being one, and the last one; the last
 * step ends at time.end. */
static void test_time_as_interval(void **state) {
    (void)state;
    const double ends[] = {9.3, 10, 10.4};
    for (int k = 0; k < 3; k++) {
        double interval = k == 1 ? 2 : 2.6, end = ends[k], now[MOST];
        RUN(RG_OK, option(0, "output.interval=%.17g", interval * dt), option(1, "time.end=%.17g", end * dt));
        table t = read_energy();
        int rows = 0, steps = (int)ceil(end - 1e-6);
        double next = 0;
        for (int i = 0; i <= steps; i++) {
            double time = i < steps ? i : end;
            if (time >= next - 1e-6 || i == steps) {
                assert_true(rows < t.rows && t.step[rows] == i && close_to(t.time[rows], time * dt));
                rows++;
                next = (floor(time / interval + 1e-6) + 1) * interval;
            }
        }
        assert_int_equal(t.rows, rows);
        assert_int_equal(frames(now), rows);
        assert_true(summary("time_end") == t.time[rows - 1] && summary("steps") == steps);
        assert_true(fabs(summary("dt_last") / dt - (end > steps - 1 ? end - (steps - 1) : 1)) < 1e-6);
        clear(NULL);
    }
}

/* Equal steps up to each moment of output.times, at which the fields are written, and only then. */
static void test_moments(void **state) {
    (void)state;
    char times[256];
    snprintf(times, sizeof times, "output.times=[0, %.17g, %.17g, %.17g]", 2.5 * dt, 2.9 * dt, 6 * dt);
    RUN(RG_OK, times, option(0, "time.end=%.17g", 7.2 * dt));
    static const double expected[] = {
        0, 2.5 / 3, 5.0 / 3, 2.5, 2.9, 2.9 + 3.1 / 4, 2.9 + 6.2 / 4, 2.9 + 9.3 / 4, 6, 7, 7.2};
    static const double moments[] = {0, 2.5, 2.9, 6};
    double time[MOST];
    table t = read_energy();
    assert_int_equal(t.rows, sizeof expected / sizeof *expected);
    for (int i = 0; i < t.rows; i++) {
        assert_true(t.step[i] == i && close_to(t.time[i], expected[i] * dt));
    }
    assert_int_equal(frames(time), 4);
    for (int i = 0; i < 4; i++) {
        assert_true(close_to(time[i], moments[i] * dt));
    }
    clear(NULL);
    /* Where the ledger is seldom due it has rows at these moments, too. */
    RUN(RG_OK, times, option(0, "time.end=%.17g", 7.2 * dt), "output.interval=100");
    t = read_energy();
    static const int64_t step[] = {0, 3, 4, 8, 10};
    assert_int_equal(t.rows, 5);
    for (int i = 0; i < 5; i++) {
        assert_int_equal(t.step[i], step[i]);
    }
}

/* The energy is looked at between outputs, too, first in step 16. */
static void test_energy_limit_between_outputs(void **state) {
    (void)state;
    RUN(RG_FAILURE, "output.energy_limit=1e-9", "output.interval=100", "time.steps=30", "time.safety=0.9");
    table t = read_energy();
    assert_true(t.rows == 2 && t.step[0] == 0 && t.step[1] == 16);
    assert_non_null(strstr(said, " passed the limit 1e-09 (output.energy_limit)"));
    clear(NULL);
    RUN(RG_OK, "output.interval=100", "time.steps=30"); /* looking leaves no trace */
    t = read_energy();
    assert_true(t.rows == 2 && t.step[1] == 30);
    static char hash[2][64];
    snprintf(hash[0], sizeof hash[0], "%s", strstr(read_all("out/summary.json"), "state_hash"));
    clear(NULL);
    RUN(RG_OK, "output.interval=1", "time.steps=30");
    snprintf(hash[1], sizeof hash[1], "%s", strstr(read_all("out/summary.json"), "state_hash"));
    hash[0][30] = hash[1][30] = '\0';
    assert_string_equal(hash[0], hash[1]);
}

/* An element that is pressed together is stiffer: the step is that of rest over a power of 2^(1/8). */
static void test_step_follows_stiffness(void **state) {
    (void)state;
    for (int steps = 1; steps <= 2;
         steps++) { /* pressed to 60 and 30 % of the length; the latter steps carefully */
        RUN(RG_OK, "time.steps=6", "interface={law: none}", "initial={}",
            steps == 1 ? "initial.displacement.z=-0.4*z" : "initial.displacement.z=-0.7*z",
            "output.energy_limit=1e9", "time.collapse=0");
        double power = 8 * log2(0.875 * summary("dt_critical") / summary("dt_first")),
               rows = read_energy().rows;
        assert_true(rows == 7 && power > 0.5 && fabs(power - round(power)) < 1e-9);
        assert_true(steps == 1 ? power < 8 : power > 8);
        clear(NULL);
    }
}

/* ---- ends before the end ---- */

/* Four times as late as the last time, but after 16 steps at the earliest and 2048 at the latest; an output
 * looks, too. */
static void test_looks_at_the_energy(void **state) {
    (void)state;
    followed = true;
    RUN(RG_OK, "interface={law: none}", "output.interval=100000", "time.steps=5200");
    assert_string_equal(read_all("taken"), "0 16 64 256 1024 3072 5120 5200 ");
    assert_string_equal(read_all("shown"), "++");
    clear(NULL);
    RUN(RG_OK, "interface={law: none}", "output.interval=50", "time.steps=230");
    assert_string_equal(read_all("taken"), "0 16 50 100 150 200 230 ");
    assert_string_equal(read_all("shown"), "++++++");
    followed = false;
}

static void test_energy_limit(void **state) {
    (void)state;
    RUN(RG_FAILURE, "output.energy_limit=1e-9", "output.interval=3", "time.steps=30", "time.safety=0.9");
    char words[128];
    table t = read_energy();
    assert_non_null(strstr(said, "rhegma: stopped: the energy error "));
    assert_non_null(strstr(said, " passed the limit 1e-09 (output.energy_limit)"));
    assert_true(t.rows == 7 && t.step[5] == 15 && t.step[6] == 18); /* judged from step 16 on */
    double time[MOST];
    assert_int_equal(frames(time), t.rows); /* the failed state, too */
    const char *autopsy = read_all("out/autopsy.json");
    snprintf(words, sizeof words, "\"step\": %d,", (int)t.step[t.rows - 1]);
    assert_non_null(strstr(autopsy, words));
    assert_non_null(strstr(read_all("out/summary.json"), "\"status\": \"the energy error "));
    assert_true(summary("steps") == (double)t.step[t.rows - 1]);
    assert_string_equal(printed, "");
}

/* The state that no step leaves has its outputs, whole, whether or not one was due: its energy is that of the
 * start. From half the step on elements may turn inside out, and each step is looked at before the next. */
static void test_collapse(void **state) {
    (void)state;
    static const struct {
        double least;
        const char *interval, *collapse;
        double energy; /* change of it, relative, at 2 to 3 times what is found */
    } known[] = {{0.8, "output.interval=1000", "time.collapse=0.8", 2.5e-4},
                 {0.8, "output.interval=1", "time.collapse=0.8", 2e-4},
                 {0.4, "output.interval=1000", "time.collapse=0.4", 2.5e-4},
                 {0.4, "output.interval=1", "time.collapse=0.4", 2.5e-4}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        double least = known[i].least;
        bool each = i % 2 == 1;
        char words[64];
        RUN(RG_FAILURE, "time.steps=200", "interface={law: none}", "initial.velocity.z=-20000*z/2e-3",
            known[i].collapse, "output.energy_limit=1e9", known[i].interval, "time.safety=0.5");
        assert_non_null(strstr(said, "rhegma: stopped: the time step collapsed: "));
        snprintf(words, sizeof words, " s, below %g (time.collapse) of the ", least);
        assert_non_null(strstr(said, words));
        double next = strtod(strstr(said, "collapsed: ") + strlen("collapsed: "), NULL);
        double rest = strtod(strstr(said, "of the ") + strlen("of the "), NULL);
        assert_true(fabs(rest / summary("dt_first") - 1) < 5e-3 && next < least * rest &&
                    next > (least - 0.2) * rest);
        table t = read_energy();
        double time[MOST];
        int last = t.rows - 1;
        assert_true(t.step[0] == 0 && t.step[last] > 2 && t.step[last] < 200);
        assert_true(each ? t.step[last] == last : last == 1);
        assert_int_equal(frames(time), t.rows);
        assert_true(close_to(time[last], t.time[last]));
        assert_true(summary("steps") == (double)t.step[last]);
        assert_true(fabs(t.total[last] / t.total[0] - 1) < known[i].energy);
        snprintf(words, sizeof words, "; last good output at %.6g s\n", t.time[last - 1]);
        assert_non_null(strstr(said, words));
        clear(NULL);
    }
}

static void test_not_finite(void **state) {
    (void)state;
    RUN(RG_FAILURE, "time.steps=20",
        option(0, "boundary=[{set: z+, component: z, velocity: '1/(t < %.17g)'}]", 4.5 * dt),
        "output.interval=100");
    assert_non_null(strstr(said, "rhegma: stopped: the state is not finite (boundary"));
    clear(NULL);
    RUN(RG_FAILURE, "time.steps=200", "interface={law: none}", "initial.velocity.z=-300000*z/2e-3",
        "time.collapse=0", "output.energy_limit=1e300", "output.interval=100");
    assert_non_null(strstr(said, "rhegma: stopped: the state is not finite (or an element is inside out)"));
    assert_int_equal(access("out/autopsy.json", F_OK), 0);
}

/* ---- checkpoints ---- */

#define CHECKPOINTS "checkpoint={steps: 3}", "output.interval=2"

static void restart(int status) {
    job.options.restart = true;
    job.signal_to_send = 0;
    expect_status(status);
}

static void test_restart(void **state) {
    (void)state;
    RUN(RG_OK, "output.interval=2", "time.steps=11");
    static char whole[65536];
    snprintf(whole, sizeof whole, "%s", read_all("out/energy.csv"));
    double worst = summary("energy_error_rel");
    clear(NULL);
    RUN(RG_OK, CHECKPOINTS, "time.steps=7");
    assert_int_equal(count_in("out/checkpoints", ".h5"), 2); /* of steps 6 and 7 */
    assert_true(summary("checkpoints") == 3 && summary("checkpoint_s") > 0);
    assert_true(summary("checkpoint_median_s") > 0 && summary("checkpoint_median_s") < 30);
    job.set[2] = "time.steps=11";
    job.options.quiet = false;
    restart(RG_OK);
    assert_non_null(strstr(printed, "goes on from step 7, time "));
    assert_string_equal(read_all("held"), "++");
    /* the run that stopped at step 7 had a row for that */
    const char *found = read_all("out/energy.csv");
    for (const char *line = whole; *line != '\0'; line = strchr(line, '\n') + 1) {
        char copy[2048];
        snprintf(copy, sizeof copy, "%.*s\n", (int)strcspn(line, "\n"), line);
        if (strstr(found, copy) == NULL) {
            fail_msg("no row %s", copy);
        }
    }
    assert_true(summary("steps") == 11 && summary("restarted_from_step") == 7);
    assert_non_null(strstr(read_all("out/case.yaml"), "steps: 11\n"));
    assert_true(summary("energy_error_rel") == worst);
    restart(RG_OK); /* again: nothing is left */
    assert_non_null(
        strstr(said, "rhegma: warning: nothing is left to compute: the checkpoint is of step 11, time "));
    assert_non_null(strstr(said, " s; time.end or time.steps must be beyond\n"));
    assert_null(strstr(printed, "goes on"));
}

/* A signal before the first step: it stops with a checkpoint; the rest is as if nothing had been. */
static void test_stop_and_go_on(void **state) {
    (void)state;
    static char whole[65536];
    RUN(RG_OK, "output.interval=2", "time.steps=5");
    snprintf(whole, sizeof whole, "%s", read_all("out/energy.csv"));
    clear(NULL);
    memset(&job, 0, sizeof job);
    job.set[0] = "output.interval=2";
    job.set[1] = "time.steps=5";
    job.signal_to_send = SIGUSR2;
    expect_status(RG_INTERRUPTED);
    assert_non_null(strstr(said, "rhegma: stopped with a checkpoint at step "));
    assert_non_null(strstr(said, " s, by a signal; goes on with: rhegma run --restart out\n"));
    assert_int_equal(count_in("out/checkpoints", ".h5"), 1);
    assert_non_null(strstr(read_all("out/summary.json"), "\"status\": \"stopped by a signal\""));
    job.signal_to_send = 0;
    job.options.quiet = true;
    expect_status(RG_USAGE); /* without a word it does not begin anew */
    assert_string_equal(said,
                        "rhegma: out holds checkpoints of a run that did not end: --restart out goes on from "
                        "them, --overwrite starts anew without them\n");
    restart(RG_OK);
    assert_string_equal(said, "");
    assert_string_equal(printed, "");
    assert_string_equal(read_all("out/energy.csv"), whole);
    /* one that ended may be replaced */
    job.options.restart = false;
    expect_status(RG_OK);
    assert_string_equal(read_all("out/energy.csv"), whole);
    assert_int_equal(count_in("out/checkpoints", ".h5"), 0);
    job.signal_to_send = SIGUSR2;
    expect_status(RG_INTERRUPTED);
    job.signal_to_send = 0;
    job.options.overwrite = true;
    expect_status(RG_OK);
    assert_string_equal(read_all("out/energy.csv"), whole);
    job.options.overwrite = false;
    job.options.walltime = 1e-9; /* there is time for nothing */
    expect_status(RG_INTERRUPTED);
    assert_non_null(strstr(said, "rhegma: warning: the wall-time limit of 0 s leaves no time for steps"));
    assert_non_null(strstr(said, ", before the wall-time limit; goes on with: rhegma run --restart out\n"));
}

/* SIGUSR1 asks for one checkpoint, and the run goes on. */
static void test_checkpoint_by_signal(void **state) {
    (void)state;
    memset(&job, 0, sizeof job);
    job.set[0] = "time.steps=5";
    job.options.quiet = true;
    job.signal_to_send = SIGUSR1;
    expect_status(RG_OK);
    assert_true(summary("checkpoints") == 1 && summary("steps") == 5);
    assert_int_equal(count_in("out/checkpoints", ".h5"), 1);
    /* while another run holds the results, nobody goes on with them */
    int file = open("out/energy.csv", O_RDWR);
    assert_int_equal(flock(file, LOCK_EX), 0);
    restart(RG_USAGE);
    assert_non_null(strstr(said, "out/energy.csv: another run is writing to it"));
    close(file);
    restart(RG_OK);
}

/* The table of fragments has rows of the moments that output.fragments asks for. */
static void test_fragments(void **state) {
    (void)state;
    static const char *const when[] = {"output.fragments=each", "output.fragments=last",
                                       "output.fragments=none"};
    static const int lines[] = {4, 2, 0}; /* of the states at steps 0, 3 and 6, and the heading */
    for (int i = 0; i < 3; i++) {
        RUN(RG_OK, "time.steps=6", "output.interval=3", when[i]);
        int found = 0;
        FILE *f = fopen("out/fragments.csv", "r");
        for (int c = f == NULL ? EOF : fgetc(f); c != EOF; c = fgetc(f)) {
            found += c == '\n';
        }
        if (f != NULL) {
            fclose(f);
        }
        assert_int_equal(found, lines[i]);
        assert_string_equal(read_all("looks"), "+++"); /* for which they are found, table or not */
        clear(NULL);
    }
    blind = true; /* a field of fragments finds them, too */
    RUN(RG_OK, "time.steps=6", "output.interval=3", "output.fragments=none", "output.fields=[fragment]");
    blind = false;
    assert_int_not_equal(access("looks", F_OK), 0);
}

/* A new interval on a restart: outputs are due at its multiples. (The row of the last state goes.) */
static void test_restart_with_another_interval(void **state) {
    (void)state;
    RUN(RG_OK, option(0, "output.interval=%.17g", 2 * dt), "checkpoint.steps=3", "time.steps=5");
    job.set[0] = option(0, "output.interval=%.17g", 4 * dt);
    job.set[2] = "time.steps=13";
    restart(RG_OK);
    static const int64_t step[] = {0, 2, 4, 8, 12, 13};
    table t = read_energy();
    assert_int_equal(t.rows, 6);
    for (int i = 0; i < 6; i++) {
        assert_int_equal(t.step[i], step[i]);
    }
    clear(NULL);
    RUN(RG_OK, option(0, "output.interval=%.17g", 4 * dt), "checkpoint.steps=3", "time.steps=5");
    job.set[2] = "time.steps=13"; /* the same interval */
    restart(RG_OK);
    static const int64_t same[] = {0, 4, 8, 12, 13};
    t = read_energy();
    assert_int_equal(t.rows, 5);
    for (int i = 0; i < 5; i++) {
        assert_int_equal(t.step[i], same[i]);
    }
}

/* ---- words ---- */

/* What is said before, by rg_run_check as by a run that is not quiet; with a warning on standard error. */
static void test_words(void **state) {
    (void)state;
    for (int check = 0; check < 2; check++) {
        memset(&job, 0, sizeof job);
        job.check = check;
        job.set[0] = "time.steps=3";
        job.set[1] =
            "materials=[{name: m, where: 1, model: neo-hookean, young: 2e11, poisson: 0.2, density: 4e3}]";
        expect_status(RG_OK);
        assert_string_equal(
            said,
            "rhegma: warning: bar.yaml: material material: later materials claim all of its elements\n");
        const char *elements = strstr(printed, "elements       12 ("),
                   *ranks = strstr(printed, "rank 0         1 thr");
        assert_true(elements == printed && ranks > elements);
        assert_int_equal(strstr(printed, "results in out\n") != NULL, !check);
        assert_int_equal(access("out", F_OK) == 0, !check);
        clear(NULL);
    }
    job.check = false;
    job.options.quiet = true;
    expect_status(RG_OK);
    assert_string_equal(printed, "");
    assert_non_null(strstr(said, "rhegma: warning: bar.yaml: material material: later"));
}

int main(int argc, char **argv) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_steps_as_interval, clear),
        cmocka_unit_test_teardown(test_time_as_interval, clear),
        cmocka_unit_test_teardown(test_moments, clear),
        cmocka_unit_test_teardown(test_step_follows_stiffness, clear),
        cmocka_unit_test_teardown(test_energy_limit, clear),
        cmocka_unit_test_teardown(test_energy_limit_between_outputs, clear),
        cmocka_unit_test_teardown(test_looks_at_the_energy, clear),
        cmocka_unit_test_teardown(test_collapse, clear),
        cmocka_unit_test_teardown(test_not_finite, clear),
        cmocka_unit_test_teardown(test_restart, clear),
        cmocka_unit_test_teardown(test_stop_and_go_on, clear),
        cmocka_unit_test_teardown(test_checkpoint_by_signal, clear),
        cmocka_unit_test_teardown(test_fragments, clear),
        cmocka_unit_test_teardown(test_restart_with_another_interval, clear),
        cmocka_unit_test_teardown(test_words, clear),
    };
    MPI_Init(&argc, &argv);
    int failed = cmocka_run_group_tests(tests, set_up, tear_down);
    MPI_Finalize();
    return failed;
}
