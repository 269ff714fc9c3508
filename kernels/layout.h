/* The one place that states how fields lie in memory.
 *
 * The mesh is cut into tiles: runs of consecutive elements along a space-filling curve, small enough for the
 * cache. A kernel works on one tile; all its pointers are to the tile's first block, all numbers in it count
 * from the tile's first element or interface. A face between two elements of a tile is one interface inside
 * it; a face between tiles is a tile-boundary face, of which each of the two tiles has its own copy, computed
 * from the same numbers to the same bits. What a tile-boundary face must know of the other side travels as a
 * row: the trace of the displacement, then the corner tractions. Whether the other tile lies on the same rank
 * makes no difference.
 *
 * Every field is a structure of arrays in blocks of RG_LANES elements (or interfaces): the lane is the
 * fastest index, so a kernel loads a vector of elements with one aligned load, and every array is
 * padded to whole blocks, so no kernel has a scalar remainder.
 *
 *   displacement, velocity, force   [element block][10 nodes][3][lane]
 *   element geometry                [element block][RG_GEOM][lane]
 *   face traction (area-weighted)   [element][4 faces][3 corners][3]
 *   links                           [element block][4 faces][lane]
 *   history of the material         [element block][4 points x values, RG_RELEASED][lane]; blocks as long as
 *                                   the longest history needs
 *   interface geometry              [interface block][RG_IGEOM][lane]
 *   interface nodal force           [interface block][6 nodes][3][lane]
 *   crack state                     [interface block]: [6 points][RG_CRACK][lane], then
 *                                   [6 points][memory of the law][lane], then, with shear that fades,
 *                                   [6 points][RG_BOND][lane], then, where strengths rise with the rate of
 *                                   stress, [6 points][RG_RISE][lane], then, with Mohr and Coulomb's
 * criterion, [6 points][lane], lent at the switch (J), then, with friction, [6 points][RG_FRICTION][lane]
 *   ghost traces                    [tile face block][6 nodes][3][lane]
 *   trace rows, traction rows       [row][6 nodes][3], [row][3 corners][3]
 *
 * The face tractions are rows instead: their reader, an interface, finds the nine values of its face in two
 * cache lines, where the lanes of a block would spread them over nine; it transposes rows into vectors in
 * registers.
 *
 * Element convention: the four vertices of a tetrahedron are sorted by ascending global vertex number. Its
 * nodes are in the order of VTK_QUADRATIC_TETRA (corners 0-3, mid-edges 01 12 02 03 13 23); local face f is
 * the one opposite corner f, its corners ascending, its six nodes in the order corner 0 1 2, mid-edge 01 12
 * 02. Because of the sorting both neighbours of a face list its nodes in the same order: no permutation is
 * ever needed. The price is that half of the elements are left-handed, which only output has to know. */
#ifndef RG_LAYOUT_H
#define RG_LAYOUT_H

#include <stddef.h>
#include <stdint.h>

/* Precision of the fields and of what the kernels compute with them: a choice of the build. Parameters, sums
 * and energies are doubles in both. */
#ifdef RG_SINGLE
typedef float rg_real;
#define RG_PRECISION "single"
#else
typedef double rg_real;
#define RG_PRECISION "double"
#endif

enum {
    RG_LANES = 64 / (int)sizeof(rg_real), /* elements or interfaces in a block, on every instruction set: a
                                             row of them is a cache line */
    RG_NODES = 10,                        /* nodes of a tetrahedron */
    RG_FACES = 4,                         /* faces of a tetrahedron */
    RG_FNODES = 6,                        /* nodes of a face */
    RG_FCORNERS = 3,                      /* corners of a face */
    RG_POINTS = 6,                        /* quadrature points of an interface */
    RG_GAUSS = 4,                         /* quadrature points of a tetrahedron */
    RG_TILE = 256,                        /* elements of a tile of a large mesh: some 0.4 MB of fields */
    RG_MOST_TILE = 1024,                  /* what may be asked for in its place */
};

enum { /* element geometry: grad l_k of barycentric coordinates k = 0, 1, 2 (1/m), volume (m^3) */
       RG_GEOM_GRAD = 0,
       RG_GEOM_VOLUME = 9,
       RG_GEOM = 10,
};

enum {                    /* interface geometry */
       RG_IGEOM_EDGE = 0, /* edges corner 0 -> 1 and 0 -> 2, 6 components (m); half their cross product is the
                             area vector A, area N, from the minus to the plus element; 0 in padding */
       RG_IGEOM_PEN_ISO = 6,  /* area (beta_s/h_s) mu (N/m) */
       RG_IGEOM_PEN_NORM = 7, /* (beta_s/h_s) (lambda + mu) / area: the penalty is (PEN_ISO I + PEN_NORM
                                 A(x)A) [u] */
       RG_IGEOM = 8,
};

