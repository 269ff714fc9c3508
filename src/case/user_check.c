/* What a user's material computes, held against what the step relies on: that its stress is the derivative of
 * its energy, turns with the solid and leaves it no moment; that waves and steps are bounded as it says; that
 * a cycle of a solid with a history adds up; and that no lane knows of another. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/hash.h"
#include "base/mem.h"
#include "case/tree.h"
#include "case/user.h"

#define SINGLE (sizeof(rg_real) == sizeof(float))

/* Steps of differences: where their own error is about that of rounding. */
#define DIFFERENCE (SINGLE ? 3e-3 : 1e-5)
#define SMOOTH     (SINGLE ? 5e-2 : 1e-5) /* bounds, of what is compared with differences */
/* ... of what is the same but for rounding: in floats the energy of a turned state; each step of a cycle */
#define EXACT   (SINGLE ? 6e-3 : 1e-8)
#define TURNING (SINGLE ? 1e-2 : 1e-6)

enum { STEPS = 240, ROUNDS = 2, AXES = 13 };
#define CLOSES 0.02 /* bound of what the sums of a cycle of so many steps leave */

typedef struct {
    const rg_material *m;
    const rg_user_material *u;
    double strain;
    rg_user_report *report;
    char *why;
    size_t size;
} check;

static void ask(const check *c, bool advance, rg_user_point p[RG_LANES]) {
    c->u->points(c->m, advance, p);
}

/* Uniform in -1 to 1. */
static double any(uint64_t seed, int k) {
    return 2 * rg_hash_uniform(rg_hash(seed, (uint64_t)k)) - 1;
}

static void random_states(const check *c, uint64_t seed, rg_user_point p[RG_LANES]) {
    memset(p, 0, RG_LANES * sizeof *p);
    for (int l = 0; l < RG_LANES; l++) {
        for (int k = 0; k < 9; k++) {
            p[l].H[k / 3][k % 3] = c->strain * any(seed, 9 * l + k);
        }
    }
}

/* A turn by `angle` about an axis of its own for each seed. */
static void rotation(uint64_t seed, double angle, double Q[3][3]) {
    double n[3], length = 0;
    for (int k = 0; k < 3; k++) {
        n[k] = any(seed, k);
        length += n[k] * n[k];
    }
    for (int i = 0; i < 3; i++) {
        n[i] /= sqrt(length);
    }
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            int k = 3 - i - j;
            double sign = (j - i + 3) % 3 == 1 ? -1 : 1;
            double cross = i == j ? 0 : sign * n[k];
            Q[i][j] = (i == j ? cos(angle) : 0) + (1 - cos(angle)) * n[i] * n[j] + sin(angle) * cross;
        }
    }
}

/* C = Q (1 + H) - 1 */
static void turn_state(double Q[3][3], double H[3][3], double C[3][3]) {
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            double sum = Q[i][j] - (i == j);
            for (int k = 0; k < 3; k++) {
                sum += Q[i][k] * H[k][j];
            }
            C[i][j] = sum;
        }
    }
}

static void multiply(double A[3][3], double B[3][3], double C[3][3]) {
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            C[i][j] = 0;
            for (int k = 0; k < 3; k++) {
                C[i][j] += A[i][k] * B[k][j];
            }
        }
    }
}

static double distance(double A[3][3], double B[3][3]) {
    double most = 0;
    for (int k = 0; k < 9; k++) {
        most = fmax(most, fabs(A[k / 3][k % 3] - B[k / 3][k % 3]));
    }
    return most;
}

static double size_of(double A[3][3]) {
    static double zero[3][3];
    return distance(A, zero);
}

/* The larger one, not a number where either is not: fmax forgets it. */
static double worst(double a, double b) {
    return isnan(a) || isnan(b) ? NAN : a > b ? a : b;
}

__attribute__((format(printf, 2, 3))) static bool refuse(const check *c, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(c->why, c->size, format, arguments);
    va_end(arguments);
    return false;
}

/* ---- lanes ---- */

