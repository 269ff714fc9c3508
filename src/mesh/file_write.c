#include <errno.h>
#include <hdf5.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "base/files.h"
#include "base/h5_reason.h"
#include "base/mem.h"
#include "layout.h"
#include "mesh/apart.h"
#include "mesh/file.h"
#include "mesh/rows.h"

typedef struct {
    const char *path;
    char *temporary;
    char reason[RG_H5_REASON];
    hid_t file, sums;
    int64_t version, tiles;
    int64_t *element_start; /* [tiles + 1]: rows of the datasets that have one for each element */
    int64_t *vertex_start;  /* [tiles + 1]: of those that have one for each vertex of a tile */
    int64_t *vertex;        /* [vertex_start[tiles]] */
} target;

static _Noreturn void fail(const target *w, const char *what, const char *reason) {
    unlink(w->temporary);
    rg_fatal(RG_FAILURE, "%s: cannot write %s: %s", w->path, what, reason);
}

static void require(const target *w, bool ok, const char *what) {
    if (!ok) {
        fail(w, what, w->reason);
    }
}

/* ---- one dataset ---- */

/* Integers are stored in 32 bits where that is enough, groups of sets in 8. */
static hid_t stored_type(const rg_rows *r, hid_t type, const void *data, int64_t count) {
    const int64_t *value = data;
    const int32_t *group = data;
    bool narrow = r->type == RG_ROWS_INT64,
         byte = r == &rg_rows_set || r == &rg_rows_region || r == &rg_rows_part;
    for (int64_t i = 0; i < count * r->columns && narrow; i++) {
        narrow = value[i] >= INT32_MIN && value[i] <= INT32_MAX;
    }
    for (int64_t i = 0; i < count * r->columns && byte; i++) {
        byte = group[i] <= INT8_MAX;
    }
    return narrow ? H5T_NATIVE_INT32 : byte ? H5T_NATIVE_INT8 : type;
}

static hid_t create_dataset(hid_t place, const char *name, hid_t stored, int columns, int64_t rows) {
    hid_t space = H5Screate_simple(columns > 1 ? 2 : 1, (hsize_t[]){(hsize_t)rows, (hsize_t)columns}, NULL);
    hid_t plan = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_obj_track_times(plan, false);
    hid_t dataset = H5Dcreate2(place, name, stored, space, H5P_DEFAULT, plan, H5P_DEFAULT);
    H5Pclose(plan);
    H5Sclose(space);
    return dataset;
}

/* Only a partition can be there already, and then it has the same size and type. */
static bool write_dataset(hid_t place, const char *name, hid_t stored, hid_t type, int columns, int64_t rows,
                          const void *data) {
    hid_t dataset = H5Lexists(place, name, H5P_DEFAULT) > 0
                        ? H5Dopen2(place, name, H5P_DEFAULT)
                        : create_dataset(place, name, stored, columns, rows);
    bool ok = dataset >= 0 && H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0;
    return dataset >= 0 && H5Dclose(dataset) >= 0 && ok;
}

/* Writes dataset `r` and its checksums, one for each of `blocks` blocks of rows that begin at start[block].
 */
static void put(const target *w, const rg_rows *r, const void *data, int64_t blocks, const int64_t *start) {
    hid_t type = rg_rows_type(r);
    int64_t rows = start[blocks];
    hid_t stored = stored_type(r, type, data, rows);
    require(w, write_dataset(w->file, r->name, stored, type, r->columns, rows, data), r->name);
    if (rg_rows_are_names(r)) {
        H5Tclose(type);
    }
    uint64_t *sum = RG_NEW(uint64_t, (size_t)blocks);
    for (int64_t b = 0; b < blocks; b++) {
        sum[b] = rg_rows_checksum(r, (const char *)data + (size_t)start[b] * rg_rows_bytes(r),
                                  start[b + 1] - start[b]);
    }
    require(w, write_dataset(w->sums, r->name, H5T_NATIVE_UINT64, H5T_NATIVE_UINT64, 1, blocks, sum),
            r->name);
    rg_free(sum);
}

static void put_whole(const target *w, const rg_rows *r, const void *data, int64_t rows) {
    if (rows > 0) {
        put(w, r, data, 1, (const int64_t[]){0, rows});
    }
}

/* ---- header ---- */

