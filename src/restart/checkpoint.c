#include "restart/checkpoint.h"

#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/error.h"
#include "base/files.h"
#include "base/hash.h"
#include "base/mem.h"
#include "base/first_bad.h"
#include "case/compare.h"
#include "restart/checkpoint_folder.h"
#include "restart/checksum.h"
#include "restart/state_table.h"
#include "revision.h"
#include "solver/tile.h"

enum { FORMAT_VERSION = 2, WORD = 32 };

/* What must be the same in the run that goes on: attributes of the file. */
typedef struct {
    int format;
    int64_t elements;
    uint64_t mesh;
    char precision[WORD], instruction_set[WORD];
} identity;

/* Elements with their corners and surface sets, in any order. */
static uint64_t mesh_hash(const rg_solver *s) {
    const rg_domain *d = s->domain;
    uint64_t sum = 0;
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        uint64_t h = rg_hash(3, (uint64_t)d->id[slot]);
        for (size_t k = 0; k < 12; k++) {
            h = rg_hash_double(h, d->corner[12 * slot + k]);
        }
        for (size_t k = 0; k < RG_FACES; k++) {
            h = rg_hash(h, (uint64_t)d->set[4 * slot + k]);
        }
        sum += d->id[slot] >= 0 ? h : 0;
    }
    MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_UINT64_T, MPI_SUM, s->comm);
    return sum;
}

static identity identity_of(const rg_checkpoints *k) {
    identity id = {FORMAT_VERSION, k->slab->total, k->mesh, RG_PRECISION, ""};
    snprintf(id.instruction_set, WORD, "%s", k->solver->kernels->name);
    return id;
}

void rg_checkpoints_open(rg_checkpoints *k, const char *dir, rg_solver *s, const rg_state *state,
                         rg_slab **slab) {
    *k = (rg_checkpoints){
        .solver = s, .state = state, .shared = slab, .folder = rg_join_path(dir, "checkpoints")};
}

/* What all checkpoints of a run share, made with the first: most runs write none. Collective. */
static void prepare(rg_checkpoints *k) {
    const rg_solver *s = k->solver;
    if (k->slab == NULL) {
        k->slab = rg_slab_shared(k->shared, s->domain, s->part->total, s->comm);
        k->mesh = mesh_hash(s);
    }
}

void rg_checkpoints_close(rg_checkpoints *k) {
    rg_free(k->folder);
    rg_free(k->window);
    rg_free(k->seconds);
}

/* ---- writing ---- */

static bool put_identity(const rg_h5_file *f, const identity *id) {
    return rg_h5_put_text(f->file, "program", "rhegma") && rg_h5_put_text(f->file, "revision", RG_REVISION) &&
           rg_h5_put_attribute(f->file, "format", H5T_NATIVE_INT, &id->format) &&
           rg_h5_put_attribute(f->file, "elements", H5T_NATIVE_INT64, &id->elements) &&
           rg_h5_put_attribute(f->file, "mesh", H5T_NATIVE_UINT64, &id->mesh) &&
           rg_h5_put_text(f->file, "precision", id->precision) &&
           rg_h5_put_text(f->file, "instruction_set", id->instruction_set);
}

/* Rank 0 has all rows of a dataset that concerns the run as a whole. */
static rg_h5_slab whole(const rg_h5_file *f, const char *name, hid_t type, int columns, int64_t rows) {
    return (rg_h5_slab){
        .name = name, .type = type, .columns = columns, .rows = rows, .count = f->rank == 0 ? rows : 0};
}

static void put_case(rg_h5_file *f, const rg_case *c) {
    char *text = rg_case_fixed(c);
    rg_h5_slab s = whole(f, "case", H5T_NATIVE_UINT8, 1, (int64_t)strlen(text) + 1);
    rg_h5_write(f, f->file, &s, NULL, text);
    free(text);
}

static rg_h5_slab of_elements(const rg_slab *slab, const rg_state_array *a) {
    return (rg_h5_slab){.name = a->name,
                        .type = rg_state_h5_type(a),
                        .columns = a->count,
                        .rows = slab->total,
                        .first = slab->first,
                        .count = (int64_t)slab->count};
}

