/* Files of VTK in XML: a head that says where each array begins in the bytes behind it, which follow as they
 * are. The field output is read in pieces, so that a large run takes little memory. */
#include "output/export.h"

#include <hdf5.h>
#include <inttypes.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/files.h"
#include "base/h5_parallel.h"
#include "base/h5_reason.h"
#include "base/mem.h"
#include "base/vector.h"

enum { NAME = 64, ROWS = 1 << 14 /* read at once */, TENSOR = 6 };

/* An array of the output file, most often a dataset. */
typedef struct {
    char name[NAME];
    const char *type; /* VTK's word */
    hid_t from;       /* negative: COUNTING, the numbers 0, 1, ...; ENDS, of cells; TYPES, of cells */
    hid_t in_memory;
    size_t size; /* of a value */
    hsize_t rows;
    int columns;
    bool of_points;
} array;

enum { COUNTING = -1, ENDS = -2, TYPES = -3 };

typedef struct {
    const char *dir;
    char *path; /* of fields.h5 */
    hid_t file, frames;
    hsize_t count; /* of frames */
    hid_t place;   /* of the frame */
    char reason[RG_H5_REASON];
} source;

typedef struct {
    source *from;
    hsize_t cells;
    int nodes; /* of a cell */
    int shape; /* VTK's number */
    array *of; /* points and connectivity among them */
    size_t arrays;
    bool is_surface;
} grid;

/* ---- the run ---- */

static _Noreturn void refuse(const source *s, const char *what) {
    rg_fatal(RG_USAGE, "%s: %s%s%s", s->path, what, s->reason[0] != '\0' ? ": " : "", s->reason);
}

static void open_source(source *s, const char *dir) {
    *s = (source){.dir = dir, .path = rg_join_path(dir, "fields.h5")};
    FILE *there = rg_open_input(s->path);
    if (there == NULL) {
        refuse(s, "there is no field output here (output.fields)");
    }
    fclose(there);
    rg_h5_listen(s->reason);
    s->file = H5Fopen(s->path, H5F_ACC_RDONLY, H5P_DEFAULT);
    s->frames = s->file >= 0 ? H5Gopen2(s->file, "frames", H5P_DEFAULT) : -1;
    H5G_info_t about;
    if (s->frames < 0 || H5Gget_info(s->frames, &about) < 0) {
        refuse(s, "cannot be read");
    }
    s->count = about.nlinks;
    if (s->count == 0) {
        refuse(s, "the run has written no fields yet");
    }
}

static hid_t open_frame(source *s, hsize_t number) {
    char name[24];
    snprintf(name, sizeof name, "%06" PRIu64, (uint64_t)number);
    hid_t place = H5Gopen2(s->frames, name, H5P_DEFAULT);
    if (place < 0) {
        refuse(s, "a moment cannot be read");
    }
    return place;
}

static double time_of(source *s, hid_t place) {
    double time = NAN;
    hid_t attribute = H5Aopen(place, "time", H5P_DEFAULT);
    if (attribute < 0 || H5Aread(attribute, H5T_NATIVE_DOUBLE, &time) < 0 || H5Aclose(attribute) < 0) {
        refuse(s, "a moment has no time");
    }
    return time;
}

static double time_of_frame(source *s, hsize_t number) {
    hid_t place = open_frame(s, number);
    double time = time_of(s, place);
    H5Gclose(place);
    return time;
}

static void close_source(source *s) {
    H5Gclose(s->frames);
    H5Fclose(s->file);
    rg_h5_deafen();
    rg_free(s->path);
}

void rg_export_list(const char *dir, FILE *out) {
    source s;
    open_source(&s, dir);
    for (hsize_t i = 0; i < s.count; i++) {
        fprintf(out, "%6" PRIu64 "  %.9g s\n", (uint64_t)i, time_of_frame(&s, i));
    }
    close_source(&s);
}

/* The earlier one of two that are as near. */
static hsize_t nearest_frame(source *s, double time) {
    hsize_t best = s->count - 1;
    for (hsize_t i = s->count; isfinite(time) && i-- > 0;) {
        best = fabs(time_of_frame(s, i) - time) <= fabs(time_of_frame(s, best) - time) ? i : best;
    }
    return best;
}

/* ---- arrays ---- */

