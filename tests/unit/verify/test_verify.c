/* The checks of rhegma verify hold, on any number of ranks, and fail when what is simulated is not what
 * theory speaks of. Prints TAP from rank 0. */
#include <math.h>
#include <mpi.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/mem.h"
#include "diagnostics/state_hash.h"
#include "domain/element.h"
#include "quadrature.h"
#include "verify/check.h"
#include "support/tap_memory.h"

/* ---- rows ---- */

static rg_verify_row row_of(double theory, double measured, double limit) {
    rg_verify_rows rows = {0};
    rg_verify_value(&rows, "row", theory, measured, limit);
    return rows.row[0];
}

static void test_rows(void) {
    static const struct {
        double theory, measured, limit;
        bool holds;
    } known[] = {
        {100, 100.9, 0.01, true}, {100, 101.1, 0.01, false}, {100, 98.9, 0.01, false}, {-2, -2, 0, true},
        {-2, 2, 0.1, false},      {0, -1e-3, 1e-2, true},    {0, -2e-2, 1e-2, false},  {0, NAN, 1, false},
        {1, NAN, 1, false},       {1, INFINITY, 1, false},   {0, INFINITY, 1, false},
    };
    bool good = true;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        rg_verify_row row = row_of(known[i].theory, known[i].measured, known[i].limit);
        good = good && rg_verify_holds(&row) == known[i].holds;
    }
    report(good, "rows", "hold within their limit and never without a number");
    rg_verify_rows rows = {0};
    rg_verify_hash(&rows, "same", 7, 7);
    rg_verify_hash(&rows, "other", 7, 8);
    report(rows.rows == 2 && rg_verify_holds(&rows.row[0]) && !rg_verify_holds(&rows.row[1]), "rows",
           "hashes are equal or not");
}

static void test_words_of_rows(void) {
    rg_verify_rows rows = {0};
    rg_verify_value(&rows, "a value", 123456789, 123456, 0.25);
    rg_verify_value(&rows, "nothing", 0, -0.0625, 0.125);
    rg_verify_hash(&rows, "bits", 0xab, UINT64_C(0x123456789abcdef0));
    char text[512] = "";
    FILE *out = fmemopen(text, sizeof text, "w");
    rg_verify_print_head(out);
    for (int k = 0; k < rows.rows; k++) {
        rg_verify_print(&rows.row[k], out);
    }
    fclose(out);
    static const char expected[] = "check                                                  theory         "
                                   "measured  deviation    limit  ok\n"
                                   "a value                                           1.23457e+08           "
                                   "123456    1.0e+00    2e-01  NO\n"
                                   "nothing                                                     0           "
                                   "-0.062    6.2e-02    1e-01  yes\n"
                                   "bits                                         00000000000000ab "
                                   "123456789abcdef0        inf    0e+00  NO\n";
    report(strcmp(text, expected) == 0, "rows", "are told in columns");
}

/* ---- a trial ---- */

#define BAR                                                                                                  \
    "mesh: {cells: [2, 2, 4], size: [1e-3, 1e-3, 2e-3]}\n"                                                   \
    "material: {model: neo-hookean, young: 260e9, poisson: 0.21, density: 3690}\n"                           \
    "interface: {law: none}\n"                                                                               \
    "initial: {velocity: {z: z}}\n"

/* Goes through a trial that takes up to `steps` steps, or ends at `end` steps of rest; whether its states
 * come at the times that they must. */
