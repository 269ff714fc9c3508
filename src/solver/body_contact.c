/* Contact of a tile's outer faces with rigid bodies. */
#include <math.h>
#include <omp.h>

#include "base/vector.h"
#include "domain/element.h"
#include "solver/body.h"

double rg_body_depth(const rg_body *b, const double x[3], double normal[3]) {
    double r[3] = {x[0] - b->x[0], x[1] - b->x[1], x[2] - b->x[2]};
    double along = b->input->shape == RG_SHAPE_SPHERE ? 0 : rg_vector_dot(r, b->turn.direction);
    if (b->input->shape == RG_SHAPE_PLANE) {
        for (int c = 0; c < 3; c++) {
            normal[c] = b->turn.direction[c];
        }
        return -along;
    }
    for (int c = 0; c < 3; c++) {
        r[c] -= along * b->turn.direction[c];
    }
    double distance = sqrt(rg_vector_dot(r, r));
    for (int c = 0; c < 3; c++) {
        normal[c] = distance > 0 ? r[c] / distance : 0;
    }
    return b->input->radius - distance;
}

/* The force of contact at point q over the depth: returns the depth (0 outside). */
static double touch_point(const rg_bodies *b, const rg_contact_face *f, double x[RG_FNODES][3], int q,
                          double at[3], double normal[3]) {
    rg_surface_at(&b->surface, q, x, at);
    return fmax(0, rg_body_depth(&b->body[f->body], at, normal));
}

/* Nodal forces on a face, their sum and its moment about the body's centre (N, N m); false where it does not
 * touch. */
static bool face_forces(const rg_bodies *b, const rg_contact_face *f, const rg_real *u,
                        double force[RG_FNODES][3], double sum[RG_BODY_SUMS]) {
    double x[RG_FNODES][3], normal[3], at[3], arm[3], moment[3], point[3];
    bool touches = false;
    rg_surface_place(&b->surface, (size_t)f->slot, f->face, u, x);
    for (int q = 0; q < RG_POINTS; q++) {
        double depth = touch_point(b, f, x, q, at, normal);
        if (depth == 0) {
            continue;
        }
        touches = true;
        for (int c = 0; c < 3; c++) {
            double pressed = f->stiffness * b->surface.weight[q] * depth * normal[c];
            sum[c] += point[c] = pressed;
            for (int a = 0; a < RG_FNODES; a++) {
                force[a][c] += b->surface.shape[q][a] * pressed;
            }
        }
        rg_vector_subtract(at, b->body[f->body].x, arm);
        rg_vector_cross(arm, point, moment);
        for (int c = 0; c < 3; c++) {
            sum[3 + c] += moment[c];
        }
    }
    return touches;
}

/* Whether a face is outside all bodies that it may touch; entries of a face lie side by side, this is the
 * first of them. */
static bool is_outside(const rg_bodies *b, const rg_contact_face *first, const rg_contact_face *end,
                       const rg_real *u) {
    double x[RG_FNODES][3], normal[3], at[3];
    rg_surface_place(&b->surface, (size_t)first->slot, first->face, u, x);
    for (const rg_contact_face *f = first; f < end && f->born == first->born; f++) {
        for (int q = 0; q < RG_POINTS; q++) {
            if (touch_point(b, f, x, q, at, normal) > 0) {
                return false;
            }
        }
    }
    return true;
}

/* Whether a face acts: those exposed in the run do once they are clear of the bodies. */
static bool acts(const rg_contact_face *f, const uint8_t *clear) {
    return f->born < 0 || (clear[f->born / 2] >> f->born % 2 & 1) != 0;
}

/* What an exposed face that is pressed adds to the squared frequency of its body. */
static double body_omega2(const rg_bodies *b, const rg_contact_face *f) {
    const rg_body *body = &b->body[f->body];
    bool turns = body->turns && isfinite(body->mass);
    return f->stiffness * (1 / body->mass + (turns ? rg_body_lever2(b, f) / body->inertia.moment[0] : 0));
}

void rg_bodies_touch(rg_bodies *b, size_t tile, const rg_real *u, const rg_push *push, uint8_t *clear) {
    if (b->count == 0) {
        return;
    }
    rg_exact_sum *sum = b->sum + RG_BODY_SUMS * b->count * omp_get_thread_num();
    const rg_contact_face *begin = b->face + b->tile_begin[tile], *end = b->face + b->tile_begin[tile + 1];
    double most = 0, element = 0;
    for (const rg_contact_face *f = begin; f < end; f++) {
        double force[RG_FNODES][3] = {{0}}, all[RG_BODY_SUMS] = {0};
        bool first = f == begin || f[-1].born != f->born, other = f == begin || f[-1].slot != f->slot;
        element = other ? 0 : element;
        if (f->born >= 0 && first && !acts(f, clear) && is_outside(b, f, end, u)) {
            clear[f->born / 2] |= (uint8_t)(1 << f->born % 2);
        }
        if (acts(f, clear) && face_forces(b, f, u, force, all)) {
            rg_surface_push(&b->surface, (size_t)f->slot, f->face, force, push);
            if (f->born >= 0) {
                double mass = rg_element_mass(b->surface.domain, b->surface.material, (size_t)f->slot);
                element += b->eigenvalue * f->stiffness / mass;
                all[RG_BODY_BORN] = -body_omega2(b, f);
            }
            for (int c = 0; c < RG_BODY_SUMS; c++) {
                rg_exact_add(&sum[RG_BODY_SUMS * f->body + c], -all[c]);
            }
        }
        most = fmax(most, element);
    }
    b->tile_omega2[tile] = most;
}

double rg_bodies_omega2_now(const rg_bodies *b) {
    double most = 0;
    for (size_t t = 0; b->count > 0 && t < b->surface.domain->tiles; t++) {
        most = fmax(most, b->tile_omega2[t]);
    }
    return most;
}

void rg_bodies_energy(const rg_bodies *b, size_t tile, const rg_real *u, const uint8_t *clear,
                      rg_exact_sum *energy) {
    for (size_t i = b->tile_begin[tile]; i < b->tile_begin[tile + 1]; i++) {
        double x[RG_FNODES][3], at[3], normal[3];
        rg_surface_place(&b->surface, (size_t)b->face[i].slot, b->face[i].face, u, x);
        for (int q = 0; q < RG_POINTS && acts(&b->face[i], clear); q++) {
            double depth = touch_point(b, &b->face[i], x, q, at, normal);
            rg_exact_add(energy, 0.5 * b->face[i].stiffness * b->surface.weight[q] * depth * depth);
        }
    }
}