/* The same states in other lanes, asked for another time: the same bits. */
static bool check_lanes(const check *c) {
    rg_user_point p[RG_LANES], q[RG_LANES];
    random_states(c, 1, p);
    for (int l = 0; l < RG_LANES; l++) {
        q[l] = p[(l + 1) % RG_LANES];
    }
    ask(c, true, p);
    ask(c, true, q);
    for (int l = 0; l < RG_LANES; l++) {
        rg_user_point *a = &q[l], *b = &p[(l + 1) % RG_LANES];
        if (memcmp(a->P, b->P, sizeof a->P) != 0 || memcmp(a->state_P, b->state_P, sizeof a->P) != 0 ||
            memcmp(a->history, b->history, sizeof a->history) != 0 ||
            memcmp(&a->energy, &b->energy, 8) != 0) {
            return refuse(c,
                          "the same state gives stresses that differ by %.3g Pa in another place, or "
                          "another time: lanes must not know of each other, nor calls of earlier ones",
                          distance(a->P, b->P));
        }
    }
    return true;
}

/* ---- states ---- */

/* The derivative of the energies of q in the direction k of H, in each lane, and of the stresses. */
static void differences(const check *c, const rg_user_point at[RG_LANES], int k, double slope[RG_LANES],
                        double tangent[RG_LANES][3][3]) {
    rg_user_point q[2][RG_LANES];
    for (int sign = 0; sign < 2; sign++) {
        memcpy(q[sign], at, sizeof q[sign]);
        for (int l = 0; l < RG_LANES; l++) {
            q[sign][l].H[k / 3][k % 3] += sign == 0 ? -DIFFERENCE : DIFFERENCE;
        }
        ask(c, false, q[sign]);
    }
    for (int l = 0; l < RG_LANES; l++) {
        double step = q[1][l].H[k / 3][k % 3] - q[0][l].H[k / 3][k % 3];
        slope[l] = (q[1][l].energy - q[0][l].energy) / step;
        for (int i = 0; i < 9; i++) {
            tangent[l][i / 3][i % 3] = (q[1][l].state_P[i / 3][i % 3] - q[0][l].state_P[i / 3][i % 3]) / step;
        }
    }
}

/* Largest a.A.a of the acoustic tensor A along N over that of the moduli, and least; `flat`: over lambda + 2
 * mu alone. */
static void acoustic(const check *c, double tangent[9][3][3], bool flat, double ratio[2]) {
    static const int axis[AXES][3] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1}, {1, 1, 0},  {1, -1, 0},
                                      {1, 0, 1},  {1, 0, -1}, {0, 1, 1}, {0, 1, -1}, {1, 1, 1},
                                      {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}};
    for (int n = 0; n < AXES; n++) {
        for (int a = 0; a < AXES; a++) {
            const int *N = axis[n], *A = axis[a];
            double sum = 0, along = 0, n2 = 0, a2 = 0;
            for (int i = 0; i < 3; i++) {
                along += N[i] * A[i];
                n2 += N[i] * N[i];
                a2 += A[i] * A[i];
                for (int J = 0; J < 3; J++) {
                    for (int kl = 0; kl < 9; kl++) {
                        sum += A[i] * N[J] * tangent[kl][i][J] * A[kl / 3] * N[kl % 3];
                    }
                }
            }
            double cosine = along * along / (n2 * a2);
            double of = flat ? c->m->lambda + 2 * c->m->mu : c->m->mu + (c->m->lambda + c->m->mu) * cosine;
            ratio[0] = fmin(ratio[0], sum / (n2 * a2 * of));
            ratio[1] = worst(ratio[1], sum / (n2 * a2 * of));
        }
    }
}

static void check_energy(const check *c, rg_user_point at[RG_LANES]) {
    rg_user_report *r = c->report;
    double slope[9][RG_LANES], tangent[9][RG_LANES][3][3];
    for (int k = 0; k < 9; k++) {
        differences(c, at, k, slope[k], tangent[k]);
    }
    for (int l = 0; l < RG_LANES; l++) {
        double scale = size_of(at[l].state_P), stiff = 0, error = 0, skew = 0, own[9][3][3], ratio[2] = {1};
        for (int k = 0; k < 9; k++) {
            memcpy(own[k], tangent[k][l], sizeof own[k]);
            stiff = fmax(stiff, size_of(own[k]));
            error = worst(error, fabs(slope[k][l] - at[l].state_P[k / 3][k % 3]));
            r->energetic = r->energetic || fabs(at[l].energy) > 0;
        }
        for (int k = 0; k < 9; k++) {
            for (int i = 0; i < 9; i++) {
                skew = worst(skew, fabs(own[k][i / 3][i % 3] - own[i][k / 3][k % 3]));
            }
        }
        acoustic(c, own, true, ratio);
        r->energy = worst(r->energy, error / scale);
        r->tangent = worst(r->tangent, skew / stiff);
        r->stiffening = worst(r->stiffening, ratio[1] / at[l].stiffening);
        if (c->u->history == 0) { /* the step's stress is the state's */
            r->step = worst(r->step, distance(at[l].P, at[l].state_P) / scale);
        }
    }
}

