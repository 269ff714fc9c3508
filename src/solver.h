/* The state of a run on one rank and the passes over it: the physics, with the messages hidden under it. */
#ifndef RG_SOLVER_H
#define RG_SOLVER_H

#include <mpi.h>

#include "case.h"
#include "constraint.h"
#include "domain.h"
#include "exact_sum.h"
#include "halo.h"
#include "kernels.h"

typedef struct {
    const rg_case *input;
    MPI_Comm comm;
    int rank, ranks, threads;
    const rg_kernels *kernels;
    rg_part *part; /* sets and totals; its element list is gone once the domain stands */
    rg_domain *domain;
    rg_halo *halo_u, *halo_t;

    double *u, *velocity, *scratch; /* [own blocks; u also ghosts], layout.h */
    double *force, *traction, *iforce, *crack;
    double *stiffening; /* [own blocks][lane] */
    double *tile_stiffening;
    double stiffening_here,
        stiffening_anywhere; /* largest on this rank, on all ranks; infinite if not finite */
    MPI_Request stiffening_request;
    uint8_t *cracked, *broken, *unlinked, *active;
    rg_constraints *constraints;

    rg_bulk_args bulk;
    rg_interface_args interface;
    rg_update_args update;

    double omega2;   /* largest squared frequency, faces intact or closed (1/s^2) */
    rg_gid limiting; /* element that sets it */
    const char *limiting_state;
    double pass_seconds; /* of one evaluation of all forces, as measured at set-up */
    double time, dt;     /* of the current state (s); dt is the step that led to it */
    int64_t step;
} rg_solver;

/* Builds everything for a case: mesh, partition, domain, fields at rest. Collective. */
rg_solver *rg_solver_make(const rg_case *input, MPI_Comm comm);

/* Initial displacement and velocity, constraints; forces at t = 0. Collective. */
void rg_solver_start(rg_solver *s);

/* One central-difference step. Collective. Allocates nothing. */
void rg_solver_step(rg_solver *s, double dt);

/* All forces of the current displacement: halo, bulk, interfaces. Collective. */
void rg_solver_forces(rg_solver *s);

/* Velocity at the time of the displacements into `scratch` (they are half a step apart), with the
 * constraints; returns the work they do in this half step (J), as an exact sum of this rank. */
void rg_solver_velocity_now(rg_solver *s, rg_exact_sum *work);

/* The same for one block of elements, without the work. Not collective. */
void rg_solver_block_velocity_now(rg_solver *s, size_t block);

void rg_solver_free(rg_solver *s);

#endif
