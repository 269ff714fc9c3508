/* The ledger, the crack surface, the first fracture and the hash of a state drawn at random, against
 * integrals and sums over the whole mesh, on any number of ranks. Prints TAP from rank 0. */
#include "diagnostics/ledger.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "diagnostics/crack_surface.h"
#include "diagnostics/state_hash.h"
#include "domain/element.h"
#include "reference/reference.h"
#include "solver/fields.h"
#include "solver/tile.h"
#include "support/random_state.h"
#include "support/tap_memory.h"

enum { SEED = 11 };
#define EXACT 1e-12 /* of sums of some hundred terms, each rounded */

static bool near(double found, double wanted, double scale) {
    bool good = fabs(found - wanted) <= EXACT * scale;
    if (!good) {
        printf("# %.17g, not %.17g\n", found, wanted);
    }
    return good;
}

static double total(double mine) {
    MPI_Allreduce(MPI_IN_PLACE, &mine, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    return mine;
}

/* ---- integrals over the elements ---- */

/* Points and weights of Gauss and Legendre on [0, 1], exact to degree 7: collapsed, the product of three is
 * exact to degree 5 in a tetrahedron; 4 is wanted. */
static const double gauss_x[4] = {0.069431844202973712, 0.33000947820757187, 0.66999052179242813,
                                  0.93056815579702629};
static const double gauss_w[4] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                  0.17392742256872693};

typedef struct {
    double kinetic, of[2] /* materials */, half_kick, volume, momentum[3], angular[3];
} integrals;

static void at_point(const double x[4][3], rg_gid id, const double l[4], double place[3], double v[3],
                     double kick[3]) {
    double N[RG_NODES];
    rg_shape(l, N);
    for (int c = 0; c < 3; c++) {
        place[c] = l[0] * x[0][c] + l[1] * x[1][c] + l[2] * x[2][c] + l[3] * x[3][c];
        v[c] = kick[c] = 0;
        for (int n = 0; n < RG_NODES; n++) {
            place[c] += N[n] * drawn_u(SEED, id, n, c);
            v[c] += N[n] * drawn_now(SEED, id, n, c);
            kick[c] += N[n] * (drawn_velocity(SEED, id, n, c) - drawn_now(SEED, id, n, c));
        }
    }
}

static double volume_of(double x[4][3]) {
    double e[3][3], cross[3];
    for (int k = 0; k < 3; k++) {
        for (int c = 0; c < 3; c++) {
            e[k][c] = x[k + 1][c] - x[0][c];
        }
    }
    rg_reference_cross(e[1], e[2], cross);
    return fabs(rg_reference_dot(e[0], cross)) / 6;
}

static void integrate(const random_state *r, rg_gid id, integrals *sum) {
    double x[4][3], density = r->solver->model->material[mesh_material(r, id)].density;
    mesh_corners(r->mesh, id, x);
    double volume = volume_of(x);
    sum->volume += volume;
    for (int k = 0; k < 64; k++) {
        double a = gauss_x[k % 4], b = gauss_x[k / 4 % 4], c = gauss_x[k / 16];
        double l[4] = {a, (1 - a) * b, (1 - a) * (1 - b) * c, (1 - a) * (1 - b) * (1 - c)};
        double w = 6 * volume * density * gauss_w[k % 4] * gauss_w[k / 4 % 4] * gauss_w[k / 16] * (1 - a) *
                   (1 - a) * (1 - b);
        double place[3], v[3], turn[3], kick[3];
        at_point((const double(*)[3])x, id, l, place, v, kick);
        rg_reference_cross(place, v, turn);
        sum->kinetic += 0.5 * w * rg_reference_dot(v, v);
        sum->half_kick += 0.5 * w * rg_reference_dot(kick, kick);
        sum->of[mesh_material(r, id)] += 0.5 * w * rg_reference_dot(v, v);
        for (int i = 0; i < 3; i++) {
            sum->momentum[i] += w * v[i];
            sum->angular[i] += w * turn[i];
        }
    }
}

/* ---- sums over elements and faces ---- */

typedef struct {
    double broken, failed, friction, first, heat, plastic, damage;
    double of[2]; /* heat, plastic, damage and half the friction of faces, by material */
    int64_t faces;
} sums;

static double face_area(const rg_mesh *mesh, rg_gid face) {
    double x[4][3], e[2][3], cross[3];
    mesh_corners(mesh, face / 4, x);
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < 2; k++) {
            e[k][c] = x[rg_face_node[face % 4][k + 1]][c] - x[rg_face_node[face % 4][0]][c];
        }
    }
    rg_reference_cross(e[0], e[1], cross);
    return 0.5 * sqrt(rg_reference_dot(cross, cross));
}

