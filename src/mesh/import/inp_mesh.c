#include "mesh/import/inp_mesh.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "base/mem.h"
#include "mesh/import/solid.h"

typedef struct {
    rg_inp_model *model;
    rg_import import;
    rg_gid *element; /* [elements of the model + 1]: those of the import begin here, and end with the next */
    int64_t missing; /* members of sets that are not there */
    rg_gid first_missing;
    const char *in;
} building;

/* ---- nodes and elements ---- */

static void take_nodes(building *b) {
    const rg_inp_model *m = b->model;
    for (size_t n = 0; n < m->nodes.count; n++) {
        rg_import_node(&b->import, (size_t)m->nodes.number[n], m->x + 3 * n);
    }
}

static bool is_solid(int kind) {
    return kind > 3 && kind != RG_INP_CORNERS_4;
}

static bool is_flat(int kind) {
    return kind == 3 || kind == RG_INP_CORNERS_4;
}

static void take_tetrahedron(building *b, size_t e) {
    const rg_inp_model *m = b->model;
    const uint32_t *from = m->node + m->start[e];
    size_t node[10];
    for (int k = 0; k < m->kind[e]; k++) {
        node[k] = from[k];
    }
    if (m->kind[e] == 10) { /* the last two middles stand the other way round */
        node[8] = from[9];
        node[9] = from[8];
    }
    rg_import_element(&b->import, m->elements.number[e], m->kind[e], node);
}

static void take_split(building *b, size_t e) {
    const rg_inp_model *m = b->model;
    size_t node[8];
    for (int k = 0; k < m->kind[e]; k++) {
        node[k] = m->node[m->start[e] + (size_t)k];
    }
    rg_import_solid(&b->import, m->elements.number[e], m->kind[e], node);
}

static void take_elements(building *b) {
    const rg_inp_model *m = b->model;
    b->element = RG_NEW(rg_gid, m->elements.count + 1);
    for (size_t e = 0; e < m->elements.count; e++) {
        b->element[e] = b->import.elements;
        if (m->kind[e] == 4 || m->kind[e] == 10) {
            take_tetrahedron(b, e);
        } else if (is_solid(m->kind[e])) {
            take_split(b, e);
        }
    }
    b->element[m->elements.count] = b->import.elements;
}

/* ---- sets ---- */

static bool is_utf8(const char *text) {
    const unsigned char *p = (const unsigned char *)text;
    while (*p != '\0') {
        size_t more = *p < 0x80 ? 0 : *p < 0xc2 ? 4 : *p < 0xe0 ? 1 : *p < 0xf0 ? 2 : *p < 0xf5 ? 3 : 4;
        for (p++; more > 0 && more < 4 && (*p & 0xc0) == 0x80; p++) {
            more--;
        }
        if (more > 0) {
            return false;
        }
    }
    return true;
}

/* Names as a case file can say them: what is no UTF-8 was written in Latin-1. False: it is too long. */
static bool put_as_utf8(const char *name, char out[RG_SET_NAME]) {
    bool as_it_is = is_utf8(name);
    size_t used = 0;
    for (; *name != '\0'; name++) {
        unsigned char c = (unsigned char)*name;
        bool two = !as_it_is && c >= 0x80;
        if (used + 1 + two >= RG_SET_NAME) {
            return false;
        }
        if (two) {
            out[used++] = (char)(0xc0 | c >> 6);
            c = 0x80 | (c & 0x3f);
        }
        out[used++] = (char)c;
    }
    out[used] = '\0';
    return true;
}

/* The name by which the mesh calls a set. Those of the only instance, and of no instance, have their own; of
 * several, "instance.set", as Abaqus calls them. */
static void name_of(const building *b, rg_inp_of of, const char *name, int scope, char out[RG_SET_NAME]) {
    const rg_inp_model *m = b->model;
    bool alone = scope == 0 || (m->scopes == 2 && rg_inp_find_set(m, of, name, 0) == NULL);
    char whole[2 * RG_SET_NAME];
    snprintf(whole, sizeof whole, "%s%s%s", alone ? "" : m->scope[scope].name, alone ? "" : ".", name);
    if (!put_as_utf8(whole, out)) {
        rg_fatal(RG_USAGE, "%s: set '%s' is longer than %d bytes", b->import.path, whole, RG_SET_NAME - 1);
    }
}

static int32_t need_set(rg_sets *sets, const char *name) {
    int32_t set = rg_sets_find(sets, name);
    return set >= 0 ? set : rg_sets_add(sets, name);
}

static rg_inp_members members_of(building *b, const rg_inp_set *s) {
    rg_inp_members found = rg_inp_members_of_set(b->model, s);
    if (found.missing > 0 && b->missing == 0) {
        b->first_missing = found.first;
        b->in = s->name;
    }
    b->missing += found.missing;
    return found;
}

