/* The equations themselves, on every set of kernels: forces are the gradient of the energy, a rigid motion
 * costs nothing, stresses, masses, and each regime of the interface by hand. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "support/kernel_input.h"

enum { NODE_VALUES = INPUT_EBLOCKS * RG_NODE_BLOCK };

/* Tolerances are a few times what rounding leaves, with either compiler and on all instruction sets. */
static void assert_near(double got, double expected, double tolerance) {
    if (!(fabs(got - expected) <= tolerance))
        fail_msg("%.17g instead of %.17g (tolerance %g)", got, expected, tolerance);
}

/* Runs `test` on every set. */
static void for_each_set(void (*test)(const rg_kernels *set)) {
    const rg_kernels *sets[INPUT_SETS];
    int n = input_sets(sets, INPUT_SETS);
    for (int k = 0; k < n; k++)
        test(sets[k]);
}

static rg_material_model model = RG_MATERIAL_NEO_HOOKEAN; /* of the bodies made next */

/* Runs `test` on every set for every elastic solid, or those that a rotation does not strain. */
static void for_each_solid(void (*test)(const rg_kernels *set), bool objective) {
    for (model = RG_MATERIAL_NEO_HOOKEAN; model < RG_MATERIAL_MODELS; model++)
        if (rg_material_history(model) == 0 && !(objective && model == RG_MATERIAL_LINEAR_ELASTIC))
            for_each_set(test);
    model = RG_MATERIAL_NEO_HOOKEAN;
}

/* A mesh with the total energy and force of its present displacement. */
typedef struct {
    const rg_kernels *set;
    input *in;
    double *force, *traction, *stiffening, *iforce, *turn, *crack, *energy;
    uint8_t *broken, *unlinked;
} body;

static body body_make(const rg_kernels *set, input *in) {
    input_set_model(in, model);
    return (body){
        .set = set,
        .in = in,
        .force = input_alloc(NODE_VALUES * sizeof(double)),
        .traction = input_alloc(INPUT_EBLOCKS * RG_TRACTION_BLOCK * sizeof(double)),
        .stiffening = input_alloc(INPUT_ESLOTS * sizeof(double)),
        .iforce = input_alloc(INPUT_IBLOCKS * RG_IFORCE_BLOCK * sizeof(double)),
        .turn = input_alloc(INPUT_IBLOCKS * RG_IFORCE_BLOCK * sizeof(double)),
        .crack = input_alloc(INPUT_IBLOCKS * RG_CRACK_BLOCK * sizeof(double)),
        .energy = input_alloc(INPUT_ISLOTS * RG_E_INTERFACE * sizeof(double)),
        .broken = input_alloc(INPUT_ISLOTS),
        .unlinked = input_alloc(INPUT_ISLOTS),
    };
}

static void body_free(body *b) {
    free(b->force);
    free(b->traction);
    free(b->stiffening);
    free(b->iforce);
    free(b->turn);
    free(b->crack);
    free(b->energy);
    free(b->broken);
    free(b->unlinked);
    input_free(b->in);
}

/* Evaluates bulk and interface from the input's crack state; returns the sum of all energies. */
static double evaluate(body *b) {
    input *in = b->in;
    double sum = 0;
    memcpy(b->crack, in->crack, INPUT_IBLOCKS * RG_CRACK_BLOCK * sizeof(double));
    memcpy(b->broken, in->broken, INPUT_ISLOTS);
    memcpy(b->unlinked, in->unlinked, INPUT_ISLOTS);
    rg_bulk_args bulk = input_bulk_args(in, b->force, b->traction, b->stiffening);
    rg_interface_args interface =
        input_interface_args(in, b->broken, b->unlinked, in->active, b->crack, b->iforce);
    interface.traction = b->traction;
    interface.turn = b->turn;
    b->set->bulk(&bulk, 0, INPUT_EBLOCKS);
    b->set->interface(&interface, 0, INPUT_IBLOCKS);
    b->set->bulk_state(&(rg_bulk_state_args){.bulk = &bulk, .energy = b->energy}, 0, INPUT_EBLOCKS);
    for (size_t e = 0; e < INPUT_ELEMENTS; e++)
        sum += b->energy[in->element[e]];
    b->set->interface_state(&(rg_interface_state_args){&interface, b->energy}, 0, INPUT_IBLOCKS);
    for (size_t i = 0; i < INPUT_ISLOTS * RG_E_INTERFACE; i++)
        sum += b->energy[i];
    return sum;
}

