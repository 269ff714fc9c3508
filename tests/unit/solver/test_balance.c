/* Whether it pays to repartition, from what ranks and tiles have spent, on any number of ranks. Prints TAP
 * from rank 0. */
#include <math.h>
#include <mpi.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "base/mem.h"
#include "solver/balance.h"
#include "support/tap_memory.h"

enum { TILES = 3 }; /* of each rank */

static int ranks;
static rg_case input;
static rg_domain domain = {.tiles = TILES};
static double tile_seconds[TILES];
static rg_solver s;

/* So much more work of this rank; what it waits for is none. */
static void spend(double seconds) {
    const double share[RG_PHASES] = {[RG_PHASE_COMPUTE] = 0.5 * seconds,
                                     [RG_PHASE_JUMP] = 0.375 * seconds,
                                     [RG_PHASE_PACK] = 0.125 * seconds,
                                     [RG_PHASE_EXCHANGE] = 100,
                                     [RG_PHASE_WAIT] = 200,
                                     [RG_PHASE_REDUCE] = 400};
    for (int p = 0; p < RG_PHASES; p++) {
        s.phases.seconds[p] += share[p];
    }
}

static void set_tiles(double seconds) {
    for (int t = 0; t < TILES; t++) {
        tile_seconds[t] = seconds;
    }
}

static bool tiles_hold(double seconds) {
    bool good = true;
    for (int t = 0; t < TILES; t++) {
        good = good && tile_seconds[t] == seconds;
    }
    return good;
}

static void begin(double limit) {
    input = (rg_case){.mesh.rebalance = limit};
    s = (rg_solver){.input = &input,
                    .comm = MPI_COMM_WORLD,
                    .rank = rank,
                    .ranks = ranks,
                    .domain = &domain,
                    .tile_seconds = tile_seconds,
                    .step = 50};
    spend(16 + 16 * rank);
    set_tiles(7);
}

static bool near(double a, double b) {
    return fabs(a - b) < 1e-12 * fabs(b);
}

/* Asks at a step, after another 1, 2, 3, ... seconds of the ranks; rank 0 alone knows cost and what is left.
 */
static bool ask(rg_balance *b, int64_t step, double cost, double left) {
    s.step = step;
    spend(1 + rank);
    set_tiles(3);
    return rg_balance_pays(b, &s, rank == 0 ? cost : 1e9, rank == 0 ? left : 0);
}

static void check_looks(void) {
    double most = ranks, mean = (1 + ranks) / 2.0, uneven = most / mean, cost = 0.5;
    double enough = 2 * cost / (1 - 1 / uneven); /* seconds left that pay: infinite on one rank */
    rg_balance b;
    begin(1.1);
    rg_balance_start(&b, &s, false);
    report(b.level == 1 && b.now == 1 && b.step == 50 && near(b.spent, 16 + 16 * rank) && tiles_hold(0),
           "start", "the first partition counts as even");
    set_tiles(5);
    s.step = 149;
    report(!rg_balance_pays(&b, &s, 0, 1e9) && b.step == 50 && tiles_hold(5), "looks",
           "not before a hundred steps");
    report(ask(&b, 150, cost, ranks > 1 ? 1.01 * enough : 1e9) == (ranks > 1) && near(b.now, uneven) &&
               b.level == 1 && b.step == 150 && near(b.spent, 17 + 17 * rank) &&
               tiles_hold(ranks > 1 ? 3 : 0),
           "looks", "uneven: the most over the mean since the last look, and it pays");
    report(!ask(&b, 249, cost, 1e9) && tiles_hold(3), "looks", "not again before a hundred more");
    report(!ask(&b, 250, cost, ranks > 1 ? 0.99 * enough : 1e9) && near(b.now, uneven) && tiles_hold(0),
           "looks", "it does not pay for the little that is left");
    input.mesh.rebalance = 1.01 * uneven;
    report(!ask(&b, 350, cost, 1e9) && near(b.now, uneven), "looks", "less uneven than is asked for");
    input.mesh.rebalance = 0.99;
    report(ask(&b, 450, 1e9, 0) && tiles_hold(3), "looks", "no reason is asked for");
}

/* What a partition by measured costs could not even out is not held against it. */
static void check_level(void) {
    double uneven = 2.0 * ranks / (1 + ranks);
    rg_balance b;
    begin(1.1);
    rg_balance_start(&b, &s, true);
    report(b.level == 0, "level", "not known yet");
    report(!ask(&b, 150, 0, 1e9) && near(b.level, uneven) && near(b.now, uneven), "level",
           "taken at the first look");
    s.step = 240; /* a little worse: more than the limit, but not on top of the level */
    b.step = 140;
    spend(1 + rank + (rank == ranks - 1 ? 0.1 : 0));
    report(!rg_balance_pays(&b, &s, 0, 1e9) && (ranks == 1 || (b.now > 1.1 && b.now > uneven)), "level",
           "a little more does not");
    s.step = 340;
    spend(rank == ranks - 1 ? 100 : 1);
    double worse = 100.0 * ranks / (99 + ranks), cost = 3, enough = 2 * cost / (1 - uneven / worse);
    bool just = rg_balance_pays(&b, &s, cost, 1.01 * enough);
    report(just == (ranks > 1) && near(b.now, worse) && near(b.level, uneven), "level",
           "what came on top of it pays");
    s.step = 440;
    spend(rank == ranks - 1 ? 100 : 1);
    report(!rg_balance_pays(&b, &s, cost, ranks > 1 ? 0.99 * enough : 1), "level", "or not");
    s.tile_seconds = NULL;
    report(!rg_balance_pays(&b, &s, 0, 1e9), "level", "nobody asks where tiles are not measured");
    rg_balance_start(&b, &s, true);
    report(b.step == 440, "level", "nor are they forgotten then");
}

/* Of tiles of 5 elements, of which the last has 1 or 5. */
static void check_costs(int last) {
    rg_gid own[TILES];
    rg_part part = {
        .tile = 5, .total = 5 * (rg_gid)(TILES * ranks - 1) + last, .tiles = TILES, .tile_id = own};
    begin(1.1);
    s.part = &part;
    double all = 0;
    for (int t = 0; t < TILES; t++) {
        own[t] = (rg_gid)t * ranks + (t % 2 == 0 ? rank : ranks - 1 - rank);
        tile_seconds[t] = own[t] == 1 ? 0 : (double)(own[t] * own[t]) + 2;
    }
    for (int k = 0; k < TILES * ranks; k++) {
        all += k == 1 ? 0 : k * k + 2;
    }
    double *cost = rg_balance_costs(&s);
    bool good = (cost != NULL) == (rank == 0);
    for (int k = 0; rank == 0 && k < TILES * ranks; k++) {
        good = good && near(cost[k], k == 1 ? 0.01 * all / (TILES * ranks) : k * k + 2);
    }
    report(good, "costs", "of all tiles on rank 0, none of them nothing");
    rg_free(cost);
    set_tiles(0);
    cost = rg_balance_costs(&s);
    report(rank > 0 || (cost[0] > 0 && cost[TILES * ranks - 1] > 0), "costs", "even where no clock ticked");
    rg_free(cost);
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    check_looks();
    check_level();
    check_costs(1);
    check_costs(5);
    return finish_with_nothing_left();
}
