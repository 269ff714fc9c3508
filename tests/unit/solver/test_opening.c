/* Faces that are opened at a time, of a state drawn at random: what is released, and that all else stays. On
 * any number of ranks, by two threads; prints TAP from rank 0. */
#include "solver/opening.h"

#include <math.h>
#include <omp.h>
#include <string.h>

#include "base/mem.h"
#include "domain/element.h"
#include "solver/fields.h"
#include "solver/law.h"
#include "solver/step.h"
#include "solver/stepper.h"
#include "solver/tile.h"
#include "support/near.h"
#include "support/random_state.h"
#include "support/tap_memory.h"

enum { SEED = 7 };

/* Some are due, those of an earlier entry later. */
static random_state make(void) {
    static const char sets[] = "interface.sets=[{where: z < 1.7e-3, open: true, at: 1e-3}, "
                               "{where: z > 2.2e-3, open: true, at: 0.5e-7}]";
    const char *change[] = {sets, "bodies=[]"};
    random_state r = random_state_make(2, change, MPI_COMM_WORLD);
    random_state_draw(&r, SEED);
    for (size_t k = 0; k < r.solver->domain->blocks * RG_NODE_BLOCK; k++) {
        r.solver->u[k] *= (rg_real)0.05; /* so that no lift turns an element inside out */
    }
    for (size_t k = 0; k < r.solver->model->openings; k++) { /* these hold until then */
        size_t i = r.solver->model->opening[k].face;
        r.solver->broken[i] = r.solver->unlinked[i] = 0;
        for (size_t n = 0; n < r.solver->model->crack_stride / RG_LANES; n++) {
            r.solver->crack[i / RG_LANES * r.solver->model->crack_stride + n * RG_LANES + i % RG_LANES] = 0;
        }
    }
    rg_solver_resume(r.solver);
    rg_halo_finish(r.solver->stepper->halo_u[r.solver->stepper->current]);
    r.solver->openings.until = 0;
    r.solver->openings.released = 0.25;
    return r;
}

/* ---- What stays ---- */

static bool same_array(const rg_state_array *a, const rg_state_array *b, size_t records) {
    static char one[4096], other[4096];
    bool good = a->of == b->of && rg_state_bytes(a) == rg_state_bytes(b) && rg_state_bytes(a) <= sizeof one;
    for (size_t i = 0; good && i < records; i++) {
        rg_state_get(a, i, one);
        rg_state_get(b, i, other);
        good = memcmp(one, other, rg_state_bytes(a)) == 0;
    }
    if (!good) {
        printf("# %s differs\n", a->name);
    }
    return good;
}

static bool same_cracks(const rg_solver *a, const rg_solver *b) {
    size_t stride = a->model->crack_stride;
    bool good = true;
    for (size_t i = 0; i < a->domain->iblocks; i++) {
        good = good && (!a->active[i] ||
                        memcmp(a->crack + i * stride, b->crack + i * stride, stride * sizeof *a->crack) == 0);
    }
    return good;
}

static bool same_state(rg_solver *a, rg_solver *b) {
    rg_state one = {0}, other = {0};
    const rg_domain *d = a->domain;
    bool good = true;
    rg_state_of_solver(&one, a);
    rg_state_of_solver(&other, b);
    for (int k = 0; k < one.arrays; k++) {
        const rg_state_array *p = &one.array[k];
        size_t records = p->of == RG_OF_ELEMENT ? d->blocks * RG_LANES
                         : p->of == RG_OF_FACE  ? d->iblocks * RG_LANES
                         : p->of == RG_OF_RUN   ? 1
                                                : 0;
        if (strcmp(p->name, "openings") != 0 && strcmp(p->name, "crack") != 0) {
            good = same_array(p, &other.array[k], records) && good;
        }
    }
    size_t values = d->blocks * RG_NODE_BLOCK;
    return good && memcmp(a->u, b->u, values * sizeof *a->u) == 0 &&
           memcmp(a->velocity, b->velocity, values * sizeof *a->velocity) == 0 &&
           memcmp(a->cracked, b->cracked, d->blocks) == 0 && memcmp(a->active, b->active, d->iblocks) == 0 &&
           same_cracks(a, b);
}

/* ---- What is released ---- */

