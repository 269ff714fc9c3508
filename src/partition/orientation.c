#include "partition/orientation.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "base/first_bad.h"
#include "base/mem.h"
#include "base/stiffness.h"
#include "mesh/field.h"

static const rg_anisotropic_input *axes_of(const rg_case *c, int i) {
    const rg_material_input *in = rg_case_material(c, i);
    return in->model == RG_MATERIAL_ANISOTROPIC ? &in->anisotropic : NULL;
}

static bool has_expressions(const rg_anisotropic_input *a) {
    return a != NULL && (a->angle[0] != NULL || a->angle[1] != NULL || a->angle[2] != NULL);
}

bool rg_orientations_vary(const rg_case *c) {
    for (int i = 0; i <= c->others; i++) {
        if (rg_material_axes_vary(rg_case_material(c, i))) {
            return true;
        }
    }
    return false;
}

/* ---- By expressions ---- */

static void fill_angles(const rg_element *e, rg_expr *const angle[3], double own[3], rg_first_bad *bad) {
    double x[3];
    rg_element_centroid(e, x);
    for (int k = 0; k < 3; k++) {
        own[k] = angle[k] == NULL ? 0 : rg_expr_value(angle[k], x, 0);
        if (!isfinite(own[k])) {
#pragma omp critical
            rg_first_bad_note(bad, 3 * (int64_t)e->material + k, x, own[k]);
        }
    }
}

/* "material." or that of an entry of materials */
static void path_of(int material, char path[40]) {
    if (material == 0) {
        snprintf(path, 40, "material.");
    } else {
        snprintf(path, 40, "materials[%d].", material - 1);
    }
}

static void by_expressions(const rg_case *c, rg_part *part, MPI_Comm comm) {
    rg_first_bad bad = {.which = RG_NOWHERE};
#pragma omp parallel
    {
        rg_expr *(*angle)[3] = rg_alloc((size_t)c->others + 1, sizeof *angle);
        for (int i = 0; i <= c->others; i++) {
            for (int k = 0; k < 3; k++) {
                angle[i][k] = has_expressions(axes_of(c, i)) ? rg_expr_copy(axes_of(c, i)->angle[k]) : NULL;
            }
        }
#pragma omp for schedule(static)
        for (rg_lid i = 0; i < part->elements; i++) {
            const rg_element *e = &part->element[i];
            if (has_expressions(axes_of(c, e->material))) {
                fill_angles(e, angle[e->material], part->turn[i].own, &bad);
            }
        }
        for (int i = 0; i < 3 * (c->others + 1); i++) {
            rg_expr_free(angle[i / 3][i % 3]);
        }
        rg_free(angle);
    }
    if (rg_first_bad_lowest(&bad, comm)) {
        char path[40];
        int k = (int)(bad.which % 3);
        path_of((int)(bad.which / 3), path);
        rg_speak(comm);
        rg_fatal(RG_USAGE, "%s: %sorientation.angle_%d: %s is %g at (%g, %g, %g), the centroid of an element",
                 c->path, path, k + 1, rg_expr_text(axes_of(c, (int)(bad.which / 3))->angle[k]), bad.value,
                 bad.x[0], bad.x[1], bad.x[2]);
    }
}

/* ---- By fields of the mesh ---- */

static bool is_of(const rg_case *c, const rg_element *e, const char *field) {
    const rg_anisotropic_input *a = axes_of(c, e->material);
    return a != NULL && a->field != NULL && strcmp(a->field, field) == 0;
}

/* Whether an entry before this one names the same field. */
static bool is_read(const rg_case *c, int material) {
    for (int i = 0; i < material; i++) {
        const rg_anisotropic_input *a = axes_of(c, i);
        if (a != NULL && a->field != NULL && strcmp(a->field, axes_of(c, material)->field) == 0) {
            return true;
        }
    }
    return false;
}

/* Tile by tile: a tile's elements are a run of the file. */
static void by_field(const rg_case *c, rg_part *part, int material, MPI_Comm comm) {
    const char *field = axes_of(c, material)->field;
    rg_mesh_run *run = RG_NEW(rg_mesh_run, (size_t)part->tiles + 1);
    double(*row)[3] = rg_alloc((size_t)part->elements + 1, sizeof *row);
    char path[40], why[200] = "cannot be read by another rank";
    path_of(material, path);
    for (rg_lid t = 0; t < part->tiles; t++) {
        run[t] = (rg_mesh_run){part->tile_id[t] * part->tile, rg_tile_size(part, part->tile_id[t])};
    }
    int good = rg_mesh_field_read(c->mesh.file, field, part->total, (size_t)part->tiles, run, row, why),
        all = 0;
    MPI_Allreduce(&good, &all, 1, MPI_INT, MPI_MIN, comm);
    if (all == 0) {
        rg_speak(comm);
        rg_fatal(RG_USAGE, "%s: %sorientation.field: %s: %s: %s", c->path, path, field, c->mesh.file, why);
    }
    rg_first_bad bad = {.which = RG_NOWHERE};
    for (rg_lid i = 0; i < part->elements; i++) {
        const rg_element *e = &part->element[i];
        for (int k = 0; is_of(c, e, field) && k < 3; k++) {
            part->turn[i].own[k] = row[i][k];
            if (!isfinite(row[i][k])) {
                double x[3];
                rg_element_centroid(e, x);
                rg_first_bad_note(&bad, e->id, x, row[i][k]);
            }
        }
    }
    if (rg_first_bad_lowest(&bad, comm)) {
        rg_speak(comm);
        rg_fatal(RG_USAGE,
                 "%s: %sorientation.field: %s: %s: row %" PRId64
                 " has %g, of the element with its centroid at (%g, %g, %g)",
                 c->path, path, field, c->mesh.file, bad.which, bad.value, bad.x[0], bad.x[1], bad.x[2]);
    }
    rg_free(row);
    rg_free(run);
}

void rg_orientations_find(const rg_case *c, rg_part *part, MPI_Comm comm) {
    part->turn = RG_NEW(rg_turn, (size_t)part->elements + 1);
    by_expressions(c, part, comm);
    for (int i = 0; i <= c->others; i++) {
        const rg_anisotropic_input *a = axes_of(c, i);
        if (a != NULL && a->field != NULL && !is_read(c, i)) {
            by_field(c, part, i, comm);
        }
    }
    for (rg_lid i = 0; i < part->elements; i++) {
        rg_turn *t = &part->turn[i];
        t->id = part->element[i].id;
        for (int f = 0; f < 4; f++) {
            memcpy(t->beside[f], t->own, sizeof t->own);
        }
    }
}

rg_material rg_material_along(const rg_material *m, const double axis[3][3]) {
    rg_material turned = *m;
    if (m->model == RG_MATERIAL_ANISOTROPIC) {
        rg_stiffness_turn(turned.of.anisotropic.stiffness, axis);
    }
    return turned;
}

rg_material rg_material_turned(const rg_material *m, const double angles[3]) {
    double axis[3][3];
    if (angles[0] == 0 && angles[1] == 0 && angles[2] == 0) {
        return *m;
    }
    rg_stiffness_axes(angles, axis);
    return rg_material_along(m, (const double(*)[3])axis);
}
