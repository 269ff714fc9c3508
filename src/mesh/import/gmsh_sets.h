/* Physical groups of Gmsh as named sets. */
#ifndef RG_GMSH_SETS_H
#define RG_GMSH_SETS_H

#include <stdbool.h>
#include <stddef.h>

#include "mesh/mesh.h"

/* Groups of one dimension and the geometric entities of that dimension. */
typedef struct {
    int dimension;
    bool named; /* by physical groups */
    rg_sets sets;
    size_t entities;
    struct rg_gmsh_entity {
        int tag;
        int32_t group; /* of sets, which may overlap */
    } * entity;
} rg_gmsh_sets;

/* All entities, in no set. */
rg_gmsh_sets rg_gmsh_entities(const char *path, int dimension);

/* The physical groups by their names (or numbers); where there are none, all entities by their numbers. */
rg_gmsh_sets rg_gmsh_sets_read(const char *path, int dimension);
void rg_gmsh_sets_free(rg_gmsh_sets *s);

/* Elements of one type and entity. */
typedef struct {
    int type;
    size_t count;
    const size_t *tag, *node; /* [count], and their nodes */
    const int32_t *set;       /* [sets] that the entity is in */
    int32_t sets;
} rg_gmsh_block;

/* Calls take(context, block) for the elements of each entity and type. */
void rg_gmsh_each(const char *path, const rg_gmsh_sets *s, void (*take)(void *, const rg_gmsh_block *),
                  void *context);

/* Ends the run with Gmsh's message unless error is 0. */
void rg_gmsh_require(const char *path, int error);

#endif
