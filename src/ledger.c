#include "ledger.h"

#include <float.h>
#include <math.h>

#include "element.h"
#include "quadrature.h"

enum {
    KINETIC,
    BULK,
    INTERFACE,
    DISSIPATED = INTERFACE + RG_E_DISSIPATED,
    EXTERNAL,
    BROKEN,
    FAILED,
    VOLUME,
    MOMENTUM,
    ANGULAR = MOMENTUM + 3,
    SUMS = ANGULAR + 3
};

enum { CHUNK = 16 }; /* blocks whose energies fit a small buffer */

static void add_all(rg_exact_sum *sum, const double *x, size_t count) {
    for (size_t i = 0; i < count; i++) {
        rg_exact_add(sum, x[i]);
    }
}

/* Momentum int rho v and angular momentum int rho x cross v of an element, both from M v at the
 * nodes. */
static void add_momentum(rg_exact_sum *sum, const rg_solver *s, size_t slot) {
    double mv[RG_NODES][3], p[3] = {0, 0, 0}, l[3] = {0, 0, 0};
    double mass = s->bulk.material.density * s->domain->geom[rg_geom_index(slot, RG_GEOM_VOLUME)];
    rg_mass_times(s->update.lumped, mass, s->scratch, slot, mv);
    for (int n = 0; n < RG_NODES; n++) {
        double x[3];
        rg_node_position(s->domain->corner + 12 * slot, n, x);
        for (int c = 0; c < 3; c++) {
            x[c] += s->u[rg_node_index(slot, n, c)];
            p[c] += mv[n][c];
        }
        for (int c = 0; c < 3; c++) {
            int a = (c + 1) % 3, b = (c + 2) % 3;
            l[c] += x[a] * mv[n][b] - x[b] * mv[n][a];
        }
    }
    for (int c = 0; c < 3; c++) {
        rg_exact_add(&sum[MOMENTUM + c], p[c]);
        rg_exact_add(&sum[ANGULAR + c], l[c]);
    }
}

static void element_energies(rg_solver *s, size_t begin, size_t end, rg_exact_sum sum[SUMS]) {
    _Alignas(64) double energy[CHUNK * RG_LANES];
    size_t count = (end - begin) * RG_LANES;
    rg_bulk_state_args bulk = {.bulk = &s->bulk, .energy = energy};
    s->kernels->bulk_state(&bulk, begin, end);
    add_all(&sum[BULK], energy, count);
    rg_kinetic_args kinetic = {s->update.density, s->update.lumped, s->domain->geom, s->scratch, energy};
    s->kernels->kinetic(&kinetic, begin, end);
    add_all(&sum[KINETIC], energy, count);
    for (size_t slot = begin * RG_LANES; slot < end * RG_LANES; slot++) {
        if (s->domain->id[slot] >= 0) {
            rg_exact_add(&sum[VOLUME], s->domain->geom[rg_geom_index(slot, RG_GEOM_VOLUME)]);
            add_momentum(sum, s, slot);
        }
    }
}

static void add_areas(rg_exact_sum sum[SUMS], const rg_solver *s, size_t i) {
    static const double weight[2] = {RG_TRI_W0, RG_TRI_W1};
    double area = s->domain->igeom[rg_igeom_index(i, RG_IGEOM_AREA)];
    for (int q = 0; q < RG_POINTS; q++) {
        if (s->broken[i] >> q & 1) {
            rg_exact_add(&sum[BROKEN], weight[q / 3] * area);
            bool failed = s->crack[rg_crack_index(i, q, RG_CRACK_OPENING)] >= s->interface.law.opening;
            rg_exact_add(&sum[FAILED], failed ? weight[q / 3] * area : 0);
        }
    }
}

