#include "partition/material_map.h"

#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/error.h"
#include "base/exchange.h"
#include "base/mem.h"
#include "base/first_bad.h"
#include "case/problem.h"
#include "mesh/gid_map.h"
#include "partition/orientation.h"

typedef struct {
    const rg_case *c;
    rg_part *part;
    MPI_Comm comm;
    int rank;
    int *region;      /* [others]: volume set of entry i; -1: it has an expression */
    int *last;        /* [groups of volume sets]: the last entry whose set holds it, from 1 on; 0: none */
    int64_t *claimed; /* [others]: elements that entry i claims */
} map;

/* ---- Who claims what ---- */

static _Noreturn void refuse_set(const map *m, int i) {
    const rg_part *part = m->part;
    char all[1024];
    const char **names = RG_NEW(const char *, (size_t)part->volume.count + 1);
    memcpy(names, part->volume.name, (size_t)part->volume.count * sizeof *names);
    rg_speak(m->comm);
    rg_fatal(RG_USAGE, "%s: materials[%d].set: %s: %s has no such volume set; allowed: %s", m->c->path, i,
             m->c->other[i].set, m->c->mesh.file, rg_choices(m->c->other[i].set, names, all, sizeof all));
}

/* Which entry has an element by its sets alone: no element asks them all. */
static void find_last(map *m) {
    const rg_sets *sets = &m->part->volume;
    int *entry = RG_NEW(int, (size_t)sets->count + 1);
    for (int i = 0; i < m->c->others; i++) {
        if (m->region[i] >= 0) {
            entry[m->region[i]] = i + 1;
        }
    }
    for (int32_t g = 0; g < rg_sets_groups(sets); g++) {
        int32_t count;
        const int32_t *set = rg_sets_of(sets, &g, &count);
        for (int32_t k = 0; k < count; k++) {
            m->last[g] = m->last[g] > entry[set[k]] ? m->last[g] : entry[set[k]];
        }
    }
    rg_free(entry);
}

static void find_regions(map *m) {
    for (int i = 0; i < m->c->others; i++) {
        const char *set = m->c->other[i].set;
        m->region[i] = set != NULL ? rg_sets_find(&m->part->volume, set) : -1;
        if (set != NULL && m->region[i] < 0) {
            refuse_set(m, i);
        }
    }
}

/* Expressions of a thread's own, with the entries that they are of. */
typedef struct {
    int count, *entry;
    rg_expr **where;
    int64_t *claimed; /* [others] */
} asking;

static asking ask(const rg_case *c) {
    size_t room = (size_t)c->others + 1;
    asking a = {0, RG_NEW(int, room), RG_NEW(rg_expr *, room), RG_NEW(int64_t, room)};
    for (int i = 0; i < c->others; i++) {
        if (c->other[i].where != NULL) {
            a.entry[a.count] = i;
            a.where[a.count++] = rg_expr_copy(c->other[i].where);
        }
    }
    return a;
}

static void ask_no_more(asking *a) {
    for (int k = 0; k < a->count; k++) {
        rg_expr_free(a->where[k]);
    }
    rg_free(a->entry);
    rg_free(a->where);
    rg_free(a->claimed);
}

/* The last entry that claims element k has it. */
static void claim(map *m, rg_lid k, asking *a, rg_first_bad *bad) {
    rg_element *e = &m->part->element[k];
    int last = e->region >= 0 ? m->last[e->region] : 0;
    double x[3];
    rg_element_centroid(e, x);
    for (int j = 0; j < a->count; j++) {
        int i = a->entry[j];
        double here = rg_expr_value(a->where[j], x, 0);
        if (!isfinite(here)) {
#pragma omp critical
            rg_first_bad_note(bad, i, x, here);
        } else if (here != 0) {
            last = last > i + 1 ? last : i + 1;
            a->claimed[i]++;
        }
    }
    e->material = (uint16_t)last;
}

/* Elements of the sets that entries name. */
static void count_sets(map *m) {
    const rg_sets *sets = &m->part->volume;
    int64_t *of = RG_NEW(int64_t, (size_t)sets->count + 1);
    for (rg_lid k = 0; k < m->part->elements; k++) {
        int32_t count;
        const int32_t *set = rg_sets_of(sets, &m->part->element[k].region, &count);
        for (int32_t j = 0; j < count; j++) {
            of[set[j]]++;
        }
    }
    for (int i = 0; i < m->c->others; i++) {
        m->claimed[i] = m->region[i] >= 0 ? of[m->region[i]] : 0;
    }
    rg_free(of);
}

/* Of all entries and ranks the lowest place is told. */
static void refuse_values(const map *m, rg_first_bad *bad) {
    if (rg_first_bad_lowest(bad, m->comm)) {
        rg_speak(m->comm);
        rg_fatal(RG_USAGE, "%s: materials[%d].where: %s is %g at (%g, %g, %g), the centroid of an element",
                 m->c->path, (int)bad->which, rg_expr_text(m->c->other[bad->which].where), bad->value,
                 bad->x[0], bad->x[1], bad->x[2]);
    }
}

