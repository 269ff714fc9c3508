#include "restart/restart.h"
#include "solver/fields.h"

#include <stdio.h>

void rg_restart_register(rg_state *state, rg_restart *keep, rg_solver *s, rg_ledger *ledger,
                         rg_summary *summary) {
    rg_state_of_solver(state, s);
    rg_state_add(state, "ledger", RG_OF_RUN, RG_STATE_BYTE, (int)sizeof *ledger, ledger);
    rg_state_add(state, "dt_first", RG_OF_RUN, RG_STATE_DOUBLE, 1, &summary->dt_first);
    rg_state_add(state, "energy_bytes", RG_OF_RUN, RG_STATE_INT64, 1, &keep->energy_bytes);
    rg_state_add(state, "history_bytes", RG_OF_RUN, RG_STATE_INT64, 1, &keep->history_bytes);
    rg_state_add(state, "fragment_bytes", RG_OF_RUN, RG_STATE_INT64, 1, &keep->fragments.bytes);
    rg_state_add(state, "overlap_time", RG_OF_RUN, RG_STATE_DOUBLE, 1, &keep->fragments.overlap_time);
    rg_state_add(state, "overlap", RG_OF_RUN, RG_STATE_INT64, 2, keep->fragments.overlap);
    rg_state_add(state, "frames", RG_OF_RUN, RG_STATE_INT64, 1, &keep->fields.frames);
    rg_state_add(state, "xdmf_volume", RG_OF_RUN, RG_STATE_INT64, 1, &keep->fields.volume);
    rg_state_add(state, "xdmf_crack", RG_OF_RUN, RG_STATE_INT64, 1, &keep->fields.crack);
    rg_state_add(state, "next_frame", RG_OF_RUN, RG_STATE_INT64, 1, &keep->frame);
    rg_state_add(state, "good_time", RG_OF_RUN, RG_STATE_DOUBLE, 1, &keep->good_time);
    rg_state_add(state, "core_seconds", RG_OF_RUN, RG_STATE_DOUBLE, 1, &keep->core_seconds);
    if (s->prestress != NULL) {
        rg_state_add(state, "stress_out_of_balance", RG_OF_RUN, RG_STATE_DOUBLE, 1,
                     &summary->stress_out_of_balance);
    }
    rg_state_add(state, "limiting_state", RG_OF_RUN, RG_STATE_BYTE, RG_LIMITING_WORDS, keep->limiting_state);
}

void rg_restart_sync(rg_restart *keep, const rg_solver *s, rg_csv *energy, rg_probes *probes,
                     rg_fragment_table *fragments, rg_snapshots *snapshots) {
    keep->history_bytes = rg_probes_sync(probes);
    keep->energy_bytes = rg_csv_sync(energy);
    keep->fragments = rg_fragment_table_sync(fragments);
    if (snapshots->fields != 0) {
        keep->fields = rg_snapshots_sync(snapshots);
    }
    keep->core_seconds = s->pass_seconds * s->ranks * s->threads;
    if (s->limiting_state != keep->limiting_state) { /* not a word that came from a checkpoint itself */
        snprintf(keep->limiting_state, sizeof keep->limiting_state, "%s", s->limiting_state);
    }
}

void rg_restart_spectrum(const rg_restart *keep, rg_solver *s) {
    s->limiting_state = keep->limiting_state;
    s->pass_seconds = keep->core_seconds / (s->ranks * s->threads);
}
