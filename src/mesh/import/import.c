#include "mesh/import/import.h"

#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/mem.h"
#include "base/tet.h"
#include "layout.h"
#include "mesh/import/extrude.h"
#include "mesh/import/merge.h"
#include "mesh/import/solid.h"

static const double straight = 1e-6; /* of an edge: how far its middle node may be off */

static const int edge_end[6][2] = {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {2, 3}, {1, 3}};

/* ---- adding ---- */

void rg_import_node(rg_import *m, size_t number, const double x[3]) {
    m->x = rg_grow(m->x, &m->x_room, m->nodes, 3 * sizeof *m->x);
    m->number = rg_grow(m->number, &m->number_room, m->nodes, sizeof *m->number);
    m->number[m->nodes] = number;
    for (size_t i = 0; i < 3; i++) {
        m->x[3 * m->nodes + i] = m->how.scale * x[i];
    }
    m->nodes++;
}

/* Maps all numbers; of rows with the same one the first keeps it and takes the position of the last. */
static void map_nodes(rg_import *m) {
    rg_gid_map_free(&m->row);
    m->row = rg_gid_map_make(m->nodes);
    for (size_t n = 0; n < m->nodes; n++) {
        size_t row = (size_t)rg_gid_map_put(&m->row, (rg_gid)m->number[n], (rg_lid)n);
        memmove(m->x + 3 * row, m->x + 3 * n, 3 * sizeof *m->x);
    }
    m->mapped = m->nodes;
}

/* Rows that stand for no other number, and of those that coincide the first for all. */
static void merge_nodes(rg_import *m) {
    rg_free(m->twin);
    m->twin = RG_NEW(size_t, m->nodes);
    for (size_t n = 0; n < m->nodes; n++) {
        m->twin[n] = (size_t)rg_gid_map_get(&m->row, (rg_gid)m->number[n]);
    }
    rg_merged found = rg_merge(m->nodes, m->x, m->how.merge, m->twin);
    printf("%s: %" PRId64 " nodes merged with others within %g m", m->path, found.count, m->how.merge);
    if (found.count > 0) {
        const double *x = m->x + 3 * found.first;
        printf("; the first is node %zu with node %zu at (%g, %g, %g) m, the farthest are %g m apart",
               m->number[found.first], m->number[m->twin[found.first]], x[0], x[1], x[2], found.farthest);
    }
    putchar('\n');
}

/* Row of the node with this number, SIZE_MAX if there is none. */
static size_t row_of(rg_import *m, size_t number) {
    if (m->mapped < m->nodes) {
        map_nodes(m);
        m->how.merge > 0 ? merge_nodes(m) : (void)0;
    }
    rg_lid row = m->nodes > 0 ? rg_gid_map_get(&m->row, (rg_gid)number) : -1;
    return row < 0 ? SIZE_MAX : m->twin != NULL ? m->twin[row] : (size_t)row;
}

size_t rg_import_number(rg_import *m, size_t number) {
    size_t row = row_of(m, number);
    return row == SIZE_MAX ? number : m->number[row];
}

static void look_at_middles(rg_import *m, const size_t *node) {
    for (int k = 0; k < 6; k++) {
        const double *a = m->x + 3 * node[edge_end[k][0]], *b = m->x + 3 * node[edge_end[k][1]];
        const double *middle = m->x + 3 * node[4 + k];
        double off = 0, edge = 0;
        for (int i = 0; i < 3; i++) {
            off += (middle[i] - 0.5 * (a[i] + b[i])) * (middle[i] - 0.5 * (a[i] + b[i]));
            edge += (b[i] - a[i]) * (b[i] - a[i]);
        }
        m->middles++;
        m->bent += off > straight * straight * edge;
        m->worst = off > 0 ? fmax(m->worst, sqrt(off / edge)) : m->worst;
    }
}

/* Elements that the input numbers inside out. Corners are sorted later, so it does no harm. */
static void look_at_orientation(rg_import *m, rg_gid name, const size_t *row) {
    const double *x = m->x;
    if (rg_tet_volume(x + 3 * row[0], x + 3 * row[1], x + 3 * row[2], x + 3 * row[3]) < 0) {
        m->first_inverted = m->inverted++ == 0 ? name : m->first_inverted;
    }
}

