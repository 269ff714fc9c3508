#include "solver/statics.h"

#include <float.h>
#include <math.h>
#include <omp.h>
#include <string.h>

#include "base/hash.h"
#include "base/mem.h"
#include "domain/element.h"
#include "solver/step.h"
#include "solver/tile.h"

rg_statics rg_statics_make(rg_solver *s) {
    rg_statics q = {.solver = s, .length = s->domain->blocks * RG_NODE_BLOCK, .stretch = 1};
    q.force = rg_statics_field(&q);
    for (int i = 0; i < RG_NODES * RG_NODES; i++) {
        q.mass[i / RG_NODES][i % RG_NODES] = rg_mass_entry(s->input->mass, i / RG_NODES, i % RG_NODES);
    }
    q.sum = RG_NEW(rg_exact_sum, (size_t)s->threads);
    q.from = RG_NEW(rg_body_place, (size_t)s->bodies->count + 1);
    q.motion = rg_alloc((size_t)s->bodies->count + 1, sizeof *q.motion);
    q.cracks = s->model->law.form == RG_FORM_INTRINSIC ? s->domain->iblocks * s->model->crack_stride : 0;
    q.crack = RG_NEW(rg_real, q.cracks + 1);
    for (size_t i = 0; q.cracks > 0 && i < s->domain->iblocks * RG_LANES; i++) {
        for (int k = 0; rg_face_is_open(s, i) && k < RG_CRACK * RG_POINTS; k++) {
            size_t at = i / RG_LANES * s->model->crack_stride + (size_t)k * RG_LANES + i % RG_LANES;
            q.crack[at] = s->crack[at];
        }
    }
    return q;
}

rg_real *rg_statics_field(const rg_statics *q) {
    return RG_NEW(rg_real, q->length + 1);
}

void rg_statics_free(rg_statics *q) {
    rg_free(q->force);
    rg_free(q->sum);
    rg_free(q->crack);
    rg_free(q->from);
    rg_free(q->motion);
}

void rg_statics_copy(const rg_statics *q, const rg_real *from, rg_real *to) {
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < q->length; i++) {
        to[i] = from[i];
    }
}

void rg_statics_add(const rg_statics *q, double scale, const rg_real *from, double factor, rg_real *to) {
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < q->length; i++) {
        to[i] = (rg_real)(factor * to[i] + scale * from[i]);
    }
}

void rg_statics_hold(const rg_statics *q, const double (*impulse)[6], rg_real *field) {
#pragma omp parallel for schedule(static)
    for (size_t t = 0; t < q->solver->domain->tiles; t++) {
        rg_constraints_hold(q->solver->constraints, t, field);
    }
    rg_ties_motions(q->solver->ties, field, impulse, q->motion);
    rg_ties_hold(q->solver->ties, (const double(*)[6])q->motion, field);
}

void rg_statics_depart(const rg_statics *q, rg_real *start) {
    rg_statics_copy(q, q->solver->u, start);
    rg_bodies_places(q->solver->bodies, q->from);
}

void rg_statics_move(const rg_statics *q, const rg_real *start, double share, const rg_real *change) {
    rg_solver *s = q->solver;
    rg_statics_copy(q, start, s->u);
    rg_statics_add(q, share, change, 1, s->u);
    if (rg_ties_any(s->ties)) {
        rg_ties_motions(s->ties, change, NULL, q->motion);
        rg_bodies_shift(s->bodies, q->from, (const double(*)[6])q->motion, share);
        rg_ties_start(s->ties, s->u, NULL);
    }
}

void rg_statics_return(const rg_statics *q) {
    rg_bodies_shift(q->solver->bodies, q->from, (const double(*)[6])q->motion, 0);
}

