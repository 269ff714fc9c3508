/* VTK: legacy and XML, text and binary, compressed and not, cell data as regions, and every mistake. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

#include <cmocka.h>

#include "base/mem.h"

#include "base/error.h"
#include "mesh/import/unpack.h"
#include "mesh/import/vtk_read.h"
#include "support/mesh_text.h"

static char folder[] = "/tmp/test_vtk.XXXXXX";
static rg_import_how how = {.scale = 1};

static void read_legacy(void) {
    print_mesh(rg_vtk_read("a.vtk", &how), stderr);
}

static void read_xml(void) {
    print_mesh(rg_vtu_read("a.vtu", &how), stderr);
}

static void write_bytes(const char *path, const void *data, size_t size) {
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(data, 1, size, f), size);
    assert_int_equal(fclose(f), 0);
}

static void expect_legacy(const char *words, int status, const char *said) {
    write_bytes("a.vtk", words, strlen(words));
    expect_said(read_legacy, status, said);
}

static void expect_xml(const char *words, int status, const char *said) {
    write_bytes("a.vtu", words, strlen(words));
    expect_said(read_xml, status, said);
}

/* Two tetrahedra on either side of points 1 2 3, and a triangle at the first. */
#define HEAD(version)                                                                                        \
    "# vtk DataFile Version " version "\na title, POINTS 7\nASCII\nDATASET UNSTRUCTURED_GRID\n"
#define POINTS  "POINTS 5 double\n1 2 3 5 2 3.5 1.5 7\n3 1 2.5 9\n6 8 10\n"
#define CELLS   "CELLS 3 14\n4 0 1 2 3\n3 0 2 1 4 1 2 3 4\n"
#define TYPES   "CELL_TYPES 3\n10\n5\n10\n"
#define GRID    HEAD("4.2") POINTS CELLS TYPES
#define X5      "x 0: 1 2 3\nx 1: 5 2 3.5\nx 2: 1.5 7 3\nx 3: 1 2.5 9\nx 4: 6 8 10\n"
#define BARE    X5 "e 0: 0 1 2 3\ne 2: 1 2 3 4\n"
#define IN_SETS X5 "e 0: 0 1 2 3 in r.3, r.7 at 3\ne 2: 1 2 3 4 in r.-4\n"
#define WARNING "rhegma: warning: a.vtk: "

static void test_legacy(void **state) {
    (void)state;
    static const char *const same[] = {
        GRID,
        HEAD("5.1") POINTS "CELLS 4 11\nOFFSETS vtktypeint64\n0 4 7 11\nCONNECTIVITY vtktypeint64\n0 1 2 3 0 "
                           "2 1\n1 2 3 4\n" TYPES,
        HEAD("2.0") "FIELD f 1\ntime 1 1 double\n7\nPOINTS 5 float\n1 2 3\n5 2 3.5\n1.5 7 3\n1 2.5 9\n6 8 "
                    "10\nMETADATA\n"
                    "INFORMATION 1\nNAME x LOCATION y\nDATA 2 3\n\n" CELLS TYPES,
        GRID "POINT_DATA 5\nSCALARS t int\nLOOKUP_TABLE default\n1 2 3 4 5\nVECTORS v double\n1 2 3 4 5 6 7 "
             "8 9 10 11 12 13 14 15\n"
             "CELL_DATA 3\nVECTORS w float\n1 2 3 4 5 6 7 8 9\nNORMALS n float\n1 2 3 4 5 6 7 8 9\nTENSORS6 "
             "s float\n"
             "1 2 3 4 5 6 1 2 3 4 5 6 1 2 3 4 5 6\nTENSORS q int\n1 2 3 4 5 6 7 8 9 1 2 3 4 5 6 7 8 9 1 2 3 "
             "4 5 6 7 8 9\n"
             "SCALARS three int 3\nLOOKUP_TABLE t\n1 2 3 4 5 6 7 8 9\nLOOKUP_TABLE t 2\n0 0 0 1 1 1 1 1\n"
             "COLOR_SCALARS c 2\n0 1 0 1 0 1\nGLOBAL_IDS g vtkIdType\n1 2 3\nPEDIGREE_IDS p int\n7 8 9\n"
             "FIELD f 1\nother 1 2 int\n3 4\n",
    };
    for (size_t i = 0; i < sizeof same / sizeof *same; i++) {
        expect_legacy(same[i], RG_OK, BARE);
    }
    /* without data a triangle between tetrahedra is a place that stays */
    expect_legacy(HEAD("4.2") POINTS "CELLS 3 14\n4 0 1 2 3\n3 3 2 1\n4 1 2 3 4\n" TYPES, RG_OK,
                  BARE "inner 1 2 3\n");
    static const char *const regions[] = {
        GRID "CELL_DATA 3\nSCALARS r int\nLOOKUP_TABLE default\n3 7 -4\n",
        GRID "CELL_DATA 3\nSCALARS r double 1\nLOOKUP_TABLE default\n3.0 7 -4e0\n",
        GRID "CELL_DATA 3\nSCALARS\tr\tdouble\t1\n3.0\t7\t-4e0\n",
        GRID
        "CELL_DATA 3\nFIELD d 2\nr 1 3 short\n3 7 -4\nMETADATA\nINFORMATION 0\n\nv 2 3 int\n1 1 2 2 3 3\n",
        GRID "CELL_DATA 3\nSCALARS r int\n3 7 -4\nPOINT_DATA 5\nSCALARS x int\n1 2 3 4 5\n",
    };
    for (size_t i = 0; i < sizeof regions / sizeof *regions; i++) {
        expect_legacy(regions[i], RG_OK, IN_SETS);
    }
    how.scale = 0.5;
    expect_legacy(
        HEAD("1.0") "POINTS 4 int\n0 0 0 2 0 0 0 2 0 0 0 6\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n", RG_OK,
        "x 0: 0 0 0\nx 1: 1 0 0\nx 2: 0 1 0\nx 3: 0 0 3\ne 0: 0 1 2 3\n");
    how.scale = 1;
}

