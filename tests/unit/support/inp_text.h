/* Abaqus input in words, and what comes of it. Include after cmocka.h. */
#ifndef RG_INP_TEXT_H
#define RG_INP_TEXT_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/error.h"
#include "mesh/import/inp_read.h"
#include "support/mesh_text.h"

static double scale;
static bool split;

static inline void read_and_print(void) {
    FILE *nowhere = fopen("/dev/null", "w");
    rg_mesh *m = rg_inp_read("a.inp", NULL, &(rg_import_how){.scale = scale, .split = split}, nowhere);
    print_mesh(m, stderr);
}

static inline void read_and_report(void) {
    rg_mesh_free(rg_inp_read("a.inp", NULL, &(rg_import_how){.scale = scale, .split = split}, stderr));
}

static inline void write_input(const char *words) {
    FILE *f = fopen("a.inp", "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(words, 1, strlen(words), f), strlen(words));
    assert_int_equal(fclose(f), 0);
}

static inline void expect(const char *words, const char *said) {
    write_input(words);
    expect_said(read_and_print, RG_OK, said);
}

/* Refused with "rhegma: a.inp" and the rest. */
static inline void expect_refused(const char *words, const char *rest) {
    char line[1200];
    write_input(words);
    snprintf(line, sizeof line, "rhegma: a.inp%s\n", rest);
    expect_said(read_and_print, RG_USAGE, line);
}

/* Refused with all of the words. */
static inline void expect_said_from(const char *words, const char *said) {
    write_input(words);
    expect_said(read_and_print, RG_USAGE, said);
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

static char folder[] = "/tmp/test_inp.XXXXXX";

static inline int set_up(void **state) {
    (void)state;
    scale = 1;
    return mkdtemp(folder) == NULL || chdir(folder) != 0;
}

static inline int tear_down(void **state) {
    (void)state;
    unlink("a.inp");
    return chdir("/") != 0 || rmdir(folder) != 0;
}

#endif