/* Force on component c of node a of the element in slot s: bulk and its interfaces. */
static double node_force(const body *b, size_t s, int a, int c) {
    double f = b->force[rg_node_index(s, a, c)];
    for (int face = 0; face < RG_FACES; face++)
        for (int k = 0; k < RG_FNODES; k++)
            if (rg_face_node[face][k] == a) {
                int32_t link = b->in->interface[rg_link_index(s, face)];
                if (link == RG_NO_INTERFACE)
                    continue;
                double g = b->iforce[rg_iforce_index((size_t)link / 4, k, c)];
                f += link % 4 == 1 ? -g : g;
                if (b->in->law.contact == RG_CONTACT_POTENTIAL && b->broken[link / 4])
                    f += b->turn[rg_iforce_index((size_t)link / 4, k, c)];
            }
    return f;
}

/* Central difference of the total energy. */
static double energy_slope(body *b, size_t k) {
    const double step = 3e-7 * INPUT_SIZE, start = b->in->u[k];
    b->in->u[k] = start + step;
    double up = evaluate(b);
    b->in->u[k] = start - step;
    double down = evaluate(b);
    b->in->u[k] = start;
    return (up - down) / (2 * step);
}

static void check_gradient(const rg_kernels *set, input *in) {
    body b = body_make(set, in);
    double *expected = input_alloc(NODE_VALUES * sizeof(double)), scale = 0;
    evaluate(&b);
    assert_memory_equal(b.broken, in->broken, INPUT_ISLOTS); /* no step of this test breaks a point */
    for (size_t e = 0; e < INPUT_ESLOTS; e++)
        for (int k = 0; k < 30; k++) {
            double f = node_force(&b, e, k / 3, k % 3);
            expected[rg_node_index(e, k / 3, k % 3)] = f;
            scale = fmax(scale, fabs(f));
        }
    assert_true(scale > 1e-3);
    for (size_t e = 0; e < INPUT_ELEMENTS; e += 9)
        for (int k = 0; k < 30; k++) {
            size_t place = rg_node_index(in->element[e], k / 3, k % 3);
            assert_near(-energy_slope(&b, place), expected[place], 8e-8 * scale);
        }
    free(expected);
    body_free(&b);
}

static const rg_cohesive unbreakable = {.strength = INFINITY, .opening = 1, .beta = 1};

static void check_intact_gradient(const rg_kernels *set) {
    for (int kind = 0; kind < 2; kind++)
        check_gradient(set, input_make((input_kind)kind, unbreakable, 3, 1));
}

/* Intact body: the force is the gradient of bulk energy at F + R plus penalty energy. */
static void test_intact_gradient(void **state) {
    (void)state;
    for_each_set(check_intact_gradient);
}

/* Displacement of the smooth deformation, and each element moved by up to `shift` as a whole. */
static void set_smooth(input *in, double shift) {
    for (size_t e = 0; e < INPUT_ELEMENTS; e++)
        for (int a = 0; a < RG_NODES; a++)
            for (int c = 0; c < 3; c++) {
                double u = shift * sin((double)(e * 3 + (size_t)c)) - in->x[e][a][c];
                for (int d = 0; d < 3; d++)
                    u += in->gradient[c][d] * in->x[e][a][d];
                in->u[rg_node_index(in->element[e], a, c)] = u;
            }
}

/* A third of all points, in all regimes, with openings much larger than the steps of the difference. */
static void break_some(input *in, const double w[CRACKS][2], const double largest[CRACKS]) {
    for (size_t i = 0; i < INPUT_INTERFACES; i++)
        for (int q = 0; q < RG_POINTS; q++)
            if ((i * 5 + (size_t)q) % 3 == 0) {
                size_t regime = (i + (size_t)q) % CRACKS;
                input_break_point(in, i, q, w[regime], largest[regime]);
            }
    input_flags(in);
}

/* Closed points do not slide: their force leaves out that the normal turns, which then costs nothing. */
static void check_broken_gradient(const rg_kernels *set) {
    static const double w[CRACKS][2] = {{0.4, 0.25}, {0.2, 0.12}, {-0.3, 0}, {0.5, 0.3}};
    static const double largest[CRACKS] = {0.2, 0.6, 0.5, 1.5};
    const rg_cohesive law = {.strength = 2e10, .opening = 5e-6, .beta = 1}; /* no further point breaks */
    input *in = input_make(INPUT_SMALL, law, 3, 1);
    set_smooth(in, 2e-7);
    break_some(in, w, largest);
    check_gradient(set, in);
}

