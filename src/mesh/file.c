#include "mesh/file.h"

#include <errno.h>
#include <hdf5.h>
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/files.h"
#include "base/h5_reason.h"
#include "base/mem.h"
#include "layout.h"
#include "mesh/check.h"
#include "mesh/rows.h"

struct rg_mesh_file {
    char *path;
    hid_t file;
    char reason[RG_H5_REASON];
    rg_mesh_header head;
};

enum { WHY = RG_H5_REASON + 80 };

/* Datasets with rows for each tile, in the order in which the input errors of an element are told. */
enum { CORNER, NEIGHBOUR, FACE, SET, REGION, PART, ORIGINAL, VERTEX_START, VERTEX, X, DATASETS };
static const rg_rows *const dataset_of[DATASETS] = {[CORNER] = &rg_rows_corner,
                                                    [NEIGHBOUR] = &rg_rows_neighbour,
                                                    [FACE] = &rg_rows_face,
                                                    [SET] = &rg_rows_set,
                                                    [REGION] = &rg_rows_region,
                                                    [PART] = &rg_rows_part,
                                                    [ORIGINAL] = &rg_rows_original,
                                                    [VERTEX] = &rg_rows_vertex,
                                                    [X] = &rg_rows_x,
                                                    [VERTEX_START] = &rg_rows_vertex_start};

enum { MOST_SETS = 1 << 24 };                /* and rows of their combinations */
static const rg_gid most = INT64_C(1) << 40; /* elements or vertices: what a sane header says */

