#include "mesh/import/inp_mesh.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "base/mem.h"
#include "mesh/import/import.h"

/* S1 to S4. */
static const int face_corner[4][3] = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};

typedef struct {
    rg_inp_model *model;
    rg_import import;
    rg_gid *element; /* [elements of the model]: that of the import, -1 for none */
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

static void take_elements(building *b) {
    const rg_inp_model *m = b->model;
    b->element = RG_NEW(rg_gid, m->elements.count + 1);
    for (size_t e = 0; e < m->elements.count; e++) {
        const uint32_t *from = m->node + m->start[e];
        size_t node[10];
        for (int k = 0; k < m->kind[e]; k++) {
            node[k] = from[k];
        }
        if (m->kind[e] == 10) { /* the last two middles stand the other way round */
            node[8] = from[9];
            node[9] = from[8];
        }
        b->element[e] = m->kind[e] > 3 ? b->import.elements : -1;
        if (m->kind[e] > 3) {
            rg_import_element(&b->import, m->elements.number[e], m->kind[e], node);
        }
    }
}

/* ---- sets ---- */

/* The name by which the mesh calls a set. Those of the only instance, and of no instance, have their own; of
 * several, "instance.set", as Abaqus calls them. */
static void name_of(const building *b, rg_inp_of of, const char *name, int scope, char out[RG_SET_NAME]) {
    const rg_inp_model *m = b->model;
    bool alone = scope == 0 || (m->scopes == 2 && rg_inp_find_set(m, of, name, 0) == NULL);
    size_t length = alone ? strlen(name) : strlen(m->scope[scope].name) + 1 + strlen(name);
    if (length >= RG_SET_NAME) {
        rg_fatal(RG_USAGE, "%s: set '%s.%s' is longer than %d bytes", b->import.path, m->scope[scope].name,
                 name, RG_SET_NAME - 1);
    }
    snprintf(out, RG_SET_NAME, "%s%s%s", alone ? "" : m->scope[scope].name, alone ? "" : ".", name);
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
        bool tets = false, triangles = false;
        for (size_t k = 0; k < found.count; k++) {
            tets = tets || b->model->kind[found.row[k]] > 3;
            triangles = triangles || b->model->kind[found.row[k]] == 3;
        }
        if (tets) {
            need_set(&b->import.volume, name);
        }
        if (triangles) {
            need_set(&b->import.surface, name);
        }
        rg_free(found.row);
    }
}

static void add_face(building *b, size_t element, const int corner[3], int32_t set) {
    const uint32_t *node = b->model->node + b->model->start[element];
    rg_import_add_face(&b->import, (rg_import_face){{node[corner[0]], node[corner[1]], node[corner[2]]},
                                                    b->model->elements.number[element],
                                                    set});
}

static void fill_element_sets(building *b) {
    static const int all[3] = {0, 1, 2};
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
            if (b->model->kind[e] > 3) {
                rg_import_put(&b->import, b->element[e], volume);
            } else if (b->model->kind[e] == 3) {
                add_face(b, e, all, surface);
            }
        }
        rg_free(found.row);
    }
}

/* ---- surfaces ---- */

static void take_face(building *b, const rg_inp_surface *s, const rg_inp_patch *p, int32_t set, size_t e) {
    static const int all[3] = {0, 1, 2};
    int kind = b->model->kind[e];
    if (kind == 0) {
        return; /* of an element that is left out, and said to be */
    }
    if (p->face == RG_INP_FREE) {
        if (kind > 3) {
            rg_import_put_skin(&b->import, b->element[e], set);
        }
    } else if ((p->face == RG_INP_SIDE) != (kind == 3)) {
        rg_inp_refuse(p->of.at, "*SURFACE, NAME=%s: element %" PRId64 " has no such face", s->name,
                      b->model->elements.number[e]);
    }
    if (kind == 3) {
        add_face(b, e, all, set);
    } else if (p->face >= 0) {
        add_face(b, e, face_corner[p->face], set);
    }
}

static void take_patch(building *b, const rg_inp_surface *s, const rg_inp_patch *p, int32_t set) {
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
}

static int32_t need_surface(building *b, const rg_inp_surface *s) {
    char name[RG_SET_NAME];
    name_of(b, RG_INP_ELEMENTS, s->name, s->scope, name);
    return need_set(s->of == RG_INP_NODES ? &b->import.node_set : &b->import.surface, name);
}

/* All names come before all faces: a set is put into combinations of those there are. */
static void take_surfaces(building *b, rg_inp_of of) {
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < b->model->surfaces; i++) {
            const rg_inp_surface *s = &b->model->surface[i];
            int32_t set = s->of == of ? need_surface(b, s) : -1;
            for (size_t k = 0; set >= 0 && pass == 1 && k < s->count; k++) {
                take_patch(b, s, &s->patch[k], set);
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

rg_mesh *rg_inp_mesh(const char *path, double scale, rg_inp_model *model) {
    building b = {.model = model, .import = {.path = path, .scale = scale}};
    take_nodes(&b);
    take_elements(&b);
    name_element_sets(&b);
    fill_element_sets(&b);
    take_surfaces(&b, RG_INP_ELEMENTS);
    take_surfaces(&b, RG_INP_NODES);
    take_node_sets(&b);
    tell(&b);
    rg_free(b.element);
    return rg_import_finish(&b.import);
}
