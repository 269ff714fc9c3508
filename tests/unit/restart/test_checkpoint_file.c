/* Checkpoints of a state drawn at random, on any number of ranks: what the file holds, that all of it comes
 * back on these ranks and on one, and what is said of files that are not what they should be. Prints TAP from
 * rank 0. */
#include "restart/checkpoint.h"

#include <errno.h>
#include <hdf5.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "base/h5_parallel.h"
#include "base/hash.h"
#include "base/mem.h"
#include "case/compare.h"
#include "restart/restart.h"
#include "restart/checksum.h"
#include "solver/tile.h"
#include "support/checkpoint_tamper.h"
#include "support/fatal.h"
#include "support/random_state.h"
#include "support/tap.h"

/* Of 144 elements on one rank the last window has one. */
enum { STEEL_ROWS = RG_GAUSS * RG_J2_HISTORY + RG_RELEASED, WINDOW = 11 };

/* ---- stand-ins: the end of the run, warnings, small windows, disks that fail ---- */

static bool last_rank;
static int warnings;
static char warned[1000];

void rg_warn(const char *format, ...) {
    va_list args;
    va_start(args, format);
    vsnprintf(warned, sizeof warned, format, args);
    va_end(args);
    warnings++;
}

size_t __wrap_rg_slab_window(size_t bytes);

static bool checksum_fails, sync_fails;
bool __wrap_rg_checksum_put(const char *path, int64_t step, MPI_Comm comm);
bool __real_rg_checksum_put(const char *path, int64_t step, MPI_Comm comm);
bool __wrap_rg_sync_folder(const char *path);
bool __real_rg_sync_folder(const char *path);

bool __wrap_rg_checksum_put(const char *path, int64_t step, MPI_Comm comm) {
    errno = EIO;
    return !checksum_fails && __real_rg_checksum_put(path, step, comm);
}

bool __wrap_rg_sync_folder(const char *path) {
    errno = EIO;
    return !sync_fails && __real_rg_sync_folder(path);
}

size_t __wrap_rg_slab_window(size_t bytes) {
    (void)bytes;
    return WINDOW;
}

/* Reads of the last rank since the first that counts, and which of them fails there; -1: none. */
static int reads, failing_read = -1;
bool __wrap_rg_h5_read(hid_t group, const rg_h5_slab *s, void *data);
bool __real_rg_h5_read(hid_t group, const rg_h5_slab *s, void *data);

bool __wrap_rg_h5_read(hid_t group, const rg_h5_slab *s, void *data) {
    bool ok = __real_rg_h5_read(group, s, data);
    return (reads++ != failing_read || !last_rank) && ok;
}

/* ---- runs ---- */

static char place[200]; /* of the test's files */

typedef struct {
    random_state r;
    rg_state state;
    rg_restart keep;
    rg_ledger ledger;
    rg_summary summary;
    rg_slab *slab;
    rg_checkpoints k;
    uint64_t pool_seed, pool_sum; /* of the pool that it has: how it was drawn, and the sum of its rows */
    size_t pool_rows;
} run;

/* A pool: an element has none to three rows, each of POOL values. */
enum { POOL = 2 };

static size_t list_pool(const void *of, int64_t **key, double **value) {
    const run *x = of;
    const rg_domain *d = x->r.solver->domain;
    size_t rows = 0;
    *key = RG_NEW(int64_t, 3 * d->blocks * RG_LANES);
    *value = RG_NEW(double, 3 * d->blocks * RG_LANES * POOL);
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        uint64_t h = rg_hash(x->pool_seed, (uint64_t)d->id[slot]);
        for (uint64_t k = 0; d->id[slot] >= 0 && k < h % 4; k++, rows++) {
            (*key)[rows] = 4 * d->id[slot] + (int64_t)k;
            for (size_t v = 0; v < POOL; v++) {
                (*value)[POOL * rows + v] = rg_hash_uniform(rg_hash(h, POOL * k + v));
            }
        }
    }
    return rows;
}

static void take_pool(void *of, size_t rows, const int64_t *key, const double *value) {
    run *x = of;
    x->pool_rows = rows;
    x->pool_sum = 0;
    for (size_t i = 0; i < rows; i++) {
        uint64_t h = (uint64_t)key[i];
        for (size_t v = 0; v < POOL; v++) {
            h = rg_hash_double(h, value[POOL * i + v]);
        }
        x->pool_sum += h;
    }
}

