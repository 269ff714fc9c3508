/* Absorbing sides (Lysmer & Kuhlemeyer 1969): the traction -rho c_d (v.n) n - rho c_s (v - (v.n) n) on faces
 * of the surface takes up plane waves that meet them straight on, with the speeds c_d and c_s of the
 * element's material.
 *
 * A dashpot that is taken explicitly would shorten the critical step. Here it acts on the mean velocity of
 * the kick, (v(n-1/2) + v(n+1/2))/2, implicitly: with v' the velocity that the other forces alone lead to, C
 * the damping matrix of an element's faces, M its mass and h the length of the kick, (M + h C/2) (v(n+1/2) -
 * v') = -h C (v(n-1/2) + v')/2 which takes energy whatever h is, and leaves the critical step as it was.
 * Elements own their nodes, so this is a small system for each element, and in its damped nodes c alone: (P +
 * h C/2) w = P (v(n-1/2) + v')/2,   P = ((M^-1)_cc)^-1,   M (v(n+1/2) - v') = -h C w with w the mean
 * velocity; factorised anew only when h changes. Where elements share nodes, mass and damping are lumped and
 * summed over the copies of a node, each of which is a system of its own. */
#ifndef RG_ABSORBING_H
#define RG_ABSORBING_H

#include "domain/assembly.h"
#include "solver/account.h"
#include "solver/surface.h"

typedef struct rg_absorbing rg_absorbing;

/* The absorbing sides of a case, together one item of the account (none where there are none). `nodes` as in
 * rg_constraints_make. Keeps references to all but `part`. Collective; free with rg_absorbing_free. */
rg_absorbing *rg_absorbing_make(const rg_case *c, const rg_domain *d, const rg_part *part,
                                const rg_material *m, rg_assembly *nodes, rg_account *account, MPI_Comm comm);

/* A kick between a step of dt_last and one of dt_next (s). */
void rg_absorbing_set(rg_absorbing *a, double dt_last, double dt_next);

/* Takes the velocity (a whole field) of a tile from before its kick. */
void rg_absorbing_note(rg_absorbing *a, size_t tile, const rg_real *velocity);

/* Damps the velocities of a tile, once all other forces have kicked them. */
void rg_absorbing_damp(rg_absorbing *a, size_t tile, const rg_push *push);

/* Its work, by the complete velocity. */
void rg_absorbing_book(const rg_absorbing *a, size_t tile, const rg_real *velocity);

/* Energy that has left up to the present time (J). */
double rg_absorbing_radiated(const rg_absorbing *a);

void rg_absorbing_free(rg_absorbing *a);

#endif
