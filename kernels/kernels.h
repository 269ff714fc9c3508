/* What the kernels compute, as one table of functions per instruction set.
 *
 * A kernel works on whole blocks [begin, end) of RG_LANES elements or interfaces of one tile (layout.h); its
 * pointers are to the tile's first block. It reads where it must (its neighbours' traces) and writes only
 * what belongs to its own blocks. So loops over blocks and tiles need no colours, no atomics and no order:
 * each sum has the order that the mesh gives it (bulk, then the faces inside the tile, then its tile-boundary
 * faces), whatever the number of ranks and threads. Equations: A. N. Seagraves, MIT 2010, and the papers
 * named at each kernel. */
#ifndef RG_KERNELS_H
#define RG_KERNELS_H

#include <stdbool.h>
#include "layout.h"
#include "materials.h"
#include "modes.h"

/* Traces: what tile-boundary faces tell each other. `send` writes the own traces as rows, `receive` collects
 * those of the other sides into ghosts, and traction rows likewise. Blocks are the tile's tile-boundary face
 * blocks. */
typedef struct {
    const rg_real *u;        /* displacement (m) */
    const rg_real *traction; /* area-weighted corner tractions (N) */
    const int32_t *side;     /* [tile face]: own face */
    const int32_t *other;    /* [tile face]: row of the other side */
    const rg_real *rows;     /* all trace rows of this rank */
    rg_real *own_rows;       /* out: the tile's trace rows */
    rg_real *own_tractions;  /* out: the tile's traction rows */
    rg_real *ghost;          /* out: ghost traces */
} rg_trace_args;

/* Bulk: tet10 at the lifted gradient F + R (Ten Eyck & Lew 2006), or at its own F. */
typedef struct {
    rg_material material;
    rg_gradient gradient;
    const rg_real *u;         /* displacement (m) */
    const rg_real *ghost;     /* traces of the other tiles' elements (m) */
    const rg_real *geom;      /* element geometry */
    const int32_t *neighbour; /* links */
    const int32_t *interface; /* links */
    const uint8_t *cracked;   /* [block]: not 0 where some face of the block has an unlinked point */
    const uint8_t *unlinked;  /* [interface]: bit q set where point q has left the lift */
    rg_real *history;         /* of the material, in/out; NULL if it has none */
    size_t history_stride;    /* values from one block's history to the next: its own, or more where other
                                 blocks are of a material with a longer one */
    rg_real *thermal;         /* [block][RG_THERMAL][lane], in/out: of solids that heat expands; or NULL */
    const rg_real *turn;      /* [block][RG_TURN][lane]: axes of anisotropic solids whose stiffness is given
                                 along those; NULL: along the axes of the mesh */
    bool advance;             /* history goes on by the step that ends here; else it stays as it is */
    rg_real *force;           /* out: internal nodal force of the bulk, -dW/du (N) */
    rg_real *traction;        /* out: area-weighted corner tractions area_f P N_outward (N) */
    rg_real *stiffening; /* out: [block][lane], largest ratio of the acoustic tensor to its value at F = I */
} rg_bulk_args;

/* Cohesive laws (laws.h); none: a point never breaks. */
typedef enum {
#define RG_LAW(NAME, ...) RG_LAW_##NAME,
#include "laws.h"
#undef RG_LAW
    RG_LAWS, /* of this program */
    RG_LAW_NONE = RG_LAWS,
    RG_LAW_USER /* that of a library of the user's (library.h) */
} rg_law;

enum {
    RG_LAW_SHAPE = 8,  /* parameters of its own that a law may have */
    RG_USER_WORK = 6,  /* of a user's law: work of separation over strength times critical opening, ... */
    RG_USER_END = 7,   /* and opening of full separation over the critical one */
    RG_LAW_MEMORY = 4, /* values that a point may remember besides its crack state */
};

/* Of a law whose opening the time step follows (RG_LIMITS_STEP, src/solver/step_limiter.h): its parameter N,
 * steps to climb to the strength; and of a point's memory the last effective opening (m) and the opening rate
 * (1/s). */
enum { RG_LIMITER_STEPS = 1, RG_LIMITER_LAST = 0, RG_LIMITER_RATE = 1, RG_LIMITER_MEMORY = 2 };

/* Parameters of a law whose energy depends on the share of shear B (RG_MIXED): the critical opening grows by
 * (ratio - 1) B^exponent. */
enum { RG_MIXED_RATIO = 0, RG_MIXED_EXPONENT = 1 };