/* With broken points the cohesive, contact and dissipated energies take the place of lift and penalty. */
static void test_broken_gradient(void **state) {
    (void)state;
    for_each_set(check_broken_gradient);
}

/* Contact as a potential: closed points have slid by up to most of their faces, or beyond, where nothing is
 * left of contact. The law is long enough that points which still hold it have slid as far. */
static void check_slid_gradient(const rg_kernels *set) {
    static const double w[CRACKS][2] = {{0.02, 0.05}, {0.01, 0.1}, {-0.1, 0.3}, {-0.02, 1.5}};
    static const double largest[CRACKS] = {0.01, 0.5, 0.6, 1.6};
    for (int beta = 0; beta < 2; beta++) {
        const rg_cohesive law = {
            .strength = 2e10, .opening = INPUT_SIZE, .beta = beta, .contact = RG_CONTACT_POTENTIAL};
        input *in = input_make(INPUT_SMALL, law, 3, 1);
        set_smooth(in, 2e-7);
        break_some(in, w, largest);
        check_gradient(set, in);
    }
}

static void test_slid_gradient(void **state) {
    (void)state;
    for_each_set(check_slid_gradient);
}

static void set_gradient(input *in, const double f[9]) {
    for (int k = 0; k < 9; k++)
        in->gradient[k / 3][k % 3] = f[k];
    set_smooth(in, 0);
}

static const double rotation[9] = {0.36, 0.48, -0.8, -0.8, 0.6, 0, 0.48, 0.64, 0.6};

static void check_rigid(const rg_kernels *set) {
    body b = body_make(set, input_make(INPUT_SMALL, unbreakable, 3, 1));
    const double scale = b.in->material.mu * INPUT_SIZE * INPUT_SIZE;
    set_gradient(b.in, rotation);
    for (size_t k = 0; k < NODE_VALUES; k++)
        b.in->u[k] += 2e-4;
    assert_near(evaluate(&b), 0, 5e-16 * scale * INPUT_SIZE);
    for (size_t e = 0; e < INPUT_ELEMENTS; e++) {
        assert_near(b.stiffening[b.in->element[e]], 1, 1e-13);
        for (int k = 0; k < 30; k++)
            assert_near(node_force(&b, b.in->element[e], k / 3, k % 3), 0, 1.2e-14 * scale);
    }
    body_free(&b);
}

/* A rotation and a translation cost no energy and no force. */
static void test_rigid(void **state) {
    (void)state;
    for_each_solid(check_rigid, true);
}

/* Mean first Piola-Kirchhoff stress of element e from its tractions, by the divergence theorem. */
static void mean_stress(const body *b, size_t e, double p[9]) {
    const size_t s = b->in->element[e];
    memset(p, 0, 9 * sizeof p[0]);
    for (int k = 0; k < 9; k++)
        for (int f = 0; f < RG_FACES; f++)
            for (int i = 0; i < RG_FCORNERS; i++)
                for (int j = 0; j < RG_FCORNERS; j++)
                    p[k] += b->traction[rg_traction_index(s, f, i, k / 3)] *
                            b->in->x[e][rg_face_node[f][j]][k % 3] / 9 /
                            b->in->geom[rg_geom_index(s, RG_GEOM_VOLUME)];
}

/* Energy density of element e. */
static double density_of(body *b, size_t e) {
    rg_bulk_args bulk = input_bulk_args(b->in, b->force, b->traction, b->stiffening);
    b->set->bulk_state(&(rg_bulk_state_args){.bulk = &bulk, .energy = b->energy}, 0, INPUT_EBLOCKS);
    return b->energy[b->in->element[e]] / b->in->geom[rg_geom_index(b->in->element[e], RG_GEOM_VOLUME)];
}

static void check_stress(const rg_kernels *set) {
    enum { E = 31 };
    body b = body_make(set, input_make(INPUT_LARGE, unbreakable, 3, 1));
    const double mu = b.in->material.mu, step = 1e-5;
    double f[9], p[9];
    memcpy(f, b.in->gradient, sizeof f);
    set_gradient(b.in, f);
    evaluate(&b);
    mean_stress(&b, E, p);
    for (int k = 0; k < 9; k++) {
        double moved[9], density[2];
        memcpy(moved, f, sizeof f);
        for (int side = 0; side < 2; side++) {
            moved[k] = f[k] + (side ? step : -step);
            set_gradient(b.in, moved);
            density[side] = density_of(&b, E);
        }
        assert_near(p[k], (density[1] - density[0]) / (2 * step), 4e-9 * mu);
    }
    body_free(&b);
}