static void test_regions(void **state) {
    (void)state;
    expect_legacy(
        GRID "CELL_DATA 3\nFIELD d 3\nr 1 3 int\n3 7 3\nmy%20part 1 3 int\n1 1 2\nhalf 1 3 float\n0 0 0.5\n",
        RG_OK,
        WARNING "cell data 'half' are not the numbers of regions: they name no sets\n" X5
                "e 0: 0 1 2 3 in r.3 and my part.1, r.7 and my part.1 and half.0 at 3\n"
                "e 2: 1 2 3 4 in r.3 and my part.2\n");
    expect_legacy(GRID "CELL_DATA 3\nSCALARS big double\n1 2 1e9\n", RG_OK,
                  WARNING "cell data 'big' are not the numbers of regions: they name no sets\n" X5
                          "e 0: 0 1 2 3, big.2 at 3\ne 2: 1 2 3 4\n");
    /* the numbers of the cells are none of regions: more than half of 20 are different, but not of 22 */
    for (int cells = 18; cells <= 22; cells += 2) {
        char words[4000] = HEAD("4.2") "POINTS 4 int\n0 0 0 1 0 0 0 1 0 0 0 1\n", found[4000];
        sprintf(words + strlen(words), "CELLS %d %d\n", cells, 5 * cells);
        for (int i = 0; i < cells; i++) {
            strcat(words, "4 0 1 2 3\n");
        }
        sprintf(words + strlen(words), "CELL_TYPES %d\n", cells);
        for (int i = 0; i < cells; i++) {
            strcat(words, "10\n");
        }
        sprintf(words + strlen(words), "CELL_DATA %d\nSCALARS n int\n", cells);
        for (int i = 0; i < cells; i++) {
            sprintf(words + strlen(words), "%d\n", i < 11 ? i : 10);
        }
        write_bytes("a.vtk", words, strlen(words));
        assert_int_equal(run_child(read_legacy, found, sizeof found), RG_OK);
        assert_int_equal(strstr(found, "name no sets") != NULL, cells < 22);
        assert_int_equal(strstr(found, "in n.0") != NULL, cells == 22);
        if (cells == 22) {
            rg_mesh *m = rg_vtk_read("a.vtk", &how);
            assert_int_equal(m->volume.count, 11);
            rg_mesh_free(m);
        }
    }
    /* few cells may all have regions of their own */
    expect_legacy(GRID "CELL_DATA 3\nSCALARS r int\n3 7 -4\n", RG_OK, IN_SETS);
}

static void test_cells(void **state) {
    (void)state;
    static const struct {
        int type, status; /* of a cell of four points beside a tetrahedron */
    } types[] = {{0, 0},  {1, 0},  {2, 0},  {3, 0},  {4, 0},  {6, 0},  {7, 0},  {8, 0},  {9, 0},  {21, 0},
                 {23, 0}, {28, 0}, {30, 0}, {34, 0}, {36, 0}, {68, 0}, {69, 0}, {70, 0}, {75, 0}, {76, 0},
                 {11, 2}, {12, 2}, {13, 2}, {14, 2}, {15, 2}, {25, 2}, {26, 2}, {29, 2}, {42, 2}, {71, 2}};
    for (size_t i = 0; i < sizeof types / sizeof *types; i++) {
        char words[1000], said[400];
        sprintf(words, HEAD("4.2") POINTS "CELLS 2 10\n4 1 2 3 4\n4 0 1 2 3\nCELL_TYPES 2\n%d\n10\n",
                types[i].type);
        if (types[i].status == 0) {
            sprintf(said, WARNING
                    "1 cells that are points, lines or no triangles are left out\n" WARNING
                    "1 nodes belong to no tetrahedron and are left out; the first is node 4 at (6, 8, 10) m\n"
                    "x 0: 1 2 3\nx 1: 5 2 3.5\nx 2: 1.5 7 3\nx 3: 1 2.5 9\ne 1: 0 1 2 3\n");
        } else {
            sprintf(said,
                    "rhegma: a.vtk: 1 cells are neither tetrahedra nor flat, the first of them cell 0 of "
                    "type %d; only "
                    "tetrahedra of first and second order are possible; --split cuts hexahedra, wedges and "
                    "pyramids\n",
                    types[i].type);
        }
        expect_legacy(words, types[i].status, said);
    }
    /* second order: the middles of edges 01 12 02 03 13 23 */
    char quadratic[1000] =
        HEAD("4.2") "POINTS 10 double\n0 0 0 2 0 0 0 2 0 0 0 2 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 0 1 1\n"
                    "CELLS 2 18\n10 0 1 2 3 4 5 6 7 8 9\n6 0 1 2 4 5 6\nCELL_TYPES 2\n24\n22\n"
                    "CELL_DATA 2\nSCALARS r int\n1 2\n";
    expect_legacy(quadratic, RG_OK,
                  "x 0: 0 0 0\nx 1: 2 0 0\nx 2: 0 2 0\nx 3: 0 0 2\ne 0: 0 1 2 3 in r.1, r.2 at 3\n");
}

