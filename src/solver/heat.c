#include "solver/heat.h"

#include <math.h>
#include <omp.h>

#include "base/error.h"
#include "base/first_bad.h"
#include "base/mem.h"
#include "domain/element.h"
#include "solver/solver.h"
#include "solver/tile.h"

struct rg_heating {
    int threads;
    bool by_time;
    rg_expr **own; /* [threads] */
};

rg_heating *rg_heating_make(const rg_solver *s) {
    const rg_expr *value = s->input->temperature.value;
    if (value == NULL) {
        return NULL;
    }
    rg_heating *h = RG_NEW(rg_heating, 1);
    *h = (rg_heating){s->threads, rg_expr_uses_time(value), RG_NEW(rg_expr *, (size_t)s->threads)};
    for (int n = 0; n < h->threads; n++) {
        h->own[n] = rg_expr_copy(value);
    }
    return h;
}

void rg_heating_free(rg_heating *h) {
    for (int n = 0; h != NULL && n < h->threads; n++) {
        rg_expr_free(h->own[n]);
    }
    if (h != NULL) {
        rg_free(h->own);
    }
    rg_free(h);
}

static rg_real *value_of(const rg_solver *s, size_t slot, int row) {
    return &s->thermal[slot / RG_LANES * RG_THERMAL_BLOCK + (size_t)row * RG_LANES + slot % RG_LANES];
}

/* Expansion per kelvin of an element. */
static double expansion_of(const rg_solver *s, size_t slot) {
    const rg_material *m = rg_material_of(s, slot);
    return ((unsigned)RG_EXPANDING >> m->model & 1U) != 0 ? m->of.parameter[RG_PARAMETER_EXPANSION] : 0;
}

/* Expansion of an element, and the place where it is not finite. */
static void fill(rg_solver *s, const rg_expr *value, size_t slot, rg_first_bad *bad) {
    double expansion = s->domain->id[slot] >= 0 ? expansion_of(s, slot) : 0;
    for (int g = 0; g < RG_GAUSS && expansion > 0; g++) {
        double x[3];
        rg_gauss_position(s->domain->corner + 12 * slot, g, x);
        double kelvin = rg_expr_value(value, x, s->time);
        if (bad != NULL && !isfinite(kelvin)) {
            rg_first_bad_note(bad, 0, x, kelvin);
        }
        *value_of(s, slot, RG_THERMAL_EXPANSION + g) =
            (rg_real)(expansion * (kelvin - s->input->temperature.free));
    }
}

void rg_heating_start(rg_solver *s) {
    rg_first_bad bad = {.which = RG_NOWHERE};
    if (s->heating == NULL) {
        return;
    }
    for (size_t slot = 0; slot < s->domain->blocks * RG_LANES; slot++) {
        fill(s, s->heating->own[0], slot, &bad);
        for (int g = 0; g < RG_GAUSS; g++) {
            *value_of(s, slot, RG_THERMAL_LAST + g) = *value_of(s, slot, RG_THERMAL_EXPANSION + g);
        }
    }
    if (rg_first_bad_lowest(&bad, s->comm)) {
        rg_speak(s->comm);
        rg_fatal(RG_USAGE, "%s: temperature.value: %s is not finite at (%g, %g, %g)", s->input->path,
                 rg_expr_text(s->input->temperature.value), bad.x[0], bad.x[1], bad.x[2]);
    }
}

void rg_heating_tile(rg_solver *s, size_t tile) {
    const rg_tile *t = &s->domain->tile[tile];
    if (s->heating == NULL || !s->heating->by_time) {
        return;
    }
    const rg_expr *own = s->heating->own[omp_get_thread_num()];
    for (size_t slot = t->begin * RG_LANES; slot < t->end * RG_LANES; slot++) {
        fill(s, own, slot, NULL);
    }
}

double rg_heating_temperature(const rg_solver *s, size_t slot) {
    const rg_expr *own = s->heating->own[omp_get_thread_num()];
    double sum = 0;
    for (int g = 0; g < RG_GAUSS; g++) {
        double x[3];
        rg_gauss_position(s->domain->corner + 12 * slot, g, x);
        sum += rg_expr_value(own, x, s->time);
    }
    return sum / RG_GAUSS;
}

double rg_heating_scale(const rg_solver *s) {
    const rg_domain *d = s->domain;
    rg_exact_sum sum = {0};
    for (size_t slot = 0; s->thermal != NULL && slot < d->blocks * RG_LANES; slot++) {
        double square = 0;
        for (int g = 0; g < RG_GAUSS && d->id[slot] >= 0; g++) {
            const rg_material *m = rg_material_of(s, slot);
            double stress = (3 * m->lambda + 2 * m->mu) * *value_of(s, slot, RG_THERMAL_EXPANSION + g);
            square += 3 * 0.25 * stress * stress;
        }
        if (square > 0) {
            double side = cbrt(d->geom[rg_geom_index(slot, RG_GEOM_VOLUME)]);
            rg_exact_add(&sum,
                         square * side * side * side * side / rg_element_mass(d, s->model->material, slot));
        }
    }
    rg_exact_allreduce(&sum, 1, s->comm);
    return sqrt(rg_exact_value(&sum));
}
