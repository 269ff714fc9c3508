/* The step of the solver against its twin (step_twin.h), on any number of ranks: what lies between the
 * kernels - tiles, tile-boundary faces, rows, links, materials, laws, strengths, shared nodes, prescribed
 * motion, rigid bodies - in every form, with faces that hold, open, break and close. Tiles have several
 * blocks, which meshes under a thousand elements have not by themselves. Prints TAP from rank 0. */
#include <float.h>
#include <math.h>
#include <omp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "base/mem.h"
#include "case/read.h"
#include "domain/element.h"
#include "partition/material_map.h"
#include "reference/reference.h"
#include "solver/setup.h"
#include "solver/step.h"
#include "solver/state.h"
#include "solver/tile.h"
#include "support/step_cases.h"
#include "support/step_twin.h"
#include "support/tap.h"

enum { TILE = 40, STEPS = 16, THREADS = 3 };

/* Relative to the largest value of its kind; measured up to 9.5e-12, in what steep laws remember. The energy
 * of an element at strains of 1e-3 is left of terms that are a million times as large: 2.6e-11. */
#define BOUND        2e-11
#define BOUND_STORED 7e-11

/* ---- Quantities ---- */

/* Of rg_energy, from `kinetic` to the end. */
enum { ENERGIES = (sizeof(rg_energy) - offsetof(rg_energy, kinetic)) / sizeof(double), MOST_HISTORY = 20 };

enum {
    DISPLACEMENT,
    VELOCITY,
    NOW,
    STIFFENING,
    HEAT,
    OPENING_RATE,
    BODY,
    PLACE,
    FORCE,
    FIRST,
    STORED,
    ENERGY,
    HISTORY = ENERGY + ENERGIES,
    CRACK = HISTORY + 2 * MOST_HISTORY,
    KINDS = CRACK + RG_CRACK + RG_LAW_MEMORY + RG_FRICTION
};
static const char *const kind_name[] = {"displacement",
                                        "velocity",
                                        "velocity at the step",
                                        "stiffening",
                                        "heat",
                                        "pace",
                                        "velocity of a body",
                                        "way of a body",
                                        "force on a body",
                                        "first fracture",
                                        "energy of an element",
                                        "energy",
                                        "history",
                                        "crack"};
static const int kind_begin[] = {DISPLACEMENT, VELOCITY, NOW,     STIFFENING, HEAT,
                                 OPENING_RATE, BODY,     PLACE,   FORCE,      FIRST,
                                 STORED,       ENERGY,   HISTORY, CRACK,      KINDS};

/* Largest difference and largest value of each kind on this rank, over all steps. */
typedef struct {
    double error[KINDS], scale[KINDS];
    bool warned;        /* of nodes that are not where they are placed, and only of them */
    bool accounted;     /* the ledger's error, and its worst */
    bool resumed;       /* what follows from the broken points is found again */
    int masks;          /* interfaces whose bits differ */
    int displaced;      /* nodes that are not quite where they are to be */
    int bits, energies; /* steps after which the state is not that of the lone solver, or its energies */
    int watched, held, opened, parted, closed, tile_faces, across_blocks;
} record;

static void note(record *r, int kind, double got, double expected) {
    double error = fabs(got - expected);
    r->error[kind] = isnan(error) ? INFINITY : fmax(r->error[kind], error);
    r->scale[kind] = fmax(r->scale[kind], fabs(expected));
}

/* ---- Comparison ---- */

static void compare_elements(record *r, const rg_solver *s, const twin *w, bool now) {
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        rg_gid id = s->domain->id[slot];
        if (id < 0)
            continue;
        size_t at = w->slot[id];
        for (int k = 0; k < 3 * RG_NODES; k++) {
            size_t i = rg_node_index(slot, k / 3, k % 3), j = rg_node_index(at, k / 3, k % 3);
            note(r, DISPLACEMENT, s->u[i], w->u[j]);
            note(r, VELOCITY, s->velocity[i], w->velocity[j]);
            if (now)
                note(r, NOW, s->step_velocity[i], w->step_velocity[j]);
        }
        note(r, STIFFENING, s->stiffening[slot], w->stiffening[at]);
        if (s->heat != NULL)
            note(r, HEAT, s->heat[slot], w->heat[at]);
        int values = rg_material_history(w->material[w->of[id]].model);
        for (size_t k = 0; k < rg_history_rows(values); k++) {
            size_t released = (size_t)(RG_GAUSS * values);
            int kind = k < released ? (int)k % values : values + (int)(k - released);
            note(r, HISTORY + MOST_HISTORY * (w->of[id] > 0) + kind, rg_history_value(s, slot, k),
                 w->history[rg_history_index(at, w->history_stride, k)]);
        }
    }
}

