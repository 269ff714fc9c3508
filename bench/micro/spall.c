/* The spall test as the bench runs it: a jittered box between two moving ends, fracture test on. */
#include "case/read.h"
#include "micro/spall.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/error.h"
#include "micro/problem.h"
#include "solver/step.h"

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
    "  tile: %d\n"
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

rg_case *bench_spall_case(const int cells[3], int tile, const char *form) {
    char path[] = "/tmp/rhegma-bench-XXXXXX";
    int file = mkstemp(path);
    FILE *out = file < 0 ? NULL : fdopen(file, "w");
    if (out == NULL) {
        rg_fatal(RG_FAILURE, "%s: cannot be written", path);
    }
    fprintf(out, case_text, cells[0], cells[1], cells[2], tile, form);
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

void bench_spall_reset(rg_solver *s, const rg_kernels *set, int percent) {
    s->kernels = set;
    s->time = s->dt = 0;
    s->step = 0;
    set_motion(s);
    break_faces(s, percent);
    rg_solver_impulse(s, s->step_velocity, 0);
}

void bench_spall_steps(void *context, int calls) {
    for (int i = 0; i < calls; i++) {
        rg_solver_step(context, STEP);
    }
}
