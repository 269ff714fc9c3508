#include "domain.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "gid_map.h"
#include "interfaces.h"
#include "layout.h"
#include "mem.h"

static size_t round_up(size_t n) {
    return (n + RG_LANES - 1) / RG_LANES * RG_LANES;
}

/* Slot of the part's element number i: boundary elements, padding, interior elements. */
static size_t slot_of(const rg_part *part, size_t i) {
    size_t boundary = (size_t)part->boundary;
    return i < boundary ? i : round_up(boundary) + (i - boundary);
}

/* The converse, for a slot that is not padding. */
static size_t part_index(const rg_part *part, size_t slot) {
    size_t boundary = (size_t)part->boundary;
    return slot < boundary ? slot : slot - round_up(boundary) + boundary;
}

/* grad l_k from the corners: rows of the inverse of the matrix with columns x_k - x_3. */
static void gradients(const double x[4][3], double grad[3][3]) {
    double e[3][3];
    for (int k = 0; k < 3; k++) {
        for (int c = 0; c < 3; c++) {
            e[k][c] = x[k][c] - x[3][c];
        }
    }
    for (int k = 0; k < 3; k++) {
        const double *a = e[(k + 1) % 3], *b = e[(k + 2) % 3];
        double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
        double det = n[0] * e[k][0] + n[1] * e[k][1] + n[2] * e[k][2];
        for (int c = 0; c < 3; c++) {
            grad[k][c] = n[c] / det;
        }
    }
}

static void set_element(rg_domain *d, size_t slot, const rg_element *e) {
    double grad[3][3];
    gradients(e->x, grad);
    for (int k = 0; k < 9; k++) {
        d->geom[rg_geom_index(slot, RG_GEOM_GRAD + k)] = grad[k / 3][k % 3];
    }
    d->geom[rg_geom_index(slot, RG_GEOM_VOLUME)] = e->volume;
    d->id[slot] = e->id;
    memcpy(d->corner + 12 * slot, e->x, sizeof e->x);
    memcpy(d->set + 4 * slot, e->set, sizeof e->set);
}

/* A harmless element of unit size at rest. */
static void set_padding(rg_domain *d, size_t slot) {
    static const rg_element unit = {
        .id = -1, .x = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}, .volume = 1, .set = {-1, -1, -1, -1}};
    set_element(d, slot, &unit);
}

/* Until interfaces are known every face links to itself and to the zero interface. */
static void clear_links(rg_domain *d, size_t slot) {
    for (int f = 0; f < RG_FACES; f++) {
        d->neighbour[rg_link_index(slot, f)] = rg_link((int32_t)slot, f, RG_FACES);
        d->interface[rg_link_index(slot, f)] = 0;
    }
}

static void make_tiles(rg_domain *d, size_t tile_blocks) {
    size_t start[3] = {0, d->boundary_blocks, d->blocks};
    d->tile = RG_NEW(rg_tile, d->blocks + 2);
    for (int group = 0; group < 2; group++) {
        for (size_t b = start[group]; b < start[group + 1]; b += tile_blocks) {
            size_t end = b + tile_blocks < start[group + 1] ? b + tile_blocks : start[group + 1];
            d->tile[d->tiles++] = (rg_tile){.begin = b, .end = end};
        }
        if (group == 0) {
            d->boundary_tiles = d->tiles;
        }
    }
}

static void allocate_elements(rg_domain *d) {
    size_t slots = d->blocks * RG_LANES;
    d->corner = RG_NEW(double, 12 * slots);
    d->set = RG_NEW(int8_t, 4 * slots);
    d->geom = RG_NEW(double, d->blocks *RG_GEOM_BLOCK);
    d->neighbour = RG_NEW(int32_t, d->blocks * RG_LINK_BLOCK);
    d->interface = RG_NEW(int32_t, d->blocks * RG_LINK_BLOCK);
}

/* Ghosts get their slots in the order of first appearance along the sweep. */
static rg_gid_map find_slots(rg_domain *d, const rg_part *part, int rank) {
    size_t own = (size_t)part->elements, ghosts = 0;
    rg_gid_map map = rg_gid_map_make(own + 4 * (size_t)part->boundary);
    for (size_t i = 0; i < own; i++) {
        rg_gid_map_put(&map, part->element[i].id, (rg_lid)slot_of(part, i));
    }
    size_t first = d->blocks * RG_LANES;
    for (size_t i = 0; i < (size_t)part->boundary; i++) {
        const rg_element *e = &part->element[i];
        for (int f = 0; f < RG_FACES; f++) {
            if (e->neighbour[f] >= 0 && e->owner[f] != rank) {
                rg_lid slot = (rg_lid)(first + ghosts);
                ghosts += rg_gid_map_put(&map, e->neighbour[f], slot) == slot;
            }
        }
    }
    d->ghost_blocks = round_up(ghosts) / RG_LANES;
    return map;
}

static void fill_elements(rg_domain *d, const rg_part *part, const rg_gid_map *map) {
    size_t slots = (d->blocks + d->ghost_blocks) * RG_LANES;
    d->id = RG_NEW(rg_gid, slots);
    for (size_t s = 0; s < slots; s++) {
        d->id[s] = -1;
    }
    for (size_t k = 0; k <= map->mask; k++) {
        if (map->key[k] >= 0) {
            d->id[map->value[k]] = map->key[k];
        }
    }
#pragma omp parallel for schedule(static)
    for (size_t t = 0; t < d->tiles; t++) {
        for (size_t slot = d->tile[t].begin * RG_LANES; slot < d->tile[t].end * RG_LANES; slot++) {
            clear_links(d, slot);
            if (d->id[slot] < 0) {
                set_padding(d, slot);
            } else {
                set_element(d, slot, &part->element[part_index(part, slot)]);
            }
        }
    }
}

rg_domain *rg_domain_build(const rg_part *part, int rank, const rg_interface_material *m,
                           size_t tile_elements) {
    rg_domain *d = RG_NEW(rg_domain, 1);
    if (part->elements > INT32_MAX / 8) {
        rg_fatal(RG_USAGE, "%d elements on one rank are too many for 32-bit links; use more ranks",
                 part->elements);
    }
    d->elements = (size_t)part->elements;
    d->boundary_blocks = round_up((size_t)part->boundary) / RG_LANES;
    d->blocks = d->boundary_blocks + round_up((size_t)(part->elements - part->boundary)) / RG_LANES;
    make_tiles(d, (tile_elements + RG_LANES - 1) / RG_LANES);
    allocate_elements(d);
    rg_gid_map map = find_slots(d, part, rank);
    fill_elements(d, part, &map);
    rg_interfaces_build(d, part, rank, m, &map);
    rg_gid_map_free(&map);
    return d;
}

void rg_domain_free(rg_domain *d) {
    if (d == NULL) {
        return;
    }
    void *blocks[] = {d->id,   d->corner,  d->set,     d->geom,  d->neighbour, d->interface,
                      d->tile, d->side[0], d->side[1], d->igeom, d->counted,   d->shared_face};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
        rg_free(blocks[i]);
    }
    rg_free(d);
}
