#include "mesh/import/gmsh_read.h"

#include <errno.h>
#include <gmshc.h>
#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base/error.h"
#include "base/files.h"
#include "base/mem.h"
#include "mesh/import/gmsh_sets.h"
#include "mesh/import/import.h"

/* Gmsh's element types. */
enum { TRI3 = 2, TET4 = 4, TRI6 = 9, TET10 = 11 };

void rg_gmsh_require(const char *path, int error) {
    if (error == 0) {
        return;
    }
    char **line = NULL;
    size_t lines = 0;
    int ignored;
    gmshLoggerGet(&line, &lines, &ignored);
    const char *said = "no reason given";
    for (size_t i = 0; i < lines; i++) {
        if (strncmp(line[i], "Error: ", 7) == 0) {
            said = line[i] + 7;
            break;
        }
    }
    rg_fatal(RG_USAGE, "%s: Gmsh: %s", path, said);
}

/* ---- opening ---- */

static void count_block(void *context, const rg_gmsh_block *b) {
    *(size_t *)context += b->count;
}

static bool has_volume_elements(const char *path) {
    size_t count = 0;
    rg_gmsh_sets all = rg_gmsh_entities(path, 3);
    rg_gmsh_each(path, &all, count_block, &count);
    rg_gmsh_sets_free(&all);
    return count > 0;
}

/* Formats that say in which unit their lengths are. */
static bool has_unit(const char *path) {
    static const char *const endings[] = {".step", ".stp", ".iges", ".igs"};
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; dot != NULL && i < sizeof endings / sizeof *endings; i++) {
        if (strcasecmp(dot, endings[i]) == 0) {
            return true;
        }
    }
    return false;
}

static void open_model(const char *path) {
    int error;
    FILE *f = rg_open_input(path);
    if (f == NULL) {
        rg_fatal(RG_USAGE, "%s: cannot be read: %s", path, strerror(errno));
    }
    fclose(f);
    gmshInitialize(0, NULL, 0, &error);
    gmshOptionSetNumber("General.Terminal", 0, &error);
    gmshOptionSetNumber("General.NumThreads", 1, &error); /* the same mesh every time */
    if (has_unit(path)) {                                 /* else OpenCASCADE makes mm of it */
        gmshOptionSetString("Geometry.OCCTargetUnit", "M", &error);
    }
    gmshLoggerStart(&error);
    gmshOpen(path, &error);
    rg_gmsh_require(path, error);
    if (!has_volume_elements(path)) {
        gmshModelMeshGenerate(3, &error);
        rg_gmsh_require(path, error);
    }
}

/* ---- nodes, elements and faces ---- */

static void read_nodes(rg_import *m) {
    size_t *tag = NULL, tags = 0, values = 0, parameters = 0;
    double *x = NULL, *parameter = NULL;
    int error;
    gmshModelMeshGetNodes(&tag, &tags, &x, &values, &parameter, &parameters, -1, -1, 0, 0, &error);
    rg_gmsh_require(m->path, error);
    for (size_t i = 0; i < tags; i++) {
        rg_import_node(m, tag[i], x + 3 * i);
    }
    gmshFree(tag);
    gmshFree(x);
    gmshFree(parameter);
}

static _Noreturn void refuse_type(const char *path, const rg_gmsh_block *b) {
    char *name = NULL;
    int dim, order, nodes, primary, error;
    double *x = NULL;
    size_t values;
    gmshModelMeshGetElementProperties(b->type, &name, &dim, &order, &nodes, &x, &values, &primary, &error);
    rg_fatal(
        RG_USAGE,
        "%s: %zu elements of type '%s', the first of them element %zu; only tetrahedra of first and second "
        "order are possible",
        path, b->count, error == 0 ? name : "?", b->tag[0]);
}

struct taking {
    rg_import *import;
    bool named_only; /* there are physical volumes */
    int64_t left_out;
};

static void take_elements(void *context, const rg_gmsh_block *b) {
    struct taking *t = context;
    if (b->sets == 0 && t->named_only) {
        t->left_out += (int64_t)b->count;
        return;
    }
    if (b->type != TET4 && b->type != TET10) {
        refuse_type(t->import->path, b);
    }
    int each = b->type == TET4 ? 4 : 10;
    for (size_t e = 0; e < b->count; e++) {
        rg_import_element(t->import, (rg_gid)b->tag[e], each, b->node + (size_t)each * e);
        for (int32_t s = 0; s < b->sets; s++) {
            rg_import_put(t->import, t->import->elements - 1, b->set[s]);
        }
    }
}

static void take_faces(void *context, const rg_gmsh_block *b) {
    rg_import *m = context;
    bool triangles = b->type == TRI3 || b->type == TRI6;
    if (!triangles && b->sets > 0) {
        refuse_type(m->path, b);
    }
    for (size_t i = 0; triangles && i < b->count; i++) {
        const size_t *node = b->node + (b->type == TRI3 ? 3 : 6) * i;
        rg_import_face face = {{node[0], node[1], node[2]}, (rg_gid)b->tag[i], RG_IMPORT_UNNAMED};
        for (int32_t s = 0; s < b->sets; s++) {
            face.set = b->set[s];
            rg_import_add_face(m, face);
        }
        if (b->sets == 0) {
            rg_import_add_face(m, face);
        }
    }
}

static void take_names(rg_sets *to, const rg_sets *from) {
    for (int32_t s = 0; s < from->count; s++) {
        rg_sets_add(to, from->name[s]);
    }
}

rg_mesh *rg_gmsh_read(const char *path, double scale) {
    rg_import m = {.path = path, .scale = scale};
    open_model(path);
    if (has_unit(path) && scale != 1) {
        rg_warn("%s: the file says its unit, so its lengths are in m already; --scale multiplies them by %g",
                path, scale);
    }
    read_nodes(&m);
    rg_gmsh_sets volumes = rg_gmsh_sets_read(path, 3), surfaces = rg_gmsh_sets_read(path, 2);
    struct taking t = {&m, volumes.sets.count > 0, 0};
    take_names(&m.volume, &volumes.sets);
    take_names(&m.surface, &surfaces.sets);
    rg_gmsh_each(path, &volumes, take_elements, &t);
    rg_gmsh_each(path, &surfaces, take_faces, &m);
    if (t.left_out > 0) {
        rg_warn("%s: %" PRId64 " elements are in no physical volume and left out", path, t.left_out);
    }
    rg_gmsh_sets_free(&volumes);
    rg_gmsh_sets_free(&surfaces);
    rg_mesh *mesh = rg_import_finish(&m);
    int error;
    gmshFinalize(&error);
    return mesh;
}
