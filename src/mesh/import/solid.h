/* Solids by their corners: faces as Abaqus numbers them, and tetrahedra in place of other shapes. Quadrangles
 * are cut from their corner of the lowest number, so that elements agree about the face between them. */
#ifndef RG_SOLID_H
#define RG_SOLID_H

#include <stddef.h>

enum { RG_SOLID_FACES = 6, RG_SOLID_TETS = 6 }; /* the most that one has */

/* Triangles of face S1 + `face` of a solid with 4 (a tetrahedron; 10 is the same), 5 (pyramid), 6 (wedge) or
 * 8 (hexahedron) corners; normals inwards. Returns how many: 0 if there is no such face. Corners may
 * coincide, then there are fewer. */
int rg_solid_face(int corners, int face, const size_t node[], size_t triangle[2][3]);

/* The two triangles of a quadrangle, given by its corners in turn. Returns how many. */
int rg_solid_quadrangle(const size_t corner[4], size_t triangle[2][3]);

/* Tetrahedra that fill it, of the orientation that it has. Returns how many. */
int rg_solid_split(int corners, const size_t node[], size_t tet[RG_SOLID_TETS][4]);

#endif
