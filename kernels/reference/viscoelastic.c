/* Reference viscoelastic solid, after the equations of material/viscoelastic.h. */
#include <math.h>
#include "reference/material.h"

static const int row[6] = {0, 1, 2, 1, 0, 0}, column[6] = {0, 1, 2, 2, 2, 1};

/* Shear and first Lame modulus of Maxwell element i. */
static void moduli(const rg_material *m, int i, double *mu, double *lambda) {
    double K = m->lambda + 2 * m->mu / 3;
    *mu = m->of.parameter[RG_PARAMETER_SHEAR_FRACTION_1 + i] * m->mu;
    *lambda = m->of.parameter[RG_PARAMETER_BULK_FRACTION_1 + i] * K - 2 * *mu / 3;
}

static void stress(double mu, double lambda, const double A[6], double S[6]) {
    for (int k = 0; k < 6; k++)
        S[k] = 2 * mu * A[k] + (row[k] == column[k]) * lambda * (A[0] + A[1] + A[2]);
}

static double contract(const double S[6], const double A[6]) {
    double sum = 0;
    for (int k = 0; k < 6; k++)
        sum += (row[k] == column[k] ? 1 : 2) * S[k] * A[k];
    return sum;
}

static void matrix(const double S[6], double out[3][3]) {
    for (int k = 0; k < 6; k++)
        out[row[k]][column[k]] = out[column[k]][row[k]] = S[k];
}

static double row_sum(const double S[6]) {
    double s[3][3], most = -INFINITY;
    matrix(S, s);
    for (int i = 0; i < 3; i++)
        most = fmax(most, s[i][i] + fabs(s[i][(i + 1) % 3]) + fabs(s[i][(i + 2) % 3]));
    return most;
}

/* Element i: adds its stress and stored energy, returns what its dashpot dissipates. */
static double element(const rg_material *m, bool advance, int i, const double gained[6], double A[6],
                      double S[6], double *energy) {
    double mu, lambda, before[6], after[6], sum[6], flow[6], now[6];
    double time = m->of.parameter[RG_PARAMETER_RELAXATION_TIME_1 + i], h = time > 0 ? m->dt / time : 1;
    moduli(m, i, &mu, &lambda);
    stress(mu, lambda, A, before);
    for (int k = 0; k < 6; k++) {
        now[k] = advance ? exp(-h) * A[k] - expm1(-h) / h * gained[k] : A[k] + gained[k];
        flow[k] = gained[k] - (now[k] - A[k]);
    }
    stress(mu, lambda, now, after);
    *energy += contract(after, now) / 2;
    for (int k = 0; k < 6; k++) {
        S[k] += after[k];
        sum[k] = before[k] + after[k];
        if (advance)
            A[k] = now[k];
    }
    return contract(sum, flow) / 2;
}

void rg_reference_point_viscoelastic(const rg_material *m, bool advance, double F[3][3], double history[],
                                     double P[3][3], rg_reference_point *out) {
    rg_material rest = *m;
    double E[6], gained[6], S[6] = {0}, s[3][3], spent = 0, energy = 0;
    for (int i = 0; i < RG_VE_ELEMENTS; i++) {
        double mu, lambda;
        moduli(m, i, &mu, &lambda);
        rest.mu -= mu;
        rest.lambda -= lambda;
    }
    rg_reference_point_neo_hookean(&rest, false, F, NULL, P, out);
    for (int k = 0; k < 6; k++) {
        int i = row[k], j = column[k];
        E[k] = (F[0][i] * F[0][j] + F[1][i] * F[1][j] + F[2][i] * F[2][j] - (i == j)) / 2;
        gained[k] = E[k] - history[RG_VE_STRAIN + k];
    }
    for (int i = 0; i < RG_VE_ELEMENTS; i++)
        spent += element(m, advance, i, gained, history + RG_VE_ELASTIC + 6 * i, S, &energy);
    for (int k = 0; advance && k < 6; k++)
        history[RG_VE_STRAIN + k] = E[k];
    matrix(S, s);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            P[i][j] += F[i][0] * s[0][j] + F[i][1] * s[1][j] + F[i][2] * s[2][j];
    double all = m->lambda + 2 * m->mu, left = rest.lambda + 2 * rest.mu;
    double more = (all - left) * (1 + 2 * row_sum(E)) + fmax(row_sum(S), 0);
    out->stiffening = (left * out->stiffening + more) / all;
    out->energy += energy;
    out->released[RG_RELEASED_PLASTIC] = advance ? spent : 0;
    out->released[RG_RELEASED_DAMAGE] = 0;
    for (int k = 0; k < RG_INTERNAL; k++)
        out->internal[k] = 0;
}
