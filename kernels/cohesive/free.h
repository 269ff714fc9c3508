/* No tension and no memory: a point that has switched bears contact alone; for tests, and to see what a body
 * does whose cracks cost nothing. Uses strength, in the criterion. Work of separation 0, so that a conserving
 * activation books all that a switch sets free as `unresolved` (RG_WORKLESS).
 *
 * The time step of the intrinsic form is found with this law: shape[0] and shape[1] are stiffnesses of the
 * opening and of sliding (Pa/m) without end, zero in every run. */
#if defined(RG_LAW_FUNCTIONS) && !defined(RG_COHESIVE_FREE_H)
#define RG_COHESIVE_FREE_H

RG_INLINE void rg_free_respond(const rg_law_point *p, rg_law_state *state, rg_law_response *r) {
    (void)state;
    r->normal = p->area * rg_splat(p->law->shape[0]) * rg_max(p->normal, rg_splat(0.0));
    r->shear = p->area * rg_splat(p->law->shape[1]);
    r->weight = rg_splat(1.0);
}

RG_INLINE void rg_free_energy(const rg_law_point *p, const rg_law_state *state, rg_law_energy *e) {
    (void)state;
    rg_vec open = rg_max(p->normal, rg_splat(0.0));
    e->stored = 0.5 * p->area *
                (rg_splat(p->law->shape[0]) * open * open + rg_splat(p->law->shape[1]) * p->sliding_square);
    e->dissipated = rg_splat(0.0);
}
#endif

#if defined(RG_LAW_REFERENCES) && !defined(RG_COHESIVE_FREE_REFERENCE)
#define RG_COHESIVE_FREE_REFERENCE
static void rg_free_reference(const rg_law_query *p, double state[], rg_law_answer *a) {
    (void)state;
    a->normal = p->shape[0] * fmax(0, p->normal);
    a->sliding = p->shape[1] * p->sliding;
    a->stored = (a->normal * fmax(0, p->normal) + a->sliding * p->sliding) / 2;
}
#endif

#ifdef RG_LAW
RG_LAW(FREE, free, "free", "no traction at all: for tests", RG_FORMS_DG | RG_FORMS_INTRINSIC | RG_WORKLESS, 0,
       0, 0, 0, 0)
#endif
