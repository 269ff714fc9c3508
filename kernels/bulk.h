/* The tet10 kernel: internal force, face tractions, energy and stress at the lifted gradient F + R.
 *
 * Everything is written in the derivatives along the barycentric coordinates l_k, because there a quadratic
 * element and its lift are sparse:
 *     F_g + R_g = I + sum_k d_k(g) (x) grad l_k,
 *     d_k(g) = (4a - 1) u_k + 4a sum_j u_kj + 4 (b - a) u_kg                        (element; u_kk = u_k)
 *              - 6/(b - a) ( m_g^k - a sum_i m_i^k )                                (lift; no m_k^k)
 * with a, b the coordinates of the four-point rule and m_i^k = sum_q w_q l_i(q) [u]_q the moments of the jump
 * on the face opposite corner k (Ten Eyck & Lew 2006; the outward normal is N_k area_k = -3 V grad l_k).
 * Conversely, with q_k(g) = (V/4) P_g grad l_k, nodal forces and corner tractions are the transposed sums.
 *
 * Included by one source per material (material_point.h), whose functions are compiled into the loops. */
#ifndef RG_BULK_H
#define RG_BULK_H

#include "isa.h"
#include "material_point.h"
#include "tet10.h"

typedef rg_vec vec3[3];

/* The element's own fields, as one vector of lanes sees them. */
typedef struct {
    const rg_bulk_args *args;
    size_t block;
    int lane;         /* first lane of the vector */
    const rg_real *u; /* the block's displacement at that lane */
    vec3 grad[3];     /* grad l_k, k = 0, 1, 2 */
    rg_vec volume;
    vec3 moment[RG_FACES][RG_FCORNERS]; /* m_i^k, i the face's corners */
} element;

RG_INLINE rg_vec node(const element *e, int n, int c) {
    return rg_load(e->u + (n * 3 + c) * RG_LANES);
}

/* Moments of a jump given at the nodes, exactly: int l_i N_j over the face, area 1. */
RG_INLINE void moments_of_nodes(vec3 jump[RG_FNODES], vec3 m[RG_FCORNERS]) {
    for (int c = 0; c < 3; c++) {
        rg_vec corners = jump[0][c] + jump[1][c] + jump[2][c], edges = jump[3][c] + jump[4][c] + jump[5][c];
        rg_vec common = rg_splat(2.0 / 15) * edges - rg_splat(1.0 / 60) * corners;
        for (int i = 0; i < 3; i++) {
            m[i][c] = common + rg_splat(1.0 / 20) * jump[i][c] - rg_splat(1.0 / 15) * jump[rg_facing[i]][c];
        }
    }
}

/* Where points of a face have left the lift, its moments are the sum over the points that remain. Lanes
 * without such points keep their bits, so that a lane's result does not depend on its companions. */
static __attribute__((noinline)) void moments_of_points(vec3 jump[RG_FNODES], const uint8_t unlinked[],
                                                        vec3 m[RG_FCORNERS]) {
    vec3 point[RG_POINTS];
    rg_face_to_points(jump, point);
    rg_mask bits;
    for (int l = 0; l < RG_VLEN; l++) {
        bits[l] = unlinked[l];
    }
    vec3 sum[RG_FCORNERS] = {{{0}}};
    for (int q = 0; q < RG_POINTS; q++) {
        rg_mask linked = ((bits >> q) & 1) == 0;
        const rg_tri_rule *rule = &rg_tri[q / 3];
        for (int c = 0; c < 3; c++) {
            rg_vec w = rg_select(linked, rule->weight * point[q][c], rg_splat(0.0));
            for (int i = 0; i < 3; i++) {
                sum[i][c] += (i == q % 3 ? rule->r : rule->p) * w;
            }
        }
    }
    for (int i = 0; i < 3; i++) {
        for (int c = 0; c < 3; c++) {
            m[i][c] = rg_select(bits != 0, sum[i][c], m[i][c]);
        }
    }
}

