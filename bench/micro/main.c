/* rhegma-bench: checks every kernel of every instruction set against the reference, and times it and the
 * whole step against what the machine can do. */
#include <errno.h>
#include <mpi.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "base/affinity.h"
#include "base/denormals.h"
#include "base/error.h"
#include "base/mem.h"
#include "micro/bench.h"
#include "revision.h"

static const char usage[] =
    "usage: rhegma-bench [options]\n"
    "  --quick         small meshes, few repeats: under 20 s; for a check, not for a record\n"
    "  --json FILE     write the record of the run, every sample included\n"
    "  --kernel NAME   only kernels with NAME in their name (step for the whole step)\n"
    "  --threads N     1, 2, 4, ... and N threads per rank (default: what OMP_NUM_THREADS allows)\n"
    "  --repeats R     samples per row, 3 to 100 (default 21; 5 if quick)\n"
    "  --tile N        of the whole step: 256 (default), 512 or 1024 elements to a tile\n"
    "  --efficiency N  instead: what the ranks' cores gain over one core, in N rounds (3 to 100); see "
    "bench/studies/efficiency\n"
    "  --cost          instead: operations and bytes of the cost model (perf/README.md)\n"
    "  --help\n"
    "us/tet counts two interfaces as one tet; the other columns follow kernels/cost/model.c "
    "(perf/README.md).\n"
    "ranks: mpirun -n N rhegma-bench ...; every rank works at the same time, rates are sums over the ranks.\n"
    "exit status: 0; 1 if a kernel differs from the reference; 2 for wrong options\n";

enum { MOST_THREADS = 4096, DEFAULT_REPEATS = 21, QUICK_REPEATS = 5 };

static int complain(const bench *b, const char *what, const char *argument) {
    if (b->rank == 0) {
        fprintf(stderr, "rhegma-bench: %s: %s\n%s", what, argument, usage);
    }
    return RG_USAGE;
}

static bool parse_count(const char *text, int least, int most, int *value) {
    char *end;
    errno = 0;
    long x = strtol(text, &end, 10);
    *value = (int)x;
    return errno == 0 && end != text && *end == '\0' && x >= least && x <= most;
}

static bool name_exists(const char *part) {
    for (int k = 0; bench_kernel_name(k) != NULL; k++) {
        if (strstr(bench_kernel_name(k), part) != NULL) {
            return true;
        }
    }
    for (int k = 0; bench_step_name(k) != NULL; k++) {
        if (strstr(bench_step_name(k), part) != NULL) {
            return true;
        }
    }
    return false;
}

/* One option with a value. */
static int parse_value(bench *b, const char *option, const char *value) {
    bench_options *o = &b->options;
    if (value == NULL) {
        return complain(b, "missing value after", option);
    }
    if (strcmp(option, "--json") == 0) {
        o->json = value;
    } else if (strcmp(option, "--kernel") == 0) {
        o->kernel = value;
        return name_exists(value) ? RG_OK : complain(b, "no kernel has this in its name", value);
    } else if (strcmp(option, "--efficiency") == 0) {
        return parse_count(value, 3, BENCH_SAMPLES, &o->rounds)
                   ? RG_OK
                   : complain(b, "--efficiency: a number from 3 to 100 is needed, not", value);
    } else if (strcmp(option, "--tile") == 0) {
        return parse_count(value, 256, 1024, &o->tile) && (o->tile & (o->tile - 1)) == 0
                   ? RG_OK
                   : complain(b, "--tile: 256, 512 or 1024 is needed, not", value);
    } else if (strcmp(option, "--threads") == 0) {
        return parse_count(value, 1, MOST_THREADS, &o->threads)
                   ? RG_OK
                   : complain(b, "--threads: a number from 1 to 4096 is needed, not", value);
    } else {
        return parse_count(value, 3, BENCH_SAMPLES, &o->repeats)
                   ? RG_OK
                   : complain(b, "--repeats: a number from 3 to 100 is needed, not", value);
    }
    return RG_OK;
}

