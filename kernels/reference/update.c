/* Reference mass matrix, time step and kinetic energy. */
#include <math.h>
#include "reference/reference.h"

/* A shape function as a polynomial: terms factor * l_i * l_j, or factor * l_i where j is -1. */
typedef struct {
    int terms;
    double factor[2];
    int i[2], j[2];
} polynomial;

static polynomial shape(int node) {
    if (node < 4)
        return (polynomial){2, {2, -1}, {node, node}, {node, -1}};
    static const int first[6] = {0, 1, 0, 0, 1, 2}, second[6] = {1, 2, 2, 3, 3, 3};
    return (polynomial){1, {4, 0}, {first[node - 4], 0}, {second[node - 4], -1}};
}

static double factorial(int n) {
    return n < 2 ? 1 : n * factorial(n - 1);
}

/* Mean of l_0^a l_1^b l_2^c l_3^d over a tetrahedron: 6 a! b! c! d! / (3 + a + b + c + d)!. */
static double mean_monomial(const int power[4]) {
    double product = 6;
    int sum = 3;
    for (int k = 0; k < 4; k++) {
        product *= factorial(power[k]);
        sum += power[k];
    }
    return product / factorial(sum);
}

static double mean_product(polynomial p, polynomial r) {
    double sum = 0;
    for (int s = 0; s < p.terms; s++)
        for (int t = 0; t < r.terms; t++) {
            int power[4] = {0};
            const int index[4] = {p.i[s], p.j[s], r.i[t], r.j[t]};
            for (int k = 0; k < 4; k++)
                if (index[k] >= 0)
                    power[index[k]]++;
            sum += p.factor[s] * r.factor[t] * mean_monomial(power);
        }
    return sum;
}

/* Value of barycentric coordinate l_k at a node. */
static double linear_value(int node, int k) {
    static const int first[6] = {0, 1, 0, 0, 1, 2}, second[6] = {1, 2, 2, 3, 3, 3};
    return node < 4 ? node == k : 0.5 * ((first[node - 4] == k) + (second[node - 4] == k));
}

/* Q = I (I' M I)^-1 I' over density and volume, I the linear motions: I' M I is the linear element's mass,
 * (1 + delta)/20, its inverse 20 delta - 4. */
static double affine_part(int a, int b) {
    double sum = -4;
    for (int k = 0; k < 4; k++)
        sum += 20 * linear_value(a, k) * linear_value(b, k);
    return sum;
}

/* Mass matrix divided by density and volume. */
static void mass_matrix(rg_mass mass, double m[RG_NODES][RG_NODES]) {
    double full[RG_NODES][RG_NODES];
    for (int a = 0; a < RG_NODES; a++)
        for (int b = 0; b < RG_NODES; b++) {
            full[a][b] = mean_product(shape(a), shape(b));
            m[a][b] = mass == RG_MASS_LUMPED ? (a != b ? 0 : a < 4 ? 1.0 / 36 : 4.0 / 27) : full[a][b];
        }
    for (int a = 0; a < RG_NODES && mass == RG_MASS_SCALED; a++)
        for (int b = 0; b < RG_NODES; b++) {
            double affine = 0;
            for (int i = 0; i < RG_NODES; i++)
                for (int j = 0; j < RG_NODES; j++)
                    affine += full[a][i] * affine_part(i, j) * full[j][b];
            m[a][b] = RG_MASS_SCALE * full[a][b] + (1 - RG_MASS_SCALE) * affine;
        }
}

/* Inverse by Gauss-Jordan elimination; positive definite, so no pivoting. Destroys m. */
static void invert(double m[RG_NODES][RG_NODES], double inv[RG_NODES][RG_NODES]) {
    for (int r = 0; r < RG_NODES; r++)
        for (int c = 0; c < RG_NODES; c++)
            inv[r][c] = r == c;
    for (int k = 0; k < RG_NODES; k++) {
        double pivot = m[k][k];
        for (int c = 0; c < RG_NODES; c++) {
            m[k][c] /= pivot;
            inv[k][c] /= pivot;
        }
        for (int r = 0; r < RG_NODES; r++) {
            double factor = r == k ? 0 : m[r][k];
            for (int c = 0; c < RG_NODES; c++) {
                m[r][c] -= factor * m[k][c];
                inv[r][c] -= factor * inv[k][c];
            }
        }
    }
}

