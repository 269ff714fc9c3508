/* The check of rhegma verify that results have the same bits on any ranks and threads. */
#include <math.h>
#include <omp.h>
#include <string.h>

#include "base/hash.h"
#include "base/vector.h"
#include "diagnostics/state_hash.h"
#include "verify/check.h"

#ifdef RG_SINGLE
static const double momentum_limit = 1e-6;
#else
static const double momentum_limit = 1e-12;
#endif

/* A free bar that flies, spins and tears itself apart. */
static const char text[] = "mesh:\n"
                           "  cells: [2, 2, 16]\n"
                           "  size: [0.4e-3, 0.4e-3, 3.2e-3]\n"
                           "  origin: [-0.2e-3, -0.2e-3, -1.6e-3]\n"
                           "  jitter: 0.1\n"
                           "material: {model: neo-hookean, young: 260e9, poisson: 0.21, density: 3690}\n"
                           "interface: {law: linear, strength: 400e6, energy: 34}\n"
                           "initial:\n"
                           "  velocity:\n"
                           "    x: 5 - 1e4*z + 2e4*y\n"
                           "    y: -3 - 2e4*x\n"
                           "    z: 2 + 1e4*x + 40*sin(pi*z/3.2e-3)\n"
                           "time: {end: 0.6e-6}\n"
                           "output: {energy_limit: 1}\n";

typedef struct {
    uint64_t hash;   /* of state and ledger at the end */
    double momentum; /* change */
} outcome;

static outcome fly(MPI_Comm comm, int threads, const rg_verify_change *change) {
    int before = omp_get_max_threads();
    omp_set_num_threads(threads);
    rg_trial *t = rg_trial_begin(text, change, comm);
    double start[3] = {0, 0, 0};
    while (rg_trial_next(t)) {
        if (t->states == 1) {
            memcpy(start, rg_trial_ledger(t)->momentum, sizeof start);
        }
    }
    const rg_energy *e = rg_trial_ledger(t);
    outcome o = {rg_hash(rg_state_hash(t->solver), rg_energy_hash(e)),
                 e->broken_area > 0 ? rg_verify_change_of(start, e->momentum) : NAN};
    rg_trial_end(t);
    omp_set_num_threads(before);
    return o;
}

/* One rank with one thread, known to all. */
static outcome fly_alone(MPI_Comm comm, const rg_verify_change *change) {
    outcome alone = {0, 0};
    int rank;
    MPI_Comm_rank(comm, &rank);
    if (rank == 0) {
        alone = fly(MPI_COMM_SELF, 1, change);
    }
    MPI_Bcast(&alone, sizeof alone, MPI_BYTE, 0, comm);
    return alone;
}

double rg_verify_change_of(const double from[3], const double to[3]) {
    double change[3];
    rg_vector_subtract(to, from, change);
    return sqrt(rg_vector_dot(change, change) / rg_vector_dot(from, from));
}

void rg_verify_identity(MPI_Comm comm, const rg_verify_change *change, rg_verify_rows *rows) {
    static const char *const name[] = {"same bits on all ranks, 1 thread each",
                                       "same bits on all ranks, 2 threads each",
                                       "same bits on all ranks, 3 threads each"};
    static const rg_verify_change none = {0, NULL};
    outcome alone = fly_alone(comm, &none);
    rg_verify_value(rows, "momentum of fragments, change", 0, alone.momentum, momentum_limit);
    for (int threads = 1; threads <= 3; threads++) {
        rg_verify_hash(rows, name[threads - 1], alone.hash, fly(comm, threads, change).hash);
    }
}
