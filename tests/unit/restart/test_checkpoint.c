/* A checkpoint holds all that a step changes, whatever that is. A run writes a checkpoint and goes on;
 * another one starts from it and goes as far. Then every word of memory that the first has changed since it
 * was made, in any block of its solver, must be the same in the second: what a step changes and the registry
 * (solver/state.h) forgets is found without being named here. Prints TAP.
 *
 * Blocks are followed by standing in for rg_alloc and its kin (the linker's --wrap); both solvers ask for the
 * same blocks in the same order. A word that points into a block must point to the same place of the block's
 * twin. */
#include <math.h>
#include <omp.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/hash.h"
#include "base/mem.h"
#include "case/read.h"
#include "domain/assembly.h"
#include "partition/material_map.h"
#include "restart/restart.h"
#include "solver/step_limiter.h"
#include "solver/setup.h"
#include "solver/step.h"
#include "solver/spectrum.h"
#include "solver/stepper.h"
#include "support/step_cases.h"
#include "support/tap.h"

/* Steps. Rows are written into two buffers in turn: an even number, so that both runs are at the same one. */
enum { BEFORE = 10, AFTER = 3, TILE = 40, MOST_BLOCKS = 1 << 14 };

/* ---- Memory ---- */

/* A block of one of the two solvers, with what it held when the solver was made. */
typedef struct {
    char *at, *made;
    size_t bytes;
} block;

typedef struct {
    block list[MOST_BLOCKS];
    size_t count;
} blocks;

static blocks blocks_of[2];
static blocks *recording; /* who gets the blocks asked for now; NULL: nobody */

static void *add(void *at, size_t bytes) {
    if (recording != NULL) {
        if (recording->count == MOST_BLOCKS)
            abort();
        recording->list[recording->count++] = (block){at, NULL, bytes};
    }
    return at;
}

static void drop(const void *at) {
    for (int s = 0; s < 2 && at != NULL; s++)
        for (size_t k = 0; k < blocks_of[s].count; k++)
            if (blocks_of[s].list[k].at == at) {
                free(blocks_of[s].list[k].made);
                memmove(&blocks_of[s].list[k], &blocks_of[s].list[k + 1],
                        (--blocks_of[s].count - k) * sizeof(block));
            }
}

void *__real_rg_alloc(size_t count, size_t size);
void *__real_rg_alloc_sparse(size_t count, size_t size);
void *__real_rg_realloc(void *old, size_t count, size_t size);
void __real_rg_free(void *old);
void *__wrap_rg_alloc(size_t count, size_t size);
void *__wrap_rg_alloc_sparse(size_t count, size_t size);
void *__wrap_rg_realloc(void *old, size_t count, size_t size);
void __wrap_rg_free(void *old);

void *__wrap_rg_alloc(size_t count, size_t size) {
    return add(__real_rg_alloc(count, size), count * size);
}

void *__wrap_rg_alloc_sparse(size_t count, size_t size) {
    return add(__real_rg_alloc_sparse(count, size), count * size);
}

void *__wrap_rg_realloc(void *old, size_t count, size_t size) {
    drop(old);
    return add(__real_rg_realloc(old, count, size), count * size);
}

void __wrap_rg_free(void *old) {
    drop(old);
    __real_rg_free(old);
}

static void keep_made(blocks *of) {
    for (size_t k = 0; k < of->count; k++) {
        of->list[k].made = malloc(of->list[k].bytes + 1);
        memcpy(of->list[k].made, of->list[k].at, of->list[k].bytes);
    }
}

/* Whether two words are addresses of the same place in a block and in its twin. */
static bool same_place(uint64_t a, uint64_t b) {
    for (size_t k = 0; k < blocks_of[0].count; k++) {
        uint64_t begin = (uintptr_t)blocks_of[0].list[k].at, twin = (uintptr_t)blocks_of[1].list[k].at;
        if (a >= begin && a < begin + blocks_of[0].list[k].bytes)
            return b - twin == a - begin;
    }
    return false;
}

