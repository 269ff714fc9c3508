/* The materials of a case, as the kernels take them. */
#ifndef RG_MATERIAL_H
#define RG_MATERIAL_H

#include "case/case.h"
#include "kernels.h"

/* Elastic constants, density, and what else the model needs, ready for use at rest. */
rg_material rg_material_make(const rg_material_input *in);

/* Those of a case, [1 + c->others], from rg_alloc: caller frees. */
rg_material *rg_materials_of_case(const rg_case *c);

/* Largest eigenvalue of the acoustic tensor of any direction: lambda + 2 mu (Pa). */
double rg_material_modulus(const rg_material *m);

/* Constants of an isotropic solid whose acoustic tensor along the unit vector n, mu 1 + (lambda + mu) n n, is
 * no less than that of `m`: its own of one that is isotropic (Pa). */
void rg_material_face(const rg_material *m, const double n[3], double *lambda, double *mu);

/* Root of the acoustic tensor along the unit vector n over the density, xx yy zz yz xz xy (m/s): the traction
 * of waves that leave along n is density times it times the velocity. */
void rg_material_impedance(const rg_material *m, const double n[3], double z[6]);

/* Speed of dilatational and of shear waves in the undamaged solid (m/s): of an anisotropic one the largest of
 * all directions, and that in its mean over all orientations. */
double rg_material_dilatational(const rg_material *m);
double rg_material_shear(const rg_material *m);

/* Speed of the slowest plane wave of any direction (m/s). */
double rg_material_slowest(const rg_material *m);

/* Uniaxial strain of a solid that yields: the stress along it at the elastic limit, sY (lambda + 2 mu)/(2 mu)
 * (Pa), and the speed of the plastic waves that follow, sqrt((K + 4/3 G H/(3G + H))/rho) (m/s), H the slope
 * of the yield curve at its start. False, and nothing set, of a model without such a limit. */
bool rg_material_plastic_wave(const rg_material *m, double *limit, double *speed);

#endif
