/* Stress that an element has before it deforms: S0 of the places of reference turns and stretches with it, as
 * a second Piola-Kirchhoff stress, P0 = F S0. It has a potential, the density S0:E + S0:C^-1:S0/2,   E = (F^T
 * F - 1)/2, of which the second part is what is stored before anything moves, by the moduli at F = 1. After
 * the bulk, to what it has computed: forces, tractions and stiffening, or energy and stress. */
#include "element/tet10_gradient.h"
#include "isa.h"

/* S0 at a point, from (xx yy zz yz xz xy). */
RG_INLINE void load_stress(const rg_real *at, int g, rg_vec S[3][3]) {
    static const int first[6] = {0, 1, 2, 1, 0, 0}, second[6] = {0, 1, 2, 2, 2, 1};
    for (int k = 0; k < 6; k++) {
        S[first[k]][second[k]] = S[second[k]][first[k]] = rg_load(at + (g * 6 + k) * RG_LANES);
    }
}

/* F = 1 + H, and P0 = F S0. */
RG_INLINE void piola(rg_vec H[3][3], rg_vec S[3][3], rg_vec P[3][3]) {
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            P[i][j] = S[i][j] + rg_dot(H[i], S[j]);
        }
    }
}

/* Of the acoustic tensor, over that of the material at F = 1: at most the largest row sum. */
RG_INLINE rg_vec stiffness_of(const rg_material *m, rg_vec S[3][3]) {
    rg_vec most = {0};
    for (int i = 0; i < 3; i++) {
        most = rg_max(most, rg_abs(S[i][0]) + rg_abs(S[i][1]) + rg_abs(S[i][2]));
    }
    return most / rg_splat(m->lambda + 2.0 * m->mu);
}

RG_INLINE void prestress_vector(const rg_prestress_args *p, size_t block, int lane, rg_gradient gradient) {
    element e;
    load_element(&e, p->bulk, block, lane, gradient);
    vec3 common[4], q[4][RG_GAUSS], Q[4] = {{{0}}};
    common_derivatives(&e, gradient, common);
    const rg_real *stress = p->stress + block * RG_PRESTRESS_BLOCK + lane;
    rg_vec stiffest = {0};
    for (int g = 0; g < RG_GAUSS; g++) {
        rg_vec H[3][3], S[3][3], P[3][3];
        displacement_gradient(&e, gradient, common, g, H);
        load_stress(stress, g, S);
        piola(H, S, P);
        stiffest = rg_max(stiffest, stiffness_of(&p->bulk->material, S));
        project_stress(&e, 0.25 * e.volume, P, g, q, Q);
    }
    store_force(q, Q, p->bulk->force + block * RG_NODE_BLOCK + lane, true);
    rg_real rows[RG_VLEN * RG_TRACTION_ROW];
    rg_real *traction = p->bulk->traction + (block * RG_LANES + (size_t)lane) * RG_TRACTION_ROW;
    store_traction(q, Q, rows);
    for (int k = 0; k < RG_VLEN * RG_TRACTION_ROW; k++) {
        traction[k] += rows[k];
    }
    rg_real *stiffening = p->bulk->stiffening + block * RG_LANES + lane;
    rg_store(stiffening, rg_load(stiffening) + stiffest);
}

void RG_ISA_NAME(rg_prestress)(const rg_prestress_args *args, size_t begin, size_t end) {
    for (size_t b = begin; b < end; b++) {
        for (int lane = 0; lane < RG_LANES; lane += RG_VLEN) {
            if (args->bulk->gradient == RG_GRADIENT_LIFTED) {
                prestress_vector(args, b, lane, RG_GRADIENT_LIFTED);
            } else {
                prestress_vector(args, b, lane, RG_GRADIENT_OWN);
            }
        }
    }
}

RG_INLINE void add_wide(double *to, rg_vec x) {
    double wide[RG_VLEN];
    rg_store_wide(wide, x);
    for (int l = 0; l < RG_VLEN; l++) {
        to[l] += wide[l];
    }
}

/* S0:E, with E = sym H + H^T H/2, and what is stored at F = 1. */
RG_INLINE rg_vec density(const rg_material *m, rg_vec H[3][3], rg_vec S[3][3]) {
    rg_vec work = {0}, square = {0}, trace = S[0][0] + S[1][1] + S[2][2];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            rg_vec stretch = H[0][i] * H[0][j] + H[1][i] * H[1][j] + H[2][i] * H[2][j];
            work += S[i][j] * (H[i][j] + 0.5 * stretch);
            square += S[i][j] * S[i][j];
        }
    }
    double across = m->lambda / (2.0 * m->mu * (3.0 * m->lambda + 2.0 * m->mu));
    return work + 0.5 * (rg_splat(0.5 / m->mu) * square - rg_splat(across) * (trace * trace));
}

/* Cauchy stress F S0 F^T/J. */
RG_INLINE void add_cauchy(double *out, rg_vec H[3][3], rg_vec P[3][3]) {
    static const int first[6] = {0, 1, 2, 1, 0, 0}, second[6] = {0, 1, 2, 2, 2, 1};
    rg_vec F[3][3], minor[3];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            F[i][j] = i == j ? H[i][j] + 1.0 : H[i][j];
        }
    }
    rg_cross(F[1], F[2], minor);
    rg_vec J = rg_dot(F[0], minor);
    for (int k = 0; k < 6; k++) {
        add_wide(out + k * RG_LANES, rg_dot(P[first[k]], F[second[k]]) / J);
    }
}

RG_INLINE void state_vector(const rg_prestress_state_args *p, size_t block, size_t row, int lane,
                            rg_gradient gradient) {
    const rg_bulk_state_args *state = p->state;
    element e;
    load_element(&e, state->bulk, block, lane, gradient);
    vec3 common[4];
    common_derivatives(&e, gradient, common);
    const rg_real *stress = p->stress + block * RG_PRESTRESS_BLOCK + lane;
    rg_vec energy = {0};
    for (int g = 0; g < RG_GAUSS; g++) {
        rg_vec H[3][3], S[3][3], P[3][3];
        displacement_gradient(&e, gradient, common, g, H);
        load_stress(stress, g, S);
        energy += 0.25 * e.volume * density(&state->bulk->material, H, S);
        if (state->cauchy != NULL) {
            piola(H, S, P);
            add_cauchy(state->cauchy + (row * RG_GAUSS + (size_t)g) * 6 * RG_LANES + lane, H, P);
        }
    }
    if (state->energy != NULL) {
        add_wide(state->energy + row * RG_LANES + lane, energy);
    }
}

void RG_ISA_NAME(rg_prestress_state)(const rg_prestress_state_args *args, size_t begin, size_t end) {
    for (size_t b = begin; b < end; b++) {
        for (int lane = 0; lane < RG_LANES; lane += RG_VLEN) {
            if (args->state->bulk->gradient == RG_GRADIENT_LIFTED) {
                state_vector(args, b, b - begin, lane, RG_GRADIENT_LIFTED);
            } else {
                state_vector(args, b, b - begin, lane, RG_GRADIENT_OWN);
            }
        }
    }
}
