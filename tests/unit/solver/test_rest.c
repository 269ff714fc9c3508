/* Rest under a load, by Newton's method and by damping: a block that is pulled between rollers against its
 * closed form, and what becomes of the work. On any number of ranks; prints TAP from rank 0. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "solver/equilibrium.h"
#include "solver/relax.h"
#include "solver/statics.h"
#include "solver/spectrum.h"
#include "solver/step.h"
#include "support/near.h"
#include "support/random_state.h"
#include "support/tap_memory.h"

static const double YOUNG = 70e9, POISSON = 0.25, PULL = 1e6;

/* Largest distance (m) of a node from where the block of linear elasticity has it. */
static double farthest(const random_state *r) {
    const rg_solver *s = r->solver;
    double most = 0;
    for (size_t k = 0; k < RG_NODES * s->domain->blocks * RG_LANES; k++) {
        rg_gid e = s->domain->id[k / RG_NODES];
        double x[3];
        if (e < 0) {
            continue;
        }
        mesh_node(r->mesh, e, (int)(k % RG_NODES), x);
        for (int c = 0; c < 3; c++) {
            double strain = c == 2 ? PULL / YOUNG : -POISSON * PULL / YOUNG;
            double wanted = strain * (x[c] - r->input->mesh.origin[c]);
            most = fmax(most, fabs(s->u[rg_node_index(k / RG_NODES, (int)(k % RG_NODES), c)] - wanted));
        }
    }
    MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    return most;
}

/* What rounding leaves of the accelerations, without what supports take; the displacement stays. */
static void check_rounding(rg_solver *s, const char *start) {
    rg_statics q = rg_statics_make(s);
    rg_real *room = rg_statics_field(&q), *change = rg_statics_field(&q), *u = rg_statics_field(&q);
    size_t bytes = q.length * sizeof *u;
    rg_statics_copy(&q, s->u, u);
    double left = rg_statics_rounding(&q, room, change);
    rg_statics_copy(&q, change, room);
    rg_statics_hold(&q, NULL, room);
    rg_statics_add(&q, -1, change, 1, room);
    bool free = rg_statics_norm(&q, room) < 1e-6 * left, stays = memcmp(u, s->u, bytes) == 0;
    rg_statics_accelerate(&q, room, true);
    report(free && stays && left > 0 && left < 3e-14 * rg_statics_norm(&q, room), start,
           "rounding: of what is free, a little");
    rg_free(room);
    rg_free(change);
    rg_free(u);
    rg_statics_free(&q);
}

static void check(const char *start, bool damped) {
    const char *change[] = {
        start,
        "material={name: glass, model: linear-elastic, young: 70e9, poisson: 0.25, density: 2500}",
        "materials=[]",
        "bodies=[]",
        "interface={law: none, beta_s: 2}",
        "viscosity.linear=0",
        "boundary=[{set: z-, component: z, displacement: 0}, {set: x-, normal: 0}, {set: y-, component: y, "
        "velocity: 0}]",
        "loads=[{set: z+, traction: {z: 1e6}}]",
        "relax.tolerance=1e-8",
    };
    random_state r = random_state_make(damped ? 9 : 8, change, MPI_COMM_WORLD);
    rg_solver *s = r.solver;
    const double *size = r.input->mesh.size;
    double work = PULL * size[0] * size[1] * PULL / YOUNG * size[2];
    rg_spectrum_whole(s);
    rg_solver_start(s);
    rg_equilibrium found = damped ? rg_relax(s, NULL) : rg_equilibrium_find(s, NULL);
    report(farthest(&r) < (damped ? 1e-7 : 3e-9) * PULL / YOUNG * size[2], start, "displacements");
    report(found.residual > 1e-9 && found.residual <= 1e-8 && found.passes > (damped ? 500 : 100) &&
               found.passes < (damped ? 1000 : 200),
           start, "residual and passes");
    report(near(s->relaxed.work, damped ? work : 0, 1e-7 * work) &&
               near(s->relaxed.heat, damped ? work / 2 : 0, 1e-14 * work),
           start, "work and heat");
    check_rounding(s, start);
    random_state_free(&r);
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    check("start=static", false);
    check("start=relax", true);
    return finish_with_nothing_left();
}
