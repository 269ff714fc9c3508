#include "solver/load.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "base/first_bad.h"
#include "base/mem.h"
#include "base/vector.h"
#include "domain/element.h"
#include "solver/selection.h"
#include "solver/tile.h"

/* Of a force, what its components are told to. */
#define ROUNDING 1e-6

/* A face under a load, or an element (face < 0), and what acts on its nodes at the present step. */
typedef struct {
    rg_lid slot;
    int8_t face;
    int16_t load;
    double before; /* work of the half step that led here (J) */
    double (
        *value)[3]; /* of a load that depends on place: at the points of the face, the nodes of the element */
    double omega2;  /* most that a pressure adds to the squared frequency of its element (1/s^2) */
    double (*force)[3]; /* on the nodes of the face, or of the element (N); NULL: m a, the same everywhere */
} entry;

typedef struct {
    const rg_load_input *input;
    int item; /* of the account */
    bool by_place, by_time;
    bool acts;       /* at the present time */
    double value[3]; /* at the present time, where it is the same everywhere */
    rg_selected on;  /* of reference; inside cracks, both sides */
    bool weighed;
    double force[3]; /* in all, where it was weighed (N) */
} load;

struct rg_loads {
    const rg_case *input;
    rg_surface surface;
    rg_account *account;
    MPI_Comm comm;
    int count, threads;
    load *load;
    rg_expr *(*own)[3]; /* [threads][count]: of loads that depend on place and time */
    size_t *tile_begin; /* entries of tile t, load by load: from tile_begin[t] on */
    double follows;     /* largest singular value of a pressure's stiffness (solver/surface.h) */
    double *slot_omega2, *tile_omega2; /* [slots], [tiles]: what pressures add now (1/s^2) */
    entry *entry;
    double (*room)[3];                                  /* of the values and forces of the entries */
    double row_sum[RG_NODES], mass[RG_NODES][RG_NODES]; /* M/(rho V), and the sums of its rows */
    double time, dt_last, dt_next;
    rg_first_bad bad; /* where a value was not finite first, and when */
};

static bool is_centrifugal(const load *l) {
    return l->input->kind == RG_LOAD_CENTRIFUGAL;
}

static bool is_foundation(const load *l) {
    return l->input->kind == RG_LOAD_FOUNDATION;
}

/* Of a value: of a pressure, a foundation and a speed there is one. */
static int components(const load *l) {
    return l->input->kind == RG_LOAD_PRESSURE || is_foundation(l) || is_centrifugal(l) ? 1 : 3;
}

static bool is_body_force(const load *l) {
    return rg_load_is_inside(l->input);
}

/* Whether the case gives it place by place: a speed it does not, though its forces differ. */
static bool is_given_by_place(const load *l) {
    return l->by_place && !is_centrifugal(l);
}

/* Nodes on which an entry's forces are. */
static int nodes(const entry *e) {
    return e->face >= 0 ? RG_FNODES : RG_NODES;
}

static int node_of(const entry *e, int a) {
    return e->face >= 0 ? rg_face_node[e->face][a] : a;
}

static size_t index_of(const entry *e, int a, int c) {
    return rg_node_index((size_t)e->slot, node_of(e, a), c);
}

static double mass_of(const rg_loads *all, const entry *e) {
    return rg_element_mass(all->surface.domain, all->surface.material, (size_t)e->slot);
}

/* ---- Values ---- */

static void note(rg_loads *all, int which, const double x[3], double time) {
#pragma omp critical(loads)
    if (all->bad.which == RG_NOWHERE || all->bad.value == time) { /* what comes later only follows */
        rg_first_bad_note(&all->bad, which, x, time);
    }
}

/* Component c of load i at a place of reference. */
static double value_at(rg_loads *all, int i, const rg_expr *e, const double x[3], double time) {
    double value = e == NULL ? 0 : rg_expr_value(e, x, time);
    if (!isfinite(value)) {
        note(all, i, x, time);
    }
    return value;
}