/* Whether an address is in the crack state of padding. */
static bool is_padding(const rg_solver *s, const char *at) {
    const char *crack = (const char *)s->crack;
    double normal[3];
    if (at < crack || at >= crack + s->domain->iblocks * s->model->crack_stride * sizeof *s->crack)
        return false;
    size_t value = (size_t)(at - crack) / sizeof *s->crack;
    size_t i = value / s->model->crack_stride * RG_LANES + value % RG_LANES;
    return rg_interface_area(s->domain, i, normal) <= 0;
}

/* What may differ: seconds that were measured, those of halos known by their value; the name of what limits
 * the step, which is a word of the program or a copy of it; and padding, where there may be a -0. */
static bool may_differ(const rg_solver *s, const char *at, uint64_t word) {
    const char *begin[] = {(const char *)&s->phases, (const char *)&s->limiting_state};
    const size_t bytes[] = {sizeof s->phases, sizeof s->limiting_state};
    const rg_halo *halo[] = {s->stepper->halo_u[0], s->stepper->halo_u[1], s->stepper->halo_t,
                             s->assembly != NULL ? rg_assembly_halo(s->assembly) : s->stepper->halo_t};
    bool may = is_padding(s, at);
    for (int k = 0; k < 2; k++)
        may = may || (at >= begin[k] && at < begin[k] + bytes[k]);
    for (int k = 0; k < 4; k++) {
        double waited = rg_halo_waited(halo[k]);
        may = may || memcmp(&waited, &word, sizeof word) == 0;
    }
    return may;
}

/* Words of block k that the first solver has changed and that are others in the second one. */
static size_t differences(const rg_solver *s, size_t k, size_t *changed) {
    const block *a = &blocks_of[0].list[k], *b = &blocks_of[1].list[k];
    size_t wrong = 0;
    for (size_t at = 0; at < a->bytes; at += 8) {
        uint64_t now = 0, made = 0, other = 0;
        size_t bytes = a->bytes - at < 8 ? a->bytes - at : 8;
        memcpy(&now, a->at + at, bytes);
        memcpy(&made, a->made + at, bytes);
        memcpy(&other, b->at + at, bytes);
        if (now == made || may_differ(s, a->at + at, now))
            continue;
        ++*changed;
        if (now != other && !same_place(now, other) && wrong++ == 0)
            printf("# block %zu of %zu bytes differs from byte %zu on: %016llx, %016llx\n", k, a->bytes, at,
                   (unsigned long long)now, (unsigned long long)other);
    }
    return wrong;
}

/* ---- Two runs ---- */

void __wrap_rg_warn(const char *format, ...);
void __wrap_rg_warn(const char *format, ...) { /* of what is suddenly placed */
    (void)format;
}

typedef struct {
    rg_solver *solver;
    rg_ledger ledger;
    rg_restart keep;
    rg_summary summary;
    rg_state state;
    rg_slab *slab;
    rg_checkpoints checkpoints;
} half;

static void open_half(half *h, const rg_case *c, const char *folder, bool first) {
    recording = &blocks_of[first ? 0 : 1];
    recording->count = 0;
    rg_mesh *mesh = make_mesh(c);
    rg_part *part = rg_part_distribute(mesh, TILE, MPI_COMM_WORLD);
    rg_materials_assign(c, part, MPI_COMM_WORLD);
    h->solver = rg_solver_make_from_part(c, part, MPI_COMM_WORLD);
    rg_mesh_free(mesh);
    recording = NULL;
    rg_restart_register(&h->state, &h->keep, h->solver, &h->ledger, &h->summary);
    rg_checkpoints_open(&h->checkpoints, folder, h->solver, &h->state, &h->slab);
}

static void close_half(half *h) {
    rg_checkpoints_close(&h->checkpoints);
    rg_slab_free(h->slab);
    rg_solver_free(h->solver);
}

