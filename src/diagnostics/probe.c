#include "diagnostics/probe.h"

#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "base/files.h"
#include "base/mem.h"
#include "base/first_bad.h"
#include "diagnostics/crack_front.h"
#include "diagnostics/crack_tip.h"
#include "diagnostics/sensor.h"
#include "domain/element.h"
#include "quadrature.h"
#include "solver/tile.h"

enum {
    VALUES = 12,
    STRAINS = 6,
    BODY = 9,
    TURN = 10,
    OUTSIDE = 7,
    CAPACITY = 256,
    CAPACITY_OF_SUMS = 32
}; /* per probe, body and what more one that turns has, item of the account and sample; samples between two
      flushes, with sensors, whose sums are large */

static const char *const column[VALUES + STRAINS] = {"ux",  "uy",  "uz",  "vx",  "vy",  "vz",
                                                     "sxx", "syy", "szz", "syz", "sxz", "sxy",
                                                     "exx", "eyy", "ezz", "eyz", "exz", "exy"};

static const char *const body_column[BODY] = {"x", "y", "z", "vx", "vy", "vz", "fx", "fy", "fz"};

static const char *const turn_column[TURN] = {"qw", "qx", "qy", "qz", "wx", "wy", "wz", "mx", "my", "mz"};

static const char *const outside_column[OUTSIDE] = {"force_x",  "force_y",  "force_z", "moment_x",
                                                    "moment_y", "moment_z", "work"};

struct rg_probes {
    MPI_Comm comm;
    int rank, probes, samples;
    int row; /* values of a sample: of the probes, of the bodies, of what has a name in the account */
    const rg_bodies *bodies;
    const rg_account *account;
    const rg_probe *probe;        /* [probes]: of the case */
    int *first;                   /* [probes + 1]: where the values of each begin in a row */
    rg_lid *slot;                 /* [probes]; -1 where another rank has it */
    double (*at)[4];              /* [probes]: barycentric coordinates */
    double *time, *value, *total; /* [CAPACITY], [CAPACITY][row]; total: on rank 0 */
    rg_sensors *sensors;
    rg_crack_tips *tips;
    rg_crack_fronts *fronts;
    FILE *file;
};

static int columns(const rg_probes *p) {
    return p->row + rg_sensors_columns(p->sensors) + rg_crack_tips_columns(p->tips) +
           rg_crack_fronts_columns(p->fronts);
}

static int capacity(const rg_probes *p) {
    return rg_sensors_columns(p->sensors) + rg_crack_fronts_columns(p->fronts) > 0 ? CAPACITY_OF_SUMS
                                                                                   : CAPACITY;
}

/* The element with the lowest number that contains probe i. */
static rg_lid locate(const rg_solver *s, int i, double at[4]) {
    const double *x = s->input->output.probe[i].at;
    const double inside = -1e-9;
    rg_lid found = -1;
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        rg_gid id = s->domain->id[slot];
        double l[4];
        if (id < 0 || (found >= 0 && id > s->domain->id[found])) {
            continue;
        }
        rg_barycentric(s->domain->corner + 12 * slot, x, l);
        if (fmin(fmin(l[0], l[1]), fmin(l[2], l[3])) >= inside) {
            found = (rg_lid)slot;
            memcpy(at, l, sizeof l);
        }
    }
    int64_t id = found >= 0 ? s->domain->id[found] : INT64_MAX, first;
    MPI_Allreduce(&id, &first, 1, MPI_INT64_T, MPI_MIN, s->comm);
    if (first == INT64_MAX) {
        rg_speak(s->comm);
        const char *file = s->input->mesh.file;
        rg_fatal(RG_USAGE, "%s: output.probes[%d].at: [%g, %g, %g]: no element of %s contains it",
                 s->input->path, i, x[0], x[1], x[2], file != NULL ? file : "the mesh");
    }
    return id == first ? found : -1;
}

static int body_columns(const rg_bodies *b) {
    int count = 0;
    for (int i = 0; i < b->count; i++) {
        count += BODY + (b->body[i].turns ? TURN : 0);
    }
    return count;
}