/* M a of an element whose acceleration depends on place. */
static void body_forces(const rg_loads *all, entry *e) {
    double mass = mass_of(all, e);
    for (int a = 0; a < RG_NODES; a++) {
        for (int c = 0; c < 3; c++) {
            double sum = 0;
            for (int b = 0; b < RG_NODES; b++) {
                sum += all->mass[a][b] * e->value[b][c];
            }
            e->force[a][c] = mass * sum;
        }
    }
}

/* The values of an entry that depend on place, by expressions of this thread. */
static void evaluate(rg_loads *all, entry *e, rg_expr *const expr[3], double time) {
    const rg_surface *s = &all->surface;
    const load *l = &all->load[e->load];
    double x[RG_FNODES][3], at[3];
    if (e->face >= 0) {
        rg_surface_place(s, (size_t)e->slot, e->face, NULL, x);
    }
    for (int q = 0; q < (e->face >= 0 ? RG_POINTS : RG_NODES); q++) {
        if (e->face >= 0) {
            rg_surface_at(s, q, x, at);
        } else {
            rg_node_position(s->domain->corner + 12 * (size_t)e->slot, q, at);
        }
        for (int c = 0; c < components(l); c++) {
            e->value[q][c] = value_at(all, e->load, expr[c], at, time);
        }
    }
    if (e->face < 0) {
        body_forces(all, e);
    }
}

static void set_even_value(rg_loads *all, int i, double time) {
    static const double nowhere[3] = {0, 0, 0};
    load *l = &all->load[i];
    double share = l->input->kind == RG_LOAD_FORCE ? 1 / l->on.size : 1;
    for (int c = 0; c < components(l); c++) {
        l->value[c] = share * value_at(all, i, l->input->value[l->input->kind][c], nowhere, time);
    }
}

void rg_loads_set(rg_loads *all, double time, double dt_last, double dt_next) {
    all->time = time;
    all->dt_last = dt_last;
    all->dt_next = dt_next;
    for (int i = 0; i < all->count; i++) {
        load *l = &all->load[i];
        l->acts = time >= l->input->from && !(l->input->until > 0 && time >= l->input->until);
        if (l->acts && l->by_time && !is_given_by_place(l)) {
            set_even_value(all, i, time);
        }
    }
}

void rg_loads_set_springs(rg_loads *all) {
    rg_loads_set(all, 0, 0, 0);
    for (int i = 0; i < all->count; i++) {
        all->load[i].acts = all->load[i].acts && is_foundation(&all->load[i]);
    }
}

/* ---- Forces ---- */

/* Accelerations of an element's nodes away from the axis, where they are by now. */
static void spin_out(const rg_loads *all, entry *e, const rg_real *u) {
    const load *l = &all->load[e->load];
    double length = sqrt(rg_vector_dot(l->input->axis, l->input->axis)), axis[3], x[3];
    double square = l->value[0] * l->value[0];
    for (int a = 0; a < RG_NODES; a++) {
        rg_node_position(all->surface.domain->corner + 12 * (size_t)e->slot, a, x);
        for (int c = 0; c < 3; c++) {
            axis[c] = l->input->axis[c] / length;
            x[c] += u[index_of(e, a, c)] - l->input->at[c];
        }
        double along = rg_vector_dot(axis, x);
        for (int c = 0; c < 3; c++) {
            e->value[a][c] = square * (x[c] - along * axis[c]);
        }
    }
    body_forces(all, e);
}

/* Displacements of an entry's nodes. */
static void displacements(const entry *e, const rg_real *u, double out[RG_FNODES][3]) {
    for (int i = 0; i < 3 * RG_FNODES; i++) {
        out[i / 3][i % 3] = u[index_of(e, i / 3, i % 3)];
    }
}