static void add_face(const random_state *r, rg_gid face, sums *sum) {
    double l[3], area = face_area(r->mesh, face);
    for (int q = 0; q < RG_POINTS; q++) {
        if ((drawn_broken(SEED, face) >> q & 1) == 0) {
            continue;
        }
        double share = area * rg_reference_face_point(q, l);
        sum->broken += share;
        sum->failed += drawn_damage(SEED, face, q) >= 1 ? share : 0;
        double heat = drawn_friction(SEED, face, q, RG_FRICTION_HEAT);
        sum->friction += heat;
        sum->of[mesh_material(r, face / 4)] += heat / 2;
        sum->of[mesh_material(r, r->mesh->neighbour[face])] += heat / 2;
        sum->first = fmin(sum->first, drawn_time(SEED, face, q));
    }
    sum->faces += drawn_broken(SEED, face) != 0;
}

static sums add_up(const random_state *r) {
    sums sum = {.first = INFINITY};
    for (rg_gid id = 0; id < r->mesh->elements; id++) {
        double heat = drawn_heat(SEED, id), plastic = 0, damage = 0;
        if (mesh_material(r, id) == 1) {
            plastic = drawn_history(SEED, id, RG_J2_HISTORY, RG_GAUSS * RG_J2_HISTORY + RG_RELEASED_PLASTIC);
            damage = drawn_history(SEED, id, RG_J2_HISTORY, RG_GAUSS * RG_J2_HISTORY + RG_RELEASED_DAMAGE);
        }
        sum.heat += heat;
        sum.plastic += plastic;
        sum.damage += damage;
        sum.of[mesh_material(r, id)] += heat + plastic + damage;
        for (int f = 0; f < 4; f++) {
            if (r->mesh->neighbour[4 * id + f] > id) {
                add_face(r, 4 * id + f, &sum);
            }
        }
    }
    return sum;
}

/* By the reference kernels: energies of the bulk, and of the interfaces by kind; by material that of the bulk
 * and what cracks have dissipated, half of it on each side. */
typedef struct {
    double bulk, part[RG_E_INTERFACE], bulk_of[2], dissipated_of[2];
} stored_parts;

static void add_interface(const random_state *r, const rg_tile *t, size_t i, const double *energy,
                          stored_parts *sum) {
    for (int k = 0; k < RG_E_INTERFACE; k++) {
        sum->part[k] += energy[(size_t)k * RG_LANES + i % RG_LANES];
    }
    rg_gid face = interface_key(r, t, i);
    double half = energy[RG_E_DISSIPATED * RG_LANES + i % RG_LANES] / 2;
    sum->dissipated_of[mesh_material(r, face / 4)] += half;
    sum->dissipated_of[mesh_material(r, r->mesh->neighbour[face])] += half;
}

