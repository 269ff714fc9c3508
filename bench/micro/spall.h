/* The spall test as the bench runs it: a jittered box between two moving ends, fracture test on. */
#ifndef RG_BENCH_SPALL_H
#define RG_BENCH_SPALL_H

#include "case/read.h"
#include "solver/solver.h"

/* The case on cells[0] x cells[1] x cells[2] cubes in tiles of `tile` elements, with interface.form `form`.
 * Free with rg_case_free. */
rg_case *bench_spall_case(const int cells[3], int tile, const char *form);

/* Back to the start: random small motion, `percent` of the faces broken, forces by the kernels `set`.
 * Collective. */
void bench_spall_reset(rg_solver *s, const rg_kernels *set, int percent);

/* `calls` steps of the solver `context`, well below the critical one. Collective. */
void bench_spall_steps(void *context, int calls);

#endif
