#include "solver/account.h"

#include <omp.h>
#include <stddef.h>
#include <string.h>

#include "base/mem.h"
#include "base/vector.h"
#include "domain/element.h"

enum { FORCE, MOMENT = 3, BEFORE = 6, AFTER, VALUES };

rg_account *rg_account_make(MPI_Comm comm) {
    rg_account *a = RG_NEW(rg_account, 1);
    a->comm = comm;
    return a;
}

int rg_account_add(rg_account *a, const char *name) {
    a->item = rg_realloc(a->item, (size_t)a->count + 1, sizeof *a->item);
    a->item[a->count] = (rg_account_item){.name = name};
    return a->count++;
}

void rg_account_open(rg_account *a, int threads) {
    a->threads = threads;
    a->sum = RG_NEW(rg_exact_sum, (size_t)(threads * a->count * VALUES) + 1);
    a->total = RG_NEW(rg_exact_sum, (size_t)(a->count * VALUES) + 1);
}

void rg_account_add_force(rg_account_entry *entry, const rg_domain *d, size_t slot, int node,
                          const rg_real *u, const double force[3]) {
    double x[3], moment[3];
    rg_node_position(d->corner + 12 * slot, node, x);
    for (int c = 0; c < 3; c++) {
        x[c] += u[rg_node_index(slot, node, c)];
    }
    rg_vector_cross(x, force, moment);
    for (int c = 0; c < 3; c++) {
        entry->force[c] += force[c];
        entry->moment[c] += moment[c];
    }
}

void rg_account_book(rg_account *a, int item, const rg_account_entry *entry) {
    rg_exact_sum *sum = a->sum + (omp_get_thread_num() * a->count + item) * VALUES;
    for (int c = 0; c < 3; c++) {
        rg_exact_add(&sum[FORCE + c], entry->force[c]);
        rg_exact_add(&sum[MOMENT + c], entry->moment[c]);
    }
    rg_exact_add(&sum[BEFORE], entry->before);
    rg_exact_add(&sum[AFTER], entry->after);
}

void rg_account_close(rg_account *a) {
    int sums = a->count * VALUES;
    if (sums == 0) {
        return;
    }
    memset(a->total, 0, (size_t)sums * sizeof *a->total);
    for (int i = 0; i < sums * a->threads; i++) {
        rg_exact_merge(&a->total[i % sums], &a->sum[i]);
    }
    memset(a->sum, 0, (size_t)(sums * a->threads) * sizeof *a->sum);
    rg_exact_allreduce(a->total, sums, a->comm);
    for (int i = 0; i < a->count; i++) {
        rg_account_item *item = &a->item[i];
        rg_exact_sum *total = a->total + i * VALUES;
        for (int c = 0; c < 3; c++) {
            item->force[c] = rg_exact_value(&total[FORCE + c]);
            item->moment[c] = rg_exact_value(&total[MOMENT + c]);
        }
        item->work_now = item->work + rg_exact_value(&total[BEFORE]);
        item->work = item->work_now + rg_exact_value(&total[AFTER]);
    }
}

void rg_account_register(rg_account *a, rg_state *st) {
    enum { ROW = (sizeof(rg_account_item) - offsetof(rg_account_item, work)) / sizeof(double) };
    if (a->count > 0) {
        rg_state_add_rows(st, "account", RG_STATE_DOUBLE, ROW, &a->item[0].work, sizeof *a->item,
                          (size_t)a->count);
    }
}

void rg_account_free(rg_account *a) {
    if (a != NULL) {
        rg_free(a->item);
        rg_free(a->sum);
        rg_free(a->total);
        rg_free(a);
    }
}