/* "path: dataset: what is wrong" */
static _Noreturn void refuse(const rg_mesh_file *f, const char *dataset, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static void refuse(const rg_mesh_file *f, const char *dataset, const char *format, ...) {
    char what[WHY];
    va_list args;
    va_start(args, format);
    vsnprintf(what, sizeof what, format, args);
    va_end(args);
    rg_fatal(RG_USAGE, "%s: %s: %s", f->path, dataset, what);
}

static void unreadable(const rg_mesh_file *f, char why[WHY]) {
    snprintf(why, WHY, "cannot be read: %s; the file is damaged or not a mesh file",
             f->reason[0] != '\0' ? f->reason : "not what it should be");
}

static _Noreturn void refuse_h5(const rg_mesh_file *f, const char *dataset) {
    char why[WHY];
    unreadable(f, why);
    refuse(f, dataset, "%s", why);
}

/* ---- datasets ---- */

/* Rows begin .. end - 1 of dataset `name`, which must have `rows`; false: cannot be read. */
static bool read_dataset(hid_t place, const char *name, hid_t type, int columns, int64_t rows, int64_t begin,
                         int64_t end, void *out) {
    hsize_t size[2] = {0, 1}, from[2] = {(hsize_t)begin, 0},
            count[2] = {(hsize_t)(end - begin), (hsize_t)columns};
    int rank = columns > 1 ? 2 : 1;
    hid_t dataset = H5Dopen2(place, name, H5P_DEFAULT), space = dataset < 0 ? -1 : H5Dget_space(dataset);
    bool ok = space >= 0 && H5Sget_simple_extent_ndims(space) == rank &&
              H5Sget_simple_extent_dims(space, size, NULL) == rank && size[0] == (hsize_t)rows &&
              size[1] == (hsize_t)columns;
    if (ok && end > begin) {
        hid_t here = H5Screate_simple(rank, count, NULL);
        ok = H5Sselect_hyperslab(space, H5S_SELECT_SET, from, NULL, count, NULL) >= 0 &&
             H5Dread(dataset, type, here, space, H5P_DEFAULT, out) >= 0;
        H5Sclose(here);
    }
    if (space >= 0) {
        H5Sclose(space);
    }
    return (dataset < 0 || H5Dclose(dataset) >= 0) && ok;
}

/* A stretch of a dataset: blocks begin .. end - 1 of `blocks`, where block b has rows start[b - begin] to
 * start[b - begin + 1]. */
typedef struct {
    int64_t rows; /* of the whole dataset */
    int64_t blocks, begin, end;
    const int64_t *start;
} stretch;

/* Whether the blocks are what was written; if not, `why` says so. */
static bool verify(const rg_mesh_file *f, const rg_rows *r, const stretch *s, const void *data,
                   char why[WHY]) {
    char name[80];
    int64_t wrong = -1;
    snprintf(name, sizeof name, "checksum/%s", r->name);
    uint64_t *sum = RG_NEW(uint64_t, (size_t)(s->end - s->begin) + 1);
    bool there = read_dataset(f->file, name, H5T_NATIVE_UINT64, 1, s->blocks, s->begin, s->end, sum);
    for (int64_t b = 0; b < s->end - s->begin && there && wrong < 0; b++) {
        const char *block = (const char *)data + (size_t)(s->start[b] - s->start[0]) * rg_rows_bytes(r);
        wrong = rg_rows_checksum(r, block, s->start[b + 1] - s->start[b]) == sum[b] ? -1 : b;
    }
    rg_free(sum);
    if (!there) {
        snprintf(why, WHY, "its checksum cannot be read: %s", f->reason);
    } else if (wrong >= 0) {
        snprintf(why, WHY, "the checksum of %s %" PRId64 " is wrong; the file is damaged",
                 s->blocks == 1 ? "part" : "tile", s->begin + wrong);
    }
    return there && wrong < 0;
}

/* Reads a stretch, which must have its checksums. NULL: it cannot be read, or is not what was written; `why`
 * says more. The caller owns the result. */
static void *take(const rg_mesh_file *f, const rg_rows *r, const stretch *s, char why[WHY]) {
    int64_t begin = s->start[0], end = s->start[s->end - s->begin];
    hid_t type = rg_rows_type(r);
    void *data = rg_alloc((size_t)(end - begin) + 1, rg_rows_bytes(r));
    bool good = read_dataset(f->file, r->name, type, r->columns, s->rows, begin, end, data);
    if (rg_rows_are_names(r)) {
        H5Tclose(type);
    }
    if (!good) {
        unreadable(f, why);
    } else {
        good = verify(f, r, s, data, why);
    }
    if (!good) {
        rg_free(data);
    }
    return good ? data : NULL;
}

static void *take_whole(const rg_mesh_file *f, const rg_rows *r, int64_t rows) {
    char why[WHY];
    if (rows == 0) {
        return rg_alloc(1, 1);
    }
    void *data = take(f, r, &(stretch){rows, 1, 0, 1, (const int64_t[]){0, rows}}, why);
    if (data == NULL) {
        refuse(f, r->name, "%s", why);
    }
    return data;
}

/* How many rows dataset `r` has. Refuses it unless it has its columns. */
static int64_t count_rows(const rg_mesh_file *f, const rg_rows *r) {
    hsize_t size[2] = {0, 0};
    hid_t dataset = H5Dopen2(f->file, r->name, H5P_DEFAULT);
    hid_t space = dataset < 0 ? -1 : H5Dget_space(dataset);
    bool ok = space >= 0 && H5Sget_simple_extent_ndims(space) == (r->columns > 1 ? 2 : 1) &&
              H5Sget_simple_extent_dims(space, size, NULL) > 0 && size[0] <= 8 * (hsize_t)most &&
              (r->columns == 1 || size[1] == (hsize_t)r->columns);
    if (!ok) {
        refuse_h5(f, r->name);
    }
    H5Sclose(space);
    H5Dclose(dataset);
    return (int64_t)size[0];
}

static void expect_rows(const rg_mesh_file *f, const rg_rows *r, int64_t rows) {
    int64_t there = count_rows(f, r);
    if (there != rows) {
        refuse(f, r->name, "has %" PRId64 " rows, not %" PRId64, there, rows);
    }
}

/* ---- header ---- */

static bool read_attribute(const rg_mesh_file *f, const char *name, hid_t type, hssize_t values, void *out) {
    hid_t attribute = H5Aopen(f->file, name, H5P_DEFAULT),
          space = attribute < 0 ? -1 : H5Aget_space(attribute);
    bool ok =
        space >= 0 && H5Sget_simple_extent_npoints(space) == values && H5Aread(attribute, type, out) >= 0;
    if (space >= 0) {
        H5Sclose(space);
    }
    return (attribute < 0 || H5Aclose(attribute) >= 0) && ok;
}

static int64_t read_count(const rg_mesh_file *f, const char *name, int64_t low, int64_t high) {
    int64_t value = -1;
    if (!read_attribute(f, name, H5T_NATIVE_INT64, 1, &value)) {
        refuse_h5(f, name);
    }
    if (value < low || value > high) {
        refuse(f, name, "%" PRId64 " is not between %" PRId64 " and %" PRId64, value, low, high);
    }
    return value;
}

/* Whether the names are stored as long ones. */
static bool has_long_names(const rg_mesh_file *f, const rg_rows *r) {
    hid_t dataset = H5Dopen2(f->file, r->name, H5P_DEFAULT);
    hid_t type = dataset < 0 ? -1 : H5Dget_type(dataset);
    bool are_long = type >= 0 && H5Tget_class(type) == H5T_STRING && H5Tget_size(type) == RG_SET_NAME;
    if (type >= 0) {
        H5Tclose(type);
    }
    if (dataset >= 0) {
        H5Dclose(dataset);
    }
    return are_long;
}

static void read_names(rg_mesh_file *f, const rg_rows *r, rg_sets *sets) {
    int64_t count = read_count(f, r->name, 0, MOST_SETS);
    if (count > 0) {
        expect_rows(f, r, count); /* before anybody makes room for so many */
    }
    rg_rows as_stored = rg_rows_of_names(r, count > 0 && has_long_names(f, r));
    size_t width = rg_rows_bytes(&as_stored);
    char *rows = take_whole(f, &as_stored, count);
    for (int64_t i = 0; i < count; i++) {
        const char *from = rows + (size_t)i * width;
        if (memchr(from, '\0', width) == NULL) {
            refuse(f, r->name, "name %" PRId64 " has no end", i);
        }
        rg_sets_add(sets, from);
    }
    rg_free(rows);
}

/* Rows begin .. end - 1 are of one combination. */
static bool is_combination(const int32_t *row, int64_t begin, int64_t end, const rg_sets *sets) {
    bool good = end - begin > 1 && row[2 * begin] == sets->combinations;
    for (int64_t i = begin; i < end; i++) {
        good = good && row[2 * i + 1] < sets->count && row[2 * i + 1] > (i > begin ? row[2 * i - 1] : -1);
    }
    return good;
}

static void read_combinations(rg_mesh_file *f, const rg_rows *r, rg_sets *sets) {
    int64_t rows = read_count(f, r->name, 0, MOST_SETS);
    if (rows > 0) {
        expect_rows(f, r, rows);
    }
    int32_t *row = take_whole(f, r, rows), *set = RG_NEW(int32_t, (size_t)rows + 1);
    for (int64_t begin = 0, end; begin < rows; begin = end) {
        for (end = begin; end < rows && row[2 * end] == row[2 * begin]; end++) {
            set[end - begin] = row[2 * end + 1];
        }
        if (!is_combination(row, begin, end, sets)) {
            refuse(f, r->name, "row %" PRId64 " begins no combination of sets", begin);
        }
        rg_sets_combine(sets, (int32_t)(end - begin), set);
    }
    rg_free(row);
    rg_free(set);
}

/* Returns the version. */
static int64_t check_format(const rg_mesh_file *f) {
    char format[32] = "";
    hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, sizeof format);
    bool known = read_attribute(f, "format", type, 1, format) && strcmp(format, "rhegma mesh") == 0;
    H5Tclose(type);
    if (!known) {
        refuse_h5(f, "format");
    }
    int64_t version = read_count(f, "version", 0, INT64_MAX);
    if (version < 1 || version > RG_MESH_VERSION) {
        refuse(f, "version", "%" PRId64 ", but this program reads versions 1 to %d", version,
               RG_MESH_VERSION);
    }
    return version;
}

