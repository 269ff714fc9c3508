/* Sides of a body drawn at random that are tied to rigid bodies which turn: where their nodes go, what they
 * take from the bodies, and what the others follow, from rotations and masses written anew. On any number of
 * ranks; prints TAP from rank 0. */
#include "solver/tie.h"

#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "domain/element.h"
#include "reference/reference.h"
#include "support/near.h"
#include "support/random_state.h"
#include "support/tap_memory.h"

enum { SEED = 37 };
static const double TIME = 1.5e-7, DT_LAST = 2e-9, DT = 3e-9;

/* The free one turns fast, about an axis that is none of its own. */
static const char bodies[] =
    "bodies=[{name: free, shape: none, motion: free, at: [1.1e-3, 0.2e-3, 4.4e-3], mass: 3e-6, inertia: "
    "[2e-12, "
    "3e-12, 4e-12, 0.3e-12, -0.2e-12, 0.1e-12], velocity: {x: 5, z: -2}, spin: {x: 2e5, y: -3e5, z: 1e5}, "
    "tied: "
    "[z+]%s}, {name: given, shape: none, motion: prescribed, at: [0.5e-3, 0, 1e-3], velocity: {y: 3 + "
    "2e7*t}, spin: {x: 1e5, z: 4e12*t}, tied: [z-]%s}]";

/* ---- The sides and elements ---- */

static unsigned nodes_at(const random_state *r, rg_gid e, int body) {
    double x[4][3], top = r->input->mesh.origin[2] + (body == 0 ? r->input->mesh.size[2] : 0);
    unsigned mask = 0;
    mesh_corners(r->mesh, e, x);
    for (int f = 0; f < RG_FACES; f++) {
        bool on = r->mesh->neighbour[4 * e + f] < 0;
        for (int i = 0; i < 3; i++) {
            on = on && fabs(x[rg_face_node[f][i]][2] - top) < 1e-9;
        }
        for (int a = 0; on && a < RG_FNODES; a++) {
            mask |= 1u << rg_face_node[f][a];
        }
    }
    return mask;
}

/* ---- Where bodies put a place ---- */

/* Rotation by a unit quaternion (scalar first), as a matrix. */
static void rotate(const double q[4], const double a[3], double out[3]) {
    double w = q[0], x = q[1], y = q[2], z = q[3];
    const double R[3][3] = {{w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)},
                            {2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)},
                            {2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z}};
    for (int i = 0; i < 3; i++) {
        out[i] = rg_reference_dot(R[i], a);
    }
}

/* A body before or after the step. */
typedef struct {
    double x[3], rotation[4], v[3], momentum[3];
} motion;

static motion motion_of(const rg_body *b) {
    motion m;
    memcpy(m.x, b->x, sizeof m.x);
    memcpy(m.rotation, b->turn.rotation, sizeof m.rotation);
    memcpy(m.v, b->v, sizeof m.v);
    memcpy(m.momentum, b->turn.momentum, sizeof m.momentum);
    return m;
}

static void place_of(const rg_body *b, const motion *m, const double X[3], double out[3]) {
    double arm[3];
    for (int c = 0; c < 3; c++) {
        arm[c] = X[c] - b->input->at[c];
    }
    rotate(m->rotation, arm, out);
    for (int c = 0; c < 3; c++) {
        out[c] += m->x[c];
    }
}

/* Where a place goes that a body takes with it. */
static void carry(const motion *before, const motion *after, const double from[3], double to[3]) {
    const double *q = before->rotation, back[4] = {q[0], -q[1], -q[2], -q[3]};
    double arm[3], seen[3];
    for (int c = 0; c < 3; c++) {
        arm[c] = from[c] - before->x[c];
    }
    rotate(back, arm, seen);
    rotate(after->rotation, seen, to);
    for (int c = 0; c < 3; c++) {
        to[c] += after->x[c];
    }
}

/* ---- A step ---- */

typedef struct {
    bool late; /* whether nodes are tied where they were when it began */
    motion before[2], after[2];
    rg_real *u, *given, *now; /* places; velocities before the bodies have acted */
} step;

static step take(rg_solver *s, double time, bool late) {
    step of = {.late = late,
               .u = copy_field(s, s->u),
               .given = copy_field(s, s->velocity),
               .now = copy_field(s, s->step_velocity)};
    rg_bodies *b = s->bodies;
    for (int i = 0; i < 2; i++) {
        of.before[i] = motion_of(&b->body[i]);
    }
    for (size_t t = 0; t < s->domain->tiles; t++) {
        rg_ties_gather(s->ties, t, time, s->u, s->velocity, late ? s->step_velocity : NULL);
    }
    rg_ties_close(s->ties, time);
    rg_bodies_sum(b);
    rg_bodies_kick(b, time, DT_LAST, DT);
    for (size_t t = 0; t < s->domain->tiles; t++) {
        rg_ties_kick(s->ties, t, time, DT_LAST, DT, s->velocity, s->step_velocity);
        rg_ties_drift(s->ties, t, time, DT, s->u);
    }
    rg_bodies_drift(b, DT);
    for (int i = 0; i < 2; i++) {
        of.after[i] = motion_of(&b->body[i]);
    }
    return of;
}

