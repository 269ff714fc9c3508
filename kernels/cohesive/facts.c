#include "cohesive/facts.h"

#include <math.h>
#include <stddef.h>

rg_law_facts rg_law_facts_of(rg_law law, const double *shape, double beta) {
    const rg_law_facts facts[] = {
#define RG_LAW(NAME, name, word, meaning, forms, work, separation, normal_slope, shear_slope, memory)        \
    {word, forms, work, separation, {normal_slope, shear_slope}, memory},
#include "laws.h"
#undef RG_LAW
    };
    if (law == RG_LAW_USER) { /* until its library is known it may be any that starts rigid */
        double work = shape[RG_USER_WORK], end = shape[RG_USER_END];
        return (rg_law_facts){"user", RG_FORMS_DG, work > 0 ? work : 0.5, end > 0 ? end : 1, {0, 0}, 0};
    }
    (void)shape; /* for builds in which no law asks for them */
    (void)beta;
    return facts[law];
}
