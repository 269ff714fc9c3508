/* Reference Holmquist-Johnson-Cook concrete, after the equations of material/holmquist_johnson_cook.h. */
#include <math.h>
#include "reference/hencky.h"
#include "reference/material.h"

typedef struct {
    const double *p; /* parameters */
    double K, G, fc, T;
    double mu_c, mu_m, K_t;
} solid;

/* Of the dense solid, at x. */
static double dense(const double *p, double x) {
    double more = p[RG_PARAMETER_BULK_2] * x * x + p[RG_PARAMETER_BULK_3] * x * x * x;
    return p[RG_PARAMETER_BULK_1] * x + (x > 0 ? more : 0);
}

static solid solid_of(const rg_material *m) {
    const double *p = m->of.parameter;
    solid s = {p,
               m->lambda + 2 * m->mu / 3,
               m->mu,
               p[RG_PARAMETER_COMPRESSIVE_STRENGTH],
               p[RG_PARAMETER_TENSILE_LIMIT],
               0,
               0,
               0};
    double low = 0, high = 1, lock = p[RG_PARAMETER_LOCK_PRESSURE];
    while (nextafter(low, high) < high) {
        double middle = (low + high) / 2;
        *(dense(p, middle) < lock ? &low : &high) = middle;
    }
    s.mu_c = p[RG_PARAMETER_CRUSH_PRESSURE] / s.K;
    s.mu_m = p[RG_PARAMETER_LOCK_STRAIN] + (1 + p[RG_PARAMETER_LOCK_STRAIN]) * high;
    s.K_t = (lock - p[RG_PARAMETER_CRUSH_PRESSURE]) / (s.mu_m - s.mu_c);
    return s;
}

/* The curve of (3) that pores closed up to m leave: slope over mu and where it has no pressure; dense ones
 * are told by a slope of 0. */
static double slope_of(const solid *s, double closed, double *none) {
    double F = closed / (s->mu_m - s->mu_c), K_u = (1 - F) * s->K + F * s->p[RG_PARAMETER_BULK_1];
    if (closed >= (s->mu_m - s->mu_c) * (1 - 1e-14)) {
        *none = s->p[RG_PARAMETER_LOCK_STRAIN];
        return 0;
    }
    double top = s->p[RG_PARAMETER_CRUSH_PRESSURE] + s->K_t * closed;
    *none = closed > 0 ? s->mu_c + closed - top / K_u : 0;
    return K_u;
}

static double pressure(const solid *s, double closed, double mu) {
    double none, slope = slope_of(s, closed, &none);
    return slope > 0 ? slope * (mu - none) : dense(s->p, (mu - none) / (1 + none));
}

/* Integral of -p dJ from no pressure on, as long as p follows J. */
static double follows(const solid *s, double closed, double J) {
    double none, slope = slope_of(s, closed, &none), y = J * (1 + none), L = log1p(y - 1), x = 1 / y - 1;
    if (slope > 0)
        return slope * (y - 1 - L);
    double sum = s->p[RG_PARAMETER_BULK_1] * (y - 1 - L);
    if (x > 0)
        sum += s->p[RG_PARAMETER_BULK_2] * (x + 2 * L + 1 - y) +
               s->p[RG_PARAMETER_BULK_3] * (x * x / 2 - 2 * x - 3 * L + y - 1);
    return sum / (1 + none);
}

static double stored(const solid *s, double closed, double J, double D) {
    double none, slope = slope_of(s, closed, &none), hold = s->T * (1 - D);
    double least = slope > 0 ? none - hold / slope : none - (1 + none) * hold / s->p[RG_PARAMETER_BULK_1];
    double most = 1 / (1 + least); /* J where the pressure stays */
    return J <= most ? follows(s, closed, J) : follows(s, closed, most) + hold * (J - most);
}

/* Work of the loading curve on the way to m. */
static double work(const solid *s, double m) {
    double straight = s->p[RG_PARAMETER_CRUSH_PRESSURE] - s->K_t * (1 + s->mu_c);
    return s->K_t * log1p(m) - straight / (1 + m);
}

static double failure_strain(const solid *s, double p) {
    double x = fmax((p + s->T) / s->fc, 0);
    return fmax(s->p[RG_PARAMETER_FAILURE_STRAIN] * pow(x, s->p[RG_PARAMETER_FAILURE_POWER]),
                s->p[RG_PARAMETER_LEAST_FAILURE_STRAIN]);
}

/* von Mises part of tau. */
static double strength(const solid *s, double J, double p, double D, double speed) {
    double A = s->p[RG_PARAMETER_COHESIVE_STRENGTH], S = s->p[RG_PARAMETER_LARGEST_STRENGTH];
    double B = s->p[RG_PARAMETER_CRUSHED_STRENGTH], N = s->p[RG_PARAMETER_CRUSHED_POWER];
    double sum = p > 0 ? A * (1 - D) + B * pow(p / s->fc, N) : A * (1 - D + p / s->T);
    return J * s->fc * fmax(fmin(sum * speed, S > 0 ? S : INFINITY), 0);
}

