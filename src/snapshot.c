#include "snapshot.h"

#include <math.h>
#include <omp.h>
#include <string.h>

#include "crack_surface.h"
#include "element.h"
#include "error.h"
#include "mem.h"
#include "principal.h"
#include "tile.h"

enum { NODAL = 3 * RG_NODES }; /* values of the largest record */

/* Output is right-handed: where the sorted corners are not, corners 0 and 1 change places. */
static const int plain[RG_NODES] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
static const int mirrored[RG_NODES] = {1, 0, 2, 3, 4, 6, 5, 8, 7, 9};

static const int *output_order(const double *corner) {
    double e[3][3], det = 0;
    for (int k = 0; k < 3; k++) {
        for (int c = 0; c < 3; c++) {
            e[k][c] = corner[3 * (k + 1) + c] - corner[c];
        }
    }
    for (int c = 0; c < 3; c++) {
        int p = (c + 1) % 3, q = (c + 2) % 3;
        det += e[0][c] * (e[1][p] * e[2][q] - e[1][q] * e[2][p]);
    }
    return det > 0 ? plain : mirrored;
}

static void send(rg_snapshots *w, int values) {
    rg_slab_send(w->slab, values, w->record, w->sorted);
}

static void collect_positions(rg_snapshots *w, const rg_solver *s) {
    for (size_t i = 0; i < w->slab->own; i++) {
        const double *corner = s->domain->corner + 12 * (size_t)w->slab->slot[i];
        const int *order = output_order(corner);
        for (int n = 0; n < RG_NODES; n++) {
            rg_node_position(corner, order[n], w->record + i * NODAL + 3 * n);
        }
    }
    send(w, NODAL);
}

/* ---- region ---- */

static bool in_region(const rg_expr *region, const double *points, int count) {
    double x[3] = {0, 0, 0};
    for (int i = 0; i < 3 * count; i++) {
        x[i % 3] += points[i] / count;
    }
    return region == NULL || rg_expr_value(region, x, 0) != 0;
}

/* From the positions in `sorted`: which elements are written, and their numbers among all that are. */
static void choose(rg_snapshots *w, const rg_solver *s) {
    w->row = RG_NEW(size_t, w->slab->count + 1);
    for (size_t i = 0; i < w->slab->count; i++) {
        if (in_region(s->input->output.region, w->sorted + i * NODAL, 4)) { /* corners: at the centroid */
            w->row[w->written++] = i;
        }
    }
    int64_t count = (int64_t)w->written;
    MPI_Scan(&count, &w->first, 1, MPI_INT64_T, MPI_SUM, s->comm);
    w->first -= count;
    MPI_Allreduce(&count, &w->total, 1, MPI_INT64_T, MPI_SUM, s->comm);
    if (w->total == 0 && s->rank > 0) {
        MPI_Barrier(s->comm); /* rank 0 speaks and ends the job */
    }
    if (w->total == 0) {
        rg_fatal(RG_USAGE, "%s: output.region: %s: no element is in it", s->input->path,
                 rg_expr_text(s->input->output.region));
    }
}

/* Keeps of `values` for each row of the slab those of the elements that are written. */
static void keep_region(const rg_snapshots *w, size_t values, double *data) {
    for (size_t i = 0; w->written < w->slab->count && i < w->written; i++) {
        memmove(data + i * values, data + w->row[i] * values, values * sizeof *data);
    }
}

/* ---- files ---- */

static rg_writer_style style_of(const rg_case *c) {
    return (rg_writer_style){c->output.precision == RG_OUTPUT_SINGLE, (int)c->output.compression};
}

/* All but the writer; the positions are in `sorted`. */
static rg_snapshots *prepare(const rg_solver *s, rg_slab **slab) {
    rg_snapshots *w = RG_NEW(rg_snapshots, 1);
    w->fields = s->input->output.fields;
    if (w->fields != 0) {
        w->slab = rg_slab_shared(slab, s->domain, s->part->total, s->comm);
        w->record = RG_NEW(double, w->slab->own *NODAL + 1);
        w->sorted = RG_NEW(double, w->slab->count *NODAL + 1);
        collect_positions(w, s);
        choose(w, s);
        keep_region(w, NODAL, w->sorted);
    }
    return w;
}

rg_snapshots *rg_snapshots_open(const rg_solver *s, rg_slab **slab) {
    rg_snapshots *w = prepare(s, slab);
    if (w->fields != 0) {
        w->writer = rg_writer_open(s->input->output.dir, s->comm, style_of(s->input), w->total, w->first,
                                   (int64_t)w->written, w->sorted);
    }
    return w;
}

rg_snapshots *rg_snapshots_reopen(const rg_solver *s, rg_slab **slab, const rg_writer_mark *mark) {
    rg_snapshots *w = prepare(s, slab);
    if (w->fields != 0) {
        w->writer = rg_writer_resume(s->input->output.dir, s->comm, style_of(s->input), w->total, w->first,
                                     (int64_t)w->written, mark);
    }
    return w;
}

