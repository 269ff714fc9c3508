/* Paths of one point of a material by its scalar reference, for point.py, which compiles this file with
 * kernels/reference/. */
#include "point.h"

#include <math.h>
#include <string.h>

#include "reference/material.h"
#include "reference/reference.h"

enum { HISTORY = 24, HALVES = 60, SWEEPS = 40 };
static const double nearest = 1e-4, farthest = 4; /* of a free logarithm of a stretch from the last one */

#define KEY(NAME, key, unit, range, models, meaning) [RG_PARAMETER_##NAME] = (key),
const char *const point_key[] = {RG_MATERIAL_PARAMETERS(KEY) NULL};

#define LAW(name, NAME, word, meaning, history, inside) [RG_MATERIAL_##NAME] = rg_reference_point_##name,
static rg_reference_point_law *const laws[] = {RG_MATERIALS(LAW)};

const int point_parameters = RG_PARAMETERS, point_stiffness = RG_STIFFNESS, point_values = POINT_VALUES;

typedef struct {
    rg_material m;
    const double (*axis)[3];
    double history[HISTORY], P[3][3];
    rg_reference_point out;
} point;

int point_model(const char *word) {
    for (int m = 0; m < RG_MATERIAL_MODELS; m++) {
        if (strcmp(rg_material_word((rg_material_model)m), word) == 0) {
            return m;
        }
    }
    return -1;
}

static rg_material solid_of(int model, const double elastic[3], const double constants[]) {
    rg_material m = {
        .model = (rg_material_model)model, .lambda = elastic[0], .mu = elastic[1], .density = elastic[2]};
    if (m.model == RG_MATERIAL_DESHPANDE_EVANS) {
        m.of.deshpande_evans.parameters = rg_deshpande_evans_alumina();
    } else if (m.model == RG_MATERIAL_ANISOTROPIC) {
        memcpy(m.of.anisotropic.stiffness, constants, sizeof m.of.anisotropic.stiffness);
    } else {
        memcpy(m.of.parameter, constants, sizeof m.of.parameter);
    }
    return m;
}

void point_stress(int model, const double elastic[3], const double constants[], const double F[9],
                  double P[9]) {
    rg_material m = solid_of(model, elastic, constants);
    double at[3][3], stress[3][3], history[HISTORY] = {0};
    rg_reference_point out;
    rg_material_prepare(&m, 1);
    memcpy(at, F, sizeof at);
    laws[model](&m, false, at, history, stress, &out);
    memcpy(P, stress, sizeof stress);
}

/* A step that ends at these stretches, on a copy of the history where it is not `kept`; Cauchy stress along
 * the axes (Pa). */
static void step(point *p, const double stretch[3], bool kept, double cauchy[3]) {
    double F[3][3], history[HISTORY], volume = stretch[0] * stretch[1] * stretch[2];
    memcpy(history, p->history, sizeof history);
    for (int k = 0; k < 9; k++) {
        F[k / 3][k % 3] = 0;
        for (int a = 0; a < 3; a++) {
            F[k / 3][k % 3] += stretch[a] * p->axis[a][k / 3] * p->axis[a][k % 3];
        }
    }
    laws[p->m.model](&p->m, true, F, kept ? p->history : history, p->P, &p->out);
    for (int a = 0; a < 3; a++) {
        double traction[3];
        for (int i = 0; i < 3; i++) {
            traction[i] = rg_reference_dot(p->P[i], p->axis[a]);
        }
        cauchy[a] = rg_reference_dot(traction, p->axis[a]) * stretch[a] / volume;
    }
}

/* Stress along axis 0 or 1, less what it should be, with log stretches `x` of it, and of both if alike. */
static double missing(point *p, double stretch[3], int axis, point_free free, double x, double side) {
    double cauchy[3];
    stretch[axis] = exp(x);
    if (free == POINT_ALIKE) {
        stretch[1] = stretch[0];
    }
    step(p, stretch, false, cauchy);
    return cauchy[axis] + side;
}

/* The root nearest to where the axis is, by doubled steps and bisection. */
static bool free_axis(point *p, double stretch[3], int axis, point_free free, double side) {
    double from = log(stretch[axis]), low = from, high = from, reach = nearest;
    const double value = missing(p, stretch, axis, free, from, side);
    const bool above = value >= 0; /* what is crushed may bear nothing over a range */
    if (value == 0) {
        return true;
    }
    do {
        if (reach > farthest) {
            return false;
        }
        *(above ? &high : &low) = above ? low : high;
        *(above ? &low : &high) = above ? from - reach : from + reach;
        reach *= 2;
    } while ((missing(p, stretch, axis, free, above ? low : high, side) >= 0) == above);
    for (int n = 0; n < HALVES; n++) {
        double middle = 0.5 * (low + high);
        *(missing(p, stretch, axis, free, middle, side) >= 0 ? &high : &low) = middle;
    }
    missing(p, stretch, axis, free, 0.5 * (low + high), side);
    return true;
}

int point_walk(int model, const double elastic[3], const double constants[], const double axes[9], int free,
               int steps, const point_step way[], double found[][POINT_VALUES]) {
    point p = {.m = solid_of(model, elastic, constants), .axis = (const double(*)[3])axes};
    double across[2] = {1, 1}, spent[RG_RELEASED] = {0};
    for (int n = 0; n < steps; n++) {
        double stretch[3], cauchy[3];
        memcpy(stretch, way[n].stretch, sizeof stretch);
        rg_material_prepare(&p.m, way[n].duration);
        if (free != POINT_HELD) {
            memcpy(stretch, across, sizeof across);
        }
        for (int sweep = 0; sweep < (free == POINT_EACH ? SWEEPS : free == POINT_ALIKE); sweep++) {
            for (int axis = 0; axis < (free == POINT_EACH ? 2 : 1); axis++) {
                if (!free_axis(&p, stretch, axis, (point_free)free, way[n].pressure)) {
                    return n;
                }
            }
        }
        memcpy(across, stretch, sizeof across);
        step(&p, stretch, true, cauchy);
        memcpy(found[n], cauchy, sizeof cauchy);
        memcpy(found[n] + 3, stretch, sizeof stretch);
        found[n][POINT_ENERGY] = p.out.energy;
        for (int k = 0; k < RG_RELEASED; k++) {
            found[n][POINT_SPENT + k] = spent[k] += p.out.released[k];
        }
        memcpy(found[n] + POINT_INSIDE, p.out.internal, sizeof p.out.internal);
    }
    return steps;
}