static void claim_all(map *m) {
    rg_first_bad bad = {.which = RG_NOWHERE};
    find_last(m);
    count_sets(m);
#pragma omp parallel
    {
        asking a = ask(m->c);
#pragma omp for schedule(static)
        for (rg_lid k = 0; k < m->part->elements; k++) {
            claim(m, k, &a, &bad);
        }
#pragma omp critical
        for (int j = 0; j < a.count; j++) {
            m->claimed[a.entry[j]] += a.claimed[a.entry[j]];
        }
        ask_no_more(&a);
    }
    refuse_values(m, &bad);
}

static void check_claims(map *m) {
    const rg_case *c = m->c;
    MPI_Allreduce(MPI_IN_PLACE, m->claimed, c->others, MPI_INT64_T, MPI_SUM, m->comm);
    for (int i = 0; i < c->others; i++) {
        if (m->claimed[i] == 0) {
            const rg_other_material *o = &c->other[i];
            rg_speak(m->comm);
            rg_fatal(RG_USAGE, "%s: materials[%d].%s: %s: no element is in it", c->path, i,
                     o->set != NULL ? "set" : "where", o->set != NULL ? o->set : rg_expr_text(o->where));
        }
    }
}

/* ---- Neighbours ---- */

/* What an element tells of itself across its face. */
typedef struct {
    rg_gid element; /* to whom */
    int8_t face;    /* ... at which of its faces */
    uint16_t material;
    int32_t region;
    double angles[3]; /* of its axes, where solids have such */
} message;

/* What is beyond face f of an element. */
static void hear(const map *m, rg_element *e, int f, const message *of) {
    bool differ = of->material != e->material || of->region != e->region;
    e->beside[f] = of->material;
    e->across |= (uint8_t)(differ ? 1u << f : 0);
    if (m->part->turn != NULL) {
        memcpy(m->part->turn[e - m->part->element].beside[f], of->angles, sizeof of->angles);
    }
}

/* What element e says across its face f. */
static message say(const map *m, const rg_element *e, int f) {
    message out = {e->neighbour[f], e->face[f], e->material, e->region, {0}};
    if (m->part->turn != NULL) {
        memcpy(out.angles, m->part->turn[e - m->part->element].own, sizeof out.angles);
    }
    return out;
}

/* Element `id` of the own part; start: where its tiles begin. */
static rg_element *element_at(const map *m, const rg_gid_map *start, rg_gid id) {
    return &m->part->element[rg_gid_map_get(start, id / m->part->tile) + id % m->part->tile];
}

/* Those of own neighbours; lists what other ranks must know. Returns how much. */
static size_t tell_own(const map *m, const rg_gid_map *start, message *out, int *to) {
    size_t count = 0;
    for (rg_lid k = 0; k < m->part->elements; k++) {
        rg_element *e = &m->part->element[k];
        for (int f = 0; f < 4; f++) {
            if (e->owner[f] >= 0 && e->owner[f] != m->rank) {
                if (out != NULL) {
                    out[count] = say(m, e, f);
                    to[count] = e->owner[f];
                }
                count++;
            } else {
                const rg_element *other = e->neighbour[f] < 0 ? e : element_at(m, start, e->neighbour[f]);
                message there = say(m, other, 0);
                hear(m, e, f, &there);
            }
        }
    }
    return count;
}

static void tell_neighbours(const map *m) {
    rg_gid_map start = rg_gid_map_make((size_t)m->part->tiles);
    for (rg_lid t = 0, at = 0; t < m->part->tiles; t++) {
        rg_gid_map_put(&start, m->part->tile_id[t], at);
        at += rg_tile_size(m->part, m->part->tile_id[t]);
    }
    size_t count = tell_own(m, &start, NULL, NULL);
    message *out = RG_NEW(message, count + 1);
    int *to = RG_NEW(int, count + 1);
    tell_own(m, &start, out, to);
    rg_exchange *x = rg_exchange_make(to, count, m->comm);
    message *in = RG_NEW(message, x->arriving + 1);
    rg_exchange_send(x, sizeof *out, out, in);
    for (size_t i = 0; i < x->arriving; i++) {
        hear(m, element_at(m, &start, in[i].element), in[i].face, &in[i]);
    }
    rg_exchange_free(x);
    rg_free(in);
    rg_free(to);
    rg_free(out);
    rg_gid_map_free(&start);
}

static bool wants_neighbours(const rg_case *c) {
    bool any = c->others > 0 || rg_orientations_vary(c);
    for (int i = 0; i < c->interface.sets; i++) {
        any = any || rg_face_set_is_any(&c->interface.set[i]);
    }
    return any;
}

void rg_materials_assign(const rg_case *c, rg_part *part, MPI_Comm comm) {
    if (!wants_neighbours(c)) {
        return;
    }
    map m = {.c = c,
             .part = part,
             .comm = comm,
             .region = RG_NEW(int, (size_t)c->others + 1),
             .last = RG_NEW(int, (size_t)rg_sets_groups(&part->volume) + 1),
             .claimed = RG_NEW(int64_t, (size_t)c->others + 1)};
    MPI_Comm_rank(comm, &m.rank);
    find_regions(&m);
    claim_all(&m);
    check_claims(&m);
    if (rg_orientations_vary(c)) {
        rg_orientations_find(c, part, comm);
    }
    tell_neighbours(&m);
    rg_free(m.region);
    rg_free(m.last);
    rg_free(m.claimed);
}