/* Bulk viscosity (element/viscosity.c), after the bulk: adds to its forces, and to its stiffening what
 * damping takes from the step. */
typedef struct {
    const rg_bulk_args *bulk; /* force and stiffening in/out */
    const rg_real *velocity;  /* in the middle of the step before (m/s) */
    double linear, quadratic; /* b1 c (m/s), b2^2 */
    double damping;           /* xi of the stiffest mode by the linear part */
    double damping_rate;      /* ... by the quadratic part, over h max(0, -div v) (s/m) */
    double allowed;           /* sqrt(1 + damping^2) - damping: what the critical step has lost already */
    double dt;                /* step for which heat is booked (s) */
    double *heat;             /* in/out: [block][lane], dissipated so far (J) */
} rg_viscosity_args;

/* Strengths that rise with the rate of stress (element/interface_rise.h). */
typedef struct {
    double rate; /* beyond which they do (Pa/s); 0: nowhere */
    double exponent, most;
} rg_rise;

/* Stress before any deformation (element/prestress.c), after the bulk: adds to force, traction and
 * stiffening, or to energy and cauchy of a state. */
typedef struct {
    const rg_bulk_args *bulk;
    const rg_real *stress; /* [block][RG_GAUSS][xx yy zz yz xz xy][lane] (Pa) */
} rg_prestress_args;

/* 12-node interface. The area vector points from minus to plus, jump [u] = u+ - u-. Force on the minus side
 * is +g, on the plus side -g. */
typedef struct {
    double strength; /* sigma_c (Pa); infinite: never breaks */
    double opening;  /* delta_c (m) */
    double beta;     /* weight of shear, in the criterion (5.3) and in the law; 0: normal only (5.17) */
    rg_form form;    /* intrinsic: every point is broken from the start and takes the total jump */
    rg_criterion criterion; /* mohr-coulomb: with Coulomb's friction and a conserving activation */
    rg_activation activation;
    double onset;  /* conserving activation: opening from which the law starts, in units as RG_ONSET's */
    double beta_s; /* of the penalty; likewise read by it alone */
    rg_law law;
    double shape[RG_LAW_SHAPE];     /* the law's own parameters */
    const struct rg_user_law *user; /* of a user's: its library */
    double separation;              /* effective opening of full separation (m) */
    rg_contact contact;             /* potential: tractions turn the mid-surface besides */
    double slope;   /* contact is at least so stiff (Pa/m): the law's own slope where it starts with one */
    rg_shear shear; /* fading: with a conserving activation */
    rg_sliding sliding;
    double friction; /* coefficient mu of Coulomb's */
    rg_rise rise;
} rg_cohesive;

/* Index of value k of RG_RISE at point q of interface i, in crack state of `stride` values a block. */
static inline size_t rg_rise_index(const rg_cohesive *law, size_t i, int q, int k, size_t stride) {
    size_t friction = law->sliding == RG_SLIDING_COULOMB ? RG_FRICTION_BLOCK : 0;
    size_t loan = law->criterion == RG_CRITERION_MOHR_COULOMB ? RG_LOAN_BLOCK : 0;
    return (i / RG_LANES + 1) * stride - friction - loan - RG_RISE_BLOCK +
           (size_t)(q * RG_RISE + k) * RG_LANES + i % RG_LANES;
}

typedef struct {
    rg_cohesive law;
    double time;                  /* time of the state (s), recorded where a point switches */
    double step;                  /* time since the state before (s) */
    const rg_real *u;             /* displacement (m) */
    const rg_real *traction;      /* area-weighted corner tractions of the tile's elements (N) */
    size_t first_tile_face;       /* blocks from here on are tile-boundary faces */
    const rg_real *ghost;         /* tile-boundary faces: trace of the other side (m) */
    const rg_real *own_tractions; /* tile-boundary faces: the tile's traction rows (N) */
    const rg_real *tractions;     /* tile-boundary faces: all traction rows of this rank (N) */
    const int32_t *side[2]; /* [interface]: links of the minus and plus side; of a tile-boundary face, `side`
                               and `other` */
    const rg_real *geom;    /* interface geometry */
    const rg_real *scale; /* NULL: all faces alike; else [block][2][lane]: strength and critical opening over
                             those of the law */
    const rg_real *beta, *friction,
        *rise;         /* NULL: the law's; else [block][lane], of each face; rise: exponent */
    uint8_t *broken;   /* [interface] in/out: bit q set where point q has switched */
    uint8_t *unlinked; /* [interface] in/out: bit q set where point q has no DG terms (never set for a closed
                          point under flux contact) */
    uint8_t *active;   /* [block] in/out: not 0 where some lane of the block has a broken point */
    rg_real *crack;    /* crack state, in/out */
    size_t crack_stride; /* values from one block's crack state to the next: RG_CRACK_BLOCK, the memory of the
                            law, with shear that fades RG_BOND_BLOCK, with strengths that rise RG_RISE_BLOCK,
                            with Mohr and Coulomb's criterion RG_LOAN_BLOCK and with Coulomb's friction
                            RG_FRICTION_BLOCK; or 0 to share one */
    rg_real *force;      /* out: g, nodal force on the minus side (N) */
    rg_real *turn;       /* out, of contact as a potential and only of broken faces: nodal force on either
                            side (N), laid out as `force` */
} rg_interface_args;

