/* Reference Deshpande-Evans ceramic. */
#include "reference_deshpande_evans.h"

#include <math.h>
#include <string.h>

#include "layout.h"
#include "reference.h"
#include "reference_material.h"

static const double pi = 3.14159265358979323846;

rg_reference_de_cracks rg_reference_de_coefficients(const rg_deshpande_evans *p, double damage) {
    double d0 = rg_de_initial_damage(p), X = cbrt(damage / d0) - 1,
           root = sqrt(1 + p->friction * p->friction);
    double A1 = pi * sqrt(p->beta / 3) * (root - p->friction);
    double A3 = A1 * (root + p->friction) / (root - p->friction);
    double c1 = 1 / (pi * pi * pow(p->alpha, 1.5) * pow(X + p->beta / p->alpha, 1.5));
    double c2 = 1 + 2 * X * X * pow(d0, 2.0 / 3) / (1 - pow(damage, 2.0 / 3));
    double c3 = 2 * p->alpha * p->alpha * pi * (p->single_pi ? 1 : pi) * X * X;
    rg_reference_de_cracks k;
    k.A = c1 * (c2 * A3 - c2 * A1 + c3);
    k.B = c1 / sqrt(3) * (c2 * A3 + c2 * A1 + c3);
    k.C = k.A + p->gamma * sqrt(p->alpha * cbrt(damage / d0));
    k.E = sqrt(k.B * k.B * k.C * k.C / (k.C * k.C - k.A * k.A));
    return k;
}

int rg_reference_de_regime(const rg_deshpande_evans *p, double damage, double mean, double mises) {
    rg_reference_de_cracks k = rg_reference_de_coefficients(p, damage);
    if (mean <= -k.B / k.A * mises)
        return 1;
    return mean < k.A * k.B / (k.C * k.C - k.A * k.A) * mises ? 2 : 3;
}

static double kappa(const rg_deshpande_evans *p) {
    return pi * rg_de_initial_damage(p) / (4 * pow(p->alpha, 3) * p->shear * (1 + p->poisson));
}

double rg_reference_de_intensity(const rg_deshpande_evans *p, double damage, double mean, double mises) {
    rg_reference_de_cracks k = rg_reference_de_coefficients(p, damage);
    double unit = sqrt(pi * p->flaw_radius);
    switch (rg_reference_de_regime(p, damage, mean, mises)) {
    case 1:
        return 0;
    case 2:
        return unit * (k.A * mean + k.B * mises);
    default:
        return unit * sqrt(k.C * k.C * mean * mean + k.E * k.E * mises * mises);
    }
}

double rg_reference_de_energy(const rg_deshpande_evans *p, double damage, double mean, double mises) {
    double nu = p->poisson, intensity = rg_reference_de_intensity(p, damage, mean, mises);
    double w0 = (2.0 / 3 * mises * mises + 3 * (1 - 2 * nu) / (1 + nu) * mean * mean) / (4 * p->shear);
    return w0 + kappa(p) * intensity * intensity / (pi * p->flaw_radius);
}

/* dX/dt of an intensity. */
static double growth_rate(const rg_deshpande_evans *p, double intensity) {
    double speed = p->growth_speed * pow(intensity / p->toughness, p->growth_exponent);
    return fmin(speed, sqrt(p->shear / p->density)) / (p->alpha * p->flaw_radius);
}

double rg_reference_de_damage_rate(const rg_deshpande_evans *p, double damage, double mean, double mises) {
    double d0 = rg_de_initial_damage(p), intensity = rg_reference_de_intensity(p, damage, mean, mises);
    return 3 * pow(damage, 2.0 / 3) * cbrt(d0) * growth_rate(p, intensity);
}

