/* Which element is of which material. */
#ifndef RG_MATERIAL_MAP_H
#define RG_MATERIAL_MAP_H

#include "case/case.h"
#include "mesh/mesh.h"

/* Fills `material` and `beside` of the part's elements: number 0 that of `material`, then those of
 * `materials`, of which the last one that claims an element has it. Ends the run with a message if a volume
 * set is unknown, an expression is not finite at the centroid of an element, or a material claims none
 * (later ones may take all of its elements: rg_estimate_warn). Collective. */
void rg_materials_assign(const rg_case *c, rg_part *part, MPI_Comm comm);

#endif
