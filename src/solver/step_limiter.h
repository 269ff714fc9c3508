/* The adaptive time step of a law with a steep ascent (H. D. Espinosa & P. D. Zavattieri 2003, thesis
 * 3.14-3.15): dt = min(dt_cont, dt_coh), dt_cont the step that all other things allow,
 *     dt_coh = dt_cont / max(xi N),   xi = |dx|/a  for x < a,  |dx|/(1 - a)  for a < x < 1
 * with dx what the opening x = delta/delta_c of a point would change by in a step dt_cont, and a its ascent:
 * so x goes from 0 to a in N steps at least. The predictor of dx holds the rate of the step before (the law
 * keeps it: rg_law_opening_rate): the step is known before the forces are, as it is for the stiffening. */
#ifndef RG_STEP_LIMITER_H
#define RG_STEP_LIMITER_H

#include "solver/solver.h"

/* Largest opening rate xi/dt_cont of the tile's points in the state just evaluated (1/s). */
double rg_tile_opening_rate(const rg_solver *s, const rg_tile *t);

/* Makes s->opening_rate the largest of all tiles and ranks. Collective; only where s->tile_opening_rate is.
 */
void rg_step_limiter_agree(rg_solver *s);

/* min(dt, dt_coh) of the current opening rate (s), dt_coh rounded down to dt times a power of 2^(-1/4), so
 * that steps seldom change: a leapfrog conserves energy at a constant one. */
double rg_limited_step(const rg_solver *s, double dt);

/* Whether the opening rate, rather than anything else, limits steps like the last one. */
bool rg_step_limiter_acts(const rg_solver *s);

#endif
