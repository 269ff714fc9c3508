#include "gmsh_sets.h"

#include <gmshc.h>
#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../kernels/layout.h"
#include "error.h"
#include "mem.h"
#include "mesh_rows.h"

/* Gmsh's types of triangles. */
enum { TRI3 = 2, TRI6 = 9 };

/* ---- groups ---- */

/* The group's name, or its number if it has none. */
static char *group_name(const char *path, int dimension, int group) {
    char *given = NULL, *name = RG_NEW(char, RG_SET_NAME);
    int error;
    gmshModelGetPhysicalName(dimension, group, &given, &error);
    rg_gmsh_require(path, error);
    if (strlen(given) >= RG_SET_NAME) {
        rg_fatal(RG_USAGE, "%s: physical group '%s': its name is longer than %d bytes", path, given,
                 RG_SET_NAME - 1);
    }
    if (given[0] != '\0') {
        strcpy(name, given);
    } else {
        snprintf(name, RG_SET_NAME, "%d", group);
    }
    gmshFree(given);
    return name;
}

/* Two groups of the same name are one set. */
static int set_of(rg_gmsh_sets *s, const char *path, int group) {
    char *name = group_name(path, s->dimension, group);
    for (int i = 0; i < s->count; i++) {
        if (strcmp(s->name[i], name) == 0) {
            rg_free(name);
            return i;
        }
    }
    if (s->count == RG_MAX_SETS) {
        rg_fatal(RG_USAGE, "%s: more than %d physical groups of dimension %d", path, RG_MAX_SETS,
                 s->dimension);
    }
    s->name[s->count] = name;
    return s->count++;
}

static void assign(rg_gmsh_sets *s, const char *path, int tag, int set) {
    size_t i = 0;
    while (i < s->entities && s->entity[i].tag != tag) {
        i++;
    }
    if (i == s->entities) {
        return;
    }
    if (s->entity[i].set >= 0 && s->entity[i].set != set) {
        rg_fatal(RG_USAGE, "%s: %s %d is in two physical groups, '%s' and '%s'; it can be in one set only",
                 path, s->dimension == 2 ? "surface" : "volume", tag, s->name[s->entity[i].set],
                 s->name[set]);
    }
    s->entity[i].set = set;
}

rg_gmsh_sets rg_gmsh_sets_read(const char *path, int dimension) {
    rg_gmsh_sets s = {.dimension = dimension};
    int *pair = NULL, error;
    size_t numbers = 0;
    gmshModelGetEntities(&pair, &numbers, dimension, &error);
    rg_gmsh_require(path, error);
    s.entities = numbers / 2;
    s.entity = RG_NEW(struct rg_gmsh_entity, s.entities + 1);
    for (size_t i = 0; i < s.entities; i++) {
        s.entity[i] = (struct rg_gmsh_entity){pair[2 * i + 1], -1};
    }
    gmshFree(pair);
    gmshModelGetPhysicalGroups(&pair, &numbers, dimension, &error);
    rg_gmsh_require(path, error);
    for (size_t i = 0; i < numbers / 2; i++) {
        int *tag = NULL, set = set_of(&s, path, pair[2 * i + 1]);
        size_t tags = 0;
        gmshModelGetEntitiesForPhysicalGroup(dimension, pair[2 * i + 1], &tag, &tags, &error);
        rg_gmsh_require(path, error);
        for (size_t k = 0; k < tags; k++) {
            assign(&s, path, abs(tag[k]), set);
        }
        gmshFree(tag);
    }
    gmshFree(pair);
    return s;
}

void rg_gmsh_sets_free(rg_gmsh_sets *s) {
    rg_free(s->entity);
}

void rg_gmsh_each(const char *path, const rg_gmsh_sets *s,
                  void (*take)(void *, int, const size_t *, size_t, const size_t *, int), void *context) {
    for (size_t i = 0; i < s->entities; i++) {
        int *type = NULL, error;
        size_t types = 0, *tags = NULL, *nodes = NULL, n1 = 0, n2 = 0, **tag = NULL, **node = NULL;
        gmshModelMeshGetElements(&type, &types, &tag, &tags, &n1, &node, &nodes, &n2, s->dimension,
                                 s->entity[i].tag, &error);
        rg_gmsh_require(path, error);
        for (size_t k = 0; k < types; k++) {
            take(context, type[k], tag[k], tags[k], node[k], s->entity[i].set);
            gmshFree(tag[k]);
            gmshFree(node[k]);
        }
        gmshFree(tag);
        gmshFree(node);
        gmshFree(tags);
        gmshFree(nodes);
        gmshFree(type);
    }
}

/* ---- surfaces ---- */

struct triangle {
    rg_gid vertex[3]; /* ascending */
    rg_gid name;      /* of a triangle of Gmsh: its tag; of a face: 4 * element + face */
    int set;          /* of a triangle of Gmsh; -1 of a face */
};

