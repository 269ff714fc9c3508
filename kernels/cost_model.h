/* What a kernel call costs: floating-point operations and bytes, written down by hand from the equations, so
 * that a measured time can be held against what the machine could do. perf/model.md explains the terms; a
 * test compares the operations with those the object code executes and the bytes with those a call is seen to
 * read and write. */
#ifndef RG_COST_MODEL_H
#define RG_COST_MODEL_H

#include <stdbool.h>

#include "materials.h"

typedef enum {
    RG_COST_BULK,
    RG_COST_INTERFACE,
    RG_COST_KICK,
    RG_COST_DRIFT,
    RG_COST_BULK_STATE,
    RG_COST_KINETIC,
    RG_COST_INTERFACE_STATE,
    RG_COST_VISCOSITY,
    RG_COST_KERNELS
} rg_cost_kernel;

/* The work asked for and the state of the mesh. Each kernel reads the members that concern it. */
typedef struct {
    rg_material_model model; /* bulk, bulk_state */
    bool lift;               /* bulk, bulk_state: variational form */
    bool lumped;             /* kick, kinetic: HRZ mass */
    bool cauchy;             /* bulk_state: writes the stress, not the energy alone */
    bool advance;            /* bulk: the history of the material goes on */
    double growing, panels;  /* ceramic: share of its points (by vectors) whose cracks grow; panels of each */
    double flowing, newton; /* ceramic, J2: share of its points that flow; iterations of each, of J2 where its
                               hardening saturates, else 0 */
    double unlinked; /* bulk, bulk_state: faces (0 to 4) of an element block with points that left the lift */
    double damaged;  /* interface, interface_state: share of the blocks in which some point is broken */
    double points;   /* interface: broken points (0 to 6) of such a block */
    double interfaces; /* blocks of interfaces per block of elements; 2 in one large tile */
    double seams;      /* step: blocks of seams among them, each face counted on both sides */
    double fill;       /* share of the lanes that carry an element or interface; the rest is padding */
} rg_cost_variant;

typedef struct {
    double flops; /* additions, subtractions, multiplications, divisions and roots, padding included; a fused
                     multiply-add is two; maxima, comparisons and selections are none */
    double minimal; /* bytes: each real value in or out once; no indices, no padding */
    double actual;  /* bytes to and from memory: whole blocks, with indices and flags; a line that is written
                       without  having been read is fetched first (write-allocate); what neighbours share is
                       fetched once */
} rg_cost;

/* Cost of one block (RG_LANES elements or interfaces). */
rg_cost rg_cost_block(rg_cost_kernel kernel, const rg_cost_variant *v);

/* Cost of one time step per block of elements. Forces, tractions and interface forces of a tile stay in the
 * cache; actual: what its two sweeps stream. Minimal: u and v in and out and the geometry of elements and
 * faces in, once. */
rg_cost rg_cost_step(const rg_cost_variant *v);

#endif