/* Columns of an item of the account: work comes last, and is not there of what acts inside the solid. */
static int item_columns(const rg_account_item *i) {
    return i->name == NULL ? 0 : i->inside ? OUTSIDE - 1 : OUTSIDE;
}

static int account_columns(const rg_account *a) {
    int count = 0;
    for (int i = 0; i < a->count; i++) {
        count += item_columns(&a->item[i]);
    }
    return count;
}

static void write_header(rg_probes *p, const rg_case *c) {
    p->file = rg_open_in(c->output.dir, "history.csv");
    fprintf(p->file, "time");
    for (int i = 0; i < p->probes; i++) {
        for (int k = 0; k < p->first[i + 1] - p->first[i]; k++) {
            fprintf(p->file, ",%s_%s", p->probe[i].name, column[k]);
        }
    }
    for (int i = 0; i < c->bodies; i++) {
        for (int k = 0; k < BODY; k++) {
            fprintf(p->file, ",%s_%s", c->body[i].name, body_column[k]);
        }
        for (int k = 0; p->bodies->body[i].turns && k < TURN; k++) {
            fprintf(p->file, ",%s_%s", c->body[i].name, turn_column[k]);
        }
    }
    for (int i = 0; i < p->account->count; i++) {
        for (int k = 0; k < item_columns(&p->account->item[i]); k++) {
            fprintf(p->file, ",%s_%s", p->account->item[i].name, outside_column[k]);
        }
    }
    rg_sensors_header(p->sensors, p->file);
    rg_crack_tips_header(p->tips, p->file);
    rg_crack_fronts_header(p->fronts, p->file);
    fputc('\n', p->file);
}

/* Stress at barycentric point l: linear through the four Gauss points. */
static void stress_at(const rg_solver *s, const rg_workspace *w, size_t slot, const double l[4],
                      double out[6]) {
    _Alignas(64) double cauchy[RG_GAUSS * 6 * RG_LANES];
    const rg_tile *t = rg_tile_of(s->domain, slot);
    size_t block = slot / RG_LANES - t->begin;
    rg_bulk_args bulk = rg_tile_bulk(s, t, w, block);
    rg_bulk_state_args args = {.bulk = &bulk, .cauchy = cauchy};
    rg_tile_bulk_state(s, t, &args, block, block + 1);
    for (size_t k = 0; k < 6; k++) {
        out[k] = 0;
        for (size_t g = 0; g < RG_GAUSS; g++) { /* sum_i l_i e_ig, e_ig = (delta_ig - a)/(b - a) */
            out[k] += (l[g] - RG_GAUSS_A) / RG_GAUSS_BA * cauchy[(g * 6 + k) * RG_LANES + slot % RG_LANES];
        }
    }
}

/* Green-Lagrange's strain at barycentric point l, by the element's own displacement. */
static void strain_at(const rg_solver *s, size_t slot, const double l[4], double out[STRAINS]) {
    static const int first[STRAINS] = {0, 1, 2, 1, 0, 0}, second[STRAINS] = {0, 1, 2, 2, 2, 1};
    double slope[4][3], corner[4][3][3], H[3][3];
    rg_barycentric_slopes(s->domain->corner + 12 * slot, slope);
    rg_corner_gradients(s->u, slot, slope, corner);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            H[i][j] = 0;
            for (int c = 0; c < 4; c++) {
                H[i][j] += l[c] * corner[c][i][j];
            }
        }
    }
    for (int k = 0; k < STRAINS; k++) {
        int i = first[k], j = second[k];
        out[k] = 0.5 * (H[i][j] + H[j][i] + H[0][i] * H[0][j] + H[1][i] * H[1][j] + H[2][i] * H[2][j]);
    }
}

static void sample(const rg_solver *s, const rg_workspace *w, size_t slot, const double l[4],
                   double out[VALUES]) {
    double N[RG_NODES];
    rg_shape(l, N);
    for (int c = 0; c < 3; c++) {
        out[c] = out[3 + c] = 0;
        for (int n = 0; n < RG_NODES; n++) {
            out[c] += N[n] * s->u[rg_node_index(slot, n, c)];
            out[3 + c] += N[n] * s->step_velocity[rg_node_index(slot, n, c)];
        }
    }
    stress_at(s, w, slot, l, out + 6);
}

