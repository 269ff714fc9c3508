#include "cost/model.h"

#include "cost/ceramic.h"
#include "cost/drucker_prager.h"
#include "cost/holmquist_johnson_cook.h"
#include "cost/j2.h"
#include "cost/johnson_cook.h"
#include "cost/johnson_holmquist.h"
#include "kernels.h"

/* ---- Operations, per lane ---- */

enum {
    FMA = 2,
    DOT = 5,   /* of 3-vectors: 1 + 2 FMA */
    CROSS = 9, /* 3 (1 + FMA) */
    LOG_TERMS = sizeof(rg_real) == sizeof(double) ? 9 : 3,
    LOG = 13 + LOG_TERMS * FMA, /* s = t/(t + 2), z, k: 5; polynomial; sum: 8 */
};

/* The jump of six nodal vectors. */
enum { JUMP = 3 * RG_FNODES };

/* Six nodal vectors to six points, per component: two sums of three, 2 x (1 + FMA) for the two rules, 2 FMA a
 * point. */
enum { TO_POINTS = 3 * (4 + 2 * (1 + FMA) + RG_POINTS * 2 * FMA) };

/* ---- Bulk ---- */

enum {
    /* jump of each face; its three moments, per component: two sums of three, common part, 2 FMA each */
    MOMENTS = RG_FACES * (JUMP + 3 * (4 + 1 + FMA + 3 * 2 * FMA)),
    /* a face with unlinked points: values at points, times weight, 3 FMA into the moments */
    UNLINKED = TO_POINTS + 3 * RG_POINTS * (1 + 3 * FMA),
    /* parts of the 4 derivatives common to all points: sum of 3 edges, 1 + FMA */
    COMMON = 4 * 3 * (3 + 1 + FMA),
    COMMON_LIFT = 4 * 3 * (2 + FMA),
    /* at a point: 4 derivatives, an FMA each; 3 differences; 3 x 3 sums of three products */
    GRADIENT = 4 * 3 * FMA + 9 + 9 * (1 + 2 * FMA),
    GRADIENT_LIFT = 3 * 3 * FMA, /* no term on the face opposite the point */
    /* a row of cof F - I: two cofactors, and H_11 + H_22 + minor on the diagonal */
    COFACTORS = 2 * (1 + FMA) + (1 + FMA + 2),
    /* F, the first row, minor + H.D, + tr H, J, log J: all that the energy needs */
    VOLUME_CHANGE = 3 + COFACTORS + DOT + 1 + 3 + 1 + LOG,
    /* the other rows, r = (lambda log J + mu j)/J, p = r - mu, P = mu H + p D + r I */
    STRESS = 2 * COFACTORS + 1 + FMA + 1 + 1 + 9 * (1 + FMA) + 3,
    /* bound on the acoustic tensor: cof F, cof^T cof (6 entries), row sums, /J^2, modulus, ratio, NaN guards
     */
    STIFFENING = 3 + 6 * DOT + 9 + 2 + FMA + FMA + 1 + (1 + FMA) + FMA,
    /* q_k = (V/4) P grad l_k and their sums; q_3 from the other three */
    PROJECT = 9 * (DOT + 1 + 1) + 3 * 3,
    /* nodal forces: 4 corners 1 + FMA, 6 edges 2 + 1 + FMA; corner tractions: FMA + 1 */
    NODAL_FORCE = 3 * (4 * (1 + FMA) + 6 * (3 + FMA)),
    CORNER_TRACTION = RG_FACES * RG_FCORNERS * 3 * (FMA + 1),
    /* energy density: H:H, j - log J, three terms; times V/4 into the sum */
    ENERGY = 3 * (DOT + 1) + (FMA + 1) + (1 + 1 + 1 + 2 * FMA) + FMA,
    CAUCHY = 6 * (DOT + 1),     /* (P F^T)/J */
    JACOBIAN = 3 + CROSS + DOT, /* F, J */
    VALID = FMA,                /* guard of a stiffening that does not know J */
    /* linear: trace, pressure, three entries on the diagonal and three off it */
    LINEAR_STRESS = 2 + 1 + 3 * FMA + 3 * 2,
    LINEAR_ENERGY = 2 + 3 * FMA + 3 * (1 + FMA) + 2 + 2 * FMA,
    /* St. Venant-Kirchhoff: six strains, their trace; pressure, S, S + H S; bound; energy */
    GREEN_STRAIN = 6 * (1 + DOT + 2) + 2,
    GREEN_STRESS = 1 + 6 + 3 + 9 * (1 + DOT),
    GREEN_STIFFENING = 3 * 2 + 1 + FMA + 1 + FMA,
    GREEN_ENERGY = 3 * (DOT + 1) + 2 + FMA,
    /* any symmetry: six strains in Voigt's notation, six sums of six; S + H S; bound; energy */
    VOIGT_STRAIN = 6 * (1 + DOT + 1) + 3,
    VOIGT_STRESS = 6 * (1 + 5 * FMA),
    VOIGT_PIOLA = 9 * (1 + DOT),
    VOIGT_STIFFENING = 3 * (1 + FMA) + 3 * 2 + 1 + 1 + FMA,
    VOIGT_ENERGY = 1 + 5 * FMA + 1 + FMA,
    /* Mooney-Rivlin: J^-2/3 by exponential, six strains, their trace */
    MOONEY_STRAIN = VOLUME_CHANGE + 1 + HENCKY_EXP + 6 * (1 + DOT + 2) + 2,
    /* other cofactors, E^2; x, y; C S, its mean, the rest on the diagonal, over J; P */
    MOONEY_STRESS =
        2 * COFACTORS + 6 * DOT + (2 + FMA + 1 + FMA + 1) + 6 * (1 + FMA) + 3 + 4 + 1 + 3 + 6 + 9 * (1 + DOT),
    /* largest rows of Q and C, tr Q; first and second part; their sum, ratio, NaN guard */
    MOONEY_STIFFENING = 3 + 6 * DOT + 9 + (3 * DOT + 2) + (3 + 6 + FMA + 1) + (FMA + 1 + FMA + 1 + 4 + 1) +
                        (2 + FMA + FMA + 2 + FMA + 1) + (2 + 1 + FMA + FMA + 1 + FMA) + 2 + FMA,
    MOONEY_ENERGY = 1 + FMA + (DOT + DOT + 1 + FMA) + (3 * DOT + 2) + (FMA + 2) + FMA + (1 + 2 * FMA) +
                    (1 + 2 * FMA + 2 + FMA + 2 * FMA + FMA + 1) + (1 + 2 * FMA) + (1 + FMA) + FMA,
};

