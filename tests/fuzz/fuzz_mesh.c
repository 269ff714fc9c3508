/* Mesh files: a good one, to which the input is a list of changes. HDF5's and the file's own checksums would
 * refuse nearly all random bytes; so values are changed with their checksums made right, attributes and the
 * shapes of datasets through HDF5; and, for the checksums, bytes as they are.
 *
 * Input: which mesh, which reader, then changes of five bytes: kind, what, where (2 bytes), value. */
#include <hdf5.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/mem.h"
#include "h5_changes.h"
#include "host.h"
#include "mesh/apart.h"
#include "mesh/file.h"
#include "mesh/info.h"
#include "mesh/rows.h"

enum { MESHES = 3, FIELDS = 15, ATTRIBUTES = 10, CHANGE = 5, MOST_CHANGES = 16, IMAGE = 1 << 20 };

typedef struct {
    const rg_rows *rows;
    size_t at, sum;                       /* where its values and checksums begin in the file */
    size_t width;                         /* of a stored value */
    int64_t values, blocks, *block_start; /* block_start[blocks + 1]: rows */
} field;

typedef struct {
    uint8_t *image;
    size_t size;
    int fields;
    field field[FIELDS];
} base;

static base bases[MESHES];
static const char *const attribute[ATTRIBUTES] = {"version",       "vertices", "elements",     "interfaces",
                                                  "tile_elements", "tiles",    "surface_sets", "volume_sets",
                                                  "parts",         "crack"};
static const rg_rows partition = {"partition_2", RG_ROWS_INT32, 1};

/* ---- the good files ---- */

/* The box cut in two at x = 1/2: each half has vertices of its own there, so that they only touch. Of an
 * element of the lower half those corners are the last ones, so that the new numbers, the highest, keep them
 * in order. */
static void cut_in_two(rg_mesh *mesh) {
    rg_gid *other = RG_NEW(rg_gid, (size_t)mesh->vertices), vertices = mesh->vertices;
    mesh->x = rg_realloc(mesh->x, 2 * (size_t)vertices, 3 * sizeof(double));
    for (rg_gid v = 0; v < vertices; v++) {
        const double *x = mesh->x + 3 * v;
        other[v] = v;
        if (x[0] > 0.5 - 1e-6 && x[0] < 0.5 + 1e-6) {
            other[v] = mesh->vertices++;
            memcpy(mesh->x + 3 * other[v], x, 3 * sizeof *x);
        }
    }
    for (rg_gid e = 0; e < mesh->elements; e++) {
        rg_gid *corner = mesh->corner + 4 * e;
        double middle = 0;
        for (int c = 0; c < 4; c++) {
            middle += mesh->x[3 * corner[c]] / 4;
        }
        for (int c = 0; c < 4 && middle < 0.5; c++) {
            corner[c] = other[corner[c]];
        }
    }
    rg_free(other);
    rg_mesh_connect(mesh);
    rg_fuzz_require(rg_mesh_keep_apart(mesh) == 2, "two parts");
}

/* `apart`: in two parts that are kept apart. */
static void write_good(const char *path, const int64_t cells[3], bool apart) {
    static const double origin[3] = {0, 0, 0}, size[3] = {1, 2, 3};
    rg_mesh *mesh = rg_mesh_box(cells, origin, size, 0, 1);
    int64_t tile = rg_mesh_tile(mesh), tiles = (mesh->elements + tile - 1) / tile;
    int32_t *owner = RG_NEW(int32_t, (size_t)tiles);
    for (int64_t t = 0; t < tiles; t++) {
        owner[t] = t >= tiles / 2;
    }
    mesh->region = RG_NEW(int32_t, (size_t)mesh->elements);
    rg_sets_add(&mesh->volume, "all");
    if (apart) {
        cut_in_two(mesh);
    }
    rg_mesh_file_write(path, mesh, 1, &(rg_tile_partition){2, owner});
    rg_mesh_free(mesh);
    rg_free(owner);
}

static void write_image(const uint8_t *image, size_t size) {
    FILE *f = fopen(rg_fuzz_scratch(), "wb");
    rg_fuzz_require(f != NULL && fwrite(image, 1, size, f) == size && fclose(f) == 0, "the scratch file");
}

static size_t read_image(uint8_t *image, size_t most) {
    FILE *f = fopen(rg_fuzz_scratch(), "rb");
    rg_fuzz_require(f != NULL, "the scratch file can be read");
    size_t size = fread(image, 1, most, f);
    fclose(f);
    return size;
}

static void load(base *b) {
    b->image = malloc(IMAGE);
    b->size = read_image(b->image, IMAGE);
}

