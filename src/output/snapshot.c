#include "output/snapshot.h"

#include <math.h>
#include <omp.h>
#include <string.h>

#include "base/error.h"
#include "base/mem.h"
#include "base/principal.h"
#include "base/first_bad.h"
#include "diagnostics/crack_surface.h"
#include "domain/element.h"
#include "solver/tile.h"

enum { NODAL = 3 * RG_NODES };   /* values of a vector field's record */
enum { WINDOW_BYTES = 4 << 20 }; /* of the records that are on their way at a time */

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

/* ---- region ---- */

static double region_at(const rg_expr *region, const double *points, int count, double x[3]) {
    x[0] = x[1] = x[2] = 0;
    for (int i = 0; i < 3 * count; i++) {
        x[i % 3] += points[i] / count;
    }
    return region == NULL ? 1 : rg_expr_value(region, x, 0);
}

/* ---- windows ---- */

/* Records by own element, in the order of the slab, on their way to the writer. */
typedef struct {
    const rg_snapshots *w;
    rg_slab_move *get;
    const void *of;
    size_t values, rows; /* of a record; of a window */
    size_t next;         /* entry of w->row from which on the rows lie in windows to come */
} window_source;

/* Keeps of a window's `n` records from row `first` on those that are written; returns how many. */
static size_t keep_region(window_source *x, size_t first, size_t n, double *record) {
    const rg_snapshots *w = x->w;
    if (w->row == NULL) {
        return n;
    }
    size_t kept = 0;
    for (; x->next < w->written && w->row[x->next] < first + n; x->next++) {
        memmove(record + kept++ * x->values, record + (w->row[x->next] - first) * x->values,
                x->values * sizeof *record);
    }
    return kept;
}

static size_t get_window(void *of, size_t k, double *out) {
    window_source *x = of;
    size_t first = k * x->rows;
    size_t n =
        rg_slab_gather(x->w->slab, first, x->rows, x->values * sizeof *out, x->get, x->of, (char *)out);
    return keep_region(x, first, n, out);
}

/* Compressed data are written at once. */
static window_source open_source(const rg_snapshots *w, const rg_case *c, size_t values, rg_slab_move *get,
                                 const void *of) {
    size_t rows =
        c->output.compression > 0 ? rg_slab_most(w->slab) : WINDOW_BYTES / (values * sizeof(double));
    return (window_source){.w = w, .get = get, .of = of, .values = values, .rows = rows};
}

static rg_cell_source cells_of(window_source *x) {
    return (rg_cell_source){.windows = (rg_slab_most(x->w->slab) + x->rows - 1) / x->rows,
                            .cells = x->rows,
                            .values = x->values,
                            .get = get_window,
                            .of = x};
}

/* A vector field by slot, or (field NULL) what follows from the mesh. */
typedef struct {
    const rg_domain *domain;
    const rg_lid *slot;
    const rg_real *field;
} nodal_records;

static void get_position(const void *of, size_t i, void *out) {
    const nodal_records *r = of;
    const double *corner = r->domain->corner + 12 * (size_t)r->slot[i];
    const int *order = output_order(corner);
    for (int n = 0; n < RG_NODES; n++) {
        rg_node_position(corner, order[n], (double *)out + 3 * n);
    }
}

static void get_vector(const void *of, size_t i, void *out) {
    const nodal_records *r = of;
    size_t slot = (size_t)r->slot[i];
    const int *order = output_order(r->domain->corner + 12 * slot);
    for (int k = 0; k < NODAL; k++) {
        ((double *)out)[k] = r->field[rg_node_index(slot, order[k / 3], k % 3)];
    }
}

/* Which elements are written. While it looks at them w->row is not there yet, so it gets all. */
static void find_region(rg_snapshots *w, const rg_solver *s) {
    nodal_records positions = {s->domain, w->slab->slot, NULL};
    window_source x = open_source(w, s->input, NODAL, get_position, &positions);
    rg_cell_source cells = cells_of(&x);
    double *record = RG_NEW(double, cells.cells *NODAL);
    size_t *row = RG_NEW(size_t, w->slab->count);
    rg_first_bad bad = {.which = RG_NOWHERE};
    for (size_t k = 0; k < cells.windows; k++) {
        size_t n = cells.get(&x, k, record);
        for (size_t i = 0; i < n; i++) {
            double centre[3]; /* of the corners */
            double here = region_at(s->input->output.region, record + i * NODAL, 4, centre);
            if (!isfinite(here)) {
                rg_first_bad_note(&bad, 0, centre, here);
            }
            if (here != 0) {
                row[w->written++] = k * x.rows + i;
            }
        }
    }
    w->row = row;
    rg_free(record);
    if (rg_first_bad_lowest(&bad, s->comm)) {
        rg_speak(s->comm);
        rg_fatal(RG_USAGE, "%s: output.region: %s is not finite at (%g, %g, %g)", s->input->path,
                 rg_expr_text(s->input->output.region), bad.x[0], bad.x[1], bad.x[2]);
    }
}

