/* A mesh of tetrahedra that can be changed: what rg_mesh_improve works on. Tetrahedra come and go, vertices
 * only move. Inside this module all corners are right-handed (positive rg_tet_volume). */
#ifndef RG_IMPROVE_TETS_H
#define RG_IMPROVE_TETS_H

#include <stdbool.h>
#include <stddef.h>

#include "mesh/mesh.h"

/* Labels of faces: 0 inside, RG_KEPT on a face inside that must stay where it is (between two volume sets, or
 * a triangle of the input), -group - 1 where it is in sets besides, RG_SURFACE + group + 1 on the surface. */
enum { RG_KEPT = 1, RG_SURFACE = 2 };

typedef struct {
    rg_gid corner[4]; /* right-handed; corner[0] is -1 once the tetrahedron is gone */
    rg_gid original;
    double height;    /* smallest (m) */
    int32_t label[4]; /* of the face opposite each corner */
    int32_t region;
} rg_tet;

/* The tetrahedra around a vertex. */
typedef struct {
    int count;
    size_t room;
    rg_gid *tet;
} rg_star;

typedef struct {
    rg_mesh *mesh; /* vertices are its own and move in place */
    rg_gid count;
    size_t room;
    rg_tet *tet;   /* [count], gone ones among them */
    rg_star *star; /* [vertices] */
    bool *on_line; /* [vertices]: whether a named edge ends there; NULL: there are none */
} rg_tets;

/* A face by its vertices, ascending. */
typedef struct {
    rg_gid vertex[3];
    int32_t label;
} rg_labelled_face;

/* Takes a connected mesh apart; `mesh` must stay. rg_tets_finish frees. */
rg_tets rg_tets_make(rg_mesh *mesh);

/* Puts the tetrahedra back into the mesh, neither sorted nor connected. */
void rg_tets_finish(rg_tets *t);

static inline const double *rg_tets_at(const rg_tets *t, rg_gid vertex) {
    return t->mesh->x + 3 * vertex;
}

/* Whether the edge is a named one. */
bool rg_tets_is_line(const rg_tets *t, rg_gid a, rg_gid b);

/* Smallest height (m) of the tetrahedron with these corners; negative if it is left-handed. */
double rg_tets_height(const rg_tets *t, const rg_gid corner[4]);

/* Smallest height among the tetrahedra around a vertex (m). */
double rg_tets_star_height(const rg_tets *t, rg_gid vertex);

/* Sets the heights around a vertex anew, which has moved. */
void rg_tets_update(rg_tets *t, rg_gid vertex);

/* Position of a vertex among the corners, -1 if it is none. */
int rg_tets_find(const rg_tet *tet, rg_gid vertex);

/* The tetrahedra that have both vertices, `most` at most; returns how many there are. */
int rg_tets_around(const rg_tets *t, rg_gid a, rg_gid b, int most, rg_gid *tet);

/* Replaces tetrahedra `old` by others that fill the same space, corners right-handed. Faces keep their
 * labels; those in `more` are new ones with labels. */
void rg_tets_replace(rg_tets *t, int olds, const rg_gid *old, int news, const rg_gid (*corner)[4], int mores,
                     const rg_labelled_face *more);

rg_labelled_face rg_labelled_face_of(rg_gid a, rg_gid b, rg_gid c, int32_t label);

#endif