/* A dataset as an array of the grid. */
static void add_dataset(grid *g, hid_t place, const char *name, bool points) {
    source *s = g->from;
    array a = {.from = H5Dopen2(place, name, H5P_DEFAULT)};
    hid_t type = a.from >= 0 ? H5Dget_type(a.from) : -1;
    hid_t space = a.from >= 0 ? H5Dget_space(a.from) : -1;
    hsize_t extent[2] = {0, 1};
    if (type < 0 || space < 0 || H5Sget_simple_extent_ndims(space) != 2 || strlen(name) >= NAME ||
        H5Sget_simple_extent_dims(space, extent, NULL) < 0) {
        refuse(s, "the fields of this moment cannot be read");
    }
    strcpy(a.name, name);
    a.size = H5Tget_size(type) == 4 ? 4 : 8;
    a.type = a.size == 4 ? "Float32" : "Float64";
    a.in_memory = a.size == 4 ? H5T_NATIVE_FLOAT : H5T_NATIVE_DOUBLE;
    H5Tclose(type);
    H5Sclose(space);
    a.rows = extent[0];
    a.columns = (int)extent[1];
    a.of_points = points || (!g->is_surface && a.rows == (hsize_t)g->nodes * g->cells);
    if (!a.of_points && a.rows != g->cells) {
        refuse(s, "a field has neither the rows of the points nor those of the elements");
    }
    g->of = rg_realloc(g->of, g->arrays + 1, sizeof *g->of);
    g->of[g->arrays++] = a;
}

static void add_made(grid *g, const char *name, const char *type, int kind, hsize_t rows) {
    array a = {.type = type, .from = kind, .size = kind == TYPES ? 1 : 8, .rows = rows, .columns = 1};
    strcpy(a.name, name);
    g->of = rg_realloc(g->of, g->arrays + 1, sizeof *g->of);
    g->of[g->arrays++] = a;
}

static herr_t add_field(hid_t place, const char *name, const H5L_info_t *about, void *data) {
    grid *g = data;
    H5O_info_t object;
    (void)about;
    if (H5Oget_info_by_name(place, name, &object, H5P_DEFAULT) >= 0 && object.type == H5O_TYPE_DATASET &&
        strcmp(name, "points") != 0 && strcmp(name, "cells") != 0) {
        add_dataset(g, place, name, false);
    }
    return 0;
}

/* First points, connectivity, ends and types of cells, then the fields by name. */
static void describe(grid *g, hid_t shape) {
    hid_t dataset = H5Dopen2(shape, "points", H5P_DEFAULT);
    hid_t space = dataset >= 0 ? H5Dget_space(dataset) : -1;
    hsize_t extent[2] = {0, 0};
    if (space < 0 || H5Sget_simple_extent_ndims(space) != 2 ||
        H5Sget_simple_extent_dims(space, extent, NULL) < 0) {
        refuse(g->from, "its points cannot be read");
    }
    H5Sclose(space);
    H5Dclose(dataset);
    g->cells = extent[0] / (hsize_t)g->nodes;
    add_dataset(g, shape, "points", true);
    add_made(g, "connectivity", "Int64", COUNTING, (hsize_t)g->nodes * g->cells);
    add_made(g, "offsets", "Int64", ENDS, g->cells);
    add_made(g, "types", "UInt8", TYPES, g->cells);
    if (H5Literate(g->is_surface ? shape : g->from->place, H5_INDEX_NAME, H5_ITER_INC, NULL, add_field, g) <
        0) {
        refuse(g->from, "the fields of this moment cannot be read");
    }
}

/* Of tensors xx xy xz yy yz zz become xx yy zz xy yz xz, as VTK has them: what stands at index i. */
static const size_t from_index[TENSOR] = {0, 3, 5, 1, 4, 2};

static void sort_doubles(double *value, size_t rows) {
    for (double row[TENSOR]; rows > 0; rows--, value += TENSOR) {
        memcpy(row, value, sizeof row);
        for (size_t k = 0; k < TENSOR; k++) {
            value[k] = row[from_index[k]];
        }
    }
}

static void sort_floats(float *value, size_t rows) {
    for (float row[TENSOR]; rows > 0; rows--, value += TENSOR) {
        memcpy(row, value, sizeof row);
        for (size_t k = 0; k < TENSOR; k++) {
            value[k] = row[from_index[k]];
        }
    }
}

