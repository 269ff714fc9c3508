/* Records to the ranks they belong to, and answers back. */
#ifndef RG_EXCHANGE_H
#define RG_EXCHANGE_H

#include <mpi.h>
#include <stddef.h>

typedef struct {
    size_t count;                               /* records that this rank sends */
    size_t arriving;                            /* records that it gets: by sending rank, each in its order */
    size_t *place;                              /* [count]: place of record i in the message */
    int *send, *send_at, *receive, *receive_at; /* [ranks]: records */
    int ranks;
    MPI_Comm comm;
} rg_exchange;

/* Prepares to send record i, of `count`, to rank to[i]. Keeps no reference to `to`. Collective; free with
 * rg_exchange_free. */
rg_exchange *rg_exchange_make(const int *to, size_t count, MPI_Comm comm);

/* Sends records of `size` bytes; `arrived` has room for x->arriving. Collective. */
void rg_exchange_send(const rg_exchange *x, size_t size, const void *records, void *arrived);

/* Sends one answer of `size` bytes to each record that arrived; `answers` has room for x->count, in the order
 * of the records. Collective. */
void rg_exchange_answer(const rg_exchange *x, size_t size, const void *given, void *answers);

void rg_exchange_free(rg_exchange *x);

#endif
