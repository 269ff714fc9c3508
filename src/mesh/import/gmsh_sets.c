#include "mesh/import/gmsh_sets.h"

#include <gmshc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/mem.h"
#include "mesh/rows.h"

/* ---- groups ---- */

/* Gmsh cuts names of files behind 253 bytes, so that such a name may have been longer. */
enum { LONGEST_NAME = 252 };

/* The group's name, or its number if it has none. */
static char *group_name(const char *path, int dimension, int group) {
    char *given = NULL, *name = RG_NEW(char, RG_SET_NAME);
    int error;
    gmshModelGetPhysicalName(dimension, group, &given, &error);
    rg_gmsh_require(path, error);
    if (strlen(given) > LONGEST_NAME) {
        rg_fatal(RG_USAGE, "%s: physical group '%s...': its name is longer than %d bytes, and Gmsh cut it",
                 path, given, LONGEST_NAME);
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
static int32_t set_of(rg_gmsh_sets *s, const char *path, int group) {
    char *name = group_name(path, s->dimension, group);
    int32_t set = rg_sets_find(&s->sets, name);
    set = set < 0 ? rg_sets_add(&s->sets, name) : set;
    rg_free(name);
    return set;
}

/* Formats without names (Nastran, Medit, STEP) number their entities: the numbers become sets. */
static void name_entities(rg_gmsh_sets *s) {
    for (size_t i = 0; i < s->entities; i++) {
        char name[RG_SET_NAME];
        snprintf(name, sizeof name, "%d", s->entity[i].tag);
        s->entity[i].group = rg_sets_add(&s->sets, name);
    }
}

rg_gmsh_sets rg_gmsh_entities(const char *path, int dimension) {
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
    return s;
}

static int by_tag(const void *a, const void *b) {
    const struct rg_gmsh_entity *p = a, *q = b;
    return (p->tag > q->tag) - (p->tag < q->tag);
}

/* An entity of a physical group. */
struct member {
    int32_t set;
    int tag;
};

static int by_set(const void *a, const void *b) {
    const struct member *p = a, *q = b;
    if (p->set != q->set) {
        return p->set < q->set ? -1 : 1;
    }
    return (p->tag > q->tag) - (p->tag < q->tag);
}

static void assign(rg_gmsh_sets *s, struct member *member, size_t members) {
    rg_sets_joining joining = {.sets = &s->sets};
    qsort(s->entity, s->entities, sizeof *s->entity, by_tag);
    qsort(member, members, sizeof *member, by_set);
    for (size_t i = 0; i < members; i++) {
        struct rg_gmsh_entity key = {member[i].tag, 0};
        struct rg_gmsh_entity *e = bsearch(&key, s->entity, s->entities, sizeof *s->entity, by_tag);
        if (e != NULL) {
            e->group = rg_sets_join(&joining, e->group, member[i].set);
        }
    }
    rg_sets_joined(&joining);
}

rg_gmsh_sets rg_gmsh_sets_read(const char *path, int dimension) {
    rg_gmsh_sets s = rg_gmsh_entities(path, dimension);
    int *pair = NULL, error;
    size_t numbers = 0, members = 0, room = 0;
    struct member *member = rg_grow(NULL, &room, 0, sizeof *member);
    gmshModelGetPhysicalGroups(&pair, &numbers, dimension, &error);
    rg_gmsh_require(path, error);
    for (size_t i = 0; i < numbers / 2; i++) {
        int *tag = NULL;
        int32_t set = set_of(&s, path, pair[2 * i + 1]);
        size_t tags = 0;
        gmshModelGetEntitiesForPhysicalGroup(dimension, pair[2 * i + 1], &tag, &tags, &error);
        rg_gmsh_require(path, error);
        for (size_t k = 0; k < tags; k++) {
            member = rg_grow(member, &room, members, sizeof *member);
            member[members++] = (struct member){set, abs(tag[k])};
        }
        gmshFree(tag);
    }
    gmshFree(pair);
    s.named = numbers > 0;
    if (!s.named) {
        name_entities(&s);
    }
    assign(&s, member, members);
    rg_free(member);
    return s;
}

void rg_gmsh_sets_free(rg_gmsh_sets *s) {
    rg_sets_free(&s->sets);
    rg_free(s->entity);
}

void rg_gmsh_each(const char *path, const rg_gmsh_sets *s, void (*take)(void *, const rg_gmsh_block *),
                  void *context) {
    for (size_t i = 0; i < s->entities; i++) {
        int *type = NULL, error;
        size_t types = 0, *tags = NULL, *nodes = NULL, n1 = 0, n2 = 0, **tag = NULL, **node = NULL;
        gmshModelMeshGetElements(&type, &types, &tag, &tags, &n1, &node, &nodes, &n2, s->dimension,
                                 s->entity[i].tag, &error);
        rg_gmsh_require(path, error);
        for (size_t k = 0; k < types; k++) {
            rg_gmsh_block block = {.type = type[k], .count = tags[k], .tag = tag[k], .node = node[k]};
            block.set = rg_sets_of(&s->sets, &s->entity[i].group, &block.sets);
            take(context, &block);
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
