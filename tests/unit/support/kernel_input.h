/* Random but valid input for the kernels: a jittered box of tetrahedra, deformed with a discontinuity at
 * every face, and interfaces with tractions and crack states of every regime. The whole mesh is one tile
 * without tile-boundary faces. The physics is a function of (kind, seed) alone; `order` shuffles which slot
 * (block and lane) each element and interface sits in. */
#ifndef RG_KERNEL_INPUT_H
#define RG_KERNEL_INPUT_H

#include <stdint.h>
#include "kernels.h"

enum {
    INPUT_ELEMENTS = 108,
    INPUT_INTERFACES = 174,
    INPUT_EBLOCKS = (INPUT_ELEMENTS + RG_LANES - 1) / RG_LANES,
    INPUT_IBLOCKS = (INPUT_INTERFACES + RG_LANES - 1) / RG_LANES,
    INPUT_ESLOTS = INPUT_EBLOCKS * RG_LANES,
    INPUT_ISLOTS = INPUT_IBLOCKS * RG_LANES,
    INPUT_SETS = 8, /* room for all sets of kernels */
    INPUT_LAWS = 10,
};

#define INPUT_SIZE 1e-4 /* edge of a cube of the mesh (m) */

/* SMALL: strains and jumps around 1e-2. LARGE: rotated by 2 rad, stretched by up to 20 %. */
typedef enum { INPUT_SMALL, INPUT_LARGE } input_kind;

/* Traction classes of interfaces, in units of the strength. */
typedef enum { PULL_WEAK, PULL_BELOW, PULL_NORMAL, PULL_SHEAR, PULL_COMPRESSED, PULLS } input_pull;

/* Regimes of points that are already broken. */
typedef enum { CRACK_LOADING, CRACK_UNLOADING, CRACK_CLOSED, CRACK_FAILED, CRACKS } input_crack;

typedef struct {
    rg_material material;
    rg_cohesive law;
    uint64_t seed;
    double gradient[3][3];                          /* F of the smooth part */
    double x[INPUT_ELEMENTS][RG_NODES][3];          /* reference positions (m) */
    size_t element[INPUT_ESLOTS];                   /* slot of element e; padding behind */
    size_t slot[INPUT_ISLOTS];                      /* slot of interface i; padding behind */
    rg_real *u, *velocity, *pull, *geom, *traction; /* element fields; pull: some bulk force */
    rg_real *igeom, *ipull, *crack;                 /* interface fields; ipull: some interface force */
    int32_t *neighbour, *interface, *side[2];
    uint8_t *broken, *unlinked, *active, *cracked;
} input;

/* Allocates and fills everything but cracks: no point broken, tractions of each interface's class. */
input *input_make(input_kind kind, rg_cohesive law, uint64_t seed, uint64_t order);

/* Makes its material one of that model, with parameters of its own that count. */
void input_set_model(input *in, rg_material_model model);

void input_free(input *in);

/* Breaks each point of the mesh with the given probability, in its regime. Under flux contact some broken
 * points are linked, as if closed before. */
void input_break(input *in, double probability);

/* Breaks interface i's point q with opening w (current normal component, one tangential component, in units
 * of the law's) and history `largest`. The normal is the one the smooth deformation gives. */
void input_break_point(input *in, size_t i, int q, const double w[2], double largest);

input_pull input_pull_of(const input *in, size_t i);
input_crack input_crack_of(const input *in, size_t i, int q);

/* Jump u+ - u- at point q of the interface in slot s (m). */
void input_jump(const input *in, size_t s, int q, double jump[3]);

/* Area vector of the interface in slot s (m^2); returns its length. */
double input_area(const input *in, size_t s, double vector[3]);

/* Points of face f of the element in slot s that have left the lift. */
uint8_t input_unlinked(const input *in, size_t s, int f);

/* Sets `cracked` and `active` from `unlinked` and `broken`. */
void input_flags(input *in);

/* Kernel arguments that read the input and write to the given arrays (which may be NULL if not used). */
rg_bulk_args input_bulk_args(const input *in, rg_real *force, rg_real *traction, rg_real *stiffening);

rg_interface_args input_interface_args(const input *in, uint8_t *broken, uint8_t *unlinked, uint8_t *active,
                                       rg_real *crack, rg_real *force);

/* Zeroed, 64-byte aligned. */
void *input_alloc(size_t bytes);

/* All sets to test: the available ones and the reference; returns their number. */
int input_sets(const rg_kernels *sets[], int capacity);

/* Laws of every combination: criterion, activation, contact. */
extern const rg_cohesive input_laws[INPUT_LAWS];

/* Runs `test` for every set, deformation and law. */
void input_for_each_case(void (*test)(const rg_kernels *set, input_kind kind, rg_cohesive law));

#endif
