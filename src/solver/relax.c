#include "solver/relax.h"

#include <inttypes.h>
#include <math.h>

#include "base/error.h"
#include "base/first_bad.h"
#include "base/mem.h"
#include "solver/limits.h"
#include "solver/statics.h"
#include "solver/step.h"

/* What the precision of the fields leaves to be found. */
#define SINGLE_TOLERANCE 1e-4

/* Of the critical step. */
#define SAFETY 0.9

/* It is told again once the residual has fallen by this. */
#define TOLD_AGAIN 0.1

typedef struct {
    rg_statics on;
    rg_real *acceleration, *velocity; /* at the present state, and half a step before it */
    rg_real *now;                     /* velocity at it */
    rg_real *load;                    /* M^-1 (loads but for foundations) at it */
    double dt, kinetic;               /* s; J at the last state */
    double loads, scale, residual;    /* norms: of the loads, with reactions, of what nothing balances */
    double work, heat;                /* J */
    double told;                      /* residual that was told last */
} relaxing;

/* The largest step that is stable: stiffening as of the last pass. */
static double stable_step(const rg_solver *s) {
    return SAFETY * 2 / sqrt(s->omega2 * fmax(1, s->stiffening_anywhere));
}

/* Forces at the present displacement without what supports take; if `measured`, what nothing balances, and
 * the norm of loads and reactions. */
static void evaluate(relaxing *r, bool measured) {
    rg_statics_accelerate(&r->on, r->acceleration, true);
    double whole = measured ? rg_statics_norm(&r->on, r->acceleration) : 0;
    rg_statics_hold(&r->on, r->acceleration);
    if (measured) {
        r->scale = fmax(r->loads, whole);
        r->residual = rg_statics_norm(&r->on, r->acceleration);
    }
    if (r->on.solver->input->loads > 0) {
        rg_solver_loads(r->on.solver, r->load);
    }
}

/* Work of the loads over half of a step that begins or ends at the present state (J). */
static double half_work(const relaxing *r) {
    if (r->on.solver->input->loads == 0) {
        return 0;
    }
    rg_statics_times_mass(&r->on, r->load, r->on.force);
    return 0.5 * r->dt * rg_statics_dot(&r->on, r->on.force, r->velocity);
}

/* dt^2/8 a.Ma: what central differences keep of a state at rest is less than what it has by that. */
static double half_kick(const relaxing *r) {
    double norm = rg_statics_norm(&r->on, r->acceleration);
    return r->dt * r->dt / 8 * norm * norm;
}

/* Begins a swing from rest. */
static void begin_swing(relaxing *r) {
    r->heat -= half_kick(r);
    r->dt = stable_step(r->on.solver);
    r->heat += half_kick(r);
    rg_statics_add(&r->on, 0.5 * r->dt, r->acceleration, 0, r->velocity);
    r->kinetic = 0;
}

/* Work of the supports that put their nodes where they are at t = 0, by the trapezoidal rule (J). */
static double place(relaxing *r) {
    rg_solver *s = r->on.solver;
    double work = 0;
    for (int k = 0; k < 2; k++) {
        rg_real *force = k == 0 ? r->acceleration : r->load;
        rg_statics_accelerate(&r->on, force, false);
        if (k == 0) {
            rg_statics_copy(&r->on, s->u, r->now);
            rg_constraints_place(s->constraints, s->u);
        }
    }
    rg_statics_add(&r->on, 1, s->u, -1, r->now);
    rg_statics_add(&r->on, 1, r->load, 1, r->acceleration);
    rg_statics_times_mass(&r->on, r->acceleration, r->on.force);
    work = -0.5 * rg_statics_dot(&r->on, r->on.force, r->now);
    rg_statics_add(&r->on, 0, r->load, 0, r->load);
    return work;
}

static void tell(relaxing *r, FILE *out, int64_t step, bool last) {
    double share = r->scale > 0 ? r->residual / r->scale : 0;
    if (out != NULL && r->on.solver->rank == 0 && (last ? share != r->told : share < TOLD_AGAIN * r->told)) {
        fprintf(out, "relax          residual %.2g of the loads after %" PRId64 " steps, heat %.4g J\n",
                share, step, r->heat);
        fflush(out);
        r->told = share;
    }
}

/* A step; at the state to which it leads the swing may be over. Returns whether it is. */
static bool step(relaxing *r) {
    rg_statics_add(&r->on, r->dt, r->velocity, 1, r->on.solver->u);
    r->work += half_work(r);
    evaluate(r, false);
    r->work += half_work(r);
    rg_statics_copy(&r->on, r->velocity, r->now);
    rg_statics_add(&r->on, 0.5 * r->dt, r->acceleration, 1, r->now);
    rg_statics_times_mass(&r->on, r->now, r->on.force);
    double kinetic = 0.5 * rg_statics_dot(&r->on, r->now, r->on.force);
    bool over = !(kinetic > r->kinetic);
    r->kinetic = kinetic;
    if (!over) {
        rg_statics_add(&r->on, r->dt, r->acceleration, 1, r->velocity);
    }
    return over;
}

_Noreturn static void refuse(const relaxing *r, int64_t steps) {
    rg_speak(r->on.solver->comm);
    rg_fatal(RG_FAILURE,
             "%s: start: relax: the residual is %.3g of the loads after %" PRId64
             " steps, more than relax.tolerance: more relax.steps, or the loads do not balance",
             r->on.solver->input->path, r->residual / r->scale, steps);
}

static relaxing make(rg_solver *s) {
    relaxing r = {.on = rg_statics_make(s), .told = INFINITY};
    rg_real **const field[] = {&r.acceleration, &r.velocity, &r.now, &r.load};
    for (size_t i = 0; i < sizeof field / sizeof *field; i++) {
        *field[i] = rg_statics_field(&r.on);
    }
    return r;
}

static void end(relaxing *r) {
    rg_free(r->acceleration);
    rg_free(r->velocity);
    rg_free(r->now);
    rg_free(r->load);
    rg_statics_free(&r->on);
}

rg_equilibrium rg_relax(rg_solver *s, FILE *out) {
    const rg_case *c = s->input;
    double tolerance =
        sizeof(rg_real) < sizeof(double) ? fmax(c->relax.tolerance, SINGLE_TOLERANCE) : c->relax.tolerance;
    relaxing r = make(s);
    r.work = place(&r);
    evaluate(&r, false);
    r.loads = fmax(rg_statics_norm(&r.on, r.load), fmax(s->initial_stress.scale, rg_heating_scale(s)));
    evaluate(&r, true);
    begin_swing(&r);
    int64_t steps = 0;
    while (r.residual > tolerance * r.scale) {
        if (steps >= c->relax.steps || !isfinite(r.residual)) {
            refuse(&r, steps);
        }
        steps++;
        if (step(&r)) {
            r.heat += r.kinetic;
            evaluate(&r, true);
            begin_swing(&r);
            tell(&r, out, steps, false);
        }
    }
    r.heat -= half_kick(&r);
    tell(&r, out, steps, true);
    rg_equilibrium found = {.residual = r.scale > 0 ? r.residual / r.scale : 0, .passes = r.on.passes};
    s->relaxed = (rg_relaxed){.heat = r.heat, .work = r.work};
    end(&r);
    rg_limits_refuse(s, "start: relax");
    rg_solver_settle(s);
    return found;
}