/* Motion by which faces break, part and close, the same of all copies of a shared node. */
static void disturb(rg_solver *s) {
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++)
        for (int k = 0; k < 3 * RG_NODES && s->domain->id[slot] >= 0; k++) {
            uint64_t h = rg_hash(rg_hash(5, (uint64_t)s->domain->id[slot]), (uint64_t)k);
            double z = s->domain->corner[12 * slot + 2] / 6e-4, strength = pow(0.5 + 0.5 * z, 2);
            s->velocity[rg_node_index(slot, k / 3, k % 3)] =
                (rg_real)(300 * strength * (2 * rg_hash_uniform(h) - 1));
        }
    if (s->assembly != NULL)
        rg_assembly_mean(s->assembly, s->velocity);
    rg_constraints_start(s->constraints, s->u, s->velocity, s->comm);
    rg_solver_resume(s);
}

/* As in a run, it follows the stiffening and the opening rate of the state before. */
static double next_step(const rg_solver *s) {
    return rg_limited_step(s, 4e-10 * (1 + 0.3 * sin((double)s->step)) / sqrt(s->stiffening_anywhere));
}

static void go_on(half *h, int steps) {
    for (int k = 0; k < steps; k++) {
        rg_solver_kick(h->solver, next_step(h->solver));
        rg_ledger_take(&h->ledger, h->solver);
        rg_solver_drift(h->solver);
    }
}

/* As a run does it: between two steps. */
static void leave(half *h) {
    h->keep.core_seconds = h->solver->pass_seconds * h->solver->ranks * h->solver->threads;
    snprintf(h->keep.limiting_state, sizeof h->keep.limiting_state, "%s", h->solver->limiting_state);
    rg_checkpoint_write(&h->checkpoints, 1);
}

static void check(const variant *v, const char *folder) {
    half a = {.slab = NULL}, b = {.slab = NULL};
    rg_case *c = read_case(v);
    open_half(&a, c, folder, true);
    keep_made(&blocks_of[0]);
    rg_spectrum_whole(a.solver);
    rg_solver_start(a.solver);
    disturb(a.solver);
    go_on(&a, BEFORE);
    leave(&a);
    open_half(&b, c, folder, false);
    rg_checkpoint_load(&b.checkpoints);
    rg_restart_spectrum(&b.keep, b.solver);
    rg_solver_resume(b.solver);
    go_on(&a, AFTER);
    go_on(&b, AFTER);
    rg_solver_kick(a.solver, 1e-10);
    rg_solver_kick(b.solver, 1e-10);
    size_t wrong = 0, changed = 0, count = blocks_of[0].count;
    bool same = count == blocks_of[1].count;
    for (size_t k = 0; same && k < count; k++)
        same = blocks_of[0].list[k].bytes == blocks_of[1].list[k].bytes;
    report(same, v->name, "the same blocks of memory");
    for (size_t k = 0; same && k < count; k++)
        wrong += differences(a.solver, k, &changed);
    report(wrong == 0, v->name, "what the steps have changed");
    report(changed > 20000 && memcmp(&a.ledger, &b.ledger, sizeof a.ledger) == 0 && a.ledger.last.step > 0 &&
               strcmp(a.solver->limiting_state, b.solver->limiting_state) == 0,
           v->name, "ledger, what limits the step");
    printf("# %zu words in %zu blocks have changed; %.3g m^2 broken\n", changed, count,
           a.ledger.last.broken_area);
    close_half(&a);
    close_half(&b);
    rg_case_free(c);
}

int main(int argc, char **argv) {
    char folder[] = "/tmp/test_checkpoint.XXXXXX", inner[64];
    MPI_Init(&argc, &argv);
    omp_set_num_threads(1); /* workspaces of several are allocated in any order */
    if (mkdtemp(folder) == NULL)
        return 1;
    for (size_t k = 0; k < VARIANTS; k++)
        if (argc < 2 || strcmp(argv[1], variants[k].name) == 0)
            check(&variants[k], folder);
    rg_checkpoints_remove(folder, true);
    snprintf(inner, sizeof inner, "%s/checkpoints", folder);
    rmdir(inner);
    rmdir(folder);
    return finish();
}
