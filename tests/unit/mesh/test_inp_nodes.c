/* Abaqus input: coordinate systems, and nodes and elements that are generated. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "support/inp_text.h"

/* Coordinates in systems of the line and of the file. */
static void test_systems(void **state) {
    (void)state;
    static const struct {
        const char *words;
        const char *x; /* of the first node */
    } cases[] = {
        {"*NODE, SYSTEM=R\n1, 1, 2, 3\n", "1 2 3"},
        {"*NODE, SYSTEM=RECTANGULAR\n1, 1, 2, 3\n", "1 2 3"},
        {"*NODE, SYSTEM=C\n1, 2, 90, 3\n", "0 2 3"},
        {"*NODE, SYSTEM=c\n1, 2, -90, 3\n", "0 -2 3"},
        {"*NODE, SYSTEM=C\n1, 2, 180, 3\n", "-2 0 3"},
        {"*NODE, SYSTEM=C\n1, 2, 450\n", "0 2 0"},
        {"*NODE, SYSTEM=Cylindrical\n1, 2, 30, 3\n", "1.73205 1 3"},
        {"*NODE, SYSTEM=S\n1, 2, 30, 0\n", "1.73205 1 0"},
        {"*NODE, SYSTEM=S\n1, 2, 0, 30\n", "1.73205 0 1"},
        {"*NODE, SYSTEM=S\n1, 2, 60, 30\n", "0.866025 1.5 1"},
        {"*NODE, SYSTEM=spherical\n1, 2, 10, -90\n", "0 0 -2"},
        {"*SYSTEM\n10, 20, 30\n*NODE\n1, 1, 2, 3\n", "11 22 33"},
        {"*SYSTEM\n10, 20, 30,\n*NODE\n1, 1, 2, 3\n", "11 22 33"},
        {"*SYSTEM\n10, 20, 30\n*SYSTEM\n*NODE\n1, 1, 2, 3\n", "1 2 3"},
        {"*SYSTEM\n10, 20, 30, 10, 27, 30\n*NODE\n1, 1, 2, 3\n", "8 21 33"},
        {"*SYSTEM\n10, 20, 30, 10, 27, 99\n*NODE\n1, 1, 2, 3\n", "8 21 33"}, /* in the plane of x and y */
        {"*SYSTEM\n10, 20, 30, 10, 20, 37\n5, 20, 99\n*NODE\n1, 1, 2, 3\n", "8 17 31"},
        {"*SYSTEM\n10, 20, 30, 10, 20, 37\n10, 25, 1\n*NODE\n1, 1, 2, 3\n", "7 22 31"},
        {"*SYSTEM\n1, 0, 0, , , \n*NODE\n1, 1, 2, 3\n", "2 2 3"},
        {"*SYSTEM\n1, 0, 0, 0\n*NODE\n1, 1, 2, 3\n", "0 -2 3"}, /* its axis points to the origin */
        {"*SYSTEM\n10, 20, 30, 10, 27, 30\n*NODE, SYSTEM=C\n1, 2, 90, 3\n", "8 20 33"},
        {"*PART, NAME=p\n*SYSTEM\n10, 20, 30\n*END PART\n*NODE\n1, 1, 2, 3\n", "1 2 3"},
        {"*SYSTEM\n10, 20, 30\n*PART, NAME=p\n*NODE\n1, 1, 2, 3\n", "1 2 3"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char words[1000], said[1000];
        snprintf(words, sizeof words,
                 "%s*SYSTEM\n*NODE\n2, 100\n3, 0, 100\n4, 0, 0, 100\n" SOLIDS "7, 1, 2, 3, 4\n",
                 cases[i].words);
        snprintf(said, sizeof said, "x 0: %s\nx 1: 100 0 0\nx 2: 0 100 0\nx 3: 0 0 100\ne 7: 0 1 2 3\n",
                 cases[i].x);
        write_input(words);
        static char found[4000];
        assert_int_equal(run_child(read_and_print, found, sizeof found), RG_OK);
        for (char *zero = strstr(found, "-0 "); zero != NULL; zero = strstr(zero, "-0 ")) {
            memmove(zero, zero + 1, strlen(zero)); /* the sign of a zero does not count */
        }
        for (char *small = strstr(found, "e-1"); small != NULL; small = strstr(found, "e-1")) {
            fail_msg("%s: %s", cases[i].words, found);
        }
        char *warned = strstr(found, "x 0:");
        assert_non_null(warned);
        assert_string_equal(warned, said);
    }
}

#define SEVENTHS                                                                                             \
    WARNING ": 2 sets of nodes hold no whole face and are left out: 'a', 'b'\n"                              \
            "x 0: 0 0 0\nx 1: 3 6 9\nx 2: 0 1 0\nx 3: 0 0 1\nx 4: 0.428571 0.857143 1.28571\n"               \
            "x 5: 0 0.857143 0.142857\nx 6: 1.28571 2.57143 3.85714\nx 7: 0 0.571429 0.428571\n"             \
            "e 1: 0 2 4 5\ne 2: 4 5 6 7\ne 3: 1 3 6 7\n"

/* Nodes between others; each is the corner of a tetrahedron, so that its place is told. */
static void test_generated_nodes(void **state) {
    (void)state;
#define ENDS "*NODE\n1, 0, 0, 0\n4, 3, 6, 9\n5, 0, 1, 0\n6, 0, 0, 1\n"
#define FAN  SOLIDS "1, 1, 2, 5, 6\n2, 2, 3, 5, 6\n3, 3, 4, 5, 6\n"
#define SPREAD                                                                                               \
    "x 0: 0 0 0\nx 1: 1 2 3\nx 2: 2 4 6\nx 3: 3 6 9\nx 4: 0 1 0\nx 5: 0 0 1\n"                               \
    "e 1: 0 1 4 5%s\ne 2: 1 2 4 5%s\ne 3: 2 3 4 5%s\n"
    char said[1000];
    snprintf(said, sizeof said, SPREAD, "", "", "");
    expect(ENDS "*NGEN\n1, 4\n" FAN, said);
    expect(ENDS "*NGEN\n4, 1, 1\n" FAN, said);
    expect("*SYSTEM\n-1, 0, 0\n*NODE\n1, 1\n4, 4, 6, 9\n5, 1, 1, 0\n6, 1, 0, 1\n*NGEN\n1, 4\n" FAN, said);
    /* in steps of 3, up and down */
    static const char *const steps[] = {"2, 8, 3", "8, 2, 3"};
    for (int i = 0; i < 2; i++) {
        char words[1000];
        snprintf(words, sizeof words,
                 "*NODE\n2, 1, 2, 3\n8, 3, 6, 9\n1, 0, 1, 0\n9, 0, 0, 1\n*NGEN\n%s\n" SOLIDS
                 "1, 1, 2, 5, 9\n2, 1, 5, 8, 9\n",
                 steps[i]);
        expect(words,
               "x 0: 0 1 0\nx 1: 1 2 3\nx 2: 2 4 6\nx 3: 3 6 9\nx 4: 0 0 1\ne 1: 0 1 2 4\ne 2: 0 2 3 4\n");
    }
    /* in an instance: between its own nodes, not those of the same numbers of another one */
    expect(
        "*PART, NAME=a\n*NODE\n1, 0, 0, 0\n2, 9, 0, 0\n3, 0, 9, 0\n4, 0, 0, 9\n" SOLIDS
        "1, 1, 2, 3, 4\n*PART, NAME=b\n*INSTANCE, NAME=i, PART=a\n*INSTANCE, NAME=j, PART=b\n*NODE\n"
        "1, 20, 0, 0\n3, 22, 4, 6\n4, 20, 1, 0\n5, 20, 0, 1\n*NGEN\n1, 3\n" SOLIDS
        "1, 1, 2, 4, 5\n2, 2, 3, 4, 5\n",
        "x 0: 0 0 0\nx 1: 9 0 0\nx 2: 0 9 0\nx 3: 0 0 9\nx 4: 20 0 0\nx 5: 21 2 3\nx 6: 22 4 6\nx 7: 20 1 0\n"
        "x 8: 20 0 1\ne 1: 0 1 2 3\ne 11: 4 5 7 8\ne 12: 5 6 7 8\n");
    snprintf(said, sizeof said, WARNING ": 1 sets of nodes hold no whole face and are left out: 'g'\n" SPREAD,
             ", h at 3", ", h at 3", ", h at 3");
    expect(ENDS "*NGEN, NSET=g\n1, 4, 1\n" FAN "*NSET, NSET=h\n5, g\n", said);
    /* two lines at once: pairs by number, or as they are listed where the sets are not sorted */
    static const char *const ends[] = {"*NSET, NSET=b\n14, 4\n", "*NSET, NSET=b, UNSORTED\n4, 14\n"};
    for (int i = 0; i < 2; i++) {
        char words[1000];
        snprintf(words, sizeof words,
                 "*NODE, NSET=a\n11, 0, 1, 0\n1, 0, 0, 0\n*NODE\n4, 2, 4, 6\n14, 2, 5, 6\n5, 0, 0, "
                 "1\n%s*NFILL, NSET=f\na, b, "
                 "2, 7\n" SOLIDS "1, 1, 8, 11, 5\n2, 8, 18, 11, 5\n*NSET, NSET=g\nf, 5\n",
                 ends[i]);
        expect(words, WARNING
               ": 2 nodes belong to no tetrahedron and are left out; the first is node 4 at (2, 4, 6) "
               "m\n" WARNING ": 2 sets of nodes hold no whole face and are left out: 'a', 'b'\n"
               "x 0: 0 0 0\nx 1: 0 0 1\nx 2: 1 2 3\nx 3: 0 1 0\nx 4: 1 3 3\n"
               "e 1: 0 1 2 3, f and g at 1, g at 2, g at 3\ne 2: 1 2 3 4, f and g at 0, g at 1, g at 2\n");
    }
    /* each distance half the next one */
    static const char *const bias[][2] = {{"0.5", "1 2 3"}, {"2", "2 4 6"}, {"1", "1.5 3 4.5"}};
    for (int i = 0; i < 3; i++) {
        char words[1000];
        snprintf(words, sizeof words,
                 ENDS "*NSET, NSET=a\n1\n*NSET, NSET=b\n4\n*NFILL, BIAS=%s\na, b, 2, 1\n" SOLIDS
                      "1, 1, 2, 5, 6\n2, 2, 4, 5, 6\n*NSET, NSET=a\n5, 6\n*NSET, NSET=b\n5, 6\n",
                 bias[i][0]);
        snprintf(said, sizeof said,
                 "x 0: 0 0 0\nx 1: %s\nx 2: 3 6 9\nx 3: 0 1 0\nx 4: 0 0 1\ne 1: 0 1 3 4, a at 1\n"
                 "e 2: 1 2 3 4, b at 0\n",
                 bias[i][1]);
        expect(words, said);
    }
    expect(ENDS "*NSET, NSET=a\n1, 5\n*NSET, NSET=b\n4, 6\n*NFILL, BIAS=0.5\na, b, 3, 10\n" SOLIDS
                "1, 1, 11, 5, 15\n2, 11, 21, 15, 25\n3, 21, 4, 25, 6\n",
           SEVENTHS);
    static const struct {
        const char *words, *said;
    } cases[] = {
        {ENDS "*NSET, NSET=a\n1\n*NSET, NSET=b\n4\n*NFILL, BIAS=0\na, b, 2, 1\n",
         ":11: *NFILL, BIAS=0: a number > 0 is expected"},
        {ENDS "*NFILL, TWO STEP\na, b, 2, 1\n", ":6: *NFILL has no parameter 'TWOSTEP' that is known here"},
        {ENDS "*NGEN\n1, 4, 2\n", ":7: *NGEN: steps of 2 do not lead from node 1 to 4"},
        {ENDS "*NGEN\n1, 1\n", ":7: *NGEN: steps of 1 do not lead from node 1 to 1"},
        {ENDS "*NGEN\n1, 7\n", ":7: there is no node 7 so far"},
        {ENDS "*NGEN\n7, 1\n", ":7: there is no node 7 so far"},
        {ENDS "*NGEN\n1\n", ":7: '' is not the number of a node or element"},
        {ENDS "*NGEN, LINE=C\n1, 4\n", ":6: *NGEN has no parameter 'LINE' that is known here"},
        {ENDS "*NODE\n1000003, 1\n*NGEN\n1, 1000003\n",
         ":9: more than 1000000 nodes and elements to be generated"},
        {ENDS "*NSET, NSET=a\n1\n*NFILL\na, b, 2, 1\n", ":9: *NFILL: no set of nodes 'b' so far"},
        {ENDS "*NSET, NSET=a\n1\n*NFILL\na\n", ":9: *NFILL: no set of nodes '' so far"},
        {ENDS "*NSET, NSET=a\n1\n*NSET, NSET=b\n4, 5\n*NFILL\na, b, 2, 1\n",
         ":11: *NFILL: the two sets have 1 and 2 nodes"},
        {ENDS "*NSET, NSET=a\n1\n*NSET, NSET=b\n4\n*NFILL\na, b, 2\n",
         ":11: '' is not the number of a node or element"},
        {ENDS "*NSET, NSET=a\n1\n*NSET, NSET=b\n4\n*NFILL\na, b, 3, 2000000000\n",
         ":11: a number beyond 4000000000 is generated"},
        {ENDS "*NSET, NSET=a\n1\n*NSET, NSET=b\n4\n*NFILL\na, b, 1000001, 4000000000\n",
         ":11: a number beyond 4000000000 is generated"},
        {ENDS "*NSET, NSET=a\n1\n*NSET, NSET=b\n4\n*NFILL\na, b, 1000002, 4000000000\n",
         ":11: more than 1000000 nodes and elements to be generated"},
        /* nodes and elements, by all lines together: 999,998 and 2 or 3 */
        {ENDS
         "*NODE\n1000000, 1\n*NGEN\n1, 1000000\n*ELEMENT, TYPE=C3D4, ELSET=a\n1, 1, 4, 5, 6\n2, 1, 4, 5, 6\n"
         "*ELCOPY, OLD SET=a, ELEMENT SHIFT=4000000000, SHIFT NODES=1\n",
         ":13: a number beyond 4000000000 is generated"},
        {ENDS
         "*NODE\n1000000, 1\n*NGEN\n1, 1000000\n*ELEMENT, TYPE=C3D4, ELSET=a\n1, 1, 4, 5, 6\n2, 1, 4, 5, 6\n"
         "3, 1, 4, 5, 6\n*ELCOPY, OLD SET=a, ELEMENT SHIFT=4000000000, SHIFT NODES=1\n",
         ":14: more than 1000000 nodes and elements to be generated"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        expect_refused(cases[i].words, cases[i].said);
    }
}

/* Nodes n at (n, n^2, n^3), any four of which are the corners of a tetrahedron. */
static char *write_nodes(char *to, int nodes) {
    to += sprintf(to, "*NODE\n");
    for (int n = 1; n <= nodes; n++) {
        to += sprintf(to, "%d, %d, %d, %d\n", n, n, n * n, n * n * n);
    }
    return to;
}

/* The mesh of these elements in words, without the warning of nodes that are left out. */
typedef struct {
    int number, node[4];
    const char *sets;
} expected_element;

static void expect_elements(const char *words, int count, const expected_element *e) {
    static char found[1 << 16], said[1 << 16];
    int vertex[200] = {0}, vertices = 0;
    for (int i = 0; i < 4 * count; i++) {
        vertex[e[i / 4].node[i % 4]] = 1;
    }
    char *to = said;
    for (int n = 0; n < 200; n++) {
        if (vertex[n] > 0) {
            to += sprintf(to, "x %d: %g %g %g\n", vertices, (double)n, (double)n * n, (double)n * n * n);
            vertex[n] = vertices++;
        }
    }
    for (int i = 0; i < count; i++) {
        const int *n = e[i].node;
        to += sprintf(to, "e %d: %d %d %d %d%s\n", e[i].number, vertex[n[0]], vertex[n[1]], vertex[n[2]],
                      vertex[n[3]], e[i].sets);
    }
    write_input(words);
    assert_int_equal(run_child(read_and_print, found, sizeof found), RG_OK);
    assert_string_equal(strstr(found, "x 0:"), said);
}

static void test_generated_elements(void **state) {
    (void)state;
    static char words[1 << 16];
    expected_element e[24];
    int count = 0;
    /* rows of 3, 2 rows, 4 layers */
    for (int layer = 0; layer < 4; layer++) {
        for (int row = 0; row < 2; row++) {
            for (int i = 0; i < 3; i++) {
                int n = 1 + 2 * i + 7 * row + 20 * layer;
                e[count++] = (expected_element){
                    9 + 10 * i + 100 * row + 1000 * layer, {n, n + 1, n + 3, n + 4}, " in g"};
            }
        }
    }
    strcpy(write_nodes(words, 80),
           SOLIDS "9, 1, 2, 4, 5\n*ELGEN, ELSET=g\n9, 3, 2, 10, 2, 7, 100, 4, 20, 1000\n");
    expect_elements(words, count, e);
    /* in an instance of its own, whose numbers begin behind those of the first: nodes from 100, elements from
     * 10 on */
    strcpy(words, "*PART, NAME=a\n");
    strcpy(write_nodes(words + strlen(words), 80),
           SOLIDS "1, 1, 2, 3, 4\n*PART, NAME=b\n*INSTANCE, NAME=i, PART=a\n*INSTANCE, NAME=j, "
                  "PART=b\n*NODE, NSET=low\n"
                  "1, 101, 10201, 1030301\n3, 103, 10609, 1092727\n*NODE, NSET=high\n5, 105, 11025, 1157625\n"
                  "7, 107, 11449, 1225043\n*NGEN\n1, 3\n*NFILL, NSET=n\nlow, high, 2, 10\n*NODE\n2, 102, "
                  "10404, 1061208\n"
                  "11, 111, 12321, 1367631\n13, 113, 12769, 1442897\n" SOLIDS
                  "1, 1, 2, 3, 5\n2, 2, 3, 11, 13\n*ELGEN, ELSET=g\n"
                  "1, 2, 2, 20\n*NODE\n4, 104, 10816, 1124864\n");
    const expected_element own[] = {{1, {1, 2, 3, 4}, ""},
                                    {11, {101, 102, 103, 105}, " in j.g, j.n at 1"},
                                    {12, {102, 103, 111, 113}, ", j.n at 0"},
                                    {31, {103, 104, 105, 107}, " in j.g, j.n at 1"}};
    expect_elements(words, 4, own);
    /* what is left out is 1 */
    e[1] = (expected_element){10, {2, 3, 5, 6}, ""};
    e[0].sets = "";
    strcpy(write_nodes(words, 80), SOLIDS "9, 1, 2, 4, 5\n*ELGEN\n9, 2\n");
    expect_elements(words, 2, e);
    /* copies of a set, which may be those of a generator and have more nodes than corners */
    const expected_element copies[] = {{9, {1, 2, 4, 5}, " in g"},
                                       {10, {2, 3, 5, 6}, " in g"},
                                       {109, {31, 32, 34, 35}, " in new"},
                                       {110, {32, 33, 35, 36}, " in new"}};
    strcpy(write_nodes(words, 80), SOLIDS
           "9, 1, 2, 4, 5\n*ELGEN, ELSET=g\n9, 2\n*ELCOPY, OLD SET=g, ELEMENT SHIFT=100, SHIFT NODES=30, NEW "
           "SET=new\n");
    expect_elements(words, 4, copies);
    const expected_element quadratic[] = {{9, {1, 2, 4, 5}, " in g"}, {10, {31, 32, 34, 35}, ""}};
    strcpy(write_nodes(words, 80),
           "*ELEMENT, TYPE=C3D10, ELSET=g\n9, 1, 2, 4, 5, 11, 12, 13, 14, 15, 16\n*ELCOPY, OLD "
           "SET=g, ELEMENT SHIFT=1, SHIFT NODES=30\n");
    expect_elements(words, 2, quadratic);
    static const struct {
        const char *words, *said;
    } cases[] = {
        {NODES SOLIDS ONE "*ELGEN\n2, 2\n", ":10: there is no element 2 so far"},
        {NODES SOLIDS ONE "*ELGEN\n1\n", ":10: '' is not the number of a node or element"},
        {NODES SOLIDS ONE "*ELGEN\n1, 2, 1, 1, 2, 1\n", ":10: '' is not the number of a node or element"},
        {NODES SOLIDS ONE "*ELGEN\n1, 2, 1, 1, 2, 1, 1\n", ":10: element 2 is defined twice"},
        {NODES SOLIDS ONE "*ELGEN\n1, 1000002\n",
         ":10: more than 1000000 nodes and elements to be generated"},
        {NODES SOLIDS ONE "*ELGEN\n1, 1001, 1, 1, 1001, 1, 1\n",
         ":10: more than 1000000 nodes and elements to be generated"},
        {NODES SOLIDS ONE "*ELGEN\n1, 2, 1, 1, 2, 1, 1, 3000000000, 1, 1\n",
         ":10: more than 1000000 nodes and elements to be generated"},
        {NODES SOLIDS ONE "*ELGEN\n1, 1000001, 1, 4000000000\n",
         ":10: a number beyond 4000000000 is generated"},
        {NODES SOLIDS ONE "*ELGEN\n1, 101, 1, 4000000000, 9901, 1, 1\n",
         ":10: a number beyond 4000000000 is generated"},
        {NODES SOLIDS ONE "*ELGEN\n1, 101, 1, 4000000000, 9902, 1, 1\n",
         ":10: more than 1000000 nodes and elements to be generated"},
        {NODES SOLIDS ONE "*ELGEN\n1, 2, 1, 4000000000, 2, 1, 1, 250000, 1, 1\n",
         ":10: a number beyond 4000000000 is generated"},
        {NODES SOLIDS ONE "*ELGEN\n1, 2, 1, 4000000000, 2, 1, 1, 250001, 1, 1\n",
         ":10: more than 1000000 nodes and elements to be generated"},
        {NODES SOLIDS ONE "*ELGEN\n1, 2, 4000000000\n", ":10: a number beyond 4000000000 is generated"},
        {NODES SOLIDS ONE "*ELGEN\n1, 2, 1, 4000000000\n", ":10: a number beyond 4000000000 is generated"},
        {NODES SOLIDS ONE "*ELCOPY, OLD SET=a, ELEMENT SHIFT=1, SHIFT NODES=1\n",
         ":9: *ELCOPY: no set of elements 'a' so far"},
        {NODES SOLIDS ONE "*ELCOPY, ELEMENT SHIFT=1, SHIFT NODES=1\n", ":9: *ELCOPY without OLDSET"},
        {NODES SOLIDS ONE "*ELCOPY, OLD SET=a, SHIFT NODES=1\n", ":9: *ELCOPY without ELEMENTSHIFT"},
        {NODES SOLIDS ONE "*ELCOPY, OLD SET=a, ELEMENT SHIFT=1\n", ":9: *ELCOPY without SHIFTNODES"},
        {NODES SOLIDS ONE "*ELCOPY, OLD SET=a, ELEMENT SHIFT=1, SHIFT NODES=1, REFLECT\n",
         ":9: *ELCOPY has no parameter 'REFLECT' that is known here"},
        {NODES "*ELEMENT, TYPE=C3D4, ELSET=a\n" ONE "*ELCOPY, OLD SET=a, ELEMENT SHIFT=1, SHIFT NODES=1\n1\n",
         ":10: *ELCOPY has no data lines"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        expect_refused(cases[i].words, cases[i].said);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_systems),
        cmocka_unit_test(test_generated_nodes),
        cmocka_unit_test(test_generated_elements),
    };
    return cmocka_run_group_tests_name("inp_nodes", tests, set_up, tear_down);
}
