/* Strengths that differ from face to face: Weibull's distribution, sets of faces, the same on both copies of
 * a tile-boundary face. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <mpi.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "case/case.h"
#include "case/read.h"
#include "base/mem.h"
#include "partition/material_map.h"
#include "partition/mesh_case.h"
#include "solver/setup.h"
#include "solver/tile.h"
#include "support/child.h"

enum { MOST = 4 };

static rg_case *read_case(int overrides, const char *const override[]) {
    const char *all[MOST] = {"mesh.cells=[6, 6, 12]", "mesh.jitter=0.15"};
    assert_true(overrides + 2 <= MOST);
    for (int i = 0; i < overrides; i++) {
        all[2 + i] = override[i];
    }
    rg_case *c = rg_case_read(RG_SOURCE_ROOT "/bench/examples/spall/spall.yaml", overrides + 2, all, stderr);
    assert_non_null(c);
    return c;
}

/* A face: what identifies it, and its factors; a sum over hashes of its corners, from a seed. */
typedef struct {
    double middle[3], normal[3], area, strength, opening;
    uint64_t corners;
} face;

enum { SEED = 5 };

static int by_place(const void *a, const void *b) {
    const face *p = a, *q = b;
    for (int c = 0; c < 3; c++) {
        if (p->middle[c] < q->middle[c] || p->middle[c] > q->middle[c]) {
            return p->middle[c] < q->middle[c] ? -1 : 1;
        }
    }
    return 0;
}

static face face_of(const rg_solver *s, const rg_tile *t, size_t i) {
    face f = {.area = rg_interface_area(s->domain, i, f.normal)};
    int32_t link = s->domain->side[0][i];
    const double *corner = s->domain->corner + 12 * (t->begin * RG_LANES + (size_t)link / RG_FACES);
    const int *node = rg_face_node[link % RG_FACES];
    for (int c = 0; c < 3; c++) { /* the same bits in any order of the corners */
        double x = corner[3 * node[0] + c], y = corner[3 * node[1] + c], z = corner[3 * node[2] + c];
        double least = fmin(fmin(x, y), z), most = fmax(fmax(x, y), z);
        double between = fmax(fmin(x, y), fmin(fmax(x, y), z));
        f.middle[c] = least + between + most;
    }
    for (int k = 0; k < RG_FCORNERS; k++) {
        const double *x = corner + 3 * node[k];
        f.corners += rg_hash_double(rg_hash_double(rg_hash_double(SEED, x[0] + 0.0), x[1] + 0.0), x[2] + 0.0);
    }
    f.strength = s->model->scale[i / RG_LANES * 2 * RG_LANES + i % RG_LANES];
    f.opening = s->model->scale[(i / RG_LANES * 2 + 1) * RG_LANES + i % RG_LANES];
    return f;
}

/* All faces of a solver, tile-boundary faces twice, sorted by place; the caller frees them. Frees the solver.
 */
static face *list_faces(rg_solver *s, size_t *count) {
    face *list = calloc(s->domain->iblocks * RG_LANES, sizeof *list);
    assert_non_null(list);
    *count = 0;
    for (size_t t = 0; t < s->domain->tiles; t++) {
        const rg_tile *tile = &s->domain->tile[t];
        for (size_t i = tile->ibegin * RG_LANES; i < tile->iend * RG_LANES; i++) {
            face f = face_of(s, tile, i);
            if (f.area > 0) {
                list[(*count)++] = f;
            }
        }
    }
    double stiffest = 0;
    for (size_t i = 0; i < *count; i++) {
        stiffest = fmax(stiffest, list[i].strength / list[i].opening);
    }
    assert_true(fabs(s->model->stiffest - stiffest) <= 1e-6 * stiffest); /* also where factors are floats */
    rg_solver_free(s);
    qsort(list, *count, sizeof *list, by_place);
    return list;
}

