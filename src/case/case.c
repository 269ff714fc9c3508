/* What follows from the values of a case. */
#include "case/case.h"

#include <math.h>
#include <string.h>

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

static bool ends_before(const rg_boundary *a, const rg_boundary *b) {
    return a->until > 0 && a->until <= b->from;
}

bool rg_boundaries_meet(const rg_boundary *a, const rg_boundary *b) {
    return !ends_before(a, b) && !ends_before(b, a);
}

bool rg_case_opens(const rg_case *c) {
    for (int i = 0; i < c->interface.sets; i++) {
        if (c->interface.set[i].opens_at > 0) {
            return true;
        }
    }
    return false;
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

/* Of all materials. */
static unsigned internal_fields(const rg_case *c) {
    unsigned inside = 0;
    for (int i = 0; i <= c->others; i++) {
        inside |= rg_material_inside(rg_case_material(c, i)->model);
    }
    return (inside & RG_HAS_DAMAGE ? RG_FIELD_DAMAGE : 0U) | (inside & RG_HAS_REGIME ? RG_FIELD_REGIME : 0U) |
           (inside & RG_HAS_PLASTIC ? RG_FIELD_PLASTIC : 0U);
}

unsigned rg_case_default_fields(const rg_case *c) {
    unsigned internal = internal_fields(c);
    return RG_FIELDS_COMMON | internal | (internal != 0 ? RG_FIELD_TRIAXIALITY : 0U) |
           (c->others > 0 ? RG_FIELD_MATERIAL : 0U);
}

unsigned rg_case_possible_fields(const rg_case *c) {
    return RG_FIELDS_COMMON | RG_FIELD_RANK | RG_FIELD_TRIAXIALITY | RG_FIELD_MATERIAL | internal_fields(c);
}