static void face_forces(const rg_loads *all, entry *e, const rg_real *u) {
    const rg_surface *s = &all->surface;
    const load *l = &all->load[e->load];
    bool follows = l->input->kind == RG_LOAD_PRESSURE;
    double normal[3], x[RG_FNODES][3];
    double area = rg_surface_area(s->domain->corner + 12 * (size_t)e->slot, e->face, normal), out = 1;
    memset(e->force, 0, RG_FNODES * sizeof *e->force);
    if (follows) { /* which way x,1 cross x,2 points, from the face of reference */
        double edge[2][3], product[3];
        rg_surface_place(s, (size_t)e->slot, e->face, NULL, x);
        rg_vector_subtract(x[1], x[0], edge[0]);
        rg_vector_subtract(x[2], x[0], edge[1]);
        rg_vector_cross(edge[0], edge[1], product);
        out = rg_vector_dot(product, normal) > 0 ? 1 : -1;
        rg_surface_place(s, (size_t)e->slot, e->face, u, x);
    }
    double steepest = 0; /* pressure times tangents */
    bool springs = is_foundation(l);
    if (springs) {
        displacements(e, u, x);
    }
    for (int q = 0; q < RG_POINTS; q++) {
        const double *value = l->by_place ? e->value[q] : l->value;
        double t[3] = {value[0] * area, value[1] * area, value[2] * area};
        if (springs) {
            double here[3];
            rg_surface_at(s, q, x, here);
            for (int c = 0; c < 3; c++) {
                t[c] = -value[0] * area * here[c];
            }
        }
        if (follows) {
            double tangent[2][3] = {{0}};
            for (int a = 0; a < RG_FNODES; a++) {
                for (int c = 0; c < 3; c++) {
                    tangent[0][c] += s->slope[q][0][a] * x[a][c];
                    tangent[1][c] += s->slope[q][1][a] * x[a][c];
                }
            }
            rg_vector_cross(tangent[0], tangent[1], t);
            steepest = fmax(steepest, fabs(value[0]) * (sqrt(rg_vector_dot(tangent[0], tangent[0])) +
                                                        sqrt(rg_vector_dot(tangent[1], tangent[1]))));
            for (int c = 0; c < 3; c++) {
                t[c] *= -0.5 * out * value[0]; /* the triangle of barycentric coordinates has area 1/2 */
            }
        }
        for (int a = 0; a < RG_FNODES; a++) {
            for (int c = 0; c < 3; c++) {
                e->force[a][c] += s->weight[q] * s->shape[q][a] * t[c];
            }
        }
    }
    e->omega2 = follows ? 0.5 * all->follows * steepest / mass_of(all, e) : 0;
}

/* Component c of an entry's force on its node a; `mass` of its element. */
static double force_on(const rg_loads *all, const entry *e, double mass, int a, int c) {
    return e->force != NULL ? e->force[a][c] : mass * all->row_sum[a] * all->load[e->load].value[c];
}

/* Power of an entry's forces at a velocity (a whole field). */
static double power(const rg_loads *all, const entry *e, const rg_real *velocity) {
    const double *value = all->load[e->load].value;
    double sum = 0;
    for (int a = 0; a < nodes(e); a++) {
        for (int c = 0; c < 3; c++) {
            double force = e->force != NULL ? e->force[a][c] : all->row_sum[a] * value[c];
            sum += force * velocity[index_of(e, a, c)];
        }
    }
    return e->force != NULL ? sum : mass_of(all, e) * sum;
}

/* Share of the points of an entry's face that have separated. */
static double open_share(const rg_loads *all, const entry *e, const rg_tile *t, const rg_solver *s) {
    int32_t link = all->surface.domain->interface[rg_link_index((size_t)e->slot, e->face)];
    size_t i = t->ibegin * RG_LANES + (size_t)link / 4;
    int count = 0;
    for (int q = 0; s->broken[i] != 0 && q < RG_POINTS; q++) {
        count += rg_point_is_broken(s, i, q) &&
                 *rg_crack_value(s, i, q, RG_CRACK_OPENING) >= rg_separation(s, i, q);
    }
    return (double)count / RG_POINTS;
}

