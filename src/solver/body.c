#include "solver/body.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "base/mem.h"
#include "base/first_bad.h"
#include "base/vector.h"
#include "contact/contact.h"
#include "partition/material.h"
#include "solver/initial.h"
#include "domain/element.h"
#include "quadrature.h"

/* Of the height of an element: a body this deep in the solid at the start only touches it. */
#define TOUCH 1e-6

enum { POWER_ITERATIONS = 200 };

/* ---- The bodies ---- */

static void unit(const double v[3], double out[3]) {
    double norm = sqrt(rg_vector_dot(v, v));
    for (int c = 0; c < 3 && norm > 0; c++) {
        out[c] = v[c] / norm;
    }
}

bool rg_bodies_told(const rg_bodies *b, char *words, size_t size) {
    const rg_body_lapse *l = &b->lapse;
    if (l->input != NULL) {
        snprintf(words, size, "bodies: %s.%c of %s: %s is not finite at t = %g s", l->what,
                 "xyz"[l->component], l -> input -> name, rg_expr_text(l->value), l -> time);
    }
    return l->input != NULL;
}

static void make_body(rg_bodies *all, int i, const rg_body_input *in) {
    rg_body *b = &all->body[i];
    b->input = in;
    b->mass = in->motion == RG_MOTION_PRESCRIBED ? INFINITY : rg_body_mass(in);
    b->turns = rg_body_turns(in);
    unit(in->shape == RG_SHAPE_PLANE ? in->normal : in->axis, b->turn.direction);
    b->turn.rotation[0] = b->turn.step[0] = b->turn.seen_rotation[0] = 1;
    if (b->turns && in->motion == RG_MOTION_FREE) {
        double tensor[6];
        rg_body_inertia(in, tensor);
        b->inertia = rg_inertia_make(tensor);
    }
    memcpy(b->x, in->at, sizeof b->x);
    rg_bodies_begin(all, i);
}

static void refuse_lapse(const rg_bodies *b, const rg_case *c) {
    char words[400];
    if (rg_bodies_told(b, words, sizeof words)) { /* on all ranks */
        rg_speak(b->comm);
        rg_fatal(RG_USAGE, "%s: %s", c->path, words);
    }
}

/* ---- Faces that may touch them ---- */

/* Which groups of faces may touch body i: [groups]; NULL where no set is named, so that all may. */
static bool *touching_groups(const rg_case *c, const rg_part *part, int i, MPI_Comm comm) {
    int32_t groups = rg_sets_groups(&part->surface);
    bool *touching = c->body[i].sets == 0 ? NULL : RG_NEW(bool, (size_t)groups + 1);
    for (int k = 0; k < c->body[i].sets; k++) {
        int set = rg_sets_find(&part->surface, c->body[i].set[k]);
        if (set < 0) {
            rg_speak(comm);
            rg_fatal(RG_USAGE, "%s: bodies[%d].faces[%d]: the mesh has no set named '%s'", c->path, i, k,
                     c->body[i].set[k]);
        }
        for (int32_t g = 0; g < groups; g++) {
            touching[g] = touching[g] || rg_sets_hold(&part->surface, g, set);
        }
    }
    return touching;
}

/* 2 * interface + side of a face that has been exposed; -1 of others. */
static int64_t born_as(const rg_domain *d, const rg_tile *t, const uint8_t *exposed, size_t slot, int face) {
    int32_t link = d->interface[rg_link_index(slot, face)];
    if (exposed == NULL || d->id[slot] < 0 || link < 0) {
        return -1;
    }
    size_t i = t->ibegin * RG_LANES + (size_t)link / 4;
    return exposed[i] >= RG_EXPOSED ? (int64_t)(2 * i) + link % 2 : -1;
}

