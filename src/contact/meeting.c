/* Steps of contact between fragments: where faces are, what pairs do to each other and that to elements. */
#include <math.h>
#include <string.h>

#include "base/vector.h"
#include "contact/inner.h"
#include "domain/element.h"
#include "partition/material.h"

double rg_contact_projection(int corner, int node) {
    static const int end[RG_FNODES - RG_FCORNERS][2] = {{0, 1}, {1, 2}, {0, 2}};
    if (node < RG_FCORNERS) {
        return node == corner ? 0.4 : -0.2;
    }
    const int *edge = end[node - RG_FCORNERS];
    return edge[0] == corner || edge[1] == corner ? 0.6 : -0.2;
}

void rg_contact_set_row(const rg_contacts *c, size_t i, const rg_real *u, rg_real *row) {
    const rg_contact_side *f = &c->face[i];
    for (int k = 0; k < RG_CONTACT_ROW; k++) {
        double sum = 0;
        for (int a = 0; a < RG_FNODES; a++) {
            sum += rg_contact_projection(rg_contact_corner(f, k / 3), a) *
                   u[rg_node_index((size_t)f->slot, rg_face_node[f->face][a], k % 3)];
        }
        row[k] = (rg_real)sum;
    }
}

void rg_contact_set_corners(const rg_contacts *c, size_t i) {
    const rg_real *row = c->row + c->values * i;
    for (size_t k = 0; k < RG_CONTACT_ROW; k++) {
        c->corner[RG_CONTACT_ROW * i + k] = c->rest[RG_CONTACT_ROW * i + k] + row[k];
        if (c->damping > 0) {
            c->rate[RG_CONTACT_ROW * i + k] = row[RG_CONTACT_ROW + 1 + k];
        }
    }
    rg_contact_box(c->corner + RG_CONTACT_ROW * i, c->box + RG_CONTACT_BOX * i);
    c->sunk[i] = row[RG_CONTACT_ROW];
}

double rg_contact_omega2_of(const rg_contacts *c, size_t slot, int k) {
    double normal[3], area = rg_surface_area(c->domain->corner + 12 * slot, k, normal);
    return 2 * area * c->eigenvalue / rg_element_mass(c->domain, c->material, slot);
}

static double largest(const double *x, size_t count) {
    double most = 0;
    for (size_t i = 0; i < count; i++) {
        most = fmax(most, x[i]);
    }
    return most;
}

/* How far a face has got from one state to another, over what it may between two searches. */
static double way(const rg_contacts *c, const double *from, const double *to) {
    double moved = 0, n[2][3];
    for (size_t k = 0; k < RG_CONTACT_ROW; k += 3) {
        moved = fmax(moved, rg_vector_distance2(from + k, to + k));
    }
    rg_vector_normal(from, n[0]);
    rg_vector_normal(to, n[1]);
    return fmax(sqrt(moved) / c->fat, sqrt(rg_vector_distance2(n[0], n[1])) / RG_CONTACT_TURN);
}

void rg_contacts_place(rg_contacts *c, size_t tile, const rg_real *u, const rg_real *velocity,
                       const rg_real *sunk) {
    for (size_t i = c->tile_begin[tile]; i < c->tile_begin[tile + 1]; i++) {
        size_t at = c->face[i].interface;
        rg_real *row = c->row + c->values * i;
        double before[RG_CONTACT_ROW];
        memcpy(before, c->corner + RG_CONTACT_ROW * i, sizeof before);
        rg_contact_set_row(c, i, u, row);
        row[RG_CONTACT_ROW] = at == RG_CONTACT_NO_INTERFACE ? 0 : sunk[at];
        if (c->damping > 0) {
            rg_contact_set_row(c, i, velocity, row + RG_CONTACT_ROW + 1);
        }
        rg_contact_set_corners(c, i);
        c->moved[i] = way(c, c->last + RG_CONTACT_ROW * i, c->corner + RG_CONTACT_ROW * i);
        c->stepped[i] = way(c, before, c->corner + RG_CONTACT_ROW * i);
    }
}

/* Work of corners' forces per time. */
static double power_of(const double *force, const double *rate) {
    double sum = 0;
    for (int k = 0; k < RG_CONTACT_ROW; k++) {
        sum += force[k] * rate[k];
    }
    return sum;
}

