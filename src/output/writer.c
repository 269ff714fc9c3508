/* Field output on parallel HDF5. Every moment is a file of its own, so that what was written cannot be
 * damaged by what is being written, and a restart takes away just what lies behind it. The layout:
 *
 *   fields/mesh.h5        points [10 total][3] float64 (m), reference configuration
 *                         cells [total][10] int64, 10 i + k: every element has its own nodes
 *   fields/NNNNNN.h5      attributes step, time (s); one dataset per field, [total][c] or [10 total][c]
 *                         crack/ points [3 n][3] (m), cells [n][3], one dataset per field [n][c]; n may be 0
 *   fields.h5             attributes program, format; /mesh and /frames/NNNNNN are links to the contents of
 *                         those files: for a reader it is one file
 *
 * Every field has an attribute unit; one of six components also an attribute components, which names the
 * order they are stored in (XDMF's). */
#include "output/writer.h"

#include <errno.h>
#include <hdf5.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/error.h"
#include "base/files.h"
#include "base/h5_parallel.h"
#include "base/mem.h"
#include "output/xdmf.h"

enum { FORMAT_VERSION = 2, CELLS_AT_ONCE = 1 << 13 };

struct rg_writer {
    MPI_Comm comm;
    int rank;
    rg_writer_style style;
    char *dir, *index_path, *xdmf_path;
    int64_t total, first, count;                       /* elements: all, first here, number here */
    int64_t triangles, triangle_first, triangle_count; /* of the current frame's crack, likewise */
    int64_t frames, synced;                            /* finished so far; of these, on the disk */
    rg_h5_file h5;                                     /* of the current frame */
    hid_t crack;                                       /* negative until the frame has one */
    rg_xdmf *xdmf;                                     /* rank 0 only */
};

/* ---- datasets ---- */

static rg_h5_slab real_slab(const rg_writer *w, const char *name, int columns, bool exact) {
    return (rg_h5_slab){.name = name,
                        .type = w->style.single && !exact ? H5T_NATIVE_FLOAT : H5T_NATIVE_DOUBLE,
                        .columns = columns,
                        .deflate = w->style.deflate};
}

static void write_reals(rg_writer *w, hid_t place, const rg_h5_slab *s, const char *unit,
                        const double *data) {
    if (!w->style.single) {
        rg_h5_write(&w->h5, place, s, unit, data);
        return;
    }
    int64_t values = s->count * s->columns;
    float *narrow = rg_realloc(NULL, (size_t)values + 1, sizeof *narrow);
    for (int64_t i = 0; i < values; i++) {
        narrow[i] = (float)data[i];
    }
    rg_h5_write(&w->h5, place, s, unit, narrow);
    rg_free(narrow);
}

/* Connectivity where every cell has its own nodes: row i is n i, n i + 1, ... What is compressed is written
 * at once, by all ranks together. */
static void write_cells(rg_writer *w, hid_t place, int nodes, int64_t rows, int64_t first, int64_t count) {
    int64_t step = w->style.deflate > 0 || count < CELLS_AT_ONCE ? count : CELLS_AT_ONCE;
    int64_t *cells = rg_realloc(NULL, (size_t)(step * nodes) + 1, sizeof *cells);
    rg_h5_slab s = {"cells", H5T_NATIVE_INT64, nodes, rows, first, 0, w->style.deflate};
    hid_t dataset = rg_h5_begin(&w->h5, place, &s, NULL);
    bool once = rows > 0;
    for (int64_t end = first + count; once || s.first < end; once = false) {
        s.count = end - s.first < step ? end - s.first : step;
        for (int64_t i = 0; i < s.count * nodes; i++) {
            cells[i] = s.first * nodes + i;
        }
        rg_h5_put(&w->h5, dataset, &s, cells);
        s.first += s.count;
    }
    rg_h5_note(&w->h5, H5Dclose(dataset) >= 0, "close", s.name);
    rg_free(cells);
}

static int64_t nodes_of(const rg_volume_field *f) {
    return f->center == RG_CENTER_CELL ? 1 : 10;
}

