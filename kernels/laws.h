/* clang-format off */
/* The registry of cohesive laws: one line per law, the name of its file. No include guard: each file lists its
 * law by RG_LAW(NAME, name, word, meaning, forms, work, separation, normal_slope, shear_slope, memory) and its
 * own parameters by RG_LAW_PARAMETER(NAME, index, word, unit, low, high, fallback, meaning), where these are
 * defined, and gives its functions in vectors or as scalars where RG_LAW_FUNCTIONS or RG_LAW_REFERENCES is:
 *
 *   NAME, name    for identifiers: RG_LAW_NAME, rg_name_respond
 *   word, meaning in case files; what `rhegma keys` says of it
 *   forms         RG_FORMS_DG: starts rigid, at the strength;
 *                 RG_FORMS_INTRINSIC: starts with a slope, at zero; or both;
 *                 RG_LIMITS_STEP besides: memory and a parameter are those of rg_law_opening_rate.
 *                 To these a law may add RG_NORMAL_MEASURE, RG_ENVELOPE and RG_MIXED (cohesive/facts.h)
 *   work          work of separation over strength times critical opening
 *   separation    effective opening of full separation over the critical opening
 *   normal_slope  bound on the stiffness of opening, in strength over critical opening; 0 for laws that start
 *                 rigid. For the time step of the intrinsic form
 *   shear_slope   the same of sliding. Both may use shape[], the law's own parameters, and beta
 *   memory        values that a point remembers besides its largest opening
 */
/* clang-format on */
#include "cohesive/linear.h"
#include "cohesive/free.h"
#include "cohesive/exponential.h"
#include "cohesive/bilinear.h"
#include "cohesive/tvergaard.h"
#include "cohesive/polynomial.h"
#include "cohesive/needleman.h"
#include "cohesive/xu_needleman.h"
#include "cohesive/rate.h"
#include "cohesive/fatigue.h"
#include "cohesive/benzeggagh_kenane.h"
