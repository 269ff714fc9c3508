/* Abaqus input: lines, keywords, element types and every mistake that the reader knows. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <cmocka.h>

#include "support/inp_text.h"

static void test_elements(void **state) {
    (void)state;
    expect(NODES SOLIDS ONE TWO, X5 "e 1: 0 1 2 3\ne 2: 1 2 3 4\n");
    scale = 0.5;
    expect(NODES SOLIDS TWO, WARNING
           ": 1 nodes belong to no tetrahedron and are left out; the first is node 10 at (0.5, 1, 1.5) m\n"
           "x 0: 2.5 1 1.75\nx 1: 0.75 3.5 1.5\nx 2: 0.5 1.25 4.5\nx 3: 3 4 5\ne 2: 0 1 2 3\n");
    scale = 1;
    /* Vertices go by the numbers, elements by the lines; corners ascend; a number given twice has the last
     * place. */
    expect("*NODE\n50, 6, 8, 10\n40, 1, 2.5, 9\n30, 1.5, 7, 3\n10, 8, 8, 8\n20, 5, 2, 3.5\n10, 1, 2, 3\n"
           "*ELEMENT, TYPE=C3D4\n2, 50, 20, 30, 40\n1, 20, 10, 30, 40\n",
           WARNING
           ": 1 nodes are given again at another place, which is the one that counts\n" WARNING
           ": 2 of 2 elements have their corners in the order of a negative volume, the first of them "
           "2: they are taken as if they had not\n" X5 "e 2: 1 2 3 4\ne 1: 0 1 2 3\n");
    expect(NODES "*NODE\n10, 1, 2, 3\n" SOLIDS ONE TWO, X5 "e 1: 0 1 2 3\ne 2: 1 2 3 4\n");
}

/* Blanks, tabs, comments, lines of Windows, of old Macintoshes and of no end, the mark of UTF-8, letters of
 * Latin-1, elements over several lines, keyword lines that go on. */
static void test_lines(void **state) {
    (void)state;
    expect("\xef\xbb\xbf*Node , nset = N\r\n 10 ,\t1 , 2, 3e0 \r\n\r\n \t\r\n20,5.,2.,3.5, 7\n** 30, 0, 0, "
           "0\n30, "
           "15e-1, 7, 3\n40, 1, 2.5, 9\n*Element ,type= C3D4\n 1, 10,\n20, 30,\n\t40\n*END STEP\n7, 7, 7, x",
           X "e 1: 0 1 2 3, N at 0, N at 1, N at 2, N at 3\n");
    static const char *const same[] = {
        "\xef\xbb\xbf" NODES SOLIDS ONE TWO,
        "*HEADING\n1, 2, x\n*NODE OUTPUT\n1, x\n" NODES SOLIDS ONE TWO,
        "** gr\xf6\xdf\x65\n  ** 1\n \t*NODE\r10, 1, 2, 3\r20, 5, 2, 3.5\r30, 1.5, 7, 3\r40, 1, 2.5, 9\r50, "
        "6, 8, 10\r"
        "*ELEMENT, TYPE=C3D4\r" ONE TWO,
        NODES " * E l e m e n t ,\t t y p e = c 3 d 4 ,\n" ONE TWO,
        NODES "*ELEMENT, TYP=C3D4, OFF=7\n1, 10, 20, 30, 40,\n2, 20, 30, 40, 50,\n",
        "*NODE,\n10, 1., 2, .3D1\n20, 5d0, +2.0E+0, 0.35D+01\n30, 1.5, 7, 3,\n40, 10.D-1, 2.5, 9, 0, 0, "
        "1\n50, 6, 8, 10"
        ",,,\n" SOLIDS ONE TWO,
        SOLIDS ONE TWO NODES,
        "*STEP\n*ELEMENT, TYPE=Q\n1\n*NIX\n*END STEP\n" NODES SOLIDS ONE TWO "*STEP\n*NODE\nx\n*SURFACE\n",
        "*BOUNDARY, INPUT=nowhere\n" NODES SOLIDS ONE TWO,
    };
    for (size_t i = 0; i < sizeof same / sizeof *same; i++) {
        expect(same[i], X5 "e 1: 0 1 2 3\ne 2: 1 2 3 4\n");
    }
    expect(NODES "*ELEMENT,\n** between\n  TYPE = C3D4\t, \n ELSET=\"a, *b =  C\"\n" ONE TWO,
           X5 "e 1: 0 1 2 3 in a, *b =  C\ne 2: 1 2 3 4 in a, *b =  C\n");
    /* coordinates that are left out are 0 */
    expect("*NODE\n1\n2, 1\n3, , 2\n4, 0, , 3\n" SOLIDS "1, 1, 2, 3, 4\n",
           "x 0: 0 0 0\nx 1: 1 0 0\nx 2: 0 2 0\nx 3: 0 0 3\ne 1: 0 1 2 3\n");
}

