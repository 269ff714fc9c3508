#include "case/read.h"
#include "solver/fields.h"
#include "solver/setup.h"
#include "solver/step.h"
#include "support/random_state.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "base/mem.h"
#include "domain/element.h"
#include "partition/material_map.h"
#include "reference/reference.h"
#include "solver/tile.h"
#include "solver/stepper.h"

enum { TILE = 16 };

static const char text[] =
    "mesh: {cells: [2, 3, 4], size: [1.1e-3, 1.7e-3, 2.9e-3], origin: [0.3e-3, -0.7e-3, 1.1e-3], jitter: "
    "0.12, "
    "seed: 5}\n"
    "material: {name: glass, model: neo-hookean, young: 70e9, poisson: 0.21, density: 2500}\n"
    "materials:\n"
    "  - {name: steel, where: \"x + z > 3.1e-3\", model: j2, young: 210e9, poisson: 0.3, density: 7800,\n"
    "     yield_stress: 1e9, hardening: 2e9}\n"
    "interface: {law: linear, strength: 400e6, energy: 34, friction: 0.3}\n"
    "viscosity: {linear: 0.06}\n"
    "boundary:\n"
    "  - {set: z+, component: z, velocity: 6}\n"
    "  - {set: x-, component: y, displacement: 1e-6}\n"
    "bodies:\n"
    "  - {name: ball, shape: sphere, motion: free, at: [0.8e-3, 0.1e-3, 0.05e-3], radius: 1e-3, density: "
    "5000}\n"
    "  - {name: wall, shape: plane, motion: prescribed, at: [0, 0, 9e-3], normal: [0, 0, -1]}\n"
    "time: {end: 1e-6}\n"
    "output: {interval: 1e-7, probes: [{name: p, at: [0.7e-3, 0.2e-3, 2.3e-3]}]}\n"
    "checkpoint: {steps: 10}\n";

random_state random_state_make(int changes, const char *const change[], MPI_Comm comm) {
    random_state r = {.input = rg_case_read_text("random.yaml", text, strlen(text), changes, change, stderr)};
    int rank;
    MPI_Comm_rank(comm, &rank);
    if (r.input == NULL) {
        abort();
    }
    r.mesh = rg_mesh_box(r.input->mesh.cells, r.input->mesh.origin, r.input->mesh.size, r.input->mesh.jitter,
                         r.input->mesh.seed);
    rg_part *part = rg_part_distribute(rank == 0 ? r.mesh : NULL, rank == 0 ? TILE : 0, comm);
    rg_materials_assign(r.input, part, comm);
    r.solver = rg_solver_make_from_part(r.input, part, comm);
    return r;
}

void random_state_free(random_state *r) {
    rg_solver_free(r->solver);
    rg_mesh_free(r->mesh);
    rg_case_free(r->input);
}

double drawn(uint64_t seed, draw_kind kind, int64_t of, int64_t number) {
    uint64_t h = rg_hash(rg_hash(seed, (uint64_t)kind), (uint64_t)of);
    return 2 * rg_hash_uniform(rg_hash(h, (uint64_t)number)) - 1;
}

/* ---- values ---- */

/* In a precision that both builds have. */
static double narrow(double x) {
    return (double)(rg_real)x;
}

double drawn_u(uint64_t seed, rg_gid id, int node, int component) {
    return narrow(8e-6 * drawn(seed, DRAW_U, id, 3 * node + component) + (component == 1 ? 3e-5 : 0));
}

double drawn_velocity(uint64_t seed, rg_gid id, int node, int component) {
    return narrow(20 * drawn(seed, DRAW_VELOCITY, id, 3 * node + component));
}

double drawn_now(uint64_t seed, rg_gid id, int node, int component) {
    return narrow(20 * drawn(seed, DRAW_NOW, id, 3 * node + component) + 5 * component - 7);
}

/* Histories end with the six components of the plastic flow; what stands before them is not negative. */
double drawn_history(uint64_t seed, rg_gid id, int values, int row) {
    double x = drawn(seed, DRAW_HISTORY, id, row);
    if (row >= RG_GAUSS * values) {
        return narrow(1e-5 * (1.5 + x)); /* set free (J) */
    }
    return narrow(row % values < values - 6 ? 0.02 * (1.1 + x) : 2e-3 * x);
}

double drawn_heat(uint64_t seed, rg_gid id) {
    return 1e-6 * (1.2 + drawn(seed, DRAW_HEAT, id, 0));
}