/* A dataset that is not there, or has another shape, is told here once and not for each tile. */
static void check_datasets(const rg_mesh_file *f) {
    int64_t vertices = count_rows(f, &rg_rows_vertex);
    if (f->head.vertices > vertices) { /* before anybody makes room for so many */
        refuse(f, "vertices", "%" PRId64 ", but the tiles list %" PRId64, f->head.vertices, vertices);
    }
    for (int k = 0; k < DATASETS; k++) {
        char name[80];
        if (k == PART && f->head.parts == 0) {
            continue;
        }
        int64_t rows = k == VERTEX_START       ? f->head.tiles + 1
                       : k == VERTEX || k == X ? vertices
                                               : f->head.elements;
        snprintf(name, sizeof name, "checksum/%s", dataset_of[k]->name);
        expect_rows(f, dataset_of[k], rows);
        expect_rows(f, &(rg_rows){name, RG_ROWS_INT64, 1}, k == VERTEX_START ? 1 : f->head.tiles);
    }
}

static void read_header(rg_mesh_file *f) {
    rg_mesh_header *h = &f->head;
    int64_t version = check_format(f);
    h->elements = read_count(f, "elements", 1, most);
    h->vertices = read_count(f, "vertices", 4, most);
    h->interfaces = read_count(f, "interfaces", 0, 2 * h->elements);
    h->tile_elements = read_count(f, "tile_elements", 1, RG_MOST_TILE);
    int64_t tiles = (h->elements + h->tile_elements - 1) / h->tile_elements;
    h->tiles = read_count(f, "tiles", tiles, tiles);
    if (!read_attribute(f, "box", H5T_NATIVE_DOUBLE, 6, h->box)) {
        refuse_h5(f, "box");
    }
    read_names(f, &rg_rows_surface_sets, &h->surface);
    read_names(f, &rg_rows_volume_sets, &h->volume);
    if (version > 1) {
        read_combinations(f, &rg_rows_surface_combinations, &h->surface);
        read_combinations(f, &rg_rows_volume_combinations, &h->volume);
    }
    if (version > 3) {
        h->parts = (int32_t)read_count(f, "parts", 0, INT32_MAX);
        h->crack = (int32_t)read_count(f, "crack", 0, h->surface.count);
    }
    check_datasets(f);
}

