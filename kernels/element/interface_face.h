/* A face as the interface kernel finds it: geometry, jumps and tractions of both sides, the forces of the DG
 * terms, the deformed mid-surface. Vectors of faces at once.
 *
 * A tile-boundary face knows the other side by a ghost trace and a row of tractions; it turns differences
 * into the direction from minus to plus, so that both tiles get the same bits. All tractions are
 * area-weighted: they carry the reference area of the face as a factor (N). */
#ifndef RG_INTERFACE_FACE_H
#define RG_INTERFACE_FACE_H

#include "isa.h"
#include "tet10.h"

typedef rg_vec vec3[3];

/* A vector of interfaces at work. */
typedef struct {
    const rg_interface_args *args;
    size_t block;
    int lane;
    bool tile_face;
    vec3 edge[2], normal; /* normal: area vector A */
    rg_vec area_square, area, pen_iso, pen_norm;
    bool damaged;           /* some face of the block is */
    vec3 middle[RG_FNODES]; /* damaged faces: mean of the displacements of both sides (find_middle) */
    vec3 jump[RG_POINTS];   /* [u] */
    vec3 mean[RG_POINTS];   /* <P> A */
    vec3 total[RG_POINTS];  /* traction that acts */
    rg_vec strength, strong_area, opening, inverse, contact; /* damaged faces: the law here (load_law) */
    rg_vec beta2;
} interface;

RG_INLINE const int32_t *side(const interface *s, int k) {
    return s->args->side[k] + s->block * RG_LANES + s->lane;
}

RG_INLINE void load_interface(interface *s, const rg_interface_args *args, size_t block, int lane,
                              bool tile_face) {
    s->args = args;
    s->block = block;
    s->lane = lane;
    s->tile_face = tile_face;
    s->damaged = args->active[block] != 0;
    const rg_real *geom = args->geom + block * RG_IGEOM_BLOCK + lane;
    for (int k = 0; k < 2; k++) {
        for (int c = 0; c < 3; c++) {
            s->edge[k][c] = rg_load(geom + (RG_IGEOM_EDGE + 3 * k + c) * RG_LANES);
        }
    }
    rg_cross(s->edge[0], s->edge[1], s->normal);
    for (int c = 0; c < 3; c++) {
        s->normal[c] *= 0.5;
    }
    s->area_square = rg_dot(s->normal, s->normal);
    s->pen_iso = rg_load(geom + RG_IGEOM_PEN_ISO * RG_LANES);
    s->pen_norm = rg_load(geom + RG_IGEOM_PEN_NORM * RG_LANES);
}

/* What turns (other - own) into (plus - minus). */
RG_INLINE rg_vec direction(const interface *s) {
    rg_vec sign;
    for (int l = 0; l < RG_VLEN; l++) {
        sign[l] = (rg_real)(1 - 2 * (side(s, 1)[l] & 1));
    }
    return sign;
}

/* Displacement on both sides: minus and plus, or own and other. */
RG_INLINE void traces(const interface *s, vec3 one[RG_FNODES], vec3 two[RG_FNODES]) {
    rg_gather_face(s->args->u, side(s, 0), one);
    if (!s->tile_face) {
        rg_gather_face(s->args->u, side(s, 1), two);
        return;
    }
    const rg_real *ghost = s->args->ghost + (s->block - s->args->first_tile_face) * RG_GHOST_BLOCK + s->lane;
    for (int a = 0; a < RG_FNODES; a++) {
        for (int c = 0; c < 3; c++) {
            two[a][c] = rg_load(ghost + (a * 3 + c) * RG_LANES);
        }
    }
}

RG_INLINE void set_middle(interface *s, vec3 one[RG_FNODES], vec3 two[RG_FNODES]) {
    for (int a = 0; a < RG_FNODES; a++) {
        for (int c = 0; c < 3; c++) {
            s->middle[a][c] = 0.5 * (one[a][c] + two[a][c]);
        }
    }
}

/* Where faces break that no damage was expected of. */
RG_INLINE void find_middle(interface *s) {
    if (!s->damaged) {
        vec3 one[RG_FNODES], two[RG_FNODES];
        traces(s, one, two);
        set_middle(s, one, two);
        s->damaged = true;
    }
}

RG_INLINE void jump_at_points(interface *s) {
    vec3 one[RG_FNODES], two[RG_FNODES];
    traces(s, one, two);
    if (s->damaged) {
        set_middle(s, one, two);
    }
    for (int a = 0; a < RG_FNODES; a++) {
        for (int c = 0; c < 3; c++) {
            two[a][c] -= one[a][c];
            if (s->tile_face) {
                two[a][c] *= direction(s);
            }
        }
    }
    rg_face_to_points(two, s->jump);
}

/* Corner tractions of side k, each with its own outward normal. */
RG_INLINE void tractions(const interface *s, int k, rg_vec t[RG_TILE_FACE_ROW]) {
    rg_lanes at;
    for (int l = 0; l < RG_VLEN; l++) {
        if (!s->tile_face) { /* a side link is the number of a face: 4 * element + face */
            at.lane[l] = s->args->traction + (size_t)side(s, k)[l] * RG_TILE_FACE_ROW;
        } else if (k == 0) {
            size_t tile_face = (s->block - s->args->first_tile_face) * RG_LANES + (size_t)(s->lane + l);
            at.lane[l] = s->args->own_tractions + tile_face * RG_TILE_FACE_ROW;
        } else {
            at.lane[l] = s->args->tractions + (size_t)((uint32_t)side(s, 1)[l] / 2) * RG_TILE_FACE_ROW;
        }
    }
    rg_load_rows(&at, RG_TILE_FACE_ROW, t);
}

