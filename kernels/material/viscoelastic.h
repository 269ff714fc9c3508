/* Linear viscoelasticity at any rotation: a neo-Hookean solid of what is left in the long run beside three
 * Maxwell elements, springs with dashpots, in the Green strain E = 1/2 (F^T F - I),
 *
 *     W = W_neo(lambda_inf, mu_inf) + sum_i (lambda_i/2 (tr A_i)^2 + mu_i A_i:A_i),                      (1)
 *     dA_i/dt = dE/dt - A_i/tau_i,   P = P_neo + F sum_i (lambda_i tr A_i I + 2 mu_i A_i).               (2)
 *
 * A_i is the elastic strain of element i. It lives in the axes of the material, as E does, so a rotation of
 * space changes nothing; and it makes the relaxation (2) linear, as the hereditary integrals of J. C. Simo
 * (1987) are, of which the shear and bulk moduli G (1 - sum g_i (1 - exp(-t/tau_i))) and likewise K with k_i
 * are the answer to a small step of strain. Here there is a stored energy (1) beside them, so what the
 * dashpots dissipate is known. The moduli to begin with are those of the material: waves and the time step.
 *
 * One step solves (2) exactly for a strain that goes straight from E before it to E after it: A = a A + b dE,
 * a = exp(-h), b = (1 - a)/h, h = dt/tau. What the dashpots take of the trapezoidal work of the step,
 * 1/2 (S_i before + S_i after):(dE - dA_i), counts as dissipated: stored and dissipated energy are that work,
 * whatever the step. */
#ifndef RG_VISCOELASTIC_H
#define RG_VISCOELASTIC_H

#include "material/neo_hookean.h"
#include "vec_math.h"

/* What a point needs of the parameters. */
typedef struct {
    rg_material rest; /* the solid in the long run */
    struct {
        double lambda, twice_mu; /* Pa */
        rg_vec keep, gain;       /* a, b of one step */
    } element[RG_VE_ELEMENTS];
    double modulus, share; /* lambda + 2 mu of all elements, and 1 over that of the material */
    double rest_share;     /* that of `rest` over it */
} rg_ve_constants;

RG_INLINE rg_ve_constants rg_ve_constants_of(const rg_material *m) {
    const double *shear = m->of.parameter + RG_PARAMETER_SHEAR_FRACTION_1;
    const double *bulk = m->of.parameter + RG_PARAMETER_BULK_FRACTION_1;
    const double *time = m->of.parameter + RG_PARAMETER_RELAXATION_TIME_1;
    const double K = m->lambda + 2.0 / 3 * m->mu;
    rg_ve_constants c = {.rest = *m};
    for (int i = 0; i < RG_VE_ELEMENTS; i++) {
        double mu = shear[i] * m->mu, lambda = bulk[i] * K - 2.0 / 3 * mu;
        double h = time[i] > 0 ? m->dt / time[i] : 1;
        c.element[i].lambda = lambda;
        c.element[i].twice_mu = 2 * mu;
        c.element[i].keep = rg_exp(rg_splat(-h));
        c.element[i].gain = rg_expm1(rg_splat(-h)) * (-1 / h);
        c.modulus += lambda + 2 * mu;
        c.rest.lambda -= lambda;
        c.rest.mu -= mu;
    }
    c.share = 1 / (m->lambda + 2 * m->mu);
    c.rest_share = (c.rest.lambda + 2 * c.rest.mu) * c.share;
    return c;
}

/* Six components xx yy zz yz xz xy. */
static const int rg_ve_row[6] = {0, 1, 2, 1, 0, 0}, rg_ve_column[6] = {0, 1, 2, 2, 2, 1};
static const int rg_ve_place[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};

/* In H = F - I: 2 E = H + H^T + H^T H keeps all digits of a small strain. */
RG_INLINE void rg_ve_strain(rg_vec H[3][3], rg_vec E[6]) {
    for (int k = 0; k < 6; k++) {
        int i = rg_ve_row[k], j = rg_ve_column[k];
        E[k] = 0.5 * ((H[i][j] + H[j][i]) + (H[0][i] * H[0][j] + H[1][i] * H[1][j] + H[2][i] * H[2][j]));
    }
}

