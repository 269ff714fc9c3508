/* A slow network for any MPI program with persistent requests: loaded in front of the MPI library
 * (LD_PRELOAD), it lets what MPI_Startall starts complete a delay later at the earliest. Tests before that
 * say no, waits last until then. The program needs no hook and does not know. Environment:
 *     RHEGMA_DELAY_US      delays in microseconds, taken in turn: 0,500,1000
 *     RHEGMA_DELAY_STARTS  calls of MPI_Startall after which it is the next one's turn
 *     RHEGMA_DELAY_LOG     file in which rank 0 leaves "delay seconds" of every turn, both in seconds
 *     RHEGMA_NO_POLL=1     all tests say no, at no cost: what happens then, the library does by itself or in
 *                          the wait */
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>

enum { MOST_SETS = 64, MOST_DELAYS = 64, MOST_TURNS = 100000 };

/* Sets of requests that were started together, found again by where the program keeps them. */
static struct {
    const MPI_Request *requests;
    double ready; /* by MPI_Wtime */
} sets[MOST_SETS];
static int known;

static double delay[MOST_DELAYS], turn_start[MOST_TURNS];
static int delays, turns, starts, starts_per_turn, deaf;

static void read_environment(void) {
    const char *text = getenv("RHEGMA_DELAY_US"), *every = getenv("RHEGMA_DELAY_STARTS");
    const char *poll = getenv("RHEGMA_NO_POLL");
    for (; text != NULL && *text != '\0' && delays < MOST_DELAYS; text += *text == ',') {
        char *end;
        delay[delays++] = 1e-6 * strtod(text, &end);
        text = end > text ? end : text + 1;
    }
    delays = delays > 0 ? delays : 1;
    starts_per_turn = every != NULL && atoi(every) > 0 ? atoi(every) : 1;
    deaf = poll != NULL && *poll == '1';
}

static double *ready_time(const MPI_Request *requests) {
    int k = 0;
    while (k < known && sets[k].requests != requests) {
        k++;
    }
    if (k == MOST_SETS) {
        fprintf(stderr, "mpi_delay: more than %d sets of requests\n", MOST_SETS);
        MPI_Abort(MPI_COMM_WORLD, 1);
    }
    known = k == known ? k + 1 : known;
    sets[k].requests = requests;
    return &sets[k].ready;
}

/* Ranks have the same turns as long as they start equally often. */
static double current_delay(double now) {
    if (delays == 0) {
        read_environment();
    }
    if (starts++ % starts_per_turn == 0 && turns < MOST_TURNS) {
        turn_start[turns++] = now;
    }
    return delay[(turns - 1) % delays];
}

int MPI_Startall(int count, MPI_Request requests[]) {
    if (count == 0) { /* a rank on its own, in the set-up: it would be ahead of the others' turns */
        return PMPI_Startall(count, requests);
    }
    double now = PMPI_Wtime();
    *ready_time(requests) = now + current_delay(now);
    return PMPI_Startall(count, requests);
}

int MPI_Testall(int count, MPI_Request requests[], int *flag, MPI_Status statuses[]) {
    if (deaf) {
        *flag = 0;
        return MPI_SUCCESS;
    }
    if (PMPI_Wtime() >= *ready_time(requests)) {
        return PMPI_Testall(count, requests, flag, statuses);
    }
    int any; /* as a test would, this lets the library work */
    *flag = 0;
    return PMPI_Iprobe(MPI_ANY_SOURCE, 0, MPI_COMM_SELF, &any, MPI_STATUS_IGNORE);
}

int MPI_Waitall(int count, MPI_Request requests[], MPI_Status statuses[]) {
    double ready = *ready_time(requests);
    while (PMPI_Wtime() < ready) {
    }
    return PMPI_Waitall(count, requests, statuses);
}

int MPI_Finalize(void) {
    const char *path = getenv("RHEGMA_DELAY_LOG");
    int rank;
    PMPI_Comm_rank(MPI_COMM_WORLD, &rank);
    FILE *out = rank == 0 && path != NULL ? fopen(path, "w") : NULL;
    for (int t = 0; out != NULL && t + 1 < turns; t++) {
        fprintf(out, "%.9g %.9g\n", delay[t % delays], turn_start[t + 1] - turn_start[t]);
    }
    if (out != NULL) {
        fclose(out);
    }
    return PMPI_Finalize();
}
