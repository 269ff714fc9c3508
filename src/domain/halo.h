/* Halo exchange: rows of the tile-boundary faces that lie between ranks, in messages that run under other
 * work. Knows neither physics nor what is in a row.
 *
 * One exchange is: pack, start, other work (poll now and then), finish; then the rows of the other ranks lie
 * behind the own ones. Pack is a worksharing loop: call it from all threads of a parallel region, or from
 * none; it ends with a barrier. start, poll and finish are for the master thread alone (MPI_THREAD_FUNNELED).
 */
#ifndef RG_HALO_H
#define RG_HALO_H

#include <mpi.h>

#include "domain/domain.h"

typedef struct rg_halo rg_halo;

/* A row that goes to another rank. */
typedef struct {
    int32_t rank;
    size_t row;
} rg_halo_row;

/* What is exchanged: rows sent, by rank, and the ranks from which rows come, ascending. Whoever is sent
 * something sends something, and both have the rows between them in the same order. */
typedef struct {
    const rg_halo_row *send;
    size_t sends;
    const int32_t *from;
    size_t receives;
    size_t own; /* rows of this rank; those that arrive lie behind them */
} rg_halo_plan;

/* Exchanges rows of `values` reals each in rows[own and receives][values]. `tag` tells exchanges apart. Keeps
 * a reference to `rows`, none to the plan. Collective; free with rg_halo_free. */
rg_halo *rg_halo_plan_make(const rg_halo_plan *plan, int values, rg_real *rows, int tag, MPI_Comm comm);

/* The same of the tile-boundary faces that a domain shares: rows[own rows and shared][values]. */
rg_halo *rg_halo_make(const rg_domain *d, int values, rg_real *rows, int tag, MPI_Comm comm);

void rg_halo_pack(rg_halo *h);
void rg_halo_start(rg_halo *h);
void rg_halo_poll(rg_halo *h);

/* Returns at once if nothing was started. */
void rg_halo_finish(rg_halo *h);

/* Seconds that `finish` has waited so far. */
double rg_halo_waited(const rg_halo *h);

/* Ranks that this one exchanges with, a message each; bytes that it sends them in one exchange. */
int rg_halo_partners(const rg_halo *h);
size_t rg_halo_bytes(const rg_halo *h);

/* Collective: ends what was started. */
void rg_halo_free(rg_halo *h);

#endif
