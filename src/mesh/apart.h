/* Parts that are kept apart although they touch: what does not hang together by nodes. Each is checked by
 * itself; between them contact acts. */
#ifndef RG_MESH_APART_H
#define RG_MESH_APART_H

#include "mesh/mesh.h"

/* How two parts touch. */
typedef struct {
    int32_t part[2];  /* the lower one first */
    int64_t faces[2]; /* of each that touch the other */
    double area;      /* on which they do (m2) */
    double place[3];  /* the middle of it (m) */
    double gap[2];    /* the least and the largest between the faces (m) */
} rg_touch;

/* Gives mesh->part: parts that share no node, numbered by their first element. Leaves it NULL where there is
 * only one. Returns how many there are. */
int32_t rg_mesh_keep_apart(rg_mesh *mesh);

/* How many parts are kept apart; 0: none are. */
int32_t rg_mesh_apart(const rg_mesh *mesh);

/* Part of each vertex, [vertices], which the caller frees; NULL: the mesh has no parts that are kept apart.
 */
int32_t *rg_mesh_vertex_parts(const rg_mesh *mesh);

/* The pairs of parts that touch, in their order: faces that face each other, within 1e-3 of the shorter of
 * their longest edges. The caller frees them. */
rg_touch *rg_mesh_touches(const rg_mesh *mesh, size_t *count);

/* Ends the run (RG_USAGE), with messages that begin with `name`, if elements of different parts lie in each
 * other deeper than 1e-3 of the shorter of their longest edges: those of each pair of parts that do so most
 * deeply. */
void rg_mesh_check_overlaps(const rg_mesh *mesh, const char *name);

#endif