static void find_face_forces(const rg_loads *all, entry *e, const rg_tile *t, const rg_solver *s) {
    double share = all->load[e->load].input->cracks ? open_share(all, e, t, s) : 1;
    if (share <= 0) {
        memset(e->force, 0, RG_FNODES * sizeof *e->force);
        return;
    }
    face_forces(all, e, s->u);
    e->omega2 *= share;
    for (int i = 0; i < 3 * RG_FNODES; i++) {
        e->force[i / 3][i % 3] *= share;
    }
}

/* What the pressures on each element of a tile add to its squared frequency, all together. */
static void add_omega2(const rg_loads *all, size_t tile) {
    double most = 0;
    for (size_t i = all->tile_begin[tile]; i < all->tile_begin[tile + 1]; i++) {
        all->slot_omega2[all->entry[i].slot] = 0;
    }
    for (size_t i = all->tile_begin[tile]; i < all->tile_begin[tile + 1]; i++) {
        double *sum = &all->slot_omega2[all->entry[i].slot];
        *sum += all->entry[i].omega2;
        most = fmax(most, *sum);
    }
    all->tile_omega2[tile] = most;
}

double rg_loads_omega2_now(const rg_loads *all) {
    double most = 0;
    for (size_t t = 0; t < all->surface.domain->tiles; t++) {
        most = fmax(most, all->tile_omega2[t]);
    }
    return most;
}

void rg_loads_find(rg_loads *all, size_t tile, const rg_solver *s) {
    for (size_t i = all->tile_begin[tile]; i < all->tile_begin[tile + 1]; i++) {
        entry *e = &all->entry[i];
        const load *l = &all->load[e->load];
        e->omega2 = 0;
        if (!l->acts) {
            continue;
        }
        if (is_centrifugal(l)) {
            spin_out(all, e, s->u);
        } else if (l->by_place && l->by_time) {
            evaluate(all, e, all->own[omp_get_thread_num() * all->count + e->load], all->time);
        }
        if (e->face >= 0) {
            find_face_forces(all, e, &s->domain->tile[tile], s);
        }
        e->before = 0.5 * all->dt_last * power(all, e, s->velocity);
    }
    add_omega2(all, tile);
}

/* An element moves by just the acceleration of its nodes. */
static void accelerate(const rg_loads *all, const entry *e, const rg_push *push) {
    const load *l = &all->load[e->load];
    for (int a = 0; a < RG_NODES; a++) {
        const double *value = l->by_place ? e->value[a] : l->value;
        for (int c = 0; c < 3; c++) {
            size_t at = rg_node_index((size_t)e->slot, a, c);
            push->velocity[at] = (rg_real)(push->velocity[at] + push->dt * value[c]);
            if (push->step_velocity != NULL) {
                push->step_velocity[at] = (rg_real)(push->step_velocity[at] + push->dt_now * value[c]);
            }
        }
    }
}

void rg_loads_push(const rg_loads *all, size_t tile, const rg_push *push) {
    for (size_t i = all->tile_begin[tile]; i < all->tile_begin[tile + 1]; i++) {
        entry *e = &all->entry[i];
        if (!all->load[e->load].acts) {
            continue;
        }
        if (e->face >= 0) {
            rg_surface_push(&all->surface, (size_t)e->slot, e->face, e->force, push);
        } else {
            accelerate(all, e, push);
        }
    }
}

static void add_entry(const rg_loads *all, const entry *e, const rg_real *u, const rg_real *velocity,
                      rg_account_entry *sum) {
    double mass = e->force != NULL ? 0 : mass_of(all, e);
    for (int a = 0; a < nodes(e); a++) {
        double force[3];
        for (int c = 0; c < 3; c++) {
            force[c] = force_on(all, e, mass, a, c);
        }
        rg_account_add_force(sum, all->surface.domain, (size_t)e->slot, node_of(e, a), u, force);
    }
    sum->before += e->before;
    sum->after += 0.5 * all->dt_next * power(all, e, velocity);
}