/* A file whose header has not been read yet. */
static rg_mesh_file *open_file(const char *path, rg_input_errors *input_errors) {
    rg_mesh_file *f = RG_NEW(rg_mesh_file, 1);
    f->path = RG_NEW(char, strlen(path) + 1);
    strcpy(f->path, path);
    FILE *probe = rg_open_input(path); /* for the reason, which HDF5 does not tell */
    if (probe == NULL) {
        rg_input_errors_add(input_errors, 0, 0, "cannot be read: %s", strerror(errno));
        return f;
    }
    fclose(probe);
    rg_h5_listen(f->reason);
    f->file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    if (f->file < 0) {
        rg_input_errors_add(
            input_errors, 0, 0,
            "not a mesh file of Rhegma, or a damaged one: %s; 'rhegma mesh IN -o OUT.h5' makes one of "
            "a mesh that Gmsh reads",
            f->reason);
    }
    return f;
}

rg_mesh_file *rg_mesh_file_open(const char *path) {
    rg_input_errors input_errors = {.name = path};
    rg_mesh_file *f = open_file(path, &input_errors);
    rg_input_errors_end(&input_errors);
    read_header(f);
    return f;
}

rg_mesh_file *rg_mesh_file_open_on_all(const char *path, MPI_Comm comm) {
    rg_input_errors input_errors = {.name = path};
    rg_mesh_file *f = open_file(path, &input_errors);
    rg_input_errors_agree(&input_errors, comm);
    read_header(f);
    return f;
}

rg_gid rg_mesh_file_original(const rg_mesh_file *f, rg_gid element) {
    rg_gid original = element;
    read_dataset(f->file, rg_rows_original.name, H5T_NATIVE_INT64, 1, f->head.elements, element, element + 1,
                 &original);
    return original;
}

const rg_mesh_header *rg_mesh_file_header(const rg_mesh_file *f) {
    return &f->head;
}

void rg_mesh_file_close(rg_mesh_file *f) {
    H5Fclose(f->file);
    rg_h5_deafen();
    rg_sets_free(&f->head.surface);
    rg_sets_free(&f->head.volume);
    rg_free(f->path);
    rg_free(f);
}

/* ---- a run of tiles ---- */

/* A run of tiles while it is read. */
typedef struct {
    const rg_mesh_file *file;
    rg_mesh_slab *slab;
    stretch elements, vertices;
    rg_input_errors *input_errors; /* NULL: nobody wants to know them */
    bool good;
} reading;