#define BOX                                                                                                  \
    "e 0: 0 4 6 7 in r.3, r.7 at 0\ne 0: 0 4 5 7 in r.3, r.7 at 0\ne 0: 0 1 5 7 in r.3\ne 0: 0 1 3 7 in "    \
    "r.3\ne 0: 0 2 3 7 in r.3\ne 0: 0 2 6 7 in r.3\n"
#define WEDGE                                                                                                \
    "x 0: 0 0 0\nx 1: 2 0 0\nx 2: 0 2 0\nx 3: 0 0 2\nx 4: 2 0 2\nx 5: 0 2 2\nx 6: 3 3 1\ne 0: 0 3 4 5\n"
#define PYRAMID "e 1: 1 2 5 6\ne 1: 1 4 5 6\n"

/* A box of 1 x 2 x 3 as one cell of each shape, with a side in a set; cut from its lowest corner, and the
 * side with it. */
static void test_split(void **state) {
    (void)state;
    static const struct {
        int solid, flat, nodes, side;
        const char *corners, *sides;
    } cells[] = {
        {12, 9, 8, 4, "0 1 3 2 4 5 7 6", "4 6 7 5"},
        {11, 8, 8, 4, "0 1 2 3 4 5 6 7", "4 6 5 7"},
        {25, 23, 20, 8, "0 1 3 2 4 5 7 6 8 8 8 8 8 8 8 8 8 8 8 8", "4 6 7 5 8 8 8 8"},
        {29, 28, 27, 9, "0 1 3 2 4 5 7 6 8 8 8 8 8 8 8 8 8 8 8 8 8 8 8 8 8 8 8", "4 6 7 5 8 8 8 8 8"},
        {33, 30, 24, 6, "0 1 3 2 4 5 7 6 8 8 8 8 8 8 8 8 8 8 8 8 8 8 8 8", "4 6 7 5 8 8"}};
    for (size_t i = 0; i < sizeof cells / sizeof *cells; i++) {
        char input[1500];
        sprintf(
            input,
            HEAD("4.2") "POINTS 9 int\n0 0 0 1 0 0 0 2 0 1 2 0 0 0 3 1 0 3 0 2 3 1 2 3 5 5 5\nCELLS 2 %d\n"
                        "%d %s\n%d %s\nCELL_TYPES 2\n%d\n%d\nCELL_DATA 2\nSCALARS r int\n3 7\n",
            cells[i].nodes + cells[i].side + 2, cells[i].nodes, cells[i].corners, cells[i].side,
            cells[i].sides, cells[i].solid, cells[i].flat);
        how.split = true;
        expect_legacy(
            input, RG_OK,
            WARNING "1 nodes belong to no tetrahedron and are left out; the first is node 8 at (5, 5, 5) m\n"
                    "x 0: 0 0 0\nx 1: 1 0 0\nx 2: 0 2 0\nx 3: 1 2 0\nx 4: 0 0 3\nx 5: 1 0 3\nx 6: 0 2 3\n"
                    "x 7: 1 2 3\n" BOX);
    }
    /* a wedge, either way round, and a pyramid, side by side */
    for (int way = 0; way < 2; way++) {
        char input[1000];
        sprintf(input,
                HEAD("4.2") "POINTS 7 int\n0 0 0 2 0 0 0 2 0 0 0 2 2 0 2 0 2 2 3 3 1\nCELLS 2 13\n6 %s\n5 1 "
                            "2 5 4 6\n"
                            "CELL_TYPES 2\n13\n14\n",
                way == 0 ? "0 1 2 3 4 5" : "0 2 1 3 5 4");
        expect_legacy(input, RG_OK,
                      way == 0 ? WEDGE "e 0: 0 1 4 5\ne 0: 0 1 2 5\n" PYRAMID
                               : WEDGE "e 0: 0 1 2 5\ne 0: 0 1 4 5\n" PYRAMID);
    }
    how.split = false;
}

#define N61 "nnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnn"