static void put_attribute(const target *w, const char *name, hid_t type, int values, const void *data) {
    hid_t space = values == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(2, (hsize_t[]){2, 3}, NULL);
    hid_t attribute = H5Acreate2(w->file, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    bool ok = attribute >= 0 && H5Awrite(attribute, type, data) >= 0;
    ok = H5Aclose(attribute) >= 0 && ok;
    H5Sclose(space);
    require(w, ok, name);
}

static void put_text(const target *w, const char *name, const char *text) {
    hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, strlen(text) + 1);
    put_attribute(w, name, type, 1, text);
    H5Tclose(type);
}

static void put_names(const target *w, const rg_rows *r, const rg_sets *sets) {
    bool are_long = false;
    for (int32_t i = 0; i < sets->count; i++) {
        are_long = are_long || strlen(sets->name[i]) >= RG_SHORT_NAME;
    }
    rg_rows as_stored = rg_rows_of_names(r, are_long);
    size_t width = rg_rows_bytes(&as_stored);
    char *rows = RG_NEW(char, (size_t)sets->count *width);
    for (int32_t i = 0; i < sets->count; i++) {
        if (strlen(sets->name[i]) >= RG_SET_NAME) {
            unlink(w->temporary);
            rg_fatal(RG_USAGE, "%s: the name of set '%s' is longer than %d bytes", w->path, sets->name[i],
                     RG_SET_NAME - 1);
        }
        strcpy(rows + (size_t)i * width, sets->name[i]);
    }
    put_whole(w, &as_stored, rows, sets->count);
    rg_free(rows);
}

static int64_t combined_rows(const rg_sets *sets) {
    return sets->combinations > 0 ? sets->start[sets->combinations] : 0;
}

static void put_combinations(const target *w, const rg_rows *r, const rg_sets *sets) {
    int64_t rows = combined_rows(sets);
    int32_t *row = RG_NEW(int32_t, 2 * (size_t)rows + 1);
    for (int32_t c = 0; c < sets->combinations; c++) {
        for (int32_t i = sets->start[c]; i < sets->start[c + 1]; i++) {
            row[2 * i] = c;
            row[2 * i + 1] = sets->member[i];
        }
    }
    put_whole(w, r, row, rows);
    rg_free(row);
}

static void put_header(const target *w, const rg_mesh *mesh) {
    rg_gid sides = 0;
    double box[2][3];
    for (rg_gid slot = 0; slot < 4 * mesh->elements; slot++) {
        sides += mesh->neighbour[slot] >= 0;
    }
    rg_mesh_box_around(mesh, box);
    put_text(w, "format", "rhegma mesh");
    put_text(w, "program", "rhegma");
    const struct {
        const char *name;
        int64_t value;
    } counts[] = {{"version", w->version},
                  {"vertices", mesh->vertices},
                  {"elements", mesh->elements},
                  {"interfaces", sides / 2},
                  {"tile_elements", rg_mesh_tile(mesh)},
                  {"tiles", w->tiles},
                  {"surface_sets", mesh->surface.count},
                  {"volume_sets", mesh->volume.count},
                  {"surface_combinations", combined_rows(&mesh->surface)},
                  {"volume_combinations", combined_rows(&mesh->volume)},
                  {"parts", rg_mesh_apart(mesh)},
                  {"crack", mesh->crack}};
    size_t known = sizeof counts / sizeof *counts - (w->version == 1 ? 4 : w->version < 4 ? 2 : 0);
    for (size_t i = 0; i < known; i++) {
        put_attribute(w, counts[i].name, H5T_NATIVE_INT64, 1, &counts[i].value);
    }
    put_attribute(w, "box", H5T_NATIVE_DOUBLE, 6, box);
    put_names(w, &rg_rows_surface_sets, &mesh->surface);
    put_names(w, &rg_rows_volume_sets, &mesh->volume);
    put_combinations(w, &rg_rows_surface_combinations, &mesh->surface);
    put_combinations(w, &rg_rows_volume_combinations, &mesh->volume);
}

/* ---- elements and vertices ---- */