/* P is the derivative of W. */
static void test_stress(void **state) {
    (void)state;
    for_each_solid(check_stress, false);
}

static double determinant(const double f[9]) {
    return f[0] * (f[4] * f[8] - f[5] * f[7]) - f[1] * (f[3] * f[8] - f[5] * f[6]) +
           f[2] * (f[3] * f[7] - f[4] * f[6]);
}

static void check_cauchy(const rg_kernels *set) {
    static const int place[9] = {0, 5, 4, 5, 1, 3, 4, 3, 2}; /* in xx yy zz yz xz xy: symmetric */
    body b = body_make(set, input_make(INPUT_LARGE, unbreakable, 3, 1));
    double *cauchy = input_alloc(INPUT_ESLOTS * 24 * sizeof(double));
    double f[9], p[9];
    memcpy(f, b.in->gradient, sizeof f);
    set_smooth(b.in, 0);
    evaluate(&b);
    rg_bulk_args bulk = input_bulk_args(b.in, b.force, b.traction, b.stiffening);
    set->bulk_state(&(rg_bulk_state_args){.bulk = &bulk, .cauchy = cauchy}, 0, INPUT_EBLOCKS);
    for (size_t e = 0; e < INPUT_ELEMENTS; e++) {
        size_t s = b.in->element[e];
        mean_stress(&b, e, p);
        for (int k = 0; k < 9; k++)
            for (size_t g = 0; g < RG_GAUSS; g++) {
                double expected = 0;
                for (int c = 0; c < 3; c++)
                    expected += p[k / 3 * 3 + c] * f[k % 3 * 3 + c] / determinant(f);
                size_t at = (s / RG_LANES * 24 + g * 6 + (size_t)place[k]) * RG_LANES + s % RG_LANES;
                assert_near(cauchy[at], expected, 8e-13 * b.in->material.mu);
            }
    }
    free(cauchy);
    body_free(&b);
}

/* Cauchy stress P F^T / J, and that it is symmetric. */
static void test_cauchy(void **state) {
    (void)state;
    for_each_solid(check_cauchy, true);
}

static void check_uniaxial(const rg_kernels *set, double stretch) {
    const double f[9] = {stretch, 0, 0, 0, 1, 0, 0, 0, 1};
    body b = body_make(set, input_make(INPUT_SMALL, unbreakable, 3, 1));
    const double mu = b.in->material.mu, lambda = b.in->material.lambda, log_j = log(stretch);
    const double across = lambda * log_j, along = mu * stretch + (lambda * log_j - mu) / stretch;
    const double density = (lambda / 2 * log_j - mu) * log_j + mu / 2 * (stretch * stretch - 1);
    const double slope = fmax(0, lambda + mu - lambda * log_j) * fmax(1, 1 / (stretch * stretch));
    double p[9];
    set_gradient(b.in, f);
    evaluate(&b);
    for (size_t e = 0; e < INPUT_ELEMENTS; e++) {
        mean_stress(&b, e, p);
        for (int k = 0; k < 9; k++)
            assert_near(p[k], k == 0 ? along : k % 4 == 0 ? across : 0, 4e-12 * mu);
        assert_near(b.stiffening[b.in->element[e]], (mu + slope) / (lambda + 2 * mu), 2e-14);
        if (e % 20 == 0)
            assert_near(density_of(&b, e), density, 1.5e-12 * mu);
    }
    body_free(&b);
}

static void check_uniaxials(const rg_kernels *set) {
    check_uniaxial(set, 0.8);
    check_uniaxial(set, 1.1);
    check_uniaxial(set, 20); /* so far that the tangent of the pressure is negative */
}

/* Compression and tension along x, by hand. */
static void test_uniaxial(void **state) {
    (void)state;
    for_each_set(check_uniaxials);
}

