#define _GNU_SOURCE 1 /* sched_getaffinity */
#include "base/affinity.h"

#include <omp.h>
#include <sched.h>
#include <string.h>
#include <unistd.h>

#include "base/error.h"
#include "base/mem.h"

enum { HOST = 64, TEXT = 256 };

typedef struct {
    char host[HOST], cpus[TEXT];
    int threads, allowed;        /* of the rank */
    int host_threads, host_cpus; /* of all ranks on its host */
} placement;

/* Union of the masks of all threads of this rank. */
static cpu_set_t rank_mask(void) {
    cpu_set_t all;
    CPU_ZERO(&all);
#pragma omp parallel
    {
        cpu_set_t mine;
        CPU_ZERO(&mine);
        sched_getaffinity(0, sizeof mine, &mine);
#pragma omp critical
        CPU_OR(&all, &all, &mine);
    }
    return all;
}

void rg_affinity_list(const bool *allowed, int count, char *text, size_t size) {
    size_t used = 0;
    text[0] = '\0';
    for (int begin = 0; begin < count && used + 16 < size; begin++) {
        int end = begin;
        while (end < count && allowed[end]) {
            end++;
        }
        if (end > begin) {
            const char *comma = used > 0 ? "," : "";
            int n = end > begin + 1 ? snprintf(text + used, size - used, "%s%d-%d", comma, begin, end - 1)
                                    : snprintf(text + used, size - used, "%s%d", comma, begin);
            used += (size_t)n;
            begin = end;
        }
    }
}

static placement place(MPI_Comm comm) {
    placement p = {.threads = omp_get_max_threads()};
    cpu_set_t mask = rank_mask(), all;
    MPI_Comm host;
    MPI_Comm_split_type(comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &host);
    MPI_Allreduce(&p.threads, &p.host_threads, 1, MPI_INT, MPI_SUM, host);
    MPI_Allreduce(&mask, &all, sizeof mask, MPI_BYTE, MPI_BOR, host);
    MPI_Comm_free(&host);
    p.allowed = CPU_COUNT(&mask);
    p.host_cpus = CPU_COUNT(&all);
    gethostname(p.host, HOST - 1);
    bool allowed[CPU_SETSIZE];
    for (size_t i = 0; i < CPU_SETSIZE; i++) {
        allowed[i] = CPU_ISSET(i, &mask);
    }
    rg_affinity_list(allowed, CPU_SETSIZE, p.cpus, TEXT);
    return p;
}

static void warn(const placement *p, int ranks) {
    for (int r = 0; r < ranks; r++) {
        if (p[r].threads > p[r].allowed) {
            rg_warn("rank %d has %d threads on %d processors: they share (mpirun --bind-to none, or --map-by "
                    "slot:PE=%d)",
                    r, p[r].threads, p[r].allowed, p[r].threads);
            return;
        }
    }
    for (int r = 0; r < ranks; r++) {
        if (p[r].host_threads > p[r].host_cpus) {
            rg_warn("host %s has %d threads on %d processors: they share", p[r].host, p[r].host_threads,
                    p[r].host_cpus);
            return;
        }
    }
}

void rg_affinity_print(MPI_Comm comm, FILE *out) {
    int rank, ranks;
    MPI_Comm_rank(comm, &rank);
    MPI_Comm_size(comm, &ranks);
    placement mine = place(comm), *all = RG_NEW(placement, rank == 0 ? (size_t)ranks : 1);
    MPI_Gather(&mine, sizeof mine, MPI_BYTE, all, sizeof mine, MPI_BYTE, 0, comm);
    if (rank == 0) {
        for (int r = 0; r < ranks; r++) {
            fprintf(out, "rank %-9d %d threads on processors %s of %s\n", r, all[r].threads, all[r].cpus,
                    all[r].host);
        }
        warn(all, ranks);
    }
    rg_free(all);
}
