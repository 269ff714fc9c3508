/* Which tile goes to which rank. */
#include "tile_graph.h"

#include <math.h>
#include <metis.h>
#include <string.h>

#include "error.h"
#include "mem.h"

enum {
    SEED = 20100, /* the same partition in every run */
    TRIES = 8,    /* partitions that METIS chooses from */
};

/* The graph in METIS's integers. */
struct graph {
    idx_t nodes, *start, *edge, *faces, *weight;
};

/* The cost of all tiles as integers, of which METIS sums up to all: elements as they are, other costs as
 * fractions of the largest that such a sum allows. */
static void set_weights(const rg_tile_graph *g, idx_t *weight) {
    double most = 0, all = 0;
    for (int64_t t = 0; t < g->tiles && g->weight != NULL; t++) {
        most = g->weight[t] > most ? g->weight[t] : most;
        all += g->weight[t];
    }
    for (int64_t t = 0; t < g->tiles; t++) {
        rg_gid left = g->elements - t * g->tile;
        weight[t] = (idx_t)(left < g->tile ? left : g->tile);
        if (g->weight != NULL) {
            weight[t] = 1 + (idx_t)fmin(1e6 * (g->weight[t] / most), 1e9 * (g->weight[t] / all));
        }
    }
}

static struct graph convert(const rg_tile_graph *g) {
    size_t n = (size_t)g->tiles, edges = (size_t)g->start[n];
    struct graph m = {(idx_t)n, RG_NEW(idx_t, n + 1), RG_NEW(idx_t, edges + 1), RG_NEW(idx_t, edges + 1),
                      RG_NEW(idx_t, n)};
    set_weights(g, m.weight);
    for (size_t t = 0; t < n; t++) {
        m.start[t + 1] = (idx_t)g->start[t + 1];
    }
    for (size_t k = 0; k < edges; k++) {
        m.edge[k] = (idx_t)g->neighbour[k];
        m.faces[k] = (idx_t)g->faces[k];
    }
    return m;
}

static void free_graph(struct graph *g) {
    rg_free(g->start);
    rg_free(g->edge);
    rg_free(g->faces);
    rg_free(g->weight);
}

typedef int metis_method(idx_t *nodes, idx_t *constraints, idx_t *start, idx_t *edge, idx_t *weight,
                         idx_t *size, idx_t *edge_weight, idx_t *parts, real_t *target, real_t *tolerance,
                         idx_t *options, idx_t *cut, idx_t *result);

/* Returns the number of faces cut. */
static idx_t run_metis(struct graph *g, metis_method *method, int parts, idx_t *result) {
    idx_t options[METIS_NOPTIONS];
    METIS_SetDefaultOptions(options);
    options[METIS_OPTION_SEED] = SEED;
    options[METIS_OPTION_NCUTS] = TRIES;
    idx_t constraints = 1, count = (idx_t)parts, cut = 0;
    int status = method(&g->nodes, &constraints, g->start, g->edge, g->weight, NULL, g->faces, &count, NULL,
                        NULL, options, &cut, result);
    if (status != METIS_OK) {
        rg_fatal(RG_FAILURE, "METIS could not partition %lld tiles for %d ranks: %s", (long long)g->nodes,
                 parts, status == METIS_ERROR_MEMORY ? "out of memory" : "internal error");
    }
    return cut;
}

/* Cost of the largest part: what all ranks wait for. */
static rg_gid heaviest(const struct graph *g, int parts, const idx_t *result) {
    rg_gid *size = RG_NEW(rg_gid, (size_t)parts), most = 0;
    for (idx_t t = 0; t < g->nodes; t++) {
        size[result[t]] += g->weight[t];
        most = size[result[t]] > most ? size[result[t]] : most;
    }
    rg_free(size);
    return most;
}

/* The better of METIS's two methods. With few tiles for each part, either may go wrong: the k-way method then
 * deals out the tiles almost at random (three times the faces), recursive bisection is out of balance. */
static void best_partition(struct graph *g, int parts, idx_t *result) {
    idx_t *other = RG_NEW(idx_t, (size_t)g->nodes);
    idx_t cut = run_metis(g, METIS_PartGraphKway, parts, result);
    idx_t other_cut = run_metis(g, METIS_PartGraphRecursive, parts, other);
    rg_gid most = heaviest(g, parts, result), other_most = heaviest(g, parts, other);
    if (other_most < most || (other_most == most && other_cut < cut)) {
        memcpy(result, other, (size_t)g->nodes * sizeof *result);
    }
    rg_free(other);
}

static int largest(const rg_gid *size, int parts) {
    int best = 0;
    for (int p = 1; p < parts; p++) {
        best = size[p] > size[best] ? p : best;
    }
    return best;
}

/* METIS leaves parts empty when there are few tiles for each: these get one tile of the largest part
 * each. */
static void fill_empty(rg_gid tiles, int parts, int32_t *part) {
    rg_gid *size = RG_NEW(rg_gid, (size_t)parts);
    for (rg_gid t = 0; t < tiles; t++) {
        size[part[t]]++;
    }
    for (int p = 0; p < parts; p++) {
        if (size[p] > 0) {
            continue;
        }
        int from = largest(size, parts);
        rg_gid t = 0;
        while (part[t] != from) {
            t++;
        }
        part[t] = p;
        size[from]--;
        size[p]++;
    }
    rg_free(size);
}

void rg_tile_graph_partition(const rg_tile_graph *graph, int parts, int32_t *part) {
    if (parts > graph->tiles) {
        rg_fatal(
            RG_USAGE,
            "%d ranks are too many for a mesh of %lld elements in %lld tiles: each needs at least one tile",
            parts, (long long)graph->elements, (long long)graph->tiles);
    }
    if (parts == 1) {
        memset(part, 0, (size_t)graph->tiles * sizeof *part);
        return;
    }
    struct graph g = convert(graph);
    idx_t *result = RG_NEW(idx_t, (size_t)graph->tiles);
    best_partition(&g, parts, result);
    free_graph(&g);
    for (rg_gid t = 0; t < graph->tiles; t++) {
        part[t] = (int32_t)result[t];
    }
    rg_free(result);
    fill_empty(graph->tiles, parts, part);
}
