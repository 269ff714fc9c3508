/* Distribution: rank 0 deals out the tiles and sends each rank the elements of its own, tile by tile, so that
 * the whole mesh never exists twice. */
#include "mesh.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "mem.h"
#include "tet.h"

static const rg_gid most_elements = 1 << 29; /* on a rank: links must fit 32 bits, see layout.h */

/* What rank 0 packs from. */
struct source {
    const rg_mesh *mesh;
    int tile;
    rg_gid tiles;
    int32_t *owner; /* [tiles] */
    double *volume; /* [elements] m^3, computed once so that all ranks see the same bits */
    rg_gid *list;  /* [tiles]: those of rank 0 first, then those of rank 1, ... in the order of their sweep */
    rg_gid *start; /* [ranks + 1]: where each rank's tiles begin */
    rg_lid *shared; /* [ranks]: how many of them share a face with another rank */
};

static const double *corner(const rg_mesh *mesh, rg_gid e, int i) {
    return mesh->x + 3 * mesh->corner[4 * e + i];
}

static rg_gid count_interfaces(const rg_mesh *mesh) {
    rg_gid sides = 0;
    for (rg_gid slot = 0; slot < 4 * mesh->elements; slot++) {
        sides += mesh->neighbour[slot] >= 0;
    }
    return sides / 2;
}

static double *compute_volumes(const rg_mesh *mesh) {
    double *volume = RG_NEW(double, (size_t)mesh->elements);
    for (rg_gid e = 0; e < mesh->elements; e++) {
        volume[e] = fabs(
            rg_tet_volume(corner(mesh, e, 0), corner(mesh, e, 1), corner(mesh, e, 2), corner(mesh, e, 3)));
        if (!(volume[e] > 0.0)) {
            rg_fatal(RG_USAGE, "mesh: element %lld has no volume", (long long)e);
        }
    }
    return volume;
}

static rg_gid tile_begin(const struct source *s, rg_gid t) {
    rg_gid begin = t * s->tile;
    return begin < s->mesh->elements ? begin : s->mesh->elements;
}

static bool shares_face(const struct source *s, rg_gid t) {
    for (rg_gid slot = 4 * tile_begin(s, t); slot < 4 * tile_begin(s, t + 1); slot++) {
        rg_gid other = s->mesh->neighbour[slot];
        if (other >= 0 && s->owner[other / s->tile] != s->owner[t]) {
            return true;
        }
    }
    return false;
}

/* Lists each rank's tiles, those that share a face with another rank first. */
static void order(struct source *s, int ranks) {
    s->start = RG_NEW(rg_gid, (size_t)ranks + 1);
    s->shared = RG_NEW(rg_lid, (size_t)ranks);
    s->list = RG_NEW(rg_gid, (size_t)s->tiles);
    bool *outer = RG_NEW(bool, (size_t)s->tiles);
    for (rg_gid t = 0; t < s->tiles; t++) {
        outer[t] = ranks > 1 && shares_face(s, t);
        s->shared[s->owner[t]] += outer[t];
        s->start[s->owner[t] + 1]++;
    }
    rg_gid *next = RG_NEW(rg_gid, 2 * (size_t)ranks);
    for (int r = 0; r < ranks; r++) {
        if (s->start[r + 1] > most_elements / s->tile) {
            rg_fatal(RG_USAGE, "mesh: %lld elements on one rank, at most %lld are possible: use more ranks",
                     (long long)(s->start[r + 1] * s->tile), (long long)most_elements);
        }
        s->start[r + 1] += s->start[r];
        next[2 * r] = s->start[r];
        next[2 * r + 1] = s->start[r] + s->shared[r];
    }
    for (rg_gid t = 0; t < s->tiles; t++) {
        s->list[next[2 * s->owner[t] + !outer[t]]++] = t;
    }
    rg_free(next);
    rg_free(outer);
}

static struct source prepare(const rg_mesh *mesh, int tile, int ranks) {
    struct source s = {.mesh = mesh, .tile = tile, .tiles = (mesh->elements + tile - 1) / tile};
    s.owner = RG_NEW(int32_t, (size_t)s.tiles);
    rg_mesh_partition(mesh, tile, ranks, s.owner);
    order(&s, ranks);
    s.volume = compute_volumes(mesh);
    return s;
}

static void release(struct source *s) {
    rg_free(s->owner);
    rg_free(s->volume);
    rg_free(s->list);
    rg_free(s->start);
    rg_free(s->shared);
}

static void pack_element(const struct source *s, rg_gid e, rg_element *out) {
    out->id = e;
    out->volume = s->volume[e];
    for (int f = 0; f < 4; f++) {
        rg_gid other = s->mesh->neighbour[4 * e + f];
        memcpy(out->x[f], corner(s->mesh, e, f), sizeof out->x[f]);
        out->neighbour[f] = other;
        out->other_volume[f] = s->volume[other >= 0 ? other : e];
        out->owner[f] = other >= 0 ? s->owner[other / s->tile] : -1;
        out->face[f] = s->mesh->face[4 * e + f];
        out->set[f] = s->mesh->set[4 * e + f];
    }
}

