#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include "base/hash.h"
#include "reference/reference.h"
#include "support/kernel_input.h"

enum { NX = 3, NY = 3, NZ = 2, VERTICES = (NX + 1) * (NY + 1) * (NZ + 1) };

enum {
    KEY_VERTEX = 1,
    KEY_JITTER,
    KEY_U,
    KEY_GRADIENT,
    KEY_VELOCITY,
    KEY_PULL,
    KEY_CLASS,
    KEY_TRACTION,
    KEY_BREAK
};

static uint64_t key(const input *in, uint64_t kind, uint64_t a, uint64_t b) {
    return rg_hash(rg_hash(rg_hash(in->seed, kind), a), b);
}

/* Uniform in [-1, 1). */
static double noise(const input *in, uint64_t kind, uint64_t a, uint64_t b) {
    return 2 * rg_hash_uniform(key(in, kind, a, b)) - 1;
}

static void shuffle(size_t *list, size_t n, uint64_t seed) {
    for (size_t k = 0; k < n; k++)
        list[k] = k;
    for (size_t k = n; seed && k > 1; k--) {
        size_t other = rg_hash(seed, k) % k, t = list[k - 1];
        list[k - 1] = list[other];
        list[other] = t;
    }
}

/* Mesh: vertices are numbered at random, so that sorting gives elements of both orientations. */
typedef struct {
    double x[VERTICES][3];
    size_t corner[INPUT_ELEMENTS][4];
    double volume[INPUT_ELEMENTS];
} mesh;

static void place_vertices(const input *in, mesh *m, size_t number[VERTICES]) {
    shuffle(number, VERTICES, key(in, KEY_VERTEX, 0, 0));
    for (size_t v = 0; v < VERTICES; v++) {
        const size_t cell[3] = {v % (NX + 1), v / (NX + 1) % (NY + 1), v / ((NX + 1) * (NY + 1))};
        for (size_t c = 0; c < 3; c++)
            m->x[number[v]][c] = INPUT_SIZE * ((double)cell[c] + 0.12 * noise(in, KEY_JITTER, v, c));
    }
}

static int ascending(const void *a, const void *b) {
    size_t x = *(const size_t *)a, y = *(const size_t *)b;
    return (x > y) - (x < y);
}

