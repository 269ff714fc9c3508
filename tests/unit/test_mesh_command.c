/* The command "rhegma mesh": its arguments, and all that it says and writes. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/error.h"
#include "base/mem.h"
#include "mesh/file.h"
#include "mesh_command.h"
#include "support/mesh_text.h"

static char folder[] = "/tmp/test_mesh_command.XXXXXX";

/* The words after "rhegma mesh" */
static const char *const *words;

static int count_words(char *argv[]) {
    int n = 2;
    for (; words[n - 2] != NULL; n++) {
        argv[n] = (char *)(uintptr_t)words[n - 2];
    }
    return n;
}

static void run_command(void) {
    char *argv[20] = {"rhegma", "mesh"};
    dup2(STDERR_FILENO, STDOUT_FILENO); /* all in one, in the order in which it comes */
    setvbuf(stdout, NULL, _IONBF, 0);
    _exit(rg_mesh_command(count_words(argv), argv));
}

#define WORDS(...) ((const char *const[]){__VA_ARGS__, NULL})

static void expect(const char *const *line, int status, const char *said) {
    words = line;
    expect_said(run_command, status, said);
}

static void write_text(const char *name, const char *text) {
    FILE *f = fopen(name, "wb");
    assert_non_null(f);
    fputs(text, f);
    fclose(f);
}

/* Two tetrahedra on either side of triangle 2 3 4. */
static const char pair[] =
    "*NODE\n1, 1, 2, 3\n2, 5, 2, 3.5\n3, 1.5, 7, 3\n4, 1, 2.5, 9\n5, 6, 8, 10\n"
    "*ELEMENT, TYPE=C3D4\n11, 1, 2, 3, 4\n12, 2, 3, 4, 5\n*SURFACE, NAME=s\n11, S1\n12, S3\n";

static const char box[] = "mesh:\n  cells: [2, 3, 2]\n  size: [1, 2, 3]\n"
                          "material: {model: neo-hookean, young: 8, poisson: 0, density: 2}\n"
                          "interface: {law: none}\ntime: {end: 1}\noutput: {fields: []}\n";

/* ---- arguments ---- */

