/* What rigid bodies do to the time step, against sums over the faces of the mesh, and what is refused of
 * them, and of other conditions, at the start. How they move and press is in test_step.c. */
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

#include "case/case.h"
#include "case/read.h"
#include "partition/mesh_case.h"
#include "solver/setup.h"
#include "solver/step.h"
#include "solver/state.h"
#include "support/child.h"

/* Two materials, of which the stiffer is the lighter, and faces of different size. */
static const char block[] = "mesh: {cells: [2, 2, 3], size: [2e-3, 3e-3, 6e-3], jitter: 0.2}\n"
                            "material: {model: neo-hookean, young: 260e9, poisson: 0.21, density: 3690}\n"
                            "materials: [{name: light, where: 'z > 3e-3', model: neo-hookean, young: 300e9, "
                            "poisson: 0.1, density: 900}]\n"
                            "interface: {law: none}\n"
                            "time: {end: 1}\n";

/* Largest eigenvalue of M^-1 K of an element of unit mass that stands on one face with unit stiffness: (N +
 * 1)(N
 * + 3)/3 of polynomials of degree N = 2 (Warburton & Hesthaven 2003), and of the lumped mass. */
#define CONSISTENT 5.0
#define LUMPED     2.471779788708127

static rg_case *read_with(const char *bodies, bool lumped) {
    const char *const set[] = {bodies, lumped ? "mass=lumped" : "mass=consistent"};
    rg_case *c = rg_case_read_text("block", block, sizeof block - 1, 2, set, stderr);
    assert_non_null(c);
    return c;
}

/* ---- What contact adds to the squared frequency ---- */

static void difference(const double *a, const double *b, double out[3]) {
    for (int c = 0; c < 3; c++) {
        out[c] = a[c] - b[c];
    }
}

static double normal_to(const rg_mesh *mesh, rg_gid e, int face, double n[3]) {
    const double *x[3];
    double a[3], b[3];
    for (int k = 0, i = 0; k < 4; k++) {
        if (k != face) {
            x[i++] = mesh->x + 3 * mesh->corner[4 * e + k];
        }
    }
    difference(x[1], x[0], a);
    difference(x[2], x[0], b);
    for (int c = 0; c < 3; c++) {
        n[c] = 0.5 * (a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3]);
    }
    return sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
}

static double volume_of(const rg_mesh *mesh, rg_gid e) {
    double n[3], up[3];
    normal_to(mesh, e, 3, n);
    difference(mesh->x + 3 * mesh->corner[4 * e + 3], mesh->x + 3 * mesh->corner[4 * e], up);
    return fabs(n[0] * up[0] + n[1] * up[1] + n[2] * up[2]) / 3;
}

/* Whether a body may touch a face of the surface. */
static bool may_touch(const rg_mesh *mesh, const rg_body_input *b, rg_gid slot) {
    bool named = b->sets == 0;
    for (int k = 0; k < b->sets; k++) {
        named = named || strcmp(mesh->surface.name[mesh->set[slot]], b->set[k]) == 0;
    }
    return named;
}

/* The elements' part: all faces of one pressed at once; the bodies': all faces, but no more than half a
 * sphere. */
static double expected(const rg_case *c, const rg_mesh *mesh, bool lumped) {
    double element = 0, body = 0, stiffness[8] = {0}, kappa[8] = {0};
    for (rg_gid e = 0; e < mesh->elements; e++) {
        double z = 0, sum = 0, volume = volume_of(mesh, e), n[3];
        for (int k = 0; k < 4; k++) {
            z += mesh->x[3 * mesh->corner[4 * e + k] + 2] / 4;
        }
        double young = z > 3e-3 ? 300e9 : 260e9, nu = z > 3e-3 ? 0.1 : 0.21, density = z > 3e-3 ? 900 : 3690;
        double modulus = young * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
        for (int k = 0; k < 4 * c->bodies; k++) {
            int f = k % 4, b = k / 4;
            if (mesh->neighbour[4 * e + f] >= 0 || !may_touch(mesh, &c->body[b], 4 * e + f)) {
                continue;
            }
            double area = normal_to(mesh, e, f, n),
                   per_area = c->body[b].penalty * modulus / (3 * volume / area);
            sum += per_area * area;
            stiffness[b] += per_area * area;
            kappa[b] = fmax(kappa[b], per_area);
        }
        element = fmax(element, (lumped ? LUMPED : CONSISTENT) * sum / (density * volume));
    }
    for (int b = 0; b < c->bodies; b++) {
        const rg_body_input *in = &c->body[b];
        double r = in->radius,
               half = in->shape == RG_SHAPE_SPHERE ? 2 * acos(-1) * r * r * kappa[b] : INFINITY;
        double mass = in->density > 0 ? in->density * 4 / 3 * acos(-1) * r * r * r : in->mass;
        body = in->motion == RG_MOTION_FREE ? fmax(body, fmin(half, stiffness[b]) / mass) : body;
    }
    return element + body;
}

