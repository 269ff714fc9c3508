/* Deshpande-Evans ceramic: what run, kernel and reference have in common (A. N. Seagraves, MIT 2010, 5.2.1
 * and appendix A; V. S. Deshpande and A. G. Evans, J. Mech. Phys. Solids 56, 2008).
 *
 * A solid with f penny-shaped flaws of radius a per volume, from which wing cracks of length l grow. Damage
 * D = 4/3 pi (l + alpha a)^3 f, D = D0 (1 + X)^3 with X = l/(alpha a). With the mean stress sm (tension
 * positive) and the von Mises stress se,
 *     I    sm/se <= -B/A                  K_I = 0
 *     II   between                        K_I = sqrt(pi a) (A sm + B se)
 *     III  sm/se >= A B/(C^2 - A^2)       K_I = sqrt(pi a) sqrt(C^2 sm^2 + E^2 se^2)
 *     W = (1/4G) (2/3 se^2 + 3 (1 - 2 nu)/(1 + nu) sm^2) + kappa K_I^2/(pi a),
 *     elastic strain = dW/dsigma,   dl/dt = min(l0dot (K_I/K_IC)^m, sqrt(G/rho))
 * A, B, C, E are functions of X. Plastic flow with equivalent strain ep and rate edot, along the deviator:
 *     se = s0(ep) (edot/edot0)^(1/n)                            edot <= edot_t
 *     se = s0(ep) (edot/edot0) (edot_t/edot0)^((1-n)/n)         beyond,   s0 = (sY/2) (1 + (ep/epsY)^M)
 *
 * The published W has a property to know about: K_I at constant stress need not grow with D, so W does not,
 * and the energy that growing cracks release at constant strain can be negative. A, B and E first fall as a
 * crack leaves its flaw (with table 5.4 A goes from 2.76 at D = 0.01 to 1.03 at D = 0.02), and in compression
 * cracks arrest. Of random growing states half raise the stored energy
 * (tests/unit/kernels/test_deshpande_evans.c tells by how much). Over an unconfined test to failure the sum
 * is positive, after a dip; in confined compression it stays negative.
 *
 * Uniaxial stress of table 5.4, as bench/studies/ceramic-curves prints it: largest Cauchy stress at strain,
 * in GPa (%), and the stress with --set material.growth_speed=1e-7 (l0dot = 100 nm/s):
 *     rate (1/s)     1e3          1e4          1e5          nm/s
 *     compression    3.20 (0.92)  3.95 (1.14)  4.78 (1.36)  6.02  7.44  9.22
 *     tension        0.98 (0.33)  1.21 (0.41)  1.48 (0.50)  1.84  2.26  2.77
 * (A point by itself, at a constant logarithmic rate of 1e4/s: 3.94 and 1.21 GPa,
 * tests/system/test_ceramic.py.) A decade of rate is a factor 10^(1/(m + 1)) = 1.23; at higher ones cracks
 * run at the shear wave speed. The default l0dot gives the 3 GPa that alumina bears in compression, 100 nm/s
 * twice that. Afterwards the stress falls to that of damage_max, much lower in tension than in compression
 * (friction), with hardly any flow. Uniaxial strain in compression closes the cracks, and the solid flows. */
#ifndef RG_DESHPANDE_EVANS_MODEL_H
#define RG_DESHPANDE_EVANS_MODEL_H

#include <stdbool.h>

/* Parameters; the names of the thesis in brackets. */
typedef struct {
    double shear, poisson, density; /* intact: G (Pa), nu, rho (kg/m^3) */
    double flaw_radius;             /* a (m) */
    double flaw_density;            /* f (1/m^3) */
    double alpha, beta, gamma;      /* geometry of wing cracks: cosine of the inclination; 0.1; 2 */
    double friction;                /* mu */
    double toughness;               /* K_IC (Pa sqrt m) */
    double growth_speed;       /* l0dot (m/s): table 5.4 reads 100, the unit is illegible (nm/s or um/s) */
    double growth_exponent;    /* m */
    double damage_max;         /* D stops here, below 1 (at 1 the solid has no stiffness) */
    double yield_stress;       /* sY (Pa) */
    double yield_strain;       /* epsY */
    double hardening_exponent; /* M */
    double plastic_rate;       /* edot0 (1/s) */
    double transition_rate;    /* edot_t (1/s) */
    double rate_exponent;      /* n */
    bool single_pi;            /* c3 = 2 alpha^2 pi X^2, as a derivation gives, not the thesis's pi^2 */
} rg_deshpande_evans;

