/* Which element goes to which rank: METIS on the dual graph, where elements are nodes and interior faces
 * edges. */
#include "mesh.h"

#include <metis.h>

#include "error.h"
#include "mem.h"

enum { SEED = 20100 }; /* the same partition in every run */

struct graph {
    idx_t nodes;
    idx_t *start; /* [nodes + 1]: where each node's edges begin */
    idx_t *edge;  /* [start[nodes]]: nodes at the other ends */
};

static struct graph dual_graph(const rg_mesh *mesh) {
    if (mesh->elements > IDX_MAX / 4) {
        rg_fatal(RG_USAGE, "mesh: %lld elements are too many for METIS with %d-bit indices",
                 (long long)mesh->elements, IDXTYPEWIDTH);
    }
    size_t n = (size_t)mesh->elements;
    struct graph g = {(idx_t)n, RG_NEW(idx_t, n + 1), RG_NEW(idx_t, 4 * n)};
    idx_t edges = 0;
    for (size_t e = 0; e < n; e++) {
        for (size_t f = 0; f < 4; f++) {
            if (mesh->neighbour[4 * e + f] >= 0) {
                g.edge[edges++] = (idx_t)mesh->neighbour[4 * e + f];
            }
        }
        g.start[e + 1] = edges;
    }
    return g;
}

static void run_metis(struct graph *g, int parts, idx_t *result) {
    idx_t options[METIS_NOPTIONS];
    METIS_SetDefaultOptions(options);
    options[METIS_OPTION_SEED] = SEED;
    idx_t constraints = 1, count = (idx_t)parts, cut = 0;
    int status = METIS_PartGraphKway(&g->nodes, &constraints, g->start, g->edge, NULL, NULL, NULL, &count,
                                     NULL, NULL, options, &cut, result);
    if (status != METIS_OK) {
        rg_fatal(RG_FAILURE, "METIS could not partition %lld elements for %d ranks: %s", (long long)g->nodes,
                 parts, status == METIS_ERROR_MEMORY ? "out of memory" : "internal error");
    }
}

static int largest(const rg_gid *size, int parts) {
    int best = 0;
    for (int p = 1; p < parts; p++) {
        best = size[p] > size[best] ? p : best;
    }
    return best;
}

/* METIS leaves parts empty when there are few elements for each: these get one element of the largest part
 * each. */
static void fill_empty(rg_gid elements, int parts, int32_t *part) {
    rg_gid *size = RG_NEW(rg_gid, (size_t)parts);
    for (rg_gid e = 0; e < elements; e++) {
        size[part[e]]++;
    }
    for (int p = 0; p < parts; p++) {
        if (size[p] > 0) {
            continue;
        }
        int from = largest(size, parts);
        rg_gid e = 0;
        while (part[e] != from) {
            e++;
        }
        part[e] = p;
        size[from]--;
        size[p]++;
    }
    rg_free(size);
}

void rg_mesh_partition(const rg_mesh *mesh, int parts, int32_t *part) {
    if (parts > mesh->elements) {
        rg_fatal(RG_USAGE, "%d ranks are too many for a mesh of %lld elements: each needs at least one",
                 parts, (long long)mesh->elements);
    }
    if (parts == 1) {
        for (rg_gid e = 0; e < mesh->elements; e++) {
            part[e] = 0;
        }
        return;
    }
    struct graph g = dual_graph(mesh);
    idx_t *result = RG_NEW(idx_t, (size_t)mesh->elements);
    run_metis(&g, parts, result);
    rg_free(g.start);
    rg_free(g.edge);
    for (rg_gid e = 0; e < mesh->elements; e++) {
        part[e] = (int32_t)result[e];
    }
    rg_free(result);
    fill_empty(mesh->elements, parts, part);
}
