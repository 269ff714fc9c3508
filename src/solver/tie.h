/* Sets of faces that are tied to rigid bodies: their nodes move and turn with them.
 *
 * Where a body is after a step, R' its attitude and x' its centre, there the nodes are, x' + R' a; so their
 * velocity in the middle of the step is the chord v + (R' - R) a/dt. An element's nodes c that are tied take
 * the impulses (Minv_cc)^-1 (chord - v*) from the body, v* what the other forces alone make of them, at the
 * places x + R a. What all of them take is linear in v and R', with coefficients that the body knows from the
 * start, but for sums over v*: six numbers a body and step, exact, so that all ranks move it alike. Both
 * momenta of body and solid together stay to rounding, and the critical step is what it was: what is held
 * vibrates no faster. Nodes that are let go (tied_until) keep their velocities, and so does the body.
 *
 * Nodes that are tied from a time on (tied_from) are so where they and the body then are. In that kick they
 * and the body take impulses between them that give them the motion of one rigid body: momenta stay, and what
 * the kinetic energy falls by is taken from the ledger, as `joined`: with v the velocities at that time and P
 * v those after it, in the inner product of the masses P is a projection, so it is (v.v - Pv.Pv)/2 >= 0. */
#ifndef RG_TIE_H
#define RG_TIE_H

#include <mpi.h>

#include "domain/assembly.h"
#include "solver/body.h"
#include "solver/constraint.h"
#include "solver/state.h"

typedef struct rg_ties rg_ties;

/* Those of the bodies of a case. `nodes` as in rg_constraints_make. Tells the bodies what they carry. Ends
 * the run with a message where an element has nodes that are tied to two bodies, or prescribed too. Keeps
 * references to `c`, `d` and `bodies`. Collective; free with rg_ties_free. */
rg_ties *rg_ties_make(const rg_case *c, const rg_domain *d, const rg_part *part, const rg_material *m,
                      rg_assembly *nodes, rg_bodies *bodies, const rg_constraints *constraints, int threads,
                      MPI_Comm comm);

/* Whether any is. On all ranks the same. */
bool rg_ties_any(const rg_ties *t);

/* Puts the nodes where the bodies are, with their velocities at the start unless `velocity` is NULL. */
void rg_ties_start(const rg_ties *t, rg_real *u, rg_real *velocity);

/* For equilibria at t = 0, of fields of velocities or accelerations: the motions [bodies][6] of rigid bodies,
 * velocity and spin about their centres, that are nearest to what the nodes tied to free bodies have, in the
 * norm of the mass, plus what `impulse` [bodies][6] on a body (and its moment; NULL: none) gives them. A body
 * has no mass of its own in this, as what is at rest needs none; a prescribed one has no motion. Collective.
 */
void rg_ties_motions(rg_ties *t, const rg_real *field, const double (*impulse)[6], double (*motion)[6]);

/* What the moments about the centres of free bodies fall by, by a turn of these and of the nodes tied to
 * them, as the forces on those keep their direction: with T = sum of a f, a from the centre and f by a field
 * of accelerations, the symmetric part of tr T 1 - T, all of it where the moments are in balance. Collective.
 */
void rg_ties_turning(rg_ties *t, const rg_real *field, double (*stiffness)[3][3]);

/* Gives the nodes these motions; the others of their elements follow (solver/pattern.h). */
void rg_ties_hold(const rg_ties *t, const double (*motion)[6], rg_real *field);

/* Shows all nodes that are tied to prescribed bodies, along each axis. */
void rg_ties_show(const rg_ties *t, rg_held_line *show, void *to);

/* Whether nodes become tied in the kick at `time`. On all ranks the same. */
bool rg_ties_due(const rg_ties *t, double time);

/* What the nodes of a tile would have after a kick at `time` without the bodies; then, once all tiles have:
 * their sums, for rg_bodies_kick. The latter collective; it tells bodies whose nodes are let go or become
 * tied. `now`: velocities at `time`; NULL where nothing becomes tied. */
void rg_ties_gather(rg_ties *t, size_t tile, double time, const rg_real *u, const rg_real *velocity,
                    const rg_real *now);
void rg_ties_close(rg_ties *t, double time);

/* Once the bodies are kicked at `time`, between a step of dt_last and one of dt_next: velocities of a tile,
 * and those at the time of the step unless `now` is NULL. */
void rg_ties_kick(const rg_ties *t, size_t tile, double time, double dt_last, double dt_next,
                  rg_real *velocity, rg_real *now);

/* Before the bodies drift from `time` on: puts the nodes of a tile where that takes them. */
void rg_ties_drift(const rg_ties *t, size_t tile, double time, double dt, rg_real *u);

/* Kinetic energy that went when nodes became tied, so far (J). */
double rg_ties_taken(const rg_ties *t);

/* Registers where nodes were tied; and what follows from that, once it is there again. The latter collective.
 */
void rg_ties_register(rg_ties *t, rg_state *st);
void rg_ties_resume(rg_ties *t);

/* What is tied to body i in words: "2.5e-09 m2"; nothing if there is none. */
void rg_ties_describe(const rg_ties *t, int i, char *words, size_t size);

void rg_ties_free(rg_ties *t);

#endif