static bool times_of(double end, int steps) {
    static const char text[] = BAR "time: {end: 1, steps: 1}\n";
    char words[2][64];
    const char *set[] = {words[0], words[1], "material.density=3700"};
    rg_verify_change change = {3, set};
    snprintf(words[0], sizeof words[0], "time.end=1");
    snprintf(words[1], sizeof words[1], "time.steps=%d", steps);
    rg_trial *t = rg_trial_begin(text, &change, MPI_COMM_WORLD);
    double dt = t->dt;
    if (end > 0) { /* once the step is known */
        t->input->time.end = end * dt;
    }
    bool good = t->theory->time.steps == 1 && t->theory->material.density == 3690 &&
                t->input->time.steps == steps && t->input->material.density == 3700 && t->states == 0;
    int last = end > 0 ? (int)ceil(end) : steps, n = 0;
    for (; rg_trial_next(t); n++) {
        double time = end > 0 ? fmin(n, end) : n;
        good = good && t->states == n + 1 && t->solver->step == n &&
               fabs(t->solver->time - time * dt) < 1e-12 * dt;
        good = good && rg_trial_ledger(t)->step == n;
    }
    good = good && n == last + 1 && (end <= 0 || t->solver->time == t->input->time.end);
    rg_trial_end(t);
    return good;
}

static void test_trial(void) {
    report(times_of(0, 3), "trial", "takes its steps");
    report(times_of(4.5, 100), "trial", "ends at its time with a shorter step");
    report(times_of(3, 100), "trial", "ends at its time with a whole step");
}

/* An element without volume has no stress: that is no state to go on from. */
static void test_end_of_what_is_not_finite(void) {
    const char *set[] = {"initial.displacement.z=-2*z", "time.steps=5"};
    const rg_verify_change change = {2, set};
    rg_trial *t = rg_trial_begin(BAR "time: {end: 1, steps: 1}\n", &change, MPI_COMM_WORLD);
    int states = 0;
    while (rg_trial_next(t)) {
        states++;
    }
    report(states == 1, "trial", "ends where the state is not finite");
    rg_trial_end(t);
}

/* What was seen of each slot: Gauss points, nodes. */
typedef struct {
    int points, nodes;
    double off; /* largest deviation of an axial stress (Pa) */
} seen;

#define GROWTH 1.0 /* of the strain along the bar (1/m) */

/* Uniaxial strain GROWTH z of a linear-elastic solid: P F^T/J is P = (lambda + 2 mu) GROWTH z. */
static void see_point(void *context, const rg_solver *s, size_t slot, const double stress[6]) {
    seen *at = (seen *)context + slot;
    const double *corner = s->domain->corner + 12 * slot;
    double z = (RG_GAUSS_B - RG_GAUSS_A) * corner[3 * (at->points % 4) + 2];
    for (int k = 0; k < 4; k++) {
        z += RG_GAUSS_A * corner[3 * k + 2];
    }
    const double modulus = 260e9 * 0.79 / (1.21 * 0.58);
    at->off = fmax(at->off, fabs(stress[2] - modulus * GROWTH * z));
    at->points++;
}

static void see_node(void *context, const rg_solver *s, size_t slot, int node) {
    seen *at = (seen *)context + slot;
    (void)s;
    at->nodes += node == at->nodes; /* each in its turn */
}

/* On a mesh with tiles of several blocks. */
static void test_visits(void) {
    const char *set[] = {"mesh={cells: [7, 7, 8], size: [1e-3, 1e-3, 2e-3], jitter: 0.2}",
                         "material.model=linear-elastic", "initial={displacement: {z: 0.5*z*z}}"};
    const rg_verify_change change = {3, set};
    rg_trial *t = rg_trial_begin(BAR "time: {end: 1, steps: 1}\n", &change, MPI_COMM_WORLD);
    const rg_domain *d = t->solver->domain;
    seen *at = RG_NEW(seen, d->blocks * RG_LANES);
    rg_trial_next(t);
    rg_trial_stresses(t, see_point, at);
    rg_trial_nodes(t, see_node, at);
    bool points = d->tile[0].end - d->tile[0].begin > 1, nodes = true;
    double off = 0;
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        bool own = d->id[slot] >= 0;
        points = points && at[slot].points == (own ? RG_GAUSS : 0);
        nodes = nodes && at[slot].nodes == (own ? RG_NODES : 0);
        off = fmax(off, at[slot].off);
    }
    report(points, "trial", "shows each Gauss point of its elements once");
    report(nodes, "trial", "shows each node of its elements once");
    /* rounding of the strain, 2e-3 at most */
    report(off / 260e9 < (sizeof(rg_real) == 4 ? 2e-8 : 3e-17), "trial", "shows the stress of each point");
    rg_free(at);
    rg_trial_end(t);
}