/* An input error of dataset k, in element `element`. */
static void complain(reading *r, rg_gid element, int k, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

static void complain(reading *r, rg_gid element, int k, const char *format, ...) {
    char what[WHY];
    va_list args;
    va_start(args, format);
    vsnprintf(what, sizeof what, format, args);
    va_end(args);
    r->good = false;
    if (r->input_errors != NULL) {
        rg_input_errors_add(r->input_errors, element, k, "%s: %s", dataset_of[k]->name, what);
    }
}

static void *take_part(reading *r, int k, const stretch *s) {
    char why[WHY];
    void *data = take(r->file, dataset_of[k], s, why);
    if (data == NULL) {
        complain(r, r->slab->first, k, "%s", why);
    }
    return data;
}

/* Where the vertices of the tiles stand. */
static int64_t *take_vertex_start(reading *r, int64_t rows) {
    const stretch *s = &r->elements;
    int64_t tiles = s->end - s->begin, *start = RG_NEW(int64_t, (size_t)tiles + 1);
    char why[WHY];
    bool there = read_dataset(r->file->file, dataset_of[VERTEX_START]->name, H5T_NATIVE_INT64, 1,
                              r->file->head.tiles + 1, s->begin, s->end + 1, start);
    if (!there) {
        unreadable(r->file, why);
        complain(r, r->slab->first, VERTEX_START, "%s", why);
    }
    for (int64_t t = 0; t < tiles && there && r->good; t++) {
        int64_t most_here = 4 * (s->start[t + 1] - s->start[t]);
        if (start[t] < 0 || start[t + 1] < start[t] || start[t + 1] > rows ||
            start[t + 1] - start[t] > most_here) {
            complain(r, s->start[t], VERTEX_START,
                     "the vertices of tile %" PRId64 " cannot stand in rows %" PRId64 " to %" PRId64,
                     s->begin + t, start[t], start[t + 1]);
        }
    }
    return start;
}

static void take_all(reading *r, int64_t rows) {
    rg_mesh_slab *slab = r->slab;
    const stretch *s = &r->elements;
    int64_t *start = take_vertex_start(r, rows), tiles = s->end - s->begin;
    bool placed = r->good;
    slab->corner = take_part(r, CORNER, s);
    slab->neighbour = take_part(r, NEIGHBOUR, s);
    slab->face = take_part(r, FACE, s);
    slab->set = take_part(r, SET, s);
    slab->region = take_part(r, REGION, s);
    slab->part = r->file->head.parts > 0 ? take_part(r, PART, s) : NULL;
    slab->original = take_part(r, ORIGINAL, s);
    r->vertices = (stretch){rows, s->blocks, s->begin, s->end, start};
    if (placed) {
        slab->vertices = start[tiles] - start[0];
        slab->vertex = take_part(r, VERTEX, &r->vertices);
        slab->x = take_part(r, X, &r->vertices);
    }
}

static void check_vertices(reading *r) {
    const stretch *s = &r->vertices;
    int64_t rows = r->slab->vertices;
    if (rows > INT32_MAX / 3) { /* so many positions have 32-bit numbers */
        refuse(r->file, "vertex", "%" PRId64 " vertices are too many at once", rows);
    }
    for (int64_t i = 0; i < rows && r->good; i++) {
        if (r->slab->vertex[i] < 0 || r->slab->vertex[i] >= r->file->head.vertices) {
            complain(r, r->slab->first, VERTEX,
                     "value %" PRId64 " of tile %" PRId64 " is not between 0 and %" PRId64,
                     r->slab->vertex[i], s->begin, r->file->head.vertices - 1);
        }
    }
}

static void check_parts(reading *r) {
    const rg_mesh_slab *slab = r->slab;
    int32_t parts = r->file->head.parts;
    for (rg_gid e = 0; e < slab->elements && slab->part != NULL && r->good; e++) {
        int32_t p = slab->part[e];
        if (p < 0 || p >= parts) {
            complain(r, slab->first + e, PART, "value %d of element %" PRId64 " is not between 0 and %d", p,
                     slab->original[e], parts - 1);
        }
    }
}

/* The first value that is not from `low` to `end` - 1. */
static void check_range(reading *r, int k, const int64_t *value, int64_t count, int columns, int64_t low,
                        int64_t end) {
    for (int64_t i = 0; i < count; i++) {
        if (value[i] < low || value[i] >= end) {
            complain(r, r->slab->first + i / columns, k,
                     "value %" PRId64 " of element %" PRId64 " is not between %" PRId64 " and %" PRId64,
                     value[i], r->slab->original[i / columns], low, end - 1);
            return;
        }
    }
}

static void check_faces(reading *r) {
    for (int64_t i = 0; i < 4 * r->slab->elements; i++) {
        if (r->slab->face[i] < -1 || r->slab->face[i] > 3) {
            complain(r, r->slab->first + i / 4, FACE,
                     "value %d of element %" PRId64 " is not between -1 and 3", r->slab->face[i],
                     r->slab->original[i / 4]);
            return;
        }
    }
}

static void check_groups(reading *r, int k, const int32_t *value, int64_t count, int columns,
                         const rg_sets *sets) {
    for (int64_t i = 0; i < count; i++) {
        if (value[i] < -1 || value[i] >= rg_sets_groups(sets)) {
            complain(r, r->slab->first + i / columns, k,
                     "value %" PRId32 " of element %" PRId64 " is not between -1 and %" PRId32, value[i],
                     r->slab->original[i / columns], rg_sets_groups(sets) - 1);
            return;
        }
    }
}

static void check_values(reading *r) {
    const rg_mesh_slab *slab = r->slab;
    const rg_mesh_header *h = &r->file->head;
    rg_gid faces = 4 * slab->elements;
    check_range(r, CORNER, slab->corner, faces, 4, 0, h->vertices);
    check_range(r, NEIGHBOUR, slab->neighbour, faces, 4, -1, h->elements);
    check_faces(r);
    check_groups(r, SET, slab->set, faces, 4, &h->surface);
    check_groups(r, REGION, slab->region, slab->elements, 1, &h->volume);
    check_parts(r);
    for (rg_gid slot = 0; slot < faces && r->good; slot++) {
        if ((slab->neighbour[slot] < 0) != (slab->face[slot] < 0)) {
            complain(r, slab->first + slot / 4, FACE,
                     "element %" PRId64 " has a neighbour without a face or a face without one",
                     slab->original[slot / 4]);
        }
    }
}

static int64_t find(const rg_gid *list, int64_t count, rg_gid value) {
    int64_t low = 0;
    while (count > 1) {
        int64_t half = count / 2;
        low += list[low + half] <= value ? half : 0;
        count -= half;
    }
    return count > 0 && list[low] == value ? low : -1;
}

/* Fills `at`: where each corner stands among the vertices of its tile. */
static void locate_corners(reading *r) {
    rg_mesh_slab *slab = r->slab;
    const stretch *s = &r->vertices;
    slab->at = RG_NEW(rg_lid, 4 * (size_t)slab->elements);
    for (rg_gid slot = 0; slot < 4 * slab->elements && r->good; slot++) {
        int64_t t = slot / 4 / r->file->head.tile_elements, from = s->start[t] - s->start[0];
        int64_t i = find(slab->vertex + from, s->start[t + 1] - s->start[t], slab->corner[slot]);
        if (i < 0) {
            complain(r, slab->first + slot / 4, VERTEX,
                     "tile %" PRId64 " does not list vertex %" PRId64 " of element %" PRId64, s->begin + t,
                     slab->corner[slot], slab->original[slot / 4]);
        }
        slab->at[slot] = (rg_lid)(from + i);
    }
}

static void check_shapes(reading *r) {
    const rg_mesh_slab *slab = r->slab;
    char what[RG_INPUT_ERROR_WORDS];
    for (rg_gid e = 0; e < slab->elements; e++) {
        double x[4][3];
        for (int i = 0; i < 4; i++) {
            memcpy(x[i], slab->x + 3 * slab->at[4 * e + i], sizeof x[i]);
        }
        if (!rg_tet_sound(x[0], slab->corner + 4 * e, slab->original[e], what)) {
            r->good = false;
            if (r->input_errors != NULL) {
                rg_input_errors_add(r->input_errors, slab->first + e, DATASETS, "%s", what);
            }
        }
    }
}

/* NULL: there are input errors. */
static rg_mesh_slab *read_run(rg_mesh_file *f, int64_t begin, int64_t end, rg_input_errors *input_errors) {
    const rg_mesh_header *h = &f->head;
    rg_mesh_slab *slab = RG_NEW(rg_mesh_slab, 1);
    int64_t *start = RG_NEW(int64_t, (size_t)(end - begin) + 1), rows = count_rows(f, &rg_rows_vertex);
    f->reason[0] = '\0'; /* of this run */
    for (int64_t t = begin; t <= end; t++) {
        rg_gid at = t * h->tile_elements;
        start[t - begin] = at < h->elements ? at : h->elements;
    }
    slab->first = start[0];
    slab->elements = start[end - begin] - start[0];
    reading r = {.file = f,
                 .slab = slab,
                 .elements = {h->elements, h->tiles, begin, end, start},
                 .input_errors = input_errors,
                 .good = true};
    take_all(&r, rows);
    void (*const next[])(reading *) = {check_vertices, check_values, locate_corners, check_shapes};
    for (size_t i = 0; i < sizeof next / sizeof *next && r.good; i++) {
        next[i](&r);
    }
    rg_free((void *)(uintptr_t)r.vertices.start);
    rg_free(start);
    if (!r.good) {
        rg_mesh_slab_free(slab);
    }
    return r.good ? slab : NULL;
}

/* NULL: there are input errors, told tile by tile, so that they are the same whichever tiles are read at
 * once. Halves that are sound are not looked at again: an input error among many tiles is soon found. */
static rg_mesh_slab *read_or_tell(rg_mesh_file *f, int64_t begin, int64_t end,
                                  rg_input_errors *input_errors) {
    bool several = end - begin > 1;
    rg_mesh_slab *slab = read_run(f, begin, end, several ? NULL : input_errors);
    if (slab == NULL && several) {
        int64_t middle = begin + (end - begin) / 2;
        rg_mesh_slab_free(read_or_tell(f, begin, middle, input_errors));
        rg_mesh_slab_free(read_or_tell(f, middle, end, input_errors));
    }
    return slab;
}

rg_mesh_slab *rg_mesh_file_slab(rg_mesh_file *f, int64_t begin, int64_t end, rg_input_errors *input_errors) {
    int64_t before = input_errors->count;
    rg_mesh_slab *slab = read_or_tell(f, begin, end, input_errors);
    if (slab == NULL && input_errors->count == before) {
        refuse(f, "tiles", "%" PRId64 " to %" PRId64 " cannot be read at once", begin, end - 1);
    }
    return slab;
}

void rg_mesh_slab_free(rg_mesh_slab *slab) {
    if (slab == NULL) {
        return;
    }
    void *blocks[] = {slab->vertex, slab->x,   slab->corner, slab->at,   slab->neighbour,
                      slab->face,   slab->set, slab->region, slab->part, slab->original};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
        rg_free(blocks[i]);
    }
    rg_free(slab);
}

