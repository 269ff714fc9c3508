#include "solver/absorbing.h"

#include <math.h>
#include <string.h>

#include "base/dense.h"
#include "base/mem.h"
#include "domain/element.h"
#include "partition/material.h"
#include "partition/orientation.h"
#include "solver/selection.h"

enum { MOST = 3 * RG_NODES }; /* damped components of an element */

/* An absorbing face: its impedance Z, rho c of waves along its normal, times its area over the element's
 * mass, xx yy zz yz xz xy (1/s). */
typedef struct {
    int8_t face;
    double impedance[6];
} side;

/* An element with damped nodes. Matrices are over its mass. */
typedef struct {
    rg_lid slot;
    int8_t sides, damped;
    int8_t node[RG_NODES]; /* the damped ones */
    side side[RG_FACES];   /* where elements own their nodes */
    double (*shared)[6];   /* where they share them: damping of each node over its mass, xx yy zz yz xz xy */
    double *matrix, *factor; /* P of the damped nodes; L of (P + h C/2) = L L^T, rows of the lower triangle */
    double length;           /* h that the factor is for */
    double before[RG_NODES][3]; /* velocity of the damped nodes before the kick */
    double force[RG_NODES][3];  /* on them (N) */
} entry;

struct rg_absorbing {
    rg_surface surface;
    rg_account *account;
    int item; /* -1: there are no such sides */
    size_t *tile_begin, entries;
    entry *entry;
    double *room;                           /* of the matrices */
    double face_mass[RG_FNODES][RG_FNODES]; /* int N_a N_b dA over the area */
    double lumped[RG_FNODES];               /* its diagonal, scaled to sum 1 (HRZ) */
    double mass_of_node[RG_NODES];          /* lumped mass of an element's nodes over its own */
    double dt_last, dt_next, length;
};

/* ---- Matrices ---- */

static size_t row(int i) {
    return (size_t)i * (size_t)(i + 1) / 2;
}

/* Position of a node among the damped ones. */
static int position(const entry *e, int node) {
    int i = 0;
    while (e->node[i] != node) {
        i++;
    }
    return i;
}

static double impedance(const side *s, int c, int d) {
    static const int place[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};
    return s->impedance[place[c][d]];
}

/* Adds factor C to the lower triangle of a matrix of the damped nodes. */
static void add_damping(const rg_absorbing *a, const entry *e, double factor, double *out) {
    for (int k = 0; k < e->sides; k++) {
        const side *s = &e->side[k];
        for (int i = 0; i < RG_FNODES * 3; i++) {
            for (int j = 0; j < RG_FNODES * 3; j++) {
                int p = 3 * position(e, rg_face_node[s->face][i / 3]) + i % 3;
                int q = 3 * position(e, rg_face_node[s->face][j / 3]) + j % 3;
                if (q <= p) {
                    out[row(p) + (size_t)q] +=
                        factor * a->face_mass[i / 3][j / 3] * impedance(s, i % 3, j % 3);
                }
            }
        }
    }
}

/* Cholesky's factor of a positive definite matrix, in place. */
static void factorise(double *m, int n) {
    for (int i = 0; i < n; i++) {
        double *mi = m + row(i);
        for (int j = 0; j <= i; j++) {
            const double *mj = m + row(j);
            double sum = mi[j];
            for (int k = 0; k < j; k++) {
                sum -= mi[k] * mj[k];
            }
            mi[j] = i == j ? sqrt(sum) : sum / mj[j];
        }
    }
}

static void solve(const double *factor, int n, double *x) {
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < i; k++) {
            x[i] -= factor[row(i) + (size_t)k] * x[k];
        }
        x[i] /= factor[row(i) + (size_t)i];
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int k = i + 1; k < n; k++) {
            x[i] -= factor[row(k) + (size_t)i] * x[k];
        }
        x[i] /= factor[row(i) + (size_t)i];
    }
}

/* y = P x, of three components each; P [n x n] is whole. */
static void times(const double *P, int n, const double *x, double *y) {
    for (int i = 0; i < 3 * n; i++) {
        y[i] = 0;
        for (int j = 0; j < n; j++) {
            y[i] += P[i / 3 * n + j] * x[3 * j + i % 3];
        }
    }
}