static void test_measures(void) {
    const double a[3] = {2, -3, 6}, b[3] = {3, -1, 8};
    report(fabs(rg_verify_change_of(a, b) - 3.0 / 7) < 1e-15 && rg_verify_change_of(a, a) == 0, "measures",
           "the change of a vector, over its length");
    rg_energy e;
    unsigned char byte[sizeof e];
    for (size_t i = 0; i < sizeof byte; i++) {
        byte[i] = (unsigned char)(37 * i);
    }
    memcpy(&e, byte, sizeof e);
    uint64_t hash = rg_energy_hash(&e);
    bool good = true;
    for (size_t i = 0; i < sizeof byte; i++) {
        byte[i] ^= 1;
        memcpy(&e, byte, sizeof e);
        good = good && rg_energy_hash(&e) != hash;
        byte[i] ^= 1;
    }
    memcpy(&e, byte, sizeof e);
    report(good && rg_energy_hash(&e) == hash, "measures", "the bits of the ledger, all of them");
}

/* ---- threads ---- */

void __real_omp_set_num_threads(int threads);
void __wrap_omp_set_num_threads(int threads);

static char threads_set[64]; /* a digit for each time that their number is set */

void __wrap_omp_set_num_threads(int threads) {
    size_t n = strlen(threads_set);
    if (n + 1 < sizeof threads_set) {
        threads_set[n] = (char)('0' + threads);
    }
    __real_omp_set_num_threads(threads);
}

/* ---- the table ---- */

static int ranks_inside;

static void pass_twice(MPI_Comm comm, const rg_verify_change *change, rg_verify_rows *rows) {
    MPI_Comm_size(comm, &ranks_inside);
    rg_verify_value(rows, "first", 2, change->count == 0 ? 2 : 3, 0);
    rg_verify_value(rows, "second", 0, 0, 0);
}

static void fail_once(MPI_Comm comm, const rg_verify_change *change, rg_verify_rows *rows) {
    (void)comm;
    (void)change;
    rg_verify_value(rows, "third", 0, 0, 0);
    rg_verify_value(rows, "fourth", 1, 2, 0.5);
}

/* Runs checks on so many ranks; whether it tells each row on rank 0 and ends so on all. */
static bool runs(rg_verify_check *const *check, size_t checks, int ranks, int status, const char *rows,
                 const char *end) {
    char text[2048] = "", words[64] = "";
    FILE *out = fmemopen(text, sizeof text, "w");
    ranks_inside = 0;
    bool good = rg_verify_run(check, checks, ranks, MPI_COMM_WORLD, out) == status;
    fclose(out);
    good = good && ranks_inside == (rank < ranks ? ranks : 0);
    if (rank > 0) {
        return good && text[0] == '\0';
    }
    double seconds = -1;
    snprintf(words, sizeof words, " %d ranks x 1 threads\ncheck ", ranks);
    good = good && strncmp(text, "rhegma ", 7) == 0 && strstr(text, words) != NULL;
    char *last = strstr(text, end);
    good = good && last != NULL && sscanf(last + strlen(end), ", in %lf s\n", &seconds) == 1 &&
           seconds >= 0 && seconds < 10;
    const char *at = strchr(text, '\n');
    for (const char *row = rows; good && *row != '\0';
         row += strcspn(row, " ") + (strchr(row, ' ') != NULL)) {
        snprintf(words, sizeof words, "\n%.*s ", (int)strcspn(row, " "), row);
        at = strstr(at, words);
        good = at != NULL && at < last;
        at = good ? at + 1 : at;
    }
    return good;
}