static face *faces_of(int overrides, const char *const override[], size_t *count) {
    rg_case *c = read_case(overrides, override);
    face *list = list_faces(rg_solver_make(c, MPI_COMM_SELF), count);
    rg_case_free(c);
    return list;
}

static void test_weibull(void **state) {
    (void)state;
    const double modulus = 8, area = 2e-9;
    const char *const set[] = {"interface.weibull={modulus: 8, area: 2e-9}"};
    size_t count, faces = 0, below[9] = {0};
    face *f = faces_of(1, set, &count);
    for (size_t i = 0; i < count; i++) {
        assert_true(fabs(f[i].strength * f[i].opening - 1) < 1e-6); /* G_c stays */
        if (i + 1 < count && by_place(&f[i], &f[i + 1]) == 0) {     /* copies of a tile-boundary face */
            assert_true(f[i].strength == f[i + 1].strength && f[i].opening == f[i + 1].opening);
            continue;
        }
        faces++;
        double broken = 1 - exp(-f[i].area / area * pow(f[i].strength, modulus)); /* uniform in (0, 1) */
        for (int k = 0; k < 9; k++) {
            below[k] += broken < 0.1 * (k + 1);
        }
    }
    assert_true(faces > 4000 && count > faces);
    for (int k = 0; k < 9; k++) {
        double p = 0.1 * (k + 1), found = (double)below[k] / (double)faces;
        assert_true(fabs(found - p) < 4 * sqrt(p * (1 - p) / (double)faces));
    }
    free(f);
}

/* Another seed gives other strengths; the opening is kept on request. */
static void test_seed_and_keep(void **state) {
    (void)state;
    const char *const one[] = {"interface.weibull={modulus: 8, area: 2e-9, keep: opening}"};
    const char *const two[] = {"interface.weibull={modulus: 8, area: 2e-9, seed: 2}"};
    size_t n, m, same = 0;
    face *a = faces_of(1, one, &n), *b = faces_of(1, two, &m);
    assert_true(n == m);
    for (size_t i = 0; i < n; i++) {
        assert_true(a[i].opening == 1 && by_place(&a[i], &b[i]) == 0);
        same += fabs(a[i].strength - b[i].strength) < 1e-3;
    }
    assert_true(same < n / 50);
    free(a);
    free(b);
}

/* ---- The same body in other numbers ---- */

/* Gives vertex v the number to[v]; the corners of an element ascend again, so that its faces and their
 * corners change their order. The sides of the box lose their names. */
static void renumber(rg_mesh *mesh, const rg_gid *to) {
    double *x = malloc(3 * (size_t)mesh->vertices * sizeof *x);
    assert_non_null(x);
    memcpy(x, mesh->x, 3 * (size_t)mesh->vertices * sizeof *x);
    for (rg_gid v = 0; v < mesh->vertices; v++) {
        memcpy(mesh->x + 3 * to[v], x + 3 * v, 3 * sizeof *x);
    }
    for (rg_gid e = 0; e < mesh->elements; e++) {
        rg_gid *corner = mesh->corner + 4 * e;
        for (int k = 0; k < 4; k++) {
            corner[k] = to[corner[k]];
        }
        for (int k = 0; k < 9; k++) { /* exchanges enough to sort four */
            rg_gid *pair = corner + k % 3, low = pair[0];
            if (low > pair[1]) {
                pair[0] = pair[1];
                pair[1] = low;
            }
        }
    }
    memset(mesh->set, -1, 4 * (size_t)mesh->elements * sizeof *mesh->set);
    free(x);
    rg_mesh_connect(mesh);
}

enum { AS_IT_IS, REVERSED, SHUFFLED, MINUS_ZERO, NUMBERS };

