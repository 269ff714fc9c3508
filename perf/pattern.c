/* Who talks to whom, on any number of ranks: the communication of a run without the run. Orders the elements
 * of a box as the solver does, makes its tiles, partitions and distributes them with the solver's own code,
 * and writes for each rank what it owns and shares. One process; the elements are never made, so that fifty
 * million take 3 GB. Where centroids lie on a border of the curve, rounding may order them otherwise than the
 * mesh does. */
#include <errno.h>
#include <mpi.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/hilbert.h"
#include "base/mem.h"
#include "layout.h"
#include "mesh/tile_graph.h"
#include "partition/distribution.h"

static const char usage[] =
    "usage: rhegma-pattern PREFIX X Y Z RANKS...\n"
    "Writes PREFIX-RANKS.txt for the box of X x Y x Z cubes of 6 tetrahedra on each number of ranks: a line\n"
    "\"tets ranks\", then one a rank: \"tets, those in tiles that touch no other rank, neighbours\", then "
    "\"rank faces\"\n"
    "for each neighbour.\n";

enum { TETS = 6 };

/* The tetrahedra of a cube as src/mesh/box.c numbers them: walks along the axes. The tetrahedron across the
 * face opposite the first corner continues the walk in the next cube, the one opposite the last corner comes
 * before; the other two exchange two steps of the walk in the same cube. */
static const int walk[TETS][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {1, 0, 2}, {2, 1, 0}};

typedef struct {
    int64_t cells[3];
    int64_t elements;
} box;

typedef struct {
    uint64_t key;
    int64_t number;
} place;

static int find_walk(int a, int b, int c) {
    int w = 0;
    while (walk[w][0] != a || walk[w][1] != b || walk[w][2] != c) {
        w++;
    }
    return w;
}

static void cell_of(const box *b, int64_t element, int64_t cell[3]) {
    int64_t c = element / TETS;
    cell[0] = c % b->cells[0];
    cell[1] = c / b->cells[0] % b->cells[1];
    cell[2] = c / b->cells[0] / b->cells[1];
}

/* The element with walk `w` in the cube `step` cubes from `cell` along `axis`; -1 beyond the surface. */
static int64_t element_at(const box *b, const int64_t cell[3], int axis, int step, int w) {
    int64_t at[3] = {cell[0], cell[1], cell[2]};
    at[axis] += step;
    if (at[axis] < 0 || at[axis] >= b->cells[axis]) {
        return -1;
    }
    return TETS * (at[0] + b->cells[0] * (at[1] + b->cells[1] * at[2])) + w;
}

/* Neighbours of an element, by its number in the box. */
static void neighbours(const box *b, int64_t element, int64_t other[4]) {
    int64_t cell[3];
    cell_of(b, element, cell);
    const int *w = walk[element % TETS];
    other[0] = element_at(b, cell, w[0], 1, find_walk(w[1], w[2], w[0]));
    other[1] = element_at(b, cell, w[0], 0, find_walk(w[1], w[0], w[2]));
    other[2] = element_at(b, cell, w[0], 0, find_walk(w[0], w[2], w[1]));
    other[3] = element_at(b, cell, w[2], -1, find_walk(w[2], w[0], w[1]));
}

/* As rg_mesh_sort: centroids in units of cubes, in a cube around the box. */
static uint64_t key_of(const box *b, int64_t element, double edge) {
    static const double origin[3] = {0, 0, 0};
    int64_t cell[3];
    cell_of(b, element, cell);
    const int *w = walk[element % TETS];
    double at[3] = {(double)cell[0], (double)cell[1], (double)cell[2]};
    for (int k = 0; k < 3; k++) {
        at[w[k]] += 0.25 * (3 - k); /* corners 1, 2, 3 lie beyond a step along the walk's first axis, ... */
    }
    return rg_hilbert_point(at, origin, edge);
}

static int along_curve(const void *a, const void *b) {
    const place *p = a, *q = b;
    if (p->key != q->key) {
        return p->key < q->key ? -1 : 1;
    }
    return (p->number > q->number) - (p->number < q->number);
}

static place *sort(const box *b) {
    double edge = 0;
    for (int i = 0; i < 3; i++) {
        edge = (double)b->cells[i] > edge ? (double)b->cells[i] : edge;
    }
    place *order = RG_NEW(place, (size_t)b->elements);
#pragma omp parallel for schedule(static)
    for (int64_t e = 0; e < b->elements; e++) {
        order[e] = (place){key_of(b, e, edge), e};
    }
    qsort(order, (size_t)b->elements, sizeof *order, along_curve);
    return order;
}

