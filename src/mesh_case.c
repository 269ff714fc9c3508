/* The mesh that a case asks for. */
#include "mesh_case.h"

#include <math.h>
#include <string.h>

#include "case_problem.h"
#include "element.h"
#include "error.h"
#include "mem.h"
#include "mesh_file.h"

static const char *list_names(const rg_mesh *mesh, char *text, size_t size) {
    size_t used = 0;
    text[0] = '\0';
    for (int s = 0; s < mesh->sets && used < size; s++) {
        used += (size_t)snprintf(text + used, size - used, "%s%s", s > 0 ? ", " : "", mesh->set_name[s]);
    }
    return mesh->sets > 0 ? text : "none";
}

/* Those that the boundary names must be there: the case file could not know. */
static void check_sets(const rg_case *c, const rg_mesh *mesh) {
    const char *names[RG_MAX_SETS + 1] = {NULL};
    char all[1024];
    memcpy(names, mesh->set_name, (size_t)mesh->sets * sizeof *names);
    for (int b = 0; b < c->boundaries; b++) {
        const char *set = c->boundary[b].set;
        bool known = false;
        for (int s = 0; s < mesh->sets; s++) {
            known = known || strcmp(set, names[s]) == 0;
        }
        if (!known) {
            const char *near = rg_nearest(set, names);
            rg_fatal(RG_USAGE, "%s: boundary[%d].set: %s: %s has no such surface set; allowed: %s%s%s%s",
                     c->path, b, set, c->mesh.file, list_names(mesh, all, sizeof all),
                     near != NULL ? "; did you mean '" : "", near != NULL ? near : "",
                     near != NULL ? "'?" : "");
        }
    }
}

static bool contains(const rg_mesh *mesh, rg_gid e, const double x[3]) {
    double corner[12], l[4];
    for (int i = 0; i < 4; i++) {
        memcpy(corner + 3 * i, mesh->x + 3 * mesh->corner[4 * e + i], 3 * sizeof *corner);
    }
    rg_barycentric(corner, x, l);
    return fmin(fmin(l[0], l[1]), fmin(l[2], l[3])) >= -1e-9; /* as for the probes themselves */
}

/* Probes must be in the mesh: told before the run writes anything. */
static void check_probes(const rg_case *c, const rg_mesh *mesh) {
    for (int p = 0; p < c->output.probes; p++) {
        const double *x = c->output.probe[p].at;
        rg_gid e = 0;
        while (e < mesh->elements && !contains(mesh, e, x)) {
            e++;
        }
        if (e == mesh->elements) {
            rg_fatal(RG_USAGE, "%s: output.probes[%d].at: [%g, %g, %g]: no element of %s contains it",
                     c->path, p, x[0], x[1], x[2], c->mesh.file);
        }
    }
}

rg_mesh *rg_mesh_of_case(const rg_case *c) {
    rg_mesh *mesh;
    if (c->mesh.file != NULL) {
        mesh = rg_mesh_file_read(c->mesh.file);
        check_sets(c, mesh);
        check_probes(c, mesh);
    } else {
        mesh = rg_mesh_box(c->mesh.cells, c->mesh.origin, c->mesh.size, c->mesh.jitter, c->mesh.seed);
    }
    return mesh;
}
