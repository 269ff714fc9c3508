#include "base/interrupt.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

/* Signal handlers and what they set cannot be anywhere else. */
static volatile sig_atomic_t wants_checkpoint, wants_stop;
static struct timespec started;
static double stop_at = INFINITY, checkpoint_at = INFINITY;

static void on_signal(int number) {
    if (number == SIGUSR1) {
        wants_checkpoint = 1;
    } else {
        wants_stop = 1;
    }
}

static void handle(int number, int flags) {
    struct sigaction action = {.sa_handler = on_signal, .sa_flags = flags};
    sigemptyset(&action.sa_mask);
    sigaction(number, &action, NULL);
}

void rg_interrupt_listen(void) {
    clock_gettime(CLOCK_MONOTONIC, &started);
    handle(SIGUSR1, SA_RESTART);
    handle(SIGUSR2, SA_RESTART);
    handle(SIGTERM, SA_RESTART | (int)SA_RESETHAND);
    handle(SIGINT, SA_RESTART | (int)SA_RESETHAND);
    if (signal(SIGHUP, SIG_IGN) != SIG_IGN) { /* nohup stays in force */
        handle(SIGHUP, SA_RESTART);           /* the terminal and the shell may both send one */
    }
    signal(SIGXFSZ, SIG_IGN);
    signal(SIGPIPE, SIG_IGN);
}

void rg_interrupt_deafen(void) {
    const int number[] = {SIGUSR1, SIGUSR2, SIGTERM, SIGINT, SIGPIPE};
    for (size_t i = 0; i < sizeof number / sizeof *number; i++) {
        signal(number[i], SIG_DFL);
    }
    if (signal(SIGHUP, SIG_DFL) == SIG_IGN) {
        signal(SIGHUP, SIG_IGN);
    }
}

double rg_interrupt_now(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)(now.tv_sec - started.tv_sec) + 1e-9 * (double)(now.tv_nsec - started.tv_nsec);
}

double rg_interrupt_limit(double walltime) {
    double limit = walltime > 0 ? walltime : INFINITY;
    const char *end = getenv("SLURM_JOB_END_TIME");
    if (end != NULL) {
        double left = difftime((time_t)strtoll(end, NULL, 10), time(NULL));
        limit = left > 0 ? fmin(limit, rg_interrupt_now() + left) : limit;
    }
    return limit;
}

void rg_interrupt_clock(double stop, double next) {
    stop_at = stop;
    checkpoint_at = next;
}

int rg_interrupt_request(void) {
    double now = isfinite(stop_at) || isfinite(checkpoint_at) ? rg_interrupt_now() : 0;
    if (now >= stop_at) {
        return RG_REQUEST_TIME_UP;
    }
    if (wants_stop) {
        return RG_REQUEST_STOP;
    }
    return wants_checkpoint || now >= checkpoint_at ? RG_REQUEST_CHECKPOINT : RG_REQUEST_NONE;
}

void rg_interrupt_answered(void) {
    wants_checkpoint = 0;
}

bool rg_interrupt_parse(const char *text, double *seconds) {
    long hours, minutes, s;
    char rest;
    if (sscanf(text, "%ld:%2ld:%2ld%c", &hours, &minutes, &s, &rest) != 3 || hours < 0 || minutes < 0 ||
        minutes > 59 || s < 0 || s > 59) {
        return false;
    }
    *seconds = 3600.0 * (double)hours + 60.0 * (double)minutes + (double)s;
    return *seconds > 0;
}