/* A mesh of which only the neighbours are known: all that the graph of tiles asks for. */
static rg_mesh *make_mesh(const box *b) {
    place *order = sort(b);
    int64_t *rank = RG_NEW(int64_t, (size_t)b->elements);
    rg_mesh *mesh = RG_NEW(rg_mesh, 1);
    mesh->elements = b->elements;
    mesh->neighbour = RG_NEW(rg_gid, 4 * (size_t)b->elements);
    for (int64_t i = 0; i < b->elements; i++) {
        rank[order[i].number] = i;
    }
#pragma omp parallel for schedule(static)
    for (int64_t i = 0; i < b->elements; i++) {
        int64_t other[4];
        neighbours(b, order[i].number, other);
        for (int f = 0; f < 4; f++) {
            mesh->neighbour[4 * i + f] = other[f] >= 0 ? rank[other[f]] : -1;
        }
    }
    rg_free(rank);
    rg_free(order);
    return mesh;
}

/* ---- Ranks ---- */

typedef struct {
    int64_t tets, inner;
    int64_t *faces; /* [ranks]: shared with each other rank, of the rank at hand */
} share;

/* Counts a tile to its rank; the faces that it shares with other ranks. */
static void add_tile(const rg_tile_graph *g, const rg_distribution *d, int64_t t, bool inner, share *s) {
    int64_t left = g->elements - t * g->tile, size = left < g->tile ? left : g->tile;
    s->tets += size;
    s->inner += inner ? size : 0;
    for (int64_t i = g->start[t]; i < g->start[t + 1]; i++) {
        if (d->owner[g->neighbour[i]] != d->owner[t]) {
            s->faces[d->owner[g->neighbour[i]]] += g->faces[i];
        }
    }
}

static void write_rank(const rg_tile_graph *g, const rg_distribution *d, int rank, share *s, FILE *out) {
    int count = 0;
    s->tets = s->inner = 0;
    for (int64_t k = d->start[rank]; k < d->start[rank + 1]; k++) {
        add_tile(g, d, d->list[k], k >= d->start[rank] + d->shared[rank], s);
    }
    for (int r = 0; r < d->ranks; r++) {
        count += s->faces[r] > 0;
    }
    fprintf(out, "%lld %lld %d", (long long)s->tets, (long long)s->inner, count);
    for (int r = 0; r < d->ranks; r++) {
        if (s->faces[r] > 0) {
            fprintf(out, " %d %lld", r, (long long)s->faces[r]);
        }
        s->faces[r] = 0;
    }
    fputc('\n', out);
}

static void write_pattern(const rg_tile_graph *g, int ranks, const char *prefix) {
    char path[1024];
    int32_t *owner = RG_NEW(int32_t, (size_t)g->tiles);
    rg_tile_graph_partition(g, ranks, owner);
    rg_distribution *d = rg_distribution_make(g, owner, ranks);
    share s = {.faces = RG_NEW(int64_t, (size_t)ranks)};
    snprintf(path, sizeof path, "%s-%d.txt", prefix, ranks);
    FILE *out = fopen(path, "w");
    if (out == NULL) {
        rg_fatal(RG_FAILURE, "%s: cannot be written: %s", path, strerror(errno));
    }
    fprintf(out, "%lld %d\n", (long long)g->elements, ranks);
    for (int r = 0; r < ranks; r++) {
        write_rank(g, d, r, &s, out);
    }
    if (fclose(out) != 0) {
        rg_fatal(RG_FAILURE, "%s: writing failed", path);
    }
    printf("%s: imbalance %.3f, %lld faces cut, neighbours %.1f, at most %d\n", path, d->quality.imbalance,
           (long long)d->quality.cut_faces, d->quality.neighbours_mean, d->quality.neighbours_max);
    fflush(stdout);
    rg_free(s.faces);
    rg_distribution_free(d);
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    box b = {.elements = TETS};
    bool right = argc >= 6;
    for (int i = 0; right && i < 3; i++) {
        b.cells[i] = atoll(argv[2 + i]);
        right = b.cells[i] > 0 && b.cells[i] < 1 << RG_HILBERT_BITS;
        b.elements *= right ? b.cells[i] : 1;
    }
    for (int i = 5; right && i < argc; i++) {
        right = atoi(argv[i]) > 0;
    }
    if (!right) {
        fputs(usage, stderr);
        MPI_Finalize();
        return RG_USAGE;
    }
    rg_mesh *mesh = make_mesh(&b);
    rg_tile_graph *g = rg_tile_graph_make(mesh, rg_mesh_tile(mesh));
    rg_mesh_free(mesh);
    for (int i = 5; i < argc; i++) {
        write_pattern(g, atoi(argv[i]), argv[1]);
    }
    rg_tile_graph_free(g);
    MPI_Finalize();
    return RG_OK;
}
