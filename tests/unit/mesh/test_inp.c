/* Abaqus input: every keyword, set and mistake that the reader knows. */
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
#include "mesh/import/inp_read.h"
#include "support/mesh_text.h"

static double scale;

static void read_and_print(void) {
    rg_mesh *m = rg_inp_read("a.inp", scale);
    print_mesh(m, stderr);
}

static void write_input(const char *words) {
    FILE *f = fopen("a.inp", "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(words, 1, strlen(words), f), strlen(words));
    assert_int_equal(fclose(f), 0);
}

static void expect(const char *words, const char *said) {
    write_input(words);
    expect_said(read_and_print, RG_OK, said);
}

/* Refused with "rhegma: a.inp" and the rest. */
static void expect_refused(const char *words, const char *rest) {
    char line[600];
    write_input(words);
    snprintf(line, sizeof line, "rhegma: a.inp%s\n", rest);
    expect_said(read_and_print, RG_USAGE, line);
}

/* Two tetrahedra on either side of nodes 20 30 40, which differ in every coordinate, with their lines 1 to 8.
 */
#define NODES   "*NODE\n10, 1, 2, 3\n20, 5, 2, 3.5\n30, 1.5, 7, 3\n40, 1, 2.5, 9\n50, 6, 8, 10\n"
#define SOLIDS  "*ELEMENT, TYPE=C3D4\n"
#define ONE     "1, 10, 20, 30, 40\n"
#define TWO     "2, 20, 30, 40, 50\n"
#define X       "x 0: 1 2 3\nx 1: 5 2 3.5\nx 2: 1.5 7 3\nx 3: 1 2.5 9\n"
#define X5      X "x 4: 6 8 10\n"
#define WARNING "rhegma: warning: a.inp"
#define LEFT_50 ": 1 nodes belong to no tetrahedron and are left out; the first is node 50 at (6, 8, 10) m\n"

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
           ": 2 of 2 elements have their corners in the order of a negative volume, the first of them "
           "2: they are taken as if they had not\n" X5 "e 2: 1 2 3 4\ne 1: 0 1 2 3\n");
}

/* Blanks, tabs, comments, lines of Windows and of no end, the mark of UTF-8, elements over several lines. */
static void test_lines(void **state) {
    (void)state;
    expect("\xef\xbb\xbf*Node , nset = N\r\n 10 ,\t1 , 2, 3e0 \r\n\r\n \t\r\n20,5.,2.,3.5, 7\n** 30, 0, 0, "
           "0\n30, "
           "15e-1, 7, 3\n40, 1, 2.5, 9\n*Element ,type= C3D4\n 1, 10,\n20, 30,\n\t40\n*ENDING\n7, 7, 7, x",
           X "e 1: 0 1 2 3\n");
    expect("\xef\xbb\xbf" NODES SOLIDS ONE TWO, X5 "e 1: 0 1 2 3\ne 2: 1 2 3 4\n");
    expect("*HEADING\n1, 2, x\n*NODE OUTPUT\n1, x\n*NSET, NSET=a\n1, x\n" NODES
           "*ELEMENT, TYPE=B31\n9, x\n" SOLIDS ONE TWO,
           X5 "e 1: 0 1 2 3\ne 2: 1 2 3 4\n");
}

