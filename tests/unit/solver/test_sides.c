/* What happens to the velocities of elements at sides that are held or that absorb, on a state drawn at
 * random: targets are met, by impulses along the lines that are held and no others; dashpots act by the mean
 * velocity, implicitly; all work is booked. Mass matrices, faces and values are written anew. On any number
 * of ranks; prints TAP from rank 0. */
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "domain/element.h"
#include "partition/material.h"
#include "reference/reference.h"
#include "solver/absorbing.h"
#include "solver/constraint.h"
#include "solver/fields.h"
#include "support/near.h"
#include "support/random_state.h"
#include "support/tap_memory.h"

enum { SEED = 31 };
static const double TIME = 1.5e-7, DT_LAST = 2e-9, DT = 3e-9;

/* ---- The sides of the box ---- */

/* Which side a face of the mesh is on: 0 to 5 for x-, x+, y-, y+, z-, z+; -1 inside. */
static int side_of(const random_state *r, rg_gid e, int face) {
    double x[4][3];
    if (r->mesh->neighbour[4 * e + face] >= 0) {
        return -1;
    }
    mesh_corners(r->mesh, e, x);
    for (int k = 0; k < 6; k++) {
        double at = r->input->mesh.origin[k / 2] + (k % 2) * r->input->mesh.size[k / 2];
        bool on = true;
        for (int i = 0; i < 3; i++) {
            on = on && fabs(x[rg_face_node[face][i]][k / 2] - at) < 1e-9;
        }
        if (on) {
            return k;
        }
    }
    return -1;
}

static unsigned nodes_on(const random_state *r, rg_gid e, int side) {
    unsigned mask = 0;
    for (int k = 0; k < RG_FACES * RG_FNODES; k++) {
        if (side_of(r, e, k / RG_FNODES) == side) {
            mask |= 1u << rg_face_node[k / RG_FNODES][k % RG_FNODES];
        }
    }
    return mask;
}

/* ---- Prescribed motions ---- */

/* A line along which nodes of a side are held, and the displacement or velocity along it at a place and a
 * time; later rows come first. */
typedef struct {
    int side;
    double line[3];
    bool placed;
    double (*value)(const double x[3], double t, int component);
} support;

static double ramp(const double x[3], double t, int component) {
    (void)component;
    return 6 + 1e3 * x[0] + 4e6 * t;
}

static double shove(const double x[3], double t, int component) {
    (void)component;
    return 1e-6 * (1 + x[2] / 1e-3) + 30 * t * t / 1e-7;
}

static double back(const double x[3], double t, int component) {
    (void)t, (void)component;
    return -4 - 2e3 * x[1];
}

/* (R - I) r + d about the axis (0, 3, 4)/5 through (1, 2, 3) mm; by a matrix. */
static double turn(const double x[3], double t, int component) {
    double a = 2e3 * t, s = sin(a), c = cos(a), n[3] = {0, 0.6, 0.8},
           r[3] = {x[0] - 1e-3, x[1] - 2e-3, x[2] - 3e-3}, moved[3] = {3 * t, 0, 1e-6};
    const double R[3][3] = {{c, -s * n[2], s * n[1]},
                            {s * n[2], c + (1 - c) * n[1] * n[1], (1 - c) * n[1] * n[2]},
                            {-s * n[1], (1 - c) * n[1] * n[2], c + (1 - c) * n[2] * n[2]}};
    return rg_reference_dot(R[component], r) - r[component] + moved[component];
}

typedef struct {
    const char *name, *boundary;
    int count;
    support of[6];
} held_case;

