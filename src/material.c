#include "material.h"

#include <math.h>

static void of_young(rg_material *m, double young, double nu) {
    m->lambda = young * nu / ((1 + nu) * (1 - 2 * nu));
    m->mu = young / (2 * (1 + nu));
}

static void set_neo_hookean(rg_material *m, const rg_case *c) {
    of_young(m, c->material.young, c->material.poisson);
}

static void set_deshpande_evans(rg_material *m, const rg_case *c) {
    rg_deshpande_evans *p = &m->of.deshpande_evans.parameters;
    *p = c->material.deshpande_evans;
    p->poisson = c->material.poisson;
    p->density = c->material.density;
    p->single_pi = c->material.interaction == RG_INTERACTION_DERIVED;
    m->mu = p->shear;
    m->lambda = 2 * p->shear * p->poisson / (1 - 2 * p->poisson);
}

rg_material rg_material_of_case(const rg_case *c) {
#define SET(name, NAME, word, history, inside) [RG_MATERIAL_##NAME] = set_##name,
    static void (*const set[])(rg_material *, const rg_case *) = {RG_MATERIALS(SET)};
    rg_material m = {.model = c->material.model, .density = c->material.density};
    set[m.model](&m, c);
    rg_material_prepare(&m, 1); /* no step has been taken; at rest its size does not matter */
    return m;
}

double rg_material_dilatational(const rg_material *m) {
    return sqrt((m->lambda + 2 * m->mu) / m->density);
}

double rg_material_shear(const rg_material *m) {
    return sqrt(m->mu / m->density);
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
