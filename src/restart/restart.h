/* What of a run, beside the solver's state, goes into a checkpoint: outputs, schedules, ledger. */
#ifndef RG_RESTART_H
#define RG_RESTART_H

#include "base/files.h"
#include "diagnostics/ledger.h"
#include "diagnostics/probe.h"
#include "output/fragment_table.h"
#include "output/snapshot.h"
#include "output/summary.h"
#include "restart/checkpoint.h"

enum { RG_LIMITING_WORDS = 40 };

/* Kept at each checkpoint. */
typedef struct {
    int64_t energy_bytes, history_bytes; /* lengths of the tables */
    rg_fragment_mark fragments;
    rg_writer_mark fields;
    int64_t frame;                          /* next of output.times */
    double good_time;                       /* of the last output that was in order (s) */
    double core_seconds;                    /* of one evaluation of all forces, times ranks and threads */
    char limiting_state[RG_LIMITING_WORDS]; /* solver/solver.h */
} rg_restart;

/* Registers all state of a run. */
void rg_restart_register(rg_state *state, rg_restart *keep, rg_solver *s, rg_ledger *ledger,
                         rg_summary *summary);

/* Before a checkpoint: the outputs go to the disk, and `keep` learns where they stand. Collective. */
void rg_restart_sync(rg_restart *keep, const rg_solver *s, rg_csv *energy, rg_probes *probes,
                     rg_fragment_table *fragments, rg_snapshots *snapshots);

/* After loading one: what rg_spectrum would have found out. */
void rg_restart_spectrum(const rg_restart *keep, rg_solver *s);

#endif
