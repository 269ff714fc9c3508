/* What a user's cohesive law includes: one that starts at the strength and unloads to the origin. Its state
 * is the largest effective opening so far. The file defines
 *
 *     RG_INLINE rg_vec law_secant(const rg_law_point *p, rg_vec largest)
 *         traction over opening (Pa/m) where the opening is the largest so far (m); it never grows, and is 0
 *         from full separation on
 *     RG_INLINE rg_vec law_dissipated(const rg_law_point *p, rg_vec largest)
 *         what is dissipated by then (J/m^2): the work done on the way there less secant largest^2/2
 *
 * with p->strength (Pa), p->opening (the critical one, m), p->inverse (1/m) and p->law->shape[], its
 * parameters, and says by RG_USER_LAW_IS(.name = ..., RG_USER_LIST(parameters), .work = ..., .end = ...) what
 * it is. The critical opening is energy/(work strength). The smallest opening is RG_OPENING_FLOOR. */
#ifndef RG_USER_LAW_H
#define RG_USER_LAW_H

#include <math.h>

#include "cohesive/cohesive.h"
#include "library.h"

#define RG_USER_LAW_IS(...) static const rg_user_law_facts rg_user_facts_here = {__VA_ARGS__};

#endif
