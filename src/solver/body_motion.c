/* How rigid bodies move: by the forces of the solid, by what is tied to them, and as prescribed. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "base/dense.h"
#include "base/vector.h"
#include "solver/body.h"

/* ---- What is prescribed ---- */

/* Component c of the velocity (or the angular velocity) that the case gives body i; notes where that is not
 * finite for the first time. */
static double given(rg_bodies *b, int i, bool spin, int c, double time) {
    static const double nowhere[3] = {0, 0, 0};
    const rg_body_input *in = b->body[i].input;
    const rg_expr *e = spin ? in->spin[c] : in->velocity[c];
    double v = e == NULL ? 0 : rg_expr_value(e, nowhere, time);
    if (!isfinite(v) && b->lapse.input == NULL) {
        b->lapse = (rg_body_lapse){in, e, spin ? "spin" : "velocity", c, time};
    }
    return v;
}

/* Angular momentum of a free body at an angular velocity, at the start. */
static void momentum_of(const rg_inertia *b, const double spin[3], double out[3]) {
    for (int c = 0; c < 3; c++) {
        out[c] = 0;
    }
    for (int k = 0; k < 3; k++) {
        double along = b->moment[k] * rg_vector_dot(b->axis[k], spin);
        for (int c = 0; c < 3; c++) {
            out[c] += along * b->axis[k][c];
        }
    }
}

void rg_bodies_begin(rg_bodies *all, int i) {
    rg_body *b = &all->body[i];
    for (int c = 0; c < 3; c++) {
        b->v[c] = given(all, i, false, c, 0);
        b->turn.spin[c] = given(all, i, true, c, 0);
    }
    if (b->turns && b->input->motion == RG_MOTION_FREE) {
        momentum_of(&b->inertia, b->turn.spin, b->turn.momentum);
    }
}

/* ---- With what is tied to it ---- */

void rg_body_arm(const rg_body *b, const double at_start[3], double arm[3]) {
    rg_rotation_turn(b->turn.rotation, at_start, arm);
}

void rg_body_sweep(const rg_body *b, const double arm[3], double moved[3]) {
    rg_rotation_move(b->turn.step, arm, moved);
}

/* Momentum and angular momentum about the centre that tied nodes have, over what they would have without the
 * body, as it moves with v and by its `step` in dt. */
static void tied_impulse(const rg_body *b, const double v[3], double dt, double impulse[3],
                         double angular[3]) {
    const rg_body_tied *t = &b->tied;
    double first[3], moved[3], across[3];
    rg_body_arm(b, t->first, first);
    rg_body_sweep(b, first, moved);
    rg_vector_cross(first, v, angular);
    for (int c = 0; c < 3; c++) {
        impulse[c] = t->mass * v[c] + moved[c] / dt - t->momentum[c];
        angular[c] -= t->angular[c];
    }
    for (int k = 0; k < 3; k++) { /* sum of m (R a) x (R' - R) a, over the axes of the body */
        const double axis[3] = {k == 0, k == 1, k == 2};
        double second[3], turned[3];
        rg_body_arm(b, t->second[k], second);
        rg_body_arm(b, axis, turned);
        rg_body_sweep(b, turned, moved);
        rg_vector_cross(second, moved, across);
        for (int c = 0; c < 3; c++) {
            angular[c] += across[c] / dt;
        }
    }
}

/* In space, at present: the inertia of what is tied to it about its centre. */
static void tied_inertia(const rg_body *b, double out[3][3]) {
    double axis[3][3], trace = 0;
    for (int k = 0; k < 3; k++) {
        const double unit[3] = {k == 0, k == 1, k == 2};
        rg_body_arm(b, unit, axis[k]);
        trace += b->tied.second[k][k];
    }
    for (int n = 0; n < 9; n++) {
        int i = n / 3, j = n % 3;
        double second = 0;
        for (int k = 0; k < 9; k++) {
            second += b->tied.second[k / 3][k % 3] * axis[k / 3][i] * axis[k % 3][j];
        }
        out[i][j] = (i == j ? trace : 0) - second;
    }
}

/* Inverse of the inertia J about a centre, as what has a mass and first moments there answers to moments. */
static void invert_inertia(double mass, const double first[3], double J[3][3], double out[9]) {
    double square = rg_vector_dot(first, first);
    for (int n = 0; n < 9; n++) {
        int i = n / 3, j = n % 3;
        out[n] = J[i][j] - ((i == j ? square : 0) - first[i] * first[j]) / mass;
    }
    rg_dense_invert(3, out);
}