static face *faces_in(const rg_case *c, int numbers, size_t *count) {
    rg_mesh *mesh = rg_mesh_of_case(c);
    rg_gid *to = malloc((size_t)mesh->vertices * sizeof *to);
    assert_non_null(to);
    for (rg_gid v = 0; v < mesh->vertices; v++) {
        to[v] = numbers == REVERSED ? mesh->vertices - 1 - v : v;
    }
    for (rg_gid v = mesh->vertices - 1; v > 0 && numbers == SHUFFLED; v--) {
        rg_gid other = (rg_gid)(rg_hash(3, (uint64_t)v) % (uint64_t)(v + 1)), kept = to[v];
        to[v] = to[other];
        to[other] = kept;
    }
    for (rg_gid k = 0; k < 3 * mesh->vertices && numbers == MINUS_ZERO; k++) {
        mesh->x[k] = fabs(mesh->x[k]) > 0 ? mesh->x[k] : -0.0;
    }
    renumber(mesh, to);
    rg_part *part = rg_part_distribute(mesh, 96, MPI_COMM_SELF);
    free(to);
    rg_mesh_free(mesh);
    return list_faces(rg_solver_make_from_part(c, part, MPI_COMM_SELF), count);
}

/* The strength of a face follows from where its corners are, in whatever order they are numbered, and 0 is
 * where -0 is. Its area is rounded by that order, and what is kept is of the fields' precision. */
static void test_numbers(void **state) {
    (void)state;
    /* the sides have lost their names */
    const char *const set[] = {"interface.weibull={modulus: 8, area: 2e-9}", "mesh.origin=[0, 0, 0]"};
    const char *const jitter[] = {"mesh.jitter=0.15", "mesh.jitter=0"};
    const double rounding = sizeof(rg_real) == sizeof(double) ? 1e-14 : 1.2e-7;
    for (int regular = 0; regular < 2; regular++) {
        const char *all[] = {"mesh.cells=[4, 4, 8]", set[0], set[1], jitter[regular], "boundary=[]"};
        rg_case *c = rg_case_read(RG_SOURCE_ROOT "/bench/examples/spall/spall.yaml", 5, all, stderr);
        assert_non_null(c);
        size_t count, others;
        face *f = faces_in(c, AS_IT_IS, &count);
        for (int numbers = REVERSED; numbers < NUMBERS; numbers++) {
            face *g = faces_in(c, numbers, &others);
            assert_int_equal(count, others);
            for (size_t i = 0; i < count; i++) {
                assert_int_equal(by_place(&f[i], &g[i]), 0);
                assert_true(fabs(f[i].strength - g[i].strength) <= rounding * f[i].strength);
                assert_true(fabs(f[i].opening - g[i].opening) <= rounding * f[i].opening);
            }
            free(g);
        }
        free(f);
        rg_case_free(c);
    }
}

/* A case of today has the same strengths with any later program: U of a face is pinned, and a set's strength
 * is what the weakest link is multiplied with. */
static void test_formula(void **state) {
    (void)state;
    const char *const set[] = {"interface.weibull={modulus: 8, area: 2e-9, seed: 5}",
                               "interface.sets=[{where: z < 0, strength: 800e6, energy: 68}]"};
    size_t count;
    face *f = faces_of(2, set, &count);
    for (size_t i = 0; i < count; i++) {
        double u = rg_hash_uniform(rg_hash(SEED, f[i].corners)), set_strength = f[i].middle[2] < 0 ? 2 : 1;
        double weakest = pow(-2e-9 / f[i].area * log(1 - u), 1 / 8.0);
        assert_true(fabs(f[i].strength - set_strength * weakest) <= 1e-6 * f[i].strength);
        assert_true(fabs(f[i].opening * weakest - 1) <= 1e-6);
    }
    free(f);
}

/* Faces without a law of softening have no opening of their own. */
static void test_without_softening(void **state) {
    (void)state;
    const char *const set[] = {
        "interface={law: free, strength: 400e6, sets: [{where: z < 0, strength: 800e6}]}"};
    size_t count;
    face *f = faces_of(1, set, &count);
    for (size_t i = 0; i < count; i++) {
        assert_true(f[i].opening == 1 && f[i].strength == (f[i].middle[2] < 0 ? 2 : 1));
    }
    free(f);
}

