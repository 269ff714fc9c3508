/* Checkpoints: the whole state of a run in one file that knows nothing of ranks and threads.
 *
 * A checkpoint is dir/step-NNNNNNNNNNNN.h5: the checksum (restart/checksum.h), then HDF5:
 *
 *   attributes       program, revision, format, precision, instruction_set, elements, mesh (its hash)
 *   case             the values of the case that a restart may not change, one a line, as bytes [n][1]
 *   run/NAME         [rows][count]: what concerns the run as a whole
 *   element/NAME     [elements][count], by global element number
 *   face/key         [n][1], sorted: 4 * global element number + local face; face/NAME [n][count]: the
 *                    interfaces that have broken points (a tile-boundary face's two copies are two of them)
 *   face/rows        [elements][1]: how many of them each element has
 *   NAME/key, NAME/NAME, NAME/rows   the same of the list NAME
 *
 * It is written under another name, read back piece by piece, given its checksum, brought to the disk, and
 * only then gets its name: what has the name is good, until somebody damages it, and then that is noticed. */
#ifndef RG_CHECKPOINT_H
#define RG_CHECKPOINT_H

#include "domain/slab.h"
#include "solver/solver.h"
#include "solver/state.h"

typedef struct {
    rg_solver *solver;
    const rg_state *state;
    char *folder;     /* where the checkpoints are */
    rg_slab **shared; /* made with the first one, if there is none yet */
    rg_slab *slab;    /* NULL until the first checkpoint */
    char *window;     /* of the state of elements in global order, on its way to the disk or back */
    size_t window_bytes;
    uint64_t mesh; /* hash of the mesh */
    int written;
    double *seconds;       /* [written]: wall time of each, from the call to the removal of an older one */
    double total, slowest; /* sum of them, and the largest */
} rg_checkpoints;

/* The checkpoints of a run in `dir`/checkpoints, which is created when the first is written. Keeps
 * references, also to `slab` (rg_slab_shared); rg_checkpoints_close frees what it holds. */
void rg_checkpoints_open(rg_checkpoints *k, const char *dir, rg_solver *s, const rg_state *state,
                         rg_slab **slab);

/* Writes the state between two steps and removes all but the last `keep` checkpoints. Ends the run with a
 * message where that fails, and leaves the earlier checkpoints. Collective. */
void rg_checkpoint_write(rg_checkpoints *k, int keep);

/* Fills the state with that of the newest good checkpoint; tells of damaged ones that it passes by. Ends the
 * run (RG_USAGE) with a message if there is none, or if it is of another case, mesh, precision or version.
 * Collective. */
void rg_checkpoint_load(rg_checkpoints *k);

/* Median of their wall times; 0 without any. */
double rg_checkpoints_median(const rg_checkpoints *k);

void rg_checkpoints_close(rg_checkpoints *k);

/* Whether dir/checkpoints has any. Not collective. */
bool rg_checkpoints_exist(const char *dir);

/* Removes the checkpoints of an earlier run and what a killed one left half-written (`all` false: only that).
 * Rank 0. */
void rg_checkpoints_remove(const char *dir, bool all);

#endif
