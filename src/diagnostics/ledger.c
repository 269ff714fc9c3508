#include "diagnostics/ledger.h"

#include <float.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/mem.h"
#include "domain/element.h"
#include "quadrature.h"
#include "solver/tile.h"

enum {
    KINETIC,
    HALF_KICK,
    BULK,
    INTERFACE,
    DISSIPATED = INTERFACE + RG_E_DISSIPATED,
    UNRESOLVED = INTERFACE + RG_E_UNRESOLVED,
    FOUNDATION,
    BRIEF, /* of those foundations that begin or end */
    EXTERNAL,
    RELEASED,
    VISCOUS = RELEASED + RG_RELEASED,
    FRICTION,
    BROKEN,
    FAILED,
    VOLUME,
    MOMENTUM,
    ANGULAR = MOMENTUM + 3,
    PARTS = ANGULAR + 3 /* those of material m: from PARTS + PART * m on */
};

enum { ROW = 28 }; /* values of a row, but for the parts of the materials */

enum { PART_KINETIC, PART_BULK, PART_DISSIPATED, PART };

/* Materials that have sums of their own: of very many there are none, but those of all together. */
static int told_materials(const rg_solver *s) {
    return s->model->materials <= RG_LEDGER_MATERIALS ? s->model->materials : 1;
}

static size_t sums(const rg_solver *s) {
    return PARTS + (size_t)(PART * told_materials(s));
}

/* The sums of a material. */
static rg_exact_sum *parts_of(rg_exact_sum *sum, const rg_solver *s, int material) {
    return &sum[PARTS + PART * (material < told_materials(s) ? material : 0)];
}

static void add_all(rg_exact_sum *sum, const double *x, size_t count) {
    for (size_t i = 0; i < count; i++) {
        rg_exact_add(sum, x[i]);
    }
}

/* Momentum int rho v and angular momentum int rho x cross v of an element, both from M v at the
 * nodes. */
