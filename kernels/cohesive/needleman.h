/* Exponential potential (A. Needleman 1990; thesis 3.6): with z = 16 e/9, x = D_n/delta_c, y = |D_t|/delta_c,
 *     phi = (9/16) sigma_c delta_c (1 - (1 + z x - alpha z^2 y^2/2) exp(-z x))
 *     T_n = (9/16) sigma_c z (z x - alpha z^2 y^2/2) exp(-z x),   T_t = (9/16) sigma_c alpha z^2 y exp(-z x)
 * Work of separation G_c = (9/16) sigma_c delta_c; strength at z x = 1; it carries less than 1 % of the
 * strength beyond x = 1.6. Sliding alone never separates; the law is meant for little of it. Stiffness of
 * opening at most (9/16) z^2 (1 + alpha z^2 y^2/2) sigma_c/delta_c, counted as (1 + alpha), that is for
 * sliding up to 0.29 delta_c; of sliding (9/16) alpha z^2 sigma_c/delta_c.
 *
 * Unloading: back along the same curves, as published, so nothing is dissipated: what an opened point has
 * taken up stays in the ledger as cohesive energy. Closure: the potential is taken at x = 0; contact bears
 * the normal part. */
#if defined(RG_LAW_FUNCTIONS) && !defined(RG_COHESIVE_NEEDLEMAN_H)
#define RG_COHESIVE_NEEDLEMAN_H

#define RG_NEEDLEMAN_Z (16 * 2.71828182845904523536 / 9)

RG_INLINE void rg_needleman_respond(const rg_law_point *p, rg_law_state *state, rg_law_response *r) {
    (void)state;
    rg_vec z = rg_splat(RG_NEEDLEMAN_Z) * p->inverse, zx = z * rg_max(p->normal, rg_splat(0.0));
    rg_vec alpha = rg_splat(p->law->shape[0]), bent = 0.5 * alpha * z * z * p->sliding_square;
    rg_vec scale = p->area * rg_splat(RG_NEEDLEMAN_Z * 9 / 16) * p->strength * rg_exp(-zx);
    r->normal = rg_select(p->normal > 0.0, scale * (zx - bent), rg_splat(0.0));
    r->shear = scale * alpha * z;
    r->weight = rg_splat(1.0);
}

RG_INLINE void rg_needleman_energy(const rg_law_point *p, const rg_law_state *state, rg_law_energy *e) {
    (void)state;
    rg_vec z = rg_splat(RG_NEEDLEMAN_Z) * p->inverse, zx = z * rg_max(p->normal, rg_splat(0.0));
    rg_vec bent = 0.5 * rg_splat(p->law->shape[0]) * z * z * p->sliding_square;
    e->stored =
        p->area * rg_splat(9. / 16) * p->strength * p->opening * (1.0 - (1.0 + zx - bent) * rg_exp(-zx));
    e->dissipated = rg_splat(0.0);
}
#endif

#if defined(RG_LAW_REFERENCES) && !defined(RG_COHESIVE_NEEDLEMAN_REFERENCE)
#define RG_COHESIVE_NEEDLEMAN_REFERENCE
static void rg_needleman_reference(const rg_law_query *p, double state[], rg_law_answer *a) {
    (void)state;
    double z = 16 * exp(1) / 9, x = fmax(0, p->normal) / p->opening, y = p->sliding / p->opening;
    double s = 9. / 16 * p->strength, bent = p->shape[0] * z * z * y * y / 2, decay = exp(-z * x);
    a->normal = p->normal > 0 ? s * z * (z * x - bent) * decay : 0;
    a->sliding = s * p->shape[0] * z * z * y * decay;
    a->stored = s * p->opening * (1 - (1 + z * x - bent) * decay);
}
#endif

#ifdef RG_LAW /* (9/16) z^2 = e z, rounded up */
RG_LAW(NEEDLEMAN, needleman, "needleman", "exponential potential, reversible (Needleman 1990)",
       RG_FORMS_INTRINSIC | RG_NORMAL_MEASURE, 0.5625, 1.6, 13.137 * (1 + shape[0]), 13.137 * shape[0], 0)
#endif
#ifdef RG_LAW_PARAMETER
RG_LAW_PARAMETER(NEEDLEMAN, 0, "interface.needleman.alpha", NULL, 0, 100, 1,
                 "stiffness of sliding over that of opening")
#endif
