#include "output/fragment_table.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "base/error.h"
#include "base/exact_sum.h"
#include "base/mem.h"
#include "diagnostics/overlap.h"

static const char columns[] =
    "step,id,elements,time,mass,volume,centroid_x,centroid_y,centroid_z,momentum_x,momentum_y,momentum_z,"
    "kinetic,rotational,inertia_1,inertia_2,inertia_3,axis_1_x,axis_1_y,axis_1_z,axis_2_x,axis_2_y,axis_2_z,"
    "axis_3_x,axis_3_y,axis_3_z,size_1,size_2,size_3";
static const char with_contact[] = ",touches,contact_impulse"; /* of contact.model general */

enum { TAG = 77 };

rg_fragment_table *rg_fragment_table_open(const rg_solver *s) {
    rg_fragment_table *t = RG_NEW(rg_fragment_table, 1);
    t->overlap_time = INFINITY;
    if (s->input->output.fragments == RG_FRAGMENTS_NONE) {
        return t;
    }
    t->csv = rg_csv_open(s->input->output.dir, "fragments.csv", s->rank);
    char header[sizeof columns + sizeof with_contact];
    snprintf(header, sizeof header, "%s%s", columns, s->contacts != NULL ? with_contact : "");
    rg_csv_header(t->csv, header);
    return t;
}

rg_fragment_table *rg_fragment_table_reopen(const rg_solver *s, const rg_fragment_mark *mark) {
    rg_fragment_table *t = RG_NEW(rg_fragment_table, 1);
    t->overlap_time = mark->overlap_time;
    memcpy(t->overlap, mark->overlap, sizeof t->overlap);
    if (s->input->output.fragments != RG_FRAGMENTS_NONE) {
        t->csv = rg_csv_reopen(s->input->output.dir, "fragments.csv", s->rank, mark->bytes);
    }
    return t;
}

rg_fragment_mark rg_fragment_table_sync(rg_fragment_table *t) {
    int64_t bytes = t->csv == NULL ? 0 : rg_csv_sync(t->csv);
    return (rg_fragment_mark){bytes, t->overlap_time, {t->overlap[0], t->overlap[1]}};
}

static void write_row(rg_fragment_table *t, const rg_solver *s, const rg_fragment *f) {
    const int64_t number[] = {s->step, f->id, f->elements};
    double value[28] = {s->time, f->mass, f->volume};
    memcpy(value + 3, f->centroid, sizeof f->centroid);
    memcpy(value + 6, f->momentum, sizeof f->momentum);
    value[9] = f->kinetic;
    value[10] = f->rotational;
    memcpy(value + 11, f->inertia, sizeof f->inertia);
    memcpy(value + 14, f->axis, sizeof f->axis);
    memcpy(value + 23, f->size, sizeof f->size);
    value[26] = f->touches;
    value[27] = f->impulse;
    rg_csv_row(t->csv, number, sizeof number / sizeof *number, value, s->contacts != NULL ? 28 : 26);
}

/* Of the same rows in the same order on any ranks: plain sums will do. */
static void count(rg_fragment_table *t, const rg_fragment *f, size_t rows) {
    for (size_t i = 0; i < rows; i++) {
        t->heaviest = fmax(t->heaviest, f[i].mass);
        int bin = (int)floor(log2(t->mass / f[i].mass) * (1 + 1e-12));
        bin = bin < 0 ? 0 : bin < RG_MASS_BINS ? bin : RG_MASS_BINS - 1;
        t->bin[bin]++;
        t->bin_mass[bin] += f[i].mass;
    }
}

/* The rows of all ranks pass through rank 0, a rank at a time. */
static void collect(rg_fragment_table *t, const rg_solver *s, rg_fragment *rows, size_t own) {
    MPI_Datatype row;
    MPI_Type_contiguous(sizeof *rows, MPI_BYTE, &row);
    MPI_Type_commit(&row);
    if (s->rank > 0) {
        MPI_Send(rows, (int)own, row, 0, TAG, s->comm);
    }
    for (int r = 0; r < s->ranks && s->rank == 0; r++) {
        rg_fragment *from = rows;
        int number = (int)own;
        if (r > 0) {
            MPI_Status status;
            MPI_Probe(r, TAG, s->comm, &status);
            MPI_Get_count(&status, row, &number);
            from = RG_NEW(rg_fragment, (size_t)number);
            MPI_Recv(from, number, row, r, TAG, s->comm, MPI_STATUS_IGNORE);
        }
        count(t, from, (size_t)number);
        for (int i = 0; i < number; i++) {
            write_row(t, s, &from[i]);
        }
        if (r > 0) {
            rg_free(from);
        }
    }
    MPI_Type_free(&row);
}

