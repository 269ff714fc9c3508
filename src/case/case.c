/* What follows from the values of a case. */
#include "case/case.h"

#include <math.h>
#include <string.h>

#include "library.h"

bool rg_boundary_damps(const rg_boundary *b) {
    return b->absorbing || b->dashpot > 0;
}

bool rg_boundary_is_along_line(const rg_boundary *b) {
    return !rg_boundary_damps(b) &&
           (b->prescribed == RG_PRESCRIBED_VELOCITY || b->prescribed == RG_PRESCRIBED_DISPLACEMENT);
}

bool rg_boundary_has_component(const rg_boundary *b) {
    const double *d = b->direction;
    return rg_boundary_is_along_line(b) && !(fabs(d[0]) + fabs(d[1]) + fabs(d[2]) > 0);
}

bool rg_boundary_is_placed(const rg_boundary *b) {
    return !rg_boundary_damps(b) &&
           (b->prescribed == RG_PRESCRIBED_DISPLACEMENT || b->prescribed == RG_PRESCRIBED_ANGLE);
}

/* Of a sphere or a cylinder of a density. */
static double volume_of(const rg_body_input *b) {
    const double pi = acos(-1.0);
    bool sphere = b->shape == RG_SHAPE_SPHERE;
    return (sphere ? 4 * pi / 3 * b->radius : pi * b->length) * b->radius * b->radius;
}

double rg_body_mass(const rg_body_input *b) {
    return b->density > 0 ? b->density * volume_of(b) : b->mass;
}

void rg_body_inertia(const rg_body_input *b, double inertia[6]) {
    static const int first[6] = {0, 1, 2, 1, 0, 0}, second[6] = {0, 1, 2, 2, 2, 1};
    double r2 = b->radius * b->radius, mass = rg_body_mass(b), length2 = 0;
    bool sphere = b->shape == RG_SHAPE_SPHERE;
    double across = mass * (sphere ? 0.4 * r2 : 0.25 * r2 + b->length * b->length / 12);
    double along = mass * (sphere ? 0.4 : 0.5) * r2;
    for (int c = 0; c < 3; c++) {
        length2 += b->axis[c] * b->axis[c];
    }
    for (int k = 0; k < 6; k++) {
        double axes = length2 > 0 ? b->axis[first[k]] * b->axis[second[k]] / length2 : 0;
        double made = across * (first[k] == second[k]) + (along - across) * axes;
        inertia[k] = b->density > 0 ? made : b->inertia[k];
    }
}

bool rg_body_spins(const rg_body_input *b) {
    return b->spin[0] != NULL || b->spin[1] != NULL || b->spin[2] != NULL;
}

bool rg_body_has_inertia(const rg_body_input *b) {
    return b->density > 0 || b->inertia[0] > 0;
}

bool rg_body_is_tied(const rg_body_input *b) {
    return b->ties > 0 || b->tied_where != NULL;
}

bool rg_case_joins(const rg_case *c) {
    bool joins = false;
    for (int i = 0; i < c->bodies; i++) {
        joins = joins || c->body[i].tied_from > 0;
    }
    return joins;
}

bool rg_body_turns(const rg_body_input *b) {
    bool central = b->shape == RG_SHAPE_SPHERE && !rg_body_is_tied(b);
    return rg_body_spins(b) || (b->motion == RG_MOTION_FREE && rg_body_has_inertia(b) && !central);
}

bool rg_load_is_inside(const rg_load_input *load) {
    return load->kind == RG_LOAD_ACCELERATION || load->kind == RG_LOAD_CENTRIFUGAL;
}

static bool ends_before(const rg_boundary *a, const rg_boundary *b) {
    return a->until > 0 && a->until <= b->from;
}

bool rg_boundaries_meet(const rg_boundary *a, const rg_boundary *b) {
    return !ends_before(a, b) && !ends_before(b, a);
}

bool rg_initial_has_stress(const rg_initial *is) {
    bool has = false;
    for (int k = 0; k < 6; k++) {
        has = has || is->stress[k] != NULL;
    }
    return has;
}

