/* Mesh files whose checksums are right but whose numbers are not: each rule of the reader, at its bound. */
#include <hdf5.h>
#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/error.h"
#include "base/hash.h"
#include "base/mem.h"
#include "mesh/file.h"
#include "mesh/rows.h"
#include "support/mesh_text.h"

/* 270 elements in 68 tiles of 4, the last one of 2; original number of element e: 1000 + 7 e modulo 270. */
enum { ELEMENTS = 270, TILES = 68, TILE = 4 };

static char folder[] = "/tmp/test_mesh_damage.XXXXXX";
static const char good[] = "good.h5", bad[] = "bad.h5";
static rg_mesh *mesh;
static int64_t *vertex_start;

static rg_mesh *make(void) {
    const int64_t cells[3] = {5, 3, 3};
    const double origin[3] = {-1, 0.5, 2}, size[3] = {0.5, 0.4, 1.1};
    rg_mesh *m = rg_mesh_box(cells, origin, size, 0.1, 3);
    m->region = RG_NEW(int32_t, ELEMENTS);
    for (rg_gid e = 0; e < ELEMENTS; e++) {
        m->region[e] = (int32_t)(e % 3 - 1);
        m->original[e] = 1000 + 7 * e % ELEMENTS;
    }
    for (int r = 0; r < 2; r++) {
        char name[RG_SHORT_NAME] = "";
        memset(name, 'a' + r, r == 0 ? 1 : RG_SHORT_NAME - 1);
        rg_sets_add(&m->volume, name);
    }
    return m;
}

/* ---- changes ---- */

static const rg_rows partition_2 = {"partition_2", RG_ROWS_INT32, 1};

static const rg_rows *rows_of(const char *name) {
    const rg_rows *all[] = {&rg_rows_corner,       &rg_rows_neighbour,      &rg_rows_face,
                            &rg_rows_set,          &rg_rows_region,         &rg_rows_original,
                            &rg_rows_vertex_start, &rg_rows_vertex,         &rg_rows_x,
                            &rg_rows_tile_start,   &rg_rows_tile_neighbour, &rg_rows_tile_faces,
                            &rg_rows_surface_sets, &rg_rows_volume_sets,    &rg_rows_surface_combinations,
                            &partition_2};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        if (strcmp(all[i]->name, name) == 0) {
            return all[i];
        }
    }
    return NULL;
}

/* Rows of the blocks that have checksums. */
static int64_t block_start(const char *name, int64_t blocks, int64_t rows, int64_t b) {
    if (blocks == 1) {
        return b * rows;
    }
    bool of_vertices = strcmp(name, "vertex") == 0 || strcmp(name, "x") == 0;
    return of_vertices ? vertex_start[b] : b * TILE < ELEMENTS ? b * TILE : ELEMENTS;
}

/* A dataset in memory, from rg_alloc. */
static void *load(hid_t file, const char *name, hid_t type, size_t width, int64_t *values) {
    hid_t dataset = H5Dopen2(file, name, H5P_DEFAULT), space = H5Dget_space(dataset);
    *values = H5Sget_simple_extent_npoints(space);
    void *data = rg_alloc((size_t)*values, width);
    assert_true(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0);
    H5Sclose(space);
    H5Dclose(dataset);
    return data;
}

static void store(hid_t file, const char *name, hid_t type, const void *data) {
    hid_t dataset = H5Dopen2(file, name, H5P_DEFAULT);
    assert_true(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0);
    H5Dclose(dataset);
}

/* Value `at` of dataset `name` becomes *value, and the checksum that of the new rows, or stays. */
static void change_value(hid_t file, const char *name, int64_t at, const void *value, bool mend) {
    const rg_rows *r = rows_of(name);
    char sums[80];
    int64_t values, blocks;
    hid_t type = rg_rows_type(r);
    size_t width = rg_rows_bytes(r) / (size_t)r->columns;
    snprintf(sums, sizeof sums, "checksum/%s", name);
    char *data = load(file, name, type, width, &values);
    uint64_t *sum = load(file, sums, H5T_NATIVE_UINT64, sizeof *sum, &blocks);
    memcpy(data + (size_t)at * width, value, width);
    int64_t rows = values / r->columns;
    for (int64_t b = 0; b < blocks && mend; b++) {
        int64_t from = block_start(name, blocks, rows, b), to = block_start(name, blocks, rows, b + 1);
        sum[b] = rg_rows_checksum(r, data + (size_t)from * rg_rows_bytes(r), to - from);
    }
    store(file, name, type, data);
    store(file, sums, H5T_NATIVE_UINT64, sum);
    rg_free(data);
    rg_free(sum);
}

