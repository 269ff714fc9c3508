#include "solver/constraint.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/mem.h"
#include "base/first_bad.h"
#include "domain/element.h"
#include "layout.h"
#include "solver/oblique.h"
#include "solver/pattern.h"
#include "solver/supports.h"

/* What a component of an element must remember. Arrays run over the constrained nodes of the pattern. Doubles
 * only: a checkpoint takes it as a row of them. */
typedef struct {
    double work, work_now;         /* of all kicks; up to the present time (J) */
    double before[RG_NODES];       /* velocity before the kick */
    double present[RG_NODES];      /* velocity at the time of the kick */
    double target[RG_NODES];       /* velocity after it */
    double displacement[RG_NODES]; /* after it, where it is prescribed */
} memory;

/* One component of one element. */
typedef struct {
    rg_lid slot;
    int8_t component;
    bool varies;
    int16_t boundary[RG_NODES];
    const rg_pattern *pattern;
    double mass;
    memory is;
} entry;

#define JUMP                                                                                                 \
    1e-9 /* of the element size: a prescribed displacement off the initial one by more is worth a warning */

struct rg_constraints {
    const rg_case *input;
    const rg_domain *domain;
    rg_supports *supports;
    rg_oblique *oblique;         /* what is not along axes */
    int64_t *key;                /* [entries], by which a checkpoint knows them */
    size_t entries, *tile_begin; /* entries of tile t: tile_begin[t] .. tile_begin[t + 1] - 1 */
    entry *entry;
    rg_patterns patterns;
    bool varies; /* some value depends on time or is a displacement */
};

/* ---- Set-up ---- */

/* Boundary that prescribes component c of each node of an element, -1 for none; returns the mask of those
 * nodes. */
static unsigned constrained_nodes(const rg_constraints *k, size_t slot, int c, int16_t which[RG_NODES]) {
    unsigned mask = 0;
    for (int b = 0; b < k->input->boundaries; b++) {
        unsigned here = k->supports->nodes[b] == NULL ? 0 : k->supports->nodes[b][slot];
        for (int n = 0; rg_support_has_axis(&k->input->boundary[b], c) && n < RG_NODES; n++) {
            if ((here >> n & 1) != 0) {
                which[n] = (int16_t)b;
                mask |= 1u << n;
            }
        }
    }
    return mask;
}

static void add_entry(rg_constraints *k, double mass, size_t slot, int c, unsigned mask,
                      const int16_t which[RG_NODES]) {
    if ((k->entries & (k->entries - 1)) == 0) { /* grow at powers of two */
        k->entry = rg_realloc(k->entry, k->entries == 0 ? 1 : 2 * k->entries, sizeof *k->entry);
    }
    entry *e = &k->entry[k->entries++];
    *e = (entry){.slot = (rg_lid)slot,
                 .component = (int8_t)c,
                 .pattern = rg_patterns_get(&k->patterns, mask),
                 .mass = mass};
    for (int i = 0; i < e->pattern->constrained; i++) {
        e->boundary[i] = which[e->pattern->node[i]];
        e->varies = e->varies || rg_support_varies(&k->input->boundary[e->boundary[i]]);
    }
}

/* The patterns of all that an entry can be while some of its boundaries act and others do not. */
static void make_parts(rg_constraints *k, const entry *e) {
    unsigned of[RG_NODES], parts = 0; /* nodes of each boundary that the entry has */
    int16_t known[RG_NODES];
    for (int i = 0; i < e->pattern->constrained; i++) {
        unsigned p = 0;
        while (p < parts && known[p] != e->boundary[i]) {
            p++;
        }
        if (p == parts) {
            known[parts] = e->boundary[i];
            of[parts++] = 0;
        }
        of[p] |= 1u << e->pattern->node[i];
    }
    for (unsigned acting = 0; acting < 1u << parts; acting++) {
        unsigned mask = 0;
        for (unsigned p = 0; p < parts; p++) {
            mask |= (acting >> p & 1) != 0 ? of[p] : 0;
        }
        rg_patterns_get(&k->patterns, mask);
    }
}