RG_INLINE bool unlinked_points(const element *e, int f, uint8_t unlinked[RG_VLEN]) {
    const int32_t *link = e->args->interface + e->block * RG_LINK_BLOCK + f * RG_LANES + e->lane;
    uint8_t any = 0;
    for (int l = 0; l < RG_VLEN; l++) {
        unlinked[l] = link[l] >= 0 ? e->args->unlinked[link[l] >> 2] : 0;
        any |= unlinked[l];
    }
    return any != 0;
}

RG_INLINE void gather_moments(element *e) {
    bool cracked = e->args->cracked[e->block] != 0;
    for (int f = 0; f < RG_FACES; f++) {
        vec3 jump[RG_FNODES];
        const int32_t *link = e->args->neighbour + e->block * RG_LINK_BLOCK + f * RG_LANES + e->lane;
        rg_gather_neighbour(e->args->u, e->args->ghost, link, jump);
        for (int a = 0; a < RG_FNODES; a++) {
            for (int c = 0; c < 3; c++) {
                jump[a][c] -= node(e, rg_face_node[f][a], c);
            }
        }
        moments_of_nodes(jump, e->moment[f]);
        uint8_t unlinked[RG_VLEN];
        if (cracked && unlinked_points(e, f, unlinked)) {
            moments_of_points(jump, unlinked, e->moment[f]);
        }
    }
}

/* Loads the element geometry and, for the variational form, the moments of its jumps. */
RG_INLINE void load_element(element *e, const rg_bulk_args *args, size_t block, int lane, bool lift) {
    e->args = args;
    e->block = block;
    e->lane = lane;
    e->u = args->u + block * RG_NODE_BLOCK + lane;
    const rg_real *geom = args->geom + block * RG_GEOM_BLOCK + lane;
    for (int k = 0; k < 3; k++) {
        for (int c = 0; c < 3; c++) {
            e->grad[k][c] = rg_load(geom + (RG_GEOM_GRAD + 3 * k + c) * RG_LANES);
        }
    }
    e->volume = rg_load(geom + RG_GEOM_VOLUME * RG_LANES);
    if (lift) {
        gather_moments(e);
    }
}

/* The part of d_k(g) that is the same at all points, k = 0..3. */
RG_INLINE void common_derivatives(element *e, bool lift, vec3 common[4]) {
    for (int k = 0; k < 4; k++) {
        for (int c = 0; c < 3; c++) {
            rg_vec edges = {0};
            for (int j = 0; j < 4; j++) {
                if (j != k) {
                    edges += node(e, rg_edge_node[k][j], c);
                }
            }
            common[k][c] = rg_splat(4 * RG_GAUSS_A - 1) * node(e, k, c) + rg_splat(4 * RG_GAUSS_A) * edges;
            if (lift) {
                vec3 *m = e->moment[k];
                common[k][c] += rg_splat(6 * RG_GAUSS_A / RG_GAUSS_BA) * (m[0][c] + m[1][c] + m[2][c]);
            }
        }
    }
}

/* H = F_g + R_g - I at Gauss point g. */
RG_INLINE void displacement_gradient(const element *e, bool lift, vec3 common[4], int g, rg_vec H[3][3]) {
    vec3 d[4];
    for (int k = 0; k < 4; k++) {
        for (int c = 0; c < 3; c++) {
            d[k][c] = common[k][c] + rg_splat(4 * RG_GAUSS_BA) * node(e, rg_edge_node[k][g], c);
            if (lift && g != k) {
                d[k][c] -= rg_splat(6 / RG_GAUSS_BA) * e->moment[k][g < k ? g : g - 1][c];
            }
        }
    }
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            H[i][j] = (d[0][i] - d[3][i]) * e->grad[0][j] + (d[1][i] - d[3][i]) * e->grad[1][j] +
                      (d[2][i] - d[3][i]) * e->grad[2][j];
        }
    }
}