static void put_elements(const target *w, const rg_mesh *mesh) {
    put(w, &rg_rows_corner, mesh->corner, w->tiles, w->element_start);
    put(w, &rg_rows_neighbour, mesh->neighbour, w->tiles, w->element_start);
    put(w, &rg_rows_face, mesh->face, w->tiles, w->element_start);
    put(w, &rg_rows_set, mesh->set, w->tiles, w->element_start);
    int32_t *region = RG_NEW(int32_t, (size_t)mesh->elements);
    rg_gid *original = RG_NEW(rg_gid, (size_t)mesh->elements);
    for (rg_gid e = 0; e < mesh->elements; e++) {
        region[e] = mesh->region != NULL ? mesh->region[e] : -1;
        original[e] = rg_mesh_original(mesh, e);
    }
    put(w, &rg_rows_region, region, w->tiles, w->element_start);
    put(w, &rg_rows_original, original, w->tiles, w->element_start);
    if (mesh->part != NULL) {
        put(w, &rg_rows_part, mesh->part, w->tiles, w->element_start);
    }
    rg_free(region);
    rg_free(original);
}

static int ascending(const void *a, const void *b) {
    int64_t p = *(const int64_t *)a, q = *(const int64_t *)b;
    return (p > q) - (p < q);
}

/* The different vertices of tile t, ascending, to `list`; returns how many. */
static int64_t tile_vertices(const target *w, const rg_mesh *mesh, int64_t t, int64_t *list) {
    int64_t n = 4 * (w->element_start[t + 1] - w->element_start[t]), kept = 0;
    memcpy(list, mesh->corner + 4 * w->element_start[t], (size_t)n * sizeof *list);
    qsort(list, (size_t)n, sizeof *list, ascending);
    for (int64_t i = 0; i < n; i++) {
        if (kept == 0 || list[i] != list[kept - 1]) {
            list[kept++] = list[i];
        }
    }
    return kept;
}

static void find_vertices(target *w, const rg_mesh *mesh) {
    int64_t list[4 * RG_MOST_TILE];
    size_t room = 0;
    w->vertex_start = RG_NEW(int64_t, (size_t)w->tiles + 1);
    for (int64_t t = 0; t < w->tiles; t++) {
        int64_t n = tile_vertices(w, mesh, t, list), at = w->vertex_start[t];
        w->vertex = rg_grow(w->vertex, &room, (size_t)(at + n), sizeof *w->vertex);
        memcpy(w->vertex + at, list, (size_t)n * sizeof *list);
        w->vertex_start[t + 1] = at + n;
    }
}

static void put_vertices(const target *w, const rg_mesh *mesh) {
    int64_t rows = w->vertex_start[w->tiles];
    double *x = RG_NEW(double, 3 * (size_t)rows);
    for (int64_t i = 0; i < rows; i++) {
        memcpy(x + 3 * i, mesh->x + 3 * w->vertex[i], 3 * sizeof *x);
    }
    put_whole(w, &rg_rows_vertex_start, w->vertex_start, w->tiles + 1);
    put(w, &rg_rows_vertex, w->vertex, w->tiles, w->vertex_start);
    put(w, &rg_rows_x, x, w->tiles, w->vertex_start);
    rg_free(x);
}

static void put_graph(const target *w, const rg_mesh *mesh) {
    rg_tile_graph *g = rg_tile_graph_make(mesh, rg_mesh_tile(mesh));
    put_whole(w, &rg_rows_tile_start, g->start, g->tiles + 1);
    put_whole(w, &rg_rows_tile_neighbour, g->neighbour, g->start[g->tiles]);
    put_whole(w, &rg_rows_tile_faces, g->faces, g->start[g->tiles]);
    rg_tile_graph_free(g);
}

static void put_partition(const target *w, const rg_tile_partition *p) {
    char name[32];
    snprintf(name, sizeof name, "partition_%d", p->parts);
    put_whole(w, &(rg_rows){name, RG_ROWS_INT32, 1}, p->owner, w->tiles);
}

/* ---- file ---- */

/* What has the name is replaced: that must not be a directory, or a device. */
static void check_target(const target *w) {
    struct stat found;
    if (stat(w->path, &found) == 0 && !S_ISREG(found.st_mode)) {
        rg_fatal(RG_FAILURE, "%s: cannot be written: not a file", w->path);
    }
}

static FILE *open_temporary(target *w) {
    check_target(w);
    w->temporary = RG_NEW(char, strlen(w->path) + 8);
    sprintf(w->temporary, "%s.part", w->path);
    FILE *f = fopen(w->temporary, "wb"); /* for the reason, which HDF5 does not tell */
    if (f == NULL) {
        rg_fatal(RG_FAILURE, "%s: cannot be written: %s", w->path, strerror(errno));
    }
    return f;
}

