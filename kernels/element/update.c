/* Central difference, element by element: the elements own their nodes, so the mass matrix is one constant 10
 * x 10 matrix times rho V. Consistent mass M: its inverse has the entries 100, 10 (corner-corner), 2.5, 10
 * (corner-edge), 28.75, -6.875, 10 (edge-edge), applied here through sums. Lumped: HRZ, corners 1/36,
 * mid-edges 4/27. Scaled: M_s^-1 = M^-1/s + (1 - 1/s) Q, where Q = I (I' M I)^-1 I' of the linear motions I
 * has the entries 16, -4, 6, -4, 6, 1, -4. */
#include "isa.h"
#include "tet10.h"

/* Corners of mid-edge nodes 4 to 9, and the edge opposite each. */
static const int edge_corner[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
static const int edge_opposite[6] = {5, 3, 4, 1, 2, 0};

/* Whether the interface of a link, if there is one, belongs to the sweep. */
RG_INLINE bool is_swept(int32_t link, rg_sweep sweep) {
    return link >= 0 && ((link & RG_TILE_FACE) != 0) == (sweep == RG_SWEEP_BOUNDARY);
}

/* Adds the interface forces of face k, if the sweep is over it. */
RG_INLINE void add_face(const rg_kick_args *args, const int32_t link[RG_VLEN], int k, rg_sweep sweep,
                        rg_vec f[3][RG_NODES]) {
    static _Alignas(64) const rg_real none[RG_IFORCE_BLOCK];
    rg_lanes at;
    rg_vec sign;
    for (int l = 0; l < RG_VLEN; l++) {
        bool there = is_swept(link[l], sweep);
        at.lane[l] = there ? rg_first_value(args->iforce, (uint32_t)link[l] / 4, RG_IFORCE_BLOCK) : none;
        sign[l] = (rg_real)(1 - 2 * (link[l] & 1));
    }
    for (int a = 0; a < RG_FNODES; a++) {
        for (int c = 0; c < 3; c++) {
            f[c][rg_face_node[k][a]] += sign * rg_gather(&at, (a * 3 + c) * RG_LANES);
        }
    }
}

/* Adds what turns the mid-surface of face k, which is the same for both sides. */
RG_INLINE void add_turn(const rg_kick_args *args, const int32_t link[RG_VLEN], int k, rg_sweep sweep,
                        rg_vec f[3][RG_NODES]) {
    static _Alignas(64) const rg_real none[RG_IFORCE_BLOCK];
    rg_lanes at;
    bool any = false;
    for (int l = 0; l < RG_VLEN; l++) {
        bool there = is_swept(link[l], sweep) && args->broken[(uint32_t)link[l] / 4];
        at.lane[l] = there ? rg_first_value(args->turn, (uint32_t)link[l] / 4, RG_IFORCE_BLOCK) : none;
        any |= there;
    }
    for (int a = 0; any && a < RG_FNODES; a++) {
        for (int c = 0; c < 3; c++) {
            f[c][rg_face_node[k][a]] += rg_gather(&at, (a * 3 + c) * RG_LANES);
        }
    }
}

/* Nodal forces: bulk, then the faces in their local order. The order is the mesh's, so the sum has the same
 * bits however the mesh is distributed. */
RG_INLINE void sum_force(const rg_kick_args *args, size_t block, int lane, rg_sweep sweep,
                         rg_vec f[3][RG_NODES]) {
    for (int n = 0; n < RG_NODES; n++) {
        for (int c = 0; c < 3; c++) {
            f[c][n] = sweep == RG_SWEEP_BOUNDARY
                          ? rg_splat(0.0)
                          : rg_load(args->force + block * RG_NODE_BLOCK + (n * 3 + c) * RG_LANES + lane);
        }
    }
    for (int k = 0; k < RG_FACES; k++) {
        const int32_t *link = args->interface + block * RG_LINK_BLOCK + k * RG_LANES + lane;
        add_face(args, link, k, sweep, f);
        if (args->contact == RG_CONTACT_POTENTIAL) {
            add_turn(args, link, k, sweep, f);
        }
    }
}

/* f <- (M_s / (rho V))^-1 f; s = 1: consistent. */
RG_INLINE void solve_scaled(rg_vec f[RG_NODES], double s) {
    double r = 1 / s, q = 1 - r; /* of M^-1, of Q */
    rg_vec corners = f[0] + f[1] + f[2] + f[3], edges = f[4] + f[5] + f[6] + f[7] + f[8] + f[9];
    rg_vec at_corner = rg_splat(10 * r - 4 * q) * (corners + edges);
    rg_vec at_edge = at_corner + rg_splat(-16.875 * r + 5 * q) * edges;
    rg_vec adjoining = rg_splat(-7.5 * r + 10 * q);
    rg_vec out[RG_NODES];
    for (int i = 0; i < 4; i++) {
        rg_vec adjacent = {0};
        for (int j = 0; j < 4; j++) {
            if (j != i) {
                adjacent += f[rg_edge_node[i][j]];
            }
        }
        out[i] = at_corner + rg_splat(90 * r + 20 * q) * f[i] + adjoining * adjacent;
    }
    for (int e = 0; e < 6; e++) {
        out[4 + e] = at_edge + rg_splat(35.625 * r + 5 * q) * f[4 + e] +
                     rg_splat(16.875 * r - 5 * q) * f[4 + edge_opposite[e]] +
                     adjoining * (f[edge_corner[e][0]] + f[edge_corner[e][1]]);
    }
    for (int n = 0; n < RG_NODES; n++) {
        f[n] = out[n];
    }
}

RG_INLINE void solve_lumped(rg_vec f[RG_NODES]) {
    for (int n = 0; n < RG_NODES; n++) {
        f[n] *= n < 4 ? 36 : (rg_real)(27.0 / 4);
    }
}

/* Adds dt M^-1 f to the velocity; dt_now M^-1 f leads to the velocity at the step, the time of the forces. */
RG_INLINE void kick_vector(const rg_kick_args *args, size_t block, int lane, rg_mass mass_matrix,
                           rg_sweep sweep) {
    rg_vec mass = rg_splat(args->density) *
                  rg_load(args->geom + block * RG_GEOM_BLOCK + RG_GEOM_VOLUME * RG_LANES + lane);
    rg_vec scale = rg_splat(args->dt) / mass, scale_now = rg_splat(args->dt_now) / mass;
    rg_vec f[3][RG_NODES];
    sum_force(args, block, lane, sweep, f);
    for (int c = 0; c < 3; c++) {
        if (mass_matrix == RG_MASS_LUMPED) {
            solve_lumped(f[c]);
        } else {
            solve_scaled(f[c], mass_matrix == RG_MASS_SCALED ? RG_MASS_SCALE : 1);
        }
        for (int n = 0; n < RG_NODES; n++) {
            size_t at = block * RG_NODE_BLOCK + (size_t)((n * 3 + c) * RG_LANES + lane);
            rg_vec v = rg_load(args->velocity + at);
            if (args->step_velocity != NULL) {
                rg_store(args->step_velocity + at,
                         (sweep == RG_SWEEP_BOUNDARY ? rg_load(args->step_velocity + at) : v) +
                             scale_now * f[c][n]);
            }
            rg_store(args->velocity + at, v + scale * f[c][n]);
        }
    }
}

void RG_ISA_NAME(rg_kick)(const rg_kick_args *args, size_t begin, size_t end) {
    for (size_t b = begin; b < end; b++) {
        for (int lane = 0; lane < RG_LANES; lane += RG_VLEN) {
            if (args->sweep == RG_SWEEP_BOUNDARY) {
                kick_vector(args, b, lane, args->mass, RG_SWEEP_BOUNDARY);
            } else if (args->mass == RG_MASS_LUMPED) {
                kick_vector(args, b, lane, RG_MASS_LUMPED, RG_SWEEP_ELEMENT);
            } else if (args->mass == RG_MASS_SCALED) {
                kick_vector(args, b, lane, RG_MASS_SCALED, RG_SWEEP_ELEMENT);
            } else {
                kick_vector(args, b, lane, RG_MASS_CONSISTENT, RG_SWEEP_ELEMENT);
            }
        }
    }
}

void RG_ISA_NAME(rg_drift)(const rg_drift_args *args, size_t begin, size_t end) {
    for (size_t i = begin * RG_NODE_BLOCK; i < end * RG_NODE_BLOCK; i += RG_VLEN) {
        rg_store(args->u + i, rg_load(args->u + i) + rg_splat(args->dt) * rg_load(args->velocity + i));
    }
}

/* v M_s v / (rho V) for one component, M_s = s M + (1 - s) M Q M: entries of 420 M are 6, 1 (corner-corner),
 * -4, -6 (corner-edge), 32, 16, 8 (edge-edge), those of 420 M Q M 7/15 of 6, 1, -4, -14, 56, 36, 16. */
RG_INLINE rg_vec scaled_square(const rg_vec v[RG_NODES], double s) {
    double q = (1 - s) * 7 / 15;
    rg_vec corners = v[0] + v[1] + v[2] + v[3], edges = {0}, corner_squares = {0}, edge_terms = {0};
    for (int i = 0; i < 4; i++) {
        corner_squares += v[i] * v[i];
    }
    for (int e = 0; e < 6; e++) {
        rg_vec own = v[4 + e];
        edges += own;
        edge_terms +=
            own * (rg_splat(16 * s + 20 * q) * own - rg_splat(8 * s + 20 * q) * v[4 + edge_opposite[e]] +
                   rg_splat(4 * s + 20 * q) * (v[edge_corner[e][0]] + v[edge_corner[e][1]]));
    }
    rg_vec sum = rg_splat(5 * s + 5 * q) * corner_squares + rg_splat(s + q) * corners * corners -
                 rg_splat(12 * s + 28 * q) * corners * edges + rg_splat(16 * s + 36 * q) * edges * edges +
                 edge_terms;
    return sum / 420.0;
}

RG_INLINE rg_vec lumped_square(const rg_vec v[RG_NODES]) {
    rg_vec sum = {0};
    for (int n = 0; n < RG_NODES; n++) {
        sum += rg_splat(n < 4 ? 1.0 / 36 : 4.0 / 27) * v[n] * v[n];
    }
    return sum;
}

void RG_ISA_NAME(rg_kinetic)(const rg_kinetic_args *args, size_t begin, size_t end) {
    for (size_t b = begin; b < end; b++) {
        for (int lane = 0; lane < RG_LANES; lane += RG_VLEN) {
            rg_vec volume = rg_load(args->geom + b * RG_GEOM_BLOCK + RG_GEOM_VOLUME * RG_LANES + lane);
            rg_vec sum = {0};
            for (int c = 0; c < 3; c++) {
                rg_vec v[RG_NODES];
                for (int n = 0; n < RG_NODES; n++) {
                    v[n] = rg_load(args->velocity + b * RG_NODE_BLOCK + (n * 3 + c) * RG_LANES + lane);
                }
                switch (args->mass) {
                case RG_MASS_LUMPED:
                    sum += lumped_square(v);
                    break;
                case RG_MASS_CONSISTENT:
                    sum += scaled_square(v, 1);
                    break;
                case RG_MASS_SCALED:
                    sum += scaled_square(v, RG_MASS_SCALE);
                    break;
                }
            }
            rg_store_wide(args->energy + (b - begin) * RG_LANES + lane,
                          rg_splat(0.5 * args->density) * volume * sum);
        }
    }
}
