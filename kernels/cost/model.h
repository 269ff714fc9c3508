/* What a kernel call costs: floating-point operations and bytes, written down by hand from the equations, so
 * that a measured time can be held against what the machine could do. perf/README.md explains the terms; a
 * test compares the operations with those the object code executes and the bytes with those a call is seen to
 * read and write. */
#ifndef RG_COST_MODEL_H
#define RG_COST_MODEL_H

#include "cost/variant.h"

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
