/* A place where an expression of the case is not what it must be: the same on any number of ranks. */
#ifndef RG_FIRST_BAD_H
#define RG_FIRST_BAD_H

#include <mpi.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct {
    int64_t which; /* of several expressions, by a number of the caller's; RG_NOWHERE: none */
    double x[3];   /* m */
    double value;  /* what was found there, or when (s) */
} rg_first_bad;

#define RG_NOWHERE INT64_MAX

/* Takes the place for p if it is lower: by `which`, then by x. One thread at a time. */
void rg_first_bad_note(rg_first_bad *p, int64_t which, const double x[3], double value);

/* Collective: *p becomes the lowest of all ranks. Returns whether there is any. */
bool rg_first_bad_lowest(rg_first_bad *p, MPI_Comm comm);

/* Collective, for what all ranks know: returns on rank 0, which ends the run with a message; the others wait
 * for that. */
void rg_speak(MPI_Comm comm);

#endif
