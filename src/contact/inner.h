/* What contact between fragments consists of, for the files of this room alone: the search makes it
 * (contact.c), steps go through it (meeting.c). */
#ifndef RG_CONTACT_INNER_H
#define RG_CONTACT_INNER_H

#include "contact/contact.h"

/* A face travels as its u^ and by how much it has sunk; with damping also as its v^. */
enum { RG_CONTACT_ROW = 9, RG_CONTACT_BOX = 6, RG_CONTACT_HALO_TAG = 11 };

#define RG_CONTACT_NO_INTERFACE SIZE_MAX

/* A face of this rank. */
typedef struct {
    rg_lid slot;
    int8_t face;
    int8_t turned;    /* its corners, ascending, run the other way round */
    size_t interface; /* of the values that it has as an interface's side: of `sunk`; or
                         RG_CONTACT_NO_INTERFACE */
    size_t touch;     /* its first touch */
} rg_contact_side;

/* A pair as one of its faces sees it. */
typedef struct {
    size_t pair;
    int side;
} rg_contact_touch;

/* Friction of a pair of materials. */
typedef struct {
    int material[2];
    double friction[2];
} rg_contact_special;

struct rg_contacts {
    const rg_domain *domain;
    const rg_material *material;
    MPI_Comm comm;
    int rank;
    double penalty, omega2;
    double push[RG_FACES][RG_NODES][RG_FCORNERS]; /* M^-1 Q' of an element of unit mass */
    double eigenvalue; /* largest of M^-1 K on unit mass and stiffness of one face */

    size_t faces, far, pairs; /* of this rank, of others, with a part of this rank */
    bool any;
    size_t *tile_begin;  /* faces of tile t: from tile_begin[t] on */
    double *tile_omega2; /* [tiles]: of what touches now (1/s^2) */
    int64_t *tile_touching;
    rg_contact_side *face;
    double *rest, *corner, *last; /* [faces, then far][9]: undeformed, now; [faces][9] at the last search */
    double *box;                  /* [faces, then far][6]: now */
    rg_gid *id;                   /* [faces, then far] */
    int32_t *of_material;         /* likewise */
    rg_real *row;                 /* [faces, then far][values] */
    double *sunk;                 /* [faces, then far]: as it came (m) */
    double *moved;                /* [faces]: since the search, and in the last step, over what they may */
    double *stepped;
    double fat;
    rg_halo *halo;
    rg_contact_pair *pair;
    rg_contact_touch *touch;
    double *force, *energy, *depth; /* of the pairs */
    size_t values;                  /* of a row */
    double damping;                 /* s/m; 0: none, and no memory for it */
    double *rate;                   /* [faces, then far][9]: velocities (m/s) */
    double *drag, *stiffer;         /* of the pairs (kernels.h), */
    double *power;                  /* and that of drag on both faces, as fast as before the kick (W) */
    double *dragged;                /* [faces][9]: drag on a face (N), */
    double *shift;                  /* [faces]: and what its partner bears of its power (W) */
    bool rubs;
    double friction[2]; /* Coulomb's coefficient until a pair slides, while it does */
    int specials;
    rg_contact_special *special; /* of pairs of materials; the last one counts */
    double *grip, *heat;         /* of the pairs: what friction remembers, and took; NULL without it */
    rg_grips kept;               /* from before the search */
};

#define RG_CONTACT_TURN 0.1 /* of the unit normals, that a face may turn by between two searches */

/* Corner i of a face, out of its ascending ones. */
static inline int rg_contact_corner(const rg_contact_side *f, int i) {
    return f->turned && i > 0 ? 3 - i : i;
}

/* Q: what the six nodes of a face have a part in its corners by the projection
 *     int l_i (u^ - u) = 0,  u^ = sum l_i u^_i,  i = 1 to 3. */
double rg_contact_projection(int corner, int node);

/* u^ of face i of this rank, of a field u, to row[9]; its corners and box from its row. */
void rg_contact_set_row(const rg_contacts *c, size_t i, const rg_real *u, rg_real *row);
void rg_contact_set_corners(const rg_contacts *c, size_t i);

/* What face k of an element adds to its squared frequency, over kappa: both sides of a pair bear its
 * stiffness, and each face by half of the jump's square at most, so twice. */
double rg_contact_omega2_of(const rg_contacts *c, size_t slot, int k);

#endif