/* Plastic strain of a step: where the elastic line meets the strength, or at least falls below it no more; by
 * bisection. */
static double flow(const solid *s, double J, double p, double D, double speed, double eb) {
    double low = 0, high = eb, ef = failure_strain(s, p);
    while (nextafter(low, high) < high) {
        double x = (low + high) / 2, after = strength(s, J, p, fmin(1, D + x / ef), speed);
        *(3 * s->G * (eb - x) > after ? &low : &high) = x;
    }
    return high;
}

void rg_reference_point_holmquist_johnson_cook(const rg_material *m, bool advance, double F[3][3],
                                               double history[], double P[3][3], rg_reference_point *out) {
    const solid s = solid_of(m);
    const double C = s.p[RG_PARAMETER_RATE_SENSITIVITY], unit = s.p[RG_PARAMETER_REFERENCE_RATE] * m->dt;
    double inverse[3][3], b[3][3], e[3][3], J = rg_reference_invert(F, inverse), mu = 1 / J - 1;
    double eb = rg_reference_hencky(F, history + RG_HJC_FLOW, b, e), elastic = eb,
           last = history[RG_HJC_LAST];
    double *D = &history[RG_HJC_DAMAGE], *closed = &history[RG_HJC_CLOSED], before = *D;
    double none, modulus;
    out->released[RG_RELEASED_PLASTIC] = out->released[RG_RELEASED_DAMAGE] = 0;
    if (advance && mu - s.mu_c > *closed && *closed < (s.mu_m - s.mu_c) * (1 - 1e-14)) {
        double to = fmin(mu, s.mu_m) - s.mu_c, from = *closed, start;
        slope_of(&s, from, &start);
        slope_of(&s, to, &none);
        out->released[RG_RELEASED_PLASTIC] = work(&s, s.mu_c + to) - work(&s, s.mu_c + from) -
                                             follows(&s, to, 1 / (1 + s.mu_c + to)) +
                                             follows(&s, from, 1 / (1 + s.mu_c + from));
        *closed = to;
        double p = fmax(pressure(&s, to, mu), -s.T * (1 - before));
        *D = none > start ? fmin(1, *D + (none - start) / failure_strain(&s, p)) : *D;
    }
    double p = fmax(pressure(&s, *closed, mu), -s.T * (1 - before));
    if (advance) {
        double now = strength(&s, J, p, *D, 1), gained = last > 0 ? eb - last : eb - now / (3 * s.G);
        double speed = 1 + C * log(fmax(gained / unit, 1));
        now = 3 * s.G * eb > now ? strength(&s, J, p, *D, speed) : now;
        history[RG_HJC_LAST] = 0;
        if (3 * s.G * eb > now) {
            double dep = flow(&s, J, p, *D, speed, eb);
            *D = fmin(1, *D + dep / failure_strain(&s, p));
            rg_reference_hencky_flow(inverse, b, e, dep / eb, history + RG_HJC_FLOW);
            history[RG_HJC_STRAIN] += dep;
            history[RG_HJC_LAST] = elastic = eb - dep;
            out->released[RG_RELEASED_PLASTIC] +=
                dep * ((last > 0 ? 3 * s.G * last : now) + 3 * s.G * elastic) / 2;
        }
        out->released[RG_RELEASED_DAMAGE] = stored(&s, *closed, J, before) - stored(&s, *closed, J, *D);
        p = fmax(pressure(&s, *closed, mu), -s.T * (1 - *D));
    }
    modulus = slope_of(&s, *closed, &none);
    if (modulus == 0) {
        double x = fmax((mu - none) / (1 + none), 0);
        modulus = (s.p[RG_PARAMETER_BULK_1] + 2 * s.p[RG_PARAMETER_BULK_2] * x +
                   3 * s.p[RG_PARAMETER_BULK_3] * x * x) /
                  (1 + none);
    }
    double mises = 3 * s.G * elastic;
    rg_reference_hencky_piola(-J * p, mises, eb, e, inverse, P);
    out->stiffening =
        rg_reference_hencky_stiffening(m->lambda, m->mu, -J * p - fmax(modulus - s.K, 0), mises, eb, inverse);
    out->energy = mises * elastic / 2 + stored(&s, *closed, J, *D);
    out->internal[RG_INTERNAL_DAMAGE] = *D;
    out->internal[RG_INTERNAL_PLASTIC] = history[RG_HJC_STRAIN];
    out->internal[RG_INTERNAL_VOLUME] = -log1p(none);
}