/* Names of the sets of elements: of volumes where they have tetrahedra, of faces where they have triangles.
 */
static void name_element_sets(building *b) {
    char name[RG_SET_NAME];
    for (size_t i = 0; i < b->model->sets; i++) {
        const rg_inp_set *s = &b->model->set[i];
        if (s->of != RG_INP_ELEMENTS || s->internal) {
            continue;
        }
        rg_inp_members found = members_of(b, s);
        name_of(b, RG_INP_ELEMENTS, s->name, s->scope, name);
        bool tets = false, triangles = false, lines = false;
        for (size_t k = 0; k < found.count; k++) {
            tets = tets || is_solid(b->model->kind[found.row[k]]);
            triangles = triangles || is_flat(b->model->kind[found.row[k]]);
            lines = lines || b->model->kind[found.row[k]] == 2;
        }
        if (tets) {
            need_set(&b->import.volume, name);
        }
        if (triangles) {
            need_set(&b->import.surface, name);
        }
        if (lines) {
            need_set(&b->import.edge_set, name);
        }
        rg_free(found.row);
    }
}

static void add_face(building *b, size_t element, const size_t node[3], int32_t set) {
    rg_import_add_face(
        &b->import, (rg_import_face){{node[0], node[1], node[2]}, b->model->elements.number[element], set});
}

/* A triangle or a quadrangle. */
static void add_flat(building *b, size_t element, int32_t set) {
    const uint32_t *node = b->model->node + b->model->start[element];
    if (b->model->kind[element] == RG_INP_CORNERS_4) {
        rg_import_add_quadrangle(&b->import, (const size_t[]){node[0], node[1], node[2], node[3]},
                                 b->model->elements.number[element], set);
    } else {
        add_face(b, element, (const size_t[]){node[0], node[1], node[2]}, set);
    }
}

/* Of an element that is one or has some, by its nodes there. */
static void add_edge(building *b, size_t element, int from, int to, int32_t set) {
    const uint32_t *node = b->model->node + b->model->start[element];
    rg_import_add_edge(&b->import,
                       (rg_import_edge){{node[from], node[to]}, b->model->elements.number[element], set});
}

static void fill_element_sets(building *b) {
    char name[RG_SET_NAME];
    for (size_t i = 0; i < b->model->sets; i++) {
        const rg_inp_set *s = &b->model->set[i];
        if (s->of != RG_INP_ELEMENTS || s->internal) {
            continue;
        }
        name_of(b, RG_INP_ELEMENTS, s->name, s->scope, name);
        int32_t volume = rg_sets_find(&b->import.volume, name),
                surface = rg_sets_find(&b->import.surface, name);
        rg_inp_members found = rg_inp_members_of_set(b->model, s);
        for (size_t k = 0; k < found.count; k++) {
            size_t e = found.row[k];
            if (is_solid(b->model->kind[e])) {
                for (rg_gid tet = b->element[e]; tet < b->element[e + 1]; tet++) {
                    rg_import_put(&b->import, tet, volume);
                }
            } else if (is_flat(b->model->kind[e])) {
                add_flat(b, e, surface);
            } else if (b->model->kind[e] == 2) {
                add_edge(b, e, 0, 1, rg_sets_find(&b->import.edge_set, name));
            }
        }
        rg_free(found.row);
    }
}

/* Those that are to be extruded, also if they are in no set. */
static void take_triangles(building *b) {
    for (size_t e = 0; e < b->model->elements.count && b->import.how.thickness > 0; e++) {
        if (is_flat(b->model->kind[e])) {
            add_flat(b, e, RG_IMPORT_UNNAMED);
        }
    }
}

/* ---- surfaces ---- */

/* Of what is to be extruded: S1 to S3 of a triangle, S1 to S4 of a quadrangle. */
static void take_edge(building *b, const rg_inp_surface *s, const rg_inp_patch *p, int32_t set, size_t e) {
    int corners = b->model->kind[e] == 3 ? 3 : 4;
    if (p->face < 0 || p->face >= corners || !is_flat(b->model->kind[e])) {
        rg_inp_refuse(p->of.at, "*SURFACE, NAME=%s: of a %s that is extruded, S1 to S%d is expected", s->name,
                      corners == 3 ? "triangle" : "quadrangle", corners);
    }
    add_edge(b, e, p->face, (p->face + 1) % corners, set);
}