static stored_parts stored_energies(const random_state *r) {
    const rg_solver *s = r->solver;
    const rg_domain *d = s->domain;
    stored_parts sum = {0};
    for (size_t k = 0; k < d->tiles; k++) {
        const rg_tile *t = &d->tile[k];
        double energy[RG_E_INTERFACE * RG_LANES];
        rg_tile_receive(s, t, s->work);
        for (size_t b = 0; b < t->end - t->begin; b++) {
            rg_bulk_args bulk_args = rg_tile_bulk(s, t, s->work, b);
            rg_bulk_state_args args = {.bulk = &bulk_args, .energy = energy};
            rg_reference_bulk_state(&args, b, b + 1);
            for (size_t lane = 0; lane < RG_LANES; lane++) {
                rg_gid id = d->id[(t->begin + b) * RG_LANES + lane];
                sum.bulk += id >= 0 ? energy[lane] : 0;
                sum.bulk_of[id >= 0 ? mesh_material(r, id) : 0] += id >= 0 ? energy[lane] : 0;
            }
        }
        rg_interface_args interface_args = rg_tile_interfaces(s, t, s->work);
        rg_interface_state_args args = {&interface_args, energy};
        for (size_t b = 0; b < t->iend - t->ibegin; b++) {
            rg_reference_interface_state(&args, b, b + 1);
            for (size_t i = (t->ibegin + b) * RG_LANES; i < (t->ibegin + b + 1) * RG_LANES; i++) {
                if (d->counted[i]) {
                    add_interface(r, t, i, energy, &sum);
                }
            }
        }
    }
    MPI_Allreduce(MPI_IN_PLACE, &sum, sizeof sum / sizeof(double), MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    return sum;
}

static double body_energy(const rg_solver *s) {
    rg_exact_sum sum = {0};
    for (size_t t = 0; t < s->domain->tiles; t++) {
        rg_bodies_energy(s->bodies, t, s->u, NULL, &sum);
    }
    return total(rg_exact_value(&sum));
}

/* Work of the prescribed motions up to the present time: the second value of their rows. */
static double constraint_work(rg_solver *s) {
    rg_state state = {0};
    double sum = 0;
    rg_state_of_solver(&state, s);
    for (int k = 0; k < state.arrays; k++) {
        const rg_state_array *a = &state.array[k];
        double row[256];
        for (size_t i = 0; a->of == RG_OF_LIST && i < a->records; i++) {
            rg_state_get(a, i, row);
            sum += row[1];
        }
    }
    return total(sum);
}

/* ---- the ledger ---- */

static void check_energies(random_state *r) {
    rg_ledger ledger = {0};
    const rg_energy *e = rg_ledger_take(&ledger, r->solver);
    integrals whole = {0};
    for (rg_gid id = 0; id < r->mesh->elements; id++) {
        integrate(r, id, &whole);
    }
    for (int i = 0; i < r->solver->bodies->count; i++) {
        const rg_body *b = &r->solver->bodies->body[i];
        double kick[3] = {b->v[0] - b->seen.v[0], b->v[1] - b->seen.v[1], b->v[2] - b->seen.v[2]};
        whole.half_kick += isfinite(b->mass) ? 0.5 * b->mass * rg_reference_dot(kick, kick) : 0;
    }
    double longer = r->solver->dt / r->solver->dt_next; /* the step ahead is the shorter one */
    whole.half_kick *= longer * longer;
    sums sum = add_up(r);
    stored_parts in = stored_energies(r);
    double bulk = in.bulk, *part = in.part, touch = body_energy(r->solver);
    part[RG_E_CONTACT] += touch;
    rg_bodies_account bodies = rg_bodies_take(r->solver->bodies, longer);
    report(e == &ledger.last && e->step == r->solver->step && e->time == r->solver->time, "ledger",
           "step and time");
    report(near(e->kinetic, whole.kinetic, whole.kinetic), "ledger", "kinetic energy");
    report(near(e->bulk, bulk, bulk), "ledger", "energy of the bulk");
    report(near(e->penalty, part[RG_E_PENALTY], part[RG_E_PENALTY]) &&
               near(e->cohesive, part[RG_E_COHESIVE], part[RG_E_COHESIVE]) &&
               near(e->contact, part[RG_E_CONTACT], part[RG_E_CONTACT]) &&
               touch > 1e-6 * part[RG_E_CONTACT] &&

               near(e->dissipated, part[RG_E_DISSIPATED], part[RG_E_DISSIPATED]) && e->unresolved == 0 &&
               part[RG_E_UNRESOLVED] == 0,
           "ledger", "energies of the interfaces");
    report(near(e->half_kick, whole.half_kick, whole.half_kick), "ledger",
           "half a kick, of the longer of both steps");
    report(near(e->plastic, sum.plastic, sum.plastic) && near(e->damage, sum.damage, sum.damage), "ledger",
           "set free in the bulk");
    report(near(e->viscous, sum.heat, sum.heat) && near(e->friction, sum.friction, sum.friction), "ledger",
           "heat");
    report(near(e->broken_area, sum.broken, sum.broken) && near(e->failed_area, sum.failed, sum.failed),
           "ledger", "areas");
    double work = constraint_work(r->solver) + bodies.work;
    report(near(e->external, work, 1) && bodies.work != 0 && fabs(work - bodies.work) > 1e-5, "ledger",
           "external work");
    report(e->bodies == bodies.kinetic && bodies.kinetic > 1e3 * EXACT * e->kinetic, "ledger",
           "kinetic energy of bodies");
    bool good = true;
    for (int c = 0; c < 3; c++) {
        double scale = fabs(whole.momentum[2]), turn = fabs(whole.angular[0]);
        good = near(e->momentum[c], whole.momentum[c] + bodies.momentum[c], scale) && good;
        good = near(e->angular_momentum[c], whole.angular[c] + bodies.angular_momentum[c], turn) && good;
        good = fabs(bodies.momentum[c]) > 100 * EXACT * scale &&
               fabs(bodies.angular_momentum[c]) > 100 * EXACT * turn && good;
    }
    report(good, "ledger", "momentum and angular momentum");
    double stored = e->kinetic + e->bodies + bulk + part[0] + part[1] + part[2] + part[3] + part[4] +
                    sum.plastic + sum.damage + sum.heat + sum.friction;
    double spent = part[RG_E_DISSIPATED] + sum.plastic + sum.damage + sum.heat + sum.friction;
    report(near(e->spent, spent, spent), "ledger", "all that was dissipated");
    for (int m = 0; m < 2; m++) {
        const rg_energy_part *p = &ledger.material[m];
        double dissipated = in.dissipated_of[m] + sum.of[m];
        report(near(p->kinetic, whole.of[m], whole.kinetic) && near(p->bulk, in.bulk_of[m], bulk) &&
                   near(p->dissipated, dissipated, spent) && whole.of[m] > 0.05 * whole.kinetic &&
                   in.bulk_of[m] > 0.05 * bulk && in.dissipated_of[m] > 0.01 * part[RG_E_DISSIPATED],
               "ledger", m == 0 ? "of the first material" : "of the second material");
    }
    report(near(e->total, stored - whole.half_kick - work, stored) && e->error == 0 &&
               rg_ledger_worst(&ledger) == 0 && ledger.begun && ledger.start == e->total &&
               near(ledger.largest, stored, stored),
           "ledger", "total");
    report(rg_first_fracture(r->solver) == sum.first, "ledger", "first fracture");
    report(memcmp(&ledger.last, e, sizeof *e) == 0, "ledger", "the last one is kept");
}

/* What came free at switches beyond the work of separation, 34 J/m2 at 400 MPa. */
static void check_unresolved(uint64_t seed) {
    const char *change[] = {"interface.activation=conserving"};
    random_state r = random_state_make(1, change, MPI_COMM_WORLD);
    random_state_draw(&r, seed);
    rg_ledger ledger = {0};
    double wanted = 0, most = 0, strength = 400e6, opening = 2 * 34 / strength;
    rg_gid where = -1;
    for (rg_gid face = 0; face < 4 * r.mesh->elements; face++) {
        double here = 0;
        for (int q = 0; q < RG_POINTS && r.mesh->neighbour[face] > face / 4; q++) {
            double l[3], share = face_area(r.mesh, face) * rg_reference_face_point(q, l);
            double given = (rg_real)(drawn(seed, DRAW_GIVEN, face, q) * opening);
            bool broken = drawn_broken(seed, face) >> q & 1;
            here += broken ? share * strength * fmax(0, given - opening / 2) : 0;
        }
        wanted += here;
        where = here > most ? face : where;
        most = fmax(most, here);
    }
    const rg_energy *e = rg_ledger_take(&ledger, r.solver);
    report(near(e->unresolved, wanted, wanted) && wanted > 0, "ledger", "what no law can take");
    rg_peak peak = ledger.unresolved; /* on all ranks the same */
    double x[4][3];
    mesh_corners(r.mesh, where / 4, x);
    const rg_gid *beyond = r.mesh->neighbour; /* a face has a number on either side */
    bool same = peak.face == where || (peak.face / 4 == beyond[where] && beyond[peak.face] == where / 4);
    bool there = near(peak.value, most, most) && most > 0 && same;
    for (int c = 0; c < 3; c++) {
        const int *corner = rg_face_node[where % 4];
        there = near(peak.place[c], (x[corner[0]][c] + x[corner[1]][c] + x[corner[2]][c]) / 3, 1e-3) && there;
    }
    report(there, "ledger", "the face with most of it");
    double parts =
        e->kinetic + e->bodies + e->bulk + e->penalty + e->cohesive + e->contact + e->foundation + e->spent;
    report(near(e->total, parts + e->unresolved - e->half_kick - e->external, parts) &&
               wanted > 1e3 * EXACT * parts,
           "ledger", "total with what no law can take");
    random_state_free(&r);
}

/* Times `factor` all velocities, which only the kinetic energy knows; no step follows. */
static void scale_velocity(rg_solver *s, double factor) {
    for (size_t i = 0; i < s->domain->blocks * RG_NODE_BLOCK; i++) {
        s->step_velocity[i] = (rg_real)(factor * s->step_velocity[i]);
        s->velocity[i] = s->step_velocity[i];
    }
}

/* The words that a ledger gets with these limits; "" where it is within them. */
static const char *off(const random_state *r, const rg_ledger *l, double limit, double of_dissipated) {
    static char why[200];
    rg_case c = *r->input;
    c.output.energy_limit = limit;
    c.output.dissipation_limit = of_dissipated;
    why[0] = '\0';
    bool is = rg_ledger_off(l, &c, why, sizeof why);
    return is == (why[0] != '\0') ? why : "?";
}

static void check_limits(const random_state *r, const rg_ledger *l, double error, double share) {
    char wanted[2][200];
    snprintf(wanted[0], sizeof wanted[0], "the energy error %.3g passed the limit %.3g (output.energy_limit)",
             l->last.error, 0.99 * error);
    snprintf(wanted[1], sizeof wanted[1],
             "the energy error %.3g of what has been dissipated passed the limit %.3g "
             "(output.dissipation_limit)",
             l->last.share, 0.99 * share);
    report(strcmp(off(r, l, 1.01 * error, 0), "") == 0 &&
               strcmp(off(r, l, 1.01 * error, 1.01 * share), "") == 0 &&
               strcmp(off(r, l, 0.99 * error, 1.01 * share), wanted[0]) == 0 &&
               strcmp(off(r, l, 1.01 * error, 0.99 * share), wanted[1]) == 0,
           "ledger", "limits");
    rg_ledger early = *l;
    early.last.share = NAN;
    report(strcmp(off(r, &early, 1.01 * error, 0.99 * share), "") == 0, "ledger",
           "no limit where little was dissipated");
    early.last.error = NAN;
    report(strcmp(off(r, &early, 1, 0), "") != 0, "ledger", "no number is no energy");
}

static void check_errors(random_state *r) {
    rg_ledger ledger = {0};
    scale_velocity(r->solver, 1);
    rg_energy first = *rg_ledger_take(&ledger, r->solver);
    double stored = first.total + first.external;
    scale_velocity(r->solver, 2);
    rg_energy second = *rg_ledger_take(&ledger, r->solver);
    double gain = 3 * first.kinetic, most = stored + gain;
    report(near(second.total, first.total + gain, most) && near(second.error, gain / most, 1) &&
               near(rg_ledger_worst(&ledger), gain / most, 1) && ledger.start == first.total &&
               near(ledger.largest, most, most),
           "ledger", "error over the largest energy");
    scale_velocity(r->solver, 0.25);
    rg_energy third = *rg_ledger_take(&ledger, r->solver);
    double loss = 0.75 * first.kinetic;
    report(near(third.error, -loss / most, 1) && near(rg_ledger_worst(&ledger), gain / most, 1) &&
               near(ledger.largest, most, most),
           "ledger", "the largest error and energy stay");
    scale_velocity(r->solver, 0);
    rg_energy fourth = *rg_ledger_take(&ledger, r->solver);
    report(near(fourth.error, -first.kinetic / most, 1) && fourth.kinetic == 0, "ledger", "a loss");
    for (size_t slot = 0; slot < r->solver->domain->blocks * RG_LANES; slot++) {
        if (r->solver->domain->id[slot] == 0) {
            r->solver->step_velocity[rg_node_index(slot, 3, 1)] = (rg_real)NAN;
        }
    }
    rg_ledger_take(&ledger, r->solver);
    report(isinf(rg_ledger_worst(&ledger)) && rg_ledger_worst(&ledger) > 0, "ledger",
           "energies that are none");
}

/* Heat of all elements (J). */
static void heat_up(rg_solver *s, double each) {
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        s->heat[slot] = s->domain->id[slot] >= 0 ? each : 0;
    }
}

