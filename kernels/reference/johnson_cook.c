/* Reference Johnson-Cook metal, after the equations of material/johnson_cook.h; the return by bisection. */
#include <math.h>
#include "reference/hencky.h"
#include "reference/material.h"

/* Flow stress at a plastic strain, a strain of the step, and a rise of the temperature. */
static double flow_stress(const rg_material *m, double ep, double dep, double rise) {
    const double *p = m->of.parameter;
    double range = p[RG_PARAMETER_MELTING_TEMPERATURE] - p[RG_PARAMETER_ROOM_TEMPERATURE];
    double hard = p[RG_PARAMETER_YIELD_STRESS] +
                  p[RG_PARAMETER_HARDENING_MODULUS] * pow(ep, p[RG_PARAMETER_HARDENING_POWER]);
    double rate = fmax(dep / m->dt / p[RG_PARAMETER_REFERENCE_RATE], 1);
    double soft = p[RG_PARAMETER_SOFTENING_POWER] > 0
                      ? 1 - pow(fmin(rise / range, 1), p[RG_PARAMETER_SOFTENING_POWER])
                      : 1;
    return hard * (1 + p[RG_PARAMETER_RATE_SENSITIVITY] * log(rate)) * soft;
}

/* dep with 3G (eb - dep) = s(ep + dep, dep/dt), by its logarithm. */
static double flow(const rg_material *m, double eb, double ep, double rise) {
    double low = -700, high = log(eb);
    for (int i = 0; i < 70; i++) {
        double middle = (low + high) / 2, dep = exp(middle);
        *(3 * m->mu * (eb - dep) > flow_stress(m, ep + dep, dep, rise) ? &low : &high) = middle;
    }
    return exp(low);
}

void rg_reference_point_johnson_cook(const rg_material *m, bool advance, double F[3][3], double history[],
                                     double P[3][3], rg_reference_point *out) {
    const double *given = m->of.parameter;
    double inverse[3][3], b[3][3], e[3][3], bulk = m->lambda + 2 * m->mu / 3, dep = 0, work = 0;
    double ekk = log(rg_reference_invert(F, inverse)), *ep = &history[RG_JC_STRAIN],
           *rise = &history[RG_JC_RISE];
    double eb = rg_reference_hencky(F, history + RG_JC_FLOW, b, e);
    if (advance && 3 * m->mu * eb > flow_stress(m, *ep, 0, *rise)) {
        dep = flow(m, eb, *ep, *rise);
        work = dep * (flow_stress(m, *ep, dep, *rise) + flow_stress(m, *ep + dep, dep, *rise)) / 2;
        rg_reference_hencky_flow(inverse, b, e, dep / eb, history + RG_JC_FLOW);
        *ep += dep;
        if (given[RG_PARAMETER_HEAT_CAPACITY] > 0)
            *rise +=
                given[RG_PARAMETER_HEAT_FRACTION] * work / (m->density * given[RG_PARAMETER_HEAT_CAPACITY]);
    }
    double mean = bulk * ekk, mises = 3 * m->mu * (eb - dep);
    rg_reference_hencky_piola(mean, mises, eb, e, inverse, P);
    out->stiffening = rg_reference_hencky_stiffening(m->lambda, m->mu, mean, mises, eb, inverse);
    out->energy = (mean * ekk + mises * (eb - dep)) / 2;
    out->released[RG_RELEASED_PLASTIC] = work;
    out->released[RG_RELEASED_DAMAGE] = 0;
    out->internal[RG_INTERNAL_PLASTIC] = *ep;
    out->internal[RG_INTERNAL_TEMPERATURE] = m->of.parameter[RG_PARAMETER_ROOM_TEMPERATURE] + *rise;
}
