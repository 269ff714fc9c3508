#include "contact/search.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/exchange.h"
#include "base/hash.h"
#include "base/mem.h"
#include "base/vector.h"

enum { AXIS = 20 }; /* cells number from -2^AXIS to 2^AXIS along each axis */

/* A face whose box has become so many times longer belongs to an element of a run that has gone wrong: it is
 * in more cells than can be looked at. */
#define TORN 10

/* Rounding of reference corners, over the height of an element. */
#define FLAT 1e-9

/* ---- Two faces ---- */

/* How many corners of the undeformed faces are the same points; weights of their mean, how far they have come
 * apart. */
static int corners_shared(const rg_exposed_face *a, const rg_exposed_face *b, double common[2][3],
                          double *apart) {
    int shared = 0;
    double w[3] = {0, 0, 0};
    for (int i = 0; i < 9; i++) {
        const double *p = a->rest + 3 * (i / 3), *q = b->rest + 3 * (i % 3);
        if (memcmp(p, q, 3 * sizeof *p) == 0) {
            common[0][i / 3] = common[1][i % 3] = 1;
            shared++;
        }
    }
    for (int i = 0; shared > 0 && i < 3; i++) {
        common[0][i] /= shared;
        common[1][i] /= shared;
        for (int c = 0; c < 3; c++) {
            w[c] += common[1][i] * b->corner[3 * i + c] - common[0][i] * a->corner[3 * i + c];
        }
    }
    *apart = sqrt(rg_vector_dot(w, w));
    return shared;
}

static double area_of(const double *corner) {
    double edge[2][3], across[3];
    for (int k = 0; k < 2; k++) {
        rg_vector_subtract(corner + 3 * (k + 1), corner, edge[k]);
    }
    rg_vector_cross(edge[0], edge[1], across);
    return 0.5 * sqrt(rg_vector_dot(across, across));
}

/* How far the middle of x is above the plane of `of`, over 3. */
static double middle_over(const double *of, const double *x) {
    double n[3], r[3], sum = 0;
    rg_vector_normal(of, n);
    for (int i = 0; i < 3; i++) {
        rg_vector_subtract(x + 3 * i, of, r);
        sum += rg_vector_dot(n, r);
    }
    return sum;
}

/* Faces that meet at a corner of the undeformed solid and have it between them: each lies behind the other.
 */
static bool is_convex_edge(const rg_exposed_face *a, const rg_exposed_face *b, double h) {
    return middle_over(a->rest, b->rest) < -FLAT * h && middle_over(b->rest, a->rest) < -FLAT * h;
}

bool rg_search_may_touch(const rg_search *by, const rg_exposed_face *a, const rg_exposed_face *b,
                         rg_contact_pair *pair) {
    double h = fmin(a->height, b->height), apart;
    *pair = (rg_contact_pair){.stiffness = by->penalty * 0.5 * (a->modulus + b->modulus) / h,
                              .skin = by->skin * h,
                              .limit = (by->skin + by->reach) * h};
    int shared = corners_shared(a, b, pair->common, &apart);
    if (a->id / RG_FACES == b->id / RG_FACES) {
        return false;
    }
    if (shared == 3 && a->former && b->former) { /* both sides of what was an interface */
        pair->fading = area_of(a->rest);
    } else if (shared > 0 && is_convex_edge(a, b, h)) {
        pair->parting = fmin(area_of(a->rest), area_of(b->rest));
    }
    return apart + 2 * by->fat >= sqrt(pair->parting);
}

/* A face as it is compared with others. */
typedef struct {
    double low[3], high[3]; /* the box of its corners */
    double normal[3];
} shape;

static shape shape_of(const rg_exposed_face *f) {
    shape s;
    for (int c = 0; c < 3; c++) {
        const double *x = f->corner + c;
        double low = x[0] < x[3] ? x[0] : x[3], high = x[0] > x[3] ? x[0] : x[3];
        s.low[c] = x[6] < low ? x[6] : low;
        s.high[c] = x[6] > high ? x[6] : high;
    }
    rg_vector_normal(f->corner, s.normal);
    return s;
}

/* Whether the distances along n of points of a from points of b come within [low, high]. */
static bool come_within(const double *n, const rg_exposed_face *a, const rg_exposed_face *b, double low,
                        double high) {
    double least = INFINITY, most = -INFINITY;
    for (int i = 0; i < 9; i++) {
        double r[3];
        rg_vector_subtract(a->corner + 3 * (i / 3), b->corner + 3 * (i % 3), r);
        double z = rg_vector_dot(n, r);
        least = z < least ? z : least;
        most = z > most ? z : most;
    }
    return least <= high && most >= low;
}

/* Whether a face may come over another: their normals may face each other, and points of both differ by what
 * they may be deep along the mid-plane's normal, after both have moved. */