/* The records of an array, by own element in the order of the slab. */
typedef struct {
    const rg_state_array *array;
    const rg_lid *slot;
} element_records;

static void get_record(const void *of, size_t i, void *out) {
    const element_records *r = of;
    rg_state_get(r->array, (size_t)r->slot[i], out);
}

static void put_record(const void *of, size_t i, void *in) {
    const element_records *r = of;
    rg_state_put(r->array, (size_t)r->slot[i], in);
}

static char *make_window(rg_checkpoints *k, size_t bytes) {
    if (bytes > k->window_bytes) {
        rg_free(k->window);
        k->window = RG_NEW(char, bytes);
        k->window_bytes = bytes;
    }
    return k->window;
}

/* Window by window, each written and read back while it is in the cache; the disk takes it while the next one
 * comes. */
static void put_elements(rg_h5_file *f, hid_t group, rg_checkpoints *k, const rg_state_array *a) {
    size_t bytes = rg_state_bytes(a), rows = rg_slab_window(bytes), most = rg_slab_most(k->slab);
    char *window = make_window(k, rows * bytes);
    element_records records = {a, k->slab->slot};
    rg_h5_slab s = of_elements(k->slab, a);
    hid_t dataset = rg_h5_begin(f, group, &s, NULL);
    for (size_t first = 0; first < most; first += rows) {
        s.count = (int64_t)rg_slab_gather(k->slab, first, rows, bytes, get_record, &records, window);
        rg_h5_put(f, dataset, &s, window);
        rg_h5_start_sync(f);
        s.first += s.count;
    }
    rg_h5_note(f, H5Dclose(dataset) >= 0, "close", a->name);
}

static void put_rows(rg_h5_file *f, hid_t group, const rg_state_array *a) {
    size_t bytes = rg_state_bytes(a);
    char *rows = RG_NEW(char, a->records *bytes);
    for (size_t i = 0; i < a->records; i++) {
        rg_state_get(a, i, rows + i * bytes);
    }
    rg_h5_slab s = whole(f, a->name, rg_state_h5_type(a), a->count, (int64_t)a->records);
    rg_h5_write(f, group, &s, NULL, rows);
    rg_free(rows);
}

/* All arrays of one kind, to a group. */
static void put_group(rg_h5_file *f, rg_checkpoints *k, const char *name, rg_state_of of) {
    hid_t group = rg_h5_group(f, name);
    for (int i = 0; i < k->state->arrays; i++) {
        const rg_state_array *a = &k->state->array[i];
        if (a->of == of && of == RG_OF_RUN) {
            put_rows(f, group, a);
        } else if (a->of == of) {
            put_elements(f, group, k, a);
        }
    }
    rg_h5_note(f, H5Gclose(group) >= 0, "close", NULL);
}

static void put_all(rg_h5_file *f, rg_checkpoints *k) {
    identity id = identity_of(k);
    rg_h5_note(f, put_identity(f, &id), "describe", "the file");
    put_case(f, k->solver->input);
    put_group(f, k, "run", RG_OF_RUN);
    put_group(f, k, "element", RG_OF_ELEMENT);
    rg_state_table table[RG_MAX_STATE];
    int tables = rg_state_tables(k->state, table);
    for (int t = 0; t < tables; t++) {
        rg_state_table_write(f, &table[t], k->solver, k->slab);
    }
}

/* The name of a checkpoint is on the disk before an older one goes. */
static void sync_folder(const rg_checkpoints *k) {
    bool ok = k->solver->rank != 0 || rg_sync_folder(k->folder);
    rg_h5_file about = {.comm = k->solver->comm, .rank = k->solver->rank};
    rg_h5_agree_on(&about, ok, k->folder, "bring the folder to the disk", strerror(errno));
}

