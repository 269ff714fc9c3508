#include "verify.h"

#include <omp.h>
#include <stdio.h>

#include "error.h"
#include "kernels.h"
#include "revision.h"
#include "verify_check.h"

enum { MOST_RANKS = 32 }; /* a rank needs a tile, and the smallest mesh has 48 */

static rg_verify_check *const check[] = {
    rg_verify_pressure_wave, rg_verify_shear_wave, rg_verify_patch,      rg_verify_rotation,
    rg_verify_energy,        rg_verify_spall,      rg_verify_separation, rg_verify_identity,
};

/* Prints the rows of check i and counts the failed ones. Ranks other than 0 have the same rows and are
 * silent. */
static int run(size_t i, MPI_Comm comm, int rank) {
    static const rg_verify_change none = {0, NULL};
    rg_verify_rows rows = {0};
    int failed = 0;
    check[i](comm, &none, &rows);
    for (int k = 0; k < rows.rows; k++) {
        failed += !rg_verify_holds(&rows.row[k]);
        if (rank == 0) {
            rg_verify_print(&rows.row[k], stdout);
        }
    }
    return failed;
}

static int run_all(MPI_Comm comm, int rank) {
    int ranks, failed = 0;
    MPI_Comm_size(comm, &ranks);
    const rg_kernels *kernels = rg_kernels_select();
    if (rank == 0) {
        printf("rhegma %s, %s precision, %s, %d ranks x %d threads\n", RG_REVISION, RG_PRECISION,
               kernels != NULL ? kernels->name : "unknown instruction set", ranks, omp_get_max_threads());
        rg_verify_print_head(stdout);
    }
    double begin = MPI_Wtime();
    for (size_t i = 0; i < sizeof check / sizeof *check; i++) {
        failed += run(i, comm, rank);
    }
    if (rank == 0) {
        printf("%s, in %.0f s\n", failed == 0 ? "all checks hold" : "FAILED", MPI_Wtime() - begin);
    }
    return failed;
}

int rg_verify(MPI_Comm comm) {
    int rank, failed = 0;
    MPI_Comm some;
    MPI_Comm_rank(comm, &rank);
    MPI_Comm_split(comm, rank < MOST_RANKS ? 0 : MPI_UNDEFINED, rank, &some);
    if (some != MPI_COMM_NULL) {
        failed = run_all(some, rank);
        MPI_Comm_free(&some);
    }
    MPI_Bcast(&failed, 1, MPI_INT, 0, comm);
    return failed == 0 ? RG_OK : RG_FAILURE;
}
