/* Shared by the files of the scalar reference: face quadrature, 3-vectors, and the kernels themselves.
 *
 * The reference is written straight after the equations (shape functions, quadrature sums, full matrices),
 * with no regard for speed, so that the fast kernels have something independent to be compared with. */
#ifndef RG_REFERENCE_H
#define RG_REFERENCE_H

#include "kernels.h"

/* Face quadrature point q: barycentric coordinates l[3] with respect to the face's corners; returns its
 * weight (the six weights sum to 1). */
double rg_reference_face_point(int q, double l[3]);

/* Values n[6] of the face's quadratic shape functions at barycentric coordinates l[3]. */
void rg_reference_face_shape(const double l[3], double n[RG_FNODES]);

static inline double rg_reference_dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void rg_reference_cross(const double a[3], const double b[3], double c[3]) {
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

/* The entries of rg_kernels_reference; see kernels.h. */
void rg_reference_send(const rg_trace_args *args, size_t begin, size_t end);
void rg_reference_send_tractions(const rg_trace_args *args, size_t begin, size_t end);
void rg_reference_receive(const rg_trace_args *args, size_t begin, size_t end);
void rg_reference_bulk(const rg_bulk_args *args, size_t begin, size_t end);
void rg_reference_bulk_state(const rg_bulk_state_args *args, size_t begin, size_t end);
void rg_reference_viscosity(const rg_viscosity_args *args, size_t begin, size_t end);
void rg_reference_prestress(const rg_prestress_args *args, size_t begin, size_t end);
void rg_reference_prestress_state(const rg_prestress_state_args *args, size_t begin, size_t end);
void rg_reference_interface(const rg_interface_args *args, size_t begin, size_t end);
void rg_reference_interface_state(const rg_interface_state_args *args, size_t begin, size_t end);
void rg_reference_kick(const rg_kick_args *args, size_t begin, size_t end);
void rg_reference_drift(const rg_drift_args *args, size_t begin, size_t end);
void rg_reference_kinetic(const rg_kinetic_args *args, size_t begin, size_t end);
void rg_reference_contact(const rg_contact_args *args, size_t begin, size_t end);

#endif
