/* Distribution of a mesh, on any number of ranks. Prints TAP from rank 0. */
#include <math.h>
#include <mpi.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "base/hilbert.h"
#include "base/mem.h"
#include "base/tet.h"
#include "mesh/mesh.h"
#include "support/tap.h"

static int ranks;

static const struct box {
    const char *name;
    int64_t cells[3];
    double origin[3], size[3], jitter;
    int tile; /* elements */
} boxes[] = {
    {"one cell", {1, 1, 1}, {0, 0, 0}, {1, 1, 1}, 0, 1},
    {"three tiles, one ragged", {1, 1, 2}, {0, 0, 0}, {1, 1, 1}, 0, 5},
    {"bar", {3, 3, 30}, {-0.2e-3, -0.2e-3, -2e-3}, {0.4e-3, 0.4e-3, 4e-3}, 0.12, 24},
    {"bar in single elements", {2, 2, 20}, {0, 0, 0}, {0.1, 0.1, 1}, 0.1, 1},
    {"block", {16, 14, 18}, {1, 2, 3}, {1.6, 1.2, 2.0}, 0.1, 256},
};
enum { BOXES = sizeof boxes / sizeof boxes[0], CHECKS = 12 };

/* What all ranks know together. */
struct whole {
    const rg_mesh *mesh; /* the same on every rank */
    const rg_part *part; /* own */
    rg_gid *copies;      /* [elements]: on how many ranks */
    rg_gid *owner;       /* [elements] */
    double *volume;      /* [elements] */
};

