#include "solver/fields.h"

void rg_state_of_solver(rg_state *st, rg_solver *s) {
    rg_state_add(st, "time", RG_OF_RUN, RG_STATE_DOUBLE, 1, &s->time);
    rg_state_add(st, "dt", RG_OF_RUN, RG_STATE_DOUBLE, 1, &s->dt);
    rg_state_add(st, "step", RG_OF_RUN, RG_STATE_INT64, 1, &s->step);
    /* The next time step follows the stiffening of the state before. */
    rg_state_add(st, "stiffening", RG_OF_RUN, RG_STATE_DOUBLE, 1, &s->stiffening_anywhere);
    rg_state_add(st, "pace", RG_OF_RUN, RG_STATE_DOUBLE, 1, &s->opening_rate); /* likewise */
    rg_state_add(st, "omega2", RG_OF_RUN, RG_STATE_DOUBLE, 1, &s->omega2);
    rg_state_add(st, "limiting", RG_OF_RUN, RG_STATE_INT64, 1, &s->limiting);
    rg_state_add(st, "damping", RG_OF_RUN, RG_STATE_DOUBLE, 1, &s->damping);
    rg_state_add(st, "displacement", RG_OF_ELEMENT, RG_STATE_REAL, 3 * RG_NODES, s->u);
    rg_state_add(st, "velocity", RG_OF_ELEMENT, RG_STATE_REAL, 3 * RG_NODES, s->velocity);
    rg_state_add(st, "broken", RG_OF_FACE, RG_STATE_BYTE, 1, s->broken);
    rg_state_add(st, "unlinked", RG_OF_FACE, RG_STATE_BYTE, 1, s->unlinked);
    rg_state_add(st, "crack", RG_OF_FACE, RG_STATE_REAL, (int)(s->crack_stride / RG_LANES), s->crack);
    if (s->history != NULL) {
        rg_state_add(st, "history", RG_OF_ELEMENT, RG_STATE_REAL, (int)(s->history_stride / RG_LANES),
                     s->history);
    }
    if (s->heat != NULL) {
        rg_state_add(st, "heat", RG_OF_ELEMENT, RG_STATE_DOUBLE, 1, s->heat);
    }
    rg_constraints_register(s->constraints, st);
    rg_bodies_register(s->bodies, st);
}
