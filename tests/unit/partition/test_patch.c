/* The largest frequency found on a patch against the whole mesh's, on any number of ranks. Prints TAP from
 * rank 0. */
#include <math.h>
#include <mpi.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "case/expr.h"
#include "partition/material.h"
#include "partition/material_map.h"
#include "partition/patch.h"
#include "solver/setup.h"
#include "solver/spectrum.h"
#include "support/sanitized.h"
#include "support/tap.h"

/* Relative to omega^2 of the whole mesh. The patch gives a lower bound; its error and that of both iterations
 * (up to 0.3 % each) must leave the margin of 2 % its use. */
#define BELOW 8e-3
#define ABOVE 3e-3

/* ---- Cases ---- */

static const struct box {
    const char *name;
    int64_t cells[3];
    double size[3], jitter, grading; /* grading: how much farther apart planes are at the upper end */
} boxes[] = {
    {"regular", {10, 10, 10}, {10, 10, 10}, 0, 0},
    {"slightly jittered", {10, 10, 10}, {10, 10, 10}, 0.01, 0},
    {"jittered", {10, 10, 10}, {10, 10, 10}, 0.1, 0},
    {"much jittered", {10, 10, 10}, {10, 10, 10}, 0.25, 0},
    {"long cells", {10, 10, 10}, {10, 10, 50}, 0.05, 0},
    {"flat cells", {10, 10, 10}, {10, 10, 2}, 0, 0},
    {"graded", {10, 10, 10}, {10, 10, 10}, 0.1, 3},
    {"bar", {3, 3, 100}, {3, 3, 100}, 0.1, 0},
};

static const struct physics {
    rg_form form;
    rg_penalty penalty;
    rg_mass mass;
    double beta_s;
    const char *where;     /* of another material; NULL: there is none */
    double young, density; /* its */
} kinds[] = {
    {RG_FORM_VARIATIONAL, RG_PENALTY_ELASTIC, RG_MASS_CONSISTENT, 4, NULL, 0, 0},
    {RG_FORM_VARIATIONAL, RG_PENALTY_ISOTROPIC, RG_MASS_LUMPED, 4, NULL, 0, 0},
    {RG_FORM_INCOMPLETE, RG_PENALTY_ELASTIC, RG_MASS_LUMPED, 20, NULL, 0, 0},
    /* faster waves in the upper half; stiff and heavy beside soft and light, where the faces between limit */
    {RG_FORM_VARIATIONAL, RG_PENALTY_ELASTIC, RG_MASS_CONSISTENT, 4, "y > 6.3", 400e9, 1500},
    {RG_FORM_VARIATIONAL, RG_PENALTY_ELASTIC, RG_MASS_LUMPED, 4, "x + z > 9.5", 2e9, 1000},
};
enum { BOXES = sizeof boxes / sizeof *boxes, KINDS = sizeof kinds / sizeof *kinds };

static rg_case make_case(const struct physics *p) {
    rg_case c = {.material = {.young = 260e9, .poisson = 0.21, .density = 3690}, .mass = p->mass};
    c.interface.form = p->form;
    c.interface.penalty = p->penalty;
    c.interface.beta_s = p->beta_s;
    c.interface.law = RG_LAW_LINEAR;
    c.interface.strength = 400e6;
    c.interface.energy = 34;
    c.interface.beta = 1;
    if (p->where != NULL) {
        char *message = NULL;
        c.others = 1;
        c.other = RG_NEW(rg_other_material, 1);
        c.other->is = (rg_material_input){.young = p->young, .poisson = 0.35, .density = p->density};
        c.other->where = rg_expr_new(p->where, &message);
    }
    return c;
}

static void free_case(rg_case *c) {
    rg_expr_free(c->others > 0 ? c->other->where : NULL);
    rg_free(c->other);
}

static rg_part *make_part(const rg_case *c, const struct box *b, MPI_Comm comm) {
    const double origin[3] = {0, 0, 0};
    int here;
    MPI_Comm_rank(comm, &here);
    rg_mesh *mesh = here == 0 ? rg_mesh_box(b->cells, origin, b->size, b->jitter, 3) : NULL;
    for (rg_gid k = 0; mesh != NULL && k < 3 * mesh->vertices; k++) {
        double s = mesh->x[k] / b->size[k % 3];
        mesh->x[k] *= 1 + b->grading * s;
    }
    rg_part *part = rg_part_distribute(mesh, mesh == NULL ? 0 : rg_mesh_tile(mesh), comm);
    rg_mesh_free(mesh);
    rg_materials_assign(c, part, comm);
    return part;
}

static rg_solver *make_solver(const rg_case *c, const struct box *b, MPI_Comm comm) {
    rg_material *material = rg_materials_of_case(c);
    rg_part *part = make_part(c, b, comm), *patch = rg_patch_gather(part, material, comm);
    rg_free(material);
    rg_solver *s = rg_solver_make_from_part(c, part, comm);
    s->patch = patch;
    return s;
}

/* ---- Checks ---- */

