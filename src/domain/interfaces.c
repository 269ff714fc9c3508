#include "domain/interfaces.h"

#include <math.h>
#include <stdlib.h>

#include "base/mem.h"
#include "base/vector.h"
#include "layout.h"
#include "mesh/gid_map.h"
#include "partition/material.h"
#include "partition/orientation.h"

typedef struct {
    rg_domain *domain;
    const rg_element *const *element; /* by tile */
    const rg_turn *turn;              /* of element[0], ...; NULL: none */
    const uint8_t *joined;            /* bits of faces without an interface; NULL: none */
    int rank;
    const rg_interface_material *material;
    size_t *inside, *tile_faces; /* [tiles]: interfaces */
} builder;

/* Real elements of tile t. */
static size_t tile_elements(const builder *b, size_t t) {
    return (size_t)(b->element[t + 1] - b->element[t]);
}

static bool in_tile(const builder *b, size_t t, rg_gid e) {
    rg_gid first = b->domain->tile[t].first;
    return e >= first && e < first + (rg_gid)tile_elements(b, t);
}

/* Whether face f of element e is inside the mesh, and whether it carries an interface. */
static bool has_interface(const builder *b, const rg_element *e, int f) {
    return e->neighbour[f] >= 0 && (b->joined == NULL || (b->joined[e - b->element[0]] >> f & 1) == 0);
}

/* Whether the area vector of face f points away from the element: then that is the minus side; with the unit
 * vector along it. */
static bool is_minus(const rg_element *e, int f, double edge[2][3], double normal[3], double *area) {
    const double *x[3];
    for (int k = 0, n = 0; k < 4; k++) {
        if (k != f) {
            x[n++] = e->x[k];
        }
    }
    double cross[3], opposite[3];
    rg_vector_subtract(x[1], x[0], edge[0]);
    rg_vector_subtract(x[2], x[0], edge[1]);
    rg_vector_subtract(e->x[f], x[0], opposite);
    rg_vector_cross(edge[0], edge[1], cross);
    *area = 0.5 * sqrt(rg_vector_dot(cross, cross));
    for (int k = 0; k < 3; k++) {
        normal[k] = cross[k] / (2 * *area);
    }
    return rg_vector_dot(cross, opposite) < 0;
}

/* Of a solid whose axes are turned by these angles; NULL: they are not. */
static void face_moduli(const rg_material *m, const double *angles, const double n[3], double *lambda,
                        double *mu) {
    if (angles == NULL) {
        rg_material_face(m, n, lambda, mu);
    } else {
        rg_material turned = rg_material_turned(m, angles);
        rg_material_face(&turned, n, lambda, mu);
    }
}

/* Edges and penalties of interface i, from the corners of an element at its face f: both sides see the same
 * corners in the same order, so they get the same bits. The penalty takes the mean of both sides' moduli over
 * the smaller height, which is no less than the mean of each side's over its own. Returns whether the element
 * is on the minus side. */
static bool set_geometry(const builder *b, size_t i, const rg_element *e, int f) {
    const rg_interface_material *m = b->material;
    double edge[2][3], n[3], area, lambda[2], mu[2];
    bool minus = is_minus(e, f, edge, n, &area);
    double h = 3 * fmin(e->volume, e->other_volume[f]) / area;
    const rg_turn *turn = b->turn == NULL ? NULL : &b->turn[e - b->element[0]];
    face_moduli(&m->material[e->material], turn == NULL ? NULL : turn->own, n, &lambda[0], &mu[0]);
    face_moduli(&m->material[e->beside[f]], turn == NULL ? NULL : turn->beside[f], n, &lambda[1], &mu[1]);
    double across = 0.5 * (mu[0] + mu[1]), along = 0.5 * (lambda[0] + lambda[1]) + 2 * across;
    bool elastic = m->penalty == RG_PENALTY_ELASTIC;
    double normal = elastic ? along : fmax(along, across), shear = elastic ? across : normal;
    rg_real *g = b->domain->igeom;
    for (int k = 0; k < 6; k++) {
        g[rg_igeom_index(i, RG_IGEOM_EDGE + k)] = (rg_real)edge[k / 3][k % 3];
    }
    g[rg_igeom_index(i, RG_IGEOM_PEN_ISO)] = (rg_real)(m->beta_s / h * shear * area);
    g[rg_igeom_index(i, RG_IGEOM_PEN_NORM)] = (rg_real)(m->beta_s / h * (normal - shear) / area);
    if (b->domain->beside != NULL) {
        bool ordered = e->material < e->beside[f];
        b->domain->beside[i][0] = ordered ? e->material : e->beside[f];
        b->domain->beside[i][1] = ordered ? e->beside[f] : e->material;
    }
    return minus;
}