void rg_import_element(rg_import *m, rg_gid name, int nodes, const size_t *node) {
    size_t row[10], count = (size_t)m->elements;
    m->corner = rg_grow(m->corner, &m->corner_room, count, 4 * sizeof *m->corner);
    m->name = rg_grow(m->name, &m->name_room, count, sizeof *m->name);
    m->region = rg_grow(m->region, &m->region_room, count, sizeof *m->region);
    for (int i = 0; i < nodes; i++) {
        row[i] = row_of(m, node[i]);
        if (row[i] == SIZE_MAX) {
            rg_fatal(RG_USAGE, "%s: element %" PRId64 " has node %zu, which is not there", m->path, name,
                     node[i]);
        }
    }
    memcpy(m->corner + 4 * m->elements, row, 4 * sizeof *row);
    look_at_orientation(m, name, row);
    m->name[m->elements] = name;
    m->region[m->elements++] = -1;
    if (nodes == 10) {
        look_at_middles(m, row);
    }
}

const double *rg_import_place(rg_import *m, size_t number) {
    size_t row = row_of(m, number);
    return row == SIZE_MAX ? NULL : m->x + 3 * row;
}

int rg_import_solid(rg_import *m, rg_gid name, int corners, const size_t *node) {
    size_t same[8], tet[RG_SOLID_TETS][4];
    for (int i = 0; i < corners; i++) {
        same[i] = rg_import_number(m, node[i]);
    }
    int count = rg_solid_split(corners, same, tet);
    for (int t = 0; t < count; t++) {
        rg_import_element(m, name, 4, tet[t]);
    }
    return count;
}

void rg_import_put(rg_import *m, rg_gid element, int32_t set) {
    m->volumes.sets = &m->volume;
    m->region[element] = rg_sets_join(&m->volumes, m->region[element], set);
}

void rg_import_put_skin(rg_import *m, rg_gid element, int32_t set) {
    if (m->skin == NULL) {
        m->skin = RG_NEW(int32_t, (size_t)m->elements);
        memset(m->skin, -1, (size_t)m->elements * sizeof *m->skin);
        m->skin_sets = rg_sets_copy(&m->surface);
        m->skins.sets = &m->skin_sets;
    }
    m->skin[element] = rg_sets_join(&m->skins, m->skin[element], set);
}

void rg_import_add_face(rg_import *m, rg_import_face face) {
    m->face = rg_grow(m->face, &m->face_room, m->faces, sizeof *m->face);
    m->face[m->faces++] = face;
}

void rg_import_add_quadrangle(rg_import *m, const size_t corner[4], rg_gid name, int32_t set) {
    size_t same[4], triangle[2][3];
    for (int i = 0; i < 4; i++) {
        same[i] = rg_import_number(m, corner[i]);
    }
    int count = rg_solid_quadrangle(same, triangle);
    for (int t = 0; t < count; t++) {
        rg_import_add_face(m, (rg_import_face){{triangle[t][0], triangle[t][1], triangle[t][2]}, name, set});
    }
}

void rg_import_add_edge(rg_import *m, rg_import_edge edge) {
    m->edge = rg_grow(m->edge, &m->edge_room, m->edges, sizeof *m->edge);
    m->edge[m->edges++] = edge;
}

void rg_import_add_point(rg_import *m, size_t node, int32_t set) {
    m->point = rg_grow(m->point, &m->point_room, m->points, sizeof *m->point);
    m->point[m->points++] = (rg_import_point){node, set};
}

/* ---- vertices and elements ---- */

struct numbered {
    size_t number, row;
};

static int by_number(const void *a, const void *b) {
    const struct numbered *p = a, *q = b;
    if (p->number != q->number) {
        return p->number < q->number ? -1 : 1;
    }
    return (p->row > q->row) - (p->row < q->row);
}

/* The rows in the order of the input's numbers. */
static struct numbered *sort_nodes(const rg_import *m) {
    struct numbered *list = RG_NEW(struct numbered, m->nodes);
    for (size_t n = 0; n < m->nodes; n++) {
        list[n] = (struct numbered){m->number[n], n};
    }
    qsort(list, m->nodes, sizeof *list, by_number);
    return list;
}