/* The last set that holds counts; faces in none keep the law's values. */
static void test_sets(void **state) {
    (void)state;
    const char *const set[] = {"interface.sets=[{where: z < 0, strength: 800e6, energy: 68}, "
                               "{where: 'abs(nz) > 0.9', strength: 200e6}]"};
    size_t count, seen[3] = {0};
    face *f = faces_of(1, set, &count);
    for (size_t i = 0; i < count; i++) {
        int which = fabs(f[i].normal[2]) > 0.9 * f[i].area ? 2 : f[i].middle[2] < 0 ? 1 : 0;
        const double strength[] = {1, 2, 0.5}, opening[] = {1, 1, 2};
        assert_true(fabs(f[i].strength - strength[which]) < 1e-6 &&
                    fabs(f[i].opening - opening[which]) < 1e-6);
        seen[which]++;
    }
    assert_true(seen[0] > 0 && seen[1] > 0 && seen[2] > 0);
    free(f);
}

/* Values of a face field, by face; NULL: all alike. */
static double face_field(const rg_real *field, size_t i) {
    return field == NULL ? NAN : field[i];
}

/* All that a set may say, by number and by expression; faces that never break; a set's own Weibull. Where a
 * set says nothing the interface's value holds, not an earlier set's. */
static void test_properties(void **state) {
    (void)state;
    const char *const set[] = {
        "interface.sets=[{where: z < 0, strength: 1e8*(3 + nz^2), beta: 0, friction: 0.5}, {where: "
        "'abs(nz) > 0.9 && z > 0', law: none}, {where: x > 0 && z > 0.5e-3, energy: 34e3*z, beta: 1 + "
        "x/1e-3, "
        "weibull: {modulus: 8, area: 2e-9, seed: 5}}]",
        "interface.friction=0.25"};
    rg_case *c = read_case(2, set);
    rg_solver *s = rg_solver_make(c, MPI_COMM_SELF);
    size_t seen[4] = {0};
    for (size_t t = 0; t < s->domain->tiles; t++) {
        const rg_tile *tile = &s->domain->tile[t];
        for (size_t i = tile->ibegin * RG_LANES; i < tile->iend * RG_LANES; i++) {
            face f = face_of(s, tile, i);
            if (!(f.area > 0)) {
                continue;
            }
            double x = f.middle[0] / 3, z = f.middle[2] / 3, nz = f.normal[2] / f.area;
            int which = x > 0 && z > 0.5e-3 ? 2 : fabs(nz) > 0.9 && z > 0 ? 1 : z < 0 ? 0 : 3;
            double weakest = 1, strength = 400e6, energy = 34, beta = 1, friction = 0.25;
            if (which == 0) {
                strength = 1e8 * (3 + nz * nz);
                beta = 0;
                friction = 0.5;
            } else if (which == 1) {
                strength = INFINITY;
            } else if (which == 2) {
                energy = 34e3 * z;
                beta = 1 + x / 1e-3;
                double u = rg_hash_uniform(rg_hash(SEED, f.corners));
                weakest = pow(-2e-9 / f.area * log(1 - u), 1 / 8.0);
            }
            seen[which]++;
            assert_true(which == 1 ? isinf(f.strength)
                                   : fabs(f.strength * 400e6 / (strength * weakest) - 1) < 1e-6);
            assert_true(fabs(f.opening * weakest - (which == 1 ? 1 : energy / 34 * 400e6 / strength)) <
                        1e-6 * f.opening * weakest);
            assert_true(fabs(face_field(s->model->beta, i) - beta) < 1e-6);
            assert_true(fabs(face_field(s->model->friction, i) - friction) < 1e-6);
        }
    }
    assert_true(seen[0] > 0 && seen[1] > 0 && seen[2] > 0 && seen[3] > 0);
    assert_true(s->model->law.sliding == RG_SLIDING_COULOMB);
    rg_solver_free(s);
    rg_case_free(c);
}

