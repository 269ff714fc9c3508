#include "solver/fields.h"

#include <string.h>

#include "base/mem.h"
#include "solver/law.h"

typedef enum { ELEMENT, FACE, SPARSE_FACE, BLOCK, FACE_BLOCK, TILE } per;

static bool is_viscous(const rg_case *c) {
    return c->viscosity.linear > 0 || c->viscosity.quadratic > 0;
}

static void *allocate(const rg_domain *d, per of, size_t values, size_t bytes) {
    switch (of) {
    case ELEMENT:
        return rg_alloc(d->blocks * RG_LANES * values, bytes);
    case FACE:
        return rg_alloc(d->iblocks * RG_LANES * values, bytes);
    case SPARSE_FACE:
        return rg_alloc_sparse(d->iblocks * RG_LANES * values, bytes);
    case BLOCK:
        return rg_alloc(d->blocks * values, bytes);
    case FACE_BLOCK:
        return rg_alloc(d->iblocks * values, bytes);
    case TILE:
        return rg_alloc(d->tiles * values, bytes);
    }
    return NULL;
}

void rg_fields_allocate(rg_solver *s) {
#define ALLOCATE(member, type, per, values, there, saved)                                                    \
    s->member = (there) ? allocate(s->domain, per, values, sizeof *s->member) : NULL;
    RG_FIELDS(ALLOCATE)
#undef ALLOCATE
}

/* Those of elements, which the sweeps stream; `bytes` of a block. */
static void touch(void *field, per of, const rg_tile *t, size_t bytes) {
    if (of == ELEMENT && field != NULL) {
        memset((char *)field + t->begin * bytes, 0, (t->end - t->begin) * bytes);
    }
}

void rg_fields_touch(rg_solver *s, const rg_tile *t) {
#define TOUCH(member, type, per, values, there, saved)                                                       \
    touch(s->member, per, t, RG_LANES *(size_t)(values) * sizeof *s->member);
    RG_FIELDS(TOUCH)
#undef TOUCH
}

void rg_fields_free(rg_solver *s) {
#define FREE(member, type, per, values, there, saved) rg_free(s->member);
    RG_FIELDS(FREE)
#undef FREE
}

static void save(rg_state *st, const char *name, per of, rg_state_type type, size_t values, void *field) {
    if (name != NULL && field != NULL) {
        rg_state_add(st, name, of == ELEMENT ? RG_OF_ELEMENT : RG_OF_FACE, type, (int)values, field);
    }
}

static size_t list_grips(const void *of, int64_t **key, double **value) {
    return rg_contacts_grips(of, key, value);
}

static void take_grips(void *of, size_t rows, const int64_t *key, const double *value) {
    rg_contacts_take_grips(of, rows, key, value);
}

void rg_state_of_solver(rg_state *st, rg_solver *s) {
    rg_state_add(st, "time", RG_OF_RUN, RG_STATE_DOUBLE, 1, &s->time);
    rg_state_add(st, "dt", RG_OF_RUN, RG_STATE_DOUBLE, 1, &s->dt);
    rg_state_add(st, "step", RG_OF_RUN, RG_STATE_INT64, 1, &s->step);
    /* The next time step follows the stiffening of the state before. */
    rg_state_add(st, "stiffening", RG_OF_RUN, RG_STATE_DOUBLE, 1, &s->stiffening_anywhere);
    rg_state_add(st, "pace", RG_OF_RUN, RG_STATE_DOUBLE, 1, &s->opening_rate); /* likewise */
    if (s->contacts != NULL) {
        rg_state_add(st, "contacts", RG_OF_RUN, RG_STATE_INT64, 1, &s->contacts_most);
        rg_state_add(st, "contact_omega2", RG_OF_RUN, RG_STATE_DOUBLE, 1, &s->contact_omega2);
    }
    if (rg_case_rubs(s->input)) {
        rg_state_add_pool(st, "contact_grip", RG_GRIP_ROW,
                          (rg_state_pool){s->contacts, list_grips, take_grips});
    }
    if (rg_case_opens(s->input)) {
        rg_state_add(st, "openings", RG_OF_RUN, RG_STATE_DOUBLE, 2, &s->openings.until);
    }
    if (s->input->start == RG_START_RELAX) {
        rg_state_add(st, "relaxed", RG_OF_RUN, RG_STATE_DOUBLE, 2, &s->relaxed.heat);
    }
    rg_state_add(st, "omega2", RG_OF_RUN, RG_STATE_DOUBLE, 1, &s->omega2);
    rg_state_add(st, "limiting", RG_OF_RUN, RG_STATE_INT64, 1, &s->limiting);
    rg_state_add(st, "damping", RG_OF_RUN, RG_STATE_DOUBLE, 1, &s->damping);
#define SAVE(member, type, per, values, there, saved)                                                        \
    save(st, saved, per, RG_STATE_##type, (size_t)(values), s->member);
    RG_FIELDS(SAVE)
#undef SAVE
    rg_constraints_register(s->constraints, st);
    rg_bodies_register(s->bodies, st);
    rg_ties_register(s->ties, st);
    rg_account_register(s->account, st);
}
