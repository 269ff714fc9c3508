#include "solver/exposure.h"

#include "base/error.h"
#include "solver/tile.h"

static bool has_separated(const rg_solver *s, size_t i) {
    if (s->broken[i] != (1 << RG_POINTS) - 1) {
        return false;
    }
    for (int q = 0; q < RG_POINTS; q++) {
        if (!(*rg_crack_value(s, i, q, RG_CRACK_OPENING) >= rg_separation(s, i, q))) {
            return false;
        }
    }
    return true;
}

bool rg_exposure_mark(rg_solver *s) {
    int waiting = 0;
#pragma omp parallel for schedule(static) reduction(| : waiting)
    for (size_t b = 0; b < s->domain->iblocks; b++) {
        for (size_t i = b * RG_LANES; s->active[b] && i < (b + 1) * RG_LANES; i++) {
            if (s->exposed[i] == RG_UNEXPOSED && has_separated(s, i)) {
                s->exposed[i] = RG_SEPARATED;
            }
            waiting |= s->exposed[i] == RG_SEPARATED;
        }
    }
    return waiting != 0;
}

static void turn(rg_solver *s, uint8_t from, uint8_t to) {
    for (size_t i = 0; i < s->domain->iblocks * RG_LANES; i++) {
        s->exposed[i] = s->exposed[i] == from ? to : s->exposed[i];
    }
}

void rg_exposure_take(rg_solver *s) {
    turn(s, RG_SEPARATED, RG_NEWLY_EXPOSED);
}

void rg_exposure_settle(rg_solver *s) {
    turn(s, RG_NEWLY_EXPOSED, RG_EXPOSED);
}

void rg_exposure_refuse_overlap(const rg_solver *s) {
    char words[200];
    if (rg_contacts_overlap(s->contacts, words, sizeof words)) {
        rg_speak(s->comm);
        rg_fatal(RG_USAGE, "%s: contact.model general: %s at the start", s->input->path, words);
    }
}
