/* Abaqus input: sets of elements and nodes, surfaces, parts and instances. */
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

#define FACES(set) "*ELEMENT, TYPE=S3, ELSET=" set "\n3, 30, 10, 20\n"

/* All sets of elements that hold some count, and may overlap. */
static void test_volume_sets(void **state) {
    (void)state;
    static const struct {
        const char *words, *one, *two; /* volume sets of the elements */
    } cases[] = {
        {"*ELEMENT, TYPE=C3D4, ELSET=L\n" ONE TWO, "L", "L"},
        {"*ELEMENT, TYPE=C3D4, ELSET=L\n" ONE TWO "*ELSET, ELSET=s\n2\n", "L", "L and s"},
        {"*ELSET, ELSET=s\n2\n*ELEMENT, TYPE=C3D4, ELSET=L\n" ONE TWO, "L",
         "s and L"}, /* before its elements */
        {"*ELEMENT, TYPE=C3D4, ELSET=L\n" ONE TWO "*ELSET, ELSET=L\n1\n", "L", "L"},
        {SOLIDS ONE TWO "*ELSET, ELSET=s, GENERATE\n1\n", "s", NULL},
        {SOLIDS ONE TWO "*ELSET, ELSET=s, GEN\n1, 2\n", "s", "s"},
        {SOLIDS ONE TWO "*ELSET, ELSET=s, GENERATE\n1, 4, 3\n", "s", NULL},
        {SOLIDS ONE TWO "*ELSET, ELSET=s, GENERATE\n1, 2, \n", "s", "s"},
        {SOLIDS ONE TWO "*ELSET, ELSET=s, GENERATE\n2, 4000000000, 1\n", NULL, "s"},
        {SOLIDS ONE TWO "*ELSET, ELSET=s, GENERATE\n1, 4000000000, 2\n", "s", NULL},
        {SOLIDS ONE TWO "*ELSET, ELSET=s, GENERATE\n2, 4000000000, 2\n", NULL, "s"},
        {SOLIDS ONE TWO "*ELSET, ELSET=s, GENERATE\n1, 1\n", "s", NULL},
        {SOLIDS ONE TWO "*ELSET, ELSET=s\n1\n*ELSET, ELSET=S\n2\n", "s", "s"}, /* names know no case */
        {SOLIDS ONE TWO "*ELSET, ELSET=s, INTERNAL\n1\n*ELSET, ELSET=t\n1, 2\n", "t", "t"},
        {SOLIDS ONE TWO "*ELSET, ELSET=s, INTERNAL\n1\n*ELSET, ELSET=u, INTERNAL\n2\n*ELSET, ELSET=t\ns, U\n",
         "t", "t"},
        {SOLIDS ONE TWO "*ELSET, ELSET=t\ns, U\n*ELSET, ELSET=u\n2\n*ELSET, ELSET=s\n1, t,\n", "t and s",
         "t and u and s"}, /* of later ones, in a ring */
        {"*ELEMENT, TYPE=C3D4, ELSET=L\n" ONE "*ELEMENT, TYPE=C3D4, ELSET=M\n" TWO
         "*SOLID SECTION, ELSET=m, MATERIAL=x\n",
         "L", "M"},
        /* the same name in parts, behind other sets */
        {"*ELEMENT, TYPE=C3D4, ELSET=L\n" ONE TWO "*ELSET, ELSET=s\n1\n*ELSET, ELSET=s\n1, 2\n", "L and s",
         "L and s"},
        {"*ELEMENT, TYPE=C3D4, ELSET=L\n" ONE TWO "*ELSET, ELSET=s\n1\n*ELSET, ELSET=L\n2\n", "L and s", "L"},
        {"*ELEMENT, TYPE=C3D4, ELSET = \"L M\"\n" ONE TWO, "L M", "L M"},
        {"*ELEMENT, TYPE=C3D4, ELSET = L M \n" ONE TWO, "LM", "LM"},
        {SOLIDS ONE TWO "*ELSET, ELSET=\"a, b\"\n1\n*ELSET, ELSET=c\n\"a, b\", 2\n", "a, b and c", "c"},
        {SOLIDS ONE TWO "*STEP\n*ELSET, ELSET=s\n1\n*END STEP\n", "s", NULL},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char words[1000], said[1000];
        snprintf(words, sizeof words, NODES "%s", cases[i].words);
        snprintf(said, sizeof said, X5 "e 1: 0 1 2 3%s%s\ne 2: 1 2 3 4%s%s\n",
                 cases[i].one != NULL ? " in " : "", cases[i].one != NULL ? cases[i].one : "",
                 cases[i].two != NULL ? " in " : "", cases[i].two != NULL ? cases[i].two : "");
        expect(words, said);
    }
    expect(NODES SOLIDS ONE TWO
           "*ELSET, ELSET=r\n1\n*ELSET, ELSET=s\n1, 1, 77, 78\n*NSET, NSET=n, INTERNAL\n7\n"
           "*ELSET, ELSET=t\n79\n",
           WARNING ": 3 members of sets are no nodes or elements of the mesh; the first is 77 in set 's'\n" X5
                   "e 1: 0 1 2 3 in r and s\ne 2: 1 2 3 4\n");
}

