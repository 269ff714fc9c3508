/* The order of the elements: along a Hilbert curve, so that consecutive elements form compact tiles. */
#include "mesh/mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/hilbert.h"
#include "base/mem.h"
#include "layout.h"

/* Tiles a mesh should have: enough for a few ranks and threads to share evenly. */
enum { FEWEST_TILES = 64 };

/* Tiles fill blocks of either precision. */
enum { WHOLE = 16 };

typedef struct {
    uint64_t key; /* index on the curve */
    rg_gid number;
} place;

void rg_mesh_box_around(const rg_mesh *mesh, double box[2][3]) {
    for (int i = 0; i < 3; i++) {
        box[0][i] = INFINITY;
        box[1][i] = -INFINITY;
        for (rg_gid v = 0; v < mesh->vertices; v++) {
            box[0][i] = fmin(box[0][i], mesh->x[3 * v + i]);
            box[1][i] = fmax(box[1][i], mesh->x[3 * v + i]);
        }
    }
}

/* Sums in integers: the result does not depend on the order of the elements. */
void rg_mesh_mean_extent(const rg_mesh *mesh, const double box[2][3], double extent[3]) {
    const double unit = 0x1p-30;
    for (int i = 0; i < 3; i++) {
        double size = box[1][i] - box[0][i];
        int64_t sum = 0;
#pragma omp parallel for schedule(static) reduction(+ : sum)
        for (rg_gid e = 0; e < mesh->elements; e++) {
            double low = INFINITY, high = -INFINITY;
            for (int k = 0; k < 4; k++) {
                double x = mesh->x[3 * mesh->corner[4 * e + k] + i];
                low = fmin(low, x);
                high = fmax(high, x);
            }
            sum += (int64_t)((high - low) / size / unit);
        }
        extent[i] = (double)sum * unit * size / (double)mesh->elements;
    }
}

/* Space in units of elements, from the lower corner of the mesh: the curve runs through a cube there. */
typedef struct {
    double low[3], extent[3], edge;
} curve;

static curve make_curve(const rg_mesh *mesh) {
    double box[2][3];
    curve c = {.edge = 0};
    rg_mesh_box_around(mesh, box);
    rg_mesh_mean_extent(mesh, (const double(*)[3])box, c.extent);
    for (int i = 0; i < 3; i++) {
        c.low[i] = box[0][i];
        c.edge = fmax(c.edge, (box[1][i] - box[0][i]) / c.extent[i]);
    }
    return c;
}

static uint64_t key_of(const rg_mesh *mesh, rg_gid e, const curve *c) {
    static const double origin[3] = {0, 0, 0};
    double at[3];
    const rg_gid *corner = mesh->corner + 4 * e;
    for (int i = 0; i < 3; i++) {
        double centroid = 0.25 * ((mesh->x[3 * corner[0] + i] + mesh->x[3 * corner[1] + i]) +
                                  (mesh->x[3 * corner[2] + i] + mesh->x[3 * corner[3] + i]));
        at[i] = (centroid - c->low[i]) / c->extent[i];
    }
    return rg_hilbert_point(at, origin, c->edge);
}

static int along_curve(const void *a, const void *b) {
    const place *p = a, *q = b;
    if (p->key != q->key) {
        return p->key < q->key ? -1 : 1;
    }
    return (p->number > q->number) - (p->number < q->number);
}

/* Moves records of `size` bytes to their places; there may be none. */
static void permute(void *records, size_t size, const place *order, rg_gid count) {
    if (records == NULL) {
        return;
    }
    char *from = rg_alloc((size_t)count, size), *to = records;
    memcpy(from, to, (size_t)count * size);
    for (rg_gid e = 0; e < count; e++) {
        memcpy(to + (size_t)e * size, from + (size_t)order[e].number * size, size);
    }
    rg_free(from);
}

/* The curve runs through a cube, not through the mesh's box stretched to one, which would lengthen the ways
 * between neighbours; but space is measured in elements, so that flat elements too make compact tiles. */
void rg_mesh_sort(rg_mesh *mesh) {
    curve c = make_curve(mesh);
    size_t count = (size_t)mesh->elements;
    place *order = RG_NEW(place, count);
#pragma omp parallel for schedule(static)
    for (rg_gid e = 0; e < mesh->elements; e++) {
        order[e] = (place){key_of(mesh, e, &c), e};
    }
    qsort(order, count, sizeof *order, along_curve);
    if (mesh->original == NULL) {
        mesh->original = RG_NEW(rg_gid, count);
        for (rg_gid e = 0; e < mesh->elements; e++) {
            mesh->original[e] = e;
        }
    }
    permute(mesh->corner, 4 * sizeof *mesh->corner, order, mesh->elements);
    permute(mesh->set, 4 * sizeof *mesh->set, order, mesh->elements);
    permute(mesh->region, sizeof *mesh->region, order, mesh->elements);
    permute(mesh->original, sizeof *mesh->original, order, mesh->elements);
    rg_free(order);
}

int rg_tile_elements(rg_gid elements, int most) {
    rg_gid tile = elements / FEWEST_TILES;
    if (tile >= most) {
        return most;
    }
    return (int)(tile >= WHOLE ? tile / WHOLE * WHOLE : tile > 0 ? tile : 1);
}

int rg_mesh_tile(const rg_mesh *mesh) {
    return mesh->tile > 0 ? mesh->tile : rg_tile_elements(mesh->elements, RG_TILE);
}