/* The rigid motion of momentum p and angular momentum l about a centre: v and w with m v + w x f = p and
 * f x v + J w = l, f the first moments; by that inverse. */
static void motion_of(double mass, const double first[3], const double inverse[9], const double p[3],
                      const double l[3], double v[3], double spin[3]) {
    double across[3], rest[3];
    rg_vector_cross(first, p, across);
    for (int c = 0; c < 3; c++) {
        rest[c] = l[c] - across[c] / mass;
    }
    for (int c = 0; c < 3; c++) {
        spin[c] = rg_vector_dot(inverse + 3 * c, rest);
    }
    rg_vector_cross(spin, first, across);
    for (int c = 0; c < 3; c++) {
        v[c] = (p[c] - across[c]) / mass;
    }
}

/* In space, at present: the inertia of the body, and that inverse of it with what is tied to it. */
static void inertias(const rg_body *b, double own[3][3], double all[9]) {
    double first[3], tied[3][3];
    memset(own, 0, 9 * sizeof(double));
    for (int k = 0; k < 3; k++) {
        double about[3];
        rg_body_arm(b, b->inertia.axis[k], about);
        for (int n = 0; n < 9; n++) {
            own[n / 3][n % 3] += b->inertia.moment[k] * about[n / 3] * about[n % 3];
        }
    }
    rg_body_arm(b, b->tied.first, first);
    tied_inertia(b, tied);
    for (int n = 0; n < 9; n++) {
        tied[n / 3][n % 3] += own[n / 3][n % 3];
    }
    invert_inertia(b->mass + b->tied.mass, first, tied, all);
}

/* Twice the kinetic energy of what is tied to it, as it moves with v and spin. */
static double tied_energy(const rg_body *b, const double v[3], const double spin[3]) {
    double first[3], inertia[3][3], across[3];
    rg_body_arm(b, b->tied.first, first);
    rg_vector_cross(spin, first, across);
    tied_inertia(b, inertia);
    double sum = b->tied.mass * rg_vector_dot(v, v) + 2 * rg_vector_dot(v, across);
    for (int n = 0; n < 9; n++) {
        sum += spin[n / 3] * inertia[n / 3][n % 3] * spin[n % 3];
    }
    return sum;
}

/* What the kinetic energy falls by as a free body, which would move with v and `momentum` at the time of the
 * kick, and what is tied to it from then on become one. */
static double joined_free(const rg_body *b, const double v[3], const double momentum[3]) {
    const rg_body_motion *nodes = &b->tied.before;
    double own[3][3], inverse[9], first[3], p[3], l[3], velocity[3], spin[3], own_spin[3];
    inertias(b, own, inverse);
    rg_body_arm(b, b->tied.first, first);
    rg_inertia_spin(&b->inertia, b->turn.rotation, momentum, own_spin);
    for (int c = 0; c < 3; c++) {
        p[c] = b->mass * v[c] + nodes->momentum[c];
        l[c] = momentum[c] + nodes->angular[c];
    }
    motion_of(b->mass + b->tied.mass, first, inverse, p, l, velocity, spin);
    return nodes->energy + 0.5 * (b->mass * rg_vector_dot(v, v) + rg_vector_dot(momentum, own_spin) -
                                  rg_vector_dot(p, velocity) - rg_vector_dot(l, spin));
}

/* Likewise of one whose motion is prescribed: less what it does in it. */
static double joined_prescribed(const rg_body *b, const double v[3], const double spin[3]) {
    const rg_body_motion *nodes = &b->tied.before;
    return nodes->energy - rg_vector_dot(nodes->momentum, v) - rg_vector_dot(nodes->angular, spin) +
           0.5 * tied_energy(b, v, spin);
}

/* A free body kicked for h by its own force and moment, before a step dt: v, the angular momentum and the
 * step of the turn, such that tied nodes, which go straight to where that takes them, take from the body just
 * what they get. By Newton's method: what the turn of a step leaves of the first guess is of its angle. */
