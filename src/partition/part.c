/* Rank 0 distributes the tiles and sends each rank the elements of its own, tile by tile, so that
 * the whole mesh never exists twice. */
#include "mesh/mesh.h"

#include <math.h>
#include <string.h>

#include "base/error.h"
#include "base/mem.h"
#include "base/tet.h"
#include "mesh/apart.h"
#include "partition/distribution.h"

/* What rank 0 packs from. */
struct source {
    const rg_mesh *mesh;
    const rg_distribution *distribution;
    double *volume; /* [elements] m^3, computed once so that all ranks see the same bits */
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
            rg_fatal(RG_USAGE, "mesh: element %lld has no volume", (long long)rg_mesh_original(mesh, e));
        }
    }
    return volume;
}

static void pack_element(const struct source *s, rg_gid e, rg_element *out) {
    out->id = e;
    out->volume = s->volume[e];
    for (int f = 0; f < 4; f++) {
        rg_gid other = s->mesh->neighbour[4 * e + f];
        memcpy(out->x[f], corner(s->mesh, e, f), sizeof out->x[f]);
        out->neighbour[f] = other;
        out->other_volume[f] = s->volume[other >= 0 ? other : e];
        out->owner[f] = other >= 0 ? s->distribution->owner[other / s->distribution->tile] : -1;
        out->face[f] = s->mesh->face[4 * e + f];
        out->set[f] = s->mesh->set[4 * e + f];
    }
    out->region = s->mesh->region != NULL ? s->mesh->region[e] : -1;
    out->part = s->mesh->part != NULL ? s->mesh->part[e] : 0;
}

/* Packs tile t to `out`; returns its number of elements. */
static rg_lid pack_tile(const struct source *s, int64_t t, rg_element *out) {
    rg_gid begin = t * s->distribution->tile, end = begin + s->distribution->tile;
    end = end < s->mesh->elements ? end : s->mesh->elements;
    for (rg_gid e = begin; e < end; e++) {
        pack_element(s, e, out + (e - begin));
    }
    return (rg_lid)(end - begin);
}

/* One message a tile: of bounded size, whatever the mesh. */
static void send_parts(const struct source *s, MPI_Comm comm) {
    const rg_distribution *d = s->distribution;
    rg_element *buffer = RG_NEW(rg_element, (size_t)d->tile);
    for (int64_t k = d->start[1]; k < d->start[d->ranks]; k++) {
        rg_lid count = pack_tile(s, d->list[k], buffer);
        MPI_Send(buffer, (int)((size_t)count * sizeof *buffer), MPI_BYTE, d->owner[d->list[k]], 0, comm);
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

/* The sets that rank 0 has in `from` to all. */
static rg_sets share_sets(const rg_sets *from, int rank, MPI_Comm comm) {
    rg_sets own = rank == 0 ? rg_sets_copy(from) : (rg_sets){.count = 0};
    int32_t count = own.count, combinations = own.combinations;
    MPI_Bcast(&count, 1, MPI_INT32_T, 0, comm);
    for (int32_t s = 0; s < count; s++) {
        int length = rank == 0 ? (int)strlen(own.name[s]) : 0;
        MPI_Bcast(&length, 1, MPI_INT, 0, comm);
        char *name = RG_NEW(char, (size_t)length + 1);
        if (rank == 0) {
            memcpy(name, own.name[s], (size_t)length);
        }
        MPI_Bcast(name, length, MPI_CHAR, 0, comm);
        if (rank > 0) {
            rg_sets_add(&own, name);
        }
        rg_free(name);
    }
    MPI_Bcast(&combinations, 1, MPI_INT32_T, 0, comm);
    for (int32_t c = 0; c < combinations; c++) {
        int32_t members = rank == 0 ? own.start[c + 1] - own.start[c] : 0;
        MPI_Bcast(&members, 1, MPI_INT32_T, 0, comm);
        int32_t *set = RG_NEW(int32_t, (size_t)members);
        if (rank == 0) {
            memcpy(set, own.member + own.start[c], (size_t)members * sizeof *set);
        }
        MPI_Bcast(set, members, MPI_INT32_T, 0, comm);
        if (rank > 0) {
            rg_sets_combine(&own, members, set);
        }
        rg_free(set);
    }
    return own;
}

/* Rank 0's side: packs and sends what the other ranks wait for, and its own part. */
static void hand_out(const rg_mesh *mesh, const rg_distribution *distribution, rg_part *own, MPI_Comm comm) {
    struct source s = {mesh, distribution, compute_volumes(mesh)};
    send_parts(&s, comm);
    pack_own(&s, own);
    rg_free(s.volume);
}

static rg_distribution *distribute_mesh(const rg_mesh *mesh, int tile, double *weight, int ranks) {
    rg_tile_graph *g = rg_tile_graph_make(mesh, tile);
    g->weight = weight;
    int32_t *owner = RG_NEW(int32_t, (size_t)g->tiles);
    rg_tile_graph_partition(g, ranks, owner);
    rg_distribution *distribution = rg_distribution_make(g, owner, ranks);
    rg_tile_graph_free(g);
    return distribution;
}

rg_part *rg_part_distribute_weighted(const rg_mesh *mesh, int tile, double *weight, MPI_Comm comm) {
    int rank, ranks;
    MPI_Comm_rank(comm, &rank);
    MPI_Comm_size(comm, &ranks);
    rg_part *own = RG_NEW(rg_part, 1);
    rg_distribution *distribution = NULL;
    if (rank == 0) {
        own->interfaces = count_interfaces(mesh);
        own->parts = rg_mesh_apart(mesh);
        rg_mesh_box_around(mesh, own->box);
        distribution = distribute_mesh(mesh, tile, weight, ranks);
    }
    rg_distribution_share(distribution, own, comm);
    MPI_Bcast(&own->interfaces, 1, MPI_INT64_T, 0, comm);
    MPI_Bcast(&own->parts, 1, MPI_INT32_T, 0, comm);
    MPI_Bcast(own->box, 6, MPI_DOUBLE, 0, comm);
    own->surface = share_sets(rank == 0 ? &mesh->surface : NULL, rank, comm);
    own->volume = share_sets(rank == 0 ? &mesh->volume : NULL, rank, comm);
    if (rank == 0) {
        hand_out(mesh, distribution, own, comm);
        rg_distribution_free(distribution);
    } else {
        receive_part(own, comm);
    }
    return own;
}

rg_part *rg_part_distribute(const rg_mesh *mesh, int tile, MPI_Comm comm) {
    return rg_part_distribute_weighted(mesh, tile, NULL, comm);
}

void rg_element_centroid(const rg_element *e, double x[3]) {
    for (int k = 0; k < 3; k++) {
        x[k] = 0.25 * ((e->x[0][k] + e->x[1][k]) + (e->x[2][k] + e->x[3][k]));
    }
}

void rg_part_free(rg_part *part) {
    if (part == NULL) {
        return;
    }
    rg_sets_free(&part->surface);
    rg_sets_free(&part->volume);
    rg_free(part->tile_id);
    rg_free(part->original);
    rg_free(part->element);
    rg_free(part->turn);
    rg_free(part);
}
