#include "solver/oblique.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "base/dense.h"
#include "base/error.h"
#include "base/mem.h"
#include "base/vector.h"
#include "domain/element.h"
#include "layout.h"
#include "solver/surface.h"

/* Rows of an element: those of entries that take turns count each. */
enum { MOST_ROWS = 128, MOST_HELD = 3 * RG_NODES };

typedef struct {
    int8_t node, component; /* of what an angle prescribes */
    int16_t boundary;
    bool held; /* at present: its entry acts, and no row before implies it */
    double along[3];
} row;

/* What a row must remember: velocities before the kick, at its time and after it, and the displacement where
 * that is prescribed, all along its line. Doubles only: a checkpoint takes them. */
typedef struct {
    double before, present, target, displacement;
} memory;

typedef struct {
    rg_lid slot;
    int rows;
    size_t first; /* of its rows */
    double mass;
    double *inverse; /* G^-1, [rows][rows]; 0 of rows that are not held */
    double *work;    /* of all kicks, and up to the present time (J); then the memory of its rows */
} entry;

struct rg_oblique {
    rg_supports *supports;
    bool shared;    /* elements share their nodes */
    rg_real **mean; /* [boundaries]: of normals, at nodes (as a field), for the set-up; NULL: faces have their
                       own */
    int64_t *key;
    size_t entries, rows, *tile_begin;
    entry *entry;
    row *row;
    int most; /* rows of an entry, on any rank */
    bool *acted;
    double *matrices, *memories;
    double inverse_mass[RG_NODES][RG_NODES];
};

static memory *memory_of(const entry *e) {
    return (memory *)(void *)(e->work + 2);
}

/* ---- Which elements, and their rows ---- */

static bool take_turns(const rg_boundary *a, const rg_boundary *b) {
    bool timed = a->from > 0 || a->until > 0 || b->from > 0 || b->until > 0;
    for (int c = 0; c < 3; c++) {
        if (timed && rg_support_has_axis(a, c) && rg_support_has_axis(b, c)) {
            return true;
        }
    }
    return false;
}

bool rg_oblique_has(const rg_oblique *o, size_t slot) {
    const rg_supports *s = o->supports;
    const rg_boundary *of = s->input->boundary;
    for (int b = 0; b < s->input->boundaries; b++) {
        if (s->nodes[b] == NULL || s->nodes[b][slot] == 0) {
            continue;
        }
        if (o->shared || rg_support_is_oblique(&of[b])) {
            return true;
        }
        for (int a = 0; a < b; a++) {
            if (s->nodes[a] != NULL && (s->nodes[a][slot] & s->nodes[b][slot]) != 0 &&
                take_turns(&of[a], &of[b])) {
                return true;
            }
        }
    }
    return false;
}

/* All copies of a shared node must be held by the same arithmetic. */
static bool holds_shared(const rg_supports *s) {
    bool oblique = s->timed;
    for (int b = 0; b < s->input->boundaries; b++) {
        oblique = oblique || rg_support_is_oblique(&s->input->boundary[b]);
    }
    return oblique;
}

static void add_row(rg_oblique *o, size_t *room, int node, int boundary, int component,
                    const double along[3]) {
    double length = sqrt(rg_vector_dot(along, along));
    o->row = rg_grow(o->row, room, o->rows + 1, sizeof *o->row);
    o->row[o->rows++] = (row){.node = (int8_t)node,
                              .component = (int8_t)component,
                              .boundary = (int16_t)boundary,
                              .along = {along[0] / length, along[1] / length, along[2] / length}};
}

static void add_nodes(rg_oblique *o, size_t *room, size_t slot, int b, int component, const double along[3]) {
    for (int n = 0; n < RG_NODES; n++) {
        if ((o->supports->nodes[b][slot] >> n & 1) != 0) {
            add_row(o, room, n, b, component, along);
        }
    }
}

