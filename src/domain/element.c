#include "domain/element.h"

/* Ends of each node: a corner is both ends of itself. */
const int rg_node_end[RG_NODES][2] = {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {0, 1},
                                      {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};

void rg_node_position(const double *corner, int node, double x[3]) {
    const int *end = rg_node_end[node];
    for (int c = 0; c < 3; c++) {
        x[c] = 0.5 * (corner[3 * end[0] + c] + corner[3 * end[1] + c]);
    }
}

static double triple(const double a[3], const double b[3], const double c[3]) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
}

void rg_barycentric(const double *corner, const double x[3], double l[4]) {
    double e[3][3], r[3];
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < 3; k++) {
            e[k][c] = corner[3 * k + c] - corner[9 + c];
        }
        r[c] = x[c] - corner[9 + c];
    }
    double det = triple(e[0], e[1], e[2]);
    l[0] = triple(r, e[1], e[2]) / det;
    l[1] = triple(e[0], r, e[2]) / det;
    l[2] = triple(e[0], e[1], r) / det;
    l[3] = 1 - l[0] - l[1] - l[2];
}

void rg_shape(const double l[4], double N[RG_NODES]) {
    for (int n = 0; n < RG_NODES; n++) {
        const int *end = rg_node_end[n];
        N[n] = n < 4 ? l[n] * (2 * l[n] - 1) : 4 * l[end[0]] * l[end[1]];
    }
}

/* Corners that two mid-edges, or an edge and a corner (listed twice), have in common. */
static int common_ends(int a, int b) {
    const int *p = rg_node_end[a], *q = rg_node_end[b];
    return (p[0] == q[0]) + (p[0] == q[1]) + (p[1] == q[0]) + (p[1] == q[1]);
}

/* Value for a pair of nodes by kind: corners same, different; corner and edge adjacent, opposite; edges same,
 * adjacent, opposite. */
static double by_kind(const double kind[7], int a, int b) {
    int common = common_ends(a, b);
    if (a < 4 && b < 4) {
        return kind[a == b ? 0 : 1];
    }
    if (a < 4 || b < 4) {
        return kind[common > 0 ? 2 : 3];
    }
    return kind[a == b ? 4 : common > 0 ? 5 : 6];
}

double rg_mass_entry(rg_mass kind, int a, int b) {
    static const double entry[7] = {6. / 420, 1. / 420, -4. / 420, -6. / 420, 32. / 420, 16. / 420, 8. / 420};
    static const double affine[7] = {6. / 900,  1. / 900,  -4. / 900, -14. / 900,
                                     56. / 900, 36. / 900, 16. / 900};
    if (kind == RG_MASS_LUMPED) {
        return a != b ? 0 : a < 4 ? 1. / 36 : 4. / 27;
    }
    if (kind == RG_MASS_SCALED) {
        return RG_MASS_SCALE * by_kind(entry, a, b) + (1 - RG_MASS_SCALE) * by_kind(affine, a, b);
    }
    return by_kind(entry, a, b);
}

double rg_inverse_mass_entry(rg_mass kind, int a, int b) {
    static const double entry[7] = {100, 10, 2.5, 10, 28.75, -6.875, 10};
    static const double affine[7] = {16, -4, 6, -4, 6, 1, -4};
    if (kind == RG_MASS_LUMPED) {
        return a != b ? 0 : a < 4 ? 36 : 27. / 4;
    }
    if (kind == RG_MASS_SCALED) {
        return by_kind(entry, a, b) / RG_MASS_SCALE + (1 - 1. / RG_MASS_SCALE) * by_kind(affine, a, b);
    }
    return by_kind(entry, a, b);
}

void rg_mass_times(rg_mass kind, double mass, const rg_real *v, size_t slot, double out[RG_NODES][3]) {
    for (int a = 0; a < RG_NODES; a++) {
        for (int c = 0; c < 3; c++) {
            out[a][c] = 0;
            for (int b = 0; b < RG_NODES; b++) {
                out[a][c] += mass * rg_mass_entry(kind, a, b) * v[rg_node_index(slot, b, c)];
            }
        }
    }
}