void rg_checkpoint_write(rg_checkpoints *k, int keep) {
    const rg_solver *s = k->solver;
    MPI_Barrier(s->comm); /* so that waiting for a slower rank does not count */
    double begin = MPI_Wtime();
    prepare(k);
    rg_make_directory(k->folder, s->comm);
    char *path = rg_folder_path(k->folder, s->step);
    rg_h5_file f;
    rg_h5_create(&f, path, RG_CHECKSUM, s->comm);
    put_all(&f, k);
    rg_h5_close(&f);
    bool written = rg_checksum_put(f.part, s->step, s->comm);
    rg_h5_agree_on(&f, written, path, "write the checksum of the file", strerror(errno));
    rg_h5_finish(&f, true);
    rg_free(path);
    sync_folder(k);
    if (s->rank == 0) {
        rg_folder_prune(k->folder, keep);
    }
    double seconds = MPI_Wtime() - begin;
    MPI_Bcast(&seconds, 1, MPI_DOUBLE, 0, s->comm);
    k->seconds = rg_realloc(k->seconds, (size_t)k->written + 1, sizeof *k->seconds);
    k->seconds[k->written++] = seconds;
    k->total += seconds;
    k->slowest = seconds > k->slowest ? seconds : k->slowest;
}

static int ascending(const void *a, const void *b) {
    double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

double rg_checkpoints_median(const rg_checkpoints *k) {
    size_t n = (size_t)k->written;
    if (n == 0) {
        return 0;
    }
    double *sorted = RG_NEW(double, n);
    memcpy(sorted, k->seconds, n * sizeof *sorted);
    qsort(sorted, n, sizeof *sorted, ascending);
    double median = (sorted[(n - 1) / 2] + sorted[n / 2]) / 2;
    rg_free(sorted);
    return median;
}

/* ---- reading ---- */

static bool get_attribute(hid_t file, const char *name, hid_t type, void *value) {
    hid_t attribute = H5Aopen(file, name, H5P_DEFAULT), space = attribute < 0 ? -1 : H5Aget_space(attribute);
    bool ok = space >= 0 && H5Sget_simple_extent_npoints(space) == 1 && H5Aread(attribute, type, value) >= 0;
    if (space >= 0) {
        H5Sclose(space);
    }
    return (attribute < 0 || H5Aclose(attribute) >= 0) && ok;
}

static bool get_word(hid_t file, const char *name, char word[WORD]) {
    hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, WORD);
    bool ok = get_attribute(file, name, type, word);
    word[WORD - 1] = '\0';
    H5Tclose(type);
    return ok;
}

static bool get_identity(hid_t file, identity *id) {
    return get_attribute(file, "format", H5T_NATIVE_INT, &id->format) &&
           get_attribute(file, "elements", H5T_NATIVE_INT64, &id->elements) &&
           get_attribute(file, "mesh", H5T_NATIVE_UINT64, &id->mesh) &&
           get_word(file, "precision", id->precision) &&
           get_word(file, "instruction_set", id->instruction_set);
}

/* Ends the run with the lines of `what`; collective, all ranks know. */
static _Noreturn void refuse(const rg_solver *s, const char *path, const char *what) {
    rg_speak(s->comm);
    rg_fatal(RG_USAGE, "%s: %s", path, what);
}

static void check_identity(const rg_checkpoints *k, const char *path, const identity *found) {
    const rg_solver *s = k->solver;
    identity here = identity_of(k);
    char what[300] = "";
    if (found->format != here.format) {
        snprintf(what, sizeof what, "a checkpoint of format %d; this program reads %d", found->format,
                 here.format);
    } else if (found->elements != here.elements) {
        snprintf(what, sizeof what, "a checkpoint of %" PRId64 " elements; the mesh of the case has %" PRId64,
                 found->elements, here.elements);
    } else if (found->mesh != here.mesh) {
        snprintf(what, sizeof what, "a checkpoint on another mesh: vertices or surface sets differ");
    } else if (strcmp(found->precision, here.precision) != 0) {
        snprintf(what, sizeof what, "a checkpoint in %s precision; this program computes in %s precision",
                 found->precision, here.precision);
    }
    if (what[0] != '\0') {
        refuse(s, path, what);
    }
    if (s->rank == 0 && strcmp(found->instruction_set, here.instruction_set) != 0) {
        rg_warn("%s: computed with %s, goes on with %s: the same up to rounding, not to the bit "
                "(RHEGMA_ISA=%s, where the machine has it)",
                path, found->instruction_set, here.instruction_set, found->instruction_set);
    }
}