/* Sets of nodes, by numbers, by sets, by elements. */
static void test_node_sets(void **state) {
    (void)state;
    static const char *const same[] = {
        "*NSET, NSET=n\n10, 20, 30\n",
        "*NSET, NSET=n, GENERATE\n10, 30, 10\n",
        "*NSET, NSET=n\nm, 30\n*NSET, NSET=m, INTERNAL\n10, 20\n",
        "*NSET, NSET=m, INTERNAL\n10, 20\n*NSET, NSET=n, UNSORTED\n30, m\n",
        "*SURFACE, TYPE=NODE, NAME=n\n10, 1.5\n20,\n30\n",
        "*NSET, NSET=m, INTERNAL\n10, 20\n*SURFACE, TYPE=node, NAME=n\nM, 1.\n30\n",
        "*ELEMENT, TYPE=S3, ELSET=n\n3, 30, 10, 20\n",
    };
    for (size_t i = 0; i < sizeof same / sizeof *same; i++) {
        char words[1000];
        snprintf(words, sizeof words, NODES SOLIDS ONE TWO "%s", same[i]);
        expect(words, X5 "e 1: 0 1 2 3, n at 3\ne 2: 1 2 3 4\n");
    }
    expect(NODES SOLIDS ONE "*ELEMENT, TYPE=C3D4, ELSET=second\n" TWO "*NSET, NSET=n, ELSET=second\n"
                            "*NSET, NSET=all, ELSET=second\nall, 10\n",
           X5 "e 1: 0 1 2 3, all at 1, all at 2, all at 3\n"
              "e 2: 1 2 3 4 in second, n and all at 0, n and all at 1, n and all at 2\n");
    expect(NODES SOLIDS ONE TWO
           "*NSET, NSET=n\n10, 20, 30\n*SURFACE, NAME=n\n2, S2\n*NSET, NSET=empty\n*NSET, NSET=edge\n"
           "10, 20\n",
           WARNING ": 2 sets of nodes hold no whole face and are left out: 'empty', 'edge'\n" WARNING
                   ": 1 sets of nodes are left out, for there are surfaces of their names: 'n'\n" X5
                   "e 1: 0 1 2 3\ne 2: 1 2 3 4, n at 2\n");
}

