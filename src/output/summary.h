/* What a run leaves behind in one page: summary.json, and the same in words. */
#ifndef RG_SUMMARY_H
#define RG_SUMMARY_H

#include "diagnostics/ledger.h"
#include "output/estimate.h"
#include "output/fragment_table.h"
#include "solver/equilibrium.h"

typedef struct {
    rg_estimate estimate;
    int64_t first_step; /* that this program did: not 0 after a restart */
    int partitions;     /* of the mesh, in this program: 1, and one more each time it was repartitioned */
    double dt_first;    /* s */
    rg_equilibrium equilibrium;   /* of a static start, where this program found it; passes 0: none */
    double stress_out_of_balance; /* of an initial stress (solver/equilibrium.h) */
    double setup_seconds;         /* wall time before the time loop */
    double loop_seconds;          /* wall time of the time loop without output */
    double output_seconds;        /* wall time of output within the time loop */
    int checkpoints;              /* written */
    double checkpoint_seconds;    /* wall time of that */
    double checkpoint_median;     /* of one of them, on the last partition that wrote any (s) */
    double halo_wait_seconds;     /* longest wait for messages on any rank; filled by rg_summary_write */
    const char *failure;          /* "" where the run reached its end; else why not */
    double us_per_tet_step,
        first_fracture; /* filled by rg_summary_write; us of core time; s, infinite for none */
    rg_peak unresolved; /* likewise: the face with most of it (J) */
} rg_summary;

/* Collective; rank 0 writes summary.json in the output directory. */
void rg_summary_write(rg_summary *m, rg_solver *s, const rg_ledger *l, const rg_fragment_table *fragments);

/* Whether dir/summary.json is that of a run that reached its end. Not collective. */
bool rg_completed(const char *dir);

/* For a person; after rg_summary_write. Rank 0. */
void rg_summary_print(const rg_summary *m, const rg_solver *s, const rg_ledger *l, FILE *out);

#endif
