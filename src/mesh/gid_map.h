/* Global element number -> local slot: open addressing, built once. */
#ifndef RG_GID_MAP_H
#define RG_GID_MAP_H

#include "mesh/mesh.h"

typedef struct {
    size_t mask;
    rg_gid *key; /* -1: empty */
    rg_lid *value;
} rg_gid_map;

/* An empty map with room for `count` numbers. Free with rg_gid_map_free. */
rg_gid_map rg_gid_map_make(size_t count);

/* The slot of `key`, or `value` if it is new, which is then stored. */
rg_lid rg_gid_map_put(rg_gid_map *map, rg_gid key, rg_lid value);

/* The slot of `key`, -1 if there is none. */
rg_lid rg_gid_map_get(const rg_gid_map *map, rg_gid key);

void rg_gid_map_free(rg_gid_map *map);

#endif
