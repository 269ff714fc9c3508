/* Snapshots of the fields: what output.fields asks for, brought into global order and written. */
#ifndef RG_SNAPSHOT_H
#define RG_SNAPSHOT_H

#include "diagnostics/fragment.h"
#include "domain/slab.h"
#include "output/writer.h"
#include "solver/solver.h"

typedef struct {
    unsigned fields;
    rg_slab *slab;
    rg_writer *writer;
    size_t written;       /* elements of the slab that are written: those in output.region */
    size_t *row;          /* [written]: their rows of the slab, ascending; NULL where all are written */
    int64_t first, total; /* of those of all slabs: the first one here, and how many */
} rg_snapshots;

/* Opens the field file in the case's output directory; does nothing where no fields are asked for. Keeps a
 * reference to the slab (rg_slab_shared). Collective. */
rg_snapshots *rg_snapshots_open(const rg_solver *s, rg_slab **slab);

/* The same, going on with the files of an earlier run from `mark` (output/writer.h), which has frames. */
rg_snapshots *rg_snapshots_reopen(const rg_solver *s, rg_slab **slab, const rg_writer_mark *mark);

/* Brings what was written to the disk; where the files stand now. Collective. */
rg_writer_mark rg_snapshots_sync(rg_snapshots *w);

/* Bytes of a frame on disk for each element, as they are without compression and without cracks. */
double rg_snapshots_frame_bytes(const rg_case *c);

/* Elements of the whole mesh whose fields are written. Ends the run, as opening does, where output.region has
 * none. Collective. */
int64_t rg_snapshots_elements(const rg_solver *s);

/* Whether the fragments are one of the fields. */
bool rg_snapshots_show_fragments(const rg_snapshots *w);

/* Writes the current state, between its kick and its drift; `parts`: its fragments, NULL where they are not
 * shown. Collective. */
void rg_snapshots_write(rg_snapshots *w, rg_solver *s, const rg_fragment_parts *parts);

void rg_snapshots_close(rg_snapshots *w);

/* Memory (bytes) that snapshots of so many elements take at most on a rank, in round numbers. */
size_t rg_snapshots_bytes(const rg_case *c, size_t elements);

#endif