static void test_table(void) {
    static rg_verify_check *const check[] = {pass_twice, fail_once};
    for (int ranks = 1; ranks <= 2; ranks++) {
        report(runs(check, 1, ranks, RG_OK, "check first second", "\nall checks hold"), "table",
               "tells that all hold");
        report(runs(check, 2, ranks, RG_FAILURE, "check first second third fourth", "\nFAILED"), "table",
               "tells that one failed");
    }
}

/* ---- checks ---- */

/* A state as it begins. */
#define AT_ONCE "time.end=1e-30", "boundary=[]"
#define MOVING_CORNER(along, x, y, z)                                                                        \
    {                                                                                                        \
        "rotation, moving at " x ", " y ", " z, rg_verify_rotation,                                          \
            {AT_ONCE, "initial.velocity={" along ": '" x " && " y " && " z " ? 5 : 0'}"}, "fh", {            \
            5 / BAR_SPEED                                                                                    \
        }                                                                                                    \
    }

#define MOVED     (1e-5 / 1.7e-3)        /* by 1e-5 times the size, over the largest displacement */
#define AXIAL     (0.79 / (1.21 * 0.58)) /* (lambda + 2 mu)/E */
#define SHEAR     (0.5 / 1.21)           /* mu/E */
#define BAR_SPEED 8394.0845651727        /* sqrt(E/rho) (m/s) */

static const struct {
    const char *name;
    rg_verify_check *check;
    const char *change[4];
    const char *failing; /* for each row after the change: f fails, h holds, ? either */
    double deviation[2]; /* of the first rows, within 1 % (stresses are not quite linear); 0: any */
} checks[] = {
    {"pressure wave", rg_verify_pressure_wave, {"material.young=262e9"}, "f", {0}},
    {"shear wave", rg_verify_shear_wave, {"material.poisson=0.22"}, "f", {0}},
    {"waves that do not swing", rg_verify_shear_wave, {"time.end=3e-8"}, "f", {INFINITY}},
    {"patch test, xx",
     rg_verify_patch,
     {AT_ONCE, "initial.displacement.x=1.0e-3*x + 0.7e-3*y + -0.4e-3*z + 1e-5*x"},
     "ff",
     {MOVED, 1e-5 * AXIAL}},
    {"patch test, yy",
     rg_verify_patch,
     {AT_ONCE, "initial.displacement.y=-0.3e-3*x + -0.8e-3*y + 0.5e-3*z + 1e-5*y"},
     "ff",
     {MOVED, 1e-5 * AXIAL}},
    {"patch test, zz",
     rg_verify_patch,
     {AT_ONCE, "initial.displacement.z=0.6e-3*x + -0.9e-3*y + 1.1e-3*z + 1e-5*z"},
     "ff",
     {MOVED, 1e-5 * AXIAL}},
    {"patch test, yz",
     rg_verify_patch,
     {AT_ONCE, "initial.displacement.y=-0.3e-3*x + -0.8e-3*y + 0.5e-3*z + 1e-5*z"},
     "ff",
     {MOVED, 1e-5 * SHEAR}},
    {"patch test, zx",
     rg_verify_patch,
     {AT_ONCE, "initial.displacement.z=0.6e-3*x + -0.9e-3*y + 1.1e-3*z + 1e-5*x"},
     "ff",
     {MOVED, 1e-5 * SHEAR}},
    {"patch test, xy",
     rg_verify_patch,
     {AT_ONCE, "initial.displacement.x=1.0e-3*x + 0.7e-3*y + -0.4e-3*z + 1e-5*y"},
     "ff",
     {MOVED, 1e-5 * SHEAR}},
    {"patch test, inside out",
     rg_verify_patch,
     {AT_ONCE, "initial.displacement.x=-3*x"},
     "ff",
     {0, INFINITY}},
    {"patch test, stiffer", rg_verify_patch, {AT_ONCE, "material.young=260.1e9"}, "hf", {0}},
    {"rotation, moving along x",
     rg_verify_rotation,
     {AT_ONCE, "initial.velocity={x: 5}"},
     "fh",
     {5 / BAR_SPEED}},
    {"rotation, moving along y",
     rg_verify_rotation,
     {AT_ONCE, "initial.velocity={y: -5}"},
     "fh",
     {5 / BAR_SPEED}},
    {"rotation, moving along z",
     rg_verify_rotation,
     {AT_ONCE, "initial.velocity={z: 5}"},
     "fh",
     {5 / BAR_SPEED}},
    MOVING_CORNER("x", "x < 1e-5", "y < 1e-5", "z < 1e-5"),
    MOVING_CORNER("y", "x > 99e-5", "y < 1e-5", "z < 1e-5"),
    MOVING_CORNER("z", "x < 1e-5", "y > 99e-5", "z < 1e-5"),
    MOVING_CORNER("x", "x > 99e-5", "y > 99e-5", "z < 1e-5"),
    MOVING_CORNER("y", "x < 1e-5", "y < 1e-5", "z > 99e-5"),
    MOVING_CORNER("z", "x > 99e-5", "y < 1e-5", "z > 99e-5"),
    MOVING_CORNER("x", "x < 1e-5", "y > 99e-5", "z > 99e-5"),
    MOVING_CORNER("y", "x > 99e-5", "y > 99e-5", "z > 99e-5"),
    {"rotation, stretched",
     rg_verify_rotation,
     {AT_ONCE, "initial.displacement.x=-1.001*y - x"},
     "hf",
     {0, 1e-3 * AXIAL}},
    {"energy, not all steps", rg_verify_energy, {"time.steps=50"}, "f", {0}},
    {"spall, denser", rg_verify_spall, {"material.density=4000"}, "ff?", {0}},
    {"separation", rg_verify_separation, {"interface.energy=33"}, "hf", {0}},
    {"identity", rg_verify_identity, {"mesh.seed=2"}, "hf", {0}},
};

