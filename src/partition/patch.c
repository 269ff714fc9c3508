#include "partition/patch.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/vector.h"
#include "mesh/gid_map.h"
#include "partition/material.h"

enum {
    CORE = 1000, /* elements around the worst one before others join: on a regular mesh no element is worse
                  * than another, and the vector of the largest frequency spreads */
    NEXT = 64,   /* worst elements that join then */
    SEEDS = 256, /* all that join, as far as there is room */
    RINGS = 4    /* of elements around those that have joined, each time */
};

/* ---- The worst elements ---- */

typedef struct {
    double rank;
    rg_gid id;
} candidate;

typedef struct {
    int count;
    candidate worst[SEEDS]; /* in order */
} candidates;

static double face_area_squared(const rg_element *e, int f) {
    const double *a = e->x[f == 0];
    double u[3], v[3], n[3];
    rg_vector_subtract(e->x[f < 2 ? 2 : 1], a, u);
    rg_vector_subtract(e->x[f == 3 ? 2 : 3], a, v);
    rg_vector_cross(u, v, n);
    return 0.25 * rg_vector_dot(n, n);
}

/* Modulus and density of material `m` over those of the first one: exactly 1 where there is but one. */
static double modulus(const rg_material *material, int m) {
    return rg_material_modulus(&material[m]) / rg_material_modulus(material);
}

static double density(const rg_material *material, int m) {
    return material[m].density / material->density;
}

double rg_patch_rank(const rg_element *e, const rg_material *material) {
    double sum = 0, stiff = modulus(material, e->material), heavy = density(material, e->material);
    for (int f = 0; f < 4; f++) {
        if (e->neighbour[f] >= 0) {
            double v = e->volume, other = e->other_volume[f];
            double mean = 0.5 * (stiff + modulus(material, e->beside[f]));
            double mass = heavy * v, other_mass = density(material, e->beside[f]) * other;
            sum += face_area_squared(e, f) / fmin(v, other) * mean * (1 / mass + 1 / other_mass);
        }
    }
    return sum;
}

static bool worse(candidate a, candidate b) {
    return a.rank > b.rank || (a.rank >= b.rank && a.id < b.id);
}

static void offer(candidates *all, candidate new) {
    if (all->count == SEEDS && !worse(new, all->worst[SEEDS - 1])) {
        return;
    }
    int at = all->count < SEEDS ? all->count++ : SEEDS - 1;
    for (; at > 0 && worse(new, all->worst[at - 1]); at--) {
        all->worst[at] = all->worst[at - 1];
    }
    all->worst[at] = new;
}

static void merge(candidates *all, const candidates *more) {
    for (int i = 0; i < more->count; i++) {
        offer(all, more->worst[i]);
    }
}

static candidates worst_elements(const rg_part *part, const rg_material *material, MPI_Comm comm) {
    candidates here = {0}, all = {0};
#pragma omp parallel
    {
        candidates mine = {0};
#pragma omp for schedule(static)
        for (rg_lid i = 0; i < part->elements; i++) {
            const rg_element *e = &part->element[i];
            offer(&mine, (candidate){rg_patch_rank(e, material), e->id});
        }
#pragma omp critical
        merge(&here, &mine);
    }
    int ranks;
    MPI_Comm_size(comm, &ranks);
    candidates *each = RG_NEW(candidates, (size_t)ranks);
    MPI_Allgather(&here, sizeof here, MPI_BYTE, each, sizeof here, MPI_BYTE, comm);
    for (int r = 0; r < ranks; r++) {
        merge(&all, &each[r]);
    }
    rg_free(each);
    return all;
}

/* ---- Growth ---- */

enum { SIEVE = 1 << 16 };

/* Element numbers, the same on all ranks. */
typedef struct {
    rg_gid_map member;
    size_t count;
    uint8_t sieve[SIEVE /
                  8]; /* bit k set if some member is k modulo SIEVE: settles most questions in the cache */
} set;

static void join(set *s, rg_gid id) {
    if (s->count < RG_PATCH_MOST && rg_gid_map_get(&s->member, id) < 0) {
        rg_gid_map_put(&s->member, id, (rg_lid)s->count++);
        s->sieve[id % SIEVE / 8] |= (uint8_t)(1 << id % 8);
    }
}

