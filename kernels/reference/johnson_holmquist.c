/* Reference Johnson-Holmquist ceramic, after the equations of material/johnson_holmquist.h. */
#include <math.h>
#include "reference/hencky.h"
#include "reference/material.h"

typedef struct {
    const double *p; /* parameters */
    double K1, G, T, hel;
} solid;

static solid solid_of(const rg_material *m) {
    const double *p = m->of.parameter;
    return (solid){p, m->lambda + 2 * m->mu / 3, m->mu, p[RG_PARAMETER_TENSILE_LIMIT],
                   1.5 * (p[RG_PARAMETER_HUGONIOT_LIMIT] - p[RG_PARAMETER_HUGONIOT_PRESSURE])};
}

/* (1) without bulking and limit. */
static double intact_pressure(const solid *s, double mu) {
    double cubic = s->p[RG_PARAMETER_BULK_2] * mu * mu + s->p[RG_PARAMETER_BULK_3] * mu * mu * mu;
    return s->K1 * mu + (mu > 0 ? cubic : 0);
}

static double pressure(const solid *s, double J, double bulked, double D) {
    return fmax(intact_pressure(s, 1 / J - 1) + bulked, -s->T * (1 - D));
}

/* (6), where the pressure follows J. */
static double follows(const solid *s, double J, double bulked) {
    double mu = 1 / J - 1, L = log1p(J - 1), sum = s->K1 * (J - 1 - L) + bulked * (1 - J);
    if (mu > 0)
        sum += s->p[RG_PARAMETER_BULK_2] * (mu + 2 * L + (1 - J)) +
               s->p[RG_PARAMETER_BULK_3] * (mu * mu / 2 - 2 * mu - 3 * L - (1 - J));
    return sum + bulked * bulked / (2 * s->K1);
}

static double stored(const solid *s, double J, double bulked, double D) {
    double hold = s->T * (1 - D), most = 1 / (1 - (hold + bulked) / s->K1);
    return J <= most ? follows(s, J, bulked) : follows(s, most, bulked) + hold * (J - most);
}

/* (3) of the intact and of the crushed solid, and ef of (4). */
static void strengths(const solid *s, double p, double *intact, double *crushed, double *strain) {
    double unit = s->p[RG_PARAMETER_HUGONIOT_PRESSURE], x = (p + s->T) / unit;
    double cap = s->p[RG_PARAMETER_CRUSHED_LIMIT];
    *intact = x > 0 ? s->p[RG_PARAMETER_INTACT_STRENGTH] * pow(x, s->p[RG_PARAMETER_INTACT_POWER]) : 0;
    *crushed =
        p > 0 ? s->p[RG_PARAMETER_CRUSHED_STRENGTH] * pow(p / unit, s->p[RG_PARAMETER_CRUSHED_POWER]) : 0;
    *crushed = fmin(fmin(*crushed, cap > 0 ? cap : INFINITY), *intact);
    *strain = x > 0 ? s->p[RG_PARAMETER_FAILURE_STRAIN] * pow(x, s->p[RG_PARAMETER_FAILURE_POWER]) : 0;
}

/* von Mises part of tau, at a damage. */
static double strength(const solid *s, double J, double p, double D, double speed) {
    double intact, crushed, strain;
    strengths(s, p, &intact, &crushed, &strain);
    return J * s->hel * ((1 - D) * intact + D * crushed) * speed;
}

/* Damage after flow from the elastic strain eb: (4) with 3G (eb - dep) at the strength of that damage, the
 * first root from D on, or 1. */
static double damage(const solid *s, double J, double p, double D, double speed, double eb) {
    double intact, crushed, strain;
    strengths(s, p, &intact, &crushed, &strain);
    double loss = J * s->hel * (intact - crushed) * speed, now = strength(s, J, p, D, speed);
    double steep = 3 * s->G * strain - loss;
    return steep > 0 ? fmin(1, D + (3 * s->G * eb - now) / steep) : 1;
}

void rg_reference_point_johnson_holmquist(const rg_material *m, bool advance, double F[3][3],
                                          double history[], double P[3][3], rg_reference_point *out) {
    const solid s = solid_of(m);
    const double C = s.p[RG_PARAMETER_RATE_SENSITIVITY], unit = s.p[RG_PARAMETER_REFERENCE_RATE] * m->dt;
    double inverse[3][3], b[3][3], e[3][3], J = rg_reference_invert(F, inverse);
    double eb = rg_reference_hencky(F, history + RG_JH_FLOW, b, e), elastic = eb, last = history[RG_JH_LAST];
    double *D = &history[RG_JH_DAMAGE], *bulked = &history[RG_JH_BULKING];
    double p = pressure(&s, J, *bulked, *D), now = strength(&s, J, p, *D, 1), speed = 1;
    out->released[RG_RELEASED_PLASTIC] = out->released[RG_RELEASED_DAMAGE] = 0;
    if (advance) {
        double gained = last > 0 ? eb - last : eb - now / (3 * s.G);
        speed = 1 + C * log(fmax(gained / unit, 1));
        now *= speed;
        history[RG_JH_LAST] = 0;
    }
    if (advance && 3 * s.G * eb > now) {
        double grown = damage(&s, J, p, *D, speed, eb), after = strength(&s, J, p, grown, speed);
        double lost = (now * now - after * after) / (6 * s.G), before = stored(&s, J, *bulked, *D);
        double mean = s.K1 * (1 / J - 1) + *bulked, dep = eb - after / (3 * s.G);
        if (lost > 0 && mean > 0)
            *bulked += sqrt(mean * mean + 2 * s.p[RG_PARAMETER_BULKING] * s.K1 * lost) - mean;
        *D = grown;
        rg_reference_hencky_flow(inverse, b, e, dep / eb, history + RG_JH_FLOW);
        history[RG_JH_STRAIN] += dep;
        history[RG_JH_LAST] = elastic = eb - dep;
        out->released[RG_RELEASED_PLASTIC] = dep * ((last > 0 ? 3 * s.G * last : now) + after) / 2;
        out->released[RG_RELEASED_DAMAGE] = before - stored(&s, J, *bulked, *D);
        p = pressure(&s, J, *bulked, *D);
    }
    double mises = 3 * s.G * elastic, pressed = fmax(1 / J - 1, 0);
    double stiffer = pressed * (2 * s.p[RG_PARAMETER_BULK_2] + 3 * s.p[RG_PARAMETER_BULK_3] * pressed);
    rg_reference_hencky_piola(-J * p, mises, eb, e, inverse, P);
    out->stiffening =
        rg_reference_hencky_stiffening(m->lambda, m->mu, -J * p - fmax(stiffer, 0), mises, eb, inverse);
    out->energy = mises * elastic / 2 + stored(&s, J, *bulked, *D);
    out->internal[RG_INTERNAL_DAMAGE] = *D;
    out->internal[RG_INTERNAL_BULKING] = *bulked;
    out->internal[RG_INTERNAL_PLASTIC] = history[RG_JH_STRAIN];
}