/* Nodal forces -sum_g (V/4) P_g grad N_a from q_k(g), and Q_k = sum_g q_k(g). */
RG_INLINE void store_force(vec3 q[4][RG_GAUSS], vec3 Q[4], rg_real *force) {
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < 4; k++) {
            rg_store(force + (k * 3 + c) * RG_LANES,
                     rg_splat(1 - 4 * RG_GAUSS_A) * Q[k][c] - rg_splat(4 * RG_GAUSS_BA) * q[k][k][c]);
            for (int j = k + 1; j < 4; j++) {
                rg_store(force + (rg_edge_node[k][j] * 3 + c) * RG_LANES,
                         rg_splat(-4 * RG_GAUSS_A) * (Q[k][c] + Q[j][c]) -
                             rg_splat(4 * RG_GAUSS_BA) * (q[k][j][c] + q[j][k][c]));
            }
        }
    }
}

/* Area-weighted corner tractions sum_g e_ig P_g (area_f N_f), e_ig = (delta_ig - a)/(b - a). */
RG_INLINE void store_traction(vec3 q[4][RG_GAUSS], vec3 Q[4], rg_real *traction) {
    rg_vec row[RG_TRACTION_ROW];
    for (int f = 0; f < RG_FACES; f++) {
        for (int i = 0; i < RG_FCORNERS; i++) {
            for (int c = 0; c < 3; c++) {
                row[(f * RG_FCORNERS + i) * 3 + c] =
                    rg_splat(12 / RG_GAUSS_BA) *
                    (rg_splat(RG_GAUSS_A) * Q[f][c] - q[f][rg_face_node[f][i]][c]);
            }
        }
    }
    rg_store_rows(traction, RG_TRACTION_ROW, RG_TRACTION_ROW, row);
}

enum { HISTORY_ROWS = RG_HISTORY == 0 ? 0 : RG_GAUSS * RG_HISTORY + RG_RELEASED };

RG_INLINE rg_real *history_of(const rg_bulk_args *args, size_t block, int lane) {
    return HISTORY_ROWS == 0 ? NULL : args->history + block * HISTORY_ROWS * RG_LANES + lane;
}

RG_INLINE void load_history(const rg_real *from, int g, rg_vec history[]) {
    for (int k = 0; k < RG_HISTORY; k++) {
        history[k] = rg_load(from + (g * RG_HISTORY + k) * RG_LANES);
    }
}

RG_INLINE void store_history(rg_real *to, int g, const rg_vec history[]) {
    for (int k = 0; k < RG_HISTORY; k++) {
        rg_store(to + (g * RG_HISTORY + k) * RG_LANES, history[k]);
    }
}

/* Adds to what the element has set free. */
RG_INLINE void store_released(rg_real *to, const rg_vec released[RG_RELEASED]) {
    for (int k = 0; k < RG_RELEASED; k++) {
        rg_real *at = to + (RG_GAUSS * RG_HISTORY + k) * RG_LANES;
        rg_store(at, rg_load(at) + released[k]);
    }
}