static void add_normals(rg_oblique *o, size_t *room, size_t slot, int b) {
    const rg_domain *d = o->supports->domain;
    double normal[3];
    const rg_real *mean = o->mean[b];
    for (int n = 0; mean != NULL && n < RG_NODES; n++) {
        if ((o->supports->nodes[b][slot] >> n & 1) != 0) {
            for (int c = 0; c < 3; c++) {
                normal[c] = mean[rg_node_index(slot, n, c)];
            }
            add_row(o, room, n, b, -1, normal);
        }
    }
    for (int f = 0; mean == NULL && f < RG_FACES; f++) {
        rg_surface_area(d->corner + 12 * slot, f, normal);
        for (int a = 0; (o->supports->faces[b][slot] >> f & 1) != 0 && a < RG_FNODES; a++) {
            add_row(o, room, rg_face_node[f][a], b, -1, normal);
        }
    }
}

/* Mean of an entry's normals at the nodes, by the areas of the faces around each. */
static rg_real *find_mean(const rg_oblique *o, int b, const rg_material *m, rg_assembly *nodes,
                          MPI_Comm comm) {
    const rg_supports *s = o->supports;
    const rg_domain *d = s->domain;
    const double steepest = 0.8; /* cosine: of a face against the mean at its nodes */
    int64_t edges = 0;
    rg_real *mean = RG_NEW(rg_real, d->blocks * RG_NODE_BLOCK + 1);
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < RG_FACES * d->blocks * RG_LANES; i++) {
            size_t slot = i / RG_FACES;
            int face = (int)(i % RG_FACES);
            double normal[3];
            for (int a = 0; (s->faces[b][slot] >> face & 1) != 0 && a < RG_FNODES; a++) {
                double weight =
                    rg_surface_area(d->corner + 12 * slot, face, normal) / rg_element_mass(d, m, slot);
                double length = 0, cosine = 0;
                for (int c = 0; c < 3; c++) { /* the mean weighs by mass */
                    rg_real *at = &mean[rg_node_index(slot, rg_face_node[face][a], c)];
                    *at = (rg_real)(*at + (pass == 0 ? weight * normal[c] : 0));
                    length += (double)*at * *at;
                    cosine += *at * normal[c];
                }
                edges += pass == 1 && cosine < steepest * sqrt(length);
            }
        }
        if (pass == 0) {
            rg_assembly_mean(nodes, mean);
        }
    }
    MPI_Allreduce(MPI_IN_PLACE, &edges, 1, MPI_INT64_T, MPI_SUM, comm);
    if (edges > 0) {
        rg_speak(comm);
        rg_fatal(RG_USAGE,
                 "%s: boundary[%d].normal: the faces have an edge, and form continuous knows one normal at a "
                 "node: give the sides as sets of their own",
                 s->input->path, b);
    }
    return mean;
}

static void list_rows(rg_oblique *o, size_t *room, size_t slot) {
    const rg_case *c = o->supports->input;
    for (int b = c->boundaries - 1; b >= 0; b--) {
        const rg_boundary *of = &c->boundary[b];
        if (rg_boundary_damps(of)) {
            continue;
        }
        for (int axis = 0; axis < 3; axis++) {
            double along[3] = {axis == 0, axis == 1, axis == 2};
            if (rg_support_has_axis(of, axis)) {
                add_nodes(o, room, slot, b, axis, along);
            }
        }
        if (of->prescribed == RG_PRESCRIBED_NORMAL) {
            add_normals(o, room, slot, b);
        } else if (rg_support_is_oblique(of)) {
            add_nodes(o, room, slot, b, -1, of->direction);
        }
    }
}

/* ---- Which rows hold ---- */

/* Whether a line is more than 1e-3 (rad) out of the span of `count` orthonormal ones; then adds what is. */
static bool is_new(double span[3][3], int count, const double line[3]) {
    double rest[3] = {line[0], line[1], line[2]};
    for (int pass = 0; pass < 2; pass++) {
        for (int i = 0; i < count; i++) {
            double along = rg_vector_dot(span[i], rest);
            for (int c = 0; c < 3; c++) {
                rest[c] -= along * span[i][c];
            }
        }
    }
    double length = sqrt(rg_vector_dot(rest, rest));
    for (int c = 0; count < 3 && c < 3; c++) {
        span[count][c] = rest[c] / length;
    }
    return count < 3 && length > 1e-3;
}

