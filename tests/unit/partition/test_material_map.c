/* Which element is of which material, and what its neighbours are, on any number of ranks; against a loop
 * over the whole mesh. Prints TAP from rank 0. */
#include <math.h>
#include <mpi.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/first_bad.h"
#include "base/mem.h"
#include "case/expr.h"
#include "partition/material_map.h"
#include "support/fatal.h"
#include "support/tap.h"

static const int64_t cells[3] = {4, 3, 7};
static const double origin[3] = {0.5, -1, 2}, size[3] = {2, 3, 7};

static void centroid(const rg_mesh *m, rg_gid e, double x[3]) {
    for (int i = 0; i < 3; i++) {
        x[i] = 0;
        for (int k = 0; k < 4; k++) {
            x[i] += m->x[3 * m->corner[4 * e + k] + i] / 4;
        }
    }
}

/* Material of an element: `low` has what is below x = 1.3, `set` volume set 1 (and group 2, of both), `slab`
 * what is between two planes, the last that claims one has it. */
static int expected_material(const rg_mesh *m, rg_gid e) {
    double x[3];
    centroid(m, e, x);
    return x[2] > 4.1 && x[1] < 0.7 ? 3 : m->region[e] >= 1 ? 2 : x[0] < 1.3 ? 1 : 0;
}

static rg_mesh *make_mesh(void) {
    static const char *const names[2] = {"core", "shell"};
    rg_mesh *m = rg_mesh_box(cells, origin, size, 0.1, 3);
    m->region = RG_NEW(int32_t, (size_t)m->elements);
    for (int r = 0; r < 2; r++) {
        rg_sets_add(&m->volume, names[r]);
    }
    rg_sets_combine(&m->volume, 2, (const int32_t[]){0, 1});
    for (rg_gid e = 0; e < m->elements; e++) {
        m->region[e] = (int32_t)(e * e % 7 - 1 > 2 ? 2 : e * e % 7 - 1);
    }
    return m;
}

static rg_expr *expression(const char *text) {
    char *message = NULL;
    return rg_expr_new(text, &message);
}