/* Rows [first, first + count). */
static void read_rows(const source *s, const array *a, hsize_t first, hsize_t count, void *out) {
    hsize_t start[2] = {first, 0}, rows[2] = {count, (hsize_t)a->columns};
    hid_t space = H5Dget_space(a->from), memory = H5Screate_simple(2, rows, NULL);
    bool ok = H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, rows, NULL) >= 0 &&
              H5Dread(a->from, a->in_memory, memory, space, H5P_DEFAULT, out) >= 0;
    H5Sclose(memory);
    H5Sclose(space);
    if (!ok) {
        refuse(s, "a field cannot be read");
    }
    if (a->columns == TENSOR) {
        a->size == sizeof(float) ? sort_floats(out, (size_t)count) : sort_doubles(out, (size_t)count);
    }
}

static void make_rows(const grid *g, const array *a, hsize_t first, hsize_t count, unsigned char *out) {
    for (hsize_t i = 0; a->from != TYPES && i < count; i++) {
        int64_t number = (int64_t)(first + i);
        number = a->from == ENDS ? (number + 1) * g->nodes : number;
        memcpy(out + i * sizeof number, &number, sizeof number);
    }
    if (a->from == TYPES) {
        memset(out, g->shape, count);
    }
}

static uint64_t bytes_of(const array *a) {
    return (uint64_t)a->rows * (uint64_t)a->columns * a->size;
}

static void write_array(const grid *g, const array *a, FILE *out) {
    uint64_t bytes = bytes_of(a);
    unsigned char *part = RG_NEW(unsigned char, (size_t)ROWS *(size_t)a->columns * a->size);
    fwrite(&bytes, sizeof bytes, 1, out);
    for (hsize_t first = 0; first < a->rows; first += ROWS) {
        hsize_t count = a->rows - first < ROWS ? a->rows - first : ROWS;
        if (a->from < 0) {
            make_rows(g, a, first, count, part);
        } else {
            read_rows(g->from, a, first, count, part);
        }
        fwrite(part, a->size * (size_t)a->columns, (size_t)count, out);
    }
    rg_free(part);
}

/* ---- XML ---- */

static void put_array(const array *a, uint64_t *offset, FILE *out) {
    static const char *const component[TENSOR] = {"XX", "YY", "ZZ", "XY", "YZ", "XZ"};
    fprintf(out, "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\"", a->type, a->name,
            a->columns);
    for (int k = 0; a->columns == TENSOR && k < TENSOR; k++) {
        fprintf(out, " ComponentName%d=\"%s\"", k, component[k]);
    }
    fprintf(out, " format=\"appended\" offset=\"%" PRIu64 "\"/>\n", *offset);
    *offset += bytes_of(a) + sizeof(uint64_t);
}

/* The arrays of a section, in the order of the bytes. */
enum { POINTS = 1, CELLS = 4, POLYS = 3 };

static void put_section(const grid *g, const char *name, size_t from, size_t to, uint64_t *offset,
                        FILE *out) {
    fprintf(out, "<%s>\n", name);
    for (size_t i = from; i < to; i++) {
        put_array(&g->of[i], offset, out);
    }
    fprintf(out, "</%s>\n", name);
}

static int points_first(const void *a, const void *b) {
    const array *p = a, *q = b;
    return p->of_points != q->of_points ? (p->of_points ? -1 : 1) : strcmp(p->name, q->name);
}

static void write_xml(grid *g, double time, bool polygons, FILE *out) {
    const char *kind = polygons ? "PolyData" : "UnstructuredGrid";
    size_t shape = polygons ? POLYS : CELLS, points = CELLS;
    uint64_t offset = 0;
    qsort(g->of + CELLS, g->arrays - CELLS, sizeof *g->of, points_first);
    while (points < g->arrays && g->of[points].of_points) {
        points++;
    }
    if (polygons) { /* all are triangles */
        g->of[POLYS].rows = 0;
    }
    int one = 1;
    fprintf(out,
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"%s\" version=\"1.0\" byte_order=\"%s\" "
            "header_type=\"UInt64\">\n<%s>\n",
            kind, *(char *)&one == 1 ? "LittleEndian" : "BigEndian", kind);
    fprintf(out,
            "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
            "format=\"ascii\">%.17g</DataArray>\n</FieldData>\n",
            time);
    fprintf(out, "<Piece NumberOfPoints=\"%" PRIu64 "\" NumberOf%s=\"%" PRIu64 "\">\n",
            (uint64_t)g->cells * (uint64_t)g->nodes, polygons ? "Polys" : "Cells", (uint64_t)g->cells);
    put_section(g, "Points", 0, POINTS, &offset, out);
    put_section(g, polygons ? "Polys" : "Cells", POINTS, shape, &offset, out);
    offset += polygons ? sizeof(uint64_t) : 0; /* of the types, which polygons have not */
    put_section(g, "PointData", CELLS, points, &offset, out);
    put_section(g, "CellData", points, g->arrays, &offset, out);
    fprintf(out, "</Piece>\n</%s>\n<AppendedData encoding=\"raw\">\n_", kind);
    for (size_t i = 0; i < g->arrays; i++) {
        write_array(g, &g->of[i], out);
    }
    fputs("\n</AppendedData>\n</VTKFile>\n", out);
}

