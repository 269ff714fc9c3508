/* Stress that an element has before it deforms: S0 of the places of reference turns and stretches with it, as
 * a second Piola-Kirchhoff stress, P0 = F S0. It has a potential, the density S0:E + S0:C^-1:S0/2,   E = (F^T
 * F - 1)/2, of which the second part is what is stored before anything moves, by the moduli at F = 1. In
 * metals, whatever their flow, it is a mean stress p alone, P0 = p F^-T, of the density p log J + p^2/2K
 * (stressed.h). After the bulk, to what it has computed: forces, tractions and stiffening, or energy and
 * stress. */
#include "element/tet10_gradient.h"
#include "isa.h"
#include "stressed.h"
#include "vec_math.h"

/* What of it is there: all of it, or a mean stress. */
typedef enum { WHOLE, PRESSURE } kind;

static kind kind_of(const rg_material *m) {
    return ((int)RG_STRESS_PRESSURE >> m->model & 1) != 0 ? PRESSURE : WHOLE;
}

/* S0 at a point, from (xx yy zz yz xz xy). */
RG_INLINE void load_stress(const rg_real *at, int g, rg_vec S[3][3]) {
    static const int first[6] = {0, 1, 2, 1, 0, 0}, second[6] = {0, 1, 2, 2, 2, 1};
    for (int k = 0; k < 6; k++) {
        S[first[k]][second[k]] = S[second[k]][first[k]] = rg_load(at + (g * 6 + k) * RG_LANES);
    }
}

/* Cofactors of F = 1 + H, and its determinant. */
RG_INLINE rg_vec cofactors(rg_vec H[3][3], rg_vec cof[3][3]) {
    rg_vec F[3][3];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            F[i][j] = i == j ? H[i][j] + 1.0 : H[i][j];
        }
    }
    for (int i = 0; i < 3; i++) {
        rg_cross(F[(i + 1) % 3], F[(i + 2) % 3], cof[i]);
    }
    return rg_dot(F[0], cof[0]);
}

/* F = 1 + H, and P0 = F S0, or p F^-T. */
RG_INLINE void piola(kind is, rg_vec H[3][3], rg_vec S[3][3], rg_vec P[3][3]) {
    if (is == PRESSURE) {
        rg_vec cof[3][3], part = S[0][0] / cofactors(H, cof);
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++) {
                P[i][j] = part * cof[i][j];
            }
        }
        return;
    }
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            P[i][j] = S[i][j] + rg_dot(H[i], S[j]);
        }
    }
}

/* Of the acoustic tensor, over that of the material at F = 1: at most the largest row sum; of a mean stress p
 * |p| times that of F^-1 F^-T. */
RG_INLINE rg_vec stiffness_of(kind is, double modulus, rg_vec H[3][3], rg_vec S[3][3]) {
    rg_vec most = {0}, cof[3][3], size = rg_splat(1.0), row[3][3];
    if (is == PRESSURE) {
        rg_vec J = cofactors(H, cof);
        size = rg_abs(S[0][0]) / (J * J);
    }
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            row[i][j] = is == PRESSURE ? cof[0][i] * cof[0][j] + cof[1][i] * cof[1][j] + cof[2][i] * cof[2][j]
                                       : S[i][j];
        }
        most = rg_max(most, rg_abs(row[i][0]) + rg_abs(row[i][1]) + rg_abs(row[i][2]));
    }
    return most * size / rg_splat(modulus);
}

