/* A rank's part of the mesh from a mesh file, of which each rank reads its own tiles. */
#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "deal.h"
#include "error.h"
#include "mem.h"
#include "mesh.h"
#include "mesh_check.h"
#include "mesh_file.h"
#include "part_check.h"
#include "tet.h"

enum { SLAB = 256 }; /* most tiles at once: what is read beside the part stays small */

typedef struct {
    const char *path;
    MPI_Comm comm;
    int rank, ranks;
    rg_mesh_file *file;
    const rg_mesh_header *head;
    int32_t *owner; /* [tiles] of the mesh */
    rg_lid *place;  /* [tiles]: where the elements of an own tile begin */
    rg_part *own;
} reader;

/* ---- who reads what ---- */

/* The stored partition for so many ranks, or else METIS's; that knew of no weights. */
static rg_deal *deal_out(const char *path, double *weight, int ranks) {
    rg_mesh_file *f = rg_mesh_file_open(path);
    rg_tile_graph *g = rg_mesh_file_graph(f);
    int32_t *owner = RG_NEW(int32_t, (size_t)g->tiles);
    g->weight = weight;
    if (weight != NULL || !rg_mesh_file_partition(f, ranks, owner)) {
        rg_tile_graph_partition(g, ranks, owner);
    }
    rg_deal *deal = rg_deal_make(g, owner, ranks);
    rg_tile_graph_free(g);
    rg_mesh_file_close(f);
    return deal;
}

static void share_owners(reader *r, const rg_deal *deal) {
    int64_t tiles = (r->own->total + r->own->tile - 1) / r->own->tile;
    r->owner = RG_NEW(int32_t, (size_t)tiles);
    if (r->rank == 0) {
        memcpy(r->owner, deal->owner, (size_t)tiles * sizeof *r->owner);
    }
    MPI_Bcast(r->owner, (int)tiles, MPI_INT32_T, 0, r->comm);
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
    memcpy(r->own->box, h->box, sizeof h->box);
    r->own->sets = h->sets;
    for (int s = 0; s < h->sets; s++) {
        r->own->set_name[s] = RG_NEW(char, strlen(h->set_name[s]) + 1);
        strcpy(r->own->set_name[s], h->set_name[s]);
    }
}

/* ---- elements ---- */