static void change_integer(hid_t file, const char *name, int64_t at, int64_t value) {
    const rg_rows *r = rows_of(name);
    int8_t small = (int8_t)value;
    int32_t narrow = (int32_t)value;
    change_value(file, name, at,
                 r->type == RG_ROWS_INT8    ? (const void *)&small
                 : r->type == RG_ROWS_INT32 ? (const void *)&narrow
                                            : (const void *)&value,
                 true);
}

static hid_t open_copy(void) {
    char chunk[4096];
    FILE *from = fopen(good, "rb"), *to = fopen(bad, "wb");
    for (size_t n; (n = fread(chunk, 1, sizeof chunk, from)) > 0;) {
        assert_int_equal(fwrite(chunk, 1, n, to), n);
    }
    fclose(from);
    fclose(to);
    return H5Fopen(bad, H5F_ACC_RDWR, H5P_DEFAULT);
}

/* ---- readers ---- */

static void read_whole(void) {
    rg_mesh_free(rg_mesh_file_read(bad));
}

static void read_graph(void) {
    rg_mesh_file *f = rg_mesh_file_open(bad);
    rg_tile_graph_free(rg_mesh_file_graph(f));
    rg_mesh_file_close(f);
}

static void read_partition(void) {
    int32_t owner[TILES];
    rg_mesh_file *f = rg_mesh_file_open(bad);
    assert_true(rg_mesh_file_partition(f, 2, owner));
    rg_mesh_file_close(f);
}

static void expect_fault(void (*job)(void), const char *words) {
    char said[1000] = "";
    for (const char *line = words; *line != '\0'; line = strchr(line, '\n') + 1) {
        snprintf(said + strlen(said), sizeof said - strlen(said), "rhegma: bad.h5: %.*s\n",
                 (int)strcspn(line, "\n"), line);
    }
    expect_said(job, said[0] != '\0' ? RG_USAGE : RG_OK, said);
}

/* ---- header ---- */

static void set_attribute(hid_t file, const char *name, int64_t value) {
    hid_t a = H5Aopen(file, name, H5P_DEFAULT);
    H5Awrite(a, H5T_NATIVE_INT64, &value);
    H5Aclose(a);
}

#define DAMAGED "cannot be read: not what it should be; the file is damaged or not a mesh file\n"

static void test_header(void **state) {
    (void)state;
    static const struct {
        const char *name;
        int64_t value;
        const char *said;
    } cases[] = {
        {"version", 1, ""},
        {"version", 0, "version: 0, but this program reads versions 1 to 4\n"},
        {"version", 2,
         "surface_combinations: cannot be read: can't locate attribute in name index; the file is "
         "damaged or not a mesh file\n"},
        {"version", 5, "version: 5, but this program reads versions 1 to 4\n"},
        {"version", -1, "version: -1 is not between 0 and 9223372036854775807\n"},
        {"elements", 0, "elements: 0 is not between 1 and 1099511627776\n"},
        {"elements", 1099511627777, "elements: 1099511627777 is not between 1 and 1099511627776\n"},
        {"elements", 271, "corner: has 270 rows, not 271\n"},
        {"elements", 272, "corner: has 270 rows, not 272\n"},
        {"elements", 273, "tiles: 68 is not between 69 and 69\n"},
        {"elements", 268, "tiles: 68 is not between 67 and 67\n"},
        {"vertices", 3, "vertices: 3 is not between 4 and 1099511627776\n"},
        {"vertices", 1099511627777, "vertices: 1099511627777 is not between 4 and 1099511627776\n"},
        {"vertices", 97, "vertices: 97, but the elements use 96\n"},
        {"interfaces", -1, "interfaces: -1 is not between 0 and 540\n"},
        {"interfaces", 541, "interfaces: 541 is not between 0 and 540\n"},
        {"interfaces", 540, ""}, /* the reader of the whole does not count them */
        {"interfaces", 0, ""},
        {"tile_elements", 0, "tile_elements: 0 is not between 1 and 1024\n"},
        {"tile_elements", 1025, "tile_elements: 1025 is not between 1 and 1024\n"},
        {"tile_elements", 256, "tiles: 68 is not between 2 and 2\n"},
        {"tile_elements", 1, "tiles: 68 is not between 270 and 270\n"},
        {"surface_sets", -1, "surface_sets: -1 is not between 0 and 16777216\n"},
        {"surface_sets", 16777217, "surface_sets: 16777217 is not between 0 and 16777216\n"},
        {"surface_sets", 16777216, "surface_sets: has 6 rows, not 16777216\n"},
        {"volume_sets", -1, "volume_sets: -1 is not between 0 and 16777216\n"},
        {"volume_sets", 16777217, "volume_sets: 16777217 is not between 0 and 16777216\n"},
        {"volume_sets", 1, "volume_sets: has 2 rows, not 1\n"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        hid_t file = open_copy();
        set_attribute(file, cases[i].name, cases[i].value);
        H5Fclose(file);
        expect_fault(read_whole, cases[i].said);
    }
    hid_t file = open_copy();
    hid_t dataset = H5Dopen2(file, "vertex", H5P_DEFAULT), space = H5Dget_space(dataset);
    int64_t listed = H5Sget_simple_extent_npoints(space);
    H5Sclose(space);
    H5Dclose(dataset);
    set_attribute(file, "vertices", listed + 1);
    H5Fclose(file);
    char words[100];
    snprintf(words, sizeof words, "vertices: %" PRId64 ", but the tiles list %" PRId64 "\n", listed + 1,
             listed);
    expect_fault(read_whole, words);
}

/* An attribute, with its name, that is another one or none. */
static void test_attributes(void **state) {
    (void)state;
    static const char *const names[] = {"format", "version", "elements", "box"};
    for (int k = 0; k < 8; k++) {
        char words[200], said[1000];
        hid_t file = open_copy();
        H5Adelete(file, names[k / 2]);
        if (k % 2 == 1) { /* two values, and a text that says something else */
            hid_t space = k == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, (hsize_t[]){2}, NULL);
            hid_t type = H5Tcopy(k == 1 ? H5T_C_S1 : H5T_NATIVE_DOUBLE);
            k == 1 ? H5Tset_size(type, 32) : 0;
            hid_t a = H5Acreate2(file, names[k / 2], type, space, H5P_DEFAULT, H5P_DEFAULT);
            char other[32] = "rhegma mess";
            H5Awrite(a, type, k == 1 ? (void *)other : (double[]){1, 1});
            H5Aclose(a);
            H5Tclose(type);
            H5Sclose(space);
        }
        H5Fclose(file);
        snprintf(words, sizeof words, "rhegma: bad.h5: %s: cannot be read: ", names[k / 2]);
        assert_int_equal(run_child(read_whole, said, sizeof said), RG_USAGE);
        if (strncmp(said, words, strlen(words)) != 0 || (k % 2 == 1 && strstr(said, DAMAGED) == NULL)) {
            fail_msg("%s: %s", words, said);
        }
    }
}