enum { /* crack state of one interface point; meaningful only where the point's bit in `broken` is set */
       RG_CRACK_OPENING = 0, /* largest effective opening so far, delta_max (m); of a conserving activation
                                less its onset */
       RG_CRACK_ORIGIN = 1,  /* jump from which the opening is measured, 3 components (m) */
       RG_CRACK_TIME = 4,    /* time at which the point switched, in the intrinsic form separated (s) */
       RG_CRACK_GIVEN = 5,   /* of a conserving activation: energy set free at the switch, over area and
                                strength (m) */
       RG_CRACK = 6,
};

enum {                          /* friction at one interface point (cohesive/friction.h) */
       RG_FRICTION_ANCHOR = 0,  /* slip at which its spring is relaxed, 2 components (m) */
       RG_FRICTION_STRETCH = 2, /* of the spring, 2 components (m) */
       RG_FRICTION_HEAT = 4,    /* dissipated at this point of the face so far (J) */
       RG_FRICTION = 5,
};

enum {                      /* shear that fades at one interface point (element/interface_bond.h) */
       RG_BOND_ANCHOR = 0,  /* slip at which its spring is relaxed, 2 components (m) */
       RG_BOND_STRETCH = 2, /* of the spring, 2 components (m) */
       RG_BOND_START = 4,   /* square of the stretch at the switch (m2) */
       RG_BOND_DAMAGE = 5,  /* of the state before */
       RG_BOND_HEAT = 6,    /* dissipated so far, of the whole face (J) */
       RG_BOND_GIVEN = 7,   /* what lift and penalty held by the shear at the switch, likewise (J) */
       RG_BOND = 8,
};

enum { /* strength that rises with the rate of stress, at one point (element/interface_rise.h) */
       RG_RISE_STRESS = 0, /* where the mean rate counts from (Pa) */
       RG_RISE_SPAN = 1,   /* time since then (s) */
       RG_RISE_LAST = 2,   /* of the last state that counted (s) */
       RG_RISE_FACTOR = 3, /* strength over that of the law; 0: never tested */
       RG_RISE = 4,
};

/* History of a material with n values per point: those of the 4 points of the element, then the energy that
 * the element has set free since the start (J), by cause. */
enum { RG_RELEASED_PLASTIC, RG_RELEASED_DAMAGE, RG_RELEASED };

enum { /* values per row, and per block */
       RG_TRACTION_ROW = RG_FACES * RG_FCORNERS * 3,
       RG_IFORCE_ROW = RG_FNODES * 3,
       RG_NODE_BLOCK = RG_NODES * 3 * RG_LANES,
       RG_TRACTION_BLOCK = RG_TRACTION_ROW * RG_LANES,
       RG_GEOM_BLOCK = RG_GEOM * RG_LANES,
       RG_LINK_BLOCK = RG_FACES * RG_LANES,
       RG_IGEOM_BLOCK = RG_IGEOM * RG_LANES,
       RG_IFORCE_BLOCK = RG_IFORCE_ROW * RG_LANES,
       RG_CRACK_BLOCK = RG_POINTS * RG_CRACK * RG_LANES,
       RG_FRICTION_BLOCK = RG_POINTS * RG_FRICTION * RG_LANES,
       RG_LOAN_BLOCK = RG_POINTS * RG_LANES,
       RG_BOND_BLOCK = RG_POINTS * RG_BOND * RG_LANES,
       RG_RISE_BLOCK = RG_POINTS * RG_RISE * RG_LANES,
       RG_TRACE_ROW = RG_FNODES * 3,
       RG_TILE_FACE_ROW = RG_FCORNERS * 3, /* tractions of one face */
       RG_GHOST_BLOCK = RG_TRACE_ROW * RG_LANES,
       RG_PRESTRESS = RG_GAUSS * 6, /* per element */
       RG_PRESTRESS_BLOCK = RG_PRESTRESS * RG_LANES,
};

enum {                           /* of an element that heat expands, values at its four points */
       RG_THERMAL_EXPANSION = 0, /* e, by which lengths have grown */
       RG_THERMAL_LAST = 4,      /* at the end of the last step */
       RG_THERMAL_FORCE = 8,     /* dW/de there (J/m^3) */
       RG_THERMAL_WORK = 12,     /* that heat has brought in (J) */
       RG_THERMAL = 13,
       RG_THERMAL_BLOCK = RG_THERMAL * RG_LANES,
};

enum { RG_TURN = 9, RG_TURN_BLOCK = RG_TURN * RG_LANES }; /* rows: axes 1, 2, 3 of an anisotropic solid */

