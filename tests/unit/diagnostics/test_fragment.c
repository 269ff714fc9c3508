/* Fragments of a box cut at known planes against closed forms, and overlaps, on any number of ranks. Prints
 * TAP from rank 0. */
#include <math.h>
#include <mpi.h>
#include <stdio.h>

#include "base/mem.h"
#include "diagnostics/fragment.h"
#include "diagnostics/overlap.h"
#include "domain/element.h"
#include "solver/setup.h"
#include "support/tap_memory.h"

/* A box of 2 x 3 x 6 m, far from the origin, which turns and flies. */
static const int64_t cells[3] = {4, 4, 12};
static const double size[3] = {2, 3, 6}, away[3] = {40, -70, 10}, spin[3] = {3, -2, 5},
                    flight[3] = {10, 20, -30};
enum { ELEMENTS = 6 * 4 * 4 * 12 };
#define DENSITY 3690.0
#define EXACT   2.5e-15 /* also in single precision, in which this motion has no rounding errors */

static rg_solver *make_solver(rg_case *c) {
    *c = (rg_case){.material = {.young = 260e9, .poisson = 0.21, .density = DENSITY}};
    c->interface.form = RG_FORM_VARIATIONAL;
    c->interface.beta_s = 4;
    c->interface.law = RG_LAW_LINEAR;
    c->interface.strength = 400e6;
    c->interface.energy = 34;
    c->interface.beta = 1;
    const double origin[3] = {0, 0, 0};
    rg_mesh *mesh = rank == 0 ? rg_mesh_box(cells, origin, size, 0, 1) : NULL;
    rg_part *part = rg_part_distribute(mesh, mesh == NULL ? 0 : rg_mesh_tile(mesh), MPI_COMM_WORLD);
    rg_mesh_free(mesh);
    return rg_solver_make_from_part(c, part, MPI_COMM_WORLD);
}

/* Moves the body away and gives it the velocity of a rigid rotation; what lies above the plane z = 2 is moved
 * down by `sunk`. */
static void set_motion(rg_solver *s, double sunk) {
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        const double *corner = s->domain->corner + 12 * slot;
        double middle = 0.25 * (corner[2] + corner[5] + corner[8] + corner[11]);
        for (int n = 0; n < RG_NODES; n++) {
            double x[3];
            rg_node_position(corner, n, x);
            for (int c = 0; c < 3; c++) {
                int a = (c + 1) % 3, b = (c + 2) % 3;
                s->u[rg_node_index(slot, n, c)] = (rg_real)(away[c] - (c == 2 && middle > 2 ? sunk : 0));
                s->step_velocity[rg_node_index(slot, n, c)] =
                    (rg_real)(flight[c] + spin[a] * x[b] - spin[b] * x[a]);
            }
        }
    }
}

/* Sets the damage of the faces whose corners all lie at x[axis] = place; of all faces where axis is -1. */
static void cut(rg_solver *s, int axis, double place, double damage) {
    const rg_domain *d = s->domain;
    for (size_t t = 0; t < d->tiles; t++) {
        for (size_t i = d->tile[t].ibegin * RG_LANES; i < d->tile[t].iend * RG_LANES; i++) {
            const double *corner =
                d->corner + 12 * (d->tile[t].begin * RG_LANES + (size_t)d->side[0][i] / RG_FACES);
            bool on = true;
            for (int a = 0; a < RG_FCORNERS && axis >= 0; a++) {
                double x = corner[3 * rg_face_node[d->side[0][i] % RG_FACES][a] + axis];
                on = on && fabs(x - place) < 1e-9;
            }
            for (int q = 0; q < RG_POINTS && on; q++) {
                s->broken[i] |= (uint8_t)(1 << q);
                s->crack[rg_crack_index(i, q, RG_CRACK_OPENING)] =
                    (rg_real)(1.001 * damage * s->model->law.opening);
            }
        }
    }
}

/* Of the fragments of a box that is cut, against closed forms, in shares of the largest value of their kind.
 */
enum { MASS, CENTROID, MOMENTUM, ENERGY, INERTIA, AXIS, SIDE, BOX_FIGURES };
static figure box[BOX_FIGURES] = {
    [MASS] = {"fragments, boxes: mass", .bound = EXACT, .why = ROUNDING},
    [CENTROID] = {"fragments, boxes: centroid", .bound = EXACT, .why = ROUNDING},
    [MOMENTUM] = {"fragments, boxes: momentum", .bound = EXACT, .why = ROUNDING},
    [ENERGY] = {"fragments, boxes: kinetic energy and that of the rotation", .bound = EXACT, .why = ROUNDING},
    [INERTIA] = {"fragments, boxes: principal moments of inertia", .bound = EXACT, .why = ROUNDING},
    [AXIS] = {"fragments, boxes: axes", .bound = EXACT, .why = ROUNDING},
    [SIDE] = {"fragments, boxes: sides of the box of equal inertia", .bound = EXACT, .why = ROUNDING},
};

