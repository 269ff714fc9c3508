/* What a step is made with: rows and messages. For those who set a solver up, step it and show its tiles to
 * the kernels (solver/setup.c, step.c, tile.c), and for nobody else. */
#ifndef RG_STEPPER_H
#define RG_STEPPER_H

#include "solver/solver.h"

struct rg_stepper {
    rg_material *material;          /* [materials], readied for the step that led here */
    rg_real *rows[2], *tractions;   /* trace rows, of the current state and of the next; traction rows */
    int current;                    /* which of `rows` */
    rg_halo *halo_u[2], *halo_t;    /* of `rows` and `tractions` */
    double here[2], anywhere[2];    /* stiffening and stop request: of this rank, of all; both on their way */
    MPI_Request stiffening_request; /* of these */
};

#endif
