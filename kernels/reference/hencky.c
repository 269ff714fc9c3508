/* Reference of the solids of material/hencky.h, by eigenvectors. */
#include "reference/hencky.h"

#include <math.h>
#include <string.h>

#include "reference/reference.h"

/* ---- Tensors ---- */

/* Rotation in the plane (a, b) that takes s[a][b] to zero. */
static void rotate(double s[3][3], double v[3][3], int a, int b) {
    double angle = 0.5 * atan2(2 * s[a][b], s[b][b] - s[a][a]), c = cos(angle), t = sin(angle);
    for (int k = 0; k < 3; k++) {
        double x = s[k][a], y = s[k][b];
        s[k][a] = c * x - t * y;
        s[k][b] = t * x + c * y;
    }
    for (int k = 0; k < 3; k++) {
        double x = s[a][k], y = s[b][k];
        s[a][k] = c * x - t * y;
        s[b][k] = t * x + c * y;
        x = v[k][a];
        y = v[k][b];
        v[k][a] = c * x - t * y;
        v[k][b] = t * x + c * y;
    }
}

void rg_reference_eigen(double s[3][3], double value[3], double v[3][3]) {
    double work[3][3];
    memcpy(work, s, sizeof work);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            v[i][j] = i == j;
    for (int sweep = 0; sweep < 10; sweep++) {
        rotate(work, v, 0, 1);
        rotate(work, v, 0, 2);
        rotate(work, v, 1, 2);
    }
    for (int i = 0; i < 3; i++)
        value[i] = work[i][i];
}

void rg_reference_function(double s[3][3], double (*f)(double), double out[3][3]) {
    double value[3], v[3][3];
    rg_reference_eigen(s, value, v);
    memset(out, 0, 9 * sizeof(double));
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                out[i][j] += f(value[k]) * v[i][k] * v[j][k];
}

static void multiply(double a[3][3], double b[3][3], double out[3][3]) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
}

static void transpose(double a[3][3], double out[3][3]) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[i][j] = a[j][i];
}

/* G S G^T. */
static void push(double G[3][3], double S[3][3], double out[3][3]) {
    double half[3][3], turned[3][3];
    multiply(G, S, half);
    transpose(G, turned);
    multiply(half, turned, out);
}

/* ---- Strain, flow and stress ---- */

static const int row[6] = {0, 1, 2, 1, 0, 0}, column[6] = {0, 1, 2, 2, 2, 1};

static double half_log(double x) {
    return log(x) / 2;
}

double rg_reference_hencky(double F[3][3], const double flow[6], double b[3][3], double e[3][3]) {
    double metric[3][3], square = 0;
    for (int k = 0; k < 6; k++)
        metric[row[k]][column[k]] = metric[column[k]][row[k]] = flow[k] + (row[k] == column[k]);
    push(F, metric, b);
    rg_reference_function(b, half_log, e);
    double third = (e[0][0] + e[1][1] + e[2][2]) / 3;
    for (int i = 0; i < 3; i++) {
        e[i][i] -= third;
        square += rg_reference_dot(e[i], e[i]);
    }
    return sqrt(2.0 / 3 * square);
}

void rg_reference_hencky_flow(double inverse[3][3], double b[3][3], double e[3][3], double part,
                              double flow[6]) {
    double argument[3][3], factor[3][3], relaxed[3][3], metric[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            argument[i][j] = -2 * part * e[i][j];
    rg_reference_function(argument, exp, factor);
    multiply(b, factor, relaxed);
    push(inverse, relaxed, metric);
    for (int k = 0; k < 6; k++)
        flow[k] = (metric[row[k]][column[k]] + metric[column[k]][row[k]]) / 2 - (row[k] == column[k]);
}

void rg_reference_hencky_piola(double mean, double mises, double eb, double e[3][3], double inverse[3][3],
                               double P[3][3]) {
    for (int i = 0; i < 3; i++) {
        double tau[3];
        for (int j = 0; j < 3; j++)
            tau[j] = (i == j) * mean + (eb > 0 ? 2.0 / 3 * mises / eb * e[i][j] : 0);
        for (int j = 0; j < 3; j++)
            P[i][j] = rg_reference_dot(tau, inverse[j]);
    }
}

double rg_reference_hencky_stiffening(double lambda, double mu, double mean, double mises, double eb,
                                      double inverse[3][3]) {
    double norm = 0, modulus = lambda + 2 * mu;
    for (int i = 0; i < 3; i++) {
        double sum = 0;
        for (int j = 0; j < 3; j++)
            sum += fabs(rg_reference_dot(inverse[i], inverse[j]));
        norm = fmax(norm, sum);
    }
    return norm * (1 + (fmax(-mean, 0) + 1.25 * mises + 4.0 / 3 * mu * eb * eb) / modulus);
}
