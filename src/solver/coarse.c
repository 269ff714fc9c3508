#include "solver/coarse.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "domain/element.h"
#include "layout.h"

enum { MOST_POINTS = 1200, HATS = 8, MOST_HATS = 4 * HATS };
#define FINEST 1.8     /* least cell, in edges of cubes of six elements */
#define SHARE  0x1p-36 /* unit of the sums, in the largest contribution: 2^26 of them cannot overflow */

/* Where a node is in the grid. */
typedef struct {
    int32_t point;  /* lowest corner of its cell */
    double part[3]; /* in the cell, 0 to 1 */
} place;

struct rg_coarse {
    const rg_solver *solver;
    int cells[3], stride[3]; /* of points, along x, y, z: the longest axis has the largest one */
    double origin[3], edge[3];
    int size, band; /* unknowns; most by which the numbers of two that are coupled differ */
    bool *out;      /* [size]: left out */
    double *factor; /* [size][band + 1]: row i from column i - band on */
    double *value;  /* [size] */
    int64_t *sum;   /* [threads][size] */
    place *place;   /* [slots][4]: of the corners */
};

/* ---- The grid ---- */

static void choose_cells(rg_coarse *c, const double box[2][3], int64_t elements) {
    double size[3], longest = 0, volume = 1;
    for (int k = 0; k < 3; k++) {
        c->origin[k] = box[0][k];
        size[k] = box[1][k] - box[0][k];
        longest = fmax(longest, size[k]);
        volume *= size[k];
    }
    double finest = FINEST * cbrt(6 * volume / (double)elements);
    for (int n = 1, points = 0; n == 1 || (points <= MOST_POINTS && longest / n > finest); n++) {
        int cells[3];
        points = 1;
        for (int k = 0; k < 3; k++) {
            cells[k] = (int)fmax(1, rint(size[k] * n / longest));
            points *= cells[k] + 1;
        }
        if (points <= MOST_POINTS) {
            memcpy(c->cells, cells, sizeof cells);
        }
    }
    for (int k = 0, stride = 1; k < 3; k++) {
        int axis = -1; /* the shortest that is left */
        for (int i = 0; i < 3; i++) {
            if (c->stride[i] == 0 && (axis < 0 || c->cells[i] < c->cells[axis])) {
                axis = i;
            }
        }
        c->stride[axis] = stride;
        stride *= c->cells[axis] + 1;
        c->size = 3 * stride;
    }
    for (int k = 0; k < 3; k++) {
        c->edge[k] = size[k] / c->cells[k];
    }
}

static place place_of(const rg_coarse *c, const double x[3]) {
    place p = {.point = 0};
    for (int k = 0; k < 3; k++) {
        double at = (x[k] - c->origin[k]) / c->edge[k];
        int cell = (int)fmin(fmax(floor(at), 0), c->cells[k] - 1);
        p.part[k] = at - cell;
        p.point += cell * c->stride[k];
    }
    return p;
}

/* Number of function h at a place, and its value there. */
static inline int hat(const rg_coarse *c, const place *p, int h, double *value) {
    int point = p->point;
    *value = 1;
    for (int k = 0; k < 3; k++) {
        bool high = (h >> k & 1) != 0;
        *value *= high ? p->part[k] : 1 - p->part[k];
        point += high ? c->stride[k] : 0;
    }
    return point;
}

static void find_places(rg_coarse *c) {
    const rg_domain *d = c->solver->domain;
    c->place = RG_NEW(place, 4 * d->blocks * RG_LANES + 1);
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < 4 * d->blocks * RG_LANES; i++) {
        if (d->id[i / 4] >= 0) {
            c->place[i] = place_of(c, d->corner + 3 * i);
        }
    }
}