static void test_legacy_mistakes(void **state) {
    (void)state;
    static const struct {
        const char *words, *said;
    } cases[] = {
        {"", ":1: not a legacy file of VTK: it does not begin with '# vtk DataFile Version'"},
        {"# vtk DataFile Version 3.0\nt\nTEXT\n", ":3: 'TEXT' instead of ASCII or BINARY"},
        {"# vtk DataFile Version 3.0\nt\nASCII\nDATA UNSTRUCTURED_GRID\n", ":4: 'DATA' instead of DATASET"},
        {"# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\n",
         ":4: DATASET POLYDATA: only an UNSTRUCTURED_GRID can be read"},
        {"# vtk DataFile Version 3.0\nt\nASCII\n", ":4: the file ends too early"},
        {HEAD("4.2"), ": POINTS, CELLS or CELL_TYPES are not there"},
        {HEAD("4.2") CELLS TYPES, ": POINTS, CELLS or CELL_TYPES are not there"},
        {HEAD("4.2") POINTS CELLS, ": POINTS, CELLS or CELL_TYPES are not there"},
        {HEAD("4.2") POINTS POINTS, ":9: POINTS come twice"},
        {HEAD("4.2") POINTS CELLS CELLS, ":12: CELLS come twice"},
        {HEAD("4.2") POINTS CELLS TYPES TYPES, ":16: 3 CELL_TYPES of 3 cells"},
        {HEAD("4.2") POINTS CELLS "CELL_TYPES 2\n", ":12: 2 CELL_TYPES of 3 cells"},
        {HEAD("4.2") POINTS TYPES, ":9: 3 CELL_TYPES of 0 cells"},
        {HEAD("4.2") "POINTS -5 double\n", ":5: '-5' is no number of what this file could hold"},
        {HEAD("4.2") "POINTS 5000 double\n", ":5: '5000' is no number of what this file could hold"},
        {HEAD("4.2") "POINTS 1x double\n", ":5: '1x' is no number of what this file could hold"},
        {HEAD("4.2") "POINTS 5 string\n", ":5: values of type 'string' cannot be read"},
        {HEAD("4.2") "POINTS 1 double\n1 2 x\n", ":6: 'x' is not a number"},
        {HEAD("4.2") "POINTS 1 double\n1 2\n", ":7: the file ends too early"},
        {HEAD("4.2") POINTS "CELLS 2 5\n4 0 1 2 3\n", ":10: CELLS end within cell 1"},
        {HEAD("4.2") POINTS "CELLS 1 5\n5 0 1 2 3\n", ":10: CELLS end within cell 0"},
        {HEAD("4.2") POINTS "CELLS 1 5\n-1 0 1 2 3\n", ":10: CELLS end within cell 0"},
        {HEAD("5.1") POINTS "CELLS 2 4\nOFFSETS int\n0 4\nTYPES int\n",
         ":12: 'TYPES' instead of CONNECTIVITY"},
        {HEAD("5.1") POINTS "CELLS 2 4\nOFFSETS int\n0 5\nCONNECTIVITY int\n0 1 2 3\nCELL_TYPES 1\n10\n",
         ": cell 0 of type 10 has not the 4 points that it should have"},
        {HEAD("5.1") POINTS "CELLS 2 4\nOFFSETS int\n-1 3\nCONNECTIVITY int\n0 1 2 3\nCELL_TYPES 1\n10\n",
         ": cell 0 of type 10 has not the 4 points that it should have"},
        {HEAD("5.1") POINTS "CELLS 2 4\nOFFSETS int\n1 5\nCONNECTIVITY int\n0 1 2 3\nCELL_TYPES 1\n10\n",
         ": cell 0 of type 10 has not the 4 points that it should have"},
        {HEAD("4.2") POINTS "CELLS 1 5\n4 0 1 2 5\nCELL_TYPES 1\n10\n",
         ": cell 0 of type 10 has not the 4 points that it should have"},
        {HEAD("4.2") POINTS "CELLS 1 5\n4 0 1 2 -1\nCELL_TYPES 1\n10\n",
         ": cell 0 of type 10 has not the 4 points that it should have"},
        {HEAD("4.2") POINTS "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n10\n",
         ": cell 0 of type 10 has not the 4 points that it should have"},
        {GRID "CELL_DATA 3\nSCALARS r nix\n", ":17: values of type 'nix' cannot be read"},
        {GRID "CELL_DATA 3\nSCALARS " N61 N61 N61 N61 " int\n1 2 3\n",
         ": the name of cell data '" N61 N61 N61 N61 "' is longer than 243 "
         "bytes"},
        {GRID "NIX 3\n", ":16: 'NIX' is not known here"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char said[600];
        snprintf(said, sizeof said, "rhegma: a.vtk%s\n", cases[i].said);
        expect_legacy(cases[i].words, RG_USAGE, said);
    }
    char word[2][600];
    for (int k = 0; k < 2; k++) {
        snprintf(word[k], sizeof word[k], "%s%0*d\n", HEAD("4.2"), 255 + k, 0);
        write_bytes("a.vtk", word[k], strlen(word[k]));
        char found[600];
        assert_int_equal(run_child(read_legacy, found, sizeof found), RG_USAGE);
        assert_int_equal(strcmp(found, "rhegma: a.vtk:5: a word of more than 255 bytes\n") == 0, k);
    }
    unlink("a.vtk");
    expect_said(read_legacy, RG_USAGE, "rhegma: a.vtk: cannot be read: No such file or directory\n");
    expect_legacy(
        GRID "CELL_DATA 3\nSCALARS nnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnn float\n0 0 .5\n",
        RG_OK,
        WARNING "cell data 'nnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnn' are not the numbers of "
                "regions: they name no sets\n" X5
                "e 0: 0 1 2 3, nnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnn.0 at 3\ne 2: 1 2 3 4\n");
}

/* ---- binary ---- */

static const double x[15] = {1, 2, 3, 5, 2, 3.5, 1.5, 7, 3, 1, 2.5, 9, 6, 8, 10};
static const int list[14] = {4, 0, 1, 2, 3, 3, 0, 2, 1, 4, 1, 2, 3, 4}, types[3] = {10, 5, 10},
                 region[3] = {3, 7, -4};
static const int ends[3] = {4, 7, 11}, nodes[11] = {0, 1, 2, 3, 0, 2, 1, 1, 2, 3, 4};

typedef struct {
    unsigned char data[4000];
    size_t size;
} bytes;

static void add(bytes *b, const void *from, size_t size) {
    memcpy(b->data + b->size, from, size);
    b->size += size;
}

static void add_text(bytes *b, const char *text) {
    add(b, text, strlen(text));
}

static void add_number(bytes *b, uint64_t bits, size_t size, bool big) {
    for (size_t i = 0; i < size; i++) {
        b->data[b->size++] = (unsigned char)(bits >> 8 * (big ? size - 1 - i : i));
    }
}

static void add_real(bytes *b, double value, size_t size, bool big) {
    uint64_t bits;
    uint32_t narrow;
    float single = (float)value;
    memcpy(&bits, &value, sizeof bits);
    memcpy(&narrow, &single, sizeof narrow);
    add_number(b, size == 4 ? narrow : bits, size, big);
}

static void add_integers(bytes *b, const int *value, int count, size_t size, bool big) {
    for (int i = 0; i < count; i++) {
        add_number(b, (uint64_t)(int64_t)value[i], size, big);
    }
}

static void test_binary(void **state) {
    (void)state;
    static const struct {
        const char *name;
        size_t size;
    } kinds[] = {{"char", 1}, {"short", 2}, {"int", 4}, {"vtkIdType", 4}, {"long", 8}, {"vtktypeint64", 8}};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        bytes b = {.size = 0};
        bool single = k % 2 == 0;
        char words[100];
        add_text(&b, "# vtk DataFile Version 4.2\nt\nBINARY\nDATASET UNSTRUCTURED_GRID\n");
        add_text(&b, single ? "POINTS 5 float\n" : "POINTS 5 double\n");
        for (int i = 0; i < 15; i++) {
            add_real(&b, x[i], single ? 4 : 8, true);
        }
        add_text(&b, "\nCELLS 3 14\n");
        add_integers(&b, list, 14, 4, true);
        add_text(&b, "\nCELL_TYPES 3\n");
        add_integers(&b, types, 3, 4, true);
        sprintf(words, "\nCELL_DATA 3\nFIELD d 1\nr 1 3 %s\n", kinds[k].name);
        add_text(&b, words);
        size_t before = b.size;
        add_integers(&b, region, 3, kinds[k].size, true);
        add_text(&b, "\n");
        write_bytes("a.vtk", b.data, b.size);
        expect_said(read_legacy, RG_OK, IN_SETS);
        write_bytes("a.vtk", b.data, b.size - 2);
        sprintf(words, "rhegma: a.vtk: at byte %zu: 3 values of type %s are more than there are\n", before,
                kinds[k].name);
        expect_said(read_legacy, RG_USAGE, words);
    }
    /* without a sign the last one is another */
    bytes b = {.size = 0};
    add_text(&b, "# vtk DataFile Version 5.1\nt\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n");
    for (int i = 0; i < 15; i++) {
        add_real(&b, x[i], 8, true);
    }
    add_text(&b, "\nCELLS 4 11\nOFFSETS vtktypeint64\n");
    add_number(&b, 0, 8, true);
    add_integers(&b, ends, 3, 8, true);
    add_text(&b, "\nCONNECTIVITY vtktypeint64\n");
    add_integers(&b, nodes, 11, 8, true);
    add_text(&b, "\nCELL_TYPES 3\n");
    add_integers(&b, types, 3, 4, true);
    add_text(&b, "\nCELL_DATA 3\nCOLOR_SCALARS r 1\n");
    add_integers(&b, region, 3, 1, true);
    add_text(&b, "\nSCALARS s unsigned_short\nLOOKUP_TABLE default\n");
    add_integers(&b, region, 3, 2, true);
    write_bytes("a.vtk", b.data, b.size);
    expect_said(read_legacy, RG_OK,
                X5 "e 0: 0 1 2 3 in r.3 and s.3, r.7 and s.7 at 3\ne 2: 1 2 3 4 in r.252 and s.65532\n");
}

