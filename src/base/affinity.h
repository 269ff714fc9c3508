/* Which processors the threads may run on: printed with every run, because threads that share a core by
 * accident (Open MPI binds a rank to one core) cost half the speed and are hard to notice. */
#ifndef RG_AFFINITY_H
#define RG_AFFINITY_H

#include <mpi.h>
#include <stdbool.h>
#include <stdio.h>

/* Prints the processors of every rank (rank 0, to `out`) and warns where the threads of a rank, or of all
 * ranks on a host, are more than their processors. Collective. */
void rg_affinity_print(MPI_Comm comm, FILE *out);

/* The numbers below `count` that are allowed, as "0-3,8", in text[0..size); of very many the first ones. */
void rg_affinity_list(const bool *allowed, int count, char *text, size_t size);

#endif
