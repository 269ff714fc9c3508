#include "diagnostics/sensor.h"

#include <float.h>
#include <math.h>
#include <omp.h>
#include <string.h>

#include "base/error.h"
#include "base/first_bad.h"
#include "base/mem.h"
#include "domain/face.h"
#include "quadrature.h"
#include "solver/selection.h"
#include "solver/tile.h"

enum { FIRST_STRESS = 6, PARTS = 6 /* of a stress */, MOST_POINTS = RG_NODES };

static const char *const value_name[RG_SENSOR_VALUES] = {
#define NAME(NAME, word, meaning) word,
    RG_SENSOR_VALUE(NAME)
#undef NAME
};

static const char *const measure_name[RG_SENSOR_MEASURES] = {
#define NAME(NAME, word, meaning) word,
    RG_SENSOR_MEASURE(NAME)
#undef NAME
};

/* An element (face < 0) or a face that a sensor looks at. */
typedef struct {
    rg_lid slot;
    int8_t face;
    int16_t sensor;
} entry;

/* A value of a sensor: what all its measures follow from. */
typedef struct {
    int sensor, value;
} quantity;

typedef struct {
    double least, most;
} extremes;

struct rg_sensors {
    const rg_case *input;
    const rg_domain *domain;
    MPI_Comm comm;
    int count, threads, quantities, columns, samples, capacity;
    quantity *quantity; /* of all sensors, one after the other */
    int *first;         /* [count + 1]: that of each */
    bool *on_faces;     /* [count] */
    rg_selected *on;    /* [count]: volume or area of the part, and of what */
    size_t *tile_begin; /* entries of tile t, ascending by slot: from tile_begin[t] on */
    entry *entry;
    rg_exact_sum *now;    /* [threads][quantities]: of the present state */
    extremes *end;        /* likewise */
    rg_exact_sum *sum;    /* [capacity][quantities] */
    double *least, *most; /* likewise; the former with the other sign, so that both are maxima */
    double *row;          /* [capacity][columns] */
};

/* ---- Points of a part, and what is there ---- */

typedef struct {
    int count;
    double weight[MOST_POINTS]; /* sum 1 */
    double value[MOST_POINTS][RG_SENSOR_VALUES];
} points;

static void find_motion(const rg_solver *s, const entry *e, points *p) {
    p->count = e->face < 0 ? RG_NODES : RG_FNODES;
    for (int a = 0; a < p->count; a++) {
        int node = e->face < 0 ? a : rg_face_node[e->face][a];
        bool corner = e->face < 0 ? a < 4 : a < RG_FCORNERS;
        /* int N_a: of the tetrahedron -V/20 at corners, V/5 between; of the triangle 0 and A/3 */
        p->weight[a] = e->face < 0 ? (corner ? -0.05 : 0.2) : (corner ? 0 : 1.0 / 3);
        for (int c = 0; c < 3; c++) {
            p->value[a][c] = s->u[rg_node_index((size_t)e->slot, node, c)];
            p->value[a][3 + c] = s->step_velocity[rg_node_index((size_t)e->slot, node, c)];
        }
    }
}

/* Stress at the Gauss points, of an element; or at the middles of a face's edges, where one coordinate of the
 * fourth corner is 0: linear through the Gauss points. */
static void find_stress(const double *cauchy, const entry *e, points *p) {
    size_t lane = (size_t)e->slot % RG_LANES;
    p->count = e->face < 0 ? RG_GAUSS : RG_FCORNERS;
    for (int a = 0; a < p->count; a++) {
        double *out = p->value[a] + FIRST_STRESS;
        p->weight[a] = 1.0 / p->count;
        for (size_t k = 0; k < PARTS && e->face < 0; k++) {
            out[k] = cauchy[((size_t)a * PARTS + k) * RG_LANES + lane];
        }
        for (size_t k = 0; k < PARTS && e->face >= 0; k++) {
            double l[RG_GAUSS] = {0};
            l[rg_face_node[e->face][a]] = l[rg_face_node[e->face][(a + 1) % RG_FCORNERS]] = 0.5;
            out[k] = 0;
            for (size_t g = 0; g < RG_GAUSS; g++) {
                out[k] += (l[g] - RG_GAUSS_A) / RG_GAUSS_BA * cauchy[(g * PARTS + k) * RG_LANES + lane];
            }
        }
        const double *t = out; /* xx, yy, zz, yz, xz, xy */
        double d[3] = {t[0] - t[1], t[1] - t[2], t[2] - t[0]};
        p->value[a][RG_SENSOR_MISES] = sqrt(0.5 * (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) +
                                            3 * (t[3] * t[3] + t[4] * t[4] + t[5] * t[5]));
        p->value[a][RG_SENSOR_PRESSURE] = -(t[0] + t[1] + t[2]) / 3;
    }
}