static void test_mistakes(void **state) {
    (void)state;
    static const struct {
        const char *words[8], *said;
    } cases[] = {
        {{NULL}, "nothing to read"},
        {{"-o", "b.h5"}, "nothing to read"},
        {{"a.msh"}, "where to? -o OUT.h5 is missing"},
        {{"a.msh", "-o"}, "missing value after: -o"},
        {{"a.msh", "--scale"}, "missing value after: --scale"},
        {{"a.msh", "b.msh", "-o", "c.h5"}, "one mesh at a time; not understood: b.msh"},
        {{"a.msh", "-o", "b.h5", "--frob", "1"}, "unknown option: --frob"},
        {{"a.msh", "-o", "b.h5", "--scale", "0"}, "--scale must be a number > 0, not: 0"},
        {{"a.msh", "-o", "b.h5", "--scale", "-1"}, "--scale must be a number > 0, not: -1"},
        {{"a.msh", "-o", "b.h5", "--scale", "inf"}, "--scale must be a number > 0, not: inf"},
        {{"a.msh", "-o", "b.h5", "--scale", "nan"}, "--scale must be a number > 0, not: nan"},
        {{"a.msh", "-o", "b.h5", "--scale", "1x"}, "--scale must be a number > 0, not: 1x"},
        {{"a.msh", "-o", "b.h5", "--scale", ""}, "--scale must be a number > 0, not"},
        {{"--info", "a.h5", "-o", "b.h5"}, "--info writes nothing; not understood: -o: b.h5"},
        {{"--info", "a.h5", "--improve"},
         "--improve is for a mesh on its way in; not understood with it: --info"},
        {{"--partition", "2", "a.h5", "--improve"},
         "--improve is for a mesh on its way in; not understood with it: --partition"},
        {{"--partition", "2", "a.h5", "--info"},
         "--partition changes the file that it is given; not understood with it: --info"},
        {{"--partition", "2", "a.h5", "-o", "b.h5"},
         "--partition changes the file that it is given; not understood with it: -o"},
        {{"a.msh", "-o", "b.h5", "--case", "c.yaml"}, "--case is for --info"},
        {{"a.h5", "-o", "b.h5"}, "a mesh file already, which --info shows: a.h5"},
        {{"box.yaml", "-o", "b.h5", "--improve"},
         "--improve is for a mesh on its way in; not understood with it: box.yaml"},
        {{"box.yaml", "-o", "b.h5", "--split"},
         "--split is for a mesh on its way in; not understood with it: box.yaml"},
        {{"box.yaml", "-o", "b.h5", "--scale", "2"},
         "--scale is for a mesh on its way in; not understood with it: box.yaml"},
        {{"--info", "a.h5", "--unit", "mm"},
         "--unit is for a mesh on its way in; not understood with it: --info"},
        {{"--info", "a.h5", "--merge", "1"},
         "--merge is for a mesh on its way in; not understood with it: --info"},
        {{"--partition", "2", "a.h5", "--size", "1"},
         "--size is for a mesh on its way in; not understood with it: --partition"},
        {{"--info", "a.h5", "--curvature", "9"},
         "--curvature is for a mesh on its way in; not understood with it: --info"},
        {{"a.msh", "-o", "b.h5", "--unit", "MM"}, "--unit is one of m, cm, mm, um, nm, in and ft, not: MM"},
        {{"a.msh", "-o", "b.h5", "--unit", "mm", "--scale", "1"},
         "--unit and --scale say the same; not understood together: mm"},
        {{"a.msh", "-o", "b.h5", "--merge", "0"}, "--merge must be a number > 0, not: 0"},
        {{"a.vtk", "-o", "b.h5", "--extrude", "0"},
         "--extrude: a thickness > 0, and perhaps a comma and a number of layers, not: 0"},
        {{"a.vtk", "-o", "b.h5", "--extrude", "1,"},
         "--extrude: a thickness > 0, and perhaps a comma and a number of layers, not: 1,"},
        {{"a.vtk", "-o", "b.h5", "--extrude", "1,0"},
         "--extrude: a thickness > 0, and perhaps a comma and a number of layers, not: 1,0"},
        {{"a.vtk", "-o", "b.h5", "--extrude", "1,2,3"},
         "--extrude: a thickness > 0, and perhaps a comma and a number of layers, not: 1,2,3"},
        {{"--info", "a.h5", "--extrude", "1"},
         "--extrude is for a mesh on its way in; not understood with it: --info"},
        {{"a.geo", "-o", "b.h5", "--size", "0"}, "--size must be > 0, not: 0"},
        {{"a.geo", "-o", "b.h5", "--size", "1 + t"}, "--size must not depend on t: 1 + t"},
        {{"a.geo", "-o", "b.h5", "--curvature", "x"}, "--curvature must be a number > 0, not: x"},
        {{"a.geo", "-o", "b.h5", "--tile", "300"}, "--tile is one of 256, 512 and 1024, not: 300"},
        {{"a.geo", "-o", "b.h5", "--tile", "2048"}, "--tile is one of 256, 512 and 1024, not: 2048"},
        {{"--info", "a.h5", "--tile", "512"},
         "--tile is for a mesh on its way in; not understood with it: --info"},
        {{"a.vtk", "-o", "b.h5", "--size", "1"},
         "it is a mesh already, so --size and --curvature say nothing of it: a.vtk"},
        {{"box.yaml", "-o", "link.h5"}, "it would take the place of what it is made from: -o: link.h5"},
    };
    assert_int_equal(link("box.yaml", "link.h5"), 0);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char said[2000], first[300];
        words = cases[i].words;
        snprintf(first, sizeof first, "rhegma: mesh: %s\nusage: rhegma mesh IN -o OUT.h5 ", cases[i].said);
        int status = run_child(run_command, said, sizeof said);
        if (status != RG_USAGE || strncmp(said, first, strlen(first)) != 0) {
            fail_msg("status %d; said: %s\ninstead of: %s", status, said, first);
        }
    }
    unlink("link.h5");
    assert_int_not_equal(access("b.h5", F_OK), 0);
}

