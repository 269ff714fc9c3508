#include "diagnostics/overlap.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/exchange.h"
#include "base/hash.h"
#include "base/mem.h"
#include "domain/element.h"
#include "mesh/gid_map.h"

/* A fragment that reaches into a cell of the grid. */
typedef struct {
    rg_gid cell, fragment;
} presence;

/* An element in a cell that several fragments reach into. */
typedef struct {
    presence at;
    double x[4][3];
} visitor;

enum { AXIS = 20 }; /* cells number from -2^AXIS to 2^AXIS along each axis */

/* An element whose box has become so many times longer is no piece of the body any more: a run that goes
 * wrong leaves some with corners metres away, in more cells than can be looked at. */
#define TORN 10

enum { RECENT = 1 << 12 }; /* consecutive elements lie close together: most repetitions are recent */

/* ---- Cells ---- */

typedef struct {
    int64_t low[3], high[3]; /* cells that an element's box reaches into, ends included */
} span;

static double lowest(const double *corner, int c) {
    return fmin(fmin(corner[c], corner[3 + c]), fmin(corner[6 + c], corner[9 + c]));
}

static double highest(const double *corner, int c) {
    return fmax(fmax(corner[c], corner[3 + c]), fmax(corner[6 + c], corner[9 + c]));
}

/* Longest side of the box around four corners. */
static double extent(const double *corner) {
    double longest = 0;
    for (int c = 0; c < 3; c++) {
        longest = fmax(longest, highest(corner, c) - lowest(corner, c));
    }
    return longest;
}

/* False where an element is outside the grid, nowhere, or torn; `reference`: its corners at rest. */
static bool element_span(double x[4][3], const double *reference, double cell, span *r) {
    if (!(extent(x[0]) <= TORN * extent(reference))) {
        return false;
    }
    for (int c = 0; c < 3; c++) {
        double low = lowest(x[0], c), high = highest(x[0], c);
        if (!(low > -cell * (1 << AXIS)) || !(high < cell * (1 << AXIS))) {
            return false;
        }
        r->low[c] = (int64_t)floor(low / cell);
        r->high[c] = (int64_t)floor(high / cell);
    }
    return true;
}

static rg_gid cell_key(const int64_t at[3]) {
    rg_gid key = 0;
    for (int c = 0; c < 3; c++) {
        key = key * (2 << AXIS) + at[c] + (1 << AXIS);
    }
    return key;
}

/* The next cell of a span; false after the last. Starts from low. */
static bool next_cell(const span *r, int64_t at[3]) {
    for (int c = 0; c < 3; c++) {
        if (++at[c] <= r->high[c]) {
            return true;
        }
        at[c] = r->low[c];
    }
    return false;
}

typedef struct {
    const rg_solver *s;
    const rg_fragment_parts *p;
    double cell;
    const rg_gid_map *mixed; /* NULL: presences of all cells; else visitors of these */
    presence *recent;
    presence *presence; /* NULL: count only */
    visitor *visitor;
    size_t count;
} lister;

static void list_presence(lister *l, presence here) {
    presence *last = &l->recent[rg_hash((uint64_t)here.cell, (uint64_t)here.fragment) % RECENT];
    if (last->cell == here.cell && last->fragment == here.fragment) {
        return;
    }
    *last = here;
    if (l->presence != NULL) {
        l->presence[l->count] = here;
    }
    l->count++;
}

static void list_visitor(lister *l, presence here, double x[4][3]) {
    if (rg_gid_map_get(l->mixed, here.cell) < 0) {
        return;
    }
    if (l->visitor != NULL) {
        l->visitor[l->count].at = here;
        memcpy(l->visitor[l->count].x, x, sizeof l->visitor->x);
    }
    l->count++;
}

static void list_elements(lister *l) {
    l->count = 0;
    memset(l->recent, 0xff, RECENT * sizeof *l->recent);
    for (size_t i = 0; i < l->s->domain->blocks * RG_LANES; i++) {
        double x[4][3];
        span r;
        if (l->p->of[i] < 0) {
            continue;
        }
        rg_current_corners(l->s, i, x);
        if (!element_span(x, l->s->domain->corner + 12 * i, l->cell, &r)) {
            continue;
        }
        int64_t at[3] = {r.low[0], r.low[1], r.low[2]};
        do {
            presence here = {cell_key(at), l->p->label[l->p->of[i]].id};
            if (l->mixed == NULL) {
                list_presence(l, here);
            } else {
                list_visitor(l, here, x);
            }
        } while (next_cell(&r, at));
    }
}

/* ---- Which cells hold several fragments ---- */

static rg_exchange *to_cells(const rg_solver *s, const void *records, size_t size, size_t count) {
    int *to = RG_NEW(int, count);
    for (size_t i = 0; i < count; i++) {
        const presence *at = (const void *)((const char *)records + i * size);
        to[i] = (int)(rg_mix((uint64_t)at->cell) % (uint64_t)s->ranks);
    }
    rg_exchange *x = rg_exchange_make(to, count, s->comm);
    rg_free(to);
    return x;
}

