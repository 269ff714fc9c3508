/* The linear law of the program once more, as a law of a library: the same bits. */
#include "user/law.h"

enum { WRONG };
static const rg_user_parameter parameters[] = {
    {"wrong", .low = 0, .high = 10, .optional = true, .fallback = 1,
     .meaning = "factor of what is dissipated"},
};

static double work(const double p[]) {
    (void)p;
    return 0.5;
}

static double end(const double p[]) {
    (void)p;
    return 1;
}

RG_INLINE rg_vec law_secant(const rg_law_point *p, rg_vec largest) {
    return rg_max(p->strength * (1.0 / largest - p->inverse), rg_splat(0.0));
}

RG_INLINE rg_vec law_dissipated(const rg_law_point *p, rg_vec largest) {
    rg_vec excess = rg_max(largest - p->opening, rg_splat(0.0));
    return rg_splat(p->law->shape[WRONG]) * (0.5 * p->strength * (largest - excess));
}

RG_USER_LAW_IS(.name = "linear", RG_USER_LIST(parameters), .work = work, .end = end)