static const held_case held[] = {
    {"axes",
     "boundary=[{name: a, set: z+, component: z, velocity: 6 + 1e3*x + 4e6*t}, "
     "{name: b, set: x-, component: y, displacement: 1e-6*(1 + z/1e-3) + 30*t*t/1e-7}, "
     "{name: c, set: x-, component: z, velocity: -4 - 2e3*y}]",
     3,
     {{5, {0, 0, 1}, false, ramp}, {0, {0, 1, 0}, true, shove}, {0, {0, 0, 1}, false, back}}},
    {"lines",
     "boundary=[{name: a, set: z+, direction: [1, 2, 2], velocity: 6 + 1e3*x + 4e6*t}, "
     "{name: b, where: nx < -0.5, direction: [0, -3, 4], displacement: 1e-6*(1 + z/1e-3) + 30*t*t/1e-7}, "
     "{name: c, set: y+, normal: -4 - 2e3*y}, {name: d, set: y-, normal: 6 + 1e3*x + 4e6*t}]",
     4,
     {{5, {1 / 3., 2 / 3., 2 / 3.}, false, ramp},
      {0, {0, -0.6, 0.8}, true, shove},
      {3, {0, 1, 0}, false, back},
      {2, {0, -1, 0}, false, ramp}}},
    {"a line that two others imply",
     "boundary=[{name: a, set: x-, direction: [0, 0, 2], velocity: -4 - 2e3*y}, "
     "{name: b, set: x-, direction: [1, 0, 0], velocity: 6 + 1e3*x + 4e6*t}, "
     "{name: c, set: z+, direction: [1, 0, 1], velocity: -4 - 2e3*y}]",
     3,
     {{0, {0, 0, 1}, false, back},
      {0, {1, 0, 0}, false, ramp},
      {5, {0.70710678118654752, 0, 0.70710678118654752}, false, back}}},
    {"a rigid side",
     "boundary=[{name: a, set: z+, direction: [1, 2, 2], velocity: 6 + 1e3*x + 4e6*t}, "
     "{name: b, set: x+, angle: 2e3*t, axis: [0, 3, 4], at: [1e-3, 2e-3, 3e-3], translation: {x: 3*t, "
     "z: 1e-6}}]",
     4,
     {{5, {1 / 3., 2 / 3., 2 / 3.}, false, ramp},
      {1, {1, 0, 0}, true, turn},
      {1, {0, 1, 0}, true, turn},
      {1, {0, 0, 1}, true, turn}}},
    {"turns",
     "boundary=[{name: a, set: z+, component: z, velocity: 6 + 1e3*x + 4e6*t, from: 1.4e-7}, "
     "{name: b, set: z+, component: z, velocity: -4, until: 1.4e-7}, "
     "{name: c, set: y-, component: y, velocity: 7, from: 1.6e-7}, "
     "{name: d, set: x-, component: x, velocity: -4 - 2e3*y, until: 1.6e-7}]",
     2,
     {{5, {0, 0, 1}, false, ramp}, {0, {1, 0, 0}, false, back}}},
};

/* An orthonormal basis of the lines along which a node is held, and the value of each row that gave one. */
typedef struct {
    int lines;
    double base[3][3];
    const support *of[3];
} holding;

static holding hold(const random_state *r, const held_case *c, rg_gid e, int n) {
    holding h = {0};
    for (int k = c->count - 1; k >= 0; k--) {
        double rest[3];
        memcpy(rest, c->of[k].line, sizeof rest);
        for (int i = 0; i < h.lines; i++) {
            double along = rg_reference_dot(h.base[i], rest);
            for (int d = 0; d < 3; d++) {
                rest[d] -= along * h.base[i][d];
            }
        }
        double length = sqrt(rg_reference_dot(rest, rest));
        if ((nodes_on(r, e, c->of[k].side) >> n & 1) != 0 && h.lines < 3 && length > 1e-6) {
            for (int d = 0; d < 3; d++) {
                h.base[h.lines][d] = rest[d] / length;
            }
            h.of[h.lines++] = &c->of[k];
        }
    }
    return h;
}

static double along(const double line[3], const rg_real *field, size_t slot, int n) {
    double sum = 0;
    for (int d = 0; d < 3; d++) {
        sum += line[d] * field[rg_node_index(slot, n, d)];
    }
    return sum;
}

/* Velocity after the kick, or at its time. */
static double target(const support *s, const double x[3], bool now, double displacement) {
    int c = s->line[1] == 1 ? 1 : s->line[2] == 1 ? 2 : 0;
    if (s->placed) {
        return now ? (s->value(x, TIME + 0.5 * DT, c) - s->value(x, TIME - 0.5 * DT, c)) / DT
                   : (s->value(x, TIME + DT, c) - displacement) / DT;
    }
    return s->value(x, now ? TIME : TIME + 0.5 * DT, c);
}