/* Nodes of local face f in the order both neighbours share. */
static const int rg_face_node[RG_FACES][RG_FNODES] = {
    {1, 2, 3, 5, 9, 8}, {0, 2, 3, 6, 9, 7}, {0, 1, 3, 4, 8, 7}, {0, 1, 2, 4, 5, 6}};

/* Mid-edge node between corners i and j (the corner itself for i = j). */
static const int rg_edge_node[4][4] = {{0, 4, 6, 7}, {4, 1, 5, 8}, {6, 5, 2, 9}, {7, 8, 9, 3}};

/* Index of component c of node n of element e. */
static inline size_t rg_node_index(size_t e, int n, int c) {
    return (e / RG_LANES) * RG_NODE_BLOCK + (size_t)(n * 3 + c) * RG_LANES + e % RG_LANES;
}

/* Index of component c at corner i (0-2) of face f of element e. */
static inline size_t rg_traction_index(size_t e, int f, int i, int c) {
    return e * RG_TRACTION_ROW + (size_t)((f * RG_FCORNERS + i) * 3 + c);
}

static inline size_t rg_geom_index(size_t e, int k) {
    return (e / RG_LANES) * RG_GEOM_BLOCK + (size_t)k * RG_LANES + e % RG_LANES;
}

static inline size_t rg_turn_index(size_t e, int k) {
    return (e / RG_LANES) * RG_TURN_BLOCK + (size_t)k * RG_LANES + e % RG_LANES;
}

static inline size_t rg_link_index(size_t e, int f) {
    return (e / RG_LANES) * RG_LINK_BLOCK + (size_t)f * RG_LANES + e % RG_LANES;
}

static inline size_t rg_igeom_index(size_t i, int k) {
    return (i / RG_LANES) * RG_IGEOM_BLOCK + (size_t)k * RG_LANES + i % RG_LANES;
}

static inline size_t rg_iforce_index(size_t i, int n, int c) {
    return (i / RG_LANES) * RG_IFORCE_BLOCK + (size_t)(n * 3 + c) * RG_LANES + i % RG_LANES;
}

static inline size_t rg_crack_index(size_t i, int q, int k) {
    return (i / RG_LANES) * RG_CRACK_BLOCK + (size_t)(q * RG_CRACK + k) * RG_LANES + i % RG_LANES;
}

/* Index of value k of friction at point q of interface i, in crack state of `stride` values a block. */
static inline size_t rg_friction_index(size_t i, int q, int k, size_t stride) {
    return (i / RG_LANES + 1) * stride - RG_FRICTION_BLOCK + (size_t)(q * RG_FRICTION + k) * RG_LANES +
           i % RG_LANES;
}

/* Likewise of what was lent to point q, where friction follows it. */
static inline size_t rg_loan_index(size_t i, int q, size_t stride) {
    return (i / RG_LANES + 1) * stride - RG_FRICTION_BLOCK - RG_LOAN_BLOCK + (size_t)q * RG_LANES +
           i % RG_LANES;
}

/* Rows of the history of an element with n values per point (none for n = 0), values of a block of them, and
 * the index of a row where blocks are `stride` values apart. */
static inline size_t rg_history_rows(int n) {
    return n == 0 ? 0 : (size_t)(RG_GAUSS * n + RG_RELEASED);
}

static inline size_t rg_history_block(int n) {
    return rg_history_rows(n) * RG_LANES;
}

static inline size_t rg_history_index(size_t e, size_t stride, size_t row) {
    return e / RG_LANES * stride + row * RG_LANES + e % RG_LANES;
}

/* Links are 32-bit numbers with a small code in the low bits.
 *
 * neighbour (element's face -> trace on its other side): 8 * element + local face of an element of the tile;
 * 8 * tile face + RG_GHOST for a ghost trace; the own face where there is none.
 * interface (element's face -> interface): 4 * interface + side (0 minus, 1 plus), + RG_TILE_FACE if it is
 * one of the tile's tile-boundary faces; negative where there is none: RG_NO_INTERFACE on the surface,
 * RG_JOINED where both sides share their nodes. side (inside: minus and plus; tile-boundary face: own): 4 *
 * element + local face. other (tile-boundary face: the other side): 2 * row + (1 if the own element is on the
 * plus side). */
enum { RG_GHOST = RG_FACES, RG_TILE_FACE = 2, RG_NO_INTERFACE = -1, RG_JOINED = -2 };

static inline int32_t rg_link(size_t number, int code, int base) {
    return (int32_t)number * base + code;
}

static inline int32_t rg_neighbour_link(size_t element, int face) {
    return rg_link(element, face, 8);
}

static inline int32_t rg_side_link(size_t element, int face) {
    return rg_link(element, face, RG_FACES);
}

#endif
