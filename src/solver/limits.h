/* Whether a solid that flows is within its limits before the clock starts. */
#ifndef RG_LIMITS_H
#define RG_LIMITS_H

#include "solver/solver.h"

/* Ends the run with a message where a step that is as slow as a load at rest would make a solid flow at the
 * present displacement: the state would then depend on the way there. `what` begins the message, as "start:
 * static". Not of the ceramic of Deshpande and Evans, which flows and cracks in time alone, nor of users'
 * materials. The state stays. Collective. */
void rg_limits_refuse(rg_solver *s, const char *what);

/* In form intrinsic, where a point of a face has opened beyond the top of its law: less than the load could
 * have opened it on the way. Open faces do not count. Collective. */
void rg_limits_refuse_openings(const rg_solver *s, const char *what);

#endif