void rg_statics_times_mass(const rg_statics *q, const rg_real *field, rg_real *out) {
    const rg_domain *d = q->solver->domain;
#pragma omp parallel for schedule(static)
    for (size_t block = 0; block < d->blocks; block++) {
        double mass[RG_LANES];
        for (int l = 0; l < RG_LANES; l++) {
            size_t slot = block * RG_LANES + (size_t)l;
            mass[l] = d->id[slot] >= 0 ? rg_element_mass(d, q->solver->model->material, slot) : 0;
        }
        for (int a = 0; a < RG_NODES; a++) {
            for (int c = 0; c < 3; c++) {
                double sum[RG_LANES] = {0};
                for (int b = 0; b < RG_NODES; b++) {
                    const rg_real *v = field + rg_node_index(block * RG_LANES, b, c);
                    for (int l = 0; l < RG_LANES; l++) {
                        sum[l] += q->mass[a][b] * v[l];
                    }
                }
                rg_real *to = out + rg_node_index(block * RG_LANES, a, c);
                for (int l = 0; l < RG_LANES; l++) {
                    to[l] = (rg_real)(mass[l] * sum[l]);
                }
            }
        }
    }
}

double rg_statics_dot(const rg_statics *q, const rg_real *a, const rg_real *b) {
    const rg_domain *d = q->solver->domain;
    memset(q->sum, 0, (size_t)q->solver->threads * sizeof *q->sum);
#pragma omp parallel for schedule(static)
    for (size_t block = 0; block < d->blocks; block++) {
        double sum[RG_LANES] = {0};
        for (size_t i = block * RG_NODE_BLOCK; i < (block + 1) * RG_NODE_BLOCK; i++) {
            sum[i % RG_LANES] += (double)a[i] * b[i];
        }
        for (size_t l = 0; l < RG_LANES; l++) {
            if (d->id[block * RG_LANES + l] >= 0) {
                rg_exact_add(&q->sum[omp_get_thread_num()], sum[l]);
            }
        }
    }
    for (int t = 1; t < q->solver->threads; t++) {
        rg_exact_merge(&q->sum[0], &q->sum[t]);
    }
    rg_exact_allreduce(&q->sum[0], 1, q->solver->comm);
    return rg_exact_value(&q->sum[0]);
}

double rg_statics_largest(const rg_statics *q, const rg_real *field) {
    double most = 0;
#pragma omp parallel for schedule(static) reduction(max : most)
    for (size_t i = 0; i < q->length; i++) {
        double size = fabs((double)field[i]);
        most = size > most ? size : most;
    }
    MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_DOUBLE, MPI_MAX, q->solver->comm);
    return most;
}

double rg_statics_norm(const rg_statics *q, const rg_real *field) {
    rg_statics_times_mass(q, field, q->force);
    return sqrt(rg_statics_dot(q, field, q->force));
}

/* Half of the last digit of a displacement, up or down by what its element, node and component say. */
static rg_real half_digit(rg_real u, rg_gid element, size_t n) {
    uint64_t h = rg_hash(rg_hash(0, (uint64_t)element), n);
    double half = (sizeof(rg_real) < sizeof(double) ? FLT_EPSILON : DBL_EPSILON) / 2;
    return (rg_real)(u * ((h & 1) != 0 ? half : -half));
}

double rg_statics_rounding(rg_statics *q, rg_real *room, rg_real *change) {
    const rg_domain *d = q->solver->domain;
    rg_real *u = q->solver->u;
    rg_statics_accelerate(q, change, false);
    rg_statics_copy(q, u, room);
    for (size_t i = 0; i < q->length; i++) {
        size_t slot = i / RG_NODE_BLOCK * RG_LANES + i % RG_LANES, n = i % RG_NODE_BLOCK / RG_LANES;
        u[i] += d->id[slot] >= 0 ? 2 * half_digit(u[i], d->id[slot], n) : 0;
    }
    rg_real *moved = RG_NEW(rg_real, q->length + 1);
    rg_statics_accelerate(q, moved, false);
    rg_statics_add(q, -1, moved, 1, change);
    rg_statics_hold(q, NULL, change);
    rg_statics_copy(q, room, u);
    rg_free(moved);
    return 0.5 * rg_statics_norm(q, change);
}

void rg_statics_accelerate(rg_statics *q, rg_real *out, bool loaded) {
    rg_statics_forget(q);
    rg_solver_acceleration(q->solver, out, loaded, q->stretch);
    q->passes++;
}

void rg_statics_forget(const rg_statics *q) {
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < q->cracks; i++) {
        q->solver->crack[i] = q->crack[i];
    }
}
