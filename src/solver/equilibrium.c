#include "solver/equilibrium.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "base/error.h"
#include "base/first_bad.h"
#include "base/mem.h"
#include "base/vector.h"
#include "domain/element.h"
#include "layout.h"
#include "solver/coarse.h"
#include "solver/limits.h"
#include "solver/statics.h"
#include "solver/step.h"

enum { NEWTON_STEPS = 30, HALVINGS = 10, ITERATIONS = 20000, MODES = 6 };

/* What the precision of the fields leaves to be found. */
static const bool single = sizeof(rg_real) < sizeof(double);
static double tolerance(void) {
    return single ? 1e-4 : 1e-8;
}

/* Of residuals that fall no more: what rounding leaves of light loads. */
static double rounding(void) {
    return single ? 1e-2 : 1e-5;
}

/* How far the linear system is solved in a step of Newton's: its tangent is that of one state. */
#define EXACTNESS 1e-2

/* Residual, of the loads, below which the forces on a body are near those of its equilibrium, and tell how
 * their moments change as it turns. */
#define BALANCED 0.1

/* In form intrinsic a way begins with laws that are straight up to this many times their openings, until the
 * residual is that small: from where nothing is in balance faces would pass their tops. */
#define STRAIGHT 1e3
#define NEAR     1e-2

typedef struct {
    rg_statics on;
    rg_coarse *coarse;
    rg_real *start, *internal;  /* u, and the acceleration by internal forces, at the last Newton step */
    rg_real *residual, *change; /* acceleration; sum of the CG's steps */
    rg_real *search, *product, *product_force, *preconditioned;
    double (*pressed)[6];    /* [bodies]: force and moment of contact on each, at the last Newton step */
    double (*fall)[6];       /* and what it falls by along `search`, with the moments of what is tied */
    double (*turning)[3][3]; /* [bodies]: solver/tie.h */
    double least;            /* edge of the smallest element, about (m) */
    double nudge;            /* largest displacement of a difference (m) */
} newton;

/* ---- Supports ---- */

typedef struct {
    const newton *of;
    double centre[3], size;
    rg_exact_sum *sum; /* [MODES][MODES] */
} rigid;

/* Six motions of a rigid body, along a held line. */
static void add_line(void *to, size_t slot, int node, const double line[3]) {
    rigid *r = to;
    double x[3], arm[3], moment[3], along[MODES];
    rg_node_position(r->of->on.solver->domain->corner + 12 * slot, node, x);
    rg_vector_subtract(x, r->centre, arm);
    rg_vector_cross(arm, line, moment);
    for (int k = 0; k < MODES; k++) {
        along[k] = k < 3 ? line[k] : moment[k - 3] / r->size;
    }
    for (int i = 0; i < MODES * MODES; i++) {
        rg_exact_add(&r->sum[i], along[i / MODES] * along[i % MODES]);
    }
}

/* Whether the supports leave the body no motion as a rigid one: the matrix of these is definite. */
static bool is_held(const newton *q) {
    const double(*box)[3] = (const double(*)[3])q->on.solver->part->box;
    rigid r = {.of = q, .sum = RG_NEW(rg_exact_sum, MODES * MODES)};
    for (int c = 0; c < 3; c++) {
        r.centre[c] = 0.5 * (box[0][c] + box[1][c]);
        r.size = fmax(r.size, box[1][c] - box[0][c]);
    }
    rg_constraints_show(q->on.solver->constraints, add_line, &r);
    rg_loads_show(q->on.solver->loads, add_line, &r);
    rg_ties_show(q->on.solver->ties, add_line, &r);
    rg_exact_allreduce(r.sum, MODES * MODES, q->on.solver->comm);
    double matrix[MODES][MODES], most = 0;
    for (int i = 0; i < MODES * MODES; i++) {
        matrix[i / MODES][i % MODES] = rg_exact_value(&r.sum[i]);
        most = fmax(most, matrix[i / MODES][i % MODES]);
    }
    rg_free(r.sum);
    bool held = most > 0;
    for (int k = 0; held && k < MODES; k++) { /* Gauss: a pivot that vanishes is a motion that is left */
        held = matrix[k][k] > 1e-10 * most;
        for (int i = k + 1; held && i < MODES; i++) {
            double factor = matrix[i][k] / matrix[k][k];
            for (int j = k; j < MODES; j++) {
                matrix[i][j] -= factor * matrix[k][j];
            }
        }
    }
    return held;
}

