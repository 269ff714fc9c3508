/* The equilibrium from which a run with `start: static` begins: u with M^-1 (internal forces + loads of t =
 * 0) = 0 but along held lines, faces not breaking.
 *
 * Newton's method on the residual, its linear systems by conjugate gradients in the inner product of the
 * mass, with tangents from differences of the internal forces (loads that follow the surface are held fixed
 * in them), preconditioned by the mass over the highest squared frequency and a coarse space
 * (solver/coarse.h). All sums are exact or of integers: the same bits on any ranks and threads. The cost is
 * one pass over all forces an iteration.
 *
 * In form intrinsic the laws of the faces answer along their first curves, which have a potential up to the
 * top of each (solver/statics.h).
 *
 * What is tied to a free rigid body moves as that does, six unknowns in place of its nodes': residuals and
 * what the coarse space brings are projected on such motions in the inner product of the mass, and a step
 * moves and turns the body, forces of contact on it among those that balance. A free body that carries
 * nothing stays where it is, so nothing may press it. */
#ifndef RG_EQUILIBRIUM_H
#define RG_EQUILIBRIUM_H

#include <stdio.h>

#include "solver/solver.h"

typedef struct {
    double residual; /* over the loads and reactions, in the norm of M^-1 */
    int64_t passes;
} rg_equilibrium;

/* After rg_solver_start: moves the displacement into equilibrium and tells `out` (NULL: nobody) of it. Ends
 * the run with a message where the body is not held or no equilibrium is found. Collective. */
rg_equilibrium rg_equilibrium_find(rg_solver *s, FILE *out);

/* Of a body with an initial stress: how much of it nothing balances at the start, loads and supports
 * included, over its forces on loose elements (solver/initial.h): tells `out` (NULL: nobody) and returns it.
 * Collective. */
double rg_equilibrium_of_stress(rg_solver *s, FILE *out);

#endif
