/* fragments.csv, what the summary tells of fragments, and the warning of those that overlap. */
#ifndef RG_FRAGMENT_TABLE_H
#define RG_FRAGMENT_TABLE_H

#include "base/files.h"
#include "diagnostics/fragment.h"

enum { RG_MASS_BINS = 64 };

typedef struct {
    rg_csv *csv;                   /* NULL: output.fragments is none */
    int64_t count;                 /* fragments, when last counted; 0: never */
    double mass;                   /* of all (kg) */
    double heaviest;               /* mass of the heaviest one (kg) */
    int64_t bin[RG_MASS_BINS];     /* fragments of mass in (mass/2^(k+1), mass/2^k] */
    double bin_mass[RG_MASS_BINS]; /* and their mass (kg) */
    double overlap_time;           /* when fragments were first found to overlap (s); infinite: never */
    rg_gid overlap[2];             /* their ids */
} rg_fragment_table;

/* Where a table stands. */
typedef struct {
    int64_t bytes; /* its length, on rank 0 */
    double overlap_time;
    rg_gid overlap[2];
} rg_fragment_mark;

/* Collective. Close with rg_fragment_table_close. */
rg_fragment_table *rg_fragment_table_open(const rg_solver *s);

/* The same, going on where a table stood at a checkpoint. */
rg_fragment_table *rg_fragment_table_reopen(const rg_solver *s, const rg_fragment_mark *mark);

/* Brings the table to the disk. */
rg_fragment_mark rg_fragment_table_sync(rg_fragment_table *t);

/* Whether the table wants the fragments of this output; `last`: the run ends with it. */
bool rg_fragment_table_due(const rg_fragment_table *t, const rg_solver *s, bool last);

/* Adds the fragments of the current state, between its kick and its drift. The counts above are those of the
 * last call, on rank 0. Collective. */
void rg_fragment_table_take(rg_fragment_table *t, const rg_solver *s, const rg_fragment_parts *p);

/* Whether overlaps are still to be looked for, at every output, with or without a table: not once one has
 * been told. */
bool rg_fragment_table_looks(const rg_fragment_table *t);

/* Looks for them in the current state, and warns. Collective. */
void rg_fragment_table_look(rg_fragment_table *t, const rg_solver *s, const rg_fragment_parts *p);

/* Writes members of a JSON object, each with a comma behind it. Rank 0. */
void rg_fragment_table_summary(const rg_fragment_table *t, FILE *out);

void rg_fragment_table_close(rg_fragment_table *t);

#endif