/* Six tetrahedra around the cube's diagonal: one for each order of steps along the axes. */
static void make_corners(mesh *m, const size_t number[VERTICES]) {
    static const int order[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (size_t e = 0; e < INPUT_ELEMENTS; e++) {
        size_t cube = e / 6, at[3] = {cube % NX, cube / NX % NY, cube / (NX * NY)};
        for (int k = 0; k < 4; k++) {
            if (k > 0)
                at[order[e % 6][k - 1]]++;
            m->corner[e][k] = number[at[0] + (NX + 1) * (at[1] + (NY + 1) * at[2])];
        }
        qsort(m->corner[e], 4, sizeof m->corner[e][0], ascending);
    }
}

static void element_geometry(input *in, mesh *m, size_t e, size_t s) {
    double edge[3][3], cross[3][3];
    for (int k = 0; k < 3; k++)
        for (int c = 0; c < 3; c++)
            edge[k][c] = m->x[m->corner[e][k]][c] - m->x[m->corner[e][3]][c];
    for (int k = 0; k < 3; k++)
        rg_reference_cross(edge[(k + 1) % 3], edge[(k + 2) % 3], cross[k]);
    double det = rg_reference_dot(edge[0], cross[0]);
    for (int k = 0; k < 9; k++)
        in->geom[rg_geom_index(s, RG_GEOM_GRAD + k)] = (rg_real)(cross[k / 3][k % 3] / det);
    m->volume[e] = fabs(det) / 6;
    in->geom[rg_geom_index(s, RG_GEOM_VOLUME)] = (rg_real)m->volume[e];
    for (int i = 0; i < 4; i++)
        for (int j = i; j < 4; j++)
            for (int c = 0; c < 3; c++)
                in->x[e][rg_edge_node[i][j]][c] = (m->x[m->corner[e][i]][c] + m->x[m->corner[e][j]][c]) / 2;
}

static bool same_face(const mesh *m, size_t e, int f, size_t d, int g) {
    for (int k = 0; k < 3; k++)
        if (m->corner[e][rg_face_node[f][k]] != m->corner[d][rg_face_node[g][k]])
            return false;
    return true;
}

/* Geometry of the interface in slot s at face f of element e, across from element d. Returns whether e is on
 * the minus side: the edges of the face decide, not the numbers of the elements. */
static bool interface_geometry(input *in, const mesh *m, size_t s, size_t e, int f, size_t d) {
    double area_vector[3], outward = 0;
    for (int k = 0; k < 2; k++)
        for (int c = 0; c < 3; c++)
            in->igeom[rg_igeom_index(s, RG_IGEOM_EDGE + 3 * k + c)] =
                (rg_real)(in->x[e][rg_face_node[f][k + 1]][c] - in->x[e][rg_face_node[f][0]][c]);
    double area = input_area(in, s, area_vector);
    for (int c = 0; c < 3; c++)
        outward += area_vector[c] * (in->x[e][rg_face_node[f][0]][c] - in->x[e][f][c]);
    double height = 3 * fmin(m->volume[e], m->volume[d]) / area, penalty = area * 4 / height;
    in->igeom[rg_igeom_index(s, RG_IGEOM_PEN_ISO)] = (rg_real)(penalty * in->material.mu);
    in->igeom[rg_igeom_index(s, RG_IGEOM_PEN_NORM)] =
        (rg_real)(penalty * (in->material.lambda + in->material.mu) / (area * area));
    return outward > 0;
}

static void link_side(input *in, size_t s, int side, size_t e, int f, size_t d, int g) {
    in->side[side][s] = rg_side_link(in->element[e], f);
    in->interface[rg_link_index(in->element[e], f)] = rg_link(s, side, 4);
    in->neighbour[rg_link_index(in->element[e], f)] = rg_neighbour_link(in->element[d], g);
}

/* Finds the interior faces; everything not linked is surface. */
static void connect(input *in, const mesh *m) {
    size_t i = 0;
    for (size_t s = 0; s < INPUT_ESLOTS; s++)
        for (int f = 0; f < RG_FACES; f++) {
            in->neighbour[rg_link_index(s, f)] = rg_neighbour_link(s, f);
            in->interface[rg_link_index(s, f)] = RG_NO_INTERFACE;
        }
    for (size_t e = 0; e < INPUT_ELEMENTS; e++)
        for (size_t d = e + 1; d < INPUT_ELEMENTS; d++)
            for (int k = 0; k < 16; k++)
                if (same_face(m, e, k / 4, d, k % 4)) {
                    size_t s = in->slot[i++];
                    int plus = interface_geometry(in, m, s, e, k / 4, d) ? 0 : 1; /* side of e */
                    link_side(in, s, plus, e, k / 4, d, k % 4);
                    link_side(in, s, 1 - plus, d, k % 4, e, k / 4);
                }
    if (i != INPUT_INTERFACES)
        abort();
    for (; i < INPUT_ISLOTS; i++) /* padding: no area, but sides that would pull it apart */
        for (int side = 0; side < 2; side++)
            in->side[side][in->slot[i]] = in->side[side][in->slot[INPUT_INTERFACES - 1]];
}

static void choose_gradient(input *in, input_kind kind) {
    const double c = cos(2), s = sin(2), rotation[3][3] = {{c, 0, s}, {0, 1, 0}, {-s, 0, c}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double n = noise(in, KEY_GRADIENT, (uint64_t)i, (uint64_t)j);
            in->gradient[i][j] = (i == j) + 5e-3 * n;
            for (int k = 0; kind == INPUT_LARGE && k < 3; k++) {
                const double stretch = k != j ? 0.03 : j == 0 ? 1.2 : j == 1 ? 0.85 : 0.95;
                in->gradient[i][j] = (k == 0 ? 0 : in->gradient[i][j]) + rotation[i][k] * stretch;
            }
        }
}

static void fill_nodes(input *in, input_kind kind) {
    const double rough = INPUT_SIZE * (kind == INPUT_LARGE ? 6e-3 : 1e-3);
    for (uint64_t e = 0; e < INPUT_ELEMENTS; e++)
        for (int a = 0; a < RG_NODES; a++)
            for (int c = 0; c < 3; c++) {
                size_t k = rg_node_index(in->element[e], a, c);
                uint64_t component = (uint64_t)(3 * a + c);
                const double *x = in->x[e][a];
                in->u[k] = (rg_real)(rg_reference_dot(in->gradient[c], x) - x[c] +
                                     rough * noise(in, KEY_U, e, component));
                in->velocity[k] = (rg_real)(10 * noise(in, KEY_VELOCITY, e, component));
                in->pull[k] = (rg_real)(20 * noise(in, KEY_PULL, e, component));
            }
    for (uint64_t i = 0; i < INPUT_INTERFACES; i++)
        for (int k = 0; k < RG_FNODES * 3; k++)
            in->ipull[rg_iforce_index(in->slot[i], k / 3, k % 3)] =
                (rg_real)(20 * noise(in, KEY_PULL, ~i, (uint64_t)k));
}

double input_area(const input *in, size_t s, double vector[3]) {
    double edge[2][3];
    for (int k = 0; k < 6; k++)
        edge[k / 3][k % 3] = in->igeom[rg_igeom_index(s, RG_IGEOM_EDGE + k)];
    rg_reference_cross(edge[0], edge[1], vector);
    for (int c = 0; c < 3; c++)
        vector[c] /= 2;
    return sqrt(rg_reference_dot(vector, vector));
}

/* Unit normal, one unit tangent and relative area of the interface under the smooth deformation. */
static double current_frame(const input *in, size_t i, double n[3], double m[3]) {
    double edge[2][3] = {{0}}, cross[3], reference[3];
    for (int c = 0; c < 3; c++)
        for (int d = 0; d < 3; d++)
            for (int k = 0; k < 2; k++)
                edge[k][c] +=
                    in->gradient[c][d] * in->igeom[rg_igeom_index(in->slot[i], RG_IGEOM_EDGE + 3 * k + d)];
    rg_reference_cross(edge[0], edge[1], cross);
    double length = sqrt(rg_reference_dot(cross, cross)), side = sqrt(rg_reference_dot(edge[0], edge[0]));
    for (int c = 0; c < 3; c++) {
        n[c] = cross[c] / length;
        m[c] = edge[0][c] / side;
    }
    return length / 2 / input_area(in, in->slot[i], reference);
}

input_pull input_pull_of(const input *in, size_t i) {
    return (input_pull)(key(in, KEY_CLASS, i, 0) % PULLS);
}

input_crack input_crack_of(const input *in, size_t i, int q) {
    return (input_crack)(key(in, KEY_BREAK, i, (uint64_t)q + RG_POINTS) % CRACKS);
}

/* Both sides' tractions of interface i: well on one side of the criterion, with a part that cancels in the
 * average. */
static void fill_interface_traction(input *in, size_t i) {
    const double pull[PULLS][2] = {{0.2, 0.1}, {0.6, 0.2}, {1.5, 0.3}, {0.3, 1.5}, {-0.5, 1.5}};
    const double beta = in->law.beta > 0 ? in->law.beta : 1;
    const size_t s = in->slot[i];
    double n[3], m[3], reference[3];
    double force = current_frame(in, i, n, m) * input_area(in, s, reference);
    force *= isfinite(in->law.strength) ? in->law.strength : 4e8;
    const double *level = pull[input_pull_of(in, i)];
    /* the first opening of a compressed point has no normal part: closed or not would be rounding's choice */
    bool undecided =
        in->law.contact == RG_CONTACT_FLUX && in->law.activation != RG_ACTIVATION_TOTAL && level[0] < 0;
    for (int k = 0; k < RG_FCORNERS * 3; k++)
        for (int side = 0; side < 2; side++) {
            double t = level[0] * (undecided ? -1 : 1) * n[k % 3] + beta * level[1] * m[k % 3];
            double common = 0.2 * noise(in, KEY_TRACTION, i, (uint64_t)k);
            double own = 0.02 * noise(in, KEY_TRACTION, i, (uint64_t)(k + 9 * (side + 1)));
            int32_t link = in->side[side][s];
            in->traction[rg_traction_index((size_t)link / 4, link % 4, k / 3, k % 3)] =
                (rg_real)(force * ((side ? -1 : 1) * t + common + own));
        }
}

void input_jump(const input *in, size_t s, int q, double jump[3]) {
    double l[3], shape[RG_FNODES];
    rg_reference_face_point(q, l);
    rg_reference_face_shape(l, shape);
    for (int c = 0; c < 3; c++) {
        jump[c] = 0;
        for (int a = 0; a < RG_FNODES; a++)
            for (int side = 0; side < 2; side++) {
                int32_t link = in->side[side][s];
                double value = in->u[rg_node_index((size_t)link / 4, rg_face_node[link % 4][a], c)];
                jump[c] += (side ? 1 : -1) * shape[a] * value;
            }
    }
}

void input_break_point(input *in, size_t i, int q, const double w[2], double largest) {
    const size_t s = in->slot[i];
    double n[3], m[3], jump[3];
    current_frame(in, i, n, m);
    input_jump(in, s, q, jump);
    in->broken[s] |= (uint8_t)(1 << q);
    in->unlinked[s] |= (uint8_t)(1 << q);
    in->crack[rg_crack_index(s, q, RG_CRACK_OPENING)] = (rg_real)(largest * in->law.opening);
    for (int c = 0; c < 3; c++)
        in->crack[rg_crack_index(s, q, RG_CRACK_ORIGIN + c)] =
            (rg_real)(jump[c] - in->law.opening * (w[0] * n[c] + w[1] * m[c]));
    in->crack[rg_crack_index(s, q, RG_CRACK_TIME)] = (rg_real)1e-7;
    in->crack[rg_crack_index(s, q, RG_CRACK_GIVEN)] =
        (rg_real)(noise(in, KEY_BREAK, i, (uint64_t)q + 2 * RG_POINTS) * in->law.opening);
}

void input_break(input *in, double probability) {
    static const double w[CRACKS][2] = {{0.4, 0.25}, {0.2, 0.12}, {-0.1, 0.2}, {0.5, 0.3}};
    static const double largest[CRACKS] = {0.2, 0.6, 0.55, 1.5};
    for (size_t i = 0; i < INPUT_INTERFACES; i++)
        for (int q = 0; q < RG_POINTS; q++) {
            uint64_t chance = key(in, KEY_BREAK, i, (uint64_t)q);
            if (rg_hash_uniform(chance) >= probability)
                continue;
            input_crack regime = input_crack_of(in, i, q);
            input_break_point(in, i, q, w[regime], largest[regime]);
            if (in->law.contact == RG_CONTACT_FLUX && chance % 3 == 0)
                in->unlinked[in->slot[i]] &= (uint8_t) ~(1 << q);
        }
    input_flags(in);
}

uint8_t input_unlinked(const input *in, size_t s, int f) {
    int32_t link = in->interface[rg_link_index(s, f)];
    return link == RG_NO_INTERFACE ? 0 : in->unlinked[link / 4];
}

void input_flags(input *in) {
    memset(in->cracked, 0, INPUT_EBLOCKS);
    memset(in->active, 0, INPUT_IBLOCKS);
    for (size_t s = 0; s < INPUT_ESLOTS; s++)
        for (int f = 0; f < RG_FACES; f++)
            if (input_unlinked(in, s, f))
                in->cracked[s / RG_LANES] = 1;
    for (size_t s = 0; s < INPUT_ISLOTS; s++)
        if (in->broken[s])
            in->active[s / RG_LANES] = 1;
}

void *input_alloc(size_t bytes) {
    size_t whole = (bytes + 63) / 64 * 64;
    void *p = aligned_alloc(64, whole);
    if (!p)
        abort();
    return memset(p, 0, whole);
}

static rg_real *reals(size_t blocks, size_t per_block) {
    return input_alloc(blocks * per_block * sizeof(rg_real));
}

static void allocate(input *in) {
    in->u = reals(INPUT_EBLOCKS, RG_NODE_BLOCK);
    in->velocity = reals(INPUT_EBLOCKS, RG_NODE_BLOCK);
    in->pull = reals(INPUT_EBLOCKS, RG_NODE_BLOCK);
    in->geom = reals(INPUT_EBLOCKS, RG_GEOM_BLOCK);
    in->traction = reals(INPUT_EBLOCKS, RG_TRACTION_BLOCK);
    in->igeom = reals(INPUT_IBLOCKS, RG_IGEOM_BLOCK);
    in->ipull = reals(INPUT_IBLOCKS, RG_IFORCE_BLOCK);
    in->crack = reals(INPUT_IBLOCKS, RG_CRACK_BLOCK);
    in->neighbour = input_alloc(INPUT_ESLOTS * RG_FACES * sizeof(int32_t));
    in->interface = input_alloc(INPUT_ESLOTS * RG_FACES * sizeof(int32_t));
    for (int side = 0; side < 2; side++)
        in->side[side] = input_alloc(INPUT_ISLOTS * sizeof(int32_t));
    in->broken = input_alloc(INPUT_ISLOTS);
    in->unlinked = input_alloc(INPUT_ISLOTS);
    in->active = input_alloc(INPUT_IBLOCKS);
    in->cracked = input_alloc(INPUT_EBLOCKS);
}

/* Of no symmetry, some 30 % off the isotropic stiffness. */
static void set_stiffness(rg_material *m) {
    rg_anisotropic *a = &m->of.anisotropic;
    for (int i = 0, at = 0; i < 6; i++)
        for (int j = i; j < 6; j++, at++) {
            double isotropic = i < 3 && j < 3 ? m->lambda + (i == j) * 2 * m->mu : (i == j) * m->mu;
            a->stiffness[at] = isotropic + 0.3 * m->mu * sin(1 + 7 * at);
        }
    a->stiffest = 1.5 * (m->lambda + 2 * m->mu);
    a->softest = 0.7 * (m->lambda + 2 * m->mu);
}

/* A solid's own parameters, of which none is 0: stresses as fractions of the shear modulus. */
static void set_parameters(rg_material *m) {
#define UNIT(NAME, key, unit, ...) unit,
    static const char *const units[RG_PARAMETERS] = {RG_MATERIAL_PARAMETERS(UNIT)};
    for (int k = 0; k < RG_PARAMETERS; k++) {
        bool stress = units[k] != NULL && strcmp(units[k], "Pa") == 0;
        m->of.parameter[k] = (0.2 + 0.05 * k) * (stress ? m->mu : 1);
    }
}

void input_set_model(input *in, rg_material_model model) {
    in->material.model = model;
    double mu = in->material.mu, *parameter = in->material.of.parameter;
    if (model == RG_MATERIAL_ANISOTROPIC)
        set_stiffness(&in->material);
    if (model == RG_MATERIAL_OGDEN) { /* of the same moduli at rest, of three terms */
        parameter[RG_PARAMETER_BULK] = in->material.lambda + 2 * mu / 3;
        parameter[RG_PARAMETER_MU_1] = 0.5 * mu;
        parameter[RG_PARAMETER_ALPHA_1] = 1.3;
        parameter[RG_PARAMETER_MU_2] = 0.1 * mu;
        parameter[RG_PARAMETER_ALPHA_2] = 5;
        parameter[RG_PARAMETER_MU_3] = -0.425 * mu;
        parameter[RG_PARAMETER_ALPHA_3] = -2;
    }
    if (model == RG_MATERIAL_MOONEY_RIVLIN) { /* of the same moduli at rest */
        parameter[RG_PARAMETER_BULK] = in->material.lambda + 2 * mu / 3;
        parameter[RG_PARAMETER_C10] = 0.3 * mu;
        parameter[RG_PARAMETER_C01] = 0.2 * mu;
    }
}

input *input_make(input_kind kind, rg_cohesive law, uint64_t seed, uint64_t order) {
    const double young = 260e9, nu = 0.21;
    size_t number[VERTICES];
    mesh m;
    input *in = input_alloc(sizeof *in);
    in->seed = seed;
    in->law = law;
    in->material = (rg_material){
        .lambda = young * nu / ((1 + nu) * (1 - 2 * nu)), .mu = young / (2 + 2 * nu), .density = 3690};
    set_parameters(&in->material);
    allocate(in);
    shuffle(in->element, INPUT_ESLOTS, order ? rg_hash(order, 1) : 0);
    shuffle(in->slot, INPUT_ISLOTS, order ? rg_hash(order, 2) : 0);
    place_vertices(in, &m, number);
    make_corners(&m, number);
    for (size_t e = 0; e < INPUT_ELEMENTS; e++)
        element_geometry(in, &m, e, in->element[e]);
    for (size_t e = INPUT_ELEMENTS; e < INPUT_ESLOTS; e++) /* padding: element 0's shape, at rest */
        for (int k = 0; k < RG_GEOM; k++)
            in->geom[rg_geom_index(in->element[e], k)] = in->geom[rg_geom_index(in->element[0], k)];
    connect(in, &m);
    choose_gradient(in, kind);
    fill_nodes(in, kind);
    for (size_t i = 0; i < INPUT_INTERFACES; i++)
        fill_interface_traction(in, i);
    input_flags(in);
    return in;
}

void input_free(input *in) {
    free(in->u);
    free(in->velocity);
    free(in->pull);
    free(in->geom);
    free(in->traction);
    free(in->igeom);
    free(in->ipull);
    free(in->crack);
    free(in->neighbour);
    free(in->interface);
    free(in->side[0]);
    free(in->side[1]);
    free(in->broken);
    free(in->unlinked);
    free(in->active);
    free(in->cracked);
    free(in);
}

rg_bulk_args input_bulk_args(const input *in, rg_real *force, rg_real *traction, rg_real *stiffening) {
    return (rg_bulk_args){
        .material = in->material,
        .gradient = RG_GRADIENT_LIFTED,
        .u = in->u,
        .geom = in->geom,
        .neighbour = in->neighbour,
        .interface = in->interface,
        .cracked = in->cracked,
        .unlinked = in->unlinked,
        .history_stride = rg_history_block(rg_material_history(in->material.model)),
        .force = force,
        .traction = traction,
        .stiffening = stiffening,
    };
}

rg_interface_args input_interface_args(const input *in, uint8_t *broken, uint8_t *unlinked, uint8_t *active,
                                       rg_real *crack, rg_real *force) {
    return (rg_interface_args){
        .law = in->law,
        .time = 3e-7,
        .u = in->u,
        .traction = in->traction,
        .first_tile_face = INPUT_IBLOCKS,
        .side = {in->side[0], in->side[1]},
        .geom = in->igeom,
        .broken = broken,
        .unlinked = unlinked,
        .active = active,
        .crack = crack,
        .crack_stride = RG_CRACK_BLOCK,
        .force = force,
    };
}

#define LINEAR .strength = 4e8, .opening = 1.7e-7, .separation = 1.7e-7

const rg_cohesive input_laws[INPUT_LAWS] = {
    {LINEAR, .beta = 1},
    {LINEAR, .beta = 0},
    {LINEAR, .beta = 2, .activation = RG_ACTIVATION_TOTAL},
    {LINEAR, .beta = 0.5, .contact = RG_CONTACT_FLUX},
    {LINEAR, .beta = 0, .activation = RG_ACTIVATION_TOTAL, .contact = RG_CONTACT_FLUX},
    {LINEAR, .beta = 2, .activation = RG_ACTIVATION_TOTAL, .contact = RG_CONTACT_FLUX},
    {LINEAR, .beta = 1.5, .contact = RG_CONTACT_FLUX},
    {LINEAR, .beta = 1, .contact = RG_CONTACT_LINEAR},
    {LINEAR, .beta = 1, .contact = RG_CONTACT_POTENTIAL},
    {LINEAR, .beta = 0, .contact = RG_CONTACT_POTENTIAL},
};

void input_for_each_case(void (*test)(const rg_kernels *set, input_kind kind, rg_cohesive law)) {
    const rg_kernels *sets[INPUT_SETS];
    int n = input_sets(sets, INPUT_SETS);
    for (int k = 0; k < n; k++)
        for (int kind = 0; kind < 2; kind++)
            for (int law = 0; law < INPUT_LAWS; law++)
                test(sets[k], (input_kind)kind, input_laws[law]);
}

int input_sets(const rg_kernels *sets[], int capacity) {
    int n = rg_kernels_available(sets, capacity - 1);
    for (int k = 0; k < n; k++)
        if (sets[k] == &rg_kernels_reference)
            return n;
    sets[n] = &rg_kernels_reference;
    return n + 1;
}
