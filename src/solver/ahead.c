/* Between two cache misses of a kernel lie hundreds of vector operations, so a core that computes waits for
 * one miss at a time, and each array of a tile is a stream that begins anew at every tile. A loop that does
 * nothing but load has as many misses under way as the core has room for. They are loads, not prefetches:
 * where there is no room, a prefetch is dropped (perf/README.md, "What was tried"). */
#include "solver/ahead.h"

#include "solver/stepper.h"

enum { LINE = 64 };

static void load(const void *from, size_t bytes) {
    const volatile char *at = from;
    for (size_t k = 0; k < bytes; k += LINE) {
        (void)at[k];
    }
}

/* Blocks begin to end of a field with so many values a block. */
#define LOAD(field, values, begin, end)                                                                      \
    load((field) + (begin) * (values), ((end) - (begin)) * (values) * sizeof *(field))

/* Rows of the other side of a tile's tile-boundary faces, anywhere in memory. */
static void load_rows(const rg_domain *d, const rg_tile *t, const rg_real *rows, size_t values) {
    for (size_t i = t->sbegin * RG_LANES; i < t->iend * RG_LANES; i++) {
        const rg_real *row = rows + (size_t)((uint32_t)d->side[1][i] / 2) * values;
        load(row, values * sizeof *row);
        load(row + values - 1, sizeof *row);
    }
}

/* Crack state of faces with broken points. */
static void load_cracks(const rg_solver *s, size_t begin, size_t end) {
    for (size_t b = begin; b < end; b++) {
        if (s->active[b]) {
            LOAD(s->crack, s->model->crack_stride, b, b + 1);
        }
    }
}

void rg_ahead_of_elements(const rg_solver *s, const rg_tile *t) {
    const rg_domain *d = s->domain;
    LOAD(d->side[1], RG_LANES, t->ibegin, t->iend);
    load_rows(d, t, s->stepper->rows[s->stepper->current], RG_TRACE_ROW);
    LOAD(s->u, RG_NODE_BLOCK, t->begin, t->end);
    LOAD(d->geom, RG_GEOM_BLOCK, t->begin, t->end);
    LOAD(d->neighbour, RG_LINK_BLOCK, t->begin, t->end);
    LOAD(d->interface, RG_LINK_BLOCK, t->begin, t->end);
    if (d->turn != NULL) {
        LOAD(d->turn, RG_TURN_BLOCK, t->begin, t->end);
    }
    if (s->history != NULL) {
        LOAD(s->history, s->model->history_stride, t->begin, t->end);
    }
    LOAD(d->side[0], RG_LANES, t->ibegin, t->iend);
    LOAD(d->igeom, RG_IGEOM_BLOCK, t->ibegin, t->sbegin);
    LOAD(s->unlinked, RG_LANES, t->ibegin, t->iend);
    LOAD(s->broken, RG_LANES, t->ibegin, t->iend);
    LOAD(s->active, 1, t->ibegin, t->iend);
    load_cracks(s, t->ibegin, t->sbegin);
    LOAD(s->velocity, RG_NODE_BLOCK, t->begin, t->end);
}

void rg_ahead_of_boundary(const rg_solver *s, const rg_tile *t) {
    const rg_domain *d = s->domain;
    const rg_stepper *m = s->stepper;
    size_t rows = (t->iend - t->sbegin) * RG_LANES;
    LOAD(d->side[1], RG_LANES, t->sbegin, t->iend);
    load_rows(d, t, m->tractions, RG_TILE_FACE_ROW);
    load_rows(d, t, m->rows[m->current], RG_TRACE_ROW);
    LOAD(m->tractions, RG_TILE_FACE_ROW, t->row, t->row + rows);
    LOAD(d->side[0], RG_LANES, t->sbegin, t->iend);
    LOAD(d->igeom, RG_IGEOM_BLOCK, t->sbegin, t->iend);
    LOAD(s->broken, RG_LANES, t->sbegin, t->iend);
    load_cracks(s, t->sbegin, t->iend);
    LOAD(s->u, RG_NODE_BLOCK, t->begin, t->end);
    LOAD(s->velocity, RG_NODE_BLOCK, t->begin, t->end);
    for (size_t b = t->begin; b < t->end; b++) {
        if (d->rim[b]) {
            LOAD(d->interface, RG_LINK_BLOCK, b, b + 1);
            load(d->geom + b * RG_GEOM_BLOCK + RG_GEOM_VOLUME * RG_LANES, RG_LANES * sizeof *d->geom);
        }
    }
    LOAD(m->rows[1 - m->current], RG_TRACE_ROW, t->row, t->row + rows); /* to be written */
}
