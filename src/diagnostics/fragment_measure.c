#include <math.h>
#include <stdlib.h>

#include "base/exact_sum.h"
#include "base/exchange.h"
#include "base/mem.h"
#include "base/principal.h"
#include "diagnostics/fragment.h"
#include "domain/element.h"
#include "domain/slab.h"
#include "solver/tile.h"

/* Sums over a fragment. Positions are relative to its anchor, so that nothing is lost where it is small and
 * far away. */
enum {
    MASS,
    VOLUME,
    KINETIC,
    MOMENT,
    MOMENTUM = MOMENT + 3,
    ANGULAR = MOMENTUM + 3,
    SECOND = ANGULAR + 3,
    TOUCHES = SECOND + 6,
    IMPULSE,
    SUMS
};

/* From this many elements on the threads share a fragment; smaller ones they share out. */
enum { LARGE = 4096 };

/* The part of a fragment on one rank. */
typedef struct {
    rg_fragment_label label;
    int64_t elements;
    rg_exact_sum sum[SUMS];
} part;

/* ---- Sums ---- */

/* M x for nodal values x[10][3]. */
static void mass_times(double m[RG_NODES][RG_NODES], double x[RG_NODES][3], double out[RG_NODES][3]) {
    for (int a = 0; a < RG_NODES; a++) {
        for (int c = 0; c < 3; c++) {
            out[a][c] = 0;
            for (int b = 0; b < RG_NODES; b++) {
                out[a][c] += m[a][b] * x[b][c];
            }
        }
    }
}

static void load_nodes(const rg_solver *s, size_t slot, const double anchor[3], double x[RG_NODES][3],
                       double v[RG_NODES][3]) {
    for (int n = 0; n < RG_NODES; n++) {
        rg_node_position(s->domain->corner + 12 * slot, n, x[n]);
        for (int c = 0; c < 3; c++) {
            x[n][c] += s->u[rg_node_index(slot, n, c)] - anchor[c];
            v[n][c] = s->step_velocity[rg_node_index(slot, n, c)];
        }
    }
}

/* Components xx yy zz yz xz xy of a symmetric tensor. */
static const int first[6] = {0, 1, 2, 1, 0, 0}, second[6] = {0, 1, 2, 2, 2, 1};

static void element_integrals(double mass, double x[RG_NODES][3], double v[RG_NODES][3],
                              double mx[RG_NODES][3], double mv[RG_NODES][3], double out[SUMS]) {
    out[MASS] = mass;
    for (int n = 0; n < RG_NODES; n++) {
        for (int c = 0; c < 3; c++) {
            int p = (c + 1) % 3, q = (c + 2) % 3;
            out[KINETIC] += 0.5 * mass * v[n][c] * mv[n][c];
            out[MOMENT + c] += mass * mx[n][c];
            out[MOMENTUM + c] += mass * mv[n][c];
            out[ANGULAR + c] += mass * (x[n][p] * mv[n][q] - x[n][q] * mv[n][p]);
        }
        for (int k = 0; k < 6; k++) {
            out[SECOND + k] += mass * x[n][first[k]] * mx[n][second[k]];
        }
    }
}

static void add_element(rg_exact_sum sum[SUMS], const rg_solver *s, double m[RG_NODES][RG_NODES],
                        const rg_fragment_label *label, size_t slot) {
    double x[RG_NODES][3], v[RG_NODES][3], mx[RG_NODES][3], mv[RG_NODES][3], out[SUMS] = {0};
    double volume = s->domain->geom[rg_geom_index(slot, RG_GEOM_VOLUME)];
    load_nodes(s, slot, label->anchor, x, v);
    mass_times(m, x, mx);
    mass_times(m, v, mv);
    element_integrals(rg_element_mass(s->domain, s->model->material, slot), x, v, mx, mv, out);
    out[VOLUME] = volume;
    if (s->contacts != NULL) {
        out[TOUCHES] = s->contact_touches[slot];
        out[IMPULSE] = s->contact_impulse[slot];
    }
    for (int k = 0; k < SUMS; k++) {
        rg_exact_add(&sum[k], out[k]);
    }
}

static void add_large(part *p, const rg_solver *s, double m[RG_NODES][RG_NODES], const rg_lid *member) {
#pragma omp parallel
    {
        rg_exact_sum mine[SUMS] = {0};
#pragma omp for schedule(static) nowait
        for (int64_t i = 0; i < p->elements; i++) {
            add_element(mine, s, m, &p->label, (size_t)member[i]);
        }
#pragma omp critical
        for (int k = 0; k < SUMS; k++) {
            rg_exact_merge(&p->sum[k], &mine[k]);
        }
    }
}

static void add_small(part *p, const rg_solver *s, double m[RG_NODES][RG_NODES], const rg_lid *member) {
    for (int64_t i = 0; i < p->elements; i++) {
        add_element(p->sum, s, m, &p->label, (size_t)member[i]);
    }
}

/* ---- From the sums to the fragment ---- */

static void find_inertia(rg_fragment *f, const double v[SUMS], const double arm[3]) {
    double about[6], tensor[6], trace = 0;
    for (int k = 0; k < 6; k++) {
        about[k] = v[SECOND + k] - f->mass * arm[first[k]] * arm[second[k]];
        trace += k < 3 ? about[k] : 0;
    }
    for (int k = 0; k < 6; k++) {
        tensor[k] = (k < 3 ? trace : 0) - about[k];
    }
    rg_principal_axes(tensor, f->inertia, f->axis);
    for (int k = 0; k < 3; k++) {
        double sum = f->inertia[0] + f->inertia[1] + f->inertia[2];
        f->size[k] = sqrt(fmax(0, 6 * (sum - 2 * f->inertia[k]) / f->mass));
    }
}

