/* The passes over the fields: start, kick, drift. */
#ifndef RG_STEP_H
#define RG_STEP_H

#include "solver/solver.h"

/* Initial displacement and velocity, constraints, stiffening at t = 0. Collective. */
void rg_solver_start(rg_solver *s);

/* Measures a pass anew, the best of a few: the first one waits for memory that nobody has read yet. The state
 * at the start stays. Collective. */
void rg_solver_measure(rg_solver *s);

/* In its place where the state comes from a checkpoint (solver/state.h): makes what follows from that.
 * Collective.
 */
void rg_solver_resume(rg_solver *s);

/* Forces of the current displacement; velocities go on to the middle of a step `dt`, and `step_velocity`
 * becomes the velocity at the current time everywhere, with the constraints. Collective. */
void rg_solver_kick(rg_solver *s, double dt);

/* The rest of the step. Collective. */
void rg_solver_drift(rg_solver *s);

/* Kick and drift at once, tile by tile; `step_velocity` is only known to the watcher. Collective. Allocates
 * nothing. */
void rg_solver_step(rg_solver *s, double dt);

/* velocity += dt M^-1 (all forces of u), without constraints. The history stays. For
 * the spectrum. Collective. */
void rg_solver_impulse(rg_solver *s, rg_real *velocity, double dt);

/* M^-1 (all forces of u) of faces that cannot break yet, with bodies where they are, with the loads of t = 0
 * or those of foundations alone, and no constraints: for equilibria. The state stays, but for that of cracks
 * in form intrinsic, whose laws have their first slopes up to `stretch` times larger openings. Collective. */
void rg_solver_acceleration(rg_solver *s, rg_real *acceleration, bool loaded, double stretch);

/* M^-1 (loads of t = 0 at the present displacement) but for foundations, of elements that do not know that
 * they share nodes. */
void rg_solver_loads(rg_solver *s, rg_real *acceleration);

/* The histories go on by a step to the present displacement, for which the materials of the stepper are
 * ready, and nothing else does. Collective. */
void rg_solver_flow(rg_solver *s);

/* The displacement of the start has changed: constraints and stiffening follow. Collective. */
void rg_solver_settle(rg_solver *s);

/* The messages of a step: traces, tractions and, where nodes are shared, their sums. How many kinds. */
int rg_solver_halos(const rg_solver *s, rg_halo *halo[3]);

/* Both exchanges of a step with nothing to hide them, as a measurement: the rows are not of one state.
 * Collective. */
void rg_solver_exchange(rg_solver *s);

#endif