/* ---- the graph of tiles ---- */

rg_tile_graph *rg_mesh_file_graph(rg_mesh_file *f) {
    rg_tile_graph *g = RG_NEW(rg_tile_graph, 1);
    int64_t tiles = f->head.tiles;
    g->elements = f->head.elements;
    g->tile = (int)f->head.tile_elements;
    g->tiles = tiles;
    g->start = take_whole(f, &rg_rows_tile_start, tiles + 1);
    for (int64_t t = 0; t < tiles; t++) {
        if (g->start[t] > g->start[t + 1]) {
            refuse(f, "tile_start", "descends at tile %" PRId64, t);
        }
    }
    int64_t rows = g->start[tiles]; /* none, where no tile touches another: the datasets are not there then */
    if (g->start[0] != 0 || (rows > 0 && count_rows(f, &rg_rows_tile_neighbour) != rows)) {
        refuse(f, "tile_start", "does not span the rows of tile_neighbour");
    }
    g->neighbour = take_whole(f, &rg_rows_tile_neighbour, rows);
    g->faces = take_whole(f, &rg_rows_tile_faces, rows);
    for (int64_t i = 0; i < rows; i++) {
        if (g->neighbour[i] < 0 || g->neighbour[i] >= tiles) {
            refuse(f, "tile_neighbour", "value %" PRId64 " is not between 0 and %" PRId64, g->neighbour[i],
                   tiles - 1);
        }
    }
    return g;
}

