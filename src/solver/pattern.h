/* What it takes to prescribe the velocities of some nodes of an element: it depends on which alone. For the
 * mass M/(rho V), c the constrained nodes and f the free ones:
 *     impulse[c][c] = (Minv_cc)^-1,   follow[f][c] = Minv_fc (Minv_cc)^-1. */
#ifndef RG_PATTERN_H
#define RG_PATTERN_H

#include "layout.h"
#include "modes.h"

typedef struct {
    int constrained;
    int8_t node[RG_NODES]; /* the constrained ones, then the free ones */
    double impulse[RG_NODES][RG_NODES], follow[RG_NODES][RG_NODES];
} rg_pattern;

/* Those that were asked for, by the bits of their nodes. Start from {mass}. */
typedef struct {
    rg_mass mass;
    rg_pattern *of[1 << RG_NODES];
} rg_patterns;

/* Not for threads. */
const rg_pattern *rg_patterns_get(rg_patterns *all, unsigned nodes);

void rg_patterns_clear(rg_patterns *all);

#endif