/* Ogden, three terms: a rotation; stretches and their logarithms; of each term powers, sum, tau, energy,
 * largest; P; bound. */
enum {
    OGDEN_ROTATION =
        (1 + 1 + 1 + FMA + 1 + 1) + 1 + (FMA + 2) + 1 + 1 + 2 + 2 * (1 + FMA) + 3 * 2 * (1 + FMA),
    /* the first rotation makes the axes; two logarithms, the third from them */
    OGDEN_STRAIN = VOLUME_CHANGE + 6 * (1 + DOT + 2) + 12 * OGDEN_ROTATION - 3 * 2 * (1 + FMA) + 3 * FMA + 1 +
                   2 * (1 + HENCKY_LOG1P + FMA) + 1,
    /* two powers, the third from them */
    OGDEN_TERM = 2 * (1 + HENCKY_EXPM1) + (1 + FMA + 2 + 1) + 2 + 2 + 3 * 2 * FMA,
    OGDEN_TERMS = RG_OGDEN_TERMS * OGDEN_TERM,
    OGDEN_PIOLA = 3 * (2 + 6 * (1 + FMA)) + 9 * (1 + DOT),
    OGDEN_MEAN = 3,
    OGDEN_STIFFENING =
        RG_OGDEN_TERMS * FMA + 1 + (1 + 1 + 2 * FMA + 1) + 3 + 1 + (1 + 1 + FMA + 1 + FMA) + 2 + 1 + FMA,
    OGDEN_ENERGY = RG_OGDEN_TERMS * FMA + 1 + 2 * FMA,
};

/* Viscoelastic: six components of E; a stress; F S; constants of a step, once for the points of an element.
 */
enum {
    VE_STRAIN = 6 * (1 + DOT + 2),
    VE_STRESS = 2 + 1 + 3 * FMA + 3,
    VE_PIOLA = 9 * (2 + DOT),
    VE_BOUND = 6,
    /* strain gained; of each element A, stress and their sum; bound */
    VE_AT_REST = VE_STRAIN + 6 + RG_VE_ELEMENTS * (6 + VE_STRESS + 6) + VE_PIOLA + 1 + 2 * VE_BOUND + 3 * FMA,
    /* stress before, A by a and b, flow, work; also at rest, where nobody looks at it */
    VE_STEP = RG_VE_ELEMENTS * (VE_STRESS + 6 * FMA + 12 + 6 + HENCKY_SYM_DOT + 1) + 1,
    VE_CONSTANTS = RG_VE_ELEMENTS * (HENCKY_EXP + HENCKY_EXPM1 + 1),
    VE_ENERGY = VE_STRAIN + 6 + RG_VE_ELEMENTS * (6 + VE_STRESS + HENCKY_SYM_DOT + FMA),
};

