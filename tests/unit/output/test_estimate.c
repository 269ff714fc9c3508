/* What is known of a run before it starts: counts, steps and memory against the mesh, on any number of ranks;
 * and its words. Prints TAP from rank 0. */
#include "output/estimate.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/mem.h"
#include "output/snapshot.h"
#define FATAL_ONLY RG_USAGE
#include "support/fatal.h"
#include "support/random_state.h"
#include "support/tap.h"

enum { SEED = 29 };

/* ---- the end of a run, warnings ---- */

static int warnings;
static char warned[400];

void rg_warn(const char *format, ...) {
    va_list args;
    va_start(args, format);
    vsnprintf(warned, sizeof warned, format, args);
    va_end(args);
    warnings++;
}

static bool near(double found, double wanted) {
    bool good = fabs(found - wanted) <= 1e-13 * fabs(wanted);
    if (!good) {
        printf("# %.17g, not %.17g\n", found, wanted);
    }
    return good;
}

/* ---- counts ---- */

static bool edge_is_new(const rg_mesh *m, rg_gid e, rg_gid a, rg_gid b) {
    for (rg_gid k = 0; k < e; k++) {
        bool has_a = false, has_b = false;
        for (int i = 0; i < 4; i++) {
            has_a = has_a || m->corner[4 * k + i] == a;
            has_b = has_b || m->corner[4 * k + i] == b;
        }
        if (has_a && has_b) {
            return false;
        }
    }
    return true;
}

static int64_t shared_nodes(const rg_mesh *m) {
    int64_t n = m->vertices;
    for (rg_gid e = 0; e < m->elements; e++) {
        for (int a = 0; a < 4; a++) {
            for (int b = 0; b < a; b++) {
                n += edge_is_new(m, e, m->corner[4 * e + b], m->corner[4 * e + a]);
            }
        }
    }
    return n;
}

/* Of all faces between elements the least of zone over longest edge, with the softer side's modulus, for 34
 * J/m2 at 400 MPa; of those alone that `where` likes. */
static void find_worst(const random_state *r, bool (*where)(const double middle[3]), double *zone,
                       double *edge) {
    const double modulus[2] = {70e9 / (1 - 0.21 * 0.21), 210e9 / (1 - 0.3 * 0.3)}; /* glass, steel */
    const rg_mesh *m = r->mesh;
    double least = INFINITY;
    for (rg_gid k = 0; k < 4 * m->elements; k++) {
        double x[4][3], longest = 0, middle[3] = {0};
        mesh_corners(m, k / 4, x);
        for (int a = 0; a < 3; a++) {
            const double *p = x[rg_face_node[k % 4][a]], *q = x[rg_face_node[k % 4][(a + 1) % 3]];
            longest = fmax(longest, sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) +
                                         (p[2] - q[2]) * (p[2] - q[2])));
            for (int c = 0; c < 3; c++) {
                middle[c] += p[c] / 3;
            }
        }
        if (m->neighbour[k] < 0 || (where != NULL && !where(middle))) {
            continue;
        }
        double e = fmin(modulus[mesh_material(r, k / 4)], modulus[mesh_material(r, m->neighbour[k])]);
        double length = 9 * 3.14159265358979324 / 32 * e * 34 / 1.6e17;
        if (length / longest < least) {
            least = length / longest;
            *zone = length;
            *edge = longest;
        }
    }
}

static bool is_low(const double middle[3]) {
    return middle[2] < 2.5e-3;
}

/* Faces that never break, or are open, ask for no resolution; stronger ones for more. */
static void check_zones(void) {
    static const char *const sets[] = {
        "interface.sets=[{where: 'z > 2.5e-3', law: none}]",
        "interface.sets=[{where: 'z > 2.5e-3', open: true}]",
        "interface.sets=[{where: 1, strength: 8e8, energy: 136}, {where: z > 2.5e-3, strength: 1e8}]"};
    for (size_t k = 0; k < sizeof sets / sizeof *sets; k++) {
        random_state r = random_state_make(1, &sets[k], MPI_COMM_WORLD);
        double zone = 0, edge = 0;
        r.solver->omega2 = 4e16;
        rg_estimate e = rg_estimate_run(r.solver);
        find_worst(&r, is_low, &zone, &edge);
        report(near(e.cohesive_zone, zone) && near(e.zone_edge, edge), "estimate",
               "zone of the faces that break");
        random_state_free(&r);
    }
}

