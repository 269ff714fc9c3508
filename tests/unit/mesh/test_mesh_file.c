/* Mesh files: what is written comes back, in whole and by tiles; what is damaged or unsound is refused. */
#include <fcntl.h>
#include <inttypes.h>
#include <hdf5.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/error.h"
#include "base/hash.h"
#include "base/mem.h"
#include "mesh/check.h"
#include "mesh/file.h"
#include "mesh/mesh.h"
#include "support/child.h"
#include "support/mesh_text.h"
#include "support/sanitized.h"

static char path[] = "/tmp/rhegma-mesh-XXXXXX", damaged[sizeof path + 8];

enum { TILES = 68, TILE = 16 };

/* A box of 1,080 elements in 68 tiles of 16, the last one of 8, with a region in its upper half. */
static rg_mesh *make(void) {
    const int64_t cells[3] = {5, 4, 9};
    const double origin[3] = {-1, 0, 2}, size[3] = {0.5, 0.4, 1.1};
    rg_mesh *m = rg_mesh_box(cells, origin, size, 0.1, 3);
    m->region = RG_NEW(int32_t, (size_t)m->elements);
    for (rg_gid e = 0; e < m->elements; e++) {
        m->region[e] = (int32_t)(e < 540 ? -1 : 0);
    }
    rg_sets_add(&m->volume, "upper");
    rg_mesh_sort(m);
    rg_mesh_connect(m);
    return m;
}

static bool same(const void *a, const void *b, rg_gid count, size_t size) {
    return memcmp(a, b, (size_t)count * size) == 0;
}

static bool equal_sets(const rg_sets *a, const rg_sets *b) {
    bool good = a->count == b->count && a->combinations == b->combinations;
    for (int32_t s = 0; s < a->count && good; s++) {
        good = strcmp(a->name[s], b->name[s]) == 0;
    }
    for (int32_t g = 0; good && g < rg_sets_groups(a); g++) {
        for (int32_t s = 0; s < a->count && good; s++) {
            good = rg_sets_hold(a, g, s) == rg_sets_hold(b, g, s);
        }
    }
    return good;
}

static bool equal(const rg_mesh *m, const rg_mesh *n) {
    rg_gid faces = 4 * m->elements;
    bool names = equal_sets(&m->surface, &n->surface) && equal_sets(&m->volume, &n->volume);
    return names && m->elements == n->elements && m->vertices == n->vertices &&
           same(m->x, n->x, 3 * m->vertices, sizeof *m->x) &&
           same(m->corner, n->corner, faces, sizeof *m->corner) &&
           same(m->neighbour, n->neighbour, faces, sizeof *m->neighbour) &&
           same(m->face, n->face, faces, 1) && same(m->set, n->set, faces, sizeof *m->set) &&
           same(m->region, n->region, m->elements, sizeof *m->region) &&
           same(m->original, n->original, m->elements, sizeof *m->original);
}

static int write_file(void **state) {
    int32_t owner[TILES], other[TILES];
    for (int t = 0; t < TILES; t++) {
        owner[t] = t >= 30;
        other[t] = t % 3;
    }
    const rg_tile_partition partition[2] = {{2, owner}, {3, other}};
    rg_mesh *m = make();
    close(mkstemp(path));
    sprintf(damaged, "%s.bad", path);
    rg_mesh_file_write(path, m, 2, partition);
    *state = m;
    return 0;
}

static int remove_file(void **state) {
    rg_mesh_free(*state);
    unlink(path);
    unlink(damaged);
    return 0;
}

static void test_whole(void **state) {
    rg_mesh *back = rg_mesh_file_read(path);
    assert_true(equal(*state, back));
    rg_mesh_free(back);
}

static int64_t version_of(const char *name) {
    int64_t version = 0;
    hid_t file = H5Fopen(name, H5F_ACC_RDONLY, H5P_DEFAULT);
    hid_t attribute = H5Aopen(file, "version", H5P_DEFAULT);
    assert_true(H5Aread(attribute, H5T_NATIVE_INT64, &version) >= 0);
    H5Aclose(attribute);
    H5Fclose(file);
    return version;
}

