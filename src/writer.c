/* Field output on parallel HDF5. The layout of fields.h5:
 *
 *   attributes            program, format
 *   /mesh/points          [10 total][3] float64 (m), reference configuration
 *   /mesh/cells           [total][10] int64, 10 i + k: every element has its own nodes
 *   /frames/NNNNNN        attributes step, time (s); one dataset per field, [total][c] or [10 total][c]
 *   /frames/NNNNNN/crack  points [3 n][3] (m), cells [n][3], one dataset per field [n][c]; n may be 0
 *
 * Every field has an attribute unit; one of six components also an attribute components, which names the
 * order they are stored in (XDMF's).
 *
 * A rank's share of a dataset is one contiguous slab, so collective transfers cost nothing extra and let
 * MPI-IO gather small slabs into large writes where that pays. OMPIO, the MPI-IO that Open MPI picks by
 * itself, is reported to corrupt such writes (its ROMIO component is not), hence every rank reads its slab
 * back and compares: most often a copy from the page cache. */
#include "writer.h"

#include <errno.h>
#include <hdf5.h>
#include <inttypes.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "error.h"
#include "h5_reason.h"
#include "mem.h"
#include "xdmf.h"

enum {
    FORMAT_VERSION = 1,
    VERIFY_BYTES = 1 << 20, /* read back at a time */
    GROUP = 48,             /* length of the longest group name: "/frames/", a 64-bit number, "/crack" */
};

struct rg_writer {
    MPI_Comm comm;
    int rank;
    char *h5_path, *xdmf_path;
    int64_t total, first, count;                       /* elements: all, first here, number here */
    int64_t triangles, triangle_first, triangle_count; /* of the current frame's crack, likewise */
    int64_t frames;                                    /* finished so far */
    hid_t file, collective, frame, crack;              /* crack: negative until the frame has one */
    char group[GROUP];                                 /* in which datasets are made now, for messages */
    char reason[RG_H5_REASON];                         /* why the first HDF5 call that failed did so */
    rg_xdmf *xdmf;                                     /* rank 0 only */
};

/* Rows [first, first + count) of `rows` are this rank's. */
typedef struct {
    const char *name;
    hid_t type;
    int columns;
    int64_t rows, first, count;
} slab;

static char *join(const char *dir, const char *name) {
    size_t size = strlen(dir) + strlen(name) + 2;
    char *path = rg_realloc(NULL, size, 1);
    snprintf(path, size, "%s/%s", dir, name);
    return path;
}

/* Collective: goes on if all ranks are `ok`; else the lowest one that is not ends the run, so that a failure
 * common to all is reported once, as "path: cannot verb object: reason". Also a barrier. */
static void agree(const rg_writer *w, bool ok, const char *path, const char *verb, const char *object,
                  const char *reason) {
    int mine = ok ? INT_MAX : w->rank, failed = INT_MAX;
    MPI_Allreduce(&mine, &failed, 1, MPI_INT, MPI_MIN, w->comm);
    if (failed == w->rank) {
        rg_fatal(RG_FAILURE, "%s: cannot %s %s: %s", path, verb, object, reason);
    }
    if (failed != INT_MAX) {
        MPI_Barrier(w->comm); /* until the failed rank ends the job */
    }
}

/* The same for HDF5 calls on dataset `name` of the current group (NULL: on the group itself). */
static void agree_h5(const rg_writer *w, bool ok, const char *verb, const char *name) {
    char object[GROUP + 64];
    snprintf(object, sizeof object, "%s%s%s", w->group, name != NULL ? "/" : "", name != NULL ? name : "");
    bool known = w->reason[0] != '\0';
    agree(w, ok, w->h5_path, verb, object,
          known ? w->reason : "it does not hold what was written (faulty MPI-IO?)");
}

/* ---- attributes ---- */

static bool put_attribute(hid_t object, const char *name, hid_t type, const void *value) {
    hid_t space = H5Screate(H5S_SCALAR);
    hid_t attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    bool ok = attribute >= 0 && H5Awrite(attribute, type, value) >= 0;
    ok = H5Aclose(attribute) >= 0 && ok;
    H5Sclose(space);
    return ok;
}

