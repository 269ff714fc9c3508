/* The crack surface: the faces with a point that switched, as triangles on the deformed mid-surface. */
#ifndef RG_CRACK_SURFACE_H
#define RG_CRACK_SURFACE_H

#include "solver/solver.h"

typedef struct {
    double x[3][3]; /* corners, deformed mid-surface (m) */
    double opening; /* mean normal component of the jump (m), positive when apart */
    double slip;    /* size of its mean tangential component (m) */
    double damage;  /* mean of min(1, delta_max/delta_c) over the face */
    double time;    /* at which its first point switched (s) */
} rg_crack_face;

/* The cracked faces that this rank speaks for; returns their number. The caller frees *faces with rg_free. */
size_t rg_crack_surface(const rg_solver *s, rg_crack_face **faces);

/* Damage of point q of interface i. */
double rg_damage(const rg_solver *s, size_t i, int q);

#endif
