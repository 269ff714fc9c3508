/* Fields of all nodes, as one works on them to find an equilibrium: sums and products that have the same bits
 * on any ranks and threads. */
#ifndef RG_STATICS_H
#define RG_STATICS_H

#include "solver/solver.h"

/* Least share of the forces at first, which nothing balances yet, by which a residual is measured: a body may
 * come to rest without any, as one does whose only support was turned. */
#define RG_STATICS_FIRST 1e-3

/* Bodies that are free and carry something move with it: a field of a displacement, velocity or acceleration
 * is that of a rigid body on what is tied to one, which is held of all fields. */
typedef struct {
    rg_solver *solver;
    size_t length;                   /* of the fields */
    double mass[RG_NODES][RG_NODES]; /* M/(rho V) */
    rg_real *force;                  /* M times a field: room */
    rg_exact_sum *sum;               /* [threads] */
    int64_t passes;                  /* over all forces so far */
    size_t cracks;                   /* values of crack state; 0 but in form intrinsic */
    rg_real *crack;                  /* as it is before any face of a law has opened */
    double stretch;                  /* of laws (rg_solver_acceleration): 1 at first */
    rg_body_place *from;             /* [bodies]: of the last departure */
    double (*motion)[6];             /* [bodies]: room */
} rg_statics;

rg_statics rg_statics_make(rg_solver *s);
void rg_statics_free(rg_statics *q);

/* A field of zeros, which the caller frees. */
rg_real *rg_statics_field(const rg_statics *q);

void rg_statics_copy(const rg_statics *q, const rg_real *from, rg_real *to);

/* to = factor to + scale from */
void rg_statics_add(const rg_statics *q, double scale, const rg_real *from, double factor, rg_real *to);

/* Takes out what lies along lines that are held at t = 0, and of what is tied to free bodies all but the
 * motion of a rigid one, which gets what `impulse` [bodies][6] on the body (and its moment) gives it besides;
 * NULL: none. Collective. */
void rg_statics_hold(const rg_statics *q, const double (*impulse)[6], rg_real *field);

/* Notes the solver's displacement in `start`, and where its bodies are. */
void rg_statics_depart(const rg_statics *q, rg_real *start);

/* Moves displacement and bodies from there by a share of `change`, which is held. Collective. */
void rg_statics_move(const rg_statics *q, const rg_real *start, double share, const rg_real *change);

/* Puts the bodies back where they were; the displacement stays. */
void rg_statics_return(const rg_statics *q);

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

/* Of the forces at the solver's displacement, with the loads of t = 0 or without (rg_solver_acceleration). In
 * form intrinsic openings on the way leave no trace: each law answers along its first curve, and the largest
 * opening of a point is then that of this displacement. */
void rg_statics_accelerate(rg_statics *q, rg_real *out, bool loaded);

/* Takes back what that has left in crack state. */
void rg_statics_forget(const rg_statics *q);

#endif
