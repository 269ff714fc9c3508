/* Constants of the 10-node tetrahedron and its six-node faces (method: thesis chapter 4), and the gather of a
 * neighbour's face. */
#ifndef RG_TET10_H
#define RG_TET10_H

#include "quadrature.h"
#include "vec.h"

/* Shape functions of a six-node triangle at a point with coordinate r = 1 - 2p at its corner and p at the
 * others. */
typedef struct {
    double p, r, weight;
    double corner, other;    /* N of the point's own corner, of the other corners: l (2 l - 1) */
    double adjacent, facing; /* N of the two mid-edges at the own corner, of the one facing it: 4 l l' */
} rg_tri_rule;

#define RG_TRI_RULE(P, W)                                                                                    \
    {                                                                                                        \
        P, 1 - 2 * (P), W, (1 - 2 * (P)) * (1 - 4 * (P)), (P) * (2 * (P)-1), 4 * (P) * (1 - 2 * (P)),        \
            4 * (P) * (P)                                                                                    \
    }

static const rg_tri_rule rg_tri[2] = {RG_TRI_RULE(RG_TRI_P0, RG_TRI_W0), RG_TRI_RULE(RG_TRI_P1, RG_TRI_W1)};

/* Face node (3-5) on the edge facing face corner i. */
static const int rg_facing[3] = {4, 5, 3};

/* Six nodal vectors of the faces that `link` (4 * element + face) names, one face per lane. */
RG_INLINE void rg_gather_face(const double *u, const int32_t link[RG_VLEN], rg_vec out[RG_FNODES][3]) {
    const double *element[RG_VLEN];
    const int *node[RG_VLEN];
    for (int l = 0; l < RG_VLEN; l++) {
        uint32_t side = (uint32_t)link[l];
        element[l] = rg_first_value(u, side / RG_FACES, RG_NODE_BLOCK);
        node[l] = rg_face_node[side % RG_FACES];
    }
    for (int a = 0; a < RG_FNODES; a++) {
        rg_lanes at;
        for (int l = 0; l < RG_VLEN; l++) {
            at.lane[l] = element[l] + node[l][a] * (3 * RG_LANES);
        }
        for (int c = 0; c < 3; c++) {
            out[a][c] = rg_gather(&at, c * RG_LANES);
        }
    }
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