/* Faces between elements in sets: the same on both sides; a version that older programs do not take. */
static void test_inner_sets(void **state) {
    (void)state;
    rg_mesh *m = make();
    for (rg_gid slot = 0; slot < 4 * m->elements; slot++) {
        rg_gid e = slot / 4, other = m->neighbour[slot];
        m->set[slot] = other >= 0 && (e < other ? 3 * e + other : 3 * other + e) % 7 == 0 ? 2 : m->set[slot];
    }
    rg_mesh_file_write("inner.h5", m, 0, NULL);
    assert_int_equal(version_of("inner.h5"), 3);
    rg_mesh *back = rg_mesh_file_read("inner.h5");
    assert_true(equal(m, back));
    rg_mesh_free(back);
    rg_mesh_free(m);
    unlink("inner.h5");
}

/* Sets that overlap, more of them than a byte counts: groups 128 to 130 among the volumes, and one in the
 * surface. Files without any are of the version that all programs read. */
static void test_overlapping(void **state) {
    (void)state;
    assert_int_equal(version_of(path), 1);
    for (int volumes = 0; volumes < 2; volumes++) {
        rg_mesh *m = make(), *back;
        char name[8];
        for (int s = 1; s < 127 && volumes; s++) {
            snprintf(name, sizeof name, "%d", s);
            rg_sets_add(&m->volume, name);
        }
        if (volumes) {
            rg_sets_combine(&m->volume, 2, (const int32_t[]){0, 126});
            int32_t many[124];
            for (int32_t k = 0; k < 124; k++) {
                many[k] = k + 3;
            }
            rg_sets_combine(&m->volume, 124, many);
        } else {
            rg_sets_combine(&m->surface, 3, (const int32_t[]){1, 3, 4});
        }
        for (rg_gid e = 0; e < m->elements; e++) {
            m->region[e] = volumes ? (int32_t)(e % 129) : 0;
            for (int f = 0; f < 4 && !volumes; f++) {
                m->set[4 * e + f] = m->set[4 * e + f] == 1 ? 6 : m->set[4 * e + f];
            }
        }
        rg_mesh_file_write("overlapping.h5", m, 0, NULL);
        assert_int_equal(version_of("overlapping.h5"), 2);
        back = rg_mesh_file_read("overlapping.h5");
        assert_true(equal(m, back));
        assert_int_equal(back->volume.combinations, volumes ? 2 : 0);
        assert_int_equal(back->surface.combinations, volumes ? 0 : 1);
        rg_mesh_free(back);
        rg_mesh_free(m);
        unlink("overlapping.h5");
    }
}

static void check_slab(const rg_mesh *m, const rg_mesh_slab *s, int64_t begin, int64_t end) {
    rg_gid first = begin * TILE, last = end * TILE;
    last = last < m->elements ? last : m->elements;
    assert_int_equal(s->first, first);
    assert_int_equal(s->elements, last - first);
    assert_true(same(s->corner, m->corner + 4 * first, 4 * s->elements, sizeof *s->corner));
    assert_true(same(s->neighbour, m->neighbour + 4 * first, 4 * s->elements, sizeof *s->neighbour));
    assert_true(same(s->face, m->face + 4 * first, 4 * s->elements, 1));
    assert_true(same(s->set, m->set + 4 * first, 4 * s->elements, sizeof *s->set));
    assert_true(same(s->region, m->region + first, s->elements, sizeof *s->region));
    assert_true(same(s->original, m->original + first, s->elements, sizeof *s->original));
    int64_t *used = RG_NEW(int64_t, (size_t)s->vertices + 1); /* the tile that does, plus 1 */
    for (rg_gid i = 0; i < 4 * s->elements; i++) {
        int64_t tile = 1 + i / 4 / TILE;
        assert_int_equal(s->vertex[s->at[i]], s->corner[i]);
        assert_true(used[s->at[i]] == 0 || used[s->at[i]] == tile);
        used[s->at[i]] = tile;
    }
    for (rg_gid v = 0; v < s->vertices; v++) { /* no more than needed, in order, where they belong */
        bool begins = v == 0 || used[v] > used[v - 1];
        assert_true(used[v] > 0 && (begins || (used[v] == used[v - 1] && s->vertex[v] > s->vertex[v - 1])));
        assert_true(same(s->x + 3 * v, m->x + 3 * s->vertex[v], 3, sizeof(double)));
    }
    rg_free(used);
}