/* M (after - before) of an element (N s). */
static void impulses(const random_state *r, rg_gid e, size_t slot, const rg_real *before,
                     const rg_real *after, double out[RG_NODES][3]) {
    for (int k = 0; k < 3 * RG_NODES; k++) {
        out[k / 3][k % 3] = 0;
        for (int b = 0; b < RG_NODES; b++) {
            size_t at = rg_node_index(slot, b, k % 3);
            out[k / 3][k % 3] +=
                mesh_mass(r, e) * rg_mass_entry(r->input->mass, k / 3, b) * ((double)after[at] - before[at]);
        }
    }
}

typedef struct {
    rg_real *before, *kicked, *now, *u; /* copies of the fields: v(n-1/2), and what the kick was given */
} fields;

/* The state is that before the kick: its velocities, then, are other ones. */
static fields kick_drawn(rg_solver *s) {
    fields f = {copy_field(s, s->velocity), NULL, copy_field(s, s->step_velocity), copy_field(s, s->u)};
    for (size_t i = 0; i < s->domain->blocks * RG_NODE_BLOCK; i++) {
        s->velocity[i] = (rg_real)(0.7 * s->velocity[i] - 0.4 * s->step_velocity[i] + 1);
    }
    f.kicked = copy_field(s, s->velocity);
    return f;
}

static void free_fields(fields *f) {
    rg_free(f->before);
    rg_free(f->kicked);
    rg_free(f->now);
    rg_free(f->u);
}

/* Velocities of 20 m/s; impulses of such over an element's mass. */
#define ROUNDED 3e-13

typedef struct {
    bool met, along;
    double work, total[3]; /* J, N s */
} verdict;

/* Of velocities at the time of the kick, or behind it. */
static void judge_element(const random_state *r, const held_case *c, size_t slot, const fields *f, bool now,
                          verdict *v) {
    const rg_real *given = now ? f->now : f->kicked,
                  *found = now ? r->solver->step_velocity : r->solver->velocity;
    rg_gid e = r->solver->domain->id[slot];
    double J[RG_NODES][3], scale = 20 * mesh_mass(r, e);
    impulses(r, e, slot, given, found, J);
    for (int n = 0; n < RG_NODES; n++) {
        holding h = hold(r, c, e, n);
        double x[3];
        mesh_node(r->mesh, e, n, x);
        for (int i = 0; i < h.lines; i++) {
            double wanted = target(h.of[i], x, now, along(h.of[i]->line, f->u, slot, n));
            v->met =
                near(along(h.of[i]->line, found, slot, n), wanted, 100 * ROUNDED * (20 + fabs(wanted))) &&
                v->met;
        }
        double rest[3];
        memcpy(rest, J[n], sizeof rest);
        for (int i = 0; i < h.lines; i++) {
            double part = rg_reference_dot(h.base[i], J[n]);
            for (int d = 0; d < 3; d++) {
                rest[d] -= part * h.base[i][d];
            }
        }
        for (int d = 0; d < 3; d++) {
            size_t at = rg_node_index(slot, n, d);
            v->along = near(rest[d], 0, ROUNDED * scale) && v->along;
            v->work += 0.5 * J[n][d] * ((double)f->before[at] + found[at]);
            v->total[d] += J[n][d];
        }
    }
}

