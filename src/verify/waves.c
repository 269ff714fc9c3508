/* Elastic checks of rhegma verify that run in time: wave speeds, conservation of energy. */
#include <math.h>

#include "verify/check.h"

#define PI 3.14159265358979323846

#define MATERIAL "material: {model: neo-hookean, young: 260e9, poisson: 0.21, density: 3690}\n"

/* The first mode of a bar of length L: frequency w = pi c/L. Its kinetic less its stored energy is the total
 * times cos 2wt, whose zeros are pi/2w apart. */
typedef struct {
    double time, value; /* of the last state */
    double first, last; /* zeros (s) */
    int zeros;
} beat;

static void look(beat *b, const rg_energy *e) {
    double value = e->kinetic - e->bulk - e->penalty;
    if ((value < 0) != (b->value < 0)) { /* never at the start, where all energy is kinetic */
        double zero = b->time + (e->time - b->time) * b->value / (b->value - value);
        b->first = b->zeros == 0 ? zero : b->first;
        b->last = zero;
        b->zeros++;
    }
    b->value = value;
    b->time = e->time;
}

static double measure_speed(rg_trial *t) {
    beat b = {0};
    while (rg_trial_next(t)) {
        look(&b, rg_trial_ledger(t));
    }
    double omega = 0.5 * PI * (b.zeros - 1) / (b.last - b.first);
    return omega * t->theory->mesh.size[2] / PI; /* not finite with fewer than two zeros */
}

static double pressure_modulus(const rg_case *c) {
    double nu = c->material.poisson;
    return c->material.young * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
}

static double shear_modulus(const rg_case *c) {
    return c->material.young / (2 * (1 + c->material.poisson));
}

static void compare_speed(MPI_Comm comm, const char *text, const rg_verify_change *change, const char *name,
                          double (*modulus)(const rg_case *c), rg_verify_rows *rows) {
    rg_trial *t = rg_trial_begin(text, change, comm);
    double theory = sqrt(modulus(t->theory) / t->theory->material.density);
    rg_verify_value(rows, name, theory, measure_speed(t), 1e-3);
    rg_trial_end(t);
}

void rg_verify_pressure_wave(MPI_Comm comm, const rg_verify_change *change, rg_verify_rows *rows) {
    static const char text[] =
        "mesh: {cells: [1, 1, 16], size: [0.0625e-3, 0.0625e-3, 1e-3]}\n" MATERIAL "interface: {law: none}\n"
        "initial: {velocity: {z: -0.1*cos(pi*z/1e-3)}}\n"
        "boundary:\n"
        "  - {set: x-, component: x, velocity: 0}\n"
        "  - {set: x+, component: x, velocity: 0}\n"
        "  - {set: y-, component: y, velocity: 0}\n"
        "  - {set: y+, component: y, velocity: 0}\n"
        "time: {end: 2.2e-7}\n"
        "output: {energy_limit: 1}\n";
    compare_speed(comm, text, change, "speed of pressure waves (m/s)", pressure_modulus, rows);
}

void rg_verify_shear_wave(MPI_Comm comm, const rg_verify_change *change, rg_verify_rows *rows) {
    static const char text[] =
        "mesh: {cells: [1, 1, 16], size: [0.0625e-3, 0.0625e-3, 1e-3]}\n" MATERIAL "interface: {law: none}\n"
        "initial: {velocity: {x: -0.1*cos(pi*z/1e-3)}}\n"
        "boundary:\n"
        "  - {set: x-, component: z, velocity: 0}\n"
        "  - {set: x+, component: z, velocity: 0}\n"
        "  - {set: y-, component: y, velocity: 0}\n"
        "  - {set: y+, component: y, velocity: 0}\n"
        "time: {end: 3.6e-7}\n"
        "output: {energy_limit: 1}\n";
    compare_speed(comm, text, change, "speed of shear waves (m/s)", shear_modulus, rows);
}

#ifdef RG_SINGLE
static const double energy_limit = 1e-6;
#else
static const double energy_limit = 1e-8;
#endif

void rg_verify_energy(MPI_Comm comm, const rg_verify_change *change, rg_verify_rows *rows) {
    static const char text[] =
        "mesh: {cells: [2, 2, 20], size: [0.2e-3, 0.2e-3, 2e-3]}\n" MATERIAL "interface: {law: none}\n"
        "initial: {velocity: {z: -1*cos(pi*z/2e-3)}}\n"
        "time: {end: 1, steps: 3000}\n";
    rg_trial *t = rg_trial_begin(text, change, comm);
    while (rg_trial_next(t)) {
        if (t->solver->step % 50 == 0) {
            rg_trial_ledger(t);
        }
    }
    bool whole = t->solver->step == t->theory->time.steps;
    rg_verify_value(rows, "energy of a free bar, change in 3000 steps", 0,
                    whole ? rg_ledger_worst(&t->ledger) : NAN, energy_limit);
    rg_trial_end(t);
}
