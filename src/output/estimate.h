/* What is known of a run before it starts: counts, size of the body, wave speeds, time step, memory, time,
 * resolution of the cohesive zone. */
#ifndef RG_ESTIMATE_H
#define RG_ESTIMATE_H

#include <stdio.h>

#include "solver/solver.h"

typedef struct {
    int64_t elements, interfaces, dofs;
    int64_t *of_material;   /* [materials] elements; the caller frees it */
    double dt_critical, dt; /* 2/omega, and times safety (s) */
    int64_t steps;
    double bytes_per_element, peak_bytes_per_element; /* fields; and with output and cracks everywhere */
    double frames, frame_bytes; /* of field output; on disk, without compression and cracks */
    int64_t written;            /* elements that have it: output.region */
    double seconds;             /* estimate for the time loop on these ranks and threads */
    double cohesive_zone; /* length at the face that resolves it worst (m); infinite where none breaks */
    double zone_edge;     /* longest edge of that face (m) */
} rg_estimate;

/* Collective; needs rg_spectrum to have run. */
rg_estimate rg_estimate_run(const rg_solver *s);

/* Warns of materials without elements (rank 0 only): once a run, which may repartition the mesh. */
void rg_estimate_warn(const rg_case *c, const rg_estimate *e);

/* Prints it for a person, with a warning where numbers look as if they were not in SI units (rank 0 only). */
void rg_estimate_print(const rg_solver *s, const rg_estimate *e, FILE *out);

#endif