/* Against a homogeneous box with the given sides, one of those into which the body is cut. */
static void compare_box(const rg_fragment *f, const double side[3]) {
    double mass = DENSITY * side[0] * side[1] * side[2], moment[3], sorted[3] = {side[2], side[1], side[0]};
    double rotational = 0, speed2 = 0, at[3];
    for (int c = 0; c < 3; c++) {
        at[c] = (floor((f->centroid[c] - away[c]) / side[c]) + 0.5) * side[c];
        raise_figure(&box[CENTROID], f->centroid[c], away[c] + at[c], fabs(away[c]));
    }
    raise_figure(&box[MASS], f->mass, mass, mass);
    raise_figure(&box[MASS], f->volume, mass / DENSITY, mass / DENSITY);
    for (int c = 0; c < 3; c++) {
        int a = (c + 1) % 3, b = (c + 2) % 3;
        double v = flight[c] + spin[a] * at[b] - spin[b] * at[a];
        moment[c] = mass * (side[a] * side[a] + side[b] * side[b]) / 12;
        rotational += 0.5 * moment[c] * spin[c] * spin[c];
        speed2 += v * v;
        raise_figure(&box[MOMENTUM], f->momentum[c], mass * v, mass * 40);
        raise_figure(&box[AXIS], f->axis[c][2 - c], 1, 1);
    }
    for (int c = 0; c < 3; c++) { /* sides are longest along z, and shortest along x */
        raise_figure(&box[INERTIA], f->inertia[c], moment[2 - c], moment[0]);
        raise_figure(&box[SIDE], f->size[c], sorted[c], side[2]);
    }
    raise_figure(&box[ENERGY], f->rotational, rotational, 0.5 * mass * speed2);
    raise_figure(&box[ENERGY], f->kinetic, 0.5 * mass * speed2 + rotational, 0.5 * mass * speed2);
}

/* Takes the fragments; their number on all ranks. */
static int64_t measure(rg_solver *s, rg_fragment **rows, size_t *own, double *mass) {
    rg_fragment_parts *p = rg_fragments_find(s);
    *own = rg_fragments_measure(s, p, rows);
    rg_fragment_parts_free(p);
    int64_t count = (int64_t)*own;
    *mass = 0;
    for (size_t i = 0; i < *own; i++) {
        *mass += (*rows)[i].mass;
    }
    MPI_Allreduce(MPI_IN_PLACE, mass, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
    return count;
}

static void check_boxes(rg_solver *s, const char *name, int64_t expected, const double side[3]) {
    rg_fragment *rows;
    size_t own;
    double mass, whole = DENSITY * size[0] * size[1] * size[2];
    int64_t count = measure(s, &rows, &own, &mass);
    report(count == expected, name, "number of fragments");
    raise_figure(&box[MASS], mass, whole, whole);
    bool good = true;
    for (size_t i = 0; i < own; i++) {
        compare_box(&rows[i], side);
        good = good && rows[i].elements == ELEMENTS / expected && (i == 0 || rows[i].id > rows[i - 1].id);
    }
    report(good, name, "as many elements in each");
    rg_free(rows);
}

static void check_cuts(void) {
    rg_case c;
    rg_solver *s = make_solver(&c);
    set_motion(s, 0);
    check_boxes(s, "whole", 1, size);
    cut(s, 0, 1, 1);
    cut(s, 1, 1.5, 1);
    cut(s, 2, 3, 0.99);
    check_boxes(s, "cut along", 4, (double[3]){1, 1.5, 6});
    cut(s, 2, 3, 1);
    check_boxes(s, "cut across", 8, (double[3]){1, 1.5, 3});
    for (int k = 0; k < BOX_FIGURES; k++) {
        report_figure("boxes", box[k]);
    }
    rg_solver_free(s);
}

static void check_dust(void) {
    rg_case c;
    rg_fragment *rows;
    size_t own;
    double mass, whole = DENSITY * size[0] * size[1] * size[2];
    rg_solver *s = make_solver(&c);
    set_motion(s, 0);
    cut(s, -1, 0, 1);
    report(measure(s, &rows, &own, &mass) == ELEMENTS, "dust", "number of fragments");
    report_figure("dust", (figure){"fragments, dust: mass", .found = mass / whole - 1, .bound = EXACT,
                                   .why = ROUNDING});
    bool good = true;
    for (size_t i = 0; i < own; i++) {
        good = good && rows[i].elements == 1 && rows[i].id == rows[0].id + (rg_gid)i;
    }
    report(good, "dust", "each element is one");
    rg_free(rows);
    rg_solver_free(s);
}

/* Makes element 0 so many times larger. */
static void stretch(rg_solver *s, double times) {
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        for (int n = 0; s->domain->id[slot] == 0 && n < RG_NODES; n++) {
            double x[3];
            rg_node_position(s->domain->corner + 12 * slot, n, x);
            for (int c = 0; c < 3; c++) {
                s->u[rg_node_index(slot, n, c)] += (rg_real)((times - 1) * x[c]);
            }
        }
    }
}

static void check_overlap(const char *name, double sunk, double times, bool expected) {
    rg_case c;
    rg_gid pair[2], last = 0;
    rg_solver *s = make_solver(&c);
    set_motion(s, sunk);
    stretch(s, times);
    cut(s, 2, 2, 1);
    rg_fragment_parts *p = rg_fragments_find(s);
    for (size_t k = 0; k < p->count; k++) {
        last = p->label[k].id > last ? p->label[k].id : last;
    }
    MPI_Allreduce(MPI_IN_PLACE, &last, 1, MPI_INT64_T, MPI_MAX, MPI_COMM_WORLD);
    bool found = rg_overlap_find(s, p, 1, pair);
    report(found == expected && (!found || (pair[0] == 0 && pair[1] == last)), "overlap", name);
    rg_fragment_parts_free(p);
    rg_solver_free(s);
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    check_cuts();
    check_dust();
    check_overlap("none where pieces touch", 0, 1, false);
    check_overlap("none where contact presses", 5e-3, 1, false);
    check_overlap("none where they part", -0.2, 1, false);
    check_overlap("sunk by a third of an element", 0.15, 1, true);
    check_overlap("sunk by elements", 1.3, 1, true);
    check_overlap("none of one that is torn", 0, 1e6, false);
    return finish_with_nothing_left();
}
