/* A flat mesh of triangles becomes a plate. */
#ifndef RG_EXTRUDE_H
#define RG_EXTRUDE_H

#include "mesh/import/import.h"

/* Puts prisms, cut into tetrahedra, on the faces of an import, along z, in as many layers as `how` asks for:
 * sets of faces become sets of volumes, sets of edges and of nodes become sets of faces, and there are two
 * more, "bottom" and "top". Ends the run if there are solids, or no faces, or these are not flat. */
void rg_extrude(rg_import *m);

#endif
