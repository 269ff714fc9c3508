#include "gmsh_read.h"

#include <errno.h>
#include <gmshc.h>
#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../kernels/layout.h"
#include "error.h"
#include "gmsh_sets.h"
#include "mem.h"

/* Gmsh's element types. */
enum { TET4 = 4, TET10 = 11 };

/* Middle of edge k of a 10-node tetrahedron, Gmsh's node 4 + k, lies between these corners. */
static const int tet_edge[6][2] = {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {2, 3}, {1, 3}};

static const double straight = 1e-6; /* of an edge: how far its middle node may be off */

/* Nodes by tag. */
struct nodes {
    const char *path;
    size_t most;    /* highest tag */
    double *x;      /* [most + 1][3] m */
    rg_gid *vertex; /* [most + 1]: number in the mesh; -1: no corner */
    int8_t *there;  /* [most + 1]: there is such a node */
};

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
    rg_fatal(RG_USAGE, "%s: Gmsh %s: %s", path, GMSH_API_VERSION, said);
}

/* ---- opening ---- */

static bool has_volume_elements(void) {
    int *type = NULL, error;
    size_t types = 0, *tags = NULL, *nodes = NULL, n1, n2, **tag = NULL, **node = NULL;
    gmshModelMeshGetElements(&type, &types, &tag, &tags, &n1, &node, &nodes, &n2, 3, -1, &error);
    for (size_t i = 0; i < types; i++) {
        gmshFree(tag[i]);
        gmshFree(node[i]);
    }
    gmshFree(tag);
    gmshFree(node);
    gmshFree(tags);
    gmshFree(nodes);
    gmshFree(type);
    return error == 0 && types > 0;
}

static void open_model(const char *path) {
    int error;
    FILE *f = fopen(path, "rb");
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
    if (!has_volume_elements()) {
        gmshModelMeshGenerate(3, &error);
        rg_gmsh_require(path, error);
    }
}

/* ---- nodes ---- */

static struct nodes read_nodes(const char *path, double scale) {
    struct nodes n = {.path = path};
    size_t *tag = NULL, tags = 0, values = 0, parameters = 0;
    double *x = NULL, *parameter = NULL;
    int error;
    gmshModelMeshGetNodes(&tag, &tags, &x, &values, &parameter, &parameters, -1, -1, 0, 0, &error);
    rg_gmsh_require(path, error);
    for (size_t i = 0; i < tags; i++) {
        n.most = tag[i] > n.most ? tag[i] : n.most;
    }
    n.x = RG_NEW(double, 3 * (n.most + 1));
    n.vertex = RG_NEW(rg_gid, n.most + 1);
    n.there = RG_NEW(int8_t, n.most + 1);
    for (size_t i = 0; i <= n.most; i++) {
        n.vertex[i] = -1;
    }
    for (size_t i = 0; i < tags; i++) {
        n.there[tag[i]] = 1;
        for (size_t k = 0; k < 3; k++) {
            n.x[3 * tag[i] + k] = scale * x[3 * i + k];
        }
    }
    gmshFree(tag);
    gmshFree(x);
    gmshFree(parameter);
    return n;
}

/* ---- elements ---- */

struct elements {
    rg_gid count, room;
    size_t *node;          /* [count][4] tags */
    rg_gid *tag;           /* [count] */
    int8_t *region;        /* [count] */
    int64_t bent, middles; /* mid-nodes off straight, and all */
};