/* A function that moves a held node is out. */
static void leave_out(void *to, size_t slot, int node, const double line[3]) {
    rg_coarse *c = to;
    for (int i = 0; i < 2 * HATS; i++) {
        double value;
        int corner = rg_node_end[node][i / HATS];
        int point = hat(c, &c->place[4 * slot + (size_t)corner], i % HATS, &value);
        for (int k = 0; fabs(value) > 1e-9 && k < 3; k++) {
            c->out[3 * point + k] = c->out[3 * point + k] || fabs(line[k]) > 1e-9;
        }
    }
}

/* ---- The matrix ---- */

typedef struct {
    int point;
    double gradient[3];
} slope;

/* Functions that are not 0 in an element, linear between its corners. Returns how many. */
static int find_slopes(const rg_coarse *c, size_t slot, slope out[MOST_HATS]) {
    const rg_domain *d = c->solver->domain;
    double gradient[4][3] = {{0}};
    int count = 0;
    for (int k = 0; k < 9; k++) {
        gradient[k / 3][k % 3] = d->geom[rg_geom_index(slot, RG_GEOM_GRAD + k)];
        gradient[3][k % 3] -= gradient[k / 3][k % 3];
    }
    for (int i = 0; i < 4 * HATS; i++) {
        double value;
        int point = hat(c, &c->place[4 * slot + (size_t)(i / HATS)], i % HATS, &value);
        if (!(fabs(value) > 1e-9)) {
            continue;
        }
        int at = 0;
        while (at < count && out[at].point != point) {
            at++;
        }
        if (at == count) {
            out[count++] = (slope){.point = point};
        }
        for (int k = 0; k < 3; k++) {
            out[at].gradient[k] += value * gradient[i / HATS][k];
        }
    }
    return count;
}

/* What an element adds between components a and b of two functions. */
static double coupling(const rg_material *m, double volume, const double g[3], const double h[3], int a,
                       int b) {
    double both = a == b ? g[0] * h[0] + g[1] * h[1] + g[2] * h[2] : 0;
    return volume * (m->lambda * g[a] * h[b] + m->mu * (both + g[b] * h[a]));
}

/* Largest entry of any element, and the band. */
static double measure(rg_coarse *c) {
    const rg_solver *s = c->solver;
    const rg_domain *d = s->domain;
    double largest = 0;
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        slope of[MOST_HATS];
        int count = d->id[slot] >= 0 ? find_slopes(c, slot, of) : 0;
        const rg_material *m = &s->model->material[d->material[slot / RG_LANES]];
        double volume = d->geom[rg_geom_index(slot, RG_GEOM_VOLUME)];
        for (int i = 0; i < count; i++) {
            double *g = of[i].gradient, both = g[0] * g[0] + g[1] * g[1] + g[2] * g[2];
            largest = fmax(largest, volume * (m->lambda + 2 * m->mu) * both);
            for (int j = 0; j < count; j++) {
                int apart = 3 * abs(of[i].point - of[j].point) + 2;
                c->band = apart > c->band ? apart : c->band;
            }
        }
    }
    MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, s->comm);
    MPI_Allreduce(MPI_IN_PLACE, &c->band, 1, MPI_INT, MPI_MAX, s->comm);
    return largest;
}

static void add_element(const rg_coarse *c, size_t slot, double unit, int64_t *sum) {
    const rg_solver *s = c->solver;
    const rg_domain *d = s->domain;
    const rg_material *m = &s->model->material[d->material[slot / RG_LANES]];
    double volume = d->geom[rg_geom_index(slot, RG_GEOM_VOLUME)];
    slope of[MOST_HATS];
    int count = find_slopes(c, slot, of);
    for (int n = 0; n < 9 * count * count; n++) {
        const slope *p = &of[n / 9 / count], *q = &of[n / 9 % count];
        int a = n % 9 / 3, b = n % 3, i = 3 * p->point + a, j = 3 * q->point + b;
        if (j <= i && !c->out[i] && !c->out[j]) {
            double value = coupling(m, volume, p->gradient, q->gradient, a, b) / unit;
            sum[(size_t)i * ((size_t)c->band + 1) + (size_t)(j - i + c->band)] += llrint(value);
        }
    }
}

