/* Polynomial potential (A. Needleman 1987; thesis 3.1): with x = D_n/delta_c, y = |D_t|/delta_c, for x < 1
 *     phi = (27/4) sigma_c delta_c (x^2/2 (1 - 4 x/3 + x^2/2) + alpha y^2/2 (1 - x)^2)
 *     T_n = (27/4) sigma_c (x (1 - x)^2 - alpha y^2 (1 - x)),   T_t = (27/4) sigma_c alpha y (1 - x)^2
 * and no traction from x = 1 on. Work of separation G_c = (9/16) sigma_c delta_c. Sliding alone never
 * separates. Stiffness of opening at most (27/4) (1 + alpha y^2) sigma_c/delta_c, counted as (1 + alpha),
 * that is for sliding up to delta_c; of sliding (27/4) alpha sigma_c/delta_c.
 *
 * Unloading: back along the same curves, as published; a point that has reached x = 1 stays separated, so all
 * of G_c is dissipated there. Closure: the potential is taken at x = 0; contact bears the normal part. */
#if defined(RG_LAW_FUNCTIONS) && !defined(RG_COHESIVE_POLYNOMIAL_H)
#define RG_COHESIVE_POLYNOMIAL_H

RG_INLINE rg_mask rg_polynomial_whole(const rg_law_point *p, const rg_law_state *state) {
    return state->largest < p->opening;
}

RG_INLINE void rg_polynomial_respond(const rg_law_point *p, rg_law_state *state, rg_law_response *r) {
    rg_vec alpha = rg_splat(p->law->shape[0]), x = rg_max(p->normal, rg_splat(0.0)) * p->inverse;
    rg_vec y2 = p->sliding_square * p->inverse * p->inverse, left = 1.0 - x;
    rg_vec scale = p->area * rg_splat(6.75) * p->strength, none = rg_splat(0.0);
    rg_mask whole = rg_polynomial_whole(p, state), open = whole & (p->normal > 0.0);
    r->normal = rg_select(open, scale * left * (x * left - alpha * y2), none);
    r->shear = rg_select(whole, scale * alpha * p->inverse * left * left, none);
    r->weight = rg_splat(1.0);
}

RG_INLINE void rg_polynomial_energy(const rg_law_point *p, const rg_law_state *state, rg_law_energy *e) {
    rg_vec alpha = rg_splat(p->law->shape[0]), x = rg_max(p->normal, rg_splat(0.0)) * p->inverse;
    rg_vec y2 = p->sliding_square * p->inverse * p->inverse, left = 1.0 - x, none = rg_splat(0.0);
    rg_vec scale = p->area * rg_splat(6.75) * p->strength * p->opening;
    rg_vec opening = x * x * (0.5 - x * (rg_splat(2. / 3) - 0.25 * x));
    rg_mask whole = rg_polynomial_whole(p, state);
    e->stored = rg_select(whole, scale * (opening + 0.5 * alpha * y2 * left * left), none);
    e->dissipated = rg_select(whole, none, scale * rg_splat(1. / 12));
}
#endif

#if defined(RG_LAW_REFERENCES) && !defined(RG_COHESIVE_POLYNOMIAL_REFERENCE)
#define RG_COHESIVE_POLYNOMIAL_REFERENCE
static void rg_polynomial_reference(const rg_law_query *p, double state[], rg_law_answer *a) {
    double s = 27. / 4 * p->strength, x = fmax(0, p->normal) / p->opening, y = p->sliding / p->opening;
    double alpha = p->shape[0];
    if (state[0] >= p->opening) {
        a->dissipated = s * p->opening / 12;
        return;
    }
    a->normal = p->normal > 0 ? s * (x * (1 - 2 * x + x * x) + alpha * y * y * (x - 1)) : 0;
    a->sliding = s * alpha * y * (1 - 2 * x + x * x);
    a->stored =
        s * p->opening * (x * x / 2 * (1 - 4 * x / 3 + x * x / 2) + alpha * y * y / 2 * (1 - 2 * x + x * x));
}
#endif

#ifdef RG_LAW
RG_LAW(POLYNOMIAL, polynomial, "polynomial",
       "cubic, from a potential of opening and sliding (Needleman 1987)",
       RG_FORMS_INTRINSIC | RG_NORMAL_MEASURE, 0.5625, 1, 6.75 * (1 + shape[0]), 6.75 * shape[0], 0)
#endif
#ifdef RG_LAW_PARAMETER
RG_LAW_PARAMETER(POLYNOMIAL, 0, "interface.polynomial.alpha", NULL, 0, 100, 1,
                 "stiffness of sliding over that of opening")
#endif
