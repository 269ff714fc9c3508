#include "solver/selection.h"

#include <math.h>

#include "base/error.h"
#include "base/first_bad.h"
#include "base/mem.h"
#include "solver/surface.h"

static void face_middle(const double *corner, int face, double x[3]) {
    const int *node = rg_face_node[face];
    for (int c = 0; c < 3; c++) {
        x[c] = (corner[3 * node[0] + c] + corner[3 * node[1] + c] + corner[3 * node[2] + c]) / 3;
    }
}

static bool is_there(const rg_selection *s, const double *corner, int face, bool turned, rg_first_bad *bad) {
    double middle[3], normal[3];
    face_middle(corner, face, middle);
    rg_surface_area(corner, face, normal);
    for (int c = 0; turned && c < 3; c++) {
        normal[c] = -normal[c];
    }
    double here = rg_expr_face_value(s->where, middle, normal);
    if (!isfinite(here)) {
        rg_first_bad_note(bad, 0, middle, here);
    }
    return here != 0;
}

static bool *groups_of(const rg_selection *s, const rg_case *c, const rg_part *part, MPI_Comm comm) {
    int32_t set = rg_sets_find(&part->surface, s->set);
    if (set < 0) {
        rg_speak(comm);
        rg_fatal(RG_USAGE, "%s: %s[%d].set: the mesh has no set named '%s'", c->path, s->list, s->number,
                 s->set);
    }
    return rg_sets_groups_in(&part->surface, set);
}

uint8_t *rg_selection_faces(const rg_selection *s, const rg_case *c, const rg_domain *d, const rg_part *part,
                            MPI_Comm comm) {
    bool *in = s->set != NULL ? groups_of(s, c, part, comm) : NULL;
    rg_first_bad bad = {.which = RG_NOWHERE};
    uint8_t *faces = RG_NEW(uint8_t, d->blocks * RG_LANES + 1);
    int64_t count = 0;
    for (size_t i = 0; i < RG_FACES * d->blocks * RG_LANES; i++) { /* expressions are not for threads */
        size_t slot = i / RG_FACES;
        int face = (int)(i % RG_FACES), group = d->set[i];
        int32_t link = d->interface[rg_link_index(slot, face)];
        bool there = s->inside ? d->id[slot] >= 0 && link >= 0 : rg_surface_has(d, slot, face);
        if (there && (in != NULL ? group >= 0 && in[group]
                      : s->where == NULL
                          ? true
                          : is_there(s, d->corner + 12 * slot, face, s->inside && link % 2 != 0, &bad))) {
            faces[slot] |= (uint8_t)(1u << face);
            count++;
        }
    }
    rg_free(in);
    if (rg_first_bad_lowest(&bad, comm)) {
        rg_speak(comm);
        rg_fatal(RG_USAGE, "%s: %s[%d].where: %s is not finite at (%g, %g, %g)", c->path, s->list, s->number,
                 rg_expr_text(s->where), bad.x[0], bad.x[1], bad.x[2]);
    }
    MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPI_INT64_T, MPI_SUM, comm);
    if (count == 0) {
        rg_speak(comm);
        bool any = s->where == NULL && s->set == NULL;
        rg_fatal(RG_USAGE, "%s: %s[%d]: no face %s is in it%s%s", c->path, s->list, s->number,
                 s->inside ? "between elements" : "of the surface",
                 any                ? ""
                 : s->where != NULL ? ", where: "
                                    : ", set: ",
                 any                ? ""
                 : s->where != NULL ? rg_expr_text(s->where)
                                    : s->set);
    }
    return faces;
}