rg_writer_mark rg_snapshots_settle(rg_snapshots *w) {
    if (w->fields == 0) {
        return (rg_writer_mark){0};
    }
    rg_writer_sync(w->writer);
    return rg_writer_stand(w->writer);
}

/* ---- fields ---- */

static void write_nodal(rg_snapshots *w, const rg_solver *s, const char *name, const char *unit,
                        const rg_real *field) {
    for (size_t i = 0; i < w->slab->own; i++) {
        size_t slot = (size_t)w->slab->slot[i];
        const int *order = output_order(s->domain->corner + 12 * slot);
        for (int k = 0; k < NODAL; k++) {
            w->record[i * NODAL + (size_t)k] = field[rg_node_index(slot, order[k / 3], k % 3)];
        }
    }
    send(w, NODAL);
    keep_region(w, NODAL, w->sorted);
    rg_writer_volume(w->writer, name, unit, RG_CENTER_NODE, 3, w->sorted);
}

/* What an element puts out of its state: mean Cauchy stress, mean stress, principal stresses, triaxiality,
 * damage, regime, plastic strain. */
enum {
    STRESS = 0,
    MEAN = 6,
    PRINCIPAL = 7,
    TRIAXIALITY = 10,
    INTERNAL = 11,
    STATE = INTERNAL + RG_INTERNAL,
};

/* Fields made of them. */
static const struct {
    unsigned bit;
    const char *name, *unit;
    int from, components;
} state_field[] = {
    {RG_FIELD_STRESS, "stress", "Pa", STRESS, 6},
    {RG_FIELD_MEAN, "mean_stress", "Pa", MEAN, 1},
    {RG_FIELD_PRINCIPAL, "principal_stress", "Pa", PRINCIPAL, 3},
    {RG_FIELD_DAMAGE, "damage", "1", INTERNAL + RG_INTERNAL_DAMAGE, 1},
    {RG_FIELD_REGIME, "regime", "1", INTERNAL + RG_INTERNAL_REGIME, 1},
    {RG_FIELD_PLASTIC, "plastic_strain", "1", INTERNAL + RG_INTERNAL_PLASTIC, 1},
    {RG_FIELD_TRIAXIALITY, "triaxiality", "1", TRIAXIALITY, 1},
};
enum { STATE_FIELDS = sizeof state_field / sizeof *state_field };

/* Mean over von Mises stress; 0 where there is no stress, infinite where there is no shear alone. */
static double triaxiality(const double s[6], double mean) {
    double square = 3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]);
    for (int k = 0; k < 3; k++) {
        square += 1.5 * (s[k] - mean) * (s[k] - mean);
    }
    return mean == 0 ? 0 : mean / sqrt(square);
}

/* Stresses of an element, from those at its Gauss points. */
static void element_stress(const double *cauchy, double out[STATE]) {
    for (size_t k = 0; k < 6; k++) {
        out[k] = 0;
        for (size_t g = 0; g < RG_GAUSS; g++) {
            out[k] += cauchy[(g * 6 + k) * RG_LANES] / RG_GAUSS;
        }
    }
    out[MEAN] = (out[0] + out[1] + out[2]) / 3;
    rg_principal(out, out + PRINCIPAL);
    out[TRIAXIALITY] = triaxiality(out, out[MEAN]);
}

/* Internal variables of an element, likewise: means, and the largest regime. */
static void element_internal(const double *internal, double out[STATE]) {
    for (size_t k = 0; k < RG_INTERNAL; k++) {
        double sum = 0, largest = 0;
        for (size_t g = 0; g < RG_GAUSS; g++) {
            double x = internal[(g * RG_INTERNAL + k) * RG_LANES];
            sum += x / RG_GAUSS;
            largest = fmax(largest, x);
        }
        out[INTERNAL + k] = k == RG_INTERNAL_REGIME ? largest : sum;
    }
}

/* Room for the state at the Gauss points of a tile. */
typedef struct {
    double *cauchy, *internal;
} gauss_state;

/* State of tile t, to its consecutive records. */
static void tile_states(rg_snapshots *w, const rg_solver *s, const rg_tile *t, const gauss_state *g) {
    const rg_workspace *work = &s->work[omp_get_thread_num()];
    size_t row = rg_slab_row(w->slab, s->domain, t->first), at = t->begin * RG_LANES;
    rg_bulk_args bulk = rg_tile_bulk(s, t, work);
    rg_bulk_state_args args = {.bulk = &bulk, .cauchy = g->cauchy, .internal = g->internal};
    rg_tile_receive(s, t, work);
    s->kernels->bulk_state(&args, 0, rg_tile_eblocks(t));
    for (size_t i = 0; at + i < t->end * RG_LANES && s->domain->id[at + i] >= 0; i++) {
        size_t first = i / RG_LANES * RG_GAUSS, lane = i % RG_LANES;
        double *record = w->record + STATE * (row + i);
        element_stress(g->cauchy + first * 6 * RG_LANES + lane, record);
        element_internal(g->internal + first * RG_INTERNAL * RG_LANES + lane, record);
    }
}