void rg_contacts_settle(rg_contacts *c, size_t tile, double half, double *heat) {
    for (size_t i = c->tile_begin[tile]; c->damping > 0 && i < c->tile_begin[tile + 1]; i++) {
        double taken = power_of(c->dragged + RG_CONTACT_ROW * i, c->rate + RG_CONTACT_ROW * i);
        heat[c->face[i].slot] -= half * (taken - c->shift[i]);
    }
}

rg_halo *rg_contacts_halo(const rg_contacts *c) {
    return c->halo;
}

/* Counts the pairs of a tile that touch, and bounds the squared frequency of elements that they press. */
static void note_touching(rg_contacts *c, size_t tile) {
    double most = 0, sum = 0;
    int64_t count = 0;
    for (size_t i = c->tile_begin[tile]; i < c->tile_begin[tile + 1]; i++) {
        const rg_contact_side *f = &c->face[i];
        double kappa = 0;
        sum = i > c->tile_begin[tile] && f->slot == f[-1].slot ? sum : 0;
        for (size_t k = f->touch; k < f[1].touch; k++) {
            size_t pair = c->touch[k].pair;
            if (c->energy[pair] > 0) {
                kappa = fmax(kappa, c->pair[pair].stiffness);
                kappa = c->damping > 0 ? fmax(kappa, c->stiffer[pair]) : kappa;
                count += c->touch[k].side == 0;
            }
        }
        sum += kappa > 0 ? kappa * rg_contact_omega2_of(c, (size_t)f->slot, f->face) : 0;
        most = fmax(most, sum);
    }
    c->tile_omega2[tile] = most;
    c->tile_touching[tile] = count;
}

/* Power of damping on both faces of pairs that press, while all of them have their velocity of one time: in
 * the sweep that follows, tiles move on one by one. */
static void note_power(rg_contacts *c, size_t begin, size_t end) {
    for (size_t i = begin; i < end; i++) {
        for (int k = 0; c->energy[i] > 0 && k < 2; k++) {
            c->power[2 * i + (size_t)k] = power_of(c->drag + 18 * i + (size_t)(RG_CONTACT_ROW * k),
                                                   c->rate + RG_CONTACT_ROW * c->pair[i].face[k]);
        }
    }
}

void rg_contacts_meet(rg_contacts *c, const rg_kernels *kernels, double dt) {
    enum { BATCH = 256 };
    rg_contact_args args = {.corner = c->corner,
                            .box = c->box,
                            .sunk = c->sunk,
                            .pair = c->pair,
                            .force = c->force,
                            .energy = c->energy,
                            .depth = c->depth,
                            .grip = dt > 0 ? c->grip : NULL,
                            .heat = c->heat,
                            .rate = dt > 0 ? c->rate : NULL,
                            .damping = c->damping,
                            .dt = dt,
                            .drag = c->drag,
                            .stiffer = c->stiffer};
    size_t batches = (c->pairs + BATCH - 1) / BATCH;
#pragma omp for schedule(static)
    for (size_t i = c->faces; i < c->faces + c->far; i++) {
        rg_contact_set_corners(c, i);
    }
#pragma omp for schedule(static)
    for (size_t b = 0; b < batches; b++) {
        size_t end = (b + 1) * BATCH < c->pairs ? (b + 1) * BATCH : c->pairs;
        kernels->contact(&args, b * BATCH, end);
        if (args.rate != NULL) {
            note_power(c, b * BATCH, end);
        }
    }
#pragma omp for schedule(static)
    for (size_t t = 0; t < c->domain->tiles; t++) {
        note_touching(c, t);
    }
}

/* Forces on the corners of a face, and the sum of their sizes by pairs (N); false where it touches nothing.
 */
static bool face_forces(const rg_contacts *c, const rg_contact_side *f, double force[3][3], double *felt) {
    bool touches = false;
    memset(force, 0, 9 * sizeof(double));
    for (size_t i = f->touch; i < f[1].touch; i++) {
        const rg_contact_touch *t = &c->touch[i];
        double sum[3] = {0, 0, 0};
        if (!(c->energy[t->pair] > 0)) {
            continue;
        }
        const double *of = c->force + 18 * t->pair + 9 * t->side;
        touches = true;
        for (int k = 0; k < 9; k++) {
            force[k / 3][k % 3] += of[k];
            sum[k % 3] += of[k];
        }
        *felt += sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    }
    return touches;
}

