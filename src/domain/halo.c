#include "domain/halo.h"

#include <string.h>

#include "base/mem.h"

#define REAL (sizeof(rg_real) == sizeof(double) ? MPI_DOUBLE : MPI_FLOAT)

struct rg_halo {
    rg_halo_row *row; /* [rows_sent], by rank */
    size_t rows_sent;
    int values, partners;
    const rg_real *rows;
    rg_real *send;
    MPI_Request *request; /* persistent: receives first, then sends */
    double waited;
};

static int count_partners(const rg_halo_row *row, size_t rows) {
    int n = 0;
    for (size_t i = 0; i < rows; i++) {
        n += i == 0 || row[i].rank != row[i - 1].rank;
    }
    return n;
}

rg_halo *rg_halo_plan_make(const rg_halo_plan *plan, int values, rg_real *rows, int tag, MPI_Comm comm) {
    rg_halo *h = RG_NEW(rg_halo, 1);
    *h = (rg_halo){.rows_sent = plan->sends, .values = values, .rows = rows};
    h->row = RG_NEW(rg_halo_row, plan->sends + 1);
    if (plan->sends > 0) {
        memcpy(h->row, plan->send, plan->sends * sizeof *h->row);
    }
    h->partners = count_partners(h->row, h->rows_sent);
    h->send = RG_NEW(rg_real, plan->sends * (size_t)values);
    h->request = RG_NEW(MPI_Request, 2 * (size_t)h->partners);
    size_t sent = 0, arrived = 0;
    for (int p = 0; p < h->partners; p++) {
        int32_t rank = h->row[sent].rank;
        size_t begin = sent, first = arrived;
        while (sent < h->rows_sent && h->row[sent].rank == rank) {
            sent++;
        }
        while (arrived < plan->receives && plan->from[arrived] == rank) {
            arrived++;
        }
        MPI_Recv_init(rows + (plan->own + first) * (size_t)values, (int)(arrived - first) * values, REAL,
                      rank, tag, comm, &h->request[p]);
        MPI_Send_init(h->send + begin * (size_t)values, (int)(sent - begin) * values, REAL, rank, tag, comm,
                      &h->request[h->partners + p]);
    }
    return h;
}

rg_halo *rg_halo_make(const rg_domain *d, int values, rg_real *rows, int tag, MPI_Comm comm) {
    rg_halo_row *send = RG_NEW(rg_halo_row, d->shared + 1);
    int32_t *from = RG_NEW(int32_t, d->shared + 1);
    for (size_t i = 0; i < d->shared; i++) {
        send[i] = (rg_halo_row){d->shared_face[i].rank, d->shared_face[i].tile_face};
        from[i] = d->shared_face[i].rank;
    }
    rg_halo_plan plan = {send, d->shared, from, d->shared, d->own_rows};
    rg_halo *h = rg_halo_plan_make(&plan, values, rows, tag, comm);
    rg_free(send);
    rg_free(from);
    return h;
}

void rg_halo_pack(rg_halo *h) {
    size_t values = (size_t)h->values;
#pragma omp for schedule(static)
    for (size_t i = 0; i < h->rows_sent; i++) {
        memcpy(h->send + i * values, h->rows + h->row[i].row * values, values * sizeof *h->send);
    }
}

void rg_halo_start(rg_halo *h) {
    MPI_Startall(2 * h->partners, h->request);
}

void rg_halo_poll(rg_halo *h) {
    int done;
    MPI_Testall(2 * h->partners, h->request, &done, MPI_STATUSES_IGNORE);
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
    return h->rows_sent * (size_t)h->values * sizeof *h->send;
}

void rg_halo_free(rg_halo *h) {
    if (h == NULL) {
        return;
    }
    rg_halo_finish(h);
    for (int i = 0; i < 2 * h->partners; i++) {
        MPI_Request_free(&h->request[i]);
    }
    rg_free(h->row);
    rg_free(h->send);
    rg_free(h->request);
    rg_free(h);
}