int rg_reference_de_invariants(const rg_deshpande_evans *p, double damage, double ekk, double eb,
                               double *mean, double *mises) {
    rg_reference_de_cracks c = rg_reference_de_coefficients(p, damage);
    double G = p->shear, k = 3 * (1 - 2 * p->poisson) / (2 * G * (1 + p->poisson)), kap = kappa(p);
    double soft = k + 2 * kap * c.C * c.C, soft_shear = 1 / (3 * G) + 2 * kap * c.E * c.E;
    if (ekk <= -c.B / c.A * 3 * G * k * eb) {
        *mean = ekk / k;
        *mises = 3 * G * eb;
        return 1;
    }
    if (ekk >= c.A * c.B / (c.C * c.C - c.A * c.A) * eb * soft / soft_shear) {
        *mean = ekk / soft;
        *mises = eb / soft_shear;
        return 3;
    }
    double a11 = k + 2 * kap * c.A * c.A, a12 = 2 * kap * c.A * c.B, a22 = 1 / (3 * G) + 2 * kap * c.B * c.B;
    double d = a11 * a22 - a12 * a12;
    *mean = (a22 * ekk - a12 * eb) / d;
    *mises = (a11 * eb - a12 * ekk) / d;
    return 2;
}

double rg_reference_de_flow_stress(const rg_deshpande_evans *p, double ep, double rate) {
    double s0 = p->yield_stress / 2 * (1 + pow(ep / p->yield_strain, p->hardening_exponent));
    double n = p->rate_exponent, relative = rate / p->plastic_rate;
    if (rate <= p->transition_rate)
        return s0 * pow(relative, 1 / n);
    return s0 * relative * pow(p->transition_rate / p->plastic_rate, (1 - n) / n);
}

static double overstress(const rg_deshpande_evans *p, double damage, double ekk, double eb, double ep,
                         double dt, double flow) {
    double mean, mises;
    rg_reference_de_invariants(p, damage, ekk, eb - flow, &mean, &mises);
    return mises - rg_reference_de_flow_stress(p, ep + flow, flow / dt);
}

double rg_reference_de_flow(const rg_deshpande_evans *p, double damage, double ekk, double eb, double ep,
                            double dt) {
    double mean, mises, low = log(RG_DE_NO_FLOW), high = log(eb);
    rg_reference_de_invariants(p, damage, ekk, eb, &mean, &mises);
    if (mises <= rg_reference_de_flow_stress(p, ep, RG_DE_NO_FLOW / dt))
        return 0;
    low -= 100;
    for (int i = 0; i < 70; i++) { /* 100 + log eb shrinks to rounding */
        double middle = (low + high) / 2;
        *(overstress(p, damage, ekk, eb, ep, dt, exp(middle)) > 0 ? &low : &high) = middle;
    }
    return exp(low);
}

/* Time per relative growth, phi = (X + beta/alpha)/(dX/dt); no growth is e^-300 of that at K_IC. */
static double phi(const rg_deshpande_evans *p, double growth, double ekk, double eb) {
    double mean, mises, damage = rg_de_damage(p, growth);
    rg_reference_de_invariants(p, damage, ekk, eb, &mean, &mises);
    double rate = growth_rate(p, rg_reference_de_intensity(p, damage, mean, mises));
    double least = p->growth_speed / (p->alpha * p->flaw_radius) * exp(-300);
    return (growth + p->beta / p->alpha) / fmax(rate, least);
}

double rg_reference_de_growth(const rg_deshpande_evans *p, double growth, double ekk, double eb, double dt) {
    double offset = p->beta / p->alpha, y = growth + offset, first = phi(p, growth, ekk, eb);
    double most = cbrt(p->damage_max / rg_de_initial_damage(p)) - 1;
    double euler = growth + dt * y / first;
    if (growth >= most || dt / first <= RG_DE_NO_GROWTH)
        return growth;
    if (dt / first <= RG_DE_LITTLE)
        return fmin(euler, most);
    double end = fmin(growth + dt * sqrt(p->shear / p->density) / (p->alpha * p->flaw_radius), most);
    double width = log((end + offset) / y) / RG_DE_PANELS;
    for (int i = 1; i <= RG_DE_PANELS; i++) {
        double last = phi(p, y * exp(i * width) - offset, ekk, eb), bend = log(last / first);
        double needed = width * (bend == 0 ? first : (last - first) / bend);
        if (dt < needed) {
            double linear = dt / (width * first), part = bend == 0 ? linear : log1p(bend * linear) / bend;
            return fmin(y * exp((i - 1 + part) * width) - offset, most);
        }
        dt -= needed;
        first = last;
    }
    return end;
}