static double viscoelastic_flops(void) {
    return VOLUME_CHANGE + STRESS + STIFFENING + VE_AT_REST + VE_STEP + VE_CONSTANTS / (double)RG_GAUSS;
}

/* All up to the gradients at the four points. */
static double gradient_flops(const rg_cost_variant *v) {
    double sum = COMMON + RG_GAUSS * GRADIENT;
    if (v->gradient == RG_GRADIENT_LIFTED) {
        sum += MOMENTS + COMMON_LIFT + RG_GAUSS * GRADIENT_LIFT + UNLINKED * v->unlinked;
    }
    return sum;
}

/* The material at a point of the bulk kernel, with the guard on its stiffening. One with a history adds up
 * what it sets free where it advances. */
static double point_flops(const rg_cost_variant *v) {
    double released = v->advance ? RG_RELEASED * FMA : 0;
    switch (v->model) {
    case RG_MATERIAL_LINEAR_ELASTIC:
        return JACOBIAN + LINEAR_STRESS + VALID + FMA;
    case RG_MATERIAL_ST_VENANT_KIRCHHOFF:
        return JACOBIAN + GREEN_STRAIN + GREEN_STRESS + GREEN_STIFFENING + VALID + FMA;
    case RG_MATERIAL_ANISOTROPIC:
        return JACOBIAN + VOIGT_STRAIN + VOIGT_STRESS + VOIGT_PIOLA + VOIGT_STIFFENING + VALID + FMA;
    case RG_MATERIAL_MOONEY_RIVLIN:
        return MOONEY_STRAIN + MOONEY_STRESS + MOONEY_STIFFENING + FMA;
    case RG_MATERIAL_OGDEN:
        return OGDEN_STRAIN + OGDEN_TERMS + OGDEN_PIOLA + OGDEN_MEAN + OGDEN_STIFFENING + FMA;
    case RG_MATERIAL_DESHPANDE_EVANS:
        return rg_ceramic_flops(v) + FMA + released;
    case RG_MATERIAL_J2:
        return rg_j2_flops(v) + FMA + released;
    case RG_MATERIAL_JOHNSON_COOK:
        return rg_johnson_cook_flops(v) + FMA + released;
    case RG_MATERIAL_JOHNSON_HOLMQUIST:
        return rg_johnson_holmquist_flops(v) + FMA + released;
    case RG_MATERIAL_HOLMQUIST_JOHNSON_COOK:
        return rg_holmquist_johnson_cook_flops(v) + FMA + released;
    case RG_MATERIAL_DRUCKER_PRAGER:
        return rg_drucker_prager_flops(v) + FMA + released;
    case RG_MATERIAL_VISCOELASTIC:
        return viscoelastic_flops() + released;
    default:
        return VOLUME_CHANGE + STRESS + STIFFENING;
    }
}