/* ---- values ---- */

typedef struct {
    const char *name;
    int64_t at, value;
    const char *said;
} case_of_value;

static void try_values(void (*job)(void), const case_of_value *cases, size_t count) {
    for (size_t i = 0; i < count; i++) {
        hid_t file = open_copy();
        change_integer(file, cases[i].name, cases[i].at, cases[i].value);
        H5Fclose(file);
        expect_fault(job, cases[i].said);
    }
}

/* Element 201, tile 50: number 1057 of the input; value 806 is at its corner 2. */
static void test_element_values(void **state) {
    (void)state;
    const case_of_value cases[] = {
        {"corner", 806, 96, "corner: value 96 of element 1057 is not between 0 and 95\n"},
        {"corner", 806, -1, "corner: value -1 of element 1057 is not between 0 and 95\n"},
        {"neighbour", 806, 270, "neighbour: value 270 of element 1057 is not between -1 and 269\n"},
        {"neighbour", 806, -2, "neighbour: value -2 of element 1057 is not between -1 and 269\n"},
        {"face", 806, 4, "face: value 4 of element 1057 is not between -1 and 3\n"},
        {"face", 806, -2, "face: value -2 of element 1057 is not between -1 and 3\n"},
        {"set", 806, 6, "set: value 6 of element 1057 is not between -1 and 5\n"},
        {"set", 806, -2, "set: value -2 of element 1057 is not between -1 and 5\n"},
        {"set", 806, 5, "set: elements 1257 and 1057 have the face between them in different sets\n"},
        {"set", 806, -1, ""},
        {"region", 201, 2, "region: value 2 of element 1057 is not between -1 and 1\n"},
        {"region", 201, -2, "region: value -2 of element 1057 is not between -1 and 1\n"},
        {"region", 201, 1, ""},
        {"region", 201, -1, ""},
        {"original", 201, 5, ""},
        /* the first value and the last one */
        {"corner", 0, 96, "corner: value 96 of element 1000 is not between 0 and 95\n"},
        {"corner", 1079, 96, "corner: value 96 of element 1263 is not between 0 and 95\n"},
        {"set", 0, 6, "set: value 6 of element 1000 is not between -1 and 5\n"},
        {"set", 1079, 6, "set: value 6 of element 1263 is not between -1 and 5\n"},
        {"region", 269, 2, "region: value 2 of element 1263 is not between -1 and 1\n"},
    };
    try_values(read_whole, cases, sizeof cases / sizeof *cases);
    /* of two in a tile, that of the earlier element comes first */
    static const case_of_value pairs[2][2] = {
        {{"corner", 806, 96, "corner: value 96 of element 1057 is not between 0 and 95\n"},
         {"region", 202, 2, "region: value 2 of element 1064 is not between -1 and 1\n"}},
        {{"set", 806, 6, "set: value 6 of element 1057 is not between -1 and 5\n"},
         {"region", 202, 2, "region: value 2 of element 1064 is not between -1 and 1\n"}}};
    for (int k = 0; k < 2; k++) {
        char words[200];
        hid_t file = open_copy();
        change_integer(file, pairs[k][0].name, pairs[k][0].at, pairs[k][0].value);
        change_integer(file, pairs[k][1].name, pairs[k][1].at, pairs[k][1].value);
        H5Fclose(file);
        snprintf(words, sizeof words, "%s%s", pairs[k][0].said, pairs[k][1].said);
        expect_fault(read_whole, words);
    }
    /* a face of the surface that has a neighbour's face, and one between elements that has none */
    for (int inside = 0; inside < 2; inside++) {
        char words[200];
        rg_gid slot = 700;
        while ((mesh->neighbour[slot] >= 0) != (inside == 1)) {
            slot++;
        }
        const case_of_value one = {"face", slot, inside ? -1 : 0, words};
        snprintf(words, sizeof words,
                 "face: element %" PRId64 " has a neighbour without a face or a face without one\n",
                 mesh->original[slot / 4]);
        try_values(read_whole, &one, 1);
    }
}