static void forget(step *of) {
    rg_free(of->u);
    rg_free(of->given);
    rg_free(of->now);
}

typedef struct {
    bool placed, chords, follow, seen;
    double impulse[2][3], angular[2][3]; /* of the solid, from each body; about its centre */
} verdict;

static void judge_node(const random_state *r, const step *of, size_t slot, int n, int body, double J[3],
                       verdict *v) {
    const rg_solver *s = r->solver;
    rg_gid e = s->domain->id[slot];
    double X[3], from[3], to[3], arm[3], turn[3];
    const rg_body *b = &s->bodies->body[body];
    mesh_node(r->mesh, e, n, X);
    if (of->late) {
        for (int c = 0; c < 3; c++) {
            from[c] = X[c] + of->u[rg_node_index(slot, n, c)];
        }
        carry(&of->before[body], &of->after[body], from, to);
    } else {
        place_of(b, &of->before[body], X, from);
        place_of(b, &of->after[body], X, to);
    }
    for (int c = 0; c < 3; c++) {
        size_t at = rg_node_index(slot, n, c);
        v->placed = near(X[c] + s->u[at], to[c], 3e-18) && v->placed;
        v->chords = near(s->velocity[at], (to[c] - from[c]) / DT, 2e-9) && v->chords;
        arm[c] = from[c] - of->before[body].x[c];
        v->impulse[body][c] += J[c];
    }
    rg_reference_cross(arm, J, turn);
    for (int c = 0; c < 3; c++) {
        v->angular[body][c] += turn[c];
    }
}

static void judge_element(const random_state *r, const step *of, size_t slot, verdict *v) {
    const rg_solver *s = r->solver;
    rg_gid e = s->domain->id[slot];
    unsigned tied[2] = {nodes_at(r, e, 0), nodes_at(r, e, 1)};
    double scale = 100 * mesh_mass(r, e), share = DT_LAST / (DT_LAST + DT);
    for (int n = 0; n < RG_NODES; n++) {
        double J[3] = {0, 0, 0};
        for (int k = 0; k < 3 * RG_NODES; k++) {
            size_t at = rg_node_index(slot, k / 3, k % 3);
            J[k % 3] += mesh_mass(r, e) * rg_mass_entry(r->input->mass, n, k / 3) *
                        ((double)s->velocity[at] - of->given[at]);
        }
        int body = (tied[0] >> n & 1) != 0 ? 0 : (tied[1] >> n & 1) != 0 ? 1 : -1;
        if (body >= 0) {
            judge_node(r, of, slot, n, body, J, v);
        }
        for (int c = 0; c < 3; c++) {
            size_t at = rg_node_index(slot, n, c);
            v->follow = (body >= 0 || near(J[c], 0, 1e-14 * scale)) && v->follow;
            v->seen = near((double)s->step_velocity[at] - of->now[at],
                           share * ((double)s->velocity[at] - of->given[at]), 1e-11) &&
                      v->seen;
        }
    }
}

static verdict judge(const random_state *r, const step *of) {
    const rg_domain *d = r->solver->domain;
    verdict v = {.placed = true, .chords = true, .follow = true, .seen = true};
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        if (d->id[slot] >= 0) {
            judge_element(r, of, slot, &v);
        }
    }
    MPI_Allreduce(MPI_IN_PLACE, v.impulse, 12, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    return v;
}

/* What the free body has lost, the solid has gained; of the prescribed one it is the force and moment. */
static void check_momenta(const rg_bodies *b, const step *of, const verdict *v) {
    const rg_body *freely = &b->body[0], *given = &b->body[1];
    double h = 0.5 * (DT_LAST + DT), size[2] = {0, 0};
    bool linear = true, angular = true, prescribed = true;
    for (int c = 0; c < 3; c++) {
        size[0] += fabs(v->impulse[0][c]) + fabs(v->impulse[1][c]);
        size[1] += fabs(v->angular[0][c]) + fabs(v->angular[1][c]);
    }
    for (int c = 0; c < 3; c++) {
        linear = near(freely->mass * (of->before[0].v[c] - of->after[0].v[c]), v->impulse[0][c],
                      1e-13 * size[0]) &&
                 linear;
        angular =
            near(of->before[0].momentum[c] - of->after[0].momentum[c], v->angular[0][c], 1e-13 * size[1]) &&
            angular;
        prescribed = near(given->seen.force[c] * h, -v->impulse[1][c], 1e-13 * size[0]) &&
                     near(given->turn.moment[c] * h, -v->angular[1][c], 1e-13 * size[1]) && prescribed;
    }
    double turn[4], rotation[4];
    bool consistent = true;
    rg_inertia_free(&freely->inertia, of->before[0].rotation, of->after[0].momentum, DT, turn);
    rg_rotation_join(turn, of->before[0].rotation, rotation);
    for (int c = 0; c < 4; c++) {
        consistent = near(of->after[0].rotation[c], rotation[c], 1e-15) && consistent;
    }
    bool seen = true;
    for (int c = 0; c < 3; c++) { /* 0.4 h of a kick h is over at its time */
        double kick[2] = {of->after[0].v[c] - of->before[0].v[c],
                          of->after[0].momentum[c] - of->before[0].momentum[c]};
        seen =
            near(freely->seen.force[c] * h, freely->mass * kick[0], 1e-13 * size[0]) &&
            near(freely->turn.moment[c] * h, kick[1], 1e-13 * size[1]) &&
            near(freely->seen.v[c], of->before[0].v[c] + 0.4 * kick[0], 1e-11) &&
            near(freely->turn.seen_momentum[c], of->before[0].momentum[c] + 0.4 * kick[1], 1e-13 * size[1]) &&
            seen;
    }
    report(seen, "ties", "force, moment and motion of a free body at the time of the step");
    report(consistent, "ties", "the turn of a free body is that of its momentum");
    report(linear, "ties", "momentum of a free body and the solid");
    report(angular, "ties", "angular momentum about its centre");
    report(prescribed, "ties", "force and moment on a prescribed one");
}

