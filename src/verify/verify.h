/* rhegma verify: closed-form checks of the program on the machine it runs on. */
#ifndef RG_VERIFY_H
#define RG_VERIFY_H

#include <mpi.h>

/* Runs all checks on the ranks of `comm`, at most 32 of them (the meshes are small), and the threads of each,
 * and prints a table as it goes. Writes no files. Returns RG_OK, or RG_FAILURE if a check failed.
 * Collective. */
int rg_verify(MPI_Comm comm);

#endif