static size_t offset_of(hid_t file, const char *name, size_t *width, int64_t *values) {
    hid_t dataset = H5Dopen2(file, name, H5P_DEFAULT), space = H5Dget_space(dataset),
          type = H5Dget_type(dataset);
    size_t at = (size_t)H5Dget_offset(dataset);
    *width = H5Tget_size(type);
    *values = H5Sget_simple_extent_npoints(space);
    H5Tclose(type);
    H5Sclose(space);
    H5Dclose(dataset);
    return at;
}

static int64_t *make_starts(const rg_mesh_header *h, const rg_rows *r, const int64_t *vertex_start,
                            int64_t rows, int64_t *blocks) {
    bool by_vertex = r == &rg_rows_vertex || r == &rg_rows_x;
    bool by_element = r == &rg_rows_corner || r == &rg_rows_neighbour || r == &rg_rows_face ||
                      r == &rg_rows_set || r == &rg_rows_region || r == &rg_rows_original ||
                      r == &rg_rows_part;
    *blocks = by_vertex || by_element ? h->tiles : 1;
    int64_t *start = calloc((size_t)*blocks + 1, sizeof *start);
    for (int64_t t = 0; t <= *blocks; t++) {
        int64_t row = t * h->tile_elements;
        start[t] = by_vertex ? vertex_start[t] : row < h->elements ? row : h->elements;
    }
    start[*blocks] = rows;
    return start;
}

static void find_fields(base *b, const char *path) {
    static const rg_rows *const all[FIELDS] = {
        &rg_rows_surface_sets,   &rg_rows_volume_sets, &rg_rows_corner, &rg_rows_neighbour,
        &rg_rows_face,           &rg_rows_set,         &rg_rows_region, &rg_rows_original,
        &rg_rows_vertex_start,   &rg_rows_vertex,      &rg_rows_x,      &rg_rows_tile_start,
        &rg_rows_tile_neighbour, &partition,           &rg_rows_part};
    rg_mesh_file *f = rg_mesh_file_open(path);
    const rg_mesh_header *h = rg_mesh_file_header(f);
    hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    int64_t *vertex_start = calloc((size_t)h->tiles + 1, sizeof *vertex_start);
    hid_t starts = H5Dopen2(file, "vertex_start", H5P_DEFAULT);
    H5Dread(starts, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, vertex_start);
    H5Dclose(starts);
    for (b->fields = 0; b->fields < FIELDS - (h->parts == 0); b->fields++) {
        field *p = &b->field[b->fields];
        char sums[80];
        size_t width;
        int64_t count;
        p->rows = all[b->fields];
        snprintf(sums, sizeof sums, "checksum/%s", p->rows->name);
        p->at = offset_of(file, p->rows->name, &p->width, &p->values);
        p->sum = offset_of(file, sums, &width, &count);
        p->block_start = make_starts(h, p->rows, vertex_start, p->values / p->rows->columns, &p->blocks);
    }
    free(vertex_start);
    H5Fclose(file);
    rg_mesh_file_close(f);
}

/* ---- changes ---- */

static void set_value(uint8_t *image, const field *p, int64_t i, uint8_t code) {
    uint8_t *to = image + p->at + (size_t)i * p->width;
    if (p->rows->type == RG_ROWS_NAME) {
        memset(to, code, code % 2 == 0 ? RG_SHORT_NAME : 1);
    } else if (p->rows->type == RG_ROWS_DOUBLE) {
        double value = rg_fuzz_real(code);
        memcpy(to, &value, sizeof value);
    } else {
        int64_t value = rg_fuzz_integer(code); /* little-endian */
        memcpy(to, &value, p->width);
    }
}

static void repair_sums(uint8_t *image, const field *p) {
    size_t bytes = rg_rows_bytes(p->rows), per_value = bytes / (size_t)p->rows->columns;
    uint8_t *values = calloc((size_t)p->values, per_value);
    for (int64_t i = 0; i < p->values; i++) {
        const uint8_t *from = image + p->at + (size_t)i * p->width;
        int64_t wide = 0; /* little-endian, its sign to be extended */
        memcpy(&wide, from, p->width < sizeof wide ? p->width : sizeof wide);
        int unused = 64 - 8 * (int)(p->width < sizeof wide ? p->width : sizeof wide);
        wide = (int64_t)((uint64_t)wide << unused) >> unused;
        memcpy(values + (size_t)i * per_value,
               p->width < per_value ? (const void *)&wide : (const void *)from, per_value);
    }
    for (int64_t b = 0; b < p->blocks; b++) {
        uint64_t sum = rg_rows_checksum(p->rows, values + (size_t)p->block_start[b] * bytes,
                                        p->block_start[b + 1] - p->block_start[b]);
        memcpy(image + p->sum + (size_t)b * sizeof sum, &sum, sizeof sum);
    }
    free(values);
}

