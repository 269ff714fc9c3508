#include "solver/relax.h"

#include <inttypes.h>
#include <math.h>

#include "base/error.h"
#include "base/first_bad.h"
#include "base/mem.h"
#include "solver/limits.h"
#include "solver/statics.h"
#include "solver/step.h"

/* Of the critical step; once that is shorter than this share of it was, all begins anew. */
#define SAFETY  0.9
#define SHORTER 0.97

/* Most that the damping takes of a velocity in a step, about. */
#define MOST_DAMPING 1.0

/* The residual is measured every so many steps. */
enum { MEASURED = 10 };

/* It is told again once the residual has fallen by this. */
#define TOLD_AGAIN 0.1

typedef struct {
    rg_statics on;
    rg_real *acceleration, *velocity; /* at the present state, and half a step before it or after */
    rg_real *now;                     /* velocity at it */
    rg_real *load;                    /* M^-1 (loads but for foundations) at it */
    rg_real *momentum;                /* M velocity */
    double dt;                        /* s */
    double inertia, power;            /* of the velocity: v.Mv (J), and v.Ma at the state before it (W) */
    double loads, scale, residual;    /* norms: least scale, with reactions, of what nothing balances */
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
    rg_statics_hold(&r->on, NULL, r->acceleration);
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

/* Sets out from rest: of the velocities half a step before and after it, the mean is zero. */
static void set_out(relaxing *r) {
    r->dt = stable_step(r->on.solver);
    r->heat += half_kick(r);
    rg_statics_add(&r->on, -0.5 * r->dt, r->acceleration, 0, r->velocity);
    r->inertia = 0;
}

/* Stops at the present state: what moved becomes heat. */
static void stop(relaxing *r) {
    rg_statics_copy(&r->on, r->velocity, r->now);
    rg_statics_add(&r->on, 0.5 * r->dt, r->acceleration, 1, r->now);
    rg_statics_times_mass(&r->on, r->now, r->on.force);
    r->heat += 0.5 * rg_statics_dot(&r->on, r->now, r->on.force) - half_kick(r);
}

/* Work of the supports that put their nodes where they are at t = 0, by the trapezoidal rule (J). */
static double place(relaxing *r) {
    rg_solver *s = r->on.solver;
    rg_statics_accelerate(&r->on, r->acceleration, false);
    rg_statics_copy(&r->on, s->u, r->now);
    rg_constraints_place(s->constraints, s->u);
    rg_statics_accelerate(&r->on, r->load, false);
    rg_statics_add(&r->on, 1, s->u, -1, r->now);
    rg_statics_add(&r->on, 1, r->load, 1, r->acceleration);
    rg_statics_times_mass(&r->on, r->acceleration, r->on.force);
    double work = -0.5 * rg_statics_dot(&r->on, r->on.force, r->now);
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

/* The velocity that leads on, damped by twice the frequency of the last change of the displacement. */
static void kick(relaxing *r) {
    double omega2 = 0;
    if (r->inertia > 0) {
        omega2 = (r->power - rg_statics_dot(&r->on, r->acceleration, r->momentum)) / (r->dt * r->inertia);
    }
    double half = 0.5 * fmin(2 * r->dt * sqrt(fmax(omega2, 0)), MOST_DAMPING);
    rg_statics_copy(&r->on, r->velocity, r->now);
    rg_statics_add(&r->on, 0.5 * r->dt / (1 + half), r->acceleration, 1 / (1 + half), r->now);
    rg_statics_times_mass(&r->on, r->now, r->on.force);
    r->heat += 2 * half * rg_statics_dot(&r->on, r->now, r->on.force);
    rg_statics_add(&r->on, 2, r->now, -1, r->velocity);
    rg_statics_times_mass(&r->on, r->velocity, r->momentum);
    r->inertia = rg_statics_dot(&r->on, r->velocity, r->momentum);
    r->power = rg_statics_dot(&r->on, r->acceleration, r->momentum);
}

/* To the next state, with its forces. */
static void drift(relaxing *r, bool measured) {
    rg_statics_add(&r->on, r->dt, r->velocity, 1, r->on.solver->u);
    r->work += half_work(r);
    evaluate(r, measured);
    r->work += half_work(r);
}

_Noreturn static void refuse(relaxing *r, int64_t steps) {
    const char *path = r->on.solver->input->path;
    if (!isfinite(r->residual)) {
        rg_speak(r->on.solver->comm);
        rg_fatal(RG_FAILURE,
                 "%s: start: relax: forces are not finite after %" PRId64
                 " steps: the solid does not bear the loads",
                 path, steps);
    }
    double rounding = rg_statics_rounding(&r->on, r->now, r->load);
    rg_speak(r->on.solver->comm);
    rg_fatal(RG_FAILURE,
             "%s: start: relax: the residual is %.3g of the loads after %" PRId64
             " steps, more than relax.tolerance: more relax.steps, or the loads do not balance (rounding of "
             "the displacement leaves %.1g)",
             path, r->residual / r->scale, steps, rounding / r->scale);
}

static relaxing make(rg_solver *s) {
    relaxing r = {.on = rg_statics_make(s), .told = INFINITY};
    rg_real **const field[] = {&r.acceleration, &r.velocity, &r.now, &r.load, &r.momentum};
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
    rg_free(r->momentum);
    rg_statics_free(&r->on);
}

rg_equilibrium rg_relax(rg_solver *s, FILE *out) {
    const rg_case *c = s->input;
    relaxing r = make(s);
    r.work = place(&r);
    evaluate(&r, false);
    r.loads = fmax(rg_statics_norm(&r.on, r.load), fmax(s->initial_stress.scale, rg_heating_scale(s)));
    evaluate(&r, true);
    r.loads = fmax(r.loads, RG_STATICS_FIRST * r.scale);
    set_out(&r);
    int64_t steps = 0;
    while (!(isfinite(r.residual) && r.residual <= c->relax.tolerance * r.scale)) {
        if (steps >= c->relax.steps || !isfinite(r.residual)) {
            refuse(&r, steps);
        }
        if (stable_step(s) < SHORTER * r.dt) {
            stop(&r);
            set_out(&r);
        }
        kick(&r);
        steps++;
        drift(&r, steps % MEASURED == 0 || steps == c->relax.steps);
        tell(&r, out, steps, false);
    }
    stop(&r);
    tell(&r, out, steps, true);
    rg_equilibrium found = {.residual = r.scale > 0 ? r.residual / r.scale : 0, .passes = r.on.passes};
    s->relaxed = (rg_relaxed){.heat = r.heat, .work = r.work};
    end(&r);
    rg_limits_refuse(s, "start: relax");
    rg_solver_settle(s);
    return found;
}