static void test_slabs(void **state) {
    rg_mesh_file *f = rg_mesh_file_open(path);
    int64_t tiles = rg_mesh_file_header(f)->tiles;
    assert_int_equal(tiles, TILES);
    for (int64_t begin = 0; begin < tiles; begin++) {
        for (int64_t end = begin; end <= tiles; end += 1 + (end - begin) / 8) {
            rg_input_errors input_errors = {.name = path};
            rg_mesh_slab *s = rg_mesh_file_slab(f, begin, end, &input_errors);
            assert_int_equal(input_errors.count, 0);
            check_slab(*state, s, begin, end);
            rg_mesh_slab_free(s);
        }
    }
    rg_mesh_file_close(f);
}

static void test_graph(void **state) {
    const rg_mesh *m = *state;
    rg_mesh_file *f = rg_mesh_file_open(path);
    rg_tile_graph *g = rg_mesh_file_graph(f);
    int64_t shared[TILES][TILES] = {{0}};
    for (rg_gid slot = 0; slot < 4 * m->elements; slot++) {
        if (m->neighbour[slot] >= 0) {
            shared[slot / 4 / TILE][m->neighbour[slot] / TILE]++;
        }
    }
    for (int64_t t = 0; t < TILES; t++) {
        int64_t others = 0;
        for (int64_t i = g->start[t]; i < g->start[t + 1]; i++, others++) {
            assert_true(i == g->start[t] || g->neighbour[i] > g->neighbour[i - 1]);
            assert_true(g->neighbour[i] != t);
            assert_int_equal(g->faces[i], shared[t][g->neighbour[i]]);
        }
        for (int64_t u = 0; u < TILES; u++) {
            others -= u != t && shared[t][u] > 0;
        }
        assert_int_equal(others, 0);
    }
    rg_tile_graph_free(g);
    rg_mesh_file_close(f);
}

static void test_partition(void **state) {
    (void)state;
    rg_mesh_file *f = rg_mesh_file_open(path);
    int32_t two[TILES], three[TILES];
    assert_false(rg_mesh_file_partition(f, 4, two));
    assert_true(rg_mesh_file_partition(f, 2, two) && rg_mesh_file_partition(f, 3, three));
    for (int t = 0; t < TILES; t++) {
        assert_true(two[t] == (t >= 30) && three[t] == t % 3);
    }
    rg_mesh_file_close(f);
}

/* Numbers are kept in 32 bits where all of them fit, else in 64. */
static void test_large_numbers(void **state) {
    (void)state;
    static const rg_gid number[] = {INT32_MAX, INT32_MAX + (rg_gid)1, INT32_MIN, INT32_MIN - (rg_gid)1};
    for (size_t k = 0; k < sizeof number / sizeof *number; k++) {
        rg_mesh *m = make();
        m->original[17] = number[k];
        rg_mesh_file_write(damaged, m, 0, NULL);
        rg_mesh *n = rg_mesh_file_read(damaged);
        assert_true(n->original[17] == number[k] && equal(m, n));
        rg_mesh_free(n);
        rg_mesh_free(m);
    }
    unlink(damaged);
}

static void test_same_mesh_same_file(void **state) {
    char *bytes[2];
    long size[2];
    for (int i = 0; i < 2; i++) {
        rg_mesh_file_write(damaged, *state, 0, NULL);
        FILE *f = fopen(damaged, "rb");
        fseek(f, 0, SEEK_END);
        size[i] = ftell(f);
        rewind(f);
        bytes[i] = malloc((size_t)size[i]);
        assert_int_equal(fread(bytes[i], 1, (size_t)size[i], f), size[i]);
        fclose(f);
    }
    assert_int_equal(size[0], size[1]);
    assert_memory_equal(bytes[0], bytes[1], (size_t)size[0]);
    free(bytes[0]);
    free(bytes[1]);
}

/* ---- damage ---- */

static const rg_mesh *expected;

/* Everything that a run can read of the file. */
static void read_all(void) {
    int32_t owner[TILES];
    rg_mesh *m = rg_mesh_file_read(damaged);
    rg_mesh_file *f = rg_mesh_file_open(damaged);
    rg_tile_graph *g = rg_mesh_file_graph(f);
    bool there = rg_mesh_file_partition(f, 2, owner) && rg_mesh_file_partition(f, 3, owner);
    _exit(equal(expected, m) && there && g->tiles == TILES ? 0 : 99);
}