static void check_counts(void) {
    random_state r = random_state_make(0, NULL, MPI_COMM_WORLD);
    rg_solver *s = r.solver;
    s->omega2 = 2.5e17;
    s->damping = 0.7;
    s->pass_seconds = 0.02;
    double sum[2] = {(double)rg_alloc_total(),
                     (double)s->domain->iblocks * (double)s->model->crack_stride * sizeof(rg_real)};
    double output = (double)rg_snapshots_bytes(s->input, s->domain->elements);
    rg_estimate e = rg_estimate_run(s);
    int64_t steel = 0, faces = 0;
    for (rg_gid id = 0; id < 144; id++) {
        steel += mesh_material(&r, id);
        for (int f = 0; f < 4; f++) {
            faces += r.mesh->neighbour[4 * id + f] > id;
        }
    }
    report(e.elements == 144 && e.dofs == 30 * 144 && e.interfaces == faces, "estimate", "counts");
    report(e.of_material[0] == 144 - steel && e.of_material[1] == steel && steel > 20, "estimate",
           "elements of each material");
    double all[3] = {sum[0], sum[1], output};
    MPI_Allreduce(MPI_IN_PLACE, all, 3, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    report(near(e.bytes_per_element, (all[0] - all[1]) / 144) &&
               near(e.peak_bytes_per_element, (all[0] + all[2]) / 144),
           "estimate", "memory");
    /* stress, mean and principal stress, displacement and velocity in floats; fragment, material, rank in
     * doubles */
    r.input->output.fields = RG_FIELD_STRESS | RG_FIELD_MEAN | RG_FIELD_PRINCIPAL | RG_FIELD_DISPLACEMENT |
                             RG_FIELD_VELOCITY | RG_FIELD_FRAGMENT | RG_FIELD_MATERIAL | RG_FIELD_RANK |
                             RG_FIELD_CRACK;
    r.input->output.precision = RG_OUTPUT_SINGLE;
    r.input->output.interval_steps = 0;
    r.input->output.interval_time = 3e-7;
    e = rg_estimate_run(s);
    report(near(e.frame_bytes, 144 * (70 * 4 + 3 * 8)) && near(e.frames, 5), "estimate", "frames at times");
    char *message = NULL, region[64];
    double height = 0.5 * (s->part->box[0][2] + s->part->box[1][2]);
    int64_t above = 0;
    snprintf(region, sizeof region, "z > %.17g", height);
    for (rg_gid id = 0; id < 144; id++) {
        double z = 0;
        for (int k = 0; k < 4; k++) {
            z += r.mesh->x[3 * r.mesh->corner[4 * id + k] + 2] / 4;
        }
        above += z > height;
    }
    r.input->output.region = rg_expr_new(region, &message);
    e = rg_estimate_run(s);
    report(e.written == above && above > 20 && above < 124 &&
               near(e.frame_bytes, (double)above * (70 * 4 + 3 * 8)),
           "estimate", "elements of the region");
    rg_expr_free(r.input->output.region);
    r.input->output.region = NULL;
    r.input->output.fields = RG_FIELD_DISPLACEMENT | RG_FIELD_PLASTIC | RG_FIELD_TRIAXIALITY;
    r.input->output.precision = RG_OUTPUT_DOUBLE;
    r.input->output.interval_steps = 100;
    e = rg_estimate_run(s);
    report(near(e.frame_bytes, 144 * 32 * 8) && near(e.frames, 1 + ceil((double)e.steps / 100)), "estimate",
           "frames at steps");
    r.input->output.times = 3;
    report(near(rg_estimate_run(s).frames, 3), "estimate", "frames at given times");
    r.input->output.times = 0;
    r.input->output.fields = 0;
    e = rg_estimate_run(s);
    report(e.frames == 0 && e.frame_bytes == 0, "estimate", "no frames");
    double xi = 0.7 * 0.06, critical = 4e-9 * (sqrt(1 + xi * xi) - xi);
    report(near(e.dt_critical, critical) && near(e.dt, 0.875 * critical), "estimate", "time step");
    report(e.steps == (int64_t)ceil(1e-6 / e.dt) && near(e.seconds, 1.3 * 0.02 * (double)e.steps), "estimate",
           "steps and time");
    double zone = 0, edge = 0;
    find_worst(&r, NULL, &zone, &edge);
    report(near(e.cohesive_zone, zone) && near(e.zone_edge, edge), "estimate", "cohesive zone");
    random_state_free(&r);
}

/* The input is the case that the solver keeps. */
static void check_steps(void) {
    random_state r = random_state_make(0, NULL, MPI_COMM_WORLD);
    rg_solver *s = r.solver;
    s->omega2 = 4e16; /* 10 ns, of which a half is taken */
    r.input->time.safety = 0.5;
    s->damping = 0;
    bool good = true;
    static const struct {
        double end;
        int64_t limit, steps;
    } cases[] = {{50e-9, 0, 10}, {50.1e-9, 0, 11}, {49.9e-9, 0, 10},
                 {50e-9, 7, 7},  {50e-9, 10, 10},  {50e-9, 12, 10}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        r.input->time.end = cases[k].end;
        r.input->time.steps = cases[k].limit;
        good = rg_estimate_run(s).steps == cases[k].steps && good;
    }
    r.input->interface.law = RG_LAW_NONE;
    good = isinf(rg_estimate_run(s).cohesive_zone) && good;
    report(good, "estimate", "steps to the end");
    random_state_free(&r);
    const char *change[] = {"interface={form: continuous, law: none}", "boundary=[]", "bodies=[]",
                            "viscosity.linear=0"};
    r = random_state_make(4, change, MPI_COMM_WORLD);
    r.solver->omega2 = 4e16;
    rg_estimate e = rg_estimate_run(r.solver);
    report(e.dofs == 3 * shared_nodes(r.mesh) && e.interfaces == 0 && isinf(e.cohesive_zone), "estimate",
           "shared nodes");
    random_state_free(&r);
}

static bool refused(const rg_solver *s, const char *words) {
    said[0] = '\0';
    expect_fatal = true;
    if (setjmp(escape) == 0) {
        rg_estimate_run(s);
    }
    expect_fatal = false;
    return strcmp(said, words) == 0;
}

static void check_too_many(void) {
    bool good = true;
    if (rank == 0) {
        random_state r = random_state_make(0, NULL, MPI_COMM_SELF);
        r.solver->omega2 = 4e16;
        r.solver->damping = 0;
        r.input->time.safety = 0.5;
        r.input->time.end = 5.1e6;
        good =
            refused(r.solver, "time.end: 5.1e+06 s are 1.02e+15 steps of 5e-09 s, more than a run can count");
        r.input->time.end = 4.9e6;
        good = refused(r.solver, "") && good;
        r.input->time.end = 5.1e6;
        r.input->time.steps = 5;
        good = refused(r.solver, "") && good;
        r.input->time.steps = 0;
        r.solver->omega2 = NAN;
        good = refused(r.solver, "time.end: 5.1e+06 s are nan steps of nan s, more than a run can count") &&
               good;
        random_state_free(&r);
    }
    report(good, "estimate", "more steps than can be counted");
}

/* ---- words ---- */

static const rg_estimate plain = {.elements = 1234,
                                  .interfaces = 2345,
                                  .dofs = 37020,
                                  .of_material = (int64_t[]){1000, 234},
                                  .dt_critical = 2e-9,
                                  .dt = 1e-9,
                                  .steps = 1001,
                                  .bytes_per_element = 3210.4,
                                  .peak_bytes_per_element = 5432.1,
                                  .seconds = 12.34,
                                  .cohesive_zone = INFINITY,
                                  .zone_edge = 1e-3};

#define BODY                                                                                                 \
    "elements       1234 (37020 degrees of freedom), 2345 interfaces\nbody           0.0011 x 0.0017 x "     \
    "0.0029 m\n"
#define GLASS "wave speeds    dilatational 5614.2 m/s, shear 3401.5 m/s\n"
#define STEEL "wave speeds    dilatational 6020.2 m/s, shear 3217.9 m/s\n"
#define BOTH                                                                                                 \
    "material       glass: 1000 elements, neo-hookean\n" GLASS                                               \
    "material       steel: 234 elements, j2\n" STEEL                                                         \
    "plastic waves  4748.6 m/s, beyond 1.75e+09 Pa in uniaxial strain\n"
#define HELD                                                                                                 \
    "boundary       velocity along z on 1.87e-06 m2, 12 faces of steel\nboundary       displacement along "  \
    "y on 4.93e-06 m2, 24 faces of glass and steel\n"
#define STEP                                                                                                 \
    HELD "time step      1e-09 s = 0.5 of the critical 2e-09 s, set by element 77 with its faces closed\n"
#define STEPS "steps          1001 to 1e-06 s\n"
#define MEMORY                                                                                               \
    "memory         3210 bytes per element, at most 5432 (output, cracks everywhere); 0.0067 GB in all\n"
#define LOOP " on %d ranks x 2 threads (%s, %s precision)\n"
#define LAST MEMORY "time loop      about 12.3 s" LOOP

static bool words_are(const rg_solver *s, const rg_estimate *e, const char *wanted, const char *more) {
    char *found = NULL, all[4000];
    size_t size = 0;
    FILE *out = open_memstream(&found, &size);
    rg_estimate_print(s, e, out);
    fclose(out);
    snprintf(all, sizeof all, wanted, s->ranks, s->kernels->name, RG_PRECISION);
    snprintf(all + strlen(all), sizeof all - strlen(all), "%s", more);
    bool good = strcmp(found, all) == 0;
    if (!good) {
        printf("# found:\n%s# wanted:\n%s", found, all);
    }
    free(found);
    return good;
}

/* The model of a solver and its first material, to change them. */
static rg_model *model_of(rg_solver *s) {
    return (rg_model *)s->model;
}

static rg_material *material_of(rg_solver *s) {
    return (rg_material *)s->model->material;
}

static bool check_onset(random_state *r, double onset, double safety, const char *limit) {
    char wanted[300] = "";
    rg_solver *s = r->solver;
    rg_cohesive *law = &model_of(s)->law;
    law->activation = onset > 0 ? RG_ACTIVATION_CONSERVING : RG_ACTIVATION_CONTINUOUS;
    r->input->interface.onset = onset;
    r->input->time.safety = safety;
    if (limit != NULL) {
        snprintf(wanted, sizeof wanted,
                 "warning: with interface.onset %.3g no step of time.safety above %s follows points that "
                 "have just switched; "
                 "the energy will show it\n",
                 onset, limit);
    }
    s->ranks = 1;
    char *found = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&found, &size);
    rg_estimate_print(s, &plain, out);
    fclose(out);
    char *at = strstr(found, "warning: with");
    bool good = strcmp(at == NULL ? "" : at, wanted) == 0;
    free(found);
    return good;
}