static void push_element(const rg_contacts *c, const rg_contact_side *f, double force[3][3],
                         const rg_push *push) {
    double mass = rg_element_mass(c->domain, c->material, (size_t)f->slot);
    for (int n = 0; n < RG_NODES; n++) {
        for (int k = 0; k < 3; k++) {
            double a = 0;
            for (int i = 0; i < RG_FCORNERS; i++) {
                a += c->push[f->face][n][rg_contact_corner(f, i)] * force[i][k];
            }
            size_t at = rg_node_index((size_t)f->slot, n, k);
            push->velocity[at] = (rg_real)(push->velocity[at] + push->dt * a / mass);
            if (push->step_velocity != NULL) {
                push->step_velocity[at] = (rg_real)(push->step_velocity[at] + push->dt_now * a / mass);
            }
        }
    }
}

/* How deep a face is in others, beyond their common skin. */
static double depth_of(const rg_contacts *c, const rg_contact_side *f) {
    double depth = 0;
    for (size_t i = f->touch; i < f[1].touch; i++) {
        size_t pair = c->touch[i].pair;
        depth = fmax(depth, c->depth[pair] - c->pair[pair].skin);
    }
    return depth;
}

/* What damping takes of the pairs of a face in the half step that led here, half of it for its element, and
 * what it takes of each half of the one to come but for what the faces change their velocity by: then the
 * force of a pair is on both as fast as they are now, here a half of it again. */
static void note_drag(const rg_contacts *c, const rg_contact_side *f, double before, double *heat) {
    size_t i = (size_t)(f - c->face);
    c->shift[i] = 0;
    memset(c->dragged + RG_CONTACT_ROW * i, 0, RG_CONTACT_ROW * sizeof *c->dragged);
    for (size_t k = f->touch; k < f[1].touch; k++) {
        const rg_contact_touch *t = &c->touch[k];
        if (!(c->energy[t->pair] > 0)) {
            continue;
        }
        const double *work = c->power + 2 * t->pair;
        for (int n = 0; n < RG_CONTACT_ROW; n++) {
            c->dragged[RG_CONTACT_ROW * i + (size_t)n] +=
                c->drag[18 * t->pair + (size_t)(RG_CONTACT_ROW * t->side + n)];
        }
        c->shift[i] += 0.5 * (work[t->side] - work[1 - t->side]);
        heat[f->slot] -= 0.5 * before * (work[0] + work[1]);
    }
}

/* Pushes the element of a face; returns whether it touches something. */
static bool push_face(const rg_contacts *c, const rg_contact_side *f, const rg_push *push, double dt,
                      const rg_contact_record *to) {
    double force[3][3], felt = 0;
    if (f->interface != RG_CONTACT_NO_INTERFACE && to->sunk[f->interface] > 0) {
        to->sunk[f->interface] = (rg_real)fmin(to->sunk[f->interface], depth_of(c, f));
    }
    bool touches = face_forces(c, f, force, &felt);
    if (touches) {
        push_element(c, f, force, push);
        to->impulse[f->slot] += felt * dt;
    }
    if (c->damping > 0) {
        note_drag(c, f, push->dt_now, to->heat);
    }
    for (size_t k = f->touch; c->heat != NULL && to->heat != NULL && k < f[1].touch; k++) {
        to->heat[f->slot] += 0.5 * c->heat[c->touch[k].pair];
    }
    return touches;
}

void rg_contacts_push(const rg_contacts *c, size_t tile, const rg_push *push, double dt,
                      const rg_contact_record *to) {
    bool touches = false;
    for (size_t i = c->tile_begin[tile]; i < c->tile_begin[tile + 1]; i++) {
        rg_lid slot = c->face[i].slot;
        touches = push_face(c, &c->face[i], push, dt, to) || touches;
        if (i + 1 == c->tile_begin[tile + 1] || c->face[i + 1].slot != slot) { /* all of its element's */
            to->touches[slot] += touches && to->touching[slot] == 0;
            to->touching[slot] =
                (uint8_t)(touches ? RG_TOUCH_AFRESH : to->touching[slot] - (to->touching[slot] > 0));
            touches = false;
        }
    }
}

