/* Moves one vertex so that the flattest tetrahedron around it becomes less flat. */
#ifndef RG_IMPROVE_MOVE_H
#define RG_IMPROVE_MOVE_H

#include "mesh/improve/tets.h"

/* Raises the smallest height around a vertex by moving it, within the planes and along the edges of the
 * surface and of kept faces that it lies on. Returns whether it did. Method: L. A. Freitag, C.
 * Ollivier-Gooch, Int. J. Numer. Meth. Engng 40 (1997) 3979: steepest ascent of the minimum of smooth
 * functions, along the shortest vector of the convex hull of the gradients of those near the minimum. */
bool rg_tets_move(rg_tets *t, rg_gid vertex);

#endif