/* ---- XML ---- */

#define VTU(more)                                                                                            \
    "<?xml version='1.0'?>\n<!-- a > remark -->\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\"" more    \
    ">\n<UnstructuredGrid>\n"
#define PIECE                   "<Piece NumberOfPoints=\"5\" NumberOfCells=\"3 \">\n"
#define ARRAY(type, name, more) "<DataArray type=\"" type "\" Name=\"" name "\" " more ">"
#define XML_POINTS                                                                                           \
    "<Points>" ARRAY("Float64", "Points",                                                                    \
                     "NumberOfComponents=\"3\" format=\"ascii\"") "1 2 3 5 2 3.5\n1.5 7 3 1 2.5 9 6 8 "      \
                                                                  "10\n</DataArray></Points>\n"
#define XML_CELLS                                                                                            \
    "<Cells>" ARRAY("Int32", "connectivity", "") "0 1 2 3 0 2 1 1 2 3 4</DataArray>" ARRAY(                  \
        "Int32", "offsets", "") "4 7 11</DataArray>" ARRAY("UInt8", "types",                                 \
                                                           "") "10 5 10</DataArray></Cells>\n"
#define XML_END "</Piece></UnstructuredGrid></VTKFile>\n"
#define REGIONS "<CellData Scalars='r'>" ARRAY("Int32", "r", "") "3 7 -4</DataArray></CellData>"
#define NONE    "<Piece NumberOfPoints='0' NumberOfCells='0'>"
#define PVTU    "<VTKFile type='PUnstructuredGrid'><PUnstructuredGrid>"
#define WARNED  "rhegma: warning: a.vtu: "

