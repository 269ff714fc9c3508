/* Assembly of shared nodes against the node numbers of the mesh, on any number of ranks. Prints TAP from
 * rank 0.
 *
 * The copies of a node are found anew from the vertices: a corner by its number, a mid-edge by those of its
 * ends, on a plane of interfaces with the side on which the element lies. */
#include <math.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "domain/assembly.h"
#include "base/hash.h"
#include "base/mem.h"
#include "case/expr.h"
#include "support/fatal.h"
#include "support/tap.h"

enum { TILE = 32, CELLS = 4 };

/* Elements of three materials that differ in density alone, in turn. */
enum { MATERIALS = 3 };
static const rg_material matter[MATERIALS] = {{.lambda = 1, .mu = 1, .density = 2},
                                              {.lambda = 1, .mu = 1, .density = 7},
                                              {.lambda = 1, .mu = 1, .density = 0.5}};
static const rg_interface_material no_matter = {MATERIALS, matter, 1, RG_PENALTY_ELASTIC};

typedef struct {
    const char *name, *faces;
    double jitter;
    long long
        interfaces; /* two triangles to a square; 12 inside faces to a cube, less half of the surface's */
} subject;

static const subject subjects[] = {
    {"all joined", NULL, 0.2, 0},
    {"a plane of interfaces", "abs(z - 2) < 1e-6 && abs(nz) == 1 && nx == 0 && ny == 0", 0, 2 * CELLS *CELLS},
    {"half a plane", "abs(z - 2) < 1e-6 && x < 2", 0, CELLS *CELLS},
    {"interfaces everywhere", "1", 0.1, 12 * CELLS *CELLS *CELLS - 6 * CELLS *CELLS},
};

/* What a rank, or one alone, has. */
typedef struct {
    rg_part *part;
    rg_domain *domain;
    rg_conforming_faces *conforming_faces;
    rg_assembly *assembly;
    rg_real *field;
    uint16_t *mask;
} share;

/* ---- The reference ---- */

/* A node: its end vertices, lowest first, and a side of the plane. */
typedef struct {
    rg_gid end[2];
    int side;
    rg_gid element; /* a copy, and its node there */
    int node;
} copy;

static int by_node(const void *a, const void *b) {
    const copy *p = a, *q = b;
    const rg_gid left[3] = {p->end[0], p->end[1], p->side}, right[3] = {q->end[0], q->end[1], q->side};
    for (int k = 0; k < 3; k++) {
        if (left[k] != right[k]) {
            return left[k] < right[k] ? -1 : 1;
        }
    }
    return 0;
}

static double random_value(rg_gid element, int n, int c) {
    return 2 * rg_hash_uniform(rg_hash(rg_hash(7, (uint64_t)element), (uint64_t)(3 * n + c))) - 1;
}

static bool marked(rg_gid element, int n) {
    return rg_hash(rg_hash(9, (uint64_t)element), (uint64_t)n) % 50 == 0;
}

static double height_of(const rg_mesh *mesh, rg_gid vertex) {
    return mesh->x[3 * vertex + 2];
}

/* Whether a node with these ends lies in the part of the plane where nodes come apart: the edge of half a
 * plane, x = 2, stays whole. */
static bool parted(const rg_mesh *mesh, const subject *s, const rg_gid end[2]) {
    bool in = s->faces != NULL;
    for (int k = 0; k < 2; k++) {
        in = in && fabs(height_of(mesh, end[k]) - 2) < 1e-6;
    }
    bool half = s == &subjects[2];
    double x = 0.5 * (mesh->x[3 * end[0]] + mesh->x[3 * end[1]]);
    return in && (!half || x < 2 - 1e-6);
}

