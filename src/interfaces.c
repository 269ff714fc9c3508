#include "interfaces.h"

#include <math.h>
#include <stdlib.h>

#include "layout.h"
#include "mem.h"

/* One interface before it has its place. */
typedef struct {
    uint64_t group;  /* tile it lies in; then "between tiles"; then "shared" */
    int32_t link[2]; /* 4 * slot + face of the minus and the plus side */
    int32_t own;     /* index in the part of an own element */
    int8_t own_face;
    int8_t own_side; /* 0: the own element is minus */
} face;

static int by_sweep(const void *a, const void *b) {
    const face *p = a, *q = b;
    if (p->group != q->group) {
        return p->group < q->group ? -1 : 1;
    }
    int32_t last[2] = {p->link[0] > p->link[1] ? p->link[0] : p->link[1],
                       q->link[0] > q->link[1] ? q->link[0] : q->link[1]};
    if (last[0] != last[1]) {
        return last[0] < last[1] ? -1 : 1;
    }
    return (p->link[0] > q->link[0]) - (p->link[0] < q->link[0]);
}

/* Tile of each own block. */
static uint32_t *tile_of_block(const rg_domain *d) {
    uint32_t *tile = RG_NEW(uint32_t, d->blocks + 1);
    for (size_t t = 0; t < d->tiles; t++) {
        for (size_t b = d->tile[t].begin; b < d->tile[t].end; b++) {
            tile[b] = (uint32_t)t;
        }
    }
    return tile;
}

static uint64_t group_of(const rg_domain *d, const uint32_t *tile, int32_t slot, int32_t other) {
    size_t b[2] = {(size_t)slot / RG_LANES, (size_t)other / RG_LANES};
    if (b[1] >= d->blocks) {
        return d->tiles + 1;
    }
    return tile[b[0]] == tile[b[1]] ? tile[b[0]] : d->tiles;
}

/* Every interior face once: from its minus side, or from the own side if the other rank has the other one. */
static face *collect(const rg_domain *d, const rg_part *part, int rank, const rg_gid_map *slot,
                     size_t *count) {
    face *list = RG_NEW(face, 4 * (size_t)part->elements + 1);
    uint32_t *tile = tile_of_block(d);
    size_t n = 0;
    for (rg_lid i = 0; i < part->elements; i++) {
        const rg_element *e = &part->element[i];
        rg_lid own = rg_gid_map_get(slot, e->id);
        for (int8_t f = 0; f < RG_FACES; f++) {
            bool plus = e->neighbour[f] < e->id;
            if (e->neighbour[f] < 0 || (plus && e->owner[f] == rank)) {
                continue;
            }
            rg_lid other = rg_gid_map_get(slot, e->neighbour[f]);
            int32_t here = rg_link(own, f, RG_FACES), there = rg_link(other, e->face[f], RG_FACES);
            list[n++] = (face){.group = group_of(d, tile, own, other),
                               .link = {plus ? there : here, plus ? here : there},
                               .own = i,
                               .own_face = f,
                               .own_side = plus};
        }
    }
    rg_free(tile);
    *count = n;
    return list;
}

/* Edges, unit normal (minus to plus), area and penalties, from the corners of the own element's face: both
 * ranks of a shared face see the same corners in the same order, so they get the same bits. */
static void set_geometry(rg_domain *d, size_t i, const rg_element *e, const face *f,
                         const rg_interface_material *m) {
    const double *x[3];
    for (int k = 0, n = 0; k < 4; k++) {
        if (k != f->own_face) {
            x[n++] = e->x[k];
        }
    }
    double edge[2][3], away = 0, n[3];
    for (int c = 0; c < 3; c++) {
        edge[0][c] = x[1][c] - x[0][c];
        edge[1][c] = x[2][c] - x[0][c];
    }
    for (int c = 0; c < 3; c++) {
        int a = (c + 1) % 3, b = (c + 2) % 3;
        n[c] = edge[0][a] * edge[1][b] - edge[0][b] * edge[1][a];
        away -= n[c] * (e->x[f->own_face][c] - x[0][c]);
    }
    double twice = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), area = 0.5 * twice;
    double sign = (away > 0) == (f->own_side == 0) ? 1 : -1;
    double h = 3 * fmin(e->volume, e->other_volume[f->own_face]) / area;
    double shear = m->penalty == RG_PENALTY_ELASTIC ? m->mu : m->lambda + 2 * m->mu;
    double *g = d->igeom;
    for (int c = 0; c < 3; c++) {
        g[rg_igeom_index(i, RG_IGEOM_NORMAL + c)] = sign * n[c] / twice;
        g[rg_igeom_index(i, RG_IGEOM_EDGE + c)] = edge[0][c];
        g[rg_igeom_index(i, RG_IGEOM_EDGE + 3 + c)] = edge[1][c];
    }
    g[rg_igeom_index(i, RG_IGEOM_AREA)] = area;
    g[rg_igeom_index(i, RG_IGEOM_PEN_ISO)] = area * m->beta_s / h * shear;
    g[rg_igeom_index(i, RG_IGEOM_PEN_NORM)] = area * m->beta_s / h * (m->lambda + 2 * m->mu - shear);
}