static void test_xml(void **state) {
    (void)state;
    expect_xml(VTU("") PIECE XML_POINTS XML_CELLS XML_END, RG_OK, BARE);
    expect_xml(VTU("") PIECE XML_POINTS
               "<Cells>" ARRAY("Int32", "faces", "") "1 2</DataArray></Cells>" XML_CELLS XML_END,
               RG_OK, BARE);
    expect_xml(VTU("") PIECE "<CellData Scalars='r'>" ARRAY("Int32", "r", "") "3 7 -4</DataArray>" ARRAY(
                   "Float64", "v",
                   "NumberOfComponents='3'") "1 2 3 4 5 6 7 8 9</DataArray></CellData>"
                                             "<PointData>" ARRAY(
                                                 "Int32", "p",
                                                 "") "1 2 3 4 5</DataArray></PointData><PointData/>" XML_CELLS
                                                 XML_POINTS XML_END,
               RG_OK, IN_SETS);
    static const struct {
        const char *words, *said;
    } cases[] = {
        {"nothing", "not an XML file of VTK: it has no VTKFile"},
        {"<VTKFile type='PolyData'>", "only an UnstructuredGrid can be read"},
        {"<VTKFile>", "only an UnstructuredGrid can be read"},
        {VTU(" compressor='vtkBestDataCompressor'"), "vtkBestDataCompressor: a compressor that is not known"},
        {VTU("") PIECE XML_POINTS XML_END, "points, connectivity, offsets or types of cells are not there"},
        {VTU("") PIECE XML_POINTS "<Cells>" ARRAY("Int32", "offsets", "") "4 7 11</DataArray>" ARRAY(
             "UInt8", "types", "") "10 5 10</DataArray></Cells>" XML_END,
         "points, connectivity, offsets or types of cells are not there"},
        {VTU("") PIECE XML_CELLS XML_END, "points, connectivity, offsets or types of cells are not there"},
        {VTU("") PIECE PIECE, "points, connectivity, offsets or types of cells are not there"},
        {VTU("") PIECE XML_POINTS XML_CELLS PIECE XML_POINTS XML_END,
         "points, connectivity, offsets or types of cells are not there"},
        {VTU("") PIECE XML_POINTS XML_CELLS REGIONS "</Piece>" PIECE XML_POINTS XML_CELLS XML_END,
         "cell data 'r' are not in all of its pieces"},
        {VTU("") PIECE XML_POINTS XML_CELLS "</Piece>" PIECE XML_POINTS XML_CELLS REGIONS XML_END,
         "cell data 'r' are not in all of its pieces"},
        {PVTU "<Piece/>", "a Piece without a Source"},
        {PVTU "</VTKFile>", "no piece has any cells"},
        {VTU("") PIECE XML_POINTS XML_POINTS, "Points: it comes twice"},
        {VTU("") PIECE XML_CELLS XML_CELLS, "connectivity: it comes twice"},
        {VTU("") "<Piece NumberOfPoints='-5'>", "NumberOfPoints: no number of what this file could hold"},
        {VTU("") "<Piece NumberOfPoints='5x'>", "NumberOfPoints: no number of what this file could hold"},
        {VTU("") "<Piece NumberOfCells='999999999999'>",
         "NumberOfCells: no number of what this file could hold"},
        {VTU("") "<Piece NumberOfPoints='5>", "NumberOfPoints: an attribute without an end"},
        {VTU("") "<Piece NumberOfPoints=5 >", "NumberOfPoints: an attribute without an end"},
        {VTU("") "<Piece NumberOfPoints='4' NumberOfCells='3'>" XML_POINTS,
         "Points: it has not as many values as it should have"},
        {VTU("") PIECE "<Points>" ARRAY("Float64", "x", "") "1 2 y</DataArray>", "Points: what is no number"},
        {VTU("") PIECE "<Points>" ARRAY("Float64", "x", "format='nix'") "1 2",
         "Points: its format is not known"},
        {VTU("") PIECE "<Points>" ARRAY("Float16", "x", "format='binary'") "AAAA",
         "Points: its type is not known"},
        {VTU("") PIECE "<Points>" ARRAY("Float64", "x", "format='appended' offset='0'"),
         "Points: its appended data are not there"},
        {VTU("") PIECE
         "<Points>" ARRAY("Float64", "x", "format='appended' offset='9'") "<AppendedData>_1</AppendedData>",
         "Points: its data are damaged"},
        {VTU("") PIECE
         "<Points>" ARRAY("Float64", "x", "format='appended' offset='999'") "<AppendedData>_1</AppendedData>",
         "Points: its appended data are not there"},
        {VTU(" compressor='vtkZLibDataCompressor'") PIECE
         "<Points>" ARRAY("Float64", "x", "format='binary'") "EAAAAA",
         "Points: its data are damaged"},
        {VTU("") PIECE "<Points>" ARRAY("Float64", "x", "format='binary'") "AA=A",
         "Points: its data are damaged"},
        {VTU("") PIECE "<Points>" ARRAY("Float64", "x", "format='binary'") "CAAAAAAA",
         "Points: its data are damaged"},
        {VTU("") PIECE "<Points>" ARRAY("Float64", "x", "format='binary'") "////f////",
         "Points: its data are damaged"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char said[300];
        snprintf(said, sizeof said, "rhegma: a.vtu: %s\n", cases[i].said);
        expect_xml(cases[i].words, RG_USAGE, said);
    }
    unlink("a.vtu");
    expect_said(read_xml, RG_USAGE, "rhegma: a.vtu: cannot be read: No such file or directory\n");
}

/* Pieces: the points of each are its own; other ranks' cells and hidden ones are none. */
static void test_pieces(void **state) {
    (void)state;
    static const char twice[] = X5 "x 5: 1 2 3\nx 6: 5 2 3.5\nx 7: 1.5 7 3\nx 8: 1 2.5 9\nx 9: 6 8 10\n"
                                   "e 0: 0 1 2 3 in r.3, r.7 at 3\ne 2: 1 2 3 4 in r.-4\n"
                                   "e 3: 5 6 7 8 in r.3, r.7 at 3\ne 5: 6 7 8 9 in r.-4\n";
    expect_xml(VTU("") PIECE XML_POINTS XML_CELLS REGIONS
               "</Piece>" NONE "</Piece>" PIECE REGIONS XML_CELLS XML_POINTS XML_END,
               RG_OK, twice);
    static const char one[] = VTU("") PIECE XML_POINTS XML_CELLS REGIONS XML_END;
    write_bytes("b 1.vtu", one, strlen(one));
    expect_xml(PVTU "<Piece Source='b 1.vtu'/><Piece Source='b 1.vtu'/></PUnstructuredGrid></VTKFile>", RG_OK,
               twice);
    expect_xml(PVTU "<Piece Source='b 1.vtu'/>", RG_OK, IN_SETS);
    char words[200];
    snprintf(words, sizeof words, PVTU "<Piece Source='%s/b 1.vtu'/>", folder);
    expect_xml(words, RG_OK, IN_SETS);
    static const char none[] = VTU("") NONE XML_END;
    write_bytes("none.vtu", none, strlen(none));
    expect_xml(PVTU "<Piece Source='none.vtu'/><Piece Source='b 1.vtu'/>", RG_OK, IN_SETS);
    expect_xml(PVTU "<Piece Source='c.vtu'/>", RG_USAGE,
               "rhegma: c.vtu: cannot be read: No such file or directory\n");
    expect_xml(PVTU "<Piece Source='a.vtu'/>", RG_USAGE,
               "rhegma: a.vtu: only an UnstructuredGrid can be read\n");
    static const char *const ghosts[] = {"0 0 1", "0 0 32", "0 2 33"};
    for (size_t i = 0; i < 3; i++) {
        snprintf(words, sizeof words, "%s", ghosts[i]);
        char text[2000];
        snprintf(text, sizeof text, "%s%s</DataArray></CellData>%s",
                 VTU("") PIECE XML_POINTS XML_CELLS "<CellData>" ARRAY("UInt8", "vtkGhostType", ""), words,
                 XML_END);
        expect_xml(text, RG_OK,
                   "rhegma: warning: a.vtu: 1 nodes belong to no tetrahedron and are left out; the first is "
                   "node 4 at "
                   "(6, 8, 10) m\nx 0: 1 2 3\nx 1: 5 2 3.5\nx 2: 1.5 7 3\nx 3: 1 2.5 9\ne 0: 0 1 2 3\n");
    }
    unlink("b 1.vtu");
    unlink("none.vtu");
}

/* How binary data are stored. */
typedef struct {
    bool big, wide, raw, appended, together; /* together: header and data are one piece of base64 */
    rg_packing packing;
} storage;

static void add_base64(bytes *to, const bytes *from) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < from->size; i += 3) {
        uint32_t bits = 0;
        for (size_t k = 0; k < 3; k++) {
            bits = bits << 8 | (i + k < from->size ? from->data[i + k] : 0);
        }
        for (size_t k = 0; k < 4; k++) {
            to->data[to->size++] =
                (unsigned char)(i + k > from->size ? '=' : digits[bits >> (18 - 6 * k) & 63]);
        }
        if (i % 60 == 57) {
            to->data[to->size++] = '\n';
        }
    }
}