static void prepare(const rg_absorbing *a, entry *e) {
    int n = e->damped;
    for (int i = 0; i < 3 * n; i++) {
        for (int j = 0; j <= i; j++) {
            e->factor[row(i) + (size_t)j] = i % 3 == j % 3 ? e->matrix[i / 3 * n + j / 3] : 0;
        }
    }
    add_damping(a, e, 0.5 * a->length, e->factor);
    factorise(e->factor, 3 * n);
    e->length = a->length;
}

/* ---- A kick ---- */

void rg_absorbing_set(rg_absorbing *a, double dt_last, double dt_next) {
    a->dt_last = dt_last;
    a->dt_next = dt_next;
    a->length = 0.5 * (dt_last + dt_next);
}

void rg_absorbing_note(rg_absorbing *a, size_t tile, const rg_real *velocity) {
    for (size_t i = a->tile_begin[tile]; i < a->tile_begin[tile + 1]; i++) {
        entry *e = &a->entry[i];
        for (int k = 0; k < 3 * e->damped; k++) {
            e->before[k / 3][k % 3] = velocity[rg_node_index((size_t)e->slot, e->node[k / 3], k % 3)];
        }
    }
}

/* C w over the mass, from the mean velocity of the damped nodes. */
static void damping_times(const rg_absorbing *a, const entry *e, const double *w, double *out) {
    memset(out, 0, 3 * (size_t)e->damped * sizeof *out);
    for (int k = 0; k < e->sides; k++) {
        const side *s = &e->side[k];
        int at[RG_FNODES];
        for (int i = 0; i < RG_FNODES; i++) {
            at[i] = 3 * position(e, rg_face_node[s->face][i]);
        }
        for (int i = 0; i < RG_FNODES; i++) {
            double v[3] = {0, 0, 0};
            for (int j = 0; j < RG_FNODES; j++) {
                for (int c = 0; c < 3; c++) {
                    v[c] += a->face_mass[i][j] * w[at[j] + c];
                }
            }
            for (int c = 0; c < 9; c++) {
                out[at[i] + c / 3] += impedance(s, c / 3, c % 3) * v[c % 3];
            }
        }
    }
}

/* Adds M^-1 j to the velocities of an element, j the impulse on its damped nodes over its mass. */
static void push_element(const rg_absorbing *a, const entry *e, const double *j, const rg_push *push) {
    for (int n = 0; n < RG_NODES; n++) {
        for (int c = 0; c < 3; c++) {
            double change = 0;
            for (int k = 0; k < e->damped; k++) {
                change += a->surface.inverse_mass[n][e->node[k]] * j[3 * k + c];
            }
            size_t at = rg_node_index((size_t)e->slot, n, c);
            push->velocity[at] = (rg_real)(push->velocity[at] + change);
            if (push->step_velocity != NULL) {
                push->step_velocity[at] =
                    (rg_real)(push->step_velocity[at] + push->dt_now / push->dt * change);
            }
        }
    }
}

static void damp_element(const rg_absorbing *a, entry *e, const rg_push *push) {
    double mean[MOST], w[MOST], j[MOST];
    double mass = rg_element_mass(a->surface.domain, a->surface.material, (size_t)e->slot);
    if (e->length != a->length) {
        prepare(a, e);
    }
    for (int i = 0; i < 3 * e->damped; i++) {
        size_t at = rg_node_index((size_t)e->slot, e->node[i / 3], i % 3);
        mean[i] = 0.5 * (e->before[i / 3][i % 3] + push->velocity[at]);
    }
    times(e->matrix, e->damped, mean, w);
    solve(e->factor, 3 * e->damped, w);
    damping_times(a, e, w, j);
    for (int i = 0; i < 3 * e->damped; i++) {
        e->force[i / 3][i % 3] = -mass * j[i];
        j[i] *= -a->length;
    }
    push_element(a, e, j, push);
}

/* Solves a symmetric system of three, the matrix as xx yy zz yz xz xy. */
static void solve_node(const double m[6], const double right[3], double x[3]) {
    double cofactor[6] = {m[1] * m[2] - m[3] * m[3], m[0] * m[2] - m[4] * m[4], m[0] * m[1] - m[5] * m[5],
                          m[4] * m[5] - m[0] * m[3], m[3] * m[5] - m[1] * m[4], m[3] * m[4] - m[2] * m[5]};
    double det = m[0] * cofactor[0] + m[5] * cofactor[5] + m[4] * cofactor[4];
    x[0] = (cofactor[0] * right[0] + cofactor[5] * right[1] + cofactor[4] * right[2]) / det;
    x[1] = (cofactor[5] * right[0] + cofactor[1] * right[1] + cofactor[3] * right[2]) / det;
    x[2] = (cofactor[4] * right[0] + cofactor[3] * right[1] + cofactor[2] * right[2]) / det;
}