/* Each interface is counted by the rank that owns its minus side. */
static void interface_energies(rg_solver *s, size_t begin, size_t end, rg_exact_sum sum[SUMS]) {
    _Alignas(64) double energy[CHUNK * RG_E_INTERFACE * RG_LANES];
    rg_interface_state_args args = {&s->interface, energy};
    s->kernels->interface_state(&args, begin, end);
    for (size_t i = begin * RG_LANES; i < end * RG_LANES; i++) {
        if (!s->domain->counted[i]) {
            continue;
        }
        for (int k = 0; k < RG_E_INTERFACE; k++) {
            size_t row = i / RG_LANES - begin;
            rg_exact_add(&sum[INTERFACE + k],
                         energy[(row * RG_E_INTERFACE + (size_t)k) * RG_LANES + i % RG_LANES]);
        }
        if (s->broken[i]) {
            add_areas(sum, s, i);
        }
    }
}

static void sum_up(rg_solver *s, rg_exact_sum sum[SUMS]) {
    size_t blocks = s->domain->blocks, iblocks = s->domain->iblocks;
#pragma omp parallel
    {
        rg_exact_sum mine[SUMS] = {0};
#pragma omp for schedule(static) nowait
        for (size_t b = 0; b < blocks; b += CHUNK) {
            element_energies(s, b, b + CHUNK < blocks ? b + CHUNK : blocks, mine);
        }
#pragma omp for schedule(static) nowait
        for (size_t b = 0; b < iblocks; b += CHUNK) {
            interface_energies(s, b, b + CHUNK < iblocks ? b + CHUNK : iblocks, mine);
        }
#pragma omp critical
        for (int k = 0; k < SUMS; k++) {
            rg_exact_merge(&sum[k], &mine[k]);
        }
    }
}

const rg_energy *rg_ledger_take(rg_ledger *l, rg_solver *s) {
    rg_exact_sum sum[SUMS] = {0};
    rg_solver_velocity_now(s, &sum[EXTERNAL]);
    rg_constraints_work(s->constraints, &sum[EXTERNAL]);
    sum_up(s, sum);
    rg_exact_allreduce(sum, SUMS, s->comm);
    double v[SUMS];
    for (int k = 0; k < SUMS; k++) {
        v[k] = rg_exact_value(&sum[k]);
    }
    const double *part = v + INTERFACE;
    rg_energy *e = &l->last;
    *e = (rg_energy){.step = s->step,
                     .time = s->time,
                     .kinetic = v[KINETIC],
                     .bulk = v[BULK],
                     .penalty = part[RG_E_PENALTY],
                     .cohesive = part[RG_E_COHESIVE],
                     .contact = part[RG_E_CONTACT],
                     .dissipated = part[RG_E_DISSIPATED],
                     .external = v[EXTERNAL],
                     .broken_area = v[BROKEN],
                     .failed_area = v[FAILED],
                     .momentum = {v[MOMENTUM], v[MOMENTUM + 1], v[MOMENTUM + 2]},
                     .angular_momentum = {v[ANGULAR], v[ANGULAR + 1], v[ANGULAR + 2]}};
    double stored = e->kinetic + e->bulk + e->penalty + e->cohesive + e->contact + e->dissipated;
    e->total = stored - e->external;
    if (!l->begun) {
        *l = (rg_ledger){.begun = true, .start = e->total, .last = *e};
    }
    l->largest = fmax(fmax(l->largest, fabs(stored)), 1e3 * DBL_EPSILON * s->bulk.material.mu * v[VOLUME]);
    e->error = e->total == l->start ? 0 : (e->total - l->start) / l->largest;
    l->worst = isnan(e->error) ? INFINITY : fmax(l->worst, fabs(e->error));
    return e;
}

double rg_first_fracture(const rg_solver *s) {
    double first = INFINITY;
    for (size_t i = 0; i < s->domain->iblocks * RG_LANES; i++) {
        for (int q = 0; s->broken[i] && q < RG_POINTS; q++) {
            if (s->broken[i] >> q & 1) {
                first = fmin(first, s->crack[rg_crack_index(i, q, RG_CRACK_TIME)]);
            }
        }
    }
    MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_DOUBLE, MPI_MIN, s->comm);
    return first;
}
