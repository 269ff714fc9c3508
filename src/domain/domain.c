#include "domain/domain.h"

#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "base/stiffness.h"
#include "base/vector.h"
#include "domain/interfaces.h"
#include "layout.h"

/* grad l_k from the corners: rows of the inverse of the matrix with columns x_k - x_3. */
static void gradients(const double x[4][3], double grad[3][3]) {
    double e[3][3], n[3];
    for (int k = 0; k < 3; k++) {
        rg_vector_subtract(x[k], x[3], e[k]);
    }
    for (int k = 0; k < 3; k++) {
        rg_vector_cross(e[(k + 1) % 3], e[(k + 2) % 3], n);
        double det = rg_vector_dot(n, e[k]);
        for (int c = 0; c < 3; c++) {
            grad[k][c] = n[c] / det;
        }
    }
}

/* The element in `slot`, which in its tile is the slot `at`. */
static void set_element(rg_domain *d, size_t slot, size_t at, const rg_element *e) {
    double grad[3][3];
    gradients(e->x, grad);
    for (int k = 0; k < 9; k++) {
        d->geom[rg_geom_index(slot, RG_GEOM_GRAD + k)] = (rg_real)grad[k / 3][k % 3];
    }
    d->geom[rg_geom_index(slot, RG_GEOM_VOLUME)] = (rg_real)e->volume;
    d->id[slot] = e->id;
    memcpy(d->corner + 12 * slot, e->x, sizeof e->x);
    memcpy(d->set + 4 * slot, e->set, sizeof e->set);
    d->region[slot] = e->region;
    d->across[slot] = e->across;
    for (int f = 0; f < RG_FACES; f++) { /* until interfaces are known */
        d->neighbour[rg_link_index(slot, f)] = rg_neighbour_link(at, f);
        d->interface[rg_link_index(slot, f)] = RG_NO_INTERFACE;
    }
}

/* A harmless element of unit size at rest. */
static void set_padding(rg_domain *d, size_t slot, size_t at) {
    static const rg_element unit = {.id = -1,
                                    .x = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}},
                                    .volume = 1,
                                    .set = {-1, -1, -1, -1},
                                    .region = -1};
    set_element(d, slot, at, &unit);
}

static void set_axes(rg_domain *d, size_t slot, const double angles[3]) {
    double axis[3][3];
    rg_stiffness_axes(angles, axis);
    for (int k = 0; k < RG_TURN; k++) {
        d->turn[rg_turn_index(slot, k)] = (rg_real)axis[k / 3][k % 3];
    }
}

static void allocate_elements(rg_domain *d, bool turned) {
    size_t slots = d->blocks * RG_LANES;
    d->id = RG_NEW(rg_gid, slots);
    d->corner = RG_NEW(double, 12 * slots);
    d->set = RG_NEW(int32_t, 4 * slots);
    d->region = RG_NEW(int32_t, slots);
    d->across = RG_NEW(uint8_t, slots + 1);
    d->material = RG_NEW(uint16_t, d->blocks + 1);
    d->rim = RG_NEW(uint8_t, d->blocks + 1);
    d->geom = RG_NEW(rg_real, d->blocks * RG_GEOM_BLOCK);
    d->turn = turned ? RG_NEW(rg_real, d->blocks * RG_TURN_BLOCK) : NULL;
    d->neighbour = RG_NEW(int32_t, d->blocks * RG_LINK_BLOCK);
    d->interface = RG_NEW(int32_t, d->blocks * RG_LINK_BLOCK);
}

/* Elements of each of so many materials among `count`. */
static void count_materials(const rg_element *element, size_t count, int materials, size_t *of) {
    memset(of, 0, (size_t)materials * sizeof *of);
    for (size_t i = 0; i < count; i++) {
        of[element[i].material]++;
    }
}

static size_t whole_blocks(size_t n) {
    return (n + RG_LANES - 1) / RG_LANES;
}

/* Every tile but the mesh's last one has the same number of elements. */
static void make_tiles(rg_domain *d, const rg_part *part, const rg_element *const element[], int materials) {
    size_t *of = RG_NEW(size_t, (size_t)materials);
    d->tile_elements = part->tile;
    d->tiles = (size_t)part->tiles;
    d->boundary_tiles = (size_t)part->boundary;
    d->tile = RG_NEW(rg_tile, d->tiles);
    for (size_t t = 0; t < d->tiles; t++) {
        size_t begin = d->blocks;
        count_materials(element[t], (size_t)(element[t + 1] - element[t]), materials, of);
        for (int m = 0; m < materials; m++) {
            d->blocks += whole_blocks(of[m]);
        }
        d->tile[t] = (rg_tile){.first = part->tile_id[t] * part->tile, .begin = begin, .end = d->blocks};
        d->tile_blocks = d->blocks - begin > d->tile_blocks ? d->blocks - begin : d->tile_blocks;
    }
    rg_free(of);
}

static void mark_joined(rg_domain *d, size_t slot, uint8_t joined) {
    for (int f = 0; f < RG_FACES; f++) {
        if ((joined >> f & 1) != 0) {
            d->interface[rg_link_index(slot, f)] = RG_JOINED;
        }
    }
}

