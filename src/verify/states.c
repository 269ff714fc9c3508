/* Checks of rhegma verify on states that must stay as they are: affine, turned. */
#include <math.h>

#include "base/vector.h"
#include "domain/element.h"
#include "verify/check.h"

#define MESH_AND_MATERIAL                                                                                    \
    "mesh: {cells: [4, 4, 4], size: [1e-3, 1e-3, 1e-3], jitter: 0.2}\n"                                      \
    "material: {model: neo-hookean, young: 260e9, poisson: 0.21, density: 3690}\n"                           \
    "interface: {law: none}\n"

/* What rounding leaves; in single precision displacements as large as the body cancel to strains of 1e-6. */
#ifdef RG_SINGLE
static const double patch_limit[2] = {2e-6, 2e-8}, rotation_limit[2] = {1e-4, 3e-5};
#else
static const double patch_limit[2] = {1e-12, 1e-12}, rotation_limit[2] = {1e-12, 1e-12};
#endif

/* Largest deviations so far: of nodal values, of stresses (Pa). */
typedef struct {
    double exact[6]; /* stress */
    double nodal, stress;
} worst;

/* What is not a number is worst. */
static double larger(double a, double b) {
    return isnan(b) ? INFINITY : fmax(a, b);
}

static void see_stress(void *context, const rg_solver *s, size_t slot, const double stress[6]) {
    worst *w = context;
    (void)s;
    (void)slot;
    for (int k = 0; k < 6; k++) {
        w->stress = larger(w->stress, fabs(stress[k] - w->exact[k]));
    }
}

/* Both over all ranks, with `nodal` and stress relative to the given scales. */
static void compare(const rg_trial *t, const worst *w, const double scale[2], const char *const name[2],
                    const double limit[2], rg_verify_rows *rows) {
    double most[2] = {w->nodal, w->stress};
    MPI_Allreduce(MPI_IN_PLACE, most, 2, MPI_DOUBLE, MPI_MAX, t->solver->comm);
    for (int k = 0; k < 2; k++) {
        rg_verify_value(rows, name[k], 0, most[k] / scale[k], limit[k]);
    }
}

/* ---- patch test ---- */

static const double gradient[3][3] = {
    {1.0e-3, 0.7e-3, -0.4e-3}, {-0.3e-3, -0.8e-3, 0.5e-3}, {0.6e-3, -0.9e-3, 1.1e-3}};

#define UX "1.0e-3*x + 0.7e-3*y - 0.4e-3*z"
#define UY "-0.3e-3*x - 0.8e-3*y + 0.5e-3*z"
#define UZ "0.6e-3*x - 0.9e-3*y + 1.1e-3*z"
#define HELD(SET)                                                                                            \
    "  - {set: " SET ", component: x, displacement: " UX "}\n"                                               \
    "  - {set: " SET ", component: y, displacement: " UY "}\n"                                               \
    "  - {set: " SET ", component: z, displacement: " UZ "}\n"

/* Cauchy stress (mu (F F^T - I) + lambda ln J I)/J of the neo-Hookean solid. */
static void affine_stress(const rg_case *c, double stress[6]) {
    static const int row[6] = {0, 1, 2, 1, 0, 0}, column[6] = {0, 1, 2, 2, 2, 1};
    double young = c->material.young, nu = c->material.poisson, F[3][3], cofactor[3];
    double mu = young / (2 * (1 + nu)), lambda = young * nu / ((1 + nu) * (1 - 2 * nu));
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            F[i][k] = gradient[i][k] + (i == k);
        }
    }
    rg_vector_cross(F[1], F[2], cofactor);
    double J = rg_vector_dot(F[0], cofactor);
    for (int m = 0; m < 6; m++) {
        int i = row[m], j = column[m];
        double b = rg_vector_dot(F[i], F[j]);
        stress[m] = (mu * (b - (i == j)) + (i == j ? lambda * log(J) : 0)) / J;
    }
}

static void see_displacement(void *context, const rg_solver *s, size_t slot, int node) {
    worst *w = context;
    double x[3];
    rg_node_position(s->domain->corner + 12 * slot, node, x);
    for (int i = 0; i < 3; i++) {
        double exact = rg_vector_dot(gradient[i], x);
        w->nodal = larger(w->nodal, fabs(s->u[rg_node_index(slot, node, i)] - exact));
    }
}

void rg_verify_patch(MPI_Comm comm, const rg_verify_change *change, rg_verify_rows *rows) {
    static const char text[] =
        MESH_AND_MATERIAL "initial: {displacement: {x: " UX ", y: " UY ", z: " UZ "}}\n"
                          "boundary:\n" HELD("x-") HELD("x+") HELD("y-") HELD("y+") HELD("z-")
                              HELD("z+") "time: {end: 1, steps: 50}\n";
    static const char *const name[2] = {"patch test: displacement / largest", "patch test: stress / E"};
    rg_trial *t = rg_trial_begin(text, change, comm);
    worst w = {.nodal = 0};
    affine_stress(t->theory, w.exact);
    while (rg_trial_next(t)) {
    }
    rg_trial_nodes(t, see_displacement, &w);
    rg_trial_stresses(t, see_stress, &w);
    double scale[2] = {1.7e-3 * t->theory->mesh.size[0], t->theory->material.young};
    compare(t, &w, scale, name, patch_limit, rows);
    rg_trial_end(t);
}

/* ---- rotation ---- */

static void see_velocity(void *context, const rg_solver *s, size_t slot, int node) {
    worst *w = context;
    for (int i = 0; i < 3; i++) {
        w->nodal = larger(w->nodal, fabs(s->step_velocity[rg_node_index(slot, node, i)]));
    }
}

void rg_verify_rotation(MPI_Comm comm, const rg_verify_change *change, rg_verify_rows *rows) {
    static const char text[] = MESH_AND_MATERIAL "initial: {displacement: {x: -y - x, y: x - y}}\n"
                                                 "time: {end: 1, steps: 20}\n"
                                                 "output: {energy_limit: 1}\n";
    static const char *const name[2] = {"turned by 90 degrees: velocity / wave speed",
                                        "turned by 90 degrees: stress / E"};
    rg_trial *t = rg_trial_begin(text, change, comm);
    worst w = {.nodal = 0};
    while (rg_trial_next(t)) {
    }
    rg_trial_nodes(t, see_velocity, &w);
    rg_trial_stresses(t, see_stress, &w);
    double young = t->theory->material.young, scale[2] = {sqrt(young / t->theory->material.density), young};
    compare(t, &w, scale, name, rotation_limit, rows);
    rg_trial_end(t);
}