static void need_tetrahedra(const char *path, int type, size_t count, size_t first) {
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

static void count_bent(const struct nodes *n, const size_t *node, struct elements *all) {
    for (int k = 0; k < 6; k++) {
        const double *a = n->x + 3 * node[tet_edge[k][0]], *b = n->x + 3 * node[tet_edge[k][1]];
        const double *m = n->x + 3 * node[4 + k];
        double off = 0, edge = 0;
        for (int i = 0; i < 3; i++) {
            off += (m[i] - 0.5 * (a[i] + b[i])) * (m[i] - 0.5 * (a[i] + b[i]));
            edge += (b[i] - a[i]) * (b[i] - a[i]);
        }
        all->middles++;
        all->bent += off > straight * straight * edge;
    }
}

static void check_nodes(const struct nodes *n, size_t element, const size_t *node, int count) {
    for (int i = 0; i < count; i++) {
        if (node[i] > n->most || !n->there[node[i]]) {
            rg_fatal(RG_USAGE, "%s: element %zu has node %zu, which is not there", n->path, element, node[i]);
        }
    }
}

/* Adds the elements of one type of one volume. */
static void add_elements(const struct nodes *n, int type, const size_t *tag, size_t count, const size_t *node,
                         int8_t region, struct elements *all) {
    if (type != TET4 && type != TET10) {
        need_tetrahedra(n->path, type, count, tag[0]);
    }
    size_t each = type == TET4 ? 4 : 10;
    all->room = all->count + (rg_gid)count;
    all->node = rg_realloc(all->node, 4 * (size_t)all->room, sizeof *all->node);
    all->tag = rg_realloc(all->tag, (size_t)all->room, sizeof *all->tag);
    all->region = rg_realloc(all->region, (size_t)all->room, sizeof *all->region);
    for (size_t e = 0; e < count; e++) {
        check_nodes(n, tag[e], node + each * e, (int)each);
        memcpy(all->node + 4 * all->count, node + each * e, 4 * sizeof *node);
        all->tag[all->count] = (rg_gid)tag[e];
        all->region[all->count++] = region;
        if (type == TET10) {
            count_bent(n, node + each * e, all);
        }
    }
}

struct taking {
    const struct nodes *nodes;
    struct elements *all;
    bool named_only; /* there are physical volumes */
    int64_t left_out;
};

static void take_block(void *context, int type, const size_t *tag, size_t count, const size_t *node,
                       int set) {
    struct taking *t = context;
    if (set < 0 && t->named_only) {
        t->left_out += (int64_t)count;
    } else {
        add_elements(t->nodes, type, tag, count, node, (int8_t)set, t->all);
    }
}

static void take_elements(const struct nodes *n, const rg_gmsh_sets *volumes, struct elements *all) {
    struct taking t = {n, all, volumes->count > 0, 0};
    rg_gmsh_each(n->path, volumes, take_block, &t);
    if (t.left_out > 0) {
        rg_warn("%s: %" PRId64 " elements are in no physical volume and left out", n->path, t.left_out);
    }
    if (all->count == 0) {
        rg_fatal(RG_USAGE, "%s: no tetrahedra%s", n->path,
                 t.left_out > 0 ? " in the physical volumes"
                                : "; a volume must be meshed or there to be meshed");
    }
    if (all->bent > 0) {
        rg_warn("%s: second-order elements are taken by their corners: %" PRId64 " of %" PRId64
                " mid-nodes are off straight by more than %g of their edge",
                n->path, all->bent, all->middles, straight);
    }
}

/* ---- mesh ---- */

/* Numbers the corners in the order of their tags; says how many nodes nothing uses. */
static void number_vertices(struct nodes *n, const struct elements *all, rg_mesh *mesh) {
    for (rg_gid i = 0; i < 4 * all->count; i++) {
        n->vertex[all->node[i]] = 0;
    }
    for (size_t tag = 0; tag <= n->most; tag++) {
        n->vertex[tag] = n->vertex[tag] < 0 ? -1 : mesh->vertices++;
    }
    mesh->x = RG_NEW(double, 3 * (size_t)mesh->vertices);
    for (size_t tag = 0; tag <= n->most; tag++) {
        if (n->vertex[tag] >= 0) {
            memcpy(mesh->x + 3 * n->vertex[tag], n->x + 3 * tag, 3 * sizeof *mesh->x);
        }
    }
}

static int ascending(const void *a, const void *b) {
    rg_gid p = *(const rg_gid *)a, q = *(const rg_gid *)b;
    return (p > q) - (p < q);
}

static rg_mesh *make_mesh(struct nodes *n, const struct elements *all) {
    rg_mesh *mesh = RG_NEW(rg_mesh, 1);
    size_t count = (size_t)all->count;
    mesh->elements = all->count;
    number_vertices(n, all, mesh);
    mesh->corner = RG_NEW(rg_gid, 4 * count);
    mesh->neighbour = RG_NEW(rg_gid, 4 * count);
    mesh->face = RG_NEW(int8_t, 4 * count);
    mesh->set = RG_NEW(int8_t, 4 * count);
    mesh->region = RG_NEW(int8_t, count);
    mesh->original = RG_NEW(rg_gid, count);
    memset(mesh->set, -1, 4 * count);
    memcpy(mesh->region, all->region, count * sizeof *all->region);
    memcpy(mesh->original, all->tag, count * sizeof *all->tag);
    for (size_t e = 0; e < count; e++) {
        for (size_t i = 0; i < 4; i++) {
            mesh->corner[4 * e + i] = n->vertex[all->node[4 * e + i]];
        }
        qsort(mesh->corner + 4 * e, 4, sizeof *mesh->corner, ascending);
    }
    return mesh;
}

static void tell_unused(const struct nodes *n, const struct elements *all, const rg_mesh *mesh) {
    int64_t unused = 0;
    for (size_t tag = 0; tag <= n->most; tag++) {
        unused += n->there[tag] && n->vertex[tag] < 0;
    }
    if (unused > 0 && all->middles == 0) {
        rg_warn("%s: %" PRId64 " nodes belong to no tetrahedron and are left out; %" PRId64 " remain",
                n->path, unused, mesh->vertices);
    }
}

rg_mesh *rg_gmsh_read(const char *path, double scale) {
    open_model(path);
    struct nodes n = read_nodes(path, scale);
    struct elements all = {0};
    rg_gmsh_sets volumes = rg_gmsh_sets_read(path, 3), surfaces = rg_gmsh_sets_read(path, 2);
    take_elements(&n, &volumes, &all);
    rg_mesh *mesh = make_mesh(&n, &all);
    tell_unused(&n, &all, mesh);
    mesh->regions = volumes.count;
    memcpy(mesh->region_name, volumes.name, sizeof mesh->region_name);
    mesh->sets = surfaces.count;
    memcpy(mesh->set_name, surfaces.name, sizeof mesh->set_name);
    rg_gmsh_mark_surfaces(path, &surfaces, n.vertex, n.most, mesh);
    rg_gmsh_sets_free(&volumes);
    rg_gmsh_sets_free(&surfaces);
    rg_free(n.x);
    rg_free(n.vertex);
    rg_free(n.there);
    rg_free(all.node);
    rg_free(all.tag);
    rg_free(all.region);
    int error;
    gmshFinalize(&error);
    return mesh;
}