static void test_vertex_values(void **state) {
    (void)state;
    char words[4][200];
    int64_t row = vertex_start[50] + 1, vertex = 0;
    hid_t file = open_copy();
    int64_t rows, *list = load(file, "vertex", H5T_NATIVE_INT64, sizeof *list, &rows);
    H5Fclose(file);
    vertex = list[row];
    rg_gid user = 4 * 50 * TILE; /* the first corner that needs it */
    while (mesh->corner[user] != vertex) {
        user++;
    }
    snprintf(words[0], sizeof *words,
             "vertex: tile 50 does not list vertex %" PRId64 " of element %" PRId64 "\n", vertex,
             mesh->original[user / 4]);
    snprintf(words[1], sizeof *words,
             "vertex_start: the vertices of tile 50 cannot stand in rows %" PRId64 " to %" PRId64 "\n",
             vertex_start[50], vertex_start[50] + 17);
    snprintf(words[2], sizeof *words,
             "vertex_start: the vertices of tile 50 cannot stand in rows %" PRId64 " to %" PRId64 "\n",
             vertex_start[50], vertex_start[50] - 1);
    snprintf(words[3], sizeof *words,
             "vertex_start: the vertices of tile 67 cannot stand in rows %" PRId64 " to %" PRId64 "\n",
             vertex_start[67], rows + 1);
    const case_of_value cases[] = {
        {"vertex", row, 96, "vertex: value 96 of tile 50 is not between 0 and 95\n"},
        {"vertex", row, -1, "vertex: value -1 of tile 50 is not between 0 and 95\n"},
        {"vertex", row, list[row - 1], words[0]},
    };
    try_values(read_whole, cases, sizeof cases / sizeof *cases);
    /* The rows of a tile: 16 at most, in order, none beyond the end; of the tiles beside one that begins
     * elsewhere the checksums are wrong too, so the first line counts. */
    const case_of_value starts[] = {
        {"vertex_start", 51, vertex_start[50] + 17, words[1]},
        {"vertex_start", 51, vertex_start[50] - 1, words[2]},
        {"vertex_start", 68, rows + 1, words[3]},
        {"vertex_start", 0, -1, "vertex_start: the vertices of tile 0 cannot stand in rows -1 to "}};
    for (size_t i = 0; i < sizeof starts / sizeof *starts; i++) {
        char said[1000], first[300];
        file = open_copy();
        change_integer(file, starts[i].name, starts[i].at, starts[i].value);
        H5Fclose(file);
        snprintf(first, sizeof first, "rhegma: bad.h5: %s", starts[i].said);
        assert_int_equal(run_child(read_whole, said, sizeof said), RG_USAGE);
        if (strncmp(said, first, strlen(first)) != 0) {
            fail_msg("%s: %s", first, said);
        }
    }
    rg_free(list);
}

