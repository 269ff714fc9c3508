#include "solver/limits.h"

#include <string.h>

#include "base/error.h"
#include "base/first_bad.h"
#include "base/mem.h"
#include "quadrature.h"
#include "solver/law.h"
#include "solver/step.h"
#include "solver/stepper.h"
#include "solver/tile.h"

/* A step so long that no rate counts; and one in which what goes on in time stands still (s). */
static const double slow = 1e9, at_once = 1e-15;

/* Values of a point's history that grow where it flows or its pores close, and nowhere else: the first ones;
 * of a user's material all, as nothing is known of them. */
static int flow_values(const rg_material *m) {
    switch (m->model) {
    case RG_MATERIAL_J2:
    case RG_MATERIAL_JOHNSON_COOK:
    case RG_MATERIAL_JOHNSON_HOLMQUIST:
        return 1;
    case RG_MATERIAL_HOLMQUIST_JOHNSON_COOK:
        return RG_HJC_CLOSED + 1;
    case RG_MATERIAL_DRUCKER_PRAGER:
        return RG_DP_RISE + 1;
    case RG_MATERIAL_USER:
        return rg_material_values(m);
    default:
        return 0;
    }
}

static bool any_flows(const rg_model *m) {
    bool any = false;
    for (int i = 0; i < m->materials; i++) {
        any = any || flow_values(&m->material[i]) > 0;
    }
    return any;
}

static void note_flow(const rg_solver *s, const rg_real *before, size_t slot, rg_first_bad *where) {
    const rg_domain *d = s->domain;
    const rg_material *m = &s->model->material[d->material[slot / RG_LANES]];
    size_t first = slot / RG_LANES * s->model->history_stride + slot % RG_LANES;
    for (int g = 0; g < RG_GAUSS; g++) {
        for (int k = 0; k < flow_values(m); k++) {
            size_t at = first + (size_t)(g * rg_material_values(m) + k) * RG_LANES;
            if (s->history[at] != before[at]) {
                rg_first_bad_note(where, d->id[slot], d->corner + 12 * slot, 0);
            }
        }
    }
}

/* A step of all histories, which then are as they were. */
static void try_step(rg_solver *s, rg_first_bad *where) {
    size_t length = s->domain->blocks * s->model->history_stride;
    size_t heated = s->thermal == NULL ? 0 : s->domain->blocks * RG_THERMAL_BLOCK;
    rg_real *before = RG_NEW(rg_real, length + 1), *thermal = RG_NEW(rg_real, heated + 1);
    memcpy(before, s->history, length * sizeof *before);
    if (heated > 0) {
        memcpy(thermal, s->thermal, heated * sizeof *thermal);
    }
    for (int m = 0; m < s->model->materials; m++) {
        rg_material *material = &s->stepper->material[m];
        rg_material_prepare(material, flow_values(material) > 0 ? slow : at_once);
    }
    rg_solver_flow(s);
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        if (s->domain->id[slot] >= 0) {
            note_flow(s, before, slot, where);
        }
    }
    memcpy(s->history, before, length * sizeof *before);
    if (heated > 0) {
        memcpy(s->thermal, thermal, heated * sizeof *thermal);
    }
    memcpy(s->stepper->material, s->model->material,
           (size_t)s->model->materials * sizeof *s->stepper->material);
    rg_free(before);
    rg_free(thermal);
}

void rg_limits_refuse(rg_solver *s, const char *what) {
    rg_first_bad where = {.which = RG_NOWHERE};
    if (!any_flows(s->model)) {
        return;
    }
    try_step(s, &where);
    if (rg_first_bad_lowest(&where, s->comm)) {
        rg_speak(s->comm);
        rg_fatal(
            RG_USAGE,
            "%s: %s: beyond the limit of what flows in element %lld at (%g, %g, %g): how it flowed on the "
            "way would matter",
            s->input->path, what, (long long)where.which, where.x[0], where.x[1], where.x[2]);
    }
}

/* Notes a face with a point beyond the top of its law, at its middle. */
static void note_opening(const rg_solver *s, const rg_tile *t, size_t i, double top, rg_first_bad *where) {
    size_t link = (size_t)s->domain->side[0][i], slot = t->begin * RG_LANES + link / RG_FACES;
    const double *corner = s->domain->corner + 12 * slot;
    const int *node = rg_face_node[link % RG_FACES];
    double middle[3];
    for (int c = 0; c < 3; c++) {
        middle[c] = (corner[3 * node[0] + c] + corner[3 * node[1] + c] + corner[3 * node[2] + c]) / 3;
    }
    for (int q = 0; q < RG_POINTS; q++) {
        double opening = *rg_crack_value(s, i, q, RG_CRACK_OPENING), most = top * rg_separation(s, i, q);
        if (opening > most) {
            rg_first_bad_note(where, 0, middle, opening / most);
        }
    }
}

void rg_limits_refuse_openings(const rg_solver *s, const char *what) {
    const rg_domain *d = s->domain;
    const rg_cohesive *law = &s->model->law;
    rg_first_bad where = {.which = RG_NOWHERE};
    if (law->form != RG_FORM_INTRINSIC) {
        return;
    }
    double top = rg_law_top(law);
    for (size_t t = 0; t < d->tiles; t++) {
        for (size_t i = d->tile[t].ibegin * RG_LANES; i < d->tile[t].iend * RG_LANES; i++) {
            double normal[3];
            if (rg_interface_area(d, i, normal) > 0 && !rg_face_is_open(s, i)) {
                note_opening(s, &d->tile[t], i, top, &where);
            }
        }
    }
    if (rg_first_bad_lowest(&where, s->comm)) {
        rg_speak(s->comm);
        rg_fatal(RG_USAGE,
                 "%s: %s: the face at (%g, %g, %g) has opened %.3g times as far as the top of its law, from "
                 "where on it would go on under less load",
                 s->input->path, what, where.x[0], where.x[1], where.x[2], where.value);
    }
}