void rg_loads_book(const rg_loads *all, size_t tile, const rg_real *u, const rg_real *velocity) {
    size_t i = all->tile_begin[tile], end = all->tile_begin[tile + 1];
    while (i < end) {
        int16_t which = all->entry[i].load;
        rg_account_entry sum = {.before = 0};
        for (; i < end && all->entry[i].load == which; i++) {
            if (all->load[which].acts) {
                add_entry(all, &all->entry[i], u, velocity, &sum);
            }
        }
        if (all->load[which].acts) {
            rg_account_book(all->account, all->load[which].item, &sum);
        }
    }
}

static bool lasts(const load *l) {
    return !(l->input->from > 0) && !(l->input->until > 0);
}

double rg_loads_work(const rg_loads *all) {
    double work = 0;
    for (int i = 0; i < all->count; i++) {
        const load *l = &all->load[i];
        work += is_foundation(l) && lasts(l) ? 0 : all->account->item[l->item].work_now;
    }
    return work;
}

void rg_loads_energy(const rg_loads *all, size_t tile, const rg_real *u, rg_exact_sum *stored,
                     rg_exact_sum *brief) {
    for (size_t i = all->tile_begin[tile]; i < all->tile_begin[tile + 1]; i++) {
        const entry *e = &all->entry[i];
        const load *l = &all->load[e->load];
        double moved[RG_FNODES][3], here[3], normal[3];
        if (!is_foundation(l) || !l->acts) {
            continue;
        }
        displacements(e, u, moved);
        double area = rg_surface_area(all->surface.domain->corner + 12 * (size_t)e->slot, e->face, normal);
        for (int q = 0; q < RG_POINTS; q++) {
            rg_surface_at(&all->surface, q, moved, here);
            double energy = 0.5 * all->surface.weight[q] * area *
                            (l->by_place ? e->value[q][0] : l->value[0]) * rg_vector_dot(here, here);
            rg_exact_add(stored, energy);
            rg_exact_add(brief, lasts(l) ? 0 : energy);
        }
    }
}

static const char *const key[] = {
#define KEY(NAME, word, unit) word,
    RG_LOADS(KEY, )
#undef KEY
};

void rg_loads_weigh(rg_loads *all) {
    rg_exact_sum *sum = RG_NEW(rg_exact_sum, 3 * (size_t)all->count + 1);
    for (size_t n = 0; n < all->tile_begin[all->surface.domain->tiles]; n++) {
        const entry *e = &all->entry[n];
        double mass = mass_of(all, e);
        for (int i = 0; all->load[e->load].acts && i < 3 * nodes(e); i++) {
            rg_exact_add(&sum[3 * e->load + i % 3], force_on(all, e, mass, i / 3, i % 3));
        }
    }
    rg_exact_allreduce(sum, 3 * all->count, all->comm);
    for (int i = 0; i < 3 * all->count; i++) {
        all->load[i / 3].weighed = true;
        all->load[i / 3].force[i % 3] = rg_exact_value(&sum[i]);
    }
    rg_free(sum);
}

/* When it begins, or its force: what only rounding leaves of a component is none. */
static void describe_force(const load *l, char *words, size_t size) {
    double most = fmax(fabs(l->force[0]), fmax(fabs(l->force[1]), fabs(l->force[2]))), f[3];
    words[0] = '\0';
    for (int c = 0; c < 3; c++) {
        f[c] = fabs(l->force[c]) > ROUNDING * most ? l->force[c] : 0;
    }
    if (l->input->from > 0) {
        snprintf(words, size, "; from %g s on", l->input->from);
    } else if (l->weighed) {
        snprintf(words, size, "; (%.4g, %.4g, %.4g) N at t = 0", f[0], f[1], f[2]);
    }
}

void rg_loads_describe(const rg_loads *all, int i, char *words, size_t size) {
    const load *l = &all->load[i];
    const char *what = key[l->input->kind];
    rg_selected part = l->on;
    if (l->input->cracks) { /* of one side */
        part.count /= 2;
        part.size /= 2;
    }
    char on[200], force[100];
    rg_selected_tell(&part, is_body_force(l), on, sizeof on);
    describe_force(l, force, sizeof force);
    const char *where = l->input->cracks          ? "in cracks, on each side on at most"
                        : !is_body_force(l)       ? "on"
                        : l->input->where == NULL ? "of the body,"
                                                  : "of a part of it,";
    snprintf(words, size, "%s %s %s%s", what, where, on, force);
}

