/* Loads ahead of the kernels: what a sweep over a tile will need, brought into the cache at once. */
#ifndef RG_AHEAD_H
#define RG_AHEAD_H

#include "solver/solver.h"

/* Of the element sweep: its elements, the interfaces inside, and the traces on other tiles' side. */
void rg_ahead_of_elements(const rg_solver *s, const rg_tile *t);

/* Of the boundary sweep: the elements, the tile-boundary faces, and both sides' tractions. */
void rg_ahead_of_boundary(const rg_solver *s, const rg_tile *t);

#endif
