/* Faces of elements: which are on the surface, and their geometry. */
#ifndef RG_FACE_H
#define RG_FACE_H

#include <stdbool.h>
#include <stddef.h>

#include "domain/domain.h"

/* Whether a face of an element is on the surface. */
bool rg_surface_has(const rg_domain *d, size_t slot, int face);

/* Area of a face of the element with these corners [4][3] (m^2), and its unit normal out of the element. */
double rg_surface_area(const double *corner, int face, double normal[3]);

/* Height of the element over the face (m). */
double rg_surface_height(const rg_domain *d, size_t slot, int face);

/* What forces do to the solid. */
typedef struct {
    double dt, dt_now;      /* velocity += dt M^-1 f, step_velocity += dt_now M^-1 f */
    rg_real *velocity;      /* whole fields (layout.h) */
    rg_real *step_velocity; /* or NULL */
} rg_push;

#endif