static char *load(size_t *size) {
    FILE *f = fopen(path, "rb");
    fseek(f, 0, SEEK_END);
    *size = (size_t)ftell(f);
    rewind(f);
    char *bytes = malloc(*size);
    assert_int_equal(fread(bytes, 1, *size, f), *size);
    fclose(f);
    return bytes;
}

static void store(const char *bytes, size_t size) {
    FILE *f = fopen(damaged, "wb");
    assert_int_equal(fwrite(bytes, 1, size, f), size);
    fclose(f);
}

static void test_truncated(void **state) {
    size_t size;
    char *bytes = load(&size), said[600];
    expected = *state;
    for (int i = 0; i < 100; i += RG_SANITIZED ? 5 : 1) {
        size_t cut = i < 50 ? (size_t)i * 7 : size - 1 - (size_t)(i - 50) * (size / 51);
        store(bytes, cut);
        assert_int_equal(run_child(read_all, said, sizeof said), RG_USAGE);
        assert_non_null(strstr(said, damaged));
    }
    free(bytes);
}

/* A flipped bit is refused with a message that names the file, or it changes nothing. */
static void test_flipped(void **state) {
    enum { TRIES = RG_SANITIZED ? 30 : 150 };
    size_t size;
    char *bytes = load(&size), said[600];
    int refused = 0;
    expected = *state;
    for (int i = 0; i < TRIES; i++) { /* the header densely, the rest at random */
        uint64_t h = rg_hash(1, (uint64_t)i);
        size_t at = i < TRIES / 2 ? (size_t)i * 11 % size : h % size;
        char good = bytes[at];
        bytes[at] = (char)(good ^ (1 << (h >> 40) % 8));
        store(bytes, size);
        bytes[at] = good;
        int status = run_child(read_all, said, sizeof said);
        if (status != 0 && (status != RG_USAGE || strstr(said, damaged) == NULL)) {
            fail_msg("bit flipped at byte %zu: status %d, said: %s", at, status, said);
        }
        refused += status != 0;
    }
    assert_true(refused > TRIES / 2); /* the rest are gaps that nothing reads */
    free(bytes);
}

static void test_damage_is_named(void **state) {
    const rg_mesh *m = *state;
    size_t size, at = 0;
    char *bytes = load(&size), said[600];
    expected = m;
    while (memcmp(bytes + at, m->x + 3 * m->corner[0], 24) != 0) { /* a position of the first element */
        at++;
    }
    bytes[at + 3] ^= 1;
    store(bytes, size);
    assert_int_equal(run_child(read_all, said, sizeof said), RG_USAGE);
    assert_non_null(strstr(said, ": x: the checksum of tile"));
    free(bytes);
}

/* ---- unsound meshes ---- */

/* Two tetrahedra on either side of triangle 0 1 2, and what a case makes of them. */
static rg_mesh *pair(void) {
    static const double x[5][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}};
    static const rg_gid corner[8] = {0, 1, 2, 3, 0, 1, 2, 4};
    rg_mesh *m = RG_NEW(rg_mesh, 1);
    *m = (rg_mesh){.vertices = 5,
                   .elements = 2,
                   .x = RG_NEW(double, 3 * 12),
                   .corner = RG_NEW(rg_gid, 4 * 3),
                   .neighbour = RG_NEW(rg_gid, 4 * 3),
                   .face = RG_NEW(int8_t, 4 * 3),
                   .set = RG_NEW(int32_t, 4 * 3),
                   .original = RG_NEW(rg_gid, 3)};
    memcpy(m->x, x, sizeof x);
    memcpy(m->corner, corner, sizeof corner);
    memset(m->set, -1, 12 * sizeof *m->set);
    for (rg_gid e = 0; e < 3; e++) {
        m->original[e] = 71 + e;
    }
    return m;
}

static void check(rg_mesh *m) {
    rg_mesh_check_elements(m, "pair");
    rg_mesh_connect(m);
    rg_mesh_check(m, "pair");
}

static void sound(void) {
    check(pair());
}

static void flat(void) {
    rg_mesh *m = pair();
    m->x[3 * 4 + 2] = 1e-14;
    check(m);
}

static void not_finite(void) {
    rg_mesh *m = pair();
    m->x[3 * 4 + 2] = 0.0 / 0.0;
    check(m);
}

static void twice_the_same_corner(void) {
    rg_mesh *m = pair();
    m->corner[7] = 2;
    check(m);
}

static void unused_vertex(void) {
    rg_mesh *m = pair();
    m->vertices = 6;
    m->x[15] = 7;
    check(m);
}

