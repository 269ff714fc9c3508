#include "domain/assembly_plan.h"

#include <stdlib.h>

#include "base/exchange.h"
#include "base/mem.h"
#include "layout.h"

enum { CROSSES = 1, SHARED = 2 }; /* a node with copies in other tiles, on other ranks */

/* Copies are numbered RG_NODES * slot + node. Those that shared-node faces connect here are a component,
 * known by its root; a node is one or, connected by way of other ranks, several of them. What identifies it
 * everywhere is its lowest RG_NODES * element number + node, and the rank where that is. */
typedef struct {
    const rg_domain *d;
    const rg_conforming_faces *j;
    MPI_Comm comm;
    int rank;
    rg_lid *parent; /* [copies]: union-find */
    rg_gid *key;    /* [copies], of roots */
    int32_t *owner; /* [copies], of roots: rank */
    uint8_t *flags; /* [copies], of roots */
    rg_assembly_plan *plan;
} builder;

/* ---- Components ---- */

static rg_lid root_of(const builder *b, rg_lid copy) {
    while (b->parent[copy] != copy) {
        b->parent[copy] = b->parent[b->parent[copy]];
        copy = b->parent[copy];
    }
    return copy;
}

static rg_lid copy_at(rg_lid slot, int face, int a) {
    return slot * RG_NODES + rg_face_node[face][a];
}

static void connect(builder *b) {
    for (size_t k = 0; k < b->j->count; k++) {
        const rg_conforming_face *conforming_face = &b->j->conforming_face[k];
        for (int a = 0; a < RG_FNODES; a++) {
            rg_lid one = root_of(b, copy_at(conforming_face->slot[0], conforming_face->face[0], a));
            rg_lid two = root_of(b, copy_at(conforming_face->slot[1], conforming_face->face[1], a));
            b->parent[one < two ? two : one] = one < two ? one : two;
        }
    }
}

static void identify(builder *b) {
    for (size_t slot = 0; slot < b->d->blocks * RG_LANES; slot++) {
        for (int n = 0; b->d->id[slot] >= 0 && n < RG_NODES; n++) {
            rg_lid copy = (rg_lid)slot * RG_NODES + n, root = root_of(b, copy);
            rg_gid key = b->d->id[slot] * RG_NODES + n;
            b->parent[copy] = root;
            b->key[root] = b->owner[root] < 0 || key < b->key[root] ? key : b->key[root];
            b->owner[root] = b->rank;
        }
    }
}

static void flag(builder *b) {
    for (size_t k = 0; k < b->j->count; k++) {
        const rg_conforming_face *conforming_face = &b->j->conforming_face[k];
        const rg_tile *tile[2];
        for (int side = 0; side < 2; side++) {
            tile[side] = rg_tile_of(b->d, (size_t)conforming_face->slot[side]);
        }
        for (int a = 0; tile[0] != tile[1] && a < RG_FNODES; a++) {
            b->flags[b->parent[copy_at(conforming_face->slot[0], conforming_face->face[0], a)]] |= CROSSES;
        }
    }
    for (size_t k = 0; k < b->j->fars; k++) {
        for (int a = 0; a < RG_FNODES; a++) {
            b->flags[b->parent[copy_at(b->j->far[k].slot, b->j->far[k].face, a)]] |= CROSSES | SHARED;
        }
    }
}

/* What two ranks tell each other of the nodes of a shared-node face between them. */
typedef struct {
    rg_gid key[RG_FNODES];
    int32_t owner[RG_FNODES];
} face_names;

/* One exchange; whether a lower key came in. */
static bool spread(builder *b, const rg_exchange *x, face_names *message, face_names *arrived) {
    bool changed = false;
    for (int pass = 0; pass < 2; pass++) {
        for (size_t k = 0; k < b->j->fars; k++) {
            for (int a = 0; a < RG_FNODES; a++) {
                rg_lid root = b->parent[copy_at(b->j->far[k].slot, b->j->far[k].face, a)];
                if (pass == 0) {
                    message[k].key[a] = b->key[root];
                    message[k].owner[a] = b->owner[root];
                } else if (arrived[k].key[a] < b->key[root]) {
                    b->key[root] = arrived[k].key[a];
                    b->owner[root] = arrived[k].owner[a];
                    changed = true;
                }
            }
        }
        if (pass == 0) {
            rg_exchange_send(x, sizeof *message, message, arrived);
        }
    }
    return changed;
}

