/* Makes flat tetrahedra less flat, for a longer time step. */
#ifndef RG_IMPROVE_H
#define RG_IMPROVE_H

#include "mesh/mesh.h"

typedef struct {
    double before, after;        /* smallest height (m) */
    int64_t moves, edges, faces; /* vertices moved, edges and faces replaced */
} rg_improvement;

/* Raises the smallest heights of a connected mesh, by moving vertices and by changing which are joined; the
 * mesh has to be sorted and connected anew. Surface, sets, volume sets and the faces in `mesh->inner` keep
 * their places: vertices on them move within their planes and along their straight edges, those on curved
 * surfaces not at all. An element that is new has the `original` of one that it replaced. The result follows
 * from the mesh alone. */
rg_improvement rg_mesh_improve(rg_mesh *mesh);

#endif