static void test_surface_sets(void **state) {
    (void)state;
    /* S1 to S4 are opposite nodes 4, 3, 1 and 2. */
    expect(NODES SOLIDS ONE TWO "*SURFACE, NAME=a, TYPE=ELEMENT\n1, S1\n*SURFACE, NAME=b\n1, s2\n*SURFACE, "
                                "TYPE=element, NAME=c\n1, S4\n"
                                "*SURFACE, NAME=d\n2, S2\n2, S3\n2, S4\n",
           X5 "e 1: 0 1 2 3, c at 1, b at 2, a at 3\ne 2: 1 2 3 4, d at 0, d at 1, d at 2\n");
    expect(NODES SOLIDS ONE TWO "*SURFACE, NAME=a\n1, S3\n2, S1\n",
           WARNING ": 1 faces of surface sets lie between elements: interface.sets may name them, boundary "
                   "leaves them out\n" X5 "e 1: 0 1 2 3, a at 0\ne 2: 1 2 3 4, a at 3\ninner 1 2 3\n");
    /* By sets of elements, of both names; one patch does not take the elements of another. */
    expect(NODES "*ELEMENT, TYPE=C3D4, ELSET=p\n" ONE "*ELEMENT, TYPE=C3D4, ELSET=q\n" TWO
                 "*SURFACE, NAME=a\np, S1\n*SURFACE, NAME=b\nq, S4\nP, S2\n",
           X5 "e 1: 0 1 2 3 in p, b at 2, a at 3\ne 2: 1 2 3 4 in q, b at 1\n");
    expect(NODES "*ELEMENT, TYPE=C3D4, ELSET=p\n" ONE TWO "*SURFACE, NAME=a\np, S2\n",
           X5 "e 1: 0 1 2 3 in p, a at 2\ne 2: 1 2 3 4 in p, a at 2\n");
    /* All free faces; of a set that comes later. */
    expect(NODES SOLIDS ONE TWO
           "*SURFACE, NAME=a\np,\n*SURFACE, NAME=b\n2\n*SURFACE, NAME=c\np, S1\n*ELSET, ELSET=p\n1\n",
           X5 "e 1: 0 1 2 3 in p, a at 1, a at 2, a and c at 3\ne 2: 1 2 3 4, b at 0, b at 1, b at 2\n");
    expect(NODES SOLIDS ONE TWO
           "*ELSET, ELSET=p, INTERNAL\n*SURFACE, NAME=a\np, S1\n*SURFACE, NAME=b\n*SURFACE, NAME=c\n1, S1\n",
           WARNING ": *SURFACE, NAME=a names no face at all\n" WARNING
                   ": *SURFACE, NAME=b names no face at all\n" X5 "e 1: 0 1 2 3, c at 3\ne 2: 1 2 3 4\n");
    /* A name is one set, however often it comes. */
    write_input(NODES SOLIDS ONE TWO
                "*SURFACE, NAME=a\n1, S1\n*SURFACE, NAME=b\n1, S2\n*SURFACE, NAME=b\n2, S2\n"
                "*SURFACE, NAME=a\n2, S3\n");
    FILE *nowhere = fopen("/dev/null", "w");
    rg_mesh *mesh = rg_inp_read("a.inp", NULL, &(rg_import_how){.scale = 1}, nowhere);
    fclose(nowhere);
    assert_int_equal(mesh->surface.count, 2);
    rg_mesh_free(mesh);
    expect_refused(NODES SOLIDS ONE TWO "*SURFACE, NAME=a\n1, S1\nnix, S1\n*HEADING\n",
                   ":12: no set of elements 'nix'");
    expect(NODES SOLIDS ONE TWO "*SURFACE, NAME=a, TYPE=CYLINDER\n1, x\n*SURFACE, NAME=b\n1, S1\n",
           WARNING ":10: *SURFACE, NAME=a is of TYPE=CYLINDER, not of elements or nodes: left out\n" X5
                   "e 1: 0 1 2 3, b at 3\ne 2: 1 2 3 4\n");
    /* Triangles: their sets, and as parts of a surface; elements that are left out have no faces. */
    expect(NODES SOLIDS ONE TWO FACES("top"), X5 "e 1: 0 1 2 3, top at 3\ne 2: 1 2 3 4\n");
    expect(NODES SOLIDS ONE TWO FACES("top") "*ELSET, ELSET=other\n3, 1\n",
           X5 "e 1: 0 1 2 3 in other, top and other at 3\ne 2: 1 2 3 4\n");
    expect(NODES SOLIDS ONE TWO "*ELEMENT, TYPE=S3\n3, 30, 10, 20\n*SURFACE, NAME=s\n3, SNEG\n3, SPOS\n",
           X5 "e 1: 0 1 2 3, s at 3\ne 2: 1 2 3 4\n");
    expect(NODES SOLIDS ONE TWO "*ELEMENT, TYPE=S3\n3, 30, 10, 20\n*SURFACE, NAME=s\n3\n",
           X5 "e 1: 0 1 2 3, s at 3\ne 2: 1 2 3 4\n");
    expect(NODES SOLIDS ONE TWO "*ELEMENT, TYPE=B31, ELSET=x\n3, 30, 10\n*SURFACE, NAME=s\n3, SPOS\nx, S1\n",
           WARNING ": elements that are no solids are left out: 1 B31\n" X5 "e 1: 0 1 2 3\ne 2: 1 2 3 4\n");
    expect(NODES SOLIDS ONE "*ELEMENT, TYPE=S3, ELSET=t\n3, 10, 20, 50\n4, 10, 20, 40\n5, 10, 20, 77\n",
           WARNING LEFT_50 WARNING ": 2 triangles of surface sets are no faces of tetrahedra: left out\n" X
                                   "e 1: 0 1 2 3, t at 2\n");
    expect(NODES SOLIDS ONE TWO FACES("top") "*SURFACE, NAME=side\n1, S1\n",
           X5 "e 1: 0 1 2 3, top and side at 3\ne 2: 1 2 3 4\n");
}