bool rg_material_axes_vary(const rg_material_input *in) {
    const rg_anisotropic_input *a = &in->anisotropic;
    return in->model == RG_MATERIAL_ANISOTROPIC &&
           (a->field != NULL || a->angle[0] != NULL || a->angle[1] != NULL || a->angle[2] != NULL);
}

bool rg_case_has_stress(const rg_case *c) {
    bool has = c->stress_of.run != NULL || rg_initial_has_stress(&c->initial);
    for (int i = 0; i < c->initial_sets; i++) {
        has = has || rg_initial_has_stress(&c->initial_set[i].is);
    }
    return has;
}

bool rg_case_opens(const rg_case *c) {
    for (int i = 0; i < c->interface.sets; i++) {
        if (c->interface.set[i].opens_at > 0) {
            return true;
        }
    }
    return false;
}

bool rg_case_rubs(const rg_case *c) {
    bool rubs = c->contact.static_friction > 0;
    for (int i = 0; i < c->contact.pairs; i++) {
        rubs = rubs || fmax(c->contact.pair[i].friction, c->contact.pair[i].static_friction) > 0;
    }
    return c->contact.model == RG_CONTACT_GENERAL && rubs;
}

bool rg_case_heats(const rg_case *c) {
    return rg_case_rubs(c) || (c->contact.model == RG_CONTACT_GENERAL && c->contact.damping > 0);
}

bool rg_face_set_is_any(const rg_face_set *set) {
    return set->names == 1 && strcmp(set->between[0], "any") == 0;
}

const rg_material_input *rg_case_material(const rg_case *c, int i) {
    return i == 0 ? &c->material : &c->other[i - 1].is;
}

const char *rg_case_material_name(const rg_case *c, int i) {
    const char *name = rg_case_material(c, i)->name;
    return name != NULL ? name : "material";
}

int rg_case_find_material(const rg_case *c, const char *name) {
    for (int i = 0; i <= c->others; i++) {
        if (strcmp(rg_case_material_name(c, i), name) == 0) {
            return i;
        }
    }
    return -1;
}

int rg_input_history(const rg_material_input *in) {
    return in->model == RG_MATERIAL_USER ? in->user.is.library->history : rg_material_history(in->model);
}

unsigned rg_input_inside(const rg_material_input *in) {
    return in->model == RG_MATERIAL_USER ? in->user.is.library->facts->inside : rg_material_inside(in->model);
}

/* Of all materials. */
static unsigned internal_fields(const rg_case *c) {
    unsigned inside = 0;
    for (int i = 0; i <= c->others; i++) {
        inside |= rg_input_inside(rg_case_material(c, i));
    }
    return (inside & RG_HAS_DAMAGE ? RG_FIELD_DAMAGE : 0U) | (inside & RG_HAS_REGIME ? RG_FIELD_REGIME : 0U) |
           (inside & RG_HAS_PLASTIC ? RG_FIELD_PLASTIC : 0U) |
           (inside & RG_HAS_VOLUME ? RG_FIELD_VOLUME : 0U) |
           (inside & RG_HAS_BULKING ? RG_FIELD_BULKING : 0U) |
           (inside & RG_HAS_TEMPERATURE || c->temperature.value != NULL ? RG_FIELD_TEMPERATURE : 0U);
}

static unsigned contact_fields(const rg_case *c) {
    return c->contact.model == RG_CONTACT_GENERAL ? RG_FIELD_CONTACT : 0U;
}

unsigned rg_case_default_fields(const rg_case *c) {
    unsigned internal = internal_fields(c);
    return RG_FIELDS_COMMON | internal |
           ((internal & ~(unsigned)RG_FIELD_TEMPERATURE) != 0 ? RG_FIELD_TRIAXIALITY : 0U) |
           (c->others > 0 ? RG_FIELD_MATERIAL : 0U) | contact_fields(c);
}

unsigned rg_case_possible_fields(const rg_case *c) {
    return RG_FIELDS_COMMON | RG_FIELD_RANK | RG_FIELD_TRIAXIALITY | RG_FIELD_MATERIAL | internal_fields(c) |
           contact_fields(c);
}
