/* Bulk viscosity, which spreads shocks over elements and damps their ringing: a pressure
 *     q = rho h ( b1 c (-div v) + b2^2 h max(0, -div v)^2 )
 * (J. von Neumann and R. D. Richtmyer 1950 for the quadratic, R. Landshoff 1955 for the linear part), h the
 * smallest height of the element, c the dilatational wave speed, rho the reference density. It acts within
 * each element on the gradient of its own velocity: no trace of a velocity travels, and what it takes out, q
 * (-div v) >= 0, is dissipated whatever the jumps do. */
#include "element/tet10_gradient.h"
#include "isa.h"

/* F = I + H. */
RG_INLINE void volume_change(rg_vec H[3][3], rg_vec cof[3][3], rg_vec *J) {
    rg_vec F[3][3];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            F[i][j] = i == j ? H[i][j] + 1.0 : H[i][j];
        }
    }
    for (int i = 0; i < 3; i++) {
        rg_cross(F[(i + 1) % 3], F[(i + 2) % 3], cof[i]);
    }
    *J = rg_dot(F[0], cof[0]);
}

/* The smallest height: 1 over the largest grad l_k. */
RG_INLINE rg_vec smallest_height(const element *e) {
    vec3 last;
    rg_vec most = {0};
    for (int c = 0; c < 3; c++) {
        last[c] = e->grad[0][c] + e->grad[1][c] + e->grad[2][c];
    }
    for (int k = 0; k < 4; k++) {
        const rg_vec *g = k < 3 ? e->grad[k] : last;
        most = rg_max(most, rg_dot(g, g));
    }
    return 1.0 / rg_sqrt(most);
}

/* The element's stiffening: a mode of frequency w that is damped by xi has the critical step
 * (2/w) (sqrt(1 + xi^2) - xi), where the velocity is that of the middle of the step before. */
RG_INLINE void limit_step(const rg_viscosity_args *v, rg_real *stiffening, rg_vec squeeze) {
    rg_vec xi = rg_splat(v->damping) + rg_splat(v->damping_rate) * squeeze;
    rg_vec factor = (rg_sqrt(xi * xi + 1.0) + xi) * rg_splat(v->allowed);
    rg_store(stiffening, rg_load(stiffening) * (factor * factor));
}

RG_INLINE void viscous_vector(const rg_viscosity_args *v, size_t block, int lane) {
    element e, rate;
    load_element(&e, v->bulk, block, lane, RG_GRADIENT_OWN);
    rate = e;
    rate.u = v->velocity + block * RG_NODE_BLOCK + lane;
    vec3 common[4], common_rate[4], q[4][RG_GAUSS], Q[4] = {{{0}}};
    common_derivatives(&e, RG_GRADIENT_OWN, common);
    common_derivatives(&rate, RG_GRADIENT_OWN, common_rate);
    rg_vec h = smallest_height(&e), weight = 0.25 * e.volume, heat = {0}, worst = {0};
    rg_vec scale = rg_splat(v->bulk->material.density) * h, quadratic = rg_splat(v->quadratic) * h;
    for (int g = 0; g < RG_GAUSS; g++) {
        rg_vec H[3][3], G[3][3], cof[3][3], P[3][3], J;
        displacement_gradient(&e, RG_GRADIENT_OWN, common, g, H);
        displacement_gradient(&rate, RG_GRADIENT_OWN, common_rate, g, G);
        volume_change(H, cof, &J);
        rg_vec shrinking = -(rg_dot(cof[0], G[0]) + rg_dot(cof[1], G[1]) + rg_dot(cof[2], G[2]));
        rg_vec closing = shrinking / J, squeeze = rg_max(closing, rg_splat(0.0));
        rg_vec pressure = scale * (rg_splat(v->linear) * closing + quadratic * (squeeze * squeeze));
        worst = rg_max(worst, squeeze);
        heat += pressure * shrinking;
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++) {
                P[i][j] = -pressure * cof[i][j];
            }
        }
        project_stress(&e, weight, P, g, q, Q);
    }
    double booked[RG_VLEN];
    rg_store_wide(booked, heat * weight * rg_splat(v->dt));
    for (int l = 0; l < RG_VLEN; l++) {
        v->heat[block * RG_LANES + (size_t)(lane + l)] += booked[l];
    }
    store_force(q, Q, v->bulk->force + block * RG_NODE_BLOCK + lane, true);
    limit_step(v, v->bulk->stiffening + block * RG_LANES + lane, worst * h);
}

void RG_ISA_NAME(rg_viscosity)(const rg_viscosity_args *args, size_t begin, size_t end) {
    for (size_t b = begin; b < end; b++) {
        for (int lane = 0; lane < RG_LANES; lane += RG_VLEN) {
            viscous_vector(args, b, lane);
        }
    }
}
