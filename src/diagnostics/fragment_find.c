#include <stdlib.h>

#include "base/exchange.h"
#include "base/mem.h"
#include "diagnostics/crack_surface.h"
#include "diagnostics/fragment.h"
#include "domain/element.h"
#include "solver/tile.h"

/* At work: the components of this rank's elements. */
typedef struct {
    const rg_solver *s;
    const rg_domain *d;
    rg_lid *parent;   /* [slots]: union-find */
    rg_lid *row_slot; /* [own rows]: element of a tile-boundary face */
    size_t count;     /* components */
    rg_lid *of;       /* [slots]: component, -1 in padding */
    rg_fragment_label *label;
    uint8_t *shared; /* [count] */
} finder;

static bool holds(const rg_solver *s, size_t i) {
    if (s->broken[i] != (1 << RG_POINTS) - 1) {
        return true;
    }
    for (int q = 0; q < RG_POINTS; q++) {
        if (rg_damage(s, i, q) < 1) {
            return true;
        }
    }
    return false;
}

/* ---- On this rank ---- */

static rg_lid find_root(rg_lid *parent, rg_lid i) {
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

static void join(rg_lid *parent, rg_lid a, rg_lid b) {
    a = find_root(parent, a);
    b = find_root(parent, b);
    parent[a < b ? b : a] = a < b ? a : b;
}

/* Element on side k of interface i of tile t. */
static rg_lid side_slot(const rg_domain *d, const rg_tile *t, size_t i, int k) {
    return (rg_lid)(t->begin * RG_LANES) + d->side[k][i] / RG_FACES;
}

/* Row in which tile-boundary face i finds its other side. */
static size_t other_row(const rg_domain *d, size_t i) {
    return (size_t)d->side[1][i] / 2;
}

static void list_rows(finder *f) {
    for (size_t t = 0; t < f->d->tiles; t++) {
        const rg_tile *tile = &f->d->tile[t];
        size_t first = tile->sbegin * RG_LANES;
        for (size_t i = first; i < tile->iend * RG_LANES; i++) {
            f->row_slot[tile->row + i - first] = side_slot(f->d, tile, i, 0);
        }
    }
}

static void join_tile(finder *f, const rg_tile *t) {
    for (size_t i = t->ibegin * RG_LANES; i < t->iend * RG_LANES; i++) {
        bool tile_face = i >= t->sbegin * RG_LANES;
        bool elsewhere = tile_face && other_row(f->d, i) >= f->d->own_rows;
        if (f->d->counted[i] && !elsewhere && holds(f->s, i)) {
            rg_lid other = tile_face ? f->row_slot[other_row(f->d, i)] : side_slot(f->d, t, i, 1);
            join(f->parent, side_slot(f->d, t, i, 0), other);
        }
    }
}

/* Elements that share nodes hang together. */
static void join_conforming_faces(finder *f) {
    for (size_t k = 0; f->s->conforming_faces != NULL && k < f->s->conforming_faces->count; k++) {
        const rg_conforming_face *conforming_face = &f->s->conforming_faces->conforming_face[k];
        join(f->parent, conforming_face->slot[0], conforming_face->slot[1]);
    }
}

/* Numbers the components by their roots, which come before all other members. */
static void number_components(finder *f) {
    for (size_t i = 0; i < f->d->blocks * RG_LANES; i++) {
        rg_lid root = find_root(f->parent, (rg_lid)i);
        f->of[i] = f->d->id[i] < 0 ? -1 : root == (rg_lid)i ? (rg_lid)f->count++ : f->of[root];
    }
}

void rg_current_corners(const rg_solver *s, size_t slot, double x[4][3]) {
    for (int a = 0; a < 4; a++) {
        for (int c = 0; c < 3; c++) {
            x[a][c] = s->domain->corner[12 * slot + (size_t)(3 * a + c)] + s->u[rg_node_index(slot, a, c)];
        }
    }
}

static rg_fragment_label element_label(const finder *f, size_t slot) {
    rg_fragment_label label = {.id = f->d->id[slot]};
    double x[4][3];
    rg_current_corners(f->s, slot, x);
    for (int c = 0; c < 3; c++) {
        label.anchor[c] = 0.25 * (x[0][c] + x[1][c] + x[2][c] + x[3][c]);
    }
    return label;
}

static void label_components(finder *f) {
    f->label = RG_NEW(rg_fragment_label, f->count);
    f->shared = RG_NEW(uint8_t, f->count + 1);
    for (size_t k = 0; k < f->count; k++) {
        f->label[k].id = INT64_MAX;
    }
    for (size_t i = 0; i < f->d->blocks * RG_LANES; i++) {
        if (f->of[i] >= 0 && f->d->id[i] < f->label[f->of[i]].id) {
            f->label[f->of[i]] = element_label(f, i);
        }
    }
}

/* ---- Across ranks ---- */

/* Faces between ranks, in the order in which the other side lists them too, of one kind: tile-boundary faces
 * or shared-node faces. */
typedef struct {
    rg_exchange *x;
    rg_lid *bridge; /* the component on this side of each that holds; -1 where it does not */
    rg_fragment_label *message, *arrived;
} bridges;

static void cross(finder *f, bridges *b, size_t at, rg_lid component) {
    b->bridge[at] = component;
    f->shared[component < 0 ? f->count : (size_t)component] = 1;
}

static void list_tile_faces(finder *f, bridges *b) {
    for (size_t t = 0; t < f->d->boundary_tiles; t++) {
        const rg_tile *tile = &f->d->tile[t];
        for (size_t i = tile->sbegin * RG_LANES; i < tile->iend * RG_LANES; i++) {
            if (other_row(f->d, i) >= f->d->own_rows) {
                rg_lid own = holds(f->s, i) ? f->of[side_slot(f->d, tile, i, 0)] : -1;
                cross(f, b, other_row(f->d, i) - f->d->own_rows, own);
            }
        }
    }
}

static void list_conforming_faces(finder *f, bridges *b) {
    for (size_t k = 0; k < b->x->count; k++) {
        cross(f, b, k, f->of[f->s->conforming_faces->far[k].slot]);
    }
}

static bridges make_bridges(const finder *f, const int *to, size_t count) {
    rg_fragment_label *message = RG_NEW(rg_fragment_label, 2 * count);
    return (bridges){rg_exchange_make(to, count, f->s->comm), RG_NEW(rg_lid, count), message,
                     message + count};
}

static void free_bridges(bridges *b) {
    rg_exchange_free(b->x);
    rg_free(b->bridge);
    rg_free(b->message);
}

/* One exchange of labels; whether one became smaller here. */
static bool spread(finder *f, bridges *b) {
    bool changed = false;
    for (size_t k = 0; k < b->x->count; k++) {
        b->message[k] = b->bridge[k] < 0 ? (rg_fragment_label){.id = -1} : f->label[b->bridge[k]];
    }
    rg_exchange_send(b->x, sizeof *b->message, b->message, b->arrived);
    for (size_t k = 0; k < b->x->count; k++) {
        if (b->bridge[k] >= 0 && b->arrived[k].id < f->label[b->bridge[k]].id) {
            f->label[b->bridge[k]] = b->arrived[k];
            changed = true;
        }
    }
    return changed;
}

static void label_across(finder *f) {
    const rg_conforming_faces *conforming_faces = f->s->conforming_faces;
    int *to = RG_NEW(int, f->d->shared);
    for (size_t k = 0; k < f->d->shared; k++) {
        to[k] = f->d->shared_face[k].rank;
    }
    bridges kind[2] = {make_bridges(f, to, f->d->shared)};
    int kinds = conforming_faces == NULL ? 1 : 2, changed = f->s->ranks > 1;
    list_tile_faces(f, &kind[0]);
    if (kinds == 2) {
        kind[1] = make_bridges(f, conforming_faces->far_rank, conforming_faces->fars);
        list_conforming_faces(f, &kind[1]);
    }
    while (changed) {
        changed = 0;
        for (int k = 0; k < kinds; k++) {
            changed |= spread(f, &kind[k]);
        }
        MPI_Allreduce(MPI_IN_PLACE, &changed, 1, MPI_INT, MPI_MAX, f->s->comm);
    }
    for (int k = 0; k < kinds; k++) {
        free_bridges(&kind[k]);
    }
    rg_free(to);
}

/* ---- Result ---- */

typedef struct {
    rg_gid id;
    rg_lid component;
} numbered;

static int by_id(const void *a, const void *b) {
    const numbered *p = a, *q = b;
    return (p->id > q->id) - (p->id < q->id);
}

/* Components become fragments: several are one where they hang together on other ranks. */
static void merge_components(const finder *f, rg_fragment_parts *p) {
    numbered *list = RG_NEW(numbered, f->count);
    rg_lid *fragment = RG_NEW(rg_lid, f->count);
    for (size_t k = 0; k < f->count; k++) {
        list[k] = (numbered){f->label[k].id, (rg_lid)k};
    }
    qsort(list, f->count, sizeof *list, by_id);
    p->label = RG_NEW(rg_fragment_label, f->count);
    p->shared = RG_NEW(uint8_t, f->count);
    for (size_t k = 0; k < f->count; k++) {
        p->count += k == 0 || list[k].id != list[k - 1].id;
        fragment[list[k].component] = (rg_lid)p->count - 1;
        p->label[p->count - 1] = f->label[list[k].component];
        p->shared[p->count - 1] |= f->shared[list[k].component];
    }
    for (size_t i = 0; i < f->d->blocks * RG_LANES; i++) {
        p->of[i] = f->of[i] < 0 ? -1 : fragment[f->of[i]];
    }
    rg_free(fragment);
    rg_free(list);
}

static void list_members(const rg_domain *d, rg_fragment_parts *p) {
    size_t slots = d->blocks * RG_LANES;
    p->start = RG_NEW(size_t, p->count + 2);
    p->member = RG_NEW(rg_lid, d->elements);
    for (size_t i = 0; i < slots; i++) { /* counts, two places on, become ends, one place on */
        p->start[p->of[i] + 2] += p->of[i] >= 0;
    }
    for (size_t k = 0; k < p->count; k++) {
        p->start[k + 2] += k == 0 ? 0 : p->start[k + 1];
    }
    for (size_t i = 0; i < slots; i++) {
        if (p->of[i] >= 0) {
            p->member[p->start[p->of[i] + 1]++] = (rg_lid)i;
        }
    }
}

rg_fragment_parts *rg_fragments_find(const rg_solver *s) {
    const rg_domain *d = s->domain;
    size_t slots = d->blocks * RG_LANES;
    rg_fragment_parts *p = RG_NEW(rg_fragment_parts, 1);
    p->of = RG_NEW(rg_lid, slots);
    finder f = {s, d, RG_NEW(rg_lid, slots), RG_NEW(rg_lid, d->own_rows), 0, p->of, NULL, NULL};
    for (size_t i = 0; i < slots; i++) {
        f.parent[i] = (rg_lid)i;
    }
    list_rows(&f);
    for (size_t t = 0; t < d->tiles; t++) {
        join_tile(&f, &d->tile[t]);
    }
    join_conforming_faces(&f);
    number_components(&f);
    label_components(&f);
    label_across(&f);
    merge_components(&f, p);
    list_members(d, p);
    rg_free(f.parent);
    rg_free(f.row_slot);
    rg_free(f.label);
    rg_free(f.shared);
    return p;
}

void rg_fragment_parts_free(rg_fragment_parts *p) {
    if (p == NULL) {
        return;
    }
    void *blocks[] = {p->label, p->shared, p->of, p->start, p->member, p};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
        rg_free(blocks[i]);
    }
}