static void check(const char *bodies, bool lumped) {
    rg_case *c = read_with(bodies, lumped);
    rg_mesh *mesh = rg_mesh_of_case(c);
    rg_solver *s = rg_solver_make(c, MPI_COMM_WORLD);
    double want = expected(c, mesh, lumped), found = s->bodies->omega2;
    if (!(fabs(found - want) <= 1e-12 * want)) {
        fail_msg("%s: %.17g, not %.17g", bodies, found, want);
    }
    rg_solver_free(s);
    rg_mesh_free(mesh);
    rg_case_free(c);
}

static void test_omega2(void **state) {
    static const char *const bodies[] = {
        /* none that moves freely */
        "bodies=[{name: a, shape: plane, motion: prescribed, at: [0, 0, 7e-3], normal: [0, 0, -1]}]",
        /* a large sphere that all faces may press, and a small one that only half of its surface can meet */
        "bodies=[{name: a, shape: sphere, motion: free, at: [0, 0, 1], radius: 0.5, density: 1e-3, faces: "
        "[z+]}]",
        "bodies=[{name: a, shape: sphere, motion: free, at: [0, 0, 1], radius: 1e-4, density: 8e3, penalty: "
        "9}]",
        /* two on the same faces, one of them heavy; a third elsewhere */
        "bodies=[{name: a, shape: plane, motion: free, at: [0, 0, 7e-3], normal: [0, 0, -1], mass: 1e-3, "
        "faces: "
        "[z+, x-]}, {name: b, shape: cylinder, motion: free, at: [0, 0, 9e-3], axis: [1, 0, 0], radius: "
        "1e-3, "
        "mass: 1e3, faces: [z+]}, {name: c, shape: plane, motion: free, at: [0, -1, 0], normal: [0, 1, 0], "
        "mass: "
        "2e-3, faces: [y-]}]",
    };
    (void)state;
    for (size_t k = 0; k < sizeof bodies / sizeof *bodies; k++) {
        check(bodies[k], false);
        check(bodies[k], true);
    }
}

/* ---- What is refused ---- */

static const char *asked[3];

static void make(void) {
    rg_case *c = rg_case_read_text("block", block, sizeof block - 1, asked[1] == NULL ? 1 : 2, asked, stderr);
    rg_solver_make(c, MPI_COMM_WORLD);
}

static void expect(const char *bodies, const char *more, const char *words) {
    char said[2000];
    asked[0] = bodies;
    asked[1] = more;
    int status = run_child(make, said, sizeof said);
    assert_int_equal(status, words == NULL ? 0 : 2);
    if (words == NULL ? said[0] != '\0' : strstr(said, words) == NULL) {
        fail_msg("%s: said %s", bodies, said);
    }
}

/* The heights over the lower side are 2e-3, but for the jitter: a millionth of them is no overlap. */
static void test_overlap(void **state) {
    (void)state;
    expect("bodies=[{name: a, shape: plane, motion: free, at: [0, 0, 1e-9], normal: [0, 0, 1], mass: 1}]",
           NULL, NULL);
    expect("bodies=[{name: a, shape: plane, motion: free, at: [0, 0, 2.2e-9], normal: [0, 0, 1], mass: 1}]",
           NULL,
           "block: bodies[0].at: [0, 0, 2.2e-09]: a overlaps the solid at the start, by 2.2e-09 m at (");
    /* where the initial displacement has put it */
    expect("bodies=[{name: a, shape: plane, motion: free, at: [0, 0, -1e-5], normal: [0, 0, 1], mass: 1}]",
           NULL, NULL);
    expect("bodies=[{name: a, shape: plane, motion: free, at: [0, 0, -1e-5], normal: [0, 0, 1], mass: 1}]",
           "initial={displacement: {z: '-3e-5 + 1e-3*z'}}",
           "a overlaps the solid at the start, by 2e-05 m at (");
    /* the deepest of several, wherever it is found, and faces that may not touch do not count */
    expect(
        "bodies=[{name: a, shape: plane, motion: free, at: [0, 0, 1e-4], normal: [0, 0, 1], mass: 1, faces: "
        "[x+]}, "
        "{name: b, shape: plane, motion: free, at: [0, 0, 3e-4], normal: [0, 0, 1], mass: 1, faces: [z-]}]",
        NULL, "bodies[1].at: [0, 0, 0.0003]: b overlaps the solid at the start, by 0.0003 m at (");
    expect(
        "bodies=[{name: a, shape: plane, motion: free, at: [0, 0, 4e-4], normal: [0, 0, 1], mass: 1, faces: "
        "[x+]}, "
        "{name: b, shape: plane, motion: free, at: [0, 0, 3e-4], normal: [0, 0, 1], mass: 1, faces: [z-]}]",
        NULL, "bodies[0].at: [0, 0, 0.0004]: a overlaps the solid at the start, by 0.0004 m at (");
}