static void check_turned(const check *c, uint64_t seed, rg_user_point at[RG_LANES]) {
    rg_user_point q[RG_LANES];
    double Q[RG_LANES][3][3];
    memset(q, 0, sizeof q);
    for (int l = 0; l < RG_LANES; l++) {
        rotation(rg_hash(seed, (uint64_t)l), 2, Q[l]);
        turn_state(Q[l], at[l].H, q[l].H);
    }
    ask(c, false, q);
    for (int l = 0; l < RG_LANES; l++) {
        double turned[3][3], F[3][3], tau[3][3], transpose[3][3];
        double scale = size_of(at[l].state_P), energy = fabs(at[l].energy);
        multiply(Q[l], at[l].state_P, turned);
        c->report->turned = worst(c->report->turned, distance(turned, q[l].state_P) / scale);
        if (energy > 0) {
            c->report->turned = worst(c->report->turned, fabs(q[l].energy - at[l].energy) / energy);
        }
        for (int k = 0; k < 9; k++) { /* transposed */
            F[k % 3][k / 3] = at[l].H[k / 3][k % 3] + (k % 4 == 0);
        }
        multiply(at[l].state_P, F, tau);
        for (int k = 0; k < 9; k++) {
            transpose[k / 3][k % 3] = tau[k % 3][k / 3];
        }
        c->report->symmetric = worst(c->report->symmetric, distance(tau, transpose) / scale);
    }
}

static bool check_states(const check *c) {
    const rg_user_facts *facts = c->u->facts;
    rg_user_report *r = c->report;
    for (uint64_t round = 0; round < ROUNDS; round++) {
        rg_user_point at[RG_LANES];
        random_states(c, 2 + round, at);
        ask(c, false, at);
        check_energy(c, at);
        check_turned(c, 2 + round, at);
    }
    if (r->energetic && !(r->energy <= SMOOTH)) {
        return refuse(c,
                      "the stress is not the derivative of the energy: they differ by %.3g of the stress at "
                      "strains of %g, more than %g",
                      r->energy, c->strain, SMOOTH);
    }
    if (!(r->step <= SMOOTH)) {
        return refuse(c, "material_step and material_state give stresses that differ by %.3g of them",
                      r->step);
    }
    if (!facts->small && !(r->turned <= EXACT)) {
        return refuse(c,
                      "not objective: a turned solid has stresses or energies that are off by %.3g of them, "
                      "more than %g",
                      r->turned, EXACT);
    }
    if (!facts->small && !(r->symmetric <= EXACT)) {
        return refuse(c,
                      "Kirchhoff's stress is not symmetric: it differs from its transpose by %.3g of itself, "
                      "more than %g",
                      r->symmetric, EXACT);
    }
    if (!(r->stiffening <= 1.02)) {
        return refuse(c,
                      "the bound `stiffening` is too low: a deformed solid's acoustic tensor is %.4g times "
                      "what it says",
                      r->stiffening);
    }
    return true;
}

/* ---- at rest, and inside out ---- */

static bool check_rest(const check *c) {
    rg_user_point at[RG_LANES];
    rg_user_report *r = c->report;
    double slope[RG_LANES], all[RG_LANES][3][3], tangent[9][3][3];
    memset(at, 0, sizeof at);
    ask(c, false, at);
    double bound = c->strain * 1e-6 * (c->m->lambda + 2 * c->m->mu);
    if (!(size_of(at[0].P) <= bound)) {
        return refuse(c, "a stress of %.3g Pa at rest, where there must be none", size_of(at[0].P));
    }
    for (int k = 0; k < 9; k++) {
        differences(c, at, k, slope, all);
        memcpy(tangent[k], all[0], sizeof tangent[k]);
    }
    r->modulus[0] = INFINITY;
    acoustic(c, tangent, false, r->modulus);
    if (!(r->modulus[1] <= 1.001 + SMOOTH && r->modulus[0] > 0)) {
        return refuse(c,
                      "at rest its acoustic tensor is %.4g to %.4g times that of the moduli that it "
                      "declares: must be above 0 and at most 1",
                      r->modulus[0], r->modulus[1]);
    }
    at[0].H[0][0] = -2; /* J = -1 */
    at[1].H[0][0] = NAN;
    ask(c, false, at);
    if (!isnan(at[0].stiffening) || !isnan(at[1].stiffening)) {
        return refuse(c,
                      "`stiffening` is %g where F is inside out and %g where F is not a number: must be "
                      "not a number in both, or nobody notices",
                      at[0].stiffening, at[1].stiffening);
    }
    return true;
}

