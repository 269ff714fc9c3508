/* fragments.csv and what the summary tells of fragments, to the letter, from rows of the test's own, on any
 * number of ranks. Prints TAP from rank 0. */
#include "output/fragment_table.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/error.h"
#include "base/mem.h"
#include "diagnostics/overlap.h"
#include "support/tap_memory.h"

/* ---- stand-ins ---- */

static int warnings, searches;
static char warned[300];
static double cell_asked;
static bool overlap;
static rg_fragment *row;
static size_t own;

void rg_fatal(int status, const char *format, ...) {
    (void)status;
    printf("Bail out! %s\n", format);
    abort();
}

void rg_warn(const char *format, ...) {
    va_list args;
    va_start(args, format);
    vsnprintf(warned, sizeof warned, format, args);
    va_end(args);
    warnings++;
}

size_t __wrap_rg_fragments_measure(const rg_solver *s, const rg_fragment_parts *p, rg_fragment **rows);
bool __wrap_rg_overlap_find(const rg_solver *s, const rg_fragment_parts *p, double cell, rg_gid pair[2]);

size_t __wrap_rg_fragments_measure(const rg_solver *s, const rg_fragment_parts *p, rg_fragment **rows) {
    (void)s;
    (void)p;
    *rows = RG_NEW(rg_fragment, own + 1);
    memcpy(*rows, row, own * sizeof *row);
    return own;
}

bool __wrap_rg_overlap_find(const rg_solver *s, const rg_fragment_parts *p, double cell, rg_gid pair[2]) {
    (void)s;
    (void)p;
    searches++;
    cell_asked = cell;
    pair[0] = overlap ? 5 : INT64_MAX;
    pair[1] = overlap ? 9 : INT64_MAX;
    return overlap;
}

/* ---- rows ---- */

static char place[200];

static const char *in(const char *name) {
    static char path[300];
    snprintf(path, sizeof path, "%s/%s", place, name);
    return path;
}

/* The whole is 16: of these, one of exactly a half, one just above a quarter, one of a quarter, and dust. */
enum { ROWS = 7 };
static const double mass[ROWS] = {8, 3.5, 2.5, 1, 0.6, 0.4, 1e-25};

static rg_fragment row_of(int k) {
    rg_fragment f = {.id = 3 + 2 * k, .elements = 10 + k, .mass = mass[k], .volume = 0.25 * (k + 1)};
    for (int c = 0; c < 3; c++) {
        f.centroid[c] = 100 * k + c;
        f.momentum[c] = 100 * k + 10 + c;
        f.inertia[c] = 100 * k + 20 + c;
        f.size[c] = 100 * k + 30 + c;
        for (int d = 0; d < 3; d++) {
            f.axis[c][d] = 100 * k + 40 + 3 * c + d;
        }
    }
    f.kinetic = 100 * k + 60;
    f.rotational = 100 * k + 61;
    return f;
}

/* Seven elements on rank 0, as large as the rows say; padding counts for nothing. */
static void fill_domain(rg_domain *d) {
    static rg_gid id[RG_LANES];
    static rg_real geom[RG_GEOM_BLOCK];
    for (size_t k = 0; k < RG_LANES; k++) {
        id[k] = rank == 0 && k < ROWS ? (rg_gid)k : -1;
        geom[rg_geom_index(k, RG_GEOM_VOLUME)] = k < ROWS ? (rg_real)(0.25 * (double)(k + 1)) : 1;
    }
    *d = (rg_domain){.blocks = 1, .id = id, .geom = geom};
}

/* Fragments as they are looked for: number 0, and another one on the last rank. */
static void look(rg_fragment_table *t, const rg_solver *s, bool several) {
    rg_fragment_label label[2] = {{.id = 0}, {.id = 4}};
    rg_fragment_parts p = {.count = several && s->rank == s->ranks - 1 ? 2 : 1, .label = label};
    if (rg_fragment_table_looks(t)) {
        rg_fragment_table_look(t, s, &p);
    }
}

/* Some of `count` rows on each rank, none on the last of several. */
static void distribution(int count, int ranks) {
    int workers = ranks > 1 ? ranks - 1 : 1;
    int from = rank < workers ? rank * count / workers : count,
        to = rank < workers ? (rank + 1) * count / workers : count;
    rg_free(row);
    row = RG_NEW(rg_fragment, ROWS);
    own = (size_t)(to - from);
    for (int k = from; k < to; k++) {
        row[k - from] = row_of(k);
    }
}