/* Central difference, in two parts: in the element sweep v += dt M^-1 (bulk force + interfaces inside the
 * tile), and in the boundary sweep, once they are known, v += dt M^-1 tile-boundary faces. */
typedef struct {
    double density;
    rg_mass mass;
    rg_sweep sweep;
    rg_contact contact;
    double dt; /* s */
    const rg_real *geom;
    const rg_real *force;  /* bulk; read in the element sweep */
    const rg_real *iforce; /* interface */
    const rg_real *turn;   /* of broken interfaces, on either side alike; read where contact is a potential */
    const uint8_t *broken; /* [interface], likewise */
    const int32_t *interface; /* links */
    rg_real *velocity;        /* in/out (m/s) */
    rg_real *step_velocity;   /* NULL, or out: v + dt_now M^-1 (...), in the boundary sweep += */
    double dt_now;
} rg_kick_args;

/* u += dt v. */
typedef struct {
    double dt;
    const rg_real *velocity;
    rg_real *u;
} rg_drift_args;

/* State for ledger and output, per element or interface. Output rows count from the first block asked for:
 * block `begin` writes row 0. */
typedef struct {
    const rg_bulk_args *bulk;
    double *energy;   /* out, or NULL: [row][lane] sum_g (V/4) W(F_g + R_g) (J) */
    double *cauchy;   /* out, or NULL: [row][4 Gauss points][xx yy zz yz xz xy][lane] Cauchy stress (Pa) */
    double *internal; /* out, or NULL: [row][4 Gauss points][RG_INTERNAL][lane]; only of a material with
                         history */
} rg_bulk_state_args;

typedef struct {
    const rg_bulk_state_args *state;
    const rg_real *stress;
} rg_prestress_state_args;

/* Internal variables that are output: damage, 0 to 1; regime of the cracks, 1, 2, 3 (0: no stress);
 * equivalent plastic strain; plastic part of log J; pressure that bulking has added (Pa); temperature (K). 0
 * where the material has none. */
enum {
    RG_INTERNAL_DAMAGE,
    RG_INTERNAL_REGIME,
    RG_INTERNAL_PLASTIC,
    RG_INTERNAL_VOLUME,
    RG_INTERNAL_BULKING,
    RG_INTERNAL_TEMPERATURE,
    RG_INTERNAL,
};

typedef struct {
    double density;
    rg_mass mass;
    const rg_real *geom, *velocity;
    double *energy; /* out: [row][lane] v M v / 2 (J) */
} rg_kinetic_args;

/* Parts of the energy; contact: of closed points, with what they store while friction holds them. */
enum { RG_E_PENALTY, RG_E_COHESIVE, RG_E_CONTACT, RG_E_DISSIPATED, RG_E_UNRESOLVED, RG_E_INTERFACE };

typedef struct {
    const rg_interface_args *interface;
    double *energy; /* out: [row][RG_E_INTERFACE][lane] (J) */
} rg_interface_state_args;

/* Contact of two faces of different elements, A and B (contact/pair.h), of corners as they are now, ordered
 * so that (x1 - x0) x (x2 - x0) points out of the element. Double, whatever the precision of this build. */
typedef struct {
    int32_t face[2];  /* A, B: rows of `corner` */
    double stiffness; /* kappa (Pa/m) */
    double skin;      /* depth at which they start to press (m) */
    double limit;     /* faces deeper than this do not see each other (m) */
    double fading;    /* 0; else area of the one face that both were (m^2), which has a contact of its own as
                         long as they lie upon each other */
    double parting;   /* 0; else an area (m^2): they lie behind each other, as parts of one solid, and touch
                         once their common corners have come apart by its root */
    double common[2][3]; /* mean of the corners that they have in common: weights of those of A, of B */
    double shear;        /* of the spring that friction is while it holds (Pa/m); at most kappa */
    double friction[2];  /* Coulomb's coefficient until it slides, while it does */
    double impedance;    /* most that damping takes of a rate of depth (Pa s/m) */
} rg_contact_pair;

