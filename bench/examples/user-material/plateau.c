/* A law with a plateau, as of polymers: full strength up to an opening of `plateau` times the critical one,
 * then a straight fall to 0 at the critical one. Of a plateau of 0 it is the linear law. */
#include "user/law.h"

enum { PLATEAU };
static const rg_user_parameter parameters[] = {
    {"plateau", NULL, "share of the critical opening", .low = 0, .high = 0.9, .optional = true,
     .fallback = 0.3},
};

static double work(const double p[]) {
    return (1 + p[PLATEAU]) / 2;
}

static double end(const double p[]) {
    (void)p;
    return 1;
}

/* Traction over strength. */
RG_INLINE rg_vec traction(const rg_law_point *p, rg_vec x) {
    rg_vec falls = (1.0 - x) * rg_splat(1 / (1 - p->law->shape[PLATEAU]));
    return rg_max(rg_min(falls, rg_splat(1.0)), rg_splat(0.0));
}

RG_INLINE rg_vec law_secant(const rg_law_point *p, rg_vec largest) {
    return p->strength * traction(p, largest * p->inverse) / largest;
}

/* Work on the way less what is stored. */
RG_INLINE rg_vec law_dissipated(const rg_law_point *p, rg_vec largest) {
    rg_vec x = rg_min(largest * p->inverse, rg_splat(1.0)), plateau = rg_splat(p->law->shape[PLATEAU]);
    rg_vec fallen = rg_max(x - plateau, rg_splat(0.0));
    rg_vec lost = 0.5 * fallen * fallen * rg_splat(1 / (1 - p->law->shape[PLATEAU]));
    return p->strength * p->opening * (x - lost - 0.5 * x * traction(p, x));
}

RG_USER_LAW_IS(.name = "plateau", .meaning = "full strength up to a part of the critical opening",
               RG_USER_LIST(parameters), .work = work, .end = end)