/* Which elements are written, and their numbers among all that are. */
static void choose(rg_snapshots *w, const rg_solver *s) {
    w->written = w->slab->count;
    if (s->input->output.region != NULL) {
        w->written = 0;
        find_region(w, s);
    }
    int64_t count = (int64_t)w->written;
    MPI_Scan(&count, &w->first, 1, MPI_INT64_T, MPI_SUM, s->comm);
    w->first -= count;
    MPI_Allreduce(&count, &w->total, 1, MPI_INT64_T, MPI_SUM, s->comm);
    if (w->total == 0) {
        rg_speak(s->comm);
        rg_fatal(RG_USAGE, "%s: output.region: %s: no element is in it", s->input->path,
                 rg_expr_text(s->input->output.region));
    }
}

/* ---- files ---- */

static rg_writer_style style_of(const rg_case *c) {
    return (rg_writer_style){c->output.precision == RG_OUTPUT_SINGLE, (int)c->output.compression};
}

/* All but the writer. */
static rg_snapshots *prepare(const rg_solver *s, rg_slab **slab) {
    rg_snapshots *w = RG_NEW(rg_snapshots, 1);
    w->fields = s->input->output.fields;
    if (w->fields != 0) {
        w->slab = rg_slab_shared(slab, s->domain, s->part->total, s->comm);
        choose(w, s);
    }
    return w;
}

int64_t rg_snapshots_elements(const rg_solver *s) {
    if (s->input->output.fields == 0 || s->input->output.region == NULL) {
        return s->part->total;
    }
    rg_slab *slab = NULL;
    rg_snapshots *w = prepare(s, &slab);
    int64_t total = w->total;
    rg_free(w->row);
    rg_free(w);
    rg_slab_free(slab);
    return total;
}