static bool may_come_over(const rg_search *by, const rg_exposed_face *a, const rg_exposed_face *b,
                          const shape *s, const shape *t) {
    double turn = 2 * by->turn, facing = -rg_vector_dot(s->normal, t->normal), n[3];
    if (facing < -turn) {
        return false;
    }
    double deep = (by->skin + by->reach) * (a->height < b->height ? a->height : b->height),
           slack = 2 * by->fat + 2 * turn * deep;
    rg_vector_subtract(s->normal, t->normal, n);
    double length = sqrt(rg_vector_dot(n, n));
    for (int c = 0; c < 3; c++) {
        n[c] /= length;
        double along = n[c] * deep, least = along < 0 ? along : 0, most = along > 0 ? along : 0;
        if (s->low[c] - t->high[c] > most + slack || s->high[c] - t->low[c] < least - slack) {
            return false;
        }
    }
    return come_within(n, a, b, -slack, deep + slack) && come_within(s->normal, a, b, -slack, deep + slack) &&
           come_within(t->normal, a, b, -deep - slack, slack);
}

/* ---- Cells ---- */

typedef struct {
    double low[3], high[3];
} box;

/* Of all that a face may touch before the next search, the half of what lies between them. False where it is
 * outside the grid, nowhere, or torn. */
static bool box_of(const rg_search *by, const rg_exposed_face *f, double cell, box *b) {
    shape s = shape_of(f);
    double now = 0, rest = 0, fat = by->fat + 0.5 * (by->skin + by->reach) * f->height;
    for (int c = 0; c < 3; c++) {
        const double *r = f->rest + c;
        b->low[c] = s.low[c] - fat;
        b->high[c] = s.high[c] + fat;
        now = fmax(now, s.high[c] - s.low[c]);
        rest = fmax(rest, fmax(fmax(r[0], r[3]), r[6]) - fmin(fmin(r[0], r[3]), r[6]));
        if (!(b->low[c] > -cell * (1 << AXIS)) || !(b->high[c] < cell * (1 << AXIS))) {
            return false;
        }
    }
    return now <= TORN * rest;
}

static int64_t cell_at(double x, double cell) {
    return (int64_t)floor(x / cell);
}

static int64_t cell_key(const int64_t at[3]) {
    int64_t key = 0;
    for (int c = 0; c < 3; c++) {
        key = key * (2 << AXIS) + at[c] + (1 << AXIS);
    }
    return key;
}

/* A face in a cell. */
typedef struct {
    int64_t cell;
    rg_exposed_face face;
} visitor;

/* Counts the visits of a face, and with room for them lists them. */
static size_t visit(const rg_search *by, const rg_exposed_face *f, double cell, visitor *out) {
    box b;
    size_t count = 0;
    if (!box_of(by, f, cell, &b)) {
        return 0;
    }
    int64_t at[3], low[3], high[3];
    for (int c = 0; c < 3; c++) {
        low[c] = cell_at(b.low[c], cell);
        high[c] = cell_at(b.high[c], cell);
    }
    for (at[0] = low[0]; at[0] <= high[0]; at[0]++) {
        for (at[1] = low[1]; at[1] <= high[1]; at[1]++) {
            for (at[2] = low[2]; at[2] <= high[2]; at[2]++, count++) {
                if (out != NULL) {
                    out[count] = (visitor){cell_key(at), *f};
                }
            }
        }
    }
    return count;
}

/* Some two faces: the mean length of a box. */
static double cell_size(const rg_search *by, const rg_exposed_face *face, size_t faces, MPI_Comm comm) {
    double sum[2] = {0, (double)faces};
    for (size_t i = 0; i < faces; i++) {
        sum[0] += sqrt(rg_vector_distance2(face[i].rest, face[i].rest + 3));
    }
    MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPI_DOUBLE, MPI_SUM, comm);
    return 2 * sum[0] / fmax(sum[1], 1) + 2 * by->fat;
}

/* Whether the boxes meet, and this is the cell of the lowest corner of what they share: only there is the
 * pair found. */
static bool meet_here(const box *a, const box *b, double cell, int64_t key) {
    int64_t at[3];
    for (int c = 0; c < 3; c++) {
        double low = a->low[c] > b->low[c] ? a->low[c] : b->low[c];
        if (low > a->high[c] || low > b->high[c]) {
            return false;
        }
        at[c] = cell_at(low, cell);
    }
    return cell_key(at) == key;
}

typedef struct {
    rg_candidate *pair;
    size_t count, room;
} found;

/* A visitor at its cell, ready to be compared. */
typedef struct {
    int64_t cell;
    rg_gid id;
    const rg_exposed_face *face;
    box box;
    shape shape;
} guest;