/* The text of the case in the file; NULL if it cannot be read. The caller frees it. */
static char *get_case(const rg_h5_file *f) {
    hsize_t size[2] = {0, 0};
    hid_t dataset = H5Dopen2(f->file, "case", H5P_DEFAULT), space = dataset < 0 ? -1 : H5Dget_space(dataset);
    bool ok = space >= 0 && H5Sget_simple_extent_ndims(space) == 2 &&
              H5Sget_simple_extent_dims(space, size, NULL) == 2 && size[0] < (1u << 24);
    if (space >= 0) {
        H5Sclose(space);
    }
    if (dataset >= 0) {
        H5Dclose(dataset);
    }
    if (!ok) {
        return NULL;
    }
    char *text = RG_NEW(char, size[0] + 1);
    rg_h5_slab s = {.name = "case",
                    .type = H5T_NATIVE_UINT8,
                    .columns = 1,
                    .rows = (int64_t)size[0],
                    .count = (int64_t)size[0]};
    if (!rg_h5_read(f->file, &s, text)) {
        rg_free(text);
        return NULL;
    }
    return text;
}

static bool check_case(const rg_checkpoints *k, const rg_h5_file *f, const char *path) {
    char *before = get_case(f), *here = rg_case_fixed(k->solver->input);
    bool ok = rg_h5_all(f->comm, before != NULL);
    char *changes = ok ? rg_case_changes(before, here) : NULL;
    if (changes != NULL) {
        refuse(k->solver, path, changes);
    }
    rg_free(before);
    free(here);
    return ok;
}

/* Window by window, as they were written. */
static bool get_elements(hid_t group, rg_checkpoints *k, const rg_state_array *a) {
    size_t bytes = rg_state_bytes(a), rows = rg_slab_window(bytes), most = rg_slab_most(k->slab);
    char *window = make_window(k, rows * bytes);
    element_records records = {a, k->slab->slot};
    rg_h5_slab s = of_elements(k->slab, a);
    int64_t end = s.first + s.count;
    bool ok = true;
    for (size_t first = 0; first < most; first += rows) {
        s.count = end - s.first < (int64_t)rows ? end - s.first : (int64_t)rows;
        ok = rg_h5_read(group, &s, window) && ok;
        rg_slab_scatter(k->slab, first, rows, bytes, window, put_record, &records);
        s.first += s.count;
    }
    return ok;
}

/* Every rank reads all. */
static bool get_rows(hid_t group, const rg_state_array *a) {
    size_t bytes = rg_state_bytes(a);
    char *rows = RG_NEW(char, a->records *bytes);
    rg_h5_slab s = {.name = a->name,
                    .type = rg_state_h5_type(a),
                    .columns = a->count,
                    .rows = (int64_t)a->records,
                    .count = (int64_t)a->records};
    bool ok = rg_h5_read(group, &s, rows);
    for (size_t i = 0; ok && i < a->records; i++) {
        rg_state_put(a, i, rows + i * bytes);
    }
    rg_free(rows);
    return ok;
}

static bool get_group(const rg_h5_file *f, rg_checkpoints *k, const char *name, rg_state_of of) {
    hid_t group = H5Gopen2(f->file, name, H5P_DEFAULT);
    bool ok = rg_h5_all(f->comm, group >= 0);
    for (int i = 0; ok && i < k->state->arrays; i++) {
        const rg_state_array *a = &k->state->array[i];
        if (a->of == of && of == RG_OF_RUN) {
            ok = get_rows(group, a);
        } else if (a->of == of) {
            ok = get_elements(group, k, a);
        }
        ok = rg_h5_all(f->comm, ok);
    }
    if (group >= 0) {
        H5Gclose(group);
    }
    return ok;
}

