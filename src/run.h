/* A run from rest, or from a checkpoint, to the end time: the time loop with its outputs, and what it leaves
 * behind. */
#ifndef RG_RUN_H
#define RG_RUN_H

#include <mpi.h>
#include <stdbool.h>

#include "case/case.h"

typedef struct {
    bool quiet;      /* no progress and summary on the terminal */
    bool restart;    /* go on from the newest good checkpoint in the output directory */
    bool overwrite;  /* start anew even where an unfinished run left checkpoints */
    double walltime; /* stop with a checkpoint before so many seconds have passed; 0: no limit
                        (base/interrupt.h) */
} rg_run_options;

/* Runs the case. Returns the exit status: RG_OK; RG_FAILURE when the run stopped early because its energy,
 * its time step or its state went wrong (a message and autopsy.json say where); RG_INTERRUPTED when it was
 * asked to stop, by a signal or the wall-time limit, and wrote a checkpoint. Collective. */
int rg_run(const rg_case *c, MPI_Comm comm, const rg_run_options *options);

/* Prints what rg_run would do, without running. Collective. */
int rg_run_check(const rg_case *c, MPI_Comm comm);

#endif
