#include "case/read.h"
#include "solver/setup.h"
#include "solver/step.h"
#include "verify/trial.h"

#include <math.h>
#include <string.h>

#include "base/error.h"
#include "base/mem.h"
#include "output/estimate.h"
#include "solver/spectrum.h"
#include "solver/tile.h"

static rg_case *read(const char *text, int count, const char *const *set) {
    rg_case *c = rg_case_read_text("verify", text, strlen(text), count, set, stderr);
    if (c == NULL) {
        rg_fatal(RG_FAILURE, "verify: a built-in case is not understood");
    }
    return c;
}

rg_trial *rg_trial_begin(const char *text, const rg_verify_change *change, MPI_Comm comm) {
    rg_trial *t = RG_NEW(rg_trial, 1);
    t->theory = read(text, 0, NULL);
    t->input = read(text, change->count, change->set);
    t->solver = rg_solver_make(t->input, comm);
    rg_spectrum(t->solver);
    rg_estimate e = rg_estimate_run(t->solver);
    rg_free(e.of_material);
    t->dt = e.dt;
    rg_solver_start(t->solver);
    return t;
}

bool rg_trial_next(rg_trial *t) {
    rg_solver *s = t->solver;
    if (t->states > 0) {
        bool over = s->time >= t->input->time.end * (1 - 1e-12) ||
                    (t->input->time.steps > 0 && s->step >= t->input->time.steps);
        if (over || !isfinite(s->stiffening_anywhere)) {
            return false;
        }
        rg_solver_drift(s);
    }
    double left = t->input->time.end - s->time;
    rg_solver_kick(s, left > 0 && left < t->dt ? left : t->dt);
    t->states++;
    return true;
}

const rg_energy *rg_trial_ledger(rg_trial *t) {
    return rg_ledger_take(&t->ledger, t->solver);
}

void rg_trial_stresses(const rg_trial *t, rg_trial_visit *visit, void *context) {
    const rg_solver *s = t->solver;
    double *cauchy = RG_NEW(double, s->domain->tile_blocks *RG_GAUSS * 6 * RG_LANES);
    for (size_t i = 0; i < s->domain->tiles; i++) {
        const rg_tile *tile = &s->domain->tile[i];
        rg_tile_receive(s, tile, &s->work[0]);
        rg_tile_state(s, tile, &s->work[0], NULL, cauchy, NULL);
        for (size_t slot = tile->begin * RG_LANES; slot < tile->end * RG_LANES; slot++) {
            const double *block = cauchy + (slot / RG_LANES - tile->begin) * RG_GAUSS * 6 * RG_LANES;
            for (size_t g = 0; s->domain->id[slot] >= 0 && g < RG_GAUSS; g++) {
                double stress[6];
                for (size_t k = 0; k < 6; k++) {
                    stress[k] = block[(g * 6 + k) * RG_LANES + slot % RG_LANES];
                }
                visit(context, s, slot, stress);
            }
        }
    }
    rg_free(cauchy);
}

void rg_trial_nodes(const rg_trial *t, rg_trial_visit_node *visit, void *context) {
    const rg_domain *d = t->solver->domain;
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        for (int n = 0; d->id[slot] >= 0 && n < RG_NODES; n++) {
            visit(context, t->solver, slot, n);
        }
    }
}

void rg_trial_end(rg_trial *t) {
    rg_solver_free(t->solver);
    rg_case_free(t->input);
    rg_case_free(t->theory);
    rg_free(t);
}