rg_constraints *rg_constraints_make(const rg_case *c, const rg_domain *d, const rg_part *part,
                                    const rg_material *m, rg_assembly *nodes, rg_account *account,
                                    MPI_Comm comm) {
    rg_constraints *k = RG_NEW(rg_constraints, 1);
    *k = (rg_constraints){.input = c,
                          .domain = d,
                          .patterns.mass = c->mass,
                          .supports = rg_supports_make(c, d, part, nodes, account, comm)};
    k->oblique = rg_oblique_make(k->supports, m, nodes, comm);
    for (int b = 0; b < c->boundaries; b++) {
        k->varies = k->varies || rg_support_varies(&c->boundary[b]);
    }
    k->tile_begin = RG_NEW(size_t, d->tiles + 1);
    for (size_t t = 0; t < d->tiles; t++) {
        k->tile_begin[t] = k->entries;
        for (size_t slot = d->tile[t].begin * RG_LANES; slot < d->tile[t].end * RG_LANES; slot++) {
            for (int comp = 0; comp < 3 && !rg_oblique_has(k->oblique, slot); comp++) {
                int16_t which[RG_NODES];
                unsigned mask = constrained_nodes(k, slot, comp, which);
                if (mask != 0) {
                    add_entry(k, rg_element_mass(d, m, slot), slot, comp, mask, which);
                }
            }
        }
    }
    k->tile_begin[d->tiles] = k->entries;
    for (size_t n = 0; k->supports->timed && n < k->entries; n++) {
        make_parts(k, &k->entry[n]);
    }
    rg_supports_forget(k->supports);
    return k;
}

/* ---- Values ---- */

static const rg_boundary *boundary_of(const rg_constraints *k, const entry *e, int i) {
    return &k->input->boundary[e->boundary[i]];
}

static double value_at(const rg_constraints *k, const entry *e, int i, double time) {
    double x[3];
    rg_node_position(k->domain->corner + 12 * (size_t)e->slot, e->pattern->node[i], x);
    return rg_support_value(boundary_of(k, e, i), e->component, x, time);
}

/* Whether the displacement of constrained node i is prescribed, not its velocity alone. */
static bool is_placed(const rg_constraints *k, const entry *e, int i) {
    return rg_boundary_is_placed(boundary_of(k, e, i));
}

/* Velocity of constrained node i at `time`; of a prescribed displacement, its difference over a step. */
static double velocity_at(const rg_constraints *k, const entry *e, int i, double time, double dt) {
    double x[3];
    rg_node_position(k->domain->corner + 12 * (size_t)e->slot, e->pattern->node[i], x);
    return rg_support_velocity(boundary_of(k, e, i), e->component, x, time, dt);
}

/* Notes that constrained node i of an entry was told something that is not finite at `time`. */
static void note(rg_constraints *k, const entry *e, int i, double time) {
    double x[3];
    rg_node_position(k->domain->corner + 12 * (size_t)e->slot, e->pattern->node[i], x);
    rg_supports_note(k->supports, e->boundary[i], x, time);
}

bool rg_constraints_told(const rg_constraints *k, char *words, size_t size, MPI_Comm comm) {
    return rg_supports_told(k->supports, words, size, comm);
}

void rg_constraints_start(rg_constraints *k, const rg_real *u, const rg_real *velocity, MPI_Comm comm) {
    int64_t jumps = rg_oblique_start(k->oblique, u, velocity);
    for (size_t n = 0; n < k->entries; n++) {
        entry *e = &k->entry[n];
        for (int i = 0; i < e->pattern->constrained; i++) {
            size_t at = rg_node_index((size_t)e->slot, e->pattern->node[i], e->component);
            e->is.before[i] = velocity[at];
            e->is.displacement[i] = u[at];
            double begin = k->input->boundary[e->boundary[i]].from;
            e->is.target[i] = e->is.present[i] = velocity_at(k, e, i, begin, 0);
            double first = value_at(k, e, i, begin);
            if (!isfinite(first)) {
                note(k, e, i, begin);
            }
            double volume = k->domain->geom[rg_geom_index((size_t)e->slot, RG_GEOM_VOLUME)];
            jumps += is_placed(k, e, i) && !(begin > 0) && fabs(first - u[at]) > JUMP * cbrt(volume);
        }
    }
    char words[400];
    if (rg_constraints_told(k, words, sizeof words, comm)) {
        rg_speak(comm);
        rg_fatal(RG_USAGE, "%s: %s", k->input->path, words);
    }
    int rank;
    MPI_Comm_rank(comm, &rank);
    MPI_Allreduce(MPI_IN_PLACE, &jumps, 1, MPI_INT64_T, MPI_SUM, comm);
    if (rank == 0 && jumps > 0) {
        rg_warn("boundary: %" PRId64
                " prescribed displacements differ from the initial ones at t = 0; the first "
                "step imposes them",
                jumps);
    }
}

