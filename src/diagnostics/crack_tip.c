#include "diagnostics/crack_tip.h"

#include <float.h>
#include <math.h>
#include <omp.h>

#include "base/mem.h"
#include "base/vector.h"
#include "quadrature.h"
#include "solver/selection.h"
#include "solver/tile.h"

enum { COLUMNS = 2 };

/* Doubles only: a checkpoint takes them as a row. */
typedef struct {
    double place, time; /* where the speed was taken last (m, s); place -DBL_MAX: there has been no tip */
    double speed;       /* m/s */
} memory;

struct rg_crack_tips {
    const rg_case *input;
    const rg_domain *domain;
    MPI_Comm comm;
    int count, threads, samples;
    uint8_t **faces;    /* [count]: bits of the faces of each element that it looks at */
    rg_selected *on;    /* [count]: these, of one side */
    double (*along)[3]; /* [count]: unit vectors */
    memory *is;         /* [count] */
    double *now;        /* [threads][count]: furthest */
    double *furthest;   /* [capacity][count] */
    double *row;        /* [capacity][columns] */
};

/* Place of reference of point q (quadrature.h) of a face, along a line. */
static double place_of(const rg_domain *d, size_t slot, int face, int q, const double along[3]) {
    const double p = q < RG_FCORNERS ? RG_TRI_P0 : RG_TRI_P1;
    double sum = 0;
    for (int k = 0; k < RG_FCORNERS; k++) {
        const double *corner = d->corner + 12 * slot + 3 * rg_face_node[face][k];
        sum += (k == q % RG_FCORNERS ? 1 - 2 * p : p) * rg_vector_dot(along, corner);
    }
    return sum;
}

static bool has_separated(const rg_solver *s, size_t i, int q) {
    return rg_point_is_broken(s, i, q) &&
           *rg_crack_value(s, i, q, RG_CRACK_OPENING) >= rg_separation(s, i, q);
}

bool rg_crack_tips_want(const rg_crack_tips *r, size_t tile) {
    return r->count > 0 && r->domain->tile[tile].ibegin < r->domain->tile[tile].iend;
}

static void look(rg_crack_tips *r, const rg_solver *s, const rg_tile *t, size_t i) {
    size_t link = (size_t)s->domain->side[0][i], slot = t->begin * RG_LANES + link / RG_FACES;
    int face = (int)(link % RG_FACES);
    for (int q = 0; s->broken[i] != 0 && q < RG_POINTS; q++) {
        if (!has_separated(s, i, q)) {
            continue;
        }
        for (int k = 0; k < r->count; k++) {
            double *here = &r->now[omp_get_thread_num() * r->count + k];
            if ((r->faces[k][slot] >> face & 1) != 0) {
                *here = fmax(*here, place_of(s->domain, slot, face, q, r->along[k]));
            }
        }
    }
}

void rg_crack_tips_watch(rg_crack_tips *r, const rg_solver *s, size_t tile) {
    const rg_tile *t = &s->domain->tile[tile];
    for (size_t b = t->ibegin; r->count > 0 && b < t->iend; b++) {
        for (size_t i = b * RG_LANES; s->active[b] && i < (b + 1) * RG_LANES; i++) {
            look(r, s, t, i);
        }
    }
}

static void clear(rg_crack_tips *r) {
    for (int i = 0; i < r->threads * r->count; i++) {
        r->now[i] = -DBL_MAX;
    }
}

void rg_crack_tips_next(rg_crack_tips *r) {
    double *out = r->furthest + r->samples++ * r->count;
    for (int k = 0; k < r->count; k++) {
        out[k] = -DBL_MAX;
        for (int t = 0; t < r->threads; t++) {
            out[k] = fmax(out[k], r->now[t * r->count + k]);
        }
    }
    clear(r);
}

double rg_crack_tips_furthest(const rg_crack_tips *r, int k) {
    return r->furthest[(r->samples - 1) * r->count + k];
}

const double *rg_crack_tips_along(const rg_crack_tips *r, int k) {
    return r->along[k];
}

