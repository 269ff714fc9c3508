/* Exponential potential of opening and sliding (X.-P. Xu & A. Needleman 1993; thesis 3.7-3.9): with
 * x = D_n/delta_c, y = |D_t|/delta_t, delta_t = delta_c/beta, phi_n = e sigma_c delta_c,
 *     phi = phi_n (1 + exp(-x) ((1 - r + x) (1 - q)/(r - 1) - (q + (r - q)/(r - 1) x) exp(-y^2)))
 *     T_n = (phi_n/delta_c) exp(-x) (x exp(-y^2) + (1 - q)/(r - 1) (1 - exp(-y^2)) (r - x))
 *     T_t = 2 (phi_n/delta_t) y (q + (r - q)/(r - 1) x) exp(-x - y^2)
 * q is the ratio of the works of separation in pure sliding and in pure opening; r delta_c is the opening
 * after complete shear separation without normal traction. Work of separation (opening) G_c = phi_n; less
 * than 1 % of the strength is left beyond x = 7.64. Stiffness (q = 1) at most e sigma_c/delta_c in opening,
 * 2 beta^2 times that in sliding.
 *
 * Unloading: back along the same curves, as published, so nothing is dissipated: what an opened point has
 * taken up stays in the ledger as cohesive energy. Closure: the potential is taken at x = 0; contact bears
 * the normal part. */
#if defined(RG_LAW_FUNCTIONS) && !defined(RG_COHESIVE_XU_NEEDLEMAN_H)
#define RG_COHESIVE_XU_NEEDLEMAN_H

/* x, exp(-x) and exp(-y^2) */
RG_INLINE void rg_xu_needleman_decay(const rg_law_point *p, rg_vec *x, rg_vec *opened, rg_vec *slid) {
    rg_vec beta = rg_splat(p->law->beta) * p->inverse;
    *x = rg_max(p->normal, rg_splat(0.0)) * p->inverse;
    *opened = rg_exp(-*x);
    *slid = rg_exp(-(beta * beta * p->sliding_square));
}

RG_INLINE void rg_xu_needleman_respond(const rg_law_point *p, rg_law_state *state, rg_law_response *w) {
    (void)state;
    double q = p->law->shape[0], r = p->law->shape[1];
    rg_vec x, opened, slid, beta = rg_splat(p->law->beta);
    rg_xu_needleman_decay(p, &x, &opened, &slid);
    rg_vec scale = p->area * rg_splat(2.71828182845904523536) * p->strength * opened;
    rg_vec across = x * slid + rg_splat((1 - q) / (r - 1)) * (1.0 - slid) * (rg_splat(r) - x);
    w->normal = rg_select(p->normal > 0.0, scale * across, rg_splat(0.0));
    w->shear =
        2.0 * scale * beta * beta * p->inverse * (rg_splat(q) + rg_splat((r - q) / (r - 1)) * x) * slid;
    w->weight = rg_splat(1.0);
}

RG_INLINE void rg_xu_needleman_energy(const rg_law_point *p, const rg_law_state *state, rg_law_energy *e) {
    (void)state;
    double q = p->law->shape[0], r = p->law->shape[1];
    rg_vec x, opened, slid;
    rg_xu_needleman_decay(p, &x, &opened, &slid);
    rg_vec bracket = (rg_splat(1 - r) + x) * rg_splat((1 - q) / (r - 1)) -
                     (rg_splat(q) + rg_splat((r - q) / (r - 1)) * x) * slid;
    e->stored =
        p->area * rg_splat(2.71828182845904523536) * p->strength * p->opening * (1.0 + opened * bracket);
    e->dissipated = rg_splat(0.0);
}
#endif

#if defined(RG_LAW_REFERENCES) && !defined(RG_COHESIVE_XU_NEEDLEMAN_REFERENCE)
#define RG_COHESIVE_XU_NEEDLEMAN_REFERENCE
static void rg_xu_needleman_reference(const rg_law_query *p, double state[], rg_law_answer *a) {
    (void)state;
    double q = p->shape[0], r = p->shape[1], work = exp(1) * p->strength * p->opening;
    double x = fmax(0, p->normal) / p->opening, y = p->sliding * p->beta / p->opening;
    double ex = exp(-x), ey = exp(-y * y), mixed = q + (r - q) / (r - 1) * x;
    if (p->normal > 0)
        a->normal = work / p->opening * ex * (x * ey + (1 - q) / (r - 1) * (1 - ey) * (r - x));
    a->sliding = 2 * work * p->beta / p->opening * y * mixed * ex * ey;
    a->stored = work + work * ex * ((1 - r + x) * (1 - q) / (r - 1) - mixed * ey);
}
#endif

#ifdef RG_LAW
RG_LAW(XU_NEEDLEMAN, xu_needleman, "xu-needleman",
       "exponential in opening and sliding, reversible (Xu & Needleman 1993)", RG_FORMS_INTRINSIC,
       2.71828182845904523536, 7.64,
       2.71828182845904523536 * (1 + fabs(1 - shape[0]) * (1 + shape[1]) / (1 - shape[1])),
       2 * 2.71828182845904523536 * fmax(shape[0], (shape[0] - shape[1]) / (1 - shape[1])) * beta * beta, 0)
#endif
#ifdef RG_LAW_PARAMETER
RG_LAW_PARAMETER(XU_NEEDLEMAN, 0, "interface.xu-needleman.q", NULL, 0, 10, 1,
                 "work of separation by sliding over that by opening")
RG_LAW_PARAMETER(
    XU_NEEDLEMAN, 1, "interface.xu-needleman.r", NULL, 0, 0.9, 0,
    "opening after complete separation by sliding without normal traction, over the critical one")
#endif
