/* The forces of loads on the nodes of elements, against integrals by another rule and in closed form, and
 * what is refused of them at the start. Their work is in tests/system/test_loads.py. */
#include <math.h>
#include <mpi.h>
#include <omp.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/dense.h"
#include "base/hash.h"
#include "base/mem.h"
#include "case/read.h"
#include "domain/element.h"
#include "solver/setup.h"
#include "solver/step.h"
#include "support/child.h"

static const char block[] =
    "mesh: {cells: [2, 2, 3], size: [2e-3, 3e-3, 6e-3], origin: [1e-3, -1e-3, 0], jitter: 0.2}\n"
    "material: {model: neo-hookean, young: 260e9, poisson: 0.21, density: 3690}\n"
    "materials: [{name: light, where: 'z > 3e-3', model: neo-hookean, young: 300e9, "
    "poisson: 0.1, density: 900}]\n"
    "interface: {law: none}\n"
    "time: {end: 1}\n";

static rg_case *read_with(const char *loads, const char *more) {
    const char *const set[] = {loads, more};
    rg_case *c = rg_case_read_text("block", block, sizeof block - 1, more == NULL ? 1 : 2, set, stderr);
    assert_non_null(c);
    return c;
}

static rg_solver *solver_of(const rg_case *c) {
    rg_solver *s = rg_solver_make(c, MPI_COMM_WORLD);
    rg_solver_start(s);
    return s;
}

/* The forces at a time, by what they do to a solid at rest in a unit of time: in `velocity`. */
static void find_forces(rg_solver *s, double time) {
    memset(s->velocity, 0, s->domain->blocks * RG_NODE_BLOCK * sizeof *s->velocity);
    memset(s->step_velocity, 0, s->domain->blocks * RG_NODE_BLOCK * sizeof *s->step_velocity);
    rg_push push = {1, 0.5, s->velocity, s->step_velocity};
    rg_loads_set(s->loads, time, 0, 2);
    for (size_t t = 0; t < s->domain->tiles; t++) {
        rg_loads_find(s->loads, t, s);
        rg_loads_push(s->loads, t, &push);
        rg_loads_book(s->loads, t, s->u, s->velocity);
    }
    rg_account_close(s->account);
    for (size_t i = 0; i < s->domain->blocks * RG_NODE_BLOCK; i++) {
        assert_true(s->step_velocity[i] == 0.5 * s->velocity[i]);
    }
}

static void forces_of(const rg_solver *s, size_t slot, double f[RG_NODES][3]) {
    rg_mass_times(s->input->mass, rg_element_mass(s->domain, s->model->material, slot), s->velocity, slot, f);
}

static void place(const rg_solver *s, size_t slot, int n, double x[3]) {
    rg_node_position(s->domain->corner + 12 * slot, n, x);
    for (int c = 0; c < 3; c++) {
        x[c] += s->u[rg_node_index(slot, n, c)];
    }
}

/* Of all nodes: force, moment about the origin, and the sum of their sizes. */
static void resultant(const rg_solver *s, double force[3], double moment[3], double *size) {
    memset(force, 0, 3 * sizeof *force);
    memset(moment, 0, 3 * sizeof *moment);
    *size = 0;
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        double f[RG_NODES][3], x[3];
        forces_of(s, slot, f);
        for (int n = 0; s->domain->id[slot] >= 0 && n < RG_NODES; n++) {
            place(s, slot, n, x);
            for (int c = 0; c < 3; c++) {
                force[c] += f[n][c];
                moment[c] += x[(c + 1) % 3] * f[n][(c + 2) % 3] - x[(c + 2) % 3] * f[n][(c + 1) % 3];
                *size += fabs(f[n][c]);
            }
        }
    }
}

static void expect_near(double found, double want, double bound) {
    if (!(fabs(found - want) <= bound)) {
        fail_msg("%.17g, not %.17g", found, want);
    }
}

static const double affine[3][3] = {{0.2, -0.3, 0.1}, {0.4, -0.1, 0.25}, {-0.15, 0.3, 0.3}};

static void set_affine(rg_solver *s) {
    const double(*G)[3] = affine;
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        for (int n = 0; s->domain->id[slot] >= 0 && n < RG_NODES; n++) {
            double x[3];
            rg_node_position(s->domain->corner + 12 * slot, n, x);
            for (int c = 0; c < 3; c++) {
                s->u[rg_node_index(slot, n, c)] =
                    (rg_real)(G[c][0] * x[0] + G[c][1] * x[1] + G[c][2] * x[2] + 1e-4 * c);
            }
        }
    }
}

