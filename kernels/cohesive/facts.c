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
    (void)shape; /* for builds in which no law asks for them */
    (void)beta;
    return facts[law];
}