static void agree(builder *b) {
    rg_exchange *x = rg_exchange_make(b->j->far_rank, b->j->fars, b->comm);
    face_names *message = RG_NEW(face_names, 2 * b->j->fars + 1);
    int changed = 1;
    while (changed) {
        changed = spread(b, x, message, message + b->j->fars);
        MPI_Allreduce(MPI_IN_PLACE, &changed, 1, MPI_INT, MPI_MAX, b->comm);
    }
    rg_free(message);
    rg_exchange_free(x);
}

static void make_components(builder *b) {
    size_t copies = b->d->blocks * RG_LANES * RG_NODES;
    b->parent = RG_NEW(rg_lid, copies);
    b->key = RG_NEW(rg_gid, copies);
    b->owner = RG_NEW(int32_t, copies);
    b->flags = RG_NEW(uint8_t, copies);
    for (size_t i = 0; i < copies; i++) {
        b->parent[i] = (rg_lid)i;
        b->owner[i] = -1;
    }
    connect(b);
    identify(b);
    flag(b);
    agree(b);
}

static void free_components(builder *b) {
    rg_free(b->parent);
    rg_free(b->key);
    rg_free(b->owner);
    rg_free(b->flags);
}

/* ---- Nodes of the tiles ---- */

/* A copy, as it is sorted into the nodes of its tile. */
typedef struct {
    rg_gid key;
    int32_t at, owner;
    uint8_t flags;
} member;

static int by_border_key_and_place(const void *a, const void *b) {
    const member *p = a, *q = b;
    if (p->flags != q->flags) {
        return p->flags < q->flags ? -1 : 1; /* CROSSES alone comes before SHARED too: both are the border */
    }
    if (p->key != q->key) {
        return p->key < q->key ? -1 : 1;
    }
    return (p->at > q->at) - (p->at < q->at);
}

/* Fills the members of a tile, in the order of their nodes; returns their number. */
static size_t list_members(const builder *b, size_t t, member *out) {
    size_t first = b->d->tile[t].begin * RG_LANES, count = 0;
    for (size_t slot = first; slot < b->d->tile[t].end * RG_LANES; slot++) {
        for (int n = 0; b->d->id[slot] >= 0 && n < RG_NODES; n++) {
            rg_lid root = b->parent[slot * RG_NODES + (size_t)n];
            int32_t at = (int32_t)rg_node_index(slot - first, n, 0);
            out[count++] = (member){b->key[root], at, b->owner[root], b->flags[root]};
        }
    }
    qsort(out, count, sizeof *out, by_border_key_and_place);
    return count;
}

/* A row: the sum of a node's copies in one tile. */
typedef struct {
    rg_gid key, tile; /* of the node; global number */
    int32_t rank;     /* who has it; in a message to another rank, which that is; of an own row: the node's */
    size_t row;
    bool shared;
} record;

typedef struct {
    record *row;
    size_t count, room;
} records;

static void add(records *list, record r) {
    list->row = rg_grow(list->row, &list->room, list->count, sizeof *list->row);
    list->row[list->count++] = r;
}

/* Takes the members of tile t into the plan, and its rows into `own`. */
static void group(builder *b, size_t t, const member *list, size_t count, records *own) {
    rg_assembly_plan *p = b->plan;
    rg_tile_nodes *tile = &p->tile[t];
    *tile = (rg_tile_nodes){.first = p->nodes, .border = p->nodes, .row = own->count};
    for (size_t i = 0; i < count; i++) {
        if (i == 0 || list[i].key != list[i - 1].key) {
            bool border = (list[i].flags & CROSSES) != 0, shared = (list[i].flags & SHARED) != 0;
            if (border) {
                add(own, (record){list[i].key, b->d->tile[t].first / b->d->tile_elements, list[i].owner,
                                  own->count, shared});
                tile->waits = tile->waits || shared;
            }
            p->first_copy[p->nodes++] = p->copies;
            tile->border += !border;
        }
        p->copy[p->copies++] = list[i].at;
    }
    tile->end = p->nodes;
}