static verdict judge(const random_state *r, const held_case *c, const fields *f, bool now) {
    verdict v = {true, true, 0, {0, 0, 0}};
    for (size_t slot = 0; slot < r->solver->domain->blocks * RG_LANES; slot++) {
        if (r->solver->domain->id[slot] >= 0) {
            judge_element(r, c, slot, f, now, &v);
        }
    }
    MPI_Allreduce(MPI_IN_PLACE, &v.work, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    MPI_Allreduce(MPI_IN_PLACE, v.total, 3, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    return v;
}

/* Forces and works of all named entries together. */
static bool booked(const rg_account *a, const verdict *after) {
    double force[3] = {0, 0, 0}, work = 0;
    for (int i = 0; i < a->count; i++) {
        work += a->item[i].work;
        for (int d = 0; d < 3; d++) {
            force[d] += a->item[i].force[d] * 0.5 * (DT_LAST + DT);
        }
    }
    bool good = near(work, after->work, 1e-12 * fabs(after->work));
    for (int d = 0; d < 3; d++) {
        good = near(force[d], after->total[d],
                    1e-12 * (fabs(after->total[0]) + fabs(after->total[1]) + fabs(after->total[2]))) &&
               good;
    }
    return good;
}

/* What has a place is there after the drift. */
static bool drifted(const random_state *r, const held_case *c) {
    const rg_solver *s = r->solver;
    bool good = true;
    for (size_t i = 0; i < s->domain->blocks * RG_NODE_BLOCK; i++) {
        s->u[i] = (rg_real)(s->u[i] + DT * s->velocity[i]);
    }
    for (size_t t = 0; t < s->domain->tiles; t++) {
        rg_constraints_drift(s->constraints, t, s->u);
    }
    for (size_t k = 0; k < RG_NODES * s->domain->blocks * RG_LANES; k++) {
        rg_gid e = s->domain->id[k / RG_NODES];
        int n = (int)(k % RG_NODES);
        double x[3];
        if (e < 0) {
            continue;
        }
        holding h = hold(r, c, e, n);
        mesh_node(r->mesh, e, n, x);
        for (int i = 0; i < h.lines; i++) {
            int axis = h.of[i]->line[1] == 1 ? 1 : h.of[i]->line[2] == 1 ? 2 : 0;
            good = (!h.of[i]->placed || h.lines > 1 ||
                    near(along(h.of[i]->line, s->u, k / RG_NODES, n), h.of[i]->value(x, TIME + DT, axis),
                         1e-18)) &&
                   good;
        }
    }
    return good;
}

/* No work has been done yet: the state that is drawn has some. */
static void forget_work(rg_solver *s) {
    rg_state state = {0};
    rg_state_of_solver(&state, s);
    for (int k = 0; k < state.arrays; k++) {
        const rg_state_array *a = &state.array[k];
        static const double none[256];
        for (size_t i = 0; a->of == RG_OF_LIST && i < a->records; i++) {
            rg_state_put(a, i, none);
        }
    }
}

static void check_held(const held_case *c, const char *mass) {
    const char *change[] = {c->boundary, mass, "bodies=[]"};
    random_state r = random_state_make(3, change, MPI_COMM_WORLD);
    rg_solver *s = r.solver;
    random_state_draw(&r, SEED);
    forget_work(s);
    rg_constraints_start(s->constraints, s->u, s->velocity, MPI_COMM_WORLD);
    fields f = kick_drawn(s);
    rg_exact_sum work = {0};
    for (int i = 0; i < s->account->count; i++) { /* they have drawn values */
        s->account->item[i] = (rg_account_item){.name = s->account->item[i].name};
    }
    rg_constraints_set(s->constraints, TIME, DT_LAST, DT);
    for (size_t t = 0; t < s->domain->tiles; t++) {
        rg_constraints_kick(s->constraints, t, s->u, s->velocity, s->step_velocity);
    }
    rg_account_close(s->account);
    rg_constraints_work(s->constraints, &work);
    rg_exact_allreduce(&work, 1, MPI_COMM_WORLD);
    verdict now = judge(&r, c, &f, true), after = judge(&r, c, &f, false);
    report(now.met && after.met, c->name, "velocities are those prescribed");
    report(now.along && after.along, c->name, "impulses are along what is held");
    report(near(rg_exact_value(&work), now.work, 1e-12 * fabs(now.work)), c->name, "work up to now");
    report(booked(s->account, &after), c->name, "forces and work are booked");
    report(drifted(&r, c), c->name, "places after the drift");
    free_fields(&f);
    random_state_free(&r);
}

/* Nodes that elements share are held in all of them, also in those that only touch the side: [2] slots. */
typedef struct {
    unsigned *nodes[2];
    bool good;
} shown;

static void show(void *to, size_t slot, int node, const double line[3]) {
    shown *of = to;
    int side = fabs(line[0]) > 0.5;
    const double wanted[3] = {side, side - 1, 0};
    for (int c = 0; c < 3; c++) {
        of->good = near(line[c], wanted[c], 1e-15) && of->good;
    }
    of->good = (of->nodes[side][slot] >> node & 1) == 0 && of->good;
    of->nodes[side][slot] |= 1u << node;
}

static void check_shared(void) {
    const char *change[] = {"interface={law: none, form: continuous}",
                            "boundary=[{set: y-, normal: 3}, {set: x+, normal: 0}]", "bodies=[]"};
    random_state r = random_state_make(3, change, MPI_COMM_WORLD);
    const rg_domain *d = r.solver->domain;
    const double *low = r.input->mesh.origin, *size = r.input->mesh.size;
    shown of = {{RG_NEW(unsigned, d->blocks *RG_LANES), RG_NEW(unsigned, d->blocks *RG_LANES)}, true};
    rg_constraints_set(r.solver->constraints, TIME, DT_LAST, DT);
    rg_constraints_show(r.solver->constraints, show, &of);
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        unsigned wanted[2] = {0, 0};
        for (int n = 0; n < RG_NODES && d->id[slot] >= 0; n++) {
            double x[3];
            mesh_node(r.mesh, d->id[slot], n, x);
            wanted[0] |= fabs(x[1] - low[1]) < 1e-9 ? 1u << n : 0;
            wanted[1] |= fabs(x[0] - low[0] - size[0]) < 1e-9 ? 1u << n : 0;
        }
        of.good = of.nodes[0][slot] == wanted[0] && of.nodes[1][slot] == wanted[1] && of.good;
    }
    report(of.good, "shared nodes", "are held wherever they are, along the mean normal");
    rg_free(of.nodes[0]);
    rg_free(of.nodes[1]);
    random_state_free(&r);
}

static void check_words(void) {
    static const char entries[] =
        "boundary=[{set: z+, component: z, velocity: 6}, {set: y-, normal: 3}, {where: nx < -0.5, direction: "
        "[0, -3, 4], displacement: 1e-6*t}, {set: x+, angle: 2e3*t, axis: [0, 3, 4]}, {set: y+, absorbing: "
        "true}, {set: z-, dashpot: 3e6}]";
    static const char *const words[] = {
        "velocity along z on 1.87e-06 m2, 12 faces of steel",
        "normal on 3.19e-06 m2, 16 faces of glass and steel",
        "displacement along (0, -3, 4) on 4.93e-06 m2, 24 faces of glass and steel",
        "angle on 4.93e-06 m2, 24 faces of glass and steel",
        "absorbing on 3.19e-06 m2, 16 faces of glass and steel",
        "dashpot on 1.87e-06 m2, 12 faces of glass"};
    const char *change[] = {entries, "bodies=[]"};
    random_state r = random_state_make(2, change, MPI_COMM_WORLD);
    bool good = true;
    for (int b = 0; b < 6; b++) {
        char found[200];
        rg_constraints_describe(r.solver->constraints, b, found, sizeof found);
        if (strcmp(found, words[b]) != 0) {
            printf("# %s\n", found);
            good = false;
        }
    }
    report(good, "sides", "are told in words");
    random_state_free(&r);
}

/* ---- Absorbing sides and dashpots ---- */

static const char damps[] = "boundary=[{set: z-, absorbing: true}, {where: nx > 0.5, absorbing: true}, "
                            "{set: x+, dashpot: 3e6}, {set: y-, dashpot: 5e6}]";

/* Impedance of a face (kg/(m2 s)) along its normal and across it. */
static void impedance(const random_state *r, rg_gid e, int side, double z[2]) {
    bool steel = mesh_material(r, e) == 1;
    double E = steel ? 210e9 : 70e9, nu = steel ? 0.3 : 0.21, rho = steel ? 7800 : 2500;
    double dashpot = side == 1 ? 3e6 : side == 2 ? 5e6 : 0;
    bool absorbs = side == 4 || side == 1;
    z[0] = dashpot + (absorbs ? sqrt(rho * E * (1 - nu) / (1 + nu) / (1 - 2 * nu)) : 0);
    z[1] = dashpot + (absorbs ? sqrt(rho * E / 2 / (1 + nu)) : 0);
}

/* C v of an element by a rule of degree 4 (N), v of its nodes. */
static void damping_force(const random_state *r, rg_gid e, double v[RG_NODES][3], double out[RG_NODES][3]) {
    memset(out, 0, RG_NODES * sizeof *out);
    for (int face = 0; face < RG_FACES; face++) {
        double x[4][3], edge[2][3], normal[3], z[2];
        int side = side_of(r, e, face);
        const int *node = rg_face_node[face];
        if (side != 4 && side != 1 && side != 2) {
            continue;
        }
        impedance(r, e, side, z);
        mesh_corners(r->mesh, e, x);
        for (int k = 0; k < 6; k++) {
            edge[k / 3][k % 3] = x[node[k / 3 + 1]][k % 3] - x[node[0]][k % 3];
        }
        rg_reference_cross(edge[0], edge[1], normal);
        double twice = sqrt(rg_reference_dot(normal, normal));
        for (int q = 0; q < RG_POINTS; q++) {
            double l[3], N[RG_FNODES], at[3] = {0, 0, 0}, weight = rg_reference_face_point(q, l) * twice / 2;
            rg_reference_face_shape(l, N);
            for (int k = 0; k < 3 * RG_FNODES; k++) {
                at[k % 3] += N[k / 3] * v[node[k / 3]][k % 3];
            }
            double through = rg_reference_dot(at, normal) / twice;
            for (int k = 0; k < 3 * RG_FNODES; k++) {
                double straight = through * normal[k % 3] / twice;
                out[node[k / 3]][k % 3] +=
                    weight * N[k / 3] * (z[0] * straight + z[1] * (at[k % 3] - straight));
            }
        }
    }
}

/* M (v+ - v') = -h C w, w the mean of v- and v+; step velocities change as far. Adds the work done in the
 * half steps around the kick. */
static bool damped_well(const random_state *r, size_t slot, const fields *f, double work[2]) {
    const rg_solver *s = r->solver;
    rg_gid e = s->domain->id[slot];
    double J[RG_NODES][3], seen[RG_NODES][3], w[RG_NODES][3], force[RG_NODES][3];
    double h = 0.5 * (DT_LAST + DT), scale = ROUNDED * 100 * mesh_mass(r, e);
    bool good = true;
    impulses(r, e, slot, f->kicked, s->velocity, J);
    impulses(r, e, slot, f->now, s->step_velocity, seen);
    for (int k = 0; k < 3 * RG_NODES; k++) {
        size_t at = rg_node_index(slot, k / 3, k % 3);
        w[k / 3][k % 3] = 0.5 * ((double)f->before[at] + s->velocity[at]);
    }
    damping_force(r, e, w, force);
    for (int k = 0; k < 3 * RG_NODES; k++) {
        size_t at = rg_node_index(slot, k / 3, k % 3);
        double F = -force[k / 3][k % 3];
        good = near(J[k / 3][k % 3], h * F, scale) && near(seen[k / 3][k % 3], 0.4 * h * F, scale) && good;
        work[0] += 0.5 * DT_LAST * F * f->before[at];
        work[1] += 0.5 * DT * F * s->velocity[at];
    }
    return good;
}

static void check_damped(const char *mass) {
    const char *change[] = {damps, mass, "bodies=[]"};
    random_state r = random_state_make(3, change, MPI_COMM_WORLD);
    rg_solver *s = r.solver;
    random_state_draw(&r, SEED);
    s->account->item[0] = (rg_account_item){.name = NULL};
    for (size_t t = 0; t < s->domain->tiles; t++) {
        rg_absorbing_note(s->absorbing, t, s->velocity);
    }
    fields f = kick_drawn(s);
    double h = 0.5 * (DT_LAST + DT), work[2] = {0, 0};
    rg_push push = {.dt = h, .dt_now = 0.4 * h, .velocity = s->velocity, .step_velocity = s->step_velocity};
    rg_absorbing_set(s->absorbing, DT_LAST, DT);
    for (size_t t = 0; t < s->domain->tiles; t++) {
        rg_absorbing_damp(s->absorbing, t, &push);
        rg_absorbing_book(s->absorbing, t, s->velocity);
    }
    rg_account_close(s->account);
    bool good = true;
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        good = (s->domain->id[slot] < 0 || damped_well(&r, slot, &f, work)) && good;
    }
    MPI_Allreduce(MPI_IN_PLACE, work, 2, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    report(good, "damped", "by the mean velocity, implicitly");
    report(near(-rg_absorbing_radiated(s->absorbing), work[0], 1e-12 * fabs(work[0])) &&
               near(s->account->item[0].work, work[0] + work[1], 1e-12 * (fabs(work[0]) + fabs(work[1]))),
           "damped", "work is booked");
    free_fields(&f);
    random_state_free(&r);
}

/* Rates (1/s) at which the components of each node's mean velocity are taken away, as found of velocities
 * `before` and `kicked` everywhere and of all matrices diagonal: the sides are along the axes. */
static double *damped_rates(rg_solver *s, double before, double kicked, double h) {
    size_t values = s->domain->blocks * RG_NODE_BLOCK;
    double *rate = RG_NEW(double, values);
    rg_push push = {.dt = h, .dt_now = 0.4 * h, .velocity = s->velocity, .step_velocity = s->step_velocity};
    for (size_t i = 0; i < values; i++) {
        s->velocity[i] = (rg_real)before;
    }
    for (size_t t = 0; t < s->domain->tiles; t++) {
        rg_absorbing_note(s->absorbing, t, s->velocity);
    }
    for (size_t i = 0; i < values; i++) {
        s->velocity[i] = s->step_velocity[i] = (rg_real)kicked;
    }
    rg_absorbing_set(s->absorbing, 2 * h, 0);
    for (size_t t = 0; t < s->domain->tiles; t++) {
        rg_absorbing_damp(s->absorbing, t, &push);
    }
    for (size_t i = 0; i < values; i++) {
        rate[i] = 2 * (kicked - (double)s->velocity[i]) / (h * (before + (double)s->velocity[i]));
    }
    return rate;
}

/* Nodes that elements share are damped by what all their faces take, implicitly: at the same rates whatever
 * the step; all together as the faces. */
static void check_damped_shared(void) {
    const char *change[] = {damps, "interface={law: none, form: continuous}", "bodies=[]"};
    random_state r = random_state_make(3, change, MPI_COMM_WORLD);
    rg_solver *s = r.solver;
    double *rate = damped_rates(s, 3, 5, 1e-8), *other = damped_rates(s, 4, 1, 4e-8);
    double all[3] = {0, 0, 0}, wanted[3] = {0, 0, 0};
    bool same = true;
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        rg_gid e = s->domain->id[slot];
        for (int k = 0; e >= 0 && k < 3 * RG_NODES; k++) {
            size_t at = rg_node_index(slot, k / 3, k % 3);
            same = fabs(rate[at] - other[at]) <= 1e-6 * rate[at] + 10 && same;
            all[k % 3] += mesh_mass(&r, e) * rg_mass_entry(RG_MASS_LUMPED, k / 3, k / 3) * rate[at];
        }
        for (int face = 0; e >= 0 && face < RG_FACES; face++) {
            double z[2], normal[3];
            int side = side_of(&r, e, face);
            for (int c = 0; c < 3 && (side == 1 || side == 2 || side == 4); c++) {
                impedance(&r, e, side, z);
                wanted[c] += rg_surface_area(s->domain->corner + 12 * slot, face, normal) * z[c != side / 2];
            }
        }
    }
    MPI_Allreduce(MPI_IN_PLACE, all, 3, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    MPI_Allreduce(MPI_IN_PLACE, wanted, 3, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    report(same, "damped shared nodes", "at one rate");
    report(near(all[0], wanted[0], 1e-12 * wanted[0]) && near(all[1], wanted[1], 1e-12 * wanted[1]) &&
               near(all[2], wanted[2], 1e-12 * wanted[2]),
           "damped shared nodes", "as their faces");
    rg_free(rate);
    rg_free(other);
    random_state_free(&r);
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    static const char *const mass[] = {"mass=consistent", "mass=lumped"};
    for (int m = 0; m < 2; m++) {
        for (size_t i = 0; i < sizeof held / sizeof *held; i++) {
            check_held(&held[i], mass[m]);
        }
        check_damped(mass[m]);
    }
    check_damped_shared();
    check_shared();
    check_words();
    return finish_with_nothing_left();
}
