/* The largest frequency of the linear operator, from which the critical time step 2/omega follows. */
#ifndef RG_SPECTRUM_H
#define RG_SPECTRUM_H

#include "solver/solver.h"

/* Stiffening up to this costs no time step: the margin and any sensible safety cover it. */
#define RG_STIFFENING_FREE 1.05

/* Fills omega2, damping, limiting and limiting_state of a solver at rest.
 * Rank 0 applies rg_spectrum_whole to the patch alone: the vector of the largest frequency
 * decays within a few elements, so that a patch around the worst elements has it too. The patch's frequency
 * is a lower bound of the whole mesh's, below it by less than the margin (figures in solver/spectrum.c). In
 * form continuous the worst vector sits where few elements share the mass of a node, at edges and corners of
 * the body, which no patch can know before the nodes are joined: it takes the whole mesh, some 100 passes.
 * The result has the same bits on any ranks and threads. Collective. */
void rg_spectrum(rg_solver *s);

/* The same from the solver's whole mesh.
 *
 * The operator is M^-1 times the derivative of the forces at rest, applied by the production kernels to a
 * tiny displacement; so it holds for every form, mass and penalty. Its largest eigenvalue is found by the
 * Lanczos iteration in the inner product of M (the incomplete form, not symmetric, by power iteration). The
 * states tried are those a face can take: all faces intact; all broken and closed (contact on both sides of
 * zero, hence linear). A point that just broke unloads along a much steeper line (its opening is still tiny),
 * which no step of use could follow: that is what time.safety is for (output/estimate.c bounds it for the
 * conserving activation). Sums are exact, so the result has the same bits on any ranks and threads.
 * Collective. */
void rg_spectrum_whole(rg_solver *s);

#endif