/* ---- Tensors ---- */

/* Rotation in the plane (a, b) that takes s[a][b] to zero. */
static void rotate(double s[3][3], double v[3][3], int a, int b) {
    double angle = 0.5 * atan2(2 * s[a][b], s[b][b] - s[a][a]), c = cos(angle), t = sin(angle);
    for (int k = 0; k < 3; k++) {
        double x = s[k][a], y = s[k][b];
        s[k][a] = c * x - t * y;
        s[k][b] = t * x + c * y;
    }
    for (int k = 0; k < 3; k++) {
        double x = s[a][k], y = s[b][k];
        s[a][k] = c * x - t * y;
        s[b][k] = t * x + c * y;
        x = v[k][a];
        y = v[k][b];
        v[k][a] = c * x - t * y;
        v[k][b] = t * x + c * y;
    }
}

void rg_reference_eigen(double s[3][3], double value[3], double v[3][3]) {
    double work[3][3];
    memcpy(work, s, sizeof work);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            v[i][j] = i == j;
    for (int sweep = 0; sweep < 10; sweep++) {
        rotate(work, v, 0, 1);
        rotate(work, v, 0, 2);
        rotate(work, v, 1, 2);
    }
    for (int i = 0; i < 3; i++)
        value[i] = work[i][i];
}

void rg_reference_function(double s[3][3], double (*f)(double), double out[3][3]) {
    double value[3], v[3][3];
    rg_reference_eigen(s, value, v);
    memset(out, 0, 9 * sizeof(double));
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                out[i][j] += f(value[k]) * v[i][k] * v[j][k];
}

static void multiply(double a[3][3], double b[3][3], double out[3][3]) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
}

static void transpose(double a[3][3], double out[3][3]) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[i][j] = a[j][i];
}

/* G S G^T. */
static void push(double G[3][3], double S[3][3], double out[3][3]) {
    double half[3][3], turned[3][3];
    multiply(G, S, half);
    transpose(G, turned);
    multiply(half, turned, out);
}

/* ---- The point ---- */

static const int row[6] = {0, 1, 2, 1, 0, 0}, column[6] = {0, 1, 2, 2, 2, 1};

static double half_log(double x) {
    return log(x) / 2;
}

/* b = F Cp^-1 F^T, the deviator e of 1/2 log b; returns eb. */
static double strain(double F[3][3], const double flow[6], double b[3][3], double e[3][3]) {
    double metric[3][3], square = 0;
    for (int k = 0; k < 6; k++)
        metric[row[k]][column[k]] = metric[column[k]][row[k]] = flow[k] + (row[k] == column[k]);
    push(F, metric, b);
    rg_reference_function(b, half_log, e);
    double third = (e[0][0] + e[1][1] + e[2][2]) / 3;
    for (int i = 0; i < 3; i++) {
        e[i][i] -= third;
        square += rg_reference_dot(e[i], e[i]);
    }
    return sqrt(2.0 / 3 * square);
}