static void add_header(bytes *b, const storage *s, size_t value) {
    add_number(b, value, s->wide ? 8 : 4, s->big);
}

static void add_piece(bytes *to, const storage *s, const bytes *header, const bytes *body) {
    if (s->raw) {
        add(to, header->data, header->size);
        add(to, body->data, body->size);
    } else if (s->together) {
        bytes both = *header;
        add(&both, body->data, body->size);
        add_base64(to, &both);
    } else {
        add_base64(to, header);
        add_base64(to, body);
    }
}

/* LZ4 of bytes as they are. */
static size_t pack(rg_packing p, const unsigned char *from, size_t size, unsigned char *to) {
    if (p == RG_ZLIB) {
        uLongf room = 200;
        assert_int_equal(compress(to, &room, from, size), Z_OK);
        return room;
    }
    to[0] = (unsigned char)((size < 15 ? size : 15) << 4);
    to[1] = (unsigned char)(size - 15);
    memcpy(to + (size < 15 ? 1 : 2), from, size);
    return size + (size < 15 ? 1 : 2);
}

/* Compressed in blocks of 40 bytes. */
static void add_stored(bytes *to, const storage *s, const bytes *data) {
    bytes header = {.size = 0}, body = {.size = 0};
    if (s->packing == RG_PLAIN) {
        add_header(&header, s, data->size);
        add_piece(to, s, &header, data);
        return;
    }
    size_t blocks = (data->size + 39) / 40;
    add_header(&header, s, blocks);
    add_header(&header, s, 40);
    add_header(&header, s, data->size % 40);
    for (size_t i = 0; i < blocks; i++) {
        size_t left = data->size - 40 * i;
        size_t size = pack(s->packing, data->data + 40 * i, left < 40 ? left : 40, body.data + body.size);
        add_header(&header, s, size);
        body.size += size;
    }
    add_piece(to, s, &header, &body);
}