static rg_contact_face face_of(const rg_bodies *b, size_t slot, int face, int body, int64_t born) {
    const rg_domain *d = b->surface.domain;
    double normal[3], area = rg_surface_area(d->corner + 12 * slot, face, normal);
    double modulus = rg_material_modulus(&b->surface.material[d->material[slot / RG_LANES]]);
    double kappa = b->body[body].input->penalty * modulus / rg_surface_height(d, slot, face);
    return (rg_contact_face){.slot = (rg_lid)slot,
                             .face = (int8_t)face,
                             .body = (int16_t)body,
                             .born = born,
                             .stiffness = kappa * area};
}

/* Visits the faces of a tile that may touch a body, in an order that follows from the mesh: counts them and,
 * with room for them, lists them. */
static size_t list_faces(const rg_bodies *b, const uint8_t *exposed, size_t tile, rg_contact_face *out) {
    const rg_domain *d = b->surface.domain;
    size_t count = 0;
    for (size_t slot = d->tile[tile].begin * RG_LANES; slot < d->tile[tile].end * RG_LANES; slot++) {
        for (int k = 0; k < RG_FACES * b->count; k++) {
            int face = k / b->count, body = k % b->count, group = d->set[4 * slot + (size_t)face];
            const bool *touching = b->touching[body];
            bool surface = rg_surface_has(d, slot, face);
            int64_t born = surface ? -1 : born_as(d, &d->tile[tile], exposed, slot, face);
            bool may =
                surface ? touching == NULL || (group >= 0 && touching[group]) : born >= 0 && touching == NULL;
            if (!may || b->body[body].input->shape == RG_SHAPE_NONE) {
                continue;
            }
            if (out != NULL) {
                out[count] = face_of(b, slot, face, body, born);
            }
            count++;
        }
    }
    return count;
}

void rg_bodies_expose(rg_bodies *b, const uint8_t *exposed) {
    size_t tiles = b->surface.domain->tiles;
    if (b->count == 0) {
        return;
    }
    rg_free(b->face);
    for (size_t t = 0; t < tiles; t++) {
        b->tile_begin[t + 1] = b->tile_begin[t] + list_faces(b, exposed, t, NULL);
    }
    b->face = RG_NEW(rg_contact_face, b->tile_begin[tiles] + 1);
    for (size_t t = 0; t < tiles; t++) {
        list_faces(b, exposed, t, b->face + b->tile_begin[t]);
    }
}

/* ---- Time step ---- */

/* Largest eigenvalue of M^-1 K for an element of unit mass with unit stiffness on one face, by iteration; it
 * is the same for all four faces (5 with the consistent mass: Warburton & Hesthaven 2003). */
static double face_eigenvalue(const rg_bodies *b) {
    const int *node = rg_face_node[0];
    double x[RG_FNODES] = {1, 0.9, 0.8, 0.7, 0.6, 0.5}, y[RG_FNODES], largest = 0;
    for (int i = 0; i < POWER_ITERATIONS; i++) {
        for (int a = 0; a < RG_FNODES; a++) {
            y[a] = 0;
            for (int k = 0; k < RG_FNODES; k++) {
                y[a] += b->surface.inverse_mass[node[a]][node[k]] * x[k];
            }
        }
        memset(x, 0, sizeof x);
        for (int q = 0; q < RG_POINTS; q++) {
            double at = 0;
            for (int a = 0; a < RG_FNODES; a++) {
                at += b->surface.shape[q][a] * y[a];
            }
            for (int a = 0; a < RG_FNODES; a++) {
                x[a] += b->surface.weight[q] * b->surface.shape[q][a] * at;
            }
        }
        largest = 0;
        for (int a = 0; a < RG_FNODES; a++) {
            largest = fmax(largest, fabs(x[a]));
        }
        for (int a = 0; a < RG_FNODES; a++) {
            x[a] /= largest;
        }
    }
    return largest;
}