void rg_constraints_set(rg_constraints *k, double time, double dt_last, double dt) {
    rg_supports_set(k->supports, time, dt_last, dt);
    rg_oblique_set(k->oblique, time, dt);
    for (size_t n = 0; k->varies && n < k->entries; n++) {
        entry *e = &k->entry[n];
        for (int i = 0; e->varies && i < e->pattern->constrained; i++) {
            if (!k->supports->acts[e->boundary[i]]) {
                continue;
            }
            if (is_placed(k, e, i)) {
                double next = value_at(k, e, i, time + dt);
                e->is.target[i] = (next - e->is.displacement[i]) / dt;
                e->is.displacement[i] = next;
            } else {
                e->is.target[i] = value_at(k, e, i, time + 0.5 * dt);
            }
            e->is.present[i] = velocity_at(k, e, i, time, dt);
            if (!isfinite(e->is.target[i] + e->is.present[i])) {
                note(k, e, i, time);
            }
        }
    }
}

/* ---- Correction ---- */

static int position(const rg_pattern *p, int node) {
    int i = 0;
    while (p->node[i] != node) {
        i++;
    }
    return i;
}

/* That of the nodes of an entry whose boundaries act at present. */
static const rg_pattern *pattern_now(const rg_constraints *k, const entry *e) {
    unsigned mask = 0;
    for (int i = 0; k->supports->timed && i < e->pattern->constrained; i++) {
        mask |= (k->supports->acts[e->boundary[i]] ? 1u : 0u) << e->pattern->node[i];
    }
    return k->supports->timed ? k->patterns.of[mask] : e->pattern;
}

/* Adds to the velocities of an entry's nodes what brings those that are constrained now, by pattern p, to
 * `target`, by `impulse` on these; returns the work of that. */
static double correct(const entry *e, const rg_pattern *p, const double *target, rg_real *velocity,
                      double impulse[RG_NODES]) {
    int of[RG_NODES]; /* positions in the entry's own pattern */
    double work = 0, change[RG_NODES];
    memset(impulse, 0, RG_NODES * sizeof *impulse);
    for (int i = 0; i < p->constrained; i++) {
        of[i] = p == e->pattern ? i : position(e->pattern, p->node[i]);
        change[i] = target[of[i]] - velocity[rg_node_index((size_t)e->slot, p->node[i], e->component)];
    }
    for (int i = 0; i < p->constrained; i++) {
        double sum = 0;
        for (int j = 0; j < p->constrained; j++) {
            sum += p->impulse[i][j] * change[j];
        }
        impulse[of[i]] = e->mass * sum;
        work += 0.5 * e->mass * sum * (e->is.before[of[i]] + target[of[i]]);
    }
    for (int n = 0; n < RG_NODES; n++) {
        size_t at = rg_node_index((size_t)e->slot, p->node[n], e->component);
        if (n < p->constrained) {
            velocity[at] = (rg_real)target[of[n]];
            continue;
        }
        double v = velocity[at];
        for (int j = 0; j < p->constrained; j++) {
            v += p->follow[n][j] * change[j];
        }
        velocity[at] = (rg_real)v;
    }
    return work;
}

/* The force and work of those boundaries of an entry that have a name. */
static void book(const rg_constraints *k, const entry *e, const rg_real *u, const double impulse[RG_NODES]) {
    for (int i = 0; i < e->pattern->constrained; i++) {
        rg_account_entry sum = {.before = 0};
        int boundary = e->boundary[i];
        bool told = k->supports->item[boundary] < 0;
        for (int j = 0; j < i; j++) {
            told = told || e->boundary[j] == boundary;
        }
        for (int j = i; !told && j < e->pattern->constrained; j++) {
            if (e->boundary[j] == boundary) {
                double force = impulse[j] / k->supports->dt_kick,
                       before = 0.5 * k->supports->dt_last * force * e->is.before[j];
                const double along[3] = {e->component == 0 ? force : 0, e->component == 1 ? force : 0,
                                         e->component == 2 ? force : 0};
                rg_account_add_force(&sum, k->domain, (size_t)e->slot, e->pattern->node[j], u, along);
                sum.before += before;
                sum.after += 0.5 * impulse[j] * (e->is.before[j] + e->is.target[j]) - before;
            }
        }
        if (!told) {
            rg_account_book(k->supports->account, k->supports->item[boundary], &sum);
        }
    }
}