static bool put_text(hid_t object, const char *name, const char *value) {
    hid_t type = H5Tcopy(H5T_C_S1);
    bool ok = H5Tset_size(type, strlen(value) + 1) >= 0 && put_attribute(object, name, type, value);
    H5Tclose(type);
    return ok;
}

/* ---- datasets ---- */

static hid_t create_dataset(hid_t place, const slab *s) {
    hid_t plan = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_fill_time(plan, H5D_FILL_TIME_NEVER);
    hid_t space = H5Screate_simple(2, (hsize_t[]){(hsize_t)s->rows, (hsize_t)s->columns}, NULL);
    hid_t dataset = H5Dcreate2(place, s->name, s->type, space, H5P_DEFAULT, plan, H5P_DEFAULT);
    H5Sclose(space);
    H5Pclose(plan);
    return dataset;
}

/* Rows [first, first + count) of the dataset. The caller closes the result. */
static hid_t select_rows(hid_t dataset, int columns, int64_t first, int64_t count) {
    hid_t space = H5Dget_space(dataset);
    if (count == 0) {
        H5Sselect_none(space);
    } else {
        H5Sselect_hyperslab(space, H5S_SELECT_SET, (hsize_t[]){(hsize_t)first, 0}, NULL,
                            (hsize_t[]){(hsize_t)count, (hsize_t)columns}, NULL);
    }
    return space;
}

static bool write_slab(const rg_writer *w, hid_t dataset, const slab *s, const void *data) {
    hid_t there = select_rows(dataset, s->columns, s->first, s->count);
    hid_t here = H5Screate_simple(2, (hsize_t[]){(hsize_t)s->count, (hsize_t)s->columns}, NULL);
    bool ok = H5Dwrite(dataset, s->type, here, there, w->collective, data) >= 0;
    H5Sclose(here);
    H5Sclose(there);
    return ok;
}

/* Whether rows [first, first + count) of the dataset are `bytes` of `data`; `buffer` holds as much. */
static bool same_rows(hid_t dataset, const slab *s, int64_t first, int64_t count, const void *data,
                      void *buffer, size_t bytes) {
    hid_t there = select_rows(dataset, s->columns, first, count);
    hid_t here = H5Screate_simple(2, (hsize_t[]){(hsize_t)count, (hsize_t)s->columns}, NULL);
    bool same =
        H5Dread(dataset, s->type, here, there, H5P_DEFAULT, buffer) >= 0 && memcmp(buffer, data, bytes) == 0;
    H5Sclose(here);
    H5Sclose(there);
    return same;
}

/* Whether this rank's slab reads back as `data`. MPI-IO promises so once all ranks have written. */
static bool verify_slab(hid_t dataset, const slab *s, const void *data) {
    size_t row = (size_t)s->columns * H5Tget_size(s->type);
    int64_t step = (int64_t)(VERIFY_BYTES / row);
    char *buffer = rg_realloc(NULL, (size_t)step, row);
    bool same = true;
    for (int64_t i = 0; i < s->count && same; i += step) {
        int64_t n = s->count - i < step ? s->count - i : step;
        same = same_rows(dataset, s, s->first + i, n, (const char *)data + (size_t)i * row, buffer,
                         (size_t)n * row);
    }
    rg_free(buffer);
    return same;
}

/* Collective: writes a whole dataset and its attributes (`unit` NULL: none). */
static void write_dataset(const rg_writer *w, hid_t place, const slab *s, const char *unit,
                          const void *data) {
    hid_t dataset = create_dataset(place, s);
    agree_h5(w, dataset >= 0, "create", s->name);
    bool ok = unit == NULL || put_text(dataset, "unit", unit);
    ok = (s->columns != 6 || put_text(dataset, "components", "xx xy xz yy yz zz")) && ok;
    agree_h5(w, ok, "describe", s->name);
    if (s->rows > 0) {
        agree_h5(w, write_slab(w, dataset, s, data), "write", s->name);
        agree_h5(w, verify_slab(dataset, s, data), "read back", s->name);
    }
    agree_h5(w, H5Dclose(dataset) >= 0, "close", s->name);
}