static void check_claims(const rg_mesh *m, int tile) {
    rg_other_material other[3] = {{.where = expression("x < 1.3")},
                                  {.set = (char[]){"shell"}},
                                  {.where = expression("z > 4.1 && y < 0.7")}};
    rg_case c = {.path = (char[]){"a.yaml"}, .others = 3, .other = other};
    rg_part *part = rg_part_distribute(rank == 0 ? m : NULL, tile, MPI_COMM_WORLD);
    bool own = true, beside = true, across = true;
    int seen[4] = {0};
    rg_materials_assign(&c, part, MPI_COMM_WORLD);
    for (rg_lid i = 0; i < part->elements; i++) {
        const rg_element *e = &part->element[i];
        own = own && e->material == expected_material(m, e->id);
        seen[expected_material(m, e->id)]++;
        for (int f = 0; f < 4; f++) {
            rg_gid other_id = m->neighbour[4 * e->id + f];
            beside = beside && e->beside[f] == expected_material(m, other_id < 0 ? e->id : other_id);
            bool differ = other_id >= 0 && (expected_material(m, other_id) != expected_material(m, e->id) ||
                                            m->region[other_id] != m->region[e->id]);
            across = across && (e->across >> f & 1) == differ;
        }
    }
    MPI_Allreduce(MPI_IN_PLACE, seen, 4, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
    report(own && seen[0] > 0 && seen[1] > 0 && seen[2] > 0 && seen[3] > 0, "box", "materials");
    report(beside, "box", "materials of neighbours");
    report(across, "box", "where sets or materials differ");
    report(rg_sets_find(&part->volume, "core") == 0 && rg_sets_find(&part->volume, "shell") == 1 &&
               rg_sets_find(&part->volume, "cor") == -1 && rg_sets_find(&part->surface, "x-") == 0 &&
               rg_sets_find(&part->surface, "z+") == 5 && rg_sets_find(&part->surface, "core") == -1,
           "box", "sets by their names");
    bool region = true;
    for (rg_lid i = 0; i < part->elements; i++) {
        region = region && part->element[i].region == m->region[part->element[i].id];
    }
    report(region && part->volume.count == 2, "box", "volume sets of elements");
    rg_part_free(part);
    part = rg_part_distribute(rank == 0 ? m : NULL, tile, MPI_COMM_WORLD);
    c.others = 0;
    rg_materials_assign(&c, part, MPI_COMM_WORLD);
    bool none = true;
    for (rg_lid i = 0; i < part->elements; i++) {
        none = none && part->element[i].material == 0;
    }
    report(none, "box", "one material");
    rg_part_free(part);
    rg_expr_free(other[0].where);
    rg_expr_free(other[2].where);
}

/* Angles of the axes of an element: what is below x = 1.3 has them by expressions, the rest none. */
static void expected_angles(const rg_mesh *m, rg_gid e, double angles[3]) {
    double x[3];
    centroid(m, e, x);
    bool low = x[0] < 1.3;
    angles[0] = low ? 90 * x[0] + x[2] : 0;
    angles[1] = 0;
    angles[2] = low ? 7 - 3 * x[1] : 0;
}

static bool are_angles(const double got[3], const double expected[3]) {
    bool right = true;
    for (int k = 0; k < 3; k++) {
        right = right && fabs(got[k] - expected[k]) < 1e-12;
    }
    return right;
}

static void check_axes(const rg_mesh *m, int tile) {
    rg_other_material other[1] = {{.where = expression("x < 1.3"), .is.model = RG_MATERIAL_ANISOTROPIC}};
    other[0].is.anisotropic.angle[0] = expression("90*x + z");
    other[0].is.anisotropic.angle[2] = expression("7 - 3*y");
    rg_case c = {.path = (char[]){"a.yaml"}, .others = 1, .other = other};
    rg_part *part = rg_part_distribute(rank == 0 ? m : NULL, tile, MPI_COMM_WORLD);
    rg_materials_assign(&c, part, MPI_COMM_WORLD);
    bool own = part->turn != NULL, beside = own;
    for (rg_lid i = 0; i < part->elements && own; i++) {
        const rg_element *e = &part->element[i];
        double expected[3];
        expected_angles(m, e->id, expected);
        own = own && are_angles(part->turn[i].own, expected) && part->turn[i].id == e->id;
        for (int f = 0; f < 4; f++) {
            expected_angles(m, e->neighbour[f] < 0 ? e->id : e->neighbour[f], expected);
            beside = beside && are_angles(part->turn[i].beside[f], expected);
        }
    }
    report(own, "axes", "of elements");
    report(beside, "axes", "of neighbours");
    rg_part_free(part);
    rg_expr_free(other[0].where);
    rg_expr_free(other[0].is.anisotropic.angle[0]);
    rg_expr_free(other[0].is.anisotropic.angle[2]);
}

/* More grains than a byte counts, each a set with a material of its own; without materials the boundaries of
 * grains are known where an entry of interface.sets asks for them. */
static void check_grains(void) {
    enum { GRAINS = 300 };
    rg_mesh *m = rg_mesh_box(cells, origin, size, 0.1, 3);
    m->region = RG_NEW(int32_t, (size_t)m->elements);
    rg_other_material other[GRAINS] = {{.set = NULL}};
    for (int g = 0; g < GRAINS; g++) {
        char name[16];
        snprintf(name, sizeof name, "grain.%d", g);
        rg_sets_add(&m->volume, name);
        other[g].set = m->volume.name[g];
    }
    for (rg_gid e = 0; e < m->elements; e++) {
        m->region[e] = (int32_t)(e * 7 / 11 % GRAINS);
    }
    char *any[] = {(char[]){"any"}};
    rg_face_set set = {.names = 1, .between = any};
    for (int own = 0; own < 2; own++) {
        rg_case c = {.path = (char[]){"a.yaml"}, .others = own ? GRAINS : 0, .other = other};
        c.interface.sets = own ? 0 : 1;
        c.interface.set = &set;
        rg_part *part = rg_part_distribute(rank == 0 ? m : NULL, 25, MPI_COMM_WORLD);
        rg_materials_assign(&c, part, MPI_COMM_WORLD);
        bool right = true, across = true;
        for (rg_lid i = 0; i < part->elements; i++) {
            const rg_element *e = &part->element[i];
            right = right && e->material == (own ? m->region[e->id] + 1 : 0);
            for (int f = 0; f < 4; f++) {
                rg_gid other_id = m->neighbour[4 * e->id + f];
                bool differ = other_id >= 0 && m->region[other_id] != m->region[e->id];
                across = across && (e->across >> f & 1) == differ;
            }
        }
        report(right, "grains", own ? "a material each" : "one material");
        report(across, "grains", "their boundaries");
        rg_part_free(part);
    }
    rg_mesh_free(m);
}

/* Whether rank 0 ends the run with these words; the others wait for it, which rank 0 lets them do no longer
 * then. */
static bool refused(const rg_mesh *m, int others, rg_other_material *other, const char *words) {
    rg_case c = {.path = (char[]){"a.yaml"}, .others = others, .other = other};
    c.mesh.file = (char[]){"m.h5"};
    rg_part *part = rg_part_distribute(rank == 0 ? m : NULL, 25, MPI_COMM_WORLD);
    volatile bool ended = true;
    said[0] = '\0';
    expect_fatal = true;
    if (setjmp(escape) == 0) {
        rg_materials_assign(&c, part, MPI_COMM_WORLD);
        ended = false;
    }
    expect_fatal = false;
    if (rank == 0 && ended) {
        MPI_Barrier(MPI_COMM_WORLD);
    }
    rg_part_free(part);
    if (strcmp(said, words) != 0) {
        printf("# %s\n", said);
    }
    return ended && fatal_status == RG_USAGE && strcmp(said, words) == 0;
}

static void check_refusals(void) {
    static const double zero[3] = {0, 0, 0}, three[3] = {3, 2, 2};
    rg_mesh *m = rg_mesh_box((const int64_t[]){3, 2, 2}, zero, three, 0, 3);
    m->region = RG_NEW(int32_t, (size_t)m->elements);
    rg_sets_add(&m->volume, "core");
    rg_sets_add(&m->volume, "shell");
    rg_other_material other[3] = {
        {.set = (char[]){"core"}}, {.set = (char[]){"shel"}}, {.where = expression("x > 1")}};
    report(refused(m, 3, other,
                   "a.yaml: materials[1].set: shel: m.h5 has no such volume set; allowed: core, shell; did "
                   "you mean 'shell'?"),
           "refused", "a set that is not there");
    other[1].set = (char[]){"shell"};
    report(refused(m, 3, other, "a.yaml: materials[1].set: shell: no element is in it"), "refused",
           "a set without elements");
    other[1] = (rg_other_material){.where = expression("x > 2.75 && y > 1.5")};
    report(refused(m, 3, other, "a.yaml: materials[1].where: x > 2.75 && y > 1.5: no element is in it"),
           "refused", "an expression that is nowhere true");
    rg_expr_free(other[1].where);
    /* of all places the lowest, of the first entry that has any: the lowest centroids beyond x = 1 and 2 */
    other[1].where = expression("x > 2 ? 1/0 : x > 1 ? 0/0 : 1");
    rg_expr_free(other[2].where);
    other[2].where = expression("1/0");
    report(
        refused(m, 3, other,
                "a.yaml: materials[1].where: x > 2 ? 1/0 : x > 1 ? 0/0 : 1 is -nan at (1.25, 0.5, 0.75), the "
                "centroid of "
                "an element") ||
            strcmp(
                said,
                "a.yaml: materials[1].where: x > 2 ? 1/0 : x > 1 ? 0/0 : 1 is nan at (1.25, 0.5, 0.75), the "
                "centroid of an element") == 0,
        "refused", "the first value that is not finite");
    rg_expr_free(other[1].where);
    rg_expr_free(other[2].where);
    other[1] = (rg_other_material){.where = expression("x > 1"), .is.model = RG_MATERIAL_ANISOTROPIC};
    other[1].is.anisotropic.angle[2] = expression("x > 2 ? 1/0 : y");
    report(refused(m, 2, other,
                   "a.yaml: materials[1].orientation.angle_3: x > 2 ? 1/0 : y is inf at (2.25, 0.5, 0.75), "
                   "the centroid of an element"),
           "refused", "an angle that is not finite");
    rg_expr_free(other[1].where);
    rg_expr_free(other[1].is.anisotropic.angle[2]);
    rg_mesh_free(m);
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    rg_mesh *m = make_mesh();
    check_claims(m, 4);
    check_claims(m, 25);
    check_axes(m, 4);
    check_axes(m, 25);
    rg_mesh_free(m);
    report(rg_alloc_blocks() == 0, "memory", "all blocks are given back");
    check_grains();
    check_refusals();
    return finish();
}
