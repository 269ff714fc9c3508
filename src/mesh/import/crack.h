/* Cracks of no width: faces of two elements at the same place, each with vertices of its own. */
#ifndef RG_CRACK_H
#define RG_CRACK_H

#include "mesh/mesh.h"

typedef struct {
    int64_t faces;
    double area;     /* m2 */
    double place[3]; /* the middle of it (m) */
} rg_mesh_crack;

/* Joins the surface faces that lie on each other, of different elements on both sides of them (of the same
 * part, where parts are kept apart): they become faces between elements, in the surface set `name` besides
 * those of both sides, and mesh->crack knows that set. The mesh is sorted and connected, before and after;
 * vertices that nobody uses any more are gone. */
rg_mesh_crack rg_mesh_take_crack(rg_mesh *mesh, const char *name);

#endif
