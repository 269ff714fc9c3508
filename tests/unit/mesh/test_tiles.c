/* Tiles: their graph, partitions of it and who gets which, against plain loops over elements and tiles. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <metis.h>

#include "base/error.h"
#include "base/mem.h"
#include "case/expr.h"
#include "mesh/gid_map.h"
#include "mesh/tile_graph.h"
#include "partition/distribution.h"
#include "partition/tile_weight.h"
#include "support/dice.h"
#include "support/mesh_text.h"

enum { MOST = 80 };

static rg_mesh *make(void) {
    const int64_t cells[3] = {4, 3, 5};
    const double origin[3] = {0.5, -1, 2}, size[3] = {2, 3, 4};
    return rg_mesh_box(cells, origin, size, 0.1, 2);
}

/* ---- graph ---- */

static void test_graph(void **state) {
    (void)state;
    rg_mesh *m = make();
    for (int tile = 5; tile <= 400; tile = tile * 2 + 3) {
        int tiles = (int)(m->elements + tile - 1) / tile, shared[MOST][MOST] = {{0}};
        rg_tile_graph *g = rg_tile_graph_make(m, tile);
        assert_true(g->elements == 360 && g->tile == tile && g->tiles == tiles && g->weight == NULL);
        for (rg_gid s = 0; s < 4 * m->elements; s++) {
            if (m->neighbour[s] >= 0) {
                shared[s / 4 / tile][m->neighbour[s] / tile]++;
            }
        }
        int64_t at = 0;
        for (int t = 0; t < tiles; t++) {
            assert_int_equal(g->start[t], at);
            for (int u = 0; u < tiles; u++) {
                if (u != t && shared[t][u] > 0) {
                    assert_int_equal(g->neighbour[at], u);
                    assert_int_equal(g->faces[at++], shared[t][u]);
                }
            }
        }
        assert_int_equal(g->start[tiles], at);
        rg_tile_graph_free(g);
    }
    rg_mesh_free(m);
}

/* Every measure of a partition from pairs of elements. */
static void check_quality(const rg_mesh *m, rg_tile_graph *g, int parts, const int32_t *part) {
    double size[MOST] = {0}, cost[MOST] = {0}, most = 0, dearest = 0, all = 0;
    bool beside[MOST][MOST] = {{false}};
    int64_t cut = 0;
    int neighbours = 0, widest = 0;
    for (rg_gid s = 0; s < 4 * m->elements; s++) {
        int here = part[s / 4 / g->tile],
            there = m->neighbour[s] < 0 ? here : part[m->neighbour[s] / g->tile];
        size[here] += 0.25;
        cut += here != there && m->neighbour[s] > s / 4;
        beside[here][there] = true;
    }
    for (int64_t t = 0; t < g->tiles; t++) {
        cost[part[t]] += g->weight != NULL ? g->weight[t] : 0;
        all += g->weight != NULL ? g->weight[t] : 0;
    }
    for (int p = 0; p < parts; p++) {
        int here = 0;
        for (int q = 0; q < parts; q++) {
            here += p != q && beside[p][q];
        }
        neighbours += here;
        widest = here > widest ? here : widest;
        most = fmax(most, size[p]);
        dearest = fmax(dearest, cost[p]);
    }
    rg_partition_quality q = rg_tile_graph_quality(g, parts, part);
    double imbalance = most * parts / (double)m->elements;
    assert_true(fabs(q.imbalance - imbalance) < 1e-14 * imbalance);
    assert_true(fabs(q.cost_imbalance - (g->weight != NULL ? dearest * parts / all : imbalance)) <
                1e-14 * parts);
    assert_int_equal(q.cut_faces, cut);
    assert_int_equal(q.neighbours_max, widest);
    assert_true(fabs(q.neighbours_mean - (double)neighbours / parts) < 1e-14);
}