/* Cp^-1 = F^-1 b exp(-2 part e) F^-T, where the exponential is that of a symmetric matrix coaxial with b. */
static void flow_history(double inverse[3][3], double b[3][3], double e[3][3], double part, double flow[6]) {
    double argument[3][3], factor[3][3], relaxed[3][3], metric[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            argument[i][j] = -2 * part * e[i][j];
    rg_reference_function(argument, exp, factor);
    multiply(b, factor, relaxed);
    push(inverse, relaxed, metric);
    for (int k = 0; k < 6; k++)
        flow[k] = (metric[row[k]][column[k]] + metric[column[k]][row[k]]) / 2 - (row[k] == column[k]);
}

/* P = tau F^-T, tau = sm I + (2/3) (se/eb) e'. */
static void piola(double mean, double mises, double eb, double e[3][3], double inverse[3][3],
                  double P[3][3]) {
    for (int i = 0; i < 3; i++) {
        double tau[3];
        for (int j = 0; j < 3; j++)
            tau[j] = (i == j) * mean + (eb > 0 ? 2.0 / 3 * mises / eb * e[i][j] : 0);
        for (int j = 0; j < 3; j++)
            P[i][j] = rg_reference_dot(tau, inverse[j]);
    }
}

/* The bound of deshpande_evans.h. */
static double stiffening(const rg_deshpande_evans *p, double mean, double mises, double eb,
                         double inverse[3][3]) {
    double norm = 0, modulus = 2 * p->shear * (1 - p->poisson) / (1 - 2 * p->poisson);
    for (int i = 0; i < 3; i++) {
        double sum = 0;
        for (int j = 0; j < 3; j++)
            sum += fabs(rg_reference_dot(inverse[i], inverse[j]));
        norm = fmax(norm, sum);
    }
    return norm * (1 + (fmax(-mean, 0) + 1.25 * mises + 4.0 / 3 * p->shear * eb * eb) / modulus);
}

rg_reference_de_result rg_reference_de_step(const rg_deshpande_evans *p, double dt, double F[3][3],
                                            double history[RG_DE_HISTORY], double P[3][3]) {
    rg_reference_de_result out;
    double inverse[3][3], b[3][3], e[3][3], mean, mises, damage = rg_de_damage(p, history[RG_DE_GROWTH]);
    double ekk = log(rg_reference_invert(F, inverse)), eb = strain(F, history + RG_DE_FLOW, b, e);
    out.ekk = ekk;
    out.eb = eb;
    out.regime_before = rg_reference_de_invariants(p, damage, ekk, eb, &mean, &mises);
    double before = rg_reference_de_energy(p, damage, mean, mises);
    double flow = dt > 0 && eb > 0 ? rg_reference_de_flow(p, damage, ekk, eb, history[RG_DE_STRAIN], dt) : 0;
    if (flow > 0)
        flow_history(inverse, b, e, flow / eb, history + RG_DE_FLOW);
    history[RG_DE_STRAIN] += flow;
    rg_reference_de_invariants(p, damage, ekk, eb - flow, &mean, &mises);
    double between = rg_reference_de_energy(p, damage, mean, mises);
    if (dt > 0)
        history[RG_DE_GROWTH] = rg_reference_de_growth(p, history[RG_DE_GROWTH], ekk, eb - flow, dt);
    damage = rg_de_damage(p, history[RG_DE_GROWTH]);
    out.regime = rg_reference_de_invariants(p, damage, ekk, eb - flow, &mean, &mises);
    out.energy = rg_reference_de_energy(p, damage, mean, mises);
    out.plastic = before - between;
    out.damage = between - out.energy;
    piola(mean, mises, eb, e, inverse, P);
    out.stiffening = stiffening(p, mean, mises, eb, inverse);
    return out;
}

void rg_reference_point_deshpande_evans(const rg_material *m, bool advance, double F[3][3], double history[],
                                        double P[3][3], rg_reference_point *out) {
    const rg_de_material *de = &m->of.deshpande_evans;
    double dt = advance ? de->constants.dt : 0;
    rg_reference_de_result r = rg_reference_de_step(&de->parameters, dt, F, history, P);
    out->stiffening = r.stiffening;
    out->energy = r.energy;
    out->released[RG_RELEASED_PLASTIC] = r.plastic;
    out->released[RG_RELEASED_DAMAGE] = r.damage;
    out->internal[RG_INTERNAL_DAMAGE] = rg_de_damage(&de->parameters, history[RG_DE_GROWTH]);
    out->internal[RG_INTERNAL_REGIME] = r.energy > 0 ? r.regime : 0;
    out->internal[RG_INTERNAL_PLASTIC] = history[RG_DE_STRAIN];
}