/* ---- STL ---- */

/* Binary: 80 bytes of any text, the number of triangles, of each its normal, corners and two bytes more. */
static void write_stl(const grid *g, FILE *out) {
    static const char head[80] = "crack surface by Rhegma, lengths in m";
    array points = g->of[0];
    points.in_memory = H5T_NATIVE_DOUBLE;
    points.size = sizeof(double);
    if (g->cells > UINT32_MAX) {
        refuse(g->from, "more triangles than an STL file can hold");
    }
    uint32_t count = (uint32_t)g->cells;
    fwrite(head, sizeof head, 1, out);
    fwrite(&count, sizeof count, 1, out);
    double corner[9], normal[3];
    for (hsize_t i = 0; i < g->cells; i++) {
        float value[12] = {0};
        read_rows(g->from, &points, 3 * i, 3, corner);
        rg_vector_normal(corner, normal);
        for (int c = 0; c < 3; c++) { /* a triangle without an area has none */
            value[c] = isfinite(normal[c]) ? (float)normal[c] : 0;
        }
        for (int k = 0; k < 9; k++) {
            value[3 + k] = (float)corner[k];
        }
        fwrite(value, sizeof value, 1, out);
        fwrite(&(uint16_t){0}, sizeof(uint16_t), 1, out);
    }
}

/* ---- the whole ---- */

rg_export_kind rg_export_kind_of(const char *path) {
    const char *end = strrchr(path, '.');
    return end == NULL                ? RG_EXPORT_NONE
           : strcmp(end, ".vtu") == 0 ? RG_EXPORT_VTU
           : strcmp(end, ".vtp") == 0 ? RG_EXPORT_VTP
           : strcmp(end, ".stl") == 0 ? RG_EXPORT_STL
                                      : RG_EXPORT_NONE;
}

static void write_file(grid *g, double time, const char *path) {
    const char *slash = strrchr(path, '/'), *name = slash != NULL ? slash + 1 : path;
    char *folder = RG_NEW(char, strlen(path) + 2);
    memcpy(folder, slash != NULL ? path : "./", slash != NULL ? (size_t)(slash + 1 - path) : 2);
    FILE *out = rg_replace_in(folder, name);
    if (rg_export_kind_of(path) == RG_EXPORT_STL) {
        write_stl(g, out);
    } else {
        write_xml(g, time, rg_export_kind_of(path) == RG_EXPORT_VTP, out);
    }
    rg_replaced_in(out, folder, name);
    rg_free(folder);
}

double rg_export(const char *dir, double time, bool crack, const char *path) {
    source s;
    open_source(&s, dir);
    s.place = open_frame(&s, nearest_frame(&s, time));
    double found = time_of(&s, s.place);
    crack = crack || rg_export_kind_of(path) != RG_EXPORT_VTU;
    if (crack && H5Lexists(s.place, "crack", H5P_DEFAULT) <= 0) {
        refuse(&s, "the run did not write its crack surface (crack in output.fields)");
    }
    grid g = {.from = &s, .nodes = crack ? 3 : 10, .shape = crack ? 5 : 24, .is_surface = crack};
    hid_t shape = H5Gopen2(crack ? s.place : s.file, crack ? "crack" : "mesh", H5P_DEFAULT);
    if (shape < 0) {
        refuse(&s, "its mesh cannot be read");
    }
    describe(&g, shape);
    write_file(&g, found, path);
    for (size_t i = 0; i < g.arrays; i++) {
        g.of[i].from >= 0 ? (void)H5Dclose(g.of[i].from) : (void)0;
    }
    rg_free(g.of);
    H5Gclose(shape);
    H5Gclose(s.place);
    close_source(&s);
    return found;
}
