/* Properties that differ from face to face: expressions, sets of faces with some of their own, and Weibull's
 * distribution. */
#ifndef RG_STRENGTH_H
#define RG_STRENGTH_H

#include "solver/solver.h"

/* Fills scale, beta and friction (NULL where all faces are alike in these), and stiffest of a
 * model, of a solver whose domain is known. A face's random number comes from the seed and the positions of
 * its corners alone: it is the same on any partition and with any numbering. Ends the run if an expression is
 * not finite. Collective. */
void rg_strength_make(const rg_solver *s, rg_model *m);

#endif
