#include "solver/opening.h"

#include <omp.h>
#include <stdio.h>
#include <string.h>

#include "base/mem.h"
#include "domain/element.h"
#include "solver/law.h"
#include "solver/selection.h"
#include "solver/step.h"
#include "solver/tile.h"

/* ---- Forces and energy of a state, which stays ---- */

/* The state of cracks, which an evaluation takes on: flags, and what the blocks with cracks remember. */
typedef struct {
    uint8_t *broken, *unlinked, *active, *cracked;
    rg_real *crack; /* [active blocks] */
} cracks;

static uint8_t *copy_flags(const uint8_t *from, size_t count) {
    uint8_t *flags = RG_NEW(uint8_t, count + 1);
    memcpy(flags, from, count);
    return flags;
}

static cracks keep_cracks(const rg_solver *s) {
    const rg_domain *d = s->domain;
    size_t stride = s->model->crack_stride, row = 0, active = 0;
    for (size_t b = 0; b < d->iblocks; b++) {
        active += s->active[b] != 0;
    }
    cracks c = {.broken = copy_flags(s->broken, d->iblocks * RG_LANES),
                .unlinked = copy_flags(s->unlinked, d->iblocks * RG_LANES),
                .active = copy_flags(s->active, d->iblocks),
                .cracked = copy_flags(s->cracked, d->blocks),
                .crack = RG_NEW(rg_real, active * stride + 1)};
    for (size_t b = 0; b < d->iblocks; b++) {
        if (s->active[b]) {
            memcpy(c.crack + row++ * stride, s->crack + b * stride, stride * sizeof *c.crack);
        }
    }
    return c;
}

static void give_back(uint8_t *flags, uint8_t *kept, size_t count) {
    memcpy(flags, kept, count);
    rg_free(kept);
}

/* Frees what was kept. */
static void restore_cracks(rg_solver *s, cracks *c) {
    const rg_domain *d = s->domain;
    size_t stride = s->model->crack_stride, row = 0;
    for (size_t b = 0; b < d->iblocks; b++) {
        if (c->active[b]) {
            memcpy(s->crack + b * stride, c->crack + row++ * stride, stride * sizeof *c->crack);
        } else if (s->active[b]) {
            memset(s->crack + b * stride, 0, stride * sizeof *c->crack);
        }
    }
    rg_free(c->crack);
    give_back(s->broken, c->broken, d->iblocks * RG_LANES);
    give_back(s->unlinked, c->unlinked, d->iblocks * RG_LANES);
    give_back(s->active, c->active, d->iblocks);
    give_back(s->cracked, c->cracked, d->blocks);
}

static void add_friction(rg_exact_sum *sum, const rg_solver *s, size_t i) {
    for (int q = 0; q < RG_POINTS && s->model->law.sliding == RG_SLIDING_COULOMB; q++) {
        if (s->broken[i] >> q & 1) {
            rg_exact_add(sum, *rg_friction_value(s, i, q, RG_FRICTION_HEAT));
        }
    }
}

/* Stored in the bulk and at faces, and dissipated at these. */
static void add_energy(rg_exact_sum *sum, rg_solver *s, const rg_tile *t, const rg_workspace *w,
                       double *energy) {
    rg_tile_receive(s, t, w);
    rg_tile_state(s, t, w, energy, NULL, NULL);
    for (size_t k = 0; k < rg_tile_eblocks(t) * RG_LANES; k++) {
        rg_exact_add(sum, energy[k]);
    }
    rg_interface_args interface = rg_tile_interfaces(s, t, w);
    s->kernels->interface_state(&(rg_interface_state_args){&interface, energy}, 0, rg_tile_iblocks(t));
    for (size_t i = t->ibegin * RG_LANES; i < t->iend * RG_LANES; i++) {
        for (size_t k = 0; s->domain->counted[i] && k < RG_E_INTERFACE; k++) {
            size_t row = i / RG_LANES - t->ibegin;
            rg_exact_add(sum, energy[(row * RG_E_INTERFACE + k) * RG_LANES + i % RG_LANES]);
        }
        if (s->domain->counted[i] && s->broken[i]) {
            add_friction(sum, s, i);
        }
    }
}