/* All copies of a node get the same bits, as they have the same numbers. */
static void damp_nodes(const rg_absorbing *a, entry *e, const rg_push *push) {
    double mass = rg_element_mass(a->surface.domain, a->surface.material, (size_t)e->slot);
    for (int k = 0; k < e->damped; k++) {
        const double *D = e->shared[k];
        double m[6], mean[3], w[3];
        size_t at[3];
        for (int c = 0; c < 3; c++) {
            at[c] = rg_node_index((size_t)e->slot, e->node[k], c);
            mean[c] = 0.5 * (e->before[k][c] + push->velocity[at[c]]);
        }
        for (int i = 0; i < 6; i++) {
            m[i] = (i < 3 ? 1 : 0) + 0.5 * a->length * D[i];
        }
        solve_node(m, mean, w);
        const double rate[3] = {D[0] * w[0] + D[5] * w[1] + D[4] * w[2],
                                D[5] * w[0] + D[1] * w[1] + D[3] * w[2],
                                D[4] * w[0] + D[3] * w[1] + D[2] * w[2]};
        for (int c = 0; c < 3; c++) {
            e->force[k][c] = -mass * a->mass_of_node[e->node[k]] * rate[c];
            push->velocity[at[c]] = (rg_real)(push->velocity[at[c]] - a->length * rate[c]);
            if (push->step_velocity != NULL) {
                push->step_velocity[at[c]] = (rg_real)(push->step_velocity[at[c]] - push->dt_now * rate[c]);
            }
        }
    }
}

void rg_absorbing_damp(rg_absorbing *a, size_t tile, const rg_push *push) {
    for (size_t i = a->tile_begin[tile]; i < a->tile_begin[tile + 1]; i++) {
        if (a->entry[i].shared != NULL) {
            damp_nodes(a, &a->entry[i], push);
        } else {
            damp_element(a, &a->entry[i], push);
        }
    }
}

void rg_absorbing_book(const rg_absorbing *a, size_t tile, const rg_real *velocity) {
    rg_account_entry sum = {.before = 0};
    if (a->tile_begin[tile] == a->tile_begin[tile + 1]) {
        return;
    }
    for (size_t i = a->tile_begin[tile]; i < a->tile_begin[tile + 1]; i++) {
        const entry *e = &a->entry[i];
        for (int k = 0; k < 3 * e->damped; k++) {
            double force = e->force[k / 3][k % 3];
            sum.force[k % 3] += force;
            sum.before += 0.5 * a->dt_last * force * e->before[k / 3][k % 3];
            sum.after +=
                0.5 * a->dt_next * force * velocity[rg_node_index((size_t)e->slot, e->node[k / 3], k % 3)];
        }
    }
    rg_account_book(a->account, a->item, &sum);
}

double rg_absorbing_radiated(const rg_absorbing *a) {
    return a->item < 0 ? 0 : -a->account->item[a->item].work_now;
}

/* ---- Set-up ---- */

/* What damps at the faces: absorbing ones, and dashpots on top (N s/m^3). */
typedef struct {
    uint8_t *faces, *absorbing; /* [slots]: bits of all, and of those that absorb */
    double *dashpot;            /* [slots][RG_FACES] */
} damping;

static damping find_faces(const rg_case *c, const rg_domain *d, const rg_part *part, MPI_Comm comm) {
    size_t slots = d->blocks * RG_LANES;
    damping all = {RG_NEW(uint8_t, slots + 1), RG_NEW(uint8_t, slots + 1),
                   RG_NEW(double, RG_FACES *slots + 1)};
    for (int b = 0; b < c->boundaries; b++) {
        if (rg_boundary_damps(&c->boundary[b])) {
            rg_selection s = {"boundary", b, c->boundary[b].set, c->boundary[b].where, false};
            uint8_t *here = rg_selection_faces(&s, c, d, part, comm);
            for (size_t slot = 0; slot < slots; slot++) {
                all.faces[slot] |= here[slot];
                all.absorbing[slot] |= c->boundary[b].absorbing ? here[slot] : 0;
            }
            for (size_t i = 0; i < RG_FACES * slots; i++) {
                all.dashpot[i] += (here[i / RG_FACES] >> i % RG_FACES & 1) != 0 ? c->boundary[b].dashpot : 0;
            }
            rg_free(here);
        }
    }
    return all;
}