static void count(builder *b, size_t t) {
    for (size_t i = 0; i < tile_elements(b, t); i++) {
        const rg_element *e = &b->element[t][i];
        for (int f = 0; f < RG_FACES; f++) {
            bool here = has_interface(b, e, f), inside = here && in_tile(b, t, e->neighbour[f]);
            b->inside[t] += inside && e->neighbour[f] < e->id;
            b->tile_faces[t] += here && !inside;
        }
    }
}

static size_t whole_blocks(size_t n) {
    return (n + RG_LANES - 1) / RG_LANES;
}

static void place_tiles(builder *b) {
    rg_domain *d = b->domain;
    for (size_t t = 0; t < d->tiles; t++) {
        rg_tile *tile = &d->tile[t];
        tile->ibegin = d->iblocks;
        tile->sbegin = tile->ibegin + whole_blocks(b->inside[t]);
        tile->iend = d->iblocks = tile->sbegin + whole_blocks(b->tile_faces[t]);
        tile->row = d->own_rows;
        d->own_rows += (tile->iend - tile->sbegin) * RG_LANES;
        size_t all = tile->iend - tile->ibegin, tile_faces = tile->iend - tile->sbegin;
        d->tile_iblocks = all > d->tile_iblocks ? all : d->tile_iblocks;
        d->tile_sblocks = tile_faces > d->tile_sblocks ? tile_faces : d->tile_sblocks;
    }
}

static void allocate(rg_domain *d, bool mixed) {
    size_t slots = d->iblocks * RG_LANES;
    d->beside = mixed ? rg_alloc(slots, sizeof *d->beside) : NULL;
    for (int k = 0; k < 2; k++) {
        d->side[k] = RG_NEW(int32_t, slots);
    }
    d->igeom = RG_NEW(rg_real, slots * RG_IGEOM);
    d->counted = RG_NEW(uint8_t, slots);
}

/* An interface inside tile t, seen from its later element `i`, so that both sides are in the cache. */
static void add_inside(const builder *b, size_t t, size_t i, int f, size_t at) {
    rg_domain *d = b->domain;
    const rg_tile *tile = &d->tile[t];
    const rg_element *e = &b->element[t][i];
    size_t first = tile->begin * RG_LANES, own = rg_slot_in(d, tile, e->id);
    size_t other = rg_slot_in(d, tile, e->neighbour[f]);
    int plus = !set_geometry(b, at, e, f), face = e->face[f];
    size_t number = at - tile->ibegin * RG_LANES;
    d->side[plus][at] = rg_side_link(own, f);
    d->side[!plus][at] = rg_side_link(other, face);
    d->counted[at] = 1;
    d->neighbour[rg_link_index(first + own, f)] = rg_neighbour_link(other, face);
    d->neighbour[rg_link_index(first + other, face)] = rg_neighbour_link(own, f);
    d->interface[rg_link_index(first + own, f)] = rg_link(number, plus, 4);
    d->interface[rg_link_index(first + other, face)] = rg_link(number, !plus, 4);
}

/* A tile-boundary face of tile t. Its `other` link waits for the rows: until then it holds the side alone. */
static void add_tile_face(const builder *b, size_t t, size_t i, int f, size_t at) {
    rg_domain *d = b->domain;
    const rg_tile *tile = &d->tile[t];
    const rg_element *e = &b->element[t][i];
    size_t own = rg_slot_in(d, tile, e->id), slot = tile->begin * RG_LANES + own;
    int plus = !set_geometry(b, at, e, f);
    d->side[0][at] = rg_side_link(own, f);
    d->side[1][at] = plus;
    d->counted[at] = e->id < e->neighbour[f];
    d->neighbour[rg_link_index(slot, f)] = rg_neighbour_link(at - tile->sbegin * RG_LANES, RG_GHOST);
    d->interface[rg_link_index(slot, f)] = rg_link(at - tile->ibegin * RG_LANES, RG_TILE_FACE + plus, 4);
}