/* Parts and their instances. */
#define PART                                                                                                 \
    "*PART, NAME=P\n" NODES "*ELEMENT, TYPE=C3D4, ELSET=L\n" ONE TWO                                         \
    "*SURFACE, NAME=s\n1, S1\nL, S2\n*NSET, NSET=n\n10, 20, 40\n*END PART\n"

static void test_parts(void **state) {
    (void)state;
    /* one part needs no instance, or has one, perhaps with a mesh of its own */
    expect(PART, X5 "e 1: 0 1 2 3 in L, s and n at 2, s at 3\ne 2: 1 2 3 4 in L, s at 2\n");
    expect(PART "*ASSEMBLY, NAME=A\n*INSTANCE, NAME=P-1, PART=P\n*END INSTANCE\n*END ASSEMBLY\n",
           X5 "e 1: 0 1 2 3 in L, s and n at 2, s at 3\ne 2: 1 2 3 4 in L, s at 2\n");
    expect("*PART, NAME=P\n*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=P-1, PART=P\n-1, 0, 0\n" NODES SOLIDS
               ONE TWO "*ELSET, ELSET=e\n1\n*END INSTANCE\n*END ASSEMBLY\n",
           "x 0: 0 2 3\nx 1: 4 2 3.5\nx 2: 0.5 7 3\nx 3: 0 2.5 9\nx 4: 5 8 10\ne 1: 0 1 2 3 in e\ne 2: 1 2 3 "
           "4\n");
    /* moved, then turned: about an axis through (1, 2) along z, by a quarter */
    expect(PART "*INSTANCE, NAME=P-1, PART=P\n1, 0, 0\n1, 2, 0, 1, 2, 7, 90\n*END INSTANCE\n",
           "x 0: 1 3 3\nx 1: 1 7 3.5\nx 2: -4 3.5 3\nx 3: 0.5 3 9\nx 4: -5 8 10\n"
           "e 1: 0 1 2 3 in L, s and n at 2, s at 3\ne 2: 1 2 3 4 in L, s at 2\n");
    /* about an axis that is none of the coordinates', by a third: x to y to z to x */
    expect(PART "*INSTANCE, NAME=P-1, PART=P\n0, 0, 0\n0, 0, 0, 2, 2, 2, 120\n",
           "x 0: 3 1 2\nx 1: 3.5 5 2\nx 2: 3 1.5 7\nx 3: 9 1 2.5\nx 4: 10 6 8\n"
           "e 1: 0 1 2 3 in L, s and n at 2, s at 3\ne 2: 1 2 3 4 in L, s at 2\n");
}

/* Several instances have numbers and names of their own. */
/* Blanks, commas and letters of all languages; Latin-1 becomes UTF-8, for a case file must be able to say it.
 */
