#include "solver/selection.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "base/exact_sum.h"
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

/* ---- What is selected ---- */

enum { MOST_NAMED = 3 };

/* " of glass, steel and tin", or how many they are. */
static void name_materials(const bool *there, const rg_case *c, char *words, size_t size) {
    int count = 0, told = 0;
    for (int m = 0; m <= c->others; m++) {
        count += there[m];
    }
    words[0] = '\0';
    if (c->others == 0 || count > MOST_NAMED) {
        if (c->others > 0) {
            snprintf(words, size, " of %d materials", count);
        }
        return;
    }
    for (int m = 0; m <= c->others; m++) {
        if (there[m]) {
            const char *before = told == 0 ? " of " : told == count - 1 ? " and " : ", ";
            size_t length = strlen(words);
            snprintf(words + length, size - length, "%s%s", before, rg_case_material_name(c, m));
            told++;
        }
    }
}

rg_selected rg_selection_measure(const uint8_t *on, bool whole, const rg_case *c, const rg_domain *d,
                                 MPI_Comm comm) {
    rg_selected s = {.count = 0};
    rg_exact_sum sum = {0};
    bool *there = RG_NEW(bool, (size_t)c->others + 1);
    for (size_t i = 0; i < RG_FACES * d->blocks * RG_LANES; i++) {
        size_t slot = i / RG_FACES;
        int face = (int)(i % RG_FACES);
        double normal[3];
        if ((on[slot] >> face & 1) == 0 || (whole && face > 0)) {
            continue;
        }
        rg_exact_add(&sum, whole ? (double)d->geom[rg_geom_index(slot, RG_GEOM_VOLUME)]
                                 : rg_surface_area(d->corner + 12 * slot, face, normal));
        there[d->material[slot / RG_LANES]] = true;
        s.count++;
    }
    rg_exact_allreduce(&sum, 1, comm);
    s.size = rg_exact_value(&sum);
    MPI_Allreduce(MPI_IN_PLACE, &s.count, 1, MPI_INT64_T, MPI_SUM, comm);
    MPI_Allreduce(MPI_IN_PLACE, there, c->others + 1, MPI_C_BOOL, MPI_LOR, comm);
    name_materials(there, c, s.of, sizeof s.of);
    rg_free(there);
    return s;
}

void rg_selected_tell(const rg_selected *s, bool whole, char *words, size_t size) {
    snprintf(words, size, "%.4g m%c, %" PRId64 " %s%s%s", s->size, whole ? '3' : '2', s->count,
             whole ? "element" : "face", s->count == 1 ? "" : "s", s->of);
}