static void thrice(void) {
    rg_mesh *m = pair();
    const rg_gid third[4] = {0, 1, 2, 5};
    m->vertices = 6;
    m->elements = 3;
    m->x[3 * 5 + 2] = -2;
    memcpy(m->corner + 8, third, sizeof third);
    check(m);
}

static void duplicate(void) { /* the second element has its own copies of the triangle's corners */
    rg_mesh *m = pair();
    const rg_gid second[4] = {4, 5, 6, 7};
    memcpy(m->x + 3 * 5, m->x, 9 * sizeof *m->x);
    m->vertices = 8;
    memcpy(m->corner + 4, second, sizeof second);
    check(m);
}

/* The first element of a pair, and a second one of vertices of its own. */
static void check_second(const double corner[4][3]) {
    rg_mesh *m = pair();
    const rg_gid second[4] = {4, 5, 6, 7};
    memcpy(m->x + 3 * 4, corner, 4 * sizeof *corner);
    m->vertices = 8;
    memcpy(m->corner + 4, second, sizeof second);
    check(m);
}

static void hanging(void) { /* with a corner on the middle of the first one's face */
    static const double on[4][3] = {{0.3, 0.3, 0}, {0.5, 0.5, -1}, {0.2, 0.6, -1}, {0.1, 0.1, -1}};
    check_second(on);
}

static void on_an_edge(void) { /* the same on an edge */
    static const double on[4][3] = {{0.5, 0, 0}, {0.5, -0.5, -1}, {0.2, -0.6, -1}, {0.1, -0.1, -1.5}};
    check_second(on);
}

static void strangers(void) {
    rg_mesh *m = pair();
    rg_mesh_connect(m);
    m->face[3] = 2;
    rg_mesh_check(m, "pair");
}

static void test_unsound(void **state) {
    (void)state;
    static const struct {
        void (*job)(void);
        const char *words[3];
    } cases[] = {{flat, {"pair: element 72", "no volume"}},
                 {not_finite, {"pair: element 72"}},
                 {twice_the_same_corner, {"pair: element 72", "four different vertices"}},
                 {unused_vertex, {"pair: no element uses vertex 5"}},
                 {thrice, {"elements 71, 72 and 73 share the face", "0, 1 and 2"}},
                 {duplicate, {"pair: elements 7", "same place"}},
                 {hanging, {"element 72", "(0.3, 0.3, 0)", "hanging node"}},
                 {on_an_edge, {"element 72", "(0.5, 0, 0)", "hanging node"}},
                 {strangers, {"pair: neighbour: element 7", "do not share"}}};
    char said[600];
    assert_int_equal(run_child(sound, said, sizeof said), 0);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_int_equal(run_child(cases[i].job, said, sizeof said), RG_USAGE);
        for (int w = 0; w < 3 && cases[i].words[w] != NULL; w++) {
            if (strstr(said, cases[i].words[w]) == NULL) {
                fail_msg("'%s' is not in: %s", cases[i].words[w], said);
            }
        }
    }
}

static void test_parts(void **state) {
    rg_mesh *m = pair();
    int32_t part[1080];
    const rg_gid second[4] = {4, 5, 6, 7};
    rg_mesh_connect(m);
    assert_int_equal(rg_mesh_parts(m, part), 1);
    m->vertices = 8;
    memcpy(m->corner + 4, second, sizeof second);
    rg_mesh_connect(m);
    assert_int_equal(rg_mesh_parts(m, part), 2);
    assert_true(part[0] == 0 && part[1] == 1);
    assert_int_equal(rg_mesh_parts(*state, part), 1);
    rg_mesh_free(m);
}

static rg_mesh *unwritten;

static void add_to_nothing(void) {
    rg_mesh_file_add_partitions("nowhere.h5", 0, NULL);
}

static void write_to_nowhere(void) {
    rg_mesh_file_write("none/out.h5", unwritten, 0, NULL);
}

static void write_to_folder(void) {
    rg_mesh_file_write("/tmp", unwritten, 0, NULL);
}

static void test_paths(void **state) {
    (void)state;
    unwritten = make();
    expect_said(add_to_nothing, RG_USAGE, "rhegma: nowhere.h5: cannot be read: No such file or directory\n");
    expect_said(write_to_nowhere, RG_FAILURE,
                "rhegma: none/out.h5: cannot be written: No such file or directory\n");
    expect_said(write_to_folder, RG_FAILURE, "rhegma: /tmp: cannot be written: not a file\n");
    rg_mesh_free(unwritten);
}