/* What is prescribed as a displacement is there to the last bit. */
static void compare_places(record *r, const rg_solver *s, const twin *w) {
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        rg_gid id = s->domain->id[slot];
        for (int k = 0; k < 3 * RG_NODES && id >= 0; k++) {
            int b = w->held[3 * RG_NODES * id + k];
            if (b >= 0 && w->input->boundary[b].prescribed == RG_PRESCRIBED_DISPLACEMENT) {
                double x[3];
                rg_node_position(s->domain->corner + 12 * slot, k / 3, x);
                double there = rg_expr_value(w->input->boundary[b].value, x, s->time);
                r->displaced += memcmp(&there, &s->u[rg_node_index(slot, k / 3, k % 3)], sizeof there) != 0;
            }
        }
    }
}

/* Where value k of point q lies in a block of crack state: its kind, with what its law remembers and friction
 * behind the state proper. */
static size_t crack_row(const twin *w, size_t lane, int q, int k) {
    size_t memory =
        (w->crack_stride - RG_CRACK_BLOCK - (w->law.sliding == RG_SLIDING_COULOMB ? RG_FRICTION_BLOCK : 0)) /
        (RG_POINTS * RG_LANES);
    if (k < RG_CRACK)
        return rg_crack_index(lane, q, k);
    if (k < RG_CRACK + RG_LAW_MEMORY)
        return (size_t)(k - RG_CRACK) < memory
                   ? RG_CRACK_BLOCK + ((size_t)q * memory + (size_t)(k - RG_CRACK)) * RG_LANES + lane
                   : SIZE_MAX;
    return w->law.sliding == RG_SLIDING_COULOMB
               ? rg_friction_index(lane, q, k - RG_CRACK - RG_LAW_MEMORY, w->crack_stride)
               : SIZE_MAX;
}

/* Whether a broken point is pressed together; the normal of the body at rest will do. */
static bool is_closed(const rg_solver *s, const rg_tile *t, size_t i, int q) {
    double normal[3], open = 0, shape[RG_FNODES], l[3];
    rg_interface_area(s->domain, i, normal);
    rg_reference_face_point(q, l);
    rg_reference_face_shape(l, shape);
    for (int c = 0; c < 3; c++) {
        double jump = -*rg_crack_value(s, i, q, RG_CRACK_ORIGIN + c);
        for (int a = 0; a < RG_FNODES; a++)
            jump += shape[a] * (rg_tile_trace(s, t, i, 1, a, c) - rg_tile_trace(s, t, i, 0, a, c));
        open += jump * normal[c];
    }
    return open < 0;
}

static void count_point(record *r, const rg_solver *s, const rg_tile *t, size_t i, int q) {
    bool broken = s->broken[i] >> q & 1;
    r->held += !broken;
    if (broken) {
        bool parted = *rg_crack_value(s, i, q, RG_CRACK_OPENING) >= rg_separation(s, i, q);
        r->parted += parted;
        r->opened += !parted;
        r->closed += is_closed(s, t, i, q);
    }
}