/* By Cholesky; unknowns that no element has, or that others imply, are out. */
static void factorise(rg_coarse *c) {
    int band = c->band;
    for (int i = 0; i < c->size; i++) {
        double *row = c->factor + (size_t)i * ((size_t)band + 1) + (band - i), diagonal = row[i];
        for (int j = i - band < 0 ? 0 : i - band; j <= i; j++) {
            const double *other = c->factor + (size_t)j * ((size_t)band + 1) + (band - j);
            double sum = row[j];
            for (int k = i - band < 0 ? 0 : i - band; k < j; k++) {
                sum -= k < j - band ? 0 : row[k] * other[k];
            }
            row[j] = j < i ? (c->out[j] ? 0 : sum / other[j]) : sum;
        }
        c->out[i] = c->out[i] || !(row[i] > 1e-9 * diagonal);
        row[i] = c->out[i] ? 1 : sqrt(row[i]);
        for (int j = i - band < 0 ? 0 : i - band; c->out[i] && j < i; j++) {
            row[j] = 0;
        }
    }
}

static void make_matrix(rg_coarse *c) {
    const rg_domain *d = c->solver->domain;
    double unit = SHARE * measure(c);
    size_t entries = (size_t)c->size * ((size_t)c->band + 1);
    int64_t *sum = RG_NEW(int64_t, entries);
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        if (d->id[slot] >= 0) {
            add_element(c, slot, unit, sum);
        }
    }
    MPI_Allreduce(MPI_IN_PLACE, sum, (int)entries, MPI_INT64_T, MPI_SUM, c->solver->comm);
    c->factor = RG_NEW(double, entries);
    for (size_t i = 0; i < entries; i++) {
        c->factor[i] = unit * (double)sum[i];
    }
    rg_free(sum);
    factorise(c);
}

rg_coarse *rg_coarse_make(const rg_solver *s) {
    rg_coarse *c = RG_NEW(rg_coarse, 1);
    int64_t elements = (int64_t)s->domain->elements;
    MPI_Allreduce(MPI_IN_PLACE, &elements, 1, MPI_INT64_T, MPI_SUM, s->comm);
    c->solver = s;
    choose_cells(c, (const double(*)[3])s->part->box, elements);
    c->out = RG_NEW(bool, (size_t)c->size);
    c->value = RG_NEW(double, (size_t)c->size);
    c->sum = RG_NEW(int64_t, (size_t)(s->threads * c->size));
    find_places(c);
    rg_constraints_show(s->constraints, leave_out, c);
    rg_ties_show(s->ties, leave_out, c);
    MPI_Allreduce(MPI_IN_PLACE, c->out, c->size, MPI_C_BOOL, MPI_LOR, s->comm);
    make_matrix(c);
    return c;
}

int rg_coarse_size(const rg_coarse *c) {
    int count = 0;
    for (int i = 0; i < c->size; i++) {
        count += !c->out[i];
    }
    return count;
}

/* ---- The correction ---- */

static void solve(const rg_coarse *c) {
    int band = c->band;
    for (int i = 0; i < c->size; i++) {
        const double *row = c->factor + (size_t)i * ((size_t)band + 1) + (band - i);
        double sum = c->out[i] ? 0 : c->value[i];
        for (int k = i - band < 0 ? 0 : i - band; k < i; k++) {
            sum -= row[k] * c->value[k];
        }
        c->value[i] = sum / row[i];
    }
    for (int i = c->size - 1; i >= 0; i--) {
        const double *row = c->factor + (size_t)i * ((size_t)band + 1) + (band - i);
        c->value[i] /= row[i];
        for (int k = i - band < 0 ? 0 : i - band; k < i; k++) {
            c->value[k] -= row[k] * c->value[i];
        }
    }
}

