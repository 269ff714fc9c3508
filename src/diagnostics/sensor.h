/* Sensors of a case: means, extremes and integrals over a part of the body, columns of history.csv.
 *
 * Integrals are over the volume or area of reference: of displacement and velocity exact for the shape
 * functions, of stress by the element's four points, on faces by its values at the middles of the edges.
 * Extremes are those of the nodes, of stress those of these points. Sums are exact (base/exact_sum.h): the
 * same bits on any ranks and threads. */
#ifndef RG_SENSOR_H
#define RG_SENSOR_H

#include <stdio.h>

#include "solver/solver.h"

typedef struct rg_sensors rg_sensors;

/* Those of the case. Ends the run with a message where a part has no element or face. Collective; free with
 * rg_sensors_free. */
rg_sensors *rg_sensors_make(const rg_solver *s);

/* Columns of all, and their names, each behind a comma. */
int rg_sensors_columns(const rg_sensors *r);
void rg_sensors_header(const rg_sensors *r, FILE *out);

/* Whether they look at a tile; then, in its kick, what they see there. Threads call it at once. */
bool rg_sensors_want(const rg_sensors *r, size_t tile);
void rg_sensors_watch(rg_sensors *r, const rg_solver *s, size_t tile, const rg_workspace *w);

/* Room for so many samples. */
void rg_sensors_open(rg_sensors *r, int capacity);

/* Closes a sample. One thread. */
void rg_sensors_next(rg_sensors *r);

/* The samples since the last call, [samples][columns], on all ranks. Collective. */
const double *rg_sensors_collect(rg_sensors *r);

/* A line for each. */
void rg_sensors_print(const rg_sensors *r, FILE *out);

void rg_sensors_free(rg_sensors *r);

#endif