struct triangles {
    struct triangle *list;
    size_t count, room;
    const char *path;
    const rg_gid *vertex;
    size_t most;
    int64_t strange; /* triangles with nodes that no tetrahedron has */
};

static void add(struct triangles *all, const struct triangle *t) {
    if (all->count == all->room) {
        all->room = 2 * all->room + 64;
        all->list = rg_realloc(all->list, all->room, sizeof *all->list);
    }
    all->list[all->count++] = *t;
}

static void sort3(rg_gid v[3]) {
    for (int i = 0; i < 3; i++) {
        int a = i == 1 ? 1 : 0, b = a + 1;
        if (v[a] > v[b]) {
            rg_gid t = v[a];
            v[a] = v[b];
            v[b] = t;
        }
    }
}

static void take_triangles(void *context, int type, const size_t *tag, size_t count, const size_t *node,
                           int set) {
    struct triangles *all = context;
    size_t each = type == TRI3 ? 3 : 6;
    if (set < 0) {
        return;
    }
    if (type != TRI3 && type != TRI6) {
        rg_fatal(RG_USAGE, "%s: surface element %zu of a physical surface is no triangle", all->path, tag[0]);
    }
    for (size_t i = 0; i < count; i++) {
        struct triangle t = {.name = (rg_gid)tag[i], .set = set};
        bool known = true;
        for (size_t k = 0; k < 3; k++) {
            size_t n = node[each * i + k];
            t.vertex[k] = n <= all->most ? all->vertex[n] : -1;
            known = known && t.vertex[k] >= 0;
        }
        sort3(t.vertex);
        all->strange += !known;
        if (known) {
            add(all, &t);
        }
    }
}

/* Triangles before the faces that they name; faces in the order of the elements. */
static int by_vertices(const void *a, const void *b) {
    const struct triangle *p = a, *q = b;
    for (int i = 0; i < 3; i++) {
        if (p->vertex[i] != q->vertex[i]) {
            return p->vertex[i] < q->vertex[i] ? -1 : 1;
        }
    }
    if ((p->set < 0) != (q->set < 0)) {
        return p->set < 0 ? 1 : -1;
    }
    return (p->name > q->name) - (p->name < q->name);
}

static bool same(const struct triangle *p, const struct triangle *q) {
    return memcmp(p->vertex, q->vertex, sizeof p->vertex) == 0;
}

struct tally {
    int64_t inside, nowhere; /* triangles between two elements; that are no faces */
};

/* One group of equal triangles: names come first, then the faces. */
static void mark_group(const struct triangle *t, size_t count, const rg_gmsh_sets *s, const char *path,
                       rg_mesh *mesh, struct tally *tally) {
    size_t names = 0;
    while (names < count && t[names].set >= 0) {
        if (t[names].set != t[0].set) {
            rg_fatal(RG_USAGE,
                     "%s: triangles %" PRId64 " and %" PRId64
                     " are the same face, in sets '%s' and '%s'; it can be in one only",
                     path, t[0].name, t[names].name, s->name[t[0].set], s->name[t[names].set]);
        }
        names++;
    }
    size_t faces = count - names;
    tally->inside += names > 0 && faces > 1;
    tally->nowhere += names > 0 && faces == 0;
    if (names > 0 && faces == 1) {
        mesh->set[t[names].name] = (int8_t)t[0].set;
    }
}

static void add_faces(struct triangles *all, const rg_mesh *mesh) {
    for (rg_gid slot = 0; slot < 4 * mesh->elements; slot++) {
        struct triangle t = {.name = slot, .set = -1};
        for (int k = 0; k < 3; k++) {
            t.vertex[k] = mesh->corner[slot / 4 * 4 + rg_face_node[slot % 4][k]];
        }
        add(all, &t);
    }
}

void rg_gmsh_mark_surfaces(const char *path, const rg_gmsh_sets *s, const rg_gid *vertex, size_t most,
                           rg_mesh *mesh) {
    struct triangles all = {.path = path, .vertex = vertex, .most = most};
    struct tally tally = {0, 0};
    rg_gmsh_each(path, s, take_triangles, &all);
    add_faces(&all, mesh);
    qsort(all.list, all.count, sizeof *all.list, by_vertices);
    for (size_t i = 0, n; i < all.count; i += n) {
        for (n = 1; i + n < all.count && same(all.list + i, all.list + i + n); n++) {
        }
        mark_group(all.list + i, n, s, path, mesh, &tally);
    }
    if (tally.inside > 0) {
        rg_warn("%s: %" PRId64
                " faces of physical surfaces lie between elements, not on the surface: in no set",
                path, tally.inside);
    }
    if (tally.nowhere + all.strange > 0) {
        rg_warn("%s: %" PRId64 " triangles of physical surfaces are no faces of tetrahedra: left out", path,
                tally.nowhere + all.strange);
    }
    rg_free(all.list);
}
