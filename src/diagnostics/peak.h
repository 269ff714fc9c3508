/* The face at which a quantity is largest, over all ranks: where, and how much. */
#ifndef RG_PEAK_H
#define RG_PEAK_H

#include <mpi.h>
#include <stdint.h>

typedef struct {
    double value; /* the largest by its size, with its sign; 0: of none */
    int64_t face; /* 4 times the element on one side + its local face; of the same size the lowest counts */
    double place[3]; /* middle of the face (m) */
} rg_peak;

/* Of two of them the larger one. */
rg_peak rg_peak_of(const rg_peak *a, const rg_peak *b);

/* The largest one over all ranks, the same bits on any of them. Collective. */
rg_peak rg_peak_reduce(const rg_peak *mine, MPI_Comm comm);

#endif