/* Makes side k of interface i and the element there know each other (own elements only). */
static void connect(rg_domain *d, size_t i, const face *f, int k) {
    int32_t here = f->link[k];
    d->side[k][i] = here;
    size_t slot = (size_t)here / RG_FACES;
    if (slot < d->blocks * RG_LANES) {
        size_t at = rg_link_index(slot, here % RG_FACES);
        d->neighbour[at] = f->link[1 - k];
        d->interface[at] = rg_link((int32_t)i, k, 2);
    }
}

static void add_shared(rg_domain *d, const rg_element *e, const face *f) {
    int32_t minus = f->link[0];
    d->shared_face[d->shared++] = (rg_shared_face){.rank = e->owner[f->own_face],
                                                   .minus = d->id[minus / RG_FACES],
                                                   .minus_face = (int8_t)(minus % RG_FACES),
                                                   .own = f->link[f->own_side],
                                                   .ghost = f->link[1 - f->own_side]};
}

static int by_rank_and_key(const void *a, const void *b) {
    const rg_shared_face *p = a, *q = b;
    if (p->rank != q->rank) {
        return p->rank < q->rank ? -1 : 1;
    }
    if (p->minus != q->minus) {
        return p->minus < q->minus ? -1 : 1;
    }
    return p->minus_face - q->minus_face;
}

/* Where each group starts, in interfaces, whole blocks each; start[groups] is the number of all. */
static size_t *group_starts(const face *list, size_t count, size_t groups) {
    size_t *start = RG_NEW(size_t, groups + 1);
    for (size_t i = 0; i < count; i++) {
        start[list[i].group + 1]++;
    }
    for (size_t g = 0; g < groups; g++) {
        start[g + 1] = start[g] + (start[g + 1] + RG_LANES - 1) / RG_LANES * RG_LANES;
    }
    return start;
}

static void allocate(rg_domain *d, size_t slots, size_t shared) {
    for (int k = 0; k < 2; k++) {
        d->side[k] = RG_NEW(int32_t, slots); /* padding: both sides are face 0 of element 0, area 0 */
    }
    d->igeom = RG_NEW(double, slots *RG_IGEOM);
    d->counted = RG_NEW(uint8_t, slots);
    d->shared_face = RG_NEW(rg_shared_face, shared + 1);
}

void rg_interfaces_build(rg_domain *d, const rg_part *part, int rank, const rg_interface_material *m,
                         const rg_gid_map *slot) {
    size_t count, groups = d->tiles + 2;
    face *list = collect(d, part, rank, slot, &count);
    qsort(list, count, sizeof *list, by_sweep);
    size_t *start = group_starts(list, count, groups);
    for (size_t t = 0; t < d->tiles; t++) {
        d->tile[t].ibegin = start[t] / RG_LANES;
        d->tile[t].iend = start[t + 1] / RG_LANES;
    }
    d->between_begin = start[d->tiles] / RG_LANES;
    d->shared_begin = start[d->tiles + 1] / RG_LANES;
    d->iblocks = start[groups] / RG_LANES;
    size_t shared = 0;
    for (size_t i = 0; i < count; i++) {
        shared += list[i].group == d->tiles + 1;
    }
    allocate(d, start[groups], shared);
    for (size_t b = 0; b < d->blocks; b++) { /* surface faces read zeros behind the last interface */
        for (size_t k = 0; k < RG_LINK_BLOCK; k++) {
            d->interface[b * RG_LINK_BLOCK + k] = rg_link((int32_t)(d->iblocks * RG_LANES), 0, 2);
        }
    }
    for (size_t i = 0; i < count; i++) {
        const face *f = &list[i];
        const rg_element *e = &part->element[f->own];
        size_t at = start[f->group]++;
        connect(d, at, f, 0);
        connect(d, at, f, 1);
        set_geometry(d, at, e, f, m);
        d->counted[at] = f->own_side == 0;
        d->interfaces += f->own_side == 0;
        if (f->group == d->tiles + 1) {
            add_shared(d, e, f);
        }
    }
    qsort(d->shared_face, d->shared, sizeof *d->shared_face, by_rank_and_key);
    rg_free(start);
    rg_free(list);
}
