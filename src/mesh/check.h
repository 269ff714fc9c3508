/* Whether a mesh can be computed on. */
#ifndef RG_MESH_CHECK_H
#define RG_MESH_CHECK_H

#include <stdbool.h>

#include "base/input_errors.h"
#include "mesh/mesh.h"

/* Ends the run (RG_USAGE) with messages (base/input_errors.h) that begin with `name` and name elements by
 * their numbers in the input, if the mesh, sorted or not but connected, has
 *   - a position that is not finite, or a vertex that no element uses,
 *   - an element whose corners are not ascending, or without volume (below 1e-12 of its longest edge cubed),
 *   - neighbours that do not agree on their common face,
 *   - neighbours in different ones of the parts that are kept apart,
 *   - two vertices of one part at the same place (within 1e-9 of the mesh's size): such a mesh is open where
 *     it looks closed,
 *   - a hanging node: a vertex on a surface face of the same part (within 1e-6 of its longest edge) that is
 *     none of its corners.
 * A mesh whose parts are not kept apart is one part.
 * Orientation is free: corners are sorted, and volumes are taken without sign. */
void rg_mesh_check(const rg_mesh *mesh, const char *name);

/* The part of this that concerns elements by themselves: corners and volume. Needs no connection. */
void rg_mesh_check_elements(const rg_mesh *mesh, const char *name);

/* The part that concerns the vertices of the surface: adds those at one place to `input_errors`, and if there
 * are none hanging nodes, each vertex once. Looks at `x`, `corner` and where `neighbour` is -1. */
void rg_mesh_check_surface(const rg_mesh *mesh, rg_input_errors *input_errors);

/* Whether an element can be computed on: its corners, at x[4][3] (m), are ascending, and it has a volume. If
 * not, what[RG_INPUT_ERROR_WORDS] says so of element `name`. */
bool rg_tet_sound(const double *x, const rg_gid corner[4], rg_gid name, char *what);

/* The longest edge of the element with corners x[4][3] (m). */
double rg_tet_longest_edge(const double *x);

/* The same of element e of a mesh. */
double rg_mesh_longest_edge(const rg_mesh *mesh, rg_gid e);

/* Parts that share no face: part[elements] numbers them by their first element. Returns how many there are.
 */
int32_t rg_mesh_parts(const rg_mesh *mesh, int32_t *part);

/* What is wrong where the mesh is open, and what to do about it. */
const char *rg_mesh_open_words(bool apart);

/* [vertices]: the first surface face of the same part, 4 * element + face, on which a vertex lies without
 * being its corner; -1 where there is none. The caller frees it with rg_free. */
rg_gid *rg_mesh_hanging(const rg_mesh *mesh);

#endif