/* The change over what was dissipated, once that is a hundredth of the largest energy. */
static void check_share(void) {
    random_state r = random_state_make(0, NULL, MPI_COMM_WORLD);
    random_state_draw(&r, SEED);
    scale_velocity(r.solver, 1);
    memset(r.solver->u, 0, r.solver->domain->blocks * RG_NODE_BLOCK * sizeof *r.solver->u);
    rg_ledger ledger = {0};
    rg_energy first = *rg_ledger_take(&ledger, r.solver);
    double stored = first.total + first.external, each = stored / (double)r.mesh->elements;
    report(isnan(first.share) && isnan(rg_ledger_share(&ledger)) && stored > 0, "ledger",
           "nothing to judge by");
    double before = first.spent - first.viscous;
    heat_up(r.solver, 0.5 * each);
    rg_energy second = *rg_ledger_take(&ledger, r.solver);
    double gain = 0.5 * stored - first.viscous, spent = before + 0.5 * stored;
    report(near(second.spent, spent, spent) && near(second.share, gain / spent, 1) &&
               near(rg_ledger_share(&ledger), gain / spent, 1),
           "ledger", "error over what was dissipated");
    check_limits(&r, &ledger, second.error, second.share);
    heat_up(r.solver, 0.25 * each);
    rg_energy third = *rg_ledger_take(&ledger, r.solver);
    spent = before + 0.25 * stored;
    report(near(third.share, (0.25 * stored - first.viscous) / spent, 1) &&
               near(rg_ledger_share(&ledger), gain / spent, 1),
           "ledger", "the largest change over what was dissipated at last");
    for (int more = 0; more < 2; more++) {
        heat_up(r.solver,
                ((more ? 1.001 : 0.999) * RG_JUDGED * ledger.largest - before) / (double)r.mesh->elements);
        rg_energy fourth = *rg_ledger_take(&ledger, r.solver);
        report(isnan(fourth.share) == !more && isnan(rg_ledger_share(&ledger)) == !more, "ledger",
               more ? "enough to judge by" : "not enough to judge by");
    }
    random_state_free(&r);
}