static void add_momentum(rg_exact_sum *sum, const rg_solver *s, size_t slot) {
    double mv[RG_NODES][3], p[3] = {0, 0, 0}, l[3] = {0, 0, 0};
    rg_mass_times(s->input->mass, rg_element_mass(s->domain, s->model->material, slot), s->step_velocity,
                  slot, mv);
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

static rg_exact_sum *parts_of_block(rg_exact_sum *sum, const rg_solver *s, size_t block) {
    return parts_of(sum, s, s->domain->material[block]);
}

/* What heat has brought in is work from outside. */
static void add_heat(rg_exact_sum *sum, const rg_solver *s, size_t slot) {
    if (s->thermal != NULL) {
        size_t at = slot / RG_LANES * RG_THERMAL_BLOCK + RG_THERMAL_WORK * RG_LANES + slot % RG_LANES;
        rg_exact_add(&sum[EXTERNAL], s->thermal[at]);
    }
}

static void add_released(rg_exact_sum *sum, const rg_solver *s, size_t slot) {
    int history = rg_material_values(rg_material_of(s, slot));
    for (size_t k = 0; history > 0 && k < RG_RELEASED; k++) {
        double released = rg_history_value(s, slot, (size_t)(RG_GAUSS * history) + k);
        rg_exact_add(&sum[RELEASED + k], released);
        rg_exact_add(&parts_of_block(sum, s, slot / RG_LANES)[PART_DISSIPATED], released);
    }
}

/* Of a tile, by a velocity of its elements: energy[blocks * RG_LANES] (J). */
static void kinetic_energies(const rg_solver *s, const rg_tile *t, const rg_real *velocity, double *energy) {
    rg_kinetic_args kinetic = {
        .mass = s->input->mass, .geom = s->domain->geom + t->begin * RG_GEOM_BLOCK, .velocity = velocity};
    for (size_t begin = 0, end; begin < rg_tile_eblocks(t); begin = end) {
        end = rg_run_end(s->domain, t, begin);
        kinetic.density = rg_block_material(s, t, begin)->density;
        kinetic.energy = energy + begin * RG_LANES;
        s->kernels->kinetic(&kinetic, begin, end);
    }
}

/* Of the steps behind and ahead the longer one, over that ahead: one that is cut short to end at a certain
 * time is no other measure of the same energy. */
static double longer_step(const rg_solver *s) {
    return s->dt > s->dt_next && s->dt_next > 0 ? s->dt / s->dt_next : 1;
}

/* The kinetic energy of what the velocity changes by in half a step, dt a/2. */
static void add_half_kick(rg_exact_sum *sum, const rg_solver *s, const rg_tile *t, rg_real *change,
                          double *energy) {
    size_t first = t->begin * RG_NODE_BLOCK, count = rg_tile_eblocks(t) * RG_NODE_BLOCK;
    rg_real longer = (rg_real)longer_step(s);
    for (size_t i = 0; i < count; i++) {
        change[i] = longer * (s->velocity[first + i] - s->step_velocity[first + i]);
    }
    kinetic_energies(s, t, change, energy);
    add_all(&sum[HALF_KICK], energy, rg_tile_eblocks(t) * RG_LANES);
}

/* Energies of the elements of a tile, to sum `all` and to that of their materials. */
static void add_elements(rg_exact_sum *sum, const rg_solver *s, const rg_tile *t, const double *energy,
                         int all, int part) {
    add_all(&sum[all], energy, rg_tile_eblocks(t) * RG_LANES);
    for (size_t b = 0; told_materials(s) > 1 && b < rg_tile_eblocks(t); b++) {
        add_all(&parts_of_block(sum, s, t->begin + b)[part], energy + b * RG_LANES, RG_LANES);
    }
}

static void element_energies(rg_solver *s, const rg_tile *t, const rg_workspace *w, double *energy,
                             rg_real *change, rg_exact_sum *sum) {
    rg_tile_state(s, t, w, energy, NULL, NULL);
    add_elements(sum, s, t, energy, BULK, PART_BULK);
    kinetic_energies(s, t, s->step_velocity + t->begin * RG_NODE_BLOCK, energy);
    add_elements(sum, s, t, energy, KINETIC, PART_KINETIC);
    add_half_kick(sum, s, t, change, energy);
    for (size_t slot = t->begin * RG_LANES; slot < t->end * RG_LANES; slot++) {
        if (s->domain->id[slot] >= 0) {
            add_released(sum, s, slot);
            add_heat(sum, s, slot);
            if (s->heat != NULL) {
                rg_exact_add(&sum[VISCOUS], s->heat[slot]);
                rg_exact_add(&parts_of_block(sum, s, slot / RG_LANES)[PART_DISSIPATED], s->heat[slot]);
            }
            if (s->contact_heat != NULL) {
                rg_exact_add(&sum[FRICTION], s->contact_heat[slot]);
                rg_exact_add(&parts_of_block(sum, s, slot / RG_LANES)[PART_DISSIPATED],
                             s->contact_heat[slot]);
            }
            rg_exact_add(&sum[VOLUME], s->domain->geom[rg_geom_index(slot, RG_GEOM_VOLUME)]);
            add_momentum(sum, s, slot);
        }
    }
}

static void add_areas(rg_exact_sum *sum, const rg_solver *s, size_t i) {
    static const double weight[2] = {RG_TRI_W0, RG_TRI_W1};
    double normal[3], area = rg_interface_area(s->domain, i, normal);
    for (int q = 0; q < RG_POINTS; q++) {
        if (rg_point_is_broken(s, i, q)) {
            rg_exact_add(&sum[BROKEN], weight[q / 3] * area);
            bool failed = *rg_crack_value(s, i, q, RG_CRACK_OPENING) >= rg_separation(s, i, q);
            rg_exact_add(&sum[FAILED], failed ? weight[q / 3] * area : 0);
        }
    }
}

/* Half of what was dissipated at a face to the material of each side. */
static void share_out(rg_exact_sum *sum, const rg_solver *s, size_t i, double dissipated) {
    for (int k = 0; k < 2; k++) {
        int m = s->domain->beside != NULL ? s->domain->beside[i][k] : 0;
        rg_exact_add(&parts_of(sum, s, m)[PART_DISSIPATED], 0.5 * dissipated);
    }
}

static void add_friction(rg_exact_sum *sum, const rg_solver *s, size_t i) {
    for (int q = 0; q < RG_POINTS && s->model->law.sliding == RG_SLIDING_COULOMB; q++) {
        if (s->broken[i] >> q & 1) {
            double heat = *rg_friction_value(s, i, q, RG_FRICTION_HEAT);
            rg_exact_add(&sum[FRICTION], heat);
            share_out(sum, s, i, heat);
        }
    }
}

/* What came free at a face of tile t, beyond what the law of its points can take. */
static void raise_unresolved(rg_peak *most, const rg_solver *s, const rg_tile *t, size_t i, double energy) {
    size_t link = (size_t)s->domain->side[0][i], slot = t->begin * RG_LANES + link / RG_FACES;
    rg_peak here = {.value = energy, .face = RG_FACES * s->domain->id[slot] + (int64_t)(link % RG_FACES)};
    for (int c = 0; c < 3; c++) {
        for (int a = 0; a < RG_FCORNERS; a++) {
            here.place[c] +=
                s->domain->corner[12 * slot + (size_t)(3 * rg_face_node[link % RG_FACES][a] + c)] / 3;
        }
    }
    *most = rg_peak_of(most, &here);
}

/* Of the two copies of a tile-boundary face one is counted. */
static void interface_energies(rg_solver *s, const rg_tile *t, const rg_workspace *w, double *energy,
                               rg_exact_sum *sum, rg_peak *unresolved) {
    rg_interface_args interface = rg_tile_interfaces(s, t, w);
    rg_interface_state_args args = {&interface, energy};
    s->kernels->interface_state(&args, 0, rg_tile_iblocks(t));
    for (size_t i = t->ibegin * RG_LANES; i < t->iend * RG_LANES; i++) {
        if (!s->domain->counted[i]) {
            continue;
        }
        for (size_t k = 0; k < RG_E_INTERFACE; k++) {
            size_t row = i / RG_LANES - t->ibegin;
            rg_exact_add(&sum[INTERFACE + k], energy[(row * RG_E_INTERFACE + k) * RG_LANES + i % RG_LANES]);
        }
        if (s->broken[i]) {
            const double *of = energy + (i / RG_LANES - t->ibegin) * RG_E_INTERFACE * RG_LANES + i % RG_LANES;
            share_out(sum, s, i, of[RG_E_DISSIPATED * RG_LANES]);
            if (of[RG_E_UNRESOLVED * RG_LANES] != 0) {
                raise_unresolved(unresolved, s, t, i, of[RG_E_UNRESOLVED * RG_LANES]);
            }
            if (!rg_face_is_open(s, i)) {
                add_areas(sum, s, i);
            }
            add_friction(sum, s, i);
        }
    }
}

static void sum_up(rg_solver *s, rg_exact_sum *sum, rg_peak *unresolved) {
    const rg_domain *d = s->domain;
    size_t most =
        d->tile_iblocks * RG_E_INTERFACE > d->tile_blocks ? d->tile_iblocks * RG_E_INTERFACE : d->tile_blocks;
#pragma omp parallel
    {
        rg_exact_sum *mine = RG_NEW(rg_exact_sum, sums(s));
        rg_peak peak = {0};
        rg_workspace *w = &s->work[omp_get_thread_num()];
        double *energy = RG_NEW(double, most *RG_LANES);
        rg_real *change = RG_NEW(rg_real, d->tile_blocks * RG_NODE_BLOCK);
#pragma omp for schedule(static) nowait
        for (size_t t = 0; t < d->tiles; t++) {
            rg_tile_receive(s, &d->tile[t], w);
            element_energies(s, &d->tile[t], w, energy, change, mine);
            interface_energies(s, &d->tile[t], w, energy, mine, &peak);
            rg_bodies_energy(s->bodies, t, s->u, s->body_clear, &mine[INTERFACE + RG_E_CONTACT]);
            rg_loads_energy(s->loads, t, s->u, &mine[FOUNDATION], &mine[BRIEF]);
            if (s->contacts != NULL) {
                rg_contacts_energy(s->contacts, t, &mine[INTERFACE + RG_E_CONTACT]);
            }
        }
        rg_free(change);
        rg_free(energy);
#pragma omp critical
        {
            for (size_t k = 0; k < sums(s); k++) {
                rg_exact_merge(&sum[k], &mine[k]);
            }
            *unresolved = rg_peak_of(unresolved, &peak);
        }
        rg_free(mine);
    }
}

/* All sums over the whole body: v[sums]. */
static void values(rg_solver *s, double *v, rg_peak *unresolved) {
    rg_exact_sum *sum = RG_NEW(rg_exact_sum, sums(s));
    rg_constraints_work(s->constraints, &sum[EXTERNAL]);
    sum_up(s, sum, unresolved);
    rg_exact_allreduce(sum, (int)sums(s), s->comm);
    for (size_t k = 0; k < sums(s); k++) {
        v[k] = rg_exact_value(&sum[k]);
    }
    rg_free(sum);
}

static rg_energy energy_of(const rg_solver *s, const double *v) {
    const double *part = v + INTERFACE;
    rg_bodies_account bodies = rg_bodies_take(s->bodies, longer_step(s));
    rg_energy e = {.step = s->step,
                   .time = s->time,
                   .kinetic = v[KINETIC],
                   .bodies = bodies.kinetic,
                   .half_kick = v[HALF_KICK] + bodies.half_kick,
                   .bulk = v[BULK],
                   .penalty = part[RG_E_PENALTY],
                   .cohesive = part[RG_E_COHESIVE],
                   .contact = part[RG_E_CONTACT],
                   .foundation = v[FOUNDATION],
                   .dissipated = part[RG_E_DISSIPATED],
                   .unresolved = part[RG_E_UNRESOLVED] + s->openings.released,
                   .plastic = v[RELEASED + RG_RELEASED_PLASTIC],
                   .damage = v[RELEASED + RG_RELEASED_DAMAGE],
                   .viscous = v[VISCOUS],
                   .friction = v[FRICTION],
                   .radiated = rg_absorbing_radiated(s->absorbing),
                   .relaxed = s->relaxed.heat,
                   .joined = rg_ties_taken(s->ties),
                   .external =
                       v[EXTERNAL] + bodies.work + rg_loads_work(s->loads) + v[BRIEF] + s->relaxed.work,
                   .broken_area = v[BROKEN],
                   .failed_area = v[FAILED],
                   .momentum = {v[MOMENTUM], v[MOMENTUM + 1], v[MOMENTUM + 2]},
                   .angular_momentum = {v[ANGULAR], v[ANGULAR + 1], v[ANGULAR + 2]}};
    for (int c = 0; c < 3; c++) {
        e.momentum[c] += bodies.momentum[c];
        e.angular_momentum[c] += bodies.angular_momentum[c];
    }
    e.spent = e.dissipated + e.plastic + e.damage + e.viscous + e.friction;
    return e;
}

/* What rounding of F makes of the energy of a body at rest (J). */
static double rounding(const rg_solver *s, double volume) {
    double mu = 0;
    for (int m = 0; m < s->model->materials; m++) {
        mu = fmax(mu, s->model->material[m].mu);
    }
    return 1e3 * DBL_EPSILON * mu * volume;
}

/* A change of the total (J) over what has been dissipated, once that is enough to judge by. */
static double over_spent(const rg_ledger *l, double change) {
    return l->last.spent > RG_JUDGED * l->largest ? change / l->last.spent : NAN;
}

const rg_energy *rg_ledger_take(rg_ledger *l, rg_solver *s) {
    double *v = RG_NEW(double, sums(s));
    rg_peak unresolved = {0};
    values(s, v, &unresolved);
    rg_energy *e = &l->last;
    *e = energy_of(s, v);
    double stored = e->kinetic + e->bodies + e->bulk + e->penalty + e->cohesive + e->contact + e->foundation +
                    e->unresolved + e->spent;
    e->total = stored + e->radiated + e->relaxed + e->joined - e->half_kick - e->external;
    if (!l->begun) {
        *l = (rg_ledger){.begun = true, .start = e->total, .last = *e};
    }
    l->unresolved = rg_peak_reduce(&unresolved, s->comm); /* a checkpoint holds that of rank 0 */
    for (int m = 0; m < told_materials(s); m++) {
        const double *part = v + PARTS + PART * m;
        l->material[m] = (rg_energy_part){part[PART_KINETIC], part[PART_BULK], part[PART_DISSIPATED]};
    }
    double change = e->total - l->start;
    l->largest = fmax(fmax(l->largest, fabs(stored)), rounding(s, v[VOLUME]));
    e->error = change == 0 ? 0 : change / l->largest;
    e->share = over_spent(l, change);
    l->change = isnan(change) ? INFINITY : fmax(l->change, fabs(change));
    rg_free(v);
    return e;
}

double rg_ledger_worst(const rg_ledger *l) {
    return l->change > 0 ? l->change / l->largest : 0;
}

double rg_ledger_share(const rg_ledger *l) {
    return over_spent(l, l->change);
}

bool rg_ledger_off(const rg_ledger *l, const rg_case *c, char *why, size_t size) {
    const rg_energy *e = &l->last;
    double limit = c->output.energy_limit, of_spent = c->output.dissipation_limit;
    if (!(fabs(e->error) <= limit)) {
        snprintf(why, size, "the energy error %.3g passed the limit %.3g (output.energy_limit)", e->error,
                 limit);
        return true;
    }
    if (of_spent > 0 && fabs(e->share) > of_spent) {
        snprintf(why, size,
                 "the energy error %.3g of what has been dissipated passed the limit %.3g "
                 "(output.dissipation_limit)",
                 e->share, of_spent);
        return true;
    }
    return false;
}

double rg_first_fracture(const rg_solver *s) {
    double first = INFINITY;
    for (size_t i = 0; i < s->domain->iblocks * RG_LANES; i++) {
        for (int q = 0; s->broken[i] && !rg_face_is_open(s, i) && q < RG_POINTS; q++) {
            if (rg_point_is_broken(s, i, q)) {
                first = fmin(first, *rg_crack_value(s, i, q, RG_CRACK_TIME));
            }
        }
    }
    MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_DOUBLE, MPI_MIN, s->comm);
    return first;
}

