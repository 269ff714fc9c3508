#include "mesh/import/gmsh_read.h"

#include <errno.h>
#include <gmshc.h>
#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

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

static void count_block(void *context, int type, const size_t *tag, size_t count, const size_t *node,
                        int set) {
    (void)type, (void)tag, (void)node, (void)set;
    *(size_t *)context += count;
}

static bool has_volume_elements(const char *path) {
    size_t count = 0;
    rg_gmsh_sets all = rg_gmsh_entities(path, 3);
    rg_gmsh_each(path, &all, count_block, &count);
    rg_gmsh_sets_free(&all);
    return count > 0;
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

static _Noreturn void refuse_type(const char *path, int type, size_t count, size_t first) {
    char *name = NULL;
    int dim, order, nodes, primary, error;
    double *x = NULL;
    size_t values;
    gmshModelMeshGetElementProperties(type, &name, &dim, &order, &nodes, &x, &values, &primary, &error);
    rg_fatal(
        RG_USAGE,
        "%s: %zu elements of type '%s', the first of them element %zu; only tetrahedra of first and second "
        "order are possible",
        path, count, error == 0 ? name : "?", first);
}

struct taking {
    rg_import *import;
    bool named_only; /* there are physical volumes */
    int64_t left_out;
};

static void take_elements(void *context, int type, const size_t *tag, size_t count, const size_t *node,
                          int set) {
    struct taking *t = context;
    if (set < 0 && t->named_only) {
        t->left_out += (int64_t)count;
        return;
    }
    if (type != TET4 && type != TET10) {
        refuse_type(t->import->path, type, count, tag[0]);
    }
    int each = type == TET4 ? 4 : 10;
    for (size_t e = 0; e < count; e++) {
        rg_import_element(t->import, (rg_gid)tag[e], each, node + (size_t)each * e, set);
    }
}

static void take_faces(void *context, int type, const size_t *tag, size_t count, const size_t *node,
                       int set) {
    rg_import *m = context;
    bool triangles = type == TRI3 || type == TRI6;
    if (!triangles && set >= 0) {
        refuse_type(m->path, type, count, tag[0]);
    }
    for (size_t i = 0; triangles && i < count; i++) {
        rg_import_add_face(m, (rg_gid)tag[i], node + (type == TRI3 ? 3 : 6) * i,
                           set >= 0 ? set : RG_IMPORT_UNNAMED);
    }
}

rg_mesh *rg_gmsh_read(const char *path, double scale) {
    rg_import m = {.path = path, .scale = scale};
    open_model(path);
    read_nodes(&m);
    rg_gmsh_sets volumes = rg_gmsh_sets_read(path, 3), surfaces = rg_gmsh_sets_read(path, 2);
    struct taking t = {&m, volumes.count > 0, 0};
    rg_gmsh_each(path, &volumes, take_elements, &t);
    rg_gmsh_each(path, &surfaces, take_faces, &m);
    if (t.left_out > 0) {
        rg_warn("%s: %" PRId64 " elements are in no physical volume and left out", path, t.left_out);
    }
    rg_mesh *mesh = rg_import_finish(&m, surfaces.name);
    mesh->regions = volumes.count;
    memcpy(mesh->region_name, volumes.name, sizeof mesh->region_name);
    mesh->sets = surfaces.count;
    memcpy(mesh->set_name, surfaces.name, sizeof mesh->set_name);
    rg_gmsh_sets_free(&volumes);
    rg_gmsh_sets_free(&surfaces);
    int error;
    gmshFinalize(&error);
    return mesh;
}