/* Position `at` (its first coordinate) of dataset x becomes another; of one copy of a vertex, or of all. */
static void test_positions(void **state) {
    (void)state;
    hid_t file = open_copy();
    int64_t rows, *list = load(file, "vertex", H5T_NATIVE_INT64, sizeof *list, &rows);
    int64_t last = rows - 1, copies = 0;
    double x = 7;
    char words[100];
    for (int64_t i = 0; i < rows; i++) {
        copies += list[i] == list[last];
    }
    assert_true(copies > 2);
    change_value(file, "x", 3 * last, &x, true);
    H5Fclose(file);
    snprintf(words, sizeof words, "x: vertex %" PRId64 " is at two places\n", list[last]);
    expect_fault(read_whole, words);
    /* The upper end of the box in x, y and z, one by one. */
    for (int i = 0; i < 3; i++) {
        double box[2][3];
        rg_mesh_box_around(mesh, box);
        file = open_copy();
        for (int64_t k = 0; k < rows; k++) {
            double at = mesh->x[3 * list[k] + i];
            double moved = at + (at >= box[1][i] ? 1e-3 : 0);
            at >= box[1][i] ? change_value(file, "x", 3 * k + i, &moved, true) : (void)0;
        }
        H5Fclose(file);
        expect_fault(read_whole, "box: is not that of the vertices\n");
    }
    rg_free(list);
}

/* ---- graph and partitions ---- */

static void test_graph_values(void **state) {
    (void)state;
    rg_mesh_file *f = rg_mesh_file_open(good);
    rg_tile_graph *g = rg_mesh_file_graph(f);
    rg_mesh_file_close(f);
    const case_of_value cases[] = {
        {"tile_start", 20, g->start[21] + 1, "tile_start: descends at tile 20\n"},
        {"tile_start", 20, g->start[21], ""},
        {"tile_start", 20, g->start[19] - 1, "tile_start: descends at tile 19\n"},
        {"tile_start", 0, 1, "tile_start: does not span the rows of tile_neighbour\n"},
        {"tile_start", 0, -1, "tile_start: does not span the rows of tile_neighbour\n"},
        {"tile_start", 68, g->start[68] - 1, "tile_start: does not span the rows of tile_neighbour\n"},
        {"tile_start", 68, g->start[68] + 1, "tile_start: does not span the rows of tile_neighbour\n"},
        {"tile_neighbour", 9, 68, "tile_neighbour: value 68 is not between 0 and 67\n"},
        {"tile_neighbour", 9, -1, "tile_neighbour: value -1 is not between 0 and 67\n"},
        {"tile_neighbour", 9, 67, ""},
        {"tile_neighbour", 9, 0, ""},
        {"tile_neighbour", g->start[68] - 1, 68, "tile_neighbour: value 68 is not between 0 and 67\n"},
    };
    try_values(read_graph, cases, sizeof cases / sizeof *cases);
    rg_tile_graph_free(g);
}

static void test_partition_values(void **state) {
    (void)state;
    const case_of_value cases[] = {
        {"partition_2", 67, 2, "partition_2: tile 67 belongs to rank 2 of 2\n"},
        {"partition_2", 0, -1, "partition_2: tile 0 belongs to rank -1 of 2\n"},
        {"partition_2", 66, 1, ""},
        {"partition_2", 67, 0, "partition_2: rank 1 has no tile\n"},
    };
    try_values(read_partition, cases, sizeof cases / sizeof *cases);
}

/* ---- sets that overlap ---- */

/* The mesh with two combinations of its surface sets, of three and of two. */
static void write_overlapping(const char *name) {
    rg_mesh *m = make();
    rg_mesh_sort(m);
    rg_mesh_connect(m);
    rg_sets_combine(&m->surface, 3, (const int32_t[]){0, 2, 5});
    rg_sets_combine(&m->surface, 2, (const int32_t[]){3, 4});
    rg_mesh_file_write(name, m, 0, NULL);
    rg_mesh_free(m);
}