bool rg_loads_told(const rg_loads *all, char *words, size_t size) {
    rg_first_bad bad = all->bad;
    double first = bad.which == RG_NOWHERE ? INFINITY : bad.value;
    MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_DOUBLE, MPI_MIN, all->comm);
    if (bad.which != RG_NOWHERE && bad.value > first) { /* it only followed */
        bad.which = RG_NOWHERE;
    }
    bool found = rg_first_bad_lowest(&bad, all->comm);
    if (found) {
        snprintf(words, size, "loads[%d].%s is not finite at (%g, %g, %g), t = %g s", (int)bad.which,
                 key[all->input->load[bad.which].kind], bad.x[0], bad.x[1], bad.x[2], bad.value);
    }
    return found;
}

/* ---- Set-up ---- */

/* Elements of an acceleration: those at whose centroid `where` is not 0. */
static bool has_element(rg_loads *all, int i, size_t slot) {
    const rg_domain *d = all->surface.domain;
    const rg_expr *where = all->load[i].input->where;
    double x[3];
    if (d->id[slot] < 0 || where == NULL) {
        return d->id[slot] >= 0;
    }
    for (int c = 0; c < 3; c++) {
        const double *corner = d->corner + 12 * slot + c;
        x[c] = 0.25 * (corner[0] + corner[3] + corner[6] + corner[9]);
    }
    return value_at(all, i, where, x, 0) != 0;
}

/* What a load acts on: bits of faces of each slot, or 1 where it acts on the element. */
static uint8_t *parts_of(rg_loads *all, int i, const rg_part *part) {
    const rg_load_input *in = all->load[i].input;
    const rg_domain *d = all->surface.domain;
    if (!is_body_force(&all->load[i])) {
        rg_selection s = {"loads", i, in->set, in->where, in->cracks};
        return rg_selection_faces(&s, all->input, d, part, all->comm);
    }
    uint8_t *on = RG_NEW(uint8_t, d->blocks * RG_LANES + 1);
    int64_t count = 0;
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        on[slot] = has_element(all, i, slot);
        count += on[slot];
    }
    MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPI_INT64_T, MPI_SUM, all->comm);
    if (rg_first_bad_lowest(&all->bad, all->comm) || count == 0) {
        const double *x = all->bad.x;
        rg_speak(all->comm);
        if (all->bad.which != RG_NOWHERE) {
            rg_fatal(RG_USAGE, "%s: loads[%d].where: %s is not finite at (%g, %g, %g)", all->input->path, i,
                     rg_expr_text(in->where), x[0], x[1], x[2]);
        }
        rg_fatal(RG_USAGE, "%s: loads[%d]: no element is in it, where: %s", all->input->path, i,
                 rg_expr_text(in->where));
    }
    return on;
}

/* Visits what a load acts on in a tile: counts it and, with room for it, lists it. */
static size_t list_parts(const rg_loads *all, int i, const uint8_t *on, const rg_tile *t, entry *out) {
    bool body = is_body_force(&all->load[i]);
    size_t count = 0;
    for (size_t slot = t->begin * RG_LANES; slot < t->end * RG_LANES; slot++) {
        for (int f = 0; f < (body ? 1 : RG_FACES); f++) {
            if ((on[slot] >> f & 1) != 0) {
                if (out != NULL) {
                    out[count] =
                        (entry){.slot = (rg_lid)slot, .face = (int8_t)(body ? -1 : f), .load = (int16_t)i};
                }
                count++;
            }
        }
    }
    return count;
}

