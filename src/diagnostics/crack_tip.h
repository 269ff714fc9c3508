/* Tips of cracks: how far along a direction faces have separated, columns NAME_tip and NAME_speed of
 * history.csv.
 *
 * The tip is the furthest point, at its place of reference, whose opening has been that of full separation.
 * It moves from point to point, so its speed is that over at least
 * a distance of the case: from where it was when the speed was last taken. */
#ifndef RG_CRACK_TIP_H
#define RG_CRACK_TIP_H

#include <stdio.h>

#include "solver/solver.h"

typedef struct rg_crack_tips rg_crack_tips;

/* Those of the case. Ends the run with a message where one looks at no face. Collective; free with
 * rg_crack_tips_free. */
rg_crack_tips *rg_crack_tips_make(const rg_solver *s);

/* As in diagnostics/sensor.h. `time`: of the samples. */
int rg_crack_tips_columns(const rg_crack_tips *r);
void rg_crack_tips_header(const rg_crack_tips *r, FILE *out);
bool rg_crack_tips_want(const rg_crack_tips *r, size_t tile);
void rg_crack_tips_watch(rg_crack_tips *r, const rg_solver *s, size_t tile);
void rg_crack_tips_open(rg_crack_tips *r, int capacity);
void rg_crack_tips_next(rg_crack_tips *r);
const double *rg_crack_tips_collect(rg_crack_tips *r, const double *time);
/* Tip k at the sample that was closed last, as far as this rank knows, along its unit vector (m); -DBL_MAX:
 * there is none. */
double rg_crack_tips_furthest(const rg_crack_tips *r, int k);
const double *rg_crack_tips_along(const rg_crack_tips *r, int k);

void rg_crack_tips_print(const rg_crack_tips *r, FILE *out);

/* Registers what goes on (solver/state.h): nothing may wait to be collected. */
void rg_crack_tips_register(rg_crack_tips *r, rg_state *st);

void rg_crack_tips_free(rg_crack_tips *r);

#endif
