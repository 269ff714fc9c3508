#include "stressed.h"

#include <math.h>
#include <string.h>

enum { TERMS = 30 }; /* of the exponential: to rounding for strains up to 1 */

static const int place[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};
static const int row[6] = {0, 1, 2, 1, 0, 0}, column[6] = {0, 1, 2, 2, 2, 1};

/* out = exp(y) - 1 of a symmetric tensor. */
static void expm1_of(const double y[6], double out[6]) {
    double term[6];
    memcpy(term, y, sizeof term);
    memcpy(out, y, sizeof term);
    for (int n = 2; n <= TERMS; n++) {
        double next[6];
        for (int k = 0; k < 6; k++) {
            next[k] = 0;
            for (int j = 0; j < 3; j++) {
                next[k] += term[place[row[k]][j]] * y[place[j][column[k]]] / n;
            }
        }
        for (int k = 0; k < 6; k++) {
            term[k] = next[k];
            out[k] += next[k];
        }
    }
}

/* tau' = 2G e' with e = 1/2 log Cp^-1 at F = 1. */
void rg_material_take_stress(const rg_material *m, double stress[6], double history[]) {
    double mean = (stress[0] + stress[1] + stress[2]) / 3, bulk = m->lambda + 2.0 / 3 * m->mu, log_flow[6];
    double *flow = history + RG_J2_FLOW;
    for (int k = 0; k < 6; k++) {
        log_flow[k] = (stress[k] - (k < 3 ? mean : 0)) / m->mu;
        stress[k] = 0;
    }
    if (m->model == RG_MATERIAL_DRUCKER_PRAGER) {
        history[RG_DP_VOLUME] = -mean / bulk;
        flow = history + RG_DP_FLOW;
    } else if (m->model == RG_MATERIAL_JOHNSON_HOLMQUIST) {
        history[RG_JH_BULKING] = -mean;
        flow = history + RG_JH_FLOW;
    } else {
        flow = m->model == RG_MATERIAL_JOHNSON_COOK ? history + RG_JC_FLOW : flow;
        stress[0] = stress[1] = stress[2] = mean;
    }
    expm1_of(log_flow, flow);
}

static void isotropic(double lambda, double mu, double out[6][6]) {
    double young = mu * (3 * lambda + 2 * mu) / (lambda + mu), poisson = lambda / (2 * (lambda + mu));
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) {
            bool normal = i < 3 && j < 3;
            out[i][j] = i != j ? (normal ? -poisson / young : 0) : normal ? 1 / young : 1 / mu;
        }
    }
}

/* By Gauss and Jordan; the stiffness is positive definite. */
static void invert(double a[6][6], double out[6][6]) {
    memset(out, 0, sizeof(double[6][6]));
    for (int k = 0; k < 6; k++) {
        out[k][k] = 1;
    }
    for (int k = 0; k < 6; k++) {
        double pivot = a[k][k];
        for (int j = 0; j < 6; j++) {
            a[k][j] /= pivot;
            out[k][j] /= pivot;
        }
        for (int i = 0; i < 6; i++) {
            double factor = a[i][k];
            for (int j = 0; j < 6 && i != k; j++) {
                a[i][j] -= factor * a[k][j];
                out[i][j] -= factor * out[k][j];
            }
        }
    }
}

void rg_material_compliance(const rg_material *m, double out[6][6]) {
    double lambda = m->lambda, mu = m->mu;
    if (m->model == RG_MATERIAL_ANISOTROPIC) {
        double whole[6][6];
        for (int i = 0, at = 0; i < 6; i++) {
            for (int j = i; j < 6; j++, at++) {
                whole[i][j] = whole[j][i] = m->of.anisotropic.stiffness[at];
            }
        }
        invert(whole, out);
        return;
    }
    if (m->model == RG_MATERIAL_VISCOELASTIC) { /* of what is left in the long run */
        double bulk = lambda + 2.0 / 3 * mu, shear = mu;
        for (int i = 0; i < RG_VE_ELEMENTS; i++) {
            mu -= m->of.parameter[RG_PARAMETER_SHEAR_FRACTION_1 + i] * shear;
            lambda -= m->of.parameter[RG_PARAMETER_BULK_FRACTION_1 + i] * bulk -
                      2.0 / 3 * m->of.parameter[RG_PARAMETER_SHEAR_FRACTION_1 + i] * shear;
        }
    }
    isotropic(lambda, mu, out);
}

double rg_material_least_modulus(const rg_material *m) {
    return m->model == RG_MATERIAL_ANISOTROPIC ? m->of.anisotropic.softest : m->lambda + 2 * m->mu;
}