static void choose_rows(const rg_oblique *o, const entry *e) {
    double span[RG_NODES][3][3];
    int count[RG_NODES] = {0};
    for (int i = 0; i < e->rows; i++) {
        row *r = &o->row[e->first + (size_t)i];
        r->held = o->supports->acts[r->boundary] && is_new(span[r->node], count[r->node], r->along);
        count[r->node] += r->held;
    }
}

/* Of the rows that hold. */
static void invert(const rg_oblique *o, const entry *e) {
    int held[MOST_HELD], count = 0;
    double matrix[MOST_HELD * MOST_HELD];
    const row *r = o->row + e->first;
    for (int i = 0; i < e->rows; i++) {
        if (r[i].held) {
            held[count++] = i;
        }
    }
    for (int n = 0; n < count * count; n++) {
        const row *a = &r[held[n / count]], *b = &r[held[n % count]];
        matrix[n] = o->inverse_mass[a->node][b->node] * rg_vector_dot(a->along, b->along);
    }
    rg_dense_invert(count, matrix);
    memset(e->inverse, 0, (size_t)(e->rows * e->rows) * sizeof *e->inverse);
    for (int n = 0; n < count * count; n++) {
        e->inverse[held[n / count] * e->rows + held[n % count]] = matrix[n];
    }
}

/* When entries of the case begin or end. */
static void choose_all(rg_oblique *o) {
    size_t size = (size_t)o->supports->input->boundaries * sizeof *o->acted;
    if (memcmp(o->acted, o->supports->acts, size) != 0) {
        memcpy(o->acted, o->supports->acts, size);
        for (size_t n = 0; n < o->entries; n++) {
            choose_rows(o, &o->entry[n]);
            invert(o, &o->entry[n]);
        }
    }
}

/* ---- Values ---- */

static const rg_boundary *boundary_of(const rg_oblique *o, const row *r) {
    return &o->supports->input->boundary[r->boundary];
}

static void place_of(const rg_oblique *o, const entry *e, const row *r, double x[3]) {
    rg_node_position(o->supports->domain->corner + 12 * (size_t)e->slot, r->node, x);
}

static double along(const entry *e, const row *r, const rg_real *field) {
    double sum = 0;
    for (int c = 0; c < 3; c++) {
        sum += r->along[c] * field[rg_node_index((size_t)e->slot, r->node, c)];
    }
    return sum;
}

#define JUMP 1e-9 /* of the element size: as in solver/constraint.c */

int64_t rg_oblique_start(rg_oblique *o, const rg_real *u, const rg_real *velocity) {
    int64_t jumps = 0;
    for (size_t n = 0; n < o->entries; n++) {
        entry *e = &o->entry[n];
        double volume = o->supports->domain->geom[rg_geom_index((size_t)e->slot, RG_GEOM_VOLUME)];
        for (int i = 0; i < e->rows; i++) {
            const row *r = &o->row[e->first + (size_t)i];
            const rg_boundary *b = boundary_of(o, r);
            memory *is = &memory_of(e)[i];
            double x[3];
            place_of(o, e, r, x);
            is->before = along(e, r, velocity);
            is->displacement = along(e, r, u);
            is->target = is->present = rg_support_velocity(b, r->component, x, b->from, 0);
            double first = rg_support_value(b, r->component, x, b->from);
            if (!isfinite(first)) {
                rg_supports_note(o->supports, r->boundary, x, b->from);
            }
            jumps += rg_boundary_is_placed(b) && !(b->from > 0) &&
                     fabs(first - is->displacement) > JUMP * cbrt(volume);
        }
    }
    return jumps;
}

