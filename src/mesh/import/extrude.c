#include "mesh/import/extrude.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/mem.h"

static const double flat = 1e-6; /* of the size: how far nodes may be off the plane */

/* A triangle of the input by the numbers that stand for its nodes. */
struct triangle {
    size_t sorted[3], node[3];
    rg_gid name;
    int32_t set;
};

/* The entries list[begin .. end - 1] are one triangle, in several sets. */
struct prism {
    size_t begin, end;
};

typedef struct {
    rg_import *import;
    struct triangle *list;
    size_t count, prisms;
    struct prism *prism;
    size_t stride; /* between the numbers of a node in two layers */
} plate;

static int by_nodes(const void *a, const void *b) {
    const struct triangle *p = a, *q = b;
    for (int i = 0; i < 3; i++) {
        if (p->sorted[i] != q->sorted[i]) {
            return p->sorted[i] < q->sorted[i] ? -1 : 1;
        }
    }
    return p->name != q->name ? (p->name > q->name) - (p->name < q->name)
                              : (p->set > q->set) - (p->set < q->set);
}

static int ascending(const void *a, const void *b) {
    size_t p = *(const size_t *)a, q = *(const size_t *)b;
    return (p > q) - (p < q);
}

/* ---- triangles ---- */

static void list_triangles(plate *p) {
    rg_import *m = p->import;
    p->list = RG_NEW(struct triangle, m->faces);
    for (size_t i = 0; i < m->faces; i++) {
        struct triangle *t = &p->list[p->count++];
        *t = (struct triangle){.name = m->face[i].name, .set = m->face[i].set};
        for (int k = 0; k < 3; k++) {
            t->node[k] = t->sorted[k] = rg_import_number(m, m->face[i].node[k]);
        }
        qsort(t->sorted, 3, sizeof *t->sorted, ascending);
    }
    qsort(p->list, p->count, sizeof *p->list, by_nodes);
    p->prism = RG_NEW(struct prism, p->count);
    for (size_t i = 0; i < p->count; i++) {
        bool again = i > 0 && memcmp(p->list[i - 1].sorted, p->list[i].sorted, sizeof p->list->sorted) == 0;
        p->prisms += !again;
        p->prism[p->prisms - 1] = (struct prism){again ? p->prism[p->prisms - 1].begin : i, i + 1};
    }
}

/* Position of a node, which must be there. */
static const double *place_of(const plate *p, const struct triangle *t, int k) {
    const double *x = rg_import_place(p->import, t->node[k]);
    if (x == NULL) {
        rg_fatal(RG_USAGE, "%s: element %" PRId64 " has node %zu, which is not there", p->import->path,
                 t->name, t->node[k]);
    }
    return x;
}

static void check_flat(const plate *p) {
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < 3 * p->count; i++) {
        const double *x = place_of(p, &p->list[i / 3], (int)(i % 3));
        for (int c = 0; c < 3; c++) {
            low[c] = fmin(low[c], x[c]);
            high[c] = fmax(high[c], x[c]);
        }
    }
    if (high[2] - low[2] > flat * fmax(high[0] - low[0], high[1] - low[1])) {
        rg_fatal(RG_USAGE,
                 "%s: --extrude takes a mesh that is flat in z, but its triangles are at z from %g to %g m",
                 p->import->path, low[2], high[2]);
    }
}

/* ---- layers ---- */

static size_t at_layer(const plate *p, size_t number, int layer) {
    return number + (size_t)layer * p->stride;
}

/* The corners of the triangles once more for each layer. */
static void add_nodes(plate *p) {
    rg_import *m = p->import;
    size_t *number = RG_NEW(size_t, 3 * p->count), most = 0, kept = 0;
    for (size_t i = 0; i < 3 * p->count; i++) {
        number[i] = p->list[i / 3].node[i % 3];
        most = number[i] > most ? number[i] : most;
    }
    for (p->stride = 10; p->stride <= most; p->stride *= 10) {
    }
    qsort(number, 3 * p->count, sizeof *number, ascending);
    for (size_t i = 0; i < 3 * p->count; i++) {
        if (kept == 0 || number[i] != number[kept - 1]) {
            number[kept++] = number[i];
        }
    }
    double *x = RG_NEW(double, 3 * kept);
    for (size_t n = 0; n < kept; n++) {
        memcpy(x + 3 * n, rg_import_place(m, number[n]), 3 * sizeof *x);
    }
    rg_free(m->twin); /* all that follows is by the numbers that stand for others */
    m->twin = NULL;
    m->how.merge = 0;
    m->how.scale = 1;
    for (int layer = 1; layer <= m->how.layers; layer++) {
        for (size_t n = 0; n < kept; n++) {
            double z = x[3 * n + 2] + m->how.thickness * layer / m->how.layers;
            rg_import_node(m, at_layer(p, number[n], layer), (const double[]){x[3 * n], x[3 * n + 1], z});
        }
    }
    rg_free(x);
    rg_free(number);
}