/* There are fields of what some set says, the last one too, and of nothing else. */
static void test_fields(void **state) {
    (void)state;
    static const struct {
        const char *sets;
        bool beta, friction;
    } known[] = {{"interface.sets=[{where: z < 0, beta: 0}]", true, false},
                 {"interface.sets=[{where: z < 0, energy: 3}, {where: x > 0, friction: 0.5}]", false, true},
                 {"interface.sets=[{where: z < 0, friction: 0.5}, {where: x > 0, energy: 3}]", false, true},
                 {"interface.sets=[{where: z < 0, energy: 3}]", false, false}};
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        const char *const set[] = {known[k].sets, "interface.friction=0.25"};
        rg_case *c = read_case(2, set);
        rg_solver *s = rg_solver_make(c, MPI_COMM_SELF);
        assert_true((s->model->beta != NULL) == known[k].beta &&
                    (s->model->friction != NULL) == known[k].friction);
        rg_solver_free(s);
        rg_case_free(c);
    }
}

/* An expression is as good as the numbers it gives, also where it is the interface's. */
static void test_expressions(void **state) {
    (void)state;
    const char *const plain[] = {"interface.sets=[{where: z < 0, strength: 800e6, energy: 68}]"};
    const char *const words[] = {"interface.strength='z < 0 ? 800e6 : 400e6'",
                                 "interface.energy='z < 0 ? 68 : 34'"};
    rg_case *c[2] = {read_case(1, plain), read_case(2, words)};
    rg_solver *s[2] = {rg_solver_make(c[0], MPI_COMM_SELF), rg_solver_make(c[1], MPI_COMM_SELF)};
    const rg_cohesive *law[2] = {&s[0]->model->law, &s[1]->model->law};
    assert_true(s[0]->model->beta == NULL && s[1]->model->friction == NULL);
    size_t faces = s[0]->domain->iblocks * RG_LANES;
    for (size_t i = 0; i < faces; i++) {
        double normal[3], found[2][2];
        for (int k = 0; k < 2; k++) {
            const rg_real *scale = s[k]->model->scale + i / RG_LANES * 2 * RG_LANES + i % RG_LANES;
            found[k][0] = law[k]->strength * scale[0];
            found[k][1] = law[k]->opening * scale[RG_LANES];
        }
        if (rg_interface_area(s[0]->domain, i, normal) > 0) {
            assert_true(fabs(found[1][0] / found[0][0] - 1) < 1e-6 &&
                        fabs(found[1][1] / found[0][1] - 1) < 1e-6);
        }
    }
    for (int k = 0; k < 2; k++) {
        rg_solver_free(s[k]);
        rg_case_free(c[k]);
    }
}

/* ---- Faces that the mesh names ---- */

/* A mesh some faces inside of which are in set "weak", and half of these in "weaker" besides. */
static rg_mesh *mesh_with_sets(const rg_case *c) {
    rg_mesh *mesh = rg_mesh_of_case(c);
    int32_t weak = rg_sets_add(&mesh->surface, "weak"), weaker = rg_sets_add(&mesh->surface, "weaker");
    int32_t both = rg_sets_combine(&mesh->surface, 2, (const int32_t[]){weak, weaker});
    for (rg_gid slot = 0; slot < 4 * mesh->elements; slot++) {
        rg_gid a = slot / 4, b = mesh->neighbour[slot], key = a * a + b * b;
        mesh->set[slot] = b >= 0 && key % 3 == 0 ? (key % 2 == 0 ? both : weak) : mesh->set[slot];
    }
    return mesh;
}

/* A face between elements a and b, its middle at height z: which set it is of, 0 of none. */
typedef int set_of_face(rg_gid a, rg_gid b, double z);

