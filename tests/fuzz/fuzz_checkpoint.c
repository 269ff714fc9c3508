/* Checkpoints: a good one, to which the input is a list of changes. The checksum refuses whatever is not what
 * was given its checksum before HDF5 sees it; so bytes change as they are, which must always be refused, and
 * values, attributes and the shapes of datasets change under a new checksum: what else could reach the reader
 * of the state? Files that HDF5 itself would not have written are not made: its parser is not this program's.
 *
 * Input: changes of five bytes: kind, what, where (2 bytes), value. */
#include <hdf5.h>
#include <mpi.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/mem.h"
#include "case/read.h"
#include "diagnostics/state_hash.h"
#include "h5_changes.h"
#include "host.h"
#include "restart/checkpoint.h"
#include "restart/restart.h"
#include "restart/checksum.h"
#include "solver/setup.h"
#include "solver/step.h"

enum { MOST_FIELDS = 96, NAME = 64, ATTRIBUTES = 7, CHANGE = 5, MOST_CHANGES = 16, STEP = 7 };

/* Every kind of state: of elements, of faces, lists, rows; and little of each. */
static const char text[] =
    "mesh: {cells: [1, 1, 2], size: [1e-3, 1e-3, 2e-3], origin: [-0.5e-3, -0.5e-3, -2e-3]}\n"
    "material: {model: neo-hookean, young: 260e9, poisson: 0.21, density: 3690}\n"
    "interface: {law: linear, strength: 400e6, energy: 34}\n"
    "initial: {velocity: {z: 1e4*z}}\n"
    "boundary: [{set: z-, component: z, velocity: 1e8*t}]\n"
    "bodies: [{name: ball, shape: sphere, motion: free, at: [0, 0, 1e-3], radius: 1e-3, density: 8000}]\n"
    "time: {end: 1e-6}\n"
    "output: {interval: 1e-8, fields: []}\n";

typedef struct {
    char name[NAME];
    size_t at, width, values;
    bool real;
} field;

static rg_solver *solver;
static rg_state state;
static rg_restart keep;
static rg_ledger ledger;
static rg_summary summary;
static rg_slab *slab;
static rg_checkpoints checkpoints;

static char dir[80], path[160];
static uint8_t *image, *work; /* the good file; the one of this input */
static size_t image_size, work_size;
static uint64_t good_state;
static int fields;
static field field_of[MOST_FIELDS];
static const char *const attribute[ATTRIBUTES] = {"program", "revision",  "format",         "elements",
                                                  "mesh",    "precision", "instruction_set"};

/* MPI-IO is not what is tested, and slow. */
herr_t __wrap_H5Pset_fapl_mpio(hid_t access, MPI_Comm comm, MPI_Info info);

herr_t __wrap_H5Pset_fapl_mpio(hid_t access, MPI_Comm comm, MPI_Info info) {
    (void)comm;
    (void)info;
    return H5Pset_fapl_sec2(access);
}

/* ---- the good file ---- */

/* A state that no symmetry hides: some faces are broken. */
static void make_state(void) {
    const rg_domain *d = solver->domain;
    for (size_t i = 0; i < d->blocks * RG_LANES * 3 * RG_NODES; i++) {
        solver->u[i] = (rg_real)(1e-9 * (double)(i % 97));
        solver->velocity[i] = (rg_real)(0.01 * (double)(i % 89));
    }
    for (size_t i = 0; i < d->iblocks * RG_LANES; i += 3) {
        double normal[3];
        solver->broken[i] = rg_interface_area(d, i, normal) > 0 ? 5 : 0;
    }
    solver->step = STEP;
    solver->time = 1e-7;
    solver->dt = 1e-9;
    solver->limiting_state = "the spectrum at rest";
    snprintf(keep.limiting_state, sizeof keep.limiting_state, "%s", solver->limiting_state);
}

static herr_t note_field(hid_t file, const char *name, const H5O_info_t *about, void *none) {
    (void)none;
    if (about->type == H5O_TYPE_DATASET) {
        rg_fuzz_require(fields < MOST_FIELDS && strlen(name) < NAME, "the datasets have their places");
        hid_t dataset = H5Dopen2(file, name, H5P_DEFAULT), space = H5Dget_space(dataset),
              type = H5Dget_type(dataset);
        field *f = &field_of[fields];
        *f = (field){.width = H5Tget_size(type),
                     .values = (size_t)H5Sget_simple_extent_npoints(space),
                     .real = H5Tget_class(type) == H5T_FLOAT};
        strcpy(f->name, name);
        f->at = f->values > 0 ? (size_t)H5Dget_offset(dataset) : 0;
        fields += f->values > 0;
        H5Tclose(type);
        H5Sclose(space);
        H5Dclose(dataset);
    }
    return 0;
}

static size_t load_file(uint8_t **data) {
    FILE *f = fopen(path, "rb");
    struct stat about;
    rg_fuzz_require(f != NULL && fstat(fileno(f), &about) == 0, "the file can be read");
    size_t size = (size_t)about.st_size;
    *data = realloc(*data, size + 1);
    rg_fuzz_require(*data != NULL && fread(*data, 1, size, f) == size, "the file can be read");
    fclose(f);
    return size;
}

static void save_file(const uint8_t *data, size_t size) {
    FILE *f = fopen(path, "wb");
    rg_fuzz_require(f != NULL && fwrite(data, 1, size, f) == size && fclose(f) == 0, "the file is written");
}

static void remove_files(void) {
    char folder[120];
    snprintf(folder, sizeof folder, "%s/checkpoints", dir);
    unlink(path);
    rmdir(folder);
    rmdir(dir);
}