/* Files that others include, from their own folders. */
static void write_file(const char *path, const char *words) {
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(words, 1, strlen(words), f), strlen(words));
    assert_int_equal(fclose(f), 0);
}

static void test_includes(void **state) {
    (void)state;
    static const char *const paths[] = {"sub/nodes.inc", "sub/more.inc", "solids.inc", "loop.inc"};
    assert_int_equal(mkdir("sub", 0777), 0);
    write_file(paths[0], "10, 1, 2, 3\n20, 5, 2, 3.5\n*INCLUDE, INPUT=more.inc\n50, 6, 8, 10\n");
    write_file(paths[1], "30, 1.5, 7, 3\n40, 1, 2.5, 9\n");
    write_file(paths[2], ONE TWO);
    write_file(paths[3], "*INCLUDE, INPUT=loop.inc\n");
    expect("*NODE, INPUT=sub/nodes.inc\n*Element, input = solids.inc , type=C3D4\n",
           X5 "e 1: 0 1 2 3\ne 2: 1 2 3 4\n");
    expect("*NODE\n10, 1, 2, 3\n20, 5, 2, 3.5\n*INCLUDE, INPUT=\"sub/more.inc\"\n50, 6, 8, 10\n" SOLIDS
           "*include,\ninput=solids.inc\n*SURFACE, NAME=s\n1, S1\n",
           X5 "e 1: 0 1 2 3, s at 3\ne 2: 1 2 3 4\n");
    write_file(paths[1], "30, 1.5, 7, y\n");
    expect_said_from("*NODE, INPUT=sub/nodes.inc\n", "rhegma: sub/more.inc:1: 'y' is not a coordinate\n");
    expect_refused("*INCLUDE, INPUT=nowhere\n",
                   ":1: *INCLUDE: nowhere cannot be read: No such file or directory");
    expect_refused("*NODE, INPUT=nowhere\n", ":1: *NODE: nowhere cannot be read: No such file or directory");
    expect_refused("*INCLUDE\n", ":1: *INCLUDE: INPUT must name a file");
    expect_refused("*INCLUDE, INPUT=\n", ":1: *INCLUDE: INPUT must name a file");
    expect_said_from(
        "*INCLUDE, INPUT=loop.inc\n",
        "rhegma: loop.inc:1: *INCLUDE: INPUT=loop.inc: more than 5 files include each other, or more than "
        "4096 in all\n");
    for (int i = 0; i < 4; i++) {
        unlink(paths[i]);
    }
    rmdir("sub");
}