rg_snapshots *rg_snapshots_open(const rg_solver *s, rg_slab **slab) {
    rg_snapshots *w = prepare(s, slab);
    if (w->fields != 0) {
        nodal_records positions = {s->domain, w->slab->slot, NULL};
        window_source x = open_source(w, s->input, NODAL, get_position, &positions);
        rg_cell_source cells = cells_of(&x);
        w->writer = rg_writer_open(s->input->output.dir, s->comm, style_of(s->input), w->total, w->first,
                                   (int64_t)w->written, &cells);
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

rg_writer_mark rg_snapshots_sync(rg_snapshots *w) {
    if (w->fields == 0) {
        return (rg_writer_mark){0};
    }
    rg_writer_sync(w->writer);
    return rg_writer_stand(w->writer);
}

/* ---- fields ---- */

/* Fields that are all in the same records. */
static void write_volume(rg_snapshots *w, const rg_solver *s, size_t fields, const rg_volume_field *field,
                         size_t values, rg_slab_move *get, const void *of) {
    window_source x = open_source(w, s->input, values, get, of);
    rg_cell_source cells = cells_of(&x);
    rg_writer_volume(w->writer, fields, field, &cells);
}

static void write_nodal(rg_snapshots *w, const rg_solver *s, const char *name, const char *unit,
                        const rg_real *field) {
    nodal_records records = {s->domain, w->slab->slot, field};
    write_volume(w, s, 1, &(rg_volume_field){name, unit, RG_CENTER_NODE, 3, 0, false}, NODAL, get_vector,
                 &records);
}

/* What an element puts out of its state: mean Cauchy stress, mean stress, principal stresses, triaxiality,
 * internal variables. */
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
    rg_volume_field field;
} state_field[] = {
    {RG_FIELD_STRESS, {"stress", "Pa", RG_CENTER_CELL, 6, STRESS, false}},
    {RG_FIELD_MEAN, {"mean_stress", "Pa", RG_CENTER_CELL, 1, MEAN, false}},
    {RG_FIELD_PRINCIPAL, {"principal_stress", "Pa", RG_CENTER_CELL, 3, PRINCIPAL, false}},
    {RG_FIELD_DAMAGE, {"damage", "1", RG_CENTER_CELL, 1, INTERNAL + RG_INTERNAL_DAMAGE, false}},
    {RG_FIELD_REGIME, {"regime", "1", RG_CENTER_CELL, 1, INTERNAL + RG_INTERNAL_REGIME, false}},
    {RG_FIELD_PLASTIC, {"plastic_strain", "1", RG_CENTER_CELL, 1, INTERNAL + RG_INTERNAL_PLASTIC, false}},
    {RG_FIELD_VOLUME, {"plastic_volume", "1", RG_CENTER_CELL, 1, INTERNAL + RG_INTERNAL_VOLUME, false}},
    {RG_FIELD_BULKING, {"bulking_pressure", "Pa", RG_CENTER_CELL, 1, INTERNAL + RG_INTERNAL_BULKING, false}},
    {RG_FIELD_TEMPERATURE,
     {"temperature", "K", RG_CENTER_CELL, 1, INTERNAL + RG_INTERNAL_TEMPERATURE, false}},
    {RG_FIELD_TRIAXIALITY, {"triaxiality", "1", RG_CENTER_CELL, 1, TRIAXIALITY, false}},
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

/* The state at the Gauss points of the tile that a thread was asked for last: neighbours in the order of the
 * slab are mostly of one tile. */
typedef struct {
    double *cauchy, *internal;
    const rg_tile *tile;
} tile_state;

typedef struct {
    const rg_solver *s;
    const rg_lid *slot;
    tile_state *thread; /* [threads] */
    bool prescribed;    /* temperatures are wanted, and the case has them */
} state_records;

static void evaluate(const rg_solver *s, const rg_tile *t, tile_state *state) {
    const rg_workspace *work = &s->work[omp_get_thread_num()];
    rg_tile_receive(s, t, work);
    rg_tile_state(s, t, work, NULL, state->cauchy, state->internal);
    state->tile = t;
}

static void get_state(const void *of, size_t i, void *out) {
    const state_records *r = of;
    tile_state *state = &r->thread[omp_get_thread_num()];
    size_t slot = (size_t)r->slot[i];
    if (state->tile == NULL || slot < state->tile->begin * RG_LANES || slot >= state->tile->end * RG_LANES) {
        evaluate(r->s, rg_tile_of(r->s->domain, slot), state);
    }
    size_t at = slot - state->tile->begin * RG_LANES;
    size_t first = at / RG_LANES * RG_GAUSS, lane = at % RG_LANES;
    element_stress(state->cauchy + first * 6 * RG_LANES + lane, out);
    element_internal(state->internal + first * RG_INTERNAL * RG_LANES + lane, out);
    if (r->prescribed && (rg_material_has(rg_material_of(r->s, slot)) & RG_HAS_TEMPERATURE) == 0) {
        ((double *)out)[INTERNAL + RG_INTERNAL_TEMPERATURE] = rg_heating_temperature(r->s, slot);
    }
}

static void write_states(rg_snapshots *w, const rg_solver *s) {
    rg_volume_field wanted[STATE_FIELDS];
    size_t fields = 0, points = s->domain->tile_blocks * RG_GAUSS * RG_LANES;
    for (int k = 0; k < STATE_FIELDS; k++) {
        if (w->fields & state_field[k].bit) {
            wanted[fields++] = state_field[k].field;
        }
    }
    if (fields == 0) {
        return;
    }
    state_records records = {s, w->slab->slot, RG_NEW(tile_state, (size_t)s->threads),
                             s->heating != NULL && (w->fields & RG_FIELD_TEMPERATURE) != 0};
    for (int t = 0; t < s->threads; t++) {
        records.thread[t] =
            (tile_state){RG_NEW(double, points * 6), RG_NEW(double, points *RG_INTERNAL), NULL};
    }
    write_volume(w, s, fields, wanted, STATE, get_state, &records);
    for (int t = 0; t < s->threads; t++) {
        rg_free(records.thread[t].cauchy);
        rg_free(records.thread[t].internal);
    }
    rg_free(records.thread);
}

/* One whole number of each element. */
static void write_numbers(rg_snapshots *w, const rg_solver *s, const char *name, rg_slab_move *get,
                          const void *of) {
    write_volume(w, s, 1, &(rg_volume_field){name, "1", RG_CENTER_CELL, 1, 0, true}, 1, get, of);
}

static void get_rank(const void *of, size_t i, void *out) {
    (void)i;
    *(double *)out = ((const rg_slab *)of)->rank;
}

static void get_material(const void *of, size_t i, void *out) {
    const nodal_records *r = of;
    *(double *)out = r->domain->material[r->slot[i] / RG_LANES];
}

typedef struct {
    const rg_fragment_parts *parts;
    const rg_lid *slot;
} fragment_records;

static void get_fragment(const void *of, size_t i, void *out) {
    const fragment_records *r = of;
    *(double *)out = (double)r->parts->label[r->parts->of[r->slot[i]]].id;
}

static void get_contact(const void *of, size_t i, void *out) {
    const state_records *r = of;
    double *value = out;
    size_t slot = (size_t)r->slot[i];
    rg_contacts_traction(r->s->contacts, slot, &value[0], value + 1);
    value[4] = r->s->contact_heat != NULL ? r->s->contact_heat[slot] : 0;
}

static void write_contact(rg_snapshots *w, const rg_solver *s) {
    static const rg_volume_field field[] = {{"contact_pressure", "Pa", RG_CENTER_CELL, 1, 0, false},
                                            {"contact_traction", "Pa", RG_CENTER_CELL, 3, 1, false},
                                            {"contact_heat", "J", RG_CENTER_CELL, 1, 4, false}};
    write_volume(w, s, s->contact_heat != NULL ? 3 : 2, field, 5, get_contact,
                 &(state_records){.s = s, .slot = w->slab->slot});
}

/* Faces in the region, by their present place; returns how many. */
static size_t keep_faces(const rg_expr *region, size_t count, rg_crack_face *face) {
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        double centre[3];
        double here = region_at(region, &face[i].x[0][0], 3, centre);
        if (isfinite(here) && here != 0) { /* it is known to be finite in elements only */
            face[kept++] = face[i];
        }
    }
    return kept;
}

static void write_cracks(rg_snapshots *w, const rg_solver *s) {
    rg_crack_face *face;
    size_t count = rg_crack_surface(s, &face);
    count = keep_faces(s->input->output.region, count, face);
    double *column = RG_NEW(double, 9 * count);
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
        write_nodal(w, s, "velocity", "m/s", s->step_velocity);
    }
    write_states(w, s);
    if (w->fields & RG_FIELD_RANK) {
        write_numbers(w, s, "rank", get_rank, w->slab);
    }
    if (rg_snapshots_show_fragments(w)) {
        write_numbers(w, s, "fragment", get_fragment, &(fragment_records){parts, w->slab->slot});
    }
    if (w->fields & RG_FIELD_MATERIAL) {
        write_numbers(w, s, "material", get_material, &(nodal_records){s->domain, w->slab->slot, NULL});
    }
    if (w->fields & RG_FIELD_CONTACT) {
        write_contact(w, s);
    }
    if (w->fields & RG_FIELD_CRACK) {
        write_cracks(w, s);
    }
    rg_writer_frame_end(w->writer);
}

