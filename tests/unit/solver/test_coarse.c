/* The coarse space of equilibria: its corrections solve Galerkin's equations, with the energy of linear
 * elasticity integrated anew, vanish where the body is held, and hold what is affine. On any number of ranks;
 * prints TAP from rank 0. */
#include "solver/coarse.h"

#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "reference/reference.h"
#include "support/random_state.h"
#include "support/tap_memory.h"

enum { FIRST = 3, SECOND = 4 };

static const char held[] =
    "boundary=[{set: z-, component: x, velocity: 0}, {set: z-, component: y, velocity: "
    "0}, {set: z-, component: z, velocity: 0}, {set: x+, component: x, velocity: 0}]";

/* Gradients of the corners' functions (1/m), and the volume (m3). */
static double gradients(const random_state *r, rg_gid e, double g[4][3]) {
    double x[4][3], edge[3][3];
    mesh_corners(r->mesh, e, x);
    for (int k = 0; k < 9; k++) {
        edge[k / 3][k % 3] = x[k / 3][k % 3] - x[3][k % 3];
    }
    memset(g, 0, 4 * sizeof *g);
    double cross[3], six;
    rg_reference_cross(edge[1], edge[2], cross);
    six = rg_reference_dot(edge[0], cross);
    for (int i = 0; i < 3; i++) {
        rg_reference_cross(edge[(i + 1) % 3], edge[(i + 2) % 3], cross);
        for (int c = 0; c < 3; c++) {
            g[i][c] = cross[c] / six;
            g[3][c] -= cross[c] / six;
        }
    }
    return fabs(six) / 6;
}

static void gradient_of(const rg_real *u, size_t slot, double g[4][3], double out[3][3]) {
    for (int k = 0; k < 9; k++) {
        out[k / 3][k % 3] = 0;
        for (int i = 0; i < 4; i++) {
            out[k / 3][k % 3] += g[i][k % 3] * u[rg_node_index(slot, i, k / 3)];
        }
    }
}

/* Stress of linear elasticity (Pa). */
static void stress_of(const random_state *r, rg_gid e, double u[3][3], double out[3][3]) {
    const rg_material *m = &r->solver->model->material[mesh_material(r, e)];
    for (int k = 0; k < 9; k++) {
        out[k / 3][k % 3] = m->mu * (u[k / 3][k % 3] + u[k % 3][k / 3]);
        out[k / 3][k % 3] += k % 4 == 0 ? m->lambda * (u[0][0] + u[1][1] + u[2][2]) : 0;
    }
}

/* Energy product of two fields that are linear in the elements (J). */
static double energy(const random_state *r, const rg_real *u, const rg_real *v) {
    const rg_domain *d = r->solver->domain;
    double sum = 0;
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        double g[4][3], du[3][3], dv[3][3], stress[3][3];
        if (d->id[slot] < 0) {
            continue;
        }
        double volume = gradients(r, d->id[slot], g);
        gradient_of(u, slot, g, du);
        gradient_of(v, slot, g, dv);
        stress_of(r, d->id[slot], du, stress);
        for (int k = 0; k < 9; k++) {
            sum += volume * stress[k / 3][k % 3] * dv[k / 3][k % 3];
        }
    }
    MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    return sum;
}

static double work(const rg_solver *s, const rg_real *force, const rg_real *u) {
    double sum = 0;
    for (size_t i = 0; i < s->domain->blocks * RG_NODE_BLOCK; i++) {
        sum += force[i] * u[i];
    }
    MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    return sum;
}

static rg_real *new_field(const rg_solver *s) {
    return RG_NEW(rg_real, s->domain->blocks * RG_NODE_BLOCK);
}

/* Forces on all nodes. */
static rg_real *draw_force(const rg_solver *s, uint64_t seed) {
    rg_real *f = new_field(s);
    for (size_t k = 0; k < 3 * RG_NODES * s->domain->blocks * RG_LANES; k++) {
        size_t slot = k / (3 * RG_NODES);
        int n = (int)(k / 3 % RG_NODES), c = (int)(k % 3);
        if (s->domain->id[slot] >= 0) {
            f[rg_node_index(slot, n, c)] = (rg_real)(30 * drawn_velocity(seed, s->domain->id[slot], n, c));
        }
    }
    return f;
}