/* Of four faces one is whole, one has failed, one is held by a point, one has broken points at random. */
static int kind_of(uint64_t seed, rg_gid face) {
    double x = drawn(seed, DRAW_BITS, face, 0);
    return seed >= RANDOM_DEBRIS && x < 0.6 ? 1 : (int)(2 * (x + 1));
}

uint8_t drawn_broken(uint64_t seed, rg_gid face) {
    uint8_t all = (1 << RG_POINTS) - 1;
    int kind = kind_of(seed, face);
    return kind == 0 ? 0 : kind < 3 ? all : (uint8_t)(32 * (drawn(seed, DRAW_BITS, face, 1) + 1));
}

double drawn_damage(uint64_t seed, rg_gid face, int point) {
    double x = drawn(seed, DRAW_DAMAGE, face, point);
    int held = (int)(3 * (drawn(seed, DRAW_BITS, face, 2) + 1));
    bool failed = kind_of(seed, face) < 3 ? kind_of(seed, face) == 1 || point != held : x > 0.4;
    return failed ? 1.4 + 0.3 * x : 0.5 + 0.45 * x;
}

double drawn_time(uint64_t seed, rg_gid face, int point) {
    return narrow(1e-7 * (3 + drawn(seed, DRAW_TIME, face, point)));
}

double drawn_friction(uint64_t seed, rg_gid face, int point, int k) {
    double x = drawn(seed, DRAW_FRICTION, face, RG_FRICTION * point + k);
    return narrow(k == RG_FRICTION_HEAT ? 1e-7 * (1.1 + x) : 1e-8 * x);
}

/* ---- into the solver ---- */

rg_gid face_key(const rg_mesh *mesh, rg_gid id, int face) {
    rg_gid other = mesh->neighbour[4 * id + face];
    if (other < 0) {
        return -1;
    }
    return id < other ? 4 * id + face : 4 * other + mesh->face[4 * id + face];
}

rg_gid interface_key(const random_state *r, const rg_tile *t, size_t i) {
    const rg_domain *d = r->solver->domain;
    int32_t link = d->side[0][i];
    return face_key(r->mesh, d->id[t->begin * RG_LANES + (size_t)link / RG_FACES], link % RG_FACES);
}

static void draw_element(rg_solver *s, size_t slot, uint64_t seed) {
    rg_gid id = s->domain->id[slot];
    for (int k = 0; k < 3 * RG_NODES; k++) {
        size_t at = rg_node_index(slot, k / 3, k % 3);
        s->u[at] = (rg_real)drawn_u(seed, id, k / 3, k % 3);
        s->step_velocity[at] = (rg_real)drawn_now(seed, id, k / 3, k % 3);
        s->velocity[at] = (rg_real)drawn_velocity(seed, id, k / 3, k % 3);
    }
    int values = rg_material_history(rg_material_of(s, slot)->model), rows = (int)rg_history_rows(values);
    for (int row = 0; row < rows; row++) {
        s->history[rg_history_index(slot, s->model->history_stride, (size_t)row)] =
            (rg_real)drawn_history(seed, id, values, row);
    }
    if (s->heat != NULL) {
        s->heat[slot] = drawn_heat(seed, id);
    }
}

static void draw_interface(rg_solver *s, size_t i, rg_gid face, uint64_t seed) {
    s->broken[i] = drawn_broken(seed, face);
    s->unlinked[i] = s->broken[i] & (uint8_t)(32 * (drawn(seed, DRAW_UNLINKED, face, 0) + 1));
    for (int q = 0; q < RG_POINTS; q++) {
        *rg_crack_value(s, i, q, RG_CRACK_OPENING) =
            (rg_real)(drawn_damage(seed, face, q) * rg_separation(s, i, q));
        *rg_crack_value(s, i, q, RG_CRACK_GIVEN) =
            (rg_real)(drawn(seed, DRAW_GIVEN, face, q) * rg_separation(s, i, q));
        for (int c = 0; c < 3; c++) {
            *rg_crack_value(s, i, q, RG_CRACK_ORIGIN + c) =
                (rg_real)(1e-8 * drawn(seed, DRAW_ORIGIN, face, 3 * q + c));
        }
        *rg_crack_value(s, i, q, RG_CRACK_TIME) = (rg_real)drawn_time(seed, face, q);
        for (int k = 0; k < RG_FRICTION && s->model->law.sliding == RG_SLIDING_COULOMB; k++) {
            *rg_friction_value(s, i, q, k) = (rg_real)drawn_friction(seed, face, q, k);
        }
    }
}

