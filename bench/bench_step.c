/* The whole time step, through the solver that runs a case: spall boundary conditions, fracture test on. */
#include <mpi.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bench.h"
#include "bench_problem.h"
#include "error.h"
#include "halo.h"
#include "mem.h"
#include "solver.h"

#define STEP    2e-11  /* s: well below the critical step */
#define ROUGH   1e-9   /* random displacement (m) */
#define SPEED   1.0    /* random velocity (m/s) */
#define OPENING 1.7e-7 /* m: delta_c of the case */

enum { KEY_U = 11, KEY_VELOCITY };

static const char case_text[] =
    "mesh:\n"
    "  cells: [%d, %d, %d]\n"
    "  size: [0.4e-3, 0.4e-3, 4e-3]\n"
    "  origin: [-0.2e-3, -0.2e-3, -2e-3]\n"
    "  jitter: 0.1\n"
    "material: {model: neo-hookean, young: 260e9, poisson: 0.21, density: 3690}\n"
    "interface: {form: %s, beta_s: 4, law: linear, strength: 400e6, energy: 34, beta: 1}\n"
    "boundary:\n"
    "  - {set: z+, component: z, velocity: 6.086}\n"
    "  - {set: z-, component: z, velocity: -6.086}\n"
    "  - {set: x-, component: x, velocity: 0}\n"
    "  - {set: x+, component: x, velocity: 0}\n"
    "  - {set: y-, component: y, velocity: 0}\n"
    "  - {set: y+, component: y, velocity: 0}\n"
    "time: {end: 1e-6}\n"
    "output: {interval: 1e-8}\n";

static const struct {
    const char *name, *form;
    int broken;
} steps[] = {
    {"step variational", "variational", 0},
    {"step variational, 10 % broken", "variational", 10},
    {"step incomplete", "incomplete", 0},
    {"step incomplete, 10 % broken", "incomplete", 10},
};
enum { STEPS = sizeof steps / sizeof *steps };

const char *bench_step_name(int k) {
    return k < STEPS ? steps[k].name : k == STEPS ? "halo" : NULL;
}

static rg_case *make_case(const int cells[3], const char *form) {
    char path[] = "/tmp/rhegma-bench-XXXXXX";
    int file = mkstemp(path);
    FILE *out = file < 0 ? NULL : fdopen(file, "w");
    if (out == NULL) {
        rg_fatal(RG_FAILURE, "%s: cannot be written", path);
    }
    fprintf(out, case_text, cells[0], cells[1], cells[2], form);
    fclose(out);
    rg_case *c = rg_case_read(path, 0, NULL, stderr);
    unlink(path);
    if (c == NULL) {
        rg_fatal(RG_FAILURE, "the case of the whole step is not valid");
    }
    return c;
}

/* ---- State ---- */

/* All points failed and open. */
static void break_face(rg_solver *s, const rg_tile *t, size_t i) {
    const rg_domain *d = s->domain;
    double normal[3], area = rg_interface_area(d, i, normal);
    s->broken[i] = s->unlinked[i] = (1 << RG_POINTS) - 1;
    s->active[i / RG_LANES] = 1;
    for (int q = 0; q < RG_POINTS; q++) {
        s->crack[rg_crack_index(i, q, RG_CRACK_OPENING)] = (rg_real)(10 * OPENING);
        for (int c = 0; c < 3; c++) {
            s->crack[rg_crack_index(i, q, RG_CRACK_ORIGIN + c)] = (rg_real)(-2 * OPENING * normal[c] / area);
        }
    }
    for (int k = 0; k < (i < t->sbegin * RG_LANES ? 2 : 1); k++) {
        s->cracked[t->begin + (size_t)d->side[k][i] / (RG_FACES * RG_LANES)] = 1;
    }
}

static void break_faces(rg_solver *s, int percent) {
    const rg_domain *d = s->domain;
    memset(s->broken, 0, d->iblocks * RG_LANES);
    memset(s->unlinked, 0, d->iblocks * RG_LANES);
    memset(s->active, 0, d->iblocks);
    memset(s->cracked, 0, d->blocks);
    for (size_t t = 0; t < d->tiles; t++) {
        for (size_t i = d->tile[t].ibegin * RG_LANES; i < d->tile[t].iend * RG_LANES; i++) {
            double normal[3];
            bool padding = !(rg_interface_area(d, i, normal) > 0);
            if (!padding && bench_is_broken(d, &d->tile[t], i, percent)) {
                break_face(s, &d->tile[t], i);
            }
        }
    }
}

/* Random small motion, by global number: the same on any ranks. */
static void set_motion(rg_solver *s) {
#pragma omp parallel for schedule(static)
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        rg_gid id = s->domain->id[slot];
        for (int k = 0; id >= 0 && k < 3 * RG_NODES; k++) {
            s->u[rg_node_index(slot, k / 3, k % 3)] = (rg_real)(ROUGH * bench_noise(KEY_U, id, k));
            s->velocity[rg_node_index(slot, k / 3, k % 3)] =
                (rg_real)(SPEED * bench_noise(KEY_VELOCITY, id, k));
        }
    }
}