static double reduce(rg_exact_sum *sum, const rg_solver *s) {
    for (int t = 1; t < s->threads; t++) {
        rg_exact_merge(&sum[0], &sum[t]);
    }
    rg_exact_allreduce(&sum[0], 1, s->comm);
    double value = rg_exact_value(&sum[0]);
    rg_free(sum);
    return value;
}

/* Acceleration, which was 0, and energy of the displacement, with the faces that break there. */
static double forces_and_energy(rg_solver *s, rg_real *acceleration) {
    const rg_domain *d = s->domain;
    double stiffening = s->stiffening_anywhere;
    cracks before = keep_cracks(s);
    rg_solver_impulse(s, acceleration, 1);
    s->stiffening_anywhere = stiffening;
    rg_exact_sum *sum = RG_NEW(rg_exact_sum, (size_t)s->threads);
    size_t most = d->tile_iblocks * RG_E_INTERFACE;
    most = most > d->tile_blocks ? most : d->tile_blocks;
#pragma omp parallel
    {
        double *energy = RG_NEW(double, most *RG_LANES);
#pragma omp for schedule(static)
        for (size_t t = 0; t < d->tiles; t++) {
            int thread = omp_get_thread_num();
            add_energy(&sum[thread], s, &d->tile[t], &s->work[thread], energy);
        }
        rg_free(energy);
    }
    restore_cracks(s, &before);
    return reduce(sum, s);
}

/* v . M (a - b) */
static double power(const rg_solver *s, const rg_real *a, const rg_real *b) {
    const rg_domain *d = s->domain;
    rg_exact_sum *sum = RG_NEW(rg_exact_sum, (size_t)s->threads);
#pragma omp parallel for schedule(static)
    for (size_t slot = 0; slot < d->blocks * RG_LANES; slot++) {
        double mv[RG_NODES][3], here = 0;
        if (d->id[slot] < 0) {
            continue;
        }
        rg_mass_times(s->input->mass, rg_element_mass(d, s->model->material, slot), s->velocity, slot, mv);
        for (int n = 0; n < RG_NODES; n++) {
            for (int c = 0; c < 3; c++) {
                size_t k = rg_node_index(slot, n, c);
                here += mv[n][c] * ((double)a[k] - b[k]);
            }
        }
        rg_exact_add(&sum[omp_get_thread_num()], here);
    }
    return reduce(sum, s);
}

/* ---- Opening ---- */

static bool any_due(const rg_solver *s) {
    const rg_case *c = s->input;
    for (int i = 0; i < c->interface.sets; i++) {
        double at = c->interface.set[i].opens_at;
        if (at > s->openings.until && at <= s->time) {
            return true;
        }
    }
    return false;
}

void rg_openings_take(rg_solver *s) {
    if (!any_due(s)) {
        return;
    }
    size_t count = s->domain->blocks * RG_NODE_BLOCK;
    rg_real *before = RG_NEW(rg_real, count + 1), *after = RG_NEW(rg_real, count + 1);
    double energy = forces_and_energy(s, before);
    rg_law_open_until(s, s->time);
    energy -= forces_and_energy(s, after);
    s->openings.released += energy + 0.5 * s->dt * power(s, before, after);
    s->openings.until = s->time;
    rg_free(before);
    rg_free(after);
}

void rg_opening_describe(const rg_solver *s, int set, char *words, size_t size) {
    rg_selected on = {s->model->open_faces[set], s->model->open_area[set], ""};
    double at = s->input->interface.set[set].opens_at;
    char faces[200], when[40] = "from the start";
    if (at > 0) {
        snprintf(when, sizeof when, "at %.4g s", at);
    }
    rg_selected_tell(&on, false, faces, sizeof faces);
    snprintf(words, size, "of %s, %s", faces, when);
}
