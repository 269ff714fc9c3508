#include "solver/stress_of_run.h"

#include <hdf5.h>
#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "base/error.h"
#include "base/files.h"
#include "base/first_bad.h"
#include "base/h5_parallel.h"
#include "base/mem.h"
#include "domain/slab.h"

/* Doubles of an element's record: its ten nodes, of which the first four are corners; then its stress in the
 * order of the file, xx xy xz yy yz zz. */
enum { POINTS = 30, STRESS = 6, RECORD = POINTS + STRESS };

/* By so much of the body's size may nodes lie apart: fields in single precision round them. */
#define SAME 1e-6

_Noreturn static void refuse(const rg_solver *s, const char *what) {
    rg_speak(s->comm);
    rg_fatal(RG_USAGE, "%s: initial.stress.run: %s: %s", s->input->path, s->input->stress_of.run, what);
}

/* Moments that the run has written; 0: no field output is there. Rank 0. */
static int64_t count_frames(const char *dir) {
    char *path = rg_join_path(dir, "fields.h5"), reason[RG_H5_REASON];
    H5G_info_t about = {.nlinks = 0};
    rg_h5_listen(reason);
    FILE *there = rg_open_input(path);
    if (there != NULL) {
        fclose(there);
        hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
        hid_t frames = file >= 0 ? H5Gopen2(file, "frames", H5P_DEFAULT) : -1;
        if (frames >= 0) {
            H5Gget_info(frames, &about);
            H5Gclose(frames);
        }
        if (file >= 0) {
            H5Fclose(file);
        }
    }
    rg_h5_deafen();
    rg_free(path);
    return (int64_t)about.nlinks;
}

static int64_t choose_frame(const rg_solver *s) {
    int64_t frames = s->rank == 0 ? count_frames(s->input->stress_of.run) : 0,
            asked = s->input->stress_of.frame;
    MPI_Bcast(&frames, 1, MPI_INT64_T, 0, s->comm);
    if (frames == 0) {
        refuse(s, "there is no field output here (output.fields of that run)");
    }
    if (asked >= frames) {
        char words[80];
        snprintf(words, sizeof words, "it has no frame %" PRId64 "; allowed: 0 to %" PRId64 ", or -1", asked,
                 frames - 1);
        refuse(s, words);
    }
    return asked < 0 ? frames - 1 : asked;
}

/* Rows of this rank's slab of a dataset that has all elements; `each`: of an element. */
static bool read_part(const rg_solver *s, const rg_slab *slab, const char *file, const char *name, int each,
                      int columns, double *out) {
    char *path = rg_join_path(s->input->stress_of.run, file);
    rg_h5_file f;
    char reason[RG_H5_REASON];
    rg_h5_listen(reason);
    bool ok = rg_h5_open(&f, path, s->comm);
    rg_h5_slab rows = {.name = name,
                       .type = H5T_NATIVE_DOUBLE,
                       .columns = columns,
                       .rows = slab->total * each,
                       .first = slab->first * each,
                       .count = (int64_t)slab->count * each};
    ok = ok && rg_h5_all(s->comm, rg_h5_read(f.file, &rows, out));
    rg_h5_close_read(&f);
    rg_h5_deafen();
    rg_free(path);
    return ok;
}

typedef struct {
    rg_solver *s;
    const rg_slab *slab;
    const int16_t *set;
    double near; /* as far apart may nodes be (m) */
    int64_t taken;
    rg_first_bad other; /* an element that is not the same there */
} destination;

/* Whether the corners are those of the element; the file has the first two the other way round where they are
 * not right-handed. */
static bool is_same(const double *corner, const double *there, double near) {
    for (int swap = 0; swap < 2; swap++) {
        double most = 0;
        for (int k = 0; k < 12; k++) {
            int from = k < 6 && swap == 1 ? (k + 3) % 6 : k;
            most = fmax(most, fabs(there[from] - corner[k]));
        }
        if (most <= near) {
            return true;
        }
    }
    return false;
}

