/* What is told of a mesh, word for word, against measures of each element by other formulas. */
#include <float.h>
#include <math.h>
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

#include "base/mem.h"
#include "mesh/info.h"
#include "support/dice.h"

#define PI 3.14159265358979323846

static double determinant(const double a[3], const double b[3], const double c[3]) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
}

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* An element by formulas that mesh/info.c does not use. */
typedef struct {
    double volume, height, aspect, quality, angle[6];
} twin;

/* Distance of p from the centre of the sphere through the corners: from 2 (x_k - x_0) c = |x_k|^2 - |x_0|^2,
 * by Cramer's rule. */
static double radius(const double x[4][3]) {
    double d[3][3], right[3], t[3][3], c[3];
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 3; i++) {
            d[k][i] = x[k + 1][i] - x[0][i];
        }
        right[k] = dot(d[k], d[k]) / 2;
    }
    for (int i = 0; i < 3; i++) {
        memcpy(t, d, sizeof t);
        for (int k = 0; k < 3; k++) {
            t[k][i] = right[k];
        }
        c[i] = determinant(t[0], t[1], t[2]) / determinant(d[0], d[1], d[2]);
    }
    return sqrt(dot(c, c));
}

/* Angle at the edge a b between the half-planes to c and d: of what is left of c - a and d - a without their
 * part along the edge. */
static double dihedral(const double a[3], const double b[3], const double c[3], const double d[3]) {
    double e[3], p[2][3];
    for (int i = 0; i < 3; i++) {
        e[i] = b[i] - a[i];
        p[0][i] = c[i] - a[i];
        p[1][i] = d[i] - a[i];
    }
    for (int k = 0; k < 2; k++) {
        double along = dot(p[k], e) / dot(e, e);
        for (int i = 0; i < 3; i++) {
            p[k][i] -= along * e[i];
        }
    }
    return acos(dot(p[0], p[1]) / sqrt(dot(p[0], p[0]) * dot(p[1], p[1]))) * 180 / PI;
}

/* Area by Heron's formula. */
static double area_of(const double a[3], const double b[3], const double c[3]) {
    double u = 0, v = 0, w = 0;
    for (int i = 0; i < 3; i++) {
        u += (b[i] - a[i]) * (b[i] - a[i]);
        v += (c[i] - b[i]) * (c[i] - b[i]);
        w += (a[i] - c[i]) * (a[i] - c[i]);
    }
    return sqrt(2 * (u * v + v * w + w * u) - u * u - v * v - w * w) / 4;
}

static twin measure(const rg_mesh *m, rg_gid e) {
    twin t = {.height = INFINITY};
    double x[4][3], d[3][3], area = 0, longest = 0;
    for (int k = 0; k < 4; k++) {
        memcpy(x[k], m->x + 3 * m->corner[4 * e + k], sizeof x[k]);
    }
    for (int k = 0; k < 9; k++) {
        d[k / 3][k % 3] = x[k / 3 + 1][k % 3] - x[0][k % 3];
    }
    t.volume = fabs(determinant(d[0], d[1], d[2])) / 6;
    for (int f = 0; f < 4; f++) {
        double here = area_of(x[(f + 1) % 4], x[(f + 2) % 4], x[(f + 3) % 4]);
        area += here;
        t.height = fmin(t.height, 3 * t.volume / here);
    }
    for (int a = 0, n = 0; a < 4; a++) {
        for (int b = a + 1; b < 4; b++, n++) {
            int c = 0, o = 3;
            while (c == a || c == b) {
                c++;
            }
            while (o == a || o == b) {
                o--;
            }
            double edge[3] = {x[a][0] - x[b][0], x[a][1] - x[b][1], x[a][2] - x[b][2]};
            longest = fmax(longest, sqrt(dot(edge, edge)));
            t.angle[n] = dihedral(x[a], x[b], x[c], x[o]);
        }
    }
    t.aspect = longest / t.height / sqrt(1.5); /* of the regular tetrahedron: height sqrt(2/3) edges */
    t.quality = 9 * t.volume / area / radius((const double(*)[3])x);
    return t;
}

static int low_count(double value, const double *end, int ends) {
    int b = 0;
    while (b < ends && value >= end[b]) {
        b++;
    }
    return b;
}

