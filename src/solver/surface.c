#include "solver/surface.h"

#include <math.h>

#include "base/vector.h"
#include "domain/element.h"
#include "quadrature.h"

/* Shape functions of the six-node triangle: corners l (2 l - 1), mid-edges 4 l l, in the order 01 12 02. */
static void make_rule(rg_surface *s) {
    for (int q = 0; q < RG_POINTS; q++) {
        double p = q < 3 ? RG_TRI_P0 : RG_TRI_P1, l[3] = {p, p, p}, *N = s->shape[q];
        l[q % 3] = 1 - 2 * p;
        s->weight[q] = q < 3 ? RG_TRI_W0 : RG_TRI_W1;
        for (int i = 0; i < 3; i++) {
            N[i] = l[i] * (2 * l[i] - 1);
        }
        N[3] = 4 * l[0] * l[1];
        N[4] = 4 * l[1] * l[2];
        N[5] = 4 * l[0] * l[2];
        for (int k = 1; k < 3; k++) { /* l_k grows, l_0 falls */
            double *slope = s->slope[q][k - 1];
            slope[0] = 1 - 4 * l[0];
            slope[k] = 4 * l[k] - 1;
            slope[3] = 4 * (k == 1 ? l[0] - l[1] : -l[1]);
            slope[4] = 4 * (k == 1 ? l[2] : l[1]);
            slope[5] = 4 * (k == 2 ? l[0] - l[2] : -l[2]);
        }
    }
}

rg_surface rg_surface_make(const rg_domain *d, const rg_material *m, rg_mass mass) {
    rg_surface s = {.domain = d, .material = m};
    make_rule(&s);
    for (int i = 0; i < RG_NODES * RG_NODES; i++) {
        s.inverse_mass[i / RG_NODES][i % RG_NODES] = rg_inverse_mass_entry(mass, i / RG_NODES, i % RG_NODES);
    }
    return s;
}

void rg_surface_place(const rg_surface *s, size_t slot, int face, const rg_real *u, double x[RG_FNODES][3]) {
    const int *node = rg_face_node[face];
    for (int a = 0; a < RG_FNODES; a++) {
        rg_node_position(s->domain->corner + 12 * slot, node[a], x[a]);
        for (int c = 0; u != NULL && c < 3; c++) {
            x[a][c] += u[rg_node_index(slot, node[a], c)];
        }
    }
}

void rg_surface_at(const rg_surface *s, int q, double value[RG_FNODES][3], double out[3]) {
    out[0] = out[1] = out[2] = 0;
    for (int a = 0; a < RG_FNODES; a++) {
        for (int c = 0; c < 3; c++) {
            out[c] += s->shape[q][a] * value[a][c];
        }
    }
}

void rg_surface_push(const rg_surface *s, size_t slot, int face, double force[RG_FNODES][3],
                     const rg_push *push) {
    double mass = rg_element_mass(s->domain, s->material, slot);
    for (int n = 0; n < RG_NODES; n++) {
        for (int c = 0; c < 3; c++) {
            double a = 0;
            for (int k = 0; k < RG_FNODES; k++) {
                a += s->inverse_mass[n][rg_face_node[face][k]] * force[k][c];
            }
            size_t at = rg_node_index(slot, n, c);
            push->velocity[at] = (rg_real)(push->velocity[at] + push->dt * a / mass);
            if (push->step_velocity != NULL) {
                push->step_velocity[at] = (rg_real)(push->step_velocity[at] + push->dt_now * a / mass);
            }
        }
    }
}

/* By power iteration, from a vector that is no eigenvector. */
static double largest_eigenvalue(double matrix[RG_FNODES][RG_FNODES]) {
    enum { ITERATIONS = 200 };
    double x[RG_FNODES] = {1, 2, 3, 5, 7, 11}, largest = 0;
    for (int k = 0; k < ITERATIONS; k++) {
        double y[RG_FNODES] = {0};
        largest = 0;
        for (int i = 0; i < RG_FNODES * RG_FNODES; i++) {
            y[i / RG_FNODES] += matrix[i / RG_FNODES][i % RG_FNODES] * x[i % RG_FNODES];
        }
        for (int a = 0; a < RG_FNODES; a++) {
            largest = fmax(largest, fabs(y[a]));
        }
        for (int a = 0; a < RG_FNODES; a++) {
            x[a] = y[a] / largest;
        }
    }
    return largest;
}

/* c += a b, or a b^T. */
static void add_product(double c[RG_FNODES][RG_FNODES], double a[RG_FNODES][RG_FNODES],
                        double b[RG_FNODES][RG_FNODES], bool transposed) {
    for (int n = 0; n < RG_FNODES * RG_FNODES * RG_FNODES; n++) {
        int i = n / RG_FNODES / RG_FNODES, j = n / RG_FNODES % RG_FNODES, k = n % RG_FNODES;
        c[i][j] += a[i][k] * (transposed ? b[j][k] : b[k][j]);
    }
}

double rg_surface_spring_value(const rg_surface *s) {
    double matrix[RG_FNODES][RG_FNODES] = {{0}};
    for (int i = 0; i < RG_FNODES * RG_FNODES * RG_FNODES * RG_POINTS; i++) {
        int q = i % RG_POINTS, k = i / RG_POINTS, a = k % RG_FNODES, b = k / RG_FNODES % RG_FNODES,
            c = k / RG_FNODES / RG_FNODES;
        matrix[a][b] += s->inverse_mass[rg_face_node[0][a]][rg_face_node[0][c]] * s->weight[q] *
                        s->shape[q][c] * s->shape[q][b];
    }
    return largest_eigenvalue(matrix);
}

double rg_surface_follower_value(const rg_surface *s) {
    double G[RG_FNODES][RG_FNODES] = {{0}}, B[RG_FNODES][RG_FNODES], half[2][RG_FNODES][RG_FNODES] = {{{0}}},
           square[RG_FNODES][RG_FNODES] = {{0}};
    for (int i = 0; i < RG_FNODES * RG_FNODES; i++) {
        int a = i / RG_FNODES, b = i % RG_FNODES;
        B[a][b] = s->inverse_mass[rg_face_node[0][a]][rg_face_node[0][b]];
        for (int q = 0; q < RG_POINTS; q++) {
            G[a][b] += s->weight[q] * s->shape[q][a] * s->slope[q][0][b];
        }
    }
    add_product(half[0], G, B, false);
    add_product(half[1], half[0], G, true);
    add_product(square, half[1], B, false);
    return sqrt(largest_eigenvalue(square));
}