/* A loss that is larger than all gains before makes the worst error; and one of a body next to rest is
 * weighed by the rounding of F. */
static void check_rest(void) {
    random_state r = random_state_make(0, NULL, MPI_COMM_WORLD);
    rg_ledger ledger = {0};
    rg_energy e = *rg_ledger_take(&ledger, r.solver);
    rg_bodies_account bodies = rg_bodies_take(r.solver->bodies, 1);
    report(isnan(e.share) && isnan(rg_ledger_share(&ledger)) &&
               e.total == bodies.kinetic - bodies.half_kick - bodies.work && e.error == 0 &&
               e.broken_area == 0 && e.failed_area == 0 && isinf(rg_first_fracture(r.solver)),
           "ledger", "at rest");
    double volume = 1.1e-3 * 1.7e-3 * 2.9e-3, mu = 210e9 / 2.6;
    report(near(ledger.largest, 1e3 * DBL_EPSILON * mu * volume, ledger.largest), "ledger",
           "what rounding makes of F");
    for (size_t slot = 0; slot < r.solver->domain->blocks * RG_LANES; slot++) {
        for (int n = 0; n < RG_NODES && r.solver->domain->id[slot] >= 0; n++) {
            r.solver->step_velocity[rg_node_index(slot, n, 1)] = (rg_real)1e-4;
        }
    }
    scale_velocity(r.solver, 1);
    e = *rg_ledger_take(&ledger, r.solver);
    report(e.kinetic > 0 && near(e.error, e.kinetic / ledger.largest, 1e-3), "ledger", "an error of that");
    for (size_t slot = 0; slot < r.solver->domain->blocks * RG_LANES; slot++) {
        for (int n = 0; n < RG_NODES && r.solver->domain->id[slot] >= 0; n++) {
            r.solver->step_velocity[rg_node_index(slot, n, 1)] = 10;
        }
    }
    scale_velocity(r.solver, 1);
    memset(&ledger, 0, sizeof ledger);
    rg_ledger_take(&ledger, r.solver);
    scale_velocity(r.solver, 0.1);
    rg_ledger_take(&ledger, r.solver);
    report(near(rg_ledger_worst(&ledger), 0.99, 1), "ledger", "a loss is an error, too");
    random_state_free(&r);
}