static void test_arguments(void **state) {
    (void)state;
    char *argv[] = {"x",      "y",         "in.msh", "--scale", "0.25",  "-o",
                    "out.h5", "--improve", "--set",  "a=1",     "--set", "b=2"};
    rg_mesh_arguments a = rg_mesh_arguments_read(12, argv, 2);
    assert_string_equal(a.input, "in.msh");
    assert_string_equal(a.output, "out.h5");
    assert_true(a.how.scale == 0.25 && a.improve && !a.info && a.material == NULL && a.partition == NULL);
    assert_int_equal(a.overrides, 2);
    assert_true(strcmp(a.override[0], "a=1") == 0 && strcmp(a.override[1], "b=2") == 0);
    rg_free(a.override);
    char *other[] = {"--info", "--case", "c.yaml", "m.h5"};
    a = rg_mesh_arguments_read(4, other, 0);
    assert_true(a.info && !a.improve && a.how.scale == 1 && a.output == NULL && a.overrides == 0);
    assert_string_equal(a.material, "c.yaml");
    assert_string_equal(a.input, "m.h5");
    rg_free(a.override);
}

/* ---- making ---- */

static void test_import(void **state) {
    (void)state;
    write_text("pair.inp", pair);
    expect(WORDS("pair.inp", "-o", "pair.h5", "--scale", "2"), RG_OK,
           "pair.inp: 0 keywords skipped, which say nothing of the mesh\n"
           "pair.h5: 10 x 12 x 14 m, 2 elements, 5 vertices, 1 surface sets, 0 volume sets\n");
    rg_mesh *m = rg_mesh_file_read("pair.h5");
    assert_true(m->x[0] == 2 && m->x[3 * 4 + 2] == 20 && m->elements == 2);
    rg_mesh_free(m);
    expect(WORDS("box.yaml", "-o", "box.h5"), RG_OK, "box.h5: 1 x 2 x 3 m, 72 elements, 36 vertices\n");
    expect(WORDS("box.yaml", "-o", "box.h5", "--set", "mesh.cells=[1, 2, 1]"), RG_OK,
           "box.h5: 1 x 2 x 3 m, 12 elements, 12 vertices\n");
    m = rg_mesh_file_read("box.h5");
    assert_int_equal(m->elements, 12);
    rg_mesh_free(m);
    assert_int_equal(link("box.yaml", "box.yml"), 0);
    expect(WORDS("box.yml", "-o", "box.h5"), RG_OK, "box.h5: 1 x 2 x 3 m, 72 elements, 36 vertices\n");
    unlink("box.yml");
    expect(WORDS("none.yaml", "-o", "none.h5"), RG_USAGE,
           "none.yaml: cannot be read: No such file or directory\n");
    assert_int_not_equal(access("none.h5", F_OK), 0);
}

/* Units, nodes that coincide (by different nodes, of which the surface names one each), and sizes that make
 * one doubt. */
