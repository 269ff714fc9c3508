/* Distribution: rank 0 orders and packs the elements of each rank in turn and sends them in pieces of bounded
 * size, so that the whole mesh never exists twice. */
#include "mesh.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "hilbert.h"
#include "mem.h"
#include "tet.h"

static const rg_gid piece = (1 << 20) / sizeof(rg_element); /* elements in a message of at most 1 MiB */
static const rg_gid most_elements = 1 << 29; /* on a rank: links must fit 32 bits, see layout.h */

/* Place of an element in the sweep of its rank; sorted by key, then by id. The key is the element's index on
 * the Hilbert curve, with the top bit set unless it shares a face with another rank. */
struct place {
    uint64_t key;
    rg_gid id;
};

static const uint64_t inner_bit = UINT64_C(1) << 63;

/* What rank 0 packs from. */
struct source {
    const rg_mesh *mesh;
    int32_t *part;       /* [elements]: owner */
    double *volume;      /* [elements] m^3, computed once so that all ranks see the same bits */
    struct place *place; /* [elements]: those of rank 0 first, then those of rank 1, ... */
    rg_gid *start;       /* [ranks + 1]: where each rank's places begin */
};

static const double *corner(const rg_mesh *mesh, rg_gid e, int i) {
    return mesh->x + 3 * mesh->corner[4 * e + i];
}

