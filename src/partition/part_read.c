/* A rank's part of the mesh from a mesh file, of which each rank reads its own tiles. */
#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/input_errors.h"
#include "base/hash.h"
#include "base/mem.h"
#include "base/tet.h"
#include "layout.h"
#include "mesh/file.h"
#include "mesh/mesh.h"
#include "partition/distribution.h"
#include "partition/part_check.h"

enum { SLAB = 256 }; /* most tiles at once: what is read beside the part stays small */

typedef struct {
    MPI_Comm comm;
    int rank, ranks;
    rg_mesh_file *file;
    const rg_mesh_header *head;
    rg_input_errors input_errors;
    int32_t *owner;   /* [tiles] of the mesh */
    uint64_t *beside; /* [tiles]: what the graph says of their neighbours, see beside() */
    rg_lid *place;    /* [tiles]: where the elements of an own tile begin */
    rg_part *own;
} reader;

/* ---- who reads what ---- */

/* A face to tile `other`; the sum of these tells the neighbours of a tile, and how many faces it shares with
 * each.
 */
static uint64_t beside(int64_t other) {
    return rg_hash(0, (uint64_t)other);
}

static uint64_t *sum_graph(const rg_tile_graph *g) {
    uint64_t *sum = RG_NEW(uint64_t, (size_t)g->tiles);
    for (int64_t t = 0; t < g->tiles; t++) {
        for (int64_t i = g->start[t]; i < g->start[t + 1]; i++) {
            sum[t] += (uint64_t)g->faces[i] * beside(g->neighbour[i]);
        }
    }
    return sum;
}

/* The stored partition for so many ranks, or else METIS's; that knew of no weights. */
static rg_distribution *distribute(reader *r, double *weight) {
    int ranks = r->ranks;
    rg_mesh_file *f = rg_mesh_file_open(r->input_errors.name);
    rg_tile_graph *g = rg_mesh_file_graph(f);
    r->beside = sum_graph(g);
    int32_t *owner = RG_NEW(int32_t, (size_t)g->tiles);
    g->weight = weight;
    if (weight != NULL || !rg_mesh_file_partition(f, ranks, owner)) {
        rg_tile_graph_partition(g, ranks, owner);
    }
    rg_distribution *distribution = rg_distribution_make(g, owner, ranks);
    rg_tile_graph_free(g);
    rg_mesh_file_close(f);
    return distribution;
}

static void share_owners(reader *r, const rg_distribution *distribution) {
    int64_t tiles = (r->own->total + r->own->tile - 1) / r->own->tile;
    r->owner = RG_NEW(int32_t, (size_t)tiles);
    if (r->rank == 0) {
        memcpy(r->owner, distribution->owner, (size_t)tiles * sizeof *r->owner);
    }
    MPI_Bcast(r->owner, (int)tiles, MPI_INT32_T, 0, r->comm);
    r->beside = r->rank == 0 ? r->beside : RG_NEW(uint64_t, (size_t)tiles);
    MPI_Bcast(r->beside, (int)tiles, MPI_UINT64_T, 0, r->comm);
    r->place = RG_NEW(rg_lid, (size_t)tiles);
    rg_lid at = 0;
    for (rg_lid t = 0; t < r->own->tiles; t++) {
        r->place[r->own->tile_id[t]] = at;
        at += rg_tile_size(r->own, r->own->tile_id[t]);
    }
}

static void take_header(reader *r) {
    const rg_mesh_header *h = r->head;
    r->own->interfaces = h->interfaces;
    r->own->parts = h->parts;
    memcpy(r->own->box, h->box, sizeof h->box);
    r->own->surface = rg_sets_copy(&h->surface);
    r->own->volume = rg_sets_copy(&h->volume);
}

/* ---- elements ---- */