/* ---- a cycle ---- */

/* A cycle of strain in the lower lanes; in the upper ones the same, while the solid turns. */
static bool check_path(const check *c) {
    enum { HALF = RG_LANES / 2 };
    const rg_user_facts *facts = c->u->facts;
    const double pi = acos(-1.0), rate = facts->rate > 0 ? facts->rate : 1000;
    rg_material prepared = *c->m;
    prepared.dt = 2 * pi * c->strain / (rate * STEPS);
    check stepping = *c;
    stepping.m = &prepared;
    rg_user_report *r = c->report;
    rg_user_point p[RG_LANES], q[RG_LANES];
    double work[HALF] = {0}, released[HALF] = {0}, put_in[HALF] = {0}, peak[HALF] = {0};
    double turned[3][3], Q[3][3];
    memset(p, 0, sizeof p);
    ask(&stepping, false, p);
    for (int n = 1; n <= STEPS; n++) {
        double part = sin(2 * pi * n / STEPS), most = 0;
        memcpy(q, p, sizeof p);
        for (int l = 0; l < HALF; l++) {
            for (int k = 0; k < 9; k++) {
                q[l].H[k / 3][k % 3] = c->strain * part * any(7, 9 * l + k);
            }
            rotation(rg_hash(9, (uint64_t)l), (double)n / STEPS, Q);
            turn_state(Q, q[l].H, q[l + HALF].H);
        }
        ask(&stepping, true, q);
        for (int l = 0; l < HALF; l++) {
            double increment = 0;
            for (int k = 0; k < 9; k++) {
                increment += (p[l].P[k / 3][k % 3] + q[l].P[k / 3][k % 3]) / 2 *
                             (q[l].H[k / 3][k % 3] - p[l].H[k / 3][k % 3]);
            }
            work[l] += increment;
            put_in[l] += fmax(increment, 0);
            released[l] += q[l].released[RG_RELEASED_PLASTIC] + q[l].released[RG_RELEASED_DAMAGE];
            most = fmax(most, put_in[l]);
            peak[l] = fmax(peak[l], size_of(q[l].P));
        }
        for (int l = 0; l < HALF && n > STEPS / 8; l++) {
            r->balance = worst(r->balance, fabs(work[l] - q[l].energy - released[l]) / most);
            rotation(rg_hash(9, (uint64_t)l), (double)n / STEPS, Q);
            multiply(Q, q[l].P, turned);
            r->path_turned = worst(r->path_turned, distance(turned, q[l + HALF].P) / peak[l]);
            r->step = worst(r->step, distance(q[l].P, q[l].state_P) / peak[l]);
        }
        memcpy(p, q, sizeof p);
    }
    r->path = true;
    double least = 1;
    for (int l = 0; l < HALF; l++) {
        least = fmin(least, released[l] / put_in[l]);
        r->released = fmax(r->released, released[l] / put_in[l]);
    }
    if (r->energetic && !(r->balance <= CLOSES)) {
        return refuse(c,
                      "the energy of a cycle of strain does not add up: stored and set free differ from the "
                      "work by %.3g of it, more than %g",
                      r->balance, CLOSES);
    }
    if (!(least >= -EXACT)) {
        return refuse(c, "a cycle of strain sets free %.3g of the work put in: it makes energy", least);
    }
    if (!facts->small && !(r->path_turned <= TURNING)) {
        return refuse(c,
                      "not objective: on a cycle on which the solid turns the stress is off by %.3g of it, "
                      "more than %g",
                      r->path_turned, TURNING);
    }
    return true;
}

bool rg_user_check(const rg_material *m, rg_user_report *report, char *why, size_t size) {
    const rg_user_material *u = m->of.user.library;
    check c = {.m = m, .u = u, .report = report, .why = why, .size = size};
    c.strain = u->facts->strain > 0 ? u->facts->strain : 0.01;
    *report = (rg_user_report){0};
    return check_lanes(&c) && check_rest(&c) && check_states(&c) && (u->history == 0 || check_path(&c));
}
