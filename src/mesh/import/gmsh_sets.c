#include "mesh/import/gmsh_sets.h"

#include <gmshc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/mem.h"
#include "mesh/rows.h"

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

/* Formats without names (Nastran, Medit, STEP) number their entities: the numbers become sets. */
static void name_entities(rg_gmsh_sets *s, const char *path) {
    if (s->entities > RG_MAX_SETS) {
        rg_warn("%s: %zu %s without physical groups are more than the %d that can be sets: in no set", path,
                s->entities, s->dimension == 2 ? "surfaces" : "volumes", RG_MAX_SETS);
        return;
    }
    for (size_t i = 0; i < s->entities; i++) {
        s->name[i] = RG_NEW(char, RG_SET_NAME);
        snprintf(s->name[i], RG_SET_NAME, "%d", s->entity[i].tag);
        s->entity[i].set = s->count++;
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

rg_gmsh_sets rg_gmsh_sets_read(const char *path, int dimension) {
    rg_gmsh_sets s = rg_gmsh_entities(path, dimension);
    int *pair = NULL, error;
    size_t numbers = 0;
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
    if (numbers == 0) {
        name_entities(&s, path);
    }
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