static void test_line_mistakes(void **state) {
    (void)state;
    static const struct {
        const char *words, *said;
    } cases[] = {
        {"*NODE\n10, 1, 2, 3x\n", ":2: '3x' is not a coordinate"},
        {"*NODE\n10, y, 2, 3\n", ":2: 'y' is not a coordinate"},
        {"*NODE\n10, 1e999, 2, 3\n", ":2: '1e999' is not a coordinate"},
        {"*NODE\n10, 1-2, 2, 3\n", ":2: '1-2' is not a coordinate"},
        {"*NODE\n10, nan, 2, 3\n", ":2: 'nan' is not a coordinate"},
        {"*NODE\n10, 0x1, 2, 3\n", ":2: '0x1' is not a coordinate"},
        {"*NODE\n10, -, 2, 3\n", ":2: '-' is not a coordinate"},
        {"*NODE\n0, 1, 2, 3\n", ":2: '0' is not the number of a node or element"},
        {"*NODE\n-1, 1, 2, 3\n", ":2: '-1' is not the number of a node or element"},
        {"*NODE\n1.5, 1, 2, 3\n", ":2: '1.5' is not the number of a node or element"},
        {"*NODE\n4000000001, 1, 2, 3\n", ":2: '4000000001' is not the number of a node or element"},
        {"*NODE\n99999999999999999999, 1, 2, 3\n",
         ":2: '99999999999999999999' is not the number of a node or element"},
        {"*NODE\n, 1, 2, 3\n", ":2: '' is not the number of a node or element"},
        {"*NODE, SYSTEM=Q\n", ":1: *NODE, SYSTEM=Q: R, C or S is expected"},
        {"*NODE, SYSTEM\n", ":1: *NODE, SYSTEM=: R, C or S is expected"},
        {NODES "*ELEMENT, TYPE=C3D4\n1, 10, , 30, 40\n", ":8: '' is not the number of a node or element"},
        {NODES "*ELEMENT\n" ONE, ":7: *ELEMENT without TYPE"},
        {NODES "*ELEMENT, TYPE\n" ONE, ":7: *ELEMENT without TYPE"},
        {NODES "*ELEMENT, TYPEX=C3D4\n" ONE, ":7: *ELEMENT has no parameter 'TYPEX' that is known here"},
        {NODES "*ELEMENT, =C3D4\n" ONE, ":7: *ELEMENT has no parameter '' that is known here"},
        {NODES "*NSET, IN=a\n",
         ":7: *NSET has no parameter 'IN' that is known here"}, /* INPUT, INSTANCE, ... */
        {NODES SOLIDS "1, 10, 20, 30\n*ELEMENT, TYPE=C3D4\n", ":9: element 1 has 3 of 4 nodes"},
        {NODES SOLIDS "1\n*NODE\n", ":9: element 1 has 0 of 4 nodes"},
        {NODES SOLIDS ONE "2\n", ":10: element 2 has 0 of 4 nodes"},
        {NODES SOLIDS ONE ONE, ":9: element 1 is defined twice"},
        {NODES SOLIDS ONE TWO TWO, ":10: element 2 is defined twice"},
        {NODES SOLIDS "1, 10, 20, 30, 60\n", ": element 1 has node 60, which is not there"},
        {NODES, ": no tetrahedra"},
        {"1, 2, 3\n*NODE\n", ":1: data before the first keyword"},
        {"*ELEM, TYPE=C3D4\n",
         ":1: *ELEM is not a keyword that is known here, and might change the mesh: without it, "
         "the mesh could be another one"},
        {"*NCOPY, OLD SET=a\n",
         ":1: *NCOPY is not a keyword that is known here, and might change the mesh: without "
         "it, the mesh could be another one"},
        {"*ELSET\n1\n", ":1: *ELSET without ELSET"},
        {"*NSET\n1\n", ":1: *NSET without NSET"},
        {NODES SOLIDS ONE "*ELSET, ELSET=a\nb\n", ":10: no set of elements 'b'"},
        {NODES SOLIDS ONE "*NSET, NSET=a\n10, b\n", ":10: no set of nodes 'b'"},
        {NODES SOLIDS ONE "*NSET, NSET=a, ELSET=b\n", ":9: no set of elements 'b'"},
        {"*ELSET, ELSET=a, GENERATE\n1, x\n", ":2: 'x' is not the number of a node or element"},
        {"*ELSET, ELSET=a, GENERATE\n1, 5, 0\n", ":2: '0' is not the number of a node or element"},
        {"*ELSET, ELSET=a, GENERATE\n5, 1\n", ":2: GENERATE from 5 to 1, which is less"},
        {"*SURFACE, TYPE=ELEMENT\n", ":1: *SURFACE without NAME"},
        {"*SURFACE, NAME=s, COMBINE=UNION\n", ":1: *SURFACE has no parameter 'COMBINE' that is known here"},
        {"*SURFACE, NAME=s\n1, S7\n", ":2: *SURFACE: 'element or set, S1 to S6' is expected"},
        {"*SURFACE, NAME=s\n, S1\n", ":2: *SURFACE: 'element or set, S1 to S6' is expected"},
        {"*PART, NAME=a\n*PART, NAME=A\n", ":2: *PART, NAME=A is there already, in line 1"},
        {"*PART, NAME=a\n1\n", ":2: *PART has no data lines"},
        {"*INSTANCE, NAME=i, PART=a\n", ":1: there is no *PART, NAME=a so far"},
        {"*PART, NAME=a\n*INSTANCE, NAME=i, PART=A\n*INSTANCE, NAME=I, PART=a\n",
         ":3: a second *INSTANCE, NAME=I"},
        {"*PART, NAME=a\n*INSTANCE, NAME=i, PART=a\n0, 0, 1, 90\n",
         ":3: *INSTANCE: 3 numbers in the first data line, 7 in the second, no third one"},
        {"*PART, NAME=a\n*INSTANCE, NAME=i, PART=a\n0, 0, 1\n0, 0, 0, 0, 0, 1, 90, 1\n",
         ":4: *INSTANCE: 3 numbers in the first data line, 7 in the second, no third one"},
        {"*PART, NAME=a\n*INSTANCE, NAME=i, PART=a\n0, 0, 1\n0, 0, 0, 0, 0, 1, 90\n1\n",
         ":5: *INSTANCE: 3 numbers in the first data line, 7 in the second, no third one"},
        {"*PART, NAME=a\n*INSTANCE, NAME=i, PART=a\n0, 0, 1\n1, 2, 3, 1, 2, 3, 90\n",
         ":4: the axis of the rotation of *INSTANCE has no length"},
        {"*PART, NAME=a\n*INSTANCE, NAME=i, PART=a\n*END INSTANCE\n*ELSET, ELSET=e, INSTANCE=j\n",
         ":4: there is no *INSTANCE, NAME=j so far"},
        {"*PART, NAME=a\n" NODES SOLIDS ONE "*PART, NAME=b\n" NODES SOLIDS ONE "*END PART\n",
         ":1: no *INSTANCE places *PART, NAME=a, which has 1 elements"},
        {"*ASSEMBLY, NAME=a\n" SOLIDS ONE,
         ":2: *ELEMENT, TYPE=C3D4 in the assembly, outside of its instances"},
        {"*SYSTEM\n0, 0, 0, 1, 0, 0, 1\n",
         ":2: *SYSTEM: two points in the first line, one in the second, no third line"},
        {"*SYSTEM\n0, 0, 0, 1, 0, 0\n0, 1, 0, 0\n",
         ":3: *SYSTEM: two points in the first line, one in the second, no third line"},
        {"*SYSTEM\n0, 0, 0, 1, 0, 0\n0, 1, 0\n0, 0, 1\n",
         ":4: *SYSTEM: two points in the first line, one in the second, no third line"},
        {"*SYSTEM\n0, 0, 0, 1, 0, 0\n2, 0, 0\n", ":3: the three points of *SYSTEM are on a line"},
        {"*SYSTEM\n0, 0, 0, 0, 0, 2\n*HEADING\n",
         ":3: the axis of *SYSTEM stands across the x-y plane, which takes a second line"},
        {NODES SOLIDS ONE "*SURFACE, NAME=s\n2, S1\n", ":10: *SURFACE, NAME=s: there is no element 2"},
        {NODES SOLIDS ONE "*SURFACE, NAME=s, TYPE=NODE\n2\n", ":10: *SURFACE, NAME=s: there is no node 2"},
        {NODES SOLIDS ONE "*SURFACE, NAME=s\n1, SPOS\n", ":10: *SURFACE, NAME=s: element 1 has no such face"},
        {NODES SOLIDS ONE "*SURFACE, NAME=s\n1, S5\n", ":10: *SURFACE, NAME=s: element 1 has no such face"},
        {NODES SOLIDS ONE "*ELEMENT, TYPE=S3\n2, 10, 20, 30\n*SURFACE, NAME=s\n2, S4\n",
         ":12: *SURFACE, NAME=s: element 2 has no such face"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        expect_refused(cases[i].words, cases[i].said);
    }
    expect_refused("", ": no tetrahedra");
    remove("a.inp");
    expect_said(read_and_print, RG_USAGE, "rhegma: a.inp: cannot be read: No such file or directory\n");
}

static void test_largest_number(void **state) {
    (void)state;
    expect("*NODE\n4000000000, 1, 2, 3\n20, 5, 2, 3.5\n30, 1.5, 7, 3\n40, 1, 2.5, 9\n" SOLIDS
           "4000000000, 4000000000, 20, 30, 40\n",
           "x 0: 5 2 3.5\nx 1: 1.5 7 3\nx 2: 1 2.5 9\nx 3: 1 2 3\ne 4000000000: 0 1 2 3\n");
}

/* Of each type a name, with the nodes that its data line has; 0: none of our business, so that the line,
 * which is no element, is passed by; -1: refused. */
static void test_types(void **state) {
    (void)state;
    static const struct {
        const char *name;
        int nodes;
    } known[] = {
        {"C3D4", 4},    {"C3D4H", 4},   {"c3d4", 4},     {"C3D10", 10},  {"C3D10MH", 10}, {"C3D10HS", 10},
        {"C3D10T", 10}, {"DC3D4", 4},   {"DC3D10E", 10}, {"AC3D4", 4},   {"AC3D10", 10},  {"FC3D4", 4},
        {"EMC3D4", 4},  {"Q3D4", 4},    {"Q3D10MH", 10}, {"S3", 3},      {"S3R", 3},      {"STRI3", 3},
        {"STRI65", 6},  {"S6", 6},      {"CPS3", 3},     {"CPS6M", 6},   {"CPE3", 3},     {"CPE6", 6},
        {"CPEG3", 3},   {"CPEG6", 6},   {"M3D3", 3},     {"M3D6", 6},    {"SFM3D3", 3},   {"SFM3D6", 6},
        {"R3D3", 3},    {"DS3", 3},     {"DS6", 6},      {"DC2D3", 3},   {"DC2D6", 6},    {"S30", 0},
        {"S4R", 0},     {"B31", 0},     {"M3D4", 0},     {"SFM3D4R", 0}, {"R3D4", 0},     {"T3D2", 0},
        {"CONN3D2", 0}, {"MASS", 0},    {"C3D8", -1},    {"C3D40", -1},  {"C3D6", -1},    {"F3D4", -1},
        {"DCC3D8", -1}, {"COH3D6", -1}, {"EC3D8R", -1},  {"CIN3D8", -1}, {"GK3D6", -1},   {"SC8R", -1},
        {"sc6r", -1},   {"CSS8", -1},   {"CCL12", -1}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        char words[1000] = "", said[1000] = "";
        sprintf(words,
                NODES
                "60, 3, 2, 3.25\n70, 3.25, 4.5, 3.25\n80, 1.25, 4.5, 3\n90, 1, 2.25, 6\n100, 3, 2.25, 6.25\n"
                "110, 1.25, 4.75, 6\n*ELEMENT, TYPE=%s, ELSET=t\n%s\n*ELEMENT, TYPE=C3D4, ELSET=u\n" TWO,
                known[i].name,
                known[i].nodes == 0 || known[i].nodes == -1 ? "1, 2, 3, 4,\n5, 6,\n7\n3, 8"
                : known[i].nodes == 3                       ? "1, 20, 40, 30"
                : known[i].nodes == 4                       ? "1, 10, 20, 30, 40"
                : known[i].nodes == 6                       ? "1, 20, 40, 30, 7, 8, 9"
                                                            : "1, 10, 20, 30, 40, 60, 70, 80, 90, 100, 110");
        if (known[i].nodes < 0) {
            snprintf(
                said, sizeof said,
                ":13: *ELEMENT, TYPE=%s: only tetrahedra are possible (C3D4, C3D10 and their kin), but there "
                "are other solids: 2 %s; --split cuts hexahedra, wedges and pyramids",
                known[i].name, known[i].name);
            expect_refused(words, said);
        } else if (known[i].nodes == 4) {
            expect(words,
                   WARNING ": 6 nodes belong to no tetrahedron and are left out; the first is node 60 at "
                           "(3, 2, 3.25) m\n" X5 "e 1: 0 1 2 3 in t\ne 2: 1 2 3 4 in u\n");
        } else if (known[i].nodes == 10) {
            expect(words, X5 "e 1: 0 1 2 3 in t\ne 2: 1 2 3 4 in u\n");
        } else { /* a triangle is a face in a set */
            char left_out[100] = "";
            if (known[i].nodes == 0) {
                sprintf(left_out, WARNING ": elements that are no solids are left out: 2 %s\n",
                        known[i].name);
            }
            snprintf(said, sizeof said,
                     "%s" WARNING
                     ": 7 nodes belong to no tetrahedron and are left out; the first is node 10 at (1, 2, 3) "
                     "m\nx 0: 5 2 3.5\nx 1: 1.5 7 3\nx 2: 1 2.5 9\nx 3: 6 8 10\ne 2: 0 1 2 3 in u%s\n",
                     left_out, known[i].nodes > 0 ? ", t at 3" : "");
            expect(words, said);
        }
    }
}

/* Node by node of a second-order element, that the middle of each edge is looked at. Its last two are those
 * of nodes 2 4 and 3 4, in Abaqus's order. */
static void test_middles(void **state) {
    (void)state;
    static const int ends[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
    static const double x[4][3] = {{1, 2, 3}, {5, 2, 3.5}, {1.5, 7, 3}, {1, 2.5, 9}};
    for (int moved = 0; moved < 6; moved++) {
        char words[1000] = NODES, said[400];
        for (int k = 0; k < 6; k++) {
            const double *a = x[ends[k][0]], *b = x[ends[k][1]];
            sprintf(words + strlen(words), "%d, %.17g, %.17g, %.17g\n", 100 + k, (a[0] + b[0]) / 2,
                    (a[1] + b[1]) / 2, (a[2] + b[2]) / 2 + (k == moved ? 0.5 : 0));
        }
        double square = 0;
        for (int i = 0; i < 3; i++) {
            double d = x[ends[moved][1]][i] - x[ends[moved][0]][i];
            square += d * d;
        }
        strcat(words, "*ELEMENT, TYPE=C3D10\n1, 10, 20, 30, 40, 100, 101, 102, 103, 104, 105\n");
        snprintf(said, sizeof said,
                 WARNING
                 ": second-order elements are taken by their corners: 1 of 6 mid-nodes are off straight by "
                 "more than 1e-06 of their edge, by %.2g at most\n" X "e 1: 0 1 2 3\n",
                 0.5 / __builtin_sqrt(square));
        expect(words, said);
    }
}

/* What is left aside is counted. */
static void test_report(void **state) {
    (void)state;
    write_input("*HEADING\n a\n" NODES SOLIDS ONE TWO
                "*Solid  Section, ELSET=a\n1.\n*STEP\n*STATIC\n*NSET, NSET=n\n"
                "10, 20, 30\n*BOUNDARY\nn, 1\n*BOUNDARY\nn, 2\n*END STEP\n*BOUNDARY\n1, 2\n");
    expect_said(
        read_and_report, RG_OK,
        "a.inp: 8 keywords skipped, which say nothing of the mesh: 1 *HEADING, 1 *SOLIDSECTION, 1 *STEP, "
        "1 *STATIC, 3 *BOUNDARY, 1 *ENDSTEP\n");
    write_input(NODES SOLIDS ONE TWO);
    expect_said(read_and_report, RG_OK, "a.inp: 0 keywords skipped, which say nothing of the mesh\n");
    expect(NODES SOLIDS ONE TWO
           "*ELEMENT, TYPE=B31\n7, 1, 2\n8, 2, 3\n*ELEMENT, TYPE=MASS\n9, 1\n*ELEMENT, TYPE=b31\n"
           "10, 2, 3\n*ELEMENT, TYPE=T3D2\n",
           WARNING ": elements that are no solids are left out: 3 B31, 1 MASS\n" X5
                   "e 1: 0 1 2 3\ne 2: 1 2 3 4\n");
    expect_refused(
        NODES SOLIDS ONE TWO
        "*ELEMENT, TYPE=B31\n7, 1, 2\n*ELEMENT, TYPE=C3D8\n*ELEMENT, TYPE=C3D6\n8, 1, 2, "
        "3, 4, 5, 6\n*ELEMENT, TYPE=C3D20\n9, 1,\n2\n10, 3\n",
        ":13: *ELEMENT, TYPE=C3D6: only tetrahedra are possible (C3D4, C3D10 and their kin), but there are "
        "other solids: 1 C3D6, 2 C3D20; --split cuts hexahedra, wedges and pyramids");
}

/* A name of 255 bytes is a name, one of 256 is too long; of sets there may be any number. */
static void test_limits(void **state) {
    (void)state;
    char name[258], words[1000], said[400];
    memset(name, 'n', 257);
    for (int length = 255; length <= 256; length++) {
        name[length] = '\0';
        snprintf(words, sizeof words,
                 NODES "*ELEMENT, TYPE=C3D4, ELSET=%s\n" ONE TWO "*SURFACE, NAME=a\n%s, S1\n", name, name);
        if (length == 255) {
            write_input(words);
            static char found[4000];
            assert_int_equal(run_child(read_and_print, found, sizeof found), RG_OK);
            assert_non_null(strstr(found, "a at 3"));
        } else {
            snprintf(said, sizeof said, ":7: '%s' is longer than 255 bytes", name);
            expect_refused(words, said);
        }
        name[length] = 'n';
    }
    /* also the type of an element that is left out */
    memset(name, 'n', 255);
    name[255] = '\0';
    snprintf(words, sizeof words, NODES SOLIDS ONE TWO "*ELEMENT, TYPE=%s\n3, 10\n", name);
    write_input(words);
    static char left[4000];
    assert_int_equal(run_child(read_and_print, left, sizeof left), RG_OK);
    snprintf(said, sizeof said, ": elements that are no solids are left out: 1 %s\n", name);
    assert_non_null(strstr(left, said));
    static char many[1 << 16];
    char *to = many + sprintf(many, NODES SOLIDS ONE TWO);
    for (int s = 0; s < 1000; s++) {
        to += sprintf(to, "*ELSET, ELSET=n%d\n1\n*SURFACE, NAME=s%d\n2, S2\n", s, s);
    }
    write_input(many);
    FILE *nowhere = fopen("/dev/null", "w");
    rg_mesh *mesh = rg_inp_read("a.inp", NULL, &(rg_import_how){.scale = 1}, nowhere);
    fclose(nowhere);
    assert_int_equal(mesh->surface.count, 1000);
    assert_int_equal(mesh->volume.count, 1000);
    for (int32_t s = 0; s < 1000; s++) {
        assert_true(rg_sets_hold(&mesh->volume, mesh->region[0], s));
        assert_false(rg_sets_hold(&mesh->volume, mesh->region[1], s));
        assert_true(rg_sets_hold(&mesh->surface, mesh->set[6], s));
    }
    rg_mesh_free(mesh);
}

/* More nodes, elements, triangles and members than anything has room for at first. */
static void test_many(void **state) {
    (void)state;
    enum { MANY = 300 };
    static char words[1 << 16], said[1 << 16];
    char *at = words, *to = said;
    at += sprintf(at, "*NODE\n");
    for (int i = 0; i < 4 * MANY; i++) {
        int tet = i / 4, corner = i % 4;
        int x[3] = {3 * tet + (corner == 1), corner == 2, corner == 3};
        at += sprintf(at, "%d, %d, %d, %d\n", i + 1, x[0], x[1], x[2]);
        to += sprintf(to, "x %d: %d %d %d\n", i, x[0], x[1], x[2]);
    }
    at += sprintf(at, "*ELEMENT, TYPE=C3D4\n");
    for (int e = 0; e < MANY; e++) {
        at += sprintf(at, "%d, %d, %d, %d, %d\n", e + 1, 4 * e + 1, 4 * e + 2, 4 * e + 3, 4 * e + 4);
        to += sprintf(to, "e %d: %d %d %d %d in all, flat at 3\n", e + 1, 4 * e, 4 * e + 1, 4 * e + 2,
                      4 * e + 3);
    }
    at += sprintf(at, "*ELEMENT, TYPE=S3, ELSET=flat\n");
    for (int e = 0; e < MANY; e++) {
        at += sprintf(at, "%d, %d, %d, %d\n", MANY + e + 1, 4 * e + 1, 4 * e + 2, 4 * e + 3);
    }
    sprintf(at, "*ELSET, ELSET=all, GENERATE\n1, %d\n", MANY);
    expect(words, said);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_elements),       cmocka_unit_test(test_lines),
        cmocka_unit_test(test_includes),       cmocka_unit_test(test_line_mistakes),
        cmocka_unit_test(test_largest_number), cmocka_unit_test(test_types),
        cmocka_unit_test(test_middles),        cmocka_unit_test(test_report),
        cmocka_unit_test(test_limits),         cmocka_unit_test(test_many),
    };
    return cmocka_run_group_tests_name("inp", tests, set_up, tear_down);
}
