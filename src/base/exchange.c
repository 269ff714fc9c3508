#include "base/exchange.h"

#include <string.h>

#include "base/mem.h"

static int offsets(const int *count, int *at, int ranks) {
    for (int r = 1; r < ranks; r++) {
        at[r] = at[r - 1] + count[r - 1];
    }
    return at[ranks - 1] + count[ranks - 1];
}

rg_exchange *rg_exchange_make(const int *to, size_t count, MPI_Comm comm) {
    rg_exchange *x = RG_NEW(rg_exchange, 1);
    *x = (rg_exchange){.count = count, .place = RG_NEW(size_t, count), .comm = comm};
    MPI_Comm_size(comm, &x->ranks);
    int **counts[] = {&x->send, &x->send_at, &x->receive, &x->receive_at};
    for (int k = 0; k < 4; k++) {
        *counts[k] = RG_NEW(int, (size_t)x->ranks);
    }
    for (size_t i = 0; i < count; i++) {
        x->place[i] = (size_t)x->send[to[i]]++;
    }
    MPI_Alltoall(x->send, 1, MPI_INT, x->receive, 1, MPI_INT, comm);
    offsets(x->send, x->send_at, x->ranks);
    x->arriving = (size_t)offsets(x->receive, x->receive_at, x->ranks);
    for (size_t i = 0; i < count; i++) {
        x->place[i] += (size_t)x->send_at[to[i]];
    }
    return x;
}

static MPI_Datatype record_type(size_t size) {
    MPI_Datatype record;
    MPI_Type_contiguous((int)size, MPI_BYTE, &record);
    MPI_Type_commit(&record);
    return record;
}

void rg_exchange_send(const rg_exchange *x, size_t size, const void *records, void *arrived) {
    char *message = rg_alloc(x->count, size);
    for (size_t i = 0; i < x->count; i++) {
        memcpy(message + x->place[i] * size, (const char *)records + i * size, size);
    }
    MPI_Datatype record = record_type(size);
    MPI_Alltoallv(message, x->send, x->send_at, record, arrived, x->receive, x->receive_at, record, x->comm);
    MPI_Type_free(&record);
    rg_free(message);
}

void rg_exchange_answer(const rg_exchange *x, size_t size, const void *given, void *answers) {
    char *message = rg_alloc(x->count, size);
    MPI_Datatype record = record_type(size);
    MPI_Alltoallv(given, x->receive, x->receive_at, record, message, x->send, x->send_at, record, x->comm);
    MPI_Type_free(&record);
    for (size_t i = 0; i < x->count; i++) {
        memcpy((char *)answers + i * size, message + x->place[i] * size, size);
    }
    rg_free(message);
}

void rg_exchange_free(rg_exchange *x) {
    if (x == NULL) {
        return;
    }
    void *blocks[] = {x->place, x->send, x->send_at, x->receive, x->receive_at};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
        rg_free(blocks[i]);
    }
    rg_free(x);
}
