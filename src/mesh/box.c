/* The built-in mesh: a box of cubes, each cut into six tetrahedra around its main diagonal (Kuhn). */
#include "mesh/mesh.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/error.h"
#include "base/hash.h"
#include "base/mem.h"
#include "base/tet.h"

enum { TETS = 6 }; /* in a cube */

/* A tetrahedron's corners are a walk along the cube's edges from its lowest to its highest corner, one step
 * per axis: the order of the axes. Vertex numbers rise along the walk, so the corners come out sorted. The
 * first three walks give right-handed tetrahedra, the others left-handed ones. */
static const int walk[TETS][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {1, 0, 2}, {2, 1, 0}};

static const char *const side_name[6] = {"x-", "x+", "y-", "y+", "z-", "z+"};

/* Least volume of a jittered tetrahedron, relative to the regular one. */
static const double least_volume = 1e-3;

struct grid {
    int64_t cells[3];
    rg_gid stride[3]; /* from a vertex to the next one along each axis */
    double origin[3], size[3];
    double jitter; /* fraction of the smallest cell edge */
    double reach;  /* the same in m */
    int64_t seed;
};

static struct grid make_grid(const int64_t cells[3], const double origin[3], const double size[3],
                             double jitter, int64_t seed) {
    struct grid g = {.jitter = jitter, .seed = seed};
    if ((double)cells[0] * (double)cells[1] * (double)cells[2] > 0x1p40) {
        rg_fatal(RG_USAGE, "mesh.cells: %lld x %lld x %lld cells are too many", (long long)cells[0],
                 (long long)cells[1], (long long)cells[2]);
    }
    double edge = INFINITY;
    for (int i = 0; i < 3; i++) {
        g.cells[i] = cells[i];
        g.origin[i] = origin[i];
        g.size[i] = size[i];
        g.stride[i] = i == 0 ? 1 : g.stride[i - 1] * (cells[i - 1] + 1);
        edge = fmin(edge, size[i] / (double)cells[i]);
    }
    g.reach = jitter * edge;
    return g;
}

static rg_mesh *allocate(const struct grid *g) {
    rg_mesh *mesh = RG_NEW(rg_mesh, 1);
    mesh->vertices = g->stride[2] * (g->cells[2] + 1);
    mesh->elements = TETS * g->cells[0] * g->cells[1] * g->cells[2];
    size_t faces = 4 * (size_t)mesh->elements;
    mesh->x = RG_NEW(double, 3 * (size_t)mesh->vertices);
    mesh->corner = RG_NEW(rg_gid, faces);
    mesh->neighbour = RG_NEW(rg_gid, faces);
    mesh->face = RG_NEW(int8_t, faces);
    mesh->set = RG_NEW(int32_t, faces);
    for (int s = 0; s < 6; s++) {
        rg_sets_add(&mesh->surface, side_name[s]);
    }
    return mesh;
}

/* In [-1, 1), the same wherever and whenever it is asked for. */
static double offset(const struct grid *g, rg_gid vertex, int component) {
    uint64_t h = rg_hash(rg_hash(rg_hash(0, (uint64_t)g->seed), (uint64_t)vertex), (uint64_t)component);
    return 2.0 * rg_hash_uniform(h) - 1.0;
}

static void place_vertex(const struct grid *g, rg_mesh *mesh, const int64_t at[3]) {
    rg_gid vertex = at[0] * g->stride[0] + at[1] * g->stride[1] + at[2] * g->stride[2];
    double *x = mesh->x + 3 * vertex;
    bool inside = true;
    for (int i = 0; i < 3; i++) {
        inside = inside && at[i] > 0 && at[i] < g->cells[i];
        /* The quotient is exactly 0 and 1 at the ends, so the surface is exactly where it was asked for. */
        x[i] = g->origin[i] + g->size[i] * ((double)at[i] / (double)g->cells[i]);
    }
    for (int i = 0; inside && i < 3; i++) {
        x[i] += g->reach * offset(g, vertex, i);
    }
}

static void place_vertices(const struct grid *g, rg_mesh *mesh) {
    int64_t at[3];
    for (at[2] = 0; at[2] <= g->cells[2]; at[2]++) {
        for (at[1] = 0; at[1] <= g->cells[1]; at[1]++) {
            for (at[0] = 0; at[0] <= g->cells[0]; at[0]++) {
                place_vertex(g, mesh, at);
            }
        }
    }
}

/* Of a tetrahedron's faces only two can lie on the surface: the one opposite the walk's start, on the upper
 * side of its first axis, and the one opposite its end, on the lower side of its last axis. */
static void fill_tet(const struct grid *g, rg_mesh *mesh, const int64_t cell[3], rg_gid e,
                     const int axis[3]) {
    rg_gid *corner = mesh->corner + 4 * e;
    corner[0] = cell[0] * g->stride[0] + cell[1] * g->stride[1] + cell[2] * g->stride[2];
    for (int i = 0; i < 3; i++) {
        corner[i + 1] = corner[i] + g->stride[axis[i]];
    }
    int32_t *set = mesh->set + 4 * e;
    int up = axis[0], down = axis[2];
    set[0] = cell[up] == g->cells[up] - 1 ? 2 * up + 1 : -1;
    set[1] = -1;
    set[2] = -1;
    set[3] = cell[down] == 0 ? 2 * down : -1;
}

static void check_tet(const struct grid *g, const rg_mesh *mesh, const int64_t cell[3], rg_gid e,
                      double regular) {
    const rg_gid *corner = mesh->corner + 4 * e;
    double volume = rg_tet_volume(mesh->x + 3 * corner[0], mesh->x + 3 * corner[1], mesh->x + 3 * corner[2],
                                  mesh->x + 3 * corner[3]);
    if (!(volume / regular >= least_volume)) {
        rg_fatal(RG_USAGE,
                 "mesh.jitter: %g turns element %lld in cell (%lld, %lld, %lld) inside out or nearly so: its "
                 "volume "
                 "is %.3g of the regular one; choose a smaller jitter or another seed",
                 g->jitter, (long long)e, (long long)cell[0], (long long)cell[1], (long long)cell[2],
                 volume / regular);
    }
}

static void fill_cells(const struct grid *g, rg_mesh *mesh) {
    double regular = 1.0 / TETS;
    for (int i = 0; i < 3; i++) {
        regular *= g->size[i] / (double)g->cells[i];
    }
    rg_gid e = 0;
    int64_t cell[3];
    for (cell[2] = 0; cell[2] < g->cells[2]; cell[2]++) {
        for (cell[1] = 0; cell[1] < g->cells[1]; cell[1]++) {
            for (cell[0] = 0; cell[0] < g->cells[0]; cell[0]++) {
                for (int t = 0; t < TETS; t++, e++) {
                    fill_tet(g, mesh, cell, e, walk[t]);
                    check_tet(g, mesh, cell, e, t < TETS / 2 ? regular : -regular);
                }
            }
        }
    }
}

rg_mesh *rg_mesh_box(const int64_t cells[3], const double origin[3], const double size[3], double jitter,
                     int64_t seed) {
    struct grid g = make_grid(cells, origin, size, jitter, seed);
    rg_mesh *mesh = allocate(&g);
    place_vertices(&g, mesh);
    fill_cells(&g, mesh);
    rg_mesh_sort(mesh);
    rg_mesh_connect(mesh);
    return mesh;
}
