/* The outer faces of the solid (domain/face.h): integrals over them, and what forces on them do to its
 * elements.
 *
 * Integrals over a face are by the six-point rule of the interfaces, exact to degree 4. The forces of a face
 * are on the nodes of its own element alone, which no other element shares (where elements do, the assembly
 * adds up what each has made), so they do not depend on the partition. */
#ifndef RG_SURFACE_H
#define RG_SURFACE_H

#include "case/case.h"
#include "domain/domain.h"
#include "domain/face.h"
#include "kernels.h"

typedef struct {
    const rg_domain *domain;
    const rg_material *material;             /* of the solid, by number */
    double inverse_mass[RG_NODES][RG_NODES]; /* (M / (rho V))^-1 */
    /* The rule: weights (sum 1), and at its points the shape functions of a face's nodes and their
     * derivatives by the barycentric coordinates of its second and third corner. */
    double weight[RG_POINTS], shape[RG_POINTS][RG_FNODES], slope[RG_POINTS][2][RG_FNODES];
} rg_surface;

rg_surface rg_surface_make(const rg_domain *d, const rg_material *m, rg_mass mass);

/* Positions of a face's nodes at displacement u (a whole field); NULL: of reference. */
void rg_surface_place(const rg_surface *s, size_t slot, int face, const rg_real *u, double x[RG_FNODES][3]);

/* Sum over a face's nodes of shape function times value, at point q of the rule. */
void rg_surface_at(const rg_surface *s, int q, double value[RG_FNODES][3], double out[3]);

/* Forces on the nodes of a face: the mass matrix couples all nodes of the element. */
void rg_surface_push(const rg_surface *s, size_t slot, int face, double force[RG_FNODES][3],
                     const rg_push *push);

/* Largest eigenvalue of a face's int N N dA over its area and M over the element's mass, of one component: by
 * power iteration, from a vector that is no eigenvector. All faces have the same. */
double rg_surface_spring_value(const rg_surface *s);

/* Largest singular value of (sum over points of weight N_a N_b,1) between the nodes of a face, in the inner
 * product of the inverse mass of its element, over that mass: the stiffness of a pressure p on a face that is
 * flat is -p/2 times this, for each tangent x,1 and x,2, crossed with the other one. All faces and both
 * directions have the same. */
double rg_surface_follower_value(const rg_surface *s);

#endif