static bool check_words(void) {
    random_state r = random_state_make(0, NULL, MPI_COMM_SELF);
    rg_solver *s = r.solver;
    int threads = s->threads;
    r.input->time.safety = 0.5;
    s->threads = 2;
    s->limiting = 77;
    s->limiting_state = "closed";
    s->omega2 = 1e18;
    s->bodies->omega2 = 0;
    bool good = words_are(s, &plain, BODY BOTH STEP STEPS LAST, "");
    s->bodies->omega2 = 0.19e18;
    good = words_are(s, &plain,
                     BODY BOTH STEP "               shorter by 10 %% for what may touch bodies\n" STEPS LAST,
                     "") &&
           good;
    s->bodies->omega2 = 0;
    r.input->time.end = 0.5e-6; /* before all steps are over */
    good = words_are(s, &plain, BODY BOTH STEP "steps          1001 to 5e-07 s\n" LAST, "") && good;
    r.input->time.end = 2;
    good = words_are(s, &plain, BODY BOTH STEP "steps          1001 to 1.001e-06 s\n" LAST, "") && good;
    r.input->time.end = 1e-6;
    rg_estimate e = plain;
    e.cohesive_zone = 1.5e-3;
    good = words_are(s, &e, BODY BOTH STEP STEPS LAST,
                     "cohesive zone  0.0015 m, 1.5 times the longest edge (0.001 m) of the face that "
                     "resolves it worst\n"
                     "warning: the cohesive zone is not resolved: it should span at least two edges, here "
                     "1.5; the dissipated "
                     "energy will depend on the mesh; edges of 0.00075 m or 0.87 of the strength there would "
                     "resolve it\n") &&
           good;
    e.cohesive_zone = 2e-3;
    good = words_are(s, &e, BODY BOTH STEP STEPS LAST,
                     "cohesive zone  0.002 m, 2 times the longest edge (0.001 m) of the face that resolves "
                     "it worst\n") &&
           good;
    e.cohesive_zone = INFINITY;
    good = words_are(s, &e, BODY BOTH STEP STEPS LAST, "") && good;
    e.frames = 51;
    e.frame_bytes = 2.5e6;
    good = words_are(
               s, &e,
               BODY BOTH STEP STEPS MEMORY
               "disk           0.128 GB: 51 frames of 0.0025 GB, and what cracks take; less by compression\n"
               "time loop      about 12.3 s" LOOP,
               "") &&
           good;
    e.frames = 0;
    static const struct {
        double seconds;
        const char *words;
    } times[] = {{119, BODY BOTH STEP STEPS MEMORY "time loop      about 119 s" LOOP},
                 {150, BODY BOTH STEP STEPS MEMORY "time loop      about 2.5 min" LOOP},
                 {7200, BODY BOTH STEP STEPS MEMORY "time loop      about 2 h" LOOP},
                 {2591999, BODY BOTH STEP STEPS MEMORY "time loop      about 30 days" LOOP},
                 {1.7e8, BODY BOTH STEP STEPS MEMORY "time loop      about 5.39 years" LOOP}};
    for (size_t i = 0; i < sizeof times / sizeof *times; i++) {
        e.seconds = times[i].seconds;
        good = words_are(s, &e, times[i].words,
                         e.seconds < 2592000 ? ""
                                             : "warning: it would run for months: is time.end in seconds, "
                                               "and the mesh in metres?\n") &&
               good;
    }
    s->ranks = 3;
    s->part->quality = (rg_partition_quality){1.25, 1.25, 50, 2, 1.5};
    s->part->interfaces = 500;
    good = words_are(s, &plain,
                     BODY "partition      imbalance 1.250, 50 faces between ranks (10 %% of all), neighbours "
                          "of a rank: at most "
                          "2, mean 1.5\n" BOTH STEP STEPS LAST,
                     "") &&
           good;
    s->ranks = 1;
    model_of(s)->materials = 1;
    good = words_are(s, &plain, BODY "material       neo-hookean\n" GLASS STEP STEPS LAST, "") && good;
    material_of(s)->model = RG_MATERIAL_LINEAR_ELASTIC;
    good = words_are(
               s, &plain,
               BODY
               "material       linear-elastic: for small strains and rotations alone\n" GLASS STEP STEPS LAST,
               "") &&
           good;
    s->threads = threads;
    random_state_free(&r);
    return good;
}