static void test_line_mistakes(void **state) {
    (void)state;
    static const struct {
        const char *words, *said;
    } cases[] = {
        {"*NODE\n10, 1, 2\n", ":2: node 10 needs three coordinates"},
        {"*NODE\n10, 1, 2,\n", ":2: node 10 needs three coordinates"},
        {"*NODE\n10, 1, 2, 3x\n", ":2: node 10 needs three coordinates"},
        {"*NODE\n10, y, 2, 3\n", ":2: node 10 needs three coordinates"},
        {"*NODE\n0, 1, 2, 3\n", ":2: '0' is not the number of a node or element"},
        {"*NODE\n-1, 1, 2, 3\n", ":2: '-1' is not the number of a node or element"},
        {"*NODE\n1.5, 1, 2, 3\n", ":2: '1.5' is not the number of a node or element"},
        {"*NODE\n4000000001, 1, 2, 3\n", ":2: '4000000001' is not the number of a node or element"},
        {"*NODE\n99999999999999999999, 1, 2, 3\n",
         ":2: '99999999999999999999' is not the number of a node or element"},
        {"*NODE\n, 1, 2, 3\n", ":2: '' is not the number of a node or element"},
        {NODES "*ELEMENT, TYPE=C3D4\n1, 10, , 30, 40\n", ":8: '' is not the number of a node or element"},
        {NODES "*ELEMENT\n" ONE, ":7: *ELEMENT without TYPE"},
        {NODES "*ELEMENT, TYPEX=C3D4\n" ONE, ":7: *ELEMENT without TYPE"},
        {NODES "*ELEMENT, TYP=C3D4\n" ONE, ":7: *ELEMENT without TYPE"},
        {NODES SOLIDS "1, 10, 20, 30\n*ELEMENT, TYPE=C3D4\n", ":9: element 1 has 3 of 4 nodes"},
        {NODES SOLIDS "1\n*NODE\n", ":9: element 1 has 0 of 4 nodes"},
        {NODES SOLIDS ONE "2\n", ":9: the file ends within an element, or cannot be read"},
        {NODES SOLIDS ONE ONE, ": element 1 is defined twice"},
        {NODES SOLIDS ONE TWO TWO, ": element 2 is defined twice"},
        {NODES SOLIDS "1, 10, 20, 30, 60\n", ": element 1 has node 60, which is not there"},
        {NODES, ": no tetrahedra"},
        {"*ELSET\n1\n", ":1: *ELSET without a name"},
        {"*ELSET, ELSET=a\nb\n", ":2: no set of elements 'b' so far"},
        {"*ELSET, ELSET=a\na\n", ":2: no set of elements 'a' so far"},
        {"*ELSET, ELSET=a, GENERATE\n1, x\n", ":2: 'x' is not the number of a node or element"},
        {"*ELSET, ELSET=a, GENERATE\n1, 5, 0\n", ":2: '0' is not the number of a node or element"},
        {"*SURFACE, TYPE=ELEMENT\n", ":1: *SURFACE without NAME"},
        {"*SURFACE, NAME=s\n1\n", ":2: *SURFACE: 'element or set, S1 to S4' is expected"},
        {"*SURFACE, NAME=s\n1, S5\n", ":2: *SURFACE: 'element or set, S1 to S4' is expected"},
        {"*PART, NAME=a\n*PART, NAME=b\n", ":2: a second *PART: only one is possible"},
        {"*INSTANCE, NAME=a\n1, 0, 0\n", ":2: *INSTANCE that is moved: give the part in its own coordinates"},
        {"*NODE\n*INCLUDE, INPUT=b.inp\n", ":2: *INCLUDE: put everything into one file"},
        {NODES SOLIDS ONE "*SOLID SECTION, ELSET=a\n*HEADING\n", ":9: no set of elements 'a' so far"},
        {NODES SOLIDS ONE "*SOLID SECTION, ELSET=b\n*ELSET, ELSET=a\nb\n",
         ":11: no set of elements 'b' so far"},
        {NODES SOLIDS ONE "*ELSET, ELSET=b\n1\n*SOLID SECTION, ELSET=a\n*HEADING\n",
         ":11: no set of elements 'a' so far"},
        {NODES SOLIDS ONE "*SURFACE, NAME=s\n2, S1\n",
         ": *SURFACE, NAME=s: element 2 is not there or has no such face"},
        {NODES SOLIDS ONE "*SURFACE, NAME=s\n1, SPOS\n",
         ": *SURFACE, NAME=s: element 1 is not there or has no such face"},
        {NODES SOLIDS ONE "*ELEMENT, TYPE=S3\n2, 10, 20, 30\n*SURFACE, NAME=s\n2, S4\n",
         ": *SURFACE, NAME=s: element 2 is not there or has no such face"},
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
    } known[] = {{"C3D4", 4},   {"C3D4H", 4},  {"c3d4", 4},  {"C3D10", 10}, {"C3D10MH", 10},
                 {"S3", 3},     {"S3R", 3},    {"STRI3", 3}, {"STRI65", 6}, {"CPS3", 3},
                 {"CPS6M", 6},  {"CPE3", 3},   {"CPE6", 6},  {"M3D3", 3},   {"M3D6", 6},
                 {"SFM3D3", 3}, {"SFM3D6", 6}, {"S30", 0},   {"S4R", 0},    {"B31", 0},
                 {"C3D8", -1},  {"C3D40", -1}, {"C3D6", -1}, {"SC8R", -1},  {"sc6r", -1}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        char words[1000] = "", said[1000] = "";
        sprintf(words,
                NODES
                "60, 3, 2, 3.25\n70, 3.25, 4.5, 3.25\n80, 1.25, 4.5, 3\n90, 1, 2.25, 6\n100, 3, 2.25, 6.25\n"
                "110, 1.25, 4.75, 6\n*ELEMENT, TYPE=%s, ELSET=t\n%s\n*ELEMENT, TYPE=C3D4, ELSET=u\n" TWO,
                known[i].name,
                known[i].nodes == 0 || known[i].nodes == -1 ? "x"
                : known[i].nodes == 3                       ? "1, 20, 40, 30"
                : known[i].nodes == 4                       ? "1, 10, 20, 30, 40"
                : known[i].nodes == 6                       ? "1, 20, 40, 30, 7, 8, 9"
                                                            : "1, 10, 20, 30, 40, 60, 70, 80, 90, 100, 110");
        if (known[i].nodes < 0) {
            snprintf(
                said, sizeof said,
                ":13: *ELEMENT, TYPE=%s: only tetrahedra of first and second order are possible: C3D4, C3D10",
                known[i].name);
            expect_refused(words, said);
        } else if (known[i].nodes == 4) {
            expect(words,
                   WARNING ": 6 nodes belong to no tetrahedron and are left out; the first is node 60 at "
                           "(3, 2, 3.25) m\n" X5 "e 1: 0 1 2 3 in t\ne 2: 1 2 3 4 in u\n");
        } else if (known[i].nodes == 10) {
            expect(words, X5 "e 1: 0 1 2 3 in t\ne 2: 1 2 3 4 in u\n");
        } else { /* a triangle is a face in a set */
            snprintf(said, sizeof said,
                     WARNING
                     ": 7 nodes belong to no tetrahedron and are left out; the first is node 10 at (1, 2, 3) "
                     "m\nx 0: 5 2 3.5\nx 1: 1.5 7 3\nx 2: 1 2.5 9\nx 3: 6 8 10\ne 2: 0 1 2 3 in u%s\n",
                     known[i].nodes > 0 ? ", t at 3" : "");
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

#define FACES(set) "*ELEMENT, TYPE=S3, ELSET=" set "\n3, 30, 10, 20\n"

/* Which sets of elements count: sections, else *ELSET, else the set of the *ELEMENT line. */
static void test_volume_sets(void **state) {
    (void)state;
    static const struct {
        const char *words, *one, *two; /* volume sets of the elements */
    } cases[] = {
        {"*ELEMENT, TYPE=C3D4, ELSET=L\n" ONE TWO, "L", "L"},
        {"*ELEMENT, TYPE=C3D4, ELSET=L\n" ONE TWO "*ELSET, ELSET=s\n2\n", "L", "s"},
        {"*ELSET, ELSET=s\n2\n*ELEMENT, TYPE=C3D4, ELSET=L\n" ONE TWO, "L", "s"}, /* before its elements */
        {"*ELEMENT, TYPE=C3D4, ELSET=L\n" ONE TWO "*ELSET, ELSET=L\n1\n", "L", "L"},
        {SOLIDS ONE TWO "*ELSET, ELSET=s, GENERATE\n1\n", "s", NULL},
        {SOLIDS ONE TWO "*ELSET, ELSET=s, GENERATE\n1, 2\n", "s", "s"},
        {SOLIDS ONE TWO "*ELSET, ELSET=s, GENERATE\n1, 4, 3\n", "s", NULL},

        {SOLIDS ONE TWO "*ELSET, ELSET=s, GENERATE\n1, 2, \n", "s", "s"},
        {SOLIDS ONE TWO "*ELSET, ELSET=s, GENERATE\n2, 1, 1\n", NULL, NULL},
        {SOLIDS ONE TWO "*ELSET, ELSET=s\n1, 1, 77,\n", "s", NULL},
        {SOLIDS ONE TWO "*ELSET, ELSET=s\n1\n*ELSET, ELSET=S\n2\n", "s", "s"}, /* names know no case */
        {SOLIDS ONE TWO "*ELSET, ELSET=s, INTERNAL\n1\n*ELSET, ELSET=t\n1, 2\n", "t", "t"},
        {SOLIDS ONE TWO "*ELSET, ELSET=s, INTERNAL\n1\n*ELSET, ELSET=u, INTERNAL\n2\n*ELSET, ELSET=t\ns, U\n",
         "t", "t"},
        {"*ELEMENT, TYPE=C3D4, ELSET=L\n" ONE "*ELEMENT, TYPE=C3D4, ELSET=M\n" TWO
         "*SOLID SECTION, ELSET=m, MATERIAL=x\n",
         NULL, "m"},
        {"*ELEMENT, TYPE=C3D4, ELSET=L\n" ONE TWO "*ELSET, ELSET=s\n1\n*SOLID SECTION, ELSET=s\n1.\n", "s",
         NULL},
        {"*ELEMENT, TYPE=C3D4, ELSET=L\n" ONE TWO "*ELSET, ELSET=s\n1\n*SOLID SECTION, MATERIAL=s\n1.\n", "s",
         "L"},
        /* the same name in parts, and of both kinds, behind other sets */
        {"*ELEMENT, TYPE=C3D4, ELSET=L\n" ONE TWO "*ELSET, ELSET=s\n1\n*ELSET, ELSET=s\n1, 2\n", "s", "s"},
        {"*ELEMENT, TYPE=C3D4, ELSET=L\n" ONE TWO "*ELSET, ELSET=s\n1\n*ELSET, ELSET=L\n2\n", "s", "L"},
        {"*ELEMENT, TYPE=C3D4, ELSET = \"L M\"\n" ONE TWO, "L M", "L M"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char words[1000], said[1000];
        snprintf(words, sizeof words, NODES "%s", cases[i].words);
        snprintf(said, sizeof said, X5 "e 1: 0 1 2 3%s%s\ne 2: 1 2 3 4%s%s\n",
                 cases[i].one != NULL ? " in " : "", cases[i].one != NULL ? cases[i].one : "",
                 cases[i].two != NULL ? " in " : "", cases[i].two != NULL ? cases[i].two : "");
        expect(words, said);
    }
    expect_refused(NODES SOLIDS ONE TWO "*ELSET, ELSET=s\n1, 2\n*ELSET, ELSET=t\n2\n",
                   ": element 2 is in two sets, 's' and 't'; it can be in one only");
    expect_refused(NODES SOLIDS ONE TWO "*ELSET, ELSET=s\n1\n*ELSET, ELSET=t\n1, 2\n*SOLID SECTION, ELSET=s\n"
                                        "*SOLID SECTION, ELSET=t\n",
                   ": element 1 is in two sets, 's' and 't'; it can be in one only");
}

static void test_surface_sets(void **state) {
    (void)state;
    /* S1 to S4 are opposite nodes 4, 3, 1 and 2. */
    expect(NODES SOLIDS ONE TWO "*SURFACE, NAME=a, TYPE=ELEMENT\n1, S1\n*SURFACE, NAME=b\n1, s2\n*SURFACE, "
                                "TYPE=element, NAME=c\n1, S4\n"
                                "*SURFACE, NAME=d\n2, S2\n2, S3\n2, S4\n",
           X5 "e 1: 0 1 2 3, c at 1, b at 2, a at 3\ne 2: 1 2 3 4, d at 0, d at 1, d at 2\n");
    expect(NODES SOLIDS ONE TWO "*SURFACE, NAME=a\n1, S3\n2, S1\n",
           WARNING ": 1 faces of surface sets lie between elements, not on the surface: in no set\n" X5
                   "e 1: 0 1 2 3\ne 2: 1 2 3 4\ninner 1 2 3\n");
    /* By sets of elements, of both names; one patch does not take the elements of another. */
    expect(NODES "*ELEMENT, TYPE=C3D4, ELSET=p\n" ONE "*ELEMENT, TYPE=C3D4, ELSET=q\n" TWO
                 "*SURFACE, NAME=a\np, S1\n*SURFACE, NAME=b\nq, S4\nP, S2\n",
           X5 "e 1: 0 1 2 3 in p, b at 2, a at 3\ne 2: 1 2 3 4 in q, b at 1\n");
    expect(NODES "*ELEMENT, TYPE=C3D4, ELSET=p\n" ONE TWO "*SURFACE, NAME=a\np, S2\n",
           X5 "e 1: 0 1 2 3 in p, a at 2\ne 2: 1 2 3 4 in p, a at 2\n");
    /* A name is one set, however often it comes. */
    write_input(NODES SOLIDS ONE TWO
                "*SURFACE, NAME=a\n1, S1\n*SURFACE, NAME=b\n1, S2\n*SURFACE, NAME=b\n2, S2\n"
                "*SURFACE, NAME=a\n2, S3\n");
    rg_mesh *mesh = rg_inp_read("a.inp", 1);
    assert_int_equal(mesh->sets, 2);
    rg_mesh_free(mesh);
    expect_refused(NODES SOLIDS ONE TWO "*SURFACE, NAME=a\n1, S1\nnix, S1\n*HEADING\n",
                   ":12: no set of elements 'nix' so far");
    expect(NODES SOLIDS ONE TWO "*SURFACE, NAME=a, TYPE=NODE\n1, x\n*SURFACE, NAME=b\n1, S1\n",
           WARNING ":10: *SURFACE, NAME=a is not of TYPE=ELEMENT: left out\n" X5
                   "e 1: 0 1 2 3, b at 3\ne 2: 1 2 3 4\n");
    /* Triangles: their set, and as parts of a surface; a section is for solids alone. */
    expect(NODES SOLIDS ONE TWO FACES("top"), X5 "e 1: 0 1 2 3, top at 3\ne 2: 1 2 3 4\n");
    expect(NODES SOLIDS ONE TWO FACES("top") "*ELSET, ELSET=other\n3\n*ELSET, ELSET=all\n1, 2\n"
                                             "*SOLID SECTION, ELSET=all\n",
           X5 "e 1: 0 1 2 3 in all, other at 3\ne 2: 1 2 3 4 in all\n");
    expect(NODES SOLIDS ONE TWO "*ELEMENT, TYPE=S3\n3, 30, 10, 20\n*SURFACE, NAME=s\n3, SNEG\n3, SPOS\n",
           X5 "e 1: 0 1 2 3, s at 3\ne 2: 1 2 3 4\n");
    expect(NODES SOLIDS ONE "*ELEMENT, TYPE=S3, ELSET=t\n3, 10, 20, 50\n4, 10, 20, 40\n5, 10, 20, 77\n",
           WARNING LEFT_50 WARNING ": 2 triangles of surface sets are no faces of tetrahedra: left out\n" X
                                   "e 1: 0 1 2 3, t at 2\n");
    expect_refused(NODES SOLIDS ONE TWO FACES("top") "*SURFACE, NAME=side\n1, S1\n",
                   ": 1 and 3 are the same face, in surface sets 'side' and 'top'; it can be in one only");
}

/* A name of 63 bytes is a name, one of 64 is too long; of sets there may be 64. */
static void test_limits(void **state) {
    (void)state;
    char name[66], words[12000], said[400];
    memset(name, 'n', 65);
    for (int length = 63; length <= 64; length++) {
        name[length] = '\0';
        snprintf(words, sizeof words, NODES "*ELEMENT, TYPE=C3D4, ELSET=%s\n" ONE TWO, name);
        if (length == 63) {
            snprintf(said, sizeof said, X5 "e 1: 0 1 2 3 in %s\ne 2: 1 2 3 4 in %s\n", name, name);
            expect(words, said);
        } else {
            snprintf(said, sizeof said, ":7: '%s' is longer than 63 bytes", name);
            expect_refused(words, said);
        }
        snprintf(words, sizeof words,
                 NODES "*ELEMENT, TYPE=C3D4, ELSET=%.63s\n" ONE TWO "*SURFACE, NAME=a\n%s, S1\n", name, name);
        if (length == 63) {
            write_input(words);
            static char found[4000];
            assert_int_equal(run_child(read_and_print, found, sizeof found), RG_OK);
            assert_non_null(strstr(found, "a at 3"));
        } else {
            expect_refused(words, ":11: *SURFACE: 'element or set, S1 to S4' is expected");
        }
        name[length] = 'n';
    }
    for (int sets = 64; sets <= 65; sets++) {
        strcpy(words, NODES SOLIDS ONE TWO);
        for (int s = 0; s < sets; s++) {
            sprintf(words + strlen(words), "*SURFACE, NAME=n%d\n", s);
            strcat(words, s == 0 ? "1, S1\n1, S1\n" : "");
            strcat(words, s == 63 ? "1, S2\n" : s > 0 ? "1, S1\n" : "");
        }
        expect_refused(words, sets == 64
                                  ? ": 1 and 1 are the same face, in surface sets 'n0' and 'n1'; it can be "
                                    "in one only"
                                  : ": more than 64 sets");
    }
    static const struct {
        int last;
        const char *said;
    } sizes[] = {{65536 + 32, NULL},
                 {65536 + 33, ":11: set 's' has more than 65568 members, with 2 elements so far"}};
    for (int i = 0; i < 2; i++) {
        sprintf(words, NODES SOLIDS ONE TWO "*ELSET, ELSET=s, GENERATE\n1, %d\n", sizes[i].last);
        if (sizes[i].said == NULL) {
            expect(words, X5 "e 1: 0 1 2 3 in s\ne 2: 1 2 3 4 in s\n");
        } else {
            expect_refused(words, sizes[i].said);
        }
    }
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

static char folder[] = "/tmp/test_inp.XXXXXX";

static int set_up(void **state) {
    (void)state;
    scale = 1;
    return mkdtemp(folder) == NULL || chdir(folder) != 0;
}

static int tear_down(void **state) {
    (void)state;
    unlink("a.inp");
    return chdir("/") != 0 || rmdir(folder) != 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_elements),      cmocka_unit_test(test_lines),
        cmocka_unit_test(test_line_mistakes), cmocka_unit_test(test_largest_number),
        cmocka_unit_test(test_types),         cmocka_unit_test(test_middles),
        cmocka_unit_test(test_volume_sets),   cmocka_unit_test(test_surface_sets),
        cmocka_unit_test(test_limits),        cmocka_unit_test(test_many),
    };
    return cmocka_run_group_tests_name("inp", tests, set_up, tear_down);
}