/* A tile-boundary face before it has its place. */
typedef struct {
    rg_gid tile, key; /* the other tile; the face's key, the same on both sides */
    int32_t own;      /* 4 * element of the tile + face */
} tile_face;

/* Tile-boundary faces with one other tile lie side by side and in the same order on both sides, so their rows
 * are read as a stream. */
static int by_tile_and_key(const void *a, const void *b) {
    const tile_face *p = a, *q = b;
    if (p->tile != q->tile) {
        return p->tile < q->tile ? -1 : 1;
    }
    return (p->key > q->key) - (p->key < q->key);
}

static rg_gid face_key(const rg_element *e, int f) {
    rg_gid other = e->neighbour[f];
    return e->id < other ? RG_FACES * e->id + f : RG_FACES * other + e->face[f];
}

static void add_tile_faces(const builder *b, size_t t, const tile_face *list) {
    size_t at = b->domain->tile[t].sbegin * RG_LANES;
    for (size_t k = 0; k < b->tile_faces[t]; k++) {
        add_tile_face(b, t, (size_t)list[k].own / RG_FACES, list[k].own % RG_FACES, at + k);
    }
}

static void fill_tile(const builder *b, size_t t, tile_face *list) {
    const rg_domain *d = b->domain;
    size_t inside = d->tile[t].ibegin * RG_LANES, tile_faces = 0;
    for (size_t i = 0; i < tile_elements(b, t); i++) {
        const rg_element *e = &b->element[t][i];
        for (int f = 0; f < RG_FACES; f++) {
            rg_gid other = e->neighbour[f];
            if (!has_interface(b, e, f)) {
                continue;
            }
            if (!in_tile(b, t, other)) {
                list[tile_faces++] =
                    (tile_face){other / d->tile_elements, face_key(e, f), rg_side_link(i, f)};
            } else if (other < e->id) {
                add_inside(b, t, i, f, inside++);
            }
        }
    }
    qsort(list, tile_faces, sizeof *list, by_tile_and_key);
    add_tile_faces(b, t, list);
}

static void fill_tiles(const builder *b) {
    const rg_domain *d = b->domain;
#pragma omp parallel
    {
        tile_face *list = RG_NEW(tile_face, d->tile_sblocks * RG_LANES);
#pragma omp for schedule(static)
        for (size_t t = 0; t < d->tiles; t++) {
            fill_tile(b, t, list);
        }
        rg_free(list);
    }
}

/* Row of tile-boundary face i of the domain, which lies in tile t. */
static size_t row_of(const rg_tile *tile, size_t i) {
    return tile->row + (i - tile->sbegin * RG_LANES);
}

/* Row of the tile-boundary face at face f of element e, in an own tile. */
static size_t find_row(const rg_domain *d, const rg_tile *tile, rg_gid e, int f) {
    size_t slot = tile->begin * RG_LANES + rg_slot_in(d, tile, e);
    return tile->row + (size_t)d->neighbour[rg_link_index(slot, f)] / 8;
}

static const rg_element *tile_face_element(const builder *b, size_t t, size_t i) {
    const rg_tile *tile = &b->domain->tile[t];
    rg_gid id = b->domain->id[tile->begin * RG_LANES + (size_t)b->domain->side[0][i] / RG_FACES];
    return &b->element[t][id - tile->first];
}

static void join_tile(const builder *b, size_t t, const rg_gid_map *number) {
    rg_domain *d = b->domain;
    const rg_tile *tile = &d->tile[t];
    size_t first = tile->sbegin * RG_LANES;
    for (size_t i = first; i < tile->iend * RG_LANES; i++) {
        size_t row = row_of(tile, i); /* padding: its own */
        if (i < first + b->tile_faces[t]) {
            const rg_element *e = tile_face_element(b, t, i);
            int f = d->side[0][i] % RG_FACES;
            if (e->owner[f] != b->rank) {
                continue;
            }
            rg_lid other = rg_gid_map_get(number, e->neighbour[f] / d->tile_elements);
            row = find_row(d, &d->tile[other], e->neighbour[f], e->face[f]);
        }
        d->side[1][i] += 2 * (int32_t)row;
    }
}