/* Speeds just inside and outside of what solids have. */
static bool check_units(void) {
    random_state r = random_state_make(0, NULL, MPI_COMM_SELF);
    rg_solver *s = r.solver;
    s->limiting_state = "closed";
    s->omega2 = 1;
    model_of(s)->materials = 1;
    static const struct {
        double speed;
        const char *warned;
    } cases[] = {{10.01, NULL}, {9.99, "9.99"}, {29990, NULL}, {30010, "3e+04"}};
    bool good = true;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char wanted[200], *found = NULL;
        size_t size = 0;
        FILE *out = open_memstream(&found, &size);
        double stiffness = s->model->material[0].lambda + 2 * s->model->material[0].mu;
        material_of(s)->density = stiffness / (cases[k].speed * cases[k].speed);
        rg_estimate_print(s, &plain, out);
        fclose(out);
        snprintf(
            wanted, sizeof wanted,
            "warning: no solid carries waves at %s m/s: are its moduli in Pa and its density in kg/m3?\n",
            cases[k].warned == NULL ? "" : cases[k].warned);
        good = (strstr(found, "no solid") != NULL) == (cases[k].warned != NULL) &&
               (cases[k].warned == NULL || strstr(found, wanted) != NULL) && good;
        free(found);
    }
    random_state_free(&r);
    return good;
}