void rg_constraints_kick(rg_constraints *k, size_t tile, const rg_real *u, rg_real *velocity, rg_real *now) {
    rg_oblique_kick(k->oblique, tile, u, velocity, now);
    for (size_t n = k->tile_begin[tile]; n < k->tile_begin[tile + 1]; n++) {
        entry *e = &k->entry[n];
        const rg_pattern *p = pattern_now(k, e);
        double impulse[RG_NODES];
        if (now != NULL) {
            e->is.work_now = e->is.work + correct(e, p, e->is.present, now, impulse);
        }
        e->is.work += correct(e, p, e->is.target, velocity, impulse);
        if (k->supports->named) {
            book(k, e, u, impulse);
        }
        memcpy(e->is.before, e->is.target, sizeof e->is.before);
        for (int i = 0; p != e->pattern && i < e->pattern->constrained; i++) {
            if (!k->supports->acts[e->boundary[i]]) { /* where it may begin */
                e->is.before[i] = velocity[rg_node_index((size_t)e->slot, e->pattern->node[i], e->component)];
            }
        }
    }
}

void rg_constraints_drift(rg_constraints *k, size_t tile, rg_real *u) {
    rg_oblique_drift(k->oblique, tile, u);
    for (size_t n = k->tile_begin[tile]; n < k->tile_begin[tile + 1]; n++) {
        entry *e = &k->entry[n];
        for (int i = 0; i < e->pattern->constrained; i++) {
            rg_real *here = &u[rg_node_index((size_t)e->slot, e->pattern->node[i], e->component)];
            if (is_placed(k, e, i) && k->supports->acts[e->boundary[i]]) {
                *here = (rg_real)e->is.displacement[i];
            } else if (is_placed(k, e, i)) {
                e->is.displacement[i] = *here;
            }
        }
    }
}

void rg_constraints_place(rg_constraints *k, rg_real *u) {
    rg_supports_set(k->supports, 0, 0, 0);
    for (size_t n = 0; n < k->entries; n++) {
        const entry *e = &k->entry[n];
        for (int i = 0; i < e->pattern->constrained; i++) {
            if (is_placed(k, e, i) && k->supports->acts[e->boundary[i]]) {
                u[rg_node_index((size_t)e->slot, e->pattern->node[i], e->component)] =
                    (rg_real)value_at(k, e, i, 0);
            }
        }
    }
    rg_oblique_place(k->oblique, u);
}

void rg_constraints_show(const rg_constraints *k, rg_held_line *show, void *to) {
    for (size_t n = 0; n < k->entries; n++) {
        const entry *e = &k->entry[n];
        const double line[3] = {e->component == 0, e->component == 1, e->component == 2};
        for (int i = 0; i < e->pattern->constrained; i++) {
            if (k->supports->acts[e->boundary[i]]) {
                show(to, (size_t)e->slot, e->pattern->node[i], line);
            }
        }
    }
    rg_oblique_show(k->oblique, show, to);
}

void rg_constraints_mark(const rg_constraints *k, uint8_t *slots) {
    for (size_t n = 0; n < k->entries; n++) {
        slots[k->entry[n].slot] = 1;
    }
    rg_oblique_mark(k->oblique, slots);
}

void rg_constraints_hold(const rg_constraints *k, size_t tile, rg_real *field) {
    static const double rest[RG_NODES] = {0};
    double impulse[RG_NODES];
    rg_oblique_hold(k->oblique, tile, field);
    for (size_t n = k->tile_begin[tile]; n < k->tile_begin[tile + 1]; n++) {
        correct(&k->entry[n], pattern_now(k, &k->entry[n]), rest, field, impulse);
    }
}

void rg_constraints_work(const rg_constraints *k, rg_exact_sum *work) {
    rg_oblique_work(k->oblique, work);
    for (size_t n = 0; n < k->entries; n++) {
        rg_exact_add(work, k->entry[n].is.work_now);
    }
}

void rg_constraints_register(rg_constraints *k, rg_state *st) {
    enum { VALUES = sizeof(memory) / sizeof(double) };
    if (k->key == NULL) { /* a list of state keeps a reference: all have the same */
        k->key = rg_alloc(k->entries, sizeof *k->key);
    }
    for (size_t n = 0; n < k->entries; n++) {
        k->key[n] = 4 * k->domain->id[k->entry[n].slot] + k->entry[n].component;
    }
    void *first = k->entries == 0 ? NULL : &k->entry[0].is;
    rg_state_add_list(st, "constraint", RG_STATE_DOUBLE, VALUES, first, sizeof *k->entry, k->entries, k->key);
    rg_oblique_register(k->oblique, st);
}

void rg_constraints_describe(const rg_constraints *k, int b, char *words, size_t size) {
    rg_supports_describe(k->supports, b, words, size);
}

void rg_constraints_free(rg_constraints *k) {
    if (k == NULL) {
        return;
    }
    rg_patterns_clear(&k->patterns);
    rg_free(k->entry);
    rg_oblique_free(k->oblique);
    rg_supports_free(k->supports);
    rg_free(k->key);
    rg_free(k->tile_begin);
    rg_free(k);
}