/* At the start nodes are where the bodies are, and move with them. */
static bool starts_well(const random_state *r) {
    const rg_solver *s = r->solver;
    bool good = true;
    rg_ties_start(s->ties, s->u, s->velocity);
    for (size_t k = 0; k < RG_NODES * s->domain->blocks * RG_LANES; k++) {
        rg_gid e = s->domain->id[k / RG_NODES];
        int n = (int)(k % RG_NODES);
        for (int i = 0; e >= 0 && i < 2; i++) {
            const rg_body *b = &s->bodies->body[i];
            double X[3], arm[3], turn[3];
            const double spin[2][3] = {{2e5, -3e5, 1e5}, {1e5, 0, 0}}, v[2][3] = {{5, 0, -2}, {0, 3, 0}};
            mesh_node(r->mesh, e, n, X);
            for (int c = 0; c < 3; c++) {
                arm[c] = X[c] - b->input->at[c];
            }
            rg_reference_cross(spin[i], arm, turn);
            for (int c = 0; c < 3 && (nodes_at(r, e, i) >> n & 1) != 0; c++) {
                size_t at = rg_node_index(k / RG_NODES, n, c);
                good = near(s->u[at], 0, 1e-18) && near(s->velocity[at], v[i][c] + turn[c], 1e-11) && good;
            }
        }
    }
    return good;
}

static bool turns_alone(rg_solver *s) {
    step of = take(s, 1.3e-7, true);
    bool good = true;
    for (size_t i = 0; i < s->domain->blocks * RG_NODE_BLOCK; i++) {
        good =
            s->u[i] == of.u[i] && s->velocity[i] == of.given[i] && s->step_velocity[i] == of.now[i] && good;
    }
    for (int i = 0; i < 2; i++) {
        good = of.before[i].rotation[0] == 1 && of.after[i].rotation[0] < 1 && good;
    }
    forget(&of);
    return good;
}

static void check(const char *mass, bool late) {
    char both[sizeof bodies + 40], words[2][80], wanted[2][80];
    const char *from = late ? ", tied_from: 1.4e-7" : "";
    snprintf(both, sizeof both, bodies, from, from);
    for (int i = 0; i < 2; i++) {
        snprintf(wanted[i], sizeof wanted[i], "1.87e-06 m2, 12 faces of %s%s", i == 0 ? "steel" : "glass",
                 late ? " from 1.4e-07 s on" : "");
    }
    const char *change[] = {both, "boundary=[]", mass}, *name = late ? "later" : mass;
    random_state r = random_state_make(3, change, MPI_COMM_WORLD);
    rg_solver *s = r.solver;
    if (late) {
        random_state_draw(&r, SEED);
        report(turns_alone(s), name, "until then the bodies turn and nothing else moves");
    } else {
        report(starts_well(&r), name, "at the start");
    }
    for (int i = 0; i < 2; i++) {
        rg_ties_describe(s->ties, i, words[i], sizeof words[i]);
    }
    report(strcmp(words[0], wanted[0]) == 0 && strcmp(words[1], wanted[1]) == 0 && rg_ties_any(s->ties), name,
           "words");
    report(!rg_ties_due(s->ties, 1.3e-7) && rg_ties_due(s->ties, 1.4e-7) == late, name, "when");
    for (int pass = 0; pass < 3; pass++) { /* the first one finds the bodies as they were */
        for (size_t i = 0; i < s->domain->blocks * RG_NODE_BLOCK; i++) {
            s->velocity[i] = (rg_real)(0.9 * s->velocity[i] + 3);
        }
        step of = take(s, TIME, late);
        verdict v = judge(&r, &of);
        report(v.placed, name, "nodes are where the bodies put them");
        report(v.chords, name, "velocities are chords");
        report(v.follow, name, "impulses on tied nodes alone");
        report(v.seen, name, "velocities at the time of the step");
        check_momenta(s->bodies, &of, &v);
        forget(&of);
    }
    report(!rg_ties_due(s->ties, TIME), name, "once");
    random_state_free(&r);
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    check("mass=consistent", false);
    check("mass=lumped", false);
    check("mass=consistent", true);
    return finish_with_nothing_left();
}