/* ---- Follower pressure ---- */

/* The same pressure all over the surface, in any affine motion: no force and no moment. */
static void test_closed_surface(void **state) {
    (void)state;
    rg_case *c = read_with("loads=[{where: '1', pressure: 3e6}]", NULL);
    rg_solver *s = solver_of(c);
    double force[3], moment[3], size;
    set_affine(s);
    find_forces(s, 0);
    resultant(s, force, moment, &size);
    assert_true(size > 100);
    for (int k = 0; k < 3; k++) {
        expect_near(force[k], 0, 1e-14 * size);
        expect_near(moment[k], 0, 1e-14 * size * 6e-3);
        expect_near(s->account->item[0].force[k], force[k], 1e-14 * size);
        expect_near(s->account->item[0].moment[k], moment[k], 1e-14 * size * 6e-3);
    }
    rg_solver_free(s);
    rg_case_free(c);
}

enum { FREE = 3 * RG_NODES };

/* Column k of the stiffness of a pressure on an element, by its forces' change over 2 du: they are quadratic
 * in the displacement. */
static void stiffness_column(rg_solver *s, size_t slot, int k, double column[FREE]) {
    double f[2][RG_NODES][3], du = 1e-4;
    rg_real *u = &s->u[rg_node_index(slot, k / 3, k % 3)], was = *u;
    for (int i = 0; i < 2; i++) {
        *u = (rg_real)(was + (i == 0 ? du : -du));
        find_forces(s, 0);
        forces_of(s, slot, f[i]);
    }
    *u = was;
    for (int n = 0; n < FREE; n++) {
        column[n] = (f[0][n / 3][n % 3] - f[1][n / 3][n % 3]) / (2 * du);
    }
}

/* Largest singular value of M^-1 K in the inner product of the mass. */
static double largest_value(const rg_solver *s, size_t slot, double K[FREE][FREE]) {
    double mass[RG_NODES * RG_NODES], x[FREE], y[FREE], z[FREE], most = 0;
    double whole = rg_element_mass(s->domain, s->model->material, slot);
    for (int i = 0; i < RG_NODES * RG_NODES; i++) {
        mass[i] = whole * rg_mass_entry(s->input->mass, i / RG_NODES, i % RG_NODES);
    }
    rg_dense_invert(RG_NODES, mass);
    for (int n = 0; n < FREE; n++) {
        x[n] = 1 + n * n % 7;
    }
    for (int k = 0; k < 400; k++) { /* x of M^-1 K^T M^-1 K, which has the squares */
        for (int half = 0; half < 2; half++) {
            const double *from = half == 0 ? x : z;
            for (int n = 0; n < FREE; n++) {
                y[n] = 0;
                for (int m = 0; m < FREE; m++) {
                    y[n] += (half == 0 ? K[n][m] : K[m][n]) * from[m];
                }
            }
            for (int n = 0; n < FREE; n++) {
                z[n] = 0;
                for (int a = 0; a < RG_NODES; a++) {
                    z[n] += mass[n / 3 * RG_NODES + a] * y[3 * a + n % 3];
                }
            }
        }
        most = 0;
        for (int n = 0; n < FREE; n++) {
            most = fmax(most, fabs(z[n]));
        }
        for (int n = 0; n < FREE; n++) {
            x[n] = z[n] / most;
        }
    }
    return sqrt(most);
}

/* What a pressure adds to the step bound covers the stiffness of it, on a stretched and turned block. */
static void test_follower_stiffness_is_covered(void **state) {
    (void)state;
    rg_case *c = read_with("loads=[{where: 'nx > 0.5 && y < 0 && z > 4e-3', pressure: 3e9}]", NULL);
    rg_solver *s = solver_of(c);
    double most = 0;
    set_affine(s);
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        double K[FREE][FREE], column[FREE];
        for (int k = 0; s->domain->id[slot] >= 0 && k < FREE; k++) {
            stiffness_column(s, slot, k, column);
            for (int n = 0; n < FREE; n++) {
                K[n][k] = column[n];
            }
        }
        double here = s->domain->id[slot] >= 0 ? largest_value(s, slot, K) : 0;
        most = isfinite(here) && here > most ? here : most;
    }
    double covered = rg_loads_omega2_now(s->loads);
    printf("# pressure: %g of what the step bound counts\n", most / covered);
    assert_true(most > 0.5 * covered && most <= covered);
    rg_loads_set_springs(s->loads);
    for (size_t t = 0; t < s->domain->tiles; t++) {
        rg_loads_find(s->loads, t, s);
    }
    assert_true(rg_loads_omega2_now(s->loads) == 0);
    rg_solver_free(s);
    rg_case_free(c);
}

