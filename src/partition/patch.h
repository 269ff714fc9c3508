/* The patch: the few thousand elements of a mesh on which its largest frequency can be found. */
#ifndef RG_PATCH_H
#define RG_PATCH_H

#include "materials.h"
#include "mesh/mesh.h"

enum {
    RG_PATCH_MOST = 5000, /* elements of a patch */
    RG_PATCH_CUT = -2     /* "surface set" of the faces where it is cut out of the mesh */
};

/* How much an element limits the time step: sum over its inner faces of area^2/min(V, V') (A + A')/2
 * (1/(rho V) + 1/(rho' V')) (1/m^2), moduli A = lambda + 2 mu and densities over those of the first material.
 * Up to constants this is the squared frequency with which two elements swing against each other on the
 * penalty of their face, beta_s (A + A')/2 area/h with h = 3 min(V, V')/area; the lift's scales the same.
 * material[]: by number. */
double rg_patch_rank(const rg_element *e, const rg_material *material);

/* The elements around the worst one and, fewer, around each of the next worst, by rg_patch_rank (the lower
 * number first among equals), as a part of its own: numbered anew in the same order, without neighbours
 * outside and without surface sets. The whole mesh if that is not larger than RG_PATCH_MOST. The same for any
 * number of ranks. Collective. The caller of rank 0 owns the result; the others get NULL. */
rg_part *rg_patch_gather(const rg_part *part, const rg_material *material, MPI_Comm comm);

#endif