/* <P> A at the points. */
RG_INLINE void mean_traction(interface *s) {
    rg_vec t[2][RG_TILE_FACE_ROW];
    tractions(s, 0, t[0]);
    tractions(s, 1, t[1]);
    for (int i = 0; i < RG_TILE_FACE_ROW; i++) {
        t[0][i] = 0.5 * (t[0][i] - t[1][i]);
        if (s->tile_face) {
            t[0][i] *= direction(s);
        }
    }
    for (int c = 0; c < 3; c++) {
        for (int q = 0; q < RG_POINTS; q++) {
            const rg_tri_rule *n = &rg_tri[q / 3];
            s->mean[q][c] =
                n->p * (t[0][c] + t[0][3 + c] + t[0][6 + c]) + (n->r - n->p) * t[0][3 * (q % 3) + c];
        }
    }
}

/* DG traction <P> A + (beta_s/h_s) <A> [u]. */
RG_INLINE void dg_traction(interface *s) {
    for (int q = 0; q < RG_POINTS; q++) {
        rg_vec normal_jump = s->pen_norm * rg_dot(s->normal, s->jump[q]);
        for (int c = 0; c < 3; c++) {
            s->total[q][c] = s->mean[q][c] + s->pen_iso * s->jump[q][c] + normal_jump * s->normal[c];
        }
    }
}

/* Normal stiffness of the penalty (N/m). */
RG_INLINE rg_vec normal_penalty(const interface *s) {
    return s->pen_iso + s->pen_norm * s->area_square;
}

/* Nodal forces sum_q w_q N_a(q) T_q. */
RG_INLINE void store_nodal_force(const interface *s) {
    rg_real *force = s->args->force + s->block * RG_IFORCE_BLOCK + s->lane;
    for (int c = 0; c < 3; c++) {
        rg_vec corner[2], edge[2], sum[2];
        for (int k = 0; k < 2; k++) {
            sum[k] =
                rg_tri[k].weight * (s->total[3 * k][c] + s->total[3 * k + 1][c] + s->total[3 * k + 2][c]);
            corner[k] = rg_splat(rg_tri[k].weight * (rg_tri[k].corner - rg_tri[k].other));
            edge[k] = rg_splat(rg_tri[k].weight * (rg_tri[k].facing - rg_tri[k].adjacent));
        }
        rg_vec corners = rg_tri[0].other * sum[0] + rg_tri[1].other * sum[1];
        rg_vec edges = rg_tri[0].adjacent * sum[0] + rg_tri[1].adjacent * sum[1];
        for (int i = 0; i < 3; i++) {
            rg_store(force + (i * 3 + c) * RG_LANES,
                     corners + corner[0] * s->total[i][c] + corner[1] * s->total[3 + i][c]);
            rg_store(force + (rg_facing[i] * 3 + c) * RG_LANES,
                     edges + edge[0] * s->total[i][c] + edge[1] * s->total[3 + i][c]);
        }
    }
}

/* ---- Deformed mid-surface ---- */

/* Derivatives of the six shape functions along xi and eta (l = 1 - xi - eta, xi, eta) at point q. */
RG_INLINE void face_derivatives(int q, rg_real xi[RG_FNODES], rg_real eta[RG_FNODES]) {
    rg_real l[3];
    for (int i = 0; i < 3; i++) {
        l[i] = i == q % 3 ? rg_tri[q / 3].r : rg_tri[q / 3].p;
    }
    const rg_real dxi[RG_FNODES] = {1 - 4 * l[0], 4 * l[1] - 1, 0, 4 * (l[0] - l[1]), 4 * l[2], -4 * l[2]};
    const rg_real deta[RG_FNODES] = {1 - 4 * l[0], 0, 4 * l[2] - 1, -4 * l[1], 4 * l[1], 4 * (l[0] - l[2])};
    memcpy(xi, dxi, sizeof dxi);
    memcpy(eta, deta, sizeof deta);
}

/* Tangents g1 = dx/dxi, g2 = dx/deta of the deformed mid-surface at the points (m). */
RG_INLINE void mid_tangents(const interface *s, vec3 g[RG_POINTS][2]) {
    for (int q = 0; q < RG_POINTS; q++) {
        rg_real xi[RG_FNODES], eta[RG_FNODES];
        face_derivatives(q, xi, eta);
        for (int c = 0; c < 3; c++) {
            g[q][0][c] = s->edge[0][c];
            g[q][1][c] = s->edge[1][c];
            for (int a = 0; a < RG_FNODES; a++) {
                g[q][0][c] += xi[a] * s->middle[a][c];
                g[q][1][c] += eta[a] * s->middle[a][c];
            }
        }
    }
}

/* Its unit normals n there, and its area (m^2). */
RG_INLINE void mid_surface(vec3 g[RG_POINTS][2], vec3 n[RG_POINTS], rg_vec area[RG_POINTS]) {
    for (int q = 0; q < RG_POINTS; q++) {
        rg_cross(g[q][0], g[q][1], n[q]);
        rg_vec twice = rg_sqrt(rg_dot(n[q], n[q]));
        area[q] = 0.5 * twice;
        for (int c = 0; c < 3; c++) {
            n[q][c] *= 1.0 / rg_max(twice, rg_splat(RG_NO_AREA)); /* padding has no area */
        }
    }
}

#endif
