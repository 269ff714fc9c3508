#include "domain/slab.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "layout.h"

enum { WINDOW_BYTES = 16 << 20 }; /* little beside the state, and in the cache while it is written */

typedef struct {
    rg_gid id;
    rg_lid slot;
} numbered;

static int by_id(const void *a, const void *b) {
    const numbered *p = a, *q = b;
    return (p->id > q->id) - (p->id < q->id);
}

/* First number of rank r's slab. */
static rg_gid slab_begin(rg_gid total, int ranks, int r) {
    return total / ranks * r + (r < total % ranks ? r : total % ranks);
}

int rg_slab_owner(rg_gid total, int ranks, rg_gid id) {
    int r = (int)(id * ranks / total);
    while (id < slab_begin(total, ranks, r)) {
        r--;
    }
    while (id >= slab_begin(total, ranks, r + 1)) {
        r++;
    }
    return r;
}

static void offsets(const int *count, int *at, int ranks) {
    for (int r = 1; r < ranks; r++) {
        at[r] = at[r - 1] + count[r - 1];
    }
}

static numbered *sorted_elements(const rg_domain *d) {
    numbered *list = RG_NEW(numbered, d->elements + 1);
    size_t n = 0;
    for (size_t i = 0; i < d->blocks * RG_LANES; i++) {
        if (d->id[i] >= 0) {
            list[n++] = (numbered){d->id[i], (rg_lid)i};
        }
    }
    qsort(list, n, sizeof *list, by_id);
    return list;
}

rg_slab *rg_slab_make(const rg_domain *d, rg_gid total, MPI_Comm comm) {
    int rank, ranks;
    MPI_Comm_rank(comm, &rank);
    MPI_Comm_size(comm, &ranks);
    rg_slab *s = RG_NEW(rg_slab, 1);
    *s = (rg_slab){.rank = rank,
                   .ranks = ranks,
                   .total = total,
                   .first = slab_begin(total, ranks, rank),
                   .own = d->elements,
                   .comm = comm};
    s->count = (size_t)(slab_begin(total, ranks, rank + 1) - s->first);
    s->slot = RG_NEW(rg_lid, s->own + 1);
    s->row = RG_NEW(size_t, s->own + 1);
    s->place = RG_NEW(size_t, s->count + 1);
    int **counts[] = {&s->send, &s->send_at, &s->receive, &s->receive_at};
    for (int k = 0; k < 4; k++) {
        *counts[k] = RG_NEW(int, (size_t)ranks);
    }
    numbered *list = sorted_elements(d);
    rg_gid *id = RG_NEW(rg_gid, s->own + 1), *arrived = RG_NEW(rg_gid, s->count + 1);
    for (size_t i = 0; i < s->own; i++) {
        s->slot[i] = list[i].slot;
        id[i] = list[i].id;
        int owner = rg_slab_owner(total, ranks, id[i]);
        s->row[i] = (size_t)(id[i] - slab_begin(total, ranks, owner));
        s->send[owner]++;
    }
    MPI_Alltoall(s->send, 1, MPI_INT, s->receive, 1, MPI_INT, comm);
    offsets(s->send, s->send_at, ranks);
    offsets(s->receive, s->receive_at, ranks);
    MPI_Alltoallv(id, s->send, s->send_at, MPI_INT64_T, arrived, s->receive, s->receive_at, MPI_INT64_T,
                  comm);
    for (size_t i = 0; i < s->count; i++) {
        s->place[i] = (size_t)(arrived[i] - s->first);
    }
    rg_free(list);
    rg_free(id);
    rg_free(arrived);
    return s;
}

rg_slab *rg_slab_shared(rg_slab **slab, const rg_domain *d, rg_gid total, MPI_Comm comm) {
    if (*slab == NULL) {
        *slab = rg_slab_make(d, total, comm);
    }
    return *slab;
}

static MPI_Datatype record_type(size_t bytes) {
    MPI_Datatype record;
    MPI_Type_contiguous((int)bytes, MPI_BYTE, &record);
    MPI_Type_commit(&record);
    return record;
}

/* ---- windows ---- */

size_t rg_slab_window(size_t bytes) {
    return WINDOW_BYTES / bytes + 1;
}

size_t rg_slab_most(const rg_slab *s) {
    return (size_t)((s->total + s->ranks - 1) / s->ranks);
}

/* What a window has of the records that a rank sends to, or receives from, each of the others. */
typedef struct {
    size_t *begin;   /* [ranks]: the first one, among all that go between the two */
    int *count, *at; /* [ranks]: how many; where they are among those on their way */
    size_t here;     /* how many stay on the rank: not among `count` */
    size_t total;    /* the others */
} traffic;