/* What friction remembers of a pair that presses (contact/friction.h). */
enum {
    RG_GRIP_ANCHOR,                          /* [A, B][2]: barycentric coordinates of the spring's ends */
    RG_GRIP_STRETCH = RG_GRIP_ANCHOR + 4,    /* [2] in the frame of A's first edge (m) */
    RG_GRIP_STIFFNESS = RG_GRIP_STRETCH + 2, /* (N/m); 0: the pair does not press, and nothing else counts */
    RG_GRIP_SLIDES,
    RG_GRIP
};

typedef struct {
    const double *corner; /* [face][3][3] (m) */
    const double *box;    /* [face][lowest, highest][3] of its corners: rg_contact_box */
    const double *sunk;   /* [face]: the larger one of both adds to the skin (m) */
    const rg_contact_pair *pair;
    double *force;  /* out: [pair][A, B][3 corners][3] (N) */
    double *energy; /* out: [pair] (J); 0: they do not touch, and their forces are not written */
    double *depth;  /* out: [pair] largest depth where they are over each other; 0: they are not, or nowhere
                       less deep than the limit, or have no share (m) */
    double *grip;   /* in and out: [pair][RG_GRIP]; NULL: no friction. Its spring is part of `energy` */
    double *heat;   /* out, with friction: [pair] what it took in the step that led here (J) */
    const double *rate; /* [face][3][3] velocities (m/s); NULL: no damping (contact/damping.h) */
    double damping, dt; /* c (s/m); step (s) that `stiffer` is for */
    double *drag;       /* out, with damping: [pair][A, B][3 corners][3] its part of `force` (N) */
    double *stiffer; /* likewise: [pair] with which stiffness the pair counts in a bound of the step (Pa/m) */
} rg_contact_args;

/* The box of a face, out of its corners. */
static inline void rg_contact_box(const double *corner, double *box) {
    for (int c = 0; c < 3; c++) {
        double a = corner[c], b = corner[3 + c], d = corner[6 + c];
        double low = a < b ? a : b, high = a < b ? b : a;
        box[c] = d < low ? d : low;
        box[3 + c] = d > high ? d : high;
    }
}

/* A set of kernels. `begin` and `end` count blocks; of contact, pairs. */
typedef struct {
    const char *name; /* "x86-64-v4", ..., "reference" */
    int vector;       /* bytes of a vector; 0: it has none */
    void (*send)(const rg_trace_args *args, size_t begin, size_t end);
    void (*send_tractions)(const rg_trace_args *args, size_t begin, size_t end);
    void (*receive)(const rg_trace_args *args, size_t begin, size_t end);
    void (*bulk)(const rg_bulk_args *args, size_t begin, size_t end);
    void (*interface)(const rg_interface_args *args, size_t begin, size_t end);
    void (*kick)(const rg_kick_args *args, size_t begin, size_t end);
    void (*drift)(const rg_drift_args *args, size_t begin, size_t end);
    void (*bulk_state)(const rg_bulk_state_args *args, size_t begin, size_t end);
    void (*kinetic)(const rg_kinetic_args *args, size_t begin, size_t end);
    void (*interface_state)(const rg_interface_state_args *args, size_t begin, size_t end);
    void (*viscosity)(const rg_viscosity_args *args, size_t begin, size_t end);
    void (*contact)(const rg_contact_args *args, size_t begin, size_t end);
    void (*prestress)(const rg_prestress_args *args, size_t begin, size_t end);
    void (*prestress_state)(const rg_prestress_state_args *args, size_t begin, size_t end);
} rg_kernels;

/* The opening from which a continuous activation starts is eps = RG_ONSET sigma_c h_s / (beta_s (lambda + 2
 * mu)), that is RG_ONSET strength area / (PEN_ISO + PEN_NORM): small against the jump at which the penalty
 * alone would carry the strength, large against rounding. */
#define RG_ONSET 0.02

extern const rg_kernels rg_kernels_reference; /* scalar, written after the equations; never used by a run */

/* All sets this machine can run, fastest first; returns their number (at most `capacity`). */
int rg_kernels_available(const rg_kernels *sets[], int capacity);

/* The set to use: the one that environment variable RHEGMA_ISA names, else the fastest. NULL if the named one
 * does not exist or cannot run here. */
const rg_kernels *rg_kernels_select(void);

#endif
