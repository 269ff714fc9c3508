/* Fragments that lie in each other: with contact.model interfaces nothing stops one from flying into another,
 * and with model general one that is far faster than sound may do so; this tells when it has happened. */
#ifndef RG_OVERLAP_H
#define RG_OVERLAP_H

#include "diagnostics/fragment.h"

/* Whether some element of one fragment has its centroid, or a point a quarter of the way from a corner to it,
 * inside an element of another fragment: fragments that have met deeper than some 6 % of an element's height.
 * Elements count as the tetrahedra of their current corners, but those that a run gone wrong has stretched to
 * ten times their size do not. `cell`: edge of the search grid (m), some two
 * elements. Gives the ids of the lowest-numbered such pair, the smaller one first. Memory: some cells per
 * element while it runs; elements near other fragments are compared on the ranks that a hash gives the cells
 * to. Collective. */
bool rg_overlap_find(const rg_solver *s, const rg_fragment_parts *p, double cell, rg_gid pair[2]);

#endif
