#include "solver/tile.h"

#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "cohesive/facts.h"
#include "solver/stepper.h"

rg_trace_args rg_tile_traces(const rg_solver *s, const rg_tile *t, const rg_workspace *w, bool next) {
    const rg_domain *d = s->domain;
    const rg_stepper *m = s->stepper;
    rg_real *rows = m->rows[next ? 1 - m->current : m->current];
    return (rg_trace_args){.u = s->u + t->begin * RG_NODE_BLOCK,
                           .traction = w->traction,
                           .side = d->side[0] + t->sbegin * RG_LANES,
                           .other = d->side[1] + t->sbegin * RG_LANES,
                           .rows = rows,
                           .own_rows = rows + t->row * RG_TRACE_ROW,
                           .own_tractions = m->tractions + t->row * RG_TILE_FACE_ROW,
                           .ghost = w->ghost};
}

static rg_real *history_of(const rg_solver *s, const rg_tile *t) {
    return s->history == NULL ? NULL : s->history + t->begin * s->model->history_stride;
}

const rg_material *rg_block_ready(const rg_solver *s, const rg_tile *t, size_t block) {
    return &s->stepper->material[s->domain->material[t->begin + block]];
}

rg_bulk_args rg_tile_bulk(const rg_solver *s, const rg_tile *t, const rg_workspace *w, size_t block) {
    const rg_domain *d = s->domain;
    return (rg_bulk_args){.material = *rg_block_ready(s, t, block),
                          .gradient = s->model->gradient,
                          .u = s->u + t->begin * RG_NODE_BLOCK,
                          .ghost = w->ghost,
                          .geom = d->geom + t->begin * RG_GEOM_BLOCK,
                          .neighbour = d->neighbour + t->begin * RG_LINK_BLOCK,
                          .interface = d->interface + t->begin * RG_LINK_BLOCK,
                          .cracked = s->cracked + t->begin,
                          .unlinked = s->unlinked + t->ibegin * RG_LANES,
                          .turn = d->turn == NULL ? NULL : d->turn + t->begin * RG_TURN_BLOCK,
                          .history = history_of(s, t),
                          .history_stride = s->model->history_stride,
                          .thermal = s->thermal == NULL ? NULL : s->thermal + t->begin * RG_THERMAL_BLOCK,
                          .force = w->force,
                          .traction = w->traction,
                          .stiffening = s->stiffening + t->begin * RG_LANES};
}

void rg_tile_bulk_state(const rg_solver *s, const rg_tile *t, const rg_bulk_state_args *args, size_t begin,
                        size_t end) {
    s->kernels->bulk_state(args, begin, end);
    if (s->prestress != NULL) {
        rg_prestress_state_args before = {args, s->prestress + t->begin * RG_PRESTRESS_BLOCK};
        s->kernels->prestress_state(&before, begin, end);
    }
}

void rg_tile_state(const rg_solver *s, const rg_tile *t, const rg_workspace *w, double *energy,
                   double *cauchy, double *internal) {
    const size_t points = RG_GAUSS * RG_LANES;
    rg_bulk_args bulk = rg_tile_bulk(s, t, w, 0);
    for (size_t begin = 0, end; begin < rg_tile_eblocks(t); begin = end) {
        end = rg_run_end(s->domain, t, begin);
        bulk.material = *rg_block_ready(s, t, begin);
        rg_bulk_state_args args = {.bulk = &bulk,
                                   .energy = energy == NULL ? NULL : energy + begin * RG_LANES,
                                   .cauchy = cauchy == NULL ? NULL : cauchy + begin * points * 6,
                                   .internal =
                                       internal == NULL ? NULL : internal + begin * points * RG_INTERNAL};
        rg_tile_bulk_state(s, t, &args, begin, end);
        if (internal != NULL && rg_material_values(&bulk.material) == 0) {
            memset(args.internal, 0, (end - begin) * points * RG_INTERNAL * sizeof *internal);
        }
    }
}

static const rg_real *of_faces(const rg_real *field, size_t first) {
    return field == NULL ? NULL : field + first;
}

rg_interface_args rg_tile_interfaces(const rg_solver *s, const rg_tile *t, const rg_workspace *w) {
    const rg_domain *d = s->domain;
    size_t first = t->ibegin * RG_LANES;
    return (rg_interface_args){.law = s->model->law,
                               .time = s->time,
                               .step = s->dt,
                               .u = s->u + t->begin * RG_NODE_BLOCK,
                               .traction = w->traction,
                               .first_tile_face = rg_tile_inner_blocks(t),
                               .ghost = w->ghost,
                               .own_tractions = s->stepper->tractions + t->row * RG_TILE_FACE_ROW,
                               .tractions = s->stepper->tractions,
                               .side = {d->side[0] + first, d->side[1] + first},
                               .geom = d->igeom + t->ibegin * RG_IGEOM_BLOCK,
                               .scale = s->model->scale == NULL ? NULL
                                                                : s->model->scale + t->ibegin * 2 * RG_LANES,
                               .beta = of_faces(s->model->beta, first),
                               .friction = of_faces(s->model->friction, first),
                               .rise = of_faces(s->model->rise, first),
                               .broken = s->broken + first,
                               .unlinked = s->unlinked + first,
                               .active = s->active + t->ibegin,
                               .crack = s->crack + t->ibegin * s->model->crack_stride,
                               .crack_stride = s->model->crack_stride,
                               .force = w->iforce,
                               .turn = w->turn};
}