/* Takes the speed of a tip that has come far enough. */
static void take_speed(memory *is, double place, double time, double distance) {
    if (!(place > -DBL_MAX) ||
        (is->place > -DBL_MAX && !(place > is->place && place - is->place >= distance))) {
        return;
    }
    is->speed = is->place > -DBL_MAX ? (place - is->place) / (time - is->time) : 0;
    is->place = place;
    is->time = time;
}

const double *rg_crack_tips_collect(rg_crack_tips *r, const double *time) {
    MPI_Allreduce(MPI_IN_PLACE, r->furthest, r->samples * r->count, MPI_DOUBLE, MPI_MAX, r->comm);
    for (int i = 0; i < r->samples * r->count; i++) {
        int k = i % r->count;
        double place = r->furthest[i];
        take_speed(&r->is[k], place, time[i / r->count], r->input->output.crack_tip[k].distance);
        r->row[COLUMNS * i] = place > -DBL_MAX ? place : NAN;
        r->row[COLUMNS * i + 1] = r->is[k].speed;
    }
    r->samples = 0;
    return r->row;
}

rg_crack_tips *rg_crack_tips_make(const rg_solver *s) {
    rg_crack_tips *r = RG_NEW(rg_crack_tips, 1);
    int count = s->input->output.crack_tips;
    *r = (rg_crack_tips){.input = s->input,
                         .domain = s->domain,
                         .comm = s->comm,
                         .count = count,
                         .threads = s->threads,
                         .faces = RG_NEW(uint8_t *, (size_t)count + 1),
                         .on = RG_NEW(rg_selected, (size_t)count + 1),
                         .along = rg_alloc((size_t)count + 1, sizeof *r->along),
                         .is = RG_NEW(memory, (size_t)count + 1)};
    for (int k = 0; k < count; k++) {
        const rg_crack_tip_input *in = &s->input->output.crack_tip[k];
        rg_selection of = {"output.crack_tips", k, in->set, in->where, true};
        r->faces[k] = rg_selection_faces(&of, s->input, s->domain, s->part, s->comm);
        r->on[k] = rg_selection_measure(r->faces[k], false, s->input, s->domain, s->comm);
        r->on[k].count /= 2;
        r->on[k].size /= 2;
        double length = sqrt(rg_vector_dot(in->direction, in->direction));
        for (int c = 0; c < 3; c++) {
            r->along[k][c] = in->direction[c] / length;
        }
        r->is[k].place = -DBL_MAX;
    }
    return r;
}

void rg_crack_tips_open(rg_crack_tips *r, int capacity) {
    size_t rows = (size_t)(capacity * r->count);
    r->now = RG_NEW(double, (size_t)(r->threads * r->count) + 1);
    r->furthest = RG_NEW(double, rows + 1);
    r->row = RG_NEW(double, COLUMNS *rows + 1);
    clear(r);
}

int rg_crack_tips_columns(const rg_crack_tips *r) {
    return COLUMNS * r->count;
}

void rg_crack_tips_header(const rg_crack_tips *r, FILE *out) {
    for (int k = 0; k < r->count; k++) {
        const char *name = r->input->output.crack_tip[k].name;
        fprintf(out, ",%s_tip,%s_speed", name, name);
    }
}

void rg_crack_tips_print(const rg_crack_tips *r, FILE *out) {
    for (int k = 0; k < r->count; k++) {
        char on[200];
        rg_selected_tell(&r->on[k], false, on, sizeof on);
        fprintf(out, "crack tip      %s: along (%.4g, %.4g, %.4g), on %s\n",
                r->input->output.crack_tip[k].name, r->along[k][0], r->along[k][1], r->along[k][2], on);
    }
}

void rg_crack_tips_register(rg_crack_tips *r, rg_state *st) {
    if (r->count > 0) {
        rg_state_add_rows(st, "crack_tips", RG_STATE_DOUBLE, (int)(sizeof(memory) / sizeof(double)),
                          &r->is[0].place, sizeof(memory), (size_t)r->count);
    }
}

void rg_crack_tips_free(rg_crack_tips *r) {
    if (r != NULL) {
        for (int k = 0; k < r->count; k++) {
            rg_free(r->faces[k]);
        }
        void *blocks[] = {r->faces, r->on, r->along, r->is, r->now, r->furthest, r->row, r};
        for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
            rg_free(blocks[i]);
        }
    }
}
