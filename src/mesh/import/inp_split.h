/* Solids by their corners: faces as Abaqus numbers them, and tetrahedra in place of other shapes. Quadrangles
 * are cut from their corner of the lowest number, so that elements agree about the face between them. */
#ifndef RG_INP_SPLIT_H
#define RG_INP_SPLIT_H

#include <stdint.h>

enum { RG_INP_FACES = 6, RG_INP_TETS = 6 }; /* the most that one has */

/* Triangles of face S1 + `face` of a solid with 4 (a tetrahedron; 10 is the same), 5 (pyramid), 6 (wedge) or
 * 8 (hexahedron) corners; normals inwards. Returns how many: 0 if there is no such face. Corners may
 * coincide, then there are fewer. */
int rg_inp_face(int corners, int face, const uint32_t node[], uint32_t triangle[2][3]);

/* Tetrahedra that fill it, of the orientation that it has. Returns how many. */
int rg_inp_split(int corners, const uint32_t node[], uint32_t tet[RG_INP_TETS][4]);

#endif