static void compare_interface(record *r, const rg_solver *s, const twin *w, const rg_tile *t, size_t i) {
    int32_t link = s->domain->side[0][i];
    size_t slot = t->begin * RG_LANES + (size_t)link / RG_FACES;
    size_t j = (size_t)w->face[RG_FACES * s->domain->id[slot] + link % RG_FACES];
    r->masks += s->broken[i] != w->broken[j] || s->unlinked[i] != w->unlinked[j];
    if (i < t->sbegin * RG_LANES)
        r->across_blocks +=
            s->domain->side[0][i] / (RG_FACES * RG_LANES) != s->domain->side[1][i] / (RG_FACES * RG_LANES);
    else
        r->tile_faces++;
    for (int q = 0; q < RG_POINTS; q++) {
        for (int k = 0; k < RG_CRACK + RG_LAW_MEMORY + RG_FRICTION && (s->broken[i] >> q & 1); k++) {
            size_t row = crack_row(w, j % RG_LANES, q, k), own = crack_row(w, i % RG_LANES, q, k);
            if (row != SIZE_MAX)
                note(r, CRACK + k, s->crack[i / RG_LANES * s->model->crack_stride + own],
                     w->crack[j / RG_LANES * w->crack_stride + row]);
        }
        count_point(r, s, t, i, q);
    }
}

static void compare_interfaces(record *r, const rg_solver *s, const twin *w) {
    for (const rg_tile *t = s->domain->tile; t < s->domain->tile + s->domain->tiles; t++)
        for (size_t i = t->ibegin * RG_LANES; i < t->iend * RG_LANES; i++) {
            double normal[3];
            if (rg_interface_area(s->domain, i, normal) > 0) /* not in padding */
                compare_interface(r, s, w, t, i);
        }
}

static void compare_bodies(record *r, const rg_solver *s, const twin *w) {
    for (int i = 0; i < w->input->bodies; i++) {
        const rg_body *a = &s->bodies->body[i];
        const twin_body *b = &w->body[i];
        for (int c = 0; c < 3; c++) {
            note(r, BODY, a->v[c], b->v[c]);
            note(r, BODY, a->seen.v[c], b->v_now[c]);
            double at = w->input->body[i].at[c];
            note(r, PLACE, a->x[c] - at, b->x[c] - at);
            note(r, PLACE, a->seen.x[c] - at, b->x_now[c] - at);
            note(r, FORCE, a->seen.force[c], b->force[c]);
        }
    }
}

static void compare_energies(record *r, rg_energy got, rg_energy want) {
    const double *a = &got.kinetic, *b = &want.kinetic;
    got.error = want.error = got.share = want.share = 0;
    want.spent = want.dissipated + want.plastic + want.damage + want.viscous + want.friction;
    for (int k = 0; k < ENERGIES; k++)
        note(r, ENERGY + k, a[k], b[k]);
}

/* What the ledger makes of them: the error is the change of the total over the largest energy so far, which
 * is no less than what rounding of F makes; and it keeps the largest change. */
typedef struct {
    double start, largest, change;
    bool begun, good;
} account;

static void keep_account(account *a, const rg_ledger *l, const twin *w) {
    double stored = l->last.total + l->last.half_kick + l->last.external, mu = 0, volume = 0;
    for (size_t e = 0; e < w->elements; e++) {
        mu = fmax(mu, w->material[w->of[e]].mu);
        volume += w->geom[rg_geom_index(w->slot[e], RG_GEOM_VOLUME)];
    }
    a->start = a->begun ? a->start : l->last.total;
    a->begun = true;
    a->largest = fmax(fmax(a->largest, fabs(stored)), 1e3 * DBL_EPSILON * mu * volume);
    double error = (l->last.total - a->start) / a->largest;
    a->change = fmax(a->change, fabs(l->last.total - a->start));
    a->good = a->good && fabs(l->last.error - error) <= 1e-14 &&
              fabs(rg_ledger_worst(l) - a->change / a->largest) <= 1e-14 &&
              fabs(l->largest - a->largest) <= 1e-14 * a->largest;
}

/* ---- A run ---- */

/* What the solver said, and the first number in it. */
static int warnings;
static int64_t warned;

void __wrap_rg_warn(const char *format, ...);
void __wrap_rg_warn(const char *format, ...) {
    va_list args;
    va_start(args, format);
    warned = strstr(format, "prescribed displacements differ") != NULL ? va_arg(args, int64_t) : -1;
    va_end(args);
    warnings++;
}

