/* Prescribed velocities and displacements on faces of the surface, on every node of the face. Here those
 * along axes of coordinates; the others in solver/oblique.h.
 *
 * The mass matrix of an element couples its nodes, so a prescribed node moves the free ones: with d the
 * change of velocity wanted at the constrained nodes c, the reaction impulse is J = (Minv_cc)^-1 d, and the
 * free nodes get Minv_fc J. The work of the reaction in a step, J . (v_before + v_after)/2, closes the
 * leapfrog's energy balance exactly. */
#ifndef RG_CONSTRAINT_H
#define RG_CONSTRAINT_H

#include <stdbool.h>

#include "base/exact_sum.h"
#include "base/first_bad.h"
#include "case/case.h"
#include "domain/assembly.h"
#include "domain/domain.h"
#include "solver/account.h"
#include "solver/state.h"

typedef struct rg_constraints rg_constraints;

/* The constraints of a case, of the materials m, on this rank. Where elements share nodes by an assembly
 * (else NULL), all copies of a node on a face of the set are prescribed, also those of elements that only
 * touch the set. Entries that have a name get an item of the account. Keeps references to `c`, `d` and
 * `account`. Collective; free with rg_constraints_free. */
rg_constraints *rg_constraints_make(const rg_case *c, const rg_domain *d, const rg_part *part,
                                    const rg_material *m, rg_assembly *nodes, rg_account *account,
                                    MPI_Comm comm);

/* Takes the fields at t = 0 as what the constrained nodes come from. Collective; ends the run with a message
 * (RG_USAGE) if a value is not finite then. */
void rg_constraints_start(rg_constraints *k, const rg_real *u, const rg_real *velocity, MPI_Comm comm);

/* Collective: whether a value was not finite in any step so far; then words[size] says which, where and when
 * first. */
bool rg_constraints_told(const rg_constraints *k, char *words, size_t size, MPI_Comm comm);

/* Evaluates what is prescribed for a step `dt` (> 0) from `time`, after one of dt_last: velocities in its
 * middle, displacements at its end, and velocities at `time` itself (at the start: those after it, with the
 * work of getting there). One thread. */
void rg_constraints_set(rg_constraints *k, double time, double dt_last, double dt);

/* Corrects the velocities of tile `tile` after its kick; before that those at the present time, unless `now`
 * is NULL. Both are whole fields. Keeps account of the work, and of the force of what has a name. */
void rg_constraints_kick(rg_constraints *k, size_t tile, const rg_real *u, rg_real *velocity, rg_real *now);

/* What has a prescribed displacement gets it after the drift of tile `tile`. */
void rg_constraints_drift(rg_constraints *k, size_t tile, rg_real *u);

/* Adds the work done up to the last present time at which velocities were asked for (J) to `work`. */
void rg_constraints_work(const rg_constraints *k, rg_exact_sum *work);

/* A line along which a node is held of its element. */
typedef void rg_held_line(void *to, size_t slot, int node, const double line[3]);

/* For equilibria at t = 0: puts what has a place then into it; shows all lines that are held then; takes what
 * is along them out of a field on a tile, by impulses through the mass. One thread, but for the last. */
void rg_constraints_place(rg_constraints *k, rg_real *u);
void rg_constraints_show(const rg_constraints *k, rg_held_line *show, void *to);
void rg_constraints_hold(const rg_constraints *k, size_t tile, rg_real *field);

/* Sets slots[slot] to 1 of all elements with a node that is prescribed at any time. */
void rg_constraints_mark(const rg_constraints *k, uint8_t *slots);

/* Registers what the constraints must remember: all that varies of their entries, keyed by 4 * global number
 * of the element + component. */
void rg_constraints_register(rg_constraints *k, rg_state *st);

/* Entry b of `boundary` in words: "velocity along x on 2.5e-09 m2, 2 faces of steel". */
void rg_constraints_describe(const rg_constraints *k, int b, char *words, size_t size);

void rg_constraints_free(rg_constraints *k);

#endif
