/* Reference J2 elastic-plastic solid, after the equations of material/j2.h; the return by bisection. */
#include <math.h>
#include "reference/hencky.h"
#include "reference/material.h"

static double yield_stress(const double given[], double ep) {
    double first = given[RG_PARAMETER_YIELD_STRESS], last = given[RG_PARAMETER_SATURATION_STRESS];
    double sum = first + given[RG_PARAMETER_HARDENING] * ep;
    return last > 0 ? sum + (last - first) * (1 - exp(-given[RG_PARAMETER_SATURATION_RATE] * ep)) : sum;
}

/* dep with 3G (eb - dep) = sY(ep + dep). */
static double flow(const rg_material *m, double eb, double ep) {
    double low = 0, high = eb;
    while (high - low > 1e-17 * eb) {
        double middle = (low + high) / 2;
        if (middle <= low || middle >= high)
            break;
        *(3 * m->mu * (eb - middle) > yield_stress(m->of.parameter, ep + middle) ? &low : &high) = middle;
    }
    return low;
}

void rg_reference_point_j2(const rg_material *m, bool advance, double F[3][3], double history[],
                           double P[3][3], rg_reference_point *out) {
    double inverse[3][3], b[3][3], e[3][3], bulk = m->lambda + 2 * m->mu / 3, *ep = &history[RG_J2_STRAIN];
    double ekk = log(rg_reference_invert(F, inverse)),
           eb = rg_reference_hencky(F, history + RG_J2_FLOW, b, e);
    double before = yield_stress(m->of.parameter, *ep), dep = 0;
    if (advance && 3 * m->mu * eb > before) {
        dep = flow(m, eb, *ep);
        rg_reference_hencky_flow(inverse, b, e, dep / eb, history + RG_J2_FLOW);
        *ep += dep;
    }
    double mean = bulk * ekk, mises = 3 * m->mu * (eb - dep);
    rg_reference_hencky_piola(mean, mises, eb, e, inverse, P);
    out->stiffening = rg_reference_hencky_stiffening(m->lambda, m->mu, mean, mises, eb, inverse);
    out->energy = (mean * ekk + mises * (eb - dep)) / 2;
    out->released[RG_RELEASED_PLASTIC] = dep * (before + yield_stress(m->of.parameter, *ep)) / 2;
    out->released[RG_RELEASED_DAMAGE] = 0;
    out->internal[RG_INTERNAL_PLASTIC] = *ep;
}