/* What is placed starts there but for so many times the difference that is worth a warning. */
static double place_of(const twin *w, const rg_boundary *b, size_t e, int n, double off) {
    const double *x[4];
    double at[3], edge[3][3];
    for (int k = 0; k < 4; k++)
        x[k] = w->mesh->x + 3 * w->mesh->corner[4 * e + (size_t)k];
    for (int k = 0; k < 9; k++)
        edge[k / 3][k % 3] = x[k / 3 + 1][k % 3] - x[0][k % 3];
    double normal[3];
    rg_reference_cross(edge[0], edge[1], normal);
    double corners[12];
    for (int k = 0; k < 12; k++)
        corners[k] = x[k / 3][k % 3];
    rg_node_position(corners, n, at);
    return rg_expr_value(b->value, at, 0) + off * 1e-9 * cbrt(fabs(rg_reference_dot(normal, edge[2])) / 6);
}

/* Velocities and displacements of neighbours that differ, the more the larger z is, so that faces hold at one
 * end, and switch, part and close at the other; copies of a shared node move as one. Returns how many nodes
 * are not where they are placed: a half of them, or none. */
static int64_t disturb(twin *w, bool suddenly) {
    int64_t jumps = 0;
    for (size_t k = 0; k < RG_NODES * w->elements; k++) {
        size_t e = k / RG_NODES;
        int n = (int)(k % RG_NODES);
        double z = w->mesh->x[3 * w->mesh->corner[4 * (w->node[k] / RG_NODES)] + 2] / 6e-4;
        double strength = pow(0.5 + 0.5 * z, 2);
        for (int c = 0; c < 3; c++) {
            uint64_t h = rg_hash(rg_hash(11, w->node[k]), (uint64_t)c);
            size_t at = rg_node_index(w->slot[e], n, c);
            int held = w->held[3 * k + (size_t)c];
            w->u[at] = (rg_real)(6e-8 * strength * (2 * rg_hash_uniform(h) - 1));
            w->velocity[at] = (rg_real)(60 * strength * (2 * rg_hash_uniform(rg_hash(h, 1)) - 1));
            if (held >= 0 && w->input->boundary[held].prescribed == RG_PRESCRIBED_DISPLACEMENT) {
                bool jump = suddenly && h % 2 == 0;
                double off = w->joined ? 0 : jump ? 1.5 : 0.6;
                w->u[at] = (rg_real)place_of(w, &w->input->boundary[held], e, n, off);
                jumps += jump;
            }
        }
    }
    return jumps;
}

static bool start(rg_solver *s, twin *w, bool suddenly) {
    rg_solver_start(s);
    int64_t jumps = disturb(w, suddenly);
    twin_start(w);
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++)
        for (int k = 0; k < 3 * RG_NODES && s->domain->id[slot] >= 0; k++) {
            size_t i = rg_node_index(slot, k / 3, k % 3);
            size_t j = rg_node_index(w->slot[s->domain->id[slot]], k / 3, k % 3);
            s->u[i] = w->u[j];
            s->velocity[i] = w->velocity[j];
        }
    warnings = 0;
    rg_constraints_start(s->constraints, s->u, s->velocity, s->comm);
    rg_solver_resume(s);
    s->damping = w->damping = 0.4;
    return rank != 0 || (warnings == (jumps > 0) && (jumps == 0 || warned == jumps));
}

static rg_solver *make_solver(const rg_case *c, const rg_mesh *mesh, MPI_Comm comm) {
    int here;
    MPI_Comm_rank(comm, &here);
    rg_part *part = rg_part_distribute(here == 0 ? mesh : NULL, TILE, comm);
    rg_materials_assign(c, part, comm);
    return rg_solver_make_from_part(c, part, comm);
}

/* ---- The same on one rank with several threads ---- */

typedef struct {
    rg_solver *solver;
    rg_ledger ledger;
    size_t *slot, *interface; /* by element; by 4 * element + face of the side that its copy is of */
} lone;

