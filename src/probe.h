/* Probes: displacement, velocity and stress at points, every step, in history.csv. */
#ifndef RG_PROBE_H
#define RG_PROBE_H

#include "solver.h"

typedef struct rg_probes rg_probes;

/* Finds the elements that hold the probes (of several, the one with the lowest number) and, on rank 0,
 * creates dir/history.csv if there are any. From then on the solver's kicks record what they see there.
 * Collective. */
rg_probes *rg_probes_open(rg_solver *s, const char *dir);

/* Closes the record of a kick at `time` (s). Collective only when the buffer is full. */
void rg_probes_next(rg_probes *p, double time);

/* Writes what is buffered. Collective. */
void rg_probes_flush(rg_probes *p);

void rg_probes_close(rg_probes *p);

#endif