/* Tile-boundary faces between own tiles find each other's rows. */
static void join_own(const builder *b) {
    rg_domain *d = b->domain;
    rg_gid_map number = rg_gid_map_make(d->tiles);
    for (size_t t = 0; t < d->tiles; t++) {
        rg_gid_map_put(&number, d->tile[t].first / d->tile_elements, (rg_lid)t);
    }
#pragma omp parallel for schedule(static)
    for (size_t t = 0; t < d->tiles; t++) {
        join_tile(b, t, &number);
    }
    rg_gid_map_free(&number);
}

static int by_rank_and_tiles(const void *a, const void *b) {
    const rg_shared_face *p = a, *q = b;
    const rg_gid left[4] = {p->rank, p->tile[0], p->tile[1], p->key};
    const rg_gid right[4] = {q->rank, q->tile[0], q->tile[1], q->key};
    for (int k = 0; k < 4; k++) {
        if (left[k] != right[k]) {
            return left[k] < right[k] ? -1 : 1;
        }
    }
    return 0;
}

static size_t collect_shared(const builder *b, rg_shared_face *list) {
    const rg_domain *d = b->domain;
    size_t n = 0;
    for (size_t t = 0; t < d->boundary_tiles; t++) {
        size_t first = d->tile[t].sbegin * RG_LANES;
        for (size_t i = first; i < first + b->tile_faces[t]; i++) {
            const rg_element *e = tile_face_element(b, t, i);
            int f = d->side[0][i] % RG_FACES;
            if (e->owner[f] == b->rank) {
                continue;
            }
            if (list != NULL) {
                rg_gid here = e->id / d->tile_elements, there = e->neighbour[f] / d->tile_elements;
                list[n] = (rg_shared_face){.rank = e->owner[f],
                                           .tile = {here < there ? here : there, here < there ? there : here},
                                           .key = face_key(e, f),
                                           .tile_face = i};
            }
            n++;
        }
    }
    return n;
}

static const rg_tile *tile_of_tile_face(const rg_domain *d, size_t i) {
    size_t low = 0, high = d->boundary_tiles;
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        *(d->tile[middle].ibegin * RG_LANES <= i ? &low : &high) = middle;
    }
    return &d->tile[low];
}

/* Tile-boundary faces shared with other ranks: their rows arrive behind the own ones, in the order of rank,
 * tiles and key, which is that in which a tile reads them. */
static void join_shared(const builder *b) {
    rg_domain *d = b->domain;
    d->shared = collect_shared(b, NULL);
    d->shared_face = RG_NEW(rg_shared_face, d->shared + 1);
    collect_shared(b, d->shared_face);
    qsort(d->shared_face, d->shared, sizeof *d->shared_face, by_rank_and_tiles);
    for (size_t k = 0; k < d->shared; k++) {
        size_t i = d->shared_face[k].tile_face;
        d->side[1][i] += 2 * (int32_t)(d->own_rows + k);
        d->shared_face[k].tile_face = row_of(tile_of_tile_face(d, i), i);
    }
}

void rg_interfaces_build(rg_domain *d, const rg_element *const element[], const rg_turn *turn,
                         const uint8_t *joined, int rank, const rg_interface_material *m) {
    builder b = {d, element, turn, joined, rank, m, RG_NEW(size_t, d->tiles), RG_NEW(size_t, d->tiles)};
#pragma omp parallel for schedule(static)
    for (size_t t = 0; t < d->tiles; t++) {
        count(&b, t);
    }
    place_tiles(&b);
    allocate(d, m->materials > 1);
    fill_tiles(&b);
    join_own(&b);
    join_shared(&b);
    for (size_t i = 0; i < d->iblocks * RG_LANES; i++) {
        d->interfaces += d->counted[i];
    }
    rg_free(b.inside);
    rg_free(b.tile_faces);
}