static void change_value(const base *b, uint8_t *image, const uint8_t *c) {
    size_t where = (size_t)c[2] + 256 * (size_t)c[3];
    const field *p = &b->field[c[1] % b->fields];
    if (c[0] == 2 || c[0] == 3) {
        set_value(image, p, (int64_t)where % p->values, c[4]);
        repair_sums(image, p);
    }
}

/* Flips or cuts: the last changes, because HDF5 itself does not survive writing to a damaged file. */
static void damage(uint8_t *image, size_t *size, const uint8_t *c) {
    size_t where = (size_t)c[2] + 256 * (size_t)c[3];
    if (c[0] == 0) {
        image[where % *size] = c[4];
    } else if (c[0] == 1) {
        *size = where % *size + 1;
    }
}

static void change_file(const base *b, hid_t file, const uint8_t *c) {
    int64_t where = c[2] + 256 * c[3];
    if (c[0] == 4 || c[0] == 5) {
        rg_fuzz_change_attribute(file, attribute[c[1] % ATTRIBUTES], rg_fuzz_integer(c[4]), c[0] == 5);
    } else if (c[0] == 6) {
        rg_fuzz_change_shape(file, b->field[c[1] % b->fields].rows->name,
                             where == 65535 ? rg_fuzz_integer(c[1]) : where, c[4]);
    }
}

/* ---- reading ---- */

static void read_whole(const char *path) {
    rg_mesh *mesh = rg_mesh_file_read(path);
    FILE *nowhere = fopen("/dev/null", "w");
    rg_mesh_info(mesh, 1, nowhere);
    rg_mesh_free(mesh);
    rg_mesh_file *f = rg_mesh_file_open(path);
    rg_mesh_info_partitions(f, nowhere);
    rg_mesh_file_close(f);
    fclose(nowhere);
}

static void read_pieces(const char *path) {
    rg_mesh_file *f = rg_mesh_file_open(path);
    rg_input_errors input_errors = {.name = path};
    int64_t tiles = rg_mesh_file_header(f)->tiles;
    for (int64_t t = 0; t < tiles; t += 7) {
        rg_mesh_slab_free(rg_mesh_file_slab(f, t, t + 1, &input_errors));
    }
    rg_input_errors_end(&input_errors);
    rg_mesh_file_close(f);
}

static void body(const uint8_t *data, size_t size) {
    const char *path = rg_fuzz_scratch();
    if (size > 1 && data[1] % 3 == 0) {
        read_whole(path);
    } else if (size > 1 && data[1] % 3 == 1) {
        read_pieces(path);
    } else {
        rg_part_free(rg_part_read(path, NULL, MPI_COMM_SELF));
    }
}

static void make_file(const base *b, const uint8_t *data, size_t size) {
    const uint8_t *change = data + 2, *end = change;
    bool later = false;
    static uint8_t image[IMAGE];
    memcpy(image, b->image, b->size);
    for (size_t n = 0; end + CHANGE <= data + size && n < MOST_CHANGES; end += CHANGE, n++) {
        change_value(b, image, end);
        later = later || end[0] >= 4;
    }
    write_image(image, b->size);
    hid_t file = later ? H5Fopen(rg_fuzz_scratch(), H5F_ACC_RDWR, H5P_DEFAULT) : -1;
    for (const uint8_t *c = change; file >= 0 && c < end; c += CHANGE) {
        change_file(b, file, c);
    }
    if (file >= 0) {
        H5Fclose(file);
    }
    size_t length = read_image(image, IMAGE);
    for (const uint8_t *c = change; c < end; c += CHANGE) {
        damage(image, &length, c);
    }
    write_image(image, length);
}

static void make_bases(const uint8_t *data, size_t size) {
    static const int64_t cells[MESHES][3] = {{2, 1, 1}, {3, 3, 3}, {2, 1, 1}};
    (void)data;
    (void)size;
    for (int m = 0; m < MESHES; m++) {
        write_good(rg_fuzz_scratch(), cells[m], m == 2);
        load(&bases[m]);
        find_fields(&bases[m], rg_fuzz_scratch());
    }
}

int LLVMFuzzerInitialize(int *argc, char ***argv) {
    MPI_Init(argc, argv);
    rg_fuzz_require(rg_fuzz_run(make_bases, NULL, 0), "the good files");
    return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size < 2) {
        return 0;
    }
    rg_fuzz_h5_begin();
    int which = data[0] % 8 < MESHES ? data[0] % 8 : 0; /* the larger one now and then: it is slow */
    make_file(&bases[which], data, size);
    bool accepted = rg_fuzz_run(body, data, size);
    rg_fuzz_require(accepted || size >= 2 + CHANGE, "the good file is read");
    rg_fuzz_h5_close();
    return 0;
}
