/* Reference Drucker-Prager solid, after the equations of material/drucker_prager.h; the return case by case,
 * that to the cap by bisection. */
#include <math.h>
#include "reference/hencky.h"
#include "reference/material.h"

typedef struct {
    const double *given;
    double k, a, b, T, K, G3; /* K and 3G over J */
} solid;

static const double degree = 0.017453292519943295769;

static solid solid_of(const rg_material *m, double J) {
    const double *given = m->of.parameter, cut = given[RG_PARAMETER_TENSION_CUTOFF];
    double phi = given[RG_PARAMETER_FRICTION_ANGLE] * degree;
    double psi = given[RG_PARAMETER_DILATION_ANGLE] * degree;
    solid s = {.given = given, .K = (m->lambda + 2 * m->mu / 3) / J, .G3 = 3 * m->mu / J};
    s.k = 6 * given[RG_PARAMETER_COHESION] * cos(phi) / (3 - sin(phi));
    s.a = 6 * sin(phi) / (3 - sin(phi));
    s.b = 6 * sin(psi) / (3 - sin(psi));
    s.T = s.a > 0 ? s.k / s.a : INFINITY;
    s.T = cut > 0 ? fmin(s.T, cut) : s.T;
    return s;
}

/* (4) and its inverse, and pa of (3). */
static double cap_at(const solid *s, double ec) {
    return s->given[RG_PARAMETER_CAP_PRESSURE] -
           s->given[RG_PARAMETER_COMPACTION_PRESSURE] * log1p(-ec / s->given[RG_PARAMETER_COMPACTION]);
}

static double compaction_at(const solid *s, double rise) {
    return -s->given[RG_PARAMETER_COMPACTION] * expm1(-rise / s->given[RG_PARAMETER_COMPACTION_PRESSURE]);
}

static double cap_begins(const solid *s, double pb) {
    double R = s->given[RG_PARAMETER_CAP_RATIO];
    return (pb - R * s->k) / (1 + R * s->a);
}

/* How far (3) is exceeded once the cap has taken dec, and the stress there. */
static double beyond_cap(const solid *s, double pt, double qt, double ec, double dec, double *p, double *q) {
    double R = s->given[RG_PARAMETER_CAP_RATIO], pa = cap_begins(s, cap_at(s, ec + dec));
    double x = pt - s->K * dec - pa;
    if (x <= 0)
        return -1;
    *p = pa + x;
    *q = qt * x / (x + s->G3 * R * R * dec);
    return hypot(x, R * *q) - R * (s->k + s->a * pa);
}

/* dec of the cap, where the trial is beyond it. */
static double flow_on_cap(const solid *s, double ec, double *p, double *q) {
    double pt = *p, qt = *q, low = 0, high = (pt - cap_begins(s, cap_at(s, ec))) / s->K;
    high = fmin(high, s->given[RG_PARAMETER_COMPACTION] - ec);
    for (int i = 0; i < 200; i++) {
        double middle = (low + high) / 2, to_p, to_q;
        bool over = beyond_cap(s, pt, qt, ec, middle, &to_p, &to_q) > 0;
        if (middle <= low || middle >= high)
            break;
        *(over ? &low : &high) = middle;
    }
    beyond_cap(s, pt, qt, ec, low, p, q);
    return low;
}

/* Cauchy's p and q after flow. */
static void flow_on_cone(const solid *s, double pa, double *p, double *q) {
    double dep = fmax(0, (*q - s->k - s->a * *p) / (s->G3 + s->a * s->b * s->K));
    double to = *p + s->b * s->K * dep;
    if (to < -s->T) { /* the cut-off, or where it meets the cone */
        *p = -s->T;
        *q = fmin(*q, fmax(0, s->k - s->a * s->T));
    } else if (to > pa) { /* where the cap begins */
        *p = pa;
        *q = s->k + s->a * pa;
    } else if (dep > 0) {
        *p = to;
        *q -= s->G3 * dep;
    }
}

void rg_reference_point_drucker_prager(const rg_material *m, bool advance, double F[3][3], double history[],
                                       double P[3][3], rg_reference_point *out) {
    double inverse[3][3], b[3][3], e[3][3], J = rg_reference_invert(F, inverse);
    const solid s = solid_of(m, J);
    double eb = rg_reference_hencky(F, history + RG_DP_FLOW, b, e), volume = log(J) - history[RG_DP_VOLUME];
    double p = -s.K * volume, q = s.G3 * eb, to_p = p, to_q = q, excess = 1;
    out->released[RG_RELEASED_PLASTIC] = out->released[RG_RELEASED_DAMAGE] = 0;
    if (advance) {
        bool cap = s.given[RG_PARAMETER_CAP_PRESSURE] > 0, inside = true;
        double ec = cap ? compaction_at(&s, history[RG_DP_RISE]) : 0, dec = 0, x, y;
        double pb = cap ? s.given[RG_PARAMETER_CAP_PRESSURE] + history[RG_DP_RISE] : INFINITY;
        double pa = cap ? cap_begins(&s, pb) : INFINITY;
        if (p > pa) {
            inside = beyond_cap(&s, p, q, ec, 0, &x, &y) <= 0;
            if (!inside)
                dec = flow_on_cap(&s, ec, &to_p, &to_q);
        } else {
            flow_on_cone(&s, pa, &to_p, &to_q);
            inside = to_p == p && to_q == q;
        }
        if (!inside) {
            bool flowed = history[RG_DP_MEAN] != 0 || history[RG_DP_MISES] != 0;
            double dep = (q - to_q) / s.G3, dvp = (to_p - p) / s.K;
            double mean = flowed ? history[RG_DP_MEAN] : -J * to_p;
            double mises = flowed ? history[RG_DP_MISES] : J * to_q;
            out->released[RG_RELEASED_PLASTIC] = (dep * (mises + J * to_q) + dvp * (mean - J * to_p)) / 2;
            rg_reference_hencky_flow(inverse, b, e, eb > 0 ? dep / eb : 0, history + RG_DP_FLOW);
            history[RG_DP_STRAIN] += dep;
            history[RG_DP_VOLUME] += dvp;
            if (dec > 0)
                history[RG_DP_RISE] = cap_at(&s, ec + dec) - s.given[RG_PARAMETER_CAP_PRESSURE];
            double g = s.G3 + s.b * s.b * s.K, n = s.G3 + s.a * s.a * s.K, both = s.G3 + s.a * s.b * s.K;
            excess = 1 + (sqrt(g * n) / both - 1) / 2;
        }
        history[RG_DP_MEAN] = inside ? 0 : -J * to_p;
        history[RG_DP_MISES] = inside ? 0 : J * to_q;
    }
    rg_reference_hencky_piola(-J * to_p, J * to_q, eb, e, inverse, P);
    out->stiffening =
        excess * rg_reference_hencky_stiffening(m->lambda, m->mu, -J * to_p, J * to_q, eb, inverse);
    out->energy = J * (to_p * to_p / s.K + to_q * to_q / s.G3) / 2;
    out->internal[RG_INTERNAL_PLASTIC] = history[RG_DP_STRAIN];
    out->internal[RG_INTERNAL_VOLUME] = history[RG_DP_VOLUME];
}
