/* Fields of all nodes, as one works on them to find an equilibrium: sums and products that have the same bits
 * on any ranks and threads. */
#ifndef RG_STATICS_H
#define RG_STATICS_H

#include "solver/solver.h"

/* Least share of the forces at first, which nothing balances yet, by which a residual is measured: a body may
 * come to rest without any, as one does whose only support was turned. */
#define RG_STATICS_FIRST 1e-3

typedef struct {
    rg_solver *solver;
    size_t length;                   /* of the fields */
    double mass[RG_NODES][RG_NODES]; /* M/(rho V) */
    rg_real *force;                  /* M times a field: room */
    rg_exact_sum *sum;               /* [threads] */
    int64_t passes;                  /* over all forces so far */
} rg_statics;

rg_statics rg_statics_make(rg_solver *s);
void rg_statics_free(rg_statics *q);

/* A field of zeros, which the caller frees. */
rg_real *rg_statics_field(const rg_statics *q);

void rg_statics_copy(const rg_statics *q, const rg_real *from, rg_real *to);

/* to = factor to + scale from */
void rg_statics_add(const rg_statics *q, double scale, const rg_real *from, double factor, rg_real *to);

/* Takes out what lies along lines that are held at t = 0. */
void rg_statics_hold(const rg_statics *q, rg_real *field);

/* out = M field */
void rg_statics_times_mass(const rg_statics *q, const rg_real *field, rg_real *out);

/* Of two fields over all elements; an element's own sum has an order of its own. Collective. */
double rg_statics_dot(const rg_statics *q, const rg_real *a, const rg_real *b);

/* Largest component. Collective. */
double rg_statics_largest(const rg_statics *q, const rg_real *field);

/* Norm of an acceleration, sqrt(a M a); M a is in `force` then. Collective. */
double rg_statics_norm(const rg_statics *q, const rg_real *field);

/* Norm of what rounding of the displacement leaves of the accelerations: of what they change by with half of
 * each last digit. `room`, `change`: fields. Collective. */
double rg_statics_rounding(rg_statics *q, rg_real *room, rg_real *change);

/* Of the forces at the solver's displacement, with the loads of t = 0 or without (rg_solver_acceleration). */
void rg_statics_accelerate(rg_statics *q, rg_real *out, bool loaded);

#endif