/* Tiles are watched by several threads at once, each with its own probes. */
static void watch(void *context, rg_solver *s, size_t tile, const rg_workspace *w) {
    rg_probes *p = context;
    for (int i = 0; i < p->probes; i++) {
        if (p->slot[i] >= 0 && rg_tile_of(s->domain, (size_t)p->slot[i]) == &s->domain->tile[tile]) {
            double *out = p->value + p->samples * p->row + p->first[i];
            sample(s, w, (size_t)p->slot[i], p->at[i], out);
            if (p->probe[i].strain) {
                strain_at(s, (size_t)p->slot[i], p->at[i], out + VALUES);
            }
        }
    }
    rg_sensors_watch(p->sensors, s, tile, w);
    rg_crack_tips_watch(p->tips, s, tile);
    rg_crack_fronts_watch(p->fronts, s, tile, w);
}

rg_probes *rg_probes_find(const rg_solver *s) {
    rg_probes *p = RG_NEW(rg_probes, 1);
    int probes = s->input->output.probes;
    *p = (rg_probes){.comm = s->comm,
                     .rank = s->rank,
                     .probes = probes,
                     .probe = s->input->output.probe,
                     .row = body_columns(s->bodies) + account_columns(s->account),
                     .bodies = s->bodies,
                     .account = s->account};
    p->sensors = rg_sensors_make(s);
    p->tips = rg_crack_tips_make(s);
    p->fronts = rg_crack_fronts_make(s);
    p->first = RG_NEW(int, (size_t)probes + 1);
    for (int i = 0; i < probes; i++) {
        p->first[i + 1] = p->first[i] + VALUES + (p->probe[i].strain ? STRAINS : 0);
    }
    p->row += p->first[probes];
    p->slot = RG_NEW(rg_lid, (size_t)p->probes);
    p->at = rg_alloc((size_t)p->probes, sizeof *p->at);
    for (int i = 0; i < p->probes; i++) {
        p->slot[i] = locate(s, i, p->at[i]);
    }
    return p;
}

/* Room for samples, and the solver's kicks fill it. */
static void begin(rg_probes *p, rg_solver *s) {
    size_t size = CAPACITY * (size_t)p->row + 1;
    p->time = RG_NEW(double, CAPACITY);
    p->value = RG_NEW(double, size);
    p->total = RG_NEW(double, size);
    for (int i = 0; i < p->probes; i++) {
        if (p->slot[i] >= 0) {
            s->watched[rg_tile_of(s->domain, (size_t)p->slot[i]) - s->domain->tile] = 1;
        }
    }
    for (size_t t = 0; t < s->domain->tiles; t++) {
        s->watched[t] |= rg_sensors_want(p->sensors, t) || rg_crack_tips_want(p->tips, t) ||
                         rg_crack_fronts_want(p->fronts, t);
    }
    rg_sensors_open(p->sensors, capacity(p));
    rg_crack_tips_open(p->tips, capacity(p));
    rg_crack_fronts_open(p->fronts, capacity(p));
    s->watch = watch;
    s->watch_context = p;
}

void rg_probes_open(rg_probes *p, rg_solver *s) {
    begin(p, s);
    if (p->rank == 0 && columns(p) > 0) {
        write_header(p, s->input);
    }
}

void rg_probes_reopen(rg_probes *p, rg_solver *s, int64_t length) {
    begin(p, s);
    if (p->rank == 0 && columns(p) > 0) {
        p->file = rg_reopen_in(s->input->output.dir, "history.csv", length);
    }
}

