/* Physical groups of Gmsh as named sets. */
#ifndef RG_GMSH_SETS_H
#define RG_GMSH_SETS_H

#include <stddef.h>

#include "mesh/mesh.h"

/* Groups of one dimension and the geometric entities of that dimension. */
typedef struct {
    int dimension, count;
    char *name[RG_MAX_SETS]; /* whoever uses the sets takes them */
    size_t entities;
    struct rg_gmsh_entity {
        int tag, set; /* set: -1 for none */
    } * entity;
} rg_gmsh_sets;

/* All entities, in no set. */
rg_gmsh_sets rg_gmsh_entities(const char *path, int dimension);

/* The physical groups by their names (or numbers); where there are none, all entities by their numbers. Ends
 * the run if an entity is in two groups: a face can be in one set only. */
rg_gmsh_sets rg_gmsh_sets_read(const char *path, int dimension);
void rg_gmsh_sets_free(rg_gmsh_sets *s);

/* Calls take(context, type, tag[count], count, node[], set) for the elements of each entity and type. */
void rg_gmsh_each(const char *path, const rg_gmsh_sets *s,
                  void (*take)(void *, int, const size_t *, size_t, const size_t *, int), void *context);

/* Ends the run with Gmsh's message unless error is 0. */
void rg_gmsh_require(const char *path, int error);

#endif