static int by_cell(const void *a, const void *b) {
    const guest *p = a, *q = b;
    int order = (p->cell > q->cell) - (p->cell < q->cell);
    return order != 0 ? order : (p->id > q->id) - (p->id < q->id);
}

static void compare_cell(const rg_search *by, double cell, const guest *g, size_t count, found *f) {
    for (size_t i = 0; i < count; i++) {
        for (size_t k = i + 1; k < count; k++) {
            rg_contact_pair pair;
            if (meet_here(&g[i].box, &g[k].box, cell, g[i].cell) &&
                may_come_over(by, g[i].face, g[k].face, &g[i].shape, &g[k].shape) &&
                rg_search_may_touch(by, g[i].face, g[k].face, &pair)) {
                f->pair = rg_grow(f->pair, &f->room, f->count, sizeof *f->pair);
                f->pair[f->count++] = (rg_candidate){.face = {*g[i].face, *g[k].face}, .pair = pair};
            }
        }
    }
}

static void compare(const rg_search *by, double cell, const visitor *v, size_t visitors, found *f) {
    guest *g = RG_NEW(guest, visitors + 1);
    for (size_t i = 0; i < visitors; i++) {
        g[i] = (guest){.cell = v[i].cell, .id = v[i].face.id, .face = &v[i].face};
        box_of(by, g[i].face, cell, &g[i].box);
        g[i].shape = shape_of(g[i].face);
    }
    qsort(g, visitors, sizeof *g, by_cell);
    for (size_t begin = 0, end; begin < visitors; begin = end) {
        for (end = begin + 1; end < visitors && g[end].cell == g[begin].cell;) {
            end++;
        }
        compare_cell(by, cell, g + begin, end - begin, f);
    }
    rg_free(g);
}

/* Sends `count` items of `size` bytes to their ranks and frees them, with `to`; returns what arrived. */
static void *swap(void *leaving, int *to, size_t size, size_t count, size_t *arrived, MPI_Comm comm) {
    rg_exchange *x = rg_exchange_make(to, count, comm);
    void *mine = rg_alloc(x->arriving + 1, size);
    rg_exchange_send(x, size, leaving, mine);
    *arrived = x->arriving;
    rg_exchange_free(x);
    rg_free(to);
    rg_free(leaving);
    return mine;
}

/* The visitors of this rank's cells. */
static visitor *gather(const rg_search *by, double cell, const rg_exposed_face *face, size_t faces,
                       size_t *arrived, MPI_Comm comm) {
    size_t count = 0, at = 0;
    int ranks;
    MPI_Comm_size(comm, &ranks);
    for (size_t i = 0; i < faces; i++) {
        count += visit(by, &face[i], cell, NULL);
    }
    visitor *leaving = RG_NEW(visitor, count + 1);
    int *to = RG_NEW(int, count + 1);
    for (size_t i = 0; i < faces; i++) {
        at += visit(by, &face[i], cell, leaving + at);
    }
    for (size_t i = 0; i < count; i++) {
        to[i] = (int)(rg_mix((uint64_t)leaving[i].cell) % (uint64_t)ranks);
    }
    return swap(leaving, to, sizeof *leaving, count, arrived, comm);
}

static int by_faces(const void *a, const void *b) {
    const rg_candidate *p = a, *q = b;
    for (int k = 0; k < 2; k++) {
        if (p->face[k].id != q->face[k].id) {
            return p->face[k].id < q->face[k].id ? -1 : 1;
        }
    }
    return 0;
}

/* Pairs to those who own their faces. */
static rg_candidate *deliver(const found *f, size_t *pairs, MPI_Comm comm) {
    size_t count = 0;
    rg_candidate *leaving = RG_NEW(rg_candidate, 2 * f->count + 1);
    int *to = RG_NEW(int, 2 * f->count + 1);
    for (size_t i = 0; i < f->count; i++) {
        const rg_candidate *p = &f->pair[i];
        for (int k = 0; k < (p->face[0].rank == p->face[1].rank ? 1 : 2); k++) {
            leaving[count] = *p;
            to[count++] = p->face[k].rank;
        }
    }
    rg_candidate *mine = swap(leaving, to, sizeof *leaving, count, pairs, comm);
    qsort(mine, *pairs, sizeof *mine, by_faces);
    return mine;
}

rg_candidate *rg_search_pairs(const rg_search *by, const rg_exposed_face *face, size_t faces, size_t *pairs,
                              MPI_Comm comm) {
    double cell = cell_size(by, face, faces, comm);
    size_t visitors;
    visitor *v = gather(by, cell, face, faces, &visitors, comm);
    found f = {0};
    compare(by, cell, v, visitors, &f);
    rg_free(v);
    rg_candidate *mine = deliver(&f, pairs, comm);
    rg_free(f.pair);
    return mine;
}