/* The material at a point of the state kernel, with what it adds to the energy. */
static double state_flops(const rg_cost_variant *v) {
    switch (v->model) {
    case RG_MATERIAL_LINEAR_ELASTIC:
        return LINEAR_ENERGY + FMA + (v->cauchy ? JACOBIAN + LINEAR_STRESS + CAUCHY : 0);
    case RG_MATERIAL_ST_VENANT_KIRCHHOFF:
        return GREEN_STRAIN + GREEN_ENERGY + FMA + (v->cauchy ? JACOBIAN + GREEN_STRESS + CAUCHY : 0);
    case RG_MATERIAL_ANISOTROPIC:
        return VOIGT_STRAIN + VOIGT_STRESS + VOIGT_ENERGY + (v->cauchy ? JACOBIAN + VOIGT_PIOLA + CAUCHY : 0);
    case RG_MATERIAL_MOONEY_RIVLIN:
        return MOONEY_STRAIN + MOONEY_ENERGY + (v->cauchy ? MOONEY_STRESS + CAUCHY : 0);
    case RG_MATERIAL_OGDEN:
        return OGDEN_STRAIN + OGDEN_TERMS + OGDEN_ENERGY + FMA +
               (v->cauchy ? OGDEN_PIOLA + OGDEN_MEAN + CAUCHY : 0);
    case RG_MATERIAL_DESHPANDE_EVANS:
        return rg_ceramic_state_flops(v) + FMA + (v->cauchy ? 3 + CAUCHY : 0);
    case RG_MATERIAL_J2:
        return rg_j2_state_flops(v) + FMA + (v->cauchy ? 3 + CAUCHY : 0);
    case RG_MATERIAL_JOHNSON_COOK:
        return rg_johnson_cook_state_flops(v) + FMA + (v->cauchy ? 3 + CAUCHY : 0);
    case RG_MATERIAL_JOHNSON_HOLMQUIST:
        return rg_johnson_holmquist_state_flops(v) + FMA + (v->cauchy ? 3 + CAUCHY : 0);
    case RG_MATERIAL_HOLMQUIST_JOHNSON_COOK:
        return rg_holmquist_johnson_cook_state_flops(v) + FMA + (v->cauchy ? 3 + CAUCHY : 0);
    case RG_MATERIAL_DRUCKER_PRAGER:
        return rg_drucker_prager_state_flops(v) + FMA + (v->cauchy ? 3 + CAUCHY : 0);
    case RG_MATERIAL_VISCOELASTIC:
        return VOLUME_CHANGE + ENERGY + VE_ENERGY +
               (v->cauchy ? STRESS + 6 * RG_VE_ELEMENTS + VE_PIOLA + CAUCHY : 0);
    default:
        return VOLUME_CHANGE + ENERGY + (v->cauchy ? STRESS + CAUCHY : 0);
    }
}

static double bulk_flops(const rg_cost_variant *v) {
    return gradient_flops(v) + RG_GAUSS * (point_flops(v) + PROJECT) + NODAL_FORCE + CORNER_TRACTION;
}

static double bulk_state_flops(const rg_cost_variant *v) {
    return gradient_flops(v) + RG_GAUSS * state_flops(v);
}

enum {
    HEIGHT = 6 + 4 * DOT + 2,
    /* at a point: F, its cofactors and J; change of volume, its rate; pressure, stress; heat */
    VISCOUS_POINT = 3 + 3 * CROSS + DOT + (3 * DOT + 2) + 1 + (1 + 1 + FMA + 1) + 9 + FMA,
    /* rho h, b2^2 h; heat of the element; forces added; xi, bound, stiffening */
    VISCOUS_ELEMENT = 2 + 2 + NODAL_FORCE + 30 + 1 + FMA + (FMA + 1 + 1 + 1) + 2,
};

static double viscosity_flops(void) {
    return 2 * (COMMON + RG_GAUSS * GRADIENT) + HEIGHT + RG_GAUSS * (VISCOUS_POINT + PROJECT) +
           VISCOUS_ELEMENT;
}

/* ---- Interface ---- */

enum {
    /* corner tractions: half the difference; per component their sum, a product per rule, an FMA a point */
    MEAN_TRACTION = RG_FCORNERS * 3 * 2 + 3 * (2 + 2 + RG_POINTS * FMA),
    DG_TRACTION = RG_POINTS * (DOT + 1 + 3 * 2 * FMA), /* mean + iso [u] + norm (A.[u]) A */
    AREA = CROSS + 3 + DOT,                            /* area vector and its square */
    TEST = 1 + RG_POINTS * DOT,                        /* bound, square of the traction */
    /* per component: two weighted sums of three points; 1 + FMA for corners and for edges; 2 FMA a node */
    FACE_FORCE = 3 * (2 * 3 + 2 * (1 + FMA) + RG_FNODES * 2 * FMA),
    /* mean of the sides; at a point two tangents of 6 FMA a component, their cross product, length, n */
    MID_SURFACE = 2 * JUMP + RG_POINTS * (2 * 3 * RG_FNODES * FMA + CROSS + DOT + 2 + 1 + 3),
    /* area; at a point: Cauchy traction, its normal part, tau, effective, and the bound again */
    CRITERION = 1 + 1 + RG_POINTS * (3 + DOT + 3 * FMA + (DOT + 1 + FMA + 1) + DOT),
    /* opening w, its normal part, tangential part, effective opening */
    OPENING = 3 + DOT + 3 * FMA + (DOT + 1 + FMA + 1),
    SECANT = 1 + 1 + 1 + 1,                                     /* area strength (1/delta_max - 1/opening) */
    LAW = OPENING + SECANT + 1 + FMA + 1 + FMA + 3 * (2 + FMA), /* normal part with contact; traction */
    PENALTY_ENERGY = RG_POINTS * (DOT + DOT + 2 + FMA + 2),
    /* stored, contact and dissipated energy of a point, each weighted and summed */
    CRACK_ENERGY = OPENING + SECANT + 3 + 2 + 4 + 3 * 2,
};