/* Linear between corners, and the same in all elements around a vertex; 0 where it is held. */
static bool conforms(const random_state *r, const rg_real *u) {
    static const int end[RG_NODES][2] = {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {0, 1},
                                         {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
    const rg_domain *d = r->solver->domain;
    double bottom = r->input->mesh.origin[2], right = r->input->mesh.origin[0] + r->input->mesh.size[0];
    double *at = RG_NEW(double, 3 * (size_t)r->mesh->vertices), size = 0;
    bool good = true;
    for (int pass = 0; pass < 2; pass++) {
        for (size_t k = 0; k < 3 * RG_NODES * d->blocks * RG_LANES; k++) {
            size_t slot = k / (3 * RG_NODES);
            int n = (int)(k / 3 % RG_NODES), c = (int)(k % 3);
            if (d->id[slot] < 0) {
                continue;
            }
            double here = u[rg_node_index(slot, n, c)],
                   mean = 0.5 * ((double)u[rg_node_index(slot, end[n][0], c)] +
                                 u[rg_node_index(slot, end[n][1], c)]);
            rg_gid vertex = n < 4 ? r->mesh->corner[4 * d->id[slot] + n] : 0;
            const double *x = r->mesh->x + 3 * vertex;
            if (pass == 0) {
                size = fmax(size, fabs(here));
                at[3 * vertex + c] = n < 4 ? here : at[3 * vertex + c];
            } else if (n < 4) {
                bool fixed = x[2] < bottom + 1e-9 || (c == 0 && x[0] > right - 1e-9);
                good = good && fabs(here - at[3 * vertex + c]) <= 1e-14 * size && (!fixed || here == 0);
            } else {
                good = good && fabs(here - mean) <= 1e-15 * size;
            }
        }
    }
    rg_free(at);
    return good && size > 0;
}

static bool near(double found, double wanted) {
    bool good = fabs(found - wanted) <= 3e-9 * fabs(wanted); /* sums of 2^-36 of the largest */
    if (!good) {
        printf("# %.17g, not %.17g: %.2g\n", found, wanted, fabs(found / wanted - 1));
    }
    return good;
}

static void check_galerkin(const random_state *r, rg_coarse *c) {
    const rg_solver *s = r->solver;
    rg_real *f = draw_force(s, FIRST), *g = draw_force(s, SECOND), *u = new_field(s), *v = new_field(s);
    rg_coarse_correct(c, f, u);
    rg_coarse_correct(c, g, v);
    report(near(energy(r, u, u), work(s, f, u)) && near(energy(r, v, v), work(s, g, v)), "coarse",
           "energies are the works of the forces");
    report(near(energy(r, u, v), work(s, f, v)) && near(energy(r, u, v), work(s, g, u)), "coarse",
           "Galerkin's equations");
    report(conforms(r, u) && conforms(r, v), "coarse", "corrections are continuous, and 0 where it is held");
    rg_free(f);
    rg_free(g);
    rg_free(u);
    rg_free(v);
}

/* y and z grow with the height: of that field the forces, on the corners; they lead back to it. */
static void check_affine(const random_state *r, rg_coarse *c) {
    const rg_solver *s = r->solver;
    rg_real *f = new_field(s), *u = new_field(s);
    double H[3][3] = {{0, 0, 0}, {0, 0, 2e-3}, {0, 0, -3e-3}}, worst = 0;
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        double g[4][3], stress[3][3];
        if (s->domain->id[slot] < 0) {
            continue;
        }
        double volume = gradients(r, s->domain->id[slot], g);
        stress_of(r, s->domain->id[slot], H, stress);
        for (int k = 0; k < 12; k++) {
            f[rg_node_index(slot, k / 3, k % 3)] =
                (rg_real)(volume * rg_reference_dot(stress[k % 3], g[k / 3]));
        }
        for (int k = 0; k < 12; k++) { /* begins with another field, that is added to */
            u[rg_node_index(slot, k / 3, k % 3)] = 1e-6;
        }
    }
    rg_coarse_correct(c, f, u);
    for (size_t k = 0; k < 12 * s->domain->blocks * RG_LANES; k++) {
        double x[4][3];
        size_t slot = k / 12;
        int n = (int)(k / 3 % 4), component = (int)(k % 3);
        if (s->domain->id[slot] >= 0) {
            mesh_corners(r->mesh, s->domain->id[slot], x);
            double wanted = 1e-6 + H[component][2] * (x[n][2] - r->input->mesh.origin[2]);
            worst = fmax(worst, fabs(u[rg_node_index(slot, n, component)] - wanted));
        }
    }
    report_figure("coarse",
                  (figure){.quantity = "coarse space: an affine field from its forces, over its size",
                           .found = worst / 8.7e-6,
                           .bound = 4e-10,
                           .why = "sums of 2^-36 of the largest"});
    rg_free(f);
    rg_free(u);
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    const char *change[] = {held, "bodies=[]"};
    random_state r = random_state_make(2, change, MPI_COMM_WORLD);
    rg_constraints_set(r.solver->constraints, 0, 0, 1e-9); /* they act */
    rg_coarse *c = rg_coarse_make(r.solver);
    report(rg_coarse_size(c) == 20, "coarse", "as many functions as are not held"); /* on 2 x 2 x 3 points */
    check_galerkin(&r, c);
    check_affine(&r, c);
    rg_coarse_free(c);
    random_state_free(&r);
    return finish_with_nothing_left();
}
