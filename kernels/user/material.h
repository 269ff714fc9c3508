/* What a user's material includes. The file then defines RG_HISTORY, the pointwise functions of
 * element/material_point.h (or, by user/scalar.h, one for a point at a time), and says by RG_USER_MATERIAL
 * what it is:
 *
 *     #include "user/material.h"
 *     #define RG_HISTORY 0
 *     RG_INLINE void material_step(const rg_bulk_args *args, rg_vec H[3][3], ...) { ... }
 *     RG_INLINE void material_state(const rg_material *m, rg_vec H[3][3], ...) { ... }
 *     static const rg_user_parameter parameters[] = {{.name = "young", .unit = "Pa", ...}, ...};
 *     static void moduli(const double parameter[], double *lambda, double *mu) { ... }
 *     RG_USER_MATERIAL(.name = "mine", RG_USER_LIST(parameters), .moduli = moduli)
 *
 * Parameters are in m->of.user.parameter, the moduli that follow from them in m->lambda and m->mu, the length
 * of the step in m->dt. What a function does not set of `out` is 0. */
#ifndef RG_USER_MATERIAL_H
#define RG_USER_MATERIAL_H

#include <math.h>

#include "element/material_point.h"
#include "library.h"
#include "vec_math.h"

#define RG_USER_MATERIAL(...) static const rg_user_facts rg_user_facts_here = {__VA_ARGS__};

/* user/material.c calls them by these names. */
#define material_step  rg_user_step
#define material_state rg_user_state

#endif