/* Counts faces by their set; each has its set's strength, over that of the case. */
static void count_faces(const rg_solver *s, const rg_mesh *mesh, set_of_face *set_of, size_t *seen) {
    static const double strength[] = {1, 0.5, 0.25, 2};
    for (size_t t = 0; t < s->domain->tiles; t++) {
        const rg_tile *tile = &s->domain->tile[t];
        for (size_t i = tile->ibegin * RG_LANES; i < tile->iend * RG_LANES; i++) {
            int32_t link = s->domain->side[0][i];
            face f = face_of(s, tile, i);
            if (f.area > 0) {
                rg_gid a = s->domain->id[tile->begin * RG_LANES + (size_t)link / RG_FACES];
                rg_gid b = mesh->neighbour[4 * a + link % RG_FACES];
                int which = set_of(a, b, f.middle[2]);
                assert_true(fabs(f.strength - strength[which]) < 1e-6);
                seen[which]++;
            }
        }
    }
}

static int named(rg_gid a, rg_gid b, double z) {
    rg_gid key = a * a + b * b;
    return key % 3 != 0 ? 0 : z > 0 ? 3 : key % 2 == 0 ? 2 : 1;
}

static int grains(rg_gid a, rg_gid b, double z) {
    return a / 7 % 3 == b / 7 % 3 ? 0 : z > 0 ? 2 : 1;
}

static void test_named(void **state) {
    (void)state;
    const char *const set[] = {
        "interface.sets=[{set: weak, strength: 200e6}, {set: weaker, strength: 100e6}, "
        "{set: weak, where: z > 0, strength: 800e6}]"};
    rg_case *c = read_case(1, set);
    rg_mesh *mesh = mesh_with_sets(c);
    rg_part *part = rg_part_distribute(mesh, 96, MPI_COMM_SELF);
    rg_solver *s = rg_solver_make_from_part(c, part, MPI_COMM_SELF);
    size_t seen[4] = {0};
    count_faces(s, mesh, named, seen);
    assert_true(seen[0] > 0 && seen[1] > 0 && seen[2] > 0 && seen[3] > 0);
    rg_solver_free(s);
    rg_mesh_free(mesh);
    rg_case_free(c);
}

/* Between any two grains. */
static void test_grains(void **state) {
    (void)state;
    const char *const set[] = {
        "interface.sets=[{between: any, strength: 200e6}, {between: [any], where: z > 0, "
        "strength: 100e6}]"};
    rg_case *c = read_case(1, set);
    rg_mesh *mesh = rg_mesh_of_case(c);
    mesh->region = rg_alloc((size_t)mesh->elements, sizeof *mesh->region);
    rg_sets_add(&mesh->volume, "a");
    rg_sets_add(&mesh->volume, "b");
    for (rg_gid e = 0; e < mesh->elements; e++) {
        mesh->region[e] = (int32_t)(e / 7 % 3) - 1;
    }
    rg_part *part = rg_part_distribute(mesh, 96, MPI_COMM_SELF);
    rg_materials_assign(c, part, MPI_COMM_SELF);
    rg_solver *s = rg_solver_make_from_part(c, part, MPI_COMM_SELF);
    size_t seen[3] = {0};
    count_faces(s, mesh, grains, seen);
    assert_true(seen[0] > 0 && seen[1] > 0 && seen[2] > 0);
    rg_solver_free(s);
    rg_mesh_free(mesh);
    rg_case_free(c);
}

/* ---- Sets that are none ---- */

static const char *asked;

static void make(void) {
    const char *const set[] = {"mesh.cells=[1, 1, 2]", "mesh.size=[1e-3, 1e-3, 2e-3]",
                               "mesh.origin=[-1e-3, 0, 0]", "mesh.jitter=0", asked};
    rg_case *c = rg_case_read(RG_SOURCE_ROOT "/bench/examples/spall/spall.yaml", 5, set, stderr);
    rg_solver_make(c, MPI_COMM_WORLD);
}

/* The first set, and there the lowest face, where `where` is not finite; that it is 0 elsewhere does not
 * help. */