static double measure_of(const rg_domain *d, const entry *e) {
    double normal[3];
    return e->face < 0 ? (double)d->geom[rg_geom_index((size_t)e->slot, RG_GEOM_VOLUME)]
                       : rg_surface_area(d->corner + 12 * (size_t)e->slot, e->face, normal);
}

/* ---- A state ---- */

bool rg_sensors_want(const rg_sensors *r, size_t tile) {
    return r->tile_begin[tile] < r->tile_begin[tile + 1];
}

static void add(rg_sensors *r, const entry *e, int k, const points *p) {
    size_t at = (size_t)(omp_get_thread_num() * r->quantities + k);
    double sum = 0;
    extremes *x = &r->end[at];
    for (int a = 0; a < p->count; a++) {
        double value = p->value[a][r->quantity[k].value];
        sum += p->weight[a] * value;
        x->least = value < x->least ? value : x->least;
        x->most = value > x->most ? value : x->most;
    }
    rg_exact_add(&r->now[at], measure_of(r->domain, e) * sum);
}

/* Whether a sensor has a value of stress; these are the last ones. */
static bool wants_stress(const rg_sensors *r, int sensor) {
    return r->quantity[r->first[sensor + 1] - 1].value >= FIRST_STRESS;
}

static void find_block(const rg_solver *s, const rg_workspace *w, const rg_tile *t, size_t block,
                       double *cauchy) {
    rg_bulk_args bulk = rg_tile_bulk(s, t, w, block);
    rg_bulk_state_args args = {.bulk = &bulk, .cauchy = cauchy};
    rg_tile_bulk_state(s, t, &args, block, block + 1);
}

void rg_sensors_watch(rg_sensors *r, const rg_solver *s, size_t tile, const rg_workspace *w) {
    _Alignas(64) double cauchy[RG_GAUSS * PARTS * RG_LANES];
    const rg_tile *t = &s->domain->tile[tile];
    size_t known = SIZE_MAX;
    for (size_t i = r->tile_begin[tile]; i < r->tile_begin[tile + 1]; i++) {
        const entry *e = &r->entry[i];
        points motion, stress;
        bool stressed = wants_stress(r, e->sensor);
        size_t block = (size_t)e->slot / RG_LANES - t->begin;
        if (stressed && block != known) {
            find_block(s, w, t, block, cauchy);
            known = block;
        }
        if (stressed) {
            find_stress(cauchy, e, &stress);
        }
        find_motion(s, e, &motion);
        for (int k = r->first[e->sensor]; k < r->first[e->sensor + 1]; k++) {
            add(r, e, k, r->quantity[k].value >= FIRST_STRESS ? &stress : &motion);
        }
    }
}

static void clear(rg_sensors *r) {
    size_t all = (size_t)(r->threads * r->quantities);
    memset(r->now, 0, all * sizeof *r->now);
    for (size_t i = 0; i < all; i++) {
        r->end[i] = (extremes){DBL_MAX, -DBL_MAX};
    }
}

void rg_sensors_next(rg_sensors *r) {
    size_t row = (size_t)(r->samples++ * r->quantities);
    for (int k = 0; k < r->quantities; k++) {
        rg_exact_sum *sum = &r->sum[row + (size_t)k];
        extremes x = r->end[k];
        *sum = r->now[k];
        for (int i = r->quantities + k; i < r->threads * r->quantities; i += r->quantities) {
            rg_exact_merge(sum, &r->now[i]);
            x.least = fmin(x.least, r->end[i].least);
            x.most = fmax(x.most, r->end[i].most);
        }
        r->least[row + (size_t)k] = -x.least;
        r->most[row + (size_t)k] = x.most;
    }
    clear(r);
}

