/* The graph of tiles: what a partition cuts. */
#include "mesh/tile_graph.h"

#include <stdbool.h>
#include <stdlib.h>

#include "base/mem.h"

struct list {
    int64_t *tile; /* a tile across each face that leaves the current one */
    size_t count;
};

static int ascending(const void *a, const void *b) {
    int64_t p = *(const int64_t *)a, q = *(const int64_t *)b;
    return (p > q) - (p < q);
}

static void collect(const rg_mesh *mesh, int tile, int64_t t, struct list *l) {
    rg_gid begin = t * tile, end = begin + tile;
    end = end < mesh->elements ? end : mesh->elements;
    l->count = 0;
    for (rg_gid slot = 4 * begin; slot < 4 * end; slot++) {
        if (mesh->neighbour[slot] >= 0 && mesh->neighbour[slot] / tile != t) {
            l->tile[l->count++] = mesh->neighbour[slot] / tile;
        }
    }
    qsort(l->tile, l->count, sizeof *l->tile, ascending);
}

/* Appends the different entries of the list, with their numbers, to the graph. */
static void append(rg_tile_graph *g, int64_t t, const struct list *l, size_t room[2]) {
    int64_t n = g->start[t];
    for (size_t i = 0; i < l->count; i++) {
        if (i > 0 && l->tile[i] == l->tile[i - 1]) {
            g->faces[n - 1]++;
            continue;
        }
        g->neighbour = rg_grow(g->neighbour, &room[0], (size_t)n, sizeof *g->neighbour);
        g->faces = rg_grow(g->faces, &room[1], (size_t)n, sizeof *g->faces);
        g->neighbour[n] = l->tile[i];
        g->faces[n++] = 1;
    }
    g->start[t + 1] = n;
}

rg_tile_graph *rg_tile_graph_make(const rg_mesh *mesh, int tile) {
    rg_tile_graph *g = RG_NEW(rg_tile_graph, 1);
    size_t room[2] = {0, 0};
    struct list list = {.tile = RG_NEW(int64_t, 4 * (size_t)tile)};
    g->elements = mesh->elements;
    g->tile = tile;
    g->tiles = (mesh->elements + tile - 1) / tile;
    g->start = RG_NEW(int64_t, (size_t)g->tiles + 1);
    for (int64_t t = 0; t < g->tiles; t++) {
        collect(mesh, tile, t, &list);
        append(g, t, &list, room);
    }
    rg_free(list.tile);
    return g;
}

void rg_tile_graph_free(rg_tile_graph *g) {
    if (g != NULL) {
        rg_free(g->start);
        rg_free(g->neighbour);
        rg_free(g->faces);
        rg_free(g->weight);
        rg_free(g);
    }
}

/* ---- quality of a partition ---- */

static double elements_of(const rg_tile_graph *g, int64_t t) {
    rg_gid left = g->elements - t * g->tile;
    return (double)(left < g->tile ? left : g->tile);
}

/* Largest part over the mean. */
static double imbalance(const rg_tile_graph *g, int parts, const int32_t *part, bool cost) {
    double *size = RG_NEW(double, (size_t)parts), most = 0, all = 0;
    for (int64_t t = 0; t < g->tiles; t++) {
        size[part[t]] += cost && g->weight != NULL ? g->weight[t] : elements_of(g, t);
    }
    for (int p = 0; p < parts; p++) {
        most = size[p] > most ? size[p] : most;
        all += size[p];
    }
    rg_free(size);
    return most * parts / all;
}

/* Counts the different pairs of parts that share faces, in order: a part's neighbours stand together. */
static void count_neighbours(rg_partition_quality *q, int parts, int64_t *pair, size_t count) {
    int64_t all = 0, here = 0;
    qsort(pair, count, sizeof *pair, ascending);
    for (size_t i = 0; i < count; i++) {
        if (i == 0 || pair[i] / parts != pair[i - 1] / parts) {
            here = 0;
        }
        if (i == 0 || pair[i] != pair[i - 1]) {
            all++;
            here++;
        }
        q->neighbours_max = here > q->neighbours_max ? (int)here : q->neighbours_max;
    }
    q->neighbours_mean = (double)all / parts;
}

rg_partition_quality rg_tile_graph_quality(const rg_tile_graph *g, int parts, const int32_t *part) {
    rg_partition_quality q = {.imbalance = imbalance(g, parts, part, false),
                              .cost_imbalance = imbalance(g, parts, part, true)};
    int64_t *pair = RG_NEW(int64_t, (size_t)g->start[g->tiles] + 1);
    size_t count = 0;
    for (int64_t t = 0; t < g->tiles; t++) {
        for (int64_t i = g->start[t]; i < g->start[t + 1]; i++) {
            int32_t other = part[g->neighbour[i]];
            if (other != part[t]) {
                q.cut_faces += t < g->neighbour[i] ? g->faces[i] : 0; /* once for both sides */
                pair[count++] = (int64_t)part[t] * parts + other;
            }
        }
    }
    count_neighbours(&q, parts, pair, count);
    rg_free(pair);
    return q;
}
