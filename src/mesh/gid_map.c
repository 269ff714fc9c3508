#include "mesh/gid_map.h"

#include "base/hash.h"
#include "base/mem.h"

rg_gid_map rg_gid_map_make(size_t count) {
    size_t size = 16;
    while (size < 2 * count) {
        size *= 2;
    }
    rg_gid_map map = {size - 1, RG_NEW(rg_gid, size), RG_NEW(rg_lid, size)};
    for (size_t i = 0; i < size; i++) {
        map.key[i] = -1;
    }
    return map;
}

static size_t find(const rg_gid_map *map, rg_gid key) {
    size_t i = rg_mix((uint64_t)key) & map->mask;
    while (map->key[i] != -1 && map->key[i] != key) {
        i++;
        i &= map->mask;
    }
    return i;
}

rg_lid rg_gid_map_put(rg_gid_map *map, rg_gid key, rg_lid value) {
    size_t i = find(map, key);
    if (map->key[i] == -1) {
        map->key[i] = key;
        map->value[i] = value;
    }
    return map->value[i];
}

rg_lid rg_gid_map_get(const rg_gid_map *map, rg_gid key) {
    size_t i = find(map, key);
    return map->key[i] == -1 ? -1 : map->value[i];
}

void rg_gid_map_free(rg_gid_map *map) {
    rg_free(map->key);
    rg_free(map->value);
}