/* Packs tile t to `out`; returns its number of elements. */
static rg_lid pack_tile(const struct source *s, rg_gid t, rg_element *out) {
    rg_gid begin = tile_begin(s, t), end = tile_begin(s, t + 1);
    for (rg_gid e = begin; e < end; e++) {
        pack_element(s, e, out + (e - begin));
    }
    return (rg_lid)(end - begin);
}

/* One message a tile: of bounded size, whatever the mesh. */
static void send_parts(const struct source *s, int ranks, MPI_Comm comm) {
    rg_element *buffer = RG_NEW(rg_element, (size_t)s->tile);
    for (rg_gid k = s->start[1]; k < s->start[ranks]; k++) {
        rg_lid count = pack_tile(s, s->list[k], buffer);
        MPI_Send(buffer, (int)((size_t)count * sizeof *buffer), MPI_BYTE, s->owner[s->list[k]], 0, comm);
    }
    rg_free(buffer);
}

static void receive_part(rg_part *own, MPI_Comm comm) {
    rg_element *to = own->element;
    for (rg_lid t = 0; t < own->tiles; t++) {
        rg_lid count = rg_tile_size(own, own->tile_id[t]);
        MPI_Recv(to, (int)((size_t)count * sizeof *to), MPI_BYTE, 0, 0, comm, MPI_STATUS_IGNORE);
        to += count;
    }
}

static void pack_own(const struct source *s, rg_part *own) {
    rg_lid at = 0;
    for (rg_lid t = 0; t < own->tiles; t++) {
        at += pack_tile(s, own->tile_id[t], own->element + at);
    }
}

/* Tells each rank which tiles it gets; `s` on rank 0. */
static void share_tiles(const struct source *s, rg_part *own, int rank, int ranks, MPI_Comm comm) {
    rg_lid *count = NULL, mine[2];
    int *size = NULL, *at = NULL;
    if (rank == 0) {
        count = RG_NEW(rg_lid, 2 * (size_t)ranks);
        size = RG_NEW(int, (size_t)ranks);
        at = RG_NEW(int, (size_t)ranks);
        for (int r = 0; r < ranks; r++) {
            at[r] = (int)s->start[r];
            size[r] = (int)(s->start[r + 1] - s->start[r]);
            count[2 * r] = size[r];
            count[2 * r + 1] = s->shared[r];
        }
    }
    MPI_Scatter(count, 2, MPI_INT32_T, mine, 2, MPI_INT32_T, 0, comm);
    own->tiles = mine[0];
    own->boundary = mine[1];
    own->tile_id = RG_NEW(rg_gid, (size_t)own->tiles);
    MPI_Scatterv(rank == 0 ? s->list : NULL, size, at, MPI_INT64_T, own->tile_id, own->tiles, MPI_INT64_T, 0,
                 comm);
    rg_free(count);
    rg_free(size);
    rg_free(at);
    for (rg_lid t = 0; t < own->tiles; t++) {
        own->elements += rg_tile_size(own, own->tile_id[t]);
    }
}

static void share_names(const rg_mesh *mesh, rg_part *own, int rank, MPI_Comm comm) {
    MPI_Bcast(&own->sets, 1, MPI_INT, 0, comm);
    for (int s = 0; s < own->sets; s++) {
        int length = rank == 0 ? (int)strlen(mesh->set_name[s]) : 0;
        MPI_Bcast(&length, 1, MPI_INT, 0, comm);
        own->set_name[s] = RG_NEW(char, (size_t)length + 1);
        if (rank == 0) {
            memcpy(own->set_name[s], mesh->set_name[s], (size_t)length);
        }
        MPI_Bcast(own->set_name[s], length, MPI_CHAR, 0, comm);
    }
}

rg_part *rg_part_distribute(const rg_mesh *mesh, int tile, MPI_Comm comm) {
    int rank, ranks;
    MPI_Comm_rank(comm, &rank);
    MPI_Comm_size(comm, &ranks);
    rg_part *own = RG_NEW(rg_part, 1);
    struct source s = {0};
    if (rank == 0) {
        own->total = mesh->elements;
        own->interfaces = count_interfaces(mesh);
        own->sets = mesh->sets;
        own->tile = tile;
        rg_mesh_box_around(mesh, own->box);
        s = prepare(mesh, tile, ranks);
    }
    MPI_Bcast(&own->total, 1, MPI_INT64_T, 0, comm);
    MPI_Bcast(&own->interfaces, 1, MPI_INT64_T, 0, comm);
    MPI_Bcast(&own->tile, 1, MPI_INT, 0, comm);
    MPI_Bcast(own->box, 6, MPI_DOUBLE, 0, comm);
    share_names(mesh, own, rank, comm);
    share_tiles(&s, own, rank, ranks, comm);
    if (rank == 0) {
        send_parts(&s, ranks, comm);
    }
    own->element = RG_NEW(rg_element, (size_t)own->elements);
    if (rank == 0) {
        pack_own(&s, own);
        release(&s);
    } else {
        receive_part(own, comm);
    }
    return own;
}

void rg_part_free(rg_part *part) {
    if (part == NULL) {
        return;
    }
    for (int s = 0; s < part->sets; s++) {
        rg_free(part->set_name[s]);
    }
    rg_free(part->tile_id);
    rg_free(part->original);
    rg_free(part->element);
    rg_free(part);
}