static void check_extension(const rg_kernels *set) {
    body b = body_make(set, input_make(INPUT_SMALL, unbreakable, 3, 1));
    const double strain = 1e-6, curve = strain / INPUT_SIZE, mu = b.in->material.mu;
    for (size_t e = 0; e < INPUT_ELEMENTS; e++)
        for (int k = 0; k < 30; k++) {
            double x = b.in->x[e][k / 3][k % 3];
            b.in->u[rg_node_index(b.in->element[e], k / 3, k % 3)] = curve * x * x / 2;
        }
    evaluate(&b);
    for (size_t i = 0; i < INPUT_INTERFACES; i++)
        for (int k = 0; k < RG_FCORNERS * 3; k++) {
            size_t s = b.in->slot[i], e = 0;
            int32_t link = b.in->side[0][s];
            while (b.in->element[e] != (size_t)link / 4)
                e++;
            const double *x = b.in->x[e][rg_face_node[link % 4][k / 3]];
            double vector[3], area = input_area(b.in, s, vector);
            double stress = curve * (b.in->material.lambda * (x[0] + x[1] + x[2]) + 2 * mu * x[k % 3]);
            double expected = stress * vector[k % 3];
            double got = b.traction[rg_traction_index((size_t)link / 4, link % 4, k / 3, k % 3)];
            assert_near(got, expected, 1e-4 * area * mu * strain);
        }
    body_free(&b);
}

/* A stress linear in position (quadratic displacement, small strain) reaches the corners of the faces
 * exactly. */
static void test_extension(void **state) {
    (void)state;
    for_each_set(check_extension);
}

/* Kinetic energy of the first element for nodal speeds v along one axis, over density times volume. */
static double kinetic(const rg_kernels *set, const input *in, rg_mass kind, const double v[RG_NODES]) {
    double velocity[RG_NODE_BLOCK] __attribute__((aligned(64))) = {0};
    double energy[RG_LANES] __attribute__((aligned(64)));
    for (int a = 0; a < RG_NODES; a++)
        velocity[rg_node_index(5, a, 1)] = v[a];
    rg_kinetic_args args = {1000, kind, in->geom, velocity, energy};
    set->kinetic(&args, 0, 1);
    assert_near(energy[4], 0, 0);
    return energy[5] / 1000 / in->geom[rg_geom_index(5, RG_GEOM_VOLUME)];
}