static void add_prism(const plate *p, const struct prism *prism, int layer) {
    rg_import *m = p->import;
    const struct triangle *t = &p->list[prism->begin];
    const double *a = place_of(p, t, 0), *b = place_of(p, t, 1), *c = place_of(p, t, 2);
    bool turned = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) < 0;
    const size_t node[3] = {t->node[0], t->node[turned ? 2 : 1], t->node[turned ? 1 : 2]};
    size_t corner[6];
    for (int k = 0; k < 6; k++) {
        corner[k] = at_layer(p, node[k % 3], layer + k / 3);
    }
    rg_gid first = m->elements;
    rg_import_solid(m, t->name, 6, corner);
    for (size_t i = prism->begin; i < prism->end; i++) {
        for (rg_gid e = first; e < m->elements && p->list[i].set >= 0; e++) {
            rg_import_put(m, e, p->list[i].set);
        }
    }
}

/* The set of that name for the lower or the upper faces, unless edges have it. */
static int32_t cover(rg_import *m, const char *name) {
    if (rg_sets_find(&m->surface, name) >= 0) {
        rg_warn("%s: there is a set '%s' of edges: the faces that --extrude would call so are in no set",
                m->path, name);
        return RG_IMPORT_UNNAMED;
    }
    return rg_sets_add(&m->surface, name);
}

static void add_covers(const plate *p) {
    rg_import *m = p->import;
    int32_t bottom = cover(m, "bottom"), top = cover(m, "top");
    for (size_t i = 0; i < p->prisms; i++) {
        const struct triangle *t = &p->list[p->prism[i].begin];
        rg_import_face face = {{t->node[0], t->node[1], t->node[2]}, t->name, bottom};
        rg_import_add_face(m, face);
        for (int k = 0; k < 3; k++) {
            face.node[k] = at_layer(p, t->node[k], m->how.layers);
        }
        face.set = top;
        rg_import_add_face(m, face);
    }
}

static void add_sides(const plate *p) {
    rg_import *m = p->import;
    for (size_t i = 0; i < m->edges; i++) {
        const rg_import_edge *e = &m->edge[i];
        for (int layer = 0; layer < m->how.layers; layer++) {
            const size_t corner[4] = {at_layer(p, e->node[0], layer), at_layer(p, e->node[1], layer),
                                      at_layer(p, e->node[1], layer + 1), at_layer(p, e->node[0], layer + 1)};
            rg_import_add_quadrangle(m, corner, e->name, e->set);
        }
    }
}

static void repeat_points(const plate *p) {
    rg_import *m = p->import;
    size_t points = m->points;
    for (size_t i = 0; i < points; i++) {
        for (int layer = 1; layer <= m->how.layers; layer++) {
            rg_import_add_point(m, at_layer(p, m->point[i].node, layer), m->point[i].set);
        }
    }
}

/* Edges and points by the numbers that stand for their nodes. */
static void take_numbers(rg_import *m) {
    for (size_t i = 0; i < 2 * m->edges; i++) {
        size_t *node = &m->edge[i / 2].node[i % 2];
        *node = rg_import_number(m, *node);
    }
    for (size_t i = 0; i < m->points; i++) {
        m->point[i].node = rg_import_number(m, m->point[i].node);
    }
}

void rg_extrude(rg_import *m) {
    plate p = {.import = m};
    if (m->elements > 0 || m->faces == 0) {
        rg_fatal(RG_USAGE, "%s: --extrude takes a flat mesh of triangles and quadrangles, but there are %s",
                 m->path, m->elements > 0 ? "solids" : "none");
    }
    list_triangles(&p);
    check_flat(&p);
    take_numbers(m);
    add_nodes(&p);
    rg_sets_free(&m->volume);
    m->volume = m->surface;
    m->surface = m->edge_set;
    m->edge_set = (rg_sets){.count = 0};
    m->faces = 0;
    for (int layer = 0; layer < m->how.layers; layer++) {
        for (size_t i = 0; i < p.prisms; i++) {
            add_prism(&p, &p.prism[i], layer);
        }
    }
    add_covers(&p);
    add_sides(&p);
    repeat_points(&p);
    rg_free(p.list);
    rg_free(p.prism);
}
