/* Contact of a tile's outer faces with rigid bodies. */
#include <math.h>
#include <omp.h>

#include "base/vector.h"
#include "domain/element.h"
#include "solver/body.h"

double rg_body_depth(const rg_body *b, const double x[3], double normal[3]) {
    double r[3] = {x[0] - b->x[0], x[1] - b->x[1], x[2] - b->x[2]};
    double along = b->input->shape == RG_SHAPE_SPHERE ? 0 : rg_vector_dot(r, b->direction);
    if (b->input->shape == RG_SHAPE_PLANE) {
        for (int c = 0; c < 3; c++) {
            normal[c] = b->direction[c];
        }
        return -along;
    }
    for (int c = 0; c < 3; c++) {
        r[c] -= along * b->direction[c];
    }
    double distance = sqrt(rg_vector_dot(r, r));
    for (int c = 0; c < 3; c++) {
        normal[c] = distance > 0 ? r[c] / distance : 0;
    }
    return b->input->radius - distance;
}

/* Deformed positions of a face's nodes. */
static void place_nodes(const rg_bodies *b, const rg_contact_face *f, const rg_real *u,
                        double x[RG_FNODES][3]) {
    const int *node = rg_face_node[f->face];
    for (int a = 0; a < RG_FNODES; a++) {
        rg_node_position(b->domain->corner + 12 * (size_t)f->slot, node[a], x[a]);
        for (int c = 0; c < 3; c++) {
            x[a][c] += u[rg_node_index((size_t)f->slot, node[a], c)];
        }
    }
}

/* The force of contact at point q over the depth: returns the depth (0 outside). */
static double touch_point(const rg_bodies *b, const rg_contact_face *f, double x[RG_FNODES][3], int q,
                          double normal[3]) {
    double at[3] = {0, 0, 0};
    for (int a = 0; a < RG_FNODES; a++) {
        for (int c = 0; c < 3; c++) {
            at[c] += b->rule.shape[q][a] * x[a][c];
        }
    }
    return fmax(0, rg_body_depth(&b->body[f->body], at, normal));
}

/* Nodal forces on a face and their sum (N); false where it does not touch. */
static bool face_forces(const rg_bodies *b, const rg_contact_face *f, const rg_real *u,
                        double force[RG_FNODES][3], double sum[3]) {
    double x[RG_FNODES][3], normal[3];
    bool touches = false;
    place_nodes(b, f, u, x);
    for (int q = 0; q < RG_POINTS; q++) {
        double depth = touch_point(b, f, x, q, normal);
        if (depth == 0) {
            continue;
        }
        touches = true;
        for (int c = 0; c < 3; c++) {
            double pressed = f->stiffness * b->rule.weight[q] * depth * normal[c];
            sum[c] += pressed;
            for (int a = 0; a < RG_FNODES; a++) {
                force[a][c] += b->rule.shape[q][a] * pressed;
            }
        }
    }
    return touches;
}

/* The mass matrix couples the nodes of the element. */
static void kick_element(const rg_bodies *b, const rg_contact_face *f, double force[RG_FNODES][3],
                         const rg_contact_kick *kick) {
    size_t slot = (size_t)f->slot;
    double mass = rg_element_mass(b->domain, b->material, slot);
    for (int n = 0; n < RG_NODES; n++) {
        for (int c = 0; c < 3; c++) {
            double a = 0;
            for (int k = 0; k < RG_FNODES; k++) {
                a += b->inverse_mass[n][rg_face_node[f->face][k]] * force[k][c];
            }
            size_t at = rg_node_index(slot, n, c);
            kick->velocity[at] = (rg_real)(kick->velocity[at] + kick->dt * a / mass);
            if (kick->step_velocity != NULL) {
                kick->step_velocity[at] = (rg_real)(kick->step_velocity[at] + kick->dt_now * a / mass);
            }
        }
    }
}

void rg_bodies_touch(rg_bodies *b, size_t tile, const rg_real *u, const rg_contact_kick *kick) {
    rg_exact_sum *sum = b->sum + 3 * b->count * omp_get_thread_num();
    for (size_t i = b->tile_begin[tile]; i < b->tile_begin[tile + 1]; i++) {
        const rg_contact_face *f = &b->face[i];
        double force[RG_FNODES][3] = {{0}}, all[3] = {0, 0, 0};
        if (face_forces(b, f, u, force, all)) {
            kick_element(b, f, force, kick);
            for (int c = 0; c < 3; c++) {
                rg_exact_add(&sum[3 * f->body + c], -all[c]);
            }
        }
    }
}

void rg_bodies_energy(const rg_bodies *b, size_t tile, const rg_real *u, rg_exact_sum *energy) {
    for (size_t i = b->tile_begin[tile]; i < b->tile_begin[tile + 1]; i++) {
        double x[RG_FNODES][3], normal[3];
        place_nodes(b, &b->face[i], u, x);
        for (int q = 0; q < RG_POINTS; q++) {
            double depth = touch_point(b, &b->face[i], x, q, normal);
            rg_exact_add(energy, 0.5 * b->face[i].stiffness * b->rule.weight[q] * depth * depth);
        }
    }
}