_Noreturn static void refuse(const newton *q, int status, const char *why) {
    rg_speak(q->on.solver->comm);
    rg_fatal(status, "%s: start: static: %s", q->on.solver->input->path, why);
}

/* Of form intrinsic, before no equilibrium is blamed on something else: faces beyond the top of their law. */
static void refuse_opened(const newton *q) {
    if (q->on.stretch == 1) {
        rg_limits_refuse_openings(q->on.solver, "start: static");
    }
}

/* ---- The linear system ---- */

/* Of the displacement of a difference: so small that few faces come into contact by it or lose it, as long as
 * rounding of the displacement itself leaves enough of it. */
static void set_nudge(newton *q) {
    double share = single ? 1e-6 : 1e-7, rounds = single ? 1e-4 : 0;
    q->nudge = fmax(share * q->least, rounds * rg_statics_largest(&q->on, q->start));
}

/* product = M^-1 K search without what is held, by a difference of internal forces. */
static void apply_tangent(newton *q) {
    const rg_bodies *bodies = q->on.solver->bodies;
    double scale = q->nudge / rg_statics_largest(&q->on, q->search);
    rg_statics_move(&q->on, q->start, scale, q->search);
    rg_statics_accelerate(&q->on, q->product, false);
    rg_statics_return(&q->on);
    rg_statics_add(&q->on, 1 / scale, q->internal, -1 / scale, q->product);
    for (int i = 0; i < 6 * bodies->count; i++) {
        q->fall[i / 6][i % 6] = (q->pressed[i / 6][i % 6] - bodies->noted[i / 6][i % 6]) / scale;
    }
    for (int i = 0; i < 3 * bodies->count; i++) {
        q->fall[i / 3][3 + i % 3] += rg_vector_dot(q->turning[i / 3][i % 3], q->on.motion[i / 3] + 3);
    }
    rg_statics_hold(&q->on, (const double(*)[6])q->fall, q->product);
}

/* preconditioned = (1/omega^2 + P A^-1 P^T M) residual, as bodies let it: projected in the inner product of
 * the mass it stays symmetric. */
static void precondition(newton *q) {
    rg_statics_add(&q->on, 1 / q->on.solver->omega2, q->residual, 0, q->preconditioned);
    rg_coarse_correct(q->coarse, q->on.force, q->preconditioned);
    if (rg_ties_any(q->on.solver->ties)) {
        rg_statics_hold(&q->on, NULL, q->preconditioned);
    }
}

/* `change` becomes what takes the residual to `goal` in its norm, about. */
static void solve(newton *q, double goal) {
    memset(q->change, 0, q->on.length * sizeof *q->change);
    double before = 1, now = 0;
    rg_statics_times_mass(&q->on, q->residual, q->on.force);
    for (int k = 0; k < ITERATIONS; k++) {
        if (sqrt(rg_statics_dot(&q->on, q->residual, q->on.force)) <= goal) {
            return;
        }
        precondition(q);
        now = rg_statics_dot(&q->on, q->preconditioned, q->on.force);
        rg_statics_add(&q->on, 1, q->preconditioned, k == 0 ? 0 : now / before, q->search);
        apply_tangent(q);
        rg_statics_times_mass(&q->on, q->product, q->product_force);
        double curvature = rg_statics_dot(&q->on, q->search, q->product_force);
        if (!(curvature > 0)) {
            refuse_opened(q);
            refuse(q, RG_FAILURE, "no stable equilibrium: a part of the body is not held, or it buckles");
        }
        rg_statics_add(&q->on, now / curvature, q->search, 1, q->change);
        rg_statics_add(&q->on, -now / curvature, q->product, 1, q->residual);
        rg_statics_add(&q->on, -now / curvature, q->product_force, 1, q->on.force);
        before = now;
    }
}

