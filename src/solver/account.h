/* Force and work of what acts on the solid from outside: an item for each load, support and absorbing side;
 * and forces between parts of it.
 *
 * A force f(n) at the time of step n acts from the middle of the step before to the middle of the next one.
 * Its work in the first half is dt v(n-1/2).f/2 and in the second dt' v(n+1/2).f/2: then the energy of a
 * linear solid at the step (diagnostics/ledger.h, with what half a kick takes) changes by just the work, to
 * rounding.
 *
 * Sums over the elements of a tile go into exact ones over threads and ranks, once a step, so that all ranks
 * know force and work of each item, to the same bits on any of them. */
#ifndef RG_ACCOUNT_H
#define RG_ACCOUNT_H

#include <mpi.h>

#include "base/exact_sum.h"
#include "domain/domain.h"
#include "solver/state.h"

typedef struct {
    const char *name; /* column prefix in history.csv; NULL: it has none there */
    bool inside;      /* between parts of the solid: no work is booked */
    /* From here to the end doubles only: a checkpoint takes them as a row. */
    double work;      /* up to the middle of the next step (J) */
    double work_now;  /* up to the present time */
    double force[3];  /* at the present time (N) */
    double moment[3]; /* of it about the origin, at places of the deformed solid (N m) */
} rg_account_item;

/* What an item did in a part of the solid, at a step. */
typedef struct {
    double force[3];      /* N */
    double moment[3];     /* about the origin (N m) */
    double before, after; /* work in the half steps (J) */
} rg_account_entry;

typedef struct {
    int count, threads;
    rg_account_item *item;
    MPI_Comm comm;
    rg_exact_sum *sum;   /* [threads][count] of the values of an entry */
    rg_exact_sum *total; /* [count] of them */
} rg_account;

/* An account without items; they are added, then it is opened. Free with rg_account_free. */
rg_account *rg_account_make(MPI_Comm comm);
int rg_account_add(rg_account *a, const char *name);
void rg_account_open(rg_account *a, int threads);

/* Adds a force on a node to an entry, with its moment where the node is by now. */
void rg_account_add_force(rg_account_entry *entry, const rg_domain *d, size_t slot, int node,
                          const rg_real *u, const double force[3]);

/* Adds to an item. Threads call it at once. */
void rg_account_book(rg_account *a, int item, const rg_account_entry *entry);

/* The sums of a step, once all is booked: work and forces of all items are known then. One thread;
 * collective.
 */
void rg_account_close(rg_account *a);

/* Registers what goes on (solver/state.h). */
void rg_account_register(rg_account *a, rg_state *st);

void rg_account_free(rg_account *a);

#endif