static void draw_pool(run *x, uint64_t seed) {
    int64_t *key;
    double *value;
    x->pool_seed = seed;
    size_t rows = list_pool(x, &key, &value);
    take_pool(x, rows, key, value);
    rg_free(key);
    rg_free(value);
}

static run *make_run(const char *dir, int changes, const char *const change[], MPI_Comm comm) {
    run *x = RG_NEW(run, 1);
    x->r = random_state_make(changes, change, comm);
    rg_restart_register(&x->state, &x->keep, x->r.solver, &x->ledger, &x->summary);
    rg_state_add_pool(&x->state, "pool", POOL, (rg_state_pool){x, list_pool, take_pool});
    rg_checkpoints_open(&x->k, dir, x->r.solver, &x->state, &x->slab);
    return x;
}

static void free_run(run *x) {
    rg_checkpoints_close(&x->k);
    rg_slab_free(x->slab);
    random_state_free(&x->r);
    rg_free(x);
}

static void fill(void *data, size_t size, uint64_t seed) {
    for (size_t i = 0; i < size; i++) {
        ((uint8_t *)data)[i] = (uint8_t)(rg_hash(seed, i) % 255 + 1);
    }
}

/* What the run itself keeps is bytes here: numbers of any kind. */
static void draw(run *x, uint64_t seed) {
    random_state_draw(&x->r, seed);
    draw_pool(x, seed);
    fill(&x->keep, sizeof x->keep, seed);
    fill(&x->ledger, sizeof x->ledger, seed + 1000);
    x->summary.dt_first = 1e-9 * (double)(seed + 1);
    x->r.solver->step = 100 + (int64_t)seed;
}

static bool same_rows(const rg_state *a, const rg_state *b) {
    bool same = a->arrays == b->arrays;
    for (int k = 0; same && k < a->arrays; k++) {
        char x[4096], y[4096];
        for (size_t i = 0;
             a->array[k].of == RG_OF_RUN || a->array[k].of == RG_OF_LIST ? i < a->array[k].records : false;
             i++) {
            rg_state_get(&a->array[k], i, x);
            rg_state_get(&b->array[k], i, y);
            same = same && memcmp(x, y, rg_state_bytes(&a->array[k])) == 0;
        }
        if (!same) {
            printf("# %s differs\n", a->array[k].name);
        }
    }
    return same;
}

static bool same_elements(const rg_solver *a, const rg_solver *b) {
    bool same = true;
    for (size_t slot = 0; slot < a->domain->blocks * RG_LANES; slot++) {
        if (a->domain->id[slot] < 0) {
            continue;
        }
        for (int k = 0; k < 3 * RG_NODES; k++) {
            size_t at = rg_node_index(slot, k / 3, k % 3);
            same = same && a->u[at] == b->u[at] && a->velocity[at] == b->velocity[at];
        }
        for (size_t row = 0; a->history != NULL && row < STEEL_ROWS; row++) {
            same = same && rg_history_value(a, slot, row) == rg_history_value(b, slot, row);
        }
        same = same && (a->heat == NULL || a->heat[slot] == b->heat[slot]);
    }
    return same;
}

static bool same_faces(const rg_solver *a, const rg_solver *b) {
    bool same = true;
    size_t lane_values = a->model->crack_stride / RG_LANES;
    for (size_t i = 0; i < a->domain->iblocks * RG_LANES; i++) {
        same = same && a->broken[i] == b->broken[i] && a->unlinked[i] == b->unlinked[i];
        for (size_t k = 0; k < lane_values && a->broken[i] != 0; k++) {
            size_t at = i / RG_LANES * a->model->crack_stride + k * RG_LANES + i % RG_LANES;
            same = same && a->crack[at] == b->crack[at];
        }
    }
    return same;
}

