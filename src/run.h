/* A run from rest to the end time: the time loop with its outputs, and what it leaves behind. */
#ifndef RG_RUN_H
#define RG_RUN_H

#include <mpi.h>
#include <stdbool.h>

#include "case.h"

/* Runs the case. Returns the exit status: RG_OK, or RG_FAILURE when the run stopped early because its energy
 * or its state went wrong (a message says where). `quiet` leaves out progress and summary on the terminal.
 * Collective. */
int rg_run(const rg_case *c, MPI_Comm comm, bool quiet);

/* Prints what rg_run would do, without running. Collective. */
int rg_check(const rg_case *c, MPI_Comm comm);

#endif