/* Numbers the corners in the order of the input's numbers; vertex[row] is -1 for what is no corner. */
static rg_gid *number_vertices(const rg_import *m, const struct numbered *order, rg_mesh *mesh) {
    rg_gid *vertex = RG_NEW(rg_gid, m->nodes);
    for (size_t n = 0; n < m->nodes; n++) {
        vertex[n] = -1;
    }
    for (rg_gid i = 0; i < 4 * m->elements; i++) {
        vertex[m->corner[i]] = 0;
    }
    for (size_t n = 0; n < m->nodes; n++) {
        rg_gid *v = &vertex[order[n].row];
        *v = *v < 0 ? -1 : mesh->vertices++;
    }
    mesh->x = RG_NEW(double, 3 * (size_t)mesh->vertices);
    for (size_t n = 0; n < m->nodes; n++) {
        if (vertex[n] >= 0) {
            memcpy(mesh->x + 3 * vertex[n], m->x + 3 * n, 3 * sizeof *mesh->x);
        }
    }
    return vertex;
}

static int ascending(const void *a, const void *b) {
    rg_gid p = *(const rg_gid *)a, q = *(const rg_gid *)b;
    return (p > q) - (p < q);
}

static void fill_elements(const rg_import *m, const rg_gid *vertex, rg_mesh *mesh) {
    size_t count = (size_t)m->elements;
    mesh->elements = m->elements;
    mesh->corner = RG_NEW(rg_gid, 4 * count);
    mesh->neighbour = RG_NEW(rg_gid, 4 * count);
    mesh->face = RG_NEW(int8_t, 4 * count);
    mesh->set = RG_NEW(int32_t, 4 * count);
    mesh->region = RG_NEW(int32_t, count);
    mesh->original = RG_NEW(rg_gid, count);
    memcpy(mesh->region, m->region, count * sizeof *m->region);
    memcpy(mesh->original, m->name, count * sizeof *m->name);
    for (size_t e = 0; e < count; e++) {
        for (size_t i = 0; i < 4; i++) {
            mesh->corner[4 * e + i] = vertex[m->corner[4 * e + i]];
            mesh->set[4 * e + i] = -1;
        }
        qsort(mesh->corner + 4 * e, 4, sizeof *mesh->corner, ascending);
    }
}

static void tell_orientation(const rg_import *m) {
    if (m->inverted > 0) {
        rg_warn("%s: %" PRId64 " of %" PRId64
                " elements have their corners in the order of a negative volume, the "
                "first of them %" PRId64 ": they are taken as if they had not",
                m->path, m->inverted, m->elements, m->first_inverted);
    }
}

static void tell_nodes(const rg_import *m, const struct numbered *order, const rg_gid *vertex) {
    int64_t unused = 0;
    size_t first = 0, last = SIZE_MAX; /* a number that no node has */
    for (size_t n = 0; n < m->nodes; n++) {
        bool again = order[n].number == last || (m->twin != NULL && m->twin[order[n].row] != order[n].row);
        last = order[n].number;
        if (!again && vertex[order[n].row] < 0) {
            first = unused++ == 0 ? order[n].row : first;
        }
    }
    if (m->bent > 0) {
        rg_warn("%s: second-order elements are taken by their corners: %" PRId64 " of %" PRId64
                " mid-nodes are off straight by more than %g of their edge, by %.2g at most",
                m->path, m->bent, m->middles, straight, m->worst);
    }
    if (unused > 0 && m->middles == 0) {
        const double *x = m->x + 3 * first;
        rg_warn("%s: %" PRId64
                " nodes belong to no tetrahedron and are left out; the first is node %zu at (%g, "
                "%g, %g) m",
                m->path, unused, m->number[first], x[0], x[1], x[2]);
    }
}

/* ---- names of faces ---- */

/* A triangle of the input, or (FACE) a face of the mesh. */
enum { FACE = RG_IMPORT_UNNAMED - 1 };

struct triangle {
    rg_lid vertex[3]; /* ascending */
    int32_t set;
    rg_gid name; /* of the input: its number; a face: 4 * element + face */
};