static void unpack(const reader *r, const rg_mesh_slab *s, rg_gid i, rg_element *e) {
    e->id = s->first + i;
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

static void read_slab(const reader *r, int64_t begin, int64_t end) {
    rg_mesh_slab *s = rg_mesh_file_slab(r->file, begin, end);
#pragma omp parallel for schedule(static)
    for (rg_gid i = 0; i < s->elements; i++) {
        unpack(r, s, i, element_at(r, s->first + i));
    }
    for (rg_gid i = 0; i < s->elements; i++) {
        const rg_element *e = element_at(r, s->first + i);
        if (!rg_tet_has_volume(e->x[0])) {
            rg_fatal(RG_USAGE, "%s: element %" PRId64 " at (%g, %g, %g) m has no volume: %g m3", r->path,
                     s->original[i], e->x[0][0], e->x[0][1], e->x[0][2], e->volume);
        }
    }
    rg_mesh_slab_free(s);
}

/* Runs of consecutive tiles are read at once. */
static void read_tiles(const reader *r) {
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

/* ---- neighbours ---- */

static _Noreturn void disagree(const reader *r, const rg_element *e, int f) {
    rg_fatal(RG_USAGE,
             "%s: neighbour: elements %" PRId64 " and %" PRId64 " do not agree that they share a face",
             r->path, e->id, e->neighbour[f]);
}

static bool agree(const rg_element *e, int f, const rg_element *other) {
    int g = e->face[f];
    return other->neighbour[g] == e->id && other->face[g] == f &&
           rg_part_face_key(other, g) == rg_part_face_key(e, f);
}

/* Faces to own elements and the surface. */
static void fill_inside(const reader *r) {
    int64_t wrong = INT64_MAX;
#pragma omp parallel for schedule(static) reduction(min : wrong)
    for (int64_t slot = 0; slot < 4 * (int64_t)r->own->elements; slot++) {
        rg_element *e = &r->own->element[slot / 4];
        int f = (int)(slot % 4);
        if (e->neighbour[f] < 0) {
            e->other_volume[f] = e->volume;
        } else if (e->owner[f] == r->rank) {
            const rg_element *other = element_at(r, e->neighbour[f]);
            e->other_volume[f] = other->volume;
            wrong = agree(e, f, other) || wrong < slot ? wrong : slot;
        }
    }
    if (wrong < INT64_MAX) {
        disagree(r, &r->own->element[wrong / 4], (int)(wrong % 4));
    }
}

/* A face as seen from one side, which is 4 * element + face. */
typedef struct {
    int64_t side;
    double volume; /* of the element there */
    uint64_t key;  /* of the place of the face */
} message;

/* A face that another rank shares. */
typedef struct {
    int64_t lower; /* side: both ranks have the faces in this order */
    int32_t owner; /* of the other side */
    rg_lid element;
    int8_t face;
} border;

static int64_t own_side(const rg_element *e, int f) {
    return 4 * e->id + f;
}

static int64_t other_side(const rg_element *e, int f) {
    return 4 * e->neighbour[f] + e->face[f];
}

static int by_owner(const void *a, const void *b) {
    const border *p = a, *q = b;
    if (p->owner != q->owner) {
        return p->owner < q->owner ? -1 : 1;
    }
    return (p->lower > q->lower) - (p->lower < q->lower);
}

/* The faces to other ranks, in the order in which these list them too. */
static border *list_borders(const reader *r, size_t *count) {
    size_t room = 0;
    border *list = NULL;
    const rg_part *own = r->own;
    *count = 0;
    for (rg_lid i = 0; i < own->elements; i++) {
        const rg_element *e = &own->element[i];
        for (int8_t f = 0; f < 4; f++) {
            if (e->owner[f] < 0 || e->owner[f] == r->rank) {
                continue;
            }
            if (*count == room) {
                room = 2 * room + 1024;
                list = rg_realloc(list, room, sizeof *list);
            }
            int64_t here = own_side(e, f), there = other_side(e, f);
            list[(*count)++] = (border){here < there ? here : there, e->owner[f], i, f};
        }
    }
    if (*count > 0) {
        qsort(list, *count, sizeof *list, by_owner);
    }
    return list;
}

/* Sends each rank the volumes on this side of the faces it shares, and takes those of the other side. */
static void exchange(const reader *r, const border *list, const int *count, const int *at, const message *out,
                     message *in) {
    int *theirs = RG_NEW(int, (size_t)r->ranks);
    MPI_Alltoall(count, 1, MPI_INT, theirs, 1, MPI_INT, r->comm);
    for (int k = 0; k < r->ranks; k++) {
        if (theirs[k] != count[k]) {
            rg_fatal(RG_USAGE, "%s: neighbour: ranks %d and %d do not agree on the faces between them",
                     r->path, r->rank, k);
        }
    }
    MPI_Datatype type;
    MPI_Type_contiguous(sizeof(message), MPI_BYTE, &type);
    MPI_Type_commit(&type);
    MPI_Alltoallv(out, count, at, type, in, count, at, type, r->comm);
    MPI_Type_free(&type);
    for (int i = 0; i < at[r->ranks]; i++) {
        rg_element *e = &r->own->element[list[i].element];
        if (in[i].side != other_side(e, list[i].face) || in[i].key != out[i].key) {
            disagree(r, e, list[i].face);
        }
        e->other_volume[list[i].face] = in[i].volume;
    }
    rg_free(theirs);
}

static void fill_borders(const reader *r) {
    size_t n;
    border *list = list_borders(r, &n);
    message *out = RG_NEW(message, n + 1), *in = RG_NEW(message, n + 1);
    int *count = RG_NEW(int, (size_t)r->ranks), *at = RG_NEW(int, (size_t)r->ranks + 1);
    for (size_t i = 0; i < n; i++) {
        const rg_element *e = &r->own->element[list[i].element];
        out[i] = (message){own_side(e, list[i].face), e->volume, rg_part_face_key(e, list[i].face)};
        count[list[i].owner]++;
    }
    for (int k = 0; k < r->ranks; k++) {
        at[k + 1] = at[k] + count[k];
    }
    exchange(r, list, count, at, out, in);
    rg_free(count);
    rg_free(at);
    rg_free(out);
    rg_free(in);
    rg_free(list);
}

/* The tiles were put in order by the graph: it must say of each whether it touches another rank. */
static void check_graph(const reader *r) {
    const rg_element *e = r->own->element;
    for (rg_lid t = 0; t < r->own->tiles; t++) {
        bool outer = false;
        for (rg_lid end = rg_tile_size(r->own, r->own->tile_id[t]); end > 0; end--, e++) {
            for (int f = 0; f < 4; f++) {
                outer = outer || (e->owner[f] >= 0 && e->owner[f] != r->rank);
            }
        }
        if (outer != (t < r->own->boundary)) {
            rg_fatal(RG_USAGE, "%s: tile_neighbour: not the neighbours of tile %" PRId64, r->path,
                     r->own->tile_id[t]);
        }
    }
}

rg_part *rg_part_read(const char *path, double *weight, MPI_Comm comm) {
    reader r = {.path = path, .comm = comm, .own = RG_NEW(rg_part, 1)};
    MPI_Comm_rank(comm, &r.rank);
    MPI_Comm_size(comm, &r.ranks);
    rg_deal *deal =
        r.rank == 0 ? deal_out(path, weight, r.ranks) : NULL; /* tells what is wrong with the file */
    rg_deal_share(deal, r.own, comm);
    share_owners(&r, deal);
    rg_deal_free(deal);
    r.file = rg_mesh_file_open(path);
    r.head = rg_mesh_file_header(r.file);
    take_header(&r);
    read_tiles(&r);
    rg_mesh_file_close(r.file);
    check_graph(&r);
    fill_inside(&r);
    fill_borders(&r);
    rg_part_check(r.own, path, comm);
    rg_free(r.owner);
    rg_free(r.place);
    return r.own;
}
