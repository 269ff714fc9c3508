/* Every kernel of every instruction set: held against the reference on the same input, then timed. */
#include <math.h>
#include <omp.h>
#include <string.h>

#include "base/mem.h"
#include "micro/bench.h"
#include "micro/problem.h"

/* One line of the table of kernels: what to run, and on how many broken faces. */
typedef struct {
    const char *name;
    rg_cost_kernel kernel;
    int broken; /* per cent of the faces */
    rg_cost_variant flags;
    bench_state state; /* of a material with a history */
} kernel_case;

#define CERAMIC   RG_MATERIAL_DESHPANDE_EVANS
#define LINEAR    RG_MATERIAL_LINEAR_ELASTIC
#define KIRCHHOFF RG_MATERIAL_ST_VENANT_KIRCHHOFF
#define CRYSTAL   RG_MATERIAL_ANISOTROPIC
#define OGDEN     RG_MATERIAL_OGDEN
#define RUBBER    RG_MATERIAL_MOONEY_RIVLIN
#define J2        RG_MATERIAL_J2
#define COOK      RG_MATERIAL_JOHNSON_COOK
#define CRUSHED   RG_MATERIAL_JOHNSON_HOLMQUIST
#define CONCRETE  RG_MATERIAL_HOLMQUIST_JOHNSON_COOK
#define ROCK      RG_MATERIAL_DRUCKER_PRAGER
#define RELAXING  RG_MATERIAL_VISCOELASTIC