/* Whether an element of the tile whose `count` elements begin with `first` has a neighbour in another one. */
static bool is_on_rim(const rg_element *e, rg_gid first, size_t count) {
    for (int f = 0; f < RG_FACES; f++) {
        rg_gid other = e->neighbour[f];
        if (other >= 0 && (other < first || other >= first + (rg_gid)count)) {
            return true;
        }
    }
    return false;
}

/* Gives the blocks of tile t their materials, and its elements their places. */
static void place_elements(rg_domain *d, const rg_tile *t, const rg_element *element, size_t count,
                           int materials) {
    size_t *next = RG_NEW(size_t, (size_t)materials), block = 0;
    uint16_t *place = d->place + (size_t)(t - d->tile) * (size_t)d->tile_elements;
    count_materials(element, count, materials, next);
    for (int m = 0; m < materials; m++) {
        size_t end = block + whole_blocks(next[m]);
        next[m] = block * RG_LANES;
        for (; block < end; block++) {
            d->material[t->begin + block] = (uint16_t)m;
        }
    }
    for (int rim = 0; rim < 2; rim++) {
        for (size_t i = 0; i < count; i++) {
            if (is_on_rim(&element[i], t->first, count) == rim) {
                place[i] = (uint16_t)next[element[i].material]++;
                d->rim[t->begin + place[i] / RG_LANES] |= (uint8_t)rim;
            }
        }
    }
    rg_free(next);
}

static void fill_tile(rg_domain *d, const rg_part *part, const rg_element *element, const uint8_t *joined,
                      int materials, size_t t) {
    const rg_tile *tile = &d->tile[t];
    size_t first = tile->begin * RG_LANES, count = (size_t)rg_tile_size(part, part->tile_id[t]);
    size_t slots = (tile->end - tile->begin) * RG_LANES;
    place_elements(d, tile, element, count, materials);
    for (size_t at = 0; at < slots; at++) {
        d->id[first + at] = -1;
        if (d->turn != NULL) {
            set_axes(d, first + at, (const double[3]){0, 0, 0});
        }
    }
    for (size_t i = 0; i < count; i++) {
        size_t at = rg_slot_in(d, tile, element[i].id);
        set_element(d, first + at, at, &element[i]);
        if (d->turn != NULL) {
            set_axes(d, first + at, part->turn[element + i - part->element].own);
        }
        mark_joined(d, first + at, joined == NULL ? 0 : joined[element + i - part->element]);
    }
    for (size_t at = 0; at < slots; at++) {
        if (d->id[first + at] < 0) {
            set_padding(d, first + at, at);
        }
    }
}

rg_domain *rg_domain_build(const rg_part *part, const uint8_t *joined, int rank,
                           const rg_interface_material *m) {
    rg_domain *d = RG_NEW(rg_domain, 1);
    d->elements = (size_t)part->elements;
    const rg_element **element = RG_NEW(const rg_element *, (size_t)part->tiles + 1);
    element[0] = part->element;
    for (rg_lid t = 0; t < part->tiles; t++) {
        element[t + 1] = element[t] + rg_tile_size(part, part->tile_id[t]);
    }
    make_tiles(d, part, element, m->materials);
    allocate_elements(d, part->turn != NULL);
    d->place = RG_NEW(uint16_t, d->tiles * (size_t)part->tile);
#pragma omp parallel for schedule(static)
    for (size_t t = 0; t < d->tiles; t++) {
        fill_tile(d, part, element[t], joined, m->materials, t);
    }
    rg_interfaces_build(d, element, part->turn, joined, rank, m);
    rg_free(element);
    return d;
}

const rg_tile *rg_tile_of(const rg_domain *d, size_t slot) {
    size_t low = 0, high = d->tiles;
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        *(d->tile[middle].begin * RG_LANES <= slot ? &low : &high) = middle;
    }
    return &d->tile[low];
}

double rg_interface_area(const rg_domain *d, size_t i, double normal[3]) {
    double edge[2][3], square = 0;
    for (int k = 0; k < 6; k++) {
        edge[k / 3][k % 3] = d->igeom[rg_igeom_index(i, RG_IGEOM_EDGE + k)];
    }
    for (int c = 0; c < 3; c++) {
        int a = (c + 1) % 3, b = (c + 2) % 3;
        normal[c] = 0.5 * (edge[0][a] * edge[1][b] - edge[0][b] * edge[1][a]);
        square += normal[c] * normal[c];
    }
    return sqrt(square);
}

void rg_domain_free(rg_domain *d) {
    if (d == NULL) {
        return;
    }
    void *blocks[] = {d->region,    d->across,   d->id,    d->corner,  d->set,        d->geom, d->neighbour,
                      d->interface, d->material, d->rim,   d->place,   d->beside,     d->turn, d->tile,
                      d->side[0],   d->side[1],  d->igeom, d->counted, d->shared_face};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
        rg_free(blocks[i]);
    }
    rg_free(d);
}
