/* The communication of the time step on a simulated cluster: the exchanges of src/domain/halo.c and the
 * reduction, in the order of rg_solver_step, with the sweeps as times given. For SimGrid's SMPI (smpicc,
 * smpirun); see perf/simulate, which builds and runs it. Real rows travel; only time is simulated. A
 * simulated network needs no polls to move the rows. The reduction goes by dissemination, in ceil(log2 ranks)
 * rounds that start one another as the polls find them done, as the schedule of Open MPI's MPI_Iallreduce
 * does; SMPI's own sends from all to all. */
#include <math.h>
#include <mpi.h>
#include <smpi/smpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/mem.h"
#include "domain/halo.h"

static const char usage[] =
    "usage: smpirun ... simulated_step PATTERN STEPS FIRST SECOND PACK REST THREADS\n"
    "PATTERN: from rhegma-pattern; seconds: FIRST and SECOND sweep per tet, PACK per face and exchange, "
    "REST\n"
    "per step; THREADS of each rank, which share the tiles of a sweep and the faces\n";

enum { REDUCTION_TAG = 3, POLLS = 24, WARM = 2 };

#define HOST_SPEED 1e9 /* flops per second of the hosts in the platform file: a unit, no more */

typedef struct {
    double first, second, pack, rest; /* s */
} costs;

/* A largest value of all ranks on its way. */
typedef struct {
    int rank, ranks, hop; /* distance of the current round */
    double here, there;
    MPI_Request request[2];
} reduction;

typedef struct {
    rg_domain domain; /* only what the halo looks at */
    double inner, outer;
    rg_halo *traces, *tractions;
    reduction reduce;
} rank_part;

static void work(double seconds) {
    smpi_execute_flops(seconds * HOST_SPEED);
}

/* ---- Set-up ---- */

/* The line of this rank: "tets inner neighbours", then "rank faces" of each. */
static void read_part(const char *path, int rank, int ranks, rank_part *p) {
    FILE *in = fopen(path, "r");
    long long tets, inner, faces;
    int count = 0, other, wanted = 0;
    if (in == NULL || fscanf(in, "%lld %d", &tets, &wanted) != 2 || wanted != ranks) {
        rg_fatal(RG_USAGE, "%s: not a pattern for %d ranks", path, ranks);
    }
    for (int r = 0; r <= rank; r++) {
        int c;
        while ((c = fgetc(in)) != '\n' && c != EOF) {
        }
    }
    if (fscanf(in, "%lld %lld %d", &tets, &inner, &count) != 3) {
        rg_fatal(RG_USAGE, "%s: no line for rank %d", path, rank);
    }
    p->inner = (double)inner;
    p->outer = (double)(tets - inner);
    for (int k = 0; k < count && fscanf(in, "%d %lld", &other, &faces) == 2; k++) {
        size_t before = p->domain.shared, all = before + (size_t)faces;
        p->domain.shared_face = rg_realloc(p->domain.shared_face, all, sizeof *p->domain.shared_face);
        for (size_t i = before; i < all; i++) {
            p->domain.shared_face[i] = (rg_shared_face){.rank = other, .tile_face = i};
        }
        p->domain.shared = p->domain.own_rows = all;
    }
    fclose(in);
}

static rg_halo *make_halo(const rank_part *p, int values, int tag) {
    rg_real *rows = RG_NEW(rg_real, (p->domain.own_rows + p->domain.shared) * (size_t)values);
    return rg_halo_make(&p->domain, values, rows, tag, MPI_COMM_WORLD);
}

/* ---- Reduction ---- */

static void start_round(reduction *r) {
    if (r->hop < r->ranks) {
        int to = (r->rank + r->hop) % r->ranks, from = (r->rank - r->hop + r->ranks) % r->ranks;
        MPI_Irecv(&r->there, 1, MPI_DOUBLE, from, REDUCTION_TAG, MPI_COMM_WORLD, &r->request[0]);
        MPI_Isend(&r->here, 1, MPI_DOUBLE, to, REDUCTION_TAG, MPI_COMM_WORLD, &r->request[1]);
    }
}

static void start_reduction(reduction *r) {
    r->hop = 1;
    start_round(r);
}

/* The round is over: on to the next. */
static void next_round(reduction *r) {
    r->here = r->here > r->there ? r->here : r->there;
    r->hop *= 2;
    start_round(r);
}

static void poll_reduction(reduction *r) {
    int done = 0;
    if (r->hop < r->ranks) {
        MPI_Testall(2, r->request, &done, MPI_STATUSES_IGNORE);
    }
    if (done) {
        next_round(r);
    }
}

static void finish_reduction(reduction *r) {
    while (r->hop < r->ranks) {
        MPI_Waitall(2, r->request, MPI_STATUSES_IGNORE);
        next_round(r);
    }
}

/* ---- Step ---- */

/* Tets of the thread that has most of them. */
static double swept(double tets, int threads) {
    return threads == 1 ? tets : RG_TILE * ceil(tets / RG_TILE / threads);
}

static void start(const rank_part *p, rg_halo *h, const costs *c) {
    rg_halo_pack(h);
    work(c->pack * (double)p->domain.shared);
    rg_halo_start(h);
}

/* As `evaluate` in src/solver/step.c. */
static void step(rank_part *p, const costs *c) {
    work(c->first * p->inner);
    rg_halo_finish(p->traces);
    work(c->first * p->outer);
    start(p, p->tractions, c);
    start_reduction(&p->reduce);
    for (int k = 0; k < POLLS && p->inner > 0; k++) {
        work(c->second * p->inner / POLLS);
        poll_reduction(&p->reduce);
    }
    rg_halo_finish(p->tractions);
    work(c->second * p->outer);
    start(p, p->traces, c);
    finish_reduction(&p->reduce);
    work(c->rest);
}

int main(int argc, char **argv) {
    int rank, ranks;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    if (argc != 8) {
        fputs(usage, stderr);
        MPI_Abort(MPI_COMM_WORLD, RG_USAGE);
    }
    costs c = {atof(argv[3]), atof(argv[4]), atof(argv[5]), atof(argv[6])};
    rank_part p = {.reduce = {.rank = rank, .ranks = ranks}};
    int steps = atoi(argv[2]);
    c.pack /= atof(argv[7]);
    read_part(argv[1], rank, ranks, &p);
    p.inner = swept(p.inner, atoi(argv[7]));
    p.outer = swept(p.outer, atoi(argv[7]));
    p.traces = make_halo(&p, RG_TRACE_ROW, 1);
    p.tractions = make_halo(&p, RG_TILE_FACE_ROW, 2);
    start(&p, p.traces, &c);
    for (int s = 0; s < WARM; s++) {
        step(&p, &c);
    }
    double t = MPI_Wtime(), mean;
    for (int s = 0; s < steps; s++) {
        step(&p, &c);
    }
    t = (MPI_Wtime() - t) / steps; /* no barrier: it would count, and ranks keep step by their messages */
    MPI_Reduce(&t, &mean, 1, MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
    double waited = rg_halo_waited(p.traces) + rg_halo_waited(p.tractions), most;
    MPI_Reduce(&waited, &most, 1, MPI_DOUBLE, MPI_MAX, 0, MPI_COMM_WORLD);
    if (rank == 0) {
        printf("%.9g %.9g\n", mean / ranks,
               most / (steps + WARM)); /* seconds a step; the longest wait of a rank */
    }
    rg_halo_finish(p.traces);
    MPI_Finalize();
    return 0;
}