static const kernel_case cases[] = {
    {"bulk lifted", RG_COST_BULK, 0, {.gradient = RG_GRADIENT_LIFTED}, BENCH_ROUGH},
    {"bulk lifted, 10 % broken", RG_COST_BULK, 10, {.gradient = RG_GRADIENT_LIFTED}, BENCH_ROUGH},
    {"bulk not lifted", RG_COST_BULK, 0, {.gradient = RG_GRADIENT_OWN}, BENCH_ROUGH},
    {"linear elastic", RG_COST_BULK, 0, {.gradient = RG_GRADIENT_LIFTED, .model = LINEAR}, BENCH_ROUGH},
    {"St. Venant-Kirchhoff",
     RG_COST_BULK,
     0,
     {.gradient = RG_GRADIENT_LIFTED, .model = KIRCHHOFF},
     BENCH_ROUGH},
    {"anisotropic", RG_COST_BULK, 0, {.gradient = RG_GRADIENT_LIFTED, .model = CRYSTAL}, BENCH_ROUGH},
    {"Mooney-Rivlin", RG_COST_BULK, 0, {.gradient = RG_GRADIENT_LIFTED, .model = RUBBER}, BENCH_ROUGH},
    {"Ogden", RG_COST_BULK, 0, {.gradient = RG_GRADIENT_LIFTED, .model = OGDEN}, BENCH_ROUGH},
    {"J2 elastic",
     RG_COST_BULK,
     0,
     {.gradient = RG_GRADIENT_LIFTED, .model = J2, .advance = true},
     BENCH_QUIET},
    {"J2 flowing",
     RG_COST_BULK,
     0,
     {.gradient = RG_GRADIENT_LIFTED, .model = J2, .advance = true, .flowing = 1, .newton = 3},
     BENCH_FLOWING},
    {"Johnson-Cook elastic",
     RG_COST_BULK,
     0,
     {.gradient = RG_GRADIENT_LIFTED, .model = COOK, .advance = true},
     BENCH_QUIET},
    {"Johnson-Cook flowing",
     RG_COST_BULK,
     0,
     {.gradient = RG_GRADIENT_LIFTED, .model = COOK, .advance = true, .flowing = 1, .newton = 5},
     BENCH_FLOWING},
    {"Johnson-Holmquist elastic",
     RG_COST_BULK,
     0,
     {.gradient = RG_GRADIENT_LIFTED, .model = CRUSHED, .advance = true},
     BENCH_QUIET},
    {"Johnson-Holmquist flowing",
     RG_COST_BULK,
     0,
     {.gradient = RG_GRADIENT_LIFTED, .model = CRUSHED, .advance = true, .flowing = 1},
     BENCH_FLOWING},
    {"Holmquist-Johnson-Cook elastic",
     RG_COST_BULK,
     0,
     {.gradient = RG_GRADIENT_LIFTED, .model = CONCRETE, .advance = true},
     BENCH_QUIET},
    {"Holmquist-Johnson-Cook flowing",
     RG_COST_BULK,
     0,
     {.gradient = RG_GRADIENT_LIFTED, .model = CONCRETE, .advance = true, .flowing = 1},
     BENCH_FLOWING},
    {"Drucker-Prager elastic",
     RG_COST_BULK,
     0,
     {.gradient = RG_GRADIENT_LIFTED, .model = ROCK, .advance = true},
     BENCH_QUIET},
    {"Drucker-Prager flowing",
     RG_COST_BULK,
     0,
     {.gradient = RG_GRADIENT_LIFTED, .model = ROCK, .advance = true, .flowing = 1},
     BENCH_FLOWING},
    {"viscoelastic",
     RG_COST_BULK,
     0,
     {.gradient = RG_GRADIENT_LIFTED, .model = RELAXING, .advance = true},
     BENCH_QUIET},
    {"ceramic quiet",
     RG_COST_BULK,
     0,
     {.gradient = RG_GRADIENT_LIFTED, .model = CERAMIC, .advance = true},
     BENCH_QUIET},
    {"ceramic cracking",
     RG_COST_BULK,
     0,
     {.gradient = RG_GRADIENT_LIFTED, .model = CERAMIC, .advance = true, .growing = 1, .panels = 1},
     BENCH_CRACKING},
    {"ceramic flowing",
     RG_COST_BULK,
     0,
     {.gradient = RG_GRADIENT_LIFTED, .model = CERAMIC, .advance = true, .flowing = 1, .newton = 1},
     BENCH_FLOWING},
    {"ceramic flowing, cracking",
     RG_COST_BULK,
     0,
     {.gradient = RG_GRADIENT_LIFTED,
      .model = CERAMIC,
      .advance = true,
      .growing = 1,
      .panels = 1,
      .flowing = 1,
      .newton = 1},
     BENCH_CRUSHED},
    {"interface intact", RG_COST_INTERFACE, 0, {.gradient = RG_GRADIENT_LIFTED}, BENCH_ROUGH},
    {"interface 10 % broken", RG_COST_INTERFACE, 10, {.gradient = RG_GRADIENT_LIFTED}, BENCH_ROUGH},
    {"interface all broken", RG_COST_INTERFACE, 100, {.gradient = RG_GRADIENT_LIFTED}, BENCH_ROUGH},
    {"kick consistent", RG_COST_KICK, 0, {.mass = RG_MASS_CONSISTENT}, BENCH_ROUGH},
    {"kick lumped", RG_COST_KICK, 0, {.mass = RG_MASS_LUMPED}, BENCH_ROUGH},
    {"drift", RG_COST_DRIFT, 0, {.mass = RG_MASS_CONSISTENT}, BENCH_ROUGH},
    {"bulk state", RG_COST_BULK_STATE, 0, {.gradient = RG_GRADIENT_LIFTED, .cauchy = true}, BENCH_ROUGH},
    {"kinetic", RG_COST_KINETIC, 0, {.mass = RG_MASS_CONSISTENT}, BENCH_ROUGH},
    {"interface state", RG_COST_INTERFACE_STATE, 0, {.gradient = RG_GRADIENT_LIFTED}, BENCH_ROUGH},
    {"interface state, all broken",
     RG_COST_INTERFACE_STATE,
     100,
     {.gradient = RG_GRADIENT_LIFTED},
     BENCH_ROUGH},
};
enum { CASES = sizeof cases / sizeof *cases };

const char *bench_kernel_name(int k) {
    return k < CASES ? cases[k].name : NULL;
}

static bool by_interface(const kernel_case *c) {
    return c->kernel == RG_COST_INTERFACE || c->kernel == RG_COST_INTERFACE_STATE;
}

/* ---- Calls ---- */

typedef struct {
    const kernel_case *what;
    const rg_kernels *set;
    bench_problem *problem;
} job;