/* Bulk force plus the forces of the interfaces inside the tile, by side; or those of the tile-boundary faces
 * alone. */
static void total_force(const rg_kick_args *args, size_t e, double f[RG_NODES][3]) {
    bool boundary = args->sweep == RG_SWEEP_BOUNDARY;
    for (int a = 0; a < RG_NODES; a++)
        for (int c = 0; c < 3; c++)
            f[a][c] = boundary ? 0 : args->force[rg_node_index(e, a, c)];
    for (int face = 0; face < RG_FACES; face++) {
        int32_t link = args->interface[rg_link_index(e, face)];
        if (link < 0 || (link % 4 >= RG_TILE_FACE) != boundary)
            continue;
        double sign = link % 2 == 1 ? -1 : 1;
        for (int a = 0; a < RG_FNODES; a++)
            for (int c = 0; c < 3; c++)
                f[rg_face_node[face][a]][c] += sign * args->iforce[rg_iforce_index((size_t)link / 4, a, c)];
        bool turns = args->contact == RG_CONTACT_POTENTIAL && args->broken[link / 4] != 0;
        for (int a = 0; turns && a < RG_FNODES; a++)
            for (int c = 0; c < 3; c++)
                f[rg_face_node[face][a]][c] += args->turn[rg_iforce_index((size_t)link / 4, a, c)];
    }
}

void rg_reference_kick(const rg_kick_args *args, size_t begin, size_t end) {
    bool boundary = args->sweep == RG_SWEEP_BOUNDARY;
    double m[RG_NODES][RG_NODES], inv[RG_NODES][RG_NODES];
    mass_matrix(args->mass, m);
    invert(m, inv);
    for (size_t e = begin * RG_LANES; e < end * RG_LANES; e++) {
        double f[RG_NODES][3];
        double mass = args->density * args->geom[rg_geom_index(e, RG_GEOM_VOLUME)];
        total_force(args, e, f);
        for (int a = 0; a < RG_NODES; a++)
            for (int c = 0; c < 3; c++) {
                double acceleration = 0;
                for (int b = 0; b < RG_NODES; b++)
                    acceleration += inv[a][b] * f[b][c] / mass;
                size_t k = rg_node_index(e, a, c);
                if (args->step_velocity)
                    args->step_velocity[k] =
                        (rg_real)((boundary ? args->step_velocity[k] : args->velocity[k]) +
                                  args->dt_now * acceleration);
                args->velocity[k] = (rg_real)(args->velocity[k] + args->dt * acceleration);
            }
    }
}

void rg_reference_drift(const rg_drift_args *args, size_t begin, size_t end) {
    for (size_t k = begin * RG_NODE_BLOCK; k < end * RG_NODE_BLOCK; k++)
        args->u[k] = (rg_real)(args->u[k] + args->dt * args->velocity[k]);
}

void rg_reference_kinetic(const rg_kinetic_args *args, size_t begin, size_t end) {
    double m[RG_NODES][RG_NODES];
    mass_matrix(args->mass, m);
    for (size_t e = begin * RG_LANES; e < end * RG_LANES; e++) {
        double sum = 0;
        for (int a = 0; a < RG_NODES; a++)
            for (int b = 0; b < RG_NODES; b++)
                for (int c = 0; c < 3; c++)
                    sum += m[a][b] * args->velocity[rg_node_index(e, a, c)] *
                           args->velocity[rg_node_index(e, b, c)];
        args->energy[e - begin * RG_LANES] =
            args->density * args->geom[rg_geom_index(e, RG_GEOM_VOLUME)] * sum / 2;
    }
}