static lone lone_make(const rg_case *c, const rg_mesh *mesh) {
    omp_set_num_threads(THREADS);
    lone one = {.solver = make_solver(c, mesh, MPI_COMM_SELF)};
    omp_set_num_threads(1);
    const rg_domain *d = one.solver->domain;
    one.slot = RG_NEW(size_t, (size_t)mesh->elements);
    one.interface = RG_NEW(size_t, RG_FACES * (size_t)mesh->elements);
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++)
        if (d->id[slot] >= 0)
            one.slot[d->id[slot]] = slot;
    for (const rg_tile *t = d->tile; t < d->tile + d->tiles; t++)
        for (size_t i = t->ibegin * RG_LANES; i < t->iend * RG_LANES; i++) {
            double normal[3];
            if (rg_interface_area(d, i, normal) > 0) /* not in padding */
                one.interface[rg_face_number(d, t, i)] = i;
        }
    return one;
}

static void lone_step(lone *one, double dt) {
    omp_set_num_threads(THREADS);
    rg_solver_kick(one->solver, dt);
    rg_ledger_take(&one->ledger, one->solver);
    rg_solver_drift(one->solver);
    omp_set_num_threads(1);
}

static void lone_free(lone *one) {
    rg_solver_free(one->solver);
    rg_free(one->slot);
    rg_free(one->interface);
}

static bool same(const void *a, const void *b, size_t bytes) {
    return memcmp(a, b, bytes) == 0;
}

/* All that the two have in common has the same bits. */
/* But for the error: the lone ledger has seen more states, among which the largest energy may be. */
static bool same_energies(rg_energy a, rg_energy b) {
    a.error = b.error = a.share = b.share = 0;
    return same(&a, &b, sizeof a);
}

static bool same_bits(const rg_solver *s, const lone *one) {
    const rg_solver *o = one->solver;
    bool good = s->stiffening_anywhere == o->stiffening_anywhere && s->opening_rate == o->opening_rate;
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        rg_gid id = s->domain->id[slot];
        for (int k = 0; k < 3 * RG_NODES && id >= 0; k++) {
            size_t i = rg_node_index(slot, k / 3, k % 3), j = rg_node_index(one->slot[id], k / 3, k % 3);
            good = good && same(&s->u[i], &o->u[j], sizeof *s->u);
            good = good && same(&s->velocity[i], &o->velocity[j], sizeof *s->u);
        }
        for (size_t k = 0; k < s->model->history_stride / RG_LANES && id >= 0; k++)
            good = good && same(&s->history[rg_history_index(slot, s->model->history_stride, k)],
                                &o->history[rg_history_index(one->slot[id], s->model->history_stride, k)],
                                sizeof *s->u);
        good = good &&
               (id < 0 || s->heat == NULL || same(&s->heat[slot], &o->heat[one->slot[id]], sizeof *s->heat));
    }
    for (const rg_tile *t = s->domain->tile; t < s->domain->tile + s->domain->tiles; t++)
        for (size_t i = t->ibegin * RG_LANES; i < t->iend * RG_LANES; i++) {
            double normal[3];
            if (rg_interface_area(s->domain, i, normal) <= 0) /* padding */
                continue;
            size_t j = one->interface[rg_face_number(s->domain, t, i)],
                   values = s->model->crack_stride / RG_LANES;
            good = good && s->broken[i] == o->broken[j] && s->unlinked[i] == o->unlinked[j];
            for (size_t k = 0; k < values && s->broken[i] != 0; k++)
                good = good &&
                       same(&s->crack[i / RG_LANES * s->model->crack_stride + k * RG_LANES + i % RG_LANES],
                            &o->crack[j / RG_LANES * s->model->crack_stride + k * RG_LANES + j % RG_LANES],
                            sizeof *s->crack);
        }
    for (int b = 0; b < s->bodies->count; b++)
        good = good && same(s->bodies->body[b].x, o->bodies->body[b].x, 6 * sizeof(double));
    return good;
}

/* Looks at a tile between its kick and its drift. */
typedef struct {
    record *record;
    const twin *twin;
} watcher;