static rg_bulk_args bulk_args(const job *j) {
    bench_problem *p = j->problem;
    return (rg_bulk_args){.material = p->material[j->what->flags.model],
                          .gradient = j->what->flags.gradient,
                          .u = p->u,
                          .geom = p->domain->geom,
                          .neighbour = p->domain->neighbour,
                          .interface = p->domain->interface,
                          .cracked = p->cracked,
                          .unlinked = p->unlinked,
                          .history = p->history,
                          .history_stride = rg_history_block(rg_material_history(j->what->flags.model)),
                          .advance = true,
                          .force = p->force,
                          .traction = p->traction,
                          .stiffening = p->stiffening};
}

static rg_interface_args interface_args(const job *j) {
    bench_problem *p = j->problem;
    return (rg_interface_args){.law = p->law,
                               .u = p->u,
                               .traction = p->itraction,
                               .first_tile_face = p->domain->iblocks,
                               .side = {p->domain->side[0], p->domain->side[1]},
                               .geom = p->domain->igeom,
                               .broken = p->broken,
                               .unlinked = p->unlinked,
                               .active = p->active,
                               .crack = p->crack,
                               .crack_stride = RG_CRACK_BLOCK,
                               .force = p->iforce};
}

/* Repeated as often as one likes: nothing depends on the motion, and it grows slowly. */
static rg_kick_args kick_args(const job *j) {
    bench_problem *p = j->problem;
    return (rg_kick_args){.density = p->density,
                          .mass = j->what->flags.mass,
                          .dt = 1e-9,
                          .geom = p->domain->geom,
                          .force = p->pull,
                          .iforce = p->ipull,
                          .interface = p->domain->interface,
                          .velocity = p->velocity};
}

static void run_states(const job *j, size_t begin, size_t end) {
    bench_problem *p = j->problem;
    rg_bulk_args bulk = bulk_args(j);
    rg_interface_args interface = interface_args(j);
    if (j->what->kernel == RG_COST_BULK_STATE) {
        rg_bulk_state_args a = {.bulk = &bulk,
                                .energy = p->energy + begin * RG_LANES,
                                .cauchy = p->cauchy + begin * RG_GAUSS * 6 * RG_LANES};
        j->set->bulk_state(&a, begin, end);
    } else if (j->what->kernel == RG_COST_INTERFACE_STATE) {
        rg_interface_state_args a = {&interface, p->ienergy + begin * RG_E_INTERFACE * RG_LANES};
        j->set->interface_state(&a, begin, end);
    } else {
        rg_kinetic_args a = {p->density, j->what->flags.mass, p->domain->geom, p->velocity,
                             p->kinetic + begin * RG_LANES};
        j->set->kinetic(&a, begin, end);
    }
}

static void run_blocks(const job *j, size_t begin, size_t end) {
    rg_bulk_args bulk = bulk_args(j);
    rg_interface_args interface = interface_args(j);
    rg_kick_args kick = kick_args(j);
    rg_drift_args drift = {1e-9, j->problem->velocity, j->problem->u};
    switch (j->what->kernel) {
    case RG_COST_BULK:
        bench_problem_restore(j->problem, j->what->flags.model, j->what->state, begin, end);
        j->set->bulk(&bulk, begin, end);
        break;
    case RG_COST_INTERFACE:
        j->set->interface(&interface, begin, end);
        break;
    case RG_COST_KICK:
        j->set->kick(&kick, begin, end);
        break;
    case RG_COST_DRIFT:
        j->set->drift(&drift, begin, end);
        break;
    default:
        run_states(j, begin, end);
        break;
    }
}

static void call(void *context, int calls) {
    const job *j = context;
    const rg_domain *d = j->problem->domain;
#pragma omp parallel
    {
        size_t begin, end;
        bench_share(by_interface(j->what) ? d->iblocks : d->blocks, &begin, &end);
        for (int i = 0; i < calls; i++) {
            run_blocks(j, begin, end);
#pragma omp barrier
        }
    }
}

/* ---- Validation ---- */

enum { MOST_FIELDS = 4 };