/* All ranks know the bodies; one says where they are. */
static void sample_bodies(const rg_probes *p, double *out) {
    for (int i = 0; p->rank == 0 && i < p->bodies->count; i++) {
        const rg_body_seen *seen = &p->bodies->body[i].seen;
        const rg_body_turn *turn = &p->bodies->body[i].turn;
        memcpy(out, seen->x, sizeof seen->x);
        memcpy(out + 3, seen->v, sizeof seen->v);
        memcpy(out + 6, seen->force, sizeof seen->force);
        out += BODY;
        if (p->bodies->body[i].turns) {
            memcpy(out, turn->seen_rotation, sizeof turn->seen_rotation);
            memcpy(out + 4, turn->seen_spin, sizeof turn->seen_spin);
            memcpy(out + 7, turn->moment, sizeof turn->moment);
            out += TURN;
        }
    }
}

/* So they know the account. */
static void sample_account(const rg_probes *p, double *out) {
    for (int i = 0; p->rank == 0 && i < p->account->count; i++) {
        const rg_account_item *item = &p->account->item[i];
        if (item->name != NULL) {
            memcpy(out, item->force, sizeof item->force);
            memcpy(out + 3, item->moment, sizeof item->moment);
            if (!item->inside) {
                out[OUTSIDE - 1] = item->work_now;
            }
            out += item_columns(item);
        }
    }
}

void rg_probes_next(rg_probes *p, double time) {
    if (columns(p) == 0) {
        return;
    }
    rg_sensors_next(p->sensors);
    rg_crack_tips_next(p->tips);
    rg_crack_fronts_next(p->fronts, p->tips);
    double *values = p->value + p->samples * p->row + p->first[p->probes];
    sample_bodies(p, values);
    sample_account(p, values + body_columns(p->bodies));
    p->time[p->samples] = time;
    if (++p->samples == capacity(p)) {
        rg_probes_flush(p);
    }
}

void rg_probes_flush(rg_probes *p) {
    int count = p->samples * p->row, more = rg_sensors_columns(p->sensors);
    int tips = rg_crack_tips_columns(p->tips), fronts = rg_crack_fronts_columns(p->fronts);
    if (p->samples == 0) {
        return;
    }
    /* One rank has each value, the others have zero from the start: the sum only brings them together. */
    MPI_Reduce(p->value, p->total, count, MPI_DOUBLE, MPI_SUM, 0, p->comm);
    const double *sensed = rg_sensors_collect(p->sensors), *tip = rg_crack_tips_collect(p->tips, p->time),
                 *front = rg_crack_fronts_collect(p->fronts);
    for (int k = 0; p->rank == 0 && k < p->samples; k++) {
        fprintf(p->file, "%.17g", p->time[k]);
        for (int i = 0; i < p->row; i++) {
            fprintf(p->file, ",%.17g", p->total[k * p->row + i]);
        }
        for (int i = 0; i < more; i++) {
            fprintf(p->file, ",%.17g", sensed[k * more + i]);
        }
        for (int i = 0; i < tips; i++) {
            fprintf(p->file, ",%.17g", tip[k * tips + i]);
        }
        for (int i = 0; i < fronts; i++) {
            fprintf(p->file, ",%.17g", front[k * fronts + i]);
        }
        fputc('\n', p->file);
    }
    if (p->rank == 0 && fflush(p->file) != 0) {
        rg_fatal(RG_FAILURE, "history.csv: cannot be written: %s", strerror(errno));
    }
    p->samples = 0;
}

int64_t rg_probes_sync(rg_probes *p) {
    rg_probes_flush(p);
    return p->file != NULL ? rg_sync_file(p->file, "history.csv") : 0;
}

void rg_probes_close(rg_probes *p) {
    rg_probes_flush(p);
    if (p->file != NULL) {
        fclose(p->file);
    }
    rg_sensors_free(p->sensors);
    rg_crack_tips_free(p->tips);
    rg_crack_fronts_free(p->fronts);
    void *blocks[] = {p->first, p->slot, p->at, p->time, p->value, p->total, p};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
        rg_free(blocks[i]);
    }
}

void rg_probes_print(const rg_probes *p, FILE *out) {
    rg_sensors_print(p->sensors, out);
    rg_crack_tips_print(p->tips, out);
    rg_crack_fronts_print(p->fronts, out);
}

void rg_probes_register(rg_probes *p, rg_state *st) {
    rg_crack_tips_register(p->tips, st);
    rg_crack_fronts_register(p->fronts, st);
}
