/* Snapshots of the fields: what output.fields asks for, brought into global order and written. */
#ifndef RG_SNAPSHOT_H
#define RG_SNAPSHOT_H

#include "slab.h"
#include "solver.h"
#include "writer.h"

typedef struct {
    unsigned fields;
    rg_slab *slab;
    rg_writer *writer;
    double *record, *sorted; /* one field of the own elements, and of the slab */
} rg_snapshots;

/* Opens the field file in the case's output directory; does nothing where no fields are asked for.
 * Collective. */
rg_snapshots *rg_snapshots_open(const rg_solver *s);

/* Writes the current state, between its kick and its drift. Collective. */
void rg_snapshots_write(rg_snapshots *w, rg_solver *s);

void rg_snapshots_close(rg_snapshots *w);

#endif