static void make_tiles(builder *b, records *own) {
    size_t room = b->d->tile_blocks * RG_LANES * RG_NODES, all = b->d->elements * RG_NODES;
    rg_assembly_plan *p = b->plan;
    p->tile = RG_NEW(rg_tile_nodes, b->d->tiles);
    p->first_copy = RG_NEW(size_t, all + 1);
    p->copy = RG_NEW(int32_t, all + 1);
    member *list = RG_NEW(member, room);
    for (size_t t = 0; t < b->d->tiles; t++) {
        group(b, t, list, list_members(b, t, list), own);
    }
    p->first_copy[p->nodes] = p->copies;
    rg_free(list);
}

/* ---- Rows of other ranks ---- */

static int compare(rg_gid a, rg_gid b) {
    return (a > b) - (a < b);
}

static int by_key_and_tile(const void *a, const void *b) {
    const record *p = a, *q = b;
    int order = compare(p->key, q->key);
    return order != 0 ? order : compare(p->tile, q->tile);
}

static int by_key_and_rank(const void *a, const void *b) {
    const record *p = a, *q = b;
    int order = compare(p->key, q->key);
    return order != 0 ? order : compare(p->rank, q->rank);
}

static int by_rank_key_and_tile(const void *a, const void *b) {
    const record *p = a, *q = b;
    int order = compare(p->rank, q->rank);
    return order != 0 ? order : by_key_and_tile(a, b);
}

static void sort(records *list, int (*order)(const void *, const void *)) {
    if (list->count > 0) {
        qsort(list->row, list->count, sizeof *list->row, order);
    }
}

/* End of the run of records from `begin` on that have the same key. */
static size_t end_of_key(const records *list, size_t begin) {
    size_t end = begin;
    while (end < list->count && list->row[end].key == list->row[begin].key) {
        end++;
    }
    return end;
}

/* Sends record i to rank to[i]; what arrives has the sender as its rank if `sign`. */
static records send_records(const records *list, const int *to, bool sign, MPI_Comm comm) {
    rg_exchange *x = rg_exchange_make(to, list->count, comm);
    records in = {RG_NEW(record, x->arriving + 1), x->arriving, x->arriving};
    rg_exchange_send(x, sizeof *list->row, list->row, in.row);
    for (int r = 0; sign && r < x->ranks; r++) {
        for (int i = x->receive_at[r]; i < x->receive_at[r] + x->receive[r]; i++) {
            in.row[i].rank = r;
        }
    }
    rg_exchange_free(x);
    return in;
}

/* Each rank tells its rows of a shared node to the rank that the node is known by. */
static records report(const builder *b, const records *own) {
    records out = {0};
    for (size_t i = 0; i < own->count; i++) {
        if (own->row[i].shared) {
            add(&out, own->row[i]);
        }
    }
    int *to = RG_NEW(int, out.count + 1);
    for (size_t i = 0; i < out.count; i++) {
        to[i] = out.row[i].rank;
    }
    records in = send_records(&out, to, true, b->comm);
    rg_free(to);
    rg_free(out.row);
    return in;
}

/* That rank tells each rank that has a row of it those of the others. */
static records answer(const builder *b, records *reported) {
    records out = {0};
    int *to = NULL;
    size_t room = 0;
    sort(reported, by_key_and_rank);
    for (size_t begin = 0, end; begin < reported->count; begin = end) {
        end = end_of_key(reported, begin);
        for (size_t i = begin; i < end; i++) {
            bool first = i == begin || reported->row[i].rank != reported->row[i - 1].rank;
            for (size_t k = begin; first && k < end; k++) {
                if (reported->row[k].rank != reported->row[i].rank) {
                    to = rg_grow(to, &room, out.count, sizeof *to);
                    to[out.count] = reported->row[i].rank;
                    add(&out, reported->row[k]);
                }
            }
        }
    }
    records in = send_records(&out, to, false, b->comm);
    rg_free(to);
    rg_free(out.row);
    return in;
}

