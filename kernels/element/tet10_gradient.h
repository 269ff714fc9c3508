/* The gradient of a field in a tet10, and the nodal forces of a stress.
 *
 * Everything is written in the derivatives along the barycentric coordinates l_k, because there a quadratic
 * element and its lift are sparse:
 *     F_g + R_g = I + sum_k d_k(g) (x) grad l_k,
 *     d_k(g) = (4a - 1) u_k + 4a sum_j u_kj + 4 (b - a) u_kg                        (element; u_kk = u_k)
 *              - 6/(b - a) ( m_g^k - a sum_i m_i^k )                                (lift; no m_k^k)
 * with a, b the coordinates of the four-point rule and m_i^k = sum_q w_q l_i(q) [u]_q the moments of the jump
 * on the face opposite corner k (Ten Eyck & Lew 2006; the outward normal is N_k area_k = -3 V grad l_k).
 * Conversely, with q_k(g) = (V/4) P_g grad l_k, nodal forces and corner tractions are the transposed sums. */
#ifndef RG_TET10_GRADIENT_H
#define RG_TET10_GRADIENT_H

#include "kernels.h"
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
RG_INLINE void load_element(element *e, const rg_bulk_args *args, size_t block, int lane,
                            rg_gradient gradient) {
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
    if (gradient == RG_GRADIENT_LIFTED) {
        gather_moments(e);
    }
}

/* The part of d_k(g) that is the same at all points, k = 0..3. */
RG_INLINE void common_derivatives(element *e, rg_gradient gradient, vec3 common[4]) {
    for (int k = 0; k < 4; k++) {
        for (int c = 0; c < 3; c++) {
            rg_vec edges = {0};
            for (int j = 0; j < 4; j++) {
                if (j != k) {
                    edges += node(e, rg_edge_node[k][j], c);
                }
            }
            common[k][c] = rg_splat(4 * RG_GAUSS_A - 1) * node(e, k, c) + rg_splat(4 * RG_GAUSS_A) * edges;
            if (gradient == RG_GRADIENT_LIFTED) {
                vec3 *m = e->moment[k];
                common[k][c] += rg_splat(6 * RG_GAUSS_A / RG_GAUSS_BA) * (m[0][c] + m[1][c] + m[2][c]);
            }
        }
    }
}

/* H = F_g + R_g - I at Gauss point g. */
RG_INLINE void displacement_gradient(const element *e, rg_gradient gradient, vec3 common[4], int g,
                                     rg_vec H[3][3]) {
    vec3 d[4];
    for (int k = 0; k < 4; k++) {
        for (int c = 0; c < 3; c++) {
            d[k][c] = common[k][c] + rg_splat(4 * RG_GAUSS_BA) * node(e, rg_edge_node[k][g], c);
            if (gradient == RG_GRADIENT_LIFTED && g != k) {
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

RG_INLINE void put(rg_real *at, rg_vec x, bool add) {
    rg_store(at, add ? rg_load(at) + x : x);
}

/* Nodal forces -sum_g (V/4) P_g grad N_a from q_k(g), and Q_k = sum_g q_k(g); added, or in place of what is
 * there. */
RG_INLINE void store_force(vec3 q[4][RG_GAUSS], vec3 Q[4], rg_real *force, bool add) {
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < 4; k++) {
            put(force + (k * 3 + c) * RG_LANES,
                rg_splat(1 - 4 * RG_GAUSS_A) * Q[k][c] - rg_splat(4 * RG_GAUSS_BA) * q[k][k][c], add);
            for (int j = k + 1; j < 4; j++) {
                put(force + (rg_edge_node[k][j] * 3 + c) * RG_LANES,
                    rg_splat(-4 * RG_GAUSS_A) * (Q[k][c] + Q[j][c]) -
                        rg_splat(4 * RG_GAUSS_BA) * (q[k][j][c] + q[j][k][c]),
                    add);
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

/* q_k(g) and Q_k of a stress at point g with its share of the volume. */
RG_INLINE void project_stress(const element *e, rg_vec weight, rg_vec P[3][3], int g, vec3 q[4][RG_GAUSS],
                              vec3 Q[4]) {
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < 3; k++) {
            q[k][g][c] = weight * rg_dot(P[c], e->grad[k]);
            Q[k][c] += q[k][g][c];
        }
        q[3][g][c] = -(q[0][g][c] + q[1][g][c] + q[2][g][c]);
        Q[3][c] += q[3][g][c];
    }
}

#endif
