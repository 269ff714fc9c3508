/* Fragments: connected components of elements over faces that still hold, that is, have a point with damage
 * below 1. They follow from the state alone, not from ranks and threads. */
#ifndef RG_FRAGMENT_H
#define RG_FRAGMENT_H

#include "solver/solver.h"

/* How a fragment is known on every rank that has a part of it. */
typedef struct {
    rg_gid id;        /* smallest global element number in it */
    double anchor[3]; /* where the centroid of that element's corners is now (m) */
} rg_fragment_label;

/* The fragments that have elements on this rank. */
typedef struct {
    size_t count;
    rg_fragment_label *label; /* [count], by ascending id */
    uint8_t *shared;          /* [count]: 1 where it goes on on other ranks */
    rg_lid *of;               /* [slots]: fragment of an element; -1 in padding */
    size_t *start;            /* [count + 1]: where the members of each fragment begin */
    rg_lid *member;           /* [elements]: slots, by fragment and slot */
} rg_fragment_parts;

/* Finds the fragments of the current state: union-find on each rank, then labels across the faces between
 * ranks until none changes. Collective; free with rg_fragment_parts_free. */
rg_fragment_parts *rg_fragments_find(const rg_solver *s);
void rg_fragment_parts_free(rg_fragment_parts *p);

/* Current corners of an element (m). */
void rg_current_corners(const rg_solver *s, size_t slot, double x[4][3]);

/* A whole fragment. Integrals are those of the scheme: mass matrix, nodal positions and velocities of the
 * current state. */
typedef struct {
    rg_gid id;
    int64_t elements;
    double mass;        /* kg */
    double volume;      /* in the reference state (m^3) */
    double centroid[3]; /* current centre of mass (m) */
    double momentum[3]; /* kg m/s */
    double kinetic;     /* all of its kinetic energy (J) */
    double rotational;  /* of its rotation as a rigid body about the centroid, L . I^-1 L/2 (J) */
    double inertia[3];  /* principal moments about the centroid, smallest first (kg m^2) */
    double axis[3][3];  /* their unit axes; the largest component of each is positive */
    double touches;     /* of contact between fragments, since the start: by its present elements, how many
                           times each began to touch something, */
    double impulse;     /* and what they felt, summed by size over steps and pairs (N s) */
    double size[3];     /* sides of the homogeneous box of the same mass and inertia, along the axes (m) */
} rg_fragment;

/* All fragments: each on one rank, those of rank 0 first, by ascending id; *rows is the caller's, to free
 * with rg_free. All values are exact sums: the same bits on any ranks and threads. Returns the number of rows
 * here. Collective. */
size_t rg_fragments_measure(const rg_solver *s, const rg_fragment_parts *p, rg_fragment **rows);

#endif