/* What the kernel writes; returns the number of fields. */
static int outputs(const job *j, bench_field field[MOST_FIELDS]) {
    const bench_problem *p = j->problem;
    size_t blocks = p->domain->blocks, faces = p->domain->iblocks;
    int n = 0;
    switch (j->what->kernel) {
    case RG_COST_BULK:
        field[n++] = (bench_field){
            .name = "force", .got = p->force, .size = sizeof *p->force, .count = blocks * RG_NODE_BLOCK};
        field[n++] = (bench_field){.name = "traction",
                                   .got = p->traction,
                                   .size = sizeof *p->traction,
                                   .count = blocks * RG_TRACTION_BLOCK};
        field[n++] = (bench_field){.name = "stiffening",
                                   .got = p->stiffening,
                                   .size = sizeof *p->stiffening,
                                   .count = blocks * RG_LANES};
        break;
    case RG_COST_INTERFACE:
        field[n++] = (bench_field){
            .name = "force", .got = p->iforce, .size = sizeof *p->iforce, .count = faces * RG_IFORCE_BLOCK};
        field[n++] = (bench_field){
            .name = "crack", .got = p->crack, .size = sizeof *p->crack, .count = faces * RG_CRACK_BLOCK};
        break;
    case RG_COST_KICK:
        field[n++] = (bench_field){.name = "velocity",
                                   .got = p->velocity,
                                   .size = sizeof *p->velocity,
                                   .count = blocks * RG_NODE_BLOCK};
        break;
    case RG_COST_DRIFT:
        field[n++] =
            (bench_field){.name = "u", .got = p->u, .size = sizeof *p->u, .count = blocks * RG_NODE_BLOCK};
        break;
    case RG_COST_BULK_STATE:
        field[n++] = (bench_field){
            .name = "energy", .got = p->energy, .size = sizeof *p->energy, .count = blocks * RG_LANES};
        field[n++] = (bench_field){.name = "cauchy",
                                   .got = p->cauchy,
                                   .size = sizeof *p->cauchy,
                                   .count = blocks * RG_GAUSS * 6 * RG_LANES};
        break;
    case RG_COST_KINETIC:
        field[n++] = (bench_field){
            .name = "kinetic", .got = p->kinetic, .size = sizeof *p->kinetic, .count = blocks * RG_LANES};
        break;
    default:
        field[n++] = (bench_field){.name = "energy",
                                   .got = p->ienergy,
                                   .size = sizeof *p->ienergy,
                                   .count = faces * RG_E_INTERFACE * RG_LANES};
        break;
    }
    return n;
}

/* What the reference made of the same input. */
typedef struct {
    int fields;
    bench_field field[MOST_FIELDS];
    double *copy[MOST_FIELDS];
    uint8_t *broken, *unlinked;
} expectation;

static expectation expect(const job *j) {
    const bench_problem *p = j->problem;
    size_t faces = p->domain->iblocks * RG_LANES;
    expectation e = {.broken = RG_NEW(uint8_t, faces), .unlinked = RG_NEW(uint8_t, faces)};
    e.fields = outputs(j, e.field);
    for (int k = 0; k < e.fields; k++) {
        e.copy[k] = RG_NEW(double, e.field[k].count);
        for (size_t i = 0; i < e.field[k].count; i++) {
            e.copy[k][i] = bench_value(e.field[k].got, e.field[k].size, i);
        }
        e.field[k].expected = e.copy[k];
    }
    memcpy(e.broken, p->broken, faces);
    memcpy(e.unlinked, p->unlinked, faces);
    return e;
}

static void forget(expectation *e) {
    for (int k = 0; k < e->fields; k++) {
        rg_free(e->copy[k]);
    }
    rg_free(e->broken);
    rg_free(e->unlinked);
}

static void compare_masks(bench *b, const bench_row *row, const char *name, const uint8_t *got,
                          const uint8_t *expected, size_t count) {
    for (size_t i = 0; i < count; i++) {
        if (got[i] != expected[i]) {
            double values[2] = {got[i], expected[i]};
            bench_compare(b, row, &(bench_field){name, &values[0], &values[1], 1, sizeof values[0]});
            return;
        }
    }
}

static void validate(bench *b, const bench_row *row, job *j, const expectation *e) {
    const bench_problem *p = j->problem;
    size_t faces = p->domain->iblocks * RG_LANES;
    bench_problem_reset(j->problem, j->what->broken, j->what->state);
    call(j, 1);
    for (int k = 0; k < e->fields; k++) {
        bench_compare(b, row, &e->field[k]);
    }
    compare_masks(b, row, "broken points", p->broken, e->broken, faces);
    compare_masks(b, row, "unlinked points", p->unlinked, e->unlinked, faces);
}