/* The first fragment that a cell was seen with; a second one makes it mixed. */
static void judge_cells(const presence *seen, size_t count, uint8_t *mixed) {
    rg_gid_map place = rg_gid_map_make(count);
    uint8_t *several = RG_NEW(uint8_t, count);
    for (size_t i = 0; i < count; i++) {
        rg_lid first = rg_gid_map_put(&place, seen[i].cell, (rg_lid)i);
        several[first] |= seen[first].fragment != seen[i].fragment;
    }
    for (size_t i = 0; i < count; i++) {
        mixed[i] = several[rg_gid_map_get(&place, seen[i].cell)];
    }
    rg_free(several);
    rg_gid_map_free(&place);
}

/* The cells here that several fragments reach into. */
static rg_gid_map mixed_cells(lister *l) {
    list_elements(l);
    l->presence = RG_NEW(presence, l->count);
    list_elements(l);
    rg_exchange *x = to_cells(l->s, l->presence, sizeof *l->presence, l->count);
    presence *seen = RG_NEW(presence, x->arriving);
    uint8_t *mixed = RG_NEW(uint8_t, x->arriving), *answer = RG_NEW(uint8_t, l->count);
    rg_exchange_send(x, sizeof *seen, l->presence, seen);
    judge_cells(seen, x->arriving, mixed);
    rg_exchange_answer(x, sizeof *mixed, mixed, answer);
    rg_gid_map cells = rg_gid_map_make(l->count);
    for (size_t i = 0; i < l->count; i++) {
        if (answer[i]) {
            rg_gid_map_put(&cells, l->presence[i].cell, 1);
        }
    }
    rg_free(answer);
    rg_free(mixed);
    rg_free(seen);
    rg_exchange_free(x);
    rg_free(l->presence);
    return cells;
}

/* ---- Elements in elements ---- */

static bool contains(double x[4][3], const double point[3]) {
    double l[4];
    rg_barycentric(x[0], point, l);
    return l[0] > 0 && l[1] > 0 && l[2] > 0 && l[3] > 0;
}

static bool boxes_meet(double a[4][3], double b[4][3]) {
    for (int c = 0; c < 3; c++) {
        if (highest(b[0], c) < lowest(a[0], c) || lowest(b[0], c) > highest(a[0], c)) {
            return false;
        }
    }
    return true;
}

/* Whether a point of `a` lies in `b`: its centroid, or three quarters of the way from there to a corner. */
static bool reaches_into(double a[4][3], double b[4][3]) {
    double middle[3], point[3];
    for (int c = 0; c < 3; c++) {
        middle[c] = 0.25 * (a[0][c] + a[1][c] + a[2][c] + a[3][c]);
    }
    bool found = contains(b, middle);
    for (int k = 0; k < 4; k++) {
        for (int c = 0; c < 3; c++) {
            point[c] = 0.25 * middle[c] + 0.75 * a[k][c];
        }
        found = found || contains(b, point);
    }
    return found;
}

static int by_cell(const void *a, const void *b) {
    const visitor *p = a, *q = b;
    return (p->at.cell > q->at.cell) - (p->at.cell < q->at.cell);
}

static void compare(visitor *a, visitor *b, rg_gid pair[2]) {
    rg_gid low = a->at.fragment, high = b->at.fragment;
    if (low > high) {
        low = b->at.fragment;
        high = a->at.fragment;
    }
    bool lower = low < pair[0] || (low == pair[0] && high < pair[1]);
    if (low != high && lower && boxes_meet(a->x, b->x) &&
        (reaches_into(a->x, b->x) || reaches_into(b->x, a->x))) {
        pair[0] = low;
        pair[1] = high;
    }
}

/* The lowest pair among the visitors of this rank's cells. */
static void compare_visitors(lister *l, rg_gid pair[2]) {
    list_elements(l);
    l->visitor = RG_NEW(visitor, l->count);
    list_elements(l);
    rg_exchange *x = to_cells(l->s, l->visitor, sizeof *l->visitor, l->count);
    size_t count = x->arriving;
    visitor *met = RG_NEW(visitor, count);
    rg_exchange_send(x, sizeof *met, l->visitor, met);
    qsort(met, count, sizeof *met, by_cell);
    for (size_t i = 0; i < count; i++) {
        for (size_t k = i + 1; k < count && met[k].at.cell == met[i].at.cell; k++) {
            compare(&met[i], &met[k], pair);
        }
    }
    rg_free(met);
    rg_exchange_free(x);
    rg_free(l->visitor);
}

bool rg_overlap_find(const rg_solver *s, const rg_fragment_parts *p, double cell, rg_gid pair[2]) {
    lister l = {.s = s, .p = p, .cell = cell, .recent = RG_NEW(presence, RECENT)};
    rg_gid_map mixed = mixed_cells(&l);
    rg_gid lowest[2] = {INT64_MAX, INT64_MAX};
    l.mixed = &mixed;
    compare_visitors(&l, lowest);
    rg_gid_map_free(&mixed);
    rg_free(l.recent);
    MPI_Allreduce(&lowest[0], &pair[0], 1, MPI_INT64_T, MPI_MIN, s->comm);
    lowest[1] = lowest[0] == pair[0] ? lowest[1] : INT64_MAX;
    MPI_Allreduce(&lowest[1], &pair[1], 1, MPI_INT64_T, MPI_MIN, s->comm);
    return pair[0] != INT64_MAX;
}