/* ---- calls of HDF5 that fail while a file is written: the linker puts these before them ---- */

static int calls, failing = -1; /* which of them does; -1: none */

#define MAY_FAIL(type, name, parameters, arguments)                                                          \
    type __wrap_##name parameters;                                                                           \
    type __real_##name parameters;                                                                           \
    type __wrap_##name parameters {                                                                          \
        type found = __real_##name arguments;                                                                \
        return calls++ == failing ? -1 : found;                                                              \
    }

MAY_FAIL(hid_t, H5Fcreate, (const char *name, unsigned flags, hid_t plan, hid_t access),
         (name, flags, plan, access))
MAY_FAIL(herr_t, H5Fclose, (hid_t file), (file))
MAY_FAIL(hid_t, H5Gcreate2, (hid_t at, const char *name, hid_t links, hid_t plan, hid_t access),
         (at, name, links, plan, access))
MAY_FAIL(herr_t, H5Gclose, (hid_t group), (group))
MAY_FAIL(hid_t, H5Acreate2, (hid_t at, const char *name, hid_t type, hid_t space, hid_t plan, hid_t access),
         (at, name, type, space, plan, access))
MAY_FAIL(herr_t, H5Awrite, (hid_t attribute, hid_t type, const void *data), (attribute, type, data))
MAY_FAIL(herr_t, H5Aclose, (hid_t attribute), (attribute))
MAY_FAIL(hid_t, H5Dcreate2,
         (hid_t at, const char *name, hid_t type, hid_t space, hid_t links, hid_t plan, hid_t access),
         (at, name, type, space, links, plan, access))
MAY_FAIL(herr_t, H5Dwrite,
         (hid_t dataset, hid_t type, hid_t memory, hid_t space, hid_t plan, const void *data),
         (dataset, type, memory, space, plan, data))
MAY_FAIL(herr_t, H5Dclose, (hid_t dataset), (dataset))

static void write_with_a_failure(void) {
    calls = 0;
    rg_mesh_file_write(damaged, unwritten, 0, NULL);
    _exit(calls > failing ? 99 : 0);
}

/* Each of them, one after the other: the write ends with words, and what was there before stays. */
static void test_failures(void **state) {
    (void)state;
    const int64_t cells[3] = {1, 1, 1};
    const double origin[3] = {0, 0, 0}, size[3] = {1, 1, 1};
    rg_mesh *m = rg_mesh_box(cells, origin, size, 0, 3);
    char said[600], temporary[sizeof damaged + 8], found[8] = "";
    int status = RG_FAILURE;
    rg_mesh_sort(m);
    rg_mesh_connect(m);
    unwritten = m;
    for (failing = 0; status != 0; failing++) {
        store("before", 6);
        status = run_child(write_with_a_failure, said, sizeof said);
        snprintf(temporary, sizeof temporary, "%s.part", damaged);
        assert_int_equal(access(temporary, F_OK), -1);
        if (status != 0) {
            FILE *f = fopen(damaged, "rb");
            assert_int_equal(fread(found, 1, 7, f), 6);
            fclose(f);
            if (status != RG_FAILURE || strstr(said, ": cannot write ") == NULL ||
                strcmp(found, "before") != 0) {
                fail_msg("call %d: status %d, said: %s", failing, status, said);
            }
        }
    }
    assert_true(failing > 100);
    failing = -1;
    rg_mesh_free(m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_whole),           cmocka_unit_test(test_overlapping),
        cmocka_unit_test(test_inner_sets),      cmocka_unit_test(test_slabs),
        cmocka_unit_test(test_graph),           cmocka_unit_test(test_partition),
        cmocka_unit_test(test_truncated),       cmocka_unit_test(test_flipped),
        cmocka_unit_test(test_damage_is_named), cmocka_unit_test(test_same_mesh_same_file),
        cmocka_unit_test(test_large_numbers),   cmocka_unit_test(test_unsound),
        cmocka_unit_test(test_parts),           cmocka_unit_test(test_paths),
        cmocka_unit_test(test_failures),
    };
    int failed = cmocka_run_group_tests(tests, write_file, remove_file);
    return failed + (rg_alloc_blocks() > 0); /* all is given back */
}
