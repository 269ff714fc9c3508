#include "support/face_bench.h"

#include <math.h>
#include <string.h>

#include "cohesive/facts.h"

enum { MINUS_FACE = 3, PLUS_FACE = 1 };

/* Row of the other side of tile-boundary face i. */
static size_t other_row(size_t i) {
    return RG_LANES + (i + 3) % RG_LANES;
}

static void bench_link(face_bench *b, size_t i) {
    const int32_t minus = rg_side_link(0, MINUS_FACE), plus = rg_side_link(1, PLUS_FACE);
    b->side[0][i] = b->view == FROM_PLUS ? plus : minus;
    b->side[1][i] = b->view == INSIDE ? plus : rg_link(other_row(i), b->view == FROM_PLUS, 2);
}

static size_t stride_of(const rg_cohesive *law) {
    int memory = rg_law_facts_of(law->law, law->shape, law->beta).memory;
    return RG_CRACK_BLOCK + (size_t)memory * RG_POINTS * RG_LANES +
           (law->shear == RG_SHEAR_FADING ? RG_BOND_BLOCK : 0) + (law->rise.rate > 0 ? RG_RISE_BLOCK : 0) +
           (law->criterion == RG_CRITERION_MOHR_COULOMB ? RG_LOAN_BLOCK : 0) +
           (law->sliding == RG_SLIDING_COULOMB ? RG_FRICTION_BLOCK : 0);
}

void face_bench_make(face_bench *b, rg_cohesive law, double up, face_view v) {
    memset(b, 0, sizeof *b);
    b->view = v;
    for (size_t i = 0; i < RG_LANES; i++) {
        bench_link(b, i);
        b->geom[rg_igeom_index(i, RG_IGEOM_PEN_ISO)] = (rg_real)(FACE_BENCH_AREA * FACE_BENCH_ISO);
        b->geom[rg_igeom_index(i, RG_IGEOM_PEN_NORM)] = (rg_real)(FACE_BENCH_NORM / FACE_BENCH_AREA);
        b->geom[rg_igeom_index(i, RG_IGEOM_EDGE + (up > 0 ? 0 : 1))] = (rg_real)FACE_BENCH_SIDE;
        b->geom[rg_igeom_index(i, RG_IGEOM_EDGE + (up > 0 ? 4 : 3))] = (rg_real)FACE_BENCH_SIDE;
    }
    b->args = (rg_interface_args){
        .law = law,
        .time = FACE_BENCH_TIME,
        .u = b->u,
        .traction = b->traction,
        .first_tile_face = v == INSIDE ? 1 : 0,
        .ghost = b->ghost,
        .own_tractions = b->rows,
        .tractions = b->rows,
        .side = {b->side[0], b->side[1]},
        .geom = b->geom,
        .broken = b->broken,
        .unlinked = b->unlinked,
        .active = &b->active,
        .crack = b->crack,
        .crack_stride = stride_of(&law),
        .force = b->force,
        .turn = b->turn,
    };
}

void face_bench_load(face_bench *b, const double pull[3], const double jump[3]) {
    for (int k = 0; k < RG_FCORNERS * 3; k++) {
        b->traction[rg_traction_index(0, MINUS_FACE, k / 3, k % 3)] =
            (rg_real)(FACE_BENCH_AREA * pull[k % 3]);
        b->traction[rg_traction_index(1, PLUS_FACE, k / 3, k % 3)] =
            (rg_real)(-FACE_BENCH_AREA * pull[k % 3]);
    }
    for (int k = 0; k < RG_FNODES * 3; k++)
        b->u[rg_node_index(1, rg_face_node[PLUS_FACE][k / 3], k % 3)] += (rg_real)jump[k % 3];
}

void face_bench_deform(face_bench *b, const double g[3][3]) {
    static const double xy[RG_FNODES][2] = {{0, 0}, {1, 0}, {0, 1}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}};
    for (int k = 0; k < RG_FNODES * 3; k++) {
        const double *x = xy[k / 3];
        double moved = FACE_BENCH_SIDE * (g[k % 3][0] * x[0] + g[k % 3][1] * x[1]);
        double u = moved - (k % 3 < 2 ? FACE_BENCH_SIDE * x[k % 3] : 0);
        b->u[rg_node_index(0, rg_face_node[MINUS_FACE][k / 3], k % 3)] = (rg_real)u;
        b->u[rg_node_index(1, rg_face_node[PLUS_FACE][k / 3], k % 3)] = (rg_real)u;
    }
}

/* What a tile-boundary face knows of both sides. The kernel must take all of it from here: the other side's
 * own fields are spoiled. */
static void bench_exchange(face_bench *b) {
    const size_t own = b->view == FROM_PLUS, other = 1 - own;
    const int face[2] = {MINUS_FACE, PLUS_FACE};
    rg_real *trace = &b->u[rg_node_index(other, 0, 0)], u[RG_FNODES][3];
    for (int k = 0; k < RG_FNODES * 3; k++)
        u[k / 3][k % 3] = b->u[rg_node_index(other, rg_face_node[face[other]][k / 3], k % 3)];
    for (int k = 0; k < RG_NODES * 3; k++)
        trace[k * RG_LANES] = NAN;
    for (size_t i = 0; i < RG_LANES; i++) {
        for (int k = 0; k < RG_FNODES * 3; k++)
            b->ghost[rg_iforce_index(i, k / 3, k % 3)] = u[k / 3][k % 3];
        memcpy(b->rows + i * RG_TILE_FACE_ROW, &b->traction[rg_traction_index(own, face[own], 0, 0)],
               RG_TILE_FACE_ROW * sizeof(rg_real));
        memcpy(b->rows + other_row(i) * RG_TILE_FACE_ROW,
               &b->traction[rg_traction_index(other, face[other], 0, 0)], RG_TILE_FACE_ROW * sizeof(rg_real));
    }
    for (int k = 0; k < RG_TRACTION_BLOCK; k++)
        b->traction[k] = NAN;
}

void face_bench_run(face_bench *b, const rg_kernels *set) {
    if (b->view != INSIDE)
        bench_exchange(b);
    set->interface(&b->args, 0, 1);
    set->interface_state(&(rg_interface_state_args){&b->args, b->energy}, 0, 1);
}
