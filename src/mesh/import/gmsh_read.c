#include "mesh/import/gmsh_read.h"

#include <errno.h>
#include <gmshc.h>
#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base/error.h"
#include "base/files.h"
#include "base/mem.h"
#include "mesh/import/gmsh_sets.h"
#include "mesh/import/import.h"

/* Gmsh's element types; corners come first. */
typedef struct {
    int type, nodes, corners;
    bool solid;
} shape;

static const shape shapes[] = {{2, 3, 3, false},  {9, 6, 3, false},  {4, 4, 4, true},   {11, 10, 4, true},
                               {3, 4, 4, false},  {10, 9, 4, false}, {16, 8, 4, false}, {5, 8, 8, true},
                               {12, 27, 8, true}, {17, 20, 8, true}, {6, 6, 6, true},   {13, 18, 6, true},
                               {18, 15, 6, true}, {7, 5, 5, true},   {14, 14, 5, true}, {19, 13, 5, true}};
enum { WHOLE = 4 }; /* the first ones are taken without a cut */

/* NULL: another type, or one that has to be cut where that was not asked for. */
static const shape *shape_of(int type, bool split) {
    for (size_t i = 0; i < (split ? sizeof shapes / sizeof *shapes : WHOLE); i++) {
        if (shapes[i].type == type) {
            return &shapes[i];
        }
    }
    return NULL;
}

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