/* Named ones by their sets, unnamed ones, then the faces in the order of the elements. */
static int by_vertices(const void *a, const void *b) {
    const struct triangle *p = a, *q = b;
    for (int i = 0; i < 3; i++) {
        if (p->vertex[i] != q->vertex[i]) {
            return p->vertex[i] < q->vertex[i] ? -1 : 1;
        }
    }
    if (p->set != q->set) {
        bool named = p->set >= 0 && q->set >= 0;
        return (p->set < q->set) == named ? -1 : 1;
    }
    return (p->name > q->name) - (p->name < q->name);
}

/* A face of one element. */
struct side {
    rg_gid slot;                   /* 4 * element + face */
    const struct triangle *vertex; /* any triangle there; from it on the named ones */
    size_t named;
};

enum {
    OF_NODE_SET = 1,
    OF_FACE = 2 /* of a triangle of the input, or an element whose outer faces are in sets */
};

struct surface {
    struct side *face; /* of the surface, by vertices, ascending */
    size_t faces, room;
    struct side *inner; /* both sides of named faces between two elements */
    size_t inners, inner_room;
    unsigned char *mark; /* [vertices]: OF_NODE_SET, OF_FACE; those of 0 are of no face that matters here */
    struct side
        *within; /* both sides of faces between two elements whose vertices all are in sets of nodes */
    size_t withins, within_room;
    int64_t inside, nowhere; /* named faces between two elements; triangles that are no faces */
};

/* One group of equal triangles: the named ones come first, then the unnamed ones, then the faces. */
static void look_at_group(const struct triangle *t, size_t count, rg_mesh *mesh, struct surface *s) {
    size_t named = 0, triangles = 0;
    for (size_t i = 0; i < count; i++) {
        named += t[i].set >= 0;
        triangles += t[i].set != FACE;
    }
    size_t faces = count - triangles;
    s->inside += named > 0 && faces > 1;
    s->nowhere += named > 0 && faces == 0;
    if (faces == 1) {
        s->face = rg_grow(s->face, &s->room, s->faces, sizeof *s->face);
        s->face[s->faces++] = (struct side){t[triangles].name, t, named};
    }
    for (size_t i = triangles; named > 0 && faces > 1 && i < count; i++) {
        s->inner = rg_grow(s->inner, &s->inner_room, s->inners, sizeof *s->inner);
        s->inner[s->inners++] = (struct side){t[i].name, t, named};
    }
    bool within = faces > 1 &&
                  (s->mark[t->vertex[0]] & s->mark[t->vertex[1]] & s->mark[t->vertex[2]] & OF_NODE_SET) != 0;
    for (size_t i = triangles; within && i < count; i++) {
        s->within = rg_grow(s->within, &s->within_room, s->withins, sizeof *s->within);
        s->within[s->withins++] = (struct side){t[i].name, t, named};
    }
    if (triangles > 0 && faces > 1) {
        for (int i = 0; i < 3; i++) {
            mesh->inner[3 * mesh->inners + (size_t)i] = t->vertex[i];
        }
        mesh->inners++;
    }
}

static void swap_if_less(rg_lid *a, rg_lid *b) {
    rg_lid low = *a < *b ? *a : *b, high = *a < *b ? *b : *a;
    *a = low;
    *b = high;
}

static void sort_three(rg_lid v[3]) {
    swap_if_less(&v[0], &v[1]);
    swap_if_less(&v[1], &v[2]);
    swap_if_less(&v[0], &v[1]);
}

/* Vertices of all faces that may come into sets: most faces have others, and need not be sorted. */
static void mark_vertices(rg_import *m, const rg_gid *vertex, const rg_mesh *mesh, struct surface *s) {
    s->mark = RG_NEW(unsigned char, (size_t)mesh->vertices);
    for (size_t i = 0; i < m->points; i++) {
        size_t row = row_of(m, m->point[i].node);
        if (row < SIZE_MAX && vertex[row] >= 0) {
            s->mark[vertex[row]] |= OF_NODE_SET;
        }
    }
    for (size_t i = 0; i < 3 * m->faces; i++) {
        size_t row = row_of(m, m->face[i / 3].node[i % 3]);
        if (row < SIZE_MAX && vertex[row] >= 0) {
            s->mark[vertex[row]] |= OF_FACE;
        }
    }
    for (rg_gid e = 0; m->skin != NULL && e < mesh->elements; e++) {
        for (int i = 0; m->skin[e] >= 0 && i < 4; i++) {
            s->mark[mesh->corner[4 * e + i]] |= OF_FACE;
        }
    }
}