/* Dead tractions of the same size on each side of the block: no force, but the moment -p V (G - G^T) of the
 * part that turns. */
static void test_dead_load_turns(void **state) {
    (void)state;
    rg_case *c = read_with("loads=[{set: x-, traction: {x: 3e6}}, {set: x+, traction: {x: -3e6}}, "
                           "{set: y-, traction: {y: 3e6}}, {set: y+, traction: {y: -3e6}}, "
                           "{set: z-, traction: {z: 3e6}}, {set: z+, traction: {z: -3e6}}]",
                           NULL);
    rg_solver *s = solver_of(c);
    double force[3], moment[3], size;
    set_affine(s);
    find_forces(s, 0);
    resultant(s, force, moment, &size);
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        double turn = -3e6 * 36e-9 * (affine[i][j] - affine[j][i]), booked = 0;
        for (int load = 0; load < 6; load++) {
            booked += s->account->item[load].moment[k];
        }
        assert_true(fabs(turn) > 1e-3 * size * 6e-3);
        expect_near(force[k], 0, 1e-14 * size);
        expect_near(moment[k], turn, 1e-14 * size * 6e-3);
        expect_near(booked, turn, 1e-14 * size * 6e-3);
    }
    rg_solver_free(s);
    rg_case_free(c);
}