/* 420 times the entry (a, b) of the consistent mass of the quadratic tetrahedron, from the literature. */
static double literature_mass(int a, int b) {
    static const int end[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
    if (a < 4 && b < 4)
        return a == b ? 6 : 1;
    if (a < 4 || b < 4) {
        const int corner = a < 4 ? a : b, *edge = end[(a < 4 ? b : a) - 4];
        return edge[0] == corner || edge[1] == corner ? -4 : -6;
    }
    const int *p = end[a - 4], *q = end[b - 4];
    int shared = (p[0] == q[0]) + (p[0] == q[1]) + (p[1] == q[0]) + (p[1] == q[1]);
    return shared == 2 ? 32 : shared == 1 ? 16 : 8;
}

/* The scaled mass for s = 2 by hand, times 420, in the kinds of pairs that literature_mass knows. */
static double expected_mass(rg_mass kind, int a, int b) {
    static const double plain[7] = {6, 1, -4, -6, 32, 16, 8};
    static const double scaled[7] = {9.2, 23. / 15, -92. / 15, -82. / 15, 568. / 15, 15.2, 128. / 15};
    if (kind == RG_MASS_LUMPED)
        return a != b ? 0 : a < 4 ? 1.0 / 36 : 4.0 / 27;
    for (int k = 0; k < 7 && kind == RG_MASS_SCALED; k++)
        if (plain[k] == literature_mass(a, b))
            return scaled[k] / 420;
    return literature_mass(a, b) / 420;
}

static void check_mass(const rg_kernels *set) {
    input *in = input_make(INPUT_SMALL, unbreakable, 3, 0);
    for (int a = 0; a < RG_NODES; a++)
        for (int b = 0; b < RG_NODES; b++)
            for (rg_mass kind = RG_MASS_CONSISTENT; kind < (rg_mass)RG_MASSES; kind++) {
                double one[RG_NODES] = {0}, other[RG_NODES] = {0}, sum[RG_NODES] = {0};
                one[a] = other[b] = 1;
                sum[a] += 1;
                sum[b] += 1;
                double mass =
                    kinetic(set, in, kind, sum) - kinetic(set, in, kind, one) - kinetic(set, in, kind, other);
                assert_near(mass, expected_mass(kind, a, b), 7e-16);
            }
    input_free(in);
}

/* Entries of the mass matrices; the sums are the element's mass (4 corners, 6 mid-edges: 1/9 + 8/9). */
static void test_mass(void **state) {
    double sum = 0;
    (void)state;
    for (int k = 0; k < RG_NODES * RG_NODES; k++)
        sum += literature_mass(k / RG_NODES, k % RG_NODES) / 420;
    assert_near(sum, 1, 2e-15);
    for_each_set(check_mass);
}

/* f - M a for the element in slot s, along component c, with the accelerations `a` of the whole mesh. */
static void check_balance(const body *b, size_t s, rg_mass kind, const double *a) {
    const double mass = b->in->material.density * b->in->geom[rg_geom_index(s, RG_GEOM_VOLUME)];
    for (int c = 0; c < 3; c++)
        for (int n = 0; n < RG_NODES; n++) {
            double sum = 0;
            for (int k = 0; k < RG_NODES; k++) {
                sum += mass * expected_mass(kind, n, k) * a[rg_node_index(s, k, c)];
            }
            assert_near(sum, node_force(b, s, n, c), 5e-13);
        }
}

/* Kick of the whole body by the input's forces, from the input's velocities. */
static void kick(const body *b, rg_mass kind, double *velocity, double *now) {
    const rg_kick_args args = {.density = b->in->material.density,
                               .mass = kind,
                               .dt = 1e-9,
                               .geom = b->in->geom,
                               .force = b->force,
                               .iforce = b->iforce,
                               .interface = b->in->interface,
                               .velocity = velocity,
                               .step_velocity = now,
                               .dt_now = 4e-10};
    b->set->kick(&args, 0, INPUT_EBLOCKS);
}

static void check_kick(const rg_kernels *set) {
    body b = body_make(set, input_make(INPUT_SMALL, unbreakable, 3, 1));
    const size_t bytes = NODE_VALUES * sizeof(double);
    double *velocity = input_alloc(bytes), *now = input_alloc(bytes), *a = input_alloc(bytes);
    memcpy(b.force, b.in->pull, bytes);
    memcpy(b.iforce, b.in->ipull, INPUT_IBLOCKS * RG_IFORCE_BLOCK * sizeof(double));
    for (rg_mass kind = RG_MASS_CONSISTENT; kind < (rg_mass)RG_MASSES; kind++) {
        memset(velocity, 0, bytes);
        kick(&b, kind, velocity, NULL);
        for (size_t k = 0; k < NODE_VALUES; k++)
            a[k] = velocity[k] / 1e-9;
        for (size_t e = 0; e < INPUT_ELEMENTS; e++)
            check_balance(&b, b.in->element[e], kind, a);
        memcpy(velocity, b.in->velocity, bytes);
        kick(&b, kind, velocity, now);
        for (size_t k = 0; k < NODE_VALUES; k++) {
            double v = b.in->velocity[k];
            assert_near(velocity[k], v + 1e-9 * a[k], 1e-12 * fabs(1e-9 * a[k]) + 1e-13);
            assert_near(now[k], v + 4e-10 * a[k], 1e-12 * fabs(4e-10 * a[k]) + 1e-13);
        }
        memcpy(a, velocity, bytes);
        memcpy(velocity, b.in->velocity, bytes);
        kick(&b, kind, velocity, NULL);
        assert_memory_equal(velocity, a, bytes);
    }
    free(velocity);
    free(now);
    free(a);
    body_free(&b);
}

/* M a = f with the interface forces on both sides, v += dt a; where `now` is given, v + dt_now a there. */
static void test_kick(void **state) {
    (void)state;
    for_each_set(check_kick);
}

static void check_drift(const rg_kernels *set) {
    input *in = input_make(INPUT_SMALL, unbreakable, 3, 1);
    double *u = input_alloc(NODE_VALUES * sizeof(double));
    memcpy(u, in->u, NODE_VALUES * sizeof(double));
    set->drift(&(rg_drift_args){3e-10, in->velocity, u}, 0, INPUT_EBLOCKS);
    for (size_t k = 0; k < NODE_VALUES; k++)
        assert_near(u[k], in->u[k] + 3e-10 * in->velocity[k], 1e-14 * fabs(3e-10 * in->velocity[k]) + 1e-21);
    free(u);
    input_free(in);
}

/* u += dt v. */
static void test_drift(void **state) {
    (void)state;
    for_each_set(check_drift);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_intact_gradient),
        cmocka_unit_test(test_broken_gradient),
        cmocka_unit_test(test_slid_gradient),
        cmocka_unit_test(test_rigid),
        cmocka_unit_test(test_stress),
        cmocka_unit_test(test_cauchy),
        cmocka_unit_test(test_uniaxial),
        cmocka_unit_test(test_extension),
        cmocka_unit_test(test_mass),
        cmocka_unit_test(test_kick),
        cmocka_unit_test(test_drift),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