static copy copy_of(const rg_mesh *mesh, const subject *s, rg_gid e, int n) {
    static const int ends[RG_NODES][2] = {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {0, 1},
                                          {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
    copy c = {.element = e, .node = n};
    double above = 0;
    for (int k = 0; k < 2; k++) {
        c.end[k] = mesh->corner[4 * e + ends[n][k]]; /* corners ascend */
    }
    for (int k = 0; k < 4; k++) {
        above += height_of(mesh, mesh->corner[4 * e + k]) - 2;
    }
    c.side = s == &subjects[3] ? (int)e : parted(mesh, s, c.end) && above > 0;
    return c;
}

/* Mean over the copies of each node, weighed by the HRZ mass: mean[elements][nodes][3]; and whether one of
 * them is marked. */
static double *reference(const rg_mesh *mesh, const subject *s, bool *any) {
    size_t copies = (size_t)mesh->elements * RG_NODES;
    copy *list = RG_NEW(copy, copies);
    double *mean = RG_NEW(double, 3 * copies);
    for (size_t i = 0; i < copies; i++) {
        list[i] = copy_of(mesh, s, (rg_gid)(i / RG_NODES), (int)(i % RG_NODES));
    }
    qsort(list, copies, sizeof *list, by_node);
    for (size_t begin = 0, end; begin < copies; begin = end) {
        double mass = 0, sum[3] = {0, 0, 0};
        bool one = false;
        for (end = begin; end < copies && by_node(&list[begin], &list[end]) == 0; end++) {
            const rg_gid *v = mesh->corner + 4 * list[end].element;
            const double *x[4] = {mesh->x + 3 * v[0], mesh->x + 3 * v[1], mesh->x + 3 * v[2],
                                  mesh->x + 3 * v[3]};
            double d[3][3], own;
            for (int k = 0; k < 9; k++) {
                d[k / 3][k % 3] = x[1 + k / 3][k % 3] - x[0][k % 3];
            }
            own = fabs(d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) -
                       d[0][1] * (d[1][0] * d[2][2] - d[1][2] * d[2][0]) +
                       d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0])) *
                  (list[end].node < 4 ? 1.0 / 36 : 4.0 / 27) * matter[list[end].element % MATERIALS].density;
            mass += own;
            one = one || marked(list[end].element, list[end].node);
            for (int c = 0; c < 3; c++) {
                sum[c] += own * random_value(list[end].element, list[end].node, c);
            }
        }
        for (size_t k = begin; k < end; k++) {
            size_t at = (size_t)list[k].element * RG_NODES + (size_t)list[k].node;
            any[at] = one;
            for (int c = 0; c < 3; c++) {
                mean[3 * at + (size_t)c] = sum[c] / mass;
            }
        }
    }
    rg_free(list);
    return mean;
}

/* ---- What is tested ---- */

static share make_share(const subject *s, const rg_mesh *mesh, MPI_Comm comm) {
    rg_case c = {.path = "test"};
    char *message = NULL;
    int here;
    c.interface.form = RG_FORM_CONTINUOUS;
    c.interface.faces = s->faces == NULL ? NULL : rg_expr_new(s->faces, &message);
    MPI_Comm_rank(comm, &here);
    share a = {.part = rg_part_distribute(here == 0 ? mesh : NULL, TILE, comm)};
    for (rg_lid i = 0; i < a.part->elements; i++) {
        a.part->element[i].material = (uint8_t)(a.part->element[i].id % MATERIALS);
    }
    uint8_t *joined = rg_joined_faces(&c, a.part, comm);
    a.domain = rg_domain_build(a.part, joined, here, &no_matter);
    a.conforming_faces = rg_conforming_faces_make(a.domain, a.part, joined, here);
    a.assembly = rg_assembly_make(a.domain, a.conforming_faces, matter, comm);
    size_t slots = a.domain->blocks * RG_LANES;
    a.field = RG_NEW(rg_real, slots * 3 * RG_NODES);
    a.mask = RG_NEW(uint16_t, slots);
    for (size_t slot = 0; slot < slots; slot++) {
        rg_gid id = a.domain->id[slot];
        for (int k = 0; id >= 0 && k < 3 * RG_NODES; k++) {
            a.field[rg_node_index(slot, k / 3, k % 3)] = (rg_real)random_value(id, k / 3, k % 3);
            a.mask[slot] |= (uint16_t)(marked(id, k / 3) << k / 3);
        }
    }
    rg_assembly_mean(a.assembly, a.field);
    rg_assembly_spread(a.assembly, a.mask);
    rg_free(joined);
    rg_expr_free(c.interface.faces);
    return a;
}