static void add_array(bytes *to, bytes *appended, const storage *s, const char *type, const char *name,
                      const bytes *data) {
    char words[200];
    sprintf(words, "<DataArray type=\"%s\" Name=\"%s\" format=\"%s\" offset=\"%zu\">\n", type, name,
            s->appended ? "appended" : "binary", appended->size);
    add_text(to, words);
    add_stored(s->appended ? appended : to, s, data);
    add_text(to, "\n</DataArray>\n");
}

static void write_stored(const storage *s) {
    bytes b = {.size = 0}, more = {.size = 0}, data = {.size = 0};
    char words[300];
    sprintf(words,
            "<VTKFile type=\"UnstructuredGrid\" byte_order=\"%s\"%s%s><UnstructuredGrid>\n" PIECE "<Points>",
            s->big ? "BigEndian" : "LittleEndian", s->wide ? " header_type=\"UInt64\"" : "",
            s->packing == RG_ZLIB  ? " compressor=\"vtkZLibDataCompressor\""
            : s->packing == RG_LZ4 ? " compressor=\"vtkLZ4DataCompressor\""
                                   : "");
    add_text(&b, words);
    for (int i = 0; i < 15; i++) {
        add_real(&data, x[i], s->wide ? 8 : 4, s->big);
    }
    add_array(&b, &more, s, s->wide ? "Float64" : "Float32", "Points", &data);
    add_text(&b, "</Points><Cells>");
    data.size = 0;
    add_integers(&data, nodes, 11, 8, s->big);
    add_array(&b, &more, s, "Int64", "connectivity", &data);
    data.size = 0;
    add_integers(&data, ends, 3, 2, s->big);
    add_array(&b, &more, s, "UInt16", "offsets", &data);
    data.size = 0;
    add_integers(&data, types, 3, 1, s->big);
    add_array(&b, &more, s, "UInt8", "types", &data);
    add_text(&b, "</Cells><CellData>");
    data.size = 0;
    add_integers(&data, region, 3, 2, s->big);
    add_array(&b, &more, s, "Int16", "r", &data);
    add_text(&b, "</CellData></Piece></UnstructuredGrid>");
    if (s->appended) {
        add_text(&b, s->raw ? "<AppendedData encoding=\"raw\">\n _" : "<AppendedData encoding=\"base64\">_");
        add(&b, more.data, more.size);
        add_text(&b, "</AppendedData>");
    }
    add_text(&b, "</VTKFile>\n");
    write_bytes("a.vtu", b.data, b.size);
}

static void test_stored(void **state) {
    (void)state;
    for (unsigned k = 0; k < 96; k++) {
        storage s = {.big = k & 1,
                     .wide = k >> 1 & 1,
                     .raw = k >> 2 & 1,
                     .appended = k >> 3 & 1,
                     .together = k >> 4 & 1,
                     .packing = k >> 5};
        if ((s.raw && !s.appended) || (s.together && (s.raw || s.packing != RG_PLAIN))) {
            continue;
        }
        write_stored(&s);
        expect_said(read_xml, RG_OK, IN_SETS);
    }
}

static int set_up(void **state) {
    (void)state;
    return mkdtemp(folder) == NULL || chdir(folder) != 0;
}

static int tear_down(void **state) {
    (void)state;
    unlink("a.vtk");
    unlink("a.vtu");
    return chdir("/") != 0 || rmdir(folder) != 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_legacy), cmocka_unit_test(test_regions),         cmocka_unit_test(test_cells),
        cmocka_unit_test(test_split),  cmocka_unit_test(test_legacy_mistakes), cmocka_unit_test(test_binary),
        cmocka_unit_test(test_xml),    cmocka_unit_test(test_stored),          cmocka_unit_test(test_pieces),
    };
    int failed = cmocka_run_group_tests_name("vtk", tests, set_up, tear_down);
    return failed + (rg_alloc_blocks() > 0); /* all is given back */
}