/* Whether a run has the state of the other one on the same ranks. */
static bool same_state(const run *a, const run *b) {
    const rg_solver *s = a->r.solver, *t = b->r.solver;
    bool run_same = same_rows(&a->state, &b->state) && memcmp(&a->keep, &b->keep, sizeof a->keep) == 0 &&
                    memcmp(&a->ledger, &b->ledger, sizeof a->ledger) == 0 &&
                    a->summary.dt_first == b->summary.dt_first && s->time == t->time && s->dt == t->dt &&
                    s->step == t->step && s->stiffening_anywhere == t->stiffening_anywhere &&
                    s->opening_rate == t->opening_rate && s->omega2 == t->omega2 &&
                    s->limiting == t->limiting && s->damping == t->damping;
    bool elements = same_elements(s, t), faces = same_faces(s, t);
    bool pool = a->pool_rows == b->pool_rows && a->pool_sum == b->pool_sum;
    if (!run_same || !elements || !faces || !pool) {
        printf("# run %d, elements %d, faces %d, pool %d\n", run_same, elements, faces, pool);
    }
    return run_same && elements && faces && pool;
}

/* ---- what comes back ---- */

static const char *in(const char *name) {
    static char path[400];
    snprintf(path, sizeof path, "%s/%s", place, name);
    return path;
}

static bool names_are(const char *dir, const char *wanted) {
    char found[400] = "";
    for (int64_t step = 0; step < 200; step++) {
        for (int damaged = 0; damaged < 2; damaged++) {
            char path[500], name[60];
            snprintf(name, sizeof name, "step-%012d.h5%s", (int)step, damaged ? ".damaged" : "");
            snprintf(path, sizeof path, "%s/checkpoints/%s", dir, name);
            if (access(path, F_OK) == 0) {
                size_t used = strlen(found);
                snprintf(found + used, sizeof found - used, "%d%s ", (int)step, damaged ? "!" : "");
            }
        }
    }
    if (strcmp(found, wanted) != 0) {
        printf("# found %s\n", found);
    }
    return strcmp(found, wanted) == 0;
}

static void check_round_trip(const char *name, int changes, const char *const change[]) {
    char dir[400];
    snprintf(dir, sizeof dir, "%s", in(name));
    run *a = make_run(dir, changes, change, MPI_COMM_WORLD),
        *b = make_run(dir, changes, change, MPI_COMM_WORLD);
    for (uint64_t seed = 1; seed <= 3; seed++) {
        draw(a, seed);
        rg_checkpoint_write(&a->k, 2);
    }
    report(names_are(dir, "102 103 "), name, "as many stay as are kept");
    report(a->k.written == 3 && a->k.seconds[0] > 0 && a->k.slowest >= a->k.seconds[1] &&
               fabs(a->k.total - a->k.seconds[0] - a->k.seconds[1] - a->k.seconds[2]) < 1e-12 &&
               (a->k.slowest == a->k.seconds[0] || a->k.slowest == a->k.seconds[1] ||
                a->k.slowest == a->k.seconds[2]),
           name, "wall times");
    draw(b, 9);
    rg_checkpoint_load(&b->k);
    report(same_state(a, b), name, "all comes back");
    report(a->k.mesh == b->k.mesh && warnings == 0, name, "without a word");
    uint64_t mesh = a->k.mesh;
    free_run(a);
    free_run(b);
    bool good = true;
    if (rank == 0) { /* alone */
        a = make_run(dir, changes, change, MPI_COMM_SELF);
        b = make_run(dir, changes, change, MPI_COMM_SELF);
        draw(a, 3);
        draw(b, 8);
        rg_checkpoint_load(&b->k);
        good = same_state(a, b) && b->k.mesh == mesh;
        free_run(a);
        free_run(b);
    }
    report(good, name, "on one rank, too");
}

/* ---- what the file holds ---- */

static bool attribute_is(hid_t file, const char *name, int64_t wanted) {
    int64_t found = -1;
    hid_t a = H5Aopen(file, name, H5P_DEFAULT);
    H5Aread(a, H5T_NATIVE_INT64, &found);
    H5Aclose(a);
    return found == wanted;
}

static bool text_is(hid_t file, const char *name, const char *wanted) {
    char found[64] = "";
    hid_t a = H5Aopen(file, name, H5P_DEFAULT), type = H5Aget_type(a);
    if (H5Tget_size(type) < sizeof found) {
        H5Aread(a, type, found);
    }
    H5Tclose(type);
    H5Aclose(a);
    return strcmp(found, wanted) == 0;
}