static void list_all(rg_loads *all, const rg_part *part) {
    const rg_domain *d = all->surface.domain;
    uint8_t **on = RG_NEW(uint8_t *, (size_t)all->count + 1);
    for (int i = 0; i < all->count; i++) {
        on[i] = parts_of(all, i, part);
        all->load[i].on = rg_selection_measure(on[i], is_body_force(&all->load[i]), all->input, d, all->comm);
    }
    all->tile_begin = RG_NEW(size_t, d->tiles + 1);
    for (int pass = 0; pass < 2; pass++) {
        for (size_t t = 0, n = 0; t < d->tiles; t++) {
            for (int i = 0; i < all->count; i++) {
                n += list_parts(all, i, on[i], &d->tile[t], pass == 0 ? NULL : all->entry + n);
            }
            all->tile_begin[t + 1] = n;
        }
        if (pass == 0) {
            all->entry = RG_NEW(entry, all->tile_begin[d->tiles] + 1);
        }
    }
    for (int i = 0; i < all->count; i++) {
        rg_free(on[i]);
    }
    rg_free(on);
}

/* Rows of values and of forces that an entry has. */
static size_t value_rows(const rg_loads *all, const entry *e) {
    return !all->load[e->load].by_place ? 0 : e->face >= 0 ? RG_POINTS : RG_NODES;
}

static size_t force_rows(const rg_loads *all, const entry *e) {
    return e->face < 0 && !all->load[e->load].by_place ? 0 : (size_t)nodes(e);
}

static void make_room(rg_loads *all) {
    size_t count = all->tile_begin[all->surface.domain->tiles], rows = 0;
    for (size_t i = 0; i < count; i++) {
        rows += value_rows(all, &all->entry[i]) + force_rows(all, &all->entry[i]);
    }
    all->room = rg_alloc(rows + 1, sizeof *all->room);
    double(*next)[3] = all->room;
    for (size_t i = 0; i < count; i++) {
        entry *e = &all->entry[i];
        size_t values = value_rows(all, e), forces = force_rows(all, e);
        e->value = values > 0 ? next : NULL;
        e->force = forces > 0 ? next + values : NULL;
        next += values + forces;
    }
}

double rg_loads_omega2(const rg_loads *all) {
    const rg_domain *d = all->surface.domain;
    double eigenvalue = rg_surface_spring_value(&all->surface), most = 0;
    double *sum = RG_NEW(double, d->blocks *RG_LANES + 1);
    for (size_t n = 0; n < all->tile_begin[d->tiles]; n++) {
        const entry *e = &all->entry[n];
        const load *l = &all->load[e->load];
        double normal[3], stiffest = l->value[0];
        if (!is_foundation(l)) {
            continue;
        }
        for (int q = 0; l->by_place && q < RG_POINTS; q++) {
            stiffest = fmax(q > 0 ? stiffest : 0, e->value[q][0]);
        }
        double area = rg_surface_area(d->corner + 12 * (size_t)e->slot, e->face, normal);
        sum[e->slot] += eigenvalue * stiffest * area / mass_of(all, e);
        most = fmax(most, sum[e->slot]);
    }
    rg_free(sum);
    MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_DOUBLE, MPI_MAX, all->comm);
    return most;
}

void rg_loads_show(const rg_loads *all, void (*show)(void *to, size_t slot, int node, const double line[3]),
                   void *to) {
    for (size_t n = 0; n < all->tile_begin[all->surface.domain->tiles]; n++) {
        const entry *e = &all->entry[n];
        const load *l = &all->load[e->load];
        bool holds = is_foundation(l) && !(l->input->from > 0);
        for (int i = 0; holds && i < 3 * RG_FNODES; i++) {
            const double line[3] = {i % 3 == 0, i % 3 == 1, i % 3 == 2};
            show(to, (size_t)e->slot, node_of(e, i / 3), line);
        }
    }
}