/* ---- Rows ---- */

static bench_row *add_row(bench *b, const job *j, bench_size size, int threads) {
    const rg_domain *d = j->problem->domain;
    bool faces = by_interface(j->what);
    double ranks = b->ranks, blocks = ranks * (double)(faces ? d->iblocks : d->blocks);
    rg_cost_variant v = bench_mesh_state(d, j->problem->active, j->problem->unlinked, j->what->flags, faces);
    bench_row *row = bench_add_row(b, j->what->name, j->set->name, size, threads);
    row->tets = ranks * (faces ? 0.5 * (double)d->interfaces : (double)d->elements);
    row->cost = rg_cost_block(j->what->kernel, &v);
    row->cost.flops *= blocks;
    row->cost.minimal *= blocks;
    row->cost.actual *= blocks;
    return row;
}

/* The reference is slow: beyond the cache its one run for validation is all that is timed. */
static void run_case(bench *b, const kernel_case *c, bench_problem *p, bench_size size, int threads) {
    const rg_kernels *sets[BENCH_SETS];
    int count = rg_kernels_available(sets, BENCH_SETS), repeats = b->options.repeats;
    job reference = {c, &rg_kernels_reference, p};
    bench_problem_reset(p, c->broken, c->state);
    bench_row *row = add_row(b, &reference, size, threads);
    bench_measure_once(call, &reference, &row->samples);
    expectation e = expect(&reference);
    if (size == BENCH_CACHE) {
        bench_measure(b, repeats, call, &reference, &row->samples);
    }
    bench_print_row(b, row, stdout);
    for (int s = 0; s < count; s++) {
        job j = {c, sets[s], p};
        row = add_row(b, &j, size, threads);
        validate(b, row, &j, &e);
        bench_measure(b, repeats, call, &j, &row->samples);
        bench_print_row(b, row, stdout);
    }
    forget(&e);
}

void bench_kernels(bench *b, bench_size size, int threads) {
    bench_problem *p = NULL;
    for (int k = 0; k < CASES; k++) {
        if (rg_material_exists(cases[k].flags.model) && bench_wants(b, cases[k].name)) {
            p = p == NULL ? bench_problem_make(size, b->options.quick) : p;
            run_case(b, &cases[k], p, size, threads);
        }
    }
    if (p != NULL) {
        bench_problem_free(p);
    }
}

/* ---- Costs ---- */

static void print_cost(const char *name, const rg_cost *c) {
    printf("| %s | %.0f | %.0f | %.0f |\n", name, c->flops / RG_LANES, c->minimal / RG_LANES,
           c->actual / RG_LANES);
}

/* Of the mesh that perf/README.md speaks of: large, without padding, and all faces whole or all broken. */
static rg_cost_variant large_mesh(rg_cost_variant flags, bool broken) {
    flags.damaged = broken ? 1 : 0;
    flags.points = broken ? RG_POINTS : 0;
    flags.interfaces = 2;
    flags.fill = 1;
    return flags;
}

void bench_print_costs(void) {
    printf(
        "| per element or interface | flops | bytes, minimal | bytes, actual |\n| --- | --- | --- | --- |\n");
    for (int k = 0; k < CASES; k++) {
        const kernel_case *c = &cases[k];
        bool some = c->broken > 0 && c->broken < 100; /* depends on the mesh */
        if (rg_material_exists(c->flags.model) && !some) {
            rg_cost_variant v = large_mesh(c->flags, c->broken > 0);
            rg_cost cost = rg_cost_block(c->kernel, &v);
            print_cost(c->name, &cost);
        }
    }
    for (int lifted = 1; lifted >= 0; lifted--) {
        rg_gradient gradient = lifted ? RG_GRADIENT_LIFTED : RG_GRADIENT_OWN;
        rg_cost_variant v = large_mesh((rg_cost_variant){.gradient = gradient}, false);
        v.interfaces = 2.46; /* tile-boundary faces belong to both their tiles */
        v.tile_faces = 0.93;
        rg_cost cost = rg_cost_step(&v);
        print_cost(lifted ? "step variational" : "step incomplete", &cost);
    }
}