static void kick_with_ties(rg_body *b, const double force[3], double h, double dt) {
    enum { MOST = 12 };
    double own[3][3], inverse[9], impulse[3], angular[3], v[3], last = INFINITY, first[3], moved[3];
    rg_body_turn *t = &b->turn;
    const double start[3] = {t->momentum[0], t->momentum[1], t->momentum[2]};
    inertias(b, own, inverse);
    rg_body_arm(b, b->tied.first, first);
    for (int k = 0; k < MOST; k++) {
        double rest[3], size = 0, change[3] = {0, 0, 0};
        rg_inertia_free(&b->inertia, t->rotation, t->momentum, dt, t->step);
        rg_body_sweep(b, first, moved);
        for (int c = 0; c < 3; c++) {
            v[c] = (b->mass * b->v[c] + h * force[c] + b->tied.momentum[c] - moved[c] / dt) /
                   (b->mass + b->tied.mass);
        }
        tied_impulse(b, v, dt, impulse, angular);
        for (int c = 0; c < 3; c++) {
            rest[c] = start[c] + h * t->moment[c] - angular[c] - t->momentum[c];
            size += rest[c] * rest[c];
        }
        if (!(size < last)) {
            break;
        }
        last = size;
        for (int n = 0; n < 9; n++) {
            change[n / 3] += inverse[n] * rest[n % 3];
        }
        for (int c = 0; c < 3; c++) {
            t->momentum[c] += rg_vector_dot(own[c], change);
        }
    }
    for (int c = 0; c < 3; c++) { /* to rounding what the nodes do not get */
        t->momentum[c] = start[c] + h * t->moment[c] - angular[c];
        b->v[c] = v[c];
    }
}

/* ---- Kick and drift ---- */

/* Velocities of a free body, by the force and moment on it. */
static void kick_free(rg_body *b, const double force[3], double dt_last, double dt_next) {
    double h = 0.5 * (dt_last + dt_next);
    rg_body_turn *t = &b->turn;
    if (b->tied.any) {
        double v[3], momentum[3];
        memcpy(v, b->v, sizeof v);
        memcpy(momentum, t->momentum, sizeof momentum);
        if (b->tied.joins) {
            double now[3], about[3];
            for (int c = 0; c < 3; c++) {
                now[c] = v[c] + 0.5 * dt_last * force[c] / b->mass;
                about[c] = momentum[c] + 0.5 * dt_last * t->moment[c];
            }
            b->tied.taken = joined_free(b, now, about);
            b->tied.joins = false;
        }
        kick_with_ties(b, force, h, dt_next);
        for (int c = 0; c < 3; c++) {
            b->seen.force[c] = b->mass * (b->v[c] - v[c]) / h;
            b->seen.v[c] = v[c] + 0.5 * dt_last / h * (b->v[c] - v[c]);
            t->moment[c] = (t->momentum[c] - momentum[c]) / h;
            t->seen_momentum[c] = momentum[c] + 0.5 * dt_last * t->moment[c];
        }
    } else {
        for (int c = 0; c < 3; c++) {
            double before = b->v[c], about = t->momentum[c], moment = b->turns ? t->moment[c] : 0;
            b->seen.v[c] = before + 0.5 * dt_last * force[c] / b->mass;
            b->v[c] = before + 0.5 * (dt_last + dt_next) * force[c] / b->mass;
            t->seen_momentum[c] = about + 0.5 * dt_last * moment;
            t->momentum[c] = about + h * moment;
        }
        if (b->turns) {
            rg_inertia_free(&b->inertia, t->rotation, t->momentum, dt_next, t->step);
        }
    }
    if (b->turns) {
        rg_inertia_spin(&b->inertia, t->rotation, t->seen_momentum, t->seen_spin);
    }
}

static void kick_prescribed(rg_bodies *all, int i, double time, double dt_last, double dt_next) {
    rg_body *b = &all->body[i];
    rg_body_turn *t = &b->turn;
    double before[3], about[3], step[3], h = 0.5 * (dt_last + dt_next);
    memcpy(before, b->v, sizeof before);
    memcpy(about, t->spin, sizeof about);
    for (int c = 0; c < 3; c++) {
        b->seen.v[c] = given(all, i, false, c, time);
        b->v[c] = given(all, i, false, c, time + 0.5 * dt_next);
        t->seen_spin[c] = given(all, i, true, c, time);
        t->spin[c] = given(all, i, true, c, time + 0.5 * dt_next);
        step[c] = dt_next * t->spin[c];
    }
    rg_rotation_by(step, t->step);
    if (b->tied.joins) {
        b->tied.taken = joined_prescribed(b, b->seen.v, t->seen_spin);
        b->tied.joins = false;
    }
    if (b->tied.any) {
        double impulse[3], angular[3];
        tied_impulse(b, b->v, dt_next, impulse, angular);
        for (int c = 0; c < 3; c++) {
            b->seen.force[c] -= impulse[c] / h;
            t->moment[c] -= angular[c] / h;
        }
    }
    for (int c = 0; c < 3; c++) {
        double force = b->seen.force[c], moment = t->moment[c];
        b->seen.work -= 0.5 * dt_last * (before[c] * force + about[c] * moment);
        b->work -= 0.5 * ((dt_last * before[c] + dt_next * b->v[c]) * force +
                          (dt_last * about[c] + dt_next * t->spin[c]) * moment);
    }
}