/* Largest squared frequency of an element whose faces are all pressed, held by nothing else. */
static double element_omega2(const rg_bodies *b) {
    double largest = 0, sum = 0;
    size_t faces = b->tile_begin[b->surface.domain->tiles];
    for (size_t i = 0; i < faces; i++) {
        const rg_contact_face *f = &b->face[i];
        bool same = i > 0 && f->slot == f[-1].slot;
        double mass = rg_element_mass(b->surface.domain, b->surface.material, (size_t)f->slot);
        sum = (same ? sum : 0) + b->eigenvalue * f->stiffness / mass;
        largest = fmax(largest, sum);
    }
    return largest;
}

double rg_body_lever2(const rg_bodies *b, const rg_contact_face *f) {
    const rg_body *body = &b->body[f->body];
    double x[RG_FNODES][3], arm[3], most = 0;
    rg_surface_place(&b->surface, (size_t)f->slot, f->face, NULL, x);
    for (int a = 0; body->turns && a < RG_FNODES; a++) {
        rg_vector_subtract(x[a], body->x, arm);
        double along = rg_vector_dot(arm, body->turn.direction),
               across2 = rg_vector_dot(arm, arm) - along * along;
        double square = body->input->shape == RG_SHAPE_PLANE      ? across2
                        : body->input->shape == RG_SHAPE_CYLINDER ? along * along
                                                                  : 0;
        most = fmax(most, square);
    }
    return most;
}

/* Squared frequency of a body on all the faces that may press it at once: those named and, on a sphere, no
 * more than half of its surface. What turns has the inverse mass 1/m + lever^2/I besides, at most. */
static double body_omega2(const rg_bodies *b, int body) {
    rg_exact_sum sum[2] = {0};
    double kappa = 0, radius = b->body[body].input->radius;
    bool turns = b->body[body].turns && isfinite(b->body[body].mass);
    for (size_t i = 0; i < b->tile_begin[b->surface.domain->tiles]; i++) {
        const rg_contact_face *f = &b->face[i];
        if (f->body == body) {
            rg_exact_add(&sum[0], f->stiffness);
            rg_exact_add(&sum[1], turns ? f->stiffness * rg_body_lever2(b, f) : 0);
            double normal[3],
                area = rg_surface_area(b->surface.domain->corner + 12 * (size_t)f->slot, f->face, normal);
            kappa = fmax(kappa, f->stiffness / area);
        }
    }
    rg_exact_allreduce(sum, 2, b->comm);
    MPI_Allreduce(MPI_IN_PLACE, &kappa, 1, MPI_DOUBLE, MPI_MAX, b->comm);
    double stiffness = rg_exact_value(&sum[0]);
    if (b->body[body].input->shape == RG_SHAPE_SPHERE) {
        stiffness = fmin(stiffness, 2 * acos(-1.0) * radius * radius * kappa);
    }
    double turn = turns ? rg_exact_value(&sum[1]) / b->body[body].inertia.moment[0] : 0;
    return stiffness / b->body[body].mass + turn;
}

/* The largest eigenvalue of a sum is at most the sum of the largest ones: the solid's (solver/spectrum.h),
 * the contact's on its elements and on the bodies. */
static double contact_omega2(const rg_bodies *b) {
    double here = element_omega2(b), elements, largest = 0;
    MPI_Allreduce(&here, &elements, 1, MPI_DOUBLE, MPI_MAX, b->comm);
    for (int i = 0; i < b->count; i++) {
        largest = fmax(largest, body_omega2(b, i));
    }
    return elements + largest;
}

/* ---- Overlap at the start ---- */

typedef struct {
    double depth;
    int rank; /* as MPI_DOUBLE_INT wants them */
} overlap;

static void start_position(const rg_case *c, const rg_domain *d, const rg_sets *volume,
                           const rg_contact_face *f, int a, double x[3]) {
    double reference[3];
    int set;
    const rg_initial *is = rg_initial_of(c, d, volume, (size_t)f->slot, &set);
    rg_node_position(d->corner + 12 * (size_t)f->slot, rg_face_node[f->face][a], reference);
    for (int k = 0; k < 3; k++) {
        const rg_expr *e = is->displacement[k];
        x[k] = reference[k] + (e == NULL ? 0 : rg_expr_value(e, reference, 0));
    }
}

