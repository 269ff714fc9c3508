#include "domain/element.h"

#include <string.h>

#include "base/vector.h"
#include "quadrature.h"

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

void rg_gauss_position(const double *corner, int g, double x[3]) {
    for (int c = 0; c < 3; c++) {
        x[c] = 0;
        for (int i = 0; i < 4; i++) {
            x[c] += (i == g ? RG_GAUSS_B : RG_GAUSS_A) * corner[3 * i + c];
        }
    }
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

void rg_barycentric_slopes(const double *corner, double slope[4][3]) {
    double edge[3][3];
    for (int k = 0; k < 3; k++) {
        rg_vector_subtract(corner + 3 * (k + 1), corner, edge[k]);
    }
    for (int c = 0; c < 3; c++) {
        slope[0][c] = 0;
    }
    for (int k = 0; k < 3; k++) {
        rg_vector_cross(edge[(k + 1) % 3], edge[(k + 2) % 3], slope[k + 1]);
        double six_volumes = rg_vector_dot(edge[k], slope[k + 1]);
        for (int c = 0; c < 3; c++) {
            slope[k + 1][c] /= six_volumes;
            slope[0][c] -= slope[k + 1][c];
        }
    }
}

void rg_corner_gradients(const rg_real *field, size_t slot, double slope[4][3], double out[4][3][3]) {
    memset(out, 0, 4 * sizeof *out);
    for (int n = 0; n < RG_NODES; n++) {
        int one = rg_node_end[n][0], two = rg_node_end[n][1];
        for (int at = 0; at < 4; at++) {
            for (int j = 0; j < 3; j++) {
                double d = n < 4 ? (at == n ? 3 : -1) * slope[n][j]
                                 : 4 * ((at == one) * slope[two][j] + (at == two) * slope[one][j]);
                for (int i = 0; i < 3; i++) {
                    out[at][i][j] += d * field[rg_node_index(slot, n, i)];
                }
            }
        }
    }
}

/* Kinds of pairs of nodes: corners same 0, different 1; corner and edge adjacent 2, opposite 3; edges same 4,
 * adjacent 5, opposite 6. */
static const uint8_t kind_of[RG_NODES][RG_NODES] = {
    {0, 1, 1, 1, 2, 3, 2, 2, 3, 3}, {1, 0, 1, 1, 2, 2, 3, 3, 2, 3}, {1, 1, 0, 1, 3, 2, 2, 3, 3, 2},
    {1, 1, 1, 0, 3, 3, 3, 2, 2, 2}, {2, 2, 3, 3, 4, 5, 5, 5, 5, 6}, {3, 2, 2, 3, 5, 4, 5, 6, 5, 5},
    {2, 3, 2, 3, 5, 5, 4, 5, 6, 5}, {2, 3, 3, 2, 5, 6, 5, 4, 5, 5}, {3, 2, 3, 2, 5, 5, 6, 5, 4, 5},
    {3, 3, 2, 2, 6, 5, 5, 5, 5, 4}};

double rg_mass_entry(rg_mass kind, int a, int b) {
    static const double entry[7] = {6. / 420, 1. / 420, -4. / 420, -6. / 420, 32. / 420, 16. / 420, 8. / 420};
    static const double affine[7] = {6. / 900,  1. / 900,  -4. / 900, -14. / 900,
                                     56. / 900, 36. / 900, 16. / 900};
    if (kind == RG_MASS_LUMPED) {
        return a != b ? 0 : a < 4 ? 1. / 36 : 4. / 27;
    }
    if (kind == RG_MASS_SCALED) {
        return RG_MASS_SCALE * entry[kind_of[a][b]] + (1 - RG_MASS_SCALE) * affine[kind_of[a][b]];
    }
    return entry[kind_of[a][b]];
}

double rg_inverse_mass_entry(rg_mass kind, int a, int b) {
    static const double entry[7] = {100, 10, 2.5, 10, 28.75, -6.875, 10};
    static const double affine[7] = {16, -4, 6, -4, 6, 1, -4};
    if (kind == RG_MASS_LUMPED) {
        return a != b ? 0 : a < 4 ? 36 : 27. / 4;
    }
    if (kind == RG_MASS_SCALED) {
        return entry[kind_of[a][b]] / RG_MASS_SCALE + (1 - 1. / RG_MASS_SCALE) * affine[kind_of[a][b]];
    }
    return entry[kind_of[a][b]];
}

void rg_mass_times(rg_mass kind, double mass, const rg_real *v, size_t slot, double out[RG_NODES][3]) {
    for (int a = 0; a < RG_NODES; a++) {
        double sum[3] = {0, 0, 0};
        for (int b = 0; b < RG_NODES; b++) {
            double entry = mass * rg_mass_entry(kind, a, b);
            for (int c = 0; c < 3; c++) {
                sum[c] += entry * v[rg_node_index(slot, b, c)];
            }
        }
        memcpy(out[a], sum, sizeof sum);
    }
}