static void watch(void *context, rg_solver *s, size_t tile, const rg_workspace *work) {
    const watcher *own = context;
    const twin *w = own->twin;
    const rg_tile *t = &s->domain->tile[tile];
    double *want = RG_NEW(double, w->blocks *RG_LANES), *got = RG_NEW(double, rg_tile_eblocks(t) * RG_LANES);
    twin_bulk_energies(w, want);
    rg_tile_state(s, t, work, got, NULL, NULL);
    own->record->watched++;
    for (size_t slot = t->begin * RG_LANES; slot < t->end * RG_LANES; slot++) {
        rg_gid id = s->domain->id[slot];
        for (int k = 0; k < 3 * RG_NODES && id >= 0; k++)
            note(own->record, NOW, s->step_velocity[rg_node_index(slot, k / 3, k % 3)],
                 w->step_velocity[rg_node_index(w->slot[id], k / 3, k % 3)]);
        if (id >= 0)
            note(own->record, STORED, got[slot - t->begin * RG_LANES], want[w->slot[id]]);
    }
    rg_free(want);
    rg_free(got);
}

static void note_step(record *r, rg_solver *s, const twin *w) {
    double most = 0, opening_rate = 0;
    for (size_t e = 0; e < w->elements; e++)
        most = fmax(most, w->stiffening[w->slot[e]]);
    note(r, STIFFENING, s->stiffening_anywhere, most);
    for (size_t i = 0; i < w->interfaces && s->tile_opening_rate != NULL; i++)
        for (int q = 0; q < RG_POINTS; q++)
            opening_rate =
                fmax(opening_rate, w->crack[i / RG_LANES * w->crack_stride +
                                            crack_row(w, i % RG_LANES, q, RG_CRACK + RG_LIMITER_RATE)]);
    note(r, OPENING_RATE, s->opening_rate, opening_rate);
    compare_interfaces(r, s, w);
    compare_bodies(r, s, w);
}

/* Whether which faces have broken points, and which elements lie beside them, is made anew of these points.
 */
static bool resumes(rg_solver *s) {
    size_t faces = s->domain->iblocks, elements = s->domain->blocks;
    uint8_t *was = RG_NEW(uint8_t, faces + elements);
    memcpy(was, s->active, faces);
    memcpy(was + faces, s->cracked, elements);
    memset(s->active, 1, faces);
    memset(s->cracked, 1, elements);
    rg_solver_resume(s);
    bool good = memcmp(was, s->active, faces) == 0 && memcmp(was + faces, s->cracked, elements) == 0;
    rg_free(was);
    return good;
}

static record follow(const rg_case *c, const rg_mesh *mesh, bool suddenly) {
    record r = {.masks = 0};
    rg_solver *s = make_solver(c, mesh, MPI_COMM_WORLD);
    twin *w = twin_make(c, mesh);
    lone one = lone_make(c, mesh);
    rg_ledger ledger = {.begun = false};
    account account_of = {.good = true};
    start(one.solver, w, suddenly);
    r.warned = start(s, w, suddenly);
    watcher own = {&r, w};
    s->watch = watch;
    s->watch_context = &own;
    for (size_t t = 0; t < s->domain->tiles; t += 2)
        s->watched[t] = 1;
    for (int k = 0; k < STEPS; k++) {
        double dt = 4e-10 * (1 + 0.3 * sin(k));
        bool whole = k % 2 == 1;
        twin_kick(w, dt);
        lone_step(&one, dt);
        if (whole) {
            rg_solver_step(s, dt);
        } else {
            rg_solver_kick(s, dt);
            compare_energies(&r, *rg_ledger_take(&ledger, s), twin_energy(w));
            keep_account(&account_of, &ledger, w);
            r.energies += !same_energies(ledger.last, one.ledger.last);
            compare_elements(&r, s, w, true);
            rg_solver_drift(s);
        }
        twin_drift(w);
        r.bits += !same_bits(s, &one);
        compare_elements(&r, s, w, false);
        note_step(&r, s, w);
        compare_places(&r, s, w);
    }
    r.accounted = account_of.good;
    r.resumed = resumes(s);
    double first = twin_first_fracture(w), found = rg_first_fracture(s);
    if (isfinite(first) || isfinite(found))
        note(&r, FIRST, found, first);
    rg_solver_free(s);
    lone_free(&one);
    twin_free(w);
    return r;
}

