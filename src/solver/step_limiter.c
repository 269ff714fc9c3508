#include "solver/step_limiter.h"

#include <math.h>

#include "solver/law.h"

double rg_tile_opening_rate(const rg_solver *s, const rg_tile *t) {
    rg_real most = 0;
    size_t values = s->model->crack_stride / RG_LANES, memory = RG_POINTS * RG_CRACK;
    for (size_t b = t->ibegin; b < t->iend; b++) {
        const rg_real *rows = s->crack + b * values * RG_LANES;
        for (size_t q = 0; q < RG_POINTS; q++) {
            const rg_real *opening_rate =
                rows + (memory + q * RG_LIMITER_MEMORY + RG_LIMITER_RATE) * RG_LANES;
            for (size_t l = 0; l < RG_LANES; l++) {
                most = opening_rate[l] > most ? opening_rate[l] : most;
            }
        }
    }
    return most;
}

void rg_step_limiter_agree(rg_solver *s) {
    s->opening_rate = 0;
    for (size_t t = 0; t < s->domain->tiles; t++) {
        s->opening_rate = fmax(s->opening_rate, s->tile_opening_rate[t]);
    }
    MPI_Allreduce(MPI_IN_PLACE, &s->opening_rate, 1, MPI_DOUBLE, MPI_MAX, s->comm);
}

/* max(xi N) for a step dt. */
static double wanted(const rg_solver *s, double dt) {
    return dt * s->opening_rate * rg_law_steps(&s->model->law);
}

double rg_limited_step(const rg_solver *s, double dt) {
    double parts = wanted(s, dt);
    return parts > 1 ? dt * exp2(-ceil(4 * log2(parts)) / 4) : dt;
}

bool rg_step_limiter_acts(const rg_solver *s) {
    return wanted(s, s->dt) > exp2(-0.25);
}
