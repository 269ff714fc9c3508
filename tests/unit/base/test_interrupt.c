/* Signals and the clock as requests of a run, and what a run says of its processors. */
#define _GNU_SOURCE /* sched_setaffinity */
#include <math.h>
#include <omp.h>
#include <sched.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#include "base/affinity.h"
#include "base/interrupt.h"
#include "support/child.h"

static char said[4096];

/* Each job says what it finds. */
static void expect(void (*job)(void), int status, const char *words) {
    assert_int_equal(run_child(job, said, sizeof said), status);
    assert_string_equal(said, words);
}

static const char *stop_request(void) {
    static const char *const word[] = {"none ", "checkpoint ", "stop ", "time-up "};
    return word[rg_interrupt_request()];
}

/* ---- signals ---- */

static void be_asked_for_a_checkpoint(void) {
    rg_interrupt_listen();
    fputs(stop_request(), stderr);
    raise(SIGUSR1);
    fputs(stop_request(), stderr);
    fputs(stop_request(), stderr); /* until it is answered */
    rg_interrupt_answered();
    fputs(stop_request(), stderr);
    raise(SIGUSR1);
    fputs(stop_request(), stderr); /* again */
    raise(SIGUSR2);
    fputs(stop_request(), stderr); /* the larger one */
    rg_interrupt_answered();
    fputs(stop_request(), stderr); /* which stays */
    rg_interrupt_clock(0, INFINITY);
    fputs(stop_request(), stderr);
}

static int signal_to_send;

static void be_signalled(void) {
    rg_interrupt_listen();
    raise(signal_to_send);
    fputs(stop_request(), stderr);
}

static void be_signalled_twice(void) {
    rg_interrupt_listen();
    raise(signal_to_send);
    raise(signal_to_send);
    fputs(stop_request(), stderr);
}

static void be_signalled_deaf(void) {
    rg_interrupt_listen();
    rg_interrupt_deafen();
    raise(signal_to_send);
    fputs(stop_request(), stderr);
}

static void start_with_nohup(void) {
    signal(SIGHUP, SIG_IGN);
    be_signalled();
}

static void deafen_with_nohup(void) {
    signal(SIGHUP, SIG_IGN);
    be_signalled_deaf();
}

static void test_signals(void **state) {
    (void)state;
    static const struct {
        int number;
        const char *once;
        int twice; /* exit status */
        bool deafened;
    } known[] = {{SIGUSR1, "checkpoint ", 0, true},
                 {SIGUSR2, "stop ", 0, true},
                 {SIGTERM, "stop ", 1000 + SIGTERM, true},
                 {SIGINT, "stop ", 1000 + SIGINT, true},
                 {SIGHUP, "stop ", 0, true},
                 {SIGPIPE, "none ", 0, true},
                 {SIGXFSZ, "none ", 0, false}};
    expect(be_asked_for_a_checkpoint, 0, "none checkpoint checkpoint none checkpoint stop stop time-up ");
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        signal_to_send = known[i].number;
        expect(be_signalled, 0, known[i].once);
        expect(be_signalled_twice, known[i].twice, known[i].twice == 0 ? known[i].once : "");
        if (known[i].deafened) {
            expect(be_signalled_deaf, 1000 + known[i].number, "");
        }
    }
    signal_to_send = SIGHUP;
    expect(start_with_nohup, 0, "none ");
    expect(deafen_with_nohup, 0, "none ");
}

/* ---- the clock ---- */

static double clock_now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Over more than a second, so that nanoseconds are greater and less than at the start. */
static void look_at_the_clock(void) {
    double before = clock_now();
    rg_interrupt_listen();
    double after = clock_now();
    for (int i = 0; i < 11; i++) {
        double least = clock_now() - after, now = rg_interrupt_now(), most = clock_now() - before;
        if (now < least - 1e-6 || now > most + 1e-6) {
            fprintf(stderr, "%g is not from %g to %g\n", now, least, most);
        }
        nanosleep(&(struct timespec){.tv_nsec = 100000000}, NULL);
    }
}

static void wait_for_the_clock(void) {
    rg_interrupt_listen();
    rg_interrupt_clock(INFINITY, INFINITY);
    fputs(stop_request(), stderr);
    rg_interrupt_clock(1000, 1000);
    fputs(stop_request(), stderr);
    rg_interrupt_clock(1000, 0);
    fputs(stop_request(), stderr);
    rg_interrupt_clock(INFINITY, 0);
    fputs(stop_request(), stderr);
    rg_interrupt_clock(0, 1000);
    fputs(stop_request(), stderr);
    rg_interrupt_clock(0, INFINITY);
    fputs(stop_request(), stderr);
    rg_interrupt_clock(rg_interrupt_now() + 0.02, INFINITY);
    fputs(stop_request(), stderr);
    nanosleep(&(struct timespec){.tv_nsec = 30000000}, NULL);
    fputs(stop_request(), stderr);
    rg_interrupt_clock(INFINITY, rg_interrupt_now() + 1000);
    fputs(stop_request(), stderr);
}

static void test_clock(void **state) {
    (void)state;
    expect(look_at_the_clock, 0, "");
    expect(wait_for_the_clock, 0, "none none checkpoint checkpoint time-up time-up none time-up none ");
}

static void set_end(double left) {
    char text[32];
    snprintf(text, sizeof text, "%lld", (long long)time(NULL) + (long long)left);
    setenv("SLURM_JOB_END_TIME", text, 1);
}

/* Within the second by which time() is behind. */
static void near(double limit, double expected) {
    if (!(limit > expected - 1.5 && limit < expected + 1.5)) {
        fprintf(stderr, "%g is not %g\n", limit, expected);
    }
}

