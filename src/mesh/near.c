/* Boxes are sorted into cubic cells; those that hold boxes of several parts are looked at. */
#include "mesh/near.h"

#include <math.h>
#include <stdbool.h>

#include "base/mem.h"

enum { EMPTY = -1, MIXED = -2 };

typedef struct {
    double low[3], edge;
    int64_t cells[3];
} grid;

static int64_t cell_count(const grid *g) {
    return g->cells[0] * g->cells[1] * g->cells[2];
}

/* Cells about as wide as the mean box, not many more of them than boxes. */
static grid make_grid(const rg_near_box *box, int64_t count) {
    grid g = {.edge = 0};
    double length[3], most = 0;
    for (int c = 0; c < 3; c++) {
        double high = -INFINITY;
        g.low[c] = INFINITY;
        for (int64_t i = 0; i < count; i++) {
            g.low[c] = fmin(g.low[c], box[i].low[c]);
            high = fmax(high, box[i].high[c]);
            g.edge += (box[i].high[c] - box[i].low[c]) / (3 * (double)count);
        }
        length[c] = high - g.low[c];
        most = fmax(most, length[c]);
    }
    g.edge = fmax(g.edge, most * 0x1p-20);
    for (;; g.edge *= 1.25) {
        double cells = 1;
        for (int c = 0; c < 3; c++) {
            cells *= floor(length[c] / g.edge) + 1;
        }
        if (cells <= 4 * (double)count + 64) {
            break;
        }
    }
    for (int c = 0; c < 3; c++) {
        g.cells[c] = (int64_t)(length[c] / g.edge) + 1;
    }
    return g;
}

static int64_t cell_along(const grid *g, int axis, double x) {
    int64_t at = (int64_t)((x - g->low[axis]) / g->edge);
    return at < g->cells[axis] ? at : g->cells[axis] - 1;
}

static int64_t cell_at(const grid *g, const int64_t at[3]) {
    return (at[2] * g->cells[1] + at[1]) * g->cells[0] + at[0];
}

/* The cell in which two boxes that meet are looked at: that of the lower corner of what they share. */
static int64_t home(const grid *g, const rg_near_box *a, const rg_near_box *b) {
    int64_t at[3];
    for (int c = 0; c < 3; c++) {
        at[c] = cell_along(g, c, fmax(a->low[c], b->low[c]));
    }
    return cell_at(g, at);
}

/* What is done with the cells of a box: they learn its part, or count it, or list it. */
typedef struct {
    grid g;
    int32_t *part;  /* [cells] */
    int64_t *start; /* [cells + 1] */
    int64_t *list;  /* boxes of mixed cells */
} cells;

typedef enum { MARK, COUNT, LIST } pass;

static void enter(cells *k, const rg_near_box *box, int64_t i, pass p) {
    int64_t at[3], low[3], high[3];
    for (int c = 0; c < 3; c++) {
        low[c] = cell_along(&k->g, c, box[i].low[c]);
        high[c] = cell_along(&k->g, c, box[i].high[c]);
    }
    for (at[2] = low[2]; at[2] <= high[2]; at[2]++) {
        for (at[1] = low[1]; at[1] <= high[1]; at[1]++) {
            for (at[0] = low[0]; at[0] <= high[0]; at[0]++) {
                int64_t cell = cell_at(&k->g, at);
                if (p == MARK) {
                    bool other = k->part[cell] != EMPTY && k->part[cell] != box[i].part;
                    k->part[cell] = other ? MIXED : box[i].part;
                } else if (k->part[cell] == MIXED && p == COUNT) {
                    k->start[cell + 1]++;
                } else if (k->part[cell] == MIXED) {
                    k->list[k->start[cell]++] = i;
                }
            }
        }
    }
}

static bool meet(const rg_near_box *a, const rg_near_box *b) {
    bool apart = a->part == b->part;
    for (int c = 0; c < 3 && !apart; c++) {
        apart = a->low[c] > b->high[c] || b->low[c] > a->high[c];
    }
    return !apart;
}

void rg_near_pairs(const rg_near_box *box, int64_t count, void (*visit)(void *context, int64_t i, int64_t j),
                   void *context) {
    if (count == 0) {
        return;
    }
    cells k = {.g = make_grid(box, count)};
    int64_t number = cell_count(&k.g), begin = 0;
    k.part = RG_NEW(int32_t, (size_t)number);
    k.start = RG_NEW(int64_t, (size_t)number + 1);
    for (int64_t cell = 0; cell < number; cell++) {
        k.part[cell] = EMPTY;
    }
    for (pass p = MARK; p <= LIST; p++) {
        for (int64_t i = 0; i < count; i++) {
            enter(&k, box, i, p);
        }
        for (int64_t cell = 0; cell < number && p == COUNT; cell++) {
            k.start[cell + 1] += k.start[cell];
        }
        k.list = p == COUNT ? RG_NEW(int64_t, (size_t)k.start[number] + 1) : k.list;
    }
    for (int64_t cell = 0; cell < number; cell++) { /* each start has become the end by now */
        for (int64_t a = begin; a < k.start[cell]; a++) {
            for (int64_t b = a + 1; b < k.start[cell]; b++) {
                const rg_near_box *p = &box[k.list[a]], *q = &box[k.list[b]];
                if (meet(p, q) && home(&k.g, p, q) == cell) {
                    bool ordered = p->part < q->part;
                    visit(context, k.list[ordered ? a : b], k.list[ordered ? b : a]);
                }
            }
        }
        begin = k.start[cell];
    }
    rg_free(k.part);
    rg_free(k.start);
    rg_free(k.list);
}