static void put_element(const void *of, size_t i, void *in) {
    static const int order[STRESS] = {0, 3, 5, 4, 2, 1}; /* where xx yy zz yz xz xy stand there */
    destination *to = (destination *)(uintptr_t)of;
    const double *record = in;
    size_t slot = (size_t)to->slab->slot[i];
    const double *corner = to->s->domain->corner + 12 * slot;
    if (!is_same(corner, record, to->near)) {
#pragma omp critical
        rg_first_bad_note(&to->other, to->s->domain->id[slot], corner, 0);
    }
    if (to->set[slot] >= 0) {
        return;
    }
#pragma omp atomic
    to->taken++;
    rg_real *block = to->s->prestress + slot / RG_LANES * RG_PRESTRESS_BLOCK + slot % RG_LANES;
    for (int k = 0; k < RG_PRESTRESS; k++) {
        block[(size_t)k * RG_LANES] = (rg_real)record[POINTS + order[k % STRESS]];
    }
}

/* The records of this rank's slab go to the elements. */
static void scatter(rg_slab *slab, const double *point, const double *stress, destination *to) {
    size_t bytes = RECORD * sizeof(double), rows = rg_slab_window(bytes);
    double *window = RG_NEW(double, rows *RECORD);
    for (size_t first = 0; first < rg_slab_most(slab); first += rows) {
        for (size_t k = 0; k < rows && first + k < slab->count; k++) {
            memcpy(window + k * RECORD, point + (first + k) * POINTS, POINTS * sizeof(double));
            memcpy(window + k * RECORD + POINTS, stress + (first + k) * STRESS, STRESS * sizeof(double));
        }
        rg_slab_scatter(slab, first, rows, bytes, (char *)window, put_element, to);
    }
    rg_free(window);
}

static void check_finite(const rg_solver *s, const double *stress, size_t count) {
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        sum += 0 * stress[i];
    }
    if (!rg_h5_all(s->comm, sum == 0)) {
        refuse(s, "its stress is not finite everywhere");
    }
}

void rg_stress_of_run(rg_solver *s, const int16_t *set) {
    const double(*box)[3] = (const double(*)[3])s->part->box;
    char file[40];
    snprintf(file, sizeof file, "fields/%06" PRId64 ".h5", choose_frame(s));
    rg_slab *slab = rg_slab_make(s->domain, s->part->total, s->comm);
    double *point = RG_NEW(double, slab->count *POINTS + 1),
           *stress = RG_NEW(double, slab->count *STRESS + 1);
    if (!read_part(s, slab, "fields/mesh.h5", "points", RG_NODES, 3, point)) {
        refuse(s, "its fields are not those of all elements of this mesh (another mesh, or output.region)");
    }
    if (!read_part(s, slab, file, "stress", 1, STRESS, stress)) {
        refuse(s, "its field `stress` is not there or cannot be read (output.fields of that run)");
    }
    check_finite(s, stress, slab->count * STRESS);
    destination to = {.s = s, .slab = slab, .set = set, .other = {.which = RG_NOWHERE}};
    for (int c = 0; c < 3; c++) {
        to.near = fmax(to.near, SAME * fmax(fabs(box[0][c]), fabs(box[1][c])));
    }
    scatter(slab, point, stress, &to);
    rg_free(point);
    rg_free(stress);
    rg_slab_free(slab);
    if (rg_first_bad_lowest(&to.other, s->comm)) {
        char words[120];
        snprintf(words, sizeof words,
                 "its mesh is another one: element %" PRId64 " at (%g, %g, %g) is not there", to.other.which,
                 to.other.x[0], to.other.x[1], to.other.x[2]);
        refuse(s, words);
    }
    MPI_Allreduce(MPI_IN_PLACE, &to.taken, 1, MPI_INT64_T, MPI_SUM, s->comm);
    if (to.taken == 0) {
        refuse(s, "no element takes its stress: all are of initial.sets");
    }
}
