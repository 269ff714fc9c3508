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

typedef struct {
    const rg_case *c;
    rg_part *part;
    MPI_Comm comm;
    int rank;
    int region[RG_MAX_MATERIALS];      /* volume set of entry i; -1: it has an expression */
    int64_t claimed[RG_MAX_MATERIALS]; /* elements that entry i claims */
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

static void find_regions(map *m) {
    for (int i = 0; i < m->c->others; i++) {
        const char *set = m->c->other[i].set;
        m->region[i] = set != NULL ? rg_sets_find(&m->part->volume, set) : -1;
        if (set != NULL && m->region[i] < 0) {
            refuse_set(m, i);
        }
    }
}

static void find_centroid(const rg_element *e, double x[3]) {
    for (int k = 0; k < 3; k++) {
        x[k] = 0.25 * ((e->x[0][k] + e->x[1][k]) + (e->x[2][k] + e->x[3][k]));
    }
}

/* Asks all entries for element k; where[i] are a thread's own expressions. */
static void claim(map *m, rg_lid k, rg_expr *const where[], int64_t claimed[], rg_first_bad *bad) {
    rg_element *e = &m->part->element[k];
    double x[3];
    find_centroid(e, x);
    for (int i = 0; i < m->c->others; i++) {
        double here = where[i] != NULL ? rg_expr_value(where[i], x, 0)
                                       : rg_sets_hold(&m->part->volume, e->region, m->region[i]);
        if (!isfinite(here)) {
#pragma omp critical
            rg_first_bad_note(bad, i, x, here);
        } else if (here != 0) {
            e->material = (uint8_t)(i + 1);
            claimed[i]++;
        }
    }
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
#pragma omp parallel
    {
        rg_expr *where[RG_MAX_MATERIALS];
        int64_t claimed[RG_MAX_MATERIALS] = {0};
        for (int i = 0; i < m->c->others; i++) {
            where[i] = rg_expr_copy(m->c->other[i].where);
        }
#pragma omp for schedule(static)
        for (rg_lid k = 0; k < m->part->elements; k++) {
            claim(m, k, where, claimed, &bad);
        }
#pragma omp critical
        for (int i = 0; i < m->c->others; i++) {
            m->claimed[i] += claimed[i];
        }
        for (int i = 0; i < m->c->others; i++) {
            rg_expr_free(where[i]);
        }
    }
    refuse_values(m, &bad);
}

static void check_claims(map *m) {
    const rg_case *c = m->c;
    MPI_Allreduce(MPI_IN_PLACE, m->claimed, RG_MAX_MATERIALS, MPI_INT64_T, MPI_SUM, m->comm);
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
    uint8_t material;
} message;

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
                    out[count] = (message){e->neighbour[f], e->face[f], e->material};
                    to[count] = e->owner[f];
                }
                count++;
            } else {
                e->beside[f] =
                    e->neighbour[f] < 0 ? e->material : element_at(m, start, e->neighbour[f])->material;
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
        element_at(m, &start, in[i].element)->beside[in[i].face] = in[i].material;
    }
    rg_exchange_free(x);
    rg_free(in);
    rg_free(to);
    rg_free(out);
    rg_gid_map_free(&start);
}

void rg_materials_assign(const rg_case *c, rg_part *part, MPI_Comm comm) {
    if (c->others == 0) {
        return;
    }
    map m = {.c = c, .part = part, .comm = comm};
    MPI_Comm_rank(comm, &m.rank);
    find_regions(&m);
    claim_all(&m);
    check_claims(&m);
    tell_neighbours(&m);
}