/* ---- Newton ---- */

/* The residual at the present displacement; returns its norm, *scale: that of loads and reactions. */
static double find_residual(newton *q, double *scale) {
    rg_statics_accelerate(&q->on, q->residual, true);
    double whole = rg_statics_norm(&q->on, q->residual);
    rg_solver *s = q->on.solver;
    if (rg_ties_any(s->ties)) {
        rg_ties_turning(s->ties, q->residual, q->turning);
    }
    rg_statics_hold(&q->on, (const double(*)[6])s->bodies->noted, q->residual);
    *scale = fmax(*scale, whole);
    double left = rg_statics_norm(&q->on, q->residual);
    if (left > BALANCED * *scale) {
        memset(q->turning, 0, ((size_t)s->bodies->count + 1) * sizeof *q->turning);
    }
    return left;
}

/* A step along `change` that makes the residual smaller, if there is one; returns its norm. */
static double step(newton *q, double before, double *scale) {
    double now = INFINITY, share = 1;
    for (int k = 0; k < HALVINGS && !(now < before); k++, share *= 0.5) {
        rg_statics_move(&q->on, q->start, share, q->change);
        now = find_residual(q, scale);
    }
    return now;
}

static void tell(const newton *q, FILE *out, double residual) {
    if (out != NULL && q->on.solver->rank == 0) {
        fprintf(out, "static start   residual %.2g of the loads after %" PRId64 " passes\n", residual,
                q->on.passes);
        fflush(out);
    }
}

static newton make(rg_solver *s) {
    newton q = {.on = rg_statics_make(s)};
    rg_real **const field[] = {&q.start,  &q.internal, &q.residual,      &q.change,
                               &q.search, &q.product,  &q.product_force, &q.preconditioned};
    for (size_t i = 0; i < sizeof field / sizeof *field; i++) {
        *field[i] = rg_statics_field(&q.on);
    }
    q.pressed = rg_alloc((size_t)s->bodies->count + 1, sizeof *q.pressed);
    q.fall = rg_alloc((size_t)s->bodies->count + 1, sizeof *q.fall);
    q.turning = rg_alloc((size_t)s->bodies->count + 1, sizeof *q.turning);
    double least = INFINITY; /* volume */
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        least = fmin(least, s->domain->geom[rg_geom_index(slot, RG_GEOM_VOLUME)]);
    }
    MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPI_DOUBLE, MPI_MIN, s->comm);
    q.least = cbrt(least);
    return q;
}

static void end(newton *q) {
    void *blocks[] = {q->start,         q->internal,       q->residual, q->change, q->search, q->product,
                      q->product_force, q->preconditioned, q->pressed,  q->fall,   q->turning};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
        rg_free(blocks[i]);
    }
    rg_statics_free(&q->on);
    rg_coarse_free(q->coarse);
}

/* Norm of the loads alone. */
static double load_norm(newton *q) {
    rg_statics_accelerate(&q->on, q->residual, true);
    rg_statics_accelerate(&q->on, q->internal, false);
    rg_statics_add(&q->on, -1, q->internal, 1, q->residual);
    return rg_statics_norm(&q->on, q->residual);
}

/* At what a Newton step departs from. */
static void depart(newton *q) {
    const rg_bodies *bodies = q->on.solver->bodies;
    rg_statics_depart(&q->on, q->start);
    rg_statics_accelerate(&q->on, q->internal, false);
    for (int i = 0; i < 6 * bodies->count; i++) {
        q->pressed[i / 6][i % 6] = bodies->noted[i / 6][i % 6];
    }
    set_nudge(q);
}

