/* Scalar twin of material/hencky.h: Hencky strain of F Fp^-1, flow along its deviator, and the stress. */
#ifndef RG_REFERENCE_HENCKY_H
#define RG_REFERENCE_HENCKY_H

/* Eigenvalues and eigenvectors (columns of v) of a symmetric matrix, by Jacobi's rotations. */
void rg_reference_eigen(double s[3][3], double value[3], double v[3][3]);

/* out = sum f(value_k) v_k v_k^T. */
void rg_reference_function(double s[3][3], double (*f)(double), double out[3][3]);

/* b = F Cp^-1 F^T with Cp^-1 = I + flow (xx yy zz yz xz xy), the deviator e of 1/2 log b; returns
 * eb = sqrt(2/3 e:e). */
double rg_reference_hencky(double F[3][3], const double flow[6], double b[3][3], double e[3][3]);

/* flow after e is scaled by 1 - part: Cp^-1 = F^-1 b exp(-2 part e) F^-T, where the exponential is that of a
 * symmetric matrix coaxial with b. */
void rg_reference_hencky_flow(double inverse[3][3], double b[3][3], double e[3][3], double part,
                              double flow[6]);

/* P = tau F^-T (Pa), tau = mean I + (2/3) (mises/eb) e. */
void rg_reference_hencky_piola(double mean, double mises, double eb, double e[3][3], double inverse[3][3],
                               double P[3][3]);

/* The bound of material/hencky.h, with the Lame constants (Pa); eb: of the stress. */
double rg_reference_hencky_stiffening(double lambda, double mu, double mean, double mises, double eb,
                                      double inverse[3][3]);

#endif
