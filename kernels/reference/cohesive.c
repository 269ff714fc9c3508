#include "reference/cohesive.h"

#include "cohesive/facts.h"

#define RG_LAW_REFERENCES
#include "laws.h"
#undef RG_LAW_REFERENCES

rg_law_answer rg_reference_law(rg_law law, const rg_law_query *p, double state[1 + RG_LAW_MEMORY]) {
    static void (*const function[])(const rg_law_query *, double[], rg_law_answer *) = {
#define RG_LAW(NAME, name, ...) rg_##name##_reference,
#include "laws.h"
#undef RG_LAW
    };
    rg_law_answer a = {0, 0, 0, 0};
    function[law](p, state, &a);
    return a;
}

rg_law_answer rg_reference_conserving(rg_law law, const rg_law_query *p, double onset,
                                      double state[1 + RG_LAW_MEMORY]) {
    rg_law_query at = *p; /* pure opening by the damage */
    state[0] = fmax(fmax(RG_REFERENCE_NOTHING, state[0]), p->effective - onset);
    if ((rg_law_facts_of(law, p->shape, p->beta).forms & RG_FOLLOWS) != 0) {
        at.onset = onset;
        return rg_reference_law(law, &at, state);
    }
    at.effective = at.normal = state[0];
    at.sliding = 0;
    rg_law_answer a = rg_reference_law(law, &at, state);
    double envelope = a.normal, largest = state[0] + onset;
    a.normal = envelope / largest * fmax(0, p->normal);
    a.sliding = envelope / largest * p->beta * p->beta * p->sliding;
    a.stored = envelope / 2 * (p->effective * p->effective / largest - onset);
    return a;
}