int LLVMFuzzerInitialize(int *argc, char ***argv) {
    MPI_Init(argc, argv);
    omp_set_num_threads(1);
    rg_case *input = rg_case_read_text("case.yaml", text, strlen(text), 0, NULL, stderr);
    rg_fuzz_require(input != NULL, "the case");
    solver = rg_solver_make(input, MPI_COMM_SELF);
    rg_restart_register(&state, &keep, solver, &ledger, &summary);
    snprintf(dir, sizeof dir, "%s.d", rg_fuzz_scratch());
    snprintf(path, sizeof path, "%s/checkpoints/step-%012d.h5", dir, STEP);
    atexit(remove_files);
    make_state();
    good_state = rg_state_hash(solver);
    rg_checkpoints_open(&checkpoints, dir, solver, &state, &slab);
    rg_checkpoint_write(&checkpoints, 1);
    image_size = load_file(&image);
    hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    H5Ovisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, note_field, NULL);
    H5Fclose(file);
    return 0;
}

/* ---- changes ---- */

/* Kinds: 0 and 1 damage the given its checksum file, 2 and 3 are values, others go through HDF5. */
enum { BYTE, CUT, VALUE, TEXT, ATTRIBUTE, OTHER_ATTRIBUTE, SHAPE, KINDS };

static size_t where(const uint8_t *c) {
    return (size_t)c[2] + 256 * (size_t)c[3];
}

static void change_value(const uint8_t *c) {
    const field *f = &field_of[c[1] % fields];
    uint8_t *to = work + f->at + where(c) % f->values * f->width;
    int64_t integer = rg_fuzz_integer(c[4]); /* little-endian */
    double real = rg_fuzz_real(c[4]);
    float narrow = (float)real;
    const void *from = !f->real ? (const void *)&integer : f->width == 4 ? (const void *)&narrow : &real;
    memcpy(to, from, f->width);
}

/* A byte of what has bytes: the case, flags, words. */
static void change_text(const uint8_t *c) {
    const field *f = &field_of[c[1] % fields];
    work[f->at + where(c) % (f->values * f->width)] = c[4];
}

static void change_file(hid_t file, const uint8_t *c) {
    int kind = c[0] % KINDS;
    if (kind == ATTRIBUTE || kind == OTHER_ATTRIBUTE) {
        rg_fuzz_change_attribute(file, attribute[c[1] % ATTRIBUTES], rg_fuzz_integer(c[4]),
                                 kind == OTHER_ATTRIBUTE);
    } else if (kind == SHAPE) {
        int64_t rows = where(c) == 65535 ? rg_fuzz_integer(c[1]) : (int64_t)where(c);
        rg_fuzz_change_shape(file, field_of[c[1] % fields].name, rows, c[4]);
    }
}

/* Puts a new checksum on what is in `work` after the changes that a checksum may have; whether there are any.
 */
static bool forge(const uint8_t *data, size_t size) {
    bool values = false, through_h5 = false;
    for (size_t at = 0; at + CHANGE <= size; at += CHANGE) {
        int kind = data[at] % KINDS;
        if (kind == VALUE) {
            change_value(data + at);
        } else if (kind == TEXT) {
            change_text(data + at);
        }
        values = values || kind == VALUE || kind == TEXT;
        through_h5 = through_h5 || kind > TEXT;
    }
    if (!values && !through_h5) {
        return false;
    }
    save_file(work, work_size);
    hid_t file = through_h5 ? H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT) : -1;
    for (size_t at = 0; file >= 0 && at + CHANGE <= size; at += CHANGE) {
        change_file(file, data + at);
    }
    rg_fuzz_require(file < 0 || H5Fclose(file) >= 0, "the changed file is closed");
    rg_fuzz_require(rg_checksum_put(path, STEP, MPI_COMM_SELF), "the changed file has its checksum");
    return true;
}

/* Changes behind the checksum's back; whether any byte is another. */
static bool damage(const uint8_t *data, size_t size) {
    uint8_t *written = NULL;
    size_t length = load_file(&written), left = length;
    uint8_t *now = malloc(length);
    rg_fuzz_require(now != NULL, "memory");
    memcpy(now, written, length);
    for (size_t at = 0; at + CHANGE <= size; at += CHANGE) {
        const uint8_t *c = data + at;
        size_t place = where(c) + 65536 * (size_t)(c[1] % 8);
        if (c[0] % KINDS == BYTE) {
            now[place % length] = c[4];
        } else if (c[0] % KINDS == CUT) {
            left = place % length;
        }
    }
    bool damaged = left < length || memcmp(now, written, length) != 0;
    if (damaged) {
        save_file(now, left);
    }
    free(now);
    free(written);
    return damaged;
}

static void body(const uint8_t *data, size_t size) {
    (void)data;
    (void)size;
    rg_checkpoint_load(&checkpoints);
    rg_restart_spectrum(&keep, solver);
    rg_solver_resume(solver);
    rg_fuzz_require(strlen(solver->limiting_state) < RG_LIMITING_WORDS, "words end");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    size = size < MOST_CHANGES * CHANGE ? size : MOST_CHANGES * CHANGE;
    rg_fuzz_h5_begin();
    work = realloc(work, image_size);
    rg_fuzz_require(work != NULL, "memory");
    memcpy(work, image, image_size);
    work_size = image_size;
    bool forged = forge(data, size);
    if (!forged) {
        save_file(work, work_size);
    }
    bool damaged = damage(data, size), accepted = rg_fuzz_run(body, data, size);
    rg_fuzz_require(!damaged || !accepted, "no damaged file is taken");
    if (!damaged && !forged) {
        rg_fuzz_require(accepted && rg_state_hash(solver) == good_state, "the good file is the state");
    }
    rg_fuzz_h5_close();
    return 0;
}
