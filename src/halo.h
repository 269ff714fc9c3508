/* Halo exchange: rows of the seams that lie between ranks, in messages that run under other work. Knows
 * neither physics nor what is in a row.
 *
 * One exchange is: pack, start, other work (poll now and then), finish; then the rows of the other ranks lie
 * behind the own ones. Pack is a worksharing loop: call it from all threads of a parallel region, or from
 * none; it ends with a barrier. start, poll and finish are for the master thread alone (MPI_THREAD_FUNNELED).
 */
#ifndef RG_HALO_H
#define RG_HALO_H

#include <mpi.h>

#include "domain.h"

typedef struct rg_halo rg_halo;

/* Exchanges the rows of `values` reals each in rows[own rows and shared][values]. `tag` tells exchanges
 * apart. Keeps references to both arguments. Collective; free with rg_halo_free. */
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
