/* One flat face under a uniform traction and jump: what the interface kernels do at a point, inside a tile
 * and as a tile-boundary face seen from either side. */
#ifndef RG_TEST_FACE_BENCH_H
#define RG_TEST_FACE_BENCH_H

#include "kernels.h"

#define FACE_BENCH_SIDE 2e-4                                    /* legs of the face (m) */
#define FACE_BENCH_AREA (FACE_BENCH_SIDE * FACE_BENCH_SIDE / 2) /* m^2 */
#define FACE_BENCH_ISO  5e15                                    /* penalty per area (Pa/m) */
#define FACE_BENCH_NORM 1.5e16
#define FACE_BENCH_TIME 2.5e-7

enum {
    FACE_BENCH_ALL = 63, /* points */
    FACE_BENCH_CRACK = RG_CRACK_BLOCK + RG_LAW_MEMORY * RG_POINTS * RG_LANES + RG_BOND_BLOCK + RG_LOAN_BLOCK +
                       RG_RISE_BLOCK + RG_FRICTION_BLOCK,
};

/* How the kernel sees the face. */
typedef enum { INSIDE, FROM_MINUS, FROM_PLUS, VIEWS } face_view;

/* One block of interfaces, all between a face of element 0 and one of element 1. As
 * tile-boundary faces they have the first rows of tractions, the other side the last ones. */
typedef struct {
    face_view view;
    _Alignas(64) rg_real u[RG_NODE_BLOCK], traction[RG_TRACTION_BLOCK], geom[RG_IGEOM_BLOCK];
    _Alignas(64) rg_real crack[FACE_BENCH_CRACK], force[RG_IFORCE_BLOCK], turn[RG_IFORCE_BLOCK];
    double energy[RG_E_INTERFACE * RG_LANES];
    _Alignas(64) rg_real ghost[RG_GHOST_BLOCK], rows[2 * RG_LANES * RG_TILE_FACE_ROW];
    _Alignas(64) int32_t side[2][RG_LANES];
    _Alignas(64) uint8_t broken[RG_LANES], unlinked[RG_LANES];
    uint8_t active;
    rg_interface_args args;
} face_bench;

/* At rest. The face lies in the xy plane; `up` is the direction of its normal along z. */
void face_bench_make(face_bench *b, rg_cohesive law, double up, face_view v);

/* Adds a uniform jump and sets the traction of the minus side (per area). */
void face_bench_load(face_bench *b, const double pull[3], const double jump[3]);

/* Displacement u = (G - I) x of both sides. */
void face_bench_deform(face_bench *b, const double g[3][3]);

/* Forces, then energies. */
void face_bench_run(face_bench *b, const rg_kernels *set);

#endif