/* Values per cell. */
static size_t width(const rg_volume_field *f) {
    return (size_t)(f->components * nodes_of(f));
}

/* Takes the values of a field from the records of `n` cells, in the order and precision of the file: of
 * tensors xx yy zz yz xz xy become xx xy xz yy yz zz. */
static void extract(const rg_writer *w, const rg_volume_field *f, size_t n, size_t values,
                    const double *record, void *out) {
    static const size_t tensor[6] = {0, 5, 4, 1, 3, 2};
    size_t per_cell = width(f);
    double *wide = out;
    float *narrow = out;
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < per_cell; k++) {
            double x = record[i * values + f->from + (f->components == 6 ? tensor[k] : k)];
            if (w->style.single && !f->exact) {
                narrow[i * per_cell + k] = (float)x;
            } else {
                wide[i * per_cell + k] = x;
            }
        }
    }
}

static rg_h5_slab slab_of(const rg_writer *w, const rg_volume_field *f) {
    rg_h5_slab s = real_slab(w, f->name, f->components, f->exact);
    s.rows = nodes_of(f) * w->total;
    s.first = nodes_of(f) * w->first;
    return s;
}

/* Window by window: the records, then each field of theirs. */
static void write_fields(rg_writer *w, size_t fields, const rg_volume_field *field,
                         const rg_cell_source *source) {
    rg_h5_slab *slab = RG_NEW(rg_h5_slab, fields);
    hid_t *dataset = RG_NEW(hid_t, fields);
    size_t widest = 0;
    for (size_t f = 0; f < fields; f++) {
        slab[f] = slab_of(w, &field[f]);
        dataset[f] = rg_h5_begin(&w->h5, w->h5.file, &slab[f], field[f].unit);
        widest = width(&field[f]) > widest ? width(&field[f]) : widest;
    }
    double *record = RG_NEW(double, source->cells * source->values);
    double *part = RG_NEW(double, source->cells *widest);
    for (size_t k = 0; k < source->windows; k++) {
        size_t n = source->get(source->of, k, record);
        for (size_t f = 0; f < fields; f++) {
            slab[f].count = (int64_t)n * nodes_of(&field[f]);
            extract(w, &field[f], n, source->values, record, part);
            rg_h5_put(&w->h5, dataset[f], &slab[f], part);
            slab[f].first += slab[f].count;
        }
    }
    for (size_t f = 0; f < fields; f++) {
        rg_h5_note(&w->h5, H5Dclose(dataset[f]) >= 0, "close", field[f].name);
    }
    rg_free(part);
    rg_free(record);
    rg_free(dataset);
    rg_free(slab);
}

/* ---- files ---- */

/* "fields/000012.h5"; the mesh for a negative frame. */
static const char *file_name(char name[40], int64_t frame) {
    if (frame < 0) {
        return "fields/mesh.h5";
    }
    snprintf(name, 40, "fields/%06" PRId64 ".h5", frame);
    return name;
}

static char *file_path(const rg_writer *w, int64_t frame) {
    char name[40];
    return rg_join_path(w->dir, file_name(name, frame) + strlen("fields/"));
}

static void create_file(rg_writer *w, int64_t frame) {
    char *path = file_path(w, frame);
    rg_h5_create(&w->h5, path, 0, w->comm);
    rg_free(path);
}

static void write_mesh(rg_writer *w, const rg_cell_source *x) {
    static const rg_volume_field points = {"points", "m", RG_CENTER_NODE, 3, 0, false};
    create_file(w, -1);
    write_fields(w, 1, &points, x);
    write_cells(w, w->h5.file, 10, w->total, w->first, w->count);
    rg_h5_close(&w->h5);
    rg_h5_finish(&w->h5, false);
}