/* Corners share the force on the middle of an edge between them. */
static void restrict_element(const rg_coarse *c, size_t slot, const rg_real *force, double per_unit,
                             int64_t *sum) {
    double corner[4][3];
    for (int i = 0; i < 12; i++) {
        corner[i / 3][i % 3] = force[rg_node_index(slot, i / 3, i % 3)];
    }
    for (int i = 0; i < 18; i++) {
        double half = 0.5 * force[rg_node_index(slot, 4 + i / 3, i % 3)];
        corner[rg_node_end[4 + i / 3][0]][i % 3] += half;
        corner[rg_node_end[4 + i / 3][1]][i % 3] += half;
    }
    for (int i = 0; i < 4 * HATS; i++) {
        double value;
        int point = hat(c, &c->place[4 * slot + (size_t)(i / HATS)], i % HATS, &value);
        for (int k = 0; k < 3; k++) {
            sum[3 * point + k] += (int64_t)(value * per_unit * corner[i / HATS][k]);
        }
    }
}

static void prolong_element(const rg_coarse *c, size_t slot, rg_real *field) {
    double corner[4][3] = {{0}};
    for (int i = 0; i < 4 * HATS; i++) {
        double value;
        int point = hat(c, &c->place[4 * slot + (size_t)(i / HATS)], i % HATS, &value);
        for (int k = 0; k < 3; k++) {
            corner[i / HATS][k] += value * c->value[3 * point + k];
        }
    }
    for (int i = 0; i < 3 * RG_NODES; i++) {
        int n = i / 3, k = i % 3;
        double value = 0.5 * (corner[rg_node_end[n][0]][k] + corner[rg_node_end[n][1]][k]);
        rg_real *at = &field[rg_node_index(slot, n, k)];
        *at = (rg_real)(*at + value);
    }
}

/* P^T force into `value`. */
static void restrict_force(rg_coarse *c, const rg_real *force) {
    const rg_domain *d = c->solver->domain;
    size_t slots = d->blocks * RG_LANES;
    double largest = 0;
#pragma omp parallel for schedule(static) reduction(max : largest)
    for (size_t i = 0; i < d->blocks * RG_NODE_BLOCK; i++) {
        double size = fabs((double)force[i]);
        largest = size > largest ? size : largest;
    }
    MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, c->solver->comm);
    double unit = largest > 0 ? SHARE * largest : 1;
    memset(c->sum, 0, (size_t)(c->solver->threads * c->size) * sizeof *c->sum);
#pragma omp parallel
    {
        int64_t *sum = c->sum + (size_t)omp_get_thread_num() * (size_t)c->size;
#pragma omp for schedule(static)
        for (size_t slot = 0; slot < slots; slot++) {
            if (d->id[slot] >= 0) {
                restrict_element(c, slot, force, 1 / unit, sum);
            }
        }
    }
    for (int i = c->size; i < c->solver->threads * c->size; i++) {
        c->sum[i % c->size] += c->sum[i];
    }
    MPI_Allreduce(MPI_IN_PLACE, c->sum, c->size, MPI_INT64_T, MPI_SUM, c->solver->comm);
    for (int i = 0; i < c->size; i++) {
        c->value[i] = unit * (double)c->sum[i];
    }
}

void rg_coarse_correct(rg_coarse *c, const rg_real *force, rg_real *field) {
    const rg_domain *d = c->solver->domain;
    restrict_force(c, force);
    solve(c);
#pragma omp parallel for schedule(static)
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        if (d->id[slot] >= 0) {
            prolong_element(c, slot, field);
        }
    }
}

void rg_coarse_free(rg_coarse *c) {
    if (c != NULL) {
        void *blocks[] = {c->out, c->factor, c->value, c->sum, c->place, c};
        for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
            rg_free(blocks[i]);
        }
    }
}
