/* The interface kernel around a user's law, whose file RG_USER_SOURCE names: what `rhegma material --law`
 * compiles into a library. */
#define RG_USER_LAW
#include RG_USER_SOURCE

RG_INLINE void rg_user_respond(const rg_law_point *p, rg_law_state *state, rg_law_response *r) {
    rg_law_by_secant(p, law_secant(p, rg_max(state->largest, rg_splat(RG_OPENING_FLOOR))), r);
}

RG_INLINE void rg_user_energy(const rg_law_point *p, const rg_law_state *state, rg_law_energy *e) {
    rg_vec largest = rg_max(state->largest, rg_splat(RG_OPENING_FLOOR));
    e->stored = rg_law_stored(p, law_secant(p, largest));
    e->dissipated = p->area * law_dissipated(p, largest);
}

#define RG_INTERFACE_LAWS "user/law_line.h"
#include "element/interface.c"

static void points(const rg_cohesive *law, rg_user_law_point point[RG_LANES]) {
    for (int lane = 0; lane < RG_LANES; lane += RG_VLEN) {
        rg_law_point p = {.law = law};
        rg_vec largest;
        for (int l = 0; l < RG_VLEN; l++) {
            p.strength[l] = (rg_real)point[lane + l].strength;
            p.opening[l] = (rg_real)point[lane + l].opening;
            largest[l] = (rg_real)point[lane + l].largest;
        }
        p.inverse = 1.0 / p.opening;
        p.effective = p.normal = p.before = largest;
        rg_vec secant = law_secant(&p, largest), dissipated = law_dissipated(&p, largest);
        for (int l = 0; l < RG_VLEN; l++) {
            point[lane + l].secant = secant[l];
            point[lane + l].dissipated = dissipated[l];
        }
    }
}

extern const rg_user_law rg_user_here;
__attribute__((visibility("default"))) const rg_user_law rg_user_here = {
    .head = RG_USER_HEAD("law"),
    .facts = &rg_user_facts_here,
    .interface = RG_ISA_NAME(rg_interface),
    .interface_state = RG_ISA_NAME(rg_interface_state),
    .points = points,
};