/* What each check compares, with theory by hand: sqrt(E (1 - nu)/((1 + nu) (1 - 2 nu) rho)) and so on. */
#ifdef RG_SINGLE
enum { SINGLE = 1 };
#else
enum { SINGLE = 0 };
#endif
static const struct {
    const char *check, *theory; /* NULL: a hash */
    double limit[2];            /* in double and in single precision */
    double found;               /* deviation on these meshes; 0: rounding */
} wanted[] = {
    {"speed of pressure waves (m/s)", "8905.95", {1e-3, 1e-3}, 6.9e-6},
    {"speed of shear waves (m/s)", "5395.92", {1e-3, 1e-3}, 2.4e-6},
    {"patch test: displacement / largest", "0", {1e-12, 2e-6}, 0},
    {"patch test: stress / E", "0", {1e-12, 2e-8}, 0},
    {"turned by 90 degrees: velocity / wave speed", "0", {1e-12, 1e-4}, 0},
    {"turned by 90 degrees: stress / E", "0", {1e-12, 3e-5}, 0},
    {"energy of a free bar, change in 3000 steps", "0", {1e-8, 1e-6}, 4.2e-9},
    {"spall: stress of the waves (Pa)", "2.00004e+08", {1e-3, 1e-3}, 1.2e-4},
    {"spall: time of first fracture (s)", "2.24569e-07", {0.03, 0.03}, 1.6e-2},
    {"spall: energy error", "0", {1e-4, 1e-4}, 3.4e-5},
    {"separation: area (m2)", "1e-08", {1e-9, 1e-6}, 0},
    {"separation: energy lost, G_c x area (J)", "3.4e-07", {5e-3, 5e-3}, 2e-3},
    {"momentum of fragments, change", "0", {1e-12, 1e-6}, 0},
    {"same bits on all ranks, 1 thread each", NULL, {0, 0}, 0},
    {"same bits on all ranks, 2 threads each", NULL, {0, 0}, 0},
    {"same bits on all ranks, 3 threads each", NULL, {0, 0}, 0},
};
enum { WANTED = sizeof wanted / sizeof *wanted };
static int times_told[WANTED];

/* Whether a row is one of these, word for word. What the mesh makes of it is as large as it was: neither has
 * the measure become worse, nor has it ceased to measure. */