static rg_fragment finish(part *p) {
    double v[SUMS], arm[3], spin[3];
    for (int k = 0; k < SUMS; k++) {
        v[k] = rg_exact_value(&p->sum[k]);
    }
    rg_fragment f = {.id = p->label.id,
                     .elements = p->elements,
                     .mass = v[MASS],
                     .volume = v[VOLUME],
                     .kinetic = v[KINETIC],
                     .touches = v[TOUCHES],
                     .impulse = v[IMPULSE]};
    for (int c = 0; c < 3; c++) {
        arm[c] = v[MOMENT + c] / f.mass;
        f.centroid[c] = p->label.anchor[c] + arm[c];
        f.momentum[c] = v[MOMENTUM + c];
    }
    find_inertia(&f, v, arm);
    for (int c = 0; c < 3; c++) {
        int a = (c + 1) % 3, b = (c + 2) % 3;
        spin[c] = v[ANGULAR + c] - (arm[a] * f.momentum[b] - arm[b] * f.momentum[a]);
    }
    for (int k = 0; k < 3; k++) {
        double along = spin[0] * f.axis[k][0] + spin[1] * f.axis[k][1] + spin[2] * f.axis[k][2];
        f.rotational += 0.5 * along * along / f.inertia[k];
    }
    return f;
}

/* ---- Parts on several ranks meet on the rank whose slab of the global order holds the id ---- */

/* What one rank has: whole fragments, and parts of others. */
typedef struct {
    const rg_solver *s;
    const rg_fragment_parts *p;
    double m[RG_NODES][RG_NODES]; /* mass matrix of an element of mass 1 */
    size_t *place;                /* [fragments]: where each goes */
    size_t count[2];              /* wholes, parts */
    rg_fragment *whole;
    part *part;
} harvest;

static void reap(harvest *h, size_t k, bool team) {
    const rg_fragment_parts *p = h->p;
    part one = {.label = p->label[k], .elements = (int64_t)(p->start[k + 1] - p->start[k])};
    if (team != (one.elements >= LARGE)) {
        return;
    }
    (team ? add_large : add_small)(&one, h->s, h->m, p->member + p->start[k]);
    if (p->shared[k]) {
        h->part[h->place[k]] = one;
    } else {
        h->whole[h->place[k]] = finish(&one);
    }
}

static void measure_here(harvest *h) {
    const rg_fragment_parts *p = h->p;
    for (int a = 0; a < RG_NODES; a++) {
        for (int b = 0; b < RG_NODES; b++) {
            h->m[a][b] = rg_mass_entry(h->s->input->mass, a, b);
        }
    }
    h->place = RG_NEW(size_t, p->count);
    for (size_t k = 0; k < p->count; k++) {
        h->place[k] = h->count[p->shared[k]]++;
    }
    h->whole = RG_NEW(rg_fragment, h->count[0]);
    h->part = RG_NEW(part, h->count[1]);
    for (size_t k = 0; k < p->count; k++) {
        reap(h, k, true);
    }
#pragma omp parallel for schedule(dynamic)
    for (size_t k = 0; k < p->count; k++) {
        reap(h, k, false);
    }
    rg_free(h->place);
}

/* Sends records that begin with an id to the ranks that list them. The caller owns the result. */
static void *send_home(const rg_solver *s, const void *records, size_t size, size_t count, size_t *arriving) {
    int *to = RG_NEW(int, count);
    for (size_t i = 0; i < count; i++) {
        rg_gid id = *(const rg_gid *)(const void *)((const char *)records + i * size);
        to[i] = rg_slab_owner(s->part->total, s->ranks, id);
    }
    rg_exchange *x = rg_exchange_make(to, count, s->comm);
    void *arrived = rg_alloc(x->arriving, size);
    rg_exchange_send(x, size, records, arrived);
    *arriving = x->arriving;
    rg_exchange_free(x);
    rg_free(to);
    return arrived;
}

/* Of records that begin with an id. */
static int by_id(const void *a, const void *b) {
    const rg_gid *p = a, *q = b;
    return (*p > *q) - (*p < *q);
}

static void merge(part *into, const part *other) {
    into->elements += other->elements;
    for (int k = 0; k < SUMS; k++) {
        rg_exact_merge(&into->sum[k], &other->sum[k]);
    }
}

size_t rg_fragments_measure(const rg_solver *s, const rg_fragment_parts *p, rg_fragment **rows) {
    harvest h = {.s = s, .p = p};
    measure_here(&h);
    size_t wholes, parts, n;
    rg_fragment *whole = send_home(s, h.whole, sizeof *whole, h.count[0], &wholes);
    part *list = send_home(s, h.part, sizeof *list, h.count[1], &parts);
    rg_free(h.whole);
    rg_free(h.part);
    qsort(list, parts, sizeof *list, by_id);
    *rows = RG_NEW(rg_fragment, wholes + parts);
    for (n = 0; n < wholes; n++) {
        (*rows)[n] = whole[n];
    }
    for (size_t i = 0, next; i < parts; i = next) {
        for (next = i + 1; next < parts && list[next].label.id == list[i].label.id; next++) {
            merge(&list[i], &list[next]);
        }
        (*rows)[n++] = finish(&list[i]);
    }
    qsort(*rows, n, sizeof **rows, by_id);
    rg_free(whole);
    rg_free(list);
    return n;
}
