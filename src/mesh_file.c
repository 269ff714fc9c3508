#include "mesh_file.h"

#include <errno.h>
#include <hdf5.h>
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "../kernels/layout.h"
#include "h5_reason.h"
#include "mem.h"
#include "mesh_check.h"
#include "mesh_rows.h"

struct rg_mesh_file {
    char *path;
    hid_t file;
    char reason[RG_H5_REASON];
    rg_mesh_header head;
};

static const rg_gid most = INT64_C(1) << 40; /* elements or vertices: what a sane header says */

/* "path: dataset: what is wrong" */
static _Noreturn void refuse(const rg_mesh_file *f, const char *dataset, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static void refuse(const rg_mesh_file *f, const char *dataset, const char *format, ...) {
    char what[300];
    va_list args;
    va_start(args, format);
    vsnprintf(what, sizeof what, format, args);
    va_end(args);
    rg_fatal(RG_USAGE, "%s: %s: %s", f->path, dataset, what);
}

static _Noreturn void refuse_h5(const rg_mesh_file *f, const char *dataset) {
    refuse(f, dataset, "cannot be read: %s; the file is damaged or not a mesh file",
           f->reason[0] != '\0' ? f->reason : "not what it should be");
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

static void verify(const rg_mesh_file *f, const rg_rows *r, const stretch *s, const void *data) {
    char name[80];
    snprintf(name, sizeof name, "checksum/%s", r->name);
    uint64_t *sum = RG_NEW(uint64_t, (size_t)(s->end - s->begin) + 1);
    if (!read_dataset(f->file, name, H5T_NATIVE_UINT64, 1, s->blocks, s->begin, s->end, sum)) {
        refuse_h5(f, name);
    }
    for (int64_t b = 0; b < s->end - s->begin; b++) {
        const char *block = (const char *)data + (size_t)(s->start[b] - s->start[0]) * rg_rows_bytes(r);
        if (rg_rows_checksum(r, block, s->start[b + 1] - s->start[b]) != sum[b]) {
            refuse(f, r->name, "the checksum of %s %" PRId64 " is wrong; the file is damaged",
                   s->blocks == 1 ? "part" : "tile", s->begin + b);
        }
    }
    rg_free(sum);
}

/* The caller owns the result. */
static void *take(rg_mesh_file *f, const rg_rows *r, const stretch *s) {
    int64_t begin = s->start[0], end = s->start[s->end - s->begin];
    hid_t type = rg_rows_type(r);
    void *data = rg_alloc((size_t)(end - begin) + 1, rg_rows_bytes(r));
    if (!read_dataset(f->file, r->name, type, r->columns, s->rows, begin, end, data)) {
        refuse_h5(f, r->name);
    }
    if (r->type == RG_ROWS_NAME) {
        H5Tclose(type);
    }
    verify(f, r, s, data);
    return data;
}

static void *take_whole(rg_mesh_file *f, const rg_rows *r, int64_t rows) {
    return rows == 0 ? rg_alloc(1, 1) : take(f, r, &(stretch){rows, 1, 0, 1, (const int64_t[]){0, rows}});
}

/* How many rows dataset `r` has. */
static int64_t count_rows(const rg_mesh_file *f, const rg_rows *r) {
    hsize_t size[2] = {0, 0};
    hid_t dataset = H5Dopen2(f->file, r->name, H5P_DEFAULT);
    hid_t space = dataset < 0 ? -1 : H5Dget_space(dataset);
    bool ok = space >= 0 && H5Sget_simple_extent_ndims(space) == (r->columns > 1 ? 2 : 1) &&
              H5Sget_simple_extent_dims(space, size, NULL) > 0 && size[0] <= 8 * (hsize_t)most;
    if (!ok) {
        refuse_h5(f, r->name);
    }
    H5Sclose(space);
    H5Dclose(dataset);
    return (int64_t)size[0];
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

static void read_names(rg_mesh_file *f, const rg_rows *r, int count, char *name[]) {
    char *rows = take_whole(f, r, count);
    for (int i = 0; i < count; i++) {
        const char *from = rows + (size_t)i * RG_SET_NAME;
        if (memchr(from, '\0', RG_SET_NAME) == NULL) {
            refuse(f, r->name, "name %d has no end", i);
        }
        name[i] = RG_NEW(char, RG_SET_NAME);
        strcpy(name[i], from);
    }
    rg_free(rows);
}

static void check_format(const rg_mesh_file *f) {
    char format[32] = "";
    hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, sizeof format);
    bool known = read_attribute(f, "format", type, 1, format) && strcmp(format, "rhegma mesh") == 0;
    H5Tclose(type);
    if (!known) {
        refuse_h5(f, "format");
    }
    int64_t version = read_count(f, "version", 0, INT64_MAX);
    if (version != RG_MESH_VERSION) {
        refuse(f, "version", "%" PRId64 ", but this program reads version %d", version, RG_MESH_VERSION);
    }
}

static void read_header(rg_mesh_file *f) {
    rg_mesh_header *h = &f->head;
    check_format(f);
    h->elements = read_count(f, "elements", 1, most);
    h->vertices = read_count(f, "vertices", 4, most);
    h->interfaces = read_count(f, "interfaces", 0, 2 * h->elements);
    h->tile_elements = read_count(f, "tile_elements", 1, RG_TILE);
    int64_t tiles = (h->elements + h->tile_elements - 1) / h->tile_elements;
    h->tiles = read_count(f, "tiles", tiles, tiles);
    h->sets = (int)read_count(f, "surface_sets", 0, RG_MAX_SETS);
    h->regions = (int)read_count(f, "volume_sets", 0, RG_MAX_SETS);
    if (!read_attribute(f, "box", H5T_NATIVE_DOUBLE, 6, h->box)) {
        refuse_h5(f, "box");
    }
    read_names(f, &rg_rows_surface_sets, h->sets, h->set_name);
    read_names(f, &rg_rows_volume_sets, h->regions, h->region_name);
}

rg_mesh_file *rg_mesh_file_open(const char *path) {
    rg_mesh_file *f = RG_NEW(rg_mesh_file, 1);
    f->path = RG_NEW(char, strlen(path) + 1);
    strcpy(f->path, path);
    FILE *probe = fopen(path, "rb"); /* for the reason, which HDF5 does not tell */
    if (probe == NULL) {
        rg_fatal(RG_USAGE, "%s: cannot be read: %s", path, strerror(errno));
    }
    fclose(probe);
    rg_h5_listen(f->reason);
    f->file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    if (f->file < 0) {
        rg_fatal(RG_USAGE,
                 "%s: not a mesh file of Rhegma, or a damaged one: %s; 'rhegma mesh %s -o NAME.h5' "
                 "makes one of a mesh that Gmsh reads",
                 path, f->reason, path);
    }
    read_header(f);
    return f;
}

const rg_mesh_header *rg_mesh_file_header(const rg_mesh_file *f) {
    return &f->head;
}

void rg_mesh_file_close(rg_mesh_file *f) {
    H5Fclose(f->file);
    rg_h5_deafen();
    for (int s = 0; s < RG_MAX_SETS; s++) {
        rg_free(f->head.set_name[s]);
        rg_free(f->head.region_name[s]);
    }
    rg_free(f->path);
    rg_free(f);
}

/* ---- a run of tiles ---- */

static void check_range(const rg_mesh_file *f, const rg_rows *r, const int64_t *value, int64_t count,
                        int64_t low, int64_t end) {
    for (int64_t i = 0; i < count; i++) {
        if (value[i] < low || value[i] >= end) {
            refuse(f, r->name, "value %" PRId64 " is not between %" PRId64 " and %" PRId64, value[i], low,
                   end - 1);
        }
    }
}

static void check_bytes(const rg_mesh_file *f, const rg_rows *r, const int8_t *value, int64_t count,
                        int end) {
    for (int64_t i = 0; i < count; i++) {
        if (value[i] < -1 || value[i] >= end) {
            refuse(f, r->name, "value %d is not between -1 and %d", value[i], end - 1);
        }
    }
}

static void read_elements(rg_mesh_file *f, const stretch *s, rg_mesh_slab *slab) {
    const rg_mesh_header *h = &f->head;
    rg_gid faces = 4 * slab->elements;
    slab->corner = take(f, &rg_rows_corner, s);
    slab->neighbour = take(f, &rg_rows_neighbour, s);
    slab->face = take(f, &rg_rows_face, s);
    slab->set = take(f, &rg_rows_set, s);
    slab->region = take(f, &rg_rows_region, s);
    slab->original = take(f, &rg_rows_original, s);
    check_range(f, &rg_rows_corner, slab->corner, faces, 0, h->vertices);
    check_range(f, &rg_rows_neighbour, slab->neighbour, faces, -1, h->elements);
    check_bytes(f, &rg_rows_face, slab->face, faces, 4);
    check_bytes(f, &rg_rows_set, slab->set, faces, h->sets);
    check_bytes(f, &rg_rows_region, slab->region, slab->elements, h->regions);
    for (rg_gid slot = 0; slot < faces; slot++) {
        if ((slab->neighbour[slot] < 0) != (slab->face[slot] < 0)) {
            refuse(f, "face", "element %" PRId64 " has a neighbour without a face or a face without one",
                   slab->first + slot / 4);
        }
    }
}

/* A vertex as one tile lists it. */
struct listed {
    rg_gid vertex;
    int64_t row;
};

static int by_vertex(const void *a, const void *b) {
    const struct listed *p = a, *q = b;
    if (p->vertex != q->vertex) {
        return p->vertex < q->vertex ? -1 : 1;
    }
    return (p->row > q->row) - (p->row < q->row);
}

/* Gives each of the `rows` vertices that the tiles list a place in the slab: the result, by row. */
static rg_lid *merge_vertices(const rg_mesh_file *f, rg_mesh_slab *slab, int64_t rows, const rg_gid *vertex,
                              const double *x) {
    struct listed *list = RG_NEW(struct listed, (size_t)rows);
    rg_lid *place = RG_NEW(rg_lid, (size_t)rows);
    for (int64_t i = 0; i < rows; i++) {
        list[i] = (struct listed){vertex[i], i};
    }
    qsort(list, (size_t)rows, sizeof *list, by_vertex);
    slab->vertex = RG_NEW(rg_gid, (size_t)rows);
    slab->x = RG_NEW(double, 3 * (size_t)rows);
    for (int64_t i = 0; i < rows; i++) {
        const double *here = x + 3 * list[i].row;
        double *known = slab->x + 3 * (slab->vertices - 1);
        if (i > 0 && list[i].vertex == list[i - 1].vertex) {
            if (memcmp(known, here, 3 * sizeof *x) != 0) {
                refuse(f, "x", "vertex %" PRId64 " is at two places", list[i].vertex);
            }
        } else {
            slab->vertex[slab->vertices++] = list[i].vertex;
            memcpy(known + 3, here, 3 * sizeof *x);
        }
        place[list[i].row] = (rg_lid)(slab->vertices - 1);
    }
    rg_free(list);
    return place;
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

/* Fills `at`: where each corner stands among the slab's vertices, by way of its tile's list. */
static void locate_corners(const rg_mesh_file *f, rg_mesh_slab *slab, const stretch *s, const rg_gid *vertex,
                           const rg_lid *place) {
    slab->at = RG_NEW(rg_lid, 4 * (size_t)slab->elements);
    for (rg_gid slot = 0; slot < 4 * slab->elements; slot++) {
        int64_t t = slot / 4 / f->head.tile_elements, from = s->start[t] - s->start[0];
        int64_t i = find(vertex + from, s->start[t + 1] - s->start[t], slab->corner[slot]);
        if (i < 0) {
            refuse(f, "vertex", "tile %" PRId64 " does not list vertex %" PRId64 " of element %" PRId64,
                   s->begin + t, slab->corner[slot], slab->first + slot / 4);
        }
        slab->at[slot] = place[from + i];
    }
}

/* Where the vertices of tiles begin .. end stand. */
static int64_t *read_vertex_start(const rg_mesh_file *f, int64_t begin, int64_t end, int64_t rows) {
    const rg_rows *r = &rg_rows_vertex_start;
    int64_t *start = RG_NEW(int64_t, (size_t)(end - begin) + 1);
    if (!read_dataset(f->file, r->name, H5T_NATIVE_INT64, 1, f->head.tiles + 1, begin, end + 1, start)) {
        refuse_h5(f, r->name);
    }
    for (int64_t t = 0; t < end - begin; t++) {
        if (start[t] < 0 || start[t + 1] < start[t] || start[t + 1] > rows) {
            refuse(f, r->name,
                   "the vertices of tile %" PRId64 " cannot stand in rows %" PRId64 " to %" PRId64, begin + t,
                   start[t], start[t + 1]);
        }
    }
    return start;
}

static void read_vertices(rg_mesh_file *f, rg_mesh_slab *slab, int64_t begin, int64_t end) {
    int64_t rows = count_rows(f, &rg_rows_vertex);
    int64_t *start = read_vertex_start(f, begin, end, rows), here = start[end - begin] - start[0];
    stretch s = {rows, f->head.tiles, begin, end, start};
    rg_gid *vertex = take(f, &rg_rows_vertex, &s);
    double *x = take(f, &rg_rows_x, &s);
    if (here > INT32_MAX) {
        refuse(f, "vertex", "%" PRId64 " vertices are too many at once; use more ranks", here);
    }
    check_range(f, &rg_rows_vertex, vertex, here, 0, f->head.vertices);
    rg_lid *place = merge_vertices(f, slab, here, vertex, x);
    locate_corners(f, slab, &s, vertex, place);
    rg_free(place);
    rg_free(vertex);
    rg_free(x);
    rg_free(start);
}

rg_mesh_slab *rg_mesh_file_slab(rg_mesh_file *f, int64_t begin, int64_t end) {
    const rg_mesh_header *h = &f->head;
    rg_mesh_slab *slab = RG_NEW(rg_mesh_slab, 1);
    int64_t *start = RG_NEW(int64_t, (size_t)(end - begin) + 1);
    for (int64_t t = begin; t <= end; t++) {
        rg_gid at = t * h->tile_elements;
        start[t - begin] = at < h->elements ? at : h->elements;
    }
    slab->first = start[0];
    slab->elements = start[end - begin] - start[0];
    read_elements(f, &(stretch){h->elements, h->tiles, begin, end, start}, slab);
    read_vertices(f, slab, begin, end);
    rg_free(start);
    return slab;
}

void rg_mesh_slab_free(rg_mesh_slab *slab) {
    if (slab == NULL) {
        return;
    }
    void *blocks[] = {slab->vertex, slab->x,   slab->corner, slab->at,      slab->neighbour,
                      slab->face,   slab->set, slab->region, slab->original};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
        rg_free(blocks[i]);
    }
    rg_free(slab);
}

/* ---- the graph of tiles ---- */

rg_tile_graph *rg_mesh_file_graph(rg_mesh_file *f) {
    rg_tile_graph *g = RG_NEW(rg_tile_graph, 1);
    int64_t tiles = f->head.tiles, rows = tiles > 1 ? count_rows(f, &rg_rows_tile_neighbour) : 0;
    g->elements = f->head.elements;
    g->tile = (int)f->head.tile_elements;
    g->tiles = tiles;
    g->start = take_whole(f, &rg_rows_tile_start, tiles + 1);
    for (int64_t t = 0; t < tiles; t++) {
        if (g->start[t] > g->start[t + 1]) {
            refuse(f, "tile_start", "descends at tile %" PRId64, t);
        }
    }
    if (g->start[0] != 0 || g->start[tiles] != rows) {
        refuse(f, "tile_start", "does not span the rows of tile_neighbour");
    }
    g->neighbour = take_whole(f, &rg_rows_tile_neighbour, rows);
    g->faces = take_whole(f, &rg_rows_tile_faces, rows);
    check_range(f, &rg_rows_tile_neighbour, g->neighbour, rows, 0, tiles);
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

/* The slab's arrays become the mesh's. */
static rg_mesh *adopt(rg_mesh_slab *slab, rg_mesh_header *h) {
    rg_mesh *mesh = RG_NEW(rg_mesh, 1);
    *mesh = (rg_mesh){.vertices = slab->vertices,
                      .elements = slab->elements,
                      .x = slab->x,
                      .corner = slab->corner,
                      .neighbour = slab->neighbour,
                      .face = slab->face,
                      .set = slab->set,
                      .sets = h->sets,
                      .original = slab->original,
                      .region = slab->region,
                      .regions = h->regions};
    memcpy(mesh->set_name, h->set_name, sizeof mesh->set_name);
    memcpy(mesh->region_name, h->region_name, sizeof mesh->region_name);
    memset(h->set_name, 0, sizeof h->set_name);
    memset(h->region_name, 0, sizeof h->region_name);
    rg_free(slab->vertex);
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
    rg_mesh_file *f = rg_mesh_file_open(path);
    rg_mesh_slab *slab = rg_mesh_file_slab(f, 0, f->head.tiles);
    if (slab->vertices != f->head.vertices) {
        refuse(f, "vertices", "%" PRId64 ", but the elements use %" PRId64, f->head.vertices, slab->vertices);
    }
    rg_mesh *mesh = adopt(slab, &f->head);
    check_box(f, mesh);
    rg_mesh_check(mesh, path);
    rg_mesh_file_close(f);
    return mesh;
}