static bool get_all(rg_h5_file *f, rg_checkpoints *k) {
    rg_solver *s = k->solver;
    bool ok = get_group(f, k, "run", RG_OF_RUN) && get_group(f, k, "element", RG_OF_ELEMENT);
    rg_faces_forget(s); /* what another attempt may have left */
    memset(s->unlinked, 0, s->domain->iblocks * RG_LANES);
    rg_state_table table[RG_MAX_STATE];
    int tables = rg_state_tables(k->state, table);
    for (int t = 0; ok && t < tables; t++) {
        ok = rg_state_table_read(f, &table[t], s, k->slab);
    }
    return ok;
}

/* One checkpoint; false, with the reason, if it is damaged. */
static bool load(rg_checkpoints *k, const char *path, char *reason, size_t size) {
    if (!rg_checksum_holds(path, k->solver->comm, reason, size)) {
        return false;
    }
    rg_h5_file f;
    identity found = {0};
    bool ok =
        rg_h5_open(&f, path, k->solver->comm) && rg_h5_all(k->solver->comm, get_identity(f.file, &found));
    if (ok) {
        check_identity(k, path, &found);
        ok = check_case(k, &f, path) && get_all(&f, k);
    }
    if (!ok) {
        snprintf(reason, size, "it does not hold the state of this case: %s", f.reason);
    }
    rg_h5_close_read(&f);
    return ok;
}

/* Out of the way of those that the run will write: one that stayed would count among the last that are kept.
 */
static void set_aside(const char *path) {
    char *name = rg_realloc(NULL, strlen(path) + 9, 1);
    sprintf(name, "%s.damaged", path);
    if (rename(path, name) != 0) {
        rg_fatal(RG_FAILURE, "%s: cannot be set aside as %s: %s", path, name, strerror(errno));
    }
    rg_free(name);
}

/* Loads the newest good one of `count`; returns its place in the list, or `count`. */
static int load_newest(rg_checkpoints *k, int count, const int64_t *steps) {
    char reason[400];
    for (int i = 0; i < count; i++) {
        char *path = rg_folder_path(k->folder, steps[i]);
        bool ok = load(k, path, reason, sizeof reason);
        if (!ok && k->solver->rank == 0) {
            rg_warn("%s: %s", path, reason);
        }
        rg_free(path);
        if (ok) {
            return i;
        }
    }
    return count;
}

void rg_checkpoint_load(rg_checkpoints *k) {
    const rg_solver *s = k->solver;
    int64_t *steps = NULL;
    prepare(k);
    int count = s->rank == 0 ? rg_folder_list(k->folder, &steps) : 0;
    MPI_Bcast(&count, 1, MPI_INT, 0, s->comm);
    if (s->rank != 0) {
        steps = RG_NEW(int64_t, (size_t)count);
    }
    MPI_Bcast(steps, count, MPI_INT64_T, 0, s->comm);
    if (count == 0) {
        DIR *folder = opendir(k->folder);
        char what[200];
        snprintf(what, sizeof what, "no checkpoint to restart from%s%s", folder == NULL ? ": " : "",
                 folder == NULL ? strerror(errno) : "");
        refuse(s, k->folder, what);
    }
    int good = load_newest(k, count, steps);
    if (good == count) {
        refuse(s, k->folder, "no checkpoint to restart from: all are damaged or cannot be read");
    }
    for (int i = 0; s->rank == 0 && i < good; i++) {
        char *path = rg_folder_path(k->folder, steps[i]);
        set_aside(path);
        rg_free(path);
    }
    rg_free(steps);
}

/* ---- the folder ---- */

bool rg_checkpoints_exist(const char *dir) {
    char *folder = rg_join_path(dir, "checkpoints");
    int64_t *steps;
    int count = rg_folder_list(folder, &steps);
    rg_free(steps);
    rg_free(folder);
    return count > 0;
}

void rg_checkpoints_remove(const char *dir, bool all) {
    char *folder = rg_join_path(dir, "checkpoints");
    rg_folder_clean(folder);
    if (all) {
        rg_folder_prune(folder, 0);
    }
    rg_free(folder);
}