/* Back to the start, with forces made by the kernels `set`. */
static void reset(rg_solver *s, const rg_kernels *set, int percent) {
    s->kernels = set;
    s->time = s->dt = 0;
    s->step = 0;
    set_motion(s);
    break_faces(s, percent);
    rg_solver_impulse(s, s->now, 0);
}

/* ---- Calls ---- */

static void take_steps(void *context, int calls) {
    for (int i = 0; i < calls; i++) {
        rg_solver_step(context, STEP);
    }
}

static void exchange(rg_halo *h) {
    rg_halo_pack(h);
#pragma omp master
    {
        rg_halo_start(h);
        rg_halo_finish(h);
    }
#pragma omp barrier
}

/* Both messages of a step, with nothing to hide them. */
static void exchange_all(void *context, int calls) {
    rg_solver *s = context;
#pragma omp parallel
    for (int i = 0; i < calls; i++) {
        exchange(s->halo_u[s->current]);
        exchange(s->halo_t);
    }
}

/* ---- Rows ---- */

static bench_row *add_row(bench *b, const rg_solver *s, const char *name, int threads) {
    const rg_domain *d = s->domain;
    const rg_cost_variant flags = {.lift = s->lift, .lumped = s->lumped};
    rg_cost_variant v = bench_mesh_state(d, s->active, s->unlinked, flags, false);
    rg_cost c = rg_cost_step(&v);
    double blocks = (double)d->blocks;
    double sum[4] = {(double)d->elements, blocks * c.flops, blocks * c.minimal, blocks * c.actual};
    MPI_Allreduce(MPI_IN_PLACE, sum, 4, MPI_DOUBLE, MPI_SUM, s->comm);
    bench_row *row = bench_add_row(b, name, s->kernels->name, BENCH_MEMORY, threads);
    row->tets = sum[0];
    row->cost = (rg_cost){.flops = sum[1], .minimal = sum[2], .actual = sum[3]};
    return row;
}

/* Two steps, then the motion must be the reference's: the second step feels the forces of the first. */
static void validate(bench *b, const bench_row *row, rg_solver *s, const double *u, const double *velocity) {
    size_t count = s->domain->blocks * RG_NODE_BLOCK;
    bench_compare(b, row, &(bench_field){"u", s->u, u, count, sizeof *s->u});
    bench_compare(b, row, &(bench_field){"velocity", s->velocity, velocity, count, sizeof *s->velocity});
}

static void run_step(bench *b, rg_solver *s, int k, int threads) {
    const rg_kernels *sets[BENCH_SETS];
    int n = rg_kernels_available(sets, BENCH_SETS);
    size_t count = s->domain->blocks * RG_NODE_BLOCK;
    double *u = RG_NEW(double, count), *velocity = RG_NEW(double, count);
    reset(s, &rg_kernels_reference, steps[k].broken);
    bench_row *row = add_row(b, s, steps[k].name, threads);
    take_steps(s, 1);
    bench_measure_once(take_steps, s, &row->samples);
    bench_print_row(b, row, stdout);
    for (size_t i = 0; i < count; i++) {
        u[i] = s->u[i];
        velocity[i] = s->velocity[i];
    }
    for (int i = 0; i < n; i++) {
        reset(s, sets[i], steps[k].broken);
        row = add_row(b, s, steps[k].name, threads);
        take_steps(s, 2);
        validate(b, row, s, u, velocity);
        bench_measure(b, b->options.repeats, take_steps, s, &row->samples);
        bench_print_row(b, row, stdout);
    }
    rg_free(u);
    rg_free(velocity);
}

static void run_halo(bench *b, rg_solver *s, int threads) {
    if (b->ranks > 1 && bench_wants(b, "halo")) {
        bench_row *row = add_row(b, s, "halo", threads);
        row->cost = (rg_cost){0};
        bench_measure(b, b->options.repeats, exchange_all, s, &row->samples);
        bench_print_row(b, row, stdout);
    }
}

static void run_mesh(bench *b, const int cells[3], int threads) {
    rg_case *c = NULL;
    rg_solver *s = NULL;
    for (int k = 0; k < STEPS; k++) {
        if (!bench_wants(b, steps[k].name) && !(steps[k].broken == 0 && bench_wants(b, "halo"))) {
            continue;
        }
        if (s == NULL || strcmp(steps[k].form, steps[k - 1].form) != 0) {
            rg_solver_free(s);
            rg_case_free(c);
            c = make_case(cells, steps[k].form);
            s = rg_solver_make(c, MPI_COMM_WORLD);
            rg_solver_start(s);
        }
        if (bench_wants(b, steps[k].name)) {
            run_step(b, s, k, threads);
        }
        if (k == 0) {
            run_halo(b, s, threads);
        }
    }
    rg_solver_free(s);
    rg_case_free(c);
}

void bench_steps(bench *b, int threads) {
    static const int full[2][3] = {{6, 6, 60}, {15, 15, 166}}, quick[2][3] = {{3, 3, 30}, {6, 6, 60}};
    for (int m = 0; m < 2; m++) {
        run_mesh(b, b->options.quick ? quick[m] : full[m], threads);
    }
}
