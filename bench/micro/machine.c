#define _GNU_SOURCE
#include <sched.h>

#include <mpi.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/mem.h"
#include "micro/bench.h"

void bench_cpu_model(char text[BENCH_TEXT]) {
    char line[512];
    FILE *in = fopen("/proc/cpuinfo", "r");
    strcpy(text, "unknown");
    while (in != NULL && fgets(line, sizeof line, in) != NULL) {
        if (sscanf(line, "model name : %255[^\n]", text) == 1) {
            break;
        }
    }
    if (in != NULL) {
        fclose(in);
    }
}

size_t bench_cache_size(void) {
    size_t kilobytes = 0;
    for (int level = 4; level > 1 && kilobytes == 0; level--) {
        char path[128];
        snprintf(path, sizeof path, "/sys/devices/system/cpu/cpu0/cache/index%d/size", level);
        FILE *in = fopen(path, "r");
        if (in != NULL) {
            kilobytes = fscanf(in, "%zuK", &kilobytes) == 1 ? kilobytes : 0;
            fclose(in);
        }
    }
    return 1024 * kilobytes;
}

int bench_processors(void) {
    return (int)sysconf(_SC_NPROCESSORS_ONLN);
}

/* Writes the set as a list of ranges, cut where there is no room. */
static void format_set(const cpu_set_t *set, char text[BENCH_TEXT]) {
    size_t used = 0;
    text[0] = '\0';
    for (size_t first = 0; first < CPU_SETSIZE && used + 16 < BENCH_TEXT; first++) {
        if (!CPU_ISSET(first, set)) {
            continue;
        }
        size_t last = first;
        while (last + 1 < CPU_SETSIZE && CPU_ISSET(last + 1, set)) {
            last++;
        }
        used += (size_t)snprintf(text + used, BENCH_TEXT - used, "%s%zu", used > 0 ? "," : "", first);
        if (last > first) {
            used += (size_t)snprintf(text + used, BENCH_TEXT - used, "-%zu", last);
        }
        first = last;
    }
}

char (*bench_affinity(const bench *b))[BENCH_TEXT] {
    int threads = b->options.threads;
    char(*mine)[BENCH_TEXT] = rg_alloc((size_t)threads, BENCH_TEXT), (*all)[BENCH_TEXT] = NULL;
    if (b->rank == 0) {
        all = rg_alloc((size_t)(threads * b->ranks), BENCH_TEXT);
    }
#pragma omp parallel num_threads(threads)
    {
        cpu_set_t set;
        CPU_ZERO(&set);
        sched_getaffinity(0, sizeof set, &set);
        format_set(&set, mine[omp_get_thread_num()]);
    }
    MPI_Gather(mine, threads * BENCH_TEXT, MPI_CHAR, all, threads * BENCH_TEXT, MPI_CHAR, 0, MPI_COMM_WORLD);
    rg_free(mine);
    return all;
}
