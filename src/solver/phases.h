/* Where the time of a step goes, on the master thread of each rank: a reading of the clock between the parts
 * of a step, some ten in all and always on. And what each rank sends. */
#ifndef RG_PHASES_H
#define RG_PHASES_H

#include <mpi.h>
#include <stdio.h>

#include "domain/halo.h"

typedef enum {
    RG_PHASE_COMPUTE,  /* element sweep: elements, interfaces inside the tiles, their kick */
    RG_PHASE_JUMP,     /* boundary sweep: tile-boundary faces, their kick, drift */
    RG_PHASE_PACK,     /* rows for other ranks into their messages */
    RG_PHASE_EXCHANGE, /* messages started: with shared memory also their way into it */
    RG_PHASE_WAIT,     /* for messages, and for ranks that are later */
    RG_PHASE_REDUCE,   /* the largest stiffening */
    RG_PHASES
} rg_phase;

typedef struct {
    double seconds[RG_PHASES];
    double last;
} rg_phases;

static inline void rg_phases_begin(rg_phases *p) {
    p->last = MPI_Wtime();
}

/* Counts the time since the last mark, or the beginning, to `phase`. */
static inline void rg_phases_mark(rg_phases *p, rg_phase phase) {
    double now = MPI_Wtime();
    p->seconds[phase] += now - p->last;
    p->last = now;
}

/* The least, mean and largest of all ranks. */
typedef struct {
    double least, mean, most;
} rg_spread;

typedef struct {
    rg_spread phase[RG_PHASES]; /* s */
    rg_spread neighbours;       /* of a rank */
    rg_spread inner;            /* share of a rank's tiles under whose work messages travel */
    rg_spread messages;         /* that a rank sends in a step */
    rg_spread bytes;            /* that a rank sends in a step */
    rg_spread message_bytes;    /* mean of a rank's messages */
} rg_phases_report;

/* Collective: of a domain and the exchanges of its step. */
rg_phases_report rg_phases_gather(const rg_phases *p, const rg_domain *d, rg_halo *const halo[], int halos,
                                  MPI_Comm comm);

/* Members of a JSON object, one a line, each [least, mean, most]. */
void rg_phases_write(const rg_phases_report *r, FILE *out);

#endif