void rg_bodies_sum(rg_bodies *b) {
    int sums = RG_BODY_SUMS * b->count;
    if (sums == 0) {
        return;
    }
    memset(b->total, 0, (size_t)sums * sizeof *b->total);
    for (int i = 0; i < sums * b->threads; i++) {
        rg_exact_merge(&b->total[i % sums], &b->sum[i]);
    }
    memset(b->sum, 0, (size_t)(sums * b->threads) * sizeof *b->sum);
    rg_exact_start_allreduce(b->total, sums, b->comm, &b->request);
}

/* ---- Equilibria ---- */

void rg_bodies_note(rg_bodies *b) {
    rg_bodies_sum(b);
    MPI_Wait(&b->request, MPI_STATUS_IGNORE);
    for (int i = 0; i < 6 * b->count; i++) {
        b->noted[i / 6][i % 6] = rg_exact_value(&b->total[RG_BODY_SUMS * (i / 6) + i % 6]);
    }
}

void rg_bodies_places(const rg_bodies *all, rg_body_place *out) {
    for (int i = 0; i < all->count; i++) {
        const rg_body *b = &all->body[i];
        memcpy(out[i].x, b->x, sizeof b->x);
        memcpy(out[i].rotation, b->turn.rotation, sizeof b->turn.rotation);
        memcpy(out[i].direction, b->turn.direction, sizeof b->turn.direction);
    }
}

void rg_bodies_shift(rg_bodies *all, const rg_body_place *from, const double (*motion)[6], double share) {
    for (int i = 0; i < all->count; i++) {
        rg_body *b = &all->body[i];
        double turn[3], by[4];
        if (b->input->motion != RG_MOTION_FREE || !b->tied.any) {
            continue;
        }
        for (int c = 0; c < 3; c++) {
            b->x[c] = from[i].x[c] + share * motion[i][c];
            turn[c] = share * motion[i][3 + c];
        }
        rg_rotation_by(turn, by);
        rg_rotation_join(by, from[i].rotation, b->turn.rotation);
        rg_rotation_turn(by, from[i].direction, b->turn.direction);
    }
}

void rg_body_carried_motion(const rg_body *b, const double impulse[6], double motion[6]) {
    double first[3], inertia[3][3], inverse[9];
    rg_body_arm(b, b->tied.first, first);
    tied_inertia(b, inertia);
    invert_inertia(b->tied.mass, first, inertia, inverse);
    motion_of(b->tied.mass, first, inverse, impulse, impulse + 3, motion, motion + 3);
}

void rg_bodies_settle(rg_bodies *all) {
    for (int i = 0; i < all->count; i++) {
        rg_body *b = &all->body[i];
        const double *q = b->turn.rotation, back[4] = {q[0], -q[1], -q[2], -q[3]};
        double spin[3], momentum[3];
        if (b->turns && b->input->motion == RG_MOTION_FREE) {
            rg_rotation_turn(back, b->turn.spin, spin);
            momentum_of(&b->inertia, spin, momentum);
            rg_rotation_turn(q, momentum, b->turn.momentum);
        }
    }
}

double rg_bodies_unheld(const rg_bodies *all, const rg_body **which) {
    double sum = 0, most = 0;
    for (int i = 0; i < all->count; i++) {
        const rg_body *b = &all->body[i];
        const double *noted = all->noted[i];
        double spin[3] = {0, 0, 0};
        if (b->input->motion != RG_MOTION_FREE || b->tied.any) {
            continue;
        }
        if (b->turns) {
            rg_inertia_spin(&b->inertia, b->turn.rotation, noted + 3, spin);
        }
        double here = rg_vector_dot(noted, noted) / b->mass + rg_vector_dot(spin, noted + 3);
        *which = here > most ? b : *which;
        most = fmax(most, here);
        sum += here;
    }
    return sqrt(sum);
}