/* Shape functions and their gradients at barycentric coordinates of the element. */
static void shape_gradients(const double *corner, const double l[4], double grad[RG_NODES][3]) {
    static const int ends[RG_NODES][2] = {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {0, 1},
                                          {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
    double at[4], origin[4];
    rg_barycentric(corner, (double[3]){0, 0, 0}, origin);
    for (int c = 0; c < 3; c++) {
        double x[3] = {0, 0, 0};
        x[c] = 1;
        rg_barycentric(corner, x, at);
        for (int n = 0; n < RG_NODES; n++) {
            int i = ends[n][0], j = ends[n][1];
            double gi = at[i] - origin[i], gj = at[j] - origin[j];
            grad[n][c] = i == j ? (4 * l[i] - 1) * gi : 4 * (l[i] * gj + l[j] * gi);
        }
    }
}

/* J F^-T N: the cofactors of F times N. */
static void turned_normal(const rg_solver *s, size_t slot, const double l[4], const double normal[3],
                          double out[3]) {
    double grad[RG_NODES][3], F[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    shape_gradients(s->domain->corner + 12 * slot, l, grad);
    for (int n = 0; n < RG_NODES; n++) {
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++) {
                F[i][j] += s->u[rg_node_index(slot, n, i)] * grad[n][j];
            }
        }
    }
    for (int i = 0; i < 3; i++) {
        int a = (i + 1) % 3, b = (i + 2) % 3;
        out[i] = 0;
        for (int j = 0; j < 3; j++) {
            int p = (j + 1) % 3, q = (j + 2) % 3;
            out[i] += (F[a][p] * F[b][q] - F[a][q] * F[b][p]) * normal[j];
        }
    }
}

/* -int p J F^-T N N_a dA over a face by Gauss's rule of 5 x 5 points on the collapsed square. */
static void add_pressure(const rg_solver *s, size_t slot, int face, double f[RG_NODES][3]) {
    static const double at[5] = {0.04691007703066802, 0.23076534494715845, 0.5, 0.76923465505284155,
                                 0.95308992296933198},
                        weight[5] = {0.11846344252809454, 0.23931433524968323, 0.28444444444444444,
                                     0.23931433524968323, 0.11846344252809454};
    const double *corner = s->domain->corner + 12 * slot;
    double normal[3], area = rg_surface_area(corner, face, normal);
    for (int k = 0; k < 25; k++) {
        double a = at[k / 5], b = (1 - a) * at[k % 5], w = 2 * area * weight[k / 5] * weight[k % 5] * (1 - a);
        double l[4] = {0}, N[RG_NODES], x[3] = {0, 0, 0}, n[3], bary[3] = {a, b, 1 - a - b};
        for (int i = 0; i < 3; i++) {
            l[rg_face_node[face][i]] = bary[i];
        }
        for (int i = 0; i < 12; i++) {
            x[i % 3] += l[i / 3] * corner[i];
        }
        rg_shape(l, N);
        turned_normal(s, slot, l, normal, n);
        double p = 2e6 * x[2] + 1e4 * 7;
        for (int i = 0; i < 3 * RG_NODES; i++) {
            f[i / 3][i % 3] -= w * p * N[i / 3] * n[i % 3];
        }
    }
}

/* At any displacement of the nodes, by F of the element; p is even, as degree 5 is beyond the six points. */
static void test_pressure(void **state) {
    (void)state;
    rg_case *c = read_with(
        "loads=[{set: z+, pressure: '2e6*6e-3 + 1e4*t'}, {set: z+, pressure: '2e6*z - 12e3', until: 5}]",
        NULL);
    rg_solver *s = solver_of(c);
    size_t slots = s->domain->blocks * RG_LANES;
    int faces = 0;
    for (size_t i = 0; i < slots * 3 * RG_NODES; i++) { /* up to a tenth of an element */
        s->u[i] = (rg_real)(1e-4 * (2 * rg_hash_uniform(rg_hash(7, i)) - 1));
    }
    find_forces(s, 7);
    for (size_t slot = 0; slot < slots; slot++) {
        double found[RG_NODES][3], want[RG_NODES][3] = {{0}}, size = 0;
        forces_of(s, slot, found);
        for (int f = 0; s->domain->id[slot] >= 0 && f < RG_FACES; f++) {
            double normal[3];
            rg_surface_area(s->domain->corner + 12 * slot, f, normal);
            if (rg_surface_has(s->domain, slot, f) && normal[2] > 0.99) {
                add_pressure(s, slot, f, want);
                faces++;
            }
        }
        for (int i = 0; i < 3 * RG_NODES; i++) {
            size = fmax(size, fabs(want[i / 3][i % 3]));
        }
        for (int i = 0; s->domain->id[slot] >= 0 && i < 3 * RG_NODES; i++) {
            expect_near(found[i / 3][i % 3], want[i / 3][i % 3], 1e-13 * size);
        }
    }
    assert_int_equal(faces, 8);
    rg_solver_free(s);
    rg_case_free(c);
}

/* ---- Dead loads ---- */

/* On x+ with its area 3e-3 x 6e-3, y from -1e-3 to 2e-3, z from 0 to 6e-3, x = 3e-3: traction (1e6 y, 0, 2e6
 * + 1e8 z t); whatever the solid does. And a force spread evenly, on faces that an expression selects. */
static void test_traction(void **state) {
    (void)state;
    static const char *const masses[] = {"mass=consistent", "mass=lumped"};
    for (int m = 0; m < 2; m++) {
        rg_case *c =
            read_with("loads=[{name: a, set: x+, traction: {x: 1e6*y, z: 2e6 + 1e8*z*t}, from: 1, until: 3},"
                      "{where: 'nz < -0.5', force: {y: 30*t}, from: 2}]",
                      masses[m]);
        rg_solver *s = solver_of(c);
        double force[3], moment[3], size, A = 18e-6;
        find_forces(s, 0.999);
        resultant(s, force, moment, &size);
        assert_true(size == 0);
        find_forces(s, 1);
        double known[3] = {1e6 * A * 0.5e-3, 0, A * (2e6 + 1e8 * 3e-3)};
        double turn[3] = {A * 0.5e-3 * (2e6 + 1e8 * 3e-3), /* y fz; mean of y 0.5e-3, of z 3e-3 */
                          A * (1e6 * 0.5e-3 * 3e-3 - 3e-3 * (2e6 + 1e8 * 3e-3)), /* z fx - x fz */
                          -A * 1e6 * 1e-6};                                      /* -y fx; mean of y^2 1e-6 */
        resultant(s, force, moment, &size);
        for (int k = 0; k < 3; k++) {
            expect_near(force[k], known[k], 3e-15 * size);
            expect_near(moment[k], turn[k], 1e-14 * size * 6e-3);
            expect_near(s->account->item[0].force[k], known[k], 3e-15 * size);
            expect_near(s->account->item[0].moment[k], turn[k], 1e-14 * size * 6e-3);
        }
        set_affine(s);
        find_forces(s, 1);
        resultant(s, force, turn, &size);
        expect_near(force[0], known[0], 3e-15 * size);
        assert_true(fabs(turn[0] - moment[0]) > 1e-3 * size * 6e-3); /* of the deformed body */
        for (int k = 0; k < 3; k++) {
            expect_near(s->account->item[0].moment[k], turn[k], 1e-14 * size * 6e-3);
        }
        find_forces(s, 3); /* the second alone: middle of z- at (2e-3, 0.5e-3, 0) */
        memset(s->u, 0, s->domain->blocks * RG_NODE_BLOCK * sizeof *s->u);
        resultant(s, force, moment, &size);
        expect_near(force[1], 90, 3e-15 * size);
        expect_near(fabs(force[0]) + fabs(force[2]), 0, 3e-15 * size);
        expect_near(moment[2], 90 * 2e-3, 2e-15);
        expect_near(moment[0], 0, 2e-15);
        expect_near(s->account->item[1].force[1], 90, 3e-15 * size);
        rg_solver_free(s);
        rg_case_free(c);
    }
}

/* All nodes get just the acceleration at their place, whatever the mass; force and work follow from M a. */
static void test_acceleration(void **state) {
    (void)state;
    static const char *const more[] = {"mass=consistent", "mass=lumped", "interface.form=continuous"};
    for (int m = 0; m < 3; m++) {
        rg_case *c = read_with(
            "loads=[{acceleration: {z: -9.81*t}}, {acceleration: {x: 1e3*y, y: 5*t*x}, where: z > 3e-3}]",
            more[m]);
        rg_solver *s = solver_of(c);
        find_forces(s, 2);
        double mass = 0, work[2] = {0, 0};
        for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
            bool light = s->domain->material[slot / RG_LANES] == 1, real = s->domain->id[slot] >= 0;
            double a[RG_NODES][3] = {{0}}, x[3], f[RG_NODES][3];
            for (int n = 0; real && n < RG_NODES; n++) {
                rg_node_position(s->domain->corner + 12 * slot, n, x);
                a[n][0] = light ? 1e3 * x[1] : 0;
                a[n][1] = light ? 10 * x[0] : 0;
                a[n][2] = -19.62;
            }
            forces_of(s, slot, f);
            mass += real ? rg_element_mass(s->domain, s->model->material, slot) : 0;
            for (int i = 0; i < 3 * RG_NODES; i++) {
                assert_true(s->velocity[rg_node_index(slot, i / 3, i % 3)] == (rg_real)a[i / 3][i % 3]);
                work[i % 3 == 2 ? 0 : 1] += f[i / 3][i % 3] * a[i / 3][i % 3]; /* half of 2 s */
            }
        }
        expect_near(s->account->item[0].force[2], -19.62 * mass, 1e-14 * mass * 20);
        expect_near(s->account->item[0].work, work[0], 1e-13 * work[0]);
        expect_near(s->account->item[1].work, work[1], 1e-13 * work[1]);
        assert_true(s->account->item[0].work_now == 0);
        rg_solver_free(s);
        rg_case_free(c);
    }
}

