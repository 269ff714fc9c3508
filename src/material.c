#include "material.h"

#include <math.h>
#include <string.h>

static void set_young(rg_material *m, double young, double nu) {
    m->lambda = young * nu / ((1 + nu) * (1 - 2 * nu));
    m->mu = young / (2 * (1 + nu));
}

static void set_ceramic(rg_material *m, const rg_case *c) {
    rg_deshpande_evans *p = &m->of.deshpande_evans.parameters;
    *p = c->material.deshpande_evans;
    p->poisson = c->material.poisson;
    p->density = c->material.density;
    p->yield_stress = c->material.parameter[RG_PARAMETER_YIELD_STRESS];
    p->single_pi = c->material.interaction == RG_INTERACTION_DERIVED;
    m->mu = p->shear;
    m->lambda = 2 * p->shear * p->poisson / (1 - 2 * p->poisson);
}

rg_material rg_material_of_case(const rg_case *c) {
    rg_material m = {.model = c->material.model, .density = c->material.density};
    if ((rg_material_inside(m.model) & RG_TAKES_YOUNG) != 0) {
        set_young(&m, c->material.young, c->material.poisson);
        memcpy(m.of.parameter, c->material.parameter, sizeof m.of.parameter);
    } else {
        set_ceramic(&m, c);
    }
    rg_material_prepare(&m, 1); /* no step has been taken; at rest its size does not matter */
    return m;
}

double rg_material_dilatational(const rg_material *m) {
    return sqrt((m->lambda + 2 * m->mu) / m->density);
}

double rg_material_shear(const rg_material *m) {
    return sqrt(m->mu / m->density);
}

bool rg_material_plastic_wave(const rg_material *m, double *limit, double *speed) {
    if (m->model != RG_MATERIAL_J2) {
        return false;
    }
    const double *given = m->of.parameter, first = given[RG_PARAMETER_YIELD_STRESS];
    double gain = fmax(given[RG_PARAMETER_SATURATION_STRESS] - first, 0);
    double slope = given[RG_PARAMETER_HARDENING] + gain * given[RG_PARAMETER_SATURATION_RATE];
    double tangent = m->mu * slope / (3 * m->mu + slope), bulk = m->lambda + 2 * m->mu / 3;
    *limit = first * (m->lambda + 2 * m->mu) / (2 * m->mu);
    *speed = sqrt((bulk + 4 * tangent / 3) / m->density);
    return true;
}

static unsigned internal_fields(rg_material_model model) {
    unsigned inside = rg_material_inside(model);
    return (inside & RG_HAS_DAMAGE ? RG_FIELD_DAMAGE : 0U) | (inside & RG_HAS_REGIME ? RG_FIELD_REGIME : 0U) |
           (inside & RG_HAS_PLASTIC ? RG_FIELD_PLASTIC : 0U);
}

unsigned rg_material_default_fields(rg_material_model model) {
    unsigned internal = internal_fields(model);
    return RG_FIELDS_COMMON | internal | (internal != 0 ? RG_FIELD_TRIAXIALITY : 0U);
}

unsigned rg_material_possible_fields(rg_material_model model) {
    return RG_FIELDS_COMMON | RG_FIELD_RANK | RG_FIELD_TRIAXIALITY | internal_fields(model);
}