static int parse(bench *b, int argc, char **argv) {
    for (int i = 1; i < argc; i++) {
        const char *a = argv[i];
        if (strcmp(a, "--quick") == 0) {
            b->options.quick = true;
        } else if (strcmp(a, "--json") == 0 || strcmp(a, "--kernel") == 0 || strcmp(a, "--threads") == 0 ||
                   strcmp(a, "--repeats") == 0 || strcmp(a, "--tile") == 0 ||
                   strcmp(a, "--efficiency") == 0) {
            if (parse_value(b, a, i + 1 < argc ? argv[i + 1] : NULL) != RG_OK) {
                return RG_USAGE;
            }
            i++;
        } else {
            return complain(b, "unknown option", a);
        }
    }
    if (b->options.tile == 0) {
        b->options.tile = 256;
    }
    if (b->options.threads == 0) {
        b->options.threads = omp_get_max_threads();
    }
    if (b->options.repeats == 0) {
        b->options.repeats = b->options.quick ? QUICK_REPEATS : DEFAULT_REPEATS;
    }
    return RG_OK;
}

bool bench_wants(const bench *b, const char *kernel) {
    return b->options.kernel == NULL || strstr(kernel, b->options.kernel) != NULL;
}

bench_row *bench_add_row(bench *b, const char *kernel, const char *set, bench_size size, int threads) {
    if (b->rows == b->capacity) {
        b->capacity = 2 * b->capacity + 64;
        b->row = rg_realloc(b->row, (size_t)b->capacity, sizeof *b->row);
    }
    bench_row *row = &b->row[b->rows++];
    *row = (bench_row){.set = set, .size = size, .threads = threads};
    snprintf(row->kernel, sizeof row->kernel, "%s", kernel);
    return row;
}

static void print_machine(const bench *b) {
    char cpu[BENCH_TEXT];
    if (b->rank == 0) {
        bench_cpu_model(cpu);
        printf("rhegma-bench %s, compiler %s\n%s, %d processors; %d ranks x %d threads\n", RG_REVISION,
               __VERSION__, cpu, bench_processors(), b->ranks, b->options.threads);
    }
    omp_set_num_threads(b->options.threads);
    rg_affinity_print(MPI_COMM_WORLD, stdout);
}

/* Everything with one number of threads. */
static void run_threads(bench *b, int threads) {
    omp_set_num_threads(threads);
    rg_flush_denormals();
    bench_roofs *r = &b->roof[b->roofs];
    bench_measure_roofs(b, r);
    b->roofs++;
    bench_print_roofs(b, r, stdout);
    if (b->rank == 0) {
        bench_print_header(stdout);
    }
    for (int size = 0; size < BENCH_SIZES; size++) {
        bench_kernels(b, (bench_size)size, threads);
    }
    bench_steps(b, threads);
}

static int run(bench *b) {
    print_machine(b);
    for (int threads = 1; threads < b->options.threads; threads *= 2) {
        run_threads(b, threads);
    }
    run_threads(b, b->options.threads);
    int failed = b->failed;
    MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    b->failed = failed != 0;
    if (b->options.json != NULL) {
        bench_write_json(b);
    }
    return b->failed ? RG_FAILURE : RG_OK;
}

int main(int argc, char **argv) {
    int provided;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
    bench *b = RG_NEW(bench, 1);
    MPI_Comm_rank(MPI_COMM_WORLD, &b->rank);
    MPI_Comm_size(MPI_COMM_WORLD, &b->ranks);
    int status = RG_OK;
    if (argc == 2 && strcmp(argv[1], "--help") == 0) {
        if (b->rank == 0) {
            fputs(usage, stdout);
        }
    } else if (argc == 2 && strcmp(argv[1], "--cost") == 0) {
        if (b->rank == 0) {
            bench_print_costs();
        }
    } else {
        status = parse(b, argc, argv);
        if (status == RG_OK && b->options.rounds > 0) {
            bench_efficiency(b);
        } else if (status == RG_OK) {
            status = run(b);
        }
    }
    rg_free(b->row);
    rg_free(b);
    MPI_Finalize();
    return status;
}