static void unpack(const reader *r, const rg_mesh_slab *s, rg_gid i, rg_element *e) {
    e->id = s->first + i;
    e->region = s->region[i];
    e->part = s->part != NULL ? s->part[i] : 0;
    for (int f = 0; f < 4; f++) {
        rg_gid other = s->neighbour[4 * i + f];
        memcpy(e->x[f], s->x + 3 * s->at[4 * i + f], sizeof e->x[f]);
        e->neighbour[f] = other;
        e->owner[f] = other >= 0 ? r->owner[other / r->own->tile] : -1;
        e->face[f] = s->face[4 * i + f];
        e->set[f] = s->set[4 * i + f];
    }
    e->volume = fabs(rg_tet_volume(e->x[0], e->x[1], e->x[2], e->x[3]));
}

static rg_element *element_at(const reader *r, rg_gid id) {
    return r->own->element + r->place[id / r->own->tile] + id % r->own->tile;
}

static void read_slab(reader *r, int64_t begin, int64_t end) {
    rg_mesh_slab *s = rg_mesh_file_slab(r->file, begin, end, &r->input_errors);
    rg_gid elements = s != NULL ? s->elements : 0;
#pragma omp parallel for schedule(static)
    for (rg_gid i = 0; i < elements; i++) {
        unpack(r, s, i, element_at(r, s->first + i));
    }
    rg_mesh_slab_free(s);
}

/* Runs of consecutive tiles are read at once. */
static void read_tiles(reader *r) {
    for (int64_t begin = 0, end; begin < r->head->tiles; begin = end) {
        end = begin;
        while (end < r->head->tiles && end - begin < SLAB && r->owner[end] == r->rank) {
            end++;
        }
        if (end > begin) {
            read_slab(r, begin, end);
        } else {
            end++;
        }
    }
}

/* ---- neighbours: each side of a face claims the other ---- */

/* What one side says. A side is 4 * element + face. */
typedef struct {
    int64_t side, other;
    uint64_t place; /* of the face */
    double volume;  /* of the element */
    int32_t set;    /* group of the face */
    int32_t part;   /* of the element */
} claim;

/* Where face f is, its corners in their order. */
static uint64_t place_of(const rg_element *e, int f) {
    uint64_t h = 0;
    for (int k = 0; k < 9; k++) {
        h = rg_hash_double(h, e->x[rg_face_node[f][k / 3]][k % 3]);
    }
    return h;
}

static claim claim_of(const rg_element *e, int f) {
    return (claim){4 * e->id + f, 4 * e->neighbour[f] + e->face[f], place_of(e, f), e->volume, e->set[f],
                   e->part};
}

/* Takes a claim upon face c->other of own element e, if e says the same of that face. */
static bool accept(rg_element *e, const claim *c) {
    int f = (int)(c->other % 4);
    bool same = c->side != c->other && e->neighbour[f] == c->side / 4 && e->face[f] == c->side % 4 &&
                place_of(e, f) == c->place && e->set[f] == c->set && e->part == c->part;
    if (same) {
        e->other_volume[f] = c->volume;
    }
    return same;
}

/* Pairs of elements that do not agree, lower one first. Both owners know of a pair; the lower one's tells. */
typedef struct {
    rg_gid (*pair)[2];
    size_t count, room;
} quarrels;

static void quarrel(quarrels *q, rg_gid a, rg_gid b) {
    q->pair = rg_grow(q->pair, &q->room, q->count, sizeof *q->pair);
    q->pair[q->count][0] = a < b ? a : b;
    q->pair[q->count++][1] = a < b ? b : a;
}

static int by_elements(const void *a, const void *b) {
    const rg_gid *p = a, *q = b;
    int i = p[0] == q[0];
    return (p[i] > q[i]) - (p[i] < q[i]);
}