static void set_row(rg_oblique *o, const entry *e, int i, double time, double dt) {
    const row *r = &o->row[e->first + (size_t)i];
    const rg_boundary *b = boundary_of(o, r);
    memory *is = &memory_of(e)[i];
    double x[3];
    if (!r->held || !rg_support_varies(b)) {
        return;
    }
    place_of(o, e, r, x);
    if (rg_boundary_is_placed(b)) {
        double next = rg_support_value(b, r->component, x, time + dt);
        is->target = (next - is->displacement) / dt;
        is->displacement = next;
    } else {
        is->target = rg_support_value(b, r->component, x, time + 0.5 * dt);
    }
    is->present = rg_support_velocity(b, r->component, x, time, dt);
    if (!isfinite(is->target + is->present)) {
        rg_supports_note(o->supports, r->boundary, x, time);
    }
}

void rg_oblique_set(rg_oblique *o, double time, double dt) {
    if (o->entries > 0) {
        choose_all(o);
    }
    for (size_t n = 0; n < o->entries; n++) {
        for (int i = 0; i < o->entry[n].rows; i++) {
            set_row(o, &o->entry[n], i, time, dt);
        }
    }
}

/* ---- Correction ---- */

/* Brings an element's velocities along its rows to `target`; finds the impulses over its mass. */
static void bring(const rg_oblique *o, const entry *e, const double *target, rg_real *velocity,
                  double *impulse) {
    const row *r = o->row + e->first;
    double change[MOST_ROWS];
    for (int i = 0; i < e->rows; i++) {
        change[i] = target[i] - along(e, &r[i], velocity);
    }
    for (int i = 0; i < e->rows; i++) {
        impulse[i] = 0;
        for (int j = 0; j < e->rows; j++) {
            impulse[i] += e->inverse[i * e->rows + j] * change[j];
        }
    }
    for (int n = 0; n < RG_NODES; n++) {
        for (int c = 0; c < 3; c++) {
            size_t at = rg_node_index((size_t)e->slot, n, c);
            double v = velocity[at];
            for (int j = 0; j < e->rows; j++) {
                v += o->inverse_mass[n][r[j].node] * r[j].along[c] * impulse[j];
            }
            velocity[at] = (rg_real)v;
        }
    }
}

/* To what is prescribed after the kick, or at its time; returns the work of that. */
static double correct(const rg_oblique *o, const entry *e, bool present, rg_real *velocity, double *impulse) {
    const memory *is = memory_of(e);
    double target[MOST_ROWS], work = 0;
    for (int i = 0; i < e->rows; i++) {
        target[i] = present ? is[i].present : is[i].target;
    }
    bring(o, e, target, velocity, impulse);
    for (int i = 0; i < e->rows; i++) {
        work += 0.5 * e->mass * impulse[i] * (is[i].before + target[i]);
    }
    return work;
}

/* The force and work of those boundaries of an entry that have a name: rows of a boundary follow each other.
 */
static void book(const rg_oblique *o, const entry *e, const rg_real *u, const double *impulse) {
    const rg_supports *s = o->supports;
    const row *r = o->row + e->first;
    const memory *is = memory_of(e);
    for (int i = 0; i < e->rows;) {
        int boundary = r[i].boundary;
        rg_account_entry sum = {.before = 0};
        for (; i < e->rows && r[i].boundary == boundary; i++) {
            double force = e->mass * impulse[i] / s->dt_kick,
                   before = 0.5 * s->dt_last * force * is[i].before;
            const double vector[3] = {force * r[i].along[0], force * r[i].along[1], force * r[i].along[2]};
            rg_account_add_force(&sum, s->domain, (size_t)e->slot, r[i].node, u, vector);
            sum.before += before;
            sum.after += 0.5 * e->mass * impulse[i] * (is[i].before + is[i].target) - before;
        }
        if (s->item[boundary] >= 0) {
            rg_account_book(s->account, s->item[boundary], &sum);
        }
    }
}