RG_INLINE void prestress_vector(const rg_prestress_args *p, size_t block, int lane, rg_gradient gradient,
                                kind is, double modulus) {
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
        piola(is, H, S, P);
        stiffest = rg_max(stiffest, stiffness_of(is, modulus, H, S));
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

/* Each kind is compiled into loops of its own. */
RG_INLINE void prestress_blocks(const rg_prestress_args *args, size_t begin, size_t end, kind is) {
    double modulus = rg_material_least_modulus(&args->bulk->material);
    for (size_t b = begin; b < end; b++) {
        for (int lane = 0; lane < RG_LANES; lane += RG_VLEN) {
            if (args->bulk->gradient == RG_GRADIENT_LIFTED) {
                prestress_vector(args, b, lane, RG_GRADIENT_LIFTED, is, modulus);
            } else {
                prestress_vector(args, b, lane, RG_GRADIENT_OWN, is, modulus);
            }
        }
    }
}

void RG_ISA_NAME(rg_prestress)(const rg_prestress_args *args, size_t begin, size_t end) {
    if (kind_of(&args->bulk->material) == PRESSURE) {
        prestress_blocks(args, begin, end, PRESSURE);
    } else {
        prestress_blocks(args, begin, end, WHOLE);
    }
}

RG_INLINE void add_wide(double *to, rg_vec x) {
    double wide[RG_VLEN];
    rg_store_wide(wide, x);
    for (int l = 0; l < RG_VLEN; l++) {
        to[l] += wide[l];
    }
}

/* S0:E, with E = sym H + H^T H/2, or p log J; and what is stored at F = 1. */
RG_INLINE rg_vec density(kind is, double compliance[6][6], rg_vec H[3][3], rg_vec S[3][3]) {
    static const int first[6] = {0, 1, 2, 1, 0, 0}, second[6] = {0, 1, 2, 2, 2, 1};
    rg_vec work = {0}, stored = {0}, cof[3][3];
    for (int i = 0; i < (is == PRESSURE ? 3 : 6); i++) {
        for (int j = 0; j < (is == PRESSURE ? 3 : 6); j++) {
            rg_vec one = is == PRESSURE ? S[0][0] : S[first[i]][second[i]];
            rg_vec other = is == PRESSURE ? S[0][0] : S[first[j]][second[j]];
            stored += rg_splat(compliance[i][j]) * one * other;
        }
    }
    if (is == PRESSURE) {
        return S[0][0] * rg_log(cofactors(H, cof)) + 0.5 * stored;
    }
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            rg_vec stretch = H[0][i] * H[0][j] + H[1][i] * H[1][j] + H[2][i] * H[2][j];
            work += S[i][j] * (H[i][j] + 0.5 * stretch);
        }
    }
    return work + 0.5 * stored;
}

/* Cauchy stress F S0 F^T/J. */
RG_INLINE void add_cauchy(double *out, rg_vec H[3][3], rg_vec P[3][3]) {
    static const int first[6] = {0, 1, 2, 1, 0, 0}, second[6] = {0, 1, 2, 2, 2, 1};
    rg_vec F[3][3], cof[3][3], J = cofactors(H, cof);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            F[i][j] = i == j ? H[i][j] + 1.0 : H[i][j];
        }
    }
    for (int k = 0; k < 6; k++) {
        add_wide(out + k * RG_LANES, rg_dot(P[first[k]], F[second[k]]) / J);
    }
}

RG_INLINE void state_vector(const rg_prestress_state_args *p, size_t block, size_t row, int lane,
                            rg_gradient gradient, kind is, double compliance[6][6]) {
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
        energy += 0.25 * e.volume * density(is, compliance, H, S);
        if (state->cauchy != NULL) {
            piola(is, H, S, P);
            add_cauchy(state->cauchy + (row * RG_GAUSS + (size_t)g) * 6 * RG_LANES + lane, H, P);
        }
    }
    if (state->energy != NULL) {
        add_wide(state->energy + row * RG_LANES + lane, energy);
    }
}

RG_INLINE void state_blocks(const rg_prestress_state_args *args, size_t begin, size_t end, kind is) {
    double compliance[6][6];
    rg_material_compliance(&args->state->bulk->material, compliance);
    for (size_t b = begin; b < end; b++) {
        for (int lane = 0; lane < RG_LANES; lane += RG_VLEN) {
            if (args->state->bulk->gradient == RG_GRADIENT_LIFTED) {
                state_vector(args, b, b - begin, lane, RG_GRADIENT_LIFTED, is, compliance);
            } else {
                state_vector(args, b, b - begin, lane, RG_GRADIENT_OWN, is, compliance);
            }
        }
    }
}

void RG_ISA_NAME(rg_prestress_state)(const rg_prestress_state_args *args, size_t begin, size_t end) {
    if (kind_of(&args->state->bulk->material) == PRESSURE) {
        state_blocks(args, begin, end, PRESSURE);
    } else {
        state_blocks(args, begin, end, WHOLE);
    }
}