static const char header[] =
    "step,id,elements,time,mass,volume,centroid_x,centroid_y,centroid_z,momentum_x,momentum_y,momentum_z,"
    "kinetic,rotational,inertia_1,inertia_2,inertia_3,axis_1_x,axis_1_y,axis_1_z,axis_2_x,axis_2_y,axis_2_z,"
    "axis_3_x,axis_3_y,axis_3_z,size_1,size_2,size_3\n";

static void append(char *text, const char *format, ...) __attribute__((format(printf, 2, 3)));

static void append(char *text, const char *format, ...) {
    va_list args;
    va_start(args, format);
    vsprintf(text + strlen(text), format, args);
    va_end(args);
}

static void append_row(char *text, int step, double time, int k) {
    append(text, "%d,%d,%d,%.17g,%.17g,%.17g", step, 3 + 2 * k, 10 + k, time, mass[k], 0.25 * (k + 1));
    static const int first[] = {0, 10, 60, 20, 40, 30}, length[] = {3, 3, 2, 3, 9, 3};
    for (int g = 0; g < 6; g++) {
        for (int i = 0; i < length[g]; i++) {
            append(text, ",%d", 100 * k + first[g] + i);
        }
    }
    append(text, "\n");
}

static bool table_is(const char *wanted) {
    char found[20000] = "";
    FILE *f = fopen(in("fragments.csv"), "r");
    if (f != NULL) {
        found[fread(found, 1, sizeof found - 1, f)] = '\0';
        fclose(f);
    }
    if (strcmp(found, wanted) != 0) {
        printf("# found:\n%s# wanted:\n%s", found, wanted);
    }
    return strcmp(found, wanted) == 0;
}

static bool summary_is(const rg_fragment_table *t, const char *wanted) {
    char *found = NULL;
    size_t size = 0;
    FILE *f = open_memstream(&found, &size);
    rg_fragment_table_summary(t, f);
    fclose(f);
    bool good = strcmp(found, wanted) == 0;
    if (!good) {
        printf("# found:\n%s# wanted:\n%s", found, wanted);
    }
    free(found);
    return good;
}

/* ---- cases ---- */

static rg_case input;
static rg_part part = {.total = 300};
static rg_domain domain;
static rg_solver solver = {.input = &input, .part = &part, .domain = &domain};

static void check_table(void) {
    char wanted[20000];
    strcpy(wanted, header);
    rg_fragment_table *t = rg_fragment_table_open(&solver);
    report(rg_fragment_table_due(t, &solver, false) && rg_fragment_table_due(t, &solver, true), "table",
           "due each time");
    solver.step = 12;
    solver.time = 1.5e-7;
    distribution(ROWS, solver.ranks);
    rg_fragment_table_take(t, &solver, NULL);
    rg_fragment_mark mark = rg_fragment_table_sync(t);
    for (int k = 0; k < ROWS; k++) {
        append_row(wanted, 12, 1.5e-7, k);
    }
    int64_t length = (int64_t)strlen(wanted);
    report(rank != 0 || table_is(wanted), "table", "all columns of all rows");
    report(mark.bytes == (rank == 0 ? length : 0) && isinf(mark.overlap_time), "table", "where it stands");
    look(t, &solver, true);
    double volume = 0.25 * (1 + 2 + 3 + 4 + 5 + 6 + 7), cell = 2 * cbrt(6 * sqrt(2) * volume / 300);
    report(searches == 1 && fabs(cell_asked - cell) < 1e-15 && warnings == 0 && t->count == ROWS, "table",
           "looks for overlaps in cells of two elements");
    report(rank != 0 ||
               summary_is(
                   t, "  \"fragments\": 7,\n  \"fragment_mass_heaviest_kg\": 8,\n"
                      "  \"fragment_mass_bins\": [[8, 1, 8], [4, 2, 6], [1, 2, 1.6000000000000001], [0.5, 1, "
                      "0.40000000000000002], [1.7347234759768071e-18, 1, 1e-25]],\n"),
           "summary", "bins, each to half of its upper bound");
    solver.step = 13;
    rg_fragment_table_take(t, &solver, NULL); /* a run that goes on does not have it */
    rg_fragment_table_close(t);
    mark.overlap_time = 3;
    mark.overlap[0] = 7;
    mark.overlap[1] = 8;
    mark.bytes = length;
    t = rg_fragment_table_reopen(&solver, &mark);
    report(t->overlap_time == 3 && t->overlap[0] == 7 && t->overlap[1] == 8, "restart",
           "keeps the first overlap");
    solver.step = 14;
    distribution(2, solver.ranks);
    searches = 0;
    rg_fragment_table_take(t, &solver, NULL);
    look(t, &solver, true);
    append_row(wanted, 14, 1.5e-7, 0);
    append_row(wanted, 14, 1.5e-7, 1);
    mark = rg_fragment_table_sync(t);
    report(rank != 0 || table_is(wanted), "restart", "goes on behind its mark");
    report(searches == 0 && mark.overlap_time == 3 && mark.overlap[0] == 7 && mark.overlap[1] == 8, "restart",
           "looks for no other overlap");
    report(rank != 0 || summary_is(t, "  \"fragments\": 2,\n  \"fragment_mass_heaviest_kg\": 8,\n"
                                      "  \"fragment_mass_bins\": [[11.5, 1, 8], [5.75, 1, 3.5]],\n"
                                      "  \"overlap_time_s\": 3,\n  \"overlap_fragments\": [7, 8],\n"),
           "summary", "of the last output alone");
    rg_fragment_table_close(t);
}

