/* What is recorded every step, in history.csv: displacement, velocity, stress and strain at the probes;
 * position, velocity of rigid bodies, and the solid's force on them; force, moment and work of loads and
 * supports that have a name; sensors (diagnostics/sensor.h); tips of cracks (diagnostics/crack_tip.h) and
 * their fronts (diagnostics/crack_front.h). */
#ifndef RG_PROBE_H
#define RG_PROBE_H

#include <stdio.h>

#include "solver/solver.h"

typedef struct rg_probes rg_probes;

/* Finds the elements that hold the probes: of several, the one with the lowest number. Ends the run with a
 * message if a probe is in none, which of a mesh file nobody knew before. Collective. */
rg_probes *rg_probes_find(const rg_solver *s);

/* What sensors look at, a line each. */
void rg_probes_print(const rg_probes *p, FILE *out);

/* Registers what goes on (solver/state.h); after rg_probes_sync it is that of all rows so far. */
void rg_probes_register(rg_probes *p, rg_state *st);

/* Creates history.csv in the output directory, on rank 0 and if there is any of that. From then on the
 * solver's kicks record what they see there. */
void rg_probes_open(rg_probes *p, rg_solver *s);

/* The same, going on with history.csv behind its first `length` bytes. */
void rg_probes_reopen(rg_probes *p, rg_solver *s, int64_t length);

/* Writes what is buffered and brings it to the disk; the length of history.csv (rank 0; 0 elsewhere).
 * Collective. */
int64_t rg_probes_sync(rg_probes *p);

/* Closes the record of a kick at `time` (s). Collective only when the buffer is full, or fronts of cracks
 * move. */
void rg_probes_next(rg_probes *p, double time);

/* Writes what is buffered. Collective. */
void rg_probes_flush(rg_probes *p);

void rg_probes_close(rg_probes *p);

#endif
