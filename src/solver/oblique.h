/* Prescribed motions of elements whose nodes are held along lines that are not axes of coordinates, or by
 * entries that take turns.
 *
 * All that is prescribed to an element are rows i: velocity t_i of node n_i along the unit vector d_i. With
 * M the mass matrix and G_ij = (d_i . d_j) (M^-1)_{n_i n_j}, the impulses G^-1 (t - d . v) along the d_i
 * bring it there. Of rows that act on a node at the same time those that earlier ones imply are left out;
 * later entries of the case come first. Where elements share nodes, the mass is lumped and a face's normal
 * is, at a node, the mean over the faces around it, so that all copies of the node get the same bits. */
#ifndef RG_OBLIQUE_H
#define RG_OBLIQUE_H

#include "base/exact_sum.h"
#include "domain/assembly.h"
#include "solver/constraint.h"
#include "solver/state.h"
#include "solver/supports.h"

typedef struct rg_oblique rg_oblique;

/* Keeps a reference to `s`. Collective; free with rg_oblique_free. */
rg_oblique *rg_oblique_make(rg_supports *s, const rg_material *m, rg_assembly *nodes, MPI_Comm comm);

/* Whether an element is one of these. */
bool rg_oblique_has(const rg_oblique *o, size_t slot);

/* As those of solver/constraint.h; `start` returns how many places are prescribed off the initial ones. */
int64_t rg_oblique_start(rg_oblique *o, const rg_real *u, const rg_real *velocity);
void rg_oblique_set(rg_oblique *o, double time, double dt);
void rg_oblique_kick(rg_oblique *o, size_t tile, const rg_real *u, rg_real *velocity, rg_real *now);
void rg_oblique_drift(rg_oblique *o, size_t tile, rg_real *u);
void rg_oblique_work(const rg_oblique *o, rg_exact_sum *work);
void rg_oblique_place(rg_oblique *o, rg_real *u);
void rg_oblique_show(const rg_oblique *o, rg_held_line *show, void *to);
void rg_oblique_mark(const rg_oblique *o, uint8_t *slots);
void rg_oblique_hold(const rg_oblique *o, size_t tile, rg_real *field);
void rg_oblique_register(rg_oblique *o, rg_state *st);

void rg_oblique_free(rg_oblique *o);

#endif