static void test_names(void **state) {
    (void)state;
    static const struct {
        const char *in, *out;
    } names[] = {{"linke Fl\xc3\xa4"
                  "che, \xe2\x84\x96 2",
                  NULL},
                 {"linke Fl\xe4"
                  "che",
                  "linke Fl\xc3\xa4"
                  "che"},
                 {"\xc3\xa4 und \xe4", "\xc3\x83\xc2\xa4 und \xc3\xa4"}, /* not all of it is UTF-8 */
                 {"\xf0\x9f\x94\xa8 \xdf", "\xc3\xb0\xc2\x9f\xc2\x94\xc2\xa8 \xc3\x9f"},
                 {"\xf0\x9f\x94\xa8", NULL},
                 {"\xe2\x84", "\xc3\xa2\xc2\x84"},
                 {"\xff", "\xc3\xbf"}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        const char *out = names[i].out != NULL ? names[i].out : names[i].in;
        char words[600], found[2000], line[300];
        snprintf(words, sizeof words,
                 NODES SOLIDS ONE TWO "*ELSET, ELSET=\"%s\"\n1\n*SURFACE, NAME=\"%s\"\n2, S2\n", names[i].in,
                 names[i].in);
        write_input(words);
        assert_int_equal(run_child(read_and_print, found, sizeof found), RG_OK);
        snprintf(line, sizeof line, " in %s", out);
        assert_non_null(strstr(found, line));
        snprintf(line, sizeof line, "%s at", out);
        assert_non_null(strstr(found, line));
    }
    /* 128 letters of two bytes each are one too many */
    char name[130], words[600];
    memset(name, 0xe4, 129);
    for (int length = 127; length <= 128; length++) {
        name[length] = '\0';
        snprintf(words, sizeof words, NODES SOLIDS ONE TWO "*ELSET, ELSET=%s\n1\n", name);
        write_input(words);
        char found[2000];
        assert_int_equal(run_child(read_and_print, found, sizeof found), length == 127 ? RG_OK : RG_USAGE);
        name[length] = (char)0xe4;
    }
}

/* 249 bytes: with a name of 6 and a point one too many. */
#define N83  "nnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnn"
#define LONG N83 N83 N83