const double *rg_sensors_collect(rg_sensors *r) {
    int all = r->samples * r->quantities, column = 0;
    rg_exact_allreduce(r->sum, all, r->comm);
    MPI_Allreduce(MPI_IN_PLACE, r->least, all, MPI_DOUBLE, MPI_MAX, r->comm);
    MPI_Allreduce(MPI_IN_PLACE, r->most, all, MPI_DOUBLE, MPI_MAX, r->comm);
    for (int i = 0; i < all; i++) {
        const quantity *q = &r->quantity[i % r->quantities];
        double sum = rg_exact_value(&r->sum[i]);
        const double is[RG_SENSOR_MEASURES] = {[RG_SENSOR_MEAN] = sum / r->on[q->sensor].size,
                                               [RG_SENSOR_MIN] = -r->least[i],
                                               [RG_SENSOR_MAX] = r->most[i],
                                               [RG_SENSOR_INTEGRAL] = sum};
        for (int m = 0; m < RG_SENSOR_MEASURES; m++) {
            if ((r->input->output.sensor[q->sensor].measures >> m & 1) != 0) {
                r->row[column++] = is[m];
            }
        }
    }
    r->samples = 0;
    return r->row;
}

/* ---- Set-up ---- */

_Noreturn static void refuse(const rg_sensors *r, int i, const char *key, const char *why) {
    rg_speak(r->comm);
    rg_fatal(RG_USAGE, "%s: output.sensors[%d]%s: %s", r->input->path, i, key, why);
}

static bool has_element(const rg_solver *s, const rg_sensor_input *in, int32_t set, size_t slot,
                        rg_first_bad *bad) {
    const rg_domain *d = s->domain;
    if (d->id[slot] < 0) {
        return false;
    }
    if (in->material != NULL) {
        return d->material[slot / RG_LANES] == rg_case_find_material(s->input, in->material);
    }
    if (in->set != NULL) {
        return rg_sets_hold(&s->part->volume, d->region[slot], set);
    }
    if (in->where == NULL) {
        return true;
    }
    double x[3];
    for (int c = 0; c < 3; c++) {
        const double *corner = d->corner + 12 * slot + c;
        x[c] = 0.25 * (corner[0] + corner[3] + corner[6] + corner[9]);
    }
    double here = rg_expr_value(in->where, x, 0);
    if (!isfinite(here)) {
        rg_first_bad_note(bad, 0, x, here);
    }
    return here != 0;
}

/* Bits of the faces of each element that a sensor looks at, or 1 of elements: [slots]. */
static uint8_t *parts_of(rg_sensors *r, const rg_solver *s, int i) {
    const rg_sensor_input *in = &s->input->output.sensor[i];
    bool surface = in->set != NULL && rg_sets_find(&s->part->surface, in->set) >= 0;
    r->on_faces[i] = surface || (in->where != NULL && rg_expr_uses_normal(in->where));
    if (r->on_faces[i]) {
        rg_selection of = {"output.sensors", i, in->set, in->where, false};
        return rg_selection_faces(&of, s->input, s->domain, s->part, s->comm);
    }
    int32_t set = in->set == NULL ? -1 : rg_sets_find(&s->part->volume, in->set);
    if (in->set != NULL && set < 0) {
        refuse(r, i, ".set", "the mesh has no set of this name, of faces or elements");
    }
    rg_first_bad bad = {.which = RG_NOWHERE};
    int64_t count = 0;
    uint8_t *on = RG_NEW(uint8_t, s->domain->blocks * RG_LANES + 1);
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) { /* expressions are not for threads */
        on[slot] = has_element(s, in, set, slot, &bad);
        count += on[slot];
    }
    if (rg_first_bad_lowest(&bad, s->comm)) {
        refuse(r, i, ".where", "is not finite everywhere");
    }
    MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPI_INT64_T, MPI_SUM, s->comm);
    if (count == 0) {
        refuse(r, i, "", "no element is in it");
    }
    return on;
}

/* Visits what sensors look at in a tile: counts it and, with room for it, lists it. */
static size_t list_tile(const rg_sensors *r, uint8_t *const *on, const rg_tile *t, entry *out) {
    size_t count = 0;
    for (size_t slot = t->begin * RG_LANES; slot < t->end * RG_LANES; slot++) {
        for (int i = 0; i < r->count; i++) {
            for (int f = 0; f < (r->on_faces[i] ? RG_FACES : 1); f++) {
                if ((on[i][slot] >> f & 1) != 0) {
                    if (out != NULL) {
                        out[count] = (entry){(rg_lid)slot, (int8_t)(r->on_faces[i] ? f : -1), (int16_t)i};
                    }
                    count++;
                }
            }
        }
    }
    return count;
}

