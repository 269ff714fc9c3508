/* Scalar reference of the Deshpande-Evans ceramic, after the equations of material/deshpande_evans_model.h,
 * in damage D. */
#ifndef RG_REFERENCE_DESHPANDE_EVANS_H
#define RG_REFERENCE_DESHPANDE_EVANS_H

#include "material/deshpande_evans_model.h"

/* A, B, C, E of (A.1), (A.2), (A.8), (A.9). */
typedef struct {
    double A, B, C, E;
} rg_reference_de_cracks;

rg_reference_de_cracks rg_reference_de_coefficients(const rg_deshpande_evans *p, double damage);

/* 1, 2 or 3, from the stress triaxiality. */
int rg_reference_de_regime(const rg_deshpande_evans *p, double damage, double mean, double mises);

/* W (J/m^3) of a stress with mean and von Mises part (Pa), and K_I (Pa sqrt m). */
double rg_reference_de_energy(const rg_deshpande_evans *p, double damage, double mean, double mises);
double rg_reference_de_intensity(const rg_deshpande_evans *p, double damage, double mean, double mises);

/* dD/dt (1/s). */
double rg_reference_de_damage_rate(const rg_deshpande_evans *p, double damage, double mean, double mises);

/* Mean and von Mises stress (Pa) of the elastic strain with trace ekk and eb = sqrt(2/3 e':e'); the regime.
 */
int rg_reference_de_invariants(const rg_deshpande_evans *p, double damage, double ekk, double eb,
                               double *mean, double *mises);

/* Stress (Pa) that the plastic strain ep and the rate (1/s) ask for. */
double rg_reference_de_flow_stress(const rg_deshpande_evans *p, double ep, double rate);

/* Plastic strain of a step of dt (s) at fixed total strain: backward Euler, by bisection. */
double rg_reference_de_flow(const rg_deshpande_evans *p, double damage, double ekk, double eb, double ep,
                            double dt);

/* X after dt (s) at fixed elastic strain, by the rule of material/deshpande_evans.h. */
double rg_reference_de_growth(const rg_deshpande_evans *p, double growth, double ekk, double eb, double dt);

/* What a step did at a point, beside stress and history. */
typedef struct {
    double stiffening, energy, plastic, damage; /* as in rg_de_result */
    double ekk, eb;                             /* elastic strain before flow and growth */
    int regime;                                 /* at the end */
    int regime_before;                          /* before flow and growth */
} rg_reference_de_result;

/* One step of dt (s; 0: at rest) ending at F: updates history[RG_DE_HISTORY], gives P (Pa). */
rg_reference_de_result rg_reference_de_step(const rg_deshpande_evans *p, double dt, double F[3][3],
                                            double history[RG_DE_HISTORY], double P[3][3]);

#endif