static void tell_quarrels(reader *r, quarrels *q) {
    if (q->count > 0) {
        qsort(q->pair, q->count, sizeof *q->pair, by_elements);
    }
    for (size_t i = 0; i < q->count; i++) {
        const rg_gid *pair = q->pair[i];
        bool first = i == 0 || by_elements(pair - 2, pair) != 0;
        char *words = first ? rg_input_errors_place(&r->input_errors, pair[0], pair[1]) : NULL;
        if (words != NULL) {
            snprintf(words, RG_INPUT_ERROR_WORDS,
                     "neighbour: elements %" PRId64 " and %" PRId64 " do not agree that they share a face",
                     rg_mesh_file_original(r->file, pair[0]), rg_mesh_file_original(r->file, pair[1]));
        }
    }
    rg_free(q->pair);
}

/* Faces to own elements and the surface. A volume of 0 is left where nobody claims the face. */
static void fill_inside(const reader *r) {
#pragma omp parallel for schedule(static)
    for (int64_t slot = 0; slot < 4 * (int64_t)r->own->elements; slot++) {
        rg_element *e = &r->own->element[slot / 4];
        int f = (int)(slot % 4);
        if (e->neighbour[f] < 0) {
            e->other_volume[f] = e->volume;
        } else if (e->owner[f] == r->rank) {
            claim c = claim_of(element_at(r, e->neighbour[f]), e->face[f]);
            if (c.other == 4 * e->id + f) {
                accept(e, &c);
            }
        }
    }
}

/* The claims upon elements of other ranks, by rank: count[ranks] of them. */
static claim *list_claims(const reader *r, int *count, int *at) {
    const rg_part *own = r->own;
    for (int64_t slot = 0; slot < 4 * (int64_t)own->elements; slot++) {
        int32_t owner = own->element[slot / 4].owner[slot % 4];
        if (owner >= 0 && owner != r->rank) {
            count[owner]++;
        }
    }
    for (int k = 0; k < r->ranks; k++) {
        at[k + 1] = at[k] + count[k];
    }
    claim *list = RG_NEW(claim, (size_t)at[r->ranks] + 1);
    int *next = RG_NEW(int, (size_t)r->ranks);
    memcpy(next, at, (size_t)r->ranks * sizeof *next);
    for (int64_t slot = 0; slot < 4 * (int64_t)own->elements; slot++) {
        const rg_element *e = &own->element[slot / 4];
        int f = (int)(slot % 4);
        if (e->owner[f] >= 0 && e->owner[f] != r->rank) {
            list[next[e->owner[f]]++] = claim_of(e, f);
        }
    }
    rg_free(next);
    return list;
}

/* Sends the claims on their way and takes those of other ranks. */
static void fill_borders(const reader *r, quarrels *q) {
    size_t ranks = (size_t)r->ranks;
    int *count = RG_NEW(int, ranks), *at = RG_NEW(int, ranks + 1);
    int *theirs = RG_NEW(int, ranks), *from = RG_NEW(int, ranks + 1);
    claim *out = list_claims(r, count, at);
    MPI_Alltoall(count, 1, MPI_INT, theirs, 1, MPI_INT, r->comm);
    for (size_t k = 0; k < ranks; k++) {
        from[k + 1] = from[k] + theirs[k];
    }
    claim *in = RG_NEW(claim, (size_t)from[ranks] + 1);
    MPI_Datatype type;
    MPI_Type_contiguous(sizeof(claim), MPI_BYTE, &type);
    MPI_Type_commit(&type);
    MPI_Alltoallv(out, count, at, type, in, theirs, from, type, r->comm);
    MPI_Type_free(&type);
    for (int i = 0; i < from[ranks]; i++) {
        rg_gid here = in[i].other / 4, there = in[i].side / 4;
        if (!accept(element_at(r, here), &in[i]) && here < there) {
            quarrel(q, here, there);
        }
    }
    rg_free(count);
    rg_free(at);
    rg_free(theirs);
    rg_free(from);
    rg_free(out);
    rg_free(in);
}