double rg_snapshots_frame_bytes(const rg_case *c) {
    const unsigned nodal = RG_FIELD_DISPLACEMENT | RG_FIELD_VELOCITY,
                   whole = RG_FIELD_RANK | RG_FIELD_FRAGMENT | RG_FIELD_MATERIAL; /* numbers, in doubles */
    double values = 0, numbers = 0;
    if ((c->output.fields & RG_FIELD_CONTACT) != 0) {
        values += rg_case_heats(c) ? 5 : 4;
    }
    for (unsigned bit = 1; bit <= c->output.fields; bit *= 2) {
        values += (bit & c->output.fields & nodal) != 0 ? NODAL : 0;
        numbers += (bit & c->output.fields & whole) != 0;
    }
    for (int k = 0; k < STATE_FIELDS; k++) {
        values += (c->output.fields & state_field[k].bit) != 0 ? state_field[k].field.components : 0;
    }
    size_t size = c->output.precision == RG_OUTPUT_SINGLE ? sizeof(float) : sizeof(double);
    return values * (double)size + numbers * sizeof(double);
}

size_t rg_snapshots_bytes(const rg_case *c, size_t elements) {
    size_t slab = sizeof(rg_lid) + 2 * sizeof(size_t), record = NODAL * sizeof(double); /* of an element */
    size_t window = c->output.compression > 0 ? elements * record : WINDOW_BYTES;
    return c->output.fields == 0 ? 0 : elements * slab + 4 * window; /* gathered, sent, received, written */
}

void rg_snapshots_close(rg_snapshots *w) {
    if (w->fields != 0) {
        rg_writer_close(w->writer);
        rg_free(w->row);
    }
    rg_free(w);
}