static void test_quality(void **state) {
    (void)state;
    rg_mesh *m = make();
    rg_tile_graph *g = rg_tile_graph_make(m, 7); /* 52 tiles, the last of 3 */
    dice d = {.seed = 1};
    int32_t part[MOST];
    for (int parts = 1; parts <= 20; parts++) {
        for (int64_t t = 0; t < g->tiles; t++) {
            part[t] = t < parts ? (int32_t)t : (int32_t)(parts * dice_unit(&d) * dice_unit(&d));
        }
        part[51] = parts - 1;
        check_quality(m, g, parts, part);
        g->weight = RG_NEW(double, (size_t)g->tiles);
        for (int64_t t = 0; t < g->tiles; t++) {
            g->weight[t] = dice_power(&d, -1, 2);
        }
        check_quality(m, g, parts, part);
        rg_free(g->weight);
        g->weight = NULL;
    }
    rg_tile_graph_free(g);
    rg_mesh_free(m);
}

/* ---- partitions ---- */

/* What the slowest part has to do, in elements of the mean cost, with half an element for each face to
 * others. */
static double slowest(const rg_tile_graph *g, int parts, const int32_t *part) {
    double work[MOST] = {0}, all = 0, most = 0;
    for (int64_t t = 0; t < g->tiles; t++) {
        all += g->weight != NULL ? g->weight[t] : 0;
    }
    for (int64_t t = 0; t < g->tiles; t++) {
        rg_gid left = g->elements - t * g->tile;
        work[part[t]] += g->weight != NULL ? g->weight[t] * (double)g->elements / all
                                           : (double)(left < g->tile ? left : g->tile);
        for (int64_t i = g->start[t]; i < g->start[t + 1]; i++) {
            work[part[t]] += part[g->neighbour[i]] != part[t] ? 0.5 * g->faces[i] : 0;
        }
    }
    for (int p = 0; p < parts; p++) {
        most = fmax(most, work[p]);
    }
    return most;
}

/* No part is empty, all have numbers in the order of their tiles, and cutting the curve into runs of equal
 * work is not better by much. Weights that differ by factors are met, of whatever size they are. */
static void check_partition(const rg_tile_graph *g, int parts, double worse) {
    int32_t part[MOST], run[MOST];
    double mean[MOST] = {0}, count[MOST] = {0}, all = 0, so_far = 0;
    rg_tile_graph_partition(g, parts, part);
    for (int64_t t = 0; t < g->tiles; t++) {
        assert_true(part[t] >= 0 && part[t] < parts);
        mean[part[t]] += (double)t;
        count[part[t]]++;
        all += g->weight != NULL ? g->weight[t] : 1;
    }
    for (int p = 0; p < parts; p++) {
        assert_true(count[p] >= 1);
        assert_true(p == 0 || mean[p - 1] / count[p - 1] <= mean[p] / count[p]);
    }
    for (int64_t t = 0; t < g->tiles; t++) {
        double here = g->weight != NULL ? g->weight[t] : 1;
        run[t] = (int32_t)fmin(parts - 1, floor((so_far + here / 2) / all * parts));
        so_far += here;
    }
    assert_true(slowest(g, parts, part) < worse * slowest(g, parts, run));
}

static void test_partition(void **state) {
    (void)state;
    rg_mesh *m = make();
    rg_tile_graph *g = rg_tile_graph_make(m, 5);
    for (int parts = 1; parts <= 6; parts++) {
        check_partition(g, parts, 1.1);
    }
    check_partition(g, 72, 1.0001); /* each tile a part */
    for (int power = -200; power <= 200; power += 100) {
        g->weight = RG_NEW(double, (size_t)g->tiles);
        for (int64_t t = 0; t < g->tiles; t++) {
            g->weight[t] = (t < 18 ? 3 : 1) * pow(10, power);
        }
        int32_t part[MOST];
        rg_tile_graph_partition(g, 2, part);
        double cost = rg_tile_graph_quality(g, 2, part).cost_imbalance;
        assert_true(cost < 1.06);
        check_partition(g, 3, 1.1);
        rg_free(g->weight);
        g->weight = NULL;
    }
    rg_tile_graph_free(g);
    rg_mesh_free(m);
}

static rg_tile_graph *few;

static void too_many(void) {
    int32_t part[MOST];
    rg_tile_graph_partition(few, 4, part);
}

static void test_too_many_parts(void **state) {
    (void)state;
    rg_mesh *m = make();
    int32_t part[3];
    few = rg_tile_graph_make(m, 120);
    rg_tile_graph_partition(few, 3, part);
    assert_true(part[0] == 0 && part[1] == 1 && part[2] == 2);
    expect_said(
        too_many, RG_USAGE,
        "rhegma: 4 ranks are too many for a mesh of 360 elements in 3 tiles: each needs at least one tile\n");
    rg_tile_graph_free(few);
    rg_mesh_free(m);
}