static bool is_wanted(const rg_verify_row *row) {
    for (size_t i = 0; i < WANTED; i++) {
        if (strcmp(row->check, wanted[i].check) == 0) {
            double found = wanted[i].found;
            times_told[i]++;
            return row->limit == wanted[i].limit[SINGLE] &&
                   (wanted[i].theory == NULL || strcmp(row->theory, wanted[i].theory) == 0) &&
                   (SINGLE || found <= 0 || (row->deviation > 0.5 * found && row->deviation < 2 * found));
        }
    }
    return false;
}

static bool as_expected(const rg_verify_rows *rows, const char *failing) {
    bool good = (int)strlen(failing) <= rows->rows;
    for (int k = 0; failing[k] != '\0' && good; k++) {
        good = failing[k] == '?' || rg_verify_holds(&rows->row[k]) == (failing[k] == 'h');
    }
    return good;
}

/* The check as it is. */
static int test_right(size_t i) {
    const rg_verify_change none = {0, NULL};
    rg_verify_rows right = {0};
    bool words = true;
    memset(threads_set, 0, sizeof threads_set);
    checks[i].check(MPI_COMM_WORLD, &none, &right);
    report(right.rows > 0 && as_expected(&right, &"hhhhhhhh"[RG_VERIFY_ROWS - right.rows]), checks[i].name,
           "holds");
    for (int k = 0; k < right.rows; k++) {
        words = is_wanted(&right.row[k]) && words;
    }
    report(words, checks[i].name, "says what it compares, and to which limit");
    bool identity = checks[i].check == rg_verify_identity; /* alone first; then as many as there were again */
    report(strcmp(threads_set, !identity   ? ""
                               : rank == 0 ? "11112131"
                                           : "112131") == 0,
           checks[i].name, "has the threads that it speaks of");
    return right.rows;
}

static void test_wrong(size_t i, int rows) {
    rg_verify_change change = {0, checks[i].change};
    rg_verify_rows wrong = {0};
    while (change.count < 4 && change.set[change.count] != NULL) {
        change.count++;
    }
    checks[i].check(MPI_COMM_WORLD, &change, &wrong);
    bool good = rows == wrong.rows && as_expected(&wrong, checks[i].failing);
    for (int k = 0; k < 2 && k < wrong.rows; k++) {
        double found = wrong.row[k].deviation, expected = checks[i].deviation[k];
        good = good && (expected <= 0 || found == expected || fabs(found / expected - 1) < 0.01);
    }
    report(good, checks[i].name, "fails with other physics, by as much as that is wrong");
}

/* The stress of the waves is the mean from 0.8 to 1.2 mm: of a bar so heavy that its one step changes
 * nothing, where the stress grows along it, the one at 1 mm. */
static void test_plateau(void) {
    const char *set[] = {"material.density=3690e12", "initial={displacement: {z: 0.5*z*z}}",
                         "interface={law: none}"};
    const rg_verify_change change = {3, set};
    rg_verify_rows rows = {0};
    rg_verify_spall(MPI_COMM_WORLD, &change, &rows);
    double expected = 260e9 * AXIAL * 1e-3; /* Pa; but for terms of the strain squared */
    report(fabs(strtod(rows.row[0].measured, NULL) / expected - 1) < 1.5e-3, "spall",
           "measures behind the front");
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    test_rows();
    test_words_of_rows();
    test_trial();
    test_end_of_what_is_not_finite();
    test_visits();
    test_measures();
    test_table();
    test_plateau();
    int rows = 0;
    for (size_t i = 0; i < sizeof checks / sizeof *checks; i++) {
        rows = i > 0 && checks[i].check == checks[i - 1].check ? rows : test_right(i);
        test_wrong(i, rows);
    }
    bool once = true;
    for (size_t i = 0; i < WANTED; i++) {
        once = once && times_told[i] == 1;
    }
    report(once, "all checks", "tell each row once");
    return finish_with_nothing_left();
}
