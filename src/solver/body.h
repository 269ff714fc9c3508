/* Rigid bodies that touch the solid's surface: spheres, planes (half-spaces) and cylinders without ends; and
 * those that only hold what is tied to them (solver/tie.h). They move freely or as prescribed, and turn where
 * they have an inertia or an angular velocity is prescribed.
 *
 * Contact is a penalty on penetration, with one potential: the integral over the outer faces of
 *     (kappa/2) <g>^2,    kappa = penalty (lambda + 2 mu)/h,
 * g the depth of a point below the body's surface, h the height of the element over the face: the stiffness
 * with which interfaces hold together (solver/surface.h: the integral). With contact between fragments
 * (contact/contact.h) faces that are exposed in the run have it too, each from when it has been outside all
 * bodies: so nothing jumps. What they add to the frequency counts from when they are pressed.
 *
 * Every rank knows all bodies and moves them alike: the force on a body is an exact sum over faces
 * (base/exact_sum.h), sent for under the tile-boundary faces and needed when the step ends. Bodies kick and
 * drift like the solid: what they gain in momentum, it loses. So with angular momentum: a kick adds the
 * moment of the forces about the centre of mass, at the places of that step, to the angular momentum about it
 * in space, and a drift turns the body without touching that (solver/attitude.h). Both momenta of body and
 * solid together stay to rounding. */
#ifndef RG_BODY_H
#define RG_BODY_H

#include <mpi.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/exact_sum.h"
#include "case/case.h"
#include "domain/domain.h"
#include "kernels.h"
#include "solver/attitude.h"
#include "solver/state.h"
#include "solver/surface.h"

enum { RG_BODY_FORCE, RG_BODY_MOMENT = 3, RG_BODY_BORN = 6, RG_BODY_SUMS };

/* A body as it was seen at a present time, between kick and drift. */
typedef struct {
    double x[3], v[3], force[3]; /* m, m/s; force of the solid on it (N) */
    double work;                 /* done on a prescribed body by what moves it, since the start (J) */
} rg_body_seen;

/* The turn of a body, likewise: at the state that the forces belong to, in the middle of the step, and as it
 * was seen. About the centre of mass. Doubles only: a checkpoint takes them as a row. */
typedef struct {
    double direction[3];     /* unit normal of a plane, unit axis of a cylinder, at present */
    double rotation[4];      /* since the start (solver/attitude.h) */
    double step[4];          /* on top of it, of the step to come */
    double momentum[3];      /* of a free body (kg m^2/s) */
    double spin[3];          /* of a prescribed one (rad/s) */
    double seen_rotation[4]; /* at the last kick */
    double seen_momentum[3], seen_spin[3];
    double moment[3]; /* of the solid's forces on it, then (N m) */
} rg_body_turn;

/* Momentum of nodes, angular momentum about the centre of their body, kinetic energy. */
typedef struct {
    double momentum[3], angular[3], energy;
} rg_body_motion;

/* What the nodes that are tied to a body add to its mass, along its own axes at the start, and the momentum
 * and angular momentum about its centre that they would have without the body after a kick. */
typedef struct {
    bool any, joins;                     /* now, and from this kick on */
    double mass, first[3], second[3][3]; /* kg, kg m, kg m^2 */
    double momentum[3], angular[3];
    rg_body_motion before; /* of a kick from which on they are tied: as they moved at its time */
    double joined, taken;  /* 1 once such a kick has been; the kinetic energy that went in it (J) */
} rg_body_tied;

typedef struct {
    const rg_body_input *input;
    double mass; /* kg; infinite where the motion is prescribed */
    bool turns;
    rg_inertia inertia;
    rg_body_tied tied;
    rg_body_turn turn;
    /* From here to the end doubles only: a checkpoint takes them as a row. */
    double x[3];       /* position of input->at, in the state that the forces belong to (m) */
    double v[3];       /* in the middle of the last step, after a kick of the next one (m/s) */
    double work;       /* as in `seen`, up to the middle of the next step (J) */
    rg_body_seen seen; /* at the last kick */
} rg_body;

/* A prescribed velocity that is not finite, and when (s); `input` NULL: none was. */
typedef struct {
    const rg_body_input *input;
    const rg_expr *value;
    const char *what; /* "velocity", "spin" */
    int component;
    double time;
} rg_body_lapse;

/* A face that may touch a body. */
typedef struct {
    rg_lid slot;
    int8_t face;
    int16_t body;
    int64_t born;     /* 2 * interface + side, of one exposed in the run; -1: of the surface */
    double stiffness; /* kappa times the area of the face (N/m) */
} rg_contact_face;