/* First of the ascending row[n] that is not below `least`. */
static size_t first_from(const size_t *row, size_t n, size_t least) {
    size_t low = 0, high = n;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (row[middle] < least) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

/* Of all records, rank r's are the `count`[r] from `at`[r] on, by ascending `row`. */
static traffic traffic_of(const rg_slab *s, const size_t *row, const int *count, const int *at, size_t first,
                          size_t rows) {
    size_t ranks = (size_t)s->ranks;
    traffic t = {.begin = RG_NEW(size_t, ranks), .count = RG_NEW(int, ranks), .at = RG_NEW(int, ranks)};
    for (size_t r = 0; r < ranks; r++) {
        const size_t *its = row + at[r];
        size_t from = first_from(its, (size_t)count[r], first), n = (size_t)count[r] - from;
        n = first_from(its + from, n, first + rows);
        t.begin[r] = (size_t)at[r] + from;
        t.at[r] = (int)t.total;
        t.count[r] = r == (size_t)s->rank ? 0 : (int)n;
        t.here = r == (size_t)s->rank ? n : t.here;
        t.total += (size_t)t.count[r];
    }
    return t;
}

static void free_traffic(traffic *t) {
    rg_free(t->begin);
    rg_free(t->count);
    rg_free(t->at);
}

static char *make_room(rg_slab *s, size_t bytes) {
    if (bytes > s->room_bytes) {
        rg_free(s->room);
        s->room = RG_NEW(char, bytes);
        s->room_bytes = bytes;
    }
    return s->room;
}

/* A window on its way: the records of own elements, and those of the window's rows. */
typedef struct {
    size_t first, bytes;
    char *row; /* the window itself */
    traffic own, others;
    char *of_own, *of_others; /* records that change ranks */
} passage;

static passage open_passage(rg_slab *s, size_t first, size_t rows, size_t bytes, char *window) {
    passage p = {.first = first,
                 .bytes = bytes,
                 .row = window,
                 .own = traffic_of(s, s->row, s->send, s->send_at, first, rows),
                 .others = traffic_of(s, s->place, s->receive, s->receive_at, first, rows)};
    p.of_own = make_room(s, (p.own.total + p.others.total) * bytes + 1);
    p.of_others = p.of_own + p.own.total * bytes;
    return p;
}

/* Own elements: records that stay are in their rows of the window, the others in `of_own`. */
static void move_own(const rg_slab *s, const passage *p, rg_slab_move *move, const void *of) {
#pragma omp parallel
    for (int r = 0; r < s->ranks; r++) {
        bool stays = r == s->rank;
        size_t n = stays ? p->own.here : (size_t)p->own.count[r];
        if (n == 0) {
            continue;
        }
#pragma omp for schedule(static) nowait
        for (size_t k = 0; k < n; k++) {
            size_t i = p->own.begin[r] + k;
            move(of, i,
                 stays ? p->row + (s->row[i] - p->first) * p->bytes
                       : p->of_own + ((size_t)p->own.at[r] + k) * p->bytes);
        }
    }
}

/* Rows of other ranks' elements: from `of_others`, or (`out`) to there. */
static void move_others(const rg_slab *s, const passage *p, bool out) {
    for (int r = 0; r < s->ranks; r++) {
        for (size_t k = 0; k < (size_t)p->others.count[r]; k++) {
            char *row = p->row + (s->place[p->others.begin[r] + k] - p->first) * p->bytes;
            char *other = p->of_others + ((size_t)p->others.at[r] + k) * p->bytes;
            memcpy(out ? other : row, out ? row : other, p->bytes);
        }
    }
}

static void exchange(const rg_slab *s, size_t bytes, const traffic *leave, const char *leaving,
                     const traffic *arrive, char *arrived) {
    if (s->ranks > 1) {
        MPI_Datatype record = record_type(bytes);
        MPI_Alltoallv(leaving, leave->count, leave->at, record, arrived, arrive->count, arrive->at, record,
                      s->comm);
        MPI_Type_free(&record);
    }
}

static void close_passage(passage *p) {
    free_traffic(&p->own);
    free_traffic(&p->others);
}

size_t rg_slab_gather(rg_slab *s, size_t first, size_t rows, size_t bytes, rg_slab_move *get, const void *of,
                      char *out) {
    passage p = open_passage(s, first, rows, bytes, out);
    move_own(s, &p, get, of);
    exchange(s, bytes, &p.own, p.of_own, &p.others, p.of_others);
    move_others(s, &p, false);
    size_t here = p.others.here + p.others.total;
    close_passage(&p);
    return here;
}

void rg_slab_scatter(rg_slab *s, size_t first, size_t rows, size_t bytes, char *in, rg_slab_move *put,
                     const void *of) {
    passage p = open_passage(s, first, rows, bytes, in);
    move_others(s, &p, true);
    exchange(s, bytes, &p.others, p.of_others, &p.own, p.of_own);
    move_own(s, &p, put, of);
    close_passage(&p);
}

void rg_slab_free(rg_slab *s) {
    if (s == NULL) {
        return;
    }
    void *blocks[] = {s->slot, s->row, s->room, s->place, s->send, s->send_at, s->receive, s->receive_at};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
        rg_free(blocks[i]);
    }
    rg_free(s);
}
