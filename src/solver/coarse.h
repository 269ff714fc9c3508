/* A coarse space for equilibria: trilinear functions on a grid of cubic cells over the body, for what the
 * mass alone would need very many steps to bring across it.
 *
 * In the elements they are linear between the corners, and so as continuous as the grid's: their stiffness is
 * that of the bulk alone, here of linear elasticity, A = sum over elements V grad N_i : C : grad N_j.
 * Functions that are not 0 where a node is held along their direction are left out. All sums are of integers,
 * of contributions rounded to a common unit: the same bits in any order, on any ranks and threads.
 */
#ifndef RG_COARSE_H
#define RG_COARSE_H

#include "solver/solver.h"

typedef struct rg_coarse rg_coarse;

/* Collective; free with rg_coarse_free. */
rg_coarse *rg_coarse_make(const rg_solver *s);

/* How many functions there are. */
int rg_coarse_size(const rg_coarse *c);

/* field += P A^-1 P^T force, both laid out as the displacement, force on the nodes (N). Collective. */
void rg_coarse_correct(rg_coarse *c, const rg_real *force, rg_real *field);

void rg_coarse_free(rg_coarse *c);

#endif
