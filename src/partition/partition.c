/* Which tile goes to which rank. */
#include "mesh/tile_graph.h"

#include <math.h>
#include <metis.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/mem.h"

enum {
    SEED = 20100, /* the same partition in every run */
    TRIES = 8,    /* partitions that METIS chooses from */
};

/* Work of an element that a face between ranks costs each of them: rows packed, 216 bytes sent and as many
 * received. At 1 GB/s, a core's share of a fast network, that is one element's, of which the sweeps hide some
 * half. */
#define FACE_COST 0.5

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

/* How to ask METIS. `excess`: that a part may have over the mean, in thousandths. */
typedef struct {
    metis_method *method;
    idx_t excess;
} request;

static void run_metis(struct graph *g, const request *q, int parts, idx_t *result) {
    idx_t options[METIS_NOPTIONS];
    METIS_SetDefaultOptions(options);
    options[METIS_OPTION_SEED] = SEED;
    options[METIS_OPTION_NCUTS] = TRIES;
    options[METIS_OPTION_UFACTOR] = q->excess;
    idx_t constraints = 1, count = (idx_t)parts, cut = 0;
    int status = q->method(&g->nodes, &constraints, g->start, g->edge, g->weight, NULL, g->faces, &count,
                           NULL, NULL, options, &cut, result);
    if (status != METIS_OK) {
        rg_fatal(RG_FAILURE, "METIS could not partition %lld tiles for %d ranks: %s", (long long)g->nodes,
                 parts, status == METIS_ERROR_MEMORY ? "out of memory" : "internal error");
    }
}

/* What all ranks wait for: the part with most to do, in elements of the mesh's mean cost. */
static double slowest(const struct graph *g, double elements, int parts, const idx_t *result) {
    double *cost = RG_NEW(double, (size_t)parts), all = 0, most = 0;
    for (idx_t t = 0; t < g->nodes; t++) {
        all += (double)g->weight[t];
    }
    for (idx_t t = 0; t < g->nodes; t++) {
        double faces = 0;
        for (idx_t i = g->start[t]; i < g->start[t + 1]; i++) {
            faces += result[g->edge[i]] != result[t] ? (double)g->faces[i] : 0;
        }
        cost[result[t]] += (double)g->weight[t] * elements / all + FACE_COST * faces;
        most = fmax(most, cost[result[t]]);
    }
    rg_free(cost);
    return most;
}

/* The best of METIS's methods. With few tiles for each part any of them may go wrong: held to a small excess,
 * the k-way method distributes the tiles almost at random (three times the faces); recursive bisection is out
 * of balance. */
static void best_partition(struct graph *g, double elements, int parts, idx_t *result) {
    static const request all[] = {{METIS_PartGraphKway, 30},
                                  {METIS_PartGraphKway, 100},
                                  {METIS_PartGraphRecursive, 1},
                                  {METIS_PartGraphRecursive, 10}};
    size_t bytes = (size_t)g->nodes * sizeof *result;
    idx_t *other = RG_NEW(idx_t, (size_t)g->nodes);
    double least = INFINITY;
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        run_metis(g, &all[k], parts, other);
        double cost = slowest(g, elements, parts, other);
        if (cost < least) {
            memcpy(result, other, bytes);
            least = cost;
        }
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

typedef struct {
    double mean; /* number of its tiles */
    int32_t part;
} placed;

static int by_mean(const void *a, const void *b) {
    const placed *p = a, *q = b;
    int by_part = (p->part > q->part) - (p->part < q->part);
    return p->mean < q->mean ? -1 : p->mean > q->mean ? 1 : by_part;
}

/* Numbers the parts in the order of their tiles. METIS's numbers follow nothing: with two parts, each may
 * have just the elements whose global order is the other's, and all records change ranks on their way to a
 * file. */
static void order_parts(rg_gid tiles, int parts, int32_t *part) {
    placed *place = RG_NEW(placed, (size_t)parts);
    rg_gid *size = RG_NEW(rg_gid, (size_t)parts);
    int32_t *number = RG_NEW(int32_t, (size_t)parts);
    for (rg_gid t = 0; t < tiles; t++) {
        place[part[t]].mean += (double)t;
        size[part[t]]++;
    }
    for (int32_t p = 0; p < parts; p++) {
        place[p] = (placed){place[p].mean / (double)size[p], p};
    }
    qsort(place, (size_t)parts, sizeof *place, by_mean);
    for (int32_t i = 0; i < parts; i++) {
        number[place[i].part] = i;
    }
    for (rg_gid t = 0; t < tiles; t++) {
        part[t] = number[part[t]];
    }
    rg_free(place);
    rg_free(size);
    rg_free(number);
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
    best_partition(&g, (double)graph->elements, parts, result);
    free_graph(&g);
    for (rg_gid t = 0; t < graph->tiles; t++) {
        part[t] = (int32_t)result[t];
    }
    rg_free(result);
    fill_empty(graph->tiles, parts, part);
    order_parts(graph->tiles, parts, part);
}