static void test_combinations(void **state) {
    (void)state;
    static const struct {
        int64_t at, value; /* of (0, 0), (0, 2), (0, 5), (1, 3), (1, 4) */
        const char *said;
    } cases[] = {
        {0, 0, ""},
        {0, 1, "row 0 begins no combination of sets"},
        {2, 1, "row 0 begins no combination of sets"},
        {1, 1, ""},
        {1, 2, "row 0 begins no combination of sets"},
        {1, -1, "row 0 begins no combination of sets"},
        {5, 6, "row 0 begins no combination of sets"},
        {5, 3, ""},
        {3, 5, "row 0 begins no combination of sets"},
        {8, 2, "row 3 begins no combination of sets"},
        {6, 0, "row 0 begins no combination of sets"},
        {9, 5, ""},
        {9, 6, "row 3 begins no combination of sets"},
        {9, 3, "row 3 begins no combination of sets"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char words[100] = "";
        write_overlapping(bad);
        hid_t file = H5Fopen(bad, H5F_ACC_RDWR, H5P_DEFAULT);
        change_integer(file, "surface_combinations", cases[i].at, cases[i].value);
        H5Fclose(file);
        if (cases[i].said[0] != '\0') {
            snprintf(words, sizeof words, "surface_combinations: %s\n", cases[i].said);
        }
        expect_fault(read_whole, words);
    }
    static const struct {
        const char *name;
        int64_t value;
        const char *said;
    } counts[] = {
        {"surface_combinations", -1, "surface_combinations: -1 is not between 0 and 16777216\n"},
        {"surface_combinations", 4, "surface_combinations: has 5 rows, not 4\n"},
        {"volume_combinations", 1,
         "volume_combinations: cannot be read: object 'volume_combinations' doesn't exist; the file is "
         "damaged or not a mesh file\n"},
    };
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        write_overlapping(bad);
        hid_t file = H5Fopen(bad, H5F_ACC_RDWR, H5P_DEFAULT);
        set_attribute(file, counts[i].name, counts[i].value);
        H5Fclose(file);
        expect_fault(read_whole, counts[i].said);
    }
}

/* ---- names ---- */

static void test_names(void **state) {
    (void)state;
    char name[RG_SHORT_NAME];
    memset(name, 'n', sizeof name);
    for (int volumes = 0; volumes < 2; volumes++) {
        hid_t file = open_copy();
        change_value(file, volumes ? "volume_sets" : "surface_sets", 1, name, true);
        H5Fclose(file);
        expect_fault(read_whole,
                     volumes ? "volume_sets: name 1 has no end\n" : "surface_sets: name 1 has no end\n");
    }
    rg_free(mesh->volume.name[0]);
    mesh->volume.name[0] = RG_NEW(char, RG_SET_NAME + 1);
    memset(mesh->volume.name[0], 'n', RG_SET_NAME);
}

static void write_long_name(void) {
    rg_mesh_file_write("long.h5", mesh, 0, NULL);
}

static void test_long_name(void **state) {
    (void)state;
    char said[400], words[300];
    memset(words, 'n', sizeof words);
    snprintf(said, sizeof said, "rhegma: long.h5: the name of set '%.256s' is longer than 255 bytes\n",
             words);
    expect_said(write_long_name, RG_USAGE, said);
    assert_int_not_equal(access("long.h5", F_OK), 0);
    assert_int_not_equal(access("long.h5.part", F_OK), 0);
    /* longest and shortest of long ones, longest of short ones: all come back, and short ones in 64 bytes */
    static const struct { size_t length, stored; } cases[] = {{255, 256}, {64, 256}, {63, 64}};
    for (int k = 0; k < 3; k++) {
        mesh->volume.name[0][cases[k].length] = '\0';
        write_long_name();
        rg_mesh *again = rg_mesh_file_read("long.h5");
        assert_string_equal(again->volume.name[0], mesh->volume.name[0]);
        assert_string_equal(again->volume.name[1], mesh->volume.name[1]);
        rg_mesh_free(again);
        hid_t file = H5Fopen("long.h5", H5F_ACC_RDONLY, H5P_DEFAULT);
        hid_t names = H5Dopen2(file, "volume_sets", H5P_DEFAULT), type = H5Dget_type(names);
        assert_int_equal(H5Tget_size(type), cases[k].stored);
        H5Tclose(type);
        H5Dclose(names);
        H5Fclose(file);
        unlink("long.h5");
    }
}

/* ---- checksums ---- */

static void test_checksums(void **state) {
    (void)state;
    const char *of_tiles[] = {"corner", "neighbour", "face", "set", "region", "original"};
    char words[200];
    for (int k = 0; k < 6; k++) {
        int64_t columns = k < 4 ? 4 : 1, zero = 0, at = columns * ELEMENTS - 1;
        int8_t face = 1;
        int32_t group = k == 4 ? 0 : 1;
        hid_t file = open_copy();
        change_value(file, of_tiles[k], at,
                     k == 2             ? (void *)&face
                     : k == 3 || k == 4 ? (void *)&group
                                        : (void *)&zero,
                     false);
        H5Fclose(file);
        snprintf(words, sizeof words, "%s: the checksum of tile 67 is wrong; the file is damaged\n",
                 of_tiles[k]);
        expect_fault(read_whole, words);
    }
    const char *whole[] = {"vertex_start", "tile_start", "tile_neighbour", "partition_2"};
    for (int k = 1; k < 4; k++) {
        int64_t zero = 3;
        int32_t narrow = 1;
        hid_t file = open_copy();
        change_value(file, whole[k], 5, k < 3 ? (void *)&zero : (void *)&narrow, false);
        H5Fclose(file);
        snprintf(words, sizeof words, "%s: the checksum of part 0 is wrong; the file is damaged\n", whole[k]);
        expect_fault(k < 3 ? read_graph : read_partition, words);
    }
    double x = 9;
    hid_t file = open_copy();
    H5Ldelete(file, "checksum/partition_2", H5P_DEFAULT);
    H5Fclose(file);
    char said[1000];
    assert_int_equal(run_child(read_partition, said, sizeof said), RG_USAGE);
    snprintf(words, sizeof words, "rhegma: bad.h5: partition_2: its checksum cannot be read: ");
    assert_memory_equal(said, words, strlen(words));
    file = open_copy();
    change_value(file, "x", 3 * vertex_start[3], &x, false);
    H5Fclose(file);
    expect_fault(read_whole, "x: the checksum of tile 3 is wrong; the file is damaged\n");
}