static void expect_bins(FILE *out, const char *format, double top, int bins, const int *count) {
    for (int b = 0; b < bins; b++) {
        fprintf(out, format, top * b / bins, top * (b + 1) / bins, count[b]);
    }
}

/* The document, as it should be. */
static void write_twin(FILE *out, const rg_mesh *m, double speed, const char *first) {
    static const double ends[7] = {1.5, 2, 3, 5, 10, 20, 50};
    int quality[10] = {0}, aspect[8] = {0}, angle[9] = {0}, octaves[64] = {0}, count = (int)m->elements,
        last = 0;
    twin *t = RG_NEW(twin, (size_t)count);
    int *order = RG_NEW(int, (size_t)count), worst = 0, longest = 0;
    double low = 180, high = 0, tallest = 0;
    for (int e = 0; e < count; e++) {
        t[e] = measure(m, e);
        quality[(int)(10 * t[e].quality)]++;
        aspect[low_count(t[e].aspect, ends, 7)]++;
        for (int k = 0; k < 6; k++) {
            angle[(int)(t[e].angle[k] / 20)]++;
            low = fmin(low, t[e].angle[k]);
            high = fmax(high, t[e].angle[k]);
        }
        worst = t[e].quality < t[worst].quality ? e : worst;
        longest = t[e].aspect > t[longest].aspect ? e : longest;
        tallest = fmax(tallest, t[e].height);
        int at = e;
        for (; at > 0 && t[order[at - 1]].height > t[e].height; at--) {
            order[at] = order[at - 1];
        }
        order[at] = e;
    }
    double least = t[order[0]].height;
    for (int e = 0; e < count; e++) {
        int k = 0;
        while (k < 31 && t[e].height >= least * exp2(k + 1)) {
            k++;
        }
        octaves[k]++;
        last = k > last ? k : last;
    }
    fputs(first, out);
    fprintf(out, "quality        3 inradius / circumradius, elements\n");
    expect_bins(out, "  %5.4g .. %-5.4g  %12d\n", 1, 10, quality);
    fprintf(out, "  worst %.4g: element %d (%d in the input)\n", t[worst].quality, worst, 1000 + worst);
    fprintf(out, "aspect ratio   longest edge / smallest height, 1 for the regular tetrahedron\n");
    static const char *const classes[8] = {"    1 .. 1.5  ", "  1.5 .. 2    ", "    2 .. 3    ",
                                           "    3 .. 5    ", "    5 .. 10   ", "   10 .. 20   ",
                                           "   20 .. 50   ", "   50 .. inf  "};
    for (int b = 0; b < 8; b++) {
        fprintf(out, "  %s  %12d\n", classes[b], aspect[b]);
    }
    fprintf(out, "  worst %.4g: element %d (%d in the input)\n", t[longest].aspect, longest, 1000 + longest);
    fprintf(out, "angles         between faces, degrees\n");
    expect_bins(out, "  %5.4g .. %-5.4g  %12d\n", 180, 9, angle);
    fprintf(out, "  from %.4g to %.4g degrees\n", low, high);
    fprintf(out, "heights        %.4g .. %.4g m; smallest:\n", least, tallest);
    for (int i = 0; i < 5 && i < count; i++) {
        const double *x = m->x + 3 * m->corner[4 * order[i]];
        fprintf(out, "  %.4g m element %d (%d in the input) at (%.4g, %.4g, %.4g) m\n", t[order[i]].height,
                order[i], 1000 + order[i], x[0], x[1], x[2]);
    }
    fprintf(out, "time steps     smallest height over %g m/s, in factors of 2\n", speed);
    for (int k = 0; k <= last; k++) {
        fprintf(out, "  %.4g .. %.4g s %12d\n", least / speed * exp2(k), least / speed * exp2(k + 1),
                octaves[k]);
    }
    rg_free(t);
    rg_free(order);
}

static void expect_same(const rg_mesh *m, double speed, const char *first) {
    char *text[2];
    size_t size[2];
    FILE *found = open_memstream(&text[0], &size[0]), *expected = open_memstream(&text[1], &size[1]);
    rg_mesh_info(m, speed, found);
    write_twin(expected, m, speed, first);
    fclose(found);
    fclose(expected);
    assert_string_equal(text[0], text[1]);
    free(text[0]);
    free(text[1]);
}