/* The solid of an element along its own axes. */
static rg_material solid_of(const rg_domain *d, const rg_material *m, size_t slot) {
    double axis[3][3];
    if (d->turn == NULL) {
        return *m;
    }
    for (int k = 0; k < RG_TURN; k++) {
        axis[k / 3][k % 3] = d->turn[rg_turn_index(slot, k)];
    }
    return rg_material_along(m, (const double(*)[3])axis);
}

static void add_side(const rg_absorbing *a, entry *e, int face, const damping *by) {
    const rg_domain *d = a->surface.domain;
    const rg_material *m = &a->surface.material[d->material[(size_t)e->slot / RG_LANES]];
    side *s = &e->side[e->sides++];
    s->face = (int8_t)face;
    double normal[3], area = rg_surface_area(d->corner + 12 * (size_t)e->slot, face, normal);
    double per_mass = area / (double)d->geom[rg_geom_index((size_t)e->slot, RG_GEOM_VOLUME)];
    if ((by->absorbing[e->slot] >> face & 1) != 0) {
        rg_material own = solid_of(d, m, (size_t)e->slot);
        rg_material_impedance(&own, normal, s->impedance);
    }
    double dashpot = by->dashpot[RG_FACES * (size_t)e->slot + (size_t)face] / m->density;
    for (int k = 0; k < 6; k++) {
        s->impedance[k] = per_mass * (s->impedance[k] + (k < 3 ? dashpot : 0));
    }
}

static entry make_entry(const rg_absorbing *a, size_t slot, const damping *by, unsigned nodes) {
    entry e = {.slot = (rg_lid)slot, .length = -1};
    for (int8_t n = 0; n < RG_NODES; n++) {
        if ((nodes >> n & 1) != 0) {
            e.node[e.damped++] = n;
        }
    }
    for (int f = 0; f < RG_FACES; f++) {
        if ((by->faces[slot] >> f & 1) != 0) {
            add_side(a, &e, f, by);
        }
    }
    return e;
}

static unsigned nodes_of(unsigned faces) {
    unsigned nodes = 0;
    for (int i = 0; i < RG_FACES * RG_FNODES; i++) {
        nodes |= (faces >> (i / RG_FNODES) & 1) << rg_face_node[i / RG_FNODES][i % RG_FNODES];
    }
    return nodes;
}

/* P = ((M^-1)_cc)^-1 over the mass [n x n]. */
static void make_matrix(const rg_absorbing *a, const entry *e) {
    int n = e->damped;
    for (int i = 0; i < n * n; i++) {
        e->matrix[i] = a->surface.inverse_mass[e->node[i / n]][e->node[i % n]];
    }
    rg_dense_invert(n, e->matrix);
}

static void make_matrices(rg_absorbing *a) {
    size_t size = 0;
    for (size_t i = 0; i < a->entries; i++) {
        int n = a->entry[i].damped;
        size += (size_t)(n * n) + row(3 * n);
    }
    a->room = RG_NEW(double, size + 1);
    double *next = a->room;
    for (size_t i = 0; i < a->entries; i++) {
        entry *e = &a->entry[i];
        e->matrix = next;
        e->factor = next + e->damped * e->damped;
        next = e->factor + row(3 * e->damped);
        make_matrix(a, e);
    }
}

/* Damping of shared nodes over their mass: the mean over the copies, each weighed by its mass, of what the
 * faces of each element give it over the mass of its copy; three components at a time. */