static bool has_elements(const char *path, int dimension) {
    size_t count = 0;
    rg_gmsh_sets all = rg_gmsh_entities(path, dimension);
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

/* What Gmsh asks while it meshes; it has one thread. */
struct asking {
    const char *path;
    const rg_expr *at;
};

static double size_at(int dim, int tag, double x, double y, double z, void *context) {
    const struct asking *asked = context;
    double size = rg_expr_value(asked->at, (const double[]){x, y, z}, 0);
    (void)dim;
    (void)tag;
    if (!isfinite(size) || !(size > 0)) {
        rg_fatal(RG_USAGE, "%s: --size: %s is %g at (%g, %g, %g)", asked->path, rg_expr_text(asked->at), size,
                 x, y, z);
    }
    return size;
}

static void make_mesh(const char *path, const rg_gmsh_size *size, int dimension) {
    int error;
    struct asking asked = {path, size->at};
    if (size->at != NULL && rg_expr_is_number(size->at)) { /* points of the geometry may ask for less */
        gmshOptionSetNumber("Mesh.MeshSizeMax", rg_expr_value(size->at, (const double[3]){0}, 0), &error);
    } else if (size->at != NULL) {
        gmshOptionSetNumber("Mesh.MeshSizeExtendFromBoundary", 0, &error);
        gmshModelMeshSetSizeCallback(size_at, &asked, &error);
        rg_gmsh_require(path, error);
    }
    if (size->curvature > 0) {
        gmshOptionSetNumber("Mesh.MeshSizeFromCurvature", size->curvature, &error);
    }
    gmshModelMeshGenerate(dimension, &error);
    rg_gmsh_require(path, error);
}

static void open_model(const char *path, const rg_gmsh_size *size, int dimension) {
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
    if (!has_elements(path, dimension)) {
        make_mesh(path, size, dimension);
    } else if (size->at != NULL || size->curvature > 0) {
        rg_fatal(RG_USAGE, "%s: it is a mesh already, so --size and --curvature say nothing", path);
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
        "order are possible%s",
        path, b->count, error == 0 ? name : "?", b->tag[0],
        shape_of(b->type, true) != NULL ? "; --split cuts hexahedra, wedges and pyramids" : "");
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
    const shape *is = shape_of(b->type, t->import->how.split);
    if (is == NULL) {
        refuse_type(t->import->path, b);
    }
    for (size_t e = 0; e < b->count; e++) {
        const size_t *node = b->node + (size_t)is->nodes * e;
        rg_gid first = t->import->elements;
        if (is->corners == 4) {
            rg_import_element(t->import, (rg_gid)b->tag[e], is->nodes, node);
        } else {
            rg_import_solid(t->import, (rg_gid)b->tag[e], is->corners, node);
        }
        for (int32_t s = 0; s < b->sets; s++) {
            for (rg_gid k = first; k < t->import->elements; k++) {
                rg_import_put(t->import, k, b->set[s]);
            }
        }
    }
}

static void take_face(rg_import *m, const shape *is, const size_t *node, size_t tag, int32_t set) {
    if (is->corners == 4) {
        rg_import_add_quadrangle(m, node, (rg_gid)tag, set);
    } else {
        rg_import_add_face(m, (rg_import_face){{node[0], node[1], node[2]}, (rg_gid)tag, set});
    }
}

static void take_faces(void *context, const rg_gmsh_block *b) {
    struct taking *t = context;
    rg_import *m = t->import;
    const shape *is = shape_of(b->type, m->how.split || m->how.thickness > 0);
    if (b->sets == 0 && t->named_only) {
        t->left_out += (int64_t)b->count;
        return;
    }
    if (is == NULL && b->sets > 0) {
        refuse_type(m->path, b);
    }
    for (size_t i = 0; is != NULL && i < b->count; i++) {
        const size_t *node = b->node + (size_t)is->nodes * i;
        for (int32_t s = 0; s < b->sets; s++) {
            take_face(m, is, node, b->tag[i], b->set[s]);
        }
        if (b->sets == 0) {
            take_face(m, is, node, b->tag[i], RG_IMPORT_UNNAMED);
        }
    }
}

/* Of any order: the ends come first. */
static void take_edges(void *context, const rg_gmsh_block *b) {
    rg_import *m = context;
    char *name = NULL;
    int dimension, order, nodes, primary, error;
    double *x = NULL;
    size_t values;
    gmshModelMeshGetElementProperties(b->type, &name, &dimension, &order, &nodes, &x, &values, &primary,
                                      &error);
    rg_gmsh_require(m->path, error);
    for (size_t i = 0; i < b->count; i++) {
        const size_t *node = b->node + (size_t)nodes * i;
        for (int32_t s = 0; s < b->sets; s++) {
            rg_import_add_edge(m, (rg_import_edge){{node[0], node[1]}, (rg_gid)b->tag[i], b->set[s]});
        }
    }
    gmshFree(name);
    gmshFree(x);
}

/* Of a solid those in groups, which name no faces. */
static void read_edges(rg_import *m, bool flat) {
    rg_gmsh_sets edges = rg_gmsh_sets_read(m->path, 1);
    if (!flat && !edges.named) {
        rg_gmsh_sets_free(&edges);
        return;
    }
    for (int32_t s = 0; s < edges.sets.count; s++) {
        rg_sets_add(&m->edge_set, edges.sets.name[s]);
    }
    rg_gmsh_each(m->path, &edges, take_edges, m);
    rg_gmsh_sets_free(&edges);
}

/* Points are no faces. Some geometries have one group for each of thousands: the first few are named. */
static void tell_points(const char *path) {
    rg_gmsh_sets points = rg_gmsh_sets_read(path, 0);
    char names[400] = "";
    for (int32_t s = 0; points.named && s < points.sets.count && s < 5; s++) {
        size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s'%s'", s > 0 ? ", " : "", points.sets.name[s]);
    }
    if (points.named) {
        rg_warn("%s: physical groups of points name no faces: %d are left out: %s%s; a probe takes a place",
                path, points.sets.count, names, points.sets.count > 5 ? ", ..." : "");
    }
    rg_gmsh_sets_free(&points);
}

static void take_names(rg_sets *to, const rg_sets *from) {
    for (int32_t s = 0; s < from->count; s++) {
        rg_sets_add(to, from->name[s]);
    }
}

rg_mesh *rg_gmsh_read(const char *path, const rg_import_how *how, const rg_gmsh_size *size) {
    rg_import m = {.path = path, .how = *how};
    bool flat = how->thickness > 0;
    open_model(path, size, flat ? 2 : 3);
    if (has_unit(path) && how->scale != 1) {
        rg_warn("%s: the file says its unit, so its lengths are in m already; --scale multiplies them by %g",
                path, how->scale);
    }
    read_nodes(&m);
    rg_gmsh_sets volumes = rg_gmsh_sets_read(path, 3), surfaces = rg_gmsh_sets_read(path, 2);
    struct taking t = {&m, volumes.sets.count > 0, 0}, f = {&m, flat && surfaces.sets.count > 0, 0};
    take_names(&m.volume, &volumes.sets);
    take_names(&m.surface, &surfaces.sets);
    rg_gmsh_each(path, &volumes, take_elements, &t);
    rg_gmsh_each(path, &surfaces, take_faces, &f);
    read_edges(&m, flat);
    tell_points(path);
    if (t.left_out > 0) {
        rg_warn("%s: %" PRId64 " elements are in no physical volume and left out", path, t.left_out);
    }
    if (f.left_out > 0) {
        rg_warn("%s: %" PRId64 " triangles are in no physical surface and left out", path, f.left_out);
    }
    rg_gmsh_sets_free(&volumes);
    rg_gmsh_sets_free(&surfaces);
    rg_mesh *mesh = rg_import_finish(&m);
    int error;
    gmshFinalize(&error);
    return mesh;
}
