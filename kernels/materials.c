#include "materials.h"

#include <math.h>

#include "library.h"

const char *rg_material_word(rg_material_model model) {
#define WORD(name, NAME, word, meaning, history, inside) [RG_MATERIAL_##NAME] = (word),
    static const char *const words[] = {RG_MATERIALS(WORD)[RG_MATERIAL_USER] = "user"};
    return words[model];
}

int rg_material_history(rg_material_model model) {
#define HISTORY(name, NAME, word, meaning, history, inside) [RG_MATERIAL_##NAME] = (history),
    static const int values[] = {RG_MATERIALS(HISTORY)};
    return values[model];
}

int rg_material_values(const rg_material *m) {
    return m->model == RG_MATERIAL_USER ? m->of.user.library->history : rg_material_history(m->model);
}

unsigned rg_material_inside(rg_material_model model) {
#define INSIDE(name, NAME, word, meaning, history, inside) [RG_MATERIAL_##NAME] = (inside),
    static const unsigned bits[] = {RG_MATERIALS(INSIDE)};
    return bits[model];
}

unsigned rg_material_has(const rg_material *m) {
    return m->model == RG_MATERIAL_USER ? m->of.user.library->facts->inside : rg_material_inside(m->model);
}

int rg_material_exists(rg_material_model model) {
#define EXISTS(name, NAME, word, meaning, history, inside) [RG_MATERIAL_##NAME] = 1,
    static const int here[] = {RG_MATERIALS_HERE(EXISTS)[RG_MATERIAL_USER] = 1};
    return here[model];
}

static const double degree = 0.017453292519943295769;

/* A cone through the compressive meridian of a Mohr-Coulomb solid: q = 6 (c cos phi + p sin phi)/(3 - sin
 * phi). */
static double slope_of(double angle) {
    return 6 * sin(angle) / (3 - sin(angle));
}

double rg_dp_strength(const double parameter[]) {
    double phi = parameter[RG_PARAMETER_FRICTION_ANGLE] * degree;
    return 6 * parameter[RG_PARAMETER_COHESION] * cos(phi) / (3 - sin(phi));
}

/* n = (1, -slope) and g = (1, -dilation) in (q, p) make an angle w in the elastic metric, 3G and K: the
 * tangent D - (Dg)(Dn)/(n.Dg) has a symmetric part of at most (1 + (1/cos w - 1)/2) D. */
static rg_dp_cone cone_of(const rg_material *m) {
    const double *given = m->of.parameter;
    const double bulk = m->lambda + 2.0 / 3 * m->mu, shear = 3 * m->mu;
    double a = slope_of(given[RG_PARAMETER_FRICTION_ANGLE] * degree);
    double b = slope_of(given[RG_PARAMETER_DILATION_ANGLE] * degree);
    double size = sqrt((shear + a * a * bulk) * (shear + b * b * bulk));
    return (rg_dp_cone){
        .strength = rg_dp_strength(given),
        .slope = a,
        .dilation = b,
        .excess = 0.5 * (size / (shear + a * b * bulk) - 1),
    };
}

/* The first x at which the dense solid bears so much; not a number if there is none up to 1. */
static double dense_at(const double parameter[], double pressure) {
    const double *k = parameter;
    double step = 1e-3, low = 0, high = 0;
    for (int n = 0; n < 1000 && high == 0; n++) {
        double x = (n + 1) * step;
        double p = (k[RG_PARAMETER_BULK_1] + (k[RG_PARAMETER_BULK_2] + k[RG_PARAMETER_BULK_3] * x) * x) * x;
        *(p < pressure ? &low : &high) = x;
    }
    for (int n = 0; n < 60 && high > 0; n++) {
        double x = 0.5 * (low + high);
        double p = (k[RG_PARAMETER_BULK_1] + (k[RG_PARAMETER_BULK_2] + k[RG_PARAMETER_BULK_3] * x) * x) * x;
        *(p < pressure ? &low : &high) = x;
    }
    return high > 0 ? high : NAN;
}

rg_hjc_pores rg_hjc_pores_of(const double parameter[], double bulk) {
    double crush = parameter[RG_PARAMETER_CRUSH_PRESSURE], lock = parameter[RG_PARAMETER_LOCK_PRESSURE];
    double strain = parameter[RG_PARAMETER_LOCK_STRAIN];
    double range = strain + (1 + strain) * dense_at(parameter, lock) - crush / bulk;
    return (rg_hjc_pores){crush / bulk, range, (lock - crush) / range};
}

void rg_material_prepare(rg_material *m, double dt) {
    m->dt = dt;
    if (m->model == RG_MATERIAL_DESHPANDE_EVANS) {
        m->of.deshpande_evans.constants = rg_de_prepare(&m->of.deshpande_evans.parameters, dt);
    } else if (m->model == RG_MATERIAL_DRUCKER_PRAGER) {
        m->of.drucker_prager.cone = cone_of(m);
    } else if (m->model == RG_MATERIAL_HOLMQUIST_JOHNSON_COOK) {
        m->of.holmquist_johnson_cook.pores = rg_hjc_pores_of(m->of.parameter, m->lambda + 2.0 / 3 * m->mu);
    }
}
