/* Which faces may touch: pairs of exposed faces whose boxes, fattened by a distance that they may move, meet.
 *
 * Each rank sends its faces to the ranks that a hash gives the cells of a grid to, which compare what has
 * come to a cell and send the pairs to those who own the faces: no rank sees the whole surface. A pair is
 * found by the numbers of its faces alone, and what it comes to follows from the present state, so that it
 * does not matter when and on which ranks the search was made, as long as it has found all that touch. */
#ifndef RG_SEARCH_H
#define RG_SEARCH_H

#include <mpi.h>

#include "kernels.h"
#include "mesh/mesh.h"

/* An exposed face; corners in the order of rg_contact_args. */
typedef struct {
    rg_gid id; /* 4 * element + local face */
    int32_t rank, row;
    int32_t former; /* not 0: it was an interface */
    int32_t material;
    double modulus;   /* lambda + 2 mu (Pa) */
    double shear;     /* mu (Pa) */
    double density;   /* kg/m3 */
    double height;    /* of its element over it (m) */
    double rest[9];   /* corners, undeformed (m) */
    double corner[9]; /* now */
} rg_exposed_face;

/* Two of them, the one with the lower number first. */
typedef struct {
    rg_exposed_face face[2];
    rg_contact_pair pair; /* all but the rows */
} rg_candidate;

typedef struct {
    double penalty; /* kappa h/(lambda + 2 mu) */
    double skin;    /* of the height of an element */
    double reach;   /* of that */
    double fat;     /* by so much each corner may move before the next search (m), */
    double turn;    /* and so far each unit normal */
} rg_search;

/* The pairs that a face of this rank has a part in, by the numbers of their faces. Collective; free with
 * rg_free. */
rg_candidate *rg_search_pairs(const rg_search *by, const rg_exposed_face *face, size_t faces, size_t *pairs,
                              MPI_Comm comm);

/* Whether these two faces, of different elements, may touch before the next search: not if they are parts of
 * one convex edge of the solid whose corners are still together. Fills in `pair`. */
bool rg_search_may_touch(const rg_search *by, const rg_exposed_face *a, const rg_exposed_face *b,
                         rg_contact_pair *pair);

#endif