/* Away from the axis, where nodes are by now. */
static void test_spin(void **state) {
    (void)state;
    rg_case *c =
        read_with("loads=[{centrifugal: {speed: 300*t, axis: [1, 2, -2], at: [1e-3, 0, 2e-3]}}]", NULL);
    rg_solver *s = solver_of(c);
    set_affine(s);
    find_forces(s, 2);
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        for (int n = 0; s->domain->id[slot] >= 0 && n < RG_NODES; n++) {
            double x[3];
            place(s, slot, n, x);
            x[0] -= 1e-3;
            x[2] -= 2e-3;
            double along = (x[0] + 2 * x[1] - 2 * x[2]) / 9;
            for (int k = 0; k < 3; k++) {
                double a = 600 * 600 * (x[k] - along * (k == 0 ? 1 : k == 1 ? 2 : -2));
                expect_near((double)s->velocity[rg_node_index(slot, n, k)], a, 1e-14 * 600 * 600 * 0.01);
            }
        }
    }
    rg_solver_free(s);
    rg_case_free(c);
}

/* On each face -k times the mean displacement, in all directions. */
static void test_foundation(void **state) {
    (void)state;
    rg_case *c = read_with("loads=[{set: z+, foundation: 3e12}, {set: y-, foundation: 2e12}]", NULL);
    rg_solver *s = solver_of(c);
    const rg_domain *d = s->domain;
    double force[3], moment[3], size, wanted[2][3] = {{0}};
    set_affine(s);
    find_forces(s, 2);
    for (size_t i = 0; i < 4 * d->blocks * RG_LANES; i++) {
        size_t slot = i / 4;
        double normal[3],
            area = d->id[slot] < 0 ? 0 : rg_surface_area(d->corner + 12 * slot, (int)(i % 4), normal);
        const int *node = rg_face_node[i % 4];
        double x[3][3], k[2] = {3e12, 2e12};
        for (int n = 0; n < 3; n++) {
            rg_node_position(d->corner + 12 * slot, node[n], x[n]);
        }
        for (int b = 0; b < 2 && area > 0; b++) { /* z = 6 mm, y = -1 mm */
            int axis = 2 - b;
            double at = b == 0 ? 6e-3 : -1e-3;
            bool on = fabs(x[0][axis] - at) + fabs(x[1][axis] - at) + fabs(x[2][axis] - at) < 1e-9;
            for (int v = 0; v < 9 && on; v++) {
                wanted[b][v % 3] -= k[b] * area * s->u[rg_node_index(slot, node[v / 3], v % 3)] / 3;
            }
        }
    }
    resultant(s, force, moment, &size);
    for (int k = 0; k < 3; k++) {
        assert_true(fabs(wanted[0][k]) > 1e-3 * size && fabs(wanted[1][k]) > 1e-3 * size);
        expect_near(s->account->item[0].force[k], wanted[0][k], 1e-14 * size);
        expect_near(s->account->item[1].force[k], wanted[1][k], 1e-14 * size);
        expect_near(force[k], wanted[0][k] + wanted[1][k], 1e-14 * size);
    }
    rg_solver_free(s);
    rg_case_free(c);
}