/* Connectivity where every cell has its own nodes: row i is n i, n i + 1, ... */
static void write_cells(const rg_writer *w, hid_t place, int nodes, int64_t rows, int64_t first,
                        int64_t count) {
    int64_t *cells = rg_realloc(NULL, (size_t)(count * nodes), sizeof *cells);
    for (int64_t i = 0; i < count * nodes; i++) {
        cells[i] = first * nodes + i;
    }
    slab s = {"cells", H5T_NATIVE_INT64, nodes, rows, first, count};
    write_dataset(w, place, &s, NULL, cells);
    rg_free(cells);
}

/* Points of `rows` cells with their own `nodes` nodes. */
static void write_points(const rg_writer *w, hid_t place, int nodes, int64_t rows, int64_t first,
                         int64_t count, const double *x) {
    slab s = {"points", H5T_NATIVE_DOUBLE, 3, nodes * rows, nodes * first, nodes * count};
    write_dataset(w, place, &s, "m", x);
}

/* Symmetric tensors in the order of the file: xx yy zz yz xz xy become xx xy xz yy yz zz. The caller owns the
 * result. */
static double *reorder_tensors(int64_t rows, const double *data) {
    static const int from[6] = {0, 5, 4, 1, 3, 2};
    double *out = rg_realloc(NULL, (size_t)(6 * rows), sizeof *out);
    for (int64_t i = 0; i < rows; i++) {
        for (int k = 0; k < 6; k++) {
            out[6 * i + k] = data[6 * i + from[k]];
        }
    }
    return out;
}

static void write_field(const rg_writer *w, hid_t place, const slab *s, const char *unit,
                        const double *data) {
    double *reordered = s->columns == 6 ? reorder_tensors(s->count, data) : NULL;
    write_dataset(w, place, s, unit, reordered != NULL ? reordered : data);
    rg_free(reordered);
}

/* ---- file ---- */

static hid_t create_file(const char *path, MPI_Comm comm) {
    MPI_Info info;
    MPI_Info_create(&info);
    MPI_Info_set(info, "romio_ds_write", "disable"); /* slabs have no holes to fill by reading first */
    hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    bool ok = H5Pset_fapl_mpio(access, comm, info) >= 0;
    hid_t file = ok ? H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, access) : -1;
    H5Pclose(access);
    MPI_Info_free(&info);
    return file;
}