static void check_overlap(void) {
    rg_fragment_table *t = rg_fragment_table_open(&solver);
    searches = 0;
    overlap = true;
    solver.step = 20;
    solver.time = 2.25e-7;
    look(t, &solver, false);
    report(searches == 0 && warnings == 0, "overlap", "one piece alone has none");
    look(t, &solver, true);
    solver.time = 3e-7;
    look(t, &solver, true);
    report(searches == 1 && warnings == (rank == 0), "overlap", "said once");
    report(rank != 0 || strstr(warned, "fragments 5 and 9 overlap at 2.25e-07 s (step 20): ") == warned,
           "overlap", "which, and when");
    rg_fragment_mark mark = rg_fragment_table_sync(t);
    report(mark.overlap_time == 2.25e-7 && mark.overlap[0] == 5 && mark.overlap[1] == 9, "overlap",
           "is remembered");
    rg_fragment_table_close(t);
}

static void check_when(void) {
    char wanted[20000];
    input.output.fragments = RG_FRAGMENTS_LAST;
    rg_fragment_table *t = rg_fragment_table_open(&solver);
    report(!rg_fragment_table_due(t, &solver, false) && rg_fragment_table_due(t, &solver, true), "table",
           "due at the end");
    rg_fragment_table_sync(t);
    strcpy(wanted, header);
    report(rank != 0 || table_is(wanted), "table", "has its header from the start");
    report(rank != 0 || summary_is(t, ""), "summary", "nothing where nothing was counted");
    rg_fragment_table_close(t);
    if (rank == 0) {
        remove(in("fragments.csv"));
    }
    MPI_Barrier(MPI_COMM_WORLD);
    input.output.fragments = RG_FRAGMENTS_NONE;
    t = rg_fragment_table_open(&solver);
    bool due = rg_fragment_table_due(t, &solver, true);
    rg_fragment_mark mark = rg_fragment_table_sync(t);
    rg_fragment_table_close(t);
    t = rg_fragment_table_reopen(&solver, &mark);
    overlap = true;
    solver.time = 4e-7;
    look(t, &solver, true);
    report(t->overlap_time == 4e-7 &&
               (rank != 0 || summary_is(t, "  \"overlap_time_s\": 3.9999999999999998e-07,\n"
                                           "  \"overlap_fragments\": [5, 9],\n")),
           "overlap", "is told without a table");
    report(!due && !rg_fragment_table_due(t, &solver, true) && mark.bytes == 0 &&
               access(in("fragments.csv"), F_OK) != 0,
           "table", "none where none is asked for");
    rg_fragment_table_close(t);
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    snprintf(place, sizeof place, "/tmp/test_fragment_table.XXXXXX");
    if (rank == 0 && mkdtemp(place) == NULL) {
        rg_fatal(RG_FAILURE, "cannot make a directory");
    }
    MPI_Bcast(place, sizeof place, MPI_CHAR, 0, MPI_COMM_WORLD);
    input.output.dir = place;
    solver.comm = MPI_COMM_WORLD;
    solver.rank = rank;
    MPI_Comm_size(MPI_COMM_WORLD, &solver.ranks);
    fill_domain(&domain);
    check_table();
    check_overlap();
    check_when();
    rg_free(row);
    if (rank == 0) {
        failures += rmdir(place) != 0;
    }
    return finish_with_nothing_left();
}