static void test_velocity(void **state) {
    (void)state;
    expect("bodies=[{name: a, shape: plane, motion: prescribed, at: [0, 0, -1], normal: [0, 0, 1], velocity: "
           "{x: 1, z: "
           "1/t}}]",
           NULL, "block: bodies: velocity.z of a: 1/t is not finite at t = 0 s");
}

static void make_and_start(void) {
    rg_case *c = rg_case_read_text("block", block, sizeof block - 1, 1, asked, stderr);
    rg_solver_start(rg_solver_make(c, MPI_COMM_WORLD));
}

/* What is not finite at the start is told with its lowest place. */
static void test_start(void **state) {
    (void)state;
    static const char *const cases[][2] = {
        {"boundary=[{set: x-, component: x, velocity: 0}, {set: z+, component: y, displacement: 'log(t)'}]",
         "rhegma: block: boundary[1].displacement: log(t) is not finite at (0, 0, 0.006), t = 0 s\n"},
        {"initial={displacement: {y: 'z > 5e-3 ? 1/(x - x) : 0'}, velocity: {x: '1/(x - x)'}}",
         "rhegma: block: initial.displacement.y: z > 5e-3 ? 1/(x - x) : 0 is not finite at (0, 0, 0.006)\n"},
        {"initial={velocity: {x: '1/(x - x)'}}",
         "rhegma: block: initial.velocity.x: 1/(x - x) is not finite at (0, 0, 0)\n"},
        {"initial={velocity: {x: x, z: 'sqrt(-y)'}}",
         "rhegma: block: initial.velocity.z: sqrt(-y) is not finite at ("},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char said[2000];
        asked[0] = cases[i][0];
        assert_int_equal(run_child(make_and_start, said, sizeof said), 2);
        if (strncmp(said, cases[i][1], strlen(cases[i][1])) != 0) {
            fail_msg("%s: said %s", asked[0], said);
        }
    }
}

/* Without bodies a checkpoint has no place for them. */
static void test_no_bodies(void **state) {
    (void)state;
    rg_case *c = read_with("bodies=[]", true);
    rg_solver *s = rg_solver_make(c, MPI_COMM_WORLD);
    rg_state st = {0};
    rg_bodies_register(s->bodies, &st);
    assert_int_equal(st.arrays, 0);
    rg_solver_free(s);
    rg_case_free(c);
}

static void add_too_many(void) {
    static rg_state st;
    for (int i = 0; i <= RG_MAX_STATE; i++) {
        fputc('.', stderr);
        rg_state_add(&st, "one", RG_OF_RUN, RG_STATE_DOUBLE, 1, NULL);
    }
}

static void test_full_state(void **state) {
    (void)state;
    char said[200], expected[200];
    assert_int_equal(run_child(add_too_many, said, sizeof said), 1);
    memset(expected, '.', RG_MAX_STATE + 1);
    strcpy(expected + RG_MAX_STATE + 1, "rhegma: state one: RG_MAX_STATE is too small\n");
    assert_string_equal(said, expected);
}

/* A mesh in which the side "x+" has another name. */
static void make_without_side(void) {
    rg_case *c = rg_case_read_text("block", block, sizeof block - 1, 1, asked, stderr);
    rg_mesh *mesh = rg_mesh_of_case(c);
    mesh->surface.name[rg_sets_find(&mesh->surface, "x+")][0] = 'q';
    rg_solver_make_from_part(c, rg_part_distribute(mesh, 8, MPI_COMM_WORLD), MPI_COMM_WORLD);
}

static void test_unknown_sides(void **state) {
    (void)state;
    static const char *const cases[][2] = {
        {"bodies=[{name: a, shape: plane, motion: free, at: [0, 0, -1], normal: [0, 0, 1], mass: 1, faces: "
         "[x-, x+]}]",
         "rhegma: block: bodies[0].faces[1]: the mesh has no set named 'x+'\n"},
        {"boundary=[{set: y+, component: x, velocity: 0}, {set: x+, component: x, velocity: 0}]",
         "rhegma: block: boundary[1].set: the mesh has no set named 'x+'\n"},
        {"boundary=[{set: x-, component: x, velocity: 0}]", ""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char said[2000];
        asked[0] = cases[i][0];
        assert_int_equal(run_child(make_without_side, said, sizeof said), cases[i][1][0] != '\0' ? 2 : 0);
        if (strncmp(said, cases[i][1], strlen(cases[i][1])) != 0) {
            fail_msg("%s: said %s", asked[0], said);
        }
    }
}

int main(int argc, char **argv) {
    omp_set_num_threads(1); /* a child has none of its parent's threads */
    MPI_Init(&argc, &argv);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_omega2),     cmocka_unit_test(test_overlap),
        cmocka_unit_test(test_velocity),   cmocka_unit_test(test_unknown_sides),
        cmocka_unit_test(test_no_bodies),  cmocka_unit_test(test_start),
        cmocka_unit_test(test_full_state),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    MPI_Finalize();
    return failed;
}