static void test_not_finite(void **state) {
    (void)state;
    static const struct {
        const char *sets, *words;
    } wrong[] = {
        {"interface.sets=[{where: 1, energy: 1}, {where: 'abs(nz) > 0.9 ? 1/(x - x) : 0', energy: 2}]",
         "interface.sets[1].where: abs(nz) > 0.9 ? 1/(x - x) : 0 is not finite at (-0.000666667, "
         "0.000666667, "
         "0.001)"},
        {"interface.sets=[{where: sqrt(-1 - z), energy: 1}, {where: 1/(x - x), energy: 1}]",
         "interface.sets[0].where: sqrt(-1 - z) is not finite at (-0.000666667, 0.000333333, "
         "0.000666667)"},
        {"interface.strength=1e12*(x + 0.5e-3)",
         "interface.strength: 1e12*(x + 0.5e-3) is not positive at (-0.000666667, 0.000333333, 0.000666667)"},
        {"interface.sets=[{where: 1, energy: 1}, {where: 1, energy: '-z'}]",
         "interface.sets[1].energy: -z is not positive at (-0.000666667, 0.000333333, 0.000666667)"},
        {"interface.sets=[{where: 1, beta: 'nz*nz - 1'}]",
         "interface.sets[0].beta: nz*nz - 1 is not 0 or positive"},
        {"interface.sets=[{where: 1, friction: 1/(x - x)}]",
         "interface.sets[0].friction: 1/(x - x) is not finite"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char said[2000];
        asked = wrong[i].sets;
        assert_int_equal(run_child(make, said, sizeof said), 2);
        if (strstr(said, wrong[i].words) == NULL) {
            fail_msg("%s: said %s", asked, said);
        }
    }
}

/* A set without a face is no set. */
static void test_empty(void **state) {
    (void)state;
    static const struct {
        const char *sets, *words;
    } wrong[] = {
        {"interface.sets=[{where: z > 1, energy: 1}]", "interface.sets[0]: no face is in it, where: z > 1\n"},
        {"interface.sets=[{between: [any], energy: 1}]",
         "interface.sets[0]: no face is in it between volume sets or materials\n"},
        {"interface.sets=[{set: x-, energy: 1}]",
         "interface.sets[0]: no face is in it that lies between elements, set: x-\n"},
        {"interface.sets=[{where: 1, energy: 1}, {set: weak, energy: 1}]",
         "interface.sets[1].set: the mesh has no set named 'weak'\n"},
        {"interface.sets=[{where: 1, energy: 1}, {where: 'nx > 2', strength: 1}, {where: 0, energy: 1}]",
         "interface.sets[1]: no face is in it, where: nx > 2\n"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char said[2000];
        asked = wrong[i].sets;
        assert_int_equal(run_child(make, said, sizeof said), 2);
        if (strstr(said, wrong[i].words) == NULL) {
            fail_msg("%s: said %s", asked, said);
        }
    }
}

/* A uniform case has no field. */
static void test_uniform(void **state) {
    (void)state;
    rg_case *c = read_case(0, NULL);
    rg_solver *s = rg_solver_make(c, MPI_COMM_SELF);
    assert_true(s->model->scale == NULL && s->model->beta == NULL && s->model->friction == NULL);
    assert_true(s->model->stiffest == 1);
    rg_solver_free(s);
    rg_case_free(c);
}

int main(int argc, char **argv) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_weibull),
        cmocka_unit_test(test_seed_and_keep),
        cmocka_unit_test(test_numbers),
        cmocka_unit_test(test_formula),
        cmocka_unit_test(test_without_softening),
        cmocka_unit_test(test_sets),
        cmocka_unit_test(test_properties),
        cmocka_unit_test(test_fields),
        cmocka_unit_test(test_named),
        cmocka_unit_test(test_grains),
        cmocka_unit_test(test_expressions),
        cmocka_unit_test(test_empty),
        cmocka_unit_test(test_uniform),
        cmocka_unit_test(test_not_finite),
    };
    omp_set_num_threads(1); /* a child has none of its parent's threads */
    MPI_Init(&argc, &argv);
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    MPI_Finalize();
    return failed;
}
