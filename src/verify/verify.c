#include "verify/verify.h"

#include <omp.h>
#include <stdio.h>

#include "base/error.h"
#include "kernels.h"
#include "revision.h"
#include "verify/check.h"

enum { MOST_RANKS = 32 }; /* a rank needs a tile, and the smallest mesh has 48 */

/* Prints the rows of a check; whether all hold. Ranks other than 0 have the same rows and are silent. */
static bool run(rg_verify_check *check, MPI_Comm comm, int rank, FILE *out) {
    static const rg_verify_change none = {0, NULL};
    rg_verify_rows rows = {0};
    bool good = true;
    check(comm, &none, &rows);
    for (int k = 0; k < rows.rows; k++) {
        good = rg_verify_holds(&rows.row[k]) && good;
        if (rank == 0) {
            rg_verify_print(&rows.row[k], out);
        }
    }
    return good;
}

static bool run_all(rg_verify_check *const *check, size_t checks, MPI_Comm comm, int rank, FILE *out) {
    int ranks;
    bool good = true;
    MPI_Comm_size(comm, &ranks);
    const rg_kernels *kernels = rg_kernels_select();
    if (rank == 0) {
        fprintf(out, "rhegma %s, %s precision, %s, %d ranks x %d threads\n", RG_REVISION, RG_PRECISION,
                kernels != NULL ? kernels->name : "unknown instruction set", ranks, omp_get_max_threads());
        rg_verify_print_head(out);
    }
    double begin = MPI_Wtime();
    for (size_t i = 0; i < checks; i++) {
        good = run(check[i], comm, rank, out) && good;
    }
    if (rank == 0) {
        fprintf(out, "%s, in %.0f s\n", good ? "all checks hold" : "FAILED", MPI_Wtime() - begin);
    }
    return good;
}

int rg_verify_run(rg_verify_check *const *check, size_t checks, int most_ranks, MPI_Comm comm, FILE *out) {
    int rank, good = 1;
    MPI_Comm some;
    MPI_Comm_rank(comm, &rank);
    MPI_Comm_split(comm, rank < most_ranks ? 0 : MPI_UNDEFINED, rank, &some);
    if (some != MPI_COMM_NULL) {
        good = run_all(check, checks, some, rank, out);
        MPI_Comm_free(&some);
    }
    MPI_Bcast(&good, 1, MPI_INT, 0, comm);
    return good ? RG_OK : RG_FAILURE;
}

int rg_verify(MPI_Comm comm) {
    static rg_verify_check *const check[] = {
        rg_verify_pressure_wave, rg_verify_shear_wave, rg_verify_patch,      rg_verify_rotation,
        rg_verify_energy,        rg_verify_spall,      rg_verify_separation, rg_verify_identity,
    };
    return rg_verify_run(check, sizeof check / sizeof *check, MOST_RANKS, comm, stdout);
}