void rg_bodies_kick(rg_bodies *all, double time, double dt_last, double dt_next) {
    MPI_Wait(&all->request, MPI_STATUS_IGNORE);
    all->born_omega2 = 0;
    for (int i = 0; i < all->count; i++) {
        rg_body *b = &all->body[i];
        all->born_omega2 =
            fmax(all->born_omega2, rg_exact_value(&all->total[RG_BODY_SUMS * i + RG_BODY_BORN]));
        for (int c = 0; c < 3; c++) {
            b->seen.force[c] = rg_exact_value(&all->total[RG_BODY_SUMS * i + RG_BODY_FORCE + c]);
            b->turn.moment[c] = rg_exact_value(&all->total[RG_BODY_SUMS * i + RG_BODY_MOMENT + c]);
        }
        memcpy(b->seen.x, b->x, sizeof b->seen.x);
        memcpy(b->turn.seen_rotation, b->turn.rotation, sizeof b->turn.rotation);
        b->seen.work = b->work;
        if (b->input->motion == RG_MOTION_PRESCRIBED) {
            kick_prescribed(all, i, time, dt_last, dt_next);
        } else {
            double force[3] = {b->seen.force[0], b->seen.force[1], b->seen.force[2]};
            kick_free(b, force, dt_last, dt_next);
        }
    }
}

void rg_bodies_drift(rg_bodies *all, double dt) {
    for (int i = 0; i < all->count; i++) {
        rg_body *b = &all->body[i];
        for (int c = 0; c < 3; c++) {
            b->x[c] += dt * b->v[c];
        }
        if (b->turns) {
            double moved[3];
            rg_body_sweep(b, b->turn.direction, moved);
            rg_rotation_join(b->turn.step, b->turn.rotation, b->turn.rotation);
            for (int c = 0; c < 3; c++) {
                b->turn.direction[c] += moved[c];
            }
            double length = sqrt(rg_vector_dot(b->turn.direction, b->turn.direction));
            for (int c = 0; c < 3 && length > 0; c++) {
                b->turn.direction[c] /= length;
            }
        }
    }
}

/* ---- Account ---- */

/* Of a change of velocity and angular momentum. */
static double kinetic_of(const rg_body *b, const double v[3], const double momentum[3]) {
    double spin[3], energy = 0;
    for (int c = 0; c < 3; c++) {
        energy += 0.5 * b->mass * v[c] * v[c];
    }
    if (b->turns) {
        rg_inertia_spin(&b->inertia, b->turn.seen_rotation, momentum, spin);
        energy += 0.5 * rg_vector_dot(spin, momentum);
    }
    return energy;
}

rg_bodies_account rg_bodies_take(const rg_bodies *all, double longer) {
    rg_bodies_account a = {0};
    for (int i = 0; i < all->count; i++) {
        const rg_body *b = &all->body[i];
        const rg_body_seen *s = &b->seen;
        a.work += s->work;
        if (b->input->motion == RG_MOTION_PRESCRIBED) {
            continue;
        }
        double change[3], about[3];
        for (int c = 0; c < 3; c++) {
            int p = (c + 1) % 3, q = (c + 2) % 3;
            change[c] = longer * (b->v[c] - s->v[c]);
            about[c] = longer * (b->turn.momentum[c] - b->turn.seen_momentum[c]);
            a.momentum[c] += b->mass * s->v[c];
            a.angular_momentum[c] +=
                b->mass * (s->x[p] * s->v[q] - s->x[q] * s->v[p]) + b->turn.seen_momentum[c];
        }
        a.kinetic += kinetic_of(b, s->v, b->turn.seen_momentum);
        a.half_kick += kinetic_of(b, change, about);
    }
    return a;
}

void rg_bodies_register(rg_bodies *all, rg_state *st) {
    enum {
        VALUES = (sizeof(rg_body) - offsetof(rg_body, x)) / sizeof(double),
        TURN = sizeof(rg_body_turn) / sizeof(double)
    };
    bool turns = false;
    for (int i = 0; i < all->count; i++) {
        turns = turns || all->body[i].turns;
    }
    if (all->count > 0) {
        rg_state_add_rows(st, "bodies", RG_STATE_DOUBLE, VALUES, all->body[0].x, sizeof *all->body,
                          (size_t)all->count);
    }
    if (turns) {
        rg_state_add_rows(st, "turning", RG_STATE_DOUBLE, TURN, (double *)&all->body[0].turn,
                          sizeof *all->body, (size_t)all->count);
    }
}