/* ---- What it is told of ---- */

static bool is_chosen(const rg_contact_choice *which, const rg_contacts *c, size_t i) {
    const rg_contact_side *f = &c->face[i];
    return which->faces != NULL ? (which->faces[f->slot] >> f->face & 1) != 0
                                : which->of < 0 || c->of_material[i] == which->of;
}

bool rg_contacts_force(const rg_contacts *c, size_t tile, const rg_contact_choice *which, double force[3],
                       double moment[3]) {
    bool touches = false;
    for (size_t i = c->tile_begin[tile]; i < c->tile_begin[tile + 1]; i++) {
        bool chosen = is_chosen(which, c, i);
        for (size_t k = c->face[i].touch; chosen && k < c->face[i + 1].touch; k++) {
            const rg_contact_touch *t = &c->touch[k];
            size_t other = (size_t)c->pair[t->pair].face[1 - t->side];
            if (!(c->energy[t->pair] > 0) || (which->by >= 0 && c->of_material[other] != which->by)) {
                continue;
            }
            touches = true;
            for (int corner = 0; corner < 3; corner++) {
                const double *f = c->force + 18 * t->pair + 9 * t->side + 3 * corner;
                double turn[3];
                rg_vector_cross(c->corner + RG_CONTACT_ROW * i + 3 * corner, f, turn);
                for (int a = 0; a < 3; a++) {
                    force[a] += f[a];
                    moment[a] += turn[a];
                }
            }
        }
    }
    return touches;
}

/* The first face of an element: they come by their elements. */
static size_t first_face(const rg_contacts *c, size_t slot) {
    size_t low = 0, high = c->faces;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if ((size_t)c->face[middle].slot < slot) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

void rg_contacts_traction(const rg_contacts *c, size_t slot, double *pressure, double traction[3]) {
    *pressure = 0;
    memset(traction, 0, 3 * sizeof *traction);
    for (size_t i = first_face(c, slot); i < c->faces && (size_t)c->face[i].slot == slot; i++) {
        double force[3][3], normal[3], sum[3], felt = 0;
        double area = 0.5 * rg_vector_normal(c->corner + RG_CONTACT_ROW * i, normal);
        face_forces(c, &c->face[i], force, &felt);
        for (int k = 0; k < 3; k++) {
            sum[k] = (force[0][k] + force[1][k] + force[2][k]) / area;
        }
        if (-rg_vector_dot(sum, normal) > *pressure) {
            *pressure = -rg_vector_dot(sum, normal);
            memcpy(traction, sum, sizeof sum);
        }
    }
}

/* ---- Once in a while ---- */

void rg_contacts_sink(const rg_contacts *c, const uint8_t *exposed, rg_real *sunk) {
    for (size_t i = 0; i < c->faces; i++) {
        size_t at = c->face[i].interface;
        if (at != RG_CONTACT_NO_INTERFACE &&
            exposed[at / (2 * RG_LANES) * RG_LANES + at % RG_LANES] == RG_NEWLY_EXPOSED) {
            sunk[at] = (rg_real)depth_of(c, &c->face[i]);
        }
    }
}

void rg_contacts_energy(const rg_contacts *c, size_t tile, rg_exact_sum *energy) {
    for (size_t i = c->face[c->tile_begin[tile]].touch; i < c->face[c->tile_begin[tile + 1]].touch; i++) {
        if (c->touch[i].side == 0) {
            rg_exact_add(energy, c->energy[c->touch[i].pair]);
        }
    }
}

double rg_contacts_moved(const rg_contacts *c) {
    double moved = largest(c->moved, c->faces), stepped = largest(c->stepped, c->faces);
    return moved + 2 * stepped;
}

int64_t rg_contacts_touching(const rg_contacts *c) {
    int64_t count = 0;
    for (size_t i = 0; i < c->domain->tiles; i++) {
        count += c->tile_touching[i];
    }
    return count;
}

bool rg_contacts_any(const rg_contacts *c) {
    return c->any;
}

double rg_contacts_omega2_now(const rg_contacts *c) {
    return largest(c->tile_omega2, c->domain->tiles);
}
