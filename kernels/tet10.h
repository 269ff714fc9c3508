/* Constants of the 10-node tetrahedron and its six-node faces (method: thesis chapter 4), and the gather of a
 * neighbour's face. */
#ifndef RG_TET10_H
#define RG_TET10_H

#include "quadrature.h"
#include "vec.h"

/* Shape functions of a six-node triangle at a point with coordinate r = 1 - 2p at its corner and p at the
 * others. */
typedef struct {
    rg_real p, r, weight;
    rg_real corner, other;    /* N of the point's own corner, of the other corners: l (2 l - 1) */
    rg_real adjacent, facing; /* N of the two mid-edges at the own corner, of the one facing it: 4 l l' */
} rg_tri_rule;

#define RG_TRI_RULE(P, W)                                                                                    \
    {                                                                                                        \
        (rg_real)(P), (rg_real)(1 - 2 * (P)), (rg_real)(W), (rg_real)((1 - 2 * (P)) * (1 - 4 * (P))),        \
            (rg_real)((P) * (2 * (P)-1)), (rg_real)(4 * (P) * (1 - 2 * (P))), (rg_real)(4 * (P) * (P))       \
    }

static const rg_tri_rule rg_tri[2] = {RG_TRI_RULE(RG_TRI_P0, RG_TRI_W0), RG_TRI_RULE(RG_TRI_P1, RG_TRI_W1)};

/* Face node (3-5) on the edge facing face corner i. */
static const int rg_facing[3] = {4, 5, 3};

/* Six nodal vectors of a face in each lane: lane l reads node a at trace[l] + place[l][a] * 3 * RG_LANES. */
RG_INLINE void rg_gather_nodes(const rg_real *const trace[RG_VLEN], const int *const place[RG_VLEN],
                               rg_vec out[RG_FNODES][3]) {
    for (int a = 0; a < RG_FNODES; a++) {
        rg_lanes at;
        for (int l = 0; l < RG_VLEN; l++) {
            at.lane[l] = trace[l] + place[l][a] * (3 * RG_LANES);
        }
        for (int c = 0; c < 3; c++) {
            out[a][c] = rg_gather(&at, c * RG_LANES);
        }
    }
}

/* Traces of a nodal field on the elements' faces that side links name. */
RG_INLINE void rg_gather_face(const rg_real *u, const int32_t link[RG_VLEN], rg_vec out[RG_FNODES][3]) {
    const rg_real *trace[RG_VLEN];
    const int *place[RG_VLEN];
    for (int l = 0; l < RG_VLEN; l++) {
        uint32_t side = (uint32_t)link[l];
        trace[l] = rg_first_value(u, side / RG_FACES, RG_NODE_BLOCK);
        place[l] = rg_face_node[side % RG_FACES];
    }
    rg_gather_nodes(trace, place, out);
}

/* Traces that neighbour links name: of elements of the tile, or ghosts. */
RG_INLINE void rg_gather_neighbour(const rg_real *u, const rg_real *ghost, const int32_t link[RG_VLEN],
                                   rg_vec out[RG_FNODES][3]) {
    static const int order[RG_FACES + 1][RG_FNODES] = {
        {1, 2, 3, 5, 9, 8}, {0, 2, 3, 6, 9, 7}, {0, 1, 3, 4, 8, 7}, {0, 1, 2, 4, 5, 6}, {0, 1, 2, 3, 4, 5}};
    const rg_real *trace[RG_VLEN];
    const int *place[RG_VLEN];
    for (int l = 0; l < RG_VLEN; l++) {
        uint32_t number = (uint32_t)link[l] / 8, code = (uint32_t)link[l] % 8;
        trace[l] = code == RG_GHOST ? rg_first_value(ghost, number, RG_GHOST_BLOCK)
                                    : rg_first_value(u, number, RG_NODE_BLOCK);
        place[l] = order[code];
    }
    rg_gather_nodes(trace, place, out);
}

/* Values at the six points of one component of a field given at the six face nodes. */
RG_INLINE void rg_face_to_points(rg_vec node[RG_FNODES][3], rg_vec point[RG_POINTS][3]) {
    for (int c = 0; c < 3; c++) {
        rg_vec corners = node[0][c] + node[1][c] + node[2][c], edges = node[3][c] + node[4][c] + node[5][c];
        for (int q = 0; q < RG_POINTS; q++) {
            const rg_tri_rule *n = &rg_tri[q / 3];
            int i = q % 3;
            point[q][c] = n->other * corners + n->adjacent * edges + (n->corner - n->other) * node[i][c] +
                          (n->facing - n->adjacent) * node[rg_facing[i]][c];
        }
    }
}

#endif
