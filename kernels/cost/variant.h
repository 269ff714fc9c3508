/* What a cost depends on. */
#ifndef RG_COST_VARIANT_H
#define RG_COST_VARIANT_H

#include <stdbool.h>

#include "materials.h"
#include "modes.h"

/* The work asked for and the state of the mesh. Each kernel reads the members that concern it. */
typedef struct {
    rg_material_model model; /* bulk, bulk_state */
    rg_gradient gradient;    /* bulk, bulk_state */
    rg_mass mass;            /* kick, kinetic */
    bool cauchy;             /* bulk_state: writes the stress, not the energy alone */
    bool advance;            /* bulk: the history of the material goes on */
    double growing, panels;  /* ceramic: share of its points (by vectors) whose cracks grow; panels of each;
                                concrete: share of the points whose pores close */
    double flowing, newton;  /* share of the points that flow; iterations of each, of J2 where its hardening
                                saturates, else 0 */
    double unlinked; /* bulk, bulk_state: faces (0 to 4) of an element block with points that left the lift */
    double damaged;  /* interface, interface_state: share of the blocks in which some point is broken */
    double points;   /* interface: broken points (0 to 6) of such a block */
    double interfaces; /* blocks of interfaces per block of elements; 2 in one large tile */
    double tile_faces; /* step: blocks of tile-boundary faces among them, each face counted on both sides */
    double fill;       /* share of the lanes that carry an element or interface; the rest is padding */
} rg_cost_variant;

#endif