void rg_oblique_kick(rg_oblique *o, size_t tile, const rg_real *u, rg_real *velocity, rg_real *now) {
    for (size_t n = o->tile_begin[tile]; n < o->tile_begin[tile + 1]; n++) {
        entry *e = &o->entry[n];
        double impulse[MOST_ROWS];
        if (now != NULL) {
            e->work[1] = e->work[0] + correct(o, e, true, now, impulse);
        }
        e->work[0] += correct(o, e, false, velocity, impulse);
        if (o->supports->named) {
            book(o, e, u, impulse);
        }
        for (int i = 0; i < e->rows; i++) {
            memory_of(e)[i].before = along(e, &o->row[e->first + (size_t)i], velocity);
        }
    }
}

void rg_oblique_drift(rg_oblique *o, size_t tile, rg_real *u) {
    for (size_t n = o->tile_begin[tile]; n < o->tile_begin[tile + 1]; n++) {
        entry *e = &o->entry[n];
        for (int i = 0; i < e->rows; i++) {
            const row *r = &o->row[e->first + (size_t)i];
            double *displacement = &memory_of(e)[i].displacement, here = along(e, r, u);
            if (!rg_boundary_is_placed(boundary_of(o, r))) {
                continue;
            }
            for (int c = 0; r->held && c < 3; c++) {
                rg_real *at = &u[rg_node_index((size_t)e->slot, r->node, c)];
                *at = (rg_real)(*at + r->along[c] * (*displacement - here));
            }
            *displacement = r->held ? *displacement : here;
        }
    }
}

void rg_oblique_place(rg_oblique *o, rg_real *u) {
    if (o->entries > 0) {
        choose_all(o);
    }
    enum { SWEEPS = 40 }; /* lines at an angle disturb each other */
    for (size_t n = 0; n < SWEEPS * o->entries; n++) {
        const entry *e = &o->entry[n / SWEEPS];
        for (int i = 0; i < e->rows; i++) {
            const row *r = &o->row[e->first + (size_t)i];
            const rg_boundary *b = boundary_of(o, r);
            double x[3];
            place_of(o, e, r, x);
            double gap = !r->held || !rg_boundary_is_placed(b)
                             ? 0
                             : rg_support_value(b, r->component, x, 0) - along(e, r, u);
            for (int c = 0; c < 3; c++) {
                rg_real *at = &u[rg_node_index((size_t)e->slot, r->node, c)];
                *at = (rg_real)(*at + gap * r->along[c]);
            }
        }
    }
}

void rg_oblique_show(const rg_oblique *o, rg_held_line *show, void *to) {
    for (size_t n = 0; n < o->entries; n++) {
        for (int i = 0; i < o->entry[n].rows; i++) {
            const row *r = &o->row[o->entry[n].first + (size_t)i];
            if (r->held) {
                show(to, (size_t)o->entry[n].slot, r->node, r->along);
            }
        }
    }
}

void rg_oblique_mark(const rg_oblique *o, uint8_t *slots) {
    for (size_t n = 0; n < o->entries; n++) {
        slots[o->entry[n].slot] = 1;
    }
}

void rg_oblique_hold(const rg_oblique *o, size_t tile, rg_real *field) {
    static const double rest[MOST_ROWS] = {0};
    double impulse[MOST_ROWS];
    for (size_t n = o->tile_begin[tile]; n < o->tile_begin[tile + 1]; n++) {
        bring(o, &o->entry[n], rest, field, impulse);
    }
}

void rg_oblique_work(const rg_oblique *o, rg_exact_sum *work) {
    for (size_t n = 0; n < o->entries; n++) {
        rg_exact_add(work, o->entry[n].work[1]);
    }
}

/* ---- Set-up and end ---- */

/* Doubles of an entry that a checkpoint holds: as many for all. */
static size_t memory_values(const rg_oblique *o) {
    return 2 + (size_t)o->most * (sizeof(memory) / sizeof(double));
}

