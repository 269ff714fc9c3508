#include "domain/sparse.h"

#include <stdlib.h>

#include "base/exchange.h"
#include "base/mem.h"

/* Sends row i to rank to[i]; the rows of a rank keep their order. */
static rg_sparse send_rows(MPI_Comm comm, const rg_sparse *in, const int *to) {
    rg_exchange *x = rg_exchange_make(to, in->rows, comm);
    rg_sparse out = {.rows = x->arriving, .bytes = in->bytes};
    out.row = RG_NEW(char, out.rows *out.bytes + 1);
    rg_exchange_send(x, in->bytes, in->row, out.row);
    rg_exchange_free(x);
    return out;
}

static int by_key(const void *a, const void *b) {
    int64_t p, q;
    memcpy(&p, a, sizeof p);
    memcpy(&q, b, sizeof q);
    return (p > q) - (p < q);
}

rg_sparse rg_sparse_to_slab(const rg_slab *slab, const rg_sparse *own) {
    int *to = RG_NEW(int, own->rows + 1);
    for (size_t i = 0; i < own->rows; i++) {
        to[i] = rg_slab_owner(slab->total, slab->ranks, rg_sparse_key(own, i) / 4);
    }
    rg_sparse out = send_rows(slab->comm, own, to);
    rg_free(to);
    qsort(out.row, out.rows, out.bytes, by_key);
    return out;
}

rg_sparse rg_sparse_to_owners(const rg_slab *slab, const rg_sparse *sorted) {
    int *owner = RG_NEW(int, slab->count + 1), *to = RG_NEW(int, sorted->rows + 1);
    for (int r = 0; r < slab->ranks; r++) {
        for (int i = 0; i < slab->receive[r]; i++) {
            owner[slab->place[slab->receive_at[r] + i]] = r;
        }
    }
    for (size_t i = 0; i < sorted->rows; i++) {
        to[i] = owner[rg_sparse_key(sorted, i) / 4 - slab->first];
    }
    rg_sparse out = send_rows(slab->comm, sorted, to);
    rg_free(owner);
    rg_free(to);
    return out;
}
