/* A tile as the kernels see it: their arguments, with all pointers to the tile's first block. */
#ifndef RG_TILE_H
#define RG_TILE_H

#include "solver/solver.h"

/* Blocks of a tile: elements, interfaces inside, tile-boundary faces. */
static inline size_t rg_tile_eblocks(const rg_tile *t) {
    return t->end - t->begin;
}

static inline size_t rg_tile_inner_blocks(const rg_tile *t) {
    return t->sbegin - t->ibegin;
}

static inline size_t rg_tile_iblocks(const rg_tile *t) {
    return t->iend - t->ibegin;
}

static inline size_t rg_tile_face_blocks(const rg_tile *t) {
    return t->iend - t->sbegin;
}

/* Trace rows go out to the current ones, or to those of the next state. */
rg_trace_args rg_tile_traces(const rg_solver *s, const rg_tile *t, const rg_workspace *w, bool next);

/* For blocks of the material of block `block`, counted from the tile's first one; that material, readied for
 * the step. */
const rg_material *rg_block_ready(const rg_solver *s, const rg_tile *t, size_t block);
rg_bulk_args rg_tile_bulk(const rg_solver *s, const rg_tile *t, const rg_workspace *w, size_t block);

/* The state of blocks by such arguments, with the stress that was there before. */
void rg_tile_bulk_state(const rg_solver *s, const rg_tile *t, const rg_bulk_state_args *args, size_t begin,
                        size_t end);
rg_interface_args rg_tile_interfaces(const rg_solver *s, const rg_tile *t, const rg_workspace *w);

/* State of all elements of a tile whose traces have been received: as in rg_bulk_state_args, the first row is
 * of the tile's first block; `internal` is 0 where the material has no history. */
void rg_tile_state(const rg_solver *s, const rg_tile *t, const rg_workspace *w, double *energy,
                   double *cauchy, double *internal);

/* Material, at rest, of a block of a tile, counted from its first one, and of an element. */
static inline const rg_material *rg_block_material(const rg_solver *s, const rg_tile *t, size_t block) {
    return &s->model->material[s->domain->material[t->begin + block]];
}

static inline const rg_material *rg_material_of(const rg_solver *s, size_t slot) {
    return &s->model->material[s->domain->material[slot / RG_LANES]];
}

/* Value `row` (layout.h) of the history of an element, whose material has one. */
static inline rg_real rg_history_value(const rg_solver *s, size_t slot, size_t row) {
    return s->history[rg_history_index(slot, s->model->history_stride, row)];
}

/* Value k (RG_CRACK_OPENING...) of the crack state of point q of interface i. */
static inline rg_real *rg_crack_value(const rg_solver *s, size_t i, int q, int k) {
    return s->crack + i / RG_LANES * s->model->crack_stride + rg_crack_index(i % RG_LANES, q, k);
}

/* First value that a law remembers there; only where it remembers one alone. */
static inline rg_real rg_law_memory(const rg_solver *s, size_t i, int q) {
    return s
        ->crack[i / RG_LANES * s->model->crack_stride + RG_CRACK_BLOCK + (size_t)q * RG_LANES + i % RG_LANES];
}

/* Value k (RG_FRICTION_ANCHOR...) of friction there; only where the law has some. */
static inline rg_real *rg_friction_value(const rg_solver *s, size_t i, int q, int k) {
    return s->crack + rg_friction_index(i, q, k, s->model->crack_stride);
}

/* Whether point q of interface i is broken: it has switched to its law, or in the intrinsic form, where all
 * points follow theirs from the start, it is fully separated. */
bool rg_point_is_broken(const rg_solver *s, size_t i, int q);

/* Whether interface i is open from the start: it has no strength. */
bool rg_face_is_open(const rg_solver *s, size_t i);

/* Opening of full separation at point q of interface i (m), which is broken if the law is RG_MIXED. */
double rg_separation(const rg_solver *s, size_t i, int q);

/* Whether interface i has a state of its own: some point has broken, or has been tested for a strength that
 * rises with the rate of stress. */
bool rg_face_is_marked(const rg_solver *s, size_t i);

/* Takes that back from all faces. */
void rg_faces_forget(rg_solver *s);

/* Some point of interface i is broken. */
bool rg_face_is_broken(const rg_solver *s, size_t i);

/* Collects the traces of the tile's other sides into the workspace. */
void rg_tile_receive(const rg_solver *s, const rg_tile *t, const rg_workspace *w);

/* Room for the largest tile of a domain. Free with rg_workspace_free. */
rg_workspace rg_workspace_make(const rg_domain *d);
void rg_workspace_free(rg_workspace *w);

/* Displacement component c at node a of interface i (of tile t) on side k: 0 minus, 1 plus. */
rg_real rg_tile_trace(const rg_solver *s, const rg_tile *t, size_t i, int k, int a, int c);

#endif
