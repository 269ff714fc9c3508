/* Strengths that differ from face to face: sets of faces with properties of their own, and Weibull's
 * distribution. */
#ifndef RG_STRENGTH_H
#define RG_STRENGTH_H

#include "solver/solver.h"

/* Fills s->scale (NULL where all faces are alike) and s->stiffest. A face's random number comes from the seed
 * and the positions of its corners alone: it is the same on any partition and with any numbering. Ends the
 * run if an expression is not finite. Collective. */
void rg_strength_make(rg_solver *s);

#endif