/* Own rows, and the ranks that they go to: all that have a row of the same node. Both lists are sorted by key
 * and rank. */
static records list_sends(const records *own, const records *others) {
    records out = {0};
    size_t at = 0;
    for (size_t begin = 0, end; begin < others->count; begin = end) {
        end = end_of_key(others, begin);
        while (own->row[at].key < others->row[begin].key) {
            at++;
        }
        for (size_t i = begin; i < end; i++) {
            bool first = i == begin || others->row[i].rank != others->row[i - 1].rank;
            for (size_t k = at; first && k < own->count && own->row[k].key == others->row[i].key; k++) {
                record r = own->row[k];
                r.rank = others->row[i].rank;
                add(&out, r);
            }
        }
    }
    sort(&out, by_rank_key_and_tile);
    return out;
}

static void plan_halo(rg_assembly_plan *p, const records *own, const records *sends, const records *others) {
    rg_halo_row *send = RG_NEW(rg_halo_row, sends->count + 1);
    int32_t *from = RG_NEW(int32_t, others->count + 1);
    for (size_t i = 0; i < sends->count; i++) {
        send[i] = (rg_halo_row){sends->row[i].rank, sends->row[i].row};
    }
    for (size_t i = 0; i < others->count; i++) {
        from[i] = others->row[i].rank;
    }
    p->halo = (rg_halo_plan){send, sends->count, from, others->count, own->count};
}

/* What each own row's node is summed from. */
static void plan_sources(rg_assembly_plan *p, const records *own, const records *others) {
    records all = {0};
    for (size_t i = 0; i < own->count; i++) {
        add(&all, own->row[i]);
    }
    for (size_t i = 0; i < others->count; i++) {
        add(&all, others->row[i]);
        all.row[all.count - 1].row = own->count + i;
    }
    sort(&all, by_key_and_tile);
    p->sources = RG_NEW(rg_sources, own->count + 1);
    p->source = RG_NEW(size_t, all.count + 1);
    for (size_t begin = 0, end; begin < all.count; begin = end) {
        end = end_of_key(&all, begin);
        for (size_t i = begin; i < end; i++) {
            p->source[i] = all.row[i].row;
            if (all.row[i].row < own->count) {
                p->sources[all.row[i].row] = (rg_sources){begin, end};
            }
        }
    }
    rg_free(all.row);
}

static void join_rows(builder *b, records *own) {
    records reported = report(b, own), others = answer(b, &reported);
    rg_free(reported.row);
    sort(own, by_key_and_tile);
    sort(&others, by_key_and_rank);
    records sends = list_sends(own, &others);
    sort(&others, by_rank_key_and_tile);
    plan_halo(b->plan, own, &sends, &others);
    plan_sources(b->plan, own, &others);
    rg_free(sends.row);
    rg_free(others.row);
}

rg_assembly_plan *rg_assembly_plan_make(const rg_domain *d, const rg_conforming_faces *j, MPI_Comm comm) {
    builder b = {.d = d, .j = j, .comm = comm, .plan = RG_NEW(rg_assembly_plan, 1)};
    records own = {0};
    MPI_Comm_rank(comm, &b.rank);
    make_components(&b);
    make_tiles(&b, &own);
    free_components(&b);
    join_rows(&b, &own);
    rg_free(own.row);
    return b.plan;
}

void rg_assembly_plan_free(rg_assembly_plan *p) {
    if (p == NULL) {
        return;
    }
    rg_free(p->tile);
    rg_free(p->first_copy);
    rg_free(p->copy);
    rg_free(p->sources);
    rg_free(p->source);
    rg_free((void *)p->halo.send);
    rg_free((void *)p->halo.from);
    rg_free(p);
}
