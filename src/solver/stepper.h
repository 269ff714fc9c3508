/* What a step is made with: rows and messages. For those who set a solver up, step it and show its tiles to
 * the kernels (solver/setup.c, step.c, tile.c), and for nobody else. */
#ifndef RG_STEPPER_H
#define RG_STEPPER_H

#include "solver/solver.h"

enum { RG_STEP_MOSTS = 7 };

struct rg_stepper {
    rg_material *material;        /* [materials], readied for the step that led here */
    rg_real *rows[2], *tractions; /* trace rows, of the current state and of the next; traction rows */
    int current;                  /* which of `rows` */
    rg_halo *halo_u[2], *halo_t;  /* of `rows` and `tractions` */
    /* Stiffening, stop request, way that faces in contact have moved (contact/contact.h), 1 where faces have
     * separated, and what is added to the squared frequency by contact of fragments, by that of faces that
     * opened with bodies, and by pressures: of this rank, of all; both on their way. */
    double here[RG_STEP_MOSTS], anywhere[RG_STEP_MOSTS];
    MPI_Request stiffening_request; /* of these */
    bool separated;                 /* some faces have, and wait to be exposed */
    int64_t touching, touching_anywhere;
    MPI_Request touching_request;
};

#endif