static void ask_for_limits(void) {
    unsetenv("SLURM_JOB_END_TIME");
    rg_interrupt_listen();
    nanosleep(&(struct timespec){.tv_nsec = 10000000}, NULL);
    fprintf(stderr, "%g %g %g\n", rg_interrupt_limit(0), rg_interrupt_limit(1), rg_interrupt_limit(0.25));
    set_end(100);
    near(rg_interrupt_limit(0), 100);
    near(rg_interrupt_limit(200), 100);
    near(rg_interrupt_limit(50), 50);
    if (rg_interrupt_limit(50) != 50) {
        fputs("not the sooner one", stderr);
    }
    set_end(-100); /* of a job long over, which this is not */
    fprintf(stderr, "%g %g\n", rg_interrupt_limit(0), rg_interrupt_limit(7));
}

static void test_limits(void **state) {
    (void)state;
    expect(ask_for_limits, 0, "inf 1 0.25\ninf 7\n");
}

static void test_times(void **state) {
    (void)state;
    static const struct {
        const char *text;
        double seconds; /* 0: none */
    } known[] = {{"1:30:00", 5400},     {"0:00:01", 1},   {"0:01:00", 60}, {"10:00:00", 36000},
                 {"123:59:59", 446399}, {"1:2:3", 3723},  {"0:00:00", 0},  {"1:60:00", 0},
                 {"1:00:60", 0},        {"-1:00:00", 0},  {"1:-1:00", 0},  {"1:00:-1", 0},
                 {"1:00", 0},           {"", 0},          {"1:00:00x", 0}, {"1:00:00 ", 0},
                 {"1:100:00", 0},       {"1:00:100", 0},  {"a:00:00", 0},  {"1.5:00:00", 0},
                 {"0:59:59", 3599},     {"0:00:59.5", 0}, {"00:00:02", 2}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        double seconds = -1;
        if (rg_interrupt_parse(known[i].text, &seconds) != (known[i].seconds > 0) ||
            (known[i].seconds > 0 && seconds != known[i].seconds)) {
            fail_msg("%s: %g", known[i].text, seconds);
        }
    }
}

/* ---- processors ---- */

static void test_list(void **state) {
    (void)state;
    static const char *const known[][2] = {
        {"1111.....", "0-3"}, {"1.1.11..1", "0,2,4-5,8"}, {".11......", "1-2"}, {".........", ""},
        {"......111", "6-8"}, {"11.......", "0-1"},       {"........1", "8"},   {"111111111", "0-8"}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        bool allowed[10];
        char text[64] = "#";
        for (int k = 0; k < 10; k++) {
            allowed[k] = k < 9 ? known[i][0][k] == '1' : true; /* the last one is beyond the count */
        }
        rg_affinity_list(allowed, 9, text, sizeof text);
        assert_string_equal(text, known[i][1]);
    }
    bool every_other[1000];
    for (int k = 0; k < 1000; k++) {
        every_other[k] = k % 2 == 0;
    }
    char whole[5000], some[100];
    rg_affinity_list(every_other, 1000, whole, sizeof whole);
    rg_affinity_list(every_other, 1000, some, 60);
    assert_true(strlen(some) < 60 && strlen(some) >= 60 - 16);
    assert_memory_equal(some, whole, strlen(some));
    assert_int_equal(whole[strlen(some)], ',');
}

static int threads, cpus; /* cpus: 1 or 2 of those there are */

static void say_processors(void) {
    cpu_set_t all, some;
    sched_getaffinity(0, sizeof all, &all);
    CPU_ZERO(&some);
    for (size_t i = 0; i < CPU_SETSIZE && CPU_COUNT(&some) < cpus; i++) {
        if (CPU_ISSET(i, &all)) {
            CPU_SET(i, &some);
        }
    }
    sched_setaffinity(0, sizeof some, &some);
    omp_set_num_threads(threads);
    rg_affinity_print(MPI_COMM_WORLD, stderr);
}

static void test_processors(void **state) {
    (void)state;
    char host[64] = "", list[64], expected[512];
    cpu_set_t all;
    assert_int_equal(gethostname(host, sizeof host - 1), 0);
    assert_int_equal(sched_getaffinity(0, sizeof all, &all), 0);
    int first = 0;
    while (!CPU_ISSET((size_t)first, &all)) {
        first++;
    }
    for (cpus = 1; cpus <= 2 && cpus <= CPU_COUNT(&all); cpus++) {
        bool allowed[CPU_SETSIZE] = {false};
        for (int i = first, n = 0; n < cpus; i++) {
            allowed[i] = CPU_ISSET((size_t)i, &all);
            n += allowed[i];
        }
        rg_affinity_list(allowed, CPU_SETSIZE, list, sizeof list);
        for (threads = 1; threads <= 3; threads++) {
            int used = snprintf(expected, sizeof expected,
                                "rank 0         %d threads on processors %s of %s\n", threads, list, host);
            if (threads > cpus) {
                snprintf(expected + used, sizeof expected - (size_t)used,
                         "rhegma: warning: rank 0 has %d threads on %d processors: they share (mpirun "
                         "--bind-to none, "
                         "or --map-by slot:PE=%d)\n",
                         threads, cpus, threads);
            }
            expect(say_processors, 0, expected);
        }
    }
}

int main(int argc, char **argv) {
    signal(SIGHUP, SIG_DFL); /* whoever started the tests with nohup */
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_signals), cmocka_unit_test(test_clock), cmocka_unit_test(test_limits),
        cmocka_unit_test(test_times),   cmocka_unit_test(test_list),  cmocka_unit_test(test_processors),
    };
    MPI_Init(&argc, &argv);
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    MPI_Finalize();
    return failed;
}
