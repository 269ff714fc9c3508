#include "slab.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "layout.h"
#include "mem.h"

typedef struct {
    rg_gid id;
    rg_lid slot;
} numbered;

static int by_id(const void *a, const void *b) {
    const numbered *p = a, *q = b;
    return (p->id > q->id) - (p->id < q->id);
}

/* First number of rank r's slab. */
static rg_gid slab_begin(rg_gid total, int ranks, int r) {
    return total / ranks * r + (r < total % ranks ? r : total % ranks);
}

int rg_slab_owner(rg_gid total, int ranks, rg_gid id) {
    int r = (int)(id * ranks / total);
    while (id < slab_begin(total, ranks, r)) {
        r--;
    }
    while (id >= slab_begin(total, ranks, r + 1)) {
        r++;
    }
    return r;
}

static void offsets(const int *count, int *at, int ranks) {
    for (int r = 1; r < ranks; r++) {
        at[r] = at[r - 1] + count[r - 1];
    }
}

static numbered *sorted_elements(const rg_domain *d) {
    numbered *list = RG_NEW(numbered, d->elements + 1);
    size_t n = 0;
    for (size_t i = 0; i < d->blocks * RG_LANES; i++) {
        if (d->id[i] >= 0) {
            list[n++] = (numbered){d->id[i], (rg_lid)i};
        }
    }
    qsort(list, n, sizeof *list, by_id);
    return list;
}

rg_slab *rg_slab_make(const rg_domain *d, rg_gid total, MPI_Comm comm) {
    int rank, ranks;
    MPI_Comm_rank(comm, &rank);
    MPI_Comm_size(comm, &ranks);
    rg_slab *s = RG_NEW(rg_slab, 1);
    *s = (rg_slab){.rank = rank,
                   .ranks = ranks,
                   .total = total,
                   .first = slab_begin(total, ranks, rank),
                   .own = d->elements,
                   .comm = comm};
    s->count = (size_t)(slab_begin(total, ranks, rank + 1) - s->first);
    s->slot = RG_NEW(rg_lid, s->own + 1);
    s->place = RG_NEW(size_t, s->count + 1);
    int **counts[] = {&s->send, &s->send_at, &s->receive, &s->receive_at};
    for (int k = 0; k < 4; k++) {
        *counts[k] = RG_NEW(int, (size_t)ranks);
    }
    numbered *list = sorted_elements(d);
    rg_gid *id = RG_NEW(rg_gid, s->own + 1), *arrived = RG_NEW(rg_gid, s->count + 1);
    for (size_t i = 0; i < s->own; i++) {
        s->slot[i] = list[i].slot;
        id[i] = list[i].id;
        s->send[rg_slab_owner(total, ranks, id[i])]++;
    }
    MPI_Alltoall(s->send, 1, MPI_INT, s->receive, 1, MPI_INT, comm);
    offsets(s->send, s->send_at, ranks);
    offsets(s->receive, s->receive_at, ranks);
    MPI_Alltoallv(id, s->send, s->send_at, MPI_INT64_T, arrived, s->receive, s->receive_at, MPI_INT64_T,
                  comm);
    for (size_t i = 0; i < s->count; i++) {
        s->place[i] = (size_t)(arrived[i] - s->first);
    }
    rg_free(list);
    rg_free(id);
    rg_free(arrived);
    return s;
}

static MPI_Datatype record_type(size_t bytes) {
    MPI_Datatype record;
    MPI_Type_contiguous((int)bytes, MPI_BYTE, &record);
    MPI_Type_commit(&record);
    return record;
}

size_t rg_slab_place(const rg_slab *s, size_t i) {
    size_t first = (size_t)s->send_at[s->rank];
    bool stays = i >= first && i < first + (size_t)s->send[s->rank];
    return stays ? s->place[(size_t)s->receive_at[s->rank] + i - first] : SIZE_MAX;
}

void rg_slab_send_others(const rg_slab *s, size_t bytes, const void *in, void *out) {
    if (s->ranks == 1) {
        return;
    }
    int *send = RG_NEW(int, 2 * (size_t)s->ranks), *receive = send + s->ranks;
    memcpy(send, s->send, (size_t)s->ranks * sizeof *send);
    memcpy(receive, s->receive, (size_t)s->ranks * sizeof *receive);
    send[s->rank] = receive[s->rank] = 0;
    MPI_Datatype record = record_type(bytes);
    char *arrived = RG_NEW(char, s->count *bytes + 1);
    MPI_Alltoallv(in, send, s->send_at, record, arrived, receive, s->receive_at, record, s->comm);
    MPI_Type_free(&record);
    size_t first = (size_t)s->receive_at[s->rank], end = first + (size_t)s->receive[s->rank];
    for (size_t i = 0; i < s->count; i++) {
        if (i < first || i >= end) {
            memcpy((char *)out + s->place[i] * bytes, arrived + i * bytes, bytes);
        }
    }
    rg_free(arrived);
    rg_free(send);
}

void rg_slab_send_bytes(const rg_slab *s, size_t bytes, const void *in, void *out) {
    size_t first = (size_t)s->send_at[s->rank], end = first + (size_t)s->send[s->rank];
    for (size_t i = first; i < end; i++) {
        memcpy((char *)out + rg_slab_place(s, i) * bytes, (const char *)in + i * bytes, bytes);
    }
    rg_slab_send_others(s, bytes, in, out);
}

void rg_slab_fetch_bytes(const rg_slab *s, size_t bytes, const void *in, void *out) {
    MPI_Datatype record = record_type(bytes);
    char *leaving = RG_NEW(char, s->count *bytes + 1);
    for (size_t i = 0; i < s->count; i++) {
        memcpy(leaving + i * bytes, (const char *)in + s->place[i] * bytes, bytes);
    }
    MPI_Alltoallv(leaving, s->receive, s->receive_at, record, out, s->send, s->send_at, record, s->comm);
    rg_free(leaving);
    MPI_Type_free(&record);
}

void rg_slab_send(const rg_slab *s, int values, const double *in, double *out) {
    rg_slab_send_bytes(s, (size_t)values * sizeof(double), in, out);
}

size_t rg_slab_row(const rg_slab *s, const rg_domain *d, rg_gid id) {
    size_t low = 0, high = s->own;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (d->id[s->slot[middle]] < id) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

void rg_slab_free(rg_slab *s) {
    if (s == NULL) {
        return;
    }
    void *blocks[] = {s->slot, s->place, s->send, s->send_at, s->receive, s->receive_at};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
        rg_free(blocks[i]);
    }
    rg_free(s);
}
