#include "partition/distribution.h"

#include <stdbool.h>

#include "base/error.h"
#include "base/mem.h"

static const rg_gid most_elements = 1 << 29; /* on a rank: links must fit 32 bits, see layout.h */

static bool shares_face(const rg_tile_graph *g, const int32_t *owner, int64_t t) {
    for (int64_t i = g->start[t]; i < g->start[t + 1]; i++) {
        if (owner[g->neighbour[i]] != owner[t]) {
            return true;
        }
    }
    return false;
}

/* Lists each rank's tiles, those that share a face with another rank first. */
static void order(rg_distribution *d, const rg_tile_graph *g) {
    bool *outer = RG_NEW(bool, (size_t)d->tiles);
    for (int64_t t = 0; t < d->tiles; t++) {
        outer[t] = shares_face(g, d->owner, t);
        d->shared[d->owner[t]] += outer[t];
        d->start[d->owner[t] + 1]++;
    }
    int64_t *next = RG_NEW(int64_t, 2 * (size_t)d->ranks);
    for (int r = 0; r < d->ranks; r++) {
        if (d->start[r + 1] > most_elements / d->tile) {
            rg_fatal(RG_USAGE, "mesh: %lld elements on one rank, at most %lld are possible: use more ranks",
                     (long long)(d->start[r + 1] * d->tile), (long long)most_elements);
        }
        d->start[r + 1] += d->start[r];
        next[2 * r] = d->start[r];
        next[2 * r + 1] = d->start[r] + d->shared[r];
    }
    for (int64_t t = 0; t < d->tiles; t++) {
        d->list[next[2 * d->owner[t] + !outer[t]]++] = t;
    }
    rg_free(next);
    rg_free(outer);
}

rg_distribution *rg_distribution_make(const rg_tile_graph *g, int32_t *owner, int ranks) {
    rg_distribution *d = RG_NEW(rg_distribution, 1);
    *d = (rg_distribution){.ranks = ranks,
                           .elements = g->elements,
                           .tile = g->tile,
                           .tiles = g->tiles,
                           .owner = owner,
                           .list = RG_NEW(int64_t, (size_t)g->tiles),
                           .start = RG_NEW(int64_t, (size_t)ranks + 1),
                           .shared = RG_NEW(rg_lid, (size_t)ranks),
                           .quality = rg_tile_graph_quality(g, ranks, owner)};
    order(d, g);
    return d;
}

void rg_distribution_free(rg_distribution *d) {
    if (d != NULL) {
        rg_free(d->owner);
        rg_free(d->list);
        rg_free(d->start);
        rg_free(d->shared);
        rg_free(d);
    }
}

static void share_counts(const rg_distribution *d, rg_part *own, MPI_Comm comm) {
    int rank;
    MPI_Comm_rank(comm, &rank);
    if (rank == 0) {
        own->total = d->elements;
        own->tile = d->tile;
        own->quality = d->quality;
    }
    MPI_Bcast(&own->total, 1, MPI_INT64_T, 0, comm);
    MPI_Bcast(&own->tile, 1, MPI_INT, 0, comm);
    MPI_Bcast(&own->quality, sizeof own->quality, MPI_BYTE, 0, comm);
}

void rg_distribution_share(const rg_distribution *d, rg_part *own, MPI_Comm comm) {
    rg_lid *count = NULL, mine[2];
    int *size = NULL, *at = NULL;
    if (d != NULL) {
        count = RG_NEW(rg_lid, 2 * (size_t)d->ranks);
        size = RG_NEW(int, (size_t)d->ranks);
        at = RG_NEW(int, (size_t)d->ranks);
        for (int r = 0; r < d->ranks; r++) {
            at[r] = (int)d->start[r];
            size[r] = (int)(d->start[r + 1] - d->start[r]);
            count[2 * r] = size[r];
            count[2 * r + 1] = d->shared[r];
        }
    }
    share_counts(d, own, comm);
    MPI_Scatter(count, 2, MPI_INT32_T, mine, 2, MPI_INT32_T, 0, comm);
    own->tiles = mine[0];
    own->boundary = mine[1];
    own->tile_id = RG_NEW(rg_gid, (size_t)own->tiles);
    MPI_Scatterv(d != NULL ? d->list : NULL, size, at, MPI_INT64_T, own->tile_id, own->tiles, MPI_INT64_T, 0,
                 comm);
    rg_free(count);
    rg_free(size);
    rg_free(at);
    for (rg_lid t = 0; t < own->tiles; t++) {
        own->elements += rg_tile_size(own, own->tile_id[t]);
    }
    own->element = RG_NEW(rg_element, (size_t)own->elements);
}