static void test_units(void **state) {
    (void)state;
    static const char touching[] =
        "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n12, 1, 0, 0\n13, 0, 1, 0.015625\n14, 0, 0, "
        "1\n5, 1, 1, 1\n"
        "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n2, 12, 13, 14, 5\n*SURFACE, NAME=crack\n2, S1\n";
    write_text("touching.inp", touching);
    char said[2000];
    snprintf(said, sizeof said,
             "touching.inp: 3 nodes merged with others within 2e-05 m; the first is node 12 with node 2 at "
             "(0.001, 0, "
             "0) m, the farthest are 1.5625e-05 m apart\n");
    words = WORDS("touching.inp", "-o", "touching.h5", "--unit", "mm", "--merge", "0.02");
    char found[2000];
    assert_int_equal(run_child(run_command, found, sizeof found), RG_OK);
    if (strstr(found, said) == NULL ||
        strstr(found, "touching.h5: 0.001 x 0.001 x 0.001 m, 2 elements, 5 vertices, 1 surface sets") ==
            NULL) {
        fail_msg("said: %s", found);
    }
    rg_mesh *m = rg_mesh_file_read("touching.h5");
    int inside = 0;
    for (int slot = 0; slot < 8; slot++) {
        inside += m->neighbour[slot] >= 0 && m->set[slot] == 0;
    }
    assert_int_equal(inside, 2);
    rg_mesh_free(m);
    words = WORDS("touching.inp", "-o", "touching.h5", "--unit", "mm", "--merge", "0.01");
    assert_int_equal(run_child(run_command, found, sizeof found), RG_OK);
    assert_non_null(strstr(found, "touching.inp: 2 nodes merged with others within 1e-05 m"));
    assert_non_null(strstr(found, "the mesh has 2 parts that share no face\n"));
    static const struct {
        const char *unit, *warning;
    } units[] = {
        {"ft", ""},
        {"in", ""},
        {"cm", ""},
        {"um", ""},
        {"nm", "rhegma: warning: pair.inp: an element is 7.517e-09 m long, which waves of 5000 m/s cross in "
               "1.5e-12 s: is that its unit? (--unit)\n"}};
    write_text("pair.inp", pair);
    for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
        words = WORDS("pair.inp", "-o", "pair.h5", "--unit", units[i].unit);
        assert_int_equal(run_child(run_command, found, sizeof found), RG_OK);
        assert_int_equal(strstr(found, "is that its unit") != NULL, units[i].warning[0] != '\0');
        assert_non_null(strstr(found, units[i].warning));
        m = rg_mesh_file_read("pair.h5");
        const double scale[] = {0.3048, 0.0254, 0.01, 1e-6, 1e-9};
        assert_true(m->x[3 * 4 + 2] == scale[i] * 10);
        rg_mesh_free(m);
    }
    words = WORDS("pair.inp", "-o", "pair.h5", "--scale", "400");
    assert_int_equal(run_child(run_command, found, sizeof found), RG_OK);
    assert_non_null(
        strstr(found, "rhegma: warning: pair.inp: the body is 2800 m long, which waves of 5000 m/s cross in "
                      "0.56 s: is that its unit? (--unit)\n"));
    unlink("touching.inp");
    unlink("touching.h5");
}