static void free_share(share *a) {
    rg_assembly_free(a->assembly);
    rg_conforming_faces_free(a->conforming_faces);
    rg_domain_free(a->domain);
    rg_part_free(a->part);
    rg_free(a->field);
    rg_free(a->mask);
}

static void check(const subject *s, const rg_mesh *mesh) {
    share many = make_share(s, mesh, MPI_COMM_WORLD), one = make_share(s, mesh, MPI_COMM_SELF);
    bool *any = RG_NEW(bool, (size_t)mesh->elements *RG_NODES);
    double *mean = reference(mesh, s, any), error = 0;
    bool bits = true, masks = true;
    size_t *slot_of = RG_NEW(size_t, (size_t)mesh->elements);
    for (size_t slot = 0; slot < one.domain->blocks * RG_LANES; slot++) {
        if (one.domain->id[slot] >= 0) {
            slot_of[one.domain->id[slot]] = slot;
        }
    }
    for (size_t slot = 0; slot < many.domain->blocks * RG_LANES; slot++) {
        rg_gid id = many.domain->id[slot];
        for (int k = 0; id >= 0 && k < 3 * RG_NODES; k++) {
            rg_real here = many.field[rg_node_index(slot, k / 3, k % 3)];
            rg_real alone = one.field[rg_node_index(slot_of[id], k / 3, k % 3)];
            size_t at = (size_t)id * RG_NODES + (size_t)k / 3;
            error = fmax(error, fabs(here - mean[3 * at + (size_t)k % 3]));
            bits = bits && memcmp(&here, &alone, sizeof here) == 0;
            masks = masks && (many.mask[slot] >> k / 3 & 1) == any[at];
        }
    }
    report_figure(s->name, (figure){"shared nodes: means against those by the node numbers of the mesh",
                                    .found = error, .bound = 2e-15, .why = ROUNDING});
    report(bits, s->name, "the same bits on one rank");
    report(masks, s->name, "marks reach all copies");
    long long interfaces = (long long)many.domain->interfaces;
    MPI_Allreduce(MPI_IN_PLACE, &interfaces, 1, MPI_LONG_LONG, MPI_SUM, MPI_COMM_WORLD);
    report(interfaces == s->interfaces, s->name, "interfaces where they belong");
    rg_free(slot_of);
    rg_free(mean);
    rg_free(any);
    free_share(&many);
    free_share(&one);
}

/* A selection that is no number somewhere ends the run with the lowest such place. (On one rank: others
 * would wait for its end.) */
static void check_not_finite(const rg_mesh *mesh) {
    char *message = NULL;
    rg_case c = {.path = "test"};
    c.interface.form = RG_FORM_CONTINUOUS;
    c.interface.faces = rg_expr_new("1/(z - 2)", &message);
    rg_part *part = rg_part_distribute(mesh, TILE, MPI_COMM_SELF);
    expect_fatal = true;
    if (setjmp(escape) == 0) {
        rg_joined_faces(&c, part, MPI_COMM_SELF);
        fatal_status = RG_OK;
    }
    expect_fatal = false;
    report(fatal_status == RG_USAGE &&
               strcmp(said, "test: interface.faces: 1/(z - 2) is not finite at (0.333333, 0.666667, 2)") == 0,
           "a selection", "must be finite");
    rg_part_free(part);
    rg_expr_free(c.interface.faces);
}

int main(int argc, char **argv) {
    const int64_t cells[3] = {CELLS, CELLS, CELLS};
    const double origin[3] = {0, 0, 0}, size[3] = {CELLS, CELLS, CELLS};
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    for (size_t i = 0; i < sizeof subjects / sizeof *subjects; i++) {
        rg_mesh *mesh = rg_mesh_box(cells, origin, size, subjects[i].jitter, 3); /* on every rank */
        check(&subjects[i], mesh);
        if (i == 1) {
            check_not_finite(mesh);
        }
        rg_mesh_free(mesh);
    }
    return finish();
}