/* Totals of all fragments: known to all ranks. */
static void total(rg_fragment_table *t, const rg_solver *s, const rg_fragment *rows, size_t own) {
    rg_exact_sum sum = {0};
    for (size_t i = 0; i < own; i++) {
        rg_exact_add(&sum, rows[i].mass);
    }
    rg_exact_allreduce(&sum, 1, s->comm);
    t->count = (int64_t)own;
    MPI_Allreduce(MPI_IN_PLACE, &t->count, 1, MPI_INT64_T, MPI_SUM, s->comm);
    t->mass = rg_exact_value(&sum);
}

bool rg_fragment_table_due(const rg_fragment_table *t, const rg_solver *s, bool last) {
    return t->csv != NULL && (s->input->output.fragments != RG_FRAGMENTS_LAST || last);
}

void rg_fragment_table_take(rg_fragment_table *t, const rg_solver *s, const rg_fragment_parts *p) {
    rg_fragment *rows;
    size_t own = rg_fragments_measure(s, p, &rows);
    t->heaviest = 0;
    memset(t->bin, 0, sizeof t->bin);
    memset(t->bin_mass, 0, sizeof t->bin_mass);
    total(t, s, rows, own);
    collect(t, s, rows, own);
    rg_free(rows);
}

/* ---- Overlaps ---- */

/* Twice the edge of a regular tetrahedron of the mean volume. */
static double cell_size(const rg_solver *s) {
    rg_exact_sum volume = {0};
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        if (s->domain->id[slot] >= 0) {
            rg_exact_add(&volume, s->domain->geom[rg_geom_index(slot, RG_GEOM_VOLUME)]);
        }
    }
    rg_exact_allreduce(&volume, 1, s->comm);
    return 2 * cbrt(6 * sqrt(2) * rg_exact_value(&volume) / (double)s->part->total);
}

/* Whether there are several fragments: all ranks say so. One alone has the first element of the mesh. */
static bool are_several(const rg_solver *s, const rg_fragment_parts *p) {
    int several = 0;
    for (size_t k = 0; k < p->count; k++) {
        several = several || p->label[k].id > 0;
    }
    MPI_Allreduce(MPI_IN_PLACE, &several, 1, MPI_INT, MPI_MAX, s->comm);
    return several != 0;
}

bool rg_fragment_table_looks(const rg_fragment_table *t) {
    return !isfinite(t->overlap_time);
}

void rg_fragment_table_look(rg_fragment_table *t, const rg_solver *s, const rg_fragment_parts *p) {
    if (!are_several(s, p) || !rg_overlap_find(s, p, cell_size(s), t->overlap)) {
        return;
    }
    t->overlap_time = s->time;
    if (s->rank == 0) {
        rg_warn("fragments %" PRId64 " and %" PRId64 " overlap at %.6g s (step %" PRId64 "): %s; said once",
                t->overlap[0], t->overlap[1], s->time, s->step,
                s->contacts == NULL ? "contact.model interfaces lets them pass through each other"
                                    : "they have got deeper than contact can see");
    }
}

static void write_counts(const rg_fragment_table *t, FILE *out) {
    const char *join = "";
    fprintf(out, "  \"fragments\": %" PRId64 ",\n  \"fragment_mass_heaviest_kg\": %.17g,\n", t->count,
            t->heaviest);
    fputs("  \"fragment_mass_bins\": [", out); /* upper bound, fragments, their mass */
    for (int k = 0; k < RG_MASS_BINS; k++) {
        if (t->bin[k] > 0) {
            fprintf(out, "%s[%.17g, %" PRId64 ", %.17g]", join, ldexp(t->mass, -k), t->bin[k],
                    t->bin_mass[k]);
            join = ", ";
        }
    }
    fputs("],\n", out);
}

void rg_fragment_table_summary(const rg_fragment_table *t, FILE *out) {
    if (t->count > 0) {
        write_counts(t, out);
    }
    if (isfinite(t->overlap_time)) {
        fprintf(out, "  \"overlap_time_s\": %.17g,\n  \"overlap_fragments\": [%" PRId64 ", %" PRId64 "],\n",
                t->overlap_time, t->overlap[0], t->overlap[1]);
    }
}

void rg_fragment_table_close(rg_fragment_table *t) {
    if (t->csv != NULL) {
        rg_csv_close(t->csv);
    }
    rg_free(t);
}