/* Chained by rg_hash from 0, each value as a 64-bit word with its sign. */
static void test_rows_checksum(void **state) {
    (void)state;
    const int8_t bytes[8] = {-1, 2, 3, -128, 127, 0, 1, 5};
    const int32_t narrow[2] = {-3, 70000};
    const int64_t wide[4] = {-5, INT64_MAX, INT64_MIN, 9};
    const double real[6] = {-0.0, 1.5, -2, 0, 3e300, 7};
    const char name[2 * RG_SHORT_NAME] = "ab\xe4";
    uint64_t sum[5] = {0}, bits;
    for (int i = 0; i < 8; i++) {
        sum[0] = rg_hash(sum[0], (uint64_t)(int64_t)bytes[i]);
    }
    for (int i = 0; i < 2; i++) {
        sum[1] = rg_hash(sum[1], (uint64_t)(int64_t)narrow[i]);
    }
    for (int i = 0; i < 4; i++) {
        sum[2] = rg_hash(sum[2], (uint64_t)wide[i]);
    }
    for (int i = 0; i < 6; i++) {
        memcpy(&bits, real + i, 8);
        sum[3] = rg_hash(sum[3], bits);
    }
    for (int i = 0; i < 2 * RG_SHORT_NAME; i++) {
        sum[4] = rg_hash(sum[4], (uint64_t)(int64_t)(signed char)name[i]);
    }
    assert_true(rg_rows_checksum(&rg_rows_face, bytes, 2) == sum[0]);
    assert_true(rg_rows_checksum(&rg_rows_tile_faces, narrow, 2) == sum[1]);
    assert_true(rg_rows_checksum(&rg_rows_corner, wide, 1) == sum[2]);
    assert_true(rg_rows_checksum(&rg_rows_original, wide, 4) == sum[2]);
    assert_true(rg_rows_checksum(&rg_rows_x, real, 2) == sum[3]);
    assert_true(rg_rows_checksum(&rg_rows_volume_sets, name, 2) == sum[4]);
    assert_int_equal(rg_rows_bytes(&rg_rows_face), 4);
    assert_int_equal(rg_rows_bytes(&rg_rows_tile_faces), 4);
    assert_int_equal(rg_rows_bytes(&rg_rows_corner), 32);
    assert_int_equal(rg_rows_bytes(&rg_rows_x), 24);
    assert_int_equal(rg_rows_bytes(&rg_rows_volume_sets), 64);
}

/* ---- shapes ---- */