static bool elements_good(hid_t file, const run *x, uint64_t seed) {
    int64_t n = x->r.mesh->elements;
    double *u = load(file, "element/displacement", H5T_NATIVE_DOUBLE, &n, 30);
    double *heat = load(file, "element/heat", H5T_NATIVE_DOUBLE, &n, 1);
    double *history = load(file, "element/history", H5T_NATIVE_DOUBLE, &n, STEEL_ROWS);
    bool good = u != NULL && heat != NULL && history != NULL;
    for (int64_t id = 0; good && id < n; id++) {
        for (int k = 0; k < 30; k++) {
            good = good && u[30 * id + k] == drawn_u(seed, id, k / 3, k % 3);
        }
        for (int row = 0; row < STEEL_ROWS && mesh_material(&x->r, id) == 1; row++) {
            good = good && history[STEEL_ROWS * id + row] == drawn_history(seed, id, RG_J2_HISTORY, row);
        }
        good = good && heat[id] == drawn_heat(seed, id);
    }
    rg_free(u);
    rg_free(heat);
    rg_free(history);
    return good;
}

/* Keys are those of the broken faces, of tile-boundary faces twice: by both sides. */
static bool faces_good(hid_t file, const run *x, uint64_t seed, int64_t copies) {
    int64_t n = -1, elements = x->r.mesh->elements;
    int64_t *key = load(file, "face/key", H5T_NATIVE_INT64, &n, 1);
    uint16_t *rows = load(file, "face/rows", H5T_NATIVE_UINT16, &elements, 1);
    uint8_t *broken = load(file, "face/broken", H5T_NATIVE_UINT8, &n, 1);
    int columns = (int)(x->r.solver->model->crack_stride / RG_LANES);
    double *crack = load(file, "face/crack", H5T_NATIVE_DOUBLE, &n, columns);
    bool good = key != NULL && rows != NULL && broken != NULL && crack != NULL && n == copies;
    for (int64_t i = 0; good && i < n; i++) {
        rg_gid face = face_key(x->r.mesh, key[i] / 4, (int)(key[i] % 4));
        good = (i == 0 || key[i] > key[i - 1]) && broken[i] == drawn_broken(seed, face) && broken[i] != 0 &&
               crack[i * columns + RG_CRACK * 4 + RG_CRACK_TIME] == drawn_time(seed, face, 4) &&
               rows[key[i] / 4]-- > 0;
    }
    for (int64_t e = 0; good && e < elements; e++) {
        good = rows[e] == 0;
    }
    rg_free(key);
    rg_free(rows);
    rg_free(broken);
    rg_free(crack);
    return good;
}

static bool run_good(hid_t file, const run *x) {
    int64_t one = 1, two = 2, length = -1;
    double *t = load(file, "run/time", H5T_NATIVE_DOUBLE, &one, 1);
    int64_t *step = load(file, "run/step", H5T_NATIVE_INT64, &one, 1);
    uint8_t *ledger = load(file, "run/ledger", H5T_NATIVE_UINT8, &one, sizeof(rg_ledger));
    double *bodies = load(file, "run/bodies", H5T_NATIVE_DOUBLE, &two, 17);
    char *words = load(file, "case", H5T_NATIVE_UINT8, &length, 1), *wanted = rg_case_fixed(x->r.input);
    bool good = t != NULL && step != NULL && ledger != NULL && bodies != NULL && words != NULL &&
                *t == x->r.solver->time && *step == x->r.solver->step &&
                memcmp(ledger, &x->ledger, sizeof x->ledger) == 0 &&
                memcmp(bodies + 17, x->r.solver->bodies->body[1].x, 17 * sizeof *bodies) == 0 &&
                length == (int64_t)strlen(wanted) + 1 && memcmp(words, wanted, (size_t)length) == 0;
    rg_free(t);
    rg_free(step);
    rg_free(ledger);
    rg_free(bodies);
    rg_free(words);
    free(wanted);
    return good;
}

