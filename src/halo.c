#include "halo.h"

#include <string.h>

#include "mem.h"

#define REAL (sizeof(rg_real) == sizeof(double) ? MPI_DOUBLE : MPI_FLOAT)

struct rg_halo {
    const rg_shared_face *face;
    size_t faces;
    int values, partners;
    const rg_real *rows;
    rg_real *send;
    MPI_Request *request; /* persistent: receives first, then sends */
    double waited;
};

static int count_partners(const rg_shared_face *face, size_t faces) {
    int n = 0;
    for (size_t i = 0; i < faces; i++) {
        n += i == 0 || face[i].rank != face[i - 1].rank;
    }
    return n;
}

rg_halo *rg_halo_make(const rg_domain *d, int values, rg_real *rows, int tag, MPI_Comm comm) {
    rg_halo *h = RG_NEW(rg_halo, 1);
    *h = (rg_halo){.face = d->shared_face, .faces = d->shared, .values = values, .rows = rows};
    h->partners = count_partners(h->face, h->faces);
    h->send = RG_NEW(rg_real, d->shared * (size_t)values);
    h->request = RG_NEW(MPI_Request, 2 * (size_t)h->partners);
    rg_real *receive = rows + d->own_rows * (size_t)values;
    size_t begin = 0;
    for (int p = 0; p < h->partners; p++) {
        size_t end = begin;
        while (end < h->faces && h->face[end].rank == h->face[begin].rank) {
            end++;
        }
        int count = (int)(end - begin) * values, rank = h->face[begin].rank;
        size_t at = begin * (size_t)values;
        MPI_Recv_init(receive + at, count, REAL, rank, tag, comm, &h->request[p]);
        MPI_Send_init(h->send + at, count, REAL, rank, tag, comm, &h->request[h->partners + p]);
        begin = end;
    }
    return h;
}

void rg_halo_pack(rg_halo *h) {
    size_t values = (size_t)h->values;
#pragma omp for schedule(static)
    for (size_t i = 0; i < h->faces; i++) {
        memcpy(h->send + i * values, h->rows + h->face[i].seam * values, values * sizeof *h->send);
    }
}

void rg_halo_start(rg_halo *h) {
    MPI_Startall(2 * h->partners, h->request);
}

void rg_halo_poll(rg_halo *h) {
    int done;
    if (h->partners > 0) {
        MPI_Testall(2 * h->partners, h->request, &done, MPI_STATUSES_IGNORE);
    }
}

void rg_halo_finish(rg_halo *h) {
    double start = MPI_Wtime();
    MPI_Waitall(2 * h->partners, h->request, MPI_STATUSES_IGNORE);
    h->waited += MPI_Wtime() - start;
}

double rg_halo_waited(const rg_halo *h) {
    return h->waited;
}

int rg_halo_partners(const rg_halo *h) {
    return h->partners;
}

size_t rg_halo_bytes(const rg_halo *h) {
    return h->faces * (size_t)h->values * sizeof *h->send;
}

void rg_halo_free(rg_halo *h) {
    if (h == NULL) {
        return;
    }
    rg_halo_finish(h);
    for (int i = 0; i < 2 * h->partners; i++) {
        MPI_Request_free(&h->request[i]);
    }
    rg_free(h->send);
    rg_free(h->request);
    rg_free(h);
}