bool rg_mesh_file_partition(rg_mesh_file *f, int parts, int32_t *owner) {
    char name[32];
    snprintf(name, sizeof name, "partition_%d", parts);
    if (H5Lexists(f->file, name, H5P_DEFAULT) <= 0) {
        return false;
    }
    int32_t *stored = take_whole(f, &(rg_rows){name, RG_ROWS_INT32, 1}, f->head.tiles);
    bool *used = RG_NEW(bool, (size_t)parts);
    for (int64_t t = 0; t < f->head.tiles; t++) {
        if (stored[t] < 0 || stored[t] >= parts) {
            refuse(f, name, "tile %" PRId64 " belongs to rank %d of %d", t, stored[t], parts);
        }
        owner[t] = stored[t];
        used[stored[t]] = true;
    }
    for (int p = 0; p < parts; p++) {
        if (!used[p]) {
            refuse(f, name, "rank %d has no tile", p);
        }
    }
    rg_free(used);
    rg_free(stored);
    return true;
}

static int ascending(const void *a, const void *b) {
    int p = *(const int *)a, q = *(const int *)b;
    return (p > q) - (p < q);
}

int rg_mesh_file_partitions(rg_mesh_file *f, int **parts) {
    H5G_info_t all = {0};
    int count = 0;
    H5Gget_info(f->file, &all);
    *parts = RG_NEW(int, (size_t)all.nlinks + 1);
    for (hsize_t i = 0; i < all.nlinks; i++) {
        char name[32] = "", rest;
        H5Lget_name_by_idx(f->file, ".", H5_INDEX_NAME, H5_ITER_NATIVE, i, name, sizeof name, H5P_DEFAULT);
        count += sscanf(name, "partition_%d%c", &(*parts)[count], &rest) == 1;
    }
    qsort(*parts, (size_t)count, sizeof **parts, ascending);
    return count;
}