/* ---- What is refused ---- */

static const char *asked[1];

static void make(void) {
    rg_case *c = rg_case_read_text("block", block, sizeof block - 1, 1, asked, stderr);
    if (c == NULL) {
        _exit(3);
    }
    rg_solver_make(c, MPI_COMM_WORLD);
}

static void test_refused(void **state) {
    (void)state;
    static const char *const cases[][2] = {
        {"loads=[{set: z+, pressure: 1}, {where: x > 1, pressure: 1}]",
         "rhegma: block: loads[1]: no face of the surface is in it, where: x > 1\n"},
        {"loads=[{where: 1/(x - x), pressure: 1}]",
         "rhegma: block: loads[0].where: 1/(x - x) is not finite at ("},
        {"loads=[{where: z > 1, acceleration: {x: 1}}]",
         "rhegma: block: loads[0]: no element is in it, where: z > 1\n"},
        {"loads=[{where: 1/(z - z), acceleration: {x: 1}}]",
         "rhegma: block: loads[0].where: 1/(z - z) is not finite at ("},
        {"loads=[{set: z+, traction: {x: 1, y: 1/t}}]",
         "rhegma: block: loads[0].traction is not finite at (0, 0, 0), t = 0 s\n"},
        {"loads=[{set: z+, traction: {x: 1, y: 1/t}, from: 1}]", ""},
        {"loads=[{set: z+, pressure: log(x)}, {set: z-, pressure: 'log(x - 3e-3)', from: 2}]",
         "rhegma: block: loads[1].pressure is not finite at (0.001"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char said[2000];
        asked[0] = cases[i][0];
        assert_int_equal(run_child(make, said, sizeof said), cases[i][1][0] != '\0' ? 2 : 0);
        if (strncmp(said, cases[i][1], strlen(cases[i][1])) != 0) {
            fail_msg("%s: said %s", asked[0], said);
        }
    }
}

int main(int argc, char **argv) {
    omp_set_num_threads(1); /* a child has none of its parent's threads */
    MPI_Init(&argc, &argv);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_closed_surface),
        cmocka_unit_test(test_follower_stiffness_is_covered),
        cmocka_unit_test(test_dead_load_turns),
        cmocka_unit_test(test_pressure),
        cmocka_unit_test(test_traction),
        cmocka_unit_test(test_acceleration),
        cmocka_unit_test(test_spin),
        cmocka_unit_test(test_foundation),
        cmocka_unit_test(test_refused),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    MPI_Finalize();
    return failed;
}