/* Elements of their own, `count`, of any shape: regular ones, flat and thin ones, of sizes over many octaves.
 */
static rg_mesh *scattered(int count, uint64_t seed) {
    size_t slots = 4 * (size_t)count;
    rg_mesh *m = RG_NEW(rg_mesh, 1);
    *m = (rg_mesh){.vertices = 4 * count,
                   .elements = count,
                   .x = RG_NEW(double, 3 * slots),
                   .corner = RG_NEW(rg_gid, slots),
                   .neighbour = RG_NEW(rg_gid, slots),
                   .face = RG_NEW(int8_t, slots),
                   .set = RG_NEW(int32_t, slots),
                   .original = RG_NEW(rg_gid, (size_t)count)};
    dice d = {.seed = seed};
    for (int e = 0; e < count; e++) {
        double size = dice_power(&d, -2, 1), flat = e % 3 == 0 ? dice_power(&d, -2.5, 0) : 1;
        for (int k = 0; k < 12; k++) {
            static const double regular[12] = {1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1};
            double shape = regular[k] + (e % 4 == 1 ? 0.01 : 0.6) * dice_sign(&d);
            m->x[12 * e + k] = size * shape * (k % 3 == e % 3 ? flat : 1) + 30 * e;
        }
        m->original[e] = 1000 + e;
    }
    for (size_t s = 0; s < slots; s++) {
        m->corner[s] = (rg_gid)s;
        m->set[s] = (int32_t)(s * s / 3 % 4) - 1;
    }
    rg_mesh_connect(m);
    static const char *const names[] = {"top", "side", "foot", "steel", "brass"};
    for (int k = 0; k < 5; k++) {
        rg_sets_add(k < 3 ? &m->surface : &m->volume, names[k]);
    }
    return m;
}

/* What stands before the measures. */
static void write_counts(FILE *out, const rg_mesh *m, const char *parts) {
    int faces[4] = {0}, elements[3] = {0};
    double volume = 0, low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (rg_gid s = 0; s < 4 * m->elements; s++) {
        faces[m->set[s] + 1]++;
    }
    for (rg_gid e = 0; e < m->elements; e++) {
        elements[m->region != NULL ? m->region[e] + 1 : 0]++;
        volume += measure(m, e).volume;
    }
    for (rg_gid k = 0; k < 3 * m->vertices; k++) {
        low[k % 3] = fmin(low[k % 3], m->x[k]);
        high[k % 3] = fmax(high[k % 3], m->x[k]);
    }
    int tile = rg_mesh_tile(m);
    fprintf(out, "elements       %d in %d tiles, %d vertices, 0 interfaces, %d surface faces\n",
            (int)m->elements, (int)(m->elements + tile - 1) / tile, (int)m->vertices, 4 * (int)m->elements);
    fprintf(out, "box            %g .. %g, %g .. %g, %g .. %g m; volume %.9g m3\n", low[0], high[0], low[1],
            high[1], low[2], high[2], volume);
    fprintf(out, "parts          %d that share no face:%s elements\n", (int)m->elements, parts);
    fprintf(out,
            "surface set    top: %d faces\nsurface set    side: %d faces\nsurface set    foot: %d faces\n"
            "               in no surface set: %d faces\n"
            "volume set     steel: %d elements\nvolume set     brass: %d elements\n"
            "               in no volume set: %d elements\n",
            faces[1], faces[2], faces[3], faces[0], elements[1], elements[2], elements[0]);
}