static hid_t create_group(rg_writer *w) {
    hid_t group = H5Gcreate2(w->file, w->group, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    agree_h5(w, group >= 0, "create", NULL);
    return group;
}

static void write_mesh(rg_writer *w, const double *x) {
    snprintf(w->group, sizeof w->group, "/mesh");
    hid_t mesh = create_group(w);
    write_points(w, mesh, 10, w->total, w->first, w->count, x);
    write_cells(w, mesh, 10, w->total, w->first, w->count);
    H5Gclose(mesh);
    snprintf(w->group, sizeof w->group, "/frames");
    H5Gclose(create_group(w));
}

static void create_h5(rg_writer *w) {
    H5dont_atexit(); /* a rank that ends the run must not wait for others to close the file */
    rg_h5_listen(w->reason);
    w->collective = H5Pcreate(H5P_DATASET_XFER);
    H5Pset_dxpl_mpio(w->collective, H5FD_MPIO_COLLECTIVE);
    w->file = create_file(w->h5_path, w->comm);
    agree(w, w->file >= 0, w->h5_path, "create", "the file", w->reason);
    bool ok = put_text(w->file, "program", "rhegma");
    ok = put_attribute(w->file, "format", H5T_NATIVE_INT, &(int){FORMAT_VERSION}) && ok;
    agree(w, ok, w->h5_path, "describe", "the file", w->reason);
}

rg_writer *rg_writer_open(const char *dir, MPI_Comm comm, int64_t total, int64_t first, int64_t count,
                          const double *x) {
    rg_writer *w = RG_NEW(rg_writer, 1);
    MPI_Comm_dup(comm, &w->comm);
    MPI_Comm_rank(w->comm, &w->rank);
    w->h5_path = join(dir, "fields.h5");
    w->xdmf_path = join(dir, "fields.xdmf");
    w->total = total;
    w->first = first;
    w->count = count;
    w->frame = w->crack = -1;
    w->xdmf = w->rank == 0 ? rg_xdmf_new(total) : NULL;
    create_h5(w);
    write_mesh(w, x);
    return w;
}

/* ---- frames ---- */

/* Makes `part` of the current frame the current group: "" or "/crack". */
static void enter(rg_writer *w, const char *part) {
    snprintf(w->group, sizeof w->group, "/frames/%06" PRId64 "%s", w->frames, part);
}

void rg_writer_frame(rg_writer *w, int64_t step, double time) {
    enter(w, "");
    w->frame = create_group(w);
    bool ok = put_attribute(w->frame, "step", H5T_NATIVE_INT64, &step);
    ok = put_attribute(w->frame, "time", H5T_NATIVE_DOUBLE, &time) && ok;
    agree_h5(w, ok, "describe", NULL);
    if (w->xdmf != NULL) {
        rg_xdmf_frame(w->xdmf, w->group, time);
    }
}

void rg_writer_volume(rg_writer *w, const char *name, const char *unit, enum rg_center center, int components,
                      const double *data) {
    int64_t nodes = center == RG_CENTER_CELL ? 1 : 10;
    slab s = {name, H5T_NATIVE_DOUBLE, components, nodes * w->total, nodes * w->first, nodes * w->count};
    enter(w, "");
    write_field(w, w->frame, &s, unit, data);
    if (w->xdmf != NULL) {
        rg_xdmf_volume(w->xdmf, name, center, components);
    }
}

/* Sets where this rank's `count` triangles stand among those of all ranks, in the order of the ranks. */
static void number_triangles(rg_writer *w, int64_t count) {
    int64_t end = 0;
    MPI_Scan(&count, &end, 1, MPI_INT64_T, MPI_SUM, w->comm);
    w->triangle_first = end - count;
    w->triangle_count = count;
    MPI_Allreduce(&count, &w->triangles, 1, MPI_INT64_T, MPI_SUM, w->comm);
}

void rg_writer_surface(rg_writer *w, int64_t count, const double *x) {
    number_triangles(w, count);
    enter(w, "/crack");
    w->crack = create_group(w);
    write_points(w, w->crack, 3, w->triangles, w->triangle_first, count, x);
    write_cells(w, w->crack, 3, w->triangles, w->triangle_first, count);
    if (w->xdmf != NULL) {
        rg_xdmf_surface(w->xdmf, w->triangles);
    }
}

void rg_writer_surface_field(rg_writer *w, const char *name, const char *unit, int components,
                             const double *data) {
    slab s = {name, H5T_NATIVE_DOUBLE, components, w->triangles, w->triangle_first, w->triangle_count};
    enter(w, "/crack");
    write_field(w, w->crack, &s, unit, data);
    if (w->xdmf != NULL) {
        rg_xdmf_surface_field(w->xdmf, name, components);
    }
}

void rg_writer_frame_end(rg_writer *w) {
    enter(w, "");
    bool ok = w->crack < 0 || H5Gclose(w->crack) >= 0;
    ok = H5Gclose(w->frame) >= 0 && ok;
    ok = H5Fflush(w->file, H5F_SCOPE_GLOBAL) >= 0 && ok;
    agree_h5(w, ok, "finish", NULL);
    w->frame = w->crack = -1;
    w->frames++;
    if (w->xdmf != NULL) {
        rg_xdmf_frame_end(w->xdmf);
        ok = rg_xdmf_write(w->xdmf, w->xdmf_path);
    }
    agree(w, ok, w->xdmf_path, "write", "the file", strerror(errno));
}

void rg_writer_close(rg_writer *w) {
    agree(w, H5Fclose(w->file) >= 0, w->h5_path, "close", "the file", w->reason);
    H5Pclose(w->collective);
    rg_h5_deafen();
    rg_xdmf_free(w->xdmf);
    rg_free(w->h5_path);
    rg_free(w->xdmf_path);
    MPI_Comm_free(&w->comm);
    rg_free(w);
}