/* Values of lists, bodies and the run itself, through the registry. */
static void draw_registered(rg_solver *s, uint64_t seed) {
    rg_state state = {0};
    rg_state_of_solver(&state, s);
    for (int k = 0; k < state.arrays; k++) {
        const rg_state_array *a = &state.array[k];
        double row[256];
        bool body = strcmp(a->name, "bodies") == 0;
        for (size_t i = 0; (a->of == RG_OF_LIST || body) && i < a->records; i++) {
            int64_t of = body ? (int64_t)i : a->key[i];
            for (int n = 0; n < a->count; n++) {
                double x = drawn(seed, body ? DRAW_BODY : DRAW_CONSTRAINT, of, n);
                /* a body begins with its place: not far from where it was, so that the ball touches */
                bool begins = body && n < 3;
                row[n] = begins ? s->bodies->body[i].input->at[n] + 5e-5 * (1.5 + x) : body ? x : 1e-3 * x;
            }
            rg_state_put(a, i, row);
        }
    }
    s->time = 1e-7 * (2 + drawn(seed, DRAW_RUN, 0, 0));
    s->dt = 1e-9 * (2 + drawn(seed, DRAW_RUN, 0, 1));
    s->dt_next = 0.8 * s->dt;
    s->step = 123 + (int64_t)(50 * drawn(seed, DRAW_RUN, 0, 2));
    s->stiffening_anywhere = 1.5 + drawn(seed, DRAW_RUN, 0, 3);
    s->opening_rate = 1.5 + drawn(seed, DRAW_RUN, 0, 4);
    s->omega2 = 1e17 * (1.5 + drawn(seed, DRAW_RUN, 0, 5));
    s->limiting = 60 + (int64_t)(50 * drawn(seed, DRAW_RUN, 0, 6));
    s->damping = 0.1 * (1.5 + drawn(seed, DRAW_RUN, 0, 7));
}

void random_state_draw(random_state *r, uint64_t seed) {
    rg_solver *s = r->solver;
    const rg_domain *d = s->domain;
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        if (d->id[slot] >= 0) {
            draw_element(s, slot, seed);
        }
    }
    for (size_t t = 0; t < d->tiles; t++) {
        for (size_t i = d->tile[t].ibegin * RG_LANES; i < d->tile[t].iend * RG_LANES; i++) {
            double normal[3];
            if (rg_interface_area(d, i, normal) > 0) {
                draw_interface(s, i, interface_key(r, &d->tile[t], i), seed);
            }
        }
    }
    draw_registered(s, seed);
    rg_solver_resume(s);
    rg_halo_finish(s->stepper->halo_u[s->stepper->current]);
}

/* ---- the whole mesh ---- */

void mesh_corners(const rg_mesh *mesh, rg_gid id, double x[4][3]) {
    for (int k = 0; k < 4; k++) {
        memcpy(x[k], mesh->x + 3 * mesh->corner[4 * id + k], sizeof x[k]);
    }
}

rg_real *copy_field(const rg_solver *s, const rg_real *from) {
    size_t values = s->domain->blocks * RG_NODE_BLOCK;
    rg_real *to = RG_NEW(rg_real, values);
    memcpy(to, from, values * sizeof *to);
    return to;
}

void mesh_node(const rg_mesh *mesh, rg_gid id, int n, double at[3]) {
    static const int end[RG_NODES][2] = {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {0, 1},
                                         {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
    double x[4][3];
    mesh_corners(mesh, id, x);
    for (int c = 0; c < 3; c++) {
        at[c] = 0.5 * (x[end[n][0]][c] + x[end[n][1]][c]);
    }
}

double tet_volume(double x[4][3]) {
    double e[3][3], cross[3];
    for (int k = 0; k < 9; k++) {
        e[k / 3][k % 3] = x[k / 3 + 1][k % 3] - x[0][k % 3];
    }
    rg_reference_cross(e[1], e[2], cross);
    return fabs(rg_reference_dot(e[0], cross)) / 6;
}

double mesh_mass(const random_state *r, rg_gid id) {
    double x[4][3];
    mesh_corners(r->mesh, id, x);
    return r->solver->model->material[mesh_material(r, id)].density * tet_volume(x);
}

int mesh_material(const random_state *r, rg_gid id) {
    double x[4][3], middle[3];
    mesh_corners(r->mesh, id, x);
    for (int c = 0; c < 3; c++) {
        middle[c] = 0.25 * (x[0][c] + x[1][c] + x[2][c] + x[3][c]);
    }
    int last = r->input->others; /* that claims it */
    while (last > 0 && rg_expr_value(r->input->other[last - 1].where, middle, 0) == 0) {
        last--;
    }
    return last;
}
