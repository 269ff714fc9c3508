/* The materials of a case, as the kernels take them. */
#ifndef RG_MATERIAL_H
#define RG_MATERIAL_H

#include "case/case.h"
#include "kernels.h"

/* Elastic constants, density, and what else the model needs, ready for use at rest. */
rg_material rg_material_make(const rg_material_input *in);

/* Those of a case, [1 + c->others], from rg_alloc: caller frees. */
rg_material *rg_materials_of_case(const rg_case *c);

/* Speed of dilatational and of shear waves in the undamaged solid (m/s). */
double rg_material_dilatational(const rg_material *m);
double rg_material_shear(const rg_material *m);

/* Uniaxial strain of a solid that yields: the stress along it at the elastic limit, sY (lambda + 2 mu)/(2 mu)
 * (Pa), and the speed of the plastic waves that follow, sqrt((K + 4/3 G H/(3G + H))/rho) (m/s), H the slope
 * of the yield curve at its start. False, and nothing set, of a model without such a limit. */
bool rg_material_plastic_wave(const rg_material *m, double *limit, double *speed);

#endif