/* Parts without a common face: up to eight are told, each by its first element. */
static void test_parts(void **state) {
    (void)state;
    for (int parts = 8; parts <= 9; parts++) {
        char text[4000] = "*NODE\n", said[2000];
        for (int n = 0; n < 4 * parts; n++) {
            static const int x[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
            sprintf(text + strlen(text), "%d, %d, %d, %d\n", n + 1, x[n % 4][0] + 3 * (n / 4), x[n % 4][1],
                    x[n % 4][2]);
        }
        sprintf(text + strlen(text), "%d, 0.75, 0.75, 1.5\n*ELEMENT, TYPE=C3D4\n", 4 * parts + 1);
        for (int e = 0; e < parts; e++) {
            sprintf(text + strlen(text), "%d, %d, %d, %d, %d\n", 50 + e, 4 * e + 1, 4 * e + 2, 4 * e + 3,
                    4 * e + 4);
        }
        sprintf(text + strlen(text), "99, 2, 3, 4, %d\n", 4 * parts + 1); /* beside the first one */
        write_text("parts.inp", text);
        char found[2000];
        words = WORDS("parts.inp", "-o", "parts.h5");
        assert_int_equal(run_child(run_command, found, sizeof found), RG_OK);
        int used = snprintf(said, sizeof said,
                            "parts.inp: 0 keywords skipped, which say nothing of the mesh\n"
                            "rhegma: warning: parts.inp: the mesh has %d parts that share no face\n",
                            parts);
        rg_mesh *m = rg_mesh_file_read("parts.h5");
        bool first = false; /* in the order of the curve; elements 50 and 99 are one part */
        for (int e = 0, p = 0; e <= parts && p < 8; e++) {
            int number = (int)m->original[e];
            bool both = number == 50 || number == 99;
            if (!both || !first) {
                used += snprintf(said + used, sizeof said - (size_t)used,
                                 "rhegma: warning: parts.inp: part %d: %d elements, one of them %d\n", ++p,
                                 both ? 2 : 1, number);
            }
            first = first || both;
        }
        rg_mesh_free(m);
        snprintf(said + used, sizeof said - (size_t)used,
                 "parts.h5: %d x 1 x 1.5 m, %d elements, %d vertices, 0 surface sets, 0 volume sets\n",
                 3 * parts - 2, parts + 1, 4 * parts + 1);
        assert_string_equal(found, said);
    }
    unlink("parts.inp");
    unlink("parts.h5");
}

/* Two flat elements on either side of a large triangle become three around the line between their apexes. */
static void test_improve(void **state) {
    (void)state;
    write_text("flat.inp",
               "*NODE\n1, 0, 0, 0\n2, 0, 0, 1\n3, 3, 0, 0.5\n4, -1.5, 2.4, 0.5\n5, -1.5, -2.7, 0.5\n"
               "*ELEMENT, TYPE=C3D4\n1, 1, 5, 3, 4\n2, 2, 4, 3, 5\n");
    write_text(
        "wrong.inp",
        "*NODE\n1, 0, 0, 0\n2, 0, 0, 1\n3, 3, 0, 0.5\n4, 0, 0, 2\n*ELEMENT, TYPE=C3D4\n7, 1, 2, 4, 3\n");
    expect(WORDS("wrong.inp", "-o", "flat.h5", "--improve"), RG_USAGE,
           "wrong.inp: 0 keywords skipped, which say nothing of the mesh\n"
           "rhegma: wrong.inp: element 7 at (0, 0, 0) m has no volume: 0 m3 with edges of up to 3.3541 m\n");
    assert_int_not_equal(access("flat.h5", F_OK), 0);
    words = WORDS("flat.inp", "-o", "flat.h5", "--improve");
    char said[1000], moved[100];
    long moves;
    double edge;
    assert_int_equal(run_child(run_command, said, sizeof said), RG_OK);
    /* before: half the distance of the apexes */
    assert_int_equal(sscanf(said,
                            "flat.inp: 0 keywords skipped, which say nothing of the mesh\n"
                            "improved: smallest height from 0.5 to %99s m, longest edge from 5.248 to %lf m; "
                            "vertices moved %ld times, 0 edges and 1 faces "
                            "replaced, from 2 to 3 elements\n",
                            moved, &edge, &moves),
                     3);
    rg_mesh *m = rg_mesh_file_read("flat.h5");
    double most = 0;
    for (int k = 0; k < 12; k++) {
        for (int l = k / 4 * 4; l < k; l++) {
            const double *p = m->x + 3 * m->corner[k], *q = m->x + 3 * m->corner[l];
            most = fmax(most, hypot(hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]));
        }
    }
    assert_true(fabs(edge - most) <= 5e-4 * most);
    rg_mesh_free(m);
    assert_true(strtod(moved, NULL) > 0.94);
    assert_non_null(
        strstr(said, "flat.h5: 4.5 x 5.1 x 1 m, 3 elements, 5 vertices, 0 surface sets, 0 volume sets\n"));
    unlink("wrong.inp");
    unlink("flat.inp");
    unlink("flat.h5");
}

/* What the reader of this name has is not here: it is a program of its own, in the folder of this one. */
static void test_other_formats(void **state) {
    (void)state;
    static const char *const names[] = {"a.msh", "yaml", ".h5x", "inp"};
    for (int k = 0; k < 4; k++) {
        char said[1000];
        words = WORDS(names[k], "-o", "b.h5");
        assert_int_equal(run_child(run_command, said, sizeof said), RG_USAGE);
        assert_true(strncmp(said, "rhegma: mesh: /", 15) == 0);
        assert_non_null(strstr(said, "/tests/rhegma-mesh: No such file or directory; it reads all but .yaml, "
                                     ".inp, .vtk, .vtu, .pvtu, .med and .cgns"));
    }
}

/* ---- showing ---- */

