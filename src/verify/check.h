/* The checks of rhegma verify. Each simulates one small case on the ranks of `comm` and adds its rows. All
 * are collective. */
#ifndef RG_VERIFY_CHECK_H
#define RG_VERIFY_CHECK_H

#include "verify/row.h"
#include "verify/trial.h"

typedef void rg_verify_check(MPI_Comm comm, const rg_verify_change *change, rg_verify_rows *rows);

/* Speed of pressure and of shear waves, from the frequency of a standing wave in a bar with sliding or free
 * ends. */
rg_verify_check rg_verify_pressure_wave, rg_verify_shear_wave;

/* An affine displacement of an irregular box stays, with the stress of the law everywhere. */
rg_verify_check rg_verify_patch;

/* A body turned by 90 degrees stays at rest without stress. */
rg_verify_check rg_verify_rotation;

/* A free bar that rings keeps its energy. */
rg_verify_check rg_verify_energy;

/* Spall (A. N. Seagraves, MIT 2010, chapter 5): two waves of stress rho c v meet in the middle of a bar at
 * L/2c and break it there and then. */
rg_verify_check rg_verify_spall;

/* A bar that breaks across one plane loses the mechanical energy G_c times its cross-section. */
rg_verify_check rg_verify_separation;

/* Linear momentum of a body that flies apart; and the state of it after fracture, which has the same bits on
 * all ranks with any number of threads as on one rank with one thread. */
rg_verify_check rg_verify_identity;

/* Length of the change of a vector over that of what it was. */
double rg_verify_change_of(const double from[3], const double to[3]);

/* Runs checks on the first `most_ranks` ranks of `comm` and prints the table to `out` of rank 0. Returns on
 * all ranks RG_OK, or RG_FAILURE if a row failed. Collective. */
int rg_verify_run(rg_verify_check *const *check, size_t checks, int most_ranks, MPI_Comm comm, FILE *out);

#endif