/* ---- distributions ---- */

static void test_distribution(void **state) {
    (void)state;
    enum { RANKS = 4 };
    rg_mesh *m = make();
    rg_tile_graph *g = rg_tile_graph_make(m, 7);
    dice d = {.seed = 4};
    for (int n = 0; n < 20; n++) {
        int32_t *owner = RG_NEW(int32_t, (size_t)g->tiles);
        for (int64_t t = 0; t < g->tiles; t++) { /* runs, so that some tiles are inside */
            owner[t] = t > 0 && dice_unit(&d) < 0.8 ? owner[t - 1] : (int32_t)(RANKS * dice_unit(&d));
        }
        rg_distribution *distribution = rg_distribution_make(g, owner, RANKS);
        assert_true(distribution->ranks == RANKS && distribution->elements == 360 &&
                    distribution->tile == 7 && distribution->tiles == 52 && distribution->owner == owner);
        rg_partition_quality q = rg_tile_graph_quality(g, RANKS, owner);
        assert_true(distribution->quality.cut_faces == q.cut_faces &&
                    distribution->quality.neighbours_max == q.neighbours_max);
        int64_t at = 0;
        for (int r = 0; r < RANKS; r++) {
            assert_int_equal(distribution->start[r], at);
            for (int inner = 0; inner < 2; inner++) {
                for (int64_t t = 0; t < g->tiles; t++) {
                    bool shared = false;
                    for (rg_gid s = 28 * t; s < 28 * (t + 1) && s < 4 * m->elements; s++) {
                        shared = shared || (m->neighbour[s] >= 0 && owner[m->neighbour[s] / 7] != owner[t]);
                    }
                    if (owner[t] == r && shared == (inner == 0)) {
                        assert_int_equal(distribution->list[at++], t);
                    }
                }
                if (inner == 0) {
                    assert_int_equal(distribution->shared[r], at - distribution->start[r]);
                }
            }
        }
        assert_true(at == 52 && distribution->start[RANKS] == 52);
        rg_distribution_free(distribution);
    }
    rg_tile_graph_free(g);
    rg_mesh_free(m);
}

/* A mesh of so many tiles of 256 on one of two ranks. */
static int64_t heavy;

static void distribute_many(void) {
    rg_tile_graph g = {.elements = 256 * (heavy + 1), .tile = 256, .tiles = heavy + 1};
    g.start = rg_alloc((size_t)g.tiles + 1, sizeof *g.start);
    g.neighbour = rg_alloc(1, sizeof *g.neighbour);
    int32_t *owner = RG_NEW(int32_t, (size_t)g.tiles);
    owner[heavy] = 1;
    rg_distribution_free(rg_distribution_make(&g, owner, 2));
}

static void test_most_elements_of_a_rank(void **state) {
    (void)state;
    heavy = (1 << 29) / 256;
    expect_said(distribute_many, RG_OK, "");
    heavy++;
    expect_said(
        distribute_many, RG_USAGE,
        "rhegma: mesh: 536871168 elements on one rank, at most 536870912 are possible: use more ranks\n");
}

/* ---- weights ---- */

static rg_case weighed;

static void set_weight(const char *text) {
    static char path[] = "a.yaml";
    char *message = NULL;
    weighed = (rg_case){.path = path};
    weighed.mesh.weight = rg_expr_new(text, &message);
    assert_non_null(weighed.mesh.weight);
}

static rg_mesh *regular; /* made before the fork: a child has no threads to sort it */

static void weigh_bad(void) {
    rg_tile_weights_of_mesh(&weighed, regular, 7);
}

