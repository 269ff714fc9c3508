#include "partition/material.h"

#include <math.h>
#include <string.h>

#include "base/mem.h"

static void set_young(rg_material *m, double young, double nu) {
    m->lambda = young * nu / ((1 + nu) * (1 - 2 * nu));
    m->mu = young / (2 * (1 + nu));
}

static void set_ceramic(rg_material *m, const rg_material_input *in) {
    rg_deshpande_evans *p = &m->of.deshpande_evans.parameters;
    *p = in->deshpande_evans;
    p->poisson = in->poisson;
    p->density = in->density;
    p->yield_stress = in->parameter[RG_PARAMETER_YIELD_STRESS];
    p->single_pi = in->interaction == RG_INTERACTION_DERIVED;
    m->mu = p->shear;
    m->lambda = 2 * p->shear * p->poisson / (1 - 2 * p->poisson);
}

rg_material rg_material_make(const rg_material_input *in) {
    rg_material m = {.model = in->model, .density = in->density};
    if ((rg_material_inside(m.model) & RG_TAKES_YOUNG) != 0) {
        set_young(&m, in->young, in->poisson);
        memcpy(m.of.parameter, in->parameter, sizeof m.of.parameter);
    } else {
        set_ceramic(&m, in);
    }
    rg_material_prepare(&m, 1); /* no step has been taken; at rest its size does not matter */
    return m;
}

rg_material *rg_materials_of_case(const rg_case *c) {
    rg_material *all = RG_NEW(rg_material, (size_t)c->others + 1);
    for (int i = 0; i <= c->others; i++) {
        all[i] = rg_material_make(rg_case_material(c, i));
    }
    return all;
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