/* ---- Verdict ---- */

static void gather(record *r) {
    MPI_Allreduce(MPI_IN_PLACE, r->error, 2 * KINDS, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    MPI_Allreduce(MPI_IN_PLACE, &r->masks, 11, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
}

static void judge(const variant *v, const record *r) {
    for (int kind = 0; kind_begin[kind] < KINDS; kind++) {
        double worst = 0, scale = 0, bound = kind_begin[kind] == STORED ? BOUND_STORED : BOUND;
        for (int k = kind_begin[kind]; k < kind_begin[kind + 1]; k++) {
            double here = r->scale[k] > 0 ? r->error[k] / r->scale[k] : r->error[k] > 0 ? INFINITY : 0;
            worst = here <= worst ? worst : here;
            scale = fmax(scale, r->scale[k]);
            if (rank == 0 && !(here <= bound)) {
                printf("# %s %d: %g of %g\n", kind_name[kind], k - kind_begin[kind], r->error[k],
                       r->scale[k]);
            }
        }
        if (scale > 0)
            report(worst <= bound, v->name, kind_name[kind]);
    }
    report(r->masks == 0, v->name, "broken and unlinked points");
    report(r->displaced == 0, v->name, "prescribed places");
    report(r->warned, v->name, "what is said of them");
    report(r->accounted, v->name, "error of the ledger");
    report(r->resumed, v->name, "what is made anew of broken points");
    report(r->bits == 0, v->name, "the same bits on one rank with three threads");
    report(r->energies == 0, v->name, "the same energies there");
    bool none = v->override[0] != NULL && strstr(v->override[0], "law: none") != NULL;
    bool parts = r->across_blocks > 1000 && r->tile_faces > 1000 && r->opened > 500 && r->parted > 10 &&
                 r->closed > 300;
    report(r->watched > 0 && none != parts, v->name, "there was something to compare");
    if (rank == 0)
        printf("# %d points hold, %d open, %d parted, %d closed; %d interfaces between blocks, %d "
               "tile-boundary faces\n",
               r->held, r->opened, r->parted, r->closed, r->across_blocks, r->tile_faces);
}

/* ---- The start, and a state that is none ---- */

/* At rest there is nothing but what rounding could make, of the stiffest material. */
static void check_rest(void) {
    const variant still = {"rest", {HALVES, "boundary=[]"}};
    rg_case *c = read_case(&still);
    rg_mesh *mesh = make_mesh(c);
    rg_solver *s = make_solver(c, mesh, MPI_COMM_WORLD);
    twin *w = twin_make(c, mesh);
    rg_ledger ledger = {.begun = false};
    account a = {.good = true};
    rg_solver_start(s);
    rg_solver_kick(s, 1e-10);
    rg_ledger_take(&ledger, s);
    keep_account(&a, &ledger, w);
    report(a.good && ledger.largest > 0 && rg_ledger_worst(&ledger) == 0, "rest", "error of the ledger");
    twin_free(w);
    rg_solver_free(s);
    rg_mesh_free(mesh);
    rg_case_free(c);
}

/* The initial fields are those of the case, and no face has broken though the stress is beyond the strength.
 */
static void check_start(void) {
    const variant stretched = {
        "start",
        {"initial={displacement: {x: '1e-3*y', z: '-1e-2*z'}, velocity: {y: '5*x/1e-4', "
         "z: '2 + z/1e-4'}}",
         "boundary=[]"}};
    rg_case *c = read_case(&stretched);
    rg_mesh *mesh = make_mesh(c);
    rg_solver *s = make_solver(c, mesh, MPI_COMM_WORLD);
    bool fields = true, whole = true;
    rg_solver_start(s);
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++)
        for (int n = 0; n < RG_NODES && s->domain->id[slot] >= 0; n++) {
            double x[3];
            rg_node_position(s->domain->corner + 12 * slot, n, x);
            const double want[6] = {1e-3 * x[1], 0, -1e-2 * x[2], 0, 5 * x[0] / 1e-4, 2 + x[2] / 1e-4};
            for (int k = 0; k < 6; k++) {
                double got = (k < 3 ? s->u : s->velocity)[rg_node_index(slot, n, k % 3)];
                fields = fields && fabs(got - want[k]) <= 1e-15 * fabs(want[k]);
            }
        }
    for (size_t i = 0; i < s->domain->iblocks * RG_LANES; i++)
        whole = whole && s->broken[i] == 0;
    report(fields, "start", "fields");
    report(whole, "start", "nothing is broken");
    report(s->stiffening_anywhere > 1 && isfinite(s->stiffening_anywhere), "start", "stiffening");
    rg_solver_step(s, 1e-10);
    if (rank == 0)
        s->velocity[rg_node_index(0, 3, 1)] = NAN;
    rg_solver_step(s, 1e-10);
    rg_solver_step(s, 1e-10);
    report(isinf(s->stiffening_anywhere), "start", "a state that is not finite is known to all");
    rg_solver_free(s);
    rg_mesh_free(mesh);
    rg_case_free(c);
}

/* What is told of prescribed values that cease to be finite: the earliest, wherever it is; of those at the
 * same time the lowest. What comes later only follows. */
static void check_told(void) {
    static const struct {
        const char *boundary, *told;
    } cases[] = {
        {"boundary=[{set: z-, component: z, velocity: 'sqrt(5e-10 - t)'}, {set: z+, component: x, "
         "displacement: "
         "'sqrt(2.4e-10 - t)'}]",
         "boundary[1].displacement: sqrt(2.4e-10 - t) is not finite at (-0.0001, -0.0001, 0.0006), t = 2e-10 "
         "s"},
        {"boundary=[{set: z-, component: z, velocity: 'sqrt(2.4e-10 - t)'}, {set: z+, component: y, "
         "velocity: "
         "'sqrt(5e-10 - t)'}]",
         "boundary[0].velocity: sqrt(2.4e-10 - t) is not finite at (-0.0001, -0.0001, -0.0006), t = 2e-10 s"},
        {"boundary=[{set: z+, component: z, velocity: 'z + sqrt(2.4e-10 - t)'}, {set: z-, component: y, "
         "velocity: 'sqrt(2.4e-10 - t)'}]",
         "boundary[0].velocity: z + sqrt(2.4e-10 - t) is not finite at (-0.0001, -0.0001, 0.0006), t = 2e-10 "
         "s"},
        {"boundary=[{set: z+, component: z, velocity: 'sqrt(1 - t)'}]", ""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const variant v = {"told", {cases[i].boundary}};
        rg_case *c = read_case(&v);
        rg_mesh *mesh = make_mesh(c);
        rg_solver *s = make_solver(c, mesh, MPI_COMM_WORLD);
        char words[400] = "";
        rg_solver_start(s);
        for (int k = 0; k < 8; k++)
            rg_constraints_set(s->constraints, k * 1e-10, 1e-10, 1e-10);
        bool any = rg_constraints_told(s->constraints, words, sizeof words, s->comm);
        if (strcmp(words, cases[i].told) != 0)
            printf("# rank %d: %s\n", rank, words);
        report(any == (*cases[i].told != '\0') && strcmp(words, cases[i].told) == 0, v.name,
               cases[i].boundary);
        rg_solver_free(s);
        rg_mesh_free(mesh);
        rg_case_free(c);
    }
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    for (size_t k = 0; k < VARIANTS; k++) {
        if (argc > 1 && strcmp(argv[1], variants[k].name) != 0)
            continue;
        rg_case *c = read_case(&variants[k]);
        rg_mesh *mesh =
            rg_mesh_box(c->mesh.cells, c->mesh.origin, c->mesh.size, c->mesh.jitter, c->mesh.seed);
        rg_mesh_sort(mesh);
        rg_mesh_connect(mesh);
        record r = follow(c, mesh, strstr(variants[k].name, "suddenly") != NULL);
        gather(&r);
        judge(&variants[k], &r);
        rg_mesh_free(mesh);
        rg_case_free(c);
    }
    check_start();
    check_rest();
    check_told();
    return finish();
}