static bool contains(const set *s, rg_gid id) {
    return id >= 0 && (s->sieve[id % SIEVE / 8] >> id % 8 & 1) != 0 && rg_gid_map_get(&s->member, id) >= 0;
}

static bool beside(const set *s, const rg_element *e) {
    return (contains(s, e->neighbour[0]) || contains(s, e->neighbour[1]) || contains(s, e->neighbour[2]) ||
            contains(s, e->neighbour[3])) &&
           !contains(s, e->id);
}

static int by_number(const void *a, const void *b) {
    const rg_gid *p = a, *q = b;
    return (*p > *q) - (*p < *q);
}

/* Where each rank's share of an array begins, from their sizes; start[ranks] is the size of all. */
static int *share_starts(int mine, int *size, int ranks, MPI_Comm comm) {
    int *start = RG_NEW(int, (size_t)ranks + 1);
    MPI_Allgather(&mine, 1, MPI_INT, size, 1, MPI_INT, comm);
    for (int r = 0; r < ranks; r++) {
        start[r + 1] = start[r] + size[r];
    }
    return start;
}

/* A ring: at most four new elements beside each member; the lowest numbers join if there is no room for all.
 */
static void grow(set *s, const rg_part *part, int ranks, MPI_Comm comm) {
    rg_gid *mine = RG_NEW(rg_gid, 4 * RG_PATCH_MOST);
    int count = 0;
#pragma omp parallel for schedule(static)
    for (rg_lid i = 0; i < part->elements; i++) {
        if (beside(s, &part->element[i])) {
            int at;
#pragma omp atomic capture
            at = count++;
            mine[at] = part->element[i].id;
        }
    }
    int *size = RG_NEW(int, (size_t)ranks), *start = share_starts(count, size, ranks, comm);
    rg_gid *all = RG_NEW(rg_gid, (size_t)start[ranks] + 1);
    MPI_Allgatherv(mine, count, MPI_INT64_T, all, size, start, MPI_INT64_T, comm);
    qsort(all, (size_t)start[ranks], sizeof *all, by_number);
    for (int i = 0; i < start[ranks]; i++) {
        join(s, all[i]);
    }
    rg_free(all);
    rg_free(start);
    rg_free(size);
    rg_free(mine);
}

static void join_next(set *s, const candidates *seeds, int most, const rg_part *part, int ranks,
                      MPI_Comm comm) {
    for (int i = 0; i < most && i < seeds->count; i++) {
        join(s, seeds->worst[i].id);
    }
    for (int r = 0; r < RINGS && s->count < RG_PATCH_MOST; r++) {
        grow(s, part, ranks, comm);
    }
}

static set choose(const rg_part *part, const rg_material *material, int ranks, MPI_Comm comm) {
    candidates seeds = worst_elements(part, material, comm);
    set s = {.member = rg_gid_map_make(RG_PATCH_MOST)};
    join(&s, seeds.worst[0].id);
    for (size_t before = 0; s.count < CORE && s.count > before;) {
        before = s.count;
        grow(&s, part, ranks, comm);
    }
    join_next(&s, &seeds, NEXT, part, ranks, comm);
    join_next(&s, &seeds, SEEDS, part, ranks, comm);
    return s;
}

/* ---- The part ---- */

static int by_id(const void *a, const void *b) {
    const rg_element *p = a, *q = b;
    return by_number(&p->id, &q->id);
}

/* `count` records of `bytes` of each rank on rank 0, in the order of the ranks; returns their number, 0
 * elsewhere. */
static rg_lid collect(const void *mine, int count, size_t bytes, void *out, int ranks, MPI_Comm comm) {
    int own = count * (int)bytes, *size = RG_NEW(int, (size_t)ranks);
    int *start = share_starts(own, size, ranks, comm);
    MPI_Gatherv(mine, own, MPI_BYTE, out, size, start, MPI_BYTE, 0, comm);
    count = start[ranks] / (int)bytes;
    rg_free(start);
    rg_free(size);
    return count;
}