static void test_show(void **state) {
    (void)state;
    char said[8000];
    expect(WORDS("box.yaml", "-o", "box.h5"), RG_OK, "box.h5: 1 x 2 x 3 m, 72 elements, 36 vertices\n");
    words = WORDS("--info", "box.h5");
    assert_int_equal(run_child(run_command, said, sizeof said), RG_OK);
    assert_int_equal(
        strncmp(said, "elements       72 in 72 tiles, 36 vertices, 112 interfaces, 64 surface faces\n", 70),
        0);
    assert_non_null(strstr(said, "time steps     smallest height over 1 m/s, in factors of 2\n"));
    assert_non_null(strstr(said, "partitions     none stored: a run makes its own\n"));
    /* lambda is 0, mu 4: waves of sqrt(8/2) m/s */
    words = WORDS("--info", "box.h5", "--case", "box.yaml");
    assert_int_equal(run_child(run_command, said, sizeof said), RG_OK);
    assert_non_null(strstr(said, "time steps     smallest height over 2 m/s, in factors of 2\n"));
    words = WORDS("--info", "box.h5", "--case", "box.yaml", "--set", "material.young=18");
    assert_int_equal(run_child(run_command, said, sizeof said), RG_OK);
    assert_non_null(strstr(said, "time steps     smallest height over 3 m/s, in factors of 2\n"));
    /* of several materials the fastest */
    words = WORDS("--info", "box.h5", "--case", "box.yaml", "--set",
                  "materials=[{name: a, where: x, model: neo-hookean, young: 50, poisson: 0, density: 2}, "
                  "{name: b, where: y, model: "
                  "neo-hookean, young: 2, poisson: 0, density: 2}]");
    assert_int_equal(run_child(run_command, said, sizeof said), RG_OK);
    assert_non_null(strstr(said, "time steps     smallest height over 5 m/s, in factors of 2\n"));
    words = WORDS("--info", "box.h5", "--case", "none.yaml");
    assert_int_equal(run_child(run_command, said, sizeof said), RG_USAGE);
    expect(WORDS("--info", "none.h5"), RG_USAGE,
           "rhegma: none.h5: cannot be read: No such file or directory\n");
}

/* ---- partitions ---- */

#define REFUSED(list)                                                                                        \
    "rhegma: mesh: --partition " list                                                                        \
    ": numbers of ranks, separated by commas, each from 2 to 72, the number of tiles\n"

static void test_partitions(void **state) {
    (void)state;
    char said[2000];
    expect(WORDS("box.yaml", "-o", "box.h5"), RG_OK, "box.h5: 1 x 2 x 3 m, 72 elements, 36 vertices\n");
    expect(WORDS("--partition", "1", "box.h5"), RG_USAGE, REFUSED("1"));
    expect(WORDS("--partition", "73", "box.h5"), RG_USAGE, REFUSED("73"));
    expect(WORDS("--partition", "2,", "box.h5"), RG_USAGE, REFUSED("2,"));
    expect(WORDS("--partition", "2;3", "box.h5"), RG_USAGE, REFUSED("2;3"));
    expect(WORDS("--partition", ",2", "box.h5"), RG_USAGE, REFUSED(",2"));
    expect(WORDS("--partition", "4294967298", "box.h5"), RG_USAGE, REFUSED("4294967298"));
    words = WORDS("--partition", "72,2,12", "box.h5");
    assert_int_equal(run_child(run_command, said, sizeof said), RG_OK);
    assert_int_equal(strncmp(said, "partitions     for ranks\n  2            imbalance 1.000, ", 52), 0);
    assert_non_null(strstr(said, "\n  12           imbalance "));
    assert_non_null(strstr(said, "\n  72           imbalance 1.000, 112 faces between ranks (100 % of all)"));
    int32_t owner[72];
    rg_mesh_file *f = rg_mesh_file_open("box.h5");
    assert_true(rg_mesh_file_partition(f, 72, owner));
    for (int t = 0; t < 72; t++) {
        assert_int_equal(owner[t], t); /* in the order of their tiles */
    }
    rg_mesh_file_close(f);
}

static int set_up(void **state) {
    (void)state;
    if (mkdtemp(folder) == NULL || chdir(folder) != 0) {
        return -1;
    }
    write_text("box.yaml", box);
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    static const char *const names[] = {"box.yaml", "box.h5", "pair.inp", "pair.h5"};
    for (int k = 0; k < 4; k++) {
        unlink(names[k]);
    }
    return chdir("/") != 0 || rmdir(folder) != 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_mistakes),      cmocka_unit_test(test_arguments),
        cmocka_unit_test(test_import),        cmocka_unit_test(test_parts),
        cmocka_unit_test(test_improve),       cmocka_unit_test(test_units),
        cmocka_unit_test(test_other_formats), cmocka_unit_test(test_show),
        cmocka_unit_test(test_partitions),
    };
    return cmocka_run_group_tests_name("mesh_command", tests, set_up, tear_down);
}