static void list_all(rg_sensors *r, const rg_solver *s) {
    const rg_domain *d = s->domain;
    uint8_t **on = RG_NEW(uint8_t *, (size_t)r->count + 1);
    for (int i = 0; i < r->count; i++) {
        on[i] = parts_of(r, s, i);
        r->on[i] = rg_selection_measure(on[i], !r->on_faces[i], s->input, d, s->comm);
    }
    for (int pass = 0; pass < 2; pass++) {
        for (size_t t = 0, n = 0; t < d->tiles; t++) {
            n += list_tile(r, on, &d->tile[t], pass == 0 ? NULL : r->entry + n);
            r->tile_begin[t + 1] = n;
        }
        if (pass == 0) {
            r->entry = RG_NEW(entry, r->tile_begin[d->tiles] + 1);
        }
    }
    for (int i = 0; i < r->count; i++) {
        rg_free(on[i]);
    }
    rg_free(on);
}

static void list_quantities(rg_sensors *r) {
    r->quantity = RG_NEW(quantity, (size_t)(r->count * RG_SENSOR_VALUES) + 1);
    for (int i = 0; i < r->count; i++) {
        const rg_sensor_input *in = &r->input->output.sensor[i];
        r->first[i] = r->quantities;
        for (int v = 0; v < RG_SENSOR_VALUES; v++) {
            if ((in->values >> v & 1) != 0) {
                r->quantity[r->quantities++] = (quantity){i, v};
                for (int m = 0; m < RG_SENSOR_MEASURES; m++) {
                    r->columns += (in->measures >> m & 1) != 0;
                }
            }
        }
    }
    r->first[r->count] = r->quantities;
}

rg_sensors *rg_sensors_make(const rg_solver *s) {
    rg_sensors *r = RG_NEW(rg_sensors, 1);
    int count = s->input->output.sensors;
    *r = (rg_sensors){.input = s->input,
                      .domain = s->domain,
                      .comm = s->comm,
                      .count = count,
                      .threads = s->threads,
                      .first = RG_NEW(int, (size_t)count + 1),
                      .on_faces = RG_NEW(bool, (size_t)count + 1),
                      .on = RG_NEW(rg_selected, (size_t)count + 1),
                      .tile_begin = RG_NEW(size_t, s->domain->tiles + 1)};
    list_quantities(r);
    list_all(r, s);
    return r;
}

void rg_sensors_open(rg_sensors *r, int capacity) {
    size_t rows = (size_t)capacity, quantities = (size_t)r->quantities;
    r->now = RG_NEW(rg_exact_sum, (size_t)r->threads * quantities + 1);
    r->end = RG_NEW(extremes, (size_t)r->threads * quantities + 1);
    r->sum = RG_NEW(rg_exact_sum, rows * quantities + 1);
    r->least = RG_NEW(double, rows *quantities + 1);
    r->most = RG_NEW(double, rows *quantities + 1);
    r->row = RG_NEW(double, rows *(size_t)r->columns + 1);
    clear(r);
}

/* ---- Words ---- */

int rg_sensors_columns(const rg_sensors *r) {
    return r->columns;
}

void rg_sensors_header(const rg_sensors *r, FILE *out) {
    for (int k = 0; k < r->quantities; k++) {
        const rg_sensor_input *in = &r->input->output.sensor[r->quantity[k].sensor];
        for (int m = 0; m < RG_SENSOR_MEASURES; m++) {
            if ((in->measures >> m & 1) != 0) {
                fprintf(out, ",%s_%s_%s", in->name, value_name[r->quantity[k].value], measure_name[m]);
            }
        }
    }
}

void rg_sensors_print(const rg_sensors *r, FILE *out) {
    for (int i = 0; i < r->count; i++) {
        char on[200];
        rg_selected_tell(&r->on[i], !r->on_faces[i], on, sizeof on);
        fprintf(out, "sensor         %s: %s\n", r->input->output.sensor[i].name, on);
    }
}

void rg_sensors_free(rg_sensors *r) {
    if (r != NULL) {
        void *blocks[] = {r->quantity, r->first, r->on_faces, r->on,   r->tile_begin, r->entry, r->now,
                          r->end,      r->sum,   r->least,    r->most, r->row,        r};
        for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
            rg_free(blocks[i]);
        }
    }
}