/* lambda tr A I + 2 mu A */
RG_INLINE void rg_ve_stress(const rg_ve_constants *c, int i, rg_vec A[6], rg_vec S[6]) {
    rg_vec pressure = c->element[i].lambda * (A[0] + A[1] + A[2]);
    for (int k = 0; k < 6; k++) {
        S[k] = c->element[i].twice_mu * A[k] + (k < 3 ? pressure : rg_splat(0.0));
    }
}

RG_INLINE rg_vec rg_ve_dot(rg_vec S[6], rg_vec A[6]) {
    return S[0] * A[0] + S[1] * A[1] + S[2] * A[2] + 2.0 * (S[3] * A[3] + S[4] * A[4] + S[5] * A[5]);
}

/* P += F S */
RG_INLINE void rg_ve_add_piola(rg_vec H[3][3], rg_vec S[6], rg_vec P[3][3]) {
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            const int *column = rg_ve_place[j];
            P[i][j] += S[rg_ve_place[i][j]] +
                       (H[i][0] * S[column[0]] + H[i][1] * S[column[1]] + H[i][2] * S[column[2]]);
        }
    }
}

/* Largest absolute row sum: a bound on the eigenvalues. */
RG_INLINE rg_vec rg_ve_bound(rg_vec S[6]) {
    rg_vec x = rg_abs(S[3]), y = rg_abs(S[4]), z = rg_abs(S[5]);
    return rg_max(S[0] + (y + z), rg_max(S[1] + (x + z), S[2] + (x + y)));
}

/* Stress of all elements at a strain; they go on by a step, and `spent` is what it dissipates, if `advance`.
 */
RG_INLINE void rg_ve_elements(const rg_ve_constants *c, bool advance, rg_vec E[6],
                              rg_vec history[RG_VE_HISTORY], rg_vec S[6], rg_vec *spent) {
    rg_vec gained[6], twice = {0};
    for (int k = 0; k < 6; k++) {
        gained[k] = E[k] - history[RG_VE_STRAIN + k];
        S[k] = (rg_vec){0};
    }
    for (int i = 0; i < RG_VE_ELEMENTS; i++) {
        rg_vec *A = &history[RG_VE_ELASTIC + 6 * i], before[6], after[6], now[6], flow[6];
        rg_ve_stress(c, i, A, before);
        for (int k = 0; k < 6; k++) {
            now[k] = advance ? c->element[i].keep * A[k] + c->element[i].gain * gained[k] : A[k] + gained[k];
            flow[k] = gained[k] - (now[k] - A[k]);
        }
        rg_ve_stress(c, i, now, after);
        for (int k = 0; k < 6; k++) {
            before[k] += after[k];
            S[k] += after[k];
            A[k] = advance ? now[k] : A[k];
        }
        twice += rg_ve_dot(before, flow);
    }
    for (int k = 0; advance && k < 6; k++) {
        history[RG_VE_STRAIN + k] = E[k];
    }
    *spent = advance ? 0.5 * twice : rg_splat(0.0);
}

/* P (Pa) and `out` at F = I + H; history goes on if `advance`. */
RG_INLINE void rg_ve_step(const rg_ve_constants *c, bool advance, rg_vec H[3][3],
                          rg_vec history[RG_VE_HISTORY], rg_vec P[3][3], rg_point *out) {
    rg_volume_change v;
    rg_vec E[6], S[6];
    rg_neo_hookean_volume(H, &v);
    rg_neo_hookean_stress(&c->rest, H, &v, P);
    rg_ve_strain(H, E);
    rg_ve_elements(c, advance, E, history, S, &out->released[RG_RELEASED_PLASTIC]);
    rg_ve_add_piola(H, S, P);
    out->released[RG_RELEASED_DAMAGE] = (rg_vec){0};
    /* (N.S N) I + mu F F^T + (lambda + mu) (F N) (x) (F N) of the elements */
    rg_vec softer = c->rest_share * rg_neo_hookean_stiffening(&c->rest, &v);
    rg_vec stretch = 1.0 + 2.0 * rg_ve_bound(E), tension = rg_max(rg_ve_bound(S), rg_splat(0.0));
    out->stiffening = softer + (c->modulus * stretch + tension) * c->share;
}

#endif
