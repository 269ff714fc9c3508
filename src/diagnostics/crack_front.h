/* Fronts of cracks: energy release rate and stress intensity, columns NAME_VALUE of history.csv.
 *
 * The energy release rate is that of Eshelby's tensor with inertia (Atkinson & Eshelby 1968; as a domain
 * integral Shih, Moran & Nakamura 1986), over the body of reference, all along the direction e of growth:
 *
 *   J L = int [P_ij u_i,e - (W + T) e_j] q,j dV + int rho (a_i u_i,e - v_i v_i,e) q dV
 *
 * P first Piola-Kirchhoff stress, W stored and T kinetic energy per volume, L the length of front under the
 * weight q: 1 within the inner radius, 0 beyond the outer one, linear in between; on an element linear
 * between its corners. So W is the element's own energy, u,e q one of its fields, on which the inertia acts
 * by its mass matrix, and nothing is integrated twice in different ways. Faces between elements add nothing:
 * they are closed up to the small jumps of the discretization, or free. Loads within the outer radius would
 * add to it; they are not taken into account. P is made of Cauchy's stress, which of the linear-elastic solid
 * is symmetric up to its strain only: so far J is right there.
 *
 * The opening behind the front tells K of each mode: of u = 4 K/E' sqrt(r/2 pi) on either side, K + c r is
 * fitted to it over all faces in the crack's plane between the radii, by area. */
#ifndef RG_CRACK_FRONT_H
#define RG_CRACK_FRONT_H

#include <stdio.h>

#include "diagnostics/crack_tip.h"
#include "solver/solver.h"

typedef struct rg_crack_fronts rg_crack_fronts;

/* Those of the case. Ends the run with a message where one is not in the body, or asks for what is not known
 * there. Collective; free with rg_crack_fronts_free. */
rg_crack_fronts *rg_crack_fronts_make(const rg_solver *s);

/* As in diagnostics/sensor.h. */
int rg_crack_fronts_columns(const rg_crack_fronts *r);
void rg_crack_fronts_header(const rg_crack_fronts *r, FILE *out);
bool rg_crack_fronts_want(const rg_crack_fronts *r, size_t tile);
void rg_crack_fronts_watch(rg_crack_fronts *r, const rg_solver *s, size_t tile, const rg_workspace *w);
void rg_crack_fronts_open(rg_crack_fronts *r, int capacity);
const double *rg_crack_fronts_collect(rg_crack_fronts *r);
void rg_crack_fronts_print(const rg_crack_fronts *r, FILE *out);

/* Closes a sample, once the tips have closed theirs: fronts that move with one are there in the next. Then
 * collective. */
void rg_crack_fronts_next(rg_crack_fronts *r, const rg_crack_tips *tips);

/* Registers where fronts are that move (solver/state.h). */
void rg_crack_fronts_register(rg_crack_fronts *r, rg_state *st);

void rg_crack_fronts_free(rg_crack_fronts *r);

#endif
