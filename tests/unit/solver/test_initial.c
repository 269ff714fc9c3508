/* Displacements and velocities at the start, of `initial` and its sets, against the expressions written anew,
 * and the messages about what cannot be. On any number of ranks; prints TAP from rank 0. */
#include "solver/initial.h"

#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "solver/selection.h"
#include "support/fatal.h"
#include "support/random_state.h"
#include "support/tap.h"

void rg_warn(const char *format, ...) {
    (void)format;
}

static const char values[] =
    "initial={displacement: {x: 1e-6 + 1e-3*y, z: -2e-3*x}, velocity: {y: 3 + 1e3*z}, sets: ["
    "{where: z > 2.0e-3, velocity: {x: 1e3*x}, "
    "rotation: {axis: [0, 3, 4], at: [1e-3, 2e-3, 3e-3], speed: 5e3}}, "
    "{material: steel, displacement: {y: 2e-6}, velocity: {z: 7}}, "
    "{where: z > 2.0e-3 && y > 0, velocity: {x: -9, z: 1e3*y}}]}";

/* What the last set that has an element says of a node at x. */
static void wanted(const random_state *r, rg_gid e, const double x[3], double u[3], double v[3]) {
    double corner[4][3], middle[3];
    mesh_corners(r->mesh, e, corner);
    for (int c = 0; c < 3; c++) {
        middle[c] = (corner[0][c] + corner[1][c] + corner[2][c] + corner[3][c]) / 4;
        u[c] = v[c] = 0;
    }
    if (middle[2] > 2.0e-3 && middle[1] > 0) {
        v[0] = -9;
        v[2] = 1e3 * x[1];
    } else if (mesh_material(r, e) == 1) {
        u[1] = 2e-6;
        v[2] = 7;
    } else if (middle[2] > 2.0e-3) { /* w x (x + u - a), w along (0, 0.6, 0.8) */
        double a[3] = {x[0] - 1e-3, x[1] - 2e-3, x[2] - 3e-3}, w[3] = {0, 3e3, 4e3};
        v[0] = 1e3 * x[0] + w[1] * a[2] - w[2] * a[1];
        v[1] = w[2] * a[0];
        v[2] = -w[1] * a[0];
    } else {
        u[0] = 1e-6 + 1e-3 * x[1];
        u[2] = -2e-3 * x[0];
        v[1] = 3 + 1e3 * x[2];
    }
}

static void check_values(void) {
    const char *change[] = {values, "bodies=[]"};
    random_state r = random_state_make(2, change, MPI_COMM_WORLD);
    const rg_solver *s = r.solver;
    double worst = 0;
    int kinds = 0;
    rg_initial_fill(r.solver);
    for (size_t k = 0; k < RG_NODES * s->domain->blocks * RG_LANES; k++) {
        size_t slot = k / RG_NODES;
        int n = (int)(k % RG_NODES), set = -2;
        double x[3], u[3], v[3];
        if (s->domain->id[slot] < 0) {
            continue;
        }
        mesh_node(r.mesh, s->domain->id[slot], n, x);
        wanted(&r, s->domain->id[slot], x, u, v);
        for (int c = 0; c < 3; c++) {
            worst = fmax(worst, fabs(s->u[rg_node_index(slot, n, c)] - u[c]) / 1e-6);
            worst = fmax(worst, fabs(s->velocity[rg_node_index(slot, n, c)] - v[c]) / 20);
        }
        rg_initial_of(s->input, s->domain, &s->part->volume, slot, &set);
        kinds |= 1 << (set + 1);
    }
    MPI_Allreduce(MPI_IN_PLACE, &kinds, 1, MPI_INT, MPI_BOR, MPI_COMM_WORLD);
    report(kinds == 15, "initial", "each set has elements");
    report_figure("initial", (figure){.quantity = "initial displacements and velocities, over their size",
                                      .found = worst,
                                      .bound = 4e-16,
                                      .why = ROUNDING});
    random_state_free(&r);
}

/* Whether filling ends the run with these words, on one rank. */
static bool refused(const char *initial, const char *words) {
    const char *change[] = {initial, "bodies=[]"};
    if (rank != 0) {
        return true;
    }
    random_state r = random_state_make(2, change, MPI_COMM_SELF);
    said[0] = '\0';
    expect_fatal = true;
    if (setjmp(escape) == 0) {
        rg_initial_fill(r.solver);
    }
    expect_fatal = false;
    bool good = strcmp(said, words) == 0 && fatal_status == RG_USAGE;
    if (!good) {
        printf("# %s\n", said);
    }
    random_state_free(&r);
    return good;
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    check_values();
    report(refused("initial={sets: [{where: z > 1, velocity: {x: 1}}]}",
                   "random.yaml: initial.sets[0]: no element is in it, or later sets have them all"),
           "initial", "a set without elements");
    report(refused("initial={sets: [{where: z > 0, velocity: {x: 1}}, {where: z > 0, velocity: {x: 2}}]}",
                   "random.yaml: initial.sets[0]: no element is in it, or later sets have them all"),
           "initial", "a set that a later one covers");
    report(refused(
               "initial={velocity: {y: log(x - 0.3e-3)}}",
               "random.yaml: initial.velocity.y: log(x - 0.3e-3) is not finite at (0.0003, -0.0007, 0.0011)"),
           "initial", "a velocity that is not finite");
    report(refused("initial={sets: [{where: z > 2e-3, displacement: {z: 1/(y - 1e-3)}}]}",
                   "random.yaml: initial.sets[0].displacement.z: 1/(y - 1e-3) is not finite at (0.0003, "
                   "0.001, 0.001825)"),
           "initial", "a displacement that is not finite");
    return finish();
}