static double interface_flops(const rg_cost_variant *v) {
    return AREA + JUMP + TO_POINTS + MEAN_TRACTION + DG_TRACTION + (1 - v->damaged) * TEST + FACE_FORCE +
           v->damaged * (MID_SURFACE + CRITERION + v->points * LAW);
}

static double interface_state_flops(const rg_cost_variant *v) {
    return AREA + 1 + JUMP + TO_POINTS + PENALTY_ENERGY +
           v->damaged * (MID_SURFACE + RG_POINTS * CRACK_ENERGY);
}

/* ---- Kick, drift and kinetic energy ---- */

enum {
    ADD_FACES = 3 * RG_FACES * RG_FNODES * FMA,
    /* sums over corners and edges: 12; a corner 3 + 2 FMA, an edge 1 + 3 FMA */
    SOLVE_CONSISTENT = 3 * (12 + 4 * (3 + 2 * FMA) + 6 * (1 + 3 * FMA)),
    SOLVE_LUMPED = 3 * RG_NODES,
    ADVANCE = 3 * RG_NODES * FMA, /* v, or u */
    SQUARE_CONSISTENT = 3 * (3 + 6 + 4 * FMA + 6 * (2 + 3 * FMA) + 10 + 2),
    SQUARE_LUMPED = 3 * (RG_NODES * (1 + FMA) + 1),
};

static double kick_flops(const rg_cost_variant *v) {
    return 2 + ADD_FACES + (v->mass == RG_MASS_LUMPED ? SOLVE_LUMPED : SOLVE_CONSISTENT) + ADVANCE;
}

static double kinetic_flops(const rg_cost_variant *v) {
    return 2 + (v->mass == RG_MASS_LUMPED ? SQUARE_LUMPED : SQUARE_CONSISTENT);
}

/* ---- Bytes, in rows: one value of each lane of a block ---- */

enum {
    NODAL = RG_NODES * 3,
    TRACTION = RG_FACES * RG_FCORNERS * 3,
    FACE = RG_FNODES * 3,
    TILE_FACE_TRACTION = RG_FCORNERS * 3,
    SIDES_TRACTION = 2 * TILE_FACE_TRACTION,
    HISTORY = RG_CRACK_TIME, /* of a broken point: opening and origin; the time is not read */
    STRESSES = RG_GAUSS * 6,
    WIDE = sizeof(double) / sizeof(rg_real), /* of a row of doubles: energies and stresses */
};

#define ROW   (RG_LANES * (double)sizeof(rg_real))
#define LINKS ((double)sizeof(int32_t) * RG_LINK_BLOCK)
#define SIDES ((double)sizeof(int32_t) * 2 * RG_LANES)

typedef struct {
    double in;      /* rows read */
    double updated; /* rows read and written back */
    double out;     /* rows only written: fetched first */
    double index;   /* bytes of links and flags */
} traffic;

/* Values of a history that serve to go on alone: the plastic strain; the heat of Johnson and Cook's metal;
 * the last strain of Johnson and Holmquist's ceramic; that of the concrete, and, while its pores are open,
 * how far they have closed, which is looked at and no more; cap and last stress of Drucker and Prager's
 * solid. */
static int only_advancing(rg_material_model model) {
    switch (model) {
    case RG_MATERIAL_VISCOELASTIC:
        return 0;
    case RG_MATERIAL_JOHNSON_COOK:
    case RG_MATERIAL_JOHNSON_HOLMQUIST:
        return 2;
    case RG_MATERIAL_HOLMQUIST_JOHNSON_COOK:
        return 3;
    case RG_MATERIAL_DRUCKER_PRAGER:
        return 4;
    default:
        return 1;
    }
}

static traffic bulk_traffic(const rg_cost_variant *v, double out) {
    traffic t = {.in = NODAL + RG_GEOM, .out = out};
    int history = rg_material_history(v->model);
    if (v->advance) {
        t.updated = (double)rg_history_rows(history);
    } else {
        t.in += history > 0 ? RG_GAUSS * (history - only_advancing(v->model)) : 0;
    }
    if (v->gradient == RG_GRADIENT_LIFTED) { /* links, one flag; where points are unlinked, interface links
                                              * and the masks of two sides
                                              */
        t.index = LINKS + 1 + (v->unlinked > 0 ? LINKS + v->interfaces * RG_LANES : 0);
    }
    return t;
}

