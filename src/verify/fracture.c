/* Checks of rhegma verify on fracture: spall, energy of separation. */
#include <math.h>

#include "base/exact_sum.h"
#include "verify/check.h"

/* Faces know their areas as the kernels do. */
#ifdef RG_SINGLE
#define AREA_LIMIT 1e-6
#else
#define AREA_LIMIT 1e-9
#endif

#define MATERIAL_AND_LAW                                                                                     \
    "material: {model: neo-hookean, young: 260e9, poisson: 0.21, density: 3690}\n"                           \
    "interface: {law: linear, strength: 400e6, energy: 34}\n"

#define SLIDING_SIDES                                                                                        \
    "boundary:\n"                                                                                            \
    "  - {set: x-, component: x, velocity: 0}\n"                                                             \
    "  - {set: x+, component: x, velocity: 0}\n"                                                             \
    "  - {set: y-, component: y, velocity: 0}\n"                                                             \
    "  - {set: y+, component: y, velocity: 0}\n"

/* ---- spall ---- */

static const double end_velocity = 6.086; /* m/s */

/* Mean axial stress over a stretch of the bar. */
typedef struct {
    double low, high; /* m: of the centroids of its elements */
    rg_exact_sum stress, volume;
} stretch;

static void see_stretch(void *context, const rg_solver *s, size_t slot, const double stress[6]) {
    stretch *p = context;
    const double *x = s->domain->corner + 12 * slot + 2;
    double z = 0.25 * (x[0] + x[3] + x[6] + x[9]),
           volume = s->domain->geom[rg_geom_index(slot, RG_GEOM_VOLUME)];
    if (z > p->low && z < p->high) {
        rg_exact_add(&p->stress, 0.25 * volume * stress[2]);
        rg_exact_add(&p->volume, 0.25 * volume);
    }
}

/* Behind the front of the wave from the upper end, before it meets the other. */
static double plateau(const rg_trial *t) {
    stretch p = {.low = 0.8e-3, .high = 1.2e-3};
    rg_trial_stresses(t, see_stretch, &p);
    rg_exact_allreduce(&p.stress, 1, t->solver->comm);
    rg_exact_allreduce(&p.volume, 1, t->solver->comm);
    return rg_exact_value(&p.stress) / rg_exact_value(&p.volume);
}

void rg_verify_spall(MPI_Comm comm, const rg_verify_change *change, rg_verify_rows *rows) {
    static const char text[] =
        "mesh: {cells: [2, 2, 80], size: [0.1e-3, 0.1e-3, 4e-3], origin: [0, 0, -2e-3]}\n" MATERIAL_AND_LAW
            SLIDING_SIDES "  - {set: z+, component: z, velocity: 6.086}\n"
        "  - {set: z-, component: z, velocity: -6.086}\n"
        "time: {end: 0.3e-6}\n";
    rg_trial *t = rg_trial_begin(text, change, comm);
    const rg_case *c = t->theory;
    double nu = c->material.poisson, modulus = c->material.young * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
    double speed = sqrt(modulus / c->material.density), meeting = 0.5 * c->mesh.size[2] / speed, stress = NAN;
    while (rg_trial_next(t)) {
        if (isnan(stress) && t->solver->time >= 0.9 * meeting) {
            stress = plateau(t);
        }
        if (t->solver->step % 50 == 0) {
            rg_trial_ledger(t);
        }
    }
    rg_verify_value(rows, "spall: stress of the waves (Pa)", c->material.density * speed * end_velocity,
                    stress, 1e-3);
    rg_verify_value(rows, "spall: time of first fracture (s)", meeting, rg_first_fracture(t->solver), 0.03);
    rg_verify_value(rows, "spall: energy error", 0, rg_ledger_worst(&t->ledger), 1e-4);
    rg_trial_end(t);
}

/* ---- separation ---- */

/* A bar so short that smooth waves break it across z = 0 alone. The energy lost is that of the motion and the
 * strains, not what the cohesive law says that it dissipated; it is a little less, because a point that
 * leaves the DG form leaves some energy of its jump behind, less on finer meshes. */
void rg_verify_separation(MPI_Comm comm, const rg_verify_change *change, rg_verify_rows *rows) {
    static const char text[] =
        "mesh: {cells: [2, 2, 4], size: [0.1e-3, 0.1e-3, 0.2e-3], origin: [0, 0, -0.1e-3]}\n" MATERIAL_AND_LAW
        "initial: {velocity: {z: 15*sin(pi*z/0.2e-3)}}\n" SLIDING_SIDES "time: {end: 0.2e-6}\n";
    rg_trial *t = rg_trial_begin(text, change, comm);
    const rg_case *c = t->theory;
    double area = c->mesh.size[0] * c->mesh.size[1], begin = NAN;
    while (rg_trial_next(t)) {
        if (t->states == 1) {
            begin = rg_trial_ledger(t)->total;
        }
    }
    const rg_energy *e = rg_trial_ledger(t);
    rg_verify_value(rows, "separation: area (m2)", area, e->failed_area, AREA_LIMIT);
    rg_verify_value(rows, "separation: energy lost, G_c x area (J)", c->interface.energy * area,
                    begin - (e->total - e->dissipated), 5e-3);
    rg_trial_end(t);
}