/* Dataset `name` with other rows or columns in its place. */
static void reshape(const char *name, int rank, hsize_t rows, hsize_t columns) {
    hid_t file = open_copy();
    H5Ldelete(file, name, H5P_DEFAULT);
    hid_t space = H5Screate_simple(rank, (hsize_t[]){rows, columns}, NULL);
    hid_t made = H5Dcreate2(file, name, H5T_NATIVE_INT32, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dclose(made);
    H5Sclose(space);
    H5Fclose(file);
}

static void test_shapes(void **state) {
    (void)state;
    static const struct {
        const char *name;
        int rank;
        hsize_t rows, columns;
        const char *said;
    } cases[] = {
        {"corner", 2, 269, 4, "corner: has 269 rows, not 270\n"},
        {"corner", 2, 270, 3, "corner: " DAMAGED},
        {"corner", 1, 270, 1, "corner: " DAMAGED},
        {"region", 2, 270, 1, "region: " DAMAGED},
        {"region", 1, 271, 1, "region: has 271 rows, not 270\n"},
        {"vertex_start", 1, 68, 1, "vertex_start: has 68 rows, not 69\n"},
        {"checksum/face", 1, 67, 1, "checksum/face: has 67 rows, not 68\n"},
        {"checksum/face", 2, 68, 1, "checksum/face: " DAMAGED},
        {"checksum/vertex_start", 1, 68, 1, "checksum/vertex_start: has 68 rows, not 1\n"},
        {"checksum/x", 1, 1, 1, "checksum/x: has 1 rows, not 68\n"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        reshape(cases[i].name, cases[i].rank, cases[i].rows, cases[i].columns);
        expect_fault(read_whole, cases[i].said);
    }
    const char *graph[] = {"tile_start", "tile_neighbour", "tile_faces"};
    for (int k = 0; k < 3; k++) {
        char words[200];
        reshape(graph[k], 1, 5, 1);
        snprintf(words, sizeof words, "%s: " DAMAGED, graph[k]);
        expect_fault(read_graph, k == 1 ? "tile_start: does not span the rows of tile_neighbour\n" : words);
    }
}

static void test_original_number(void **state) {
    (void)state;
    rg_mesh_file *f = rg_mesh_file_open(good);
    assert_int_equal(rg_mesh_file_original(f, 0), 1000);
    assert_int_equal(rg_mesh_file_original(f, 201), 1057);
    assert_int_equal(rg_mesh_file_original(f, 269), 1000 + 7 * 269 % 270);
    assert_int_equal(rg_mesh_file_original(f, 270), 270); /* there is none */
    rg_mesh_file_close(f);
}

/* ---- partitions that are there, and added ---- */

static void test_partitions(void **state) {
    (void)state;
    int32_t distribution[3][TILES], found[TILES];
    int *parts;
    for (int t = 0; t < TILES; t++) {
        distribution[0][t] = t % 11;
        distribution[1][t] = t % 7 % 2;
        distribution[2][t] = t % 3;
    }
    H5Fclose(open_copy());
    rg_mesh_file_add_partitions(
        bad, 3,
        (const rg_tile_partition[]){{11, distribution[0]}, {2, distribution[1]}, {3, distribution[2]}});
    rg_mesh_file *f = rg_mesh_file_open(bad);
    assert_int_equal(rg_mesh_file_partitions(f, &parts), 3);
    assert_true(parts[0] == 2 && parts[1] == 3 && parts[2] == 11);
    for (int k = 0; k < 3; k++) {
        assert_true(rg_mesh_file_partition(f, k == 0 ? 11 : k + 1, found));
        assert_memory_equal(found, distribution[k], sizeof found);
    }
    assert_false(rg_mesh_file_partition(f, 4, found));
    rg_free(parts);
    rg_mesh_file_close(f);
    f = rg_mesh_file_open(good); /* the other file has what it had */
    assert_int_equal(rg_mesh_file_partitions(f, &parts), 1);
    assert_true(rg_mesh_file_partition(f, 2, found));
    for (int t = 0; t < TILES; t++) {
        assert_int_equal(found[t], t == 67);
    }
    rg_free(parts);
    rg_mesh_file_close(f);
    rg_mesh *back = rg_mesh_file_read(bad);
    assert_memory_equal(back->corner, mesh->corner, 4 * ELEMENTS * sizeof *back->corner);
    rg_mesh_free(back);
}

static int set_up(void **state) {
    (void)state;
    int32_t owner[TILES] = {0};
    owner[67] = 1;
    if (mkdtemp(folder) == NULL || chdir(folder) != 0) {
        return -1;
    }
    mesh = make();
    rg_mesh_file_write(good, mesh, 1, &(rg_tile_partition){2, owner});
    hid_t file = H5Fopen(good, H5F_ACC_RDONLY, H5P_DEFAULT);
    int64_t starts;
    vertex_start = load(file, "vertex_start", H5T_NATIVE_INT64, sizeof *vertex_start, &starts);
    return H5Fclose(file);
}

static int tear_down(void **state) {
    (void)state;
    rg_free(vertex_start);
    unlink(good);
    unlink(bad);
    return chdir("/") != 0 || rmdir(folder) != 0;
}

int main(void) {
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_header),           cmocka_unit_test(test_attributes),
        cmocka_unit_test(test_element_values),   cmocka_unit_test(test_vertex_values),
        cmocka_unit_test(test_positions),        cmocka_unit_test(test_graph_values),
        cmocka_unit_test(test_partition_values), cmocka_unit_test(test_checksums),
        cmocka_unit_test(test_rows_checksum),    cmocka_unit_test(test_shapes),
        cmocka_unit_test(test_original_number),  cmocka_unit_test(test_partitions),
        cmocka_unit_test(test_combinations),     cmocka_unit_test(test_names),
        cmocka_unit_test(test_long_name),
    };
    return cmocka_run_group_tests_name("mesh_damage", tests, set_up, tear_down);
}