/* Elements of the set, likewise, with their axes. */
static rg_lid collect_elements(const rg_part *part, const set *s, rg_part *patch, int ranks, MPI_Comm comm) {
    rg_element *mine = RG_NEW(rg_element, RG_PATCH_MOST);
    rg_turn *turn = RG_NEW(rg_turn, part->turn == NULL ? 1 : RG_PATCH_MOST);
    int count = 0;
    for (rg_lid i = 0; i < part->elements; i++) {
        if (contains(s, part->element[i].id)) {
            mine[count] = part->element[i];
            if (part->turn != NULL) {
                turn[count] = part->turn[i];
            }
            count++;
        }
    }
    rg_lid all = collect(mine, count, sizeof *mine, patch->element, ranks, comm);
    if (part->turn != NULL) {
        patch->turn = RG_NEW(rg_turn, RG_PATCH_MOST);
        collect(turn, count, sizeof *turn, patch->turn, ranks, comm);
    }
    rg_free(mine);
    rg_free(turn);
    return all;
}

static int turn_by_id(const void *a, const void *b) {
    const rg_turn *p = a, *q = b;
    return by_number(&p->id, &q->id);
}

/* Number in the patch of an element of the mesh; -1 if it is not there. */
static rg_gid number_in(const rg_part *patch, rg_gid original) {
    const rg_gid *found = original < 0 ? NULL
                                       : bsearch(&original, patch->original, (size_t)patch->elements,
                                                 sizeof original, by_number);
    return found == NULL ? -1 : found - patch->original;
}

/* Numbers an element anew. Faces to elements that are not there become surface, of the set RG_PATCH_CUT. */
static void renumber(const rg_part *patch, rg_element *e) {
    e->id = number_in(patch, e->id);
    for (int f = 0; f < 4; f++) {
        rg_gid other = number_in(patch, e->neighbour[f]);
        e->set[f] = e->neighbour[f] >= 0 && other < 0 ? RG_PATCH_CUT : -1;
        e->owner[f] = other < 0 ? -1 : 0;
        e->face[f] = other < 0 ? (int8_t)-1 : e->face[f];
        e->neighbour[f] = other;
    }
}

/* The elements lie in the order of the curve; so do their new numbers. */
static void make_tiles(rg_part *patch) {
    patch->tile = rg_tile_elements(patch->total, RG_TILE);
    patch->tiles = (rg_lid)((patch->total + patch->tile - 1) / patch->tile);
    patch->tile_id = RG_NEW(rg_gid, (size_t)patch->tiles);
    for (rg_lid t = 0; t < patch->tiles; t++) {
        patch->tile_id[t] = t;
    }
}

static void finish(rg_part *patch) {
    patch->original = RG_NEW(rg_gid, (size_t)patch->elements);
    qsort(patch->element, (size_t)patch->elements, sizeof *patch->element, by_id);
    if (patch->turn != NULL) {
        qsort(patch->turn, (size_t)patch->elements, sizeof *patch->turn, turn_by_id);
    }
    for (rg_lid i = 0; i < patch->elements; i++) {
        patch->original[i] = patch->element[i].id;
    }
    for (rg_lid i = 0; i < patch->elements; i++) {
        renumber(patch, &patch->element[i]);
    }
    make_tiles(patch);
}

static rg_gid count_interfaces(const rg_part *part) {
    rg_gid sides = 0;
    for (rg_lid i = 0; i < part->elements; i++) {
        for (int f = 0; f < 4; f++) {
            sides += part->element[i].neighbour[f] >= 0;
        }
    }
    return sides / 2;
}

static set everything(rg_gid total) {
    set s = {.member = rg_gid_map_make(RG_PATCH_MOST)};
    for (rg_gid id = 0; id < total; id++) {
        join(&s, id);
    }
    return s;
}

rg_part *rg_patch_gather(const rg_part *part, const rg_material *material, MPI_Comm comm) {
    int rank, ranks;
    MPI_Comm_rank(comm, &rank);
    MPI_Comm_size(comm, &ranks);
    set s = part->total > RG_PATCH_MOST ? choose(part, material, ranks, comm) : everything(part->total);
    rg_part *patch = RG_NEW(rg_part, 1);
    patch->element = RG_NEW(rg_element, rank == 0 ? RG_PATCH_MOST : 1);
    patch->elements = collect_elements(part, &s, patch, ranks, comm);
    patch->total = patch->elements;
    memcpy(patch->box, part->box, sizeof patch->box);
    if (rank == 0) {
        finish(patch);
        patch->interfaces = count_interfaces(patch);
    } else {
        rg_part_free(patch);
        patch = NULL;
    }
    rg_gid_map_free(&s.member);
    return patch;
}