static void test_instances(void **state) {
    (void)state;
#define BOTH X5 "x 5: 1 2 53\nx 6: 5 2 53.5\nx 7: 1.5 7 53\nx 8: 1 2.5 59\nx 9: 6 8 60\n"
    expect(
        PART
        "*ASSEMBLY, NAME=A\n*INSTANCE, NAME=one, PART=P\n*END INSTANCE\n*INSTANCE, NAME=\"one.b\", PART=p\n"
        "0, 0, 50\n*NSET, NSET=m\n20, 30, 50\n*END INSTANCE\n"
        "*NODE, NSET=point\n10, 7, 7, 7\n*ELEMENT, TYPE=MASS, ELSET=point\n1, 10\n*MASS, ELSET=point\n1.\n"
        "*ELSET, ELSET=all, INSTANCE=one\n2\n*ELSET, ELSET=all, INSTANCE=ONE.b\nL\n*ELSET, ELSET=all, "
        "INSTANCE=one, "
        "GENERATE\n1, 1\n*NSET, NSET=point\n10\n"
        "*SURFACE, NAME=t\none.1, S1\nOne.B.2, S2\n*SURFACE, NAME=u, TYPE=NODE\none.b.m\n"
        "*ELSET, ELSET=v\none.b.L, one.1\n*END ASSEMBLY\n*NSET, NSET=w, INSTANCE=one\n10, 20, 30\n",
        WARNING ": elements that are no solids are left out: 1 MASS\n" WARNING
                ": 1 sets of nodes hold no whole face and are left out: 'point'\n" BOTH
                "e 1: 0 1 2 3 in one.L and all and v, one.s and one.n at 2, one.s and t and w at 3\n"
                "e 2: 1 2 3 4 in one.L and all, one.s at 2\n"
                "e 11: 5 6 7 8 in one.b.L and all and v, one.b.s and one.b.n at 2, one.b.s at 3\n"
                "e 12: 6 7 8 9 in one.b.L and all and v, one.b.s and t and u and one.b.m at 2\n");
    /* the same name in the assembly: that of the instance gets the longer one */
    expect(PART "*INSTANCE, NAME=one, PART=P\n*END INSTANCE\n*ELSET, ELSET=l, INSTANCE=one\n1\n*NSET, "
                "NSET=n, INSTANCE=one\n"
                "10, 30, 40\n",
           X5
           "e 1: 0 1 2 3 in one.L and l, n at 1, s and one.n at 2, s at 3\ne 2: 1 2 3 4 in one.L, s at 2\n");
    /* numbers stay clear of each other, in parts of all sizes, with meshes of their own */
    expect("*PART, NAME=a\n*NODE\n1, 1, 2, 3\n2, 5, 2, 3.5\n3, 1.5, 7, 3\n100, 1, 2.5, 9\n" SOLIDS
           "9, 1, 2, 3, 100\n"
           "*PART, NAME=b\n*INSTANCE, NAME=i, PART=a\n*INSTANCE, NAME=j, PART=a\n*INSTANCE, NAME=k, "
           "PART=b\n" NODES SOLIDS ONE "*INSTANCE, NAME=l, PART=a\n",
           WARNING
           ": 1 nodes belong to no tetrahedron and are left out; the first is node 10050 at (6, 8, 10) m\n" X
           "x 4: 1 2 3\nx 5: 5 2 3.5\nx 6: 1.5 7 3\nx 7: 1 2.5 9\nx 8: 1 2 3\nx 9: 5 2 3.5\nx 10: 1.5 7 3\nx "
           "11: 1 2.5 9\n"
           "x 12: 1 2 3\nx 13: 5 2 3.5\nx 14: 1.5 7 3\nx 15: 1 2.5 9\n"
           "e 9: 0 1 2 3\ne 19: 4 5 6 7\ne 101: 8 9 10 11\ne 119: 12 13 14 15\n");
    static const struct {
        const char *words, *said;
    } cases[] = {
        {"*PART, NAME=P\n*NODE\n3000000000, 1\n*INSTANCE, NAME=a, PART=P\n*INSTANCE, NAME=b, "
         "PART=P\n*HEADING\n",
         ":6: the nodes or elements of *INSTANCE, NAME=b get numbers beyond 4000000000"},
        {"*PART, NAME=P\n" SOLIDS
         "3000000000, 1, 2, 3, 4\n*INSTANCE, NAME=a, PART=P\n*INSTANCE, NAME=b, PART=P\n*HEADING\n",
         ":6: the nodes or elements of *INSTANCE, NAME=b get numbers beyond 4000000000"},
        {"*PART, NAME=P\n*NODE\n100000000, 1\n*INSTANCE, NAME=a, PART=P\n*PART, NAME=Q\n*INSTANCE, NAME=b, "
         "PART=Q\n"
         "*NODE\n4000000000, 1\n",
         ":8: the number gets beyond 4000000000 in instance 'b'"},
        {"*PART, NAME=P\n" NODES "*ELEMENT, TYPE=C3D4, ELSET=" LONG "\n" ONE
         "*INSTANCE, NAME=a, PART=P\n*INSTANCE, NAME=aaaaaa, PART=P\n",
         ": set 'aaaaaa." LONG "' is longer than 255 bytes"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        expect_refused(cases[i].words, cases[i].said);
    }
    /* a message has the number of the file */
    expect_refused("*PART, NAME=a\n" NODES SOLIDS ONE
                   "*PART, NAME=b\n*INSTANCE, NAME=i, PART=a\n*INSTANCE, NAME=j, PART=b\n" SOLIDS
                   "7, 10, 20\n",
                   ":15: element 7 has 2 of 4 nodes");
    expect_refused("*PART, NAME=a\n" NODES SOLIDS ONE
                   "*PART, NAME=b\n*INSTANCE, NAME=i, PART=a\n*INSTANCE, NAME=j, PART=b\n" SOLIDS
                   "7, 10, 20, 30, 40\n7, 10, 20, 30, 40\n",
                   ":15: element 7 is defined twice");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_volume_sets),  cmocka_unit_test(test_node_sets),
        cmocka_unit_test(test_surface_sets), cmocka_unit_test(test_parts),
        cmocka_unit_test(test_instances),    cmocka_unit_test(test_names),
    };
    return cmocka_run_group_tests_name("inp_sets", tests, set_up, tear_down);
}