static void write_part(rg_snapshots *w, int field, double *part) {
    size_t components = (size_t)state_field[field].components;
    for (size_t i = 0; i < w->written; i++) {
        for (size_t k = 0; k < components; k++) {
            part[i * components + k] = w->sorted[i * STATE + (size_t)state_field[field].from + k];
        }
    }
    rg_writer_volume(w->writer, state_field[field].name, state_field[field].unit, RG_CENTER_CELL,
                     state_field[field].components, part);
}

static bool wants_states(const rg_snapshots *w) {
    unsigned bits = 0;
    for (int k = 0; k < STATE_FIELDS; k++) {
        bits |= state_field[k].bit;
    }
    return (w->fields & bits) != 0;
}

static void write_states(rg_snapshots *w, rg_solver *s) {
    const rg_domain *d = s->domain;
#pragma omp parallel
    {
        size_t points = d->tile_blocks * RG_GAUSS * RG_LANES;
        gauss_state g = {RG_NEW(double, points * 6), RG_NEW(double, points *RG_INTERNAL)};
#pragma omp for schedule(static)
        for (size_t t = 0; t < d->tiles; t++) {
            tile_states(w, s, &d->tile[t], &g);
        }
        rg_free(g.cauchy);
        rg_free(g.internal);
    }
    send(w, STATE);
    keep_region(w, STATE, w->sorted);
    double *part = w->sorted + STATE * w->slab->count; /* behind the values of the elements */
    for (int k = 0; k < STATE_FIELDS; k++) {
        if (w->fields & state_field[k].bit) {
            write_part(w, k, part);
        }
    }
}

/* One number of each own element, in `record`. */
static void write_numbers(rg_snapshots *w, const char *name) {
    send(w, 1);
    keep_region(w, 1, w->sorted);
    rg_writer_volume(w->writer, name, "1", RG_CENTER_CELL, 1, w->sorted);
}

static void write_ranks(rg_snapshots *w, const rg_solver *s) {
    for (size_t i = 0; i < w->slab->own; i++) {
        w->record[i] = s->rank;
    }
    write_numbers(w, "rank");
}

static void write_fragments(rg_snapshots *w, const rg_fragment_parts *p) {
    for (size_t i = 0; i < w->slab->own; i++) {
        w->record[i] = (double)p->label[p->of[w->slab->slot[i]]].id;
    }
    write_numbers(w, "fragment");
}

/* Faces in the region, by their present place; returns how many. */
static size_t keep_faces(const rg_expr *region, size_t count, rg_crack_face *face) {
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        if (in_region(region, &face[i].x[0][0], 3)) {
            face[kept++] = face[i];
        }
    }
    return kept;
}

static void write_cracks(rg_snapshots *w, const rg_solver *s) {
    rg_crack_face *face;
    size_t count = rg_crack_surface(s, &face);
    count = keep_faces(s->input->output.region, count, face);
    double *column = RG_NEW(double, 9 * count + 1);
    for (size_t i = 0; i < 9 * count; i++) {
        column[i] = face[i / 9].x[i % 9 / 3][i % 3];
    }
    rg_writer_surface(w->writer, (int64_t)count, column);
    static const char *const name[] = {"opening", "slip", "damage", "time_of_failure"};
    static const char *const unit[] = {"m", "m", "1", "s"};
    for (int k = 0; k < 4; k++) {
        for (size_t i = 0; i < count; i++) {
            column[i] = (&face[i].opening)[k];
        }
        rg_writer_surface_field(w->writer, name[k], unit[k], 1, column);
    }
    for (size_t i = 0; i < count; i++) {
        column[i] = s->rank;
    }
    if (w->fields & RG_FIELD_RANK) {
        rg_writer_surface_field(w->writer, "rank", "1", 1, column);
    }
    rg_free(column);
    rg_free(face);
}

bool rg_snapshots_show_fragments(const rg_snapshots *w) {
    return (w->fields & RG_FIELD_FRAGMENT) != 0;
}

void rg_snapshots_write(rg_snapshots *w, rg_solver *s, const rg_fragment_parts *parts) {
    if (w->fields == 0) {
        return;
    }
    rg_writer_frame(w->writer, s->step, s->time);
    if (w->fields & RG_FIELD_DISPLACEMENT) {
        write_nodal(w, s, "displacement", "m", s->u);
    }
    if (w->fields & RG_FIELD_VELOCITY) {
        write_nodal(w, s, "velocity", "m/s", s->now);
    }
    if (wants_states(w)) {
        write_states(w, s);
    }
    if (w->fields & RG_FIELD_RANK) {
        write_ranks(w, s);
    }
    if (rg_snapshots_show_fragments(w)) {
        write_fragments(w, parts);
    }
    if (w->fields & RG_FIELD_CRACK) {
        write_cracks(w, s);
    }
    rg_writer_frame_end(w->writer);
}

void rg_snapshots_close(rg_snapshots *w) {
    if (w->fields != 0) {
        rg_writer_close(w->writer);
        rg_free(w->record);
        rg_free(w->sorted);
        rg_free(w->row);
    }
    rg_free(w);
}