void rg_energy_header(rg_csv *t, const rg_solver *s) {
    static const char *const parts[PART] = {"kinetic", "bulk", "dissipated"};
    size_t length = 0;
    char *columns = NULL;
    FILE *f = open_memstream(&columns, &length);
    fputs("step,time,kinetic,bodies,bulk,penalty,cohesive,contact,foundation,dissipated,plastic,damage,"
          "viscous,friction,"
          "unresolved,radiated,half_kick,"
          "external_work,total,error_rel,error_dissipated,broken_area,failed_area,momentum_x,momentum_y,"
          "momentum_z,angular_x,angular_y,angular_z",
          f);
    for (int m = 0; told_materials(s) > 1 && m < told_materials(s); m++) {
        for (int k = 0; k < PART; k++) {
            fprintf(f, ",%s_%s", parts[k], rg_case_material_name(s->input, m));
        }
    }
    if (s->input->start == RG_START_RELAX) {
        fputs(",relaxed", f);
    }
    if (rg_case_joins(s->input)) {
        fputs(",joined", f);
    }
    fclose(f);
    rg_csv_header(t, columns);
    free(columns);
}

void rg_energy_row(rg_csv *t, const rg_ledger *l, const rg_solver *s) {
    const rg_energy *e = &l->last;
    double row[ROW + PART * RG_LEDGER_MATERIALS + 2] = {e->time,
                                                        e->kinetic,
                                                        e->bodies,
                                                        e->bulk,
                                                        e->penalty,
                                                        e->cohesive,
                                                        e->contact,
                                                        e->foundation,
                                                        e->dissipated,
                                                        e->plastic,
                                                        e->damage,
                                                        e->viscous,
                                                        e->friction,
                                                        e->unresolved,
                                                        e->radiated,
                                                        e->half_kick,
                                                        e->external,
                                                        e->total,
                                                        e->error,
                                                        e->share,
                                                        e->broken_area,
                                                        e->failed_area,
                                                        e->momentum[0],
                                                        e->momentum[1],
                                                        e->momentum[2],
                                                        e->angular_momentum[0],
                                                        e->angular_momentum[1],
                                                        e->angular_momentum[2]};
    size_t values = ROW;
    for (int m = 0; told_materials(s) > 1 && m < told_materials(s); m++) {
        row[values++] = l->material[m].kinetic;
        row[values++] = l->material[m].bulk;
        row[values++] = l->material[m].dissipated;
    }
    if (s->input->start == RG_START_RELAX) {
        row[values++] = e->relaxed;
    }
    if (rg_case_joins(s->input)) {
        row[values++] = e->joined;
    }
    rg_csv_row(t, &e->step, 1, row, values);
}
