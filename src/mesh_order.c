/* The order of the elements: along a Hilbert curve through their centroids. */
#include "mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../kernels/layout.h"
#include "hilbert.h"
#include "mem.h"

/* Tiles a mesh should have: enough for a few ranks and threads to share evenly. */
enum { FEWEST_TILES = 64 };

struct place {
    uint64_t key; /* index on the curve */
    rg_gid id;    /* number so far */
};

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

static int by_key(const void *a, const void *b) {
    const struct place *p = a, *q = b;
    if (p->key != q->key) {
        return p->key < q->key ? -1 : 1;
    }
    return (p->id > q->id) - (p->id < q->id);
}

static uint64_t curve_index(const rg_mesh *mesh, rg_gid e, const double low[3], double edge) {
    const rg_gid *c = mesh->corner + 4 * e;
    double centroid[3];
    for (int i = 0; i < 3; i++) {
        centroid[i] = 0.25 * ((mesh->x[3 * c[0] + i] + mesh->x[3 * c[1] + i]) +
                              (mesh->x[3 * c[2] + i] + mesh->x[3 * c[3] + i]));
    }
    return rg_hilbert_point(centroid, low, edge);
}

/* The curve runs through the cube around the mesh's box, not through the box stretched to a cube, which would
 * lengthen the ways between neighbours. */
static struct place *find_places(const rg_mesh *mesh) {
    double box[2][3];
    rg_mesh_box_around(mesh, box);
    double edge = fmax(box[1][0] - box[0][0], fmax(box[1][1] - box[0][1], box[1][2] - box[0][2]));
    struct place *place = RG_NEW(struct place, (size_t)mesh->elements);
    for (rg_gid e = 0; e < mesh->elements; e++) {
        place[e] = (struct place){curve_index(mesh, e, box[0], edge), e};
    }
    qsort(place, (size_t)mesh->elements, sizeof *place, by_key);
    return place;
}

/* Moves the rows of `*array`, one of `bytes` for each element, to their places. NULL stays NULL. */
static void move_rows(void *array, size_t bytes, const struct place *place, rg_gid elements) {
    char *old, *moved;
    memcpy(&old, array, sizeof old);
    if (old == NULL) {
        return;
    }
    moved = rg_alloc((size_t)elements, bytes);
    for (rg_gid e = 0; e < elements; e++) {
        memcpy(moved + (size_t)e * bytes, old + (size_t)place[e].id * bytes, bytes);
    }
    rg_free(old);
    memcpy(array, &moved, sizeof moved);
}

void rg_mesh_sort(rg_mesh *mesh) {
    struct place *place = find_places(mesh);
    if (mesh->original == NULL) {
        mesh->original = RG_NEW(rg_gid, (size_t)mesh->elements);
        for (rg_gid e = 0; e < mesh->elements; e++) {
            mesh->original[e] = e;
        }
    }
    move_rows(&mesh->corner, 4 * sizeof *mesh->corner, place, mesh->elements);
    move_rows(&mesh->set, 4 * sizeof *mesh->set, place, mesh->elements);
    move_rows(&mesh->region, sizeof *mesh->region, place, mesh->elements);
    move_rows(&mesh->original, sizeof *mesh->original, place, mesh->elements);
    rg_free(place);
}

int rg_tile_elements(rg_gid elements) {
    rg_gid tile = elements / FEWEST_TILES;
    if (tile >= RG_TILE) {
        return RG_TILE;
    }
    return (int)(tile >= RG_LANES ? tile / RG_LANES * RG_LANES : tile > 0 ? tile : 1);
}