static bool is_mixed(const rg_cohesive *law) {
    return law->law != RG_LAW_NONE &&
           (rg_law_facts_of(law->law, law->shape, law->beta).forms & RG_MIXED) != 0;
}

bool rg_face_is_open(const rg_solver *s, size_t i) {
    return s->model->scale != NULL && !(s->model->scale[i / RG_LANES * 2 * RG_LANES + i % RG_LANES] > 0);
}

static rg_real *risen(const rg_solver *s, size_t i, int q) {
    return s->crack + rg_rise_index(&s->model->law, i, q, RG_RISE_FACTOR, s->model->crack_stride);
}

double rg_separation(const rg_solver *s, size_t i, int q) {
    const rg_real *scale =
        s->model->scale == NULL ? NULL : s->model->scale + (i / RG_LANES * 2 + 1) * RG_LANES;
    double whole = s->model->law.separation * (scale == NULL ? 1 : scale[i % RG_LANES]);
    if (s->model->law.rise.rate > 0) {
        whole /= fmax(1, *risen(s, i, q));
    }
    return is_mixed(&s->model->law) ? whole * (1 + rg_law_memory(s, i, q)) : whole;
}

bool rg_face_is_marked(const rg_solver *s, size_t i) {
    bool marked = s->broken[i] != 0;
    for (int q = 0; s->model->law.rise.rate > 0 && q < RG_POINTS; q++) {
        marked = marked || *risen(s, i, q) > 0;
    }
    return marked;
}

void rg_faces_forget(rg_solver *s) {
    memset(s->broken, 0, s->domain->iblocks * RG_LANES);
    for (size_t i = 0; s->model->law.rise.rate > 0 && i < s->domain->iblocks * RG_LANES; i++) {
        for (int q = 0; q < RG_POINTS; q++) {
            *risen(s, i, q) = 0;
        }
    }
}

bool rg_point_is_broken(const rg_solver *s, size_t i, int q) {
    bool cohesive = s->broken[i] >> q & 1;
    return cohesive && (s->model->law.form != RG_FORM_INTRINSIC ||
                        *rg_crack_value(s, i, q, RG_CRACK_OPENING) >= rg_separation(s, i, q));
}

bool rg_face_is_broken(const rg_solver *s, size_t i) {
    for (int q = 0; s->broken[i] && q < RG_POINTS; q++) {
        if (rg_point_is_broken(s, i, q)) {
            return true;
        }
    }
    return false;
}

void rg_tile_receive(const rg_solver *s, const rg_tile *t, const rg_workspace *w) {
    rg_trace_args traces = rg_tile_traces(s, t, w, false);
    s->kernels->receive(&traces, 0, rg_tile_face_blocks(t));
}

rg_workspace rg_workspace_make(const rg_domain *d) {
    return (rg_workspace){.force = RG_NEW(rg_real, d->tile_blocks * RG_NODE_BLOCK),
                          .traction = RG_NEW(rg_real, d->tile_blocks * RG_TRACTION_BLOCK),
                          .iforce = RG_NEW(rg_real, d->tile_iblocks * RG_IFORCE_BLOCK),
                          .turn = RG_NEW(rg_real, d->tile_iblocks * RG_IFORCE_BLOCK),
                          .ghost = RG_NEW(rg_real, d->tile_sblocks * RG_GHOST_BLOCK)};
}

void rg_workspace_free(rg_workspace *w) {
    rg_free(w->force);
    rg_free(w->traction);
    rg_free(w->iforce);
    rg_free(w->turn);
    rg_free(w->ghost);
}

rg_real rg_tile_trace(const rg_solver *s, const rg_tile *t, size_t i, int k, int a, int c) {
    int32_t link = s->domain->side[k][i];
    if (i >= t->sbegin * RG_LANES) {
        int32_t other = s->domain->side[1][i];
        if (k != other % 2) { /* not the own side */
            return s->stepper
                ->rows[s->stepper->current][(size_t)(other / 2) * RG_TRACE_ROW + (size_t)(3 * a + c)];
        }
        link = s->domain->side[0][i];
    }
    size_t element = t->begin * RG_LANES + (size_t)link / RG_FACES;
    return s->u[rg_node_index(element, rg_face_node[link % RG_FACES][a], c)];
}
