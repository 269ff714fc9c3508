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
    {"patch test, stiffer", rg_verify_patch, "material.young=260.1e9", "hf"},
    {"rotation", rg_verify_rotation, "initial.displacement.x=-y - 0.99*x", "ff"},
    {"energy", rg_verify_energy, "interface.form=incomplete", "f"},
    {"spall, denser", rg_verify_spall, "material.density=4000", "ff?"},
    {"spall, weaker", rg_verify_spall, "interface.strength=150e6", "?f?"},
    {"separation", rg_verify_separation, "interface.energy=36", "hf"},
    {"identity", rg_verify_identity, "mesh.seed=2", "hf"},
};

static bool as_expected(const rg_verify_rows *rows, const char *failing) {
    bool good = (int)strlen(failing) <= rows->rows;
    for (int k = 0; failing[k] != '\0' && good; k++) {
        good = failing[k] == '?' || rg_verify_holds(&rows->row[k]) == (failing[k] == 'h');
    }
    return good;
}

static void test_check(size_t i) {
    rg_verify_change change = {0, NULL};
    rg_verify_rows right = {0}, wrong = {0};
    checks[i].check(MPI_COMM_WORLD, &change, &right);
    report(right.rows > 0 && as_expected(&right, &"hhhhhhhh"[RG_VERIFY_ROWS - right.rows]), checks[i].name,
           "holds");
    change = (rg_verify_change){1, &checks[i].change};
    checks[i].check(MPI_COMM_WORLD, &change, &wrong);
    report(right.rows == wrong.rows && as_expected(&wrong, checks[i].failing), checks[i].name,
           "fails with other physics");
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    test_rows();
    for (size_t i = 0; i < sizeof checks / sizeof *checks; i++) {
        test_check(i);
    }
    return finish();
}