static void check_frequency(const struct box *b, const struct physics *p) {
    rg_case c = make_case(p);
    rg_solver *s = make_solver(&c, b, MPI_COMM_WORLD), *alone = make_solver(&c, b, MPI_COMM_SELF);
    rg_spectrum(s);
    rg_spectrum(alone);
    report(memcmp(&s->omega2, &alone->omega2, sizeof s->omega2) == 0 && s->limiting == alone->limiting &&
               strcmp(s->limiting_state, alone->limiting_state) == 0,
           b->name, "the same on one rank");
    double patch = s->omega2;
    rg_spectrum_whole(s);
    double error = patch / s->omega2 - 1;
    if (rank == 0) {
        printf("# omega^2 of the patch %+.2e\n", error);
    }
    report(error > -BELOW && error < ABOVE, b->name, "close to the whole mesh");
    rg_solver_free(s);
    rg_solver_free(alone);
    free_case(&c);
}

static int by_number(const void *a, const void *b) {
    const rg_gid *p = a, *q = b;
    return (*p > *q) - (*p < *q);
}

/* Number in the patch of element `original` of the mesh. */
static rg_gid find(const rg_part *p, rg_gid original) {
    const rg_gid *found = bsearch(&original, p->original, (size_t)p->elements, sizeof original, by_number);
    return found == NULL ? -1 : found - p->original;
}

/* ---- The choice, by plain loops over the whole mesh ---- */

typedef struct {
    const rg_mesh *mesh;
    const double *worse; /* [elements]: their ranks */
    bool *in;            /* [elements] */
    int count;
} choice;

static void join(choice *c, rg_gid e) {
    if (!c->in[e] && c->count < RG_PATCH_MOST) {
        c->in[e] = true;
        c->count++;
    }
}

/* All beside what has joined, the lowest numbers first. */
static void add_ring(choice *c) {
    bool *before = RG_NEW(bool, (size_t)c->mesh->elements);
    memcpy(before, c->in, (size_t)c->mesh->elements);
    for (rg_gid e = 0; e < c->mesh->elements; e++) {
        for (int f = 0; f < 4; f++) {
            rg_gid other = c->mesh->neighbour[4 * e + f];
            if (other >= 0 && before[other]) {
                join(c, e);
            }
        }
    }
    rg_free(before);
}

/* 1,000 elements around the worst one; the 64 worst and four rings around all; the 256 worst and four more.
 */
static void choose(choice *c) {
    rg_gid *order = RG_NEW(rg_gid, 256);
    bool *taken = RG_NEW(bool, (size_t)c->mesh->elements);
    for (int k = 0; k < 256; k++) {
        rg_gid worst = -1;
        for (rg_gid e = 0; e < c->mesh->elements; e++) {
            worst = !taken[e] && (worst < 0 || c->worse[e] > c->worse[worst]) ? e : worst;
        }
        order[k] = worst;
        taken[worst] = true;
    }
    join(c, order[0]);
    while (c->count < 1000) {
        add_ring(c);
    }
    for (int seeds = 64; seeds <= 256; seeds *= 4) {
        for (int k = 0; k < seeds; k++) {
            join(c, order[k]);
        }
        for (int r = 0; r < 4; r++) {
            add_ring(c);
        }
    }
    rg_free(order);
    rg_free(taken);
}