static void test_weights(void **state) {
    (void)state;
    rg_mesh *m = make();
    set_weight("1 + 2*x*x + 3*abs(y) + z");
    double *found = rg_tile_weights_of_mesh(&weighed, m, 7), sum[52] = {0};
    for (rg_gid e = 0; e < m->elements; e++) {
        double x[3] = {0, 0, 0};
        for (int k = 0; k < 12; k++) {
            x[k % 3] += m->x[3 * m->corner[4 * e + k / 3] + k % 3] / 4;
        }
        sum[e / 7] += 1 + 2 * x[0] * x[0] + 3 * fabs(x[1]) + x[2];
    }
    for (int t = 0; t < 52; t++) {
        assert_true(fabs(found[t] - sum[t]) < 1e-14 * sum[t]);
    }
    rg_free(found);
    rg_expr_free(weighed.mesh.weight);
    rg_mesh_free(m);
    /* Centroids of regular tetrahedra: the lowest of the places where it is not positive is told. */
    static const struct {
        const char *weight, *said;
    } bad[] = {{"0", "0 is 0 at (0.625, -0.5, 2.6)"},
               {"1e-310*x", "1e-310*x is 6.25e-311 at (0.625, -0.5, 2.6)"},
               {"x-0.75", "x-0.75 is -0.125 at (0.625, -0.5, 2.6)"},
               {"1e308*x*y*y*100", "1e308*x*y*y*100 is inf at (0.625, -0.5, 2.6)"},
               {"1/(y-y)", "1/(y-y) is inf at (0.625, -0.5, 2.6)"}};
    const int64_t cells[3] = {4, 3, 5};
    const double origin[3] = {0.5, -1, 2}, size[3] = {2, 3, 4};
    regular = rg_mesh_box(cells, origin, size, 0, 2);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char said[200];
        set_weight(bad[i].weight);
        snprintf(said, sizeof said, "rhegma: a.yaml: mesh.weight: %s; allowed: numbers > 0\n", bad[i].said);
        expect_said(weigh_bad, RG_USAGE, said);
        rg_expr_free(weighed.mesh.weight);
    }
    rg_mesh_free(regular);
}

/* ---- METIS refuses ---- */

static int refusal = METIS_OK; /* what METIS returns in place of a partition */

#define REFUSES(method)                                                                                      \
    int __real_##method(idx_t *, idx_t *, idx_t *, idx_t *, idx_t *, idx_t *, idx_t *, idx_t *, real_t *,    \
                        real_t *, idx_t *, idx_t *, idx_t *);                                                \
    int __wrap_##method(idx_t *, idx_t *, idx_t *, idx_t *, idx_t *, idx_t *, idx_t *, idx_t *, real_t *,    \
                        real_t *, idx_t *, idx_t *, idx_t *);                                                \
    int __wrap_##method(idx_t *n, idx_t *c, idx_t *start, idx_t *edge, idx_t *weight, idx_t *size,           \
                        idx_t *faces, idx_t *parts, real_t *share, real_t *excess, idx_t *options,           \
                        idx_t *cut, idx_t *part) {                                                           \
        return refusal != METIS_OK ? refusal                                                                 \
                                   : __real_##method(n, c, start, edge, weight, size, faces, parts, share,   \
                                                     excess, options, cut, part);                            \
    }
REFUSES(METIS_PartGraphKway)
REFUSES(METIS_PartGraphRecursive)

static rg_tile_graph *refused; /* made by the parent: a child has none of its threads */

static void partition_refused(void) {
    int32_t part[MOST];
    rg_tile_graph_partition(refused, 3, part);
}

static void test_refusal(void **state) {
    (void)state;
    const char *words = "rhegma: METIS could not partition 12 tiles for 3 ranks: ";
    char said[200];
    rg_mesh *m = make();
    refused = rg_tile_graph_make(m, 30);
    for (int k = 0; k < 2; k++) {
        refusal = k == 0 ? METIS_ERROR_MEMORY : METIS_ERROR;
        snprintf(said, sizeof said, "%s%s\n", words, k == 0 ? "out of memory" : "internal error");
        expect_said(partition_refused, RG_FAILURE, said);
    }
    refusal = METIS_OK;
    rg_tile_graph_free(refused);
    rg_mesh_free(m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_graph),        cmocka_unit_test(test_quality),
        cmocka_unit_test(test_partition),    cmocka_unit_test(test_too_many_parts),
        cmocka_unit_test(test_distribution), cmocka_unit_test(test_most_elements_of_a_rank),
        cmocka_unit_test(test_weights),      cmocka_unit_test(test_refusal),
    };
    int failed = cmocka_run_group_tests_name("tiles", tests, NULL, NULL);
    return failed + (rg_alloc_blocks() > 0); /* all is given back */
}
