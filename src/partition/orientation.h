/* Axes of anisotropic solids that differ from element to element: by expressions or a field of the mesh. */
#ifndef RG_ORIENTATION_H
#define RG_ORIENTATION_H

#include "case/case.h"
#include "kernels.h"
#include "mesh/mesh.h"

/* Whether any material of the case has such axes. */
bool rg_orientations_vary(const rg_case *c);

/* Makes `turn` of the part, whose elements have their materials, and fills `own` of it; `beside` is as on the
 * surface. Ends the run with a message if an expression is not finite at the centroid of an element, or the
 * mesh file has no such field, or one of another shape, or with what is no number. Collective. */
void rg_orientations_find(const rg_case *c, rg_part *part, MPI_Comm comm);

/* The material with these axes, rows of unit length, in place of those of the mesh. */
rg_material rg_material_along(const rg_material *m, const double axis[3][3]);

/* The material with these Euler angles after Bunge (degrees) beside its own. */
rg_material rg_material_turned(const rg_material *m, const double angles[3]);

#endif