static void refuse_overlap(const rg_bodies *b, const rg_case *c, const rg_sets *volume) {
    double worst[3] = {0, 0, 0};
    const rg_contact_face *in = NULL;
    overlap here = {0}, all;
    MPI_Comm_rank(b->comm, &here.rank);
    for (size_t i = 0; i < b->tile_begin[b->surface.domain->tiles]; i++) {
        const rg_contact_face *f = &b->face[i];
        for (int a = 0; a < RG_FNODES; a++) {
            double x[3], normal[3];
            start_position(c, b->surface.domain, volume, f, a, x);
            double depth = rg_body_depth(&b->body[f->body], x, normal);
            if (depth >
                fmax(here.depth, TOUCH * rg_surface_height(b->surface.domain, (size_t)f->slot, f->face))) {
                here.depth = depth;
                in = f;
                memcpy(worst, x, sizeof worst);
            }
        }
    }
    MPI_Allreduce(&here, &all, 1, MPI_DOUBLE_INT, MPI_MAXLOC, b->comm);
    if (all.depth > 0 && all.rank != here.rank) {
        MPI_Barrier(b->comm); /* one rank speaks and ends the job */
    }
    if (all.depth > 0 && in != NULL) {
        rg_fatal(
            RG_USAGE,
            "%s: bodies[%d].at: [%g, %g, %g]: %s overlaps the solid at the start, by %.3g m at (%g, %g, %g)",
            c->path, in->body, c->body[in->body].at[0], c->body[in->body].at[1], c->body[in->body].at[2],
            c->body[in->body].name, all.depth, worst[0], worst[1], worst[2]);
    }
}

rg_bodies *rg_bodies_make(const rg_case *c, const rg_domain *d, const rg_part *part, const rg_material *m,
                          int threads, MPI_Comm comm) {
    rg_bodies *b = RG_NEW(rg_bodies, 1);
    *b = (rg_bodies){.count = c->bodies,
                     .threads = threads,
                     .comm = comm,
                     .surface = rg_surface_make(d, m, c->mass),
                     .request = MPI_REQUEST_NULL};
    b->tile_begin = RG_NEW(size_t, d->tiles + 1);
    if (c->bodies == 0) {
        return b;
    }
    b->body = RG_NEW(rg_body, (size_t)b->count);
    for (int i = 0; i < b->count; i++) {
        make_body(b, i, &c->body[i]);
    }
    refuse_lapse(b, c);
    b->sum = RG_NEW(rg_exact_sum, (size_t)(RG_BODY_SUMS * b->count * threads));
    b->total = RG_NEW(rg_exact_sum, (size_t)(RG_BODY_SUMS * b->count));
    b->noted = rg_alloc((size_t)b->count, sizeof *b->noted);
    b->tile_omega2 = RG_NEW(double, d->tiles + 1);
    b->touching = RG_NEW(bool *, (size_t)b->count);
    for (int i = 0; i < b->count; i++) {
        b->touching[i] = touching_groups(c, part, i, comm);
    }
    rg_bodies_expose(b, NULL);
    refuse_overlap(b, c, &part->volume);
    b->eigenvalue = face_eigenvalue(b);
    b->omega2 = contact_omega2(b);
    return b;
}

void rg_bodies_free(rg_bodies *b) {
    if (b == NULL) {
        return;
    }
    for (int i = 0; i < b->count; i++) {
        rg_free(b->touching[i]);
    }
    void *blocks[] = {b->body,  b->tile_begin, b->face, b->touching, b->tile_omega2, b->sum,
                      b->total, b->noted,      b};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
        rg_free(blocks[i]);
    }
}
