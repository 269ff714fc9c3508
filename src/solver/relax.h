/* The rest into which a body comes by damping, from which a run with `start: relax` begins: of loads,
 * supports and temperature of t = 0, faces not breaking, as of solver/equilibrium.h, but without a system to
 * solve. So the body may be free where its forces balance, and buckle or snap on its way.
 *
 * Dynamic relaxation: central differences in a time of their own,
 *     M (v+ - v-)/dt = forces - c M v, v = (v- + v+)/2,
 * c = 2 omega, critical for the frequency of the last change of the displacement: by Rayleigh's quotient
 * omega^2 = -v-.M(a - a-)/(dt v-.Mv-), 0 where that is negative (M. Papadrakakis 1981, D. R. Oakley and N. F.
 * Knight 1995). Fast motions decay first, so c falls to what the slowest one needs; to stop everything at
 * each peak of the kinetic energy instead never lets that one begin, as fast ones have peaks in every other
 * step. Where the critical step has become shorter all stops and begins anew, and at the end it stops.
 *
 * What damping and stops take away is heat. With the work of the loads on the way it is a part of the ledger
 * from t = 0 on:
 *     stored(t = 0) = stored(initial) + work - heat.
 * For linear solids exactly so: heat is c dt v.Mv of each step and the kinetic energy at a stop, and work is
 * by the trapezoidal rule, which suits both; the difference of dt^2/8 a.Ma at each start from rest and at
 * each stop is counted with the heat. All sums are exact: the same bits on any ranks and threads. */
#ifndef RG_RELAX_H
#define RG_RELAX_H

#include <stdio.h>

#include "solver/equilibrium.h"

/* After rg_solver_start: as rg_equilibrium_find; books what it took in s->relaxed. Collective. */
rg_equilibrium rg_relax(rg_solver *s, FILE *out);

#endif