/* The input's triangles that have corners, then the faces of the mesh that may be in sets. */
static struct triangle *list_triangles(rg_import *m, const rg_gid *vertex, const rg_mesh *mesh, size_t *count,
                                       struct surface *s) {
    struct triangle *list = RG_NEW(struct triangle, m->faces + 4 * (size_t)mesh->elements);
    *count = 0;
    for (size_t i = 0; i < m->faces; i++) {
        const rg_import_face *face = &m->face[i];
        struct triangle t = {.name = face->name, .set = face->set};
        bool known = true;
        for (int k = 0; k < 3; k++) {
            size_t n = row_of(m, face->node[k]);
            t.vertex[k] = n < SIZE_MAX ? (rg_lid)vertex[n] : -1;
            known = known && t.vertex[k] >= 0;
        }
        sort_three(t.vertex);
        list[*count] = t;
        *count += known;
        s->nowhere += !known && t.set >= 0;
    }
    for (rg_gid slot = 0; slot < 4 * mesh->elements; slot++) {
        struct triangle t = {.name = slot, .set = FACE};
        for (int k = 0; k < 3; k++) {
            t.vertex[k] = (rg_lid)mesh->corner[slot / 4 * 4 + rg_face_node[slot % 4][k]];
        }
        if (s->mark[t.vertex[0]] != 0 && s->mark[t.vertex[1]] != 0 && s->mark[t.vertex[2]] != 0) {
            list[(*count)++] = t;
        }
    }
    return list;
}

static void tell_faces(const rg_import *m, const struct surface *s) {
    if (s->inside > 0) {
        rg_warn("%s: %" PRId64
                " faces of surface sets lie between elements: interface.sets may name them, boundary leaves "
                "them out",
                m->path, s->inside);
    }
    if (s->nowhere > 0) {
        rg_warn("%s: %" PRId64 " triangles of surface sets are no faces of tetrahedra: left out", m->path,
                s->nowhere);
    }
}

/* ---- sets of nodes ---- */

/* The nodes of one set, and what it becomes. */
struct node_set {
    const rg_import_point *point;
    size_t points;
    int32_t set; /* of the surface; -1: none */
    bool inside; /* it holds no face of the surface, but some between elements */
};

static int by_set(const void *a, const void *b) {
    const rg_import_point *p = a, *q = b;
    if (p->set != q->set) {
        return p->set < q->set ? -1 : 1;
    }
    return (p->node > q->node) - (p->node < q->node);
}

