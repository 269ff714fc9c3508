/* The whole time step, through the solver that runs a case: unbroken and with a tenth of the faces broken. */
#include <mpi.h>
#include <omp.h>
#include <string.h>

#include "base/mem.h"
#include "case/read.h"
#include "micro/bench.h"
#include "micro/problem.h"
#include "micro/spall.h"
#include "solver/setup.h"
#include "solver/step.h"

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

/* ---- Calls ---- */

static void exchange(void *context, int calls) {
    for (int i = 0; i < calls; i++) {
        rg_solver_exchange(context);
    }
}

/* ---- Rows ---- */

static bench_row *add_row(bench *b, const rg_solver *s, const char *name, int threads) {
    const rg_domain *d = s->domain;
    const rg_cost_variant flags = {.gradient = s->model->gradient, .mass = s->input->mass};
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
    bench_spall_reset(s, &rg_kernels_reference, steps[k].broken);
    bench_row *row = add_row(b, s, steps[k].name, threads);
    bench_spall_steps(s, 1);
    bench_measure_once(bench_spall_steps, s, &row->samples);
    bench_print_row(b, row, stdout);
    for (size_t i = 0; i < count; i++) {
        u[i] = s->u[i];
        velocity[i] = s->velocity[i];
    }
    for (int i = 0; i < n; i++) {
        bench_spall_reset(s, sets[i], steps[k].broken);
        row = add_row(b, s, steps[k].name, threads);
        bench_spall_steps(s, 2);
        validate(b, row, s, u, velocity);
        bench_measure(b, b->options.repeats, bench_spall_steps, s, &row->samples);
        bench_print_row(b, row, stdout);
    }
    rg_free(u);
    rg_free(velocity);
}

static void run_halo(bench *b, rg_solver *s, int threads) {
    if (b->ranks > 1 && bench_wants(b, "halo")) {
        bench_row *row = add_row(b, s, "halo", threads);
        row->cost = (rg_cost){0};
        bench_measure(b, b->options.repeats, exchange, s, &row->samples);
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
            c = bench_spall_case(cells, b->options.tile, steps[k].form);
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