static void check_content(void) {
    run *x = make_run(in("content"), 0, NULL, MPI_COMM_WORLD);
    draw(x, 5);
    rg_checkpoint_write(&x->k, 1);
    int64_t copies = 0;
    for (size_t i = 0; i < x->r.solver->domain->iblocks * RG_LANES; i++) {
        copies += x->r.solver->broken[i] != 0;
    }
    MPI_Allreduce(MPI_IN_PLACE, &copies, 1, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
    bool head = true, elements = true, faces = true, whole = true;
    if (rank == 0) {
        hid_t file = H5Fopen(in("content/checkpoints/step-000000000105.h5"), H5F_ACC_RDONLY, H5P_DEFAULT);
        head = text_is(file, "program", "rhegma") && attribute_is(file, "format", 2) &&
               attribute_is(file, "elements", 144) && attribute_is(file, "mesh", (int64_t)x->k.mesh) &&
               text_is(file, "precision", RG_PRECISION) &&
               text_is(file, "instruction_set", x->r.solver->kernels->name);
        elements = elements_good(file, x, 5);
        faces = faces_good(file, x, 5, copies);
        whole = run_good(file, x);
        H5Fclose(file);
    }
    report(head, "file", "what it is of");
    report(elements, "file", "elements by their numbers");
    report(faces, "file", "broken faces by their numbers");
    report(whole, "file", "what concerns the run as a whole");
    free_run(x);
}

/* ---- reads that fail on one rank: all ranks go back to the checkpoint before ---- */

static void check_reads(void) {
    run *x = make_run(in("reads"), 0, NULL, MPI_COMM_WORLD),
        *before = make_run(in("reads"), 0, NULL, MPI_COMM_WORLD);
    char name[500], aside[520];
    snprintf(name, sizeof name, "%s", in("reads/checkpoints/step-000000000102.h5"));
    snprintf(aside, sizeof aside, "%s.damaged", name);
    for (uint64_t seed = 1; seed <= 2; seed++) {
        draw(x, seed);
        rg_checkpoint_write(&x->k, 2);
    }
    draw(before, 1);
    bool good = true;
    enum { EVERY = 7 }; /* of the reads is tried */
    int failed = 0;
    do {
        draw(x, 9);
        reads = 0;
        failing_read = EVERY * failed;
        rg_checkpoint_load(&x->k);
        if (x->r.solver->step == 101) {
            good = same_state(x, before) && good;
            failed++;
        }
        if (rank == 0) {
            rename(aside, name);
        }
        MPI_Barrier(MPI_COMM_WORLD);
    } while (x->r.solver->step == 101);
    failing_read = -1;
    report(good && failed > 7 && (rank != 0 || warnings == failed), "reads", "each fails on one rank");
    warnings = 0;
    free_run(x);
    free_run(before);
}

/* ---- files that are not what they should be; rank 0 alone ---- */

static const char unfit[] = ": it does not hold the state of this case: ";
static const char *const attributes[] = {"format", "elements", "mesh", "precision", "instruction_set"};

static void copy_file(const char *from, const char *to) {
    char command[2000];
    snprintf(command, sizeof command, "mkdir -p $(dirname %s) && cp %s %s", to, from, to);
    if (system(command) != 0) {
        rg_fatal(RG_FAILURE, "%s", command);
    }
}

/* Loads from `dir`; whether that ended the run. */
static bool load_refused(run *x) {
    fatal_status = RG_OK;
    said[0] = warned[0] = '\0';
    warnings = 0;
    expect_fatal = true;
    if (setjmp(escape) == 0) {
        rg_checkpoint_load(&x->k);
    }
    expect_fatal = false;
    return fatal_status != RG_OK;
}

static void point_to(run *x, const char *dir) {
    rg_free(x->k.folder);
    x->k.folder = rg_join_path(dir, "checkpoints");
}

static bool good_of(bool good, const char *name) {
    if (!good) {
        printf("# %s: fatal %d '%s', %d warnings, '%s'\n", name, fatal_status, said, warnings, warned);
    }
    return good;
}

/* The file that the run wrote, changed by `which`, under a checksum of its own. */
static void make_tampered(const char *dir, int which) {
    char path[500];
    snprintf(path, sizeof path, "%s/checkpoints/step-000000000107.h5", dir);
    copy_file(in("good/checkpoints/step-000000000107.h5"), path);
    hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
    if (which < CHECKPOINT_TAMPERS) {
        checkpoint_tamper(file, which);
    } else if (which < CHECKPOINT_TAMPERS + 5) {
        H5Adelete(file, attributes[which - CHECKPOINT_TAMPERS]);
    } else {
        put_text(file, "instruction_set", "abacus");
    }
    H5Fclose(file);
    if (!rg_checksum_put(path, 107, MPI_COMM_SELF)) {
        rg_fatal(RG_FAILURE, "%s cannot be given its checksum", path);
    }
}

static bool check_tampers(run *x) {
    bool good = true;
    for (int which = 0; which < CHECKPOINT_TAMPERS + 6; which++) {
        char dir[400];
        snprintf(dir, sizeof dir, "%s/tamper-%d", place, which);
        make_tampered(dir, which);
        point_to(x, dir);
        draw(x, 2);
        bool refused = load_refused(x);
        if (which < CHECKPOINT_TAMPERS && checkpoint_tampers[which].words != NULL) {
            good = good_of(refused && fatal_status == RG_USAGE &&
                               strstr(said, checkpoint_tampers[which].words) != NULL && warnings == 0,
                           checkpoint_tampers[which].name) &&
                   good;
        } else if (which < CHECKPOINT_TAMPERS + 5) {
            good =
                good_of(
                    refused && fatal_status == RG_USAGE && warnings == 1 && strstr(warned, unfit) != NULL &&
                        strstr(said, "no checkpoint to restart from: all are damaged or cannot be read") !=
                            NULL &&
                        names_are(dir, "107 "),
                    which < CHECKPOINT_TAMPERS ? checkpoint_tampers[which].name
                                               : attributes[which - CHECKPOINT_TAMPERS]) &&
                good;
        } else {
            good = good_of(!refused && warnings == 1 &&
                               strstr(warned, "computed with abacus, goes on with ") != NULL &&
                               strstr(warned, "(RHEGMA_ISA=abacus, where the machine has it)") != NULL,
                           "another instruction set") &&
                   good;
        }
    }
    return good;
}

static void flip_byte(const char *path, long at) {
    FILE *f = fopen(path, "r+b");
    fseek(f, at, SEEK_SET);
    int byte = fgetc(f);
    fseek(f, at, SEEK_SET);
    fputc(byte ^ 4, f);
    fclose(f);
}

/* The newest that is whole is taken; all that are newer are set aside. */
static bool check_older(run *x) {
    char path[4][500], dir[400];
    snprintf(dir, sizeof dir, "%s", in("older"));
    point_to(x, dir);
    for (int k = 0; k < 4; k++) {
        draw(x, (uint64_t)(k + 1));
        rg_checkpoint_write(&x->k, 5);
        snprintf(path[k], sizeof path[k], "%s/checkpoints/step-%012d.h5", dir, 101 + k);
    }
    flip_byte(path[2], 5000);
    flip_byte(path[3], 5000);
    draw(x, 9);
    run *wanted = make_run(dir, 0, NULL, MPI_COMM_SELF);
    draw(wanted, 2);
    bool good =
        good_of(!load_refused(x) && warnings == 2 && strstr(warned, "step-000000000103.h5: ") != NULL &&
                    strstr(warned, "its checksum is wrong: it is damaged") != NULL,
                "newest damaged");
    good = same_state(x, wanted) && names_are(dir, "101 102 103! 104! ") && good;
    flip_byte(path[1], 100);
    char blocked[600];
    snprintf(blocked, sizeof blocked, "%s.damaged/x", path[1]);
    copy_file(path[0], blocked);
    good =
        good_of(load_refused(x) && fatal_status == RG_FAILURE &&
                    strstr(said, "cannot be set aside as ") != NULL && strstr(said, ".h5.damaged: ") != NULL,
                "cannot be set aside") &&
        good;
    flip_byte(path[0], 100);
    good =
        good_of(load_refused(x) && fatal_status == RG_USAGE && warnings == 2 &&
                    strstr(said, "older/checkpoints: no checkpoint to restart from: all are damaged") != NULL,
                "all damaged") &&
        good;
    free_run(wanted);
    return good;
}

/* Whether writing ends the run with these words, and which checkpoints are there then. */
static bool write_fails(run *x, const char *words, const char *names) {
    said[0] = '\0';
    fatal_status = RG_OK;
    expect_fatal = true;
    if (setjmp(escape) == 0) {
        rg_checkpoint_write(&x->k, 1);
    }
    expect_fatal = false;
    return good_of(
        fatal_status == RG_FAILURE && strstr(said, words) != NULL && names_are(in("failing"), names), words);
}

/* The checkpoint before stays. */
static bool check_failures(run *x) {
    point_to(x, in("failing"));
    draw(x, 1);
    rg_checkpoint_write(&x->k, 1);
    draw(x, 2);
    checksum_fails = true;
    bool good = write_fails(
        x, "step-000000000102.h5: cannot write the checksum of the file: Input/output error", "101 ");
    checksum_fails = false;
    sync_fails = true;
    good = write_fails(x, "failing/checkpoints: cannot bring the folder to the disk: Input/output error",
                       "101 102 ") &&
           good;
    sync_fails = false;
    return good;
}

static bool check_none(run *x) {
    point_to(x, in("nowhere"));
    bool good = good_of(
        load_refused(x) && fatal_status == RG_USAGE &&
            strstr(said, "nowhere/checkpoints: no checkpoint to restart from: No such file or directory"),
        "no folder");
    copy_file("/dev/null", in("empty/checkpoints/x"));
    point_to(x, in("empty"));
    return good_of(load_refused(x) && fatal_status == RG_USAGE &&
                       strcmp(said + strlen(said) - 30, "no checkpoint to restart from") != 0 &&
                       strstr(said, "empty/checkpoints: no checkpoint to restart from") != NULL &&
                       said[strlen(said) - 1] == 'm',
                   "an empty folder") &&
           good;
}

/* Each corner and set of an element changes the hash of the mesh; padding does not. */
static bool check_mesh_hash(run *x) {
    const rg_domain *d = x->r.solver->domain;
    size_t slot = 0;
    while (d->id[slot] != 77) {
        slot++;
    }
    uint64_t before = 0;
    bool good = true;
    for (int k = -2; k < 16; k++) {
        double kept = k >= 0 && k < 12 ? d->corner[12 * slot + (size_t)k] : 0;
        if (k == -1) {
            for (size_t i = 0; i < d->blocks * RG_LANES; i++) {
                d->corner[12 * i + 3] += d->id[i] < 0 ? 1 : 0;
            }
        } else if (k >= 12) {
            d->set[4 * slot + (size_t)k - 12]++;
        } else if (k >= 0) {
            d->corner[12 * slot + (size_t)k] = kept * (1 + 1e-15);
        }
        rg_checkpoints_close(&x->k);
        rg_checkpoints_open(&x->k, in("hash"), x->r.solver, &x->state, &x->slab);
        rg_checkpoint_write(&x->k, 1);
        before = k == -2 ? x->k.mesh : before;
        good = (x->k.mesh == before) == (k < 0) && good;
        if (k >= 12) {
            d->set[4 * slot + (size_t)k - 12]--;
        } else if (k >= 0) {
            d->corner[12 * slot + (size_t)k] = kept;
        }
    }
    return good;
}

static void check_refusals(void) {
    bool tampered = true, older = true, none = true, failing = true, hash = true;
    if (rank == 0) {
        run *x = make_run(in("good"), 0, NULL, MPI_COMM_SELF);
        draw(x, 7);
        rg_checkpoint_write(&x->k, 1);
        tampered = check_tampers(x);
        older = check_older(x);
        none = check_none(x);
        failing = check_failures(x);
        hash = check_mesh_hash(x);
        free_run(x);
        warnings = 0;
    }
    report(tampered, "refused", "files that hold something else");
    report(older, "refused", "files that are damaged");
    report(none, "refused", "no files");
    report(failing, "failed", "disks that cannot take a checkpoint");
    report(hash, "mesh", "its hash");
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    int ranks;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    last_rank = rank == ranks - 1;
    snprintf(place, sizeof place, "/tmp/test_checkpoint_file.XXXXXX");
    if (rank == 0 && mkdtemp(place) == NULL) {
        rg_fatal(RG_FAILURE, "cannot make %s", place);
    }
    MPI_Bcast(place, sizeof place, MPI_CHAR, 0, MPI_COMM_WORLD);
    check_round_trip("whole", 0, NULL);
    const char *plain[] = {"interface.friction=0", "viscosity.linear=0", "materials=[]", "bodies=[]",
                           "boundary=[]"};
    check_round_trip("plain", 5, plain);
    check_content();
    check_reads();
    check_refusals();
    if (rank == 0) {
        char command[300];
        snprintf(command, sizeof command, "rm -rf %s", place);
        failures += system(command) != 0;
    }
    return finish();
}