static void fill_neighbours(reader *r) {
    quarrels q = {0};
    fill_inside(r);
    fill_borders(r, &q);
    for (int64_t slot = 0; slot < 4 * (int64_t)r->own->elements; slot++) {
        const rg_element *e = &r->own->element[slot / 4];
        int f = (int)(slot % 4);
        if (!(e->other_volume[f] > 0) && (e->owner[f] == r->rank || e->id < e->neighbour[f])) {
            quarrel(&q, e->id, e->neighbour[f]);
        }
    }
    tell_quarrels(r, &q);
}

/* ---- what the file says of the whole ---- */

/* The tiles were put in order by the graph: it must be that of the elements. */
static void check_graph(reader *r) {
    const rg_element *e = r->own->element;
    for (rg_lid t = 0; t < r->own->tiles; t++) {
        int64_t id = r->own->tile_id[t];
        uint64_t sum = 0;
        for (rg_lid end = rg_tile_size(r->own, id); end > 0; end--, e++) {
            for (int f = 0; f < 4; f++) {
                int64_t other = e->neighbour[f] < 0 ? id : e->neighbour[f] / r->own->tile;
                sum += other != id ? beside(other) : 0;
            }
        }
        if (sum != r->beside[id]) {
            rg_input_errors_add(
                &r->input_errors, id, 0,
                "tile_neighbour: not the neighbours of tile %" PRId64 ", or not as many faces", id);
        }
    }
}

/* Counts and box of the header; rank 0 tells. */
static void check_header(reader *r) {
    const rg_part *own = r->own;
    double box[6]; /* upper corner and negative lower corner: one maximum */
    int64_t sides = 0;
    for (int i = 0; i < 6; i++) {
        box[i] = -INFINITY;
    }
    for (int64_t slot = 0; slot < 4 * (int64_t)own->elements; slot++) {
        const rg_element *e = &own->element[slot / 4];
        sides += e->neighbour[slot % 4] >= 0;
        for (int i = 0; i < 3; i++) {
            box[i] = fmax(box[i], e->x[slot % 4][i]);
            box[3 + i] = fmax(box[3 + i], -e->x[slot % 4][i]);
        }
    }
    MPI_Allreduce(MPI_IN_PLACE, &sides, 1, MPI_INT64_T, MPI_SUM, r->comm);
    MPI_Allreduce(MPI_IN_PLACE, box, 6, MPI_DOUBLE, MPI_MAX, r->comm);
    if (r->rank == 0 && sides != 2 * own->interfaces) {
        rg_input_errors_add(&r->input_errors, -2, 0,
                            "interfaces: %" PRId64 ", but the elements have %" PRId64, own->interfaces,
                            sides / 2);
    }
    for (int i = 0; i < 3; i++) {
        if (r->rank == 0 && (own->box[1][i] != box[i] || own->box[0][i] != -box[3 + i])) {
            rg_input_errors_add(&r->input_errors, -1, 0, "box: is not that of the vertices");
            return;
        }
    }
}

rg_part *rg_part_read(const char *path, double *weight, MPI_Comm comm) {
    reader r = {.comm = comm, .input_errors = {.name = path}, .own = RG_NEW(rg_part, 1)};
    MPI_Comm_rank(comm, &r.rank);
    MPI_Comm_size(comm, &r.ranks);
    rg_distribution *distribution =
        r.rank == 0 ? distribute(&r, weight) : NULL; /* tells what is wrong with the file as such */
    rg_distribution_share(distribution, r.own, comm);
    share_owners(&r, distribution);
    rg_distribution_free(distribution);
    r.file = rg_mesh_file_open_on_all(path, comm);
    r.head = rg_mesh_file_header(r.file);
    take_header(&r);
    read_tiles(&r);
    rg_input_errors_agree(&r.input_errors, comm);
    fill_neighbours(&r);
    rg_input_errors_agree(&r.input_errors, comm);
    check_graph(&r);
    check_header(&r);
    rg_input_errors_agree(&r.input_errors, comm);
    rg_part_check(r.own, path, r.file, comm);
    rg_mesh_file_close(r.file);
    rg_free(r.owner);
    rg_free(r.beside);
    rg_free(r.place);
    return r.own;
}
