/* Prescribed velocities and displacements on named sets of faces, on every node of the face.
 *
 * The mass matrix of an element couples its nodes, so a prescribed node moves the free ones: with d the
 * change of velocity wanted at the constrained nodes c, the reaction impulse is J = (Minv_cc)^-1 d, and the
 * free nodes get Minv_fc J. The work of the reaction in a step, J . (v_before + v_after)/2, closes the
 * leapfrog's energy balance exactly. */
#ifndef RG_CONSTRAINT_H
#define RG_CONSTRAINT_H

#include <stdbool.h>

#include "case.h"
#include "domain.h"
#include "exact_sum.h"

typedef struct rg_constraints rg_constraints;

/* The constraints of a case on this rank. Keeps references to `c` and `d`. Free with rg_constraints_free. */
rg_constraints *rg_constraints_make(const rg_case *c, const rg_domain *d, const rg_part *part);

/* Takes the fields at t = 0 as what the constrained nodes come from. */
void rg_constraints_start(rg_constraints *k, const double *u, const double *velocity);

/* Evaluates what is prescribed: velocities at `time_velocity`, displacements at `time_displacement`, to be
 * reached by a step `dt_displacement`. One thread. */
void rg_constraints_set(rg_constraints *k, double time_velocity, double time_displacement,
                        double dt_displacement);

/* Corrects tile `tile` after its update. */
void rg_constraints_apply(rg_constraints *k, size_t tile, double *velocity, double *u,
                          double dt_displacement);

/* Corrects the velocities of own slots [begin, end) at `time` without keeping account; adds the work of doing
 * so to `work` unless that is NULL. */
void rg_constraints_peek(rg_constraints *k, size_t begin, size_t end, double time, double *velocity,
                         rg_exact_sum *work);

/* Adds the work done so far (J) to `work`. */
void rg_constraints_work(const rg_constraints *k, rg_exact_sum *work);

void rg_constraints_free(rg_constraints *k);

#endif