/* The first face whose lowest vertex is not below `v`. */
static size_t first_face(const struct side *face, size_t faces, rg_gid v) {
    size_t low = 0, high = faces;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (face[middle].vertex->vertex[0] < v) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

/* Vertices of a set of nodes: marked with its number. */
struct marks {
    rg_import *import;
    const rg_gid *vertex; /* of rows */
    int32_t *mark;        /* [vertices] */
    rg_sets_joining *joining;
};

static rg_gid vertex_of(const struct marks *k, size_t node) {
    size_t row = row_of(k->import, node);
    return row < SIZE_MAX ? k->vertex[row] : -1;
}

/* Puts the faces all of whose vertices have `mark` into the set, or without one only counts them: those of
 * the surface, or if it is `inside` both sides of those between elements. */
static int64_t take_faces(const struct marks *k, const struct node_set *n, const struct surface *s,
                          int32_t mark, rg_mesh *mesh) {
    const struct side *face = n->inside ? s->within : s->face;
    size_t faces = n->inside ? s->withins : s->faces;
    int64_t count = 0;
    for (size_t i = 0; i < n->points; i++) {
        rg_gid v = vertex_of(k, n->point[i].node);
        bool again = i > 0 && n->point[i].node == n->point[i - 1].node;
        for (size_t f = v < 0 || again ? faces : first_face(face, faces, v);
             f < faces && face[f].vertex->vertex[0] == v; f++) {
            const rg_lid *corner = face[f].vertex->vertex;
            if (k->mark[corner[1]] == mark && k->mark[corner[2]] == mark) {
                int32_t *group = &mesh->set[face[f].slot];
                *group = n->set >= 0 ? rg_sets_join(k->joining, *group, n->set) : *group;
                count++;
            }
        }
    }
    return count;
}

static void mark_nodes(const struct marks *k, const struct node_set *n, int32_t mark) {
    for (size_t i = 0; i < n->points; i++) {
        rg_gid v = vertex_of(k, n->point[i].node);
        if (v >= 0) {
            k->mark[v] = mark;
        }
    }
}

/* Adds a name to a list for a message, which keeps the first few. */
static void note_name(char *text, size_t size, const char *name, int64_t before) {
    size_t used = strlen(text);
    if (before < 5) {
        snprintf(text + used, size - used, "%s'%s'", before > 0 ? ", " : "", name);
    } else if (before == 5) {
        snprintf(text + used, size - used, ", ...");
    }
}

/* Which sets of nodes become surface sets. */
static void choose_node_sets(struct marks *k, struct node_set *sets, const struct surface *s, rg_mesh *mesh) {
    rg_import *m = k->import;
    char without[400] = "", taken[400] = "";
    int64_t withouts = 0, takens = 0;
    for (int32_t i = 0; i < m->node_set.count; i++) {
        const char *name = m->node_set.name[i];
        mark_nodes(k, &sets[i], i + 1);
        sets[i].inside = take_faces(k, &sets[i], s, i + 1, mesh) == 0;
        if (sets[i].inside && take_faces(k, &sets[i], s, i + 1, mesh) == 0) {
            note_name(without, sizeof without, name, withouts++);
        } else if (rg_sets_find(&m->surface, name) >= 0) {
            note_name(taken, sizeof taken, name, takens++);
        } else {
            sets[i].set = rg_sets_add(&m->surface, name);
        }
    }
    if (withouts > 0) {
        rg_warn("%s: %" PRId64 " sets of nodes hold no whole face and are left out: %s", m->path, withouts,
                without);
    }
    if (takens > 0) {
        rg_warn("%s: %" PRId64 " sets of nodes are left out, for there are surfaces of their names: %s",
                m->path, takens, taken);
    }
}

static struct node_set *list_node_sets(rg_import *m) {
    struct node_set *sets = RG_NEW(struct node_set, (size_t)m->node_set.count + 1);
    if (m->points > 0) {
        qsort(m->point, m->points, sizeof *m->point, by_set);
    }
    for (int32_t i = 0; i < m->node_set.count; i++) {
        sets[i].set = -1;
    }
    for (size_t i = 0; i < m->points; i++) {
        struct node_set *n = &sets[m->point[i].set];
        n->point = n->points == 0 ? &m->point[i] : n->point;
        n->points++;
    }
    return sets;
}

/* ---- all faces ---- */

/* The sets of a face by name. */
static void put_named(struct marks *k, const struct side *face, int32_t *group) {
    for (size_t i = 0; i < face->named; i++) {
        *group = rg_sets_join(k->joining, *group, face->vertex[i].set);
    }
}

/* The sets of a face of the surface: by name, and by its element. */
static void put_face(struct marks *k, const struct side *face, int32_t *group) {
    const rg_import *m = k->import;
    int32_t count = 0;
    const int32_t *skin =
        m->skin != NULL ? rg_sets_of(&m->skin_sets, &m->skin[face->slot / 4], &count) : NULL;
    put_named(k, face, group);
    for (int32_t s = 0; s < count; s++) {
        *group = rg_sets_join(k->joining, *group, skin[s]);
    }
}

static void put_into_sets(struct marks *k, const struct node_set *sets, const struct surface *s,
                          rg_mesh *mesh) {
    for (size_t f = 0; f < s->faces; f++) {
        put_face(k, &s->face[f], &mesh->set[s->face[f].slot]);
    }
    for (size_t f = 0; f < s->inners; f++) {
        put_named(k, &s->inner[f], &mesh->set[s->inner[f].slot]);
    }
    for (int32_t i = 0; i < k->import->node_set.count; i++) {
        if (sets[i].set >= 0) {
            mark_nodes(k, &sets[i], -1 - i);
            take_faces(k, &sets[i], s, -1 - i, mesh);
        }
    }
}

static void mark_faces(rg_import *m, const rg_gid *vertex, rg_mesh *mesh) {
    struct surface s = {.faces = 0};
    size_t count;
    mark_vertices(m, vertex, mesh, &s);
    struct triangle *list = list_triangles(m, vertex, mesh, &count, &s);
    mesh->inner = RG_NEW(rg_gid, 3 * m->faces + 1);
    qsort(list, count, sizeof *list, by_vertices);
    for (size_t i = 0, n; i < count; i += n) {
        for (n = 1; i + n < count && memcmp(list[i].vertex, list[i + n].vertex, sizeof list->vertex) == 0;
             n++) {
        }
        look_at_group(list + i, n, mesh, &s);
    }
    tell_faces(m, &s);
    rg_sets_joining joining = {.sets = &m->surface};
    struct marks k = {m, vertex, RG_NEW(int32_t, (size_t)mesh->vertices), &joining};
    struct node_set *sets = list_node_sets(m);
    choose_node_sets(&k, sets, &s, mesh);
    put_into_sets(&k, sets, &s, mesh);
    rg_sets_joined(&joining);
    rg_free(k.mark);
    rg_free(sets);
    rg_free(s.face);
    rg_free(s.inner);
    rg_free(s.within);
    rg_free(s.mark);
    rg_free(list);
}

/* Named edges of a solid, which --improve keeps. */
static void keep_lines(rg_import *m, const rg_gid *vertex, rg_mesh *mesh) {
    size_t edges = m->how.thickness > 0 ? 0 : m->edges; /* those of a plate are faces by now */
    mesh->line = edges > 0 ? RG_NEW(rg_gid, 2 * edges) : NULL;
    for (size_t i = 0; i < edges; i++) {
        size_t from = row_of(m, m->edge[i].node[0]), to = row_of(m, m->edge[i].node[1]);
        rg_gid a = from < SIZE_MAX ? vertex[from] : -1, b = to < SIZE_MAX ? vertex[to] : -1;
        if (a >= 0 && b >= 0 && a != b) {
            mesh->line[2 * mesh->lines] = a < b ? a : b;
            mesh->line[2 * mesh->lines++ + 1] = a < b ? b : a;
        }
    }
    if (m->edge_set.count > 0) {
        rg_warn("%s: sets of edges name no faces: %d are left out, but --improve keeps their places", m->path,
                m->edge_set.count);
    }
    rg_sets_free(&m->edge_set);
}

rg_mesh *rg_import_finish(rg_import *m) {
    m->how.thickness > 0 ? rg_extrude(m) : (void)0;
    if (m->elements == 0) {
        rg_fatal(RG_USAGE, "%s: no tetrahedra", m->path);
    }
    rg_mesh *mesh = RG_NEW(rg_mesh, 1);
    struct numbered *order = sort_nodes(m);
    rg_gid *vertex = number_vertices(m, order, mesh);
    fill_elements(m, vertex, mesh);
    tell_orientation(m);
    tell_nodes(m, order, vertex);
    mark_faces(m, vertex, mesh);
    keep_lines(m, vertex, mesh);
    mesh->surface = m->surface;
    mesh->volume = m->volume;
    rg_sets_joined(&m->volumes);
    rg_sets_joined(&m->skins);
    rg_sets_free(&m->skin_sets);
    rg_sets_free(&m->node_set);
    rg_free(vertex);
    rg_free(order);
    rg_gid_map_free(&m->row);
    rg_free(m->x);
    rg_free(m->number);
    rg_free(m->corner);
    rg_free(m->name);
    rg_free(m->region);
    rg_free(m->face);
    rg_free(m->edge);
    rg_free(m->point);
    rg_free(m->skin);
    rg_free(m->twin);
    return mesh;
}
