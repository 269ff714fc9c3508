#include "solver/pattern.h"

#include "base/mem.h"
#include "domain/element.h"

/* Inverts the leading n x n part of a symmetric positive definite matrix (Gauss-Jordan, no pivoting needed).
 */
static void invert(int n, double a[RG_NODES][RG_NODES], double inverse[RG_NODES][RG_NODES]) {
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            inverse[i][j] = i == j;
        }
    }
    for (int k = 0; k < n; k++) {
        double pivot = a[k][k];
        for (int j = 0; j < n; j++) {
            a[k][j] /= pivot;
            inverse[k][j] /= pivot;
        }
        for (int i = 0; i < n; i++) {
            double factor = a[i][k];
            for (int j = 0; i != k && j < n; j++) {
                a[i][j] -= factor * a[k][j];
                inverse[i][j] -= factor * inverse[k][j];
            }
        }
    }
}

static rg_pattern *make(rg_mass mass, unsigned nodes) {
    rg_pattern *p = RG_NEW(rg_pattern, 1);
    int n = 0;
    for (int pass = 1; pass >= 0; pass--) {
        for (int8_t a = 0; a < RG_NODES; a++) {
            if ((int)(nodes >> a & 1) == pass) {
                p->node[n++] = a;
            }
        }
        p->constrained = pass == 1 ? n : p->constrained;
    }
    double block[RG_NODES][RG_NODES];
    for (int i = 0; i < p->constrained; i++) {
        for (int j = 0; j < p->constrained; j++) {
            block[i][j] = rg_inverse_mass_entry(mass, p->node[i], p->node[j]);
        }
    }
    invert(p->constrained, block, p->impulse);
    for (int f = p->constrained; f < RG_NODES; f++) {
        for (int i = 0; i < p->constrained; i++) {
            for (int j = 0; j < p->constrained; j++) {
                p->follow[f][i] += rg_inverse_mass_entry(mass, p->node[f], p->node[j]) * p->impulse[j][i];
            }
        }
    }
    return p;
}

const rg_pattern *rg_patterns_get(rg_patterns *all, unsigned nodes) {
    if (all->of[nodes] == NULL) {
        all->of[nodes] = make(all->mass, nodes);
    }
    return all->of[nodes];
}

void rg_patterns_clear(rg_patterns *all) {
    for (size_t i = 0; i < sizeof all->of / sizeof *all->of; i++) {
        rg_free(all->of[i]);
        all->of[i] = NULL;
    }
}
