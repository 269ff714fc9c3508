/* The rest into which a body comes by damping, from which a run with `start: relax` begins: of loads,
 * supports and temperature of t = 0, faces not breaking, as of solver/equilibrium.h, but without a system to
 * solve. So the body may be free where its forces balance, and buckle or snap on its way.
 *
 * Kinetic damping (A. S. Day 1965, P. A. Cundall 1976): central differences in a time of their own, and
 * whenever the kinetic energy has passed a peak all velocities become 0. What they take away is heat. With
 * the work of the loads on the way it is a part of the ledger from t = 0 on:
 *     stored(t = 0) = stored(initial) + work - heat.
 * For linear solids exactly so: heat is the kinetic energy at whole steps, each peak ends and the next swing
 * begins as a step from rest, and work is by the trapezoidal rule, which suits both; the difference of the
 * two ends' dt^2/8 a.Ma is counted with the heat. All sums are exact: the same bits on any ranks and threads.
 */
#ifndef RG_RELAX_H
#define RG_RELAX_H

#include <stdio.h>

#include "solver/equilibrium.h"

/* After rg_solver_start: as rg_equilibrium_find; books what it took in s->relaxed. Collective. */
rg_equilibrium rg_relax(rg_solver *s, FILE *out);

#endif