/* fields.h5 with links to all frames so far, in the place of the old one. Rank 0. */
static bool put_links(const rg_writer *w, const char *path) {
    hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    hid_t frames = H5Gcreate2(file, "frames", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    bool ok = frames >= 0 && rg_h5_put_text(file, "program", "rhegma") &&
              rg_h5_put_attribute(file, "format", H5T_NATIVE_INT, &(int){FORMAT_VERSION}) &&
              H5Lcreate_external("fields/mesh.h5", "/", file, "mesh", H5P_DEFAULT, H5P_DEFAULT) >= 0;
    for (int64_t i = 0; ok && i < w->frames; i++) {
        char name[40], link[24];
        snprintf(link, sizeof link, "%06" PRId64, i);
        ok = H5Lcreate_external(file_name(name, i), "/", frames, link, H5P_DEFAULT, H5P_DEFAULT) >= 0;
    }
    ok = (frames < 0 || H5Gclose(frames) >= 0) && ok;
    return H5Fclose(file) >= 0 && ok;
}

static void write_index(rg_writer *w) {
    char reason[RG_H5_REASON] = "";
    bool ok = true;
    if (w->rank == 0) {
        char *part = rg_realloc(NULL, strlen(w->index_path) + 6, 1);
        sprintf(part, "%s.part", w->index_path);
        rg_h5_listen(reason);
        ok = put_links(w, part);
        rg_h5_deafen();
        if (ok && rename(part, w->index_path) != 0) {
            snprintf(reason, sizeof reason, "%s", strerror(errno));
            ok = false;
        }
        rg_free(part);
    }
    rg_h5_file about = {.comm = w->comm, .rank = w->rank};
    rg_h5_agree_on(&about, ok, w->index_path, "write the file", reason);
}

static rg_writer *make(const char *dir, MPI_Comm comm, rg_writer_style style, int64_t total, int64_t first,
                       int64_t count) {
    rg_writer *w = RG_NEW(rg_writer, 1);
    MPI_Comm_dup(comm, &w->comm);
    MPI_Comm_rank(w->comm, &w->rank);
    w->style = style;
    w->dir = rg_join_path(dir, "fields");
    w->index_path = rg_join_path(dir, "fields.h5");
    w->xdmf_path = rg_join_path(dir, "fields.xdmf");
    w->total = total;
    w->first = first;
    w->count = count;
    w->crack = -1;
    w->xdmf = w->rank == 0 ? rg_xdmf_new(total, style.single) : NULL;
    return w;
}

rg_writer *rg_writer_open(const char *dir, MPI_Comm comm, rg_writer_style style, int64_t total, int64_t first,
                          int64_t count, const rg_cell_source *x) {
    rg_writer *w = make(dir, comm, style, total, first, count);
    rg_make_directory(w->dir, comm);
    write_mesh(w, x);
    write_index(w);
    return w;
}

/* ---- restart ---- */

/* The frames before `mark` must be there; the others go. Rank 0; what is missing, in `reason`. */
static bool cut_frames(rg_writer *w, const rg_writer_mark *mark, char *reason, size_t size) {
    for (int64_t i = -1; i < mark->frames; i++) {
        char *path = file_path(w, i);
        bool there = access(path, R_OK) == 0;
        if (!there) {
            snprintf(reason, size, "%s: %s", path, strerror(errno));
        }
        rg_free(path);
        if (!there) {
            return false;
        }
    }
    for (int64_t i = mark->frames, gone = 1; gone != 0; i++) {
        char *path = file_path(w, i);
        gone = remove(path) == 0;
        rg_free(path);
    }
    return true;
}

rg_writer *rg_writer_resume(const char *dir, MPI_Comm comm, rg_writer_style style, int64_t total,
                            int64_t first, int64_t count, const rg_writer_mark *mark) {
    rg_writer *w = make(dir, comm, style, total, first, count);
    w->frames = w->synced = mark->frames;
    char reason[1200] = "it is shorter than at the checkpoint";
    bool ok = true;
    if (w->rank == 0) {
        ok = cut_frames(w, mark, reason, sizeof reason) &&
             (mark->frames == 0 || rg_xdmf_resume(w->xdmf, w->xdmf_path, mark->volume, mark->crack));
        ok = ok && (mark->frames == 0 || rg_xdmf_write(w->xdmf, w->xdmf_path));
    }
    rg_h5_file about = {.comm = w->comm, .rank = w->rank};
    rg_h5_agree_on(&about, ok, w->xdmf_path, "go on with the fields", reason);
    write_index(w);
    return w;
}

rg_writer_mark rg_writer_stand(const rg_writer *w) {
    rg_writer_mark mark = {.frames = w->frames};
    if (w->xdmf != NULL) {
        rg_xdmf_length(w->xdmf, &mark.volume, &mark.crack);
    }
    return mark;
}

void rg_writer_sync(rg_writer *w) {
    bool ok = true;
    for (int64_t i = w->synced == 0 ? -1 : w->synced; w->rank == 0 && ok && i < w->frames; i++) {
        char *path = file_path(w, i);
        ok = rg_sync(path);
        rg_free(path);
    }
    ok = ok && (w->rank != 0 || (rg_sync_folder(w->dir) && rg_sync(w->index_path) &&
                                 (w->frames == 0 || rg_sync(w->xdmf_path))));
    w->synced = w->frames;
    rg_h5_file about = {.comm = w->comm, .rank = w->rank};
    rg_h5_agree_on(&about, ok, w->index_path, "bring the fields to the disk", strerror(errno));
}

/* ---- frames ---- */

void rg_writer_frame(rg_writer *w, int64_t step, double time) {
    create_file(w, w->frames);
    bool ok = rg_h5_put_attribute(w->h5.file, "step", H5T_NATIVE_INT64, &step);
    ok = rg_h5_put_attribute(w->h5.file, "time", H5T_NATIVE_DOUBLE, &time) && ok;
    rg_h5_note(&w->h5, ok, "describe", "the frame");
    if (w->xdmf != NULL) {
        char name[40];
        rg_xdmf_frame(w->xdmf, file_name(name, w->frames), time);
    }
}

void rg_writer_volume(rg_writer *w, size_t fields, const rg_volume_field *field,
                      const rg_cell_source *source) {
    w->h5.group[0] = '\0';
    write_fields(w, fields, field, source);
    for (size_t f = 0; w->xdmf != NULL && f < fields; f++) {
        rg_xdmf_volume(w->xdmf, &field[f]);
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
    w->crack = rg_h5_group(&w->h5, "crack");
    rg_h5_slab s = real_slab(w, "points", 3, false);
    s.rows = 3 * w->triangles;
    s.first = 3 * w->triangle_first;
    s.count = 3 * count;
    write_reals(w, w->crack, &s, "m", x);
    write_cells(w, w->crack, 3, w->triangles, w->triangle_first, count);
    if (w->xdmf != NULL) {
        rg_xdmf_surface(w->xdmf, w->triangles);
    }
}

void rg_writer_surface_field(rg_writer *w, const char *name, const char *unit, int components,
                             const double *data) {
    rg_h5_slab s = real_slab(w, name, components, false);
    s.rows = w->triangles;
    s.first = w->triangle_first;
    s.count = w->triangle_count;
    snprintf(w->h5.group, sizeof w->h5.group, "/crack");
    write_reals(w, w->crack, &s, unit, data);
    if (w->xdmf != NULL) {
        rg_xdmf_surface_field(w->xdmf, name, components);
    }
}

void rg_writer_frame_end(rg_writer *w) {
    rg_h5_note(&w->h5, w->crack < 0 || H5Gclose(w->crack) >= 0, "finish", "the frame");
    w->crack = -1;
    rg_h5_close(&w->h5);
    rg_h5_finish(&w->h5, false);
    w->frames++;
    write_index(w);
    bool ok = true;
    if (w->xdmf != NULL) {
        rg_xdmf_frame_end(w->xdmf);
        ok = rg_xdmf_write(w->xdmf, w->xdmf_path);
    }
    rg_h5_file about = {.comm = w->comm, .rank = w->rank};
    rg_h5_agree_on(&about, ok, w->xdmf_path, "write the file", strerror(errno));
}

void rg_writer_close(rg_writer *w) {
    rg_xdmf_free(w->xdmf);
    rg_free(w->dir);
    rg_free(w->index_path);
    rg_free(w->xdmf_path);
    MPI_Comm_free(&w->comm);
    rg_free(w);
}