/* sqrt(onset/0.6), whatever beta, for the law has an onset of max(1, beta^2) times that. */
static bool check_onsets(void) {
    random_state r = random_state_make(0, NULL, MPI_COMM_SELF);
    r.solver->limiting_state = "closed";
    r.solver->omega2 = 1;
    bool good = check_onset(&r, 0.15, 0.5, NULL) && check_onset(&r, 0.15, 0.5001, "0.5") &&
                check_onset(&r, 0, 0.9, NULL) && check_onset(&r, 0.0375, 0.26, "0.25");
    random_state_free(&r);
    static const struct {
        const char *beta;
        double onset;
    } of[] = {{"interface.beta=0.5", 0.3}, {"interface.beta=0", 0.3}, {"interface.beta=2", 1.2}};
    for (size_t i = 0; i < sizeof of / sizeof *of; i++) {
        const char *change[] = {"interface.activation=conserving", "interface.onset=0.3", of[i].beta};
        r = random_state_make(3, change, MPI_COMM_SELF);
        good = good && fabs(r.solver->model->law.onset - of[i].onset) < 1e-15;
        random_state_free(&r);
    }
    return good;
}

static bool check_claims(void) {
    rg_other_material other[2] = {{.is = {.name = (char[]){"steel"}}}, {.is = {.name = (char[]){"glue"}}}};
    rg_case c = {.path = (char[]){"a.yaml"}, .others = 2, .other = other};
    c.material.name = (char[]){"glass"};
    rg_estimate e = {.of_material = (int64_t[]){3, 2, 1}};
    warnings = 0;
    rg_estimate_warn(&c, &e);
    bool good = warnings == 0;
    e.of_material[0] = 0;
    rg_estimate_warn(&c, &e);
    good = warnings == 1 &&
           strcmp(warned, "a.yaml: material glass: later materials claim all of its elements") == 0 && good;
    e.of_material[0] = 3;
    e.of_material[2] = 0;
    rg_estimate_warn(&c, &e);
    return warnings == 2 &&
           strcmp(warned, "a.yaml: materials: glue: later materials claim all of its elements") == 0 && good;
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    check_counts();
    check_zones();
    check_steps();
    check_too_many();
    report(rank != 0 || check_words(), "words", "to the letter");
    report(rank != 0 || check_units(), "words", "of waves that no solid has");
    report(rank != 0 || check_onsets(), "words", "of an onset too stiff for the step");
    report(rank != 0 || check_claims(), "words", "of materials without elements");
    return finish();
}