static void find_box(const rg_mesh *mesh, double box[2][3]) {
    for (int i = 0; i < 3; i++) {
        box[0][i] = INFINITY;
        box[1][i] = -INFINITY;
        for (rg_gid v = 0; v < mesh->vertices; v++) {
            box[0][i] = fmin(box[0][i], mesh->x[3 * v + i]);
            box[1][i] = fmax(box[1][i], mesh->x[3 * v + i]);
        }
    }
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

static bool shares_face(const struct source *s, rg_gid e) {
    for (int f = 0; f < 4; f++) {
        rg_gid other = s->mesh->neighbour[4 * e + f];
        if (other >= 0 && s->part[other] != s->part[e]) {
            return true;
        }
    }
    return false;
}

static uint64_t sweep_key(const struct source *s, rg_gid e, const double low[3], double edge) {
    double centroid[3];
    for (int i = 0; i < 3; i++) {
        centroid[i] = 0.25 * ((corner(s->mesh, e, 0)[i] + corner(s->mesh, e, 1)[i]) +
                              (corner(s->mesh, e, 2)[i] + corner(s->mesh, e, 3)[i]));
    }
    return rg_hilbert_point(centroid, low, edge) | (shares_face(s, e) ? 0 : inner_bit);
}

static int by_key(const void *a, const void *b) {
    const struct place *p = a, *q = b;
    if (p->key != q->key) {
        return p->key < q->key ? -1 : 1;
    }
    return (p->id > q->id) - (p->id < q->id);
}

/* start[r] = number of elements of all ranks before r. */
static rg_gid *count_parts(const struct source *s, int ranks) {
    rg_gid *start = RG_NEW(rg_gid, (size_t)ranks + 1);
    for (rg_gid e = 0; e < s->mesh->elements; e++) {
        start[s->part[e] + 1]++;
    }
    for (int r = 0; r < ranks; r++) {
        if (start[r + 1] > most_elements) {
            rg_fatal(RG_USAGE, "mesh: %lld elements on one rank, at most %lld are possible: use more ranks",
                     (long long)start[r + 1], (long long)most_elements);
        }
        start[r + 1] += start[r];
    }
    return start;
}

/* Sorts the elements by rank and along the sweep. The curve runs through the cube around the mesh's box, not
 * through the box stretched to a cube, which would lengthen the ways between neighbours. */
static void order(struct source *s, int ranks, double box[2][3]) {
    double edge = fmax(box[1][0] - box[0][0], fmax(box[1][1] - box[0][1], box[1][2] - box[0][2]));
    s->start = count_parts(s, ranks);
    s->place = RG_NEW(struct place, (size_t)s->mesh->elements);
    rg_gid *next = RG_NEW(rg_gid, (size_t)ranks);
    memcpy(next, s->start, (size_t)ranks * sizeof *next);
    for (rg_gid e = 0; e < s->mesh->elements; e++) {
        s->place[next[s->part[e]]++] = (struct place){sweep_key(s, e, box[0], edge), e};
    }
    rg_free(next);
    for (int r = 0; r < ranks; r++) {
        qsort(s->place + s->start[r], (size_t)(s->start[r + 1] - s->start[r]), sizeof *s->place, by_key);
    }
}

static struct source prepare(const rg_mesh *mesh, int ranks, double box[2][3]) {
    struct source s = {.mesh = mesh, .part = RG_NEW(int32_t, (size_t)mesh->elements)};
    rg_mesh_partition(mesh, ranks, s.part);
    order(&s, ranks, box);
    s.volume = compute_volumes(mesh);
    return s;
}

static void release(struct source *s) {
    rg_free(s->part);
    rg_free(s->volume);
    rg_free(s->place);
    rg_free(s->start);
}

static void pack_element(const struct source *s, rg_gid e, rg_element *out) {
    out->id = e;
    out->volume = s->volume[e];
    for (int f = 0; f < 4; f++) {
        rg_gid other = s->mesh->neighbour[4 * e + f];
        memcpy(out->x[f], corner(s->mesh, e, f), sizeof out->x[f]);
        out->neighbour[f] = other;
        out->other_volume[f] = s->volume[other >= 0 ? other : e];
        out->owner[f] = other >= 0 ? s->part[other] : -1;
        out->face[f] = s->mesh->face[4 * e + f];
        out->set[f] = s->mesh->set[4 * e + f];
    }
}

/* Packs places [begin, end) to `out`. */
static void pack(const struct source *s, rg_gid begin, rg_gid end, rg_element *out) {
    for (rg_gid p = begin; p < end; p++) {
        pack_element(s, s->place[p].id, out + (p - begin));
    }
}

static rg_gid lesser(rg_gid a, rg_gid b) {
    return a < b ? a : b;
}

static void send_parts(const struct source *s, int ranks, MPI_Comm comm) {
    rg_element *buffer = RG_NEW(rg_element, (size_t)piece);
    for (int r = 1; r < ranks; r++) {
        for (rg_gid begin = s->start[r]; begin < s->start[r + 1]; begin += piece) {
            rg_gid end = lesser(begin + piece, s->start[r + 1]);
            pack(s, begin, end, buffer);
            MPI_Send(buffer, (int)((size_t)(end - begin) * sizeof *buffer), MPI_BYTE, r, 0, comm);
        }
    }
    rg_free(buffer);
}

static void receive_part(rg_part *own, MPI_Comm comm) {
    for (rg_gid begin = 0; begin < own->elements; begin += piece) {
        rg_gid count = lesser(piece, own->elements - begin);
        MPI_Recv(own->element + begin, (int)((size_t)count * sizeof *own->element), MPI_BYTE, 0, 0, comm,
                 MPI_STATUS_IGNORE);
    }
}

/* Tells each rank how many elements it gets and how many of them share a face with another rank; `s` on rank
 * 0. */
static void share_counts(const struct source *s, rg_part *own, int rank, int ranks, MPI_Comm comm) {
    int32_t *count = NULL, mine[2];
    if (rank == 0) {
        count = RG_NEW(int32_t, 2 * (size_t)ranks);
        for (int r = 0; r < ranks; r++) {
            rg_gid p = s->start[r];
            while (p < s->start[r + 1] && (s->place[p].key & inner_bit) == 0) {
                p++;
            }
            count[2 * r] = (int32_t)(s->start[r + 1] - s->start[r]);
            count[2 * r + 1] = (int32_t)(p - s->start[r]);
        }
    }
    MPI_Scatter(count, 2, MPI_INT32_T, mine, 2, MPI_INT32_T, 0, comm);
    rg_free(count);
    own->elements = mine[0];
    own->boundary = mine[1];
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

rg_part *rg_part_distribute(const rg_mesh *mesh, MPI_Comm comm) {
    int rank, ranks;
    MPI_Comm_rank(comm, &rank);
    MPI_Comm_size(comm, &ranks);
    rg_part *own = RG_NEW(rg_part, 1);
    struct source s = {0};
    if (rank == 0) {
        own->total = mesh->elements;
        own->interfaces = count_interfaces(mesh);
        own->sets = mesh->sets;
        find_box(mesh, own->box);
        s = prepare(mesh, ranks, own->box);
    }
    MPI_Bcast(&own->total, 1, MPI_INT64_T, 0, comm);
    MPI_Bcast(&own->interfaces, 1, MPI_INT64_T, 0, comm);
    MPI_Bcast(own->box, 6, MPI_DOUBLE, 0, comm);
    share_names(mesh, own, rank, comm);
    share_counts(&s, own, rank, ranks, comm);
    if (rank == 0) {
        send_parts(&s, ranks, comm);
    }
    own->element = RG_NEW(rg_element, (size_t)own->elements);
    if (rank == 0) {
        pack(&s, 0, own->elements, own->element);
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
    rg_free(part->element);
    rg_free(part);
}