static struct whole gather(const rg_mesh *mesh, const rg_part *part) {
    size_t n = (size_t)mesh->elements;
    struct whole w = {mesh, part, RG_NEW(rg_gid, n), RG_NEW(rg_gid, n), RG_NEW(double, n)};
    for (rg_lid i = 0; i < part->elements; i++) {
        rg_gid id = part->element[i].id;
        if (id >= 0 && id < mesh->elements) {
            w.copies[id]++;
            w.owner[id] = rank;
            w.volume[id] = part->element[i].volume;
        }
    }
    MPI_Allreduce(MPI_IN_PLACE, w.copies, (int)n, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
    MPI_Allreduce(MPI_IN_PLACE, w.owner, (int)n, MPI_INT64_T, MPI_MAX, MPI_COMM_WORLD);
    MPI_Allreduce(MPI_IN_PLACE, w.volume, (int)n, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    return w;
}

static void release(struct whole *w) {
    rg_free(w->copies);
    rg_free(w->owner);
    rg_free(w->volume);
}

static bool header_right(const struct whole *w, const struct box *b) {
    const rg_part *p = w->part;
    const int64_t *n = b->cells;
    rg_gid surface = 4 * (n[0] * n[1] + n[1] * n[2] + n[2] * n[0]);
    bool good =
        p->total == w->mesh->elements && p->interfaces == (4 * p->total - surface) / 2 && p->tile == b->tile;
    for (int i = 0; i < 3; i++) {
        good = good && p->box[0][i] == b->origin[i] && p->box[1][i] == b->origin[i] + b->size[i];
    }
    return good;
}

static bool names_right(const struct whole *w) {
    bool good = w->part->surface.count == w->mesh->surface.count;
    for (int s = 0; good && s < w->part->surface.count; s++) {
        good = strcmp(w->part->surface.name[s], w->mesh->surface.name[s]) == 0;
    }
    return good;
}

static bool every_element_once(const struct whole *w) {
    bool good = true;
    for (rg_gid e = 0; e < w->mesh->elements; e++) {
        good = good && w->copies[e] == 1;
    }
    return good;
}

/* No rank empty; within a tile, or 10 %, of even where there are enough elements. */
static bool balanced(const struct whole *w) {
    double even = (double)w->mesh->elements / ranks, own = (double)w->part->elements;
    double slack = fmax(0.1 * even, w->part->tile);
    return w->part->tiles >= 1 && own >= 1 && (even < 500 || fabs(own - even) <= slack);
}

/* Each tile on one rank, as a whole and in the order of its elements. */
static bool whole_tiles(const struct whole *w) {
    const rg_part *p = w->part;
    bool good = true;
    rg_lid at = 0;
    for (rg_lid t = 0; good && t < p->tiles; t++) {
        rg_gid first = p->tile_id[t] * p->tile, left = w->mesh->elements - first;
        good = first >= 0 && left > 0 && rg_tile_size(p, p->tile_id[t]) == (left < p->tile ? left : p->tile);
        for (rg_gid e = first; good && e < first + p->tile && e < w->mesh->elements; e++, at++) {
            good = at < p->elements && p->element[at].id == e;
        }
    }
    return good && at == p->elements;
}

static bool same_as_mesh(const struct whole *w, const rg_element *e) {
    const rg_mesh *m = w->mesh;
    bool good = memcmp(e->neighbour, m->neighbour + 4 * e->id, sizeof e->neighbour) == 0 &&
                memcmp(e->face, m->face + 4 * e->id, sizeof e->face) == 0 &&
                memcmp(e->set, m->set + 4 * e->id, sizeof e->set) == 0;
    for (int i = 0; i < 4; i++) {
        good = good && memcmp(e->x[i], m->x + 3 * m->corner[4 * e->id + i], sizeof e->x[i]) == 0;
    }
    return good;
}

static bool owners_right(const struct whole *w, const rg_element *e) {
    bool good = true;
    for (int f = 0; f < 4; f++) {
        good = good && e->owner[f] == (e->neighbour[f] < 0 ? -1 : w->owner[e->neighbour[f]]);
    }
    return good;
}

static bool volume_right(const struct whole *w, const rg_element *e) {
    (void)w;
    double v = fabs(rg_tet_volume(e->x[0], e->x[1], e->x[2], e->x[3]));
    return e->volume > 0.0 && fabs(e->volume - v) < 1e-12 * v;
}

/* Bit for bit: both ranks of a face must compute the same from it. */
static bool other_volumes_right(const struct whole *w, const rg_element *e) {
    bool good = true;
    for (int f = 0; f < 4; f++) {
        rg_gid other = e->neighbour[f] < 0 ? e->id : e->neighbour[f];
        good = good && memcmp(&e->other_volume[f], &w->volume[other], sizeof(double)) == 0;
    }
    return good;
}

static bool all_elements(const struct whole *w, bool (*right)(const struct whole *, const rg_element *)) {
    bool good = true;
    for (rg_lid i = 0; i < w->part->elements; i++) {
        good = good && right(w, w->part->element + i);
    }
    return good;
}

static bool touches_other_rank(const rg_element *e) {
    bool shared = false;
    for (int f = 0; f < 4; f++) {
        shared = shared || (e->owner[f] >= 0 && e->owner[f] != rank);
    }
    return shared;
}

/* Tiles that touch another rank, then the others, each by ascending number. */
static bool boundary_first(const struct whole *w) {
    const rg_part *p = w->part;
    bool good = p->boundary <= p->tiles && (p->boundary > 0) == (ranks > 1);
    const rg_element *e = p->element;
    for (rg_lid t = 0; t < p->tiles; t++) {
        bool shared = false;
        for (rg_lid i = 0; i < rg_tile_size(p, p->tile_id[t]); i++, e++) {
            shared = shared || touches_other_rank(e);
        }
        good = good && shared == (t < p->boundary);
        good = good && (t == 0 || t == p->boundary || p->tile_id[t - 1] < p->tile_id[t]);
    }
    return good;
}

/* Places on the curve, in units of the mean element. */
static void keys(const struct whole *w, uint64_t *key_of) {
    const double(*box)[3] = (const double(*)[3])w->part->box, origin[3] = {0, 0, 0};
    double extent[3], edge = 0.0, x[3];
    rg_mesh_mean_extent(w->mesh, box, extent);
    for (int i = 0; i < 3; i++) {
        edge = fmax(edge, (box[1][i] - box[0][i]) / extent[i]);
    }
    for (rg_lid k = 0; k < w->part->elements; k++) {
        const rg_element *e = &w->part->element[k];
        for (int i = 0; i < 3; i++) {
            x[i] = (0.25 * ((e->x[0][i] + e->x[1][i]) + (e->x[2][i] + e->x[3][i])) - box[0][i]) / extent[i];
        }
        key_of[k] = rg_hilbert_point(x, origin, edge);
    }
}

/* All of the mesh's elements by ascending number: along the curve within each group of tiles. */
static bool along_curve(const struct whole *w) {
    const rg_part *p = w->part;
    bool good = true;
    rg_lid first_inner = 0;
    for (rg_lid t = 0; t < p->boundary; t++) {
        first_inner += rg_tile_size(p, p->tile_id[t]);
    }
    uint64_t *key_of = RG_NEW(uint64_t, (size_t)p->elements);
    keys(w, key_of);
    for (rg_lid i = 1; i < p->elements; i++) {
        good = good && (i == first_inner || key_of[i - 1] < key_of[i]);
    }
    rg_free(key_of);
    return good;
}

/* Neighbours of the same rank and class are near each other in the order: not farther, in the mean, than the
 * number of elements in a section through a cube of `count`, which is what a curve that fills space can give.
 * A random order gives count / 3, well above that for the counts tried here. */
static bool local(const struct whole *w) {
    rg_lid begin = 0;
    for (rg_lid t = 0; t < w->part->boundary; t++) {
        begin += rg_tile_size(w->part, w->part->tile_id[t]);
    }
    rg_lid count = w->part->elements - begin;
    if (count < 500) {
        return true;
    }
    rg_gid *index = RG_NEW(rg_gid, (size_t)w->mesh->elements);
    for (rg_lid i = begin; i < w->part->elements; i++) {
        index[w->part->element[i].id] = i + 1; /* 0: elsewhere */
    }
    double sum = 0.0, pairs = 0.0;
    for (rg_lid i = begin; i < w->part->elements; i++) {
        for (int f = 0; f < 4; f++) {
            rg_gid other = w->part->element[i].neighbour[f];
            if (other >= 0 && index[other] > 0) {
                sum += fabs((double)(index[other] - 1 - i));
                pairs += 1.0;
            }
        }
    }
    rg_free(index);
    return pairs > 0.0 && sum / pairs < pow(count, 2.0 / 3.0);
}

static void check_box(const struct box *b) {
    rg_mesh *mesh = rg_mesh_box(b->cells, b->origin, b->size, b->jitter, 5);
    rg_part *part = rg_part_distribute(rank == 0 ? mesh : NULL, rank == 0 ? b->tile : 0, MPI_COMM_WORLD);
    struct whole w = gather(mesh, part);
    report(header_right(&w, b), b->name, "counts and box");
    report(names_right(&w), b->name, "names of the sets");
    report(every_element_once(&w), b->name, "every element on exactly one rank");
    report(balanced(&w), b->name, "ranks balanced");
    report(whole_tiles(&w), b->name, "whole tiles");
    report(all_elements(&w, same_as_mesh), b->name, "elements as in the mesh");
    report(all_elements(&w, owners_right), b->name, "owners of neighbours");
    report(all_elements(&w, volume_right), b->name, "volumes");
    report(all_elements(&w, other_volumes_right), b->name, "neighbours' volumes bit for bit");
    report(boundary_first(&w), b->name, "boundary tiles first, each group by number");
    report(along_curve(&w), b->name, "along the Hilbert curve");
    report(local(&w), b->name, "neighbours near in the order");
    release(&w);
    rg_part_free(part);
    rg_mesh_free(mesh);
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    if (rank == 0) {
        printf("1..%d\n", BOXES * CHECKS);
    }
    for (int b = 0; b < BOXES; b++) {
        check_box(&boxes[b]);
    }
    MPI_Finalize();
    return failures > 0;
}