static void create(target *w) {
    fclose(open_temporary(w));
    rg_h5_listen(w->reason);
    hid_t access = H5Pcreate(H5P_FILE_ACCESS), plan = H5Pcreate(H5P_FILE_CREATE);
    H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18); /* the format that has checksums */
    H5Pset_obj_track_times(plan, false);                          /* the same mesh is the same file */
    w->file = H5Fcreate(w->temporary, H5F_ACC_TRUNC, plan, access);
    H5Pclose(plan);
    H5Pclose(access);
    require(w, w->file >= 0, "the file");
    plan = H5Pcreate(H5P_GROUP_CREATE);
    H5Pset_obj_track_times(plan, false);
    w->sums = H5Gcreate2(w->file, "checksum", H5P_DEFAULT, plan, H5P_DEFAULT);
    H5Pclose(plan);
    require(w, w->sums >= 0, "checksum");
}

static void copy(target *w) {
    enum { CHUNK = 1 << 20 };
    FILE *from = rg_open_input(w->path);
    if (from == NULL) {
        rg_fatal(RG_USAGE, "%s: cannot be read: %s", w->path, strerror(errno));
    }
    FILE *to = open_temporary(w);
    char *chunk = RG_NEW(char, CHUNK);
    size_t n;
    bool ok = true;
    while (ok && (n = fread(chunk, 1, CHUNK, from)) > 0) {
        ok = fwrite(chunk, 1, n, to) == n;
    }
    ok = ok && !ferror(from);
    if (fclose(to) != 0 || !ok) {
        fail(w, "a copy", strerror(errno));
    }
    fclose(from);
    rg_free(chunk);
}

/* A copy of the file under the temporary name, open to be changed. */
static void reopen(target *w) {
    copy(w);
    rg_h5_listen(w->reason);
    hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18);
    w->file = H5Fopen(w->temporary, H5F_ACC_RDWR, access);
    H5Pclose(access);
    require(w, w->file >= 0, "the file");
    w->sums = H5Gopen2(w->file, "checksum", H5P_DEFAULT);
    require(w, w->sums >= 0, "checksum");
}

static void finish(target *w) {
    bool ok = H5Gclose(w->sums) >= 0;
    ok = H5Fclose(w->file) >= 0 && ok;
    require(w, ok, "the file");
    if (rename(w->temporary, w->path) != 0) {
        fail(w, "the file", strerror(errno));
    }
    rg_h5_deafen();
    rg_free(w->temporary);
    rg_free(w->element_start);
    rg_free(w->vertex_start);
    rg_free(w->vertex);
}

void rg_mesh_file_add_partitions(const char *path, int partitions, const rg_tile_partition *partition) {
    rg_mesh_file *f = rg_mesh_file_open(path);
    target w = {.path = path, .tiles = rg_mesh_file_header(f)->tiles};
    rg_mesh_file_close(f);
    reopen(&w);
    for (int p = 0; p < partitions; p++) {
        put_partition(&w, &partition[p]);
    }
    finish(&w);
}

static int64_t version_of(const rg_mesh *mesh) {
    if (mesh->part != NULL || mesh->crack > 0) {
        return 4;
    }
    for (rg_gid slot = 0; slot < 4 * mesh->elements; slot++) {
        if (mesh->neighbour[slot] >= 0 && mesh->set[slot] >= 0) {
            return 3;
        }
    }
    return mesh->surface.combinations > 0 || mesh->volume.combinations > 0 ? 2 : 1;
}

void rg_mesh_file_write(const char *path, const rg_mesh *mesh, int partitions,
                        const rg_tile_partition *partition) {
    int tile = rg_mesh_tile(mesh);
    target w = {.path = path, .version = version_of(mesh), .tiles = (mesh->elements + tile - 1) / tile};
    w.element_start = RG_NEW(int64_t, (size_t)w.tiles + 1);
    for (int64_t t = 0; t <= w.tiles; t++) {
        rg_gid end = t * tile;
        w.element_start[t] = end < mesh->elements ? end : mesh->elements;
    }
    create(&w);
    put_header(&w, mesh);
    put_elements(&w, mesh);
    find_vertices(&w, mesh);
    put_vertices(&w, mesh);
    put_graph(&w, mesh);
    for (int p = 0; p < partitions; p++) {
        put_partition(&w, &partition[p]);
    }
    finish(&w);
}