/* Without friction, viscosity, histories and bodies; on an intrinsic interface broken is what is separated.
 */
static void check_plain(void) {
    const char *change[] = {
        "interface.friction=0", "viscosity.linear=0",       "materials=[]",          "bodies=[]",
        "boundary=[]",          "interface.form=intrinsic", "interface.law=bilinear"};
    for (int intrinsic = 0; intrinsic < 2; intrinsic++) {
        random_state r = random_state_make(intrinsic ? 7 : 5, change, MPI_COMM_WORLD);
        random_state_draw(&r, SEED);
        rg_ledger ledger = {0};
        const rg_energy *e = rg_ledger_take(&ledger, r.solver);
        sums sum = {.first = INFINITY};
        int64_t faces = 0;
        for (rg_gid key = 0; key < 4 * r.mesh->elements; key++) {
            bool any = false;
            for (int q = 0; q < RG_POINTS && r.mesh->neighbour[key] > key / 4; q++) {
                double l[3], share = face_area(r.mesh, key) * rg_reference_face_point(q, l);
                bool bit = drawn_broken(SEED, key) >> q & 1, failed = drawn_damage(SEED, key, q) >= 1;
                if (bit && (failed || !intrinsic)) {
                    sum.broken += share;
                    sum.failed += failed ? share : 0;
                    sum.first = fmin(sum.first, drawn_time(SEED, key, q));
                    any = true;
                }
            }
            faces += any;
        }
        rg_crack_face *face;
        size_t count = rg_crack_surface(r.solver, &face);
        report(e->friction == 0 && e->viscous == 0 && e->plastic == 0 && e->damage == 0 && e->bodies == 0 &&
                   e->external == 0 && e->bulk > 0 && e->kinetic > 0,
               "plain", intrinsic ? "intrinsic: no other energies" : "no other energies");
        report(near(e->broken_area, sum.broken, sum.broken) && near(e->failed_area, sum.failed, sum.failed) &&
                   rg_first_fracture(r.solver) == sum.first && total((double)count) == (double)faces,
               "plain", intrinsic ? "intrinsic: what is broken" : "what is broken");
        rg_free(face);
        random_state_free(&r);
    }
}

/* The HRZ mass has its own momentum: of each node by itself. */
static void check_lumped(void) {
    const char *change[] = {"mass=lumped"};
    random_state r = random_state_make(1, change, MPI_COMM_WORLD);
    random_state_draw(&r, SEED);
    rg_ledger ledger = {0};
    const rg_energy *e = rg_ledger_take(&ledger, r.solver);
    rg_bodies_account bodies = rg_bodies_take(r.solver->bodies, 1);
    double kinetic = 0, momentum[3] = {0, 0, 0};
    for (rg_gid id = 0; id < r.mesh->elements; id++) {
        double x[4][3];
        mesh_corners(r.mesh, id, x);
        double mass = volume_of(x) * r.solver->model->material[mesh_material(&r, id)].density;
        for (int k = 0; k < 3 * RG_NODES; k++) {
            double m = mass * (k / 3 < 4 ? 1. / 36 : 4. / 27), v = drawn_now(SEED, id, k / 3, k % 3);
            kinetic += 0.5 * m * v * v;
            momentum[k % 3] += m * v;
        }
    }
    bool good = near(e->kinetic, kinetic, kinetic);
    for (int c = 0; c < 3; c++) {
        good = near(e->momentum[c], momentum[c] + bodies.momentum[c], fabs(momentum[2])) && good;
    }
    report(good, "ledger", "lumped mass");
    random_state_free(&r);
}