/* Newton's steps until the residual is `goal` of the loads, or falls no more; returns it, *scale: of loads
 * and reactions. */
static double search(newton *q, FILE *out, double goal, double loads, double residual, double *scale) {
    double last = INFINITY;
    for (int k = 0; k < NEWTON_STEPS && residual > goal * *scale; k++) {
        if (residual > 0.5 * last && residual < rounding() * *scale) {
            break; /* to rounding */
        }
        last = residual;
        depart(q);
        solve(q, fmax(EXACTNESS * residual, 0.1 * goal * *scale));
        *scale = loads;
        residual = step(q, residual, scale);
        tell(q, out, residual / *scale);
    }
    return residual;
}

/* Contact alone would have to hold a free body that carries nothing. */
static void refuse_unheld(const newton *q, double scale) {
    const rg_solver *s = q->on.solver;
    const rg_body *which = NULL;
    double left = rg_bodies_unheld(s->bodies, &which);
    if (which != NULL && left > tolerance() * scale) {
        rg_speak(s->comm);
        rg_fatal(RG_USAGE,
                 "%s: start: static: the solid at rest presses %s, a free body with nothing tied to it: only "
                 "contact would hold it; tie it, prescribe it or leave it a gap",
                 s->input->path, which->input->name);
    }
}

rg_equilibrium rg_equilibrium_find(rg_solver *s, FILE *out) {
    newton q = make(s);
    rg_constraints_place(s->constraints, s->u);
    if (!is_held(&q)) {
        refuse(&q, RG_USAGE,
               "what `boundary` prescribes at t = 0 does not hold the body: it can still move or turn");
    }
    q.coarse = rg_coarse_make(s);
    double stress = fmax(s->prestress != NULL ? s->initial_stress.scale : 0, rg_heating_scale(s));
    q.on.stretch = s->model->law.form == RG_FORM_INTRINSIC ? STRAIGHT : 1;
    double loads = fmax(load_norm(&q), stress), scale = loads, residual = find_residual(&q, &scale);
    loads = fmax(loads, RG_STATICS_FIRST * scale);
    if (q.on.stretch > 1) {
        search(&q, out, NEAR, loads, residual, &scale);
        q.on.stretch = 1;
        scale = loads;
        residual = find_residual(&q, &scale);
    }
    residual = search(&q, out, tolerance(), loads, residual, &scale);
    if (!(residual <= rounding() * scale)) {
        refuse_opened(&q);
        refuse(&q, RG_FAILURE, "no equilibrium found");
    }
    refuse_unheld(&q, scale);
    rg_equilibrium found = {.residual = scale > 0 ? residual / scale : 0, .passes = q.on.passes};
    end(&q);
    rg_bodies_settle(s->bodies);
    rg_ties_start(s->ties, s->u, s->velocity);
    rg_limits_refuse(s, "start: static");
    rg_limits_refuse_openings(s, "start: static");
    rg_solver_settle(s);
    return found;
}

double rg_equilibrium_of_stress(rg_solver *s, FILE *out) {
    newton q = make(s);
    if (s->input->start == RG_START_INITIAL) {
        rg_limits_refuse(s, "initial.stress");
    }
    double loads = 0, scale = s->initial_stress.scale;
    rg_statics_copy(&q.on, s->u, q.start);
    rg_constraints_place(s->constraints, s->u); /* which the first step does */
    double residual = find_residual(&q, &loads), share = scale > 0 ? residual / scale : 0;
    if (out != NULL && s->rank == 0) {
        fprintf(out, "initial stress %.2g of it is not in balance at the start\n", share);
        fflush(out);
    }
    rg_statics_copy(&q.on, q.start, s->u);
    rg_statics_forget(&q.on);
    end(&q);
    return share;
}