static void make_room(rg_oblique *o) {
    size_t size = 0;
    for (size_t n = 0; n < o->entries; n++) {
        size += (size_t)(o->entry[n].rows * o->entry[n].rows);
    }
    o->matrices = RG_NEW(double, size + 1);
    o->memories = RG_NEW(double, o->entries *memory_values(o) + 1);
    double *next = o->matrices;
    for (size_t n = 0; n < o->entries; n++) {
        entry *e = &o->entry[n];
        e->inverse = next;
        e->work = o->memories + n * memory_values(o);
        next += e->rows * e->rows;
    }
}

rg_oblique *rg_oblique_make(rg_supports *s, const rg_material *m, rg_assembly *nodes, MPI_Comm comm) {
    const rg_domain *d = s->domain;
    const rg_case *c = s->input;
    rg_oblique *o = RG_NEW(rg_oblique, 1);
    *o = (rg_oblique){.supports = s,
                      .shared = nodes != NULL && holds_shared(s),
                      .mean = RG_NEW(rg_real *, (size_t)c->boundaries + 1),
                      .acted = RG_NEW(bool, (size_t)c->boundaries + 1),
                      .tile_begin = RG_NEW(size_t, d->tiles + 1)};
    for (int i = 0; i < RG_NODES * RG_NODES; i++) {
        o->inverse_mass[i / RG_NODES][i % RG_NODES] =
            rg_inverse_mass_entry(c->mass, i / RG_NODES, i % RG_NODES);
    }
    for (int b = 0; nodes != NULL && b < c->boundaries; b++) {
        bool normal =
            !rg_boundary_damps(&c->boundary[b]) && c->boundary[b].prescribed == RG_PRESCRIBED_NORMAL;
        o->mean[b] = normal ? find_mean(o, b, m, nodes, comm) : NULL;
    }
    size_t room = 0, row_room = 0;
    for (size_t t = 0; t < d->tiles; t++) {
        for (size_t slot = d->tile[t].begin * RG_LANES; slot < d->tile[t].end * RG_LANES; slot++) {
            if (d->id[slot] >= 0 && rg_oblique_has(o, slot)) {
                o->entry = rg_grow(o->entry, &room, o->entries + 1, sizeof *o->entry);
                entry *e = &o->entry[o->entries++];
                *e = (entry){.slot = (rg_lid)slot, .first = o->rows, .mass = rg_element_mass(d, m, slot)};
                list_rows(o, &row_room, slot);
                e->rows = (int)(o->rows - e->first);
                o->most = e->rows > o->most ? e->rows : o->most;
            }
        }
        o->tile_begin[t + 1] = o->entries;
    }
    for (int b = 0; b < c->boundaries; b++) {
        rg_free(o->mean[b]);
    }
    rg_free(o->mean);
    o->mean = NULL;
    MPI_Allreduce(MPI_IN_PLACE, &o->most, 1, MPI_INT, MPI_MAX, comm);
    if (o->most > MOST_ROWS) {
        rg_speak(comm);
        rg_fatal(RG_USAGE, "%s: boundary: too many entries take turns: %d on one element, at most %d",
                 c->path, o->most, MOST_ROWS);
    }
    make_room(o);
    return o;
}

void rg_oblique_register(rg_oblique *o, rg_state *st) {
    if (o->most == 0) {
        return;
    }
    if (o->key == NULL) { /* a list of state keeps a reference: all have the same */
        o->key = rg_alloc(o->entries + 1, sizeof *o->key);
    }
    for (size_t n = 0; n < o->entries; n++) {
        o->key[n] = 4 * o->supports->domain->id[o->entry[n].slot] + 3;
    }
    rg_state_add_list(st, "oblique", RG_STATE_DOUBLE, (int)memory_values(o), o->memories,
                      memory_values(o) * sizeof(double), o->entries, o->key);
}

void rg_oblique_free(rg_oblique *o) {
    if (o != NULL) {
        void *blocks[] = {o->key, o->tile_begin, o->entry, o->row, o->acted, o->matrices, o->memories, o};
        for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
            rg_free(blocks[i]);
        }
    }
}
