/* The 10-node tetrahedron outside the time loop: positions, shape functions, mass. Scalar, for set-up and
 * output. */
#ifndef RG_ELEMENT_H
#define RG_ELEMENT_H

#include "layout.h"
#include "modes.h"

/* Corners at the ends of each node's edge; a corner is both of its own. */
extern const int rg_node_end[RG_NODES][2];

/* Reference position of a node from the four corners [4][3] (m). */
void rg_node_position(const double *corner, int node, double x[3]);

/* Reference position of quadrature point g (m). */
void rg_gauss_position(const double *corner, int g, double x[3]);

/* Barycentric coordinates of point x in the element with the given corners [4][3]. */
void rg_barycentric(const double *corner, const double x[3], double l[4]);

/* The ten shape functions at barycentric coordinates l. */
void rg_shape(const double l[4], double N[RG_NODES]);

/* Gradients of the barycentric coordinates of the element with these corners [4][3] (1/m). */
void rg_barycentric_slopes(const double *corner, double slope[4][3]);

/* Gradient [component][direction] of a field (layout.h) at the corners of an element; in between it is
 * linear. */
void rg_corner_gradients(const rg_real *field, size_t slot, double slope[4][3], double out[4][3][3]);

/* Entry (a, b) of the mass matrix over rho V, and of its inverse. */
double rg_mass_entry(rg_mass kind, int a, int b);
double rg_inverse_mass_entry(rg_mass kind, int a, int b);

/* M v of element `slot` of total mass `mass`; v laid out as in layout.h. */
void rg_mass_times(rg_mass kind, double mass, const rg_real *v, size_t slot, double out[RG_NODES][3]);

#endif
