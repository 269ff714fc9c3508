/* A run of two ranks that distributes its tiles anew on the way: the same rows, one more partition, and what
 * the run hands to the question whether that pays. What is left to a restart of it is said once. Prints TAP
 * from rank 0. */
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/error.h"
#include "case/read.h"
#include "run.h"
#include "solver/balance.h"
#include "support/tap_memory.h"

static const char text[] = "mesh: {cells: [2, 2, 4], size: [1e-3, 1e-3, 2e-3], rebalance: 1.1}\n"
                           "material: {model: neo-hookean, young: 260e9, poisson: 0.21, density: 3690}\n"
                           "interface: {law: linear, strength: 4e9, energy: 3400}\n"
                           "initial: {velocity: {z: 20*z/2e-3}}\n"
                           "time: {end: 1, steps: 8}\n"
                           "checkpoint: {steps: 1000}\n"
                           "output: {dir: out, interval: 2, fields: [velocity]}\n";

static char directory[] = "/tmp/test_rebalance.XXXXXX";

/* ---- the question, in the place of the answer ---- */

static int64_t deal_at; /* step; -1: never */
static int64_t looked;  /* step from which on the balance is measured */
static bool asked_well;
static double first_cost, dearest; /* of what is asked of (s) */

bool __wrap_rg_balance_pays(rg_balance *b, rg_solver *s, double cost, double left);
bool __wrap_rg_balance_pays(rg_balance *b, rg_solver *s, double cost, double left) {
    asked_well = asked_well && cost > 0 && cost < 30 && left >= 0 && s->exchange_seconds > 0 &&
                 s->exchange_seconds < 1 && s->tile_seconds != NULL && b->step == looked;
    first_cost = dearest > 0 ? first_cost : cost;
    dearest = fmax(dearest, cost);
    b->now = 1.25;
    if (s->step != deal_at) {
        return false;
    }
    deal_at = -1;
    looked = s->step;
    return true;
}

/* ---- a run ---- */

static char printed[16384], said[4096];

static void read_all(const char *path, char *to, size_t size) {
    FILE *f = fopen(path, "r");
    to[f == NULL ? 0 : fread(to, 1, size - 1, f)] = '\0';
    if (f != NULL) {
        fclose(f);
    }
}

/* What rank 0 prints goes to `printed`; what all say, to `said`. */
static int go(bool restart, int64_t distribution) {
    const rg_run_options options = {.restart = restart, .overwrite = true};
    int out = dup(STDOUT_FILENO), err = dup(STDERR_FILENO);
    int to_out = open(rank == 0 ? "stdout" : "/dev/null", O_WRONLY | O_CREAT | O_TRUNC, 0666);
    int to_err = open("stderr", O_WRONLY | O_CREAT | O_APPEND, 0666);
    fflush(stdout);
    dup2(to_out, STDOUT_FILENO);
    dup2(to_err, STDERR_FILENO);
    deal_at = distribution;
    looked = 0;
    asked_well = true;
    dearest = 0;
    rg_case *c = rg_case_read_text("bar.yaml", text, strlen(text), 0, NULL, stderr);
    int status = rg_run(c, MPI_COMM_WORLD, &options);
    rg_case_free(c);
    fflush(stdout);
    fflush(stderr);
    dup2(out, STDOUT_FILENO);
    dup2(err, STDERR_FILENO);
    close(out);
    close(err);
    close(to_out);
    close(to_err);
    MPI_Barrier(MPI_COMM_WORLD);
    read_all("stdout", printed, sizeof printed);
    read_all("stderr", said, sizeof said);
    MPI_Barrier(MPI_COMM_WORLD);
    if (rank == 0) {
        remove("stderr");
    }
    MPI_Barrier(MPI_COMM_WORLD);
    return status;
}

static double summary(const char *key) {
    static char all[16384];
    char word[64];
    snprintf(word, sizeof word, "\"%s\": ", key);
    read_all("out/summary.json", all, sizeof all);
    const char *at = strstr(all, word);
    return at == NULL ? NAN : strtod(at + strlen(word), NULL);
}

static int count(const char *in, const char *what) {
    int n = 0;
    for (; (in = strstr(in, what)) != NULL; in++) {
        n++;
    }
    return n;
}

int main(int argc, char **argv) {
    static char rows[2][16384];
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    if (rank == 0 && mkdtemp(directory) == NULL) {
        MPI_Abort(MPI_COMM_WORLD, 1);
    }
    MPI_Bcast(directory, sizeof directory, MPI_CHAR, 0, MPI_COMM_WORLD);
    if (chdir(directory) != 0) {
        MPI_Abort(MPI_COMM_WORLD, 1);
    }
    bool good = go(false, -1) == RG_OK && summary("partitions") == 1 && summary("checkpoints") == 1;
    read_all("out/energy.csv", rows[0], sizeof rows[0]);
    good = good && (rank > 0 || first_cost >= summary("setup_s")); /* and a checkpoint, of a guessed speed */
    report(good && asked_well && count(rows[0], "\n") == 6, "on one partition", "takes its steps");

    double begin = MPI_Wtime();
    good = go(false, 3) == RG_OK && summary("partitions") == 2 && summary("checkpoints") == 2;
    double elapsed = MPI_Wtime() - begin;
    read_all("out/energy.csv", rows[1], sizeof rows[1]);
    report(good && asked_well && summary("steps") == 8 && strcmp(rows[0], rows[1]) == 0, "repartitioned",
           "goes on to the same rows");
    /* a checkpoint of 96 elements costs next to nothing */
    report(rank > 0 || (summary("setup_s") > first_cost && summary("setup_s") + summary("wall_s") < elapsed &&
                        dearest < elapsed),
           "repartitioned", "takes its time once");
    double most = 0, seconds = -1;
    const char *words =
        strstr(printed, "step 3: the ranks' work was uneven (most 1.25 of the mean), the mesh is "
                        "repartitioned (by cost, most ");
    good = words != NULL && sscanf(strstr(words, "by cost, most "), "by cost, most %lf of the mean) in %lf s",
                                   &most, &seconds) == 2;
    report(good && most >= 1 && most < 2 && seconds >= 0 && seconds < elapsed, "repartitioned", "says so");

    good = go(true, -1) == RG_OK && count(said, "warning: nothing is left to compute") == 1 &&
           count(printed, "goes on") == 0;
    report(good, "restarted at its end", "says once that nothing is left");
    MPI_Barrier(MPI_COMM_WORLD);
    char clear[64];
    snprintf(clear, sizeof clear, "rm -rf %s", directory);
    if (chdir("/") != 0 || (rank == 0 && system(clear) != 0)) {
        MPI_Abort(MPI_COMM_WORLD, 1);
    }
    return finish_with_nothing_left();
}
