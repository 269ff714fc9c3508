#include "reference_cohesive.h"

#define RG_LAW_REFERENCES
#include "cohesive_laws.h"
#undef RG_LAW_REFERENCES

rg_law_answer rg_reference_law(rg_law law, const rg_law_query *p, double state[1 + RG_LAW_MEMORY]) {
    static void (*const function[])(const rg_law_query *, double[], rg_law_answer *) = {
#define RG_LAW(NAME, name, ...) rg_##name##_reference,
#include "cohesive_laws.h"
#undef RG_LAW
    };
    rg_law_answer a = {0, 0, 0, 0};
    function[law](p, state, &a);
    return a;
}
