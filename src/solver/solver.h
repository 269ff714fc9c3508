/* The state of a run on one rank and the passes over it: the physics, with the messages hidden under it.
 *
 * A step from state n to n + 1 is a kick and a drift. The kick evaluates the forces of u(n) in two sweeps
 * over the tiles: the element sweep does elements and the interfaces inside tiles, whose results never leave
 * the cache; then, when the tractions of all tiles are known, the boundary sweep the tile-boundary faces. The
 * drift moves u and publishes the traces of the tile-boundary faces. In form continuous the sweeps kick
 * accelerations in place of velocities, whose mean over the copies of a node (domain/assembly.h) moves all of
 * them in a third one.
 *
 * A material with a history goes on in the kick, by the step that led to u(n): once for each state. Between
 * kick and drift stress and energy are those that the forces were made of. */
#ifndef RG_SOLVER_H
#define RG_SOLVER_H

#include <mpi.h>

#include "base/exact_sum.h"
#include "case/case.h"
#include "contact/contact.h"
#include "solver/contact_force.h"
#include "domain/assembly.h"
#include "domain/domain.h"
#include "domain/halo.h"
#include "kernels.h"
#include "solver/absorbing.h"
#include "solver/account.h"
#include "solver/body.h"
#include "solver/constraint.h"
#include "solver/field_list.h"
#include "solver/load.h"
#include "solver/heat.h"
#include "solver/model.h"
#include "solver/phases.h"
#include "solver/tie.h"

/* What one thread needs to work on a tile. */
typedef struct {
    rg_real *force, *traction, *iforce, *turn, *ghost; /* layout.h */
} rg_workspace;

/* What a checkpoint holds of faces that open at a time. */
typedef struct {
    double until;    /* those that were to open by then have (s) */
    double released; /* energy that was set free (J) */
} rg_openings;

/* Of a start by damping: what that took, and the work of loads and supports (J). */
typedef struct {
    double heat, work;
} rg_relaxed;

typedef struct rg_solver rg_solver;
typedef struct rg_stepper rg_stepper;

/* Called for a tile between its kick and its drift, with `step_velocity` up to date there and the ghosts
 * received. */
typedef void rg_watcher(void *context, rg_solver *s, size_t tile, const rg_workspace *work);

struct rg_solver {
    /* ---- what is solved, and where: set up once (solver/setup.c) ---- */
    const rg_case *input;
    const rg_model *model;
    MPI_Comm comm;
    int rank, ranks, threads;
    const rg_kernels *kernels;
    rg_part *part;  /* sets and totals; its element list is gone once the domain stands */
    rg_part *patch; /* rank 0, until rg_spectrum: the elements that limit the time step (partition/patch.h);
                       not in form continuous */
    const rg_domain *domain;
    const rg_conforming_faces *conforming_faces; /* of form continuous; NULL in others */
    rg_assembly *assembly;                       /* likewise */
    bool beside;                                 /* all of this is another solver's (rg_solver_beside) */

    /* ---- the critical step, once rg_spectrum has found it ---- */
    double damping;  /* by viscosity.linear 1, of the stiffest mode */
    double omega2;   /* largest squared frequency, faces intact or closed, bodies in contact (1/s^2) */
    rg_gid limiting; /* element that sets it */
    const char *limiting_state;

    /* ---- the state: with the fields, what a checkpoint holds (solver/fields.c) ---- */
#define MEMBER(member, type, per, values, there, saved) RG_TYPE_OF_##type *member;
    struct {
        RG_FIELDS(MEMBER)
    };
#undef MEMBER
    rg_constraints *constraints;
    rg_bodies *bodies;
    rg_ties *ties;       /* of the surface to bodies */
    rg_account *account; /* of what acts from outside */
    rg_loads *loads;
    rg_absorbing *absorbing;
    rg_heating *heating;               /* NULL: no temperature is prescribed */
    rg_contacts *contacts;             /* between fragments; NULL: not computed */
    rg_contact_forces *contact_forces; /* NULL likewise */
    int64_t contacts_most;             /* most pairs of faces that touched at a time */
    double contact_omega2;             /* most that they added to the squared frequency (1/s^2) */
    double time, dt;                   /* of the current state (s); dt is the step that led to it */
    double dt_next;                    /* step that leads on, once kicked */
    int64_t step;
    struct {
        double largest;         /* component (Pa) */
        double scale;           /* about the norm, in that of M^-1, of its forces on loose elements */
    } initial_stress;           /* as the case gives it; 0 after a restart, which needs it no more */
    rg_relaxed relaxed;         /* on the way to the start (solver/relax.h) */
    rg_openings openings;       /* of faces that open at a time (solver/opening.h) */
    double opening_rate;        /* largest on all ranks (1/s) */
    double stiffening_anywhere; /* largest on all ranks; infinite if not finite */

    /* ---- the stepper, and what it tells ---- */
    rg_stepper *stepper; /* rows and messages: solver/stepper.h */
    rg_workspace *work;  /* [threads] */
    rg_watcher *watch;
    void *watch_context;
    int stop_request;        /* largest of all ranks (base/interrupt.h) when the forces were last computed */
    double *tile_seconds;    /* [tiles]: that the sweeps took (solver/balance.h); NULL: nobody asks */
    double pass_seconds;     /* of one evaluation of all forces, as measured at set-up */
    double exchange_seconds; /* of a step's messages with nothing to hide them, as measured at set-up */
    rg_phases phases;        /* of all passes since it was cleared */
};

#endif