/* ---- the crack surface ---- */

static rg_crack_face wanted_face(const random_state *r, rg_gid key) {
    rg_crack_face f = {.time = INFINITY};
    rg_gid id[2] = {key / 4, r->mesh->neighbour[key]};
    int face[2] = {(int)(key % 4), r->mesh->face[key]};
    double x[4][3], area[3], n[3], jump[3] = {0, 0, 0}, e[2][3], l[3], out[3];
    mesh_corners(r->mesh, id[0], x);
    for (int a = 0; a < RG_FNODES; a++) {
        for (int c = 0; c < 3; c++) {
            double minus = drawn_u(SEED, id[0], rg_face_node[face[0]][a], c);
            double plus = drawn_u(SEED, id[1], rg_face_node[face[1]][a], c);
            if (a < 3) {
                f.x[a][c] = x[rg_face_node[face[0]][a]][c] + (minus + plus) / 2;
            } else {
                jump[c] += (plus - minus) / 3;
            }
        }
    }
    for (int c = 0; c < 3; c++) {
        e[0][c] = f.x[1][c] - f.x[0][c];
        e[1][c] = f.x[2][c] - f.x[0][c];
        out[c] = x[rg_face_node[face[0]][0]][c] - x[face[0]][c]; /* from the lower element outwards */
    }
    rg_reference_cross(e[0], e[1], area);
    double size = sqrt(rg_reference_dot(area, area));
    for (int c = 0; c < 3; c++) {
        n[c] = area[c] / size * (rg_reference_dot(area, out) > 0 ? 1 : -1);
    }
    f.opening = rg_reference_dot(jump, n);
    rg_reference_cross(jump, n, e[0]);
    f.slip = sqrt(rg_reference_dot(e[0], e[0]));
    for (int q = 0; q < RG_POINTS; q++) {
        if (drawn_broken(SEED, key) >> q & 1) {
            f.damage += rg_reference_face_point(q, l) * fmin(1, drawn_damage(SEED, key, q));
            f.time = fmin(f.time, drawn_time(SEED, key, q));
        }
    }
    return f;
}

static bool same_face(const rg_crack_face *a, const rg_crack_face *b) {
    bool same = a->time == b->time && fabs(a->damage - b->damage) <= 1e-12 &&
                fabs(a->opening - b->opening) <= 1e-18 && fabs(a->slip - b->slip) <= 1e-13;
    for (int k = 0; k < 9; k++) {
        same = same && fabs(a->x[k / 3][k % 3] - b->x[k / 3][k % 3]) <= 1e-17;
    }
    return same;
}

static void check_cracks(const random_state *r) {
    rg_crack_face *face;
    size_t count = rg_crack_surface(r->solver, &face), found = 0;
    for (rg_gid key = 0; key < 4 * r->mesh->elements; key++) {
        if (r->mesh->neighbour[key] > key / 4 && drawn_broken(SEED, key) != 0) {
            rg_crack_face wanted = wanted_face(r, key);
            for (size_t i = 0; i < count; i++) {
                found += same_face(&face[i], &wanted);
            }
        }
    }
    report(found == count, "crack surface", "each face is one of those that are broken");
    report(total((double)count) == (double)add_up(r).faces, "crack surface", "as many of all ranks together");
    rg_free(face);
}

/* ---- the hash ---- */

/* Whether the hash changes with a value, where the value is `here`, and comes back with it. */
static bool noticed(const rg_solver *s, double *x, bool here) {
    double kept = *x;
    uint64_t before = rg_state_hash(s);
    *x = here ? 1.5 * kept + 1e-9 : kept;
    bool good = rg_state_hash(s) != before;
    *x = kept;
    return rg_state_hash(s) == before && good;
}

static int64_t slot_of(const rg_domain *d, rg_gid id) {
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        if (d->id[slot] == id) {
            return (int64_t)slot;
        }
    }
    return -1;
}

/* Every value of an element of steel, the last one that there is. */
static void check_element_hash(random_state *r) {
    rg_solver *s = r->solver;
    rg_gid id = r->mesh->elements - 1;
    while (mesh_material(r, id) == 0) {
        id--;
    }
    int64_t slot = slot_of(s->domain, id);
    bool here = slot >= 0, good = true;
    size_t at = here ? (size_t)slot : 0;
    for (int k = 0; k < 3 * RG_NODES; k++) {
        good = noticed(s, &s->u[rg_node_index(at, k / 3, k % 3)], here) && good;
        good = noticed(s, &s->step_velocity[rg_node_index(at, k / 3, k % 3)], here) && good;
    }
    for (size_t row = 0; row < rg_history_rows(RG_J2_HISTORY); row++) {
        good = noticed(s, &s->history[rg_history_index(at, s->model->history_stride, row)], here) && good;
    }
    good = noticed(s, &s->heat[at], here) && good;
    report(good, "hash", "every value of an element");
    uint64_t before = rg_state_hash(s);
    for (size_t i = 0; i < s->domain->blocks * RG_LANES; i++) {
        if (s->domain->id[i] < 0) {
            s->u[rg_node_index(i, 1, 1)] += 1;
        }
        s->velocity[rg_node_index(i, 1, 1)] += 1;
    }
    report(rg_state_hash(s) == before, "hash", "nothing else of elements");
}

