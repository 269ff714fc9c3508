#include "sparse.h"

#include <stdlib.h>

#include "mem.h"

/* Sends row i to rank to[i]; the rows of a rank keep their order. */
static rg_sparse exchange(MPI_Comm comm, const rg_sparse *in, const int *to) {
    int ranks;
    MPI_Comm_size(comm, &ranks);
    int *count = RG_NEW(int, 4 * (size_t)ranks + 4), *send = count, *send_at = count + ranks;
    int *receive = count + 2 * ranks, *receive_at = count + 3 * ranks;
    for (size_t i = 0; i < in->rows; i++) {
        send[to[i]]++;
    }
    MPI_Alltoall(send, 1, MPI_INT, receive, 1, MPI_INT, comm);
    for (int r = 1; r < ranks; r++) {
        send_at[r] = send_at[r - 1] + send[r - 1];
        receive_at[r] = receive_at[r - 1] + receive[r - 1];
    }
    rg_sparse out = {.rows = (size_t)(receive_at[ranks - 1] + receive[ranks - 1]), .bytes = in->bytes};
    char *packed = RG_NEW(char, in->rows * in->bytes + 1);
    int *next = RG_NEW(int, (size_t)ranks);
    for (size_t i = 0; i < in->rows; i++) {
        size_t at = (size_t)(send_at[to[i]] + next[to[i]]++);
        memcpy(packed + at * in->bytes, in->row + i * in->bytes, in->bytes);
    }
    out.row = RG_NEW(char, out.rows *out.bytes + 1);
    MPI_Datatype row;
    MPI_Type_contiguous((int)in->bytes, MPI_BYTE, &row);
    MPI_Type_commit(&row);
    MPI_Alltoallv(packed, send, send_at, row, out.row, receive, receive_at, row, comm);
    MPI_Type_free(&row);
    rg_free(packed);
    rg_free(next);
    rg_free(count);
    return out;
}

static int by_key(const void *a, const void *b) {
    int64_t p, q;
    memcpy(&p, a, sizeof p);
    memcpy(&q, b, sizeof q);
    return (p > q) - (p < q);
}

rg_sparse rg_sparse_to_slab(const rg_slab *slab, const rg_sparse *own) {
    int ranks, *to = RG_NEW(int, own->rows + 1);
    MPI_Comm_size(slab->comm, &ranks);
    for (size_t i = 0; i < own->rows; i++) {
        to[i] = rg_slab_owner(slab->total, ranks, rg_sparse_key(own, i) / 4);
    }
    rg_sparse out = exchange(slab->comm, own, to);
    rg_free(to);
    qsort(out.row, out.rows, out.bytes, by_key);
    return out;
}

rg_sparse rg_sparse_to_owners(const rg_slab *slab, const rg_sparse *sorted) {
    int ranks, *owner = RG_NEW(int, slab->count + 1), *to = RG_NEW(int, sorted->rows + 1);
    MPI_Comm_size(slab->comm, &ranks);
    for (int r = 0; r < ranks; r++) {
        for (int i = 0; i < slab->receive[r]; i++) {
            owner[slab->place[slab->receive_at[r] + i]] = r;
        }
    }
    for (size_t i = 0; i < sorted->rows; i++) {
        to[i] = owner[rg_sparse_key(sorted, i) / 4 - slab->first];
    }
    rg_sparse out = exchange(slab->comm, sorted, to);
    rg_free(owner);
    rg_free(to);
    return out;
}