/* Springs that push away from where they are fixed are none. */
static void refuse_negative(const rg_loads *all) {
    int bad = all->count;
    for (size_t n = 0; n < all->tile_begin[all->surface.domain->tiles]; n++) {
        const entry *e = &all->entry[n];
        const load *l = &all->load[e->load];
        for (int q = 0; is_foundation(l) && q < RG_POINTS; q++) {
            double value = l->by_place ? e->value[q][0] : l->value[0];
            bad = value < 0 && e->load < bad ? e->load : bad;
        }
    }
    MPI_Allreduce(MPI_IN_PLACE, &bad, 1, MPI_INT, MPI_MIN, all->comm);
    if (bad < all->count) {
        rg_speak(all->comm);
        rg_fatal(RG_USAGE, "%s: loads[%d].foundation: %s is negative somewhere", all->input->path, bad,
                 rg_expr_text(all->load[bad].input->value[RG_LOAD_FOUNDATION][0]));
    }
}

/* Values that do not change, and all others when their load begins. */
static void first_values(rg_loads *all) {
    for (int i = 0; i < all->count; i++) {
        if (!is_given_by_place(&all->load[i])) {
            set_even_value(all, i, all->load[i].input->from);
        }
    }
    for (size_t n = 0; n < all->tile_begin[all->surface.domain->tiles]; n++) {
        entry *e = &all->entry[n];
        const rg_load_input *in = all->load[e->load].input;
        if (is_given_by_place(&all->load[e->load])) {
            evaluate(all, e, in->value[in->kind], in->from);
        }
    }
    char words[400];
    if (rg_loads_told(all, words, sizeof words)) {
        rg_speak(all->comm);
        rg_fatal(RG_USAGE, "%s: %s", all->input->path, words);
    }
}

static void copy_expressions(rg_loads *all) {
    all->own = rg_alloc((size_t)(all->threads * all->count) + 1, sizeof *all->own);
    for (int n = 0; n < all->threads * all->count; n++) {
        const load *l = &all->load[n % all->count];
        for (int c = 0; l->by_place && l->by_time && c < components(l); c++) {
            all->own[n][c] = rg_expr_copy(l->input->value[l->input->kind][c]);
        }
    }
}

rg_loads *rg_loads_make(const rg_case *c, const rg_domain *d, const rg_part *part, const rg_material *m,
                        rg_account *account, int threads, MPI_Comm comm) {
    rg_loads *all = RG_NEW(rg_loads, 1);
    *all = (rg_loads){.input = c,
                      .surface = rg_surface_make(d, m, c->mass),
                      .account = account,
                      .comm = comm,
                      .count = c->loads,
                      .threads = threads,
                      .load = RG_NEW(load, (size_t)c->loads + 1),
                      .bad = {.which = RG_NOWHERE}};
    for (int a = 0; a < RG_NODES; a++) {
        for (int b = 0; b < RG_NODES; b++) {
            all->mass[a][b] = rg_mass_entry(c->mass, a, b);
            all->row_sum[a] += all->mass[a][b];
        }
    }
    for (int i = 0; i < c->loads; i++) {
        load *l = &all->load[i];
        *l = (load){.input = &c->load[i], .item = rg_account_add(account, c->load[i].name)};
        l->by_place = is_centrifugal(l);
        for (int k = 0; k < components(l); k++) {
            const rg_expr *e = c->load[i].value[c->load[i].kind][k];
            l->by_place = l->by_place || (e != NULL && rg_expr_uses_position(e));
            l->by_time = l->by_time || (e != NULL && rg_expr_uses_time(e));
        }
    }
    list_all(all, part);
    make_room(all);
    all->follows = rg_surface_follower_value(&all->surface);
    all->slot_omega2 = RG_NEW(double, d->blocks *RG_LANES + 1);
    all->tile_omega2 = RG_NEW(double, d->tiles + 1);
    copy_expressions(all);
    first_values(all);
    refuse_negative(all);
    return all;
}

void rg_loads_free(rg_loads *all) {
    if (all == NULL) {
        return;
    }
    for (int n = 0; n < 3 * all->threads * all->count; n++) {
        rg_expr_free(all->own[n / 3][n % 3]);
    }
    void *blocks[] = {all->load, all->own,         all->tile_begin,  all->entry,
                      all->room, all->slot_omega2, all->tile_omega2, all};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
        rg_free(blocks[i]);
    }
}