static void take_face(building *b, const rg_inp_surface *s, const rg_inp_patch *p, int32_t set, size_t e) {
    int kind = b->model->kind[e], count = 0;
    size_t triangle[2][3], node[8];
    if (kind == 0) {
        return; /* of an element that is left out, and said to be: it has no nodes here */
    }
    if (b->import.how.thickness > 0) { /* solids are refused in the end */
        is_solid(kind) ? (void)0 : take_edge(b, s, p, set, e);
        return;
    }
    if (is_flat(kind) && (p->face == RG_INP_FREE || p->face == RG_INP_SIDE)) {
        add_flat(b, e, set);
        return;
    }
    for (rg_gid tet = b->element[e]; p->face == RG_INP_FREE && tet < b->element[e + 1]; tet++) {
        rg_import_put_skin(&b->import, tet, set);
    }
    for (int k = 0; is_solid(kind) && k < (kind == 10 ? 4 : kind); k++) {
        node[k] = rg_import_number(&b->import, b->model->node[b->model->start[e] + (size_t)k]);
    }
    if (is_solid(kind) && p->face >= 0 && p->face < RG_SOLID_FACES) {
        count = rg_solid_face(kind, p->face, node, triangle);
    }
    for (int t = 0; t < count; t++) {
        add_face(b, e, triangle[t], set);
    }
    if (count == 0 && p->face != RG_INP_FREE) {
        rg_inp_refuse(p->of.at, "*SURFACE, NAME=%s: element %" PRId64 " has no such face", s->name,
                      b->model->elements.number[e]);
    }
}

/* Returns how many nodes or elements it names. */
static size_t take_patch(building *b, const rg_inp_surface *s, const rg_inp_patch *p, int32_t set) {
    rg_inp_members found = rg_inp_members_of_entry(b->model, s->of, &p->of);
    if (p->of.name == NULL && found.missing > 0) {
        rg_inp_refuse(p->of.at, "*SURFACE, NAME=%s: there is no %s %" PRId64, s->name,
                      s->of == RG_INP_NODES ? "node" : "element", found.first % RG_INP_OUTSIDE);
    }
    for (size_t k = 0; k < found.count; k++) {
        if (s->of == RG_INP_NODES) {
            rg_import_add_point(&b->import, (size_t)b->model->nodes.number[found.row[k]], set);
        } else {
            take_face(b, s, p, set, found.row[k]);
        }
    }
    rg_free(found.row);
    return found.count;
}

static int32_t need_surface(building *b, const rg_inp_surface *s) {
    char name[RG_SET_NAME];
    name_of(b, RG_INP_ELEMENTS, s->name, s->scope, name);
    return need_set(s->of == RG_INP_NODES         ? &b->import.node_set
                    : b->import.how.thickness > 0 ? &b->import.edge_set
                                                  : &b->import.surface,
                    name);
}

/* All names come before all faces: a set is put into combinations of those there are. */
static void take_surfaces(building *b, rg_inp_of of) {
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < b->model->surfaces; i++) {
            const rg_inp_surface *s = &b->model->surface[i];
            int32_t set = s->of == of ? need_surface(b, s) : -1;
            size_t named = 0;
            for (size_t k = 0; set >= 0 && pass == 1 && k < s->count; k++) {
                named += take_patch(b, s, &s->patch[k], set);
            }
            if (set >= 0 && pass == 1 && named == 0) {
                rg_warn("%s: *SURFACE, NAME=%s names no face at all", b->import.path, s->name);
            }
        }
    }
}

static void take_node_sets(building *b) {
    char name[RG_SET_NAME];
    for (size_t i = 0; i < b->model->sets; i++) {
        const rg_inp_set *s = &b->model->set[i];
        if (s->of != RG_INP_NODES || s->internal) {
            continue;
        }
        rg_inp_members found = members_of(b, s);
        name_of(b, RG_INP_NODES, s->name, s->scope, name);
        int32_t set = need_set(&b->import.node_set, name);
        for (size_t k = 0; k < found.count; k++) {
            rg_import_add_point(&b->import, (size_t)b->model->nodes.number[found.row[k]], set);
        }
        rg_free(found.row);
    }
}

/* ---- the whole ---- */

static void tell(const building *b) {
    if (b->model->moved > 0) {
        rg_warn("%s: %" PRId64 " nodes are given again at another place, which is the one that counts",
                b->import.path, b->model->moved);
    }
    if (b->missing > 0) {
        rg_warn("%s: %" PRId64 " members of sets are no nodes or elements of the mesh; the first is %" PRId64
                " in set '%s'",
                b->import.path, b->missing, b->first_missing, b->in);
    }
}

rg_mesh *rg_inp_mesh(const char *path, const rg_import_how *how, rg_inp_model *model) {
    building b = {.model = model, .import = {.path = path, .how = *how}};
    take_nodes(&b);
    take_elements(&b);
    name_element_sets(&b);
    fill_element_sets(&b);
    take_triangles(&b);
    take_surfaces(&b, RG_INP_ELEMENTS);
    take_surfaces(&b, RG_INP_NODES);
    take_node_sets(&b);
    tell(&b);
    rg_free(b.element);
    return rg_import_finish(&b.import);
}
