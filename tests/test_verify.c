/* The checks of rhegma verify hold, on any number of ranks, and fail when what is simulated is not what
 * theory speaks of. Prints TAP from rank 0. */
#include <math.h>
#include <mpi.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "../src/verify_check.h"
#include "tap.h"

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

/* ---- checks ---- */

static const struct {
    const char *name;
    rg_verify_check *check;
    const char *change;
    const char *failing; /* for each row after the change: f fails, h holds, ? either */
} checks[] = {
    {"pressure wave", rg_verify_pressure_wave, "material.young=262e9", "f"},
    {"shear wave", rg_verify_shear_wave, "material.poisson=0.22", "f"},
    {"patch test", rg_verify_patch, "initial.displacement.x=1.0001e-3*x + 0.7e-3*y - 0.4e-3*z", "ff"},
    {"patch test, y", rg_verify_patch, "initial.displacement.y=-0.3e-3*x - 0.8001e-3*y + 0.5e-3*z", "ff"},
    {"patch test, z", rg_verify_patch, "initial.displacement.z=0.6e-3*x - 0.9e-3*y + 1.1001e-3*z", "ff"},
    {"patch test, stiffer", rg_verify_patch, "material.young=260.1e9", "hf"},
    {"rotation", rg_verify_rotation, "initial.displacement.x=-y - 0.99*x", "ff"},
    {"rotation, y", rg_verify_rotation, "initial.displacement.y=x - 0.99*y", "ff"},
    {"energy", rg_verify_energy, "interface.form=incomplete", "f"},
    {"spall, denser", rg_verify_spall, "material.density=4000", "ff?"},
    {"spall, weaker", rg_verify_spall, "interface.strength=150e6", "?f?"},
    {"separation", rg_verify_separation, "interface.energy=36", "hf"},
    {"identity", rg_verify_identity, "mesh.seed=2", "hf"},
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
} wanted[] = {
    {"speed of pressure waves (m/s)", "8905.95", {1e-3, 1e-3}},
    {"speed of shear waves (m/s)", "5395.92", {1e-3, 1e-3}},
    {"patch test: displacement / largest", "0", {1e-12, 2e-6}},
    {"patch test: stress / E", "0", {1e-12, 2e-8}},
    {"turned by 90 degrees: velocity / wave speed", "0", {1e-12, 1e-4}},
    {"turned by 90 degrees: stress / E", "0", {1e-12, 1e-5}},
    {"energy of a free bar, change in 3000 steps", "0", {1e-3, 1e-3}},
    {"spall: stress of the waves (Pa)", "2.00004e+08", {0.01, 0.01}},
    {"spall: time of first fracture (s)", "2.24569e-07", {0.03, 0.03}},
    {"spall: energy error", "0", {0.01, 0.01}},
    {"separation: area (m2)", "1e-08", {1e-9, 1e-6}},
    {"separation: energy lost, G_c x area (J)", "3.4e-07", {0.02, 0.02}},
    {"momentum of fragments, change", "0", {1e-12, 1e-6}},
    {"same bits on all ranks, 1 thread each", NULL, {0, 0}},
    {"same bits on all ranks, 2 threads each", NULL, {0, 0}},
    {"same bits on all ranks, 3 threads each", NULL, {0, 0}},
};

/* Whether a row is one of these, word for word. */
static bool is_wanted(const rg_verify_row *row) {
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) {
        if (strcmp(row->check, wanted[i].check) == 0) {
            return row->limit == wanted[i].limit[SINGLE] &&
                   (wanted[i].theory == NULL || strcmp(row->theory, wanted[i].theory) == 0);
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
    checks[i].check(MPI_COMM_WORLD, &none, &right);
    report(right.rows > 0 && as_expected(&right, &"hhhhhhhh"[RG_VERIFY_ROWS - right.rows]), checks[i].name,
           "holds");
    for (int k = 0; k < right.rows; k++) {
        words = words && is_wanted(&right.row[k]);
        for (int j = 0; j < k; j++) {
            words = words && strcmp(right.row[j].check, right.row[k].check) != 0;
        }
    }
    report(words, checks[i].name, "says what it compares, and to which limit");
    return right.rows;
}

static void test_wrong(size_t i, int rows) {
    const rg_verify_change change = {1, &checks[i].change};
    rg_verify_rows wrong = {0};
    checks[i].check(MPI_COMM_WORLD, &change, &wrong);
    report(rows == wrong.rows && as_expected(&wrong, checks[i].failing), checks[i].name,
           "fails with other physics");
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    test_rows();
    test_words_of_rows();
    test_trial();
    int rows = 0;
    for (size_t i = 0; i < sizeof checks / sizeof *checks; i++) {
        rows = i > 0 && checks[i].check == checks[i - 1].check ? rows : test_right(i);
        test_wrong(i, rows);
    }
    return finish();
}
