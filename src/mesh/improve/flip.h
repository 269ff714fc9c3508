/* Changes which vertices are joined around an edge or across a face, so that the flattest tetrahedron there
 * becomes less flat. Faces with labels stay, but for pairs of surface faces in one plane and one set. */
#ifndef RG_IMPROVE_FLIP_H
#define RG_IMPROVE_FLIP_H

#include "mesh/improve/tets.h"

/* Removes the edge between vertices a and b, which is there, whose ring of neighbours is joined by triangles
 * in the best way (G. T. Klincsek, Ann. Discrete Math. 9 (1980) 121). Returns whether the smallest height
 * grew. */
bool rg_tets_remove_edge(rg_tets *t, rg_gid a, rg_gid b);

/* Replaces a tetrahedron and the one across its face f by three around the line between their apexes. Returns
 * whether the smallest height grew. */
bool rg_tets_remove_face(rg_tets *t, rg_gid tet, int f);

#endif
