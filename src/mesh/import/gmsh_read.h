/* Meshes by way of Gmsh. */
#ifndef RG_GMSH_READ_H
#define RG_GMSH_READ_H

#include "case/expr.h"
#include "mesh/import/import.h"

/* Element size for geometries: a number or an expression in x, y, z, in units of the input; NULL: Gmsh's own
 * choice. curvature: so many elements at least around a whole turn; 0: none in particular. */
typedef struct {
    const rg_expr *at;
    double curvature;
} rg_gmsh_size;

/* Reads a mesh in any format of this Gmsh, or meshes a geometry (.geo, .step, ...) of elements
 * of that size; formats that say their unit (STEP, IGES) are in m already. Physical surfaces and volumes
 * become sets by their names, or their numbers where they have none, and may overlap; where there are no
 * physical surfaces (or volumes) at all, all surfaces (or volumes) do by their numbers. Elements outside of
 * the physical volumes are left out. Second-order elements are taken by their corners. What is left out is
 * told in warnings; elements that are not tetrahedra end the run. The result is neither sorted nor connected;
 * `original` holds Gmsh's element numbers. The caller frees it. */
rg_mesh *rg_gmsh_read(const char *path, const rg_import_how *how, const rg_gmsh_size *size);

#endif
