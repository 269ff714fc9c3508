#include "solver/balance.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "partition/tile_weight.h"

enum { LOOK = 100 }; /* steps between looks: what one of them measures is steady within some per cent */

/* An even partition saves time, a new one takes some that is known from the last one alone. */
#define WORTH 2

static double work_of(const rg_solver *s) {
    const double *seconds = s->phases.seconds;
    return seconds[RG_PHASE_COMPUTE] + seconds[RG_PHASE_JUMP] + seconds[RG_PHASE_PACK];
}

/* What tiles took so far, set-up included, is not asked for any more. */
static void forget(rg_solver *s) {
    if (s->tile_seconds != NULL) {
        memset(s->tile_seconds, 0, s->domain->tiles * sizeof *s->tile_seconds);
    }
}

void rg_balance_start(rg_balance *b, rg_solver *s, bool repartitioned) {
    *b = (rg_balance){.level = repartitioned ? 0 : 1, .now = 1, .spent = work_of(s), .step = s->step};
    forget(s);
}

/* The most over the mean, of the work since the last look. */
static double unevenness(rg_balance *b, const rg_solver *s) {
    double here = work_of(s) - b->spent, most, sum;
    MPI_Allreduce(&here, &most, 1, MPI_DOUBLE, MPI_MAX, s->comm);
    MPI_Allreduce(&here, &sum, 1, MPI_DOUBLE, MPI_SUM, s->comm);
    b->spent += here;
    return most * s->ranks / fmax(sum, DBL_MIN);
}

bool rg_balance_pays(rg_balance *b, rg_solver *s, double cost, double left) {
    double limit = s->input->mesh.rebalance;
    if (s->tile_seconds == NULL || s->step < b->step + LOOK) {
        return false;
    }
    b->now = unevenness(b, s);
    b->step = s->step;
    if (b->level == 0) {
        b->level = b->now;
    }
    int pays = limit < 1 || (b->now > limit * b->level && (1 - b->level / b->now) * left > WORTH * cost);
    MPI_Bcast(&pays, 1, MPI_INT, 0, s->comm);
    if (!pays) {
        forget(s);
    }
    return pays;
}

double *rg_balance_costs(const rg_solver *s) {
    const rg_part *part = s->part;
    size_t all = (size_t)((part->total + part->tile - 1) / part->tile);
    double *cost = RG_NEW(double, all), mean = 0;
    for (rg_lid t = 0; t < part->tiles; t++) {
        cost[part->tile_id[t]] = s->tile_seconds[t];
    }
    cost = rg_tile_weights_gather(cost, (int64_t)all, s->comm);
    if (cost == NULL) {
        return NULL;
    }
    for (size_t t = 0; t < all; t++) {
        mean += cost[t] / (double)all;
    }
    for (size_t t = 0; t < all; t++) { /* a clock too coarse for a small tile */
        cost[t] = fmax(cost[t], 0.01 * mean + DBL_MIN);
    }
    return cost;
}
