/* How solids take a stress from before any deformation (element/prestress.c).
 *
 * Solids without limits have it beside their own, with moduli for what it stores: elastic ones, and the
 * viscoelastic one, in which it does not relax, as it has been there for long. In solids that flow it must
 * count against their limits, so it is a part of their own elastic strain: the history of the point begins
 * with an Fp as if the solid had been relieved of it, det Fp = 1, in Drucker and Prager's with a plastic
 * volume, in Johnson and Holmquist's with a pressure like that of bulking. In metals, whose limits know no
 * pressure, the mean of it is beside: a Kirchhoff stress of p at any strain, of energy p log J. The ceramic
 * of Deshpande and Evans has no such state: its flaws and their wings would depend on how it came there, as
 * the pores of Holmquist, Johnson and Cook's concrete would; nor is one known of a user's material with a
 * history. */
#ifndef RG_STRESSED_H
#define RG_STRESSED_H

#include <stdbool.h>

#include "materials.h"

/* Models that take no stress; that take one into their history; whose stress beside is a pressure alone. */
enum {
    RG_STRESS_NONE = (int)RG_MATERIAL_BIT_DESHPANDE_EVANS | (int)RG_MATERIAL_BIT_HOLMQUIST_JOHNSON_COOK,
    RG_STRESS_PRESSURE = (int)RG_MATERIAL_BIT_J2 | (int)RG_MATERIAL_BIT_JOHNSON_COOK,
    RG_STRESS_INSIDE = (int)RG_STRESS_PRESSURE | (int)RG_MATERIAL_BIT_DRUCKER_PRAGER |
                       (int)RG_MATERIAL_BIT_JOHNSON_HOLMQUIST,
};

/* Of a model of RG_STRESS_INSIDE, at a virgin point: its history with a stress at F = 1 (Pa, xx yy zz yz xz
 * xy), of which `stress` becomes what is to be beside. */
void rg_material_take_stress(const rg_material *m, double stress[6], double history[]);

/* What a stress beside is to be stored by: inverse of the stiffness at F = 1 (1/Pa), in the order above, of
 * shear strains twice those of the tensor. */
void rg_material_compliance(const rg_material *m, double out[6][6]);

/* The modulus over which a stress beside counts in the critical step (Pa). */
double rg_material_least_modulus(const rg_material *m);

#endif