/* ---- the whole ---- */

/* One position for each vertex from those that the tiles list, [vertices][3]. */
static double *merge_positions(const rg_mesh_file *f, const rg_mesh_slab *slab,
                               rg_input_errors *input_errors) {
    double *x = RG_NEW(double, 3 * (size_t)f->head.vertices);
    int8_t *seen = RG_NEW(int8_t, (size_t)f->head.vertices);
    rg_gid used = 0;
    for (rg_gid i = 0; i < slab->vertices; i++) {
        rg_gid v = slab->vertex[i];
        if (seen[v] == 0) {
            memcpy(x + 3 * v, slab->x + 3 * i, 3 * sizeof *x);
            used++;
        } else if (seen[v] == 1 && memcmp(x + 3 * v, slab->x + 3 * i, 3 * sizeof *x) != 0) {
            rg_input_errors_add(input_errors, v, 0, "x: vertex %" PRId64 " is at two places", v);
            seen[v] = 2;
        }
        seen[v] = seen[v] == 2 ? 2 : 1;
    }
    if (used != f->head.vertices) {
        rg_input_errors_add(input_errors, -1, 0, "vertices: %" PRId64 ", but the elements use %" PRId64,
                            f->head.vertices, used);
    }
    rg_free(seen);
    return x;
}

/* The arrays of the slab and the names of the sets become the mesh's. */
static rg_mesh *adopt(rg_mesh_slab *slab, double *x, rg_mesh_header *h) {
    rg_mesh *mesh = RG_NEW(rg_mesh, 1);
    *mesh = (rg_mesh){.vertices = h->vertices,
                      .elements = slab->elements,
                      .tile = (int)h->tile_elements,
                      .x = x,
                      .corner = slab->corner,
                      .neighbour = slab->neighbour,
                      .face = slab->face,
                      .set = slab->set,
                      .surface = h->surface,
                      .original = slab->original,
                      .region = slab->region,
                      .part = slab->part,
                      .crack = h->crack,
                      .volume = h->volume};
    h->surface = h->volume = (rg_sets){.count = 0};
    rg_free(slab->vertex);
    rg_free(slab->x);
    rg_free(slab->at);
    rg_free(slab);
    return mesh;
}

static void check_box(const rg_mesh_file *f, const rg_mesh *mesh) {
    double box[2][3];
    rg_mesh_box_around(mesh, box);
    if (memcmp(box, f->head.box, sizeof box) != 0) {
        refuse(f, "box", "is not that of the vertices");
    }
}

rg_mesh *rg_mesh_file_read(const char *path) {
    rg_input_errors input_errors = {.name = path};
    rg_mesh_file *f = rg_mesh_file_open(path);
    rg_mesh_slab *slab = rg_mesh_file_slab(f, 0, f->head.tiles, &input_errors);
    rg_input_errors_end(&input_errors);
    double *x = merge_positions(f, slab, &input_errors);
    rg_input_errors_end(&input_errors);
    rg_mesh *mesh = adopt(slab, x, &f->head);
    check_box(f, mesh);
    rg_mesh_check(mesh, path);
    rg_mesh_file_close(f);
    return mesh;
}