/* Faces between two elements are counted by themselves, once. */
static void test_inner_sets(void **state) {
    (void)state;
    rg_mesh *m = scattered(2, 3);
    const double x[5][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
    memcpy(m->x, x, sizeof x);
    m->vertices = 5;
    for (int k = 0; k < 4; k++) {
        m->corner[k] = k;
        m->corner[4 + k] = k + 1;
    }
    for (int slot = 0; slot < 8; slot++) {
        m->set[slot] = slot == 0 || slot == 7 ? 2 : slot == 3 || slot == 5 ? 0 : slot == 4 ? 2 : -1;
    }
    rg_mesh_connect(m);
    char *text;
    size_t length;
    FILE *stream = open_memstream(&text, &length);
    rg_mesh_info(m, 1, stream);
    fclose(stream);
    assert_non_null(strstr(text, "surface set    top: 2 faces\nsurface set    side: 0 faces\n"
                                 "surface set    foot: 1 faces, and 1 between elements\n"
                                 "               in no surface set: 3 faces\n"));
    free(text);
    rg_mesh_free(m);
}

static void test_scattered(void **state) {
    (void)state;
    static const int counts[] = {400, 130, 9, 8, 3, 1};
    static const char *const parts[] = {" 1 1 1 1 1 1 1 1 ...",
                                        " 1 1 1 1 1 1 1 1 ...",
                                        " 1 1 1 1 1 1 1 1 ...",
                                        " 1 1 1 1 1 1 1 1",
                                        " 1 1 1",
                                        " 1"};
    for (int k = 0; k < 6; k++) {
        char *first;
        size_t size;
        rg_mesh *m = scattered(counts[k], 5 + (uint64_t)k);
        for (int regions = 0; regions < 2; regions++) {
            m->region = regions ? RG_NEW(int32_t, (size_t)m->elements) : NULL;
            for (rg_gid e = 0; e < m->elements && regions; e++) {
                m->region[e] = (int32_t)(e * e % 5 % 3 - 1);
            }
            FILE *stream = open_memstream(&first, &size);
            write_counts(stream, m, parts[k]);
            fclose(stream);
            expect_same(m, k == 0 ? 1 : 5837.25, first);
            free(first);
        }
        rg_mesh_free(m);
    }
}

/* Sizes over more than 32 factors of 2, of which the last class takes the rest, and equal ones: the lower
 * number is told first. */
static void test_extremes(void **state) {
    (void)state;
    rg_mesh *m = scattered(7, 3);
    static const double size[7] = {1, 1, 0x1p-34, 0x1p-3, 1, 0x1p-34, 0x1p-2};
    static const double shape[12] = {0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3};
    for (int k = 0; k < 84; k++) {
        m->x[k] = size[k / 12] * shape[k % 12];
    }
    char *text;
    size_t length;
    FILE *stream = open_memstream(&text, &length);
    rg_mesh_info(m, 1, stream);
    fclose(stream);
    /* volume 1, largest face 7/2: height 6/7 of the size */
    const char *heights = strstr(text, "heights");
    assert_non_null(heights);
    char expected[4000];
    int used = sprintf(expected,
                       "heights        %.4g .. 0.8571 m; smallest:\n"
                       "  %.4g m element 2 (1002 in the input) at (0, 0, 0) m\n"
                       "  %.4g m element 5 (1005 in the input) at (0, 0, 0) m\n"
                       "  %.4g m element 3 (1003 in the input) at (0, 0, 0) m\n"
                       "  %.4g m element 6 (1006 in the input) at (0, 0, 0) m\n"
                       "  0.8571 m element 0 (1000 in the input) at (0, 0, 0) m\n"
                       "time steps     smallest height over 1 m/s, in factors of 2\n",
                       6.0 / 7 * 0x1p-34, 6.0 / 7 * 0x1p-34, 6.0 / 7 * 0x1p-34, 6.0 / 7 / 8, 6.0 / 7 / 4);
    for (int k = 0; k < 32; k++) {
        double low = 6.0 / 7 * ldexp(1, k - 34);
        used += sprintf(expected + used, "  %.4g .. %.4g s %12d\n", low, 2 * low,
                        k == 0    ? 2
                        : k == 31 ? 5
                                  : 0);
    }
    assert_string_equal(heights, expected);
    free(text);
    rg_mesh_free(m);
}

/* The regular tetrahedron has quality and aspect ratio 1, the last and the first class. */
static void test_regular(void **state) {
    (void)state;
    rg_mesh *m = scattered(1, 3);
    static const double x[12] = {1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1};
    memcpy(m->x, x, sizeof x);
    char *text;
    size_t length;
    FILE *stream = open_memstream(&text, &length);
    rg_mesh_info(m, 1, stream);
    fclose(stream);
    assert_non_null(
        strstr(text, "\n    0.9 .. 1                 1\n  worst 1: element 0 (1000 in the input)\n"));
    assert_non_null(strstr(text, "worst 1: element 0 (1000 in the input)\nangles"));
    assert_non_null(strstr(text, "\n     60 .. 80                6\n"));
    assert_non_null(strstr(text, "\n  from 70.53 to 70.53 degrees\n"));
    free(text);
    rg_mesh_free(m);
}

/* ---- partitions ---- */

static void expect_quality(const rg_partition_quality *q, rg_gid interfaces, const char *words) {
    char *text;
    size_t length;
    FILE *stream = open_memstream(&text, &length);
    rg_quality_print(q, interfaces, stream);
    fclose(stream);
    assert_string_equal(text, words);
    free(text);
}

static void test_quality(void **state) {
    (void)state;
    rg_partition_quality q = {1.25, 1.25, 30, 3, 2.5};
    expect_quality(&q, 240,
                   "imbalance 1.250, 30 faces between ranks (12.5 % of all), neighbours of a rank: at most "
                   "3, mean 2.5\n");
    expect_quality(
        &q, 0,
        "imbalance 1.250, 30 faces between ranks (0 % of all), neighbours of a rank: at most 3, mean 2.5\n");
    expect_quality(&q, 1,
                   "imbalance 1.250, 30 faces between ranks (3e+03 % of all), neighbours of a rank: at most "
                   "3, mean 2.5\n");
    q.cost_imbalance = 1.125;
    expect_quality(&q, 240,
                   "imbalance 1.250 (1.125 of the cost), 30 faces between ranks (12.5 % of all), neighbours "
                   "of a rank: at most 3, mean 2.5\n");
    q.cost_imbalance = 1.5;
    expect_quality(&q, 240,
                   "imbalance 1.250 (1.500 of the cost), 30 faces between ranks (12.5 % of all), neighbours "
                   "of a rank: at most 3, mean 2.5\n");
}

static void expect_partitions(const char *path, const char *words) {
    char *text;
    size_t length;
    FILE *stream = open_memstream(&text, &length);
    rg_mesh_file *f = rg_mesh_file_open(path);
    rg_mesh_info_partitions(f, stream);
    rg_mesh_file_close(f);
    fclose(stream);
    assert_string_equal(text, words);
    free(text);
}

/* A row of 48 cells of 288 elements in 72 tiles of 4: 1.5 cells each. */
static void test_stored_partitions(void **state) {
    (void)state;
    static const int64_t cells[3] = {48, 1, 1};
    static const double origin[3] = {0, 0, 0}, size[3] = {48, 1, 1};
    rg_mesh *m = rg_mesh_box(cells, origin, size, 0, 1);
    int32_t two[72], twelve[72];
    int cut = 0, cuts = 0;
    for (int t = 0; t < 72; t++) {
        two[t] = t >= 48;
        twelve[t] = t / 6;
    }
    char path[] = "/tmp/test_mesh_info.XXXXXX", words[600];
    close(mkstemp(path));
    rg_mesh_file_write(path, m, 0, NULL);
    expect_partitions(path, "partitions     none stored: a run makes its own\n");
    rg_mesh_file_add_partitions(path, 2, (const rg_tile_partition[]){{12, twelve}, {2, two}});
    for (rg_gid s = 0; s < 4 * m->elements; s++) {
        rg_gid other = m->neighbour[s];
        cut += other > s / 4 && two[other / 4] != two[s / 16];
        cuts += other > s / 4 && twelve[other / 4] != twelve[s / 16];
    }
    snprintf(words, sizeof words,
             "partitions     for ranks\n"
             "  2            imbalance 1.333, %d faces between ranks (%.3g %% of all), neighbours of a rank: "
             "at most 1, mean 1\n"
             "  12           imbalance 1.000, %d faces between ranks (%.3g %% of all), neighbours of a rank: "
             "at most 2, mean 1.83\n",
             cut, 100.0 * cut / (288 * 2 - 2 * 97), cuts, 100.0 * cuts / (288 * 2 - 2 * 97));
    expect_partitions(path, words);
    unlink(path);
    rg_mesh_free(m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_scattered), cmocka_unit_test(test_inner_sets),
        cmocka_unit_test(test_extremes),  cmocka_unit_test(test_regular),
        cmocka_unit_test(test_quality),   cmocka_unit_test(test_stored_partitions),
    };
    int failed = cmocka_run_group_tests_name("mesh_info", tests, NULL, NULL);
    return failed + (rg_alloc_blocks() > 0); /* all is given back */
}