/* Alumina, table 5.4, with 100 um/s, and 0.002 taken for both plastic_rate and yield_strain (the table has
 * one of them). */
rg_deshpande_evans rg_deshpande_evans_alumina(void);

/* History of a point. Zero is the virgin material. */
enum {
    RG_DE_GROWTH = 0, /* X = l/(alpha a) = (D/D0)^(1/3) - 1 */
    RG_DE_STRAIN = 1, /* ep, accumulated equivalent plastic strain */
    RG_DE_FLOW = 2,   /* Fp^-1 Fp^-T - I, six components xx yy zz yz xz xy */
    RG_DE_HISTORY = 8,
};

#define RG_DE_NO_FLOW   1e-12 /* plastic strain in one step below which there is none */
#define RG_DE_NO_GROWTH 1e-12 /* growth of X in one step, over X + beta/alpha, below which there is none */
#define RG_DE_LITTLE    1e-6  /* ... and below which one explicit Euler step is enough */
enum { RG_DE_PANELS = 8 };    /* else: panels of the quadrature over X */
enum { RG_DE_BINOMIAL = 8 };  /* terms of the hardening by x = 1 %; the first left out is 1e-17 of the sum */

/* What the kernel needs of the parameters and of the size of the step. */
typedef struct {
    double bulk, von_mises;   /* K, and 3G: se = 3G eb of the intact solid (Pa) */
    double p_modulus;         /* lambda + 2 mu (Pa) */
    double crack_compliance;  /* 2 kappa = pi D0/(2 alpha^3 G (1 + nu)) (1/Pa) */
    double offset;            /* beta/alpha */
    double c1, c2, c3;        /* c1 (X + offset)^(3/2), (c2 - 1) (1 - D^(2/3))/X^2, c3/X^2 */
    double d0, d0_23;         /* D0, D0^(2/3) */
    double sum, difference;   /* (A3 + A1)/sqrt 3, A3 - A1 */
    double gamma_root;        /* (C - A)/(1 + X)^(1/2) */
    double growth_max;        /* X at damage_max */
    double intensity;         /* sqrt(pi a)/K_IC (1/Pa) */
    double exponent;          /* m */
    double log_rate, log_cap; /* log(dX/dt) at K_I = K_IC and at the shear wave speed (1/s) */
    double silent;            /* no growth where K_I^2/(pi a) is below this (Pa^2) */
    double dt, reach;         /* s; largest growth of X in dt */
    double half_yield, yield_strain, hardening; /* sY/2, epsY, M */
    double binomial[RG_DE_BINOMIAL];            /* of (1 + x)^M = 1 + sum binomial[k] x^(k + 1) */
    double inv_n, n, log_edot0_dt, log_transition,
        jump;     /* log(edot0 dt); log(edot_t/edot0) and its (1 - 1/n) */
    double quiet; /* no plastic flow where se is below this (Pa) */
} rg_de_constants;

/* Constants for steps of `dt` (s), which is > 0. */
rg_de_constants rg_de_prepare(const rg_deshpande_evans *p, double dt);

/* The ceramic as a material of a run (materials.h). */
typedef struct {
    rg_deshpande_evans parameters;
    rg_de_constants constants;
} rg_de_material;

/* D0 = 4/3 pi (alpha a)^3 f, and D = D0 (1 + X)^3. */
double rg_de_initial_damage(const rg_deshpande_evans *p);
double rg_de_damage(const rg_deshpande_evans *p, double growth);

#endif