typedef struct {
    int count, threads;
    rg_body *body;
    MPI_Comm comm;
    rg_surface surface;
    size_t *tile_begin; /* faces of tile t: from tile_begin[t] on */
    rg_contact_face *face;
    bool **touching;   /* [count]: groups of faces that may touch a body; NULL: all, and those exposed */
    double eigenvalue; /* of an element of unit mass with unit stiffness on one face */
    double omega2; /* what contact of the surface adds to the largest squared frequency, at most (1/s^2) */
    double *tile_omega2; /* [tiles]: what that of exposed faces adds now, on elements */
    double born_omega2;  /* and on bodies */
    rg_exact_sum *sum;   /* [threads][count][RG_BODY_SUMS] force and moment on each body (N, N m), and what
                            exposed faces add to its squared frequency (1/s^2) */
    rg_exact_sum *total; /* [count][RG_BODY_SUMS] */
    double (*noted)[6];  /* [count]: force and moment on each (rg_bodies_note) */
    MPI_Request request;
    rg_body_lapse lapse; /* the first; on all ranks the same */
} rg_bodies;

/* The bodies of a case, with the faces of this rank that may touch them. Ends the run with a message if a set
 * is unknown, a velocity is not finite or a body overlaps the solid at the start. Keeps references to `c`,
 * `d` and `m`, the materials. Collective. Free with rg_bodies_free. */
rg_bodies *rg_bodies_make(const rg_case *c, const rg_domain *d, const rg_part *part, const rg_material *m,
                          int threads, MPI_Comm comm);

/* Lists the faces anew: with those of interfaces i with exposed[i] >= RG_EXPOSED (contact/contact.h). */
void rg_bodies_expose(rg_bodies *b, const uint8_t *exposed);

/* The velocities that the case gives body i at the start. */
void rg_bodies_begin(rg_bodies *b, int i);

/* Depth of point x below the surface of a body (m), negative outside; `normal` points out of the body. */
double rg_body_depth(const rg_body *b, const double x[3], double normal[3]);

/* Forces of the bodies on the faces of a tile at displacement u: kicks the velocities and keeps account of
 * the forces for the bodies' own. Bit k of clear[i]: side k of interface i, once exposed, has been outside
 * all bodies. Threads call it for different tiles. */
void rg_bodies_touch(rg_bodies *b, size_t tile, const rg_real *u, const rg_push *push, uint8_t *clear);

/* Notes the force and the moment about its centre on each body since the last sum, which move none: for a
 * search for an equilibrium. Collective. */
void rg_bodies_note(rg_bodies *b);

/* Where a body is. */
typedef struct {
    double x[3], rotation[4], direction[3];
} rg_body_place;

/* Places of all bodies, and from them the share of a motion [count][6], velocity and spin, of those that are
 * free and carry something: for a search for an equilibrium. */
void rg_bodies_places(const rg_bodies *b, rg_body_place *out);
void rg_bodies_shift(rg_bodies *b, const rg_body_place *from, const double (*motion)[6], double share);

/* Velocity and spin of what is tied to a body, by an impulse and its moment about the body's centre, as if it
 * had no mass of its own. */
void rg_body_carried_motion(const rg_body *b, const double impulse[6], double motion[6]);

/* The angular momentum of the start, where bodies have been turned since. */
void rg_bodies_settle(rg_bodies *b);

/* Norm, in that of M^-1, of what is noted on the free bodies that nothing holds, and the one with most of it.
 */
double rg_bodies_unheld(const rg_bodies *b, const rg_body **which);

/* Adds the contact energy of a tile's faces at displacement u (J) to `energy`. */
void rg_bodies_energy(const rg_bodies *b, size_t tile, const rg_real *u, const uint8_t *clear,
                      rg_exact_sum *energy);

/* What contact of exposed faces adds to the squared frequency of elements of this rank, when the forces were
 * last computed. */
double rg_bodies_omega2_now(const rg_bodies *b);

/* Starts the sum of the forces over threads and ranks. One thread, once all tiles are touched. Collective. */
void rg_bodies_sum(rg_bodies *b);

/* Waits for the forces and kicks the bodies: their velocities go on by `dt` to the middle of the next step,
 * dt_next long; `seen` is their state at `time`, half of dt_last after the middle of the last step.
 * Collective. */
void rg_bodies_kick(rg_bodies *b, double time, double dt_last, double dt_next);

/* Whether a prescribed velocity was not finite so far; then words[size] says which and when first. Such a
 * body touches nothing any more. */
bool rg_bodies_told(const rg_bodies *b, char *words, size_t size);

/* Moves the bodies on by a step. */
void rg_bodies_drift(rg_bodies *b, double dt);

/* Work done on prescribed bodies and kinetic energy of the free ones (J), also that of `longer` times the
 * change of their velocities in the last half kick, and their momentum and angular momentum about the origin,
 * as last seen. */
typedef struct {
    double work, kinetic, half_kick, momentum[3], angular_momentum[3];
} rg_bodies_account;

rg_bodies_account rg_bodies_take(const rg_bodies *b, double longer);

/* A place in the body, from its centre at the start, as seen from there at present (m); and what it moves by
 * in the step to come. */
void rg_body_arm(const rg_body *b, const double at_start[3], double arm[3]);
void rg_body_sweep(const rg_body *b, const double arm[3], double moved[3]);

/* Square of the largest lever of forces that press a face, about its body's centre at present (m^2). */
double rg_body_lever2(const rg_bodies *b, const rg_contact_face *f);

/* Registers what moves (solver/state.h). */
void rg_bodies_register(rg_bodies *b, rg_state *st);

void rg_bodies_free(rg_bodies *b);

#endif