static void check_face_hash(random_state *r) {
    rg_solver *s = r->solver;
    const rg_domain *d = s->domain;
    bool good = true, here = false;
    size_t at = 0;
    uint64_t before = rg_state_hash(s);
    for (size_t i = 0; rank == 0 && !here && i < d->iblocks * RG_LANES; i++) {
        here = s->broken[i] == (1 << RG_POINTS) - 1 && d->counted[i];
        at = here ? i : 0;
    }
    for (int q = 0; q < RG_POINTS; q++) {
        double *opening = rg_crack_value(s, at, q, RG_CRACK_OPENING), kept = *opening;
        *opening = here ? 0.123 * rg_separation(s, at, q) : kept;
        good = rg_state_hash(s) != before && good;
        *opening = kept;
        for (int k = 0; k < RG_FRICTION; k++) {
            good = noticed(s, rg_friction_value(s, at, q, k), here) && good;
        }
    }
    report(good, "hash", "damage and friction of a broken face");
    for (size_t i = 0; i < d->iblocks * RG_LANES; i++) {
        for (int q = 0; q < RG_POINTS && (s->broken[i] == 0 || !d->counted[i]); q++) {
            *rg_crack_value(s, i, q, RG_CRACK_OPENING) += 1;
            *rg_friction_value(s, i, q, RG_FRICTION_STRETCH) += 1;
        }
    }
    report(rg_state_hash(s) == before, "hash", "nothing of whole faces and second copies");
}

static void check_body_hash(random_state *r) {
    bool good = true, here = rank == 0;
    for (int i = 0; i < 2; i++) {
        rg_body *b = &r->solver->bodies->body[i];
        for (int c = 0; c < 3; c++) {
            good = noticed(r->solver, &b->seen.x[c], here) && good;
            good = noticed(r->solver, &b->seen.v[c], here) && good;
        }
        b->turns = true;
        for (int c = 0; c < 3; c++) {
            good = noticed(r->solver, &b->turn.seen_spin[c], here) && good;
        }
        for (int k = 0; k < 4; k++) {
            good = noticed(r->solver, &b->turn.seen_rotation[k], here) && good;
        }
        b->turns = false;
    }
    report(good, "hash", "every place, velocity, rotation and spin of bodies");
    rg_body_seen kept = r->solver->bodies->body[0].seen;
    uint64_t before = rg_state_hash(r->solver);
    r->solver->bodies->body[0].seen = r->solver->bodies->body[1].seen;
    r->solver->bodies->body[1].seen = kept;
    report(rg_state_hash(r->solver) != before, "hash", "which body is which");
}

/* The same of one rank as of all, and of all versions of the program: results are compared by it. */
static void check_known_hash(void) {
    const char *change[] = {"interface.activation=continuous"};
    random_state all = random_state_make(1, change, MPI_COMM_WORLD),
                 one = random_state_make(1, change, MPI_COMM_SELF);
    random_state_draw(&all, SEED);
    random_state_draw(&one, SEED);
    uint64_t hash = rg_state_hash(all.solver);
    report(hash == rg_state_hash(one.solver), "hash", "the same on one rank");
    if (rank == 0) {
        printf("# hash %016llx\n", (unsigned long long)hash);
    }
    report(hash == UINT64_C(0x94b215759a2afcc7), "hash", "of a known state");
    random_state_draw(&one, SEED + 1);
    report(hash != rg_state_hash(one.solver), "hash", "another state");
    random_state_free(&all);
    random_state_free(&one);
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    const char *change[] = {"interface.activation=continuous"};
    random_state r = random_state_make(1, change, MPI_COMM_WORLD);
    random_state_draw(&r, SEED);
    check_energies(&r);
    for (uint64_t seed = SEED; seed < SEED + 4; seed++) {
        check_unresolved(seed);
    }
    check_cracks(&r);
    check_element_hash(&r);
    check_body_hash(&r);
    random_state_draw(&r, SEED);
    check_face_hash(&r);
    random_state_draw(&r, SEED);
    check_errors(&r);
    random_state_free(&r);
    check_share();
    check_rest();
    check_plain();
    check_lumped();
    check_known_hash();
    return finish_with_nothing_left();
}