/* Energy and acceleration of a state, which an impulse makes another one. */
static double evaluate(rg_solver *s, rg_real *acceleration) {
    const rg_domain *d = s->domain;
    rg_exact_sum sum = {0};
    double *energy = RG_NEW(double, (d->blocks + d->iblocks * RG_E_INTERFACE) * RG_LANES);
    rg_solver_impulse(s, acceleration, 1);
    for (size_t n = 0; n < d->tiles; n++) {
        const rg_tile *t = &d->tile[n];
        rg_tile_receive(s, t, &s->work[0]);
        rg_tile_state(s, t, &s->work[0], energy, NULL, NULL);
        for (size_t k = 0; k < rg_tile_eblocks(t) * RG_LANES; k++) {
            rg_exact_add(&sum, energy[k]);
        }
        rg_interface_args interface = rg_tile_interfaces(s, t, &s->work[0]);
        rg_interface_state_args args = {&interface, energy};
        s->kernels->interface_state(&args, 0, rg_tile_iblocks(t));
        for (size_t k = 0; k < rg_tile_iblocks(t) * RG_LANES; k++) {
            size_t i = t->ibegin * RG_LANES + k;
            for (size_t part = 0; d->counted[i] && part < RG_E_INTERFACE; part++) {
                rg_exact_add(&sum, energy[(k / RG_LANES * RG_E_INTERFACE + part) * RG_LANES + k % RG_LANES]);
            }
            for (int q = 0; d->counted[i] && q < RG_POINTS; q++) {
                rg_exact_add(
                    &sum, (s->broken[i] >> q & 1) != 0 ? *rg_friction_value(s, i, q, RG_FRICTION_HEAT) : 0);
            }
        }
    }
    rg_free(energy);
    rg_exact_allreduce(&sum, 1, MPI_COMM_WORLD);
    return rg_exact_value(&sum);
}

/* Power of the difference of two accelerations, and of both. */
static double power(const random_state *r, const rg_real *a, const rg_real *b, double *size) {
    const rg_domain *d = r->solver->domain;
    rg_exact_sum sum[2] = {0};
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        rg_gid e = d->id[slot];
        for (int k = 0; e >= 0 && k < 3 * RG_NODES * RG_NODES; k++) {
            int n = k / 3 % RG_NODES, m = k / 3 / RG_NODES, c = k % 3;
            double weight =
                mesh_mass(r, e) * rg_mass_entry(r->input->mass, n, m) * drawn_velocity(SEED, e, n, c);
            size_t at = rg_node_index(slot, m, c);
            rg_exact_add(&sum[0], weight * ((double)a[at] - (double)b[at]));
            rg_exact_add(&sum[1], fabs(weight * a[at]));
        }
    }
    rg_exact_allreduce(sum, 2, MPI_COMM_WORLD);
    *size = rg_exact_value(&sum[1]);
    return rg_exact_value(&sum[0]);
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    omp_set_num_threads(2);
    random_state taken = make(), opened = make(), before = make(), after = make();
    size_t values = opened.solver->domain->blocks * RG_NODE_BLOCK;
    rg_real *a = RG_NEW(rg_real, values), *b = RG_NEW(rg_real, values);
    double time = taken.solver->time, size;
    rg_openings_take(taken.solver);
    rg_law_open_until(opened.solver, time);
    report(same_state(taken.solver, opened.solver), "opening", "nothing changes but the faces that open");
    double energy = evaluate(before.solver, a);
    rg_law_open_until(after.solver, time);
    energy -= evaluate(after.solver, b);
    double work = 0.5 * taken.solver->dt * power(&taken, a, b, &size);
    double found = taken.solver->openings.released - 0.25;
    report(near(found, energy + work, 1e-12 * (fabs(energy) + taken.solver->dt * size)) &&
               fabs(work) > 1e-3 * fabs(energy) && fabs(energy) > 1e-6,
           "opening", "what is released");
    report(!(fabs(taken.solver->openings.until - time) > 0), "opening", "is noted");
    rg_openings_take(taken.solver);
    report(!(fabs(taken.solver->openings.released - 0.25 - found) > 0) &&
               same_state(taken.solver, opened.solver),
           "opening", "nothing twice");
    rg_free(a);
    rg_free(b);
    random_state_free(&taken);
    random_state_free(&opened);
    random_state_free(&before);
    random_state_free(&after);
    return finish_with_nothing_left();
}