RG_INLINE void bulk_vector(const rg_bulk_args *args, size_t block, int lane, bool lift) {
    element e;
    load_element(&e, args, block, lane, lift);
    vec3 common[4], q[4][RG_GAUSS], Q[4] = {{{0}}};
    common_derivatives(&e, lift, common);
    rg_real *past = history_of(args, block, lane);
    rg_vec stiffening = {0}, bad = {0}, weight = 0.25 * e.volume, released[RG_RELEASED] = {{0}};
    for (int g = 0; g < RG_GAUSS; g++) {
        rg_vec H[3][3], P[3][3], history[RG_HISTORY + 1];
        rg_point point;
        displacement_gradient(&e, lift, common, g, H);
        load_history(past, g, history);
        material_step(args, H, history, P, &point);
        stiffening = rg_max(stiffening, point.stiffening);
        bad += 0.0 * point.stiffening; /* a maximum forgets what is not a number */
        if (RG_HISTORY > 0 && args->advance) {
            store_history(past, g, history);
            for (int k = 0; k < RG_RELEASED; k++) {
                released[k] += weight * point.released[k];
            }
        }
        for (int c = 0; c < 3; c++) {
            for (int k = 0; k < 3; k++) {
                q[k][g][c] = weight * rg_dot(P[c], e.grad[k]);
                Q[k][c] += q[k][g][c];
            }
            q[3][g][c] = -(q[0][g][c] + q[1][g][c] + q[2][g][c]);
            Q[3][c] += q[3][g][c];
        }
    }
    if (RG_HISTORY > 0 && args->advance) {
        store_released(past, released);
    }
    store_force(q, Q, args->force + block * RG_NODE_BLOCK + lane);
    store_traction(q, Q, args->traction + (block * RG_LANES + (size_t)lane) * RG_TRACTION_ROW);
    rg_store(args->stiffening + block * RG_LANES + lane, stiffening + bad);
}

#define BULK_KERNEL(kernel) RG_ISA_NAME(RG_PASTE(kernel, RG_MATERIAL))

void BULK_KERNEL(rg_bulk)(const rg_bulk_args *args, size_t begin, size_t end) {
    for (size_t b = begin; b < end; b++) {
        for (int lane = 0; lane < RG_LANES; lane += RG_VLEN) {
            if (args->lift) {
                bulk_vector(args, b, lane, true);
            } else {
                bulk_vector(args, b, lane, false);
            }
        }
    }
}

/* Cauchy stress P F^T/J of one point. */
RG_INLINE void store_cauchy(double *out, rg_vec H[3][3], rg_point_state *s) {
    static const int first[6] = {0, 1, 2, 1, 0, 0}, second[6] = {0, 1, 2, 2, 2, 1};
    rg_vec F[3][3];
    rg_plus_identity(H, F);
    for (int k = 0; k < 6; k++) {
        rg_store_wide(out + k * RG_LANES, rg_dot(s->P[first[k]], F[second[k]]) / s->J);
    }
}

RG_INLINE void state_vector(const rg_bulk_state_args *args, size_t block, size_t row, int lane, bool lift) {
    element e;
    load_element(&e, args->bulk, block, lane, lift);
    vec3 common[4];
    common_derivatives(&e, lift, common);
    const rg_real *past = history_of(args->bulk, block, lane);
    rg_vec energy = {0};
    for (int g = 0; g < RG_GAUSS; g++) {
        rg_vec H[3][3], history[RG_HISTORY + 1];
        rg_point_state s;
        size_t at = row * RG_GAUSS + (size_t)g;
        displacement_gradient(&e, lift, common, g, H);
        load_history(past, g, history);
        material_state(&args->bulk->material, H, history, args->cauchy != NULL, &s);
        energy += 0.25 * e.volume * s.energy;
        if (args->cauchy != NULL) {
            store_cauchy(args->cauchy + at * 6 * RG_LANES + lane, H, &s);
        }
        for (int k = 0; RG_HISTORY > 0 && args->internal != NULL && k < RG_INTERNAL; k++) {
            rg_store_wide(args->internal + (at * RG_INTERNAL + (size_t)k) * RG_LANES + lane, s.internal[k]);
        }
    }
    if (args->energy != NULL) {
        rg_store_wide(args->energy + row * RG_LANES + lane, energy);
    }
}

void BULK_KERNEL(rg_bulk_state)(const rg_bulk_state_args *args, size_t begin, size_t end) {
    for (size_t b = begin; b < end; b++) {
        for (int lane = 0; lane < RG_LANES; lane += RG_VLEN) {
            if (args->bulk->lift) {
                state_vector(args, b, b - begin, lane, true);
            } else {
                state_vector(args, b, b - begin, lane, false);
            }
        }
    }
}

#endif