static void share_nodes(rg_absorbing *a, rg_assembly *nodes) {
    static const int component[6][2] = {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
    size_t rows = 0;
    for (size_t i = 0; i < a->entries; i++) {
        rows += (size_t)a->entry[i].damped;
    }
    a->room = RG_NEW(double, 6 * rows + 1);
    rg_real *field = RG_NEW(rg_real, a->surface.domain->blocks * RG_NODE_BLOCK);
    for (int part = 0; part < 6; part += 3) {
        memset(field, 0, a->surface.domain->blocks * RG_NODE_BLOCK * sizeof *field);
        for (size_t i = 0; i < a->entries; i++) {
            const entry *e = &a->entry[i];
            for (int k = 0; k < e->sides * RG_FNODES * 3; k++) {
                const side *s = &e->side[k / (RG_FNODES * 3)];
                int q = k / 3 % RG_FNODES, node = rg_face_node[s->face][q], c = k % 3;
                const int *at = component[part + c];
                field[rg_node_index((size_t)e->slot, node, c)] +=
                    (rg_real)(a->lumped[q] * impedance(s, at[0], at[1]) / a->mass_of_node[node]);
            }
        }
        rg_assembly_mean(nodes, field);
        double *next = a->room;
        for (size_t i = 0; i < a->entries; i++) {
            entry *e = &a->entry[i];
            e->shared = (double(*)[6])(void *)next;
            for (int k = 0; k < 3 * e->damped; k++) {
                e->shared[k / 3][part + k % 3] = field[rg_node_index((size_t)e->slot, e->node[k / 3], k % 3)];
            }
            next += 6 * e->damped;
        }
    }
    rg_free(field);
}

static void make_rules(rg_absorbing *a, rg_mass mass) {
    const rg_surface *s = &a->surface;
    double trace = 0;
    for (int i = 0; i < RG_FNODES * RG_FNODES * RG_POINTS; i++) {
        int q = i % RG_POINTS, j = i / RG_POINTS % RG_FNODES, k = i / RG_POINTS / RG_FNODES;
        a->face_mass[k][j] += s->weight[q] * s->shape[q][k] * s->shape[q][j];
    }
    for (int k = 0; k < RG_FNODES; k++) {
        trace += a->face_mass[k][k];
    }
    for (int k = 0; k < RG_FNODES; k++) {
        a->lumped[k] = a->face_mass[k][k] / trace;
    }
    for (int n = 0; n < RG_NODES; n++) {
        a->mass_of_node[n] = rg_mass_entry(mass, n, n);
    }
}

static bool any_side(const rg_case *c) {
    bool any = false;
    for (int b = 0; b < c->boundaries; b++) {
        any = any || rg_boundary_damps(&c->boundary[b]);
    }
    return any;
}

rg_absorbing *rg_absorbing_make(const rg_case *c, const rg_domain *d, const rg_part *part,
                                const rg_material *m, rg_assembly *nodes, rg_account *account,
                                MPI_Comm comm) {
    rg_absorbing *a = RG_NEW(rg_absorbing, 1);
    *a = (rg_absorbing){.surface = rg_surface_make(d, m, c->mass), .account = account, .item = -1};
    a->tile_begin = RG_NEW(size_t, d->tiles + 1);
    if (!any_side(c)) {
        return a;
    }
    a->item = rg_account_add(account, NULL);
    make_rules(a, c->mass);
    damping by = find_faces(c, d, part, comm);
    uint16_t *damped = RG_NEW(uint16_t, d->blocks * RG_LANES + 1);
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        damped[slot] = (uint16_t)nodes_of(by.faces[slot]);
    }
    if (nodes != NULL) { /* also copies of elements that only touch a side */
        rg_assembly_spread(nodes, damped);
    }
    size_t room = 0;
    for (size_t t = 0; t < d->tiles; t++) {
        for (size_t slot = d->tile[t].begin * RG_LANES; slot < d->tile[t].end * RG_LANES; slot++) {
            if (damped[slot] != 0) {
                a->entry = rg_grow(a->entry, &room, a->entries + 1, sizeof *a->entry);
                a->entry[a->entries++] = make_entry(a, slot, &by, damped[slot]);
            }
        }
        a->tile_begin[t + 1] = a->entries;
    }
    rg_free(damped);
    rg_free(by.faces);
    rg_free(by.absorbing);
    rg_free(by.dashpot);
    if (nodes != NULL) {
        share_nodes(a, nodes);
    } else {
        make_matrices(a);
    }
    return a;
}

void rg_absorbing_free(rg_absorbing *a) {
    if (a != NULL) {
        rg_free(a->tile_begin);
        rg_free(a->entry);
        rg_free(a->room);
        rg_free(a);
    }
}
