/* Sets that are joined two by two, each known by its lowest member: up[i] is a member of i's set no higher
 * than i, and i itself of the lowest. To begin with up[i] = i. */
#ifndef RG_UNION_FIND_H
#define RG_UNION_FIND_H

#include <stddef.h>

/* The lowest member of i's set; the way to it becomes shorter. */
static inline size_t rg_union_root(size_t *up, size_t i) {
    while (up[i] != i) {
        up[i] = up[up[i]];
        i = up[i];
    }
    return i;
}

static inline void rg_union_join(size_t *up, size_t i, size_t j) {
    size_t a = rg_union_root(up, i), b = rg_union_root(up, j);
    up[a > b ? a : b] = a > b ? b : a;
}

#endif
