/* Halo exchange: lists built once, messages that run under other work. Knows neither physics nor layout: a
 * function tells where value k of a face lies.
 *
 * One exchange is: pack, start, other work (poll now and then), finish, unpack. Pack and unpack are
 * worksharing loops: call them from all threads of a parallel region, or from none; each ends with a barrier.
 * start, poll and finish are for the master thread alone (MPI_THREAD_FUNNELED). */
#ifndef RG_HALO_H
#define RG_HALO_H

#include <mpi.h>

#include "domain.h"

/* Index of value k of the face that `link` (4 * element + face) names, in the field to exchange. */
typedef size_t (*rg_halo_index)(int32_t link, int k);

typedef struct rg_halo rg_halo;

/* Exchanges `values` doubles per shared face and direction. `tag` tells exchanges apart. Keeps a reference to
 * the domain's list of shared faces. Collective; free with rg_halo_free. */
rg_halo *rg_halo_make(const rg_domain *d, int values, rg_halo_index index, int tag, MPI_Comm comm);

void rg_halo_pack(rg_halo *h, const double *field);
void rg_halo_start(rg_halo *h);
void rg_halo_poll(rg_halo *h);
void rg_halo_finish(rg_halo *h);
void rg_halo_unpack(rg_halo *h, double *field);

/* Seconds that `finish` has waited so far. */
double rg_halo_waited(const rg_halo *h);

void rg_halo_free(rg_halo *h);

#endif