/* Against the choice above; all that is known of the elements comes along, in a mesh of the patch's own. */
static bool well_chosen(const rg_part *patch, const rg_part *part, const rg_mesh *mesh,
                        const rg_material *material) {
    size_t n = (size_t)mesh->elements;
    double *worse = RG_NEW(double, n);
    choice c = {mesh, worse, RG_NEW(bool, n), 0};
    rg_element *all = RG_NEW(rg_element, n);
    for (rg_lid i = 0; i < part->elements; i++) {
        worse[part->element[i].id] = rg_patch_rank(&part->element[i], material);
        all[part->element[i].id] = part->element[i];
    }
    MPI_Allreduce(MPI_IN_PLACE, worse, (int)n, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    MPI_Allreduce(MPI_IN_PLACE, all, (int)(n * sizeof *all), MPI_BYTE, MPI_BOR, MPI_COMM_WORLD);
    n > RG_PATCH_MOST ? choose(&c) : (void)memset(c.in, 1, n);
    bool good = patch == NULL ||
                (memcmp(patch->box, part->box, sizeof patch->box) == 0 &&
                 patch->tile == rg_tile_elements(patch->total, RG_TILE) && patch->total == patch->elements);
    rg_gid at = 0, sides = 0;
    for (rg_gid e = 0; patch != NULL && e < mesh->elements; e++) {
        if (c.in[e]) {
            const rg_element *p = &patch->element[at < patch->elements ? at : 0], *w = &all[e];
            good = good && at < patch->elements && patch->original[at] == e && p->volume == w->volume &&
                   p->material == w->material && memcmp(p->x, w->x, sizeof p->x) == 0 &&
                   memcmp(p->other_volume, w->other_volume, sizeof p->other_volume) == 0 &&
                   memcmp(p->beside, w->beside, sizeof p->beside) == 0;
            for (int f = 0; f < 4; f++) {
                sides += mesh->neighbour[4 * e + f] >= 0 && c.in[mesh->neighbour[4 * e + f]];
            }
            at++;
        }
    }
    good = good && (patch == NULL || (at == patch->elements && patch->interfaces == sides / 2));
    rg_free(worse);
    rg_free(c.in);
    rg_free(all);
    return good;
}

/* Numbered in the order of the mesh, in whole tiles; neighbours know each other; faces to elements outside,
 * and no others, are cut. */
static bool well_connected(const rg_part *patch, const rg_mesh *mesh) {
    bool good = (rg_gid)patch->tiles * patch->tile >= patch->total &&
                (rg_gid)(patch->tiles - 1) * patch->tile < patch->total && patch->boundary == 0 &&
                patch->total == patch->elements && patch->tile == rg_tile_elements(patch->total, RG_TILE);
    rg_gid sides = 0;
    for (rg_lid t = 0; t < patch->tiles; t++) {
        good = good && patch->tile_id[t] == t;
    }
    for (rg_lid i = 0; i < patch->elements; i++) {
        const rg_element *e = &patch->element[i];
        rg_gid original = patch->original[i];
        good = good && e->id == i && (i == 0 || patch->original[i - 1] < original);
        for (int f = 0; f < 4; f++) {
            rg_gid other = mesh->neighbour[4 * original + f], here = find(patch, other);
            good = good && e->neighbour[f] == here && e->owner[f] == (here < 0 ? -1 : 0) &&
                   e->face[f] == (here < 0 ? -1 : mesh->face[4 * original + f]) &&
                   e->set[f] == (here < 0 && other >= 0 ? RG_PATCH_CUT : -1);
            sides += here >= 0;
        }
    }
    return good && sides == 2 * patch->interfaces;
}

static void check_patch(void) {
    const double origin[3] = {0, 0, 0};
    static const struct box small = {"small", {3, 4, 5}, {3, 4, 5}, 0.1, 0};
    const struct box *each[2] = {&small, &boxes[3]};
    rg_case c = make_case(&kinds[0]);
    rg_material material = rg_material_make(&c.material);
    for (int k = 0; k < 2; k++) {
        rg_mesh *mesh = rg_mesh_box(each[k]->cells, origin, each[k]->size, each[k]->jitter, 3);
        rg_part *part = make_part(&c, each[k], MPI_COMM_WORLD);
        rg_part *patch = rg_patch_gather(part, &material, MPI_COMM_WORLD);
        report((patch != NULL) == (rank == 0), each[k]->name, "a patch on rank 0");
        report(patch == NULL || (k == 0 ? patch->elements == mesh->elements
                                        : patch->elements > 1000 && patch->elements <= RG_PATCH_MOST),
               each[k]->name, "size of the patch");
        report(patch == NULL || well_connected(patch, mesh), each[k]->name, "links of the patch");
        report(well_chosen(patch, part, mesh, &material), each[k]->name, "elements of the patch");
        rg_part_free(part);
        rg_part_free(patch);
        rg_mesh_free(mesh);
    }
}

/* An inner tetrahedron of a cube of edge 2: volume 8/6, two faces of area 2, two of area 2 sqrt 2. */
static void check_rank(void) {
    static const rg_material two[2] = {{.lambda = 1, .mu = 1, .density = 2},
                                       {.lambda = 5, .mu = 5, .density = 5}};
    rg_element e = {.x = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {2, 2, 2}}, .volume = 8.0 / 6};
    for (int f = 0; f < 4; f++) {
        e.other_volume[f] = 8.0 / 6;
    }
    report(fabs(rg_patch_rank(&e, two) - 2 * 13.5) < 1e-12, "rank", "regular");
    e.neighbour[1] = -1; /* area 2 sqrt 2 */
    report(fabs(rg_patch_rank(&e, two) - 2 * 9) < 1e-12, "rank", "with a surface face");
    e.neighbour[1] = 0;
    e.other_volume[0] = 4.0 / 6; /* twice the penalty, three times the inverse mass of the pair over 2 */
    report(fabs(rg_patch_rank(&e, two) - (2 * 11.25 + 2.25 * 2 * 3)) < 1e-12, "rank",
           "with a small neighbour");
    e.other_volume[0] = 8.0 / 6;
    e.beside[0] = 1; /* area 2: mean of the moduli 3, mean of the inverse masses 0.7 */
    report(fabs(rg_patch_rank(&e, two) - (27 - 4.5 + 4.5 * 3 * 0.7)) < 1e-12, "rank",
           "with a stiff neighbour");
}

/* Each mesh once, and on one rank two materials on every third one; two meshes with sanitizers, which slow
 * everything down. */
static bool wanted(int b, int k) {
    if (RG_SANITIZED) {
        return k == b && (b == 0 || b == 3);
    }
    int ranks;
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    bool mixed = kinds[k].where != NULL;
    return k == b % KINDS || (ranks == 1 && mixed && b % 3 == 0);
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    check_rank();
    check_patch();
    for (int b = 0; b < BOXES; b++) {
        for (int k = 0; k < KINDS; k++) {
            if (wanted(b, k)) {
                check_frequency(&boxes[b], &kinds[k]);
            }
        }
    }
    return finish();
}
