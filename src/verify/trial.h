/* A small case that rhegma verify simulates, step by step. */
#ifndef RG_VERIFY_TRIAL_H
#define RG_VERIFY_TRIAL_H

#include <mpi.h>
#include <stdbool.h>

#include "case/case.h"
#include "diagnostics/ledger.h"
#include "solver/solver.h"

/* What to change of what is simulated, while theory stays: none in the program; tests show by it that a check
 * fails when the physics is wrong. */
typedef struct {
    int count;
    const char *const *set; /* "a.b=value" */
} rg_verify_change;

typedef struct {
    rg_case *theory, *input; /* the case, and what is simulated of it */
    rg_solver *solver;
    rg_ledger ledger;
    double dt;      /* s */
    int64_t states; /* seen so far */
} rg_trial;

/* The case in `text`, ready at its start. Collective; end with rg_trial_end. */
rg_trial *rg_trial_begin(const char *text, const rg_verify_change *change, MPI_Comm comm);

/* Goes on to the next state, from the first call's initial one to that at the end time, with forces and the
 * velocity of that moment (solver->step_velocity) known. False after the last, or when the state is no longer
 * finite. Collective. */
bool rg_trial_next(rg_trial *t);

/* Takes stock of the current state. Collective. */
const rg_energy *rg_trial_ledger(rg_trial *t);

/* Calls `visit` for each Gauss point of the own elements with the Cauchy stress there (xx yy zz yz xz xy,
 * Pa). */
typedef void rg_trial_visit(void *context, const rg_solver *s, size_t slot, const double stress[6]);
void rg_trial_stresses(const rg_trial *t, rg_trial_visit *visit, void *context);

/* Calls `visit` for each node of the own elements. */
typedef void rg_trial_visit_node(void *context, const rg_solver *s, size_t slot, int node);
void rg_trial_nodes(const rg_trial *t, rg_trial_visit_node *visit, void *context);

void rg_trial_end(rg_trial *t);

#endif
