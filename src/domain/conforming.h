/* Shared-node faces: the faces across which elements share their nodes, in form `continuous`. There the
 * displacement is continuous, and no interface is needed.
 *
 * Elements go on to own their nodes. Those of one place in the mesh are copies of one node where a path over
 * shared-node faces leads from one element to the other; domain/assembly.h keeps them alike. So which copies
 * are one follows from the faces alone: no node numbers, no coordinates. Elements that touch at an edge or a
 * vertex alone hang together no more than in the other forms, and the nodes at the edge of a surface of
 * interfaces, around which shared-node faces lead, are whole. */
#ifndef RG_CONFORMING_H
#define RG_CONFORMING_H

#include "domain/domain.h"

/* Between two elements of this rank. */
typedef struct {
    rg_lid slot[2];
    int8_t face[2];
} rg_conforming_face;

/* Between an element of this rank and one of another. */
typedef struct {
    int32_t rank; /* the other */
    rg_gid key;   /* the same on both: 4 * lower element number + its local face */
    rg_lid slot;
    int8_t face;
} rg_far_conforming_face;

typedef struct {
    size_t count, fars;
    rg_conforming_face *conforming_face;
    rg_far_conforming_face *far; /* by rank and key: both sides list them in the same order */
    int *far_rank;               /* [fars] */
} rg_conforming_faces;

/* Bits of the faces of each element of a part that are shared-node faces: in form `continuous` all faces
 * inside that interface.faces does not select, whose expression both sides evaluate at the same numbers. NULL
 * in other forms. Ends the run with a message (RG_USAGE) where the expression is not finite. Collective; free
 * with rg_free. */
uint8_t *rg_joined_faces(const rg_case *c, const rg_part *part, MPI_Comm comm);

/* The shared-node faces of a domain made with these bits, from its part. Free with rg_conforming_faces_free.
 */
rg_conforming_faces *rg_conforming_faces_make(const rg_domain *d, const rg_part *part, const uint8_t *joined,
                                              int rank);

void rg_conforming_faces_free(rg_conforming_faces *j);

#endif