/* Displacements of the elements belong to `interfaces` blocks of interfaces; an element's second and later
 * faces find them in the cache. */
static traffic interface_traffic(const rg_cost_variant *v, double in, double out) {
    return (traffic){.in = NODAL / v->interfaces + in + v->damaged * HISTORY * RG_POINTS,
                     .out = out,
                     .index = SIDES + 1 + v->damaged * 2 * 2 * RG_LANES};
}

static traffic traffic_of(rg_cost_kernel kernel, const rg_cost_variant *v) {
    switch (kernel) {
    case RG_COST_BULK: /* out: forces, tractions, stiffening */
        return bulk_traffic(v, NODAL + TRACTION + 1);
    case RG_COST_BULK_STATE:
        return bulk_traffic(v, WIDE * (1 + (v->cauchy ? STRESSES : 0)));
    case RG_COST_INTERFACE:
        return interface_traffic(v, SIDES_TRACTION + RG_IGEOM, FACE);
    case RG_COST_INTERFACE_STATE:
        return interface_traffic(v, RG_IGEOM, WIDE * RG_E_INTERFACE);
    case RG_COST_KICK: /* in: bulk force, the forces of all interfaces, volume */
        return (traffic){.in = NODAL + FACE * v->interfaces + 1, .updated = NODAL, .index = LINKS};
    case RG_COST_VISCOSITY: /* displacement and velocity; forces, stiffening and heat in and out */
        return (traffic){.in = 2 * NODAL + RG_GEOM, .updated = NODAL + 1 + WIDE};
    case RG_COST_DRIFT:
        return (traffic){.in = NODAL, .updated = NODAL};
    default: /* kinetic: velocity and volume */
        return (traffic){.in = NODAL + 1, .out = WIDE};
    }
}

static double flops_of(rg_cost_kernel kernel, const rg_cost_variant *v) {
    switch (kernel) {
    case RG_COST_BULK:
        return bulk_flops(v);
    case RG_COST_BULK_STATE:
        return bulk_state_flops(v);
    case RG_COST_INTERFACE:
        return interface_flops(v);
    case RG_COST_INTERFACE_STATE:
        return interface_state_flops(v);
    case RG_COST_KICK:
        return kick_flops(v);
    case RG_COST_VISCOSITY:
        return viscosity_flops();
    case RG_COST_DRIFT:
        return ADVANCE;
    default:
        return kinetic_flops(v);
    }
}

rg_cost rg_cost_block(rg_cost_kernel kernel, const rg_cost_variant *v) {
    traffic t = traffic_of(kernel, v);
    return (rg_cost){.flops = RG_LANES * flops_of(kernel, v),
                     .minimal = ROW * v->fill * (t.in + 2 * t.updated + t.out),
                     .actual = ROW * (t.in + 2 * t.updated + 2 * t.out) + t.index};
}

rg_cost rg_cost_step(const rg_cost_variant *v) {
    rg_cost bulk = rg_cost_block(RG_COST_BULK, v), interface = rg_cost_block(RG_COST_INTERFACE, v),
            kick = rg_cost_block(RG_COST_KICK, v), drift = rg_cost_block(RG_COST_DRIFT, v);
    double again =
        v->tile_faces > 0 ? kick.flops : 0; /* at most: blocks without tile-boundary faces are left out */
    double faces = v->interfaces * (RG_IGEOM + v->damaged * HISTORY * RG_POINTS);
    double first = NODAL + 2 * NODAL + RG_GEOM + v->tile_faces * (FACE + 2 * TILE_FACE_TRACTION);
    double second = 2 * NODAL + 2 * NODAL + 1 + v->tile_faces * (FACE + 2 * TILE_FACE_TRACTION + 2 * FACE);
    double index = (2 + 1) * LINKS + v->interfaces * (SIDES + 1);
    return (rg_cost){.flops = bulk.flops + v->interfaces * interface.flops + kick.flops + again + drift.flops,
                     .minimal = ROW * v->fill * (2 * 2 * NODAL + RG_GEOM + v->interfaces * RG_IGEOM),
                     .actual = ROW * (first + second + faces) + index};
}
